/* Systems of units of UDUNITS-2. Its database takes longer to read than most decks to check, so that it is read only where a deck has a unit that is none of
 * the usual ones. These are defined here as the database does, and a word means the same in both: it is here as a whole, with its prefix, or not at all. */
#include "deck/units.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

/* UDUNITS-2 keeps states of its parser and of products of units in static variables. Functions of ours that hold the
 * lock call each other. */
static pthread_mutex_t units_mutex;

static void units_make_mutex(void)
{
  pthread_mutexattr_t recursive;
  pthread_mutexattr_init(&recursive);
  pthread_mutexattr_settype(&recursive, PTHREAD_MUTEX_RECURSIVE);
  pthread_mutex_init(&units_mutex, &recursive);
  pthread_mutexattr_destroy(&recursive);
}

void units_lock(void)
{
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, units_make_mutex);
  pthread_mutex_lock(&units_mutex);
}

void units_unlock(void)
{
  pthread_mutex_unlock(&units_mutex);
}

/* In the order in which they are made. */
static const struct {
  const char *symbol;
  double prefix; /* or 0 */
  const char *of;
} usual[] = {
    {"g", 0, "1e-3 kg"},
    {"t", 0, "1000 kg"},
    {"N", 0, "m.kg/s^2"},
    {"Pa", 0, "N/m^2"},
    {"J", 0, "N.m"},
    {"Hz", 0, "1/s"},
    {"min", 0, "60 s"},
    {"h", 0, "60 min"},
    {"d", 0, "24 h"},
    {"pi", 0, "3.141592653589793238462643383279"},
    {"deg", 0, "(pi/180) rad"},
    {"%", 0, "0.01"},
    {"cm", 0.01, "m"},
    {"mm", 1e-3, "m"},
    {"km", 1e3, "m"},
    {"ms", 1e-3, "s"},
    {"us", 1e-6, "s"},
    {"kHz", 1e3, "Hz"},
    {"kN", 1e3, "N"},
    {"MN", 1e6, "N"},
    {"kPa", 1e3, "Pa"},
    {"MPa", 1e6, "Pa"},
    {"GPa", 1e9, "Pa"},
    {"kJ", 1e3, "J"},
    {"in", 0, "2.54 cm"},
    {"ft", 0, "12 in"},
    {"lb", 0, "4.5359237e-1 kg"},
    {"lbf", 0, "4.4482216152605 N"},
    {"kip", 0, "1000 lbf"},
    {"gravity", 0, "9.806650 m/s^2"},
    {"psi", 0, "1 lb gravity/in^2"},
    {"ksi", 0, "kip/in^2"},
    {"pcf", 0, "lb/ft3"},
    {"psf", 0, "lbf/ft2"},
};

/* Names that civil engineers use and the library lacks. */
static const struct {
  const char *name, *meaning;
} additions[] = {
    {"kip", "1000 lbf"},     {"ksi", "1000 lbf/in2"}, {"pcf", "lb/ft3"},       {"psf", "lbf/ft2"},
    {"plf", "lbf/ft"},       {"klf", "1000 lbf/ft"},  {"ksf", "1000 lbf/ft2"}, {"tonf", "2000 lbf"},
    {"microstrain", "1e-6"}, {"deg", "arc_degree"},   {"kgf", "9.80665 N"},    {"tf", "9806.65 N"},
};

static void map_symbol(const char *symbol, ut_unit *unit)
{
  if (unit) ut_map_symbol_to_unit(symbol, UT_ASCII, unit);
  ut_free(unit);
}

/** A unit that is made of no other. */
static void make_base(const char *name, const char *symbol, ut_unit *unit)
{
  if (unit) ut_map_unit_to_name(unit, name, UT_ASCII);
  map_symbol(symbol, unit);
}

ut_system *unit_system_usual(void)
{
  ut_system *system = ut_new_system();
  if (!system) return NULL;
  make_base("meter", "m", ut_new_base_unit(system));
  make_base("kilogram", "kg", ut_new_base_unit(system));
  make_base("second", "s", ut_new_base_unit(system));
  make_base("radian", "rad", ut_new_dimensionless_unit(system));
  for (size_t k = 0; k < sizeof usual / sizeof *usual; ++k) {
    ut_unit *of = ut_parse(system, usual[k].of, UT_ASCII);
    if (!of || usual[k].prefix == 0) {
      map_symbol(usual[k].symbol, of);
      continue;
    }
    map_symbol(usual[k].symbol, ut_scale(usual[k].prefix, of));
    ut_free(of);
  }
  return system;
}

/** @return why no files can be opened at this moment, whichever they are: as many as UDUNITS-2 reads at once; 0 if they can */
static int why_unopened(void)
{
  enum { AT_ONCE = 2 };
  int files[AT_ONCE], number = 0;
  for (int k = 0; k < AT_ONCE; ++k)
    if ((files[k] = open("/", O_RDONLY | O_CLOEXEC)) < 0) number = errno;
  for (int k = 0; k < AT_ONCE; ++k)
    if (files[k] >= 0) close(files[k]);
  return number;
}

ut_system *unit_system_whole(Text *reason)
{
  ut_system *system = ut_read_xml(NULL);
  if (!system) {
    const int number = why_unopened();
    const bool full = number == EMFILE || number == ENFILE;
    text_add(reason, "the unit database of UDUNITS-2 %s%s%s",
             number ? "cannot be read: " : "was not found: install libudunits2-data", number ? strerror(number) : "",
             full ? "; close some, or allow more (ulimit -n)" : "");
    return NULL;
  }
  for (size_t k = 0; k < sizeof additions / sizeof *additions; ++k) {
    ut_unit *known = ut_get_unit_by_name(system, additions[k].name);
    if (!known) {
      ut_unit *unit = ut_parse(system, additions[k].meaning, UT_ASCII);
      if (unit) ut_map_name_to_unit(additions[k].name, UT_ASCII, unit);
      ut_free(unit);
    }
    ut_free(known);
  }
  return system;
}

const char *unit_usual(size_t k)
{
  static const char *const base[] = {"m", "kg", "s", "rad"};
  enum { BASE = sizeof base / sizeof *base };
  if (k < BASE) return base[k];
  return k < BASE + sizeof usual / sizeof *usual ? usual[k - BASE].symbol : NULL;
}

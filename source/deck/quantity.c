/* A strict wrapper around UDUNITS-2. What the library accepts silently and reads otherwise than an engineer means it
 * ("ton" is the US short ton, 6" an angle, MPa*m^0.5 a multiple) is refused with a hint. */
#include "deck/quantity.h"

#include "base/memory.h"
#include "deck/measure.h"
#include "deck/units.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const Dimension dimensions[] = {
    {"1", 0, 0, 0, ""},
    {"angle", 0, 0, 0, "deg"},
    {"length", 1, 0, 0, "m"},
    {"area", 2, 0, 0, "m2"},
    {"volume", 3, 0, 0, "m3"},
    {"time", 0, 0, 1, "s"},
    {"frequency", 0, 0, -1, "Hz"},
    {"damping rate", 0, 0, -1, "1/s"},
    {"velocity", 1, 0, -1, "m/s"},
    {"acceleration", 1, 0, -2, "m/s2"},
    {"angular velocity", 0, 0, -1, "rad/s"},
    {"force", 0, 1, 0, "kN"},
    {"force per length", -1, 1, 0, "kN/m"},
    {"force per volume", -3, 1, 0, "kN/m3"},
    {"stress", -2, 1, 0, "kPa"},
    {"per stress", 2, -1, 0, "1/kPa"},
    {"density", -4, 1, 2, "t/m3"},
    {"energy", 1, 1, 0, "kJ"},
    {"fracture energy", -1, 1, 0, "N/m"},
    {"bond energy", -5, 1, 0, "J/m6"},
    {NULL, 0, 0, 0, NULL},
};

const Dimension *dimension_list(void)
{
  return dimensions;
}

const Dimension *dimension_find(const char *name)
{
  for (const Dimension *d = dimensions; d->name; ++d)
    if (!strcmp(d->name, name)) return d;
  return NULL;
}

/** A system of units, and what decks are reckoned in as units of it. */
typedef struct UnitSet {
  ut_system *system; /* or NULL */
  ut_unit *base[3], *degree;
} UnitSet;

enum { USUAL, WHOLE, SETS };

struct Units {
  UnitSet *sets;  /* [SETS]; the whole system is read when a word asks for it */
  double size[3]; /* of the base units, in m, N, s */
  char name[3][32];
};

static void close_set(UnitSet *set)
{
  for (int k = 0; k < 3; ++k) ut_free(set->base[k]);
  ut_free(set->degree);
  ut_free_system(set->system);
  *set = (UnitSet){0};
}

/** @param[in] system  or NULL. @return whether it knows all base units */
static bool open_set(UnitSet *set, ut_system *system, const char *const names[3])
{
  *set = (UnitSet){.system = system};
  if (!system) return false;
  bool all = true;
  set->degree = ut_parse(system, "deg", UT_ASCII);
  for (int k = 0; k < 3; ++k) all &= (set->base[k] = ut_parse(system, names[k], UT_UTF8)) != NULL;
  return all;
}

/** The system to which a unit belongs. */
static const UnitSet *set_of(const Units *units, const ut_unit *unit)
{
  return &units->sets[ut_get_system(unit) == units->sets[USUAL].system ? USUAL : WHOLE];
}

/** Whether a word begins here with which the library moves the zero of a unit: "m from 2". */
static bool shifts(const char *words, const char *at)
{
  static const char *const known[] = {"from", "after", "since", "ref"};
  for (size_t k = 0; k < sizeof known / sizeof *known; ++k)
    if (at > words && isspace((unsigned char)at[-1]) && !strncasecmp(at, known[k], strlen(known[k])) &&
        isspace((unsigned char)at[strlen(known[k])]))
      return true;
  return false;
}

/** @return NULL after saying why there is none */
static ut_unit *find_unit(const Units *units, const char *words, Text *reason)
{
  UnitSet *usual = &units->sets[USUAL], *whole = &units->sets[WHOLE];
  ut_unit *unit = usual->system ? ut_parse(usual->system, words, UT_UTF8) : NULL;
  if (unit) return unit;
  if (!whole->system) {
    const char *const names[3] = {units->name[0], units->name[1], units->name[2]};
    ut_system *system = unit_system_whole(reason);
    if (!system) return NULL;
    open_set(whole, system, names);
  }
  unit = ut_parse(whole->system, words, UT_UTF8);
  if (!unit) text_add(reason, "unit '%s' is not known", words);
  return unit;
}

/** Says why a unit is not understood as its writer may have meant it. @return whether it is so */
static bool explain_unit(const char *words, Text *reason)
{
  for (const char *c = words; *c; ++c) {
    if (*c == '"' || *c == '\'') {
      text_add(reason, "unit '%s': quotation marks are angles to some and inches to others; write in, ft or deg",
               words);
      return true;
    }
    if (*c == '^' || *c == '*') {
      const char *power = c + 1 + (c[0] == '*' && c[1] == '*');
      char *end;
      double exponent = *c == '^' || c[1] == '*' ? strtod(power, &end) : 1;
      if (exponent != floor(exponent)) {
        text_add(reason, "unit '%s': powers must be whole numbers", words);
        return true;
      }
    }
    if (!strncmp(c, "ton", 3) && !isalpha((unsigned char)c[3]) && (c == words || !isalpha((unsigned char)c[-1]))) {
      text_add(reason, "unit '%s': 'ton' may be short, long or metric; write t (1000 kg) or lb", words);
      return true;
    }
    if (!strncmp(c, "gr", 2) && !isalpha((unsigned char)c[2]) && (c == words || !isalpha((unsigned char)c[-1]))) {
      text_add(reason, "unit '%s': 'gr' is a grain of 65 mg to some; write g", words);
      return true;
    }
    if (!strncmp(c, "rpm", 3) && !isalpha((unsigned char)c[3]) && (c == words || !isalpha((unsigned char)c[-1]))) {
      text_add(reason, "unit '%s': 'rpm' is an angle by time to some; write turns per second as Hz", words);
      return true;
    }
    if (*c == '@' || shifts(words, c)) {
      text_add(reason, "unit '%s': units with an origin are not understood here", words);
      return true;
    }
  }
  return false;
}

ut_unit *units_parse(const Units *units, const char *words, Text *reason)
{
  units_lock();
  ut_unit *unit = explain_unit(words, reason) ? NULL : find_unit(units, words, reason);
  units_unlock();
  return unit;
}

bool units_count_cycles(const char *unit)
{
  static const char *const names[] = {"Hz", "hertz", "Hertz"};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strstr(unit, names[k])) return true;
  return false;
}

/** True if one unit is a multiple of the other. The library also converts a unit to its reciprocal: a period to a frequency. */
static bool alike(const ut_unit *a, const ut_unit *b)
{
  ut_unit *ratio = ut_are_convertible(a, b) ? ut_divide(a, b) : NULL;
  const bool yes = ratio && ut_is_dimensionless(ratio);
  ut_free(ratio);
  return yes;
}

/** The deck's own unit of a dimension, in the system of another unit. */
static ut_unit *unit_of(const Units *units, const Dimension *dimension, const ut_unit *beside)
{
  const UnitSet *set = set_of(units, beside);
  if (!strcmp(dimension->name, "angle")) return ut_clone(set->degree);
  const int power[3] = {dimension->length, dimension->force, dimension->time};
  ut_unit *product = ut_get_dimensionless_unit_one(set->system);
  for (int k = 0; k < 3 && product; ++k) {
    ut_unit *factor = ut_raise(set->base[k], power[k]);
    ut_unit *next = factor ? ut_multiply(product, factor) : NULL;
    ut_free(factor);
    ut_free(product);
    product = next;
  }
  return product;
}

/** Reads the three units of a deck. @return whether it could */
static bool read_base_units(Units *units, const char *const names[3], Error *error)
{
  const char *const wanted[3] = {"m", "N", "s"}, *const what[3] = {"length", "force", "time"};
  bool usual = true; /* names that are not kept as a whole could not be read again in the whole system */
  for (int k = 0; k < 3; ++k) {
    usual &= strlen(names[k]) < sizeof units->name[k];
    strncpy(units->name[k], names[k], sizeof units->name[k] - 1);
  }
  ut_set_error_message_handler(ut_ignore);
  const UnitSet *set = &units->sets[USUAL];
  if (!usual || !open_set(&units->sets[USUAL], unit_system_usual(), names)) {
    Text reason = {0};
    close_set(&units->sets[USUAL]);
    set = &units->sets[WHOLE];
    open_set(&units->sets[WHOLE], unit_system_whole(&reason), names);
    if (!set->system) {
      error_add(error, BRECCIA_FAILURE, "%s", text_words(&reason));
      text_free(&reason);
      return false;
    }
  }
  static const char *const examples[3] = {"m, mm or ft", "N, kN or lbf", "s or ms"};
  for (int k = 0; k < 3; ++k) {
    Text reason = {0};
    bool lacks_memory = false;
    ut_unit *given = units_parse(units, names[k], &reason), *standard = ut_parse(set->system, wanted[k], UT_ASCII);
    if (!given)
      text_add(&reason, "; expected a unit of %s, like %s", what[k], examples[k]);
    else if (!ut_are_convertible(given, standard))
      text_add(&reason, "unit '%s' is not a unit of %s", names[k], what[k]);
    else {
      cv_converter *converter = ut_get_converter(given, standard);
      lacks_memory = !converter;
      units->size[k] = converter ? cv_convert_double(converter, 1) : NAN;
      if (converter && !(units->size[k] > 0))
        text_add(&reason, "unit '%s' is none to count %s in: it must be greater than 0", names[k], what[k]);
      cv_free(converter);
    }
    ut_free(given);
    ut_free(standard);
    if (lacks_memory) error_add(error, BRECCIA_FAILURE, "out of memory: units");
    if (reason.length) error_add(error, BRECCIA_USER_ERROR, "%s", text_words(&reason));
    const bool failed = lacks_memory || reason.length > 0;
    text_free(&reason);
    if (failed) return false;
  }
  return true;
}

Units *units_create(const char *length, const char *force, const char *time, Error *error)
{
  Units *units = memory_plain(1, sizeof *units);
  if (units) units->sets = memory_plain(SETS, sizeof *units->sets);
  if (!units || !units->sets) {
    error_add(error, BRECCIA_FAILURE, "out of memory: units");
    free(units);
    return NULL;
  }
  units_lock();
  const bool read = read_base_units(units, (const char *const[3]){length, force, time}, error);
  units_unlock();
  if (!read) units_destroy(&units);
  return units;
}

void units_destroy(Units **units)
{
  if (!units || !*units) return;
  units_lock();
  for (int n = 0; n < SETS; ++n) close_set(&(*units)->sets[n]);
  units_unlock();
  free((*units)->sets);
  free(*units);
  *units = NULL;
}

void units_name(const Units *units, const Dimension *dimension, char *name, size_t size)
{
  if (!strcmp(dimension->name, "angle")) {
    snprintf(name, size, "deg");
    return;
  }
  if (!strcmp(dimension->name, "stress") && !strcmp(units->name[0], "m")) { /* kN/m2 is kPa to everybody */
    const char *force = units->name[1];
    size_t n = strlen(force);
    if (n && force[n - 1] == 'N') {
      snprintf(name, size, "%.*sPa", (int)(n - 1), force);
      return;
    }
  }
  /* Force per acceleration is mass: say so where the unit has a name. */
  int mass = 0;
  int power[3] = {dimension->length, dimension->force, dimension->time};
  if (power[1] == 1 && power[2] == 2 && !strcmp(units->name[0], "m") && !strcmp(units->name[2], "s")) {
    if (!strcmp(units->name[1], "kN") || !strcmp(units->name[1], "N")) {
      mass = units->name[1][0] == 'k' ? 1 : 2;
      power[0] += 1;
      power[1] = power[2] = 0;
    }
  }
  Text top = {0}, bottom = {0};
  if (mass) text_add(&top, mass == 1 ? "t" : "kg");
  static const int order[3] = {1, 0, 2};
  for (int i = 0; i < 3; ++i) {
    int k = order[i];
    if (!power[k]) continue;
    Text *side = power[k] > 0 ? &top : &bottom;
    if (side->length) text_add(side, "*");
    text_add(side, "%s", units->name[k]);
    if (abs(power[k]) > 1) text_add(side, "%d", abs(power[k]));
  }
  if (bottom.length)
    snprintf(name, size, "%s/%s", top.length ? top.characters : "1", text_words(&bottom));
  else
    snprintf(name, size, "%s", top.length ? top.characters : "");
  text_free(&top);
  text_free(&bottom);
}

double units_in_si(const Units *units, const Dimension *dimension, double value)
{
  return value * pow(units->size[0], dimension->length) * pow(units->size[1], dimension->force) *
         pow(units->size[2], dimension->time);
}

void quantity_describe(double value, const char *unit, Text *text)
{
  static const struct {
    double size;
    const char *prefix;
  } prefixes[] = {{1e12, "T"}, {1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "\u00b5"}, {1e-9, "n"}};
  const double size = fabs(value);
  if (!strcmp(unit, "kg") || !strcmp(unit, "kg/m3")) { /* nobody says Mg */
    const bool tonnes = size >= 999.5 && !unit[2], grams = size > 0 && size < 0.9995 && !unit[2];
    text_add(text, "%.5g %s", tonnes ? value / 1000 : grams ? value * 1000 : value, tonnes ? "t" : grams ? "g" : unit);
    return;
  }
  int k = 4; /* no prefix: for 0 and what is no number */
  if (size > 0 && isfinite(size))
    for (k = 0; k < 7 && size < 0.9995 * prefixes[k].size;) ++k;
  if (!strcmp(unit, "m") && k < 4) k = 4;
  text_add(text, "%.3g %s%s", value / prefixes[k].size, prefixes[k].prefix, unit);
}

/* ---- what was meant by a number or unit that cannot be read ---- */

/** A number written as in other countries or other notations: "10,5", "30 000", "3x10^4". @return true after saying so */
static bool explain_number(const char *words, const char *rest, Text *reason)
{
  const char *next = rest + (*rest == ',' || *rest == '\'' || *rest == '_' || *rest == ' ');
  const char *power = rest + strspn(rest, " x*");
  if (*rest == ',' && isdigit((unsigned char)*next))
    text_add(reason, "'%s': write decimals with a point, like 10.5, and thousands without a comma", words);
  else if (next > rest && isdigit((unsigned char)next[0]) && isdigit((unsigned char)next[1]) &&
           isdigit((unsigned char)next[2]))
    text_add(reason, "'%s': write thousands with nothing between, like 30000 or 3e4", words);
  else if (power > rest && !strncmp(power, "10", 2) && (power[2] == '^' || power[2] == '*'))
    text_add(reason, "'%s': write powers of ten like 3e4", words);
  else
    return false;
  return true;
}

static bool convertible(const Units *units, const char *words, const Dimension *dimension)
{
  Text why = {0};
  ut_unit *unit = find_unit(units, words, &why), *target = unit ? unit_of(units, dimension, unit) : NULL;
  const bool yes = target && alike(unit, target);
  text_free(&why);
  ut_free(unit);
  ut_free(target);
  return yes;
}

/** A unit that was probably meant: its letters in another case ("Mpa"), or a mass that stands for its weight ("lb/in2").
 *  @return true with the unit written out in `meant` */
static bool guess_unit(const Units *units, const Dimension *dimension, const char *given, Text *meant)
{
  static const char *const usual[] = {"Pa", "kPa", "MPa", "GPa", "N",  "kN", "MN", "m",  "mm",  "cm",  "km",
                                      "s",  "ms",  "kg",  "t",   "in", "ft", "J",  "kJ", "psi", "ksi", "lbf"};
  static const char *const weights[][2] = {{"lb", "lbf"}, {"kg", "kgf"}, {"t", "tf"}};
  if (!strcmp(given, "\u00ba") && !strcmp(dimension->name, "angle")) { /* the ordinal sign of Spanish keyboards */
    text_add(meant, "deg");
    return true;
  }
  for (int pass = 0; pass < 2; ++pass) {
    text_free(meant);
    for (const char *c = given; *c;) {
      size_t n = 0;
      while (isalpha((unsigned char)c[n])) ++n;
      const char *word = NULL;
      for (size_t k = 0; k < sizeof usual / sizeof *usual && n && !pass; ++k)
        if (strlen(usual[k]) == n && !strncasecmp(c, usual[k], n)) word = usual[k];
      for (size_t k = 0; k < 3 && n && pass; ++k)
        if (strlen(weights[k][0]) == n && !strncmp(c, weights[k][0], n)) word = weights[k][1];
      if (word)
        text_add(meant, "%s", word);
      else
        text_add(meant, "%.*s", (int)(n ? n : 1), c);
      c += n ? n : 1;
    }
    if (strcmp(text_words(meant), given) && convertible(units, text_words(meant), dimension)) return true;
  }
  return false;
}

/** A weight per volume where a density is asked. */
static bool explain_weight(const Units *units, const Dimension *dimension, const char *given, double number,
                           const char *words, Text *reason)
{
  if (strcmp(dimension->name, "density") || !convertible(units, given, dimension_find("force per volume")))
    return false;
  Text why = {0};
  ut_unit *unit = find_unit(units, given, &why),
          *target = unit ? ut_parse(ut_get_system(unit), "N/m3", UT_ASCII) : NULL;
  cv_converter *converter = unit && target ? ut_get_converter(unit, target) : NULL;
  if (converter)
    text_add(reason, "'%s' is a weight per volume; the density is its mass, %.5g kg/m3", words,
             cv_convert_double(converter, number) / 9.80665);
  const bool explained = converter != NULL;
  cv_free(converter);
  ut_free(unit);
  ut_free(target);
  text_free(&why);
  return explained;
}

/** Does what units_read does, in a thread that holds the lock. */
static int read_quantity(const Units *units, const Dimension *dimension, const char *words, double *value, Text *reason)
{
  char *end;
  double number = strtod(words, &end);
  /* strtod takes hexadecimal numbers and the words inf and nan; a deck has no use for them. */
  const char *first = words + strspn(words, " \t+-");
  if (!*words) {
    text_add(reason, "no value is given");
    goto expected;
  }
  if (end == words || !(isdigit((unsigned char)*first) || *first == '.') ||
      (*first == '0' && (first[1] == 'x' || first[1] == 'X'))) {
    text_add(reason, "'%s' is not a number", words);
    goto expected;
  }
  if (!isfinite(number)) {
    text_add(reason, "'%s' is too large for a number", words);
    return 1;
  }
  if (explain_number(words, end, reason)) return 1;
  while (isspace((unsigned char)*end)) ++end;
  if (!*end) {
    *value = number;
    return 0;
  }
  if (!strcmp(dimension->name, "angular velocity") && units_count_cycles(end)) {
    text_add(reason, "'%s' counts turns, but an angular velocity is asked, like '30 rad/s': 2 pi times as much", words);
    return 1;
  }
  if (!strcmp(dimension->name, "damping rate") && units_count_cycles(end)) {
    text_add(reason,
             "'%s' is a frequency, but a rate is asked, like '30 1/s'; a ratio of critical damping at a frequency is "
             "written {ratio: 0.05, at: %s}",
             words, words);
    return 1;
  }
  Text why = {0}, meant = {0};
  ut_unit *given = units_parse(units, end, &why), *target = given ? unit_of(units, dimension, given) : NULL;
  const bool fits = target && alike(given, target);
  if (fits) {
    cv_converter *converter = ut_get_converter(given, target);
    *value = cv_convert_double(converter, number);
    cv_free(converter);
  }
  Measure measure = {0}; /* of the unit that was given, if it is one of a wrong dimension */
  const bool measured = given && !fits && !measure_unit(units, end, &measure, &meant);
  text_free(&meant);
  bool explained = fits || explain_weight(units, dimension, end, number, words, reason);
  if (!explained && (explained = guess_unit(units, dimension, end, &meant)))
    text_add(reason, "'%s' is not a unit of %s; did you mean '%s'?", end, dimension->name, text_words(&meant));
  if (!explained && given)
    text_add(reason, "'%s' has the wrong dimension", words);
  else if (!explained)
    text_add(reason, "%s", text_words(&why));
  ut_free(given);
  ut_free(target);
  text_free(&why);
  text_free(&meant);
  if (fits) return 0;
  if (explained) return 1;
  if (measured)
    measure_describe_difference(&measure,
                                &(Measure){.power = {[MEASURE_LENGTH] = dimension->length,
                                                     [MEASURE_FORCE] = dimension->force,
                                                     [MEASURE_TIME] = dimension->time}},
                                reason);
expected:
  if (!strcmp(dimension->name, "1"))
    text_add(reason, "; expected a plain number");
  else {
    char unit[64];
    units_name(units, dimension, unit, sizeof unit);
    text_add(reason, "; expected %s %s, like '1.5 %s' or 1.5 (plain numbers are in %s)",
             strchr("aeiou", dimension->name[0]) ? "an" : "a", dimension->name, dimension->example, unit);
  }
  return 1;
}

int units_read(const Units *units, const Dimension *dimension, const char *words, double *value, Text *reason)
{
  units_lock();
  const int status = read_quantity(units, dimension, words, value, reason);
  units_unlock();
  return status;
}

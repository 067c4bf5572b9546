#include "deck/measure.h"

#include "deck/units.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 0.017453292519943295769; /* in radians */

bool measure_is_plain(const Measure *m)
{
  for (int k = 0; k < MEASURE_POWERS; ++k)
    if (m->power[k] != 0) return false;
  return true;
}

bool measure_alike(const Measure *a, const Measure *b)
{
  for (int k = 0; k < MEASURE_POWERS; ++k)
    if (a->power[k] != b->power[k]) return false;
  return a->cycles == b->cycles;
}

/* ---- units ---- */

/* The library shows what a unit is made of to a visitor; a status other than UT_SUCCESS ends the visit. */

static ut_status multiply_by(const ut_unit *basic, int power, Measure *m)
{
  const char *name = ut_get_name(basic, UT_ASCII);
  if (!name) return UT_UNKNOWN;
  if (!strcmp(name, "meter"))
    m->power[MEASURE_LENGTH] += power;
  else if (!strcmp(name, "second"))
    m->power[MEASURE_TIME] += power;
  else if (!strcmp(name, "radian"))
    m->power[MEASURE_ANGLE] += power;
  else if (!strcmp(name, "kilogram")) { /* N s2/m */
    m->power[MEASURE_FORCE] += power;
    m->power[MEASURE_TIME] += 2 * power;
    m->power[MEASURE_LENGTH] -= power;
  } else
    return UT_MEANINGLESS;
  return UT_SUCCESS;
}

static ut_status visit_basic(const ut_unit *unit, void *measure)
{
  return multiply_by(unit, 1, measure);
}

static ut_status visit_product(const ut_unit *unit, int count, const ut_unit *const *basic, const int *powers,
                               void *measure)
{
  (void)unit;
  ut_status status = UT_SUCCESS;
  for (int k = 0; k < count && status == UT_SUCCESS; ++k) status = multiply_by(basic[k], powers[k], measure);
  return status;
}

static const ut_visitor visitor;

static ut_status visit_galilean(const ut_unit *unit, double scale, const ut_unit *underlying, double origin,
                                void *measure)
{
  (void)unit;
  if (origin != 0) return UT_MEANINGLESS;
  ((Measure *)measure)->value *= scale;
  return ut_accept_visitor(underlying, &visitor, measure);
}

static ut_status visit_timestamp(const ut_unit *unit, const ut_unit *underlying, double origin, void *measure)
{
  (void)unit, (void)underlying, (void)origin, (void)measure;
  return UT_MEANINGLESS;
}

static ut_status visit_logarithmic(const ut_unit *unit, double base, const ut_unit *reference, void *measure)
{
  (void)unit, (void)base, (void)reference, (void)measure;
  return UT_MEANINGLESS;
}

static const ut_visitor visitor = {visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

int measure_unit(const Units *units, const char *words, Measure *measure, Text *reason)
{
  *measure = (Measure){.value = 1};
  units_lock();
  ut_unit *unit = units_parse(units, words, reason);
  const ut_status status = unit ? ut_accept_visitor(unit, &visitor, measure) : UT_UNKNOWN;
  ut_free(unit);
  units_unlock();
  if (!unit) return 1;
  measure->cycles = units_count_cycles(words) && measure->power[MEASURE_TIME] == -1;
  if (status == UT_SUCCESS) return 0;
  text_add(reason, "unit '%s' is none of length, force, mass, time or angle", words);
  return 1;
}

int measure_read(const Units *units, const char *words, Measure *measure, Text *reason)
{
  char *end;
  const char *first = words + strspn(words, " \t+-");
  const double value = strtod(words, &end);
  *measure = (Measure){.value = value};
  if (end == words || !(isdigit((unsigned char)*first) || *first == '.') ||
      (*first == '0' && (first[1] == 'x' || first[1] == 'X')) || !isfinite(value)) {
    text_add(reason, "'%s' is not a number", words);
    return 1;
  }
  while (isspace((unsigned char)*end)) ++end;
  if (!*end) return 0;
  if (measure_unit(units, end, measure, reason)) return 1;
  measure->value *= value;
  return 0;
}

/* ---- words ---- */

/* Dimensions by the names that decks use, and the units in which expressions give them. */
static const struct {
  double power[MEASURE_POWERS];
  bool cycles;
  double size; /* of the unit */
  const char *unit, *what;
} known[] = {
    {{0, 0, 0, 0}, false, 1, "", "a plain number"},  {{0, 0, 0, 1}, false, degree, "deg", "an angle"},
    {{1, 0, 0, 0}, false, 1, "m", "a length"},       {{2, 0, 0, 0}, false, 1, "m2", "an area"},
    {{3, 0, 0, 0}, false, 1, "m3", "a volume"},      {{0, 0, 1, 0}, false, 1, "s", "a time"},
    {{0, 0, -1, 0}, true, 1, "Hz", "a frequency"},   {{0, 0, -1, 0}, false, 1, "1/s", "a rate"},
    {{1, 0, -1, 0}, false, 1, "m/s", "a velocity"},  {{1, 0, -2, 0}, false, 1, "m/s2", "an acceleration"},
    {{0, 1, 0, 0}, false, 1, "N", "a force"},        {{-3, 1, 0, 0}, false, 1, "N/m3", "a force per volume"},
    {{-2, 1, 0, 0}, false, 1, "Pa", "a stress"},     {{2, -1, 0, 0}, false, 1, "1/Pa", "an inverse stress"},
    {{-4, 1, 2, 0}, false, 1, "kg/m3", "a density"}, {{-1, 1, 2, 0}, false, 1, "kg", "a mass"},
    {{1, 1, 0, 0}, false, 1, "J", "an energy"},      {{-1, 1, 0, 0}, false, 1, "N/m", "a force per length"},
};
enum { KNOWN = sizeof known / sizeof *known };

static int known_row(const Measure *m)
{
  for (int k = 0; k < KNOWN; ++k) {
    bool same = known[k].cycles == m->cycles;
    for (int p = 0; p < MEASURE_POWERS; ++p) same &= known[k].power[p] == m->power[p];
    if (same) return k;
  }
  return -1;
}

static void add_unit(const Measure *m, Text *words)
{
  static const char *const names[] = {"m", "N", "s", "rad"};
  static const int order[] = {MEASURE_FORCE, MEASURE_LENGTH, MEASURE_TIME, MEASURE_ANGLE};
  const size_t before = words->length;
  for (int above = 1; above >= 0; --above)
    for (int i = 0; i < MEASURE_POWERS; ++i) {
      const int k = order[i];
      const double power = m->power[k];
      if (power == 0 || (power > 0) != above) continue;
      if (words->length == before && !above) text_add(words, "1");
      text_add(words, "%s%s", above ? words->length > before ? "*" : "" : "/", names[k]);
      if (fabs(power) != 1) text_add(words, "%g", fabs(power));
    }
}

int measure_write(const Measure *m, Text *words, Text *reason)
{
  if (!isfinite(m->value)) {
    text_add(reason, "the result is not a finite number");
    return 1;
  }
  const int row = known_row(m);
  if (row >= 0) {
    text_add(words, "%.15g%s%s", m->value / known[row].size, *known[row].unit ? " " : "", known[row].unit);
    return 0;
  }
  for (int k = 0; k < MEASURE_POWERS; ++k)
    if (m->power[k] != floor(m->power[k])) {
      text_add(reason, "the result is ");
      measure_describe(m, reason);
      text_add(reason, ", which no key of a deck takes");
      return 1;
    }
  text_add(words, "%.15g ", m->value);
  add_unit(m, words);
  return 0;
}

void measure_describe(const Measure *m, Text *words)
{
  const int row = known_row(m);
  if (row >= 0) {
    text_add(words, "%s", known[row].what);
    return;
  }
  text_add(words, "a quantity in ");
  add_unit(m, words);
}

void measure_describe_difference(const Measure *given, const Measure *wanted, Text *words)
{
  Measure size = {.value = 1};
  int differences = 0;
  bool more = false;
  for (int k = 0; k < MEASURE_POWERS; ++k) {
    const double over = given->power[k] - wanted->power[k];
    size.power[k] = fabs(over);
    differences += over != 0;
    more |= over > 0;
  }
  const int row = known_row(&size);
  if (differences != 1 || row < 0 || measure_is_plain(wanted)) return;
  text_add(words, "; %s is %s", known[row].what, more ? "left over" : "missing");
}

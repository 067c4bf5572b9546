/* Every dimension and every unit of ours, in units of a deck that are unlike each other; and what is said of numbers and units that cannot be meant. */
#include "deck/interval.h"
#include "deck/measure.h"
#include "deck/quantity.h"
#include "deck/units.h"
#include "support.h"

#include <pthread.h>

/** Reads a quantity of a deck in some units. @return 0, or 1 with words of what is wrong */
static int read_in(const char *const names[3], const char *dimension, const char *words, double *value, Text *reason)
{
  Units *units = units_create(names[0], names[1], names[2], NULL);
  assert_non_null(units);
  const int bad = units_read(units, dimension_find(dimension), words, value, reason);
  units_destroy(&units);
  return bad;
}

static void every_dimension_is_the_same_in_any_units(void **state)
{
  (void)state;
  /* One of each in m, N, s; and its size in ft, kip and ms, of which a second has 1000. */
  const double ft = 0.3048, kip = 4448.2216152605, ms = 1e-3;
  const struct {
    const char *name, *si;
    double size;
  } cases[] = {
      {"1", "", 1},
      {"angle", "deg", 1},
      {"length", "m", ft},
      {"area", "m2", ft * ft},
      {"volume", "m3", ft * ft * ft},
      {"time", "s", ms},
      {"frequency", "Hz", 1 / ms},
      {"damping rate", "1/s", 1 / ms},
      {"velocity", "m/s", ft / ms},
      {"acceleration", "m/s2", ft / ms / ms},
      {"angular velocity", "rad/s", 1 / ms},
      {"force", "N", kip},
      {"force per length", "N/m", kip / ft},
      {"force per volume", "N/m3", kip / (ft * ft * ft)},
      {"stress", "Pa", kip / (ft * ft)},
      {"per stress", "1/Pa", ft * ft / kip},
      {"density", "kg/m3", kip / ft * ms * ms / (ft * ft * ft)},
      {"energy", "J", kip * ft},
      {"fracture energy", "J/m2", kip / ft},
      {"bond energy", "J/m6", kip / (ft * ft * ft * ft * ft)},
  };
  static const char *const names[3] = {"ft", "kip", "ms"};
  Units *units = units_create(names[0], names[1], names[2], NULL);
  size_t count = 0;
  for (const Dimension *d = dimension_list(); d->name; ++d, ++count) {
    assert_true(count < sizeof cases / sizeof *cases);
    assert_string_equal(d->name, cases[count].name);
    char words[64];
    double value;
    Text reason = {0};
    snprintf(words, sizeof words, "3 %s", cases[count].si);
    if (units_read(units, d, words, &value, &reason)) fail_msg("%s: %s", d->name, text_words(&reason));
    if (!(fabs(value * cases[count].size - 3) < 1e-9)) fail_msg("%s: 3 %s is %g", d->name, cases[count].si, value);
    assert_near(units_in_si(units, d, value), 3, 1e-9);
    snprintf(words, sizeof words, "1.5 %s", d->example);
    if (units_read(units, d, words, &value, &reason)) fail_msg("%s: %s", d->name, text_words(&reason));
    /* The deck's own unit in words is that unit. */
    char own[48];
    units_name(units, d, own, sizeof own);
    snprintf(words, sizeof words, "7 %s", own);
    if (units_read(units, d, words, &value, &reason)) fail_msg("%s: %s", d->name, text_words(&reason));
    assert_near(value, 7, 1e-12);
    text_free(&reason);
  }
  assert_int_equal(count, sizeof cases / sizeof *cases);
  units_destroy(&units);
}

static void units_of_civil_engineers_have_their_sizes(void **state)
{
  (void)state;
  static const char *const names[3] = {"m", "N", "s"};
  const double lbf = 4.4482216152605, ft = 0.3048, in = 0.0254, lb = 0.45359237;
  const struct {
    const char *dimension, *unit;
    double size;
  } cases[] = {
      {"force", "kip", 1000 * lbf},
      {"stress", "ksi", 1000 * lbf / (in * in)},
      {"density", "pcf", lb / (ft * ft * ft)},
      {"stress", "psf", lbf / (ft * ft)},
      {"force per length", "plf", lbf / ft},
      {"force per length", "klf", 1000 * lbf / ft},
      {"stress", "ksf", 1000 * lbf / (ft * ft)},
      {"force", "tonf", 2000 * lbf},
      {"1", "microstrain", 1e-6},
      {"angle", "deg", 1},
      {"force", "kgf", 9.80665},
      {"force", "tf", 9806.65},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char words[64];
    double value;
    Text reason = {0};
    snprintf(words, sizeof words, "2 %s", cases[k].unit);
    if (read_in(names, cases[k].dimension, words, &value, &reason)) fail_msg("%s: %s", words, text_words(&reason));
    if (!(fabs(value / cases[k].size - 2) < 1e-9)) fail_msg("%s is %.10g", words, value);
  }
}

/** What most decks need is there without the library's database, and the same to the last bit. */
static void usual_units_are_those_of_the_database(void **state)
{
  (void)state;
  Units *usual = units_create("m", "kN", "s", NULL), *whole = units_create("furlong", "kN", "s", NULL);
  size_t count = 0;
  for (const char *words; (words = unit_usual(count)); ++count) {
    Measure ours, theirs;
    Text reason = {0};
    if (measure_unit(usual, words, &ours, &reason) || measure_unit(whole, words, &theirs, &reason))
      fail_msg("%s", text_words(&reason));
    if (!measure_alike(&ours, &theirs) || ours.value != theirs.value)
      fail_msg("%s is %.17g, of the database %.17g", words, ours.value, theirs.value);
  }
  assert_true(count > 30);
  units_destroy(&whole);
  /* Where there is no database only what is unusual is missed. */
  assert_int_equal(setenv("UDUNITS2_XML_PATH", "/nowhere.xml", 1), 0);
  Error *error = breccia_error_create();
  double value;
  Text reason = {0};
  assert_int_equal(units_read(usual, dimension_find("stress"), "3 kip/in2", &value, &reason), 0);
  assert_int_equal(units_read(usual, dimension_find("length"), "3 furlong", &value, &reason), 1);
  assert_string_equal(text_words(&reason),
                      "the unit database of UDUNITS-2 was not found: install libudunits2-data; expected a length, like "
                      "'1.5 m' or 1.5 (plain numbers are in m)");
  text_free(&reason);
  assert_null(units_create("furlong", "kN", "s", error));
  assert_string_equal(breccia_error_text(error),
                      "the unit database of UDUNITS-2 was not found: install libudunits2-data");
  breccia_error_destroy(&error);
  /* Once it is there, what was begun without it goes on with it. */
  assert_int_equal(unsetenv("UDUNITS2_XML_PATH"), 0);
  const struct {
    const char *dimension, *words;
    double value;
  } cases[] = {{"length", "3 furlong", 603.50520675},
               {"stress", "3 MPa", 3000},
               {"angle", "0.5 turn", 180},
               {"angle", "90 deg", 90},
               {"density", "3000 carat/m3", 6e-4}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    if (units_read(usual, dimension_find(cases[k].dimension), cases[k].words, &value, &reason))
      fail_msg("%s: %s", cases[k].words, text_words(&reason));
    assert_near(value, cases[k].value, 1e-5 * cases[k].value);
  }
  units_destroy(&usual);
}

static void units_are_called_as_engineers_call_them(void **state)
{
  (void)state;
  const struct {
    const char *names[3], *dimension, *wanted;
  } cases[] = {
      {{"m", "N", "s"}, "stress", "Pa"},
      {{"m", "MN", "s"}, "stress", "MPa"},
      {{"mm", "N", "s"}, "stress", "N/mm2"},
      {{"m", "lbf", "s"}, "stress", "lbf/m2"},
      {{"m", "N", "s"}, "density", "kg/m3"},
      {{"m", "kN", "s"}, "density", "t/m3"},
      {{"m", "MN", "s"}, "density", "MN*s2/m4"},
      {{"m", "kN", "ms"}, "density", "kN*ms2/m4"},
      {{"mm", "kN", "s"}, "density", "kN*s2/mm4"},
      {{"mm", "kN", "ms"}, "per stress", "mm2/kN"},
      {{"mm", "kN", "ms"}, "frequency", "1/ms"},
      {{"mm", "kN", "ms"}, "acceleration", "mm/ms2"},
      {{"mm", "kN", "ms"}, "fracture energy", "kN/mm"},
      {{"mm", "kN", "ms"}, "bond energy", "kN/mm5"},
      {{"mm", "kN", "ms"}, "angle", "deg"},
      {{"mm", "kN", "ms"}, "1", ""},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Units *units = units_create(cases[k].names[0], cases[k].names[1], cases[k].names[2], NULL);
    char name[64];
    units_name(units, dimension_find(cases[k].dimension), name, sizeof name);
    assert_string_equal(name, cases[k].wanted);
    units_destroy(&units);
  }
}

static void numbers_have_the_prefix_of_their_size(void **state)
{
  (void)state;
  const struct {
    double value;
    const char *unit, *words;
  } cases[] = {
      {2e12, "Pa", "2 TPa"},       {2e9, "Pa", "2 GPa"},      {2e6, "Pa", "2 MPa"},        {2e3, "Pa", "2 kPa"},
      {2, "Pa", "2 Pa"},           {2e-3, "s", "2 ms"},       {2e-6, "s", "2 \u00b5s"},    {2e-9, "s", "2 ns"},
      {999.4, "Pa", "999 Pa"},     {999.6, "Pa", "1 kPa"},    {2e3, "m", "2e+03 m"},       {999.4, "kg", "999.4 kg"},
      {999.6, "kg", "0.9996 t"},   {0.9994, "kg", "999.4 g"}, {0.9996, "kg", "0.9996 kg"}, {0, "kg", "0 kg"},
      {0.5, "kg/m3", "0.5 kg/m3"}, {INFINITY, "s", "inf s"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Text text = {0};
    quantity_describe(cases[k].value, cases[k].unit, &text);
    assert_string_equal(text_words(&text), cases[k].words);
    text_free(&text);
  }
}

static void what_is_wrong_with_a_quantity_is_said(void **state)
{
  (void)state;
  static const char *const names[3] = {"mm", "kN", "s"};
  static const char length[] = "; expected a length, like '1.5 m' or 1.5 (plain numbers are in mm)";
  static const char energy[] = "; expected an energy, like '1.5 kJ' or 1.5 (plain numbers are in kN*mm)";
  static const char plain[] = "; expected a plain number";
  const struct {
    const char *dimension, *words, *wanted, *more;
  } cases[] = {
      {"length", "", "no value is given", length},
      {"energy", "", "no value is given", energy},
      {"1", "much", "'much' is not a number", plain},
      {"1", "3 m", "'3 m' has the wrong dimension", plain},
      {"length", "0x10", "'0x10' is not a number", length},
      {"length", "-0X10", "'-0X10' is not a number", length},
      {"length", "inf", "'inf' is not a number", length},
      {"length", "-nan", "'-nan' is not a number", length},
      {"length", "1e999", "'1e999' is too large for a number", ""},
      {"length", "3,5 m", "'3,5 m': write decimals with a point, like 10.5, and thousands without a comma", ""},
      {"length", "3'500 m", "'3'500 m': write thousands with nothing between, like 30000 or 3e4", ""},
      {"length", "3_500 m", "'3_500 m': write thousands with nothing between, like 30000 or 3e4", ""},
      {"length", "3 500 m", "'3 500 m': write thousands with nothing between, like 30000 or 3e4", ""},
      {"length", "3x10^4 m", "'3x10^4 m': write powers of ten like 3e4", ""},
      {"length", "3*10**4 m", "'3*10**4 m': write powers of ten like 3e4", ""},
      {"length", "3 x 10^4 m", "'3 x 10^4 m': write powers of ten like 3e4", ""},
      {"length", "3 s", "'3 s' has the wrong dimension", length},
      {"length", "3 parsnips", "unit 'parsnips' is not known", length},
      {"length", "6\"", "unit '\"': quotation marks are angles to some and inches to others; write in, ft or deg",
       length},
      {"length", "6'", "unit ''': quotation marks are angles to some and inches to others; write in, ft or deg",
       length},
      {"length", "3 m^0.5", "unit 'm^0.5': powers must be whole numbers", length},
      {"length", "3 m**1.5", "unit 'm**1.5': powers must be whole numbers", length},
      {"energy", "3 kN*ton", "unit 'kN*ton': 'ton' may be short, long or metric; write t (1000 kg) or lb", energy},
      {"length", "3 gr/m3", "unit 'gr/m3': 'gr' is a grain of 65 mg to some; write g", length},
      {"length", "3 rpm", "unit 'rpm': 'rpm' is an angle by time to some; write turns per second as Hz", length},
      {"length", "3 m @ 2", "unit 'm @ 2': units with an origin are not understood here", length},
      {"length", "3 s since 1970", "unit 's since 1970': units with an origin are not understood here", length},
      {"length", "3 m from 2", "unit 'm from 2': units with an origin are not understood here", length},
      {"length", "3 m after 2", "unit 'm after 2': units with an origin are not understood here", length},
      {"length", "3 m ref 2", "unit 'm ref 2': units with an origin are not understood here", length},
      {"length", "3 m FROM 2", "unit 'm FROM 2': units with an origin are not understood here", length},
      {"angle", "3 \u00ba", "'\u00ba' is not a unit of angle; did you mean 'deg'?", ""},
      {"stress", "3 mpa", "'mpa' is not a unit of stress; did you mean 'MPa'?", ""},
      {"stress", "3 PSI", "'PSI' is not a unit of stress; did you mean 'psi'?", ""},
      {"stress", "3 t/m2", "'t/m2' is not a unit of stress; did you mean 'tf/m2'?", ""},
      {"stress", "3 kg/cm2", "'kg/cm2' is not a unit of stress; did you mean 'kgf/cm2'?", ""},
      {"density", "3 lbf/ft3", "'3 lbf/ft3' is a weight per volume; the density is its mass, 48.055 kg/m3", ""},
      {"damping rate", "3 Hz",
       "'3 Hz' is a frequency, but a rate is asked, like '30 1/s'; a ratio of critical damping at a frequency is "
       "written "
       "{ratio: 0.05, at: 3 Hz}",
       ""},
      {"angular velocity", "3 hertz",
       "'3 hertz' counts turns, but an angular velocity is asked, like '30 rad/s': 2 pi times as much", ""},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    double value;
    Text reason = {0};
    char *wanted = text_format("%s%s", cases[k].wanted, cases[k].more);
    if (!read_in(names, cases[k].dimension, cases[k].words, &value, &reason))
      fail_msg("'%s' was read as a %s", cases[k].words, cases[k].dimension);
    assert_string_equal(text_words(&reason), wanted);
    text_free(&reason);
    free(wanted);
  }
  /* And what is near to these is none of them. */
  const char *const good[][2] = {{"length", "+3 m"},        {"length", ".5 m"},  {"length", "-3e2 mm"},
                                 {"angular velocity", "3"}, {"force", "3 tonf"}, {"volume", "3 m^3"},
                                 {"density", "3 g/cm3"},    {"length", "3\tm"}};
  for (size_t k = 0; k < sizeof good / sizeof *good; ++k) {
    double value;
    Text reason = {0};
    if (read_in(names, good[k][0], good[k][1], &value, &reason)) fail_msg("%s: %s", good[k][1], text_words(&reason));
  }
}

static void units_of_a_deck_must_be_of_their_kind(void **state)
{
  (void)state;
  const char *const cases[][4] = {
      {"s", "N", "s", "unit 's' is not a unit of length"},
      {"m", "kg", "s", "unit 'kg' is not a unit of force"},
      {"m", "N", "m", "unit 'm' is not a unit of time"},
      {"ells", "N", "s", "unit 'ells' is not known; expected a unit of length, like m, mm or ft"},
      {"m", "newt", "s", "unit 'newt' is not known; expected a unit of force, like N, kN or lbf"},
      {"m", "N", "fortnite", "unit 'fortnite' is not known; expected a unit of time, like s or ms"},
      {"m", "-2 N", "s", "unit '-2 N' is none to count force in: it must be greater than 0"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Error *error = breccia_error_create();
    assert_null(units_create(cases[k][0], cases[k][1], cases[k][2], error));
    assert_string_equal(breccia_error_text(error), cases[k][3]);
    breccia_error_destroy(&error);
  }
}

/** Each dimension that expressions name: what is written of it reads as the same quantity, and it has words. */
static void measures_are_written_in_units_that_read_as_the_same(void **state)
{
  (void)state;
  const char *const cases[][3] = {
      {"3", "3", "a plain number"},
      {"3 deg", "3 deg", "an angle"},
      {"3 mm", "0.003 m", "a length"},
      {"3 cm2", "0.0003 m2", "an area"},
      {"3 m3", "3 m3", "a volume"},
      {"3 min", "180 s", "a time"},
      {"3 kHz", "3000 Hz", "a frequency"},
      {"3 1/ms", "3000 1/s", "a rate"},
      {"3 km/s", "3000 m/s", "a velocity"},
      {"3 cm/s2", "0.03 m/s2", "an acceleration"},
      {"3 kN", "3000 N", "a force"},
      {"3 kN/m3", "3000 N/m3", "a force per volume"},
      {"3 kPa", "3000 Pa", "a stress"},
      {"3 1/kPa", "0.003 1/Pa", "an inverse stress"},
      {"3 t/m3", "3000 kg/m3", "a density"},
      {"3 t", "3000 kg", "a mass"},
      {"3 kJ", "3000 J", "an energy"},
      {"3 kN/m", "3000 N/m", "a force per length"},
      {"3 kN/m5", "3000 N/m5", "a quantity in N/m5"},
      {"3 1/m2", "3 1/m2", "a quantity in 1/m2"},
      {"3 kPa s", "3000 N*s/m2", "a quantity in N*s/m2"},
      {"3 Hz2", "3 1/s2", "a quantity in 1/s2"},
  };
  Units *units = units_create("ft", "lbf", "ms", NULL);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Measure m, again;
    Text words = {0}, what = {0}, reason = {0};
    if (measure_read(units, cases[k][0], &m, &reason) || measure_write(&m, &words, &reason))
      fail_msg("%s: %s", cases[k][0], text_words(&reason));
    measure_describe(&m, &what);
    assert_string_equal(text_words(&words), cases[k][1]);
    assert_string_equal(text_words(&what), cases[k][2]);
    assert_int_equal(measure_read(units, text_words(&words), &again, &reason), 0);
    assert_true(measure_alike(&m, &again));
    assert_near(again.value, m.value, 1e-12 * fabs(m.value));
    assert_int_equal(measure_is_plain(&m), k == 0);
    text_free(&words), text_free(&what);
  }
  const char *const wrong[][2] = {{"much", "'much' is not a number"},
                                  {"0x1 m", "'0x1 m' is not a number"},
                                  {"inf", "'inf' is not a number"},
                                  {"1e999", "'1e999' is not a number"},
                                  {"3 candela", "unit 'candela' is none of length, force, mass, time or angle"},
                                  {"3 lg(re 1 mW)", "unit 'lg(re 1 mW)' is none of length, force, mass, time or angle"},
                                  {"3 degC", "unit 'degC' is none of length, force, mass, time or angle"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    Measure m;
    Text reason = {0};
    assert_int_equal(measure_read(units, wrong[k][0], &m, &reason), 1);
    assert_string_equal(text_words(&reason), wrong[k][1]);
    text_free(&reason);
  }
  units_destroy(&units);
}

static void intervals_say_which_numbers_they_hold(void **state)
{
  (void)state;
  const struct {
    const char *interval, *words;
    bool below, low, between, high, above; /* of -1, 0, 1, 2 and 3 */
  } cases[] = {
      {"[0, 2]", "at least 0 and at most 2", false, true, true, true, false},
      {"(0, 2)", "greater than 0 and less than 2", false, false, true, false, false},
      {"[0, 2)", "at least 0 and less than 2", false, true, true, false, false},
      {"(0, 2]", "greater than 0 and at most 2", false, false, true, true, false},
      {"[0, inf)", "at least 0", false, true, true, true, true},
      {"(-inf, 2)", "less than 2", true, true, true, false, false},
      {"(-inf, inf)", "", true, true, true, true, true},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char words[64];
    interval_describe(cases[k].interval, words, sizeof words);
    assert_string_equal(words, cases[k].words);
    const bool wanted[] = {cases[k].below, cases[k].low, cases[k].between, cases[k].high, cases[k].above};
    for (int v = -1; v <= 3; ++v) assert_int_equal(interval_contains(cases[k].interval, v), wanted[v + 1]);
    assert_false(interval_contains(cases[k].interval, NAN));
  }
  assert_true(interval_contains(NULL, -5));
}

/** Reads a unit of the usual ones and one of the database, again and again, until one is wrong. */
static void *read_units_for_long(void *failed)
{
  for (int round = 0; round < 300 && !*(int *)failed; ++round) {
    Units *units = units_create("m", "kN", "s", NULL);
    Text reason = {0};
    double value = 0;
    *(int *)failed |= units_read(units, dimension_find("stress"), "3.5 N.mm^-2", &value, &reason) || value != 3500;
    if (round % 100 == 0)
      *(int *)failed |=
          units_read(units, dimension_find("length"), "2 furlong", &value, &reason) || fabs(value - 402.3) > 0.1;
    text_free(&reason);
    units_destroy(&units);
  }
  return NULL;
}

static void units_are_read_by_many_threads_at_once(void **state)
{
  (void)state;
  enum { THREADS = 4 };
  pthread_t thread[THREADS];
  int failed[THREADS] = {0};
  for (int n = 0; n < THREADS; ++n)
    assert_int_equal(pthread_create(&thread[n], NULL, read_units_for_long, &failed[n]), 0);
  for (int n = 0; n < THREADS; ++n) pthread_join(thread[n], NULL);
  for (int n = 0; n < THREADS; ++n) assert_int_equal(failed[n], 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_dimension_is_the_same_in_any_units),
      cmocka_unit_test(units_of_civil_engineers_have_their_sizes),
      cmocka_unit_test(usual_units_are_those_of_the_database),
      cmocka_unit_test(units_are_called_as_engineers_call_them),
      cmocka_unit_test(numbers_have_the_prefix_of_their_size),
      cmocka_unit_test(what_is_wrong_with_a_quantity_is_said),
      cmocka_unit_test(units_of_a_deck_must_be_of_their_kind),
      cmocka_unit_test(measures_are_written_in_units_that_read_as_the_same),
      cmocka_unit_test(intervals_say_which_numbers_they_hold),
      cmocka_unit_test(units_are_read_by_many_threads_at_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

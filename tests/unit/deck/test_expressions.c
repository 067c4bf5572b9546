/* Where in an expression a mistake stands, and what is said of it. */
#include "support.h"

#include "deck/expression.h"

static int find(void *context, const char *name, Measure *value, Text *reason)
{
  (void)context;
  *value = (Measure){.value = 2};
  if (!strcmp(name, "size")) return 0;
  text_add(reason, "there is no '%s'", name);
  return 1;
}

static bool knows(void *context, const char *name)
{
  (void)context;
  return !strcmp(name, "size");
}

/** Each with the byte at which it goes wrong. */
static void mistakes_are_told_where_they_stand(void **state)
{
  (void)state;
  static const struct {
    const char *words;
    size_t at;
    const char *reason;
  } cases[] = {{"nowhere", 0, "there is no 'nowhere'"},
               {"size + nowhere * 2", 7, "there is no 'nowhere'"},
               {"sqrt(size + here)", 12, "there is no 'here'"},
               {"(size + 1", 9, "expected ')'"},
               {"max(1, (size)", 13, "expected"},
               {"size +", 6, "expected"},
               {"2 * * 3", 4, "write ^ for powers"},
               {"size size", 5, ""},
               {"1 + 2 m", 2, ""},
               {"size ^ 2 m", 5, ""},
               {"a123456789012345678901234567890123456789012345678901234567890123", 0, "a name has at most 63 letters"},
               {"1 + a123456789012345678901234567890123456789012345678901234567890123", 4, "at most 63 letters"},
               {"sinus(1)", 0, ""},
               {"1 + sinus(1)", 4, ""}};
  const Names names = {find, knows, NULL};
  breccia_model *m = model_of(SOFT_SOLID "body: {b: {material: m, spacing: 1, shape: {box: {particles: [2, 2, 2]}}}}\n"
                                         "solve: {explicit: {steps: 1}}\n");
  int bad = 0;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Measure value;
    size_t at = 999;
    Text reason = {0};
    if (!expression_read(cases[k].words, m->units, &names, &value, &at, &reason) || at != cases[k].at ||
        !reason.length || !strstr(text_words(&reason), cases[k].reason)) {
      print_error("'%s': expected '%s' at %zu, found '%s' at %zu\n", cases[k].words, cases[k].reason, cases[k].at,
                  text_words(&reason), at);
      ++bad;
    }
    text_free(&reason);
  }
  breccia_model_destroy(&m);
  assert_int_equal(bad, 0);
}

/** A body whose spacing is what a deck says, with a width W of 500 mm. */
static breccia_model *with_spacing(const char *words)
{
  return model_of("units: {length: m, force: kN, time: s}\nvariables: {W: 500 mm, n: 5, k: '${W} * 2'}\n" SOFT_SOLID
                  "body: {b: {material: m, spacing: '%s', shape: {box: {particles: [2, 2, 2]}}}}\n"
                  "solve: {explicit: {steps: 1}}\n",
                  words);
}

static void quantities_keep_their_units_in_formulas(void **state)
{
  (void)state;
  static const struct {
    const char *words;
    double spacing;
  } cases[] = {{"${W/5}", 0.1},
               {"${W} / 5", 0.1},
               {"${${W}/5}", 0.1},
               {"${W}/5 + 1 mm", 0.101},
               {"2*${W}/n", 0.2},
               {"${n} mm", 0.005},
               {"${k}", 1},
               {"${k/10}", 0.1},
               {"${W}^2/1 m", 0.25},
               {"${sqrt(${W}*k)}", 0.70710678118654752},
               {"${W*sin(pi/6)}", 0.25},
               {"${W*sin(30 deg)}", 0.25},
               {"${W*cos(1)}", 0.5 * 0.5403023058681398},
               {"${W*tan(0.5 rad)}", 0.5 * 0.5463024898437905}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = with_spacing(cases[k].words);
    const double found = m->domain.body.lattices[0].spacing;
    if (!(fabs(found - cases[k].spacing) < 1e-14)) fail_msg("'%s' is %.17g", cases[k].words, found);
    breccia_model_destroy(&m);
  }
}

static void dimensions_that_are_left_over_are_named(void **state)
{
  (void)state;
  static const struct {
    const char *words, *told;
  } cases[] = {{"${W*W}", "'0.25 m2' has the wrong dimension; a length is left over; expected a length"},
               {"${W}^2", "'0.25 m2' has the wrong dimension; a length is left over; expected a length"},
               {"${W/(2 s)}", "'0.25 m/s' has the wrong dimension; a time is missing; expected a length"},
               {"${W} mm", "'500 mm mm' has the wrong dimension; a length is left over; expected a length"},
               {"3 kN m", "'3 kN m' has the wrong dimension; a force is left over; expected a length"},
               {"5 s", "'5 s' has the wrong dimension; expected a length"},
               {"${W*sin(W)}", "sin takes an angle, like sin(30 deg), or a plain number in radians, not a length"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char deck[512];
    snprintf(deck, sizeof deck,
             "units: {length: m, force: kN, time: s}\nvariables: {W: 500 mm}\n" SOFT_SOLID
             "body: {b: {material: m, spacing: '%s', shape: {box: {particles: [2, 2, 2]}}}}\n"
             "solve: {explicit: {steps: 1}}\n",
             cases[k].words);
    char *words = refusal_of(deck);
    if (!strstr(words, cases[k].told)) fail_msg("expected '%s', found '%s'", cases[k].told, words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(mistakes_are_told_where_they_stand),
                                     cmocka_unit_test(quantities_keep_their_units_in_formulas),
                                     cmocka_unit_test(dimensions_that_are_left_over_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

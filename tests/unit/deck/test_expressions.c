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

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(mistakes_are_told_where_they_stand)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

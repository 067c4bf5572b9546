/* Decks that define thousands of things: the reader's work grows as they do, and not as their square. Its work are comparisons of names,
 * counted here by a strcmp that stands before the C library's. */
#include "support.h"

#include "base/text.h"
#include <string.h>

static long comparisons;

int strcmp(const char *a, const char *b)
{
  ++comparisons;
  while (*a && *a == *b) ++a, ++b;
  return (unsigned char)*a - (unsigned char)*b;
}

/** Comparisons that it takes to read a deck with a part that consists of many lines. @param[in] line  with %d for its number */
static long comparisons_for(const char *before, const char *line, int count, const char *after)
{
  Text deck = {0};
  text_add(&deck, "%s", before);
  for (int k = 0; k < count; ++k) {
    const char *number = line;
    for (const char *mark; (mark = strstr(number, "%d")); number = mark + 2)
      text_add(&deck, "%.*s%d", (int)(mark - number), number, k);
    text_add(&deck, "%s\n", number);
  }
  text_add(&deck, "%s", after);
  const long start = comparisons;
  breccia_model *m = model_of("%s", text_words(&deck));
  const long taken = comparisons - start;
  breccia_model_destroy(&m);
  text_free(&deck);
  return taken;
}

#define BAR                                                                                                            \
  "body: {b: {material: m0, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}\n"                                    \
  "solve: {explicit: {steps: 1}}\n"
#define CLAY "materials: {m0: {model: elastic, density: 2000, Young modulus: 1e9, Poisson ratio: 0.2}}\n"

static void reading_grows_as_the_deck_does(void **state)
{
  (void)state;
  const struct {
    const char *before, *line, *after;
  } parts[] = {
      {"materials:\n", "  m%d: {model: elastic, density: 2000, Young modulus: 1e9, Poisson ratio: 0.2}", BAR},
      {CLAY BAR "variables:\n", "  v%d: 1 mm", ""},
      {CLAY BAR "selections:\n", "  s%d: {face: x+}",
       "loads: [{on: s300, force: [1, 0, 0]}, {on: s7, force: [1, 0, 0]}]\n"},
      {CLAY BAR "selections:\n  s: {face: x+}\nloads:\n", "  - {on: s, name: l%d, force: [1, 0, 0]}", ""},
      {CLAY BAR "watch:\n", "  w%d: {displacement of: {nearest: [0, 0, 0]}}", ""},
  };
  for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k) {
    const long few = comparisons_for(parts[k].before, parts[k].line, 400, parts[k].after),
               many = comparisons_for(parts[k].before, parts[k].line, 3200, parts[k].after);
    if (many > 12 * few) fail_msg("%s: %ld comparisons for 400 lines, %ld for 3200", parts[k].line, few, many);
    assert_true(few > 400);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(reading_grows_as_the_deck_does)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

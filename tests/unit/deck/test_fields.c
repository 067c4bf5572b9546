/* Keys of every kind that a deck may have, in a section of the tests' own: what is read, what stands for a key that is left out, and what is said of
 * values that are none. */
#include "deck/section.h"
#include "support.h"

typedef struct Part {
  SectionHead head;
  double size;
} Part;

typedef struct Whole {
  SectionHead head;
  double number, usual, below_one, up_to_one, point[3], open[3];
  const Node *quantity;
  Length length;
  int64_t count, counts[3];
  bool flag;
  const char *text;
  int choice;
  NumberList numbers, pairs, points;
  TextList texts;
  Part *part;
  SectionList parts, some, named;
  NumberOrSection either;
} Whole;

static const char *word(int k)
{
  static const char *const words[] = {"slow", "quick", NULL};
  return words[k];
}

static void check_part(const DeckReader *reader, void *section)
{
  const Part *part = section;
  if (part->size == 13)
    node_error(reader->document, section_node(part, "size"), reader->error, "size: brings bad luck");
}

static const Field part_fields[] = {{.key = "size",
                                     .kind = FIELD_NUMBER,
                                     .offset = offsetof(Part, size),
                                     .dimension = "length",
                                     .standard = "2 mm",
                                     .meaning = "how large"}};
static const Section part_section = {.name = "part", .size = sizeof(Part), FIELDS(part_fields), .check = check_part};

#define KEY(name, its_kind, ...)                                                                                       \
  {                                                                                                                    \
    .key = #name, .kind = its_kind, .offset = offsetof(Whole, name), .standard = "", .meaning = "", __VA_ARGS__        \
  }

static const Field whole_fields[] = {
    KEY(number, FIELD_NUMBER, .dimension = "stress", .range = "[-5, inf)"),
    {.key = "usual", .kind = FIELD_NUMBER, .offset = offsetof(Whole, usual), .standard = "0.25", .meaning = ""},
    {.key = "below one",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Whole, below_one),
     .standard = "",
     .range = "[0, 1)",
     .meaning = ""},
    {.key = "up to one",
     .kind = FIELD_NUMBER,
     .offset = offsetof(Whole, up_to_one),
     .standard = "",
     .range = "(0, 1]",
     .meaning = ""},
    KEY(quantity, FIELD_QUANTITY),
    KEY(length, FIELD_LENGTH, .range = "(0, inf)"),
    KEY(count, FIELD_COUNT, .range = "[1, 9e18]"),
    KEY(flag, FIELD_FLAG),
    KEY(text, FIELD_TEXT),
    KEY(choice, FIELD_CHOICE, .choice = word),
    KEY(point, FIELD_POINT, .dimension = "length"),
    KEY(open, FIELD_FREE_POINT, .dimension = "length"),
    KEY(counts, FIELD_COUNTS, .range = "[1, 99]"),
    KEY(numbers, FIELD_NUMBERS, .dimension = "length"),
    KEY(pairs, FIELD_PAIRS, .dimension = "length"),
    KEY(points, FIELD_POINTS, .dimension = "length"),
    KEY(texts, FIELD_TEXTS),
    KEY(part, FIELD_SECTION, .section = &part_section),
    KEY(parts, FIELD_SECTIONS, .section = &part_section),
    KEY(some, FIELD_ONE_OR_SECTIONS, .section = &part_section),
    KEY(named, FIELD_NAMED, .section = &part_section),
    KEY(either, FIELD_NUMBER_OR_SECTION, .dimension = "length", .section = &part_section),
};
static const Section whole_section = {.name = "whole", .size = sizeof(Whole), FIELDS(whole_fields)};

/** What was read stays as long as this. */
typedef struct Reading {
  Error *error;
  Units *units;
  Document *document;
  Whole *whole;
} Reading;

static Reading read_deck(const char *deck)
{
  Reading r = {.error = breccia_error_create(), .units = units_create("mm", "N", "s", NULL)};
  r.document = document_parse(deck, strlen(deck), "deck", r.error);
  assert_non_null(r.document);
  const DeckReader reader = {.document = r.document, .units = r.units, .error = r.error};
  r.whole = section_read(&reader, r.document->root, &whole_section);
  return r;
}

static void stop(Reading *r)
{
  breccia_error_destroy(&r->error);
  units_destroy(&r->units);
  document_destroy(&r->document);
}

static void every_kind_of_key_is_read(void **state)
{
  (void)state;
  Reading r = read_deck("number: 3 MPa\nusual: -1\nquantity: 7 kg\nlength: 3.5 spacings\ncount: 4e3\nflag: yes\n"
                        "text: two words\nchoice: quick\npoint: [1, 2 m]\nopen: [free, 3]\ncounts: [5, 6]\n"
                        "numbers: [1, 2 cm, 3]\npairs: [[-1, 2], [3, 4 m]]\npoints: [[1, 2], [3, 4, 5]]\n"
                        "texts: [a, b c]\npart: {size: 5 cm}\nparts: [{size: 6}, {}]\nsome: {size: 8}\n"
                        "named: {b: {size: 9}, a: {size: 10}}\neither: {size: 11}\n");
  assert_string_equal(breccia_error_text(r.error), "");
  const Whole *w = r.whole;
  assert_near(w->number, 3, 1e-12);
  assert_near(w->usual, -1, 0);
  assert_string_equal(w->quantity->text, "7 kg");
  assert_near(w->length.value, 3.5, 0);
  assert_true(w->length.in_spacings);
  assert_int_equal(w->count, 4000);
  assert_true(w->flag);
  assert_string_equal(w->text, "two words");
  assert_int_equal(w->choice, 1);
  static const double point[] = {1, 2000, 0}, open[] = {NAN, 3, NAN}, numbers[] = {1, 20, 3},
                      pairs[] = {-1, 2, 3, 4000}, points[] = {1, 2, 0, 3, 4, 5};
  for (int k = 0; k < 3; ++k) {
    assert_near(w->point[k], point[k], 1e-9);
    assert_true(k == 1 ? w->open[k] == open[k] : isnan(w->open[k]));
    assert_int_equal(w->counts[k], ((const int[]){5, 6, 1})[k]);
    assert_near(w->numbers.values[k], numbers[k], 1e-12);
  }
  for (int k = 0; k < 4; ++k) assert_near(w->pairs.values[k], pairs[k], 1e-9);
  for (int k = 0; k < 6; ++k) assert_near(w->points.values[k], points[k], 1e-12);
  assert_int_equal(w->numbers.count, 3);
  assert_int_equal(w->pairs.count, 2);
  assert_int_equal(w->points.count, 2);
  assert_int_equal(w->texts.count, 2);
  assert_string_equal(w->texts.items[1], "b c");
  assert_near(w->part->size, 50, 1e-12);
  assert_int_equal(w->parts.count, 2);
  assert_near(((const Part *)w->parts.items[0])->size, 6, 0);
  assert_near(((const Part *)w->parts.items[1])->size, 2, 1e-15);
  assert_int_equal(w->some.count, 1);
  assert_near(((const Part *)w->some.items[0])->size, 8, 0);
  assert_int_equal(w->named.count, 2);
  assert_near(((const Part *)section_find(&w->named, "a"))->size, 10, 0);
  assert_near(((const Part *)section_find(&w->named, "b"))->size, 9, 0);
  assert_string_equal(((const Part *)w->named.items[0])->head.name, "b"); /* in the order of the deck */
  assert_null(section_find(&w->named, "ab"));
  assert_null(section_find(&w->named, "c"));
  assert_null(section_find(&w->parts, "a"));
  assert_true(isnan(w->either.value));
  assert_near(((const Part *)w->either.section)->size, 11, 0);
  stop(&r);
  r = read_deck("either: 3 m\nlength: 2 m\nsome: [{}, {}, {}]\nopen: [0, free, 1]\ncounts: [7, 8, 9]\n"
                "point: [1, 2, 3]\n");
  assert_string_equal(breccia_error_text(r.error), "");
  assert_near(r.whole->either.value, 3000, 1e-9);
  assert_null(r.whole->either.section);
  assert_near(r.whole->length.value, 2000, 1e-9);
  assert_false(r.whole->length.in_spacings);
  assert_int_equal(r.whole->some.count, 3);
  assert_true(r.whole->open[0] == 0 && isnan(r.whole->open[1]) && r.whole->open[2] == 1);
  assert_int_equal(r.whole->counts[2], 9);
  assert_near(r.whole->point[2], 3, 0);
  stop(&r);
}

static void what_is_left_out_is_absent_or_as_the_table_says(void **state)
{
  (void)state;
  Reading r = read_deck("flag: no");
  assert_string_equal(breccia_error_text(r.error), "");
  const Whole *w = r.whole;
  assert_true(isnan(w->number) && isnan(w->length.value) && isnan(w->either.value));
  for (int k = 0; k < 3; ++k) assert_true(isnan(w->point[k]) && isnan(w->open[k]) && w->counts[k] == -1);
  assert_near(w->usual, 0.25, 0);
  assert_int_equal(w->count, -1);
  assert_false(w->flag);
  assert_null(w->text);
  assert_int_equal(w->choice, -1);
  assert_null(w->quantity);
  assert_null(w->part);
  assert_null(w->either.section);
  assert_int_equal(w->numbers.count + w->pairs.count + w->points.count + w->texts.count, 0);
  assert_int_equal(w->parts.count + w->some.count + w->named.count, 0);
  stop(&r);
}

static void yes_and_no_have_six_words(void **state)
{
  (void)state;
  static const char *const words[] = {"yes", "no", "true", "false", "on", "off",
                                      "Yes", "NO", "True", "FALSE", "On", "OFF"};
  for (int k = 0; k < 12; ++k) {
    char *deck = text_format("flag: %s", words[k]);
    Reading r = read_deck(deck);
    assert_string_equal(breccia_error_text(r.error), "");
    assert_int_equal(r.whole->flag, k % 2 == 0);
    stop(&r);
    free(deck);
  }
}

/** The ends that are not accepted are among the values that are refused below. */
static void closed_ends_of_ranges_are_accepted(void **state)
{
  (void)state;
  static const double below[] = {0, 0.5, 1 - 1e-12}, up_to[] = {1e-12, 0.5, 1};
  for (size_t k = 0; k < sizeof below / sizeof *below; ++k) {
    char *deck = text_format("below one: %.17g\nup to one: %.17g\n", below[k], up_to[k]);
    Reading r = read_deck(deck);
    assert_string_equal(breccia_error_text(r.error), "");
    assert_true(r.whole->below_one == below[k] && r.whole->up_to_one == up_to[k]);
    stop(&r);
    free(deck);
  }
}

static void values_that_are_none_are_refused_in_words(void **state)
{
  (void)state;
  static const char stress[] = "; expected a stress, like '1.5 kPa' or 1.5 (plain numbers are in N/mm2)";
  static const char points[] = "a list of 2 or 3 numbers, like [0, 0.5, 0]",
                    open[] = "a list of 2 or 3 numbers, like [0, free]: 0 holds a direction, 'free' leaves it",
                    counts[] = "a list of 2 or 3 whole numbers, like [64, 70, 2]",
                    numbers[] = "a list of numbers, like [0.1, 0.2]",
                    pairs[] = "a list of pairs [time, value], like [[0, 0], [0.1 s, 1]]",
                    rows[] = "a list of points, like [[0, 0], [1, 0]]", texts[] = "a list of words in square brackets";
  const struct {
    const char *deck, *place, *words, *more;
  } cases[] = {
      {"number: wide", "1:9: number", "'wide' is not a number", stress},
      {"number: [1]", "1:1: number", "expected a number, found a list", ""},
      {"number: {a: 1}", "1:1: number", "expected a number, found keys and values", ""},
      {"number: -6", "1:9: number", "-6 is out of range; it must be at least -5", ""},
      {"below one: 1", "1:12: below one", "1 is out of range; it must be at least 0 and less than 1", ""},
      {"below one: -1e-9", "1:12: below one", "-1e-9 is out of range; it must be at least 0 and less than 1", ""},
      {"up to one: 0", "1:12: up to one", "0 is out of range; it must be greater than 0 and at most 1", ""},
      {"up to one: 1.5", "1:12: up to one", "1.5 is out of range; it must be greater than 0 and at most 1", ""},
      {"usual: 2e50", "1:8: usual",
       "2e50 is too large to reckon with; in the deck's units numbers lie between 1e-50 and 1e+50", ""},
      {"usual: -2e-51", "1:8: usual",
       "-2e-51 is too small to reckon with; in the deck's units numbers lie between 1e-50 and 1e+50", ""},
      {"length: 0 spacings", "1:9: length", "0 is out of range; it must be greater than 0", ""},
      {"length: 3dx", "1:9: length", "'3dx' is not known; did you mean '3 spacings'?", ""},
      {"length: 3.5 * dx", "1:9: length", "'3.5 * dx' is not known; did you mean '3.5 spacings'?", ""},
      {"length: three spacings", "1:9: length", "'three' is not a number; expected a plain number", ""},
      {"count: 1.5", "1:8: count", "1.5 is not a whole number", ""},
      {"count: 1e16", "1:8: count", "1e16 is not a whole number", ""},
      {"count: 0", "1:8: count", "0 is out of range; it must be at least 1 and at most 9e+18", ""},
      {"flag: perhaps", "1:7: flag", "expected yes or no, found perhaps", ""},
      {"flag: [yes]", "1:1: flag", "expected yes or no, found a list", ""},
      {"text: ''", "1:8: text", "expected words", ""},
      {"text: [a]", "1:1: text", "expected words", ""},
      {"choice: slwo", "1:9: choice", "'slwo' is not known; did you mean 'slow'? (choose from slow, quick)", ""},
      {"choice: other", "1:9: choice", "'other' is not known; choose from slow, quick", ""},
      {"choice: {slow: 1}", "1:1: choice", "'keys and values' is not known; choose from slow, quick", ""},
      {"point: 3", "1:8: point", "found 3", points},
      {"point: [1]", "1:1: point", "found a list", points},
      {"point: [1, 2, 3, 4]", "1:1: point", "found a list", points},
      {"point: [1, free]", "1:12: point", "'free' is not a number",
       "; expected a length, like '1.5 m' or 1.5 (plain numbers are in mm)"},
      {"open: [1]", "1:1: open", "found a list", open},
      {"open: [fixed, 2]", "1:8: open",
       "expected a number or 'free', found 'fixed'; 0 holds a direction, 'free' leaves it", ""},
      {"counts: 3", "1:9: counts", "", counts},
      {"counts: [3]", "1:1: counts", "", counts},
      {"counts: [1, 2, 3, 4]", "1:1: counts", "", counts},
      {"counts: [3, 0]", "1:13: counts", "0 is out of range; it must be at least 1 and at most 99", ""},
      {"numbers: 3", "1:10: numbers", "found 3", numbers},
      {"numbers: []", "1:1: numbers", "found an empty one", numbers},
      {"numbers: [[1]]", "1:1: numbers", "found a plain list", numbers},
      {"numbers: data.csv", "1:10: numbers", "found data.csv: files are not read here, write the rows out", numbers},
      {"numbers: [1, x]", "1:14: numbers", "'x' is not a number",
       "; expected a length, like '1.5 m' or 1.5 (plain numbers are in mm)"},
      {"pairs: [1, 2]", "1:1: pairs", "found a plain list", pairs},
      {"pairs: [[0, 1], [2]]", "1:18: pairs", "", pairs},
      {"pairs: [[0, 1], 2]", "1:17: pairs", "", pairs},
      {"pairs: [[0, 1], [0, 2]]", "1:18: pairs", "times must grow from row to row", ""},
      {"pairs: [[0 m, 1]]", "1:10: pairs", "'0 m' has the wrong dimension",
       "; expected a time, like '1.5 s' or 1.5 (plain numbers are in s)"},
      {"points: [1, 2]", "1:1: points", "found a plain list", rows},
      {"points: [[1, 2], [1]]", "1:19: points", "found a list", rows},
      {"texts: a", "1:8: texts", "", texts},
      {"texts: [[a]]", "1:10: texts", "expected words", ""},
      {"part: 3", "1:7: part", "expected keys and values, like {size: 2 mm}; found 3", ""},
      {"part:", "1:1: part", "expected keys and values, like {size: 2 mm}; found nothing", ""},
      {"part: {size: 13}", "1:14: size", "brings bad luck", ""},
      {"parts: {size: 1}", "1:1: parts", "expected a list, each item starting with '- '", ""},
      {"some: []", "1:1: some", "the list is empty", ""},
      {"named: [a]", "1:1: named", "expected names, each with its keys and values; found a list: leave out the '- '",
       ""},
      {"named: {a: {}, a: {}}", "1:16: named", "'a' is defined twice (first in line 1)", ""},
      {"either: [3]", "1:1: either", "expected a number, found a list", ""},
      {"size: 3", "1:1: whole", "unknown key 'size'; 'size' stands under 'part', like part: {size: ...}", ""},
      {"numbr: 3", "1:1: whole", "unknown key 'numbr'; did you mean 'number'?", ""},
      {"flag: no\nflag: yes", "2:1: whole", "key 'flag' stands here twice (first in line 1)", ""},
  };
  int bad = 0;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const bool kind = !strncmp(cases[k].more, "a list", 6);
    char *wanted = kind ? text_format("deck:%s: expected %s%s%s", cases[k].place, cases[k].more,
                                      *cases[k].words ? "; " : "", cases[k].words)
                        : text_format("deck:%s: %s%s", cases[k].place, cases[k].words, cases[k].more);
    Reading r = read_deck(cases[k].deck);
    if (strcmp(breccia_error_text(r.error), wanted)) {
      print_error("%s: «%s», expected «%s»\n", cases[k].deck, breccia_error_text(r.error), wanted);
      ++bad;
    }
    stop(&r);
    free(wanted);
  }
  assert_int_equal(bad, 0);
}

/** Nobody reads on; and no letter of two bytes is cut in half. */
static void long_values_are_cut_in_messages(void **state)
{
  (void)state;
  for (int wide = 0; wide < 2; ++wide)
    for (int length = 120; length <= 122; length += 1 + wide) {
      Text deck = {0}, wanted = {0};
      const bool cut = length > 120;
      text_add(&deck, "usual: %s", wide ? "qq" : "");
      for (int n = wide ? 2 : 0; n < length; n += 1 + wide) text_add(&deck, "%s", wide ? "\u00e9" : "q");
      const char *value = text_words(&deck) + strlen("usual: ");
      text_add(&wanted, "deck:1:8: usual: '%.*s%s' is not a number; expected a plain number", cut ? 60 : length, value,
               cut ? "..." : "");
      Reading r = read_deck(text_words(&deck));
      assert_string_equal(breccia_error_text(r.error), text_words(&wanted));
      stop(&r);
      /* A letter that stands across the cut goes. */
      Text across = {0};
      text_add(&across, "usual: q");
      for (int n = 0; n < 70; ++n) text_add(&across, "\u00e9");
      r = read_deck(text_words(&across));
      text_free(&wanted);
      text_add(&wanted, "deck:1:8: usual: '%.59s...' is not a number", text_words(&across) + strlen("usual: "));
      assert_memory_equal(breccia_error_text(r.error), text_words(&wanted), wanted.length);
      stop(&r);
      text_free(&deck), text_free(&wanted), text_free(&across);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_kind_of_key_is_read),
      cmocka_unit_test(what_is_left_out_is_absent_or_as_the_table_says),
      cmocka_unit_test(yes_and_no_have_six_words),
      cmocka_unit_test(closed_ends_of_ranges_are_accepted),
      cmocka_unit_test(values_that_are_none_are_refused_in_words),
      cmocka_unit_test(long_values_are_cut_in_messages),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

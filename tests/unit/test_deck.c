#include "deck/spelling.h"
#include "support.h"

static double read_as(const char *dimension, const char *words)
{
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  double value = NAN;
  Text reason = {0};
  if (units_read(units, dimension_find(dimension), words, &value, &reason)) value = NAN;
  text_free(&reason);
  units_destroy(&units);
  breccia_error_destroy(&error);
  return value;
}

static void quantities_of_engineers_convert_to_the_decks_units(void **state)
{
  (void)state;
  assert_near(read_as("length", "1.89 m"), 1.89, 1e-15);
  assert_near(read_as("length", "25 mm"), 0.025, 1e-15);
  assert_near(read_as("stress", "30 kPa"), 30, 1e-12);
  assert_near(read_as("stress", "150 MPa"), 150e3, 1e-7);
  assert_near(read_as("density", "1.5 t/m3"), 1.5, 1e-12);
  assert_near(read_as("density", "2400 kg/m3"), 2.4, 1e-12);
  assert_near(read_as("stress", "4000 psi"), 4000 * 6.894757293168361, 1e-6); /* 1 psi = 6894.757293168361 Pa */
  assert_near(read_as("stress", "60 ksi"), 60 * 6894.757293168361, 1e-5);
  assert_near(read_as("fracture energy", "300 lbf/in"), 300 * 4.4482216152605 / 0.0254 / 1000, 1e-9);
  assert_near(read_as("density", "145 pcf"), 145 * 0.45359237 / pow(0.3048, 3) / 1000, 1e-9);
  assert_near(read_as("force per volume", "750 kN/m3"), 750, 1e-9);
  assert_near(read_as("angle", "30"), 30, 0);
  assert_near(read_as("angle", "1 rad"), 180 / acos(-1), 1e-12);
  assert_near(read_as("1", "5 %"), 0.05, 1e-15);
  assert_near(read_as("stress", "1e-3"), 1e-3, 0);
}

static void ambiguous_or_wrong_units_are_refused(void **state)
{
  (void)state;
  const char *const wrong[][2] = {{"stress", "30 kN"},
                                  {"length", "6\""},
                                  {"force", "2 ton"},
                                  {"length", "3 s"},
                                  {"stress", "5 MPa*m^0.5"},
                                  {"stress", "thirty"},
                                  {"length", "1 parsnip"},
                                  {"1", "3 m"},
                                  /* reciprocals are something else, and gr is a grain */
                                  {"frequency", "100 s"},
                                  {"length", "2 1/m"},
                                  {"damping rate", "0.1 s"},
                                  {"density", "2.4 gr/cm3"},
                                  {"damping rate", "3 Hz"},
                                  {"stress", "0x10"},
                                  {"stress", "nan"},
                                  {"length", "inf"},
                                  {"time", "1e999"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k)
    if (!isnan(read_as(wrong[k][0], wrong[k][1]))) fail_msg("'%s' was read as a %s", wrong[k][1], wrong[k][0]);
}

static void unit_names_read_like_an_engineers(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  Units *units = units_create("m", "kN", "s", error);
  char name[64];
  const char *const expected[][2] = {{"stress", "kPa"},  {"density", "t/m3"},           {"length", "m"},
                                     {"time", "s"},      {"force per volume", "kN/m3"}, {"energy", "kN*m"},
                                     {"velocity", "m/s"}};
  for (int k = 0; k < 7; ++k) {
    units_name(units, dimension_find(expected[k][0]), name, sizeof name);
    assert_string_equal(name, expected[k][1]);
  }
  units_destroy(&units);
  breccia_error_destroy(&error);
}

static void numbers_in_si_units_read_as_people_say_them(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  Units *units = units_create("mm", "kN", "ms", error);
  assert_near(units_in_si(units, dimension_find("length"), 5), 5e-3, 1e-18);
  assert_near(units_in_si(units, dimension_find("stress"), 30), 30e9, 1e-3); /* kN/mm2 is GPa */
  assert_near(units_in_si(units, dimension_find("velocity"), 2), 2, 1e-15);
  assert_near(units_in_si(units, dimension_find("density"), 2.4e-6), 2400, 1e-9); /* kN ms2/mm4 is 1e9 kg/m3 */
  units_destroy(&units);
  breccia_error_destroy(&error);
  const struct {
    double value;
    const char *unit, *words;
  } cases[] = {{2e-5, "s", "20 \u00b5s"},  {0.031, "m", "31 mm"},  {2100, "m", "2.1e+03 m"},
               {2400, "kg", "2.4 t"},      {0.05, "kg", "50 g"},   {25000, "kg/m3", "25000 kg/m3"},
               {3e10, "Pa", "30 GPa"},     {-999.7, "J", "-1 kJ"}, {0, "J", "0 J"},
               {1.5e-12, "J", "0.0015 nJ"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Text text = {0};
    quantity_describe(cases[k].value, cases[k].unit, &text);
    assert_string_equal(text_words(&text), cases[k].words);
    text_free(&text);
  }
}

static void other_words_and_slips_lead_to_the_name_meant(void **state)
{
  (void)state;
  const char *const names[] = {"Young modulus", "Poisson ratio", "shear modulus",
                               "ramp to",       "displacement",  "surfaces"};
  const char *const cases[][2] = {{"E", "Young modulus"},
                                  {"G", "shear modulus"},
                                  {"g", NULL},
                                  {"nu", "Poisson ratio"},
                                  {"Young_Modulus", "Young modulus"},
                                  {"ramp", "ramp to"},
                                  {"disp", "displacement"},
                                  {"surfcaes", "surfaces"},
                                  {"name", NULL},
                                  {"colour", NULL},
                                  {"", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const char *found = spelling_nearest(cases[k][0], names, 6);
    if (!cases[k][1] ? found != NULL : !found || strcmp(found, cases[k][1]))
      fail_msg("'%s' leads to '%s'", cases[k][0], found ? found : "nothing");
  }
  assert_int_equal(text_distance("rnu", "run"), 1);
  assert_int_equal(text_distance("plane-stress", "plane stress"), 0);
  assert_int_equal(text_distance("abc", ""), 3);
}

static void intervals_hold_their_closed_ends_only(void **state)
{
  (void)state;
  assert_true(interval_contains("[0, 1)", 0));
  assert_false(interval_contains("[0, 1)", 1));
  assert_false(interval_contains("(0, inf)", 0));
  assert_true(interval_contains("(0, inf)", 1e300));
  char words[64];
  interval_describe("(0, 0.5]", words, sizeof words);
  assert_string_equal(words, "greater than 0 and at most 0.5");
}

static void positions_of_nodes_are_those_of_the_text(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  const char *text = "a: 1\nb:\n  c: [2, 3]\n  d: {e: 4}\n";
  Document *document = document_parse(text, strlen(text), "deck", error);
  assert_non_null(document);
  const Node *b = node_get(document->root, "b"), *c = node_get(b, "c"), *e = node_get(node_get(b, "d"), "e");
  assert_int_equal(c->items[1].line, 3);
  assert_int_equal(c->items[1].column, 10);
  assert_int_equal(e->line, 4);
  assert_int_equal(e->column, 10);
  assert_int_equal(b->key_line, 2);
  document_destroy(&document);
  breccia_error_destroy(&error);
}

static void all_errors_of_a_deck_come_in_one_go(void **state)
{
  (void)state;
  char *words =
      refusal_of("materials:\n  m: {model: elastic, density: -1, Young modulus: 3 m, Poisson ratio: 0.2}\n"
                 "body:\n  b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}, colour: red}\n"
                 "solve: {explicit: {steps: 10.5}}\n");
  int lines = 1;
  for (const char *c = words; *c; ++c) lines += *c == '\n';
  assert_int_equal(lines, 4);
  assert_non_null(strstr(words, "deck:2:32: density: -1 is out of range; it must be greater than 0"));
  assert_non_null(strstr(words, "Young modulus: '3 m' has the wrong dimension"));
  assert_non_null(strstr(words, "unknown key 'colour'"));
  assert_non_null(strstr(words, "steps: 10.5 is not a whole number"));
  free(words);
}

static void two_readings_of_one_text_are_one_model(void **state)
{
  (void)state;
  /* Two models in one process do not disturb each other. */
  const char *deck = "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
                     "body: {b: {material: m, spacing: 1, shape: {box: {particles: [5, 5, 5]}}}}\n"
                     "solve: {explicit: {steps: 5}}\nloads: [{on: {face: x+}, body force: [1, 0, 0]}]\n";
  breccia_model *a = model_of("%s", deck), *b = model_of("%s", deck);
  assert_int_equal(breccia_model_step(a, 5, NULL), 0);
  assert_int_equal(breccia_model_step(b, 5, NULL), 0);
  size_t bytes = sizeof(double) * (size_t)breccia_model_places(a);
  assert_memory_equal(breccia_model_array(a, "displacement x"), breccia_model_array(b, "displacement x"), bytes);
  breccia_model_destroy(&a);
  breccia_model_destroy(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantities_of_engineers_convert_to_the_decks_units),
      cmocka_unit_test(ambiguous_or_wrong_units_are_refused),
      cmocka_unit_test(unit_names_read_like_an_engineers),
      cmocka_unit_test(numbers_in_si_units_read_as_people_say_them),
      cmocka_unit_test(other_words_and_slips_lead_to_the_name_meant),
      cmocka_unit_test(intervals_hold_their_closed_ends_only),
      cmocka_unit_test(positions_of_nodes_are_those_of_the_text),
      cmocka_unit_test(all_errors_of_a_deck_come_in_one_go),
      cmocka_unit_test(two_readings_of_one_text_are_one_model),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

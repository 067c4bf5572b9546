/* Tests of material points: what their curves show, and laws that give up before anything is strained. */
#include "support.h"

#include "constitutive/element_test.h"

#include <unistd.h>

#define FILE_NAME "test_material_tests.yaml"

static void write_test(const char *stages)
{
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  fprintf(file,
          "units: {length: m, force: kN, time: s}\n"
          "material: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\nstages: %s\n"
          "against: test_material_tests.csv\n",
          stages);
  fclose(file);
  file = fopen("test_material_tests.csv", "w");
  assert_non_null(file);
  fprintf(file, "0,0\n1e-3,1\n2e-3,2\n");
  fclose(file);
}

/** The curve of a path is of the component that is strained the farthest, whatever its sign, and the first one of equals; what consolidates does not
 *  count. */
static void a_path_is_drawn_along_its_widest_strain(void **state)
{
  (void)state;
  static const struct {
    const char *stages, *component;
  } cases[] = {{"[{strain xx: 1e-3}]", "xx"},
               {"[{strain xx: 1e-3, strain xy: 2e-3}]", "xy"},
               {"[{strain xx: 1e-3, strain zz: -2e-3}]", "zz"},
               {"[{strain yy: 1e-3}, {strain zx: -3e-3}, {strain yy: 2e-3}]", "zx"},
               {"[{strain yz: 1e-3, strain zx: 1e-3}]", "yz"},
               {"[{strain yy: -5e-3, consolidation: yes}, {strain xy: 1e-3}]", "xy"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_test *test = NULL;
    breccia_comparison found = {.size = sizeof found};
    char words[32];
    write_test(cases[k].stages);
    if (breccia_test_load(FILE_NAME, &test, error) || breccia_test_run(test, 0, error) ||
        breccia_test_compare(test, NULL, &found, error))
      fail_msg("%s: %s", cases[k].stages, breccia_error_text(error));
    snprintf(words, sizeof words, "strain %s", cases[k].component);
    assert_string_equal(found.x_label, words);
    snprintf(words, sizeof words, "stress %s", cases[k].component);
    assert_string_equal(found.y_label, words);
    breccia_test_destroy(&test);
    breccia_error_destroy(&error);
  }
  unlink(FILE_NAME);
  unlink("test_material_tests.csv");
}

/** Fits that cannot be made are refused in their line. */
static void what_cannot_be_fitted_is_said(void **state)
{
  (void)state;
  static const struct {
    const char *fit, *words;
  } cases[] = {
      {"{cohesion: {from: 1, to: 2}}", ":5:7: fit: elastic has no parameter 'cohesion'; it has '"},
      {"{Young modulus: {from: 2e4, to: 1e4}}", "fit: 'Young modulus' needs 'from' below 'to', and both "},
      {"{Young modulus: {from: -1, to: 1e4}}", "fit: 'Young modulus' needs 'from' below 'to', and both greater than 0"},
      {"{Poisson ratio: {from: 0.1, to: 0.6}}", "fit: 'Poisson ratio' needs 'from' below 'to', and both "},
      {"{Poisson ratio: {from: 0.1 m, to: 0.3}}", "has the wrong dimension"},
      {"{}", "nothing to calibrate"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_test *test = NULL;
    breccia_fit fit = {.size = sizeof fit};
    write_test("[{strain xx: 1e-3}]");
    FILE *file = fopen(FILE_NAME, "a");
    assert_non_null(file);
    fprintf(file, "fit: %s\n", cases[k].fit);
    fclose(file);
    int status = breccia_test_load(FILE_NAME, &test, error);
    if (!status) status = breccia_test_fit(test, NULL, &fit, error);
    if (status != BRECCIA_USER_ERROR || !strstr(breccia_error_text(error), cases[k].words))
      fail_msg("%s: expected '%s', status %d: %s", cases[k].fit, cases[k].words, status, breccia_error_text(error));
    breccia_test_destroy(&test);
    breccia_error_destroy(&error);
  }
  unlink(FILE_NAME);
  unlink("test_material_tests.csv");
}

/** Where a test stops early its curve is trusted the less the earlier that is: two parts of the range of the points for what it has not run. A bar that yields at
 *  10.1 never comes to 20: of 40 rows 20 are there, and the first. A fit ends where the test can be run. */
static void a_test_that_stops_early_is_far_from_its_points(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_test *test = NULL;
  breccia_fit fit = {.size = sizeof fit};
  breccia_fitted yield = {.size = sizeof yield};
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  fprintf(file, "units: {length: m, force: kN, time: s}\n"
                "material: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10.1}\n"
                "stages: [{stress xx: 20, stress yy: 0, stress zz: 0, stress xy: 0, stress yz: 0, stress zx: 0, steps: "
                "40}]\n"
                "against: test_material_tests.csv\nfit: {yield stress: {from: 5, to: 50}}\n");
  fclose(file);
  file = fopen("test_material_tests.csv", "w");
  assert_non_null(file);
  fprintf(file, "0,0\n0.5e-3,5\n1e-3,10\n");
  fclose(file);
  if (breccia_test_load(FILE_NAME, &test, error) || breccia_test_fit(test, NULL, &fit, error))
    fail_msg("%s", breccia_error_text(error));
  assert_near(fit.before, 2 * (1 - 21.0 / 40), 1e-6);
  assert_near(fit.after, 0, 1e-6);
  assert_int_equal(breccia_test_fitted_at(test, 0, &yield), 1);
  assert_true(yield.value > 19.99);
  breccia_test_destroy(&test);
  breccia_error_destroy(&error);
  unlink(FILE_NAME);
  unlink("test_material_tests.csv");
}

static int answer_nothing(const void *constants, const breccia_batch *batch)
{
  (void)constants, (void)batch;
  return 0; /* the first point of the batch */
}

/** A law that gives up at no strain: said, and there is no curve. */
static void a_law_that_knows_no_unstrained_state_is_said_to(void **state)
{
  (void)state;
  Material material = material_of("elastic", "Young modulus=1e4", "Poisson ratio=0.25", NULL);
  breccia_law law = *material.law;
  law.update = answer_nothing;
  material.law = &law;
  Stage stage = {.by_strain = {true, true, true, true, true, true}, .target = {1e-3}, .steps = 4};
  const ElementTest test = {.stages = &stage, .count = 1, .turns = -1, .x_weight = {1}, .y_weight = {1}};
  ElementCurve curve;
  Error *error = breccia_error_create();
  assert_int_equal(element_test_run(&test, &material, &curve, error), BRECCIA_FAILURE);
  assert_non_null(strstr(breccia_error_text(error), "the unstrained point could not be integrated"));
  assert_int_equal(curve.count, 0);
  element_curve_destroy(&curve);
  breccia_error_destroy(&error);
  material_destroy(&material);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_path_is_drawn_along_its_widest_strain),
      cmocka_unit_test(what_cannot_be_fitted_is_said),
      cmocka_unit_test(a_test_that_stops_early_is_far_from_its_points),
      cmocka_unit_test(a_law_that_knows_no_unstrained_state_is_said_to),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

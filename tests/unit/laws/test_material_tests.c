/* Tests of material points: what their curves show, and laws that give up before anything is strained. */
#include "support.h"

#include "base/tensor.h"
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

/** What a fit says of its curve is what the test says that is run with the values found, however the search came there. */
static void a_fit_speaks_of_the_curve_that_it_found(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_test *test = NULL;
  breccia_fit fit = {.size = sizeof fit};
  breccia_comparison found = {.size = sizeof found};
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  fprintf(file,
          "units: {length: m, force: kN, time: s}\n"
          "material: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening "
          "modulus: 500}\n"
          "test: {kind: uniaxial, strain: 4e-3, steps: 40}\n"
          "against: test_material_tests.csv\nfit: {yield stress: {from: 5, to: 50}, hardening modulus: {from: 10, "
          "to: 5000}}\n");
  fclose(file);
  file = fopen("test_material_tests.csv", "w");
  assert_non_null(file);
  fprintf(file, "0,0\n0.5e-3,5.4\n1e-3,9.5\n2e-3,14\n3e-3,14.5\n3.5e-3,17\n");
  fclose(file);
  if (breccia_test_load(FILE_NAME, &test, error) || breccia_test_fit(test, NULL, &fit, error) ||
      breccia_test_run(test, 0, error) || breccia_test_compare(test, NULL, &found, error))
    fail_msg("%s", breccia_error_text(error));
  assert_int_equal(found.points, 6);
  assert_true(found.mean > 0.01 && found.most > 1.2 * found.mean);
  assert_near(fit.after, found.mean, 1e-15);
  assert_near(fit.most, found.most, 1e-15);
  breccia_test_destroy(&test);
  breccia_error_destroy(&error);
  unlink(FILE_NAME);
  unlink("test_material_tests.csv");
}

/** A test in words, run to its end; numbers in m, kN, s. */
static breccia_test *test_of(const char *law, const char *const *parameters, int count, breccia_test_words words)
{
  breccia_error *error = breccia_error_create();
  breccia_test *test = NULL;
  words.size = sizeof words;
  words.law = law;
  words.units = "m, kN, s";
  words.parameters = parameters;
  words.parameter_count = count;
  if (breccia_test_make(&words, &test, error) || breccia_test_run(test, 0, error))
    fail_msg("%s of %s: %s", words.kind, law, breccia_error_text(error));
  breccia_error_destroy(&error);
  return test;
}

/** @return the last number of a column: strains come first, then stresses */
static double last_of(const breccia_test *test, bool stress, int component)
{
  char words[32];
  snprintf(words, sizeof words, "%s %s", stress ? "stress" : "strain", component_names[component]);
  const int column = 6 * stress + component;
  assert_memory_equal(breccia_test_heading(test, column), words, strlen(words));
  return breccia_test_column(test, column)[breccia_test_rows(test) - 1];
}

enum { ONCE, BACK, TOTAL, OPTIONS };

/** Every kind of test with an elastic law, E = 10 MPa and nu = 0.25 (lambda = G = 4 MPa), under 50 kPa and strained by e: all strains and stresses at its
 *  end, per e and beyond the consolidation; once to the strain, there and back to another one, and with strains counted from before the
 *  consolidation. */
static void every_kind_of_test_strains_as_it_says(void **state)
{
  (void)state;
  static const char *const elastic[] = {"Young modulus=1e4", "Poisson ratio=0.25"};
  static const struct {
    const char *kind;
    double strain[6], stress[6];
  } cases[] = {{"uniaxial", {1, -0.25, -0.25}, {1e4}},
               {"triaxial", {1, -0.25, -0.25}, {1e4}},
               {"undrained triaxial", {1, -0.5, -0.5}, {8e3, -4e3, -4e3}},
               {"oedometer", {1}, {1.2e4, 4e3, 4e3}},
               {"biaxial", {1, -1.0 / 3}, {1e4 / 0.9375, 0, 0.25e4 / 0.9375}},
               {"isotropic", {1, 1, 1}, {2e4, 2e4, 2e4}},
               {"simple shear", {0, 0, 0, 1}, {0, 0, 0, 4e3}},
               {"undrained shear", {0, 0, 0, 1}, {0, 0, 0, 4e3}}};
  enum { KINDS = sizeof cases / sizeof *cases };
  for (int k = 0; test_kind_word(k); ++k) {
    int c = 0;
    while (c < KINDS && strcmp(cases[c].kind, test_kind_word(k)) != 0) ++c;
    if (c == KINDS) fail_msg("nobody tests the kind '%s'", test_kind_word(k));
    for (int option = ONCE; option < OPTIONS; ++option) {
      const bool confined = strcmp(cases[c].kind, "uniaxial") != 0;
      const double e = option == BACK ? 3e-3 : -1e-2, pressure = confined ? 50 : 0;
      const int ways = option == BACK ? 4 : 1, before = confined && option == TOTAL ? 20 : 0;
      breccia_test *test = test_of("elastic", elastic, 2,
                                   (breccia_test_words){.kind = cases[c].kind,
                                                        .to = "-0.01",
                                                        .back = option == BACK ? "0.003" : NULL,
                                                        .confining = confined ? "50" : NULL,
                                                        .strain_zero = option == TOTAL ? "before consolidation" : NULL,
                                                        .cycles = option == BACK ? 2 : 0,
                                                        .steps = 5});
      assert_int_equal(breccia_test_rows(test), 1 + before + 5 * ways);
      for (int n = 0; n < 6; ++n) {
        const double consolidated = n < 3 && option == TOTAL ? -pressure / 2e4 : 0;
        assert_near(last_of(test, false, n), consolidated + cases[c].strain[n] * e, 1e-12);
        assert_near(last_of(test, true, n), cases[c].stress[n] * e - (n < 3 ? pressure : 0), 1e-7);
      }
      breccia_test_destroy(&test);
    }
  }
}

/** Sand that is sheared swells: where the stress on its plane is kept it rises, where its volume is kept the pressure grows. */
static void sheared_sand_swells_or_is_pressed(void **state)
{
  (void)state;
  static const char *const sand[] = {"Young modulus=1e4", "Poisson ratio=0.25", "cohesion=1", "friction angle=30",
                                     "dilation angle=10"};
  for (int undrained = 0; undrained < 2; ++undrained) {
    breccia_test *test = test_of(
        "mohr-coulomb", sand, 5,
        (breccia_test_words){
            .kind = undrained ? "undrained shear" : "simple shear", .to = "0.05", .confining = "50", .steps = 100});
    assert_near(last_of(test, false, XX), 0, 1e-12);
    assert_near(last_of(test, false, ZZ), 0, 1e-12);
    const double risen = last_of(test, false, YY), pressed = last_of(test, true, YY);
    if (undrained) {
      assert_near(risen, 0, 1e-12);
      assert_true(pressed < -60);
    } else {
      assert_near(pressed, -50, 1e-6);
      assert_true(risen > 1e-3);
    }
    breccia_test_destroy(&test);
  }
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
      cmocka_unit_test(a_fit_speaks_of_the_curve_that_it_found),
      cmocka_unit_test(every_kind_of_test_strains_as_it_says),
      cmocka_unit_test(sheared_sand_swells_or_is_pressed),
      cmocka_unit_test(a_law_that_knows_no_unstrained_state_is_said_to),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

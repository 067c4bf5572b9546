/* Bars in one dimension, against closed forms. */
#include "support.h"

#include "base/tensor.h"

static const double pi = 3.14159265358979323846;

/** A bar of n particles 1 apart, of area 0.3, E = 150. */
static breccia_model *bar(int n, const char *peridynamics, const char *rest)
{
  return model_of(
      "materials: {m: {model: elastic-1d, density: 2, Young modulus: 150}}\n"
      "peridynamics: {formulation: bond-based, space: 1-D%s}\nbody: {b: {material: m, lattice: line, area: 0.3, "
      "spacing: 1, shape: {box: {particles: [%d, 1]}}}}\n%s",
      peridynamics, n, rest);
}

#define ONE_STEP "solve: {explicit: {steps: 1}}\n"

/** Validation U7, U8: 2 floor(m) neighbours; energies of a stretched bar over the continuum's. */
static void a_stretched_bar_has_the_energy_that_theory_tabulates(void **state)
{
  (void)state;
  const struct {
    const char *words;
    double ratio;
    int neighbours;
  } cases[] = {{", calibration: continuum", 1.3201, 6},
               {", calibration: continuum, volume correction: partial", 1.0000, 6},
               {", calibration: continuum, volume correction: partial-beyond", 1.0000, 6},
               {"", 1, 6},
               {", horizon: 2.015 spacings, influence: conical", 1, 4}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model = bar(30, cases[k].words, ONE_STEP);
    const int32_t middle = model->domain.particles->place_of[15];
    assert_int_equal(family_count(&model->domain.family, middle), cases[k].neighbours);
    const double f[9] = {1 + 1e-6, 0, 0, 0, 1, 0, 0, 0, 1};
    deform_uniformly(model, f);
    double strain[6], stress[6];
    for (int32_t n = 0; n < 30; ++n) {
      domain_look(&model->domain, model->domain.particles->place_of[n], strain, stress);
      assert_near(strain[XX], 1e-6, 1e-11);
      if (n == 15) assert_near(stress[XX] / (150 * 1e-6), cases[k].ratio, 1e-4);
      for (int c = 1; c < 6; ++c) assert_near(stress[c], 0, 0);
    }
    breccia_model_destroy(&model);
  }
}

/** Validation A8: a wave of wave number k on a long bar rings with omega^2 = 2 / rho sum c A dx (1 - cos k j dx) / (j dx). Forces of a small
 *  cosine are -rho omega^2 u inside. */
static void waves_have_the_dispersion_of_bonds(void **state)
{
  (void)state;
  const double horizon = 3.015, c = 2 * 150 / (0.3 * horizon * horizon);
  for (int wave = 1; wave <= 7; ++wave) {
    breccia_model *model = bar(120, ", calibration: continuum", ONE_STEP);
    const Particles *p = model->domain.particles;
    const double k = wave * pi / 7.3, amplitude = 1e-9;
    double square = 0;
    for (int j = 1; j <= 3; ++j) square += 2 * c * 0.3 / 2 * (1 - cos(k * j)) / j;
    for (int32_t n = 0; n < 120; ++n) p->displacement.row[0][p->place_of[n]] = amplitude * cos(k * n);
    compute_forces(model);
    for (int32_t n = 10; n < 110; ++n)
      assert_near(p->internal.row[0][p->place_of[n]], -2 * square * amplitude * cos(k * n),
                  1e-7 * 2 * square * amplitude);
    breccia_model_destroy(&model);
  }
}

/** s0 = sqrt(3 G_F / (E delta)) of a continuum. */
static void a_bar_breaks_at_its_fracture_energy(void **state)
{
  (void)state;
  breccia_model *model =
      bar(30, ", calibration: continuum", "failure: {fracture energy: 0.02, calibration: continuum}\n" ONE_STEP);
  const double limit = model->domain.failure.limit[0];
  assert_near(limit, sqrt(3 * 0.02 / (150 * 3.015)), 1e-9 * limit);
  breccia_model_destroy(&model);
}

/** Validation A6: a bar struck at its end; the front runs at root E / rho. */
static void a_front_runs_along_the_bar_at_root_e_over_rho(void **state)
{
  (void)state;
  breccia_model *model = bar(400, ", surface correction: energy",
                             "loads: [{on: {face: x-}, velocity: [0.001, 0, 0], history: {ramp to: 0.3}}]\n"
                             "solve: {explicit: {steps: 100000}}\n");
  const Particles *p = model->domain.particles;
  double arrival[2] = {0};
  while (!(arrival[1] > 0) && breccia_model_time(model) < 100) {
    breccia_model_step(model, 1, NULL);
    for (int k = 0; k < 2; ++k)
      if (!(arrival[k] > 0) && p->velocity.row[0][p->place_of[100 + 200 * k]] > 0.0005)
        arrival[k] = breccia_model_time(model);
  }
  assert_near(200 / (arrival[1] - arrival[0]), sqrt(150. / 2), 0.02 * sqrt(150. / 2));
  breccia_model_destroy(&model);
}

static void what_a_bar_cannot_have_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *peridynamics, *block, *load, *words;
  } wrong[] = {
      {"formulation: bond-based, space: 1-D", "lattice: line", "", "a line needs the 'area'"},
      {"formulation: bond-based", "lattice: line, area: 1", "", "space: a line needs '1-D'"},
      {"formulation: bond-based, space: 1-D", "lattice: square, thickness: 1", "",
       "a lattice of the plane needs 'plane strain'"},
      {"formulation: bond-based, space: 1-D", "lattice: line, area: 1",
       "loads: [{on: {all: yes}, body force: [0, 1, 0]}]\n", "has a part along y, but the body is a bar along x"},
      {"space: 1-D", "lattice: line, area: 1", "", "correspondence has no strain along a line"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char *deck =
        text_format("materials: {m: {%s, density: 1, Young modulus: 1%s}}\nperidynamics: {%s}\nbody: {b: {material: m, "
                    "spacing: 1, %s, shape: {box: {particles: [9, 1]}}}}\n%s" ONE_STEP,
                    k == 4 ? "model: elastic" : "model: elastic-1d", k == 4 ? ", Poisson ratio: 0.2" : "",
                    wrong[k].peridynamics, wrong[k].block, wrong[k].load);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s' in '%s'", wrong[k].words, words);
    free(words);
    free(deck);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_stretched_bar_has_the_energy_that_theory_tabulates),
      cmocka_unit_test(waves_have_the_dispersion_of_bonds),
      cmocka_unit_test(a_bar_breaks_at_its_fracture_energy),
      cmocka_unit_test(a_front_runs_along_the_bar_at_root_e_over_rho),
      cmocka_unit_test(what_a_bar_cannot_have_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

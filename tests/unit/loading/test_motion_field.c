/* Motions prescribed by formulas: even strain through a rim as deep as the horizon, at rest and in motion, and what is no formula. */
#include "support.h"

#define UNITS "units: {length: mm, force: N, time: s}\n"
#define RIM "{except: {inside: {box: {from: [400, 400], to: [1200, 800]}}}}"

static breccia_model *plate(const char *formulation, const char *field, const char *solve)
{
  return model_of(UNITS
                  "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 1e7 kPa, Poisson ratio: 0.3}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 100, thickness: 300, shape: {box: {particles: "
                  "[16, 12]}}}}\n"
                  "peridynamics: {formulation: %s, space: plane strain, strain: small, horizon: 2.015 spacings}\n"
                  "loads: [{on: " RIM ", field: {%s}, history: {ramp to: 1}}]\n"
                  "solve: {%s}\n",
                  formulation, field, solve);
}

/** The farthest that any particle is from u = G X + c, as a share of the largest displacement. */
static double farthest(const breccia_model *m, const double g[4], const double c[2])
{
  const Particles *p = m->domain.particles;
  double off = 0, most = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    for (int k = 0; k < 2; ++k) {
      const double wanted = g[2 * k] * p->position[0][i] + g[2 * k + 1] * p->position[1][i] + c[k];
      off = larger_of(off, fabs(p->displacement.row[k][i] - wanted));
      most = larger_of(most, fabs(wanted));
    }
  }
  return off / most;
}

static const char *const even = "displacement: ['1e-4*x - 3e-5*y + 0.002 mm', '2e-5 * (x + 100 mm) - 4e-5*y']";
static const double even_g[4] = {1e-4, -3e-5, 2e-5, -4e-5}, even_c[2] = {0.002, 0.002};

static void an_even_strain_of_the_rim_is_that_of_the_body(void **state)
{
  (void)state;
  static const char *const formulations[] = {"hybrid, form: variational", "hybrid, form: pairwise", "correspondence"};
  static const char *const ways[] = {"direct", "minimal residuals"};
  for (int f = 0; f < 3; ++f)
    for (int w = 0; w < 2; ++w) {
      char solve[100];
      snprintf(solve, sizeof solve, "static: {increments: 2, residual: 1e-12, equations: %s}", ways[w]);
      breccia_model *m = plate(formulations[f], even, solve);
      step_surely(m, INT64_MAX);
      assert_near(farthest(m, even_g, even_c), 0, 1e-9);
      breccia_model_destroy(&m);
    }
}

/** In motion, with the works of the rim in the ledger. Brought on slowly, it ends in even strain. */
static void the_rim_does_its_work_in_motion(void **state)
{
  (void)state;
  static const char *const solves[] = {
      "implicit: {end time: 1, time step: 0.05, damping: 200 1/s}",
      "explicit: {end time: 0.05, damping: 200 1/s}",
  };
  for (int s = 0; s < 2; ++s) {
    breccia_model *m = model_of(
        UNITS "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 1e4 kPa, Poisson ratio: 0.3}}\n"
              "body: {b: {material: m, lattice: square, spacing: 100, thickness: 300, shape: {box: {particles: [16, "
              "12]}}}}\n"
              "peridynamics: {formulation: hybrid, space: plane strain, strain: small, horizon: 1.5 spacings}\n"
              "loads: [{on: " RIM ", field: {%s}, history: {ramp to: %g}}]\n"
              "solve: {%s}\n",
        even, s ? 0.03 : 0.5, solves[s]);
    step_surely(m, INT64_MAX);
    assert_near(farthest(m, even_g, even_c), 0, s ? 2e-2 : 1e-3);
    assert_balanced(m, s ? 1e-3 : 1e-6);
    assert_true(m->solver.ledger.external_work > 0);
    breccia_model_destroy(&m);
  }
}

/** A body that is turned as a whole has the kinetic energy of its turning, and no strain, in any unit of time. */
static void a_field_of_velocities_turns_a_body(void **state)
{
  (void)state;
  for (int ms = 0; ms < 2; ++ms) {
    breccia_model *m = model_of(
        "units: {length: mm, force: N, time: %s}\n"
        "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 1e4 kPa, Poisson ratio: 0.3}}\n"
        "body: {b: {material: m, lattice: square, spacing: 100, thickness: 300, shape: {box: {particles: [8, 6]}}}}\n"
        "peridynamics: {formulation: hybrid, space: plane strain, strain: small, horizon: 1.5 spacings}\n"
        "loads: [{on: {all: yes}, field: {velocity: ['-0.002 * (y - 300 mm) / 1 s', '0.002 * (x - 400 mm) / 1 s', "
        "free]}}]\n"
        "solve: {explicit: {steps: 40}}\n",
        ms ? "ms" : "s");
    const Particles *p = m->domain.particles;
    step_surely(m, INT64_MAX);
    const double rate = ms ? 2e-6 : 2e-3, angle = rate * m->solver.clock.time, g[4] = {0, -angle, angle, 0},
                 c[2] = {300 * angle, -400 * angle};
    assert_near(farthest(m, g, c), 0, 1e-9);
    double expected = 0;
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      expected += 0.5 * p->density[i] * p->volume[i] * rate * rate *
                  (pow(p->position[0][i] - 400, 2) + pow(p->position[1][i] - 300, 2));
    }
    assert_near(m->solver.ledger.kinetic, expected, 1e-9 * expected);
    assert_balanced(m, 1e-6);
    breccia_model_destroy(&m);
  }
}

static void what_is_no_field_is_refused(void **state)
{
  (void)state;
  static const char *const cases[][2] = {
      {"displacement: ['0.1*w', 0]", "there is no 'w' here; a field knows x, y and z"},
      {"displacement: ['x*y', 0]", "displacement: 'x*y': is an area, expected a length"},
      {"velocity: ['x', 0]", "is a length, expected a velocity"},
      {"displacement: [0.1]", "expected a list of 2 or 3 expressions"},
      {"displacement: [0, 0, '0.1*x']", "has a part along z, but the body is plane"},
      {"displacement: ['1/(x-x)', 0]", "division by zero"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char deck[1200];
    snprintf(deck, sizeof deck,
             UNITS "materials: {m: {model: elastic, density: 2 t/m3, Young modulus: 1e7 kPa, Poisson ratio: 0.3}}\n"
                   "body: {b: {material: m, lattice: square, spacing: 100, thickness: 300, shape: {box: {particles: "
                   "[8, 8]}}}}\n"
                   "peridynamics: {formulation: hybrid, space: plane strain}\n"
                   "loads: [{on: {all: yes}, field: {%s}}]\n"
                   "solve: {static: {increments: 1}}\n",
             cases[k][0]);
    char *words = refusal_of(deck);
    if (!strstr(words, cases[k][1])) fail_msg("«%s», expected «%s»", words, cases[k][1]);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_even_strain_of_the_rim_is_that_of_the_body),
      cmocka_unit_test(the_rim_does_its_work_in_motion),
      cmocka_unit_test(a_field_of_velocities_turns_a_body),
      cmocka_unit_test(what_is_no_field_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

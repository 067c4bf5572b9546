/* Factors of loads that are found so that a measure of the displacements is as prescribed: peaks, softening branches and snap-back. */
#include "support.h"

static double factor_of(const breccia_model *model)
{
  for (int l = 0; l < model->loading.count; ++l)
    if (history_is_controlled(&model->loading.loads[l].history)) return model->loading.loads[l].history.found;
  return NAN;
}

static void step(breccia_model *model, int64_t count)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, count, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

#define PLATE                                                                                                          \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"       \
  "peridynamics: {formulation: correspondence, space: plane stress}\n"                                                 \
  "loads:\n"                                                                                                           \
  "  - {on: {face: x-, layers: 2}, displacement: [0, 0]}\n"                                                            \
  "  - {on: {face: y+, layers: 1}, traction: [0, 3], history: {ramp to: 1}}\n"                                         \
  "  - {on: {face: x+, layers: 1}, %s, history: {%s}}\n"                                                               \
  "solve: {static: {increments: 3, residual: 1e-12, equations: %s%s}}\n"

/** A load that is found does what the same load does when it is given: forces and motions, beside loads of their own time. */
static void a_factor_that_is_found_is_that_which_would_be_given(void **state)
{
  static const char *const loads[] = {"traction: [1, 0.5]", "displacement: [0.002, free]",
                                      "along: {direction: [1, 1], displacement: 0.001}"};
  (void)state;
  for (int n = 0; n < 6; ++n) {
    const char *const load = loads[n / 2], *const equations = n % 2 ? "direct" : "conjugate gradients";
    breccia_model *found =
        model_of(PLATE, load, "controlled: yes", equations,
                 ", control: {displacement of: {nearest: [0.55, 0.05]}, direction: [2, 1], to: 0.003}");
    step(found, INT64_MAX);
    char history[80];
    snprintf(history, sizeof history, "table: [[0, 0], [1, %.17g]]", factor_of(found));
    breccia_model *given = model_of(PLATE, load, history, equations, "");
    step(given, INT64_MAX);
    const Particles *p = found->domain.particles, *q = given->domain.particles;
    const int32_t measured = body_nearest(&found->domain.body, (double[3]){0.55, 0.05, 0});
    const double reached = (2 * p->displacement[0][measured] + p->displacement[1][measured]) / sqrt(5);
    assert_true(fabs(reached - 0.003) < 1e-13);
    for (int k = 0; k < 2; ++k)
      for (int64_t i = 0; i < p->count; ++i)
        assert_true(fabs(p->displacement[k][p->place_of[i]] - q->displacement[k][q->place_of[i]]) < 1e-10);
    breccia_model_destroy(&found);
    breccia_model_destroy(&given);
  }
}

/* Much longer than E G_F / f_t^2, with a weaker part in which all bonds reach their strength at once. */
#define BAR                                                                                                            \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials:\n"                                                                                                       \
  "  strong: &c {model: exponential-softening, density: 2.4, Young modulus: 30 GPa,\n"                                 \
  "              tensile strength: 3 MPa, fracture energy: 40 N/m}\n"                                                  \
  "  weak: {<<: *c, tensile strength: 2.5 MPa}\n"                                                                      \
  "body:\n"                                                                                                            \
  "  left: &b {material: strong, lattice: square, spacing: 10 mm, thickness: 1,\n"                                     \
  "            shape: {box: {from: [0, 0], to: [0.29, 0.05]}}}\n"                                                      \
  "  middle: {<<: *b, material: weak, shape: {box: {from: [0.29, 0], to: [0.31, 0.05]}}}\n"                            \
  "  right: {<<: *b, shape: {box: {from: [0.31, 0], to: [0.6, 0.05]}}}\n"                                              \
  "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}\n"                         \
  "loads:\n"                                                                                                           \
  "  - {on: {face: x-, layers: 3}, roller: [1, 0]}\n"                                                                  \
  "  - {on: {nearest: [0, 0]}, roller: [0, 1]}\n"                                                                      \
  "  - {on: {face: x+, layers: 3}, tie: {directions: x}}\n"                                                            \
  "  - {on: {face: x+, layers: 3}, %s, history: {controlled: yes}}\n"                                                  \
  "solve: {static: {increments: 60,\n"                                                                                 \
  "                 control: {opening between: [[0.255, 0.025], [0.345, 0.025]], to: 0.12 mm}}}\n"

/** A long bar gives off more energy than its crack takes: its end goes back while the crack opens. */
static void a_long_brittle_bar_snaps_back_and_spends_its_fracture_energy(void **state)
{
  static const char *const loads[] = {"force: [1, 0]", "displacement: [0.1 mm, free]"};
  (void)state;
  for (int way = 0; way < 2; ++way) {
    breccia_model *model = model_of(BAR, loads[way]);
    const Domain *d = &model->domain;
    const Particles *p = d->particles;
    const int32_t end = body_nearest(&d->body, (double[3]){0.6, 0.025, 0}),
                  left = body_nearest(&d->body, (double[3]){0.255, 0.025, 0}),
                  right = body_nearest(&d->body, (double[3]){0.345, 0.025, 0});
    double most = 0, farthest = 0, back = 0, force = 0;
    while (!solver_is_done(&model->solver)) {
      step(model, 1);
      const double part = model->solver.clock.time / model->solver.clock.end_time;
      assert_true(fabs(p->displacement[0][right] - p->displacement[0][left] - part * 0.12e-3) < 1e-12);
      force = 0; /* that bonds carry through a cut */
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        if (p->position[0][i] > 0.45) force -= p->volume[i] * p->internal[0][i];
      }
      if (force > most) farthest = p->displacement[0][end];
      most = fmax(most, force);
      back = fmax(back, farthest - p->displacement[0][end]);
    }
    const Energy e = solver_energy(&model->solver);
    assert_true(most > 2.5e3 * 0.05 && most < 3e3 * 0.05); /* strength of the weak part and of the strong ones */
    assert_true(force < 0.05 * most);
    assert_true(back > 0.3 * farthest);
    assert_true(fabs(e.imbalance) < 1e-8);
    assert_true(fabs(e.external / (0.040 * 0.05) - 1) < 0.1); /* what the crack takes */
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_factor_that_is_found_is_that_which_would_be_given),
      cmocka_unit_test(a_long_brittle_bar_snaps_back_and_spends_its_fracture_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

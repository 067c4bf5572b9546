/* Contact in one dimension: bars that meet end to end, against closed forms of waves and of layers in series. */
#include "support.h"

/* Two bars along x, farther apart than the horizon. Modulus, density, spacing, number of particles and first particle
 * of the second bar are arguments. */
#define BARS                                                                                                           \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials:\n  m: {model: elastic-1d, Young modulus: 8e4, density: 2}\n"                                             \
  "  n: {model: elastic-1d, Young modulus: %g, density: %g}\n"                                                         \
  "body:\n  a: {material: m, lattice: line, spacing: 0.1, area: 0.013, shape: {box: {particles: [40, 1], first "       \
  "particle: [-3.95, 0]}}}\n"                                                                                          \
  "  b: {material: n, lattice: line, spacing: %g, area: 0.013, shape: {box: {particles: [%d, 1], first particle: "     \
  "[%g, 0]}}}\n"                                                                                                       \
  "peridynamics: {formulation: bond-based, space: 1-D, horizon: 0.2015}\n"

/** Sums over the particles of one block: mean velocity, internal force, lowest and highest x. */
typedef struct Bar {
  double mass, velocity, force, low, high;
} Bar;

static Bar bar_of(const breccia_model *m, int block)
{
  const Particles *p = m->domain.particles;
  Bar bar = {.low = INFINITY, .high = -INFINITY};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->block[i / SLICE] != block) continue;
    const double mass = p->density[i] * p->volume[i], x = p->position[0][i] + p->displacement.row[0][i];
    bar.mass += mass;
    bar.velocity += mass * p->velocity.row[0][i];
    bar.force += p->internal.row[0][i] * p->volume[i];
    bar.low = fmin(bar.low, x);
    bar.high = fmax(bar.high, x);
  }
  bar.velocity /= bar.mass;
  return bar;
}

/** A bar with velocity v meets a bar at rest of twice its impedance, the same length L and the same wave speed c. By
 *  d'Alembert's solution the bars part after 2 L / c: the first flies back with v / 3, the second on with 2 v / 3. */
static void bars_that_meet_part_as_their_impedances_say(void **state)
{
  (void)state;
  /* E = 160 MPa and a density of 4 t/m3: twice the impedance, the same wave speed of 200 m/s. */
  breccia_model *m = model_of(BARS "contact: {}\nloads: [{on: {block: a}, initial velocity: {translation: [3, 0]}}]\n"
                                   "solve: {explicit: {end time: 0.16, safety: 0.5}}\n",
                              1.6e5, 4.0, 0.1, 40, 0.35);
  const double v = 3, momentum = 3 * bar_of(m, 0).mass, met = 0.3 / v, lasts = 2 * 4.0 / 200;
  while (breccia_model_time(m) < met + 0.5 * lasts) step_surely(m, 1);
  /* During contact the face between the bars moves with v / 3, and the force is rho c A 2 v / 3. */
  const double force = 2 * 200 * 0.013 * 2 * v / 3;
  assert_near(bar_of(m, 1).force, force, 0.1 * force);
  assert_near(bar_of(m, 0).force, -force, 0.1 * force);
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  const Bar a = bar_of(m, 0), b = bar_of(m, 1);
  assert_near(a.velocity, -v / 3, 0.02 * v);
  assert_near(b.velocity, 2 * v / 3, 0.01 * v);
  assert_near(a.mass * a.velocity + b.mass * b.velocity, momentum, 1e-10 * momentum);
  assert_true(b.low > a.high + 0.1);
  assert_balanced(m, 1e-3);
  breccia_model_destroy(&m);
}

/** Contact acts as a layer as thick as the mean spacing, with the harmonic mean of both moduli times the stiffness of
 *  the deck. The force is also that of the layer and both bars in series. */
static void bars_that_are_pressed_together_have_a_layer_between_them(void **state)
{
  (void)state;
  const double stiffness[] = {1, 0.35}, ea = 8e4 * 0.013, mean = 2 * 8e4 * 3e4 / 11e4;
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(BARS "contact: {stiffness: %g}\nloads:\n  - {on: {nearest: [-3.95, 0]}, displacement: [0, 0]}\n"
                      "  - {on: {nearest: [2.5, 0]}, displacement: [-0.37, 0], history: {ramp to: 1}}\n"
                      "solve: {static: {end time: 1, increments: 4, residual: 1e-10}}\n",
                 3e4, 2.7, 0.08, 25, 0.34, stiffness[k]);
    while (!solver_is_done(&m->solver)) step_surely(m, 1);
    const Bar a = bar_of(m, 0), b = bar_of(m, 1);
    const Particles *p = m->domain.particles;
    /* The first bar is held at its left end, whose particle takes the force that goes through the bar. */
    double through = 0;
    for (int64_t n = 0; n < p->count; ++n)
      if (p->position[0][p->place_of[n]] < -3.9)
        through += p->internal.row[0][p->place_of[n]] * p->volume[p->place_of[n]];
    const double gap = (0.1 + 0.08) / 2 - (b.low - a.high), force = stiffness[k] * mean * 0.013 * gap / 0.09;
    assert_true(gap > 0);
    assert_near(-through, force, 1e-6 * force);
    /* Between the particles of their ends the bars are 3.9 and 1.92 long; ends with few bonds are a little softer. */
    const double shorter = force * (3.9 / ea + 1.92 / (3e4 * 0.013));
    const double pushed = 0.37 - (0.34 + 0.05 - 0.09); /* displacement of the last particle after first contact */
    assert_near(shorter, pushed - gap, 0.05 * pushed);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bars_that_meet_part_as_their_impedances_say),
      cmocka_unit_test(bars_that_are_pressed_together_have_a_layer_between_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

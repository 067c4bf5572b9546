/* Bodies of two parts with different densities, particle volumes and stiffnesses, under loads that move all particles
 * alike. A load without the right density or volume strains such a body. */
#include "support.h"

/* Two blocks of one body. */
#define PARTS                                                                                                          \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials:\n  m: {%s, density: 1.7, Young modulus: 1e4}\n  n: {%s, density: 3.1, Young modulus: 2.3e4}\n"           \
  "body:\n  b: {material: m, lattice: square, thickness: 0.27, spacing: 0.1, shape: {box: {from: [-0.3, 0.2], to: "    \
  "[0.2, 0.9]}}}\n"                                                                                                    \
  "  c: {material: n, lattice: square, thickness: 0.27, spacing: %s, shape: {box: {from: [0.2, 0.2], to: [0.6, "       \
  "0.9]}}}\n"                                                                                                          \
  "peridynamics: {formulation: %s, space: plane strain, horizon: 0.215}\n"

#define SOLID "model: elastic, Poisson ratio: 0.2"

static const struct {
  const char *formulation, *law, *spacing;
} kinds[] = {{"bond-based", "model: elastic-1d", "0.05"},
             {"ordinary", SOLID, "0.05"},
             {"correspondence", SOLID, "0.05"},
             {"hybrid", SOLID, "0.1"},
             {"micropolar", SOLID, "0.1"}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static breccia_model *parts(int kind, const char *rest)
{
  return model_of(PARTS "%s", kinds[kind].law, kinds[kind].law, kinds[kind].spacing, kinds[kind].formulation, rest);
}

/** Fails unless the displacement of every particle is (x, y) [length]. */
static void assert_moved(const breccia_model *m, double x, double y, double tolerance)
{
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    assert_near(p->displacement.row[0][p->place_of[n]], x, tolerance);
    assert_near(p->displacement.row[1][p->place_of[n]], y, tolerance);
  }
}

/** Under gravity and base acceleration a free body moves without strain; energies are those of a rigid body. */
static void unlike_parts_fall_as_one(void **state)
{
  (void)state;
  static const char *const solvers[] = {
      "explicit: {end time: 0.02}", "implicit: {end time: 0.02, time step: 2e-3, local error: 1}",
      "implicit: {end time: 0.02, time step: 2e-3, local error: 1, scheme: HHT, alpha: -0.1}"};
  for (int n = 0; n < KINDS * 3; ++n) {
    char rest[512];
    snprintf(rest, sizeof rest,
             "loads: [{gravity: [2, -9.81]}, {base acceleration: [5, 3]}, {initial velocity: {translation: [-0.3, "
             "0.4]}}]\nsolve: {%s}\n",
             solvers[n % 3]);
    breccia_model *m = parts(n / 3, rest);
    step_surely(m, INT64_MAX);
    const double t = 0.02, a[] = {2 - 5, -9.81 - 3}, v[] = {-0.3 + a[0] * t, 0.4 + a[1] * t};
    const double x = -0.3 * t + a[0] * t * t / 2, y = 0.4 * t + a[1] * t * t / 2,
                 mass = 0.27 * 0.7 * (1.7 * 0.5 + 3.1 * 0.4);
    assert_near(breccia_model_time(m), t, 1e-12);
    assert_moved(m, x, y, 1e-9);
    const Sums s = sums_of(m);
    assert_near(s.mass, mass, 1e-9);
    for (int k = 0; k < 2; ++k) assert_near(s.momentum[k], mass * v[k], 1e-8 * mass);
    const Energy e = solver_energy(&m->solver);
    assert_near(e.external, mass * (a[0] * x + a[1] * y), 1e-7);
    assert_near(e.kinetic, mass * (v[0] * v[0] + v[1] * v[1]) / 2, 1e-8);
    assert_balanced(m, 1e-7);
    breccia_model_destroy(&m);
  }
}

/** Mass-proportional damping slows all particles alike, v = v0 exp(-c t), and dissipates the kinetic energy lost. */
static void unlike_parts_are_damped_as_one(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.02, time step: 1e-4, damping: 40}",
                                        "implicit: {end time: 0.02, time step: 2e-4, local error: 1, damping: 40}"};
  for (int n = 0; n < KINDS * 2; ++n) {
    char rest[256];
    snprintf(rest, sizeof rest, "loads: [{initial velocity: {translation: [-0.3, 0.4]}}]\nsolve: {%s}\n",
             solvers[n % 2]);
    breccia_model *m = parts(n / 2, rest);
    step_surely(m, INT64_MAX);
    const double left = exp(-40 * 0.02), moved = (1 - left) / 40;
    assert_moved(m, -0.3 * moved, 0.4 * moved, 1e-4 * moved);
    const Energy e = solver_energy(&m->solver);
    const double before = 0.27 * 0.7 * (1.7 * 0.5 + 3.1 * 0.4) * 0.25 / 2;
    assert_near(e.kinetic, before * left * left, 2e-5 * before);
    assert_near(e.damping, before * (1 - left * left), 2e-4 * before);
    breccia_model_destroy(&m);
  }
}

/** A spring on all particles distributes its stiffness by volume, as a body force does its force: in equilibrium every
 *  displacement is force over stiffness. A spring that a second stage adds begins without force. */
static void unlike_parts_hang_from_springs_as_one(void **state)
{
  (void)state;
  for (int n = 0; n < KINDS; ++n) {
    breccia_model *m =
        parts(n, "loads:\n  - {on: {all: yes}, body force: [3, -5]}\n  - {on: {all: yes}, spring: {stiffness: 700}}\n"
                 "solve:\n  - {static: {end time: 1, increments: 1, residual: 1e-11}}\n"
                 "  - {static: {end time: 1, increments: 1, residual: 1e-11}, loads: [{on: {all: yes}, spring: "
                 "{stiffness: 300}}, "
                 "{on: {all: yes}, body force: [1, 2]}]}\n");
    const double volume = 0.27 * 0.7 * 0.9;
    step_surely(m, 1);
    assert_moved(m, 3 * volume / 700, -5 * volume / 700, 1e-8);
    step_surely(m, INT64_MAX);
    assert_moved(m, 3 * volume / 700 + volume / 1000, -5 * volume / 700 + 2 * volume / 1000, 1e-8);
    const double u[] = {3 * volume / 700, -5 * volume / 700}, more[] = {volume / 1000, 2 * volume / 1000};
    double stored = 0;
    for (int k = 0; k < 2; ++k) stored += 350 * (u[k] + more[k]) * (u[k] + more[k]) + 150 * more[k] * more[k];
    assert_near(solver_energy(&m->solver).stored, stored, 1e-6 * stored);
    breccia_model_destroy(&m);
  }
}

/** A force that is distributed by volume strains parts of different densities, but the total momentum is the impulse of
 *  the force. */
static void forces_in_all_move_the_common_centre(void **state)
{
  (void)state;
  for (int n = 0; n < KINDS; ++n) {
    breccia_model *m = parts(n, "loads:\n  - {on: {face: x+, layers: 2}, force: [2, -3], history: {ramp to: 0.01}}\n"
                                "  - {on: {block: b}, body force: [0, 4]}\nsolve: {explicit: {end time: 0.02}}\n");
    step_surely(m, INT64_MAX);
    const Sums s = sums_of(m);
    const double t = breccia_model_time(m), push = t - 0.005;
    assert_near(s.momentum[0], 2 * push, 2e-3 * 2 * push);
    assert_near(s.momentum[1], -3 * push + 4 * 0.27 * 0.7 * 0.5 * t, 2e-3 * 3 * push);
    assert_balanced(m, 2e-3);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unlike_parts_fall_as_one),
      cmocka_unit_test(unlike_parts_are_damped_as_one),
      cmocka_unit_test(unlike_parts_hang_from_springs_as_one),
      cmocka_unit_test(forces_in_all_move_the_common_centre),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Prestressed bars, against closed forms of sections, beams and bond. */
#include "support.h"

#include "bars/bars.h"

#define UNITS "units: {length: m, force: MN, time: s}\n"
#define ROD "rod: {model: elastic, density: 7, Young modulus: 2e5, Poisson ratio: 0.3}"
#define STEEL "rod: {model: steel-bilinear, density: 7, Young modulus: 2e5, yield stress: %g, hardening ratio: 0.01}"

static Bars *bars_of(breccia_model *m)
{
  for (int k = 0; k < m->domain.forces.count; ++k)
    if (!strcmp(m->domain.forces.type[k]->name, "bars")) return m->domain.forces.own[k];
  fail_msg("no bars");
  return NULL;
}

/** A slender body of concrete in plane stress, 4 m by 0.44 m and 0.2 m thick to its faces, with a bar at a height. */
static breccia_model *beam(const char *steel, double height, const char *bar, const char *loads, const char *solve,
                           int threads)
{
  return model_on(
      threads,
      UNITS "materials:\n  concrete: {model: elastic, density: 2.4e-3, Young modulus: 3e4, Poisson ratio: 0.2}\n  %s\n"
            "body: {b: {material: concrete, lattice: square, spacing: 0.04, thickness: 0.2, shape: {box: {particles: "
            "[100, 11], first particle: [0, 0]}}}}\n"
            "peridynamics: {space: plane stress, formulation: ordinary, horizon: 2.015 spacings}\n"
            "bars: {tendon: {points: [[0, %g], [3.96, %g]], area: 1e-3, material: rod%s}}\n"
            "loads:\n  - {on: {nearest: [1.96, 0.2]}, displacement: [0, 0]}\n  - {on: {nearest: [2.0, 0.2]}, "
            "displacement: [free, 0]}\n  - %s\n"
            "solve: %s\npictures: []\n",
      steel, height, height, bar, loads, solve);
}

static double stress_in(const Bars *b, double x)
{
  const double point[3] = {x, b->node[0][1], 0};
  return b->stress_held[bar_nearest(b, 0, point)];
}

static double displacement_at(const breccia_model *m, int k, double x, double y)
{
  return m->domain.particles->displacement.row[k][particles_nearest(m->domain.particles, (double[]){x, y, 0})];
}

/** Force P before the concrete gives way: stress P / (A_c + n A_s) in the concrete, n times that less in the bar. */
static void a_bar_in_the_middle_presses_the_transformed_section(void **state)
{
  (void)state;
  static const char *const loads[] = {"{prestress: {bars: [tendon], stress: 1000}}",
                                      "{prestress: {bars: [tendon], strain: 5e-3}, history: {ramp to: 1}}"};
  static const char *const steels[] = {
      ROD, "rod: {model: steel-bilinear, density: 7, Young modulus: 2e5, yield stress: 5000, hardening ratio: 0.01}"};
  for (int n = under_sanitizers() ? 3 : 0; n < 4; ++n) {
    breccia_model *m =
        beam(steels[n / 2], 0.2, "", loads[n % 2], "{static: {increments: 2, end time: 1, residual: 1e-9}}", 1);
    step_surely(m, INT64_MAX);
    const Bars *b = bars_of(m);
    const double concrete = 0.44 * 0.2, ratio = 2e5 / 3e4, steel = 1e-3;
    const double pressed = -1000 * steel / (concrete + ratio * steel);
    const double point[3] = {1.6, 0.2, 0}, strain = b->line_strain[bar_nearest(b, 0, point)];
    assert_near(3e4 * strain, pressed, 0.05 * fabs(pressed));
    assert_near(stress_in(b, 1.6), 1000 + ratio * pressed, 0.005 * 1000);
    /* what the body and the bar hold came from the prestress */
    const Energy e = solver_energy(&m->solver);
    assert_near(e.stored, 0.5 * 3.96 * steel * 1000 * (1000 + ratio * pressed) / 2e5, 0.02 * e.stored);
    assert_balanced(m, 1e-4);
    breccia_model_destroy(&m);
  }
}

/** Straight and off the axis: the beam bends upwards by M l^2 / (8 E I), of the transformed section. */
static void a_bar_below_the_axis_lifts_the_middle(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* a bar in the middle is the same code */
  breccia_model *m = beam(ROD, 0.06, "", "{prestress: {bars: [tendon], stress: 1000}}", "{static: {increments: 1}}", 1);
  step_surely(m, INT64_MAX);
  const double steel = 1e-3, more = (2e5 / 3e4) * steel, area = 0.44 * 0.2, below = 0.2 - 0.06;
  const double axis = more * below / (area + more), lever = below - axis; /* of the transformed section */
  const double inertia = 0.2 * pow(0.44, 3) / 12 + area * axis * axis + more * lever * lever;
  const double from = 0.48, to = 3.48, length = to - from;
  const double camber = 1000 * steel * lever * length * length / (8 * 3e4 * inertia);
  const double ends = (displacement_at(m, 1, from, 0.2) + displacement_at(m, 1, to, 0.2)) / 2;
  const double found = displacement_at(m, 1, (from + to) / 2, 0.2) - ends;
  assert_near(found, camber, 0.03 * camber);
  breccia_model_destroy(&m);
}

/** Bond that grows with slip, in concrete that does not move: s = -p sinh(lambda x) / (lambda cosh(lambda l / 2)). */
static void stress_builds_up_along_the_transfer_length(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  " ROD "\n"
            "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1.2, 0.2, 0.2]}}}}\n"
            "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
            "bars: {bar: {points: [[0, 0.1, 0.1], [1.2, 0.1, 0.1]], area: 1e-4, material: rod, bond: {law: linear, "
            "stiffness: 1.4e4}}}\n"
            "loads: [{on: {all: yes}, displacement: [0, 0, 0]}, {prestress: {bars: [bar], stress: 1200}}]\n"
            "solve: {static: {increments: 1}}\npictures: []\n");
  step_surely(m, INT64_MAX);
  const Bars *b = bars_of(m);
  const double pi = acos(-1), around = pi * sqrt(4 / pi * 1e-4), l = 1.2, lambda = sqrt(1.4e4 * around / (2e5 * 1e-4)),
               strain = 1200 / 2e5;
  for (int64_t k = 0; k <= b->count; ++k) {
    const double x = b->node[k][0] - l / 2;
    assert_near(b->slips->slip_held[k], -strain * sinh(lambda * x) / (lambda * cosh(lambda * l / 2)),
                0.01 * strain / lambda);
  }
  for (int64_t e = 0; e < b->count; ++e) {
    const double x = (b->node[e][0] + b->node[e + 1][0]) / 2 - l / 2;
    assert_near(b->stress_held[e], 1200 * (1 - cosh(lambda * x) / cosh(lambda * l / 2)), 0.01 * 1200);
  }
  assert_balanced(m, 1e-6);
  breccia_model_destroy(&m);
}

/** Tensioned in a second stage, over time, and taken away in a third. */
static void bars_are_tensioned_in_a_stage(void **state)
{
  (void)state;
  breccia_model *m = beam(ROD, 0.2, "", "{on: {nearest: [0, 0]}, force: [0, 0]}",
                          "\n  - {static: {increments: 1, end time: 1}}\n"
                          "  - {static: {increments: 2, end time: 1}, loads: [{name: jack, prestress: {bars: [tendon], "
                          "stress: 600}, history: {ramp to: 1}}]}\n"
                          "  - {static: {increments: 1, end time: 1}, without: [jack]}",
                          1);
  const Bars *b = bars_of(m);
  const double left = 1 / (1 + 2e5 / 3e4 * 1e-3 / 0.088), wanted[] = {0, 300 * left, 600 * left, 0};
  for (int step = 0; step < 4; ++step) {
    step_surely(m, 1);
    assert_near(stress_in(b, 1.6), wanted[step], 0.005 * 600);
  }
  assert_balanced(m, 1e-4);
  breccia_model_destroy(&m);
}

static void its_work_is_in_the_books_of_every_solver(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 3, end time: 1e-3}",
                                        "implicit: {time step: 2e-5 s, end time: 4e-3}", "explicit: {end time: 2e-3}"};
  static const char *const bars[] = {"", ", bond: {law: linear, stiffness: 1e5}"};
  char steel[200];
  snprintf(steel, sizeof steel, STEEL, 800.0);
  for (size_t n = 0; n < 6; ++n) {
    if (under_sanitizers() && n % 2 != n / 2 % 2) continue; /* each solver, and both bars */
    char solve[100];
    snprintf(solve, sizeof solve, "{%s}", solvers[n / 2]);
    breccia_model *m = beam(steel, 0.06, bars[n % 2],
                            "{prestress: {bars: [tendon], strain: 5e-3}, history: {ramp to: 1e-3}}", solve, 1);
    step_surely(m, under_sanitizers() ? 20 : INT64_MAX);
    const Energy e = solver_energy(&m->solver);
    const BarReport r = bar_report(bars_of(m), 0);
    if (!under_sanitizers()) assert_true(r.dissipated > 0.05 * e.external); /* it yields */
    assert_balanced(m, n < 2 ? 1e-3 : 2e-3);
    breccia_model_destroy(&m);
  }
}

static const char *solver_under_way;

static breccia_model *with_threads(int threads)
{
  return beam(ROD, 0.06, ", bond: {law: linear, stiffness: 1e5}",
              "{prestress: {bars: [tendon], strain: 5e-3}, history: {ramp to: 1e-3}}", solver_under_way, threads);
}

static void bits_do_not_depend_on_threads_or_restarts(void **state)
{
  (void)state;
  solver_under_way = "{explicit: {end time: 2e-3}}";
  assert_same_bits_by_threads_and_restart(with_threads, 10, 25);
  if (under_sanitizers()) return; /* a bar tensioned in a stage walks the static solver */
  solver_under_way = "{static: {increments: 5, end time: 1e-3}}";
  assert_same_bits_by_threads_and_restart(with_threads, 2, 4);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bar_in_the_middle_presses_the_transformed_section),
      cmocka_unit_test(a_bar_below_the_axis_lifts_the_middle),
      cmocka_unit_test(stress_builds_up_along_the_transfer_length),
      cmocka_unit_test(bars_are_tensioned_in_a_stage),
      cmocka_unit_test(its_work_is_in_the_books_of_every_solver),
      cmocka_unit_test(bits_do_not_depend_on_threads_or_restarts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

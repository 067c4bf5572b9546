/* Reinforced concrete at rest through its cracks: several of them open at once, and the body jumps from one state of rest to the next. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STEEL                                                                                                          \
  "  steel: {model: steel-bilinear, density: 7.85 t/m3, Young modulus: 200 GPa, yield stress: 500 MPa, "               \
  "hardening ratio: 1e-3}\n"

/** What the load of a number exerts along an axis. */
static double exerted(const breccia_model *m, int load, int axis)
{
  const Particles *p = m->domain.particles;
  const Load *l = &m->loading.loads[load];
  double sum = 0;
  for (int64_t n = 0; n < l->selection.count; ++n)
    sum -= p->internal.row[axis][l->selection.places[n]] * p->volume[l->selection.places[n]];
  return sum;
}

/** 300 mm by 100 mm and 100 mm thick, with a bar of 16 mm; drawn to 1.1 times its yield strain, slowly until it has cracked. */
static breccia_model *tie_of(const char *law, const char *formulation)
{
  return model_of("units: {length: mm, force: N, time: s}\n"
                  "materials:\n"
                  "  concrete: {%s, density: 2.4 t/m3, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture "
                  "energy: 100 N/m}\n" STEEL
                  "body: {tie: {material: concrete, spacing: 12.5, lattice: square, thickness: 100, shape: {box: "
                  "{from: [0, 0], to: [300, 100]}}}}\n"
                  "peridynamics: {formulation: %s, space: plane stress}\n"
                  "bars: {bar: {points: [[0, 50], [300, 50]], diameter: 16, material: steel}}\n"
                  "loads:\n"
                  "  - {on: {face: x-, layers: 3}, displacement: [-0.42, free], history: {table: [[0, 0], [0.5, "
                  "0.07], [1, 1]]}}\n"
                  "  - {on: {face: x+, layers: 3}, displacement: [0.42, free], history: {table: [[0, 0], [0.5, 0.07], "
                  "[1, 1]]}}\n"
                  "  - {on: {nearest: [6.25, 50]}, displacement: [free, 0]}\n"
                  "  - {on: {nearest: [293.75, 50]}, displacement: [free, 0]}\n"
                  "solve: {static: {increments: 20}}\n",
                  law, formulation);
}

/** The whole section carries the tie to its first crack, steel alone in the end. */
static void a_tie_cracks_by_its_section_and_yields_by_its_steel(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* bars in a cracked beam, and control that fades (test_fading), are the same code */
  const double steel = acos(-1) / 4 * 16 * 16, concrete = 100 * 100;
  const double cracks_at = 3 * (concrete + 200.0 / 30 * steel), yields_at = 500 * steel;
  breccia_model *m = tie_of("model: mazars, Poisson ratio: 0.2", "correspondence");
  double first = 0;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    if (m->solver.clock.time < 0.51)
      first = fmax(first, exerted(m, 1, 0));
    else if (!whole_walks())
      break; /* the way to the yield of the steel takes half a minute */
  }
  const double last = exerted(m, 1, 0), other = -exerted(m, 0, 0);
  print_message("tie: cracks at %.3f of f_t (A_c + n A_s), ends with %.4f of f_y A_s\n", first / cracks_at,
                last / yields_at);
  assert_true(first > 0.93 * cracks_at && first < 1.02 * cracks_at);
  if (whole_walks())
    assert_near(last, yields_at, 0.03 * yields_at); /* concrete beside the cracks at the grips still presses */
  assert_near(last, other, 1e-6 * yields_at);
  breccia_model_destroy(&m);
}

/** Two columns of nearly one strength, both of which begin to soften: the weaker one opens, and takes the fracture energy of one crack. */
static void of_two_weak_columns_one_opens(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* test_fading walks the same code */
  char blocks[5][200];
  static const char *const material[] = {"c", "w", "c", "v", "c"};
  const int count[] = {8, 1, 10, 1, 8}, first[] = {0, 8, 9, 19, 20};
  for (int k = 0; k < 5; ++k)
    snprintf(blocks[k], sizeof blocks[k],
             "{material: %s, spacing: 0.01, lattice: square, thickness: 1, shape: {box: {particles: [%d, 5], first "
             "particle: [%g, 0]}}}",
             material[k], count[k], 0.01 * first[k]);
#define CONCRETE                                                                                                       \
  "{density: 2.4, model: mazars, Poisson ratio: 0.2, Young modulus: 30e6, fracture energy: 0.1, tensile strength: "
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials:\n  c: " CONCRETE "3000}\n  w: " CONCRETE "2700}\n  v: " CONCRETE "2720}\n"
                              "body:\n  a: %s\n  b: %s\n  c: %s\n  d: %s\n  e: %s\n"
                              "peridynamics: {formulation: correspondence, space: plane stress}\n"
                              "loads:\n"
                              "  - {on: {face: x-, layers: 3}, displacement: [0, free]}\n"
                              "  - {on: {face: x+, layers: 3}, displacement: [3e-4, free], history: {ramp to: 1}}\n"
                              "  - {on: {nearest: [0, 0.02]}, displacement: [free, 0]}\n"
                              "  - {on: {nearest: [0.27, 0.02]}, displacement: [free, 0]}\n"
                              "solve: {static: {increments: 30}}\n",
                              blocks[0], blocks[1], blocks[2], blocks[3], blocks[4]);
  double most = 0;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    most = fmax(most, exerted(m, 1, 0));
  }
  const double left = exerted(m, 1, 0) / most, spent = solver_energy(&m->solver).external / 0.05 / 0.1;
  print_message("two weak columns: %.4f of the largest force left, %.3f G_F\n", left, spent);
  assert_true(fabs(left) < 0.05);
  assert_true(spent > 0.9 && spent < 1.1);
  breccia_model_destroy(&m);
}

/** 800 mm by 160 mm and 100 mm thick, on supports 660 mm apart, pressed in its middle; a bar of 8 mm, 30 mm above its lower face. Steel that yields and the
 *  pressed concrete above the crack make a moment between that of the cracked elastic section and that of its whole effective depth. */
static void a_beam_cracks_and_bears_what_its_steel_does(void **state)
{
  (void)state;
  if (under_sanitizers()) skip();
  breccia_model *m = model_of(
      "units: {length: mm, force: N, time: s}\n"
      "materials:\n"
      "  concrete: {model: bilinear-softening, density: 2.4 t/m3, Young modulus: 30 GPa, tensile strength: 3 MPa, "
      "fracture energy: 100 N/m}\n" STEEL
      "body: {beam: {material: concrete, spacing: 20, lattice: square, thickness: 100, shape: {box: {from: [0, 0], to: "
      "[800, 160]}}}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress}\n"
      "bars: {bar: {points: [[0, 30], [800, 30]], diameter: 8, material: steel}}\n"
      "loads:\n"
      "  - {on: {inside: {box: {from: [60, 0], to: [80, 20]}}}, displacement: [free, 0]}\n"
      "  - {on: {inside: {box: {from: [380, 140], to: [420, 160]}}}, displacement: [free, -3], history: {ramp to: 1}}\n"
      "  - {on: {inside: {box: {from: [720, 0], to: [740, 20]}}}, displacement: [free, 0]}\n"
      "  - {on: {nearest: [400, 160]}, displacement: [0, free]}\n"
      "solve: {static: {increments: 10}}\n");
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  const double steel = acos(-1) / 4 * 8 * 8, depth = 130, ratio = 200.0 / 30 * steel / (100 * depth);
  const double pressed = depth * (sqrt(ratio * ratio + 2 * ratio) - ratio);
  const double force = -exerted(m, 1, 1), moment = force / 2 * (390 - 70), low = 500 * steel * (depth - pressed / 3),
               high = 500 * steel * depth;
  print_message("beam: %.3f of the moment of the cracked section, %.3f of that of the whole depth\n", moment / low,
                moment / high);
  assert_true(moment > 0.95 * low && moment < 1.1 * high);
  assert_near(exerted(m, 0, 1), force / 2, 0.01 * force);
  breccia_model_destroy(&m);
}

/** The last number of an iteration of Newton's method that a log tells, before others take over. */
static int last_iteration(const char *log)
{
  int last = 0;
  const char *end = strstr(log, "by dynamic relaxation");
  for (const char *at = strstr(log, "iteration "); at && (!end || at < end); at = strstr(at + 1, "iteration "))
    last = atoi(at + strlen("iteration "));
  return last;
}

static breccia_model *beam_in_even_bending(const char *solver)
{
  return model_of(
      "units: {length: mm, force: N, time: s}\n"
      "materials:\n"
      "  concrete: {model: exponential-softening, density: 2.4 t/m3, Young modulus: 33 GPa, tensile strength: 2.9 MPa, "
      "fracture energy: 140 N/m}\n" STEEL
      "body: {beam: {material: concrete, spacing: 20, lattice: square, thickness: 150, shape: {box: {from: [0, 0], "
      "to: [1600, 200]}}}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress}\n"
      "bars: {bar: {points: [[30, 40], [1570, 40]], diameter: 16, number: 2, material: steel}}\n"
      "loads:\n"
      "  - {on: {inside: {box: {from: [80, 0], to: [120, 20]}}}, displacement: [0, 0]}\n"
      "  - {on: {inside: {box: {from: [480, 180], to: [520, 200]}}}, displacement: [free, -1.2], history: {ramp to: "
      "1}}\n"
      "  - {on: {inside: {box: {from: [1080, 180], to: [1120, 200]}}}, displacement: [free, -1.2], history: {ramp to: "
      "1}}\n"
      "  - {on: {inside: {box: {from: [1480, 0], to: [1520, 20]}}}, displacement: [free, 0]}\n"
      "solve: {static: {increments: 8, residual: 1e-6, %s}}\n",
      solver);
}

/** Under an even moment many cracks open at once, and bonds soften and unload in turn: Newton's method had taken two hundred secants in an increment
 *  before another way was asked. Equations that become hard to solve tell sooner than secants do; factors never become so. What is found is the state of
 *  rest that relaxation alone finds. */
static void a_beam_in_even_bending_is_left_to_relaxation(void **state)
{
  (void)state;
  static const char *const equations[] = {"equations: minimal residuals", "equations: direct"};
  const int allowed[] = {5, 20}; /* iterations */
  for (int k = 0; k < (under_sanitizers() ? 1 : 2); ++k) {
    breccia_model *newton = beam_in_even_bending(equations[k]),
                  *relaxation = beam_in_even_bending("method: relaxation");
    int left = 0, most = 0;
    double peak = 0;
    while (!solver_is_done(&newton->solver) && !(under_sanitizers() && left > 0)) {
      step_surely(newton, 1);
      const char *log = text_words(&newton->solver.log);
      left += strstr(log, "left to other ways") != NULL;
      most = last_iteration(log) > most ? last_iteration(log) : most;
      while (relaxation->solver.clock.time < newton->solver.clock.time - 1e-9) step_surely(relaxation, 1);
      peak = fmax(peak, fabs(exerted(relaxation, 1, 1)));
      assert_near(exerted(newton, 1, 1), exerted(relaxation, 1, 1), 1e-3 * peak);
    }
    print_message("%s: %d increments left to relaxation, %d iterations of Newton's method at most\n", equations[k],
                  left, most);
    assert_true(left > 0 && most <= allowed[k]);
    assert_true(newton->solver.records[0].relaxed == left);
    breccia_model_destroy(&newton);
    breccia_model_destroy(&relaxation);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_tie_cracks_by_its_section_and_yields_by_its_steel),
                                     cmocka_unit_test(of_two_weak_columns_one_opens),
                                     cmocka_unit_test(a_beam_cracks_and_bears_what_its_steel_does),
                                     cmocka_unit_test(a_beam_in_even_bending_is_left_to_relaxation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The force in all that loads and supports exert, the largest and at the end: against closed forms of rods, springs
 * and waves. */
#include "support.h"

#include "model/run.h"
#include "solver/resultants.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ROD "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 5, 4]}}}}\n"

enum { MOST = 8 };

static void find(const breccia_model *model, Resultant *list)
{
  assert_true(model->loading.count <= MOST);
  assert_int_equal(resultants_find(&model->solver, list, NULL), 0);
}

static void assert_force(const double *force, double x, double y, double z, double tolerance)
{
  assert_near(force[0], x, tolerance);
  assert_near(force[1], y, tolerance);
  assert_near(force[2], z, tolerance);
}

/** A pull of 1 kPa on 0.2 m2 that doubles, halves and ends, a lift beside it, and a weight that comes later. */
static void supports_bear_the_most_where_loads_are_largest(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS SOFT_SOLID ROD
      "loads:\n"
      "  - {name: base, on: {face: x-}, displacement: [0, 0, 0]}\n"
      "  - {name: pull, on: {face: x+}, traction: [1, 0, 0], history: {table: [[0, 0], [0.5, 2], [1, 1]]}}\n"
      "  - {name: later, on: {face: y+}, force: [0, 0, 3]}\n"
      "  - {name: strain, initial strain: 1e-5}\n"
      "solve: [{static: {increments: 4, residual: 1e-10}}, {static: {increments: 2, residual: 1e-10}, without: [pull], "
      "loads: [{name: weight, gravity: [0, 0, -40]}]}]\n");
  const double tolerance = 1e-8, weight = 2 * 40 * 0.8 * 0.5 * 0.4;
  Resultant r[MOST];
  step_surely(model, 4);
  find(model, r);
  assert_true(r[0].exerts && r[1].exerts && !r[3].exerts);
  assert_force(r[0].now, -0.2, 0, -3, tolerance);
  assert_force(r[0].largest, -0.4, 0, -3, tolerance);
  assert_force(r[1].now, 0.2, 0, 0, tolerance);
  assert_force(r[1].largest, 0.4, 0, 0, tolerance);
  assert_force(r[2].now, 0, 0, 3, tolerance);
  assert_true(isnan(r[1].time));
  assert_near(r[0].time, 0.5, 1e-12);
  assert_true(r[4].exerts);
  assert_force(r[4].largest, 0, 0, 0, 0);
  step_surely(model, INT64_MAX);
  find(model, r);
  assert_force(r[0].now, 0, 0, weight - 3, tolerance);
  assert_force(r[0].largest, 0, 0, weight - 3, tolerance);
  assert_true(r[0].time >= 1.5 && r[0].time <= 2); /* the weight comes with the first increment */
  assert_force(r[1].now, 0, 0, 0, 0);
  assert_force(r[1].largest, 0.4, 0, 0, tolerance);
  assert_force(r[4].now, 0, 0, -weight, tolerance);
  breccia_model_destroy(&model);
}

/** Two blocks: one hangs from a spring to the ground, the other from one to a block that is held. */
static void springs_exert_what_hangs_from_them(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS SOFT_SOLID
               "body:\n"
               "  a: {material: m, spacing: 0.1, shape: {box: {particles: [3, 3, 3], first particle: [0, 0, 0]}}}\n"
               "  b: {material: m, spacing: 0.1, shape: {box: {particles: [3, 3, 3], first particle: [1, 0, 0]}}}\n"
               "  c: {material: m, spacing: 0.1, shape: {box: {particles: [3, 3, 3], first particle: [2, 0, 0]}}}\n"
               "loads:\n"
               "  - {name: wall, on: {block: a}, displacement: [0, 0, 0]}\n"
               "  - {on: {block: b}, displacement: [free, 0, 0]}\n"
               "  - {on: {block: c}, displacement: [free, 0, 0]}\n"
               "  - {name: tie, on: {block: b}, spring: {stiffness: 50, to: {block: a}}}\n"
               "  - {name: ground, on: {block: c}, spring: {stiffness: 20}}\n"
               "  - {on: {block: b}, force: [2, 0, 0]}\n"
               "  - {on: {block: c}, force: [-3, 0, 0], history: {ramp to: 1}}\n"
               "solve: {static: {increments: 2, residual: 1e-10}}\n");
  Resultant r[MOST];
  step_surely(model, INT64_MAX);
  find(model, r);
  assert_force(r[0].now, -2, 0, 0, 1e-8); /* holds what the spring pulls it with */
  assert_force(r[3].now, -2, 0, 0, 1e-8);
  assert_force(r[4].now, 3, 0, 0, 1e-8);
  assert_force(r[4].largest, 3, 0, 0, 1e-8);
  assert_near(r[4].time, 1, 1e-12);
  Text words = {0};
  run_tell_loads(model, &words);
  const char *body = strstr(text_words(&words), "force in all on the body"),
             *between = strstr(text_words(&words), "force in all on the first end of springs between two parts");
  const char *tie = strstr(text_words(&words), "  load 'tie': [-2, 0, 0]");
  const char *ground = strstr(text_words(&words), "  load 'ground': [3, 0, 0]");
  if (!(body && between && tie && ground && body < ground && ground < between && between < tie))
    fail_msg("%s", text_words(&words));
  text_free(&words);
  breccia_model_destroy(&model);
}

/** A bar of density 2, waves of 200 m/s and 1 m2 that is pushed by 1 mm/s for a while: impedance times speed, at one
 * end and then the other. */
static void waves_push_what_moves_the_bar_and_then_the_dashpots(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.3}", "implicit: {end time: 0.3, time step: 1e-3}"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model =
        model_of(UNITS "materials: {m: {model: elastic-1d, Young modulus: 8e4, density: 2}}\n"
                       "body: {bar: {material: m, lattice: line, spacing: 0.125, area: 1, shape: {box: {particles: "
                       "[160, 1], first particle: [0.0625, 0]}}}}\n"
                       "peridynamics: {formulation: bond-based, space: 1-D}\n"
                       "loads:\n"
                       "  - {name: push, on: {face: x-}, velocity: [1e-3, free], history: {table: [[0, 0], [0.03, 1], "
                       "[0.07, 1], [0.1, 0]]}}\n"
                       "  - {name: away, on: {face: x+}, dashpots: {}}\n"
                       "solve: {%s}\n",
                 solvers[k]);
    const double force = 2 * 200 * 1e-3;
    Resultant r[MOST];
    while (breccia_model_time(model) < 0.05) step_surely(model, 1);
    find(model, r);
    assert_force(r[0].now, force, 0, 0, 0.03 * force);
    assert_force(r[1].now, 0, 0, 0, 0.01 * force);
    while (breccia_model_time(model) < 0.15) step_surely(model, 1);
    find(model, r);
    assert_force(r[1].now, -force, 0, 0, 0.03 * force);
    step_surely(model, INT64_MAX);
    find(model, r);
    for (int end = 0; end < 2; ++end) {
      assert_force(r[end].now, 0, 0, 0, 0.02 * force);
      assert_force(r[end].largest, end ? -force : force, 0, 0, 0.04 * force);
      assert_true(r[end].time > 0.02 + 0.1 * end && r[end].time < 0.08 + 0.1 * end);
    }
    breccia_model_destroy(&model);
  }
}

/** The largest force is taken over all steps, not over a sample: a bar is struck by a motion that lasts few steps. */
static void the_largest_of_explicit_steps_misses_none(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS "materials: {m: {model: elastic-1d, Young modulus: 8e4, density: 2}}\n"
                     "body: {bar: {material: m, lattice: line, spacing: 0.125, area: 1, shape: {box: {particles: "
                     "[40, 1], first particle: [0.0625, 0]}}}}\n"
                     "peridynamics: {formulation: bond-based, space: 1-D}\n"
                     "loads:\n"
                     "  - {name: blow, on: {face: x-}, velocity: [1e-3, free], history: {table: [[0, 0], [1e-3, 1], "
                     "[2e-3, 0]]}}\n"
                     "solve: {explicit: {time step: 2e-4, steps: 95}}\n");
  Resultant r[MOST];
  double largest = 0;
  for (int step = 0; step < 95; ++step) {
    step_surely(model, 1);
    find(model, r);
    largest = larger_of(largest, fabs(r[0].now[0]));
  }
  assert_true(largest > 0.2); /* the exact value is 0.4, impedance times speed */
  assert_near(fabs(r[0].largest[0]), largest, 1e-8 * largest);
  breccia_model_destroy(&model);
}

/** What acts on the corner of three planes of symmetry, beside a spring. */
static breccia_model *corner(int threads)
{
  return model_on(
      threads, UNITS SOFT_SOLID ROD
      "loads:\n"
      "  - {name: wall, on: {face: x-}, support: {held: across}}\n"
      "  - {name: floor, on: {face: z-}, support: {held: across}}\n"
      "  - {name: push, on: {face: x+}, velocity: [-0.1, free, free], history: {sine: {frequency: 90 Hz}}}\n"
      "  - {name: bed, on: {face: y-}, spring: {stiffness: 200}}\n"
      "  - {name: weight, gravity: [0, 0, -10]}\n"
      "solve: {explicit: {steps: 75}}\n");
}

static void the_largest_is_the_same_to_the_bit_after_a_restart(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(corner, 33, 72);
  breccia_model *model = corner(1);
  Resultant r[MOST];
  step_surely(model, 72);
  find(model, r);
  for (int l = 0; l < 4; ++l) { /* each has been larger before */
    double largest = 0, now = 0;
    for (int k = 0; k < 3; ++k) {
      largest += pow(r[l].largest[k], 2);
      now += pow(r[l].now[k], 2);
    }
    assert_true(largest > 0 && largest >= now);
  }
  breccia_model_destroy(&model);
}

/** Where several supports mirror, forces are summed at every tenth explicit step: words say so of explicit stages, and
 * not of bodies that were only at rest. */
static void words_say_when_the_largest_is_of_every_tenth_step(void **state)
{
  (void)state;
  static const struct {
    const char *solve;
    bool every_tenth;
  } cases[] = {{"{static: {increments: 2}}", false},
               {"{explicit: {steps: 20}}", true},
               {"[{static: {increments: 2}}, {explicit: {steps: 20}}]", true},
               {"[{explicit: {steps: 20}}, {static: {increments: 2}}]", true}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        UNITS SOFT_SOLID ROD "loads: [{name: left, on: {face: x-}, support: {held: across}}, {name: below, on: {face: "
                             "z-}, support: {held: across}}, {on: {face: y-}, support: {held: across}}, {name: pull, "
                             "on: {face: x+}, traction: [1, 0, 0]}]\nsolve: %s\npictures: []\n",
        cases[k].solve);
    step_surely(m, INT64_MAX);
    Text words = {0};
    run_tell_loads(m, &words);
    const bool told = strstr(text_words(&words), "the largest (of explicit steps every tenth) and at the end") != NULL;
    if (told != cases[k].every_tenth) fail_msg("%s: %s", cases[k].solve, text_words(&words));
    text_free(&words);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(words_say_when_the_largest_is_of_every_tenth_step),
      cmocka_unit_test(supports_bear_the_most_where_loads_are_largest),
      cmocka_unit_test(springs_exert_what_hangs_from_them),
      cmocka_unit_test(waves_push_what_moves_the_bar_and_then_the_dashpots),
      cmocka_unit_test(the_largest_of_explicit_steps_misses_none),
      cmocka_unit_test(the_largest_is_the_same_to_the_bit_after_a_restart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Patches under rigid plates that turn freely: against superposed fields of displacement, statics of rigid bodies, and
 * energy in motion. */
#include "support.h"

#include "solver/reactions.h"
#include "solver/resultants.h"

#define MATERIAL                                                                                                       \
  "units: {length: mm, force: kN, time: ms}\n"                                                                         \
  "materials: {m: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}\n"
/* A beam on two supports, with the jack beside its middle. The support that holds along x is a particle beside one that
 * does not. */
#define BEAM                                                                                                           \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [400, "        \
  "80]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress}\n"                                                 \
  "selections: {jack: {face: y+, inside: {box: {from: [80, 0], to: [150, 80]}}}}\n"                                    \
  "loads:\n  - {on: {nearest: [5, 5]}, displacement: [0, 0]}\n  - {on: {nearest: [395, 5]}, displacement: [free, "     \
  "0]}\n"

/** Returns force and moment of a load about the middle of its particles as they stand. */
static Wrench wrench_of(breccia_model *model, const char *load)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, model->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &model->solver, NULL, load, NULL);
  reactions_destroy(&reactions);
  return sum;
}

/** Returns the displacement at the end of a run along y of the particle nearest to a point. */
static double moved_at(const breccia_model *m, double x, double y)
{
  const Particles *p = m->domain.particles;
  return p->displacement.row[1][particles_nearest(p, (double[]){x, y, 0})];
}

static breccia_model *run_of(const char *load, const char *solve)
{
  breccia_model *m = model_of(BEAM "  - {name: jack, on: jack, %s}\nsolve: {%s}\n", load, solve);
  step_surely(m, 1000000);
  return m;
}

/* The patch is 7 particles from x = 85 to 145, its centre at 115. */
static const double first = 85, last = 145;

static void check_platen(breccia_model *m, double moved, double force, double tolerance)
{
  const Wrench w = wrench_of(m, "jack");
  assert_near(w.force[1], force, tolerance * fabs(force));
  Resultant resultants[3];
  assert_int_equal(resultants_find(&m->solver, resultants, NULL), 0);
  assert_near(resultants[2].now[1], w.force[1], 1e-9 * fabs(force));
  assert_near(w.moment[2], 0, 2e-2 * fabs(force)); /* kN mm: the strain of the patch changes arms of 30 mm */
  const double left = moved_at(m, first, 75), right = moved_at(m, last, 75);
  for (double x = first; x < last; x += 10)
    assert_near(moved_at(m, x, 75), left + (right - left) * (x - first) / (last - first), 1e-9 * fabs(moved));
  assert_near((left + right) / 2, moved, 1e-9 * fabs(moved));
  breccia_model_destroy(&m);
}

/** The force on a plate that turns is that of the two fields of displacement, uniform and turning, of which the moments
 * cancel. */
static void a_platen_takes_no_moment(void **state)
{
  (void)state;
  const char *const fields[] = {"field: {displacement: [free, '-1e-4 * 1 m']}",
                                "field: {displacement: [free, '1e-3 * (x - 115 mm)']}"};
  double force[2], moment[2];
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = run_of(fields[k], "static: {increments: 1}");
    const Wrench w = wrench_of(m, "jack");
    force[k] = w.force[1];
    moment[k] = w.moment[2];
    breccia_model_destroy(&m);
  }
  const double turning = force[0] - moment[0] / moment[1] * force[1];
  assert_true(fabs(turning) < 0.9 * fabs(force[0]));
  static const char *const solvers[] = {"static: {increments: 1, equations: direct}",
                                        "static: {increments: 2, equations: conjugate gradients}",
                                        "static: {increments: 1, equations: minimal residuals}",
                                        "static: {increments: 1, method: relaxation}",
                                        "implicit: {end time: 16, time step: 0.05, local error: 1, damping: 2 1/ms}",
                                        "explicit: {end time: 16, damping: 2 1/ms}"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k)
    check_platen(
        run_of(k < 4 ? "displacement: [free, -0.1]" : "displacement: [free, -0.1], history: {ramp to: 4}", solvers[k]),
        -0.1, turning, k < 4 ? 1e-3 : 5e-3);
  breccia_model *m = run_of("displacement: [free, -0.1], platen: fixed", "static: {increments: 1}");
  assert_near(wrench_of(m, "jack").force[1], force[0], 1e-3 * fabs(force[0]));
  breccia_model_destroy(&m);
}

static void work_in_motion_is_balanced(void **state)
{
  (void)state;
  static const char *const solvers[] = {
      "explicit: {end time: 1}", "explicit: {end time: 1, damping: 1 1/ms, stiffness damping: 1e-4 ms}",
      "implicit: {end time: 1, time step: 0.02, local error: 1}",
      "implicit: {end time: 1, time step: 0.02, local error: 1, scheme: HHT, damping: 1 1/ms}"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k) {
    breccia_model *m = run_of("velocity: [free, -0.1], history: {ramp to: 0.5}", solvers[k]);
    const Energy e = solver_energy(&m->solver);
    assert_balanced(m, k < 2 ? 1e-6 : 1e-4);
    assert_true(e.external > 0 && e.damping >= 0 && e.stored > 0);
    check_platen(m, -0.075, wrench_of(m, "jack").force[1], 1e-12);
  }
}

/** A block that its platen throws along its axis of symmetry does not turn, and weighs on it by mass times
 * acceleration. */
static void a_platen_that_speeds_up_does_not_tilt(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 2}",
                                        "implicit: {end time: 2, time step: 0.05, local error: 1}"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        MATERIAL "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: "
                 "[90, 40]}}}}\nperidynamics: {formulation: correspondence, space: plane stress}\n"
                 "selections: {jack: {face: y+, inside: {box: {from: [20, 0], to: [70, 40]}}}}\n"
                 "loads:\n  - {name: jack, on: jack, acceleration: [free, -0.5], history: {ramp to: 1}}\nsolve: {%s}\n",
        solvers[k]);
    step_surely(m, 1000000);
    const double moved = moved_at(m, 45, 35), force = 2.4e-6 * 90 * 40 * 50 * -0.5; /* kg mm/ms2 is kN */
    assert_near(moved, -0.5 * (1.0 / 6 + 0.5 + 0.5), 2e-3);
    assert_near(moved_at(m, 25, 35), moved, 1e-5);
    assert_near(wrench_of(m, "jack").force[1], force, 0.2 * fabs(force));
    breccia_model_destroy(&m);
  }
}

/** A jack that moves at once pushes a body that is symmetric about the jack without turning, and books its blow. */
static void a_platen_that_starts_at_once_does_not_turn(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.1}",
                                        "implicit: {end time: 0.1, time step: 0.002, local error: 1}"},
                           *const motions[] = {"velocity: [free, -1]",
                                               "displacement: [free, -1], history: {ramp to: 1}"};
  for (int k = 0; k < 4; ++k) {
    breccia_model *m = model_of(
        MATERIAL "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: "
                 "[150, 50]}}}}\nperidynamics: {formulation: correspondence, space: plane stress}\n"
                 "selections: {jack: {face: y+, inside: {box: {from: [50, 0], to: [100, 50]}}}}\n"
                 "loads:\n  - {on: {face: y-}, displacement: [free, 0]}\n  - {name: jack, on: jack, %s}\nsolve: {%s}\n",
        motions[k / 2], solvers[k % 2]);
    step_surely(m, 1000000);
    assert_near(moved_at(m, 55, 45), moved_at(m, 95, 45), 1e-9);
    assert_near(moved_at(m, 75, 45), -0.1, 1e-9);
    assert_balanced(m, k % 2 ? 1e-4 : 1e-5);
    breccia_model_destroy(&m);
  }
}

/** In space a plate with two leaders stays plane and takes no moment. */
static void a_block_hangs_on_its_platen(void **state)
{
  (void)state;
  /* In space the block is held across by springs so soft that it only leans: the plate bears weight and push, and no
   * moment. */
  breccia_model *m = model_of(
      MATERIAL "body: {b: {material: m, spacing: 10, shape: {box: {particles: [6, 5, 4]}}}}\n"
               "selections: {plate: {face: y+, inside: {box: {from: [0, 0, 0], to: [40, 50, 30]}}}}\n"
               "loads:\n  - {on: {face: y-}, spring: {stiffness: 20 kN/mm}}\n"
               "  - {name: plate, on: plate, displacement: [free, -0.01, free]}\nsolve: {static: {increments: 1}}\n");
  step_surely(m, 10);
  const Wrench w = wrench_of(m, "plate");
  assert_true(w.force[1] < -0.1);
  for (int k = 0; k < 3; k += 2) assert_near(w.moment[k], 0, 1e-3 * fabs(w.force[1]));
  const Particles *p = m->domain.particles;
  double at[2][2];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      at[a][b] = p->displacement.row[1][particles_nearest(p, (double[]){a ? 35 : 5, 45, b ? 25 : 5})];
  assert_near(at[0][0] + at[1][1], at[0][1] + at[1][0], 1e-12);
  assert_near((at[0][0] + at[1][1]) / 2, -0.01, 1e-12);
  assert_true(fabs(at[1][0] - at[0][0]) > 1e-4 && fabs(at[0][1] - at[0][0]) > 1e-4);
  breccia_model_destroy(&m);
}

static void reactions_go_on_where_a_platen_ends(void **state)
{
  (void)state;
  /* Its forces take its place: nothing moves. Then they go. */
  breccia_model *m = model_of(BEAM "  - {name: jack, on: jack, displacement: [free, -0.1]}\n"
                                   "solve:\n  - {static: {increments: 1}}\n"
                                   "  - {static: {increments: 1}, loads: [{reaction of: jack}]}\n");
  step_surely(m, 1);
  const double before = moved_at(m, 205, 45);
  step_surely(m, 1);
  assert_near(moved_at(m, 205, 45), before, 1e-6 * fabs(before));
  assert_near(moved_at(m, first, 75) + moved_at(m, last, 75), -0.2, 1e-6);
  breccia_model_destroy(&m);
}

static void a_platen_follows_a_control(void **state)
{
  (void)state;
  breccia_model *m =
      run_of("displacement: [free, -1], history: {controlled: yes}",
             "static: {increments: 1, control: {displacement of: {nearest: [205, 45]}, direction: [0, 1], to: -0.05}}");
  assert_near(moved_at(m, 205, 45), -0.05, 1e-9);
  assert_near(wrench_of(m, "jack").moment[2], 0, 1e-3);
  breccia_model_destroy(&m);
}

static breccia_model *pushed_beam(int threads)
{
  return model_on(threads, BEAM "  - {name: jack, on: jack, velocity: [free, -0.1], history: {ramp to: 0.02}}\n"
                                "solve:\n  - {explicit: {steps: 12}}\n  - {explicit: {steps: 40}, loads: "
                                "[{name: jack, on: jack, velocity: [free, 0.1]}]}\n");
}

static void threads_and_restarts_change_no_bit(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(pushed_beam, 8, 9);
  assert_same_bits_by_threads_and_restart(pushed_beam, 8, 30);
}

/** Returns true if a platen is between the only motion that a load prescribes and its particles. */
static bool turns(const char *body, const char *load)
{
  breccia_model *m = model_of("%s  - {name: jack, on: jack, %s}\nsolve: {static: {increments: 1}}\n", body, load);
  bool found = false;
  for (int c = 0; c < m->loading.constraint_count; ++c) found |= m->loading.constraints[c].platen != NULL;
  breccia_model_destroy(&m);
  return found;
}

#define TWO_JACKS                                                                                                      \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [400, "        \
  "80]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress}\n"                                                 \
  "selections: {jack: {any of: [{nearest: [125, 75]}, {nearest: [275, 75]}]}}\n"                                       \
  "loads:\n  - {on: {nearest: [5, 5]}, displacement: [0, 0]}\n  - {on: {nearest: [395, 5]}, displacement: [free, "     \
  "0]}\n"
#define WHOLE                                                                                                          \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [200, "        \
  "80]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress}\nselections: {jack: {face: y+}}\n"                 \
  "loads:\n  - {on: {face: y-}, displacement: [0, 0]}\n"

static void patches_turn_where_nothing_says_that_they_must_not(void **state)
{
  (void)state;
  assert_true(turns(BEAM, "displacement: [free, -0.1]"));
  assert_true(turns(BEAM, "velocity: [free, -0.1]"));
  assert_true(turns(BEAM, "along: {direction: [1, -2], displacement: 0.1}"));
  assert_true(turns(BEAM, "displacement: [free, 0], platen: turning"));
  assert_false(turns(BEAM, "displacement: [free, 0]"));
  assert_false(turns(TWO_JACKS, "displacement: [free, -0.1]"));
  assert_true(turns(TWO_JACKS, "displacement: [free, -0.1], platen: turning"));
  assert_false(turns(BEAM, "displacement: [0, -0.1]"));
  assert_false(turns(BEAM, "displacement: [free, -0.1], platen: fixed"));
  /* The whole face; half of a body, whose plane of symmetry is held by particles or by images. */
  assert_false(turns(WHOLE, "displacement: [free, -0.1]"));
#define HALF                                                                                                           \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [200, "        \
  "80]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress}\n"                                                 \
  "selections: {jack: {face: y+, inside: {box: {from: [0, 0], to: [40, 80]}}}}\n"                                      \
  "loads:\n  - {on: {nearest: [195, 5]}, displacement: [0, 0]}\n"
  assert_false(turns(HALF "  - {on: {face: x-}, displacement: [0, free]}\n", "displacement: [free, -0.1]"));
  assert_false(turns(HALF "  - {on: {face: x-}, support: {held: across}}\n", "displacement: [free, -0.1]"));
}

static void what_contradicts_a_platen_is_refused(void **state)
{
  (void)state;
  static const char *const decks[][2] = {
      {BEAM "  - {on: jack, displacement: [0, -0.1], platen: turning}\nsolve: {static: {increments: 1}}\n",
       "in one direction|it is in 2"},
      {BEAM "  - {on: jack, force: [0, -1], platen: turning}\nsolve: {static: {increments: 1}}\n", "platen: only of"},
      {BEAM "  - {on: jack, displacement: [free, -0.1]}\n  - {on: {all of: [jack, {nearest: [85, 75]}]}, tie: {to: "
            "{nearest: [200, 45]}}}\n"
            "solve: {static: {increments: 1}}\n",
       "under a platen that turns|platen: fixed"},
  };
  for (size_t k = 0; k < sizeof decks / sizeof *decks; ++k) {
    char *words = refusal_of(decks[k][0]);
    holds_words(words, decks[k][1]);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_platen_takes_no_moment),
      cmocka_unit_test(work_in_motion_is_balanced),
      cmocka_unit_test(a_platen_that_speeds_up_does_not_tilt),
      cmocka_unit_test(a_platen_that_starts_at_once_does_not_turn),
      cmocka_unit_test(a_block_hangs_on_its_platen),
      cmocka_unit_test(reactions_go_on_where_a_platen_ends),
      cmocka_unit_test(a_platen_follows_a_control),
      cmocka_unit_test(threads_and_restarts_change_no_bit),
      cmocka_unit_test(patches_turn_where_nothing_says_that_they_must_not),
      cmocka_unit_test(what_contradicts_a_platen_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

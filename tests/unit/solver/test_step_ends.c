/* How steps end: at rest, at the times that are asked for, and how one that fails is taken back. */
#include "sample_laws.h"
#include "solver/rest.h"
#include "support.h"

#include <unistd.h>

static void damped_bodies_come_to_rest_at_the_default_step(void **state)
{
  (void)state;
  /* A bar under its own end load: u = sigma L / E; the stable step falls by 1 / sqrt(1 + 0.8). */
  const char *const damping[] = {"local damping: 0.8", "local damping: 0.5", "damping: 60", "damping: 4e4"};
  for (int k = 0; k < 4; ++k) {
    breccia_model *m =
        model_of("materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
                 "body: {b: {material: m, lattice: line, area: 1, spacing: 0.1, shape: {box: {particles: "
                 "[40, 1]}}}}\n"
                 "peridynamics: {formulation: bond-based, space: 1-D, horizon: 2.015 spacings}\n"
                 "loads: [{on: {face: x-, layers: 2}, displacement: [0, free]}, {on: {face: x+, layers: 2}, "
                 "force: [1, 0]}]\n"
                 "solve: {explicit: {end time: %g, %s}}\n",
                 k == 3 ? 0.02 : 3.0, damping[k]);
    breccia_error *error = breccia_error_create();
    if (breccia_model_step(m, INT64_MAX, error)) fail_msg("%s: %s", damping[k], breccia_error_text(error));
    const Particles *p = m->domain.particles;
    Rest rest;
    assert_int_equal(rest_find(&m->solver, &rest, error), 0);
    assert_true(rest.meant);
    if (k < 3) {
      if (!rest.reached) fail_msg("%s: unbalanced %g, kinetic %g", damping[k], rest.unbalanced, rest.kinetic);
      const double u = p->displacement.row[0][p->place_of[30]];
      assert_near(u, 1e-4 * (p->position[0][p->place_of[30]] - 0.2), 0.03 * 2.9e-4);
    } else { /* creeps: each step is no longer than the damping's own time */
      assert_false(rest.reached);
      assert_true(m->solver.clock.time_step <= 1 / 4e4);
    }
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

static void a_body_that_supports_hold_is_out_of_balance_while_it_moves(void **state)
{
  (void)state;
  /* Its end is set over at once and held there: no load acts but what the supports carry, and forces out of balance are measured by that. */
  breccia_model *m = model_of(
      "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
      "body: {b: {material: m, lattice: line, area: 1, spacing: 0.1, shape: {box: {particles: [40, 1]}}}}\n"
      "peridynamics: {formulation: bond-based, space: 1-D, horizon: 2.015 spacings}\n"
      "loads: [{on: {face: x-, layers: 2}, displacement: [0, free]}, {on: {face: x+, layers: 2}, displacement: "
      "[1e-3, free]}]\nsolve: {explicit: {end time: 3, local damping: 0.5}}\n");
  Rest rest;
  step_surely(m, 20);
  assert_int_equal(rest_find(&m->solver, &rest, NULL), 0);
  assert_true(rest.meant && !rest.reached);
  assert_true(rest.unbalanced > 0.1 && rest.unbalanced < 10);
  step_surely(m, INT64_MAX);
  assert_int_equal(rest_find(&m->solver, &rest, NULL), 0);
  assert_true(rest.reached && rest.unbalanced > 0);
  breccia_model_destroy(&m);
}

static void steps_end_with_the_times_that_are_asked_for(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                          "pictures: [{field: displacement, at: [0.0137, 0.02]}]\n"
                          "results: {times: [0.0031]}\n"
                          "solve: {explicit: {end time: 0.0271}}\n");
  const double wanted[] = {0.0031, 0.0137, 0.02, 0.0271};
  int met = 0;
  while (m->solver.clock.step < m->solver.clock.steps) {
    breccia_model_step(m, 1, NULL);
    assert_true(m->solver.clock.time_step <= 0.8 * m->solver.clock.stable * (1 + 1e-12));
    assert_true(m->solver.clock.time_step > 0.4 * m->solver.clock.stable);
    if (met < 4 && m->solver.clock.time == wanted[met]) ++met;
  }
  assert_int_equal(met, 4);
  assert_true(m->solver.clock.time == 0.0271);
  breccia_model_destroy(&m);
}

static void a_chosen_step_ends_with_the_end_time_by_a_shorter_last_one(void **state)
{
  (void)state;
  const struct {
    const char *solve;
    int64_t steps;
    double end, last; /* the last step, where it is told */
  } cases[] = {{"time step: 1e-4, end time: 1.025e-2", 103, 1.025e-2, 5e-5},
               {"time step: 1e-4, end time: 1e-2", 100, 1e-2, NAN}, /* 1e-2 / 1e-4 is not quite 100 */
               {"time step: 1e-4, end time: 3e-5", 1, 3e-5, 3e-5},
               {"time step: 1e-4, steps: 7", 7, 7e-4, NAN},
               {"steps: 0", 0, 0, NAN}};
  for (int k = 0; k < 5; ++k) {
    char deck[512], words[64];
    snprintf(deck, sizeof deck,
             SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                        "solve: {explicit: {%s}}\n",
             cases[k].solve);
    breccia_model *m = model_of("%s", deck);
    assert_int_equal(m->solver.clock.steps, cases[k].steps);
    snprintf(words, sizeof words, "the last one %.4g so as to end at %g", cases[k].last, cases[k].end);
    assert_true((strstr(breccia_model_overview(m), words) != NULL) == isfinite(cases[k].last));
    for (int64_t step = 1; step < cases[k].steps; ++step) {
      assert_int_equal(breccia_model_step(m, 1, NULL), 0);
      assert_near(m->solver.clock.time, 1e-4 * (double)step, 1e-12);
    }
    assert_int_equal(breccia_model_step(m, 10, NULL), 0);
    assert_int_equal(m->solver.clock.step, cases[k].steps);
    assert_near(m->solver.clock.time, cases[k].end, 1e-15);
    breccia_model_destroy(&m);
  }
}

/* ---- steps that fail ---- */

static breccia_model *pulled_vase(const char *failure)
{
  static const breccia_law *const laws[] = {&law_of_glass};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1};
  breccia_model *m = NULL;
  char deck[1024];
  snprintf(deck, sizeof deck,
           "units: {length: m, force: kN, time: s}\nmaterials: {v: {model: glass, density: 2}}\n"
           "body: {b: {material: v, spacing: 0.1, shape: {box: {particles: [12, 4, 4]}}}}\n"
           "failure: {%s}\ncontact: {}\n"
           "loads: [{on: {face: x-, layers: 3}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 3}, velocity: [0.5, 0, "
           "0]}]\nsolve: {explicit: {steps: 300}}\n",
           failure);
  breccia_error *error = breccia_error_create();
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return m;
}

/** Bits of what a step may change in the particles: displacements, velocities, forces, strains and stresses. */
static double *bits_of_state(const Domain *d, size_t *bytes)
{
  enum { ARRAYS = 21 };
  const size_t places = (size_t)d->particles->places;
  double *bits = malloc(ARRAYS * places * sizeof *bits);
  *bytes = ARRAYS * places * sizeof *bits;
  for (size_t k = 0; k < ARRAYS; ++k)
    memcpy(bits + k * places,
           k < 3    ? d->particles->displacement.row[k]
           : k < 6  ? d->particles->velocity.row[k - 3]
           : k < 9  ? d->particles->internal.row[k - 6]
           : k < 15 ? d->strain[k - 9]
                    : d->stress[k - 15],
           places * sizeof *bits);
  return bits;
}

static void a_step_that_fails_leaves_nothing_behind(void **state)
{
  (void)state;
  /* Limits at which bonds break in the steps before and in the step in which the law gives up; also of particles whose motion is
   * prescribed. */
  for (int k = 0; k < 12; ++k) {
    char failure[64];
    snprintf(failure, sizeof failure, "critical stretch: %g", 1.4e-3 + 2e-5 * k);
    breccia_model *m = pulled_vase(failure);
    Domain *d = &m->domain;
    const size_t slots = (size_t)d->family.slots;
    uint8_t *intact = malloc(slots);
    double *before = NULL;
    size_t bytes;
    Ledger ledger = {0};
    double fracture = 0;
    int64_t broken = 0;
    int status = 0;
    while (!status && m->solver.clock.step < m->solver.clock.steps) {
      free(before);
      before = bits_of_state(d, &bytes);
      memcpy(intact, d->family.intact, slots);
      ledger = m->solver.ledger;
      fracture = d->fracture_energy;
      broken = d->broken_count;
      status = breccia_model_step(m, 1, NULL);
    }
    assert_int_equal(status, BRECCIA_FAILURE);
    assert_int_equal(d->broken_count, broken);
    assert_memory_equal(intact, d->family.intact, slots);
    assert_true(d->fracture_energy == fracture);
    assert_memory_equal(&ledger, &m->solver.ledger, sizeof ledger);
    double *after = bits_of_state(d, &bytes);
    assert_memory_equal(before, after, bytes);
    free(intact);
    free(before);
    free(after);
    breccia_model_destroy(&m);
  }
}

static void marks_of_laws_that_gave_up_outlive_a_restart(void **state)
{
  (void)state;
  breccia_model *whole = pulled_vase("failed laws: break");
  bool marked = false;
  while (!marked && whole->solver.clock.step < whole->solver.clock.steps) {
    breccia_model_step(whole, 1, NULL);
    for (int64_t i = 0; i < whole->domain.particles->places; ++i) marked |= whole->domain.gave_up[i];
  }
  assert_true(marked);
  char folder[] = "/tmp/breccia-XXXXXX";
  assert_non_null(mkdtemp(folder));
  breccia_run run = {.size = sizeof(breccia_run), .folder = folder, .steps = whole->solver.clock.step};
  breccia_model *first = pulled_vase("failed laws: break"), *second = pulled_vase("failed laws: break");
  assert_int_equal(breccia_model_run(first, &run, NULL), 0);
  breccia_model_step(whole, 40, NULL);
  run.restart = 1;
  run.steps = whole->solver.clock.step;
  assert_int_equal(breccia_model_run(second, &run, NULL), 0);
  assert_true(whole->domain.broken_count > 0);
  assert_int_equal(second->domain.broken_count, whole->domain.broken_count);
  for (int k = 0; k < 3; ++k)
    assert_memory_equal(second->domain.particles->displacement.row[k], whole->domain.particles->displacement.row[k],
                        sizeof(double) * (size_t)whole->domain.particles->places);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&first);
  breccia_model_destroy(&second);
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void a_law_that_gives_more_than_it_got_stops_the_run(void **state)
{
  (void)state;
  static const breccia_law *const laws[] = {&law_of_giver};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1};
  breccia_error *error = breccia_error_create();
  breccia_model *m;
  const char *deck = "materials: {g: {model: giver, density: 2}}\n"
                     "body: {b: {material: g, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                     "loads: [{on: {face: x+}, body force: [1, 0, 0]}]\n"
                     "solve: {explicit: {steps: 5000}}\n";
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  assert_int_equal(breccia_model_step(m, m->solver.clock.steps, error), BRECCIA_FAILURE);
  assert_non_null(strstr(breccia_error_text(error), "energy from nothing"));
  assert_true(solver_energy(&m->solver).internal > -m->solver.ledger.paid); /* and soon */
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

/** What damps and what holds shortens the stable step t of the body alone, w = 2 / t its fastest vibration: local damping acts on it like a greater
 *  stiffness; with stiffness damping b it turns over from step to step where dt^2 w^2 + 2 b w^2 dt = 4; mass damping is followed by steps of its own
 *  time; springs of k per mass add to w^2. The steps are as many as fit at the share that is safe. */
static void damping_and_springs_shorten_steps_as_they_must(void **state)
{
  (void)state;
#define CUBE                                                                                                           \
  "units: {length: m, force: kN, time: s}\n" SOFT_SOLID                                                                \
  "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"                                     \
  "peridynamics: {horizon: 1.5 spacings}\nloads: [%s]\nsolve: {explicit: {end time: %.17g, safety: 0.7%s}}\n"
  breccia_model *m = model_of(CUBE, "", 0.1, "");
  const double t = m->solver.clock.stable, w = 2 / t, mass = 120 * 2 * 0.001;
  breccia_model_destroy(&m);
  const struct {
    const char *loads, *more;
    double number, stable; /* of the words; what follows */
  } cases[] = {{"", "", 0, t},
               {"", "local damping", 0.44, t / sqrt(1.44)},
               {"", "damping", 0.5 / t, t},
               {"", "damping", 3 / t, t / 3},
               {"", "stiffness damping", 0.75 * t, t / 2},
               {"spring", "", 3 * mass * w * w, t / 2}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char loads[100] = "", more[100] = "";
    if (*cases[k].loads)
      snprintf(loads, sizeof loads, "{on: {all: yes}, %s: {stiffness: %.17g}}", cases[k].loads, cases[k].number);
    if (*cases[k].more) snprintf(more, sizeof more, ", %s: %.17g", cases[k].more, cases[k].number);
    const double end = 12.3 * 0.7 * cases[k].stable;
    m = model_of(CUBE, loads, end, more);
    assert_near(m->solver.clock.stable, cases[k].stable, 2e-3 * cases[k].stable);
    assert_int_equal(m->solver.clock.steps, 13);
    assert_near(m->solver.clock.time_step, end / 13, 1e-12 * end);
    step_surely(m, 13);
    assert_true(breccia_model_time(m) == end);
    breccia_model_destroy(&m);
  }
#undef CUBE
}

/** A spring between two bodies adds k (1 / m_1 + 1 / m_2) to the square of the fastest vibration, whichever end the
 * deck names first: here three times that of either body, whose waves are equally fast. */
static void a_spring_between_two_densities_is_as_fast_as_its_lighter_end(void **state)
{
  (void)state;
#define PAIR                                                                                                           \
  "units: {length: m, force: kN, time: s}\nmaterials:\n"                                                               \
  "  heavy: {model: elastic, density: 20, Young modulus: 1e5, Poisson ratio: 0.25}\n"                                  \
  "  light: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\nbody:\n"                            \
  "  h: {material: heavy, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [0.6, 0.5, 0.4]}}}\n"                       \
  "  l: {material: light, spacing: 0.1, shape: {box: {from: [2, 0, 0], to: [2.6, 0.5, 0.4]}}}\n"                       \
  "peridynamics: {horizon: 1.5 spacings}\nloads: [%s]\nsolve: {explicit: {steps: 1}}\n"
  breccia_model *m = model_of(PAIR, "");
  const double t = m->solver.clock.stable, w = 2 / t, volume = 120 * 0.001, both = 1 / (20 * volume) + 1 / (2 * volume);
  breccia_model_destroy(&m);
  for (int k = 0; k < 2; ++k) {
    char spring[200];
    snprintf(spring, sizeof spring, "{on: {block: %s}, spring: {to: {block: %s}, stiffness: %.17g}}", k ? "l" : "h",
             k ? "h" : "l", 3 * w * w / both);
    m = model_of(PAIR, spring);
    assert_near(m->solver.clock.stable, t / 2, 2e-3 * t);
    breccia_model_destroy(&m);
  }
#undef PAIR
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damping_and_springs_shorten_steps_as_they_must),
      cmocka_unit_test(a_spring_between_two_densities_is_as_fast_as_its_lighter_end),
      cmocka_unit_test(damped_bodies_come_to_rest_at_the_default_step),
      cmocka_unit_test(a_body_that_supports_hold_is_out_of_balance_while_it_moves),
      cmocka_unit_test(steps_end_with_the_times_that_are_asked_for),
      cmocka_unit_test(a_chosen_step_ends_with_the_end_time_by_a_shorter_last_one),
      cmocka_unit_test(a_step_that_fails_leaves_nothing_behind),
      cmocka_unit_test(a_law_that_gives_more_than_it_got_stops_the_run),
      cmocka_unit_test(marks_of_laws_that_gave_up_outlive_a_restart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

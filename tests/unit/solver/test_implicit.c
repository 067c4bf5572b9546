/* Implicit dynamics: Newmark's and the HHT method, Rayleigh damping, steps that are cut. */
#include "support.h"

#include "solver/implicit.h"

#include <unistd.h>

static void run_all(breccia_model *model)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, INT64_MAX, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

#define UNITS "units: {length: m, force: kN, time: s}\n"
/* A bar of 3.75 m beyond what is held at its left end, along which waves run at 707 m/s: its first period is 21.2 ms. */
#define BAR                                                                                                            \
  UNITS "materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}\n"                                        \
        "body: {bar: {material: m, lattice: line, spacing: 0.1, area: 0.01, shape: {box: {particles: [40, 1], first "  \
        "particle: [0.05, 0]}}}}\n"                                                                                    \
        "peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings, surface correction: energy}\n"   \
        "loads:\n  - {on: {face: x-, layers: 3}, displacement: [0, 0]}\n"
static const double pi = 3.14159265358979323846, period = 15 / 707.10678, length = 3.75;

/** The first mode of the bar, at a largest speed. */
static double first_mode(const double x[3])
{
  return sin(pi / 2 * fmax(0, x[0] - 0.25) / length);
}

/** The fastest motion: neighbours against each other. */
static double alternating(const double x[3])
{
  return x[0] < 0.3 ? 0 : lround(x[0] / 0.1) % 2 ? 1 : -1;
}

/** Begins again with these velocities along x. */
static void set_moving(breccia_model *model, double (*shape)(const double x[3]), double speed)
{
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->velocity.row[0][i] = speed * shape((const double[3]){p->position[0][i], p->position[1][i], p->position[2][i]});
  }
  assert_int_equal(solver_begin(&model->solver, NULL), 0);
}

static double total_energy(const breccia_model *model)
{
  const Energy e = solver_energy(&model->solver);
  return e.kinetic + e.stored;
}

/** Displacements of the bar at 10 ms, from a motion that is no mode. */
static breccia_model *swing(const char *solve)
{
  breccia_model *m = model_of(BAR "solve: {%s}\n", solve);
  set_moving(m, first_mode, 0.1);
  run_all(m);
  assert_near(m->solver.clock.time, 0.01, 1e-12);
  return m;
}

static void errors_fall_with_the_square_of_the_step(void **state)
{
  (void)state;
  static const char *const schemes[] = {"Newmark", "HHT, alpha: -0.1", "Newmark, damping: 40, stiffness damping: 2e-4"};
  for (int c = 0; c < 3; ++c) {
    char deck[256];
    /* Explicit dynamics has no stiffness damping: there the finest steps are the reference. */
    snprintf(deck, sizeof deck, "implicit: {end time: 0.01, time step: 1e-5, local error: 1e9, scheme: %s}",
             schemes[c]);
    breccia_model *reference = swing(c < 2 ? "explicit: {end time: 0.01, safety: 0.05}" : deck);
    double before = 0;
    for (int k = 0; k < 3; ++k) {
      snprintf(deck, sizeof deck, "implicit: {end time: 0.01, time step: %g, local error: 1e9, scheme: %s}",
               1e-3 / (1 << k), schemes[c]);
      breccia_model *m = swing(deck);
      assert_int_equal(m->solver.clock.step, 10 << k);
      double square = 0, size = 0;
      for (int64_t n = 0; n < m->domain.particles->count; ++n) {
        const int32_t i = m->domain.particles->place_of[n];
        const double exact = reference->domain.particles->displacement.row[0][i];
        square += pow(m->domain.particles->displacement.row[0][i] - exact, 2);
        size += exact * exact;
      }
      const double error = sqrt(square / size);
      if (k && !(before / error > 3.5 && before / error < 4.6))
        fail_msg("%s: errors %g, then %g", schemes[c], before, error);
      assert_true(error < 0.15); /* it passes through rest there */
      before = error;
      breccia_model_destroy(&m);
    }
    breccia_model_destroy(&reference);
  }
}

static void average_acceleration_keeps_energy(void **state)
{
  (void)state;
  const char *solve = "solve: {implicit: {end time: 0.2, time step: 1e-3, local error: 1e9, residual: 1e-12}}\n";
  breccia_model *bar = model_of(BAR "%s", solve);
  breccia_model *plate = model_of(
      UNITS SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 6]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane stress, strain: small}\n"
      "loads: [{on: {face: x-, layers: 2}, roller: [1, 0]}]\n%s",
      solve);
  breccia_model *models[] = {bar, plate};
  for (int k = 0; k < 2; ++k) {
    set_moving(models[k], k ? alternating : first_mode, 0.1);
    const double begun = total_energy(models[k]);
    for (int n = 0; n < 200; ++n) {
      step_surely(models[k], 1);
      assert_near(total_energy(models[k]), begun, 1e-8 * begun);
    }
    assert_int_equal(models[k]->solver.clock.step, 200);
    assert_near(solver_energy(&models[k]->solver).numerical, 0, 1e-8 * begun);
    breccia_model_destroy(&models[k]);
  }
}

static void hht_takes_energy_out_of_what_steps_are_too_long_for(void **state)
{
  (void)state;
  /* The spectral radius of fast vibrations is (1 + alpha) / (1 - alpha), for speeds; energy has its square (Hughes 2000, 9.3). */
  const double alpha = -0.2, radius = (1 + alpha) / (1 - alpha);
  breccia_model *fast =
                    model_of(BAR "solve: {implicit: {end time: 40, time step: 1, local error: 1e9, scheme: HHT, alpha: "
                                 "%g}}\n",
                             alpha),
                *slow =
                    model_of(BAR "solve: {implicit: {end time: 0.0226, time step: 2.26e-4, local error: 1e9, scheme: "
                                 "HHT, alpha: %g}}\n",
                             alpha);
  set_moving(fast, alternating, 0.1);
  set_moving(slow, first_mode, 0.1);
  const double begun[] = {total_energy(fast), total_energy(slow)};
  step_surely(fast, 30); /* a double root: n radius^n */
  const double before = total_energy(fast);
  step_surely(fast, 1);
  assert_near(total_energy(fast) / before, radius * radius, 0.15 * radius * radius);
  assert_true(total_energy(fast) < 0.05 * begun[0]);
  run_all(slow);
  assert_true(total_energy(slow) > 0.998 * begun[1] && total_energy(slow) < 0.99999 * begun[1]);
  assert_balanced(slow, 1e-6);
  const Energy e = solver_energy(&slow->solver);
  assert_near(e.numerical, begun[1] - total_energy(slow), 1e-6 * begun[1]);
  breccia_model_destroy(&fast);
  breccia_model_destroy(&slow);
}

static void rayleigh_damping_is_that_of_the_ratio(void **state)
{
  (void)state;
  /* Energy falls by exp(-2 xi omega t); at two frequencies the ratio is the one given, and each part alone makes 2 xi omega = c or b omega^2. */
  const double ratio = 0.03, f = 1 / period, w = 2 * pi * f;
  char both[96], mass[64], stiffness[64];
  snprintf(both, sizeof both, "Rayleigh damping: {ratio: %g, from: %g, to: %g}", ratio, f, 7 * f);
  snprintf(mass, sizeof mass, "damping: {ratio: %g, at: %g}", ratio, f);
  snprintf(stiffness, sizeof stiffness, "stiffness damping: %.10g", 2 * ratio / w);
  const char *const words[] = {both, mass, stiffness};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = model_of(BAR "solve: {implicit: {end time: %.10g, time step: %.10g, local error: 1e9, %s}}\n",
                                4 * period, period / 80, words[k]);
    set_moving(m, first_mode, 0.1);
    const double begun = total_energy(m);
    run_all(m);
    const double found = -log(total_energy(m) / begun) / (2 * w * 4 * period);
    if (!(fabs(found - ratio) < 0.06 * ratio)) fail_msg("%s: a ratio of %g", words[k], found);
    assert_balanced(m, 1e-6);
    assert_near(solver_energy(&m->solver).damping, begun - total_energy(m), 1e-6 * begun);
    breccia_model_destroy(&m);
  }
}

/* Each formulation, with supports, ties, rollers and prescribed motions. */
static const char *const bodies[] = {
    SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 3]}}}}\n"
               "peridynamics: {formulation: correspondence, space: 3-D}\n"
               "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
               " {on: {face: x+, layers: 1}, traction: [1, 2, -0.5], history: {ramp to: 0.01}}]\n",
    SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 3]}}}}\n"
               "peridynamics: {formulation: ordinary, space: 3-D}\n"
               "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
               " {on: {face: x+, layers: 1}, velocity: [0.05, free, free], history: {ramp to: 0.01}},"
               " {on: {nearest: [0.25, 0.15, 0.15]}, roller: [0, 1, 1]}]\n",
    "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
    "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"
    "peridynamics: {formulation: bond-based, space: plane stress}\n"
    "loads: [{on: {face: x-, layers: 2}, roller: [1, 0]}, {on: {nearest: [0.75, 0.05]}, roller: [0.6, 0.8]},"
    " {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n",
    SOFT_SOLID
    "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"
    "peridynamics: {formulation: correspondence, space: plane strain}\n"
    "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}},"
    " {on: {face: x+, layers: 1}, tie: {directions: x}}, {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n",
    SOFT_SOLID /* nothing holds it */
    "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"
    "peridynamics: {formulation: correspondence, space: plane stress}\n"
    "loads: [{on: {face: x+, layers: 1}, acceleration: [3, free]}, {initial velocity: {translation: [0, 1]}},"
    " {on: {face: x-, layers: 1}, spring: {stiffness: 5}}]\n"};
enum { BODIES = sizeof bodies / sizeof *bodies };

/** Largest difference of displacements, over the largest of them. */
static double difference(const breccia_model *a, const breccia_model *b)
{
  double most = 0, largest = 0;
  const Particles *p = a->domain.particles;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      most = larger_of(most, fabs(p->displacement.row[k][i] - b->domain.particles->displacement.row[k][i]));
      largest = larger_of(largest, fabs(p->displacement.row[k][i]));
    }
  assert_true(largest > 0);
  return most / largest;
}

static void every_body_moves_as_by_explicit_steps(void **state)
{
  (void)state;
  for (int b = 0; b < BODIES; ++b) {
    const bool springs = strstr(bodies[b], "spring") != NULL;
    breccia_model *explicit =
        model_of(UNITS "%ssolve: {explicit: {end time: 0.004, damping: 20, safety: 0.2}}\n", bodies[b]),
                  *direct = model_of(UNITS "%ssolve: {implicit: {end time: 0.004, time step: 2e-4, damping: 20, local "
                                           "error: 1e9, equations: %s}}\n",
                                     bodies[b], springs ? "automatic" : "direct"),
                  *gradients =
                      model_of(UNITS "%ssolve: {implicit: {end time: 0.004, time step: 2e-4, damping: 20, local "
                                     "error: 1e9, equations: conjugate gradients}}\n",
                               bodies[b]);
    run_all(explicit);
    run_all(direct);
    run_all(gradients);
    const double to_explicit = difference(explicit, direct), to_each_other = difference(direct, gradients);
    if (!(to_explicit < 2e-2 && to_each_other < 1e-6))
      fail_msg("body %d: differs by %g from explicit, by %g between ways to solve", b, to_explicit, to_each_other);
    assert_near(direct->solver.ledger.external_work, explicit->solver.ledger.external_work,
                0.01 * explicit->solver.ledger.paid);
    assert_near(direct->solver.ledger.kinetic, explicit->solver.ledger.kinetic, 0.02 * explicit->solver.ledger.paid);
    assert_balanced(direct, 1e-3);
    breccia_model_destroy(&explicit);
    breccia_model_destroy(&direct);
    breccia_model_destroy(&gradients);
  }
}

#define FLOWING                                                                                                        \
  UNITS                                                                                                                \
  "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening "       \
  "modulus: 0}}\n"                                                                                                     \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 4]}}}}\n"       \
  "peridynamics: {formulation: correspondence, space: plane strain}\n"                                                 \
  "failure: {critical stretch: 0.012, near grips: hold}\n"                                                             \
  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]},"                                                         \
  " {on: {face: x+, layers: 1}, traction: [6, 14], history: {ramp to: 0.05}}]\n"

static void a_loads_slow_growth_gives_the_state_of_rest(void **state)
{
  (void)state;
  const char *deck = "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                     "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 3, 3]}}}}\n"
                     "peridynamics: {formulation: correspondence, space: 3-D}\n"
                     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
                     " {on: {face: x+, layers: 1}, traction: [1, 2, -0.5], history: {ramp to: 4}}]\n";
  breccia_model *rest = model_of(UNITS "%ssolve: {static: {end time: 4, increments: 4}}\n", deck),
                *slow = model_of(
                    UNITS "%ssolve: {implicit: {end time: 30, time step: 1, local error: 1e9, scheme: HHT, alpha: "
                          "-0.3, damping: 1}}\n",
                    deck);
  run_all(rest);
  run_all(slow);
  assert_true(difference(rest, slow) < 1e-5);
  breccia_model_destroy(&rest);
  breccia_model_destroy(&slow);
}

static int count_of(const char *text, const char *words)
{
  int count = 0;
  for (const char *at = text; (at = strstr(at, words)); at += strlen(words)) ++count;
  return count;
}

static void steps_are_cut_where_newton_does_not_follow_and_by_their_error(void **state)
{
  (void)state;
  static const char *const whys[] = {"iterations: 3, local error: 1e9", "local error: 2e-3"};
  breccia_model *fine = model_of(FLOWING "solve: {implicit: {end time: 0.06, time step: 5e-4, local error: 1e9}}\n");
  run_all(fine);
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(FLOWING "solve: {implicit: {end time: 0.06, time step: 4e-3, %s}}\n", whys[k]);
    static const char *const told[] = {"    cut: no equilibrium: ", "    cut: the step errs by "};
    int64_t lines = 0, tries = 0;
    while (!m->solver.clock.ended) { /* solution.txt tells of every try, and why it was cut */
      step_surely(m, 1);
      lines += count_of(text_words(&m->solver.log), told[k]);
      tries += count_of(text_words(&m->solver.log), ", from time ");
    }
    const Implicit *s = m->solver.own;
    assert_int_equal(lines, s->cuts);
    assert_int_equal(tries, s->cuts + m->solver.clock.step);
    if (!(s->cuts > 0 && m->solver.clock.step > 15 && m->solver.clock.step < 400))
      fail_msg("%lld steps, %lld cuts", (long long)m->solver.clock.step, (long long)s->cuts);
    assert_near(m->solver.clock.time, 0.06, 1e-12);
    assert_true(difference(fine, m) < 0.05);
    assert_true(solver_energy(&m->solver).dissipated > 0);
    assert_true(fabs(m->solver.ledger.numerical) <
                0.02 * solver_energy(&m->solver).external); /* by Newmark's constant average acceleration */
    breccia_model_destroy(&m);
  }
  breccia_model_destroy(&fine);
}

static void what_flows_is_followed_in_few_iterations_whatever_its_damping(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(FLOWING "solve: {implicit: {end time: 0.06, time step: 1e-3, local error: 1e9, residual: 1e-9,"
                       " stiffness damping: 5e-3}}\n");
  int64_t most = 0, steps = 0;
  while (!m->solver.clock.ended) {
    step_surely(m, 1);
    const int64_t iterations = ((const Implicit *)m->solver.own)->newton.iterations;
    most = iterations > most ? iterations : most;
    steps += 1;
  }
  assert_int_equal(steps, 60);
  assert_true(solver_energy(&m->solver).dissipated > 0.01 * solver_energy(&m->solver).external);
  if (most > 6) fail_msg("%lld iterations", (long long)most);
  breccia_model_destroy(&m);
}

static void a_body_that_turns_is_followed(void **state)
{
  (void)state;
  /* More than half a turn in 40 steps: the stiffness of the body as it stood at first is of no use any more. */
  const char *deck = SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [6, 4]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane stress}\n"
      "loads: [{initial velocity: {rotation: [0, 0, 10]}}]\n";
  breccia_model *explicit = model_of(UNITS "%ssolve: {explicit: {end time: 0.4}}\n", deck),
                *implicit =
                    model_of(UNITS "%ssolve: {implicit: {end time: 0.4, time step: 0.01, local error: 1e9, scheme: "
                                   "HHT, stiffness damping: 1e-4}}\n",
                             deck);
  run_all(explicit);
  int64_t most = 0;
  while (!implicit->solver.clock.ended) {
    step_surely(implicit, 1);
    const int64_t iterations = ((const Implicit *)implicit->solver.own)->newton.iterations;
    most = iterations > most ? iterations : most;
  }
  assert_int_equal(implicit->solver.clock.step, 40);
  assert_int_equal(((const Implicit *)implicit->solver.own)->newton.follows, 1);
  if (most > 8 || !(difference(explicit, implicit) <= 0.02))
    fail_msg("%lld iterations, off by %g", (long long)most, difference(explicit, implicit));
  breccia_model_destroy(&explicit);
  breccia_model_destroy(&implicit);
}

static void accelerations_are_those_of_the_bonds_that_are_left(void **state)
{
  (void)state;
  breccia_model *m = model_of(BAR "  - {on: {face: x+, layers: 1}, force: [20, 0], history: {ramp to: 5e-3}}\n"
                                  "failure: {critical stretch: 1.5e-3, near grips: hold}\n"
                                  "solve: {implicit: {end time: 0.02, time step: 1e-3, local error: 1e9}}\n");
  while (!breccia_model_broken_bonds(m)) step_surely(m, 1);
  const Particles *p = m->domain.particles;
  const Implicit *s = m->solver.own;
  double largest = 0;
  for (int64_t n = 3; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double wanted = (p->internal.row[0][i] + p->external.row[0][i]) / p->density[i];
    largest = larger_of(largest, fabs(wanted));
    assert_near(s->acceleration.row[0][i], wanted, 1e-6 * largest + 1e-6);
  }
  assert_true(largest > 1e3);       /* both ends of the bond spring back */
  assert_near(s->next, 5e-4, 1e-9); /* waves take 4.3e-4 s across a horizon */
  breccia_model_destroy(&m);
}

/** A step that comes to no equilibrium leaves nothing behind, whether a shorter one is tried after it or the run ends. */
static void a_step_that_fails_is_taken_back(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      FLOWING
      "solve: {implicit: {end time: 0.06, time step: 4e-3, iterations: 3, local error: 1e9, smallest time step: "
      "0.9}}\n");
  int status = BRECCIA_OK;
  while (!status && !solver_is_done(&m->solver)) {
    StateCopy before = state_of(m);
    status = breccia_model_step(m, 1, NULL);
    if (status) {
      StateCopy after = state_of(m);
      assert_true(m->solver.clock.step > 0);
      for (int k = 0; k < before.count; ++k)
        if (memcmp(before.values[k], after.values[k], state_size(&before.rows[k]) * (size_t)before.rows[k].count))
          fail_msg("'%s' is not that of before", before.rows[k].name);
      state_copy_destroy(&after);
    }
    state_copy_destroy(&before);
  }
  assert_int_equal(status, BRECCIA_FAILURE);
  breccia_model_destroy(&m);
}

static breccia_model *broken_plate(const char *law)
{
  return model_of(
      UNITS
      "materials: {m: {model: %s, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 6]}}}}\n"
      "peridynamics: {space: plane strain}\n"
      "failure: {critical stretch: 4e-3, near grips: hold}\n"
      "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]},"
      " {on: {face: y+, layers: 2}, traction: [0, -5]}]\n"
      "solve:\n"
      "  - static: {increments: 1}\n"
      "  - implicit: {end time: 0.03, time step: 1e-3, scheme: HHT, damping: 20, stiffness damping: 1e-4}\n"
      "    loads: [{name: pull, on: {face: x+, layers: 2}, velocity: [0.4, free], history: {ramp to: 0.01}}]\n"
      "  - {without: [pull], explicit: {steps: 20}}\n"
      "results: {number: 4, checkpoint steps: 5}\n",
      law);
}

static void assert_same_bits_after_restart(const char *law)
{
  breccia_model *whole = broken_plate(law);
  run_all(whole);
  assert_true(breccia_model_broken_bonds(whole) > 0);
  const StageRecord *r = &whole->solver.records[1];
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  Error *error = breccia_error_create();
  breccia_run run = {
      .size = sizeof(breccia_run), .folder = folder, .steps = (int64_t)(r->first_step + r->last_step) / 2};
  breccia_model *first = broken_plate(law), *second = broken_plate(law);
  if (breccia_model_run(first, &run, error)) fail_msg("%s", breccia_error_text(error));
  assert_int_equal(first->solver.clock.stage, 1);
  run.restart = 1;
  run.steps = 0;
  if (breccia_model_run(second, &run, error)) fail_msg("%s", breccia_error_text(error));
  second->peaks = whole->peaks = (Peaks){0};
  model_forget_compressions(second), model_forget_compressions(whole);
  second->next_due = second->last_due = second->states_due = second->log_bytes = 0; /* of files */
  StateCopy found = state_of(second), expected = state_of(whole);
  assert_int_equal(found.count, expected.count);
  for (int k = 0; k < found.count; ++k)
    if (found.rows[k].count != expected.rows[k].count ||
        memcmp(found.values[k], expected.values[k], state_size(&found.rows[k]) * (size_t)found.rows[k].count))
      fail_msg("'%s' is not the same", found.rows[k].name);
  state_copy_destroy(&found);
  state_copy_destroy(&expected);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&first);
  breccia_model_destroy(&second);
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void bonds_break_and_a_restart_goes_on_to_the_same_bits(void **state)
{
  (void)state;
  assert_same_bits_after_restart("j2, yield stress: 40, hardening modulus: 100");
  assert_same_bits_after_restart("elastic"); /* whose factors are kept */
}

static void a_body_that_flies_freely_takes_whole_steps(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(UNITS SOFT_SOLID
               "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {from: [0, 0], "
               "to: [0.1, 0.1]}}}}\n"
               "peridynamics: {space: plane strain}\n"
               "loads: [{on: {block: b}, initial velocity: {translation: [3, -1]}}]\n"
               "solve: {implicit: {end time: 0.1, time step: 1e-2, scheme: HHT}}\n");
  step_surely(m, 10);
  assert_true(solver_is_done(&m->solver));
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    assert_near(p->displacement.row[0][p->place_of[n]], 0.3, 1e-12);
    assert_near(p->displacement.row[1][p->place_of[n]], -0.1, 1e-12);
  }
  breccia_model_destroy(&m);
}

static void keys_that_contradict_each_other_are_refused(void **state)
{
  (void)state;
  static const struct {
    const char *keys, *words;
  } cases[] = {{"scheme: HHT, beta: 0.3", "beta: it follows from 'alpha'"},
               {"alpha: -0.1", "alpha: it belongs to 'scheme: HHT'"},
               {"beta: 0.2", "beta: below gamma / 2"},
               {"damping: 3, Rayleigh damping: {ratio: 0.05, from: 1, to: 9}", "damping: 'Rayleigh damping' says it"},
               {"time step: 1e-45", "time step: 1e+45 steps are too many"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, BAR "solve: {implicit: {end time: 1, %s}}\n", cases[k].keys);
    char *words = refusal_of(deck);
    if (!strstr(words, cases[k].words)) fail_msg("%s", words);
    free(words);
  }
}

/** Equilibrium that is found only nearly makes accelerations err, whatever the step: cutting it further and further is of no use. */
static void no_step_is_shorter_than_the_smallest(void **state)
{
  (void)state;
  static const char *const residuals[] = {"1e-8", "1e-3"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(FLOWING "solve: {implicit: {end time: 0.06, time step: 4e-3, local error: 2e-3, residual: %s}}\n",
                 residuals[k]);
    while (!m->solver.clock.ended && m->solver.clock.step < 400) {
      assert_int_equal(breccia_model_step(m, 1, NULL), 0);
      if (m->solver.clock.time_step < 0.999e-4 * 4e-3 && !m->solver.clock.ended)
        fail_msg("a step of %g", m->solver.clock.time_step);
    }
    assert_true(m->solver.clock.ended);
    breccia_model_destroy(&m);
  }
}

/** Steps that are kept though they err by more than asked for are told of, once. */
static void steps_that_err_at_the_smallest_are_told(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        FLOWING "solve: {implicit: {end time: 0.06, time step: 4e-3, local error: %s, smallest time step: 0.5}}\n",
        k ? "1" : "1e-6");
    Text warning = {0};
    int told = 0;
    while (!m->solver.clock.ended) {
      Error *error = NULL;
      assert_int_equal(solver_advance(&m->solver, &warning, error), 0);
    }
    for (const char *at = text_words(&warning); (at = strstr(at, "cut to the 'smallest time step'")); ++at) ++told;
    assert_int_equal(told, k ? 0 : 1);
    text_free(&warning);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(errors_fall_with_the_square_of_the_step),
      cmocka_unit_test(average_acceleration_keeps_energy),
      cmocka_unit_test(hht_takes_energy_out_of_what_steps_are_too_long_for),
      cmocka_unit_test(rayleigh_damping_is_that_of_the_ratio),
      cmocka_unit_test(every_body_moves_as_by_explicit_steps),
      cmocka_unit_test(a_loads_slow_growth_gives_the_state_of_rest),
      cmocka_unit_test(steps_are_cut_where_newton_does_not_follow_and_by_their_error),
      cmocka_unit_test(a_step_that_fails_is_taken_back),
      cmocka_unit_test(what_flows_is_followed_in_few_iterations_whatever_its_damping),
      cmocka_unit_test(a_body_that_turns_is_followed),
      cmocka_unit_test(accelerations_are_those_of_the_bonds_that_are_left),
      cmocka_unit_test(bonds_break_and_a_restart_goes_on_to_the_same_bits),
      cmocka_unit_test(no_step_is_shorter_than_the_smallest),
      cmocka_unit_test(steps_that_err_at_the_smallest_are_told),
      cmocka_unit_test(a_body_that_flies_freely_takes_whole_steps),
      cmocka_unit_test(keys_that_contradict_each_other_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

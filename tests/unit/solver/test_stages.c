/* Runs in stages: loads, laws, damping and ends that change from one to the next. */
#include "support.h"

#include "deck/spelling.h"

#include <signal.h>
#include <unistd.h>

static void run_all(breccia_model *model)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, INT64_MAX, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

/** Mean shown displacement along x of the outermost particles at an end. */
static double shown_at(const breccia_model *model, bool right)
{
  const Particles *p = model->domain.particles;
  double low[3], high[3], sum = 0;
  int count = 0;
  particles_bounds(p, low, high);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (fabs(p->position[0][i] - (right ? high : low)[0]) > 1e-9) continue;
    sum += particles_moved(p, 0, i);
    ++count;
  }
  return sum / count;
}

#define BAR                                                                                                            \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}\n"                                              \
  "body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [80, 1], first "       \
  "particle: [0.025, 0]}}}}\n"                                                                                         \
  "peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings, surface correction: energy}\n"

static void gravity_then_a_load_give_what_each_gives_alone(void **state)
{
  (void)state;
  /* A bar hangs at its left end: rho g L^2 / (2 E) by its weight, then F L / (E A) by a force at its free end, shown from zero on. */
  const char *hold = "{on: {face: x-, layers: 3}, displacement: [0, 0]}",
             *pull = "{on: {face: x+, layers: 3}, force: [2, 0]}", *weight = "{gravity: [200, 0]}",
             *rest = "explicit: {end time: 2, damping: 300, rest: 1e-6}";
  breccia_model *chain = model_of(BAR "loads: [%s, %s]\nsolve:\n  - {name: own weight, %s}\n"
                                      "  - {name: pulled, displacements: zero, loads: [%s], %s}\n",
                                  hold, weight, rest, pull, rest),
                *kept =
                    model_of(BAR "loads: [%s, %s]\nsolve: [{%s}, {loads: [%s], %s}]\n", hold, weight, rest, pull, rest),
                *alone = model_of(BAR "loads: [%s, %s]\nsolve: {%s}\n", hold, pull, rest);
  while (chain->solver.clock.stage == 0) assert_int_equal(breccia_model_step(chain, 1, NULL), 0);
  const Particles *p = chain->domain.particles;
  const double under_weight = p->zero[0][p->place_of[79]];
  run_all(chain);
  run_all(kept);
  run_all(alone);
  const double length = 4 - 2.5 * 0.05, /* from the middle of what is held */
      by_weight = 2 * 200 * length * length / (2 * 1e6), by_force = 2 * (length - 1.5 * 0.05) / (1e6 * 0.01);
  assert_near(under_weight, by_weight, 0.03 * by_weight);
  assert_near(shown_at(chain, true), by_force, 0.03 * by_force);
  assert_near(shown_at(chain, true), shown_at(alone, true), 1e-4 * by_force);
  assert_near(shown_at(kept, true), under_weight + shown_at(alone, true), 1e-4 * by_force);
  for (int k = 0; k < 2; ++k) { /* before the 2 s that each may take */
    const StageRecord *r = &chain->solver.records[k];
    assert_true(r->came_to_rest == 1 && r->end - r->begin < 1.9);
  }
  assert_true(solver_energy(&chain->solver).imbalance < 5e-3);
  breccia_model_destroy(&chain);
  breccia_model_destroy(&kept);
  breccia_model_destroy(&alone);
}

/** A load that stays on does its whole work in a later stage at rest, one that comes then half of it: together half of both on the whole way. */
static void loads_that_stay_on_do_their_whole_work(void **state)
{
  (void)state;
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {gravity: [200, 0]}]\n"
                                  "solve:\n"
                                  "  - static: {increments: 1, residual: 1e-11}\n"
                                  "  - {loads: [{gravity: [300, 0]}], static: {increments: 2, residual: 1e-11}}\n");
  run_all(m);
  const Energy e = solver_energy(&m->solver);
  assert_near(e.damping, 0, 1e-9 * e.stored);
  assert_near(e.external, e.stored + e.damping, 1e-9 * e.stored);
  breccia_model_destroy(&m);
}

static void histories_and_motions_count_from_the_beginning_of_their_stage(void **state)
{
  (void)state;
  const char *deck =
      BAR "loads:\n"
          "  - {on: {face: x-, layers: 3}, displacement: [0, 0]}\n"
          "  - {name: jack, on: {face: x+, layers: 3}, velocity: [0.1, 0]}\n"
          "solve:\n"
          "  - explicit: {end time: 0.01, damping: 300}\n"
          "  - loads: [{name: jack, on: {face: x+, layers: 3}, displacement: [-2e-4, 0], history: {ramp to: "
          "0.005}}]\n"
          "    explicit: {end time: 0.006, damping: 300}\n"
          "  - loads: [{name: jack, on: {face: x+, layers: 3}, velocity: [0.2, 0]}]\n"
          "    explicit: {end time: 0.005, damping: 300}\n"
          "  - {without: [jack], explicit: {end time: 0.1, damping: 300}}\n";
  breccia_model *m = model_of("%s", deck);
  const double ends[] = {0.01, 0.016, 0.021}, moved[] = {1e-3, 0.8e-3, 1.8e-3};
  for (int k = 0; k < 3; ++k) {
    while (!m->solver.clock.ended || m->solver.clock.stage < k) assert_int_equal(breccia_model_step(m, 1, NULL), 0);
    assert_int_equal(m->solver.clock.stage, k);
    assert_near(m->solver.clock.time, ends[k], 1e-12);
    assert_near(shown_at(m, true), moved[k], 1e-12);
  }
  run_all(m);
  assert_near(shown_at(m, true), 0, 1e-6); /* the jack has let go */
  breccia_model_destroy(&m);
}

static void springs_blows_and_ties_begin_with_their_stage(void **state)
{
  (void)state;
  /* 80 particles, 2 t/m3 x 0.04 m3 = 80 kg, thrown at 2 m/s in the second stage, with a spring from where it is then. */
  breccia_model *m = model_of(BAR "loads: [{gravity: [3, 0]}]\nsolve:\n"
                                  "  - explicit: {end time: 0.1}\n"
                                  "  - loads: [{initial velocity: {translation: [2, 0]}}, {on: {all: yes}, spring: "
                                  "{stiffness: 8}}]\n"
                                  "    explicit: {end time: 0.1}\n"
                                  "  - loads: [{on: {all: yes}, tie: {}}, {on: {face: x+, layers: 40}, initial "
                                  "velocity: {translation: [-2, 0]}}]\n"
                                  "    explicit: {end time: 0.1}\n");
  const double mass = 0.08, w = sqrt(8 / mass), still = 3 / (w * w);
  while (!m->solver.clock.ended) assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  assert_near(shown_at(m, true), 3 * 0.01 / 2, 1e-9);
  assert_near(solver_energy(&m->solver).external, mass * 3 * 0.015, 1e-9);
  assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  while (!m->solver.clock.ended) assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  const double moved = still + 2 / w * sin(0.1 * w) - still * cos(0.1 * w),
               speed = 2 * cos(0.1 * w) + still * w * sin(0.1 * w);
  assert_near(shown_at(m, true), 0.015 + moved, 1e-5);
  Energy e = solver_energy(&m->solver);
  assert_near(e.stored, 8 * moved * moved / 2, 1e-4);
  const double blow = mass * (4 - 0.09) / 2; /* from 0.3 to 2 m/s */
  assert_near(e.external, mass * 3 * (0.015 + moved) + blow, 1e-4);
  assert_true(e.imbalance < 1e-4);
  /* Half of it is thrown back and tied to the rest at once: the common speed is the mean. */
  assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) assert_near(p->velocity.row[0][p->place_of[n]], (speed - 2) / 2, 2e-3);
  run_all(m);
  assert_true(solver_energy(&m->solver).imbalance < 1e-3);
  breccia_model_destroy(&m);
}

static void in_an_elastic_stage_laws_do_not_yield_and_bonds_do_not_break(void **state)
{
  (void)state;
  breccia_model *m =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: j2, density: 2, bulk modulus: 1e5, shear modulus: 6e4, yield stress: 100}}\n"
               "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [12, 4, 4]}}}}\n"
               "failure: {critical stretch: 1.5e-3, near grips: break}\n"
               "loads: [{on: {face: x-, layers: 3}, displacement: [0, free, free]},\n"
               "        {on: {face: x+, layers: 3}, displacement: [3e-3, free, free], history: {ramp to: 0.02}}]\n"
               "solve: [{laws: elastic, explicit: {end time: 0.05, damping: 100}}, {explicit: {end time: 0.01, "
               "damping: 100}}]\n");
  const int32_t middle = particles_nearest(m->domain.particles, (const double[3]){0.55, 0.15, 0.15});
  const Points *points = &m->domain.regions[0].points; /* whose stresses change places with those of the step before */
  while (!m->solver.clock.ended) assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  assert_near(points->stress[0][middle], 1.5e5 * points->strain[0][middle],
              0.05 * points->stress[0][middle]); /* E = 9KG / (3K + G) */
  assert_true(points->stress[0][middle] > 200);
  assert_int_equal(breccia_model_broken_bonds(m), 0);
  breccia_model_step(m, 1, NULL);
  assert_int_equal(m->solver.clock.stage, 1);
  assert_true(points->stress[0][middle] < 200);
  assert_true(breccia_model_broken_bonds(m) > 0);
  breccia_model_destroy(&m);
}

static void assert_same_state(const StateCopy *a, const StateCopy *b)
{
  assert_int_equal(a->count, b->count);
  for (int k = 0; k < a->count; ++k)
    if (a->rows[k].count != b->rows[k].count ||
        memcmp(a->values[k], b->values[k], state_size(&a->rows[k]) * (size_t)a->rows[k].count))
      fail_msg("'%s' is not the same", a->rows[k].name);
}

static breccia_model *struck_plate(void)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {clay: {model: multi-yield-j2, density: 1.5, shear modulus: 60000, bulk modulus: 100000, "
      "octahedral strength: 30}}\n"
      "body: {plate: {material: clay, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
      "[16, 12]}}}}\n"
      "peridynamics: {space: plane stress}\n"
      "failure: {critical stretch: 0.004, near grips: break}\n"
      "loads: [{on: {face: y-, layers: 3}, displacement: [free, 0]}, {gravity: [0, -50]}]\n"
      "solve:\n"
      "  - {name: own weight, laws: elastic, explicit: {end time: 0.5, local damping: 0.8, rest: 1e-3}}\n"
      "  - {name: pull, displacements: zero, explicit: {end time: 0.02, damping: 20},\n"
      "     loads: [{name: pull, on: {face: y+, layers: 2}, velocity: [free, 1], history: {ramp to: 0.01}}]}\n"
      "  - {name: let go, without: [pull], explicit: {steps: 150, safety: 0.5}}\n"
      "results: {number: 4, checkpoint steps: 50}\n");
}

static void a_restart_in_any_stage_goes_on_to_the_same_bits(void **state)
{
  (void)state;
  breccia_model *whole = struck_plate();
  run_all(whole);
  const StateCopy wanted = state_of(whole);
  assert_true(breccia_model_broken_bonds(whole) > 0);
  assert_true(whole->solver.records[0].came_to_rest == 1);
  for (int stage = 0; stage < 3; ++stage)
    for (int at_end = 0; at_end < 2; ++at_end) {
      if (under_sanitizers() && stage + at_end != 1) continue;
      char folder[] = "/tmp/breccia-XXXXXX", command[64];
      const StageRecord *r = &whole->solver.records[stage];
      assert_non_null(mkdtemp(folder));
      Error *error = breccia_error_create();
      breccia_run run = {.size = sizeof(breccia_run),
                         .folder = folder,
                         .steps = (int64_t)(at_end ? r->last_step : (r->first_step + r->last_step) / 2)};
      breccia_model *first = struck_plate(), *second = struck_plate();
      if (breccia_model_run(first, &run, error)) fail_msg("%s", breccia_error_text(error));
      assert_int_equal(first->solver.clock.stage, stage);
      run.restart = 1;
      run.steps = 0;
      if (breccia_model_run(second, &run, error)) fail_msg("%s", breccia_error_text(error));
      for (int k = 0; k < 3; ++k)
        assert_memory_equal(&second->solver.records[k], &whole->solver.records[k], sizeof(StageRecord));
      second->peaks = whole->peaks = (Peaks){0}; /* of the states written: none in a run by steps */
      model_forget_compressions(second), model_forget_compressions(whole);
      second->next_due = second->last_due = second->states_due = 0;
      const StateCopy found = state_of(second), expected = state_of(whole);
      assert_same_state(&expected, &found);
      StateCopy copies[] = {found, expected};
      for (int k = 0; k < 2; ++k) state_copy_destroy(&copies[k]);
      breccia_model_destroy(&first);
      breccia_model_destroy(&second);
      breccia_error_destroy(&error);
      snprintf(command, sizeof command, "rm -r %s", folder);
      assert_int_equal(system(command), 0);
    }
  StateCopy last = wanted;
  state_copy_destroy(&last);
  breccia_model_destroy(&whole);
}

static bool summary_has(const char *folder, const char *words)
{
  char path[80], text[8192];
  snprintf(path, sizeof path, "%s/summary.json", folder);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  return strstr(text, words);
}

/** The number in a column of each row of a history, up to `most`. @return how many */
static int column_of(const char *folder, const char *name, int column, double *values, int most)
{
  char path[80], line[512];
  int count = 0;
  snprintf(path, sizeof path, "%s/%s.csv", folder, name);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  assert_non_null(fgets(line, sizeof line, file));
  while (count < most && fgets(line, sizeof line, file)) {
    const char *at = line;
    for (int c = 0; c < column; ++c) at = strchr(at, ',') + 1;
    values[count++] = atof(at);
  }
  fclose(file);
  return count;
}

/** In the second stage a push and a grip that moves: they are watched from the beginning, as nothing. */
static void loads_of_later_stages_are_watched_from_the_beginning(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  breccia_model *model =
      model_of(BAR "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]\n"
                   "watch: {push: {load: push}, grip: {reaction of: grip}}\n"
                   "solve:\n"
                   "  - {static: {increments: 2}}\n"
                   "  - static: {increments: 2}\n"
                   "    loads:\n"
                   "      - {name: push, on: {face: x+}, force: [2, 0], history: {ramp to: 1}}\n"
                   "      - {name: grip, on: {nearest: [2, 0]}, displacement: [0.001, 0], history: {ramp to: 1}}\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
  double push[8], grip[8];
  assert_int_equal(column_of(folder, "push", 3, push, 8), 5);
  assert_int_equal(column_of(folder, "grip", 2, grip, 8), 5);
  for (int k = 0; k < 3; ++k) assert_true(push[k] == 0 && grip[k] == 0);
  assert_near(push[3], 1, 1e-12);
  assert_near(push[4], 2, 1e-12);
  assert_true(grip[3] > 0 && grip[4] > 1.9 * grip[3]);
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

/** A run of two steps, taken up and stopped at once: no state is written in it, and yet its last words are of the state in which it is. */
static void a_run_that_is_stopped_says_how_far_it_has_come(void **state)
{
  static const int now = 1;
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  Error *error = breccia_error_create();
  breccia_run run = {.size = sizeof run, .folder = folder, .steps = 2};
  for (run.restart = 0; run.restart < 2; ++run.restart, run.steps = 0, run.interrupted = &now) {
    breccia_model *model = model_of(
        BAR
        "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {name: push, on: {face: x+}, along: {direction: "
        "[1, 0], displacement: -2e-3}, history: {table: [[0, 0], [1, 1]]}}]\n"
        "results: {every: 100}\n"
        "solve: {static: {increments: 4}}\n");
    assert_int_equal(breccia_model_run(model, &run, error), run.restart ? BRECCIA_INTERRUPTED : BRECCIA_OK);
    const char *words = breccia_model_outcome(model);
    assert_true(summary_has(folder, "\"left\": "));
    if (!strstr(words, "at the end: displacement 1 mm") || !strstr(words, "peak -0.001 m") ||
        strstr(words, "inside out"))
      fail_msg("%s", words);
    breccia_model_destroy(&model);
  }
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static volatile int stop_asked;

static void ask_to_stop(int signal)
{
  (void)signal;
  stop_asked = 1;
}

/** A bar of metal that is pulled by more than it bears, and given iterations without end: a wish to stop is heard within the increment, and leaves the
 *  last state of rest, to the bit. */
static void a_wish_to_stop_is_heard_within_an_increment(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", command[128];
  assert_non_null(mkdtemp(folder));
  signal(SIGALRM, ask_to_stop);
  Error *error = breccia_error_create();
  breccia_run run = {.size = sizeof run, .folder = folder, .interrupted = &stop_asked};
  double *left[3];
  int64_t steps = 0;
  for (int k = 0; k < 2; ++k, run.steps = steps, run.interrupted = NULL) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10}}\n"
        "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
        "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
        "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}}, {on: {face: "
        "z-}, "
        "support: {held: across}}, {on: {face: x+, layers: 1}, traction: [40, 0, 0], history: {ramp to: 1}}]\n"
        "solve: {static: {increments: 8, method: relaxation, relaxation iterations: 1000000000}}\n"
        "results: {every: 100}\npictures: []\n");
    const Particles *p = m->domain.particles;
    if (k == 0) {
      alarm(1);
      assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_INTERRUPTED);
      steps = m->solver.clock.step;
      for (int c = 0; c < 3; ++c) {
        left[c] = malloc(sizeof(double) * (size_t)p->places);
        memcpy(left[c], p->displacement.row[c], sizeof(double) * (size_t)p->places);
      }
      print_message("stopped behind increment %lld\n", (long long)steps);
      snprintf(command, sizeof command, "grep -q 'Time Value=\"%g\"' %s/results.xdmf", m->solver.clock.time, folder);
      assert_int_equal(system(command), 0); /* pictures are of this state */
      assert_true(steps < 4);               /* of which the third would be beyond the strength */
    } else if (steps > 0) {
      assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_OK);
    }
    for (int c = 0; c < 3; ++c)
      assert_memory_equal(left[c], p->displacement.row[c], sizeof(double) * (size_t)p->places);
    breccia_model_destroy(&m);
  }
  for (int c = 0; c < 3; ++c) free(left[c]);
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

/** Metres for millimetres: a block that is pushed through itself comes to rest behind its face, in balance; and a bar
 * of steel that is drawn to hundreds of its lengths goes on to flow. Neither is a result. */
static void bodies_that_no_body_can_become_stop_the_run(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  breccia_error *error = breccia_error_create();
  breccia_run run = {.size = sizeof run, .folder = folder};
  breccia_model *m = model_of(
      "materials: {m: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1 m, thickness: 1 m, shape: {box: {from: [0, 0], to: [1, "
      "1]}}}}\n"
      "peridynamics: {space: plane strain}\n"
      "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: x-}, support: {held: across}},\n"
      "        {on: {face: y+}, displacement: [free, -3], history: {ramp to: 1}}]\n"
      "solve: {static: {increments: 1}}\n");
  assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_FAILURE);
  const char *words = breccia_model_outcome(m);
  if (!strstr(words, "warning: 100 particles are turned inside out, the first at [0.05, 0.05, 0] m"))
    fail_msg("%s", words);
  words = breccia_error_text(error);
  if (!strstr(words, "step 1 (time 1 s): particle ") || !strstr(words, " is turned inside out (det F = -"))
    fail_msg("%s", words);
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  m = model_of(/* flowing laws on bonds keep their strength */
               "units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, yield stress: 3 "
               "GPa}}\n"
               "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [0, 0], to: "
               "[1, 1]}}}}\n"
               "peridynamics: {formulation: hybrid, space: plane strain}\n"
               "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: x-}, support: {held: across}},\n"
               "        {name: press, on: {face: y+}, displacement: [free, -3], history: {ramp to: 1}}]\n"
               "solve: {static: {increments: 1}}\n");
  assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_FAILURE);
  words = breccia_error_text(error);
  if (!strstr(words, " is turned inside out (det F = -") || !strstr(words, "take smaller 'increments'") ||
      !strstr(words, "loads: displacement (line 6) at 3 m") || !strstr(words, " at [0."))
    fail_msg("%s", words);
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {c: {model: j2, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, yield stress: 3 MPa}}\n"
      "body: {beam: {material: c, lattice: square, spacing: 0.02, thickness: 0.1, shape: {box: {particles: [12, 6], "
      "first particle: [0, 0]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane stress}\n"
      "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}, {name: pull, on: {face: x+, layers: 1}, velocity: "
      "[1e5, free]}]\n"
      "solve: {explicit: {steps: 400}}\n");
  assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_FAILURE);
  words = breccia_error_text(error);
  if (!strstr(words, "step 100 (time ") || !strstr(words, "particles have moved apart by ")) fail_msg("%s", words);
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void histories_have_a_row_for_each_long_step(void **state)
{
  (void)state;
  /* Steps 1 to 3 are static, and of the others each tenth has a row; so too where a run is taken up in the middle. */
  static const int wanted[] = {0, 1, 2, 3, 10, 20, 30, 33};
  for (int stop = 0; stop < 26; stop += 5) {
    char folder[] = "/tmp/breccia-XXXXXX", path[64], line[256];
    breccia_run run = {.size = sizeof(breccia_run), .steps = stop};
    Error *error = breccia_error_create();
    assert_non_null(mkdtemp(folder));
    run.folder = folder;
    for (int part = stop ? 0 : 1; part < 2; ++part) {
      breccia_model *model =
          model_of(BAR "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {gravity: [20, 0, 0]}]\n"
                       "watch: {end: {displacement of: {nearest: [1, 0, 0]}}}\n"
                       "solve: [{static: {increments: 3}}, {explicit: {time step: 2e-5, steps: 30}}]\n");
      if (part) run.steps = 0;
      if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
      run.restart = 1;
      breccia_model_destroy(&model);
    }
    snprintf(path, sizeof path, "%s/end.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k) {
      assert_non_null(fgets(line, sizeof line, file));
      assert_int_equal(atoi(line), wanted[k]);
    }
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
    assert_true(summary_has(folder, "equilibrium") && !summary_has(folder, "\"left\"")); /* it vibrates */
    breccia_error_destroy(&error);
    snprintf(line, sizeof line, "rm -r %s", folder);
    assert_int_equal(system(line), 0);
  }
}

/** Of explicit steps behind others, whose number no one can foresee, all are done. */
static void explicit_steps_behind_long_ones_are_done(void **state)
{
  (void)state;
  const char *const before[] = {"static: {increments: 2}", "implicit: {end time: 1e-3, time step: 5e-4}"};
  for (int k = 0; k < 2; ++k) {
    char folder[] = "/tmp/breccia-XXXXXX", deck[1024], line[64];
    double times[64];
    assert_non_null(mkdtemp(folder));
    snprintf(deck, sizeof deck,
             BAR "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {gravity: [20, 0, 0]}]\n"
                 "watch: {end: {displacement of: {nearest: [1, 0, 0]}}}\n"
                 "solve: [{%s}, {explicit: {end time: 5e-3}}]\n",
             before[k]);
    breccia_model *model = model_of("%s", deck);
    breccia_run run = {.size = sizeof(breccia_run), .folder = folder};
    Error *error = breccia_error_create();
    assert_false(solver_foresees_steps(&model->solver));
    if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
    assert_true(summary_has(folder, "\"completed\": true"));
    const int count = column_of(folder, "end", 1, times, 64);
    assert_near(times[count - 1], k ? 6e-3 : 1.005, 1e-9);
    breccia_error_destroy(&error);
    breccia_model_destroy(&model);
    snprintf(line, sizeof line, "rm -r %s", folder);
    assert_int_equal(system(line), 0);
  }
}

static void one_stage_in_a_list_is_the_same_as_no_list(void **state)
{
  (void)state;
  breccia_model *plain =
                    model_of(BAR "loads: [{gravity: [200, 0]}]\nsolve: {explicit: {time step: 2e-5, steps: 200}}\n"),
                *list =
                    model_of(BAR "loads: [{gravity: [200, 0]}]\nsolve: [{explicit: {time step: 2e-5, steps: 200}}]\n"),
                *halves = model_of(
                    BAR
                    "loads: [{gravity: [200, 0]}]\n"
                    "solve: [{explicit: {time step: 2e-5, steps: 90}}, {explicit: {time step: 2e-5, steps: 110}}]\n");
  run_all(plain);
  run_all(list);
  run_all(halves);
  StateCopy a = state_of(plain), b = state_of(list);
  assert_same_state(&a, &b);
  assert_int_equal(halves->solver.clock.step, 200);
  const Particles *p = plain->domain.particles, *q = halves->domain.particles;
  assert_memory_equal(p->displacement.row[0], q->displacement.row[0], sizeof(double) * (size_t)p->places);
  state_copy_destroy(&a);
  state_copy_destroy(&b);
  breccia_model_destroy(&plain);
  breccia_model_destroy(&list);
  breccia_model_destroy(&halves);
}

/* A stage begins between two steps: no time passes, and nothing relaxes in it. */
static void laws_with_rates_do_not_see_where_a_stage_begins(void **state)
{
  (void)state;
  const char *const formulations[] = {"correspondence", "ordinary"};
  for (int f = 0; f < 2; ++f) {
    const char *deck =
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: viscoelastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.2, relaxing share: 0.5, "
        "relaxation time: 1e-3}}\n"
        "body: {bar: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
        "peridynamics: {formulation: %s}\nloads: [{on: {face: x+}, force: [10, 0, 0]}]\nsolve: [%s]\n";
    breccia_model *one = model_of(deck, formulations[f], "{explicit: {time step: 5e-5, steps: 60}}"),
                  *two = model_of(deck, formulations[f],
                                  "{explicit: {time step: 5e-5, steps: 25}}, {explicit: {time step: 5e-5, steps: 35}}");
    run_all(one);
    run_all(two);
    const Particles *p = one->domain.particles, *q = two->domain.particles;
    assert_memory_equal(p->displacement.row[0], q->displacement.row[0], sizeof(double) * (size_t)p->places);
    breccia_model_destroy(&one);
    breccia_model_destroy(&two);
  }
}

/* The second stage would have too many steps: the run stops, and its checkpoint is the end of the first one. */
static void a_stage_that_cannot_begin_leaves_the_one_before(void **state)
{
  (void)state;
  const char *deck =
      BAR "loads: [{on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, force: [1, 0]}]\nsolve:\n"
          "  - {explicit: {time step: 2e-5, steps: 40}}\n"
          "  - {explicit: {time step: 2e-5, end time: 1e12}, laws: elastic, displacements: zero, loads: [{on: {face: "
          "x+}, spring: {stiffness: 1}}, {initial velocity: {translation: [1, 0]}}]}\n";
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  breccia_run run = {.size = sizeof(breccia_run), .folder = folder};
  StateCopy ends[3];
  for (int k = 0; k < 3; ++k) { /* stepped to the end of the first stage; run on from there; taken up */
    breccia_model *m = model_of("%s", deck);
    Error *error = breccia_error_create();
    run.restart = k == 2;
    if (k == 0) {
      assert_int_equal(breccia_model_step(m, 40, NULL), 0);
      m->last_due = 40; /* by a run, as the end of a stage is */
      m->next_due = m->schedule_count;
    } else {
      assert_int_equal(breccia_model_run(m, &run, error), BRECCIA_USER_ERROR);
      assert_non_null(strstr(breccia_error_text(error), "steps are too many"));
    }
    assert_int_equal(m->solver.clock.stage, 0);
    assert_int_equal(m->solver.clock.step, 40);
    m->peaks = (Peaks){0}; /* and a count, of the states that a run writes */
    m->states_due = 0;
    ends[k] = state_of(m);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
  for (int k = 1; k < 3; ++k) assert_same_state(&ends[0], &ends[k]);
  for (int k = 0; k < 3; ++k) state_copy_destroy(&ends[k]);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

/** A key that looks like one under which names are defined, wrongly written, would hide that a name is not there (deck/names.c). */
static void no_key_is_taken_for_one_of_names(void **state)
{
  (void)state;
  static const char *const defining[] = {"materials", "body", "selections", "loads", "solve"};
  static const char *const name = "name";
  for (int k = 0; k < deck_section.field_count; ++k)
    for (size_t n = 0; n < sizeof defining / sizeof *defining; ++n)
      if (strcmp(deck_section.fields[k].key, defining[n]) &&
          spelling_nearest(deck_section.fields[k].key, &defining[n], 1))
        fail_msg("%s is like %s", deck_section.fields[k].key, defining[n]);
  for (int k = 0; k < solve_section.field_count; ++k)
    if (strcmp(solve_section.fields[k].key, "loads") && spelling_nearest(solve_section.fields[k].key, &defining[3], 1))
      fail_msg("%s is like loads", solve_section.fields[k].key);
  for (int k = 0; k < load_section.field_count; ++k)
    if (strcmp(load_section.fields[k].key, name) && spelling_nearest(load_section.fields[k].key, &name, 1))
      fail_msg("%s is like name", load_section.fields[k].key);
}

static void what_does_not_fit_is_said(void **state)
{
  (void)state;
  const struct {
    const char *solve, *words;
  } wrong[] = {
      {"solve: []\n", "solve: the list is empty"},
      {"solve: [{explicit: {steps: 1}}, {without: [jack], explicit: {steps: 1}}]\n",
       "without: no load that acts before this stage has the name 'jack'"},
      {"solve: {explicit: {steps: 1, rest: 1e-3}}\n", "rest: without 'damping' or 'local damping' a body"},
      {"solve: [{explicit: {steps: 1}}, {name: late, explicit: {steps: 1, time step: 1}}]\n", "times the stable step"},
      {"solve: [{explicit: {steps: 1}}, {loads: [{on: {face: x+}, spring: {stiffness: 1e9}}], explicit: {steps: 1, "
       "time "
       "step: 2e-5}}]\n",
       "times the stable step"},
      {"solve: [{laws: plastic, explicit: {steps: 1}}]\n", "elastic"},
      {"solve: [{name: nothing}]\n", "none of 'explicit'"},
      {"watch: {w: {load: a}}\nsolve: [{loads: [{name: a, gravity: [1, 0]}], explicit: {steps: 1}}, {loads: [{name: a, "
       "on: {face: x+}, force: [1, 0]}], explicit: {steps: 1}}]\n",
       "the loads of the name 'a' are of several kinds"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, BAR "loads: [{gravity: [200, 0]}]\n%s", wrong[k].solve);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    assert_non_null(strstr(words, "deck:"));
    free(words);
  }
}

/** A body that drifts freely has no forces out of balance, and is not at rest: damping c leaves exp(-2 c t) of its
 * kinetic energy, and the stage ends at the first look, every 100 steps, at which that is below the share asked for. */
static void a_body_that_drifts_is_at_rest_once_its_speed_is_damped(void **state)
{
  (void)state;
  const double damping = 2, share = 1e-3;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n" SOFT_SOLID
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                              "loads: [{initial velocity: {translation: [0.5, 0, 0]}}]\n"
                              "solve: {explicit: {end time: 10, damping: %g, rest: %g}}\npictures: []\n",
                              damping, share);
  step_surely(m, 1);
  const double look = 100 * m->solver.clock.time_step, wanted = ceil(log(1 / share) / (2 * damping) / look);
  step_surely(m, INT64_MAX);
  assert_true(m->solver.records[0].came_to_rest);
  assert_near((double)m->solver.clock.step, 100 * wanted, 0);
  assert_near(sums_of(m).moved[0], 0.5 / damping, 0.05 * 0.5 / damping);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_that_drifts_is_at_rest_once_its_speed_is_damped),
      cmocka_unit_test(gravity_then_a_load_give_what_each_gives_alone),
      cmocka_unit_test(loads_that_stay_on_do_their_whole_work),
      cmocka_unit_test(histories_and_motions_count_from_the_beginning_of_their_stage),
      cmocka_unit_test(springs_blows_and_ties_begin_with_their_stage),
      cmocka_unit_test(in_an_elastic_stage_laws_do_not_yield_and_bonds_do_not_break),
      cmocka_unit_test(a_restart_in_any_stage_goes_on_to_the_same_bits),
      cmocka_unit_test(loads_of_later_stages_are_watched_from_the_beginning),
      cmocka_unit_test(a_run_that_is_stopped_says_how_far_it_has_come),
      cmocka_unit_test(a_wish_to_stop_is_heard_within_an_increment),
      cmocka_unit_test(bodies_that_no_body_can_become_stop_the_run),
      cmocka_unit_test(histories_have_a_row_for_each_long_step),
      cmocka_unit_test(explicit_steps_behind_long_ones_are_done),
      cmocka_unit_test(one_stage_in_a_list_is_the_same_as_no_list),
      cmocka_unit_test(laws_with_rates_do_not_see_where_a_stage_begins),
      cmocka_unit_test(a_stage_that_cannot_begin_leaves_the_one_before),
      cmocka_unit_test(no_key_is_taken_for_one_of_names),
      cmocka_unit_test(what_does_not_fit_is_said),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

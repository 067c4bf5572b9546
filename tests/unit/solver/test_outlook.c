/* Expected times of runs that are made up: what a run would have said at each moment, against what it then took. */
#include "support.h"

#include "results/result_file.h"

enum { STEPS = 20000, TELLS = 100 };

typedef struct Story {
  const char *name;
  double (*step)(int64_t k, double now); /* seconds of step k that begins `now` */
  double expected;                       /* of a step, beforehand */
  int64_t state_every, checkpoint_every; /* steps; 0: none */
  double checkpoint_seconds;             /* between checkpoints; 0: none */
  double byte, checkpoint, state_bytes;  /* seconds of each; bytes of a state */
  double trusted;                        /* share of the whole time from which on the words must hold */
} Story;

static double steady(int64_t k, double now)
{
  (void)k, (void)now;
  return 0.01;
}
static double slow_start(int64_t k, double now)
{
  (void)now;
  return k < 300 ? 0.1 : 0.01;
}
static double neighbour_by_turns(int64_t k, double now)
{
  (void)k;
  return fmod(now, 40) < 20 ? 0.025 : 0.01;
}
static double neighbour_stays(int64_t k, double now)
{
  (void)k;
  return now > 60 ? 0.025 : 0.01;
}
static double neighbour_leaves(int64_t k, double now)
{
  (void)k;
  return now < 200 ? 0.03 : 0.01;
}

static const Story stories[] = {
    {"steady", steady, 0.01, .trusted = 0},
    {"nothing known beforehand", steady, 0, .trusted = 0.001},
    {"wrong beforehand", steady, 0.3, .trusted = 0.1},
    {"slow start", slow_start, 0.01, .trusted = 0.25},
    {"neighbour by turns", neighbour_by_turns, 0.01, .trusted = 0},
    {"neighbour who stays", neighbour_stays, 0.01, .trusted = 0.2},
    {"neighbour who leaves", neighbour_leaves, 0.03, .trusted = 0.7},
    {"checkpoints", steady, 0.01, .checkpoint_every = 400, .checkpoint = 3, .trusted = 0.05},
    {"checkpoints by time", steady, 0.01, .checkpoint_seconds = 20, .checkpoint = 12, .trusted = 0.2},
    {"states", steady, 0.01, .state_every = 100, .byte = 1e-8, .state_bytes = 1e6, .trusted = 0},
    {"many states on a slow disc", steady, 0.01, .state_every = 50, .byte = 3e-8, .state_bytes = 2e6, .trusted = 0.05},
};

/** Goes through a story. @return seconds; `moments` and `told` say when what was expected still to come */
static double live(const Story *s, double *moments, double *told)
{
  Outlook o;
  const double state_bytes = s->state_bytes > 0 ? s->state_bytes : 1;
  outlook_expect(&o, s->expected, state_bytes, 0, 0);
  o.picture_seconds = 0;
  double now = 0, last_checkpoint = 0, stepping = 0;
  Task task = {.steps = STEPS,
               .states = s->state_every ? STEPS / s->state_every : 0,
               .checkpoints = s->checkpoint_every ? STEPS / s->checkpoint_every : 0,
               .checkpoint_seconds = s->checkpoint_seconds > 0 ? s->checkpoint_seconds : INFINITY};
  for (int64_t k = 0; k < STEPS; ++k) {
    const double seconds = s->step(k, now);
    now += seconds;
    stepping += seconds;
    --task.steps;
    if (s->state_every && (k + 1) % s->state_every == 0) {
      const double bytes = state_bytes;
      pace_note(&o.bytes, bytes, bytes * s->byte);
      now += bytes * s->byte;
      ++task.states_written;
    }
    const bool by_step = s->checkpoint_every && (k + 1) % s->checkpoint_every == 0;
    if (by_step || (s->checkpoint_seconds > 0 && now - last_checkpoint > s->checkpoint_seconds)) {
      last_checkpoint = now;
      pace_note(&o.checkpoints, 1, s->checkpoint);
      now += s->checkpoint;
      task.checkpoints -= by_step;
    }
    if ((k + 1) % 20 == 0) {
      pace_note(&o.steps, 20, stepping);
      stepping = 0;
    }
    if ((k + 1) % (STEPS / TELLS) == 0) {
      moments[(k + 1) / (STEPS / TELLS) - 1] = now;
      told[(k + 1) / (STEPS / TELLS) - 1] = outlook_left(&o, &task);
    }
  }
  return now;
}

static void expected_times_hold_within_a_factor_of_two(void **state)
{
  (void)state;
  for (size_t n = 0; n < sizeof stories / sizeof *stories; ++n) {
    const Story *s = &stories[n];
    double moments[TELLS], told[TELLS];
    const double end = live(s, moments, told);
    for (int k = 0; k < TELLS - 1; ++k) {
      if (moments[k] < s->trusted * end) continue;
      const double left = end - moments[k], slack = s->checkpoint + 1;
      if (told[k] > 2 * left + slack || told[k] < left / 2 - slack)
        fail_msg("%s: after %.1f of %.1f s it said %.1f s, and it took %.1f s", s->name, moments[k], end, told[k],
                 left);
    }
  }
}

static void a_steady_run_is_told_exactly(void **state)
{
  (void)state;
  double moments[TELLS], told[TELLS];
  const double end = live(&stories[0], moments, told);
  assert_near(end, 200, 1e-6);
  for (int k = 0; k < TELLS; ++k) assert_near(told[k], end - moments[k], 1e-6);
}

/** A model tells beforehand what its steps then take, and telling changes nothing. */
static void asking_beforehand_changes_nothing(void **state)
{
  (void)state;
  breccia_model *models[2];
  for (int asked = 0; asked < 2; ++asked) {
    models[asked] = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {model: multi-yield-j2, density: "
                             "1.5, shear modulus: 60000, bulk modulus: 100000, octahedral strength: 30}}\nbody: {b: "
                             "{material: m, spacing: 0.1, shape: {box: {particles: [12, 9, 5]}}}}\nloads: [{on: {face: "
                             "x+, layers: 2}, velocity: [1, 0, 0]}, {on: {face: x-, layers: 2}, velocity: [0, 0, "
                             "0]}]\nsolve: {explicit: {steps: 40}}\n");
    if (asked) assert_non_null(strstr(breccia_model_overview(models[asked]), ", about "));
    breccia_model_step(models[asked], 20, NULL);
    if (asked) assert_non_null(strstr(breccia_model_overview(models[asked]), ", about "));
    breccia_model_step(models[asked], 20, NULL);
  }
  const size_t bytes = sizeof(double) * (size_t)breccia_model_places(models[0]);
  static const char *const arrays[] = {"displacement x", "velocity y", "force x", "stress xx", "strain xy"};
  for (int k = 0; k < 5; ++k)
    assert_memory_equal(breccia_model_array(models[0], arrays[k]), breccia_model_array(models[1], arrays[k]), bytes);
  for (int k = 0; k < 2; ++k) breccia_model_destroy(&models[k]);
}

#define SQUARE                                                                                                         \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: %s, density: 2, Young modulus: 1e4, Poisson ratio: 0.25%s}}\n"                               \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 8]}}}}\n"      \
  "peridynamics: {space: plane strain}\n"                                                                              \
  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}, {name: pull, on: {face: x+, layers: 1}, traction: [1, "  \
  "0], history: {ramp to: 0.5}}]\n"

/** Bodies whose steps at rest are as many as they seem are told a time, others the least. Time that is none of a clock is compared with no wave. */
static void what_nothing_tells_beforehand_is_told_as_the_least(void **state)
{
  (void)state;
  static const char rest[] = "the run: from rest to rest", grows[] = "grows over 500 ms of its stage, at rest\n";
  static const struct {
    const char *law, *keys, *solve, *time, *run, *load;
  } cases[] = {
      {"elastic", "", "{static: {increments: 4}}", " MB, about ", rest, grows},
      {"j2", ", yield stress: 1e3", "{static: {increments: 4}}", " MB, at least ", rest, grows},
      {"elastic", "", "{static: {increments: 4, method: relaxation}}", " MB, at least ", rest, grows},
      {"elastic", "", "[{static: {increments: 4}}, {static: {increments: 2}}]", " MB, at least ", rest, grows},
      {"elastic", "", "[{explicit: {end time: 1}}, {static: {increments: 2}}]", " MB, at least ",
       "the run: 1 s beside stages at rest, ", "travel times of a wave: "},
      {"elastic", "", "[{static: {increments: 4}}, {explicit: {end time: 1}}]", " MB, at least ",
       "the run: 1 s beside stages at rest, ", grows},
      {"elastic", "", "[{static: {increments: 4}}, {explicit: {steps: 9}}]", " MB, about ",
       "the run: steps beside stages at rest", grows},
      {"elastic", "", "{explicit: {end time: 1}}", " MB, about ", "the run: 1 s, ", "travel times of a wave: "}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *m = model_of(SQUARE "solve: %s\n", cases[c].law, cases[c].keys, cases[c].solve);
    const char *overview = breccia_model_overview(m);
    if (!strstr(overview, cases[c].time)) fail_msg("no '%s' in: %s", cases[c].time, overview);
    const char *words = breccia_model_plausibility(m);
    if (!strstr(words, cases[c].run)) fail_msg("no '%s' in: %s", cases[c].run, words);
    if (!strstr(words, cases[c].load)) fail_msg("no '%s' in: %s", cases[c].load, words);
    breccia_model_destroy(&m);
  }
}

/** From fractions of a second to hours. */
static void the_time_is_told_in_a_unit_that_suits(void **state)
{
  (void)state;
  static const struct {
    double unit, slack; /* seconds; half of the last digit */
    const char *word;
  } words[] = {{1, 0.51, "s"}, {60, 31, "min"}, {3600, 181, "h"}};
  bool met[3] = {false};
  for (double steps = 1; steps < 1e13; steps *= 10) {
    breccia_model *m = model_of(SQUARE "solve: {explicit: {time step: 1e-6, steps: %.0f}}\n", "elastic", "", steps);
    const char *about = strstr(breccia_model_overview(m), " MB, about ");
    const Task task = model_task(m, 0, m->solver.clock.steps, 0);
    const double seconds = outlook_left(&m->outlook, &task);
    assert_non_null(about);
    char *unit;
    const double told = strtod(about + strlen(" MB, about "), &unit);
    const int which = seconds < 100 ? 0 : seconds < 6000 ? 1 : 2;
    met[which] = true;
    const double slack = seconds < 10 ? 0.051 : words[which].slack;
    if (strcmp(unit + 1, words[which].word) != 0 || !(fabs(told * words[which].unit - seconds) <= slack))
      fail_msg("%g s are told as '%s'", seconds, about);
    breccia_model_destroy(&m);
  }
  assert_true(met[0] && met[1] && met[2]);
}

static void steps_of_later_stages_count_as_what_they_are(void **state)
{
  (void)state;
  /* 4 increments, then 12 of the same solver, or as many steps as the body needs; an evaluation of forces more for none of the first. */
  static const char *const later[] = {"{static: {increments: 12}}", "{explicit: {time step: 1e-3, steps: 12}}"};
  StepCost cost;
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(SQUARE "solve: [{static: {increments: 4}}, %s]\n", "elastic", "", later[k]);
    assert_int_equal(m->solver.clock.steps, 16);
    assert_int_equal(solver_measure(&m->solver, &cost, NULL), 0);
    assert_near(cost.evaluations, k ? 1.2 * 12 / 16 : 0, 1e-12);
    assert_true(cost.seconds > 0);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(expected_times_hold_within_a_factor_of_two),
      cmocka_unit_test(a_steady_run_is_told_exactly),
      cmocka_unit_test(what_nothing_tells_beforehand_is_told_as_the_least),
      cmocka_unit_test(the_time_is_told_in_a_unit_that_suits),
      cmocka_unit_test(steps_of_later_stages_count_as_what_they_are),
      cmocka_unit_test(asking_beforehand_changes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

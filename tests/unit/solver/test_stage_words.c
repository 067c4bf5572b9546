/* What is told of stages beforehand and at their end, each solver's, and that foreseen steps are those taken. */
#include "support.h"

#define BODY                                                                                                           \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 8]}}}}\n"      \
  "peridynamics: {space: plane strain}\n"
#define HELD "{on: {face: x-}, displacement: [0, 0]}"
#define LOADS "loads: [" HELD ", {name: pull, on: {face: x+}, traction: [1, 0], history: {ramp to: 0.5}}]\n"

static void has(const char *words, const char *wanted)
{
  if (!strstr(words, wanted)) fail_msg("no '%s' in: %s", wanted, words);
}

/** 12 x 8 particles, eight of them held: 88 times two unknowns. */
static void solvers_say_what_they_will_do(void **state)
{
  (void)state;
  static const struct {
    const char *solve, *words[3];
  } cases[] = {
      {"{static: {increments: 4}}", {"static, 4 increments up to time 1 s, for 176 unknowns, by ", NULL}},
      {"{static: {increments: 1, equations: direct}}",
       {"static, 1 increment up to time 1 s, for 176 unknowns, by ", NULL}},
      {"{static: {increments: 4, end time: 2.5, method: relaxation}}",
       {"static, 4 increments up to time 2.5 s, for 176 unknowns, by dynamic relaxation", NULL}},
      {"{implicit: {end time: 2, time step: 0.02}}",
       {"implicit, Newmark with beta 0.25 and gamma 0.5, 2 s by steps of at most 0.02 s", ", for 176 unknowns, by ",
        ", at least 100 steps, "}},
      /* local errors cut implicit steps; increments of elastic bodies are as many as asked for */
      {"[{static: {increments: 4}}, {implicit: {end time: 1, time step: 0.1}}]",
       {"14 steps at least, the first ", NULL}},
      {"[{static: {increments: 4}}, {static: {increments: 3}}]", {"7 steps at most, the first ", NULL}},
      {"{implicit: {end time: 2, beta: 0.4, gamma: 0.6, damping: 3}}",
       {"implicit, Newmark with beta 0.4 and gamma 0.6, 2 s by steps of at most 0.02 s, damping 3 1/s (", NULL}},
      {"{implicit: {end time: 2, scheme: HHT, alpha: -0.1, stiffness damping: 0.004}}",
       {"implicit, HHT with alpha -0.1, 2 s by steps of at most 0.02 s, stiffness damping 0.004 s (", NULL}},
      {"[{explicit: {steps: 7, local damping: 0.3}}, {explicit: {end time: 1, rest: 1e-4, damping: 5}}]",
       {"stage '1': explicit, 7 steps, local damping 0.3\n",
        "stage '2': explicit, until rest (0.0001), at most 1 s, damping 5 1/s\n", NULL}}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *m = model_of(BODY LOADS "solve: %s\n", cases[c].solve);
    for (int k = 0; k < 3 && cases[c].words[k]; ++k) has(breccia_model_overview(m), cases[c].words[k]);
    breccia_model_destroy(&m);
  }
}

/** Steps of implicit dynamics are compared with those of explicit dynamics, and warned of where they are shorter. */
static void implicit_steps_are_measured_by_explicit_ones(void **state)
{
  (void)state;
  breccia_model *m = model_of(BODY LOADS "solve: {explicit: {steps: 1}}\n");
  const double stable = m->solver.clock.stable;
  breccia_model_destroy(&m);
  const double shares[] = {0.5, 0.99, 1.01, 20};
  for (int k = 0; k < 4; ++k) {
    char words[128];
    m = model_of(BODY LOADS "solve: {implicit: {end time: 2, time step: %.17g}}\n", shares[k] * stable);
    snprintf(words, sizeof words, " (%.3g times the stable step of explicit dynamics)", shares[k]);
    has(breccia_model_overview(m), words);
    snprintf(words, sizeof words, "time step: %g s is below the stable step of %.4g s of explicit dynamics",
             shares[k] * stable, stable);
    assert_int_equal(strstr(breccia_model_warnings(m), words) != NULL, shares[k] < 1);
    breccia_model_destroy(&m);
  }
}

static void steps_close_to_the_stable_one_are_warned_of(void **state)
{
  (void)state;
  breccia_model *m = model_of(BODY LOADS "solve: {explicit: {steps: 1}}\n");
  const double stable = m->solver.clock.stable, shares[] = {0.5, 0.89, 0.91, 1};
  breccia_model_destroy(&m);
  for (int k = 0; k < 4; ++k) {
    char words[128];
    m = model_of(BODY LOADS "solve: {explicit: {time step: %.17g, steps: 1}}\n", shares[k] * stable * (1 - 1e-12));
    snprintf(words, sizeof words, "warning: time step: %g s is %.3g times the stable step of %.4g s",
             shares[k] * stable, shares[k], stable);
    assert_int_equal(strstr(breccia_model_warnings(m), words) != NULL, shares[k] > 0.9);
    breccia_model_destroy(&m);
  }
}

/** Of the deck, which need not be seconds. */
static void times_of_logs_have_their_unit(void **state)
{
  (void)state;
  static const struct {
    const char *solve, *words;
  } cases[] = {{"{static: {increments: 2, end time: 5}}", "increment 1, from time 0 to 2.5 ms\n"},
               {"{implicit: {end time: 40, time step: 20}}", "step 1, from time 0 to 20 ms\n"}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of("units: {length: m, force: kN, time: ms}\n"
                 "materials: {m: {model: elastic, density: 2e6, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                 "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: "
                 "{particles: [12, 8]}}}}\n"
                 "peridynamics: {space: plane strain}\n" LOADS "solve: %s\n",
                 cases[k].solve);
    step_surely(m, 1);
    has(text_words(&m->solver.log), cases[k].words);
    breccia_model_destroy(&m);
  }
}

/** A stage that is to end at rest says why it did not. */
static void a_stage_that_does_not_come_to_rest_says_why(void **state)
{
  (void)state;
  static const struct {
    const char *history, *words;
  } cases[] = {
      {"{ramp to: 0.02}", "warning: stage '1' ended at its end time, not at rest: forces out of balance are "},
      {"{ramp to: 5}", "warning: stage '1' ended at its end time, not at rest: a load or motion still changes"}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(BODY "loads: [" HELD ", {on: {face: x+}, traction: [1, 0], history: %s}]\n"
                      "solve: [{explicit: {end time: 0.05, local damping: 0.1, rest: 1e-4}}, {explicit: {steps: 2}}]\n",
                 cases[k].history);
    step_surely(m, INT64_MAX);
    has(breccia_model_warnings(m), cases[k].words);
    assert_int_equal(strstr(breccia_model_warnings(m), "kinetic energy ") != NULL, k == 0);
    breccia_model_destroy(&m);
  }
  breccia_model *m =
      model_of(BODY "loads: [" HELD ", {on: {face: x+}, traction: [1, 0]}]\n"
                    "solve: [{explicit: {steps: 60, local damping: 0.1, rest: 1e-4}}, {explicit: {steps: 2}}]\n");
  step_surely(m, INT64_MAX);
  has(breccia_model_warnings(m), "warning: stage '1' ended at its last step, not at rest: ");
  breccia_model_destroy(&m);
}

/** However many times ask for a step's end, and wherever they lie: as many steps are taken as were foreseen, and none is
 *  longer than it may be. */
static void steps_foreseen_are_those_taken(void **state)
{
  (void)state;
  static const char *const asked[] = {
      "results: {number: 1}\n", "results: {number: 7}\n",
      "results: {times: [0.001, 0.0010001, 0.004, 0.0139999, 0.014]}\n",
      "results: {number: 3}\npictures: [{field: displacement, at: [0.00313, 0.0072, 0.013]}]\n",
      "results: {times: [0.0137]}\nwatch: {e: {energy: yes, every: 3}}\n"};
  static const char *const solves[] = {"{explicit: {end time: 0.014}}", "{explicit: {end time: 0.014, safety: 0.31}}",
                                       "[{explicit: {end time: 0.008}}, {explicit: {end time: 0.006}}]"};
  for (size_t a = 0; a < sizeof asked / sizeof *asked; ++a)
    for (size_t s = 0; s < sizeof solves / sizeof *solves; ++s) {
      breccia_model *m = model_of(BODY LOADS "%ssolve: %s\n", asked[a], solves[s]);
      const int64_t foreseen = m->solver.clock.steps;
      const double longest = (s == 1 ? 0.31 : 0.8) * m->solver.clock.stable;
      int64_t taken = 0;
      for (double before = 0; !solver_is_done(&m->solver) && taken < 10000; ++taken) {
        step_surely(m, 1);
        assert_true(m->solver.clock.time > before && m->solver.clock.time - before <= longest * (1 + 1e-9));
        before = m->solver.clock.time;
      }
      /* of later stages the times asked for are not looked at before they begin */
      if (taken < foreseen || taken > foreseen + (s == 2 ? 5 : 0) || m->solver.clock.steps != taken)
        fail_msg("%s%s: %lld steps foreseen, %lld at the end, %lld taken", asked[a], solves[s], (long long)foreseen,
                 (long long)m->solver.clock.steps, (long long)taken);
      /* no more than one step more than the longest needs, for each stretch between two times */
      assert_true((double)taken <= ceil(0.014 / longest) + 12);
      assert_near(m->solver.clock.time, 0.014, 1e-15);
      breccia_model_destroy(&m);
    }
}

/** Of a chosen step: when broken bonds make it too long it is divided, and said so, and its multiples stay ends of
 *  steps. */
static void a_chosen_step_is_divided_where_bonds_that_break_stiffen_the_body(void **state)
{
  (void)state;
#define TORN                                                                                                           \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [24, 12]}}}}\n"     \
  "peridynamics: {space: plane strain, horizon: 3.015 spacings}\nfailure: {critical stretch: 1e-3, near grips: "       \
  "hold}\n"                                                                                                            \
  "loads: [{on: {face: x-, layers: 3}, velocity: [-0.4, 0.1], history: {ramp to: 0.03}}, {on: {face: x+, "             \
  "layers: 3}, velocity: [0.4, 0], history: {ramp to: 0.03}}]\n"
  breccia_model *m = model_of(TORN "solve: {explicit: {steps: 1}}\n");
  const double step = 0.95 * m->solver.clock.stable;
  breccia_model_destroy(&m);
  m = model_of(TORN "solve: {explicit: {time step: %.17g, steps: 700}}\n", step);
  int divided = 0;
  double shortest = INFINITY;
  while (m->solver.clock.time < 690 * step) {
    const double before = m->solver.clock.time, whole = floor(before / step + 1e-6) + 1;
    step_surely(m, 1);
    const double after = m->solver.clock.time;
    assert_true(after <= whole * step * (1 + 1e-9)); /* no step passes over a multiple */
    shortest = fmin(shortest, after - before);
    divided += after - before < 0.99 * step;
  }
  assert_true(breccia_model_broken_bonds(m) > 100);
  print_message("%lld broken, %d steps divided, shortest %.3f of the chosen one, stable %.3f\n",
                (long long)breccia_model_broken_bonds(m), divided, shortest / step, m->solver.clock.stable / step);
  assert_true(divided > 0 && shortest > 0.05 * step);
  has(breccia_model_warnings(m), "broken bonds have lowered the stable step to ");
  breccia_model_destroy(&m);
}

/** Whole rows of a lattice in a box that is none of them long. */
static void a_box_that_rows_do_not_fill_is_told(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                              "body: {slab: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.2, shape: "
                              "{box: {from: [0, 0], to: [2, "
                              "1]}}}}\n"
                              "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n");
  /* 12 rows, sqrt(3) / 2 of a spacing apart, stand for 1.0392 of 1 m: each particle is smaller by as much, and the mass
   * is that of the box */
  has(breccia_model_overview(m),
      "; rows of slab take 1.039 of their box along y, and each particle 0.9623 of its volume");
  has(breccia_model_overview(m), ", 800 kg;");
  const Sums sums = sums_of(m);
  assert_near(sums.mass, 2 * 1 * 0.2 * 2, 0.02);
  breccia_model_destroy(&m);
}

/** Loads whose size control finds have none beforehand; what is tied has a reach. */
static void loads_are_told_by_what_they_do(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      BODY "loads: [" HELD
           ", {name: drawn, on: {face: x+}, traction: [1, 0], history: {controlled: yes}}, {name: cap, on: "
           "{nearest: [1.15, 0.75]}, tie: {to: {nearest: [0.25, 0.75]}, directions: y}}]\n"
           "solve: {static: {increments: 2, control: {displacement of: {face: x+}, direction: [1, 0], to: 1e-5}}}\n");
  has(breccia_model_plausibility(m), "  load 'drawn': ");
  has(breccia_model_plausibility(m), "as much as control finds\n");
  has(breccia_model_plausibility(m), "  load 'cap': particles tied over at most 900 mm\n");
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solvers_say_what_they_will_do),
      cmocka_unit_test(implicit_steps_are_measured_by_explicit_ones),
      cmocka_unit_test(times_of_logs_have_their_unit),
      cmocka_unit_test(steps_close_to_the_stable_one_are_warned_of),
      cmocka_unit_test(a_stage_that_does_not_come_to_rest_says_why),
      cmocka_unit_test(steps_foreseen_are_those_taken),
      cmocka_unit_test(a_chosen_step_is_divided_where_bonds_that_break_stiffen_the_body),
      cmocka_unit_test(a_box_that_rows_do_not_fill_is_told),
      cmocka_unit_test(loads_are_told_by_what_they_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

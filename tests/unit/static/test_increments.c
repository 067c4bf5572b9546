/* Increments of bodies at rest: where they end, and how many are foreseen. */
#include "support.h"

#define BAR                                                                                                            \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}\n"                                     \
  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x+}, traction: [1, 0, 0], history: "      \
  "{ramp "                                                                                                             \
  "to: 1}}]\n"

/** Of four increments one is cut short by a state that is asked for at a time between two of them; the next begins there, as long as the others, and the number
 *  that is foreseen grows by one. */
static void a_time_that_is_asked_for_ends_its_own_increment_only(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 4}", "static: {increments: 4, method: relaxation}"};
  static const double wanted[] = {0.25, 0.5, 0.6, 0.85, 1};
  enum { COUNT = sizeof wanted / sizeof *wanted };
  for (size_t s = 0; s < sizeof solvers / sizeof *solvers; ++s) {
    breccia_model *m = model_of(BAR "solve: {%s}\nresults: {times: [0.6]}\npictures: []\n", solvers[s]);
    for (int n = 0; n < COUNT; ++n) {
      step_surely(m, 1);
      assert_near(m->solver.clock.time, wanted[n], 1e-9);
      const int left = (int)ceil((1 - wanted[n]) / 0.25 - 1e-6);
      assert_int_equal(m->solver.clock.stage_last, n + 1 + left);
    }
    assert_true(solver_is_done(&m->solver));
    breccia_model_destroy(&m);
  }
}

/** Two times within one increment end one each. */
static void times_within_one_increment_end_one_each(void **state)
{
  (void)state;
  static const double wanted[] = {0.1, 0.2, 0.7, 1};
  breccia_model *m = model_of(BAR "solve: {static: {increments: 2}}\nresults: {times: [0.1, 0.2]}\npictures: []\n");
  for (size_t n = 0; n < sizeof wanted / sizeof *wanted; ++n) {
    step_surely(m, 1);
    assert_near(m->solver.clock.time, wanted[n], 1e-9);
  }
  assert_true(solver_is_done(&m->solver));
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_time_that_is_asked_for_ends_its_own_increment_only),
      cmocka_unit_test(times_within_one_increment_end_one_each),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What held a body at rest, carried on as forces: under dashpots nothing moves and waves pass as without the weight; without it the body springs back. */
#include "support.h"

#define PLANE                                                                                                          \
  "units: {length: m, force: kN, time: s}\n" SOFT_SOLID                                                                \
  "body: {b: {material: m, lattice: square, spacing: 0.5, thickness: 1, shape: {box: {particles: [6, 20]}}}}\n"
#define GROUND PLANE "peridynamics: {formulation: %s, space: plane strain, horizon: 2.015 spacings%s}\n"
#define HELD                                                                                                           \
  "loads:\n"                                                                                                           \
  "  - {name: base, on: {face: y-, layers: 4}, displacement: [0, free]}\n"                                             \
  "  - {name: base, on: {face: y-, layers: 2}, roller: [0, 1]}\n"
#define WEIGHT "  - {gravity: [3, -9.81]}\n"

/** The most of all particles of a motion. */
static double largest(const Particles *p, double *const v[3])
{
  double most = 0;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) most = larger_of(most, fabs(v[k][p->place_of[n]]));
  return most;
}

static void what_held_the_weight_holds_it_under_dashpots(void **state)
{
  (void)state;
  static const char *const of[][2] = {{"ordinary", ""}, {"correspondence", ""}, {"hybrid", ", strain: small"}};
  static const char *const motions[] = {"explicit: {end time: 0.5}", "implicit: {end time: 0.5, time step: 0.02}"};
  for (int k = 0; k < 6; ++k) {
    breccia_model *m = model_of(GROUND HELD WEIGHT "solve:\n"
                                                   "  - static: {increments: 1, residual: 1e-11}\n"
                                                   "  - loads: [{reaction of: base}, {on: {face: y-}, dashpots: {}}]\n"
                                                   "    %s\n",
                                of[k / 2][0], of[k / 2][1], motions[k % 2]);
    const Particles *p = m->domain.particles;
    step_surely(m, 1);
    const Energy before = solver_energy(&m->solver);
    step_surely(m, INT64_MAX);
    assert_true(largest(p, p->displacement.row) > 0.01);
    assert_near(largest(p, p->velocity.row), 0, 1e-6 * 9.81 * 0.5); /* of free fall */
    assert_near(solver_energy(&m->solver).damping, before.damping, 1e-9);
    assert_near(solver_energy(&m->solver).external, before.external, 1e-6 * before.external);
    breccia_model_destroy(&m);
  }
}

/** Small strains add up: with the weight on, a wave moves the ground as it does without. */
static void waves_pass_through_ground_with_weight_as_without(void **state)
{
  (void)state;
  double top[2];
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(GROUND HELD "%s"
                                            "solve:\n"
                                            "  - static: {increments: 1, residual: 1e-11}\n"
                                            "  - loads:\n"
                                            "      - {reaction of: base}\n"
                                            "      - {on: {face: y-}, dashpots: {outcrop velocity: [1, 0.5]}, history: "
                                            "{sine: {frequency: 2 Hz, until: 0.5}}}\n"
                                            "    explicit: {end time: 0.6, time step: 1e-3}\n",
                                "hybrid", ", strain: small", k ? WEIGHT : "");
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    top[k] = p->velocity.row[0][p->place_of[p->count - 1]];
    breccia_model_destroy(&m);
  }
  assert_true(fabs(top[0]) > 0.05);
  assert_near(top[0], top[1], 1e-6);
}

#define PULLED                                                                                                         \
  PLANE "peridynamics: {formulation: hybrid, space: plane strain, horizon: 1.5 spacings, strain: small}\n"             \
        "loads:\n"                                                                                                     \
        "  - {name: left, on: {face: x-}, displacement: [0, 0]}\n"                                                     \
        "  - {name: jack, on: {face: x+}, along: {direction: [1, 1], displacement: 0.02}}\n"                           \
        "solve:\n"                                                                                                     \
        "  - static: {increments: 1, residual: 1e-11}\n"

/** As ground is dug away: half of the force leaves half of the displacement, and none leaves none. */
static void a_body_springs_back_as_its_reaction_goes(void **state)
{
  (void)state;
  breccia_model *m = model_of(PULLED "  - {loads: [{reaction of: jack, history: {table: [[0, 1], [2, 0]]}}], static: "
                                     "{increments: 2, residual: 1e-11, end time: 2}}\n");
  const Particles *p = m->domain.particles;
  const int32_t end = p->place_of[p->count - 1];
  double at_first[2];
  step_surely(m, 1);
  for (int k = 0; k < 2; ++k) at_first[k] = p->displacement.row[k][end];
  assert_near(at_first[0] + at_first[1], 0.02 * sqrt(2), 1e-12);
  step_surely(m, 1);
  for (int k = 0; k < 2; ++k) assert_near(p->displacement.row[k][end], at_first[k] / 2, 1e-9);
  step_surely(m, INT64_MAX);
  assert_near(largest(p, p->displacement.row), 0, 1e-10);
  assert_near(solver_energy(&m->solver).external, 0, 1e-9 * m->solver.ledger.paid);
  breccia_model_destroy(&m);
}

static void a_run_goes_on_from_a_checkpoint_with_the_same_forces(void **state)
{
  (void)state;
  breccia_model *models[2];
  for (int k = 0; k < 2; ++k) {
    models[k] = model_of(PULLED "  - {loads: [{reaction of: jack, history: {sine: {frequency: 3 Hz}}}], explicit: {end "
                                "time: 0.2}}\n");
    step_surely(models[k], 10);
  }
  step_surely(models[0], 10);
  StateCopy copy = state_of(models[0]);
  StateList list = {0};
  breccia_model *later = model_of("%s", breccia_model_deck(models[0]));
  step_surely(later, 2); /* into the second stage */
  for (int k = 0; k < 3; ++k) memset(later->domain.particles->displacement.row[k], 0, sizeof(double));
  model_state(later, &list);
  assert_int_equal(state_return(&copy, &list, NULL), 0);
  step_surely(models[0], 20);
  step_surely(later, 20);
  for (int k = 0; k < 2; ++k)
    assert_memory_equal(later->domain.particles->displacement.row[k], models[0]->domain.particles->displacement.row[k],
                        sizeof(double) * (size_t)later->domain.particles->places);
  state_list_destroy(&list);
  state_copy_destroy(&copy);
  breccia_model_destroy(&later);
  for (int k = 0; k < 2; ++k) breccia_model_destroy(&models[k]);
}

static void what_cannot_be_carried_on_is_refused(void **state)
{
  (void)state;
  static const char *const wrong[][2] = {
      {"{reaction of: jak}", "no load that acts before this stage prescribes a motion under the name 'jak'"},
      {"{reaction of: push}", "no load that acts before this stage prescribes a motion under the name 'push'"},
      {"{name: new, on: {face: y-}, displacement: [0, 0]}, {reaction of: new}", "no load that acts before this stage"},
      {"{reaction of: foot}", "'foot' is a support, whose particles stand outside the body"},
      {"{reaction of: jack, on: {face: x+}}", "on: 'reaction of' acts on the particles that 'jack' held"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[2048];
    snprintf(deck, sizeof deck,
             PLANE "peridynamics: {formulation: hybrid, space: plane strain}\n"
                   "loads:\n"
                   "  - {name: foot, on: {face: y-}, support: {held: across}}\n"
                   "  - {name: jack, on: {face: x+}, displacement: [0.1, free]}\n"
                   "  - {name: push, on: {face: x+}, force: [0, 1]}\n"
                   "solve: [{explicit: {steps: 1}}, {loads: [%s], explicit: {steps: 1}}]\n",
             wrong[k][0]);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k][1])) fail_msg("expected '%s', found '%s'", wrong[k][1], words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_held_the_weight_holds_it_under_dashpots),
      cmocka_unit_test(waves_pass_through_ground_with_weight_as_without),
      cmocka_unit_test(a_body_springs_back_as_its_reaction_goes),
      cmocka_unit_test(a_run_goes_on_from_a_checkpoint_with_the_same_forces),
      cmocka_unit_test(what_cannot_be_carried_on_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Stages at rest that find no equilibrium any more, and those that go on from there: through the failure in motion, and to rest again. */
#include "solver/reactions.h"
#include "support.h"

/* Of metal, on planes of symmetry; a list of loads goes on. */
#define METAL_BAR                                                                                                      \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening "       \
  "modulus: 0}}\n"                                                                                                     \
  "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"                                     \
  "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"                    \
  "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}},"                      \
  " {on: {face: z-}, support: {held: across}}"

/** Mean displacement along x of the outermost layer at the right. */
static double mean_end(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double low[3], high[3], sum = 0;
  int count = 0;
  particles_bounds(p, low, high);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[0][i] < high[0] - 1e-9) continue;
    sum += p->displacement.row[0][i];
    ++count;
  }
  return sum / count;
}

static void end_stage(breccia_model *m)
{
  const int64_t stage = m->solver.clock.stage;
  while (m->solver.clock.stage == stage && !m->solver.clock.ended) step_surely(m, 1);
}

/** A bar of metal that is pulled by more than it bears comes to its strength at rest, flows in motion while its load is taken back to half, and at rest
 *  again is longer by Hooke's law when it is loaded again. */
static void a_bar_flows_between_two_stages_at_rest(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      METAL_BAR
      ","
      " {name: pull, on: {face: x+, layers: 1}, traction: [12, 0, 0], history: {ramp to: 1}}]\n"
      "solve:\n"
      "  - {static: {increments: 12, no equilibrium: next stage}}\n"
      "  - {name: flow, loads: [{name: pull, on: {face: x+, layers: 1}, traction: [11, 0, 0], history: {table: [[0, "
      "1], [0.2, 1], [0.3, 0.4545454545]]}}], explicit: {end time: 2, local damping: 0.8, rest: 1e-7}}\n"
      "  - {loads: [{name: pull, on: {face: x+, layers: 1}, traction: [9, 0, 0], history: {table: [[0, 0.5555555556], "
      "[1, 1]]}}], static: {increments: 2}}\n");
  end_stage(m);
  const double failed = m->solver.clock.time, before = mean_end(m);
  print_message("no equilibrium beyond %.3f of the strength\n", failed * 12 / 10);
  assert_near(failed * 12, 10, 0.6);
  holds_words(breccia_model_warnings(m), "static: no equilibrium beyond time 0.|; stage 'flow' goes on from there");
  step_surely(m, 1);
  assert_int_equal(m->solver.clock.stage, 1);
  assert_true(m->solver.clock.time > failed);
  end_stage(m);
  const double flown = mean_end(m);
  assert_true(flown > before); /* it has flown, and unloaded by half */
  step_surely(m, INT64_MAX);
  assert_true(solver_is_done(&m->solver));
  assert_near(mean_end(m) - flown, 4.0 / 1e4 * 0.85,
              1e-3 * 4.0 / 1e4 * 0.85); /* from the plane of symmetry to the last layer */
  assert_balanced(m, 2e-2);
  breccia_model_destroy(&m);
}

/** All kinds of stages in a row: a bar of metal under its weight, by an elastic law and then by its own, which changes nothing; pulled, displacements
 *  counted from zero and stresses kept, until weight and load are its strength; in motion while the load is taken back; and at rest again, longer by
 *  Hooke's law as the load grows once more, with reactions that are weight and load. */
static void stages_of_all_kinds_follow_each_other(void **state)
{
  (void)state;
  const double weight = 0.4, length = 0.85,
               young = 1e4; /* stress at the support; from there to the middle of the last layer */
  breccia_model *m = model_of(
      METAL_BAR
      ", {gravity: [0.2222222222, 0, 0]}]\n"
      "solve:\n"
      "  - {laws: elastic, static: {increments: 1}}\n"
      "  - {static: {increments: 1}}\n"
      "  - {displacements: zero, loads: [{name: pull, on: {face: x+, layers: 1}, traction: [12, 0, 0], history: {ramp "
      "to: 1}}], static: {increments: 12, no equilibrium: next stage}}\n"
      "  - {loads: [{name: pull, on: {face: x+, layers: 1}, traction: [9, 0, 0], history: {table: [[0, "
      "1], [0.2, 1], [0.3, 0.3333333333]]}}], explicit: {end time: 2, local damping: 0.8, rest: 1e-7}}\n"
      "  - {loads: [{name: pull, on: {face: x+, layers: 1}, traction: [6, 0, 0], history: {table: [[0, 0.5], "
      "[1, 1]]}}], static: {increments: 2}}\n");
  const Particles *p = m->domain.particles;
  const Points *points = &m->domain.regions[0].points;
  const int32_t foot = particles_nearest(p, (const double[3]){0.05, 0.15, 0.15});
  end_stage(m);
  const double hung = mean_end(m);
  assert_near(hung, weight / young * (length - length * length / 2 / 0.9),
              0.01 * hung); /* to the middle of the last layer */
  step_surely(m, 1);
  assert_int_equal(m->solver.clock.stage, 1);
  assert_near(mean_end(m), hung, 1e-8 * hung);
  step_surely(m, 1);
  assert_int_equal(m->solver.clock.stage, 2);
  assert_near(points->stress[0][foot], weight * 0.85 / 0.9 + 1, 0.02); /* that of the weight is kept */
  const int32_t end = particles_nearest(p, (const double[3]){0.85, 0.15, 0.15});
  assert_near(particles_moved(p, 0, end), length / young, 0.01 * length / young);
  end_stage(m);
  const double failed = 12 * (m->solver.clock.time - 2);
  print_message("no equilibrium beyond %.2f of load and %.2f of weight, strength 10\n", failed, weight);
  assert_near(failed + weight, 10, 0.5);
  step_surely(m, 1);
  end_stage(m);
  assert_int_equal(m->solver.clock.stage, 3);
  const double flown = mean_end(m);
  step_surely(m, INT64_MAX);
  assert_true(solver_is_done(&m->solver));
  assert_near(mean_end(m) - flown, 3 / young * length, 2e-3 * 3 / young * length);
  Reactions reactions = {0};
  const double origin[3] = {0};
  assert_int_equal(reactions_create(&reactions, p, NULL), 0);
  const Wrench held = reactions_sum(&reactions, &m->solver, NULL, NULL, origin),
               loads = reactions_of_loads(&m->solver, origin);
  reactions_destroy(&reactions);
  assert_near(loads.force[0], 6 * 0.09 + 2 * 0.2222222222 * 0.9 * 0.09, 1e-6);
  assert_near(held.force[0], -loads.force[0], 1e-7 * loads.force[0]);
  assert_balanced(m, 2e-2);
  breccia_model_destroy(&m);
}

/** A brittle strip that a growing force tears: what is torn off flies on, with the momentum that the force gives it. */
static void what_is_torn_off_at_rest_flies_on(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [14, 4]}}}}\n"
      "cracks: [{cut: {line: [[0.65, -1], [0.65, 0.15]]}}]\n"
      "peridynamics: {formulation: bond-based, space: plane stress}\n"
      "failure: {critical stretch: 1e-3, near grips: hold}\n"
      "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}, {name: pull, on: {face: x+, layers: 3}, force: [20, "
      "0], history: {ramp to: 1}}]\n"
      "solve:\n  - {static: {increments: 40, no equilibrium: next stage}}\n"
      "  - {name: torn, explicit: {end time: 0.05}}\n");
  end_stage(m);
  const double begun = m->solver.clock.time;
  assert_true(begun < 0.99 && breccia_model_broken_bonds(m) > 0);
  holds_words(breccia_model_warnings(m), "static: no equilibrium beyond time 0.|; stage 'torn' goes on from there");
  step_surely(m, INT64_MAX);
  const double end = m->solver.clock.time, impulse = 20 * (end * end - begun * begun) / 2;
  const Particles *p = m->domain.particles;
  double momentum = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[0][i] > 0.8) momentum += p->density[i] * p->volume[i] * p->velocity.row[0][i];
  }
  print_message("torn at %.3f kN; momentum %.4f kNs beside an impulse of %.4f kNs\n", 20 * begun, momentum, impulse);
  assert_near(end - begun, 0.05, 1e-6);
  assert_true(momentum > 0.8 * impulse && momentum < 1.001 * impulse); /* the rest pulls until it is torn off */
  breccia_model_destroy(&m);
}

static void the_last_stage_has_none_to_go_on(void **state)
{
  (void)state;
  char *words = refusal_of(
      "units: {length: m, force: kN, time: s}\n" SOFT_SOLID
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 3, 3]}}}}\n"
      "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0, 0]}, {on: {face: x+, layers: 1}, force: [1, 0, 0]}]\n"
      "solve: [{static: {increments: 1}}, {static: {increments: 1, no equilibrium: next stage}}]\n");
  holds_words(words, "no equilibrium: no stage comes after this one");
  free(words);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bar_flows_between_two_stages_at_rest),
      cmocka_unit_test(stages_of_all_kinds_follow_each_other),
      cmocka_unit_test(what_is_torn_off_at_rest_flies_on),
      cmocka_unit_test(the_last_stage_has_none_to_go_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

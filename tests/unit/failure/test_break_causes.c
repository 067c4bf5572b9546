/* Reasons of broken bonds: causes, values and limits of all criteria, positions inside the body; identical reasons
 * after a restart. */
#include "support.h"

#include "domain/domain.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define HOOKE "model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25"

/** Creates a notched plate of one formulation that is torn at a given rate. */
static breccia_model *plate_of(int threads, const char *formulation, const char *failure, const char *solver)
{
  return model_on(threads,
                  UNITS "materials: {m: {%s}}\n"
                        "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
                        "[16, 9]}}}}\n"
                        "cracks: [{cut: {line: [[0.8, 0.45], [0.8, 1]]}}]\n"
                        "peridynamics: {space: plane strain, %s}\nfailure: {%s}\n"
                        "loads: [{on: {face: x-}, support: {held: across}}, {on: {nearest: [0, 0.45]}, displacement: "
                        "[free, 0]}, {on: {face: x+, layers: 2}, displacement: [0.03, 0.002], history: {ramp to: 1}}]\n"
                        "solve: {%s}\n",
                  strstr(formulation, "bond-based") ? "model: elastic-1d, density: 2, Young modulus: 1e4" : HOOKE,
                  formulation, failure, solver);
}

static const struct {
  const char *formulation, *failure;
  double limit; /* limit of the criterion */
} plates[] = {
    {"formulation: bond-based, horizon: 3.015 spacings", "critical stretch: 2e-3", 2e-3},
    {"formulation: bond-based, horizon: 3.015 spacings", "criterion: critical bond energy, bond energy: 0.5", 0.5},
    {"formulation: ordinary, horizon: 3.015 spacings", "critical stretch: 2e-3", 2e-3},
    {"formulation: ordinary, horizon: 3.015 spacings", "criterion: critical bond energy, bond energy: 0.5", 0.5},
    {"formulation: correspondence, horizon: 2.015 spacings", "critical stretch: 2e-3", 2e-3},
    {"formulation: micropolar, horizon: 1.5 spacings", "critical stretch: 2e-3", 2e-3},
    {"formulation: hybrid, horizon: 1.5 spacings", "critical stretch: 2e-3", 2e-3},
    {"formulation: hybrid, horizon: 1.5 spacings", "criterion: critical bond energy, bond energy: 0.5", 0.5},
    {"formulation: hybrid, horizon: 1.5 spacings", "criterion: critical bond stress, bond tensile strength: 20", 20},
    {"formulation: correspondence, horizon: 2.015 spacings", "criterion: critical bond energy, bond energy: 0.5", 0.5},
};
static const char *const solvers[] = {"explicit: {end time: 0.5, time step: 2e-4}",
                                      "static: {increments: 8, end time: 0.7}"};

static void broken_bonds_tell_value_limit_and_place(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof plates / sizeof *plates; ++k)
    for (int s = 0; s < 2; ++s) {
      breccia_model *m = plate_of(1, plates[k].formulation, plates[k].failure, solvers[s]);
      breccia_error *error = breccia_error_create();
      breccia_model_step(m, INT64_MAX, error); /* to the end, or to where no equilibrium is left */
      const Domain *d = &m->domain;
      print_message("%s, %s: %lld bonds broken, the first at %g of %g\n", plates[k].formulation, solvers[s],
                    (long long)d->broken_count, d->broken_count ? d->broken[0].value : 0, plates[k].limit);
      assert_true(d->broken_count > 5);
      for (int64_t n = 0; n < d->broken_count; ++n) {
        const BrokenBond *bond = &d->broken[n];
        double middle[3];
        domain_bond_middle(d, (const int32_t[]){bond->a, bond->b}, middle);
        assert_true(middle[0] >= 0 && middle[0] <= 1.6 && middle[1] >= 0 && middle[1] <= 0.9 && middle[2] == 0);
        if (bond->cause == BREAK_LIMIT) {
          assert_near(bond->limit, plates[k].limit, 1e-12 * plates[k].limit);
          assert_true(bond->value > bond->limit * (1 - 1e-12));
        } else {
          assert_int_equal(bond->cause, BREAK_ISOLATED);
          assert_true(bond->limit == FORMULATION_LEAST_EVENNESS && bond->value >= 0 && bond->value <= bond->limit);
        }
      }
      assert_int_equal(d->broken[0].cause, BREAK_LIMIT);
      assert_true(d->broken[0].value < (s ? 5 : 1.5) * plates[k].limit); /* increments are longer than steps */
      breccia_error_destroy(&error);
      breccia_model_destroy(&m);
    }
}

/** In a body without images the stored stretch equals the stretch of the positions at the time of the break. */
static void stretch_told_is_that_of_the_two_particles(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
            "body: {b: {material: m, lattice: line, area: 1, spacing: 1, shape: {box: {particles: [12, 1, 1]}}}}\n"
            "peridynamics: {formulation: bond-based, space: 1-D, horizon: 1.2}\nfailure: {critical stretch: 2e-3}\n"
            "solve: {explicit: {time step: 1e-4, steps: 3}}\n");
  const Particles *p = m->domain.particles;
  for (int32_t n = 5; n < 12; ++n) p->displacement.row[0][p->place_of[n]] = 5e-3;
  step_surely(m, 1);
  assert_int_equal(m->domain.broken_count, 1);
  const BrokenBond *bond = &m->domain.broken[0];
  assert_true(bond->a == 4 && bond->b == 5 && bond->cause == BREAK_LIMIT);
  const double *u = p->displacement.row[0], stretch = u[p->place_of[5]] - u[p->place_of[4]]; /* of a bond 1 m long */
  assert_near(stretch, 5e-3, 1e-6);
  assert_near(bond->value, stretch, 1e-15);
  assert_near(bond->limit, 2e-3, 1e-15);
  breccia_model_destroy(&m);
}

/** Bonds of hybrid points that lose their other members break as isolated, as the other causes are excluded. */
static void bonds_without_members_are_isolated(void **state)
{
  (void)state;
  int64_t isolated = 0;
  for (int s = 0; s < 2; ++s) {
    breccia_model *m = plate_of(1, "formulation: hybrid, horizon: 1.5 spacings", "critical stretch: 1e-3",
                                s ? solvers[1] : "explicit: {end time: 1, time step: 2e-4}");
    breccia_error *error = breccia_error_create();
    breccia_model_step(m, INT64_MAX, error);
    for (int64_t n = 0; n < m->domain.broken_count; ++n) isolated += m->domain.broken[n].cause == BREAK_ISOLATED;
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
  assert_true(isolated > 0);
}

static breccia_model *torn_plate(int threads)
{
  return plate_of(threads, plates[0].formulation, plates[0].failure, solvers[0]);
}

static void causes_come_back_with_a_state(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(torn_plate, 1500, 2000);
  breccia_model *m = torn_plate(1), *other = torn_plate(1);
  step_surely(m, 2000);
  StateCopy copy = state_of(m);
  StateList list = {0};
  model_state(other, &list);
  assert_int_equal(state_return(&copy, &list, NULL), 0);
  assert_int_equal(other->domain.broken_count, m->domain.broken_count);
  for (int64_t n = 0; n < m->domain.broken_count; ++n) {
    const BrokenBond *one = &m->domain.broken[n], *back = &other->domain.broken[n];
    assert_true(one->step == back->step && one->time == back->time && one->a == back->a && one->b == back->b);
    assert_true(one->cause == back->cause && one->value == back->value && one->limit == back->limit);
    assert_true(one->quantity == back->quantity && one->material == back->material);
  }
  state_list_destroy(&list);
  state_copy_destroy(&copy);
  breccia_model_destroy(&m);
  breccia_model_destroy(&other);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(broken_bonds_tell_value_limit_and_place),
      cmocka_unit_test(stretch_told_is_that_of_the_two_particles),
      cmocka_unit_test(bonds_without_members_are_isolated),
      cmocka_unit_test(causes_come_back_with_a_state),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

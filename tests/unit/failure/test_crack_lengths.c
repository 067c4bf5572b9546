/* Lengths by crack normal in increments in which elastic points begin to soften (solver/newton.h,
 * constitutive/normal_lengths.h). */
#include "support.h"

/** Returns the stress along the diagonal x = y at the particle nearest to the origin. */
static double stress_in_the_middle(const Domain *d)
{
  double stress[6], nearest = INFINITY;
  int64_t middle = 0;
  for (int64_t i = 0; i < d->particles->count; ++i) {
    const int64_t place = d->particles->place_of[i];
    const double apart = hypot(d->particles->position[0][place], d->particles->position[1][place]);
    if (apart < nearest) middle = place;
    nearest = fmin(nearest, apart);
  }
  d->regions[0].type->stress(d->regions[0].formulation, middle, stress);
  return (stress[0] + stress[1]) / 2 + stress[3];
}

/** Returns the stress along the diagonal in the middle of a block of hybrid bonds. The block is strained along its
 *  diagonal, in the middle to about seven times the elastic limit. All particles except those in the middle have
 *  prescribed displacements. A second block, which stays elastic, takes most of the work of the loads, so that
 *  increments in which points soften are not cut.
 *  @param[in] solve  text of the section 'solve' */
static double stress_along_diagonal(const char *law, double horizon, const char *solve)
{
  const double stretch = 7e-4;
  breccia_model *m = model_of(
      "units: {length: m, force: N, time: s}\n"
      "materials: {m: {%s, density: 1e-6, Young modulus: 1e4, Poisson ratio: 0, fracture energy: 4e-4},\n"
      "            e: {model: elastic, density: 1e-6, Young modulus: 1e6, Poisson ratio: 0}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [-0.75, -0.75], "
      "to: [0.75, 0.75]}}},\n"
      "       c: {material: e, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [2.25, -0.75], to: "
      "[3.75, "
      "0.75]}}}}\n"
      "peridynamics: {formulation: hybrid, strain: small, horizon: %g, space: plane stress}\n"
      "loads: [{on: {all: yes, except: {inside: {box: {from: [-0.05, -0.05], to: [0.05, 0.05]}}}}, history: {ramp to: "
      "1},\n"
      "  field: {displacement: ['%g*(x+y)*(1+(x+y)/(5 m))', '%g*(x+y)*(1+(x+y)/(5 m))']}}]\nsolve: {%s}\n",
      law, horizon, stretch / 2, stretch / 2, solve);
  assert_int_equal(breccia_model_step(m, INT64_MAX, NULL), 0);
  const double stress = stress_in_the_middle(&m->domain);
  breccia_model_destroy(&m);
  return stress;
}

static void one_increment_from_elastic_far_into_softening_has_the_stress_of_many(void **state)
{
  (void)state;
  static const char *const laws[] = {"model: mazars, tensile strength: 1",
                                     "model: damage-plasticity, tensile strength: 1, compressive strength: 10",
                                     "model: link-damage, tensile stretch: 1e-4"};
  static const char *const ways[] = {"static: {increments: 1}",
                                     "static: {increments: 2}",
                                     "static: {increments: 10}",
                                     "static: {increments: 1, method: relaxation}",
                                     "static: {increments: 10, method: relaxation}",
                                     "implicit: {end time: 1, time step: 0.1, local error: 1}"};
  for (int law = 0; law < 3; ++law)
    for (int k = 0; k < 2; ++k) {
      const double many = stress_along_diagonal(laws[law], k ? 0.15 : 0.2015, "static: {increments: 200}");
      assert_true(many > 0.05 && many < 0.9);
      for (int way = 0; way < 6; ++way) {
        const double found = stress_along_diagonal(laws[law], k ? 0.15 : 0.2015, ways[way]);
        print_message("%.25s, %s: %.4f of the stress after 200 increments\n", laws[law], ways[way], found / many);
        assert_near(found / many, 1, way == 0 || way == 3 ? 0.04 : 0.01);
      }
    }
}

static void lengths_of_a_failed_try_are_dropped(void **state)
{
  (void)state;
  const double e = 3.5e-4;
  breccia_model *m =
      model_of("materials: {m: {model: mazars, tensile strength: 1, density: 1, Young modulus: 1e4, Poisson ratio: 0, "
               "fracture energy: 4e-4}}\n"
               "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [-0.75, "
               "-0.75], to: [0.75, 0.75]}}}}\n"
               "peridynamics: {formulation: hybrid, strain: small, space: plane stress}\n"
               "solve: {explicit: {steps: 1, time step: 1e-9}}\n");
  deform_uniformly(m, (const double[]){1 + e, e, 0, e, 1 + e, 0, 0, 0, 1});
  compute_forces(m);
  const double first = stress_in_the_middle(&m->domain);
  assert_true(domain_take_lengths(&m->domain) > 0);
  assert_int_equal(domain_take_lengths(&m->domain), 0);
  compute_forces(m);
  const double taken = stress_in_the_middle(&m->domain);
  assert_true(fabs(taken - first) > 0.05 * first);
  domain_drop_lengths(&m->domain);
  compute_forces(m);
  assert_near(stress_in_the_middle(&m->domain), first, 0);
  /* Points that were damaged in an earlier step keep their lengths. */
  domain_commit_points(&m->domain);
  domain_drop_lengths(&m->domain);
  assert_int_equal(domain_take_lengths(&m->domain), 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_increment_from_elastic_far_into_softening_has_the_stress_of_many),
      cmocka_unit_test(lengths_of_a_failed_try_are_dropped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

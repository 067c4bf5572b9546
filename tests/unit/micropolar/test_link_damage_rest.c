/* Damage of links at rest: the ways to rest against each other and against slow explicit dynamics. */
#include "support.h"

#include "solver/reactions.h"

/** A bar notched from both sides, so that one crack goes through 50 mm x 50 mm; drawn by 0.15 mm. */
static breccia_model *notched(double spacing, const char *solver)
{
  breccia_model *model = model_of(
      "units: {length: mm, force: N, time: s}\n"
      "materials: {m: {model: link-damage, density: 2.4 t/m3, Young modulus: 24.86 GPa, Poisson ratio: 0.2, tensile "
      "stretch: 7e-5, compressive stretch: 7e-4, fracture energy: 80 N/m}}\n"
      "body: {b: {material: m, lattice: hexagonal, spacing: %g, thickness: 50, shape: {box: {from: [0, 0], to: [100, "
      "100]}}}}\n"
      "cracks: [{cut: {line: [[-10, 50.6], [25, 50.6]]}}, {cut: {line: [[75, 50.6], [110, 50.6]]}}]\n"
      "peridynamics: {formulation: micropolar, space: plane stress}\n"
      "loads: [{on: {face: y-, layers: 2}, displacement: [free, 0]}, {on: {nearest: [0, 0]}, displacement: [0, free]},"
      " {name: top, on: {face: y+, layers: 2}, displacement: [free, 0.15], history: {%s}}]\nsolve: {%s}\n",
      spacing, strstr(solver, "explicit") ? "ramp to: 0.05" : "table: [[0, 0], [0.5, 0.15], [1, 1]]", solver);
  model->threads = 1; /* of bodies so small more only wait */
  return model;
}

/** Force that the moving grip exerts. */
static double pull(const breccia_model *model)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, model->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &model->solver, NULL, "top", NULL);
  reactions_destroy(&reactions);
  return sum.force[1];
}

/** Runs to the end. @param[out] most  of the pull */
static void run(breccia_model *model, double *most)
{
  *most = 0;
  for (int64_t k = 0; !model->solver.clock.ended; ++k) {
    step_surely(model, 1);
    if (model->solver.type->rests || k % 50 == 0) *most = larger_of(*most, pull(model));
  }
}

/** By Newton's method, which goes by secants here, by relaxation, and by explicit dynamics that is slow: the same strength, within 2 %. At rest more links
 *  are damaged beside the crack than in a body that moves. */
static void all_ways_find_the_same_strength(void **state)
{
  (void)state;
  static const char *const ways[] = {"static: {increments: 60}", "static: {increments: 60, method: relaxation}",
                                     "explicit: {end time: 0.05, local damping: 0.3}"};
  double most[3], spent[3];
  for (int k = 0; k < 3; ++k) {
    breccia_model *model = notched(10, ways[k]);
    run(model, &most[k]);
    const Energy e = solver_energy(&model->solver);
    spent[k] = e.dissipated;
    assert_balanced(model, 1e-6);
    print_message("%s: strength %g, spent %g\n", ways[k], most[k], spent[k]);
    breccia_model_destroy(&model);
  }
  for (int k = 1; k < 3; ++k) {
    assert_near(most[k] / most[0], 1, 0.02);
    assert_near(spent[k] / spent[0], 1, k == 1 ? 1e-3 : 0.08);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_ways_find_the_same_strength),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* How stiff strips of few rows of hybrid bonds are when they are bent: bonds beside a free side have the strain of members that are nearer to the axis than they are. */
#include "support.h"

/** Energy of a strip of unit spacing, thickness and Young modulus that is bent to a circle of curvature 1e-9, over that curvature squared; 0.2 is its Poisson ratio. */
static double energy_of(int columns, int rows, double horizon)
{
  const double curvature = 1e-9;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, density: 2, Young modulus: 1, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [%d, %d], first "
      "particle: [0, 0]}}}}\n"
      "peridynamics: {formulation: hybrid, space: plane stress, strain: small, horizon: %g spacings}\n"
      "solve: {explicit: {steps: 1}}\n",
      columns, rows, horizon);
  const Particles *p = m->domain.particles;
  double energy = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double x = p->position[0][i], y = p->position[1][i] - (rows - 1) / 2.0;
    p->displacement.row[0][i] = -curvature * x * y;
    p->displacement.row[1][i] = curvature * (x * x + 0.2 * y * y) / 2;
  }
  compute_forces(m);
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 2; ++k) {
      const int32_t i = p->place_of[n];
      energy -= 0.5 * p->internal.row[k][i] * p->volume[i] * p->displacement.row[k][i];
    }
  breccia_model_destroy(&m);
  return energy / (curvature * curvature);
}

/** Bending stiffness over E I, without what ends of strips have of their own. The figures are those of a program of its own that writes section 5 of
 *  docs/theory.md out for one column of particles. */
static void strips_are_softer_in_bending_by_one_over_their_rows_squared(void **state)
{
  (void)state;
  static const struct {
    double horizon;
    int rows;
    double stiffness;
  } known[] = {{1.5, 10, 0.936978},   {1.5, 20, 0.983239},   {1.5, 40, 0.995684},
               {2.015, 10, 0.908819}, {2.015, 20, 0.974525}, {2.015, 40, 0.993296}};
  for (size_t k = 0; k < sizeof known / sizeof *known; ++k) {
    const int rows = known[k].rows;
    const double found = (energy_of(24, rows, known[k].horizon) - energy_of(14, rows, known[k].horizon)) / 10;
    assert_near(found / (pow(rows, 3) / 24), known[k].stiffness, 1e-5);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(strips_are_softer_in_bending_by_one_over_their_rows_squared)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

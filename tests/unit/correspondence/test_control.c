/* Control of zero-energy modes: how strong it is. */
#include "formulation/correspondence.h"
#include "support.h"

/** The shape tensor of a place, sum of weight xi (x) xi, inverted; and its trace before. Of bodies whose axes are its own. */
static double invert_shape(const Family *f, int64_t place, int dimensions, double inverse[3])
{
  const int64_t slice = place / SLICE;
  double sum[3] = {0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
    for (int k = 0; k < 3; ++k) sum[k] += bond.weight * bond.xi[k] * bond.xi[k];
  }
  for (int k = 0; k < 3; ++k) inverse[k] = k < dimensions ? 1 / sum[k] : 0;
  return sum[0] + sum[1] + sum[2];
}

static void control_by_the_moduli_is_bounded_in_flat_families(void **state)
{
  (void)state;
  /* Wan's C = G_w (2 G K^-1 + lambda tr(K^-1) 1) by the law's moduli, and no more than that of families of which tr K tr K^-1 / d^2 is 4: on
   * strips and slabs of ever fewer layers, in whose middle layers K has the axes of the body. */
  for (int dimensions = 2; dimensions <= 3; ++dimensions)
    for (int n = 0; n < 3; ++n) {
      const int layers = n == 2 ? 9 : 3, horizon = n == 1 ? 8 : 4;
      breccia_model *m =
          model_of("materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
                   "peridynamics: {space: %s, horizon: %d.015 spacings, zero-energy control: {wan: 0.3}}\n"
                   "body: {b: {material: m, lattice: %s, %sspacing: 1, shape: {box: {particles: [%d, %s%d], first "
                   "particle: [0, 0, 0]}}}}\nsolve: {explicit: {steps: 1}}\n",
                   dimensions == 2 ? "plane strain" : "3-D", horizon, dimensions == 2 ? "square" : "cubic",
                   dimensions == 2 ? "thickness: 1, " : "", 21, dimensions == 2 ? "" : "21, ", layers);
      const Correspondence *c = m->domain.regions[0].formulation;
      const double middle[3] = {10, dimensions == 2 ? (layers - 1) / 2 : 10, dimensions == 2 ? 0 : (layers - 1) / 2};
      const int32_t place = particles_nearest(m->domain.particles, middle);
      double inverse[3];
      const double whole = invert_shape(&m->domain.family, place, dimensions, inverse),
                   trace = inverse[0] + inverse[1] + inverse[2], round = whole * trace / (dimensions * dimensions),
                   strength = 0.3 * fmin(1, 4 / fmax(1, round));
      for (int k = 0; k < dimensions; ++k)
        assert_near(c->hold[k][place], strength * (2 * 60 * inverse[k] + 60 * trace), 1e-9 * 60 * trace);
      assert_true(n == 0   ? round > 1.8 && round < 3
                  : n == 1 ? round > 4
                           : round < 1.01); /* below the bound and beyond it */
      breccia_model_destroy(&m);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(control_by_the_moduli_is_bounded_in_flat_families),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Pairwise hybrid bonds without damping: what docs/theory.md 5.4 says about them, and why the program refuses it. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ELASTIC "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}}\n"

/** By central differences of this test's own, so that nothing damps: how many times as far as at first a free body swings at most. */
static double growth_of(const char *body, const char *keys, int steps)
{
  breccia_model *m = model_of(UNITS ELASTIC "body: {b: {material: m, %s}}\n"
                                            "peridynamics: {formulation: hybrid, strain: small, %s}\n"
                                            "solve: {implicit: {end time: 1, stiffness damping: 1e-6}}\n",
                              body, keys);
  const Particles *p = m->domain.particles;
  const double step = 0.4 * 0.1 / sqrt(1e4 * 1.35 / 2); /* of a wave across a spacing */
  double first = INFINITY, largest = 0;
  for (int64_t i = 0; i < p->places; ++i)
    for (int k = 0; k < 3; ++k)
      p->velocity.row[k][i] = p->number[i] >= 0 && k < m->domain.body.dimensions ? sin(0.9 * (double)i * (k + 1)) : 0;
  for (int n = 0; n < steps && largest <= 1e7 * first; ++n) {
    compute_forces(m);
    for (int64_t i = 0; i < p->places; ++i)
      for (int k = 0; k < m->domain.body.dimensions && p->number[i] >= 0; ++k) {
        p->velocity.row[k][i] += step * p->internal.row[k][i] / p->density[i];
        p->displacement.row[k][i] += step * p->velocity.row[k][i];
        largest = larger_of(largest, fabs(p->velocity.row[k][i]));
      }
    if (n == 100) first = largest;
  }
  breccia_model_destroy(&m);
  return largest / first;
}

/** Its stiffness is not symmetric near surfaces: some motions take energy out of it, however short the steps are. The variational form has none. */
static void undamped_pairwise_bonds_flutter(void **state)
{
  (void)state;
  static const char *const plate = "lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [12, 4]}}",
                           *const layers = "spacing: 0.1, shape: {box: {particles: [12, 5, 2]}}";
  static const struct {
    const char *body, *keys;
  } of[] = {{plate, "space: plane stress, horizon: 1.5 spacings"},
            {plate, "space: plane stress, horizon: 2.015 spacings"},
            {layers, "space: 3-D, horizon: 1.5 spacings"},
            {layers, "space: 3-D, horizon: 2.015 spacings"}};
  for (size_t k = 0; k < sizeof of / sizeof *of; k += under_sanitizers() ? 2 : 1) {
    char keys[120];
    snprintf(keys, sizeof keys, "%s, form: pairwise", of[k].keys);
    const double pairwise = growth_of(of[k].body, keys, 8000), variational = growth_of(of[k].body, of[k].keys, 3000);
    print_message("%s: %.2g times, variational %.2g\n", of[k].keys, pairwise, variational);
    assert_true(pairwise > 1e7);
    assert_true(variational < 3);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(undamped_pairwise_bonds_flutter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

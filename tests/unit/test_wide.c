/* Sweeps on long vectors (base/wide.h) beside those on short ones: the same bits. */
#include "support.h"

#include "base/random.h"
#include "base/wide.h"
#include "formulation/bond_based.h"
#include "formulation/hybrid.h"
#include "formulation/ordinary.h"

static breccia_model *body(const char *formulation, const char *law)
{
  return model_of("materials: {m: {model: %s, density: 1, Young modulus: 150}}\n"
                  "peridynamics: {formulation: %s, horizon: 3.015}\n"
                  "cracks: [{cut: {line: [[9.05, -9], [9.05, 3.1]]}}]\n"
                  "body: {b: {material: m, spacing: 1, shape: {difference: [{box: {particles: [29, 8, 7]}}, {sphere: "
                  "{centre: [20, 4, 3], radius: 1.7}}]}}}\n"
                  "solve: {explicit: {steps: 1}}\n",
                  law, formulation);
}

static void set_wide(Domain *d, bool wide)
{
  void *formulation = d->regions[0].formulation;
  if (!strcmp(d->regions[0].type->name, "ordinary"))
    ((Ordinary *)formulation)->wide = wide;
  else if (!strcmp(d->regions[0].type->name, "hybrid"))
    ((Hybrid *)formulation)->wide = wide;
  else
    ((BondBased *)formulation)->wide = wide;
}

/** Displacements with stretches of a thousandth; of one particle, if wanted, so large that bonds around it leave the series. */
static void displace(const Domain *d, double far)
{
  const Particles *p = d->particles;
  uint64_t seed = 5;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) p->displacement[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
  p->displacement[0][p->place_of[p->count / 3]] += far;
}

static void check(breccia_model *model, double far)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  const size_t bytes = sizeof(double) * (size_t)p->places;
  double *forces[3];
  displace(d, far);
  set_wide(d, true);
  compute_forces(model);
  for (int k = 0; k < 3; ++k) {
    forces[k] = malloc(bytes);
    memcpy(forces[k], p->internal[k], bytes);
    memset(p->internal[k], 0, bytes);
  }
  set_wide(d, false);
  compute_forces(model);
  double largest = 0;
  for (int k = 0; k < 3; ++k) {
    for (int64_t i = 0; i < p->places; ++i) largest = fmax(largest, fabs(forces[k][i]));
    assert_memory_equal(forces[k], p->internal[k], bytes);
    free(forces[k]);
  }
  assert_true(largest > 0);
}

static void long_vectors_give_the_bits_of_short_ones(void **state)
{
  (void)state;
  if (!wide_lanes_pay()) skip();
  static const char *const of[][2] = {{"bond-based", "elastic-1d"},
                                      {"ordinary", "elastic, Poisson ratio: 0.3"},
                                      {"hybrid", "elastic, Poisson ratio: 0.3"},
                                      {"hybrid, strain: small", "elastic, Poisson ratio: 0.3"}};
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    breccia_model *model = body(of[k][0], of[k][1]);
    check(model, 0);
    check(model, 0.3);
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(long_vectors_give_the_bits_of_short_ones)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

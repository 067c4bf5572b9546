/* Bars that are drawn apart at rest until next to nothing of their strength is left, without help: by displacements, and by the opening of the crack. */
#include "support.h"

/** Weaker by a tenth in one column in its middle, 0.05 m high; G_F = 0.1 kN/m. */
static breccia_model *bar_of(const char *law, const char *formulation, bool opening)
{
  char blocks[3][200];
  const int count[] = {10, 1, 10};
  const double from[] = {0, 0.1, 0.11};
  for (int k = 0; k < 3; ++k)
    snprintf(blocks[k], sizeof blocks[k],
             "{material: %s, spacing: 0.01, lattice: square, thickness: 1, shape: {box: {particles: [%d, 5], first "
             "particle: [%g, 0]}}}",
             k == 1 ? "w" : "c", count[k], from[k]);
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials:\n"
                  "  c: {density: 2.4, %s, Young modulus: 30e6, fracture energy: 0.1, tensile strength: 3000}\n"
                  "  w: {density: 2.4, %s, Young modulus: 30e6, fracture energy: 0.1, tensile strength: 2700}\n"
                  "body:\n  a: %s\n  b: %s\n  c: %s\n"
                  "peridynamics: {formulation: %s, space: plane stress}\n"
                  "loads:\n"
                  "  - {on: {face: x-, layers: 3}, displacement: [0, free]}\n"
                  "  - {on: {face: x+, layers: 3}, displacement: [3e-4, free], history: {%s}}\n"
                  "  - {on: {nearest: [0, 0.02]}, displacement: [free, 0]}\n"
                  "  - {on: {nearest: [0.2, 0.02]}, displacement: [free, 0]}\n"
                  "solve: {static: {increments: 40%s}}\n",
                  law, law, blocks[0], blocks[1], blocks[2], formulation, opening ? "controlled: yes" : "ramp to: 1",
                  opening ? ", control: {opening between: [[0.05, 0.02], [0.15, 0.02]], to: 3e-4}" : "");
}

/** What the end on the right is drawn with. */
static double drawn_with(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  const Load *end = &m->loading.loads[1];
  double sum = 0;
  for (int64_t n = 0; n < end->selection.count; ++n)
    sum -= p->internal.row[0][end->selection.places[n]] * p->volume[end->selection.places[n]];
  return sum;
}

static void softening_is_followed_to_its_end_without_help(void **state)
{
  (void)state;
  static const struct {
    const char *law, *formulation;
    double least,
        spent; /* over the fracture energy: bonds of one weak column may spend a third more, and the increments in which they jump less; its two gaps are
                  alike to hybrid bonds, and by control of the opening both open */
  } bars[] = {{"model: bilinear-softening", "bond-based", 0.8, 1.4},
              {"model: mazars, Poisson ratio: 0.2", "correspondence", 0.9, 1.1},
              {"model: damage-plasticity, compressive strength: 30e3, Poisson ratio: 0.2", "correspondence", 0.9, 1.1},
              {"model: mazars, Poisson ratio: 0.2", "hybrid", 0.9, 1.5}};
  const int laws = under_sanitizers() ? 1 : sizeof bars / sizeof *bars;
  for (int k = 0; k < 2 * laws; ++k) {
    if (k % 2 != k / 2 % 2 && !whole_walks()) continue; /* each law by one of the two, in turn */
    breccia_model *m = bar_of(bars[k / 2].law, bars[k / 2].formulation, k % 2);
    double most = 0;
    while (!solver_is_done(&m->solver)) {
      step_surely(m, 1);
      most = larger_of(most, drawn_with(m));
    }
    const double left = drawn_with(m) / most, spent = solver_energy(&m->solver).external / 0.05 / 0.1;
    print_message("%s, by %s: %.4f of the largest force left, %.3f G_F\n", bars[k / 2].law,
                  k % 2 ? "opening" : "displacements", left, spent);
    assert_true(fabs(left) < 0.05);
    assert_true(spent > bars[k / 2].least && spent < bars[k / 2].spent);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(softening_is_followed_to_its_end_without_help)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

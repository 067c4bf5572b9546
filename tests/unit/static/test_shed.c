/* What bonds take that break at rest: the energy at their limits, however far an increment has overloaded them. What
 * they held beyond is counted by itself. */
#include "support.h"

/** Two halves of a plate, drawn apart by 10 mm; bonds across break at a stretch of 0.004 or the energy of that. */
static breccia_model *parted(const char *formulation, const char *failure, int increments)
{
  const bool of_bonds = !strcmp(formulation, "bond-based");
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: %s, density: 2, Young modulus: 1e4%s}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 8]}}}}\n"
      "peridynamics: {formulation: %s, space: plane stress, horizon: 2.015 spacings}\nfailure: {%s}\n"
      "loads: [{on: {inside: {box: {from: [-1, -1, -1], to: [1, 0.4, 1]}}}, displacement: [0, 0]},\n"
      "        {on: {inside: {box: {from: [-1, 0.4, -1], to: [1, 1, 1]}}}, displacement: [free, 0.01],"
      " history: {ramp to: 1}}]\n"
      "solve: {static: {increments: %d, bonds at once: 1000}}\n",
      of_bonds ? "elastic-1d" : "elastic", of_bonds ? "" : ", Poisson ratio: 0.25", formulation, failure, increments);
  m->threads = 1; /* of bodies so small more only wait */
  step_surely(m, INT64_MAX);
  return m;
}

static void a_crack_takes_the_same_however_bonds_are_overloaded(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *failure;
    /* Energy of a bond at its limit [kJ]; 0: not the same for all. */
    double limit;
    /* Increments that overload bonds. */
    int few;
    /* Difference of fracture energies. The energy of an ordinary bond at its limit depends on the dilatations of its
     * families. Of bonds that one increment overloads together these are the means over the increment; of bonds that
     * break one by one they have fallen with the bonds beside them. */
    double close;
  } cracks[] = {{"bond-based", "critical stretch: 0.004", 0, 1, 1e-9},
                {"bond-based", "criterion: critical bond energy, bond energy: 21", 21 * 0.002 * 0.002, 1, 1e-9},
                {"ordinary", "critical stretch: 0.004", 0, 10, 0.13}};
  for (size_t k = 0; k < sizeof cracks / sizeof *cracks; ++k) {
    Energy found[2];
    int64_t broken[2];
    for (int n = 0; n < 2; ++n) {
      breccia_model *m = parted(cracks[k].formulation, cracks[k].failure, n ? 200 : cracks[k].few);
      found[n] = solver_energy(&m->solver);
      broken[n] = m->domain.broken_count;
      breccia_model_destroy(&m);
      print_message("%s, %s: %lld bonds, fracture %.9g, shed %.9g, external %.9g, damping %.9g, imbalance %.2g\n",
                    cracks[k].formulation, cracks[k].failure, (long long)broken[n], found[n].fracture, found[n].shed,
                    found[n].external, found[n].damping, found[n].imbalance);
    }
    assert_true(broken[0] > 0 && (broken[0] == broken[1] || cracks[k].few > 1));
    assert_near(found[1].fracture / found[0].fracture, 1, cracks[k].close);
    if (cracks[k].limit > 0) assert_near(found[0].fracture / (cracks[k].limit * (double)broken[0]), 1, 1e-9);
    /* Ten increments overload bonds by about the energy of their limits, one by far more. */
    assert_true(found[0].shed > 0.8 * found[0].fracture);
    assert_true(found[1].shed < 0.1 * found[1].fracture);
    for (int n = 0; n < 2; ++n) assert_true(found[n].imbalance < 0.01);
  }
}

/** A plate with a notch that opens at one end, of hybrid bonds, which share points; `side` -1: its mirror image, whose
 *  particles stand in the opposite order. */
static breccia_model *torn(const char *failure, const char *solve, int side)
{
  breccia_model *m =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2,\n"
               "  shape: {box: {from: [%g, 0], to: [%g, 0.8]}}}}\n"
               "cracks: [{cut: {line: [[%g, 0.41], [%g, 0.41]]}}]\n"
               "peridynamics: {formulation: hybrid, space: plane stress, horizon: 2.015 spacings}\nfailure: {%s}\n"
               "loads: [{on: {face: y-}, displacement: [0, 0]},\n"
               "        {on: {face: y+}, displacement: [%g, 0.01], history: {ramp to: %g}}]\n"
               "solve: {%s}\npictures: []\n",
               side > 0 ? 0 : -1.0, side > 0 ? 1.0 : 0, side * -0.1, side * 0.35, failure, side * 0.004,
               strstr(solve, "static") ? 1 : 0.1, solve);
  m->threads = 1;
  step_surely(m, INT64_MAX);
  return m;
}

static void what_breaks_and_takes_does_not_depend_on_the_order(void **state)
{
  (void)state;
  static const char *const failures[] = {"criterion: critical bond stress, bond tensile strength: 30",
                                         "criterion: critical bond energy, fracture energy: 0.02"},
                           *const solves[] = {"static: {increments: 4}", "explicit: {end time: 60 ms}"};
  for (int k = 0; k < 4; ++k) {
    Energy found[2];
    int64_t broken[2], isolated[2] = {0};
    for (int n = 0; n < 2; ++n) {
      breccia_model *m = torn(failures[k % 2], solves[k / 2], n ? -1 : 1);
      found[n] = solver_energy(&m->solver);
      broken[n] = m->domain.broken_count;
      for (int64_t b = 0; b < broken[n]; ++b) isolated[n] += m->domain.broken[b].cause == BREAK_ISOLATED;
      breccia_model_destroy(&m);
      print_message("%s, %s: %lld bonds, %lld isolated, fracture %.12g, shed %.12g\n", failures[k % 2], solves[k / 2],
                    (long long)broken[n], (long long)isolated[n], found[n].fracture, found[n].shed);
    }
    assert_true(broken[0] > 10 && broken[0] == broken[1] && isolated[0] == isolated[1]);
    assert_near(found[1].fracture / found[0].fracture, 1, 1e-6);
    if (k < 2) assert_true(found[0].shed > 0.02 * found[0].fracture);
    if (k < 2) assert_near(found[1].shed / found[0].shed, 1, 1e-6);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_crack_takes_the_same_however_bonds_are_overloaded),
                                     cmocka_unit_test(what_breaks_and_takes_does_not_depend_on_the_order)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

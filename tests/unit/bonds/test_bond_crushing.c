/* Bodies of bonds that crush (fib-concrete): what lattices and prisms carry in uniaxial compression, and what
 * pressure across does to bonds. */
#include "support.h"

#define LAW                                                                                                            \
  "units: {length: mm, force: N, time: s}\n"                                                                           \
  "materials:\n"                                                                                                       \
  "  m: {model: fib-concrete, density: 2.4e-9, Young modulus: %g, tensile strength: 2.9, fracture energy: 0.14,\n"     \
  "      compressive strength: %g, peak strain: %g}\n"

/** Largest stress of a uniform strain with free sides, over f_c. */
static double crushing_along(const breccia_model *m, double x, double y, double z)
{
  const double length = sqrt(x * x + y * y + z * z), n[3] = {x / length, y / length, z / length};
  const Region *region = &m->domain.regions[0];
  return region->type->uniaxial_crushing(region->formulation, 0, n);
}

static void lattices_crush_at_the_strength_given(void **state)
{
  (void)state;
  static const struct {
    const char *lattice, *space;
    double z;
  } cases[] = {{"square", "plane stress", 0},
               {"hexagonal", "plane stress", 0},
               {"cubic", "3-D", 1},
               {"face-centred cubic", "3-D", 1}};
  static const struct {
    double young, strength, strain;
  } grades[] = {{33000, 38, 0.0022}, {38000, 58, 0.0025}};
  for (int g = 0; g < 2; ++g)
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
      char size[64];
      snprintf(size, sizeof size, cases[k].z > 0 ? "[0, 0, 0], to: [200, 200, 200]" : "[0, 0], to: [200, 200]");
      breccia_model *m =
          model_of(LAW "body: {b: {material: m, lattice: %s, spacing: 20, %sshape: {box: {from: %s}}}}\n"
                       "peridynamics: {formulation: bond-based, space: %s}\nsolve: {explicit: {steps: 1}}\n",
                   grades[g].young, grades[g].strength, grades[g].strain, cases[k].lattice,
                   cases[k].z > 0 ? "" : "thickness: 200, ", size, cases[k].space);
      const double found[] = {crushing_along(m, 1, 0, 0), crushing_along(m, 0, 1, 0), crushing_along(m, 1, 1, 0),
                              crushing_along(m, 1, 1, cases[k].z), crushing_along(m, 2, 1, 0)};
      for (int n = 0; n < 5; ++n)
        if (!(found[n] > 0.95 && found[n] < 1.05)) fail_msg("%s: %g in direction %d", cases[k].lattice, found[n], n);
      breccia_model_destroy(&m);
    }
}

/** Resultant along y on the particles above a height. */
static double force_above(const breccia_model *m, double height)
{
  const Particles *p = m->domain.particles;
  double force = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[1][i] > height) force -= p->volume[i] * p->internal[1][i];
  }
  return force;
}

/** A prism of 100 mm by 200 mm between smooth platens carries 38 MPa, where one that cannot crush would go on. */
static void a_prism_between_smooth_platens_crushes_at_its_strength(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      LAW
      "body: {b: {material: m, lattice: square, spacing: 10, thickness: 100, shape: {box: {from: [0, 0], to: [100, "
      "200]}}}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}\n"
      "failure: {near grips: hold}\n"
      "loads:\n  - {on: {face: y-, layers: 3}, displacement: [free, 0]}\n"
      "  - {on: {nearest: [55, 5]}, displacement: [0, free]}\n  - {on: {nearest: [55, 195]}, displacement: [0, free]}\n"
      "  - {on: {face: y+, layers: 3}, displacement: [free, -0.6], history: {ramp to: 1}}\n"
      "solve: {static: {increments: 15, method: relaxation, residual: 1e-4}}\n",
      33000.0, 38.0, 0.0022);
  double most = 0, last = 0;
  for (int step = 0; step < 15; ++step) {
    step_surely(m, 1);
    last = fabs(force_above(m, 170)) / 1e4;
    most = larger_of(most, last);
  }
  if (!(most > 0.95 * 38 && most < 1.05 * 38)) fail_msg("it carries %g MPa", most);
  assert_true(last < 0.95 * most);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattices_crush_at_the_strength_given),
      cmocka_unit_test(a_prism_between_smooth_platens_crushes_at_its_strength),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

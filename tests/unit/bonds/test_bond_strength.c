/* Strength of lattices of softening bonds, against closed forms of a network of nearest neighbours, and against a
 * strip. */
#include "support.h"

#define LAW                                                                                                            \
  "units: {length: mm, force: N, time: s}\n"                                                                           \
  "materials: {m: {model: %s, density: 2.4e-9, Young modulus: 30000, tensile strength: %g, fracture energy: 0.1}}\n"

/** Returns what a lattice carries along a direction, over what its bonds carry. */
static double strength_along(const breccia_model *m, double x, double y, double z)
{
  const double length = sqrt(x * x + y * y + z * z), n[3] = {x / length, y / length, z / length};
  const Region *region = &m->domain.regions[0];
  return region->type->uniaxial_strength(region->formulation, 0, n);
}

/** Bonds of a hexagonal lattice to its six neighbours only carry sigma = A sum f n n, with A = 1/2 for unit modulus.
 *  Pulled along a row with free sides, slanted bonds are not stretched: sigma = f of the row. Pulled across, the row is
 *  pressed by f / 2 of the four slanted bonds, and sigma = 1/2 4 f 3/4. */
static void six_neighbours_carry_what_a_closed_form_says(void **state)
{
  (void)state;
  static const char *const laws[] = {"bilinear-softening", "exponential-softening"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        LAW "body: {b: {material: m, lattice: hexagonal, spacing: 5, thickness: 10, shape: {box: {from: [0, 0], to: "
            "[60, 60]}}}}\nperidynamics: {formulation: bond-based, space: plane stress, horizon: 5.5}\n"
            "solve: {explicit: {steps: 1}}\n",
        laws[k], 3.0);
    assert_near(strength_along(m, 1, 0, 0), 1, 1e-3);
    assert_near(strength_along(m, 0, 1, 0), 1.5, 1e-3);
    assert_near(strength_along(m, -1, sqrt(3), 0), 1, 1e-3);
    breccia_model_destroy(&m);
  }
}

/** Slower softening lets slanted bonds gain more before the body has its largest stress. */
static void strength_grows_with_the_length_of_softening(void **state)
{
  (void)state;
  static const double strengths[] = {6, 3, 1.5};
  double last = 0.8;
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = model_of(LAW "body: {b: {material: m, spacing: 20, shape: {box: {particles: [8, 8, 8]}}}}\n"
                                    "peridynamics: {formulation: bond-based}\nsolve: {explicit: {steps: 1}}\n",
                                "bilinear-softening", strengths[k]);
    const double x = strength_along(m, 1, 0, 0), z = strength_along(m, 0, 0, 1), slanted = strength_along(m, 1, 1, 1);
    assert_near(x, z, 1e-9);
    assert_true(x > last + 0.02 && slanted > x);
    last = x;
    breccia_model_destroy(&m);
  }
}

/** A strip with a weak column begins to soften there: it carries what is told of the weak lattice, and up to 5 % more
 * from the lattice beside. */
static void a_strip_carries_what_is_told(void **state)
{
  (void)state;
  static const char *const laws[] = {"trilinear-softening", "exponential-softening"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        "units: {length: mm, force: N, time: s}\n"
        "materials:\n  c: {model: %s, density: 2.4e-9, Young modulus: 30000, tensile strength: 3, fracture energy: "
        "0.1}\n"
        "  w: {model: %s, density: 2.4e-9, Young modulus: 30000, tensile strength: 2.7, fracture energy: 0.1}\n"
        "body:\n  w: {material: w, lattice: square, spacing: 5, thickness: 100, shape: {box: {from: [55, 0], to: [80, "
        "60]}}}\n"
        "  l: {material: c, lattice: square, spacing: 5, thickness: 100, shape: {box: {from: [0, 0], to: [55, 60]}}}\n"
        "  r: {material: c, lattice: square, spacing: 5, thickness: 100, shape: {box: {from: [80, 0], to: [135, "
        "60]}}}\n"
        "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}\n"
        "loads:\n  - {on: {face: x-, layers: 3}, displacement: [0, free]}\n  - {on: {nearest: [2.5, 32.5]}, "
        "displacement: [free, 0]}\n"
        "  - {name: pull, on: {face: x+, layers: 3}, displacement: [0.06, free], history: {ramp to: 1}}\n"
        "solve: {static: {increments: 20}}\n",
        laws[k], laws[k]);
    const double told = 2.7 * strength_along(m, 1, 0, 0);
    double most = 0;
    for (int step = 0; step < 20; ++step) {
      step_surely(m, 1);
      double force = 0;
      const Particles *p = m->domain.particles;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        if (p->position[0][i] > 120) force -= p->volume[i] * p->internal[0][i];
      }
      most = larger_of(most, force / 6000);
    }
    assert_true(most > 0.97 * told && most < 1.05 * told);
    breccia_model_destroy(&m);
  }
}

/** The strength to give bonds for a body of some strength makes up for the direction in which a lattice carries the
 * most: it is one over the larger number of those told. */
static void the_strongest_direction_decides(void **state)
{
  (void)state;
  static const char *const lattices[] = {"square", "hexagonal"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        "units: {length: mm, force: N, time: s}\n"
        "materials: {c: {model: exponential-softening, density: 2.4e-9, Young modulus: 30000, tensile strength: 3, "
        "fracture energy: 0.1}}\n"
        "body: {b: {material: c, lattice: %s, spacing: 5, thickness: 100, shape: {box: {particles: [12, 12]}}}}\n"
        "peridynamics: {formulation: bond-based, space: plane stress}\nsolve: {explicit: {steps: 1}}\n",
        lattices[k]);
    const char *words = strstr(breccia_model_overview(m), "a body carries ");
    double least, most, give;
    assert_non_null(words);
    assert_int_equal(sscanf(words,
                            "a body carries %lf to %lf of the tensile strength of its bonds by the direction; for a "
                            "body of some strength give the bonds at most %lf of it",
                            &least, &most, &give),
                     3);
    assert_true(least <= most && (k || least < 0.99 * most));
    assert_near(give * most, 1, 5e-3);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(six_neighbours_carry_what_a_closed_form_says),
      cmocka_unit_test(strength_grows_with_the_length_of_softening),
      cmocka_unit_test(a_strip_carries_what_is_told),
      cmocka_unit_test(the_strongest_direction_decides),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Strength of bodies of softening bonds: closed forms of a network of nearest neighbours, and strips that carry the
 * tensile strength of the deck. */
#include "domain/bending_strength.h"
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
            "[60, 60]}}}}\nperidynamics: {formulation: bond-based, space: plane stress, horizon: 5.5, strength of: "
            "bonds}\n"
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
    breccia_model *m =
        model_of(LAW "body: {b: {material: m, spacing: 20, shape: {box: {particles: [8, 8, 8]}}}}\n"
                     "peridynamics: {formulation: bond-based, strength of: bonds}\nsolve: {explicit: {steps: 1}}\n",
                 "bilinear-softening", strengths[k]);
    const double x = strength_along(m, 1, 0, 0), z = strength_along(m, 0, 0, 1), slanted = strength_along(m, 1, 1, 1);
    assert_near(x, z, 1e-9);
    assert_true(x > last + 0.02 && slanted > x);
    last = x;
    breccia_model_destroy(&m);
  }
}

/** Writes the polygon of a part of a strip that starts at the origin along a direction, between two distances. */
static char *part_of_strip(char *words, size_t size, const double along[2], double from, double to, double half)
{
  double corner[4][2];
  for (int k = 0; k < 4; ++k) {
    const double x = k == 0 || k == 3 ? from : to, y = k < 2 ? -half : half;
    corner[k][0] = along[0] * x - along[1] * y;
    corner[k][1] = along[1] * x + along[0] * y;
  }
  snprintf(words, size, "polygon: {corners: [[%.9g, %.9g], [%.9g, %.9g], [%.9g, %.9g], [%.9g, %.9g]]}", corner[0][0],
           corner[0][1], corner[1][0], corner[1][1], corner[2][0], corner[2][1], corner[3][0], corner[3][1]);
  return words;
}

enum { STRIP_LENGTH = 150, STRIP_STEPS = 20 };

/** Pulls a strip in static increments; its middle softens, its ends do not. @return largest stress [MPa] */
static double strip_peak(const char *law, const char *lattice, const char *horizon, double angle, const char *keys)
{
  const double pi = acos(-1), along[2] = {cos(pi * angle / 180), sin(pi * angle / 180)}, half = 29.9, pulled = 0.03;
  char part[5][200];
  part_of_strip(part[0], sizeof part[0], along, 0, 45, half);
  part_of_strip(part[1], sizeof part[1], along, 45, 105, half);
  part_of_strip(part[2], sizeof part[2], along, 105, STRIP_LENGTH, half);
  part_of_strip(part[3], sizeof part[3], along, -5, 16, 2 * half);
  part_of_strip(part[4], sizeof part[4], along, STRIP_LENGTH - 16, STRIP_LENGTH + 5, 2 * half);
  const char *const grid = "lattice: %s, spacing: 5, thickness: 100";
  char shape[100];
  snprintf(shape, sizeof shape, grid, lattice);
  breccia_model *m =
      model_of("units: {length: mm, force: N, time: s}\n"
               "materials:\n  e: {model: elastic-1d, density: 2.4e-9, Young modulus: 30000}\n"
               "  m: {model: %s, density: 2.4e-9, Young modulus: 30000, tensile strength: 3, fracture energy: 0.1}\n"
               "body:\n  l: {material: e, %s, shape: {%s}}\n  m: {material: m, %s, shape: {%s}}\n"
               "  r: {material: e, %s, shape: {%s}}\n"
               "peridynamics: {formulation: bond-based, space: plane stress, horizon: %s spacings, surface correction: "
               "energy%s}\n"
               "loads:\n  - {on: {inside: {%s}}, displacement: [0, 0]}\n"
               "  - {on: {inside: {%s}}, displacement: [%.9g, %.9g], history: {ramp to: 1}}\n"
               "solve: {static: {increments: %d}}\n",
               law, shape, part[0], shape, part[1], shape, part[2], horizon, keys, part[3], part[4], pulled * along[0],
               pulled * along[1], STRIP_STEPS);
  const Particles *p = m->domain.particles;
  double volume = 0, most = 0;
  for (int64_t n = 0; n < p->count; ++n) volume += p->volume[p->place_of[n]];
  for (double last = 0, force = 0; force >= last; most = larger_of(most, force * STRIP_LENGTH / volume)) {
    step_surely(m, 1);
    last = force;
    force = 0;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (p->position[0][i] * along[0] + p->position[1][i] * along[1] > STRIP_LENGTH - 20)
        force -= p->volume[i] * (p->internal.row[0][i] * along[0] + p->internal.row[1][i] * along[1]);
    }
  }
  breccia_model_destroy(&m);
  return most;
}

/** A strip carries the tensile strength of the deck in the strongest direction of its lattice, and never more than 5 %
 *  in excess. In other directions it carries the share that `check` prints. */
static void strips_carry_their_tensile_strength(void **state)
{
  (void)state;
  static const struct {
    const char *law, *lattice, *horizon;
    double angle, least;
  } strips[] = {
      {"trilinear-softening", "square", "3.015", 0, 0.95},     {"trilinear-softening", "square", "3.015", 26.565, 0.88},
      {"trilinear-softening", "square", "3.015", 45, 0.95},    {"exponential-softening", "square", "3.015", 0, 0.95},
      {"bilinear-softening", "square", "3.015", 26.565, 0.88}, {"bilinear-softening", "square", "3.015", 45, 0.95},
      {"exponential-softening", "square", "3.015", 45, 0.95},  {"trilinear-softening", "hexagonal", "3.015", 0, 0.9},
      {"trilinear-softening", "square", "2.015", 0, 0.95},     {"trilinear-softening", "square", "1.5", 45, 0.85},
  };
  for (size_t k = 0; k < sizeof strips / sizeof *strips; ++k) {
    const double peak = strip_peak(strips[k].law, strips[k].lattice, strips[k].horizon, strips[k].angle, "");
    assert_true(peak / 3 > strips[k].least && peak / 3 < 1.05);
  }
}

/** With `strength of: bonds` a strip carries the multiple that `check` prints for its lattice. */
static void strips_of_strong_bonds_carry_what_is_told(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      LAW "body: {b: {material: m, lattice: square, spacing: 5, thickness: 100, shape: {box: {particles: [9, 9]}}}}\n"
          "peridynamics: {formulation: bond-based, space: plane stress, strength of: bonds}\n"
          "solve: {explicit: {steps: 1}}\n",
      "trilinear-softening", 3.0);
  const double told = strength_along(m, 1, 0, 0);
  assert_near(m->domain.materials[0].strength_share, 1, 0);
  breccia_model_destroy(&m);
  const double peak = strip_peak("trilinear-softening", "square", "3.015", 0, ", strength of: bonds");
  assert_true(told > 1.3);
  assert_near(peak / 3 / told, 1, 0.05);
}

/** Returns the strength of a model's body in its strongest direction, over the tensile strength of the deck. */
static double strongest(const char *body, const char *peridynamics, const char *strain)
{
  breccia_model *m = model_of("units: {length: mm, force: N, time: s}\n"
                              "materials: {m: {model: bilinear-softening, density: 2.4e-9, Young modulus: 30000, "
                              "tensile strength: 3, fracture energy: 0.1%s}}\n"
                              "body: {b: {material: m, spacing: 5, %s}}\nperidynamics: {formulation: bond-based%s}\n"
                              "solve: {explicit: {steps: 1}}\n",
                              strain, body, peridynamics);
  const double diagonal = larger_of(strength_along(m, 1, 1, 0), strength_along(m, 1, 1, 1)),
               most = m->domain.materials[0].strength_share * larger_of(diagonal, strength_along(m, 1, 0, 0));
  breccia_model_destroy(&m);
  return most;
}

/** Bodies in space, in the plane and with limits of strain carry the tensile strength of the deck. The diagonals of a
 *  cube are its strongest directions. */
static void bodies_carry_their_tensile_strength(void **state)
{
  (void)state;
  const char *const cube = "shape: {box: {particles: [8, 8, 8]}}",
                    *const plate = "lattice: square, thickness: 9, shape: {box: {particles: [8, 8]}}";
  assert_near(strongest(cube, "", ""), 1, 1e-3);
  assert_near(strongest(cube, ", horizon: 2.015 spacings", ""), 1, 1e-3);
  assert_near(strongest(plate, ", space: plane strain", ""), 1, 1e-3);
  assert_near(strongest(plate, ", space: plane stress", ", largest strain: 0.5"), 1, 1e-3);
  assert_true(strongest(cube, ", strength of: bonds", "") > 1.5);
}

/** The fracture energy of a crack per area does not depend on the strength of bonds. */
static void the_fracture_energy_stays(void **state)
{
  (void)state;
  double area[2];
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        LAW "body: {b: {material: m, lattice: square, spacing: 5, thickness: 100, shape: {box: {particles: [8, 8]}}}}\n"
            "peridynamics: {formulation: bond-based, space: plane stress, strength of: %s}\n"
            "solve: {explicit: {steps: 1}}\n",
        "trilinear-softening", 3.0, k ? "bonds" : "body");
    const Material *c = &m->domain.materials[0];
    const double end = material_failure_strain(c), step = end / 4000;
    double damage[2] = {0};
    area[k] = 0;
    for (int n = 0; n < 4000; ++n) {
      double strain = (n + 0.5) * step, stress;
      const breccia_batch one = {.size = sizeof one,
                                 .count = 1,
                                 .strain = {&strain},
                                 .stress = {&stress},
                                 .committed = &damage[0],
                                 .trial = &damage[1]};
      assert_int_equal(material_update(c, &one), -1);
      damage[0] = damage[1];
      area[k] += stress * step;
    }
    assert_near(area[k] * c->length, 0.1, 1e-4);
    breccia_model_destroy(&m);
  }
  assert_near(area[0], area[1], 1e-5);
}

/** Bonds take a share of the tensile strength for which the strongest direction of a lattice carries that strength: the
 * upper end of the printed band is 1. */
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
    const char *words = strstr(breccia_model_overview(m), "bonds carry ");
    double share, least, most;
    assert_non_null(words);
    assert_int_equal(sscanf(words,
                            "bonds carry %lf of the tensile strength, so that a body pulled one way carries %lf to %lf "
                            "of it by the direction",
                            &share, &least, &most),
                     3);
    assert_true(share < 0.95 && share > 0.5 && least < 0.99 * most);
    assert_near(most, 1, 5e-3);
    breccia_model_destroy(&m);
  }
}

/** bending_factor interpolates between measured beams of 10 and 20 rows and depths of 0.3, 0.6 and 1.2 E G_F / f_t^2,
 *  and is NaN for laws that were not measured. */
static void bending_strength_lies_between_measured_beams(void **state)
{
  (void)state;
  const char *const law = "exponential-softening";
  const double coarse = bending_factor("bond-based", law, 10, 0.3), fine = bending_factor("bond-based", law, 20, 0.3);
  assert_true(coarse > 0.9 && fine > coarse + 0.02);
  assert_true(bending_factor("bond-based", law, 5, 0.1) == coarse);
  assert_true(bending_factor("bond-based", law, 50, 0.1) == fine);
  assert_near(bending_factor("bond-based", law, sqrt(200), 0.3), (coarse + fine) / 2, 1e-12);
  assert_near(bending_factor("bond-based", law, 10, sqrt(0.3 * 0.6)),
              (coarse + bending_factor("bond-based", law, 10, 0.6)) / 2, 1e-12);
  assert_true(bending_factor("bond-based", "fib-concrete", 10, 0.3) == coarse); /* its curve in tension is the same */
  assert_true(isnan(bending_factor("bond-based", "elastic-brittle", 10, 0.3)));
  assert_true(isnan(bending_factor("ordinary", law, 10, 0.3)));
}

/** The lines of `check` on beams and links have the number of rows over the shortest side and the depth over
 *  E G_F / f_t^2 with the tensile strength of the deck, whatever share of that strength bonds take. */
static void bending_strength_is_told(void **state)
{
  (void)state;
  static const char *const deck =
      "units: {length: mm, force: N, time: s}\n"
      "materials: {c: {model: %s, density: 2.4e-9, Young modulus: 30000, %s}}\n"
      "body: {b: {material: c, lattice: %s, spacing: 10, thickness: 100, shape: {box: {"
      "particles: [%d, 20]}}}}\n"
      "peridynamics: {formulation: %s, space: plane stress}\nsolve: {explicit: {steps: 1}}\n";
  breccia_model *m =
      model_of(deck, "bilinear-softening", "tensile strength: 3, fracture energy: 0.1", "square", 60, "bond-based");
  const char *words = strstr(breccia_model_overview(m), "b: a beam of ");
  double rows, depth, strength, factor;
  assert_non_null(words);
  assert_int_equal(sscanf(words,
                          "b: a beam of %lf rows, %lf E G_F/f_t^2 deep, has a bending strength of %lf f_t, %lf times",
                          &rows, &depth, &strength, &factor),
                   4);
  assert_near(rows, 20, 1e-9);
  assert_near(depth, 0.6, 1e-9);
  assert_near(factor, bending_factor("bond-based", "bilinear-softening", 20, 0.6), 5e-3);
  assert_near(strength, factor * bending_cohesive("bond-based", "bilinear-softening", 0.6), 1e-2);
  assert_non_null(strstr(words, "softening curve (1.56 f_t; "));
  breccia_model_destroy(&m);
  m = model_of(deck, "bilinear-softening", "tensile strength: 3, fracture energy: 0.1", "square", 30, "bond-based");
  assert_null(strstr(breccia_model_overview(m), "a beam of ")); /* too short for a beam */
  breccia_model_destroy(&m);
  m = model_of(deck, "fib-concrete", "tensile strength: 3, fracture energy: 0.1, compressive strength: 30", "square",
               60, "bond-based");
  assert_non_null(strstr(breccia_model_overview(m), "b: a beam of 20 rows, 0.6 E G_F/f_t^2 deep"));
  breccia_model_destroy(&m);
  m = model_of(deck, "link-damage", "Poisson ratio: 0.2, tensile stretch: 1e-4, fracture energy: 0.1", "hexagonal", 60,
               "micropolar");
  words = strstr(breccia_model_overview(m), "b: a strip of these links pulled along its rows carries ");
  assert_non_null(words);
  assert_int_equal(sscanf(words, "b: a strip of these links pulled along its rows carries %lf times", &factor), 1);
  assert_near(factor, 1.29, 1e-9);
  breccia_model_destroy(&m);
}

/** With perfect plasticity six neighbours carry the yield stress along a row and 1.5 times as much across, as above. In an
 *  isotropic plane family bonds within 66.2 degrees of the pull yield in tension and all others in compression, as
 *  theta / 2 - sin(2 theta) / 4 = pi / 8 without stress across, and the body carries 1.411 times the yield stress. */
static void bodies_of_yielding_bonds_carry_more_than_their_bonds(void **state)
{
  (void)state;
  static const struct {
    const char *law, *block, *horizon;
    double x, y, within; /* strength along x and y */
  } cases[] = {{"elastic-perfectly-plastic, yield stress: 3", "hexagonal", "5.5", 1, 1.5, 1e-3},
               {"elastic-perfectly-plastic, yield stress: 3", "square", "5.015 spacings", 1.411, 1.411, 0.03},
               {"elastic-perfectly-plastic, yield stress: 3", "square", "3.015 spacings", 1.411, 1.411, 0.06},
               {"elastic-1d", "square", "3.015 spacings", NAN, NAN, 0},
               {"elastic-brittle, tensile strength: 3", "square", "3.015 spacings", NAN, NAN, 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(
        "units: {length: mm, force: N, time: s}\nmaterials: {m: {model: %s, density: 2.4e-9, Young modulus: 30000}}\n"
        "body: {b: {material: m, lattice: %s, spacing: 5, thickness: 10, shape: {box: {particles: [14, 14]}}}}\n"
        "peridynamics: {formulation: bond-based, space: plane stress, horizon: %s}\nsolve: {explicit: {steps: 1}}\n",
        cases[k].law, cases[k].block, cases[k].horizon);
    const double x = strength_along(m, 1, 0, 0), y = strength_along(m, 0, 1, 0);
    const bool told = strstr(breccia_model_overview(m), "times the stress of its bonds") != NULL;
    print_message("%s, %s, %s: %.4f along x, %.4f along y\n", cases[k].law, cases[k].block, cases[k].horizon, x, y);
    assert_int_equal(told, !isnan(cases[k].x));
    if (isnan(cases[k].x)) {
      assert_true(isnan(x) && isnan(y));
    } else {
      assert_near(x, cases[k].x, cases[k].within);
      assert_near(y, cases[k].y, cases[k].within);
    }
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_of_yielding_bonds_carry_more_than_their_bonds),
      cmocka_unit_test(bending_strength_lies_between_measured_beams),
      cmocka_unit_test(bending_strength_is_told),
      cmocka_unit_test(six_neighbours_carry_what_a_closed_form_says),
      cmocka_unit_test(strength_grows_with_the_length_of_softening),
      cmocka_unit_test(strips_carry_their_tensile_strength),
      cmocka_unit_test(strips_of_strong_bonds_carry_what_is_told),
      cmocka_unit_test(bodies_carry_their_tensile_strength),
      cmocka_unit_test(the_fracture_energy_stays),
      cmocka_unit_test(the_strongest_direction_decides),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

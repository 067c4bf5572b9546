/* Bodies of crushing bonds (fib-concrete): strength of lattices and prisms in uniaxial compression, and the effect of
 * pressure across bonds and of pressure in two directions. */
#include "base/tensor.h"
#include "domain/toughness.h"
#include "solver/reactions.h"
#include "support.h"

#define LAW                                                                                                            \
  "units: {length: mm, force: N, time: s}\n"                                                                           \
  "materials:\n"                                                                                                       \
  "  m: {model: fib-concrete, density: 2.4e-9, Young modulus: %g, tensile strength: 2.9, fracture energy: 0.14,\n"     \
  "      compressive strength: %g, peak strain: %g}\n"

/** Returns the largest stress in uniaxial compression with free sides, over f_c. */
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

/** Returns the resultant along y on the particles above a height. */
static double force_above(const breccia_model *m, double height)
{
  const Particles *p = m->domain.particles;
  double force = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[1][i] > height) force -= p->volume[i] * p->internal.row[1][i];
  }
  return force;
}

/** A prism of 100 mm by 200 mm between smooth platens carries 38 MPa; without crushing the stress would increase on. */
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

/** Returns the largest damage of the bonds of a body at a uniform strain. */
static double damage_at(const char *space, const char *shape, const char *field)
{
  breccia_model *m =
      model_of(LAW "body: {b: {material: m, %s, spacing: 20, shape: {box: {from: %s}}}}\n"
                   "peridynamics: {formulation: bond-based, space: %s, strength of: bonds}\n"
                   "loads: [{on: {all: yes}, field: {displacement: %s}}]\n"
                   "solve: {static: {increments: 1}}\n",
               33000.0, 38.0, 0.0022, strcmp(space, "3-D") ? "thickness: 50, lattice: square" : "lattice: cubic", shape,
               space, field);
  step_surely(m, 1);
  const Points *points = &m->domain.regions[0].points;
  double most = 0;
  for (size_t n = 0; n < points->history_size; n += 3) most = larger_of(most, points->committed[n]);
  breccia_model_destroy(&m);
  return most;
}

/** In pure shear with the strain e along a bond the body has the stress 3/4 E e in plane stress and 4/5 E e otherwise;
 * the bond has E e. Damage begins at f_t of the body, up to the faces. Under equal tension in two directions there is
 * no pressure across bonds, and damage begins at f_t of the bond. f_t / E = 8.79e-5. */
static void pressure_across_counts_in_bodies(void **state)
{
  (void)state;
  static const char plane[] = "[0, 0], to: [160, 120]", solid[] = "[0, 0, 0], to: [120, 120, 120]";
  assert_near(damage_at("plane stress", plane, "[1.15e-4 * x, -1.15e-4 * y]"), 0, 0);
  assert_true(damage_at("plane stress", plane, "[1.19e-4 * x, -1.19e-4 * y]") > 1e-3);
  assert_near(damage_at("plane strain", plane, "[1.08e-4 * x, -1.08e-4 * y]"), 0, 0);
  assert_true(damage_at("plane strain", plane, "[1.12e-4 * x, -1.12e-4 * y]") > 1e-3);
  assert_near(damage_at("3-D", solid, "[1.08e-4 * x, -1.08e-4 * y, 0]"), 0, 0);
  assert_true(damage_at("3-D", solid, "[1.12e-4 * x, -1.12e-4 * y, 0]") > 1e-3);
  assert_near(damage_at("plane stress", plane, "[8.7e-5 * x, 8.7e-5 * y]"), 0, 0);
  assert_true(damage_at("plane stress", plane, "[8.9e-5 * x, 8.9e-5 * y]") > 1e-3);
  assert_near(damage_at("plane stress", plane, "[-9e-4 * x, 3e-4 * y]"), 0, 0);
  assert_near(damage_at("3-D", solid, "[-1e-3 * x, 2.5e-4 * y, 2.5e-4 * z]"), 0, 0);
}

/** Under pressure in two directions a body carries what Kupfer and Gerstle (1973) measured,
 *  sigma_1 / f_c = (1 + 3.65 alpha) / (1 + alpha)^2 with alpha = sigma_2 / sigma_1. Bonds that know no confining pressure
 *  carry 1 + 0.2 alpha. Strains across are a share of the strain along the larger pressure. */
static void pressure_in_two_directions_raises_the_strength(void **state)
{
  (void)state;
  enum { STEPS = 80 };
  static const double shares[] = {0.2, 0.1, 0, -0.1, -0.3};
  for (size_t k = 0; k < sizeof shares / sizeof *shares; ++k) {
    breccia_model *m =
        model_of(LAW "body: {b: {material: m, lattice: square, spacing: 20, thickness: 200, shape: {box: {from: [0, "
                     "0], to: [280, 280]}}}}\n"
                     "peridynamics: {formulation: bond-based, space: plane stress}\n"
                     "loads: [{on: {all: yes}, field: {displacement: [\"-4e-3 * x\", \"%g * y\"]}, history: {ramp to: "
                     "1}}]\n"
                     "solve: {static: {increments: %d}}\n",
                 33000.0, 38.0, 0.0022, 4e-3 * shares[k], STEPS);
    const Region *region = &m->domain.regions[0];
    const Particles *p = m->domain.particles;
    int64_t middle = p->place_of[7 * 14 + 7];
    double most = 0, across = 0;
    for (int step = 0; step < STEPS; ++step) {
      double stress[6];
      step_surely(m, 1);
      region->type->stress(region->formulation, middle, stress);
      if (-stress[XX] > most) across = -stress[YY];
      most = larger_of(most, -stress[XX]);
    }
    const double alpha = across / most, told = 38 * (1 + 3.65 * alpha) / pow(1 + alpha, 2);
    assert_true(alpha > 0.05 && alpha < 0.9);
    if (!(most > 0.95 * told && most < 1.05 * told))
      fail_msg("%g MPa, by Kupfer and Gerstle %g at a ratio of %g", most, told, alpha);
    breccia_model_destroy(&m);
  }
}

/** Returns the stress of the law under monotonic strain; compression is positive. The exponential descent spends 35
 * N/mm over a length. */
static double curve_at(double strain, double length)
{
  const double k = 33000 * 0.0022 / 38, eta = strain / 0.0022;
  if (strain <= 0) return 0;
  return eta < 1 ? 38 * (k * eta - eta * eta) / (1 + (k - 2) * eta) : 38 * exp(-(strain - 0.0022) * 38 * length / 35);
}

/** Returns the largest force on a plane section of height 100 and width 100 at an eccentricity, without tension. */
static double force_of_section(double eccentricity, double length)
{
  enum { LAYERS = 200 };
  double most = 0;
  for (int n = 1; n < 120; ++n) {
    double low = 10, high = 5000, force = 0; /* height under compression */
    for (int turn = 0; turn < 50; ++turn) {
      const double zone = sqrt(low * high);
      double moment = 0;
      force = 0;
      for (int k = 0; k < LAYERS; ++k) {
        const double y = (k + 0.5) * 100 / LAYERS, stress = curve_at(5e-5 * n * (1 - y / zone), length);
        force += stress * 1e4 / LAYERS;
        moment += stress * 1e4 / LAYERS * (50 - y);
      }
      if (moment > eccentricity * force)
        low = zone;
      else
        high = zone;
    }
    most = larger_of(most, force);
  }
  return most;
}

/** A prism of 100 mm by 200 mm with an eccentricity of 15 mm acts as the compression zone of a beam and cracks on the
 * far side. Equilibrium of plane sections gives 251 kN. */
static void a_prism_pressed_off_its_axis_carries_what_its_section_does(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      LAW "  s: {model: elastic-1d, density: 7.8e-9, Young modulus: 200000}\n"
          "body:\n"
          "  b: {material: m, lattice: square, spacing: 10, thickness: 100, shape: {box: {from: [0, 0], to: [100, "
          "200]}}}\n"
          "  foot: {material: s, lattice: square, spacing: 10, thickness: 100, shape: {box: {from: [0, -30], to: [100, "
          "0]}}}\n"
          "  head: {material: s, lattice: square, spacing: 10, thickness: 100, shape: {box: {from: [0, 200], to: [100, "
          "230]}}}\n"
          "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}\n"
          "failure: {near grips: hold}\n"
          "loads:\n  - {on: {nearest: [65, -25]}, displacement: [0, 0]}\n"
          "  - {on: {nearest: [65, 225]}, displacement: [0, -0.6], history: {ramp to: 1}}\n"
          "solve: {static: {increments: 20, method: relaxation, residual: 1e-3}}\n",
      33000.0, 38.0, 0.0022);
  const double told = force_of_section(15, m->domain.materials[0].length);
  double most = 0, last = 0;
  for (int step = 0; step < 20; ++step) {
    step_surely(m, 1);
    last = fabs(force_above(m, 215));
    most = larger_of(most, last);
  }
  if (!(most > 0.88 * told && most < 1.05 * told)) fail_msg("%g kN, by its section %g", most / 1e3, told / 1e3);
  assert_true(last < 0.95 * most);
  breccia_model_destroy(&m);
}

/** Returns the load of two jacks, each 1 m from its support, at the moment of a section of 200 mm by 400 mm with a
 *  rectangular stress block of 0.8 of the compression zone, at a strain of 0.0035 at the top: five bars of 25 mm at a
 *  depth of 354 mm and two of 10 mm at 43 mm, which yield at 500 MPa. */
static double load_of_stress_block(void)
{
  const double tension = 5 * 490.874, compression = 2 * 78.54;
  double low = 10, high = 400, moment = 0;
  for (int turn = 0; turn < 60; ++turn) {
    const double zone = (low + high) / 2, block = 0.8 * zone * 200 * 38, pulled = 700 * (354 / zone - 1),
                 pressed = fmin(500, 700 * (1 - 43 / zone)) - 38;
    if (block + compression * pressed > tension * fmin(500, pulled))
      high = zone;
    else
      low = zone;
    moment = block * (354 - 0.4 * zone) + compression * pressed * (354 - 43);
  }
  return 2 * moment / 1000;
}

/** Returns the force along y that a load exerts on the body. */
static double force_of_load(breccia_model *m, const char *load)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, m->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &m->solver, NULL, load, NULL);
  reactions_destroy(&reactions);
  return sum.force[1];
}

/** A beam with so much steel that its concrete crushes first carries the moment of its section, although the
 *  compression zone lies under two jacks. Bonds that know no confining pressure carry 0.79 of it in these 8 rows. */
static void a_beam_crushes_under_its_jacks_at_the_moment_of_its_section(void **state)
{
  (void)state;
  enum { STEPS = 20 };
  const double told = load_of_stress_block();
  assert_near(told, 687.7e3, 1e3);
  breccia_model *m = model_of(
      LAW
      "  s: {model: steel-bilinear, density: 7.85e-9, Young modulus: 2e5, yield stress: 500, hardening ratio: "
      "0.005}\n"
      "body: {b: {material: m, lattice: square, spacing: 50, thickness: 200, shape: {box: {from: [0, 0], to: [3300, "
      "400]}}}}\n"
      "bars:\n"
      "  bottom: {points: [[30, 46], [3270, 46]], diameter: 25, number: 5, material: s}\n"
      "  top: {points: [[30, 357], [3270, 357]], diameter: 10, number: 2, material: s}\n"
      "  stirrups: {points: [[75, 34], [75, 366]], diameter: 10, number: 2, material: s, repeat: {along: [1, 0], "
      "pitch: 75, over: 3150}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy}\n"
      "failure: {near grips: hold}\n"
      "selections:\n"
      "  pin: {inside: {box: {from: [100, 0], to: [200, 50]}}}\n"
      "  roller: {inside: {box: {from: [3100, 0], to: [3200, 50]}}}\n"
      "  left: {inside: {box: {from: [1100, 350], to: [1200, 400]}}}\n"
      "  right: {inside: {box: {from: [2100, 350], to: [2200, 400]}}}\n"
      "loads:\n"
      "  - {name: pin, on: pin, displacement: [free, 0], platen: turning}\n"
      "  - {name: roller, on: roller, displacement: [free, 0], platen: turning}\n"
      "  - {on: {nearest: [1625, 175]}, displacement: [0, free]}\n"
      "  - {on: left, displacement: [free, -18], history: {ramp to: 1}, platen: turning}\n"
      "  - {on: right, displacement: [free, -18], history: {ramp to: 1}, platen: turning}\n"
      "solve: {static: {increments: 20, method: relaxation, residual: 1e-3}}\n",
      33000.0, 38.0, 0.0022);
  double most = 0, last = 0;
  for (int step = 0; step < STEPS && !(last < 0.95 * most); ++step) {
    step_surely(m, 1);
    last = force_of_load(m, "pin") + force_of_load(m, "roller");
    most = larger_of(most, last);
  }
  if (!(most > 0.85 * told && most < 1.03 * told)) fail_msg("%g kN, by its section %g", most / 1e3, told / 1e3);
  assert_true(last < 0.95 * most);
  breccia_model_destroy(&m);
}

/** Returns true if the words on toughness of a block of crushing bonds warn of a block of a Young's modulus on it. */
static bool plates_are_told(double young)
{
  breccia_model *m = model_of(
      LAW
      "  s: {model: elastic-1d, density: 7.85e-9, Young modulus: %g}\n"
      "body:\n"
      "  beam: {material: m, lattice: square, spacing: 20, thickness: 100, shape: {box: {from: [0, 0], to: [400, "
      "100]}}}\n"
      "  plate: {material: s, lattice: square, spacing: 20, thickness: 100, shape: {box: {from: [160, 100], to: [240, "
      "140]}}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress}\nsolve: {explicit: {steps: 1}}\n",
      33000.0, 38.0, 0.0022, young);
  Text text = {0};
  toughness_describe(&m->domain, m->spec->failure, m->units, &text);
  const bool told = strstr(text.characters, "if 'plate' is a plate under a jack") != NULL;
  assert_non_null(strstr(text.characters, "pressed one way a body carries"));
  text_free(&text);
  breccia_model_destroy(&m);
  return told;
}

static void stiff_plates_on_crushing_bonds_are_told(void **state)
{
  (void)state;
  assert_true(plates_are_told(200000));
  assert_false(plates_are_told(33000));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stiff_plates_on_crushing_bonds_are_told),
      cmocka_unit_test(lattices_crush_at_the_strength_given),
      cmocka_unit_test(pressure_across_counts_in_bodies),
      cmocka_unit_test(pressure_in_two_directions_raises_the_strength),
      cmocka_unit_test(a_prism_between_smooth_platens_crushes_at_its_strength),
      cmocka_unit_test(a_prism_pressed_off_its_axis_carries_what_its_section_does),
      cmocka_unit_test(a_beam_crushes_under_its_jacks_at_the_moment_of_its_section),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

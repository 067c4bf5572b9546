/* Interfaces of two materials in bodies of hybrid bonds. A state that is uniform in each of two layers, with equal
 * strain along the interface and equal traction across it, is in equilibrium on all particles for any rotation of the
 * body. Its energy is that of Hooke's law. */
#include "support.h"

#include <unistd.h>

#define FILES "test_hybrid_interfaces"

/** Two layers of a body and a uniform state of each. */
typedef struct Layers {
  const char *lattice, *space, *words; /* words: more keys of the formulation */
  double spacings, contrast, turn;     /* turn [rad] in the plane */
  double poisson[2];                   /* Poisson's ratios of the lower and the upper layer */
  bool flows;                          /* laws with a history, far from their limits */
  double along, stretch, slide;        /* strains along and across the interface and in shear; lower layer */
} Layers;

static const double stiff = 1e6, scale = 1e-13; /* Young's modulus of the lower layer; scale of strains */

/** Returns the moduli of a layer in the body's space. */
typedef struct Moduli {
  double across, lame, shear;
} Moduli;

static Moduli moduli_of(const Layers *of, int layer)
{
  const double young = layer ? stiff / of->contrast : stiff, nu = of->poisson[layer], shear = young / (2 * (1 + nu));
  double lame = 2 * shear * nu / (1 - 2 * nu);
  if (!strcmp(of->space, "plane stress")) lame = 2 * shear * lame / (lame + 2 * shear);
  return (Moduli){lame + 2 * shear, lame, shear};
}

/** Computes the strain across a layer and its shear strain for the tractions of the lower layer. */
static void strain_across(const Layers *of, int layer, double *stretch, double *slide)
{
  const Moduli lower = moduli_of(of, 0), own = moduli_of(of, layer);
  *stretch = (lower.across * of->stretch + (lower.lame - own.lame) * of->along) / own.across;
  *slide = lower.shear * of->slide / own.shear;
}

static char *material_words(const Layers *of, int layer)
{
  return text_format("{model: %s, density: 2, Young modulus: %.17g, Poisson ratio: %.17g%s}",
                     of->flows ? "j2" : "elastic", layer ? stiff / of->contrast : stiff, of->poisson[layer],
                     of->flows ? ", yield stress: 1e6" : "");
}

enum { COLUMNS = 18, ROWS = 12 }; /* rows of each layer */

/** Returns true if the body comes from files: turned bodies, and hexagonal lattices with rows across the interface. */
static bool from_files(const Layers *of)
{
  return of->turn != 0 || !strcmp(of->lattice, "hexagonal");
}

static double rows_apart(const Layers *of)
{
  return strcmp(of->lattice, "hexagonal") ? 1 : sqrt(0.75);
}

/** Writes the particles of a layer of a lattice with rows along the interface, turned about the origin. */
static void write_layer(const Layers *of, int layer, const char *name)
{
  FILE *file = fopen(name, "w");
  const double c = cos(of->turn), s = sin(of->turn);
  const bool hexagonal = !strcmp(of->lattice, "hexagonal");
  const double apart = rows_apart(of);
  assert_non_null(file);
  fprintf(file, "x,y,volume\n");
  for (int row = 0; row < ROWS; ++row)
    for (int k = 0; k < COLUMNS; ++k) {
      const double y = (layer ? 1 : -1) * (row + 0.5) * apart, x = k + (hexagonal && (row + layer) % 2 ? 0.25 : 0.75);
      fprintf(file, "%.17g,%.17g,%.17g\n", c * x - s * y, s * x + c * y, apart);
    }
  fclose(file);
}

static breccia_model *layers_of(const Layers *of)
{
  const bool solid = !strcmp(of->space, "3-D");
  char *materials[2] = {material_words(of, 0), material_words(of, 1)}, *blocks[2];
  for (int n = 0; n < 2; ++n) {
    char *name = text_format(FILES "_%d.csv", n);
    if (from_files(of)) write_layer(of, n, name);
    blocks[n] =
        from_files(of) ? text_format("lattice: square, spacing: 1, thickness: 1, file: %s", name)
        : solid ? text_format("spacing: 1, shape: {box: {from: [0, 0, %d], to: [11, 11, %d]}}", n ? 0 : -8, n ? 8 : 0)
                : text_format("lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, %d], "
                              "to: [%d, %d]}}",
                              n ? 0 : -ROWS, COLUMNS, n ? ROWS : 0);
    free(name);
  }
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\nmaterials:\n  a: %s\n  b: %s\nbody:\n"
                              "  a: {material: a, %s}\n  b: {material: b, %s}\n"
                              "peridynamics: {formulation: hybrid, space: %s, horizon: %.17g spacings%s}\n"
                              "solve: {explicit: {time step: 1e-6, steps: 1}}\n",
                              materials[0], materials[1], blocks[0], blocks[1], of->space, of->spacings, of->words);
  for (int n = 0; n < 2; ++n) {
    char *name = text_format(FILES "_%d.csv", n);
    if (from_files(of)) unlink(name);
    free(name);
    free(materials[n]);
    free(blocks[n]);
  }
  return m;
}

/** Computes the distances of a particle from the interface and along it. */
static void place_in_layers(const Layers *of, const breccia_model *m, int32_t i, double *along, double *across)
{
  double *const *x = m->domain.particles->position;
  const bool solid = !strcmp(of->space, "3-D");
  const double c = cos(of->turn), s = sin(of->turn);
  *along = c * x[0][i] + s * x[1][i];
  *across = solid ? x[2][i] : c * x[1][i] - s * x[0][i];
}

/** Displaces all particles by the uniform states of both layers. */
static void displace(const Layers *of, breccia_model *m)
{
  const Particles *p = m->domain.particles;
  const double c = cos(of->turn), s = sin(of->turn);
  const bool solid = !strcmp(of->space, "3-D");
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x, y, stretch, slide;
    place_in_layers(of, m, i, &x, &y);
    strain_across(of, y > 0, &stretch, &slide);
    const double u = scale * (of->along * x + slide * y), v = scale * stretch * y;
    p->displacement.row[0][i] = c * u - (solid ? 0 : s * v);
    p->displacement.row[solid ? 2 : 1][i] = s * u + (solid ? 1 : c) * v;
  }
}

/** Returns the largest internal force per volume on particles farther than two horizons from all faces, over the ratio
 *  of stress to spacing. */
static double largest_force(const Layers *of, breccia_model *m)
{
  const Particles *p = m->domain.particles;
  const bool solid = !strcmp(of->space, "3-D");
  const double margin = 2 * of->spacings + 0.5, stress = scale * stiff;
  double largest = NAN; /* NaN if no particle is far enough from the faces */
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x, y;
    place_in_layers(of, m, i, &x, &y);
    if (x < margin || x > (solid ? 11 : COLUMNS) - margin || fabs(y) > (solid ? 8 : ROWS * rows_apart(of)) - margin)
      continue;
    if (solid && (p->position[1][i] < margin || p->position[1][i] > 11 - margin)) continue;
    if (isnan(largest)) largest = 0;
    for (int k = 0; k < 3; ++k) largest = larger_of(largest, fabs(p->internal.row[k][i]) / stress);
  }
  return largest;
}

/** Uniform states along the interface, across it and in shear are in equilibrium. */
static const double states[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static void assert_in_equilibrium(Layers of)
{
  breccia_model *m = layers_of(&of);
  for (int n = 0; n < 3; ++n) {
    of.along = states[n][0];
    of.stretch = states[n][1];
    of.slide = states[n][2];
    displace(&of, m);
    compute_forces(m);
    const double force = largest_force(&of, m);
    if (!(force <= 1e-9))
      fail_msg("%s, %s, %g spacings, contrast %g, turned by %g, state %d: %g of the stress is out of balance",
               of.lattice, of.space, of.spacings, of.contrast, of.turn, n, force);
  }
  breccia_model_destroy(&m);
}

static void uniform_layers_are_in_equilibrium(void **state)
{
  (void)state;
  static const Layers of[] = {
      {"square", "plane stress", "", 1.5, 10, 0, {0.2, 0.2}, .flows = false},
      {"square", "plane stress", "", 2.015, 1000, 0, {0.2, 0.3}, .flows = false},
      {"square", "plane strain", ", strain: small", 3.015, 0.1, 0, {0.3, 0.2}, .flows = false},
      {"square", "plane strain", "", 2.015, 10, 0, {0.3, 0.1}, .flows = true},
      {"square", "plane stress", "", 2.015, 10, 0, {0.3, 0.1}, .flows = true},
      {"square", "plane stress", ", own bond: 0.7", 2.015, 10, 0, {0.2, 0.2}, .flows = false},
      {"square", "plane strain", "", 2.015, 10, 0.6435, {0.2, 0.3}, .flows = false},
      {"cubic", "3-D", "", 1.5, 100, 0, {0.2, 0.3}, .flows = false},
      {"cubic", "3-D", "", 2.015, 10, 0, {0.2, 0.2}, .flows = true},
      {"hexagonal", "plane stress", "", 2.015, 10, 0, {0.2, 0.2}, .flows = false},
  };
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) assert_in_equilibrium(of[k]);
}

/** Returns the stiffness of two layers of six rows along the interface, from the stored energy, over the sum of both
 *  layers' stiffness. */
static double stiffness_along(double spacings, double contrast, const char *space)
{
  enum { ALONG = 24, LAYER = 6 };
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {s: {model: elastic, density: 2, Young modulus: 1e6, Poisson ratio: 0.2},\n"
      "            w: {model: elastic, density: 2, Young modulus: %.17g, Poisson ratio: 0.2}}\n"
      "body:\n  a: {material: s, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: {from: [0, 0], to: "
      "[2.4, 0.6]}}}\n"
      "  b: {material: w, lattice: square, spacing: 0.1, thickness: 0.1, shape: {box: {from: [0, 0.6], to: [2.4, "
      "1.2]}}}\n"
      "peridynamics: {space: %s, formulation: hybrid, horizon: %g spacings}\n"
      "loads: [{on: {all: yes}, field: {displacement: ['1e-6 * x', free]}}, {on: {nearest: [1.25, 0.05]}, "
      "displacement: [free, 0]}]\nsolve: {static: {increments: 1}}\n",
      1e6 / contrast, space, spacings);
  step_surely(m, 1);
  const double plate = strcmp(space, "plane stress") ? 1 / (1 - 0.2 * 0.2) : 1,
               exact = 0.5e-12 * plate * (1e6 + 1e6 / contrast) * ALONG * LAYER * 1e-3,
               share = solver_energy(&m->solver).stored / exact;
  breccia_model_destroy(&m);
  return share;
}

static void layers_are_as_stiff_along_their_interface_as_both_together(void **state)
{
  (void)state;
  static const struct {
    double spacings, contrast;
    const char *space;
  } of[] = {{2.015, 1, "plane stress"},
            {2.015, 10, "plane stress"},
            {2.015, 1000, "plane stress"},
            {3.015, 10, "plane stress"},
            {3.015, 1000, "plane strain"}};
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    const double share = stiffness_along(of[k].spacings, of[k].contrast, of[k].space);
    if (fabs(share - 1) > 1e-5)
      fail_msg("%g spacings, contrast %g, %s: %.6f of both layers", of[k].spacings, of[k].contrast, of[k].space, share);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform_layers_are_in_equilibrium),
      cmocka_unit_test(layers_are_as_stiff_along_their_interface_as_both_together),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

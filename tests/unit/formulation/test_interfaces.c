/* Two elastic layers of bond-based and ordinary bodies: stiffness along their interface, across it and in shear, for any
 * contrast of moduli, lattice and horizon, over that of Hooke's law. */
#include "support.h"

/** Two layers of six free rows each. */
typedef struct Layers {
  const char *formulation, *space, *lattice;
  double spacings, contrast, poisson;
} Layers;

enum { ROWS = 6, HELD = 4, LONG = 16, SHORT = 7 }; /* LONG: in the plane */

typedef enum State { STATE_ALONG, STATE_ACROSS, STATE_SHEAR, STATES } State;
static const char *const state_words[] = {"along", "across", "in shear"};

static bool is_solid(const Layers *of)
{
  return !strcmp(of->space, "3-D");
}

static double rows_apart(const Layers *of)
{
  return strcmp(of->lattice, "hexagonal") ? 1 : sqrt(0.75);
}

/** Writes the corner of a box. @param[in] y  place across the interface */
static char *corner_of(const Layers *of, double x, double y, double z)
{
  return is_solid(of) ? text_format("[%.17g, %.17g, %.17g]", x, z, y) : text_format("[%.17g, %.17g]", x, y);
}

/** Returns the loads of a state. */
static char *loads_of(const Layers *of, State state)
{
  const bool solid = is_solid(of);
  const char *up = solid ? "z" : "y";
  if (state == STATE_ALONG)
    return text_format(solid ? "  - {on: {all: yes}, field: {displacement: ['1e-6 * x', free, free]}}\n"
                               "  - {on: {nearest: [8, 4, 0]}, displacement: [free, 0, 0]}\n"
                               "  - {on: {nearest: [8, 4, 5]}, displacement: [free, 0, free]}\n"
                             : "  - {on: {all: yes}, field: {displacement: ['1e-6 * x', free]}}\n"
                               "  - {on: {nearest: [8, 0]}, displacement: [free, 0]}\n");
  return text_format("  - {on: {block: a, face: x-}, support: {held: periodic}}\n"
                     "  - {on: {block: b, face: x-}, support: {held: periodic}}\n%s"
                     "  - {on: {block: a, face: %s-, layers: %d}, displacement: [0, 0%s]}\n"
                     "  - {on: {block: b, face: %s+, layers: %d}, displacement: [%s]}\n",
                     solid ? "  - {on: {block: a, face: y-}, support: {held: periodic}}\n"
                             "  - {on: {block: b, face: y-}, support: {held: periodic}}\n"
                           : "",
                     up, HELD, solid ? ", 0" : "", up, HELD,
                     state == STATE_SHEAR ? (solid ? "1e-6, 0, 0" : "1e-6, 0") : (solid ? "0, 0, 1e-6" : "0, 1e-6"));
}

/** Returns the energy of a state of two layers, the lower one with a Young's modulus of 1e6. */
static double energy_of(const Layers *of, State state)
{
  const double height = (ROWS + (state == STATE_ALONG ? 0 : HELD)) * rows_apart(of);
  char *corner[4] = {corner_of(of, 0, -height, 0), corner_of(of, is_solid(of) ? SHORT : LONG, 0, SHORT),
                     corner_of(of, 0, 0, 0), corner_of(of, is_solid(of) ? SHORT : LONG, height, SHORT)},
       *loads = loads_of(of, state),
       *law = strcmp(of->formulation, "ordinary") ? text_format("model: elastic-1d")
                                                  : text_format("model: elastic, Poisson ratio: %.17g", of->poisson);
  const char *thick = is_solid(of) ? "" : ", thickness: 1";
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials:\n"
      "  a: {%s, density: 2, Young modulus: 1e6}\n  b: {%s, density: 2, Young modulus: %.17g}\n"
      "body:\n  a: {material: a, lattice: %s, spacing: 1%s, shape: {box: {from: %s, to: %s}}}\n"
      "  b: {material: b, lattice: %s, spacing: 1%s, shape: {box: {from: %s, to: %s}}}\n"
      "peridynamics: {space: %s, formulation: %s, horizon: %g spacings}\nloads:\n%ssolve: {static: {increments: 1}}\n",
      law, law, 1e6 / of->contrast, of->lattice, thick, corner[0], corner[1], of->lattice, thick, corner[2], corner[3],
      of->space, of->formulation, of->spacings, loads);
  step_surely(m, 1);
  const double energy = solver_energy(&m->solver).stored;
  breccia_model_destroy(&m);
  for (int k = 0; k < 4; ++k) free(corner[k]);
  free(loads);
  free(law);
  return energy;
}

/** Returns the energy of two layers over that by the energy of one material and Hooke's law. */
static double stiffness_of(const Layers *of, State state)
{
  Layers one = *of;
  one.contrast = 1;
  const double share = state == STATE_ALONG ? (1 + 1 / of->contrast) / 2 : 2 / (1 + of->contrast);
  return energy_of(of, state) / (share * energy_of(&one, state));
}

static void assert_stiff(const Layers *of, double near)
{
  for (State s = 0; s < STATES; ++s) {
    const double stiffness = stiffness_of(of, s);
    if (!(fabs(stiffness - 1) <= (s == STATE_ALONG ? near : 0.002)))
      fail_msg("%s, %s, %g spacings, contrast %g, %s: %.5f of the stiffness of both layers", of->formulation, of->space,
               of->spacings, of->contrast, state_words[s], stiffness);
  }
}

static const char *const formulations[] = {"bond-based", "ordinary"};

static void layers_in_the_plane_are_as_stiff_as_hooke_says(void **state)
{
  (void)state;
  static const double contrasts[] = {2, 10, 100, 1000};
  for (int f = 0; f < 2; ++f)
    for (int c = 0; c < 4; ++c) {
      assert_stiff(&(Layers){formulations[f], "plane stress", "square", 3.015, contrasts[c], 1. / 3}, 0.003);
      assert_stiff(&(Layers){formulations[f], "plane stress", "square", 2.015, contrasts[c], 0.2}, 0.01);
      assert_stiff(&(Layers){formulations[f], "plane strain", "square", 3.015, contrasts[c], 0.3}, 0.003);
    }
}

static void layers_in_space_are_as_stiff_as_hooke_says(void **state)
{
  (void)state;
  for (int f = 0; f < 2; ++f) {
    assert_stiff(&(Layers){formulations[f], "3-D", "cubic", 2.015, 1000, 0.25}, 0.01);
    if (whole_walks()) assert_stiff(&(Layers){formulations[f], "3-D", "cubic", 3.015, 10, 0.2}, 0.004);
  }
}

/** Bonds of laws that can fail keep the mean of both ends: pieces in series would carry on above the strength of the
 *  softer one. */
static void laws_that_can_fail_keep_the_mean_of_both_ends(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *stiff, *soft, *failure;
    bool joins;
  } of[] = {
      {"bond-based", "elastic-1d", "elastic-1d", "", true},
      {"bond-based", "elastic-1d", "elastic-perfectly-plastic, yield stress: 1", "", false},
      {"bond-based", "elastic-1d", "elastic-brittle, tensile strength: 1", "", false},
      {"bond-based", "elastic-1d", "bilinear-softening, tensile strength: 1, fracture energy: 1", "", false},
      {"bond-based", "elastic-1d", "elastic-1d", "failure: {critical stretch: 0.01}\n", false},
      {"ordinary", "elastic, Poisson ratio: 0.2", "elastic, Poisson ratio: 0.2", "", true},
      {"ordinary", "elastic, Poisson ratio: 0.2", "j2, Poisson ratio: 0.2, yield stress: 1", "", false},
      {"ordinary", "elastic, Poisson ratio: 0.2", "elastic, Poisson ratio: 0.2", "failure: {critical stretch: 0.01}\n",
       false},
  };
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials:\n"
        "  a: {density: 2, Young modulus: 1e6, model: %s}\n  b: {density: 2, Young modulus: 1e5, model: %s}\n"
        "body:\n  a: {material: a, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, -4], to: [8, "
        "0]}}}\n"
        "  b: {material: b, lattice: square, spacing: 1, thickness: 1, shape: {box: {from: [0, 0], to: [8, 4]}}}\n"
        "peridynamics: {space: plane stress, formulation: %s}\n%ssolve: {explicit: {time step: 1e-6, steps: 1}}\n",
        of[k].stiff, of[k].soft, of[k].formulation, of[k].failure);
    const Domain *d = &m->domain;
    const Region *region = &d->regions[0];
    const int32_t stiff = particles_nearest(d->particles, (double[]){4.5, -0.5, 0}),
                  soft = particles_nearest(d->particles, (double[]){4.5, 0.5, 0});
    const bool shifts = region->type->shifts_interface(region->formulation, &d->materials[d->material[stiff / SLICE]],
                                                       &d->materials[d->material[soft / SLICE]]);
    double state_of[3];
    for (int32_t n = 0; n < d->particles->count; ++n) {
      const int32_t i = d->particles->place_of[n];
      for (int c = 0; c < 2; ++c) d->particles->displacement.row[c][i] = 1e-9 * d->particles->position[c][i];
    }
    compute_forces(m);
    const int64_t slot = family_slot(&d->family, stiff, soft);
    double force = 0;
    for (int end = 0; end < 2; ++end) {
      const int32_t own = end ? soft : stiff;
      const int64_t at = end ? family_slot(&d->family, soft, stiff) : slot;
      region->type->half_state(region->formulation, d->particles->displacement.row, NULL, own / SLICE, at, own % SLICE,
                               state_of);
      force += fabs(state_of[1]);
    }
    /* Moduli of 1 and 0.1 have the mean of 0.55, and 0.182 in series. */
    const int64_t one = particles_nearest(d->particles, (double[]){4.5, -1.5, 0});
    double inside[3];
    region->type->half_state(region->formulation, d->particles->displacement.row, NULL, one / SLICE,
                             family_slot(&d->family, (int32_t)one, stiff), (int)(one % SLICE), inside);
    const double share = force / (2 * fabs(inside[1]));
    if (shifts == of[k].joins || !(of[k].joins ? share < 0.3 : share > 0.35 && share < 0.7))
      fail_msg("%s, %s on %s %s: a bond across has %.3f of the stiffness of the stiffer side", of[k].formulation,
               of[k].soft, of[k].stiff, of[k].failure, share);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(laws_that_can_fail_keep_the_mean_of_both_ends),
                                     cmocka_unit_test(layers_in_the_plane_are_as_stiff_as_hooke_says),
                                     cmocka_unit_test(layers_in_space_are_as_stiff_as_hooke_says)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Tractions and pressures on faces: with what bonds cut off would bring, an even stress reaches up to every face, edge and corner. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

static const double stress[6] = {3, -2, 1.5, 0.7, -0.4, 0.9}; /* xx yy zz xy yz zx */
static const int place_in[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

static double of(int r, int c, int dimensions)
{
  return r < dimensions && c < dimensions ? stress[place_in[r][c]] : 0;
}

/** Tractions of the stress on all faces of a body. */
static void add_tractions(char *text, size_t size, int dimensions, const char *more)
{
  size_t length = (size_t)snprintf(text, size, "loads:\n");
  for (int axis = 0; axis < dimensions; ++axis)
    for (int sign = -1; sign <= 1; sign += 2)
      length += (size_t)snprintf(text + length, size - length, "  - {on: {face: %c%c}, traction: [%g, %g, %g]%s}\n",
                                 "xyz"[axis], sign > 0 ? '+' : '-', sign * of(0, axis, dimensions),
                                 sign * of(1, axis, dimensions), sign * of(2, axis, dimensions), more);
}

/** Strain of the stress, with E = 1e4 and nu = 0.3, as a gradient. */
static void find_gradient(const char *space, double f[9])
{
  const double young = 1e4, ratio = 0.3;
  const int dimensions = strcmp(space, "3-D") ? 2 : 3;
  double trace = 0;
  for (int k = 0; k < dimensions; ++k) trace += of(k, k, dimensions);
  if (!strcmp(space, "plane strain")) trace *= 1 + ratio;
  for (int k = 0; k < 9; ++k)
    f[k] = (k % 4 == 0) + ((1 + ratio) * of(k / 3, k % 3, dimensions) - (k % 4 == 0 ? ratio * trace : 0)) / young;
  for (int k = dimensions; k < 3; ++k) f[4 * k] = 1;
}

static breccia_model *brick(const char *formulation, const char *space, double horizon, const char *particles,
                            const char *loads)
{
  const bool plane = strcmp(space, "3-D") != 0;
  return model_of(UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}}\n"
                        "body: {b: {material: m, lattice: %s, spacing: 0.1%s, shape: {box: {particles: %s}}}}\n"
                        "peridynamics: {formulation: %s, space: %s, strain: small, horizon: %g spacings}\n"
                        "%ssolve: {implicit: {end time: 1, stiffness damping: 1e-6}}\n",
                  plane ? "square" : "cubic", plane ? ", thickness: 0.3" : "", particles, formulation, space, horizon,
                  loads);
}

/** The largest force on a particle that bonds and loads leave, as a share of that on its face. */
static double largest_left(breccia_model *m, const char *space)
{
  Particles *p = m->domain.particles;
  double f[9], most = 0;
  find_gradient(space, f);
  deform_uniformly(m, f);
  compute_forces(m);
  loading_enter(&m->loading, p, 0, NULL);
  loading_apply(&m->loading, p, 1);
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k)
      most = larger_of(most, fabs(p->internal.row[k][p->place_of[n]] + p->external.row[k][p->place_of[n]]));
  return most * 0.1 / 3; /* times the spacing, over the largest stress */
}

static const char *const forms[] = {"hybrid, form: variational", "hybrid, form: pairwise", "correspondence"};
static const char *const spaces[] = {"plane stress", "plane strain", "3-D"};
static const double horizons[] = {1.5, 2.015};

static void an_even_stress_reaches_up_to_all_faces(void **state)
{
  (void)state;
  char loads[1000];
  for (int f = 0; f < 3; ++f)
    for (int s = 0; s < 3; ++s)
      for (int k = 0; k < 2; ++k) {
        if (under_sanitizers() && s == 2 && k) continue;
        const int dimensions = s == 2 ? 3 : 2;
        add_tractions(loads, sizeof loads, dimensions, "");
        breccia_model *m = brick(forms[f], spaces[s], horizons[k], dimensions == 3 ? "[8, 9, 10]" : "[8, 11]", loads);
        const double left = largest_left(m, spaces[s]);
        assert_true(left < 1e-11);
        breccia_model_destroy(&m);
        add_tractions(loads, sizeof loads, dimensions, ", spread: layers");
        m = brick(forms[f], spaces[s], horizons[k], dimensions == 3 ? "[8, 9, 10]" : "[8, 11]", loads);
        assert_true(largest_left(m, spaces[s]) > 0.1);
        breccia_model_destroy(&m);
      }
}

/** Force of all loads at factor 1, and its mean place along an axis by its part along z or, in the plane, y. */
static Sums forces_of(breccia_model *m, int axis, double *at)
{
  Particles *p = m->domain.particles;
  loading_enter(&m->loading, p, 0, NULL);
  loading_apply(&m->loading, p, 1);
  const Sums sums = sums_of(m);
  const int by = m->domain.body.dimensions - 1;
  *at = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    *at += p->position[axis][i] * p->external.row[by][i] * p->volume[i] / sums.external[by];
  }
  return sums;
}

/** Of a part of a face the resultant stands at the face; in bodies too thin for that, next to other blocks and where bonds do not tell it is on the last
 *  layer. In any case it is the traction times the area. */
static void resultants_are_right_whatever_stands_behind_the_face(void **state)
{
  (void)state;
  const char *const parts[] = {"[{from: [0.4, 0], to: [1.1, 9]}]", "[{from: [0, 0], to: [0.3, 9]}]"};
  double at;
  char loads[300];
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 2; ++k) {
      for (int part = 0; part < 2; ++part) {
        snprintf(loads, sizeof loads, "loads: [{on: {face: y+, inside: {box: %.*s}}, traction: [0, -5]}]\n",
                 (int)strlen(parts[part]) - 2, parts[part] + 1);
        breccia_model *m = brick(forms[f], "plane strain", horizons[k], "[15, 12]", loads);
        const Sums sums = forces_of(m, 1, &at);
        assert_near(sums.external[1], -5 * 0.3 * (part ? 0.3 : 0.7), 1e-12);
        assert_near(at, 1.2, part ? 0.01 : 1e-12);
        breccia_model_destroy(&m);
      }
      breccia_model *m = brick(forms[f], "3-D", horizons[k], "[9, 9, 2]", "loads: [{on: {face: z+}, pressure: 4}]\n");
      const Sums sums = forces_of(m, 2, &at);
      assert_near(sums.external[2], -4 * 0.81, 1e-12);
      assert_near(at, 0.15, 1e-12);
      breccia_model_destroy(&m);
    }
}

/** A column that water stands against on both sides takes nothing in all, and the pressure of its depth in each row. */
static void water_presses_by_depth_at_the_face(void **state)
{
  (void)state;
  breccia_model *m = brick(forms[0], "plane strain", 1.5, "[10, 40]",
                           "loads: [{on: {face: x-}, water pressure: {surface: 3, unit weight: 10}}, {on: {face: x+}, "
                           "water pressure: {surface: 3, unit weight: 10}}]\n");
  const Particles *p = m->domain.particles;
  double at, force[4] = {0};
  const Sums sums = forces_of(m, 0, &at);
  assert_near(sums.external[0], 0, 1e-12);
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (fabs(p->position[1][i] - 1.05) > 1e-9) continue;
    const int layer = (int)lround((p->position[0][i] - 0.05) / 0.1);
    if (layer < 4) force[layer] = p->external.row[0][i] * p->volume[i];
  }
  const double whole = 10 * (3 - 1.05) * 0.1 * 0.3;
  assert_near(force[0], 1.5 * whole, 1e-12);
  assert_near(force[1], -0.5 * whole, 1e-12);
  assert_near(force[2], 0, 1e-12);
  breccia_model_destroy(&m);
}

/** 1/2 of the unit weight times the depth squared times the thickness, whatever columns at corners stand for. */
static void water_comes_to_the_force_on_its_face(void **state)
{
  (void)state;
  double at;
  for (int f = 0; f < 3; ++f)
    for (int k = 0; k < 2; ++k)
      for (int above = 0; above < 2; ++above) {
        char loads[200];
        snprintf(loads, sizeof loads, "loads: [{on: {face: x-}, water pressure: {surface: %d, unit weight: 10}}]\n",
                 above ? 2 : 4);
        breccia_model *m = brick(forms[f], "plane strain", horizons[k], "[12, 30]", loads);
        assert_near(forces_of(m, 0, &at).external[0], 10 * 0.3 * (above ? 2 * 2 : 4 * 4 - 1) / 2, 1e-12);
        breccia_model_destroy(&m);
      }
}

/** What a user gets of it: a bar that is pulled at its last row has an even strain to the end, and its end moves as it should. */
static void a_pulled_bar_strains_evenly_to_its_end(void **state)
{
  (void)state;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 2; ++k)
      for (int spread = 0; spread < 2; ++spread) {
        breccia_model *m = model_of(
            UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: "
                  "[16, 6]}}}}\n"
                  "peridynamics: {formulation: %s, space: plane stress, strain: small, horizon: %g spacings}\n"
                  "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}},\n"
                  "        {on: {face: x+}, traction: [2, 0]%s}]\n"
                  "solve: {static: {increments: 1, residual: 1e-12, equations: direct}}\n",
            forms[f], horizons[k], spread ? ", spread: layers" : "");
        const Particles *p = m->domain.particles;
        double off = 0;
        step_surely(m, 1);
        for (int32_t n = 0; n < p->count; ++n) {
          const int32_t i = p->place_of[n];
          if (body_outside(&m->domain.body, n)) continue;
          off = larger_of(off, fabs(p->displacement.row[0][i] - 2e-4 * p->position[0][i]));
        }
        if (spread)
          assert_true(off > 1e-2 * 2e-5);
        else
          assert_near(off, 0, 1e-9 * 2e-4 * 1.6);
        breccia_model_destroy(&m);
      }
}

static void what_bonds_cannot_tell_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *load, *peridynamics, *words;
  } cases[] = {
      {"{on: {face: x+}, traction: [1, 0], spread: bonds}", "formulation: ordinary",
       "spread: bonds tell where forces act behind one layer of a face"},
      {"{on: {face: x+, layers: 2}, traction: [1, 0], spread: bonds}", "formulation: hybrid", "spread: bonds tell"},
      {"{on: {face: x+}, force: [1, 0], spread: layers}", "formulation: hybrid", "spread: only of a traction"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char deck[800];
    snprintf(deck, sizeof deck,
             UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                   "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: "
                   "[8, 8]}}}}\n"
                   "peridynamics: {%s, space: plane stress, horizon: 2.015 spacings}\n"
                   "loads: [{on: {face: x-}, support: {held: all}}, %s]\n"
                   "solve: {static: {increments: 1}}\n",
             cases[k].peridynamics, cases[k].load);
    char *words = refusal_of(deck);
    if (!strstr(words, cases[k].words)) fail_msg("%s", words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_even_stress_reaches_up_to_all_faces),
      cmocka_unit_test(resultants_are_right_whatever_stands_behind_the_face),
      cmocka_unit_test(water_presses_by_depth_at_the_face),
      cmocka_unit_test(water_comes_to_the_force_on_its_face),
      cmocka_unit_test(a_pulled_bar_strains_evenly_to_its_end),
      cmocka_unit_test(what_bonds_cannot_tell_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "support.h"

#define MATERIAL "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
#define SOLVE "solve: {explicit: {steps: 1}}\n"

static breccia_model *block_of(const char *shape, double spacing)
{
  return model_of(MATERIAL SOLVE "peridynamics: {horizon: 2.015 spacings}\n"
                                 "body: {b: {material: m, spacing: %g, shape: %s}}\n",
                  spacing, shape);
}

static double volume_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  double volume = 0;
  for (int64_t i = 0; i < p->places; ++i) volume += p->volume[i];
  return volume;
}

static void shapes_have_the_volumes_of_geometry(void **state)
{
  (void)state;
  const double pi = acos(-1);
  const struct {
    const char *shape;
    double volume, tolerance;
  } cases[] = {
      {"{box: {from: [0, 0, 0], to: [1, 0.5, 0.5]}}", 0.25, 1e-12},
      {"{sphere: {centre: [1, 2, 3], radius: 0.5}}", pi / 6, 0.01},
      {"{cylinder: {from: [0, 0, 0], to: [0, 0, 1], radius: 0.4}}", pi * 0.16, 0.02},
      {"{cylinder: {from: [0, 0, 0], to: [1, 1, 1], radius: 0.3}}", pi * 0.09 * sqrt(3), 0.02},
      {"{polygon: {corners: [[0, 0], [1, 0], [0, 1]], bottom: 0, top: 0.5}}", 0.25, 0.035},
      {"{difference: [{box: {from: [0, 0, 0], to: [1, 1, 0.5]}}, {box: {from: [0.25, 0.25, -1], to: [0.75, 0.75, "
       "1]}}]}",
       0.375, 1e-12},
      {"{union: [{box: {from: [0, 0, 0], to: [1, 0.5, 0.5]}}, {box: {from: [0, 0, 0], to: [0.5, 1, 0.5]}}]}", 0.375,
       1e-12},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model = block_of(cases[k].shape, 1.0 / 32);
    assert_near(volume_of(model), cases[k].volume, cases[k].tolerance * cases[k].volume);
    breccia_model_destroy(&model);
  }
}

/** A point that goes out through a face of a shape is inside until it is the tolerance away; the box around the shape ends where its outermost faces do. */
static void shapes_hold_points_up_to_their_faces(void **state)
{
  (void)state;
  const double r = sqrt(0.5);
  const struct {
    const char *shape;
    double low[3], high[3]; /* of the box around it */
    struct {
      double at[3], out[3]; /* a place on a face, and the way out of it */
    } faces[6];
    int count;
  } cases[] = {
      {"box: {from: [1, 2, 3], to: [2, 4, 6]}",
       {1, 2, 3},
       {2, 4, 6},
       {{{1, 3, 4}, {-1}},
        {{2, 3, 4}, {1}},
        {{1.5, 2, 4}, {0, -1}},
        {{1.5, 4, 4}, {0, 1}},
        {{1.5, 3, 3}, {0, 0, -1}},
        {{1.5, 3, 6}, {0, 0, 1}}},
       6},
      {"box: {particles: [2, 3, 4], first particle: [1, 1, 1]}",
       {0.5, 0.5, 0.5},
       {2.5, 3.5, 4.5},
       {{{0.5, 2, 2}, {-1}},
        {{2.5, 2, 2}, {1}},
        {{1, 0.5, 2}, {0, -1}},
        {{1, 3.5, 2}, {0, 1}},
        {{1, 2, 0.5}, {0, 0, -1}},
        {{1, 2, 4.5}, {0, 0, 1}}},
       6},
      {"box: {particles: [2, 3, 4]}",
       {0, 0, 0},
       {2, 3, 4},
       {{{0, 2, 2}, {-1}}, {{2, 2, 2}, {1}}, {{1, 3, 2}, {0, 1}}, {{1, 2, 4}, {0, 0, 1}}},
       4},
      {"sphere: {centre: [1, 2, 3], radius: 2}",
       {-1, 0, 1},
       {3, 4, 5},
       {{{-1, 2, 3}, {-1}}, {{1, 4, 3}, {0, 1}}, {{1, 2, 5}, {0, 0, 1}}, {{1 + 2 * r, 2 + 2 * r, 3}, {r, r}}},
       4},
      {"cylinder: {from: [1, 2, 3], to: [1, 2, 7], radius: 2}",
       {-1, 0, 3},
       {3, 4, 7},
       {{{-1, 2, 4}, {-1}}, {{1, 4, 6}, {0, 1}}, {{1, 2, 3}, {0, 0, -1}}, {{2, 3, 7}, {0, 0, 1}}},
       4},
      {"cylinder: {from: [4, 1, 0], to: [1, 4, 0], radius: 1}",
       {1 - r, 1 - r, -1},
       {4 + r, 4 + r, 1},
       {{{4, 1, 0.5}, {r, -r}}, {{1, 4, 0.5}, {-r, r}}, {{2.5 + r, 2.5 + r, 0}, {r, r}}, {{2.5, 2.5, 1}, {0, 0, 1}}},
       4},
      {"polygon: {corners: [[1, 1], [4, 1], [4, 5], [1, 3]], bottom: 2, top: 3}",
       {1, 1, 2},
       {4, 5, 3},
       {{{2, 2, 2}, {0, 0, -1}}, {{2, 2, 3}, {0, 0, 1}}},
       2},
      {"polygon: {corners: [[1, 1], [4, 1], [4, 5], [1, 3]]}",
       {1, 1, 0},
       {4, 5, 1},
       {{{2, 2, 0}, {0, 0, -1}}, {{2, 2, 1}, {0, 0, 1}}},
       2},
      {"union: [{sphere: {centre: [0, 0, 0], radius: 1}}, {box: {from: [0, 0, 0], to: [3, 2, 2]}}]",
       {-1, -1, -1},
       {3, 2, 2},
       {{{-1, 0, 0}, {-1}}, {{3, 1, 1}, {1}}, {{2, 2, 1}, {0, 1}}, {{0, 0, -1}, {0, 0, -1}}},
       4},
      {"difference: [{box: {from: [0, 0, 0], to: [9, 9, 9]}}, {sphere: {centre: [4, 4, 4], radius: 1}}, {box: {from: "
       "[6, 6, 6], to: [8, 8, 8]}}]",
       {0, 0, 0},
       {9, 9, 9},
       {{{5, 4, 4}, {-1}}, {{4, 3, 4}, {0, 1}}, {{6, 7, 7}, {1}}, {{7, 8, 7}, {0, -1}}},
       4},
  };
  Units *units = units_create("m", "N", "s", NULL);
  Lattice lattice = {0};
  lattice_measure(&lattice, lattice_find("cubic"), 1);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    Error *error = breccia_error_create();
    Document *document = document_parse(cases[c].shape, strlen(cases[c].shape), "deck", error);
    const DeckReader reader = {.document = document, .units = units, .error = error};
    const Shape *shape = section_read(&reader, document->root, &shape_section);
    assert_string_equal(breccia_error_text(error), "");
    double low[3], high[3];
    shape_bounds(shape, &lattice.unit, low, high);
    for (int k = 0; k < 3; ++k) {
      assert_near(low[k], cases[c].low[k], 1e-12);
      assert_near(high[k], cases[c].high[k], 1e-12);
    }
    for (int f = 0; f < cases[c].count; ++f)
      for (int step = -3; step <= 3; ++step) {
        const double beyond = 0.05 * step, tolerance = 0.075;
        double point[3];
        for (int k = 0; k < 3; ++k) point[k] = cases[c].faces[f].at[k] + beyond * cases[c].faces[f].out[k];
        if (shape_contains(shape, &lattice.unit, 3, point, tolerance) != (beyond < tolerance))
          fail_msg("%s: face %d, %g beyond it", cases[c].shape, f, beyond);
        if (step && shape_contains(shape, &lattice.unit, 3, point, 0) != (step < 0))
          fail_msg("%s: face %d, %g beyond it, without tolerance", cases[c].shape, f, beyond);
      }
    document_destroy(&document);
    breccia_error_destroy(&error);
  }
  units_destroy(&units);
  /* A polygon with a dent, and points left and right of all its edges. */
  static const double corners[] = {0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 0, 4, 0};
  for (double x = -0.95; x < 5; x += 0.1)
    for (double y = -0.95; y < 5; y += 0.1) {
      const double roof = x < 2 ? 4 - 1.5 * x : 1 + 1.5 * (x - 2);
      assert_int_equal(polygon_contains(corners, 5, x, y), x > 0 && x < 4 && y > 0 && y < roof);
    }
}

/** Layers of a face are as thick as the brick of a particle, on any lattice and any of its faces. */
static void layers_of_faces_are_counted_alike_on_all_sides(void **state)
{
  (void)state;
  static const struct {
    const char *lattice, *space;
    int faces;
  } cases[] = {{"cubic", "3-D", 6},
               {"face-centred cubic", "3-D", 6},
               {"square, thickness: 1", "plane strain", 4},
               {"hexagonal, thickness: 1", "plane strain", 4}};
  static const char *const faces[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
  for (size_t c = 0; c < 4; ++c)
    for (int f = 0; f < cases[c].faces; ++f)
      for (int layers = 1; layers <= 3; ++layers) {
        breccia_model *model = model_of(MATERIAL SOLVE "peridynamics: {space: %s}\nbody: {b: {material: m, spacing: 1, "
                                                       "lattice: %s, shape: {box: {particles: [8, 7, 6]}}}}\n"
                                                       "loads: [{on: {face: %s, layers: %d}, body force: [1, 0, 0]}]\n",
                                        cases[c].space, cases[c].lattice, faces[f], layers);
        const Particles *p = model->domain.particles;
        const Lattice *lattice = &model->domain.body.lattices[0];
        const Selection *selection = &model->loading.loads[0].selection;
        const int axis = f / 2, sign = f % 2 ? 1 : -1;
        double low[3], high[3];
        int64_t expected = 0;
        particles_bounds(p, low, high);
        const double outermost = f % 2 ? high[axis] : -low[axis], depth = lattice->unit.size[axis] * layers;
        for (int64_t n = 0; n < p->count; ++n)
          expected += outermost - sign * p->position[axis][p->place_of[n]] < depth - 1e-6;
        assert_true(expected < p->count / 2 + 1);
        assert_int_equal(selection->count, expected);
        for (int64_t n = 0; n < selection->count; ++n)
          assert_true(outermost - sign * p->position[axis][selection->places[n]] < depth - 1e-6);
        breccia_model_destroy(&model);
      }
}

/** A face that two blocks of unlike spacing share has layers of both spacings. */
static void layers_of_a_face_are_those_of_each_block(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      MATERIAL SOLVE "peridynamics: {space: 3-D}\n"
                     "body:\n  coarse: {material: m, spacing: 1, shape: {box: {from: [0, 0, 0], to: [6, 4, 4]}}}\n"
                     "  fine: {material: m, spacing: 0.5, shape: {box: {from: [0, 4, 0], to: [6, 6, 4]}}}\n"
                     "loads: [{on: {face: x-, layers: 2}, body force: [1, 0, 0]}]\n");
  const Particles *p = model->domain.particles;
  const Selection *selection = &model->loading.loads[0].selection;
  int64_t counts[2] = {0};
  for (int64_t n = 0; n < selection->count; ++n) {
    const int32_t i = selection->places[n];
    const int block = p->block[i / SLICE];
    ++counts[block];
    assert_true(p->position[0][i] < (block ? 1 : 2));
  }
  assert_int_equal(counts[0], 4 * 4 * 2);
  assert_int_equal(counts[1], 4 * 8 * 2);
  breccia_model_destroy(&model);
}

static void particles_on_the_face_of_a_hole_stay(void **state)
{
  (void)state;
  /* Of 21 x 21 points around the middle: 81 lie within a distance of 5 of it, 12 of them right there, like 3, 4. A plate keeps those at its
   * edge, and those at the edge of a hole. */
  const struct {
    const char *shape;
    int count;
  } cases[] = {
      {"{difference: [{box: {particles: [21, 21], first particle: [-10, -10]}}, {sphere: {centre: [0, 0], radius: "
       "5}}]}",
       441 - 81 + 12},
      {"{difference: [{box: {particles: [21, 21], first particle: [-10, -10]}}, {box: {from: [-3, -2], to: [3, 2]}}]}",
       441 - 5 * 3},
      {"{difference: [{box: {particles: [11, 11], first particle: [-5, -5]}}, {difference: [{box: {particles: [21, "
       "21], "
       "first particle: [-10, -10]}}, {sphere: {centre: [0, 0], radius: 5}}]}]}",
       81},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {space: plane strain}\n"
                                "body: {b: {material: m, lattice: square, thickness: 1, spacing: 1, shape: %s}}\n",
                 cases[k].shape);
    assert_int_equal(model->domain.particles->count, cases[k].count);
    breccia_model_destroy(&model);
  }
}

static void numbers_run_along_x_then_y_then_z(void **state)
{
  (void)state;
  breccia_model *model = block_of("{box: {particles: [3, 11, 4], first particle: [0, 0, 0]}}", 1);
  const Particles *p = model->domain.particles;
  assert_int_equal(p->count, 3 * 11 * 4);
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    assert_int_equal(p->number[i], n);
    assert_near(p->position[0][i], (double)(n % 3), 0);
    assert_near(p->position[1][i], (double)(n / 3 % 11), 0);
    assert_near(p->position[2][i], (double)(n / 33), 0);
  }
  breccia_model_destroy(&model);
}

/* ---- families ---- */

static int interior_bonds(const char *lattice, const char *space, int n, double horizon)
{
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: %g spacings, space: %s}\n"
                              "body: {b: {material: m, lattice: %s, spacing: 1, shape: {box: {particles: "
                              "[%d, %d, %d], first particle: [0, 0, 0]}}}}\n",
               horizon, space, lattice, n, n, strcmp(space, "3-D") ? 1 : n);
  const double middle[3] = {(n - 1) / 2, (n - 1) / 2, strcmp(space, "3-D") ? 0 : (n - 1) / 2};
  int count = family_count(&model->domain.family, particles_nearest(model->domain.particles, middle));
  breccia_model_destroy(&model);
  return count;
}

static void families_on_lattices_have_the_counts_of_geometry(void **state)
{
  (void)state;
  /* docs/theory.md 1; the horizon of 3 exactly reaches the neighbours at 3. */
  const struct {
    double horizon;
    int plane, space;
  } cases[] = {{1.5, 8, 18}, {2.015, 12, 32}, {3, 28, 122}, {3.015, 28, 122}, {4.015, 48, 256}};
  for (int k = 0; k < 5; ++k) {
    assert_int_equal(interior_bonds("square, thickness: 1", "plane strain", 11, cases[k].horizon), cases[k].plane);
    assert_int_equal(interior_bonds("cubic", "3-D", 11, cases[k].horizon), cases[k].space);
  }
}

static void families_are_those_of_all_pairs_on_a_body_with_hole_cut_and_two_lattices(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      MATERIAL SOLVE "peridynamics: {horizon: 2.5}\n"
                     "cracks: [{cut: {polygon: [[2.7, -9, -9], [2.7, 6.3, -9], [2.7, 6.3, 9], [2.7, -9, 9]]}},\n"
                     "         {remove: {box: {from: [8.5, 3.5, -1], to: [9.5, 20, 9]}}, cut faces: yes}]\n"
                     "body:\n"
                     "  coarse: {material: m, spacing: 1, shape: {difference: [{box: {particles: [21, 9, 4]}}, "
                     "{sphere: {centre: [14, 4, 2], "
                     "radius: 1.9}}]}}\n"
                     "  fine: {material: m, spacing: 0.8, shape: {box: {from: [0, 0, 4], to: [8, 8, 6.4]}}}\n");
  assert_true(model->domain.family.stored_slots > 0);
  assert_families_are_all_pairs(model);
  breccia_model_destroy(&model);
}

static void bonds_come_in_pairs_with_opposite_vectors_and_break_on_both_sides(void **state)
{
  (void)state;
  breccia_model *model = block_of("{sphere: {centre: [0, 0, 0], radius: 4.2}}", 1);
  Family *f = &model->domain.family;
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    for (int64_t slot = f->first[i / SLICE]; slot < f->first[i / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> (i % SLICE) & 1)) continue;
      Bond bond = family_bond(f, i / SLICE, slot, i % SLICE);
      assert_true(family_joins(f, bond.neighbour, i));
      for (int k = 0; k < 3; ++k) assert_near(bond.xi[k], p->position[k][bond.neighbour] - p->position[k][i], 1e-12);
    }
  }
  const double points[2][3] = {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}};
  int32_t a = particles_nearest(p, points[0]), b = particles_nearest(p, points[1]);
  int before = family_count(f, a);
  assert_true(family_break(f, a, b));
  assert_false(family_joins(f, a, b));
  assert_false(family_joins(f, b, a));
  assert_int_equal(family_count(f, a), before - 1);
  assert_false(family_break(f, a, b));
  breccia_model_destroy(&model);
}

static double weighted_volume(int n, const char *correction)
{
  /* Sum of omega |xi|^2 V over the family of the middle particle of a cube of side 2, horizon 1. */
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: 1, volume correction: %s}\n"
                              "body: {b: {material: m, spacing: %.17g, shape: {box: {from: [-1, -1, -1], "
                              "to: [1, 1, 1]}}}}\n",
               correction, 2.0 / n);
  const double origin[3] = {0, 0, 0};
  int32_t i = particles_nearest(model->domain.particles, origin);
  const Family *f = &model->domain.family;
  double sum = 0;
  for (int64_t slot = f->first[i / SLICE]; slot < f->first[i / SLICE + 1]; ++slot)
    if (f->intact[slot] >> (i % SLICE) & 1) {
      Bond bond = family_bond(f, i / SLICE, slot, i % SLICE);
      sum += bond.weight * bond.length * bond.length;
    }
  breccia_model_destroy(&model);
  return sum;
}

static void weighted_volume_of_whole_cells_matches_peridigm(void **state)
{
  (void)state;
  /* validation U4: Peridigm's gold files for naive volumes; the exact value is 4 pi / 5. */
  const struct {
    int n;
    double naive;
  } gold[] = {{5, 3.502080}, {7, 2.490391}, {9, 2.594726}, {11, 2.764640}, {13, 2.655369}, {17, 2.481106}};
  for (int k = 0; k < (under_sanitizers() ? 3 : 6); ++k)
    assert_near(weighted_volume(gold[k].n, "none"), gold[k].naive, 1e-6);
  if (under_sanitizers()) return; /* larger bodies walk the same code */
  const double exact = 4 * acos(-1) / 5;
  assert_near(weighted_volume(17, "partial-beyond"), exact, 0.02 * exact);
}

static void weights_of_bonds_are_influence_times_volume(void **state)
{
  (void)state;
  /* docs/theory.md 1, at bonds along an axis of a horizon of 4 spacings of 0.5: q = 1/4, 1/2, 3/4 and 1. */
  const struct {
    const char *name;
    double value[4];
  } cases[] = {{"constant", {1, 1, 1, 1}},
               {"conical", {0.75, 0.5, 0.25, 0}},
               {"inverse", {2, 1, 2.0 / 3, 0.5}},
               {"inverse-square", {4, 1, 4.0 / 9, 0.25}},
               {"quartic", {225.0 / 256, 9.0 / 16, 49.0 / 256, 0}},
               {"gaussian", {exp(-0.25), exp(-1), exp(-2.25), exp(-4)}},
               {"cubic-spline", {2.0 / 3 - 0.1875, 1.0 / 6, 1.0 / 48, 0}}};
  for (int k = 0; influence_word(k); ++k) {
    int c = 0;
    while (c < 7 && strcmp(cases[c].name, influence_word(k)) != 0) ++c;
    if (c == 7) fail_msg("nobody tests the influence '%s'", influence_word(k));
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {horizon: 4 spacings, influence: %s}\n"
                                "body: {b: {material: m, spacing: 0.5, shape: {box: {particles: [9, 9, 9]}}}}\n",
                 cases[c].name);
    const Family *f = &model->domain.family;
    int found = 0;
    for (int row = 0; row < f->pattern_count; ++row) {
      const double *xi = f->patterns[row].xi, length = fabs(xi[0]) + fabs(xi[1]) + fabs(xi[2]);
      if (fabs(f->patterns[row].length - length) > 1e-12) continue;
      ++found;
      assert_near(f->patterns[row].weight, cases[c].value[(int)lround(2 * length) - 1] * 0.125, 1e-15);
      assert_near(f->patterns[row].weighted_xi[0], f->patterns[row].weight * xi[0], 1e-18);
    }
    assert_int_equal(found, 4 * 6);
    breccia_model_destroy(&model);
  }
}

static void round_bodies_lie_in_the_middle_of_their_lattice(void **state)
{
  (void)state;
  /* Whatever the spacing: their particles are as symmetric as they are. */
  const struct {
    const char *shape;
    double middle[3];
  } cases[] = {{"{sphere: {centre: [1.1, 2.2, 3.3], radius: 0.5}}", {1.1, 2.2, 3.3}},
               {"{cylinder: {from: [0.3, 0.1, 0.2], to: [0.3, 0.1, 1.2], radius: 0.4}}", {0.3, 0.1, 0.7}},
               {"{cylinder: {from: [-0.3, 0.1, 0.2], to: [0.9, 0.1, 0.2], radius: 0.4}}", {0.3, 0.1, 0.2}}};
  const double spacings[] = {1.0 / 16, 0.07, 0.091};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    for (int n = 0; n < 3; ++n) {
      breccia_model *model = block_of(cases[k].shape, spacings[n]);
      const Particles *p = model->domain.particles;
      for (int j = 0; j < 3; ++j) {
        double moment = 0;
        for (int64_t i = 0; i < p->places; ++i) moment += p->volume[i] * p->position[j][i];
        assert_near(moment / volume_of(model), cases[k].middle[j], 1e-10);
      }
      breccia_model_destroy(&model);
    }
}

static void parts_of_volumes_at_the_horizon_go_by_both_spacings(void **state)
{
  (void)state;
  /* Of blocks of spacings 1 and 0.5 the share between them falls from 1 at delta - h to 1/2 at delta, beyond which there is no bond, with
   * h = (1 + 0.5) / 4; from both ends alike. */
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: 2.6, volume correction: partial}\n"
                              "body:\n  a: {material: m, spacing: 1, shape: {box: {from: [0, 0, 0], to: [4, 4, 4]}}}\n"
                              "  b: {material: m, spacing: 0.5, shape: {box: {from: [4, 0, 0], to: [7, 4, 4]}}}\n");
  const Family *f = &model->domain.family;
  const Particles *p = model->domain.particles;
  int parts[2] = {0};
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        const Bond bond = family_bond(f, slice, slot, lane);
        const double share = fmin(1, (2.6 + 0.375 - bond.length) / 0.75);
        assert_near(bond.weight, share * p->volume[bond.neighbour], 1e-12);
        parts[p->block[slice]] += share < 1;
      }
  assert_true(parts[0] > 100);
  assert_int_equal(parts[0], parts[1]);
  breccia_model_destroy(&model);
}

static void particles_on_top_of_each_other_are_refused(void **state)
{
  (void)state;
  char *words = refusal_of(MATERIAL SOLVE "body:\n"
                                          "  a: {material: m, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}\n"
                                          "  b: {material: m, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}\n");
  assert_non_null(strstr(words, "on top of each other"));
  free(words);
}

/** Constants of bonds are of one thickness. */
static void blocks_of_unlike_thickness_or_area_are_refused(void **state)
{
  (void)state;
  static const char *const of[2][2] = {{"lattice: square, thickness", "has one thickness"},
                                       {"lattice: line, area", "a bar one area"}};
  for (int k = 0; k < 2; ++k) {
    char deck[512];
    snprintf(deck, sizeof deck,
             MATERIAL SOLVE
             "body:\n  a: {material: m, spacing: 1, %s: 1, shape: {box: {from: [0, 0], to: [9, %d]}}}\n  "
             "b: {material: m, spacing: 1, %s: 2, shape: {box: {from: [9, 0], to: [18, %d]}}}\n",
             of[k][0], k ? 1 : 5, of[k][0], k ? 1 : 5);
    char *words = refusal_of(deck);
    assert_non_null(strstr(words, of[k][1]));
    free(words);
  }
}

/** As of blocks drawn in unlike units. To count such families first took minutes, or passed the largest whole number. */
static void spacings_that_differ_by_thousands_are_refused_at_once(void **state)
{
  (void)state;
  for (double coarse = 1e3; coarse < 1e50; coarse *= coarse) {
    char deck[512];
    snprintf(deck, sizeof deck,
             MATERIAL SOLVE
             "body:\n  a: {material: m, spacing: %g, shape: {box: {particles: [4, 4, 4]}}}\n"
             "  b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [-1, 0, 0]}}}\n",
             coarse);
    char *words = refusal_of(deck);
    assert_non_null(strstr(words, "spacings of 0.1: families would have more than 65535 bonds"));
    free(words);
  }
}

static void selections_hold_what_they_say(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      MATERIAL SOLVE
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [10, 5, 3], first particle: [0, 0, 0]}}}}\n"
      "loads: [{on: {face: x+, layers: 3}, force: [6, 0, 0]}, {on: {inside: {sphere: {centre: [0, 0, 0], radius: "
      "1}}}, body force: [0, 1, 0]}, {on: {nearest: [4.4, 2.2, 1]}, body force: [0, 0, 2]}]\n");
  const Loading *l = &model->loading;
  assert_int_equal(l->loads[0].selection.count, 3 * 5 * 3);
  assert_int_equal(l->loads[1].selection.count, 4);
  assert_int_equal(l->loads[2].selection.count, 1);
  assert_near(model->domain.particles->position[0][l->loads[2].selection.places[0]], 4, 0);
  loading_apply(l, model->domain.particles, 0);
  double total = 0;
  for (int64_t i = 0; i < model->domain.particles->places; ++i)
    total += model->domain.particles->external.row[0][i] * model->domain.particles->volume[i];
  assert_near(total, 6, 1e-12);
  breccia_model_destroy(&model);
}

static void selections_join_others_have_them_in_common_and_leave_them_out(void **state)
{
  (void)state;
  /* Of 10 x 5 x 3 particles the end has 3 x 5 x 3, the base 10 x 3, both together 9 less than their sum. */
  const struct {
    const char *words;
    int64_t count;
  } cases[] = {{"{any of: [end, base]}", 45 + 30 - 9},
               {"{all of: [end, base]}", 9},
               {"{all of: [end, base, {face: z+}]}", 3},
               {"{except: base}", 150 - 30},
               {"{all: yes, except: [end, base]}", 150 - 66},
               {"{group: end}", 45},
               {"{group: end, face: x-}", 15}, /* the face of the end, not of the body */
               {"{group: end, except: {nearest: [9, 0, 0]}}", 44},
               {"{any of: [{face: x-}, {face: x+}], face: z-}", 10},
               {"{any of: {all of: [end, {except: base}]}}", 36},
               {"rest", 150 - 9}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model = model_of(
        MATERIAL SOLVE
        "body: {b: {material: m, spacing: 1, shape: {box: {particles: [10, 5, 3], first particle: [0, 0, 0]}}}}\n"
        "selections: {rest: {except: corner}, corner: {all of: [base, end]}, end: {face: x+, layers: 3}, base: {face: "
        "y-}}\n"
        "loads: [{on: %s, body force: [1, 0, 0]}]\n",
        cases[k].words);
    const Selection *selection = &model->loading.loads[0].selection;
    assert_int_equal(selection->count, cases[k].count);
    for (int64_t n = 1; n < selection->count; ++n) /* each once, by its number */
      assert_true(model->domain.particles->number[selection->places[n - 1]] <
                  model->domain.particles->number[selection->places[n]]);
    breccia_model_destroy(&model);
  }
}

/** What a group leaves empty is said once, whatever else the selection asks for. */
static void an_empty_group_is_said_once(void **state)
{
  (void)state;
  static const char *const more[] = {
      "", ", face: x+", ", nearest: [0, 0, 0]", ", any of: far", ", all of: far", ", except: end"};
  for (size_t k = 0; k < sizeof more / sizeof *more; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck,
             MATERIAL SOLVE "body: {a: {material: m, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}, b: {material: "
                            "m, spacing: 1, shape: {box: {from: [4, 0, 0], to: [8, 4, 4]}}}}\n"
                            "selections: {end: {block: a, face: x-}, far: {block: b, face: x+}}\n"
                            "loads: [{on: {block: b, group: end%s}, body force: [1, 0, 0]}]\n",
             more[k]);
    char *words = refusal_of(deck);
    assert_non_null(
        strstr(words, "the selection holds no particle; 'group' leaves none of the 64 that its other keys"));
    assert_null(strchr(words, '\n'));
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_have_the_volumes_of_geometry),
      cmocka_unit_test(shapes_hold_points_up_to_their_faces),
      cmocka_unit_test(layers_of_faces_are_counted_alike_on_all_sides),
      cmocka_unit_test(layers_of_a_face_are_those_of_each_block),
      cmocka_unit_test(particles_on_the_face_of_a_hole_stay),
      cmocka_unit_test(numbers_run_along_x_then_y_then_z),
      cmocka_unit_test(families_on_lattices_have_the_counts_of_geometry),
      cmocka_unit_test(families_are_those_of_all_pairs_on_a_body_with_hole_cut_and_two_lattices),
      cmocka_unit_test(bonds_come_in_pairs_with_opposite_vectors_and_break_on_both_sides),
      cmocka_unit_test(weighted_volume_of_whole_cells_matches_peridigm),
      cmocka_unit_test(weights_of_bonds_are_influence_times_volume),
      cmocka_unit_test(parts_of_volumes_at_the_horizon_go_by_both_spacings),
      cmocka_unit_test(particles_on_top_of_each_other_are_refused),
      cmocka_unit_test(blocks_of_unlike_thickness_or_area_are_refused),
      cmocka_unit_test(spacings_that_differ_by_thousands_are_refused_at_once),
      cmocka_unit_test(selections_hold_what_they_say),
      cmocka_unit_test(selections_join_others_have_them_in_common_and_leave_them_out),
      cmocka_unit_test(round_bodies_lie_in_the_middle_of_their_lattice),
      cmocka_unit_test(an_empty_group_is_said_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

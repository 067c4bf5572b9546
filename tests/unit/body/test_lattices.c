#include "base/random.h"
#include "base/tensor.h"
#include "support.h"

/* Lattices whose vectors are not along the axes, told by numbers that follow from geometry alone. */
#define MATERIAL "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
#define BONDS "materials: {m: {model: elastic-1d, density: 1, Young modulus: 150}}\n"
#define SOLVE "solve: {explicit: {steps: 1}}\n"
#define HEXAGONAL "lattice: hexagonal, thickness: 0.5"
#define FCC "lattice: face-centred cubic"

static const double pi = 3.14159265358979323846;

static double volume_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  double volume = 0;
  for (int64_t i = 0; i < p->places; ++i) volume += p->volume[i];
  return volume;
}

static int32_t middle_of(const breccia_model *model)
{
  double low[3], high[3], middle[3];
  particles_bounds(model->domain.particles, low, high);
  for (int k = 0; k < 3; ++k) middle[k] = (low[k] + high[k]) / 2;
  return particles_nearest(model->domain.particles, middle);
}

static void rows_are_shifted_by_whole_or_half_cells(void **state)
{
  (void)state;
  /* Sums along rows (family/lattice_rows) need it, and vectors with nothing above the diagonal, the first one spacing long. */
  for (int k = 0; lattice_word(k); ++k) {
    const LatticeType *type = lattice_find(lattice_word(k));
    assert_near(type->vector[0][0], 1, 0);
    for (int n = 0; n < 3; ++n)
      for (int i = 0; i < 3; ++i) {
        if (i > n) assert_near(type->vector[n][i], 0, 0);
        double halves = 2 * type->vector[n][i] / type->vector[i][i];
        if (i < n) assert_near(halves, round(halves), 1e-12);
      }
  }
}

static void families_have_the_shells_of_their_lattice(void **state)
{
  (void)state;
  /* Distances and numbers of neighbours: of a hexagonal lattice i^2 + i j + j^2, of a face-centred cubic one the points with
   * integer coordinates of even sum, at root 2 from each other. */
  const struct {
    double square;
    int plane, space;
  } shells[] = {{1, 6, 12},  {2, 6, 18},   {3, 12, 42},  {4, 18, 54},  {5, 18, 78},
                {6, 18, 86}, {7, 30, 134}, {8, 30, 140}, {9, 36, 176}, {13, 54, 0}};
  for (size_t k = 0; k < sizeof shells / sizeof *shells; ++k)
    for (int space = 0; space < 2; ++space) {
      if ((space && !shells[k].space) || (under_sanitizers() && k % 4)) continue;
      breccia_model *model =
          model_of(BONDS SOLVE "peridynamics: {formulation: bond-based, horizon: %.15g spacings, space: %s}\n"
                               "body: {b: {material: m, %s, spacing: 0.1, shape: {box: {particles: [13, 14, %d]}}}}\n",
                   sqrt(shells[k].square), space ? "3-D" : "plane strain", space ? FCC : HEXAGONAL, space ? 12 : 1);
      assert_int_equal(family_count(&model->domain.family, middle_of(model)),
                       space ? shells[k].space : shells[k].plane);
      breccia_model_destroy(&model);
    }
}

static void families_are_those_of_all_pairs(void **state)
{
  (void)state;
  /* Holes, cuts, notches, rows along x and y, beside lattices of other kinds and spacings. */
  const char *const bodies[] = {
      "cracks: [{cut: {line: [[5.3, -1], [5.3, 4.4]]}}, {remove: {box: {from: [8.5, 3.5], to: [9.5, 20]}}, cut faces: "
      "yes}]\n"
      "body:\n"
      "  a: {material: m, " HEXAGONAL ", spacing: 1, shape: {difference: [{box: {from: [0, 0], to: [21, 10.4]}}, "
      "{sphere: {centre: [14, 5], radius: 1.9}}]}}\n"
      "  b: {material: m, lattice: square, thickness: 0.5, spacing: 0.8, shape: {box: {from: [0, 10.8], to: [8, "
      "14]}}}\n"
      "peridynamics: {horizon: 2.7, space: plane stress}\n",
      "body: {a: {material: m, " HEXAGONAL ", spacing: 1, shape: {polygon: {corners: [[0, 0], [17, 2], [9, 13]]}}}}\n"
      "peridynamics: {horizon: 3.015 spacings, space: plane strain, volume correction: partial}\n",
      "cracks: [{cut: {polygon: [[2.7, -9, -9], [2.7, 6.3, -9], [2.7, 6.3, 9], [2.7, -9, 9]]}}]\n"
      "body:\n"
      "  a: {material: m, " FCC ", spacing: 1, shape: {difference: [{box: {from: [0, 0, 0], to: [17, 9, 5]}}, {sphere: "
      "{centre: [12, 4, 2], radius: 1.9}}]}}\n"
      "  b: {material: m, spacing: 0.8, shape: {box: {from: [0, 0, 5.4], to: [8, 4, 7.8]}}}\n"
      "peridynamics: {horizon: 2.5}\n",
      "body: {a: {material: m, " FCC
      ", spacing: 1, shape: {union: [{box: {particles: [5, 19, 5]}}, {box: {from: [0, 0, 0], "
      "to: [9, 7, 5]}}]}}}\n"
      "peridynamics: {horizon: 3.015 spacings}\n"};
  for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k += under_sanitizers() ? 2 : 1) {
    breccia_model *model = model_of(MATERIAL SOLVE "%s", bodies[k]);
    assert_families_are_all_pairs(model);
    breccia_model_destroy(&model);
  }
}

static void rows_run_along_the_longest_axis_that_the_lattice_allows(void **state)
{
  (void)state;
  const struct {
    const char *lattice, *space, *size;
    int axis;
  } cases[] = {{FCC, "3-D", "[5, 19, 7]", 1}, {FCC, "3-D", "[5, 6, 30]", 1}, {HEXAGONAL, "plane strain", "[5, 19]", 0}};
  for (int k = 0; k < 3; ++k) {
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {space: %s}\n"
                                "body: {b: {material: m, %s, spacing: 1, shape: {box: {particles: %s}}}}\n",
                 cases[k].space, cases[k].lattice, cases[k].size);
    assert_int_equal(model->domain.body.lattices[0].axis, cases[k].axis);
    breccia_model_destroy(&model);
  }
}

static void particles_share_the_volume_of_their_shape(void **state)
{
  (void)state;
  /* A box exactly, whether whole rows fill it or not (100 / 4.33 are 23.09 rows); what is round about. */
  const struct {
    const char *lattice, *space, *shape;
    double volume, tolerance;
  } cases[] = {{HEXAGONAL, "plane strain", "{box: {particles: [20, 11]}}", 20 * 11 * 5 * 5 * sqrt(0.75) * 0.5, 1e-12},
               {HEXAGONAL, "plane strain", "{box: {from: [0, 0], to: [500, 100]}}", 500 * 100 * 0.5, 1e-12},
               {HEXAGONAL, "plane strain", "{box: {from: [-3, 7], to: [197, 167]}}", 200 * 160 * 0.5, 1e-12},
               {HEXAGONAL, "plane strain", "{sphere: {centre: [3, 4], radius: 120}}", pi * 120 * 120 * 0.5, 0.01},
               {FCC, "3-D", "{box: {particles: [9, 8, 11]}}", 9 * 8 * 11 * 125 * sqrt(0.5), 1e-12},
               {FCC, "3-D", "{box: {from: [0, 0, 0], to: [50, 40, 60]}}", 50 * 40 * 60, 1e-12},
               {FCC, "3-D", "{sphere: {centre: [1, 2, 3], radius: 60}}", 4 * pi / 3 * 60 * 60 * 60, 0.01}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model = model_of(MATERIAL SOLVE "peridynamics: {space: %s, horizon: 2.1 spacings}\n"
                                                   "body: {b: {material: m, %s, spacing: 5, shape: %s}}\n",
                                    cases[k].space, cases[k].lattice, cases[k].shape);
    assert_near(volume_of(model), cases[k].volume, cases[k].tolerance * cases[k].volume);
    breccia_model_destroy(&model);
  }
}

static void a_box_is_filled_alike_from_both_sides(void **state)
{
  (void)state;
  /* The middle of all particles is the middle of the box, and so it is where whole rows do not fill it. */
  const char *const bodies[] = {HEXAGONAL ", shape: {box: {from: [0, 0, 0], to: [30, 10, 0]}}",
                                FCC ", shape: {box: {from: [0, 0, 0], to: [30, 10, 12]}}"};
  const double middle[2][3] = {{15, 5, 0}, {15, 5, 6}};
  for (int b = 0; b < 2; ++b) {
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {space: %s}\nbody: {b: {material: m, spacing: 1, %s}}\n",
                 b ? "3-D" : "plane strain", bodies[b]);
    double low[3], high[3];
    particles_bounds(model->domain.particles, low, high);
    for (int k = 0; k < 3; ++k) assert_near((low[k] + high[k]) / 2, middle[b][k], 1e-12);
    assert_near(low[0], 0.25, 1e-12); /* rows begin a quarter and three quarters of a spacing from the face in turn */
    breccia_model_destroy(&model);
  }
}

static void a_box_that_would_become_another_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *box, *words;
  } cases[] = {{"{from: [0, 0], to: [5.3, 10]}", "is not a whole number of spacings of 1"},
               {"{from: [0, 0], to: [5, 3]}",
                "its size along y, 3, is 3.464 rows of a hexagonal lattice, which stand 0.866025 apart; 2.59808 or "
                "3.4641 holds whole rows"},
               {"{from: [0, 0], to: [5, 0.5]}", "is less than one spacing of 0.866025"}};
  for (int k = 0; k < 3; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck,
             MATERIAL SOLVE "peridynamics: {space: plane strain}\n"
                            "body: {b: {material: m, " HEXAGONAL ", spacing: 1, shape: {box: %s}}}\n",
             cases[k].box);
    char *words = refusal_of(deck);
    if (!strstr(words, cases[k].words)) fail_msg("%s", words);
    free(words);
  }
}

static void layers_of_a_face_are_whole_cells(void **state)
{
  (void)state;
  /* Across the rows both of the shifted kinds belong to a layer. */
  const struct {
    const char *lattice, *space, *box, *face;
    int64_t count;
  } cases[] = {{HEXAGONAL, "plane strain", "[20, 10]", "face: x+, layers: 1", 10},
               {HEXAGONAL, "plane strain", "[20, 10]", "face: x-, layers: 3", 30},
               {HEXAGONAL, "plane strain", "[20, 10]", "face: y+, layers: 2", 40},
               {FCC, "3-D", "[7, 8, 6]", "face: z-, layers: 1", 56},
               {FCC, "3-D", "[7, 8, 6]", "face: x+, layers: 2", 2 * 8 * 6},
               {FCC, "3-D", "[7, 8, 6]", "face: y-, layers: 1", 7 * 6}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {space: %s}\n"
                                "body: {b: {material: m, %s, spacing: 0.3, shape: {box: {particles: %s}}}}\n"
                                "loads: [{on: {%s}, velocity: [0, 0, 0]}]\n",
                 cases[k].space, cases[k].lattice, cases[k].box, cases[k].face);
    assert_int_equal(model->loading.loads[0].selection.count, cases[k].count);
    breccia_model_destroy(&model);
  }
}

static void cells_of_the_plane_tile_it(void **state)
{
  (void)state;
  /* The part nearest to a particle has the area of its brick, and each corner is equally far from two neighbours at least. */
  for (int k = 0; lattice_word(k); ++k) {
    const LatticeType *type = lattice_find(lattice_word(k));
    double corners[6][2], area = 0;
    const int count = lattice_cell_corners(type, corners);
    for (int n = 0; n < count; ++n) {
      const double *a = corners[n], *b = corners[(n + 1) % count];
      area += (a[0] * b[1] - a[1] * b[0]) / 2;
      int near = 0;
      for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j) {
          const double x = i * type->vector[0][0] + j * type->vector[1][0], y = j * type->vector[1][1];
          assert_true(hypot(a[0] - x, a[1] - y) > hypot(a[0], a[1]) - 1e-9);
          near += fabs(hypot(a[0] - x, a[1] - y) - hypot(a[0], a[1])) < 1e-9;
        }
      assert_true(near >= 3);
    }
    assert_int_equal(count, type->vector[1][0] != 0 ? 6 : 4);
    assert_near(area, type->vector[0][0] * type->vector[1][1], 1e-12);
  }
  assert_near(lattice_period(lattice_find("hexagonal"), 1), sqrt(3), 1e-12);
}

/* ---- elasticity ---- */

static breccia_model *bonded(const char *lattice, const char *space, const char *more)
{
  const bool flat = strcmp(space, "3-D");
  return model_of(BONDS SOLVE "peridynamics: {formulation: bond-based, space: %s, %s}\n"
                              "body: {b: {material: m, %s, spacing: 1, shape: {box: {particles: [11, 11, %d]}}}}\n",
                  space, more, lattice, flat ? 1 : 11);
}

/** Stress of the middle particle over s for a stretch s along a direction, everything else held. */
static void stress_of_stretch(breccia_model *model, const double n[3], double stress[6])
{
  const double s = 1e-8;
  double f[9], strain[6];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) f[3 * i + j] = (i == j) + s * n[i] * n[j];
  const Particles *p = model->domain.particles;
  for (int k = 0; k < 3; ++k) memset(p->displacement.row[k], 0, sizeof(double) * (size_t)p->places);
  deform_uniformly(model, f);
  domain_look(&model->domain, middle_of(model), strain, stress);
  for (int k = 0; k < 6; ++k) stress[k] /= s;
}

static double along(const double stress[6], const double n[3])
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += stress[k] * n[symmetric_row[k]] * n[symmetric_column[k]] * (k < 3 ? 1 : 2);
  return sum;
}

static void hexagonal_bonds_are_isotropic_in_the_plane(void **state)
{
  (void)state;
  /* Symmetry of order six leaves a tensor of rank four no direction. The modulus of a held stretch is 9/8 E in plane stress at nu = 1/3, 6/5 E in
   * plane strain at nu = 1/4. A square lattice differs by 4 % at this horizon. */
  const char *const horizons[] = {"horizon: 1.2 spacings", "horizon: 2.015 spacings",
                                  "horizon: 3.015 spacings, influence: conical",
                                  "horizon: 3.015 spacings, volume correction: partial"};
  const double want[2] = {150 * 9. / 8, 150 * 6. / 5};
  for (int h = 0; h < 4; ++h)
    for (int s = 0; s < 2; ++s) {
      breccia_model *model = bonded(HEXAGONAL, s ? "plane strain" : "plane stress", horizons[h]);
      for (double angle = 0; angle < pi; angle += 0.1) {
        double n[3] = {cos(angle), sin(angle), 0}, across[3] = {-sin(angle), cos(angle), 0}, stress[6];
        stress_of_stretch(model, n, stress);
        assert_near(along(stress, n), want[s], 2e-6 * want[s]);
        assert_near(along(stress, across), want[s] / 3, 2e-6 * want[s]);
      }
      breccia_model_destroy(&model);
    }
  breccia_model *square = bonded("lattice: square, thickness: 0.5", "plane stress", "horizon: 3.015 spacings");
  double stress[6];
  stress_of_stretch(square, (double[3]){1, 0, 0}, stress);
  assert_true(fabs(along(stress, (double[3]){1, 0, 0}) / want[0] - 1) > 0.01);
  breccia_model_destroy(&square);
}

static void face_centred_bonds_have_cubic_symmetry_and_differ_less_than_cubic_ones(void **state)
{
  (void)state;
  /* The cubes' edges run along z and the diagonals of x-y. Largest over smallest modulus of a held stretch, all directions: */
  double spread[2];
  for (int l = 0; l < 2; ++l) {
    breccia_model *model = bonded(l ? "lattice: cubic" : FCC, "3-D", "horizon: 3.015 spacings");
    double stress[6], low = INFINITY, high = 0;
    uint64_t seed = 3;
    for (int k = 0; k < (under_sanitizers() ? 20 : 200); ++k) {
      double n[3], size = 0;
      for (int i = 0; i < 3; ++i) {
        n[i] = random_uniform(&seed) - 0.5;
        size += n[i] * n[i];
      }
      for (int i = 0; i < 3; ++i) n[i] /= sqrt(size);
      stress_of_stretch(model, n, stress);
      low = fmin(low, along(stress, n));
      high = larger_of(high, along(stress, n));
    }
    spread[l] = high / low;
    if (!l) {
      const double edges[3][3] = {{0, 0, 1}, {sqrt(0.5), sqrt(0.5), 0}, {sqrt(0.5), -sqrt(0.5), 0}};
      double modulus[3];
      for (int e = 0; e < 3; ++e) {
        stress_of_stretch(model, edges[e], stress);
        modulus[e] = along(stress, edges[e]);
      }
      assert_near(modulus[1], modulus[0], 2e-6 * modulus[0]);
      assert_near(modulus[2], modulus[0], 2e-6 * modulus[0]);
    }
    breccia_model_destroy(&model);
  }
  if (!under_sanitizers()) assert_true(spread[0] - 1 < 0.6 * (spread[1] - 1));
}

static void calibration_makes_its_field_exact(void **state)
{
  (void)state;
  /* Uniform expansion: the energy of the continuum, stress sum 6 E s in space, 3 E s in plane stress; uniaxial: E along x when the sides are free. */
  for (int l = 0; l < 2; ++l) {
    breccia_model *model = bonded(l ? FCC : HEXAGONAL, l ? "3-D" : "plane stress", "calibration: uniform-expansion");
    double sum = 0, stress[6];
    for (int k = 0; k < (l ? 3 : 2); ++k) {
      double n[3] = {k == 0, k == 1, k == 2};
      stress_of_stretch(model, n, stress);
      sum += stress[XX] + stress[YY] + (l ? stress[ZZ] : 0);
    }
    assert_near(sum / 150, l ? 6 : 3, 1e-6);
    breccia_model_destroy(&model);
    model = bonded(l ? FCC : HEXAGONAL, l ? "3-D" : "plane stress", "calibration: uniaxial");
    assert_non_null(strstr(breccia_model_overview(model), "shows 1.000 of the wanted modulus along x"));
    breccia_model_destroy(&model);
  }
}

/** What `check` tells of lattices whose axes are not alike: the modulus along each, between the least and largest of all directions, which a horizon of one
 *  shell of neighbours tells apart in space and six neighbours in the plane do not. */
static void check_tells_moduli_in_all_directions(void **state)
{
  (void)state;
  for (int l = 0; l < 2; ++l) {
    breccia_model *model = bonded(l ? FCC : HEXAGONAL, l ? "3-D" : "plane stress", "horizon: 1.1 spacings");
    const char *line = strstr(breccia_model_overview(model), "a uniaxial patch shows ");
    double along[3] = {0}, least = NAN, largest = NAN;
    assert_non_null(line);
    const int read =
        l ? sscanf(line,
                   "a uniaxial patch shows %lf of the wanted modulus along x, %lf along y, %lf along z; %lf to %lf in "
                   "all directions",
                   &along[0], &along[1], &along[2], &least, &largest)
          : sscanf(
                line,
                "a uniaxial patch shows %lf of the wanted modulus along x, %lf along y; %lf to %lf in all directions",
                &along[0], &along[1], &least, &largest);
    assert_int_equal(read, 4 + l);
    /* Twelve neighbours (1, 1, 0) in cubic symmetry: c11 = 2 c12 = 2 c44, so that E along an edge of the cube, a diagonal of a face (a row) and one of space
     * are 4/3, 2 and 12/5 c44; with the wanted energy of expansion the second is E. */
    for (int k = 0; k < 2 + l; ++k) assert_true(along[k] >= least - 1e-9 && along[k] <= largest + 1e-9);
    assert_near(least, l ? 2. / 3 : along[1], 2e-3);
    assert_near(largest, l ? 1.2 : along[0], 2e-3);
    assert_near(along[0], l ? 1 : along[1], 2e-3);
    breccia_model_destroy(&model);
  }
}

static void waves_run_as_the_sum_over_the_lattice_says(void **state)
{
  (void)state;
  /* A standing wave u = a cos k.x about a particle pulls it by a sum V c / L (1 - cos k.xi) (n.a) n over vectors xi counted here
   * from the definition of the lattice: that is density times squared frequency, direction by direction. */
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = bonded(space ? FCC : HEXAGONAL, space ? "3-D" : "plane stress", "calibration: continuum");
    const Particles *p = model->domain.particles;
    const int32_t centre = middle_of(model);
    const double c = space ? 12 * 150 / (pi * pow(3.015, 4)) : 9 * 150 / (pi * 0.5 * pow(3.015, 3)),
                 volume = space ? sqrt(0.5) : sqrt(0.75) * 0.5, amplitude = 1e-9;
    uint64_t seed = 9;
    for (int wave = 0; wave < 12; ++wave) {
      double k[3] = {0}, a[3] = {0}, want[3] = {0}, size = 0;
      for (int i = 0; i < (space ? 3 : 2); ++i) {
        k[i] = 4 * (random_uniform(&seed) - 0.5);
        a[i] = random_uniform(&seed) - 0.5;
      }
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        double phase = 0;
        for (int m = 0; m < 3; ++m) phase += k[m] * (p->position[m][i] - p->position[m][centre]);
        for (int m = 0; m < 3; ++m) p->displacement.row[m][i] = amplitude * a[m] * cos(phase);
      }
      compute_forces(model);
      for (int i = -9; i <= 9; ++i)
        for (int j = -9; j <= 9; ++j)
          for (int l = space ? -9 : 0; l <= (space ? 9 : 0); ++l) {
            const double xi[3] = {space ? i + 0.5 * l : i + 0.5 * j, space ? j + 0.5 * l : sqrt(0.75) * j,
                                  space ? sqrt(0.5) * l : 0};
            const double length = sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
            if (length == 0 || length > 3.015) continue;
            const double turn = k[0] * xi[0] + k[1] * xi[1] + k[2] * xi[2],
                         pull = (xi[0] * a[0] + xi[1] * a[1] + xi[2] * a[2]) / length;
            for (int m = 0; m < 3; ++m)
              want[m] -= amplitude * c * volume / length * (1 - cos(turn)) * pull * xi[m] / length;
          }
      for (int m = 0; m < 3; ++m) size = larger_of(size, fabs(want[m]));
      for (int m = 0; m < 3; ++m) assert_near(p->internal.row[m][centre], want[m], 1e-6 * size);
    }
    breccia_model_destroy(&model);
  }
}

static void uniform_strain_leaves_the_inside_without_force_in_all_formulations(void **state)
{
  (void)state;
  const struct {
    const char *formulation, *space, *lattice;
  } cases[] = {{"bond-based", "plane stress", HEXAGONAL},
               {"bond-based", "plane strain", HEXAGONAL},
               {"correspondence", "plane stress", HEXAGONAL},
               {"correspondence", "plane strain", HEXAGONAL},
               {"bond-based", "3-D", FCC},
               {"correspondence", "3-D", FCC}};
  const double f[9] = {1.002, 0.001, 0, -0.003, 0.999, 0, 0, 0, 1};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *model =
        model_of("%s" SOLVE "peridynamics: {formulation: %s, space: %s}\n"
                 "body: {b: {material: m, %s, spacing: 1, shape: {box: {particles: [20, 21, %d]}}}}\n",
                 strcmp(cases[c].formulation, "bond-based") ? MATERIAL : BONDS, cases[c].formulation, cases[c].space,
                 cases[c].lattice, strcmp(cases[c].space, "3-D") ? 1 : 22);
    deform_uniformly(model, f);
    compute_forces(model);
    const Domain *d = &model->domain;
    const Particles *p = d->particles;
    double low[3], high[3];
    particles_bounds(p, low, high);
    int inside = 0;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      double gradient[9];
      bool deep = true;
      for (int k = 0; k < d->body.dimensions; ++k)
        deep &= fmin(p->position[k][i] - low[k], high[k] - p->position[k][i]) > 6.1;
      if (d->regions[0].type->gradient) {
        d->regions[0].type->gradient(d->regions[0].formulation, i, gradient);
        for (int k = 0; k < 9; ++k)
          if (k < 8 || d->body.dimensions == 3) assert_near(gradient[k], f[k], 1e-12); /* at surfaces too */
      }
      for (int k = 0; deep && k < 3; ++k) assert_near(p->internal.row[k][i], 0, 1e-12);
      inside += deep;
    }
    assert_true(inside > 4);
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_shifted_by_whole_or_half_cells),
      cmocka_unit_test(families_have_the_shells_of_their_lattice),
      cmocka_unit_test(families_are_those_of_all_pairs),
      cmocka_unit_test(rows_run_along_the_longest_axis_that_the_lattice_allows),
      cmocka_unit_test(particles_share_the_volume_of_their_shape),
      cmocka_unit_test(a_box_is_filled_alike_from_both_sides),
      cmocka_unit_test(a_box_that_would_become_another_is_refused),
      cmocka_unit_test(layers_of_a_face_are_whole_cells),
      cmocka_unit_test(cells_of_the_plane_tile_it),
      cmocka_unit_test(hexagonal_bonds_are_isotropic_in_the_plane),
      cmocka_unit_test(face_centred_bonds_have_cubic_symmetry_and_differ_less_than_cubic_ones),
      cmocka_unit_test(calibration_makes_its_field_exact),
      cmocka_unit_test(check_tells_moduli_in_all_directions),
      cmocka_unit_test(waves_run_as_the_sum_over_the_lattice_says),
      cmocka_unit_test(uniform_strain_leaves_the_inside_without_force_in_all_formulations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "base/csv.h"
#include "base/random.h"
#include "support.h"
#include <glob.h>

/* ---- golden paths ---- */

typedef struct Path {
  int rows;
  double *strain, *stress; /* [rows][6] */
} Path;

static double *columns_of(const char *file, const char *const *names, int count, int *rows)
{
  double *table = NULL;
  Error *error = breccia_error_create();
  for (int k = 0; k < count; ++k) {
    char label[128];
    double *column = csv_column(file, names[k], CSV_FINISHED, rows, label, error);
    if (!column) fail_msg("%s", breccia_error_text(error));
    if (!table) table = malloc(sizeof(double) * (size_t)(count * *rows));
    for (int i = 0; i < *rows; ++i) table[count * i + k] = column[i];
    free(column);
  }
  breccia_error_destroy(&error);
  return table;
}

static Path read_path(const char *file)
{
  static const char *const strains[] = {"e11", "e22", "e33", "g12", "g23", "g31"};
  static const char *const stresses[] = {"s11", "s22", "s33", "s12", "s23", "s31"};
  Path path = {0};
  path.strain = columns_of(file, strains, 6, &path.rows);
  path.stress = columns_of(file, stresses, 6, &path.rows);
  return path;
}

typedef struct Drive { /* one point, its twin histories, and rows of a tangent file to compare */
  const Material *m;
  double *committed, *trial;
} Drive;

static Drive start(const Material *m)
{
  Drive d = {m, calloc((size_t)m->history_values + 1, sizeof(double)),
             calloc((size_t)m->history_values + 1, sizeof(double))};
  if (m->law->begin) {
    m->law->begin(m->constants, d.committed);
    m->law->begin(m->constants, d.trial);
  }
  return d;
}
static void stop(Drive *d)
{
  free(d->committed);
  free(d->trial);
}
static void try_strain(Drive *d, const double *strain, double *stress, double *tangent, int elastic)
{
  breccia_batch batch = {
      .count = 1, .committed = d->committed, .trial = d->trial, .tangent = tangent, .elastic_stage = elastic};
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = strain + k;
    batch.stress[k] = stress + k;
  }
  assert_int_equal(d->m->law->update(d->m->constants, &batch), -1);
}
static void commit(Drive *d)
{
  double *other = d->committed;
  d->committed = d->trial;
  d->trial = other;
}

static void follow(Drive *d, const char *file, const double *tangents, int tangent_rows, int first_row,
                   int elastic_rows)
{
  Path path = read_path(file);
  double largest = 0, worst = 0, worst_tangent = 0, largest_tangent = 0;
  for (int i = 0; i < 6 * path.rows; ++i) largest = fmax(largest, fabs(path.stress[i]));
  for (int i = 0; i < path.rows; ++i) {
    double stress[6], tangent[36];
    try_strain(d, path.strain + 6 * i, stress, tangent, first_row + i < elastic_rows);
    for (int k = 0; k < 6; ++k) worst = fmax(worst, fabs(stress[k] - path.stress[6 * i + k]));
    for (int t = 0; t < tangent_rows; ++t)
      if ((int)tangents[37 * t] == first_row + i + 1)
        for (int k = 0; k < 36; ++k) {
          largest_tangent = fmax(largest_tangent, fabs(tangents[37 * t + 1 + k]));
          worst_tangent = fmax(worst_tangent, fabs(tangent[k] - tangents[37 * t + 1 + k]));
        }
    commit(d);
  }
  if (worst > 1e-8 * largest) fail_msg("%s: stress off by %.3g of %.3g", file, worst, largest);
  if (worst_tangent > 1e-8 * largest_tangent)
    fail_msg("%s: tangent off by %.3g of %.3g", file, worst_tangent, largest_tangent);
  free(path.strain);
  free(path.stress);
}

/** The set (P1, P2, P3, A) is the last part of a file's name. */
static Material material_for(const char *file)
{
  if (strstr(file, "ElasticIsotropic3D"))
    return material_of("elastic", "Young modulus=150000", "Poisson ratio=0.25", NULL);
  if (strstr(file, "_P1"))
    return material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "cohesion=31.8198051534", NULL);
  if (strstr(file, "_P2"))
    return material_of("multi-yield-j2", "shear modulus=25000", "bulk modulus=120000", "cohesion=18",
                       "peak octahedral strain=0.05", "surfaces=11", NULL);
  return material_of("multi-yield-j2", "shear modulus=40000", "bulk modulus=90000", "cohesion=10", "friction angle=25",
                     "reference pressure=80", "pressure exponent=0.5", NULL);
}

static int follow_all(const char *folder)
{
  char pattern[512];
  snprintf(pattern, sizeof pattern, "%s/%s/*.csv", GOLDEN, folder);
  glob_t found;
  assert_int_equal(glob(pattern, 0, NULL, &found), 0);
  int paths = 0;
  for (size_t k = 0; k < found.gl_pathc; ++k) {
    const char *file = found.gl_pathv[k];
    if (strstr(file, "_tangent") || strstr(file, "surfaces_") || strstr(file, "_p2.csv")) continue;
    Material m = material_for(file);
    Drive d = start(&m);
    char tangent_file[512];
    snprintf(tangent_file, sizeof tangent_file, "%.*s_tangent.csv",
             (int)(strlen(file) - (strstr(file, "_p1.csv") ? strlen("_p1.csv") : strlen(".csv"))), file);
    const char *names[37] = {"step"};
    char words[36][8];
    for (int c = 0; c < 36; ++c) {
      snprintf(words[c], sizeof words[c], "C%d%d", c / 6 + 1, c % 6 + 1);
      names[c + 1] = words[c];
    }
    int tangent_rows;
    double *tangents = columns_of(tangent_file, names, 37, &tangent_rows);
    assert_true(tangent_rows > 0);
    int elastic = strstr(file, "stage0_then_1") ? 20 : 0;
    follow(&d, file, tangents, tangent_rows, 0, elastic);
    if (strstr(file, "_p1.csv")) {
      char second[512];
      snprintf(second, sizeof second, "%.*s_p2.csv", (int)(strlen(file) - strlen("_p1.csv")), file);
      follow(&d, second, tangents, tangent_rows, 1200, 0);
    }
    free(tangents);
    stop(&d);
    material_destroy(&m);
    ++paths;
  }
  globfree(&found);
  return paths;
}

static void elastic_follows_the_golden_paths_of_opensees(void **state)
{
  (void)state;
  assert_int_equal(follow_all("ElasticIsotropic3D"), 2);
}

static void multi_yield_follows_the_golden_paths_of_opensees(void **state)
{
  (void)state;
  assert_int_equal(follow_all("PressureIndependMultiYield"), 15 - 0 - 2);
}

/* ---- closed forms ---- */

static void corners_of_the_backbone_lie_on_the_hyperbola(void **state)
{
  (void)state;
  /* docs/theory.md 8.2 and validation P1: corners at (gamma(tau_m) - 1.309e-6, tau_m). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  const double reference = 0.1 * 30 / (60000 * 0.1 - 30);
  assert_near(reference, 5.0251e-4, 1e-8);
  double shift = 1.5 * reference / (60000 * reference - 1.5) - 1.5 / 60000;
  assert_near(shift, 1.309e-6, 1e-9);
  Drive d = start(&m);
  for (int corner = 1; corner < 20; ++corner) {
    double tau = 30.0 * corner / 20, gamma = tau * reference / (60000 * reference - tau) - shift;
    double from =
        corner == 1 ? 0 : 30.0 * (corner - 1) / 20 * reference / (60000 * reference - 30.0 * (corner - 1) / 20) - shift;
    for (int k = 1; k <= 200; ++k) { /* in simple shear gamma_oct = sqrt(2/3) gamma, tau_oct = sqrt(2/3) tau */
      double strain[6] = {0, 0, 0, sqrt(1.5) * (from + (gamma - from) * k / 200)}, stress[6];
      try_strain(&d, strain, stress, NULL, 0);
      commit(&d);
      if (k == 200) assert_near(sqrt(2.0 / 3) * stress[3], tau, 1e-6 * 30);
    }
  }
  stop(&d);
  material_destroy(&m);
}

static void uniaxial_strength_is_three_tau_over_root_two(void **state)
{
  (void)state;
  /* Uniaxial stress by iterating the lateral strain (validation P4: 63.640 kPa). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Drive d = start(&m);
  double lateral = 0, stress[6];
  for (int k = 1; k <= 3000; ++k) {
    double axial = 0.3 * k / 3000;
    for (int i = 0; i < 60; ++i) {
      double strain[6] = {axial, lateral, lateral}, tangent[36];
      try_strain(&d, strain, stress, tangent, 0);
      if (fabs(stress[1]) < 1e-9) break;
      lateral -= stress[1] / (100000 + 20000);
    }
    commit(&d);
  }
  assert_near(stress[0], 3 * 30 / sqrt(2), 1e-6 * 63.64);
  stop(&d);
  material_destroy(&m);
}

static void unloading_doubles_the_backbone(void **state)
{
  (void)state;
  /* Masing: after a reversal at (g, t) the stress at g - 2 x lies at t - 2 tau(x). */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  enum { STEPS = 4000 };
  static double loading[STEPS + 1];
  double top = 0.004, stress[6];
  Drive d = start(&m);
  for (int k = 1; k <= STEPS; ++k) {
    double strain[6] = {0, 0, 0, top * k / STEPS};
    try_strain(&d, strain, stress, NULL, 0);
    commit(&d);
    loading[k] = stress[3];
  }
  for (int k = 1; k <= STEPS; ++k) {
    double strain[6] = {0, 0, 0, top - 2 * top * k / STEPS};
    try_strain(&d, strain, stress, NULL, 0);
    commit(&d);
    if (k % 500 == 0) assert_near(loading[STEPS] - stress[3], 2 * loading[k], 0.02 * loading[STEPS]);
  }
  stop(&d);
  material_destroy(&m);
}

static void a_trial_can_be_repeated_and_leaves_the_committed_state_alone(void **state)
{
  (void)state;
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Drive tried = start(&m), plain = start(&m);
  uint64_t seed = 7;
  double strain[6] = {0}, a[6], b[6];
  size_t bytes = sizeof(double) * (size_t)m.history_values;
  double *before = malloc(bytes);
  for (int step = 0; step < 400; ++step) {
    for (int k = 0; k < 6; ++k) strain[k] = 0.9 * strain[k] + 2e-3 * (random_uniform(&seed) - 0.5);
    memcpy(before, tried.committed, bytes);
    for (int wild = 0; wild < 3; ++wild) {
      double other[6];
      for (int k = 0; k < 6; ++k) other[k] = strain[k] + 1e-2 * (random_uniform(&seed) - 0.5);
      try_strain(&tried, other, a, NULL, wild == 1);
    }
    assert_memory_equal(before, tried.committed, bytes);
    try_strain(&tried, strain, a, NULL, 0);
    try_strain(&plain, strain, b, NULL, 0);
    assert_memory_equal(a, b, sizeof a);
    commit(&tried);
    commit(&plain);
  }
  free(before);
  stop(&tried);
  stop(&plain);
  material_destroy(&m);
}

static void stress_turns_with_the_strain(void **state)
{
  (void)state;
  /* Objectivity: the axes x, y, z renamed to y, z, x give the same stress renamed. */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Drive a = start(&m), b = start(&m);
  const int renamed[6] = {1, 2, 0, 4, 5, 3};
  uint64_t seed = 3;
  double e[6] = {0}, f[6], s[6], t[6];
  for (int step = 0; step < 500; ++step) {
    for (int k = 0; k < 6; ++k) e[k] = 0.95 * e[k] + 1e-3 * (random_uniform(&seed) - 0.5);
    for (int k = 0; k < 6; ++k) f[renamed[k]] = e[k];
    try_strain(&a, e, s, NULL, 0);
    try_strain(&b, f, t, NULL, 0);
    for (int k = 0; k < 6; ++k) assert_near(t[renamed[k]], s[k], 1e-9);
    commit(&a);
    commit(&b);
  }
  stop(&a);
  stop(&b);
  material_destroy(&m);
}

static void stress_never_leaves_the_outermost_surface(void **state)
{
  (void)state;
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  uint64_t seed = 11;
  for (int scale = -12; scale <= 0; ++scale) {
    Drive d = start(&m);
    double strain[6] = {0}, s[6];
    for (int step = 0; step < 3000; ++step) {
      for (int k = 0; k < 6; ++k) strain[k] += pow(10, scale) * (random_uniform(&seed) - 0.5);
      try_strain(&d, strain, s, NULL, 0);
      double mean = (s[0] + s[1] + s[2]) / 3, square = 0;
      for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * pow(s[k] - (k < 3 ? mean : 0), 2);
      assert_true(isfinite(square));
      assert_true(sqrt(square / 3) <= 30 * (1 + 1e-8));
      commit(&d);
    }
    stop(&d);
  }
  material_destroy(&m);
}

static void elastic_tangent_is_the_derivative_of_stress(void **state)
{
  (void)state;
  Material m = material_of("elastic", "bulk modulus=100000", "shear modulus=60000", NULL);
  Drive d = start(&m);
  double strain[6] = {1e-3, -2e-3, 5e-4, 3e-3, -1e-3, 2e-3}, s[6], t[6], tangent[36], h = 1e-6;
  try_strain(&d, strain, s, tangent, 0);
  for (int k = 0; k < 6; ++k) {
    strain[k] += h;
    try_strain(&d, strain, t, NULL, 0);
    strain[k] -= h;
    for (int r = 0; r < 6; ++r) assert_near(tangent[6 * r + k], (t[r] - s[r]) / h, 1e-6 * 180000);
  }
  stop(&d);
  material_destroy(&m);
}

static void multi_yield_tangent_is_the_derivative_of_stress_while_loading_on(void **state)
{
  (void)state;
  /* The law's tangent is the continuum one: it is the derivative in the limit of small increments from the committed state,
   * for increments that load on. */
  Material m =
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL);
  Drive d = start(&m);
  const double direction[6] = {1, -0.4, -0.2, 1.5, 0.7, -0.3};
  double strain[6], s[6], t[6], tangent[36], h = 1e-9;
  for (int step = 1; step <= 400; ++step) {
    for (int k = 0; k < 6; ++k) strain[k] = 1e-5 * step * direction[k];
    try_strain(&d, strain, s, tangent, 0);
    commit(&d);
  }
  for (int k = 0; k < 6; ++k) strain[k] += h * direction[k];
  try_strain(&d, strain, t, NULL, 0);
  for (int r = 0; r < 6; ++r) {
    double expected = 0;
    for (int k = 0; k < 6; ++k) expected += tangent[6 * r + k] * direction[k];
    assert_near((t[r] - s[r]) / h, expected, 2e-3 * 180000);
  }
  stop(&d);
  material_destroy(&m);
}

static void plane_stress_of_any_law_has_no_stress_across_the_plane(void **state)
{
  (void)state;
  Material materials[2] = {
      material_of("elastic", "Young modulus=150000", "Poisson ratio=0.25", NULL),
      material_of("multi-yield-j2", "shear modulus=60000", "bulk modulus=100000", "octahedral strength=30", NULL)};
  const int32_t which[2] = {0, 1};
  const Particles particles = {.slices = 2};
  const Family family = {.particles = &particles};
  Points points;
  assert_int_equal(points_create(&points,
                                 &(PointsSpec){POINTS_ON_PARTICLES, SPACE_PLANE_STRESS, &family, materials, 2, which},
                                 NULL),
                   0);
  static double tangent[2][SLICE * 36];
  for (int step = 1; step <= 50; ++step) {
    for (int i = 0; i < 2 * SLICE; ++i) {
      points.strain[0][i] = 2e-5 * step;
      points.strain[1][i] = -1e-6 * step * (i % SLICE);
      points.strain[3][i] = 1e-5 * step;
    }
    for (int s = 0; s < 2; ++s) assert_int_equal(points_update(&points, s, s + 1, tangent[s]), -1);
    for (int i = 0; i < 2 * SLICE; ++i) assert_near(points.stress[2][i], 0, 1e-9 * fabs(points.stress[0][i]));
    points_commit(&points);
  }
  /* Elastic: E / (1 - nu^2) [1 nu; nu 1], shear G. */
  double e = 150000 / (1 - 0.0625), xx = 1e-3, yy = -5e-5 * 3;
  assert_near(points.stress[0][3], e * (xx + 0.25 * yy), 1e-9 * 150);
  assert_near(points.stress[1][3], e * (yy + 0.25 * xx), 1e-9 * 150);
  assert_near(tangent[0][0], e, 1e-6 * e);
  assert_near(tangent[0][1], 0.25 * e, 1e-6 * e);
  assert_near(tangent[0][21], 60000, 1e-6 * e);
  assert_near(tangent[0][14], 0, 0);
  points_destroy(&points);
  for (int k = 0; k < 2; ++k) material_destroy(&materials[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elastic_follows_the_golden_paths_of_opensees),
      cmocka_unit_test(multi_yield_follows_the_golden_paths_of_opensees),
      cmocka_unit_test(corners_of_the_backbone_lie_on_the_hyperbola),
      cmocka_unit_test(uniaxial_strength_is_three_tau_over_root_two),
      cmocka_unit_test(unloading_doubles_the_backbone),
      cmocka_unit_test(a_trial_can_be_repeated_and_leaves_the_committed_state_alone),
      cmocka_unit_test(stress_turns_with_the_strain),
      cmocka_unit_test(stress_never_leaves_the_outermost_surface),
      cmocka_unit_test(elastic_tangent_is_the_derivative_of_stress),
      cmocka_unit_test(multi_yield_tangent_is_the_derivative_of_stress_while_loading_on),
      cmocka_unit_test(plane_stress_of_any_law_has_no_stress_across_the_plane),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Stress paths of OpenSees's own material classes (tests/golden), followed row by row. */
#include "point.h"

#include <glob.h>

typedef struct Set {
  const char *folder, *set; /* files FOLDER/PATH_SET.csv; with "/" a single path and its set */
  const char *law, *parameters[14];
  double tolerance, tangent_tolerance; /* of the largest stress of a path; of the largest entry; 0: not compared */
  int paths;                           /* how many files there are */
} Set;

#define CAP_C(K, G, X, D, W, R, L, TH, B, A, T)                                                                        \
  {                                                                                                                    \
    "bulk modulus=" K, "shear modulus=" G, "cap position=" X, "compaction rate=" D, "largest compaction=" W,           \
        "cap ratio=" R, "envelope drop=" L, "envelope slope=" TH, "envelope rate=" B, "envelope strength=" A,          \
        "tension cut-off=" T                                                                                           \
  }

static const Set solids[] = {
    {"ElasticIsotropic3D", "A", "elastic", {"Young modulus=150000", "Poisson ratio=0.25"}, 1e-8, 1e-8, 2},
    {"PressureIndependMultiYield",
     "P1",
     "multi-yield-j2",
     {"shear modulus=60000", "bulk modulus=100000", "cohesion=31.8198051534"},
     1e-8,
     0,
     9},
    {"PressureIndependMultiYield",
     "P2",
     "multi-yield-j2",
     {"shear modulus=25000", "bulk modulus=120000", "cohesion=18", "peak octahedral strain=0.05", "surfaces=11"},
     1e-8,
     0,
     3},
    {"PressureIndependMultiYield",
     "P3",
     "multi-yield-j2",
     {"shear modulus=40000", "bulk modulus=90000", "cohesion=10", "friction angle=25", "reference pressure=80",
      "pressure exponent=0.5"},
     1e-8,
     0,
     1},
    {"CapPlasticity", "C1", "cap",
     CAP_C("14478996", "11721092", "110320", "4.6412e-7", "0.42", "4.43", "7997.9", "0.11", "6.3816e-5", "2.6614e4",
           "2.0684e3"),
     2e-6, 1e-6, 8},
    {"CapPlasticity", "C2", "cap",
     CAP_C("1.2e7", "9.0e6", "60000", "8.0e-7", "0.30", "3.5", "6000", "0.15", "8.0e-5", "2.0e4", "1.5e3"), 1e-6, 1e-6,
     1},
    {"CapPlasticity", "C3", "cap",
     CAP_C("50000", "30000", "300", "6.0e-4", "0.10", "2.5", "60", "0.12", "2.0e-3", "80", "10"), 1e-5, 1e-5, 7},
    {"J2Plasticity",
     "A",
     "j2",
     {"bulk modulus=100000", "shear modulus=60000", "yield stress=100", "saturation stress=150", "saturation rate=80",
      "hardening modulus=500"},
     1e-8,
     1e-6,
     6},
    {"J2Plasticity",
     "B",
     "j2",
     {"bulk modulus=1.6e8", "shear modulus=8e7", "yield stress=2.5e5", "saturation stress=4e5", "saturation rate=20",
      "hardening modulus=2e6"},
     1e-8,
     1e-6,
     2},
    {"LinearCap_TruncatedDP",
     "A",
     "drucker-prager",
     {"bulk modulus=100000", "shear modulus=60000", "cone slope=0.1414213562373095", "cone strength=28.2842712474619",
      "tension cut-off=30"},
     1e-8,
     0,
     7},
    {"LinearCap_TruncatedDP",
     "B",
     "drucker-prager",
     {"bulk modulus=14478996", "shear modulus=11721092", "cone slope=0.07778174593052023",
      "cone strength=18818.939874498774", "tension cut-off=2068.4"},
     1e-8,
     0,
     2},
    {"DruckerPrager",
     "B",
     "drucker-prager",
     {"bulk modulus=100000", "shear modulus=60000", "cone slope=0.1414213562373095", "cone strength=28.867513459481291",
      "saturation gain=20", "saturation rate=100"},
     1e-8,
     0,
     2},
    {"J2CyclicBoundingSurface",
     "A",
     "bounding-surface-clay",
     {"bulk modulus=100000", "shear modulus=60000", "undrained strength=30", "hardening modulus=60000",
      "hardening exponent=1", "implicit share=0.5", "opensees steps=1"},
     2e-6,
     0,
     7},
    {"J2CyclicBoundingSurface",
     "B",
     "bounding-surface-clay",
     {"bulk modulus=120000", "shear modulus=25000", "undrained strength=18", "hardening modulus=12500",
      "hardening exponent=1.5", "implicit share=0.5", "opensees steps=1"},
     2e-6,
     0,
     2},
    {"J2CyclicBoundingSurface",
     "C",
     "bounding-surface-clay",
     {"bulk modulus=100000", "shear modulus=60000", "undrained strength=30", "hardening modulus=20000",
      "hardening exponent=0.8", "implicit share=1", "opensees steps=1"},
     2e-6,
     0,
     1},
};

static Material material_of_set(const Set *s)
{
  const char *const *w = s->parameters; /* the words after the last are NULL */
  return material_of(s->law, w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8], w[9], w[10], w[11], w[12], w[13],
                     NULL);
}

typedef struct Compared {
  double stress, largest, tangent, largest_tangent;
  int worst_row;
} Compared;

static const char *const solid_columns[] = {"e11", "e22", "e33", "g12", "g23", "g31",
                                            "s11", "s22", "s33", "s12", "s23", "s31"};

/** The OpenSees class of the bounding surface tells the stress before last in steps without shear (README of its golden paths). */
static bool told_late(const Material *m, const double *before, const double *row)
{
  if (!before || strcmp(m->law->name, "bounding-surface-clay")) return false;
  double shear = 0;
  for (int k = 0; k < 3; ++k)
    shear += fabs(row[k] - before[k] - (row[(k + 1) % 3] - before[(k + 1) % 3])) + fabs(row[3 + k] - before[3 + k]);
  return shear < 1e-12;
}

/** Follows one file; its rows have the numbers first_row + 1, ... */
static void follow(Point *p, const char *file, const double *tangents, int tangent_rows, int first_row,
                   int elastic_rows, Compared *c)
{
  int rows;
  double *path = columns_of(file, solid_columns, 12, &rows);
  for (int i = 0; i < rows; ++i) {
    const double *row = path + 12 * i;
    double stress[6], tangent[36];
    point_try(p, row, stress, tangent, first_row + i < elastic_rows);
    for (int k = 0; k < 6 && !told_late(p->m, i ? row - 12 : NULL, row); ++k) {
      double off = fabs(stress[k] - row[6 + k]);
      if (off > c->stress) c->worst_row = first_row + i + 1;
      c->stress = larger_of(c->stress, off);
      c->largest = larger_of(c->largest, fabs(row[6 + k]));
    }
    for (int t = 0; t < tangent_rows; ++t)
      for (int k = 0; (int)tangents[37 * t] == first_row + i + 1 && k < 36; ++k) {
        c->largest_tangent = larger_of(c->largest_tangent, fabs(tangents[37 * t + 1 + k]));
        c->tangent = larger_of(c->tangent, fabs(tangent[k] - tangents[37 * t + 1 + k]));
      }
    point_commit(p);
  }
  free(path);
}

static double *tangents_of(const char *file, int *rows)
{
  char path[512];
  snprintf(path, sizeof path, "%.*s_tangent.csv",
           (int)(strlen(file) - (strstr(file, "_p1.csv") ? strlen("_p1.csv") : strlen(".csv"))), file);
  const char *names[37] = {"step"};
  char words[36][8];
  for (int c = 0; c < 36; ++c) {
    snprintf(words[c], sizeof words[c], "C%d%d", c / 6 + 1, c % 6 + 1);
    names[c + 1] = words[c];
  }
  double *table = columns_of(path, names, 37, rows);
  assert_true(*rows > 0);
  return table;
}

static void follow_set(const Set *set)
{
  char pattern[512];
  glob_t found;
  int paths = 0;
  snprintf(pattern, sizeof pattern, "%s/%s/*_%s*.csv", GOLDEN, set->folder, set->set);
  assert_int_equal(glob(pattern, 0, NULL, &found), 0);
  for (size_t k = 0; k < found.gl_pathc; ++k) {
    const char *file = found.gl_pathv[k];
    if (strstr(file, "_tangent") || strstr(file, "surfaces_") || strstr(file, "_p2.csv") || strstr(file, "exact_nan"))
      continue;
    Material m = material_of_set(set);
    Point p = point_start(&m);
    int tangent_rows = 0;
    double *tangents = tangents_of(file, &tangent_rows);
    Compared c = {0};
    follow(&p, file, tangents, tangent_rows, 0, strstr(file, "stage0_then_1") ? 20 : 0, &c);
    if (strstr(file, "_p1.csv")) {
      char second[512];
      snprintf(second, sizeof second, "%.*s_p2.csv", (int)(strlen(file) - strlen("_p1.csv")), file);
      follow(&p, second, tangents, tangent_rows, 1200, 0, &c);
    }
    if (!(c.stress <= set->tolerance * c.largest))
      fail_msg("%s: stress off by %.3g of %.3g in row %d", file, c.stress, c.largest, c.worst_row);
    if (set->tangent_tolerance > 0 && !(c.tangent <= set->tangent_tolerance * c.largest_tangent))
      fail_msg("%s: tangent off by %.3g of %.3g", file, c.tangent, c.largest_tangent);
    free(tangents);
    point_stop(&p);
    material_destroy(&m);
    ++paths;
  }
  globfree(&found);
  assert_int_equal(paths, set->paths);
}

static void solid_laws_follow_opensees(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof solids / sizeof *solids; ++k) follow_set(&solids[k]);
}

#define STEEL "Young modulus=200000", "yield stress=400", "hardening ratio=0.01"
#define CONCRETE_A "compressive strength=30", "peak strain=0.002", "residual strength=6", "crushing strain=0.006"
#define CONCRETE_B "compressive strength=45", "peak strain=0.0025", "residual strength=15", "crushing strain=0.015"

static const Set fibres[] = {
    {"uniaxial_Elastic", "A", "elastic-1d", {"Young modulus=30000"}, 1e-8, 1e-8, 5},
    {"uniaxial_Elastic", "B", "elastic-1d", {"Young modulus=200000"}, 1e-8, 1e-8, 2},
    {"uniaxial_ElasticPP",
     "A",
     "elastic-perfectly-plastic",
     {"Young modulus=200000", "yield stress=400"},
     1e-8,
     1e-8,
     5},
    {"uniaxial_ElasticPP",
     "B",
     "elastic-perfectly-plastic",
     {"Young modulus=30000", "yield stress=30", "compressive yield stress=90", "initial strain=0.0005"},
     1e-8,
     1e-8,
     2},
    {"uniaxial_Steel01", "A", "steel-bilinear", {STEEL}, 1e-8, 1e-8, 5},
    {"uniaxial_Steel01",
     "B",
     "steel-bilinear",
     {"Young modulus=210000", "yield stress=350", "hardening ratio=0.02", "compression shift=0.1",
      "compression range=5", "tension shift=0.15", "tension range=6"},
     1e-8,
     1e-8,
     2},
    {"uniaxial_Steel02", "A", "menegotto-pinto", {STEEL, "roundness=18"}, 1e-8, 1e-8, 5},
    {"uniaxial_Steel02", "D", "menegotto-pinto", {STEEL}, 1e-8, 1e-8, 1},
    {"uniaxial_Steel02",
     "B",
     "menegotto-pinto",
     {"Young modulus=205000", "yield stress=500", "hardening ratio=0.015", "roundness=20", "roundness fall=0.9",
      "roundness range=0.12", "compression shift=0.03", "compression range=1", "tension shift=0.03", "tension range=1",
      "initial stress=50"},
     1e-8,
     1e-8,
     2},
    {"uniaxial_Concrete01", "A", "kent-scott-park", {CONCRETE_A}, 1e-8, 1e-8, 5},
    {"uniaxial_Concrete01", "B", "kent-scott-park", {CONCRETE_B}, 1e-8, 1e-8, 2},
    {"uniaxial_Concrete02",
     "A",
     "concrete02",
     {CONCRETE_A, "tensile strength=3", "tension softening=1500"},
     1e-8,
     1e-8,
     5},
    {"uniaxial_Concrete02", "D", "concrete02", {CONCRETE_A}, 1e-8, 1e-8, 1},
    {"uniaxial_Concrete02",
     "B",
     "concrete02",
     {CONCRETE_B, "unloading ratio=0.25", "tensile strength=4", "tension softening=3000"},
     1e-8,
     1e-8,
     2},
};

static void uniaxial_laws_follow_opensees(void **state)
{
  (void)state;
  static const char *const columns[] = {"strain", "stress", "tangent"};
  for (size_t n = 0; n < sizeof fibres / sizeof *fibres; ++n) {
    const Set *set = &fibres[n];
    char pattern[512];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/%s/*_%s.csv", GOLDEN, set->folder, set->set);
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    assert_int_equal(found.gl_pathc, set->paths);
    for (size_t k = 0; k < found.gl_pathc; ++k) {
      Material m = material_of_set(set);
      Point p = point_start(&m);
      int rows;
      double *path = columns_of(found.gl_pathv[k], columns, 3, &rows), worst = 0, largest = 0, off = 0, stiffest = 0;
      int worst_row = 0, off_row = 0;
      for (int i = 0; i < rows; ++i) {
        double stress, tangent;
        point_try(&p, path + 3 * i, &stress, &tangent, 0);
        if (fabs(stress - path[3 * i + 1]) > worst) worst_row = i + 1;
        double slope_off = fabs(tangent - path[3 * i + 2]);
        for (int side = -1; side <= 1; side += 2) { /* at a corner either slope is right, and roundings choose */
          const double aside = path[3 * i] + 1e-9 * side;
          double there, ignored;
          point_try(&p, &aside, &there, &ignored, 0);
          if (slope_off > 1e-8 * fabs(path[2]) &&
              fabs((there - stress) / (1e-9 * side) - tangent) < 1e-4 * fabs(path[2]))
            slope_off = 0;
        }
        point_try(&p, path + 3 * i, &stress, &tangent, 0);
        point_commit(&p);
        if (slope_off > off) off_row = i + 1;
        worst = larger_of(worst, fabs(stress - path[3 * i + 1]));
        off = larger_of(off, slope_off);
        largest = larger_of(largest, fabs(path[3 * i + 1]));
        stiffest = larger_of(stiffest, fabs(path[3 * i + 2]));
      }
      if (!(worst <= set->tolerance * largest))
        fail_msg("%s: stress off by %.3g of %.3g in row %d", found.gl_pathv[k], worst, largest, worst_row);
      if (!(off <= set->tangent_tolerance * stiffest))
        fail_msg("%s: tangent off by %.3g of %.3g in row %d", found.gl_pathv[k], off, stiffest, off_row);
      free(path);
      point_stop(&p);
      material_destroy(&m);
    }
    globfree(&found);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solid_laws_follow_opensees),
      cmocka_unit_test(uniaxial_laws_follow_opensees),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Tangents of laws of a point in space are the derivatives of their steps, wherever a walk leads. */
#include "sample_laws.h"

#include "base/random.h"
#include "base/tensor.h"
#include "points/points.h"

/** The walk of the tangents, which begins again now and then: dilation would press a point that wanders for long. */
static void wander_anew(uint64_t *seed, const Material *m, Point *p, double size, int step, double *length,
                        double strain[6])
{
  if (step % 12 == 11) {
    point_stop(p);
    *p = point_start(m);
    memset(strain, 0, sizeof(double) * 6);
  }
  *length = size * pow(10, -2 * random_uniform(seed));
  sample_wander(seed, size, *length, strain);
}

/** How far the tangent of a strain is from central differences of steps of size h, over the stiffness; -1 at a kink. */
static double tangent_error(Point *p, const double strain[6], double h)
{
  const double whole = sample_stiffness(p->m);
  double s[6], tangent[36], worst = 0;
  point_try(p, strain, s, tangent, 0);
  bool kink = false;
  for (int k = 0; k < 6; ++k) {
    double at[4][6]; /* -2h, -h, h, 2h */
    for (int i = 0; i < 4; ++i) {
      double e[6];
      memcpy(e, strain, sizeof e);
      e[k] += (i < 2 ? i - 2 : i - 1) * h;
      point_try(p, e, at[i], NULL, 0);
    }
    for (int r = 0; r < 6; ++r) {
      const double near = (at[2][r] - at[1][r]) / (2 * h), far = (at[3][r] - at[0][r]) / (4 * h);
      const double left = (s[r] - at[1][r]) / h, right = (at[2][r] - s[r]) / h, left2 = (at[1][r] - at[0][r]) / h,
                   right2 = (at[3][r] - at[2][r]) / h;
      const double bend = fabs(right - left) / whole, bend2 = fabs(right2 - right) / whole,
                   bend3 = fabs(left2 - left) / whole;
      if (fmax(bend, fmax(bend2, bend3)) > 3e-3) kink = true;
      worst = larger_of(worst, fabs((4 * near - far) / 3 - tangent[6 * r + k]) / whole);
    }
  }
  return kink ? -1 : worst;
}

static void tangents_are_derivatives_of_steps(void **state)
{
  (void)state;
  for (int n = 0; n < SAMPLES; ++n) {
    Material m = samples[n].make();
    Point p = point_start(&m);
    uint64_t seed = 17;
    double strain[6] = {0}, s[6], length;
    int smooth = 0;
    for (int step = 0; step < 3000; ++step) {
      wander_anew(&seed, &m, &p, samples[n].strain, step, &length, strain);
      double error = tangent_error(&p, strain, 1e-4 * length);
      if (error > 1e-6) error = tangent_error(&p, strain, 1e-6 * length); /* a slight kink nearby? */
      if (error > 1e-6) fail_msg("%s: tangent off by %.2e in step %d", samples[n].name, error, step);
      smooth += error >= 0;
      point_try(&p, strain, s, NULL, 0);
      point_commit(&p);
    }
    assert_true(smooth > 2500);
    point_stop(&p);
    material_destroy(&m);
  }
}

/** Where a point of the cap model stands: 1 cut-off, 2 its corner, 3 cap, 4 corner of envelope and cap, 5 envelope, 6 inside. */
static int cap_region(const Point *p, const double s[6])
{
  double i, length;
  stress_invariants(s, &i, &length);
  i = -i;
  const double k = p->trial[6], small = 1e-7 * 2.6e4;
  if (fabs(i + 2068.4) < small) return fabs(length - sample_cap_envelope(i)) < small ? 2 : 1;
  if (fabs(i - k) < small && fabs(length - sample_cap_envelope(k)) < small) return 4;
  if (i < k) return fabs(length - sample_cap_envelope(i)) < small ? 5 : 6;
  return fabs(sqrt(length * length + pow((i - k) / 4.43, 2)) - sample_cap_envelope(k)) < small ? 3 : 6;
}

static void the_walk_of_tangents_visits_every_region_of_the_cap(void **state)
{
  (void)state;
  Material m = sample_cap();
  Point p = point_start(&m);
  uint64_t seed = 17;
  double strain[6] = {0}, s[6];
  int visits[7] = {0};
  for (int step = 0; step < 3000; ++step) {
    double length;
    wander_anew(&seed, &m, &p, 5e-3, step, &length, strain);
    point_try(&p, strain, s, NULL, 0);
    ++visits[cap_region(&p, s)];
    point_commit(&p);
  }
  for (int k = 1; k < 7; ++k) assert_true(visits[k] > 20);
  point_stop(&p);
  material_destroy(&m);
}

/** Which planes of the Mohr-Coulomb sample a stress lies on: 1 shear, 2 an edge with two equal stresses, 4, 8, 16 the cut-off by one, two, three. */
static int coulomb_planes(const double s[6])
{
  double value[3], vector[9];
  tensor_eigen(s, value, vector);
  const double most = fmax(value[0], fmax(value[1], value[2])), least = fmin(value[0], fmin(value[1], value[2])),
               middle = value[0] + value[1] + value[2] - most - least, small = 1e-7 * 20;
  const int cuts = (most > 15 - small) + (middle > 15 - small) + (least > 15 - small);
  const bool shear = fabs(most - least + 0.5 * (most + least) - 40 * sqrt(0.75)) < small;
  return shear + (shear && (most - middle < small || middle - least < small) ? 2 : 0) + (cuts ? 2 << cuts : 0);
}

static void the_walk_of_tangents_visits_the_planes_edges_and_corners_of_mohr_and_coulomb(void **state)
{
  (void)state;
  Material m = sample_coulomb();
  Point p = point_start(&m);
  uint64_t seed = 17;
  double strain[6] = {0}, s[6];
  int visits[32] = {0};
  for (int step = 0; step < 3000; ++step) {
    double length;
    wander_anew(&seed, &m, &p, 5e-3, step, &length, strain);
    point_try(&p, strain, s, NULL, 0);
    ++visits[coulomb_planes(s)];
    point_commit(&p);
  }
  /* Inside; shear; an edge; cut-off once, twice, at its corner; shear with one cut-off, and both corners of that. */
  const int wanted[] = {0, 1, 3, 4, 8, 16, 5, 7, 11};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k)
    if (visits[wanted[k]] < 5) fail_msg("%d visits of kind %d", visits[wanted[k]], wanted[k]);
  point_stop(&p);
  material_destroy(&m);
}

/** How far the tangents of points in plane stress are from central differences, over the stiffness; -1 at a kink. */
static void plane_stress_errors(Points *points, const Material *m, double h, double error[SLICE], double *skew)
{
  static const int in_plane[3] = {XX, YY, XY};
  double base[3][SLICE], tangent[SLICE][36], at[4][3][SLICE];
  bool kink[SLICE] = {false};
  points_keep_tangents(points, true, NULL);
  assert_int_equal(points_update(points, 0, SLICE, points->strain, points->stress), -1);
  for (int i = 0; i < SLICE; ++i) {
    error[i] = 0;
    points_tangent(points, i, tangent[i]);
    for (int r = 0; r < 3; ++r) base[r][i] = points->stress[in_plane[r]][i];
  }
  points_keep_tangents(points, false, NULL);
  for (int k = 0; k < 3; ++k) {
    double *strain = points->strain[in_plane[k]], kept[SLICE];
    memcpy(kept, strain, sizeof kept);
    for (int part = 0; part < 4; ++part) { /* -2h, -h, h, 2h */
      for (int i = 0; i < SLICE; ++i) strain[i] = kept[i] + (part < 2 ? part - 2 : part - 1) * h;
      assert_int_equal(points_update(points, 0, SLICE, points->strain, points->stress), -1);
      for (int r = 0; r < 3; ++r) memcpy(at[part][r], points->stress[in_plane[r]], sizeof at[part][r]);
    }
    memcpy(strain, kept, sizeof kept);
    for (int i = 0; i < SLICE; ++i)
      for (int r = 0; r < 3; ++r) {
        const double near = (at[2][r][i] - at[1][r][i]) / (2 * h), far = (at[3][r][i] - at[0][r][i]) / (4 * h),
                     bend = (at[2][r][i] - 2 * base[r][i] + at[1][r][i]) / h,
                     wide = (at[3][r][i] - 2 * base[r][i] + at[0][r][i]) / (2 * h);
        if (fmax(fabs(bend), fabs(wide)) > 3e-3 * sample_stiffness(m)) kink[i] = true;
        error[i] = larger_of(error[i], fabs((4 * near - far) / 3 - tangent[i][6 * in_plane[r] + in_plane[k]]));
        *skew =
            fmax(*skew, fabs(tangent[i][6 * in_plane[r] + in_plane[k]] - tangent[i][6 * in_plane[k] + in_plane[r]]) /
                            sample_stiffness(m));
      }
  }
  for (int i = 0; i < SLICE; ++i) error[i] = kink[i] ? -1 : error[i] / sample_stiffness(m);
}

static void tangents_of_plane_stress_are_derivatives_too(void **state)
{
  (void)state;
  const PointsRun run = {0, 0, SLICE};
  enum { STEPS = 150, FRESH = 10 };
  double most_skew = 0;
  for (int n = 0; n < SAMPLES; ++n) {
    if (samples[n].jumps) continue;
    Material m = samples[n].make();
    uint64_t seed = 61;
    int smooth = 0;
    Points points = {0};
    const PointsSpec spec = {.components = 6,
                             .plane_stress = true,
                             .runs = &run,
                             .run_count = 1,
                             .materials = &m,
                             .material_count = 1,
                             .length = NAN};
    for (int step = 0; step < STEPS; ++step) {
      double error[SLICE];
      const double length = samples[n].strain * pow(10, -2 * random_uniform(&seed));
      if (step % FRESH == 0) {
        points_destroy(&points);
        assert_int_equal(points_create(&points, &spec, NULL), 0);
      }
      for (int i = 0; i < SLICE; ++i) {
        double e[6] = {points.strain[XX][i], points.strain[YY][i], 0, points.strain[XY][i]};
        sample_wander(&seed, samples[n].strain, length, e);
        points.strain[XX][i] = e[XX];
        points.strain[YY][i] = e[YY];
        points.strain[XY][i] = e[XY];
      }
      plane_stress_errors(&points, &m, 1e-4 * length, error, &most_skew);
      for (int i = 0; i < SLICE; ++i) {
        smooth += error[i] >= 0 && error[i] < 1e-5;
        if (error[i] > 1e-2)
          fail_msg("%s: tangent in plane stress off by %.2e in step %d", samples[n].name, error[i], step);
      }
      assert_int_equal(points_update(&points, 0, SLICE, points.strain, points.stress), -1);
      points_commit(&points);
    }
    if (smooth < 0.8 * STEPS * SLICE)
      fail_msg("%s: only %d tangents were those of differences", samples[n].name, smooth);
    points_destroy(&points);
    material_destroy(&m);
  }
  assert_true(most_skew > 0.05); /* laws that do not flow along their normal are among them */
}

/* With the weight 1 of elastic tangents every body answers as Hooke's, however far its laws have gone: in plane stress by
 * E / (1 - nu^2) (1, nu), which is free across, in space by K + 4G/3 and K - 2G/3. */
static void elastic_tangents_are_hookes(void **state)
{
  (void)state;
  const PointsRun run = {0, 0, SLICE};
  for (int n = 0; n < SAMPLES; ++n)
    for (int plane = 0; plane < 2; ++plane) {
      Material m = samples[n].make();
      Points points = {0};
      const PointsSpec spec = {.components = 6,
                               .plane_stress = plane,
                               .runs = &run,
                               .run_count = 1,
                               .materials = &m,
                               .material_count = 1,
                               .length = NAN};
      assert_int_equal(points_create(&points, &spec, NULL), 0);
      for (int i = 0; i < SLICE; ++i) points.strain[XX][i] = samples[n].strain;
      points_keep_tangents(&points, true, NULL);
      assert_int_equal(points_update(&points, 0, SLICE, points.strain, points.stress), -1);
      points.elastic_weight = 1;
      const double young = 9 * m.bulk * m.shear / (3 * m.bulk + m.shear), nu = young / (2 * m.shear) - 1,
                   along = plane ? young / (1 - nu * nu) : m.bulk + 4 * m.shear / 3,
                   across = plane ? nu * along : m.bulk - 2 * m.shear / 3;
      double tangent[36];
      points_tangent(&points, SLICE / 2, tangent);
      for (int r = 0; r < 6; ++r)
        for (int k = 0; k < 6; ++k) {
          const bool normal = r < (plane ? 2 : 3) && k < (plane ? 2 : 3);
          const double hooke = normal ? (r == k ? along : across) : r != k || (plane && r == ZZ) ? 0 : m.shear;
          if (plane && r == k && (r == YZ || r == ZX)) continue; /* no such strains */
          if (!(fabs(tangent[6 * r + k] - hooke) <= 1e-12 * along))
            fail_msg("%s%s: %g in row %d, column %d, expected %g", samples[n].name, plane ? " in plane stress" : "",
                     tangent[6 * r + k], r, k, hooke);
        }
      points_destroy(&points);
      material_destroy(&m);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_are_derivatives_of_steps),
      cmocka_unit_test(tangents_of_plane_stress_are_derivatives_too),
      cmocka_unit_test(elastic_tangents_are_hookes),
      cmocka_unit_test(the_walk_of_tangents_visits_every_region_of_the_cap),
      cmocka_unit_test(the_walk_of_tangents_visits_the_planes_edges_and_corners_of_mohr_and_coulomb),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

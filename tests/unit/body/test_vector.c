/* Operations on vectors (body/vector.h) against loops written out, and with any number of threads to the same bits. */
#include "support.h"

#include "base/random.h"
#include "base/team.h"

enum { VECTORS = 4, RESULTS = 8 };

static const double turning = 3; /* factor on the part of rotations */

static breccia_model *body_with_rotations(bool space)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials: {m: {model: elastic, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2}}\n"
                  "body: {b: {material: m, %s spacing: 0.1, shape: {box: {particles: %s}}}}\n"
                  "peridynamics: {formulation: micropolar, space: %s, horizon: 1.5 spacings}\n"
                  "loads: [{on: {face: x+}, traction: %s}]\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
                  space ? "" : "lattice: square, thickness: 0.1,", space ? "[13, 11, 9]" : "[53, 31]",
                  space ? "3-D" : "plane stress", space ? "[1, 0, 0]" : "[1, 0]");
}

static void fill(const Particles *p, const Vector *v, uint64_t seed)
{
  for (int k = 0; k < v->space->rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) v->row[k][p->place_of[n]] = random_uniform(&seed) - 0.5;
}

/** Elementwise operations into the last vector, then sums and extremes. */
static void operate(const Particles *p, const Vector *v, double result[RESULTS])
{
  const Vector *a = &v[3];
  vector_sum_terms(a, &(VectorTerms){{2, -3, 0.5}, {&v[0], &v[1], &v[2]}});
  vector_weigh_sum(a, p->volume, a, &v[0]);
  vector_add_weighted(a, p->density, &v[1]);
  vector_combine(0.25, a, -4, &v[2]);
  vector_scale(a, 3);
  result[0] = vector_inner(a, &v[1], turning);
  result[1] = vector_inner_weighted(p->volume, a, NULL, &v[0]);
  result[2] = vector_inner_weighted(p->volume, a, &v[1], &v[0]);
  result[3] = vector_inner_mass(p->volume, &p->inertia, a, a);
  result[4] = vector_largest(a);
  result[5] = vector_largest_rotation(a);
  result[6] = vector_spread(a, p->number);
  result[7] = vector_is_zero(a);
}

/** The same by loops over particles. @param[out] size  of the terms of each sum */
static void by_loops(const Particles *p, const Vector *v, double result[RESULTS], double size[RESULTS])
{
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int m = 0; m < RESULTS; ++m) result[m] = size[m] = 0;
  for (int k = 0; k < v->space->rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) {
      const int64_t i = p->place_of[n];
      const double x = v[0].row[k][i], y = v[1].row[k][i], z = v[2].row[k][i], w = p->volume[i];
      double a = w * (2 * x - 3 * y + 0.5 * z + x) + p->density[i] * y;
      a = 3 * (0.25 * a - 4 * z);
      assert_near(v[3].row[k][i], a, 1e-14 * (1 + fabs(a)));
      const bool turns = k >= 3;
      const double terms[] = {(turns ? turning : 1) * a * y, w * a * x, w * (a + y) * x,
                              p->inertia.row[k][i] * w * a * a};
      for (int m = 0; m < 4; ++m) {
        result[m] += terms[m];
        size[m] += fabs(terms[m]);
      }
      result[4 + turns] = fmax(result[4 + turns], fabs(a));
      if (!turns) low[k] = fmin(low[k], a), high[k] = fmax(high[k], a);
    }
  for (int k = 0; k < 3; ++k) result[6] += (high[k] - low[k]) * (high[k] - low[k]);
  result[6] = sqrt(result[6]);
  for (int m = 4; m < RESULTS; ++m) size[m] = 1;
}

static void operations_are_those_of_loops_with_any_number_of_threads(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = body_with_rotations(space);
    const Particles *p = model->domain.particles;
    Vector v[VECTORS] = {{0}}, first = {0};
    double expected[RESULTS], size[RESULTS], found[RESULTS];
    assert_true(vector_create(&first, &p->space, "test", NULL));
    assert_int_equal(p->space.rows - p->space.rotation, space ? 3 : 1);
    assert_true(p->space.tile_count > 3);
    for (int m = 0; m < VECTORS; ++m) assert_true(vector_create(&v[m], &p->space, "test", NULL));
    for (int m = 0; m < 3; ++m) fill(p, &v[m], (uint64_t)m + 1);
    for (int threads = 1; threads <= 4; ++threads) {
      Team *team = team_create(threads, NULL), *before = team_use(team);
      double now[RESULTS];
      vector_clear(&v[3]);
      assert_true(vector_is_zero(&v[3]));
      operate(p, v, now);
      if (threads == 1) memcpy(found, now, sizeof found), vector_copy(&first, &v[3]);
      assert_memory_equal(now, found, sizeof now);
      for (int k = 0; k < p->space.rows; ++k)
        assert_memory_equal(v[3].row[k], first.row[k], sizeof(double) * (size_t)p->places);
      team_use(before);
      team_destroy(&team);
    }
    by_loops(p, v, expected, size);
    for (int m = 0; m < RESULTS; ++m) assert_near(found[m], expected[m], 1e-13 * size[m]);
    for (int m = 0; m < VECTORS; ++m) vector_destroy(&v[m]);
    vector_destroy(&first);
    breccia_model_destroy(&model);
  }
}

/** Largest values ignore what is no number, but no vector with such values counts as zero. */
static void what_is_no_number_is_not_zero(void **state)
{
  (void)state;
  breccia_model *model = body_with_rotations(false);
  const Particles *p = model->domain.particles;
  Vector v = {0};
  assert_true(vector_create(&v, &p->space, "test", NULL));
  v.row[1][p->place_of[p->count - 1]] = NAN;
  assert_false(vector_is_zero(&v));
  assert_near(vector_largest(&v), 0, 0);
  assert_true(isnan(vector_inner(&v, &v, 1)));
  vector_destroy(&v);
  breccia_model_destroy(&model);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operations_are_those_of_loops_with_any_number_of_threads),
      cmocka_unit_test(what_is_no_number_is_not_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

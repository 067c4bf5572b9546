/* Search cells: whatever a point and however the particles stand, all within reach of it are among those that are given, and few others. */
#include "family/cells.h"
#include "support.h"

#include "base/random.h"

static void every_particle_within_reach_is_found(void **state)
{
  (void)state;
  /* A cube, a plate, a row, two clumps far apart, and a cube of which some particles are nowhere. */
  enum { COUNT = 700, KINDS = 5, POINTS = 60 };
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n" SOFT_SOLID
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 10, 7]}}}}\n"
                              "peridynamics: {horizon: 1.5 spacings}\n"
                              "solve: {explicit: {steps: 1, time step: 1e-9}}\n");
  const Particles *p = m->domain.particles;
  assert_int_equal(p->count, COUNT);
  double *x[3];
  for (int k = 0; k < 3; ++k) assert_non_null(x[k] = places_array(p->places, "places", NULL));
  uint64_t seed = 12;
  for (int kind = 0; kind < KINDS; ++kind) {
    const double size[KINDS][3] = {{1, 1, 1}, {2, 2, 0}, {5, 0, 0}, {1, 1, 1}, {1, 1, 1}},
                 reach = kind == 2 ? 0.05 : 0.21;
    for (int64_t n = 0; n < COUNT; ++n)
      for (int k = 0; k < 3; ++k) {
        x[k][p->place_of[n]] = size[kind][k] * random_uniform(&seed) - 0.3 + (kind == 3 && n % 2 ? 1e3 : 0);
        if (kind == 4 && n % 50 == k) x[k][p->place_of[n]] = k == 1 ? INFINITY : k ? NAN : -INFINITY;
      }
    Cells cells;
    assert_int_equal(cells_create(&cells, p, (const double *const[3]){x[0], x[1], x[2]}, reach, NULL), 0);
    assert_true(cells.width >= reach);
    assert_true((double)(cells.count[0] * cells.count[1] * cells.count[2]) <= 4.0 * COUNT + 64);
    if (kind < 3) assert_true(cells.width < 1.001 * reach); /* none wider than it needs to be */
    for (int k = 0; k < 3; ++k) { /* they cover the particles that are somewhere, and no more */
      double low = INFINITY, high = -INFINITY;
      for (int64_t n = 0; n < COUNT; ++n) {
        const double at = x[k][p->place_of[n]];
        if (!isfinite(at)) continue;
        low = fmin(low, at);
        high = larger_of(high, at);
      }
      assert_true(cells.low[k] == low);
      assert_int_equal(cells.count[k], 1 + (int64_t)floor((high - low) / cells.width));
    }
    for (int64_t n = 0; n < COUNT; ++n)
      for (int k = 0; k < 3; ++k) {
        const double there = x[k][cells.places[n]];
        assert_true(cells.position[3 * n + k] == there || (isnan(there) && isnan(cells.position[3 * n + k])));
      }
    int64_t looked = 0, within = 0;
    for (int t = 0; t < POINTS; ++t) {
      const int32_t i = p->place_of[(int64_t)(COUNT * random_uniform(&seed))];
      double point[3];
      for (int k = 0; k < 3; ++k) point[k] = x[k][i] + (t % 3 ? 2 * reach * (random_uniform(&seed) - 0.5) : 0);
      int64_t rows[9][2], found = 0, expected = 0;
      const int count = cells_around(&cells, point, rows);
      assert_true(count >= 1 && count <= 9);
      for (int r = 0; r < count; ++r)
        for (int64_t n = rows[r][0]; n < rows[r][1]; ++n, ++looked) {
          double square = 0;
          if (r && n == rows[r][0]) assert_true(n >= rows[r - 1][1]); /* no particle comes twice */
          for (int k = 0; k < 3; ++k) square += pow(cells.position[3 * n + k] - point[k], 2);
          found += square <= reach * reach;
        }
      for (int64_t n = 0; n < COUNT; ++n) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow(x[k][p->place_of[n]] - point[k], 2);
        expected += square <= reach * reach;
      }
      assert_int_equal(found, expected);
      within += expected;
    }
    assert_true(within > POINTS / 2);
    /* Of a cube 27 cells to a ball: 6.4 times; of a plate 9 to a disc, of a row 3 to 2, and those at the edge. */
    if (kind < 3) assert_true((double)looked < (kind ? 4 : 8) * (double)within);
    cells_destroy(&cells);
  }
  for (int64_t i = 0; i < p->places; ++i) x[0][i] = x[1][i] = x[2][i] = NAN;
  Cells cells;
  assert_int_equal(cells_create(&cells, p, (const double *const[3]){x[0], x[1], x[2]}, 0.1, NULL), 0);
  assert_true(cells.count[0] == 1 && cells.count[1] == 1 && cells.count[2] == 1);
  int64_t rows[9][2];
  assert_int_equal(cells_around(&cells, (const double[3]){NAN, 0, INFINITY}, rows), 1);
  assert_true(rows[0][0] == 0 && rows[0][1] == COUNT);
  cells_destroy(&cells);
  for (int k = 0; k < 3; ++k) places_free(&x[k]);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_particle_within_reach_is_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The least sum of squares in a box: valleys, ends of the box, places without residuals, and the curvature at the end; and systems of equations. */
#include "base/least_squares.h"
#include "base/linear.h"
#include "base/random.h"
#include "support.h"

/** Rosenbrock's valley from (0, 0) to (1, 1), laid into the box: its residuals vanish at (0.75, 0.75). */
static bool valley(void *context, const double *at, double *residual)
{
  const double x = 4 * at[0] - 2, y = 4 * at[1] - 2;
  ++*(int *)context;
  residual[0] = 10 * (y - x * x);
  residual[1] = 1 - x;
  return true;
}

static void the_end_of_a_curved_valley_is_found(void **state)
{
  (void)state;
  int calls = 0;
  LeastSquares p = {.parameters = 2, .count = 2, .residuals = valley, .context = &calls};
  assert_int_equal(least_squares_create(&p, NULL), BRECCIA_OK);
  double at[2] = {0.2, 0.75};
  assert_true(least_squares_descend(&p, at) < 1e-12);
  assert_near(at[0], 0.75, 1e-6);
  assert_near(at[1], 0.75, 1e-6);
  assert_true(calls < 200);
  least_squares_destroy(&p);
}

/** A line through points at 1, 2, 3 with slope 2 and ordinate -0.5, which lies outside the box. */
static bool line(void *context, const double *at, double *residual)
{
  (void)context;
  for (int k = 0; k < 3; ++k) residual[k] = 4 * at[0] * (k + 1) + at[1] - (2 * (k + 1) - 0.5);
  return true;
}

static void what_lies_outside_the_box_is_met_at_its_face(void **state)
{
  (void)state;
  LeastSquares p = {.parameters = 2, .count = 3, .residuals = line};
  assert_int_equal(least_squares_create(&p, NULL), BRECCIA_OK);
  double at[2] = {0.9, 0.9}, curvature[4];
  const double sum = least_squares_descend(&p, at);
  assert_true(at[1] == 0);
  /* without an ordinate the slope is sum(x y) / sum(x x) = (1.5 + 7 + 16.5) / 14 */
  assert_near(4 * at[0], 25. / 14, 1e-6);
  assert_near(sum, 1.5 * 1.5 + 3.5 * 3.5 + 5.5 * 5.5 - 25. * 25 / 14, 1e-6);
  least_squares_curvature(&p, at, curvature);
  assert_near(curvature[0], 16 * 14, 1e-5);
  assert_near(curvature[1], 4 * 6, 1e-5);
  assert_near(curvature[3], 3, 1e-5);
  least_squares_destroy(&p);
}

/** As the line, but nothing can be computed where the slope is more than 2.4. */
static bool cliff(void *context, const double *at, double *residual)
{
  return at[0] <= 0.6 && line(context, at, residual);
}

static void places_without_residuals_are_left_alone(void **state)
{
  (void)state;
  LeastSquares p = {.parameters = 2, .count = 3, .residuals = cliff};
  assert_int_equal(least_squares_create(&p, NULL), BRECCIA_OK);
  double at[2] = {0.6, 0.9}, none[2] = {0.7, 0.5};
  assert_true(isinf(least_squares_descend(&p, none)));
  least_squares_descend(&p, at);
  assert_near(4 * at[0], 25. / 14, 1e-6);
  least_squares_destroy(&p);
}

static void systems_are_solved_whatever_their_signs_and_order(void **state)
{
  (void)state;
  /* Matrices with one large number in each row, of either sign and in any column, and small ones beside: only the large ones can be pivots. */
  enum { SIZE = 5, COLUMNS = 2 };
  uint64_t seed = 11;
  for (int trial = 0; trial < 200; ++trial) {
    double a[SIZE * SIZE], kept[SIZE * SIZE], right[SIZE * COLUMNS] = {0}, x[SIZE * COLUMNS];
    int column[SIZE] = {0, 1, 2, 3, 4};
    for (int r = SIZE - 1; r > 0; --r) {
      const int other = (int)(random_uniform(&seed) * (r + 1)), mine = column[r];
      column[r] = column[other];
      column[other] = mine;
    }
    for (int k = 0; k < SIZE * SIZE; ++k) a[k] = 1e-9 * (random_uniform(&seed) - 0.5);
    for (int r = 0; r < SIZE; ++r) a[SIZE * r + column[r]] = (random_uniform(&seed) < 0.5 ? -1 : 1) * (1 + r);
    for (int k = 0; k < SIZE * COLUMNS; ++k) x[k] = random_uniform(&seed) - 0.5;
    for (int r = 0; r < SIZE; ++r)
      for (int n = 0; n < COLUMNS; ++n)
        for (int k = 0; k < SIZE; ++k) right[COLUMNS * r + n] += a[SIZE * r + k] * x[COLUMNS * k + n];
    memcpy(kept, a, sizeof a);
    assert_true(linear_solve(SIZE, a, COLUMNS, right));
    for (int k = 0; k < SIZE * COLUMNS; ++k) assert_near(right[k], x[k], 1e-13);
    memcpy(kept + SIZE, kept, sizeof(double) * SIZE); /* two rows alike */
    assert_false(linear_solve(SIZE, kept, COLUMNS, right));
  }
}

static void positive_definite_matrices_have_a_factor(void **state)
{
  (void)state;
  enum { MOST = 41 };
  static double a[MOST * MOST], factor[MOST * MOST];
  uint64_t seed = 5;
  for (int size = 1; size <= MOST; ++size) {
    double x[MOST], right[MOST];
    int begin[MOST];
    for (int row = 0; row < size; ++row) {
      const int first = (int)(random_uniform(&seed) * (row + 1)); /* rows begin anywhere */
      for (int column = 0; column <= row; ++column)
        a[row * size + column] = a[column * size + row] = column < first ? 0 : random_uniform(&seed) - 0.5;
      a[row * size + row] = size;
      right[row] = x[row] = random_uniform(&seed) - 0.5;
    }
    memcpy(factor, a, sizeof a);
    assert_true(linear_factor(size, factor, begin));
    linear_factor_solve(size, factor, begin, x);
    for (int row = 0; row < size; ++row) {
      double sum = 0;
      for (int column = 0; column < size; ++column) sum += a[row * size + column] * x[column];
      assert_near(sum, right[row], 1e-14 * size);
    }
    memcpy(factor, a, sizeof a);
    factor[size * size - 1] = -1; /* one direction is unstable */
    assert_false(linear_factor(size, factor, begin));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(systems_are_solved_whatever_their_signs_and_order),
      cmocka_unit_test(positive_definite_matrices_have_a_factor),
      cmocka_unit_test(the_end_of_a_curved_valley_is_found),
      cmocka_unit_test(what_lies_outside_the_box_is_met_at_its_face),
      cmocka_unit_test(places_without_residuals_are_left_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

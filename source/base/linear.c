#include "base/linear.h"

#include <math.h>
#include <stdint.h>

static void swap_rows(double *matrix, int columns, int one, int other)
{
  for (int k = 0; k < columns; ++k) {
    const double value = matrix[one * columns + k];
    matrix[one * columns + k] = matrix[other * columns + k];
    matrix[other * columns + k] = value;
  }
}

bool linear_solve(int size, double *a, int columns, double *right)
{
  double largest = 0;
  for (int k = 0; k < size * size; ++k) largest = fmax(largest, fabs(a[k]));
  for (int k = 0; k < size; ++k) {
    int pivot = k;
    for (int r = k + 1; r < size; ++r)
      if (fabs(a[r * size + k]) > fabs(a[pivot * size + k])) pivot = r;
    if (!(fabs(a[pivot * size + k]) > 1e-12 * largest)) return false;
    swap_rows(a, size, k, pivot);
    swap_rows(right, columns, k, pivot);
    for (int r = 0; r < size; ++r) {
      if (r == k) continue;
      const double factor = a[r * size + k] / a[k * size + k];
      for (int n = k; n < size; ++n) a[r * size + n] -= factor * a[k * size + n];
      for (int n = 0; n < columns; ++n) right[r * columns + n] -= factor * right[k * columns + n];
    }
  }
  for (int k = 0; k < size; ++k)
    for (int n = 0; n < columns; ++n) right[k * columns + n] /= a[k * size + k];
  return true;
}

/** Sum of products, in four partial sums, so that additions need not wait for each other. */
static double linear_product(const double *a, const double *b, int count)
{
  double sum[4] = {0};
  int k = 0;
  for (; k + 4 <= count; k += 4)
    for (int n = 0; n < 4; ++n) sum[n] += a[k + n] * b[k + n];
  for (; k < count; ++k) sum[0] += a[k] * b[k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

bool linear_factor(int size, double *a, int *begin)
{
  for (int row = 0; row < size; ++row) {
    double *at = a + (int64_t)row * size;
    int first = 0;
    while (first < row && at[first] == 0) ++first;
    begin[row] = first;
    for (int column = first; column < row; ++column) {
      const double *other = a + (int64_t)column * size;
      const int from = begin[column] > first ? begin[column] : first;
      at[column] = (at[column] - linear_product(at + from, other + from, column - from)) / other[column];
    }
    const double square = at[row] - linear_product(at + first, at + first, row - first);
    if (!(square > 0)) return false;
    at[row] = sqrt(square);
  }
  return true;
}

void linear_factor_solve(int size, const double *a, const int *begin, double *x)
{
  for (int row = 0; row < size; ++row) {
    const double *at = a + (int64_t)row * size;
    x[row] = (x[row] - linear_product(at + begin[row], x + begin[row], row - begin[row])) / at[row];
  }
  for (int row = size - 1; row >= 0; --row) {
    const double *at = a + (int64_t)row * size;
    x[row] /= at[row];
    for (int k = begin[row]; k < row; ++k) x[k] -= at[k] * x[row];
  }
}

#include "base/linear.h"

#include <math.h>

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

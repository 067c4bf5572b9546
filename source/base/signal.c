#include "base/signal.h"

#include "base/linear.h"
#include "base/memory.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/** Legendre's polynomials up to the cubic one, in which equations of least squares are well conditioned. */
static void find_basis(double x, double basis[SIGNAL_DEGREES])
{
  basis[0] = 1;
  basis[1] = x;
  basis[2] = (3 * x * x - 1) / 2;
  basis[3] = (5 * x * x - 3) * x / 2;
}

void signal_take_off(double *values, int count, int degree)
{
  const int size = degree + 1;
  double matrix[SIGNAL_DEGREES * SIGNAL_DEGREES] = {0}, right[SIGNAL_DEGREES] = {0}, basis[SIGNAL_DEGREES];
  for (int k = 0; k < count; ++k) {
    find_basis(2.0 * k / (count - 1) - 1, basis);
    for (int r = 0; r < size; ++r) {
      for (int c = 0; c < size; ++c) matrix[r * size + c] += basis[r] * basis[c];
      right[r] += basis[r] * values[k];
    }
  }
  if (!linear_solve(size, matrix, 1, right)) return;
  for (int k = 0; k < count; ++k) {
    find_basis(2.0 * k / (count - 1) - 1, basis);
    for (int r = 0; r < size; ++r) values[k] -= right[r] * basis[r];
  }
}

/** y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y'', dashes of values before. */
typedef struct Stage {
  double b[3], a[2];
} Stage;

/** The k-th stage of a filter: of two poles, or of one, which is the last of odd orders. */
static Stage stage_of(double corner, bool high, int order, int k)
{
  const double pi = acos(-1), t = tan(pi * corner);
  if (2 * k + 1 == order) {
    const double all = 1 / (1 + t), b = high ? all : t * all;
    return (Stage){{b, high ? -b : b, 0}, {(t - 1) * all, 0}};
  }
  const double damping = 2 * sin(pi * (2 * k + 1) / (2 * order)) * t, all = 1 / (1 + damping + t * t);
  const double b = high ? all : t * t * all;
  return (Stage){{b, high ? -2 * b : 2 * b, b}, {2 * (t * t - 1) * all, (1 - damping + t * t) * all}};
}

static void run_through(const Stage *s, double *values, int64_t count)
{
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  for (int64_t k = 0; k < count; ++k) {
    const double x = values[k], y = s->b[0] * x + s->b[1] * x1 + s->b[2] * x2 - s->a[0] * y1 - s->a[1] * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = values[k] = y;
  }
}

static void turn_round(double *values, int64_t count)
{
  for (int64_t k = 0; k < count / 2; ++k) {
    const double value = values[k];
    values[k] = values[count - 1 - k];
    values[count - 1 - k] = value;
  }
}

static void filter(double *values, int64_t count, double step, const Band *band)
{
  for (int k = 0; 2 * k < band->order; ++k) {
    const Stage high = stage_of(band->from * step, true, band->order, k);
    const Stage low = stage_of(band->to * step, false, band->order, k);
    if (!isnan(band->from)) run_through(&high, values, count);
    if (!isnan(band->to)) run_through(&low, values, count);
  }
}

int signal_band_pass(double *values, int count, double step, const Band *band, Error *error)
{
  const double most = 1e7, lowest = isnan(band->from) ? band->to : band->from;
  const int64_t pad = (int64_t)fmin(most, ceil(1.5 * band->order / (lowest * step))), all = count + 2 * pad;
  double *padded = memory_zeroed((size_t)all, sizeof *padded, "filter", error);
  if (!padded) return BRECCIA_FAILURE;
  memcpy(padded + pad, values, sizeof *values * (size_t)count);
  for (int way = 0; way < 2; ++way) {
    filter(padded, all, step, band);
    turn_round(padded, all);
  }
  memcpy(values, padded + pad, sizeof *values * (size_t)count);
  free(padded);
  return BRECCIA_OK;
}

#include "base/least_squares.h"

#include "base/linear.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FARTHEST = 0.3; /* step of a parameter, in parts of the box */

int least_squares_create(LeastSquares *p, Error *error)
{
  const size_t n = (size_t)p->count, k = (size_t)p->parameters;
  p->residual = memory_zeroed(n, sizeof(double), "least squares", error);
  p->trial = memory_zeroed(n, sizeof(double), "least squares", error);
  p->jacobian = memory_zeroed(n * k, sizeof(double), "least squares", error);
  p->matrix = memory_zeroed(k * k, sizeof(double), "least squares", error);
  p->step = memory_zeroed(k, sizeof(double), "least squares", error);
  p->to = memory_zeroed(k, sizeof(double), "least squares", error);
  p->movable = memory_zeroed(k, sizeof(int), "least squares", error);
  return p->residual && p->trial && p->jacobian && p->matrix && p->step && p->to && p->movable ? BRECCIA_OK
                                                                                               : BRECCIA_FAILURE;
}

void least_squares_destroy(LeastSquares *p)
{
  double *const own[] = {p->residual, p->trial, p->jacobian, p->matrix, p->step, p->to};
  for (size_t k = 0; k < sizeof own / sizeof *own; ++k) free(own[k]);
  free(p->movable);
  *p = (LeastSquares){0};
}

static double product(const double *a, const double *b, int count)
{
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

/** Derivatives by differences of a step h, to the side where the box and the residuals allow it; a parameter without either side gets
 *  none. `residual` holds the residuals at the place. */
static void differentiate(LeastSquares *p, const double *at, double h)
{
  memcpy(p->to, at, sizeof(double) * (size_t)p->parameters);
  for (int k = 0; k < p->parameters; ++k) {
    double *column = p->jacobian + (size_t)p->count * (size_t)k, side = at[k] + h > 1 ? -h : h;
    bool found = false;
    for (int attempt = 0; attempt < 2 && !found; ++attempt, side = -side) {
      p->to[k] = at[k] + side;
      found = p->to[k] >= 0 && p->to[k] <= 1 && p->residuals(p->context, p->to, p->trial);
      for (int i = 0; found && i < p->count; ++i) column[i] = (p->trial[i] - p->residual[i]) / side;
    }
    if (!found) memset(column, 0, sizeof(double) * (size_t)p->count);
    p->to[k] = at[k];
  }
}

/** The damped step of the parameters that are free to move, into `to`. @return how far it goes, or a negative number */
static double aim(LeastSquares *p, const double *at, double damping)
{
  int *const movable = p->movable, count = 0;
  for (int k = 0; k < p->parameters; ++k) {
    const double slope = -product(p->jacobian + (size_t)p->count * (size_t)k, p->residual, p->count);
    p->to[k] = at[k];
    if ((at[k] <= 0 && slope < 0) || (at[k] >= 1 && slope > 0)) continue;
    p->step[count] = slope;
    movable[count++] = k;
  }
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) {
      const double square = product(p->jacobian + (size_t)p->count * (size_t)movable[a],
                                    p->jacobian + (size_t)p->count * (size_t)movable[b], p->count);
      /* A touch more keeps parameters that do nothing where they are. */
      p->matrix[count * a + b] = a == b ? square * (1 + damping) + 1e-9 + 1e-6 * damping : square;
    }
  if (!count || !linear_solve(count, p->matrix, 1, p->step)) return -1;
  double farthest = 0;
  for (int a = 0; a < count; ++a) {
    const double step = fmax(-FARTHEST, fmin(FARTHEST, p->step[a]));
    p->to[movable[a]] = fmin(1, fmax(0, at[movable[a]] + step));
    farthest = fmax(farthest, fabs(p->to[movable[a]] - at[movable[a]]));
  }
  return farthest;
}

double least_squares_descend(LeastSquares *p, double *at)
{
  enum { MOST_ITERATIONS = 40, MOST_DAMPINGS = 8, FIRST_COARSE = 4 };
  const size_t size = sizeof(double) * (size_t)p->count;
  if (!p->residuals(p->context, at, p->residual)) return INFINITY;
  double sum = product(p->residual, p->residual, p->count), damping = 1e-3;
  for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
    const double before = sum;
    double moved = 0;
    bool better = false;
    differentiate(p, at, iteration < FIRST_COARSE ? 1e-3 : 1e-5);
    for (int attempt = 0; attempt < MOST_DAMPINGS && !better; ++attempt) {
      moved = aim(p, at, damping);
      const bool there = moved >= 0 && p->residuals(p->context, p->to, p->trial);
      const double now = there ? product(p->trial, p->trial, p->count) : INFINITY;
      better = now < sum;
      damping = better ? fmax(1e-9, damping / 5) : damping * 6;
      if (!better) continue;
      sum = now;
      memcpy(at, p->to, sizeof(double) * (size_t)p->parameters);
      memcpy(p->residual, p->trial, size);
    }
    if (!better || (before - sum < 2e-5 * before && moved < 1e-4) || sum < 1e-18 * p->count) break;
  }
  return sum;
}

void least_squares_curvature(LeastSquares *p, const double *at, double *matrix)
{
  if (!p->residuals(p->context, at, p->residual)) return;
  differentiate(p, at, 1e-4);
  for (int a = 0; a < p->parameters; ++a)
    for (int b = 0; b < p->parameters; ++b)
      matrix[p->parameters * a + b] =
          product(p->jacobian + (size_t)p->count * (size_t)a, p->jacobian + (size_t)p->count * (size_t)b, p->count);
}

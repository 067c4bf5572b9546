/* Moving least squares of first order (Lancaster and Salkauskas 1981, Math. Comp. 37, 141): of all linear functions the one that is nearest to the
 * displacements around, weighed by a kernel, taken at the point. Its weights are w_i p_i . M^-1 p(0) with p = (1, x_i - x) and M = sum w_i p_i p_i^T. */
#include "bars/bars.h"

#include <math.h>
#include <string.h>

/* Radius of the kernel in spacings: 1.75 where particles are all around; more where they are on one side only. */
static const double radii[] = {1.75, 2, 2.5, 3};
/* Spread of the particles in a direction, in spacings squared, below which they say too little of it; below the second one they say nothing of it. */
static const double enough = 0.01, none = 1e-9;

bool bar_weights_add(BarWeights *w, int32_t place, double weight)
{
  if (w->count == w->capacity) {
    const int64_t wanted = w->capacity ? 2 * w->capacity : 64;
    int32_t *places = memory_grown(w->place, (size_t)wanted, sizeof *places);
    if (places) w->place = places;
    double *weights = memory_grown(w->weight, (size_t)wanted, sizeof *weights);
    if (weights) w->weight = weights;
    if (!places || !weights) return false;
    w->capacity = wanted;
  }
  w->place[w->count] = place;
  w->weight[w->count++] = weight;
  return true;
}

/** Particles within a radius, no cut between, with the values of the kernel. Those outside the body, beyond supports, are nobody's to pull on. */
static bool gather(BarWeights *w, const Body *body, const Cells *cells, const double point[3], double radius)
{
  const Particles *p = &body->particles;
  int64_t rows[9][2];
  w->count = 0;
  const int row_count = cells_around(cells, point, rows);
  for (int r = 0; r < row_count; ++r)
    for (int64_t n = rows[r][0]; n < rows[r][1]; ++n) {
      const double *x = cells->position + 3 * n;
      const double square = (x[0] - point[0]) * (x[0] - point[0]) + (x[1] - point[1]) * (x[1] - point[1]) +
                            (x[2] - point[2]) * (x[2] - point[2]);
      const double left = 1 - square / (radius * radius);
      if (left <= 0 || body_outside(body, p->number[cells->places[n]])) continue;
      if (body->crack_count && body_cuts(body, point, x)) continue;
      if (!bar_weights_add(w, cells->places[n], left * left)) return false;
    }
  return true;
}

/** M^-1 of (1, 0, 0, 0), by L D L^T; what the particles say nothing of is left out. @return the smallest spread of them in any direction */
static double solve(double m[4][4], int size, double x[4])
{
  double least = INFINITY, lower[4][4] = {{0}}, pivot[4] = {0};
  const double total = m[0][0];
  for (int c = 0; c < size; ++c) {
    pivot[c] = m[c][c];
    for (int k = 0; k < c; ++k) pivot[c] -= lower[c][k] * lower[c][k] * pivot[k];
    if (c) least = fmin(least, pivot[c] / total);
    for (int r = c + 1; r < size; ++r) {
      lower[r][c] = m[r][c];
      for (int k = 0; k < c; ++k) lower[r][c] -= lower[r][k] * lower[c][k] * pivot[k];
      lower[r][c] = pivot[c] > none * total ? lower[r][c] / pivot[c] : 0;
    }
    if (!(pivot[c] > none * total)) pivot[c] = INFINITY;
  }
  for (int r = 0; r < size; ++r) {
    x[r] = r == 0;
    for (int k = 0; k < r; ++k) x[r] -= lower[r][k] * x[k];
  }
  for (int r = 0; r < size; ++r) x[r] /= pivot[r];
  for (int r = size - 1; r >= 0; --r)
    for (int k = r + 1; k < size; ++k) x[r] -= lower[k][r] * x[k];
  return least;
}

bool bar_weigh(BarWeights *w, const Body *body, const Cells *cells, const double point[3])
{
  enum { RADII = sizeof radii / sizeof *radii };
  const Particles *p = &body->particles;
  const int size = body->dimensions + 1;
  double x[4];
  const int32_t near = body_nearest(body, point);
  const double spacing = body->lattices[p->block[near / SLICE]].spacing;
  for (int r = 0; r < RADII; ++r) {
    double m[4][4] = {{0}};
    if (!gather(w, body, cells, point, radii[r] * spacing)) return false;
    for (int64_t n = 0; n < w->count; ++n) {
      double basis[4] = {1};
      for (int k = 0; k < size - 1; ++k) basis[k + 1] = (p->position[k][w->place[n]] - point[k]) / spacing;
      for (int a = 0; a < size; ++a)
        for (int b = 0; b < size; ++b) m[a][b] += w->weight[n] * basis[a] * basis[b];
    }
    if (w->count && solve(m, size, x) > enough) break;
  }
  if (!w->count) return bar_weights_add(w, near, 1);
  for (int64_t n = 0; n < w->count; ++n) {
    double sum = x[0];
    for (int k = 0; k < size - 1; ++k) sum += x[k + 1] * (p->position[k][w->place[n]] - point[k]) / spacing;
    w->weight[n] *= sum;
  }
  return true;
}

/* Weights with which a lattice is isotropic. The shear modulus that a family shows follows from the sum of w |xi|^2 n n n n over its bonds. On a lattice
 * that depends on the direction: with constant influence and 3.015 spacings it is 0.835 of the wanted one in stretching along the axes of a cubic
 * lattice, and 1.110 in shear along them. The mean is right, so that no constant can mend it. As built every bond of a lattice gets a factor 1 + h(n),
 * h a polynomial of the fourth order of its direction, the smallest (least squares, weighted by w |xi|^2) with which the sum is isotropic. All such
 * factors are alike for a bond and its reverse. */
#include "formulation/ordinary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 15 };

/** Products n_x^a n_y^b n_z^c of the fourth order less their means over all directions. @return how many */
static int directions(const Pattern *p, int dimensions, double h[MOST_TERMS])
{
  static const double mean[5] = {1, 0, 1, 0,
                                 3}; /* of n^k over directions, times d (d + 2) for the fourth order in all */
  int count = 0;
  for (int a = 0; a <= 4; ++a)
    for (int b = 0; b <= 4 - a; ++b) {
      const int c = 4 - a - b;
      if (dimensions == 2 && c) continue;
      const double product = pow(p->xi[0], a) * pow(p->xi[1], b) * pow(p->xi[2], c) / pow(p->length, 4);
      h[count++] = product - mean[a] * mean[b] * mean[c] / (dimensions * (dimensions + 2));
    }
  return count;
}

/** Solves a x = r for a matrix that is symmetric and not negative, and r in its range; x is 0 where a pivot would be nothing. */
static void solve(int count, double a[MOST_TERMS][MOST_TERMS], const double r[MOST_TERMS], double x[MOST_TERMS])
{
  int order[MOST_TERMS], rank = 0;
  double right[MOST_TERMS], first = 0;
  memcpy(right, r, sizeof right);
  for (int k = 0; k < count; ++k) order[k] = k;
  for (; rank < count; ++rank) {
    int best = rank;
    for (int k = rank; k < count; ++k)
      if (a[order[k]][order[k]] > a[order[best]][order[best]]) best = k;
    const int pivot = order[best];
    if (!rank) first = a[pivot][pivot];
    if (!(a[pivot][pivot] > 1e-10 * first)) break;
    order[best] = order[rank];
    order[rank] = pivot;
    for (int k = rank + 1; k < count; ++k) {
      const int row = order[k];
      const double factor = a[row][pivot] / a[pivot][pivot];
      for (int j = 0; j < count; ++j) a[row][j] -= factor * a[pivot][j];
      right[row] -= factor * right[pivot];
    }
  }
  memset(x, 0, sizeof *x * MOST_TERMS);
  for (int k = rank - 1; k >= 0; --k) {
    const int row = order[k];
    x[row] = right[row];
    for (int j = k + 1; j < rank; ++j) x[row] -= a[row][order[j]] * x[order[j]];
    x[row] /= a[row][row];
  }
}

void ordinary_balance(const Ordinary *o, int block)
{
  enum { HARDLY = 10 }; /* a factor below one over this would leave a bond hardly any part */
  const Family *f = o->family;
  double a[MOST_TERMS][MOST_TERMS] = {{0}}, r[MOST_TERMS] = {0}, x[MOST_TERMS], h[MOST_TERMS];
  int count = 0;
  double least = 1;
  for (int p = f->pattern_begin[block]; p < f->pattern_begin[block + 1]; ++p) {
    const Pattern *pattern = &f->patterns[p];
    const double moment = pattern->weight * pattern->length * pattern->length;
    count = directions(pattern, o->dimensions, h);
    for (int i = 0; i < count; ++i) {
      r[i] -= moment * h[i];
      for (int j = 0; j < count; ++j) a[i][j] += moment * h[i] * h[j];
    }
  }
  solve(count, a, r, x);
  for (int p = f->pattern_begin[block]; p < f->pattern_begin[block + 1]; ++p) {
    directions(&f->patterns[p], o->dimensions, h);
    for (int i = 0; i < count; ++i) o->factor[p] += x[i] * h[i];
    least = fmin(least, o->factor[p]);
  }
  for (int p = f->pattern_begin[block]; least < 1. / HARDLY && p < f->pattern_begin[block + 1]; ++p) o->factor[p] = 1;
}

double ordinary_lattice_shear(const Ordinary *o, int block, const double e[6])
{
  const Family *f = o->family;
  double sum = 0, moment = 0, square = 0;
  for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * e[k] * e[k];
  for (int p = f->pattern_begin[block]; p < f->pattern_begin[block + 1]; ++p) {
    const Pattern *pattern = &f->patterns[p];
    const double *xi = pattern->xi, weight = pattern->weight * o->factor[p];
    double along = 0; /* xi . e xi */
    for (int k = 0; k < 3; ++k) along += e[k] * xi[k] * xi[k] + 2 * e[3 + k] * xi[k] * xi[(k + 1) % 3];
    sum += weight * along * along / (pattern->length * pattern->length);
    moment += weight * pattern->length * pattern->length;
  }
  return o->dimensions * (o->dimensions + 2) / 2.0 * sum / (moment * square);
}

#include "solver/coarse_frame.h"

#include "base/tensor.h"
#include <complex.h>
#include <math.h>
#include <string.h>

/* Difference of two moments over their sum below which the moments count as equal. */
static const double frame_roundings = 1e-6;

/** Finds the centre of volume [length]. */
static void frame_find_centre(const Particles *p, double centre[3])
{
  double volume = 0, sum[3] = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    volume += p->volume[i];
    for (int k = 0; k < 3; ++k) sum[k] += p->volume[i] * p->position[k][i];
  }
  for (int k = 0; k < 3; ++k) centre[k] = sum[k] / volume;
}

/** Computes the second moments of volume about a point. */
static void frame_find_moments(const Particles *p, const double centre[3], double moments[6])
{
  memset(moments, 0, 6 * sizeof *moments);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x[3];
    for (int k = 0; k < 3; ++k) x[k] = p->position[k][i] - centre[k];
    for (int r = 0; r < 3; ++r)
      for (int s = r; s < 3; ++s) moments[symmetric_place[3 * r + s]] += p->volume[i] * x[r] * x[s];
  }
}

/** Turns two axes in their plane to the principal axes of the second moments, or to those of the fourth moments if the
 *  second moments are equal; leaves the axes if the fourth moments are equal, too. With z = x + i y along the two axes,
 *  the arguments of the sums of V z^2 and V z^4 are two and four times the angle of the body. */
static void frame_turn_in_plane(const Particles *p, const double centre[3], double first[3], double second[3])
{
  double complex sums[2] = {0};
  double sizes[2] = {0};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x = 0, y = 0;
    for (int k = 0; k < 3; ++k) {
      x += first[k] * (p->position[k][i] - centre[k]);
      y += second[k] * (p->position[k][i] - centre[k]);
    }
    const double complex square = (x + I * y) * (x + I * y);
    const double size = x * x + y * y;
    sums[0] += p->volume[i] * square;
    sums[1] += p->volume[i] * square * square;
    sizes[0] += p->volume[i] * size;
    sizes[1] += p->volume[i] * size * size;
  }
  for (int k = 0; k < 2; ++k) {
    if (!(cabs(sums[k]) > frame_roundings * sizes[k])) continue;
    const double angle = carg(sums[k]) / (k ? 4 : 2), c = cos(angle), s = sin(angle);
    for (int j = 0; j < 3; ++j) {
      const double x = first[j], y = second[j];
      first[j] = c * x + s * y;
      second[j] = c * y - s * x;
    }
    return;
  }
}

/** Finds the axes of a body in space; leaves them if all second moments are equal.
 *  @param[in,out] axes  those of the deck before */
static void frame_find_in_space(const Particles *p, const double centre[3], double axes[9])
{
  double moments[6], value[3], vector[9], sum = 0;
  frame_find_moments(p, centre, moments);
  tensor_eigen(moments, value, vector);
  for (int k = 0; k < 3; ++k) sum += fabs(value[k]);
  bool alike[3]; /* the k-th second moment and the next are equal */
  int pairs = 0;
  for (int k = 0; k < 3; ++k) {
    alike[k] = fabs(value[k] - value[(k + 1) % 3]) <= frame_roundings * sum;
    pairs += alike[k];
  }
  if (pairs > 1) return;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) axes[3 * k + j] = vector[3 * j + k];
  for (int k = 0; k < 3; ++k)
    if (alike[k]) frame_turn_in_plane(p, centre, axes + 3 * k, axes + 3 * ((k + 1) % 3));
}

void coarse_frame_find(const Particles *p, int dimensions, double centre[3], double axes[9])
{
  for (int k = 0; k < 9; ++k) axes[k] = k % 4 == 0;
  frame_find_centre(p, centre);
  if (dimensions == 2) frame_turn_in_plane(p, centre, axes, axes + 3);
  if (dimensions == 3) frame_find_in_space(p, centre, axes);
}

/* Orientations of places in space, a vector of places at a time; particles_orientation does the same of one. */
#ifndef BRECCIA_BODY_ORIENTATION_H
#define BRECCIA_BODY_ORIENTATION_H

#include "body/particles.h"

LANES_INLINE void cross_lanes(const Lanes a[3], const Lanes b[3], Lanes c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE Lanes dot_lanes(const Lanes a[3], const Lanes b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Unit quaternions, but for roundings, of places from `place` on: of `orientation` and the rotation since, in three rows. */
LANES_INLINE void turned_by(double *const orientation[4], double *const *rotation, int64_t place, Lanes q[4])
{
  Lanes turn[3], o[4], across[3], square = lanes_set(0), sine, cosine;
  for (int k = 0; k < 4; ++k) o[k] = lanes_load(orientation[k] + place);
  for (int k = 0; k < 3; ++k) {
    turn[k] = lanes_load(rotation[k] + place);
    square += turn[k] * turn[k];
  }
  const Lanes half = lanes_set(0.5) * lanes_root(square);
  const LaneMask small = (LaneMask)(half < lanes_set(1e-4));
  lanes_sine_cosine(half, &sine, &cosine);
  const Lanes share = lanes_choose(small, lanes_set(0.5) - half * half * lanes_set(1.0 / 12),
                                   lanes_set(0.5) * sine / lanes_choose(small, lanes_set(1), half));
  for (int k = 0; k < 3; ++k) turn[k] *= share;
  q[0] = cosine * o[0] - dot_lanes(turn, o + 1);
  cross_lanes(turn, o + 1, across);
  for (int k = 0; k < 3; ++k) q[1 + k] = cosine * o[1 + k] + turn[k] * o[0] + across[k];
}

#endif

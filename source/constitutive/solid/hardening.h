/* Isotropic hardening that grows on a line and towards a saturation: Y(x) = Y0 + gain (1 - exp(-rate x)) + modulus x, with the equivalent plastic
 * strain x, dx = sqrt(2/3) dg. */
#ifndef BRECCIA_CONSTITUTIVE_HARDENING_H
#define BRECCIA_CONSTITUTIVE_HARDENING_H

#include "base/lanes.h"
#include "constitutive/solid/solid_law.h"

typedef struct Hardening {
  double first, gain, rate, modulus;
} Hardening;

static inline double hardening_strength(const Hardening *h, double x, double *slope)
{
  const double fall = h->gain > 0 ? h->gain * exp(-h->rate * x) : 0;
  *slope = h->rate * fall + h->modulus;
  return h->first + h->gain - fall + h->modulus * x;
}

/** sqrt(2/3) times a strength that is reached at least. */
LANES_INLINE Lanes hardening_least(const Hardening *h, Lanes x)
{
  return lanes_set(root23) * (lanes_set(h->first) + lanes_set(h->modulus) * x);
}

/** Multiplier g >= 0 of excess - stiffness g = sqrt(2/3) (Y(x + sqrt(2/3) g) - Y(x)); Newton's method never overshoots, because Y is concave.
 *  @param[out] strength, slope  of Y at the end */
static inline double hardening_multiplier(const Hardening *h, double excess, double stiffness, double x,
                                          double *strength, double *slope)
{
  const double before = hardening_strength(h, x, slope);
  double flow = 0;
  *strength = before;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double step = (excess - stiffness * flow - root23 * (*strength - before)) / (stiffness + 2 * *slope / 3);
    flow += step;
    *strength = hardening_strength(h, x + root23 * flow, slope);
    if (fabs(step) <= 1e-15 * flow) break;
  }
  return flow;
}

#endif

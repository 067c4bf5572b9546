/* Isotropic hardening that grows on a line and towards a saturation: Y(x) = Y0 + gain (1 - exp(-rate x)) + modulus x, with the equivalent plastic
 * strain x, dx = sqrt(2/3) dg. */
#ifndef BRECCIA_CONSTITUTIVE_HARDENING_H
#define BRECCIA_CONSTITUTIVE_HARDENING_H

#include "constitutive/solid/solid_lanes.h"

typedef struct Hardening {
  double first, gain, rate, modulus;
} Hardening;

/** What saturation has not given yet. */
LANES_INLINE Lanes hardening_left(const Hardening *h, Lanes x)
{
  return lanes_product(lanes_set(h->gain), lanes_exponential(lanes_set(-h->rate) * x));
}

LANES_INLINE Lanes hardening_strength(const Hardening *h, Lanes x)
{
  return (lanes_set(h->first + h->gain) - hardening_left(h, x)) + lanes_set(h->modulus) * x;
}

/** sqrt(2/3) times a strength that is reached at least. */
LANES_INLINE Lanes hardening_least(const Hardening *h, Lanes x)
{
  return lanes_set(root23) * (lanes_set(h->first) + lanes_set(h->modulus) * x);
}

/** Multiplier g >= 0 of excess - stiffness g = sqrt(2/3) (Y(x + sqrt(2/3) g) - Y(x)); Newton's method never overshoots, because Y is concave. It is 0 where
 *  the excess is not positive.
 *  @param[out] grown, slope  Y(x + sqrt(2/3) g) - Y(x), and the slope of Y there */
LANES_INLINE Lanes hardening_multiplier(const Hardening *h, Lanes excess, double stiffness, Lanes x, Lanes *grown,
                                        Lanes *slope)
{
  enum { MOST_ITERATIONS = 100 };
  const Lanes left = hardening_left(h, x), stiff = lanes_set(stiffness);
  excess = lanes_where(excess > lanes_set(0), excess);
  Lanes flow = lanes_set(0);
  LaneMask ended = {0};
  *grown = lanes_set(0);
  *slope = lanes_set(h->rate) * left + lanes_set(h->modulus);
  for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
    const Lanes step = ((excess - stiff * flow) - lanes_set(root23) * *grown) / (stiff + lanes_set(2.0 / 3) * *slope);
    flow = lanes_choose(ended, flow, flow + step);
    const Lanes further = lanes_product(lanes_set(root23), flow),
                fade = lanes_exponential_less_one(lanes_set(-h->rate) * further);
    *grown = lanes_set(h->modulus) * further - lanes_product(left, fade);
    *slope = lanes_set(h->rate) * (left + lanes_product(left, fade)) + lanes_set(h->modulus);
    ended |= ~(lanes_absolute(step) > lanes_set(1e-15) * flow);
    if (!lanes_any(~ended)) break;
  }
  return flow;
}

#endif

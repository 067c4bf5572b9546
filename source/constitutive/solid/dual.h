/* Numbers that carry their derivatives to a few variables, side by side, for laws with long formulas. How many variables count is said where numbers are
 * worked with, by a constant: with none only values are computed. */
#ifndef BRECCIA_CONSTITUTIVE_DUAL_H
#define BRECCIA_CONSTITUTIVE_DUAL_H

#include "base/lanes.h"

enum { DUAL_VARIABLES = 4 };

/* Slopes from `first` to before `end` count; the others are zero. */
typedef struct DualSlopes {
  int first, end;
} DualSlopes;

typedef struct Dual {
  Lanes value, slope[DUAL_VARIABLES];
} Dual;

/* Products are rounded by themselves (lanes_product), so that the bits are the same whatever they are added to. Unrolled early, so that the numbers of a struct become registers. */
#define DUAL_EACH(n, k)                                                                                                \
  _Pragma("GCC unroll 4") for (int k = 0; k < DUAL_VARIABLES; ++k) if (k >= (n).first && k < (n).end)

/* Slope by slope: cleared as a whole, gcc keeps it in memory. */
LANES_INLINE Dual dual_constant(Lanes value)
{
  Dual x;
  x.value = value;
  x.slope[0] = x.slope[1] = x.slope[2] = x.slope[3] = lanes_set(0);
  return x;
}

LANES_INLINE Dual dual_variable(Lanes value, int which)
{
  Dual x = dual_constant(value);
  x.slope[which] = lanes_set(1);
  return x;
}

/** f(x) from its value and derivative. */
LANES_INLINE Dual dual_of(DualSlopes n, Lanes value, Lanes to_x, Dual x)
{
  Dual f = dual_constant(value);
  DUAL_EACH(n, k) f.slope[k] = lanes_product(to_x, x.slope[k]);
  return f;
}

/** f(x, y) from its value and partial derivatives. */
LANES_INLINE Dual dual_chain(DualSlopes n, Lanes value, Lanes to_x, Dual x, Lanes to_y, Dual y)
{
  Dual f = dual_constant(value);
  DUAL_EACH(n, k) f.slope[k] = lanes_product(to_x, x.slope[k]) + to_y * y.slope[k];
  return f;
}

LANES_INLINE Dual dual_add(DualSlopes n, Dual x, Dual y)
{
  x.value += y.value;
  DUAL_EACH(n, k) x.slope[k] += y.slope[k];
  return x;
}

/** Returns x + b y. The product is rounded by itself: where a mask selects the sum, gcc adds under the mask of AVX-512
 *  and fuses no product with it. */
LANES_INLINE Dual dual_sum(DualSlopes n, Dual x, double b, Dual y)
{
  x.value += lanes_product(lanes_set(b), y.value);
  DUAL_EACH(n, k) x.slope[k] += lanes_product(lanes_set(b), y.slope[k]);
  return x;
}
LANES_INLINE Dual dual_scale(DualSlopes n, double a, Dual x)
{
  return dual_of(n, lanes_product(lanes_set(a), x.value), lanes_set(a), x);
}
LANES_INLINE Dual dual_shift(Dual x, double a)
{
  x.value += lanes_set(a);
  return x;
}
/** 1 - x */
LANES_INLINE Dual dual_rest(DualSlopes n, Dual x)
{
  x.value = lanes_set(1) - x.value;
  DUAL_EACH(n, k) x.slope[k] = -x.slope[k];
  return x;
}
LANES_INLINE Dual dual_product(DualSlopes n, Dual x, Dual y)
{
  return dual_chain(n, lanes_product(x.value, y.value), y.value, x, x.value, y);
}
/** x times the variable `which`, on which x does not depend. */
LANES_INLINE Dual dual_times_variable(DualSlopes n, Dual x, Lanes value, int which)
{
  Dual f = dual_constant(lanes_product(value, x.value));
  DUAL_EACH(n, k) f.slope[k] = k == which ? x.value : lanes_product(value, x.slope[k]);
  return f;
}
LANES_INLINE Dual dual_quotient(DualSlopes n, Dual x, Dual y)
{
  const Lanes inverse = lanes_set(1) / y.value, value = lanes_product(x.value, inverse);
  return dual_chain(n, value, inverse, x, -value * inverse, y);
}
LANES_INLINE Dual dual_exponential(DualSlopes n, Dual x)
{
  const Lanes value = lanes_exponential(x.value);
  return dual_of(n, value, value, x);
}
LANES_INLINE Dual dual_logarithm(DualSlopes n, Dual x)
{
  return dual_of(n, lanes_logarithm(x.value), lanes_set(1) / x.value, x);
}
LANES_INLINE Dual dual_root(DualSlopes n, Dual x)
{
  const Lanes root = lanes_root(x.value), zero = lanes_set(0);
  const LaneMask positive = root > zero;
  return dual_of(n, root, lanes_where(positive, lanes_set(0.5) / lanes_choose(positive, root, lanes_set(1))), x);
}
/** x where the mask is set, y elsewhere. */
LANES_INLINE Dual dual_choose(DualSlopes n, LaneMask mask, Dual x, Dual y)
{
  Dual f = dual_constant(lanes_choose(mask, x.value, y.value));
  DUAL_EACH(n, k) f.slope[k] = lanes_choose(mask, x.slope[k], y.slope[k]);
  return f;
}
/** x where the mask is set, 0 elsewhere. */
LANES_INLINE Dual dual_where(DualSlopes n, LaneMask mask, Dual x)
{
  x.value = lanes_where(mask, x.value);
  DUAL_EACH(n, k) x.slope[k] = lanes_where(mask, x.slope[k]);
  return x;
}
/** x if it is positive, otherwise 0. */
LANES_INLINE Dual dual_positive(DualSlopes n, Dual x)
{
  return dual_where(n, x.value > lanes_set(0), x);
}
LANES_INLINE Dual dual_absolute(DualSlopes n, Dual x)
{
  const LaneMask sign = (LaneMask)(x.value < lanes_set(0)) & (LaneMask)lanes_set(-0.0);
  x.value = (Lanes)((LaneMask)x.value ^ sign);
  DUAL_EACH(n, k) x.slope[k] = (Lanes)((LaneMask)x.slope[k] ^ sign);
  return x;
}
LANES_INLINE Dual dual_smaller(DualSlopes n, Dual x, Dual y)
{
  return dual_choose(n, x.value <= y.value, x, y);
}
LANES_INLINE Dual dual_larger(DualSlopes n, Dual x, Dual y)
{
  return dual_choose(n, x.value >= y.value, x, y);
}

#endif

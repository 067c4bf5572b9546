/* Numbers that carry their derivatives to four variables, for tangents of laws with long formulas. */
#ifndef BRECCIA_CONSTITUTIVE_DUAL_H
#define BRECCIA_CONSTITUTIVE_DUAL_H

#include <math.h>

enum { DUAL_VARIABLES = 4 };

typedef struct Dual {
  double value, slope[DUAL_VARIABLES];
} Dual;

static inline Dual dual_constant(double value)
{
  return (Dual){value, {0}};
}

static inline Dual dual_variable(double value, int which)
{
  Dual x = {value, {0}};
  x.slope[which] = 1;
  return x;
}

/** f(x, y) from its value and partial derivatives. */
static inline Dual dual_chain(double value, double to_x, Dual x, double to_y, Dual y)
{
  Dual f = {value, {0}};
  for (int k = 0; k < DUAL_VARIABLES; ++k) f.slope[k] = to_x * x.slope[k] + to_y * y.slope[k];
  return f;
}

static inline Dual dual_sum(double a, Dual x, double b, Dual y)
{
  return dual_chain(a * x.value + b * y.value, a, x, b, y);
}
static inline Dual dual_scale(double a, Dual x)
{
  return dual_sum(a, x, 0, x);
}
static inline Dual dual_shift(Dual x, double a)
{
  x.value += a;
  return x;
}
static inline Dual dual_product(Dual x, Dual y)
{
  return dual_chain(x.value * y.value, y.value, x, x.value, y);
}
static inline Dual dual_quotient(Dual x, Dual y)
{
  return dual_chain(x.value / y.value, 1 / y.value, x, -x.value / (y.value * y.value), y);
}
static inline Dual dual_exp(Dual x)
{
  return dual_chain(exp(x.value), exp(x.value), x, 0, x);
}
static inline Dual dual_sqrt(Dual x)
{
  const double root = sqrt(x.value);
  return dual_chain(root, root > 0 ? 0.5 / root : 0, x, 0, x);
}
/** x if it is positive, otherwise 0. */
static inline Dual dual_positive(Dual x)
{
  return x.value > 0 ? x : dual_constant(0);
}
static inline Dual dual_absolute(Dual x)
{
  return x.value < 0 ? dual_scale(-1, x) : x;
}
static inline Dual dual_larger(Dual x, Dual y)
{
  return x.value >= y.value ? x : y;
}

#endif

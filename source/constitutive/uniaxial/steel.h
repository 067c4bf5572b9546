/* What steel laws along one direction share: their constants, and isotropic hardening as a shift of the yield lines that grows with
 * the range of strains (Filippou, Popov and Bertero 1983). */
#ifndef BRECCIA_CONSTITUTIVE_UNIAXIAL_STEEL_H
#define BRECCIA_CONSTITUTIVE_UNIAXIAL_STEEL_H

#include "constitutive/uniaxial/uniaxial_law.h"

enum {
  STEEL_YOUNG,
  STEEL_YIELD,
  STEEL_RATIO,
  STEEL_COMPRESSION_SHIFT,
  STEEL_COMPRESSION_RANGE,
  STEEL_TENSION_SHIFT,
  STEEL_TENSION_RANGE,
  STEEL_PARAMETERS
};

#define STEEL_PARAMETER_ROWS                                                                                           \
  {"Young modulus", "stress", NULL, "(0, inf)", "E"}, {"yield stress", "stress", NULL, "(0, inf)", "f_y"},             \
      {"hardening ratio", "1", "0.01", "[0, 1)", "b, slope after yield over E"},                                       \
      {"compression shift", "1", "0", "[0, inf)", "a1, growth of the yield line in compression"},                      \
      {"compression range", "1", "1", "(0, inf)", "a2, range of strains over 2 f_y / E at which that growth is a1"},   \
      {"tension shift", "1", "0", "[0, inf)", "a3, growth of the yield line in tension"},                              \
  {                                                                                                                    \
    "tension range", "1", "1", "(0, inf)", "a4, range of strains over 2 f_y / E at which that growth is a3"            \
  }

typedef struct Steel {
  double young, yield, ratio, shift[2], range[2]; /* in compression, in tension */
} Steel;

static inline void steel_prepare(Steel *c, const double *v)
{
  *c = (Steel){v[STEEL_YOUNG],
               v[STEEL_YIELD],
               v[STEEL_RATIO],
               {v[STEEL_COMPRESSION_SHIFT], v[STEEL_TENSION_SHIFT]},
               {v[STEEL_COMPRESSION_RANGE], v[STEEL_TENSION_RANGE]}};
}

/** Yield line over f_y after strains have run from `low` to `high`. */
static inline double steel_shift(const Steel *c, int tension, double low, double high)
{
  if (c->shift[tension] == 0) return 1;
  return 1 + c->shift[tension] * pow((high - low) / (2 * c->range[tension] * c->yield / c->young), 0.8);
}

#endif

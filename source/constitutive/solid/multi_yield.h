/* Multi-yield-surface J2 plasticity: what its parameters become, and a point's history (multi_yield_j2.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_MULTI_YIELD_H
#define BRECCIA_CONSTITUTIVE_MULTI_YIELD_H

#include "constitutive/law.h"

#include <math.h>

enum { MOST_SURFACES = 60 };

/** Surfaces 1 (innermost) to `surfaces`; flow, ratio and step_down are the same at any confinement. */
typedef struct MultiYield {
  double shear, bulk;
  int surfaces;
  double radius[MOST_SURFACES + 1];    /* largest |s - centre| */
  double flow[MOST_SURFACES + 1];      /* 2 G / (2 G + H'), H' the plastic modulus */
  double ratio[MOST_SURFACES + 1];     /* of the radius to that of the next surface */
  double step_down[MOST_SURFACES + 1]; /* what part of H' the next surface inside has beyond that of this one */
  double residual_pressure, reference_pressure, exponent;
  int frictional;
} MultiYield;

/* A row of history: this head; with friction two scales, of moduli and radii; then the centres of surfaces 1 .. N-1 (the outermost never
 * moves). Deviators are five numbers, xx yy xy yz zx. LOW .. HIGH: surfaces whose centres this row holds otherwise than the row it came
 * from. All these centres are needed: each reversal leaves the surfaces inside the active one in a row of their own direction, and as many
 * reversals can nest as there are surfaces. */
enum { DEVIATOR_VALUES = 5 };
enum { DEVIATOR = 0, PRESSURE = DEVIATOR_VALUES, STRAIN, ACTIVE = STRAIN + 6, LOW, HIGH, BEGUN, HEAD };

static inline int multi_yield_scales(const MultiYield *c)
{
  return c->frictional ? 2 : 0;
}

/** `history_values` of the law. */
static inline int multi_yield_history_values(const void *constants)
{
  const MultiYield *c = constants;
  return HEAD + multi_yield_scales(c) + DEVIATOR_VALUES * (c->surfaces - 1);
}

/** `update` of the law. */
int multi_yield_update(const void *constants, const breccia_batch *batch);

#endif

/* What laws of a point in space share: elastic constants from either pair, one point at a time out of a batch, deviators and
 * tangents of laws that return along the trial deviator.
 *
 * Symmetric tensors are six numbers, xx yy zz xy yz zx, with shear components as of a tensor (half the engineering strain). */
#ifndef BRECCIA_CONSTITUTIVE_SOLID_LAW_H
#define BRECCIA_CONSTITUTIVE_SOLID_LAW_H

#include "base/tensor.h"
#include "constitutive/law.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* ---- elastic constants: the first four parameters of a law ---- */

enum { ELASTIC_YOUNG, ELASTIC_POISSON, ELASTIC_BULK, ELASTIC_SHEAR, ELASTIC_PARAMETERS };

#define ELASTIC_PARAMETER_ROWS                                                                                         \
  {"Young modulus", "stress", "", "(0, inf)", "E; goes with the Poisson ratio"},                                       \
      {"Poisson ratio", "1", "", "(-1, 0.5)", "nu; goes with the Young modulus"},                                      \
      {"bulk modulus", "stress", "", "(0, inf)", "K; goes with the shear modulus"},                                    \
  {                                                                                                                    \
    "shear modulus", "stress", "", "(0, inf)", "G; goes with the bulk modulus"                                         \
  }

typedef struct Elasticity {
  double bulk, shear;
} Elasticity;

static inline int elasticity_prepare(Elasticity *e, const double *v, char *reason, size_t size)
{
  int young = !isnan(v[ELASTIC_YOUNG]) + !isnan(v[ELASTIC_POISSON]);
  int bulk = !isnan(v[ELASTIC_BULK]) + !isnan(v[ELASTIC_SHEAR]);
  if (!((young == 2 && !bulk) || (bulk == 2 && !young))) {
    snprintf(reason, size, "give 'Young modulus' and 'Poisson ratio', or 'bulk modulus' and 'shear modulus'");
    return 1;
  }
  e->shear = young ? v[ELASTIC_YOUNG] / (2 * (1 + v[ELASTIC_POISSON])) : v[ELASTIC_SHEAR];
  e->bulk = young ? v[ELASTIC_YOUNG] / (3 * (1 - 2 * v[ELASTIC_POISSON])) : v[ELASTIC_BULK];
  return 0;
}

static inline double elasticity_young(const Elasticity *e)
{
  return 9 * e->bulk * e->shear / (3 * e->bulk + e->shear);
}

/** `moduli` of laws whose constants begin with an Elasticity. */
static inline void elasticity_moduli(const void *constants, double *bulk, double *shear)
{
  const Elasticity *e = constants;
  *bulk = e->bulk;
  *shear = e->shear;
}

/** |s| of a uniaxial stress of 1. */
static const double root23 = 0.81649658092772603;

/* ---- one point at a time ---- */

typedef struct SolidPoint {
  double strain[6]; /* in, total */
  double stress[6]; /* out */
  const double *committed;
  double *trial;   /* whatever stands there at first: all of it is to be written */
  double *tangent; /* out, [6][6] to engineering shear strains, or NULL */
  bool elastic;    /* respond elastically, and keep the history */
} SolidPoint;

/** @return true if the point could be integrated */
typedef bool (*SolidPointUpdate)(const void *constants, SolidPoint *point);

/** Point i of a batch. @return true if it could be integrated */
static inline bool solid_update_one(const void *constants, const breccia_batch *batch, int history_values, int i,
                                    SolidPointUpdate update_point)
{
  SolidPoint point = {.committed = batch->committed + (ptrdiff_t)history_values * i,
                      .trial = batch->trial + (ptrdiff_t)history_values * i,
                      .tangent = batch->tangent ? batch->tangent + 36 * i : NULL,
                      .elastic = batch->elastic_stage};
  for (int k = 0; k < 6; ++k) point.strain[k] = batch->strain[k][i] * (k < 3 ? 1 : 0.5);
  if (!update_point(constants, &point)) return false;
  for (int k = 0; k < 6; ++k) {
    if (!isfinite(point.stress[k])) return false;
    batch->stress[k][i] = point.stress[k];
  }
  return true;
}

/** `update` of a law, point after point. */
__attribute__((always_inline)) static inline int solid_update(const void *constants, const breccia_batch *batch,
                                                              int history_values, SolidPointUpdate update_point)
{
  for (int i = 0; i < batch->count; ++i)
    if (!solid_update_one(constants, batch, history_values, i, update_point)) return i;
  return -1;
}

/* ---- tensors ---- */

static inline double trace(const double a[6])
{
  return a[XX] + a[YY] + a[ZZ];
}

/** a:b of symmetric tensors. */
static inline double contract(const double a[6], const double b[6])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

static inline double norm(const double a[6])
{
  return sqrt(contract(a, a));
}

static inline void deviator(const double a[6], double d[6])
{
  const double mean = trace(a) / 3;
  for (int k = 0; k < 6; ++k) d[k] = a[k] - (k < 3 ? mean : 0);
}

/** Elastic trial: strain less plastic strain gives the first invariant, the deviator and its norm. */
static inline double elastic_trial(const Elasticity *e, const double strain[6], const double plastic[6], double s[6],
                                   double *length)
{
  double elastic[6];
  for (int k = 0; k < 6; ++k) elastic[k] = strain[k] - plastic[k];
  deviator(elastic, s);
  for (int k = 0; k < 6; ++k) s[k] *= 2 * e->shear;
  *length = norm(s);
  return 3 * e->bulk * trace(elastic);
}

/** Plastic strain that leaves a stress of first invariant I and deviator s at a strain. */
static inline void plastic_rest(const Elasticity *e, const double strain[6], double invariant, const double s[6],
                                double plastic[6])
{
  for (int k = 0; k < 6; ++k) plastic[k] = strain[k] - s[k] / (2 * e->shear) - (k < 3 ? invariant / (9 * e->bulk) : 0);
}

/** Tangent a 1x1 + b 1xn + c nx1 + d nxn + e (deviatoric identity) with a unit deviator n. */
static inline void solid_tangent(double a, double b, double c, double d, double e, const double n[6],
                                 double tangent[36])
{
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      double value = d * n[i] * n[k];
      if (i < 3 && k < 3) value += a - e / 3;
      if (i < 3) value += b * n[k];
      if (k < 3) value += c * n[i];
      if (i == k) value += e * (i < 3 ? 1 : 0.5);
      tangent[6 * i + k] = value;
    }
}

static inline void elastic_tangent(const Elasticity *e, double tangent[36])
{
  static const double none[6];
  solid_tangent(e->bulk, 0, 0, 0, 2 * e->shear, none, tangent);
}

/** Derivatives of the returned pair (I, |s|) to the trial pair: the tangent of a law that keeps the direction of the trial deviator. */
typedef struct ReturnSlopes {
  double invariant_invariant, invariant_length, length_invariant, length_length;
} ReturnSlopes;

static inline void return_tangent(const Elasticity *e, const ReturnSlopes *slopes, double length, double trial_length,
                                  const double trial[6], double tangent[36])
{
  double n[6];
  for (int k = 0; k < 6; ++k) n[k] = trial_length > 0 ? trial[k] / trial_length : 0;
  const double ratio = trial_length > 0 ? length / trial_length : slopes->length_length;
  solid_tangent(e->bulk * slopes->invariant_invariant, 2 * e->shear / 3 * slopes->invariant_length,
                3 * e->bulk * slopes->length_invariant, 2 * e->shear * (slopes->length_length - ratio),
                2 * e->shear * ratio, n, tangent);
}

#endif

/* Vectors over places, x, y, z, for methods that go by products with the stiffness. */
#ifndef BRECCIA_SOLVER_VECTORS_H
#define BRECCIA_SOLVER_VECTORS_H

#include "domain/domain.h"

bool vectors_make(double *vector[3], int64_t places, const char *label, Error *error);
void vectors_free(double *vector[3]);
/** The part of a place's vector along a direction of length 1. */
static inline double vectors_along(double *const v[3], const double direction[3], int32_t place)
{
  return v[0][place] * direction[0] + v[1][place] * direction[1] + v[2][place] * direction[2];
}
void vectors_clear(double *const vector[3], int64_t places);

/** a = own a + factor b, by the team; where `own` is 0 nothing that stood in a is left. */
void vectors_combine(const Domain *domain, double own, double *const a[3], double factor, double *const b[3]);

/** The most by which components of a vector over particles differ, of all axes the root of the sum of squares. */
double vectors_apart(const Particles *particles, double *const vector[3]);

#endif

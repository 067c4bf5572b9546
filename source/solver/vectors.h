/* Vectors over places, x, y, z, for methods that go by products with the stiffness. */
#ifndef BRECCIA_SOLVER_VECTORS_H
#define BRECCIA_SOLVER_VECTORS_H

#include "domain/domain.h"

bool vectors_make(double *vector[3], int64_t places, const char *label, Error *error);
void vectors_free(double *vector[3]);

/** a = own a + factor b, by the team; where `own` is 0 nothing that stood in a is left. */
void vectors_combine(const Domain *domain, double own, double *const a[3], double factor, double *const b[3]);

#endif

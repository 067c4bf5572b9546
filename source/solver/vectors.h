/* Vectors over places, a row of each motion (body/particles.h), for methods that go by products with the stiffness. */
#ifndef BRECCIA_SOLVER_VECTORS_H
#define BRECCIA_SOLVER_VECTORS_H

#include "domain/domain.h"

/** Zeros in the rows that the particles have; rows beyond stay NULL. */
bool vectors_make(double *vector[MOTIONS], const Particles *particles, const char *label, Error *error);
void vectors_free(double *vector[MOTIONS]);
/** Bytes of one. */
size_t vectors_bytes(const Particles *particles);
void vectors_clear(double *const vector[MOTIONS], const Particles *particles);

/** a = own a + factor b, by the team; where `own` is 0 nothing that stood in a is left. */
void vectors_combine(const Domain *domain, double own, double *const a[MOTIONS], double factor,
                     double *const b[MOTIONS]);

/** The most by which displacements of a vector over particles differ, of all axes the root of the sum of squares. */
double vectors_apart(const Particles *particles, double *const vector[MOTIONS]);

#endif

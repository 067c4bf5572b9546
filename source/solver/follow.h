/* How displacements follow from unknowns that have numbers, as the matrix needs them (matrix.h): what unknowns.h does in place, written out term by term. */
#ifndef BRECCIA_SOLVER_FOLLOW_H
#define BRECCIA_SOLVER_FOLLOW_H

#include "solver/unknowns.h"

enum { FEW_TERMS = 3 };

typedef struct Term {
  int64_t unknown;
  double factor;
} Term;

/** A displacement, or rotation, as the sum of `count` terms of factor times unknown. The force on it belongs to the unknowns of the first `own` ones; those behind
 *  are of the particle whose mirror image it is. */
typedef struct Follow {
  int own, count;
  Term few[FEW_TERMS];
  Term *many; /* [count] where there are more than a few */
} Follow;

static inline const Term *follow_terms(const Follow *follow)
{
  return follow->count > FEW_TERMS ? follow->many : follow->few;
}

/** Numbers the unknowns. Those of rotations are displacements at the length by which rotations count (unknowns.h), so that rows and columns are alike.
 *  @param[out] count  of unknowns
 *  @return [places][motions], or NULL: no memory */
Follow *follow_create(const Unknowns *unknowns, int64_t *count, Error *error);
void follow_destroy(Follow **follow, int64_t count);

#endif

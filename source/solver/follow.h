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
/** Of each place one that moves as it does whatever the unknowns are, and whose forces belong to these: itself, or another one; -1 of those that do not
 *  move. @return [places], or NULL: no memory */
int32_t *follow_leaders(const Follow *follow, int motions, int64_t places, int64_t count, Error *error);
/** Whether the force on a place belongs to all the unknowns that it moves with. */
bool follow_is_whole(const Follow *follow, int motions, int64_t place);
void follow_destroy(Follow **follow, int64_t count);

#endif

/* The active set of one-sided supports (loading/one_sided.h) in solvers that iterate. An increment is solved with a set
 * of entries that are open. Then closed entries that pull are to be opened, and open ones that the body has passed are
 * to be closed, and the increment is solved again from its beginning, until no entry is wrong.
 *
 * All wrong entries change at once as long as their number falls, or has fallen within a few solutions; else the last
 * one alone (Judice and Pires 1994, Computers and Operations Research 21, 587), which comes to an end for every
 * symmetric positive definite stiffness. Where a set leaves a piece of the body to nothing, or no equilibrium, half of
 * the changes are taken. Forces are compared with the tolerance of equilibrium, and gaps with the same share of the
 * displacements. */
#ifndef BRECCIA_SOLVER_PRESSING_H
#define BRECCIA_SOLVER_PRESSING_H

#include "solver/newton.h"
#include "solver/pieces.h"

typedef struct Pressing {
  int64_t count;           /* entries of the stage */
  uint8_t *begun, *solved; /* [count] 1: open, at the beginning of the increment; in the last set with equilibrium */
  struct Wrong *wrong;     /* [count] entries of `solved` that are to change */
  int64_t wrong_count, least, patience, taken, rounds;
  bool known;       /* there is a set with equilibrium */
  bool last_alone;  /* only the last wrong entry changes */
  double reference; /* Newton.reference at the beginning of the increment */
  LoosePiece loose; /* what the first set that was refused would have left to nothing */
} Pressing;

/** `pressing` is zero; destroy it in any case. */
int pressing_create(Pressing *pressing, const Loading *loading, Error *error);
void pressing_destroy(Pressing *pressing);

/** Notes the set at the beginning of an increment. */
void pressing_begin(Pressing *pressing, const Newton *newton);
/** Returns true if the set is to change after a solution, which the caller takes back before pressing_choose.
 *  @param[in,out] outcome  of the solution; NEWTON_SLOW where the set has changed too often */
bool pressing_is_wrong(Pressing *pressing, const Newton *newton, double time, NewtonOutcome *outcome);
/** Sets the entries that are open in the next solution. @return false if there is no other set to be tried */
bool pressing_choose(Pressing *pressing, Newton *newton);

/** Finds at the beginning of a stage with which forces entries press, by the forces on all particles.
 *  @param[in] drag  [motions][places] forces of damping; NULL: none */
void pressing_take_up(const Newton *newton, double *const *drag);

/** Calls `one` for each entry that is open at the beginning of the increment and closed now. */
void pressing_each_closing(const Pressing *pressing, const Loading *loading,
                           void (*one)(void *context, const Constraint *constraint, int64_t entry), void *context);

#endif

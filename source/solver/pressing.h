/* Active-set method for one-sided supports (loading/one_sided.h) in iterative solvers. An increment is solved with a
 * set of open entries. Then closed entries that pull are opened, and open entries that the body has passed are closed.
 * The increment is solved again from its beginning, until no entry is wrong.
 *
 * All wrong entries change at once as long as their number decreases at least once in a few solutions. Otherwise only
 * the last entry changes (Judice and Pires 1994, Computers and Operations Research 21, 587), which terminates for every
 * symmetric positive definite stiffness. If a set leaves a piece of the body unsupported, or has no equilibrium, half
 * of the entries change. The tolerance of forces is that of equilibrium; gaps have the same tolerance relative to the
 * largest displacement. */
#ifndef BRECCIA_SOLVER_PRESSING_H
#define BRECCIA_SOLVER_PRESSING_H

#include "solver/newton.h"
#include "solver/pieces.h"

typedef struct Pressing {
  int64_t count;           /* number of entries of the stage */
  uint8_t *begun, *solved; /* [count] 1: open at the beginning of the increment; open in the last equilibrium */
  struct Wrong *wrong;     /* [count] entries of `solved` that are to change */
  int64_t wrong_count, least, patience, taken, rounds;
  bool known;       /* a set with equilibrium has been found */
  bool last_alone;  /* only the last wrong entry changes */
  double reference; /* Newton.reference at the beginning of the increment */
  LoosePiece loose; /* piece that the first refused set would leave unsupported */
} Pressing;

/** Creates the set of a stage in `pressing`, which is zero before. Call pressing_destroy also after a failure. */
int pressing_create(Pressing *pressing, const Loading *loading, Error *error);
void pressing_destroy(Pressing *pressing);

/** Saves the set at the beginning of an increment. */
void pressing_begin(Pressing *pressing, const Newton *newton);
/** Returns true if the set is to change after a solution. The caller then restores the beginning of the increment and
 *  calls pressing_choose.
 *  @param[in,out] outcome  outcome of the solution; set to NEWTON_SLOW if the set has changed too often */
bool pressing_is_wrong(Pressing *pressing, const Newton *newton, double time, NewtonOutcome *outcome);
/** Sets the entries that are open in the next solution. @return false if no other set can be tried */
bool pressing_choose(Pressing *pressing, Newton *newton);

/** Computes the forces with which entries press at the beginning of a stage, from the forces on all particles.
 *  @param[in] drag  [motions][places] forces of damping; NULL: none */
void pressing_take_up(const Newton *newton, const Vector *drag);

/** Calls `one` for each entry that is open at the beginning of the increment and closed now. */
void pressing_each_closing(const Pressing *pressing, const Loading *loading,
                           void (*one)(void *context, const Constraint *constraint, int64_t entry), void *context);

#endif

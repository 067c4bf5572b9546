/* Equilibrium by descent: where tangents lead Newton's method round in circles, because points soften and unload in turn or a body jumps to another equilibrium,
 * secants of what softens lead down to one in which it stays (docs/theory.md 7).
 *
 * The stiffness of secants is that with which a damaged body unloads: symmetric, positive, and at least as stiff as the body, so that steps by it go down
 * like a motion that is damped beyond all swinging, but slowly. They are made longer by what forces have answered to the last steps (limited-memory BFGS: Liu
 * and Nocedal 1989, Math. Program. 45, 503), along each of which forces are brought into balance roughly. Near to equilibrium tangents are tried, and kept where they
 * halve the forces out of balance. Laws are asked for the whole way from the committed state, as always. */
#ifndef BRECCIA_SOLVER_NEWTON_DESCENT_H
#define BRECCIA_SOLVER_NEWTON_DESCENT_H

#include "solver/newton.h"
#include "solver/preconditioner.h"

enum { DESCENT_PAIRS = 8 };

typedef struct Descent {
  Vector step[DESCENT_PAIRS]; /* of the unknowns, and by how much forces have fallen in them */
  Vector fall[DESCENT_PAIRS];
  double work[DESCENT_PAIRS]; /* of the falls along the steps, above 0 */
  int64_t count;              /* of steps so far; of the last ones there are pairs */
  double first_work;          /* of the forces out of balance along the first step of the increment */
  Vector before;              /* forces out of balance at the begin of an iteration */
  Vector room;
  Preconditioner preconditioner; /* to ask whether the body stays in an equilibrium */
} Descent;

/** For the same body as `newton`. `descent` is zero; destroy it in any case. */
int descent_create(Descent *descent, const Newton *newton, Error *error);
/** Bytes that it takes, once it is made. */
size_t descent_bytes(const Descent *descent, const Particles *particles);
void descent_destroy(Descent *descent);

/** As newton_solve, of a stage without control. @param[in] most  iterations */
NewtonOutcome descent_solve(Descent *descent, Newton *newton, double time, int64_t most, Error *error);

#endif

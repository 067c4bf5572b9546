/* Whether a body stays in an equilibrium that has been found, or falls from it by the smallest push: two cracks that are alike may both stand open at rest, as a
 * pencil stands on its tip.
 *
 * Where the linearised body resists every motion it stays. Conjugate gradients for a push of random forces, always the same, come across a motion that it does
 * not resist, if there is one (Nocedal and Wright, Numerical Optimization, 7.1), with high probability and without an eigenvalue being found. */
#ifndef BRECCIA_SOLVER_NEWTON_STABILITY_H
#define BRECCIA_SOLVER_NEWTON_STABILITY_H

#include "solver/newton.h"
#include "solver/preconditioner.h"

/** Seeks a motion along which forces out of balance grow, by tangents at the equilibrium held, which are those of the domain afterwards.
 *  @param[in] preconditioner  created for the body; it is prepared here
 *  @param[out] fall           the motion, a vector of unknowns of any size
 *  @param[out] rest, product  lost
 *  @param[out] falls          whether there is one; else `fall` is lost */
int newton_seek_fall(Newton *newton, Preconditioner *preconditioner, const Vector *fall, const Vector *rest,
                     const Vector *product, bool *falls, Error *error);

/** Determines whether a body stays in the equilibrium held: whether its tangent stiffness is positive definite, as the
 *  linear solver sees that (`linear.definite` must be set). Overwrites `force` and `change` of `newton`.
 *  @param[out] stays  true if no motion was found that the body does not resist */
int newton_find_stability(Newton *newton, bool *stays, Error *error);

#endif

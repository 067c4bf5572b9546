/* What stands for the inverse of K in Krylov methods: M^-1 = D^-1 + P A^-1 P^T, symmetric and positive.
 *
 * D is what stands on the diagonal of K, and does for whatever is no longer than a horizon: a family joins its particles so well that K hardly tells such
 * displacements apart. What is longer is left to a coarse grid of finite elements (solver/coarse_grid.h; P interpolates from it, and lets particles turn as
 * the grid does there). Additive two-level
 * preconditioners: Smith, Bjorstad and Gropp, Domain Decomposition, Cambridge 1996. */
#ifndef BRECCIA_SOLVER_PRECONDITIONER_H
#define BRECCIA_SOLVER_PRECONDITIONER_H

#include "solver/coarse_grid.h"
#include "solver/linear_solver.h"

typedef struct Preconditioner {
  double *diagonal;  /* [places] mean over the axes; infinite: nothing holds the particle, and it stays where it is */
  double *turning;   /* [places] the same of rotations; NULL without them */
  double centre[3];  /* centre of volume of the body [length]; only with any_pose */
  CoarseGrid *grid;  /* NULL: bodies with rotations, for any pose */
  bool any_pose;     /* as preconditioner_create was given */
  bool is_symmetric; /* K, as far as two products tell */
} Preconditioner;

/** Allocates a preconditioner, which must be zero before; preconditioner_prepare assembles it.
 *  @param[in] any_pose  true: M is the same for each pose of the body (solver/coarse_frame.h), up to round-off, and
 *                       bodies with rotations have no coarse correction. false: M depends on the axes of the deck and
 *                       on the order of places
 *  @return BRECCIA_OK; BRECCIA_FAILURE without memory */
int preconditioner_create(Preconditioner *preconditioner, const Domain *domain, bool any_pose, Error *error);
void preconditioner_destroy(Preconditioner *preconditioner);

/** The domain was linearised again. It takes some products with K.
 *  @param[out] v, kv  vectors to work with */
int preconditioner_prepare(Preconditioner *preconditioner, LinearSolver *solver, const Vector *v, const Vector *kv,
                           Error *error);

/** v = M^-1 f, both vectors of unknowns. */
void preconditioner_apply(const Preconditioner *preconditioner, const LinearSolver *solver, const Vector *f,
                          const Vector *v);
/** Returns a component of a pseudo-random motion that turns with the body and does not depend on the order of
 *  particles. Each particle moves along the line from the centre of the body, by the sine of its distance (1000 radians
 *  over a horizon). Rotations about the normal of a plane have that sine, too. Only with any_pose.
 *  @param[in] phase  of the sine [rad]
 *  @param[in] row    row of motion
 *  @return component of the motion, 1 at most; 0 in unused places */
double preconditioner_probe(const Preconditioner *preconditioner, const LinearSolver *solver, double phase, int row,
                            int64_t place);

/** Bytes of its coarse grid, beside which the rest is small; 0 before it is made. */
size_t preconditioner_bytes(const Preconditioner *preconditioner);

#endif

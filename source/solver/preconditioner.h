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
  double *diagonal; /* [places] mean over the axes; infinite: nothing holds the particle, and it stays where it is */
  double *turning;  /* [places] the same of rotations; NULL without them */
  double centre[3]; /* of the volume (length) */
  CoarseGrid *grid;
  bool
      any_pose; /* the diagonal is that of the body in each pose; else it depends on the axes and on the order of places */
  bool is_symmetric; /* K, as far as two products tell */
} Preconditioner;

/** @param[in] any_pose  what it makes of forces is the same for each pose of the body: its place and direction in space, and
 *                       the order of its particles, up to round-off. Bodies with rotations have no coarse grid then. Else it
 *                       depends on the axes of the deck */
int preconditioner_create(Preconditioner *preconditioner, const Domain *domain, bool any_pose, Error *error);
void preconditioner_destroy(Preconditioner *preconditioner);

/** The domain was linearised again. It takes some products with K.
 *  @param[out] v, kv  vectors to work with */
int preconditioner_prepare(Preconditioner *preconditioner, LinearSolver *solver, double *const v[MOTIONS],
                           double *const kv[MOTIONS], Error *error);

/** v = M^-1 f, both vectors of unknowns. */
void preconditioner_apply(const Preconditioner *preconditioner, const LinearSolver *solver, double *const f[MOTIONS],
                          double *const v[MOTIONS]);
/** A motion of all particles that looks random: along the line from the centre of the body, by the sine of the distance
 *  (1000 radians over a horizon). It turns with the body, and knows no order of particles, so that what is found by it
 *  is the same for each pose of a body.
 *  @param[in] phase  of the sine (rad)
 *  @return the component of a row of motion at a place; 0 in unused places */
double preconditioner_probe(const Preconditioner *preconditioner, const LinearSolver *solver, double phase, int row,
                            int64_t place);

/** Bytes of its coarse grid, beside which the rest is small; 0 before it is made. */
size_t preconditioner_bytes(const Preconditioner *preconditioner);

#endif

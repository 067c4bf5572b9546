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
  CoarseGrid *grid;
  bool is_symmetric; /* K, as far as two products tell */
} Preconditioner;

int preconditioner_create(Preconditioner *preconditioner, const Domain *domain, Error *error);
void preconditioner_destroy(Preconditioner *preconditioner);

/** The domain was linearised again. It takes some products with K.
 *  @param[out] v, kv  vectors to work with */
int preconditioner_prepare(Preconditioner *preconditioner, LinearSolver *solver, double *const v[MOTIONS],
                           double *const kv[MOTIONS], Error *error);

/** v = M^-1 f, both vectors of unknowns. */
void preconditioner_apply(const Preconditioner *preconditioner, const LinearSolver *solver, double *const f[MOTIONS],
                          double *const v[MOTIONS]);

/** Bytes of its coarse grid, beside which the rest is small; 0 before it is made. */
size_t preconditioner_bytes(const Preconditioner *preconditioner);

#endif

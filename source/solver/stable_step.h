/* The largest stable time step of the explicit solver, measured on the body itself. */
#ifndef BRECCIA_SOLVER_STABLE_STEP_H
#define BRECCIA_SOLVER_STABLE_STEP_H

#include "domain/domain.h"

/** 2 / omega_max of the body as it is now, elastic, with its present bonds and displacements.
 *
 * omega_max^2 is the largest eigenvalue of v -> -(f(u + h v) - f(u)) / (h rho), found by Lanczos' method with the volume-weighted mass
 * as inner product. Estimates from row sums are off by a third at surfaces and for zero-energy control (docs/theory.md 7); this one needs no formula per
 * formulation and costs some thirty force evaluations. It approaches omega_max from below; the residual bound is added.
 * Committed states are not touched; trial states are.
 *  @param[out] step  INFINITY where no bond pulls: none is left */
int stable_step(Domain *domain, double *step, Error *error);

#endif

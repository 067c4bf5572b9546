/* The slowest vibration of a body that its loads set off: by it they have to grow slowly, and by its critical damping it comes to rest soonest. */
#ifndef BRECCIA_SOLVER_PERIOD_H
#define BRECCIA_SOLVER_PERIOD_H

#include "solver/linear_solver.h"

/** Of the body as the stage under way holds it, elastic and with its present bonds, at the displacements held; of loads and prescribed displacements those
 *  that begin with the stage, as large as their histories make them first. `time` of the run when it begins.
 *  @return BRECCIA_USER_ERROR where there is none: nothing loads the body, or nothing holds it against its loads */
int period_find(Domain *domain, const Loading *loading, double time, double *period, Error *error);

#endif

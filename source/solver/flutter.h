/* Motions that grow by themselves, because what answers displacements has no energy. */
#ifndef BRECCIA_SOLVER_FLUTTER_H
#define BRECCIA_SOLVER_FLUTTER_H

#include "solver/solver.h"

/** Warns of supports that hold a face in all directions, whose images hand no force on, so that the stiffness is not symmetric (docs/theory.md 7).
 *  @param[in] stable  step of explicit dynamics without damping; @param[in] stiffness  damping of the stage in proportion to stiffness [time]
 *  @param[in] local  whether 'local damping' can be advised */
void flutter_warn_of_supports(const Solver *run, double stable, double stiffness, bool local, Text *warning);

#endif

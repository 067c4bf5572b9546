/* How a body vibrates by itself: its lowest frequencies and their modes, as it is held and supported by springs in the stage under way, elastic
 * and with its present bonds. */
#ifndef BRECCIA_SOLVER_MODES_H
#define BRECCIA_SOLVER_MODES_H

#include "solver/linear_solver.h"

typedef struct Mode {
  double frequency;    /* cycles per time; 0: the body moves as a whole */
  double share[3];     /* of the mass that moves with a motion of the ground along each axis */
  Vector displacement; /* arrays of places; the largest component is 1, of rotations at the radius of gyration */
} Mode;

typedef struct Modes {
  int count, rigid; /* of these with frequency 0 */
  Mode *modes;      /* [count], the slowest first */
} Modes;

/** Finds them at the displacements held. @param[out] modes  zero before; destroy it in any case
 *  @return BRECCIA_USER_ERROR where the body has fewer unknowns than this many modes need */
int modes_find(Domain *domain, const Loading *loading, int count, Modes *modes, Error *error);
void modes_destroy(Modes *modes);

/** A small omega squared, by which K + s M can be solved where K alone leaves motions as a whole free. */
double modes_shift(const Domain *domain);

#endif

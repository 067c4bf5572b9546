/* Whether a body that was meant to come to rest has done so. */
#ifndef BRECCIA_SOLVER_REST_H
#define BRECCIA_SOLVER_REST_H

#include "solver/solver.h"

typedef struct Rest {
  bool meant;   /* there is damping, and no load or motion changes any more */
  bool reached; /* both shares are below `rest_limit` */
  double
      unbalanced; /* forces that nothing balances, over those that act, strains of loads too: sums of both; at rest the roots of squares by which that converges */
  double kinetic; /* kinetic energy, over the most that loads and motions have put in */
} Rest;

/** Share below which a body is at rest: a thousandth, as users of explicit codes in soil mechanics ask for. */
extern const double rest_limit;

/** @return status; of the state between two steps */
int rest_find(const Solver *solver, Rest *rest, Error *error);

#endif

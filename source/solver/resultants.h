/* Resultant forces of loads and supports: the force in all that each exerts on the body now, and the largest that it
 * has exerted so far.
 * What a load of forces exerts is its factor times one vector, so that its largest resultant follows from its
 * history. What supports, prescribed motions, springs and dashpots exert depends on the body. The largest is taken over
 * the ends of all steps. If several supports mirror, their resultants are sums over bonds, which take longer than a
 * step: every tenth explicit step and the last step of a stage are then evaluated. The largest is part of the state, so
 * that a restart ends in the same numbers. */
#ifndef BRECCIA_SOLVER_RESULTANTS_H
#define BRECCIA_SOLVER_RESULTANTS_H

#include "solver/solver.h"

typedef struct Resultant {
  bool exerts;       /* a force, or one that holds a prescribed motion; ties and strains exert none */
  double largest[3]; /* resultant where its length is largest [force] */
  double time;       /* of that; NaN where it follows from a history */
  double now[3];     /* 0 of what acts no more */
} Resultant;

/** Makes room, without memory of its own before the first step. Destroy in any case. */
int resultants_create(Solver *solver, Error *error);
void resultants_destroy(Solver *solver);

/** Returns the number of explicit steps between evaluations of resultants. Peaks between evaluations can be missed. */
int64_t resultants_interval(const Solver *solver);

/** After a step that has come out well: keeps resultants larger than those so far. */
void resultants_note(Solver *solver);

/** Returns the index of an active load or support whose resultant was the largest of the run so far at a time; loads
 *  with a name take precedence. Only resultants that are not prescribed count.
 *  @param[in] time  time at the end of a step
 *  @return index of the load; -1: none */
int resultants_largest_at(const Solver *solver, double time);

/** Rows of the largest resultants that are kept. */
void resultants_state(Solver *solver, StateList *list);

/** Finds the resultants of all loads in the state held, as the last step left it.
 *  @param[out] list  [loads] */
int resultants_find(const Solver *solver, Resultant *list, Error *error);

/** The factor of a load that is farthest from zero from its begin until now, or until it ended; 0 before its stage. */
double resultants_peak_factor(const Solver *solver, const Load *load);

#endif

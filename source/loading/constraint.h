/* Motions prescribed to particles (loading/load.h has the rows). */
#ifndef BRECCIA_LOADING_CONSTRAINT_H
#define BRECCIA_LOADING_CONSTRAINT_H

#include "loading/load.h"

/** Two motions of one particle must be at right angles, or they contradict each other. */
int constraints_check(const Loading *loading, const Particles *particles, const DeckReader *reader);

/** What the n-th particle of a constraint does of what is told of all. */
static inline double constraint_part(const Constraint *constraint, int64_t n)
{
  return constraint->part ? constraint->part[n] : 1;
}
/** The part of a place's motion along the direction of a constraint. @param[in] v  rows of motion */
static inline double constraint_along(const Constraint *constraint, double *const *v, int32_t place)
{
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (constraint->direction[k] != 0) sum += v[constraint->row + k][place] * constraint->direction[k];
  return sum;
}
/** Adds to the motion of a place along it. */
static inline void constraint_add(const Constraint *constraint, double *const *v, int32_t place, double amount)
{
  for (int k = 0; k < 3; ++k)
    if (constraint->direction[k] != 0) v[constraint->row + k][place] += amount * constraint->direction[k];
}
/** The most that any particle does of it. */
static inline double constraint_most(const Constraint *constraint)
{
  return constraint->part ? constraint->largest_part : 1;
}

/** Displacement along its direction that a constraint prescribes at a time of the run, from where its load began. By one thread. */
double constraint_displacement(const Constraint *constraint, double time);

/** What it prescribes besides where it began, from one time of the run to a later one. By one thread. */
double constraint_change(const Constraint *constraint, double from, double to);

/** Velocity along it at a time of the run. By one thread.
 *  @param[in] step  time over a small part of which displacements are differenced that are prescribed themselves */
double constraint_velocity(const Constraint *constraint, double time, double step);

/** Acceleration along it at a time of the run, 0 before its load has begun. By one thread.
 *  @param[in] step  time over which displacements are differenced, unless accelerations are prescribed: where velocities jump, what it takes is
 *                   spread over a step */
double constraint_acceleration(const Constraint *constraint, double time, double step);

#endif

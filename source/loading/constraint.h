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
/** Returns true if the motion of the n-th particle is free and leads those of a platen. */
static inline bool constraint_leads(const Constraint *constraint, int64_t n)
{
  const Platen *platen = constraint->platen;
  return platen && (n == platen->leader[0] || (platen->leaders > 1 && n == platen->leader[1]));
}
/** The particle that leads the m-th share of a platen. */
static inline int32_t constraint_leader(const Constraint *constraint, int m)
{
  return constraint->load->selection.places[constraint->platen->leader[m]];
}
/** Returns the part of the motion of the n-th particle along the direction that follows from motions of other
 * particles. @param[in] v  rows of motion */
static inline double constraint_followed(const Constraint *constraint, double *const *v, int64_t n)
{
  double sum = 0;
  if (constraint->images) sum += constraint->share * constraint_along(constraint, v, constraint->images[n]);
  for (int m = 0; constraint->platen && m < constraint->platen->leaders; ++m)
    sum += constraint->platen->share[m][n] * constraint_along(constraint, v, constraint_leader(constraint, m));
  return sum;
}
/** Returns true if the motion of particles follows from that of others. */
static inline bool constraint_follows(const Constraint *constraint)
{
  return constraint->images || constraint->platen;
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

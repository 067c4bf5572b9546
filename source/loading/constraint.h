/* Motions prescribed to particles (loading/load.h has the rows). */
#ifndef BRECCIA_LOADING_CONSTRAINT_H
#define BRECCIA_LOADING_CONSTRAINT_H

#include "loading/load.h"

/** Two motions of one particle must be at right angles, or they contradict each other. */
int constraints_check(const Loading *loading, const Particles *particles, const DeckReader *reader);

/** Returns true if a platen is one-sided and has let go, so that its centre moves freely. */
static inline bool constraint_is_loose(const Constraint *constraint)
{
  return constraint->platen && constraint->one_sided && constraint->one_sided->open[0];
}
/** Returns true if a constraint is one-sided and has let go of its n-th particle, which is free then. */
static inline bool constraint_is_open(const Constraint *constraint, int64_t n)
{
  return constraint->one_sided && !constraint->platen && constraint->one_sided->open[n];
}
/** Returns the number of particles that lead those of a platen; 0 without a platen. */
static inline int constraint_leaders(const Constraint *constraint)
{
  return constraint->platen ? constraint->platen->leaders + constraint_is_loose(constraint) : 0;
}
/** Returns the factor S with which the m-th leader of a platen contributes to the motion of its n-th particle. */
static inline double constraint_share(const Constraint *constraint, int m, int64_t n)
{
  const Platen *platen = constraint->platen;
  return constraint_is_loose(constraint) ? platen->loose[m][n] : platen->share[m][n];
}
/** What the n-th particle of a constraint does of what is told of all. */
static inline double constraint_part(const Constraint *constraint, int64_t n)
{
  if (constraint_is_loose(constraint)) return 0;
  return constraint->part ? constraint->part[n] : 1;
}
/** Returns the position of the n-th particle along the direction when the load began, relative to what it follows. */
static inline double constraint_from(const Constraint *constraint, int64_t n)
{
  if (!constraint->from) return 0;
  if (!constraint_is_loose(constraint)) return constraint->from[n];
  const Platen *platen = constraint->platen;
  return constraint->from[n] - platen->loose[platen->leaders][n] * constraint->from[platen->leader[platen->leaders]];
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
  for (int m = 0; m < constraint_leaders(constraint); ++m)
    if (constraint->platen->leader[m] == n) return true;
  return false;
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
  for (int m = 0; m < constraint_leaders(constraint); ++m)
    sum += constraint_share(constraint, m, n) * constraint_along(constraint, v, constraint_leader(constraint, m));
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

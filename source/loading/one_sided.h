/* One-sided supports: a prescribed motion that presses on the body and lets go where it would pull. With the force r
 * with which an entry presses and its gap g from where it is prescribed to be, in the direction in which it pushes,
 *   r >= 0,   g >= 0,   r g = 0.
 * An entry is a particle; a platen that turns lets go as a whole: the plate stays on its particles, and r is the
 * resultant on its centre. Solvers choose which entries are open; these flags are part of the state. */
#ifndef BRECCIA_LOADING_ONE_SIDED_H
#define BRECCIA_LOADING_ONE_SIDED_H

#include "loading/load.h"

/** Makes the constraints of loads that only press one-sided, when platens are there, and finds the side from which each
 * pushes.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR after a message where a motion is prescribed in several directions, or where
 *          the side cannot be told; BRECCIA_FAILURE: no memory */
int one_sided_create(const LoadMaking *making);
void one_sided_destroy(OneSided *one_sided);

/** Finds on which side of the particles of a load the body lies: 1 along a direction, -1 against it, 0 if on both.
 *  @param[in] direction  unit vector */
int one_sided_find_side(const Load *load, const LoadMaking *making, const double direction[3]);

/** Closes all entries of a constraint whose load begins. */
void one_sided_close(const Constraint *constraint);

/** Returns the number of entries of all constraints that act in the stage under way. */
int64_t one_sided_count(const Loading *loading);
/** Returns a number that differs when other entries are open, for factors that are kept. */
int64_t one_sided_key(const Loading *loading);

/** Returns the gap of an entry at the displacements held [length]; negative where the body has passed the support.
 *  @param[in] time  of the run */
double one_sided_gap(const Constraint *constraint, const Particles *particles, int64_t entry, double time);

/** Stores in `found` with which force the closed entries press, if these are the forces on all particles; 0 of open
 * ones.
 *  @param[in] f  [motions][places] forces out of balance without those of constraints */
void one_sided_find(const Loading *loading, double *const f[MOTIONS]);
/** Takes `found` as what presses from now on, without what pulls. */
void one_sided_accept(const Loading *loading);

/** Adds to forces those with which entries pressed at the last equilibrium or implicit step: of entries that have let
 * go since, no other force stands for them.
 *  @param[in,out] f  [motions][places] */
void one_sided_add_pressed(const Loading *loading, double factor, double *const f[MOTIONS]);

/** Rows of which entries are open. @param[in] name  of the constraint */
void one_sided_state(const Constraint *constraint, const char *name, StateList *list);

#endif

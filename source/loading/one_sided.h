/* One-sided supports: a prescribed motion that presses on the body and lets go where it would pull. With the force r
 * with which an entry presses, and its gap g from the prescribed position in the direction in which it pushes,
 *   r >= 0,   g >= 0,   r g = 0.
 * An entry is a particle or a whole platen. The plate of a turning platen stays on its particles, and r is the
 * resultant on its centre. Solvers choose which entries are open; these flags are part of the state. */
#ifndef BRECCIA_LOADING_ONE_SIDED_H
#define BRECCIA_LOADING_ONE_SIDED_H

#include "loading/load.h"

/** Makes the constraints of loads with 'only presses' one-sided, and finds the side from which each pushes. Called
 * after platens are created.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR after a message if a load prescribes several directions, if control finds its
 *          factor, or if the side is unknown; BRECCIA_FAILURE: memory is exhausted */
int one_sided_create(const LoadMaking *making);
void one_sided_destroy(OneSided *one_sided);

/** Finds the side of the body from the particles of a load: 1 along a direction, -1 against it, 0 if on both sides.
 *  @param[in] direction  unit vector */
int one_sided_find_side(const Load *load, const LoadMaking *making, const double direction[3]);

/** Closes all entries of a constraint whose load begins. */
void one_sided_close(const Constraint *constraint);

/** Returns the number of entries of all constraints that act in the stage under way. */
int64_t one_sided_count(const Loading *loading);
/** Returns a hash of the set of open entries, by which factorisations detect a change of the set. */
int64_t one_sided_key(const Loading *loading);

/** Returns the gap of an entry at the current displacements [length]; negative: the body has passed the support.
 *  @param[in] time  time of the run */
double one_sided_gap(const Constraint *constraint, const Particles *particles, int64_t entry, double time);

/** Computes `found`, the force with which each closed entry presses, from the forces on all particles; 0 for open
 * entries.
 *  @param[in] f  [motions][places] unbalanced forces without those of constraints */
void one_sided_find(const Loading *loading, const Vector *f);
/** Accepts `found` as the forces that press; pulling forces become 0. */
void one_sided_accept(const Loading *loading);

/** Adds the forces with which entries pressed at the last accepted step. For entries that have let go since, no other
 * force replaces them.
 *  @param[in,out] f  [motions][places] */
void one_sided_add_pressed(const Loading *loading, double factor, const Vector *f);

/** Adds the flags of open entries and the accepted forces to the state. @param[in] name  name of the constraint */
void one_sided_state(const Constraint *constraint, const char *name, StateList *list);

#endif

/* Platens: rigid plates between a jack and the particles that it moves. The motion of the centre along one direction is
 * prescribed, and the plate turns freely about the axes across that direction, as on a ball joint. It takes no moment,
 * so that a jack of any width does not clamp the body.
 *
 * With coordinates s_i of the particles across the direction, counted from the centre of their volumes,
 *   u_i = U + theta . s_i.
 * The turn theta follows from the motions of leading particles, which are free:
 *   u_i = (1 - sum_m S_im) U + sum_m S_im u_m,    sum_m S_im s_m = s_i.
 * In the plane one particle leads, in space two, or one where all particles stand in a line. */
#ifndef BRECCIA_LOADING_PLATEN_H
#define BRECCIA_LOADING_PLATEN_H

#include "loading/load.h"

/** Puts platens between loads that prescribe a motion in one direction and their particles: where the deck wants one
 *  that turns, and where it says nothing and the load moves one patch, narrower than the body, to no particle of which
 *  another motion is prescribed or which stands beside its mirror image, as on a plane of symmetry.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR after a message where a platen is wanted and motions in several directions
 *          are prescribed; BRECCIA_FAILURE: no memory */
int platens_create(const LoadMaking *making);
void platen_destroy(Platen *platen);
/** Computes the shares S of particles for a free centre, with one more leader k, from
 *    u_k = (1 - sum_m S_km) U + sum_m S_km u_m.
 *  @return BRECCIA_OK, or BRECCIA_FAILURE if memory is exhausted */
int platen_loosen(const Constraint *constraint, Error *error);
/** Returns the displacement or the rate of the centre along the direction, computed from the motions of all leaders,
 * including the one that leads while the centre is free.
 *  @param[in] u, v  [motions][places] */
double platen_centre_displacement(const Constraint *constraint, double *const *u);
double platen_centre_rate(const Constraint *constraint, double *const *v);
/** Returns the resultant of forces on the particles at the centre of the plate.
 *  @param[in] f  [motions][places] forces */
double platen_centre_force(const Constraint *constraint, double *const *f);
/** Adds a force on a free centre as work-equivalent forces on the leaders.
 *  @param[in,out] f  [motions][places] forces */
void platen_add_centre_force(const Constraint *constraint, double *const *f, double force);

/** Returns the width along an axis of the patch on which a constraint acts, a spacing more than its particles stand
 * apart; 0 where they stand in one row or the axis is not across the direction. */
double platen_width(const Constraint *constraint, const Body *body, int axis);
/** Returns true if the particles of a constraint do not all stand in one line along its direction. */
bool platen_can_turn(const Constraint *constraint, const Body *body);
/** Returns true if the patch on which a constraint acts is narrower than the body along any axis across its direction.
 */
bool platen_is_narrow(const Constraint *constraint, const Body *body);

/** Sets the velocities of the leaders when the motion of the centre begins, which may be at once: the plate turns on
 *  with the moment of momentum of its particles. By one thread.
 *  @param[in] step  time over a small part of which displacements are differenced */
void platen_start(const Constraint *constraint, const Particles *particles, double time, double step);

/** Sets the external forces on the leaders so that they accelerate with the plate under the forces on all its
 * particles. By one thread.
 *  @param[in] time  of the run */
void platen_push(const Constraint *constraint, Particles *particles, double time);

/** Replaces the accelerations of the leaders, which are generalised forces over their own masses, by those of the plate
 * with all masses on it. */
void platen_share_mass(const Constraint *constraint, const Particles *particles, const Vector *acceleration);

#endif

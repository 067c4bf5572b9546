/* Deformations that no body can have: families that are turned inside out, and parts that have moved apart by many
 * sizes of the body. They come of motions and loads in a wrong unit; laws and formulations know nothing against them,
 * and energies balance. */
#ifndef BRECCIA_SOLVER_DISTORTION_H
#define BRECCIA_SOLVER_DISTORTION_H

#include "domain/domain.h"
#include "solver/clock.h"

/** Counts the particles of whole families whose deformation gradient has a determinant of 0 or less.
 *  @param[out] first  place of the first of them */
int64_t distortion_inverted(const Domain *domain, int32_t *first);

/** Returns the place of the first particle that still carries load and is turned inside out; -1: there is none. */
int32_t distortion_first_impossible(const Domain *domain);

/** Fails if particles that still carry load are turned inside out, or if particles with bonds have moved apart by more
 * than 100 sizes of the body.
 *  @param[in] rests  true: the solver finds equilibria, so that the body has failed under its loads
 *  @param[in] loads  text for the message: current values of loads
 *  @return BRECCIA_OK; BRECCIA_FAILURE after a message */
int distortion_watch(const Domain *domain, const Clock *clock, bool rests, const char *loads, Error *error);

#endif

/* The height of a step in the surface of ground, as of a slope or a cut, in spacings. */
#ifndef BRECCIA_MODEL_GROUND_STEP_H
#define BRECCIA_MODEL_GROUND_STEP_H

#include "domain/domain.h"

/** Returns by how many spacings the highest column of particles along gravity ends above the lowest one; 0: gravity
 * does not act, or memory is out. */
double ground_step_spacings(const Body *body, const Loading *loading);

/** Returns an estimate of the relative excess of the factor of safety for a step: at most 0.35, or 0.1 if control of
 * zero-energy modes fades with yielding.
 *  @param[in] spacings  height of the step in spacings */
double ground_step_excess(const Domain *domain, double spacings);

/** Adds a line that says how control of zero-energy modes may hold ground without a step in its surface, under footings and
 *  in slopes without end; nothing where families resist slip lines by their strength alone or have no control. Begins
 *  with some words, and ends with advice. */
void ground_step_tell_level(const Domain *domain, const char *before, const char *advice, Text *text);

/** Returns true if loads divide strengths in any stage. */
bool ground_step_is_weakened(const Loading *loading);

/** Returns the support `held: all` on which ground rests whose strengths loads can divide; NULL: there is none, or
 * gravity does not act. Ground that yields beside the images of such a support carries less than its strength. */
const LoadSpec *ground_step_held_base(const Domain *domain, const Loading *loading);

/** Adds what is known of factors of safety that come out too low, as lines that begin with some words. */
void ground_step_tell_low(const Domain *domain, const Loading *loading, const char *before, Text *text);

#endif

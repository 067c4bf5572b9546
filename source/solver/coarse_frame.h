/* Axes of a body that turn with it: those of the coarse grid where what it leads to must be the same for each pose. */
#ifndef BRECCIA_SOLVER_COARSE_FRAME_H
#define BRECCIA_SOLVER_COARSE_FRAME_H

#include "body/particles.h"

/** Finds the centre of the volume of a body and axes through it: the principal axes of its second moments; in a plane in
 *  which these are equal the axes of the fourth moments, as of a square. Axes of a body that has neither, as of a disc, a
 *  sphere or a cube, are those of the deck. Mirror images have mirrored axes, up to their order and signs.
 *  @param[in] dimensions  of the body
 *  @param[out] centre     (length)
 *  @param[out] axes       [3][3] a unit vector in each row */
void coarse_frame_find(const Particles *particles, int dimensions, double centre[3], double axes[9]);

#endif

/* Axes that turn with a body. The coarse grid follows them where results must not depend on the pose of the body, that
 * is on its position and direction in space and on the order of its particles. */
#ifndef BRECCIA_SOLVER_COARSE_FRAME_H
#define BRECCIA_SOLVER_COARSE_FRAME_H

#include "body/particles.h"

/** Finds the centre of volume of a body and axes through that centre.
 *  - The axes are the principal axes of the second moments of volume.
 *  - Where two second moments are equal, as of a square, the axes of the fourth moments in their plane are taken.
 *  - Bodies without such axes, as discs, spheres and cubes, have the axes of the deck.
 *  Mirrored bodies have mirrored axes, up to their order and signs.
 *  @param[in] dimensions  of the body, 1 to 3
 *  @param[out] centre     [length]
 *  @param[out] axes       [3][3] a unit vector in each row */
void coarse_frame_find(const Particles *particles, int dimensions, double centre[3], double axes[9]);

#endif

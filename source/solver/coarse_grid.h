/* A regular grid of finite elements laid over the body, some horizon wide each, whose solution stands for the smooth part of a solution among particles.
 *
 * Elements are bilinear or trilinear, as stiff as the particles in them: their moduli, by their volume over the element's. Elements without particles have no
 * stiffness, and their corners no unknowns. What is held holds the grid by springs at the particles. Displacements of particles are interpolated
 * from the corners of their element, so that lattices, scattered particles, holes and several materials are all alike.
 * A library factors its equations (factors.h). */
#ifndef BRECCIA_SOLVER_COARSE_GRID_H
#define BRECCIA_SOLVER_COARSE_GRID_H

#include "solver/unknowns.h"

typedef struct CoarseGrid CoarseGrid;

/** Lays the grid over the body: elements at least 4/3 horizons wide, and so wide that the grid has few corners.
 *  @param[in] any_pose  true: the axes of the grid turn with the body, and the correction is the same for each pose, up
 *                       to round-off (coarse_frame.h); only for bodies without rotations. false: they are those of the
 *                       deck */
CoarseGrid *coarse_grid_create(const Domain *domain, bool any_pose, Error *error);
void coarse_grid_destroy(CoarseGrid **grid);

/** Assembles and factors the equations of the grid.
 *  @param[in] diagonal     [places] stiffness of each particle against being moved alone: how stiffly the grid is held where the particle is;
 *                          infinite: the particle has no part in it. Borrowed until the next time
 *  @param[in] turning      [places] the same against being turned; NULL without rotations
 *  @param[in] linearised  true: by the tangents at which the domain was linearised; false: by the elastic moduli
 *  @param[in] stiffness_share, mass_factor  as in LinearSolver */
int coarse_grid_prepare(CoarseGrid *grid, const Unknowns *unknowns, const double *diagonal, const double *turning,
                        bool linearised, double stiffness_share, double mass_factor, Error *error);

/** Adds to displacements v of all particles what the grid answers to forces f, by the team. Particles turn as the grid does where they are, by half of the
 *  curl of its displacements, and their moments act on it so. */
void coarse_grid_correct(CoarseGrid *grid, const Vector *f, const Vector *v);

size_t coarse_grid_bytes(const CoarseGrid *grid);

#endif

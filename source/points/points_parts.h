/* What stands behind the door of points: plane stress (plane_stress.c), and laws in other processes (servers.c). */
#ifndef BRECCIA_POINTS_PARTS_H
#define BRECCIA_POINTS_PARTS_H

#include "points/points.h"

/** Part of a batch of points of so many components. */
breccia_batch batch_part(const breccia_batch *whole, const Material *m, int components, int first, int count);

/** Update in plane stress: finds the strains zz.
 *  @return -1, or the index of a point whose law could not be integrated */
int plane_stress_update(const Material *m, breccia_batch *batch, double *strain_zz);

/** Numbers the points and divides them among the servers. */
int point_servers_create(Points *points, const uint8_t *present, Error *error);
void point_servers_destroy(Points *points);
/** Tells the servers that the trial state is the committed one. */
void point_servers_commit(Points *points);
/** points_update out of what was awaited. */
int64_t point_servers_answer(const Points *points, const Material *m, const breccia_batch *batch, int64_t first);
/** Stress of a point of one strain, as of its last answer. */
double point_servers_last_stress(const double *row);

#endif

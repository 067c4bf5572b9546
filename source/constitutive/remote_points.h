/* Points of laws that run in other processes: which server holds which, and what is sent and received. */
#ifndef BRECCIA_CONSTITUTIVE_REMOTE_POINTS_H
#define BRECCIA_CONSTITUTIVE_REMOTE_POINTS_H

#include "constitutive/points.h"

/** Numbers the points and divides them among the servers. */
int remote_points_create(Points *points, Error *error);
void remote_points_destroy(Points *points);
/** Tells the servers that the trial state is the committed one. */
void remote_points_commit(Points *points);
/** Stress of a point of a law of one strain, as of its last answer. */
double remote_last_stress(const double *row);

/** `points_update_bonds` of a remote law, in the pass that is going on. @return -1, or the index of a point without an answer */
int remote_points_bonds(const Points *points, const Material *m, const breccia_batch *batch);

/** Where the row of a bond's point begins, of its own law or of that at the other end (points.c). */
int64_t points_bond_row(const Points *points, int64_t slice, int64_t slot, int lane, bool partner);
const Material *points_partner(const Points *points, int64_t slot, int lane);

#endif

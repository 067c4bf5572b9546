/* What stands behind the door of points: tangents and secants (points_tangents.c), trials (points_trials.c), plane stress (plane_stress.c), laws in other
 * processes (servers.c), and histories that nothing has happened to (untouched.c). */
#ifndef BRECCIA_POINTS_PARTS_H
#define BRECCIA_POINTS_PARTS_H

#include "points/points.h"

enum { MOST_TRIED_VALUES = 256 }; /* history numbers of a point that can be tried out */

/** Where the tangents from a row of run n on are kept; NULL: its law is linear. */
double *points_kept_tangent(const Points *points, int64_t n, int64_t row);

/** What laws see of rows of one run. */
void points_make_batch(breccia_batch *batch, const Points *points, int64_t first, int count, double *const *strain,
                       double *const *stress);

/** Asks a law, in plane stress such that stresses zz vanish, with the strengths of the rows.
 *  @param[in] first  row of the first point
 *  @return -1, or the index of a point whose law could not be integrated */
int points_update_batch(const Points *points, const Material *m, breccia_batch *batch, int64_t first,
                        double *const strain[6]);

/** In place of the tangents of rows whose law softens: its first moduli times the share of them with which a point unloads, or that stands between its
 *  stress and its strain. */
void points_take_secants(const Points *points, int64_t first, int count, double *const strain[6],
                         double *const stress[6]);

/** Asks a law with the strengths of the rows, which points_update_batch does where plane stress wants it.
 *  @param[in] first          row of the first point
 *  @param[in,out] strain_zz  strains zz, which are found such that stresses zz vanish; NULL: strains stay
 *  @return -1, or the index of a point whose law could not be integrated */
int points_ask_law(const Points *points, const Material *m, breccia_batch *batch, int64_t first, double *strain_zz);

/** Part of a batch of points of so many components. */
breccia_batch batch_part(const breccia_batch *whole, const Material *m, int components, int first, int count);

/** Update in plane stress: finds the strains zz.
 *  @return -1, or the index of a point whose law could not be integrated */
int plane_stress_update(const Material *m, breccia_batch *batch, double *strain_zz);

enum { UNTOUCHED_NUMBERS = 4 * BATCH }; /* of the histories of a batch of untouched rows, at most */

int untouched_create(Points *points, Error *error);
void untouched_destroy(Points *points);
/** Finds again which rows are untouched: the committed histories were put in place from outside. */
void untouched_find(Points *points);
/** Notes that a row is no longer untouched. */
void untouched_leave(const Points *points, int64_t row);
/** Gives a batch whose rows are all untouched the history that its law begins with, and a trial one of its own.
 *  @param[out] trial  [UNTOUCHED_NUMBERS]
 *  @return whether they are */
bool untouched_batch(const Points *points, int material, int64_t first, int count, breccia_batch *batch, double *trial);
/** Takes up what a law has written into the trial histories of an untouched batch, if it remembers anything.
 *  @param[out] own  where the trial histories of these rows stand */
void untouched_keep(Points *points, int material, int64_t first, int count, const double *trial, double *own);

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

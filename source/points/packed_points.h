/* Some points of a batch side by side: where few of them are still looked for, laws need not be asked about the others. */
#ifndef BRECCIA_POINTS_PACKED_POINTS_H
#define BRECCIA_POINTS_PACKED_POINTS_H

#include "points/points.h"

enum { PACKED_VALUES = 16 }; /* of histories of points that are packed, at most */

/** Points out of a whole batch, with room for all of it. */
typedef struct PackedPoints {
  int of[BATCH]; /* which points of the whole batch */
  double strain[6][BATCH], stress[6][BATCH], length[BATCH], tangent[36 * BATCH];
  double committed[PACKED_VALUES * BATCH], trial[PACKED_VALUES * BATCH];
} PackedPoints;

/** Whether points of a material can be packed: those of servers are known there by their places, laws may ask where points stand, and long histories have no room. */
bool packed_points_take(const Material *m);

/** Takes points out of a batch, the whole one or the packed one itself, with strains, histories and lengths.
 *  @param[in] is_packed  it is the packed one @param[in] chosen  [count] rising numbers of points */
void packed_points_pack(PackedPoints *packed, const Material *m, const breccia_batch *from, bool is_packed,
                        const int *chosen, int count);

/** What a law updates instead of the whole batch; tangents, where that wants any. */
breccia_batch packed_points_batch(PackedPoints *packed, const breccia_batch *whole, int count);

/** What the law answered for packed point j, to its place in the whole batch. @param[out] strain_zz  of the whole batch */
void packed_points_give_back(const PackedPoints *packed, const Material *m, int j, const breccia_batch *whole,
                             double *strain_zz);

#endif

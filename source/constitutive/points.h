/* Material points: strain, stress and history, committed and trial, one point per place.
 *
 * Strain and stress are arrays by component; histories are rows per point, because a law with a long history touches little of
 * it. All points of a slice are of one material. Commit is a swap. */
#ifndef BRECCIA_CONSTITUTIVE_POINTS_H
#define BRECCIA_CONSTITUTIVE_POINTS_H

#include "body/body.h"
#include "constitutive/material.h"

enum { BLOCK = 128 }; /* places worked on together: their strains, stresses and states stay in the first-level cache */

typedef struct Points {
  int64_t places;
  Space space;
  bool kept;
  double *strain[6], *stress[6]; /* [places]; if no point is kept, what domain_observe has found */
  double *committed, *trial;
  size_t history_size;    /* numbers in each of them */
  int64_t *history_start; /* [slices] */
  const Material *materials;
  const int32_t *material; /* [slices] */
  int elastic_stage;       /* laws respond elastically while it is set */
} Points;

/** @param[in] material  [slices] which of the materials; both arrays are borrowed
 *  @param[in] kept      false: linear laws on bonds need no points; points_update then does nothing */
int points_create(Points *points, int64_t slices, Space space, const Material *materials, const int32_t *material,
                  bool kept, Error *error);
void points_destroy(Points *points);

/** Stress and trial history of slices first .. last - 1 from their strains; they must be of one material and at most BLOCK
 *  places. In plane stress the strain zz is found such that the stress zz vanishes.
 *  @param[out] tangent  [places][36] or NULL; in plane stress the rows and columns of zz are condensed out
 *  @return -1, or a place whose law could not be integrated */
int64_t points_update(Points *points, int64_t first, int64_t last, double *tangent);

/** Makes the trial state the committed one. */
void points_commit(Points *points);

#endif

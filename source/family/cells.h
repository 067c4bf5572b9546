/* Particles sorted into cubic cells at least as wide as a reach: all within reach of a point lie in the 27 cells around it. */
#ifndef BRECCIA_FAMILY_CELLS_H
#define BRECCIA_FAMILY_CELLS_H

#include "body/particles.h"

typedef struct Cells {
  double low[3], width;
  int64_t count[3];
  int64_t *first;   /* [cells + 1] */
  int32_t *places;  /* cell by cell, ascending by number within one */
  double *position; /* [particles][3] in the same order */
} Cells;

/** @param[in] position  where the particles are taken to be, [places] each; what is not a finite number falls into the first cell. Without memory for them nothing is left to destroy */
int cells_create(Cells *cells, const Particles *particles, const double *const position[3], double reach, Error *error);
void cells_destroy(Cells *cells);

/** The particles around a point as rows of cells: entries rows[r][0] .. rows[r][1] - 1 of `places` and `position`.
 *  @return how many rows, at most 9 */
int cells_around(const Cells *cells, const double point[3], int64_t rows[9][2]);

#endif

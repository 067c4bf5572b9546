/* What laws of one strain with memory share: one point at a time out of a batch. */
#ifndef BRECCIA_CONSTITUTIVE_UNIAXIAL_LAW_H
#define BRECCIA_CONSTITUTIVE_UNIAXIAL_LAW_H

#include "constitutive/law.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

typedef struct UniaxialPoint {
  double strain;          /* in, total */
  double stress, tangent; /* out */
  const double *committed;
  double *trial; /* a copy of the committed history at first */
} UniaxialPoint;

/** x, but not below `low` nor above `high`. By comparisons, which cost a tenth of fmin and fmax; NaN stays NaN. */
static inline double uniaxial_between(double low, double x, double high)
{
  x = x > high ? high : x;
  return x < low ? low : x;
}

typedef void (*UniaxialPointUpdate)(const void *constants, UniaxialPoint *point);

/** In the elastic stage stress is `young` times the strain beyond that of no stress at first (`slack`), and history numbers 0 and 1, which are the last
 *  strain and stress if `remembers`, follow. */
__attribute__((always_inline)) static inline int uniaxial_update(const void *constants, const breccia_batch *batch,
                                                                 int history_values, double young, double slack,
                                                                 bool remembers, UniaxialPointUpdate update_point)
{
  for (int i = 0; i < batch->count; ++i) {
    UniaxialPoint point = {.strain = batch->strain[0][i],
                           .committed = batch->committed + (ptrdiff_t)history_values * i,
                           .trial = batch->trial + (ptrdiff_t)history_values * i};
    memcpy(point.trial, point.committed, sizeof(double) * (size_t)history_values);
    if (batch->elastic_stage) {
      point.stress = young * (point.strain - slack);
      point.tangent = young;
    } else {
      update_point(constants, &point);
    }
    if (!isfinite(point.stress)) return i;
    if (remembers) {
      point.trial[0] = point.strain;
      point.trial[1] = point.stress;
    }
    batch->stress[0][i] = point.stress;
    if (batch->tangent) batch->tangent[i] = point.tangent;
  }
  return -1;
}

#endif

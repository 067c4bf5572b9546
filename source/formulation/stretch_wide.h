/* Stretches of whole lattice slots on long vectors, by the series of small ones (formulation/stretch.h). */
#ifndef BRECCIA_FORMULATION_STRETCH_WIDE_H
#define BRECCIA_FORMULATION_STRETCH_WIDE_H

#include "base/wide.h"
#include "formulation/stretch.h"

/** -|xi|^2 d of a slot, and 2 y.
 *  @param[in] doubled[k] 2 xi
 *  @param[in] there      place of the first neighbour */
LANES_INLINE Wide stretch_wide(double *const u[3], const double *const doubled[3], int64_t there, const Wide own[3],
                               Wide twice[3])
{
  Wide d = {0};
  for (int k = 0; k < 3; ++k) {
    const Wide back = own[k] - wide_load(u[k] + there);
    const Wide middle = wide_set(*doubled[k]) - back;
    twice[k] = middle - back;
    d += back * middle;
  }
  return d;
}

/** A series in -|xi|^2 d, by pairs. @param[in] stride  from one of its terms to the next */
LANES_INLINE Wide stretch_wide_series(const double *terms, int stride, Wide d)
{
  const Wide square = d * d;
  Wide pair[STRETCH_TERMS / 2];
  for (int n = 0; n < STRETCH_TERMS; n += 2)
    pair[n / 2] = wide_set(terms[stride * n]) + d * wide_set(terms[stride * (n + 1)]);
  return d * (pair[0] + square * (pair[1] + square * pair[2]));
}

#endif

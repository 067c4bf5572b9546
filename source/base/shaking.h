/* What shaking is and what it does: its intensity, and the answers of oscillators that stand on it. Accelerations at times, straight lines between. */
#ifndef BRECCIA_BASE_SHAKING_H
#define BRECCIA_BASE_SHAKING_H

#include "base/error.h"

typedef struct Shaking {
  const double *times, *values; /* [count] ascending; accelerations */
  int count;                    /* 2 or more */
} Shaking;

/** Velocities and displacements from rest, [count] each: exact for straight lines. */
void shaking_integrate(const Shaking *shaking, double *velocities, double *displacements);

/** Integral of the squares of accelerations up to each time, [count]: exact for straight lines. Times pi / (2 g) it is Arias' intensity (Arias 1970),
 *  and over its last value Husid's curve (Husid 1969). */
void shaking_squares(const Shaking *shaking, double *sums);

/** When growing sums reach a share of the last of them; between times by straight lines. NaN where all are 0. */
double shaking_time_of(const double *times, const double *sums, int count, double share);

typedef struct Response {        /* largest sizes */
  double displacement, velocity; /* of the oscillator against its base */
  double acceleration;           /* of both together */
} Response;

/** How an oscillator answers that is at rest at first, x'' + 2 damping omega x' + omega^2 x = -values. Each straight line is solved in closed form
 *  (Nigam and Jennings 1969, Bull. Seism. Soc. Am. 59, 909), whatever its length; sizes are looked at 60 times a period or more, which misses
 *  1.4e-3 of a peak at most, and for a period after the end, when the base moves on evenly.
 *  @param[in] period   positive
 *  @param[in] damping  share of the critical one, 0 to below 1 */
Response shaking_response(const Shaking *shaking, double period, double damping);

#endif

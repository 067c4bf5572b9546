/* Values at equal steps of time: trends and frequencies taken out of them. */
#ifndef BRECCIA_BASE_SIGNAL_H
#define BRECCIA_BASE_SIGNAL_H

#include "base/error.h"

enum { SIGNAL_DEGREES = 4 }; /* of polynomials: constant to cubic */

/** Takes off the polynomial of a degree below SIGNAL_DEGREES that is closest to the values by least squares. More values than its degree. */
void signal_take_off(double *values, int count, int degree);

typedef struct Band {
  double from, to; /* corner frequencies [1/time]; NaN: none. `to` is below half of one over the step */
  int order;       /* of Butterworth's filter, 1 or more */
} Band;

/** What Butterworth filters leave (high pass at `from`, low pass at `to`, each by the bilinear transformation with its corner kept): once
 *  forwards, once backwards, so that nothing is shifted in time. A sine of frequency f keeps 1 / (1 + (from / f)^(2 order)) of its
 *  amplitude, and 1 / (1 + (f / to)^(2 order)) of that, where tan(pi f step) stands for each frequency. Outside its ends the signal is taken
 *  as zero for 1.5 order / from (Boore 2005, Bull. Seism. Soc. Am. 95, 745); these pads are left out of the answer. */
int signal_band_pass(double *values, int count, double step, const Band *band, Error *error);

#endif

/* Amplitudes of frequencies in values at equal steps. */
#ifndef BRECCIA_BASE_FOURIER_H
#define BRECCIA_BASE_FOURIER_H

#include "base/error.h"

/** Numbers that a transform takes: a power of two, `count` or more. @param[in] count  at most 2^29 */
int fourier_size(int count);

/** |integral of values exp(-2 pi i f t) dt| at the frequencies f = k / (size step), [size / 2 + 1] of them; zeros follow the values. */
int fourier_amplitudes(const double *values, int count, double step, int size, double *amplitudes, Error *error);

/** Mean of amplitudes about a frequency, weighted by (sin(z) / z)^4 with z = bandwidth log10(f / frequency), up to the first zeros of that (Konno and
 *  Ohmachi 1998, Bull. Seism. Soc. Am. 88, 228): as wide on logarithmic axes wherever it stands.
 *  @param[in] amplitudes  [count] at the frequencies k times `spacing`; that of 0 has no part
 *  @return the straight line between the amplitudes beside it where none is near enough */
double fourier_smooth(const double *amplitudes, int count, double spacing, double frequency, double bandwidth);

#endif

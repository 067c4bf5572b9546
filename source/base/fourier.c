#include "base/fourier.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

int fourier_size(int count)
{
  int size = 2;
  while (size < count) size *= 2;
  return size;
}

/** To the places that numbers have with their binary digits the other way round. */
static void reorder(double *re, double *im, int size)
{
  for (int k = 1, mirror = 0; k < size; ++k) {
    int bit = size / 2;
    for (; mirror & bit; bit /= 2) mirror ^= bit;
    mirror |= bit;
    if (k >= mirror) continue;
    const double r = re[k], i = im[k];
    re[k] = re[mirror];
    im[k] = im[mirror];
    re[mirror] = r;
    im[mirror] = i;
  }
}

/** Cooley and Tukey's transform in place, exp(-2 pi i j k / size). @param[in] turns  [size / 2] cosines and sines in turn */
static void transform(double *re, double *im, int size, const double *turns)
{
  reorder(re, im, size);
  for (int half = 1; half < size; half *= 2)
    for (int first = 0; first < size; first += 2 * half)
      for (int k = 0; k < half; ++k) {
        const double *turn = turns + 2 * (size_t)k * (size_t)(size / 2 / half);
        const int a = first + k, b = a + half;
        const double r = turn[0] * re[b] + turn[1] * im[b], i = turn[0] * im[b] - turn[1] * re[b];
        re[b] = re[a] - r;
        im[b] = im[a] - i;
        re[a] += r;
        im[a] += i;
      }
}

int fourier_amplitudes(const double *values, int count, double step, int size, double *amplitudes, Error *error)
{
  const size_t n = (size_t)size;
  double *work = memory_zeroed(3 * n, sizeof *work, "spectrum", error), *re = work, *im = work + n,
         *turns = work + 2 * n;
  if (!work) return BRECCIA_FAILURE;
  for (int k = 0; k < count; ++k) re[k] = values[k];
  for (int k = 0; k < size / 2; ++k) {
    turns[2 * k] = cos(2 * acos(-1) * k / size);
    turns[2 * k + 1] = sin(2 * acos(-1) * k / size);
  }
  transform(re, im, size, turns);
  for (int k = 0; k <= size / 2; ++k) amplitudes[k] = step * hypot(re[k], im[k]);
  free(work);
  return BRECCIA_OK;
}

double fourier_smooth(const double *amplitudes, int count, double spacing, double frequency, double bandwidth)
{
  const double reach = pow(10, acos(-1) / bandwidth), most = count - 1;
  const int first = (int)fmin(most, fmax(1, ceil(frequency / reach / spacing)));
  const int last = (int)fmin(most, floor(frequency * reach / spacing));
  double sum = 0, weights = 0;
  for (int k = first; k <= last; ++k) {
    const double z = bandwidth * log10(k * spacing / frequency), part = fabs(z) < 1e-6 ? 1 : sin(z) / z;
    const double weight = part * part * part * part;
    sum += weight * amplitudes[k];
    weights += weight;
  }
  if (weights > 1e-6) return sum / weights;
  const double at = fmin(most, frequency / spacing);
  const int below = (int)fmin(most - 1, floor(at));
  return amplitudes[below] + (at - below) * (amplitudes[below + 1] - amplitudes[below]);
}

#include "measure.h"

#include "base/lanes.h"
#include <math.h>
#include <stdlib.h>
#ifdef _OPENMP
#include <omp.h>
#endif

int all_threads(void)
{
#ifdef _OPENMP
  return omp_get_num_procs();
#else
  return 1;
#endif
}

void use_threads(int threads)
{
#ifdef _OPENMP
  omp_set_num_threads(threads);
#else
  (void)threads;
#endif
}

static int by_value(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

double median(double *values, int count)
{
  qsort(values, (size_t)count, sizeof *values, by_value);
  return values[count / 2];
}

double stream_bandwidth(void)
{
  const int64_t n = 1 << 24;
  double *a = malloc(sizeof(double) * (size_t)n), *b = malloc(sizeof(double) * (size_t)n),
         *c = malloc(sizeof(double) * (size_t)n);
  if (!a || !b || !c) return NAN;
  double seconds[REPEATS];
  for (int r = -1; r < REPEATS; ++r) {
    double start = clock_seconds();
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < n; ++i)
      if (r < 0)
        a[i] = b[i] = c[i] = 1;
      else
        a[i] = b[i] + 3 * c[i];
    if (r >= 0) seconds[r] = clock_seconds() - start;
  }
  double rate = 3 * sizeof(double) * (double)n / median(seconds, REPEATS) / 1e9 + 0 * a[n / 2];
  free(a);
  free(b);
  free(c);
  return rate;
}

BRECCIA_CLONES
static double multiply_add(int64_t rounds)
{
  enum { CHAINS = 10 };
  Lanes sum[CHAINS], x = lanes_set(1.000000001), y = lanes_set(1e-9);
  for (int k = 0; k < CHAINS; ++k) sum[k] = lanes_set(k);
  for (int64_t r = 0; r < rounds; ++r)
    for (int k = 0; k < CHAINS; ++k) sum[k] = sum[k] * x + y;
  double total = 0;
  for (int k = 0; k < CHAINS; ++k)
    for (int l = 0; l < LANES; ++l) total += sum[k][l];
  return total;
}

double multiply_add_rate(void)
{
  const int64_t rounds = 20000000;
  double seconds[REPEATS], sink = 0;
  for (int r = 0; r < REPEATS; ++r) {
    double start = clock_seconds();
    sink += multiply_add(rounds);
    seconds[r] = clock_seconds() - start;
  }
  return 2.0 * 10 * LANES * (double)rounds / median(seconds, REPEATS) / 1e9 + 0 * sink;
}

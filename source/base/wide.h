/* Long vectors: eight doubles side by side, a whole slice, for processors that hold as many in a register (AVX-512). The same operations in the same
 * order as on two short ones (base/lanes.h), so the same bits, with half as many instructions: 15 % of a sweep. On processors with shorter registers
 * the sums would not fit, and such loops take twice as long; therefore sweeps that have them keep their loops over short vectors too, and ask
 * wide_lanes_pay() when they are made. */
#ifndef BRECCIA_BASE_WIDE_H
#define BRECCIA_BASE_WIDE_H

#include "base/lanes.h"

#include <stdbool.h>

typedef double Wide __attribute__((vector_size(8 * SLICE)));
typedef int64_t WideMask __attribute__((vector_size(8 * SLICE)));

/* Stands before functions with long vectors. */
#if defined(__x86_64__) && !defined(__clang__) && !defined(BRECCIA_NO_CLONES)
#define BRECCIA_WIDE __attribute__((target("arch=x86-64-v4")))
#else
#define BRECCIA_WIDE
#endif

static inline bool wide_lanes_pay(void)
{
#if defined(__AVX512F__)
  return true;
#elif defined(__x86_64__) && !defined(__clang__) && !defined(BRECCIA_NO_CLONES)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

LANES_INLINE Wide wide_load(const double *from)
{
  Wide wide;
  memcpy(&wide, from, sizeof wide);
  return wide;
}

LANES_INLINE void wide_store(double *to, Wide wide)
{
  memcpy(to, &wide, sizeof wide);
}

/** One number in all lanes; by way of its bits as in lanes_set. */
LANES_INLINE Wide wide_set(double value)
{
  int64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return (Wide)(WideMask){bits, bits, bits, bits, bits, bits, bits, bits};
}

/** `wide` in the lanes whose bit is set, zero elsewhere. */
LANES_INLINE Wide wide_where(uint8_t bits, Wide wide)
{
  const WideMask all = {bits, bits, bits, bits, bits, bits, bits, bits}, one = {1, 2, 4, 8, 16, 32, 64, 128};
  return (Wide)((WideMask)wide & (WideMask)((all & one) != 0));
}

LANES_INLINE Wide wide_absolute(Wide a)
{
  const WideMask magnitude = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
  return (Wide)((WideMask)a & magnitude);
}

/** True if any lane of a mask is set. */
LANES_INLINE bool wide_any(WideMask mask)
{
  int64_t any = 0;
  for (int lane = 0; lane < SLICE; ++lane) any |= mask[lane];
  return any;
}

#endif

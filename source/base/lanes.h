/* Short vectors: four doubles side by side, written with the compilers' own vector types so that one text serves
 * every processor. A slice is eight particles: two such vectors. Eight, because one byte then holds the intact bits of
 * a slot; four per vector, because a 3 x 3 accumulator and its operands then fit in the 16 registers of AVX2. */
#ifndef BRECCIA_BASE_LANES_H
#define BRECCIA_BASE_LANES_H

#include <stdint.h>
#include <string.h>

enum { LANES = 4, SLICE = 8 };

typedef double Lanes __attribute__((vector_size(32)));
typedef int64_t LaneMask __attribute__((vector_size(32)));

/* Hot loops are compiled once per processor generation and chosen when the program starts. The sanitizers' start-up
 * comes after that choice, so their builds have the plain version only; and clang does not let functions of another
 * generation pass vectors to inlined ones, so that with clang -march=native is the way to speed. */
#if defined(__x86_64__) && !defined(__clang__) && !defined(BRECCIA_NO_CLONES)
#define BRECCIA_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BRECCIA_CLONES
#endif

#define LANES_INLINE static inline __attribute__((always_inline))

LANES_INLINE Lanes lanes_load(const double *from)
{
  Lanes lanes;
  memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

LANES_INLINE void lanes_store(double *to, Lanes lanes)
{
  memcpy(to, &lanes, sizeof lanes);
}

LANES_INLINE Lanes lanes_set(double value)
{
  return (Lanes){value, value, value, value};
}

LANES_INLINE Lanes lanes_gather(const double *from, const int32_t *index)
{
  return (Lanes){from[index[0]], from[index[1]], from[index[2]], from[index[3]]};
}

/** All bits set in the lanes whose bit (0 to 3) is set in `bits`. Looked up: computing it took two registers that the sweeps
 *  need for their sums. */
LANES_INLINE LaneMask lanes_mask(unsigned bits)
{
  static const LaneMask masks[16] = {{0, 0, 0, 0},   {-1, 0, 0, 0},   {0, -1, 0, 0},   {-1, -1, 0, 0},
                                     {0, 0, -1, 0},  {-1, 0, -1, 0},  {0, -1, -1, 0},  {-1, -1, -1, 0},
                                     {0, 0, 0, -1},  {-1, 0, 0, -1},  {0, -1, 0, -1},  {-1, -1, 0, -1},
                                     {0, 0, -1, -1}, {-1, 0, -1, -1}, {0, -1, -1, -1}, {-1, -1, -1, -1}};
  return masks[bits];
}

/** The lanes of `lanes` where the mask is set, zero elsewhere. */
LANES_INLINE Lanes lanes_where(LaneMask mask, Lanes lanes)
{
  return (Lanes)((LaneMask)lanes & mask);
}

LANES_INLINE Lanes lanes_root(Lanes x)
{
  return (Lanes){__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])};
}

/** The smaller of two, lane by lane; a where b is not a number. */
LANES_INLINE Lanes lanes_least(Lanes a, Lanes b)
{
  LaneMask smaller = b < a;
  return lanes_where(smaller, b) + lanes_where(~smaller, a);
}

LANES_INLINE Lanes lanes_absolute(Lanes a)
{
  const LaneMask magnitude = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
  return (Lanes)((LaneMask)a & magnitude);
}

/** Sum of the four lanes, always in the same order. */
LANES_INLINE double lanes_total(Lanes a)
{
  return (a[0] + a[1]) + (a[2] + a[3]);
}

#endif

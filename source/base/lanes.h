/* Short vectors: doubles side by side, written with the compilers' own vector types so that one text serves every processor. A slice is eight
 * particles, because one byte then holds the intact bits of a slot. A vector has four lanes, because a 3 x 3 accumulator and its operands then
 * fit in the 16 registers of AVX2: a slice is two of them, its halves. The hottest files are compiled for more than one kind of processor
 * (base/lane_kinds.h), and with eight lanes for those of AVX-512: there the first half is the whole slice, and there is no other.
 * A lane is a particle, so that bits do not depend on how many there are. */
#ifndef BRECCIA_BASE_LANES_H
#define BRECCIA_BASE_LANES_H

#include <stdint.h>
#include <string.h>

#ifdef BRECCIA_EIGHT_LANES
enum { LANES = 8 };
#else
enum { LANES = 4 };
#endif
enum { SLICE = 8, HALVES = SLICE / LANES, QUAD = 4 };

typedef double Lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t LaneMask __attribute__((vector_size(8 * LANES)));
/* Four numbers, however many lanes there are. */
typedef double Quad __attribute__((vector_size(8 * QUAD)));
/* The same where they stand in memory, at any number. Copied by memcpy, gcc takes them for integers, and hands them over to arithmetic through the stack. */
typedef double LanesInMemory __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
typedef double QuadInMemory __attribute__((vector_size(8 * QUAD), aligned(8), may_alias));

/* Hot loops in files that are compiled once are compiled once per processor generation and chosen when the program starts. The sanitizers' start-up
 * comes after that choice, so their builds have the plain version only; and clang does not let functions of another generation pass vectors to
 * inlined ones. */
#if defined(__x86_64__) && !defined(__clang__) && !defined(BRECCIA_NO_CLONES) && !defined(BRECCIA_LANE_KIND)
#define BRECCIA_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BRECCIA_CLONES
#endif

/* Before a loop none of whose turns reads what another one writes, so that the compiler need not make sure before it takes several
 * turns at once. */
#ifdef BRECCIA_NARROW_LANES
#define LANES_INDEPENDENT
#elif defined(__clang__)
#define LANES_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define LANES_INDEPENDENT _Pragma("GCC ivdep")
#endif

#define LANES_INLINE static inline __attribute__((always_inline))

/* The thread sanitizer sees no loads and stores of more than 16 bytes: for it (BRECCIA_NARROW_LANES) they are made one by one. */
LANES_INLINE Lanes lanes_load(const double *from)
{
#ifdef BRECCIA_NARROW_LANES
  Lanes lanes;
  for (int k = 0; k < LANES; ++k) lanes[k] = from[k];
  return lanes;
#else
  return *(const LanesInMemory *)from;
#endif
}

LANES_INLINE void lanes_store(double *to, Lanes lanes)
{
#ifdef BRECCIA_NARROW_LANES
  for (int k = 0; k < LANES; ++k) to[k] = lanes[k];
#else
  *(LanesInMemory *)to = lanes;
#endif
}

LANES_INLINE Quad quad_load(const double *from)
{
#ifdef BRECCIA_NARROW_LANES
  Quad quad;
  for (int k = 0; k < QUAD; ++k) quad[k] = from[k];
  return quad;
#else
  return *(const QuadInMemory *)from;
#endif
}

LANES_INLINE void quad_store(double *to, Quad quad)
{
#ifdef BRECCIA_NARROW_LANES
  for (int k = 0; k < QUAD; ++k) to[k] = quad[k];
#else
  *(QuadInMemory *)to = quad;
#endif
}

/** The lanes of `lanes` where the mask is set, zero elsewhere. */
LANES_INLINE Lanes lanes_where(LaneMask mask, Lanes lanes)
{
  return (Lanes)((LaneMask)lanes & mask);
}

#ifdef BRECCIA_EIGHT_LANES
#include "base/lanes_eight.h"
#else
#include "base/lanes_four.h"
#endif

/** a b, rounded by itself: of two products that are added a compiler may fuse either with the sum, and the bits differ. Here it is fused with nothing. */
LANES_INLINE Lanes lanes_product(Lanes a, Lanes b)
{
  return lanes_set(0) + a * b;
}

/* Sums of products, each in one order for all kinds of vectors. */
LANES_INLINE Lanes lanes_dot(Lanes a, Lanes b, Lanes c, Lanes d, Lanes e, Lanes f)
{
  return (lanes_product(a, b) + c * d) + e * f;
}
LANES_INLINE Lanes lanes_square(Lanes a, Lanes b, Lanes c)
{
  return lanes_dot(a, a, b, b, c, c);
}
/** a b - c d */
LANES_INLINE Lanes lanes_cross(Lanes a, Lanes b, Lanes c, Lanes d)
{
  return lanes_product(a, b) - c * d;
}

/** e^x = power (1 + part); x is limited to -708 to 709. */
LANES_INLINE void lanes_split_exponential(Lanes x, Lanes *power, Lanes *part)
{
  x = lanes_least(lanes_greatest(x, lanes_set(-708)), lanes_set(709));
  /* x = n ln 2 + r: adding 3 * 2^51 leaves n in the low bits. */
  const Lanes round = lanes_set(6755399441055744.0), shifted = x * lanes_set(1.4426950408889634) + round,
              n = shifted - round;
  const Lanes r = (x - n * lanes_set(6.93147180369123816490e-01)) - n * lanes_set(1.90821492927058770002e-10),
              r2 = r * r;
  /* Taylor's series in pairs: less to wait for than one term after another. */
  Lanes p = lanes_set(1.0 / 6227020800) * r + lanes_set(1.0 / 479001600);
  p = p * r2 + (lanes_set(1.0 / 39916800) * r + lanes_set(1.0 / 3628800));
  p = p * r2 + (lanes_set(1.0 / 362880) * r + lanes_set(1.0 / 40320));
  p = p * r2 + (lanes_set(1.0 / 5040) * r + lanes_set(1.0 / 720));
  p = p * r2 + (lanes_set(1.0 / 120) * r + lanes_set(1.0 / 24));
  p = p * r2 + (lanes_set(1.0 / 6) * r + lanes_set(0.5));
  *part = p * r2 + r;
  *power = (Lanes)((LaneMask)lanes_set(1) + ((LaneMask)shifted << 52));
}

/** e^x - 1 to its last digits, also for small x; below -708 it is -1, above 709 it is 8e307. x must be a number. */
LANES_INLINE Lanes lanes_exponential_less_one(Lanes x)
{
  Lanes power, part;
  lanes_split_exponential(x, &power, &part);
  return power * part + (power - lanes_set(1));
}

/** e^x to its last digits, from -708 to 709 as above. */
LANES_INLINE Lanes lanes_exponential(Lanes x)
{
  Lanes power, part;
  lanes_split_exponential(x, &power, &part);
  return power * part + power;
}

/** The natural logarithm of a positive number that is neither infinite nor below 2e-308, to its last digits. */
LANES_INLINE Lanes lanes_logarithm(Lanes x)
{
  /* x = 2^n m with m from sqrt(1/2) to sqrt(2), ln m = 2 artanh(s), s = (m - 1) / (m + 1): at most 0.172. */
  const LaneMask one = (LaneMask)lanes_set(1), half_root = (LaneMask)lanes_set(0.70710678118654752),
                 moved = (LaneMask)x + (one - half_root), mantissa = (LaneMask){0} + 0xfffffffffffffll;
  const Lanes m = (Lanes)((moved & mantissa) + half_root), round = lanes_set(6755399441055744.0),
              n = ((Lanes)((moved >> 52) + (LaneMask)round) - round) - lanes_set(1023);
  const Lanes s = (m - lanes_set(1)) / (m + lanes_set(1)), s2 = s * s;
  Lanes p = lanes_set(2.0 / 21) * s2 + lanes_set(2.0 / 19);
  p = p * s2 + lanes_set(2.0 / 17);
  p = p * s2 + lanes_set(2.0 / 15);
  p = p * s2 + lanes_set(2.0 / 13);
  p = p * s2 + lanes_set(2.0 / 11);
  p = p * s2 + lanes_set(2.0 / 9);
  p = p * s2 + lanes_set(2.0 / 7);
  p = p * s2 + lanes_set(2.0 / 5);
  p = p * s2 + lanes_set(2.0 / 3);
  p = p * lanes_product(s2, s) + (s + s);
  return n * lanes_set(6.93147180369123816490e-01) + (n * lanes_set(1.90821492927058770002e-10) + p);
}

/** Sine and cosine to their last digits, of angles up to a hundred thousand turns. */
LANES_INLINE void lanes_sine_cosine(Lanes x, Lanes *sine, Lanes *cosine)
{
  /* x = n pi/2 + r: adding 3 * 2^51 leaves n in the low bits. Three parts of pi/2, the first two with zeros at their ends. */
  const Lanes round = lanes_set(6755399441055744.0), shifted = x * lanes_set(0.63661977236758134308) + round,
              n = shifted - round;
  const Lanes r = ((x - n * lanes_set(0x1.921fb544p+0)) - n * lanes_set(0x1.0b4611a6p-34)) -
                  n * lanes_set(0x1.3198a2e037073p-69),
              r2 = r * r;
  /* Taylor's series: the next terms are below 5e-17 up to pi/4. */
  Lanes s = lanes_set(-1.0 / 1307674368000) * r2 + lanes_set(1.0 / 6227020800);
  s = s * r2 + lanes_set(-1.0 / 39916800);
  s = s * r2 + lanes_set(1.0 / 362880);
  s = s * r2 + lanes_set(-1.0 / 5040);
  s = s * r2 + lanes_set(1.0 / 120);
  s = s * r2 + lanes_set(-1.0 / 6);
  s = s * r2 * r + r;
  Lanes c = lanes_set(1.0 / 20922789888000) * r2 + lanes_set(-1.0 / 87178291200);
  c = c * r2 + lanes_set(1.0 / 479001600);
  c = c * r2 + lanes_set(-1.0 / 3628800);
  c = c * r2 + lanes_set(1.0 / 40320);
  c = c * r2 + lanes_set(-1.0 / 720);
  c = c * r2 + lanes_set(1.0 / 24);
  c = c * r2 * r2 + (lanes_set(1) - lanes_set(0.5) * r2);
  const LaneMask quarter = (LaneMask)shifted, one = (LaneMask){0} + 1, two = one + one;
  const LaneMask odd = (quarter & one) != 0, sign = (LaneMask)lanes_set(-0.0);
  const Lanes a = (Lanes)(((LaneMask)s & ~odd) | ((LaneMask)c & odd)),
              b = (Lanes)(((LaneMask)c & ~odd) | ((LaneMask)s & odd));
  *sine = (Lanes)((LaneMask)a ^ (sign & ((quarter & two) != 0)));
  *cosine = (Lanes)((LaneMask)b ^ (sign & (((quarter + one) & two) != 0)));
}

#endif

/* Stretches of bonds without a root and a quotient for each. As |y|^2 = |xi|^2 (1 + d) with y = xi + eta and d = eta . (xi + y) / |xi|^2, a bond
 * needs g(d) = 1 - (1 + d)^-1/2 only: 1 - |xi| / |y| = g, and the stretch is d (1 - g) - g. d has no cancellation however small it is. */
#ifndef BRECCIA_FORMULATION_STRETCH_H
#define BRECCIA_FORMULATION_STRETCH_H

#include "family/family.h"

/* Ways to g(d), each good to double precision relative to g and each cheaper than the next: its series, for stretches up to 0.2 %; a
 * reciprocal root by Newton's steps from a short series, for stretches from -13 to 11 %; root and quotients. Of a slice all bonds go the
 * same way, the first that is good for all of them. */
typedef enum StretchRange { RANGE_SERIES, RANGE_NEWTON, RANGE_ANY } StretchRange;
static const double range_limit[] = {0x1p-8, 0.25}; /* largest |d| */

/** The first way that is good for d up to `largest`. */
static inline StretchRange stretch_range(double largest)
{
  return largest <= range_limit[RANGE_SERIES]   ? RANGE_SERIES
         : largest <= range_limit[RANGE_NEWTON] ? RANGE_NEWTON
                                                : RANGE_ANY;
}

enum { STRETCH_TERMS = 6 };

/* g / d = sum of these times (-d)^n: Taylor's series, whose next term 429 / 2048 (-d)^6 is replaced by lower ones (Chebyshev), so that the
 * error stays below 5e-17 up to |d| = 2^-8. */
static const double shortening_terms[STRETCH_TERMS] = {0.5 + 429.0 / 2048 * 0x1p-48 / 32,          3.0 / 8,
                                                       5.0 / 16 - 429.0 / 2048 * 0x1p-32 * 0.5625, 35.0 / 128,
                                                       63.0 / 256 + 429.0 / 2048 * 0x1p-16 * 1.5,  231.0 / 1024};

/* The same of the stretch: ((1 + d)^1/2 - 1) / d, whose next term 33 / 2048 (-d)^6 is replaced. */
static const double stretch_terms[STRETCH_TERMS] = {0.5 + 33.0 / 2048 * 0x1p-48 / 32,          1.0 / 8,
                                                    1.0 / 16 - 33.0 / 2048 * 0x1p-32 * 0.5625, 5.0 / 128,
                                                    7.0 / 256 + 33.0 / 2048 * 0x1p-16 * 1.5,   21.0 / 1024};

/** g(d) by its series. */
LANES_INLINE Lanes shortening_series(Lanes d)
{
  /* By pairs: less to wait for than one term after another. */
  const Lanes square = d * d;
  Lanes pair[STRETCH_TERMS / 2];
  for (int n = 0; n < STRETCH_TERMS; n += 2)
    pair[n / 2] = lanes_set(shortening_terms[n]) - d * lanes_set(shortening_terms[n + 1]);
  return d * (pair[0] + square * (pair[1] + square * pair[2]));
}

/** g(d) by one of the ways. */
LANES_INLINE Lanes shortening(Lanes d, StretchRange range)
{
  if (range == RANGE_SERIES) return shortening_series(d);
  if (range == RANGE_NEWTON) {
    Lanes r = lanes_set(35.0 / 128), x = lanes_set(0.5) + lanes_set(0.5) * d;
    r = lanes_set(-5.0 / 16) + d * r;
    r = lanes_set(3.0 / 8) + d * r;
    r = lanes_set(-0.5) + d * r;
    r = lanes_set(1) + d * r;
    for (int step = 0; step < 3; ++step) r *= lanes_set(1.5) - x * (r * r);
    Lanes g = lanes_set(1) - r; /* has lost digits where d is small; (1 - g)^2 (1 + d) = 1 gives them back */
    return lanes_set(0.5) * (d * (r * r) + g * g);
  }
  Lanes r = lanes_set(1) / lanes_root(lanes_set(1) + d);
  return d * r * r / (lanes_set(1) + r);
}

/* What stored slots read of a neighbour lies together, a line of the cache: x, y, z, V, u, v, w, and one number of the formulation's. */
enum { STRETCH_SHOWN = 8 };

/** Half a stored slot: y, d, 1 / |xi| (0 where there is no intact bond), influence x correction x V, and the neighbours' last number. */
typedef struct StretchEnds {
  Lanes y[3], d, square, by_length, weight, last; /* square: |xi|^2 */
} StretchEnds;

/** Positions and displacements of half a slice. */
typedef struct StretchHere {
  Lanes x[3], u[3];
} StretchHere;

LANES_INLINE StretchHere stretch_here(const Particles *p, int64_t slice, int half)
{
  StretchHere here;
  for (int k = 0; k < 3; ++k) {
    here.x[k] = lanes_load(p->position[k] + slice * SLICE + LANES * half);
    here.u[k] = lanes_load(p->displacement[k] + slice * SLICE + LANES * half);
  }
  return here;
}

/** @param[in] shown  [places][STRETCH_SHOWN] */
LANES_INLINE StretchEnds stretch_ends(const Family *f, const double *shown, int64_t slot, int half,
                                      const StretchHere *here)
{
  const int64_t at = (int64_t)f->base[slot] * SLICE + LANES * half;
  Lanes x[QUAD], u[QUAD];
  StretchEnds ends = {.d = {0}, .square = {0}};
  family_fetch_ahead(f, at, shown, STRETCH_SHOWN);
  lanes_gather_rows(shown, STRETCH_SHOWN, f->neighbour + at, x);
  lanes_gather_rows(shown + QUAD, STRETCH_SHOWN, f->neighbour + at, u);
  for (int k = 0; k < 3; ++k) {
    const Lanes xi = x[k] - here->x[k], eta = u[k] - here->u[k];
    ends.y[k] = xi + eta;
    ends.d += eta * (xi + ends.y[k]);
    ends.square += xi * xi;
  }
  /* Quotient and root are found beside the other arithmetic; kept lengths would have to come from memory. */
  const LaneMask intact =
      lanes_half(f->intact[slot], half); /* where there is no bond, the particle has itself as neighbour */
  const Lanes by_square = lanes_where(intact, lanes_set(1) / lanes_choose(intact, ends.square, lanes_set(1)));
  ends.d *= by_square;
  ends.by_length = lanes_root(by_square);
  ends.weight = x[3];
  if (f->scale) ends.weight *= lanes_load(f->scale + at);
  ends.last = u[3];
  return ends;
}

#endif

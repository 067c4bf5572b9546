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

/** The first way that is good for all d of which this is the largest square. */
static inline StretchRange stretch_range(double largest)
{
  return largest <= range_limit[RANGE_SERIES] * range_limit[RANGE_SERIES]   ? RANGE_SERIES
         : largest <= range_limit[RANGE_NEWTON] * range_limit[RANGE_NEWTON] ? RANGE_NEWTON
                                                                            : RANGE_ANY;
}

/** The way that a slice should go, of which all bonds have gone a way. */
static inline StretchRange stretch_range_after(StretchRange range, double largest)
{
  const StretchRange next = stretch_range(largest);
  return range == RANGE_SERIES && next == RANGE_ANY ? RANGE_NEWTON : next;
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

/** Positions and displacements of half a slice. */
typedef struct StretchHere {
  Lanes x[3], u[3];
} StretchHere;

LANES_INLINE StretchHere stretch_here(const Particles *p, double *const *u, int64_t slice, int half)
{
  StretchHere here;
  for (int k = 0; k < 3; ++k) {
    here.x[k] = lanes_load(p->position[k] + slice * SLICE + LANES * half);
    here.u[k] = lanes_load(u[k] + slice * SLICE + LANES * half);
  }
  return here;
}

/** x, y, z, V and u, v, w, last of the neighbours of half a stored slot. */
typedef struct StretchShown {
  Lanes x[QUAD], u[QUAD];
} StretchShown;

/** A walk over stored slots of half a slice. On eight lanes three slots are under way, for which there are registers enough: while one is summed,
 *  records of the next one are turned round, and those of the one after are loaded. Four lanes have half as many registers, and were slower so. */
typedef struct StretchWalk {
  const Family *family;
  const double *shown; /* [places][STRETCH_SHOWN] */
  int64_t at;          /* of the slot that comes next, in the arrays of stored slots */
#ifdef BRECCIA_EIGHT_LANES
  int64_t last; /* of the last slot */
  StretchShown turned, loaded;
#endif
} StretchWalk;

#ifdef BRECCIA_EIGHT_LANES
/** Behind the last slot it is read again: what comes there is another slice's, which others may be writing. */
LANES_INLINE StretchShown stretch_loaded(const StretchWalk *walk, int slots_ahead)
{
  StretchShown rows;
  const int64_t at = walk->at + slots_ahead * SLICE;
  const int32_t *place = walk->family->neighbour + (at < walk->last ? at : walk->last);
  lanes_load_rows(walk->shown, STRETCH_SHOWN, place, rows.x);
  lanes_load_rows(walk->shown + QUAD, STRETCH_SHOWN, place, rows.u);
  return rows;
}

LANES_INLINE StretchShown stretch_turned(const StretchShown *rows)
{
  StretchShown turned;
  lanes_turn_rows(rows->x, turned.x);
  lanes_turn_rows(rows->u, turned.u);
  return turned;
}
#endif

/** @param[in] slot, last  it goes over slots slot .. last - 1 */
LANES_INLINE StretchWalk stretch_walk(const Family *f, const double *shown, int64_t slot, int64_t last, int half)
{
  StretchWalk walk = {.family = f, .shown = shown};
  if (slot >= last) return walk;
  walk.at = (int64_t)f->base[slot] * SLICE + LANES * half;
#ifdef BRECCIA_EIGHT_LANES
  walk.last = walk.at + (last - 1 - slot) * SLICE;
  const StretchShown rows = stretch_loaded(&walk, 0);
  walk.turned = stretch_turned(&rows);
  walk.loaded = stretch_loaded(&walk, 1);
#endif
  return walk;
}

/** What the next slot shows. */
LANES_INLINE StretchShown stretch_next(StretchWalk *walk)
{
  family_fetch_ahead(walk->family, walk->at, walk->shown, STRETCH_SHOWN);
#ifdef BRECCIA_EIGHT_LANES
  const StretchShown there = walk->turned;
  walk->turned = stretch_turned(&walk->loaded);
  walk->loaded = stretch_loaded(walk, 2);
#else
  StretchShown there;
  lanes_gather_rows(walk->shown, STRETCH_SHOWN, walk->family->neighbour + walk->at, there.x);
  lanes_gather_rows(walk->shown + QUAD, STRETCH_SHOWN, walk->family->neighbour + walk->at, there.u);
#endif
  walk->at += SLICE;
  return there;
}

/** 1 / |xi| of all stored bonds to single precision, by which stretch_ends finds it to double precision. Broken ones have it too.
 *  @return [stored_slots][8], 0 where there never was a bond; or NULL */
float *stretch_lengths(const Family *family, Error *error);

/** Whether a slice lacks bonds: in a slot of a lattice one that is not there or broken, in a stored one one that is broken. */
bool stretch_has_gaps(const Family *family, int64_t slice);

/** Half a stored slot: y, d, |xi|^2, 1 / |xi|, influence x correction x V, and the neighbours' last number. */
typedef struct StretchEnds {
  Lanes y[3], d, square, by_length, weight, last;
} StretchEnds;

/** d and 1 / |xi| are 0 where there is no bond, and if the slice has gaps where it is broken.
 *  With r = (1 / |xi|) (1 + e) as kept, |e| < 2^-24, the rest t = 1 - |xi|^2 r^2 = -2 e - e^2 makes of it 1 / |xi|^2 = r^2 (1 + t) and 1 / |xi| =
 *  r (1 + t / 2), but for t^2 < 1.5e-14 of them: less than roundings of displacements make of d. It does not depend on the displacements, and is the
 *  same for both ends.
 *  @param[in] at  of the half slot in the arrays of stored slots */
LANES_INLINE StretchEnds stretch_ends(const Family *f, const float *by_length, const StretchShown *there, int64_t at,
                                      unsigned intact, int half, bool gaps, const StretchHere *here)
{
  StretchEnds ends = {.d = {0}, .square = {0}, .weight = there->x[3], .last = there->u[3]};
  for (int k = 0; k < 3; ++k) {
    const Lanes xi = there->x[k] - here->x[k], eta = there->u[k] - here->u[k];
    ends.y[k] = xi + eta;
    ends.d += eta * (xi + ends.y[k]);
    ends.square += xi * xi;
  }
  Lanes kept = lanes_widen(by_length + at);
  __builtin_prefetch((const void *)((uintptr_t)(by_length + at) + 4 * FAMILY_AHEAD * SLICE * sizeof *by_length));
  if (gaps) kept = lanes_intact(intact, half, kept);
  const Lanes by_square = kept * kept, rest = lanes_set(1) - ends.square * by_square;
  ends.d *= by_square + by_square * rest;
  ends.by_length = kept + (lanes_set(0.5) * kept) * rest;
  if (f->scale) ends.weight *= lanes_load(f->scale + at);
  return ends;
}

#endif

/* What the sweeps over slices of hybrid bonds share: where the members of a slice's bonds stand, and how what these exert is summed by lattice rows. */
#ifndef BRECCIA_FORMULATION_HYBRID_SLICE_H
#define BRECCIA_FORMULATION_HYBRID_SLICE_H

#include "formulation/hybrid.h"

#include <string.h>

/** Numbers that are kept of a component of what a lattice vector's places receive: eight, between zeros as far as windows reach. */
enum { MOST_MARGIN = HYBRID_WIDTH - SLICE, MOST_ROOM = 2 * MOST_MARGIN + SLICE };

/** Zeros on each side, so that the eight stand as a cache line does. */
LANES_INLINE int sums_margin(const Hybrid *h)
{
  return (h->width - 1) / SLICE * SLICE;
}

/** What the loops over a slice's slots need at hand. */
typedef struct SliceOf {
  const Hybrid *h;
  const Sweep *sweep; /* or NULL */
  int64_t slice;
  int64_t first;             /* group of the first row */
  int groups;                /* whole slots among the rows; listed single bonds follow */
  int32_t base[HYBRID_NEAR]; /* place of lane 0's member, by lattice vector */
} SliceOf;

/** All rows of a slice. */
LANES_INLINE void find_slice(const Hybrid *h, int64_t slice, SliceOf *s)
{
  const Family *f = h->family;
  const BondList *l = h->bonds;
  s->h = h;
  s->sweep = NULL;
  s->slice = slice;
  s->first = l->owned_first[slice];
  s->groups = (int)(l->owned_first[slice + 1] - s->first);
  if (!s->groups || !h->lattice[h->particles->block[slice]].count) return;
  const int begin = f->pattern_begin[h->particles->block[slice]] - 1;
  s->base[0] = (int32_t)(slice * SLICE);
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    s->base[family_pattern(f, slice, slot) - begin] = family_base(f, slice, slot);
}

/** The stripe of a slice. */
LANES_INLINE const HybridStripe *stripe_of(const Hybrid *h, int64_t slice)
{
  int64_t low = 0, high = h->stripes;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (h->stripe[middle].first <= slice)
      low = middle;
    else
      high = middle;
  }
  return &h->stripe[low];
}

static inline void clear_stripe(const HybridStripe *stripe)
{
  memset(stripe->sums, 0, sizeof *stripe->sums * (size_t)(3 * (stripe->high - stripe->low)));
}

/** Adds what the places of one lattice row receive. @param[in] vectors  that lead to them */
LANES_INLINE void add_row(const SliceOf *s, const HybridStripe *stripe, const double *sums, int room, int width,
                          const int32_t *vectors, int count)
{
  int32_t first = INT32_MAX;
  for (int m = 0; m < count; ++m)
    if (s->base[vectors[m]] < first) first = s->base[vectors[m]];
  const int64_t size = stripe->high - stripe->low;
  double *to = stripe->sums + (first - stripe->low);
  Quad sum[3][HYBRID_WIDTH / QUAD];
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < width / QUAD; ++i) sum[k][i] = quad_load(to + k * size + QUAD * i);
  for (int m = 0; m < count; ++m) {
    const double *from = sums + 3 * (int64_t)vectors[m] * room - (s->base[vectors[m]] - first);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < width / QUAD; ++i) sum[k][i] += quad_load(from + k * room + QUAD * i);
  }
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < width / QUAD; ++i) quad_store(to + k * size + QUAD * i, sum[k][i]);
}

/** Adds to the sums of a stripe what the places of all lattice vectors receive, by lattice rows. */
LANES_INLINE void add_to_stripe(const SliceOf *s, const HybridStripe *stripe, const double *sums, int room)
{
  const Hybrid *h = s->h;
  const Family *f = h->family;
  const int64_t last = f->stored[s->slice];
  const int block = h->particles->block[s->slice], begin = f->pattern_begin[block] - 1;
  const HybridLattice *lattice = &h->lattice[block];
  int64_t slot = f->first[s->slice];
  for (int n = 0; n < lattice->windows; ++n) { /* vectors of one row follow each other, but for the place itself */
    int32_t vectors[HYBRID_WIDTH];
    int count = 0;
    if (lattice->window[0] == n) vectors[count++] = 0;
    for (; slot < last && lattice->window[family_pattern(f, s->slice, slot) - begin] == n; ++slot)
      vectors[count++] = family_pattern(f, s->slice, slot) - begin;
    if (!count) continue;
    if (h->width == 3 * QUAD) /* reaches of two places at most; loops of known length keep their sums in registers */
      add_row(s, stripe, sums, room, 3 * QUAD, vectors, count);
    else
      add_row(s, stripe, sums, room, h->width, vectors, count);
  }
}

#endif

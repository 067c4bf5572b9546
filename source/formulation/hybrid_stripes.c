/* Where what the points of lattice slots exert is summed: stripes of slices, each of which reaches places before and behind its own. */
#include "formulation/hybrid.h"

#include "base/memory.h"

/** Numbers of a lattice row that the bonds of a slice lead to, at most; and the places of all rows. @param[in,out] low, high  places */
static int reach_of(const Hybrid *h, int64_t slice, int64_t *low, int64_t *high)
{
  const Family *f = h->family;
  const int block = h->particles->block[slice];
  const HybridLattice *lattice = &h->lattice[block];
  int32_t begin[HYBRID_NEAR], end[HYBRID_NEAR];
  int longest = SLICE;
  for (int n = 0; n < lattice->windows; ++n) {
    begin[n] = INT32_MAX;
    end[n] = INT32_MIN;
  }
  for (int64_t slot = f->first[slice] - 1; slot < f->stored[slice]; ++slot) {
    const bool own = slot < f->first[slice];
    const int32_t to = own ? (int32_t)(slice * SLICE) : family_base(f, slice, slot);
    const int n = lattice->window[own ? 0 : hybrid_vector(h, block, slice, slot)];
    if (to < begin[n]) begin[n] = to;
    if (to + SLICE > end[n]) end[n] = to + SLICE;
    if (end[n] - begin[n] > longest) longest = end[n] - begin[n];
    if (to < *low) *low = to;
  }
  for (int n = 0; n < lattice->windows; ++n)
    if (end[n] > *high) *high = end[n];
  return longest;
}

static bool exerts(const Hybrid *h, int64_t slice)
{
  return h->bonds->owned_first[slice + 1] > h->bonds->owned_first[slice] &&
         h->lattice[h->particles->block[slice]].count;
}

/** Reach of each stripe, and what stands there is read of. @return numbers that all of them take */
static int64_t lay_out(Hybrid *h, const int64_t *begin)
{
  int64_t size = 0;
  for (int64_t n = 0; n < h->stripes; ++n) {
    HybridStripe *stripe = &h->stripe[n];
    *stripe =
        (HybridStripe){.first = begin[n], .last = begin[n + 1], .row = h->bonds->first[begin[n]], .low = INT64_MAX};
    for (int64_t slice = begin[n]; slice < begin[n + 1]; ++slice) {
      if (!exerts(h, slice)) continue;
      const int needed = (reach_of(h, slice, &stripe->low, &stripe->high) + LANES - 1) / LANES * LANES;
      if (needed > h->width) h->width = needed;
    }
    if (stripe->low == INT64_MAX) stripe->low = 0;
    /* Rows are added to in whole vectors: what is behind their last place must be there too. */
    stripe->low = (stripe->low < 0 ? stripe->low - SLICE + 1 : stripe->low) / SLICE * SLICE;
    stripe->high = (stripe->high + SLICE - 1) / SLICE * SLICE;
  }
  for (int64_t n = 0; n < h->stripes; ++n) {
    HybridStripe *stripe = &h->stripe[n];
    if (stripe->high) stripe->high += (h->width - 1) / SLICE * SLICE;
    size += 3 * (stripe->high - stripe->low);
  }
  return size;
}

int hybrid_stripes_create(Hybrid *h, const int64_t *begin, Error *error)
{
  const int64_t slices = h->particles->slices;
  h->stripe = memory_zeroed((size_t)h->stripes, sizeof *h->stripe, "sums of bonds", error);
  h->reaching = memory_zeroed((size_t)slices, sizeof *h->reaching, "sums of bonds", error);
  if (!h->stripe || !h->reaching) return BRECCIA_FAILURE;
  h->sums = places_array(lay_out(h, begin), "sums of bonds", error);
  if (!h->sums) return BRECCIA_FAILURE;
  for (int64_t slice = 0; slice < slices; ++slice) {
    h->reaching[slice][0] = (int32_t)h->stripes;
    h->reaching[slice][1] = -1;
  }
  double *sums = h->sums;
  for (int32_t n = 0; n < h->stripes; ++n) {
    HybridStripe *stripe = &h->stripe[n];
    stripe->sums = sums;
    sums += 3 * (stripe->high - stripe->low);
    for (int64_t slice = stripe->low < 0 ? 0 : stripe->low / SLICE; slice < slices && slice * SLICE < stripe->high;
         ++slice) {
      if (h->reaching[slice][0] > n) h->reaching[slice][0] = n;
      h->reaching[slice][1] = n;
    }
  }
  return BRECCIA_OK;
}

size_t hybrid_stripes_bytes(const Hybrid *h)
{
  int64_t size = 0;
  for (int64_t n = 0; n < h->stripes; ++n) size += 3 * (h->stripe[n].high - h->stripe[n].low);
  return (size_t)size * sizeof *h->sums + (size_t)h->stripes * sizeof *h->stripe +
         (size_t)h->particles->slices * sizeof *h->reaching;
}

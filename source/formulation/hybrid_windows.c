/* Where places take what the points of lattice slots exert: windows of each slice, one for each lattice row that its bonds lead to. */
#include "formulation/hybrid.h"

#include "base/memory.h"

/** First places of the windows of a slice, and those behind the last. @param[out] begin, end  [windows]; begin: INT32_MAX for windows that nothing is in
 *  @return numbers that the longest needs */
static int find_windows(const Hybrid *h, int64_t slice, int32_t *begin, int32_t *end)
{
  const Family *f = h->family;
  const int block = h->particles->block[slice];
  const HybridLattice *lattice = &h->lattice[block];
  int longest = 0;
  for (int n = 0; n < lattice->windows; ++n) {
    begin[n] = INT32_MAX;
    end[n] = INT32_MIN;
  }
  begin[lattice->window[0]] = (int32_t)(slice * SLICE);
  end[lattice->window[0]] = begin[lattice->window[0]] + SLICE;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
    const int n = lattice->window[hybrid_vector(h, block, slot)];
    if (f->base[slot] < begin[n]) begin[n] = f->base[slot];
    if (f->base[slot] + SLICE > end[n]) end[n] = f->base[slot] + SLICE;
  }
  for (int n = 0; n < lattice->windows; ++n)
    if (begin[n] < INT32_MAX && end[n] - begin[n] > longest) longest = end[n] - begin[n];
  return longest;
}

static bool exerts(const Hybrid *h, int64_t slice)
{
  return h->bonds->owned_first[slice + 1] > h->bonds->owned_first[slice] &&
         h->lattice[h->particles->block[slice]].count;
}

int hybrid_windows_create(Hybrid *h, Error *error)
{
  const int64_t slices = h->particles->slices;
  int32_t begin[HYBRID_NEAR], end[HYBRID_NEAR];
  for (int block = 0; block < h->body->block_count; ++block)
    if (h->lattice[block].windows > h->windows) h->windows = h->lattice[block].windows;
  for (int64_t slice = 0; slice < slices; ++slice) {
    const int needed = exerts(h, slice) ? find_windows(h, slice, begin, end) : 0;
    if (needed > h->width) h->width = (needed + LANES - 1) / LANES * LANES;
  }
  h->share_first = memory_zeroed((size_t)slices + 2, sizeof *h->share_first, "windows of bonds", error);
  h->window = places_array(slices * h->windows * 3 * h->width, "windows of bonds", error);
  if (!h->share_first || !h->window) return BRECCIA_FAILURE;
  for (int turn = 0; turn < 2; ++turn) { /* counted, then written */
    for (int64_t slice = 0; slice < slices; ++slice) {
      if (!exerts(h, slice)) continue;
      find_windows(h, slice, begin, end);
      const int windows = h->lattice[h->particles->block[slice]].windows;
      for (int n = 0; n < windows; ++n)
        for (int64_t to = begin[n] < 0 ? 0 : begin[n] / SLICE;
             begin[n] < INT32_MAX && to < slices && to * SLICE < end[n]; ++to) {
          const int64_t from = to * SLICE - begin[n];
          uint8_t lanes = 0;
          for (int lane = 0; lane < SLICE; ++lane)
            if (from + lane >= 0 && from + lane < end[n] - begin[n]) lanes |= (uint8_t)(1u << lane);
          if (!turn)
            ++h->share_first[to + 2];
          else
            h->share[h->share_first[to + 1]++] =
                (HybridShare){.window = (int32_t)(slice * h->windows + n), .from = (int16_t)from, .lanes = lanes};
        }
    }
    if (turn) break;
    for (int64_t slice = 0; slice < slices; ++slice) h->share_first[slice + 2] += h->share_first[slice + 1];
    h->share = memory_zeroed((size_t)h->share_first[slices + 1], sizeof *h->share, "windows of bonds", error);
    if (!h->share) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

/* What phases `ahead` write, sums along lattice rows, is read by the next phase only, and of some planes of the body around each batch. Threads go through their batches in
 * order: each makes such sums as it comes to them, in memory that holds those planes, so that they stay in its caches and large bodies have no arrays
 * for them. Sums of slices that two threads read are made twice, to the same bits. */
#include "base/team.h"
#include "domain/regions.h"

#include <stdlib.h>

static void find_reach(const Domain *d, const Region *region, int32_t *low, int32_t *high)
{
  const int64_t batches = region->last_batch - region->first_batch;
  for (int64_t n = 0; n < batches; ++n) {
    const Batch *batch = &d->batches[region->first_batch + n];
    int64_t first = batch->first, last = batch->first;
    for (int64_t s = batch->first; s < batch->last; ++s) {
      const SumsAround sums = region->type->sums_around(region->formulation, s);
      if (sums.low < first) first = sums.low;
      if (sums.high > last) last = sums.high;
    }
    low[n] = (int32_t)first;
    high[n] = (int32_t)last;
  }
  for (int64_t n = 1; n < batches; ++n)
    if (high[n] < high[n - 1]) high[n] = high[n - 1];
  for (int64_t n = batches - 2; n >= 0; --n)
    if (low[n] > low[n + 1]) low[n] = low[n + 1];
}

int window_create(Domain *d, Region *region, Error *error)
{
  Window *w = &region->window;
  const int64_t batches = region->last_batch - region->first_batch;
  if (!region->type->sums_around || d->region_count > 1 || d->failure.criterion || d->gave_up) return BRECCIA_OK;
  w->numbers = region->type->sums_around(region->formulation, 0).most;
  if (!w->numbers) return BRECCIA_OK;
  w->low = memory_zeroed((size_t)batches, sizeof *w->low, "windows", error);
  w->high = memory_zeroed((size_t)batches, sizeof *w->high, "windows", error);
  if (!w->low || !w->high) return BRECCIA_FAILURE;
  find_reach(d, region, w->low, w->high);
  w->slices = 1;
  for (int64_t n = 0; n < batches; ++n)
    while (w->slices <= w->high[n] - w->low[n]) w->slices *= 2;
  w->threads = (int)(d->particles->slices / 2 / w->slices);
  if (!w->threads) {
    window_destroy(w);
    return BRECCIA_OK;
  }
  w->memory = places_reserved(w->threads * w->slices * w->numbers, "windows", error);
  return w->memory ? BRECCIA_OK : BRECCIA_FAILURE;
}

void window_destroy(Window *w)
{
  places_free(&w->memory);
  free(w->low);
  free(w->high);
  *w = (Window){0};
}

double *window_of_thread(const Window *w)
{
  return team_size() <= w->threads ? w->memory + team_rank() * w->slices * w->numbers : NULL;
}

size_t window_bytes(const Domain *d, const Region *region)
{
  const Window *w = &region->window;
  const int threads = team_called();
  if (!region->type->sums_around) return 0;
  const int64_t numbers = threads <= w->threads
                              ? threads * w->slices * w->numbers
                              : d->particles->slices * region->type->sums_around(region->formulation, 0).all;
  return (size_t)numbers * sizeof(double);
}

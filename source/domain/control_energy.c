/* The energy that the control of zero-energy modes holds: what families store beside their laws. */
#include "domain/domain.h"

#include "base/team.h"
#include <string.h>

static void control_energy_of_batch(void *context, int64_t b)
{
  const Domain *d = context;
  d->batch_sum[b] = 0;
  for (int64_t slice = d->batches[b].first; slice < d->batches[b].last; ++slice) {
    const Region *region = &d->regions[d->region[slice]];
    if (!region->type->control) continue;
    for (int64_t i = slice * SLICE; i < (slice + 1) * SLICE; ++i)
      if (d->counted[i] > 0) d->batch_sum[b] += region->type->control->energy(region->formulation, i);
  }
}

double domain_control_energy(const Domain *d)
{
  double sum = 0;
  team_each(d->batch_count, control_energy_of_batch, (void *)d);
  for (int64_t b = 0; b < d->batch_count; ++b) sum += d->batch_sum[b]; /* in order */
  return sum;
}

bool domain_is_controlled(const Domain *d)
{
  bool is = false;
  for (int r = 0; r < d->region_count; ++r)
    is |= d->regions[r].type->control && d->regions[r].type->control->is_active(d->regions[r].formulation);
  return is;
}

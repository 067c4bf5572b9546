/* What holds of a family at any time, line by line. */
#include "family/family.h"

enum {
  SAMPLE = 61
}; /* of so many bonds one is looked for from its other end, which takes as long as a family is large */

static bool bond_is_valid(const Family *f, int64_t slice, int64_t slot, int lane, bool looked_for)
{
  const Particles *p = f->particles;
  const int32_t here = (int32_t)(slice * SLICE + lane);
  if (p->number[here] < 0) return false; /* places without a particle have no bonds */
  const int64_t there = slot < f->stored[slice] ? family_base(f, slice, slot) + lane
                                                : f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
  if (there < 0 || there >= p->places || there == here || p->number[there] < 0) return false;
  const Bond bond = family_bond(f, slice, slot, lane);
  if (!(bond.length > 0 && bond.length <= f->reach * (1 + 1e-6) && bond.weight >= 0)) return false;
  return !looked_for || family_slot(f, bond.neighbour, here) >= 0; /* bonds come in pairs, both intact */
}

bool family_is_valid(const Family *f)
{
  int64_t seen = 0;
  if (f->first[0] != 0 || f->first[f->particles->slices] != f->slots) return false;
  for (int64_t slice = 0; slice < f->particles->slices; ++slice) {
    if (!(f->first[slice] <= f->stored[slice] && f->stored[slice] <= f->first[slice + 1])) return false;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      if (slot < f->stored[slice] && family_pattern(f, slice, slot) >= f->pattern_count) return false;
      for (int lane = 0; lane < SLICE; ++lane)
        if (f->intact[slot] >> lane & 1 && !bond_is_valid(f, slice, slot, lane, seen++ % SAMPLE == 0)) return false;
    }
  }
  return seen <= f->bonds;
}

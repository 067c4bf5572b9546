/* What stored bonds keep of their lengths (formulation/stretch.h). */
#include "formulation/stretch.h"

#include "base/memory.h"
#include "base/team.h"

typedef struct Lengths {
  const Family *family;
  float *by_length;
} Lengths;

static void find_lengths(void *context, int64_t slice)
{
  const Lengths *l = context;
  const Family *f = l->family;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const Bond bond = family_bond(f, slice, slot, lane);
      if (bond.neighbour != slice * SLICE + lane)
        l->by_length[(int64_t)f->base[slot] * SLICE + lane] = (float)(1 / bond.length);
    }
}

float *stretch_lengths(const Family *family, Error *error)
{
  Lengths l = {.family = family};
  l.by_length = memory_zeroed((size_t)family->stored_slots * SLICE, sizeof *l.by_length, "lengths of bonds", error);
  if (l.by_length) team_each(family->particles->slices, find_lengths, &l);
  return l.by_length;
}

bool stretch_has_gaps(const Family *f, int64_t slice)
{
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    if (f->intact[slot] != UINT8_MAX) return true;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE && f->intact[slot] != UINT8_MAX; ++lane)
      if (!(f->intact[slot] >> lane & 1) && f->neighbour[(int64_t)f->base[slot] * SLICE + lane] != slice * SLICE + lane)
        return true;
  return false;
}

/* Reading what eight neighbours of a slot have, on lattices (side by side) and elsewhere (one by one), with one text for both:
 * `lattice` is known when the loop is compiled. */
#ifndef BRECCIA_FAMILY_SLOTS_H
#define BRECCIA_FAMILY_SLOTS_H

#include "family/family.h"

typedef struct Slot {
  bool lattice;
  int64_t base;         /* lattice: place of the first neighbour */
  const int32_t *index; /* stored: their places */
  int64_t at;           /* stored: where their weights begin */
} Slot;

LANES_INLINE Slot slot_open(const Family *f, int64_t slot, bool lattice)
{
  if (lattice) return (Slot){true, f->base[slot], NULL, 0};
  int64_t at = (int64_t)f->base[slot] * SLICE;
  return (Slot){false, 0, f->neighbour + at, at};
}

LANES_INLINE Lanes slot_read(const Slot *s, int half, const double *array)
{
  return s->lattice ? lanes_load(array + s->base + LANES * half) : lanes_gather(array, s->index + LANES * half);
}

/** Reference vector, from half a slice to its neighbours in a stored slot. */
LANES_INLINE void slot_reference(const Slot *s, const Particles *p, int64_t slice, int half, Lanes xi[3])
{
  for (int k = 0; k < 3; ++k)
    xi[k] = slot_read(s, half, p->position[k]) - lanes_load(p->position[k] + slice * SLICE + LANES * half);
}

LANES_INLINE LaneMask half_mask(unsigned bits, int half)
{
  return lanes_mask(bits >> (LANES * half) & 15u);
}

#endif

/* Linear bonds of whole lattice slots with small stretches, on long vectors: as in bond_springs.c, twice as many at a time. */
#include "formulation/bond_based.h"
#include "formulation/stretch_wide.h"

LANES_INLINE StretchRange resist(const BondBased *b, int64_t slice, bool gaps)
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  const double *numbers = b->numbers;
  const int64_t here = slice * SLICE, last = f->first[slice + 1];
  Wide own[3], force[3] = {{0}};
  WideMask beyond = {0};
  for (int k = 0; k < 3; ++k) own[k] = wide_load(p->displacement[k] + here);
  for (int64_t slot = f->first[slice]; slot < last; ++slot) {
    const SpringRow *row = &b->rows[f->pattern[slot]];
    const double *const doubled[3] = {numbers + row->xi[0], numbers + row->xi[1], numbers + row->xi[2]};
    Wide twice[3], d = stretch_wide(p->displacement, doubled, f->base[slot], own, twice);
    if (gaps) d = wide_where(f->intact[slot], d);
    const Wide pull = stretch_wide_series(numbers + row->length + LENGTH_PULL, LANES, d);
    beyond |= (WideMask)(wide_absolute(d) > wide_set(numbers[row->length + LENGTH_LIMIT]));
    for (int k = 0; k < 3; ++k) force[k] += pull * twice[k];
  }
  const Wide scale = wide_set(b->stiffness[p->block[slice]]);
  for (int k = 0; k < 3; ++k) wide_store(p->internal[k] + here, force[k] * scale);
  return wide_any(beyond) ? RANGE_NEWTON : RANGE_SERIES;
}

BRECCIA_WIDE StretchRange bond_resist_springs_wide(const BondBased *b, int64_t slice)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  return b->gaps[slice] ? resist(&local, slice, true) : resist(&local, slice, false);
}

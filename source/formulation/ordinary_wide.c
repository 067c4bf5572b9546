/* Sweeps of ordinary peridynamics over whole lattice slots with small stretches, on long vectors: as in ordinary.c, twice as many at a time. */
#include "formulation/ordinary.h"
#include "formulation/stretch_wide.h"

LANES_INLINE StretchRange dilate(const Ordinary *o, int64_t slice, bool gaps)
{
  const Family *f = o->family;
  const int64_t here = slice * SLICE, last = f->first[slice + 1];
  Wide own[3], sum = {0};
  WideMask beyond = {0};
  for (int k = 0; k < 3; ++k) own[k] = wide_load(o->particles->displacement[k] + here);
  for (int64_t slot = f->first[slice]; slot < last; ++slot) {
    const OrdinaryDilating *row = &o->dilating[f->pattern[slot]];
    const double *const doubled[3] = {&row->twice[0], &row->twice[1], &row->twice[2]};
    Wide twice[3], d = stretch_wide(o->particles->displacement, doubled, f->base[slot], own, twice);
    if (gaps) d = wide_where(f->intact[slot], d);
    sum += stretch_wide_series(row->series, 1, d);
    beyond |= (WideMask)(d * d > wide_set(row->limit));
  }
  wide_store(o->dilatation + here, wide_load(o->inverse + here) * sum);
  return wide_any(beyond) ? RANGE_NEWTON : RANGE_SERIES;
}

LANES_INLINE void resist(const Ordinary *o, int64_t slice, bool gaps)
{
  const Family *f = o->family;
  const int64_t here = slice * SLICE, last = f->first[slice + 1];
  Wide own[3], force[3] = {{0}};
  for (int k = 0; k < 3; ++k) own[k] = wide_load(o->particles->displacement[k] + here);
  const Wide base = wide_load(o->base + here), slope = wide_load(o->slope + here);
  for (int64_t slot = f->first[slice]; slot < last; ++slot) {
    const OrdinaryResisting *row = &o->resisting[f->pattern[slot]];
    const int64_t there = f->base[slot];
    const double *const doubled[3] = {&row->twice[0], &row->twice[1], &row->twice[2]};
    Wide twice[3], d = stretch_wide(o->particles->displacement, doubled, there, own, twice);
    const Wide both = base + wide_load(o->base + there), slopes = slope + wide_load(o->slope + there);
    const Wide g = stretch_wide_series(row->series, 1, d);
    Wide pull = wide_set(row->weight) * both + slopes * g;
    if (gaps) pull = wide_where(f->intact[slot], pull);
    for (int k = 0; k < 3; ++k) force[k] += pull * twice[k];
  }
  for (int k = 0; k < 3; ++k) wide_store(o->particles->internal[k] + here, force[k]);
}

BRECCIA_WIDE StretchRange ordinary_dilate_wide(const Ordinary *o, int64_t slice)
{
  const Ordinary local = *o; /* so that stores are seen not to change it */
  return o->gaps[slice] ? dilate(&local, slice, true) : dilate(&local, slice, false);
}

BRECCIA_WIDE void ordinary_resist_wide(const Ordinary *o, int64_t slice)
{
  const Ordinary local = *o;
  if (o->gaps[slice])
    resist(&local, slice, true);
  else
    resist(&local, slice, false);
}

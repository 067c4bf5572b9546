/* Rows of hybrid bonds one by one: where they stand, what their strain is made of, and which ones a place's bonds have. */
#include "formulation/hybrid.h"

#include <string.h>

static HybridRow row_of(const Hybrid *h, int64_t slice, int64_t row)
{
  const BondList *l = h->bonds;
  HybridRow at = {.slice = slice, .group = -1, .listed = -1, .geometry = -1};
  at.second = bond_list_bond(l, h->family, at.slice, row, &at.slot, &at.lane);
  const int64_t n = row - l->first[at.slice], owned = l->owned_first[at.slice + 1] - l->owned_first[at.slice];
  if (n >= SLICE * owned) {
    at.listed = h->listed_first[at.slice + 1] - (l->first[at.slice + 1] - row);
    return at;
  }
  at.group = l->owned_first[at.slice] + n / SLICE;
  const int32_t whole = h->group[at.group], geometry = whole < 0 ? h->mixed[-1 - whole][at.lane] : whole;
  at.listed = geometry < -1 ? -2 - geometry : -1;
  at.geometry = geometry < -1 ? -1 : geometry;
  return at;
}

HybridRow hybrid_row(const Hybrid *h, int64_t row)
{
  int64_t slice = 0, high = h->particles->slices;
  while (high - slice > 1) {
    const int64_t middle = (slice + high) / 2;
    if (h->bonds->first[middle] <= row)
      slice = middle;
    else
      high = middle;
  }
  return row_of(h, slice, row);
}

static void view_listed(const Hybrid *h, int64_t slice, int64_t number, HybridView *view)
{
  view->idle = h->idle[number];
  view->member = h->member + h->first[number];
  if (h->moments) {
    view->count = h->moments->present[number];
    view->g = (const double(*)[3])view->tried;
    hybrid_moments_vectors(h, slice, number, view->tried);
  } else {
    view->count = (int)(h->first[number + 1] - h->first[number]);
    view->g = (const double(*)[3])(h->g + h->first[number]);
  }
  memcpy(view->area, h->area[number], sizeof view->area);
  view->volume = h->volume[number];
  view->laminate = hybrid_laminate(h, number);
}

void hybrid_view_at(const Hybrid *h, const HybridRow *at, HybridView *view)
{
  view->idle = true;
  view->count = 0;
  view->laminate = NULL;
  view->volume = 0;
  if (at->listed >= 0) {
    view_listed(h, at->slice, at->listed, view);
    return;
  }
  if (at->geometry < 0) return;
  const Family *f = h->family;
  const HybridGeometry *geometry = &h->table.geometry[at->geometry];
  const int begin = f->pattern_begin[h->particles->block[at->slice]] - 1;
  view->idle = !geometry->count;
  view->count = geometry->count;
  view->member = view->near;
  view->g = (const double(*)[3])(h->table.g + geometry->first);
  memcpy(view->area, geometry->area, sizeof view->area);
  view->volume = geometry->volume;
  int32_t base[HYBRID_NEAR];
  base[0] = (int32_t)(at->slice * SLICE);
  for (int64_t slot = f->first[at->slice]; slot < f->stored[at->slice]; ++slot)
    base[family_pattern(f, at->slice, slot) - begin] = family_base(f, at->slice, slot);
  for (int n = 0; n < view->count; ++n) view->near[n] = base[h->table.near[geometry->first + n]] + at->lane;
}

void hybrid_view(const Hybrid *h, int64_t row, HybridView *view)
{
  const HybridRow at = hybrid_row(h, row);
  hybrid_view_at(h, &at, view);
}

HybridRows hybrid_rows(const Hybrid *h, int64_t place)
{
  return (HybridRows){.place = place, .slot = h->family->first[place / SLICE] - 1};
}

/** Advances to the next slot of the place whose bond has rows. @return false if there is none */
static bool next_slot(const Hybrid *h, HybridRows *rows)
{
  const Family *f = h->family;
  const int64_t slice = rows->place / SLICE;
  const int lane = (int)(rows->place % SLICE);
  while (++rows->slot < f->first[slice + 1]) {
    if (!(f->intact[rows->slot] >> lane & 1)) continue;
    rows->other = rows->slot < f->stored[slice] ? family_base(f, slice, rows->slot) + lane
                                                : f->neighbour[(int64_t)f->base[rows->slot] * SLICE + lane];
    if (!is_foreign(h->foreign, rows->place) || !is_foreign(h->foreign, rows->other)) return true;
  }
  return false;
}

bool hybrid_rows_next(const Hybrid *h, HybridRows *rows, HybridRow *at)
{
  const Family *f = h->family;
  int64_t both[2];
  if (rows->more) {
    rows->more = false;
    bond_list_rows(h->bonds, f, rows->place / SLICE, rows->slot, (int)(rows->place % SLICE), both);
    rows->row = both[0] == rows->row ? both[1] : both[0];
    *at = row_of(h, rows->owner, rows->row);
    return true;
  }
  if (!next_slot(h, rows)) return false;
  const int64_t other = rows->other;
  const bool from_there = is_foreign(h->foreign, rows->place);
  rows->alone = from_there || is_foreign(h->foreign, other);
  const int64_t from = from_there ? other : rows->place;
  const int64_t slot = from_there ? family_slot(f, (int32_t)other, (int32_t)rows->place) : rows->slot;
  bond_list_rows(h->bonds, f, from / SLICE, slot, (int)(from % SLICE), both);
  rows->owner = (rows->alone || from < other ? from : other) / SLICE;
  rows->more = both[0] != both[1];
  rows->row = both[0];
  *at = row_of(h, rows->owner, rows->row);
  return true;
}

bool hybrid_rows_near(const Hybrid *h, const HybridRows *rows, int32_t place)
{
  const double *const *x = (const double *const *)h->particles->position, reach = h->family->reach * (1 + 1e-6);
  double square = 0;
  for (int k = 0; k < 3; ++k) square += (x[k][rows->other] - x[k][place]) * (x[k][rows->other] - x[k][place]);
  return square <= reach * reach;
}

double hybrid_volume(const Hybrid *h, const HybridRow *at)
{
  if (at->listed >= 0) return h->idle[at->listed] ? 0 : h->volume[at->listed];
  const HybridGeometry *geometry = at->geometry >= 0 ? &h->table.geometry[at->geometry] : NULL;
  return geometry && geometry->count ? geometry->volume : 0;
}

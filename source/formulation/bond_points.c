/* Bonds whose law has a history. Each bond has its material point once, in its row of the bond list: the stretch of the bond goes to it, and what
 * comes back is a stress that acts on c / E times the bond's weight. Both ends then read their bond's pull, force per length of y:
 * per volume of the particle on lattices, and per volume of the neighbour too on stored bonds, where that differs from end to end. A bond
 * between two materials is half a fibre of each, side by side, with a row for each. */
#include "formulation/bond_based.h"

#include <math.h>

enum { AHEAD = 12 }; /* slots */

/** Rows of a slice that are worked on together. */
typedef struct Chunk {
  int64_t slice, row;
  int count;
  double *strain, *lever; /* [count]; lever: pull per stress */
  const double *u[3];
  double per_stress;
} Chunk;

/** Stretch and |xi| / |y| from d = eta . (xi + y) / |xi|^2. By the series without root and quotients, which would take more time than all
 *  else; lanes for which it is not good are marked. */
LANES_INLINE Lanes stretch_of(Lanes d, bool series, Lanes *shortened, LaneMask *beyond)
{
  if (!series) {
    const Lanes ratio = lanes_root(lanes_set(1) + d);
    *shortened = lanes_set(1) / ratio;
    return d / (lanes_set(1) + ratio);
  }
  const Lanes g = shortening_series(d);
  *beyond |= (LaneMask)(lanes_absolute(d) > lanes_set(range_limit[RANGE_SERIES]));
  *shortened = lanes_set(1) - g;
  return d * *shortened - g;
}

/** A lattice slot, both halves side by side. */
LANES_INLINE void stretch_lattice(const BondBased *b, const Chunk *chunk, int64_t slot, int at, bool gaps, bool series,
                                  LaneMask *beyond)
{
  const Family *f = b->family;
  const int pattern = f->pattern[slot];
  const Pattern *row = &f->patterns[pattern];
  const int64_t there = f->base[slot], here = chunk->slice * SLICE;
  const Lanes twice[3] = {lanes_load(b->numbers + b->rows[pattern].xi[0]),
                          lanes_load(b->numbers + b->rows[pattern].xi[1]),
                          lanes_load(b->numbers + b->rows[pattern].xi[2])};
  const Lanes by_square = lanes_set(row->by_square), pull = lanes_set(row->weight_by_length * chunk->per_stress);
  for (int half = 0; half < 2; ++half) {
    Lanes d = {0}, shortened, lever = pull;
    for (int k = 0; k < 3; ++k) {
      const Lanes eta = lanes_load(chunk->u[k] + there + LANES * half) - lanes_load(chunk->u[k] + here + LANES * half);
      d += eta * (twice[k] + eta);
    }
    if (gaps) {
      const LaneMask intact = lanes_half(f->intact[slot], half);
      d = lanes_where(intact, d);
      lever = lanes_where(intact, lever);
    }
    d *= by_square;
    if (b->surface) lever *= bond_surface(b, slot, half);
    lanes_store(chunk->strain + at + LANES * half, stretch_of(d, series, &shortened, beyond));
    lanes_store(chunk->lever + at + LANES * half, lever * shortened);
  }
}

/** Four stored bonds from what their ends show. Of those that are broken `lever` is 0.
 *  @param[in,out] lever  pull per stress, but for the length of y; and with it
 *  @return the stretches */
LANES_INLINE Lanes stretch_stored(const Lanes own[2][3], const Lanes x[LANES], const Lanes u[LANES], Lanes *lever,
                                  bool series, LaneMask *beyond)
{
  Lanes d = {0}, square = {0}, shortened;
  for (int k = 0; k < 3; ++k) {
    const Lanes xi = x[k] - own[0][k], eta = u[k] - own[1][k];
    d += eta * (xi + xi + eta);
    square += xi * xi;
  }
  const Lanes strain = stretch_of(lanes_where(*lever != lanes_set(0), d) / square, series, &shortened, beyond);
  *lever = *lever * shortened / lanes_root(square);
  return strain;
}

/** Four stored bonds of half a slot: most of those that a slice owns, and half as dear as four that lie anywhere. */
LANES_INLINE void stretch_half(const BondBased *b, const Chunk *chunk, int32_t code, int at, bool series,
                               LaneMask *beyond)
{
  const Family *f = b->family;
  const int64_t slot = f->first[chunk->slice] + code / SLICE, here = chunk->slice * SLICE + code % SLICE,
                place = (int64_t)f->base[slot] * SLICE + code % SLICE;
  const int half = code % SLICE / LANES;
  Lanes own[2][3], x[LANES], u[LANES];
  for (int k = 0; k < 3; ++k) {
    own[0][k] = lanes_load(b->particles->position[k] + here);
    own[1][k] = lanes_load(chunk->u[k] + here);
  }
  lanes_gather_rows(b->shown, BOND_SHOWN, f->neighbour + place, x);
  lanes_gather_rows(b->shown + LANES, BOND_SHOWN, f->neighbour + place, u);
  Lanes lever = lanes_set(0.5) * (lanes_set(chunk->per_stress) + u[3]);
  if (f->scale) lever *= lanes_load(f->scale + place);
  if (b->surface) lever *= bond_surface(b, slot, half);
  lever = lanes_where(lanes_half(f->intact[slot], half), lever);
  lanes_store(chunk->strain + at, stretch_stored(own, x, u, &lever, series, beyond));
  lanes_store(chunk->lever + at, lever);
}

/** Whether four rows are those of half a slot. */
static inline bool is_half(const int32_t *codes)
{
  return codes[0] >= 0 && codes[0] % LANES == 0 && codes[LANES - 1] == codes[0] + LANES - 1;
}

/** Up to four stored bonds, each of one row. */
LANES_INLINE void stretch_singles(const BondBased *b, const Chunk *chunk, const int32_t *codes, int count, int at,
                                  bool series, LaneMask *beyond)
{
  const Family *f = b->family;
  int32_t here[LANES], there[LANES];
  Lanes x[2][LANES], u[2][LANES], lever = {0}, strain;
  for (int n = 0; n < LANES; ++n) {
    const int32_t single = codes[n < count ? n : count - 1];
    const bool second = single < 0;
    const int32_t code = second ? -1 - single : single;
    const int lane = code % SLICE;
    const int64_t slot = f->first[chunk->slice] + code / SLICE, place = (int64_t)f->base[slot] * SLICE + lane;
    here[n] = (int32_t)(chunk->slice * SLICE + lane);
    there[n] = f->neighbour[place];
    const double own = b->shown[BOND_SHOWN * (int64_t)here[n] + 7],
                 other = b->shown[BOND_SHOWN * (int64_t)there[n] + 7];
    const bool mixed = b->material[here[n] / SLICE] != b->material[there[n] / SLICE];
    lever[n] = f->intact[slot] >> lane & 1 ? 0.5 * (mixed ? (second ? other : own) : own + other) : 0;
    if (f->scale) lever[n] *= f->scale[place];
    if (b->surface) lever[n] *= (double)b->surface[slot * SLICE + lane];
  }
  lanes_gather_rows(b->shown, BOND_SHOWN, here, x[0]);
  lanes_gather_rows(b->shown, BOND_SHOWN, there, x[1]);
  lanes_gather_rows(b->shown + LANES, BOND_SHOWN, here, u[0]);
  lanes_gather_rows(b->shown + LANES, BOND_SHOWN, there, u[1]);
  const Lanes own[2][3] = {{x[0][0], x[0][1], x[0][2]}, {u[0][0], u[0][1], u[0][2]}};
  strain = stretch_stored(own, x[1], u[1], &lever, series, beyond);
  for (int n = 0; n < count; ++n) {
    chunk->strain[at + n] = strain[n];
    chunk->lever[at + n] = lever[n];
  }
}

/** @return whether all stretches are small enough for the series, if that is asked for */
LANES_INLINE bool stretch_rows(const BondBased *b, const Chunk *chunk, bool gaps, bool series)
{
  const BondList *l = b->bonds;
  const int64_t slice = chunk->slice, from = chunk->row - l->first[slice],
                lattice = SLICE * (l->owned_first[slice + 1] - l->owned_first[slice]);
  LaneMask beyond = {0};
  int at = 0;
  for (; at < chunk->count && from + at < lattice; at += SLICE) {
    const int64_t slot = b->family->first[slice] + l->owned[l->owned_first[slice] + (from + at) / SLICE];
    stretch_lattice(b, chunk, slot, at, gaps, series, &beyond);
  }
  const int64_t singles = l->single_first[slice] + from - lattice;
  for (int count; at < chunk->count; at += count) {
    const int32_t *codes = l->single + (singles + at);
    const int left = chunk->count - at;
    count = left < LANES ? left : LANES;
    if (!l->partner_row && left >= LANES && is_half(codes)) {
      stretch_half(b, chunk, codes[0], at, series, &beyond);
      continue;
    }
    for (int n = 1; n < count && n + LANES <= left; ++n)
      if (is_half(codes + n)) count = n;
    stretch_singles(b, chunk, codes, count, at, series, &beyond);
  }
  return !(beyond[0] | beyond[1] | beyond[2] | beyond[3]);
}

BRECCIA_CLONES
static void stretch_chunk(const BondBased *b, const Sweep *sweep)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  const Particles *p = b->particles;
  const Chunk chunk = {.slice = sweep->first,
                       .row = sweep->row,
                       .count = sweep->rows,
                       .strain = sweep->strain[0],
                       .lever = sweep->carry,
                       .u = {p->displacement[0], p->displacement[1], p->displacement[2]},
                       .per_stress = b->per_stress[p->block[sweep->first]]};
  const bool small =
      local.gaps[chunk.slice] ? stretch_rows(&local, &chunk, true, true) : stretch_rows(&local, &chunk, false, true);
  if (!small) stretch_rows(&local, &chunk, true, false);
}

int64_t bond_stretch(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  if (b->bonds) stretch_chunk(b, sweep);
  return -1;
}

int64_t bond_pull_of_stress(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  if (!b->bonds) return -1;
  int64_t slot;
  int lane;
  const double *stress = sweep->stress[0], *lever = sweep->carry;
  if (!bond_list_bond(b->bonds, b->family, sweep->first, sweep->row, &slot, &lane)) {
    for (int i = 0; i < sweep->rows; ++i) b->pull[sweep->row + i] = stress[i] * lever[i];
    return -1;
  }
  for (int i = 0; i < sweep->rows; ++i) { /* second rows add to the first of their bonds */
    bond_list_bond(b->bonds, b->family, sweep->first, sweep->row + i, &slot, &lane);
    b->pull[b->bonds->stored_row[(int64_t)b->family->base[slot] * SLICE + lane]] += stress[i] * lever[i];
  }
  return -1;
}

LANES_INLINE void resist_lattice(const BondBased *b, const double *const u[3], int64_t slice, int64_t slot, bool gaps,
                                 Lanes force[2][3], const Lanes own[2][3])
{
  const Family *f = b->family;
  const Pattern *row = &f->patterns[f->pattern[slot]];
  /* Pulls of bonds that others own lie far apart: without this most of the time is waiting for them. */
  const int32_t *ahead = b->bonds->slot_row[slot + AHEAD];
  __builtin_prefetch(b->pull + ahead[0]);
  __builtin_prefetch(b->pull + ahead[1]);
  for (int half = 0; half < 2; ++half) {
    const int64_t there = f->base[slot] + LANES * half;
    Lanes pull = bond_list_load(b->bonds, f, b->pull, slice, slot, half);
    if (gaps) pull = lanes_where(lanes_half(f->intact[slot], half), pull);
    for (int k = 0; k < 3; ++k)
      force[half][k] += pull * (lanes_set(row->xi[k]) + (lanes_load(u[k] + there) - own[half][k]));
  }
}

LANES_INLINE void resist_stored(const BondBased *b, int64_t slice, int64_t slot, int half, Lanes force[3],
                                const Lanes own[3])
{
  const Family *f = b->family;
  const int64_t at = (int64_t)f->base[slot] * SLICE + LANES * half, here = slice * SLICE + LANES * half;
  Lanes x[LANES], u[LANES], pull = bond_list_load(b->bonds, f, b->pull, slice, slot, half);
  lanes_gather_rows(b->shown, BOND_SHOWN, f->neighbour + at, x);
  lanes_gather_rows(b->shown + LANES, BOND_SHOWN, f->neighbour + at, u);
  pull = lanes_where(lanes_half(f->intact[slot], half), pull * x[3]);
  for (int k = 0; k < 3; ++k)
    force[k] += pull * ((x[k] - lanes_load(b->particles->position[k] + here)) + (u[k] - own[k]));
}

LANES_INLINE void resist_slice(const BondBased *b, int64_t slice, bool gaps)
{
  const Family *f = b->family;
  const int64_t stored = f->stored[slice], last = f->first[slice + 1];
  double *const *all = b->particles->displacement;
  const double *const u[3] = {all[0], all[1], all[2]};
  Lanes force[2][3] = {{{0}}}, own[2][3];
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + slice * SLICE + LANES * half);
  for (int64_t slot = f->first[slice]; slot < stored; ++slot) resist_lattice(b, u, slice, slot, gaps, force, own);
  for (int64_t slot = stored; slot < last; ++slot)
    for (int half = 0; half < 2; ++half) resist_stored(b, slice, slot, half, force[half], own[half]);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(b->particles->internal[k] + slice * SLICE + LANES * half, force[half][k]);
}

BRECCIA_CLONES
static void resist_points(const BondBased *b, int64_t first, int64_t last)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice)
    if (local.gaps[slice])
      resist_slice(&local, slice, true);
    else
      resist_slice(&local, slice, false);
}

void bond_resist_points(const BondBased *b, int64_t first, int64_t last)
{
  resist_points(b, first, last);
}

double bond_pull(const BondBased *b, int64_t slice, int64_t slot, int lane, const Bond *bond, double y[3])
{
  double tension, slope, length = 0;
  bond_tension(b, slice, slot, lane, bond, y, &tension, &slope);
  for (int k = 0; k < 3; ++k) length += y[k] * y[k];
  if (b->surface) tension *= (double)b->surface[slot * SLICE + lane];
  return tension / sqrt(length);
}

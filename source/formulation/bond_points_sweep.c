/* Bonds whose law has a history. Each bond has its material point once, in its row of the bond list: the stretch of the bond goes to it, and what
 * comes back is a stress that acts on c / E times the bond's weight. Both ends then read their bond's pull, force per length of y:
 * per volume of the particle on lattices, and per volume of the neighbour too on stored bonds, where that differs from end to end. A bond
 * between two materials is half a fibre of each, side by side, with a row for each. For each kind of vectors. */
#include "formulation/bond_based.h"

enum { AHEAD = 12 }; /* lattice slots */

/** Rows of a slice that are worked on together. */
typedef struct Chunk {
  int64_t slice, row;
  int count;
  double *strain, *lever; /* [count]; lever: pull per stress */
  double *const *u;       /* rows of displacements */
  double per_stress;
} Chunk;

/** Stretch and |xi| / |y| from d = eta . (xi + y) / |xi|^2. By the series without root and quotients, which would take more time than all
 *  else, where it is good for all bonds (`within`). */
LANES_INLINE Lanes stretch_of(Lanes d, bool series, Lanes *shortened)
{
  if (!series) {
    const Lanes ratio = lanes_root(lanes_set(1) + d);
    *shortened = lanes_set(1) / ratio;
    return d / (lanes_set(1) + ratio);
  }
  const Lanes g = shortening_series(d);
  *shortened = lanes_set(1) - g;
  return d * *shortened - g;
}

/** A lattice slot, both halves side by side. */
LANES_INLINE void stretch_lattice(const BondBased *b, const Chunk *chunk, int64_t slot, int at, bool gaps, bool series,
                                  LanesWithin *within)
{
  const Family *f = b->family;
  const int pattern = family_pattern(f, chunk->slice, slot);
  const Pattern *row = &f->patterns[pattern];
  const int64_t there = family_base(f, chunk->slice, slot), here = chunk->slice * SLICE;
  const float *factors = bond_factors(b, chunk->slice);
  const Lanes twice[3] = {lanes_repeated(b->numbers + b->rows[pattern].xi[0]),
                          lanes_repeated(b->numbers + b->rows[pattern].xi[1]),
                          lanes_repeated(b->numbers + b->rows[pattern].xi[2])};
  const Lanes by_square = lanes_set(row->by_square), pull = lanes_set(row->weight_by_length * chunk->per_stress);
  for (int half = 0; half < HALVES; ++half) {
    Lanes d = {0}, shortened, lever = pull;
    for (int k = 0; k < 3; ++k) {
      const Lanes eta = lanes_load(chunk->u[k] + there + LANES * half) - lanes_load(chunk->u[k] + here + LANES * half);
      d += eta * (twice[k] + eta);
    }
    if (gaps) {
      d = lanes_intact(f->intact[slot], half, d);
      lever = lanes_intact(f->intact[slot], half, lever);
    }
    d *= by_square;
    if (factors) lever *= bond_surface(b, factors, chunk->slice, slot, half);
    *within = lanes_within(*within, d, lanes_set(range_limit[RANGE_SERIES]));
    lanes_store(chunk->strain + at + LANES * half, stretch_of(d, series, &shortened));
    lanes_store(chunk->lever + at + LANES * half, lever * shortened);
  }
}

/** Stored bonds side by side, from what their ends show. Of those that are broken `lever` is 0.
 *  @param[in] here        the ends that own them
 *  @param[in] counted     bits of those for which the series must be good
 *  @param[in,out] lever  pull per stress, but for the length of y; and with it
 *  @return the stretches */
LANES_INLINE Lanes stretch_stored(const StretchHere *here, const Lanes x[QUAD], const Lanes u[QUAD], unsigned counted,
                                  int half, Lanes *lever, bool series, LanesWithin *within)
{
  Lanes d = {0}, square = {0}, shortened;
  for (int k = 0; k < 3; ++k) {
    const Lanes xi = x[k] - here->x[k], eta = u[k] - here->u[k];
    d += eta * (xi + xi + eta);
    square += xi * xi;
  }
  const LaneMask there = (LaneMask)(*lever != lanes_set(0)); /* where no bond is, both ends may be one */
  const Lanes by_square = lanes_where(there, lanes_set(1) / lanes_choose(there, square, lanes_set(1)));
  d *= by_square;
  const Lanes strain = stretch_of(d, series, &shortened);
  *within = lanes_within_where(*within, counted, half, d, lanes_set(range_limit[RANGE_SERIES]));
  *lever *= shortened * lanes_root(by_square);
  return strain;
}

/** Bonds of a stored slot that have rows.
 *  @param[in] owned  their bits */
LANES_INLINE void stretch_slot(const BondBased *b, const Chunk *chunk, const StretchHere here[HALVES], int64_t slot,
                               unsigned owned, int at, bool series, StretchWalk walk[HALVES], LanesWithin *within)
{
  const Family *f = b->family;
  const float *factors = bond_factors(b, chunk->slice);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = walk[half].at;
    const StretchShown there = stretch_next(&walk[half]);
    Lanes lever = lanes_set(0.5 * chunk->per_stress) + there.u[3];
    if (f->scale) lever *= lanes_load(f->scale + place);
    if (factors) lever *= bond_surface(b, factors, chunk->slice, slot, half);
    lever = lanes_intact(f->intact[slot], half, lever);
    const Lanes strain = stretch_stored(&here[half], there.x, there.u, owned, half, &lever, series, within);
    lanes_store_some(chunk->strain + at, owned, half, strain);
    lanes_store_some(chunk->lever + at, owned, half, lever);
    at += __builtin_popcount(owned >> (LANES * half) & ((1u << LANES) - 1));
  }
}

/** Rows of stored bonds, of one material, slot by slot. There is no branch for slots of which not all lanes have rows: which these are follows no rule
 *  that a processor could guess. */
LANES_INLINE void stretch_slots(const BondBased *b, const Chunk *chunk, int32_t code, int at, bool series,
                                LanesWithin *within)
{
  const Family *f = b->family;
  const int64_t first = f->first[chunk->slice] + code / SLICE;
  StretchHere here[HALVES] = {0};
  StretchWalk walk[HALVES] = {0};
  for (int half = 0; half < HALVES; ++half) {
    here[half] = stretch_here(b->particles, chunk->u, chunk->slice, half);
    walk[half] = stretch_walk(f, b->shown, first, f->first[chunk->slice + 1], half);
  }
  unsigned rest = (unsigned)UINT8_MAX << (code % SLICE); /* a chunk may begin and end within a slot */
  for (int64_t slot = first; at < chunk->count; ++slot, rest = UINT8_MAX) {
    unsigned owned = b->bonds->keeps[f->base[slot]] & rest;
    while (__builtin_popcount(owned) > chunk->count - at) owned &= ~(1u << (31 - __builtin_clz(owned)));
    stretch_slot(b, chunk, here, slot, owned, at, series, walk, within);
    at += __builtin_popcount(owned);
  }
}

/** Some stored bonds, each of one row, where there are rows of two materials. */
LANES_INLINE void stretch_singles(const BondBased *b, const Chunk *chunk, const int32_t *codes, int count, int at,
                                  bool series, LanesWithin *within)
{
  const Family *f = b->family;
  int32_t here[LANES], there[LANES];
  Lanes x[2][QUAD], u[2][QUAD], lever = {0}, strain;
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
    const double share = mixed ? 2 * bond_share(b, here[n] / SLICE, there[n] / SLICE) : 1;
    lever[n] = f->intact[slot] >> lane & 1 ? (mixed ? (second ? (2 - share) * other : share * own) : own + other) : 0;
    if (f->scale) lever[n] *= f->scale[place];
    lever[n] *= bond_factor(b, chunk->slice, slot, lane);
  }
  lanes_gather_rows(b->shown, BOND_SHOWN, here, x[0]);
  lanes_gather_rows(b->shown, BOND_SHOWN, there, x[1]);
  lanes_gather_rows(b->shown + QUAD, BOND_SHOWN, here, u[0]);
  lanes_gather_rows(b->shown + QUAD, BOND_SHOWN, there, u[1]);
  const StretchHere own = {{x[0][0], x[0][1], x[0][2]}, {u[0][0], u[0][1], u[0][2]}};
  strain = stretch_stored(&own, x[1], u[1], UINT8_MAX, 0, &lever, series, within);
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
  LanesWithin within = lanes_all_within();
  int at = 0;
  for (; at < chunk->count && from + at < lattice; at += SLICE) {
    const int64_t slot = b->family->first[slice] + l->owned[l->owned_first[slice] + (from + at) / SLICE];
    stretch_lattice(b, chunk, slot, at, gaps, series, &within);
  }
  const int64_t singles = l->single_first[slice] + from - lattice;
  const int32_t *codes = l->single + singles;
  __builtin_prefetch(
      (const void *)((uintptr_t)(codes + at) + 2 * BATCH * sizeof *codes)); /* of chunks to come: one number each */
  if (at < chunk->count && !l->partner_row) stretch_slots(b, chunk, codes[at], at, series, &within);
  for (int count; at < chunk->count && l->partner_row; at += count) {
    count = chunk->count - at < LANES ? chunk->count - at : LANES;
    stretch_singles(b, chunk, codes + at, count, at, series, &within);
  }
  return lanes_are_within(within);
}

static void stretch_chunk(const BondBased *b, const Sweep *sweep)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  const Chunk chunk = {.slice = sweep->first,
                       .row = sweep->row,
                       .count = sweep->rows,
                       .strain = sweep->strain[0],
                       .lever = sweep->carry,
                       .u = sweep->displacement,
                       .per_stress = b->per_stress[b->particles->block[sweep->first]]};
  const bool small =
      local.gaps[chunk.slice] ? stretch_rows(&local, &chunk, true, true) : stretch_rows(&local, &chunk, false, true);
  if (!small) stretch_rows(&local, &chunk, true, false);
}

LANES_INLINE void resist_lattice(const BondBased *b, const double *const u[3], int64_t slice, int64_t slot, bool gaps,
                                 Lanes force[HALVES][3], const Lanes own[HALVES][3])
{
  const Family *f = b->family;
  const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
  /* Pulls of bonds that others own lie far apart: without this most of the time is waiting for them. */
  const int32_t *ahead = b->bonds->slot_row[slot + AHEAD];
  __builtin_prefetch(b->pull + ahead[0]);
  __builtin_prefetch(b->pull + ahead[1]);
  for (int half = 0; half < HALVES; ++half) {
    const int64_t there = family_base(f, slice, slot) + LANES * half;
    Lanes pull = bond_list_load(b->bonds, f, b->pull, slice, slot, half);
    if (gaps) pull = lanes_intact(f->intact[slot], half, pull);
    for (int k = 0; k < 3; ++k)
      force[half][k] += pull * (lanes_set(row->xi[k]) + (lanes_load(u[k] + there) - own[half][k]));
  }
}

LANES_INLINE void resist_stored(const BondBased *b, int64_t slot, int half, const StretchHere *here, StretchWalk *walk,
                                Lanes force[3])
{
  const int64_t at = walk->at;
  const int32_t *ahead = b->bonds->stored_row + at + FAMILY_AHEAD * SLICE;
  Lanes pull = lanes_gather(b->pull, b->bonds->stored_row + at);
  __builtin_prefetch((const void *)((uintptr_t)ahead + 4 * FAMILY_AHEAD * SLICE * sizeof *ahead));
  for (int k = 0; k < LANES; ++k) __builtin_prefetch(b->pull + ahead[k]);
  const StretchShown there = stretch_next(walk);
  pull = lanes_intact(b->family->intact[slot], half, pull * there.x[3]);
  for (int k = 0; k < 3; ++k) force[k] += pull * ((there.x[k] - here->x[k]) + (there.u[k] - here->u[k]));
}

LANES_INLINE void resist_slice(const BondBased *b, const Sweep *sweep, int64_t slice, bool gaps)
{
  const Family *f = b->family;
  const int64_t stored = f->stored[slice], last = f->first[slice + 1];
  double *const *all = sweep->displacement;
  const double *const u[3] = {all[0], all[1], all[2]};
  Lanes force[HALVES][3] = {{{0}}}, own[HALVES][3];
  for (int half = 0; half < HALVES; ++half)
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + slice * SLICE + LANES * half);
  for (int64_t slot = f->first[slice]; slot < stored; ++slot) resist_lattice(b, u, slice, slot, gaps, force, own);
  for (int half = 0; half < HALVES; ++half) {
    const StretchHere here = stretch_here(b->particles, all, slice, half);
    StretchWalk walk = stretch_walk(f, b->shown, stored, last, half);
    for (int64_t slot = stored; slot < last; ++slot) resist_stored(b, slot, half, &here, &walk, force[half]);
  }
  for (int half = 0; half < HALVES; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(sweep->internal[k] + slice * SLICE + LANES * half, force[half][k]);
}

static void resist_points(const BondBased *b, const Sweep *sweep)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    if (local.gaps[slice])
      resist_slice(&local, sweep, slice, true);
    else
      resist_slice(&local, sweep, slice, false);
}

const BondPointSweeps LANES_NAMED(bond_point_sweeps) = {.stretch = stretch_chunk, .resist = resist_points};

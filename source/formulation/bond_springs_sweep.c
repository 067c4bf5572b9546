/* Linear bonds: the force on a particle per volume is sum c w s y / |y| with s = (|y| - |xi|) / |xi| and y = xi + eta. As
 * s / |y| = (1 - |xi| / |y|) / |xi|, and |y|^2 = |xi|^2 (1 + d) with d = eta . (xi + y) / |xi|^2, a bond needs
 * g(d) = 1 - (1 + d)^-1/2 only; d has no cancellation however small the stretch. */
#include "formulation/bond_based.h"

#include <math.h>

typedef struct Sum {
  Lanes force[3], own[3]; /* own: displacements */
  Lanes largest;          /* d^2, where that is not by the series of a lattice */
  LanesWithin within;     /* the series */
} Sum;

/** Half a slot between lattice neighbours; back is -eta, and middle 2 xi + eta. Polynomial by pairs: its chain is shorter so. */
LANES_INLINE void add_lattice(const BondBased *b, double *const *u, int64_t slice, int64_t slot, int half, bool gaps,
                              const float *factors, StretchRange range, Sum *sum)
{
  const Family *f = b->family;
  const int pattern = family_pattern(f, slice, slot);
  const SpringRow *row = &b->rows[pattern];
  const double *numbers = b->numbers, *length = numbers + row->length;
  const int64_t there = family_base(f, slice, slot) + LANES * half;
  Lanes d = {0}, twice[3], pull;
  for (int k = 0; k < 3; ++k) {
    Lanes back = sum->own[k] - lanes_load(u[k] + there);
    Lanes middle = lanes_repeated(numbers + row->xi[k]) - back;
    twice[k] = middle - back; /* 2 y */
    d += back * middle;
  }
  if (gaps) d = lanes_intact(f->intact[slot], half, d);
  if (range == RANGE_SERIES) {
    Lanes square = d * d, pair[STRETCH_TERMS / 2];
    for (int n = 0; n < STRETCH_TERMS; n += 2)
      pair[n / 2] = lanes_repeated(length + QUAD * n) + d * lanes_repeated(length + QUAD * (n + 1));
    pull = d * (pair[0] + square * (pair[1] + square * pair[2]));
    sum->within = lanes_within(sum->within, d, lanes_repeated(length + LENGTH_LIMIT));
  } else {
    d *= -lanes_set(f->patterns[pattern].by_square);
    sum->largest = lanes_greatest(sum->largest, d * d);
    pull = lanes_set(0.5 * f->patterns[pattern].weight_by_length) * shortening(d, range);
  }
  if (factors) pull *= bond_surface(b, factors, slice, slot, half);
  for (int k = 0; k < 3; ++k) sum->force[k] += pull * twice[k];
}

/** Half a stored slot; its forces have their constants in them.
 *  @param[in] constant  of the particles */
LANES_INLINE void add_stored(const BondBased *b, int64_t slice, int64_t slot, int half, bool gaps, const float *factors,
                             Lanes constant, const StretchHere *here, StretchRange range, StretchWalk *walk, Sum *sum)
{
  const int64_t at = walk->at;
  const StretchShown there = stretch_next(walk);
  const StretchEnds ends = stretch_ends(b->family, b->by_length, &there, at, b->family->intact[slot], half, gaps, here);
  sum->largest = lanes_greatest(sum->largest, ends.d * ends.d);
  Lanes pull = (constant + ends.last) * (ends.weight * ends.by_length) * shortening(ends.d, range);
  if (factors) pull *= bond_surface(b, factors, slice, slot, half);
  for (int k = 0; k < 3; ++k) sum->force[k] += pull * ends.y[k];
}

/** Forces on a slice, all bonds by one way. @return the way that they should go */
LANES_INLINE StretchRange resist_slice(const BondBased *b, const Sweep *sweep, int64_t slice, bool gaps,
                                       const float *factors, StretchRange range)
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  double *const *u = sweep->displacement;
  const int64_t stored = f->stored[slice], last = f->first[slice + 1];
  const Lanes scale = lanes_set(b->stiffness[p->block[slice]]);
  double most = 0;
  for (int half = 0; half < HALVES; ++half) {
    const int64_t here = slice * SLICE + LANES * half;
    Sum sum = {.within = lanes_all_within()};
    for (int k = 0; k < 3; ++k) sum.own[k] = lanes_load(u[k] + here);
    for (int64_t slot = f->first[slice]; slot < stored; ++slot)
      add_lattice(b, u, slice, slot, half, gaps, factors, range, &sum);
    for (int k = 0; k < 3; ++k) sum.force[k] *= scale;
    const StretchHere own = stretch_here(p, u, slice, half);
    const Lanes constant = lanes_set(stored < last ? b->shown[BOND_SHOWN * slice * SLICE + 7] : 0);
    StretchWalk walk = stretch_walk(f, b->shown, stored, last, half);
    for (int64_t slot = stored; slot < last; ++slot)
      add_stored(b, slice, slot, half, gaps, factors, constant, &own, range, &walk, &sum);
    for (int k = 0; k < 3; ++k) lanes_store(sweep->internal[k] + here, sum.force[k]);
    if (!lanes_are_within(sum.within)) most = INFINITY;
    for (int k = 0; k < LANES; ++k) most = sum.largest[k] > most ? sum.largest[k] : most;
  }
  return stretch_range_after(range, most);
}

LANES_INLINE StretchRange resist_way(const BondBased *b, const Sweep *sweep, int64_t slice, bool gaps,
                                     const float *factors, StretchRange range)
{
  if (range == RANGE_SERIES) return resist_slice(b, sweep, slice, gaps, factors, RANGE_SERIES);
  if (range == RANGE_NEWTON) return resist_slice(b, sweep, slice, gaps, factors, RANGE_NEWTON);
  return resist_slice(b, sweep, slice, gaps, factors, RANGE_ANY);
}

void LANES_NAMED(bond_resist_springs)(const BondBased *b, const Sweep *sweep)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    /* Begins with the way of the last time, and ends with the first way that is good: what came before does not show in the bits. */
    StretchRange range = (StretchRange)local.range[slice], next = range;
    const float *factors = bond_factors(&local, slice);
    for (int turn = 0; turn < 3; ++turn) {
      range = next;
      next = factors             ? resist_way(&local, sweep, slice, true, factors, range)
             : local.gaps[slice] ? resist_way(&local, sweep, slice, true, NULL, range)
                                 : resist_way(&local, sweep, slice, false, NULL, range);
      if (next == range) break;
    }
    local.range[slice] = (uint8_t)range;
  }
}

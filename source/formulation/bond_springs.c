/* Linear bonds: the force on a particle per volume is sum c w s y / |y| with s = (|y| - |xi|) / |xi| and y = xi + eta. As
 * s / |y| = (1 - |xi| / |y|) / |xi|, and |y|^2 = |xi|^2 (1 + d) with d = eta . (xi + y) / |xi|^2, a bond needs
 * g(d) = 1 - (1 + d)^-1/2 only; d has no cancellation however small the stretch. */
#include "formulation/bond_based.h"

#include "base/wide.h"
#include <math.h>

/* The table of lattice bonds. Components of reference vectors are few, and so are lengths with weights: each number stands there as often
 * as a vector has lanes, so that arithmetic takes it from memory (a tenth faster than spreading one). Behind what is read of a length: */
enum { LENGTH_KEY = LENGTH_LIMIT + LANES, LENGTH_SIZE = LENGTH_KEY + LANES };

static void put(BondBased *b, int64_t at, double number)
{
  for (int k = 0; k < LANES; ++k) b->numbers[at + k] = number;
}

static void put_length(BondBased *b, int64_t at, const Pattern *pattern)
{
  const double square = pattern->length * pattern->length;
  double scale = -pattern->weight_by_length / 2; /* series in -d, and halved because vectors are doubled */
  for (int n = 0; n < STRETCH_TERMS; ++n) put(b, at + LENGTH_PULL + LANES * n, (scale /= square) * shortening_terms[n]);
  put(b, at + LENGTH_LIMIT, range_limit[RANGE_SERIES] * square);
  b->numbers[at + LENGTH_KEY] = pattern->length;
  b->numbers[at + LENGTH_KEY + 1] = pattern->weight;
}

int bond_springs_create(BondBased *b, Error *error)
{
  const Family *f = b->family;
  b->rows = memory_zeroed((size_t)f->pattern_count, sizeof *b->rows, "bond constants", error);
  b->numbers = places_array((int64_t)f->pattern_count * (3 * LANES + LENGTH_SIZE), "bond constants", error);
  if (!b->rows || !b->numbers) return BRECCIA_FAILURE;
  b->wide = wide_lanes_pay();
  int32_t end = 0;
  for (int p = 0; p < f->pattern_count; ++p)
    for (int k = 0; k < 3; ++k) {
      int32_t at = 0;
      while (at < end && b->numbers[at] != 2 * f->patterns[p].xi[k]) at += LANES;
      if (at == end) put(b, at, 2 * f->patterns[p].xi[k]);
      if (at == end) end += LANES;
      b->rows[p].xi[k] = at;
    }
  const int32_t lengths = end;
  for (int p = 0; p < f->pattern_count; ++p) {
    const Pattern *pattern = &f->patterns[p];
    int32_t at = lengths;
    while (at < end &&
           (b->numbers[at + LENGTH_KEY] != pattern->length || b->numbers[at + LENGTH_KEY + 1] != pattern->weight))
      at += LENGTH_SIZE;
    if (at == end) put_length(b, at, pattern);
    if (at == end) end += LENGTH_SIZE;
    b->rows[p].length = at;
  }
  return BRECCIA_OK;
}

typedef struct Sum {
  Lanes force[3], own[3]; /* own: displacements */
  Lanes largest;          /* |d|, beyond the series */
  LaneMask beyond;        /* the series */
} Sum;

/** Half a slot between lattice neighbours; back is -eta, and middle 2 xi + eta. Polynomial by pairs: its chain is shorter so. */
LANES_INLINE void add_lattice(const BondBased *b, int64_t slot, int half, bool gaps, bool corrected, StretchRange range,
                              Sum *sum)
{
  const Family *f = b->family;
  const int pattern = f->pattern[slot];
  const SpringRow *row = &b->rows[pattern];
  const double *numbers = b->numbers, *length = numbers + row->length;
  const int64_t there = f->base[slot] + LANES * half;
  Lanes d = {0}, twice[3], pull;
  for (int k = 0; k < 3; ++k) {
    Lanes back = sum->own[k] - lanes_load(b->particles->displacement[k] + there);
    Lanes middle = lanes_load(numbers + row->xi[k]) - back;
    twice[k] = middle - back; /* 2 y */
    d += back * middle;
  }
  if (gaps) d = lanes_where(lanes_half(f->intact[slot], half), d);
  if (range == RANGE_SERIES) {
    Lanes square = d * d, pair[STRETCH_TERMS / 2];
    for (int n = 0; n < STRETCH_TERMS; n += 2)
      pair[n / 2] = lanes_load(length + LANES * n) + d * lanes_load(length + LANES * (n + 1));
    pull = d * (pair[0] + square * (pair[1] + square * pair[2]));
    sum->beyond |= (LaneMask)(lanes_absolute(d) > lanes_load(length + LENGTH_LIMIT));
  } else {
    d *= -lanes_set(f->patterns[pattern].by_square);
    sum->largest = lanes_greatest(sum->largest, lanes_absolute(d));
    pull = lanes_set(0.5 * f->patterns[pattern].weight_by_length) * shortening(d, range);
  }
  if (corrected) pull *= bond_surface(b, slot, half);
  for (int k = 0; k < 3; ++k) sum->force[k] += pull * twice[k];
}

/** Half a stored slot; its forces have their constants in them. */
LANES_INLINE void add_stored(const BondBased *b, int64_t slot, int64_t slice, int half, StretchRange range, Sum *sum)
{
  StretchEnds ends = stretch_ends(b->family, b->shown, slice, slot, half, sum->own);
  sum->largest = lanes_greatest(sum->largest, lanes_absolute(ends.d));
  Lanes pull = bond_constant(b, slice, &ends) * (ends.weight * ends.by_length) * shortening(ends.d, range);
  if (b->surface) pull *= bond_surface(b, slot, half);
  for (int k = 0; k < 3; ++k) sum->force[k] += pull * ends.y[k];
}

/** Forces on a slice, all bonds by one way. @return the way that they should go */
LANES_INLINE StretchRange resist_slice(const BondBased *b, int64_t slice, bool gaps, bool corrected, StretchRange range)
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  const int64_t stored = f->stored[slice], last = f->first[slice + 1];
  const Lanes scale = lanes_set(b->stiffness[p->block[slice]]);
  Sum sum[2] = {{.beyond = {0}}, {.beyond = {0}}};
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) sum[half].own[k] = lanes_load(p->displacement[k] + slice * SLICE + LANES * half);
  for (int half = 0; half < 2; ++half)
    for (int64_t slot = f->first[slice]; slot < stored; ++slot)
      add_lattice(b, slot, half, gaps, corrected, range, &sum[half]);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) sum[half].force[k] *= scale;
  for (int64_t slot = stored; slot < last; ++slot)
    for (int half = 0; half < 2; ++half) add_stored(b, slot, slice, half, range, &sum[half]);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(p->internal[k] + slice * SLICE + LANES * half, sum[half].force[k]);
  Lanes largest = lanes_greatest(sum[0].largest, sum[1].largest);
  LaneMask beyond = sum[0].beyond | sum[1].beyond;
  double most = beyond[0] | beyond[1] | beyond[2] | beyond[3] ? INFINITY : 0;
  for (int k = 0; k < LANES; ++k) most = largest[k] > most ? largest[k] : most;
  if (range == RANGE_SERIES && most > range_limit[RANGE_SERIES]) return RANGE_NEWTON;
  return stretch_range(most);
}

LANES_INLINE StretchRange resist_way(const BondBased *b, int64_t slice, bool gaps, bool corrected, StretchRange range)
{
  if (range == RANGE_SERIES && b->wide && !corrected && stretch_is_wide(b->family, slice))
    return bond_resist_springs_wide(b, slice);
  if (range == RANGE_SERIES) return resist_slice(b, slice, gaps, corrected, RANGE_SERIES);
  if (range == RANGE_NEWTON) return resist_slice(b, slice, gaps, corrected, RANGE_NEWTON);
  return resist_slice(b, slice, gaps, corrected, RANGE_ANY);
}

BRECCIA_CLONES
static void resist_springs(const BondBased *b, int64_t first, int64_t last)
{
  const BondBased local = *b; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice) {
    /* Begins with the way of the last time, and ends with the first way that is good: what came before does not show in the bits. */
    StretchRange range = (StretchRange)local.range[slice], next = range;
    for (int turn = 0; turn < 3; ++turn) {
      range = next;
      next = local.surface       ? resist_way(&local, slice, true, true, range)
             : local.gaps[slice] ? resist_way(&local, slice, true, false, range)
                                 : resist_way(&local, slice, false, false, range);
      if (next == range) break;
    }
    local.range[slice] = (uint8_t)range;
  }
}

void bond_note_gaps(BondBased *b, int64_t slice)
{
  const Family *f = b->family;
  b->gaps[slice] = 0;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) b->gaps[slice] |= f->intact[slot] != UINT8_MAX;
}

void bond_resist_springs(const BondBased *b, int64_t first, int64_t last)
{
  resist_springs(b, first, last);
}

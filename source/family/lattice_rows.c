#include "family/lattice_rows.h"

#include "base/team.h"
#include "family/family.h"
#include <stdlib.h>
#include <string.h>

/* Sums are worth making where they spare many loads: a row of n neighbours costs two instead of n, and making the sums costs about as
 * much as MAKING further neighbours per place. Measured on cubes of 32 x 32 x 32 whose arrays do not fit the second cache: sums that spare 60
 * (cubic, 3.015 spacings) take a tenth off the time, two or three kinds that spare 12 to 32 each (face-centred cubic; weights that
 * fall with distance) add up to a fifth to it. */
enum { MAKING = 34 };

typedef struct Candidate {
  RowKind kind;
  int rows; /* how many there are of it around a particle */
} Candidate;

static bool same_kind(const RowKind *a, const RowKind *b)
{
  return a->neighbours == b->neighbours && !memcmp(a->weight, b->weight, sizeof a->weight);
}

static int gain(const Candidate *candidate)
{
  return candidate->rows * (candidate->kind.neighbours - 2) - MAKING;
}

/** Stable: patterns without sums first. */
static int put_last(Pattern *patterns, int count, Error *error)
{
  Pattern *sorted = memory_zeroed((size_t)count, sizeof *sorted, "bond patterns", error);
  if (!sorted) return BRECCIA_FAILURE;
  int n = 0;
  for (int with_sums = 0; with_sums < 2; ++with_sums)
    for (int k = 0; k < count; ++k)
      if ((patterns[k].kind >= 0) == with_sums) sorted[n++] = patterns[k];
  memcpy(patterns, sorted, sizeof *patterns * (size_t)count);
  free(sorted);
  return BRECCIA_OK;
}

int lattice_rows_choose(Family *family, int b, Error *error)
{
  const Lattice *lattice = &family->lattices[b];
  const int first = family->pattern_begin[b], count = family->pattern_begin[b + 1] - first;
  Candidate found[4 * ROW_KINDS];
  int candidates = 0;
  for (int pass = 0; pass < 2; ++pass) { /* first count the rows of each kind, then tell the patterns */
    for (int begin = first, end; begin < first + count; begin = end) {
      const Pattern *row = &family->patterns[begin];
      for (end = begin + 1; end < first + count && family->patterns[end].row == begin;) ++end;
      RowKind kind = {.reach = (1 - row->twice) / 2, .neighbours = 1 - row->twice};
      if (kind.reach > ROW_REACH || end - begin != kind.neighbours) continue; /* too long, or its own row */
      for (int s = 0; s < kind.neighbours; ++s) {
        kind.weight[s] = row[s].weight;
        kind.moment[s] = row[s].weight * row[s].xi[lattice->axis];
      }
      int c = 0;
      while (c < candidates && !same_kind(&found[c].kind, &kind)) ++c;
      if (!pass && c == candidates && c < 4 * ROW_KINDS) found[candidates++] = (Candidate){kind, 0};
      if (!pass && c < candidates) ++found[c].rows;
      for (int s = begin; pass && c < ROW_KINDS && c < candidates && s < end; ++s) family->patterns[s].kind = c;
    }
    if (pass) break;
    for (int a = 0; a < candidates; ++a) /* the best first; those without gain go */
      for (int c = a + 1; c < candidates; ++c)
        if (gain(&found[c]) > gain(&found[a])) {
          Candidate better = found[c];
          found[c] = found[a];
          found[a] = better;
        }
    while (candidates && gain(&found[candidates - 1]) <= 0) --candidates;
    if (candidates > ROW_KINDS) candidates = ROW_KINDS;
  }
  LatticeRows *rows = &family->rows;
  for (int c = 0; c < candidates; ++c) {
    rows->kind[b * ROW_KINDS + c] = found[c].kind;
    if (found[c].kind.reach > rows->reach) rows->reach = found[c].kind.reach;
  }
  if (candidates > rows->kinds) rows->kinds = candidates;
  return put_last(family->patterns + first, count, error);
}

/** Which lanes of a slice have a particle `along` places further in their row. */
static uint8_t present_lanes(const Particles *p, const int32_t *slices, int64_t chunks, int64_t chunk, int along)
{
  uint8_t lanes = 0;
  for (int lane = 0; lane < SLICE; ++lane) {
    int64_t at = chunk * SLICE + lane + along;
    if (at < 0 || at >= chunks * SLICE || slices[at / SLICE] < 0) continue;
    if (p->number[(int64_t)slices[at / SLICE] * SLICE + at % SLICE] >= 0) lanes |= (uint8_t)(1u << lane);
  }
  return lanes;
}

/** Counts the rows of a slice that have sums, and finds the first slot of them. */
static int64_t count_rows(const Family *family, int64_t slice, int64_t *first)
{
  int64_t slot = family->first[slice], stored = family->stored[slice], rows = 0;
  while (slot < stored && family->patterns[family_pattern(family, slice, slot)].kind < 0) ++slot;
  *first = slot;
  for (; slot < stored; ++slot)
    rows += slot == *first || family_row(family, slice, slot - 1) != family_row(family, slice, slot);
  return rows;
}

typedef struct LatticeOfFamily {
  const Family *family;
  const Lattice *lattice;
} LatticeOfFamily;

static void find_present(void *context, int64_t row)
{
  const LatticeOfFamily *of = context;
  const Lattice *lattice = of->lattice;
  const LatticeRows *rows = &of->family->rows;
  const int width = 2 * rows->reach + 1;
  int64_t cell[3];
  lattice_cell(lattice, row, 0, 0, cell);
  const bool late = lattice_row_shift(lattice, cell) > 0.25;
  for (int64_t chunk = 0; chunk < lattice->chunks; ++chunk) {
    const int32_t *row_slices = lattice->slice + row * lattice->chunks;
    int64_t slice = row_slices[chunk];
    if (slice < 0) continue;
    uint8_t *present = rows->present + slice * width;
    rows->complete[slice] = 1;
    rows->late[slice] = late;
    for (int s = 0; s < width; ++s) {
      present[s] = present_lanes(of->family->particles, row_slices, lattice->chunks, chunk, s - rows->reach);
      rows->complete[slice] &= present[s] == UINT8_MAX;
    }
  }
}

static void mark(void *context, int64_t slice)
{
  lattice_rows_mark(context, slice);
}

int lattice_rows_create(Family *family, const Body *body, Error *error)
{
  LatticeRows *rows = &family->rows;
  const Particles *p = family->particles;
  int width = 2 * rows->reach + 1;
  size_t slices = (size_t)p->slices;
  rows->present = memory_zeroed(slices * (size_t)width, 1, "lattice rows", error);
  rows->complete = memory_zeroed(slices, 1, "lattice rows", error);
  rows->late = memory_zeroed(slices, 1, "lattice rows", error);
  rows->first = memory_zeroed(slices, sizeof *rows->first, "lattice rows", error);
  rows->begin = memory_zeroed(slices + 1, sizeof *rows->begin, "lattice rows", error);
  rows->count = memory_zeroed(slices, sizeof *rows->count, "lattice rows", error);
  rows->condition = memory_zeroed(slices, 1, "lattice rows", error);
  if (!rows->present || !rows->complete || !rows->late || !rows->first || !rows->begin || !rows->count ||
      !rows->condition)
    return BRECCIA_FAILURE;
  for (int b = 0; b < body->block_count; ++b) {
    const Lattice *lattice = &body->lattices[b];
    LatticeOfFamily of = {family, lattice};
    team_each(lattice_row_count(lattice), find_present, &of);
  }
  for (int32_t slice = 0; slice < (int32_t)p->slices; ++slice) /* of particles that stand in no lattice */
    if (!body->lattices[p->block[slice]].chunks)
      rows->present[slice * width + rows->reach] = present_lanes(p, &slice, 1, 0, 0);
  for (int64_t slice = 0; slice < p->slices; ++slice)
    rows->begin[slice + 1] = rows->begin[slice] + count_rows(family, slice, &rows->first[slice]);
  rows->whole = memory_zeroed((size_t)rows->begin[p->slices], sizeof *rows->whole, "lattice rows", error);
  if (!rows->whole) return BRECCIA_FAILURE;
  team_each(p->slices, mark, family);
  return BRECCIA_OK;
}

void lattice_rows_destroy(LatticeRows *rows)
{
  free(rows->kind);
  free(rows->present);
  free(rows->complete);
  free(rows->late);
  free(rows->first);
  free(rows->begin);
  free(rows->whole);
  free(rows->count);
  free(rows->condition);
  *rows = (LatticeRows){0};
}

/** Places along its row, from where its sums are kept, of the neighbour in a slot. */
static int along_row(const Family *family, int64_t slice, int64_t slot, bool late)
{
  const int twice = family->patterns[family_pattern(family, slice, slot)].twice;
  return (twice + (twice % 2 ? late ? 1 : -1 : 0)) / 2;
}

/** @return of the slots begin .. end - 1 of a row the one that leads to where its sums are kept, if the row is whole, or -1 */
static int64_t middle_of_whole(const Family *family, int64_t slice, int64_t begin, int64_t end)
{
  const LatticeRows *rows = &family->rows;
  const int block = family->particles->block[slice];
  const bool late = rows->late[slice];
  int64_t middle = begin;
  while (middle < end && along_row(family, slice, middle, late)) ++middle;
  if (middle == end) return -1;
  const RowKind *kind = &rows->kind[block * ROW_KINDS + family->patterns[family_pattern(family, slice, begin)].kind];
  const int64_t there = family_base(family, slice, middle) / SLICE;
  const uint8_t *present = rows->present + there * (2 * rows->reach + 1) + rows->reach;
  const unsigned own = lattice_rows_lanes(rows, slice);
  const int first = lattice_row_begin(kind, rows->late[there]);
  int64_t slot = begin;
  for (int along = first; along < first + kind->neighbours; ++along) {
    bool listed = slot < end && along_row(family, slice, slot, late) == along;
    if ((own & present[along]) != (listed ? family->intact[slot] : 0u)) return -1;
    slot += listed;
  }
  return middle;
}

void lattice_rows_mark(Family *family, int64_t slice)
{
  LatticeRows *rows = &family->rows;
  if (!rows->present) return;
  int64_t entry = rows->begin[slice];
  unsigned condition = 0;
  for (int64_t slot = family->first[slice]; slot < rows->first[slice]; ++slot)
    if (family->intact[slot] != UINT8_MAX) condition |= ROWS_GAPS;
  for (int64_t begin = rows->first[slice], end; begin < family->stored[slice]; begin = end) {
    for (end = begin + 1;
         end < family->stored[slice] && family_row(family, slice, begin) == family_row(family, slice, end);)
      ++end;
    int64_t middle = middle_of_whole(family, slice, begin, end);
    if (middle < 0)
      condition |= ROWS_RAGGED | ROWS_GAPS;
    else
      rows->whole[entry++] = (uint16_t)(middle - family->first[slice]);
  }
  rows->count[slice] = (uint16_t)(entry - rows->begin[slice]);
  rows->condition[slice] = (uint8_t)condition;
}

size_t lattice_rows_bytes(const Family *family)
{
  const LatticeRows *rows = &family->rows;
  if (!rows->present) return 0;
  size_t slices = (size_t)family->particles->slices, slice = (size_t)(2 * rows->reach + 4) + sizeof *rows->first;
  return slices * (slice + sizeof *rows->begin + sizeof *rows->count) +
         (size_t)rows->begin[slices] * sizeof *rows->whole;
}

/* What the sweep over linear bonds reads (bond_springs_sweep.c): the table of lattice bonds, and which slices have gaps. */
#include "formulation/bond_based.h"

/* The table of lattice bonds. Components of reference vectors are few, and so are lengths with weights: each number stands there four times, so
 * that arithmetic on four lanes takes it from memory (lanes_repeated). Behind what is read of a length: */
enum { LENGTH_KEY = LENGTH_LIMIT + QUAD, LENGTH_SIZE = LENGTH_KEY + QUAD };

static void put(BondBased *b, int64_t at, double number)
{
  for (int k = 0; k < QUAD; ++k) b->numbers[at + k] = number;
}

static void put_length(BondBased *b, int64_t at, const Pattern *pattern)
{
  const double square = pattern->length * pattern->length;
  double scale = -pattern->weight_by_length / 2; /* series in -d, and halved because vectors are doubled */
  for (int n = 0; n < STRETCH_TERMS; ++n) put(b, at + LENGTH_PULL + QUAD * n, (scale /= square) * shortening_terms[n]);
  put(b, at + LENGTH_LIMIT, range_limit[RANGE_SERIES] * square);
  b->numbers[at + LENGTH_KEY] = pattern->length;
  b->numbers[at + LENGTH_KEY + 1] = pattern->weight;
}

int bond_springs_create(BondBased *b, Error *error)
{
  const Family *f = b->family;
  b->rows = memory_zeroed((size_t)f->pattern_count, sizeof *b->rows, "bond constants", error);
  b->numbers = places_array((int64_t)f->pattern_count * (3 * QUAD + LENGTH_SIZE), "bond constants", error);
  if (!b->rows || !b->numbers) return BRECCIA_FAILURE;
  b->resist_springs = bond_resist_springs_chosen();
  b->point_sweeps = bond_point_sweeps_chosen();
  int32_t end = 0;
  for (int p = 0; p < f->pattern_count; ++p)
    for (int k = 0; k < 3; ++k) {
      int32_t at = 0;
      while (at < end && b->numbers[at] != 2 * f->patterns[p].xi[k]) at += QUAD;
      if (at == end) put(b, at, 2 * f->patterns[p].xi[k]);
      if (at == end) end += QUAD;
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

void bond_note_gaps(BondBased *b, int64_t slice)
{
  b->gaps[slice] = stretch_has_gaps(b->family, slice);
}

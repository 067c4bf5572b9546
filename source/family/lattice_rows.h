/* Whole rows of a lattice at once.
 *
 * What is summed over a family is often linear in a number q of the neighbour: sum w q and sum w xi q. The part of such a sum that
 * comes from one lattice row is then made of two sums along that row,
 *   sum w q  and  sum w s q   (s: distance along the row from its middle),
 * which all particles around share. With a horizon of 3.015 spacings 20 of the 28 other rows that a particle's bonds lead to are alike: five
 * neighbours with equal weights. Sums along them are made once per place; a particle reads 2 numbers instead of 5.
 *
 * Rows are of one kind if their weights are alike; kinds with too few rows or neighbours have no sums (kind -1).
 * A row whose particles stand half a cell further along than those of a particle's own row has no neighbour in its middle: as many on
 * either side. Its sums are kept where the particle's own chunk of the row would be, so that they too are read in slices. Which of the
 * two neighbours nearest to the middle is at that place depends on which row is the shifted one; `late` tells.
 * The row of a slice is whole if each of its particles has an intact bond to every particle of the row within reach. Bonds of
 * other rows, and bonds between lattices, are summed slot by slot. */
#ifndef BRECCIA_FAMILY_LATTICE_ROWS_H
#define BRECCIA_FAMILY_LATTICE_ROWS_H

#include "body/body.h"

enum { ROW_KINDS = 4, ROW_REACH = SLICE };

typedef struct RowKind {
  int reach;                        /* neighbours at most so many places along the row */
  int neighbours;                   /* 2 reach + 1, or 2 reach where the row is shifted */
  double weight[2 * ROW_REACH + 1]; /* [neighbours] of the bonds to them, in order */
  double moment[2 * ROW_REACH + 1]; /* weight times distance along the row from the particle */
} RowKind;

typedef struct LatticeRows {
  int kinds, reach;  /* how many kinds have sums, the longest's reach */
  RowKind *kind;     /* [lattices][ROW_KINDS] */
  uint8_t *present;  /* [slices][2 reach + 1] lanes for which a particle is so many places further in the same row */
  uint8_t *complete; /* [slices] 1: there is one for all lanes and distances */
  uint8_t *late;     /* [slices] 1: in a row shifted by half a cell */
  int64_t *first;    /* [slices] first slot of a row that has sums; they come after all others */
  int64_t *begin;    /* [slices + 1] first of the slice's entries in `whole` */
  uint16_t *
      whole; /* entries begin[s] .. begin[s] + count[s] - 1: the whole rows of slice s, each by its middle slot, counted from
                         the first slot of the slice */
  uint16_t *count;    /* [slices] */
  uint8_t *condition; /* [slices] RowCondition bits */
} LatticeRows;

typedef enum RowCondition {
  ROWS_RAGGED = 1, /* a row that has sums is not whole */
  ROWS_GAPS = 2,   /* a bond of a slot that belongs to no whole row is missing */
} RowCondition;

/** Along which place of a row the neighbours of one kind begin, counted from where the sums are kept. */
LANES_INLINE int lattice_row_begin(const RowKind *kind, bool late)
{
  return kind->neighbours % 2 || late ? -kind->reach : 1 - kind->reach;
}

LANES_INLINE void lattice_row_sums_of(const RowKind *kind, int begin, int neighbours, const uint8_t *present,
                                      const double *q, double *sum, double *moment)
{
  for (int half = 0; half < HALVES; ++half) {
    Lanes s = {0}, m = {0};
    for (int n = 0; n < neighbours; ++n) {
      const int along = begin + n;
      const double *there = q + LANES * half + along;
      const Lanes value = present ? lanes_load_some(there, present[along], half) : lanes_load(there);
      if (sum) s += value * lanes_set(kind->weight[n]);
      if (moment) m += value * lanes_set(kind->moment[n]);
    }
    if (sum) lanes_store(sum + LANES * half, s);
    if (moment) lanes_store(moment + LANES * half, m);
  }
}

/** Sums along the rows for all places of one slice, as far as particles are present there.
 *  @param[in] q      a number per place, with spare entries (places_array)
 *  @param[out] sum, moment  [8] sum w q and sum w s q of the slice's places; either may be NULL */
LANES_INLINE void lattice_row_sums(const LatticeRows *rows, const RowKind *kind, int64_t slice, const double *q,
                                   double *sum, double *moment)
{
  const uint8_t *present = rows->present + slice * (2 * rows->reach + 1) + rows->reach;
  const int begin = lattice_row_begin(kind, rows->late[slice]);
  q += slice * SLICE;
  if (!rows->complete[slice])
    lattice_row_sums_of(kind, begin, kind->neighbours, present, q, sum, moment);
  else if (kind->neighbours ==
           5) /* as with the usual horizon of 3.015 spacings; loops of known length take a third less time */
    lattice_row_sums_of(kind, -2, 5, NULL, q, sum, moment);
  else if (kind->neighbours == 6) /* of face-centred cubic lattices, this and the next */
    lattice_row_sums_of(kind, begin, 6, NULL, q, sum, moment);
  else if (kind->neighbours == 4)
    lattice_row_sums_of(kind, begin, 4, NULL, q, sum, moment);
  else
    lattice_row_sums_of(kind, begin, kind->neighbours, NULL, q, sum, moment);
}

/** Lanes of a slice that hold a particle, a bit each. */
static inline unsigned lattice_rows_lanes(const LatticeRows *rows, int64_t slice)
{
  return rows->present[slice * (2 * rows->reach + 1) + rows->reach];
}

typedef struct Family Family;

/** Chooses the kinds of rows that get sums in the lattice of block b, and puts their patterns last. */
int lattice_rows_choose(Family *family, int b, Error *error);

/** Finds which particles are present along rows and which rows are whole; kinds were chosen and slots built before. */
int lattice_rows_create(Family *family, const Body *body, Error *error);
void lattice_rows_destroy(LatticeRows *rows);

/** Finds out again which rows of a slice are whole; to be called when its intact bits have changed. */
void lattice_rows_mark(Family *family, int64_t slice);

size_t lattice_rows_bytes(const Family *family);

#endif

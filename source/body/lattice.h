/* Regular arrangements of particles.
 *
 * A lattice is three primitive vectors, the first along x, the second in the plane x-y: a particle stands at every sum of whole multiples
 * of them. Particles along the first vector are a row. Cells are counted from the low corner of the box that the lattice fills, row by
 * row, so that a row whose particles stand half a spacing further along begins like the others: the particle of cell (i, j, k) is the
 * one in the i-th brick of its row. Always true: two particles of one vector apart stay so in every row, so that a bond of a
 * lattice is a vector and not a pair. */
#ifndef BRECCIA_BODY_LATTICE_H
#define BRECCIA_BODY_LATTICE_H

#include "body/shape.h"

typedef struct LatticeType {
  const char *name;
  int dimensions;
  int turns;           /* rows may run along so many of the first axes: turned so the lattice looks the same */
  double vector[3][3]; /* in spacings, nothing above the diagonal */
} LatticeType;

/** A lattice that fills one block. Rows run along `axis`. Particles from a file have none: no cells, no chunks; `spacing` is their
 *  usual distance then. */
typedef struct Lattice {
  const LatticeType *type;
  double spacing; /* of nearest neighbours */
  UnitCell unit;
  double plane[3];  /* distance of the planes of particles across x, y, z */
  double origin[3]; /* particle of cell (0, 0, 0) */
  int64_t cells[3];
  bool repeats
      [3]; /* along each axis: what lies outside the shape is the lattice inside once more, and not its mirror image */
  int64_t margin[3][2]; /* how many of them lie outside the shape along each axis: before the others, behind them */
  int axis, across[2];  /* axis of the rows, and the two others in ascending order */
  double shift
      [3]; /* in cells: along `axis` for each row along across[0], across[1]; along across[0] for each along across[1] */
  int64_t chunks;   /* slices that a full row would have */
  int32_t *slice;   /* [cells[across[1]]][cells[across[0]]][chunks] slice there, or -1 */
  double volume;    /* of a particle */
  double filled[3]; /* lengths of the box over those that whole rows have, 1 where they fit: factors of the volume */
  int dimensions;
} Lattice;

/** Names of the lattices one by one, NULL after the last. */
const char *lattice_word(int k);
/** Returns the lattice type of an index of lattice_word. */
const LatticeType *lattice_at(int k);
/** @return NULL if there is none of that name */
const LatticeType *lattice_find(const char *name);

/** True if the vectors are along x, y and z. */
bool lattice_is_grid(const LatticeType *type);

/** Sizes of a lattice of that type; no cells yet. */
void lattice_measure(Lattice *lattice, const LatticeType *type, double spacing);

/** Chooses along which axis rows run, for cells that are counted: the longest of those that the type allows. */
void lattice_lay_rows(Lattice *lattice);

/** How many rows there are. */
int64_t lattice_row_count(const Lattice *lattice);

/** Lattice cell of a place: a row, one of its chunks, a lane. */
void lattice_cell(const Lattice *lattice, int64_t row, int64_t chunk, int lane, int64_t cell[3]);

/** Row and place in it of a cell. @return the row */
int64_t lattice_row(const Lattice *lattice, const int64_t cell[3]);

/** Where the particle of a cell stands. */
void lattice_point(const Lattice *lattice, const int64_t cell[3], double point[3]);

/** By what part of a cell the particles of a cell's row stand further along than those of the first row, 0 to less than 1. */
double lattice_row_shift(const Lattice *lattice, const int64_t cell[3]);

/** The cell that so many primitive vectors (along `axis`, across[0], across[1], at these places of `offset`) lead to; it may lie beyond the
 *  ends of its row. @return false if the lattice has no such row */
bool lattice_neighbour(const Lattice *lattice, const int64_t cell[3], const int offset[3], int64_t other[3]);

/** That many primitive vectors, in spacings. */
void lattice_vector(const Lattice *lattice, const int offset[3], double way[3]);

/** Distance, in spacings, from a particle to the next one straight along x (axis 0) or y (1). */
double lattice_period(const LatticeType *type, int axis);

/** Corners of the part of the plane x-y that is nearer to a particle than to its neighbours in that plane, in spacings, anticlockwise.
 *  @param[out] corners  room for 6
 *  @return how many */
int lattice_cell_corners(const LatticeType *type, double corners[6][2]);

#endif

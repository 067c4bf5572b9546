/* Vectors over the places of a body: numbers in rows, as many rows as their space describes.
 *
 * A space holds what all its vectors share: the rows, the number of places, and the tiles that threads work on. The
 * motion of a body has three rows of displacements and, with rotations, one more in the plane and three more in
 * space. A field with other rows takes a space of its own over the same tiles. Always true: unused places hold 0;
 * sums are formed tile by tile and added in the order of tiles, so that they have the same bits for any number of
 * threads; the arrays of rows are places_array's.
 *
 * `const Vector *` leaves the descriptor as it is; the numbers of a vector that a function writes are @param[out] or
 * [in,out]. Operations run on the team in use and are called by one thread. */
#ifndef BRECCIA_BODY_VECTOR_H
#define BRECCIA_BODY_VECTOR_H

#include "base/error.h"
#include "base/lanes.h"
#include <stdbool.h>
#include <stddef.h>

/* Bounds: rows of a vector, for small dense blocks of one particle; sums that one pass forms. */
enum { MAX_ROWS = 6, MAX_SUMS = 4 };

typedef enum VectorRowKind { ROW_DISPLACEMENT, ROW_ROTATION } VectorRowKind;

typedef struct VectorRow {
  VectorRowKind kind;
  int axis; /* along or about which it counts, 0 to 2 */
} VectorRow;

/** Slices first .. last - 1, of one region and material, at most BATCH places. */
typedef struct Batch {
  int64_t first, last;
} Batch;

typedef struct VectorSpace {
  int rows;
  int rotation; /* first row of rotations; `rows` where there are none */
  VectorRow row[MAX_ROWS];
  int64_t places;
  const Batch *tiles; /* [tile_count] disjoint, all slices; borrowed from the domain */
  int64_t tile_count;
  double *sums; /* [tile_count * MAX_SUMS] of the pass under way; borrowed */
} VectorSpace;

typedef struct Vector {
  const VectorSpace *space;
  double *row[MAX_ROWS]; /* [space->rows][places]; NULL beyond, and before vector_create */
} Vector;

/** Creates a vector of zeros. `vector` is zero; destroy it in any case. @return false without memory */
bool vector_create(Vector *vector, const VectorSpace *space, const char *label, Error *error);
/** Creates a vector of zeros whose memory is taken where something is written. */
bool vector_reserve(Vector *vector, const VectorSpace *space, const char *label, Error *error);
void vector_destroy(Vector *vector);
/** Returns the bytes of one vector of a space. */
size_t vector_bytes(const VectorSpace *space);

/** Returns true if a vector has been created. */
static inline bool vector_exists(const Vector *vector)
{
  return vector->row[0] != NULL;
}

/* ---- passes over all places ---- */

/** Work of a pass on the places first .. last - 1 of a tile, whole slices. */
typedef void (*TileWork)(void *context, int64_t first, int64_t last);
/** Sums of a pass over the places of a tile. @param[out] sums  0 before */
typedef void (*TileSums)(void *context, int64_t first, int64_t last, double *sums);

/** Calls `work` for all tiles. */
void vector_each_tile(const VectorSpace *space, TileWork work, void *context);
/** Adds up `count` sums over all tiles, in their order. @param[out] sums  [count], at most MAX_SUMS */
void vector_sum_tiles(const VectorSpace *space, TileSums part, void *context, int count, double *sums);
/** Returns the largest value over all tiles, at least 0; one that is no number counts as none. */
double vector_largest_of_tiles(const VectorSpace *space, TileSums part, void *context);

/* ---- elementwise ---- */

void vector_clear(const Vector *vector);
void vector_copy(const Vector *to, const Vector *from);
/** a = own a + factor b; where `own` is 0 nothing that stood in a is left. */
void vector_combine(double own, const Vector *a, double factor, const Vector *b);
/** Three terms of a sum: each a factor and a vector. */
typedef struct VectorTerms {
  double factor[3];
  const Vector *of[3];
} VectorTerms;
/** a = sum of three terms */
void vector_sum_terms(const Vector *a, const VectorTerms *terms);
/** a = factor a */
void vector_scale(const Vector *a, double factor);
/** a = weight b. @param[in] weight  [places] */
void vector_weigh(const Vector *a, const double *weight, const Vector *b);
/** a += weight b */
void vector_add_weighted(const Vector *a, const double *weight, const Vector *b);
/** a = weight (b + c) */
void vector_weigh_sum(const Vector *a, const double *weight, const Vector *b, const Vector *c);
/** a = weight b c, row by row */
void vector_weigh_product(const Vector *a, const double *weight, const Vector *b, const Vector *c);

/* ---- sums and extremes ---- */

/** Sum of a b. @param[in] turning  factor on the part of rotations */
double vector_inner(const Vector *a, const Vector *b, double turning);
/** Sum of weight (a + b) c. @param[in] b  NULL: 0 */
double vector_inner_weighted(const double *weight, const Vector *a, const Vector *b, const Vector *c);
/** Sum of weight mass a b. @param[in] mass  a factor of each row, as inertia */
double vector_inner_mass(const double *weight, const Vector *mass, const Vector *a, const Vector *b);
/** Largest size of a number in the rows of displacements. */
double vector_largest(const Vector *vector);
/** Largest size of a number in rows of rotations; 0 without them. */
double vector_largest_rotation(const Vector *vector);
/** Returns true if all numbers are 0. */
bool vector_is_zero(const Vector *vector);
/** The most by which displacements differ between particles: the root of the sum of squares over the axes.
 *  @param[in] number  [places] -1 in unused places */
double vector_spread(const Vector *vector, const int32_t *number);

#endif

/* Hybrid bonds of Hooke's law inside simple cubic lattices, whole rows of bonds at once, for each kind of vectors (base/lane_kinds.h).
 *
 * There the fit of a bond comes down to sums and differences of its members with one factor for each (docs/theory.md 5.2). Of a bond along axis k that
 * is, along the others, what members differ on both sides of the bond (horizon 1.5 spacings), or of both ends and what stands across them (2.015); of one
 * across a square, of its other two corners, what stands before and behind them and, at 2.015, of their neighbours; of one through a cube, of the twenty particles
 * around. What points exert goes back the same way.
 *
 * A stripe of slices is gone through in columns of some rows and chunks, layer by layer. A row of a column is cut into eight pieces of one length, and vector m
 * has number m of each of them: so neighbours along a row stand in whole vectors, too, and none is put together of two. Of each place there are
 * the displacement and the force, side by side, and nothing else, so that all that the bonds of a row need lies in the first-level cache: sums
 * that bonds could share would save few operations and take three times as long to fetch from the second.
 * Bonds that lack a member of those have a weight of 0 here and are walked (hybrid_hooke.c). */
#include "formulation/hybrid_slice.h"

#include <string.h>

enum {
  REACH = 2,                                  /* particles that bonds lead beyond a row's ends, at most */
  CHUNKS = 8,                                 /* of a row at once */
  PLACE = 6 * SLICE,                          /* of a vector of places: three of displacement, three of force */
  ROW = PLACE * (CHUNKS + 2 * REACH) + SLICE, /* whole cache lines, but so many that rows meet in no set */
  DEEP = 20,                                  /* rows at once */
  RING = 4,                                   /* layers that are held */
  NO_BONDS = HYBRID_ODD + 1
};

/** What a column of rows has at hand. Rows begin two before its own, and vectors two before the first. */
typedef struct Column {
  double row[RING][DEEP + 2 * REACH][ROW];
  double weight[CHUNKS][HYBRID_KINDS][SLICE];
  /* Numbers of a row one after the other, from a chunk before those of the column. */
  double line[3][SLICE * (CHUNKS + 2)];
  int kind[CHUNKS]; /* of slices whose weights these are, or NO_BONDS; -1: nobody's */
  bool some;        /* of these weights some are not 0 */
} Column;

typedef struct PlanesWork {
  const Hybrid *h;
  double *const *displacement;
  const Lattice *lattice;
  const HybridStripe *stripe;
  int axes[3]; /* of the body: that of rows, that of a layer's rows, that of layers */
  int kinds, reach;
  double shear, share; /* shear modulus over the spacing; Lame's over twice the shear modulus */
  double unit;         /* of displacements here, over the spacing */
  int64_t rows, layers;
  int64_t row, chunk;           /* where the column begins */
  int deep, chunks;             /* chunks: also vectors of a row */
  int32_t piece[SLICE];         /* where the pieces of a row begin */
  int32_t back[SLICE * CHUNKS]; /* forces of the places of a row, from its first vector */
  Column *column;
} PlanesWork;

/** Row r of a layer, from its first vector. */
LANES_INLINE double *row_at(const PlanesWork *w, int r, int64_t layer)
{
  return w->column->row[layer & (RING - 1)][r + REACH] + REACH * PLACE;
}

/** Slice of a chunk of the column, or -1. */
LANES_INLINE int64_t slice_at(const PlanesWork *w, int64_t row, int64_t layer, int chunk)
{
  const int64_t at = w->chunk + chunk;
  if (row < 0 || row >= w->rows || layer < 0 || layer >= w->layers || at < 0 || at >= w->lattice->chunks) return -1;
  return w->lattice->slice[(layer * w->rows + row) * w->lattice->chunks + at];
}

/** Displacements of a row in its own order; none where no particle is. */
LANES_INLINE void take_line(const PlanesWork *w, int64_t row, int64_t layer)
{
  const Particles *p = w->h->particles;
  double *const *displacement = w->displacement;
  const Lanes unit = lanes_set(w->unit / w->lattice->spacing), none = lanes_set(0);
  for (int chunk = -1; chunk <= w->chunks; ++chunk) {
    const int64_t slice = slice_at(w, row, layer, chunk), place = slice * SLICE;
    const int x = SLICE * (chunk + 1), kind = slice < 0 ? HYBRID_ODD : w->h->planar_kind[slice];
    const bool full = kind != HYBRID_ODD && w->h->planes[kind].full;
    for (int lane = 0; lane < SLICE; lane += LANES) {
      LaneMask there = {0};
      if (slice >= 0 && !full) there = (LaneMask)(lanes_load(p->volume + place + lane) > none);
      for (int c = 0; c < 3; ++c) {
        const Lanes u = slice < 0 ? none : unit * lanes_load(displacement[w->axes[c]] + place + lane);
        lanes_store(w->column->line[c] + x + lane, full ? u : lanes_where(there, u));
      }
    }
  }
}

/** Displacements of a layer. */
static void take_layer(const PlanesWork *w, int64_t layer)
{
  for (int r = -w->reach; r < w->deep + w->reach; ++r) {
    take_line(w, w->row + r, layer);
    double *to = row_at(w, r, layer);
    for (int m = -w->reach; m < w->chunks + w->reach; ++m)
      for (int lane = 0; lane < SLICE; lane += LANES)
        for (int c = 0; c < 3; ++c)
          lanes_store(to + m * PLACE + SLICE * c + lane, lanes_gather(w->column->line[c] + SLICE + m, w->piece + lane));
  }
}

/** F S of G, both column by column. */
LANES_INLINE void find_stress(const Lanes g[3][3], Lanes share, bool finite, Lanes p[3][3])
{
  Lanes s[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      s[a][b] = g[a][b] + g[b][a];
      for (int c = 0; c < 3 && finite; ++c) s[a][b] += g[a][c] * g[b][c];
      s[b][a] = s[a][b];
    }
  const Lanes trace = (s[0][0] + s[1][1]) + s[2][2];
  for (int a = 0; a < 3; ++a) s[a][a] += share * trace;
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) {
      p[a][c] = s[a][c];
      for (int b = 0; b < 3 && finite; ++b) p[a][c] += g[b][c] * s[b][a];
    }
}

/** A vector of places whose bonds are gone through, in its layer and in the layers around: from the one below to two above. */
typedef struct Around {
  double *at[RING];
  const double *weight; /* of the first kind */
  Lanes share;
  bool finite;
} Around;

/** Displacement of the places (dx, dy, dz) from there, a component. */
LANES_INLINE Lanes moved(const Around *a, int c, int dx, int dy, int dz)
{
  return lanes_load(a->at[1 + dz] + dy * ROW + dx * PLACE + SLICE * c);
}

/** Adds to their force. */
LANES_INLINE void give(const Around *a, int c, int dx, int dy, int dz, Lanes value)
{
  double *to = a->at[1 + dz] + dy * ROW + dx * PLACE + SLICE * (3 + c);
  lanes_store(to, lanes_load(to) + value);
}

/** Adds a product. */
LANES_INLINE void give_times(const Around *a, int c, int dx, int dy, int dz, Lanes factor, Lanes value)
{
  double *to = a->at[1 + dz] + dy * ROW + dx * PLACE + SLICE * (3 + c);
  lanes_store(to, lanes_load(to) + factor * value);
}

LANES_INLINE Lanes weight_of(const Around *a, int kind)
{
  return lanes_load(a->weight + SLICE * kind);
}

/* Displacements are in spacings times these, the numbers that fits of bonds along axes have, so that sums are G without a product. */
enum { UNIT_NEAR = 4, UNIT_FAR = 12 };

/** Bonds along axis k, horizon 1.5 spacings. */
LANES_INLINE void along(const Around *a, int k)
{
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const int kx = k == 0, ky = k == 1, kz = k == 2, ix = i == 0, iy = i == 1, iz = i == 2, jx = j == 0, jy = j == 1,
            jz = j == 2;
  const Lanes unit = lanes_set(UNIT_NEAR);
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    g[k][c] = lanes_product(unit, moved(a, c, kx, ky, kz) - moved(a, c, 0, 0, 0));
    g[i][c] = (moved(a, c, ix, iy, iz) - moved(a, c, -ix, -iy, -iz)) +
              (moved(a, c, kx + ix, ky + iy, kz + iz) - moved(a, c, kx - ix, ky - iy, kz - iz));
    g[j][c] = (moved(a, c, jx, jy, jz) - moved(a, c, -jx, -jy, -jz)) +
              (moved(a, c, kx + jx, ky + jy, kz + jz) - moved(a, c, kx - jx, ky - jy, kz - jz));
  }
  find_stress(g, a->share, a->finite, p);
  const Lanes weight = weight_of(a, k), own = weight * unit;
  for (int c = 0; c < 3; ++c) {
    give_times(a, c, 0, 0, 0, -own, p[k][c]);
    give_times(a, c, kx, ky, kz, own, p[k][c]);
    give_times(a, c, ix, iy, iz, weight, p[i][c]);
    give_times(a, c, -ix, -iy, -iz, -weight, p[i][c]);
    give_times(a, c, kx + ix, ky + iy, kz + iz, weight, p[i][c]);
    give_times(a, c, kx - ix, ky - iy, kz - iz, -weight, p[i][c]);
    give_times(a, c, jx, jy, jz, weight, p[j][c]);
    give_times(a, c, -jx, -jy, -jz, -weight, p[j][c]);
    give_times(a, c, kx + jx, ky + jy, kz + jz, weight, p[j][c]);
    give_times(a, c, kx - jx, ky - jy, kz - jz, -weight, p[j][c]);
  }
}

/** Bonds that lead one spacing along axis `to` and `sign` spacings along axis `by` before it. */
LANES_INLINE void across(const Around *a, int kind, int by, int to, int sign, bool far)
{
  const int m = 3 - by - to, ax = by == 0 ? sign : 0, ay = by == 1 ? sign : 0, ty = to == 1, tz = to == 2, mx = m == 0,
            my = m == 1, mz = m == 2;
  const double unit = far ? UNIT_FAR : UNIT_NEAR;
  const Lanes half = lanes_set(unit / 2), turned = lanes_set(sign * unit / 2), two = lanes_set(2);
  const Lanes sideways = lanes_set(unit / (far ? 22 : 6)), over = lanes_set(unit / (far ? 8 : 4));
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    const Lanes own = moved(a, c, ax, ay + ty, tz) - moved(a, c, 0, 0, 0);
    const Lanes e = moved(a, c, ax + mx, ay + my, mz) - moved(a, c, -mx, ty - my, tz - mz),
                d = moved(a, c, ax - mx, ay - my, -mz) - moved(a, c, mx, ty + my, tz + mz);
    Lanes side = (moved(a, c, ax, ay, 0) - moved(a, c, 0, ty, tz)) + (e + d);
    g[m][c] = e - d;
    if (far) {
      side += two * ((moved(a, c, 2 * ax, 2 * ay, 0) - moved(a, c, 0, 2 * ty, 2 * tz)) +
                     (moved(a, c, ax, ay - ty, -tz) - moved(a, c, -ax, ty - ay, tz)));
      g[m][c] += (moved(a, c, mx, my, mz) - moved(a, c, -mx, -my, -mz)) +
                 (moved(a, c, ax + mx, ay + ty + my, tz + mz) - moved(a, c, ax - mx, ay + ty - my, tz - mz));
      g[m][c] = lanes_product(over, g[m][c]);
    }
    side = lanes_product(sideways, side);
    g[by][c] = (sign > 0 ? side : -side) + turned * own;
    g[to][c] = half * own - side;
  }
  find_stress(g, a->share, a->finite, p);
  const Lanes weight = weight_of(a, kind), along = weight * half, beside = weight * sideways;
  for (int c = 0; c < 3; ++c) {
    const Lanes end = sign > 0 ? p[to][c] + p[by][c] : p[to][c] - p[by][c];
    const Lanes side = lanes_product(beside, sign > 0 ? p[by][c] - p[to][c] : -(p[by][c] + p[to][c]));
    const Lanes up = far ? lanes_product(weight * over, p[m][c]) : lanes_product(weight, p[m][c]);
    const Lanes e = side + up, d = side - up;
    give_times(a, c, 0, 0, 0, -along, end);
    give_times(a, c, ax, ay + ty, tz, along, end);
    give(a, c, ax, ay, 0, side);
    give(a, c, 0, ty, tz, -side);
    give(a, c, ax + mx, ay + my, mz, e);
    give(a, c, -mx, ty - my, tz - mz, -e);
    give(a, c, ax - mx, ay - my, -mz, d);
    give(a, c, mx, ty + my, tz + mz, -d);
    if (!far) continue;
    give(a, c, mx, my, mz, up);
    give(a, c, -mx, -my, -mz, -up);
    give(a, c, ax + mx, ay + ty + my, tz + mz, up);
    give(a, c, ax - mx, ay + ty - my, tz - mz, -up);
    give_times(a, c, 2 * ax, 2 * ay, 0, two, side);
    give_times(a, c, 0, 2 * ty, 2 * tz, -two, side);
    give_times(a, c, ax, ay - ty, -tz, two, side);
    give_times(a, c, -ax, ty - ay, tz, -two, side);
  }
}

/** What differs across axis k at the places (dx, dy, dz), over the eight around in its plane: along the next axis and along that after it. */
LANES_INLINE void differ(const Around *a, int c, int k, int dx, int dy, int dz, Lanes *i, Lanes *j)
{
  const int p = (k + 1) % 3, q = (k + 2) % 3, ix = p == 0, iy = p == 1, iz = p == 2, jx = q == 0, jy = q == 1,
            jz = q == 2;
  const Lanes e = moved(a, c, dx + ix + jx, dy + iy + jy, dz + iz + jz) -
                  moved(a, c, dx - ix - jx, dy - iy - jy, dz - iz - jz),
              d = moved(a, c, dx + ix - jx, dy + iy - jy, dz + iz - jz) -
                  moved(a, c, dx - ix + jx, dy - iy + jy, dz - iz + jz);
  *i = (e + d) + (moved(a, c, dx + ix, dy + iy, dz + iz) - moved(a, c, dx - ix, dy - iy, dz - iz));
  *j = (e - d) + (moved(a, c, dx + jx, dy + jy, dz + jz) - moved(a, c, dx - jx, dy - jy, dz - jz));
}

/** Gives these eight what acts on such differences. */
LANES_INLINE void give_differing(const Around *a, int c, int k, int dx, int dy, int dz, Lanes i, Lanes j)
{
  const int p = (k + 1) % 3, q = (k + 2) % 3, ix = p == 0, iy = p == 1, iz = p == 2, jx = q == 0, jy = q == 1,
            jz = q == 2;
  const Lanes e = i + j, d = i - j;
  give(a, c, dx + ix + jx, dy + iy + jy, dz + iz + jz, e);
  give(a, c, dx - ix - jx, dy - iy - jy, dz - iz - jz, -e);
  give(a, c, dx + ix - jx, dy + iy - jy, dz + iz - jz, d);
  give(a, c, dx - ix + jx, dy - iy + jy, dz - iz + jz, -d);
  give(a, c, dx + ix, dy + iy, dz + iz, i);
  give(a, c, dx - ix, dy - iy, dz - iz, -i);
  give(a, c, dx + jx, dy + jy, dz + jz, j);
  give(a, c, dx - jx, dy - jy, dz - jz, -j);
}

/** Bonds along axis k, horizon 2.015 spacings, one spacing long or two. */
LANES_INLINE void along_far(const Around *a, int k, bool twice)
{
  const int i = (k + 1) % 3, j = (k + 2) % 3, kx = k == 0, ky = k == 1, kz = k == 2, length = twice ? 2 : 1;
  const Lanes unit = lanes_set((double)UNIT_FAR / length), two = lanes_set(2);
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    Lanes own[2], other[2];
    g[k][c] = lanes_product(unit, moved(a, c, length * kx, length * ky, length * kz) - moved(a, c, 0, 0, 0));
    differ(a, c, k, kx, ky, kz, &other[0], &other[1]);
    if (!twice) differ(a, c, k, 0, 0, 0, &own[0], &own[1]);
    g[i][c] = twice ? two * other[0] : own[0] + other[0];
    g[j][c] = twice ? two * other[1] : own[1] + other[1];
  }
  find_stress(g, a->share, a->finite, p);
  const Lanes weight = weight_of(a, twice ? TWICE + k : k), along = weight * unit,
              beside = twice ? weight * two : weight;
  for (int c = 0; c < 3; ++c) {
    const Lanes of_i = lanes_product(beside, p[i][c]), of_j = lanes_product(beside, p[j][c]);
    give_times(a, c, 0, 0, 0, -along, p[k][c]);
    give_times(a, c, length * kx, length * ky, length * kz, along, p[k][c]);
    if (!twice) give_differing(a, c, k, 0, 0, 0, of_i, of_j);
    give_differing(a, c, k, kx, ky, kz, of_i, of_j);
  }
}

/** Bonds through cubes, which lead to (sx, sy, 1). */
LANES_INLINE void through(const Around *a, int kind, int sx, int sy)
{
  const Lanes unit = lanes_set(UNIT_FAR), tenth = lanes_set(UNIT_FAR / 10.0), fifth = lanes_set(UNIT_FAR / 5.0),
              third = lanes_set(1.0 / 3);
  const double sign[3] = {sx, sy, 1};
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    const Lanes own = moved(a, c, sx, sy, 1) - moved(a, c, 0, 0, 0);
    g[0][c] = lanes_product(tenth, moved(a, c, sx, 0, 0) - moved(a, c, 0, sy, 1));
    g[1][c] = lanes_product(tenth, moved(a, c, 0, sy, 0) - moved(a, c, sx, 0, 1));
    g[2][c] = lanes_product(tenth, moved(a, c, 0, 0, 1) - moved(a, c, sx, sy, 0));
    g[0][c] += fifth * (moved(a, c, 2 * sx, 0, 0) - moved(a, c, -sx, sy, 1));
    g[1][c] += fifth * (moved(a, c, 0, 2 * sy, 0) - moved(a, c, sx, -sy, 1));
    g[2][c] += fifth * (moved(a, c, 0, 0, 2) - moved(a, c, sx, sy, -1));
    const Lanes rest = lanes_product(third, unit * own - ((g[0][c] + g[1][c]) + g[2][c]));
    for (int k = 0; k < 3; ++k) g[k][c] = sign[k] > 0 ? g[k][c] + rest : -(g[k][c] + rest);
  }
  find_stress(g, a->share, a->finite, p);
  const Lanes weight = weight_of(a, kind), along = weight * lanes_set(UNIT_FAR / 3.0), one = weight * tenth,
              other = weight * fifth;
  for (int c = 0; c < 3; ++c) {
    Lanes q[3];
    for (int k = 0; k < 3; ++k) q[k] = sign[k] > 0 ? p[k][c] : -p[k][c];
    const Lanes sum = (q[0] + q[1]) + q[2];
    for (int k = 0; k < 3; ++k) q[k] -= third * sum;
    give_times(a, c, 0, 0, 0, -along, sum);
    give_times(a, c, sx, sy, 1, along, sum);
    give_times(a, c, sx, 0, 0, one, q[0]);
    give_times(a, c, 0, sy, 1, -one, q[0]);
    give_times(a, c, 2 * sx, 0, 0, other, q[0]);
    give_times(a, c, -sx, sy, 1, -other, q[0]);
    give_times(a, c, 0, sy, 0, one, q[1]);
    give_times(a, c, sx, 0, 1, -one, q[1]);
    give_times(a, c, 0, 2 * sy, 0, other, q[1]);
    give_times(a, c, sx, -sy, 1, -other, q[1]);
    give_times(a, c, 0, 0, 1, one, q[2]);
    give_times(a, c, sx, sy, 0, -one, q[2]);
    give_times(a, c, 0, 0, 2, other, q[2]);
    give_times(a, c, sx, sy, -1, -other, q[2]);
  }
}

LANES_INLINE void all_across(const Around *a, bool far)
{
  across(a, ACROSS, 0, 1, 1, far);
  across(a, ACROSS + 1, 0, 1, -1, far);
  across(a, ACROSS + 2, 0, 2, 1, far);
  across(a, ACROSS + 3, 0, 2, -1, far);
  across(a, ACROSS + 4, 1, 2, 1, far);
  across(a, ACROSS + 5, 1, 2, -1, far);
}

/* Some kinds at once: more instructions than the processor keeps decoded take longer. */
enum { ALL_NEAR, FAR_ALONG, FAR_ACROSS, FAR_THROUGH };

/** What bonds of some kinds exert, of the places of a row. */
LANES_INLINE void go_through_row(const PlanesWork *w, int r, int64_t layer, int which, bool finite)
{
  Around a = {.share = lanes_set(w->share), .finite = finite};
  for (int m = 0; m < w->chunks; ++m)
    for (int lane = 0; lane < SLICE; lane += LANES) {
      for (int z = 0; z < RING; ++z) a.at[z] = row_at(w, r, layer + z - 1) + m * PLACE + lane;
      a.weight = w->column->weight[m][0] + lane;
      if (which == ALL_NEAR) {
        along(&a, 0);
        along(&a, 1);
        along(&a, 2);
        all_across(&a, false);
      }
      if (which == FAR_ALONG) {
        along_far(&a, 0, false);
        along_far(&a, 1, false);
        along_far(&a, 2, false);
        along_far(&a, 0, true);
        along_far(&a, 1, true);
        along_far(&a, 2, true);
      }
      if (which == FAR_ACROSS) all_across(&a, true);
      if (which == FAR_THROUGH) {
        through(&a, THROUGH, 1, 1);
        through(&a, THROUGH + 1, -1, 1);
        through(&a, THROUGH + 2, 1, -1);
        through(&a, THROUGH + 3, -1, -1);
      }
    }
}

/* Each way through a row is compiled on its own. */
#define WAY(name, which, finite)                                                                                       \
  static __attribute__((noinline)) void name(const PlanesWork *w, int r, int64_t layer)                                \
  {                                                                                                                    \
    go_through_row(w, r, layer, which, finite);                                                                        \
  }
WAY(near_small, ALL_NEAR, false)
WAY(near_finite, ALL_NEAR, true)
WAY(along_small, FAR_ALONG, false)
WAY(along_finite, FAR_ALONG, true)
WAY(across_small, FAR_ACROSS, false)
WAY(across_finite, FAR_ACROSS, true)
WAY(through_small, FAR_THROUGH, false)
WAY(through_finite, FAR_THROUGH, true)
#undef WAY

/** Adds what the vectors beyond the ends of a row have received to the places where they stand, those of the row itself or of its line. */
static void fold_row(const PlanesWork *w, double *row)
{
  const int last = SLICE * w->chunks - 1;
  for (int m = -w->reach; m < w->chunks + w->reach; m = m == -1 ? w->chunks : m + 1)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int x = w->piece[lane] + m;
      for (int c = 0; c < 3; ++c) {
        const double force = row[m * PLACE + SLICE * (3 + c) + lane];
        if (x < 0 || x > last)
          w->column->line[c][SLICE + x] += force;
        else
          row[w->back[x] + SLICE * c] += force;
      }
    }
}

LANES_INLINE void forget_row(const PlanesWork *w, double *row)
{
  for (int m = -w->reach; m < w->chunks + w->reach; ++m)
    for (int x = 3 * SLICE; x < PLACE; x += LANES) lanes_store(row + m * PLACE + x, lanes_set(0));
}

/** Adds a layer's forces to the sums of the stripe, and forgets them. */
static void give_layer(const PlanesWork *w, int64_t layer)
{
  const HybridStripe *stripe = w->stripe;
  const int64_t size = stripe->high - stripe->low;
  const Lanes unit = lanes_set(w->unit);
  Column *column = w->column;
  for (int r = -w->reach; r < w->deep + w->reach; ++r) {
    double *row = row_at(w, r, layer);
    for (int c = 0; c < 3; ++c)
      for (int side = 0; side < 2; ++side)
        memset(column->line[c] + side * SLICE * (w->chunks + 1), 0, SLICE * sizeof(double));
    fold_row(w, row);
    for (int chunk = -1; chunk <= w->chunks; ++chunk) {
      const int64_t slice = slice_at(w, w->row + r, layer, chunk), at = slice * SLICE - stripe->low;
      if (slice < 0 || at < 0 || at >= size) continue;
      for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < SLICE; lane += LANES) {
          const int x = SLICE * chunk + lane;
          const Lanes force = chunk < 0 || chunk == w->chunks ? lanes_load(column->line[c] + SLICE + x)
                                                              : lanes_gather(row + SLICE * c, w->back + x);
          double *to = stripe->sums + w->axes[c] * size + at + lane;
          lanes_store(to, lanes_load(to) - unit * force);
        }
    }
    forget_row(w, row);
  }
}

/** Weights of the bonds of a row. @return whether there are any */
static bool weigh_row(const PlanesWork *w, int r, int64_t layer)
{
  const Hybrid *h = w->h;
  Column *column = w->column;
  int64_t slices[CHUNKS];
  int kinds[CHUNKS];
  bool same = true;
  for (int chunk = 0; chunk < w->chunks; ++chunk) {
    const int64_t slice = slices[chunk] = slice_at(w, w->row + r, layer, chunk);
    kinds[chunk] = slice >= w->stripe->first && slice < w->stripe->last ? h->planar_kind[slice] : NO_BONDS;
    same &= kinds[chunk] == column->kind[chunk] && kinds[chunk] != HYBRID_ODD;
  }
  if (same) return column->some;
  column->some = false;
  for (int chunk = 0; chunk < w->chunks; ++chunk) {
    HybridPlanes odd = {.some = false};
    if (kinds[chunk] == HYBRID_ODD) hybrid_planes_weigh(h, slices[chunk], &odd);
    const HybridPlanes *planes = kinds[chunk] < HYBRID_ODD ? &h->planes[kinds[chunk]] : &odd;
    column->some |= planes->some;
    column->kind[chunk] = kinds[chunk];
    for (int lane = 0; lane < SLICE; ++lane) {
      const int x = SLICE * chunk + lane;
      double *to = &column->weight[x % w->chunks][0][x / w->chunks];
      for (int k = 0; k < w->kinds; ++k) to[SLICE * k] = planes->volume[k][lane] * w->shear;
    }
  }
  return column->some;
}

static void go_through_layer(const PlanesWork *w, int64_t layer)
{
  const bool finite = w->h->finite;
  for (int r = 0; r < w->deep; ++r) {
    if (!weigh_row(w, r, layer)) continue;
    if (w->kinds == NEAR_KINDS) {
      (finite ? near_finite : near_small)(w, r, layer);
      continue;
    }
    (finite ? along_finite : along_small)(w, r, layer);
    (finite ? across_finite : across_small)(w, r, layer);
    (finite ? through_finite : through_small)(w, r, layer);
  }
}

/** Whether the stripe has slices in a layer of the column. */
static bool has_slices(const PlanesWork *w, int64_t layer)
{
  for (int r = 0; r < w->deep; ++r)
    for (int chunk = 0; chunk < w->chunks; ++chunk) {
      const int64_t slice = slice_at(w, w->row + r, layer, chunk);
      if (slice >= w->stripe->first && slice < w->stripe->last) return true;
    }
  return false;
}

static void go_through_column(PlanesWork *w, int64_t first, int64_t last)
{
  while (first <= last && !has_slices(w, first)) ++first;
  while (last > first && !has_slices(w, last)) --last;
  if (first > last) return;
  for (int lane = 0; lane < SLICE; ++lane) w->piece[lane] = lane * w->chunks;
  for (int x = 0; x < SLICE * w->chunks; ++x) w->back[x] = x % w->chunks * PLACE + 3 * SLICE + x / w->chunks;
  for (int chunk = 0; chunk < CHUNKS; ++chunk) w->column->kind[chunk] = -1;
  for (int z = 0; z < RING; ++z)
    for (int r = -w->reach; r < w->deep + w->reach; ++r) forget_row(w, row_at(w, r, z));
  for (int z = -1; z < w->reach; ++z) take_layer(w, first + z);
  for (int64_t layer = first; layer <= last; ++layer) {
    take_layer(w, layer + w->reach);
    go_through_layer(w, layer);
    give_layer(w, layer - 1);
  }
  for (int z = 0; z <= w->reach; ++z) give_layer(w, last + z);
}

/** Bonds of a stripe's slices of one block. */
static void go_through_block(PlanesWork *w, const HybridLattice *of)
{
  const HybridStripe *stripe = w->stripe;
  const int64_t chunks = w->lattice->chunks;
  const int64_t columns = (w->rows + DEEP - 1) / DEEP, parts = (chunks + CHUNKS - 1) / CHUNKS;
  const int64_t deep = (w->rows + columns - 1) / columns, wide = (chunks + parts - 1) / parts;
  int64_t first = 0, last = w->layers - 1;
  while (first < last && of->layer[first + 1] <= stripe->first) ++first;
  while (last > first && of->layer[last] >= stripe->last) --last;
  const HybridHooke *hooke = &w->h->hooke[w->h->material[of->layer[first]]];
  w->shear = hooke->shear / w->lattice->spacing;
  w->share = hooke->lame / (2 * hooke->shear);
  for (w->row = 0; w->row < w->rows; w->row += deep)
    for (w->chunk = 0; w->chunk < chunks; w->chunk += wide) {
      w->deep = (int)(w->rows - w->row < deep ? w->rows - w->row : deep);
      w->chunks = (int)(chunks - w->chunk < wide ? chunks - w->chunk : wide);
      go_through_column(w, first, last);
    }
}

void LANES_NAMED(hybrid_planes)(const Hybrid *h, double *const *displacement, const HybridStripe *stripe)
{
  _Alignas(64) Column column;
  for (int block = h->particles->block[stripe->first]; block <= h->particles->block[stripe->last - 1]; ++block) {
    const HybridLattice *of = &h->lattice[block];
    const Lattice *lattice = &h->family->lattices[block];
    if (!of->kind) continue;
    const bool near = of->kinds == NEAR_KINDS;
    PlanesWork w = {.h = h,
                    .displacement = displacement,
                    .lattice = lattice,
                    .stripe = stripe,
                    .axes = {lattice->axis, lattice->across[0], lattice->across[1]},
                    .kinds = of->kinds,
                    .reach = near ? 1 : 2,
                    .unit = 1.0 / (near ? UNIT_NEAR : UNIT_FAR),
                    .rows = lattice->cells[lattice->across[0]],
                    .layers = lattice->cells[lattice->across[1]],
                    .column = &column};
    go_through_block(&w, of);
  }
}

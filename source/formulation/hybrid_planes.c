/* Hybrid bonds of Hooke's law inside simple cubic lattices, whole rows of bonds at once, for each kind of vectors (base/lane_kinds.h).
 *
 * There the fit of a bond comes down to a few sums that many bonds share and that need no products. With u(i) the displacement one spacing further along
 * axis i they are, all over numbers that follow from the fits,
 *   D_i = u(i) - u(-i),   T_i = u(-i) + u + u(i),   V_ij = T_j of D_i.
 * G of a bond along axis k follows along k from its own ends, along the others from D of both (horizon 1.5 spacings) or V of both (2.015); of one across
 * a square from its own ends, T at the other two corners with, at 2.015, the neighbours of these, and D; of one through a cube from the twenty particles
 * around (docs/theory.md 5.2). What points exert goes back the same way: a bond gives what it was made of its share, and sums give theirs to the displacements they
 * were made of.
 *
 * A stripe of slices is gone through in columns of some rows and chunks, layer by layer, so that what a column needs at once stays in the second-level
 * cache. Bonds that lack a member have a weight of 0 here and are walked (hybrid_hooke.c). */
#include "formulation/hybrid_slice.h"

#include <string.h>

enum {
  MARGIN = 16, /* numbers of a row before those of its chunks, and behind them */
  CHUNKS = 8,  /* of a row at once */
  WIDE =
      2 * MARGIN + SLICE * CHUNKS + 8, /* numbers of a row: whole cache lines, but so many that rows meet in no set */
  DEEP = 14,                           /* rows at once */
  DEEP_FAR = 8,                        /* with the longer horizon */
  RING = 4,                            /* layers of displacements and forces that are held */
  PAIR = 2,                            /* layers of sums */
  D = 0,
  T = 9,
  V = 18,
  SUMS = 36,      /* numbers of a place: 3 each for three axes, and for six pairs */
  NEAR_KINDS = 9, /* of the shorter horizon */
  TWICE = 9,      /* the first of those two spacings long */
  THROUGH = 12,   /* the first of those through a cube */
  EXERTED = 9 * THROUGH + 12 * (HYBRID_KINDS - THROUGH),
  MOST_SUMS = (DEEP_FAR + 3) * SUMS, /* more than with the shorter horizon */
  NO_BONDS = HYBRID_ODD + 1
};

typedef double Row[WIDE];

/** What a column of rows has at hand. Rows of displacements and forces begin two before its own, those of sums one. */
typedef struct Column {
  Row moved[RING][DEEP + 4][3];
  Row force[RING][DEEP + 4][3]; /* derivatives of the energy */
  Row sum[PAIR][MOST_SUMS];     /* row by row */
  Row dual[PAIR][MOST_SUMS];    /* derivatives of the energy by them */
  Row exerted[EXERTED];
  Row weight[HYBRID_KINDS];
  int kind[CHUNKS]; /* of slices whose weights these are, or NO_BONDS; -1: nobody's */
  bool some[CHUNKS];
} Column;

typedef struct PlanesWork {
  const Hybrid *h;
  const Lattice *lattice;
  const HybridStripe *stripe;
  int axes[3]; /* of the body: that of rows, that of a layer's rows, that of layers */
  int kinds, sums;
  double shear, share,
      inverse; /* shear modulus over the spacing; Lame's over twice the shear modulus; 1 over the spacing */
  int64_t rows, layers;
  int64_t row, chunk; /* where the column begins */
  int deep, chunks;
  int from, to; /* numbers of a row that sums are made of */
  Column *column;
} PlanesWork;

LANES_INLINE Lanes take(const double *from)
{
  return lanes_load(from);
}

LANES_INLINE void add(double *to, Lanes value)
{
  lanes_store(to, lanes_load(to) + value);
}

/** Place of V for bonds along axis k in direction i, across the third axis. */
LANES_INLINE int pair_of(int i, int k)
{
  return V + 3 * (2 * i + ((i + 1) % 3 == k ? 0 : 1));
}

/** Rows of a layer's sums, `r` rows from the first. */
LANES_INLINE Row *sums_at(const PlanesWork *w, Row *of, int r)
{
  return of + w->sums * (r + 1);
}

/** Slice of a chunk of the column, or -1. */
LANES_INLINE int64_t slice_at(const PlanesWork *w, int64_t row, int64_t layer, int chunk)
{
  const int64_t at = w->chunk + chunk;
  if (row < 0 || row >= w->rows || layer < 0 || layer >= w->layers || at < 0 || at >= w->lattice->chunks) return -1;
  return w->lattice->slice[(layer * w->rows + row) * w->lattice->chunks + at];
}

/** Displacements of a layer, in spacings; none where no particle is. */
static void take_layer(const PlanesWork *w, int64_t layer)
{
  const Particles *p = w->h->particles;
  const Lanes inverse = lanes_set(w->inverse), none = lanes_set(0);
  for (int r = -2; r < w->deep + 2; ++r) {
    Row *to = w->column->moved[layer & (RING - 1)][r + 2];
    for (int chunk = -1; chunk <= w->chunks; ++chunk) {
      const int64_t slice = slice_at(w, w->row + r, layer, chunk), place = slice * SLICE;
      const int x = MARGIN + SLICE * chunk, kind = slice < 0 ? HYBRID_ODD : w->h->planar_kind[slice];
      const bool full = kind != HYBRID_ODD && w->h->planes[kind].full;
      for (int lane = 0; lane < SLICE; lane += LANES) {
        LaneMask there = {0};
        if (slice >= 0 && !full) there = (LaneMask)(lanes_load(p->volume + place + lane) > none);
        for (int c = 0; c < 3; ++c) {
          const Lanes u = slice < 0 ? none : inverse * lanes_load(p->displacement[w->axes[c]] + place + lane);
          lanes_store(to[c] + x + lane, full ? u : lanes_where(there, u));
        }
      }
    }
  }
}

/* Over what sums are taken: the numbers that fits have. */
LANES_INLINE double over_d(bool far)
{
  return far ? 1.0 / 8 : 1.0 / 4;
}
LANES_INLINE double over_t(bool far)
{
  return far ? 1.0 / 22 : 1.0 / 6;
}
enum { OVER_V = 12 };

LANES_INLINE void sum_rows(const PlanesWork *w, int64_t layer, bool far)
{
  Column *column = w->column;
  Row *of = column->sum[layer & 1];
  const Lanes d = lanes_set(over_d(far)), t = lanes_set(over_t(far));
  for (int r = -1; r < w->deep + (far ? 2 : 1); ++r) {
    const Row *here = column->moved[layer & 3][r + 2], *left = column->moved[layer & 3][r + 1],
              *right =
                  column->moved[layer & 3][r + (r > w->deep ? 2 : 3)], /* of the last row those sums serve nobody */
                  *below = column->moved[(layer - 1) & 3][r + 2], *above = column->moved[(layer + 1) & 3][r + 2];
    Row *to = sums_at(w, of, r);
    for (int x = w->from; x < w->to; x += LANES)
      for (int c = 0; c < 3; ++c) {
        const Lanes u = take(here[c] + x), a[3][2] = {{take(here[c] + x - 1), take(here[c] + x + 1)},
                                                      {take(left[c] + x), take(right[c] + x)},
                                                      {take(below[c] + x), take(above[c] + x)}};
        for (int k = 0; k < 3; ++k) {
          lanes_store(to[D + 3 * k + c] + x, (a[k][1] - a[k][0]) * d);
          lanes_store(to[T + 3 * k + c] + x, ((a[k][1] + a[k][0]) + u) * t);
        }
      }
  }
  const Lanes of_t = lanes_set(1 / (OVER_V * over_t(far))), of_d = lanes_set(1 / (OVER_V * over_d(far)));
  for (int r = 0; r <= w->deep && far; ++r) {
    const Row *left = sums_at(w, of, r - 1), *right = sums_at(w, of, r + 1);
    Row *to = sums_at(w, of, r);
    for (int x = w->from; x < w->to; x += LANES)
      for (int c = 0; c < 3; ++c) {
        const double *ty = to[T + 3 + c] + x, *tz = to[T + 6 + c] + x, *dz = to[D + 6 + c] + x;
        lanes_store(to[pair_of(0, 1) + c] + x, of_t * (take(tz + 1) - take(tz - 1)));
        lanes_store(to[pair_of(0, 2) + c] + x, of_t * (take(ty + 1) - take(ty - 1)));
        lanes_store(to[pair_of(1, 2) + c] + x, of_t * (take(right[T + c] + x) - take(left[T + c] + x)));
        lanes_store(to[pair_of(1, 0) + c] + x, of_t * (take(right[T + 6 + c] + x) - take(left[T + 6 + c] + x)));
        lanes_store(to[pair_of(2, 0) + c] + x,
                    of_d * ((take(right[D + 6 + c] + x) + take(left[D + 6 + c] + x)) + take(dz)));
        lanes_store(to[pair_of(2, 1) + c] + x, of_d * ((take(dz + 1) + take(dz - 1)) + take(dz)));
      }
  }
}

/** F S of G, both column by column, times a weight. */
LANES_INLINE void find_stress(const Lanes g[3][3], Lanes weight, Lanes share, bool finite, Lanes p[3][3])
{
  Lanes s[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      s[a][b] = g[a][b] + g[b][a];
      for (int c = 0; c < 3 && finite; ++c) s[a][b] += g[a][c] * g[b][c];
    }
  const Lanes trace = (s[0][0] + s[1][1]) + s[2][2];
  for (int a = 0; a < 3; ++a) s[a][a] += share * trace;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) s[a][b] = s[b][a] = lanes_product(s[a][b], weight);
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) {
      p[a][c] = s[a][c];
      for (int b = 0; b < 3 && finite; ++b) p[a][c] += g[b][c] * s[b][a];
    }
}

/** Rows around those whose bonds are gone through: of displacements from two before to two behind, from the layer below to two above; of sums from one before to one
 *  behind, of this layer and the next. */
typedef struct Around {
  const Row *u[4][5], *sum[2][3];
  Row *force[4][5], *dual[2][3];
  Row *exerted;
  Lanes share;
  bool finite;
} Around;

LANES_INLINE Lanes moved(const Around *a, int c, int x, int dx, int dy, int dz)
{
  return take(a->u[1 + dz][2 + dy][c] + x + dx);
}

LANES_INLINE Lanes sum_at(const Around *a, int which, int x, int dx, int dy, int dz)
{
  return take(a->sum[dz][1 + dy][which] + x + dx);
}

/** Rows of what bonds of a kind exert. */
LANES_INLINE int exerted_of(int kind)
{
  return kind < THROUGH ? 9 * kind : 9 * THROUGH + 12 * (kind - THROUGH);
}

/** Bonds along axis k, `long_one`: of two spacings. */
LANES_INLINE void along(const Around *a, const Row *weight, int k, bool far, bool long_one, int x)
{
  const int i = (k + 1) % 3, j = (k + 2) % 3, dx = k == 0, dy = k == 1, dz = k == 2, kind = long_one ? TWICE + k : k;
  const int of_i = far ? pair_of(i, k) : D + 3 * i, of_j = far ? pair_of(j, k) : D + 3 * j;
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    if (long_one) {
      g[k][c] = lanes_set(0.5) * (moved(a, c, x, 2 * dx, 2 * dy, 2 * dz) - moved(a, c, x, 0, 0, 0));
      g[i][c] = lanes_set(2) * sum_at(a, of_i + c, x, dx, dy, dz);
      g[j][c] = lanes_set(2) * sum_at(a, of_j + c, x, dx, dy, dz);
      continue;
    }
    g[k][c] = moved(a, c, x, dx, dy, dz) - moved(a, c, x, 0, 0, 0);
    g[i][c] = sum_at(a, of_i + c, x, 0, 0, 0) + sum_at(a, of_i + c, x, dx, dy, dz);
    g[j][c] = sum_at(a, of_j + c, x, 0, 0, 0) + sum_at(a, of_j + c, x, dx, dy, dz);
  }
  find_stress(g, take(weight[kind] + x), a->share, a->finite, p);
  Row *to = a->exerted + exerted_of(kind);
  for (int c = 0; c < 3; ++c) {
    lanes_store(to[c] + x, p[k][c]);
    lanes_store(to[3 + c] + x, p[i][c]);
    lanes_store(to[6 + c] + x, p[j][c]);
  }
}

/** Bonds that lead one spacing along axis `to` and `sign` spacings along axis `by` before it. */
LANES_INLINE void across(const Around *a, const Row *weight, int kind, int by, int to, int sign, bool far, int x)
{
  const int m = 3 - by - to, ax = by == 0 ? sign : 0, ay = by == 1 ? sign : 0, ty = to == 1, tz = to == 2;
  const Lanes half = lanes_set(0.5), turned = lanes_set(0.5 * sign);
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    const Lanes own = moved(a, c, x, ax, ay + ty, tz) - moved(a, c, x, 0, 0, 0);
    Lanes side = sum_at(a, T + 3 * m + c, x, ax, ay, 0) - sum_at(a, T + 3 * m + c, x, 0, ty, tz);
    Lanes over = sum_at(a, D + 3 * m + c, x, ax, ay, 0) + sum_at(a, D + 3 * m + c, x, 0, ty, tz);
    if (far) {
      side += lanes_set(1.0 / 11) * ((moved(a, c, x, 2 * ax, 2 * ay, 0) - moved(a, c, x, 0, 2 * ty, 2 * tz)) +
                                     (moved(a, c, x, ax, ay - ty, -tz) - moved(a, c, x, -ax, ty - ay, tz)));
      over += sum_at(a, D + 3 * m + c, x, 0, 0, 0) + sum_at(a, D + 3 * m + c, x, ax, ay + ty, tz);
    }
    g[by][c] = (sign > 0 ? side : -side) + turned * own;
    g[to][c] = half * own - side;
    g[m][c] = over;
  }
  find_stress(g, take(weight[kind] + x), a->share, a->finite, p);
  Row *out = a->exerted + exerted_of(kind);
  for (int c = 0; c < 3; ++c) {
    lanes_store(out[c] + x, sign > 0 ? p[to][c] + p[by][c] : p[to][c] - p[by][c]);
    lanes_store(out[3 + c] + x, sign > 0 ? p[by][c] - p[to][c] : -(p[by][c] + p[to][c]));
    lanes_store(out[6 + c] + x, p[m][c]);
  }
}

/** Bonds through cubes, which lead to (sx, sy, 1). */
LANES_INLINE void through(const Around *a, const Row *weight, int kind, int sx, int sy, int x)
{
  const Lanes tenth = lanes_set(0.1), fifth = lanes_set(0.2), third = lanes_set(1.0 / 3);
  const double sign[3] = {sx, sy, 1};
  Lanes g[3][3], p[3][3];
  for (int c = 0; c < 3; ++c) {
    const Lanes own = moved(a, c, x, sx, sy, 1) - moved(a, c, x, 0, 0, 0);
    g[0][c] = lanes_product(tenth, moved(a, c, x, sx, 0, 0) - moved(a, c, x, 0, sy, 1));
    g[1][c] = lanes_product(tenth, moved(a, c, x, 0, sy, 0) - moved(a, c, x, sx, 0, 1));
    g[2][c] = lanes_product(tenth, moved(a, c, x, 0, 0, 1) - moved(a, c, x, sx, sy, 0));
    g[0][c] += fifth * (moved(a, c, x, 2 * sx, 0, 0) - moved(a, c, x, -sx, sy, 1));
    g[1][c] += fifth * (moved(a, c, x, 0, 2 * sy, 0) - moved(a, c, x, sx, -sy, 1));
    g[2][c] += fifth * (moved(a, c, x, 0, 0, 2) - moved(a, c, x, sx, sy, -1));
    const Lanes rest = lanes_product(third, own - ((g[0][c] + g[1][c]) + g[2][c]));
    for (int k = 0; k < 3; ++k) g[k][c] = sign[k] > 0 ? g[k][c] + rest : -(g[k][c] + rest);
  }
  find_stress(g, take(weight[kind] + x), a->share, a->finite, p);
  Row *out = a->exerted + exerted_of(kind);
  for (int c = 0; c < 3; ++c) {
    Lanes q[3];
    for (int k = 0; k < 3; ++k) q[k] = sign[k] > 0 ? p[k][c] : -p[k][c];
    const Lanes mean = lanes_product(third, (q[0] + q[1]) + q[2]);
    lanes_store(out[c] + x, mean);
    for (int k = 0; k < 3; ++k) lanes_store(out[3 + 3 * k + c] + x, q[k] - mean);
  }
}

/** What the bonds of a row's places exert. */
LANES_INLINE void exert_row(const PlanesWork *w, Around *a, bool far)
{
  const Row *weight = w->column->weight;
  for (int x = MARGIN; x < MARGIN + SLICE * w->chunks; x += LANES) {
    along(a, weight, 0, far, false, x);
    along(a, weight, 1, far, false, x);
    along(a, weight, 2, far, false, x);
    across(a, weight, 3, 0, 1, 1, far, x);
    across(a, weight, 4, 0, 1, -1, far, x);
    across(a, weight, 5, 0, 2, 1, far, x);
    across(a, weight, 6, 0, 2, -1, far, x);
    across(a, weight, 7, 1, 2, 1, far, x);
    across(a, weight, 8, 1, 2, -1, far, x);
  }
  for (int x = MARGIN; x < MARGIN + SLICE * w->chunks && far; x += LANES) {
    along(a, weight, 0, far, true, x);
    along(a, weight, 1, far, true, x);
    along(a, weight, 2, far, true, x);
    through(a, weight, 12, 1, 1, x);
    through(a, weight, 13, -1, 1, x);
    through(a, weight, 14, 1, -1, x);
    through(a, weight, 15, -1, -1, x);
  }
}

/** Number c of what the bonds of a kind whose owners stand dx places before give in the way that `column` says. */
LANES_INLINE Lanes from(const Around *a, int kind, int column, int c, int x, int dx)
{
  return take(a->exerted[exerted_of(kind) + 3 * column + c] + x - dx);
}

/** Gives it to ends and to what else was taken of single particles. */
LANES_INLINE void give_ends(const Around *a, bool far, int x, int c)
{
  const Lanes half = lanes_set(0.5);
  Lanes f[4][5]; /* as Around.force */
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 5; ++y) f[z][y] = lanes_set(0);
#define OF(kind, column, dx) from(a, kind, column, c, x, dx)
#define TO(dy, dz) f[1 + (dz)][2 + (dy)]
  TO(0, 0) = half * (((OF(3, 0, 0) + OF(4, 0, 0)) + (OF(5, 0, 0) + OF(6, 0, 0))) + (OF(7, 0, 0) + OF(8, 0, 0)));
  TO(0, 0) = ((OF(0, 0, 1) - OF(0, 0, 0)) - (OF(1, 0, 0) + OF(2, 0, 0))) - TO(0, 0);
  TO(1, 0) = OF(1, 0, 0) + half * (OF(3, 0, 1) + OF(4, 0, -1));
  TO(0, 1) = OF(2, 0, 0) + half * (OF(5, 0, 1) + OF(6, 0, -1));
  TO(1, 1) = half * OF(7, 0, 0);
  TO(-1, 1) = half * OF(8, 0, 0);
  if (far) {
    TO(0, 0) += half * (OF(9, 0, 2) - ((OF(9, 0, 0) + OF(10, 0, 0)) + OF(11, 0, 0)));
    TO(2, 0) += half * OF(10, 0, 0);
    TO(0, 2) += half * OF(11, 0, 0);
    const Lanes side = lanes_set(1.0 / 11);
    TO(0, 0) += side * ((OF(3, 1, 2) + OF(4, 1, -2)) + (OF(5, 1, 2) + OF(6, 1, -2)));
    TO(-1, 0) += side * (OF(3, 1, 1) + OF(4, 1, -1));
    TO(2, 0) += side * (OF(7, 1, 0) - (OF(3, 1, 0) + OF(4, 1, 0)));
    TO(1, 0) -= side * (OF(3, 1, -1) + OF(4, 1, 1));
    TO(0, -1) += side * (OF(5, 1, 1) + OF(6, 1, -1));
    TO(0, 2) -= side * ((OF(5, 1, 0) + OF(6, 1, 0)) + (OF(7, 1, 0) + OF(8, 1, 0)));
    TO(0, 1) -= side * (OF(5, 1, -1) + OF(6, 1, 1));
    TO(1, -1) += side * OF(7, 1, 0);
    TO(-1, 1) -= side * OF(7, 1, 0);
    TO(-2, 0) += side * OF(8, 1, 0);
    TO(-1, -1) += side * OF(8, 1, 0);
    TO(1, 1) -= side * OF(8, 1, 0);
#define GIVE_THROUGH(kind, sx, sy)                                                                                     \
  TO(0, 0) -= OF(kind, 0, 0);                                                                                          \
  TO(sy, 1) += OF(kind, 0, sx);                                                                                        \
  TO(0, 0) += tenth * OF(kind, 1, sx);                                                                                 \
  TO(sy, 1) -= tenth * OF(kind, 1, 0);                                                                                 \
  TO(0, 0) += fifth * OF(kind, 1, 2 * (sx));                                                                           \
  TO(sy, 1) -= fifth * OF(kind, 1, -(sx));                                                                             \
  TO(sy, 0) += tenth * OF(kind, 2, 0);                                                                                 \
  TO(0, 1) -= tenth * OF(kind, 2, sx);                                                                                 \
  TO(2 * (sy), 0) += fifth * OF(kind, 2, 0);                                                                           \
  TO(-(sy), 1) -= fifth * OF(kind, 2, sx);                                                                             \
  TO(0, 1) += tenth * OF(kind, 3, 0);                                                                                  \
  TO(sy, 0) -= tenth * OF(kind, 3, sx);                                                                                \
  TO(0, 2) += fifth * OF(kind, 3, 0);                                                                                  \
  TO(sy, -1) -= fifth * OF(kind, 3, sx)
    const Lanes tenth = lanes_set(0.1), fifth = lanes_set(0.2);
    GIVE_THROUGH(12, 1, 1);
    GIVE_THROUGH(13, -1, 1);
    GIVE_THROUGH(14, 1, -1);
    GIVE_THROUGH(15, -1, -1);
#undef GIVE_THROUGH
  }
  for (int dy = far ? -2 : 0; dy <= (far ? 2 : 1); ++dy) add(a->force[1][2 + dy][c] + x, TO(dy, 0));
  for (int dy = -1; dy <= 1; ++dy) {
    add(a->force[2][2 + dy][c] + x, TO(dy, 1));
    if (far) add(a->force[0][2 + dy][c] + x, TO(dy, -1));
  }
  if (far) add(a->force[3][2][c] + x, TO(0, 2));
}

/** Gives it to sums. */
LANES_INLINE void give_sums(const Around *a, bool far, int x, int c)
{
  Row *const(*to)[3] = (Row *const(*)[3])a->dual;
  const Lanes seven = OF(7, 2, 0), eight = OF(8, 2, 0);
  const Lanes own_y = OF(5, 2, 1) + OF(6, 2, -1), up_y = OF(5, 2, 0) + OF(6, 2, 0);
  const Lanes own_z = OF(3, 2, 1) + OF(4, 2, -1), up_z = OF(3, 2, 0) + OF(4, 2, 0);
  if (far) {
    add(to[0][1][D + c] + x, seven + eight);
    add(to[0][2][D + c] + x, seven);
    add(to[0][0][D + c] + x, eight);
    add(to[1][1][D + c] + x, seven + eight);
    add(to[1][2][D + c] + x, seven);
    add(to[1][0][D + c] + x, eight);
    add(to[0][1][D + 3 + c] + x, own_y + up_y);
    add(to[1][1][D + 3 + c] + x, own_y + up_y);
    add(to[0][1][D + 6 + c] + x, own_z + up_z);
    add(to[0][2][D + 6 + c] + x, own_z + up_z);
    const Lanes two = lanes_set(2);
    add(to[0][1][pair_of(1, 0) + c] + x, (OF(0, 1, 0) + OF(0, 1, 1)) + two * OF(9, 1, 1));
    add(to[0][1][pair_of(2, 0) + c] + x, (OF(0, 2, 0) + OF(0, 2, 1)) + two * OF(9, 2, 1));
    add(to[0][1][pair_of(2, 1) + c] + x, OF(1, 1, 0));
    add(to[0][1][pair_of(0, 1) + c] + x, OF(1, 2, 0));
    add(to[0][2][pair_of(2, 1) + c] + x, OF(1, 1, 0) + two * OF(10, 1, 0));
    add(to[0][2][pair_of(0, 1) + c] + x, OF(1, 2, 0) + two * OF(10, 2, 0));
    add(to[0][1][pair_of(0, 2) + c] + x, OF(2, 1, 0));
    add(to[0][1][pair_of(1, 2) + c] + x, OF(2, 2, 0));
    add(to[1][1][pair_of(0, 2) + c] + x, OF(2, 1, 0) + two * OF(11, 1, 0));
    add(to[1][1][pair_of(1, 2) + c] + x, OF(2, 2, 0) + two * OF(11, 2, 0));
  } else {
    add(to[0][1][D + c] + x, OF(1, 2, 0) + OF(2, 1, 0));
    add(to[0][2][D + c] + x, OF(1, 2, 0) + seven);
    add(to[0][0][D + c] + x, eight);
    add(to[1][1][D + c] + x, OF(2, 1, 0) + (seven + eight));
    add(to[0][1][D + 3 + c] + x, ((OF(0, 1, 0) + OF(0, 1, 1)) + OF(2, 2, 0)) + own_y);
    add(to[1][1][D + 3 + c] + x, OF(2, 2, 0) + up_y);
    add(to[0][1][D + 6 + c] + x, ((OF(0, 2, 0) + OF(0, 2, 1)) + OF(1, 1, 0)) + own_z);
    add(to[0][2][D + 6 + c] + x, OF(1, 1, 0) + up_z);
  }
  add(to[0][2][T + c] + x, OF(7, 1, 0));
  add(to[0][0][T + c] + x, OF(8, 1, 0));
  add(to[1][1][T + c] + x, -(OF(7, 1, 0) + OF(8, 1, 0)));
  add(to[0][1][T + 3 + c] + x, OF(5, 1, 1) + OF(6, 1, -1));
  add(to[1][1][T + 3 + c] + x, -(OF(5, 1, 0) + OF(6, 1, 0)));
  add(to[0][1][T + 6 + c] + x, OF(3, 1, 1) + OF(4, 1, -1));
  add(to[0][2][T + 6 + c] + x, -(OF(3, 1, 0) + OF(4, 1, 0)));
}
#undef OF
#undef TO

LANES_INLINE void give_row(const PlanesWork *w, const Around *a, bool far)
{
  for (int x = w->from; x < w->to; x += LANES)
    for (int c = 0; c < 3; ++c) {
      give_ends(a, far, x, c);
      give_sums(a, far, x, c);
    }
}

LANES_INLINE void go_through_row(const PlanesWork *w, int r, int64_t layer, bool far, bool finite)
{
  Column *column = w->column;
  Around a = {.exerted = column->exerted, .share = lanes_set(w->share), .finite = finite};
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 5; ++y) {
      a.u[z][y] = column->moved[(layer + z - 1) & 3][r + y];
      a.force[z][y] = column->force[(layer + z - 1) & 3][r + y];
    }
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y) {
      a.sum[z][y] = sums_at(w, column->sum[(layer + z) & 1], r + y - 1);
      a.dual[z][y] = sums_at(w, column->dual[(layer + z) & 1], r + y - 1);
    }
  exert_row(w, &a, far);
  give_row(w, &a, far);
}

/* Each way through a row is compiled on its own. */
static __attribute__((noinline)) void near_small(const PlanesWork *w, int r, int64_t layer)
{
  go_through_row(w, r, layer, false, false);
}
static __attribute__((noinline)) void near_finite(const PlanesWork *w, int r, int64_t layer)
{
  go_through_row(w, r, layer, false, true);
}
static __attribute__((noinline)) void far_small(const PlanesWork *w, int r, int64_t layer)
{
  go_through_row(w, r, layer, true, false);
}
static __attribute__((noinline)) void far_finite(const PlanesWork *w, int r, int64_t layer)
{
  go_through_row(w, r, layer, true, true);
}

/** Gives what V of a layer received to the T and D they were made of. */
static void spread_pairs(const PlanesWork *w, int64_t layer)
{
  Row *of = w->column->dual[layer & 1];
  const Lanes of_t = lanes_set(1 / (OVER_V * over_t(true))), of_d = lanes_set(1 / (OVER_V * over_d(true)));
  for (int r = -1; r < w->deep + 2; ++r) {
    Row *own = sums_at(w, of, r);
    const Row *left = r > 0 ? own - w->sums : NULL, *right = r < w->deep ? own + w->sums : NULL;
    for (int x = w->from; x < w->to; x += LANES)
      for (int c = 0; c < 3; ++c) {
        const double *xz = own[pair_of(0, 1) + c] + x, *xy = own[pair_of(0, 2) + c] + x,
                     *zx = own[pair_of(2, 1) + c] + x, *zy = own[pair_of(2, 0) + c] + x;
        Lanes tx = lanes_set(0), tz = take(xz - 1) - take(xz + 1), dz = (take(zx - 1) + take(zx + 1)) + take(zx);
        dz += take(zy);
        if (left) {
          tx += take(left[pair_of(1, 2) + c] + x);
          tz += take(left[pair_of(1, 0) + c] + x);
          dz += take(left[pair_of(2, 0) + c] + x);
        }
        if (right) {
          tx -= take(right[pair_of(1, 2) + c] + x);
          tz -= take(right[pair_of(1, 0) + c] + x);
          dz += take(right[pair_of(2, 0) + c] + x);
        }
        add(own[T + c] + x, of_t * tx);
        add(own[T + 3 + c] + x, of_t * (take(xy - 1) - take(xy + 1)));
        add(own[T + 6 + c] + x, of_t * tz);
        add(own[D + 6 + c] + x, of_d * dz);
      }
  }
}

/** Gives what D and T of a layer received to the displacements they were made of, and forgets it. */
static void spread_layer(const PlanesWork *w, int64_t layer)
{
  static const Row nothing[SUMS];
  const bool far = w->kinds > NEAR_KINDS;
  Column *column = w->column;
  Row *of = column->dual[layer & 1];
  if (far) spread_pairs(w, layer);
  const int end = w->deep + (far ? 2 : 1);
  const Lanes d_part = lanes_set(over_d(far)), t_part = lanes_set(over_t(far));
  for (int r = -2; r < w->deep + 2; ++r) {
    Row *to = column->force[layer & 3][r + 2], *below = column->force[(layer - 1) & 3][r + 2],
        *above = column->force[(layer + 1) & 3][r + 2];
    const Row *before = r > -1 ? sums_at(w, of, r - 1) : nothing,
              *own = r > -2 && r < end ? sums_at(w, of, r) : nothing,
              *behind = r + 1 < end ? sums_at(w, of, r + 1) : nothing;
    for (int x = w->from; x < w->to; x += LANES)
      for (int c = 0; c < 3; ++c) {
        const Lanes tz = take(own[T + 6 + c] + x), dz = take(own[D + 6 + c] + x);
        const Lanes d = (take(own[D + c] + x - 1) - take(own[D + c] + x + 1)) +
                        (take(before[D + 3 + c] + x) - take(behind[D + 3 + c] + x));
        const Lanes t = ((take(own[T + c] + x - 1) + take(own[T + c] + x + 1)) + take(own[T + c] + x)) +
                        ((take(before[T + 3 + c] + x) + take(behind[T + 3 + c] + x)) + (take(own[T + 3 + c] + x) + tz));
        const Lanes up = lanes_load(above[c] + x) + t_part * tz, down = lanes_load(below[c] + x) + t_part * tz,
                    same = lanes_load(to[c] + x) + t_part * t;
        lanes_store(above[c] + x, up + d_part * dz);
        lanes_store(below[c] + x, down - d_part * dz);
        lanes_store(to[c] + x, same + d_part * d);
      }
    for (int n = 0; n < w->sums && r > -1; ++n) /* nothing asks for those of the row before any more */
      for (int x = w->from; x < w->to; x += LANES) lanes_store(sums_at(w, of, r - 1)[n] + x, lanes_set(0));
  }
  for (int n = 0; n < w->sums && far; ++n)
    for (int x = w->from; x < w->to; x += LANES) lanes_store(sums_at(w, of, w->deep + 1)[n] + x, lanes_set(0));
}

/** Adds a layer's forces to the sums of the stripe, and forgets them. */
static void give_layer(const PlanesWork *w, int64_t layer)
{
  const HybridStripe *stripe = w->stripe;
  const int64_t size = stripe->high - stripe->low;
  for (int r = -2; r < w->deep + 2; ++r) {
    Row *of = w->column->force[layer & (RING - 1)][r + 2];
    for (int chunk = -1; chunk <= w->chunks; ++chunk) {
      const int64_t slice = slice_at(w, w->row + r, layer, chunk), at = slice * SLICE - stripe->low;
      if (slice < 0 || at < 0 || at >= size) continue;
      for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < SLICE; lane += LANES)
          add(stripe->sums + w->axes[c] * size + at + lane, -take(of[c] + MARGIN + SLICE * chunk + lane));
    }
    for (int c = 0; c < 3; ++c)
      for (int x = w->from; x < w->to; x += LANES) lanes_store(of[c] + x, lanes_set(0));
  }
}

/** Weights of the bonds of a chunk. @return whether there are any */
static bool weigh_chunk(const PlanesWork *w, int64_t slice, int chunk)
{
  const Hybrid *h = w->h;
  const bool own = slice >= w->stripe->first && slice < w->stripe->last;
  const int kind = own ? h->planar_kind[slice] : NO_BONDS;
  Column *column = w->column;
  if (kind == column->kind[chunk] && kind != HYBRID_ODD) return column->some[chunk];
  HybridPlanes odd = {.some = false};
  if (kind == HYBRID_ODD) hybrid_planes_weigh(h, slice, &odd);
  const HybridPlanes *planes = own && kind != HYBRID_ODD ? &h->planes[kind] : &odd;
  for (int k = 0; k < w->kinds; ++k)
    for (int lane = 0; lane < SLICE; lane += LANES)
      lanes_store(column->weight[k] + MARGIN + SLICE * chunk + lane,
                  lanes_load(planes->volume[k] + lane) * lanes_set(w->shear));
  column->kind[chunk] = kind;
  return column->some[chunk] = planes->some;
}

static void sum_layer(const PlanesWork *w, int64_t layer)
{
  if (w->kinds > NEAR_KINDS)
    sum_rows(w, layer, true);
  else
    sum_rows(w, layer, false);
}

static void go_through_layer(const PlanesWork *w, int64_t layer)
{
  void (*const go)(const PlanesWork *, int, int64_t) =
      w->kinds > NEAR_KINDS ? (w->h->finite ? far_finite : far_small) : (w->h->finite ? near_finite : near_small);
  for (int r = 0; r < w->deep; ++r) {
    bool some = false;
    for (int chunk = 0; chunk < w->chunks; ++chunk)
      some |= weigh_chunk(w, slice_at(w, w->row + r, layer, chunk), chunk);
    if (some) go(w, r, layer);
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
  w->from = w->chunk > 0 ? MARGIN - SLICE : MARGIN;
  w->to = MARGIN + SLICE * (w->chunks + (w->chunk + w->chunks < w->lattice->chunks));
  for (int n = 0; n < EXERTED && w->chunks < CHUNKS; ++n) /* left by a wider column */
    memset(&w->column->exerted[n][MARGIN + SLICE * w->chunks], 0, SLICE * sizeof(double));
  for (int z = -1; z < 2; ++z) take_layer(w, first + z);
  sum_layer(w, first);
  for (int64_t layer = first; layer <= last; ++layer) {
    take_layer(w, layer + 2);
    sum_layer(w, layer + 1);
    go_through_layer(w, layer);
    spread_layer(w, layer);
    give_layer(w, layer - 1);
  }
  spread_layer(w, last + 1);
  for (int z = 0; z < 3; ++z) give_layer(w, last + z);
}

/** Bonds of a stripe's slices of one block. */
static void go_through_block(PlanesWork *w, const HybridLattice *of)
{
  const HybridStripe *stripe = w->stripe;
  const int64_t chunks = w->lattice->chunks;
  const int most = w->kinds > NEAR_KINDS ? DEEP_FAR : DEEP;
  const int64_t columns = (w->rows + most - 1) / most, parts = (chunks + CHUNKS - 1) / CHUNKS;
  const int64_t deep = (w->rows + columns - 1) / columns, wide = (chunks + parts - 1) / parts;
  int64_t first = 0, last = w->layers - 1;
  while (first < last && of->layer[first + 1] <= stripe->first) ++first;
  while (last > first && of->layer[last] >= stripe->last) --last;
  const HybridHooke *hooke = &w->h->hooke[w->h->material[of->layer[first]]];
  w->shear = hooke->shear / w->lattice->spacing;
  w->share = hooke->lame / (2 * hooke->shear);
  for (int chunk = 0; chunk < CHUNKS; ++chunk) w->column->kind[chunk] = -1;
  for (w->row = 0; w->row < w->rows; w->row += deep)
    for (w->chunk = 0; w->chunk < chunks; w->chunk += wide) {
      w->deep = (int)(w->rows - w->row < deep ? w->rows - w->row : deep);
      w->chunks = (int)(chunks - w->chunk < wide ? chunks - w->chunk : wide);
      go_through_column(w, first, last);
    }
}

void LANES_NAMED(hybrid_planes)(const Hybrid *h, const HybridStripe *stripe)
{
  _Alignas(64) Column column;
  bool clear = false;
  for (int block = h->particles->block[stripe->first]; block <= h->particles->block[stripe->last - 1]; ++block) {
    const HybridLattice *of = &h->lattice[block];
    const Lattice *lattice = &h->family->lattices[block];
    if (!of->kind) continue;
    if (!clear) memset(&column, 0, sizeof column);
    if (clear) memset(column.exerted, 0, sizeof column.exerted); /* rows of another block may have been longer */
    clear = true;
    PlanesWork w = {.h = h,
                    .lattice = lattice,
                    .stripe = stripe,
                    .axes = {lattice->axis, lattice->across[0], lattice->across[1]},
                    .kinds = of->kinds,
                    .sums = of->kinds > NEAR_KINDS ? SUMS : V,
                    .inverse = 1 / lattice->spacing,
                    .rows = lattice->cells[lattice->across[0]],
                    .layers = lattice->cells[lattice->across[1]],
                    .column = &column};
    go_through_block(&w, of);
  }
}

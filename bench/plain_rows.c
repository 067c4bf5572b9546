#include "measure.h"

#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The yardstick must stay scalar. */
#ifdef __clang__
#define PLAIN
#else
#define PLAIN __attribute__((optimize("no-tree-vectorize")))
#endif

typedef struct Rows {
  int64_t *first;
  int32_t *neighbour;
} Rows;

static Rows rows_of(const Domain *d)
{
  const Particles *p = d->particles;
  Rows rows = {malloc(sizeof(int64_t) * (size_t)(p->count + 1)), malloc(sizeof(int32_t) * (size_t)d->family.bonds)};
  int64_t n = 0;
  for (int64_t i = 0; i < p->count; ++i) {
    int32_t place = p->place_of[i];
    rows.first[i] = n;
    for (int64_t slot = d->family.first[place / SLICE]; slot < d->family.first[place / SLICE + 1]; ++slot)
      if (d->family.intact[slot] >> (place % SLICE) & 1)
        rows.neighbour[n++] = p->number[family_bond(&d->family, place / SLICE, slot, place % SLICE).neighbour];
  }
  rows.first[p->count] = n;
  return rows;
}

struct Plain {
  size_t count;
  int dimensions;
  Rows rows;
  double *x, *u, *force, *state, *inverse, *volume, *moment; /* moment: sum of V |xi|^2 */
  double *turned; /* cosine and sine of rotations in the plane, or quaternions: four numbers each */
};

Plain *plain_create(const Domain *d)
{
  const Particles *p = d->particles;
  size_t n = (size_t)p->count;
  Plain *plain = malloc(sizeof *plain);
  if (!plain) abort();
  *plain = (Plain){n,
                   d->body.dimensions,
                   rows_of(d),
                   malloc(24 * n),
                   malloc(24 * n),
                   malloc(24 * n),
                   malloc(72 * n),
                   malloc(48 * n),
                   malloc(8 * n),
                   malloc(8 * n),
                   malloc(32 * n)};
  for (size_t i = 0; i < n; ++i) {
    double k[6] = {0};
    int32_t here = p->place_of[i];
    plain->volume[i] = p->volume[here];
    const double angle = 1e-6 * (double)(i % 5), half = d->body.dimensions == 2 ? angle : angle / 2;
    memcpy(plain->turned + 4 * i, (double[]){cos(half), sin(half), 0, 0}, 32);
    for (int c = 0; c < 3; ++c) {
      plain->x[3 * i + (size_t)c] = p->position[c][here];
      plain->u[3 * i + (size_t)c] = 1e-6 * (double)(i % 7);
    }
    for (int64_t b = plain->rows.first[i]; b < plain->rows.first[i + 1]; ++b)
      for (int c = 0; c < 6; ++c) {
        int32_t j = p->place_of[plain->rows.neighbour[b]];
        k[c] += p->volume[j] * (p->position[symmetric_row[c]][j] - p->position[symmetric_row[c]][here]) *
                (p->position[symmetric_column[c]][j] - p->position[symmetric_column[c]][here]);
      }
    plain->moment[i] = k[XX] + k[YY] + k[ZZ];
    if (k[ZZ] == 0) k[ZZ] = 1; /* a body of the plane */
    tensor_inverse(k, plain->inverse + 6 * i);
  }
  return plain;
}

void plain_destroy(Plain *plain)
{
  free(plain->rows.first);
  free(plain->rows.neighbour);
  free(plain->x);
  free(plain->u);
  free(plain->force);
  free(plain->state);
  free(plain->inverse);
  free(plain->volume);
  free(plain->moment);
  free(plain->turned);
  free(plain);
}

PLAIN void plain_bonds(Plain *plain)
{
  const double *x = plain->x, *u = plain->u, *volume = plain->volume, constant = 1e9;
  const Rows *rows = &plain->rows;
  for (size_t i = 0; i < plain->count; ++i) {
    double force[3] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      size_t j = (size_t)rows->neighbour[b];
      double y[3], reference = 0, length = 0;
      for (int c = 0; c < 3; ++c) {
        double xi = x[3 * j + (size_t)c] - x[3 * i + (size_t)c];
        y[c] = xi + u[3 * j + (size_t)c] - u[3 * i + (size_t)c];
        reference += xi * xi;
        length += y[c] * y[c];
      }
      reference = sqrt(reference);
      length = sqrt(length);
      double pull = constant * volume[j] * (length - reference) / (reference * length);
      for (int c = 0; c < 3; ++c) force[c] += pull * y[c];
    }
    for (int c = 0; c < 3; ++c) plain->force[3 * i + (size_t)c] = force[c];
  }
}

/** Reference and deformed vector of a bond. */
static inline double plain_elongation(const Plain *plain, size_t i, size_t j, double y[3], double *reference)
{
  const double *x = plain->x, *u = plain->u;
  double square = 0, length = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double xi = x[3 * j + c] - x[3 * i + c];
    y[c] = xi + u[3 * j + c] - u[3 * i + c];
    square += xi * xi;
    length += y[c] * y[c];
  }
  *reference = sqrt(square);
  return sqrt(length) - *reference;
}

PLAIN void plain_ordinary(Plain *plain)
{
  const double *volume = plain->volume, bulk = 100000, shear = 60000;
  const Rows *rows = &plain->rows;
  double *base = plain->state, reference, y[3];
  for (size_t i = 0; i < plain->count; ++i) {
    double sum = 0;
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      const size_t j = (size_t)rows->neighbour[b];
      const double elongation = plain_elongation(plain, i, j, y, &reference);
      sum += volume[j] * reference * elongation;
    }
    base[i] = 3 * sum * (3 * bulk - 5 * shear) / (plain->moment[i] * plain->moment[i]);
  }
  for (size_t i = 0; i < plain->count; ++i) {
    double force[3] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      const size_t j = (size_t)rows->neighbour[b];
      const double elongation = plain_elongation(plain, i, j, y, &reference);
      const double pull =
          volume[j] *
          ((base[i] + base[j]) * reference + 15 * shear * (1 / plain->moment[i] + 1 / plain->moment[j]) * elongation) /
          (reference + elongation);
      for (int c = 0; c < 3; ++c) force[c] += pull * y[c];
    }
    for (int c = 0; c < 3; ++c) plain->force[3 * i + (size_t)c] = force[c];
  }
}

PLAIN void plain_correspondence(Plain *plain)
{
  const double *x = plain->x, *u = plain->u, *volume = plain->volume, lambda = 60000, shear = 60000;
  const Rows *rows = &plain->rows;
  double *q = plain->state;
  for (size_t i = 0; i < plain->count; ++i) {
    double g[9] = {0}, grad[9], s[9];
    const double *k = plain->inverse + 6 * i;
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      size_t j = (size_t)rows->neighbour[b];
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          g[3 * c + e] +=
              volume[j] * (u[3 * j + (size_t)c] - u[3 * i + (size_t)c]) * (x[3 * j + (size_t)e] - x[3 * i + (size_t)e]);
    }
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e)
        grad[3 * c + e] = g[3 * c] * k[symmetric_place[e]] + g[3 * c + 1] * k[symmetric_place[3 + e]] +
                          g[3 * c + 2] * k[symmetric_place[6 + e]];
    double trace = lambda * (grad[0] + grad[4] + grad[8]);
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e) s[3 * c + e] = shear * (grad[3 * c + e] + grad[3 * e + c]) + (c == e ? trace : 0);
    for (int c = 0; c < 3; ++c)
      for (int e = 0; e < 3; ++e)
        q[9 * i + (size_t)(3 * c + e)] = s[3 * c] * k[symmetric_place[e]] + s[3 * c + 1] * k[symmetric_place[3 + e]] +
                                         s[3 * c + 2] * k[symmetric_place[6 + e]];
  }
  for (size_t i = 0; i < plain->count; ++i) {
    double force[3] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      size_t j = (size_t)rows->neighbour[b];
      double xi[3] = {x[3 * j] - x[3 * i], x[3 * j + 1] - x[3 * i + 1], x[3 * j + 2] - x[3 * i + 2]};
      for (int c = 0; c < 3; ++c)
        for (int e = 0; e < 3; ++e)
          force[c] += volume[j] * (q[9 * i + (size_t)(3 * c + e)] + q[9 * j + (size_t)(3 * c + e)]) * xi[e];
    }
    for (int c = 0; c < 3; ++c) plain->force[3 * i + (size_t)c] = force[c];
  }
}

/** Angle over sine, of the square of the sine. */
static inline double angle_share(double square)
{
  return 1 + square * (1.0 / 6 + square * (3.0 / 40 + square * (5.0 / 112 + square * 35.0 / 1152)));
}

PLAIN static void plain_links_of_the_plane(Plain *plain)
{
  const double *x = plain->x, *u = plain->u, axial = 1e9, bending = 1e3;
  const Rows *rows = &plain->rows;
  for (size_t i = 0; i < plain->count; ++i) {
    const double *r = plain->turned + 4 * i;
    double force[3] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      const size_t j = (size_t)rows->neighbour[b];
      const double *q = plain->turned + 4 * j;
      const double xi[2] = {x[3 * j] - x[3 * i], x[3 * j + 1] - x[3 * i + 1]},
                   y[2] = {xi[0] + u[3 * j] - u[3 * i], xi[1] + u[3 * j + 1] - u[3 * i + 1]};
      const double length = sqrt(xi[0] * xi[0] + xi[1] * xi[1]), present = sqrt(y[0] * y[0] + y[1] * y[1]),
                   n[2] = {xi[0] / length, xi[1] / length}, m[2] = {y[0] / present, y[1] / present};
      const double here = m[0] * (r[1] * n[0] + r[0] * n[1]) - m[1] * (r[0] * n[0] - r[1] * n[1]),
                   there = m[0] * (q[1] * n[0] + q[0] * n[1]) - m[1] * (q[0] * n[0] - q[1] * n[1]);
      const double own = here * angle_share(here * here), other = there * angle_share(there * there);
      const double pull = plain->volume[j] * axial * (present - length) / length,
                   stiff = plain->volume[j] * bending / length, shear = 6 * stiff * (own + other) / present;
      force[0] += pull * m[0] + shear * m[1];
      force[1] += pull * m[1] - shear * m[0];
      force[2] -= stiff * (4 * own + 2 * other);
    }
    for (int c = 0; c < 3; ++c) plain->force[3 * i + (size_t)c] = force[c];
  }
}

static inline void cross(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; ++k) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static inline double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

PLAIN static void plain_links_of_space(Plain *plain)
{
  const double *x = plain->x, *u = plain->u, axial = 1e9, bending = 1e3, twist = 1e3;
  const Rows *rows = &plain->rows;
  for (size_t i = 0; i < plain->count; ++i) {
    double sum[6] = {0};
    for (int64_t b = rows->first[i]; b < rows->first[i + 1]; ++b) {
      const size_t ends[2] = {i, (size_t)rows->neighbour[b]};
      double n[3], m[3], sine[2][3], arrow[2][3], share[2], bend[2], length = 0, present = 0;
      for (size_t c = 0; c < 3; ++c) {
        n[c] = x[3 * ends[1] + c] - x[3 * i + c];
        m[c] = n[c] + u[3 * ends[1] + c] - u[3 * i + c];
        length += n[c] * n[c];
        present += m[c] * m[c];
      }
      length = sqrt(length);
      present = sqrt(present);
      for (int c = 0; c < 3; ++c) {
        n[c] /= length;
        m[c] /= present;
      }
      for (int e = 0; e < 2; ++e) {
        const double *q = plain->turned + 4 * ends[e];
        double once[3], twice[3];
        cross(q + 1, n, once);
        cross(q + 1, once, twice);
        for (int c = 0; c < 3; ++c) arrow[e][c] = n[c] + 2 * (q[0] * once[c] + twice[c]);
        cross(m, arrow[e], sine[e]);
        const double square = dot(sine[e], sine[e]);
        share[e] = angle_share(square);
        bend[e] = 1.0 / 3 + square * (2.0 / 15 + square * 8.0 / 105);
      }
      const double *q = plain->turned + 4 * i, *r = plain->turned + 4 * ends[1];
      const double stiff = plain->volume[ends[1]] * bending / length, both = dot(sine[0], sine[1]);
      double spin[2][3], turn[3], across[3];
      cross(q + 1, r + 1, turn);
      for (int c = 0; c < 3; ++c) turn[c] += q[0] * r[1 + c] - r[0] * q[1 + c];
      const double torque = plain->volume[ends[1]] * twist / length * 2 * dot(m, turn);
      cross(turn, m, across);
      for (int e = 0; e < 2; ++e) {
        const double own = stiff * (4 * share[e] + 2 * bend[e] * share[1 - e] * both),
                     other = 2 * stiff * share[1 - e] * (1 - bend[e] * dot(sine[e], sine[e])),
                     along = 2 * stiff * share[0] * share[1] * dot(arrow[e], sine[1 - e]) +
                             (e ? -torque : torque) * (q[0] * r[0] + dot(q + 1, r + 1));
        for (int c = 0; c < 3; ++c)
          spin[e][c] = own * sine[e][c] + other * sine[1 - e][c] + torque * across[c] - along * m[c];
      }
      for (int c = 0; c < 3; ++c) turn[c] = spin[0][c] + spin[1][c];
      cross(m, turn, across);
      const double pull = plain->volume[ends[1]] * axial * (present - length) / length;
      for (int c = 0; c < 3; ++c) {
        sum[c] += pull * m[c] + across[c] / present;
        sum[3 + c] -= spin[0][c];
      }
    }
    for (int c = 0; c < 3; ++c) {
      plain->force[3 * i + (size_t)c] = sum[c];
      plain->state[3 * i + (size_t)c] = sum[3 + c];
    }
  }
}

void plain_links(Plain *plain)
{
  if (plain->dimensions == 2)
    plain_links_of_the_plane(plain);
  else
    plain_links_of_space(plain);
}

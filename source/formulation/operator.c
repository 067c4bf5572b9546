#include "formulation/operator.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void operator_clear(Operator *point)
{
  OperatorPlace *places = point->places;
  const int capacity = point->capacity;
  memset(point, 0, offsetof(Operator, force)); /* what is of links only is filled whole */
  point->places = places;
  point->capacity = capacity;
  point->motions = 3;
}

void operator_destroy(Operator *point)
{
  free(point->places);
  *point = (Operator){0};
}

OperatorPlace *operator_add(Operator *point, int64_t place, Error *error)
{
  if (point->count == point->capacity) {
    const int wanted = point->capacity ? 2 * point->capacity : 128;
    OperatorPlace *grown = memory_grown(point->places, (size_t)wanted, sizeof *grown);
    if (!grown) {
      error_add(error, BRECCIA_FAILURE, "out of memory: operator of a point");
      return NULL;
    }
    point->places = grown;
    point->capacity = wanted;
  }
  OperatorPlace *new = &point->places[point->count++];
  *new = (OperatorPlace){.place = (int32_t)place};
  return new;
}

void operator_close(Operator *point)
{
  OperatorPlace *first = &point->places[0];
  for (int k = 0; k < 3; ++k) {
    first->g[k] = first->second[k] = 0;
    for (int l = 1; l < point->count; ++l) {
      first->g[k] -= point->places[l].g[k];
      first->second[k] -= point->places[l].second[k];
    }
  }
}

void operator_gradient(const Operator *point, double *const u[3], double g[9])
{
  memset(g, 0, 9 * sizeof *g);
  for (int l = 0; l < point->count; ++l)
    for (int k = 0; k < 9; ++k) g[k] += u[k / 3][point->places[l].place] * point->places[l].g[k % 3];
}

/** F at displacements u; I where strains are small. */
static void deformation(const Operator *point, double *const u[3], double f[9])
{
  memset(f, 0, 9 * sizeof *f);
  if (point->finite) operator_gradient(point, u, f);
  for (int k = 0; k < 3; ++k) f[4 * k] += 1;
}

/** Vectors by which the stress acts on a place. */
static const double *acting(const Operator *point, int l)
{
  return point->acts_apart ? point->places[l].act : point->places[l].g;
}

/** The matrix from a displacement of place l, by its vector g, to the strain; rows beyond the point's components are not filled. */
static void strain_matrix(const Operator *point, const double f[9], int l, const double g[3], double b[6][3])
{
  if (point->components < 6) {
    memcpy(b[0], g, 3 * sizeof *g);
    memcpy(b[1], point->places[l].second, 3 * sizeof *g);
    return;
  }
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 3; ++i) {
      const int r = symmetric_row[k], s = symmetric_column[k];
      b[k][i] = (f[3 * i + r] * g[s] + f[3 * i + s] * g[r]) * (k < 3 ? 0.5 : 1);
    }
}

void operator_strain(const Operator *point, double *const u[3], double *const v[3], double strain[6])
{
  double f[9], b[6][3];
  memset(strain, 0, 6 * sizeof *strain);
  deformation(point, u, f);
  for (int l = 0; l < point->count; ++l) {
    const int32_t place = point->places[l].place;
    strain_matrix(point, f, l, point->places[l].g, b);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < point->components; ++k) strain[k] += b[k][i] * v[i][place];
  }
}

/** K g of place l. */
static void shaped(const Operator *point, int l, double kg[3])
{
  for (int i = 0; i < 3; ++i) {
    kg[i] = 0;
    for (int j = 0; j < 3; ++j) kg[i] += point->shape[symmetric_place[3 * i + j]] * point->places[l].g[j];
  }
}

static bool is_link(const Operator *point)
{
  return point->motions > 3;
}

/** Change of the forces of one end of a link with motions of an end. */
static void stiffness_of_link(const Operator *point, int a, int b, double *k)
{
  const int n = point->motions;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      k[n * row + column] = point->stiffness[2 * n * (n * a + row) + n * b + column];
}

void operator_add_forces(const Operator *point, double *const u[3], double *const force[3])
{
  for (int row = 0; row < 2 * point->motions && is_link(point); ++row)
    force[row % point->motions][point->places[row / point->motions].place] += point->force[row];
  if (is_link(point)) return;
  double g[9], f[9], b[6][3], kg[3], held[9];
  operator_gradient(point, u, g);
  deformation(point, u, f);
  for (int k = 0; k < 9; ++k) { /* C G */
    held[k] = 0;
    for (int j = 0; j < 3; ++j) held[k] += point->hold[symmetric_place[k / 3 * 3 + j]] * g[3 * j + k % 3];
  }
  for (int l = 0; l < point->count; ++l) {
    const OperatorPlace *p = &point->places[l];
    strain_matrix(point, f, l, acting(point, l), b);
    shaped(point, l, kg);
    for (int i = 0; i < 3; ++i) {
      double sum = 0;
      for (int k = 0; k < point->components; ++k) sum -= point->stress[k] * b[k][i];
      for (int j = 0; j < 3; ++j) sum += held[3 * i + j] * kg[j];
      force[i][p->place] += point->volume * sum - p->pull[i];
      force[i][point->places[0].place] += p->pull[i];
    }
  }
}

/** Stiffness of place l against the first one: the spring's, and what comes from the turning of g. */
static void against_first(const Operator *point, int l, double k[9])
{
  const OperatorPlace *p = &point->places[l];
  double square = 0;
  for (int i = 0; i < 3; ++i) square += p->g[i] * p->g[i];
  const double turn = point->components < 6 ? point->volume * point->stress[0] * p->turn : 0;
  for (int c = 0; c < 9; ++c) {
    k[c] = p->spring[symmetric_place[c]] + (c % 4 == 0 ? turn : 0);
    if (turn != 0) k[c] -= turn * p->g[c / 3] * p->g[c % 3] / square;
  }
}

/** What the stiffness of a place needs. */
typedef struct Prepared {
  double b[6][3],
      tangent_b[6][3]; /* from stress to its force, but for the volume, and from its displacement to stress */
  double stress_g[3], kg[3];
} Prepared;

static void prepare(const Operator *point, const double f[9], int l, Prepared *p)
{
  const int n = point->components;
  double b[6][3];
  memset(p, 0, sizeof *p);
  strain_matrix(point, f, l, acting(point, l), p->b);
  strain_matrix(point, f, l, point->places[l].g, b);
  for (int r = 0; r < n; ++r)
    for (int s = 0; s < n; ++s)
      for (int i = 0; i < 3; ++i) p->tangent_b[r][i] += point->tangent[n * r + s] * b[s][i];
  shaped(point, l, p->kg);
  for (int i = 0; i < 3 && n == 6 && point->finite; ++i)
    for (int j = 0; j < 3; ++j) p->stress_g[i] += point->stress[symmetric_place[3 * i + j]] * point->places[l].g[j];
}

/** Through the point: by its law, its stress and the control. */
static void through_point(const Operator *point, const Prepared *a, const double g[3], const Prepared *b, double k[9])
{
  double along = 0, across = 0;
  for (int i = 0; i < 3; ++i) {
    along += g[i] * b->stress_g[i];
    across += g[i] * b->kg[i];
  }
  for (int c = 0; c < 9; ++c) {
    double sum = 0;
    for (int r = 0; r < point->components; ++r) sum += a->b[r][c / 3] * b->tangent_b[r][c % 3];
    k[c] = point->volume * (point->hold[symmetric_place[c]] * across - (c % 4 == 0 ? along : 0) - sum);
  }
}

static void add(double *to, const double *from, double factor)
{
  for (int c = 0; c < 9; ++c) to[c] += factor * from[c];
}

void operator_stiffness(const Operator *point, double *const u[3], int a, int b, double *k)
{
  if (is_link(point)) {
    stiffness_of_link(point, a, b, k);
    return;
  }
  Prepared pa, pb;
  double f[9], part[9];
  deformation(point, u, f);
  prepare(point, f, a, &pa);
  prepare(point, f, b, &pb);
  through_point(point, &pa, acting(point, a), &pb, k);
  for (int l = 1; l < point->count; ++l) {
    const bool both = (a == l || !a) && (b == l || !b);
    if (!both) continue;
    against_first(point, l, part);
    add(k, part, a == b ? -1 : 1);
  }
}

int operator_matrix(const Operator *point, double *const u[3], double *k, Error *error)
{
  const int count = point->count;
  double f[9], part[9];
  for (int block = 0; block < count * count && is_link(point); ++block)
    stiffness_of_link(point, block / count, block % count, k + point->motions * point->motions * block);
  if (is_link(point)) return BRECCIA_OK;
  Prepared *all = memory_plain((size_t)(count + 1), sizeof *all);
  if (!all) return error_add(error, BRECCIA_FAILURE, "out of memory: operator of a point");
  deformation(point, u, f);
  for (int l = 0; l < count; ++l) prepare(point, f, l, &all[l]);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b)
      through_point(point, &all[a], acting(point, a), &all[b], k + 9 * ((int64_t)count * a + b));
  for (int l = 1; l < count; ++l) {
    against_first(point, l, part);
    add(k, part, -1);
    add(k + 9 * ((int64_t)count * l + l), part, -1);
    add(k + 9 * l, part, 1);
    add(k + 9 * ((int64_t)count * l), part, 1);
  }
  free(all);
  return BRECCIA_OK;
}

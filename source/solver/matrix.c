#include "solver/matrix.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *matrix_refusal(const Unknowns *u)
{
  if (u->domain->region_count > 1) return "bonds between regions have no operators";
  for (int l = 0; l < u->loading->count; ++l) {
    const Load *load = &u->loading->loads[l];
    if (load->type->change && load_acts(u->loading, load)) return "springs are not in it yet";
  }
  return NULL;
}

/* ---- how displacements follow from unknowns ---- */

/** Directions in which a particle is held, and, behind them, those in which it is free. */
typedef struct Held {
  int held, free;
  double direction[3][3];
} Held;

typedef struct Numbering {
  Matrix *matrix;
  const Unknowns *unknowns;
  int64_t *which; /* [places] index of a particle that is held anywhere, plus 1 */
  Held *held;
  int64_t held_count;
} Numbering;

static void mark(Numbering *of, int32_t i)
{
  if (!of->which[i]) of->which[i] = ++of->held_count;
}

static void hold(Numbering *of, int32_t i, const double direction[3])
{
  Held *h = &of->held[of->which[i] - 1];
  for (int m = 0; m < h->held; ++m) {
    const double *d = h->direction[m];
    if (fabs(d[0] * direction[0] + d[1] * direction[1] + d[2] * direction[2]) > 0.5) return; /* twice the same way */
  }
  memcpy(h->direction[h->held++], direction, 3 * sizeof *direction);
}

static void mark_row(const Constraint *c, int64_t n, void *context)
{
  mark(context, c->load->selection.places[n]);
}

static void hold_row(const Constraint *c, int64_t n, void *context)
{
  hold(context, c->load->selection.places[n], c->direction);
}

/** Calls for each particle that follows another one along an axis. */
static void each_tie(Numbering *of, void (*one)(Numbering *of, int32_t follower, int32_t leader, int axis))
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &of->unknowns->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n)
        one(of, ties->places[n], ties->places[ties->first[g]], k);
  }
}

static void mark_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  (void)leader, (void)axis;
  mark(of, follower);
}

static void hold_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  (void)leader;
  hold(of, follower, (const double[]){axis == 0, axis == 1, axis == 2});
}

static void follow_tie(Numbering *of, int32_t follower, int32_t leader, int axis)
{
  of->matrix->follow[3 * follower + axis] = of->matrix->follow[3 * leader + axis];
}

/** Directions across those that are held, of the axes along which the body extends: those that differ from them most come first. */
static void find_free(const Unknowns *u, Held *h)
{
  int left = -h->held;
  for (int k = 0; k < 3; ++k) left += !u->flat[k];
  for (; h->free < left; ++h->free) {
    double best = 0, chosen[3] = {0};
    for (int k = 0; k < 3; ++k) {
      double v[3] = {k == 0, k == 1, k == 2}, square = 0;
      for (int m = 0; m < h->held + h->free; ++m) {
        const double *d = h->direction[m], along = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        for (int j = 0; j < 3; ++j) v[j] -= along * d[j];
      }
      for (int j = 0; j < 3; ++j) square += v[j] * v[j];
      if (u->flat[k] || square < best + 1e-6) continue;
      best = square;
      for (int j = 0; j < 3; ++j) chosen[j] = v[j] / sqrt(square);
    }
    memcpy(h->direction[h->held + h->free], chosen, sizeof chosen);
  }
}

static void add_term(Follow *follow, int64_t unknown, double factor)
{
  for (int t = 0; t < follow->count; ++t)
    if (follow->unknown[t] == unknown) {
      follow->factor[t] += factor;
      return;
    }
  if (factor == 0 || follow->count == MOST_TERMS) return;
  follow->unknown[follow->count] = unknown;
  follow->factor[follow->count++] = factor;
}

/** Unknowns of a particle of its own. */
static void follow_own(Numbering *of, int32_t i)
{
  Matrix *m = of->matrix;
  Follow *own = &m->follow[3 * (int64_t)i];
  const Held *h = of->which[i] ? &of->held[of->which[i] - 1] : NULL;
  for (int k = 0; k < 3 && !h; ++k)
    if (!of->unknowns->flat[k]) add_term(&own[k], m->size++, 1);
  for (int f = 0; h && f < h->free; ++f, ++m->size)
    for (int k = 0; k < 3; ++k) add_term(&own[k], m->size, h->direction[h->held + f][k]);
}

/** Adds what a displacement of `from` along a direction is, times a share, to that of `own` along it. */
static void add_along(Follow *own, const Follow *from, const double direction[3], double share)
{
  Follow copy[3] = {from[0], from[1], from[2]};
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int t = 0; t < copy[j].count; ++t)
        add_term(&own[k], copy[j].unknown[t], share * direction[k] * direction[j] * copy[j].factor[t]);
}

static void follow_row(const Constraint *c, int64_t n, void *context)
{
  Follow *follow = ((Numbering *)context)->matrix->follow, *own = &follow[3 * (int64_t)c->load->selection.places[n]];
  add_along(own, own, c->direction, -1);
  if (c->images) add_along(own, &follow[3 * (int64_t)c->images[n]], c->direction, c->share);
}

static int number_unknowns(Matrix *m, const Unknowns *u, Error *error)
{
  const Particles *p = u->domain->particles;
  Numbering of = {.matrix = m, .unknowns = u};
  m->follow = memory_zeroed(3 * (size_t)p->places, sizeof *m->follow, "unknowns", error);
  of.which = memory_zeroed((size_t)p->places, sizeof *of.which, "unknowns", error);
  int status = m->follow && of.which ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) {
    unknowns_each_row(u, mark_row, &of);
    each_tie(&of, mark_tie);
    of.held = memory_zeroed((size_t)of.held_count + 1, sizeof *of.held, "unknowns", error);
    if (!of.held) status = BRECCIA_FAILURE;
  }
  if (!status) {
    unknowns_each_row(u, hold_row, &of);
    each_tie(&of, hold_tie);
    for (int64_t n = 0; n < of.held_count; ++n) find_free(u, &of.held[n]);
    for (int64_t n = 0; n < p->count; ++n) follow_own(&of, p->place_of[n]);
    each_tie(&of, follow_tie);
    for (int64_t i = 0; i < 3 * p->places; ++i) m->follow[i].own = m->follow[i].count;
    unknowns_each_row(u, follow_row, &of);
  }
  free(of.which);
  free(of.held);
  return status;
}

/* ---- which entries there are ---- */

/** Lists with a first entry each, in one array. */
typedef struct Lists {
  int64_t *first; /* [count + 1] */
  int64_t *items;
} Lists;

static void lists_free(Lists *lists)
{
  free(lists->first);
  free(lists->items);
}

/** Places of every point. */
static int list_places(Lists *of, const Region *region, Error *error)
{
  const int64_t points = region->type->point_count(region->formulation);
  Operator point = {0};
  int64_t capacity = 0;
  int status = BRECCIA_OK;
  of->first = memory_zeroed((size_t)points + 1, sizeof *of->first, "matrix", error);
  if (!of->first) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < points && !status; ++n) {
    status = region->type->point(region->formulation, n, &point, error);
    const int64_t end = of->first[n] + point.count;
    if (end > capacity) {
      capacity = 2 * end + 1024;
      int64_t *grown = memory_grown(of->items, (size_t)capacity, sizeof *grown);
      if (!grown) status = error_add(error, BRECCIA_FAILURE, "out of memory: matrix");
      if (grown) of->items = grown;
    }
    for (int l = 0; l < point.count && !status; ++l) of->items[of->first[n] + l] = point.places[l].place;
    of->first[n + 1] = end;
  }
  operator_destroy(&point);
  return status;
}

/** Turns lists round: of each of `count` items the lists that have it. */
static int turn_round(const Lists *of, int64_t lists, int64_t count, Lists *back, Error *error)
{
  back->first = memory_zeroed((size_t)count + 2, sizeof *back->first, "matrix", error);
  back->items = memory_zeroed((size_t)of->first[lists] + 1, sizeof *back->items, "matrix", error);
  if (!back->first || !back->items) return BRECCIA_FAILURE;
  for (int64_t t = 0; t < of->first[lists]; ++t) ++back->first[of->items[t] + 2];
  for (int64_t i = 0; i < count; ++i) back->first[i + 2] += back->first[i + 1];
  for (int64_t n = 0; n < lists; ++n)
    for (int64_t t = of->first[n]; t < of->first[n + 1]; ++t) back->items[back->first[of->items[t] + 1]++] = n;
  return BRECCIA_OK;
}

static int compare_columns(const void *a, const void *b)
{
  const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

typedef struct Rows {
  Matrix *matrix;
  Lists of_points, of_places, of_unknowns; /* places of points, points of places, places of unknowns */
  int64_t *seen_place, *seen_column;       /* last row that has met it, plus 1 */
  int64_t count, capacity;
} Rows;

static int add_column(Rows *rows, int64_t row, int64_t column, Error *error)
{
  Matrix *m = rows->matrix;
  if (rows->seen_column[column] == row + 1) return BRECCIA_OK;
  rows->seen_column[column] = row + 1;
  if (rows->count == rows->capacity) {
    rows->capacity = 2 * rows->capacity + 4096;
    int64_t *grown = memory_grown(m->column, (size_t)rows->capacity, sizeof *grown);
    if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: matrix");
    m->column = grown;
  }
  m->column[rows->count++] = column;
  return BRECCIA_OK;
}

/** Columns of a row: the unknowns of all places that share a point with one of its own. */
static int find_row(Rows *rows, int64_t row, Error *error)
{
  const Matrix *m = rows->matrix;
  const Lists *own = &rows->of_unknowns;
  int status = add_column(rows, row, row, error);
  for (int64_t o = own->first[row]; o < own->first[row + 1]; ++o) {
    const int64_t place = own->items[o];
    for (int64_t t = rows->of_places.first[place]; t < rows->of_places.first[place + 1]; ++t) {
      const int64_t point = rows->of_places.items[t];
      for (int64_t l = rows->of_points.first[point]; l < rows->of_points.first[point + 1]; ++l) {
        const int64_t other = rows->of_points.items[l];
        if (rows->seen_place[other] == row + 1) continue;
        rows->seen_place[other] = row + 1;
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < m->follow[3 * other + k].count && !status; ++c)
            status = add_column(rows, row, m->follow[3 * other + k].unknown[c], error);
      }
    }
  }
  return status;
}

/** Places whose displacements follow from each unknown. */
static int list_owners(Rows *rows, int64_t places, Error *error)
{
  const Matrix *m = rows->matrix;
  Lists terms = {0};
  int64_t count = 0;
  for (int64_t i = 0; i < 3 * places; ++i) count += m->follow[i].own;
  terms.first = memory_zeroed((size_t)places + 1, sizeof *terms.first, "matrix", error);
  terms.items = memory_zeroed((size_t)count + 1, sizeof *terms.items, "matrix", error);
  int status = terms.first && terms.items ? BRECCIA_OK : BRECCIA_FAILURE;
  count = 0;
  for (int64_t i = 0; i < places && !status; ++i) {
    for (int k = 0; k < 3; ++k)
      for (int t = 0; t < m->follow[3 * i + k].own; ++t) terms.items[count++] = m->follow[3 * i + k].unknown[t];
    terms.first[i + 1] = count;
  }
  if (!status) status = turn_round(&terms, places, m->size, &rows->of_unknowns, error);
  lists_free(&terms);
  return status;
}

int matrix_create(Matrix *m, const Unknowns *u, Error *error)
{
  const Region *region = &u->domain->regions[0];
  const int64_t places = u->domain->particles->places, points = region->type->point_count(region->formulation);
  Rows rows = {.matrix = m};
  int status = number_unknowns(m, u, error);
  if (!status) status = list_places(&rows.of_points, region, error);
  if (!status) status = turn_round(&rows.of_points, points, places, &rows.of_places, error);
  if (!status) status = list_owners(&rows, places, error);
  m->first = memory_zeroed((size_t)m->size + 1, sizeof *m->first, "matrix", error);
  rows.seen_place = memory_zeroed((size_t)places, sizeof *rows.seen_place, "matrix", error);
  rows.seen_column = memory_zeroed((size_t)m->size + 1, sizeof *rows.seen_column, "matrix", error);
  if (!m->first || !rows.seen_place || !rows.seen_column) status = BRECCIA_FAILURE;
  for (int64_t row = 0; row < m->size && !status; ++row) {
    status = find_row(&rows, row, error);
    qsort(m->column + m->first[row], (size_t)(rows.count - m->first[row]), sizeof *m->column, compare_columns);
    m->first[row + 1] = rows.count;
  }
  if (!status && !(m->value = memory_zeroed((size_t)rows.count + 1, sizeof *m->value, "matrix", error)))
    status = BRECCIA_FAILURE;
  lists_free(&rows.of_points);
  lists_free(&rows.of_places);
  lists_free(&rows.of_unknowns);
  free(rows.seen_place);
  free(rows.seen_column);
  return status;
}

void matrix_destroy(Matrix *m)
{
  free(m->first);
  free(m->column);
  free(m->value);
  free(m->follow);
  *m = (Matrix){0};
}

/* ---- numbers ---- */

static double *entry(const Matrix *m, int64_t row, int64_t column)
{
  int64_t low = m->first[row], high = m->first[row + 1];
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (m->column[middle] <= column)
      low = middle;
    else
      high = middle;
  }
  return &m->value[low];
}

/** Adds a factor times what joins two displacements, 3 x 3 of them. */
static void add_block(Matrix *m, int64_t row_place, int64_t column_place, const double *k, double factor)
{
  const Follow *rows = &m->follow[3 * row_place], *columns = &m->follow[3 * column_place];
  for (int i = 0; i < 3; ++i)
    for (int t = 0; t < rows[i].own; ++t)
      for (int j = 0; j < 3; ++j)
        for (int s = 0; s < columns[j].count; ++s)
          *entry(m, rows[i].unknown[t], columns[j].unknown[s]) +=
              factor * rows[i].factor[t] * k[3 * i + j] * columns[j].factor[s];
}

static int fill_points(Matrix *m, const Domain *d, double factor, Error *error)
{
  const Region *region = &d->regions[0];
  const int64_t points = region->type->point_count(region->formulation);
  Operator point = {0};
  double *k = NULL;
  int room = 0, status = BRECCIA_OK;
  for (int64_t n = 0; n < points && !status; ++n) {
    status = region->type->point(region->formulation, n, &point, error);
    const int count = point.count;
    if (!status && count > room) {
      room = 2 * count;
      free(k);
      if (!(k = memory_zeroed(9 * (size_t)room * (size_t)room, sizeof *k, "matrix", error))) status = BRECCIA_FAILURE;
    }
    if (!status) status = operator_matrix(&point, d->particles->displacement, k, error);
    for (int a = 0; a < count && !status; ++a)
      for (int b = 0; b < count; ++b)
        add_block(m, point.places[a].place, point.places[b].place, k + 9 * (count * a + b), -factor);
  }
  operator_destroy(&point);
  free(k);
  return status;
}

int matrix_fill(Matrix *m, const Unknowns *u, double stiffness_share, double mass_factor, Error *error)
{
  const Particles *p = u->domain->particles;
  memset(m->value, 0, sizeof *m->value * (size_t)m->first[m->size]);
  const int status = fill_points(m, u->domain, 1 + stiffness_share, error);
  for (int64_t n = 0; n < p->count && !status && mass_factor != 0; ++n) {
    const int32_t i = p->place_of[n];
    const double mass = mass_factor * p->density[i] * p->volume[i];
    add_block(m, i, i, (const double[9]){mass, 0, 0, 0, mass, 0, 0, 0, mass}, 1);
  }
  return status;
}

double matrix_asymmetry(const Matrix *m)
{
  double most = 0, largest = 0;
  for (int64_t row = 0; row < m->size; ++row)
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) {
      largest = fmax(largest, fabs(m->value[t]));
      if (m->column[t] > row) most = fmax(most, fabs(m->value[t] - *entry(m, m->column[t], row)));
    }
  return largest > 0 ? most / largest : 0;
}

/* ---- vectors ---- */

void matrix_pack(const Matrix *m, const Unknowns *u, double *const v[3], double *x)
{
  memset(x, 0, sizeof *x * (size_t)m->size);
  for (int64_t i = 0; i < u->domain->particles->places; ++i)
    for (int k = 0; k < 3; ++k) {
      const Follow *follow = &m->follow[3 * i + k];
      for (int t = 0; t < follow->own; ++t) x[follow->unknown[t]] += follow->factor[t] * v[k][i];
    }
}

void matrix_unpack(const Matrix *m, const Unknowns *u, const double *x, double *const v[3])
{
  for (int64_t i = 0; i < u->domain->particles->places; ++i)
    for (int k = 0; k < 3; ++k) {
      const Follow *follow = &m->follow[3 * i + k];
      double sum = 0;
      for (int t = 0; t < follow->count; ++t) sum += follow->factor[t] * x[follow->unknown[t]];
      v[k][i] = sum;
    }
  unknowns_clear_rest(u, v);
}

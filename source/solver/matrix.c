#include "solver/matrix.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *matrix_refusal(const Unknowns *u)
{
  const int64_t most = 3000; /* rows and columns of one spring are all filled */
  const char *forces = forces_unassembled(&u->domain->forces);
  if (forces) return forces;
  for (int l = 0; l < u->loading->count; ++l) {
    const Load *load = &u->loading->loads[l];
    if (!load->type->change || !load_acts(u->loading, load)) continue;
    if (!load->type->point) return "a load that follows displacements has no place in it";
    if (load->selection.count + load->other.count > most && load->other.count)
      return "a spring joins so many particles that it would be full";
  }
  return NULL;
}

/* ---- points ---- */

/** What has points: a region, a load or a kind of forces. */
typedef struct Source {
  const Region *region;
  const Load *load;
  const ForcesType *forces;
  const void *own; /* of forces */
  int64_t count;
} Source;

/** @return sources in all; the n-th of them is written */
static int find_source(const Unknowns *u, int n, Source *source)
{
  const Domain *d = u->domain;
  int count = 0;
  for (int r = 0; r < d->region_count; ++r)
    if (count++ == n)
      *source = (Source){.region = &d->regions[r], .count = d->regions[r].type->point_count(d->regions[r].formulation)};
  for (int l = 0; l < u->loading->count; ++l) {
    const Load *load = &u->loading->loads[l];
    if (load->type->point && load_acts(u->loading, load) && count++ == n)
      *source = (Source){.load = load, .count = load->type->point_count(load)};
  }
  for (int k = 0; k < d->forces.count; ++k) {
    const ForcesType *type = d->forces.type[k];
    if (type->point && count++ == n)
      *source = (Source){.forces = type, .own = d->forces.own[k], .count = type->point_count(d->forces.own[k])};
  }
  return count;
}

static int find_point(const Source *source, const Unknowns *u, int64_t number, Operator *point, Error *error)
{
  if (source->forces) return source->forces->point(source->own, number, point, error);
  if (source->load) return source->load->type->point(source->load, u->domain->particles, number, point, error);
  return source->region->type->point(source->region->formulation, u->domain->linearised_at->row, number, point, error);
}

static int64_t count_points(const Unknowns *u)
{
  Source source;
  int64_t points = 0;
  for (int n = 0; n < find_source(u, n, &source); ++n) points += source.count;
  return points;
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
static int list_places(Lists *of, const Unknowns *u, Error *error)
{
  Operator point = {0};
  Source source;
  int64_t capacity = 0, all = 0;
  int status = BRECCIA_OK;
  of->first = memory_zeroed((size_t)count_points(u) + 1, sizeof *of->first, "matrix", error);
  if (!of->first) return BRECCIA_FAILURE;
  for (int s = 0; s < find_source(u, s, &source); ++s)
    for (int64_t n = 0; n < source.count && !status; ++n, ++all) {
      status = find_point(&source, u, n, &point, error);
      const int64_t end = of->first[all] + point.count;
      if (end > capacity) {
        capacity = 2 * end + 1024;
        int64_t *grown = memory_grown(of->items, (size_t)capacity, sizeof *grown);
        if (!grown) status = error_add(error, BRECCIA_FAILURE, "out of memory: matrix");
        if (grown) of->items = grown;
      }
      for (int l = 0; l < point.count && !status; ++l) of->items[of->first[all] + l] = point.places[l].place;
      of->first[all + 1] = end;
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
        const Follow *follow = &m->follow[m->motions * other];
        for (int k = 0; k < m->motions; ++k)
          for (int c = 0; c < follow[k].count && !status; ++c)
            status = add_column(rows, row, follow_terms(&follow[k])[c].unknown, error);
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
  for (int64_t i = 0; i < m->motions * places; ++i) count += m->follow[i].own;
  terms.first = memory_zeroed((size_t)places + 1, sizeof *terms.first, "matrix", error);
  terms.items = memory_zeroed((size_t)count + 1, sizeof *terms.items, "matrix", error);
  int status = terms.first && terms.items ? BRECCIA_OK : BRECCIA_FAILURE;
  count = 0;
  for (int64_t i = 0; i < places && !status; ++i) {
    const Follow *follow = &m->follow[m->motions * i];
    for (int k = 0; k < m->motions; ++k)
      for (int t = 0; t < follow[k].own; ++t) terms.items[count++] = follow_terms(&follow[k])[t].unknown;
    terms.first[i + 1] = count;
  }
  if (!status) status = turn_round(&terms, places, m->size, &rows->of_unknowns, error);
  lists_free(&terms);
  return status;
}

int matrix_create(Matrix *m, const Unknowns *u, Error *error)
{
  const int64_t places = m->places = u->domain->particles->places, points = count_points(u);
  Rows rows = {.matrix = m};
  m->motions = u->domain->particles->space.rows;
  m->follow = follow_create(u, &m->size, error);
  m->leader = m->follow ? follow_leaders(m->follow, m->motions, places, m->size, error) : NULL;
  int status = m->leader ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) status = list_places(&rows.of_points, u, error);
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
  free(m->leader);
  follow_destroy(&m->follow, m->motions * m->places);
  *m = (Matrix){0};
}

/* ---- numbers ---- */

static int64_t find_entry(const Matrix *m, int64_t row, int64_t column)
{
  int64_t low = m->first[row], high = m->first[row + 1];
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (m->column[middle] <= column)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/** Adds a factor times what joins two motions, size x size of them. */
static void add_block(Matrix *m, int64_t row_place, int64_t column_place, const double *k, int size, double factor)
{
  const Follow *rows = &m->follow[m->motions * row_place], *columns = &m->follow[m->motions * column_place];
  for (int i = 0; i < size; ++i)
    for (int t = 0; t < rows[i].own; ++t) {
      const Term row = follow_terms(&rows[i])[t];
      const int64_t end = m->first[row.unknown + 1];
      int64_t at = end - 1; /* the unknowns of a particle mostly stand side by side */
      for (int j = 0; j < size; ++j)
        for (int s = 0; s < columns[j].count; ++s) {
          const Term column = follow_terms(&columns[j])[s];
          at =
              at + 1 < end && m->column[at + 1] == column.unknown ? at + 1 : find_entry(m, row.unknown, column.unknown);
          m->value[at] += factor * row.factor * k[size * i + j] * column.factor;
        }
    }
}

/** Whether blocks of a point are linear in the vectors of each of their two places, and nothing else. */
static bool is_plain(const Operator *point)
{
  static const double none[6] = {0};
  if (point->components < 6 || memcmp(point->hold, none, sizeof none)) return false;
  for (int l = 0; l < point->count; ++l)
    if (memcmp(point->places[l].spring, none, sizeof none)) return false;
  return true;
}

/** Whether two places are where they were at first, or have gone the same way: the deformation of a point needs their displacements, too. */
static bool went_alike(const Operator *point, double *const u[3], int32_t a, int32_t b)
{
  return !point->finite || (u[0][a] == u[0][b] && u[1][a] == u[1][b] && u[2][a] == u[2][b]);
}

/** Makes one place of those that move alike, like particles of a level that are tied or images beyond a periodic face: a point then has fewer blocks by
 *  the square of that. Forces on images belong to nobody; what cannot move is left out where its displacement does not count. */
static void join_places(const Matrix *m, Operator *point, double *const u[3])
{
  if (!is_plain(point)) return;
  int count = 0;
  for (int l = 0; l < point->count; ++l) {
    OperatorPlace place = point->places[l];
    const int32_t leader = m->leader[place.place];
    if (leader < 0 && !point->finite) continue;
    if (!point->acts_apart) memcpy(place.act, place.g, sizeof place.act);
    if (leader >= 0 && leader != place.place && went_alike(point, u, leader, place.place)) {
      if (!follow_is_whole(m->follow, m->motions, place.place)) memset(place.act, 0, sizeof place.act);
      place.place = leader;
    }
    int n = 0;
    while (n < count && point->places[n].place != place.place) ++n;
    if (n == count)
      point->places[count++] = place;
    else
      for (int k = 0; k < 3; ++k) {
        point->places[n].g[k] += place.g[k];
        point->places[n].act[k] += place.act[k];
      }
  }
  point->acts_apart = true;
  point->count = count;
}

static int fill_points(Matrix *m, const Unknowns *u, double stiffness_share, Error *error)
{
  Operator point = {0};
  Source source;
  double *k = NULL;
  int room = 0, status = BRECCIA_OK;
  for (int s = 0; s < find_source(u, s, &source); ++s)
    for (int64_t n = 0; n < source.count && !status; ++n) {
      const double factor = source.region ? 1 + stiffness_share : 1;
      status = find_point(&source, u, n, &point, error);
      if (!status) join_places(m, &point, u->domain->linearised_at->row);
      const int count = point.count, size = point.motions, wanted = count * size;
      if (!status && wanted > room) {
        room = 2 * wanted;
        free(k);
        if (!(k = memory_zeroed((size_t)room * (size_t)room, sizeof *k, "matrix", error))) status = BRECCIA_FAILURE;
      }
      if (!status) status = operator_matrix(&point, u->domain->linearised_at->row, k, error);
      for (int a = 0; a < count && !status; ++a)
        for (int b = 0; b < count; ++b)
          add_block(m, point.places[a].place, point.places[b].place, k + (int64_t)size * size * (count * a + b), size,
                    -factor);
    }
  operator_destroy(&point);
  free(k);
  return status;
}

int matrix_fill(Matrix *m, const Unknowns *u, double stiffness_share, double mass_factor, Error *error)
{
  const Particles *p = u->domain->particles;
  memset(m->value, 0, sizeof *m->value * (size_t)m->first[m->size]);
  const int status = fill_points(m, u, stiffness_share, error);
  for (int64_t n = 0; n < p->count && !status && mass_factor != 0; ++n) {
    const int32_t i = p->place_of[n];
    double mass[MAX_ROWS * MAX_ROWS] = {0};
    for (int k = 0; k < p->space.rows; ++k)
      mass[(p->space.rows + 1) * k] = mass_factor * p->inertia.row[k][i] * p->volume[i];
    add_block(m, i, i, mass, p->space.rows, 1);
  }
  return status;
}

double matrix_asymmetry(const Matrix *m)
{
  double most = 0, largest = 0;
  for (int64_t row = 0; row < m->size; ++row)
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) {
      largest = fmax(largest, fabs(m->value[t]));
      if (m->column[t] > row) most = fmax(most, fabs(m->value[t] - m->value[find_entry(m, m->column[t], row)]));
    }
  return largest > 0 ? most / largest : 0;
}

/* ---- vectors ---- */

void matrix_pack(const Matrix *m, const Unknowns *u, const Vector *v, double *x)
{
  memset(x, 0, sizeof *x * (size_t)m->size);
  for (int64_t i = 0; i < u->domain->particles->places; ++i)
    for (int k = 0; k < m->motions; ++k) {
      const Follow *follow = &m->follow[m->motions * i + k];
      for (int t = 0; t < follow->own; ++t)
        x[follow_terms(follow)[t].unknown] += follow_terms(follow)[t].factor * v->row[k][i];
    }
}

void matrix_unpack(const Matrix *m, const Unknowns *u, const double *x, const Vector *v)
{
  for (int64_t i = 0; i < u->domain->particles->places; ++i)
    for (int k = 0; k < m->motions; ++k) {
      const Follow *follow = &m->follow[m->motions * i + k];
      double sum = 0;
      for (int t = 0; t < follow->count; ++t)
        sum += follow_terms(follow)[t].factor * x[follow_terms(follow)[t].unknown];
      v->row[k][i] = sum;
    }
  unknowns_clear_rest(u, v);
}

#include "solver/coarse_grid.h"

#include "base/linear.h"
#include "base/team.h"
#include "solver/coarse_element.h"
#include "solver/coarse_frame.h"
#include "solver/factors.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  CORNERS = 8,
  NEIGHBOURS = 14,     /* corners around a corner that are numbered no higher, itself the last */
  MOST_CORNERS = 1500, /* that have unknowns */
  MOST_DENSE = 300     /* unknowns of a matrix with a dense factor: a solution by the sparse one would take longer */
};
#define MOST_ELEMENTS 3e7 /* in the box, with and without particles */

/* Least elements in horizons; what is added to the diagonal, of itself, so that a body that nothing holds can be factored. */
static const double width = 4.0 / 3, added = 1e-6;

struct CoarseGrid {
  const Domain *domain;
  int axes;                   /* of unknowns at a corner */
  bool any_pose;              /* the axes of the grid turn with the body */
  double centre[3], frame[9]; /* origin of the axes of the grid [length]; [3][3] their unit vectors, one in each row */
  int elements[3], points[3];
  double low[3], size[3];
  int64_t element_count;      /* with particles */
  int32_t (*corner)[CORNERS]; /* [element_count] their numbers; bit k of the index: the farther one along axis k */
  int64_t *first;             /* [element_count + 1] */
  int32_t *place;             /* [particles] element by element */
  int32_t *element;           /* of the box: number of an element, or -1 */
  int64_t corner_count;
  int32_t (*touching)[CORNERS];     /* [corner_count] element times CORNERS + index of the corner in it, or -1 */
  double *parts;                    /* [element_count][CORNERS * 3] */
  const double *diagonal, *turning; /* as it was prepared */
  double *stiffness;                /* [corner_count][NEIGHBOURS][9], only while equations are made */
  Factors *factors;                 /* of the equations, without a dense factor */
  double *dense;                    /* factor of at most MOST_DENSE equations; NULL: there is none */
  int *dense_begin;                 /* [MOST_DENSE] its rows (base/linear.h) */
  /** Forces at the corners, overwritten by displacements [corner_count * axes]. */
  double *answer;
};

/* ---- laying it ---- */

/** Returns the coordinate of a position along an axis of the grid [length]. */
static double grid_coordinate(const CoarseGrid *g, int axis, const double position[3])
{
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += g->frame[3 * axis + k] * (position[k] - g->centre[k]);
  return sum;
}

/** Element of a particle, and where in it: 0 to 1 along each axis. */
static int64_t locate(const CoarseGrid *g, const double position[3], double at[3])
{
  int64_t number = 0;
  for (int k = 2; k >= 0; --k) {
    const double x = (grid_coordinate(g, k, position) - g->low[k]) / g->size[k];
    int n = (int)x;
    if (n >= g->elements[k]) n = g->elements[k] - 1;
    if (n < 0) n = 0;
    at[k] = x - n;
    number = number * g->elements[k] + n;
  }
  return number;
}

static int64_t locate_place(const CoarseGrid *g, int64_t i, double at[3])
{
  const Particles *p = g->domain->particles;
  return locate(g, (double[3]){p->position[0][i], p->position[1][i], p->position[2][i]}, at);
}

static int64_t corner_in_box(const CoarseGrid *g, int64_t element, int c)
{
  int64_t number = 0, n[3] = {element % g->elements[0], element / g->elements[0] % g->elements[1],
                              element / g->elements[0] / g->elements[1]};
  for (int k = 2; k >= 0; --k) number = number * g->points[k] + n[k] + (c >> k & 1);
  return number;
}

/** Divides the box of the body. @return elements in it */
static double divide(CoarseGrid *g, const double high[3], double size)
{
  double count = 1;
  for (int k = 0; k < 3; ++k) {
    /* The extent along turned axes has round-off, which must not decide on the number of elements. */
    const double extent = high[k] - g->low[k], number = fmax(1, floor(extent / size + (g->any_pose ? 1e-9 : 0)));
    g->elements[k] = (int)fmin(number, INT_MAX - 1);
    g->points[k] = g->elements[k] + 1;
    g->size[k] = extent > 1e-6 * size ? extent / g->elements[k] : size;
    count *= number;
  }
  return count;
}

static bool mark_corners(const CoarseGrid *g, int32_t *number, int64_t *count, Error *error)
{
  const int64_t all = (int64_t)g->points[0] * g->points[1] * g->points[2];
  uint8_t *used = memory_zeroed((size_t)all, 1, "coarse grid", error);
  *count = 0;
  if (!used) return false;
  for (int64_t e = 0; e < (int64_t)g->elements[0] * g->elements[1] * g->elements[2]; ++e)
    for (int c = 0; c < CORNERS && g->element[e] >= 0; ++c)
      if (c >> g->axes == 0) used[corner_in_box(g, e, c)] = 1;
  for (int64_t n = 0; n < all; ++n) {
    if (number) number[n] = used[n] ? (int32_t)*count : -1;
    *count += used[n];
  }
  free(used);
  return true;
}

/** Elements with particles, and how many particles each has. */
static bool mark_elements(CoarseGrid *g, Error *error)
{
  const Particles *p = g->domain->particles;
  const int64_t all = (int64_t)g->elements[0] * g->elements[1] * g->elements[2];
  double at[3];
  free(g->element);
  g->element = memory_zeroed((size_t)all, sizeof *g->element, "coarse grid", error);
  if (!g->element) return false;
  for (int64_t n = 0; n < p->count; ++n) ++g->element[locate_place(g, p->place_of[n], at)];
  g->element_count = 0;
  for (int64_t e = 0; e < all; ++e) g->element[e] = g->element[e] ? (int32_t)g->element_count++ : -1;
  return true;
}

/** Finds the bounds of the body along the axes of the grid [length].
 *  @param[out] high  upper bounds; the lower ones are in the grid */
static void grid_find_bounds(CoarseGrid *g, double high[3])
{
  const Particles *p = g->domain->particles;
  for (int k = 0; k < 3; ++k) {
    g->low[k] = INFINITY;
    high[k] = -INFINITY;
  }
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double position[3] = {p->position[0][i], p->position[1][i], p->position[2][i]};
    for (int k = 0; k < 3; ++k) {
      g->low[k] = fmin(g->low[k], grid_coordinate(g, k, position));
      high[k] = fmax(high[k], grid_coordinate(g, k, position));
    }
  }
}

/** The narrowest elements with which the grid has few enough corners. */
static bool choose_elements(CoarseGrid *g, Error *error)
{
  double high[3], size = width * g->domain->family.horizon;
  grid_find_bounds(g, high);
  for (;; size *= 1.1) {
    if (divide(g, high, size) > MOST_ELEMENTS) continue;
    if (!mark_elements(g, error) || !mark_corners(g, NULL, &g->corner_count, error)) return false;
    if (g->corner_count <= MOST_CORNERS) return true;
  }
}

static bool sort_particles(CoarseGrid *g, Error *error)
{
  const Particles *p = g->domain->particles;
  double at[3];
  g->first = memory_zeroed((size_t)g->element_count + 2, sizeof *g->first, "coarse grid", error);
  g->place = memory_zeroed((size_t)p->count, sizeof *g->place, "coarse grid", error);
  if (!g->first || !g->place) return false;
  for (int64_t n = 0; n < p->count; ++n) ++g->first[g->element[locate_place(g, p->place_of[n], at)] + 2];
  for (int64_t e = 0; e < g->element_count; ++e) g->first[e + 2] += g->first[e + 1];
  for (int64_t i = 0; i < p->places; ++i)
    if (p->number[i] >= 0) g->place[g->first[g->element[locate_place(g, i, at)] + 1]++] = (int32_t)i;
  return true;
}

static bool number_corners(CoarseGrid *g, Error *error)
{
  const int64_t all = (int64_t)g->points[0] * g->points[1] * g->points[2];
  int32_t *number = memory_zeroed((size_t)all, sizeof *number, "coarse grid", error);
  g->corner = memory_zeroed((size_t)g->element_count, sizeof *g->corner, "coarse grid", error);
  g->touching = memory_zeroed((size_t)g->corner_count, sizeof *g->touching, "coarse grid", error);
  g->parts = memory_zeroed((size_t)g->element_count * CORNERS * 3, sizeof(double), "coarse grid", error);
  const bool well = number && g->corner && g->touching && g->parts && mark_corners(g, number, &g->corner_count, error);
  if (well) memset(g->touching, -1, sizeof *g->touching * (size_t)g->corner_count);
  for (int64_t e = 0; well && e < (int64_t)g->elements[0] * g->elements[1] * g->elements[2]; ++e)
    for (int c = 0; c < 1 << g->axes && g->element[e] >= 0; ++c) {
      const int32_t at = number[corner_in_box(g, e, c)];
      g->corner[g->element[e]][c] = at;
      g->touching[at][c] = g->element[e] * CORNERS + c;
    }
  free(number);
  return well;
}

CoarseGrid *coarse_grid_create(const Domain *d, bool any_pose, Error *error)
{
  CoarseGrid *g = memory_zeroed(1, sizeof *g, "coarse grid", error);
  if (!g) return NULL;
  g->domain = d;
  g->axes = d->body.dimensions;
  g->any_pose = any_pose;
  for (int k = 0; k < 9; ++k) g->frame[k] = k % 4 == 0;
  if (any_pose) coarse_frame_find(d->particles, g->axes, g->centre, g->frame);
  g->factors = factors_create("coarse grid", error);
  if (!g->factors || !choose_elements(g, error) || !sort_particles(g, error) || !number_corners(g, error))
    coarse_grid_destroy(&g);
  return g;
}

void coarse_grid_destroy(CoarseGrid **grid)
{
  CoarseGrid *g = *grid;
  if (!g) return;
  factors_destroy(&g->factors);
  free(g->dense);
  free(g->dense_begin);
  free(g->answer);
  free(g->corner);
  free(g->first);
  free(g->place);
  free(g->element);
  free(g->touching);
  free(g->parts);
  free(g->stiffness);
  free(g);
  *grid = NULL;
}

size_t coarse_grid_bytes(const CoarseGrid *g)
{
  const size_t size = (size_t)(g->corner_count * g->axes);
  return factors_bytes(g->factors) + (g->dense ? size * (size * sizeof *g->dense + sizeof *g->dense_begin) : 0) +
         sizeof(int32_t) * (size_t)g->domain->particles->count +
         (size_t)g->element_count * (sizeof *g->corner + CORNERS * 3 * sizeof(double)) +
         (size_t)g->corner_count * sizeof *g->touching;
}

/* ---- its equations ---- */

/** Shares of the corners at a point of an element. */
static inline void interpolate(int axes, const double at[3], double share[CORNERS])
{
  share[0] = 1;
  for (int k = 0; k < axes; ++k)
    for (int c = 0; c < 1 << k; ++c) {
      share[c + (1 << k)] = share[c] * at[k];
      share[c] -= share[c + (1 << k)];
    }
}

/** Adds a stiffness between component r of corner a and component s of corner b of an element. */
static void add(CoarseGrid *g, int64_t e, int a, int r, int b, int s, double stiffness)
{
  int way = 0;
  for (int k = g->axes - 1; k >= 0; --k) way = 3 * way + (b >> k & 1) - (a >> k & 1) + 1;
  way -= g->axes == 3 ? 0 : g->axes == 2 ? -9 : -12; /* the corner itself is the 13th of 27 */
  if (way < NEIGHBOURS) g->stiffness[((int64_t)g->corner[e][a] * NEIGHBOURS + way) * 9 + 3 * r + s] += stiffness;
}

/** Adds the moduli of the particles of an element, weighted by their volumes.
 *  @param[in] factor  of the weights, with the reciprocal of the volume of an element
 *  @param[in,out] sum  moduli of the element */
static void grid_add_moduli(const CoarseGrid *g, int64_t e, double factor, bool linearised, ElementModuli *sum)
{
  for (int64_t n = g->first[e]; n < g->first[e + 1]; ++n) {
    const ElementModuli moduli = element_moduli(g->domain, g->place[n], linearised);
    sum->lame += factor * g->domain->particles->volume[g->place[n]] * moduli.lame;
    sum->shear += factor * g->domain->particles->volume[g->place[n]] * moduli.shear;
  }
}

/** Adds the moduli of the particles of an element to its corners, weighted by the volumes of the particles and by their
 *  shape functions. Round-off decides to which of two elements a particle on their border belongs; the sums at the
 *  corners do not depend on it.
 *  @param[in] factor  of the weights, with the reciprocal of the volume of an element
 *  @param[in,out] corner  [corner_count] moduli */
static void grid_add_moduli_at_corners(const CoarseGrid *g, int64_t e, double factor, bool linearised,
                                       ElementModuli *corner)
{
  for (int64_t n = g->first[e]; n < g->first[e + 1]; ++n) {
    double at[3], share[CORNERS];
    const ElementModuli moduli = element_moduli(g->domain, g->place[n], linearised);
    locate_place(g, g->place[n], at);
    interpolate(g->axes, at, share);
    for (int c = 0; c < 1 << g->axes; ++c) {
      const double weight = factor * g->domain->particles->volume[g->place[n]] * share[c];
      corner[g->corner[e][c]].lame += weight * moduli.lame;
      corner[g->corner[e][c]].shear += weight * moduli.shear;
    }
  }
}

/** Returns the moduli of an element from those at its corners. The elements that touch a corner share its moduli
 *  equally. */
static ElementModuli grid_moduli_of_corners(const CoarseGrid *g, int64_t e, const ElementModuli *corner)
{
  ElementModuli sum = {0};
  for (int c = 0; c < 1 << g->axes; ++c) {
    const int32_t at = g->corner[e][c];
    int touching = 0;
    for (int other = 0; other < CORNERS; ++other) touching += g->touching[at][other] >= 0;
    sum.lame += corner[at].lame / touching;
    sum.shear += corner[at].shear / touching;
  }
  return sum;
}

/** Returns the component (r, s), along the axes of the deck, of a 3 x 3 block of the stiffness.
 *  @param[in] block  [3][3] components along the axes of the grid */
static double grid_turn_back(const CoarseGrid *g, const double block[9], int r, int s)
{
  double sum = 0;
  for (int k = 0; k < g->axes; ++k)
    for (int l = 0; l < g->axes; ++l) sum += g->frame[3 * k + r] * block[3 * k + l] * g->frame[3 * l + s];
  return sum;
}

/** Adds the stiffness of an element to the equations of the grid.
 *  @param[in] unit    stiffness of an element for unit moduli, along the axes of the grid
 *  @param[in] moduli  of the element */
static void grid_add_element(CoarseGrid *g, int64_t e, const ElementStiffness *unit, ElementModuli moduli)
{
  const int axes = g->axes;
  for (int a = 0; a < 1 << axes; ++a)
    for (int b = 0; b < 1 << axes; ++b) {
      double block[9] = {0};
      for (int r = 0; r < axes; ++r)
        for (int s = 0; s < axes; ++s)
          block[3 * r + s] = moduli.lame * unit->lame[a * axes + r][b * axes + s] +
                             moduli.shear * unit->shear[a * axes + r][b * axes + s];
      for (int r = 0; r < axes; ++r)
        for (int s = 0; s < axes; ++s)
          add(g, e, a, r, b, s, g->any_pose ? grid_turn_back(g, block, r, s) : block[3 * r + s]);
    }
}

/** Adds the stiffness of all elements to the equations of the grid.
 *  @param[in] factor  of the stiffness
 *  @param[in] linearised  take the moduli of the linearised laws; otherwise the first ones
 *  @return BRECCIA_OK; BRECCIA_FAILURE without memory */
static int grid_add_elements(CoarseGrid *g, double factor, bool linearised, Error *error)
{
  ElementStiffness unit;
  double volume = 1;
  ElementModuli *corner =
      g->any_pose ? memory_zeroed((size_t)g->corner_count, sizeof *corner, "coarse grid", error) : NULL;
  if (g->any_pose && !corner) return BRECCIA_FAILURE;
  for (int k = 0; k < g->axes; ++k) volume *= g->size[k];
  element_stiffness(g->axes, g->size, &unit);
  for (int64_t e = 0; e < g->element_count && corner; ++e)
    grid_add_moduli_at_corners(g, e, factor / volume, linearised, corner);
  for (int64_t e = 0; e < g->element_count; ++e) {
    ElementModuli moduli = {0};
    if (corner)
      moduli = grid_moduli_of_corners(g, e, corner);
    else
      grid_add_moduli(g, e, factor / volume, linearised, &moduli);
    grid_add_element(g, e, &unit, moduli);
  }
  free(corner);
  return BRECCIA_OK;
}

/** A spring from a point of the grid to the ground. */
static void hold(CoarseGrid *g, const double position[3], const double direction[3], double stiffness)
{
  double at[3], share[CORNERS];
  const int32_t e = g->element[locate(g, position, at)];
  if (e < 0) return;
  interpolate(g->axes, at, share);
  for (int a = 0; a < 1 << g->axes; ++a)
    for (int b = 0; b < 1 << g->axes; ++b)
      for (int r = 0; r < g->axes; ++r)
        for (int s = 0; s < g->axes; ++s)
          if (direction[r] != 0 && direction[s] != 0)
            add(g, e, a, r, b, s, stiffness * direction[r] * direction[s] * share[a] * share[b]);
}

/** A held motion. Of a particle that mirrors another the plane between them is held where they move against each other; where they move alike
 *  nothing is. */
static void add_support(const Constraint *c, int64_t n, void *context)
{
  CoarseGrid *g = context;
  const Particles *p = g->domain->particles;
  const int32_t i = c->load->selection.places[n], image = c->images ? c->images[n] : i;
  double position[3];
  if (c->row) return; /* of a rotation */
  for (int k = 0; k < 3; ++k) position[k] = (p->position[k][i] + p->position[k][image]) / 2;
  if ((!c->images || c->share < 0) && isfinite(g->diagonal[image])) hold(g, position, c->direction, g->diagonal[image]);
}

/** Springs to the ground, by what the body as a whole feels of them, and masses. */
static int add_springs(CoarseGrid *g, const Unknowns *u, double mass_factor, Error *error)
{
  const Particles *p = g->domain->particles;
  Vector v = {0}, change = {0};
  const bool well =
      vector_create(&v, &p->space, "coarse grid", error) && vector_create(&change, &p->space, "coarse grid", error);
  for (int axis = 0; axis < g->axes && well; ++axis) {
    const double direction[3] = {axis == 0, axis == 1, axis == 2};
    vector_clear(&v);
    vector_clear(&change);
    for (int64_t n = 0; n < p->count; ++n) v.row[axis][p->place_of[n]] = 1;
    loading_change(u->loading, p, v.row, change.row);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      const double stiffness = p->volume[i] * (mass_factor * p->density[i] + fmax(0, -change.row[axis][i]));
      if (stiffness > 0)
        hold(g, (double[3]){p->position[0][i], p->position[1][i], p->position[2][i]}, direction, stiffness);
    }
  }
  vector_destroy(&v);
  vector_destroy(&change);
  return well ? BRECCIA_OK : BRECCIA_FAILURE;
}

/** Number of the neighbour of a corner, 0 .. NEIGHBOURS - 1, or -1. */
static int32_t neighbour(const CoarseGrid *g, int64_t corner, int way)
{
  const int off[3] = {way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1};
  for (int c = 0; c < 1 << g->axes; ++c) {
    if (g->touching[corner][c] < 0) continue;
    int other = 0;
    for (int k = 0; k < 3 && other >= 0; ++k) {
      const int at = (c >> k & 1) + off[k];
      other = at < 0 || at > 1 || (k >= g->axes && off[k]) ? -1 : other | at << k;
    }
    if (other >= 0) return g->corner[g->touching[corner][c] / CORNERS][other];
  }
  return -1;
}

/** The equations up to the diagonal, row by row. */
typedef struct CornerMatrix {
  int64_t *first, *column;
  double *value;
} CornerMatrix;

static void corner_matrix_fill(const CoarseGrid *g, const CornerMatrix *m)
{
  int64_t count = 0;
  for (int64_t n = 0; n < g->corner_count; ++n) {
    int32_t beside[NEIGHBOURS];
    for (int way = 0; way < NEIGHBOURS; ++way) beside[way] = neighbour(g, n, way);
    for (int r = 0; r < g->axes; ++r) {
      m->first[n * g->axes + r] = count;
      for (int way = 0; way < NEIGHBOURS; ++way)
        for (int s = 0; s < g->axes && beside[way] >= 0; ++s) {
          if (beside[way] == n && s > r) break;
          m->column[count] = beside[way] * g->axes + s;
          m->value[count++] =
              g->stiffness[(n * NEIGHBOURS + way) * 9 + 3 * r + s] * (beside[way] == n && s == r ? 1 + added : 1);
        }
    }
  }
  m->first[g->corner_count * g->axes] = count;
}

/** Makes the dense factor of a small matrix.
 *  @param[out] done  whether there is one: the matrix is small and positive definite */
static int coarse_grid_factor_dense(CoarseGrid *g, const CornerMatrix *m, size_t size, bool *done, Error *error)
{
  *done = false;
  if (size > MOST_DENSE) return BRECCIA_OK;
  free(g->dense);
  g->dense = memory_zeroed(size * size, sizeof *g->dense, "coarse grid", error);
  if (!g->dense_begin) g->dense_begin = memory_zeroed(MOST_DENSE, sizeof *g->dense_begin, "coarse grid", error);
  if (!g->dense || !g->dense_begin) return BRECCIA_FAILURE;
  for (size_t row = 0; row < size; ++row)
    for (int64_t n = m->first[row]; n < m->first[row + 1]; ++n)
      g->dense[row * size + (size_t)m->column[n]] = m->value[n];
  *done = linear_factor((int)size, g->dense, g->dense_begin);
  if (*done) return BRECCIA_OK;
  free(g->dense);
  g->dense = NULL;
  return BRECCIA_OK;
}

static int coarse_grid_factor(CoarseGrid *g, Error *error)
{
  const size_t size = (size_t)(g->corner_count * g->axes), most = size * (size_t)(NEIGHBOURS * g->axes);
  CornerMatrix m = {memory_zeroed(size + 1, sizeof *m.first, "coarse grid", error),
                    memory_reserved(most, sizeof *m.column, "coarse grid", error),
                    memory_reserved(most, sizeof *m.value, "coarse grid", error)};
  int status = m.first && m.column && m.value ? BRECCIA_OK : BRECCIA_FAILURE;
  bool indefinite, dense = false;
  if (!g->answer) g->answer = memory_zeroed(size, sizeof *g->answer, "coarse grid", error);
  if (!g->answer) status = BRECCIA_FAILURE;
  if (!status) {
    corner_matrix_fill(g, &m);
    status = coarse_grid_factor_dense(g, &m, size, &dense, error);
  }
  if (!status && !dense)
    status = factors_compute(g->factors, &(SparseMatrix){(int64_t)size, m.first, m.column, m.value}, true, &indefinite,
                             error);
  free(m.first);
  free(m.column);
  free(m.value);
  return status;
}

int coarse_grid_prepare(CoarseGrid *g, const Unknowns *u, const double *diagonal, const double *turning,
                        bool linearised, double stiffness_share, double mass_factor, Error *error)
{
  g->stiffness = memory_zeroed((size_t)g->corner_count * NEIGHBOURS * 9, sizeof(double), "coarse grid", error);
  if (!g->stiffness) return BRECCIA_FAILURE;
  g->diagonal = diagonal;
  g->turning = turning;
  int status = grid_add_elements(g, 1 + stiffness_share, linearised, error);
  unknowns_each_row(u, add_support, g);
  if (!status) status = add_springs(g, u, mass_factor, error);
  if (!status) status = coarse_grid_factor(g, error);
  free(g->stiffness);
  g->stiffness = NULL;
  return status;
}

/* ---- its answer ---- */

typedef struct Transfer {
  const CoarseGrid *grid;
  const Vector *f, *v;
  const double *answer;
} Transfer;

/** Rates of the shares of the corners along an axis, at a point of an element. */
static void slope(const CoarseGrid *g, const double at[3], int axis, double rate[CORNERS])
{
  for (int c = 0; c < 1 << g->axes; ++c) {
    rate[c] = (c >> axis & 1 ? 1 : -1) / g->size[axis];
    for (int k = 0; k < g->axes; ++k)
      if (k != axis) rate[c] *= c >> k & 1 ? at[k] : 1 - at[k];
  }
}

/** Whether a particle turns with the grid. */
static bool turns(const CoarseGrid *g, int32_t i)
{
  return g->turning && !isinf(g->turning[i]);
}

/** Shares of displacements of the corners in the k-th rotation: half of u_b,a - u_a,b. */
static void turn_shares(const CoarseGrid *g, const double at[3], int k, double share[CORNERS * 3])
{
  const int a = g->axes == 2 ? 0 : (k + 1) % 3, b = g->axes == 2 ? 1 : (k + 2) % 3;
  for (int c = 0; c < CORNERS * 3; ++c) share[c] = 0;
  slope(g, at, a, share + CORNERS * b);
  slope(g, at, b, share + CORNERS * a);
  for (int c = 0; c < CORNERS; ++c) {
    share[CORNERS * b + c] *= 0.5;
    share[CORNERS * a + c] *= -0.5;
  }
}

/** What moments on a particle give the corners of its element. */
static void gather_moments(const Transfer *t, int32_t i, const double at[3], double sum[CORNERS * 3])
{
  double share[CORNERS * 3];
  const VectorSpace *space = t->f->space;
  for (int k = space->rotation; k < space->rows; ++k) {
    turn_shares(t->grid, at, k - space->rotation, share);
    for (int c = 0; c < CORNERS * 3; ++c) sum[c] += share[c] * t->f->row[k][i];
  }
}

/** Its rotations by displacements of the corners. */
static void spread_turns(const Transfer *t, int32_t i, const double at[3], const double of[CORNERS * 3])
{
  double share[CORNERS * 3];
  const VectorSpace *space = t->v->space;
  for (int k = space->rotation; k < space->rows; ++k) {
    turn_shares(t->grid, at, k - space->rotation, share);
    for (int c = 0; c < CORNERS * 3; ++c) t->v->row[k][i] += share[c] * of[c];
  }
}

/** What the particles of an element give its corners. */
static void gather_element(void *context, int64_t e)
{
  const Transfer *t = context;
  const CoarseGrid *g = t->grid;
  double sum[CORNERS * 3] = {0};
  for (int64_t n = g->first[e]; n < g->first[e + 1]; ++n) {
    const int32_t i = g->place[n];
    double at[3], share[CORNERS];
    if (isinf(g->diagonal[i])) continue;
    locate_place(g, i, at);
    interpolate(g->axes, at, share);
    for (int k = 0; k < g->axes; ++k)
      for (int c = 0; c < 1 << g->axes; ++c) sum[CORNERS * k + c] += share[c] * t->f->row[k][i];
    if (turns(g, i)) gather_moments(t, i, at, sum);
  }
  memcpy(g->parts + e * CORNERS * 3, sum, sizeof sum);
}

static void gather_corner(void *context, int64_t n)
{
  const CoarseGrid *g = context;
  for (int k = 0; k < g->axes; ++k) {
    double sum = 0;
    for (int c = 0; c < 1 << g->axes; ++c) {
      const int32_t at = g->touching[n][c];
      if (at >= 0) sum += g->parts[(int64_t)(at / CORNERS) * CORNERS * 3 + CORNERS * k + at % CORNERS];
    }
    g->answer[n * g->axes + k] = sum;
  }
}

static void spread_element(void *context, int64_t e)
{
  const Transfer *t = context;
  const CoarseGrid *g = t->grid;
  double of[CORNERS * 3] = {0};
  for (int k = 0; k < g->axes; ++k)
    for (int c = 0; c < 1 << g->axes; ++c) of[CORNERS * k + c] = t->answer[(int64_t)g->corner[e][c] * g->axes + k];
  for (int64_t n = g->first[e]; n < g->first[e + 1]; ++n) {
    const int32_t i = g->place[n];
    double at[3], share[CORNERS];
    if (isinf(g->diagonal[i])) continue;
    locate_place(g, i, at);
    interpolate(g->axes, at, share);
    for (int k = 0; k < g->axes; ++k) {
      double sum = 0;
      for (int c = 0; c < 1 << g->axes; ++c) sum += share[c] * of[CORNERS * k + c];
      t->v->row[k][i] += sum;
    }
    if (turns(g, i)) spread_turns(t, i, at, of);
  }
}

void coarse_grid_correct(CoarseGrid *g, const Vector *f, const Vector *v)
{
  Transfer t = {g, f, v, NULL};
  team_each(g->element_count, gather_element, &t);
  team_each(g->corner_count, gather_corner, g);
  if (g->dense)
    linear_factor_solve((int)(g->corner_count * g->axes), g->dense, g->dense_begin, g->answer);
  else if (factors_solve(g->factors, g->answer, NULL))
    return;
  t.answer = g->answer;
  team_each(g->element_count, spread_element, &t);
}

#include "solver/preconditioner.h"

#include "base/random.h"
#include "base/team.h"
#include "solver/coarse_frame.h"
#include <math.h>
#include <string.h>

enum { PROBES = 3 };

int preconditioner_create(Preconditioner *m, const Domain *d, bool any_pose, Error *error)
{
  const Particles *p = d->particles;
  double axes[9];
  m->any_pose = any_pose;
  if (any_pose) coarse_frame_find(p, d->body.dimensions, m->centre, axes);
  m->diagonal = places_array(p->places, "preconditioner", error);
  if (m->diagonal && p->rotary) m->turning = places_array(p->places, "preconditioner", error);
  if (!m->diagonal || (p->rotary && !m->turning)) return BRECCIA_FAILURE;
  if (any_pose && p->rotary) return BRECCIA_OK;
  m->grid = coarse_grid_create(d, any_pose, error);
  return m->grid ? BRECCIA_OK : BRECCIA_FAILURE;
}

void preconditioner_destroy(Preconditioner *m)
{
  places_free(&m->diagonal);
  places_free(&m->turning);
  coarse_grid_destroy(&m->grid);
}

size_t preconditioner_bytes(const Preconditioner *m)
{
  return m->grid ? coarse_grid_bytes(m->grid) : 0;
}

/* ---- the diagonal ---- */

double preconditioner_probe(const Preconditioner *m, const LinearSolver *s, double phase, int row, int64_t place)
{
  const Particles *p = s->domain->particles;
  /* Radians over a horizon: enough for uncorrelated motions of neighbours, few enough for small round-off. */
  const double waves = 1000;
  double from[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    from[k] = p->position[k][place] - m->centre[k];
    square += from[k] * from[k];
  }
  const double r = sqrt(square), size = sin(waves * r / s->domain->family.horizon + phase);
  if (p->number[place] < 0) return 0;
  if (p->space.row[row].kind == ROW_ROTATION && p->space.rows == 4) return size; /* about the normal of the plane */
  return r > 0 ? size * from[row % 3] / r : 0;
}

/** Data of the sweeps that estimate the diagonal. */
typedef struct Probing {
  Preconditioner *m;
  LinearSolver *solver;
  const Vector *v, *kv; /* the probe and its product with K */
  int probe;            /* number of the probe, 0 to PROBES - 1 */
  double share, factor; /* of the products in their mean; of expected values */
} Probing;

/** 1 or -1, as if at random, of a row of motion of a probe at a place (SplitMix64). */
static double sign(const VectorSpace *space, int probe, int row, int64_t place)
{
  uint64_t x = ((uint64_t)place * 3 + (uint64_t)row % 3) * PROBES + (uint64_t)probe + 1;
  if (row >= space->rotation) x += (uint64_t)1 << 62;
  x *= 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x >> 63 ? 1 : -1;
}

/** Returns the component of a probe in a row of motion at a place; rotations have the size of displacements. */
static double probe_of(const Probing *p, int probe, int row, int64_t place)
{
  if (p->solver->domain->particles->number[place] < 0) return 0;
  const double size = p->m->any_pose ? preconditioner_probe(p->m, p->solver, 2 * acos(-1) * probe / PROBES, row, place)
                                     : sign(p->v->space, probe, row, place);
  return size / unknowns_length(&p->solver->unknowns, row);
}

static void probe_fill_tile(void *context, int64_t first, int64_t last)
{
  const Probing *p = context;
  for (int64_t i = first; i < last; ++i)
    for (int k = 0; k < p->v->space->rows; ++k) p->v->row[k][i] = probe_of(p, p->probe, k, i);
  for (int64_t i = first; i < last && p->probe == 0; ++i) {
    p->m->diagonal[i] = 0;
    if (p->m->turning) p->m->turning[i] = 0;
  }
}

/** Adds v K v to the diagonal. @param[out] cross  product of K v with the other of the first two probes */
static void add_products(void *context, int64_t first, int64_t last, double *cross)
{
  const Probing *p = context;
  const VectorSpace *space = p->v->space;
  for (int64_t i = first; i < last; ++i)
    for (int k = 0; k < space->rows; ++k) {
      double *of = space->row[k].kind == ROW_DISPLACEMENT ? p->m->diagonal : p->m->turning;
      of[i] += p->v->row[k][i] * p->kv->row[k][i];
      if (p->probe < 2) *cross += p->kv->row[k][i] * probe_of(p, 1 - p->probe, k, i);
    }
}

/** What a particle of its volume, moduli and family would have on the diagonal, but for a factor that all have. */
static double guess(const Domain *d, int64_t i)
{
  const Material *m = &d->materials[d->material[i / SLICE]];
  return d->particles->volume[i] * (m->bulk + 4 * m->shear / 3) * fmax(1, family_count(&d->family, (int32_t)i));
}

/** Returns the sum of the squares of all probes at a place over some rows of motion. With any_pose the phases of three
 *  sines are a third of a turn apart, and the sum of their squares is 3/2 everywhere. */
static double probes_square_sum(const Preconditioner *m, int rows)
{
  return m->any_pose ? PROBES / 2.0 : PROBES * rows;
}

enum { FOUND, EXPECTED, SIZE, PROBE_SUMS };

static void sum_turning(void *context, int64_t first, int64_t last, double *sums)
{
  const Probing *p = context;
  const double length = p->solver->unknowns.length;
  for (int64_t i = first; i < last; ++i) {
    if (isinf(p->m->diagonal[i])) continue;
    sums[FOUND] += p->m->turning[i] * p->share;
    sums[EXPECTED] += length * length * p->m->diagonal[i];
  }
}

static void bound_turning(void *context, int64_t first, int64_t last)
{
  const Probing *p = context;
  const double least = 0.2, length = p->solver->unknowns.length, bound = least * p->factor * length * length;
  for (int64_t i = first; i < last; ++i)
    p->m->turning[i] = p->factor == 0 || isinf(p->m->diagonal[i])
                           ? INFINITY
                           : fmax(p->m->turning[i] * p->share, bound * p->m->diagonal[i]);
}

/** Of rotations the least is a share of what the displacements have, at the radius of gyration: of links that do not bend it is nothing, and they stay. */
static void finish_turning(Probing *p)
{
  const VectorSpace *space = p->v->space;
  const double length = p->solver->unknowns.length, nothing = 1e-10;
  double sums[PROBE_SUMS];
  p->share = length * length / probes_square_sum(p->m, space->rows - space->rotation);
  vector_sum_tiles(space, sum_turning, p, PROBE_SUMS, sums);
  p->factor = sums[FOUND] > nothing * sums[EXPECTED] ? sums[FOUND] / sums[EXPECTED] : 0;
  vector_each_tile(space, bound_turning, p);
}

/** Returns the share of the square of a probe at a place that belongs to unknowns, at least a quarter: supports hold
 *  the other displacements. */
static double probe_free_share(const Probing *p, int64_t place)
{
  const double least = 0.25;
  double whole = 0, left = 0;
  for (int k = 0; k < 3; ++k) {
    const double probe = probe_of(p, p->probe, k, place);
    whole += probe * probe;
    left += p->v->row[k][place] * p->v->row[k][place];
  }
  return whole > 0 ? fmax(least, left / whole) : 1;
}

/** A factor near 1 that differs from particle to particle, by their numbers: a body that is its own mirror image would
 *  come to rest where two like cracks are both half open, from which it moves away at the slightest difference. */
static double probe_uneven(int32_t number)
{
  const double size = 1e-4;
  uint64_t state = (uint64_t)number;
  return 1 + size * (random_uniform(&state) - 0.5);
}

static void sum_diagonal(void *context, int64_t first, int64_t last, double *sums)
{
  const Probing *p = context;
  const Domain *d = p->solver->domain;
  double *diagonal = p->m->diagonal;
  for (int64_t i = first; i < last; ++i) {
    if (d->particles->number[i] < 0) continue;
    sums[SIZE] += fabs(diagonal[i]);
    if (p->m->any_pose) diagonal[i] /= probe_free_share(p, i);
    sums[FOUND] += diagonal[i] * p->share;
    sums[EXPECTED] += guess(d, i);
  }
}

static void bound_diagonal(void *context, int64_t first, int64_t last)
{
  const Probing *p = context;
  const Domain *d = p->solver->domain;
  const double least = 0.2;
  double *diagonal = p->m->diagonal;
  for (int64_t i = first; i < last; ++i) {
    const int32_t number = d->particles->number[i];
    const bool lost = number < 0 || (diagonal[i] == 0 && !family_count(&d->family, (int32_t)i));
    diagonal[i] = lost ? INFINITY : fmax(diagonal[i] * p->share, least * p->factor * guess(d, i));
    if (p->m->any_pose && !lost) diagonal[i] *= probe_uneven(number);
  }
}

/** Estimates the diagonal of K as the mean of the products v_i (K v)_i over pseudo-random vectors v (Bekas, Kokiopoulou
 *  and Saad 2007, Appl. Numer. Math. 57, 1214). The terms of other entries of K average out, and are small where
 *  families are large. The estimate is bounded from below by a share of the value expected from the family of a
 *  particle, because K of a softening body is not positive, but M must be. */
static void find_diagonal(Preconditioner *m, LinearSolver *s, const Vector *v, const Vector *kv)
{
  Probing p = {.m = m, .solver = s, .v = v, .kv = kv, .share = 1 / probes_square_sum(m, s->domain->body.dimensions)};
  double cross[PROBES], sums[PROBE_SUMS];
  for (; p.probe < PROBES; ++p.probe) {
    vector_each_tile(v->space, probe_fill_tile, &p);
    linear_solver_apply(s, v, kv);
    unknowns_clear_rest(&s->unknowns, v);
    vector_sum_tiles(v->space, add_products, &p, 1, &cross[p.probe]);
  }
  p.probe = PROBES - 1; /* v holds the last one */
  vector_sum_tiles(v->space, sum_diagonal, &p, PROBE_SUMS, sums);
  m->is_symmetric = fabs(cross[0] - cross[1]) <= 1e-9 * sums[SIZE];
  p.factor = sums[FOUND] > 0 ? sums[FOUND] / sums[EXPECTED] : 1;
  vector_each_tile(v->space, bound_diagonal, &p);
  if (m->turning) finish_turning(&p);
}

int preconditioner_prepare(Preconditioner *m, LinearSolver *s, const Vector *v, const Vector *kv, Error *error)
{
  find_diagonal(m, s, v, kv);
  if (!m->grid) return BRECCIA_OK;
  return coarse_grid_prepare(m->grid, &s->unknowns, m->diagonal, m->turning, !s->elastic, s->stiffness_share,
                             s->mass_factor, error);
}

/* ---- as it is used ---- */

typedef struct Scaling {
  const Preconditioner *m;
  const Vector *f, *v;
} Scaling;

BRECCIA_CLONES
static void divide(const double *diagonal, double *const *f, double *const *v, int rows, int64_t first, int64_t last)
{
  for (int64_t i = first; i < last; i += LANES) {
    const Lanes inverse = lanes_set(1) / lanes_load(diagonal + i);
    for (int k = 0; k < rows; ++k) lanes_store(v[k] + i, inverse * lanes_load(f[k] + i));
  }
}

static void divide_tile(void *context, int64_t first, int64_t last)
{
  const Scaling *s = context;
  const int rows = s->f->space->rows, turn = s->f->space->rotation;
  divide(s->m->diagonal, s->f->row, s->v->row, turn, first, last);
  if (s->m->turning) divide(s->m->turning, s->f->row + turn, s->v->row + turn, rows - turn, first, last);
}

void preconditioner_apply(const Preconditioner *m, const LinearSolver *s, const Vector *f, const Vector *v)
{
  vector_each_tile(f->space, divide_tile, &(Scaling){m, f, v});
  if (m->grid) coarse_grid_correct(m->grid, f, v);
  unknowns_clear_rest(&s->unknowns, v);
}

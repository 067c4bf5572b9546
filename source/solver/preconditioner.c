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
  if (row >= ROTATION && p->motions == 4) return size; /* about the normal of the plane */
  return r > 0 ? size * from[row % 3] / r : 0;
}

/** Data of the sweeps that estimate the diagonal. */
typedef struct Probing {
  Preconditioner *m;
  LinearSolver *solver;
  double *const *v, *const *kv; /* the probe and its product with K */
  int probe;                    /* number of the probe, 0 to PROBES - 1 */
} Probing;

/** 1 or -1, as if at random, of a row of motion of a probe at a place (SplitMix64). */
static double sign(int probe, int row, int64_t place)
{
  uint64_t x = ((uint64_t)place * 3 + (uint64_t)row % 3) * PROBES + (uint64_t)probe + 1;
  if (row >= ROTATION) x += (uint64_t)1 << 62;
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
                                     : sign(probe, row, place);
  return size / unknowns_length(&p->solver->unknowns, row);
}

static void probe_fill_batch(void *context, int64_t b)
{
  const Probing *p = context;
  const Batch *batch = &p->solver->domain->batches[b];
  const Particles *of = p->solver->domain->particles;
  for (int64_t i = batch->first * SLICE; i < batch->last * SLICE; ++i)
    for (int k = 0; k < of->motions; ++k) p->v[k][i] = probe_of(p, p->probe, k, i);
}

static void add_products(void *context, int64_t b)
{
  const Probing *p = context;
  const Batch *batch = &p->solver->domain->batches[b];
  for (int64_t i = batch->first * SLICE; i < batch->last * SLICE; ++i) {
    for (int k = 0; k < 3; ++k) p->m->diagonal[i] += p->v[k][i] * p->kv[k][i];
    for (int k = ROTATION; k < p->solver->domain->particles->motions; ++k) p->m->turning[i] += p->v[k][i] * p->kv[k][i];
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

/** Of rotations the least is a share of what the displacements have, at the radius of gyration: of links that do not bend it is nothing, and they stay. */
static void finish_turning(Preconditioner *m, const LinearSolver *s)
{
  const Domain *d = s->domain;
  const double length = s->unknowns.length,
               share = length * length / probes_square_sum(m, d->particles->motions - ROTATION), least = 0.2,
               nothing = 1e-10;
  double found = 0, expected = 0;
  for (int64_t i = 0; i < d->particles->places; ++i) {
    if (isinf(m->diagonal[i])) continue;
    found += m->turning[i] * share;
    expected += length * length * m->diagonal[i];
  }
  const double factor = found > nothing * expected ? found / expected : 0;
  for (int64_t i = 0; i < d->particles->places; ++i)
    m->turning[i] = factor == 0 || isinf(m->diagonal[i])
                        ? INFINITY
                        : fmax(m->turning[i] * share, least * factor * length * length * m->diagonal[i]);
}

/** Returns the share of the square of a probe at a place that belongs to unknowns, at least a quarter: supports hold
 *  the other displacements. */
static double probe_free_share(const Probing *p, int64_t place)
{
  const double least = 0.25;
  double whole = 0, left = 0;
  for (int k = 0; k < ROTATION; ++k) {
    const double probe = probe_of(p, p->probe, k, place);
    whole += probe * probe;
    left += p->v[k][place] * p->v[k][place];
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

/** Estimates the diagonal of K as the mean of the products v_i (K v)_i over pseudo-random vectors v (Bekas, Kokiopoulou
 *  and Saad 2007, Appl. Numer. Math. 57, 1214). The terms of other entries of K average out, and are small where
 *  families are large. The estimate is bounded from below by a share of the value expected from the family of a
 *  particle, because K of a softening body is not positive, but M must be. */
static void find_diagonal(Preconditioner *m, LinearSolver *s, double *const v[MOTIONS], double *const kv[MOTIONS])
{
  const Domain *d = s->domain;
  const int64_t places = d->particles->places;
  const double share = 1 / probes_square_sum(m, d->body.dimensions), least = 0.2;
  double cross[2] = {0}, found = 0, expected = 0;
  memset(m->diagonal, 0, sizeof(double) * (size_t)places);
  if (m->turning) memset(m->turning, 0, sizeof(double) * (size_t)places);
  for (int probe = 0; probe < PROBES; ++probe) {
    Probing p = {m, s, v, kv, probe};
    team_each(d->batch_count, probe_fill_batch, &p);
    linear_solver_apply(s, v, kv);
    unknowns_clear_rest(&s->unknowns, v);
    team_each(d->batch_count, add_products, &p);
    for (int64_t i = 0; i < places && probe < 2; ++i)
      for (int k = 0; k < d->particles->motions; ++k) cross[probe] += kv[k][i] * probe_of(&p, 1 - probe, k, i);
  }
  Probing last = {m, s, v, kv, PROBES - 1};
  double size = 0;
  for (int64_t i = 0; i < places; ++i) {
    if (d->particles->number[i] < 0) continue;
    size += fabs(m->diagonal[i]);
    if (m->any_pose) m->diagonal[i] /= probe_free_share(&last, i);
    found += m->diagonal[i] * share;
    expected += guess(d, i);
  }
  m->is_symmetric = fabs(cross[0] - cross[1]) <= 1e-9 * size;
  const double factor = found > 0 ? found / expected : 1;
  for (int64_t i = 0; i < places; ++i) {
    const bool lost = d->particles->number[i] < 0 || (m->diagonal[i] == 0 && !family_count(&d->family, (int32_t)i));
    m->diagonal[i] = lost ? INFINITY : fmax(m->diagonal[i] * share, least * factor * guess(d, i));
    if (m->any_pose && !lost) m->diagonal[i] *= probe_uneven(d->particles->number[i]);
  }
  if (m->turning) finish_turning(m, s);
}

int preconditioner_prepare(Preconditioner *m, LinearSolver *s, double *const v[MOTIONS], double *const kv[MOTIONS],
                           Error *error)
{
  find_diagonal(m, s, v, kv);
  if (!m->grid) return BRECCIA_OK;
  return coarse_grid_prepare(m->grid, &s->unknowns, m->diagonal, m->turning, !s->elastic, s->stiffness_share,
                             s->mass_factor, error);
}

/* ---- as it is used ---- */

typedef struct Scaling {
  const Preconditioner *m;
  const Domain *domain;
  double *const *f, *const *v;
} Scaling;

BRECCIA_CLONES
static void divide(const double *diagonal, double *const *f, double *const *v, int rows, int64_t first, int64_t last)
{
  for (int64_t i = first; i < last; i += LANES) {
    const Lanes inverse = lanes_set(1) / lanes_load(diagonal + i);
    for (int k = 0; k < rows; ++k) lanes_store(v[k] + i, inverse * lanes_load(f[k] + i));
  }
}

static void divide_batch(void *context, int64_t b)
{
  const Scaling *s = context;
  const Batch *batch = &s->domain->batches[b];
  const int64_t first = batch->first * SLICE, last = batch->last * SLICE;
  divide(s->m->diagonal, s->f, s->v, ROTATION, first, last);
  if (s->m->turning)
    divide(s->m->turning, s->f + ROTATION, s->v + ROTATION, s->domain->particles->motions - ROTATION, first, last);
}

void preconditioner_apply(const Preconditioner *m, const LinearSolver *s, double *const f[MOTIONS],
                          double *const v[MOTIONS])
{
  team_each(s->domain->batch_count, divide_batch, &(Scaling){m, s->domain, f, v});
  if (m->grid) coarse_grid_correct(m->grid, f, v);
  unknowns_clear_rest(&s->unknowns, v);
}

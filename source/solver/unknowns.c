#include "solver/unknowns.h"

#include "base/team.h"
#include "loading/constraint.h"
#include "solver/vectors.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

Unknowns unknowns_of(const Domain *domain, const Loading *loading)
{
  Unknowns u = {.domain = domain, .loading = loading, .length = 1};
  for (int k = 0; k < 3; ++k) u.flat[k] = k >= domain->body.dimensions;
  const Particles *p = domain->particles;
  if (p->rotary) u.length = sqrt(p->rotary[p->place_of[0]] / p->density[p->place_of[0]]);
  return u;
}

static void clear_flat(const Unknowns *u, double *const v[MOTIONS])
{
  for (int k = 0; k < 3; ++k)
    if (u->flat[k]) memset(v[k], 0, sizeof(double) * (size_t)u->domain->particles->places);
}

void unknowns_each_row(const Unknowns *u, void (*one)(const Constraint *constraint, int64_t n, void *context),
                       void *context)
{
  const int count = u->loading->constraint_count;
  for (int turn = 0; turn < 2 * count; ++turn) {
    const Constraint *constraint = &u->loading->constraints[turn % count];
    if (!load_acts(u->loading, constraint->load) || (constraint->images != NULL) != (turn >= count)) continue;
    for (int64_t n = 0; n < constraint->load->selection.count; ++n) one(constraint, n, context);
  }
}

/* ---- T ---- */

typedef struct Spreading {
  const Unknowns *unknowns;
  double time;
  bool controlled; /* with motions of controlled loads, of factor 1 */
  double *const *v;
} Spreading;

static void spread_row(const Constraint *c, int64_t n, void *context)
{
  const Spreading *s = context;
  const int32_t i = c->load->selection.places[n];
  const Particles *p = s->unknowns->domain->particles;
  double *const *u = p->displacement;
  double wanted = 0;
  if (c->images) wanted = c->share * constraint_along(c, s->v, c->images[n]);
  if (s->controlled && history_is_controlled(&c->load->history)) wanted += c->value * constraint_part(c, n);
  const bool from_step = c->row && p->orientation[0]; /* rotations in space count from the beginning of the step */
  if (!isnan(s->time) && from_step)
    wanted += constraint_change(c, domain_step_begin(s->unknowns->domain), s->time) * constraint_part(c, n);
  else if (!isnan(s->time))
    wanted += constraint_displacement(c, s->time) * constraint_part(c, n) + (c->from ? c->from[n] : 0);
  if (!isnan(s->time)) wanted -= constraint_along(c, u, i);
  if (!isnan(s->time) && c->images) wanted += c->share * constraint_along(c, u, c->images[n]);
  constraint_add(c, s->v, i, wanted - constraint_along(c, s->v, i));
}

static void spread(const Unknowns *u, Spreading *s)
{
  double *const *v = s->v;
  clear_flat(u, v);
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &u->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n)
        v[k][ties->places[n]] = v[k][ties->places[ties->first[g]]];
  }
  unknowns_each_row(u, spread_row, s);
}

void unknowns_spread(const Unknowns *u, double time, double *const v[MOTIONS])
{
  spread(u, &(Spreading){u, time, false, v});
}

void unknowns_spread_controlled(const Unknowns *u, double *const v[MOTIONS])
{
  spread(u, &(Spreading){u, NAN, true, v});
}

/* ---- its transpose ---- */

static void clear_row(const Constraint *c, int64_t n, void *context)
{
  double *const *v = context;
  const int32_t i = c->load->selection.places[n];
  constraint_add(c, v, i, -constraint_along(c, v, i));
}

/** Ties hand on what all particles of a group get, or nothing. */
static void close_ties(const Unknowns *u, double *const f[MOTIONS], bool hand_on)
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &u->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g) {
      const int32_t first = ties->places[ties->first[g]];
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n) {
        if (hand_on) f[k][first] += f[k][ties->places[n]];
        f[k][ties->places[n]] = 0;
      }
    }
  }
}

void unknowns_gather(const Unknowns *u, double *const f[MOTIONS])
{
  unknowns_each_row(u, clear_row, (void *)f);
  close_ties(u, f, true);
  clear_flat(u, f);
}

void unknowns_clear_rest(const Unknowns *u, double *const v[MOTIONS])
{
  unknowns_each_row(u, clear_row, (void *)v);
  close_ties(u, v, false);
  clear_flat(u, v);
}

int64_t unknowns_count(const Unknowns *u, Error *error)
{
  const Particles *p = u->domain->particles;
  double *ones[MOTIONS] = {0}, sum = 0;
  const bool made = vectors_make(ones, p, "unknowns", error);
  /* The trace of a projection is the number of directions that it leaves: axis by axis. */
  for (int axis = 0; axis < p->motions && made; ++axis) {
    for (int k = 0; k < p->motions; ++k)
      for (int64_t i = 0; i < p->places; ++i) ones[k][i] = k == axis && p->number[i] >= 0;
    unknowns_clear_rest(u, ones);
    for (int64_t i = 0; i < p->places; ++i) sum += ones[axis][i];
  }
  vectors_free(ones);
  return made ? (int64_t)(sum + 0.5) : -1;
}

/* ---- products ---- */

typedef struct Product {
  const Unknowns *unknowns;
  double *const *a, *const *b;
  double weight; /* of rotations */
  double *parts; /* [batches] */
} Product;

BRECCIA_CLONES
static double product_of(double *const *a, double *const *b, int rows, int64_t first, int64_t last)
{
  Lanes sum = {0};
  for (int k = 0; k < rows; ++k)
    for (int64_t i = first; i < last; i += LANES) sum += lanes_load(a[k] + i) * lanes_load(b[k] + i);
  return lanes_total(sum);
}

static void multiply(void *context, int64_t batch)
{
  const Product *m = context;
  const Batch *slices = &m->unknowns->domain->batches[batch];
  const int64_t first = slices->first * SLICE, last = slices->last * SLICE;
  const int turning = m->unknowns->domain->particles->motions - ROTATION;
  m->parts[batch] = product_of(m->a, m->b, ROTATION, first, last);
  if (turning) m->parts[batch] += m->weight * product_of(m->a + ROTATION, m->b + ROTATION, turning, first, last);
}

static double find_product(const Unknowns *u, double *const *a, double *const *b, double weight)
{
  Product m = {u, a, b, weight, u->domain->batch_sum};
  double sum = 0;
  team_each(u->domain->batch_count, multiply, &m);
  for (int64_t n = 0; n < u->domain->batch_count; ++n) sum += m.parts[n];
  return sum;
}

double unknowns_work(const Unknowns *u, double *const force[MOTIONS], double *const motion[MOTIONS])
{
  return find_product(u, force, motion, 1);
}

double unknowns_product_of_forces(const Unknowns *u, double *const a[MOTIONS], double *const b[MOTIONS])
{
  return find_product(u, a, b, 1 / (u->length * u->length));
}

double unknowns_product_of_motions(const Unknowns *u, double *const a[MOTIONS], double *const b[MOTIONS])
{
  return find_product(u, a, b, u->length * u->length);
}

/* ---- the body as a whole ---- */

enum { RIGID = 6 };

/** How the body is held against motions as a whole: moment[a][b] = sum over rows of what a and b do to them. */
typedef struct Hold {
  const Particles *particles;
  double centre[3], size;
  double moment[RIGID][RIGID];
} Hold;

/** Displacements of a particle in the motions as a whole, along a direction: three shifts, and three turns of the edge of the body by 1. */
static void rigid(const Hold *h, const double direction[3], int32_t i, double share, double moved[RIGID])
{
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const double y = (h->particles->position[next][i] - h->centre[next]) / h->size;
    const double z = (h->particles->position[last][i] - h->centre[last]) / h->size;
    moved[k] += share * direction[k];
    moved[3 + k] += share * (direction[last] * y - direction[next] * z);
  }
}

static void add_row(Hold *h, const double moved[RIGID])
{
  for (int a = 0; a < RIGID; ++a)
    for (int b = 0; b < RIGID; ++b) h->moment[a][b] += moved[a] * moved[b];
}

static void hold_row(const Constraint *c, int64_t n, void *context)
{
  double moved[RIGID] = {0};
  const Hold *h = context;
  if (c->row) { /* a particle that cannot turn */
    for (int k = 0; k < 3; ++k)
      if (c->direction[k] != 0) moved[h->particles->motions == 4 ? RIGID - 1 : 3 + k] = c->direction[k];
    add_row(context, moved);
    return;
  }
  rigid(context, c->direction, c->load->selection.places[n], 1, moved);
  if (c->images) rigid(context, c->direction, c->images[n], -c->share, moved);
  add_row(context, moved);
}

static void hold_ties(Hold *h, const Unknowns *u)
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &u->loading->ties[k];
    const double axis[3] = {k == 0, k == 1, k == 2};
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n) {
        double moved[RIGID] = {0};
        rigid(h, axis, ties->places[n], 1, moved);
        rigid(h, axis, ties->places[ties->first[g]], -1, moved);
        add_row(h, moved);
      }
  }
}

/** Takes from the others what one motion shares with them, the most held first; shifts before turns, so that a body that is held at one point is told to
 *  turn about it. @return the first that nothing holds, or -1 */
static int find_loose(Hold *h, const bool wanted[RIGID])
{
  bool done[RIGID];
  double largest = 0;
  for (int a = 0; a < RIGID; ++a) {
    done[a] = !wanted[a];
    largest = fmax(largest, h->moment[a][a]);
  }
  for (;;) {
    int pivot = -1;
    for (int a = 0; a < RIGID && !(a == 3 && pivot >= 0); ++a)
      if (!done[a] && (pivot < 0 || h->moment[a][a] > h->moment[pivot][pivot])) pivot = a;
    if (pivot < 0) return -1;
    if (!(h->moment[pivot][pivot] > 1e-10 * largest)) return pivot;
    done[pivot] = true;
    for (int a = 0; a < RIGID; ++a)
      for (int b = 0; b < RIGID && !done[a]; ++b)
        if (!done[b]) h->moment[a][b] -= h->moment[a][pivot] * h->moment[pivot][b] / h->moment[pivot][pivot];
  }
}

bool unknowns_are_loose(const Unknowns *u, char *motion, size_t size)
{
  const Particles *p = u->domain->particles;
  const int dimensions = u->domain->body.dimensions;
  double low[3], high[3];
  Hold h = {.particles = p};
  for (int l = 0; l < u->loading->count; ++l) { /* springs hold */
    const Load *load = &u->loading->loads[l];
    if (load->type->eigenvalue && load_acts(u->loading, load) && load->type->eigenvalue(load, p) > 0) return false;
  }
  particles_bounds(p, low, high);
  for (int k = 0; k < 3; ++k) {
    h.centre[k] = (low[k] + high[k]) / 2;
    h.size = fmax(h.size, (high[k] - low[k]) / 2);
  }
  if (!(h.size > 0)) h.size = 1;
  unknowns_each_row(u, hold_row, &h);
  hold_ties(&h, u);
  const bool wanted[RIGID] = {true, dimensions > 1, dimensions > 2, dimensions > 2, dimensions > 2, dimensions > 1};
  const int loose = find_loose(&h, wanted);
  if (loose >= 0) snprintf(motion, size, "%s %c", loose < 3 ? "along" : "about", "xyz"[loose % 3]);
  return loose >= 0;
}

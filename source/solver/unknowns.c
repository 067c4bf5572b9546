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

/** What is no motion: out of a plane or line, and rotations of particles of formulations without any. */
static void clear_flat(const Unknowns *u, double *const v[MOTIONS])
{
  const Domain *d = u->domain;
  for (int k = 0; k < 3; ++k)
    if (u->flat[k]) memset(v[k], 0, sizeof(double) * (size_t)d->particles->places);
  for (int64_t s = 0; s < d->particles->slices && d->particles->unturned; ++s)
    if (d->particles->unturned[s])
      for (int k = ROTATION; k < d->particles->motions; ++k) memset(v[k] + s * SLICE, 0, SLICE * sizeof(double));
}

void unknowns_each_row(const Unknowns *u, void (*one)(const Constraint *constraint, int64_t n, void *context),
                       void *context)
{
  const int count = u->loading->constraint_count;
  for (int turn = 0; turn < 2 * count; ++turn) {
    const Constraint *constraint = &u->loading->constraints[turn % count];
    if (!load_acts(u->loading, constraint->load) || (constraint->images != NULL) != (turn >= count)) continue;
    for (int64_t n = 0; n < constraint->load->selection.count; ++n)
      if (!constraint_leads(constraint, n) && !constraint_is_open(constraint, n)) one(constraint, n, context);
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
  double wanted = constraint_followed(c, s->v, n);
  if (s->controlled && history_is_controlled(&c->load->history)) wanted += c->value * constraint_part(c, n);
  const bool from_step = c->row && p->orientation[0]; /* rotations in space count from the beginning of the step */
  if (!isnan(s->time) && from_step)
    wanted += constraint_change(c, domain_step_begin(s->unknowns->domain), s->time) * constraint_part(c, n);
  else if (!isnan(s->time))
    wanted += constraint_displacement(c, s->time) * constraint_part(c, n) + constraint_from(c, n);
  if (!isnan(s->time)) wanted += constraint_followed(c, u, n) - constraint_along(c, u, i);
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

/** Adds the force on a particle of a platen to those on its leaders, and clears the force. */
static void hand_on_row(const Constraint *c, int64_t n, void *context)
{
  double *const *f = context;
  const double along = constraint_along(c, f, c->load->selection.places[n]);
  for (int m = 0; m < constraint_leaders(c); ++m)
    constraint_add(c, f, constraint_leader(c, m), constraint_share(c, m, n) * along);
  clear_row(c, n, context);
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
  unknowns_each_row(u, hand_on_row, (void *)f);
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

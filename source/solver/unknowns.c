#include "solver/unknowns.h"

#include "base/team.h"
#include "loading/constraint.h"
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

typedef struct Flat {
  const Unknowns *unknowns;
  const Vector *v;
} Flat;

static void clear_flat_tile(void *context, int64_t first, int64_t last)
{
  const Flat *of = context;
  const VectorSpace *space = of->v->space;
  const uint8_t *unturned = of->unknowns->domain->particles->unturned;
  for (int k = 0; k < 3; ++k)
    if (of->unknowns->flat[k]) memset(of->v->row[k] + first, 0, sizeof(double) * (size_t)(last - first));
  for (int64_t i = first; i < last && unturned; i += SLICE)
    for (int k = space->rotation; k < space->rows && unturned[i / SLICE]; ++k)
      memset(of->v->row[k] + i, 0, SLICE * sizeof(double));
}

/** Clears what is no motion: out of a plane or line, and rotations of particles of formulations without any. */
static void clear_flat(const Unknowns *u, const Vector *v)
{
  if (u->flat[2] || u->domain->particles->unturned) vector_each_tile(v->space, clear_flat_tile, &(Flat){u, v});
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
  const Vector *v;
} Spreading;

static void spread_row(const Constraint *c, int64_t n, void *context)
{
  const Spreading *s = context;
  const int32_t i = c->load->selection.places[n];
  const Particles *p = s->unknowns->domain->particles;
  double *const *u = p->displacement.row, *const *v = s->v->row;
  double wanted = constraint_followed(c, v, n);
  if (s->controlled && history_is_controlled(&c->load->history)) wanted += c->value * constraint_part(c, n);
  const bool from_step = c->row && p->orientation[0]; /* rotations in space count from the beginning of the step */
  if (!isnan(s->time) && from_step)
    wanted += constraint_change(c, domain_step_begin(s->unknowns->domain), s->time) * constraint_part(c, n);
  else if (!isnan(s->time))
    wanted += constraint_displacement(c, s->time) * constraint_part(c, n) + constraint_from(c, n);
  if (!isnan(s->time)) wanted += constraint_followed(c, u, n) - constraint_along(c, u, i);
  constraint_add(c, v, i, wanted - constraint_along(c, v, i));
}

static void spread(const Unknowns *u, Spreading *s)
{
  const Vector *v = s->v;
  clear_flat(u, v);
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &u->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g)
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n)
        v->row[k][ties->places[n]] = v->row[k][ties->places[ties->first[g]]];
  }
  unknowns_each_row(u, spread_row, s);
}

void unknowns_spread(const Unknowns *u, double time, const Vector *v)
{
  spread(u, &(Spreading){u, time, false, v});
}

void unknowns_spread_controlled(const Unknowns *u, const Vector *v)
{
  spread(u, &(Spreading){u, NAN, true, v});
}

/* ---- its transpose ---- */

static void clear_row(const Constraint *c, int64_t n, void *context)
{
  double *const *v = ((const Vector *)context)->row;
  const int32_t i = c->load->selection.places[n];
  constraint_add(c, v, i, -constraint_along(c, v, i));
}

/** Adds the force on a particle of a platen to those on its leaders, and clears the force. */
static void hand_on_row(const Constraint *c, int64_t n, void *context)
{
  double *const *f = ((const Vector *)context)->row;
  const double along = constraint_along(c, f, c->load->selection.places[n]);
  for (int m = 0; m < constraint_leaders(c); ++m)
    constraint_add(c, f, constraint_leader(c, m), constraint_share(c, m, n) * along);
  clear_row(c, n, context);
}

/** Ties hand on what all particles of a group get, or nothing. */
static void close_ties(const Unknowns *u, const Vector *f, bool hand_on)
{
  for (int k = 0; k < 3; ++k) {
    const TieGroups *ties = &u->loading->ties[k];
    for (int64_t g = 0; g < ties->count; ++g) {
      const int32_t first = ties->places[ties->first[g]];
      for (int64_t n = ties->first[g] + 1; n < ties->first[g + 1]; ++n) {
        if (hand_on) f->row[k][first] += f->row[k][ties->places[n]];
        f->row[k][ties->places[n]] = 0;
      }
    }
  }
}

void unknowns_gather(const Unknowns *u, const Vector *f)
{
  unknowns_each_row(u, hand_on_row, (void *)f);
  close_ties(u, f, true);
  clear_flat(u, f);
}

void unknowns_clear_rest(const Unknowns *u, const Vector *v)
{
  unknowns_each_row(u, clear_row, (void *)v);
  close_ties(u, v, false);
  clear_flat(u, v);
}

int64_t unknowns_count(const Unknowns *u, Error *error)
{
  const Particles *p = u->domain->particles;
  Vector ones = {0};
  double sum = 0;
  const bool made = vector_create(&ones, &p->space, "unknowns", error);
  /* The trace of a projection is the number of directions that it leaves: axis by axis. */
  for (int axis = 0; axis < p->space.rows && made; ++axis) {
    vector_clear(&ones);
    for (int64_t n = 0; n < p->count; ++n) ones.row[axis][p->place_of[n]] = 1;
    unknowns_clear_rest(u, &ones);
    for (int64_t n = 0; n < p->count; ++n) sum += ones.row[axis][p->place_of[n]];
  }
  vector_destroy(&ones);
  return made ? (int64_t)(sum + 0.5) : -1;
}

/* ---- products ---- */

double unknowns_product_of_forces(const Unknowns *u, const Vector *a, const Vector *b)
{
  return vector_inner(a, b, 1 / (u->length * u->length));
}

double unknowns_product_of_motions(const Unknowns *u, const Vector *a, const Vector *b)
{
  return vector_inner(a, b, u->length * u->length);
}

#include "solver/reactions.h"

#include "solver/unknowns.h"
#include "solver/vectors.h"
#include <math.h>
#include <string.h>

int reactions_create(Reactions *r, const Particles *p, Error *error)
{
  return vectors_make(r->force, p->places, "reactions", error) ? BRECCIA_OK : BRECCIA_FAILURE;
}

void reactions_destroy(Reactions *r)
{
  vectors_free(r->force);
}

static void add_force(Wrench *w, const Particles *p, int32_t i, const double force[3])
{
  double arm[3];
  for (int k = 0; k < 3; ++k) arm[k] = p->position[k][i] + p->displacement[k][i] - w->about[k];
  w->size += sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    w->force[k] += force[k];
    w->moment[k] += arm[next] * force[last] - arm[last] * force[next];
  }
}

typedef struct Summing {
  double *const *force;
  const Solver *solver;
  const uint8_t *on;
  const char *load;
  int64_t rows;
  double middle[3];
  Wrench sum;
} Summing;

static bool counts(const Summing *s, const Constraint *c, int32_t i)
{
  if (s->on && !s->on[i]) return false;
  return !s->load || (c->load->spec->name && !strcmp(c->load->spec->name, s->load));
}

static void note_row(const Constraint *c, int64_t n, void *context)
{
  Summing *s = context;
  const Particles *p = s->solver->domain->particles;
  const int32_t i = c->load->selection.places[n];
  for (int k = 0; k < 3; ++k) s->force[k][i] = p->volume[i] * (p->internal[k][i] + p->external[k][i]);
  if (!counts(s, c, i)) return;
  ++s->rows;
  for (int k = 0; k < 3; ++k) s->middle[k] += p->position[k][i] + p->displacement[k][i];
}

/** What balances a particle in one direction is taken off there, so that another row of that direction finds nothing any more. */
static void add_row(const Constraint *c, int64_t n, void *context)
{
  Summing *s = context;
  const int32_t i = c->load->selection.places[n];
  double along = 0, force[3];
  for (int k = 0; k < 3; ++k) along -= s->force[k][i] * c->direction[k];
  for (int k = 0; k < 3; ++k) s->force[k][i] += along * c->direction[k];
  if (!counts(s, c, i)) return;
  if (s->solver->type->inertia && !c->images) along += s->solver->type->inertia(s->solver, c, n);
  for (int k = 0; k < 3; ++k) force[k] = along * c->direction[k];
  add_force(&s->sum, s->solver->domain->particles, i, force);
}

Wrench reactions_sum(const Reactions *r, const Solver *solver, const uint8_t *on, const char *load, const double *about)
{
  const Unknowns u = unknowns_of(solver->domain, solver->loading);
  Summing s = {.force = r->force, .solver = solver, .on = on, .load = load};
  unknowns_each_row(&u, note_row, &s);
  for (int k = 0; k < 3; ++k) s.sum.about[k] = about ? about[k] : s.rows ? s.middle[k] / (double)s.rows : 0;
  unknowns_each_row(&u, add_row, &s);
  return s.sum;
}

Wrench reactions_of_loads(const Solver *solver, const double about[3])
{
  const Particles *p = solver->domain->particles;
  Wrench sum = {.about = {about[0], about[1], about[2]}};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double force[3];
    for (int k = 0; k < 3; ++k) force[k] = p->volume[i] * p->external[k][i];
    add_force(&sum, p, i, force);
  }
  return sum;
}

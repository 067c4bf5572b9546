#include "solver/rest.h"

#include "base/memory.h"
#include "solver/unknowns.h"
#include <math.h>
#include <stdlib.h>

const double rest_limit = 1e-3;

/** True if a history says the same at the end as a hundredth of the time before. */
static bool is_steady(const Load *load, double time)
{
  const double now = load_factor(load, time), before = load_factor(load, time - 0.01 * (time - load->begin));
  return fabs(now - before) <= 1e-9 * fmax(fabs(now), 1);
}

static bool is_meant(const Solver *s)
{
  if (s->type->rests) return true;
  if (!s->type->damps(s)) return false;
  for (int k = 0; k < s->loading->count; ++k)
    if (load_acts(s->loading, &s->loading->loads[k]) && !is_steady(&s->loading->loads[k], s->clock.time)) return false;
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *c = &s->loading->constraints[n];
    if (load_acts(s->loading, c->load) && c->order && c->value != 0 && load_factor(c->load, s->clock.time) != 0)
      return false;
  }
  return true;
}

int rest_find(const Solver *s, Rest *rest, Error *error)
{
  *rest = (Rest){.meant = is_meant(s)};
  if (!rest->meant) return BRECCIA_OK;
  const Particles *p = s->domain->particles;
  double *free_force[3] = {0}, unbalanced = 0, acting = 0;
  int failed = 0;
  for (int k = 0; k < 3; ++k) {
    failed |= !(free_force[k] = places_array(p->places, "forces out of balance", error));
    for (int64_t i = 0; !failed && i < p->places; ++i)
      free_force[k][i] = (p->internal[k][i] + p->external[k][i]) * p->volume[i];
  }
  for (int n = 0; !failed && n < s->loading->constraint_count; ++n) { /* what a support carries is balanced */
    const Constraint *c = &s->loading->constraints[n];
    for (int64_t at = 0; load_acts(s->loading, c->load) && !c->row && at < c->load->selection.count; ++at) {
      const int32_t i = c->load->selection.places[at];
      double along = 0;
      for (int k = 0; k < 3; ++k) along += free_force[k][i] * c->direction[k];
      for (int k = 0; k < 3; ++k) free_force[k][i] -= along * c->direction[k];
      acting += fabs(along);
    }
  }
  if (!failed && s->type->rests) { /* what ties exert is not among the forces then */
    const Unknowns unknowns = unknowns_of(s->domain, s->loading);
    unknowns_gather(&unknowns, free_force);
  }
  for (int64_t n = 0; !failed && n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0, external = 0;
    for (int k = 0; k < 3; ++k) {
      square += free_force[k][i] * free_force[k][i];
      external += p->external[k][i] * p->external[k][i];
    }
    unbalanced += sqrt(square);
    acting += p->volume[i] * sqrt(external);
  }
  for (int k = 0; k < 3; ++k) places_free(&free_force[k]);
  if (failed) return BRECCIA_FAILURE;
  if (s->type->exerted) acting = fmax(acting, s->type->exerted(s)); /* nothing acts on what was unloaded, or is torn */
  rest->unbalanced = acting > 0 ? unbalanced / acting : 0;
  rest->kinetic =
      s->ledger.paid > 0 ? fmax(0, s->ledger.kinetic) / s->ledger.paid : 0; /* a rounding below zero is none */
  rest->reached = rest->unbalanced < rest_limit && rest->kinetic < rest_limit;
  return BRECCIA_OK;
}

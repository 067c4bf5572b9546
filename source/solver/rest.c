#include "solver/rest.h"

#include "base/memory.h"
#include "loading/constraint.h"
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

/** Whether something else than supports and strains acts: a force, or a motion that is prescribed. */
static bool is_loaded(const Solver *s)
{
  for (int k = 0; k < s->loading->count; ++k) {
    const Load *load = &s->loading->loads[k];
    if (load_acts(s->loading, load) && load->type->force && !load->type->brake && !load->type->energy &&
        load_magnitude(load->spec) != 0 && load_factor(load, s->clock.time) != 0)
      return true;
  }
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *c = &s->loading->constraints[n];
    if (load_acts(s->loading, c->load) && c->value != 0 && load_factor(c->load, s->clock.time) != 0) return true;
  }
  return false;
}

/** Forces by strains that the stage has brought or changed, as those of earlier stages are in balance by then; these where nothing else acts. */
static int find_forces_of_strains(const Solver *s, double *sum, Error *error)
{
  const int status = domain_forces_of_strains(s->domain, s->clock.stage_time, s->clock.time, sum, error);
  if (status || *sum > 0 || is_loaded(s)) return status;
  return domain_forces_of_strains(s->domain, NAN, s->clock.time, sum, error);
}

int rest_find(const Solver *s, Rest *rest, Error *error)
{
  *rest = (Rest){.meant = is_meant(s)};
  if (!rest->meant) return BRECCIA_OK;
  const Particles *p = s->domain->particles;
  const Unknowns unknowns = unknowns_of(s->domain, s->loading);
  Vector free_force = {0};
  double unbalanced = 0, acting = 0, squares = 0, held_squares = 0, external_squares = 0;
  bool failed = !vector_create(&free_force, &p->space, "forces out of balance", error);
  if (!failed) vector_weigh_sum(&free_force, p->volume, &p->internal, &p->external);
  for (int n = 0; !failed && n < s->loading->constraint_count; ++n) { /* what a support carries is balanced */
    const Constraint *c = &s->loading->constraints[n];
    for (int64_t at = 0; load_acts(s->loading, c->load) && at < c->load->selection.count; ++at) {
      const int32_t i = c->load->selection.places[at];
      if (constraint_leads(c, at) || constraint_is_open(c, at)) continue;
      const double along = constraint_along(c, free_force.row, i);
      constraint_add(c, free_force.row, i, -along);
      for (int m = 0; s->type->rests && m < constraint_leaders(c); ++m)
        constraint_add(c, free_force.row, constraint_leader(c, m), constraint_share(c, m, at) * along);
      acting += fabs(along) / unknowns_length(&unknowns, c->row);
      held_squares += pow(along / unknowns_length(&unknowns, c->row), 2);
    }
  }
  if (!failed && s->type->rests) { /* what ties exert is not among the forces then */
    unknowns_gather(&unknowns, &free_force);
  }
  for (int64_t n = 0; !failed && n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double square = 0, external = 0;
    for (int k = 0; k < p->space.rows; ++k) {
      const double length = unknowns_length(&unknowns, k);
      square += pow(free_force.row[k][i] / length, 2);
      external += pow(p->external.row[k][i] / length, 2);
    }
    unbalanced += sqrt(square);
    acting += p->volume[i] * sqrt(external);
    squares += square;
    external_squares += p->volume[i] * p->volume[i] * external;
  }
  vector_destroy(&free_force);
  double of_strains = 0;
  if (!failed && !s->type->rests) failed = find_forces_of_strains(s, &of_strains, error) != BRECCIA_OK;
  if (failed) return BRECCIA_FAILURE;
  acting += of_strains;
  if (s->type->rests) { /* the measure by which it has converged */
    unbalanced = sqrt(squares);
    acting = sqrt(fmax(held_squares, external_squares));
  }
  if (s->type->exerted) acting = fmax(acting, s->type->exerted(s)); /* nothing acts on what was unloaded, or is torn */
  rest->unbalanced = acting > 0 ? unbalanced / acting : 0;
  rest->kinetic =
      s->ledger.paid > 0 ? fmax(0, s->ledger.kinetic) / s->ledger.paid : 0; /* a rounding below zero is none */
  rest->reached = rest->unbalanced < rest_limit && rest->kinetic < rest_limit;
  return BRECCIA_OK;
}

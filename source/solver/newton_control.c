/* Newton's method where the factor of some loads is found, so that a measure of the displacements is as prescribed (control.h). */
#include "solver/newton.h"
#include "solver/vectors.h"

#include "base/team.h"
#include "loading/constraint.h"
#include <math.h>
#include <string.h>

static void apply_controlled(void *context)
{
  const Newton *n = context;
  loading_apply_controlled(n->loading, n->domain->particles);
}

/** Forces on the unknowns where the factor of controlled loads grows by 1. Leaves zeros in `unit_motion`. */
static void find_unit_force(Newton *n)
{
  double *const *room = n->unit_motion;
  const Particles *p = n->domain->particles;
  const Unknowns *u = &n->linear.unknowns;
  vectors_clear(room, p);
  unknowns_spread_controlled(u, room);
  domain_linear_step(n->domain, room, n->unit_force);
  domain_change_forces(n->domain, room, n->unit_force);
  loading_change(n->loading, p, room, n->unit_force);
  for (int k = 0; k < p->motions; ++k) memcpy(room[k], p->external[k], sizeof(double) * (size_t)p->places);
  team_run(apply_controlled, n);
  for (int k = 0; k < p->motions; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      n->unit_force[k][i] = p->volume[i] * (n->unit_force[k][i] + p->external[k][i]);
      p->external[k][i] = room[k][i];
      room[k][i] = 0;
    }
  unknowns_gather(u, n->unit_force);
}

/** Displacements where the factor of controlled loads grows by 1. */
static NewtonOutcome find_unit_motion(Newton *n, double accuracy, Error *error)
{
  LinearRecord linear;
  find_unit_force(n);
  if (linear_solver_solve(&n->linear, n->unit_force, n->unit_motion, accuracy, &linear, error)) return NEWTON_FAILED;
  n->products += linear.iterations;
  n->indefinite |= linear.indefinite;
  unknowns_spread_controlled(&n->linear.unknowns, n->unit_motion);
  return NEWTON_CONVERGED;
}

/** The factor by which controlled loads grow, so that the measure comes to its target. */
static double find_growth(const Newton *n)
{
  return (n->target - control_shown(n->control) - control_value(n->control, n->change)) /
         control_value(n->control, n->unit_motion);
}

NewtonOutcome newton_follow_control(Newton *n, double accuracy, double *work, Error *error)
{
  const Particles *p = n->domain->particles;
  const Unknowns *u = &n->linear.unknowns;
  NewtonOutcome outcome = find_unit_motion(n, accuracy, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  if (n->iterations == 1) n->target += control_aim(n->control, n->unit_motion);
  double more = find_growth(n);
  /* Loads that grow by much leave more out of balance by what their motion errs than the forces that are there: it is to leave no more than these. */
  const double left = accuracy * fabs(more) * sqrt(unknowns_product_of_forces(u, n->unit_force, n->unit_force)),
               may = fmax(0.3 * n->spec->residual * n->exerted,
                          accuracy * sqrt(unknowns_product_of_forces(u, n->force, n->force)));
  if (left > 2 * may && may > 0) {
    outcome = find_unit_motion(n, fmax(1e-12, accuracy * may / left), error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    more = find_growth(n);
  }
  if (!isfinite(more)) return NEWTON_SINGULAR;
  for (int k = 0; k < p->motions; ++k)
    for (int64_t i = 0; i < p->places; ++i) n->change[k][i] += more * n->unit_motion[k][i];
  n->factor_change = more;
  *work = unknowns_work(&n->linear.unknowns, n->force, n->change) +
          more * unknowns_work(&n->linear.unknowns, n->unit_force, n->change);
  return NEWTON_CONVERGED;
}

double newton_controlled_force(Newton *n)
{
  const Particles *p = n->domain->particles;
  double *const *kept = n->unit_force, sum = 0, factor = 0;
  for (int k = 0; k < p->motions; ++k) memcpy(kept[k], p->external[k], sizeof(double) * (size_t)p->places);
  for (int l = 0; l < n->loading->count; ++l) {
    const Load *load = &n->loading->loads[l];
    if (history_is_controlled(&load->history) && load_acts(n->loading, load))
      factor = fmax(factor, fabs(load->history.found));
  }
  team_run(apply_controlled, n);
  for (int64_t i = 0; i < p->places; ++i)
    sum += factor * p->volume[i] *
           sqrt(p->external[0][i] * p->external[0][i] + p->external[1][i] * p->external[1][i] +
                p->external[2][i] * p->external[2][i]);
  for (int k = 0; k < p->motions; ++k) memcpy(p->external[k], kept[k], sizeof(double) * (size_t)p->places);
  for (int m = 0; m < n->loading->constraint_count; ++m) {
    const Constraint *c = &n->loading->constraints[m];
    const Selection *on = &c->load->selection;
    double along = 0;
    if (!history_is_controlled(&c->load->history) || !load_acts(n->loading, c->load)) continue;
    for (int64_t at = 0; at < on->count; ++at)
      along += p->volume[on->places[at]] *
               (constraint_along(c, p->internal, on->places[at]) + constraint_along(c, p->external, on->places[at]));
    sum += fabs(along);
  }
  return sum;
}

int newton_check_control(Newton *n, Error *error)
{
  const double accuracy = 1e-8;
  const int64_t given_up = n->linear.given_up; /* the run gives up its ways by itself */
  if (newton_linearise(n, error) || linear_solver_prepare(&n->linear, error) ||
      find_unit_motion(n, accuracy, error) != NEWTON_CONVERGED)
    return BRECCIA_FAILURE;
  control_open(n->control);
  control_aim(n->control, n->unit_motion);
  n->linear.given_up = given_up;
  return control_check_answer(n->control, n->unit_motion, error);
}

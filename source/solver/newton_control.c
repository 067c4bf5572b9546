/* Newton's method where the factor of some loads is found, so that a measure of the displacements is as prescribed (control.h). */
#include "solver/newton.h"

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
  const Vector *room = &n->unit_motion;
  const Particles *p = n->domain->particles;
  const Unknowns *u = &n->linear.unknowns;
  vector_clear(room);
  unknowns_spread_controlled(u, room);
  domain_linear_step(n->domain, room, &n->unit_force);
  domain_change_forces(n->domain, room, &n->unit_force);
  loading_change(n->loading, p, room->row, n->unit_force.row);
  vector_copy(room, &p->external);
  team_run(apply_controlled, n);
  vector_weigh_sum(&n->unit_force, p->volume, &n->unit_force, &p->external);
  vector_copy(&p->external, room);
  vector_clear(room);
  unknowns_gather(u, &n->unit_force);
}

/** Displacements where the factor of controlled loads grows by 1. */
static NewtonOutcome find_unit_motion(Newton *n, double accuracy, Error *error)
{
  LinearRecord linear;
  find_unit_force(n);
  if (linear_solver_solve(&n->linear, &n->unit_force, &n->unit_motion, accuracy, &linear, error)) return NEWTON_FAILED;
  n->products += linear.iterations;
  n->indefinite |= linear.indefinite;
  unknowns_spread_controlled(&n->linear.unknowns, &n->unit_motion);
  return NEWTON_CONVERGED;
}

/** The factor by which controlled loads grow, so that the measure comes to its target. */
static double find_growth(const Newton *n)
{
  return (n->target - control_shown(n->control) - control_value(n->control, n->change.row)) /
         control_value(n->control, n->unit_motion.row);
}

NewtonOutcome newton_follow_control(Newton *n, double accuracy, double *work, Error *error)
{
  const Unknowns *u = &n->linear.unknowns;
  NewtonOutcome outcome = find_unit_motion(n, accuracy, error);
  if (outcome != NEWTON_CONVERGED) return outcome;
  if (n->iterations == 1) n->target += control_aim(n->control, &n->unit_motion);
  double more = find_growth(n);
  /* Loads that grow by much leave more out of balance by what their motion errs than the forces that are there: it is to leave no more than these. */
  const double left = accuracy * fabs(more) * sqrt(unknowns_product_of_forces(u, &n->unit_force, &n->unit_force)),
               may = fmax(0.3 * n->spec->residual * n->exerted,
                          accuracy * sqrt(unknowns_product_of_forces(u, &n->force, &n->force)));
  if (left > 2 * may && may > 0) {
    outcome = find_unit_motion(n, fmax(1e-12, accuracy * may / left), error);
    if (outcome != NEWTON_CONVERGED) return outcome;
    more = find_growth(n);
  }
  if (!isfinite(more)) return NEWTON_SINGULAR;
  vector_combine(1, &n->change, more, &n->unit_motion);
  n->factor_change = more;
  *work = vector_inner(&n->force, &n->change, 1) + more * vector_inner(&n->unit_force, &n->change, 1);
  return NEWTON_CONVERGED;
}

/** Sum of the sizes of external forces. */
static void add_force_sizes(void *context, int64_t first, int64_t last, double *sum)
{
  const Particles *p = context;
  const double *const *f = (const double *const *)p->external.row;
  for (int64_t i = first; i < last; ++i)
    *sum += p->volume[i] * sqrt(f[0][i] * f[0][i] + f[1][i] * f[1][i] + f[2][i] * f[2][i]);
}

double newton_controlled_force(Newton *n)
{
  Particles *p = n->domain->particles;
  const Vector *kept = &n->unit_force;
  double sum = 0, factor = 0;
  vector_copy(kept, &p->external);
  for (int l = 0; l < n->loading->count; ++l) {
    const Load *load = &n->loading->loads[l];
    if (history_is_controlled(&load->history) && load_acts(n->loading, load))
      factor = fmax(factor, fabs(load->history.found));
  }
  team_run(apply_controlled, n);
  vector_sum_tiles(&p->space, add_force_sizes, p, 1, &sum);
  sum *= factor;
  vector_copy(&p->external, kept);
  for (int m = 0; m < n->loading->constraint_count; ++m) {
    const Constraint *c = &n->loading->constraints[m];
    const Selection *on = &c->load->selection;
    double along = 0;
    if (!history_is_controlled(&c->load->history) || !load_acts(n->loading, c->load)) continue;
    for (int64_t at = 0; at < on->count; ++at)
      along += p->volume[on->places[at]] * (constraint_along(c, p->internal.row, on->places[at]) +
                                            constraint_along(c, p->external.row, on->places[at]));
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
  control_aim(n->control, &n->unit_motion);
  n->linear.given_up = given_up;
  return control_check_answer(n->control, &n->unit_motion, error);
}

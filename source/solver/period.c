/* Inverse iteration that begins with the answer at rest to the loads: K u(n+1) = M u(n). What the loads do not set off, as the bending of a plate that is
 * pulled along its axis, has no part in it but by roundings, so that the slowest vibration of the others comes out, and not the slowest of all. Its
 * omega squared is Rayleigh's quotient, which comes nearer by the fourth power of the ratio of the two slowest frequencies in each turn. A share of
 * it is taken as a shift, K + s M, which keeps apart what moves as a whole: what roundings have of that, or of slower vibrations, grows by less than
 * (1 + s / omega^2) / (s / omega^2) in a turn. */
#include "solver/period.h"

#include "loading/constraint.h"
#include "solver/modes.h"
#include <math.h>
#include <string.h>

typedef struct Search {
  Domain *domain;
  LinearSolver linear;
  Vector force, motion, mass; /* right-hand side, answer, and mass times the answer */
} Search;

static bool begins(const Loading *loading, const Load *load)
{
  return load->first == loading->stage && load_acts(loading, load) && !load->type->goes_on;
}

/** Forces that nothing balances once the loads of the stage have grown, with the particles where they are. */
static void find_pull(const Search *s, double time)
{
  const Loading *loading = s->linear.loading;
  Particles *p = s->domain->particles;
  vector_copy(&s->mass, &p->external);
  vector_clear(&p->external);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (!load->type->force || !load_acts(loading, load)) continue;
    load->type->force(load, p, loading_grown_factor(loading, load, time));
  }
  vector_weigh_sum(&s->force, p->volume, &p->internal, &p->external);
  vector_copy(&p->external, &s->mass);
}

/** Adds what strains of loads that begin with the stage exert. */
static int add_pull_of_strains(const Search *s, double time, Error *error)
{
  const Particles *p = s->domain->particles;
  vector_clear(&s->mass);
  const int status = domain_add_grown_strains(s->domain, time, &s->mass, error);
  vector_add_weighted(&s->force, p->volume, &s->mass);
  return status;
}

/** Adds forces by which the body answers where prescribed displacements have come to their full size and all else is held. */
static void add_pull_of_motions(const Search *s)
{
  const Loading *loading = s->linear.loading;
  const Particles *p = s->domain->particles;
  bool moves = false;
  vector_clear(&s->motion);
  for (int n = 0; n < loading->constraint_count; ++n) {
    const Constraint *c = &loading->constraints[n];
    if (c->order || c->value == 0 || c->images || !begins(loading, c->load)) continue;
    const double factor = history_factor(&c->load->history, history_rise(&c->load->history));
    for (int64_t at = 0; at < c->load->selection.count; ++at)
      constraint_add(c, s->motion.row, c->load->selection.places[at],
                     factor * c->value * (c->platen ? 1 : constraint_part(c, at)));
    moves = true;
  }
  if (!moves) return;
  domain_linear_step(s->domain, &s->motion, &s->mass);
  vector_add_weighted(&s->force, p->volume, &s->mass);
}

static int solve(Search *s, Error *error)
{
  const double accuracy = 1e-11, enough = 1e-6;
  LinearRecord record;
  vector_clear(&s->motion);
  if (linear_solver_solve(&s->linear, &s->force, &s->motion, accuracy, &record, error)) return BRECCIA_FAILURE;
  if (record.residual <= enough) return BRECCIA_OK;
  return error_add(error, BRECCIA_FAILURE,
                   "the slowest vibration could not be found: equations with the body's stiffness were solved up to a "
                   "residual of %.1g only; give the 'period' of 'quasi-static'",
                   record.residual);
}

/** Rayleigh's quotient of the answer, whose mass becomes the right-hand side of the next turn. NaN: nothing moves. */
static double turn(Search *s)
{
  const Particles *p = s->domain->particles;
  const Unknowns *u = &s->linear.unknowns;
  unknowns_spread(u, NAN, &s->motion);
  vector_weigh_product(&s->mass, p->volume, &p->inertia, &s->motion);
  unknowns_gather(u, &s->mass);
  unknowns_clear_rest(u, &s->motion);
  const double square = vector_inner(&s->mass, &s->motion, 1), work = vector_inner(&s->force, &s->motion, 1);
  if (!(square > 0)) return NAN;
  vector_combine(0, &s->force, 1 / sqrt(square), &s->mass);
  return work / square - s->linear.mass_factor;
}

/** @param[out] square  omega squared */
static int iterate(Search *s, double *square, Error *error)
{
  enum { MOST = 60 };
  const double exact = 1e-5, share = 0.1;
  int status = solve(s, error);
  if (status) return status;
  double found = turn(s), least = INFINITY;
  *square = found;
  if (!(found > 0)) return BRECCIA_OK;
  s->linear.mass_factor = share * found;
  status = linear_solver_prepare(&s->linear, error);
  for (int k = 0; k < MOST && !status && least > exact; ++k) {
    if ((status = solve(s, error))) break;
    const double next = turn(s), change = fabs(next - found) / fabs(next);
    found = next;
    if (k > 1 && !(change < least)) break; /* roundings have grown to something that the loads do not set off */
    least = change;
    *square = found;
  }
  return status;
}

/** The answer, or why there is none. */
static int judge(double square, double least, double *period, Error *error)
{
  if (isnan(square))
    return error_add(
        error, BRECCIA_USER_ERROR,
        "quasi-static: no load, prescribed displacement or strain that begins with this stage sets the body off, "
        "so that the period by which it should grow is not known; give a 'period'");
  if (square < -least)
    return error_add(error, BRECCIA_FAILURE,
                     "quasi-static: the body gives way by itself: a motion has a negative stiffness");
  if (square <= least)
    return error_add(error, BRECCIA_USER_ERROR,
                     "quasi-static: its loads move the body as a whole and nothing holds it, so that it does not come "
                     "to rest; hold it by 'displacement: [0, 0, 0]' or 'support', or let its loads balance each other");
  *period = 2 * acos(-1) / sqrt(square);
  return BRECCIA_OK;
}

int period_find(Domain *d, const Loading *loading, double time, double *period, Error *error)
{
  const double shift = modes_shift(d), nothing = 1e-7;
  const Particles *p = d->particles;
  Search s = {.domain = d,
              .linear = {.domain = d, .loading = loading, .unknowns = unknowns_of(d, loading), .mass_factor = shift}};
  double square = NAN;
  int status = vector_create(&s.force, &p->space, "quasi-static loading", error) &&
                       vector_create(&s.motion, &p->space, "quasi-static loading", error) &&
                       vector_create(&s.mass, &p->space, "quasi-static loading", error)
                   ? BRECCIA_OK
                   : BRECCIA_FAILURE;
  if (!status) {
    domain_evaluate(d, NULL);
    find_pull(&s, time);
    status = add_pull_of_strains(&s, time, error);
  }
  if (!status) {
    const bool elastic = domain_in_elastic_stage(d);
    domain_set_elastic_stage(d, true);
    status = domain_linearise(d, NULL, error);
    if (!status) forces_linearise(&d->forces);
    domain_set_elastic_stage(d, elastic);
  }
  if (!status) {
    add_pull_of_motions(&s);
    unknowns_gather(&s.linear.unknowns, &s.force);
    status = linear_solver_create(&s.linear, LINEAR_AUTOMATIC, error);
  }
  if (!status) status = linear_solver_prepare(&s.linear, error);
  if (!status) status = iterate(&s, &square, error);
  if (!status) status = judge(square, nothing * shift, period, error);
  linear_solver_destroy(&s.linear);
  vector_destroy(&s.force);
  vector_destroy(&s.motion);
  vector_destroy(&s.mass);
  domain_evaluate(d, NULL);
  return status;
}

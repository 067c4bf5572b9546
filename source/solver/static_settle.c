/* What an increment of statics leads to besides: bonds that break, and control of zero-energy modes that fades. */
#include "solver/static.h"

#include <math.h>
#include <string.h>

bool static_may_go_on_again(const Static *s)
{
  return isfinite(domain_lag_allowed(s->domain)) && !domain_is_elastic(s->domain);
}

int static_keep(Solver *run, Error *error)
{
  Static *s = run->own;
  state_copy_destroy(&s->whole);
  if (!static_may_go_on_again(s) && !static_may_slide(s)) return BRECCIA_OK;
  StateList list = {0};
  domain_state(s->domain, &list);
  solver_state(run, &list);
  const int status = state_copy(&s->whole, &list, error);
  state_list_destroy(&list);
  return status;
}

int static_give_back(Solver *run, Error *error)
{
  Static *s = run->own;
  StateList list = {0};
  domain_state(s->domain, &list);
  solver_state(run, &list);
  const int status = state_return(&s->whole, &list, error);
  state_list_destroy(&list);
  if (status) return status;
  newton_apply_loads(&s->newton, s->clock->time);
  increment_start(&s->increment);
  s->relaxation.prepared = NAN; /* else a restart would go on with other roundings */
  return BRECCIA_OK;
}

/** Lets bonds break and the body find equilibrium again, in turn, until no bond is beyond its limit.
 *  @param[out] outcome  why there is no equilibrium; @param[in,out] way  raised to what found it */
static int break_bonds(Solver *run, NewtonOutcome *outcome, TryBy *way, Error *error)
{
  Static *s = run->own;
  bool may_relax = true;
  int64_t broken;
  *outcome = NEWTON_CONVERGED;
  s->newton.interrupted = NULL; /* bonds that have broken in equilibrium stay so: what this leads to is found first */
  while (*outcome == NEWTON_CONVERGED &&
         (broken = increment_break(&s->increment, s->clock, s->spec->bonds_at_once)) > 0) {
    if (s->domain->out_of_memory) return error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
    text_add(&run->log, "  %lld bonds break\n", (long long)broken);
    *outcome = static_try(s, s->clock->time, (Try){0}, error);
    if (*outcome == NEWTON_ASTRAY && static_may_relax(s)) /* roundings decide where the first iteration leads */
      *outcome = static_try_others(s, *outcome, s->clock->time, &may_relax, way, error);
    if (*outcome == NEWTON_FAILED) return BRECCIA_FAILURE;
  }
  s->newton.interrupted = run->interrupted;
  return BRECCIA_OK;
}

/** Once more at the same time, on the way of the last try, which came to equilibrium.
 *  @param[in] first  it was the first on this way */
static int try_again(Static *s, bool first, TryBy by, NewtonOutcome *outcome, Error *error)
{
  if (!s->way.moved.row[0] && !vector_create(&s->way.moved, &s->domain->particles->space, "static solver", error))
    return BRECCIA_FAILURE;
  if (first) vector_copy(&s->way.moved, &s->newton.moved);
  *outcome = static_try(s, s->clock->time, (Try){.again = true, .by = by}, error);
  return *outcome == NEWTON_FAILED ? BRECCIA_FAILURE : BRECCIA_OK;
}

int static_settle(Solver *run, NewtonOutcome *outcome, bool *settled, TryBy *way, Error *error)
{
  enum { MOST = 20 };
  Static *s = run->own;
  const double enough = domain_lag_allowed(s->domain); /* what comes of so few is left to the next increment */
  int status = break_bonds(run, outcome, way, error);
  bool first = true; /* the last try began a way */
  *settled = true;
  for (int k = 0; !status && *outcome == NEWTON_CONVERGED && domain_lags(s->domain); ++k) {
    text_add(&run->log, "  again, with the control of zero-energy modes as it is now\n");
    NewtonOutcome again;
    if (try_again(s, first, BY_METHOD, &again, error)) return BRECCIA_FAILURE;
    const bool few = s->newton.unbalanced_before < enough;
    for (TryBy by = BY_SECANTS;
         by <= BY_RELAXATION && again < NEWTON_STOPPED && again != NEWTON_CONVERGED && static_may_relax(s); ++by) {
      text_add(&run->log, "    no equilibrium\n"); /* none near: the body jumps */
      if (try_again(s, false, by, &again, error)) return BRECCIA_FAILURE;
      *way = by > *way ? by : *way;
    }
    if (again != NEWTON_CONVERGED || (k == MOST && !few)) {
      s->lag = s->newton.unbalanced_before;
      *settled = false;
      break;
    }
    const int64_t broken = s->domain->broken_count;
    status = break_bonds(run, outcome, way,
                         error); /* what the stage leaves overloaded would stay whole if it was the last */
    first = s->domain->broken_count != broken;
    if (few && !first) break;
  }
  return status;
}

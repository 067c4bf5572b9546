/* How long explicit steps are: a plan of steps of one length leads to the next time at which one has to end, and is made again when the stable
 * step has fallen. */
#include "solver/explicit.h"
#include "solver/flutter.h"
#include "solver/period.h"
#include "solver/stable_step.h"

#include <math.h>

/** The longest step that the program takes by itself. */
static double longest_step(const Explicit *s)
{
  return s->spec->safety * s->clock->stable;
}

/** Damping shortens the stable step: local damping by 1 / sqrt(1 + its share), as its force changes sign with the velocity;
 *  mass-proportional damping leaves it, but is followed only by steps of up to its own time; stiffness-proportional damping works with
 *  velocities that lag behind (docs/theory.md 7).
 *  @param[in] mass  rate of mass-proportional damping */
static int find_damped(Domain *domain, const Loading *loading, const ExplicitSpec *spec, double mass, double *stable,
                       Error *error)
{
  const int status = stable_step(domain, stable, error);
  if (status) return status;
  const double springs = loading_eigenvalue(loading, domain->particles);
  if (springs > 0) *stable = 2 / sqrt(4 / (*stable * *stable) + springs);
  if (!isfinite(*stable)) return BRECCIA_OK;
  *stable /= sqrt(1 + spec->local_damping);
  if (spec->damping.stiffness > 0) *stable = stiffness_damping_step(spec->damping.stiffness, *stable);
  if (mass > 0) *stable = fmin(*stable, 1 / mass);
  return BRECCIA_OK;
}

/** A body that has lost its last bond keeps the step that it had. */
static int find_stable_step(Explicit *s, Error *error)
{
  double stable;
  int status = find_damped(s->domain, s->loading, s->spec, explicit_mass_damping(s), &stable, error);
  if (!status && isfinite(stable)) s->clock->stable = stable;
  if (!status && !isfinite(s->clock->stable))
    status = error_add(error, BRECCIA_FAILURE,
                       "the stable time step could not be found: no bond joins any particles; choose a longer "
                       "'horizon'");
  s->broken_at_estimate = s->domain->broken_count;
  s->step_at_estimate = s->clock->step;
  return status;
}

/** Steps of one length from the present time on: as long as allowed, and as many as end with the stop. */
static void step_to(Explicit *s, double stop, double longest)
{
  const int64_t count = (int64_t)fmax(1, ceil((stop - s->clock->time) / longest - 1e-9));
  s->plan.from = s->clock->time;
  s->plan.to = stop;
  s->plan.first = s->clock->step;
  s->plan.count = count;
  s->clock->time_step = (stop - s->clock->time) / (double)count;
}

/** True if steps of this length have become too long for the body. */
static bool is_too_long(const Explicit *s, double step)
{
  return !s->force && step > (isnan(s->spec->time_step) ? 1.1 * longest_step(s) : s->clock->stable);
}

/** Plans steps up to the next time at which one has to end, and foresees how many there will be in all. */
static void plan_steps(Explicit *s, const Solver *run)
{
  const double longest = isnan(s->fixed) || is_too_long(s, s->fixed) ? longest_step(s) : s->fixed,
               tiny = 1e-6 * longest;
  double stop = s->clock->stage_end, from;
  if (!isnan(s->fixed)) {
    const double begin = s->clock->stage_time;
    stop = fmin(stop, begin + s->fixed * (floor((s->clock->time - begin) / s->fixed + 1e-6) + 1));
  }
  for (int64_t k = run->stop_count; isnan(s->fixed) && k-- > 0;)
    if (run->stops[k] > s->clock->time + tiny && run->stops[k] < s->clock->stage_end - tiny) stop = run->stops[k];
  step_to(s, stop, longest);
  double later = 0;
  from = stop;
  for (int64_t k = 0; isnan(s->fixed) && k < run->stop_count; ++k)
    if (run->stops[k] > from + tiny && run->stops[k] < s->clock->stage_end - tiny) {
      later += ceil((run->stops[k] - from) / longest - 1e-9);
      from = run->stops[k];
    }
  if (s->clock->stage_end > from + tiny) later += ceil((s->clock->stage_end - from) / longest - 1e-9);
  s->clock->stage_last = s->plan.first + s->plan.count + (int64_t)later;
}

int explicit_follow(Solver *run, Text *warning, Error *error)
{
  Explicit *s = run->own;
  /* Steps; one bond in so many. No more than MANY measurements can come at once in a run, whatever breaks. */
  enum { SOON = 100, LATE = 1000, SHARE = 100, MANY = 20 };
  const int64_t broken = s->domain->broken_count - s->broken_at_estimate, since = s->clock->step - s->step_at_estimate;
  const int64_t bonds = s->domain->family.bonds / 2;
  const int64_t patience = broken * MANY > bonds ? 1 : broken * SHARE > bonds ? SOON : LATE;
  if (domain_may_stiffen(s->domain) && broken && since >= patience) {
    const int status = find_stable_step(s, error);
    if (status) return status;
    if (is_too_long(s, s->clock->time_step)) {
      if (!isnan(s->spec->time_step))
        text_add_warning(warning,
                         "step %lld: broken bonds have lowered the stable step to %.4g %s; the time step of %g %s is "
                         "divided from here on",
                         (long long)s->clock->step, s->clock->stable, s->clock->time_unit, s->fixed,
                         s->clock->time_unit);
      plan_steps(s, run);
    }
  }
  if (s->clock->step == s->plan.first + s->plan.count) plan_steps(s, run);
  return BRECCIA_OK;
}

double explicit_time_after_step(const Explicit *s)
{
  const int64_t taken = s->clock->step + 1 - s->plan.first;
  return taken == s->plan.count ? s->plan.to : s->plan.from + (double)taken * s->clock->time_step;
}

/** A step that the deck chooses must be a stable one. */
static int check_time_step(const Solver *run, const ExplicitSpec *spec, double stable, Text *warning, Error *error)
{
  const double chosen = spec->time_step, share = chosen / stable;
  const Document *document = run->reader->document;
  const Node *node = section_node(spec, "time step");
  const char *unit = run->clock.time_unit;
  if (share > 1 && !run->force)
    return node_error(
        document, node, error,
        "time step: %g %s is %.3g times the stable step of %.4g %s; choose a smaller one, leave it out, or run with "
        "--force",
        chosen, unit, share, stable, unit);
  if (warning && share > 0.9) {
    char where[WHERE_SIZE];
    node_where(document, node, where, sizeof where);
    text_add(warning, "%s%s: warning: time step: %g %s is %.3g times the stable step of %.4g %s",
             warning->length ? "\n" : "", where, chosen, unit, share, stable, unit);
  }
  return BRECCIA_OK;
}

/** How many steps of the deck's length there are until the end of the stage; 0 without such a length. */
static int64_t whole_steps(const Explicit *s)
{
  return isnan(s->fixed) ? 0 : (int64_t)floor((s->clock->stage_end - s->clock->stage_time) / s->fixed + 1e-6);
}

/** Refuses formulations that free motions make grow, unless stiffness damping holds them: by 1 % of critical at the highest frequency in the plane, 5 % in
 *  space (docs/theory.md 5.4).
 *  @param[in] slack  share of that which is enough: stages behind others begin with bodies that strains and broken bonds have changed */
static int check_formulations(const Solver *run, const ExplicitSpec *spec, double slack, Error *error)
{
  const char *why = domain_flutters(run->domain);
  const double share = run->domain->body.dimensions == 2 ? 0.01 : 0.05;
  double stable;
  if (!why) return BRECCIA_OK;
  if (run->domain->failure.criterion)
    return node_error(run->reader->document, spec->head.node, error,
                      "explicit: %s, and more so beside a crack: cracks stop where they should run on; expected 'form: "
                      "variational', or a deck in which no bond breaks",
                      why);
  const int status = stable_step(run->domain, &stable, error);
  if (status || isinf(stable) || spec->damping.stiffness >= slack * share * stable) return status;
  return node_error(run->reader->document, spec->head.node, error,
                    "explicit: %s: expected 'form: variational', or 'stiffness damping' of at least %.3g %s, %g %% of "
                    "critical at the highest frequency",
                    why, share * stable, run->clock.time_unit, 100 * share);
}

/** Damping by stiffness asks laws for elastic forces beside those of the step. */
static int check_stiffness_damping(const Solver *run, const ExplicitSpec *spec, Error *error)
{
  const Material *served = domain_without_trials(run->domain);
  if (!(spec->damping.stiffness > 0)) return BRECCIA_OK;
  const char *key = spec->damping_given.rayleigh ? "Rayleigh damping" : "stiffness damping";
  const Node *node = section_node(spec, key);
  if (run->domain->forces.count) {
    const char *kind = run->domain->forces.type[0]->name;
    return node_error(run->reader->document, node, error,
                      "%s: '%s' has no place in it yet; leave '%s' out, or take 'damping' alone", key, kind, kind);
  }
  if (served)
    return node_error(run->reader->document, node, error,
                      "%s: it tries strains beside those of the step, and the server of material '%s' cannot take a "
                      "trial back; take 'damping' alone, a server that can (docs/material-server.md), or a law of this "
                      "program",
                      key, served->name);
  return BRECCIA_OK;
}

/** The period of `quasi-static`, by which loads grow from here on. */
static int find_period(Solver *run, Error *error)
{
  Explicit *s = run->own;
  const QuasiStaticSpec *spec = s->spec->quasi_static;
  int status = BRECCIA_OK;
  if (!spec) return BRECCIA_OK;
  s->period = spec->period;
  if (isnan(spec->period)) {
    s->period = 0;
    if (domain_has_servers(run->domain))
      return node_error(run->reader->document, spec->head.node, error,
                        "quasi-static: the period cannot be found where a law runs in a server; give a 'period'");
    Error *reason = breccia_error_create();
    status = period_find(run->domain, run->loading, run->clock.time, &s->period, reason);
    if (status == BRECCIA_USER_ERROR)
      node_error(run->reader->document, spec->head.node, error, "%s", breccia_error_text(reason));
    else if (status)
      error_add_all(error, status, reason);
    breccia_error_destroy(&reason);
  }
  if (!status) loading_grow(run->loading, spec->ramp * s->period);
  return status;
}

/** How long the stage lasts that does not count steps. */
static double duration(const Explicit *s)
{
  const QuasiStaticSpec *spec = s->spec->quasi_static;
  return spec ? (spec->ramp + spec->hold) * s->period : s->spec->end_time;
}

int explicit_plan(Solver *run, Text *warning, Error *error)
{
  Explicit *s = run->own;
  const ExplicitSpec *spec = s->spec;
  int status = check_formulations(run, spec, 0.5, error);
  if (!status) status = check_stiffness_damping(run, spec, error);
  if (!status) status = find_period(run, error);
  if (!status) status = find_stable_step(s, error);
  if (status || (status = check_time_step(run, spec, s->clock->stable, warning, error))) return status;
  if (!(spec->local_damping > 0))
    flutter_warn_of_supports(run, s->clock->stable, spec->damping.stiffness, !spec->quasi_static, warning);
  s->fixed = spec->steps >= 0 && isnan(spec->time_step) ? longest_step(s) : spec->time_step;
  const double step = isnan(s->fixed) ? longest_step(s) : s->fixed;
  const double steps = spec->steps >= 0 ? (double)spec->steps : ceil(duration(s) / step - 1e-6);
  if (steps > 1e15)
    return node_error(run->reader->document, spec->head.node, error, "explicit: %.3g steps are too many", steps);
  s->clock->stage_end = s->clock->stage_time + (spec->steps >= 0 ? steps * s->fixed : duration(s));
  const int64_t whole = whole_steps(s);
  if (!whole && spec->steps != 0) {
    plan_steps(s, run);
    return BRECCIA_OK;
  }
  /* Fixed steps are planned at once; what is left of the end time after them becomes a shorter last one. */
  s->clock->time_step = s->fixed;
  s->clock->stage_last = s->clock->step + (int64_t)steps;
  s->clock->ended = steps == 0;
  s->plan.from = s->clock->time;
  s->plan.first = s->clock->step;
  s->plan.count = whole;
  s->plan.to = whole == (int64_t)steps ? s->clock->stage_end : s->plan.from + (double)whole * s->fixed;
  return BRECCIA_OK;
}

double explicit_last_step(const Explicit *s)
{
  const double left = s->clock->stage_end - s->clock->stage_time - (double)whole_steps(s) * s->fixed;
  return left > 1e-6 * s->fixed ? left : NAN;
}

int explicit_check(Solver *run, const void *spec, Error *error)
{
  double stable;
  int status = check_formulations(run, spec, 0.99, error); /* told with three digits */
  if (!status) status = check_stiffness_damping(run, spec, error);
  if (status || isnan(((const ExplicitSpec *)spec)->time_step)) return status;
  status = find_damped(run->domain, run->loading, spec, ((const ExplicitSpec *)spec)->damping.mass, &stable, error);
  return status ? status : check_time_step(run, spec, stable, NULL, error);
}

void explicit_plan_again(Solver *run)
{
  Explicit *s = run->own;
  if (isnan(s->fixed)) plan_steps(s, run);
}

void explicit_foresee(const void *section, const Clock *clock, double *steps, double *time)
{
  const ExplicitSpec *spec = section;
  const QuasiStaticSpec *slow = spec->quasi_static;
  if (slow && isnan(slow->period)) return; /* found when the stage begins */
  const double end = slow ? (slow->ramp + slow->hold) * slow->period : spec->end_time;
  const double step = isnan(spec->time_step) ? spec->safety * clock->stable : spec->time_step;
  const double count = spec->steps >= 0 ? (double)spec->steps : ceil(end / step - 1e-9);
  *steps += count;
  *time += spec->steps >= 0 ? count * step : end;
}

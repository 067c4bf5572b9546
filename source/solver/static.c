/* Bodies at rest under their loads: increments of loads and motions, each brought to equilibrium by Newton's method (newton.h), and bonds that break
 * in between, the most loaded first. Histories of loads run in the time of the stage, which need not be one of a clock. */
#include "solver/newton.h"
#include "solver/solver.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct StaticSpec {
  SectionHead head;
  double end_time, smallest;
  int64_t increments, bonds_at_once;
  NewtonSpec newton;
} StaticSpec;

static const Field static_fields[] = {
    {.key = "end time",
     .kind = FIELD_NUMBER,
     .offset = offsetof(StaticSpec, end_time),
     .dimension = "time",
     .standard = "1",
     .range = "(0, inf)",
     .meaning = "the stage ends at this time of its own; histories of loads run in it"},
    {.key = "increments",
     .kind = FIELD_COUNT,
     .offset = offsetof(StaticSpec, increments),
     .standard = "10",
     .range = "[1, 1e9]",
     .meaning = "equal ones; where one fails it is cut, and later ones grow again"},
    {.key = "smallest increment",
     .kind = FIELD_NUMBER,
     .offset = offsetof(StaticSpec, smallest),
     .dimension = "1",
     .standard = "1e-3",
     .range = "(0, 1]",
     .meaning =
         "share of an increment below which it is not cut any more: the body is then taken to find no equilibrium"},
    {.key = "bonds at once",
     .kind = FIELD_COUNT,
     .offset = offsetof(StaticSpec, bonds_at_once),
     .standard = "10",
     .range = "[1, 1e9]",
     .meaning = "so many bonds beyond their limit break before equilibrium is sought again, the most loaded first"},
    NEWTON_FIELDS(StaticSpec, newton),
};

const Section static_section = {.name = "static",
                                .about = "Equilibrium at rest, increment by increment, by Newton's method.",
                                .size = sizeof(StaticSpec),
                                FIELDS(static_fields)};

typedef struct Static {
  Domain *domain;
  const Loading *loading;
  const StaticSpec *spec;
  Clock *clock;
  Ledger *ledger;
  Newton newton;
  StateCopy before;
  /* at the beginning of an increment: */
  double *internal[3], *external[3]; /* forces per volume of bonds and of loads */
  double increment;                  /* to be tried next */
  double moved;                      /* largest motion since bonds were judged */
  int64_t cuts;                      /* in the stage */
} Static;

static void list_state(Solver *run, StateList *list)
{
  Static *s = run->own;
  state_add_number(list, "next increment", "time", STATE_COMMITTED, &s->increment);
  state_add_number(list, "exerted force", "force", STATE_COMMITTED, &s->newton.reference);
  state_add_count(list, "cuts of increments", STATE_COMMITTED, &s->cuts);
}

static void forget_before(Static *s)
{
  state_copy_destroy(&s->before);
  domain_keep_stresses(s->domain, false, NULL);
}

static void destroy(Solver *run)
{
  Static *s = run->own;
  newton_destroy(&s->newton);
  for (int k = 0; k < 3; ++k) {
    places_free(&s->internal[k]);
    places_free(&s->external[k]);
  }
  forget_before(s);
  free(s);
  run->own = NULL;
}

static int create(Solver *run, Error *error)
{
  Static *s = run->own = memory_zeroed(1, sizeof *s, "static solver", error);
  if (!s) return BRECCIA_FAILURE;
  *s = (Static){.domain = run->domain,
                .loading = run->loading,
                .spec = run->spec,
                .clock = &run->clock,
                .ledger = &run->ledger,
                .newton = {.domain = run->domain, .loading = run->loading}};
  s->newton.spec = &s->spec->newton;
  for (int k = 0; k < 3; ++k) {
    s->internal[k] = places_array(run->domain->particles->places, "forces", error);
    s->external[k] = places_array(run->domain->particles->places, "forces", error);
    if (!s->internal[k] || !s->external[k]) return BRECCIA_FAILURE;
  }
  return newton_create(&s->newton, error);
}

static bool damps(const Solver *run)
{
  (void)run;
  return true; /* what a body gives off on its way to rest is gone */
}

/* ---- what is planned ---- */

static double whole_increment(const StaticSpec *spec)
{
  return spec->end_time / (double)spec->increments;
}

static int check(Solver *run, const void *section, Error *error)
{
  const StaticSpec *spec = section;
  const Unknowns unknowns = unknowns_of(run->domain, run->loading);
  char motion[16];
  if (forces_strike(&run->domain->forces))
    return node_error(run->reader->document, spec->head.node, error,
                      "static: contact has no place in it yet; leave 'contact' out, or find rest by 'explicit' with "
                      "'local damping'");
  if (unknowns_are_loose(&unknowns, motion, sizeof motion))
    return node_error(run->reader->document, spec->head.node, error,
                      "static: nothing holds the body against moving %s as a whole; hold it by a support, a roller, a "
                      "displacement or a spring",
                      motion);
  return BRECCIA_OK;
}

static void count_steps(const Solver *run)
{
  const Static *s = run->own;
  Clock *clock = (Clock *)&run->clock;
  const double left = clock->stage_end - clock->time;
  clock->stage_last = clock->step + (int64_t)ceil(left / whole_increment(s->spec) - 1e-6);
}

static int plan(Solver *run, Text *warning, Error *error)
{
  (void)warning;
  Static *s = run->own;
  const int status = check(run, s->spec, error);
  if (status) return status;
  s->increment = whole_increment(s->spec);
  run->clock.stable = INFINITY;
  run->clock.time_step = s->increment;
  run->clock.stage_end = run->clock.stage_time + s->spec->end_time;
  count_steps(run);
  return BRECCIA_OK;
}

static void plan_again(Solver *run)
{
  (void)run; /* every increment looks at the times again */
}

static void foresee(const void *section, const Clock *clock, double *steps, double *time)
{
  (void)clock;
  const StaticSpec *spec = section;
  *steps += (double)spec->increments;
  *time += spec->end_time;
}

static void describe_stage(const void *section, const char *time, Text *text)
{
  const StaticSpec *spec = section;
  text_add(text, "static, %lld increments of %.4g %s", (long long)spec->increments, whole_increment(spec), time);
}

static void describe(const Solver *run, const char *time, Text *text)
{
  const Static *s = run->own;
  Error *none = NULL;
  describe_stage(s->spec, time, text);
  text_add(text, " for %lld unknowns, by %s", (long long)unknowns_count(&s->newton.linear.unknowns, none),
           linear_solver_name(&s->newton.linear));
}

/* ---- increments ---- */

static int keep_before(Solver *run, Error *error)
{
  Static *s = run->own;
  if (s->before.rows) return BRECCIA_OK;
  StateList list = {0};
  domain_state(s->domain, &list);
  solver_state(run, &list);
  int status = state_keep(&s->before, &list, error);
  state_list_destroy(&list);
  if (!status) status = domain_keep_stresses(s->domain, true, error);
  if (status) forget_before(s);
  return status;
}

static int begin(Solver *run, Error *error)
{
  (void)error;
  Static *s = run->own;
  Particles *p = s->domain->particles;
  run->ledger.damping_work += run->ledger.kinetic; /* of the stage before: it is at rest now */
  run->ledger.kinetic = 0;
  for (int k = 0; k < 3; ++k) memset(p->velocity[k], 0, sizeof(double) * (size_t)p->places);
  domain_tell_time(s->domain, run->clock.time, 0);
  domain_evaluate(s->domain);
  return BRECCIA_OK;
}

/** Where the increment ends: at a time that is asked for, if it comes before its end or hardly behind it. */
static double end_of_increment(const Solver *run, double increment)
{
  const Clock *clock = &run->clock;
  const double tiny = 1e-6 * increment;
  double end = clock->time + increment;
  if (end > clock->stage_end - tiny) end = clock->stage_end;
  for (int64_t k = 0; k < run->stop_count; ++k)
    if (run->stops[k] > clock->time + tiny && run->stops[k] < end + tiny) {
      end = run->stops[k];
      break;
    }
  return end;
}

/** Works by the trapezium rule. Forces out of balance at the beginning, of a load that was there already or of bonds that have broken, do work that the
 *  body gives off on its way to rest. */
static void book(Static *s)
{
  const Particles *p = s->domain->particles;
  double *const *moved = s->newton.moved, bonds = 0;
  for (int64_t b = 0; b < s->domain->batch_count; ++b) {
    double part = 0;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = s->domain->batches[b].first * SLICE; i < s->domain->batches[b].last * SLICE; ++i) {
        part -= 0.5 * p->volume[i] * (s->internal[k][i] + p->internal[k][i]) * moved[k][i];
        s->internal[k][i] = p->volume[i] * (s->internal[k][i] + s->external[k][i]);
      }
    bonds += part;
  }
  unknowns_gather(&s->newton.linear.unknowns,
                  s->internal); /* what was out of balance: nobody needs the forces any more */
  const double given_off = 0.5 * (unknowns_product(&s->newton.linear.unknowns, s->internal, moved) +
                                  unknowns_product(&s->newton.linear.unknowns, s->newton.force, moved));
  s->ledger->bond_work += bonds;
  s->ledger->damping_work += given_off;
  s->ledger->external_work += bonds + given_off;
}

static const char *describe_outcome(const Static *s, NewtonOutcome outcome, char *words, size_t size)
{
  const Domain *d = s->domain;
  const Particles *p = d->particles;
  switch (outcome) {
  case NEWTON_SLOW:
    snprintf(words, size, "%lld iterations left %.2g of the forces out of balance%s",
             (long long)s->newton.iterations - 1, s->newton.unbalanced,
             s->newton.indefinite ? ", and the body does not resist some motion any more" : "");
    break;
  case NEWTON_LAW: {
    const int64_t i = d->failed_place;
    const Material *m = &d->materials[d->material[i / SLICE]];
    snprintf(words, size, "the law %s of material '%s' could not be integrated at particle %d at [%g, %g, %g]",
             m->law_name, m->name, p->number[i], p->position[0][i], p->position[1][i], p->position[2][i]);
    break;
  }
  case NEWTON_SINGULAR: snprintf(words, size, "the body does not resist some motion at all"); break;
  default: snprintf(words, size, "the forces have grown beyond all bounds");
  }
  return words;
}

/** The state as it was before an increment that has failed. */
static void retreat(Static *s)
{
  const Particles *p = s->domain->particles;
  state_undo(&s->before);
  for (int k = 0; k < 3; ++k) memcpy(p->external[k], s->external[k], sizeof(double) * (size_t)p->places);
  domain_put_stresses_by(s->domain);
  domain_follow(s->domain);
}

static void note_places(void *context)
{
  Static *s = context;
  const Domain *d = s->domain;
  const Particles *p = d->particles;
  TEAM_FOR (b, d->batch_count) {
    const int64_t first = d->batches[b].first * SLICE, last = d->batches[b].last * SLICE;
    state_note_places(&s->before, first, last);
    for (int k = 0; k < 3; ++k) {
      memcpy(s->internal[k] + first, p->internal[k] + first, sizeof(double) * (size_t)(last - first));
      memcpy(s->external[k] + first, p->external[k] + first, sizeof(double) * (size_t)(last - first));
    }
  }
}

static void accept(void *context)
{
  domain_accept(context);
}

/** One try to come to equilibrium at a time of the run. */
static NewtonOutcome try_increment(Static *s, double end, Error *error)
{
  Domain *d = s->domain;
  state_note_others(&s->before);
  team_run(note_places, s);
  domain_put_stresses_by(d);
  domain_tell_time(d, end, end - s->clock->time);
  const NewtonOutcome outcome = newton_solve(&s->newton, end, error);
  if (outcome != NEWTON_CONVERGED) {
    retreat(s);
    return outcome;
  }
  book(s);
  const Particles *p = d->particles;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) s->moved = fmax(s->moved, fabs(s->newton.moved[k][i]));
  team_run(accept, d);
  domain_commit_points(d);
  forces_commit(&d->forces);
  return outcome;
}

static void break_bonds(void *context)
{
  struct {
    Domain *domain;
    Moment moment;
  } *of = context;
  domain_break(of->domain, &of->moment);
  domain_forces(of->domain);
  domain_accept(of->domain);
}

/** Breaks the most loaded bonds that are beyond their limit, at the displacements held, and commits what is left of the body, which is then not at
 *  rest. @return how many */
static int64_t break_most_loaded(Static *s)
{
  Domain *d = s->domain;
  const int64_t broken = d->broken_count;
  struct {
    Domain *domain;
    Moment moment;
  } of = {d,
          {.step = s->clock->step + 1,
           .time = s->clock->time,
           .motion = sqrt(3) * s->moved,
           .most = s->spec->bonds_at_once}};
  if (!d->failure.criterion && !d->gave_up) return 0;
  s->moved = 0;
  team_run(break_bonds, &of);
  domain_commit_points(d);
  forces_commit(&d->forces);
  return d->broken_count - broken;
}

/** Lets bonds break and the body find equilibrium again, in turn, until no bond is beyond its limit.
 *  @param[out] outcome  why there is no equilibrium */
static int settle(Solver *run, NewtonOutcome *outcome, Error *error)
{
  Static *s = run->own;
  int64_t broken;
  *outcome = NEWTON_CONVERGED;
  while (*outcome == NEWTON_CONVERGED && (broken = break_most_loaded(s)) > 0) {
    if (s->domain->out_of_memory) return error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
    text_add(&run->log, "  %lld bonds break\n", (long long)broken);
    *outcome = try_increment(s, s->clock->time, error);
    if (*outcome == NEWTON_FAILED) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

static int advance(Solver *run, Text *warning, Error *error)
{
  (void)warning;
  Static *s = run->own;
  Clock *clock = &run->clock;
  if (keep_before(run, error)) return BRECCIA_FAILURE;
  s->newton.log = &run->log;
  NewtonOutcome outcome;
  for (;;) {
    const double end = end_of_increment(run, s->increment);
    text_add(&run->log, "increment %lld, from time %.6g to %.6g\n", (long long)clock->step + 1, clock->time, end);
    outcome = try_increment(s, end, error);
    if (outcome == NEWTON_FAILED) return BRECCIA_FAILURE;
    if (outcome != NEWTON_CONVERGED) {
      char words[320];
      text_add(&run->log, "    no equilibrium: %s\n", describe_outcome(s, outcome, words, sizeof words));
    }
    if (outcome == NEWTON_CONVERGED) {
      clock->time_step = end - clock->time;
      clock->time = end;
      break;
    }
    ++s->cuts;
    s->increment = (end - clock->time) / 2;
    if (s->increment < s->spec->smallest * whole_increment(s->spec)) {
      char words[320];
      return error_add(error, BRECCIA_FAILURE,
                       "static: no equilibrium beyond time %g, with increments cut to %.2g: %s; the body may fail at "
                       "this load: go on with a stage "
                       "of 'explicit', or look at the loads and at the last pictures",
                       clock->time, s->increment, describe_outcome(s, outcome, words, sizeof words));
    }
  }
  const int64_t iterations = s->newton.iterations;
  if (settle(run, &outcome, error)) return BRECCIA_FAILURE;
  ++clock->step;
  if (outcome != NEWTON_CONVERGED) {
    char words[320];
    return error_add(error, BRECCIA_FAILURE,
                     "static: with %lld broken bonds the body finds no equilibrium any more at time %g: %s; it has "
                     "failed at this load: go on with "
                     "a stage of 'explicit', or prescribe displacements instead of forces",
                     (long long)s->domain->broken_count, clock->time,
                     describe_outcome(s, outcome, words, sizeof words));
  }
  if (iterations <= s->spec->newton.iterations / 2) s->increment = fmin(2 * s->increment, whole_increment(s->spec));
  clock->ended = clock->time >= clock->stage_end - 1e-9 * whole_increment(s->spec);
  count_steps(run);
  if (clock->ended) forget_before(s);
  return BRECCIA_OK;
}

const SolverType static_solver = {.name = "static",
                                  .create = create,
                                  .destroy = destroy,
                                  .plan = plan,
                                  .check = check,
                                  .plan_again = plan_again,
                                  .begin = begin,
                                  .advance = advance,
                                  .state = list_state,
                                  .damps = damps,
                                  .foresee = foresee,
                                  .describe = describe,
                                  .describe_stage = describe_stage};

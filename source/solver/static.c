/* Bodies at rest under their loads: increments of loads and motions, each brought to equilibrium by Newton's method (newton.h) or dynamic
 * relaxation (relaxation.h), and bonds that break in between, the most loaded first. Histories of loads run in the time of the stage, which need not be one of a clock. */
#include "solver/increment.h"
#include "solver/relaxation.h"
#include "solver/vectors.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct StaticSpec {
  SectionHead head;
  double end_time, smallest;
  int64_t increments, bonds_at_once, relaxation_iterations;
  const char *method;
  const ControlSpec *control;
  NewtonSpec newton;
} StaticSpec;

static const char *method_word(int k)
{
  static const char *const words[] = {"newton", "relaxation", NULL};
  return words[k];
}

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
    {.key = "method",
     .kind = FIELD_CHOICE,
     .offset = offsetof(StaticSpec, method),
     .standard = "newton",
     .meaning = "newton: by linearised equations; relaxation: by forces alone, as if the body came to rest in a damped "
                "motion (dynamic relaxation): it needs no tangents, and goes on to the next state of rest where a body "
                "gives way",
     .choice = method_word},
    {.key = "relaxation iterations",
     .kind = FIELD_COUNT,
     .offset = offsetof(StaticSpec, relaxation_iterations),
     .standard = "2000",
     .range = "[1, 1e9]",
     .meaning = "an increment that takes more by relaxation, at an evaluation of forces each, is tried again with half "
                "of its length"},
    {.key = "control",
     .kind = FIELD_SECTION,
     .offset = offsetof(StaticSpec, control),
     .standard = "",
     .meaning = "what controlled loads are to bring about",
     .section = &control_section},
    NEWTON_FIELDS(StaticSpec, newton),
};

const Section static_section = {.name = "static",
                                .about = "Equilibrium at rest, increment by increment.",
                                .size = sizeof(StaticSpec),
                                FIELDS(static_fields)};

/** From equilibrium at the begin of an increment, or with bonds that have broken in it, to the one that was found last: works are those between these
 *  two, whatever was tried on the way. */
typedef struct Way {
  double *moved[MOTIONS]; /* made where an increment is solved again; else what Newton's method has moved is all */
  double bonds, given_off, sudden; /* works booked of it */
} Way;

typedef struct Static {
  Domain *domain;
  const Loading *loading;
  const StaticSpec *spec;
  Clock *clock;
  Ledger *ledger;
  Newton newton;
  Relaxation relaxation; /* empty where Newton's method serves */
  Control control;
  Increment increment;
  Way way;
  double next;  /* length of the increment to be tried next */
  int64_t cuts; /* in the stage */
  bool lagged;  /* an increment kept a control that should have faded, and this was told */
} Static;

static void list_state(Solver *run, StateList *list)
{
  Static *s = run->own;
  state_add_number(list, "next increment", "time", STATE_LEARNED, &s->next);
  newton_state(&s->newton, list);
  control_state(&s->control, list);
  state_add_count(list, "cuts of increments", STATE_LEARNED, &s->cuts);
}

static void destroy(Solver *run)
{
  Static *s = run->own;
  newton_destroy(&s->newton);
  relaxation_destroy(&s->relaxation);
  vectors_free(s->way.moved);
  control_destroy(&s->control);
  increment_destroy(&s->increment);
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
  const int status = control_create(&s->control, s->spec->control, run->domain, run->reader, run->selections);
  if (status) return status;
  if (s->spec->control) s->newton.control = &s->control;
  s->newton.relaxes = !strcmp(s->spec->method, "relaxation");
  if (increment_create(&s->increment, run->domain, error) || newton_create(&s->newton, error)) return BRECCIA_FAILURE;
  if (domain_may_soften(run->domain) && !run->domain->forces.count && !s->newton.relaxes && !s->spec->control &&
      !vectors_make(s->newton.change_forces, run->domain->particles, "works", error))
    return BRECCIA_FAILURE;
  return s->newton.relaxes ? relaxation_create(&s->relaxation, &s->newton, error) : BRECCIA_OK;
}

static bool controls(const void *section)
{
  const StaticSpec *spec = section;
  return spec->control != NULL;
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

static int check_hold(const Solver *run, const StaticSpec *spec, Error *error)
{
  const Unknowns unknowns = unknowns_of(run->domain, run->loading);
  char motion[16];
  if (!unknowns_are_loose(&unknowns, motion, sizeof motion)) return BRECCIA_OK;
  return node_error(run->reader->document, spec->head.node, error,
                    "static: nothing holds the body against moving %s as a whole; hold it by a support, a roller, a "
                    "displacement or a spring",
                    motion);
}

static int check(Solver *run, const void *section, Error *error)
{
  const StaticSpec *spec = section;
  int status = increment_check(run, section, "find rest by 'explicit' with 'local damping'", error);
  if (!status && !run->loose) status = check_hold(run, spec, error);
  if (status) return status;
  if (spec->control && !strcmp(spec->method, "relaxation"))
    return node_error(run->reader->document, section_node(spec, "control"), error,
                      "control: dynamic relaxation cannot find factors of loads; leave 'method: relaxation' out");
  if (spec != run->spec) { /* that of the stage under way has its own already */
    Control control;
    status = control_create(&control, spec->control, run->domain, run->reader, run->selections);
    control_destroy(&control);
  }
  return status ? status : control_check(spec->control, run->loading, run->reader, error);
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
  int status = check(run, s->spec, error);
  if (status) return status;
  if (s->spec->control && !run->loose && run->clock.step == 0 && !domain_has_servers(s->domain) &&
      (status = newton_check_control(&s->newton, error)))
    return status;
  s->next = whole_increment(s->spec);
  run->clock.stable = INFINITY;
  run->clock.time_step = s->next;
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

static double exerted(const Solver *run)
{
  const Newton *n = &((const Static *)run->own)->newton;
  return fmax(n->reference, n->roundings / n->spec->residual);
}

static int measure(Solver *run, StepCost *cost, Error *error)
{
  return newton_measure(&((Static *)run->own)->newton, cost, error);
}

static void describe_stage(const void *section, const char *time, Text *text)
{
  const StaticSpec *spec = section;
  (void)time; /* it runs in one of its own */
  text_add(text, "static, %lld increment%s up to time %.4g", (long long)spec->increments,
           spec->increments == 1 ? "" : "s", spec->end_time);
}

static void describe(const Solver *run, const char *time, Text *text)
{
  const Static *s = run->own;
  Error *none = NULL;
  describe_stage(s->spec, time, text);
  text_add(text, ", for %lld unknowns, by %s", (long long)unknowns_count(&s->newton.linear.unknowns, none),
           s->newton.relaxes ? "dynamic relaxation" : linear_solver_words(&s->newton.linear));
}

/* ---- increments ---- */

static int begin(Solver *run, Error *error)
{
  Static *s = run->own;
  Particles *p = s->domain->particles;
  if (run->loose && check_hold(run, s->spec, error)) return BRECCIA_USER_ERROR;
  run->ledger.damping_work += run->ledger.kinetic; /* of the stage before: it is at rest now */
  run->ledger.kinetic = 0;
  vectors_clear(p->velocity, p);
  control_begin(&s->control);
  domain_tell_time(s->domain, run->clock.time, 0);
  domain_evaluate(s->domain);
  newton_note_forces_held(&s->newton);
  increment_start(&s->increment);
  return BRECCIA_OK;
}

/** Works by the trapezium rule. Forces out of balance at the beginning, of a load that was there already or of bonds that have broken, do work that the
 *  body gives off on its way to rest.
 *  @param[in] moved  on the whole way */
static void book(Static *s, double *const moved[MOTIONS])
{
  const Particles *p = s->domain->particles;
  const Increment *begin = &s->increment;
  double *const *before = s->newton.change; /* forces out of balance: of corrections nothing is wanted any more */
  double bonds = 0;
  for (int64_t b = 0; b < s->domain->batch_count; ++b) {
    double part = 0;
    for (int k = 0; k < p->motions; ++k)
      for (int64_t i = s->domain->batches[b].first * SLICE; i < s->domain->batches[b].last * SLICE; ++i) {
        part -= 0.5 * p->volume[i] * (begin->internal[k][i] + p->internal[k][i]) * moved[k][i];
        before[k][i] = p->volume[i] * (begin->internal[k][i] + begin->external[k][i]);
      }
    bonds += part;
  }
  unknowns_gather(&s->newton.linear.unknowns, before);
  const double given_off = 0.5 * (unknowns_work(&s->newton.linear.unknowns, before, moved) +
                                  unknowns_work(&s->newton.linear.unknowns, s->newton.force, moved));
  s->ledger->bond_work += bonds - s->way.bonds;
  s->ledger->damping_work += given_off - s->way.given_off;
  s->ledger->external_work += bonds + given_off - s->way.bonds - s->way.given_off;
  s->ledger->paid =
      fmax(s->ledger->paid, s->newton.rounding_work); /* less says nothing of a body that moves as a whole */
  s->way.bonds = bonds;
  s->way.given_off = given_off;
}

static void book_sudden(Static *s, double *const moved[MOTIONS])
{
  const double sudden = increment_sudden_work(&s->increment, moved);
  s->ledger->bond_work += sudden - s->way.sudden;
  s->ledger->external_work += sudden - s->way.sudden;
  s->way.sudden = sudden;
}

/** Whether the body softens on the way of an increment in which it has come to equilibrium, so that it may have passed a peak: what the work of an
 *  increment that goes on as it began is more than that by the trapezium rule bounds twice what that misses.
 *  @param[in] length  of the increment */
static bool is_coarse(const Static *s, double length)
{
  const double most = 0.02, least = 1.0 / 16; /* of the largest work so far; of an increment as asked for */
  const Particles *p = s->domain->particles;
  double work = 0;
  if (!s->newton.change_forces[0] || length / 2 < least * whole_increment(s->spec)) return false;
  for (int k = 0; k < p->motions; ++k)
    for (int64_t i = 0; i < p->places; ++i)
      work -= 0.5 * p->volume[i] * (s->increment.internal[k][i] + p->internal[k][i]) * s->newton.moved[k][i];
  const double held = s->ledger->bond_work; /* an unloaded body gives it all back */
  return 0.5 * (s->newton.foreseen - work) > most * fmax(fabs(held), fabs(held + work));
}

/** One try to come to equilibrium at a time of the run.
 *  @param[in] again  it goes on with the way of the try before, which came to equilibrium at the same time */
static NewtonOutcome try_increment(Static *s, double end, bool again, Error *error)
{
  if (again) {
    increment_begin_again(&s->increment);
  } else {
    increment_begin(&s->increment);
    s->way.bonds = s->way.given_off = s->way.sudden = 0;
  }
  domain_tell_time(s->domain, end, end - s->clock->time);
  if (s->spec->control) {
    const double begin = s->clock->stage_time, whole = s->clock->stage_end - begin;
    s->newton.target = control_target(&s->control, (s->clock->time - begin) / whole, (end - begin) / whole);
  }
  NewtonOutcome outcome = s->newton.relaxes
                              ? relaxation_solve(&s->relaxation, &s->newton, end, s->spec->relaxation_iterations, error)
                              : newton_solve(&s->newton, end, error);
  if (outcome == NEWTON_CONVERGED && !again && is_coarse(s, end - s->clock->time)) outcome = NEWTON_COARSE;
  if (outcome != NEWTON_CONVERGED) {
    increment_retreat(&s->increment);
    if (again) newton_apply_loads(&s->newton, s->clock->time);
    return outcome;
  }
  if (again) vectors_combine(s->domain, 1, s->way.moved, 1, s->newton.moved);
  book(s, again ? s->way.moved : s->newton.moved);
  if (s->spec->control) control_accept(&s->control, s->loading, s->newton.moved);
  increment_accept(&s->increment, s->newton.moved);
  book_sudden(s, again ? s->way.moved : s->newton.moved);
  return outcome;
}

/** Once more at the same time, on the way of the last try, which came to equilibrium.
 *  @param[in] first  it was the first on this way */
static int try_again(Static *s, bool first, NewtonOutcome *outcome, Error *error)
{
  if (!s->way.moved[0] && !vectors_make(s->way.moved, s->domain->particles, "static solver", error))
    return BRECCIA_FAILURE;
  if (first) vectors_combine(s->domain, 0, s->way.moved, 1, s->newton.moved);
  *outcome = try_increment(s, s->clock->time, true, error);
  return *outcome == NEWTON_FAILED ? BRECCIA_FAILURE : BRECCIA_OK;
}

/** Lets bonds break and the body find equilibrium again, in turn, until no bond is beyond its limit.
 *  @param[out] outcome  why there is no equilibrium */
static int break_bonds(Solver *run, NewtonOutcome *outcome, Error *error)
{
  Static *s = run->own;
  int64_t broken;
  *outcome = NEWTON_CONVERGED;
  while (*outcome == NEWTON_CONVERGED &&
         (broken = increment_break(&s->increment, s->clock, s->spec->bonds_at_once)) > 0) {
    if (s->domain->out_of_memory) return error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
    text_add(&run->log, "  %lld bonds break\n", (long long)broken);
    *outcome = try_increment(s, s->clock->time, false, error);
    if (*outcome == NEWTON_FAILED) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

/** Says once in a stage that forces are found with a control of zero-energy modes that should have faded. */
static void tell_lag(Static *s, Text *warning)
{
  if (!s->lagged)
    text_add(warning,
             "%swarning: static: at time %.6g no equilibrium is found with the control of zero-energy modes as far as "
             "it has faded; this increment keeps that of the one before, which leaves %.2g of the forces out of "
             "balance, and forces from here on may be too large: take more increments, or 'method: relaxation'",
             warning->length ? "\n" : "", s->clock->time, s->newton.unbalanced_before);
  s->lagged = true;
}

/** Equilibrium with what has come of the increment: bonds that it has overloaded, and what forces are found with as the step before left it, like
 *  the control of zero-energy modes that fades in correspondence. Where increments are few, what that holds besides would be spent as fracture energy.
 *  @param[out] outcome  why there is no equilibrium */
static int settle(Solver *run, NewtonOutcome *outcome, Text *warning, Error *error)
{
  enum { MOST = 20 };
  const double enough = 1e-2; /* of forces out of balance: what comes of so few is left to the next increment */
  Static *s = run->own;
  int status = break_bonds(run, outcome, error);
  bool first = true; /* the last try began a way */
  for (int k = 0; k < MOST && !status && *outcome == NEWTON_CONVERGED && domain_lags(s->domain); ++k) {
    text_add(&run->log, "  again, with the control of zero-energy modes as it is now\n");
    NewtonOutcome again;
    if (try_again(s, first, &again, error)) return BRECCIA_FAILURE;
    const bool few = s->newton.unbalanced_before < enough;
    if (again != NEWTON_CONVERGED) { /* the next increment will see to it, or fail and say so */
      text_add(&run->log, "    no equilibrium: control as it was is kept in this increment\n");
      if (!few) tell_lag(s, warning);
      break;
    }
    const int64_t broken = s->domain->broken_count;
    status =
        break_bonds(run, outcome, error); /* what the stage leaves overloaded would stay whole if it was the last */
    first = s->domain->broken_count != broken;
    if (few && !first) break;
  }
  return status;
}

/** The stage ends now: the body is torn. */
static void end_torn(Solver *run, Text *warning)
{
  const Static *s = run->own;
  Clock *clock = &run->clock;
  control_tell_torn(&s->control, clock->time, warning);
  clock->ended = 1;
  clock->stage_last = clock->step;
  clock->stage_end = clock->time;
}

/** A step that has failed for good before anything came of it. */
static int give_up(Static *s, double next, int64_t cuts)
{
  s->next = next;
  s->cuts = cuts;
  return BRECCIA_FAILURE;
}

static int advance(Solver *run, Text *warning, Error *error)
{
  Static *s = run->own;
  Clock *clock = &run->clock;
  const double first = s->next;
  const int64_t cuts = s->cuts;
  const bool was_spent = control_is_spent(&s->control);
  const int64_t broken = s->domain->broken_count;
  if (increment_keep(&s->increment, run, error)) return BRECCIA_FAILURE;
  s->newton.log = &run->log;
  NewtonOutcome outcome;
  for (;;) {
    const double end = increment_end(run, s->next);
    text_add(&run->log, "increment %lld, from time %.6g to %.6g\n", (long long)clock->step + 1, clock->time, end);
    outcome = try_increment(s, end, false, error);
    if (outcome == NEWTON_FAILED) return give_up(s, first, cuts);
    if (outcome != NEWTON_CONVERGED) {
      char words[320];
      text_add(&run->log, "    %s: %s\n", outcome == NEWTON_COARSE ? "cut" : "no equilibrium",
               newton_describe(&s->newton, outcome, words, sizeof words));
    }
    if (outcome == NEWTON_CONVERGED) {
      clock->time_step = end - clock->time;
      clock->time = end;
      break;
    }
    ++s->cuts;
    s->next = (end - clock->time) / 2;
    if (s->next < s->spec->smallest * whole_increment(s->spec)) {
      char words[320];
      error_add(error, BRECCIA_FAILURE, "static: no equilibrium beyond time %g, with increments cut to %.2g: %s; %s",
                clock->time, s->next, newton_describe(&s->newton, outcome, words, sizeof words),
                outcome == NEWTON_SLOW && domain_is_elastic(s->domain) && !s->newton.indefinite
                    ? "allow more 'iterations', or take a larger 'residual'"
                    : "the body may fail at this load: go on with a stage of 'explicit', or look at the loads and at "
                      "the last pictures");
      return give_up(s, first, cuts);
    }
  }
  const int64_t iterations = s->newton.iterations;
  const int status = settle(run, &outcome, warning, error);
  ++clock->step; /* what was found in it is committed, whatever has become of the rest */
  if (status) return BRECCIA_FAILURE;
  if (outcome != NEWTON_CONVERGED) {
    char words[320];
    return error_add(error, BRECCIA_FAILURE,
                     "static: with %lld broken bonds the body finds no equilibrium any more at time %g: %s; it has "
                     "failed at this load: go on with "
                     "a stage of 'explicit', or prescribe displacements instead of forces",
                     (long long)s->domain->broken_count, clock->time,
                     newton_describe(&s->newton, outcome, words, sizeof words));
  }
  const int64_t most = s->newton.relaxes ? s->spec->relaxation_iterations : newton_most_iterations(&s->newton);
  if (iterations <= (most + 1) / 2) s->next = fmin(2 * s->next, whole_increment(s->spec));
  clock->ended = clock->time >= clock->stage_end - 1e-9 * whole_increment(s->spec);
  count_steps(run);
  if (s->spec->control) control_note_exerted(&s->control, newton_controlled_force(&s->newton));
  /* Once without broken bonds it may be a load that changes its sign. */
  const bool again = was_spent || s->domain->broken_count > broken;
  if (!clock->ended && again && control_is_spent(&s->control)) end_torn(run, warning);
  if (clock->ended) increment_forget(&s->increment);
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
                                  .controls = controls,
                                  .damps = damps,
                                  .few_steps = true,
                                  .rests = true,
                                  .exerted = exerted,
                                  .foresee = foresee,
                                  .measure = measure,
                                  .describe = describe,
                                  .describe_stage = describe_stage};

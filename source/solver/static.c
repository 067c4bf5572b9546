/* Bodies at rest under their loads: increments of loads and motions, each brought to equilibrium by Newton's method (newton.h) or dynamic
 * relaxation (relaxation.h), and bonds that break in between, the most loaded first. Histories of loads run in the time of the stage, which need not be one of a clock. */
#include "solver/static.h"
#include "solver/pieces.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
     .words = (const char *const[]){[METHOD_NEWTON] = "newton", [METHOD_RELAXATION] = "relaxation", NULL}},
    {.key = "relaxation iterations",
     .kind = FIELD_COUNT,
     .offset = offsetof(StaticSpec, relaxation_iterations),
     .standard = "2000",
     .range = "[1, 1e9]",
     .meaning = "an increment that takes more by relaxation, at an evaluation of forces each, is tried again with half "
                "of its length"},
    {.key = "no equilibrium",
     .kind = FIELD_CHOICE,
     .offset = offsetof(StaticSpec, no_equilibrium),
     .standard = "stop",
     .meaning = "what happens where none is found: the run stops there, with an error; or the stage ends and the next "
                "one, as of "
                "'explicit', goes on from the last state of rest, without the bonds that have broken since",
     .words = (const char *const[]){"stop", "next stage", NULL}},
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

/** Adds the state of the jumps: ranges of increments, and the jump at the peak. */
static void list_jumps(Jumps *jumps, StateList *list)
{
  static const char *const names[] = {"first increments of jumps", "last increments of jumps"};
  int64_t *const rows[] = {jumps->first, jumps->last};
  state_add_count(list, "ranges of jumps", STATE_COMMITTED, &jumps->ranges);
  state_add_count(list, "jumps beyond the ranges", STATE_COMMITTED, &jumps->omitted);
  for (int k = 0; k < 2; ++k)
    state_add(list,
              &(StateRow){
                  .unit = "1", .kind = STATE_COUNTS, .role = STATE_COMMITTED, .count = JUMP_RANGES, .values = rows[k]},
              names[k], NULL);
  state_add_count(list, "increment of the peak jump", STATE_COMMITTED, &jumps->peak_step);
  state_add_count(list, "load of the peak jump", STATE_COMMITTED, &jumps->peak_load);
  state_add_number(list, "beginning of the peak jump", "time", STATE_COMMITTED, &jumps->peak_begin);
  state_add_number(list, "end of the peak jump", "time", STATE_COMMITTED, &jumps->peak_end);
}

static void list_state(Solver *run, StateList *list)
{
  Static *s = run->own;
  state_add_number(list, "next increment", "time", STATE_LEARNED, &s->next);
  newton_state(&s->newton, list);
  control_state(&s->control, list);
  state_add_count(list, "cuts of increments", STATE_LEARNED, &s->cuts);
  state_add_count(list, "increments by secants", STATE_COMMITTED, &s->descended);
  state_add_count(list, "increments by relaxation", STATE_COMMITTED, &s->relaxed);
  list_jumps(&s->jumps, list);
}

static void destroy(Solver *run)
{
  Static *s = run->own;
  descent_destroy(&s->descent);
  relaxation_destroy(&s->relaxation);
  newton_destroy(&s->newton);
  state_copy_destroy(&s->whole);
  vector_destroy(&s->way.moved);
  control_destroy(&s->control);
  increment_destroy(&s->increment);
  pressing_destroy(&s->pressing);
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
  s->newton.relaxes = s->spec->method == METHOD_RELAXATION;
  if (increment_create(&s->increment, run->domain, run->loading, error) || newton_create(&s->newton, error) ||
      pressing_create(&s->pressing, run->loading, error))
    return BRECCIA_FAILURE;
  const bool softens = s->spec->control ? domain_bonds_may_soften(run->domain) : domain_may_soften(run->domain);
  if (softens && !run->domain->forces.count && !s->newton.relaxes &&
      !vector_create(&s->newton.change_forces, &run->domain->particles->space, "works", error))
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

double static_whole_increment(const StaticSpec *spec)
{
  return spec->end_time / (double)spec->increments;
}

/** Of a stage to come parts may meet before it begins. Where bonds have broken pieces on which nothing acts are let be. */
static PiecesTaken pieces_to_hold(const Solver *run, const StaticSpec *spec)
{
  if (spec != run->spec && run->domain->forces.count) return PIECES_TOGETHER;
  return run->domain->broken_count ? PIECES_WORKED : PIECES_ALL;
}

static int check_hold(const Solver *run, const StaticSpec *spec, Error *error)
{
  const Unknowns unknowns = unknowns_of(run->domain, run->loading);
  const Particles *p = run->domain->particles;
  LoosePiece loose;
  char words[256];
  if (pieces_find_loose(&unknowns, pieces_to_hold(run, spec), &loose, error)) return BRECCIA_FAILURE;
  if (!loose.pieces) return BRECCIA_OK;
  return node_error(run->reader->document, spec->head.node, error,
                    "static: %s; hold it by a support, a roller, a displacement or a spring%s",
                    pieces_describe(&loose, p, words, sizeof words),
                    loose.whole                     ? ""
                    : run->domain->broken_count > 0 ? ", or go on with a stage of 'explicit'"
                                                    : ", or join it to the rest by bonds, ties or 'contact'");
}

static int check(Solver *run, const void *section, Error *error)
{
  const StaticSpec *spec = section;
  const bool solves = spec->method != METHOD_RELAXATION;
  int status = increment_check(run, section, solves ? &spec->newton : NULL,
                               "find rest by 'explicit' with 'local damping'", error);
  if (!status && !run->loose) status = check_hold(run, spec, error);
  if (status) return status;
  const SolveSpec *last = run->stages->items[run->stages->count - 1];
  if (static_hands_over(spec) && section_node(last, "static") == spec->head.node)
    return node_error(run->reader->document, section_node(spec, "no equilibrium"), error,
                      "no equilibrium: no stage comes after this one; add one, as of 'explicit', or leave this out");
  if (spec->control && spec->method == METHOD_RELAXATION)
    return node_error(run->reader->document, section_node(spec, "control"), error,
                      "control: dynamic relaxation cannot find factors of loads; leave 'method: relaxation' out");
  if (spec != run->spec) { /* that of the stage under way has its own already */
    Control control;
    status = control_create(&control, spec->control, run->domain, run->reader, run->selections);
    control_destroy(&control);
  }
  return status ? status : control_check(spec->control, run->loading, run->reader, error);
}

void static_count_steps(const Solver *run)
{
  const Static *s = run->own;
  Clock *clock = (Clock *)&run->clock;
  const double left = clock->stage_end - clock->time;
  clock->stage_last = clock->step + (int64_t)ceil(left / static_whole_increment(s->spec) - 1e-6);
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
  s->next = static_whole_increment(s->spec);
  run->clock.stable = INFINITY;
  run->clock.time_step = s->next;
  run->clock.stage_end = run->clock.stage_time + s->spec->end_time;
  static_count_steps(run);
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
  Static *s = run->own;
  cost->bytes += (double)increment_bytes(&s->increment, run);
  const bool jumps = domain_may_soften(s->domain) && static_may_relax(s); /* then both other ways may be made */
  if (jumps) cost->bytes += (double)descent_bytes(&s->descent, s->domain->particles);
  if (jumps || s->newton.relaxes) cost->bytes += (double)relaxation_bytes(&s->relaxation, s->domain->particles);
  if (static_may_go_on_again(s) || static_may_slide(s))
    cost->bytes += (double)(solver_kept_bytes(run, KEPT_ALL) + vector_bytes(&s->domain->particles->space));
  return newton_measure(&s->newton, cost, error);
}

static void describe_stage(const void *section, const char *time, Text *text)
{
  const StaticSpec *spec = section;
  text_add(text, "static, %lld increment%s up to time %.4g %s", (long long)spec->increments,
           spec->increments == 1 ? "" : "s", spec->end_time, time);
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
  vector_clear(&p->velocity);
  control_begin(&s->control);
  domain_tell_time(s->domain, run->clock.time, 0);
  domain_evaluate(s->domain, NULL);
  newton_note_forces_held(&s->newton);
  pressing_take_up(&s->newton, NULL);
  increment_start(&s->increment);
  return BRECCIA_OK;
}

const SolverType static_solver = {.name = "static",
                                  .create = create,
                                  .destroy = destroy,
                                  .plan = plan,
                                  .check = check,
                                  .plan_again = plan_again,
                                  .begin = begin,
                                  .advance = static_advance,
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

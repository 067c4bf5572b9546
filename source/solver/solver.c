#include "solver/solver.h"

#include "base/trap.h"
#include "solver/distortion.h"
#include "solver/resultants.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOLVER(name, about)                                                                                            \
  extern const SolverType name##_solver;                                                                               \
  extern const Section name##_section;
#include "solver/solvers.h"
#undef SOLVER

static const SolverType *const types[] = {
#define SOLVER(name, about) &name##_solver,
#include "solver/solvers.h"
#undef SOLVER
};

static const Field solve_fields[] = {
#define SOLVER(name, about)                                                                                            \
  {.key = #name,                                                                                                       \
   .kind = FIELD_SECTION,                                                                                              \
   .offset = offsetof(SolveSpec, of[SOLVER_##name]),                                                                   \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &name##_section,                                                                                         \
   .group = 'S'},
#include "solver/solvers.h"
#undef SOLVER
    {.key = "name",
     .kind = FIELD_TEXT,
     .offset = offsetof(SolveSpec, name),
     .standard = "",
     .meaning = "of the stage, for messages and the summary"},
    {.key = "laws",
     .kind = FIELD_CHOICE,
     .offset = offsetof(SolveSpec, laws),
     .standard = "as given",
     .meaning = "elastic: while this stage lasts, all laws answer elastically and no bond breaks",
     .words = (const char *const[]){[LAWS_AS_GIVEN] = "as given", [LAWS_ELASTIC] = "elastic", NULL}},
    {.key = "displacements",
     .kind = FIELD_CHOICE,
     .offset = offsetof(SolveSpec, displacements),
     .standard = "keep",
     .meaning =
         "zero: displacements that are written, drawn and watched count from the beginning of this stage; stresses, "
         "strains and what laws remember stay",
     .words = (const char *const[]){[DISPLACEMENTS_KEPT] = "keep", [DISPLACEMENTS_FROM_ZERO] = "zero", NULL}},
    {.key = "loads",
     .kind = FIELD_SECTIONS,
     .offset = offsetof(SolveSpec, loads),
     .standard = "",
     .meaning =
         "loads that begin with this stage; histories count from its beginning, prescribed motions from where the "
         "particles are then. Earlier loads go on; one of the same name is replaced",
     .section = &load_section},
    {.key = "without",
     .kind = FIELD_TEXTS,
     .offset = offsetof(SolveSpec, without),
     .standard = "",
     .meaning = "names of earlier loads that end"},
};

const Section solve_section = {.name = "solve",
                               .about = "How the equations are solved, or a stage of that.",
                               .size = sizeof(SolveSpec),
                               FIELDS(solve_fields)};

static const SolveSpec *stage_of(const Solver *s, int64_t stage)
{
  return s->stages->items[stage];
}

static int type_of(const SolveSpec *stage)
{
  int k = 0;
  while (!stage->of[k]) ++k;
  return k;
}

/** Steps and end of the run, from those of the stage under way and what later ones may take. */
static void foresee(Solver *s)
{
  double steps = 0, time = 0;
  for (int64_t k = s->clock.stage + 1; k < s->clock.stages; ++k) {
    const SolveSpec *stage = stage_of(s, k);
    types[type_of(stage)]->foresee(stage->of[type_of(stage)], &s->clock, &steps, &time);
  }
  s->clock.steps = s->clock.stage_last + (int64_t)fmin(steps, 1e15);
  s->clock.end_time = s->clock.stage_end + time;
}

double solver_strength_reduction(const Solver *s)
{
  int64_t stage = s->clock.stage;
  while (stage >= 0 && !(s->clock.time > s->records[stage].begin)) --stage;
  return loading_strength_reduction(s->loading, stage, s->clock.time);
}

const char *solver_stage_name(const Solver *s, int64_t stage, char *name, size_t size)
{
  if (stage_of(s, stage)->name)
    snprintf(name, size, "%s", stage_of(s, stage)->name);
  else
    snprintf(name, size, "%lld", (long long)stage + 1);
  return name;
}

bool solver_step_was_long(const Solver *s, int64_t step)
{
  int64_t stage = 0;
  while (stage < s->clock.stage && (double)step > s->records[stage].last_step) ++stage;
  return types[type_of(stage_of(s, stage))]->few_steps;
}

void solver_describe_stage(const Solver *s, int64_t stage, const char *time, Text *text)
{
  const int type = type_of(stage_of(s, stage));
  types[type]->describe_stage(stage_of(s, stage)->of[type], time, text);
}

/** Servers are not told of elastic stages, so that what they remember would not fit. */
static int check_laws(const Solver *s, Error *error)
{
  for (int64_t k = 0; k < s->clock.stages; ++k)
    for (int m = 0; m < s->domain->material_count && stage_of(s, k)->laws == LAWS_ELASTIC; ++m)
      if (s->domain->materials[m].remote)
        return node_error(s->reader->document, section_node(stage_of(s, k), "laws"), error,
                          "laws: the law of material '%s' runs in a server, which cannot be told to be elastic for a "
                          "stage; leave 'laws' out",
                          s->domain->materials[m].name);
  return BRECCIA_OK;
}

/** Makes the loads, laws and solver of a stage those in use. What the solver of the stage before keeps stays. */
static int take_stage(Solver *s, int64_t stage, Error *error)
{
  s->own = NULL;
  s->clock.stage = stage;
  s->stage = stage_of(s, stage);
  s->type = types[type_of(s->stage)];
  s->spec = s->stage->of[type_of(s->stage)];
  s->stops = NULL;
  s->stop_count = 0;
  domain_set_elastic_stage(s->domain, s->stage->laws == LAWS_ELASTIC);
  const int status = loading_enter(s->loading, s->domain->particles, stage, error);
  return status ? status : s->type->create(s, error);
}

int solver_enter(Solver *s, int64_t stage, Error *error)
{
  if (s->own) s->type->destroy(s);
  return take_stage(s, stage, error);
}

/** Says so where a load has a factor to be found and no stage in which it acts finds it. */
static int check_controlled(const Solver *s, Error *error)
{
  int status = BRECCIA_OK;
  for (int l = 0; l < s->loading->count; ++l) {
    const Load *load = &s->loading->loads[l];
    bool found = !history_is_controlled(&load->history);
    for (int64_t k = load->first; !found && k < s->clock.stages && k < load->behind; ++k) {
      const SolverType *type = types[type_of(stage_of(s, k))];
      found = type->controls && type->controls(stage_of(s, k)->of[type_of(stage_of(s, k))]);
    }
    if (!found)
      status = node_error(s->reader->document, load->history.value_node, error,
                          "controlled: no stage in which the load acts finds its factor; give a stage of 'static' a "
                          "'control'");
  }
  return status;
}

int solver_create(Solver *s, Text *warning, Error *error)
{
  bool zeroes = false;
  s->clock.stages = s->stages->count;
  s->clock.stable = INFINITY;
  units_name(s->reader->units, dimension_find("time"), s->clock.time_unit, sizeof s->clock.time_unit);
  s->records = memory_zeroed((size_t)s->clock.stages, sizeof *s->records, "stages", error);
  for (int64_t k = 0; k < s->clock.stages; ++k) zeroes |= stage_of(s, k)->displacements == DISPLACEMENTS_FROM_ZERO;
  if (!s->records || (zeroes && particles_make_zero(s->domain->particles, error))) return BRECCIA_FAILURE;
  int status = check_laws(s, error);
  if (!status) status = resultants_create(s, error);
  if (!status) status = check_controlled(s, error);
  if (!status) status = solver_enter(s, 0, error);
  if (!status) status = s->type->plan(s, warning, error);
  for (int64_t k = 1; !status && k < s->clock.stages; ++k) {
    const int type = type_of(stage_of(s, k));
    status = loading_enter(s->loading, s->domain->particles, k, error); /* with its springs and ties */
    if (!status) status = types[type]->check(s, stage_of(s, k)->of[type], error);
  }
  if (!status && s->clock.stages > 1) status = loading_enter(s->loading, s->domain->particles, 0, error);
  if (!status) foresee(s);
  return status;
}

void solver_destroy(Solver *s)
{
  if (s->own) s->type->destroy(s);
  resultants_destroy(s);
  free(s->records);
  text_free(&s->log);
  *s = (Solver){0};
}

static void zero_displacements(Particles *p)
{
  for (int k = 0; k < 3; ++k) memcpy(p->zero[k], p->displacement.row[k], sizeof(double) * (size_t)p->places);
}

/** A stage that cannot be planned leaves the end of the one before as it was, so that a checkpoint of that can be taken up. */
static void leave_stage(Solver *s, const Solver *before)
{
  if (s->own) s->type->destroy(s);
  *s = *before;
  domain_set_elastic_stage(s->domain, s->stage->laws == LAWS_ELASTIC);
  loading_enter(s->loading, s->domain->particles, s->clock.stage, NULL);
}

/** Begins with the loads of the stage under way. */
static void begin_loads(Solver *s)
{
  const Particles *p = s->domain->particles;
  loading_begin(s->loading, s->domain->particles, s->clock.time);
  if (!s->type->rests) loading_start_platens(s->loading, p, s->clock.time, s->clock.time_step);
}

int solver_next_stage(Solver *s, Text *warning, Error *error)
{
  Solver before = *s;
  Clock *clock = &s->clock;
  int status = take_stage(s, clock->stage + 1, error);
  clock->stage_step = clock->step;
  clock->stage_time = clock->time;
  clock->ended = 0;
  if (!status) status = s->type->plan(s, warning, error);
  if (status) {
    leave_stage(s, &before);
    return status;
  }
  if (before.own) before.type->destroy(&before);
  if (s->stage->displacements == DISPLACEMENTS_FROM_ZERO) zero_displacements(s->domain->particles);
  begin_loads(s);
  foresee(s);
  return solver_begin(s, error);
}

bool solver_is_done(const Solver *s)
{
  return s->clock.ended && s->clock.stage + 1 == s->clock.stages;
}

void solver_stop_at(Solver *s, const double *times, int64_t count, bool again)
{
  s->stops = times;
  s->stop_count = count;
  if (again) s->type->plan_again(s);
  foresee(s);
}

int solver_begin(Solver *s, Error *error)
{
  if (s->clock.stage == 0) {
    begin_loads(s);
    s->ledger.stored_at_start = s->domain->initial_energy + forces_energy(&s->domain->forces);
  }
  const double kinetic = s->ledger.kinetic;
  s->ledger.damped |= s->type->damps(s);
  s->records[s->clock.stage] = (StageRecord){.first_step = (double)s->clock.step, .begin = s->clock.time};
  const int status = s->type->begin(s, error);
  s->unbegun = status != BRECCIA_OK;
  if (!status) domain_book_strains(s->domain);
  if (s->clock.stage == 0) {
    s->ledger.kinetic_at_start = s->ledger.kinetic;
    s->ledger.bond_work += s->ledger.stored_at_start; /* done before the run */
    s->ledger.paid = s->ledger.kinetic + s->ledger.stored_at_start;
  } else if (s->loading->speeds_set) /* a blow from outside, or a loss where particles are tied that moved apart */
    s->ledger.external_work += s->ledger.kinetic - kinetic;
  ledger_note_strains(&s->ledger, s->domain);
  return status;
}

/** The state's rows; what the caller gives back by itself counts as what changes only when a step has come out well. */
static void list_kept(Solver *s, Kept kept, StateList *list)
{
  const Particles *p = s->domain->particles;
  domain_state(s->domain, list);
  solver_state(s, list);
  for (int n = 0; n < list->count && kept != KEPT_ALL; ++n)
    for (int k = 0; k < p->space.rows; ++k) {
      const bool moves = body_moves_along(&s->domain->body, k);
      if ((kept == KEPT_BUT_MOTION || !moves) &&
          (list->rows[n].values == p->displacement.row[k] || list->rows[n].values == p->velocity.row[k]))
        list->rows[n].role = STATE_COMMITTED;
    }
}

size_t solver_kept_bytes(Solver *s, Kept kept)
{
  StateList list = {0};
  list_kept(s, kept, &list);
  size_t bytes = state_bytes(&list, kept != KEPT_ALL);
  state_list_destroy(&list);
  for (int r = 0; r < s->domain->region_count && kept != KEPT_ALL; ++r)
    bytes += points_kept_bytes(&s->domain->regions[r].points);
  return bytes;
}

int solver_keep(Solver *s, Kept kept, StateCopy *before, Error *error)
{
  if (before->rows) return BRECCIA_OK;
  StateList list = {0};
  list_kept(s, kept, &list);
  int status = state_keep(before, &list, error);
  state_list_destroy(&list);
  if (!status) status = domain_keep_stresses(s->domain, true, error);
  if (status) solver_forget(s->domain, before);
  return status;
}

void solver_forget(Domain *domain, StateCopy *before)
{
  state_copy_destroy(before);
  domain_keep_stresses(domain, false, NULL);
}

int solver_measure(Solver *s, StepCost *cost, Error *error)
{
  const double most = 1.2; /* what a step does beside the forces takes 2 to 40 % of them (docs/performance.md) */
  *cost = (StepCost){.evaluations = most};
  const int status = s->type->measure ? s->type->measure(s, cost, error) : BRECCIA_OK;
  if (s->type->bytes) cost->bytes = (double)s->type->bytes(s);
  double own = (double)(s->clock.stage_last - s->clock.step), all = own, others = 0;
  for (int64_t k = s->clock.stage + 1; k < s->clock.stages; ++k) {
    const SolverType *type = types[type_of(stage_of(s, k))];
    double steps = 0, time = 0;
    type->foresee(stage_of(s, k)->of[type_of(stage_of(s, k))], &s->clock, &steps, &time);
    cost->least |= type->measure || steps == 0; /* tried are only the equations of the stage under way */
    *(type == s->type ? &own : &others) += steps;
    all += steps;
  }
  if (all > 0) {
    cost->seconds *= own / all;
    cost->evaluations = (own * cost->evaluations + others * most) / all;
  }
  return status;
}

bool solver_foresees_steps(const Solver *s)
{
  bool known = true;
  for (int64_t k = s->clock.stage + 1; k < s->clock.stages; ++k) {
    double steps = 0, time = 0;
    types[type_of(stage_of(s, k))]->foresee(stage_of(s, k)->of[type_of(stage_of(s, k))], &s->clock, &steps, &time);
    known &= steps > 0 || time == 0;
  }
  return known;
}

bool solver_stage_rests(const Solver *s, int64_t stage)
{
  return types[type_of(stage_of(s, stage))]->rests;
}

bool solver_linearises(const SectionList *stages)
{
  bool linearises = stages->count == 0;
  for (int k = 0; k < stages->count; ++k) {
    const SolveSpec *stage = stages->items[k];
    const SolverType *type = types[type_of(stage)];
    linearises |= !type->linearises || type->linearises(stage->of[type_of(stage)]);
  }
  return linearises;
}

double solver_stage_steady(const Solver *s, int64_t stage)
{
  const int type = type_of(stage_of(s, stage));
  return types[type]->steady ? types[type]->steady(stage_of(s, stage)->of[type]) : NAN;
}

double solver_stage_damping(const Solver *s, int64_t stage, const Node **node)
{
  const int type = type_of(stage_of(s, stage));
  const void *spec = stage_of(s, stage)->of[type];
  *node = section_node(spec, "damping");
  return types[type]->damping ? types[type]->damping(spec) : 0;
}

double solver_time_in_motion(const Solver *s)
{
  double whole = solver_stage_rests(s, s->clock.stage) ? 0 : s->clock.stage_end - s->clock.stage_time;
  for (int64_t k = s->clock.stage + 1; k < s->clock.stages; ++k) {
    double steps = 0, time = 0;
    types[type_of(stage_of(s, k))]->foresee(stage_of(s, k)->of[type_of(stage_of(s, k))], &s->clock, &steps, &time);
    if (!solver_stage_rests(s, k)) whole += time;
  }
  return whole;
}

/** @param[in] step, time, unit  at the end of the step in which the trap has sprung, if it has; and of that time */
static int tell_trap(const Trap *trap, int64_t step, double time, const char *unit, Error *error)
{
  Text words = {0};
  int status = BRECCIA_OK;
  if (trap_tell(trap, &words))
    status = error_add(error, BRECCIA_FAILURE, "step %lld (time %g %s): floating-point trap: %s", (long long)step, time,
                       unit, text_words(&words));
  text_free(&words);
  return status;
}

/** Returns true if distortion is to be checked: after static increments, at the ends of stages, and at intervals
 * before. A check takes as long as a few evaluations of forces. */
static bool solver_looks_at_distortion(const Solver *s)
{
  const int64_t every = s->type->rests ? 1 : s->type->few_steps ? 10 : 100;
  return s->clock.ended || s->clock.step % every == 0;
}

/** Adds the current values of active loads and prescribed motions, each with its line in the deck. */
static void solver_tell_loads(const Solver *s, Text *text)
{
  enum { FEW = 5 };
  int told = 0;
  for (int k = 0; k < s->loading->count && told < FEW; ++k) {
    const Load *load = &s->loading->loads[k];
    const char *dimension, *kind = load_kind(load->spec, &dimension);
    const double factor = load->type->timeless ? 1 : load_factor(load, s->clock.time);
    char unit[64];
    if (!load_acts(s->loading, load) || load_magnitude(load->spec) == 0) continue;
    units_name(s->reader->units, dimension_find(dimension), unit, sizeof unit);
    text_add(text, "%s%s (line %d) ", told++ ? ", " : "; loads: ", kind, load->spec->head.node->line);
    text_add(text, "at %.6g%s%s", load_value(load->spec, factor), *unit ? " " : "", unit);
  }
}

/** Fails if the deformation of the body is impossible, with the current loads in the message. */
static int solver_watch_distortion(Solver *s, Error *error)
{
  Text loads = {0};
  solver_tell_loads(s, &loads);
  const int status = distortion_watch(s->domain, &s->clock, s->type->rests, text_words(&loads), error);
  text_free(&loads);
  if (status) ledger_give_up(&s->ledger);
  return status;
}

int solver_advance(Solver *s, Text *warning, Error *error)
{
  Trap trap = {0};
  const int64_t step = s->clock.step + 1;
  const double time = s->clock.time;
  text_free(&s->log);
  if (s->trap) trap_begin(&trap);
  const int failed = s->type->advance(s, warning, error);
  if (s->trap) trap_end();
  const int trapped = tell_trap(&trap, step, time + s->clock.time_step, s->clock.time_unit, error);
  if (failed && s->clock.step < step) return failed; /* and the state is a good one, even if a trap has sprung */
  foresee(s);
  s->records[s->clock.stage].last_step = (double)s->clock.step;
  s->records[s->clock.stage].end = s->clock.time;
  ledger_note_strains(&s->ledger, s->domain);
  ledger_note_paid(&s->ledger);
  if (failed) return failed;
  s->ledger.trapped = trapped;
  int status = trapped ? trapped : ledger_watch(&s->ledger, s->domain, &s->clock, s->reader->units, error);
  if (!status && solver_looks_at_distortion(s)) status = solver_watch_distortion(s, error);
  if (!status) resultants_note(s);
  return status;
}

/** Adds -1/2 of the internal forces' work on changes of displacements, that is half of the work done on bonds. */
static double solver_half_work(const Domain *d, const Vector *change)
{
  return -0.5 * vector_inner_weighted(d->counted, &d->particles->internal, NULL, change);
}

int solver_take_motion(Solver *s, const Vector *displacement, const Vector *velocity, Error *error)
{
  const Domain *d = s->domain;
  const Particles *p = d->particles;
  const Vector *v = &p->velocity;
  double kinetic = 0.5 * (vector_inner_mass(d->counted, &p->inertia, v, v) -
                          vector_inner_mass(d->counted, &p->inertia, velocity, velocity));
  vector_combine(-1, displacement, 1, &p->displacement);
  vector_combine(-1, velocity, 1, v);
  const bool moved = !vector_is_zero(displacement), kicked = !vector_is_zero(velocity);
  if (!moved && !kicked) return BRECCIA_OK;
  if (s->type->rests) kinetic = 0; /* nothing moves there, whatever is written */
  double bonds = solver_half_work(d, displacement);
  const int status = s->type->begin(s, error);
  if (status) return status;
  bonds += solver_half_work(d, displacement);
  s->ledger.bond_work += bonds;
  s->ledger.external_work += bonds + kinetic;
  ledger_note_paid(&s->ledger);
  return BRECCIA_OK;
}

Energy solver_energy(const Solver *s)
{
  Energy e = ledger_energy(&s->ledger, s->domain);
  const double springs = loading_energy(s->loading, s->domain->particles); /* their work is among that of loads */
  const double dashpots = loading_dissipated(s->loading);                  /* what these take too */
  e.stored += springs;
  e.damping += dashpots;
  e.external += springs + dashpots;
  return e;
}

void solver_state(Solver *s, StateList *list)
{
  Clock *clock = &s->clock;
  state_add_count(list, "step", STATE_TRIED, &clock->step);
  state_add_count(list, "steps", STATE_TRIED, &clock->steps);
  state_add_number(list, "time", "time", STATE_TRIED, &clock->time);
  state_add_number(list, "end time", "time", STATE_TRIED, &clock->end_time);
  state_add_number(list, "time step", "time", STATE_TRIED, &clock->time_step);
  state_add_number(list, "stable step", "time", STATE_TRIED, &clock->stable);
  state_add_count(list, "stage", STATE_TRIED, &clock->stage);
  state_add_count(list, "first step of the stage", STATE_TRIED, &clock->stage_step);
  state_add_number(list, "begin of the stage", "time", STATE_TRIED, &clock->stage_time);
  state_add_count(list, "last step of the stage", STATE_TRIED, &clock->stage_last);
  state_add_number(list, "end of the stage", "time", STATE_TRIED, &clock->stage_end);
  state_add_count(list, "stage has ended", STATE_TRIED, &clock->ended);
  state_add(
      list,
      &(StateRow){.unit = "1", .role = STATE_COMMITTED, .count = STAGE_NUMBERS * clock->stages, .values = s->records},
      "stages", NULL);
  resultants_state(s, list);
  loading_state(s->loading, list);
  ledger_state(&s->ledger, list);
  s->type->state(s, list);
}

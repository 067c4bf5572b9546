/* Velocity Verlet (docs/theory.md 7), with g = a - c v, all forces over the mass:
 *   v+ = v + dt/2 g,  u' = u + dt v+,  a' = (f(u') + b - local damping) / rho,  v' = (v+ + dt/2 a') / (1 + c dt/2).
 * Works are summed by the trapezium rule over the step. The kinetic energy of v then grows by more than their sum, whatever the forces, by
 * exactly dt^2 / 8 sum m (g'^2 - g^2): the speeds at full steps are not those at which the works are done. */
#include "solver/explicit.h"

#include "base/team.h"
#include "solver/damping.h"
#include "solver/rest.h"
#include <math.h>
#include <stdlib.h>

static bool is_damped(const ExplicitSpec *spec)
{
  return spec->quasi_static || spec->damping.mass > 0 || spec->damping.stiffness > 0 || spec->local_damping > 0;
}

static void check_explicit(const DeckReader *reader, void *section)
{
  ExplicitSpec *spec = section;
  static const char *const others[] = {"damping", "Rayleigh damping", "local damping", NULL};
  spec->damping = damping_of(&spec->damping_given, reader, section);
  for (int k = 0; spec->quasi_static && others[k]; ++k)
    if (section_node(section, others[k]) != spec->head.node)
      node_error(
          reader->document, section_node(section, others[k]), reader->error,
          "%s: 'quasi-static' damps the slowest vibration by itself, by its 'damping ratio'; leave one of them out",
          others[k]);
  if (!isnan(spec->rest) && !is_damped(spec))
    node_error(reader->document, section_node(section, "rest"), reader->error,
               "rest: without 'damping' or 'local damping' a body does not come to rest");
}

static const Field explicit_fields[] = {
    {.key = "time step",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ExplicitSpec, time_step),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "when absent: 'safety' times the stable step, which is found by the program"},
    {.key = "safety",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ExplicitSpec, safety),
     .dimension = "1",
     .standard = "0.8",
     .range = "(0, 1]",
     .meaning = "share of the stable step taken when 'time step' is absent"},
    {.key = "steps",
     .kind = FIELD_COUNT,
     .offset = offsetof(ExplicitSpec, steps),
     .standard = "",
     .range = "[0, 1e15]",
     .meaning = "number of steps",
     .group = 'A'},
    {.key = "end time",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ExplicitSpec, end_time),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "the run, or this stage of it, ends at this time, if need be with a shorter last step",
     .group = 'A'},
    {.key = "quasi-static",
     .kind = FIELD_SECTION,
     .offset = offsetof(ExplicitSpec, quasi_static),
     .standard = "",
     .meaning =
         "loads grow over two periods of the slowest vibration that they set off, and are held for a third, with "
         "critical damping (all three can be set); the run says whether the body is steady then or has failed",
     .section = &quasi_static_section,
     .group = 'A'},
    DAMPING_FIELDS(ExplicitSpec, damping_given),
    {.key = "local damping",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ExplicitSpec, local_damping),
     .dimension = "1",
     .standard = "0",
     .range = "[0, 1)",
     .meaning =
         "Cundall's damping: a share of the force out of balance, against the velocity; 0.8 finds states of rest"},
    {.key = "rest",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ExplicitSpec, rest),
     .dimension = "1",
     .standard = "",
     .range = "(0, 1)",
     .meaning = "end earlier, once the body is at rest: forces out of balance are below this share of those that act, "
                "and kinetic energy of the work; 1e-3 is usual. Loads must have become steady"},
};
const Section explicit_section = {.name = "explicit",
                                  .about = "Explicit dynamics by velocity Verlet.",
                                  .size = sizeof(ExplicitSpec),
                                  FIELDS(explicit_fields),
                                  .check = check_explicit};

static void list_state(Solver *run, StateList *list)
{
  Explicit *s = run->own;
  state_add_vector(list, "acceleration", "acceleration", STATE_COMMITTED, s->acceleration.row,
                   s->domain->particles->places);
  particles_state_rotations("angular acceleration", "1", STATE_COMMITTED, &s->acceleration, list);
  if (s->viscous.time > 0)
    state_add_vector(list, "drag of stiffness", "force per volume", STATE_TRIED, s->viscous.drag.row,
                     s->domain->particles->places);
  if (s->viscous.time > 0)
    particles_state_rotations("moment of stiffness drag", "stress", STATE_TRIED, &s->viscous.drag, list);
  state_add_number(list, "period", "time", STATE_COMMITTED, &s->period);
  state_add_number(list, "fixed step", "time", STATE_TRIED, &s->fixed);
  state_add_number(list, "plan from", "time", STATE_TRIED, &s->plan.from);
  state_add_number(list, "plan to", "time", STATE_TRIED, &s->plan.to);
  state_add_count(list, "first step of the plan", STATE_TRIED, &s->plan.first);
  state_add_count(list, "steps of the plan", STATE_TRIED, &s->plan.count);
  state_add_count(list, "broken at the stable step", STATE_TRIED, &s->broken_at_estimate);
  state_add_count(list, "step of the stable step", STATE_TRIED, &s->step_at_estimate);
}

static int create(Solver *run, Error *error)
{
  Domain *d = run->domain;
  Explicit *s = run->own = memory_zeroed(1, sizeof *s, "explicit solver", error);
  if (!s) return BRECCIA_FAILURE;
  *s = (Explicit){.domain = d,
                  .loading = run->loading,
                  .spec = run->spec,
                  .clock = &run->clock,
                  .ledger = &run->ledger,
                  .force = run->force};
  /* Nothing leads out of a plane, or off a line: loads that would are refused. */
  for (int k = 0; k < d->particles->space.rows; ++k)
    if (body_moves_along(&d->body, k)) s->rows[s->row_count++] = k;
  ledger_begin(&run->ledger, d);
  const bool failed = !vector_reserve(&s->acceleration, &d->particles->space, "accelerations", error);
  s->sums = memory_zeroed((size_t)d->batch_count, sizeof *s->sums, "energy sums", error);
  int64_t parts = 0;
  for (int n = 0; n < run->loading->constraint_count; ++n)
    if (explicit_parts_of(&run->loading->constraints[n]) > parts)
      parts = explicit_parts_of(&run->loading->constraints[n]);
  s->parts = memory_zeroed((size_t)parts, sizeof *s->parts, "energy sums", error);
  s->motions = memory_zeroed((size_t)run->loading->constraint_count, sizeof *s->motions, "motions", error);
  if (failed || !s->sums || !s->parts || !s->motions) return BRECCIA_FAILURE;
  if (face_work_create(&s->face_work, d, run->loading, error)) return BRECCIA_FAILURE;
  return stiffness_damping_create(&s->viscous, s->spec->damping.stiffness, d, error);
}

/** Returns which rows a step copies before it begins. Steps of elastic bodies that leave strains out fail only where
 *  they grow beyond all bounds, and explicit_step_back then reconstructs the motion, so that its rows are not copied.
 *  For this, 1 - c dt / 2 must stay away from zero, and there must be no drag of stiffness, which it does not know. */
static Kept explicit_kept(const Explicit *s, bool leaves)
{
  const bool goes_back = leaves && !(s->viscous.time > 0) && explicit_mass_damping(s) * s->clock->time_step < 1.5;
  return goes_back ? KEPT_BUT_MOTION : KEPT_TRIED;
}

/** Accelerations, what stiffness damping and work at faces take, and what a step that fails gives back. */
static size_t bytes(Solver *run)
{
  const Explicit *s = run->own;
  return vector_bytes(&s->domain->particles->space) + stiffness_damping_bytes(&s->viscous, s->domain) +
         face_work_bytes(&s->face_work) + solver_kept_bytes(run, explicit_kept(s, s->domain->may_leave_tensors));
}

static void give_up_room(Explicit *s)
{
  solver_forget(s->domain, &s->before);
}

/** Room for the state that a step begins with; only while steps are taken, as pictures and the like need room afterwards. */
static int make_room(Explicit *s, Solver *run, Error *error)
{
  const Kept kept = explicit_kept(s, s->domain->leaves_tensors);
  if (kept != s->kept) solver_forget(s->domain, &s->before);
  s->kept = kept;
  return solver_keep(run, kept, &s->before, error);
}

static void destroy(Solver *run)
{
  Explicit *s = run->own;
  vector_destroy(&s->acceleration);
  free(s->sums);
  free(s->parts);
  free(s->motions);
  stiffness_damping_destroy(&s->viscous);
  face_work_destroy(&s->face_work);
  give_up_room(s);
  free(s);
  run->own = NULL;
}

double explicit_mass_damping(const Explicit *s)
{
  return s->period > 0 ? quasi_static_damping(s->spec->quasi_static, s->period) : s->spec->damping.mass;
}

static bool damps(const Solver *run)
{
  return is_damped(run->spec);
}

static void describe(const Solver *run, const char *time, Text *text)
{
  const Clock *clock = &run->clock;
  const Explicit *s = run->own;
  if (s->period > 0)
    text_add(
        text,
        "quasi-static: a period of %.4g %s; loads without a history grow over %.4g and stay so up to %.4g, damping "
        "%.4g 1/%s, which is %g of critical\n",
        s->period, time, s->spec->quasi_static->ramp * s->period, clock->stage_end - clock->stage_time,
        explicit_mass_damping(s), time, s->spec->quasi_static->ratio);
  text_add(text, "%lld steps of %.4g %s (%.2f of the stable %.4g)", (long long)(clock->stage_last - clock->stage_step),
           clock->time_step, time, clock->time_step / clock->stable, clock->stable);
  const double last = explicit_last_step(s);
  if (isfinite(last)) text_add(text, ", the last one %.4g so as to end at %g", last, clock->stage_end);
}

static void describe_stage(const void *section, const char *time, Text *text)
{
  const ExplicitSpec *spec = section;
  text_add(text, "explicit, ");
  if (!isnan(spec->rest)) text_add(text, "until rest (%g), at most ", spec->rest);
  if (spec->steps >= 0)
    text_add(text, "%lld steps", (long long)spec->steps);
  else if (spec->quasi_static)
    text_add(text, "quasi-static, %g periods, damping %g of critical",
             spec->quasi_static->ramp + spec->quasi_static->hold, spec->quasi_static->ratio);
  else
    text_add(text, "%g %s", spec->end_time, time);
  damping_describe(&spec->damping, time, text);
  if (spec->local_damping > 0) text_add(text, ", local damping %g", spec->local_damping);
}

/** For the period of its vibration, and for what stiffness damps. */
static bool linearises(const void *section)
{
  const ExplicitSpec *spec = section;
  return spec->quasi_static || spec->damping.stiffness > 0;
}

static double damping(const void *section)
{
  const ExplicitSpec *spec = section;
  return spec->damping.mass;
}

static double steady(const void *section)
{
  const ExplicitSpec *spec = section;
  return spec->quasi_static ? spec->quasi_static->steady : NAN;
}

/** Ends a quasi-static stage early, or half a hold later. */
static void explicit_obey(Solver *run, QuasiStaticNext next)
{
  const Explicit *s = run->own;
  Clock *clock = &run->clock;
  if (next == QUASI_STATIC_GOES_ON) return;
  clock->ended = next == QUASI_STATIC_ENDS;
  clock->stage_end = clock->time;
  clock->stage_last = clock->step;
  if (clock->ended) return;
  clock->stage_end += 0.5 * s->spec->quasi_static->hold * s->period;
  ++clock->stage_last; /* until the next step plans the steps up to there */
}

/** Whether a stage that may end at rest has come to rest; looked at only now and then, at steps that a restart finds again. */
static int look_for_rest(Solver *run, Text *warning, Error *error)
{
  enum { EVERY = 100 };
  const Explicit *s = run->own;
  Clock *clock = &run->clock;
  const bool last = clock->step >= clock->stage_last;
  Rest rest;
  clock->ended = last;
  const QuasiStaticSpec *slow = s->spec->quasi_static;
  const bool asked = !isnan(s->spec->rest) && (last || (clock->step - clock->stage_step) % EVERY == 0),
             judged = slow && quasi_static_is_due(run, slow, s->period, last);
  if (!asked && !judged) return BRECCIA_OK;
  const int status = rest_find(run, &rest, error);
  if (status) return status;
  if (judged) explicit_obey(run, quasi_static_look(run, slow, s->period, &rest, last));
  if (!asked) return BRECCIA_OK;
  if (rest.meant && fmax(rest.unbalanced, rest.kinetic) < s->spec->rest) {
    clock->ended = 1;
    clock->stage_last = clock->step;
    clock->stage_end = clock->time;
    run->records[clock->stage].came_to_rest = 1;
  } else if (last) {
    char name[64];
    text_add_warning(
        warning, "stage '%s' ended at its %s, not at rest: ", solver_stage_name(run, clock->stage, name, sizeof name),
        s->spec->steps >= 0 ? "last step" : "end time");
    if (rest.meant)
      text_add(warning,
               "forces out of balance are %.2g of those that act, kinetic energy %.2g of the work; give it more time, "
               "or more damping",
               rest.unbalanced, rest.kinetic);
    else
      text_add(warning, "a load or motion still changes");
  }
  return BRECCIA_OK;
}

/* ---- steps ---- */

static void add_sums(Explicit *s)
{
  s->ledger->kinetic = 0;
  for (int64_t b = 0; b < s->domain->batch_count; ++b) explicit_add_to_ledger(s, s->sums[b]);
}

/** Each thread writes to the part that it will work on (places_array says why). */
static void find_accelerations(void *context, int64_t b)
{
  Explicit *s = context;
  const Particles *p = s->domain->particles;
  const Batch *batch = &s->domain->batches[b];
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = batch->first * SLICE; i < batch->last * SLICE; ++i)
      s->acceleration.row[k][i] = (p->internal.row[k][i] + p->external.row[k][i]) / p->inertia.row[k][i];
}

static int begin(Solver *run, Error *error)
{
  (void)error;
  Explicit *s = run->own;
  Domain *d = s->domain;
  domain_tell_time(d, s->clock->time, 0); /* laws with rates answered to the last step of the stage before already */
  domain_evaluate(d, NULL);
  s->face_work.fresh = false;
  loading_move(s->loading, &(LoadMotion){.velocity = d->particles->velocity.row});
  loading_apply(s->loading, d->particles, s->clock->time);
  loading_settle(s->loading, d->particles, d->particles->velocity.row, 0);
  const Particles *p = d->particles;
  const Vector *v = &p->velocity;
  team_each(d->batch_count, find_accelerations, s);
  s->ledger->kinetic = 0.5 * vector_inner_mass(d->counted, &p->inertia, v, v);
  s->ledger->given = fmax(s->ledger->given, vector_largest(v));
  return BRECCIA_OK;
}

/** Whether a step that has come to its forces may go on. */
static bool is_sound(const Explicit *s)
{
  const Domain *d = s->domain;
  return domain_has_forces(d) && !forces_failed(&d->forces) && !d->out_of_memory;
}

/** Displacements at the end of the step. */
static void move(void *context)
{
  Explicit *s = context;
  const Domain *d = s->domain;
  TEAM_FOR (b, d->batch_count) {
    const int64_t first = d->batches[b].first * SLICE, last = d->batches[b].last * SLICE;
    state_note_places(&s->before, first, last);
    explicit_kick_and_drift(s, b);
  }
  explicit_prescribe_displacements(s);
}

/** What loads say to the forces of bonds, and of their damping. */
static void apply_loads(Explicit *s, double end)
{
  Domain *d = s->domain;
  if (s->viscous.time > 0) stiffness_damping_take_off(&s->viscous, d);
  loading_apply(s->loading, d->particles, end);
  if (s->viscous.time > 0) stiffness_damping_put_back(&s->viscous, d);
  TEAM_SINGLE
  {
    loading_settle(s->loading, d->particles, d->particles->velocity.row, s->clock->time_step);
    explicit_note_open_platens(s);
  }
}

/** Bonds that break, forces, velocities at the end of the step. */
static void answer(void *context)
{
  Explicit *s = context;
  Domain *d = s->domain;
  const double end = explicit_time_after_step(s);
  domain_break(
      d, &(Moment){
             .step = s->clock->step + 1, .time = end, .time_step = s->clock->time_step, .motion = sqrt(3) * s->motion});
  TEAM_SINGLE domain_put_stresses_by(d);
  const Evaluation present = domain_present(d);
  domain_forces(d, &present);
  if (!is_sound(s)) return;
  domain_accept(d);
  face_work_find(&s->face_work, d);
  TEAM_SINGLE
  {
    const double work = face_work_done(&s->face_work, s->clock->time_step, d->particles->velocity.row);
    s->ledger->bond_work += work;
    s->ledger->external_work += work;
  }
  apply_loads(s, end);
  TEAM_FOR (b, d->batch_count) {
    explicit_kick(s, b);
    particles_take_rotations(d->particles, d->batches[b].first * SLICE, d->batches[b].last * SLICE);
  }
  TEAM_SINGLE
  {
    add_sums(s);
    s->clock->time = end;
    ++s->clock->step;
  }
  explicit_prescribe_velocities(s);
  loading_keep_ties(s->loading, d->particles, s->acceleration.row);
}

/** Drag of stiffness in the step under way. */
static void find_drag(Explicit *s)
{
  Domain *d = s->domain;
  stiffness_damping_find(&s->viscous, d, s->clock->time_step);
  /* Bonds that break next are judged by what particles showed before the step. */
  if (d->failure.criterion || d->gave_up) domain_show_states(d, &s->viscous.was);
}

static void take_step(void *context)
{
  move(context);
  answer(context);
}

static int advance(Solver *run, Text *warning, Error *error)
{
  Explicit *s = run->own;
  if (make_room(s, run, error)) return BRECCIA_FAILURE;
  state_note_others(&s->before); /* first, so that a step that fails gives back the plan and the stable step too */
  const int status = explicit_follow(run, warning, error);
  if (status) return status;
  const double start = s->clock->time;
  if (!s->face_work.fresh) face_work_renew(&s->face_work, s->domain);
  face_work_note(&s->face_work);
  explicit_foresee_motions(s);
  loading_move(s->loading, &(LoadMotion){.velocity = s->domain->particles->velocity.row,
                                         .lag = s->clock->time_step / 2,
                                         .damping = explicit_mass_damping(s)});
  if (s->viscous.time > 0) {
    stiffness_damping_note(&s->viscous, s->domain);
    team_run(move, s);
    find_drag(s);
    team_run(answer, s);
  } else
    team_run(take_step, s);
  if (!is_sound(s)) return explicit_retreat(s, error);
  s->ledger->fastest = s->motion / (s->clock->time - start);
  domain_commit_points(s->domain);
  forces_commit(&s->domain->forces);
  const int looked = look_for_rest(run, warning, error);
  if (run->clock.ended) give_up_room(s);
  return looked;
}

const SolverType explicit_solver = {.name = "explicit",
                                    .create = create,
                                    .destroy = destroy,
                                    .plan = explicit_plan,
                                    .check = explicit_check,
                                    .linearises = linearises,
                                    .plan_again = explicit_plan_again,
                                    .begin = begin,
                                    .advance = advance,
                                    .state = list_state,
                                    .damps = damps,
                                    .damping = damping,
                                    .steady = steady,
                                    .inertia = explicit_inertia,
                                    .foresee = explicit_foresee,
                                    .bytes = bytes,
                                    .describe = describe,
                                    .describe_stage = describe_stage};

#include "solver/implicit.h"
#include "solver/flutter.h"
#include "solver/stable_step.h"

#include "base/memory.h"
#include "loading/constraint.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_given(const void *section, const char *key)
{
  return section_node(section, key) != ((const SectionHead *)section)->node;
}

/** Keys of the scheme that is not taken. */
static void check_scheme(const DeckReader *reader, ImplicitSpec *spec)
{
  const bool dissipates = spec->scheme == SCHEME_HHT;
  static const char *const newmark[] = {"beta", "gamma"};
  for (int k = 0; k < 2 && dissipates; ++k)
    if (is_given(spec, newmark[k]))
      node_error(reader->document, section_node(spec, newmark[k]), reader->error,
                 "%s: it follows from 'alpha' in the scheme HHT; leave it out, or choose 'scheme: Newmark'",
                 newmark[k]);
  if (!dissipates && is_given(spec, "alpha"))
    node_error(reader->document, section_node(spec, "alpha"), reader->error,
               "alpha: it belongs to 'scheme: HHT'; leave it out, or choose that");
  if (!dissipates && spec->beta < spec->gamma / 2)
    node_error(reader->document, section_node(spec, "beta"), reader->error,
               "beta: below gamma / 2 = %g steps have to be as short as those of explicit dynamics, or explode; choose "
               "more, or 'explicit'",
               spec->gamma / 2);
  if (!dissipates) spec->alpha = 0;
  if (dissipates) { /* of second order, stable for steps of any length (Hilber, Hughes and Taylor 1977) */
    spec->gamma = 0.5 - spec->alpha;
    spec->beta = (1 - spec->alpha) * (1 - spec->alpha) / 4;
  }
}

static void check_implicit(const DeckReader *reader, void *section)
{
  ImplicitSpec *spec = section;
  check_scheme(reader, spec);
  spec->damping = damping_of(&spec->damping_given, reader, section);
}

static const Field implicit_fields[] = {
    {.key = "end time",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, end_time),
     .dimension = "time",
     .range = "(0, inf)",
     .meaning = "the run, or this stage of it, ends at this time"},
    {.key = "time step",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, time_step),
     .dimension = "time",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "the first and longest; a twentieth of a period follows a vibration within 1 % of its period. When "
                "absent: a hundredth of 'end time'"},
    {.key = "smallest time step",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, smallest),
     .dimension = "1",
     .standard = "1e-4",
     .range = "(0, 1]",
     .meaning = "share of the longest step below which none is cut any more"},
    {.key = "local error",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, local_error),
     .dimension = "1",
     .standard = "1e-3",
     .range = "(0, inf)",
     .meaning =
         "the most that a step may err by, as a share of the largest displacements so far: steps are cut and grow "
         "by it. With a very large one they are cut only where no equilibrium is found and where bonds break"},
    {.key = "scheme",
     .kind = FIELD_CHOICE,
     .offset = offsetof(ImplicitSpec, scheme),
     .standard = "Newmark",
     .meaning =
         "Newmark: by 'beta' and 'gamma', whose defaults are the average acceleration, which keeps energy; HHT: by "
         "'alpha', which takes energy out of vibrations that steps are too long for",
     .words = (const char *const[]){[SCHEME_NEWMARK] = "Newmark", [SCHEME_HHT] = "HHT", NULL}},
    {.key = "beta",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, beta),
     .dimension = "1",
     .standard = "0.25",
     .range = "(0, 1]",
     .meaning = "weight of the acceleration at the end of a step in displacements; at least gamma / 2"},
    {.key = "gamma",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, gamma),
     .dimension = "1",
     .standard = "0.5",
     .range = "[0.5, 1]",
     .meaning = "the same in velocities; above 0.5 vibrations lose energy, and the error is of first order"},
    {.key = "alpha",
     .kind = FIELD_NUMBER,
     .offset = offsetof(ImplicitSpec, alpha),
     .dimension = "1",
     .standard = "-0.05",
     .range = "[-0.3333333333333334, 0]",
     .meaning = "of Hilber, Hughes and Taylor, as Abaqus counts it (OpenSees says 1 + alpha): beta = (1 - alpha)^2 / 4 "
                "and gamma = 1/2 - alpha follow; the fastest vibrations keep (1 + alpha) / (1 - alpha) of their size "
                "in a step"},
    DAMPING_FIELDS(ImplicitSpec, damping_given),
    NEWTON_FIELDS(ImplicitSpec, newton),
};

const Section implicit_section = {.name = "implicit",
                                  .about = "Implicit dynamics: steps as long as accuracy allows, each brought to "
                                           "equilibrium with inertia by Newton's method.",
                                  .size = sizeof(ImplicitSpec),
                                  FIELDS(implicit_fields),
                                  .check = check_implicit};

double implicit_longest(const ImplicitSpec *spec)
{
  return fmin(isnan(spec->time_step) ? spec->end_time / 100 : spec->time_step, spec->end_time);
}

static void list_state(Solver *run, StateList *list)
{
  Implicit *s = run->own;
  const Particles *p = s->domain->particles;
  state_add_vector(list, "acceleration", "acceleration", STATE_COMMITTED, s->acceleration.row, p->places);
  particles_state_rotations("angular acceleration", "1", STATE_COMMITTED, &s->acceleration, list);
  state_add_vector(list, "damping force", "force", STATE_COMMITTED, s->drag.row, p->places);
  particles_state_rotations("damping moment", "energy", STATE_COMMITTED, &s->drag, list);
  state_add_number(list, "next step", "time", STATE_LEARNED, &s->next);
  newton_state(&s->newton, list);
  state_add_number(list, "largest displacements", "length", STATE_COMMITTED, &s->shift);
  state_add_count(list, "cuts of steps", STATE_LEARNED, &s->cuts);
}

static void destroy(Solver *run)
{
  Implicit *s = run->own;
  newton_destroy(&s->newton);
  increment_destroy(&s->increment);
  pressing_destroy(&s->pressing);
  vector_destroy(&s->acceleration);
  vector_destroy(&s->drag);
  vector_destroy(&s->velocity);
  vector_destroy(&s->drag_then);
  vector_destroy(&s->result);
  free(s);
  run->own = NULL;
}

static int create(Solver *run, Error *error)
{
  Implicit *s = run->own = memory_zeroed(1, sizeof *s, "implicit solver", error);
  if (!s) return BRECCIA_FAILURE;
  *s = (Implicit){.domain = run->domain,
                  .loading = run->loading,
                  .spec = run->spec,
                  .clock = &run->clock,
                  .ledger = &run->ledger,
                  .newton = {.domain = run->domain, .loading = run->loading},
                  .stable = INFINITY};
  s->newton.spec = &s->spec->newton;
  s->beside = implicit_forces(s);
  s->newton.beside = &s->beside;
  ledger_begin(&run->ledger, run->domain);
  const Particles *p = run->domain->particles;
  const bool made = vector_create(&s->acceleration, &p->space, "accelerations", error) &&
                    vector_create(&s->drag, &p->space, "damping", error) &&
                    vector_create(&s->velocity, &p->space, "velocities", error) &&
                    vector_create(&s->drag_then, &p->space, "damping", error) &&
                    vector_create(&s->result, &p->space, "steps", error);
  if (!made || increment_create(&s->increment, run->domain, run->loading, error)) return BRECCIA_FAILURE;
  if (pressing_create(&s->pressing, run->loading, error)) return BRECCIA_FAILURE;
  return newton_create(&s->newton, error);
}

static bool damps(const Solver *run)
{
  const ImplicitSpec *spec = run->spec;
  return spec->damping.mass > 0 || spec->damping.stiffness > 0;
}

static double damping(const void *section)
{
  const ImplicitSpec *spec = section;
  return spec->damping.mass;
}

static int check(Solver *run, const void *section, Error *error)
{
  const ImplicitSpec *spec = section;
  const double steps = spec->end_time / implicit_longest(spec);
  if (steps > 1e15)
    return node_error(run->reader->document, section_node(spec, "time step"), error,
                      "time step: %.3g steps are too many", steps);
  const char *flutters = domain_flutters(run->domain);
  if (flutters && run->domain->failure.criterion)
    return node_error(run->reader->document, spec->head.node, error,
                      "implicit: %s, and more so beside a crack: cracks stop where they should run on; expected 'form: "
                      "variational', or a deck in which no bond breaks",
                      flutters);
  if (flutters && !(spec->damping.stiffness > 0))
    return node_error(run->reader->document, spec->head.node, error,
                      "implicit: %s: expected 'form: variational', 'stiffness damping' or 'Rayleigh damping'",
                      flutters);
  return increment_check(run, section, &spec->newton, "take 'explicit'", error);
}

static int plan(Solver *run, Text *warning, Error *error)
{
  Implicit *s = run->own;
  int status = check(run, s->spec, error);
  if (!status) status = stable_step(s->domain, &s->stable, error);
  if (status) return status;
  flutter_warn_of_supports(run, s->stable, s->spec->damping.stiffness, false, warning);
  s->next = implicit_longest(s->spec);
  run->clock.stable = INFINITY;
  run->clock.time_step = s->next;
  run->clock.stage_end = run->clock.stage_time + s->spec->end_time;
  implicit_count_steps(run);
  if (s->next < s->stable && isfinite(s->stable)) { /* nothing but springs may be stiff */
    char where[WHERE_SIZE];
    node_where(run->reader->document, section_node(s->spec, "time step"), where, sizeof where);
    text_add(warning,
             "%s%s: warning: time step: %g %s is below the stable step of %.4g %s of explicit dynamics, which takes a "
             "step at a "
             "small part of the price; choose a longer one, or 'explicit'",
             warning->length ? "\n" : "", where, s->next, run->clock.time_unit, s->stable, run->clock.time_unit);
  }
  return BRECCIA_OK;
}

static void plan_again(Solver *run)
{
  (void)run; /* every step looks at the times again */
}

static void foresee(const void *section, const Clock *clock, double *steps, double *time)
{
  (void)clock;
  const ImplicitSpec *spec = section;
  *steps += ceil(spec->end_time / implicit_longest(spec) - 1e-9);
  *time += spec->end_time;
}

/** With about the inertia of the longest step, which all bodies have, so that those that nothing holds resist too. */
static int measure(Solver *run, StepCost *cost, Error *error)
{
  enum { VECTORS = 5 };
  Implicit *s = run->own;
  Newton *newton = &s->newton;
  const double step = implicit_longest(run->spec);
  cost->bytes += (double)(increment_bytes(&s->increment, run) + VECTORS * vector_bytes(&s->domain->particles->space));
  newton->linear.mass_factor = 4 / (step * step);
  const int status = newton_measure(newton, cost, error);
  newton->linear.mass_factor = 0;
  return status;
}

static void describe_stage(const void *section, const char *time, Text *text)
{
  const ImplicitSpec *spec = section;
  if (spec->scheme == SCHEME_HHT)
    text_add(text, "implicit, HHT with alpha %.3g", spec->alpha);
  else
    text_add(text, "implicit, Newmark with beta %.4g and gamma %.3g", spec->beta, spec->gamma);
  text_add(text, ", %g %s by steps of at most %.4g %s", spec->end_time, time, implicit_longest(spec), time);
  damping_describe(&spec->damping, time, text);
}

static void describe(const Solver *run, const char *time, Text *text)
{
  const Implicit *s = run->own;
  Error *none = NULL;
  describe_stage(s->spec, time, text);
  text_add(text, " (%.3g times the stable step of explicit dynamics), for %lld unknowns, by %s",
           implicit_longest(s->spec) / s->stable, (long long)unknowns_count(&s->newton.linear.unknowns, none),
           linear_solver_words(&s->newton.linear));
}

/** Accelerations that are kept are those of free particles: what is prescribed has its own. */
static double inertia(const Solver *run, const Constraint *constraint, int64_t n)
{
  const Implicit *s = run->own;
  const Particles *p = s->domain->particles;
  const int32_t i = constraint->load->selection.places[n];
  return constraint_along(constraint, s->drag.row, i) +
         p->inertia.row[constraint->row][i] * p->volume[i] *
             (constraint_part(constraint, n) *
                  constraint_acceleration(constraint, run->clock.time, run->clock.time_step) +
              constraint_followed(constraint, s->acceleration.row, n));
}

const SolverType implicit_solver = {.name = "implicit",
                                    .create = create,
                                    .destroy = destroy,
                                    .plan = plan,
                                    .check = check,
                                    .plan_again = plan_again,
                                    .begin = implicit_begin,
                                    .advance = implicit_advance,
                                    .state = list_state,
                                    .damps = damps,
                                    .damping = damping,
                                    .few_steps = true,
                                    .inertia = inertia,
                                    .foresee = foresee,
                                    .measure = measure,
                                    .describe = describe,
                                    .describe_stage = describe_stage};

/* A solver as somebody would add one: particles coast with the velocities that they have. */
#include "solver/solver.h"

typedef struct PromisedSpec {
  SectionHead head;
  double time_step;
  int64_t steps;
} PromisedSpec;

static const Field fields[] = {{.key = "time step",
                                .kind = FIELD_NUMBER,
                                .offset = offsetof(PromisedSpec, time_step),
                                .dimension = "time",
                                .range = "(0, inf)",
                                .meaning = "length of the steps"},
                               {.key = "steps",
                                .kind = FIELD_COUNT,
                                .offset = offsetof(PromisedSpec, steps),
                                .range = "[1, inf)",
                                .meaning = "how many"}};
const Section promised_section = {
    .name = "promised", .about = "A solver.", .size = sizeof(PromisedSpec), FIELDS(fields)};

static int create(Solver *solver, Error *error)
{
  (void)solver, (void)error;
  return BRECCIA_OK;
}

static void destroy(Solver *solver)
{
  (void)solver;
}

static void foresee(const void *given, const Clock *clock, double *steps, double *time)
{
  const PromisedSpec *spec = given;
  (void)clock;
  *steps = (double)spec->steps;
  *time = (double)spec->steps * spec->time_step;
}

static int plan(Solver *solver, Text *warning, Error *error)
{
  const PromisedSpec *spec = solver->spec;
  Clock *clock = &solver->clock;
  (void)warning, (void)error;
  clock->time_step = clock->stable = spec->time_step;
  clock->stage_last = clock->stage_step + spec->steps;
  clock->stage_end = clock->stage_time + (double)spec->steps * spec->time_step;
  return BRECCIA_OK;
}

static int check(Solver *solver, const void *spec, Error *error)
{
  (void)solver, (void)spec, (void)error;
  return BRECCIA_OK;
}

static void plan_again(Solver *solver)
{
  (void)solver;
}

static int begin(Solver *solver, Error *error)
{
  (void)solver, (void)error;
  return BRECCIA_OK;
}

static int advance(Solver *solver, Text *warning, Error *error)
{
  Particles *p = solver->domain->particles;
  Clock *clock = &solver->clock;
  (void)warning, (void)error;
  for (int64_t place = 0; place < p->places; ++place)
    for (int k = 0; k < 3; ++k) p->displacement.row[k][place] += clock->time_step * p->velocity.row[k][place];
  clock->time += clock->time_step;
  clock->ended = ++clock->step >= clock->stage_last;
  return BRECCIA_OK;
}

static void state(Solver *solver, StateList *list)
{
  (void)solver, (void)list;
}

static bool damps(const Solver *solver)
{
  (void)solver;
  return false;
}

static void describe(const Solver *solver, const char *time, Text *text)
{
  text_add(text, "coasts in steps of %g %s", solver->clock.time_step, time);
}

static void describe_stage(const void *spec, const char *time, Text *text)
{
  text_add(text, "coasts in steps of %g %s", ((const PromisedSpec *)spec)->time_step, time);
}

const SolverType promised_solver = {.name = "promised",
                                    .create = create,
                                    .destroy = destroy,
                                    .plan = plan,
                                    .check = check,
                                    .plan_again = plan_again,
                                    .begin = begin,
                                    .advance = advance,
                                    .state = state,
                                    .damps = damps,
                                    .foresee = foresee,
                                    .describe = describe,
                                    .describe_stage = describe_stage};

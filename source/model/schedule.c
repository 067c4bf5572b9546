/* How long stages are, and when results are written. */
#include "model/model.h"

#include "base/memory.h"
#include "solver/implicit.h"
#include "solver/static.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

double model_stage_time(const breccia_model *model, int64_t number)
{
  const SolveSpec *stage = model->solver.stages->items[number];
  const StaticSpec *rest = stage->of[SOLVER_static];
  const ImplicitSpec *implicit = stage->of[SOLVER_implicit];
  return rest ? rest->end_time : implicit ? implicit->end_time : INFINITY;
}

bool model_stage_hands_over(const breccia_model *model, int64_t number)
{
  const StaticSpec *rest = ((const SolveSpec *)model->solver.stages->items[number])->of[SOLVER_static];
  return rest && static_hands_over(rest);
}

double model_stage_error(const breccia_model *model, int64_t number)
{
  const ImplicitSpec *implicit = ((const SolveSpec *)model->solver.stages->items[number])->of[SOLVER_implicit];
  return implicit ? implicit->local_error : INFINITY;
}

static int by_value(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

/** Adds times that are asked for by name, as far as they fall into the stage. */
static void add_times(double *list, int64_t *count, const NumberList *times, double begin, double end)
{
  for (int k = 0; k < times->count; ++k)
    if (times->values[k] >= begin && times->values[k] <= end * (1 + 1e-9))
      list[(*count)++] = fmin(times->values[k], end);
}

int model_make_schedule(breccia_model *model, bool again, Error *error)
{
  const ResultsSpec *r = model->spec->results;
  const Clock *clock = &model->solver.clock;
  const double begin = clock->stage_time, end = clock->stage_end;
  const int64_t even = r->every > 0 ? 0 : r->number;
  int64_t most = 2 + even + r->times.count;
  for (int k = 0; k < model->spec->pictures.count; ++k)
    most += ((const PictureSpec *)model->spec->pictures.items[k])->times.count;
  if (most > 10000000 || (r->every > 0 && model->solver.clock.steps / r->every > 10000000))
    return node_error(model->document, r->head.node, error, "results: %lld states are too many to write",
                      (long long)(r->every > 0 ? model->solver.clock.steps / r->every : most));
  free(model->schedule);
  free(model->stops);
  model->schedule_count = 0;
  model->schedule = memory_zeroed((size_t)most, sizeof(double), "schedule", error);
  model->stops = memory_zeroed((size_t)most, sizeof(double), "schedule", error);
  if (!model->schedule || !model->stops) return BRECCIA_FAILURE;
  int64_t n = 0;
  add_times(model->stops, &n, &r->times, begin, end);
  for (int p = 0; p < model->spec->pictures.count; ++p) {
    const PictureSpec *picture = model->spec->pictures.items[p];
    add_times(model->stops, &n, &picture->times, begin, end);
  }
  qsort(model->stops, (size_t)n, sizeof(double), by_value);
  solver_stop_at(&model->solver, model->stops, n, again);
  double *list = model->schedule;
  memcpy(list, model->stops, sizeof(double) * (size_t)n);
  list[n++] = begin;
  list[n++] = end;
  for (int64_t k = 1; k <= even; ++k) list[n++] = begin + (end - begin) * ((double)k / (double)even);
  qsort(list, (size_t)n, sizeof(double), by_value);
  model->schedule_count = n;
  return BRECCIA_OK;
}

bool model_has_passed(const breccia_model *model, int64_t k, double time)
{
  return k < model->schedule_count && model->schedule[k] <= time + (0.5 - 1e-6) * model->solver.clock.time_step;
}

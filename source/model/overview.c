/* What a run would do, and how long it will take. */
#include "model/model.h"

#include "base/clock.h"
#include "base/cores.h"
#include "base/tensor.h"
#include "domain/bending_strength.h"
#include "domain/strength_field.h"
#include "domain/tensile_strength.h"
#include "domain/toughness.h"
#include "model/plausibility.h"
#include "results/result_file.h"
#include "solver/explicit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

Task model_task(const breccia_model *model, int64_t first, int64_t last, int64_t states_written)
{
  const ResultsSpec *r = model->spec->results;
  Task task = {.steps = last - first, .states_written = states_written, .checkpoint_seconds = r->checkpoint_seconds};
  const Clock *s = &model->solver.clock;
  const double time = last >= s->steps ? s->end_time : s->end_time * (double)last / (double)s->steps;
  while (task.states < model->schedule_count && model->schedule[task.states] <= time) ++task.states;
  task.states += model->states_before;
  if (r->every <= 0) task.states += r->number * (s->stages - 1 - s->stage);
  if (r->every > 0) task.states += last / r->every;
  if (r->checkpoint_steps > 0) task.checkpoints = last / r->checkpoint_steps - first / r->checkpoint_steps;
  for (int k = 0; k < model->spec->pictures.count; ++k) {
    const PictureSpec *picture = model->spec->pictures.items[k];
    task.pictures += picture->times.count ? picture->times.count : 1;
  }
  if (deck_usual_pictures(model->spec)) task.pictures = 3;
  return task;
}

/* Memory of a run besides body, formulations and solver: the program with its libraries, and work arrays of result
 * files and of the summary. The values were measured on bodies of all formulations (docs/performance.md). */
#define PROGRAM_BYTES 25e6
#define PARTICLE_BYTES 112

/** Mean seconds of one evaluation of the forces. On a quiet machine a tenth of a second is enough; where others use it too, two seconds,
 *  in which they have had their turns. Never more than a tenth of what the whole run takes. */
static double measure_evaluation(breccia_model *model)
{
  enum { FEWEST = 3 };
  double fastest = INFINITY, before = 0;
  bool quiet = true;
  domain_evaluate(&model->domain, NULL); /* the first touches memory for the first time */
  const double begin = clock_seconds();
  for (int count = 1;; ++count) {
    domain_evaluate(&model->domain, NULL);
    const double seconds = clock_seconds() - begin, one = seconds / count;
    fastest = fmin(fastest, seconds - before);
    before = seconds;
    quiet &= !cores_are_short();
    const double whole = one * (double)model->solver.clock.steps;
    const double enough = quiet && one < 1.1 * fastest ? fmin(0.1, whole / 30) : fmin(2, whole / 10);
    if (count >= FEWEST && seconds > enough) return one;
  }
}

int model_expect(breccia_model *model, Error *error)
{
  const Domain *d = &model->domain;
  Entry entry;
  if (model->begun || model->outlook.state_bytes > 0) return BRECCIA_OK;
  ResultNames names = {.single = model->spec->results->precision == PRECISION_SINGLE};
  TextList list;
  if (model_enter(model, &entry, error)) return BRECCIA_FAILURE;
  StepCost cost;
  int status = model_field_names(model, &list, error);
  if (status) return model_leave(&entry, status, error);
  const bool leaves = d->leaves_tensors;
  domain_leave_tensors(&model->domain, true); /* as a run does */
  status = solver_measure(&model->solver, &cost, error);
  if (!status) {
    names.fields = list.items;
    names.count = list.count;
    const double evaluation = measure_evaluation(model);
    const double criterion =
        domain_criterion_seconds(&model->domain, fmin(0.1, evaluation * (double)model->solver.clock.steps));
    outlook_expect(&model->outlook, cost.evaluations * evaluation + cost.seconds + criterion,
                   result_file_state_bytes(d, &names), (double)(domain_particle_bytes(d)), d->particles->count);
    model->outlook.least = cost.least;
    model->solver_bytes = cost.bytes;
  }
  domain_leave_tensors(&model->domain, leaves);
  free(list.items);
  return model_leave(&entry, status, error);
}

static void add_duration(Text *text, double seconds)
{
  if (seconds < 100)
    text_add(text, "%.*f s", seconds < 10 ? 1 : 0, seconds);
  else if (seconds < 6000)
    text_add(text, "%.0f min", seconds / 60);
  else
    text_add(text, "%.1f h", seconds / 3600);
}

/** Returns true if stages to come may take more steps than the deck says: implicit ones cut steps that err by more than
 *  'local error', static ones increments in which a law or bonds leave no equilibrium near, quasi-static ones hold
 *  longer while the body still comes to rest. */
static bool steps_may_be_cut(const breccia_model *model)
{
  const Domain *d = &model->domain;
  const Clock *clock = &model->solver.clock;
  const bool yields = !domain_is_elastic(d) || d->failure.criterion;
  bool cut = false;
  for (int64_t k = clock->stage; k < clock->stages; ++k) {
    const SolveSpec *stage = model->solver.stages->items[k];
    const ExplicitSpec *explicit = stage->of[SOLVER_explicit];
    cut |= stage->of[SOLVER_implicit] || (stage->of[SOLVER_static] && yields) || (explicit && explicit->quasi_static);
  }
  return cut;
}

/** A line for each stage: what changes with it, and how it may end. */
static void describe_stages(const breccia_model *model, const char *time, Text *text)
{
  const Solver *s = &model->solver;
  const int64_t begin = s->clock.step;
  char name[64];
  for (int64_t k = 0; k < s->clock.stages; ++k) {
    const SolveSpec *stage = s->stages->items[k];
    text_add(text, "stage '%s': ", solver_stage_name(s, k, name, sizeof name));
    solver_describe_stage(s, k, time, text);
    if (stage->laws == LAWS_ELASTIC) text_add(text, ", elastic");
    if (stage->displacements == DISPLACEMENTS_FROM_ZERO) text_add(text, ", displacements from zero");
    if (stage->loads.count) text_add(text, ", %d new load%s", stage->loads.count, stage->loads.count > 1 ? "s" : "");
    text_add(text, "\n");
  }
  text_add(text, "%lld steps at %s, the first of %.4g %s", (long long)(s->clock.steps - begin),
           steps_may_be_cut(model) ? "least" : "most", s->clock.time_step, time);
  if (isfinite(s->clock.stable))
    text_add(text, " (%.2f of the stable %.4g)", s->clock.time_step / s->clock.stable, s->clock.stable);
  if (!solver_foresees_steps(s)) text_add(text, ", besides those of explicit stages");
}

/** Each with its particles, where there are several. */
static void describe_regions(const Domain *d, Text *text)
{
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    text_add(text, "%s%s", r ? ", " : "", region->type->name);
    if (region->name) text_add(text, " in %s", region->name);
    if (d->region_count > 1)
      text_add(text, " (%lld particle%s)", (long long)region->particles, region->particles == 1 ? "" : "s");
  }
  if (d->region_count > 1)
    text_add(text, ", joined by %lld bond%s", (long long)d->joint.bond_count / 2, d->joint.bond_count == 2 ? "" : "s");
  text_add(text, ";");
}

/** What bonds of a material bear. */
static void describe_limit(const breccia_model *model, int material, Text *text)
{
  const Domain *d = &model->domain;
  const Failure *failure = &d->failure;
  const Criterion *criterion = failure->criterion;
  text_add(text, material ? ", " : " ");
  if (!isfinite(failure->limit[material])) {
    text_add(text, "bonds of '%s' do not break", d->materials[material].name);
    return;
  }
  text_add(text, "%g", failure->limit[material]);
  char unit[64];
  if (criterion->dimension) {
    units_name(model->units, dimension_find(criterion->dimension), unit, sizeof unit);
    text_add(text, " %s", unit);
  }
  const BondLength lengths = {peridynamics_space(model->spec->peridynamics), failure->influence, d->family.horizon,
                              d->body.largest_spacing};
  for (int r = 0; criterion->describe && r < d->region_count; ++r) {
    const LimitsOf of = domain_limits_of(d, r, &lengths);
    if (!region_has_material(d, &d->regions[r], d->materials[material].name)) continue;
    criterion->describe(model->spec->failure, &of, material, failure->limit[material], model->units, text);
    return;
  }
}

/** How many particles begin under stress, and between which mean stresses. */
static void describe_initial_stress(const breccia_model *model, Text *text)
{
  const Domain *d = &model->domain;
  char unit[64];
  if (!d->stressed || model->begun) return;
  units_name(model->units, dimension_find("stress"), unit, sizeof unit);
  text_add(text, "%lld particles begin under stress, mean %.4g to %.4g %s\n", (long long)d->stressed, d->least_mean,
           d->largest_mean, unit);
}

const char *breccia_model_overview(breccia_model *model)
{
  if (!model) return NULL;
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  const Host host = host_enter();
  Text *text = &model->overview;
  text_free(text);
  int fewest = INT32_MAX, most = 0;
  int64_t outside = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    int count = family_count(&d->family, d->particles->place_of[n]);
    outside += body_outside(&d->body, n);
    if (count < fewest) fewest = count;
    if (count > most) most = count;
  }
  char length[64], time[64];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  units_name(model->units, dimension_find("time"), time, sizeof time);
  text_add(text, "%s: %lld particle%s", model->spec->title, (long long)d->particles->count,
           d->particles->count == 1 ? "" : "s");
  if (outside) text_add(text, ", of them %lld in layers outside supports", (long long)outside);
  text_add(text, ", %lld bond%s, %d to %d per particle (mean %.1f), horizon %g %s\n", (long long)d->family.bonds / 2,
           d->family.bonds == 2 ? "" : "s", fewest, most, (double)d->family.bonds / (double)d->particles->count,
           d->family.horizon, length);
  describe_regions(d, text);
  for (int k = 0; k < d->material_count; ++k)
    text_add(text, "%s %s (%s)", k ? "," : "", d->materials[k].name, d->materials[k].law_name);
  if (d->failure.criterion)
    text_add(text, "; %s", d->failure.criterion->name);
  else
    text_add(text, "; bonds do not break");
  for (int k = 0; d->failure.criterion && k < d->material_count; ++k) describe_limit(model, k, text);
  text_add(text, "\n");
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].type->describe) d->regions[r].type->describe(d->regions[r].formulation, model->units, text);
  toughness_describe(d, model->spec->failure, model->units, text);
  tensile_strength_describe(d, text);
  bending_strength_describe(d, text);
  describe_initial_stress(model, text);
  strength_field_describe(d, text);
  plausibility_describe_contact(model, text);
  forces_describe(&d->forces, model->units, text);
  plausibility_in_short(model, text);
  text_add(text, "\n");
  model_expect(model, NULL); /* the equations of the first step say how they are best solved */
  if (s->clock.stages > 1)
    describe_stages(model, time, text);
  else
    s->type->describe(s, time, text);
  const bool more = steps_may_be_cut(model);
  if (more && s->clock.stages == 1)
    text_add(text, ", at least %lld steps", (long long)(s->clock.steps - s->clock.step));
  const double bytes =
      (double)domain_bytes(d) + model->solver_bytes + PROGRAM_BYTES + PARTICLE_BYTES * (double)d->particles->count;
  text_add(text, ", %.0f MB, %s ", bytes / 1e6, more || model->outlook.least ? "at least" : "about");
  const Task task = model_task(model, s->clock.step, s->clock.steps, 0);
  add_duration(text, outlook_left(&model->outlook, &task));
  if (model->outlook.least && s->type->few_steps && domain_may_soften(d))
    text_add(text, ", ten to a hundred times that where it cracks");
  if (domain_has_servers(d)) text_add(text, " and what its material servers take");
  return host_leave(&host, BRECCIA_OK, NULL) ? NULL : text_words(text);
}

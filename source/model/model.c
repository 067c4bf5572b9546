#include "model/model.h"

#include "base/clock.h"
#include "base/cores.h"
#include "base/memory.h"
#include "base/team.h"
#include "deck/resolve.h"
#include "deck/spelling.h"
#include "model/plausibility.h"
#include "results/curve_names.h"
#include "results/fields.h"
#include "results/result_file.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int model_enter(breccia_model *model, Team **before, Error *error)
{
  if (team_threads(model->team) != model->threads) {
    team_destroy(&model->team);
    if (!(model->team = team_create(model->threads, error))) return BRECCIA_FAILURE;
  }
  *before = team_use(model->team);
  return BRECCIA_OK;
}

/* ---- loading ---- */

/** The deck as it will be run, and its text for everybody who asks later what that was. */
static int open_deck(breccia_model *model, const DeckText *words, Error *error)
{
  const int status = deck_open(words, &deck_section, &model->laws, &model->document, &model->units, error);
  model->reader = (DeckReader){model->document, model->units, &model->laws, error, NULL};
  if (!status) deck_write(model->document, &model->deck);
  return status;
}

static int check_names(const breccia_model *model, const Domain *domain, const TextList *names, const Node *list)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < names->count; ++k) {
    const Node *place = list->kind == NODE_LIST ? &list->items[k] : list;
    bool known = output_field_find(names->items[k]) != NULL;
    for (int m = 0; m < domain->material_count; ++m)
      known |= history_field_index(&domain->materials[m], names->items[k]) >= 0;
    if (known) continue;
    const char *fields[64];
    int count = 0;
    while (count < 64 && output_field_at(count)) {
      fields[count] = output_field_at(count)->name;
      ++count;
    }
    Text advice = {0};
    spelling_advice(&advice, names->items[k], fields, count, "the fields are");
    status =
        node_error(model->document, place, model->reader.error, "there is no field '%s'; %s%s", names->items[k],
                   text_words(&advice),
                   spelling_nearest(names->items[k], fields, count) ? "" : " and named histories of the materials");
    text_free(&advice);
  }
  return status;
}

/** A picture shows one number of each particle: a component, or the length of a vector. */
static int check_component(const breccia_model *model, const PictureSpec *picture)
{
  const OutputField *field = output_field_find(picture->field);
  const int count = field && field->component_names ? field->components : 0;
  for (int k = 0; picture->component && k < count; ++k)
    if (!strcmp(field->component_names[k], picture->component)) return BRECCIA_OK;
  if (!picture->component && count <= 3) return BRECCIA_OK;
  Text advice = {0};
  spelling_advice(&advice, picture->component ? picture->component : "", field ? field->component_names : NULL, count,
                  "its components are");
  const int status = node_error(
      model->document, section_place(picture, picture->component ? "component" : "field"), model->reader.error,
      picture->component ? "component: %s has no '%s'; %s" : "field: %s is drawn by 'component'%s; %s", picture->field,
      picture->component ? picture->component : "",
      count ? text_words(&advice) : "it is one number, leave 'component' out");
  text_free(&advice);
  return status;
}

/** A column that a curve draws is one that a history of the deck will write. */
static int check_column(const breccia_model *model, const CurveNames *names, int which, const Node *place)
{
  Error *error = model->reader.error;
  const char **words = memory_zeroed((size_t)watches_count(model->watches) + 64, sizeof(char *), "curves", error);
  if (!words) return BRECCIA_FAILURE;
  char columns[64][64], wanted[CURVE_NAME], file[CURVE_NAME];
  int watch = -1, count = watches_count(model->watches);
  text_file_name(names->watch[which], wanted, sizeof wanted);
  for (int k = 0; k < count; ++k) {
    words[k] = watches_name(model->watches, k);
    text_file_name(words[k], file, sizeof file);
    if (!strcmp(file, wanted)) watch = k;
  }
  bool known = watch >= 0 && watches_column(model->watches, watch, 2, columns[0], 64); /* it is wrong itself */
  const char *given = watch < 0 ? names->watch[which] : names->column[which];
  for (int c = 0; watch >= 0 && c < 64 && !watches_column(model->watches, watch, c, columns[c], 64); ++c) {
    words[c] = columns[c];
    known |= !strcmp(columns[c], given);
    count = c + 1;
  }
  Text advice = {0};
  spelling_advice(&advice, given, words, count, watch < 0 ? "the deck watches" : "its columns are");
  if (!known)
    node_error(model->document, place, error, "curve: %s%sthere is no %s '%s'; %s",
               watch < 0 ? "" : names->watch[which], watch < 0 ? "" : ": ", watch < 0 ? "history" : "column", given,
               text_words(&advice));
  text_free(&advice);
  free(words);
  return known ? BRECCIA_OK : BRECCIA_USER_ERROR;
}

static int check_curve(const breccia_model *model, const PictureSpec *picture)
{
  const Node *place = section_place(picture, "curve");
  if (!model->watches) return BRECCIA_OK; /* the deck is refused for something else */
  CurveNames names;
  if (curve_names(picture->curve, &names))
    return node_error(model->document, place, model->reader.error,
                      "curve: '%s' should be 'watch.column : watch.column', like 'opening.distance : pull.value', or "
                      "with a minus 'tip.y : -grip.y'",
                      picture->curve);
  int status = BRECCIA_OK;
  for (int k = 0; k < names.count && !status; ++k) status = check_column(model, &names, k, place);
  return status;
}

static int check_results(breccia_model *model)
{
  DeckSpec *spec = (DeckSpec *)(void *)(uintptr_t)model->spec;
  if (!spec->results) spec->results = section_standard(&model->reader, &results_section, spec->head.node);
  if (!spec->results) return BRECCIA_FAILURE;
  int status = check_names(model, &model->domain, &spec->results->fields, section_place(spec->results, "fields"));
  for (int k = 0; k < spec->pictures.count; ++k) {
    const PictureSpec *picture = spec->pictures.items[k];
    if (picture->curve && check_curve(model, picture)) status = BRECCIA_USER_ERROR;
    if (!picture->field) continue;
    TextList one = {(const char *[]){picture->field}, 1};
    int bad = check_names(model, &model->domain, &one, section_place(picture, "field"));
    if (!bad) bad = check_component(model, picture);
    if (bad) status = bad;
  }
  return status;
}

static int by_value(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

static void warn_of_late_picture(breccia_model *model, const PictureSpec *picture, double time)
{
  const double end = model->solver.clock.end_time;
  if (time <= end * (1 + 1e-9)) return;
  const Node *place = section_place(picture, "at");
  char words[PLACE];
  node_place(model->document, place, words, sizeof words);
  text_add(&model->warnings, "%swarning: %s: the run ends at %g, before the picture at %g, which is not made",
           model->warnings.length ? "\n" : "", words, end, time);
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

/** True for a file of `breccia material`: one material, a test or stages, no body. */
static bool looks_like_test(const Node *root)
{
  return node_get(root, "material") && (node_get(root, "test") || node_get(root, "stages")) && !node_get(root, "body");
}

static int hold_grips(breccia_model *model, Error *error)
{
  const FailureSpec *failure = model->spec->failure;
  if (!failure || !failure->near_grips || strcmp(failure->near_grips, "hold")) return BRECCIA_OK;
  uint8_t *held = memory_zeroed((size_t)model->domain.particles->places, 1, "grips", error);
  if (!held) return BRECCIA_FAILURE;
  loading_mark_held(&model->loading, held);
  const int status = domain_hold_grips(&model->domain, held, error);
  free(held);
  return status;
}

static int create_loading(breccia_model *model, Error *error)
{
  const DeckSpec *spec = model->spec;
  LoadStage *stages = memory_zeroed((size_t)spec->solve.count, sizeof *stages, "stages", error);
  if (!stages) return BRECCIA_FAILURE;
  for (int k = 0; k < spec->solve.count; ++k) {
    const SolveSpec *stage = spec->solve.items[k];
    stages[k] = (LoadStage){&stage->loads, &stage->without, stage};
  }
  const int status = loading_create(&model->loading, &model->domain.body, &model->reader, &spec->loads, stages,
                                    spec->solve.count, &spec->selections);
  free(stages);
  return status;
}

static int build(breccia_model *model, bool force, Error *error)
{
  if (looks_like_test(model->document->root))
    return error_add(error, BRECCIA_USER_ERROR, "%s: is a laboratory test; 'breccia material %s' runs it",
                     model->document->name, model->document->name);
  int unknown = 0; /* names: what does not need them is checked all the same */
  model->reader.unknown = &unknown;
  DeckSpec *spec = section_read(&model->reader, model->document->root, &deck_section);
  model->reader.unknown = NULL;
  if (!spec || error_count(error) > unknown) return BRECCIA_USER_ERROR;
  model->spec = spec;
  if (!spec->peridynamics)
    spec->peridynamics = section_standard(&model->reader, &peridynamics_section, spec->head.node);
  if (!spec->peridynamics) return BRECCIA_FAILURE;
  DomainSpec parts = {&spec->materials, &spec->body, &spec->cracks, spec->peridynamics, spec->failure, spec->contact};
  int status = domain_create(&model->domain, &model->reader, &parts), bad;
  /* What follows needs the body or the materials only: its mistakes are told together with those of the rest. */
  const bool stands = model->domain.particles && model->domain.particles->count;
  if (stands) {
    bad = create_loading(model, error);
    if (bad) status = bad;
  }
  if (model->domain.family.first) {
    bad = watches_create(&model->watches, &model->domain, &model->loading, &model->reader, &spec->watches,
                         &spec->selections);
    if (bad) status = bad;
  }
  if (model->domain.material_count == spec->materials.count && (bad = check_results(model))) status = bad;
  if (!status && unknown) status = BRECCIA_USER_ERROR;
  if (!status) status = stands ? hold_grips(model, error) : BRECCIA_USER_ERROR;
  if (status) return status;
  model->solver = (Solver){.domain = &model->domain,
                           .loading = &model->loading,
                           .stages = &spec->solve,
                           .reader = &model->reader,
                           .force = force};
  status = solver_create(&model->solver, &model->warnings, error);
  if (!status) status = model_make_schedule(model, true, error);
  for (int p = 0; !status && p < spec->pictures.count; ++p) {
    const PictureSpec *picture = spec->pictures.items[p];
    for (int k = 0; k < picture->times.count; ++k) warn_of_late_picture(model, picture, picture->times.values[k]);
  }
  if (!status) plausibility_warn(model);
  return status;
}

int breccia_model_load_string(const char *deck, const char *name, const breccia_options *options, breccia_model **out,
                              breccia_error *given)
{
  *out = NULL;
  Error *error = given ? given : breccia_error_create();
  breccia_model *model = calloc(1, sizeof *model);
  int status = BRECCIA_FAILURE;
  Team *before;
  static const breccia_options standard = {0};
  if (!options) options = &standard;
  Text ignored = {0};
  if (model) model->threads = options->threads > 0 ? options->threads : threads_by_default(&ignored);
  if (!model || !error) {
    error_add(error, BRECCIA_FAILURE, "out of memory: model");
  } else if (!model_enter(model, &before, error)) {
    model->laws = (LawList){options->laws, options->law_count};
    model->settings = options->settings;
    model->setting_count = options->setting_count;
    const DeckText words = {deck, name, options->settings, options->setting_count};
    status = open_deck(model, &words, error);
    if (!status) status = build(model, options->force, error);
    if (!status && error_count(error)) status = BRECCIA_USER_ERROR;
    if (ignored.length) text_add(&model->warnings, "%s%s", model->warnings.length ? "\n" : "", ignored.characters);
    team_use(before);
  }
  text_free(&ignored);
  if (status)
    breccia_model_destroy(&model);
  else
    model->reader.error = NULL;
  if (!given) breccia_error_destroy(&error);
  *out = model;
  return status;
}

int breccia_model_load_file(const char *path, const breccia_options *options, breccia_model **model,
                            breccia_error *error)
{
  *model = NULL;
  size_t length;
  char *text = document_text(path, &length, error);
  if (!text) return BRECCIA_USER_ERROR;
  int status = breccia_model_load_string(text, path, options, model, error);
  free(text);
  return status;
}

void breccia_model_destroy(breccia_model **out)
{
  if (!out || !*out) return;
  breccia_model *model = *out;
  watches_destroy(&model->watches);
  solver_destroy(&model->solver);
  loading_destroy(&model->loading);
  domain_destroy(&model->domain);
  team_destroy(&model->team);
  units_destroy(&model->units);
  document_destroy(&model->document);
  text_free(&model->warnings);
  text_free(&model->overview);
  text_free(&model->plausibility);
  text_free(&model->outcome);
  text_free(&model->stage);
  free(model->schedule);
  free(model->stops);
  text_free(&model->deck);
  free(model);
  *out = NULL;
}

/* ---- stepping ---- */

int model_begin(breccia_model *model, Error *error)
{
  if (model->begun) return BRECCIA_OK;
  int status = points_begin(&model->domain.points, error);
  if (!status) status = solver_begin(&model->solver, error);
  model->begun = !status;
  return status;
}

int model_advance(breccia_model *model, Error *error)
{
  int status = BRECCIA_OK;
  while (!status && model->solver.clock.ended && !solver_is_done(&model->solver)) {
    model->states_before += model->schedule_count;
    status = solver_next_stage(&model->solver, &model->warnings, error);
    if (!status) status = model_make_schedule(model, true, error);
  }
  if (status || solver_is_done(&model->solver)) return status;
  return solver_advance(&model->solver, &model->warnings, error);
}

int breccia_model_step(breccia_model *model, int64_t steps, breccia_error *error)
{
  Team *before;
  if (model_enter(model, &before, error)) return BRECCIA_FAILURE;
  int status = model_begin(model, error);
  for (int64_t k = 0; !status && k < steps && !solver_is_done(&model->solver); ++k)
    status = model_advance(model, error);
  team_use(before);
  return status;
}

/* ---- looking ---- */

int64_t breccia_model_particles(const breccia_model *model)
{
  return model->domain.particles->count;
}
int64_t breccia_model_bonds(const breccia_model *model)
{
  return model->domain.family.bonds;
}
int64_t breccia_model_broken_bonds(const breccia_model *model)
{
  return model->domain.broken_count;
}
int64_t breccia_model_steps_done(const breccia_model *model)
{
  return model->solver.clock.step;
}
const char *breccia_model_stage(breccia_model *model)
{
  const Clock *clock = &model->solver.clock;
  char name[64];
  text_free(&model->stage);
  if (clock->stages > 1)
    text_add(&model->stage, "stage %lld of %lld, %s", (long long)clock->stage + 1, (long long)clock->stages,
             solver_stage_name(&model->solver, clock->stage, name, sizeof name));
  return text_words(&model->stage);
}
double breccia_model_time(const breccia_model *model)
{
  return model->solver.clock.time;
}
double breccia_model_time_step(const breccia_model *model)
{
  return model->solver.clock.time_step;
}
double breccia_model_stable_time_step(const breccia_model *model)
{
  return model->solver.clock.stable;
}
int64_t breccia_model_places(const breccia_model *model)
{
  return model->domain.particles->places;
}
const int32_t *breccia_model_numbers(const breccia_model *model)
{
  return model->domain.particles->number;
}

int model_field_names(const breccia_model *model, TextList *names, Error *error)
{
  const DeckSpec *spec = model->spec;
  const TextList *asked = &spec->results->fields;
  names->items = calloc((size_t)(asked->count + spec->pictures.count + 16), sizeof(char *));
  names->count = 0;
  if (!names->items) return error_add(error, BRECCIA_FAILURE, "out of memory: fields");
  for (int pass = 0; pass < 3; ++pass) {
    int count = pass == 0 ? asked->count : pass == 1 ? spec->pictures.count : 6;
    for (int k = 0; k < count; ++k) {
      const char *name = pass == 0      ? asked->items[k]
                         : pass == 1    ? ((const PictureSpec *)spec->pictures.items[k])->field
                         : asked->count ? "displacement"
                                        : standard_fields[k];
      int known = !name;
      for (int n = 0; n < names->count; ++n) known |= name && !strcmp(names->items[n], name);
      if (!known) names->items[names->count++] = name;
    }
  }
  return BRECCIA_OK;
}

/* ---- how long a run takes ---- */

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
  if (!model->spec->pictures.count) task.pictures = 3;
  return task;
}

/** Mean seconds of one evaluation of the forces. On a quiet machine a tenth of a second is enough; where others use it too, two seconds,
 *  in which they have had their turns. Never more than a tenth of what the whole run takes. */
static double measure_evaluation(breccia_model *model)
{
  enum { FEWEST = 3 };
  double fastest = INFINITY, before = 0;
  bool quiet = true;
  domain_evaluate(&model->domain); /* the first touches memory for the first time */
  const double begin = clock_seconds();
  for (int count = 1;; ++count) {
    domain_evaluate(&model->domain);
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
  Team *before;
  if (model->begun || model->outlook.state_bytes > 0) return BRECCIA_OK;
  ResultNames names = {.single = !strcmp(model->spec->results->precision, "single")};
  TextList list;
  if (model_enter(model, &before, error)) return BRECCIA_FAILURE;
  const int status = model_field_names(model, &list, error);
  if (!status) {
    names.fields = list.items;
    names.count = list.count;
    /* What a step does beside the forces takes 2 to 40 % of them (docs/performance.md). */
    outlook_expect(&model->outlook, 1.2 * measure_evaluation(model), result_file_state_bytes(d, &names),
                   (double)(domain_particle_bytes(d)), d->particles->count);
    free(list.items);
  }
  team_use(before);
  return status;
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
    if (!strcmp(stage->laws, "elastic")) text_add(text, ", elastic");
    if (!strcmp(stage->displacements, "zero")) text_add(text, ", displacements from zero");
    if (stage->loads.count) text_add(text, ", %d new load%s", stage->loads.count, stage->loads.count > 1 ? "s" : "");
    text_add(text, "\n");
  }
  text_add(text, "%lld steps at most, the first of %.4g %s (%.2f of the stable %.4g)",
           (long long)(s->clock.steps - begin), s->clock.time_step, time, s->clock.time_step / s->clock.stable,
           s->clock.stable);
}

const char *breccia_model_overview(breccia_model *model)
{
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  Text *text = &model->overview;
  text_free(text);
  int fewest = INT32_MAX, most = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    int count = family_count(&d->family, d->particles->place_of[n]);
    if (count < fewest) fewest = count;
    if (count > most) most = count;
  }
  char length[64], time[64];
  units_name(model->units, dimension_find("length"), length, sizeof length);
  units_name(model->units, dimension_find("time"), time, sizeof time);
  text_add(text, "%s: %lld particles, %lld bonds, %d to %d per particle (mean %.1f), horizon %g %s\n",
           model->spec->title, (long long)d->particles->count, (long long)d->family.bonds / 2, fewest, most,
           (double)d->family.bonds / (double)d->particles->count, d->family.horizon, length);
  text_add(text, "%s;", d->type->name);
  for (int k = 0; k < d->material_count; ++k)
    text_add(text, "%s %s (%s)", k ? "," : "", d->materials[k].name, d->materials[k].law->name);
  if (d->failure.criterion)
    text_add(text, "; %s", d->failure.criterion->name);
  else
    text_add(text, "; bonds do not break");
  for (int k = 0; d->failure.criterion && k < d->material_count; ++k)
    if (isfinite(d->failure.limit[k]))
      text_add(text, "%s %g", k ? "," : "", d->failure.limit[k]);
    else
      text_add(text, "%s none", k ? "," : "");
  text_add(text, "\n");
  if (d->type->describe) d->type->describe(d->formulation, text);
  plausibility_in_short(model, text);
  text_add(text, "\n");
  if (s->clock.stages > 1)
    describe_stages(model, time, text);
  else
    s->type->describe(s, time, text);
  text_add(text, ", %.0f MB, about ", (double)domain_bytes(d) / 1e6);
  model_expect(model, NULL);
  const Task task = model_task(model, s->clock.step, s->clock.steps, 0);
  add_duration(text, outlook_left(&model->outlook, &task));
  if (d->points.servers) text_add(text, " and what its material servers take");
  return text_words(text);
}

const char *breccia_model_plausibility(breccia_model *model)
{
  text_free(&model->plausibility);
  plausibility_describe(model, &model->plausibility);
  return text_words(&model->plausibility);
}

const char *breccia_model_deck(const breccia_model *model)
{
  return text_words(&model->deck);
}

const char *breccia_model_warnings(breccia_model *model)
{
  return text_words(&model->warnings);
}

const char *breccia_model_outcome(breccia_model *model)
{
  return text_words(&model->outcome);
}

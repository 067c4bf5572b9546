/* A whole run with its files: results, histories, checkpoints, pictures, summary. */
#include "base/clock.h"
#include "base/tensor.h"
#include "model/model.h"
#include "results/checkpoint.h"
#include "results/curve.h"
#include "results/result_file.h"
#include "solver/rest.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Run {
  breccia_model *model;
  const breccia_run *wish;
  ResultFile *results;
  int64_t next_write; /* index in the schedule */
  int64_t steps;      /* where to stop */
  double started, last_checkpoint, last_progress;
  double paused;   /* seconds since the last progress that went into writing */
  int64_t told_at; /* step of the last progress */
  TextList names;
  Text files;
} Run;

static void note_file(Run *run, const char *path)
{
  text_add(&run->files, "  %s\n", path);
}

/* ---- pieces ---- */

static int make_folder(const char *path, Error *error)
{
  char *part = text_format("%s", path);
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: folder");
  for (char *slash = strchr(part + (*part != 0), '/');; slash = strchr(slash + 1, '/')) {
    if (slash) *slash = 0;
    int bad = mkdir(part, 0777);
    struct stat status;
    if (bad && (errno != EEXIST || stat(part, &status) || !S_ISDIR(status.st_mode))) {
      error_add(error, BRECCIA_USER_ERROR, "%s: the folder cannot be made: %s", part, strerror(errno));
      free(part);
      return BRECCIA_USER_ERROR;
    }
    if (!slash) break;
    *slash = '/';
  }
  free(part);
  return BRECCIA_OK;
}

static void update_peaks(breccia_model *model)
{
  const Domain *d = &model->domain;
  Peaks *peaks = &model->peaks;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    int32_t place = d->particles->place_of[n];
    double u = 0, v = 0, s[6];
    for (int k = 0; k < 3; ++k) {
      u += pow(particles_moved(d->particles, k, place), 2);
      v += pow(d->particles->velocity[k][place], 2);
    }
    for (int k = 0; k < 6; ++k) s[k] = d->stress[k][place];
    peaks->displacement = fmax(peaks->displacement, sqrt(u));
    peaks->velocity = fmax(peaks->velocity, sqrt(v));
    peaks->octahedral = fmax(peaks->octahedral, tensor_octahedral_shear(s));
    peaks->mean_low = fmin(peaks->mean_low, (s[XX] + s[YY] + s[ZZ]) / 3);
    peaks->mean_high = fmax(peaks->mean_high, (s[XX] + s[YY] + s[ZZ]) / 3);
    peaks->damage = fmax(peaks->damage, domain_damage(d, place));
  }
}

static int write_results(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const double start = clock_seconds();
  if (domain_observe(&model->domain, error)) return BRECCIA_FAILURE;
  update_peaks(model);
  const int status =
      result_file_write(run->results, &model->domain, model->solver.clock.step, model->solver.clock.time, error);
  const double seconds = clock_seconds() - start;
  Outlook *o = &model->outlook;
  pace_note(&o->bytes, o->state_bytes, seconds);
  run->paused += seconds;
  return status;
}

static int write_checkpoint(Run *run, Error *error)
{
  breccia_model *model = run->model;
  if (result_file_show(run->results, error)) return BRECCIA_FAILURE; /* a restart takes them up from there */
  run->last_checkpoint = clock_seconds();
  if (!points_can_save(&model->domain.points))
    return BRECCIA_OK; /* the checkpoint before, if any, is all that is left */
  StateList state = {0};
  model_state(model, &state);
  const CheckpointOf of = {text_words(&model->deck), model->domain.particles->count};
  const int status = checkpoint_write(run->wish->folder, &state, &of, error);
  state_list_destroy(&state);
  const double seconds = clock_seconds() - run->last_checkpoint;
  pace_note(&run->model->outlook.checkpoints, 1, seconds);
  run->paused += seconds;
  return status;
}

/** Writes a small file whole, or not at all. */
static int write_file(Run *run, const char *name, const Text *words, Error *error)
{
  char *path = text_format("%s/%s", run->wish->folder, name),
       *part = text_format("%s/%s.part", run->wish->folder, name);
  errno = 0;
  FILE *file = part && path ? fopen(part, "w") : NULL;
  int bad = !file || fwrite(text_words(words), 1, words->length, file) != words->length;
  if (file && fclose(file)) bad = 1;
  bad = bad || rename(part, path);
  if (bad) error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path ? path : name, strerror(errno));
  free(path);
  free(part);
  return bad ? BRECCIA_FAILURE : BRECCIA_OK;
}

/** The deck as it is run, beside its results. What is told of an earlier run would be told of another deck. */
static int write_deck(Run *run, Error *error)
{
  const breccia_model *model = run->model;
  Text words = {0};
  text_add(&words, "# What was run, by Breccia %s, from ", BRECCIA_VERSION);
  text_add_json(&words, model->document->name);
  for (int k = 0; k < model->setting_count; ++k) {
    text_add(&words, " --set ");
    text_add_json(&words, model->settings[k]);
  }
  text_add(&words, "\n# Everything is worked out in it. Files that it names are beside the file above.\n%s",
           text_words(&model->deck));
  char *summary = run->wish->restart ? NULL : text_format("%s/summary.json", run->wish->folder);
  if (summary) unlink(summary);
  const int status = write_file(run, "deck.yaml", &words, error);
  free(summary);
  text_free(&words);
  return status;
}

static int read_checkpoint(Run *run, Error *error)
{
  breccia_model *model = run->model;
  StateList state = {0};
  const int64_t stage = checkpoint_count(run->wish->folder, "stage");
  if (stage > 0 && stage < model->solver.clock.stages && solver_enter(&model->solver, stage, error))
    return BRECCIA_FAILURE;
  model_state(model, &state);
  const CheckpointOf of = {text_words(&model->deck), model->domain.particles->count};
  const int status = checkpoint_read(run->wish->folder, &state, &of, error);
  state_list_destroy(&state);
  model->begun = !status;
  return status ? status : model_make_schedule(model, false, error);
}

static int open_files(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const ResultNames names = {run->names.items, run->names.count, !strcmp(model->spec->results->precision, "single")};
  int64_t resume = run->wish->restart ? model->solver.clock.step : -1;
  int status;
  if (run->wish->restart) {
    const WrittenAt at = {model->schedule,
                          model->schedule_count,
                          model->spec->results->every,
                          model->solver.clock.time_step / 2,
                          model->solver.clock.step,
                          model->solver.clock.ended && model->solver.clock.stages > 1};
    while (model_has_passed(model, run->next_write, model->solver.clock.time)) ++run->next_write;
    status = result_file_resume(&run->results, run->wish->folder, &model->domain, model->units, model->spec->title,
                                &names, &at, error);
  } else
    status = result_file_create(&run->results, run->wish->folder, &model->domain, model->units, model->spec->title,
                                &names, error);
  if (!status) status = write_deck(run, error);
  return status ? status : watches_open(model->watches, run->wish->folder, model->units, resume, error);
}

/* ---- the loop ---- */

static void show_progress(Run *run, bool always)
{
  const Solver *s = &run->model->solver;
  double now = clock_seconds();
  if (!run->wish->progress || (!always && now - run->last_progress < 0.2)) return;
  pace_note(&run->model->outlook.steps, (double)(s->clock.step - run->told_at), now - run->last_progress - run->paused);
  run->last_progress = now;
  run->told_at = s->clock.step;
  run->paused = 0;
  const Task left = model_task(run->model, s->clock.step, run->steps, run->model->states_before + run->next_write);
  run->wish->progress(run->wish->context, s->clock.step, run->steps, outlook_left(&run->model->outlook, &left));
}

static int due(Run *run, Error *error)
{
  breccia_model *model = run->model;
  const Solver *s = &model->solver;
  const ResultsSpec *r = model->spec->results;
  int status = watches_write(model->watches, s, false, error);
  bool write = r->every > 0 && s->clock.step % r->every == 0;
  for (; model_has_passed(model, run->next_write, s->clock.time); ++run->next_write) write = true;
  write |= s->clock.ended && s->clock.stages > 1;
  if (!status && write) status = write_results(run, error);
  bool by_steps = r->checkpoint_steps > 0 && s->clock.step && s->clock.step % r->checkpoint_steps == 0;
  if (!status && (by_steps || clock_seconds() - run->last_checkpoint > r->checkpoint_seconds))
    status = write_checkpoint(run, error);
  return status;
}

/** Steps at which to stop: as many as wished for, or as the run has as far as it can be foreseen. */
static int64_t steps_wanted(const Run *run)
{
  const int64_t wished = run->wish->steps, steps = run->model->solver.clock.steps;
  return wished > 0 && wished < steps ? wished : steps;
}

/** What was due at the end of the stage before has been written. */
static void begin_stage(Run *run)
{
  run->next_write = 0;
  while (run->next_write < run->model->schedule_count &&
         run->model->schedule[run->next_write] <= run->model->solver.clock.stage_time)
    ++run->next_write;
}

static int loop(Run *run, Error *error)
{
  breccia_model *model = run->model;
  Solver *s = &model->solver;
  int status = run->wish->restart ? BRECCIA_OK : due(run, error);
  while (!status && !solver_is_done(s) && s->clock.step < run->steps) {
    if (run->wish->interrupted && *run->wish->interrupted) return BRECCIA_INTERRUPTED;
    const int64_t stage = s->clock.stage, step = s->clock.step;
    status = model_advance(model, error);
    if (s->clock.stage != stage) begin_stage(run);
    if (status) break;
    model->run_steps += s->clock.step - step;
    run->steps = steps_wanted(run);
    status = due(run, error);
    show_progress(run, false);
  }
  return status;
}

/* ---- pictures ---- */

static int nearest_write(const ResultView *view, double time)
{
  int best = view->steps - 1;
  for (int k = 0; k < view->steps; ++k)
    if (fabs(view->times[k] - time) < fabs(view->times[best] - time)) best = k;
  return best;
}

/** A path in the folder of pictures that no other picture of this run has. To be freed. */
static char *picture_path(const Run *run, const char *given, const char *name)
{
  char *path = NULL;
  for (int number = 1; number < 1000; ++number) {
    char words[256], safe[256], ending[16] = "";
    if (number > 1) snprintf(ending, sizeof ending, "-%d", number);
    snprintf(words, sizeof words, "%.200s%s", given ? given : name, ending);
    text_file_name(words, safe, sizeof safe);
    path = text_format("%s/pictures/%s.png", run->wish->folder, safe);
    char *line = path ? text_format("  %s\n", path) : NULL;
    const bool taken = line && run->files.characters && strstr(run->files.characters, line);
    free(line);
    if (!taken) break;
    free(path);
    path = NULL;
  }
  return path;
}

static PictureOptions picture_options(const PictureSpec *spec)
{
  return (PictureOptions){.field = spec->field,
                          .component = spec->component,
                          .title = spec->title,
                          .x_label = spec->x_label,
                          .y_label = spec->y_label,
                          .deformed = spec->deformed,
                          .azimuth = spec->view[0],
                          .elevation = spec->view[1],
                          .low = spec->range[0],
                          .high = spec->range[1],
                          .broken_bonds = spec->broken_bonds};
}

/** One field at the times of its entry, or at the last one written. */
static int draw_field(Run *run, const ResultView *view, const PictureSpec *spec, Error *error)
{
  const PictureOptions o = picture_options(spec);
  PictureSurvey survey;
  int status = spec->same_range ? picture_survey(view, 0, view->steps - 1, false, &o, &survey, error) : BRECCIA_OK;
  for (int t = 0; !status && t < (spec->times.count ? spec->times.count : 1); ++t) {
    const double time = spec->times.count ? spec->times.values[t] : run->model->solver.clock.time;
    if (time > run->model->solver.clock.time * (1 + 1e-9)) continue; /* the run did not come so far */
    const int step = nearest_write(view, time);
    char name[160];
    picture_name(view, step, spec->field, spec->component, spec->times.count > 0, name, sizeof name);
    char *path = picture_path(run, spec->times.count > 1 ? NULL : spec->name, name);
    if (spec->name && spec->times.count > 1) { /* the times tell its pictures apart */
      char whole[256];
      picture_name(view, step, spec->name, NULL, true, whole, sizeof whole);
      free(path);
      path = picture_path(run, whole, NULL);
    }
    status = path ? picture_draw(view, step, &o, spec->same_range ? &survey : NULL, path, error) : BRECCIA_FAILURE;
    if (!status) note_file(run, path);
    free(path);
  }
  return status;
}

static int draw_curve(Run *run, const PictureSpec *spec, Error *error)
{
  char name[160];
  const char *folder = run->wish->folder;
  char *curve = spec->energy ? curve_of_energies(folder, error) : text_format("%s", spec->curve);
  if (!curve) return BRECCIA_FAILURE;
  curve_name(curve, name, sizeof name);
  char *path = picture_path(run, spec->name, name);
  const CurveOptions o = {.title = spec->title ? spec->title : run->model->spec->title,
                          .x_label = spec->x_label,
                          .y_label = spec->y_label,
                          .log_axes = spec->log_axes,
                          .low = spec->range[0],
                          .high = spec->range[1]};
  int status = path ? curve_draw(&folder, 1, curve, &o, path, error) : BRECCIA_FAILURE;
  if (!status) note_file(run, path);
  free(path);
  free(curve);
  return status;
}

/** Pictures are made from the files, as `breccia plot` does. What cannot be drawn is a warning: the results are there. */
static void draw_pictures(Run *run)
{
  breccia_model *model = run->model;
  Error *error = breccia_error_create();
  char *path = text_format("%s/results.vtkhdf", run->wish->folder),
       *folder = text_format("%s/pictures", run->wish->folder);
  ResultView view;
  int status = path && folder ? make_folder(folder, error) : BRECCIA_FAILURE;
  if (!status && !(status = result_view_open(&view, path, error))) {
    static const char *const usual[] = {"displacement", "octahedral shear stress", "damage"};
    for (int k = 0; !model->spec->pictures.count && k < 3; ++k) {
      bool written = false;
      for (int n = 0; n < run->names.count; ++n) written |= !strcmp(run->names.items[n], usual[k]);
      const PictureSpec spec = {
          .field = usual[k], .deformed = 1, .view = {NAN, NAN, NAN}, .range = {NAN, NAN, NAN}, .same_range = true};
      if (written) draw_field(run, &view, &spec, error);
    }
    for (int k = 0; k < model->spec->pictures.count; ++k) {
      const PictureSpec *spec = model->spec->pictures.items[k];
      if (spec->field)
        draw_field(run, &view, spec, error);
      else
        draw_curve(run, spec, error);
    }
    result_view_close(&view);
  }
  if (error_count(error))
    text_add(&model->warnings, "%swarning: %s", model->warnings.length ? "\n" : "", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(path);
  free(folder);
}

/* ---- summary ---- */

static double load_peak(const Load *load, double time)
{
  enum { SAMPLES = 1000 };
  double peak = 0;
  for (int k = 0; k <= SAMPLES; ++k)
    peak = fmax(peak, fabs(load_factor(load, load->begin + (time - load->begin) * k / SAMPLES)));
  return peak * load_magnitude(load->spec);
}

static double nanoseconds_per_bond(const breccia_model *model)
{
  double work = (double)model->run_steps * (double)model->domain.family.bonds;
  return work > 0 ? 1e9 * model->run_seconds / work : 0;
}

static void add_number(Text *text, const char *key, double value)
{
  if (isfinite(value))
    text_add(text, "\"%s\": %.10g", key, value);
  else
    text_add(text, "\"%s\": null", key);
}

/** What the deck was made of: its file, settings from outside, its variables with their values. */
static void add_origin(const breccia_model *model, Text *t)
{
  text_add(t, "  \"deck\": ");
  text_add_json(t, model->document->name);
  text_add(t, ",\n  \"settings\": [");
  for (int k = 0; k < model->setting_count; ++k) {
    text_add(t, "%s", k ? ", " : "");
    text_add_json(t, model->settings[k]);
  }
  text_add(t, "],\n  \"variables\": {");
  const Node *variables = node_get(model->document->root, "variables");
  for (int k = 0; variables && k < variables->count; ++k) {
    text_add(t, "%s", k ? ", " : "");
    text_add_json(t, variables->items[k].key);
    text_add(t, ": ");
    text_add_json(t, variables->items[k].text);
  }
  text_add(t, "},\n");
}

/** The bond that broke first, and its middle; NULL if none did. */
static const BrokenBond *first_broken(const Domain *d, double middle[3])
{
  if (!d->broken_count) return NULL;
  const BrokenBond *bond = &d->broken[0];
  const int32_t a = d->particles->place_of[bond->a], b = d->particles->place_of[bond->b];
  for (int k = 0; k < 3; ++k) middle[k] = (d->particles->position[k][a] + d->particles->position[k][b]) / 2;
  return bond;
}

/** The stages that have begun, where there are several. */
static void add_stages(const Solver *s, Text *text)
{
  if (s->clock.stages == 1) return;
  text_add(text, "  \"stages\": [");
  for (int64_t k = 0; k <= s->clock.stage; ++k) {
    const StageRecord *r = &s->records[k];
    char name[64];
    text_add(text, "%s{\"name\": ", k ? ", " : "");
    text_add_json(text, solver_stage_name(s, k, name, sizeof name));
    text_add(text, ", \"steps\": [%.0f, %.0f], ", r->first_step, r->last_step);
    text_add(text, "\"times\": [%.10g, %.10g], \"at_rest\": %s}", r->begin, r->end,
             r->came_to_rest > 0 ? "true" : "false");
  }
  text_add(text, "],\n");
}

static void tell_stages(const Solver *s, const char *time, Text *text)
{
  for (int64_t k = 0; s->clock.stages > 1 && k <= s->clock.stage; ++k) {
    const StageRecord *r = &s->records[k];
    char name[64];
    text_add(text, "stage '%s': steps %.0f to %.0f, time %.6g to %.6g %s%s\n",
             solver_stage_name(s, k, name, sizeof name), r->first_step, r->last_step, r->begin, r->end, time,
             r->came_to_rest > 0 ? ", came to rest" : "");
  }
}

static int write_summary(Run *run, int status, const char *problem, Error *error)
{
  breccia_model *model = run->model;
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  Energy e = solver_energy(s);
  Text t = {0};
  text_add(&t, "{\n  \"title\": ");
  text_add_json(&t, model->spec->title);
  text_add(&t, ",\n  \"version\": \"%s\",\n  \"completed\": %s,\n", BRECCIA_VERSION,
           !status && solver_is_done(s) ? "true" : "false");
  add_origin(model, &t);
  if (problem && *problem) {
    text_add(&t, "  \"problem\": ");
    text_add_json(&t, problem);
    text_add(&t, ",\n");
  }
  text_add(&t, "  \"particles\": %lld,\n  \"bonds\": %lld,\n  \"steps\": %lld,\n", (long long)d->particles->count,
           (long long)d->family.bonds / 2, (long long)s->clock.step);
  text_add(&t, "  \"time\": %.10g,\n  \"time_step\": %.10g,\n  \"stable_time_step\": %.10g,\n", s->clock.time,
           s->clock.time_step, s->clock.stable);
  add_stages(s, &t);
  text_add(&t, "  \"wall_seconds\": %.3f,\n  \"ns_per_directed_bond_step\": %.4f,\n  \"threads\": %d,\n",
           model->run_seconds, nanoseconds_per_bond(model), model->threads);
  double x[3];
  const BrokenBond *first = first_broken(d, x);
  if (first)
    text_add(
        &t,
        "  \"first_broken_bond\": {\"step\": %lld, \"time\": %.10g, \"particles\": [%d, %d], \"at\": [%.10g, %.10g, "
        "%.10g]},\n",
        (long long)first->step, first->time, first->a, first->b, x[0], x[1], x[2]);
  else
    text_add(&t, "  \"first_broken_bond\": null,\n");
  text_add(&t, "  \"broken_bonds\": %lld,\n  \"energy\": {", (long long)d->broken_count);
  const struct {
    const char *key;
    double value;
  } energies[] = {{"kinetic", e.kinetic},       {"internal", e.internal}, {"stored", e.stored},
                  {"dissipated", e.dissipated}, {"external", e.external}, {"damping", e.damping},
                  {"fracture", e.fracture},     {"friction", e.friction}, {"between", e.between},
                  {"imbalance", e.imbalance}};
  for (int k = 0; k < (int)(sizeof energies / sizeof *energies); ++k) {
    if (k) text_add(&t, ", ");
    add_number(&t, energies[k].key, energies[k].value);
  }
  text_add(&t, "},\n  \"peaks\": {");
  const Peaks *p = &model->peaks;
  const struct {
    const char *key;
    double value;
  } peaks[] = {{"displacement", p->displacement},          {"velocity", p->velocity},
               {"octahedral_shear_stress", p->octahedral}, {"mean_stress_lowest", p->mean_low},
               {"mean_stress_highest", p->mean_high},      {"damage", p->damage}};
  for (int k = 0; k < 6; ++k) {
    if (k) text_add(&t, ", ");
    add_number(&t, peaks[k].key, peaks[k].value);
  }
  text_add(&t, "},\n  \"loads\": [");
  for (int k = 0; k < model->loading.count; ++k) {
    const LoadSpec *l = model->loading.loads[k].spec;
    const char *dimension, *kind = load_kind(l, &dimension);
    char unit[64];
    units_name(model->units, dimension_find(dimension), unit, sizeof unit);
    text_add(&t, "%s{\"name\": ", k ? ", " : "");
    text_add_json(&t, l->name ? l->name : "");
    text_add(&t, ", \"line\": %d, \"kind\": \"%s\", ", l->head.node->line, kind);
    add_number(&t, "peak", load_peak(&model->loading.loads[k], s->clock.time));
    text_add(&t, ", \"unit\": ");
    text_add_json(&t, unit);
    text_add(&t, "}");
  }
  text_add(&t, "],\n  \"units\": {");
  static const char *const units[][2] = {{"times", "time"},
                                         {"positions and displacements", "length"},
                                         {"velocities", "velocity"},
                                         {"stresses", "stress"},
                                         {"energies", "energy"}}; /* shares have none */
  for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
    char unit[64];
    units_name(model->units, dimension_find(units[k][1]), unit, sizeof unit);
    text_add(&t, "%s\"%s\": ", k ? ", " : "", units[k][0]);
    text_add_json(&t, unit);
  }
  text_add(&t, "}");
  Text servers = {0};
  points_report(&d->points, model->run_seconds, true, &servers);
  if (servers.length) text_add(&t, ",\n  \"servers\": [%s]", text_words(&servers));
  text_free(&servers);
  text_add(&t, "\n}\n");
  const int status_written = write_file(run, "summary.json", &t, error);
  if (!status_written) text_add(&run->files, "  %s/summary.json\n", run->wish->folder);
  text_free(&t);
  return status_written;
}

/** Says whether a body that was meant to come to rest has done so. */
static void tell_rest(const Solver *s, Text *t)
{
  Rest rest;
  if (rest_find(s, &rest, NULL) || !rest.meant) return;
  if (rest.reached)
    text_add(t, "at rest: forces out of balance are %.2g of those that act, kinetic energy %.2g of the work\n",
             rest.unbalanced, rest.kinetic);
  else
    text_add(
        t,
        "not at rest: forces out of balance are %.2g of those that act, kinetic energy %.2g of the work (at rest both "
        "are below %g): run longer, with local damping, or load more slowly; what slides or falls does not come to "
        "rest\n",
        rest.unbalanced, rest.kinetic, rest_limit);
}

static void tell_outcome(Run *run, int status)
{
  breccia_model *model = run->model;
  const Domain *d = &model->domain;
  const Solver *s = &model->solver;
  Energy e = solver_energy(s);
  Text *t = &model->outcome;
  char time[64], length[64];
  units_name(model->units, dimension_find("time"), time, sizeof time);
  units_name(model->units, dimension_find("length"), length, sizeof length);
  text_free(t);
  text_add(t, "%s at step %lld of %lld, time %.6g %s; %.1f s for %lld steps, %.2f ns per directed bond and step\n",
           status == BRECCIA_INTERRUPTED ? "stopped on request"
           : status                      ? "stopped by a failure"
                                         : "finished",
           (long long)s->clock.step, (long long)s->clock.steps, s->clock.time, time, model->run_seconds,
           (long long)model->run_steps, nanoseconds_per_bond(model));
  tell_stages(s, time, t);
  for (int k = 0; k < model->loading.count; ++k) {
    const LoadSpec *l = model->loading.loads[k].spec;
    const char *dimension, *kind = load_kind(l, &dimension);
    char unit[64];
    units_name(model->units, dimension_find(dimension), unit, sizeof unit);
    if (l->name)
      text_add(t, "load '%s': %s, peak %.6g %s\n", l->name, kind, load_peak(&model->loading.loads[k], s->clock.time),
               unit);
  }
  double x[3];
  const BrokenBond *first = first_broken(d, x);
  if (first)
    text_add(
        t,
        "first broken bond at step %lld, time %.6g %s, near [%.4g, %.4g, %.4g] %s; %lld of %lld bonds broken in all\n",
        (long long)first->step, first->time, time, x[0], x[1], x[2], length, (long long)d->broken_count,
        (long long)d->family.bonds / 2);
  else if (d->failure.criterion)
    text_add(t, "no bond broke\n");
  const struct {
    const char *words;
    double value;
    bool told;
  } energies[] = {{"energy: external ", e.external, true},
                  {" = kinetic ", e.kinetic, true},
                  {" + stored ", e.stored, true},
                  {" + dissipated ", e.dissipated, true},
                  {" + fracture ", e.fracture, true},
                  {" + friction ", e.friction, e.friction != 0},
                  {" + damping ", e.damping, e.damping != 0},
                  {" - kinetic at the start ", s->ledger.kinetic_at_start, s->ledger.kinetic_at_start > 0},
                  {" - short waves between steps ", e.between, fabs(e.between) > 1e-3 * s->ledger.paid}};
  for (size_t k = 0; k < sizeof energies / sizeof *energies; ++k) {
    if (!energies[k].told) continue;
    text_add(t, "%s", energies[k].words);
    quantity_describe(units_in_si(model->units, dimension_find("energy"), energies[k].value), "J", t);
  }
  text_add(t, ", imbalance %.2g %%\n", 100 * e.imbalance);
  const Peaks *peaks = &model->peaks;
  const double stress = units_in_si(model->units, dimension_find("stress"), 1);
  text_add(t, "largest in the states written: displacement ");
  quantity_describe(units_in_si(model->units, dimension_find("length"), peaks->displacement), "m", t);
  text_add(t, ", octahedral shear stress ");
  quantity_describe(stress * peaks->octahedral, "Pa", t);
  text_add(t, ", mean stress ");
  quantity_describe(stress * peaks->mean_low, "Pa", t);
  text_add(t, " to ");
  quantity_describe(stress * peaks->mean_high, "Pa", t);
  text_add(t, ", damage %.3g\n", peaks->damage);
  tell_rest(s, t);
  points_report(&d->points, model->run_seconds, false, t);
  text_add(t, "written:\n%s", text_words(&run->files));
  if (t->length && t->characters[t->length - 1] == '\n') t->characters[--t->length] = 0;
}

static int finish(Run *run, int status, Error *error)
{
  breccia_model *model = run->model;
  model->run_seconds = clock_seconds() - run->started;
  char *problem = text_format("%s", breccia_error_text(error));
  if (!status) {
    status = watches_write(model->watches, &model->solver, true, error);
    /* First the checkpoint: a state written because a run stops early leaves no trace when it is taken up again. */
    if (!status) status = write_checkpoint(run, error);
    if (!status) status = write_results(run, error);
  } else if (status == BRECCIA_INTERRUPTED) {
    int bad = write_checkpoint(run, error);
    if (bad) status = bad;
  } else { /* the last good state; of energy from nothing the checkpoint before is the better one */
    if (!model->solver.ledger.unsound_steps) write_checkpoint(run, error);
    write_results(run, error);
    watches_write(model->watches, &model->solver, true, error);
  }
  if (result_file_show(run->results, error) && !status) status = BRECCIA_FAILURE;
  Text own = {0};
  text_add(&own, "  %s/deck.yaml (what was run)\n  %s/results.vtkhdf (and results.xdmf for older ParaView)\n",
           run->wish->folder, run->wish->folder);
  for (int k = 0; k < watches_count(model->watches); ++k) text_add(&own, "  %s\n", watches_path(model->watches, k));
  text_free(&run->files);
  run->files = own;
  int bad = write_summary(run, status, problem, error);
  if (bad && !status) status = bad;
  draw_pictures(run);
  tell_outcome(run, status);
  free(problem);
  return status;
}

int breccia_model_run(breccia_model *model, const breccia_run *wish, breccia_error *given)
{
  Error *error = given ? given : breccia_error_create();
  Run run = {.model = model, .wish = wish};
  model->run_steps = 0;
  Team *before;
  if (model_enter(model, &before, error)) {
    if (!given) breccia_error_destroy(&error);
    return BRECCIA_FAILURE;
  }
  int status = make_folder(wish->folder, error);
  if (!status) status = model_field_names(model, &run.names, error);
  if (!status && wish->progress) status = model_expect(model, error);
  if (!status && wish->restart) status = read_checkpoint(&run, error);
  run.steps = steps_wanted(&run); /* only now: a checkpoint may know of more */
  if (!status) status = model_begin(model, error);
  if (!status) status = open_files(&run, error);
  if (!status) {
    run.started = run.last_checkpoint = run.last_progress = clock_seconds();
    run.told_at = model->solver.clock.step;
    status = finish(&run, loop(&run, error), error);
  }
  result_file_destroy(&run.results);
  free(run.names.items);
  text_free(&run.files);
  team_use(before);
  if (!given) breccia_error_destroy(&error);
  return status;
}

/* The pictures of a run. */
#include "model/run.h"

#include "bars/bars.h"
#include "base/folder.h"
#include "results/bar_columns.h"
#include "results/bar_curve.h"
#include "results/curve.h"
#include "results/result_view.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void note_file(Run *run, const char *path)
{
  text_add(&run->files, "  %s\n", path);
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
                          .bars = spec->bars < 0 ? NULL : bar_column_name(spec->bars),
                          .title = spec->title,
                          .x_label = spec->x_label,
                          .y_label = spec->y_label,
                          .deformed = spec->deformed,
                          .azimuth = spec->view[0],
                          .elevation = spec->view[1],
                          .inside = spec->inside,
                          .low = spec->range[0],
                          .high = spec->range[1],
                          .broken_bonds = spec->broken_bonds};
}

/** One field, or bars, at the times of its entry, or at the last one written. */
static int draw_field(Run *run, const ResultView *view, const PictureSpec *spec, Error *error)
{
  const PictureOptions o = picture_options(spec);
  PictureSurvey survey;
  int status = spec->same_range ? picture_survey(view, 0, view->steps - 1, false, &o, &survey, error) : BRECCIA_OK;
  for (int t = 0; !status && t < (spec->times.count ? spec->times.count : 1); ++t) {
    const int step = spec->times.count ? result_view_nearest(view, spec->times.values[t]) : view->steps - 1;
    if (step < 0) continue; /* the run did not come so far */
    char name[160];
    picture_name(view, step, o.bars ? "bars" : spec->field, o.bars ? o.bars : spec->component, spec->times.count > 0,
                 name, sizeof name);
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

/** A column of bars over their length, at the times of its entry that the run came to, or at the last one written. */
static int draw_over_length(Run *run, const ResultView *view, const PictureSpec *spec, bool *no_gnuplot, Error *error)
{
  int steps[BAR_CURVE_TIMES], count = 0;
  for (int t = 0; t < spec->times.count && t < BAR_CURVE_TIMES; ++t)
    if ((steps[count] = result_view_nearest(view, spec->times.values[t])) >= 0) ++count;
  if (spec->times.count && !count) return BRECCIA_OK;
  if (!count) steps[count++] = view->steps - 1;
  char words[128];
  snprintf(words, sizeof words, "bar %.100s", bar_column_name(spec->bars));
  char *path = picture_path(run, spec->name, words);
  const BarCurveOptions o = {.column = bar_column_name(spec->bars),
                             .title = spec->title,
                             .x_label = spec->x_label,
                             .y_label = spec->y_label,
                             .log_axes = picture_log_axes(spec->log_axes),
                             .names = spec->of_bars.items,
                             .name_count = spec->of_bars.count,
                             .steps = steps,
                             .count = count,
                             .low = spec->range[0],
                             .high = spec->range[1],
                             .no_gnuplot = no_gnuplot};
  const int status = path ? bar_curve_draw(view, &o, path, error) : BRECCIA_FAILURE;
  if (!status) note_file(run, path);
  free(path);
  return status;
}

/** @param[out] no_gnuplot  whether that is why it could not be drawn */
static int draw_curve(Run *run, const PictureSpec *spec, bool *no_gnuplot, Error *error)
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
                          .log_axes = picture_log_axes(spec->log_axes),
                          .low = spec->range[0],
                          .high = spec->range[1],
                          .no_gnuplot = no_gnuplot};
  int status = path ? curve_draw(&folder, 1, curve, &o, path, error) : BRECCIA_FAILURE;
  if (!status) note_file(run, path);
  free(path);
  free(curve);
  return status;
}

typedef struct Outcome { /* of several pictures */
  int status;
  Error *warnings, *error;
} Outcome;

/** One picture of the deck. What could not be written is an error; what cannot be drawn, because the results do not hold it or there is no
 *  gnuplot, is a warning. */
static void draw(Run *run, const ResultView *view, const PictureSpec *spec, Outcome *outcome)
{
  Error *own = breccia_error_create();
  bool no_gnuplot = false;
  const int status = spec->over_length                ? draw_over_length(run, view, spec, &no_gnuplot, own)
                     : spec->field || spec->bars >= 0 ? draw_field(run, view, spec, own)
                                                      : draw_curve(run, spec, &no_gnuplot, own);
  const bool unwritten = status == BRECCIA_FAILURE && !no_gnuplot;
  if (unwritten) outcome->status = BRECCIA_FAILURE;
  if (status) error_add_all(unwritten ? outcome->error : outcome->warnings, status, own);
  breccia_error_destroy(&own);
}

/** Pictures of a profile; the same holds of what cannot be drawn. */
static void draw_profile(Run *run, int k, const char *folder, Outcome *outcome)
{
  const breccia_model *model = run->model;
  Error *own = breccia_error_create();
  bool no_gnuplot = false;
  const int status = profiles_draw(model->profiles, k, folder, model->units, &run->files, &no_gnuplot, own);
  const bool unwritten = status == BRECCIA_FAILURE && !no_gnuplot;
  if (unwritten) outcome->status = BRECCIA_FAILURE;
  if (status) error_add_all(unwritten ? outcome->error : outcome->warnings, status, own);
  breccia_error_destroy(&own);
}

static void draw_all(Run *run, const ResultView *view, Outcome *outcome)
{
  static const char *const usual[] = {"displacement", "octahedral shear stress", "damage"};
  const SectionList *own = &run->model->spec->pictures;
  for (int k = 0; deck_usual_pictures(run->model->spec) && k < 3; ++k) {
    bool written = false;
    for (int n = 0; n < run->names.count; ++n) written |= !strcmp(run->names.items[n], usual[k]);
    const PictureSpec spec = {.field = usual[k],
                              .bars = -1,
                              .deformed = 1,
                              .view = {NAN, NAN, NAN},
                              .range = {NAN, NAN, NAN},
                              .same_range = true};
    if (written) draw(run, view, &spec, outcome);
  }
  const PictureSpec stress = {.bars = BAR_STRESS, .over_length = true, .range = {NAN, NAN, NAN}};
  if (deck_usual_pictures(run->model->spec) && bars_among(&run->model->domain.forces))
    draw(run, view, &stress, outcome);
  for (int k = 0; k < own->count; ++k) draw(run, view, own->items[k], outcome);
}

int run_draw_pictures(Run *run, Error *error)
{
  breccia_model *model = run->model;
  if (!deck_usual_pictures(model->spec) && !model->spec->pictures.count) return BRECCIA_OK;
  Outcome outcome = {BRECCIA_OK, breccia_error_create(), error};
  char *path = text_format("%s/results.vtkhdf", run->wish->folder),
       *folder = text_format("%s/pictures", run->wish->folder);
  ResultView view;
  if (!path || !folder)
    outcome.status = error_add(error, BRECCIA_FAILURE, "out of memory: pictures");
  else if (folder_make_inside(folder, error) || result_view_open(&view, path, error))
    outcome.status = BRECCIA_FAILURE;
  else {
    if (view.steps) draw_all(run, &view, &outcome);
    for (int k = 0; k < profiles_count(model->profiles); ++k) draw_profile(run, k, folder, &outcome);
    result_view_close(&view);
  }
  if (error_count(outcome.warnings))
    text_add(&model->warnings, "%swarning: %s", model->warnings.length ? "\n" : "",
             breccia_error_text(outcome.warnings));
  breccia_error_destroy(&outcome.warnings);
  free(path);
  free(folder);
  return outcome.status;
}

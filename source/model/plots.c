/* Pictures of results, after a run. */
#include "model/host.h"
#include "model/sized.h"
#include "results/bar_curve.h"
#include "results/curve.h"
#include "results/movie.h"
#include "results/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/** A .png file in the folder of pictures beside a result file. To be freed. */
static char *in_pictures(const char *result, const char *name)
{
  char *pictures = text_beside(result, "pictures");
  if (pictures) mkdir(pictures, 0777);
  char *file = pictures ? text_format("%s/%s.png", pictures, name) : NULL;
  free(pictures);
  return file;
}

/** @param[in] replaced  it has taken the place of another file */
static void tell(const breccia_plot *plot, const char *path, bool replaced)
{
  if (replaced && plot->replaces) plot->replaces(plot->context, path);
  if (plot->drawn) plot->drawn(plot->context, path);
}

/** Whether a file stands where a picture goes whose path was not given. */
static bool is_in_place(const breccia_plot *plot, const char *path)
{
  struct stat status;
  return !plot->path && path && !stat(path, &status);
}

void breccia_plot_begin(breccia_plot *plot, size_t size)
{
  if (!plot) return;
  const breccia_plot usual = {.field = "octahedral shear stress",
                              .deformed = 1,
                              .azimuth = NAN,
                              .elevation = NAN,
                              .low = NAN,
                              .high = NAN,
                              .low_corner = {NAN, NAN, NAN},
                              .high_corner = {NAN, NAN, NAN}};
  memset(plot, 0, size);
  plot->size = size;
  sized_give(plot, &usual, sizeof usual);
}

/** What is asked for, if it makes sense. */
static int take_plot(breccia_plot *plot, const breccia_plot *given, Error *error)
{
  const int status = sized_take(plot, sizeof *plot, given, "breccia_plot", error);
  if (status) return status;
  if (plot->low >= plot->high)
    return error_add(error, BRECCIA_USER_ERROR, "range: the lowest value %g is not below the highest, %g", plot->low,
                     plot->high);
  for (int k = 0; k < 3; ++k)
    if (plot->low_corner[k] >= plot->high_corner[k])
      return error_add(error, BRECCIA_USER_ERROR, "inside: along %c the lower end %g is not below the upper one, %g",
                       "xyz"[k], plot -> low_corner[k], plot -> high_corner[k]);
  if (plot->log_axes && strcmp(plot->log_axes, "x") && strcmp(plot->log_axes, "y") && strcmp(plot->log_axes, "xy"))
    return error_add(error, BRECCIA_USER_ERROR, "logarithmic axes: '%s' should be x, y or xy", plot->log_axes);
  return BRECCIA_OK;
}

static int check_ending(const char *path, Error *error)
{
  return !path || picture_format(path)
             ? BRECCIA_OK
             : error_add(error, BRECCIA_USER_ERROR, "'%s' should end in .png, .svg or .pdf", path);
}

int breccia_can_draw(const char *path)
{
  if (!path) return 0;
  return picture_format(path);
}

/** What is drawn of a body: all of it, or the box that is asked for. */
typedef struct Part {
  Box box;
  Shape shape;
  bool whole;
} Part;

static void find_part(const breccia_plot *plot, Part *part)
{
  *part = (Part){.box = {.particles = {-1, -1, -1}}, .whole = true};
  part->shape.box = &part->box;
  for (int k = 0; k < 3; ++k) {
    part->whole &= isnan(plot->low_corner[k]) && isnan(plot->high_corner[k]);
    part->box.from[k] = isnan(plot->low_corner[k]) ? -INFINITY : plot->low_corner[k];
    part->box.to[k] = isnan(plot->high_corner[k]) ? INFINITY : plot->high_corner[k];
  }
}

static PictureOptions field_options(const breccia_plot *plot, const Part *part)
{
  return (PictureOptions){.field = plot->field,
                          .component = plot->component,
                          .bars = plot->bars,
                          .title = plot->title,
                          .x_label = plot->x_label,
                          .y_label = plot->y_label,
                          .deformed = plot->deformed,
                          .azimuth = plot->azimuth,
                          .elevation = plot->elevation,
                          .inside = part->whole ? NULL : &part->shape,
                          .low = plot->low,
                          .high = plot->high,
                          .broken_bonds = plot->broken_bonds != 0,
                          .size = plot->pixels};
}

/** The written state nearest to a time, or -1 after saying that the run did not come there. */
static int nearest_state(const ResultView *view, double time, Error *error)
{
  const int nearest = result_view_nearest(view, time);
  if (nearest < 0)
    error_add(error, BRECCIA_USER_ERROR, "time %g: the run wrote states from the time %g to %g only", time,
              view->times[0], view->times[view->steps - 1]);
  return nearest;
}

/** Which of the written states are asked for. */
static int find_states(const ResultView *view, const breccia_plot *plot, int *first, int *last, Error *error)
{
  *first = *last = view->steps - 1;
  if (plot->state == BRECCIA_STATE_ALL) *first = 0;
  if (plot->state == BRECCIA_STATE_NEAR_TIME && (*first = *last = nearest_state(view, plot->time, error)) < 0)
    return BRECCIA_USER_ERROR;
  if (plot->state != BRECCIA_STATE_OF_STEP) return BRECCIA_OK;
  for (int k = 0; k < view->steps; ++k)
    if (view->step_numbers[k] == plot->step) {
      *first = *last = k;
      return BRECCIA_OK;
    }
  enum { SHORT = 20 };
  Text list = {0};
  for (int k = 0; k < view->steps; ++k) {
    if (k && k < view->steps - 1 && view->steps > SHORT) continue;
    text_add(&list, "%s%lld", !k ? "" : view->steps > SHORT ? " ... " : ", ", (long long)view->step_numbers[k]);
  }
  if (view->steps > SHORT) text_add(&list, " (%d states); --time takes the nearest", view->steps);
  error_add(error, BRECCIA_USER_ERROR, "step %lld was not written; these were: %s", (long long)plot->step,
            text_words(&list));
  text_free(&list);
  return BRECCIA_USER_ERROR;
}

/** Where the picture of a state goes: of several the number stands before the ending. To be freed. */
static char *state_path(const ResultView *view, int k, bool many, const breccia_plot *plot, const char *result)
{
  if (plot->path && !many) return text_format("%s", plot->path);
  if (plot->path) {
    const char *dot = strrchr(plot->path, '.');
    return text_format("%.*s-%06lld%s", (int)(dot - plot->path), plot->path, (long long)view->step_numbers[k], dot);
  }
  char name[256];
  picture_name(view, k, plot->bars ? "bars" : plot->field, plot->bars ? plot->bars : plot->component, true, name,
               sizeof name);
  return in_pictures(result, name);
}

static int draw_states(const ResultView *view, const char *result, const breccia_plot *plot, const PictureOptions *o,
                       Error *error)
{
  PictureSurvey survey;
  int first, last, status = find_states(view, plot, &first, &last, error);
  if (!status && !plot->each_range) status = picture_survey(view, 0, view->steps - 1, false, o, &survey, error);
  for (int k = first; k <= last && !status; ++k) {
    char *path = state_path(view, k, first < last, plot, result);
    const bool replaces = is_in_place(plot, path);
    status = path ? picture_draw(view, k, o, plot->each_range ? NULL : &survey, path, error)
                  : error_add(error, BRECCIA_FAILURE, "out of memory: picture");
    if (!status) tell(plot, path, replaces);
    free(path);
  }
  return status;
}

/** Where a curve over the length of bars goes. To be freed. */
static char *over_length_path(const breccia_plot *plot, const char *result)
{
  char words[128], name[160];
  snprintf(words, sizeof words, "bar %.100s", plot->bars);
  text_file_name(words, name, sizeof name);
  return plot->path ? text_format("%s", plot->path) : in_pictures(result, name);
}

static int draw_over_length(const ResultView *view, const char *result, const breccia_plot *plot, Error *error)
{
  int steps[BAR_CURVE_TIMES] = {0}, count = plot->time_count, first = 0, last = 0;
  int status = count ? BRECCIA_OK : find_states(view, plot, &first, &last, error);
  if (!count) count = last - first + 1;
  for (int k = 0; k < count && k < BAR_CURVE_TIMES && !status; ++k) {
    steps[k] = plot->time_count ? nearest_state(view, plot->times[k], error) : first + k;
    if (steps[k] < 0) status = BRECCIA_USER_ERROR;
  }
  const BarCurveOptions o = {.column = plot->bars,
                             .title = plot->title,
                             .x_label = plot->x_label,
                             .y_label = plot->y_label,
                             .log_axes = plot->log_axes,
                             .names = plot->of_bars,
                             .name_count = plot->of_bar_count,
                             .steps = steps,
                             .count = count,
                             .low = plot->low,
                             .high = plot->high};
  char *path = status ? NULL : over_length_path(plot, result);
  const bool replaces = is_in_place(plot, path);
  if (!status)
    status = path ? bar_curve_draw(view, &o, path, error) : error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  if (!status) tell(plot, path, replaces);
  free(path);
  return status;
}

typedef enum Kind { STATES, MOVIE, OVER_LENGTH } Kind;

/** Draws states of a result, a movie of all, or curves over the length of bars. */
static int draw_results(const char *result, const breccia_plot *plot, Kind kind, Error *error)
{
  ResultView view;
  char *path = result_view_path(result);
  int status = path ? result_view_open(&view, path, error) : BRECCIA_FAILURE;
  if (!status && view.steps == 0) {
    status = error_add(error, BRECCIA_USER_ERROR, "%s: holds no step yet", path);
    result_view_close(&view);
  } else if (!status) {
    Part part;
    find_part(plot, &part);
    const PictureOptions o = field_options(plot, &part);
    status = kind == MOVIE    ? movie_make(&view, &o, plot->each_range != 0, plot->rate, plot->path, error)
             : kind == STATES ? draw_states(&view, path, plot, &o, error)
                              : draw_over_length(&view, path, plot, error);
    if (!status && kind == MOVIE) tell(plot, plot->path, false);
    result_view_close(&view);
  }
  free(path);
  return status;
}

int breccia_plot_field(const char *result, const breccia_plot *given, breccia_error *error)
{
  if (host_lacks(result, __func__, "result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_plot plot;
  int status = take_plot(&plot, given, error);
  if (!status) status = check_ending(plot.path, error);
  if (!status) status = draw_results(result, &plot, STATES, error);
  return host_leave(&host, status, error);
}

int breccia_plot_movie(const char *result, const breccia_plot *given, breccia_error *error)
{
  if (host_lacks(result, __func__, "result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_plot plot;
  int status = take_plot(&plot, given, error);
  if (!status && !plot.path) status = error_add(error, BRECCIA_USER_ERROR, "a movie needs the path of an .mp4 file");
  if (!status) status = draw_results(result, &plot, MOVIE, error);
  return host_leave(&host, status, error);
}

int breccia_plot_over_length(const char *result, const breccia_plot *given, breccia_error *error)
{
  if (host_lacks(result, __func__, "result", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_plot plot;
  int status = take_plot(&plot, given, error);
  if (!status) status = check_ending(plot.path, error);
  if (!status && !plot.bars)
    status =
        error_add(error, BRECCIA_USER_ERROR, "a curve over the length of bars needs a column of theirs, like stress");
  if (!status) status = draw_results(result, &plot, OVER_LENGTH, error);
  return host_leave(&host, status, error);
}

/** Curves of one result lie with its pictures, those of several in the present folder. To be freed. */
static char *curve_path(const char *const *folders, int count, const char *curve, const breccia_plot *plot)
{
  char name[256];
  if (plot->path) return text_format("%s", plot->path);
  curve_name(curve, name, sizeof name);
  char *inside = text_format("%s/any", folders[0]);
  char *path = !inside ? NULL : count == 1 ? in_pictures(inside, name) : text_format("%s.png", name);
  free(inside);
  return path;
}

/** The deck's title; histories may lie without results, then there is none. */
static void find_title(const char *folder, char *title, size_t size)
{
  ResultView view;
  char *path = result_view_path(folder);
  Error *ignored = breccia_error_create();
  if (path && !result_view_open(&view, path, ignored)) {
    snprintf(title, size, "%s", view.title);
    result_view_close(&view);
  }
  breccia_error_destroy(&ignored);
  free(path);
}

int breccia_plot_curve(const char *const *folders, int count, const breccia_plot *given, breccia_error *error)
{
  if (host_lacks_items(folders, count, __func__, "folders", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  breccia_plot plot;
  int status = take_plot(&plot, given, error);
  if (!status) status = check_ending(plot.path, error);
  if (!status && count < 1) status = error_add(error, BRECCIA_USER_ERROR, "a curve needs a folder with histories");
  char *curve = NULL, *path = NULL, title[256] = "";
  if (!status) {
    curve = plot.curve ? text_format("%s", plot.curve) : curve_of_energies(folders[0], error);
    if (!curve) status = BRECCIA_USER_ERROR;
  }
  if (!status && !(path = curve_path(folders, count, curve, &plot)))
    status = error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  if (!status && !plot.title && count == 1) find_title(folders[0], title, sizeof title);
  const CurveOptions o = {.title = plot.title ? plot.title : title,
                          .overlay = plot.overlay,
                          .x_label = plot.x_label,
                          .y_label = plot.y_label,
                          .log_axes = plot.log_axes,
                          .low = plot.low,
                          .high = plot.high};
  const bool replaces = is_in_place(&plot, path);
  if (!status) status = curve_draw(folders, count, curve, &o, path, error);
  if (!status) tell(&plot, path, replaces);
  free(path);
  free(curve);
  return host_leave(&host, status, error);
}

#include "results/picture.h"

#include "base/memory.h"
#include "base/regular_file.h"
#include "deck/quantity.h"
#include "results/bar_columns.h"
#include "results/colours.h"
#include "results/fields.h"
#include "results/scene.h"
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool picture_format(const char *path)
{
  const char *dot = strrchr(path, '.');
  return dot && (!strcmp(dot, ".png") || !strcmp(dot, ".svg") || !strcmp(dot, ".pdf"));
}

/** As many decimals for all times of a file as tell two neighbours apart, of the largest time four digits at least. */
static int time_decimals(const ResultView *view, double factor)
{
  double gap = view->steps ? view->times[view->steps - 1] / 1000 : 1;
  for (int k = 1; k < view->steps; ++k)
    if (view->times[k] > view->times[k - 1]) gap = fmin(gap, view->times[k] - view->times[k - 1]);
  return gap > 0 ? (int)fmin(6, fmax(0, -floor(log10(gap * factor) + 1e-6))) : 0;
}

static void trim_zeros(char *number)
{
  size_t n = strlen(number);
  if (!strchr(number, '.')) return;
  while (number[n - 1] == '0') number[--n] = 0;
  if (number[n - 1] == '.') number[n - 1] = 0;
}

bool picture_of_mode(const ResultView *view, int step)
{
  return step < view->frequency_count;
}

void picture_time(const ResultView *view, int step, bool all_digits, char *words, size_t size)
{
  if (picture_of_mode(view, step)) {
    Text frequency = {0};
    quantity_describe(view->frequencies[step], "Hz", &frequency);
    snprintf(words, size, "mode %lld, %s", (long long)view->step_numbers[step], text_words(&frequency));
    text_free(&frequency);
    return;
  }
  const DisplayUnit unit = display_unit(view->time_unit, view->steps ? view->times[view->steps - 1] : 0);
  char number[64];
  snprintf(number, sizeof number, "%.*f", time_decimals(view, unit.factor), view->times[step] * unit.factor);
  if (!all_digits) trim_zeros(number);
  snprintf(words, size, "%s %s", number, unit.name);
}

void picture_name(const ResultView *view, int step, const char *field, const char *component, bool with_time,
                  char *name, size_t size)
{
  char time[96] = "", words[256];
  if (with_time && picture_of_mode(view, step))
    snprintf(time, sizeof time, "mode %lld", (long long)view->step_numbers[step]);
  else if (with_time) {
    picture_time(view, step, false, time, sizeof time);
    char *space = strchr(time, ' ');
    if (space) memmove(space, space + 1, strlen(space));
    char *micro = strstr(time, "µ");
    if (micro) memmove(micro, "u", 1), memmove(micro + 1, micro + 2, strlen(micro + 1));
  }
  snprintf(words, sizeof words, "%s%s%s%s%s", field, component ? " " : "", component ? component : "",
           with_time ? " " : "", time);
  text_file_name(words, name, size);
}

/* ---- values ---- */

static int component_index(const char *component, int components)
{
  static const char *const vector[] = {"x", "y", "z"}, *const voigt[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  static const char *const full[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  const char *const *names = components == 3 ? vector : components == 6 ? voigt : full;
  for (int k = 0; k < components; ++k)
    if (components > 1 && !strcmp(names[k], component)) return k;
  return -1;
}

/** The number of each particle that colours stand for. */
static int take_field(const ResultView *view, int step, const PictureOptions *o, double *values, char *unit,
                      Error *error)
{
  int components, chosen = 0;
  double *all = result_view_read(view, o->field, step, &components, unit, error);
  if (!all) return result_view_lost(view);
  if (o->component && (chosen = component_index(o->component, components)) < 0) {
    free(all);
    return error_add(error, BRECCIA_USER_ERROR, "field '%s' has %d component%s and none called '%s'", o->field,
                     components, components == 1 ? "" : "s", o->component);
  }
  if (!o->component && components > 3) {
    free(all);
    return error_add(error, BRECCIA_USER_ERROR, "field '%s' has %d components; choose one, like xx", o->field,
                     components);
  }
  for (int64_t n = 0; n < view->particles; ++n) {
    double square = 0;
    for (int k = 0; k < components; ++k) square += all[n * components + k] * all[n * components + k];
    values[n] = components == 1 || o->component ? all[n * components + chosen] : sqrt(square);
  }
  free(all);
  return BRECCIA_OK;
}

static int take_values(Scene *scene, const ResultView *view, int step, const PictureOptions *o, char *unit,
                       Error *error)
{
  return o->bars ? scene_bars_read(scene, view, step, o, unit, error)
                 : take_field(view, step, o, scene->value, unit, error);
}

/** Takes the values that are shown into a range. */
static void survey_values(const Scene *scene, PictureSurvey *s)
{
  if (scene->bars.view.lines) {
    scene_bars_survey(scene, s);
    return;
  }
  for (int64_t n = 0; n < scene->count; ++n)
    if (!scene->hidden[n] && isfinite(scene->value[n])) {
      s->least = fmin(s->least, scene->value[n]);
      s->most = fmax(s->most, scene->value[n]);
    }
}

void scene_colour(const Scene *scene, double value, double rgb[3])
{
  const ColourRange *r = &scene->range;
  if (!isfinite(value))
    rgb[0] = rgb[1] = rgb[2] = 0.62;
  else if (r->diverging)
    colour_diverging(value / fmax(fabs(r->low), fabs(r->high)), rgb);
  else
    colour_sequential((value - r->low) / (r->high - r->low), rgb);
}

/* ---- where particles are seen ---- */

/** Plates are seen from the front, and beams of whatever length from their long side, so that their depth shows. */
static void look(Scene *scene, const ResultView *view, const PictureOptions *o)
{
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int64_t n = 0; n < view->particles; ++n)
    for (int k = 0; k < 3; ++k) {
      low[k] = fmin(low[k], view->positions[3 * n + k]);
      high[k] = fmax(high[k], view->positions[3 * n + k]);
    }
  const double wide[2] = {high[0] - low[0], high[1] - low[1]}, thick = high[2] - low[2] + view->spacing,
               degree = acos(-1) / 180, usual = wide[1] > 2 * wide[0] ? -30 : -60;
  const bool thin = thick < 0.2 * fmax(wide[0], wide[1]) && thick < 0.25 * (fmin(wide[0], wide[1]) + view->spacing);
  scene->flat = view->plane || (thin && isnan(o->azimuth));
  if (scene->flat) {
    const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(scene->right, axes[0], sizeof axes[0]);
    memcpy(scene->up, axes[1], sizeof axes[1]);
    memcpy(scene->eye, axes[2], sizeof axes[2]);
    return;
  }
  double a = (isnan(o->azimuth) ? usual : o->azimuth) * degree, e = (isnan(o->elevation) ? 25 : o->elevation) * degree;
  const double eye[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)}, right[3] = {-sin(a), cos(a), 0};
  for (int k = 0; k < 3; ++k) {
    scene->eye[k] = eye[k];
    scene->right[k] = right[k];
    scene->up[k] = eye[(k + 1) % 3] * right[(k + 2) % 3] - eye[(k + 2) % 3] * right[(k + 1) % 3];
  }
}

/** Particles on the plane of the picture, displaced by `deformed` times `u` (NULL: nowhere). */
static void project(Scene *scene, const ResultView *view, const double *u, double deformed)
{
  scene->x0 = scene->y0 = INFINITY;
  scene->x1 = scene->y1 = -INFINITY;
  for (int64_t n = 0; n < scene->count; ++n) {
    const double half = view->spacings[n] * (scene->flat ? 0.5 : BALL);
    scene->x[n] = scene->y[n] = scene->hidden[n] ? NAN : 0;
    scene->depth[n] = 0;
    if (scene->hidden[n]) continue;
    for (int k = 0; k < 3; ++k) {
      const double p = view->positions[3 * n + k] + (u ? deformed * u[3 * n + k] : 0);
      scene->x[n] += p * scene->right[k];
      scene->y[n] += p * scene->up[k];
      scene->depth[n] += p * scene->eye[k];
    }
    if (!isfinite(scene->x[n]) || !isfinite(scene->y[n])) continue;
    scene->x0 = fmin(scene->x0, scene->x[n] - half);
    scene->x1 = fmax(scene->x1, scene->x[n] + half);
    scene->y0 = fmin(scene->y0, scene->y[n] - half);
    scene->y1 = fmax(scene->y1, scene->y[n] + half);
  }
}

/** Places of the particles at a step. A picture shows no more than the body's size around where it was: of a body that flew apart the
 *  rest would be a dot. */
static int place_particles(Scene *scene, const ResultView *view, int step, const PictureOptions *o, Error *error)
{
  double *u = NULL;
  int components = 3;
  const bool moved = result_view_has(view, "displacement");
  if (!moved && o->deformed != 0 && o->deformed != 1)
    return error_add(error, BRECCIA_USER_ERROR, "a deformed picture needs the field 'displacement' in the result file");
  if (moved && o->deformed != 0 && !(u = result_view_read(view, "displacement", step, &components, NULL, error)))
    return result_view_lost(view);
  project(scene, view, NULL, 0);
  const double room = fmax(scene->x1 - scene->x0, scene->y1 - scene->y0);
  const double x0 = scene->x0 - room, x1 = scene->x1 + room, y0 = scene->y0 - room, y1 = scene->y1 + room;
  if (u) project(scene, view, u, o->deformed);
  free(u);
  const int status = scene_bars_place(scene, view, step, moved ? o->deformed : 0, error);
  if (status) return status;
  scene->x0 = fmax(scene->x0, x0);
  scene->x1 = fmin(scene->x1, x1);
  scene->y0 = fmax(scene->y0, y0);
  scene->y1 = fmin(scene->y1, y1);
  if (scene->x1 > scene->x0 && scene->y1 > scene->y0) return BRECCIA_OK;
  return error_add(error, BRECCIA_FAILURE, "step %lld: no particle has a place in the picture",
                   (long long)view->step_numbers[step]);
}

/* ---- a picture ---- */

/** Particles that stand outside of what is asked for. */
static int hide(Scene *scene, const ResultView *view, const PictureOptions *o, Error *error)
{
  int64_t shown = 0;
  for (int64_t n = 0; n < scene->count; ++n) {
    scene->hidden[n] = o->inside && !shape_contains(o->inside, NULL, view->plane ? 2 : 3, view->positions + 3 * n,
                                                    1e-6 * view->spacings[n]);
    shown += !scene->hidden[n];
  }
  if (shown) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR, "inside: none of the %lld particles stands in this shape",
                   (long long)scene->count);
}

static int scene_create(Scene *scene, const ResultView *view, const PictureOptions *o, Error *error)
{
  *scene = (Scene){.count = view->particles};
  double **arrays[] = {&scene->x, &scene->y, &scene->depth, &scene->value};
  for (int k = 0; k < 4; ++k) {
    *arrays[k] = memory_plain((size_t)(scene->count + 1), sizeof(double));
    if (!*arrays[k]) return error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  }
  if (!(scene->hidden = memory_zeroed((size_t)(scene->count + 1), sizeof(bool), "picture", error)))
    return BRECCIA_FAILURE;
  look(scene, view, o);
  const int status = hide(scene, view, o, error);
  return status ? status : scene_bars_create(scene, view, o, error);
}

static void scene_destroy(Scene *scene)
{
  scene_bars_destroy(scene);
  free(scene->hidden);
  free(scene->x);
  free(scene->y);
  free(scene->depth);
  free(scene->value);
}

int picture_survey(const ResultView *view, int first, int last, bool framing, const PictureOptions *o, PictureSurvey *s,
                   Error *error)
{
  *s = (PictureSurvey){INFINITY, -INFINITY, NAN, NAN, NAN, NAN};
  Scene scene;
  char unit[64];
  int status = scene_create(&scene, view, o, error);
  for (int k = first; k <= last && !status; ++k) {
    status = take_values(&scene, view, k, o, unit, error);
    if (!status) survey_values(&scene, s);
    if (status || !framing) continue;
    status = place_particles(&scene, view, k, o, error);
    s->x0 = fmin(s->x0, scene.x0); /* the first time the other is no number, which fmin passes over */
    s->x1 = fmax(s->x1, scene.x1);
    s->y0 = fmin(s->y0, scene.y0);
    s->y1 = fmax(s->y1, scene.y1);
  }
  scene_destroy(&scene);
  return status;
}

static int scene_fill(Scene *scene, const ResultView *view, int step, const PictureOptions *o, const PictureSurvey *s,
                      Error *error)
{
  char unit[64] = "", words[128];
  int status = take_values(scene, view, step, o, unit, error);
  if (!status) status = place_particles(scene, view, step, o, error);
  if (status) return status;
  if (!isnan(s->x0)) {
    scene->x0 = s->x0;
    scene->x1 = s->x1;
    scene->y0 = s->y0;
    scene->y1 = s->y1;
  }
  for (int64_t n = 0; n < scene->count; ++n) {
    if (scene->hidden[n]) continue;
    scene->missing += !o->bars && !isfinite(scene->value[n]);
    scene->outside +=
        !(scene->x[n] >= scene->x0 && scene->x[n] <= scene->x1 && scene->y[n] >= scene->y0 && scene->y[n] <= scene->y1);
  }
  const OutputField *field = o->bars ? NULL : output_field_find(o->field);
  const BarColumn *column = o->bars ? bar_column_find(o->bars) : NULL;
  const bool has_sign = column ? column->has_sign : o->component || (field && field->has_sign);
  scene->range = scale_colours(s->least, s->most, has_sign, o->low, o->high);
  scene->unit = display_unit(unit, fmax(fabs(scene->range.low), fabs(scene->range.high)));
  scene->length = display_unit(view->length_unit, fmax(scene->x1 - scene->x0, scene->y1 - scene->y0));
  if (o->bars)
    snprintf(words, sizeof words, "%s of bars", o->bars);
  else
    snprintf(words, sizeof words, "%s%s%s", o->field, o->component ? " " : "", o->component ? o->component : "");
  display_heading(words, scene->unit.name, scene->heading, sizeof scene->heading);
  return BRECCIA_OK;
}

static int paint(cairo_surface_t *surface, const Page *page, const Scene *scene, const ResultView *view, int step,
                 const PictureOptions *o)
{
  cairo_t *cr = cairo_create(surface);
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  int bad = body_draw(cr, page, scene, view, step, o);
  page_draw(cr, page, scene, o);
  cairo_destroy(cr);
  return bad;
}

/** @param[in] ending  of the picture's name, which tells what it is; "": an image in memory */
static cairo_surface_t *open_surface(const char *path, const char *ending, const Page *page)
{
  if (!strcmp(ending, ".svg")) return cairo_svg_surface_create(path, page->width, page->height);
  if (!strcmp(ending, ".pdf")) return cairo_pdf_surface_create(path, page->width, page->height);
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)page->width, (int)page->height);
}

/** One step on a surface that belongs to the file `path`, or on an image in memory (NULL, ""). */
static int render(cairo_surface_t **surface, const ResultView *view, int step, const PictureOptions *o,
                  const PictureSurvey *given, const char *path, const char *ending, Error *error)
{
  Scene scene;
  PictureSurvey own;
  int status = scene_create(&scene, view, o, error);
  if (!status && !given) status = picture_survey(view, step, step, false, o, &own, error);
  if (!status) status = scene_fill(&scene, view, step, o, given ? given : &own, error);
  if (!status) {
    const Page page = page_lay_out(&scene, view, step, o);
    *surface = open_surface(path, ending, &page);
    if (paint(*surface, &page, &scene, view, step, o)) {
      status = error_add(error, BRECCIA_FAILURE, "out of memory: picture");
      cairo_surface_destroy(*surface);
    }
  }
  scene_destroy(&scene);
  return status;
}

int picture_draw(const ResultView *view, int step, const PictureOptions *o, const PictureSurvey *survey,
                 const char *path, Error *error)
{
  if (!picture_format(path))
    return error_add(error, BRECCIA_USER_ERROR, "%s: pictures end in .png, .svg or .pdf", path);
  char *part = text_format("%s.part", path);
  if (!part) return error_add(error, BRECCIA_FAILURE, "out of memory: %s", path);
  const char *ending = strrchr(path, '.');
  cairo_surface_t *surface;
  const int cause = regular_file_make(part);
  int status = cause ? error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, regular_file_problem(cause))
                     : render(&surface, view, step, o, survey, part, ending, error);
  if (!status) {
    errno = 0;
    cairo_status_t end = cairo_surface_status(surface);
    if (!end && !strcmp(ending, ".png")) end = cairo_surface_write_to_png(surface, part);
    cairo_surface_finish(surface);
    if (!end) end = cairo_surface_status(surface);
    if (end && !(end == CAIRO_STATUS_WRITE_ERROR && errno))
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be drawn: %s", path, cairo_status_to_string(end));
    else if (end || rename(part, path))
      status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    cairo_surface_destroy(surface);
  }
  if (status) remove(part);
  free(part);
  return status;
}

unsigned char *picture_pixels(const ResultView *view, int step, const PictureOptions *o, const PictureSurvey *survey,
                              int *wide, int *high, Error *error)
{
  cairo_surface_t *surface;
  if (render(&surface, view, step, o, survey, NULL, "", error)) return NULL;
  cairo_surface_flush(surface);
  *wide = cairo_image_surface_get_width(surface);
  *high = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  unsigned char *rows = cairo_surface_status(surface) ? NULL : memory_plain((size_t)*wide * (size_t)*high * 4, 1);
  for (int y = 0; rows && y < *high; ++y)
    memcpy(rows + (size_t)y * (size_t)*wide * 4, cairo_image_surface_get_data(surface) + (size_t)y * (size_t)stride,
           (size_t)*wide * 4);
  cairo_surface_destroy(surface);
  if (!rows) error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  return rows;
}

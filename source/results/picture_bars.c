/* Reinforcing bars in a picture: lines over the body, which is pale then. */
#include "base/memory.h"
#include "results/scene.h"

#include <math.h>
#include <stdlib.h>

static bool is_shown(const Scene *scene, int64_t element)
{
  return !scene->bars.hidden[element];
}

/** Elements whose middle stands outside of what is asked for. */
static int hide(SceneBars *bars, const ResultView *view, const PictureOptions *o, Error *error)
{
  const BarView *b = &bars->view;
  int64_t shown = 0;
  for (int n = 0; n < b->lines; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      const double *p = b->points + 3 * (e + n), middle[3] = {(p[0] + p[3]) / 2, (p[1] + p[4]) / 2, (p[2] + p[5]) / 2};
      bars->hidden[e] =
          o->inside && !shape_contains(o->inside, NULL, view->plane ? 2 : 3, middle, 1e-6 * view->spacing);
      shown += !bars->hidden[e];
    }
  if (shown) return BRECCIA_OK;
  return error_add(error, BRECCIA_USER_ERROR, "inside: no bar stands in this shape");
}

int scene_bars_create(Scene *scene, const ResultView *view, const PictureOptions *o, Error *error)
{
  SceneBars *bars = &scene->bars;
  if (!o->bars) return BRECCIA_OK;
  int status = bar_view_open(&bars->view, view, error);
  if (status) return status;
  const size_t nodes = (size_t)bars->view.nodes + 1;
  bars->near = view->spacing;
  bars->x = memory_plain(nodes, sizeof(double));
  bars->y = memory_plain(nodes, sizeof(double));
  bars->depth = memory_plain(nodes, sizeof(double));
  bars->hidden = memory_plain(nodes, sizeof(bool));
  if (!bars->x || !bars->y || !bars->depth || !bars->hidden)
    return error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  return hide(bars, view, o, error);
}

void scene_bars_destroy(Scene *scene)
{
  SceneBars *bars = &scene->bars;
  bar_view_close(&bars->view);
  free(bars->x);
  free(bars->y);
  free(bars->depth);
  free(bars->hidden);
  free(bars->value);
}

int scene_bars_read(Scene *scene, const ResultView *view, int step, const PictureOptions *o, char *unit, Error *error)
{
  free(scene->bars.value);
  scene->bars.value = bar_view_read(&scene->bars.view, view, o->bars, step, unit, error);
  return scene->bars.value ? BRECCIA_OK : result_view_lost(view);
}

void scene_bars_survey(const Scene *scene, PictureSurvey *survey)
{
  for (int64_t e = 0; e < scene->bars.view.elements; ++e)
    if (is_shown(scene, e) && isfinite(scene->bars.value[e])) {
      survey->least = fmin(survey->least, scene->bars.value[e]);
      survey->most = fmax(survey->most, scene->bars.value[e]);
    }
}

int scene_bars_place(Scene *scene, const ResultView *view, int step, double deformed, Error *error)
{
  SceneBars *bars = &scene->bars;
  const BarView *b = &bars->view;
  double *u = NULL;
  if (!b->lines) return BRECCIA_OK;
  if (deformed != 0 && !(u = bar_view_displacements(b, view, step, error))) return result_view_lost(view);
  for (int64_t k = 0; k < b->nodes; ++k) {
    bars->x[k] = bars->y[k] = bars->depth[k] = 0;
    for (int c = 0; c < 3; ++c) {
      const double p = b->points[3 * k + c] + (u ? deformed * u[3 * k + c] : 0);
      bars->x[k] += p * scene->right[c];
      bars->y[k] += p * scene->up[c];
      bars->depth[k] += p * scene->eye[c];
    }
  }
  free(u);
  const double half = 0.25 * view->spacing;
  for (int n = 0; n < b->lines; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e)
      for (int64_t k = e + n; k <= e + n + 1; ++k) {
        if (!is_shown(scene, e) || !isfinite(bars->x[k]) || !isfinite(bars->y[k])) continue;
        scene->x0 = fmin(scene->x0, bars->x[k] - half);
        scene->x1 = fmax(scene->x1, bars->x[k] + half);
        scene->y0 = fmin(scene->y0, bars->y[k] - half);
        scene->y1 = fmax(scene->y1, bars->y[k] + half);
      }
  return BRECCIA_OK;
}

/* ---- drawing ---- */

typedef struct Line {
  double depth;
  int64_t element, node;
} Line;

static int by_depth(const void *a, const void *b)
{
  const Line *p = a, *q = b;
  return p->depth != q->depth ? (p->depth < q->depth ? -1 : 1) : (p->element < q->element ? -1 : 1);
}

static void draw_line(cairo_t *cr, const Page *page, const Scene *scene, int64_t node, double width)
{
  for (int end = 0; end < 2; ++end) {
    const double x = page->left + (scene->bars.x[node + end] - scene->x0) * page->scale;
    const double y = page->thick > 0 ? page->top + page->thick / 2
                                     : page->top + page->high - (scene->bars.y[node + end] - scene->y0) * page->scale;
    if (end)
      cairo_line_to(cr, x, y);
    else
      cairo_move_to(cr, x, y);
  }
  cairo_set_line_width(cr, width);
  cairo_stroke(cr);
}

int scene_bars_draw(cairo_t *cr, const Page *page, const Scene *scene)
{
  const SceneBars *bars = &scene->bars;
  const BarView *b = &bars->view;
  const double width = 3, edge = 0.8; /* dark edges: colours of small numbers are as pale as the body */
  Line *lines = memory_plain((size_t)b->elements + 1, sizeof *lines);
  int64_t count = 0;
  if (!lines) return 1;
  for (int n = 0; n < b->lines; ++n)
    for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
      const int64_t k = e + n;
      if (!is_shown(scene, e) || !isfinite(bars->x[k] + bars->y[k] + bars->x[k + 1] + bars->y[k + 1])) continue;
      lines[count++] = (Line){(bars->depth[k] + bars->depth[k + 1]) / 2, e, k};
    }
  qsort(lines, (size_t)count, sizeof *lines, by_depth);
  cairo_save(cr);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  for (int64_t from = 0, to; from < count; from = to) { /* edges of what lies equally deep do not cross its colours */
    for (to = from; to < count && (scene->flat || lines[to].depth - lines[from].depth < scene->bars.near); ++to) {
      cairo_set_source_rgb(cr, 0.25, 0.25, 0.25);
      draw_line(cr, page, scene, lines[to].node, width + 2 * edge);
    }
    for (int64_t k = from; k < to; ++k) {
      double rgb[3];
      scene_colour(scene, bars->value[lines[k].element], rgb);
      cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
      draw_line(cr, page, scene, lines[k].node, width);
    }
  }
  cairo_restore(cr);
  free(lines);
  return 0;
}

/* The body of a picture. */
#include "base/memory.h"
#include "results/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void colour_particle(const Scene *s, int64_t n, double rgb[3])
{
  if (s->bars.view.lines) {
    rgb[0] = rgb[1] = 0.88;
    rgb[2] = 0.9;
  } else
    scene_colour(s, s->value[n], rgb);
}

static bool scene_shows(const Scene *s, int64_t n)
{
  return s->x[n] >= s->x0 && s->x[n] <= s->x1 && s->y[n] >= s->y0 && s->y[n] <= s->y1;
}

typedef struct Depth {
  double depth;
  int64_t particle;
} Depth;

static int by_depth(const void *a, const void *b)
{
  const Depth *x = a, *y = b;
  return x->depth != y->depth ? (x->depth < y->depth ? -1 : 1) : (x->particle < y->particle ? -1 : 1);
}

/* ---- flat bodies ---- */

typedef struct
    Order { /* where a particle stands on its lattice, in thousandths of a spacing: rows along `axis` together */
  long long plane, row, along;
  int64_t particle;
} Order;

static int by_row(const void *a, const void *b)
{
  const Order *p = a, *q = b;
  if (p->plane != q->plane) return p->plane < q->plane ? -1 : 1;
  if (p->row != q->row) return p->row < q->row ? -1 : 1;
  return p->along != q->along ? (p->along < q->along ? -1 : 1) : (p->particle < q->particle ? -1 : 1);
}

static void shorter(const Scene *scene, int64_t from, int64_t to, double vector[2])
{
  const double x = scene->x[to] - scene->x[from], y = scene->y[to] - scene->y[from];
  if (isfinite(x) && isfinite(y) && hypot(x, y) < hypot(vector[0], vector[1])) {
    vector[0] = x;
    vector[1] = y;
  }
}

/** Of each particle the way to its neighbour along x (axis 0) or y, as the body is drawn, over its length in spacings: the shorter of the
 *  two, because what tears grows longer; as in the reference shape where there is none or where both are torn. */
static int neighbour_vectors(const Scene *scene, const ResultView *view, int axis, double (*vectors)[2])
{
  Order *order = memory_plain((size_t)(scene->count + 1), sizeof(Order));
  if (!order) return 1;
  for (int64_t n = 0; n < scene->count; ++n) {
    const double *p = view->positions + 3 * n, unit = 1e-3 * view->spacings[n];
    order[n] = (Order){llround(p[2] / unit), llround(p[1 - axis] / unit), llround(p[axis] / unit), n};
    vectors[n][0] = vectors[n][1] = INFINITY;
  }
  qsort(order, (size_t)scene->count, sizeof *order, by_row);
  for (int64_t k = 1; k < scene->count; ++k) {
    const Order *p = &order[k - 1], *q = &order[k];
    const double period = lattice_period(result_view_lattice(view, p->particle), axis);
    if (p->plane != q->plane || llabs(p->row - q->row) > 1 || llabs(q->along - p->along - llround(1000 * period)) > 2)
      continue;
    shorter(scene, p->particle, q->particle, vectors[p->particle]);
    double back[2] = {-vectors[q->particle][0], -vectors[q->particle][1]};
    shorter(scene, p->particle, q->particle, back);
    vectors[q->particle][0] = back[0];
    vectors[q->particle][1] = back[1];
  }
  free(order);
  for (int64_t n = 0; n < scene->count; ++n)
    for (int k = 0; k < 2; ++k) vectors[n][k] /= lattice_period(result_view_lattice(view, n), axis);
  double mean = 0;
  int64_t found = 0;
  for (int64_t n = 0; n < scene->count; ++n)
    if (isfinite(vectors[n][0])) {
      mean += hypot(vectors[n][0], vectors[n][1]) / view->spacings[n];
      ++found;
    }
  mean = found ? fmax(1, mean / (double)found) : 1;
  for (int64_t n = 0; n < scene->count; ++n) {
    const double spacing = view->spacings[n];
    if (hypot(vectors[n][0], vectors[n][1]) <= 2.5 * mean * spacing) continue;
    vectors[n][axis] = spacing;
    vectors[n][1 - axis] = 0;
  }
  return 0;
}

/** The part of the plane that belongs to a particle, turned and stretched with its neighbours. */
static void draw_cell(cairo_t *cr, const Page *page, double x, double y, const double a[2], const double b[2],
                      const LatticeType *lattice)
{
  double corners[6][2];
  const int count = lattice_cell_corners(lattice, corners);
  const double size = 1.08 * page->scale; /* a little more than its own part, or seams show */
  for (int c = 0; c < count; ++c) {
    const double dx = size * (corners[c][0] * a[0] + corners[c][1] * b[0]);
    const double dy = size * (corners[c][0] * a[1] + corners[c][1] * b[1]);
    if (c)
      cairo_line_to(cr, x + dx, y - dy);
    else
      cairo_move_to(cr, x + dx, y - dy);
  }
  cairo_close_path(cr);
  cairo_fill(cr);
}

/** A square with its edges on pixels, or seams show. */
static void draw_square(cairo_t *cr, const Page *page, double x, double y, double side)
{
  double x0 = x - side / 2, y0 = y - side / 2, x1 = floor(x0 + side + 0.5), y1 = floor(y0 + side + 0.5);
  x0 = floor(x0 + 0.5);
  y0 = floor(y0 + 0.5);
  if (page->thick > 0) { /* a line of particles */
    y0 = page->top;
    y1 = page->top + page->thick;
  }
  cairo_rectangle(cr, x0, y0, x1 - x0, y1 - y0);
  cairo_fill(cr);
}

/** The nearest last: plane bodies, and plates seen from the front. */
static int draw_flat(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, bool deformed)
{
  Depth *order = memory_plain((size_t)(scene->count + 1), sizeof(Depth));
  double(*a)[2] = memory_plain((size_t)(scene->count + 1), sizeof *a),
  (*b)[2] = memory_plain((size_t)(scene->count + 1), sizeof *b);
  int bad = !order || !a || !b;
  const bool cells = deformed && page->thick == 0;
  if (!bad && cells) bad = neighbour_vectors(scene, view, 0, a) || neighbour_vectors(scene, view, 1, b);
  for (int64_t n = 0; n < scene->count && !bad; ++n) order[n] = (Depth){scene->depth[n], n};
  for (int64_t n = 0; n < scene->count && !bad && cells; ++n) { /* a loose particle has no shape */
    const double along = hypot(a[n][0], a[n][1]), across = hypot(b[n][0], b[n][1]);
    const double area = fabs(a[n][0] * b[n][1] - a[n][1] * b[n][0]);
    if (along < 3 * across && across < 3 * along && area > 0.3 * along * across) continue;
    a[n][0] = b[n][1] = view->spacings[n];
    a[n][1] = b[n][0] = 0;
  }
  if (!bad) qsort(order, (size_t)scene->count, sizeof(Depth), by_depth);
  cairo_save(cr);
  cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE);
  for (int64_t k = 0; k < scene->count && !bad; ++k) {
    const int64_t n = order[k].particle;
    if (!scene_shows(scene, n)) continue;
    double rgb[3];
    colour_particle(scene, n, rgb);
    cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
    const double x = page->left + (scene->x[n] - scene->x0) * page->scale;
    const double y = page->top + page->high - (scene->y[n] - scene->y0) * page->scale;
    const double along[2] = {view->spacings[n], 0}, up[2] = {0, view->spacings[n]};
    if (cells)
      draw_cell(cr, page, x, y, a[n], b[n], result_view_lattice(view, n));
    else if (page->thick == 0 && result_view_lattice(view, n)->vector[1][0] != 0) /* no square */
      draw_cell(cr, page, x, y, along, up, result_view_lattice(view, n));
    else
      draw_square(cr, page, x, y, view->spacings[n] * page->scale);
  }
  cairo_restore(cr);
  free(order);
  free(a);
  free(b);
  return bad;
}

/* ---- bodies in space ---- */

/** Spheres into an image of twice the resolution, the nearest one in each pixel. */
static int draw_spheres(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view)
{
  const int fine = 2;
  int wide = (int)ceil(page->wide) * fine + 1, high = (int)ceil(page->high) * fine + 1;
  cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, wide, high);
  double *depth = memory_plain((size_t)wide * (size_t)high, sizeof(double));
  if (!depth || cairo_surface_status(image)) {
    free(depth);
    cairo_surface_destroy(image);
    return 1;
  }
  for (int k = 0; k < wide * high; ++k) depth[k] = -INFINITY;
  unsigned char *pixels = cairo_image_surface_get_data(image);
  int stride = cairo_image_surface_get_stride(image);
  double scale = page->scale * fine;
  for (int64_t n = 0; n < scene->count; ++n) {
    double radius = BALL * view->spacings[n] * scale, rgb[3];
    const double shades = radius > 30 ? 64 : 8; /* pictures with many shades of small spheres are large files */
    double cx = (scene->x[n] - scene->x0) * scale, cy = (scene->y1 - scene->y[n]) * scale;
    if (!scene_shows(scene, n)) continue;
    colour_particle(scene, n, rgb);
    int x0 = (int)fmax(0, floor(cx - radius)), x1 = (int)fmin(wide - 1, ceil(cx + radius));
    int y0 = (int)fmax(0, floor(cy - radius)), y1 = (int)fmin(high - 1, ceil(cy + radius));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        double dx = (x + 0.5 - cx) / radius, dy = (y + 0.5 - cy) / radius, square = dx * dx + dy * dy;
        if (square > 1) continue;
        double dz = sqrt(1 - square), at = scene->depth[n] * scale + radius * dz;
        if (at <= depth[y * wide + x]) continue;
        depth[y * wide + x] = at;
        const double light = 0.62 + 0.38 / shades * floor(shades * fmax(0, -0.35 * dx - 0.45 * dy + 0.82 * dz) + 0.5);
        uint32_t pixel = 0xff000000u;
        for (int c = 0; c < 3; ++c) pixel |= (uint32_t)(255 * fmin(1, rgb[c] * light) + 0.5) << (16 - 8 * c);
        memcpy(pixels + (size_t)y * (size_t)stride + 4 * (size_t)x, &pixel, sizeof pixel);
      }
  }
  cairo_surface_mark_dirty(image);
  cairo_save(cr);
  cairo_translate(cr, page->left, page->top);
  cairo_scale(cr, 1.0 / fine, 1.0 / fine);
  cairo_set_source_surface(cr, image, 0, 0);
  cairo_paint(cr);
  cairo_restore(cr);
  cairo_surface_destroy(image);
  free(depth);
  return 0;
}

/** Bonds that broke, but not those that a crack has opened wide since: their lines would hide it. */
static void draw_broken(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, int step)
{
  int64_t count = 0, *pairs = result_view_broken(view, step, &count);
  cairo_set_source_rgba(cr, 0.85, 0.1, 0.1, 0.55);
  cairo_set_line_width(cr, 0.6);
  for (int64_t k = 0; pairs && k < count; ++k) {
    const int64_t a = pairs[2 * k], b = pairs[2 * k + 1];
    if (a < 0 || a >= scene->count || b < 0 || b >= scene->count) continue;
    if (!scene_shows(scene, a) || !scene_shows(scene, b)) continue;
    double length = 0;
    for (int c = 0; c < 3; ++c) length += pow(view->positions[3 * a + c] - view->positions[3 * b + c], 2);
    if (hypot(scene->x[a] - scene->x[b], scene->y[a] - scene->y[b]) > 2 * sqrt(length)) continue;
    cairo_move_to(cr, page->left + (scene->x[a] - scene->x0) * page->scale,
                  page->top + page->high - (scene->y[a] - scene->y0) * page->scale);
    cairo_line_to(cr, page->left + (scene->x[b] - scene->x0) * page->scale,
                  page->top + page->high - (scene->y[b] - scene->y0) * page->scale);
    cairo_stroke(cr);
  }
  free(pairs);
}

int body_draw(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, int step,
              const PictureOptions *o)
{
  cairo_save(cr);
  cairo_rectangle(cr, page->left - 6, page->top - 6, page->wide + 12, page->high + 12);
  cairo_clip(cr);
  int bad = scene->flat ? draw_flat(cr, page, scene, view, o->deformed != 0) : draw_spheres(cr, page, scene, view);
  if (o->broken_bonds) draw_broken(cr, page, scene, view, step);
  if (scene->bars.view.lines && scene_bars_draw(cr, page, scene)) bad = 1;
  cairo_restore(cr);
  return bad;
}

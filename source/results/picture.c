#include "results/picture.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Field picture_fields[] = {
    {"field", FIELD_TEXT, offsetof(PictureSpec, field), NULL, "", NULL, "field of the particles to colour by", NULL,
     NULL, 'A'},
    {"curve", FIELD_TEXT, offsetof(PictureSpec, curve), NULL, "", NULL,
     "two columns of histories, 'watch.column : watch.column' for the horizontal and the vertical axis", NULL, NULL,
     'A'},
    {"component", FIELD_TEXT, offsetof(PictureSpec, component), NULL, "", NULL,
     "of a vector or tensor, like x or xy; when absent the length of a vector", NULL, NULL, 0},
    {"at", FIELD_NUMBERS, offsetof(PictureSpec, times), "time", "", "[0, inf)", "times to draw; the end when absent",
     NULL, NULL, 0},
    {"deformed", FIELD_NUMBER, offsetof(PictureSpec, deformed), "1", "1", NULL, "scale of the displacements drawn",
     NULL, NULL, 0},
    {"view", FIELD_POINT, offsetof(PictureSpec, view), "angle", "", NULL,
     "[azimuth, elevation] of the eye; from the front for flat bodies and aslant for others when absent", NULL, NULL,
     0},
    {"range", FIELD_POINT, offsetof(PictureSpec, range), "1", "", NULL,
     "[lowest, highest] value of the colour scale, or of the horizontal axis of a curve, in the deck's units", NULL,
     NULL, 0},
    {"broken bonds", FIELD_FLAG, offsetof(PictureSpec, broken_bonds), NULL, "no", NULL, "draw bonds that have broken",
     NULL, NULL, 0},
};
const Section picture_section = {"picture",
                                 "A picture made at the end of a run, in the folder 'pictures'.",
                                 sizeof(PictureSpec),
                                 FIELDS(picture_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};

bool picture_format(const char *path)
{
  const char *dot = strrchr(path, '.');
  return dot && (!strcmp(dot, ".png") || !strcmp(dot, ".svg") || !strcmp(dot, ".pdf"));
}

/* A sequential scale from dark blue over green to yellow: rises evenly in lightness, so that it survives a grey printer. */
static void colour(double t, double rgb[3])
{
  static const double stops[][3] = {{.190, .072, .330}, {.230, .250, .530}, {.170, .410, .560}, {.130, .560, .550},
                                    {.210, .700, .470}, {.550, .820, .270}, {.960, .900, .150}};
  enum { LAST = sizeof stops / sizeof *stops - 1 };
  t = t < 0 || isnan(t) ? 0 : t > 1 ? 1 : t;
  int k = (int)(t * LAST);
  if (k == LAST) --k;
  double share = t * LAST - k;
  for (int c = 0; c < 3; ++c) rgb[c] = stops[k][c] + share * (stops[k + 1][c] - stops[k][c]);
}

#define BALL 0.62 /* radius of a sphere in spacings: they overlap a little, without gaps along rows */

typedef struct Scene {
  int64_t count;
  double *x, *y, *depth; /* on the picture plane, and towards the eye */
  double *value;
  double low, high; /* of the colours */
  double right[3], up[3], eye[3];
  bool flat;             /* seen along z: the axes of the picture are x and y */
  double x0, x1, y0, y1; /* extent with half a spacing around */
} Scene;

static int component_index(const char *component, int components)
{
  static const char *const vector[] = {"x", "y", "z"}, *const voigt[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  static const char *const full[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  const char *const *names = components == 3 ? vector : components == 6 ? voigt : full;
  for (int k = 0; k < components; ++k)
    if (components > 1 && !strcmp(names[k], component)) return k;
  return -1;
}

static int take_values(Scene *scene, const ResultView *view, int step, const PictureOptions *o, char *label,
                       size_t size, Error *error)
{
  int components, chosen = 0;
  char unit[64] = "";
  double *all = result_view_read(view, o->field, step, &components, unit, error);
  if (!all) return BRECCIA_USER_ERROR;
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
  scene->low = INFINITY;
  scene->high = -INFINITY;
  for (int64_t n = 0; n < scene->count; ++n) {
    double square = 0;
    for (int k = 0; k < components; ++k) square += all[n * components + k] * all[n * components + k];
    double v = components == 1 || o->component ? all[n * components + chosen] : sqrt(square);
    scene->value[n] = v;
    if (!isfinite(v)) continue;
    scene->low = fmin(scene->low, v);
    scene->high = fmax(scene->high, v);
  }
  free(all);
  if (!isnan(o->low)) scene->low = o->low;
  if (!isnan(o->high)) scene->high = o->high;
  if (!(scene->high > scene->low)) scene->high = scene->low + fmax(1e-12, fabs(scene->low) * 1e-6);
  snprintf(label, size, "%s%s%s%s%s%s", o->field, o->component ? " " : "", o->component ? o->component : "",
           *unit ? " (" : "", unit, *unit ? ")" : "");
  return BRECCIA_OK;
}

static void look(Scene *scene, const ResultView *view, const PictureOptions *o)
{
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int64_t n = 0; n < view->particles; ++n)
    for (int k = 0; k < 3; ++k) {
      low[k] = fmin(low[k], view->positions[3 * n + k]);
      high[k] = fmax(high[k], view->positions[3 * n + k]);
    }
  double wide = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
  const double degree = acos(-1) / 180;
  bool thin = high[2] - low[2] + view->spacing < 0.2 * wide;
  scene->flat = view->plane || (thin && isnan(o->azimuth));
  if (scene->flat) {
    const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(scene->right, axes[0], sizeof axes[0]);
    memcpy(scene->up, axes[1], sizeof axes[1]);
    memcpy(scene->eye, axes[2], sizeof axes[2]);
    return;
  }
  double a = (isnan(o->azimuth) ? -60 : o->azimuth) * degree, e = (isnan(o->elevation) ? 25 : o->elevation) * degree;
  const double eye[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)}, right[3] = {-sin(a), cos(a), 0};
  for (int k = 0; k < 3; ++k) {
    scene->eye[k] = eye[k];
    scene->right[k] = right[k];
    scene->up[k] = eye[(k + 1) % 3] * right[(k + 2) % 3] - eye[(k + 2) % 3] * right[(k + 1) % 3];
  }
}

static int project(Scene *scene, const ResultView *view, int step, const PictureOptions *o, Error *error)
{
  double *u = NULL;
  int components = 3;
  if (o->deformed != 0) {
    Error *ignored = breccia_error_create();
    u = result_view_read(view, "displacement", step, &components, NULL, ignored);
    breccia_error_destroy(&ignored);
    if (!u && o->deformed != 1)
      return error_add(error, BRECCIA_USER_ERROR,
                       "a deformed picture needs the field 'displacement' in the result file");
  }
  scene->x0 = scene->y0 = INFINITY;
  scene->x1 = scene->y1 = -INFINITY;
  for (int64_t n = 0; n < scene->count; ++n) {
    double p[3], half = view->spacings[n] * (scene->flat ? 0.5 : BALL);
    scene->x[n] = scene->y[n] = scene->depth[n] = 0;
    for (int k = 0; k < 3; ++k) {
      p[k] = view->positions[3 * n + k] + (u ? o->deformed * u[3 * n + k] : 0);
      scene->x[n] += p[k] * scene->right[k];
      scene->y[n] += p[k] * scene->up[k];
      scene->depth[n] += p[k] * scene->eye[k];
    }
    if (!isfinite(scene->x[n]) || !isfinite(scene->y[n])) continue;
    scene->x0 = fmin(scene->x0, scene->x[n] - half);
    scene->x1 = fmax(scene->x1, scene->x[n] + half);
    scene->y0 = fmin(scene->y0, scene->y[n] - half);
    scene->y1 = fmax(scene->y1, scene->y[n] + half);
  }
  free(u);
  return BRECCIA_OK;
}

/* ---- the page ---- */

typedef struct Page {
  double width, height;         /* of the page in points */
  double left, top, wide, high; /* of the drawing */
  double scale;                 /* points per length */
} Page;

static Page lay_out(const Scene *scene, double size)
{
  const double most_wide = size > 0 ? size : 640, most_high = most_wide * 7 / 8;
  Page page = {.left = 72, .top = 64};
  double w = scene->x1 - scene->x0, h = scene->y1 - scene->y0;
  page.scale = fmin(most_wide / w, most_high / h);
  page.wide = w * page.scale;
  page.high = h * page.scale;
  page.width = fmax(page.left + page.wide + 150, 480);
  page.height = fmax(page.top + page.high, 220) + 56;
  return page;
}

static void put_text(cairo_t *cr, double x, double y, double align, double size, const char *words)
{
  cairo_text_extents_t extent;
  cairo_set_font_size(cr, size);
  cairo_text_extents(cr, words, &extent);
  cairo_move_to(cr, x - align * extent.x_advance, y);
  cairo_show_text(cr, words);
}

/** Distance of ticks: 1, 2 or 5 times a power of ten, some five of them. */
static double tick_distance(double range)
{
  double power = pow(10, floor(log10(range / 5))), part = range / 5 / power;
  return power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
}

static void tick_words(double value, double distance, char *words, size_t size)
{
  if (fabs(value) < 1e-9 * distance) value = 0;
  snprintf(words, size, "%.6g", value);
}

static void draw_axes(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view)
{
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 0.8);
  for (int axis = 0; axis < 2; ++axis) {
    double low = axis ? scene->y0 : scene->x0, high = axis ? scene->y1 : scene->x1;
    double apart = axis ? 18 : 50; /* pixels that the words of a tick need */
    double step = tick_distance(fmax(high - low, 5 * apart / page->scale));
    for (double v = ceil(low / step) * step; v <= high; v += step) {
      char words[32];
      tick_words(v, step, words, sizeof words);
      if (axis) {
        double y = page->top + page->high - (v - low) * page->scale;
        cairo_move_to(cr, page->left - 10, y);
        cairo_line_to(cr, page->left - 6, y);
        cairo_stroke(cr);
        put_text(cr, page->left - 14, y + 4, 1, 12, words);
      } else {
        double x = page->left + (v - low) * page->scale;
        cairo_move_to(cr, x, page->top + page->high + 6);
        cairo_line_to(cr, x, page->top + page->high + 10);
        cairo_stroke(cr);
        put_text(cr, x, page->top + page->high + 24, 0.5, 12, words);
      }
    }
  }
  cairo_rectangle(cr, page->left - 6, page->top - 6, page->wide + 12, page->high + 12);
  cairo_stroke(cr);
  char words[96];
  snprintf(words, sizeof words, "x (%s)", view->length_unit);
  put_text(cr, page->left + page->wide / 2, page->top + page->high + 42, 0.5, 13, words);
  snprintf(words, sizeof words, "y (%s)", view->length_unit);
  cairo_save(cr);
  cairo_translate(cr, 18, page->top + page->high / 2);
  cairo_rotate(cr, -acos(-1) / 2);
  put_text(cr, 0, 0, 0.5, 13, words);
  cairo_restore(cr);
}

/** Directions of x, y and z, and the size of the body, where axes with numbers would mean nothing. */
static void draw_triad(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view)
{
  double x = 34, y = page->height - 34;
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 1.2);
  for (int k = 0; k < 3; ++k) {
    double dx = 24 * scene->right[k], dy = -24 * scene->up[k];
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + dx, y + dy);
    cairo_stroke(cr);
    char name[2] = {"xyz"[k], 0};
    put_text(cr, x + 1.4 * dx, y + 1.4 * dy + 4, 0.5, 12, name);
  }
  double bar = tick_distance((scene->x1 - scene->x0) * 2);
  char words[96];
  snprintf(words, sizeof words, "%g %s", bar, view->length_unit);
  double at = page->left + 60;
  cairo_move_to(cr, at, page->height - 24);
  cairo_line_to(cr, at + bar * page->scale, page->height - 24);
  cairo_stroke(cr);
  put_text(cr, at + bar * page->scale + 8, page->height - 20, 0, 12, words);
}

static void draw_bar(cairo_t *cr, const Page *page, const Scene *scene, const char *label)
{
  double x = page->left + page->wide + 26, wide = 16, high = fmax(page->high, 160), y = page->top;
  enum { STEPS = 128 };
  for (int k = 0; k < STEPS; ++k) {
    double rgb[3];
    colour((k + 0.5) / STEPS, rgb);
    cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
    cairo_rectangle(cr, x, y + high * (STEPS - 1 - k) / STEPS, wide, high / STEPS + 0.6);
    cairo_fill(cr);
  }
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 0.8);
  cairo_rectangle(cr, x, y, wide, high);
  cairo_stroke(cr);
  double step = tick_distance(scene->high - scene->low);
  for (double v = ceil(scene->low / step - 1e-9) * step; v <= scene->high + 1e-9 * step; v += step) {
    char words[32];
    double at = y + high * (1 - (v - scene->low) / (scene->high - scene->low));
    cairo_move_to(cr, x + wide, at);
    cairo_line_to(cr, x + wide + 4, at);
    cairo_stroke(cr);
    tick_words(v, step, words, sizeof words);
    put_text(cr, x + wide + 8, at + 4, 0, 12, words);
  }
  cairo_save(cr);
  cairo_translate(cr, page->width - 14, y + high / 2);
  cairo_rotate(cr, -acos(-1) / 2);
  put_text(cr, 0, 0, 0.5, 13, label);
  cairo_restore(cr);
}

/* ---- particles ---- */

typedef struct Depth {
  double depth;
  int64_t particle;
} Depth;

static int by_depth(const void *a, const void *b)
{
  const Depth *x = a, *y = b;
  return x->depth != y->depth ? (x->depth < y->depth ? -1 : 1) : (x->particle < y->particle ? -1 : 1);
}

/** Flat squares, the nearest last: plane bodies, and plates seen from the front. */
static int draw_squares(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, bool deformed)
{
  /* Turned and parted squares would leave gaps: where the body is deformed they are drawn a little larger. */
  const double larger = deformed ? 1.3 : 1;
  Depth *order = malloc(sizeof(Depth) * (size_t)(scene->count + 1));
  if (!order) return 1;
  for (int64_t n = 0; n < scene->count; ++n) order[n] = (Depth){scene->depth[n], n};
  qsort(order, (size_t)scene->count, sizeof(Depth), by_depth);
  for (int64_t k = 0; k < scene->count; ++k) {
    int64_t n = order[k].particle;
    double rgb[3], half = larger * view->spacings[n] / 2, side = 2 * half * page->scale;
    colour((scene->value[n] - scene->low) / (scene->high - scene->low), rgb);
    cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
    double x0 = page->left + (scene->x[n] - half - scene->x0) * page->scale;
    double y0 = page->top + page->high - (scene->y[n] + half - scene->y0) * page->scale;
    double x1 = floor(x0 + side + 0.5), y1 = floor(y0 + side + 0.5); /* edges on pixels, or seams show */
    x0 = floor(x0 + 0.5);
    y0 = floor(y0 + 0.5);
    cairo_rectangle(cr, x0, y0, x1 - x0, y1 - y0);
    cairo_fill(cr);
  }
  free(order);
  return 0;
}

/** Spheres into an image of twice the resolution, the nearest one in each pixel. */
static int draw_spheres(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view)
{
  const int fine = 2;
  int wide = (int)ceil(page->wide) * fine + 1, high = (int)ceil(page->high) * fine + 1;
  cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, wide, high);
  double *depth = malloc(sizeof(double) * (size_t)wide * (size_t)high);
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
    double cx = (scene->x[n] - scene->x0) * scale, cy = (scene->y1 - scene->y[n]) * scale;
    if (!isfinite(cx) || !isfinite(cy)) continue;
    colour((scene->value[n] - scene->low) / (scene->high - scene->low), rgb);
    int x0 = (int)fmax(0, floor(cx - radius)), x1 = (int)fmin(wide - 1, ceil(cx + radius));
    int y0 = (int)fmax(0, floor(cy - radius)), y1 = (int)fmin(high - 1, ceil(cy + radius));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        double dx = (x + 0.5 - cx) / radius, dy = (y + 0.5 - cy) / radius, square = dx * dx + dy * dy;
        if (square > 1) continue;
        double dz = sqrt(1 - square), at = scene->depth[n] * scale + radius * dz;
        if (at <= depth[y * wide + x]) continue;
        depth[y * wide + x] = at;
        double light = 0.62 + 0.38 * fmax(0, -0.35 * dx - 0.45 * dy + 0.82 * dz);
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

static void draw_broken(cairo_t *cr, const Page *page, const Scene *scene, const ResultView *view, int step)
{
  int64_t count = 0, *pairs = result_view_broken(view, step, &count);
  cairo_set_source_rgba(cr, 0.85, 0.1, 0.1, 0.55);
  cairo_set_line_width(cr, 0.6);
  for (int64_t k = 0; pairs && k < count; ++k) {
    for (int e = 0; e < 2; ++e) {
      int64_t n = pairs[2 * k + e];
      if (n < 0 || n >= scene->count) continue;
      double x = page->left + (scene->x[n] - scene->x0) * page->scale;
      double y = page->top + page->high - (scene->y[n] - scene->y0) * page->scale;
      if (e)
        cairo_line_to(cr, x, y);
      else
        cairo_move_to(cr, x, y);
    }
    cairo_stroke(cr);
  }
  free(pairs);
}

static cairo_surface_t *open_surface(const char *path, const Page *page)
{
  const char *dot = strrchr(path, '.');
  if (!strcmp(dot, ".svg")) return cairo_svg_surface_create(path, page->width, page->height);
  if (!strcmp(dot, ".pdf")) return cairo_pdf_surface_create(path, page->width, page->height);
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)ceil(page->width), (int)ceil(page->height));
}

static int render(const Scene *scene, const ResultView *view, int step, const PictureOptions *o, const char *label,
                  const char *path, Error *error)
{
  Page page = lay_out(scene, o->size);
  cairo_surface_t *surface = open_surface(path, &page);
  cairo_t *cr = cairo_create(surface);
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  int bad = scene->flat ? draw_squares(cr, &page, scene, view, o->deformed != 0) : draw_spheres(cr, &page, scene, view);
  if (o->broken_bonds) draw_broken(cr, &page, scene, view, step);
  if (scene->flat)
    draw_axes(cr, &page, scene, view);
  else
    draw_triad(cr, &page, scene, view);
  draw_bar(cr, &page, scene, label);
  cairo_set_source_rgb(cr, 0, 0, 0);
  put_text(cr, page.left - 6, 24, 0, 16, view->title);
  char words[160];
  snprintf(words, sizeof words, "time %.6g %s (step %lld)", view->times[step], view->time_unit,
           (long long)view->step_numbers[step]);
  size_t n = strlen(words);
  if (o->deformed == 0)
    snprintf(words + n, sizeof words - n, ", reference shape");
  else if (o->deformed != 1)
    snprintf(words + n, sizeof words - n, ", displacements %g times enlarged", o->deformed);
  put_text(cr, page.left - 6, 44, 0, 13, words);
  cairo_destroy(cr);
  cairo_status_t status = cairo_surface_status(surface);
  if (!status && !strcmp(strrchr(path, '.'), ".png")) status = cairo_surface_write_to_png(surface, path);
  cairo_surface_finish(surface);
  if (!status) status = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (!status && !bad) return BRECCIA_OK;
  return error_add(error, BRECCIA_FAILURE, "%s: cannot be drawn: %s", path,
                   bad ? "out of memory" : cairo_status_to_string(status));
}

int picture_draw(const ResultView *view, int step, const PictureOptions *o, const char *path, Error *error)
{
  if (!picture_format(path))
    return error_add(error, BRECCIA_USER_ERROR, "%s: pictures end in .png, .svg or .pdf", path);
  Scene scene = {.count = view->particles};
  double **arrays[] = {&scene.x, &scene.y, &scene.depth, &scene.value};
  int status = BRECCIA_OK;
  for (int k = 0; k < 4; ++k) {
    *arrays[k] = malloc(sizeof(double) * (size_t)(scene.count + 1));
    if (!*arrays[k]) status = error_add(error, BRECCIA_FAILURE, "out of memory: picture");
  }
  char label[160];
  if (!status) status = take_values(&scene, view, step, o, label, sizeof label, error);
  if (!status) {
    look(&scene, view, o);
    status = project(&scene, view, step, o, error);
  }
  if (!status && !(scene.x1 > scene.x0 && scene.y1 > scene.y0))
    status = error_add(error, BRECCIA_FAILURE, "%s: no particle has a finite position", path);
  if (!status) status = render(&scene, view, step, o, label, path, error);
  for (int k = 0; k < 4; ++k) free(*arrays[k]);
  return status;
}

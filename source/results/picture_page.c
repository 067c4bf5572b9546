/* The page around a body: title, axes or directions, colour bar. */
#include "results/colours.h"
#include "results/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TITLE_SIZE = 16, WORDS_SIZE = 13, TICK_SIZE = 12, MARGIN = 14, BAR = 16, TICK = 4, MOST_WIDE = 760 };

static double words_width(cairo_t *cr, double size, const char *words)
{
  cairo_text_extents_t extent;
  cairo_set_font_size(cr, size);
  cairo_text_extents(cr, words, &extent);
  return extent.x_advance;
}

/** Words with their left end (align 0), middle (0.5) or right end (1) at x; smaller if they are wider than `room`. */
static void put_words(cairo_t *cr, double x, double y, double align, double size, double room, const char *words)
{
  double wide = words_width(cr, size, words);
  if (wide > room) {
    size = fmax(8, size * room / wide);
    wide = words_width(cr, size, words);
  }
  cairo_move_to(cr, x - align * wide, y);
  cairo_show_text(cr, words);
}

static void put_upright(cairo_t *cr, double x, double y, double size, double room, const char *words)
{
  cairo_save(cr);
  cairo_translate(cr, x, y);
  cairo_rotate(cr, -acos(-1) / 2);
  put_words(cr, 0, 0, 0.5, size, room, words);
  cairo_restore(cr);
}

typedef struct Ticks {
  double distance, first;
  int count;
} Ticks;

/** Returns the ticks from `low` to `high` at multiples of `distance`; none where a range without a length has no
 * distance. */
static Ticks ticks_at(double distance, double low, double high)
{
  const double first = ceil(low / distance - 1e-9), more = floor(high / distance + 1e-9) - first;
  return (Ticks){distance, first * distance, more >= 0 ? (int)more + 1 : 0};
}

/** Ticks from `low` to `high` on `points` of paper, each `apart` from the next at least. */
static Ticks place_ticks(double low, double high, double points, double apart)
{
  double number = fmax(1, fmin(6, points / apart)), distance = scale_ticks(high - low, number);
  while (distance / (high - low) * points < apart && number > 0.2) distance = scale_ticks(high - low, number *= 0.7);
  return ticks_at(distance, low, high);
}

/** A narrow body may lie between two ticks: then nearer ones, of which words that take `room` each leave one. */
static Ticks one_at_least(Ticks t, double low, double high, double points, double room)
{
  for (double number = 1; !t.count && number < 1000; number *= 1.5)
    t = ticks_at(scale_ticks(high - low, number), low, high);
  if (t.count > 1 && room > t.distance / (high - low) * points) t.count = 1;
  return t;
}

/** Room that the widest words of some ticks take. */
static double ticks_width(cairo_t *cr, const Ticks *t)
{
  double most = 0;
  for (int k = 0; k < t->count; ++k) {
    char words[32];
    scale_words(t->first + k * t->distance, t->distance, words, sizeof words);
    most = fmax(most, words_width(cr, TICK_SIZE, words));
  }
  return most;
}

static Ticks upright_ticks(double low, double high, double points)
{
  return one_at_least(place_ticks(low, high, points, 20), low, high, points, TICK_SIZE);
}

/** Ticks of a lying axis: their words must not touch. */
static Ticks level_ticks(cairo_t *cr, double low, double high, double points)
{
  Ticks t = place_ticks(low, high, points, 40);
  for (int k = 0; k < 4; ++k) t = place_ticks(low, high, points, ticks_width(cr, &t) + 16);
  return one_at_least(t, low, high, points, ticks_width(cr, &t) + 4);
}

static bool has_y_axis(const Page *page)
{
  return page->thick == 0;
}

static double axis_low(const Scene *s, int axis)
{
  return (axis ? s->y0 : s->x0) * s->length.factor;
}
static double axis_high(const Scene *s, int axis)
{
  return (axis ? s->y1 : s->x1) * s->length.factor;
}

static void write_heads(Page *page, const Scene *scene, const ResultView *view, int step, const PictureOptions *o)
{
  char time[96];
  picture_time(view, step, o->one_of_many, time, sizeof time);
  snprintf(page->title, sizeof page->title, "%s", o->title ? o->title : view->title);
  snprintf(page->subtitle, sizeof page->subtitle, "%s %s %s", scene->heading, picture_of_mode(view, step) ? "of" : "at",
           time);
  Text notes = {0};
  if (o->deformed == 0)
    text_add(&notes, "reference shape");
  else if (o->deformed != 1)
    text_add(&notes, "displacements ×%g", o->deformed);
  if (scene->bars.view.lines && !scene->flat)
    text_add(&notes, "%sbars are seen through the body", notes.length ? ", " : "");
  int64_t broken = 0;
  if (o->broken_bonds) free(result_view_broken(view, step, &broken));
  if (broken) text_add(&notes, "%sbroken bonds in red, except across open cracks", notes.length ? ", " : "");
  if (scene->missing)
    text_add(&notes, "%sgrey: %lld particle%s without a number", notes.length ? ", " : "", (long long)scene->missing,
             scene->missing > 1 ? "s" : "");
  if (scene->outside)
    text_add(&notes, "%s%lld particle%s outside the picture", notes.length ? ", " : "", (long long)scene->outside,
             scene->outside > 1 ? "s" : "");
  snprintf(page->notes, sizeof page->notes, "%s", notes.characters ? notes.characters : "");
  text_free(&notes);
}

Page page_lay_out(const Scene *scene, const ResultView *view, int step, const PictureOptions *o)
{
  Page page = {0};
  const double most_wide = o->size > 0 ? o->size : scene->flat ? 640 : 460, most_high = most_wide * 7 / 8;
  const double w = scene->x1 - scene->x0, h = scene->y1 - scene->y0;
  page.scale = fmin(most_wide / w, most_high / h);
  page.wide = w * page.scale;
  page.high = h * page.scale;
  if (scene->flat && page.high < 16) page.high = page.thick = 16;
  page.bar_below = page.wide > 3 * page.high;
  write_heads(&page, scene, view, step, o);

  cairo_surface_t *none = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1);
  cairo_t *cr = cairo_create(none);
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  page.left = 2 * MARGIN;
  if (scene->flat && has_y_axis(&page)) {
    const Ticks t = upright_ticks(axis_low(scene, 1), axis_high(scene, 1), page.high);
    page.left = MARGIN + WORDS_SIZE + 8 + ticks_width(cr, &t) + 4 + TICK + 6;
  }
  page.top = MARGIN + TITLE_SIZE + 8 + WORDS_SIZE + (*page.notes || o->one_of_many ? 6 + TICK_SIZE : 0) + 18;
  double right = 2 * MARGIN, bottom = scene->flat ? 6 + TICK + 4 + TICK_SIZE + 8 + WORDS_SIZE + MARGIN : 70;
  if (page.bar_below)
    bottom += 12 + WORDS_SIZE + 6 + BAR + TICK + 4 + TICK_SIZE;
  else {
    const Ticks t = upright_ticks(scene->range.low * scene->unit.factor, scene->range.high * scene->unit.factor,
                                  fmax(page.high, 160));
    right = 24 + BAR + TICK + 4 + (o->one_of_many ? 60 : ticks_width(cr, &t)) + 10 + WORDS_SIZE + MARGIN;
  }
  const double words = fmax(words_width(cr, TITLE_SIZE, page.title),
                            fmax(words_width(cr, WORDS_SIZE, page.subtitle), words_width(cr, TICK_SIZE, page.notes)));
  page.width = fmax(page.left + page.wide + right, o->one_of_many ? 480 : fmin(words + 2 * MARGIN, MOST_WIDE));
  page.height = page.top + (page.bar_below ? page.high : fmax(page.high, 160)) + bottom;
  cairo_destroy(cr);
  cairo_surface_destroy(none);
  page.width = 2 * ceil(page.width / 2); /* players of movies want even numbers of pixels */
  page.height = 2 * ceil(page.height / 2);
  return page;
}

static void draw_axes(cairo_t *cr, const Page *page, const Scene *scene, const PictureOptions *o)
{
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 0.8);
  const double scale = page->scale / scene->length.factor;
  for (int axis = 0; axis < (has_y_axis(page) ? 2 : 1); ++axis) {
    const double low = axis_low(scene, axis), high = axis_high(scene, axis);
    const Ticks t = axis ? upright_ticks(low, high, page->high) : level_ticks(cr, low, high, page->wide);
    for (int k = 0; k < t.count; ++k) {
      const double v = t.first + k * t.distance;
      char words[32];
      scale_words(v, t.distance, words, sizeof words);
      if (axis) {
        const double y = page->top + page->high - (v - low) * scale;
        cairo_move_to(cr, page->left - 6 - TICK, y);
        cairo_line_to(cr, page->left - 6, y);
        cairo_stroke(cr);
        put_words(cr, page->left - 6 - TICK - 4, y + 4, 1, TICK_SIZE, 1000, words);
      } else {
        const double x = page->left + (v - low) * scale, y = page->top + page->high + 6;
        cairo_move_to(cr, x, y);
        cairo_line_to(cr, x, y + TICK);
        cairo_stroke(cr);
        put_words(cr, x, y + TICK + 4 + TICK_SIZE - 2, 0.5, TICK_SIZE, 1000, words);
      }
    }
  }
  cairo_rectangle(cr, page->left - 6, page->top - 6, page->wide + 12, page->high + 12);
  cairo_stroke(cr);
  for (int axis = 0; axis < (has_y_axis(page) ? 2 : 1); ++axis) {
    char label[160], magnified[64] = "";
    const char *given = axis ? o->y_label : o->x_label;
    if (o->deformed != 0 && o->deformed != 1) /* these are not the coordinates of anything */
      snprintf(magnified, sizeof magnified, " + %g u%c", o->deformed, axis ? 'y' : 'x');
    snprintf(label, sizeof label, "%c%s [%s]", axis ? 'y' : 'x', magnified, scene->length.name);
    if (axis)
      put_upright(cr, MARGIN + WORDS_SIZE - 3, page->top + page->high / 2, WORDS_SIZE, page->high + 24,
                  given ? given : label);
    else
      put_words(cr, page->left + page->wide / 2, page->top + page->high + 6 + TICK + 4 + TICK_SIZE + 6 + WORDS_SIZE,
                0.5, WORDS_SIZE, page->wide + 80, given ? given : label);
  }
}

/** Directions of x, y and z, and a length, where axes with numbers would mean nothing. */
static void draw_triad(cairo_t *cr, const Page *page, const Scene *scene)
{
  const double x = page->left + 24, y = page->top + page->high + 42;
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 1.2);
  for (int k = 0; k < 3; ++k) {
    const double dx = 22 * scene->right[k], dy = -22 * scene->up[k];
    if (hypot(dx, dy) < 6) continue; /* towards the eye */
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + dx, y + dy);
    cairo_stroke(cr);
    const char name[2] = {"xyz"[k], 0};
    put_words(cr, x + dx + 9 * dx / hypot(dx, dy), y + dy + 9 * dy / hypot(dx, dy) + 4, 0.5, TICK_SIZE, 100, name);
  }
  const double length = scale_ticks((scene->x1 - scene->x0) * scene->length.factor, 4);
  const double from = page->left + 76, to = from + length / scene->length.factor * page->scale, at = y + 6;
  char words[96];
  snprintf(words, sizeof words, "%g %s", length, scene->length.name);
  cairo_move_to(cr, from, at - 4);
  cairo_line_to(cr, from, at + 4);
  cairo_move_to(cr, from, at);
  cairo_line_to(cr, to, at);
  cairo_move_to(cr, to, at - 4);
  cairo_line_to(cr, to, at + 4);
  cairo_stroke(cr);
  put_words(cr, to + 8, at + 4, 0, TICK_SIZE, 1000, words);
}

/** The colour bar with its numbers and, along it, its title. */
static void draw_bar(cairo_t *cr, const Page *page, const Scene *scene)
{
  const bool below = page->bar_below;
  const double length = below ? fmin(page->wide, 420) : fmax(page->high, 160);
  const double x = below ? page->left : page->left + page->wide + 24;
  const double y = below ? page->height - MARGIN - TICK_SIZE - 4 - TICK - BAR : page->top;
  enum { STEPS = 128 };
  for (int k = 0; k < STEPS; ++k) {
    double rgb[3];
    scene_colour(scene, scene->range.low + (k + 0.5) / STEPS * (scene->range.high - scene->range.low), rgb);
    cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
    if (below)
      cairo_rectangle(cr, x + length * k / STEPS, y, length / STEPS + 0.6, BAR);
    else
      cairo_rectangle(cr, x, y + length * (STEPS - 1 - k) / STEPS, BAR, length / STEPS + 0.6);
    cairo_fill(cr);
  }
  cairo_set_source_rgb(cr, 0.2, 0.2, 0.2);
  cairo_set_line_width(cr, 0.8);
  cairo_rectangle(cr, x, y, below ? length : BAR, below ? BAR : length);
  cairo_stroke(cr);
  const double low = scene->range.low * scene->unit.factor, high = scene->range.high * scene->unit.factor;
  const Ticks t = below ? level_ticks(cr, low, high, length) : upright_ticks(low, high, length);
  const double numbers = ticks_width(cr, &t);
  for (int k = 0; k < t.count; ++k) {
    char words[32];
    const double v = t.first + k * t.distance, share = (v - low) / (high - low);
    scale_words(v, t.distance, words, sizeof words);
    const double at = below ? x + length * share : y + length * (1 - share);
    cairo_move_to(cr, below ? at : x + BAR, below ? y + BAR : at);
    cairo_line_to(cr, below ? at : x + BAR + TICK, below ? y + BAR + TICK : at);
    cairo_stroke(cr);
    if (below)
      put_words(cr, at, y + BAR + TICK + 4 + TICK_SIZE - 2, 0.5, TICK_SIZE, 1000, words);
    else /* numbers stand in line at their right ends */
      put_words(cr, x + BAR + TICK + 4 + numbers, at + 4, 1, TICK_SIZE, 1000, words);
  }
  if (below)
    put_words(cr, x, y - 7, 0, WORDS_SIZE, page->wide, scene->heading);
  else
    put_upright(cr, x + BAR + TICK + 4 + numbers + 10 + WORDS_SIZE - 3, y + length / 2, WORDS_SIZE, length + 40,
                scene->heading);
}

void page_draw(cairo_t *cr, const Page *page, const Scene *scene, const PictureOptions *o)
{
  if (scene->flat)
    draw_axes(cr, page, scene, o);
  else
    draw_triad(cr, page, scene);
  draw_bar(cr, page, scene);
  const double room = page->width - 2 * MARGIN;
  double y = MARGIN + TITLE_SIZE - 2;
  cairo_set_source_rgb(cr, 0, 0, 0);
  put_words(cr, MARGIN, y, 0, TITLE_SIZE, room, page->title);
  put_words(cr, MARGIN, y += 8 + WORDS_SIZE, 0, WORDS_SIZE, room, page->subtitle);
  cairo_set_source_rgb(cr, 0.3, 0.3, 0.3);
  put_words(cr, MARGIN, y + 6 + TICK_SIZE, 0, TICK_SIZE, room, page->notes);
}

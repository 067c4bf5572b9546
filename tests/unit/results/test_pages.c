/* Pictures as people read them: numbers at axes and colour bars stand where what they say is drawn, words say what there is, and particles have
 * their colours where they stand. Pages are of scenes made up here. */
#include "results/colours.h"
#include "results/picture.h"
#include "results/scene.h"
#include "support.h"

enum { MOST = 200 };
static struct {
  char words[256];
  double x, y, wide; /* left end and base line on the page; along the words */
  bool upright;
} written[MOST];
static int written_count;

/** Takes the place of cairo's: it notes words and where they stand, and draws nothing. */
void cairo_show_text(cairo_t *cr, const char *words)
{
  cairo_text_extents_t extent;
  cairo_matrix_t matrix;
  double x, y;
  assert_true(written_count < MOST);
  cairo_text_extents(cr, words, &extent);
  cairo_get_current_point(cr, &x, &y);
  cairo_user_to_device(cr, &x, &y);
  cairo_get_matrix(cr, &matrix);
  snprintf(written[written_count].words, sizeof written[0].words, "%s", words);
  written[written_count].x = x;
  written[written_count].y = y;
  written[written_count].wide = extent.x_advance;
  written[written_count++].upright = matrix.xx == 0 || fabs(matrix.yx) > 0.5;
}

static int find_words(const char *words)
{
  for (int k = 0; k < written_count; ++k)
    if (!strcmp(written[k].words, words)) return k;
  fail_msg("'%s' is not written", words);
  return -1;
}

static double middle_of(int k)
{
  return written[k].x + written[k].wide / 2;
}

static bool is_number(const char *words, double *value)
{
  char *end;
  *value = strtod(words, &end);
  return *words && !*end;
}

typedef struct Sheet { /* what was drawn */
  Page page;
  cairo_surface_t *surface;
  int wide, high;
} Sheet;

static double times[] = {0, 0.5, 2};
static int64_t steps[] = {0, 10, 40};
static const PictureOptions plain = {.field = "stress", .deformed = 1, .azimuth = NAN, .elevation = NAN};

/** Draws a scene's page, and its body if there is one, on white. */
static Sheet draw(const Scene *scene, const ResultView *view, int step, const PictureOptions *o)
{
  Sheet s = {.page = page_lay_out(scene, view, step, o)};
  s.wide = (int)s.page.width;
  s.high = (int)s.page.height;
  s.surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, s.wide, s.high);
  cairo_t *cr = cairo_create(s.surface);
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  written_count = 0;
  if (scene->count) assert_int_equal(body_draw(cr, &s.page, scene, view, step, o), 0);
  page_draw(cr, &s.page, scene, o);
  assert_int_equal(cairo_status(cr), 0);
  cairo_destroy(cr);
  cairo_surface_flush(s.surface);
  return s;
}

static void pixel(const Sheet *s, double x, double y, double rgb[3])
{
  const int column = (int)floor(x), row = (int)floor(y);
  assert_true(column >= 0 && column < s->wide && row >= 0 && row < s->high);
  const unsigned char *p = cairo_image_surface_get_data(s->surface) +
                           (size_t)row * (size_t)cairo_image_surface_get_stride(s->surface) + 4 * (size_t)column;
  for (int c = 0; c < 3; ++c) rgb[c] = p[2 - c] / 255.0;
}

static double brightness(const Sheet *s, double x, double y)
{
  double rgb[3];
  pixel(s, x, y, rgb);
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

/** Fails unless there is the colour of a value at a place. */
static void has_colour(const Sheet *s, const Scene *scene, double x, double y, double value, double slack)
{
  double found[3], expected[3];
  pixel(s, x, y, found);
  scene_colour(scene, value, expected);
  for (int c = 0; c < 3; ++c)
    if (!(fabs(found[c] - expected[c]) <= slack))
      fail_msg("at %g, %g: colour %.3f %.3f %.3f, expected that of %g: %.3f %.3f %.3f", x, y, found[0], found[1],
               found[2], value, expected[0], expected[1], expected[2]);
}

static ResultView a_view(void)
{
  ResultView view = {.times = times, .steps = 3, .step_numbers = steps, .spacing = 1};
  snprintf(view.title, sizeof view.title, "Dam");
  snprintf(view.time_unit, sizeof view.time_unit, "s");
  return view;
}

/** Of flat bodies: the axes reach over what is shown, in their own unit, and the bar over the colours. */
static void numbers_stand_at_what_they_say(void **state)
{
  (void)state;
  const ResultView view = a_view();
  static const double shapes[][4] = {{2, 12, -1, 4}, {-3, 6, 10, 31}, {0, 40, 0, 3}}; /* the last has its bar below */
  for (int k = 0; k < 3; ++k)
    for (int diverging = 0; diverging < 2; ++diverging) {
      Scene scene = {.flat = true,
                     .x0 = shapes[k][0],
                     .x1 = shapes[k][1],
                     .y0 = shapes[k][2],
                     .y1 = shapes[k][3],
                     .range = {diverging ? -20e3 : 5e3, 30e3, diverging},
                     .unit = {"MPa", 1e-3},
                     .length = {"cm", 100},
                     .heading = "Stress xx [MPa]"};
      Sheet s = draw(&scene, &view, 1, &plain);
      const Page *p = &s.page;
      const bool below = k == 2;
      assert_true(p->bar_below == below);
      assert_near(p->scale, k == 1 ? 560 / 21.0 : 640 / (shapes[k][1] - shapes[k][0]), 1e-9);
      assert_near(p->wide, p->scale * (scene.x1 - scene.x0), 1e-9);
      assert_near(p->high, p->scale * (scene.y1 - scene.y0), 1e-9);
      const int title = find_words("Dam"), what = find_words("Stress xx [MPa] at 0.5 s"), x = find_words("x [cm]"),
                y = find_words("y [cm]"), bar = find_words("Stress xx [MPa]");
      assert_true(written[title].y < written[what].y && written[what].y < p->top);
      assert_true(written[title].x == written[what].x);
      assert_near(middle_of(x), p->left + p->wide / 2, 1);
      assert_true(!written[x].upright && written[y].upright && written[bar].upright == !below);
      assert_near(written[y].y - written[y].wide / 2, p->top + p->high / 2, 1);
      assert_true(written[y].x < p->left - 20);
      int along = 0, up = 0, values = 0;
      const double length = below ? fmin(p->wide, 420) : fmax(p->high, 160);
      for (int n = 0; n < written_count; ++n) {
        double value;
        if (!is_number(written[n].words, &value)) continue;
        const double shown = value / 100, colour = value * 1e3;
        if (written[n].x > p->left + p->wide + 20 || (below && written[n].y > written[x].y + 10)) {
          const double share = (colour - scene.range.low) / (scene.range.high - scene.range.low);
          const double left = below ? p->left : p->left + p->wide + 24, top = below ? written[n].y - 34 : p->top;
          const double at = below ? left + share * length : top + (1 - share) * length;
          assert_true(share > -1e-9 && share < 1 + 1e-9);
          assert_near(below ? middle_of(n) : written[n].y - 4, at, 1);
          const double inwards = share < 0.5 ? 2 : -2, within = (share < 0.5 ? 1 : -1) * 2 / length;
          const double there = colour + within * (scene.range.high - scene.range.low);
          if (below)
            has_colour(&s, &scene, at + inwards, top + 8, there, 0.03);
          else
            has_colour(&s, &scene, left + 8, at - inwards, there, 0.03);
          assert_true(below ? brightness(&s, at, top + 16 + 2) < 0.8 || brightness(&s, at - 1, top + 16 + 2) < 0.8
                            : brightness(&s, left + 16 + 2, at) < 0.8 || brightness(&s, left + 16 + 2, at - 1) < 0.8);
          ++values;
        } else if (written[n].y > p->top + p->high + 6) {
          const double at = p->left + (shown - scene.x0) * p->scale;
          assert_true(shown >= scene.x0 - 1e-9 && shown <= scene.x1 + 1e-9);
          assert_near(middle_of(n), at, 1);
          assert_true(brightness(&s, at, p->top + p->high + 8) < 0.8 ||
                      brightness(&s, at - 1, p->top + p->high + 8) < 0.8);
          ++along;
        } else {
          const double at = p->top + p->high - (shown - scene.y0) * p->scale;
          assert_true(shown >= scene.y0 - 1e-9 && shown <= scene.y1 + 1e-9);
          assert_near(written[n].y - 4, at, 1);
          assert_true(written[n].x + written[n].wide < p->left - 6);
          assert_true(brightness(&s, p->left - 8, at) < 0.8 || brightness(&s, p->left - 8, at - 1) < 0.8);
          ++up;
        }
      }
      if (along < 4 || up < 2 || values < 3 || along > 14 || up > 14 || values > 8)
        fail_msg("shape %d: %d numbers along, %d up, %d at the colours", k, along, up, values);
      cairo_surface_destroy(s.surface);
    }
}

/** What was asked for stands in place of what is usual; what is magnified, missing or outside is told. */
static void words_of_a_picture_tell_what_it_shows(void **state)
{
  (void)state;
  ResultView view = a_view();
  int64_t broken[] = {5, 0, 1, 20, 1, 2, 40, 0, 2};
  view.broken = broken;
  view.broken_count = 3;
  Scene scene = {.flat = true, .x1 = 4, .y1 = 2, .range = {0, 1, false}, .unit = {"", 1}, .length = {"m", 1}};
  snprintf(scene.heading, sizeof scene.heading, "Damage");
  static const struct {
    double deformed;
    bool bonds;
    int step, missing, outside;
    const char *notes, *x, *y;
  } cases[] = {
      {1, false, 2, 0, 0, "", "x [m]", "y [m]"},
      {0, false, 2, 0, 0, "reference shape", "x [m]", "y [m]"},
      {50, false, 2, 0, 0, "displacements ×50", "x + 50 ux [m]", "y + 50 uy [m]"},
      {1, true, 0, 0, 0, "", "x [m]", "y [m]"}, /* none has broken by then */
      {1, true, 1, 0, 0, "broken bonds in red, except across open cracks", "x [m]", "y [m]"},
      {0, true, 1, 1, 2,
       "reference shape, broken bonds in red, except across open cracks, grey: 1 particle without a number, 2 "
       "particles outside the picture",
       "x [m]", "y [m]"},
      {1, false, 2, 2, 1, "grey: 2 particles without a number, 1 particle outside the picture", "x [m]", "y [m]"},
      {1, false, 2, 0, 3, "3 particles outside the picture", "x [m]", "y [m]"},
  };
  double bare = 0;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    PictureOptions o = plain;
    o.deformed = cases[k].deformed;
    o.broken_bonds = cases[k].bonds;
    scene.missing = cases[k].missing;
    scene.outside = cases[k].outside;
    Sheet s = draw(&scene, &view, cases[k].step, &o);
    assert_string_equal(s.page.title, "Dam");
    assert_string_equal(s.page.subtitle, cases[k].step == 0   ? "Damage at 0 s"
                                         : cases[k].step == 1 ? "Damage at 0.5 s"
                                                              : "Damage at 2 s");
    assert_string_equal(s.page.notes, cases[k].notes);
    const int notes = find_words(cases[k].notes);
    find_words(cases[k].x);
    find_words(cases[k].y);
    if (k == 0) bare = s.page.top;
    if (*cases[k].notes) { /* below the other words, and above the drawing */
      assert_true(written[notes].y > written[find_words(s.page.subtitle)].y + 10 && written[notes].y < s.page.top - 6);
      assert_near(s.page.top, bare + 18, 1e-9);
      assert_true(written[notes].x + written[notes].wide < s.page.width);
    }
    cairo_surface_destroy(s.surface);
  }
  PictureOptions o = plain;
  o.title = "Crest";
  o.x_label = "along";
  o.y_label = "height";
  Sheet s = draw(&scene, &view, 0, &o);
  assert_true(written[find_words("Crest")].y < written[find_words("Damage at 0 s")].y);
  assert_true(find_words("along") >= 0 && written[find_words("height")].upright);
  assert_near(s.page.scale, 160, 1e-9);
  cairo_surface_destroy(s.surface);
  o.size = 100;
  s = draw(&scene, &view, 0, &o);
  assert_near(s.page.scale, 25, 1e-9);
  cairo_surface_destroy(s.surface);
  /* Modes of vibration have no time. */
  double frequencies[] = {4.56, 12, 30};
  view.frequencies = frequencies;
  view.frequency_count = 3;
  s = draw(&scene, &view, 1, &plain);
  assert_string_equal(s.page.subtitle, "Damage of mode 10, 12 Hz");
  cairo_surface_destroy(s.surface);
}

/** The frames of a movie are of one size, and times in them have all digits, whatever stands in them. */
static void frames_of_a_movie_are_alike(void **state)
{
  (void)state;
  const ResultView view = a_view();
  PictureOptions o = plain;
  o.one_of_many = true;
  Scene scene = {.flat = true, .x1 = 4, .y1 = 2, .range = {0, 1, false}, .unit = {"", 1}, .length = {"m", 1}};
  const Page first = page_lay_out(&scene, &view, 0, &o);
  assert_non_null(strstr(first.subtitle, " 0.000 s"));
  scene.missing = 7;
  scene.range.high = 3e-4;
  const Page last = page_lay_out(&scene, &view, 2, &o);
  assert_non_null(strstr(last.subtitle, " 2.000 s"));
  assert_true(first.width == last.width && first.height == last.height && first.top == last.top);
  assert_true(fmod(first.width, 2) == 0 && fmod(first.height, 2) == 0);
}

/** Bodies in space have arrows along x, y and z and a length in place of axes. */
static void directions_and_a_length_stand_beside_bodies_in_space(void **state)
{
  (void)state;
  const ResultView view = a_view();
  const Scene scene = {.x0 = -2,
                       .x1 = 8,
                       .y1 = 6,
                       .range = {0, 1, false},
                       .unit = {"", 1},
                       .length = {"mm", 1e3},
                       .right = {0.8, 0.6, 0},
                       .up = {-0.3, 0.4, 0.8660254},
                       .eye = {0.5, -0.7, 0.5}};
  Sheet s = draw(&scene, &view, 0, &plain);
  const double x = s.page.left + 24, y = s.page.top + s.page.high + 42;
  for (int k = 0; k < 3; ++k) {
    const char name[2] = {"xyz"[k], 0};
    const double dx = 22 * scene.right[k], dy = -22 * scene.up[k], far = 1 + 9 / hypot(dx, dy);
    const int n = find_words(name);
    assert_near(middle_of(n), x + far * dx, 1);
    assert_near(written[n].y - 4, y + far * dy, 1);
    assert_true(brightness(&s, x + 0.7 * dx, y + 0.7 * dy) < 0.75);
    assert_near(brightness(&s, x - 0.7 * dx, y - 0.7 * dy), 1, 0.01);
  }
  /* 10 m wide on 460 points: 2000 mm are 92 points */
  const int length = find_words("2000 mm");
  const double from = s.page.left + 76, at = y + 6;
  assert_true(brightness(&s, from + 5, at) < 0.75 || brightness(&s, from + 5, at - 1) < 0.75);
  assert_true(brightness(&s, from + 90, at) < 0.75 || brightness(&s, from + 90, at - 1) < 0.75);
  assert_near(brightness(&s, from + 95, at), 1, 0.01);
  assert_near(written[length].x, from + 92 + 8, 1);
  cairo_surface_destroy(s.surface);
}

/* ---- particles ---- */

enum { FEW = 6 };
typedef struct Made { /* a body of few particles */
  double x[FEW], y[FEW], depth[FEW], value[FEW], positions[3 * FEW], spacings[FEW];
  uint8_t lattices[FEW];
  ResultView view;
  Scene scene;
} Made;

static const LatticeType *lattice_called(const char *name)
{
  const LatticeType *type = lattice_find(name);
  assert_non_null(type);
  return type;
}

/** Particles with the values 0, 1, 2 ... where `places` says; they are drawn there, too. */
static void make(Made *m, int count, const double places[][3], double spacing, const char *lattice, bool flat)
{
  *m = (Made){.view = a_view()};
  m->scene = (Scene){.count = count,
                     .flat = flat,
                     .range = {0, FEW - 1, false},
                     .unit = {"", 1},
                     .length = {"m", 1},
                     .x0 = INFINITY,
                     .x1 = -INFINITY,
                     .y0 = INFINITY,
                     .y1 = -INFINITY};
  for (int n = 0; n < count; ++n) {
    m->x[n] = places[n][0];
    m->y[n] = places[n][1];
    m->depth[n] = places[n][2];
    memcpy(m->positions + 3 * n, places[n], sizeof places[n]);
    m->value[n] = n;
    m->spacings[n] = spacing;
    const double half = spacing * (flat ? 0.5 : BALL);
    m->scene.x0 = fmin(m->scene.x0, m->x[n] - half);
    m->scene.x1 = larger_of(m->scene.x1, m->x[n] + half);
    m->scene.y0 = fmin(m->scene.y0, m->y[n] - half);
    m->scene.y1 = larger_of(m->scene.y1, m->y[n] + half);
  }
  m->scene.x = m->x;
  m->scene.y = m->y;
  m->scene.depth = m->depth;
  m->scene.value = m->value;
  m->view.particles = count;
  m->view.positions = m->positions;
  m->view.spacings = m->spacings;
  m->view.spacing = spacing;
  m->view.lattice_numbers = m->lattices;
  m->view.lattice_types[0] = lattice_called(lattice);
}

static double page_x(const Made *m, const Sheet *s, double x)
{
  return s->page.left + (x - m->scene.x0) * s->page.scale;
}
static double page_y(const Made *m, const Sheet *s, double y)
{
  return s->page.top + s->page.high - (y - m->scene.y0) * s->page.scale;
}

static void flat_particles_fill_their_part_of_the_plane(void **state)
{
  (void)state;
  const double h = sqrt(3) / 2;
  static const double square[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  const double hexagons[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, h, 0}, {1.5, h, 0}, {2.5, h, 0}};
  Made m;
  for (int hexagonal = 0; hexagonal < 2; ++hexagonal)
    for (int deformed = 0; deformed < 2; ++deformed) {
      make(&m, 6, hexagonal ? hexagons : square, 1, hexagonal ? "hexagonal" : "square", true);
      PictureOptions o = plain;
      o.deformed = deformed;
      Sheet s = draw(&m.scene, &m.view, 0, &o);
      for (int n = 0; n < 6; ++n) { /* in the middle, and nearly half a spacing off it */
        static const double off[][2] = {{0, 0}, {0.42, 0}, {-0.42, 0}, {0, 0.42}, {0, -0.42}, {0.42, 0.42}};
        for (int k = 0; k < (hexagonal ? 5 : 6); ++k)
          has_colour(&s, &m.scene, page_x(&m, &s, m.x[n] + off[k][0]), page_y(&m, &s, m.y[n] + off[k][1]), n, 0.01);
      }
      if (hexagonal) /* the corners of a hexagon that nothing lies beside */
        assert_near(brightness(&s, page_x(&m, &s, -0.45), page_y(&m, &s, 0.45)), 1, 0.01);
      cairo_surface_destroy(s.surface);
    }
  /* stretched threefold along x and sheared: without gaps, each as far as halfway to the next */
  make(&m, 6, square, 1, "square", true);
  for (int n = 0; n < 6; ++n) {
    m.x[n] = 3 * square[n][0] + 0.5 * square[n][1];
    m.y[n] = 0.25 * square[n][0] + 2 * square[n][1];
  }
  m.scene.x0 = -2, m.scene.x1 = 9, m.scene.y0 = -2, m.scene.y1 = 4;
  Sheet s = draw(&m.scene, &m.view, 0, &plain);
  for (int n = 0; n < 6; ++n)
    for (int k = -1; k <= 1; ++k)
      for (int l = -1; l <= 1; ++l)
        has_colour(&s, &m.scene, page_x(&m, &s, m.x[n] + 0.42 * (3 * k + 0.5 * l)),
                   page_y(&m, &s, m.y[n] + 0.42 * (0.25 * k + 2 * l)), n, 0.01);
  assert_near(brightness(&s, page_x(&m, &s, -1.9), page_y(&m, &s, 0.5)), 1, 0.01);
  cairo_surface_destroy(s.surface);
  /* of plates the nearest layer is seen, whichever comes first */
  static const double layers[][3] = {{0, 0, 1}, {1, 0, 0}, {0, 0, 0}, {1, 0, 1}};
  make(&m, 4, layers, 1, "cubic", true);
  PictureOptions o = plain;
  o.deformed = 0;
  s = draw(&m.scene, &m.view, 0, &o);
  has_colour(&s, &m.scene, page_x(&m, &s, 0), page_y(&m, &s, 0), 0, 0.01);
  has_colour(&s, &m.scene, page_x(&m, &s, 1), page_y(&m, &s, 0), 3, 0.01);
  cairo_surface_destroy(s.surface);
  /* a line of particles is as thick as a line must be to be seen */
  double rod[60][3];
  for (int n = 0; n < FEW; ++n) rod[n][0] = 20 * n, rod[n][1] = rod[n][2] = 0;
  make(&m, FEW, (const double(*)[3])rod, 1, "line", true);
  s = draw(&m.scene, &m.view, 0, &plain);
  assert_true(s.page.thick == 16 && s.page.high == 16);
  for (int n = 0; n < FEW; ++n)
    for (int k = 0; k < 3; ++k) has_colour(&s, &m.scene, page_x(&m, &s, 20 * n), s.page.top + 1 + 7 * k, n, 0.01);
  for (int n = 0; n < written_count; ++n) assert_true(strcmp(written[n].words, "y [m]") != 0);
  cairo_surface_destroy(s.surface);
}

/** What has torn off keeps its size, and what nobody can see is not drawn. */
static void torn_particles_keep_their_size(void **state)
{
  (void)state;
  static const double row[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  Made m;
  make(&m, 6, row, 1, "square", true);
  for (int n = 3; n < 6; ++n) m.x[n] += 9; /* a crack opens between the third and the fourth */
  m.scene.x1 += 9;
  Sheet s = draw(&m.scene, &m.view, 0, &plain);
  for (int n = 0; n < 6; ++n) has_colour(&s, &m.scene, page_x(&m, &s, m.x[n]), page_y(&m, &s, 0), n, 0.01);
  for (double x = 2.7; x < 11.4; x += 0.3) assert_near(brightness(&s, page_x(&m, &s, x), page_y(&m, &s, 0)), 1, 0.01);
  cairo_surface_destroy(s.surface);
  m.scene.x1 = 3.5; /* what lies beyond what is shown */
  s = draw(&m.scene, &m.view, 0, &plain);
  for (double x = 2.7; x < 3.5; x += 0.2) assert_near(brightness(&s, page_x(&m, &s, x), page_y(&m, &s, 0)), 1, 0.01);
  cairo_surface_destroy(s.surface);
}

/** The nearest sphere is seen where several lie behind each other; light comes from above on the left. */
static void spheres_hide_each_other_and_are_lit_from_above(void **state)
{
  (void)state;
  static const double places[][3] = {{0, 0, 0}, {0.4, 0, 5}, {3, 0, 5}, {3.4, 0, 0}, {6, 0, 0.1}, {6.9, 0, 0}};
  Made m;
  make(&m, 6, places, 1, "cubic", false);
  for (int n = 0; n < 6; ++n) m.value[n] = n % 2 ? 5 : 2;
  Sheet s = draw(&m.scene, &m.view, 0, &plain);
  double seen[3], near[3];
  for (int k = 0; k < 2; ++k) { /* halfway between two the nearer one has its colour, with its shade */
    scene_colour(&m.scene, k ? 2 : 5, near);
    pixel(&s, page_x(&m, &s, k ? 3.2 : 0.2), page_y(&m, &s, 0), seen);
    for (int c = 0; c < 3; ++c) assert_near(seen[c] / seen[1], near[c] / near[1], 0.1 * near[c] / near[1]);
  }
  for (int k = 0; k < 2; ++k) { /* two that touch at the same depth, nearly: each has its half */
    scene_colour(&m.scene, k ? 5 : 2, near);
    pixel(&s, page_x(&m, &s, k ? 6.6 : 6.3), page_y(&m, &s, 0), seen);
    for (int c = 0; c < 3; ++c) assert_near(seen[c] / seen[1], near[c] / near[1], 0.1 * near[c] / near[1]);
  }
  const double middle = brightness(&s, page_x(&m, &s, 6), page_y(&m, &s, 0)),
               above = brightness(&s, page_x(&m, &s, 5.8), page_y(&m, &s, 0.25)),
               below = brightness(&s, page_x(&m, &s, 6.1), page_y(&m, &s, -0.5)),
               left = brightness(&s, page_x(&m, &s, 5.5), page_y(&m, &s, 0)),
               right = brightness(&s, page_x(&m, &s, 7.4), page_y(&m, &s, 0)),
               there = brightness(&s, page_x(&m, &s, 6.9), page_y(&m, &s, 0));
  assert_true(above > middle && middle > below + 0.03);
  assert_true(left / middle > right / there + 0.03);
  assert_near(brightness(&s, page_x(&m, &s, 6), page_y(&m, &s, 0.7)), 1, 0.01); /* beyond its radius of 0.62 */
  assert_true(brightness(&s, page_x(&m, &s, 6), page_y(&m, &s, 0.58)) < 0.95);
  cairo_surface_destroy(s.surface);
}

/** Bonds that have broken by then are red lines between their particles, but not where a crack stands wide open. */
static void broken_bonds_are_red(void **state)
{
  (void)state;
  static const double places[][3] = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {0, 2, 0}, {2, 2, 0}, {4, 2, 0}};
  int64_t broken[] = {5, 0, 3, 20, 1, 4, 30, 2, 5, 40, 0, 4};
  Made m;
  make(&m, 6, places, 0.5, "square", true);
  m.view.broken = broken;
  m.view.broken_count = 4;
  m.y[5] = 6.1; /* drawn more than twice as far from 2 as they were */
  m.scene.y1 = 6.5;
  PictureOptions o = plain;
  o.broken_bonds = true;
  for (int step = 0; step < 3; ++step) {
    Sheet s = draw(&m.scene, &m.view, step, &o);
    int red[4];
    for (int k = 0; k < 4; ++k) {
      const int64_t a = broken[3 * k + 1], b = broken[3 * k + 2];
      double least = 1, rgb[3];
      for (int dx = -1; dx <= 1; ++dx) { /* a line of 0.6 points falls into one or two pixels */
        pixel(&s, page_x(&m, &s, 0.55 * m.x[a] + 0.45 * m.x[b]) + dx, page_y(&m, &s, 0.55 * m.y[a] + 0.45 * m.y[b]),
              rgb);
        if (rgb[0] > 0.9) least = fmin(least, rgb[1]);
      }
      red[k] = least < 0.93;
    }
    assert_true(red[0] == (step >= 1) && red[1] == (step >= 2) && !red[2] && red[3] == (step >= 2));
    cairo_surface_destroy(s.surface);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_stand_at_what_they_say),
      cmocka_unit_test(words_of_a_picture_tell_what_it_shows),
      cmocka_unit_test(frames_of_a_movie_are_alike),
      cmocka_unit_test(directions_and_a_length_stand_beside_bodies_in_space),
      cmocka_unit_test(flat_particles_fill_their_part_of_the_plane),
      cmocka_unit_test(torn_particles_keep_their_size),
      cmocka_unit_test(spheres_hide_each_other_and_are_lit_from_above),
      cmocka_unit_test(broken_bonds_are_red),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What pictures are made of: ticks, ends of colour bars, units that read well, colours. */
#include "results/colours.h"
#include "results/display_unit.h"
#include "results/picture.h"
#include "results/scale.h"
#include "results/scene.h"
#include "support.h"
#include <hdf5.h>
#include <unistd.h>

/** Runs a model into a folder and opens what it has written. */
static void run_to_view(breccia_model *model, const char *into, ResultView *view)
{
  char path[80];
  const breccia_run run = {.size = sizeof(breccia_run), .folder = into};
  assert_int_equal(breccia_model_run(model, &run, NULL), 0);
  breccia_model_destroy(&model);
  snprintf(path, sizeof path, "%s/results.vtkhdf", into);
  assert_int_equal(result_view_open(view, path, NULL), 0);
}

/** Lightness L* of CIELAB from sRGB (IEC 61966-2-1, CIE 15). */
static double lightness(const double rgb[3])
{
  const double weights[3] = {0.2126, 0.7152, 0.0722};
  double y = 0;
  for (int c = 0; c < 3; ++c)
    y += weights[c] * (rgb[c] <= 0.04045 ? rgb[c] / 12.92 : pow((rgb[c] + 0.055) / 1.055, 2.4));
  return y > 216.0 / 24389 ? 116 * cbrt(y) - 16 : y * 24389 / 27;
}

static void sequential_colours_rise_in_lightness(void **state)
{
  (void)state;
  double last = -1, rgb[3];
  for (int k = 0; k <= 200; ++k) {
    colour_sequential(k / 200.0, rgb);
    for (int c = 0; c < 3; ++c) assert_true(rgb[c] >= 0 && rgb[c] <= 1);
    if (!(lightness(rgb) > last)) fail_msg("at %g the lightness falls from %g to %g", k / 200.0, last, lightness(rgb));
    last = lightness(rgb);
  }
  assert_true(last > 85);
  colour_sequential(0, rgb);
  assert_true(lightness(rgb) < 20);
}

static void diverging_colours_are_equally_light_on_both_sides_of_zero(void **state)
{
  (void)state;
  double last = 100;
  for (int k = 0; k <= 100; ++k) {
    double below[3], above[3];
    colour_diverging(-k / 100.0, below);
    colour_diverging(k / 100.0, above);
    assert_near(lightness(below), lightness(above), 2);
    if (!(lightness(below) < last)) fail_msg("at -%g the colour is no darker than nearer to zero", k / 100.0);
    last = lightness(below);
    if (k > 10) assert_true(below[2] > below[0] + 0.05 && above[0] > above[2] + 0.05); /* blue, red */
  }
  double zero[3];
  colour_diverging(0, zero);
  assert_true(fabs(zero[0] - zero[2]) < 0.02 && lightness(zero) < 93); /* grey that is seen on white paper */
}

static void ticks_are_one_two_or_five_times_a_power_of_ten(void **state)
{
  (void)state;
  const double ranges[] = {1, 0.37, 6.4e-5, 28.7, 9.99e9, 123};
  for (int r = 0; r < 6; ++r)
    for (int number = 2; number < 9; ++number) {
      const double tick = scale_ticks(ranges[r], number), digit = tick / pow(10, floor(log10(tick * (1 + 1e-12))));
      if (fabs(digit - 1) > 1e-9 && fabs(digit - 2) > 1e-9 && fabs(digit - 5) > 1e-9)
        fail_msg("%g in %d parts: ticks %g apart", ranges[r], number, tick);
      assert_true(ranges[r] / tick < 1.76 * number && ranges[r] / tick > number / 1.45);
    }
  const struct {
    double value, distance;
    const char *words;
  } cases[] = {{0.30000000000000004, 0.1, "0.3"},
               {-1e-18, 0.1, "0.0"},
               {20, 5, "20"},
               {0.05, 0.05, "0.05"},
               {-1500, 500, "-1500"}};
  for (int k = 0; k < 5; ++k) {
    char words[32];
    scale_words(cases[k].value, cases[k].distance, words, sizeof words);
    assert_string_equal(words, cases[k].words);
  }
}

static void colour_bars_end_where_they_should(void **state)
{
  (void)state;
  const struct {
    double least, most;
    bool has_sign;
    double given_low, given_high, low, high;
    bool diverging;
  } cases[] = {
      {0, 28.7, false, NAN, NAN, 0, 30, false},            /* a magnitude begins at zero */
      {20, 28.7, false, NAN, NAN, 20, 30, false},          /* unless all of it is far from there */
      {-12, 28.7, false, NAN, NAN, -30, 30, true},         /* both signs: zero in the middle */
      {-28.7, -3, true, NAN, NAN, -30, 0, true},           /* one sign only: one side of the colours */
      {-28.7, 0.01, true, NAN, NAN, -30, 0, true},         /* a trace of the other */
      {0.2, 28.7, true, NAN, NAN, 0, 30, true},            /* tension only, of a stress */
      {0.97, 1.02, true, NAN, NAN, 0.97, 1.02, false},     /* far from zero, like a deformation gradient */
      {0, 0, false, NAN, NAN, 0, 1, false},                /* all zero */
      {0, 0, true, NAN, NAN, -1, 1, true},                 /* all zero, of either sign */
      {7, 7, false, NAN, NAN, 0, 7, false},                /* the same everywhere */
      {-7, -7, true, NAN, NAN, -7, 0, true},               /* the same everywhere, negative */
      {INFINITY, -INFINITY, false, NAN, NAN, 0, 1, false}, /* no number at all */
      {0, 28.7, false, 0, 2000, 0, 2000, false},           /* as asked */
      {-12, 28.7, true, -3, 11, -3, 11, true},             /* as asked, zero still grey */
      {-12, 28.7, true, 3, 11, 3, 11, false},              /* as asked, without zero */
      {0, 28.7, false, 50, NAN, 50, 100, false},           /* the end that was given lies beyond the data */
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const ColourRange r =
        scale_colours(cases[k].least, cases[k].most, cases[k].has_sign, cases[k].given_low, cases[k].given_high);
    if (!(fabs(r.low - cases[k].low) <= 1e-9) || !(fabs(r.high - cases[k].high) <= 1e-9) ||
        r.diverging != cases[k].diverging)
      fail_msg("%g to %g: the bar goes from %g to %g%s", cases[k].least, cases[k].most, r.low, r.high,
               r.diverging ? ", diverging" : "");
  }
}

/** Values of equal size and either sign are equally light, whichever end of the bar is farther from zero, and the farther
 *  end has the darkest colour. */
static void one_scale_holds_for_both_signs(void **state)
{
  (void)state;
  const double ends[][2] = {{-30, 10}, {-10, 30}, {-30, 30}};
  for (size_t k = 0; k < sizeof ends / sizeof *ends; ++k) {
    const Scene scene = {.range = {ends[k][0], ends[k][1], true}};
    const double far = fabs(ends[k][0]) > ends[k][1] ? -1 : 1;
    double last = 100, rgb[3], other[3];
    for (int n = 1; n <= 30; ++n) {
      scene_colour(&scene, far * n, rgb);
      if (!(lightness(rgb) < last)) fail_msg("%g to %g: %g is no darker", ends[k][0], ends[k][1], far * n);
      last = lightness(rgb);
      if (n > 10) continue;
      scene_colour(&scene, -far * n, other);
      assert_near(lightness(other), last, 2);
    }
    colour_diverging(far, other);
    for (int c = 0; c < 3; ++c) assert_near(rgb[c], other[c], 1e-12);
  }
}

static void units_read_well(void **state)
{
  (void)state;
  const struct {
    const char *unit;
    double largest;
    const char *name;
    double factor;
  } cases[] = {{"m", 0.00006227, "µm", 1e6},
               {"m", 0.0628, "mm", 1e3},
               {"m", 1.9, "m", 1},
               {"kPa", 150e3, "MPa", 1e-3},
               {"kPa", 30, "kPa", 1},
               {"kPa", 2e6, "GPa", 1e-6},
               {"kN*m", 1e-3, "J", 1e3},
               {"kN*m", 34, "kJ", 1},
               {"N*mm", 3e3, "J", 1e-3},
               {"N*mm", 3e6, "kJ", 1e-6},
               {"kN*mm", 3e-3, "mJ", 1e3},
               {"N/mm2", 30, "MPa", 1},
               {"N/mm2", 0.03, "kPa", 1e3},
               {"kN/m3", 5000, "MN/m³", 1e-3},
               {"m/s2", 9.81, "m/s²", 1},
               {"s", 0.092, "ms", 1e3},
               {"s", 3600, "s", 1},
               {"cm", 40, "cm", 1},
               {"cm", 0.01, "µm", 1e4},
               {"psi", 1e6, "psi", 1},
               {"lbf/in2", 4000, "lbf/in²", 1},
               {"in", 1e-5, "in", 1},
               {"min", 1e-5, "min", 1},
               {"", 0.5, "", 1},
               {"", 0.03, "%", 100},
               {"", 3e-5, "10⁻⁶", 1e6},
               {"m", 0, "m", 1},
               {"MN", 0.05, "kN", 1e3},
               {"m", INFINITY, "m", 1}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    const DisplayUnit u = display_unit(cases[k].unit, cases[k].largest);
    if (strcmp(u.name, cases[k].name) || !(fabs(u.factor - cases[k].factor) <= 1e-9 * cases[k].factor))
      fail_msg("%g %s is shown as %g %s", cases[k].largest, cases[k].unit, cases[k].largest * u.factor, u.name);
  }
  char heading[64];
  display_heading("stress xx", "MPa", heading, sizeof heading);
  assert_string_equal(heading, "Stress xx [MPa]");
  display_heading("damage", "", heading, sizeof heading);
  assert_string_equal(heading, "Damage");
}

/* ---- whole pictures, of a bar that is pulled more and more ---- */

static char folder[] = "pictures of XXXXXX";

static int run_bar(void **state)
{
  (void)state;
  if (!mkdtemp(folder)) return 1;
  breccia_model *model = model_of(
      "title: bar\nmaterials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [24, 12]}}}}\n"
      "peridynamics: {space: plane stress}\n"
      "loads: [{on: {face: x+}, body force: [0.4, 0], history: {ramp to: 10}},\n"
      "  {on: {face: x-}, body force: [-0.4, 0], history: {ramp to: 10}}]\n"
      "solve: {explicit: {steps: 90, time step: 0.1}}\nresults: {number: 3, fields: [displacement, stress]}\n"
      "pictures: [{field: stress, component: xx, deformed: 3}]\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof(breccia_run), .folder = folder};
  const int bad = breccia_model_run(model, &run, error);
  if (bad) print_error("%s\n", breccia_error_text(error));
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
  return bad;
}

static int remove_bar(void **state)
{
  (void)state;
  char words[80];
  snprintf(words, sizeof words, "rm -r '%s'", folder);
  return system(words);
}

static const PictureOptions of_stress = {
    .field = "stress", .component = "xx", .deformed = 3, .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};

static void open_bar(ResultView *view)
{
  char path[80];
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  assert_int_equal(result_view_open(view, path, NULL), 0);
  assert_int_equal(view->steps, 4);
}

static int differing_pixels(const unsigned char *a, const unsigned char *b, int wide, int high, int from_x)
{
  int count = 0;
  for (int y = 0; y < high; ++y)
    for (int x = from_x; x < wide; ++x) count += memcmp(a + 4 * (y * wide + x), b + 4 * (y * wide + x), 3) != 0;
  return count;
}

/** Whoever gives up closes what may be closed already. */
static void a_closed_file_may_be_closed_again(void **state)
{
  (void)state;
  ResultView view;
  open_bar(&view);
  for (int again = 0; again < 2; ++again) {
    result_view_close(&view);
    assert_true(view.file.id < 0 && !view.times && !view.positions && !view.lattice_numbers);
  }
  assert_int_not_equal(result_view_open(&view, "nowhere.vtkhdf", NULL), 0);
  result_view_close(&view);
}

static void all_times_of_a_field_have_one_colour_bar_and_one_framing(void **state)
{
  (void)state;
  ResultView view;
  open_bar(&view);
  PictureOptions o = of_stress;
  o.one_of_many = true;
  PictureSurvey all, first, last;
  assert_int_equal(picture_survey(&view, 0, 3, true, &o, &all, NULL), 0);
  assert_int_equal(picture_survey(&view, 0, 0, true, &o, &first, NULL), 0);
  assert_int_equal(picture_survey(&view, 3, 3, true, &o, &last, NULL), 0);
  assert_true(first.most == 0 && last.most > 0 && all.most >= last.most);
  assert_true(all.x1 >= last.x1 && last.x1 > first.x1 + 0.1); /* the body grows */
  int wide, high, w, h;
  unsigned char *one = picture_pixels(&view, 0, &o, &all, &wide, &high, NULL);
  unsigned char *other = picture_pixels(&view, 3, &o, &all, &w, &h, NULL);
  assert_true(one && other && w == wide && h == high && wide % 2 == 0 && high % 2 == 0);
  const int bar = wide - 110; /* the bar and its words stand at the right */
  assert_int_equal(differing_pixels(one, other, wide, high, bar), 0);
  assert_true(differing_pixels(one, other, wide, high, 0) > 10000); /* the bodies do differ */
  free(other);
  PictureSurvey own = last;
  own.x0 = all.x0, own.x1 = all.x1, own.y0 = all.y0, own.y1 = all.y1;
  own.most *= 3;
  other = picture_pixels(&view, 3, &o, &own, &w, &h, NULL);
  assert_true(other && w == wide && h == high && differing_pixels(one, other, wide, high, bar) > 0);
  free(one);
  free(other);
  result_view_close(&view);
}

/** Colour in the middle of the drawing: of the particle that stands there. */
static void colour_within(const unsigned char *pixels, int wide, int high, double at[3])
{
  const unsigned char *p = pixels + 4 * ((high * 45 / 100) * wide + wide * 45 / 100);
  for (int c = 0; c < 3; ++c) at[c] = p[2 - c];
}

static void signed_fields_are_grey_at_zero_and_red_in_tension(void **state)
{
  (void)state;
  ResultView view;
  open_bar(&view);
  PictureSurvey all;
  assert_int_equal(picture_survey(&view, 0, 3, false, &of_stress, &all, NULL), 0);
  int w, h;
  double rgb[3];
  unsigned char *pixels = picture_pixels(&view, 0, &of_stress, &all, &w, &h, NULL);
  colour_within(pixels, w, h, rgb);
  assert_near(rgb[0], rgb[2], 6);
  assert_true(rgb[1] > 200 && rgb[1] < 250);
  free(pixels);
  pixels = picture_pixels(&view, 3, &of_stress, &all, &w, &h, NULL);
  colour_within(pixels, w, h, rgb);
  assert_true(rgb[0] > rgb[2] + 30);
  free(pixels);
  result_view_close(&view);
}

static void what_is_no_number_is_grey(void **state)
{
  (void)state;
  ResultView view;
  open_bar(&view);
  const PictureSurvey none = {INFINITY, -INFINITY, NAN, NAN, NAN, NAN};
  int w, h;
  unsigned char *pixels = picture_pixels(&view, 3, &of_stress, &none, &w, &h, NULL); /* a field without any number */
  assert_non_null(pixels);
  free(pixels);
  double rgb[3];
  Scene scene = {.range = {-1, 1, true}, .x1 = 24, .y1 = 12, .missing = 2};
  assert_string_equal(page_lay_out(&scene, &view, 3, &of_stress).notes,
                      "displacements ×3, grey: 2 particles without a number");
  scene.missing = 0;
  assert_string_equal(page_lay_out(&scene, &view, 3, &of_stress).notes, "displacements ×3");
  result_view_close(&view);
  scene_colour(&scene, NAN, rgb);
  assert_true(rgb[0] == rgb[1] && rgb[1] == rgb[2] && rgb[0] < 0.7); /* darker than zero */
}

/** Mirror images beyond a support are no part of the body that people look at; the results keep them. */
static void layers_outside_the_body_are_not_shown(void **state)
{
  (void)state;
  char place[] = "held body of XXXXXX", path[80], words[80];
  assert_non_null(mkdtemp(place));
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [9, 6]}}}}\n"
      "peridynamics: {space: plane stress}\n"
      "loads: [{on: {face: y-}, support: {held: all}}, {gravity: [0.01, -0.1]}]\n"
      "solve: {static: {increments: 1}}\nresults: {number: 1, fields: [displacement]}\npictures: []\n");
  const breccia_run run = {.size = sizeof(breccia_run), .folder = place};
  assert_int_equal(breccia_model_run(model, &run, NULL), 0);
  const Particles *p = model->domain.particles;
  ResultView view;
  snprintf(path, sizeof path, "%s/results.vtkhdf", place);
  assert_int_equal(result_view_open(&view, path, NULL), 0);
  assert_int_equal(view.particles, 9 * 6);
  assert_int_equal(view.rows, p->count);
  assert_true(view.rows > view.particles);
  int components;
  double *u = result_view_read(&view, "displacement", view.steps - 1, &components, NULL, NULL), largest = 0;
  assert_non_null(u);
  int64_t own = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    if (body_outside(&model->domain.body, n)) continue;
    for (int k = 0; k < 2; ++k) {
      assert_true(view.positions[3 * own + k] == p->position[k][p->place_of[n]]);
      assert_near(u[3 * own + k], p->displacement.row[k][p->place_of[n]], 1e-8); /* single precision in the file */
      largest = larger_of(largest, fabs(u[3 * own + k]));
    }
    ++own;
  }
  assert_true(own == view.particles && largest > 1e-4);
  free(u);
  result_view_close(&view);
  breccia_model_destroy(&model);
  snprintf(words, sizeof words, "rm -r '%s'", place);
  assert_int_equal(system(words), 0);
}

/** Fails unless the picture of a body whose turning of 1e-3 is drawn `deformed` times has no gaps within the body. */
static void assert_no_gaps(double spacing, double deformed)
{
  char into[40];
  snprintf(into, sizeof into, "%s/turned", folder);
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: %g, thickness: 1, shape: {box: {particles: [14, 12]}}}}\n"
      "peridynamics: {space: plane stress}\n"
      "loads: [{on: {all: yes}, initial velocity: {rotation: [0, 0, 1]}}]\n"
      "solve: {explicit: {steps: 1, time step: 1e-3}}\nresults: {number: 1, fields: [displacement]}\npictures: []\n",
      spacing);
  ResultView view;
  run_to_view(model, into, &view);
  const PictureOptions o = {
      .field = "displacement", .deformed = deformed, .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
  PictureSurvey all;
  assert_int_equal(picture_survey(&view, 1, 1, true, &o, &all, NULL), 0);
  int wide, high, gaps = 0;
  unsigned char *pixels = picture_pixels(&view, 1, &o, &all, &wide, &high, NULL);
  assert_non_null(pixels);
  const int half = high / 6; /* within the body */
  for (int y = high / 2 - half; y < high / 2 + half; ++y)
    for (int x = wide * 45 / 100 - half; x < wide * 45 / 100 + half; ++x) {
      const unsigned char *p = pixels + 4 * (y * wide + x);
      gaps += p[0] == 255 && p[1] == 255 && p[2] == 255;
    }
  if (gaps) fail_msg("spacing %g, deformed by %g: %d gaps", spacing, deformed, gaps);
  free(pixels);
  result_view_close(&view);
}

/** Particles are drawn with the part of the plane that belongs to them, which turns and grows with its neighbours:
 *  by 63 degrees and 2.2 times, or by 76 degrees and 4.1 times, in any unit of length. */
static void bodies_that_turn_and_grow_have_no_gaps(void **state)
{
  (void)state;
  assert_no_gaps(1, 2e3);
  assert_no_gaps(0.05, 4e3);
  assert_no_gaps(50, 4e3);
}

/* One corner of a block moves a little, the one at large x, small y, large z: its colour tells where it is seen, and that it is hidden
 * from behind. */
static void bodies_in_space_stand_as_they_are_seen(void **state)
{
  (void)state;
  char into[40], path[80];
  snprintf(into, sizeof into, "%s/block", folder);
  breccia_model *model =
      model_of("materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, lattice: cubic, spacing: 1, shape: {box: {from: [0, 0, 0], to: [8, 6, 7]}}}}\n"
               "loads: [{on: {inside: {box: {from: [6, 0, 5], to: [8, 2, 7]}}}, velocity: [0.01, 0, 0]}]\n"
               "solve: {explicit: {steps: 1, time step: 0.01}}\nresults: {number: 1, fields: [displacement]}\n"
               "pictures: []\n");
  Error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof(breccia_run), .folder = into};
  if (breccia_model_run(model, &run, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
  ResultView view;
  snprintf(path, sizeof path, "%s/results.vtkhdf", into);
  assert_int_equal(result_view_open(&view, path, NULL), 0);
  static const struct {
    double azimuth, elevation;
    int right, up;                                /* in which half of the block; 0: not seen */
  } eyes[] = {{-90, 0, 1, 1},                     /* from small y: x goes to the right, z upwards */
              {0, 0, -1, 1},                      /* from large x: y to the right */
              {90, 0, 0, 0},                      /* from large y and from small x: hidden */
              {180, 0, 0, 0},   {-90, 90, 1, -1}, /* from above: y upwards */
              {-90, -90, 0, 0},                   /* from below */
              {-60, 25, 1, 1}};
  for (size_t k = 0; k < sizeof eyes / sizeof *eyes; ++k) {
    const PictureOptions o = {
        .field = "displacement", .azimuth = eyes[k].azimuth, .elevation = eyes[k].elevation, .low = NAN, .high = NAN};
    PictureSurvey all;
    assert_int_equal(picture_survey(&view, 0, 1, true, &o, &all, NULL), 0);
    int wide, high, w, h, count = 0;
    unsigned char *before = picture_pixels(&view, 0, &o, &all, &wide, &high, NULL);
    unsigned char *after = picture_pixels(&view, 1, &o, &all, &w, &h, NULL);
    assert_true(before && after && w == wide && h == high);
    /* The body is what has the colour of zero before: dark, while the page is white. */
    double body[2] = {0}, corner[2] = {0}, inside = 0;
    for (int y = 80; y < high - 60; ++y)
      for (int x = 0; x < wide - 130; ++x) {
        const unsigned char *a = before + 4 * (y * wide + x), *b = after + 4 * (y * wide + x);
        if (a[0] + a[1] + a[2] < 600) body[0] += x, body[1] += y, inside += 1;
        if (abs(a[0] - b[0]) + abs(a[1] - b[1]) + abs(a[2] - b[2]) > 60) corner[0] += x, corner[1] += y, ++count;
      }
    assert_true(inside > 10000);
    if (!eyes[k].right) assert_int_equal(count, 0);
    if (eyes[k].right && (count < 500 || (corner[0] / count - body[0] / inside) * eyes[k].right < 20 ||
                          (corner[1] / count - body[1] / inside) * eyes[k].up > -20))
      fail_msg("from %g, %g: the corner is seen at %g, %g, the block at %g, %g", eyes[k].azimuth, eyes[k].elevation,
               corner[0] / count, corner[1] / count, body[0] / inside, body[1] / inside);
    free(before);
    free(after);
  }
  result_view_close(&view);
}

/** Plates thinner than a fifth of their length are seen from the front, unless somebody wants another view. */
static void thin_plates_are_seen_from_the_front(void **state)
{
  (void)state;
  for (int layers = 2; layers <= 3; ++layers) {
    char into[40];
    snprintf(into, sizeof into, "%s/plate%d", folder, layers);
    breccia_model *model = model_of(
        "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, spacing: 1, shape: {box: {particles: [12, 10, %d]}}}}\n"
        "solve: {explicit: {steps: 1, time step: 1e-3}}\nresults: {number: 1, fields: [damage]}\npictures: []\n",
        layers);
    ResultView view;
    run_to_view(model, into, &view);
    for (int wish = 0; wish < 2; ++wish) {
      const PictureOptions o = {
          .field = "damage", .azimuth = wish ? -60 : NAN, .elevation = NAN, .low = NAN, .high = NAN};
      PictureSurvey s;
      assert_int_equal(picture_survey(&view, 0, 0, true, &o, &s, NULL), 0);
      const bool front = fabs(s.x0) + fabs(s.x1 - 12) + fabs(s.y0) + fabs(s.y1 - 10) < 1e-6;
      assert_true(front == (layers == 2 && !wish));
    }
    result_view_close(&view);
  }
}

/** Beams, thinner along z than a fifth of their length too, are seen from their long side and a little from above, so that their depth shows; strips of
 *  plates are plates. */
static void beams_are_seen_from_their_side(void **state)
{
  (void)state;
  static const struct {
    int particles[3];
    bool plate;
  } bodies[] = {
      {{40, 4, 6}, false}, {{4, 40, 6}, false}, {{40, 10, 4}, false}, {{40, 20, 4}, true}, {{20, 40, 4}, true}};
  for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
    const int *of = bodies[b].particles;
    char into[40];
    snprintf(into, sizeof into, "%s/beam%zu", folder, b);
    breccia_model *model = model_of(
        "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
        "body: {b: {material: m, spacing: 1, shape: {box: {particles: [%d, %d, %d]}}}}\n"
        "solve: {explicit: {steps: 1, time step: 1e-3}}\nresults: {number: 1, fields: [damage]}\npictures: []\n",
        of[0], of[1], of[2]);
    ResultView view;
    run_to_view(model, into, &view);
    const PictureOptions o = {.field = "damage", .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
    PictureSurvey s;
    assert_int_equal(picture_survey(&view, 0, 0, true, &o, &s, NULL), 0);
    const bool front = fabs(s.x1 - s.x0 - of[0]) + fabs(s.y1 - s.y0 - of[1]) < 1e-6;
    if (front != bodies[b].plate || (!front && !(s.x1 - s.x0 > 0.85 * 40 && s.y1 - s.y0 > 0.9 * of[2])))
      fail_msg("body %d by %d by %d: a picture of %g by %g", of[0], of[1], of[2], s.x1 - s.x0, s.y1 - s.y0);
    result_view_close(&view);
  }
}

/** Bodies in the plane have no other side: whatever view is asked for they are seen from the front. */
static void bodies_in_the_plane_are_seen_from_the_front(void **state)
{
  (void)state;
  char into[40];
  snprintf(into, sizeof into, "%s/flat", folder);
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 1, thickness: 1, shape: {box: {particles: [12, 10]}}}}\n"
      "peridynamics: {space: plane stress}\nsolve: {explicit: {steps: 1, time step: 1e-3}}\n"
      "results: {number: 1, fields: [damage]}\npictures: []\n");
  ResultView view;
  run_to_view(model, into, &view);
  assert_true(view.plane);
  for (int wish = 0; wish < 2; ++wish) {
    const PictureOptions o = {
        .field = "damage", .azimuth = wish ? -60 : NAN, .elevation = wish ? 30 : NAN, .low = NAN, .high = NAN};
    PictureSurvey s;
    assert_int_equal(picture_survey(&view, 0, 0, true, &o, &s, NULL), 0);
    assert_near(fabs(s.x0) + fabs(s.x1 - 12) + fabs(s.y0) + fabs(s.y1 - 10), 0, 1e-6);
  }
  result_view_close(&view);
}

/** Whatever the shape of a body, nothing of its page is cut off or stands right at an edge: a margin of 14 is left, more beside what has no words. */
static void pages_have_margins_on_all_sides(void **state)
{
  (void)state;
  static const struct {
    const char *name, *particles;
    bool space;
  } bodies[] = {{"block", "[12, 10]", false},
                {"wide", "[60, 5]", false},
                {"tall", "[5, 40]", false},
                {"solid", "[9, 6, 5]", true}};
  for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
    char into[40];
    snprintf(into, sizeof into, "%s/margins-%s", folder, bodies[b].name);
    breccia_model *model =
        model_of("materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
                 "body: {b: {material: m, %sspacing: 1, shape: {box: {particles: %s}}}}\n"
                 "peridynamics: {space: %s}\nsolve: {explicit: {steps: 1, time step: 1e-3}}\n"
                 "loads: [{on: {all: yes}, initial velocity: {translation: [1, 0%s]}}]\n"
                 "results: {number: 1, fields: [velocity]}\npictures: []\n",
                 bodies[b].space ? "" : "lattice: square, thickness: 1, ", bodies[b].particles,
                 bodies[b].space ? "3-D" : "plane stress", bodies[b].space ? ", 0" : "");
    ResultView view;
    run_to_view(model, into, &view);
    const PictureOptions o = {
        .field = "velocity", .component = "x", .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
    PictureSurvey survey;
    int wide, high, left = 1 << 20, right = 0, top = -1, bottom = 0;
    assert_int_equal(picture_survey(&view, 1, 1, true, &o, &survey, NULL), 0);
    unsigned char *pixels = picture_pixels(&view, 1, &o, &survey, &wide, &high, NULL);
    assert_non_null(pixels);
    for (int y = 0; y < high; ++y)
      for (int x = 0; x < wide; ++x) {
        const unsigned char *at = pixels + 4 * (y * wide + x);
        if (at[0] + at[1] + at[2] > 740) continue;
        if (top < 0) top = y;
        bottom = y;
        left = x < left ? x : left;
        right = x > right ? x : right;
      }
    const int room[4] = {left, wide - 1 - right, top, high - 1 - bottom};
    for (int k = 0; k < 4; ++k) assert_true(room[k] >= 9 && room[k] <= 32);
    free(pixels);
    result_view_close(&view);
  }
}

/** A body so narrow that no round number lies on its axis, as from 1.1 to 3.1, has a number there all the same: the words from below are the axis' name,
 *  numbers, and then the body in its frame. */
static void narrow_bodies_have_a_number_on_their_axis(void **state)
{
  (void)state;
  char into[40];
  snprintf(into, sizeof into, "%s/narrow", folder);
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 100, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, thickness: 1, spacing: 1, shape: {box: {particles: [2, 60], first "
      "particle: [1.6, 0.5]}}}}\n"
      "peridynamics: {space: plane stress}\nsolve: {explicit: {steps: 1, time step: 1e-3}}\n"
      "results: {number: 1, fields: [damage]}\npictures: []\n");
  ResultView view;
  run_to_view(model, into, &view);
  const PictureOptions o = {.field = "damage", .azimuth = NAN, .elevation = NAN, .low = NAN, .high = NAN};
  PictureSurvey survey;
  int wide, high, tall[3] = {0}, group = -1;
  assert_int_equal(picture_survey(&view, 0, 0, true, &o, &survey, NULL), 0);
  unsigned char *pixels = picture_pixels(&view, 0, &o, &survey, &wide, &high, NULL);
  assert_non_null(pixels);
  bool dark = false;
  for (int y = high - 1; y >= 0 && group < 3; --y) {
    const bool before = dark;
    dark = false;
    for (int x = 0; x < wide; ++x) {
      const unsigned char *at = pixels + 4 * (y * wide + x);
      dark |= at[0] + at[1] + at[2] < 740;
    }
    if (dark && !before) ++group;
    if (dark && group < 3) ++tall[group];
  }
  free(pixels);
  result_view_close(&view);
  assert_true(tall[0] < 20 && tall[1] < 20 && tall[2] > 200);
}

/** Every dataset that results.xdmf names is there and holds the step's numbers. */
static void xdmf_names_a_whole_dataset_for_every_step(void **state)
{
  (void)state;
  ResultView view;
  open_bar(&view);
  char path[80];
  snprintf(path, sizeof path, "%s/results.xdmf", folder);
  char *xdmf = text_read_file(path, NULL);
  assert_non_null(xdmf);
  assert_null(strstr(xdmf, "HyperSlab")); /* which meshio cannot read */
  for (int k = 0; k < view.steps; ++k) {
    char name[96];
    int components;
    snprintf(name, sizeof name, "results.vtkhdf:/Breccia/States/%lld/stress<", (long long)view.step_numbers[k]);
    char *field = strstr(xdmf, name), *begin = NULL, time[64];
    assert_non_null(field);
    snprintf(time, sizeof time, "<Grid Name=\"step %lld\"", (long long)view.step_numbers[k]);
    begin = strstr(xdmf, time);
    assert_true(begin && begin < field);
    assert_near(strtod(strstr(begin, "Time Value=\"") + strlen("Time Value=\""), NULL), view.times[k], 0);
    double *expected = result_view_read(&view, "stress", k, &components, NULL, NULL);
    double *found = calloc((size_t)view.particles * 6, sizeof *found);
    name[strlen(name) - 1] = 0;
    hid_t set = H5Dopen2(view.file.id, strchr(name, ':') + 1, H5P_DEFAULT), space = H5Dget_space(set);
    assert_int_equal(H5Sget_simple_extent_npoints(space), view.particles * 6);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, found) >= 0);
    assert_memory_equal(found, expected, sizeof *found * (size_t)view.particles * 6);
    H5Sclose(space);
    H5Dclose(set);
    free(found);
    free(expected);
  }
  free(xdmf);
  result_view_close(&view);
}

static void names_of_pictures_are_short(void **state)
{
  (void)state;
  double times[] = {0, 0.036, 0.0792, 0.0912}, micro[] = {0, 2.5e-6};
  ResultView view = {.times = times, .steps = 4, .time_unit = "s"};
  char words[96];
  picture_name(&view, 2, "damage", NULL, true, words, sizeof words);
  assert_string_equal(words, "damage-79.2ms");
  picture_name(&view, 1, "stress", "xx", true, words, sizeof words);
  assert_string_equal(words, "stress-xx-36ms");
  picture_name(&view, 3, "stress", "xx", false, words, sizeof words);
  assert_string_equal(words, "stress-xx");
  picture_time(&view, 2, false, words, sizeof words);
  assert_string_equal(words, "79.2 ms");
  view.times = micro;
  view.steps = 2;
  picture_name(&view, 1, "damage", NULL, true, words, sizeof words);
  assert_string_equal(words, "damage-2.5us");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sequential_colours_rise_in_lightness),
      cmocka_unit_test(diverging_colours_are_equally_light_on_both_sides_of_zero),
      cmocka_unit_test(ticks_are_one_two_or_five_times_a_power_of_ten),
      cmocka_unit_test(colour_bars_end_where_they_should),
      cmocka_unit_test(one_scale_holds_for_both_signs),
      cmocka_unit_test(units_read_well),
      cmocka_unit_test(a_closed_file_may_be_closed_again),
      cmocka_unit_test(all_times_of_a_field_have_one_colour_bar_and_one_framing),
      cmocka_unit_test(signed_fields_are_grey_at_zero_and_red_in_tension),
      cmocka_unit_test(what_is_no_number_is_grey),
      cmocka_unit_test(layers_outside_the_body_are_not_shown),
      cmocka_unit_test(bodies_that_turn_and_grow_have_no_gaps),
      cmocka_unit_test(bodies_in_space_stand_as_they_are_seen),
      cmocka_unit_test(thin_plates_are_seen_from_the_front),
      cmocka_unit_test(beams_are_seen_from_their_side),
      cmocka_unit_test(bodies_in_the_plane_are_seen_from_the_front),
      cmocka_unit_test(pages_have_margins_on_all_sides),
      cmocka_unit_test(narrow_bodies_have_a_number_on_their_axis),
      cmocka_unit_test(xdmf_names_a_whole_dataset_for_every_step),
      cmocka_unit_test(names_of_pictures_are_short),
  };
  return cmocka_run_group_tests(tests, run_bar, remove_bar);
}

/* Reinforcing bars in results and pictures: what is written at every state, taken up again by a restart, and drawn where it stands. */
#include "support.h"

#include "bars/bars.h"
#include "results/bar_columns.h"
#include "results/bar_curve.h"
#include "results/result_file.h"
#include "results/scene.h"
#include <unistd.h>

static char folder[] = "/tmp/breccia-bar-pictures-XXXXXX";

enum { INCREMENTS = 8 };
#define STRETCH 0.001

/** A plate that is stretched along x and pressed along y, evenly and as time goes on, with a bar each way: the first far off and thin in the picture. */
static breccia_model *stretched(void)
{
  return model_of(
      "title: Plate\nunits: {length: m, force: kN, time: s}\n"
      "materials:\n"
      "  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
      "  steel: {model: steel-bilinear, density: 7.85, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01}\n"
      "body: {b: {material: soft, lattice: square, spacing: 0.05, thickness: 0.1, shape: {box: {from: [0, 0], to: [2, "
      "0.6]}}}}\n"
      "bars:\n"
      "  along: {points: [[0.2, 0.2], [1.8, 0.2]], diameter: 0.01, material: steel, bond: {law: linear, stiffness: "
      "1.4e7}}\n"
      "  across: {points: [[0.5, 0.1], [0.5, 0.5]], area: 2e-4, material: steel, repeat: {along: [1, 0], pitch: 0.5, "
      "number: 2}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress}\n"
      "loads: [{on: {all: yes}, field: {displacement: ['%g*x', '-%g*y']}, history: {ramp to: 1}}]\n"
      "solve: {static: {increments: %d, end time: 1}}\nresults: {number: 4, precision: double}\npictures: []\n",
      STRETCH, STRETCH, (int)INCREMENTS);
}

static char *inside(const char *name)
{
  return text_format("%s/%s", folder, name);
}

static void run_to(breccia_model *m, const char *name, int64_t steps, int restart)
{
  Error *error = breccia_error_create();
  char *path = inside(name);
  const breccia_run run = {.size = sizeof run, .folder = path, .steps = steps, .restart = restart};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(path);
}

static void open_view(ResultView *view, const char *name)
{
  char *path = text_format("%s/%s/results.vtkhdf", folder, name);
  Error *error = breccia_error_create();
  if (result_view_open(view, path, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  free(path);
}

static int begin(void **state)
{
  (void)state;
  if (!mkdtemp(folder)) return 1;
  breccia_model *m = stretched();
  run_to(m, "whole", 0, BRECCIA_RESTART_NO);
  breccia_model_destroy(&m);
  return 0;
}

static int end(void **state)
{
  (void)state;
  char *command = text_format("rm -r %s", folder);
  const int bad = system(command);
  free(command);
  return bad;
}

static double *column(const BarView *bars, const ResultView *view, const char *name, int step, char unit[64])
{
  Error *error = breccia_error_create();
  double *values = bar_view_read(bars, view, name, step, unit, error);
  if (!values) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return values;
}

/** Strains of the field, at each time; bars in perfect bond have no slip, and one with linear bond has the strain e (1 - cosh(lambda x) / cosh(lambda l))
 *  at x from its middle, with lambda^2 = stiffness of bond times perimeter / (E A). */
static void every_state_has_bars_as_they_were_then(void **state)
{
  (void)state;
  ResultView view;
  BarView bars;
  char unit[64];
  open_view(&view, "whole");
  assert_int_equal(view.steps, 5);
  assert_int_equal(bar_view_open(&bars, &view, NULL), 0);
  assert_int_equal(bars.lines, 3);
  assert_string_equal(bars.name[0], "along");
  assert_string_equal(bars.name[2], "across 2");
  double *along = bar_view_along(&bars, NULL);
  assert_near(along[bars.first[1] - 1] + along[0], 1.6, 1e-9);
  assert_near(along[bars.first[3] - 1] + along[bars.first[2]], 0.4, 1e-9);
  free(along);
  for (int step = 0; step < view.steps; ++step) {
    const double time = view.times[step], strain = STRETCH * time;
    double *u = bar_view_displacements(&bars, &view, step, NULL);
    for (int64_t k = 0; k < bars.nodes; ++k) {
      assert_near(u[3 * k], strain * bars.points[3 * k], 1e-12);
      assert_near(u[3 * k + 1], -strain * bars.points[3 * k + 1], 1e-12);
      assert_near(u[3 * k + 2], 0, 0);
    }
    double *e = column(&bars, &view, "strain", step, unit);
    assert_string_equal(unit, "");
    double *s = column(&bars, &view, "stress", step, unit);
    assert_string_equal(unit, "kPa");
    double *f = column(&bars, &view, "force", step, unit), *slip = column(&bars, &view, "slip", step, unit);
    assert_string_equal(unit, "m");
    double *bond = column(&bars, &view, "bond stress", step, unit);
    for (int64_t n = bars.first[1]; n < bars.elements; ++n) {
      assert_near(e[n], -strain, 1e-6 * STRETCH);
      assert_near(s[n], 2e8 * e[n], 1e-6);
      assert_near(f[n], 2e-4 * s[n], 1e-9);
      assert_near(slip[n], 0, 0);
      assert_near(bond[n], 0, 0);
    }
    const double lambda = sqrt(1.4e7 * 4 / (2e8 * 0.01)), half = cosh(lambda * 0.8);
    for (int64_t n = 0; n < bars.first[1]; ++n) {
      const double x = bars.points[3 * n] + 0.025 - 1;
      assert_near(e[n], strain * (1 - cosh(lambda * x) / half), 0.01 * strain);
      assert_near(slip[n], -strain * sinh(lambda * x) / (lambda * half), 0.01 * strain / lambda);
      assert_near(bond[n], 1.4e7 * slip[n], 0.01 * 1.4e7 * strain / lambda);
    }
    free(u), free(e), free(s), free(f), free(slip), free(bond);
  }
  bar_view_close(&bars);
  result_view_close(&view);
}

/** The last state is what the model holds, to the bit. */
static void the_last_state_is_that_of_the_model(void **state)
{
  (void)state;
  breccia_model *m = stretched();
  ResultView view;
  BarView bars;
  open_view(&view, "whole");
  assert_int_equal(bar_view_open(&bars, &view, NULL), 0);
  step_surely(m, INT64_MAX);
  const Bars *b = bars_among(&m->domain.forces);
  const BarColumn *c;
  for (int k = 0; (c = bar_column_at(k)); ++k) {
    char unit[64];
    double *values = column(&bars, &view, c->name, view.steps - 1, unit);
    for (int n = 0; n < bars.lines; ++n)
      for (int64_t e = bars.first[n]; e < bars.first[n + 1]; ++e) assert_true(values[e] == c->value(b, n, e));
    free(values);
  }
  bar_view_close(&bars);
  result_view_close(&view);
  breccia_model_destroy(&m);
}

/** Stopped behind a state that was due, and between two: after a restart the same states, each once. */
static void a_restart_goes_on_with_the_states_of_bars(void **state)
{
  (void)state;
  for (int stop = 3; stop <= 4; ++stop) {
    breccia_model *m = stretched();
    run_to(m, "parts", stop, BRECCIA_RESTART_NO);
    breccia_model_destroy(&m);
    m = stretched();
    run_to(m, "parts", 0, BRECCIA_RESTART_LAST);
    breccia_model_destroy(&m);
    ResultView view[2];
    BarView bars[2];
    open_view(&view[0], "whole");
    open_view(&view[1], "parts");
    for (int k = 0; k < 2; ++k) assert_int_equal(bar_view_open(&bars[k], &view[k], NULL), 0);
    assert_int_equal(view[1].steps, view[0].steps);
    for (int step = 0; step < view[0].steps; ++step)
      for (int c = 0; bar_column_at(c); ++c) {
        char unit[64];
        double *a = column(&bars[0], &view[0], bar_column_at(c)->name, step, unit),
               *b = column(&bars[1], &view[1], bar_column_at(c)->name, step, unit);
        assert_memory_equal(a, b, sizeof(double) * (size_t)bars[0].elements);
        free(a), free(b);
      }
    for (int k = 0; k < 2; ++k) {
      bar_view_close(&bars[k]);
      result_view_close(&view[k]);
    }
  }
}

/** States behind the one that a run goes on from are gone, of bars too. */
static void states_that_are_cut_off_take_those_of_bars_along(void **state)
{
  (void)state;
  breccia_model *m = stretched();
  run_to(m, "cut", 0, BRECCIA_RESTART_NO);
  const char *const fields[] = {"displacement"};
  const ResultNames names = {.fields = fields, .count = 1};
  char *path = inside("cut");
  ResultFile *file;
  assert_int_equal(result_file_resume(&file, path, &m->domain, m->units, "Plate", &names, INCREMENTS / 2, NULL), 0);
  result_file_destroy(&file);
  free(path);
  breccia_model_destroy(&m);
  ResultView view;
  BarView bars;
  open_view(&view, "cut");
  assert_int_equal(view.steps, 3);
  assert_int_equal(bar_view_open(&bars, &view, NULL), 0);
  int64_t rows = 0;
  free(result_view_numbers(&view, "Breccia/Bars/displacement", H5T_NATIVE_DOUBLE, sizeof(double), &rows, NULL));
  assert_int_equal(rows, 3 * bars.nodes);
  for (int c = 0; bar_column_at(c); ++c) {
    char *name = text_format("Breccia/Bars/%s", bar_column_at(c)->name);
    free(result_view_numbers(&view, name, H5T_NATIVE_DOUBLE, sizeof(double), &rows, NULL));
    assert_int_equal(rows, 3 * bars.elements);
    free(name);
  }
  bar_view_close(&bars);
  result_view_close(&view);
}

/** Nodes stand at X + factor u in the picture, and it reaches around all of them, also where particles are left out. */
static void bars_move_with_the_body_and_stay_in_the_picture(void **state)
{
  (void)state;
  ResultView view;
  open_view(&view, "whole");
  Box box = {.from = {1.4, -1}, .to = {1.62, 1}, .particles = {-1, -1, -1}};
  const Shape shape = {.box = &box};
  for (int cut = 0; cut < 2; ++cut)
    for (double factor = 0; factor < 301; factor += 150) {
      const PictureOptions o = {.bars = "stress",
                                .deformed = factor,
                                .azimuth = NAN,
                                .elevation = NAN,
                                .low = NAN,
                                .high = NAN,
                                .inside = cut ? &shape : NULL};
      PictureSurvey survey;
      assert_int_equal(picture_survey(&view, view.steps - 1, view.steps - 1, true, &o, &survey, NULL), 0);
      Scene scene = {.flat = true, .right = {1, 0, 0}, .up = {0, 1, 0}, .eye = {0, 0, 1}};
      assert_int_equal(scene_bars_create(&scene, &view, &o, NULL), 0);
      assert_int_equal(scene_bars_place(&scene, &view, view.steps - 1, factor, NULL), 0);
      const BarView *b = &scene.bars.view;
      int shown = 0;
      for (int n = 0; n < b->lines; ++n)
        for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
          const double middle = (b->points[3 * (e + n)] + b->points[3 * (e + n + 1)]) / 2;
          assert_int_equal(scene.bars.hidden[e], cut && (middle < 1.4 || middle > 1.62));
          if (scene.bars.hidden[e]) continue;
          ++shown;
          for (int64_t k = e + n; k <= e + n + 1; ++k) {
            const double x = b->points[3 * k] * (1 + factor * STRETCH),
                         y = b->points[3 * k + 1] * (1 - factor * STRETCH);
            assert_near(scene.bars.x[k], x, 1e-9);
            assert_near(scene.bars.y[k], y, 1e-9);
            assert_true(x > survey.x0 && x < survey.x1 && y > survey.y0 && y < survey.y1);
          }
        }
      assert_true(shown > (cut ? 3 : 40));
      if (!cut) assert_near(survey.most, 2e5 * (1 - 1 / cosh(sqrt(1.4e7 * 4 / (2e8 * 0.01)) * 0.8)), 0.01 * 2e5);
      if (!cut) assert_near(survey.least, -2e5, 1);
      scene_bars_destroy(&scene);
    }
  result_view_close(&view);
}

/** Pixels that are red or blue in the drawing. */
static void count_colours(const unsigned char *pixels, int wide, int high, int *red, int *blue)
{
  *red = *blue = 0;
  for (int y = 70; y < high - 90; ++y) /* words are above, the colour bar below */
    for (int x = 0; x < wide; ++x) {
      const unsigned char *p = pixels + 4 * ((size_t)y * (size_t)wide + (size_t)x);
      *red += p[2] > p[0] + 60;
      *blue += p[0] > p[2] + 60;
    }
}

/** What is stretched is red and what is pressed blue, as long and as wide as it should be; the body has no colour. */
static void bars_are_drawn_in_their_colours_over_a_pale_body(void **state)
{
  (void)state;
  ResultView view;
  open_view(&view, "whole");
  PictureOptions o = {.bars = "stress", .deformed = 1, .azimuth = NAN, .elevation = NAN, .low = -1e5, .high = 1e5};
  int wide, high, red, blue;
  unsigned char *pixels = picture_pixels(&view, view.steps - 1, &o, NULL, &wide, &high, NULL);
  assert_non_null(pixels);
  count_colours(pixels, wide, high, &red, &blue);
  free(pixels);
  const double scale = 640 / 2.0, width = 3; /* pixels a metre; of a line */
  assert_near(red, 1.6 * scale * width, 0.15 * 1.6 * scale * width);
  assert_near(blue, 2 * 0.4 * scale * width,
              0.3 * 2 * 0.4 * scale * width); /* edges of upright lines fall between pixels */
  o.low = 1e5;                                /* colours of a scale that has no grey */
  o.high = 2e5;
  pixels = picture_pixels(&view, view.steps - 1, &o, NULL, &wide, &high, NULL);
  assert_non_null(pixels);
  int pale = 0;
  for (int64_t k = 0; k < (int64_t)wide * high; ++k) /* as cairo rounds 0.88 and 0.9 */
    pale += abs(pixels[4 * k] - 230) < 3 && abs(pixels[4 * k + 1] - 224) < 3 && abs(pixels[4 * k + 2] - 224) < 3;
  assert_true(pale > 0.95 * 640 * 192 - 2 * red - 2 * blue && pale < 640 * 194);
  free(pixels);
  o.bars = "slip";
  o.low = o.high = NAN;
  pixels = picture_pixels(&view, 0, &o, NULL, &wide, &high, NULL); /* nothing has slipped: no colours */
  assert_non_null(pixels);
  count_colours(pixels, wide, high, &red, &blue);
  assert_int_equal(red + blue, 0);
  free(pixels);
  result_view_close(&view);
}

/** Of two bars behind each other the nearer one is seen: a stretched one from the one side, a pressed one from the
 *  other. */
static void bars_in_front_hide_those_behind(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "title: Prism\nunits: {length: m, force: kN, time: s}\n"
      "materials:\n"
      "  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
      "  steel: {model: elastic-1d, density: 7.85, Young modulus: 2e8}\n"
      "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1, 0.3, 0.2]}}}}\n"
      "bars:\n"
      "  near: {points: [[0.2, 0.05, 0.1], [0.8, 0.05, 0.1]], diameter: 0.01, material: steel}\n"
      "  far: {points: [[0.2, 0.25, 0.1], [0.8, 0.25, 0.1]], diameter: 0.01, material: steel}\n"
      "peridynamics: {formulation: bond-based, horizon: 1.5 spacings}\n"
      "loads: [{on: {all: yes}, field: {displacement: ['1e-3 * x * (0.15 m - y) / 0.1 m', 0, 0]}, history: {ramp to: "
      "1}}]\n"
      "solve: {static: {increments: 1, end time: 1}}\nresults: {number: 1, precision: double}\npictures: []\n");
  run_to(m, "prism", INT64_MAX, 0);
  breccia_model_destroy(&m);
  ResultView view;
  open_view(&view, "prism");
  for (int side = 0; side < 2; ++side) {
    const PictureOptions o = {
        .bars = "stress", .deformed = 1, .azimuth = side ? 90 : -90, .elevation = 0, .low = -1e5, .high = 1e5};
    int wide, high, red, blue;
    unsigned char *pixels = picture_pixels(&view, view.steps - 1, &o, NULL, &wide, &high, NULL);
    assert_non_null(pixels);
    count_colours(pixels, wide, high, &red, &blue);
    free(pixels);
    print_message("from side %d: %d red, %d blue\n", side, red, blue);
    assert_true((side ? blue : red) > 200 && (side ? red : blue) < 20);
  }
  result_view_close(&view);
}

static void wrong_wishes_are_told(void **state)
{
  (void)state;
  ResultView view;
  BarView bars;
  open_view(&view, "whole");
  Error *error = breccia_error_create();
  char unit[64];
  assert_int_equal(bar_view_open(&bars, &view, NULL), 0);
  assert_null(bar_view_read(&bars, &view, "Lines", 0, unit, error));
  holds_words(breccia_error_text(error), "bars have no 'Lines'|it holds strain, stress, force, dissipated, slip, bond "
                                         "stress of them");
  bar_view_close(&bars);
  const int steps[7] = {0};
  const BarCurveOptions o = {.column = "stress", .steps = steps, .count = 7, .low = NAN, .high = NAN};
  assert_int_equal(bar_curve_draw(&view, &o, "/tmp/none.png", error), BRECCIA_USER_ERROR);
  holds_words(breccia_error_text(error), "at up to 6 times, and these are 7");
  breccia_error_destroy(&error);
  result_view_close(&view);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_state_has_bars_as_they_were_then),
      cmocka_unit_test(the_last_state_is_that_of_the_model),
      cmocka_unit_test(a_restart_goes_on_with_the_states_of_bars),
      cmocka_unit_test(states_that_are_cut_off_take_those_of_bars_along),
      cmocka_unit_test(bars_move_with_the_body_and_stay_in_the_picture),
      cmocka_unit_test(bars_are_drawn_in_their_colours_over_a_pale_body),
      cmocka_unit_test(bars_in_front_hide_those_behind),
      cmocka_unit_test(wrong_wishes_are_told),
  };
  return cmocka_run_group_tests(tests, begin, end);
}

/* Pictures of a part of a body: what lies inside a body in space is seen there, and what is left out has no say in colours and frame. */
#include "results/picture.h"
#include "results/scene.h"
#include "support.h"
#include <unistd.h>

/** A block of 8 x 6 x 6 with a core of 2 x 2 x 2 that alone moves, along x, with 1; its shell's corner at the end moves with 3. */
static void open_block(ResultView *view)
{
  char folder[] = "cut open XXXXXX", path[80], words[80];
  assert_non_null(mkdtemp(folder));
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 1e-9, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [8, 6, 6]}}}}\n"
      "loads:\n"
      "  - {on: {inside: {box: {from: [3, 2, 2], to: [5, 4, 4]}}}, initial velocity: {translation: [1, 0, 0]}}\n"
      "  - {on: {inside: {box: {from: [7, 5, 5], to: [8, 6, 6]}}}, initial velocity: {translation: [3, 0, 0]}}\n"
      "solve: {explicit: {steps: 1, time step: 1e-3}}\nresults: {number: 1, fields: [velocity]}\npictures: []\n");
  const breccia_run run = {.size = sizeof(breccia_run), .folder = folder};
  assert_int_equal(breccia_model_run(model, &run, NULL), 0);
  breccia_model_destroy(&model);
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  assert_int_equal(result_view_open(view, path, NULL), 0);
  snprintf(words, sizeof words, "rm -r '%s'", folder); /* the file stays open */
  assert_int_equal(system(words), 0);
}

/** Pixels that are nearly as red as a value of 1 between -1 and 1 makes them, below the page's words and left of its bar. */
static int strong_pixels(const ResultView *view, const PictureOptions *o)
{
  PictureSurvey survey;
  int wide, high, count = 0;
  assert_int_equal(picture_survey(view, 1, 1, false, o, &survey, NULL), 0);
  unsigned char *pixels = picture_pixels(view, 1, o, &survey, &wide, &high, NULL);
  assert_non_null(pixels);
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide * 3 / 4; ++x) {
      const unsigned char *at = pixels + 4 * (y * wide + x);
      count += at[2] > at[0] + 80 && at[2] > at[1] + 80;
    }
  free(pixels);
  return count;
}

static void what_lies_inside_a_body_is_seen_where_it_is_cut_open(void **state)
{
  (void)state;
  ResultView view;
  open_block(&view);
  Box half = {.from = {0, 3, 0}, .to = {7, 6, 6}, .particles = {-1, -1, -1}};
  const Shape shape = {.box = &half};
  PictureOptions o = {.field = "velocity", .component = "x", .azimuth = -90, .elevation = 0, .low = -1, .high = 1};
  const int closed = strong_pixels(&view, &o);
  o.inside = &shape;
  const int open = strong_pixels(&view, &o);
  if (closed > 0 || open < 500)
    fail_msg("the core takes %d pixels of a closed body and %d of half of it", closed, open);
  result_view_close(&view);
}

static void what_is_left_out_has_no_say_in_colours_and_frame(void **state)
{
  (void)state;
  ResultView view;
  open_block(&view);
  Box half = {.from = {-INFINITY, 3, -INFINITY}, .to = {7, INFINITY, INFINITY}, .particles = {-1, -1, -1}};
  const Shape shape = {.box = &half};
  PictureOptions o = {.field = "velocity", .component = "x", .azimuth = -90, .elevation = 0, .low = NAN, .high = NAN};
  PictureSurvey whole, part;
  assert_int_equal(picture_survey(&view, 1, 1, true, &o, &whole, NULL), 0);
  o.inside = &shape;
  assert_int_equal(picture_survey(&view, 1, 1, true, &o, &part, NULL), 0);
  assert_near(whole.most, 3, 1e-6);
  assert_near(part.most, 1, 1e-6);
  assert_near((whole.x1 - whole.x0) - (part.x1 - part.x0), 1, 0.01); /* one layer less, seen from y- */
  assert_near((whole.y1 - whole.y0) - (part.y1 - part.y0), 0, 0.01);

  half.from[1] = 100; /* nothing is there */
  breccia_error *error = breccia_error_create();
  assert_int_equal(picture_survey(&view, 1, 1, true, &o, &part, error), BRECCIA_USER_ERROR);
  assert_string_equal(breccia_error_text(error), "inside: none of the 288 particles stands in this shape");
  breccia_error_destroy(&error);
  result_view_close(&view);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_lies_inside_a_body_is_seen_where_it_is_cut_open),
      cmocka_unit_test(what_is_left_out_has_no_say_in_colours_and_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

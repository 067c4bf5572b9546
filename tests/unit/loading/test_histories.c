/* Histories: factors, and integrals of them over time, against closed forms. */
#include "support.h"

#include <unistd.h>

#define DECK                                                                                                           \
  "units: {length: m, force: kN, time: ms}\n"                                                                          \
  "materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}\n"                                              \
  "body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [8, 1], first "        \
  "particle: [0.025, 0]}}}}\n"                                                                                         \
  "peridynamics: {formulation: bond-based, space: 1-D}\n"                                                              \
  "solve: {explicit: {steps: 1}}\n"

static breccia_model *with_history(const char *history)
{
  return model_of(DECK "loads: [{on: {face: x+}, velocity: [1, 0], history: {%s}}]\n", history);
}

static History *history_of(breccia_model *m)
{
  return &m->loading.loads[0].history;
}

/** Factor, integral and its integral of a sine of the angular frequency w that begins with the angle a, after a time t. */
static void sine(double w, double a, double t, double values[3])
{
  values[0] = sin(w * t + a);
  values[1] = (cos(a) - cos(w * t + a)) / w;
  values[2] = cos(a) * t / w - (sin(w * t + a) - sin(a)) / (w * w);
}

static void assert_values(History *h, double time, const double expected[3], double tolerance)
{
  const double found[] = {history_factor(h, time), history_integral(h, 1, 1, time), history_integral(h, 2, 1, time)};
  for (int k = 0; k < 3; ++k) assert_near(found[k], expected[k], tolerance);
}

static void integrals_are_those_of_the_closed_forms(void **state)
{
  (void)state;
  const double pi = acos(-1), w = 2 * pi * 0.5; /* 500 Hz in 1/ms */
  breccia_model *ramp = with_history("ramp to: 2"), *table = with_history("table: [[1, 0], [3, 4], [5, 1]]"),
                *constant = with_history("constant: yes"),
                *plain = with_history("sine: {frequency: 500 Hz, phase: 30}");
  for (double t = 0.05; t < 8; t += 0.73) {
    const double r = fmin(t, 2), beyond = fmax(0, t - 2);
    assert_values(history_of(ramp), t,
                  (double[]){r / 2, r * r / 4 + beyond, r * r * r / 12 + beyond + beyond * beyond / 2}, 1e-13 * t * t);
    assert_values(history_of(constant), t, (double[]){1, t, t * t / 2}, 1e-13 * t * t);
    double expected[3];
    sine(w, pi / 6, t, expected);
    assert_values(history_of(plain), t, expected, 1e-11);
  }
  /* The table: 0 up to 1, then 2 (t - 1), then 4 - 1.5 (t - 3), then 1. Integrals at 3: 4 and 8/3; at 5: 9 and 8/3 + 8 + 8 - 2. */
  assert_values(history_of(table), 1, (double[]){0, 0, 0}, 1e-14);
  assert_values(history_of(table), 2, (double[]){2, 1, 1.0 / 3}, 1e-13);
  assert_values(history_of(table), 3, (double[]){4, 4, 8.0 / 3}, 1e-13);
  assert_values(history_of(table), 5, (double[]){1, 9, 8.0 / 3 + 8 + 8 - 2}, 1e-12);
  assert_values(history_of(table), 7, (double[]){1, 11, 8.0 / 3 + 14 + 18 + 2}, 1e-12);
  breccia_model *all[] = {ramp, table, constant, plain};
  for (int k = 0; k < 4; ++k) breccia_model_destroy(&all[k]);
}

static void a_sine_begins_ends_and_swells_as_said(void **state)
{
  (void)state;
  const double pi = acos(-1), w = 2 * pi * 0.5;
  breccia_model *m = with_history("sine: {frequency: 500 Hz, from: 1, until: 5.5}"),
                *swell = with_history("sine: {frequency: 500 Hz, envelope: [[0, 0], [4, 1], [8, 0]]}");
  double at[3], end[3];
  assert_values(history_of(m), 0.9, (double[]){0, 0, 0}, 0);
  sine(w, 0, 2.3, at);
  assert_values(history_of(m), 3.3, at, 1e-12);
  sine(w, 0, 4.5, end);
  assert_values(history_of(m), 9, (double[]){0, end[1], end[2] + 3.5 * end[1]}, 1e-11);
  /* The integral of t sin(w t) is (sin w t - w t cos w t) / w^2. */
  for (double t = 0.3; t < 4; t += 0.61) {
    assert_near(history_factor(history_of(swell), t), t / 4 * sin(w * t), 1e-14);
    assert_near(history_integral(history_of(swell), 1, 1, t), (sin(w * t) - w * t * cos(w * t)) / (4 * w * w), 1e-12);
  }
  breccia_model_destroy(&m);
  breccia_model_destroy(&swell);
}

static void products_and_sums_are_those_of_their_parts(void **state)
{
  (void)state;
  breccia_model *product = with_history("product: [{ramp to: 4}, {table: [[0, 2], [4, 0]]}]"),
                *sum = with_history("sum: [{ramp to: 4}, {product: [{ramp to: 2}, {ramp to: 2}, {constant: yes}]}]");
  for (double t = 0.2; t < 4; t += 0.37) { /* t/4 (2 - t/2) */
    assert_values(history_of(product), t,
                  (double[]){t / 2 - t * t / 8, t * t / 4 - t * t * t / 24, t * t * t / 12 - t * t * t * t / 96},
                  1e-13);
    const double r = fmin(t, 2);
    assert_near(history_factor(history_of(sum), t), t / 4 + r * r / 4, 1e-14);
    assert_near(history_integral(history_of(sum), 1, 1, t), t * t / 8 + r * r * r / 12 + fmax(0, t - 2), 1e-13);
  }
  breccia_model_destroy(&product);
  breccia_model_destroy(&sum);
}

static void what_was_found_does_not_depend_on_what_was_asked_before(void **state)
{
  (void)state;
  const char *history = "product: [{sine: {frequency: 730 Hz}}, {table: [[0, 0], [2.1, 1], [6, 0.3]]}]";
  breccia_model *once = with_history(history), *often = with_history(history);
  for (double t = 0.001; t < 7.5; t += 0.0131) history_integral(history_of(often), 2, 1, t);
  for (double t = 7.5; t > 0; t -= 0.77)
    assert_true(history_integral(history_of(once), 2, 1, t) == history_integral(history_of(often), 2, 1, t));
  breccia_model_destroy(&once);
  breccia_model_destroy(&often);
}

static void write_text(const char *folder, const char *name, const char *text)
{
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static char *folder_of_files(void)
{
  static char folder[32];
  snprintf(folder, sizeof folder, "/tmp/breccia-XXXXXX");
  assert_non_null(mkdtemp(folder));
  write_text(folder, "new.AT2",
             "PEER NGA STRONG MOTION DATABASE RECORD\nA station, 090\nACCELERATION TIME SERIES IN UNITS OF G\n"
             "NPTS=   5, DT=   .0020 SEC\n  .1E+00  -.2E+00   .3\n  .0  .05\n");
  write_text(folder, "old.at2", "old\nheading\nlines\n5 0.0020 NPTS, DT\n.1 -.2 .3 0 .05\n");
  write_text(folder, "old.vt2", "old\nheading\nlines\n5 0.0020 NPTS, DT\n.1 -.2 .3 0 .05\n");
  write_text(folder, "old.DT2", "old\nheading\nlines\n5 0.0020 NPTS, DT\n.1 -.2 .3 0 .05\n");
  write_text(folder, "short.AT2", "a\nb\nc\nNPTS= 6, DT= .002 SEC\n.1 -.2 .3 0 .05\n");
  write_text(folder, "bare.AT2", "a\nb\nc\nno numbers here\n.1 -.2 .3 0 .05\n");
  write_text(folder, "two.txt", "time acceleration\n# remark\n0 0.1\n2\t-0.2\n4, 0.3\n6; 0\n8 .05\n");
  write_text(folder, "three.txt", "0 1 2\n1 2 3\n");
  write_text(folder, "back.txt", "0 1\n2 2\n1 3\n");
  write_text(folder, "table.csv",
             "# made by hand\nt (s),motion rate (1/s),motion (m/s2)\n0,9,0.1\n0.002,9,-0.2\n0.004,9,0.3\n"
             "0.006,9,0\n0.008,9,.05\n");
  return folder;
}

static void remove_files(const char *folder)
{
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void records_in_every_form_say_the_same(void **state)
{
  (void)state;
  const char *folder = folder_of_files();
  const char *const files[] = {"name: %s/new.AT2", "name: %s/old.at2", "name: %s/old.vt2",
                               "name: %s/old.DT2", "name: %s/two.txt", "name: %s/table.csv, column: motion, times: t"};
  for (size_t k = 0; k < sizeof files / sizeof *files;
       ++k) { /* five values 2 ms apart, 0 before and after; areas by the trapezium rule */
    char file[128], history[160];
    snprintf(file, sizeof file, files[k], folder);
    snprintf(history, sizeof history, "file: {%s, scale: 10}", file);
    breccia_model *m = with_history(history);
    History *h = history_of(m);
    const double at[] = {1, -2, 3, 0, 0.5};
    for (int n = 0; n < 5; ++n) assert_near(history_factor(h, 2 * n), at[n], 1e-14);
    assert_near(history_factor(h, 1), -0.5, 1e-14);
    assert_near(history_factor(h, -0.1), 0, 0);
    assert_near(history_factor(h, 8.1), 0, 0);
    assert_near(history_integral(h, 1, 1, 8), 1 - 4 + 6 + 0 + 0.5, 1e-13);
    assert_near(history_integral(h, 1, 1, 10), 3.5, 1e-13);
    /* a piece of length h from f to g adds h^2 (2 f + g) / 6 to the second integral */
    double twice = 0, area = 0;
    for (int n = 0; n < 4; ++n) {
      twice += 2 * area + 4 * (2 * at[n] + at[n + 1]) / 6;
      area += at[n] + at[n + 1];
    }
    assert_near(history_integral(h, 2, 1, 8), twice, 1e-12);
    assert_near(history_integral(h, 2, 1, 11), twice + 3 * 3.5, 1e-12);
    breccia_model_destroy(&m);
  }
  remove_files(folder);
}

static void a_record_that_begins_before_the_run_counts_from_its_beginning(void **state)
{
  (void)state;
  /* From 2 at -3 ms to 5 at 3 ms, and to 1 at 7 ms: 3.5 when the run begins, at time 0, from which integrals count. */
  char path[] = "/tmp/breccia-XXXXXX", history[80];
  const int file = mkstemp(path);
  static const char rows[] = "-3 2\n3 5\n7 1\n";
  assert_int_equal(write(file, rows, sizeof rows - 1), sizeof rows - 1);
  close(file);
  snprintf(history, sizeof history, "file: {name: %s}", path);
  breccia_model *m = with_history(history);
  History *h = history_of(m);
  assert_values(h, 0, (double[]){3.5, 0, 0}, 1e-14);
  assert_values(h, 2, (double[]){4.5, 3.5 * 2 + 0.25 * 4, 3.5 * 2 + 0.25 * 8 / 3}, 1e-13);
  assert_values(h, 3, (double[]){5, 10.5 + 2.25, 3.5 * 4.5 + 0.25 * 9}, 1e-13);
  assert_near(history_integral(h, 1, 1, 7), 12.75 + 12, 1e-13);
  assert_near(history_integral(h, 1, 1, 9), 12.75 + 12, 1e-13);
  breccia_model_destroy(&m);
  unlink(path);
}

static void what_files_lack_is_said(void **state)
{
  (void)state;
  const char *folder = folder_of_files();
  const struct {
    const char *file, *words;
  } wrong[] = {
      {"name: %s/none.AT2", "No such file"},
      {"name: %s/short.AT2", "its heading says 6 values, but it holds fewer numbers"},
      {"name: %s/bare.AT2", "bare.AT2:4: expected the number of values and the time step"},
      {"name: %s/three.txt", "three.txt:1: expected two numbers, time and value, found '0 1 2'"},
      {"name: %s/back.txt", "times must grow from row to row; row 3 has 1 after 2"},
      {"name: %s/table.csv, column: force, times: t", "has no column 'force'"},
      {"name: %s/table.csv, column: motion", "has no column 'time'"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char file[128], deck[1024];
    snprintf(file, sizeof file, wrong[k].file, folder);
    snprintf(deck, sizeof deck, DECK "loads: [{on: {face: x+}, force: [1, 0], history: {file: {%s}}}]\n", file);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    assert_non_null(strstr(words, "deck:"));
    free(words);
  }
  char *words = refusal_of(DECK "loads: [{on: {face: x+}, force: [1, 0], history: {product: []}}]\n");
  assert_non_null(strstr(words, "product: the list is empty"));
  free(words);
  words =
      refusal_of(DECK "loads: [{on: {face: x+}, force: [1, 0], history: {sine: {frequency: 1, from: 2, until: 1}}}]\n");
  assert_non_null(strstr(words, "until: must be later than 'from'"));
  free(words);
  remove_files(folder);
}

static void the_peak_of_a_history_is_its_farthest_from_zero(void **state)
{
  (void)state;
  breccia_model *down = with_history("table: [[0, 0], [1, -3], [2, 1], [9, 2]]"),
                *up = with_history("table: [[0, 0], [1, 3], [2, -1], [9, -2]]"),
                *wave = with_history("sine: {frequency: 500 Hz, phase: 180}");
  assert_near(history_peak(history_of(down), 9), -3, 1e-12);
  assert_near(history_peak(history_of(up), 9), 3, 1e-12);
  assert_near(history_peak(history_of(down), 0.5), -1.5, 1e-12);
  assert_near(history_peak(history_of(wave), 0.6), -1, 1e-4); /* down first */
  breccia_model *all[] = {down, up, wave};
  for (int k = 0; k < 3; ++k) breccia_model_destroy(&all[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals_are_those_of_the_closed_forms),
      cmocka_unit_test(a_sine_begins_ends_and_swells_as_said),
      cmocka_unit_test(products_and_sums_are_those_of_their_parts),
      cmocka_unit_test(what_was_found_does_not_depend_on_what_was_asked_before),
      cmocka_unit_test(records_in_every_form_say_the_same),
      cmocka_unit_test(a_record_that_begins_before_the_run_counts_from_its_beginning),
      cmocka_unit_test(what_files_lack_is_said),
      cmocka_unit_test(the_peak_of_a_history_is_its_farthest_from_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

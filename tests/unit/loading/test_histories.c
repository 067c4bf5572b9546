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

/** Adds a number in a column of a width, as Fortran writes it. */
static void add_column(char *text, size_t size, int width, const char *number)
{
  const size_t length = strlen(text);
  snprintf(text + length, size - length, "%*s", width, number);
}

/** Adds lines of equal columns, all with one number but for those that are given by their index. */
static void add_columns(char *text, size_t size, int count, int per_line, int width, const char *other,
                        const char *const given[][2])
{
  for (int k = 0; k < count; ++k) {
    const char *number = other;
    for (int n = 0; given[n][0]; ++n)
      if (atoi(given[n][0]) == k) number = given[n][1];
    add_column(text, size, width, number);
    if (k % per_line == per_line - 1 || k == count - 1) strncat(text, "\n", size - strlen(text) - 1);
  }
}

/** Writes a file in the SMC format: text, 48 integers, 50 reals, comments, values in columns of ten that touch each
 *  other. */
static void write_smc(const char *folder, const char *name, const char *kind, const char *rate, const char *values)
{
  char text[4096];
  snprintf(text, sizeof text, "%s\n", kind);
  for (int k = 0; k < 9; ++k) strcat(text, "*\n");
  strcat(text, "*\n");
  add_columns(text, sizeof text, 48, 8, 10, "-32768", (const char *const[][2]){{"15", "2"}, {"16", "5"}, {NULL, NULL}});
  add_columns(text, sizeof text, 50, 5, 15, "0.1700000E+39", (const char *const[][2]){{"1", rate}, {NULL, NULL}});
  strcat(text, "| a remark\n| 1.0 another one\n");
  strcat(text, values);
  write_text(folder, name, text);
}

/** Writes a file in the V2 format of COSMOS with so many channels, each with 12 lines of text, integers, 62 reals and
 *  a block of accelerations. */
static void write_cosmos(const char *folder, const char *name, int channels, const char *step, const char *block)
{
  char text[8192] = "";
  for (int channel = 0; channel < channels; ++channel) {
    strcat(text, "Corrected acceleration  (Format v01.20 with 13 text lines)\n");
    for (int k = 0; k < 12; ++k) strcat(text, "text, 7200 of a station\n");
    strcat(text, "  10  Integer-header values follow on  1 lines, Format= (10I8)\n");
    add_columns(text, sizeof text, 10, 10, 8, "-999", (const char *const[][2]){{NULL, NULL}});
    strcat(text, " 100  Real-header values follow on 17 lines, Format= (6F13.6)\n");
    add_columns(text, sizeof text, 100, 6, 13, "-999.000000", (const char *const[][2]){{"61", step}, {NULL, NULL}});
    strcat(text, "   1 Comment line(s) follow, each starting with a \"|\":\n| a remark\n");
    strcat(text, block);
    strcat(text, "End-of-data for channel\n");
  }
  write_text(folder, name, text);
}

static void write_record_files(const char *folder)
{
  write_text(folder, "fortran.AT2",
             "a\nb\nACC IN UNITS OF G\nNPTS=   5, DT=   2.00D-03 SEC,\n 1.0D-01-2.D-1 3.0Q-001 0 .5-001\n");
  write_text(folder, "milli.AT2", "a\nb\nACC IN UNITS OF G\nNPTS= 5, DT (MSEC) = 2\n.1 -.2 .3 0 .05\n");
  write_text(folder, "cm.AT2",
             "a\nb\nACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC\nNPTS= 5, DT= 2 MSEC\n"
             "98.0665 -196.133 294.1995 0 49.03325\n");
  write_text(folder, "stars.AT2",
             "a\nb\nACC IN UNITS OF CM/SEC**2\nNPTS= 5, DT= .002 SEC\n98.0665 -196.133 294.1995 0 49.03325\n");
  write_text(folder, "metres.AT2",
             "units: m/s^2\nDT = .002\na remark in 3 words\nNPTS = 5\n.980665 -1.96133 2.941995 0 .4903325\n");
  write_text(folder, "six.AT2",
             "turned\nH1: 000\nH2: 090\nangle 37\nFN\nAcceleration in g\n5 0.0020 NPTS, DT\n.1 -.2 .3 0 .05\n");
  write_text(folder, "early.AT2",
             "NPTS= 5, DT= .002 SEC\nstation\n(the unit) Acceleration (gal)\n98.0665 -196.133 294.1995 0 49.03325\n");
  write_text(folder, "record.txt", "NPTS= 5, DT= .002 SEC, UNITS: G\n.1 -.2 .3 0 .05\n");
  write_text(folder, "fast.VT2", "a\nb\nVELOCITY IN UNITS OF M/S\nNPTS= 5, DT= .002 SEC\n.001 -.002 .003 0 .0005\n");
  write_text(folder, "values.txt", "motion of a table\n.1\n-2.D-1\n.3\n0\n.05\n");
  write_smc(folder, "two.smc", "2 CORRECTED ACCELEROGRAM", "0.5000000E+03",
            "  98.06650-196.13300 294.19950   0.00000  49.03325\n");
  write_cosmos(folder, "one.v2", 1, "2.000000",
               "5 acceleration pts, approx 0 secs, units=cm/sec2(04),Format=(8f10.5)\n"
               "  98.06650-196.13300 294.19950   0.00000  49.03325\n5 velocity pts, approx 0 secs, units=cm/sec "
               "(05),Format=(8f10.5)\n"
               "   1.00000   1.00000   1.00000   1.00000   1.00000\n");
  write_cosmos(folder, "three.v2", 3, "2.000000",
               "5 acceleration pts, approx 0 secs, units=cm/sec2(04),Format=(8f10.5)\n"
               "  98.06650-196.13300 294.19950   0.00000  49.03325\n");
  write_cosmos(folder, "counts.v0", 1, "2.000000",
               "5 acceleration pts, approx 0 secs, units=counts (50),Format=(8f10.5)\n"
               "  98.06650-196.13300 294.19950   0.00000  49.03325\n");
  write_cosmos(folder, "stopped.v2", 1, "-999.000000",
               "5 acceleration pts, approx 0 secs, units=cm/sec2(04),Format=(8f10.5)\n"
               "  98.06650-196.13300 294.19950   0.00000  49.03325\n");
  write_cosmos(folder, "lasting.v2", 1, "2.000000",
               "5 acceleration pts, approx 9 secs, units=cm/sec2(04),Format=(8f10.5)\n"
               "  98.06650-196.13300 294.19950   0.00000  49.03325\n");
  write_text(folder, "csmip.v2",
             "a station\n   5 points of accel data equally spaced at  .002 sec, in cm/sec2. (3f9.5)\n"
             " 98.06650-196.1330294.19950\n  0.00000 49.03325\n   5 points of veloc data equally spaced at  .002 sec, "
             "in cm/sec. (3f9.5)\n"
             "  1.00000  1.00000  1.00000\n  1.00000  1.00000\n/&  ---------- End of data for channel  1 ----------\n");
  write_text(folder, "unit.AT2",
             "a\nb\nACCELERATION IN UNITS OF FURLONGS/FORTNIGHT2\nNPTS= 5, DT= .002 SEC\n.1 -.2 .3 0 .05\n");
  write_text(folder, "speed.AT2", "a\nb\nVELOCITY IN UNITS OF CM/S\nNPTS= 5, DT= .002 SEC\n.1 -.2 .3 0 .05\n");
  write_text(folder, "none.txt", "a\nNPTS= 5, DT= .002 SEC\n.1 -.2 .3 0 .05\n");
  write_text(folder, "word.AT2", "a\nb\nc\nNPTS= 5, DT= .002 SEC\n.1 -.2\nx .3 0 .05\n");
  write_text(folder, "long.AT2", "a\nb\nc\nNPTS= 5, DT= .002 SEC\n.1 -.2 .3 0 .05\n.1\n");
  write_text(folder, "tail.AT2", "a\nb\nc\nNPTS= 5, DT= .002 SEC\n.1 -.2 .3 0 .05\nend\n");
  write_text(folder, "zero.AT2", "a\nb\nc\nNPTS= 5, DT= .000 SEC\n.1 -.2 .3 0 .05\n");
  write_text(folder, "mixed.txt", "1\n2 3\n");
  write_smc(folder, "uneven.smc", "1 UNCORRECTED ACCELEROGRAM", "0.1700000E+39", "1 2 3 4 5\n");
  write_smc(folder, "spectrum.smc", "5 RESPONSE SPECTRA", "0.5000000E+03", "1 2 3 4 5\n");
  write_text(folder, "shallow.smc", "2 CORRECTED ACCELEROGRAM\n*\n1 2 3\n");
  write_text(folder, "knet.EW",
             "Origin Time       2006\nSampling Freq(Hz) 500Hz\nScale Factor      980.665/1000\nMemo.\n 1 2\n");
  write_text(folder, "knet.UD",
             "Origin Time       2006\nSampling Freq(Hz) 500Hz\nDuration Time(s)  9\nScale Factor      "
             "980.665(gal)/1000\nMemo.\n 1 2\n");
  /* Counts 8000 + 1000 (0.05, -0.25, 0.25, -0.05, 0), which is 0.1, -0.2, 0.3, 0, 0.05 less the mean; 1000 counts are
   * 1 g. */
  write_text(
      folder, "knet.NS",
      "Origin Time       2006/01/18 23:25:00\nSampling Freq(Hz) 500Hz\nDuration Time(s)  0\n"
      "Scale Factor      980.665(gal)/1000\nMemo.             \n    8050     7750     8250\n    7950     8000\n");
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
  write_record_files(folder);
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
  const char *const files[] = {"name: %s/new.AT2",
                               "name: %s/old.at2",
                               "name: %s/old.vt2",
                               "name: %s/old.DT2",
                               "name: %s/two.txt",
                               "name: %s/table.csv, column: motion, times: t",
                               "name: %s/fortran.AT2",
                               "name: %s/milli.AT2",
                               "name: %s/cm.AT2",
                               "name: %s/stars.AT2",
                               "name: %s/metres.AT2",
                               "name: %s/six.AT2",
                               "name: %s/early.AT2",
                               "name: %s/record.txt",
                               "name: %s/fast.VT2",
                               "name: %s/values.txt, time step: 2",
                               "name: %s/two.smc",
                               "name: %s/one.v2",
                               "name: %s/three.v2, channel: 2",
                               "name: %s/csmip.v2"};
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

static void offsets_of_recorders_are_no_acceleration(void **state)
{
  (void)state;
  const char *folder = folder_of_files();
  char history[80];
  snprintf(history, sizeof history, "file: {name: %s/knet.NS}", folder);
  breccia_model *m = with_history(history);
  const double at[] = {0.05, -0.25, 0.25, -0.05, 0};
  for (int n = 0; n < 5; ++n) assert_near(history_factor(history_of(m), 2 * n), at[n], 1e-14);
  breccia_model_destroy(&m);
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
      {"name: %s/unit.AT2", "unit.AT2:3: the unit 'FURLONGS/FORTNIGHT2' is unknown; expected g, cm/s2, m/s2"},
      {"name: %s/speed.AT2",
       "speed.AT2:3: its values are of velocity, and the ending of its name stands for acceleration"},
      {"name: %s/none.txt", "none.txt: its heading names no unit"},
      {"name: %s/word.AT2", "word.AT2:6: expected value 3 of 5, a number, found 'x .3 0 .05'"},
      {"name: %s/long.AT2", "long.AT2:6: its heading says 5 values, but it holds more numbers"},
      {"name: %s/tail.AT2", "tail.AT2:6: expected the end of the file after 5 values, found 'end'"},
      {"name: %s/zero.AT2", "zero.AT2:4: expected the number of values and the time step"},
      {"name: %s/values.txt", "values.txt:2: holds values without times, found '.1'; give the step between them"},
      {"name: %s/mixed.txt, time step: 2", "mixed.txt:2: expected one value, as in the rows before, found '2 3'"},
      {"name: %s/two.txt, channel: 1", "'channel' is for files of several channels"},
      {"name: %s/three.v2", "holds 3 channels of accelerations; choose one with 'channel'"},
      {"name: %s/three.v2, channel: 4", "holds 3 channels of accelerations, and channel 4 was asked for"},
      {"name: %s/counts.v0", "counts.v0:36: expected a unit of accelerations, cm/sec2 or g"},
      {"name: %s/stopped.v2", "expected a time step before these values"},
      {"name: %s/lasting.v2", "says approximately 9 s, and 5 values with the step of the header, 0.002 s, make 0.01 s"},
      {"name: %s/uneven.smc", "uneven.smc:18: expected the samples a second"},
      {"name: %s/spectrum.smc", "spectrum.smc:1: expected the kind of an SMC file"},
      {"name: %s/shallow.smc", "shallow.smc:11: expected '*'"},
      {"name: %s/knet.EW", "knet.EW:3: expected a scale factor, like 'Scale Factor 3920(gal)/6182761'"},
      {"name: %s/knet.UD", "knet.UD: holds 2 values at 500 Hz, and its header says a duration of 9 s; expected 4500"},
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
      cmocka_unit_test(offsets_of_recorders_are_no_acceleration),
      cmocka_unit_test(a_record_that_begins_before_the_run_counts_from_its_beginning),
      cmocka_unit_test(what_files_lack_is_said),
      cmocka_unit_test(the_peak_of_a_history_is_its_farthest_from_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

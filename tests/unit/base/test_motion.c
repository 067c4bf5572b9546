/* Intensities, response spectra and transfer functions: against closed forms. */
#include "base/fourier.h"
#include "base/shaking.h"
#include "model/motion.h"
#include "support.h"

#include <unistd.h>

static const double pi = 3.14159265358979323846, gravity = 9.80665;

typedef double Function(double time);

typedef struct Written { /* a motion in a file of its own */
  char path[40];
} Written;

static Written write_motion(const char *heading, Function *value, double step, int count)
{
  Written w = {"/tmp/breccia-XXXXXX"};
  FILE *stream = fdopen(mkstemp(w.path), "w");
  assert_non_null(stream);
  fputs(heading, stream);
  for (int k = 0; k < count; ++k) fprintf(stream, "%.17g,%.17g\n", k * step, value(k * step));
  fclose(stream);
  return w;
}

static breccia_motion *load(const Written *w, const char *column, const char *unit)
{
  breccia_error *error = breccia_error_create();
  breccia_motion *motion = NULL;
  const breccia_motion_file file = {.size = sizeof file, .path = w->path, .column = column, .unit = unit};
  if (breccia_motion_load(&file, &motion, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return motion;
}

static void analyse(breccia_motion *motion, const breccia_motion *over, const breccia_motion_wish *wish)
{
  breccia_error *error = breccia_error_create();
  if (breccia_motion_analyse(motion, over, wish, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

static Response respond(Function *value, double step, int count, double period, double damping)
{
  double *times = malloc(sizeof *times * (size_t)count), *values = malloc(sizeof *values * (size_t)count);
  for (int k = 0; k < count; ++k) {
    times[k] = k * step;
    values[k] = value(times[k]);
  }
  const Response response = shaking_response(&(Shaking){times, values, count}, period, damping);
  free(times);
  free(values);
  return response;
}

static double steady(double t)
{
  (void)t;
  return 2;
}

/** Pushed at once, an oscillator goes 1 + exp(-pi zeta / sqrt(1 - zeta^2)) times as far as it would come to rest: however long the steps are. */
static void a_push_is_overshot(void **state)
{
  (void)state;
  for (double damping = 0; damping < 0.9; damping += 0.1)
    for (double step = 0.014; step < 15; step *= 10) { /* to a time at which an undamped one has come back */
      const double omega = 2 * pi / 0.7, over = 1 + exp(-pi * damping / sqrt(1 - damping * damping));
      const Response r = respond(steady, step, (int)lround(14 / step) + 1, 0.7, damping);
      assert_near(r.displacement, over * 2 / (omega * omega), 2e-3 * over * 2 / (omega * omega));
      if (damping == 0) assert_near(r.velocity, 2 / omega, 2e-3 * 2 / omega);
      if (damping == 0) assert_near(r.acceleration, 4, 8e-3);
    }
}

static double ramp(double t)
{
  return 3 * t;
}

/** Under a base that accelerates ever more, x = -3 (t - 2 zeta / omega) / omega^2 in the end: straight lines are followed as they are. */
static void a_straight_line_is_followed_exactly(void **state)
{
  (void)state;
  const double omega = 2 * pi / 0.5, damping = 0.3, end = 40;
  const Response r = respond(ramp, end, 2, 0.5, damping);
  assert_near(r.displacement, 3 * (end - 2 * damping / omega) / (omega * omega), 1e-10);
}

static double wave(double t)
{
  return 1.5 * sin(2 * pi * 2 * t);
}

/** In resonance: a / (2 zeta omega^2) against the base, and sqrt(1 + 4 zeta^2) / (2 zeta) times the base's acceleration in all. */
static void resonance_is_bounded_by_damping(void **state)
{
  (void)state;
  const double damping = 0.05, omega = 2 * pi * 2, most = 1.5 / (2 * damping * omega * omega);
  const Response r = respond(wave, 0.002, 15001, 0.5, damping);
  assert_near(r.displacement, most, 2e-3 * most);
  assert_near(r.velocity, most * omega, 2e-3 * most * omega);
  assert_near(r.acceleration, 1.5 * sqrt(1 + 4 * damping * damping) / (2 * damping), 2e-3 * 15);
}

/** Every row of the response spectrum of a push of 2 m/s2, and of the one below it: periods at equal ratios, 2 (T / 2 pi)^2 times 1 + exp(-pi zeta /
 *  sqrt(1 - zeta^2)) of displacement, and that times 2 pi / T once and twice. The
 *  acceleration in all is that of its spring and its dashpot. */
static void rows_of_a_spectrum_are_those_of_an_oscillator(void **state)
{
  (void)state;
  const Written w = write_motion("", steady, 0.5, 201);
  for (int damped = 0; damped < 2; ++damped) {
    const double damping = damped ? 0.2 : 0, over = 1 + exp(-pi * damping / sqrt(1 - damping * damping));
    breccia_motion *m = load(&w, NULL, "m/s2"), *below = load(&w, NULL, "g");
    analyse(below, NULL,
            &(breccia_motion_wish){
                .size = sizeof(breccia_motion_wish), .damping = damping, .shortest = NAN, .longest = NAN});
    analyse(m, below,
            &(breccia_motion_wish){
                .size = sizeof(breccia_motion_wish), .damping = damping, .shortest = 0.2, .longest = 20, .periods = 5});
    assert_int_equal(breccia_motion_rows(m, BRECCIA_MOTION_RESPONSE), 5);
    const double *column[5];
    for (int c = 0; c < 5; ++c) column[c] = m->tables[BRECCIA_MOTION_RESPONSE].columns[c];
    for (int k = 0; k < 5; ++k) {
      const double period = 0.2 * pow(10, 0.5 * k), omega = 2 * pi / period, most = over * 2 / (omega * omega);
      assert_near(column[0][k], period, 1e-12 * period);
      assert_near(column[1][k], most, 2e-3 * most);
      assert_near(column[2][k], most * omega, 2e-3 * most * omega);
      assert_near(column[3][k], most * omega * omega, 2e-3 * most * omega * omega);
      /* The acceleration in all, 2 (1 - exp(-zeta omega t) (cos - zeta / root sin)): its largest by trial. */
      double largest = 0;
      const double root = sqrt(1 - damping * damping);
      for (double t = 0; t < 1; t += 1e-4) {
        const double turn = 2 * pi * t * root;
        largest = larger_of(largest, 2 * (1 - exp(-damping * 2 * pi * t) * (cos(turn) - damping / root * sin(turn))));
      }
      assert_near(column[4][k], largest, 2e-3 * largest);
      assert_near(m->over_response[k], gravity * most * omega * omega, 2e-3 * gravity * most * omega * omega);
    }
    breccia_motion_destroy(&m);
    breccia_motion_destroy(&below);
  }
  unlink(w.path);
}

static double pulse(double t)
{
  return sin(pi * t / 0.3);
}

/** After half a sine of length d an undamped oscillator of period T swings by (T / d) cos(pi d / T) / ((T / 2 d)^2 - 1) times what the largest acceleration
 *  would hold it at (Chopra, Dynamics of Structures, 4.8): the largest comes behind the end of the record. */
static void an_oscillator_swings_on_after_the_end(void **state)
{
  (void)state;
  const double period = 1, d = 0.3, held = 1 / pow(2 * pi / period, 2);
  const double expected = held * period / d * cos(pi * d / period) / (pow(period / (2 * d), 2) - 1);
  const Response r = respond(pulse, d / 300, 301, period, 0);
  assert_near(r.displacement, expected, 2e-3 * expected);
}

/** Of whole periods of a sine: a^2 t pi / (4 g), nine tenths of it in nine tenths of the time; 2 a / omega and a t / omega in the end. */
static void a_sine_has_the_intensity_of_its_square(void **state)
{
  (void)state;
  const double omega = 4 * pi;
  const Written w = write_motion("", wave, 0.001, 20001);
  breccia_motion *m = load(&w, NULL, "m/s2");
  analyse(m, NULL,
          &(breccia_motion_wish){.size = sizeof(breccia_motion_wish), .damping = 0.05, .shortest = 1, .longest = 1});
  breccia_intensity i = {.size = sizeof i};
  assert_int_equal(breccia_motion_intensity(m, &i), 1);
  assert_near(i.acceleration, 1.5, 1e-6);
  assert_near(i.velocity, 2 * 1.5 / omega, 1e-5);
  assert_near(i.displacement, 1.5 / omega * 20, 1e-4);
  assert_near(i.arias, pi / (2 * gravity) * 1.5 * 1.5 * 20 / 2, 1e-4);
  assert_near(i.from, 1, 0.02);
  assert_near(i.to - i.from, 18, 0.03);
  assert_int_equal(breccia_motion_rows(m, BRECCIA_MOTION_HISTORY), 20001);
  assert_string_equal(breccia_motion_heading(m, BRECCIA_MOTION_HISTORY, 4), "Husid");
  const double *husid = breccia_motion_column(m, BRECCIA_MOTION_HISTORY, 4);
  for (int k = 0; k <= 20; ++k) assert_near(husid[1000 * k], k / 20.0, 1e-5);
  assert_int_equal(breccia_motion_rows(m, BRECCIA_MOTION_RESPONSE), 1);
  breccia_motion_destroy(&m);
  unlink(w.path);
}

static double box(double t)
{
  return t < 1.995 ? 1 : 0;
}

/** A box of length d: |sin(pi f d) / (pi f)|, with the corner that straight lines cut off. */
static void a_box_has_the_amplitudes_of_its_sine(void **state)
{
  (void)state;
  enum { COUNT = 400, SIZE = 1024 };
  const double step = 0.01, d = 2;
  double values[COUNT], amplitudes[SIZE / 2 + 1];
  for (int k = 0; k < COUNT; ++k) values[k] = box(k * step);
  assert_int_equal(fourier_size(COUNT), 512);
  assert_int_equal(fourier_size(512), 512);
  assert_int_equal(fourier_amplitudes(values, COUNT, step, SIZE, amplitudes, NULL), 0);
  assert_near(amplitudes[0], d, 1e-12);
  for (int k = 1; k <= SIZE / 2; ++k) {
    const double f = k / (step * SIZE); /* a sum of equal terms: sin(pi f d) / sin(pi f step) */
    assert_near(amplitudes[k], step * fabs(sin(pi * f * d) / sin(pi * f * step)), 1e-12);
  }
}

/** A line on logarithmic axes stays where it is, and what is alike stays alike; far from all amplitudes the nearest count. */
static void smoothing_keeps_what_is_smooth(void **state)
{
  (void)state;
  enum { COUNT = 2000 };
  double flat[COUNT], steep[COUNT], spike[COUNT] = {0};
  for (int k = 0; k < COUNT; ++k) {
    flat[k] = 3;
    steep[k] = k ? 1.0 / k : 7;
  }
  spike[1000] = 1;
  for (double f = 0.02; f < 150; f *= 1.3) assert_near(fourier_smooth(flat, COUNT, 0.1, f, 40), 3, 1e-12);
  for (double f = 5; f < 150; f *= 1.3) assert_near(fourier_smooth(steep, COUNT, 0.1, f, 40), 0.1 / f, 4e-3 * 0.1 / f);
  assert_near(fourier_smooth(spike, COUNT, 0.1, 100 * pow(10, 3.1 / 40), 40), 0, 1e-6);
  const double z = 1.2, beside = 100 * pow(10, z / 40), peak = fourier_smooth(spike, COUNT, 0.1, 100, 40);
  assert_near(fourier_smooth(spike, COUNT, 0.1, beside, 40) * beside, 100 * peak * pow(sin(z) / z, 4),
              0.01 * 100 * peak);
  assert_near(fourier_smooth(steep, COUNT, 0.1, 0.25, 1e4), (1 / 2.0 + 1 / 3.0) / 2, 1e-12);
}

static double shake(double t)
{
  return sin(9 * t) * exp(-t) + 2 * sin(40 * t) * exp(-2 * t);
}

static double echoed(double t)
{
  return shake(t) + (t >= 0.25 ? 0.6 * shake(t - 0.25) : 0);
}

/** Over what it is an echo of, later by d and 0.6 times as large, a motion is |1 + 0.6 exp(-2 pi i f d)| times as large; in the table of words the largest. */
static void an_echo_has_its_transfer_function(void **state)
{
  (void)state;
  const Written above = write_motion("", echoed, 0.01, 2401),
                below = write_motion("time (s),a (m/s2)\n", shake, 0.005, 4001);
  breccia_motion *m = load(&above, NULL, "m/s2"), *o = load(&below, "a", NULL);
  breccia_motion_wish wish = {.size = sizeof wish, .damping = 0.05, .shortest = 1, .longest = 1, .smoothing = 0};
  for (int smooth = 0; smooth < 2; ++smooth) {
    wish.smoothing = smooth ? 200 : 0;
    analyse(m, o, &wish);
    const int rows = breccia_motion_rows(m, BRECCIA_MOTION_FOURIER);
    const double *f = breccia_motion_column(m, BRECCIA_MOTION_FOURIER, 0),
                 *ratio = breccia_motion_column(m, BRECCIA_MOTION_FOURIER, 3);
    int looked = 0;
    assert_near(f[rows - 1], 0.5 / 0.005, 1e-9); /* the finer steps of both */
    for (int k = 0; k < rows && f[k] < 8; ++k) {
      if (f[k] < 0.5) continue;
      const double x = 1 + 0.6 * cos(2 * pi * f[k] * 0.25), y = 0.6 * sin(2 * pi * f[k] * 0.25);
      assert_near(ratio[k], hypot(x, y), smooth ? 0.06 : 0.03); /* straight lines over 0.01 s cut off 2 % of 8 Hz */
      ++looked;
    }
    assert_true(looked > 50);
  }
  assert_non_null(strstr(breccia_motion_words(m), "times as large at most"));
  assert_null(breccia_motion_heading(m, BRECCIA_MOTION_FOURIER, 4));
  assert_null(breccia_motion_heading(m, 3, 0));
  assert_int_equal(breccia_motion_rows(m, -1), 0);
  breccia_motion_destroy(&m);
  breccia_motion_destroy(&o);
  unlink(above.path);
  unlink(below.path);
}

static double speed(double t)
{
  return 30 * (1 - cos(2 * pi * 2 * t));
}

/** Velocities in cm/s become accelerations; values in g those in m/s2. */
static void files_are_read_in_their_units(void **state)
{
  (void)state;
  const Written v = write_motion("time (ms),x (cm/s)\n", speed, 1, 3), a = write_motion("", steady, 0.1, 11);
  breccia_motion *m = load(&v, "x", NULL);
  analyse(m, NULL, NULL);
  assert_near(breccia_motion_column(m, BRECCIA_MOTION_HISTORY, 0)[2], 0.002, 1e-15);
  breccia_motion_destroy(&m);
  unlink(v.path);
  const Written fine = write_motion("time,x (cm/s)\n", speed, 0.001, 2001);
  m = load(&fine, "x", NULL);
  analyse(m, NULL, NULL);
  for (int k = 1; k < 2000; ++k)
    assert_near(breccia_motion_column(m, BRECCIA_MOTION_HISTORY, 1)[k], 0.3 * 4 * pi * sin(4 * pi * k * 0.001), 2e-4);
  breccia_motion_destroy(&m);
  unlink(fine.path);
  m = load(&a, NULL, "g");
  analyse(m, NULL, NULL);
  assert_near(breccia_motion_column(m, BRECCIA_MOTION_HISTORY, 1)[5], 2 * gravity, 1e-12);
  assert_int_equal(breccia_motion_rows(m, BRECCIA_MOTION_RESPONSE), 181);
  assert_near(breccia_motion_column(m, BRECCIA_MOTION_RESPONSE, 0)[60], 0.1, 1e-12);
  breccia_motion_destroy(&m);
  unlink(a.path);
}

static double still(double t)
{
  (void)t;
  return 0;
}

/** No motion is told as none. */
static void no_motion_has_no_duration(void **state)
{
  (void)state;
  const Written w = write_motion("", still, 0.1, 11);
  breccia_motion *m = load(&w, NULL, "g");
  analyse(m, NULL, NULL);
  breccia_intensity i = {.size = sizeof i};
  breccia_motion_intensity(m, &i);
  assert_true(isnan(i.from) && isnan(i.to) && i.arias == 0);
  assert_non_null(strstr(breccia_motion_words(m), "significant duration (5 to 95 %)  -\n"));
  breccia_motion_destroy(&m);
  unlink(w.path);
}

static void wrong_files_and_wishes_are_refused(void **state)
{
  (void)state;
  const Written w = write_motion("time (s),x (m),y (m/s2)\n", steady, 0.1, 11),
                plain = write_motion("", steady, 0.1, 11);
  const struct {
    const Written *file;
    const char *column, *words;
  } files[] = {{&w, "x", "its values are in 'm', which is no unit of an acceleration (g, m/s2) or a velocity (m/s)"},
               {&plain, NULL, "does not say in which unit its values are; give it: g, m/s2, or m/s of velocities"},
               {&w, "u", "u"}};
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_motion *m = NULL;
    const breccia_motion_file file = {.size = sizeof file, .path = files[k].file->path, .column = files[k].column};
    assert_int_equal(breccia_motion_load(&file, &m, error), BRECCIA_USER_ERROR);
    assert_null(m);
    if (!strstr(breccia_error_text(error), files[k].words)) fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
  }
  static const char *const units[] = {"kN", "m", "g2"}; /* even where the file says one */
  for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_motion *m = NULL;
    const breccia_motion_file file = {.size = sizeof file, .path = w.path, .column = "x", .unit = units[k]};
    assert_int_equal(breccia_motion_load(&file, &m, error), BRECCIA_USER_ERROR);
    if (!strstr(breccia_error_text(error),
                "', which was given, is no unit of an acceleration (g, m/s2) or a velocity (m/s)"))
      fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
  }
  const Written brief = write_motion("time (s),y (m/s2)\n", steady, 1e-30, 11);
  breccia_motion *short_one = load(&brief, "y", NULL);
  breccia_error *why = breccia_error_create();
  assert_int_equal(breccia_motion_analyse(short_one, NULL, NULL, why), BRECCIA_USER_ERROR);
  if (!strstr(breccia_error_text(why), "s; expected more than 1e-09 s: in which unit are its times?"))
    fail_msg("%s", breccia_error_text(why));
  breccia_error_destroy(&why);
  breccia_motion_destroy(&short_one);
  unlink(brief.path);
  breccia_motion *m = load(&plain, NULL, "g");
  const struct {
    breccia_motion_wish wish;
    const char *words;
  } wishes[] = {
      {{.damping = 1, .shortest = 1, .longest = 2}, "damping: 1 is no share of the critical one"},
      {{.damping = -0.1, .shortest = 1, .longest = 2}, "damping: -0.1 is no share"},
      {{.shortest = 2, .longest = 1}, "periods: from 2 to 1 s: expected two above 0, the shorter one first"},
      {{.shortest = 0, .longest = 1}, "periods: from 0 to 1 s"},
      {{.shortest = 1e-8, .longest = 1}, "periods: the shortest, 1e-08 s, goes more than 1e7 times into the 1 s of"},
      {{.shortest = 1, .longest = 1, .smoothing = 2}, "smoothing: 2 is not 0 (none), or from 5"},
      {{.shortest = 1, .longest = 1, .periods = 200000}, "periods: 200000 of them"},
  };
  for (size_t k = 0; k < sizeof wishes / sizeof *wishes; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_motion_wish wish = wishes[k].wish;
    wish.size = sizeof wish;
    assert_int_equal(breccia_motion_analyse(m, NULL, &wish, error), BRECCIA_USER_ERROR);
    if (!strstr(breccia_error_text(error), wishes[k].words)) fail_msg("%s", breccia_error_text(error));
    assert_string_equal(breccia_motion_words(m), "");
    breccia_error_destroy(&error);
  }
  breccia_error *error = breccia_error_create();
  const breccia_motion_wish none = {.size = 0};
  breccia_intensity unsized = {.size = 0};
  assert_int_equal(breccia_motion_analyse(m, NULL, &none, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), "breccia_motion_wish: its size is not set"));
  assert_int_equal(breccia_motion_intensity(m, &unsized), 0);
  assert_int_equal(breccia_motion_write(m, "/tmp", error), BRECCIA_USER_ERROR);
  breccia_error_destroy(&error);
  breccia_motion_destroy(&m);
  unlink(w.path);
  unlink(plain.path);
}

static double steady_ground(double t)
{
  return t < 0.5 ? 2 : -3;
}

static void values_alone_take_the_step_that_is_given(void **state)
{
  (void)state;
  char path[] = "/tmp/breccia-XXXXXX";
  FILE *stream = fdopen(mkstemp(path), "w");
  assert_non_null(stream);
  for (int k = 0; k < 100; ++k) fprintf(stream, "%g\n", steady_ground(0.01 * k));
  fclose(stream);
  breccia_error *error = breccia_error_create();
  breccia_motion *motion = NULL;
  breccia_motion_file file = {.size = sizeof file, .path = path, .unit = "m/s2"};
  assert_int_equal(breccia_motion_load(&file, &motion, error), BRECCIA_USER_ERROR);
  holds_words(breccia_error_text(error), "holds values without times|--time-step");
  breccia_error_destroy(&error);
  error = breccia_error_create();
  file.step = -1;
  assert_int_equal(breccia_motion_load(&file, &motion, error), BRECCIA_USER_ERROR);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  file.step = 0.01;
  if (breccia_motion_load(&file, &motion, error)) fail_msg("%s", breccia_error_text(error));
  assert_int_equal(motion->count, 100);
  assert_near(motion->rows[2 * 99], 0.99, 1e-14);
  assert_near(motion->rows[2 * 99 + 1], -3, 1e-14);
  breccia_error_destroy(&error);
  breccia_motion_destroy(&motion);
  unlink(path);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_alone_take_the_step_that_is_given),
      cmocka_unit_test(a_push_is_overshot),
      cmocka_unit_test(rows_of_a_spectrum_are_those_of_an_oscillator),
      cmocka_unit_test(a_straight_line_is_followed_exactly),
      cmocka_unit_test(resonance_is_bounded_by_damping),
      cmocka_unit_test(an_oscillator_swings_on_after_the_end),
      cmocka_unit_test(a_sine_has_the_intensity_of_its_square),
      cmocka_unit_test(a_box_has_the_amplitudes_of_its_sine),
      cmocka_unit_test(smoothing_keeps_what_is_smooth),
      cmocka_unit_test(an_echo_has_its_transfer_function),
      cmocka_unit_test(files_are_read_in_their_units),
      cmocka_unit_test(no_motion_has_no_duration),
      cmocka_unit_test(wrong_files_and_wishes_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

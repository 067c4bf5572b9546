/* What is made of records before they act: against closed forms. */
#include "support.h"

#include <unistd.h>

#define DECK                                                                                                           \
  "materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}\n"                                              \
  "body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [8, 1], first "        \
  "particle: [0.025, 0]}}}}\n"                                                                                         \
  "peridynamics: {formulation: bond-based, space: 1-D}\n"                                                              \
  "solve: {explicit: {steps: 1}}\n"

typedef double Function(double time);

typedef struct Written { /* a record in a file of its own */
  char path[32];
} Written;

static Written write_record(Function *value, double first, double step, int count)
{
  Written w = {"/tmp/breccia-XXXXXX"};
  const int file = mkstemp(w.path);
  FILE *stream = fdopen(file, "w");
  assert_non_null(stream);
  for (int k = 0; k < count; ++k) fprintf(stream, "%.17g %.17g\n", first + k * step, value(first + k * step));
  fclose(stream);
  return w;
}

static char *deck_of(const Written *w, const char *keys)
{
  static char deck[1024];
  snprintf(deck, sizeof deck, DECK "loads: [{on: {face: x+}, force: [1, 0], history: {file: {name: %s%s}}}]\n", w->path,
           keys);
  return deck;
}

static History *history_of(breccia_model *m)
{
  return &m->loading.loads[0].history;
}

static double cubic(double t)
{
  return 3 - 2 * t + 0.5 * t * t - 0.3 * t * t * t;
}

static void a_polynomial_is_taken_off_whole_by_one_of_its_degree_or_more(void **state)
{
  (void)state;
  static const char *const words[] = {"constant", "linear", "quadratic", "cubic"};
  const Written w = write_record(cubic, 1, 0.05, 81);
  for (int degree = 0; degree < 4; ++degree) {
    char keys[64];
    snprintf(keys, sizeof keys, ", baseline correction: %s", words[degree]);
    breccia_model *m = model_of("%s", deck_of(&w, keys));
    /* What is left is orthogonal to all polynomials that could have been taken off. */
    for (int power = 0; power <= degree; ++power) {
      double sum = 0;
      for (int k = 0; k < 81; ++k) sum += pow(k / 40.0 - 1, power) * history_factor(history_of(m), 1 + 0.05 * k);
      assert_near(sum, 0, 1e-10);
    }
    double most = 0;
    for (int k = 0; k < 81; ++k) most = larger_of(most, fabs(history_factor(history_of(m), 1 + 0.05 * k)));
    if (degree == 3) assert_true(most < 1e-11);
    if (degree < 3) assert_true(most > 0.1);
    breccia_model_destroy(&m);
  }
  unlink(w.path);
}

static double frequency;

static double wave(double t)
{
  return sin(2 * acos(-1) * frequency * t + 0.4);
}

/** Amplitude of the record's own frequency in whole periods around the middle, and its phase. */
static void measure_wave(History *h, double middle, double *amplitude, double *phase)
{
  const double pi = acos(-1), length = 10 / frequency;
  const int samples = 2000;
  double in = 0, across = 0;
  for (int k = 0; k < samples; ++k) {
    const double t = middle + length * ((k + 0.5) / samples - 0.5), angle = 2 * pi * frequency * t;
    in += 2.0 / samples * history_factor(h, t) * sin(angle);
    across += 2.0 / samples * history_factor(h, t) * cos(angle);
  }
  *amplitude = hypot(in, across);
  *phase = atan2(across, in);
}

static void a_band_pass_keeps_the_share_of_butterworths_filter_twice_and_no_phase(void **state)
{
  (void)state;
  const double pi = acos(-1), step = 0.005, from = 0.5, to = 8, frequencies[] = {0.25, 0.5, 0.8, 2, 6, 8, 11};
  for (int order = 1; order <= 5; ++order)
    for (size_t k = 0; k < sizeof frequencies / sizeof *frequencies; ++k) {
      const double f = frequency = frequencies[k];
      char keys[80];
      double amplitude, phase;
      const Written w = write_record(wave, 0, step, 16001); /* 80 s */
      snprintf(keys, sizeof keys, ", band pass: {from: %g, to: %g, order: %d}", from, to, order);
      breccia_model *m = model_of("%s", deck_of(&w, keys));
      measure_wave(history_of(m), 40, &amplitude, &phase);
      /* The bilinear transformation sees frequencies as tan(pi f step) and leaves corners where they are. */
      const double below = tan(pi * from * step) / tan(pi * f * step), above = tan(pi * f * step) / tan(pi * to * step);
      const double expected = 1 / ((1 + pow(below, 2 * order)) * (1 + pow(above, 2 * order)));
      const double straight =
          1 - pow(pi * f * step, 2) / 3; /* of a sine that is drawn by straight lines, in the mean */
      assert_near(amplitude, expected * straight, 1e-3 * expected + 1e-5);
      assert_near(phase, 0.4, 2e-3);
      breccia_model_destroy(&m);
      unlink(w.path);
    }
}

static void one_corner_alone_leaves_the_other_side_as_it_is(void **state)
{
  (void)state;
  frequency = 2;
  const Written w = write_record(wave, 0, 0.002, 20001);
  double amplitude, phase;
  breccia_model *low = model_of("%s", deck_of(&w, ", band pass: {to: 20}")),
                *high = model_of("%s", deck_of(&w, ", band pass: {from: 0.2}")),
                *both = model_of("%s", deck_of(&w, ", band pass: {to: 2}"));
  measure_wave(history_of(low), 15, &amplitude, &phase);
  assert_near(amplitude, 1, 1e-3);
  measure_wave(history_of(high), 15, &amplitude, &phase);
  assert_near(amplitude, 1, 1e-3);
  measure_wave(history_of(both), 15, &amplitude, &phase);
  assert_near(amplitude, 0.5, 1e-3);
  breccia_model *all[] = {low, high, both};
  for (int k = 0; k < 3; ++k) breccia_model_destroy(&all[k]);
  unlink(w.path);
}

/** Something that ends neither at rest nor where it began. */
static double drifting(double t)
{
  return sin(7 * t) * exp(-0.3 * t) + 0.2 + 0.05 * t;
}

/** The record may begin at any time: a straight line over its own duration is taken off. */
static void a_base_comes_to_rest_where_it_began(void **state)
{
  (void)state;
  for (double begin = 0; begin < 5; begin += 4) {
    const Written w = write_record(drifting, begin, 0.01, 1001);
    const double end = begin + 10;
    breccia_model *plain = model_of("%s", deck_of(&w, "")), *rest = model_of("%s", deck_of(&w, ", end at rest: yes"));
    assert_true(fabs(history_integral(history_of(plain), 1, 1, end)) > 1);
    assert_true(fabs(history_integral(history_of(plain), 2, 1, end)) > 1);
    for (int order = 1; order <= 2; ++order) {
      assert_near(history_integral(history_of(rest), order, 1, end), 0, 1e-10);
      assert_near(history_integral(history_of(rest), order, 1, end + 2), 0, 1e-10);
    }
    /* Both differ by a straight line. */
    double off[3];
    for (int k = 0; k < 3; ++k) {
      const double time = begin + 2 + 3 * k;
      off[k] = history_factor(history_of(plain), time) - history_factor(history_of(rest), time);
    }
    assert_near(off[2] - off[1], off[1] - off[0], 1e-12);
    breccia_model_destroy(&plain);
    breccia_model_destroy(&rest);
    unlink(w.path);
  }
}

static void finer_steps_follow_the_same_straight_lines(void **state)
{
  (void)state;
  const Written w = write_record(drifting, 0.5, 0.1, 51);
  breccia_model *plain = model_of("%s", deck_of(&w, "")), *fine = model_of("%s", deck_of(&w, ", time step: 0.025"));
  assert_int_equal(history_of(fine)->line.count, 201);
  for (double t = 0.4; t < 5.6; t += 0.0137)
    assert_near(history_factor(history_of(fine), t), history_factor(history_of(plain), t), 1e-12);
  breccia_model_destroy(&plain);
  breccia_model_destroy(&fine);
  unlink(w.path);
}

static void wrong_wishes_are_refused_with_their_place(void **state)
{
  (void)state;
  const Written even = write_record(drifting, 0, 0.01, 101), few = write_record(drifting, 0, 0.01, 5);
  Written uneven = {"/tmp/breccia-XXXXXX"};
  const int file = mkstemp(uneven.path);
  static const char rows[] = "0 1\n1 2\n1.5 0\n3 1\n4 1\n";
  assert_int_equal(write(file, rows, sizeof rows - 1), sizeof rows - 1);
  close(file);
  const struct {
    const Written *record;
    const char *keys, *words;
  } wrong[] = {
      {&even, ", time step: 0.02", "time step: 0.02 would leave out values of the file, whose longest step is 0.01"},
      {&even, ", time step: 1e-12", "makes more than 1e8 values of the file; choose a longer one"},
      {&even, ", band pass: {from: 1, to: 50}", "to: steps of 0.01 hold frequencies below 50 only"},
      {&even, ", band pass: {from: 2, to: 1}", "to: must be above 'from'"},
      {&even, ", band pass: {order: 2}", "band pass: give the lower corner 'from', the upper one 'to', or both"},
      {&even, ", baseline correction: lin", "linear"},
      {&few, ", baseline correction: cubic", "5 values are too few for a cubic one"},
      {&uneven, ", baseline correction: linear",
       "baseline correction: the steps of the file are not equal (0.5 to 1.5)"},
      {&uneven, ", band pass: {to: 0.1}",
       "band pass: the steps of the file are not equal (0.5 to 1.5); give 'time step'"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char *words = refusal_of(deck_of(wrong[k].record, wrong[k].keys));
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    if (!strstr(words, "deck:5:")) fail_msg("no place in %s", words);
    free(words);
  }
  breccia_model *made_even = model_of("%s", deck_of(&uneven, ", time step: 0.5, baseline correction: linear"));
  assert_int_equal(history_of(made_even)->line.count, 9);
  breccia_model_destroy(&made_even);
  unlink(even.path);
  unlink(few.path);
  unlink(uneven.path);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_polynomial_is_taken_off_whole_by_one_of_its_degree_or_more),
      cmocka_unit_test(a_band_pass_keeps_the_share_of_butterworths_filter_twice_and_no_phase),
      cmocka_unit_test(one_corner_alone_leaves_the_other_side_as_it_is),
      cmocka_unit_test(a_base_comes_to_rest_where_it_began),
      cmocka_unit_test(finer_steps_follow_the_same_straight_lines),
      cmocka_unit_test(wrong_wishes_are_refused_with_their_place),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

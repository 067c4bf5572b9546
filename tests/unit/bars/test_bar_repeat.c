/* Bars at a pitch: where their lines stand, against closed forms, and against the same bars written one by one. */
#include "support.h"

#include "bars/bars.h"
#include "model/run.h"

#define STEEL "steel: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01}"

/** A slab of 1.2 m by 0.8 m by 0.3 m that is pulled, with bars. */
#define SLAB(solve)                                                                                                    \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  " STEEL "\n"                             \
  "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.8, 0.3]}}}}\n"                  \
  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"                                                 \
  "bars: {%s}\n"                                                                                                       \
  "loads: [{on: {all: yes}, field: {displacement: ['0.01*x + 0.003*y', '0.004*y - 0.005*z', '0.002*x*x/1 m']}, "       \
  "history: {ramp to: 1}}%s]\n"                                                                                        \
  "solve: {" solve "}\npictures: []\n"
#define RAMP "static: {increments: 3, end time: 1}"

static const Bars *bars_of(const breccia_model *m)
{
  return bars_among(&m->domain.forces);
}

static void lines_stand_at_the_pitch(void **state)
{
  (void)state;
  static const struct {
    const char *repeat;
    int lines;
    double at[12];
  } cases[] = {
      {"along: [2, 0, 0], pitch: 150 mm, number: 4", 4, {0, 0.15, 0.3, 0.45}},
      {"along: [1, 0, 0], pitch: 0.2, over: 1", 6, {0, 0.2, 0.4, 0.6, 0.8, 1}},
      {"along: [1, 0, 0], pitch: 0.1, over: 0.3", 4, {0, 0.1, 0.2, 0.3}},
      /* 0.3 / 0.1 is a little less than 3, and 1.1 / 0.1 a little more than 11 */
      {"along: [1, 0, 0], pitch: 0.1, over: 0.3, last gap: open", 4, {0, 0.1, 0.2, 0.3}},
      {"along: [1, 0, 0], pitch: 0.1, over: 1.1", 12, {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1}},
      {"along: [1, 0, 0], pitch: 0.3, over: 1", 5, {0, 0.3, 0.6, 0.9, 1}},
      {"along: [1, 0, 0], pitch: 0.3, over: 1, last gap: short", 5, {0, 0.3, 0.6, 0.9, 1}},
      {"along: [1, 0, 0], pitch: 0.3, over: 1, last gap: even", 5, {0, 0.25, 0.5, 0.75, 1}},
      {"along: [1, 0, 0], pitch: 0.2, over: 1, last gap: even", 6, {0, 0.2, 0.4, 0.6, 0.8, 1}},
      {"along: [1, 0, 0], pitch: 0.3, over: 1, last gap: open", 4, {0, 0.3, 0.6, 0.9}},
      {"along: [1, 0, 0], pitch: 0.3, over: 0.2", 2, {0, 0.2}},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *bars = text_format("s: {points: [[0.05, 0.1, 0.05], [0.05, 0.7, 0.05], [0.05, 0.7, 0.25]], diameter: 8 mm, "
                             "material: steel, repeat: {%s}}",
                             cases[k].repeat);
    breccia_model *m = model_of(SLAB(RAMP), bars, "");
    const Bars *b = bars_of(m);
    double length = 0;
    assert_int_equal(b->specs->count, cases[k].lines);
    assert_int_equal(deck_bar_lines(b, 0), cases[k].lines);
    for (int n = 0; n < b->specs->count; ++n)
      for (int64_t e = b->first[n]; e < b->first[n + 1]; ++e) {
        double middle[3];
        bar_middle(b, e, middle);
        assert_int_equal(bar_of(b, e), n);
        assert_int_equal(bar_nearest(b, 0, middle), e);
        length += b->length[e];
        for (int end = 0; end < 2; ++end) {
          assert_near(b->node[e + n + end][0], 0.05 + cases[k].at[n], 1e-14);
          assert_near(b->node[e + n + end][1], 0.4, 0.3 + 1e-14);
        }
      }
    assert_near(length, cases[k].lines * 0.8, 1e-12);
    breccia_model_destroy(&m);
    free(bars);
  }
}

/** Along a slanted direction, and along two: the first goes through its lines for each of the second. */
static void two_directions_make_a_grid(void **state)
{
  (void)state;
  breccia_model *m = model_of(SLAB(RAMP),
                              "ties: {points: [[0.1, 0.1, 0.05], [0.1, 0.1, 0.25]], diameter: 8 mm, material: steel, "
                              "repeat: [{along: [3, 4, 0], pitch: 0.25, number: 3}, {along: [1, 0, 0], pitch: 0.2, "
                              "over: 0.5, last gap: open}]}",
                              "");
  const Bars *b = bars_of(m);
  assert_int_equal(b->specs->count, 9);
  for (int n = 0; n < 9; ++n) {
    const int64_t node = b->first[n] + n;
    assert_near(b->node[node][0], 0.1 + 0.15 * (n % 3) + 0.2 * (n / 3), 1e-14);
    assert_near(b->node[node][1], 0.1 + 0.2 * (n % 3), 1e-14);
    assert_near(b->node[node][2], 0.05, 1e-14);
  }
  /* what is nearest to a point is looked for on all lines */
  const double point[3] = {0.1 + 0.15 + 0.4, 0.3, 0.2};
  assert_int_equal(bar_of(b, bar_nearest(b, 0, point)), 7);
  breccia_model_destroy(&m);
}

/** Bars of a mesh in two layers. @param[in] bond  further keys */
static char *mesh(bool by_pitch, const char *bond)
{
  Text t = {0};
  if (by_pitch) {
    text_add(&t,
             "along x: {points: [[0.05, 0.1, 0.05], [1.15, 0.1, 0.05]], diameter: 12 mm, material: steel%s, repeat: "
             "{along: [0, 1, 0], pitch: 0.25, over: 0.6}}, along y: {points: [[0.125, 0.05, 0.0625], [0.125, 0.75, "
             "0.0625]], diameter: 10 mm, number: 2, material: steel%s, repeat: {along: [1, 0, 0], pitch: 0.25, number: "
             "4}}",
             bond, bond);
    return text_take(&t);
  }
  static const double y[] = {0.1, 0.35, 0.6, 0.7};
  for (int n = 0; n < 4; ++n)
    text_add(&t,
             "along x %d: {points: [[0.05, %.17g, 0.05], [1.15, %.17g, 0.05]], diameter: 12 mm, material: steel%s}, ",
             n + 1, y[n], y[n], bond);
  for (int n = 0; n < 4; ++n)
    text_add(&t,
             "%salong y %d: {points: [[%.17g, 0.05, 0.0625], [%.17g, 0.75, 0.0625]], diameter: 10 mm, number: 2, "
             "material: steel%s}",
             n ? ", " : "", n + 1, 0.125 + 0.25 * n, 0.125 + 0.25 * n, bond);
  return text_take(&t);
}

static void assert_same_bits(const StateCopy *a, const StateCopy *b)
{
  assert_int_equal(a->count, b->count);
  for (int k = 0; k < a->count; ++k) {
    const StateRow *row = &a->rows[k];
    assert_int_equal(row->count, b->rows[k].count);
    if (memcmp(a->values[k], b->values[k], state_size(row) * (size_t)row->count)) fail_msg("'%s' differs", row->name);
  }
}

static void a_mesh_by_pitch_has_the_bits_of_its_bars_one_by_one(void **state)
{
  (void)state;
  static const char *const bonds[] = {"", ", bond: {compressive strength: 38 MPa, rib spacing: 8 mm}"};
  for (int k = 0; k < 2; ++k) {
    BarReport by_pitch[2] = {{0}};
    StateCopy copies[2];
    breccia_model *models[2];
    for (int way = 0; way < 2; ++way) {
      char *bars = mesh(way == 0, bonds[k]);
      breccia_model *m = models[way] =
          model_of(SLAB(RAMP), bars,
                   way == 0 ? ", {prestress: {bars: [along x], stress: 2e5}, history: {ramp to: 1}}"
                            : ", {prestress: {bars: [along x 1, along x 2, along x 3, along x 4], "
                              "stress: 2e5}, history: {ramp to: 1}}");
      free(bars);
      step_surely(m, INT64_MAX);
      copies[way] = state_of(m);
      for (int n = 0; n < 2 && way == 0; ++n) by_pitch[n] = bar_report(bars_of(m), n);
    }
    assert_same_bits(&copies[0], &copies[1]);
    for (int n = 0; n < 2; ++n) { /* what is told of a bar at a pitch is what its lines have together */
      BarReport all = bar_report(bars_of(models[1]), 4 * n);
      for (int line = 1; line < 4; ++line) {
        const BarReport r = bar_report(bars_of(models[1]), 4 * n + line);
        all.least_stress = fmin(all.least_stress, r.least_stress);
        all.largest_stress = fmax(all.largest_stress, r.largest_stress);
        all.highest_stress = fmax(all.highest_stress, r.highest_stress);
        all.largest_slip = fmax(all.largest_slip, r.largest_slip);
        all.stored += r.stored;
        all.dissipated += r.dissipated;
        all.yielded += r.yielded;
      }
      assert_true(all.highest_stress > 1e5);
      assert_near(by_pitch[n].least_stress, all.least_stress, 0);
      assert_near(by_pitch[n].largest_stress, all.largest_stress, 0);
      assert_near(by_pitch[n].highest_stress, all.highest_stress, 0);
      assert_near(by_pitch[n].largest_slip, all.largest_slip, 0);
      assert_near(by_pitch[n].stored, all.stored, 1e-12 * all.stored);
      assert_near(by_pitch[n].dissipated, all.dissipated, 1e-9 * all.stored);
      assert_near(by_pitch[n].yielded, all.yielded / 4, 1e-12);
    }
    Text words = {0}, summary = {0}, about = {0};
    run_tell_bars(models[0], &words);
    run_add_bars(models[0], &summary);
    forces_describe(&models[0]->domain.forces, models[0]->units, &about);
    holds_words(text_words(&words), "bar 'along x', 4 lines: stress|bar 'along y', 4 lines");
    holds_words(text_words(&summary),
                "\"name\": \"along x\", \"elements\": 44, \"lines\": 4|\"elements\": 28, \"lines\": 4");
    holds_words(text_words(&about), "4 times 1 'along x' of|4 times 2 'along y' of|together; 72 elements");
    text_free(&words);
    text_free(&summary);
    text_free(&about);
    for (int way = 0; way < 2; ++way) {
      state_copy_destroy(&copies[way]);
      breccia_model_destroy(&models[way]);
    }
  }
}

static const char *bond_of_struck;

/** A slab whose halves fly apart, with its mesh and a grid of ties: steel yields, and bonds slip. */
static breccia_model *struck(int threads)
{
  char *bars = mesh(true, bond_of_struck);
  breccia_model *m = model_on(
      threads,
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  " STEEL "\n"
      "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.8, 0.3]}}}}\n"
      "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
      "bars: {%s, ties: {points: [[0.1, 0.1, 0.05], [0.1, 0.1, 0.25]], diameter: 4 mm, material: steel%s, "
      "repeat: [{along: [1, 0, 0], pitch: 0.3, over: 1}, {along: [0, 1, 0], pitch: 0.25, number: 3}]}}\n"
      "loads: [{on: {inside: {box: {from: [0, 0, 0], to: [0.6, 1, 1]}}}, initial velocity: {translation: [-2, 0, "
      "0.4]}},\n"
      "        {on: {inside: {box: {from: [0.6, 0, 0], to: [2, 1, 1]}}}, initial velocity: {translation: [2, 0.4, "
      "0]}},\n"
      "        {prestress: {bars: [along x], stress: 2e5}, history: {ramp to: 1e-3}}]\n"
      "solve: {explicit: {end time: 1}}\npictures: []\n",
      bars, bond_of_struck);
  free(bars);
  return m;
}

static void threads_and_restarts_give_the_same_bits(void **state)
{
  (void)state;
  static const char *const bonds[] = {"", ", bond: {compressive strength: 38 MPa, rib spacing: 8 mm}"};
  for (int k = 0; k < 2; ++k) {
    bond_of_struck = bonds[k];
    breccia_model *m = struck(2);
    step_surely(m, 120);
    const BarReport mesh_across = bar_report(bars_of(m), 0), ties = bar_report(bars_of(m), 2);
    print_message("mesh: yielded %g, slip %g; ties: stress %g to %g\n", mesh_across.yielded, mesh_across.largest_slip,
                  ties.lowest_stress, ties.highest_stress);
    assert_true(k ? mesh_across.largest_slip > 5e-5 : mesh_across.yielded > 0.05);
    assert_true(ties.highest_stress > 1e3);
    breccia_model_destroy(&m);
    assert_same_bits_by_threads_and_restart(struck, 60, 120);
  }
}

static void nonsense_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *repeat, *words;
  } wrong[] = {
      {"{along: [0, 0, 0], pitch: 0.1, number: 3}", "along: must not be zero"},
      {"{along: [1, 0, 0], pitch: 0, number: 3}", "pitch"},
      {"{along: [1, 0, 0], pitch: 0.1, number: 1}", "number"},
      {"{along: [1, 0, 0], pitch: 0.1, over: -1}", "over"},
      {"{along: [1, 0, 0], pitch: 0.1}", "number|over"},
      {"{along: [1, 0, 0], pitch: 0.1, number: 3, over: 0.2}", "number|over"},
      {"{along: [1, 0, 0], pitch: 0.1, number: 3, last gap: even}", "last gap: says how lines fill a length"},
      {"{along: [1, 0, 0], pitch: 0.4, over: 0.2, last gap: open}", "over: shorter than one pitch"},
      {"{along: [1, 0, 0], pitch: 1e-7, over: 1}", "pitch: makes 1e+07 lines, and a bar may have 10000"},
      {"{along: [1, 0, 0], pitch: 1e-3, over: 10}", "pitch: makes 10001 lines, and a bar may have 10000"},
      {"{along: [1, 0, 0], pitch: 1e-3, over: 9.9999}", "pitch: makes 10001 lines, and a bar may have 10000"},
      {"{along: [1, 0, 0], pitch: 1e-3, over: 9.9999, last gap: open}", "is outside the body at [1.232"},
      {"{along: [1, 0, 0], pitch: 0.3, over: 2}", "repeat: bar 's 5' is outside the body at [1.25, "},
      {"[{along: [1, 0, 0], pitch: 1e-3, over: 1}, {along: [0, 1, 0], pitch: 1e-3, number: 100}]",
       "repeat: makes 100100 lines"},
      {"[{along: [1, 0, 0], pitch: 0.1, number: 2}, {along: [0, 1, 0], pitch: 0.1, number: 2}, {along: [0, 0, 1], "
       "pitch: 0.1, number: 2}]",
       "repeat: one or two directions, and here are 3"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char *bars = text_format("s: {points: [[0.05, 0.1, 0.05], [0.05, 0.6, 0.05]], diameter: 8 mm, material: steel, "
                             "repeat: %s}",
                             wrong[k].repeat);
    char *deck = text_format(SLAB(RAMP), bars, "");
    char *words = refusal_of(deck);
    holds_words(words, "deck:7:");
    holds_words(words, wrong[k].words);
    free(words);
    free(deck);
    free(bars);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_stand_at_the_pitch),
      cmocka_unit_test(two_directions_make_a_grid),
      cmocka_unit_test(a_mesh_by_pitch_has_the_bits_of_its_bars_one_by_one),
      cmocka_unit_test(threads_and_restarts_give_the_same_bits),
      cmocka_unit_test(nonsense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

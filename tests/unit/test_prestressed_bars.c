/* Bars whose steel begins under stress, and bars that bond has let go: what they report, against their law by hand. */
#include "support.h"

#include "bars/bars.h"

static const double young = 2e8, section = 1e-4, length = 1, yield = 1.6e6;

/** A block that is stretched alike, with a bar along it. */
static breccia_model *stretched(const char *law, const char *bar, const char *history)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
                  "  steel: {model: %s, density: 7, Young modulus: 2e8, yield stress: 1.6e6}\n"
                  "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1, 0.2, 0.2]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                  "bars: {bar: {points: [[0, 0.1, 0.1], [1, 0.1, 0.1]], area: 1e-4, material: steel%s}}\n"
                  "loads: [{on: {all: yes}, field: {displacement: ['0.01 * x', 0 m, 0 m]}, history: {table: [%s]}}]\n"
                  "solve: {static: {increments: 20, end time: 1}}\npictures: []\n",
                  law, bar, history);
}

static const Bars *bars_of(const breccia_model *m)
{
  return bars_among(&m->domain.forces);
}

/** Energy of steel at a stress. */
static double held(double stress)
{
  return section * length * stress * stress / (2 * young);
}

static void steel_that_begins_under_stress_keeps_its_books(void **state)
{
  (void)state;
  static const char *const laws[] = {"elastic-perfectly-plastic, initial strain: -5e-3",
                                     "menegotto-pinto, initial stress: 1e6, roundness: 200, roundness fall: 0, "
                                     "hardening ratio: 0"};
  const struct {
    const char *history;
    double stress, yields; /* the first increment beyond the yield strain by 2 %; below zero: none */
  } cases[] = {{"[0, 0], [1, 0.2]", 1.4e6, -1},    /* stretched by 2e-3, elastic */
               {"[0, 0], [1, -0.7]", -0.4e6, -1},  /* pushed back beyond where it is slack */
               {"[0, 0], [1, -0.5]", 0, -1},       /* to where it is */
               {"[0, 0], [1, 0.6]", 1.6e6, 0.55}}; /* yields at 3e-3; E e + 1e6 is above 1.632e6 from 3.16e-3 on */
  for (size_t l = 0; l < 2; ++l)
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
      breccia_model *m = stretched(laws[l], "", cases[k].history);
      const Bars *b = bars_of(m);
      BarReport r = bar_report(b, 0);
      assert_near(r.least_stress, 1e6, 1e-3); /* before the first increment */
      assert_near(r.stored, held(1e6), 1e-9);
      assert_near(m->solver.ledger.stored_at_start, held(1e6), 1e-9);
      step_surely(m, INT64_MAX);
      r = bar_report(b, 0);
      const bool yields = cases[k].yields > 0;
      const double slid = yields ? 0.006 - (yield - 1e6) / young : 0;
      assert_near(r.largest_stress, cases[k].stress, 2e-3 * 1e6);
      assert_near(r.lowest_stress, fmin(1e6, cases[k].stress), 2e-3 * 1e6);
      assert_near(r.highest_stress, fmax(1e6, cases[k].stress), 2e-3 * 1e6);
      assert_near(r.yielded, yields, 1e-12);
      if (yields) assert_near(b->yielded[r.first_yielded], cases[k].yields, 1e-9);
      assert_near(r.stored, held(cases[k].stress), 5e-3 * held(1e6));
      assert_near(r.dissipated, section * length * yield * slid, 5e-3 * held(1e6));
      assert_balanced(m, 1e-6);
      breccia_model_destroy(&m);
    }
}

/** Rounded corners: such steel leaves the stress that it began with by a jump to its curve. It holds the whole of it at first, and has dissipated nothing
 *  when the body gives way a little. */
static void rounded_steel_under_stress_holds_all_of_it(void **state)
{
  (void)state;
  static const char *const roundness[] = {"", ", roundness: 8", ", roundness: 20"};
  for (size_t k = 0; k < sizeof roundness / sizeof *roundness; ++k)
    for (int sign = -1; sign <= 1; sign += 2) {
      char law[160];
      snprintf(law, sizeof law, "menegotto-pinto, initial stress: %de5, hardening ratio: 0%s", 9 * sign, roundness[k]);
      breccia_model *m = stretched(law, "", sign > 0 ? "[0, 0], [1, -0.02]" : "[0, 0], [1, 0.02]");
      const Bars *b = bars_of(m);
      assert_near(bar_report(b, 0).stored, held(9e5), 1e-9);
      assert_near(m->solver.ledger.stored_at_start, held(9e5), 1e-9);
      step_surely(m, INT64_MAX);
      const BarReport r = bar_report(b, 0);
      assert_near(fabs(r.largest_stress), 9e5 - 2e-4 * young, 2e-3 * 9e5);
      assert_near(r.stored, held(r.largest_stress), 5e-3 * held(9e5));
      assert_near(r.dissipated, 0, 5e-3 * held(9e5));
      assert_near(solver_energy(&m->solver).dissipated, 0, 5e-3 * held(9e5));
      assert_balanced(m, 1e-4);
      breccia_model_destroy(&m);
    }
}

/** Concrete that splits lets the bar go: roundings of its stress are no yielding. */
static void a_bar_that_bond_lets_go_has_not_yielded(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
      "  steel: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5}\n"
      "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1, 0.2, 0.2]}}}}\n"
      "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
      "bars: {bar: {points: [[0, 0.1, 0.1], [1, 0.1, 0.1]], area: 1e-4, material: steel, bonded: [0, 0.2], anchored: "
      "[end],\n"
      "             bond: {compressive strength: 30 MPa, rib spacing: 8 mm, splitting stress: 4 MPa}}}\n"
      "loads: [{on: {all: yes}, field: {displacement: ['0.02*max(0 m, x-0.5 m)', 0 m, 0 m]}, history: {ramp to: 1}}]\n"
      "solve: {static: {increments: 40, end time: 1}}\npictures: []\n");
  step_surely(m, INT64_MAX);
  const BarReport r = bar_report(bars_of(m), 0);
  assert_true(r.highest_stress > 1e5 && r.highest_stress < 5e5);
  assert_near(r.largest_stress, 0, 1e-6 * r.highest_stress);
  assert_near(r.yielded, 0, 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steel_that_begins_under_stress_keeps_its_books),
      cmocka_unit_test(rounded_steel_under_stress_holds_all_of_it),
      cmocka_unit_test(a_bar_that_bond_lets_go_has_not_yielded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bars whose steel begins under stress, and bars that bond has let go: what they report, against their law by hand. */
#include "servers.h"

#include "bars/bars.h"

static const double young = 2e8, section = 1e-4, length = 1, yield = 1.6e6;

/** A block that is stretched alike, with a bar along it.
 *  @param[in] steel  what makes its material, without density */
static breccia_model *stretched(const char *steel, const char *bar, const char *history, const char *solve)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
                  "  steel: {%s, density: 7}\n"
                  "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1, 0.2, 0.2]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                  "bars: {bar: {points: [[0, 0.1, 0.1], [1, 0.1, 0.1]], area: 1e-4, material: steel%s}}\n"
                  "loads: [{on: {all: yes}, field: {displacement: ['0.01 * x', 0 m, 0 m]}, history: {table: [%s]}}]\n"
                  "solve: %s\npictures: []\n",
                  steel, bar, history, solve);
}

#define REST "{static: {increments: 20, end time: 1}}"

static const Bars *bars_of(const breccia_model *m)
{
  return bars_among(&m->domain.forces);
}

/** Energy of steel at a stress. */
static double held(double stress)
{
  return section * length * stress * stress / (2 * young);
}

/** What makes a steel of a law of this program, or of the same law in a server: keys and values with "; " between. To be freed. */
static char *steel_of(const char *law, const Servers *servers)
{
  char *steel = servers ? text_format("remote: '%s; Young modulus=2e8; yield stress=1.6e6', server: ['%s']", law,
                                      servers->address[0])
                        : text_format("model: %s, Young modulus: 2e8, yield stress: 1.6e6", law);
  for (char *at = steel; !servers && *at; ++at) {
    if (*at == ';') *at = ',';
    if (*at == '=') *at = ':';
  }
  return steel;
}

static void check_books(const char *law, const Servers *servers)
{
  const struct {
    const char *history;
    double stress, yields; /* the first increment beyond the yield strain by 2 %; below zero: none */
  } cases[] = {{"[0, 0], [1, 0.2]", 1.4e6, -1},    /* stretched by 2e-3, elastic */
               {"[0, 0], [1, -0.7]", -0.4e6, -1},  /* pushed back beyond where it is slack */
               {"[0, 0], [1, -0.5]", 0, -1},       /* to where it is */
               {"[0, 0], [1, 0.6]", 1.6e6, 0.55}}; /* yields at 3e-3; E e + 1e6 is above 1.632e6 from 3.16e-3 on */
  char *steel = steel_of(law, servers);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = stretched(steel, "", cases[k].history, REST);
    const Bars *b = bars_of(m);
    step_surely(m, 0); /* servers have their points when a run begins */
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
  free(steel);
}

static const char *const laws[] = {"elastic-perfectly-plastic; initial strain= -5e-3",
                                   "menegotto-pinto; initial stress= 1e6; roundness= 200; roundness fall= 0; "
                                   "hardening ratio= 0"};

static void steel_that_begins_under_stress_keeps_its_books(void **state)
{
  (void)state;
  for (int l = 0; l < 2; ++l) check_books(laws[l], NULL);
}

/** Servers tell only when a run begins what their steel carries at no strain. */
static void steel_of_servers_that_begins_under_stress_keeps_its_books(void **state)
{
  (void)state;
  Servers servers;
  servers_start(&servers, 1);
  for (int l = 0; l < 2; ++l) check_books(laws[l], &servers);
  servers_stop(&servers);
}

/** In a stage of elastic laws steel adds to the stress with which it began: 1e6 + 2e8 * 1e-3, and keeps that in the stage behind it: where it has rounded
 *  corners as long as nothing moves. */
static void elastic_stages_add_to_the_stress_at_first(void **state)
{
  (void)state;
  static const char rounded[] = "menegotto-pinto; initial stress= 1e6";
  for (int l = 0; l < 3; ++l) {
    char *steel = steel_of(l < 2 ? laws[l] : rounded, NULL);
    breccia_model *m = stretched(steel, "", l < 2 ? "[0, 0], [1, 0.1], [2, 0.2]" : "[0, 0], [1, 0.1]",
                                 "[{laws: elastic, static: {increments: 4, end time: 1}}, "
                                 "{static: {increments: 4, end time: 1}}]");
    const Bars *b = bars_of(m);
    step_surely(m, 4);
    assert_near(m->solver.clock.time, 1, 1e-12);
    BarReport r = bar_report(b, 0);
    assert_near(r.least_stress, 1.2e6, 1e-3);
    assert_near(r.stored, held(1.2e6), 1e-6 * held(1.2e6));
    step_surely(m, INT64_MAX);
    assert_near(m->solver.clock.time, 2, 1e-12);
    r = bar_report(b, 0);
    const double stress = l < 2 ? 1.4e6 : 1.2e6;
    assert_near(r.least_stress, stress, 2e-3 * 1e6);
    assert_near(r.stored, held(stress), 5e-3 * held(1e6));
    assert_near(r.dissipated, 0, 5e-3 * held(1e6));
    assert_near(r.yielded, 0, 0);
    assert_balanced(m, 1e-6);
    breccia_model_destroy(&m);
    free(steel);
  }
}

/** Rounded corners: such steel leaves the stress that it began with by a jump to its curve. It holds the whole of it at first, and has dissipated nothing
 *  when the body gives way a little. */
static void rounded_steel_under_stress_holds_all_of_it(void **state)
{
  (void)state;
  static const char *const roundness[] = {"", "; roundness= 8", "; roundness= 20"};
  Servers servers;
  servers_start(&servers, 1);
  for (int served = 0; served < 2; ++served)
    for (size_t k = 0; k < sizeof roundness / sizeof *roundness; ++k)
      for (int sign = -1; sign <= 1; sign += 2) {
        char *law = text_format("menegotto-pinto; initial stress= %de5; hardening ratio= 0%s", 9 * sign, roundness[k]);
        char *steel = steel_of(law, served ? &servers : NULL);
        breccia_model *m = stretched(steel, "", sign > 0 ? "[0, 0], [1, -0.02]" : "[0, 0], [1, 0.02]", REST);
        const Bars *b = bars_of(m);
        step_surely(m, 0);
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
        free(steel);
        free(law);
      }
  servers_stop(&servers);
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
      cmocka_unit_test(steel_of_servers_that_begins_under_stress_keeps_its_books),
      cmocka_unit_test(elastic_stages_add_to_the_stress_at_first),
      cmocka_unit_test(rounded_steel_under_stress_holds_all_of_it),
      cmocka_unit_test(a_bar_that_bond_lets_go_has_not_yielded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

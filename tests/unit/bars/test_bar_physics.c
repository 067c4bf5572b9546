/* Bars in what engineers know of them by hand: pull-out, energies, a beam in bending, the cracks of a tie. */
#include "support.h"

#include "bars/bars.h"
#include "model/run.h"

static const Bars *bars_of(const breccia_model *m)
{
  return bars_among(&m->domain.forces);
}

static const double young = 2e8, section = 1e-4, stiffness = 1.4e7;

static double around(void)
{
  return sqrt(4 * acos(-1) * section);
}

static double lambda(void)
{
  return sqrt(stiffness * around() / (young * section));
}

#define ROD "{model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}"
#define STEEL "{model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e6, hardening ratio: 0.01}"

/** A prism whose particles are all moved as the deck says, with a bar along it. */
static breccia_model *led(double spacing, const char *steel, const char *keys, const char *field)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  rod: %s\n"
                  "body: {b: {material: soft, spacing: %g, shape: {box: {from: [0, 0, 0], to: [1.2, 0.2, 0.2]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                  "bars: {bar: {points: [[0, 0.1, 0.1], [1.2, 0.1, 0.1]], area: 1e-4, material: rod%s}}\n"
                  "loads: [{on: {all: yes}, field: {displacement: ['%s', 0 m, 0 m]}, history: {ramp to: 1}}]\n"
                  "solve: {static: {increments: 1, end time: 1}}\npictures: []\n",
                  steel, spacing, keys, field);
}

/** Slip and stress of a bar that is pulled out of concrete at rest: s = s_l cosh(lambda x) / cosh(lambda l), stress as sinh(lambda x) / sinh(lambda l),
 *  lambda^2 = stiffness of bond times perimeter / (E A). Errors fall with the square of the spacing. */
static void pull_out_converges_to_the_closed_form(void **state)
{
  (void)state;
  const double l = 0.4, rate = lambda(), stiff = young * section;
  const double force = 0.01 / (0.8 / stiff + 1 / (stiff * rate * tanh(rate * l))),
               slip = force / (stiff * rate * tanh(rate * l));
  double slips[3], stresses[3];
  for (int k = 0; k < 3; ++k) {
    breccia_model *m =
        led(0.1 / (1 << k), ROD, ", bond: {law: linear, stiffness: 1.4e7}, bonded: [0, 0.4], anchored: [end]",
            "0.02*max(0 m, x-0.7 m)");
    step_surely(m, INT64_MAX);
    const Bars *b = bars_of(m);
    slips[k] = stresses[k] = 0;
    for (int64_t n = 0; b->node[n][0] < l + 1e-9; ++n)
      slips[k] =
          larger_of(slips[k], fabs(b->slips->slip_held[n] - slip * cosh(rate * b->node[n][0]) / cosh(rate * l)) / slip);
    for (int64_t e = 0; b->node[e + 1][0] < l + 1e-9; ++e) {
      const double x = (b->node[e][0] + b->node[e + 1][0]) / 2,
                   by_hand = force / section * sinh(rate * x) / sinh(rate * l);
      stresses[k] = larger_of(stresses[k], fabs(b->stress_held[e] - by_hand) / (force / section));
    }
    print_message("pull-out, %g m apart: slips %.2e, stresses %.2e off\n", 0.1 / (1 << k), slips[k], stresses[k]);
    breccia_model_destroy(&m);
  }
  assert_true(slips[2] < 2e-3 && stresses[2] < 2e-3);
  for (int k = 0; k < 2; ++k) assert_true(slips[k] > 3 * slips[k + 1] && stresses[k] > 3 * stresses[k + 1]);
}

/** The number behind a word. */
static double number_behind(const char *text, const char *word)
{
  const char *at = strstr(text, word);
  if (!at) fail_msg("there is no %s in %s", word, text);
  return atof(at + strlen(word));
}

/** Energies of an even strain e: E A e^2 l / 2 in perfect bond; of a bar with linear bond and free ends those of its strain
 *  e (1 - cosh(lambda x) / cosh(lambda l)) and of its bond, whose slip is - e sinh(lambda x) / (lambda cosh(lambda l)). The report, summary.json and the words
 *  at the end tell them. */
static void reports_tell_the_energy_that_is_stored(void **state)
{
  (void)state;
  const double strain = 1e-3, l = 0.6, rate = lambda(), end = cosh(rate * l);
  const double squares =
      2 * l - 4 * sinh(rate * l) / (rate * end) + (l + sinh(2 * rate * l) / (2 * rate)) / (end * end);
  const double slips = (sinh(2 * rate * l) / (2 * rate) - l) / (rate * rate * end * end);
  const double perfect = young * section * strain * strain * l,
               bonded = strain * strain * (young * section * squares + stiffness * around() * slips) / 2;
  static const char *const laws[] = {ROD, STEEL};
  for (int law = 0; law < 2; ++law)
    for (int bond = 0; bond < 2; ++bond) {
      breccia_model *m = led(0.05, laws[law], bond ? ", bond: {law: linear, stiffness: 1.4e7}" : "", "0.001*x");
      step_surely(m, INT64_MAX);
      const BarReport r = bar_report(bars_of(m), 0);
      const double by_hand = bond ? bonded : perfect;
      assert_near(r.stored, by_hand, (bond ? 0.01 : 1e-6) * by_hand);
      assert_near(r.dissipated, 0, 1e-6 * by_hand);
      assert_near(m->domain.forces.type[0]->energy(m->domain.forces.own[0]), r.stored, 1e-9 * by_hand);
      Text summary = {0}, words = {0};
      run_add_bars(m, &summary);
      run_tell_bars(m, &words);
      assert_near(number_behind(text_words(&summary), "\"stored\": "), r.stored, 1e-9 * by_hand);
      assert_near(number_behind(text_words(&words), "stored "), 1e3 * r.stored, 0.01 * 1e3 * by_hand); /* J */
      text_free(&summary);
      text_free(&words);
      breccia_model_destroy(&m);
    }
}

/** What the load of a number exerts along x. */
static double exerted(const breccia_model *m, int load)
{
  const Particles *p = m->domain.particles;
  const Load *l = &m->loading.loads[load];
  double sum = 0;
  for (int64_t n = 0; n < l->selection.count; ++n)
    sum -= p->internal.row[0][l->selection.places[n]] * p->volume[l->selection.places[n]];
  return sum;
}

enum { MOST_CRACKS = 40 };

/** Where the bar has its peaks of stress: in cracks. @return how many */
static int find_cracks(const Bars *b, double *at)
{
  double most = 0;
  int count = 0;
  for (int64_t e = 0; e < b->count; ++e) most = fmax(most, b->stress_held[e]);
  for (int64_t e = 1; e < b->count - 1 && count < MOST_CRACKS; ++e)
    if (b->stress_held[e] > 0.85 * most && b->stress_held[e] >= b->stress_held[e - 1] &&
        b->stress_held[e] > b->stress_held[e + 1]) {
      double middle[3];
      bar_middle(b, e, middle);
      at[count++] = middle[0];
    }
  return count;
}

/** A tie of 1.2 m that is pulled beyond its cracks. Its section bears f_t (A_c + n A_s) before it cracks between the grips. By fib Model Code 2010, 7.6.4.4,
 *  concrete needs l = d / (4 * 1.8 rho) to come to its strength again by bond of 1.8 f_t, so that cracks stand l to 2 l apart; and the bar, in the mean, is
 *  stretched less than a bare one, by 0.6 of what the section loses in its first crack at most (beta of 7.6.4.4, short-term). */
static void cracks_of_a_tie_stand_apart_by_bond(void **state)
{
  (void)state;
  if (under_sanitizers()) skip();
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n"
      "  concrete: {model: exponential-softening, density: 2.4 t/m3, Young modulus: 30 GPa, tensile strength: 3 MPa, "
      "fracture energy: 100 N/m}\n"
      "  steel: {model: steel-bilinear, density: 7.85 t/m3, Young modulus: 200 GPa, yield stress: 500 MPa, hardening "
      "ratio: 0.01}\n"
      "body: {tie: {material: concrete, lattice: square, spacing: 20 mm, thickness: 120 mm, shape: {box: {from: [0, "
      "0], to: [1.2, 0.12]}}}}\n"
      "bars: {bar: {points: [[0, 0.06], [1.2, 0.06]], diameter: 16 mm, material: steel, anchored: [start, end],\n"
      "       bond: {compressive strength: 38 MPa, rib spacing: 8 mm}}}\n"
      "peridynamics: {formulation: bond-based, space: plane stress, surface correction: energy, strength of: "
      "bonds}\n"
      "loads:\n"
      "  - {name: left, on: {face: x-, layers: 3}, displacement: [0, 0]}\n"
      "  - {name: right, on: {face: x+, layers: 3}, displacement: [1.5 mm, 0], history: {ramp to: 1}}\n"
      "solve: {static: {increments: 40, method: relaxation, residual: 1e-5}}\npictures: []\n");
  const double concrete = 0.12 * 0.12, steel = acos(-1) / 4 * 0.016 * 0.016, rho = steel / concrete, ratio = 200.0 / 30;
  const double cracks_at = 3e3 * (concrete + ratio * steel), lost = 3e3 / rho * (1 + ratio * rho),
               apart = 0.016 / (4 * 1.8 * rho);
  const Bars *b = bars_of(m);
  double first = 0, at[MOST_CRACKS];
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    if (m->solver.clock.time < 0.4) first = fmax(first, exerted(m, 1));
  }
  const int count = find_cracks(b, at);
  double closest = INFINITY, widest = 0, mean = 0, length = 0;
  for (int k = 1; k < count; ++k) {
    closest = fmin(closest, at[k] - at[k - 1]);
    widest = fmax(widest, at[k] - at[k - 1]);
  }
  for (int64_t e = 0; e < b->count; ++e) {
    double middle[3];
    bar_middle(b, e, middle);
    if (middle[0] < at[0] || middle[0] > at[count - 1]) continue;
    mean += b->strain_held[e] * b->length[e];
    length += b->length[e];
  }
  const double force = exerted(m, 1), bare = force / steel;
  mean = 2e8 * mean / length;
  print_message("tie: cracks at %.3f of its section; %d cracks %.0f to %.0f mm apart (%.0f to %.0f); bar %.0f MPa in "
                "the mean, bare %.0f, "
                "by the code %.0f\n",
                first / cracks_at, count, 1e3 * closest, 1e3 * widest, 1e3 * apart, 2e3 * apart, mean / 1e3, bare / 1e3,
                (bare - 0.6 * lost) / 1e3);
  assert_true(first > 0.93 * cracks_at && first < 1.05 * cracks_at);
  assert_true(count >= 4 && closest > apart && widest < 2 * apart);
  assert_true(mean < 0.95 * bare && mean > bare - 0.6 * lost);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pull_out_converges_to_the_closed_form),
      cmocka_unit_test(reports_tell_the_energy_that_is_stored),
      cmocka_unit_test(cracks_of_a_tie_stand_apart_by_bond),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

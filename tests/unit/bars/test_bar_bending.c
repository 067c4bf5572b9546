/* Bars that resist bending against beams: clamped at an end, bent to a sine, turned, torn, in motion. */
#include "forces_beside.h"

#include "bars/bars.h"
#include "solver/modes.h"

static const double young = 2e8;

/** Of a round bar of an area. */
static double stiffness(double area)
{
  return young * area * area / (4 * acos(-1));
}

static Bars *bars_of(const breccia_model *m)
{
  return m->domain.forces.own[0];
}

/** A beam of four rows clamped at one end, with a bar in the middle of its height. */
static breccia_model *beam_of(const char *keys, const char *loads, const char *solver)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials:\n  soft: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0}\n"
                  "  rod: {model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}\n"
                  "body: {b: {material: soft, spacing: 0.1, lattice: square, thickness: 0.5, shape: {box: {from: [0, "
                  "-0.2], to: [4, "
                  "0.2]}}}}\n"
                  "peridynamics: {formulation: correspondence, space: plane stress, horizon: 1.5 spacings}\n"
                  "bars: {rod: {points: [[0.05, 0], [3.95, 0]], area: 2.5e-3, number: 2, material: rod%s}}\n"
                  "loads:\n  - {on: {inside: {box: {from: [-1, -1], to: [1, 1]}}}, displacement: [0, 0]}\n%s"
                  "solve: {%s}\npictures: []\n",
                  keys, loads, solver);
}

static double height(const Bars *b, int64_t node)
{
  double u[3];
  bar_node_displacement(b, node, u);
  return u[1];
}

/** Bending stiffness of the beam: the end is P L^3 / (3 E I) off the line that goes on straight from a section away from the clamp. */
static double stiffness_of_beam(const char *keys)
{
  const double load = 1e-4;
  const int64_t from = 15;
  breccia_model *m =
      beam_of(keys, "  - {on: {face: x+}, force: [0, 1e-4]}\n", "static: {increments: 1, residual: 1e-7}");
  step_surely(m, INT64_MAX);
  const Bars *b = bars_of(m);
  const double length = b->node[b->count][0] - b->node[from][0],
               slope = (height(b, from + 1) - height(b, from - 1)) / (b->node[from + 1][0] - b->node[from - 1][0]),
               bent = height(b, b->count) - height(b, from) - slope * length;
  breccia_model_destroy(&m);
  return load * pow(length, 3) / (3 * bent);
}

static void a_bar_adds_its_bending_stiffness(void **state)
{
  (void)state;
  const double with = stiffness_of_beam(", bending: yes"), without = stiffness_of_beam(""),
               by_hand = 2 * stiffness(2.5e-3);
  print_message("%.4g and %.4g without: %.4g of %.4g more\n", with, without, with - without, by_hand);
  assert_near(with - without, by_hand, 0.03 * by_hand);
}

/** Energy of a sine a sin(k x): a^2 k^4 E I / 4 a length. */
static void a_sine_holds_its_energy(void **state)
{
  (void)state;
  const double a = 1e-5, k = 2 * acos(-1) / 4;
  breccia_model *m = beam_of(", bending: yes", "", "explicit: {end time: 1}");
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->displacement.row[1][i] = a * sin(k * p->position[0][i]);
  }
  compute_forces(m);
  Bars *b = bars_of(m);
  bars_accept(b);
  const double energy = 2 * stiffness(2.5e-3) * a * a * pow(k, 4) / 4 * 4;
  print_message("sine: %.4g of %.4g\n", bars_bent(b, 0, b->count), energy);
  assert_near(bars_bent(b, 0, b->count), energy, 0.03 * energy);
  breccia_model_destroy(&m);
}

static const char *const lattices[] = {"square", "hexagonal", "cubic", "face-centred cubic"};

/** A body with a bar that stands nowhere on particles and has a corner; of its corner nothing is known, of both pieces bending. */
static breccia_model *bent_bar(const char *lattice)
{
  const bool plane = lattice[0] == 's' || lattice[0] == 'h';
  return model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1}\n"
      "  rod: {model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}\n"
      "body: {b: {material: soft, spacing: 0.1, lattice: %s%s, shape: {box: {from: [0, 0%s], to: [1, 0.6%s]}}}}\n"
      "peridynamics: {formulation: bond-based%s}\n"
      "bars: {bent: {points: [[0, 0.13%s], [0.52, 0.31%s], [1, 0.55%s]], diameter: 0.1, number: 2, material: rod, "
      "bending: yes}}\nsolve: {explicit: {end time: 1}}\npictures: []\n",
      lattice, plane ? ", thickness: 0.3" : "", plane ? "" : ", 0", plane ? "" : ", 0.5",
      plane ? ", space: plane stress" : "", plane ? "" : ", 0.21", plane ? "" : ", 0.29", plane ? "" : ", 0.17");
}

/** Energy of bars as they stand. */
static double energy_of(breccia_model *m)
{
  bars_accept(bars_of(m));
  return bars_energy(bars_of(m));
}

/** Forces and their changes against difference quotients of energy and of forces, where the whole is turned and strained; sums and moments. */
static void moments_follow_from_an_energy(void **state)
{
  (void)state;
  for (size_t l = 0; l < sizeof lattices / sizeof *lattices; ++l) {
    breccia_model *m = bent_bar(lattices[l]);
    const Particles *p = m->domain.particles;
    const bool plane = m->domain.body.dimensions == 2;
    deform_uniformly(m, (const double[]){0.8, -0.6, 0, 0.6, 0.81, 0, 0, 0, 1});
    shake(m, 0.03);
    Vector v[1] = {{0}}, changed[1] = {{0}}, up[1] = {{0}}, down[1] = {{0}}, here[1] = {{0}};
    double sum[6] = {0}, size = 0;
    find_beside(m, here);
    bars_linearise(bars_of(m));
    const double bent = (bars_accept(bars_of(m)), bars_bent(bars_of(m), 0, bars_of(m)->count)),
                 all = bars_energy(bars_of(m));
    assert_true(bent > 0.01 * all);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, c = (k + 2) % 3;
        sum[k] += p->volume[i] * here->row[k][i];
        sum[3 + k] += p->volume[i] * ((p->position[a][i] + p->displacement.row[a][i]) * here->row[c][i] -
                                      (p->position[c][i] + p->displacement.row[c][i]) * here->row[a][i]);
        size += fabs(p->volume[i] * here->row[k][i]);
      }
    }
    for (int k = 0; k < 6; ++k) assert_near(sum[k], 0, 1e-13 * size);
    uint64_t seed = 3;
    assert_true(vector_create(v, &p->space, "test", NULL));
    assert_true(vector_create(changed, &p->space, "test", NULL));
    for (int k = 0; k < 3; ++k) {
      for (int64_t n = 0; n < p->count && (k < 2 || !plane); ++n)
        v->row[k][p->place_of[n]] = random_uniform(&seed) - 0.5;
    }
    domain_change_forces(&m->domain, v, changed);
    const double h = 1e-7;
    double energy[2] = {0}, work = 0;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < 3; ++k)
        for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] += (side ? -2 : 1) * h * v->row[k][i];
      find_beside(m, side ? down : up);
      energy[side] = energy_of(m);
    }
    size = 0;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) size = larger_of(size, fabs(changed->row[k][i]));
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) {
        assert_near((up->row[k][i] - down->row[k][i]) / (2 * h), changed->row[k][i], 1e-6 * size);
        work -= p->volume[i] * (up->row[k][i] + down->row[k][i]) / 2 * v->row[k][i];
      }
    assert_near((energy[0] - energy[1]) / (2 * h), work, 1e-6 * fabs(work));
    drop(v);
    drop(changed);
    drop(up);
    drop(down);
    drop(here);
    breccia_model_destroy(&m);
  }
}

static void turning_bends_nothing_and_what_tears_is_lost(void **state)
{
  (void)state;
  breccia_model *m = bent_bar("cubic");
  Bars *b = bars_of(m);
  deform_uniformly(m, (const double[]){0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1});
  Vector force[1] = {{0}};
  find_beside(m, force);
  assert_near(energy_of(m), 0, 1e-12);
  drop(force);
  shake(m, 0.02);
  find_beside(m, force);
  energy_of(m);
  int64_t most = 0, corner = -1;
  for (int64_t e = 0; e < b->count; ++e) {
    if (b->bent[e] > b->bent[most]) most = e;
    if (e + 1 < b->count && !(b->bend[e] > 0)) corner = e;
  }
  assert_true(corner > 0 && b->bent[corner] == 0); /* it hands on no moment */
  const double before = bars_bent(b, 0, b->count), lost = b->bent[most], dissipated = bars_dissipated(b);
  assert_near(bar_report(b, 0).dissipated, dissipated, 1e-12 * before);
  b->torn[most + 1] = 0;
  const double behind = most + 2 < b->count ? b->bent[most + 1] : 0;
  bars_accept(b);
  assert_true(lost > 0);
  assert_near(bars_bent(b, 0, b->count), before - lost - behind, 1e-12 * before);
  assert_near(bars_dissipated(b), dissipated + lost + behind, 1e-12 * before);
  assert_near(bar_report(b, 0).dissipated, dissipated + lost + behind, 1e-12 * before); /* and of the bar itself */
  drop(force);
  breccia_model_destroy(&m);
}

/** Its stiffness is in the stable step, its energy in the ledger. */
static void a_bar_in_motion_keeps_its_energy(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.04}", "implicit: {end time: 0.04, time step: 0.002}"};
  for (int s = 0; s < 2; ++s) {
    breccia_model *m = beam_of(
        ", bending: yes", "  - {on: {face: x+}, force: [0, 0.5], history: {table: [[0, 0], [0.01, 1], [0.02, 0]]}}\n",
        solvers[s]);
    step_surely(m, INT64_MAX);
    const double bent = bars_bent(bars_of(m), 0, bars_of(m)->count), kinetic = m->solver.ledger.kinetic;
    print_message("kinetic %g, bending %g, %lld steps\n", kinetic, bent, (long long)m->solver.clock.step);
    assert_true(bent > 0.01 * kinetic && kinetic > 0);
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

static const char *solver_of_torn;
static bool bonded_in_torn;

/** A block whose halves fly or are drawn apart and past each other, so that bonds between them break, with a bar across and stirrups by pitch, all of
 *  which resist bending; they slip or do not. */
static breccia_model *torn_apart(int threads)
{
  const char *const bond = bonded_in_torn ? ", bond: {compressive strength: 2 MPa, rib spacing: 8 mm}" : "";
  const bool flies = !strstr(solver_of_torn, "static");
  return model_on(
      threads,
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n"
      "  steel: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5}\n"
      "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.4, 0.3]}}}}\n"
      "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
      "failure: {critical stretch: 0.01, near grips: hold}\n"
      "bars: {dowel: {points: [[0.02, 0.14, 0.11], [1.18, 0.23, 0.17]], diameter: 20 mm, material: steel, bending: "
      "yes%s},\n"
      "       stirrups: {points: [[0.15, 0.03, 0.13], [0.15, 0.37, 0.13]], diameter: 6 mm, material: steel, bending: "
      "yes%s, repeat: {along: [1, 0, 0], pitch: 0.3, number: 4}}}\n"
      "loads:\n  - {on: {face: x-, layers: 2}, %s}\n  - {on: {face: x+, layers: 2}, %s}\n"
      "solve: {%s}\npictures: []\n",
      bond, bond, flies ? "velocity: [0, 0, 0]" : "displacement: [0, 0, 0]",
      flies ? "velocity: [0.8, 0.8, 0], history: {ramp to: 0.005}"
            : "displacement: [0.03, 0.03, 0], history: {ramp to: 1}",
      solver_of_torn);
}

/** While bonds around them break, and bars bend, slip and yield. */
static void threads_and_restarts_give_the_same_bits(void **state)
{
  (void)state;
  static const struct {
    const char *solver;
    bool slips;
    int64_t half, last;
  } ways[] = {{"explicit: {end time: 1}", false, 150, 300},
              {"explicit: {end time: 1}", true, 150, 300},
              {"implicit: {end time: 1, time step: 1e-3}", true, 45, 60},
              {"static: {increments: 6}", false, 2, 3},
              {"static: {increments: 6, method: relaxation, residual: 1e-4}", true, 2, 3}};
  /* threads that wait for each other make the last one, by relaxation, as long as the others together */
  const size_t all = sizeof ways / sizeof *ways, count = under_sanitizers() ? 2 : whole_walks() ? all : all - 1;
  for (size_t w = 0; w < count; ++w) {
    solver_of_torn = ways[w].solver;
    bonded_in_torn = ways[w].slips;
    breccia_model *m = torn_apart(1);
    const Bars *b = bars_of(m);
    step_surely(m, ways[w].half);
    const int64_t broken = breccia_model_broken_bonds(m);
    step_surely(m, ways[w].last - ways[w].half);
    const BarReport dowel = bar_report(b, 0), stirrups = bar_report(b, 1);
    print_message("%s: %lld and %lld bonds broken, bending %g and %g of %g, slip %g\n", ways[w].solver,
                  (long long)broken, (long long)breccia_model_broken_bonds(m), bars_bent(b, 0, b->first[1]),
                  bars_bent(b, b->first[1], b->count), dowel.stored, dowel.largest_slip);
    assert_true(broken > 0 && breccia_model_broken_bonds(m) > broken);
    assert_true(bars_bent(b, 0, b->first[1]) > 1e-3 * dowel.stored);
    assert_true(bars_bent(b, b->first[1], b->count) > 1e-5 * stirrups.stored);
    assert_true(bonded_in_torn ? dowel.largest_slip > 1e-5 : dowel.yielded > 0.05);
    breccia_model_destroy(&m);
    assert_same_bits_by_threads_and_restart(torn_apart, ways[w].half, ways[w].last);
  }
}

/** Bars that bend make a body stiffer, along themselves no less than without: no mode becomes slower. */
static void modes_know_bars_that_bend(void **state)
{
  (void)state;
  enum { COUNT = 6 };
  double frequency[2][COUNT];
  for (int bends = 0; bends < 2; ++bends) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials:\n"
        "  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0}\n"
        "  s: {model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: {from: [0, -0.2], to: [2, "
        "0.2]}}}}\n"
        "bars: {r: {points: [[0.05, 0], [1.95, 0]], area: 2.5e-3, material: s%s}}\n"
        "peridynamics: {formulation: correspondence, space: plane stress, horizon: 1.5 spacings}\n"
        "loads: [{on: {inside: {box: {from: [-1, -1], to: [0.2, 1]}}}, displacement: [0, 0]}]\n"
        "solve: {explicit: {steps: 1}}\n",
        bends ? ", bending: yes" : "");
    Modes modes;
    Error *error = breccia_error_create();
    if (modes_find(&m->domain, &m->loading, COUNT, &modes, error)) fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
    for (int n = 0; n < COUNT; ++n) frequency[bends][n] = modes.modes[n].frequency;
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
  for (int n = 0; n < COUNT; ++n) assert_true(frequency[1][n] > 0.999 * frequency[0][n]);
}

/** Lines that are nothing but corners are refused; of others the description tells at how many joints they resist. */
static void corners_are_told(void **state)
{
  (void)state;
  const char *const deck =
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson "
      "ratio: 0}}\nbody: {b: {material: m, spacing: 0.1, lattice: square, thickness: 0.5, shape: {box: {from: [0, 0], "
      "to: "
      "[1, 0.5]}}}}\nperidynamics: {formulation: correspondence, space: plane stress}\nbars: {r: {points: [[0.1, 0.1], "
      "[0.2, 0.1], [0.3, 0.101]%s], diameter: 20 mm, material: m, bending: yes}}\nsolve: {explicit: {steps: 1}}\n";
  char *bad = text_format(deck, ""), *words = refusal_of(bad);
  if (!strstr(words, "deck:5:") || !strstr(words, "bending: no two elements of this line lie on one straight line"))
    fail_msg("%s", words);
  free(words);
  free(bad);
  breccia_model *m = model_of(deck, ", [0.5, 0.103]");
  const char *overview = breccia_model_overview(m);
  if (!strstr(overview, " at 2 of 3 joints; none at corners); 4 elements")) fail_msg("%s", overview);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bar_adds_its_bending_stiffness),
      cmocka_unit_test(a_sine_holds_its_energy),
      cmocka_unit_test(moments_follow_from_an_energy),
      cmocka_unit_test(turning_bends_nothing_and_what_tears_is_lost),
      cmocka_unit_test(modes_know_bars_that_bend),
      cmocka_unit_test(corners_are_told),
      cmocka_unit_test(threads_and_restarts_give_the_same_bits),
      cmocka_unit_test(a_bar_in_motion_keeps_its_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bars that slip, against closed forms, difference quotients and their law. */
#include "forces_beside.h"

#include "bars/bars.h"
#include "model/run.h"
#include "results/bar_lines.h"
#include "results/watch_parts.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ROD "rod: {model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}"
#define STEEL "rod: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01}"
#define FIB "law: fib, compressive strength: 30 MPa, rib spacing: 8 mm"

static Bars *bars_of(breccia_model *m)
{
  for (int k = 0; k < m->domain.forces.count; ++k)
    if (!strcmp(m->domain.forces.type[k]->name, "bars")) return m->domain.forces.own[k];
  fail_msg("no bars");
  return NULL;
}

/** A prism along x whose particles are all moved as the deck says, with a bar of section 1e-4 along it. */
static breccia_model *led(const char *steel, const char *keys, const char *field, const char *history, int increments)
{
  return model_of(UNITS
                  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  %s\n"
                  "body: {b: {material: soft, spacing: 0.05, shape: {box: {from: [0, 0, 0], to: [1.2, 0.2, 0.2]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                  "bars: {bar: {points: [[0, 0.1, 0.1], [1.2, 0.1, 0.1]], area: 1e-4, material: rod, %s}}\n"
                  "loads: [{on: {all: yes}, field: {displacement: ['%s', 0 m, 0 m]}, history: {table: [%s]}}]\n"
                  "watch: {bar: {bar: bar}, place: {bar: bar, at: [0.175, 0, 0]}}\n"
                  "solve: {static: {increments: %d, end time: 1}}\npictures: []\n",
                  steel, keys, field, history, increments);
}

static const double section = 1e-4, young = 2e8;

static double around(void)
{
  return acos(-1) * sqrt(4 / acos(-1) * section);
}

/** Concrete strained alike along a bar whose ends are free: s'' = lambda^2 s, s' = -strain at both ends. */
static void slip_along_a_free_bar_is_that_of_the_closed_form(void **state)
{
  (void)state;
  breccia_model *m = led(ROD, "bond: {law: linear, stiffness: 1.4e7}", "1e-4*x", "[0, 0], [1, 1]", 1);
  step_surely(m, INT64_MAX);
  const Bars *b = bars_of(m);
  const double l = 1.2, lambda = sqrt(1.4e7 * around() / (young * section)), end = 1e-4 * tanh(lambda * l / 2) / lambda;
  for (int64_t k = 0; k <= b->count; ++k) {
    const double x = b->node[k][0] - l / 2;
    assert_near(b->slips->slip_held[k], -1e-4 * sinh(lambda * x) / (lambda * cosh(lambda * l / 2)), 0.01 * end);
  }
  for (int64_t e = 0; e < b->count; ++e) {
    const double x = (b->node[e][0] + b->node[e + 1][0]) / 2 - l / 2;
    assert_near(b->stress_held[e], young * 1e-4 * (1 - cosh(lambda * x) / cosh(lambda * l / 2)), 0.01 * young * 1e-4);
  }
  breccia_model_destroy(&m);
}

#define PULL "0.02*max(0 m, x-0.7 m)"

/** A bar bonded in a block at rest and pulled by its other end, which is anchored in what moves: s = s_l cosh(lambda x) / cosh(lambda l). */
static void a_bar_is_pulled_out_as_by_the_closed_form(void **state)
{
  (void)state;
  breccia_model *m =
      led(ROD, "bond: {law: linear, stiffness: 1.4e7}, bonded: [0, 0.4], anchored: [end]", PULL, "[0, 0], [1, 1]", 1);
  step_surely(m, INT64_MAX);
  const Bars *b = bars_of(m);
  const Particles *p = m->domain.particles;
  double moved[3], held = 0;
  bar_node_displacement(b, b->count, moved);
  assert_near(moved[0], 0.01, 1e-12);
  const double l = 0.4, lambda = sqrt(1.4e7 * around() / (young * section)), stiff = young * section,
               force = moved[0] / (0.8 / stiff + 1 / (stiff * lambda * tanh(lambda * l))),
               slip = force / (stiff * lambda * tanh(lambda * l));
  for (int64_t k = 0; b->node[k][0] < l + 1e-9; ++k)
    assert_near(b->slips->slip_held[k], slip * cosh(lambda * b->node[k][0]) / cosh(lambda * l), 0.01 * slip);
  assert_near(b->slips->slip_held[b->count], 0, 0);
  const Watch *whole = &m->watches->items[0], *place = &m->watches->items[1];
  double told[10], there[5];
  assert_int_equal(watch_columns(whole->kind), 10);
  assert_int_equal(watch_columns(place->kind), 5);
  whole->kind->row(whole, &m->solver, told);
  place->kind->row(place, &m->solver, there);
  const double middle = slip * cosh(lambda * 0.175) / cosh(lambda * l);
  assert_near(told[8], 0, 1e-15);
  double most = 0;
  for (int64_t k = 0; k <= b->count; ++k) most = larger_of(most, b->slips->slip_held[k]);
  assert_near(told[9], most, 0);
  assert_near(there[3], middle, 0.01 * slip);
  assert_near(there[4], 1.4e7 * middle, 0.01 * 1.4e7 * slip);
  char folder[] = "/tmp/breccia-slips-XXXXXX", line[512] = "";
  assert_non_null(mkdtemp(folder));
  Text files = {0};
  assert_int_equal(bar_lines_write(&m->domain, folder, m->units, &files, NULL), 0);
  text_free(&files);
  char *path = text_format("%s/bars/bars.csv", folder);
  FILE *file = fopen(path, "r");
  double told_slip = 0;
  assert_non_null(fgets(line, sizeof line, file));
  holds_words(line, "torn since (s),slip (m),bond stress (kPa)");
  for (int row = 0; row < 4; ++row) assert_non_null(fgets(line, sizeof line, file));
  assert_int_equal(sscanf(strstr(line, ",,,") + 3, "%lf", &told_slip), 1);
  assert_near(told_slip, there[3], 0);
  fclose(file);
  free(path);
  snprintf(line, sizeof line, "rm -r %s", folder);
  assert_int_equal(system(line), 0);
  for (int64_t e = 8; e < b->count; ++e) assert_near(section * b->stress_held[e], force, 0.01 * force);
  double borne = 0;
  for (int64_t e = 0; e < b->count; ++e) borne += bar_bond_stress_in(b, 0, e) * around() * b->length[e];
  assert_near(borne, section * b->stress_held[b->count - 1], 1e-9 * force);
  for (int64_t e = 8; e < b->count; ++e)
    assert_near(bar_bond_stress_in(b, 0, e), 0, 1e-9 * there[4]); /* in its sleeve */
  for (int64_t k = 9; k <= b->count; ++k) assert_near(b->slips->stress_held[k], 0, 0);
  Vector f[1] = {{0}};
  assert_true(vector_create(f, &p->space, "test", NULL));
  domain_forces_beside(&m->domain, NULL, f);
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] < 0.6) held += p->volume[p->place_of[n]] * f->row[0][p->place_of[n]];
  assert_near(held, force, 0.01 * force);
  vector_destroy(f);
  breccia_model_destroy(&m);
}

static void a_short_bar_bears_the_bond_stress_of_its_surface(void **state)
{
  (void)state;
  static const struct {
    const char *condition;
    double peak, friction; /* MPa */
  } cases[] = {{"", 2.5, 0.4},
               {", condition: other", 1.25, 0.4},
               {", splitting stress: 6 MPa, confinement: stirrups", 0, 0.4},
               {", splitting stress: 6 MPa", 0, 0}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    char *keys = text_format("bond: {" FIB "%s}, bonded: [0.15, 0.2], anchored: [end]", cases[c].condition);
    breccia_model *m = led(ROD, keys, PULL, "[0, 0], [1, 2]", 200);
    const double surface = around() * 0.05, peak = cases[c].peak > 0 ? cases[c].peak * sqrt(30) * 1e3 : 6e3;
    double most = 0, last = 0;
    const Bars *b = bars_of(m);
    for (int t = 0; t < 200; ++t) {
      step_surely(m, 1);
      last = section * b->stress_held[b->count - 1];
      most = larger_of(most, last);
      const double s = (b->slips->slip_held[3] + b->slips->slip_held[4]) / 2;
      double at = 2 * s; /* the law by its words */
      if (c == 0) at = s < 1e-3 ? pow(s / 1e-3, 0.4) : s < 2e-3 ? 1 : s < 8e-3 ? 1 - 0.6 * (s - 2e-3) / 6e-3 : 0.4;
      if (c == 0 && s > 5e-5) assert_near(last, at * peak * surface, 5e-3 * peak * surface);
    }
    assert_near(most, peak * surface,
                (c < 2 ? 2e-3 : 0.09) * peak * surface); /* a sharp peak is passed between increments */
    assert_near(last, cases[c].friction * peak * surface, 1e-9 * peak * surface);
    assert_balanced(m, c < 2 ? 0.01 : 0.06);
    breccia_model_destroy(&m);
    free(keys);
  }
}

static BondLaw law_of(const char *keys)
{
  char *words = text_format("bond: {%s}", keys);
  breccia_model *m = led(ROD, words, "0*x", "[0, 0], [1, 1]", 1);
  const BondLaw law = bars_of(m)->slips->law[0];
  breccia_model_destroy(&m);
  free(words);
  return law;
}

static void bond_follows_the_table_of_the_code(void **state)
{
  (void)state;
  const double root = sqrt(30) * 1e3; /* kPa */
  const struct {
    const char *keys;
    double peak, from, to, end, friction;
  } cases[] = {{FIB, 2.5 * root, 1e-3, 2e-3, 8e-3, root},
               {FIB ", condition: other", 1.25 * root, 1.8e-3, 3.6e-3, 8e-3, 0.5 * root},
               {FIB ", splitting stress: 20 MPa", 2.5 * root, 1e-3, 2e-3, 8e-3, root},
               {FIB ", splitting stress: 6 MPa", 6e3, 1e-3 * pow(6e3 / (2.5 * root), 2.5), NAN, 1.2e-3, 0},
               {FIB ", splitting stress: 6 MPa, confinement: stirrups", 6e3, 1e-3 * pow(6e3 / (2.5 * root), 2.5), NAN,
                4e-3, 2.4e3}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    const BondLaw law = law_of(cases[c].keys);
    const double to = isnan(cases[c].to) ? cases[c].from : cases[c].to;
    assert_near(bond_law_envelope(&law, cases[c].from, NULL), cases[c].peak, 1e-9 * root);
    assert_near(bond_law_envelope(&law, 0.3 * cases[c].from, NULL), cases[c].peak * pow(0.3, 0.4), 1e-9 * root);
    assert_near(bond_law_envelope(&law, to, NULL), cases[c].peak, 1e-9 * root);
    assert_near(bond_law_envelope(&law, (to + cases[c].end) / 2, NULL), (cases[c].peak + cases[c].friction) / 2,
                1e-9 * root);
    assert_near(bond_law_envelope(&law, cases[c].end, NULL), cases[c].friction, 1e-9 * root);
    assert_near(bond_law_envelope(&law, 1, NULL), cases[c].friction, 1e-9 * root);
  }
}

/** Leads a piece of bond to a slip in small steps. @return work */
static double lead(const BondLaw *law, BondState *at, double slip)
{
  enum { STEPS = 2000 };
  const double step = (slip - at->slip) / STEPS;
  double work = 0;
  for (int n = 0; n < STEPS; ++n) {
    double slope, up, down, other;
    const double next = at->slip + step, stress = bond_law_stress(law, at, next, false, &slope), h = 1e-9;
    up = bond_law_stress(law, at, next + h, false, &other);
    down = bond_law_stress(law, at, next - h, false, &other);
    if (fabs((up - stress) - (stress - down)) < 1e-6 * h * law->stiffness) /* no corner is between */
      assert_near((up - down) / (2 * h), slope, 1e-5 * law->stiffness);
    work += (stress + at->stress) / 2 * step;
    at->slip = next;
    at->stress = stress;
    at->forward = larger_of(at->forward, next);
    at->backward = fmin(at->backward, next);
  }
  return work;
}

static void slip_that_goes_back_meets_friction(void **state)
{
  (void)state;
  const BondLaw law = law_of(FIB);
  const double root = sqrt(30) * 1e3, mm = 1e-3, stiff = 2e8; /* 200 MPa/mm */
  BondState at = {0};
  double work = lead(&law, &at, 1.5 * mm);
  assert_near(at.stress, 2.5 * root, 1e-9 * root);
  assert_near(work, 2.5 * root * (1 / 1.4 + 0.5) * mm, 0.01 * 2.5 * root * mm); /* the rise is steep, not upright */
  lead(&law, &at, 1.5 * mm - 2.5 * root / stiff);
  assert_near(at.stress, 0, 1e-6 * root);
  lead(&law, &at, 1 * mm);
  assert_near(at.stress, -root, 1e-6 * root);
  lead(&law, &at, 0.5 * mm);
  assert_near(at.stress, -root, 1e-6 * root);
  lead(&law, &at, 1 * mm);
  assert_near(at.stress, root, 1e-6 * root);
  lead(&law, &at, 1.5 * mm);
  assert_near(at.stress, 2.5 * root, 1e-6 * root);
  lead(&law, &at, 5 * mm);
  assert_near(at.stress, 2.5 * root * (1 - 0.6 * 0.5), 1e-6 * root);
  lead(&law, &at, -1 * mm);
  assert_near(at.stress, -2.5 * root, 1e-6 * root); /* the ribs' other sides are whole */
  uint64_t seed = 5;
  double spent = 0;
  for (int turn = 0; turn < 40; ++turn) {
    const double before = at.stress;
    const double done = lead(&law, &at, 10 * mm * (random_uniform(&seed) - 0.5));
    const double lost = done - (at.stress * at.stress - before * before) / (2 * stiff);
    assert_true(lost > -1e-9 * root * mm);
    spent += lost;
  }
  assert_true(spent > 10 * root * mm);
}

/** Slips of opposite sign meet stresses of opposite sign, whatever their path. */
static void slip_of_the_other_sign_meets_the_same_stress(void **state)
{
  (void)state;
  const BondLaw law = law_of(FIB);
  const double root = sqrt(30) * 1e3, mm = 1e-3;
  BondState forth = {0}, back = {0};
  uint64_t seed = 7;
  for (int turn = 0; turn < 20; ++turn) {
    const double slip = (0.2 + 0.1 * turn) * mm * (random_uniform(&seed) - 0.5);
    lead(&law, &forth, slip);
    lead(&law, &back, -slip);
    assert_near(back.stress, -forth.stress, 1e-9 * root);
  }
}

/* ---- forces on the concrete ---- */

static const char *const bonds[] = {"bond: {law: linear, stiffness: 1e6}", "bond: {" FIB "}, anchored: [start]",
                                    "bond: {" FIB ", condition: other}, bonded: [0.2, 0.7]"};
static const char *const laws[] = {ROD, STEEL};

static breccia_model *bent(const char *steel, const char *bond)
{
  return model_of(UNITS
                  "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  %s\n"
                  "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.6, 0.5]}}}}\n"
                  "peridynamics: {formulation: bond-based}\n"
                  "bars: {bent: {points: [[0, 0.13, 0.21], [0.52, 0.31, 0.29], [1, 0.55, 0.17]], diameter: 16 mm, "
                  "number: 2, material: rod, %s}}\n"
                  "solve: {explicit: {end time: 1}}\npictures: []\n",
                  steel, bond);
}

static void bars_that_slip_neither_push_nor_turn_the_whole(void **state)
{
  (void)state;
  for (size_t c = 0; c < 6; ++c) {
    breccia_model *m = bent(laws[c / 3], bonds[c % 3]);
    const Particles *p = m->domain.particles;
    shake(m, 0.01);
    Vector f[1] = {{0}};
    double sum[3] = {0}, turn[3] = {0}, size = 0;
    find_beside(m, f);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, z = (k + 2) % 3;
        sum[k] += p->volume[i] * f->row[k][i];
        size += fabs(p->volume[i] * f->row[k][i]);
        turn[k] += p->volume[i] * ((p->position[a][i] + p->displacement.row[a][i]) * f->row[z][i] -
                                   (p->position[z][i] + p->displacement.row[z][i]) * f->row[a][i]);
      }
    }
    assert_true(size > 1);
    for (int k = 0; k < 3; ++k) {
      assert_near(sum[k], 0, 1e-13 * size);
      assert_near(turn[k], 0, 1e-13 * size);
    }
    drop(f);
    breccia_model_destroy(&m);
  }
}

static void a_body_that_is_turned_has_the_same_slips(void **state)
{
  (void)state;
  for (size_t c = 0; c < 6; ++c) {
    breccia_model *straight = bent(laws[c / 3], bonds[c % 3]), *turned = bent(laws[c / 3], bonds[c % 3]);
    const double q[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6};
    Vector f[1] = {{0}}, g[1] = {{0}};
    shake(straight, 0.004);
    Particles *p = straight->domain.particles, *r = turned->domain.particles;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        r->displacement.row[k][i] = -r->position[k][i];
        for (int j = 0; j < 3; ++j)
          r->displacement.row[k][i] += q[3 * k + j] * (p->position[j][i] + p->displacement.row[j][i]);
      }
    }
    find_beside(straight, f);
    find_beside(turned, g);
    const Bars *a = bars_of(straight), *b = bars_of(turned);
    double most = 0, size = 0;
    for (int64_t k = 0; k <= a->count; ++k) most = larger_of(most, fabs(a->slips->slip[k]));
    assert_true(most > 1e-5);
    for (int64_t k = 0; k <= a->count; ++k) assert_near(b->slips->slip[k], a->slips->slip[k], 1e-9 * most);
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) size = larger_of(size, fabs(f->row[k][i]));
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i)
        assert_near(g->row[k][i], q[3 * k] * f->row[0][i] + q[3 * k + 1] * f->row[1][i] + q[3 * k + 2] * f->row[2][i],
                    1e-8 * size);
    drop(f);
    drop(g);
    breccia_model_destroy(&straight);
    breccia_model_destroy(&turned);
  }
}

static void changes_are_those_of_forces(void **state)
{
  (void)state;
  for (size_t c = 0; c < 6; ++c) {
    breccia_model *m = bent(laws[c / 3], bonds[c % 3]);
    const Particles *p = m->domain.particles;
    Bars *b = bars_of(m);
    deform_uniformly(m, (const double[]){0.8, -0.6, 0, 0.6, 0.81, 0, 0, 0, 1});
    shake(m, 2e-3);
    Vector v[1] = {{0}}, changed[1] = {{0}}, up[1] = {{0}}, down[1] = {{0}};
    double size = 0;
    find_beside(m, up);
    bars_linearise(b);
    drop(up);
    uint64_t seed = 3;
    assert_true(vector_create(v, &p->space, "test", NULL));
    assert_true(vector_create(changed, &p->space, "test", NULL));
    for (int k = 0; k < 3; ++k) {
      for (int64_t n = 0; n < p->count; ++n) v->row[k][p->place_of[n]] = random_uniform(&seed) - 0.5;
    }
    domain_change_forces(&m->domain, v, changed);
    const double h = 1e-8;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < 3; ++k)
        for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] += (side ? -2 : 1) * h * v->row[k][i];
      find_beside(m, side ? down : up);
    }
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) size = larger_of(size, fabs(changed->row[k][i]));
    assert_true(size > 0);
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i)
        assert_near((up->row[k][i] - down->row[k][i]) / (2 * h), changed->row[k][i], 1e-5 * size);
    drop(v);
    drop(changed);
    drop(up);
    drop(down);
    breccia_model_destroy(&m);
  }
}

/** Very stiff bond is perfect bond. */
static void stiff_bond_comes_to_perfect_bond(void **state)
{
  (void)state;
  breccia_model *stiff = bent(STEEL, "bond: {law: linear, stiffness: 1e13}"), *perfect = bent(STEEL, "snap: no");
  Vector f[1] = {{0}}, g[1] = {{0}};
  double size = 0;
  shake(stiff, 0.004);
  shake(perfect, 0.004);
  find_beside(stiff, f);
  find_beside(perfect, g);
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < stiff->domain.particles->places; ++i) size = larger_of(size, fabs(g->row[k][i]));
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < stiff->domain.particles->places; ++i) assert_near(f->row[k][i], g->row[k][i], 1e-4 * size);
  drop(f);
  drop(g);
  breccia_model_destroy(&stiff);
  breccia_model_destroy(&perfect);
}

/* ---- in runs ---- */

/** A block with a bar along it whose ends fly apart: the bar slips, and the block swings on. */
static breccia_model *struck(const char *solver, int threads)
{
  return model_on(
      threads,
      UNITS "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e4}\n  " STEEL "\n"
            "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.4, 0.4]}}}}\n"
            "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
            "bars: {long: {points: [[0.02, 0.14, 0.11], [0.98, 0.23, 0.17]], area: 1e-5, material: rod,\n"
            "              bond: {compressive strength: 20 kPa, rib spacing: 5 mm, unloading stiffness: 2 MPa/mm}},\n"
            "       stirrup: {points: [[0.5, 0.1, 0.1], [0.5, 0.3, 0.1], [0.5, 0.3, 0.3], [0.5, 0.1, 0.3], "
            "[0.5, 0.1, 0.1]], diameter: 2 mm, material: rod}}\n"
            "loads: [{on: {inside: {box: {from: [0, 0, 0], to: [0.5, 1, 1]}}}, initial velocity: {translation: "
            "[-0.4, 0, 0.1]}},\n"
            "        {on: {inside: {box: {from: [0.5, 0, 0], to: [1, 1, 1]}}}, initial velocity: {translation: "
            "[0.4, 0.1, 0]}}]\n"
            "solve: {%s}\npictures: []\n",
      solver);
}

static void works_are_in_the_books_where_bars_slip(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.05}", "implicit: {end time: 0.05, time step: 5e-4}"};
  for (int s = 0; s < 2; ++s) {
    breccia_model *m = struck(solvers[s], 1);
    step_surely(m, INT64_MAX);
    const Energy e = solver_energy(&m->solver);
    const BarReport r = bar_report(bars_of(m), 0);
    print_message("kinetic %g stored %g dissipated %g imbalance %g; slips %g to %g\n", e.kinetic, e.stored,
                  e.dissipated, e.imbalance, r.least_slip, r.largest_slip);
    assert_true(e.dissipated > 0.01 * m->solver.ledger.kinetic_at_start);
    assert_balanced(m, s ? 2e-3 : 5e-4);
    breccia_model_destroy(&m);
  }
}

static breccia_model *struck_for_long(int threads)
{
  return struck("explicit: {end time: 1}", threads);
}

static void threads_and_restarts_give_the_same_bits(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(struck_for_long, 300, 500);
}

/** A block on a bar that is pulled out of it: what must be found by solvers, by every one of them the same. */
static void every_way_to_solve_finds_the_same(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 4}",
                                        "static: {increments: 4, equations: conjugate gradients}",
                                        "static: {increments: 4, method: relaxation, residual: 1e-9}"};
  double first = 0;
  for (size_t s = 0; s < sizeof solvers / sizeof *solvers; ++s) {
    breccia_model *m = model_of(
        UNITS "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e6}\n  " ROD "\n"
              "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}\n"
              "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
              "bars: {bar: {points: [[0.02, 0.14, 0.11], [1.18, 0.14, 0.11]], area: 1e-4, material: rod, bond: {" FIB
              "}}}\n"
              "loads:\n  - {on: {face: x-, layers: 2}, displacement: [0, 0, 0]}\n"
              "  - {on: {face: x+, layers: 2}, displacement: [0.004, 0, 0]}\nsolve: {%s}\npictures: []\n",
        solvers[s]);
    step_surely(m, INT64_MAX);
    const BarReport r = bar_report(bars_of(m), 0);
    print_message("%s: %.9g, slips %.9g to %.9g\n", solvers[s], r.largest_stress, r.least_slip, r.largest_slip);
    if (!s) first = r.largest_stress;
    assert_true(r.largest_slip > 1e-4);
    assert_near(r.largest_stress, first, 1e-5 * first);
    breccia_model_destroy(&m);
  }
}

static void bond_that_makes_no_sense_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *keys, *words;
  } cases[] = {
      {"bond: {law: linear}", "stiffness: law 'linear' needs it"},
      {"bond: {rib spacing: 8 mm}", "compressive strength: law 'fib' needs it"},
      {"bond: {compressive strength: 30 MPa}", "rib spacing: law 'fib' needs it"},
      {"bond: {" FIB ", stiffness: 1e6}", "stiffness: is for law 'linear'"},
      {"bond: {law: linear, stiffness: 1e6, rib spacing: 8 mm}", "rib spacing: is for law 'fib'"},
      {"bond: {" FIB "}, anchored: [middle]", "'middle' is no end of a bar|'start'|'end'"},
      {"anchored: [end]", "a bar in perfect bond slips nowhere; add 'bond'"},
      {"bonded: [0, 1]", "add 'bond'"},
      {"bond: {" FIB "}, bonded: [0.4, 0.2]", "two lengths along the bar"},
      {"bond: {" FIB "}, bonded: [4, 5]", "it is not anchored: nothing would hold it"},
      {"bond: {" FIB "}, bonded: [0, 0], anchored: [start]", "it is anchored at one end only: nothing would hold it"},
      {"bond: {" FIB "}, bonded: [0.4, 0.91]", "bonded: bar 'r' is 0.9 m long, from 0 to there"},
      {"bond: {" FIB "}, bonded: [-0.01, 0.9]", "bonded: bar 'r' is 0.9 m long, from 0 to there"},
      {"bond: {" FIB ", confinement: stirrups}", "confinement: counts where concrete splits; give 'splitting"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format(
        UNITS "materials:\n  soft: {model: elastic-1d, density: 2, Young modulus: 1e6}\n  " ROD "\n"
              "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.3, 0.3]}}}}\n"
              "peridynamics: {formulation: bond-based}\n"
              "bars: {r: {points: [[0, 0.1, 0.1], [0.9, 0.1, 0.1]], diameter: 8 mm, material: rod, %s}}\n"
              "solve: {explicit: {end time: 1}}\npictures: []\n",
        cases[k].keys);
    char *words = refusal_of(deck);
    holds_words(words, cases[k].words);
    free(words);
    free(deck);
  }
}

/** What is told of a bar of 0.2 m in 0.1 m of bond before the run, and after it. */
static void words_tell_bond_and_slip(void **state)
{
  (void)state;
  static const struct {
    const char *keys, *words;
  } cases[] = {{"bond: {" FIB "}, bonded: [0.4, 0.5], anchored: [end]",
                "bars: 1 'bar' of 0.0001 m2; |'bar' slips: bond of 13.7 MPa between slips of 1 mm and 2 mm, 5.48 MPa "
                "beyond 8 mm, along 100 mm of "
                "1.2 m, 48.5 "
                "kN in all; anchored at its end\n"},
               {"bond: {" FIB ", splitting stress: 6 MPa}",
                "'bar' slips: bond of 6 MPa at a slip of 127 µm, none beyond 1.2 mm, along all of it, 255 kN in all; "
                "anchored at "
                "neither end\n"},
               {"number: 2, bond: {law: linear, stiffness: 1.4e7}, anchored: [start, end]",
                "bars: 2 'bar' of 0.0002 m2 together; |'bar' slips: bond of 14 MPa per mm of slip, along all of it; "
                "anchored at both ends\n"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *m = led(ROD, cases[c].keys, PULL, "[0, 0], [1, 1]", 1);
    holds_words(breccia_model_overview(m), cases[c].words);
    Text words = {0};
    step_surely(m, INT64_MAX);
    run_tell_bars(m, &words);
    holds_words(text_words(&words), c ? "stored|slip" : "stored|dissipated|slip 0 m to 9.4");
    text_free(&words);
    breccia_model_destroy(&m);
  }
}

/** The summary prints the largest compression of concrete and the smallest compressive strength of its bar bonds. */
static void the_least_strength_of_all_bonds_is_told(void **state)
{
  (void)state;
  static const char *const kinds[] = {"{law: fib, compressive strength: 25 MPa, rib spacing: 8 mm}",
                                      "{law: fib, compressive strength: 40 MPa, rib spacing: 8 mm}",
                                      "{law: linear, stiffness: 1e7}"};
  for (int first = 0; first < 3; ++first) {
    breccia_model *m = model_of(
        UNITS "materials:\n  c: {model: exponential-softening, density: 2, Young modulus: 3e7, tensile strength: 3e3, "
              "fracture energy: 0.1}\n  " ROD "\n"
              "body: {b: {material: c, lattice: square, spacing: 0.05, thickness: 0.1, shape: {box: {particles: [12, "
              "8]}}}}\n"
              "peridynamics: {formulation: bond-based, space: plane stress}\n"
              "bars:\n  a: {points: [[0.1, 0.1], [0.5, 0.1]], area: 1e-4, material: rod, bond: %s}\n"
              "  b: {points: [[0.1, 0.2], [0.5, 0.2]], area: 1e-4, material: rod, bond: %s}\n"
              "  c: {points: [[0.1, 0.3], [0.5, 0.3]], area: 1e-4, material: rod, bond: %s}\n"
              "solve: {explicit: {steps: 1}}\npictures: []\n",
        kinds[first], kinds[(first + 1) % 3], kinds[(first + 2) % 3]);
    for (int k = 0; k < 2; ++k) {
      Text words = {0};
      m->compressions.stress[0] = k ? -30e3 : -20e3;
      run_tell_compressions(m, &words);
      const char *strength = strstr(text_words(&words), "; bond of bars is given a compressive strength of 25 MPa");
      if (!strength || !strstr(strength, "CRUSHED") != !k) fail_msg("order %d: %s", first, text_words(&words));
      text_free(&words);
    }
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_least_strength_of_all_bonds_is_told),
      cmocka_unit_test(bond_follows_the_table_of_the_code),
      cmocka_unit_test(slip_that_goes_back_meets_friction),
      cmocka_unit_test(slip_of_the_other_sign_meets_the_same_stress),
      cmocka_unit_test(slip_along_a_free_bar_is_that_of_the_closed_form),
      cmocka_unit_test(a_bar_is_pulled_out_as_by_the_closed_form),
      cmocka_unit_test(a_short_bar_bears_the_bond_stress_of_its_surface),
      cmocka_unit_test(bars_that_slip_neither_push_nor_turn_the_whole),
      cmocka_unit_test(a_body_that_is_turned_has_the_same_slips),
      cmocka_unit_test(changes_are_those_of_forces),
      cmocka_unit_test(stiff_bond_comes_to_perfect_bond),
      cmocka_unit_test(works_are_in_the_books_where_bars_slip),
      cmocka_unit_test(threads_and_restarts_give_the_same_bits),
      cmocka_unit_test(every_way_to_solve_finds_the_same),
      cmocka_unit_test(bond_that_makes_no_sense_is_refused),
      cmocka_unit_test(words_tell_bond_and_slip),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

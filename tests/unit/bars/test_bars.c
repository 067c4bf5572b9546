/* Reinforcing bars against closed forms and difference quotients, in every formulation. */
#include "forces_beside.h"

#include "bars/bars.h"
#include "model/run.h"
#include "results/bar_lines.h"
#include "results/watch_parts.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define MATERIALS                                                                                                      \
  UNITS "materials:\n  soft: {model: %s, density: 2, Young modulus: 1e4}\n"                                            \
        "  %s\n"
#define ROD_OF "rod: {model: elastic, density: 7, Young modulus: 2e8, Poisson ratio: 0.3}"
#define STEEL_OF                                                                                                       \
  "steel: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5, hardening ratio: 0.01}"
#define REST "solve: {explicit: {end time: 1}}\npictures: []\n"

static Bars *bars_of(breccia_model *m)
{
  for (int k = 0; k < m->domain.forces.count; ++k)
    if (!strcmp(m->domain.forces.type[k]->name, "bars")) return m->domain.forces.own[k];
  fail_msg("no bars");
  return NULL;
}

static const char *const lattices[] = {"square", "hexagonal", "cubic", "face-centred cubic"};

/** A body of a lattice with a bent bar through it that stands nowhere on particles and ends at a face. */
static breccia_model *bent_bar(const char *lattice, const char *keys)
{
  const bool plane = lattice[0] == 's' || lattice[0] == 'h';
  return model_of(
      MATERIALS
      "body: {b: {material: soft, spacing: 0.1, lattice: %s%s, shape: {box: {from: [0, 0%s], to: [1, 0.6%s]}}}}\n"
      "peridynamics: {formulation: bond-based%s}\n"
      "bars: {bent: {points: [[0, 0.13%s], [0.52, 0.31%s], [1, 0.55%s]], diameter: 16 mm, number: 2, %s}}\n" REST,
      "elastic-1d", strstr(keys, "rod") ? ROD_OF : STEEL_OF, lattice, plane ? ", thickness: 0.3" : "",
      plane ? "" : ", 0", plane ? "" : ", 0.5", plane ? ", space: plane stress" : "", plane ? "" : ", 0.21",
      plane ? "" : ", 0.29", plane ? "" : ", 0.17", keys);
}

static void an_element_feels_uniform_deformation_exactly(void **state)
{
  (void)state;
  for (size_t l = 0; l < sizeof lattices / sizeof *lattices; ++l) {
    breccia_model *m = bent_bar(lattices[l], "material: rod");
    const Bars *b = bars_of(m);
    const bool plane = m->domain.body.dimensions == 2;
    const double f[9] = {1.02,
                         0.3,
                         plane ? 0 : 0.1,
                         -0.2,
                         0.97,
                         plane ? 0 : 0.05,
                         plane ? 0 : -0.1,
                         plane ? 0 : 0.2,
                         1.01 - 0.01 * plane};
    deform_uniformly(m, f);
    compute_forces(m);
    double length = 0;
    for (int64_t e = 0; e < b->count; ++e) {
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        double sum = 0;
        for (int j = 0; j < 3; ++j) sum += f[3 * k + j] * b->rest[e][j];
        square += sum * sum;
      }
      assert_near(b->strain[e], sqrt(square) / b->length[e] - 1, 1e-13);
      assert_near(b->area[e], 2 * acos(-1) / 4 * 0.016 * 0.016, 1e-15);
      length += b->length[e];
    }
    const double d[2] = {plane ? 0 : 0.08, plane ? 0 : -0.12};
    assert_near(length, sqrt(0.52 * 0.52 + 0.18 * 0.18 + d[0] * d[0]) + sqrt(0.48 * 0.48 + 0.24 * 0.24 + d[1] * d[1]),
                1e-12);
    breccia_model_destroy(&m);
  }
}

static void bars_neither_push_nor_turn_the_whole(void **state)
{
  (void)state;
  for (size_t l = 0; l < sizeof lattices / sizeof *lattices; ++l) {
    breccia_model *m = bent_bar(lattices[l], "material: rod");
    const Particles *p = m->domain.particles;
    shake(m, 0.01);
    Vector f[1] = {{0}};
    double sum[3] = {0}, turn[3] = {0}, size = 0;
    find_beside(m, f);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, c = (k + 2) % 3;
        sum[k] += p->volume[i] * f->row[k][i];
        size += fabs(p->volume[i] * f->row[k][i]);
        turn[k] += p->volume[i] * ((p->position[a][i] + p->displacement.row[a][i]) * f->row[c][i] -
                                   (p->position[c][i] + p->displacement.row[c][i]) * f->row[a][i]);
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

static void bars_carry_nothing_where_the_body_only_turns(void **state)
{
  (void)state;
  for (int quarters = 1; quarters <= 4; ++quarters) {
    breccia_model *m = bent_bar("cubic", "material: steel");
    const double angle = quarters * acos(-1) / 2, c = cos(angle), s = sin(angle);
    deform_uniformly(m, (const double[]){c, -s, 0, s, c, 0, 0, 0, 1});
    Vector f[1] = {{0}};
    find_beside(m, f);
    const Bars *b = bars_of(m);
    for (int64_t e = 0; e < b->count; ++e) assert_near(b->strain[e], 0, 1e-13);
    drop(f);
    breccia_model_destroy(&m);
  }
}

/** The forces of bars against the slope of their energy, and changes and assembled points against difference quotients of forces, where elements
 *  are strained, turned, and yield. */
static void changes_are_those_of_forces_and_of_energy(void **state)
{
  (void)state;
  static const char *const laws[] = {"material: rod", "material: steel", "material: steel, snap: yes"};
  for (size_t l = 0; l < 3 * sizeof lattices / sizeof *lattices; ++l) {
    breccia_model *m = bent_bar(lattices[l % 4], laws[l / 4]);
    const Particles *p = m->domain.particles;
    Bars *b = bars_of(m);
    const bool plane = m->domain.body.dimensions == 2;
    deform_uniformly(m, (const double[]){0.8, -0.6, 0, 0.6, 0.81, 0, 0, 0, 1});
    shake(m, 2e-3);
    Vector v[1] = {{0}}, changed[1] = {{0}}, up[1] = {{0}}, down[1] = {{0}}, assembled[1] = {{0}};
    find_beside(m, up);
    bars_linearise(b);
    drop(up);
    uint64_t seed = 3;
    assert_true(vector_create(v, &p->space, "test", NULL));
    assert_true(vector_create(changed, &p->space, "test", NULL));
    assert_true(vector_create(assembled, &p->space, "test", NULL));
    for (int k = 0; k < 3; ++k) {
      for (int64_t n = 0; n < p->count && (k < 2 || !plane); ++n)
        v->row[k][p->place_of[n]] = random_uniform(&seed) - 0.5;
    }
    domain_change_forces(&m->domain, v, changed);
    Operator point = {0};
    double k9[9];
    for (int64_t e = 0; e < bars_point_count(b); ++e) {
      assert_int_equal(bars_point(b, e, &point, NULL), 0);
      for (int i = 0; i < point.count; ++i)
        for (int j = 0; j < point.count; ++j) {
          operator_stiffness(&point, p->displacement.row, i, j, k9);
          for (int k = 0; k < 9; ++k)
            assembled->row[k / 3][point.places[i].place] +=
                k9[k] * v->row[k % 3][point.places[j].place] / p->volume[point.places[i].place];
        }
    }
    operator_destroy(&point);
    const double h = 1e-8;
    double energy[2] = {0}, work = 0;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < 3; ++k)
        for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] += (side ? -2 : 1) * h * v->row[k][i];
      find_beside(m, side ? down : up);
      for (int64_t e = 0; e < b->count; ++e)
        energy[side] += b->area[e] * b->length[e] * 2e8 * b->strain[e] * b->strain[e] / 2;
    }
    double size = 0;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) size = larger_of(size, fabs(changed->row[k][i]));
    assert_true(size > 0);
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) {
        assert_near((up->row[k][i] - down->row[k][i]) / (2 * h), changed->row[k][i], 1e-6 * size);
        assert_near(assembled->row[k][i], changed->row[k][i], 1e-11 * size);
        work -= p->volume[i] * (up->row[k][i] + down->row[k][i]) / 2 * v->row[k][i];
      }
    if (l < 4) assert_near((energy[0] - energy[1]) / (2 * h), work, 1e-6 * fabs(work));
    drop(v);
    drop(changed);
    drop(up);
    drop(down);
    drop(assembled);
    breccia_model_destroy(&m);
  }
}

/* ---- in a block that is pulled ---- */

static const char *const formulations[] = {"formulation: bond-based", "formulation: ordinary",
                                           "formulation: correspondence", "formulation: hybrid",
                                           "formulation: micropolar"};

/** Pulls a prism of 1.2 x 0.3 x 0.3 with prescribed layers at its ends; with `bars` or without.
 *  @return force in the middle: what the right half is held by */
static double pulled(const char *formulation, const char *bars, const char *solver, double strain)
{
  /* Bonds of ordinary families of a thin prism have factors that vary up to seven horizons from its ends. Where the
   * prism is free in between its strain is even only beyond that distance. */
  const int more = strstr(formulation, "ordinary") ? 12 : 0;
  breccia_model *m = model_of(
      MATERIALS "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [%g, 0, 0], to: [%g, 0.3, 0.3]}}}}\n"
                "peridynamics: {%s, horizon: 2.015 spacings}\n%s"
                "loads:\n  - {on: {all: yes}, along: {direction: [0, 1, 0], displacement: 0}}\n"
                "  - {on: {all: yes}, along: {direction: [0, 0, 1], displacement: 0}}\n"
                "  - {on: {face: x-, layers: %d}, field: {displacement: ['%.17g*x', free, free]}}\n"
                "  - {on: {face: x+, layers: %d}, field: {displacement: ['%.17g*x', free, free]}}\n"
                "solve: {%s}\npictures: []\nresults: {}\n",
      strstr(formulation, "bond-based") ? "elastic-1d" : "elastic, Poisson ratio: 0.2",
      strstr(bars, "steel") ? STEEL_OF
      : *bars               ? ROD_OF
                            : "",
      -0.1 * more, 1.2 + 0.1 * more, formulation, bars, 4 + more, strain, 4 + more, strain, solver);
  step_surely(m, INT64_MAX);
  const Particles *p = m->domain.particles;
  double force = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[0][i] > 0.6) force -= p->volume[i] * p->internal.row[0][i];
  }
  breccia_model_destroy(&m);
  return force;
}

#define ROD "bars: {rod: {points: [[0.02, 0.14, 0.11], [1.18, 0.14, 0.11]], area: 1e-4, material: rod}}\n"

static void a_bar_adds_its_stiffness_times_the_strain(void **state)
{
  (void)state;
  const double strain = 1e-5;
  for (size_t f = 0; f < sizeof formulations / sizeof *formulations; ++f) {
    const char *solver = "static: {increments: 1}";
    const double with = pulled(formulations[f], ROD, solver, strain),
                 without = pulled(formulations[f], "", solver, strain);
    print_message("%s: %.8g of %.8g\n", formulations[f], with - without, 2e8 * 1e-4 * strain);
    assert_near(with - without, 2e8 * 1e-4 * strain, 1e-6 * 2e8 * 1e-4 * strain);
  }
}

static void every_way_to_solve_finds_the_same(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 2, equations: direct}",
                                        "static: {increments: 1, equations: conjugate gradients}",
                                        "static: {increments: 1, method: relaxation, residual: 1e-9}"};
  for (size_t s = 0; s < sizeof solvers / sizeof *solvers; ++s) {
    const double strain = 1e-5, with = pulled(formulations[2], ROD, solvers[s], strain),
                 without = pulled(formulations[2], "", solvers[s], strain);
    assert_near(with - without, 2e8 * 1e-4 * strain, 1e-6 * 2e8 * 1e-4 * strain);
  }
}

#define TIE "bars: {tie: {points: [[0.02, 0.14, 0.11], [1.18, 0.14, 0.11]], area: 1e-4, material: steel}}\n"

static void steel_carries_what_its_law_says(void **state)
{
  (void)state;
  const double strain = 0.01;
  for (size_t f = 0; f < sizeof formulations / sizeof *formulations; ++f) {
    const char *solver = "static: {increments: 4}";
    const double with = pulled(formulations[f], TIE, solver, strain),
                 without = pulled(formulations[f], "", solver, strain);
    assert_near(with - without, 1e-4 * (5e5 + 0.01 * 2e8 * (strain - 2.5e-3)), 1e-6 * 70);
  }
}

/** A prism with a bar along it, all of it stretched alike by 0.01 times a factor. */
static breccia_model *stretched(const char *steel, const char *history)
{
  return model_of(MATERIALS
                  "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n" TIE
                  "loads:\n  - {on: {all: yes}, field: {displacement: ['0.01*x', 0 m, 0 m]}, history: {%s}}\n"
                  "watch: {tie: {bar: tie}, end: {bar: tie, at: [1.2, 0, 0]}}\n"
                  "solve: {static: {increments: 20, end time: 1}}\npictures: []\n",
                  "elastic-1d", steel, history);
}

static void steel_pushed_back_keeps_the_energy_of_its_stress(void **state)
{
  (void)state;
  const struct {
    const char *history;
    double stress, strain;
  } cases[] = {
      {"table: [[0, 0], [1, 1]]", 5e5 + 0.01 * 2e8 * 7.5e-3, 0.01},
      {"table: [[0, 0], [0.5, 1], [1, 0.6]]", 5e5 + 0.01 * 2e8 * 7.5e-3 - 2e8 * 0.004, 0.006},
      {"table: [[0, 0], [0.5, 1], [1, 0]]", -0.99 * 5e5, 0},                             /* on the lower line */
      {"table: [[0, 0], [0.5, 1], [1, -0.1]]", -0.99 * 5e5 - 0.01 * 2e8 * 1e-3, -1e-3}}; /* against what stays */
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = stretched(STEEL_OF, cases[k].history);
    step_surely(m, INT64_MAX);
    const Bars *b = bars_of(m);
    const BarReport r = bar_report(b, 0);
    const double volume = 1.16 * 1e-4, stored = volume * cases[k].stress * cases[k].stress / (2 * 2e8);
    assert_near(r.least_strain, cases[k].strain, 1e-9);
    assert_near(r.largest_stress, cases[k].stress, 1e-4 * 5e5);
    assert_near(r.stored, stored, 1e-4 * stored);
    assert_near(bars_energy(bars_of(m)), stored, 1e-4 * stored);
    assert_true(r.dissipated > 0.5 * volume * 5e5 * 6e-3);
    assert_near(r.dissipated, bars_dissipated(b), 1e-12);
    assert_near(r.yielded, 1, 1e-12);
    assert_near(r.torn, 0, 0);
    assert_near(r.highest_stress, 5e5 + 0.01 * 2e8 * 7.5e-3, 1e-4 * 5e5);
    const Watch *whole = &m->watches->items[0], *end = &m->watches->items[1];
    double told[8], there[3];
    const double expected[] = {r.least_strain, r.largest_strain, r.least_stress, r.largest_stress,
                               r.stored,       r.dissipated,     r.yielded,      r.torn};
    assert_int_equal(watch_columns(whole->kind), 8);
    assert_int_equal(watch_columns(end->kind), 3);
    whole->kind->row(whole, &m->solver, told);
    end->kind->row(end, &m->solver, there);
    for (int c = 0; c < 8; ++c) assert_near(told[c], expected[c], 0);
    assert_int_equal(end->element, b->count - 1);
    assert_near(there[0], cases[k].strain, 1e-9);
    assert_near(there[2], 1e-4 * cases[k].stress, 1e-3);
    breccia_model_destroy(&m);
  }
}

/** The same of bonds: stretched by 0.01 and pushed back to 0.0065, bonds along the axis have yielded and carry against their stretch. */
static void bonds_of_steel_pushed_back_store_energy(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS "materials:\n  " STEEL_OF "\n"
            "body: {b: {material: steel, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}\n"
            "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
            "loads:\n  - {on: {all: yes}, field: {displacement: ['0.01*x', 0 m, 0 m]}, history: {table: [[0, 0], [0.5, "
            "1], [1, 0.65]]}}\n"
            "solve: {static: {increments: 20, end time: 1}}\npictures: []\n");
  step_surely(m, INT64_MAX);
  const Energy e = solver_energy(&m->solver);
  assert_true(e.stored > 0.03 * e.external);
  assert_near(e.stored + e.dissipated, e.external, 1e-6 * e.external);
  breccia_model_destroy(&m);
}

static void bars_tell_when_they_yield_and_tear(void **state)
{
  (void)state;
  /* Strains are 0.01 times the time: it yields at 0.0025 (beyond by 2 %), and tears beyond 0.0071. */
  breccia_model *m = stretched("steel: {model: steel-bilinear, density: 7, Young modulus: 2e8, yield stress: 5e5, "
                               "hardening ratio: 0.01, largest strain: 0.0071}",
                               "table: [[0, 0], [1, 1]]");
  step_surely(m, INT64_MAX);
  const Bars *b = bars_of(m);
  const BarReport r = bar_report(b, 0);
  assert_near(r.torn, 1, 1e-12);
  assert_near(r.largest_stress, 0, 0);
  assert_near(b->yielded[r.first_yielded], 0.3, 1e-9); /* increments of 0.05 */
  assert_near(b->torn[r.first_torn], 0.75, 1e-9);
  assert_near(r.highest_stress, 5e5 + 0.01 * 2e8 * 4.5e-3, 1e-3 * 5e5);
  assert_near(r.stored, 0, 1e-12);
  assert_string_equal(breccia_model_event(m), "bars torn");
  Text summary = {0}, words = {0};
  run_add_bars(m, &summary);
  run_tell_bars(m, &words);
  holds_words(text_words(&summary),
              "\"name\": \"tie\", \"elements\": 12|\"torn_share\": 1|\"first_yielded\": {\"time\": 0.3,|"
              "\"first_torn\": {\"time\": 0.75,");
  holds_words(text_words(&words), "bar 'tie'|yields since time 0.3 s|TORN since time 0.75 s|now over 100 %");
  text_free(&summary);
  text_free(&words);
  for (int64_t k = 0; k < b->count + 1; ++k) { /* nodes move as the body does */
    double u[3];
    bar_node_displacement(b, k, u);
    assert_near(u[0], 0.01 * b->node[k][0], 1e-12);
    assert_near(u[1], 0, 1e-12);
  }
  char folder[] = "/tmp/breccia-bars-XXXXXX", line[512] = "", last[512] = "";
  assert_non_null(mkdtemp(folder));
  Text files = {0};
  assert_int_equal(bar_lines_write(&m->domain, folder, m->units, &files, NULL), 0);
  holds_words(text_words(&files), "bars/bars.csv|bars/bars.vtp");
  text_free(&files);
  char *path = text_format("%s/bars/bars.csv", folder);
  FILE *file = fopen(path, "r");
  int rows = -1;
  for (; file && fgets(line, sizeof line, file); ++rows) {
    if (rows < 0) holds_words(line, "bar,along (m),x (m)|strain,stress (kPa),force (kN)|torn since (s)");
    memcpy(last, line, sizeof last);
  }
  fclose(file);
  assert_int_equal(rows, 12);
  holds_words(last, "\"tie\",1.111666667,1.131666667,0.14,0.11,0.0|,0.3,0.75");
  snprintf(line, sizeof line, "rm -r %s", folder);
  assert_int_equal(system(line), 0);
  free(path);
  const double point[3] = {0.61, 0, 0};
  double middle[3];
  bar_middle(b, bar_nearest(b, 0, point), middle);
  assert_true(fabs(middle[0] - 0.61) < 0.06);
  breccia_model_destroy(&m);
}

/** A block with a bar along it and one across, whose ends fly apart: the steel yields, and the block swings on. */
static breccia_model *struck(const char *solver, int threads)
{
  return model_on(threads,
                  MATERIALS
                  "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.4, 0.4]}}}}\n"
                  "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                  "bars: {long: {points: [[0.02, 0.14, 0.11], [0.98, 0.23, 0.17]], area: 4e-6, material: steel},\n"
                  "       stirrup: {points: [[0.5, 0.1, 0.1], [0.5, 0.3, 0.1], [0.5, 0.3, 0.3], [0.5, 0.1, 0.3], "
                  "[0.5, 0.1, 0.1]], diameter: 2 mm, material: steel}}\n"
                  "loads: [{on: {inside: {box: {from: [0, 0, 0], to: [0.5, 1, 1]}}}, initial velocity: {translation: "
                  "[-0.4, 0, 0.1]}},\n"
                  "        {on: {inside: {box: {from: [0.5, 0, 0], to: [1, 1, 1]}}}, initial velocity: {translation: "
                  "[0.4, 0.1, 0]}}]\n"
                  "solve: {%s}\npictures: []\n",
                  "elastic-1d", STEEL_OF, solver);
}

static void works_are_in_the_books_where_steel_yields(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.05}", "implicit: {end time: 0.05, time step: 5e-4}"};
  for (int s = 0; s < 2; ++s) {
    breccia_model *m = struck(solvers[s], 1);
    step_surely(m, INT64_MAX);
    const Energy e = solver_energy(&m->solver);
    print_message("kinetic %g stored %g dissipated %g imbalance %g\n", e.kinetic, e.stored, e.dissipated, e.imbalance);
    assert_true(e.dissipated > 0.05 * m->solver.ledger.kinetic_at_start);
    assert_near(e.friction, 0, 0);
    assert_balanced(m, s ? 1e-3 : 2e-4);
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
  assert_same_bits_by_threads_and_restart(struck_for_long, 150, 300);
}

static void a_cracked_tie_carries_what_its_steel_yields_at(void **state)
{
  (void)state;
  /* The soft block would carry 1e4 * 1e-3 * 0.09 = 0.9 kN and the steel 5 kN: the block breaks apart, and then the steel yields. */
  breccia_model *m = model_of(
      MATERIALS "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.3, 0.3]}}}}\n"
                "peridynamics: {formulation: bond-based, horizon: 2.015 spacings}\n"
                "failure: {critical stretch: 1e-3}\n"
                "bars: {tie: {points: [[0.02, 0.14, 0.11], [1.18, 0.14, 0.11]], area: 1e-5, material: steel}}\n"
                "loads:\n  - {on: {face: x-, layers: 4}, displacement: [0, 0, 0]}\n"
                "  - {on: {face: x+, layers: 4}, displacement: [0.03, 0, 0], history: {ramp to: 1.5}}\n"
                "solve: {explicit: {end time: 1.5, damping: 30}}\npictures: []\n",
      "elastic-1d", "steel: {model: elastic-perfectly-plastic, density: 7, Young modulus: 2e8, yield stress: 5e5}");
  step_surely(m, INT64_MAX);
  const Particles *p = m->domain.particles;
  const Bars *b = bars_of(m);
  double held = 0, most = 0;
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] < 0.4) held += p->volume[p->place_of[n]] * p->internal.row[0][p->place_of[n]];
  for (int64_t e = 0; e < b->count; ++e) most = larger_of(most, b->stress[e]);
  assert_true(breccia_model_broken_bonds(m) > 100);
  assert_near(most, 5e5, 1e-6);
  assert_near(held, 5e5 * 1e-5, 0.01 * 5);
  assert_balanced(m, 0.01);
  breccia_model_destroy(&m);
}

static void lines_that_make_no_bar_are_refused(void **state)
{
  (void)state;
  static const struct {
    const char *bar, *words;
  } cases[] = {
      {"points: [[0, 0.1, 0.1], [1.3, 0.1, 0.1]], diameter: 8 mm, material: steel",
       "deck:8|outside the body at [1.1, 0.1, 0.1]|keep its line within"},
      {"points: [[0, 0.1, 0.1]], diameter: 8 mm, material: steel", "two or more"},
      {"points: [[0, 0.1, 0.1], [0, 0.1, 0.1]], diameter: 8 mm, material: steel", "points 1 and 2 are the same"},
      {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], material: steel", "diameter|area"},
      {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: 8 mm, area: 1 cm2, material: steel", "diameter|area"},
      {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: 8 mm, material: iron", "iron"},
      {"points: [[0.51, 0.1, 0.1], [0.52, 0.1, 0.1]], diameter: 8 mm, material: steel, snap: yes",
       "comes to one particle"},
      {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: 8 mm, material: clay",
       "'clay' is 'drucker-prager'|laws of one strain"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format(
        MATERIALS "  clay: {model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.2, cohesion: 10, "
                  "friction angle: 30 deg}\n"
                  "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.3, 0.3]}}}}\n"
                  "peridynamics: {formulation: correspondence}\n"
                  "bars: {r: {%s}}\n" REST,
        "elastic, Poisson ratio: 0.2", strstr(cases[k].bar, "clay") ? "" : STEEL_OF, cases[k].bar);
    char *words = refusal_of(deck);
    holds_words(words, cases[k].words);
    free(words);
    free(deck);
  }
}

static void points_in_the_plane_have_no_height(void **state)
{
  (void)state;
  char *deck = text_format(
      MATERIALS "body: {b: {material: soft, spacing: 0.1, lattice: square, thickness: 0.3, shape: {box: {from: [0, 0], "
                "to: [1, 0.3]}}}}\n"
                "peridynamics: {formulation: bond-based, space: plane stress}\n"
                "bars: {r: {points: [[0, 0.1, 0.04], [0.5, 0.1, 0.04]], diameter: 8 mm, material: steel}}\n" REST,
      "elastic-1d", STEEL_OF);
  char *words = refusal_of(deck);
  holds_words(words, "z = 0.04|give x and y only");
  free(words);
  free(deck);
}

static void materials_beside_bars_need_not_suit_the_formulation(void **state)
{
  (void)state;
  static const char block[] =
      "body: {b: {material: soft, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1, 0.3, 0.3]}}}}\n"
      "peridynamics: {formulation: correspondence}\n";
  breccia_model_destroy((breccia_model *[]){model_of(
      MATERIALS "%sbars: {r: {points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: 8 mm, material: soft}}\n" REST,
      "elastic, Poisson ratio: 0.2", STEEL_OF, block)});
  static const struct {
    const char *bar, *words;
  } mistakes[] = {{"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: 8 mm, material: stel", "no material 'stel'"},
                  {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diametre: 8 mm, material: steel", "diametre"},
                  {"points: [[0, 0.1, 0.1], [0.5, 0.1, 0.1]], diameter: -8 mm, material: steel", "diameter"},
                  {"points: [[0, 0.1, 0.1]], diameter: 8 mm, material: steel", "two or more"}};
  for (size_t k = 0; k < sizeof mistakes / sizeof *mistakes; ++k) {
    char *deck = text_format(MATERIALS "%sbars: {r: {%s}}\n" REST, "elastic, Poisson ratio: 0.2", STEEL_OF, block,
                             mistakes[k].bar);
    char *words = refusal_of(deck);
    holds_words(words, mistakes[k].words);
    if (strstr(words, "one strain")) fail_msg("%s", words);
    free(words);
    free(deck);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_element_feels_uniform_deformation_exactly),
      cmocka_unit_test(bars_neither_push_nor_turn_the_whole),
      cmocka_unit_test(bars_carry_nothing_where_the_body_only_turns),
      cmocka_unit_test(changes_are_those_of_forces_and_of_energy),
      cmocka_unit_test(a_bar_adds_its_stiffness_times_the_strain),
      cmocka_unit_test(every_way_to_solve_finds_the_same),
      cmocka_unit_test(steel_carries_what_its_law_says),
      cmocka_unit_test(steel_pushed_back_keeps_the_energy_of_its_stress),
      cmocka_unit_test(bonds_of_steel_pushed_back_store_energy),
      cmocka_unit_test(bars_tell_when_they_yield_and_tear),
      cmocka_unit_test(works_are_in_the_books_where_steel_yields),
      cmocka_unit_test(threads_and_restarts_give_the_same_bits),
      cmocka_unit_test(a_cracked_tie_carries_what_its_steel_yields_at),
      cmocka_unit_test(lines_that_make_no_bar_are_refused),
      cmocka_unit_test(materials_beside_bars_need_not_suit_the_formulation),
      cmocka_unit_test(points_in_the_plane_have_no_height),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

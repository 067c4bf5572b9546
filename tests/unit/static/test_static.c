/* Bodies at rest: the static solver, and the equations that it solves. */
#include "support.h"

#include "base/random.h"
#include "solver/increment.h"
#include "solver/linear_solver.h"
#include "solver/matrix.h"
#include "solver/newton.h"
#include "solver/rest.h"

static void run_all(breccia_model *model)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, INT64_MAX, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ELASTIC "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
#define SPRINGS "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
#define BLOCK "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
#define PLATE                                                                                                          \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"

#define TIED                                                                                                           \
  "selections: {corner: {inside: {box: {from: [0, 0, -1], to: [0.1, 0.1, 1]}}}}\n"                                     \
  "loads: [{on: {face: z-, layers: 1}, displacement: [0, 0, 0]}, {on: {except: corner}, tie: {to: corner}},"           \
  " {on: {face: z+, layers: 1}, traction: [1, 2, -0.5]}]\n"

/** Bodies of each formulation, held and loaded in different ways. */
static const struct Case {
  const char *name, *deck;
} cases[] = {
    {"correspondence in space", ELASTIC BLOCK "peridynamics: {formulation: correspondence, space: 3-D}\n"
                                              "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
                                              " {on: {face: x+, layers: 1}, traction: [1, 2, -0.5]}]\n"},
    {"ordinary in space", ELASTIC BLOCK "peridynamics: {formulation: ordinary, space: 3-D}\n"
                                        "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
                                        " {on: {face: x+, layers: 1}, displacement: [0.001, free, free]},"
                                        " {on: {nearest: [0.35, 0.25, 0.35]}, roller: [0, 1, 1]}]\n"},
    {"bonds in the plane", SPRINGS PLATE "peridynamics: {formulation: bond-based, space: plane stress}\n"
                                         "loads: [{on: {face: x-, layers: 2}, roller: [1, 0]},"
                                         " {on: {nearest: [0.75, 0.05]}, roller: [0.6, 0.8]},"
                                         " {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n"},
    {"correspondence in plane stress",
     ELASTIC PLATE "peridynamics: {formulation: correspondence, space: plane stress}\n"
                   "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]},"
                   " {on: {face: x+, layers: 1}, tie: {directions: x}},"
                   " {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n"},
    {"correspondence in plane strain",
     ELASTIC PLATE "peridynamics: {formulation: correspondence, space: plane strain}\n"
                   "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}},"
                   " {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n"},
    {"links with rotations",
     "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
     "body: {b: {material: m, lattice: face-centred cubic, spacing: 0.1, shape: {box: {particles: [4, 4, 3]}}}}\n"
     "peridynamics: {formulation: micropolar, space: 3-D}\n"
     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x-, layers: 1}, rotation: [0, free, "
     "0.001]}, {on: {face: x+, layers: 1}, tie: {directions: x}}, {on: {nearest: [0.3, 0.15, 0.1]}, roller: [0, 0.6, "
     "0.8]}]\n"},
    {"hybrid, levels tied",
     ELASTIC BLOCK "peridynamics: {formulation: hybrid, strain: small, horizon: 1.5 spacings}\n" TIED},
    {"hybrid, levels tied, finite strain",
     ELASTIC BLOCK "peridynamics: {formulation: hybrid, horizon: 1.5 spacings}\n" TIED},
    {"hybrid, periodic", ELASTIC PLATE
     "peridynamics: {formulation: hybrid, space: plane strain, strain: small}\n"
     "loads: [{on: {face: x-}, support: {held: periodic}}, {on: {face: y-, layers: 2}, displacement: [0, 0]},"
     " {on: {face: y+, layers: 1}, traction: [1, 0.5]}]\n"},
};
enum { CASES = sizeof cases / sizeof *cases };

static void fill_randomly(const Particles *p, const Vector *v, uint64_t seed)
{
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) v->row[k][p->place_of[n]] = random_uniform(&seed) - 0.5;
}

static void gathering_is_spreading_transposed(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    breccia_model *model = model_of(UNITS "%ssolve: {static: {increments: 1}}\n", cases[c].deck);
    const Particles *p = model->domain.particles;
    const Unknowns u = unknowns_of(&model->domain, &model->loading);
    const bool mirrored = strstr(cases[c].deck, "support") != NULL; /* forces on images are dropped */
    Vector v[1] = {{0}}, f[1] = {{0}}, q[1] = {{0}};
    assert_true(vector_create(v, &p->space, "test", NULL)), assert_true(vector_create(f, &p->space, "test", NULL)),
        assert_true(vector_create(q, &p->space, "test", NULL));
    fill_randomly(p, q, 1);
    fill_randomly(p, f, 2);
    unknowns_clear_rest(&u, q);
    vector_copy(v, q);
    unknowns_spread(&u, NAN, v);
    const double there = vector_inner(f, v, 1);
    unknowns_gather(&u, f);
    if (!mirrored) assert_near(vector_inner(f, q, 1), there, 1e-12 * (1 + fabs(there)));
    unknowns_clear_rest(&u, v); /* what was spread from is there still */
    for (int k = 0; k < p->space.rows; ++k)
      for (int64_t i = 0; i < p->places; ++i) assert_near(v->row[k][i], q->row[k][i], 1e-15);
    vector_destroy(v), vector_destroy(f), vector_destroy(q);
    breccia_model_destroy(&model);
  }
}

static void the_matrix_does_what_a_linearised_step_does(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    breccia_model *model = model_of(UNITS "%ssolve: {static: {increments: 1}}\n", cases[c].deck);
    Domain *d = &model->domain;
    const Particles *p = d->particles;
    LinearSolver solver = {.domain = d,
                           .loading = &model->loading,
                           .unknowns = unknowns_of(d, &model->loading),
                           .stiffness_share = 0.3,
                           .mass_factor = 7};
    Matrix m = {0};
    Vector v[1] = {{0}}, kv[1] = {{0}};
    double *x, *y;
    assert_true(vector_create(v, &p->space, "test", NULL)), assert_true(vector_create(kv, &p->space, "test", NULL));
    fill_randomly(p, &p->displacement, 5);
    for (int k = 0; k < p->space.rows; ++k)
      for (int64_t i = 0; i < p->places; ++i)
        p->displacement.row[k][i] *= k < d->body.dimensions || k >= p->space.rotation ? 0.01 : 0;
    assert_int_equal(domain_linearise(d, NULL, NULL), 0);
    assert_int_equal(matrix_create(&m, &solver.unknowns, NULL), 0);
    assert_int_equal(matrix_fill(&m, &solver.unknowns, solver.stiffness_share, solver.mass_factor, NULL), 0);
    assert_int_equal(m.size, unknowns_count(&solver.unknowns, NULL));
    x = calloc((size_t)m.size, sizeof *x);
    y = calloc((size_t)m.size, sizeof *y);
    uint64_t seed = 3;
    for (int64_t n = 0; n < m.size; ++n) x[n] = random_uniform(&seed) - 0.5;
    matrix_unpack(&m, &solver.unknowns, x, v);
    linear_solver_apply(&solver, v, kv);
    matrix_pack(&m, &solver.unknowns, kv, y);
    double largest = 0, most = 0;
    for (int64_t row = 0; row < m.size; ++row) {
      double sum = 0;
      for (int64_t t = m.first[row]; t < m.first[row + 1]; ++t) sum += m.value[t] * x[m.column[t]];
      largest = larger_of(largest, fabs(y[row]));
      most = larger_of(most, fabs(sum - y[row]));
    }
    if (!(most <= 1e-9 * largest)) fail_msg("%s: K v is off by %g of %g", cases[c].name, most, largest);
    assert_true(largest > 0);
    free(x), free(y);
    matrix_destroy(&m);
    vector_destroy(v), vector_destroy(kv);
    breccia_model_destroy(&model);
  }
}

static void both_ways_find_the_same_rest_and_reactions_are_the_loads(void **state)
{
  (void)state;
  static const char *const ways[] = {"direct", "conjugate gradients"};
  for (int c = 0; c < CASES; ++c) {
    Vector found[2] = {{0}};
    double largest = 0, most = 0;
    int64_t places = 0;
    for (int way = 0; way < 2; ++way) {
      const bool turns = strstr(cases[c].deck, "micropolar"); /* in space: its stiffness is not symmetric */
      breccia_model *model = model_of(UNITS "%ssolve: {static: {increments: 2, residual: 1e-10, equations: %s}}\n",
                                      cases[c].deck, way && turns ? "minimal residuals" : ways[way]);
      const Particles *p = model->domain.particles;
      run_all(model);
      places = p->places;
      assert_true(vector_create(&found[way], &p->space, "test", NULL));
      double forces[3] = {0}, size = 0;
      for (int k = 0; k < 3; ++k)
        for (int64_t i = 0; i < p->places; ++i) {
          found[way].row[k][i] = p->displacement.row[k][i];
          largest = larger_of(largest, fabs(p->displacement.row[k][i]));
          forces[k] += p->volume[i] * p->internal.row[k][i];
          size = larger_of(size, fabs(p->volume[i] * p->internal.row[k][i]));
        }
      for (int k = 0; k < 3; ++k) assert_near(forces[k], 0, 1e-10 * size * 100);
      assert_balanced(model, 2e-3); /* two increments, and strains that are not quite linear */
      assert_true(model->solver.clock.time == 1 && model->solver.clock.step == 2);
      breccia_model_destroy(&model);
    }
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < places; ++i) most = larger_of(most, fabs(found[0].row[k][i] - found[1].row[k][i]));
    if (!(most <= 1e-7 * largest)) fail_msg("%s: displacements differ by %g of %g", cases[c].name, most, largest);
    assert_true(largest > 0);
    vector_destroy(&found[0]), vector_destroy(&found[1]);
  }
}

/** Shares of forces out of balance after each iteration of the last increment, until control of zero-energy modes is renewed, from what the
 *  solver tells. @return how many */
static int residuals_of(const breccia_model *model, double *residual, int most)
{
  const char *const words = text_words(&model->solver.log), *const again = strstr(words, "again");
  int count = 0;
  for (const char *at = words; (at = strstr(at, "residual ")) && (!again || at < again) && count < most; ++at)
    residual[count++] = atof(at + strlen("residual "));
  return count;
}

/* Whether a correction near equilibrium was not taken whole: to look for a better share of it takes forces that nobody needs. Further off it may be
 * right, and roundings of a machine decide where bonds of a law with kinks turn. */
static bool cuts_near_rest(const breccia_model *model)
{
  const double near = 1e-2;
  double before = INFINITY;
  const char *line = strstr(text_words(&model->solver.log), "iteration ");
  while (line) {
    const char *const end = strchr(line, '\n'), *const part = strstr(line, "of it taken");
    if (before < near && part && end && part < end) return true;
    before = atof(strstr(line, "residual ") + strlen("residual "));
    line = end ? strstr(end, "iteration ") : NULL;
  }
  return false;
}

/* Every law whose tangent is that of its step: a block is bent, pulled, or pressed while it is held across, until much of it flows, crushes or cracks;
 * where nothing does, until its shape matters. */
static const struct {
  const char *law, *formulation, *moved; /* of its end, in m */
} laws_with_tangents[] = {
    {"j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening modulus: 1e3", "correspondence",
     "[0, 0, 0.01]"},
    {"drucker-prager, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 6, friction angle: 20 deg, dilation angle: 20 "
     "deg",
     "correspondence", "[0, 0, 0.01]"},
    {"drucker-prager, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 6, friction angle: 20 deg, dilation angle: 5 "
     "deg, hardening modulus: 500",
     "correspondence", "[0, 0, 0.01]"},
    {"mohr-coulomb, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 6, friction angle: 20 deg, dilation angle: 20 "
     "deg, tensile strength: 16.484",
     "correspondence", "[0, 0, 0.01]"},
    {"multi-yield-j2, shear modulus: 4e3, bulk modulus: 6e3, octahedral strength: 12", "correspondence",
     "[0, 0, 0.01]"},
    {"bounding-surface-clay, shear modulus: 4e3, bulk modulus: 6e3, undrained strength: 12, hardening modulus: 4e3",
     "correspondence", "[0, 0, 0.01]"},
    {"cap, bulk modulus: 14478996, shear modulus: 11721092, cap position: 110320, compaction rate: 4.6412e-7, largest "
     "compaction: 0.42, cap ratio: 4.43, envelope drop: 7997.9, envelope slope: 0.11, envelope rate: 6.3816e-5, "
     "envelope strength: 2.6614e4, tension cut-off: 2068.4",
     "correspondence", "[0, 0, 0.003]"},
    {"damage-plasticity, Young modulus: 30e6, Poisson ratio: 0.2, tensile strength: 3000, fracture energy: 0.1, "
     "compressive strength: 34000",
     "correspondence", "[0, 0, 0.0003]"},
    {"mazars, Young modulus: 30e6, Poisson ratio: 0.2, tensile strength: 3000, fracture energy: 0.1", "correspondence",
     "[0, 0, 0.0004]"},
    {"j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10", "ordinary", "[0, 0, 0.01]"},
    {"j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening modulus: 1e3", "hybrid", "[0, 0, 0.01]"},
    {"menegotto-pinto, Young modulus: 2e8, yield stress: 2e5", "bond-based", "[0.003, 0, 0]"},
    {"concrete02, compressive strength: 34000", "bond-based", "[-0.001, 0, 0.0004]"},
    {"kent-scott-park, compressive strength: 34000", "bond-based", "[-0.001, 0, 0.0004]"},
    {"mander, compressive strength: 34000, Young modulus: 30e6", "bond-based", "[-0.001, 0, 0.0004]"},
    {"steel-bilinear, Young modulus: 2e8, yield stress: 2e5", "bond-based", "[0.003, 0, 0]"},
    {"elastic-perfectly-plastic, Young modulus: 2e8, yield stress: 2e5", "bond-based", "[0, 0, 0.003]"},
    {"bilinear-softening, Young modulus: 30e6, tensile strength: 3000, fracture energy: 0.1", "bond-based",
     "[0, 0, 0.00019]"},
    {"trilinear-softening, Young modulus: 30e6, tensile strength: 3000, fracture energy: 0.1", "bond-based",
     "[0, 0, 0.00022]"},
    {"exponential-softening, Young modulus: 30e6, tensile strength: 3000, fracture energy: 0.1", "bond-based",
     "[0, 0, 0.0002]"},
    {"viscoelastic, Young modulus: 1e4, Poisson ratio: 0.25, relaxing share: 0.5, relaxation time: 1", "correspondence",
     "[0, 0, 0.1]"},
    {"elastic, Young modulus: 1e4, Poisson ratio: 0.25", "correspondence", "[0, 0, 0.1]"},
    {"elastic-1d, Young modulus: 1e4", "bond-based", "[0, 0, 0.1]"},
    {"elastic-brittle, Young modulus: 1e4, tensile strength: 1e4", "bond-based", "[0, 0, 0.1]"},
};

/** The table contains all laws except those for which static solvers use secants. */
static void every_law_is_among_them(void **state)
{
  (void)state;
  static const char *const others[] = {"link-damage", "fib-concrete"};
  for (int k = 0; law_at(NULL, k); ++k) {
    const char *name = law_at(NULL, k)->name;
    bool found = false;
    for (size_t l = 0; l < sizeof others / sizeof *others; ++l) found |= !strcmp(name, others[l]);
    for (size_t l = 0; l < sizeof laws_with_tangents / sizeof *laws_with_tangents; ++l)
      found |= strcspn(laws_with_tangents[l].law, ",") == strlen(name) &&
               !strncmp(laws_with_tangents[l].law, name, strlen(name));
    if (!found) fail_msg("'%s' is not among them", name);
  }
}

static void laws_with_tangents_converge_quadratically(void **state)
{
  (void)state;
  for (size_t l = 0; l < sizeof laws_with_tangents / sizeof *laws_with_tangents; ++l) {
    breccia_model *model =
        model_of(UNITS "materials: {m: {model: %s, density: 2}}\n"
                       "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
                       "peridynamics: {formulation: %s, space: 3-D, horizon: 1.5 spacings}\n"
                       "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
                       " {on: {face: x+, layers: 1}, displacement: %s, history: {ramp to: 1}}%s]\n"
                       "solve: {static: {increments: 4, residual: 1e-11, equations: direct}}\n",
                 laws_with_tangents[l].law, laws_with_tangents[l].formulation, laws_with_tangents[l].moved,
                 laws_with_tangents[l].moved[1] == '-'
                     ? ", {on: {inside: {box: {from: [0.1, 0, 0], to: [0.8, 1, 1]}}}, roller: [0, 1, 0]},"
                       " {on: {inside: {box: {from: [0.1, 0, 0], to: [0.8, 1, 1]}}}, roller: [0, 0, 1]}"
                     : "");
    run_all(model);
    double residual[20];
    const int count = residuals_of(model, residual, 20);
    bool plastic = false, quick = false;
    for (int n = 1; n < count; ++n) {
      plastic |= residual[n - 1] > 1e-6;
      quick |= residual[n - 1] < 2e-3 && residual[n] < 90 * residual[n - 1] * residual[n - 1] + 1e-12 &&
               residual[n - 1] > 1e-8;
    }
    if (!plastic || !quick || cuts_near_rest(model) || count > 10)
      fail_msg("%s:\n%s", laws_with_tangents[l].law, text_words(&model->solver.log));
    const Energy e = solver_energy(&model->solver);
    const bool linear =
        !strncmp(laws_with_tangents[l].law, "elastic", 7) && !strstr(laws_with_tangents[l].law, "plastic");
    if (!linear && !(e.dissipated > 0.1 * e.external)) fail_msg("%s: elastic to the end", laws_with_tangents[l].law);
    breccia_model_destroy(&model);
  }
}

/** Equations of bodies whose answer is linear are solved as closely as equilibrium wants, and once. */
static void elastic_bodies_take_one_iteration(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence, strain: small", "bond-based"};
  static const char *const ways[] = {"conjugate gradients", "minimal residuals", "direct"};
  for (int n = 0; n < 6; ++n) {
    breccia_model *model = model_of(
        UNITS "%s" PLATE "peridynamics: {formulation: %s, space: plane stress}\n"
              "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 1}, traction: "
              "[1e-6, 5e-7]}]\nsolve: {static: {increments: 2, equations: %s}}\n",
        n % 2 ? SPRINGS : ELASTIC, formulations[n % 2], ways[n / 2]);
    for (int k = 0; k < 2; ++k) {
      step_surely(model, 1);
      const char *log = text_words(&model->solver.log);
      if (!k && (!strstr(log, "iteration 1: ") || strstr(log, "iteration 2: ")))
        fail_msg("%s, %s: %s", formulations[n % 2], ways[n / 2], log);
    }
    breccia_model_destroy(&model);
  }
}

/** An increment for which no equilibrium is found is halved until one is; from there on each is at most twice as long as the one before, up to the
 *  whole. solution.txt tells of all that were tried. */
static void increments_are_halved_and_grow_again(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, "
            "hardening modulus: 100}}\n"
            "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
            "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
            "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
            " {on: {face: x+, layers: 1}, traction: [40, 3, 0], history: {table: [[0, 0], [0.3, 1], [1, 1.02]]}}]\n"
            "solve: {static: {increments: 4, iterations: 5}}\n");
  double before = 0.25, shortest = 1;
  int grown = 0, cuts = 0, tries = 0;
  while (!model->solver.clock.ended) {
    step_surely(model, 1);
    const double length = model->solver.clock.time_step;
    for (const char *at = text_words(&model->solver.log); (at = strstr(at, "no equilibrium: ")); ++at) ++cuts;
    for (const char *at = text_words(&model->solver.log); (at = strstr(at, ", from time ")); ++at) ++tries;
    assert_true(length <= 2 * before * (1 + 1e-9) && length <= 0.25 * (1 + 1e-9));
    grown += length > 1.9 * before;
    shortest = fmin(shortest, length);
    before = length;
  }
  assert_int_equal(tries, cuts + model->solver.clock.step);
  assert_true(cuts > 1 && shortest < 0.13 && grown > 0);
  assert_near(model->solver.clock.time, 1, 1e-12);
  breccia_model_destroy(&model);
}

static void a_bar_that_flows_carries_its_strength_and_no_more(void **state)
{
  (void)state;
  /* 10 kPa of strength, by a pull that grows to 12: beyond that it finds no equilibrium, and the last one found stays as it was. */
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, "
            "hardening modulus: 0}}\n"
            "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
            "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
            "loads: [{on: {face: x-, layers: 1}, roller: [1, 0, 0]}, {on: {face: y-, layers: 1}, roller: [0, 1, 0]},"
            " {on: {face: z-, layers: 1}, roller: [0, 0, 1]},"
            " {on: {face: x+, layers: 1}, traction: [12, 0, 0], history: {ramp to: 1}}]\n"
            "solve: {static: {increments: 12}}\n");
  const Particles *p = model->domain.particles;
  step_must_fail(model,
                 "no equilibrium beyond time 0.8| s, with increments cut to | s: |; the body may fail at this load: go "
                 "on with a stage of 'explicit', or look at the loads and at the last pictures");
  /* At the other end one layer alone takes the reaction, which spreads over a horizon, where the bar is confined and a little stronger. */
  assert_near(model->solver.clock.time, 10.55 / 12, 0.01);
  double pull = 0, carried = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    pull += p->volume[i] * p->external.row[0][i];
    if (p->position[0][i] < 0.1) carried += p->volume[i] * p->internal.row[0][i];
  }
  assert_near(pull, 12 * model->solver.clock.time * 0.09, 1e-9);
  assert_near(carried, pull, 1e-6 * pull);
  breccia_model_destroy(&model);
}

/** A number among the rows of a solver's state. */
static double number_of(breccia_model *model, const char *row)
{
  StateList list = {0};
  solver_state(&model->solver, &list);
  const StateRow *found = state_find(&list, row);
  assert_non_null(found);
  const double number = found->kind == STATE_COUNTS ? (double)*(int64_t *)found->values : *(double *)found->values;
  state_list_destroy(&list);
  return number;
}

/** Increments that failed one after the other, and were cut, leave no trace once the step is given up. */
static void a_step_that_fails_before_anything_broke_does_not_count(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, "
            "hardening modulus: 0}}\n"
            "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 3, 3]}}}}\n"
            "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
            "loads: [{on: {face: x-, layers: 1}, roller: [1, 0, 0]}, {on: {face: y-, layers: 1}, roller: [0, 1, 0]},"
            " {on: {face: z-, layers: 1}, roller: [0, 0, 1]},"
            " {on: {face: x+, layers: 1}, traction: [30, 0, 0], history: {ramp to: 1}}]\n"
            "solve: {static: {increments: 2, smallest increment: 0.6}}\n");
  const double next = number_of(model, "next increment");
  step_must_fail(model,
                 "no equilibrium beyond time 0 s,|, with increments cut to |; the body may fail at this load: go "
                 "on with a stage of 'explicit', or look at the loads and at the last pictures");
  assert_int_equal(model->solver.clock.step, 0);
  assert_true(number_of(model, "next increment") == next && number_of(model, "cuts of increments") == 0);
  breccia_model_destroy(&model);
}

/** What is not met is named, with the key that helps: of elastic and of yielding bodies, by Newton's method and by relaxation. */
static void the_tolerance_that_is_not_met_is_named(void **state)
{
  (void)state;
  static const struct {
    const char *law, *solve, *words;
  } missed[] = {
      {"elastic", "displacement tolerance: 1e-40",
       "which is enough, but the last correction is larger than|; take a larger 'displacement tolerance' or 'energy "
       "tolerance'"},
      {"j2, yield stress: 5, hardening modulus: 1e3", "energy tolerance: 1e-40",
       "which is enough, but the last correction is larger than|; take a larger 'displacement tolerance' or 'energy "
       "tolerance'"},
      {"elastic", "method: relaxation, relaxation iterations: 1",
       "; allow more 'relaxation iterations', or take a larger 'residual'"},
      {"elastic", "iterations: 1, residual: 1e-13", "; allow more 'iterations', or take a larger 'residual'"},
  };
  for (size_t k = 0; k < sizeof missed / sizeof *missed; ++k) {
    breccia_model *model = model_of(
        UNITS "materials: {m: {model: %s, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 3, 3]}}}}\n"
              "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings}\n"
              "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x+, layers: 1}, traction: [6, "
              "1, 0], history: {ramp to: 1}}]\n"
              "solve: {static: {increments: 1, smallest increment: 0.6, %s}}\n",
        missed[k].law, missed[k].solve);
    step_must_fail(model, missed[k].words);
    breccia_model_destroy(&model);
  }
}

/** Patterns that nothing resists, of correspondence without control: factors that are singular but for rounding lead them away by 1e14 m, in balance. */
static void a_body_that_is_carried_away_finds_no_equilibrium(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: multi-yield-j2, density: 1.5, shear modulus: 6e4, bulk modulus: 1e5, octahedral "
            "strength: 30, peak octahedral strain: 0.1, surfaces: 20}}\n"
            "body: {b: {material: m, lattice: square, spacing: 0.25, thickness: 1, shape: {box: {from: [0, 0], to: [2, "
            "10]}}}}\n"
            "peridynamics: {formulation: correspondence, space: plane strain, strain: small, horizon: 2.015 spacings, "
            "zero-energy control: {none: yes}}\n"
            "loads: [{on: {face: y-}, support: {held: all}}, {on: {face: x-}, support: {held: periodic}},"
            " {on: {face: y+}, traction: [33.07, 0], spread: layers, history: {ramp to: 1}}]\n"
            "solve: {static: {increments: 18, residual: 1e-10, equations: direct, smallest increment: 0.01}}\n");
  step_must_fail(model, "no equilibrium beyond time 0.|, with increments cut to |; the body may fail at this load: go "
                        "on with a stage of 'explicit', or look at the loads and at the last pictures");
  const Particles *p = model->domain.particles;
  for (int64_t i = 0; i < p->places; ++i) assert_true(fabs(p->displacement.row[0][i]) < 1e4);
  breccia_model_destroy(&model);
}

/** A brittle strip that a growing force tears: the bonds that broke are gone, so the step counts, and what loads have paid in it too. */
static void a_body_that_is_moved_as_a_whole_is_at_rest(void **state)
{
  (void)state;
  const char *const ways[] = {"equations: direct", "equations: minimal residuals", "method: relaxation"};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m =
        model_of(UNITS SOFT_SOLID
                 "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {from: [0, "
                 "0], to: [0.1, 0.1]}}}}\n"
                 "peridynamics: {space: plane strain}\n"
                 "loads: [{on: {face: y+, layers: 3}, displacement: [0.03, -0.04], history: {ramp to: 1}}]\n"
                 "solve: {static: {increments: 4, %s}}\n",
                 ways[k]);
    step_surely(m, 4); /* not one of them is cut, and roundings are not energy from nothing */
    assert_true(solver_is_done(&m->solver));
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n) {
      assert_near(p->displacement.row[0][p->place_of[n]], 0.03, 1e-12);
      assert_near(p->displacement.row[1][p->place_of[n]], -0.04, 1e-12);
    }
    assert_true(solver_energy(&m->solver).imbalance < 0.1);
    Rest rest;
    assert_int_equal(rest_find(&m->solver, &rest, NULL), 0);
    assert_true(rest.reached);
    breccia_model_destroy(&m);
  }
}

static void a_step_in_which_bonds_broke_counts_though_it_fails(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS SPRINGS PLATE "peridynamics: {formulation: bond-based, space: plane stress}\n"
                                   "failure: {critical stretch: 0.01}\n"
                                   "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]},"
                                   " {on: {face: x+, layers: 1}, traction: [200, 0], history: {ramp to: 1}}]\n"
                                   "solve: {static: {increments: 10}}\n");
  const Solver *s = &model->solver;
  step_must_fail(model, "static: with |broken bonds the body finds no equilibrium any more at time |it has failed at "
                        "this load: go on with a stage of 'explicit', or prescribe displacements instead of forces");
  assert_true(s->clock.step > 1);
  assert_int_equal(s->records[0].last_step, s->clock.step);
  assert_true(s->records[0].end == s->clock.time);
  assert_int_equal(model->domain.broken[model->domain.broken_count - 1].step, s->clock.step);
  assert_true(s->ledger.paid >= fabs(s->ledger.external_work));
  breccia_model_destroy(&model);
}

/** Nothing acts on it in the end, and what roundings leave out of balance is small beside what did. */
static void an_unloaded_body_is_at_rest(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS ELASTIC PLATE
               "peridynamics: {formulation: correspondence, space: plane stress}\n"
               "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]},"
               " {on: {face: x+, layers: 1}, traction: [1, 0.5], history: {table: [[0, 0], [1, 1], [2, 0]]}}]\n"
               "solve: {static: {increments: 2, end time: 2}}\n");
  run_all(model);
  Rest rest;
  assert_int_equal(rest_find(&model->solver, &rest, NULL), 0);
  if (!rest.meant || !rest.reached) fail_msg("out of balance: %g", rest.unbalanced);
  breccia_model_destroy(&model);
}

/** What is left when the last load is taken away is measured by what the body held before: measured by itself, which goes to zero too, it was never small
 *  enough, and increments were cut until the run failed. */
static void the_last_load_is_taken_away_in_few_iterations(void **state)
{
  (void)state;
  const char *laws[] = {"elastic-1d", "bilinear-softening, tensile strength: 3 MPa, fracture energy: 100 N/m"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        "materials: {m: {density: 2400 kg/m3, model: %s, Young modulus: 30 GPa}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [10, 5]}}}}\n"
        "peridynamics: {formulation: bond-based, space: plane stress}\n"
        "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]},\n"
        "        {name: pull, on: {face: x+, layers: 2}, force: [0.3 MN, 0]}]\n"
        "solve:\n  - {name: up, static: {increments: 1}}\n"
        "  - {name: gone, without: [pull], static: {increments: 1, iterations: 4, smallest increment: 1}}\n",
        laws[k]);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n) assert_near(p->displacement.row[0][p->place_of[n]], 0, 1e-11);
    breccia_model_destroy(&m);
  }
}

static void a_loose_body_is_refused(void **state)
{
  (void)state;
  char *words = refusal_of(UNITS ELASTIC BLOCK "peridynamics: {formulation: correspondence, space: 3-D}\n"
                                               "loads: [{on: {face: x-, layers: 1}, roller: [1, 0, 0]},"
                                               " {on: {face: x+, layers: 1}, traction: [1, 0, 0]}]\n"
                                               "solve: {static: {increments: 1}}\n");
  assert_non_null(strstr(words, "nothing holds the body against moving"));
  free(words);
  words = refusal_of(UNITS ELASTIC BLOCK "peridynamics: {formulation: correspondence, space: 3-D}\n"
                                         "loads: [{on: {nearest: [0, 0, 0]}, displacement: [0, 0, 0]}]\n"
                                         "solve: {static: {increments: 1}}\n");
  assert_non_null(strstr(words, "about"));
  free(words);
  words = refusal_of(UNITS ELASTIC PLATE "peridynamics: {formulation: correspondence, space: plane strain}\n"
                                         "loads: [{on: {nearest: [0, 0]}, displacement: [0, 0]}]\n"
                                         "solve: {static: {increments: 1}}\n");
  assert_non_null(strstr(words, "moving about z")); /* not along y, as it would without its turning */
  free(words);
}

/** Of three blocks two are let go when a stage ties one to the one that is held; the other is loose from then on, and this is said before anything runs. */
static void a_block_that_a_later_stage_leaves_loose_is_refused(void **state)
{
  (void)state;
  static const char deck[] = UNITS
      "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
      "body:\n"
      "  a: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [0, 0], to: [0.6, 0.6]}}}\n"
      "  b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [2, 0], to: [2.6, 0.6]}}}\n"
      "  c: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [4, 0], to: [4.6, 0.6]}}}\n"
      "peridynamics: {space: plane strain}\n"
      "loads: [{on: {block: a, face: x-}, displacement: [0, 0]}, {name: b held, on: {block: b}, displacement: [0, 0]},"
      " {name: c held, on: {block: c}, displacement: [0, 0]}]\n"
      "solve: [{static: {increments: 1}}, {without: [b held%s], loads: [{on: {block: b, face: x-}, tie: {to: "
      "{block: a, face: x+}}}, {on: {block: b, face: x+}, traction: [1, 0]}], static: {increments: 1}}]\n";
  char text[2048];
  snprintf(text, sizeof text, deck, ", c held");
  char *words = refusal_of(text);
  holds_words(words, "nothing holds a piece of 36 particles|[4.05, 0.05, 0]");
  free(words);
  breccia_model *m = model_of(deck, "");
  run_all(m);
  assert_true(
      m->domain.particles->displacement.row[0][particles_nearest(m->domain.particles, (double[]){2.55, 0.3, 0})] > 0);
  breccia_model_destroy(&m);
}

/** Conjugate gradients that were asked for by name: nothing would come of them, increment after increment. */
static void equations_that_do_not_suit_are_named(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 6, "
            "friction "
            "angle: 35 deg, dilation angle: 0, hardening modulus: 500}}\n" BLOCK
            "peridynamics: {formulation: correspondence}\n"
            "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0, 0]}, {on: {face: x+, layers: 2}, displacement: "
            "[0, 0.02, 0], history: {ramp to: 1}}]\n"
            "solve: {static: {equations: conjugate gradients}}\n");
  step_must_fail(model, "the stiffness is not symmetric");
  breccia_model_destroy(&model);
}

/** Bonds are looked at when particles may have moved so far that one could have reached its limit: in one increment or in many. */
static void motions_add_up_until_bonds_are_judged(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS SPRINGS PLATE
               "peridynamics: {formulation: bond-based, space: plane stress}\n"
               "failure: {critical stretch: 0.01}\n"
               "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}]\nsolve: {static: {increments: 1}}\n");
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  const double tenth = 0.1 * 0.01 * 0.1; /* of the elongation at which a shortest bond breaks */
  const int32_t pulled = body_nearest(&d->body, (double[3]){0.75, 0.55, 0});
  Increment increment = {0};
  Vector moved[1] = {{0}};
  assert_true(vector_create(moved, &p->space, "test", NULL));
  assert_int_equal(increment_create(&increment, d, &model->loading, NULL), 0);
  moved->row[0][pulled] = tenth;
  for (int k = 0; k < 12; ++k) {
    if (k == 4) assert_int_equal(increment_break(&increment, &model->solver.clock, 0), 0);
    p->displacement.row[0][pulled] += tenth;
    increment_accept(&increment, moved);
  }
  assert_true(increment_break(&increment, &model->solver.clock, 0) > 0);
  increment_destroy(&increment);
  vector_destroy(moved);
  breccia_model_destroy(&model);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(motions_add_up_until_bonds_are_judged),
      cmocka_unit_test(equations_that_do_not_suit_are_named),
      cmocka_unit_test(gathering_is_spreading_transposed),
      cmocka_unit_test(the_matrix_does_what_a_linearised_step_does),
      cmocka_unit_test(both_ways_find_the_same_rest_and_reactions_are_the_loads),
      cmocka_unit_test(every_law_is_among_them),
      cmocka_unit_test(laws_with_tangents_converge_quadratically),
      cmocka_unit_test(elastic_bodies_take_one_iteration),
      cmocka_unit_test(increments_are_halved_and_grow_again),
      cmocka_unit_test(a_bar_that_flows_carries_its_strength_and_no_more),
      cmocka_unit_test(a_step_that_fails_before_anything_broke_does_not_count),
      cmocka_unit_test(a_step_in_which_bonds_broke_counts_though_it_fails),
      cmocka_unit_test(the_tolerance_that_is_not_met_is_named),
      cmocka_unit_test(a_body_that_is_carried_away_finds_no_equilibrium),
      cmocka_unit_test(a_body_that_is_moved_as_a_whole_is_at_rest),
      cmocka_unit_test(an_unloaded_body_is_at_rest),
      cmocka_unit_test(the_last_load_is_taken_away_in_few_iterations),
      cmocka_unit_test(a_loose_body_is_refused),
      cmocka_unit_test(a_block_that_a_later_stage_leaves_loose_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

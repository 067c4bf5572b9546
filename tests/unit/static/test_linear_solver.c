/* Krylov methods on products with the stiffness and factors of the assembled matrix, against dense solutions of the same products, and how many products
 * they take. */
#include "support.h"

#include "base/linear.h"
#include "base/random.h"
#include "solver/matrix.h"
#include "solver/preconditioner.h"
#include <dirent.h>

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define END "solve: {explicit: {steps: 1, time step: 1e-6}}\n"
#define ELASTIC "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
#define LINKS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
#define SPRINGS "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
#define TWO                                                                                                            \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}, n: {model: elastic, "         \
  "density: 2, Young modulus: 50, "                                                                                    \
  "Poisson ratio: 0.4}}\n"
#define FIBRES                                                                                                         \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}, f: {model: elastic-1d, "      \
  "density: 2, Young modulus: 1e4}}\n"
#define BLOCK "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
#define BLOCKS                                                                                                         \
  "body: {a: {material: m, spacing: 0.1, shape: {box: {particles: [4, 5, 4]}}},\n"                                     \
  "       b: {material: n, spacing: 0.1, shape: {box: {from: [0.4, 0, 0], to: [0.7, 0.5, 0.4]}}}}\n"
#define PLATE                                                                                                          \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 7]}}}}\n"
#define HOLD "{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}"

/** Each formulation, held and loaded in different ways. */
static const struct Case {
  const char *name, *deck;
} cases[] = {
    {"correspondence in space",
     ELASTIC BLOCK "peridynamics: {formulation: correspondence, space: 3-D}\n"
                   "loads: [" HOLD ", {on: {face: x+, layers: 1}, traction: [1, 2, -0.5]}]\n"},
    {"ordinary in space",
     ELASTIC BLOCK "peridynamics: {formulation: ordinary, space: 3-D}\n"
                   "loads: [" HOLD ", {on: {face: x+, layers: 1}, displacement: [0.001, free, free]},"
                   " {on: {nearest: [0.35, 0.25, 0.35]}, roller: [0, 1, 1]}]\n"},
    {"bonds in space", SPRINGS BLOCK "peridynamics: {formulation: bond-based, space: 3-D}\n"
                                     "loads: [" HOLD ", {on: {face: x+, layers: 1}, tie: {directions: x}}]\n"},
    {"two materials", TWO BLOCKS "peridynamics: {formulation: correspondence, space: 3-D}\n"
                                 "loads: [" HOLD ", {on: {face: x+}, traction: [1, 2, -0.5]}]\n"},
    {"bonds in the plane", SPRINGS PLATE "peridynamics: {formulation: bond-based, space: plane stress}\n"
                                         "loads: [{on: {face: x-, layers: 2}, roller: [1, 0]},"
                                         " {on: {nearest: [0.75, 0.05]}, roller: [0.6, 0.8]},"
                                         " {on: {face: x+, layers: 1}, traction: [1, 0.5]}]\n"},
    {"correspondence in plane stress", ELASTIC PLATE
     "peridynamics: {formulation: correspondence, space: plane stress}\n"
     "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {on: {face: x+, layers: 1}, tie: {directions: x}}]\n"},
    {"ordinary on springs", ELASTIC PLATE "peridynamics: {formulation: ordinary, space: plane strain}\n"
                                          "loads: [{on: {all: yes}, spring: {stiffness: 2e3}}]\n"},
    {"a bar",
     SPRINGS "body: {b: {material: m, lattice: line, area: 0.5, spacing: 0.1, shape: {box: {particles: [40, 1]}}}}\n"
             "peridynamics: {formulation: bond-based, space: 1-D}\n"
             "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}]\n"},
    {"a quarter of a plate",
     ELASTIC PLATE "peridynamics: {formulation: correspondence, space: plane strain}\n"
                   "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}}]\n"},
    {"bonds beside correspondence on springs", FIBRES
     "body: {a: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [5, 7]}}},\n"
     "       b: {material: f, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0.5, 0], to: [0.9, "
     "0.7]}}}}\n"
     "peridynamics: {formulation: correspondence, space: plane strain, regions: {fibres: {blocks: [b], formulation: "
     "bond-based}}}\n"
     "loads: [" HOLD ", {on: {face: x+, layers: 1}, spring: {stiffness: 2e3, direction: [0.6, 0.8]}},"
     " {on: {nearest: [0.45, 0.65]}, spring: {stiffness: 1e3, to: {nearest: [0.75, 0.05]}}},"
     " {on: {face: y+, layers: 1}, spring: {stiffness: 3e3, direction: [1, 2], to: {face: y-, layers: 1}}}]\n"},
    {"links in the plane", LINKS
     "body: {b: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 7]}}}}\n"
     "peridynamics: {formulation: micropolar, space: plane stress}\n"
     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}, {on: {face: x-, layers: 1}, rotation: [0, 0, 0]},"
     " {on: {nearest: [0.75, 0.05]}, roller: [0.6, 0.8]}, {on: {nearest: [0.45, 0.3]}, rotation: [0, 0, 0]},"
     " {on: {face: x+, layers: 1}, tie: {directions: x}}, {on: {face: y+, layers: 1}, spring: {stiffness: 2e3}}]\n"},
    {"links in space",
     LINKS "body: {b: {material: m, lattice: face-centred cubic, spacing: 0.1, shape: {box: {particles: [4, 3, 3]}}}}\n"
           "peridynamics: {formulation: micropolar, space: 3-D}\n"
           "loads: [" HOLD ", {on: {nearest: [0.3, 0.1, 0.1]}, rotation: [0, free, 0]}]\n"},
    {"links beside particles without rotations", LINKS
     "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [5, 6]}}},"
     " c: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0.5, 0], to: [1, 0.6]}}}}\n"
     "peridynamics: {formulation: micropolar, space: plane stress, horizon: 1.5 spacings,"
     " regions: {other: {blocks: [c], formulation: ordinary}}}\n"
     "loads: [{on: {block: c, face: y-}, support: {held: across}}, {on: {face: x-, layers: 1}, displacement: [0, 0]},"
     " {on: {face: x+, layers: 1}, displacement: [0, free]}, {on: {nearest: [0.75, 0.35]}, roller: [0.6, 0.8]},"
     " {on: {inside: {box: {from: [0.2, 0.5], to: [0.8, 0.6]}}}, "
     "tie: {directions: y}}]\n"},
};
enum { CASES = sizeof cases / sizeof *cases };

/** A model, linearised at a strained state, and what is solved of it. */
typedef struct Problem {
  breccia_model *model;
  Domain *domain;
  LinearSolver solver;
  Vector f[1], v[1], kv[1];
  Team *before;
} Problem;

static void fill_randomly(const Particles *p, const Vector *v, double size, uint64_t seed)
{
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) v->row[k][p->place_of[n]] = size * (random_uniform(&seed) - 0.5);
}

static Problem pose(breccia_model *model, double mass_factor)
{
  Problem problem = {.model = model, .domain = &model->domain};
  const Particles *p = problem.domain->particles;
  problem.before = team_use(model->team);
  problem.solver = (LinearSolver){.domain = problem.domain,
                                  .loading = &model->loading,
                                  .unknowns = unknowns_of(problem.domain, &model->loading),
                                  .mass_factor = mass_factor};
  assert_true(vector_create(problem.f, &p->space, "test", NULL) && vector_create(problem.v, &p->space, "test", NULL) &&
              vector_create(problem.kv, &p->space, "test", NULL));
  fill_randomly(p, problem.f, 1, 4);
  unknowns_clear_rest(&problem.solver.unknowns, problem.f);
  assert_int_equal(domain_linearise(problem.domain, NULL, NULL), 0);
  return problem;
}

static void begin(Problem *p, int word)
{
  assert_int_equal(linear_solver_create(&p->solver, word, NULL), 0);
  assert_int_equal(linear_solver_prepare(&p->solver, NULL), 0);
}

static LinearRecord solve(Problem *p, double tolerance)
{
  LinearRecord record;
  vector_clear(p->v);
  assert_int_equal(linear_solver_solve(&p->solver, p->f, p->v, tolerance, &record, NULL), 0);
  return record;
}

static void forget(Problem *p)
{
  linear_solver_destroy(&p->solver);
  vector_destroy(p->f), vector_destroy(p->v), vector_destroy(p->kv);
  team_use(p->before);
  breccia_model_destroy(&p->model);
}

/** Solves by products with one displacement after another. What is not free has a stiffness of 1, alone. */
static void solve_densely(Problem *p, const Vector *v)
{
  const Particles *particles = p->domain->particles;
  const Unknowns *u = &p->solver.unknowns;
  const int rows = particles->space.rows, size = rows * (int)particles->count;
  double *matrix = calloc((size_t)size * (size_t)size, sizeof *matrix), *right = calloc((size_t)size, sizeof *right);
  Vector moved[1] = {{0}};
  double scale = 0;
  assert_true(vector_create(moved, &particles->space, "test", NULL));
  for (int column = 0; column < size; ++column) {
    const int32_t place = particles->place_of[column / rows];
    vector_clear(moved);
    moved->row[column % rows][place] = 1;
    unknowns_clear_rest(u, moved);
    for (int row = 0; row < size; ++row)
      matrix[row * size + column] = (row == column) - moved->row[row % rows][particles->place_of[row / rows]];
    linear_solver_apply(&p->solver, moved, p->kv);
    for (int row = 0; row < size; ++row)
      matrix[row * size + column] += p->kv->row[row % rows][particles->place_of[row / rows]];
    right[column] = p->f->row[column % rows][place];
    scale = larger_of(scale, fabs(matrix[column * size + column]));
  }
  assert_true(linear_solve(size, matrix, 1, right));
  for (int row = 0; row < size; ++row) v->row[row % rows][particles->place_of[row / rows]] = right[row];
  vector_destroy(moved);
  free(matrix), free(right);
}

static void assert_same_answer(const Problem *p, const Vector *wanted, double tolerance, const char *name)
{
  double most = 0, off = 0;
  for (int k = 0; k < p->domain->particles->space.rows; ++k)
    for (int64_t i = 0; i < p->domain->particles->places; ++i) {
      most = larger_of(most, fabs(wanted->row[k][i]));
      off = larger_of(off, fabs(wanted->row[k][i] - p->v->row[k][i]));
    }
  if (!(off <= tolerance * most) || !(most > 0)) fail_msg("%s: off by %g of %g", name, off, most);
}

static void answers_are_those_of_a_dense_solution(void **state)
{
  (void)state;
  static const int ways[] = {LINEAR_gradients, LINEAR_residuals, LINEAR_direct};
  for (int c = 0; c < CASES; ++c)
    for (int way = 0; way < 3; ++way) {
      if (under_sanitizers() && (c + way) % 3) continue;
      Problem p = pose(model_of(UNITS "%s" END, cases[c].deck), way == 1 ? 3e3 : 0);
      char name[100];
      Vector wanted[1] = {{0}};
      snprintf(name, sizeof name, "%s by %s", cases[c].name, linear_word(ways[way]));
      assert_true(vector_create(wanted, &p.domain->particles->space, "test", NULL));
      solve_densely(&p, wanted);
      begin(&p, ways[way]);
      const LinearRecord record = solve(&p, 1e-12);
      if (!(record.residual <= 1e-12)) fail_msg("%s: residual %g", name, record.residual);
      assert_false(record.indefinite);
      assert_false(record.unsuited);
      assert_same_answer(&p, wanted, 1e-9, name);
      vector_destroy(wanted);
      forget(&p);
    }
}

/** Else conjugate gradients do not come to the solution. */
static void the_preconditioner_is_symmetric_and_positive(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    Problem p = pose(model_of(UNITS "%s" END, cases[c].deck), 0);
    Preconditioner m = {0};
    Vector x[1] = {{0}}, y[1] = {{0}}, mx[1] = {{0}}, my[1] = {{0}};
    const Particles *q = p.domain->particles;
    assert_true(vector_create(x, &q->space, "test", NULL) && vector_create(y, &q->space, "test", NULL));
    assert_true(vector_create(mx, &q->space, "test", NULL) && vector_create(my, &q->space, "test", NULL));
    assert_int_equal(preconditioner_create(&m, p.domain, false, NULL), 0);
    assert_int_equal(preconditioner_prepare(&m, &p.solver, x, y, NULL), 0);
    assert_true(m.is_symmetric);
    for (uint64_t seed = 1; seed < 6; ++seed) {
      fill_randomly(p.domain->particles, x, 1, seed);
      fill_randomly(p.domain->particles, y, 1, 100 + seed);
      unknowns_clear_rest(&p.solver.unknowns, x);
      unknowns_clear_rest(&p.solver.unknowns, y);
      preconditioner_apply(&m, &p.solver, x, mx);
      preconditioner_apply(&m, &p.solver, y, my);
      const double size = sqrt(vector_inner(x, mx, 1) * vector_inner(y, my, 1));
      assert_true(vector_inner(x, mx, 1) > 0);
      assert_near(vector_inner(x, my, 1), vector_inner(y, mx, 1), 1e-12 * size);
    }
    preconditioner_destroy(&m);
    vector_destroy(x), vector_destroy(y), vector_destroy(mx), vector_destroy(my);
    forget(&p);
  }
}

static breccia_model *cube(const char *formulation, const char *material, int n, const char *more)
{
  return model_of(UNITS
                  "%speridynamics: {formulation: %s, space: 3-D}\nbody: {b: {material: m, spacing: 0.1, shape: {box: "
                  "{particles: [%d, %d, %d]}}}}\nloads: [{on: {face: x-, layers: 3}, displacement: [0, 0, 0]}]\n%s" END,
                  material, formulation, n, n, n, more);
}

/** The diagonal that random signs tell is that of the stiffness, in the whole of a body of many batches: up to what stands beside it, which averages out. */
static void random_signs_tell_the_diagonal(void **state)
{
  (void)state;
  Problem p = pose(cube("correspondence", ELASTIC, 12, ""), 0);
  Preconditioner m = {0};
  Vector v[1] = {{0}}, kv[1] = {{0}};
  double told[2] = {0}, found[2] = {0};
  const int64_t places = p.domain->particles->places;
  assert_true(p.domain->batch_count > 4);
  assert_true(vector_create(v, &p.domain->particles->space, "test", NULL) &&
              vector_create(kv, &p.domain->particles->space, "test", NULL));
  assert_int_equal(preconditioner_create(&m, p.domain, false, NULL), 0);
  assert_int_equal(preconditioner_prepare(&m, &p.solver, v, kv, NULL), 0);
  for (int64_t i = 0; i < places; i += 17) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      vector_clear(v);
      v->row[k][i] = 1;
      unknowns_clear_rest(&p.solver.unknowns, v);
      if (v->row[k][i] != 1) continue; /* it is held */
      linear_solver_apply(&p.solver, v, kv);
      sum += kv->row[k][i] / 3;
    }
    if (sum == 0) continue;
    told[i > places / 2] += m.diagonal[i];
    found[i > places / 2] += sum;
  }
  for (int half = 0; half < 2; ++half) {
    print_message("diagonal %g by signs, %g by products\n", told[half], found[half]);
    assert_true(found[half] > 0);
    assert_near(told[half] / found[half], 1, 0.2);
  }
  preconditioner_destroy(&m);
  vector_destroy(v), vector_destroy(kv);
  forget(&p);
}

/** Pulled and bent at the far face, so that the whole body answers. */
static void load_far_face(Problem *p, int n)
{
  const Particles *q = p->domain->particles;
  for (int64_t at = 0; at < q->count; ++at) {
    const int32_t i = q->place_of[at];
    for (int k = 0; k < 3; ++k) p->f->row[k][i] = q->position[0][i] > 0.1 * (n - 3) ? (k == 0) + 0.3 * (k == 1) : 0;
  }
}

/** The diagonal alone takes twice as many for a body twice as long: 159 and 310 of ordinary bonds, say. */
static void the_number_of_products_does_not_grow_with_the_body(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *material;
    int n;
  } of[] = {{"correspondence", ELASTIC, 12},
            {"bond-based", SPRINGS, 12},
            {"ordinary", ELASTIC, 9},
            {"micropolar", LINKS, 10}};
  for (int c = whole_walks() ? 0 : 1; c < 4; c += under_sanitizers() ? 3 : whole_walks() ? 1 : 2) {
    int64_t products[2];
    for (int twice = 0; twice < 2; ++twice) {
      const int n = of[c].n << twice;
      Problem p = pose(cube(of[c].formulation, of[c].material, n, ""), 0);
      load_far_face(&p, n);
      begin(&p, LINEAR_gradients);
      const LinearRecord record = solve(&p, 1e-8);
      assert_true(record.residual <= 1e-8);
      products[twice] = record.iterations;
      forget(&p);
    }
    print_message("%s: %lld products, of a body twice as long %lld\n", of[c].formulation, (long long)products[0],
                  (long long)products[1]);
    assert_true(products[1] <= 40);
    assert_true((double)products[1] <= 1.3 * (double)products[0]);
  }
}

#define PLANE(more)                                                                                                    \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, " more "}}\n"                                \
  "peridynamics: {formulation: ordinary, space: plane strain}\n"
#define SPACE(more)                                                                                                    \
  "body: {b: {material: m, spacing: 0.1, " more "}}\nperidynamics: {formulation: correspondence, space: 3-D}\n"

/** What a body of each kind takes, by the preconditioner as it is: the lattice, the way in which it is held, masses and damping, holes, stiff parts beside
 *  soft ones. Counts vary by one or two with roundings. */
static void no_kind_of_body_takes_more_products_than_it_did(void **state)
{
  (void)state;
  static const struct {
    const char *name, *deck;
    double mass, share; /* of masses and damping beside the stiffness */
    int64_t products;
  } of[] = {
      {"a long plate", ELASTIC PLANE("shape: {box: {particles: [60, 12]}}") "loads: [" HOLD "]\n", 0, 0, 37},
      {"a damped plate with mass", ELASTIC PLANE("shape: {box: {particles: [60, 12]}}") "loads: [" HOLD "]\n", 200, 3,
       35},
      {"a long plate with mass", ELASTIC PLANE("shape: {box: {particles: [60, 12]}}") "loads: [" HOLD "]\n", 20, 0, 35},
      {"a free plate with mass", ELASTIC PLANE("shape: {box: {particles: [40, 20]}}"), 50, 0, 26},
      {"a quarter of a plate",
       ELASTIC PLANE("shape: {box: {particles: [40, 20]}}") "loads: [{on: {face: x-}, support: {held: across}}, {on: "
                                                            "{face: y-}, support: {held: across}}]\n",
       0, 0, 26},
      {"a plate on a wall",
       ELASTIC PLANE("shape: {box: {particles: [40, 20]}}") "loads: [{on: {face: x-}, support: {held: all}}]\n", 0, 0,
       30},
      {"a plate on rollers askew",
       ELASTIC PLANE(
           "shape: {box: {particles: [40, 20]}}") "loads: [{on: {face: x-, layers: 2}, roller: [1, 0.5]}, {on: "
                                                  "{nearest: [3.95, 0.05]}, roller: [0, 1]}]\n",
       0, 0, 42},
      {"a plate on springs",
       ELASTIC PLANE("shape: {box: {particles: [40, 20]}}") "loads: [{on: {face: y-}, spring: {stiffness: 2e3}}]\n", 0,
       0, 29},
      {"an angle",
       ELASTIC PLANE(
           "shape: {polygon: {corners: [[0, 0], [4, 0], [4, 0.8], [0.8, 0.8], [0.8, 4], [0, 4]]}}") "loads: [" HOLD
                                                                                                    "]\n",
       0, 0, 37},
      {"hexagons",
       ELASTIC
       "body: {b: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.2, shape: {box: {from: [0, 0], to: "
       "[5, 1.5]}}}}\nperidynamics: {formulation: ordinary, space: plane stress}\nloads: [" HOLD "]\n",
       0, 0, 33},
      {"a large plate", ELASTIC PLANE("shape: {box: {particles: [200, 150]}}") "loads: [" HOLD "]\n", 0, 0, 47},
      {"a beam in space", ELASTIC SPACE("shape: {box: {particles: [30, 5, 8]}}") "loads: [" HOLD "]\n", 0, 0, 49},
      {"a beam of two materials",
       TWO "body: {a: {material: n, spacing: 0.1, shape: {box: {particles: [8, 6, 6]}}},\n"
           "       b: {material: m, spacing: 0.1, shape: {box: {from: [0.8, 0, 0], to: [2.4, 0.6, 0.6]}}}}\n"
           "peridynamics: {formulation: correspondence, space: 3-D}\nloads: [" HOLD "]\n",
       0, 0, 59},
      {"a rod",
       SPRINGS "body: {b: {material: m, lattice: line, area: 0.5, spacing: 0.1, shape: {box: {particles: [400, 1]}}}}\n"
               "peridynamics: {formulation: bond-based, space: 1-D}\n"
               "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}]\n",
       0, 0, 22},
  };
  int wrong = 0;
  for (size_t c = 0; c < sizeof of / sizeof *of; ++c) {
    if (under_sanitizers() && c % 4) continue;
    if (!strcmp(of[c].name, "a large plate") && !whole_walks()) continue;
    Problem p = pose(model_of(UNITS "%s" END, of[c].deck), of[c].mass);
    const Particles *q = p.domain->particles;
    p.solver.stiffness_share = of[c].share;
    for (int64_t n = 0; n < q->count; ++n) { /* bent, and pulled more at the far end */
      const int32_t i = q->place_of[n];
      const double along = q->position[0][i] / q->position[0][q->place_of[q->count - 1]];
      for (int k = 0; k < p.domain->body.dimensions; ++k)
        p.f->row[k][i] = k == 0 ? along * along : k == 1 ? 0.3 : -0.2 * along;
    }
    unknowns_gather(&p.solver.unknowns, p.f);
    begin(&p, strstr(of[c].deck, "held: all") ? LINEAR_residuals : LINEAR_gradients);
    const LinearRecord record = solve(&p, 1e-8);
    assert_true(record.residual <= 1e-8);
    if (llabs(record.iterations - of[c].products) > 2) {
      print_error("%s: %lld products, and not %lld\n", of[c].name, (long long)record.iterations,
                  (long long)of[c].products);
      ++wrong;
    }
    forget(&p);
  }
  assert_int_equal(wrong, 0);
}

static void answers_have_the_same_bits_for_any_number_of_threads(void **state)
{
  (void)state;
  static const int ways[] = {LINEAR_gradients, LINEAR_residuals};
  for (int way = 0; way < 2; ++way) {
    Problem p = pose(cube("correspondence", ELASTIC, 12, ""), 0);
    const size_t bytes = sizeof(double) * (size_t)p.domain->particles->places;
    Vector first[1] = {{0}};
    assert_true(vector_create(first, &p.domain->particles->space, "test", NULL));
    for (int threads = 1; threads <= 3; ++threads) {
      Team *team = team_create(threads, NULL), *before = team_use(team);
      begin(&p, ways[way]);
      solve(&p, 1e-8);
      for (int k = 0; k < 3; ++k) {
        if (threads == 1) memcpy(first->row[k], p.v->row[k], bytes);
        assert_memory_equal(first->row[k], p.v->row[k], bytes);
      }
      p.solver.type->destroy(&p.solver);
      p.solver.type = NULL;
      p.solver.own = NULL;
      team_use(before);
      team_destroy(&team);
    }
    vector_destroy(first);
    forget(&p);
  }
}

/** A cut that all but parts the body, and a particle without bonds. */
static void broken_bodies_are_solved(void **state)
{
  (void)state;
  Problem p = pose(cube("correspondence", ELASTIC, 10, ""), 0);
  Domain *d = p.domain;
  const int32_t lost = d->particles->place_of[d->particles->count - 1];
  for (int64_t s = 0; s < d->particles->slices; ++s)
    for (int64_t slot = d->family.first[s]; slot < d->family.first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        const int32_t a = (int32_t)(s * SLICE + lane);
        if (!(d->family.intact[slot] >> lane & 1)) continue;
        const int32_t b = family_bond(&d->family, s, slot, lane).neighbour;
        const double *x = d->particles->position[0], *y = d->particles->position[1];
        if (a == lost || b == lost || ((x[a] - 0.55) * (x[b] - 0.55) < 0 && fmax(y[a], y[b]) < 0.7))
          family_break(&d->family, a, b);
      }
  for (int64_t s = 0; s < d->particles->slices; ++s)
    if (d->regions->type->renew) d->regions->type->renew(d->regions->formulation, s);
  assert_int_equal(domain_linearise(d, NULL, NULL), 0);
  load_far_face(&p, 10);
  for (int k = 0; k < 3; ++k) p.f->row[k][lost] = 0;
  begin(&p, LINEAR_gradients);
  const LinearRecord record = solve(&p, 1e-8);
  assert_true(record.residual <= 1e-8);
  assert_false(record.indefinite);
  assert_true(record.iterations <= 80);
  for (int k = 0; k < 3; ++k) assert_near(p.v->row[k][lost], 0, 0);
  forget(&p);
}

#define SOFTENING                                                                                                      \
  "materials: {m: {model: bilinear-softening, density: 2, Young modulus: 1e4, tensile strength: 1, fracture energy: "  \
  "1e-3}}\n"
#define FLOWING                                                                                                        \
  "materials: {m: {model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.2, cohesion: 1, friction "  \
  "angle: 35, dilation angle: 0, "                                                                                     \
  "hardening modulus: 500}}\n"

/** Sheared and pressed by `even`; opened by `opening` across the middle; with some unevenness. */
static void strain(const Problem *p, double even, double opening)
{
  const Particles *q = p->domain->particles;
  fill_randomly(q, &q->displacement, 1e-5 * (even + opening), 9);
  for (int64_t n = 0; n < q->count; ++n) {
    const int32_t i = q->place_of[n];
    const double x = q->position[0][i], y = q->position[1][i];
    q->displacement.row[0][i] += even * (x + y) + (x > 0.4 ? opening : 0);
  }
  assert_int_equal(domain_linearise(p->domain, NULL, NULL), 0);
}

/** Plastic flow without dilation makes tangents that are not symmetric, softening such that are not definite: conjugate gradients say so, and what is
 *  taken by itself solves both. */
static void the_way_follows_the_stiffness(void **state)
{
  (void)state;
  static const struct {
    const char *name, *formulation, *material;
    double even, opening;
    bool indefinite;
  } of[] = {{"flow", "correspondence", FLOWING, -1e-3, 0, false},
            {"softening", "bond-based", SOFTENING, 0, 5e-5, true}};
  for (int c = 0; c < 2; ++c) {
    Problem p = pose(cube(of[c].formulation, of[c].material, 8, ""), 0);
    strain(&p, of[c].even, of[c].opening);
    begin(&p, LINEAR_gradients);
    LinearRecord record = solve(&p, 1e-8);
    if (!record.unsuited) fail_msg("%s: conjugate gradients do not notice", of[c].name);
    assert_int_equal(record.indefinite, of[c].indefinite);
    p.solver.is_free = true; /* as where the deck does not say */
    record = solve(&p, 1e-8);
    assert_string_equal(linear_solver_name(&p.solver), "minimal residuals");
    print_message("%s: %lld products, residual %g\n", of[c].name, (long long)record.iterations, record.residual);
    assert_true(record.residual <= 1e-8);
    assert_int_equal(record.indefinite, of[c].indefinite);
    vector_copy(p.kv, p.v);
    Vector check[1] = {{0}};
    assert_true(vector_create(check, &p.domain->particles->space, "test", NULL));
    linear_solver_apply(&p.solver, p.kv, check);
    vector_combine(1, check, -1, p.f);
    assert_true(vector_inner(check, check, 1) <= 1.01e-16 * vector_inner(p.f, p.f, 1));
    vector_destroy(check);
    forget(&p);
  }
}

/** Of this process; 0 where the system does not tell. */
static int count_threads(void)
{
  DIR *folder = opendir("/proc/self/task");
  int count = 0;
  while (folder && readdir(folder)) ++count;
  if (folder) closedir(folder);
  return count;
}

static breccia_model *plate(int n)
{
  return model_of(UNITS ELASTIC
                  "peridynamics: {formulation: correspondence, space: plane strain}\nbody: {b: {material: m, lattice: "
                  "square, spacing: 0.1, thickness: 1, shape: {box: {particles: [%d, %d]}}}}\nloads: [" HOLD "]\n" END,
                  n, n);
}

/** Far up in the spectrum of vibrations minimal residuals lead nowhere; factors do not mind. */
static void factors_are_the_last_resort(void **state)
{
  (void)state;
  Problem p = pose(plate(24), 0);
  p.solver.mass_factor = -2e5;
  begin(&p, LINEAR_residuals);
  LinearRecord record = solve(&p, 1e-8);
  print_message("minimal residuals: %lld products leave %g\n", (long long)record.iterations, record.residual);
  assert_true(record.residual > 0.01);
  assert_true(record.unsuited);
  p.solver.is_free = true; /* as where the deck does not say */
  record = solve(&p, 1e-8);
  assert_string_equal(linear_solver_name(&p.solver), "direct");
  assert_true(record.residual <= 1e-8);
  assert_false(record.unsuited);
  forget(&p);
}

/** Where one solution took hundreds of products, factors of a body that is still small take over with the equations to come. */
static void tedious_equations_go_to_factors(void **state)
{
  (void)state;
  Problem p = pose(plate(24), 0);
  p.solver.mass_factor = -3.75e4; /* of larger factors round-off decides whether they find the solution */
  begin(&p, LINEAR_AUTOMATIC);
  LinearRecord record = solve(&p, 1e-8);
  print_message("minimal residuals: %lld products leave %g\n", (long long)record.iterations, record.residual);
  assert_string_equal(linear_solver_name(&p.solver), "minimal residuals");
  assert_true(record.iterations > 500);
  assert_true(record.residual <= 1e-8);
  record = solve(&p, 1e-8);
  assert_string_equal(linear_solver_name(&p.solver), "direct");
  assert_true(record.residual <= 1e-8);
  forget(&p);
}

/** Threads of libraries stand in the way of ours. */
static void factors_start_no_threads(void **state)
{
  (void)state;
  Problem p = pose(plate(40), 0);
  const int before = count_threads();
  begin(&p, LINEAR_direct);
  solve(&p, 1e-8);
  assert_int_equal(count_threads(), before);
  forget(&p);
}

/** What is told before, beside what is taken then. */
static void memory_of_factors_is_foreseen(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *material, *space, *shape;
  } of[] = {
      {"bond-based", SPRINGS, "plane strain", "lattice: square, thickness: 1, shape: {box: {particles: [60, 50]}}"},
      {"ordinary", ELASTIC, "plane strain", "lattice: square, thickness: 1, shape: {box: {particles: [40, 40]}}"},
      {"correspondence", ELASTIC, "plane strain", "lattice: square, thickness: 1, shape: {box: {particles: [60, 20]}}"},
      {"bond-based", SPRINGS, "3-D", "shape: {box: {particles: [9, 9, 9]}}"},
      {"correspondence", ELASTIC, "3-D", "shape: {box: {particles: [7, 7, 7]}}"}};
  for (size_t c = 0; c < sizeof of / sizeof *of; ++c) {
    Problem p = pose(model_of(UNITS "%speridynamics: {formulation: %s, space: %s}\nbody: {b: {material: m, spacing: "
                                    "0.1, %s}}\nloads: [" HOLD "]\n" END,
                              of[c].material, of[c].formulation, of[c].space, of[c].shape),
                     0);
    assert_int_equal(linear_solver_create(&p.solver, LINEAR_direct, NULL), 0);
    const double told = linear_solver_foresee(&p.solver).bytes;
    assert_int_equal(linear_solver_prepare(&p.solver, NULL), 0);
    const double taken = (double)p.solver.type->bytes(&p.solver);
    print_message("%s, %s: %.3g bytes, told %.3g\n", of[c].formulation, of[c].space, taken, told);
    assert_true(told < 2 * taken && taken < 2 * told);
    forget(&p);
  }
}

/** Displacements as the matrix makes them of its unknowns are those that loads allow, and each product with the matrix is one with the stiffness. */
static void the_matrix_is_the_stiffness(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    Problem p = pose(model_of(UNITS "%s" END, cases[c].deck), 10);
    Matrix m = {0};
    double *const *u = p.domain->particles->displacement.row;
    fill_randomly(p.domain->particles, &p.domain->particles->displacement, 1e-3, 5);
    for (int k = 0; k < 3; ++k) /* nothing leads out of a plane */
      if (p.solver.unknowns.flat[k]) memset(u[k], 0, sizeof(double) * (size_t)p.domain->particles->places);
    assert_int_equal(domain_linearise(p.domain, NULL, NULL), 0);
    assert_int_equal(matrix_create(&m, &p.solver.unknowns, NULL), 0);
    assert_int_equal(matrix_fill(&m, &p.solver.unknowns, 0, 10, NULL), 0);
    assert_int_equal(m.size, unknowns_count(&p.solver.unknowns, NULL));
    double *x = calloc((size_t)m.size, sizeof *x), *kx = calloc((size_t)m.size, sizeof *kx), most = 0, off = 0;
    uint64_t seed = 7;
    for (int64_t n = 0; n < m.size; ++n) x[n] = random_uniform(&seed) - 0.5;
    matrix_unpack(&m, &p.solver.unknowns, x, p.v);
    linear_solver_apply(&p.solver, p.v, p.kv);
    matrix_pack(&m, &p.solver.unknowns, p.kv, kx);
    for (int64_t row = 0; row < m.size; ++row) {
      double sum = 0;
      for (int64_t t = m.first[row]; t < m.first[row + 1]; ++t) sum += m.value[t] * x[m.column[t]];
      most = larger_of(most, fabs(sum));
      off = larger_of(off, fabs(sum - kx[row]));
    }
    if (!(off <= 1e-11 * most)) fail_msg("%s: off by %g of %g", cases[c].name, off, most);
    matrix_destroy(&m);
    free(x), free(kx);
    forget(&p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(factors_start_no_threads), /* first: where they do those of others may be there already */
      cmocka_unit_test(answers_are_those_of_a_dense_solution),
      cmocka_unit_test(the_preconditioner_is_symmetric_and_positive),
      cmocka_unit_test(random_signs_tell_the_diagonal),
      cmocka_unit_test(the_number_of_products_does_not_grow_with_the_body),
      cmocka_unit_test(no_kind_of_body_takes_more_products_than_it_did),
      cmocka_unit_test(answers_have_the_same_bits_for_any_number_of_threads),
      cmocka_unit_test(broken_bodies_are_solved),
      cmocka_unit_test(the_way_follows_the_stiffness),
      cmocka_unit_test(the_matrix_is_the_stiffness),
      cmocka_unit_test(factors_are_the_last_resort),
      cmocka_unit_test(tedious_equations_go_to_factors),
      cmocka_unit_test(memory_of_factors_is_foreseen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

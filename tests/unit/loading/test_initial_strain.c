/* Bodies that shrink and warm, against closed forms, and against the same strains by displacements. */
#include "support.h"

#include "base/random.h"
#include "base/tensor.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

typedef struct Case {
  const char *formulation, *law;
  double poisson[3]; /* in 3-D, plane strain, plane stress */
} Case;

#define ELASTIC "model: elastic, Poisson ratio: 0.2"
static const Case cases[] = {
    {"formulation: bond-based", "model: elastic-1d", {0.25, 0.25, 1.0 / 3}},
    {"formulation: ordinary", ELASTIC, {0.2, 0.2, 0.2}},
    {"formulation: correspondence", ELASTIC, {0.2, 0.2, 0.2}},
    {"formulation: hybrid", ELASTIC, {0.2, 0.2, 0.2}},
    {"formulation: micropolar", ELASTIC, {0.2, 0.2, 0.2}},
};
enum { CASES = sizeof cases / sizeof *cases, SPACES = 3, YOUNG = 10000 };
static const char *const spaces[] = {"3-D", "plane strain", "plane stress"};

/** A body of a case, with loads and a solver. */
static breccia_model *body_of(const Case *c, int space, const char *loads, const char *solve)
{
  const bool plane = space > 0;
  return model_of(UNITS "materials: {m: {%s, density: 2, Young modulus: 1e4}}\n"
                        "body: {b: {material: m, lattice: %s, spacing: 0.1%s, shape: {box: {particles: [%s]}}}}\n"
                        "peridynamics: {%s, space: %s, horizon: %s}\nloads: [%s]\nsolve: {%s}\npictures: []\n",
                  c->law, plane ? "square" : "cubic", plane ? ", thickness: 0.5" : "", plane ? "9, 8" : "6, 5, 6",
                  c->formulation, spaces[space],
                  strstr(c->formulation, "micropolar") ? "1.5 spacings" : "2.015 spacings", loads, solve);
}

/** What keeps a body from moving as a whole, and from nothing else. */
static const char *points_held(int space)
{
  return space ? "{on: {nearest: [0, 0]}, displacement: [0, 0]}, {on: {nearest: [9, 0]}, displacement: [free, 0]}"
               : "{on: {nearest: [0, 0, 0]}, displacement: [0, 0, 0]}, {on: {nearest: [9, 0, 0]}, displacement: [free, "
                 "0, 0]}, "
                 "{on: {nearest: [0, 9, 0]}, displacement: [free, free, 0]}";
}

static const char *all_held(int space)
{
  return space ? "{on: {all: yes}, displacement: [0, 0]}" : "{on: {all: yes}, displacement: [0, 0, 0]}";
}

#define AT_REST "static: {increments: 1, residual: 1e-12}"

/** Stress at a place, by the formulation. */
static void stress_at(const breccia_model *m, int64_t place, double stress[6])
{
  double strain[6];
  domain_look(&m->domain, place, strain, stress);
}

static double largest_stress(const breccia_model *m, int from, int to)
{
  double most = 0, stress[6];
  for (int32_t n = 0; n < m->domain.particles->count; ++n) {
    stress_at(m, m->domain.particles->place_of[n], stress);
    for (int k = from; k < to; ++k) most = larger_of(most, fabs(stress[k]));
  }
  return most;
}

/** The place in the middle. */
static int32_t middle(const breccia_model *m)
{
  double low[3], high[3], centre[3];
  particles_bounds(m->domain.particles, low, high);
  for (int k = 0; k < 3; ++k) centre[k] = (low[k] + high[k]) / 2;
  return particles_nearest(m->domain.particles, centre);
}

static void a_free_body_takes_it_without_stress(void **state)
{
  (void)state;
  const double shrinkage = -3e-4;
  for (int n = 0; n < CASES * SPACES; ++n) {
    const Case *c = &cases[n / SPACES];
    const int space = n % SPACES;
    char loads[500];
    snprintf(loads, sizeof loads, "%s, {initial strain: -3e-4}", points_held(space));
    breccia_model *m = body_of(c, space, loads, AT_REST);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    const double natural = space == 1 ? (1 + c->poisson[1]) * shrinkage : shrinkage;
    const int32_t corner = p->place_of[0];
    for (int32_t i = 0; i < p->count; ++i)
      for (int k = 0; k < m->domain.body.dimensions; ++k)
        assert_near(p->displacement.row[k][p->place_of[i]],
                    natural * (p->position[k][p->place_of[i]] - p->position[k][corner]),
                    /* Green's strain of the formulations of small strains in space; of finite ones lengths are exact */
                    2 * natural * natural + 1e-9 * fabs(natural));
    assert_true(largest_stress(m, 0, space ? 2 : 3) < 1e-9 * YOUNG * 3e-4);
    assert_true(largest_stress(m, 3, 6) < 1e-9 * YOUNG * 3e-4);
    double stress[6];
    stress_at(m, middle(m), stress);
    /* what cannot go across the plane */
    if (space == 1 && strstr(c->law, "Poisson") && !strstr(c->formulation, "micropolar"))
      assert_near(stress[ZZ], -YOUNG * shrinkage, 2e-3 * YOUNG * 3e-4);
    breccia_model_destroy(&m);
  }
}

/** A free body of two materials, in one formulation or in two, takes an initial strain without stress. In plane strain,
 *  where the strain in the plane depends on Poisson's ratio, both materials have the same ratio. */
static void a_free_body_of_two_materials_takes_it_without_stress(void **state)
{
  (void)state;
  const double swelling = 4e-4;
  for (int n = 0; n < 2 * CASES * SPACES; ++n) {
    const Case *c = &cases[n / 2 / SPACES];
    const int space = n / 2 % SPACES, plane = space > 0, bonds = c == cases;
    char second[128], regions[128] = "", loads[500];
    snprintf(second, sizeof second, "model: elastic, Poisson ratio: %g", space == 1 ? 0.2 : 0.1);
    if (bonds) snprintf(second, sizeof second, "%s", c->law);
    if (n % 2)
      snprintf(regions, sizeof regions, ", regions: {far: {blocks: [b], formulation: %s}}",
               bonds                                ? "bond-based"
               : strstr(c->formulation, "ordinary") ? "hybrid"
                                                    : "ordinary");
    snprintf(loads, sizeof loads, "%s, {initial strain: 4e-4}", points_held(space));
    breccia_model *m = model_of(
        UNITS "materials:\n  m: {%s, density: 2, Young modulus: 1e4}\n  n: {%s, density: 3, Young modulus: 2.3e4}\n"
              "body:\n  a: {material: m, lattice: %s, spacing: 0.1%s, shape: {box: {particles: [%s]}}}\n"
              "  b: {material: n, lattice: %s, spacing: 0.1%s, shape: {box: {particles: [%s], first particle: %s}}}\n"
              "peridynamics: {%s, space: %s, horizon: %s%s}\nloads: [%s]\nsolve: {" AT_REST "}\npictures: []\n",
        c->law, second, plane ? "square" : "cubic", plane ? ", thickness: 0.3" : "", plane ? "5, 7" : "4, 5, 4",
        plane ? "square" : "cubic", plane ? ", thickness: 0.3" : "", plane ? "4, 7" : "4, 5, 4",
        plane ? "[0.55, 0.05]" : "[0.45, 0.05, 0.05]", c->formulation, spaces[space],
        strstr(c->formulation, "micropolar") ? "1.5 spacings" : "2.015 spacings", regions, loads);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    const double natural = space == 1 ? (1 + c->poisson[1]) * swelling : swelling;
    const int32_t corner = p->place_of[0];
    for (int32_t i = 0; i < p->count; ++i)
      for (int k = 0; k < m->domain.body.dimensions; ++k)
        assert_near(p->displacement.row[k][p->place_of[i]],
                    natural * (p->position[k][p->place_of[i]] - p->position[k][corner]),
                    2 * natural * natural + 1e-9 * fabs(natural));
    /* Two formulations measure strains of second order differently. */
    const double stress = YOUNG * (n % 2 ? 2 * natural * natural : 1e-9 * natural);
    assert_true(largest_stress(m, 0, space ? 2 : 3) < stress);
    assert_true(largest_stress(m, 3, 6) < stress);
    breccia_model_destroy(&m);
  }
}

/** Forces of a held plate that is warm in one half are mirrored where the other half is. */
static void either_half_may_be_warm(void **state)
{
  (void)state;
  for (int n = 0; n < CASES; ++n) {
    breccia_model *sides[2];
    for (int right = 0; right < 2; ++right) {
      char loads[300];
      snprintf(loads, sizeof loads, "%s, {on: {inside: {box: {from: [%g, -1], to: [%g, 9]}}}, initial strain: 2e-3}",
               all_held(1), right ? 0.45 : -1, right ? 9 : 0.45);
      sides[right] = model_of(
          UNITS
          "materials: {m: {%s, density: 2, Young modulus: 1e4}}\n"
          "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: {particles: [10, 6], "
          "first particle: [0, 0]}}}}\n"
          "peridynamics: {%s, space: plane strain, horizon: %s}\nloads: [%s]\nsolve: {explicit: {steps: 1}}\n",
          cases[n].law, cases[n].formulation,
          strstr(cases[n].formulation, "micropolar") ? "1.5 spacings" : "2.015 spacings", loads);
      step_surely(sides[right], 1);
    }
    const Particles *p = sides[0]->domain.particles, *q = sides[1]->domain.particles;
    double largest = 0;
    for (int64_t k = 0; k < p->count; ++k) largest = larger_of(largest, fabs(p->internal.row[0][p->place_of[k]]));
    assert_true(largest > 1);
    for (int64_t k = 0; k < p->count; ++k) {
      const int32_t i = p->place_of[k],
                    j = particles_nearest(q, (double[]){0.9 - p->position[0][i], p->position[1][i], 0});
      assert_near(p->internal.row[0][i], -q->internal.row[0][j], 1e-9 * largest);
      assert_near(p->internal.row[1][i], q->internal.row[1][j], 1e-9 * largest);
    }
    for (int right = 0; right < 2; ++right) breccia_model_destroy(&sides[right]);
  }
}

static void a_held_body_carries_what_the_closed_form_says(void **state)
{
  (void)state;
  for (int n = 0; n < CASES * SPACES; ++n) {
    const Case *c = &cases[n / SPACES];
    const int space = n % SPACES;
    const double nu = c->poisson[space], warming = 2e-4;
    char loads[300];
    snprintf(loads, sizeof loads, "%s, {initial strain: 2e-4, history: {ramp to: 1}}", all_held(space));
    breccia_model *m = body_of(c, space, loads, "static: {increments: 2, end time: 1}");
    step_surely(m, INT64_MAX);
    double stress[6];
    stress_at(m, middle(m), stress);
    const double wanted = -YOUNG * warming / (space == 2 ? 1 - nu : 1 - 2 * nu);
    for (int k = 0; k < (space ? 2 : 3); ++k) assert_near(stress[k], wanted, 1e-3 * fabs(wanted));
    /* all that is stored was put in by the strain */
    const Energy e = solver_energy(&m->solver);
    const double volume = sums_of(m).volume;
    assert_near(e.external, e.stored, 1e-6 * e.stored);
    assert_true(e.stored > 0.5 * volume * fabs(wanted) * warming);
    assert_balanced(m, 1e-6);
    breccia_model_destroy(&m);
  }
}

static void a_bar_held_at_both_ends_pulls_with_e_times_its_shrinkage(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
      "body: {b: {material: m, lattice: line, spacing: 0.1, area: 0.3, shape: {box: {particles: [20, 1]}}}}\n"
      "peridynamics: {space: 1-D, formulation: bond-based, horizon: 1.015 spacings}\n"
      "loads: [{name: left, on: {face: x-}, displacement: [0, 0]}, {on: {face: x+}, displacement: [0, 0]}, {initial "
      "strain: -1e-4}]\n"
      "solve: {static: {increments: 1}}\npictures: []\n");
  step_surely(m, INT64_MAX);
  double stress[6];
  stress_at(m, middle(m), stress);
  assert_near(stress[XX], YOUNG * 1e-4, 1e-6 * YOUNG * 1e-4);
  assert_balanced(m, 1e-9);
  breccia_model_destroy(&m);
}

static const Case bent_laws[] = {
    {"formulation: bond-based", "model: steel-bilinear, yield stress: 2, hardening ratio: 0.1", {0}},
    {"formulation: bond-based", "model: bilinear-softening, tensile strength: 3, fracture energy: 2e-3", {0}},
    {"formulation: ordinary", "model: j2, Poisson ratio: 0.2, yield stress: 2", {0}},
    {"formulation: ordinary", "model: viscoelastic, Poisson ratio: 0.2, relaxing share: 0.5, relaxation time: 1", {0}},
    {"formulation: correspondence",
     "model: drucker-prager, Poisson ratio: 0.2, friction angle: 30 deg, cohesion: 1",
     {0}},
    {"formulation: hybrid", "model: drucker-prager, Poisson ratio: 0.2, friction angle: 30 deg, cohesion: 1", {0}},
    {"formulation: micropolar",
     "model: link-damage, Poisson ratio: 0.2, tensile stretch: 1e-4, tensile ductility: 50",
     {0}},
};

/** A body held in a strain of -e alike in all directions is strained as one that shrinks by e and does not move. */
static void laws_see_the_strain_without_it(void **state)
{
  (void)state;
  for (size_t n = 0; n < sizeof bent_laws / sizeof *bent_laws; ++n)
    for (int space = 0; space < 3; space += 2) {
      const Case *c = &bent_laws[n];
      char loads[2][400];
      snprintf(loads[0], sizeof loads[0], "%s, {initial strain: -6e-4, history: {table: [[0, 0], [1, 1], [2, 0.3]]}}",
               all_held(space));
      snprintf(loads[1], sizeof loads[1],
               "{on: {all: yes}, field: {displacement: ['6e-4*x', '6e-4*y'%s]}, history: {table: [[0, 0], [1, 1], [2, "
               "0.3]]}}",
               space ? "" : ", '6e-4*z'");
      double stress[2][6], size = 0;
      for (int way = 0; way < 2; ++way) {
        breccia_model *m = body_of(c, space, loads[way], "static: {increments: 10, end time: 2}");
        step_surely(m, INT64_MAX);
        stress_at(m, middle(m), stress[way]);
        assert_balanced(m, 0.02);
        breccia_model_destroy(&m);
      }
      for (int k = 0; k < 6; ++k) size = larger_of(size, fabs(stress[1][k]));
      assert_true(size > 0.1);
      for (int k = 0; k < 6; ++k) assert_near(stress[0][k], stress[1][k], 5e-3 * size);
    }
}

/** Changes of forces by tangents are those by differences. */
static void tangents_know_it(void **state)
{
  (void)state;
  for (int n = 0; n < CASES * SPACES; ++n) {
    char loads[300];
    snprintf(loads, sizeof loads, "%s, {initial strain: 5e-2}", points_held(n % SPACES));
    breccia_model *m = body_of(&cases[n / SPACES], n % SPACES, loads, AT_REST);
    Domain *d = &m->domain;
    Particles *p = d->particles;
    Vector v[1] = {{0}}, change[1] = {{0}}, force[2] = {{0}};
    uint64_t seed = 3;
    domain_tell_time(d, 0, 0);
    assert_true(vector_create(v, &p->space, "test", NULL) && vector_create(change, &p->space, "test", NULL));
    for (int side = 0; side < 2; ++side) assert_true(vector_create(&force[side], &p->space, "test", NULL));
    for (int k = 0; k < p->space.rows; ++k) {
      for (int32_t i = 0; i < p->count && (k < d->body.dimensions || k >= p->space.rotation); ++i) {
        p->displacement.row[k][p->place_of[i]] = 0.005 * (random_uniform(&seed) - 0.5);
        v->row[k][p->place_of[i]] = random_uniform(&seed) - 0.5;
      }
    }
    assert_int_equal(domain_linearise(d, NULL, NULL), 0);
    domain_linear_step(d, v, change);
    const double h = 1e-6;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < p->space.rows; ++k)
        for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] += (side ? -2 : 1) * h * v->row[k][i];
      domain_evaluate(d, NULL);
      vector_copy(&force[side], &p->internal);
    }
    double most = 0, off = 0;
    for (int k = 0; k < p->space.rows; ++k)
      for (int64_t i = 0; i < p->places; ++i) {
        most = larger_of(most, fabs(change->row[k][i]));
        off = larger_of(off, fabs(change->row[k][i] - (force[0].row[k][i] - force[1].row[k][i]) / (2 * h)));
      }
    assert_true(most > 0);
    assert_near(off / most, 0, 1e-6);
    vector_destroy(v);
    vector_destroy(change);
    for (int side = 0; side < 2; ++side) vector_destroy(&force[side]);
    breccia_model_destroy(&m);
  }
}

#define ONE_FACE                                                                                                       \
  "{on: {face: x-, layers: 2}, displacement: [0, 0]}, {name: dry, initial strain: -1e-3, history: {ramp to: 0.05}}"

/** One face is held, so that some of it becomes stress and some motion. */
static void its_work_is_in_the_books_of_every_solver(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 3, end time: 0.05}",
                                        "static: {increments: 2, end time: 0.05, method: relaxation, residual: 1e-6}",
                                        "implicit: {time step: 1 ms, end time: 0.1}", "explicit: {end time: 0.1}",
                                        "explicit: {end time: 0.1, damping: 20}"};
  for (int n = 0; n < CASES; ++n)
    for (size_t s = 0; s < sizeof solvers / sizeof *solvers; ++s) {
      breccia_model *m = body_of(&cases[n], 2, ONE_FACE, solvers[s]);
      step_surely(m, INT64_MAX);
      const Energy e = solver_energy(&m->solver);
      assert_true(e.stored > 0 && e.external > 0);
      assert_balanced(m, s < 2 ? 1e-4 : 2e-3);
      breccia_model_destroy(&m);
    }
}

/** It is there at once. */
static void a_sudden_one_is_in_the_books_too(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 1}", "implicit: {time step: 1 ms, end time: 0.1}",
                                        "explicit: {end time: 0.1}"};
  for (int n = 0; n < CASES; n += under_sanitizers() ? 2 : 1)
    for (size_t s = 0; s < sizeof solvers / sizeof *solvers; ++s) {
      breccia_model *m = body_of(
          &cases[n], 2, "{on: {face: x-, layers: 2}, displacement: [0, 0]}, {initial strain: -1e-3}", solvers[s]);
      step_surely(m, INT64_MAX);
      assert_true(solver_energy(&m->solver).external > 0);
      assert_balanced(m, s < 1 ? 1e-3 : 5e-3); /* of one increment, by the trapezium rule, to a strain of 1e-3 */
      breccia_model_destroy(&m);
    }
}

/** A body that shrinks faster and faster, held by one face where bonds break one after the other. */
static void its_work_is_in_the_books_where_bonds_break(void **state)
{
  (void)state;
  for (int n = 0; n < CASES; n += under_sanitizers() ? 2 : 1)
    for (int energy = 0; energy < 2; ++energy) {
      const Case *c = &cases[n];
      breccia_model *m =
          model_of(UNITS "materials: {m: {%s, density: 2, Young modulus: 1e4}}\n"
                         "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: "
                         "{particles: [16, 12]}}}}\n"
                         "peridynamics: {space: plane stress, %s, horizon: %s}\nfailure: {%s, near grips: break}\n"
                         "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0]}, {initial strain: -8e-3, history: "
                         "{table: [[0, 0], [0.1, 0.2], [0.25, 1]]}}]\n"
                         "solve: {explicit: {end time: 0.3, safety: 0.5}}\npictures: []\n",
                   c->law, c->formulation, strstr(c->formulation, "micropolar") ? "1.5 spacings" : "2.015 spacings",
                   energy ? "criterion: critical bond energy, fracture energy: 2e-3" : "critical stretch: 1.5e-3");
      step_surely(m, INT64_MAX);
      assert_true(m->domain.broken_count > 10);
      assert_balanced(m, 2e-3);
      breccia_model_destroy(&m);
    }
}

static const Case *under_way;
static const char *solver_under_way;

static breccia_model *with_threads(int threads)
{
  breccia_model *m = body_of(under_way, 2, ONE_FACE, solver_under_way);
  m->threads = threads;
  return m;
}

static void bits_do_not_depend_on_threads_or_restarts(void **state)
{
  (void)state;
  for (int n = 0; n < CASES; ++n) {
    under_way = &cases[n];
    solver_under_way = "explicit: {end time: 0.1}";
    assert_same_bits_by_threads_and_restart(with_threads, 7, 20);
    solver_under_way = "static: {increments: 6, end time: 0.1}";
    assert_same_bits_by_threads_and_restart(with_threads, 2, 4);
  }
}

static void it_comes_in_one_stage_and_goes_in_another(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: {particles: [9, 7]}}}}\n"
      "peridynamics: {space: plane stress, formulation: correspondence}\nloads: [%s]\n"
      "solve:\n  - {static: {increments: 1, end time: 1}}\n"
      "  - {static: {increments: 2, end time: 1}, loads: [{name: hot, initial strain: 1e-3, history: {ramp to: 1}}]}\n"
      "  - {static: {increments: 1, end time: 1}, without: [hot]}\npictures: []\n",
      points_held(2));
  const int32_t last = m->domain.particles->place_of[m->domain.particles->count - 1];
  const double wanted[] = {0, 0.5e-3, 1e-3, 0};
  for (int step = 0; step < 4; ++step) {
    step_surely(m, 1);
    assert_near(m->domain.particles->displacement.row[0][last], 0.8 * wanted[step], 2e-6);
  }
  breccia_model_destroy(&m);
}

/** Free bodies break nowhere, however hot; held ones break where they would shrink by more than bonds bear. */
static void bonds_break_by_the_stretch_without_it(void **state)
{
  (void)state;
  static const char *const criteria[] = {"failure: {critical stretch: 1e-3}",
                                         "failure: {criterion: critical bond energy, fracture energy: 1e-3}"};
  for (int held = 0; held < 2; ++held)
    for (int n = 0; n < 2 * CASES; n += under_sanitizers() ? 3 : 1) {
      const Case *c = &cases[n / 2];
      const bool micropolar = strstr(c->formulation, "micropolar") != NULL;
      breccia_model *m =
          model_of(UNITS "materials: {m: {%s, density: 2, Young modulus: 1e4}}\n"
                         "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: "
                         "{box: {particles: [12, 8]}}}}\n"
                         "peridynamics: {space: plane stress, %s, horizon: %s}\n%s\nloads: [%s, "
                         "{initial strain: %s, history: {ramp to: 0.2}}]\n"
                         "solve: {%s}\npictures: []\n",
                   c->law, c->formulation, micropolar ? "1.5 spacings" : "2.015 spacings", criteria[n % 2],
                   held ? all_held(2) : points_held(2), held ? "-2e-3" : "5e-3",
                   held ? "static: {increments: 4, end time: 0.2}" : "explicit: {end time: 0.3, local damping: 0.5}");
      step_surely(m, INT64_MAX);
      assert_true(held ? m->domain.broken_count > 100 : m->domain.broken_count == 0);
      breccia_model_destroy(&m);
    }
}

static void what_cannot_be_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *keys, *law, *load, *words;
  } wrong[] = {
      {"formulation: ordinary, space: plane strain", "model: j2, Poisson ratio: 0.2, yield stress: 2",
       "initial strain: 1e-3", "initial strain: with laws that yield or relax in plane strain|correspondence"},
      {"formulation: micropolar, kinematics: thesis, space: plane stress", ELASTIC, "initial strain: 1e-3",
       "initial strain: links of 'kinematics: thesis' take none"},
      {"formulation: correspondence, space: plane stress", ELASTIC, "initial strain: 1e-3, history: {controlled: yes}",
       "controlled: the factor of a load 'initial strain' or 'prestress' is not found"},
      {"formulation: correspondence, space: plane stress", ELASTIC, "prestress: {bars: [none], stress: 1}",
       "bars: there is no bar 'none'"},
      {"formulation: correspondence, space: plane stress", ELASTIC,
       "on: {all: yes}, prestress: {bars: [none], stress: 1}", "on: a prestress acts on the bars that it names"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1500];
    snprintf(
        deck, sizeof deck,
        UNITS
        "materials: {m: {%s, density: 2, Young modulus: 1e4}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: {particles: [9, 7]}}}}\n"
        "peridynamics: {%s}\nloads: [%s, {%s}]\nsolve: {static: {increments: 1}}\npictures: []\n",
        wrong[k].law, wrong[k].keys, points_held(2), wrong[k].load);
    char *words = refusal_of(deck);
    holds_words(words, wrong[k].words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_body_takes_it_without_stress),
      cmocka_unit_test(a_free_body_of_two_materials_takes_it_without_stress),
      cmocka_unit_test(either_half_may_be_warm),
      cmocka_unit_test(a_held_body_carries_what_the_closed_form_says),
      cmocka_unit_test(a_bar_held_at_both_ends_pulls_with_e_times_its_shrinkage),
      cmocka_unit_test(laws_see_the_strain_without_it),
      cmocka_unit_test(tangents_know_it),
      cmocka_unit_test(its_work_is_in_the_books_of_every_solver),
      cmocka_unit_test(a_sudden_one_is_in_the_books_too),
      cmocka_unit_test(its_work_is_in_the_books_where_bonds_break),
      cmocka_unit_test(bits_do_not_depend_on_threads_or_restarts),
      cmocka_unit_test(it_comes_in_one_stage_and_goes_in_another),
      cmocka_unit_test(bonds_break_by_the_stretch_without_it),
      cmocka_unit_test(what_cannot_be_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

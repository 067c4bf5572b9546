/* Bodies that begin under stress: what holds, springs, yields and is told then. */
#include "support.h"

#include "base/tensor.h"

static void run_all(breccia_model *model)
{
  step_surely(model, INT64_MAX);
}

static double largest_displacement(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double most = 0;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) most = larger_of(most, fabs(particles_moved(p, k, p->place_of[n])));
  return most;
}

/** Largest internal force per volume of a particle of the body itself. */
static double largest_force(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double most = 0;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k)
      if (!body_outside(&m->domain.body, n)) most = larger_of(most, fabs(p->internal.row[k][p->place_of[n]]));
  return most;
}

/** A body with the strains and stresses of its particles, which points on bonds must be asked for. */
static const Domain *observed(breccia_model *m)
{
  assert_int_equal(domain_observe(&m->domain, NULL), BRECCIA_OK);
  return &m->domain;
}

/** Fails unless each particle of the body has these stresses. */
static void assert_stress(breccia_model *m, const double stress[6], double tolerance)
{
  const Domain *d = observed(m);
  for (int64_t n = 0; n < d->particles->count; ++n)
    for (int k = 0; k < 6; ++k)
      if (!body_outside(&d->body, n)) assert_near(d->stress[k][d->particles->place_of[n]], stress[k], tolerance);
}

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define ELASTIC UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
#define CUBE "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [7, 6, 8]}}}}\n"
#define PLATE                                                                                                          \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.5, shape: {box: {particles: [9, 7]}}}}\n"
/* What keeps a body from moving as a whole, and from nothing else. */
#define THREE_POINTS                                                                                                   \
  "loads: [{on: {nearest: [0, 0, 0]}, displacement: [0, 0, 0]},"                                                       \
  " {on: {nearest: [9, 0, 0]}, displacement: [free, 0, 0]}, {on: {nearest: [0, 9, 0]}, displacement: [free, free, "    \
  "0]}]\n"
#define TWO_POINTS                                                                                                     \
  "loads: [{on: {nearest: [0, 0]}, displacement: [0, 0]}, {on: {nearest: [9, 0]}, displacement: [free, 0]}]\n"
#define AT_REST "solve: {static: {increments: 1, residual: 1e-12}}\n"

/* Formulations whose points are in space: on particles, on bonds, and on bonds that pull at their ends alone. */
static const char *const in_space[] = {"correspondence", "hybrid", "hybrid, form: pairwise"};

static void a_body_held_on_all_sides_keeps_any_stress(void **state)
{
  (void)state;
  const double stress[6] = {-300, -200, 150, 40, -30, 20};
  for (int k = 0; k < 4; ++k) {
    Text faces = {0};
    for (int n = 0; n < 6; ++n)
      text_add(&faces, "%s{on: {face: %c%c}, support: {held: all}}", n ? ", " : "", "xyz"[n / 2], "-+"[n % 2]);
    breccia_model *m =
        model_of(ELASTIC CUBE "peridynamics: {space: 3-D, strain: %s, formulation: %s}\n"
                              "initial stress: {stress: [-300, -200, 150, 40, -30, 20]}\nloads: [%s]\n" AT_REST,
                 k ? "green-lagrange" : "small", in_space[k ? k - 1 : 0], text_words(&faces));
    text_free(&faces);
    assert_non_null(strstr(breccia_model_overview(m), "336 particles begin under stress, mean -116.7 to -116.7 kPa"));
    assert_stress(m, stress, 1e-8);
    assert_true(largest_force(m) < 1e-7); /* of 300 kPa over 0.1 m */
    run_all(m);
    assert_true(largest_displacement(m) < 1e-13);
    assert_stress(m, stress, 1e-8);
    breccia_model_destroy(&m);
  }
}

/** Blocks of unlike stiffness begin under the same stress, each at the strain of its own compliance. */
static void unlike_blocks_begin_under_one_stress(void **state)
{
  (void)state;
  const double stress[6] = {-300, -200, 150, 40, -30, 20};
  breccia_model *m = model_of(
      UNITS
      "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\n"
      "  n: {model: elastic, density: 2, Young modulus: 4e4, Poisson ratio: 0.25}\n"
      "body:\n  up: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [0, 0, 0]}}}\n"
      "  down: {material: n, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [0, 0, -0.4]}}}\n"
      "initial stress: {stress: [-300, -200, 150, 40, -30, 20]}\nsolve: {explicit: {steps: 1}}\n");
  assert_stress(m, stress, 1e-8);
  const Domain *d = &m->domain;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int32_t i = d->particles->place_of[n];
    const double young = d->particles->position[2][i] > -0.05 ? 1e4 : 4e4;
    assert_near(d->initial_strain[XY][i], 40 / (young / 2.5), 1e-9);
  }
  breccia_model_destroy(&m);
}

static void a_face_that_slides_takes_pressure_and_no_shear(void **state)
{
  (void)state;
  for (int form = 0; form < 3; ++form) {
    breccia_model *m = model_of(
        ELASTIC CUBE "peridynamics: {space: 3-D, formulation: %s}\ninitial stress: {stress: [-300, 0, 0, 40, 0, 0]}\n"
                     "loads: [{on: {face: x-}, support: {held: across}}]\n"
                     "solve: {explicit: {steps: 1%s}}\n",
        in_space[form], form == 2 ? ", stiffness damping: 1e-4" : "");
    const Particles *p = m->domain.particles;
    double force[3] = {0};
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < 3; ++k) {
        const int32_t i = p->place_of[n];
        if (!body_outside(&m->domain.body, n)) force[k] += p->volume[i] * p->internal.row[k][i];
      }
    assert_near(force[0], 300 * 0.6 * 0.8, 1e-9);
    assert_near(force[1], 0, 1e-9);
    assert_near(force[2], 0, 1e-9);
    breccia_model_destroy(&m);
  }
}

/** Fails unless the particles have moved by a uniform strain from the one that is held, and the works and energies of that balance. */
static void assert_springs(breccia_model *m, const double strain[6], const double stress[6])
{
  const Particles *p = m->domain.particles;
  const int32_t held = particles_nearest(p, (const double[3]){0, 0, 0});
  run_all(m);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x[3];
    for (int k = 0; k < 3; ++k) x[k] = p->position[k][i] - p->position[k][held];
    const double u[3] = {
        strain[XX] * x[0] + strain[XY] * x[1] + strain[ZX] * x[2], strain[YY] * x[1] + strain[YZ] * x[2],
        strain[ZZ] * x[2]}; /* as three points hold it: shear leaves the planes of y and z where they are */
    for (int k = 0; k < m->domain.body.dimensions; ++k) assert_near(p->displacement.row[k][i], u[k], 1e-8);
  }
  assert_stress(m, stress, 1e-5);
  assert_balanced(m, 1e-5);
}

static void a_body_let_go_springs_by_its_compliance(void **state)
{
  (void)state;
  /* strain = -C^-1 stress; E = 1e4, nu = 1/4, G = 4000 */
  const double s[6] = {-30, -20, 15, 4, -3, 2}, zero[6] = {0};
  double strain[6], energy = 0;
  for (int k = 0; k < 6; ++k) {
    strain[k] = k < 3 ? -(1.25 * s[k] - 0.25 * (s[0] + s[1] + s[2])) / 1e4 : -s[k] / 4000;
    energy -= 0.5 * s[k] * strain[k] * 0.7 * 0.6 * 0.8;
  }
  for (int form = 0; form < 3; ++form) {
    breccia_model *m =
        model_of(ELASTIC CUBE "peridynamics: {space: 3-D, strain: small, formulation: %s}\n"
                              "initial stress: {stress: [-30, -20, 15, 4, -3, 2]}\n" THREE_POINTS AT_REST,
                 in_space[form]);
    assert_near(solver_energy(&m->solver).stored, energy, 1e-9 * energy);
    assert_springs(m, strain, zero);
    assert_true(solver_energy(&m->solver).stored < 1e-9 * energy);
    assert_near(solver_energy(&m->solver).damping, energy, 1e-5 * energy);
    breccia_model_destroy(&m);
  }
}

static void a_plane_body_springs_in_its_plane(void **state)
{
  (void)state;
  const double s[6] = {-30, -20, 0, 4, 0, 0}, shear = -4 / 4000.0, zero[6] = {0};
  const double in_stress[6] = {-(s[0] - 0.25 * s[1]) / 1e4, -(s[1] - 0.25 * s[0]) / 1e4, 0, shear, 0, 0};
  /* Across the plane -12 stays, and what contraction in the plane takes from it or adds: nu (0 - (xx + yy)). */
  const double nu = 0.25, a = (1 - nu * nu) / 1e4, b = nu * (1 + nu) / 1e4;
  const double in_strain[6] = {-(a * s[0] - b * s[1]), -(a * s[1] - b * s[0]), 0, shear, 0, 0},
               left[6] = {0, 0, -12 - nu * (s[0] + s[1]), 0, 0, 0};
  for (int form = 0; form < 3; ++form) {
    breccia_model *m = model_of(ELASTIC PLATE "peridynamics: {space: plane stress, strain: small, formulation: %s}\n"
                                              "initial stress: {stress: [-30, -20, 0, 4, 0, 0]}\n" TWO_POINTS AT_REST,
                                in_space[form]);
    assert_springs(m, in_stress, zero);
    const int32_t middle = particles_nearest(m->domain.particles, (const double[3]){0.45, 0.35, 0});
    assert_near(m->domain.strain[ZZ][middle], -nu * 50 / 1e4, 1e-9); /* from nu 50 / E across the plane to nothing */
    breccia_model_destroy(&m);
    m = model_of(ELASTIC PLATE "peridynamics: {space: plane strain, strain: small, formulation: %s}\n"
                               "initial stress: {stress: [-30, -20, -12, 4, 0, 0]}\n" TWO_POINTS AT_REST,
                 in_space[form]);
    assert_springs(m, in_strain, left);
    breccia_model_destroy(&m);
  }
}

static void a_body_let_go_in_motion_keeps_its_energy(void **state)
{
  (void)state;
  const double energy = 900 / (2 * 1e4 / 1.5) * 0.7 * 0.6 * 0.8; /* p^2 / (2 K) */
  for (int form = 0; form < 2; ++form) {
    breccia_model *m = model_of(
        ELASTIC CUBE "peridynamics: {space: 3-D, formulation: %s}\ninitial stress: {stress: [-30, -30, -30, 0, 0, 0]}\n"
                     "solve: {explicit: {steps: 400, safety: 0.3}}\n",
        in_space[form]);
    double most = 0;
    assert_near(solver_energy(&m->solver).stored, energy, 1e-3 * energy);
    for (int k = 0; k < 100; ++k) {
      step_surely(m, 4);
      most = larger_of(most, solver_energy(&m->solver).kinetic);
      assert_balanced(m, 1e-3);
    }
    assert_true(most > 0.3 * energy && most < energy);
    assert_near(solver_energy(&m->solver).external, 0, 1e-12);
    breccia_model_destroy(&m);
  }
}

/* ---- ground at rest ---- */

#define SIDES                                                                                                          \
  "{on: {face: x-}, support: {held: across}}, {on: {face: x+}, support: {held: across}}, {on: {face: y-}, support: "   \
  "{held: across}}"

static void ground_under_its_own_weight_stays_where_it_is(void **state)
{
  (void)state;
  /* K0 = 0.8, where an elastic column would have 1/3; gravity at once: rho g H^2 / (2 M), M = 12000 */
  static const struct {
    const char *formulation, *solve;
  } ways[] = {{"correspondence", "static: {increments: 1}"},
              {"correspondence", "static: {increments: 1, method: relaxation}"},
              {"correspondence", "implicit: {end time: 0.05, time step: 0.01}"},
              {"correspondence", "explicit: {steps: 200}"},
              {"hybrid", "static: {increments: 1}"},
              {"hybrid", "explicit: {steps: 200}"},
              {"hybrid, form: pairwise", "static: {increments: 1}"}};
  const double by_gravity = 2 * 10 * 4 * 4 / (2 * 12000.0);
  for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
    breccia_model *m = model_of(
        ELASTIC
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [8, 40]}}}}\n"
        "peridynamics: {space: plane strain, formulation: %s}\n"
        "initial stress: {surface: 4, K0: 0.8}\n"
        "loads: [{gravity: [0, -10]}, " SIDES "]\nsolve: {%s}\n",
        ways[k].formulation, ways[k].solve);
    assert_string_equal(breccia_model_warnings(m), "");
    run_all(m);
    print_message("%s, %s: moved %g of %g\n", ways[k].formulation, ways[k].solve, largest_displacement(m), by_gravity);
    assert_true(largest_displacement(m) < 2e-3 * by_gravity); /* families at the surface are not whole */
    const Domain *d = observed(m);
    for (int64_t n = 0; n < d->particles->count; ++n) {
      const int32_t i = d->particles->place_of[n];
      const double depth = 4 - d->particles->position[1][i];
      if (body_outside(&d->body, n) || depth < 1) continue;
      assert_near(d->stress[YY][i], -20 * depth, 0.2);
      assert_near(d->stress[XX][i] / d->stress[YY][i], 0.8, 5e-3);
      assert_near(d->stress[ZZ][i] / d->stress[YY][i], 0.8, 5e-3);
    }
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

/** What is told of ground whose faces are held in so many layers, and which is said to weigh this. */
static char *warnings_of_held_ground(int layers, double weight)
{
  breccia_model *m = model_of(
      ELASTIC
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [20, 16]}}}}\n"
      "peridynamics: {space: plane strain}\n"
      "initial stress: {surface: 1.6, K0: 0.5, unit weight: %g}\n"
      "loads: [{gravity: [0, -10]}, {on: {face: x-, layers: %d}, roller: [1, 0]}, {on: {face: x+, layers: %d}, "
      "roller: [1, 0]}, {on: {face: y-, layers: %d}, roller: [0, 1]}]\n"
      "solve: {static: {increments: 1}}\n",
      weight, layers, layers, layers);
  char *words = text_format("%s", breccia_model_warnings(m));
  breccia_model_destroy(&m);
  return words;
}

static void ground_that_is_not_in_balance_is_told(void **state)
{
  (void)state;
  const struct {
    int layers;
    double weight;
    bool told;
  } grounds[] = {{6, 20, false}, {3, 20, true}, {1, 20, true}, {6, 40, true}};
  for (size_t k = 0; k < sizeof grounds / sizeof *grounds; ++k) {
    char *words = warnings_of_held_ground(grounds[k].layers, grounds[k].weight);
    if (grounds[k].told != (strstr(words, "the ground begins out of balance: on particle") != NULL))
      fail_msg("ground %d: %s", (int)k, words);
    assert_int_equal(!grounds[k].told, !*words);
    free(words);
  }
}

static void layers_stand_on_each_other_and_weigh_what_is_said(void **state)
{
  (void)state;
  /* Weights of 20 and 30 along an inclined axis: gravity [0, -6, -8]; the lower block under a surcharge of 20 times its depth. */
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25},\n"
      "            n: {model: elastic, density: 3, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
      "body: {up: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [0, 0, 0]}}},\n"
      "       down: {material: n, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [0, 0, -0.4]}}}}\n"
      "initial stress:\n"
      "  - {on: {block: up}, surface: 1, K0: 0.5}\n"
      "  - {on: {block: down}, surface: 0.15, K0: 2, surcharge: 18, unit weight: 25}\n"
      "loads: [{gravity: [0, -6, -8]}]\nsolve: {explicit: {steps: 1}}\n");
  const Domain *d = &m->domain;
  const Particles *p = d->particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double height = 0.6 * p->position[1][i] + 0.8 * p->position[2][i];
    const bool up = p->position[2][i] > -0.05;
    const double v = up ? -20 * (1 - height) : -18 - 25 * (0.15 - height), h = up ? 0.5 * v : 2 * v;
    const double expected[6] = {h, h + 0.36 * (v - h), h + 0.64 * (v - h), 0, 0.48 * (v - h), 0};
    for (int k = 0; k < 6; ++k) assert_near(d->stress[k][i], expected[k], 1e-8);
  }
  breccia_model_destroy(&m);
}

static void free_strains_come_beside_it(void **state)
{
  (void)state;
  /* A body that is held on all sides and warms by e: 3 K e = e E / (1 - 2 nu) = 2e4 e of pressure beside what it began with. */
  for (int form = 0; form < 3; ++form) {
    breccia_model *m =
        model_of(ELASTIC PLATE "peridynamics: {space: plane strain, formulation: %s}\n"
                               "initial stress: {stress: [-300, -200, -100, 40, 0, 0]}\n"
                               "loads: [{on: {face: x-}, support: {held: all}}, {on: {face: x+}, support: {held: all}},"
                               " {on: {face: y-}, support: {held: all}}, {on: {face: y+}, support: {held: all}},"
                               " {initial strain: 1e-3, history: {ramp to: 1}}]\n" AT_REST,
                 in_space[form]);
    run_all(m);
    assert_stress(m, (const double[6]){-320, -220, -120, 40, 0, 0}, 1e-8);
    breccia_model_destroy(&m);
  }
}

static void stages_and_loads_go_on_from_it(void **state)
{
  (void)state;
  /* 30 kPa on the surface of an elastic layer: 30 of vertical and 30 nu / (1 - nu) = 10 of horizontal stress more, p H / M of settlement. */
  breccia_model *m = model_of(
      ELASTIC
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [8, 20]}}}}\n"
      "peridynamics: {space: plane strain, strain: small}\n"
      "initial stress: {surface: 2, K0: 0.8}\n"
      "loads: [{gravity: [0, -10]}, " SIDES "]\n"
      "solve: [{laws: elastic, static: {increments: 1}},\n"
      "        {displacements: zero, loads: [{on: {face: y+}, pressure: 30}], static: {increments: 2}}]\n");
  run_all(m);
  const Domain *d = &m->domain;
  const int32_t i = particles_nearest(d->particles, (const double[3]){0.35, 0.85, 0});
  assert_near(d->stress[YY][i], -20 * 1.15 - 30, 0.3);
  assert_near(d->stress[XX][i], -16 * 1.15 - 10, 0.3);
  assert_near(particles_moved(d->particles, 1, particles_nearest(d->particles, (const double[3]){0.35, 1.95, 0})),
              -30 * 1.95 / 12000, 0.03 * 30 * 1.95 / 12000);
  breccia_model_destroy(&m);
}

/* ---- laws ---- */

/** A block between smooth walls under [-20, -80, -20] that is pressed together along y. */
static breccia_model *oedometer(const char *law, const char *formulation, double pressed)
{
  return model_of(UNITS "materials: {m: {density: 2, Young modulus: 1e4, Poisson ratio: 0.25, %s}}\n" PLATE
                        "peridynamics: {space: plane strain, strain: small, formulation: %s}\n"
                        "initial stress: {stress: [-20, -80, -20, 0, 0, 0]}\n"
                        "loads: [" SIDES ", {on: {face: y+}, support: {held: across, displacement: [0, %.17g]},"
                        " history: {ramp to: 1}}]\n"
                        "solve: {static: {increments: 4, residual: 1e-10}}\n",
                  law, formulation, -0.7 * pressed);
}

static void a_plastic_law_yields_where_stress_and_strain_lead_it_together(void **state)
{
  (void)state;
  /* Deviator stress 60 of 100 at first; it grows by 2 G = 8000 times the strain, up to 100; the mean stress by K = 20000 / 3 times the strain. */
  for (int n = 0; n < 4; ++n) {
    const int k = n % 2;
    const double pressed = k ? 0.01 : 0.0045;
    breccia_model *m = oedometer("model: j2, yield stress: 100", in_space[n / 2], pressed);
    run_all(m);
    const double q = k ? 100 : 60 + 8000 * pressed, mean = -40 - 20000 / 3.0 * pressed;
    assert_stress(m, (const double[6]){mean + q / 3, mean - 2 * q / 3, mean + q / 3, 0, 0, 0}, 1e-4);
    /* q times the plastic deviator strain 2/3 (e - e_y) */
    const double volume = 0.9 * 0.7 * 0.5, dissipated = k ? 100 * 2 / 3.0 * (pressed - 0.005) * volume : 0;
    assert_near(solver_energy(&m->solver).dissipated, dissipated, 0.02 * dissipated + 1e-6);
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

static void a_law_that_hardens_is_led_along_its_own_path(void **state)
{
  (void)state;
  /* Deviator stress 60 is beyond 45, and H = 1000 leads to it with a plastic strain of 15 / 1000. From there on it yields at once: with a uniaxial
   * strain e the deviator stress grows by 3 G H / (3 G + H) times 2/3 e. */
  breccia_model *m = oedometer("model: j2, yield stress: 45, hardening modulus: 1000", "correspondence", 0.004);
  const Domain *d = &m->domain;
  assert_stress(m, (const double[6]){-20, -80, -20, 0, 0, 0}, 1e-6);
  const int32_t i = particles_nearest(d->particles, (const double[3]){0.4, 0.3, 0});
  const Points *points = &d->regions[0].points;
  bool found = false;
  for (int k = 0; k < points_material(points, i)->history_values; ++k)
    found |= fabs(points_history(points, i)[k] - 0.015) < 1e-9;
  assert_true(found);                               /* before anything moves */
  for (size_t k = 0; k < points->history_size; ++k) /* but for the roundings of a law that stands where it yields */
    assert_near(points->trial[k], points->committed[k], 1e-15);
  run_all(m);
  assert_near(d->stress[XX][i] - d->stress[YY][i], 60 + 8000 * 1000 / 13000.0 * 0.004, 1e-3);
  assert_balanced(m, 1e-3);
  breccia_model_destroy(&m);
}

/** A number that the law of the first material remembers at a place, by its name. */
static double remembered(const Domain *d, int64_t place, const char *wanted)
{
  const Material *m = &d->materials[0];
  for (int k = 0; k < m->history_values; ++k) {
    char name[64];
    m->law->history_name(m->constants, k, name, sizeof name);
    if (!strcmp(name, wanted)) return domain_history(d, place, k);
  }
  fail_msg("the law remembers no %s", wanted);
  return NAN;
}

static void damage_of_the_stress_at_the_start_stays(void **state)
{
  (void)state;
  /* Damaged under 6 in compression along y, by the strains 1.5 / (E (1 - D)) across, it holds the energy of what is left of its stiffness; squeezed
   * across, in its first step, it heals not. */
  breccia_model *m =
      model_of(UNITS "materials: {m: {model: mazars, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, "
                     "tensile strength: 1, fracture energy: 0.01}}\n" PLATE
                     "peridynamics: {space: plane strain, strain: small}\n"
                     "initial stress: {stress: [0, -6, 0, 0, 0, 0]}\n"
                     "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-}, support: {held: across}},"
                     " {on: {face: y+}, support: {held: across}},"
                     " {on: {face: x+}, support: {held: across, displacement: [-9e-5, 0]}, history: {ramp to: 1}}]\n"
                     "solve: {static: {increments: 1}}\n");
  Domain *d = &m->domain;
  const int32_t i = particles_nearest(d->particles, (const double[3]){0.45, 0.35, 0});
  const double damage = remembered(d, i, "material damage"), strain = remembered(d, i, "equivalent strain");
  assert_true(damage > 0.02 && damage < 0.9);
  assert_near(strain, sqrt(2) * 1.5 / (1e4 * (1 - damage)), 1e-9);
  const double energy = 36 / (2 * 1e4 * (1 - damage)) * 0.9 * 0.7 * 0.5;
  assert_near(solver_energy(&m->solver).stored, energy, 1e-6 * energy);
  run_all(m);
  assert_near(d->strain[XX][i], -1e-4, 1e-7);
  assert_near(remembered(d, i, "equivalent strain"), strain, 1e-12);
  breccia_model_destroy(&m);
}

static void clay_begins_as_after_an_elastic_stage(void **state)
{
  (void)state;
  /* 10 of shear, beyond the innermost of its surfaces: the strain is elastic, and what it would have yielded on the way is not. */
  breccia_model *m = model_of(UNITS "materials: {m: {model: multi-yield-j2, density: 1.5, shear modulus: 6000, bulk "
                                    "modulus: 1e4, octahedral strength: 30}}\n" CUBE "peridynamics: {space: 3-D}\n"
                                    "initial stress: {stress: [-50, -50, -50, 10, 0, 0]}\n"
                                    "solve: {explicit: {steps: 1}}\n");
  const Domain *d = &m->domain;
  assert_stress(m, (const double[6]){-50, -50, -50, 10, 0, 0}, 1e-6);
  for (int64_t n = 0; n < d->particles->count; ++n)
    assert_near(d->initial_strain[XY][d->particles->place_of[n]], 10 / 6000.0, 1e-9);
  breccia_model_destroy(&m);
}

static void control_does_not_fade_where_stress_was_there_before_strain(void **state)
{
  (void)state;
  /* Concrete in compression that is pulled a little is as stiff as before, though stress and displacement work against each other. */
  breccia_model *m = oedometer("model: mazars, tensile strength: 30, fracture energy: 0.1", "correspondence", -1e-4);
  run_all(m);
  const Region *region = &m->domain.regions[0];
  assert_false(region->type->lags(region->formulation));
  assert_stress(m, (const double[6]){-20 + 0.4, -80 + 1.2, -20 + 0.4, 0, 0, 0}, 1e-4);
  breccia_model_destroy(&m);
}

/** Concrete under its weight keeps all of its zero-energy control at every depth. Rows along x, and so batches of
 *  particles, lie at several depths. */
static void control_does_not_fade_under_stress_that_grows_with_depth(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: mazars, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, tensile strength: 30, "
      "fracture energy: 0.1}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [60, 12]}}}}\n"
      "peridynamics: {space: plane strain, formulation: correspondence}\n"
      "initial stress: {surface: 1.2, K0: 0.33333333}\n"
      "loads: [{gravity: [0, -10]}, " SIDES "]\nsolve: {static: {increments: 2}}\n");
  assert_true(m->domain.batch_count > 1);
  run_all(m);
  const Region *region = &m->domain.regions[0];
  assert_false(region->type->lags(region->formulation));
  breccia_model_destroy(&m);
}

/* ---- what is refused ---- */

#define GROUND ELASTIC PLATE "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"

/** A rod whose law is under stress at no strain springs back once it is let go: that energy was stored at the start. */
static void a_law_under_stress_at_no_strain_stores_energy(void **state)
{
  (void)state;
  static const char *const laws[] = {"elastic-perfectly-plastic, yield stress: 100, initial strain: 5e-3",
                                     "menegotto-pinto, yield stress: 100, initial stress: -50"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        UNITS "materials: {m: {model: %s, density: 2, Young modulus: 1e4}}\n"
              "body: {b: {material: m, lattice: line, spacing: 0.1, area: 0.02, shape: {box: {from: [0, 0], to: [4, "
              "0.1]}}}}\nperidynamics: {formulation: bond-based, space: 1-D, horizon: 1.5 spacings}\n"
              "solve: {explicit: {end time: 0.2}}\n",
        laws[k]);
    run_all(m);
    assert_near(m->solver.ledger.stored_at_start, 50.0 * 50 / 2e4 * 0.02 * 3.9, 2e-3 * 0.02);
    assert_near(m->solver.ledger.stored_at_start, ledger_energy(&m->solver.ledger, &m->domain).kinetic, 0.02);
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

static void what_cannot_be_meant_is_told(void **state)
{
  (void)state;
  static const struct {
    const char *deck, *words;
  } decks[] = {
      {GROUND "initial stress: {surface: 1}\n", "missing key 'K0'"},
      {GROUND "initial stress: {stress: [1, 2, 3]}\n", "expected six numbers, xx, yy, zz, xy, yz, zx; found 3"},
      {GROUND "initial stress: {stress: [1, 2, 3, 4, 0, 0], K0: 0.5}\n", "K0: belongs to 'surface'"},
      {GROUND "initial stress: {stress: [1, 2, 3, 4, 0, 0], unit weight: 20}\n", "unit weight: belongs to 'surface'"},
      {GROUND "initial stress: {stress: [1, 2, 3, 4, 0, 0], surcharge: 5}\n", "surcharge: belongs to 'surface'"},
      {GROUND "initial stress: {stress: [1, 2, 3, 4, 5, 0]}\n", "yz is 5; expected 0 in the plane"},
      {GROUND "initial stress: {surface: 1, K0: 0.5}\n", "no gravity acts on the whole body when the run begins"},
      {GROUND "initial stress: {surface: 1, K0: 0.5}\nloads: [{gravity: [0, -10], history: {ramp to: 1}}]\n",
       "no gravity acts on the whole body when the run begins"},
      {GROUND "initial stress: {surface: 0.6, K0: 0.5, unit weight: 20}\n", "stands 0.05 above it"},
      {GROUND "initial stress: {surface: 1, K0: 0.5, unit weight: 20, stress: [0, 0, 0, 0, 0, 0]}\n", "stress"},
      {GROUND "initial stress: {surface: 1, K0: -0.5, unit weight: 20}\n", "out of range"},
      {GROUND "initial stress: [{stress: [1, 0, 0, 0, 0, 0]}, {on: {face: x-}, stress: [1, 0, 0, 0, 0, 0]}]\n",
       "has one already, of line"},
      {ELASTIC PLATE "peridynamics: {space: plane stress}\nsolve: {explicit: {steps: 1}}\n"
                     "initial stress: {stress: [1, 0, 3, 0, 0, 0]}\n",
       "zz is 3; expected 0 in plane stress"},
      {ELASTIC PLATE "peridynamics: {space: plane strain, formulation: ordinary}\nsolve: {explicit: {steps: 1}}\n"
                     "initial stress: {stress: [1, 0, 3, 0, 0, 0]}\n",
       "'ordinary' has no law for stress in space, as at particle 0 at [0.05, 0.05, 0]; expected 'formulation: "
       "correspondence' or 'hybrid', or a first stage 'laws: elastic' under the weight"},
      {UNITS
       "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 50}}\n" PLATE
       "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
       "initial stress: {stress: [-20, -80, -20, 0, 0, 0]}\nloads: [{on: {face: x-}, support: {held: across}}]\n",
       "does not bear [-20, -80, -20, 0, 0, 0] of particle"},
      {UNITS
       "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 50}}\n" PLATE
       "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n"
       "initial stress: {stress: [-20, -80, -20, 0, 0, 0]}\n",
       "the law j2 of material 'm' does not bear [-20, -80, -20, 0, 0, 0] of particle 0 at [0.05, 0.05, 0], it comes "
       "to [-"},
      {UNITS
       "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 50}}\n" PLATE
       "peridynamics: {space: plane strain, formulation: hybrid}\nsolve: {explicit: {steps: 1}}\n"
       "initial stress: {on: {inside: {box: {from: [0.4, 0], to: [1, 1]}}}, stress: [-40, -160, -40, 0, 0, 0]}\n",
       "the law j2 of material 'm' does not bear [-20, -80, -20, 0, 0, 0] of particle 4 at [0.45, 0.05, 0], it comes "
       "to [-"},
      {UNITS
       "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25},\n"
       "            n: {model: elastic, density: 3, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
       "body: {a: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}},\n"
       "       b: {material: n, spacing: 0.1, shape: {box: {particles: [4, 4, 4], first particle: [0, 0, -0.4]}}}}\n"
       "initial stress: {surface: 1, K0: 0.5}\nloads: [{gravity: [0, 0, -10]}]\nsolve: {explicit: {steps: 1}}\n",
       "its particles have unit weights of 20 and 30"},
  };
  for (size_t k = 0; k < sizeof decks / sizeof *decks; ++k) {
    char *words = refusal_of(decks[k].deck);
    if (!strstr(words, decks[k].words)) fail_msg("deck %d is refused by '%s'", (int)k, words);
    if (strchr(words, '\n')) fail_msg("deck %d is refused in two lines: %s", (int)k, words);
    free(words);
  }
  breccia_model *m = model_of(GROUND "initial stress: {surface: 1, K0: 0.5, unit weight: 20}\n");
  assert_non_null(strstr(breccia_model_warnings(m), "no gravity acts when the run begins"));
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_held_on_all_sides_keeps_any_stress),
      cmocka_unit_test(unlike_blocks_begin_under_one_stress),
      cmocka_unit_test(a_face_that_slides_takes_pressure_and_no_shear),
      cmocka_unit_test(a_body_let_go_springs_by_its_compliance),
      cmocka_unit_test(a_plane_body_springs_in_its_plane),
      cmocka_unit_test(a_body_let_go_in_motion_keeps_its_energy),
      cmocka_unit_test(ground_under_its_own_weight_stays_where_it_is),
      cmocka_unit_test(ground_that_is_not_in_balance_is_told),
      cmocka_unit_test(layers_stand_on_each_other_and_weigh_what_is_said),
      cmocka_unit_test(free_strains_come_beside_it),
      cmocka_unit_test(stages_and_loads_go_on_from_it),
      cmocka_unit_test(a_plastic_law_yields_where_stress_and_strain_lead_it_together),
      cmocka_unit_test(a_law_that_hardens_is_led_along_its_own_path),
      cmocka_unit_test(damage_of_the_stress_at_the_start_stays),
      cmocka_unit_test(clay_begins_as_after_an_elastic_stage),
      cmocka_unit_test(control_does_not_fade_where_stress_was_there_before_strain),
      cmocka_unit_test(control_does_not_fade_under_stress_that_grows_with_depth),
      cmocka_unit_test(a_law_under_stress_at_no_strain_stores_energy),
      cmocka_unit_test(what_cannot_be_meant_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

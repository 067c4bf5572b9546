/* What joins bodies to each other and to the ground: springs and ties, against closed forms, and their work in the ledger. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define SOFT UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e3, Poisson ratio: 0.25}}\n"
#define CUBE SOFT "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"

static void a_mass_on_a_spring_swings_with_its_period(void **state)
{
  (void)state;
  /* 128 kg on 5 kN/m and, across, on none: sqrt(k / m) = 6.25 1/s. */
  const char *const springs[] = {"stiffness: 5 kN/m", "stiffness: 5 kN/m, direction: [3, 0, 0]"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(CUBE "loads:\n  - {on: {all: yes}, spring: {%s}}\n"
                                     "  - {initial velocity: {translation: [0.5, 0.2, 0]}}\n"
                                     "solve: {explicit: {end time: 1.3, time step: 1e-3}}\n",
                                springs[k]);
    double most = 0;
    while (m->solver.clock.time < 1.25) {
      assert_int_equal(breccia_model_step(m, 25, NULL), 0);
      const double t = breccia_model_time(m), w = 6.25;
      const Sums s = sums_of(m);
      assert_near(s.moved[0], 0.5 / w * sin(w * t), 2e-5 * 0.5);
      assert_near(s.moved[1], k ? 0.2 * t : 0.2 / w * sin(w * t), 2e-5 * 0.5);
      const Energy e = solver_energy(&m->solver);
      assert_near(e.kinetic + e.stored, 0.128 * (0.25 + 0.04) / 2, 1e-4 * 0.0186);
      assert_near(e.external, 0, 1e-12);
      most = larger_of(most, e.stored);
    }
    assert_true(most > 0.99 * 0.128 * (k ? 0.25 : 0.29) / 2);
    assert_balanced(m, 1e-10);
    breccia_model_destroy(&m);
  }
}

#define PAIR                                                                                                           \
  SOFT "body: {a: {material: m, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [0.3, 0.3, 0.3]}}},\n"                \
       "       b: {material: m, spacing: 0.1, shape: {box: {from: [1, 0, 0], to: [1.6, 0.3, 0.3]}}}}\n"

static double mean_along(const breccia_model *m, int block, double *const vector)
{
  const Particles *p = m->domain.particles;
  double sum = 0, count = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->block[i / SLICE] != block) continue;
    sum += vector[i];
    ++count;
  }
  return sum / count;
}

static void two_bodies_on_one_spring_swing_about_their_centre_of_mass(void **state)
{
  (void)state;
  /* Masses 54 and 108 kg, reduced mass 36 kg, 9 kN/m: 15.81 1/s. */
  breccia_model *m = model_of(PAIR "loads:\n  - {on: {block: a}, spring: {to: {block: b}, stiffness: 9}}\n"
                                   "  - {on: {block: a}, initial velocity: {translation: [0.3, 0, 0]}}\n"
                                   "solve: {explicit: {end time: 1, time step: 5e-4}}\n");
  const Particles *p = m->domain.particles;
  const double w = sqrt(9 / 0.036);
  while (m->solver.clock.time < 0.9) {
    assert_int_equal(breccia_model_step(m, 40, NULL), 0);
    const double t = breccia_model_time(m);
    const double apart = mean_along(m, 0, p->displacement.row[0]) - mean_along(m, 1, p->displacement.row[0]);
    assert_near(apart, 0.3 / w * sin(w * t), 2e-4 * 0.3 / w);
    assert_near(sums_of(m).momentum[0], 0.054 * 0.3, 1e-12);
  }
  assert_balanced(m, 1e-9);
  breccia_model_destroy(&m);
}

static void springs_shorten_the_stable_step_as_they_must(void **state)
{
  (void)state;
  /* Of a body that is next to nothing beside its springs: 2 sqrt(m / k), and 2 sqrt of the reduced mass / k. */
  breccia_model *ground = model_of(CUBE "loads: [{on: {all: yes}, spring: {stiffness: 2e9}}]\n"
                                        "solve: {explicit: {steps: 1}}\n"),
                *pair = model_of(PAIR "loads: [{on: {block: a}, spring: {to: {block: b}, stiffness: 9e9}}]\n"
                                      "solve: {explicit: {steps: 1}}\n");
  assert_near(ground->solver.clock.stable, 2 * sqrt(0.128 / 2e9), 1e-3 * 2 * sqrt(0.128 / 2e9));
  assert_near(pair->solver.clock.stable, 2 * sqrt(0.036 / 9e9), 1e-3 * 2 * sqrt(0.036 / 9e9));
  breccia_model_destroy(&ground);
  breccia_model_destroy(&pair);
}

static void tied_bodies_move_as_one_and_keep_their_momentum(void **state)
{
  (void)state;
  for (int local = 0; local < 2; ++local) {
    breccia_model *m = model_of(PAIR "loads:\n  - {on: {block: a, face: x+}, tie: {to: {block: b, face: x-}}}\n"
                                     "  - {on: {block: a}, initial velocity: {translation: [0.3, 0, 0.1]}}\n"
                                     "solve: {explicit: {steps: 400%s}}\n",
                                local ? ", local damping: 0.3" : "");
    const Particles *p = m->domain.particles;
    const double given[] = {0.054 * 0.3, 0, 0.054 * 0.1};
    for (int round = 0; round < 8; ++round) {
      assert_int_equal(breccia_model_step(m, 50, NULL), 0);
      for (double y = 0.05; y < 0.3; y += 0.1)
        for (double z = 0.05; z < 0.3; z += 0.1) {
          const int32_t a = particles_nearest(p, (double[]){0.25, y, z}),
                        b = particles_nearest(p, (double[]){1.05, y, z});
          for (int k = 0; k < 3; ++k) assert_true(p->displacement.row[k][a] == p->displacement.row[k][b]);
        }
      for (int k = 0; k < 3 && !local; ++k) assert_near(sums_of(m).momentum[k], given[k], 1e-12);
    }
    assert_true(mean_along(m, 1, p->displacement.row[0]) > 1e-3); /* b goes along */
    assert_balanced(m, 2e-3);
    breccia_model_destroy(&m);
  }
}

/** Implicit steps find the constant acceleration of tied bodies of two densities that a force pushes from rest. */
static void unlike_tied_bodies_are_pushed_by_the_mass_of_both(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e3, Poisson ratio: 0.25}\n"
            "  n: {model: elastic, density: 9, Young modulus: 1e3, Poisson ratio: 0.25}\n"
            "body: {a: {material: m, spacing: 0.1, shape: {box: {particles: [3, 3, 3]}}},\n"
            "       b: {material: n, spacing: 0.1, shape: {box: {particles: [4, 3, 3], first particle: [1, 0, 0]}}}}\n"
            "loads: [{on: {all: yes}, tie: {}}, {on: {block: a}, force: [0.3, 0, -0.1]}]\n"
            "solve: {implicit: {end time: 0.02, time step: 2e-3, local error: 1, residual: 1e-12}}\n");
  const double mass = 0.027 * 2 + 0.036 * 9;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    const double t = breccia_model_time(m);
    assert_near(mean_along(m, 1, m->domain.particles->displacement.row[0]), 0.3 / mass * t * t / 2,
                1e-6 * 0.3 / mass * 2e-4);
    assert_near(mean_along(m, 0, m->domain.particles->velocity.row[2]), -0.1 / mass * t, 1e-6 * 0.1 / mass * 0.02);
  }
  breccia_model_destroy(&m);
}

static void a_tie_in_one_direction_leaves_the_others(void **state)
{
  (void)state;
  breccia_model *m = model_of(CUBE "loads:\n  - {on: {face: z+}, tie: {directions: z}}\n"
                                   "  - {on: {nearest: [0, 0, 0.4]}, force: [0.01, 0, 0.01]}\n"
                                   "  - {on: {face: z-, layers: 1}, displacement: [0, 0, 0]}\n"
                                   "solve: {explicit: {steps: 300, damping: 5}}\n");
  step_surely(m, INT64_MAX);
  const Particles *p = m->domain.particles;
  const int32_t a = particles_nearest(p, (double[]){0, 0, 0.4}), b = particles_nearest(p, (double[]){0.4, 0.4, 0.4});
  assert_true(p->displacement.row[2][a] == p->displacement.row[2][b] && p->displacement.row[2][a] > 0);
  assert_true(fabs(p->displacement.row[0][a] - p->displacement.row[0][b]) > 1e-3 * fabs(p->displacement.row[0][a]));
  assert_balanced(m, 2e-3);
  breccia_model_destroy(&m);
}

/** A plane body has no z in which particles could move as one. */
static void a_tie_that_leads_out_of_the_plane_is_refused(void **state)
{
  (void)state;
  char *words = refusal_of(
      UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 250, Poisson ratio: 0.25}}\n"
            "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 6]}}}}\n"
            "peridynamics: {space: plane strain}\n"
            "loads: [{on: {face: y-}, tie: {directions: z}}]\nsolve: {explicit: {steps: 1}}\n");
  holds_words(words, "directions: 'z' leads out of the body, which is plane");
  free(words);
}

/** A spring between two blocks of unlike size at rest is longer by the force over its stiffness than when it
 *  began. */
static void a_spring_between_blocks_at_rest_is_stretched_by_its_force(void **state)
{
  (void)state;
  for (int later = 0; later < 2; ++later) { /* from the beginning, or from a stage on in which its block is let go */
    const char *spring = "{on: {block: b}, spring: {to: {block: a}, stiffness: 9}}",
               *pull = "{on: {block: b, face: x+}, force: [0.018, 0, 0]}",
               *hold = "{name: held, on: {block: b}, displacement: [0, free, free]}";
    char rest[600];
    snprintf(
        rest, sizeof rest,
        later
            ? ", %s]\nsolve: [{static: {increments: 1}}, {without: [held], loads: [%s, %s], static: {increments: 1}}]\n"
            : ", %s, %s]\nsolve: {static: {increments: 1}}\n",
        later ? hold : spring, later ? spring : pull, pull);
    breccia_model *m = model_of(PAIR "loads: [{on: {block: a}, displacement: [0.01, 0, 0]},"
                                     " {on: {block: b}, roller: [0, 1, 0]}, {on: {block: b}, roller: [0, 0, 1]}%s",
                                rest);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    assert_near(mean_along(m, 1, p->displacement.row[0]), (later ? 0 : 0.01) + 0.018 / 9, 1e-8 * 0.018 / 9);
    breccia_model_destroy(&m);
  }
}

/* A shear column whose sides are tied is one of infinite width: with a = g sin a along it, rest is at u(z) = rho a (H z - z^2 / 2) / G. */
static void a_column_with_tied_sides_shears_as_if_it_had_none(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: elastic, density: 2, Young modulus: 250, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 20]}}}}\n"
      "peridynamics: {space: plane strain}\n"
      "loads:\n"
      "  - {on: {face: y-, layers: 3}, displacement: [0, 0]}\n"
      "  - {on: {face: x-, layers: 3}, tie: {to: {face: x+, layers: 1}}}\n"
      "  - {on: {all of: [{face: x+, layers: 3}], except: {face: x+, layers: 1}}, tie: {to: {face: x+, layers: 1}}}\n"
      "  - {gravity: [1, 0]}\n"
      "solve: {explicit: {end time: 12, damping: 3, rest: 1e-5}}\n");
  step_surely(m, INT64_MAX);
  const Particles *p = m->domain.particles;
  const double height = 2 - 0.25, shear = 100; /* from the middle of the held layers */
  const int32_t top = particles_nearest(p, (double[]){0.25, 1.95, 0}),
                side = particles_nearest(p, (double[]){0.05, 1.95, 0});
  const double z = 1.95 - 0.25, expected = 2 * 1 * (height * z - z * z / 2) / shear;
  assert_near(p->displacement.row[0][top], expected, 0.05 * expected);
  assert_near(p->displacement.row[0][side], p->displacement.row[0][top], 0.02 * expected);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_mass_on_a_spring_swings_with_its_period),
      cmocka_unit_test(two_bodies_on_one_spring_swing_about_their_centre_of_mass),
      cmocka_unit_test(springs_shorten_the_stable_step_as_they_must),
      cmocka_unit_test(tied_bodies_move_as_one_and_keep_their_momentum),
      cmocka_unit_test(unlike_tied_bodies_are_pushed_by_the_mass_of_both),
      cmocka_unit_test(a_tie_in_one_direction_leaves_the_others),
      cmocka_unit_test(a_tie_that_leads_out_of_the_plane_is_refused),
      cmocka_unit_test(a_spring_between_blocks_at_rest_is_stretched_by_its_force),
      cmocka_unit_test(a_column_with_tied_sides_shears_as_if_it_had_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

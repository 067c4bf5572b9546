/* Waves that leave through dashpots, and earthquakes that come in through them: against closed forms of one-dimensional waves. */
#include "solver/modes.h"
#include "support.h"

/* A bar of 20 m with waves of 200 m/s, density 2 and area 1: a shear column of these numbers has the same equations. Free at x+. */
#define BAR                                                                                                            \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic-1d, Young modulus: 8e4, density: 2}}\n"                                              \
  "body: {bar: {material: m, lattice: line, spacing: 0.125, area: 1, shape: {box: {particles: [160, 1], first "        \
  "particle: [0.0625, 0]}}}}\n"                                                                                        \
  "peridynamics: {formulation: bond-based, space: 1-D}\n"
#define BURST "history: {sine: {frequency: 4 Hz, envelope: [[0, 0], [0.25, 1], [0.5, 0]]}}"

static const double height = 20, speed = 200, density = 2;

static double burst(double t)
{
  const double pi = acos(-1);
  return t <= 0 || t >= 0.5 ? 0 : sin(8 * pi * t) * fmin(4 * t, 2 - 4 * t);
}

/** Velocity along x of the particle that is farthest along an axis. */
static double velocity_at_top(const breccia_model *m, int axis)
{
  const Particles *p = m->domain.particles;
  int32_t top = p->place_of[0];
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[axis][p->place_of[n]] > p->position[axis][top]) top = p->place_of[n];
  return p->velocity.row[0][top];
}

static double energy_inside(const breccia_model *m)
{
  const Energy e = solver_energy(&m->solver);
  return e.kinetic + e.stored;
}

static const char *const solvers[] = {"explicit: {end time: 0.8}", "implicit: {end time: 0.8, time step: 2e-3}"};

/** The surface of ground that is alike all the way down moves as its outcrop, later by the time that waves take; then all is at rest again. */
static void alike_ground_moves_as_its_outcrop_and_sends_nothing_back(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        BAR "loads: [{on: {face: x-}, dashpots: {outcrop velocity: [1, 0]}, " BURST "}]\nsolve: {%s}\n", solvers[k]);
    double incident = 0, input = 0, absorbed = 0, before = 0;
    const double impedance = density * speed, around = 2 * height / speed;
    while (!solver_is_done(&m->solver)) {
      step_surely(m, 1);
      const double t = breccia_model_time(m), step = t - before, middle = (t + before) / 2;
      /* A quarter of a spacing between the middle of the last particle and the end of the bar is 3e-4 s: half a percent of 2 pi / 0.25 s. */
      assert_near(velocity_at_top(m, 0), burst(t - height / speed), 0.03);
      const double base = (burst(middle) + burst(middle - around)) / 2;
      incident += step * impedance * pow(burst(middle) / 2, 2);
      input += step * impedance * burst(middle) * base;
      absorbed += step * impedance * base * base;
      before = t;
    }
    assert_true(energy_inside(m) < 0.01 * incident);
    const Energy e = solver_energy(&m->solver);
    assert_near(e.external, input, 0.02 * input);
    assert_near(e.damping, absorbed, 0.02 * absorbed);
    assert_balanced(m, 1e-6);
    breccia_model_destroy(&m);
  }
}

/** The same by the acceleration of the outcrop. */
static void an_outcrop_may_be_said_by_its_acceleration(void **state)
{
  (void)state;
  const double pi = acos(-1);
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-}, dashpots: {outcrop acceleration: [3, 0]}, history: {sine: "
                                  "{frequency: 4 Hz, until: 0.25}}}]\nsolve: {explicit: {end time: 0.6}}\n");
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    const double t = breccia_model_time(m) - height / speed;
    const double expected = t <= 0 || t >= 0.25 ? 0 : 3 * (1 - cos(8 * pi * t)) / (8 * pi);
    assert_near(velocity_at_top(m, 0), expected, 0.03 * 6 / (8 * pi));
  }
  breccia_model_destroy(&m);
}

static double shear_in(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double most = 0;
  for (int64_t n = 0; n < p->count; ++n) most = larger_of(most, fabs(p->velocity.row[1][p->place_of[n]]));
  return most;
}

/** Shear waves in the plane, with rows that move as one: the impedance along the face counts, not that across it. */
static void shear_waves_pass_by_the_speed_along_the_face(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {m: {model: elastic, Young modulus: 2e5, Poisson ratio: 0.25, density: 2}}\n"
                              "body: {soil: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: "
                              "{from: [0, 0], to: [6, 20]}}}}\n"
                              "peridynamics: {space: plane strain}\n"
                              "loads:\n"
                              "  - {on: {face: y-}, dashpots: {outcrop velocity: [1, 0]}, " BURST "}\n"
                              "  - {on: {face: x+, layers: 11}, tie: {to: {face: x-}, directions: x}}\n"
                              "  - {on: {all: yes}, roller: [0, 1]}\n"
                              "solve: {explicit: {end time: 0.8}}\n");
  double incident = 0, before = 0;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 1);
    const double t = breccia_model_time(m);
    incident += (t - before) * density * speed * 6 * pow(burst((t + before) / 2) / 2, 2);
    assert_near(velocity_at_top(m, 1), burst(t - height / speed), 0.05);
    before = t;
  }
  assert_near(shear_in(m), 0, 1e-12);
  assert_true(energy_inside(m) < 0.01 * incident);
  assert_balanced(m, 1e-6);
  breccia_model_destroy(&m);
}

/** Amplitude at the top in the last 0.8 s, two periods of 2.5 Hz and whole ones of 7.5 and 12.5 Hz, with what is added to it. */
static double steady_amplitude(breccia_model *m, double frequency, double added_in, double added_across)
{
  const double omega = 2 * acos(-1) * frequency, from = m->solver.clock.end_time - 0.8;
  double in = 0, across = 0;
  while (!solver_is_done(&m->solver)) {
    const double before = breccia_model_time(m);
    step_surely(m, 1);
    const double t = breccia_model_time(m), step = t - fmax(before, from);
    if (t <= from) continue;
    in += 2 * step / 0.8 * velocity_at_top(m, 0) * sin(omega * t);
    across += 2 * step / 0.8 * velocity_at_top(m, 0) * cos(omega * t);
  }
  return hypot(in + added_in, across + added_across);
}

/** Soil on rock of four times its impedance: at the first frequency of the soil on rigid rock, c / 4 H, it moves 1 / (alpha + pi zeta / 2) times as
 *  much as an outcrop of the rock. */
static void soil_on_rock_is_amplified_by_its_impedance_and_damping(void **state)
{
  (void)state;
  const double alpha = 0.25, zeta[] = {0, 0.05}, pi = acos(-1);
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(BAR "loads: [{on: {face: x-}, dashpots: {compression wave speed: 800, outcrop velocity: [1, "
                     "0]}, history: {sine: {frequency: 2.5 Hz}}}]\n"
                     "solve: {explicit: {end time: 3.6, damping: {ratio: %g, at: 2.5 Hz}}}\n",
                 zeta[k]);
    const double expected = 1 / (alpha + pi * zeta[k] / 2);
    assert_near(steady_amplitude(m, 2.5, 0, 0), expected, 0.05 * expected);
    breccia_model_destroy(&m);
  }
}

/** Soil on rigid rock that is shaken, seen from the rock: at its n-th frequency, with a damping of 5 % there, the surface moves
 *  1 / sinh((2 n - 1) pi zeta / 2) times as much as the rock. */
static void soil_on_rigid_rock_is_amplified_by_its_damping(void **state)
{
  (void)state;
  const double pi = acos(-1), zeta = 0.05;
  for (int n = 1; n <= 3; ++n) {
    const double f = (2 * n - 1) * 2.5, omega = 2 * pi * f, expected = 1 / sinh((2 * n - 1) * pi * zeta / 2);
    breccia_model *m = model_of(BAR "loads:\n  - {on: {face: x-}, support: {held: all}}\n"
                                    "  - {base acceleration: [1, 0], history: {sine: {frequency: %g}}}\n"
                                    "solve: {explicit: {end time: 6, damping: {ratio: 0.05, at: %g}}}\n",
                                f, f);
    /* The ground accelerates by sin(omega t) and moves by -cos(omega t) / omega. */
    assert_near(steady_amplitude(m, f, 0, -1 / omega) * omega, expected, 0.05 * expected);
    breccia_model_destroy(&m);
  }
}

/** (2 n - 1) c / 4 H. */
static void soil_on_rigid_rock_has_the_frequencies_of_a_layer(void **state)
{
  (void)state;
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-}, support: {held: all}}]\nsolve: {explicit: {steps: 1}}\n");
  Modes modes = {0};
  assert_int_equal(modes_find(&m->domain, &m->loading, 3, &modes, NULL), 0);
  for (int n = 0; n < 3; ++n) assert_near(modes.modes[n].frequency, 2.5 * (2 * n + 1), 0.02 * 2.5 * (2 * n + 1));
  modes_destroy(&modes);
  breccia_model_destroy(&m);
}

static void dashpots_do_nothing_at_rest(void **state)
{
  (void)state;
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-}, dashpots: {}}, {on: {face: x-}, spring: {stiffness: 5}}, "
                                  "{on: {face: x+}, force: [2, 0]}]\nsolve: {static: {increments: 2}}\n");
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  const Particles *p = m->domain.particles;
  assert_near(p->displacement.row[0][p->place_of[0]], 2.0 / 5, 1e-6);
  assert_near(solver_energy(&m->solver).damping, 0, 1e-9);
  breccia_model_plausibility(m); /* which looks at the loads */
  assert_non_null(strstr(breccia_model_warnings(m), "dashpots: they hold nothing in a stage at rest"));
  breccia_model_destroy(&m);
}

/** Edges have dashpots of two faces. A body that flies is braked by rho c A v, whatever the step: v = v0 exp(-rho c A t / mass). */
static void a_body_is_braked_by_its_faces(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n" SOFT_SOLID
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 4, 4]}}}}\n"
      "loads:\n  - {on: {face: x-}, dashpots: {density: 2, shear wave speed: 0, compression wave speed: 1.5}}\n"
      "  - {on: {face: y+}, dashpots: {density: 2, shear wave speed: 0.7, compression wave speed: 0}}\n"
      "  - {on: {face: y-}, dashpots: {density: 2, shear wave speed: 0.7, compression wave speed: 0}}\n"
      "  - {initial velocity: {translation: [0.5, 0, 0]}}\n"
      "solve: {explicit: {end time: 0.2}}\n");
  const double mass = 2 * 0.5 * 0.4 * 0.4, rate = (2 * 1.5 * 0.16 + 2 * 2 * 0.7 * 0.2) / mass;
  while (!solver_is_done(&m->solver)) step_surely(m, 1);
  const Sums s = sums_of(m);
  assert_near(s.momentum[0] / s.mass, 0.5 * exp(-rate * 0.2), 0.01 * 0.5);
  assert_near(solver_energy(&m->solver).external, 0, 1e-12);
  assert_balanced(m, 1e-7);
  breccia_model_destroy(&m);
}

/** Two bodies of unlike density on dashpots of their own density: rho c A / mass is c / length for both. */
static void each_material_of_a_face_has_its_own_impedance(void **state)
{
  (void)state;
  breccia_model *m =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials:\n  light: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\n"
               "  heavy: {model: elastic, density: 6, Young modulus: 1e4, Poisson ratio: 0.25}\n"
               "body:\n  a: {material: light, spacing: 0.1, shape: {box: {particles: [5, 4, 4]}}}\n"
               "  b: {material: heavy, spacing: 0.1, shape: {box: {particles: [5, 4, 4], first particle: "
               "[0, 2, 0]}}}\n"
               "loads:\n  - {on: {face: x-}, dashpots: {shear wave speed: 0, compression wave speed: 1.5}}\n"
               "  - {initial velocity: {translation: [0.5, 0, 0]}}\n"
               "solve: {explicit: {end time: 0.2}}\n");
  const Particles *p = m->domain.particles;
  step_surely(m, INT64_MAX);
  double mean[2] = {0};
  for (int64_t n = 0; n < p->count; ++n)
    mean[p->block[p->place_of[n] / SLICE]] += p->velocity.row[0][p->place_of[n]] / 80;
  for (int block = 0; block < 2; ++block) assert_near(mean[block], 0.5 * exp(-1.5 / 0.5 * 0.2), 0.01 * 0.5);
  assert_balanced(m, 1e-7);
  breccia_model_destroy(&m);
}

static void wrong_dashpots_are_refused(void **state)
{
  (void)state;
  const struct {
    const char *load, *words;
  } wrong[] = {
      {"on: {face: x-}, dashpots: {}, history: {ramp to: 1}", "history: of dashpots only 'outcrop velocity' and"},
      {"on: {face: x-}, dashpots: {outcrop velocity: [1, 0], outcrop acceleration: [1, 0]}",
       "'outcrop velocity' says the motion already"},
      {"on: {all: yes}, dashpots: {}", "dashpots: acts on a face: 'on' must say which"},
      {"on: {face: x-}, dashpots: {outcrop velocity: [0, 1]}", "dashpots: has a part along y"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, BAR "loads: [{%s}]\nsolve: {explicit: {steps: 1}}\n", wrong[k].load);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    assert_non_null(strstr(words, "deck:5:"));
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(alike_ground_moves_as_its_outcrop_and_sends_nothing_back),
      cmocka_unit_test(an_outcrop_may_be_said_by_its_acceleration),
      cmocka_unit_test(shear_waves_pass_by_the_speed_along_the_face),
      cmocka_unit_test(soil_on_rock_is_amplified_by_its_impedance_and_damping),
      cmocka_unit_test(soil_on_rigid_rock_is_amplified_by_its_damping),
      cmocka_unit_test(soil_on_rigid_rock_has_the_frequencies_of_a_layer),
      cmocka_unit_test(dashpots_do_nothing_at_rest),
      cmocka_unit_test(a_body_is_braked_by_its_faces),
      cmocka_unit_test(each_material_of_a_face_has_its_own_impedance),
      cmocka_unit_test(wrong_dashpots_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

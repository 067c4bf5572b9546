/* Damping in proportion to stiffness in explicit steps: against closed forms, and against implicit steps. */
#include "solver/explicit.h"
#include "support.h"

#include <complex.h>
#include <unistd.h>

/* A bar of 20 m with waves of 200 m/s, density 2 and area 1: a shear column of these numbers has the same equations. */
#define BAR                                                                                                            \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic-1d, Young modulus: 8e4, density: 2}}\n"                                              \
  "body: {bar: {material: m, lattice: line, spacing: 0.5, area: 1, shape: {box: {particles: [40, 1], first "           \
  "particle: [0.25, 0]}}}}\n"                                                                                          \
  "peridynamics: {formulation: bond-based, space: 1-D, surface correction: energy}\n"

static const double pi = 3.14159265358979323846, height = 20, speed = 200;

/** Velocities of the n-th mode of a bar that is held at x-. */
static void strike(breccia_model *m, int mode)
{
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->velocity.row[0][i] = 1e-3 * sin((2 * mode - 1) * pi * p->position[0][i] / (2 * height));
  }
}

/** Kinetic and stored energy after some time. */
static double energy_at(breccia_model *m, double time)
{
  while (breccia_model_time(m) < time - 1e-12) step_surely(m, 1);
  const Energy e = solver_energy(&m->solver);
  return e.kinetic + e.stored;
}

/** Energies fall by exp(-2 zeta omega t), with zeta = alpha / (2 omega) + b omega / 2. */
static void modes_decay_by_their_ratios(void **state)
{
  (void)state;
  static const struct {
    const char *damping;
    double ratio[3];
  } cases[] = {{"stiffness damping: 1 ms", {7.854e-3, 23.56e-3, 39.27e-3}},
               {"Rayleigh damping: {ratio: 0.03, from: 2.5 Hz, to: 12.5 Hz}", {0.03, 0.0233, 0.03}}};
  for (int c = 0; c < 2; ++c)
    for (int mode = 1; mode <= 3; ++mode) {
      const double f = (2 * mode - 1) * 2.5, zeta = cases[c].ratio[mode - 1];
      breccia_model *m = model_of(BAR "loads: [{on: {face: x-}, support: {held: all}}]\n"
                                      "solve: {explicit: {end time: %g, safety: 0.3, %s}}\n",
                                  4 / f + 0.05 / f, cases[c].damping);
      strike(m, mode);
      const double first = energy_at(m, 0.05 / f), last = energy_at(m, 4 / f + 0.0499 / f);
      assert_near(log(first / last) / (4 * pi * 4), zeta, 0.03 * zeta);
      assert_balanced(m, 1e-7);
      assert_true(solver_energy(&m->solver).damping > 0);
      breccia_model_destroy(&m);
    }
}

/** Rows of a column in the plane that move as one have the same ratios: what ties share includes the drag. */
static void tied_rows_decay_by_their_ratio(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {m: {model: elastic, Young modulus: 2e5, Poisson ratio: 0.25, density: 2}}\n"
                              "body: {soil: {material: m, lattice: square, thickness: 1, spacing: 1, shape: {box: "
                              "{from: [0, 0], to: [4, 20]}}}}\n"
                              "peridynamics: {space: plane strain}\n"
                              "loads:\n"
                              "  - {on: {face: y-}, support: {held: all}}\n"
                              "  - {on: {face: x+, layers: 3}, tie: {to: {face: x-}, directions: x}}\n"
                              "  - {on: {all: yes}, roller: [0, 1]}\n"
                              "solve: {explicit: {end time: 1.62, stiffness damping: 4 ms}}\n");
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n)
    p->velocity.row[0][p->place_of[n]] = 1e-3 * sin(pi * p->position[1][p->place_of[n]] / (2 * height));
  const double first = energy_at(m, 0.02), last = energy_at(m, 1.62), zeta = pi * 4e-3 * 2.5;
  assert_near(log(first / last) / (4 * pi * 4), zeta, 0.03 * zeta);
  assert_balanced(m, 1e-6);
  breccia_model_destroy(&m);
}

/** What the surface of a layer does that is damped by alpha and b and shaken from below, over what the rock does:
 *  -omega^2 u + i omega alpha u - c^2 (1 + i omega b) u'' = omega^2, u the motion against the rock. */
static double amplification(double f, double alpha, double b)
{
  const double omega = 2 * pi * f;
  const double complex inertia = omega * omega - I * omega * alpha;
  const double complex k = csqrt(inertia / (speed * speed * (1 + I * omega * b)));
  return cabs(1 - omega * omega / inertia * (1 - 1 / ccos(k * height)));
}

/** Soil on rigid rock with one ratio at two frequencies: steady shaking at them and in between. */
static void soil_is_amplified_by_two_point_damping(void **state)
{
  (void)state;
  const double ratio = 0.05, from = 2.5, to = 12.5, alpha = 4 * pi * ratio * from * to / (from + to),
               b = ratio / (pi * (from + to));
  const double frequencies[] = {2.5, 5, 7.5, 12.5};
  for (int n = 0; n < 4; n += under_sanitizers() ? 3 : 1) {
    const double f = frequencies[n], omega = 2 * pi * f;
    breccia_model *m =
        model_of(BAR "loads:\n  - {on: {face: x-}, support: {held: all}}\n"
                     "  - {base acceleration: [1, 0], history: {sine: {frequency: %g}}}\n"
                     "solve: {explicit: {end time: 6, Rayleigh damping: {ratio: %g, from: %g, to: %g}}}\n",
                 f, ratio, from, to);
    int32_t top = 0;
    const Particles *p = m->domain.particles;
    for (int64_t k = 0; k < p->count; ++k)
      if (p->position[0][p->place_of[k]] > p->position[0][top]) top = p->place_of[k];
    double in = 0, across = 0;
    while (!solver_is_done(&m->solver)) {
      const double before = breccia_model_time(m);
      step_surely(m, 1);
      const double t = breccia_model_time(m), step = t - fmax(before, 5.2);
      if (t <= 5.2) continue;
      in += 2 * step / 0.8 * p->velocity.row[0][top] * sin(omega * t);
      across += 2 * step / 0.8 * p->velocity.row[0][top] * cos(omega * t);
    }
    const double expected = amplification(f, alpha, b); /* the rock moves by -cos(omega t) / omega */
    assert_near(hypot(in, across - 1 / omega) * omega, expected, 0.04 * expected);
    breccia_model_destroy(&m);
  }
  assert_near(amplification(2.5, alpha, b), 1 / sinh(pi * ratio / 2),
              0.02 * 12.7); /* as with damping alike at all frequencies */
}

/** A motion in a file of its own, of velocities. */
static breccia_motion *motion_of(FILE *file, const char *path)
{
  const breccia_motion_file from = {.size = sizeof from, .path = path, .unit = "m/s"};
  breccia_motion *motion = NULL;
  breccia_error *error = breccia_error_create();
  fclose(file);
  if (breccia_motion_load(&from, &motion, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  unlink(path);
  return motion;
}

static double burst(double t)
{
  return t <= 0 || t >= 0.4 ? 0 : sin(2 * pi * 6 * t) * fmin(5 * t, 2 - 5 * t);
}

/** One burst tells the whole transfer function: frequencies of the layer within 2 %, amplification within 5 % of the closed form. */
static void a_burst_tells_the_transfer_function(void **state)
{
  (void)state;
  const double ratio = 0.05, from = 2.5, to = 7.5, alpha = 4 * pi * ratio * from * to / (from + to),
               b = ratio / (pi * (from + to));
  breccia_model *m =
      model_of(BAR "loads:\n  - {on: {face: x-}, support: {held: all}}\n"
                   "  - {base acceleration: [1, 0], history: {sine: {frequency: 6 Hz, envelope: [[0, 0], "
                   "[0.2, 1], [0.4, 0]]}}}\n"
                   "solve: {explicit: {end time: 8, safety: 0.9, Rayleigh damping: {ratio: %g, from: "
                   "%g, to: %g}}}\n",
               ratio, from, to);
  const Particles *p = m->domain.particles;
  int32_t top = p->place_of[0];
  for (int64_t k = 0; k < p->count; ++k)
    if (p->position[0][p->place_of[k]] > p->position[0][top]) top = p->place_of[k];
  char paths[2][32] = {"/tmp/breccia-XXXXXX", "/tmp/breccia-XXXXXX"};
  FILE *files[2];
  for (int k = 0; k < 2; ++k) assert_non_null(files[k] = fdopen(mkstemp(paths[k]), "w"));
  double ground = 0;
  while (!solver_is_done(&m->solver)) { /* the ground's velocity by the trapezium rule over many points of a step */
    const double t = breccia_model_time(m);
    fprintf(files[0], "%.17g %.17g\n", t, p->velocity.row[0][top] + ground);
    fprintf(files[1], "%.17g %.17g\n", t, ground);
    step_surely(m, 1);
    const double step = breccia_model_time(m) - t;
    for (int k = 0; k < 8; ++k) ground += step / 16 * (burst(t + k * step / 8) + burst(t + (k + 1) * step / 8));
  }
  breccia_motion *above = motion_of(files[0], paths[0]), *below = motion_of(files[1], paths[1]);
  const breccia_motion_wish wish = {.size = sizeof wish, .damping = 0.05, .shortest = 1, .longest = 1, .smoothing = 0};
  breccia_error *error = breccia_error_create();
  if (breccia_motion_analyse(above, below, &wish, error)) fail_msg("%s", breccia_error_text(error));
  const int rows = breccia_motion_rows(above, BRECCIA_MOTION_FOURIER);
  const double *f = breccia_motion_column(above, BRECCIA_MOTION_FOURIER, 0),
               *found = breccia_motion_column(above, BRECCIA_MOTION_FOURIER, 3);
  for (int n = 1; n <= 2; ++n) {
    const double wanted = (2 * n - 1) * 2.5;
    int peak = 0;
    for (int k = 0; k < rows; ++k)
      if (f[k] > wanted - 1.5 && f[k] < wanted + 1.5 && (!peak || found[k] > found[peak])) peak = k;
    assert_near(f[peak], wanted, 0.02 * wanted);
    assert_near(found[peak], amplification(wanted, alpha, b), 0.05 * amplification(wanted, alpha, b));
  }
  breccia_motion_destroy(&above);
  breccia_motion_destroy(&below);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
}

/** Solids that yield or are damaged are damped by their elastic stiffness, in explicit as in implicit steps. */
static void what_yields_is_damped_by_its_elastic_stiffness(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 0.03",
                                        "implicit: {end time: 0.03, time step: 2e-4, local error: 1"};
  static const char *const laws[] = {
      "j2, bulk modulus: 6666, shear modulus: 4000, density: 2, yield stress: 20",
      "mazars, bulk modulus: 6666, shear modulus: 4000, density: 2, tensile strength: 25, fracture "
      "energy: 0.4"};
  for (int law = under_sanitizers(); law < 2; ++law) {
    double damping[2], dissipated[2];
    for (int k = 0; k < 2; ++k) {
      breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                                  "materials: {m: {model: %s}}\n"
                                  "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: "
                                  "{particles: [12, 6]}}}}\n"
                                  "peridynamics: {space: plane strain}\n"
                                  "loads:\n  - {on: {face: x-}, support: {held: all}}\n"
                                  "  - {on: {face: x+}, force: [%s], history: {sine: {frequency: 40 Hz}}}\n"
                                  "solve: {%s, stiffness damping: 2 ms}}\n",
                                  laws[law], law ? "24, 4" : "30, 10", solvers[k]);
      while (!solver_is_done(&m->solver)) step_surely(m, 1);
      const Energy e = solver_energy(&m->solver);
      damping[k] = e.damping;
      dissipated[k] = e.dissipated;
      assert_balanced(m, 1e-2);
      breccia_model_destroy(&m);
    }
    assert_true(dissipated[1] > 0.1 * damping[1] && damping[1] > 0.1 * dissipated[1]);
    assert_near(damping[0], damping[1], 0.03 * damping[1]);
    assert_near(dissipated[0], dissipated[1],
                (law ? 0.2 : 0.03) * dissipated[1]); /* what softens leaves no one answer */
  }
}

/** What may yield and does not is damped as an elastic body is, in the plane across which it may strain, too. */
static void what_does_not_yield_is_damped_as_elastic_bodies_are(void **state)
{
  (void)state;
  static const char *const spaces[] = {"plane strain", "plane stress"}, *const laws[] = {"elastic",
                                                                                         "j2, yield stress: 1e9"};
  for (int s = 0; s < 2; ++s) {
    breccia_model *m[2];
    for (int k = 0; k < 2; ++k) {
      m[k] =
          model_of("units: {length: m, force: kN, time: s}\n"
                   "materials: {m: {model: %s, bulk modulus: 6666, shear modulus: 4000, density: 2}}\n"
                   "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [8, "
                   "4]}}}}\n"
                   "peridynamics: {space: %s}\n"
                   "loads:\n  - {on: {face: x-}, support: {held: all}}\n  - {on: {face: x+}, force: [3, 1]}\n"
                   "solve: {implicit: {end time: 4e-3, time step: 2e-4, local error: 1e9, residual: 1e-11, stiffness "
                   "damping: 2 ms}}\n",
                   laws[k], spaces[s]);
      while (!solver_is_done(&m[k]->solver)) step_surely(m[k], 1);
    }
    const Particles *one = m[0]->domain.particles, *other = m[1]->domain.particles;
    double most = 0;
    for (int64_t i = 0; i < one->places; ++i) most = larger_of(most, fabs(one->displacement.row[0][i]));
    for (int k = 0; k < 2; ++k)
      for (int64_t i = 0; i < one->places; ++i)
        assert_near(other->displacement.row[k][i], one->displacement.row[k][i], 1e-8 * most);
    const double damping = solver_energy(&m[0]->solver).damping;
    assert_true(most > 0 && damping > 0);
    assert_near(solver_energy(&m[1]->solver).damping, damping, 1e-7 * damping);
    for (int k = 0; k < 2; ++k) breccia_model_destroy(&m[k]);
  }
}

/** sqrt(b^2 + s^2) - b: just below it nothing grows, just above it everything. */
static void the_stable_step_is_shorter(void **state)
{
  (void)state;
  breccia_model *free = model_of(BAR "solve: {explicit: {steps: 1}}\n");
  const double plain = breccia_model_stable_time_step(free), b = 2e-3;
  breccia_model_destroy(&free);
  for (int k = 0; k < 2; ++k) {
    const double step = (k ? 1.02 : 0.985) * (sqrt(b * b + plain * plain) - b);
    const breccia_options options = {.size = sizeof options, .force = 1};
    char deck[1024];
    snprintf(deck, sizeof deck, BAR "solve: {explicit: {steps: 3000, time step: %.9g, stiffness damping: %g}}\n", step,
             b);
    breccia_model *m = NULL;
    breccia_error *error = breccia_error_create();
    if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
    assert_near(breccia_model_stable_time_step(m), sqrt(b * b + plain * plain) - b, 1e-3 * plain);
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n) p->velocity.row[0][p->place_of[n]] = n % 2 ? 1e-3 : -1e-3;
    double first = 0, most = 0;
    for (int n = 0; n < 3000 && isfinite(most) && most < 1; ++n) {
      if (breccia_model_step(m, 1, error)) {
        most = INFINITY;
        break;
      }
      most = solver_energy(&m->solver).kinetic;
      if (!n) first = most;
    }
    if (k)
      assert_true(most > 10 * first);
    else
      assert_true(most < first);
    breccia_error_destroy(&error);
    breccia_model_destroy(&m);
  }
}

/** What breaks in a step is judged as if there were no damping: with next to none the same bonds break in the same steps. */
static void bonds_break_as_without(void **state)
{
  (void)state;
  static const char *const criteria[] = {"critical stretch: 0.02",
                                         "criterion: critical bond energy, fracture energy: 0.5"};
  for (int c = 0; c < 2; ++c) {
    double broken[2] = {0}, moved[2];
    for (int k = 0; k < 2; ++k) {
      breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n" SOFT_SOLID
                                  "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: "
                                  "{particles: [16, 12]}}}}\n"
                                  "cracks: [{cut: {line: [[0.8, -0.1], [0.8, 0.4]]}}]\n"
                                  "peridynamics: {space: plane strain, formulation: ordinary}\n"
                                  "failure: {%s}\n"
                                  "loads:\n  - {on: {face: x-, layers: 3}, velocity: [-0.6, 0]}\n"
                                  "  - {on: {face: x+, layers: 3}, velocity: [0.6, 0]}\n"
                                  "solve: {explicit: {steps: 150, time step: 2e-4%s}}\n",
                                  criteria[c], k ? ", stiffness damping: 1e-14" : "");
      while (!solver_is_done(&m->solver)) {
        step_surely(m, 1);
        broken[k] += (double)breccia_model_broken_bonds(m) * (double)m->solver.clock.step;
      }
      moved[k] = m->domain.particles->displacement.row[0][m->domain.particles->place_of[5]];
      if (breccia_model_broken_bonds(m) < 10) fail_msg("%lld", (long long)breccia_model_broken_bonds(m));
      breccia_model_destroy(&m);
    }
    assert_true(broken[0] == broken[1]);
    assert_near(moved[0], moved[1], 1e-9);
  }
}

static void wrong_damping_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *keys, *words;
  } wrong[] = {
      {"solve: {explicit: {steps: 1, damping: 5, Rayleigh damping: {ratio: 0.05, from: 1, to: 2}}}",
       "damping: 'Rayleigh damping' says it already"},
      {"solve: {explicit: {steps: 1, stiffness damping: 1e-3, Rayleigh damping: {ratio: 0.05, from: 1, to: 2}}}",
       "stiffness damping: 'Rayleigh damping' says it already"},
      {"contact: {}\nsolve: {explicit: {steps: 1, stiffness damping: 1e-3}}",
       "stiffness damping: 'contact' has no place in it yet; leave 'contact' out"},
      {"bars: {rod: {points: [[1, 0, 0], [4, 0, 0]], area: 1e-4, material: m}}\nsolve: {explicit: {steps: 1, "
       "stiffness damping: 1e-3}}",
       "stiffness damping: 'bars' has no place in it yet; leave 'bars' out"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, BAR "%s\n", wrong[k].keys);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    free(words);
  }
}

/** The toe of a dam on a base that is held in all directions. */
static breccia_model *toe(const char *held, const char *stage)
{
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials: {m: {model: elastic, density: 2.4, Young modulus: 3e6, Poisson ratio: 0.25}}\n"
                  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {polygon: {corners: "
                  "[[0, 0], [2, 0], "
                  "[1, 1], [0, 1]]}}}}\n"
                  "peridynamics: {formulation: correspondence, space: plane strain}\n"
                  "loads: [{on: {face: y-}, support: {held: %s}}, {gravity: [0, -9.81]}]\n"
                  "solve: {%s}\n",
                  held, stage);
}

/** The stiffness beside such a base is not symmetric, and its shortest waves grow: the deck is told, with what holds them. */
static void what_grows_beside_a_held_base_is_told_and_damped(void **state)
{
  (void)state;
  const struct {
    const char *held, *stage;
    bool told;
  } decks[] = {{"all", "explicit: {end time: 0.02}", true},
               {"all", "implicit: {end time: 0.02, time step: 1e-3}", true},
               {"all", "explicit: {end time: 0.02, damping: {ratio: 0.05, at: 287 Hz}}", true},
               {"all", "explicit: {end time: 0.02, local damping: 0.8}", false},
               {"all", "static: {increments: 1}", false},
               {"across", "explicit: {end time: 0.02}", false}};
  double advised = 0;
  for (size_t k = 0; k < sizeof decks / sizeof *decks; ++k) {
    breccia_model *m = toe(decks[k].held, decks[k].stage);
    const char *words = strstr(breccia_model_warnings(m), "grow by themselves"),
               *number = words ? strstr(words, "'stiffness damping: ") : NULL;
    if ((words != NULL) != decks[k].told)
      fail_msg("%s, %s: %s", decks[k].held, decks[k].stage, breccia_model_warnings(m));
    if (k == 0) {
      assert_non_null(number);
      advised = strtod(number + strlen("'stiffness damping: "), NULL);
    }
    breccia_model_destroy(&m);
  }
  char stage[100];
  snprintf(stage, sizeof stage, "explicit: {end time: 0.4, stiffness damping: %g}", advised);
  breccia_model *m = toe("all", stage);
  assert_null(strstr(breccia_model_warnings(m), "grow by themselves"));
  double first = 0;
  while (!solver_is_done(&m->solver)) {
    step_surely(m, 20);
    if (m->solver.clock.time < 0.02) first = larger_of(first, solver_energy(&m->solver).kinetic);
  }
  assert_true(solver_energy(&m->solver).kinetic < 1e-3 * first);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modes_decay_by_their_ratios),
      cmocka_unit_test(tied_rows_decay_by_their_ratio),
      cmocka_unit_test(soil_is_amplified_by_two_point_damping),
      cmocka_unit_test(a_burst_tells_the_transfer_function),
      cmocka_unit_test(what_yields_is_damped_by_its_elastic_stiffness),
      cmocka_unit_test(what_does_not_yield_is_damped_as_elastic_bodies_are),
      cmocka_unit_test(the_stable_step_is_shorter),
      cmocka_unit_test(bonds_break_as_without),
      cmocka_unit_test(wrong_damping_is_refused),
      cmocka_unit_test(what_grows_beside_a_held_base_is_told_and_damped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Frequencies and modes of vibration, beside closed forms. */
#include "support.h"

#include "base/folder_lock.h"
#include "results/picture.h"
#include "solver/modes.h"
#include <unistd.h>

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define BAR                                                                                                            \
  UNITS "materials: {m: {model: elastic-1d, Young modulus: 1e6, density: 2}}\n"                                        \
        "body: {bar: {material: m, lattice: line, spacing: 0.05, area: 0.01, shape: {box: {particles: [80, 1]}}}}\n"   \
        "peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings, surface correction: energy}\n"

static Modes modes_of(breccia_model *model, int count)
{
  Modes modes = {0};
  Error *error = breccia_error_create();
  if (modes_find(&model->domain, &model->loading, count, &modes, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  for (int n = 1; n < count; ++n) assert_true(modes.modes[n].frequency >= modes.modes[n - 1].frequency);
  return modes;
}

static void a_bar_vibrates_at_odd_quarters_of_its_wave(void **state)
{
  (void)state;
  /* Fixed and free: (2n - 1) c / 4L, with 8 / (pi (2n - 1))^2 of the mass. */
  const double pi = acos(-1), speed = sqrt(1e6 / 2), length = 77.5 * 0.05;
  breccia_model *m =
      model_of(BAR "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]\nsolve: {static: {increments: 1}}\n");
  Modes modes = modes_of(m, 4);
  assert_int_equal(modes.rigid, 0);
  for (int n = 0; n < 4; ++n) {
    const double odd = 2 * n + 1, wanted = odd * speed / (4 * length);
    assert_near(modes.modes[n].frequency, wanted, 0.01 * wanted);
    assert_near(modes.modes[n].share[0], 8 / pow(pi * odd, 2) * 77.5 / 80, 0.01);
    assert_near(modes.modes[n].share[1], 0, 1e-12);
  }
  modes_destroy(&modes);
  breccia_model_destroy(&m);
}

static void a_cantilever_bends_as_beams_do(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* the next beams are smaller */
  /* Euler and Bernoulli, less what shear and turning take: 1 - (1.875)^2 / 2 (r / L)^2 (1 + E / (k G)) about (Timoshenko 1921). */
  const double pi = acos(-1), depth = 0.8, length = 7.975, radius = depth / sqrt(12), first = 1.87510407,
               bending = first * first / (2 * pi * length * length) * sqrt(1e4 / 2) * radius,
               wanted = bending * (1 - first * first / 2 * pow(radius / length, 2) * (1 + 2.5 / (5.0 / 6)));
  double found[2];
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(UNITS SOFT_SOLID
                 "body: {b: {material: m, lattice: square, spacing: 0.05, thickness: 0.2, shape: {box: {particles: "
                 "[160, 16]}}}}\n"
                 "peridynamics: {formulation: %s, space: plane stress}\n"
                 "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}]\nsolve: {static: {increments: 1}}\n",
                 k ? "ordinary" : "correspondence");
    Modes modes = modes_of(m, 3);
    found[k] = modes.modes[0].frequency;
    if (!(fabs(found[k] - wanted) <= (k ? 0.08 : 0.03) * wanted)) fail_msg("%g instead of %g", found[k], wanted);
    assert_near(modes.modes[0].share[1], 0.613, 0.02); /* of the first mode of any slender cantilever */
    assert_int_equal(modes.rigid, 0);
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

static void beams_between_mirrored_layers_bend_as_beams_do(void **state)
{
  (void)state;
  /* Supported at x = 0: the layers outside are no part of the mass, and stiffness is not symmetric beside them. Frequencies as above; beyond the third
   * there are few shares of the mass left. */
  const double pi = acos(-1), depth = 0.8, length = 8, radius = depth / sqrt(12), roots[] = {1.87510407, 4.69409113},
               shares[] = {0.613, 0.188};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(UNITS SOFT_SOLID
                 "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: "
                 "[80, 8]}}}}\n"
                 "peridynamics: {formulation: %s, space: plane stress}\n"
                 "loads: [{on: {face: x-}, support: {held: all}}]\nsolve: {static: {increments: 1}}\n",
                 k ? "ordinary" : "correspondence");
    Modes modes = modes_of(m, 6);
    double sums[3] = {0};
    assert_int_equal(modes.rigid, 0);
    for (int n = 0; n < 6; ++n)
      for (int a = 0; a < 3; ++a) sums[a] += modes.modes[n].share[a];
    for (int n = 0; n < 2; ++n) {
      const double slender = pow(roots[n] / length, 2) * sqrt(1e4 / 2) * radius / (2 * pi);
      const double thick = 1 - (n ? 12.5 : 1) * pow(roots[0] * radius / length, 2) / 2 * (1 + 2.5 / (5.0 / 6));
      if (!(fabs(modes.modes[n].frequency - slender * thick) <= 0.1 * slender))
        fail_msg("mode %d: %g instead of %g", n + 1, modes.modes[n].frequency, slender * thick);
      assert_near(modes.modes[n].share[1], shares[n], 0.02);
    }
    assert_true(sums[0] > 0.78 && sums[0] < 1 && sums[1] > 0.9 &&
                sums[1] < 1); /* one of them stretches the beam: 8 / pi^2 */
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

/** Returns the lowest frequency of two sheared layers of one thickness and density between walls:
 *    c_2 sin(w H / c_1) cos(w H / c_2) + c_1 cos(w H / c_1) sin(w H / c_2) = 0,
 *  by continuity of displacement and traction. */
static double frequency_of_layers(double thickness, double density, double lower, double upper)
{
  const double below = sqrt(lower / density), above = sqrt(upper / density), slower = fmin(below, above);
  double low = acos(-1) / 2 * slower / thickness, high = 2 * low;
  for (int n = 0; n < 60; ++n) {
    const double w = (low + high) / 2, one = w * thickness / below, two = w * thickness / above;
    *(above * sin(one) * cos(two) + below * cos(one) * sin(two) > 0 ? &low : &high) = w;
  }
  return low / (2 * acos(-1));
}

/** Returns the lowest frequency of two sheared layers, each 10 m high, over the closed form, less 1. */
static double error_of_layers(const char *formulation, double lower, double upper, double spacing)
{
  breccia_model *m = model_of(
      UNITS "materials:\n"
            "  lower: {model: elastic, density: 2, shear modulus: %g, bulk modulus: %g}\n"
            "  upper: {model: elastic, density: 2, shear modulus: %g, bulk modulus: %g}\n"
            "body:\n"
            "  lower: {material: lower, lattice: square, spacing: %g, thickness: 1, shape: {box: {from: [0, -10], to: "
            "[%g, 0]}}}\n"
            "  upper: {material: upper, lattice: square, spacing: %g, thickness: 1, shape: {box: {from: [0, 0], to: "
            "[%g, 10]}}}\n"
            "peridynamics: {formulation: %s, space: plane strain}\n"
            "loads: [{on: {block: lower, face: x-}, support: {held: periodic}}, {on: {block: upper, face: x-}, "
            "support: {held: "
            "periodic}}, {on: {block: lower, face: y-}, support: {held: all}}, {on: {block: upper, face: y+}, support: "
            "{held: all}}]\nsolve: {static: {increments: 1}}\n",
      lower, 2 * lower, upper, 2 * upper, spacing, 2 * spacing, spacing, 2 * spacing, formulation);
  Modes modes = modes_of(m, 1);
  const double found = modes.modes[0].frequency / frequency_of_layers(10, 2, lower, upper) - 1;
  modes_destroy(&modes);
  breccia_model_destroy(&m);
  return found;
}

static void layers_of_unlike_stiffness_vibrate_as_in_closed_form(void **state)
{
  (void)state;
  static const double cases[][2] = {{3e4, 3e4}, {3e4, 3e3}, {3e4, 3e2}};
  static const char *const formulations[] = {"hybrid", "ordinary"};
  for (size_t k = 0; k < 2 * sizeof cases / sizeof *cases; ++k) {
    const char *formulation = formulations[k % 2];
    const double lower = cases[k / 2][0], upper = cases[k / 2][1],
                 coarse = error_of_layers(formulation, lower, upper, 2),
                 fine = error_of_layers(formulation, lower, upper, 1);
    if (!(fabs(fine) < 0.015 && coarse / fine > 3.3 && coarse / fine < 4.5))
      fail_msg("%s, %g on %g: errors of %.2g at 5 rows and %.2g at 10 are not of second order", formulation, upper,
               lower, coarse, fine);
  }
}

static double overlap(const breccia_model *model, const Mode *a, const Mode *b)
{
  const Particles *p = model->domain.particles;
  double product = 0, sizes[2] = {0};
  for (int k = 0; k < 3; ++k)
    for (int64_t n = 0; n < p->count; ++n) {
      if (body_outside(&model->domain.body, n)) continue;
      const int32_t i = p->place_of[n];
      const double mass = p->density[i] * p->volume[i], u = a->displacement.row[k][i], v = b->displacement.row[k][i];
      product += mass * u * v;
      sizes[0] += mass * u * u;
      sizes[1] += mass * v * v;
    }
  return fabs(product) / sqrt(sizes[0] * sizes[1]);
}

static void modes_between_mirrored_layers_are_nearly_orthogonal(void **state)
{
  (void)state;
  /* A square plate held on all sides has pairs of modes of one frequency, whose stiffness is not symmetric. Those of a pair are parted; modes of
   * different frequencies share what docs/choosing.md says. */
  static const char *const kinds[] = {"correspondence", "ordinary"};
  for (int f = 0; f < 2; ++f) {
    breccia_model *m = model_of(
        UNITS SOFT_SOLID
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [12, 12]}}}}\n"
        "peridynamics: {formulation: %s, space: plane stress}\n"
        "loads: [{on: {face: x-}, support: {held: all}}, {on: {face: x+}, support: {held: all}}, {on: {face: y-}, "
        "support: {held: all}}, {on: {face: y+}, support: {held: all}}]\nsolve: {static: {increments: 1}}\n",
        kinds[f]);
    Modes modes = modes_of(m, 8);
    int pairs = 0;
    double most = 0;
    for (int r = 0; r < 8; ++r)
      for (int c = 0; c < r; ++c) {
        const bool equal = fabs(modes.modes[r].frequency - modes.modes[c].frequency) < 1e-4 * modes.modes[r].frequency;
        const double shared = overlap(m, &modes.modes[r], &modes.modes[c]);
        pairs += equal;
        if (equal) assert_near(shared, 0, 1e-9);
        most = larger_of(most, shared);
      }
    assert_true(pairs > 0);
    assert_true(most < 0.05);
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

static void a_free_body_moves_as_a_whole_in_so_many_ways(void **state)
{
  (void)state;
  static const struct {
    const char *deck;
    int rigid;
  } bodies[] = {
      {SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                  "peridynamics: {formulation: correspondence, space: 3-D}\n",
       6},
      {SOFT_SOLID
       "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 6]}}}}\n"
       "peridynamics: {formulation: ordinary, space: plane strain}\n",
       3},
      {SOFT_SOLID
       "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 6]}}}}\n"
       "peridynamics: {formulation: correspondence, space: plane stress}\n"
       "loads: [{on: {face: y-, layers: 1}, roller: [0, 1]}]\n",
       1}};
  for (int b = 0; b < 3; ++b) {
    breccia_model *m = model_of(UNITS "%ssolve: {explicit: {steps: 1}}\n", bodies[b].deck);
    Modes modes = modes_of(m, 8);
    assert_int_equal(modes.rigid, bodies[b].rigid);
    assert_true(modes.modes[modes.rigid].frequency > 1);
    for (int r = 0; r < 8; ++r)
      for (int c = 0; c < r; ++c) assert_near(overlap(m, &modes.modes[r], &modes.modes[c]), 0, 1e-7); /* by mass */
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

static void modes_are_those_of_elastic_laws(void **state)
{
  (void)state;
  /* Stretched to five times the strain at which its law begins to soften a bar has the modes that it had before, and its forces stay as they were. */
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: mazars, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2, tensile strength: "
      "3000, fracture energy: 0.1}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 1, shape: {box: {particles: [20, 6]}}}}\n"
      "peridynamics: {space: plane stress, strain: small}\n"
      "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]}]\nsolve: {static: {increments: 1}}\n");
  const Particles *p = m->domain.particles;
  Modes before = modes_of(m, 3);
  for (int64_t n = 0; n < p->count; ++n) p->displacement.row[0][p->place_of[n]] = 5e-4 * p->position[0][p->place_of[n]];
  compute_forces(m);
  double *forces = malloc(sizeof(double) * (size_t)p->places);
  assert_non_null(forces);
  memcpy(forces, p->internal.row[0], sizeof(double) * (size_t)p->places);
  Modes after = modes_of(m, 3);
  for (int n = 0; n < 3; ++n)
    assert_near(after.modes[n].frequency, before.modes[n].frequency, 1e-6 * before.modes[n].frequency);
  assert_false(domain_in_elastic_stage(&m->domain));
  assert_memory_equal(forces, p->internal.row[0], sizeof(double) * (size_t)p->places);
  free(forces);
  modes_destroy(&before);
  modes_destroy(&after);
  breccia_model_destroy(&m);
}

static void pictures_say_which_mode_they_show(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", path[64], words[96], command[64];
  assert_non_null(mkdtemp(folder));
  breccia_model *m =
      model_of(BAR "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]\nsolve: {static: {increments: 1}}\n");
  const breccia_modes wish = {.size = sizeof wish, .folder = folder, .count = 2};
  Error *error = breccia_error_create();
  if (breccia_model_modes(m, &wish, error)) fail_msg("%s", breccia_error_text(error));
  ResultView view;
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  assert_int_equal(result_view_open(&view, path, error), 0);
  picture_time(&view, 1, false, words, sizeof words);
  assert_string_equal(words, "mode 2, 136 Hz"); /* 3 c / 4L but for what the horizon takes */
  picture_name(&view, 1, "displacement", "x", true, words, sizeof words);
  assert_string_equal(words, "displacement-x-mode-2");
  result_view_close(&view);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

/** What results hold of a mode is its shape, in every direction, its largest component a tenth of the body's largest length. */
static void pictures_show_modes_as_they_are(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", path[64], command[64];
  assert_non_null(mkdtemp(folder));
  breccia_model *m = model_of(UNITS SOFT_SOLID
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 5, 3]}}}}\n"
                              "peridynamics: {horizon: 2.015 spacings}\nloads: [{on: {face: x-}, displacement: [0, 0, "
                              "0]}]\nsolve: {static: {increments: 1}}\nresults: {precision: double}\n");
  Modes modes = modes_of(m, 4); /* two that bend, one that twists, one that bends again */
  const breccia_modes wish = {.size = sizeof wish, .folder = folder, .count = 4};
  Error *error = breccia_error_create();
  if (breccia_model_modes(m, &wish, error)) fail_msg("%s", breccia_error_text(error));
  const Particles *p = m->domain.particles;
  for (int64_t i = 0; i < p->places; ++i)
    for (int k = 0; k < 3; ++k) assert_true(p->displacement.row[k][i] == 0); /* the body itself is where it was */
  ResultView view;
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  assert_int_equal(result_view_open(&view, path, error), 0);
  assert_int_equal(view.steps, 4);
  for (int n = 0; n < 4; ++n) {
    int components;
    double *shown = result_view_read(&view, "displacement", n, &components, NULL, error), most = 0, length = 0,
           largest = 0, sign = 0;
    assert_non_null(shown);
    assert_int_equal(components, 3);
    assert_near(view.times[n], n + 1, 0);
    for (int64_t a = 0; a < p->count; ++a) {
      double squares[2] = {0};
      for (int k = 0; k < 3; ++k) {
        const double shape = modes.modes[n].displacement.row[k][p->place_of[a]];
        squares[0] += shape * shape;
        squares[1] += shown[3 * a + k] * shown[3 * a + k];
        sign += shape * shown[3 * a + k];
        largest = larger_of(largest, fabs(shown[3 * a + k]));
      }
      most = larger_of(most, sqrt(squares[0]));
      length = larger_of(length, sqrt(squares[1]));
    }
    assert_near(largest, 0.1 * 0.8, 1e-9); /* from the first centre to the last */
    for (int64_t a = 0; a < p->count; ++a)
      for (int k = 0; k < 3; ++k)
        assert_near(shown[3 * a + k] / length * (sign < 0 ? -1 : 1),
                    modes.modes[n].displacement.row[k][p->place_of[a]] / most, 1e-4);
    free(shown);
  }
  result_view_close(&view);
  modes_destroy(&modes);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void expect_refusal(breccia_model *model, const breccia_modes *wish, const char *words)
{
  Error *error = breccia_error_create();
  assert_int_equal(breccia_model_modes(model, wish, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), words));
  breccia_error_destroy(&error);
}

static void results_of_runs_are_not_written_over(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", path[64], command[64];
  assert_non_null(mkdtemp(folder));
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]}]\nsolve: {explicit: "
                                  "{steps: 1}}\n");
  const breccia_modes wish = {.size = sizeof wish, .folder = folder, .count = 2};
  Error *error = breccia_error_create();
  FolderLock lock; /* a run is under way */
  assert_int_equal(folder_lock_take(&lock, folder, error), 0);
  expect_refusal(m, &wish, "another run writes into this folder");
  folder_lock_return(&lock);
  for (int n = 0; n < 2; ++n) /* modes give way to modes */
    if (breccia_model_modes(m, &wish, error)) fail_msg("%s", breccia_error_text(error));
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  expect_refusal(m, &wish, "holds the results of a run");
  ResultView view;
  snprintf(path, sizeof path, "%s/results.vtkhdf", folder);
  assert_int_equal(result_view_open(&view, path, error), 0);
  assert_null(view.frequencies);
  result_view_close(&view);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static void springs_ties_and_supports_are_felt(void **state)
{
  (void)state;
  /* A block that its springs carry: omega^2 = k / m along x. Half of it beyond a plane of symmetry has the whole one's symmetric modes. */
  breccia_model *m = model_of(BAR "loads: [{on: {all: yes}, spring: {stiffness: 8}}]\nsolve: {explicit: {steps: 1}}\n");
  Modes modes = modes_of(m, 2);
  assert_near(modes.modes[0].frequency, sqrt(8 / 0.08) / (2 * acos(-1)), 1e-6);
  assert_near(modes.modes[0].share[0], 1, 1e-6);
  modes_destroy(&modes);
  breccia_model_destroy(&m);
  /* Tied ends move together: of a free bar's modes n c / 2L those with even n are left. With springs nothing is assembled. */
  for (int k = 0; k < 2; ++k) {
    m = model_of(BAR
                 "loads: [{on: {nearest: [0, 0]}, tie: {to: {nearest: [3.95, 0]}}}%s]\nsolve: {explicit: {steps: 1}}\n",
                 k ? ", {on: {all: yes}, spring: {stiffness: 1e-12}}" : "");
    modes = modes_of(m, 3);
    assert_int_equal(modes.rigid, 1);
    assert_near(modes.modes[1].frequency, sqrt(1e6 / 2) / 4, 0.02 * sqrt(1e6 / 2) / 4);
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

static void soft_springs_hold(void **state)
{
  (void)state;
  /* 1e-9 and 1e-10 of the squared frequency of waves along the bar: omega^2 = k / m. In space a block on springs at all of its particles has six such
   * modes, of which the shifts have one frequency. */
  static const double stiffness[] = {2.4e-6, 2.4e-7};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        BAR "loads: [{on: {all: yes}, spring: {stiffness: %g}}]\nsolve: {explicit: {steps: 1}}\n", stiffness[k]);
    Modes modes = modes_of(m, 2);
    const double wanted = sqrt(stiffness[k] / 0.08) / (2 * acos(-1));
    assert_int_equal(modes.rigid, 0);
    assert_near(modes.modes[0].frequency, wanted, 0.01 * wanted);
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
  breccia_model *m = model_of(UNITS SOFT_SOLID
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                              "peridynamics: {formulation: correspondence, space: 3-D}\n"
                              "loads: [{on: {all: yes}, spring: {stiffness: 1e-4}}]\nsolve: {explicit: {steps: 1}}\n");
  Modes modes = modes_of(m, 7);
  const double wanted = sqrt(1e-4 / (2 * 0.12)) / (2 * acos(-1));
  assert_int_equal(modes.rigid, 0);
  for (int n = 0; n < 6; ++n) assert_near(modes.modes[n].frequency, wanted, 0.2 * wanted);
  assert_true(modes.modes[6].frequency > 100 * wanted);
  modes_destroy(&modes);
  breccia_model_destroy(&m);
}

static void what_is_loose_at_rest_has_modes_too(void **state)
{
  (void)state;
  /* A deck of statics that nothing holds is refused, but where only modes are asked for. */
  static const char deck[] = UNITS SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [9, 6]}}}}\n"
      "peridynamics: {space: plane stress}\nsolve: {static: {increments: 1}}\n";
  const breccia_options options = {.size = sizeof options, .loose = 1};
  Error *error = breccia_error_create();
  breccia_model *m;
  char *words = refusal_of(deck);
  assert_non_null(strstr(words, "nothing holds the body"));
  free(words);
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  const breccia_modes wish = {.size = sizeof wish, .count = 4};
  if (breccia_model_modes(m, &wish, error)) fail_msg("%s", breccia_error_text(error));
  assert_non_null(strstr(breccia_model_outcome(m), "3 of them: nothing holds the body"));
  breccia_model *soft =
      model_of(UNITS SOFT_SOLID "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: "
                                "{particles: [9, 6]}}}}\nperidynamics: {space: plane stress}\n"
                                "loads: [{on: {all: yes}, spring: {stiffness: 1e-13}}]\nsolve: {static: {increments: "
                                "1}}\n");
  if (breccia_model_modes(soft, &wish, error)) fail_msg("%s", breccia_error_text(error));
  assert_non_null(strstr(breccia_model_outcome(soft), "3 of them: only springs too soft to show"));
  breccia_model_destroy(&soft);
  assert_int_equal(breccia_model_step(m, 1, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), "nothing holds the body"));
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

/** Of modes of one frequency, as bars of square section have them in pairs, none is left out, however many are asked for: Lanczos' iteration comes upon
 *  the second one only by roundings, which may be after it has ended. */
static void all_modes_of_one_frequency_are_found(void **state)
{
  (void)state;
  static const char *const bodies[] = {
      "peridynamics: {formulation: ordinary, space: 3-D}\n"
      "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0, 0]}, {on: {face: x+}, tie: {directions: x}}]\n",
      "peridynamics: {formulation: hybrid, space: 3-D}\n",
      "peridynamics: {formulation: correspondence, space: 3-D}\n"
      "loads: [{on: {face: x-}, support: {held: all}}]\n"};
  const int first = 11, last = under_sanitizers() ? 13 : 14;
  for (int b = 0; b < (under_sanitizers() ? 1 : 3); ++b) {
    double frequency[20] = {0};
    int equal = 0;
    for (int count = last; count >= first; count -= under_sanitizers() ? 2 : whole_walks() ? 1 : 3 - b % 2) {
      breccia_model *m = model_of("materials: {m: {density: 2400 kg/m3, model: elastic, Young modulus: 30 GPa, Poisson "
                                  "ratio: 0.2}}\n"
                                  "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                                  "%ssolve: {explicit: {steps: 1}}\n",
                                  bodies[b]);
      Modes modes = modes_of(m, count);
      for (int n = modes.rigid; n < count; ++n) {
        if (count == last) frequency[n] = modes.modes[n].frequency;
        if (!(fabs(modes.modes[n].frequency - frequency[n]) <= 1e-6 * frequency[n]))
          fail_msg("body %d: mode %d of %d has %.8g, of %d %.8g", b, n + 1, count, modes.modes[n].frequency, last,
                   frequency[n]);
        equal += n && fabs(frequency[n] / frequency[n - 1] - 1) < 1e-6;
        for (int before = modes.rigid; before < n && b < 2; ++before)
          assert_near(overlap(m, &modes.modes[n], &modes.modes[before]), 0, 1e-6);
      }
      modes_destroy(&modes);
      breccia_model_destroy(&m);
    }
    if (equal < 3) fail_msg("body %d: %d pairs", b, equal);
  }
}

static void more_modes_than_unknowns_are_refused(void **state)
{
  (void)state;
  breccia_model *m = model_of(BAR "solve: {explicit: {steps: 1}}\n");
  Modes modes = {0};
  Error *error = breccia_error_create();
  assert_int_equal(modes_find(&m->domain, &m->loading, 80, &modes, error), BRECCIA_USER_ERROR);
  assert_non_null(strstr(breccia_error_text(error), "80 modes are too many for a body with 80 unknowns"));
  breccia_error_destroy(&error);
  modes_destroy(&modes);
  breccia_model_destroy(&m);
}

static void modes_that_roundings_hide_are_not_told(void **state)
{
  (void)state;
  /* Springs 1e16 times as stiff as bonds: what bonds do is lost in the sums. */
  breccia_model *m = model_of(BAR "loads: [{on: {face: x-, layers: 3}, spring: {stiffness: 1e20}}]\nsolve: {explicit: "
                                  "{steps: 1}}\n");
  Modes modes = {0};
  Error *error = breccia_error_create();
  assert_int_equal(modes_find(&m->domain, &m->loading, 2, &modes, error), BRECCIA_FAILURE);
  assert_non_null(strstr(breccia_error_text(error), "the modes could not be found: equations with the body's"));
  breccia_error_destroy(&error);
  modes_destroy(&modes);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bar_vibrates_at_odd_quarters_of_its_wave),
      cmocka_unit_test(a_cantilever_bends_as_beams_do),
      cmocka_unit_test(beams_between_mirrored_layers_bend_as_beams_do),
      cmocka_unit_test(layers_of_unlike_stiffness_vibrate_as_in_closed_form),
      cmocka_unit_test(modes_between_mirrored_layers_are_nearly_orthogonal),
      cmocka_unit_test(a_free_body_moves_as_a_whole_in_so_many_ways),
      cmocka_unit_test(modes_are_those_of_elastic_laws),
      cmocka_unit_test(pictures_show_modes_as_they_are),
      cmocka_unit_test(pictures_say_which_mode_they_show),
      cmocka_unit_test(results_of_runs_are_not_written_over),
      cmocka_unit_test(springs_ties_and_supports_are_felt),
      cmocka_unit_test(soft_springs_hold),
      cmocka_unit_test(what_is_loose_at_rest_has_modes_too),
      cmocka_unit_test(all_modes_of_one_frequency_are_found),
      cmocka_unit_test(more_modes_than_unknowns_are_refused),
      cmocka_unit_test(modes_that_roundings_hide_are_not_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Bodies that go on beyond two opposite faces as they are: against closed forms, and against wider pieces of the same body. */
#include "solver/modes.h"
#include "support.h"

#define SOIL "materials: {m: {model: elastic, Young modulus: 2e5, Poisson ratio: 0.25, density: 2}}\n"
#define FIBRES "materials: {m: {model: elastic-1d, Young modulus: 2e5, density: 2}}\n"

/** (2 n - 1) Vs / 4 H of a column of soil, whatever the formulation. Bonds in the plane have a third as Poisson's ratio, and a shear modulus that
 *  depends on the direction by 2 %. */
static void a_column_has_the_frequencies_of_a_layer(void **state)
{
  (void)state;
  static const struct {
    const char *material, *body, *peridynamics, *sides;
    double speed, tolerance;
  } columns[] = {
      {SOIL, "lattice: square, thickness: 1, spacing: 1, shape: {box: {from: [0, 0], to: [4, 20]}}",
       "space: plane strain", "{on: {face: x-}, support: {held: periodic}}", 200, 2e-3},
      {SOIL, "lattice: square, thickness: 1, spacing: 1, shape: {box: {from: [0, 0], to: [4, 20]}}",
       "space: plane strain, horizon: 2.015 spacings, formulation: ordinary",
       "{on: {face: x+}, support: {held: periodic}}", 200, 2e-3},
      {SOIL, "lattice: square, thickness: 1, spacing: 1, shape: {box: {from: [0, 0], to: [4, 20]}}",
       "space: plane strain, horizon: 2.015 spacings, formulation: hybrid",
       "{on: {face: x-}, support: {held: periodic}}", 200, 5e-3},
      {FIBRES, "lattice: square, thickness: 1, spacing: 1, shape: {box: {from: [0, 0], to: [2, 20]}}",
       "space: plane stress, formulation: bond-based", "{on: {face: x-}, support: {held: periodic}}", 193.65, 0.02},
      {SOIL, "spacing: 1, shape: {box: {from: [0, 0, 0], to: [2, 20, 3]}}", "horizon: 1.5 spacings",
       "{on: {face: x-}, support: {held: periodic}}, {on: {face: z-}, support: {held: periodic}}", 200, 2e-3},
  };
  for (size_t c = 0; c < sizeof columns / sizeof *columns; ++c) {
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n%s"
                                "body: {soil: {material: m, %s}}\nperidynamics: {%s}\n"
                                "loads: [{on: {face: y-}, support: {held: all}}, %s]\n"
                                "solve: {explicit: {steps: 1}}\n",
                                columns[c].material, columns[c].body, columns[c].peridynamics, columns[c].sides);
    Modes modes = {0};
    assert_int_equal(modes_find(&m->domain, &m->loading, 2, &modes, NULL), 0);
    assert_near(modes.modes[0].frequency, columns[c].speed / 80, columns[c].tolerance * columns[c].speed / 80);
    modes_destroy(&modes);
    breccia_model_destroy(&m);
  }
}

static bool outside(const breccia_model *m, int64_t n)
{
  return body_outside(&m->domain.body, n);
}

/** A burst goes up and down a column: all particles of a row do the same, and nothing goes another way. */
static void plane_waves_stay_plane(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence, strain: small", "ordinary"};
  for (int f = 0; f < 2; ++f) {
    breccia_model *m =
        model_of("units: {length: m, force: kN, time: s}\n" SOIL
                 "body: {soil: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: "
                 "{from: [0, 0], to: [3, 20]}}}}\n"
                 "peridynamics: {space: plane strain, formulation: %s}\n"
                 "loads:\n"
                 "  - {on: {face: y-}, dashpots: {outcrop velocity: [1, 0]}, history: {sine: {frequency: 4 Hz, "
                 "envelope: [[0, 0], [0.25, 1], [0.5, 0]]}}}\n"
                 "  - {on: {face: x-}, support: {held: periodic}}\n"
                 "solve: {explicit: {end time: 0.3}}\n",
                 formulations[f]);
    const Particles *p = m->domain.particles;
    double most = 0;
    while (!solver_is_done(&m->solver)) step_surely(m, 1);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      double first = NAN, across = NAN; /* of its row */
      for (int64_t o = 0; o < p->count && isnan(first); ++o) {
        const int32_t other = p->place_of[o];
        if (outside(m, o) || fabs(p->position[1][other] - p->position[1][i]) > 1e-9) continue;
        first = p->velocity.row[0][other];
        across = p->velocity.row[1][other];
      }
      most = larger_of(most, fabs(first));
      assert_near(p->velocity.row[0][i], first, 1e-10);
      assert_near(p->velocity.row[1][i], f ? across : 0,
                  1e-10); /* bonds that turn lengthen: at finite strain shear swells */
    }
    assert_true(most > 0.5);
    breccia_model_destroy(&m);
  }
}

/** Velocities that repeat along x after 4, and neither along y nor in any other way. */
static void push(breccia_model *m)
{
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double angle = 2 * acos(-1) * p->position[0][i] / 4, y = p->position[1][i];
    p->velocity.row[0][i] = 0.3 * sin(angle + 0.4) * (1 + 0.3 * y) + 0.1;
    p->velocity.row[1][i] = 0.2 * cos(2 * angle) * y - 0.05;
  }
}

/** What repeats stays so: a piece of one period moves as a piece of two periods does, and keeps its momentum. */
static void one_period_moves_as_two(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence", "ordinary", "bond-based", "hybrid", "micropolar"};
  static const char *const solvers[] = {"explicit: {end time: 0.04, time step: 5e-4}",
                                        "implicit: {end time: 0.04, time step: 2e-3, local error: 1, residual: 1e-11}"};
  for (int f = 0; f < 5; ++f)
    for (int s = 0; s < (f ? 1 : 2); ++s) {
      breccia_model *pieces[2];
      double momentum[2] = {0};
      for (int k = 0; k < 2; ++k) {
        pieces[k] = model_of(
            "units: {length: m, force: kN, time: s}\n%s"
            "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: {from: [0, 0], to: "
            "[%d, 3]}}}}\n"
            "peridynamics: {space: plane stress, formulation: %s}\n"
            "loads: [{on: {face: x-}, support: {held: periodic}}]\nsolve: {%s}\n",
            f == 2 ? FIBRES : SOIL, 4 * (k + 1), formulations[f], solvers[s]);
        push(pieces[k]);
        const Particles *p = pieces[k]->domain.particles;
        for (int64_t n = 0; n < p->count; ++n)
          for (int axis = 0; !k && axis < 2 && !outside(pieces[k], n); ++axis)
            momentum[axis] +=
                p->density[p->place_of[n]] * p->volume[p->place_of[n]] * p->velocity.row[axis][p->place_of[n]];
        while (!solver_is_done(&pieces[k]->solver)) step_surely(pieces[k], 1);
        assert_balanced(pieces[k], 1e-3);
      }
      const Particles *one = pieces[0]->domain.particles, *two = pieces[1]->domain.particles;
      double most = 0;
      for (int64_t n = 0; n < two->count; ++n) {
        const int32_t i = two->place_of[n];
        int32_t other = -1;
        for (int64_t o = 0; o < one->count && other < 0; ++o) {
          const double off = (two->position[0][i] - one->position[0][one->place_of[o]]) / 4;
          if (!outside(pieces[0], o) && fabs(off - round(off)) < 1e-9 &&
              fabs(two->position[1][i] - one->position[1][one->place_of[o]]) < 1e-9)
            other = one->place_of[o];
        }
        assert_true(other >= 0);
        for (int axis = 0; axis < 2; ++axis) {
          assert_near(two->displacement.row[axis][i], one->displacement.row[axis][other], s ? 1e-8 : 1e-12);
          most = larger_of(most, fabs(two->displacement.row[axis][i]));
        }
      }
      assert_true(most > 1e-3);
      for (int64_t n = 0; n < one->count; ++n)
        for (int axis = 0; axis < 2 && !outside(pieces[0], n); ++axis)
          momentum[axis] -= one->density[one->place_of[n]] * one->volume[one->place_of[n]] *
                            one->velocity.row[axis][one->place_of[n]];
      for (int axis = 0; axis < 2; ++axis) assert_near(momentum[axis], 0, s ? 1e-7 : 1e-11);
      for (int k = 0; k < 2; ++k) breccia_model_destroy(&pieces[k]);
    }
}

/** A column under its weight is strained along its height only, rho g H^2 / 2 M at the top; and ground at rest under K0 stays so. */
static void weight_settles_as_in_one_dimension(void **state)
{
  (void)state;
  static const char *const starts[] = {"", "initial stress: {surface: 10, K0: 0.4}\n"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n" SOIL
        "body: {soil: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: "
        "{from: [0, 0], to: [2, 10]}}}}\n"
        "peridynamics: {space: plane strain, strain: small}\n%s"
        "loads: [{gravity: [0, -9.81]}, {on: {face: y-}, support: {held: all}}, {on: {face: x+}, support: {held: "
        "periodic}}]\n"
        "solve: {static: {increments: 1}}\n",
        starts[k]);
    while (!solver_is_done(&m->solver)) step_surely(m, 1);
    const Particles *p = m->domain.particles;
    const double settled = 2 * 9.81 * 100 / (2 * 2.4e5);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (outside(m, n) || p->position[1][i] < 2) continue;
      const double y = p->position[1][i], expected = k ? 0 : -settled * (1 - pow(1 - y / 10, 2));
      assert_near(p->displacement.row[0][i], 0, 1e-9);
      assert_near(p->displacement.row[1][i], expected, 0.01 * settled);
    }
    breccia_model_destroy(&m);
  }
}

static void wrong_sides_are_refused(void **state)
{
  (void)state;
  const struct {
    const char *loads, *words;
  } wrong[] = {
      {"{on: {face: x-}, support: {held: periodic}}, {on: {face: x+}, support: {held: periodic}}",
       "support: this face has one already, of line 5"},
      {"{on: {face: x+}, support: {held: across}}, {on: {face: x-}, support: {held: periodic}}",
       "support: this face has one already, of line 5"},
      {"{on: {face: x-}, support: {held: periodic, displacement: [1e-3, 0]}}",
       "support: faces of a periodic body are not held; leave 'displacement' out"},
      {"{on: {all: yes}, support: {held: periodic}}", "support: takes the whole face of a block"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck,
             "units: {length: m, force: kN, time: s}\n" SOIL
             "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: {from: [0, 0], to: [4, "
             "3]}}}}\n"
             "peridynamics: {space: plane strain}\nloads: [%s]\nsolve: {explicit: {steps: 1}}\n",
             wrong[k].loads);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_column_has_the_frequencies_of_a_layer),
      cmocka_unit_test(plane_waves_stay_plane),
      cmocka_unit_test(one_period_moves_as_two),
      cmocka_unit_test(weight_settles_as_in_one_dimension),
      cmocka_unit_test(wrong_sides_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

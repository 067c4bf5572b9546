/* What supports and prescribed motions exert: sums and moments against loads and against the change of momentum. */
#include "support.h"

#include "solver/reactions.h"
#include "solver/rest.h"
#include "solver/resultants.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

static Wrench sum_of(const breccia_model *model, const uint8_t *on, const char *load, const double *about)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, model->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &model->solver, on, load, about);
  reactions_destroy(&reactions);
  return sum;
}

static void a_base_carries_the_weight_of_a_block(void **state)
{
  (void)state;
  static const char *const methods[] = {"newton", "relaxation"};
  for (int m = 0; m < 2; ++m) {
    breccia_model *model =
        model_of(UNITS SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                                  "loads: [{gravity: [0, 0, -9.81]},"
                                  " {name: base, on: {face: z-, layers: 1}, displacement: [0, 0, 0]}]\n"
                                  "solve: {static: {increments: 2, residual: 1e-10, method: %s}}\n",
                 methods[m]);
    step_surely(model, INT64_MAX);
    const double weight = 2 * 9.81 * 6 * 5 * 4 * 1e-3;
    const Wrench base = sum_of(model, NULL, "base", NULL);
    assert_near(base.force[2], weight, 1e-8 * weight);
    for (int k = 0; k < 2; ++k) assert_near(base.force[k], 0, 1e-8 * weight);
    for (int k = 0; k < 3; ++k) assert_near(base.moment[k], 0, 1e-8 * weight);
    assert_near(base.about[0], 0.3, 1e-12);
    assert_true(base.size >= weight * (1 - 1e-8) && base.size < 2 * weight); /* it holds its particles together, too */
    assert_near(reactions_of_loads(&model->solver, base.about).size, weight, 1e-8 * weight);
    const Wrench aside = sum_of(model, NULL, NULL, (const double[3]){0.1, 0, 0});
    assert_near(aside.moment[1], -0.2 * weight, 1e-8 * weight);
    assert_near(aside.moment[0], 0.25 * weight, 1e-8 * weight);
    breccia_model_destroy(&model);
  }
}

static void supports_outside_the_body_carry_it_too(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, 6]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane strain}\n"
      "loads: [{name: wall, on: {face: x-}, support: {held: across}}, {name: floor, on: {face: y-}, support: {held: "
      "across}}, {gravity: [0, -9.81]}, {on: {face: x+, layers: 1}, traction: [1, 0]}, {on: {face: y+, layers: 1}, "
      "traction: [0, -3]}]\n"
      "solve: {static: {increments: 1, residual: 1e-10}}\n");
  step_surely(model, INT64_MAX);
  const Wrench both = sum_of(model, NULL, NULL, NULL);
  assert_near(both.force[0], -1 * 0.6 * 0.2, 1e-9);
  assert_near(both.force[1], 3 * 0.8 * 0.2 + 2 * 9.81 * 0.8 * 0.6 * 0.2, 1e-9); /* of the body alone */
  const Wrench loads = reactions_of_loads(&model->solver, both.about);
  for (int k = 0; k < 2; ++k) assert_near(loads.force[k], -both.force[k], 1e-9);
  breccia_model_destroy(&model);
}

static void each_of_several_walls_carries_its_own(void **state)
{
  (void)state;
  /* Three planes of symmetry meet in a corner: each bears what presses on it, and nothing along itself. */
  static const char *const formulations[] = {"correspondence", "ordinary"}, *const names[] = {"wall", "back", "floor"};
  for (int f = 0; f < 2; ++f) {
    breccia_model *model = model_of(
        UNITS SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                         "peridynamics: {formulation: %s, horizon: 2.015 spacings}\n"
                         "loads: [{name: wall, on: {face: x-}, support: {held: across}}, {name: back, on: {face: y-}, "
                         "support: {held: across}}, {name: floor, on: {face: z-}, support: {held: across}}, {gravity: "
                         "[0, 0, -9.81]}, {on: {face: x+, layers: 1}, traction: [1, 0, 0]}, {on: {face: y+, layers: "
                         "1}, traction: [0, -3, 0]}]\n"
                         "watch: {wall: {reaction of: wall}}\n"
                         "solve: {static: {increments: 1, residual: 1e-10}}\n",
        formulations[f]);
    step_surely(model, INT64_MAX);
    const double wanted[] = {-1 * 0.5 * 0.4, 3 * 0.6 * 0.4, 2 * 9.81 * 0.6 * 0.5 * 0.4};
    const double middle[] = {0.3, 0.25, 0.2};
    double sums[3] = {0};
    Resultant resultants[6];
    assert_int_equal(resultants_find(&model->solver, resultants, NULL), 0);
    for (int w = 0; w < 3; ++w) {
      const Wrench wall = sum_of(model, NULL, names[w], NULL);
      for (int k = 0; k < 3; ++k) assert_near(resultants[w].now[k], wall.force[k], 1e-12);
      for (int k = 0; k < 3; ++k) {
        assert_near(wall.force[k], k == w ? wanted[k] : 0, 1e-8);
        sums[k] += wall.force[k];
      }
      assert_near(wall.about[w], 0, 1e-12);
      assert_near(wall.about[(w + 1) % 3], middle[(w + 1) % 3], 1e-2);
    }
    for (int k = 0; k < 3; ++k) assert_near(sums[k], sum_of(model, NULL, NULL, NULL).force[k], 1e-8);
    breccia_model_destroy(&model);
  }
}

/** Finds the reactions of the loads `held` and `side` of a block in space that is pulled obliquely.
 *  @param[in] swapped  true: `side` stands before `held` in the deck */
static void corner_reactions(const char *formulation, const char *held, const char *side, bool swapped,
                             double force[2][3])
{
  char loads[2][120];
  snprintf(loads[0], sizeof loads[0], "{name: held, on: {face: x-%s}, %s}", *held == 's' ? "" : ", layers: 2", held);
  snprintf(loads[1], sizeof loads[1], "{name: side, on: {face: y-}, support: {held: %s}}", side);
  breccia_model *model =
      model_of(UNITS SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                                "peridynamics: {formulation: %s, horizon: 2.015 spacings}\n"
                                "loads: [%s, %s, {on: {face: x+, layers: 1}, traction: [1, 0.7, 0.5]}]\n"
                                "solve: {static: {increments: 1, residual: 1e-10}}\n",
               formulation, loads[swapped], loads[!swapped]);
  step_surely(model, INT64_MAX);
  Resultant resultants[3];
  assert_int_equal(resultants_find(&model->solver, resultants, NULL), 0);
  for (int w = 0; w < 2; ++w) {
    const Wrench sum = sum_of(model, NULL, w ? "side" : "held", NULL);
    for (int k = 0; k < 3; ++k) assert_near(resultants[w ^ swapped].now[k], sum.force[k], 1e-12);
    memcpy(force[w], sum.force, sizeof sum.force);
  }
  breccia_model_destroy(&model);
}

/** Images in the corner of a face held in all directions and a plane of symmetry continue the held face beyond that
 *  plane: the held face carries all shear along the edge, whichever load the deck names first, as held layers do. */
static void the_order_of_supports_does_not_move_shear(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence", "ordinary", "hybrid"};
  static const char *const held[] = {"support: {held: all}", "displacement: [0, 0, 0]"};
  const double load[] = {1 * 0.5 * 0.4, 0.7 * 0.5 * 0.4, 0.5 * 0.5 * 0.4};
  for (int f = 0; f < 3; ++f)
    for (int h = 0; h < 2; ++h) {
      double force[2][2][3];
      for (int swapped = 0; swapped < 2; ++swapped) {
        corner_reactions(formulations[f], held[h], "across", swapped, force[swapped]);
        for (int k = 0; k < 3; ++k) assert_near(force[swapped][0][k] + force[swapped][1][k], -load[k], 1e-8);
        for (int k = 0; k < 3; k += 2) { /* none along the plane of symmetry */
          assert_near(force[swapped][0][k], -load[k], 1e-8);
          assert_near(force[swapped][1][k], 0, 1e-8);
        }
      }
      for (int k = 0; k < 3; ++k) assert_near(force[0][1][k], force[1][1][k], 1e-9);
    }
}

/** The edge of two faces held in all directions belongs to both alike. */
static void two_held_faces_share_the_shear_along_their_edge(void **state)
{
  (void)state;
  const double load = 0.5 * 0.5 * 0.4;
  double force[2][2][3];
  for (int swapped = 0; swapped < 2; ++swapped)
    corner_reactions("correspondence", "support: {held: all}", "all", swapped, force[swapped]);
  for (int w = 0; w < 2; ++w)
    for (int k = 0; k < 3; ++k) assert_near(force[0][w][k], force[1][w][k], 1e-9);
  assert_near(force[0][0][2] + force[0][1][2], -load, 1e-8);
  for (int w = 0; w < 2; ++w) assert_true(force[0][w][2] < 0);
}

/** The base of a layer between periodic faces carries the shear and the weight of one period, whatever images are in
 *  the corners beside the periodic faces. */
static void a_base_between_periodic_faces_carries_one_period(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence", "ordinary", "hybrid", "bond-based", "micropolar"};
  static const char *const held[] = {"all", "across"};
  for (int k = 0; k < 10; ++k) {
    const int f = k / 2;
    if (f == 4 && k % 2 == 0) continue; /* micropolar bodies are held across only */
    breccia_model *model = model_of(
        UNITS
        "materials: {m: {model: %s, Young modulus: 2e5, density: 2%s}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [8, "
        "6]}}}}\nperidynamics: {formulation: %s, space: plane stress, horizon: 3.015 spacings}\n"
        "loads: [{name: base, on: {face: y-}, support: {held: %s}}, {on: {face: x-}, support: {held: "
        "periodic}}, {gravity: [0, -9.81]}, {on: {face: y+, layers: 1}, traction: [%g, 0]}, {on: {nearest: [0.35, "
        "0.05]}, displacement: [%s, free]}]\n"
        "solve: {static: {increments: 1, residual: 1e-10}}\n",
        f == 3 ? "elastic-1d" : "elastic", f == 3 ? "" : ", Poisson ratio: 0.25", formulations[f], held[k % 2],
        k % 2 ? 0 : 0.7, k % 2 ? "0" : "free");
    step_surely(model, INT64_MAX);
    const double shear = k % 2 ? 0 : 0.7 * 0.8 * 0.2, weight = 2 * 9.81 * 0.8 * 0.6 * 0.2;
    const Wrench base = sum_of(model, NULL, "base", NULL);
    assert_near(base.force[0], -shear, 1e-7);
    assert_near(base.force[1], weight, 1e-7);
    breccia_model_destroy(&model);
  }
}

/** Prescribed rotations exert moments alone, also along free directions in which particles are not in balance. */
static void what_holds_a_rotation_exerts_a_moment_and_no_force(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.1}}\n"
                     "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 3, 3]}}}}\n"
                     "peridynamics: {formulation: micropolar}\n"
                     "loads: [{name: wall, on: {face: x-}, displacement: [0, free, free]}, {name: turns, on: {face: "
                     "x-}, rotation: [0, "
                     "0, 0]}, {on: {face: x+}, traction: [1, 2, 3]}, {on: {inside: {box: {from: [0.1, 0, 0], to: [0.2, "
                     "1, 0.1]}}}, moment: [0.03, 0.02, 0.01]}]\n"
                     "solve: {explicit: {steps: 60}}\n");
  step_surely(model, 60);
  const Particles *p = model->domain.particles;
  const Selection *held = &model->loading.loads[1].selection;
  double moment[3] = {0}, pushed = 0;
  for (int64_t n = 0; n < held->count; ++n) {
    const int32_t i = held->places[n];
    pushed = larger_of(pushed, fabs(p->volume[i] * p->internal.row[1][i]));
    for (int k = 0; k < 3; ++k) moment[k] -= p->volume[i] * p->internal.row[p->space.rotation + k][i];
  }
  const Wrench turns = sum_of(model, NULL, "turns", NULL), wall = sum_of(model, NULL, "wall", NULL),
               both = sum_of(model, NULL, NULL, turns.about);
  const double size = fabs(moment[0]) + fabs(moment[1]) + fabs(moment[2]);
  assert_true(pushed > 1e-3 && size > 1e-4);
  for (int k = 0; k < 3; ++k) {
    assert_near(turns.force[k], 0, 0);
    assert_near(turns.moment[k], moment[k], 1e-12 * size);
    assert_near(both.force[k], wall.force[k], 0);
    assert_near(wall.force[k], k ? 0 : wall.force[0], 0);
  }
  breccia_model_destroy(&model);
}

static void two_supports_share_the_load_of_a_beam(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS SOFT_SOLID
      "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [31, 6]}}}}\n"
      "peridynamics: {formulation: correspondence, space: plane stress}\n"
      "loads: [{name: left, on: {nearest: [0.05, 0]}, displacement: [0, 0]},"
      " {name: right, on: {nearest: [3.05, 0]}, displacement: [free, 0]},"
      " {on: {nearest: [1.55, 0.55]}, force: [0, -0.01]}]\n"
      "watch: {left: {reaction of: left}, right: {reaction on: {nearest: [3.05, 0]}}}\n"
      "solve: {static: {increments: 1, residual: 1e-10}}\n");
  step_surely(model, INT64_MAX);
  const Wrench left = sum_of(model, NULL, "left", NULL), right = sum_of(model, NULL, "right", NULL);
  assert_near(left.force[1], 0.005, 1e-6);
  assert_near(right.force[1], 0.005, 1e-6);
  assert_near(left.force[1] + right.force[1], 0.01, 1e-10);
  assert_near(right.force[0], 0, 0);
  const Wrench loads = reactions_of_loads(&model->solver, left.about);
  assert_near(loads.force[1], -0.01, 1e-12);
  assert_near(loads.moment[2] + sum_of(model, NULL, NULL, left.about).moment[2], 0, 1e-9);
  breccia_model_destroy(&model);
}

static void a_clamp_exerts_the_moment_of_the_load_about_its_face(void **state)
{
  (void)state;
  /* P L from the face, of a support that mirrors as it is; from the middle of layers that are held themselves by half of what they are deep more. The
     load stands at the end where bonds tell how it is spread (correspondence), otherwise in the last layer. */
  static const char *const clamps[] = {"support: {held: all}", "displacement: [0, 0]"};
  for (int k = 0; k < 4; ++k) {
    breccia_model *model = model_of(
        UNITS SOFT_SOLID
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [20, 6]}}}}\n"
        "peridynamics: {formulation: %s, space: plane stress}\n"
        "loads: [{name: clamp, on: {face: x-%s}, %s}, {on: {face: x+, layers: 1}, traction: [0, -1e-4]}]\n"
        "solve: {static: {increments: 1, residual: 1e-10}}\n",
        k / 2 ? "ordinary" : "correspondence", k % 2 ? ", layers: 2" : "", clamps[k % 2]);
    step_surely(model, INT64_MAX);
    const double load = 1e-4 * 0.6 * 0.2, middle = k % 2 ? 0.1 : 0, arm = (k / 2 ? 1.95 : 2) - middle;
    const Wrench clamp = sum_of(model, NULL, "clamp", NULL);
    assert_near(clamp.about[0], middle, 1e-5);
    assert_near(clamp.force[1], load, 1e-8 * load);
    assert_near(clamp.moment[2], load * arm, 1e-4 * load * arm); /* as far as it bends */
    breccia_model_destroy(&model);
  }
}

static void a_shaken_body_is_pushed_by_its_change_of_momentum(void **state)
{
  (void)state;
  /* Sum of m u'' + c m u' = reactions, exactly so for central differences, held particles among them. */
  breccia_model *model =
      model_of(UNITS SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 3, 3]}}}}\n"
                                "loads: [{on: {face: x-, layers: 2}, displacement: [1e-3, 0, free], history: {sine: "
                                "{frequency: 40 Hz}}}]\n"
                                "solve: {explicit: {time step: 2e-4, steps: 90, damping: 30}}\n");
  const Particles *p = model->domain.particles;
  const double dt = 2e-4;
  double before[3] = {0}, now[3] = {0}, after[3] = {0}, largest = 0;
  Wrench found = {.about = {0}};
  for (int step = 0; step < 80; ++step) {
    step_surely(model, 1);
    for (int k = 0; k < 3; ++k) {
      before[k] = now[k];
      now[k] = after[k];
      after[k] = 0;
      for (int64_t i = 0; i < p->places; ++i) after[k] += p->density[i] * p->volume[i] * p->displacement.row[k][i];
      const double pushed = (after[k] - 2 * now[k] + before[k]) / (dt * dt) + 30 * (after[k] - before[k]) / (2 * dt);
      largest = larger_of(largest, fabs(pushed));
      if (step > 2) assert_near(found.force[k], pushed, 1e-6 * largest);
    }
    found = sum_of(model, NULL, NULL, NULL);
  }
  assert_true(largest > 1e-3);
  breccia_model_destroy(&model);
}

static void a_stiff_body_is_pushed_by_its_mass_times_its_acceleration(void **state)
{
  (void)state;
  /* Half of it is held and moves evenly faster, whichever way the deck says so; what it exerts on the other half is quickly even, too. Mass damping c
   * adds c m u'. */
  static const char *const motions[] = {"acceleration: [2, 0, free]", "velocity: [2, 0, free], history: {ramp to: 1}",
                                        "displacement: [1, 0, free], history: {product: [{ramp to: 1}, {ramp to: 1}]}"};
  const double mass = 2 * 8 * 3 * 3 * 1e-3, c = 3, time = 0.5;
  for (int m = 0; m < 3; ++m) {
    breccia_model *model =
        model_of(UNITS SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 3, 3]}}}}\n"
                                  "loads: [{on: {face: x-, layers: 4}, %s}]\n"
                                  "solve: {implicit: {end time: %g, time step: 0.01, damping: %g, stiffness damping: "
                                  "0.01}}\n",
                 motions[m], time, c);
    step_surely(model, INT64_MAX);
    const double wanted = mass * 2 * (1 + c * time), found = sum_of(model, NULL, NULL, NULL).force[0];
    if (!(fabs(found - wanted) <= 2e-3 * wanted)) fail_msg("%s: %g instead of %g", motions[m], found, wanted);
    breccia_model_destroy(&model);
  }
}

static void a_static_stage_ends_at_rest_ties_among_it(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS SOFT_SOLID
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}\n"
      "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x+, layers: 1}, tie: {directions: x}},"
      " {on: {nearest: [0.6, 0.4, 0.4]}, force: [1, 0, 0], history: {ramp to: 1}}]\n"
      "solve: {static: {increments: 2}}\n");
  step_surely(model, INT64_MAX);
  Rest rest;
  assert_int_equal(rest_find(&model->solver, &rest, NULL), 0);
  assert_true(rest.meant && rest.reached);
  assert_near(rest.unbalanced, 0, 1e-6);
  assert_near(sum_of(model, NULL, NULL, NULL).force[0], -1, 1e-7);
  breccia_model_destroy(&model);
}

static void what_holds_nothing_is_refused(void **state)
{
  (void)state;
  static const char *const watches[] = {"reaction on: {face: x+, layers: 1}", "reaction of: pull"},
                           *const reasons[] = {"no motion is prescribed to these particles", "prescribes no motion"};
  for (int k = 0; k < 2; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck,
             UNITS SOFT_SOLID
             "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 4, 4]}}}}\n"
             "loads: [{on: {face: x-, layers: 1}, displacement: [0, free, free]}, {name: pull, on: {face: "
             "x+, layers: 1}, traction: [1, 0, 0]}, {name: wall, on: {face: y-}, support: {held: across}}, {on: {face: "
             "z-}, support: {held: across}}]\n"
             "watch: {w: {%s}}\n"
             "solve: {static: {increments: 1}}\n",
             watches[k]);
    char *words = refusal_of(deck);
    assert_non_null(strstr(words, reasons[k]));
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_base_carries_the_weight_of_a_block),
      cmocka_unit_test(supports_outside_the_body_carry_it_too),
      cmocka_unit_test(each_of_several_walls_carries_its_own),
      cmocka_unit_test(the_order_of_supports_does_not_move_shear),
      cmocka_unit_test(two_held_faces_share_the_shear_along_their_edge),
      cmocka_unit_test(a_base_between_periodic_faces_carries_one_period),
      cmocka_unit_test(what_holds_a_rotation_exerts_a_moment_and_no_force),
      cmocka_unit_test(two_supports_share_the_load_of_a_beam),
      cmocka_unit_test(a_clamp_exerts_the_moment_of_the_load_about_its_face),
      cmocka_unit_test(a_shaken_body_is_pushed_by_its_change_of_momentum),
      cmocka_unit_test(a_stiff_body_is_pushed_by_its_mass_times_its_acceleration),
      cmocka_unit_test(a_static_stage_ends_at_rest_ties_among_it),
      cmocka_unit_test(what_holds_nothing_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

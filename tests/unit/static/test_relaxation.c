/* Dynamic relaxation finds the rest that Newton's method finds. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define BAR "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
#define PLATE                                                                                                          \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: {particles: [24, 10]}}}}\n"

/* Its end may turn about a ligament of few bonds: motions ten thousand times slower than the others. */
#define HINGED                                                                                                         \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n" PLATE                      \
  "peridynamics: {formulation: ordinary, space: plane strain, horizon: 2.015 spacings}\n"                              \
  "cracks: [{cut: {line: [[1.2, -1], [1.2, 0.4]]}}]\n"                                                                 \
  "failure: {fracture energy: 0.05, near grips: hold}\n"                                                               \
  "loads: [{on: {face: x-, layers: 3}, displacement: [0, free]},"                                                      \
  " {on: {face: x+, layers: 3}, displacement: [0.012, free], history: {ramp to: 1}},"                                  \
  " {on: {nearest: [0.05, 0.05]}, displacement: [free, 0]}, {on: {nearest: [2.35, 0.05]}, displacement: [free, 0]}]\n"

/** Bodies that yield, soften or break, and elastic ones, held and loaded in different ways. */
static const struct Case {
  const char *name, *deck;
  int increments;
  bool breaks;
} cases[] = {
    {"an elastic plate with a hole",
     SOFT_SOLID
     "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {difference: [{box: {from: "
     "[0, 0], to: [2.4, 1.6]}}, {cylinder: {from: [1.2, 0.8, -1], to: [1.2, 0.8, 1], radius: 0.4}}]}}}\n"
     "peridynamics: {formulation: correspondence, space: plane stress}\n"
     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]},"
     " {on: {face: x+, layers: 1}, displacement: [0.002, free]}]\n",
     1, false},
    {"an ordinary block with supports, springs and ties",
     SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [6, 5, 4]}}}}\n"
                "peridynamics: {formulation: ordinary, space: 3-D}\n"
                "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: y-, layers: 1}, spring: {direction: "
                "[0, 1, 0], stiffness: 10}},"
                " {on: {face: z-, layers: 1}, roller: [0, 0, 1]}, {on: {face: x+, layers: 1}, tie: {directions: x}},"
                " {on: {face: x+, layers: 1}, traction: [4, 2, 0]}]\n",
     2, false},
    {"a j2 bar beyond yield",
     "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, hardening "
     "modulus: 1e3}}\n" BAR "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings}\n"
     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
     " {on: {face: x+, layers: 1}, traction: [0, 0, 2.2], history: {ramp to: 1}}]\n",
     4, false},
    {"a Drucker-Prager block under a footing",
     "materials: {m: {model: drucker-prager, density: 2, Young modulus: 1e4, Poisson ratio: 0.3, cohesion: 10, "
     "friction "
     "angle: 20 deg, dilation angle: 10 deg}}\n" PLATE
     "peridynamics: {formulation: correspondence, space: plane strain}\n"
     "loads: [{on: {face: y-, layers: 3}, displacement: [0, 0]},"
     " {on: {inside: {box: {from: [0.9, 0.7], to: [1.5, 1.1]}}}, displacement: [0, -0.012], history: {ramp to: 1}}]\n",
     4, false},
    {"a bar whose bonds soften, before its peak",
     "materials: {m: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, "
     "fracture "
     "energy: 100 N/m}}\n" PLATE "peridynamics: {formulation: bond-based, space: plane stress, strength of: bonds}\n"
     "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]},"
     " {on: {face: x+, layers: 3}, displacement: [0.000115, free], history: {ramp to: 1}}]\n",
     3, false},
    {"a notched plate whose bonds break",
     "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n" PLATE
     "peridynamics: {formulation: bond-based, space: plane stress}\n"
     "cracks: [{cut: {line: [[1.2, 0], [1.2, 0.4]]}}]\n"
     "failure: {critical stretch: 0.01, near grips: hold}\n"
     "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0]},"
     " {on: {face: x+, layers: 3}, displacement: [0.012, 0], history: {ramp to: 1}}]\n",
     4, true},
    {"a notched plate of ordinary peridynamics that few bonds hold together in the end", HINGED, 8, true},
};

static breccia_model *rested(const struct Case *c, const char *method)
{
  breccia_model *model =
      model_of(UNITS "%ssolve: {static: {increments: %d, method: %s}}\n", c->deck, c->increments, method);
  step_surely(model, INT64_MAX);
  assert_true(model->solver.clock.time == 1);
  return model;
}

static void it_finds_the_rest_that_newton_finds(void **state)
{
  (void)state;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *newton = rested(&cases[c], "newton"), *relaxed = rested(&cases[c], "relaxation");
    const Particles *p = newton->domain.particles, *q = relaxed->domain.particles;
    double most = 0, largest = 0, force = 0, strongest = 0;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < p->places; ++i) {
        most = larger_of(most, fabs(p->displacement.row[k][i] - q->displacement.row[k][i]));
        largest = larger_of(largest, fabs(p->displacement.row[k][i]));
        force = larger_of(force, p->volume[i] *
                                     fabs(p->internal.row[k][i] - q->internal.row[k][i])); /* reactions among them */
        strongest = larger_of(strongest, p->volume[i] * fabs(p->internal.row[k][i]));
      }
    if (!(most <= 1e-5 * largest)) fail_msg("%s: displacements differ by %g of %g", cases[c].name, most, largest);
    if (!(force <= 1e-5 * strongest)) fail_msg("%s: forces differ by %g of %g", cases[c].name, force, strongest);
    assert_int_equal(breccia_model_broken_bonds(newton), breccia_model_broken_bonds(relaxed));
    assert_true(largest > 0 && (breccia_model_broken_bonds(newton) > 0) == cases[c].breaks);
    assert_near(solver_energy(&relaxed->solver).dissipated, solver_energy(&newton->solver).dissipated,
                1e-5 * solver_energy(&newton->solver).external);
    breccia_model_destroy(&newton);
    breccia_model_destroy(&relaxed);
  }
}

static void an_unloaded_body_is_at_rest_again(void **state)
{
  (void)state;
  /* Nothing acts on it in the end: what is left is measured by what has acted before, and not by itself. */
  breccia_model *model = model_of(UNITS SOFT_SOLID BAR
                                  "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
                                  " {on: {face: x+, layers: 1}, traction: [0, 0, 2], history: {table: [[0, 0], [0.5, "
                                  "1], [1, 0]]}}]\n"
                                  "solve: {static: {increments: 4, method: relaxation, relaxation iterations: 500}}\n");
  const Particles *p = model->domain.particles;
  double bent = 0, left = 0;
  step_surely(model, 2);
  for (int64_t i = 0; i < p->places; ++i) bent = larger_of(bent, fabs(p->displacement.row[2][i]));
  step_surely(model, INT64_MAX);
  assert_true(model->solver.clock.time == 1);
  for (int64_t i = 0; i < p->places; ++i) left = larger_of(left, fabs(p->displacement.row[2][i]));
  assert_true(bent > 1e-3);
  assert_near(left, 0, 1e-5 * bent);
  breccia_model_destroy(&model);
}

static void it_goes_on_where_a_bar_gives_way(void **state)
{
  (void)state;
  /* Three times the displacement at which the bar above carries its most: it tears at once, as it holds more energy than tearing takes, and Newton's
   * method finds no equilibrium. Nothing is lost: what loads have put in the law has dissipated. */
  char deck[1024];
  const char *at = strstr(cases[4].deck, "0.000115");
  struct Case torn = {.deck = deck, .increments = 10};
  assert_non_null(at);
  snprintf(deck, sizeof deck, "%.*s0.0004%s", (int)(at - cases[4].deck), cases[4].deck, at + strlen("0.000115"));
  breccia_model *model = rested(&torn, "relaxation");
  const Particles *p = model->domain.particles;
  const Energy energy = solver_energy(&model->solver);
  double held = 0;
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] > 2.05) held += p->volume[p->place_of[n]] * p->internal.row[0][p->place_of[n]];
  assert_near(held, 0, 1e-3); /* of a strength of 3000 kPa x 1 m x 0.2 m */
  assert_true(energy.dissipated > 0.01);
  assert_near(energy.dissipated, energy.external, 1e-3 * energy.external);
  breccia_model_destroy(&model);
}

static void it_needs_few_steps_for_any_size(void **state)
{
  (void)state;
  /* The mass knows how a body answers as a whole: iterations do not grow with the number of particles along it. */
  int64_t iterations[2];
  for (int size = 0; size < 2; ++size) {
    breccia_model *model = model_of(
        UNITS SOFT_SOLID "body: {b: {material: m, lattice: square, spacing: %g, thickness: 0.2, shape: {box: {from: "
                         "[0, 0], to: [2, 2]}}}}\n"
                         "peridynamics: {formulation: correspondence, space: plane stress}\n"
                         "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0]},"
                         " {on: {face: x+, layers: 1}, traction: [1, 3]}]\n"
                         "solve: {static: {increments: 1, method: relaxation}}\n",
        0.2 / (1 + 2 * size));
    step_surely(model, INT64_MAX);
    const char *last = NULL;
    for (const char *at = text_words(&model->solver.log); (at = strstr(at, "iteration ")); ++at) last = at;
    assert_non_null(last);
    iterations[size] = strtoll(last + strlen("iteration "), NULL, 10);
    breccia_model_destroy(&model);
  }
  if (iterations[0] > 150 || (double)iterations[1] > 1.5 * (double)iterations[0])
    fail_msg("%lld and %lld iterations", (long long)iterations[0], (long long)iterations[1]);
}

static void beyond_its_strength_a_bar_stays_as_it_was(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS
      "materials: {m: {model: j2, density: 2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 10, "
      "hardening modulus: 0}}\n" BAR
      "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
      "loads: [{on: {face: x-, layers: 1}, roller: [1, 0, 0]}, {on: {face: y-, layers: 1}, roller: [0, 1, 0]},"
      " {on: {face: z-, layers: 1}, roller: [0, 0, 1]},"
      " {on: {face: x+, layers: 1}, traction: [12, 0, 0], spread: layers, history: {ramp to: 1}}]\n"
      "solve: {static: {increments: 6, method: relaxation, relaxation iterations: 200, smallest increment: 0.1}}\n");
  const Particles *p = model->domain.particles;
  step_must_fail(model, "200 iterations left");
  assert_near(model->solver.clock.time, 11.25 / 12, 0.03); /* beyond the strength as the last layer is confined */
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

/** The motion of this body is prescribed, so that it is not told to prescribe one. */
static void who_comes_to_rest_slowly_is_told_to_allow_more(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  breccia_model *model =
      model_of(UNITS HINGED "solve: {static: {increments: 8, method: relaxation, relaxation iterations: 100}}\n");
  int status = 0;
  while (!status && !solver_is_done(&model->solver)) status = breccia_model_step(model, 1, error);
  assert_int_equal(status, BRECCIA_FAILURE);
  holds_words(
      breccia_error_text(error),
      "broken bonds the body finds no equilibrium any more at time |: 100 iterations left |; it has failed at "
      "this load, or few bonds hold it together and it comes to rest slowly: allow more 'relaxation iterations', "
      "go on with a stage of 'explicit'");
  assert_null(strstr(breccia_error_text(error), "instead of forces"));
  breccia_error_destroy(&error);
  breccia_model_destroy(&model);
}

/** A body that may soften, and whose step has no equilibrium by Newton's method nor by the relaxation that follows it, is told of both ways out. */
static void who_cannot_carry_a_load_is_told_the_ways_out(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS "materials: {m: {model: mazars, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2, tensile strength: "
            "3000, fracture energy: 0.1}}\n"
            "body: {b: {material: m, spacing: 0.02, shape: {box: {particles: [5, 3, 3]}}}}\n"
            "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings, strain: small}\n"
            "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},"
            " {on: {face: x+, layers: 1}, traction: [9000, 0, 0], history: {ramp to: 1}}]\n"
            "solve: {static: {increments: 1, smallest increment: 0.9, relaxation iterations: 50}}\n");
  step_must_fail(
      model, "no equilibrium beyond time 0 s, with increments cut to |: by Newton's method, descent by secants and "
             "dynamic relaxation; at last |; the body may fail at this load: take 'method: relaxation' with more "
             "'relaxation iterations', go on with a stage of 'explicit', as by 'quasi-static', or look at the loads "
             "and at the last pictures");
  breccia_model_destroy(&model);
}

static void a_restart_goes_on_to_the_same_bits(void **state)
{
  (void)state;
  const struct Case *c = &cases[5];
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  breccia_model *whole = rested(c, "relaxation"), *parts[2];
  breccia_run run = {.size = sizeof(breccia_run), .steps = 2};
  Error *error = breccia_error_create();
  assert_non_null(mkdtemp(folder));
  run.folder = folder;
  for (int k = 0; k < 2; ++k) {
    parts[k] = model_of(UNITS "%ssolve: {static: {increments: %d, method: relaxation}}\n", c->deck, c->increments);
    if (breccia_model_run(parts[k], &run, error)) fail_msg("%s", breccia_error_text(error));
    run.restart = 1;
    run.steps = 0;
  }
  const Particles *p = whole->domain.particles, *q = parts[1]->domain.particles;
  for (int k = 0; k < 3; ++k)
    assert_memory_equal(p->displacement.row[k], q->displacement.row[k], sizeof(double) * (size_t)p->places);
  assert_int_equal(breccia_model_broken_bonds(whole), breccia_model_broken_bonds(parts[1]));
  for (int k = 0; k < 2; ++k) breccia_model_destroy(&parts[k]);
  breccia_model_destroy(&whole);
  breccia_error_destroy(&error);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_finds_the_rest_that_newton_finds),
      cmocka_unit_test(an_unloaded_body_is_at_rest_again),
      cmocka_unit_test(who_comes_to_rest_slowly_is_told_to_allow_more),
      cmocka_unit_test(who_cannot_carry_a_load_is_told_the_ways_out),
      cmocka_unit_test(it_goes_on_where_a_bar_gives_way),
      cmocka_unit_test(it_needs_few_steps_for_any_size),
      cmocka_unit_test(beyond_its_strength_a_bar_stays_as_it_was),
      cmocka_unit_test(a_restart_goes_on_to_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Laws that give up, that end the life of their points, or that do not tell all that a solver needs: what is said, and what becomes of the body. */
#include "sample_laws.h"
#include "support.h"

#include "constitutive/driver.h"

static void a_law_that_gives_up_stops_the_run_or_breaks_its_particle(void **state)
{
  (void)state;
  const breccia_law *const laws[] = {&law_of_glass};
  for (int breaks = 0; breaks < 2; ++breaks) {
    const breccia_options options = {
        .size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1 + breaks};
    breccia_error *error = breccia_error_create();
    breccia_model *model = NULL;
    char deck[1024];
    snprintf(deck, sizeof deck,
             "units: {length: m, force: kN, time: s}\nmaterials: {vase: {model: glass, density: 2}}\n"
             "body: {b: {material: vase, spacing: 0.1, shape: {box: {particles: [12, 4, 4]}}}}\n"
             "failure: {failed laws: %s}\n"
             "loads: [{on: {face: x-, layers: 3}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 3}, velocity: [0.5, 0, "
             "0]}]\n"
             "solve: {explicit: {steps: 400}}\n",
             breaks ? "break" : "stop");
    assert_int_equal(breccia_model_load_string(deck, "deck", &options, &model, error), 0);
    const int status = breccia_model_step(model, INT64_MAX, error);
    if (breaks) {
      assert_int_equal(status, 0);
      assert_true(breccia_model_broken_bonds(model) > 100);
      for (int64_t i = 0; i < model->domain.particles->places; ++i)
        for (int k = 0; k < 3; ++k) assert_true(isfinite(model->domain.particles->displacement.row[k][i]));
      assert_true(model->domain.gave_up != NULL);
    } else {
      assert_int_equal(status, BRECCIA_FAILURE);
      assert_non_null(strstr(breccia_error_text(error),
                             "the law glass of material 'vase' could not be integrated at the strain xx 0.001"));
      assert_int_equal(breccia_model_broken_bonds(model), 0);
    }
    breccia_model_destroy(&model);
    breccia_error_destroy(&error);
  }
}

/** A bar with a part of glass in its middle, pulled at rest by a growing displacement: increments are cut until the glass is strained as far as it
 *  goes, the message names law, material and a particle of that part, and the state is that of the last increment that found rest. */
static void a_law_that_gives_up_at_rest_is_named_with_its_particle(void **state)
{
  (void)state;
  const breccia_law *const laws[] = {&law_of_glass};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1};
  breccia_error *error = breccia_error_create();
  breccia_model *m = NULL;
  if (breccia_model_load_string("units: {length: m, force: kN, time: s}\n"
                                "materials:\n  vase: {model: glass, density: 2}\n"
                                "  m: {model: elastic, density: 2, Young modulus: 1.5e5, Poisson ratio: 0.25}\n"
                                "body:\n  left: {material: m, spacing: 0.1, shape: {box: {particles: [6, 3, 3]}}}\n"
                                "  middle: {material: vase, spacing: 0.1, shape: {box: {particles: [3, 3, 3], first "
                                "particle: [0.65, 0.05, 0.05]}}}\n"
                                "  right: {material: m, spacing: 0.1, shape: {box: {particles: [6, 3, 3], first "
                                "particle: [0.95, 0.05, 0.05]}}}\n"
                                "peridynamics: {formulation: correspondence, horizon: 1.5 spacings, strain: small}\n"
                                "loads: [{on: {face: x-, layers: 2}, displacement: [0, 0, 0]},"
                                " {on: {face: x+, layers: 2}, displacement: [0.002, 0, 0], history: {ramp to: 1}}]\n"
                                "solve: {static: {increments: 7}}\n",
                                "deck", &options, &m, error))
    fail_msg("%s", breccia_error_text(error));
  assert_int_equal(breccia_model_step(m, INT64_MAX, error), BRECCIA_FAILURE);
  const char *words = strstr(breccia_error_text(error), "static: no equilibrium beyond time 0.");
  assert_non_null(words);
  words = strstr(words, "the law glass of material 'vase' could not be integrated at particle ");
  assert_non_null(words);
  int number = -1;
  double x = 0, y = 0, z = 0;
  assert_int_equal(sscanf(strstr(words, "particle "), "particle %d at [%lf, %lf, %lf]", &number, &x, &y, &z), 4);
  const Domain *d = &m->domain;
  const Particles *p = d->particles;
  const int32_t place = p->place_of[number];
  assert_near(p->position[0][place], x, 1e-6);
  assert_near(p->position[1][place], y, 1e-6);
  assert_near(p->position[2][place], z, 1e-6);
  assert_true(x > 0.6 && x < 0.9);
  double most = 0, end = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    end = fmax(end, p->displacement.row[0][i]);
    if (p->position[0][i] > 0.6 && p->position[0][i] < 0.9) most = fmax(most, d->strain[0][i]);
  }
  assert_true(most <= 1e-3 && most > 0.98e-3);
  assert_near(end, 0.002 * m->solver.clock.time, 1e-9);
  assert_balanced(m, 1e-6);
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

/* "bare glass": glass that does not say how its stresses change. */
static int bare_update(const void *constants, const breccia_batch *batch)
{
  breccia_batch without = *batch;
  without.tangent = NULL;
  return law_of_glass.update(constants, &without);
}

static void a_law_without_tangents_is_refused_where_they_are_needed(void **state)
{
  (void)state;
  static const struct {
    const char *solve, *refused;
  } cases[] = {{"static: {increments: 2}", "static"},
               {"implicit: {end time: 1e-3, time step: 1e-3}", "implicit"},
               {"static: {increments: 2, method: relaxation}", NULL},
               {"explicit: {steps: 2}", NULL}};
  breccia_law bare = law_of_glass;
  bare.name = "bare-glass";
  bare.update = bare_update;
  const breccia_law *const laws[] = {&bare};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_model *m = NULL;
    char deck[1024], words[256];
    snprintf(deck, sizeof deck,
             "units: {length: m, force: kN, time: s}\nmaterials: {vase: {model: bare-glass, density: 2}}\n"
             "body: {b: {material: vase, spacing: 0.1, shape: {box: {particles: [8, 3, 3]}}}}\n"
             "loads: [{on: {face: x-, layers: 3}, displacement: [0, 0, 0]},"
             " {on: {face: x+, layers: 3}, displacement: [1e-4, 0, 0], history: {ramp to: 1}}]\nsolve: {%s}\n",
             cases[k].solve);
    int status = breccia_model_load_string(deck, "deck", &options, &m, error);
    if (!status) status = breccia_model_step(m, INT64_MAX, error);
    if (cases[k].refused) {
      snprintf(words, sizeof words,
               "deck:5:9: %s: it needs to know how stresses change with strains, and the law bare-glass of material "
               "'vase' does not fill 'tangent'",
               cases[k].refused);
      assert_int_equal(status, BRECCIA_USER_ERROR);
      if (!strstr(breccia_error_text(error), words)) fail_msg("found '%s'", breccia_error_text(error));
    } else if (status) {
      fail_msg("%s: %s", cases[k].solve, breccia_error_text(error));
    }
    breccia_model_destroy(&m);
    breccia_error_destroy(&error);
  }
}

/* "string": elastic up to a strain of 1e-3, where it gives up. */
static int string_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)values, (void)constants, (void)reason, (void)size;
  return 0;
}
static void string_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1e4 / 1.5;
  *shear = 1e4 / 2.5;
}
static int string_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    if (batch->strain[0][i] > 1e-3) return i;
    batch->stress[0][i] = 1e4 * batch->strain[0][i];
    if (batch->tangent) batch->tangent[i] = 1e4;
  }
  return -1;
}
static const breccia_law law_of_string = {.size = sizeof(breccia_law),
                                          .name = "string",
                                          .about = "gives up",
                                          .source = "the tests",
                                          .maturity = "experimental",
                                          .constants_size = 1,
                                          .components = 1,
                                          .prepare = string_prepare,
                                          .moduli = string_moduli,
                                          .update = string_update};

static void a_bond_whose_law_gives_up_takes_both_its_particles_along(void **state)
{
  (void)state;
  /* A row bonded to next neighbours, one gap of which is opened: the two beside it lose the bonds on their other sides too, and no other
   * particle loses any, wherever the gap is. */
  enum { COUNT = 21 };
  for (int gap = 2; gap < COUNT - 3; gap += 3) {
    const breccia_law *const laws[] = {&law_of_string};
    const breccia_options options = {
        .size = sizeof(breccia_options), .laws = laws, .law_count = 1, .threads = 1 + gap % 2};
    breccia_error *error = breccia_error_create();
    breccia_model *m;
    if (breccia_model_load_string(
            "units: {length: m, force: kN, time: s}\nmaterials: {s: {model: string, density: 2}}\n"
            "body: {b: {material: s, lattice: line, area: 1, spacing: 1, shape: {box: {particles: "
            "[21, 1, 1]}}}}\nperidynamics: {formulation: bond-based, space: 1-D, horizon: 1.2}\n"
            "failure: {failed laws: break}\nsolve: {explicit: {time step: 1e-4, steps: 3}}\n",
            "deck", &options, &m, error))
      fail_msg("%s", breccia_error_text(error));
    const Particles *p = m->domain.particles;
    for (int32_t n = gap + 1; n < COUNT; ++n) p->displacement.row[0][p->place_of[n]] = 5e-3;
    step_surely(m, 2);
    assert_near(solver_energy(&m->solver).fracture, 0, 1e-4); /* what gives up carries nothing: 0.125 was stored */
    for (int64_t n = 0; n < m->domain.broken_count; ++n) {
      assert_int_equal(m->domain.broken[n].cause, BREAK_LAW);
      assert_true(isnan(m->domain.broken[n].limit));
      const double opened = m->domain.broken[n].a == gap ? 5e-3 : 0;
      assert_near(m->domain.broken[n].value, opened, 1e-3);
    }
    for (int32_t n = 0; n < COUNT; ++n) {
      const int ends = n == 0 || n == COUNT - 1, lost = n == gap || n == gap + 1       ? 2
                                                        : n == gap - 1 || n == gap + 2 ? 1
                                                                                       : 0;
      assert_int_equal(family_count(&m->domain.family, p->place_of[n]), 2 - ends - lost);
    }
    breccia_model_destroy(&m);
    breccia_error_destroy(&error);
  }
}

/* "wary": elastic, and gives up on more than a tenth of a per mille at once. */
static int wary_values(const void *constants)
{
  (void)constants;
  return 1;
}
static int wary_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    if (!(fabs(batch->strain[0][i] - batch->committed[i]) < 1e-4)) return i;
    batch->trial[i] = batch->strain[0][i];
    batch->stress[0][i] = 1e4 * batch->strain[0][i];
    if (batch->tangent) batch->tangent[i] = 1e4;
  }
  return -1;
}

/** To a stress far away the driver of a point goes in as many parts as the law asks for, from where it was; what a law never takes leaves the state of the last
 *  part that went well. */
static void a_step_that_a_law_refuses_is_cut(void **state)
{
  (void)state;
  breccia_law wary = law_of_string;
  wary.name = "wary";
  wary.history_values = wary_values;
  wary.update = wary_update;
  Material m = {0};
  char reason[100];
  assert_int_equal(material_prepare(&m, &wary, NULL, reason, sizeof reason), 0);
  Driver d;
  assert_int_equal(driver_create(&d, &m, NULL), 0);
  const bool by_stress[6] = {true};
  const double there[6] = {10}, back[6] = {-4}, too_far[6] = {1e6};
  assert_true(driver_step(&d, by_stress, there, 1e-9));
  assert_near(d.strain[0], 1e-3, 1e-12);
  assert_near(d.stress[0], 10, 1e-9);
  assert_true(driver_step(&d, by_stress, back, 1e-9));
  assert_near(d.strain[0], -4e-4, 1e-12);
  assert_false(driver_step(&d, by_stress, too_far, 1e-9));
  assert_near(d.strain[0], -4e-4, 1e-12);
  driver_destroy(&d);
  material_destroy(&m);
}

/** Where volumes hardly change, corners of Mohr and Coulomb's pyramid are found to roundings of stresses that the bulk modulus makes large. */
static void corners_are_found_near_constant_volume(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {m: {model: mohr-coulomb, density: 2, Young modulus: 1e4, Poisson ratio: "
                              "0.49999, cohesion: 6, friction "
                              "angle: 30 deg, dilation angle: 10 deg, tensile strength: 10.392}}\n"
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 3, 3]}}}}\n"
                              "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings}\n"
                              "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x+, layers: "
                              "1}, displacement: [0, 0, 0.1], "
                              "history: {ramp to: 0.05}}]\n"
                              "solve: {explicit: {steps: 1000, damping: 30}}\n");
  step_surely(m, 1000);
  assert_true(solver_energy(&m->solver).dissipated > 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners_are_found_near_constant_volume),
      cmocka_unit_test(a_law_that_gives_up_stops_the_run_or_breaks_its_particle),
      cmocka_unit_test(a_law_that_gives_up_at_rest_is_named_with_its_particle),
      cmocka_unit_test(a_law_without_tangents_is_refused_where_they_are_needed),
      cmocka_unit_test(a_bond_whose_law_gives_up_takes_both_its_particles_along),
      cmocka_unit_test(a_step_that_a_law_refuses_is_cut),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

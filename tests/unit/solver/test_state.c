/* The state of a run as a list of rows: what is copied and given back leads to the same steps, to the bit, and what a step that fails
 * has tried leaves nothing behind. */
#include "model/model.h"
#include "support.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static void copy_state(breccia_model *model, StateCopy *copy)
{
  StateList list = {0};
  model_state(model, &list);
  Error *error = breccia_error_create();
  if (state_copy(copy, &list, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  state_list_destroy(&list);
}

static void return_state(breccia_model *model, const StateCopy *copy)
{
  StateList list = {0};
  model_state(model, &list);
  Error *error = breccia_error_create();
  Team *before = team_use(model->team);
  if (state_return(copy, &list, error)) fail_msg("%s", breccia_error_text(error));
  team_use(before);
  breccia_error_destroy(&error);
  state_list_destroy(&list);
}

/** Fails unless all rows are alike to the bit. Sessions of servers get other numbers when they are taken up again. */
static void assert_same_state(const StateCopy *a, const StateCopy *b)
{
  assert_int_equal(a->count, b->count);
  for (int k = 0; k < a->count; ++k) {
    const StateRow *row = &a->rows[k], *other = &b->rows[k];
    assert_string_equal(row->name, other->name);
    if (!strcmp(row->name, "servers")) continue;
    if (row->count != other->count || memcmp(a->values[k], b->values[k], state_size(row) * (size_t)row->count))
      fail_msg("'%s' is not the same", row->name);
  }
}

static void advance(breccia_model *model, int64_t steps)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, steps, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

/** From a step on: some steps, back, and the same steps again; then on to see that bonds have broken meanwhile. */
static void assert_returns(breccia_model *model, int64_t from, bool breaks)
{
  StateCopy start, first, again, returned;
  advance(model, from);
  copy_state(model, &start);
  const int64_t broken = breccia_model_broken_bonds(model);
  for (int64_t steps = 3; steps <= 60; steps *= 4) {
    advance(model, steps);
    copy_state(model, &first);
    return_state(model, &start);
    copy_state(model, &returned);
    assert_same_state(&start, &returned);
    advance(model, steps);
    copy_state(model, &again);
    assert_same_state(&first, &again);
    if (breaks && steps == 48) assert_true(breccia_model_broken_bonds(model) > broken);
    return_state(model, &start);
    state_copy_destroy(&first);
    state_copy_destroy(&again);
    state_copy_destroy(&returned);
  }
  assert_int_equal(breccia_model_broken_bonds(model), broken);
  state_copy_destroy(&start);
  breccia_model_destroy(&model);
}

static void a_state_given_back_leads_to_the_same_steps(void **state)
{
  (void)state;
  /* A soft plate that yields and tears, in correspondence; then in plane stress, where the law finds a strain. */
  const char *deck =
      "units: {length: m, force: kN, time: s}\n"
      "materials: {clay: {model: multi-yield-j2, density: 1.5, shear modulus: 60000, bulk modulus: "
      "100000, octahedral strength: 30}}\n"
      "body: {plate: {material: clay, lattice: %s, %sspacing: 0.1, shape: {box: {particles: [24, 16%s]}}}}\n"
      "cracks: [{cut: {line: [[1.2, -1], [1.2, 0.4]]}}]\n"
      "%sfailure: {critical stretch: 0.01}\n"
      "loads:\n"
      "  - {on: {face: x-, layers: 3}, body force: [-900, 0, 0], history: {ramp to: 0.005}}\n"
      "  - {on: {face: x+, layers: 3}, body force: [900, 0, 0], history: {ramp to: 0.005}}\n"
      "solve: {explicit: {time step: 1e-4, steps: 5000}}\n";
  assert_returns(model_of(deck, "cubic", "", ", 2", ""), 80, true);
  assert_returns(model_of(deck, "square", "thickness: 1, ", "", "peridynamics: {space: plane stress}\n"), 80, true);
  /* Families that keep what they show, and may carry less. */
  const char *const laws[] = {"elastic", "j2, yield stress: 2e4",
                              "viscoelastic, relaxing share: 0.5, relaxation time: 1e-4"};
  for (int k = 0; k < 3; ++k)
    assert_returns(model_of("units: {length: m, force: kN, time: s}\n"
                            "materials: {rock: {model: %s, density: 2.6, Young modulus: 3e7, Poisson ratio: 0.2}}\n"
                            "body: {plate: {material: rock, spacing: 0.1, shape: {box: {particles: [24, 16, 2]}}}}\n"
                            "cracks: [{cut: {line: [[1.2, -1], [1.2, 0.4]]}}]\n"
                            "peridynamics: {formulation: ordinary}\nfailure: {critical stretch: 0.001}\n"
                            "loads: [{on: {face: x-, layers: 3}, velocity: [-5, 0, 0]}, {on: {face: x+, layers: 3}, "
                            "velocity: [5, 0, 0]}]\nsolve: {explicit: {steps: 5000}}\n",
                            laws[k]),
                   80, !k);
}

static void so_it_does_where_bonds_remember_and_bodies_meet(void **state)
{
  (void)state;
  const char *deck =
      "units: {length: m, force: kN, time: s}\n"
      "materials:\n"
      "  c: {model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture "
      "energy: 30 kN/m}\n"
      "  s: {model: elastic-1d, density: 2.4, Young modulus: 30 GPa}\n"
      "body:\n"
      "  block: {material: c, spacing: 1, shape: {box: {from: [-0.5, -0.5, -0.5], to: [9.5, 3.5, 3.5]}}}\n"
      "  more: {material: s, spacing: 1, shape: {box: {from: [9.6, -0.5, -0.5], to: [14.6, 3.5, 3.5]}}}\n"
      "  hammer: {material: s, spacing: 1, shape: {box: {from: [6, 4.2, 0], to: [8, 6.2, 2]}}}\n"
      "peridynamics: {formulation: bond-based, calibration: continuum}\n"
      "contact: {friction: 0.3}\n"
      "loads:\n"
      "  - {on: {face: x-, layers: 2}, velocity: [0, 0, 0]}\n"
      "  - {on: {block: more}, velocity: [10, 0, 0], history: {ramp to: 0.002}}\n"
      "  - {on: {block: hammer}, velocity: [0, -80, 0]}\n"
      "solve: {explicit: {steps: 3000}}\n";
  assert_returns(model_of(deck, ""), 60, true);
}

/** A server of our own laws. @return its process */
static pid_t serve(const char *address)
{
  int ends[2];
  assert_int_equal(pipe(ends), 0);
  const pid_t child = fork();
  assert_true(child >= 0);
  if (!child) {
    dup2(ends[1], STDOUT_FILENO);
    execl(COMMAND, "breccia", "serve", "--listen", address, "--once", (char *)NULL);
    _exit(127);
  }
  close(ends[1]);
  char word;
  assert_int_equal(read(ends[0], &word, 1), 1); /* "listening at" */
  close(ends[0]);
  return child;
}

static void so_it_does_where_laws_are_in_servers(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-XXXXXX", address[64];
  assert_non_null(mkdtemp(folder));
  snprintf(address, sizeof address, "unix:%s/law", folder);
  const pid_t child = serve(address);
  assert_returns(
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {clay: {remote: 'multi-yield-j2; shear modulus=60000; bulk modulus=100000; octahedral "
               "strength=30', server: ['%s'], density: 1.5}}\n"
               "body: {plate: {material: clay, spacing: 0.1, shape: {box: {particles: [12, 8, 2]}}}}\n"
               "failure: {critical stretch: 0.01}\n"
               "loads:\n"
               "  - {on: {face: x-, layers: 3}, body force: [-1500, 0, 0], history: {ramp to: 0.005}}\n"
               "  - {on: {face: x+, layers: 3}, body force: [1500, 0, 0], history: {ramp to: 0.005}}\n"
               "solve: {explicit: {time step: 1e-4, steps: 5000}}\n",
               address),
      160, true);
  kill(child, SIGTERM);
  waitpid(child, NULL, 0);
  char path[64];
  snprintf(path, sizeof path, "%s/law", folder);
  unlink(path);
  assert_int_equal(rmdir(folder), 0);
}

/* ---- steps that fail ---- */

static int tired_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)reason, (void)size;
  *(double *)constants = values[0];
  return 0;
}
static void tired_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1e5;
  *shear = 6e4;
}
static int tired_values(const void *constants)
{
  (void)constants;
  return 1;
}
/** Softens with the largest strain xx so far, in a way that does not answer the same bits when it is asked twice; gives up at 1e-3. */
static double tired_factor(const breccia_batch *batch, int i)
{
  batch->trial[i] = 0.9 * batch->committed[i] + 0.1 * fabs(batch->strain[0][i]);
  return 1 - 20 * batch->trial[i];
}
static int tired_update(const void *constants, const breccia_batch *batch)
{
  for (int i = 0; i < batch->count; ++i) {
    if (batch->strain[0][i] > *(const double *)constants) return i;
    const double factor = tired_factor(batch, i);
    const double volumetric = 6e4 * (batch->strain[0][i] + batch->strain[1][i] + batch->strain[2][i]);
    for (int k = 0; k < 6; ++k)
      batch->stress[k][i] = factor * ((k < 3 ? volumetric : 0) + (k < 3 ? 2 : 1) * 6e4 * batch->strain[k][i]);
    for (int k = 0; batch->tangent && k < 36; ++k)
      batch->tangent[36 * i + k] = (k % 7 == 0 ? (k < 18 ? 1.2e5 : 6e4) : 0) + (k < 18 && k % 6 < 3 ? 6e4 : 0);
  }
  return -1;
}
static int tired_update_bond(const void *constants, const breccia_batch *batch)
{
  for (int i = 0; i < batch->count; ++i) {
    if (batch->strain[0][i] > *(const double *)constants) return i;
    batch->stress[0][i] = 1.5e5 * tired_factor(batch, i) * batch->strain[0][i];
  }
  return -1;
}
static const breccia_parameter tired_parameters[] = {{"limit", "1", NULL, "(0, inf)", "strain at which it gives up"}};
#define TIRED(word, one_strain, function)                                                                              \
  {                                                                                                                    \
    .size = sizeof(breccia_law), .name = word, .about = "softens and gives up", .source = "this test",                 \
    .maturity = "experimental", .parameters = tired_parameters, .parameter_count = 1,                                  \
    .constants_size = sizeof(double), .components = (one_strain) ? 1 : 6, .prepare = tired_prepare,                    \
    .moduli = tired_moduli, .history_values = tired_values, .update = function                                         \
  }
static const breccia_law tired = TIRED("tired", 0, tired_update), tired_bond = TIRED("tired-1d", 1, tired_update_bond);

static breccia_model *pulled_body(const char *law, double limit, const char *lattice, const char *peridynamics,
                                  double stretch)
{
  static const breccia_law *const laws[] = {&tired, &tired_bond};
  const breccia_options options = {.size = sizeof(breccia_options), .laws = laws, .law_count = 2};
  breccia_model *model = NULL;
  Error *error = breccia_error_create();
  char deck[1024];
  snprintf(
      deck, sizeof deck,
      "units: {length: m, force: kN, time: s}\nmaterials: {v: {model: %s, density: 2, limit: %g}}\n"
      "body: {b: {material: v, spacing: 0.1, %s}}\n%s"
      "failure: {critical stretch: %g, near grips: break}\n"
      "loads: [{on: {face: x-, layers: 3}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 3}, velocity: [0.5, 0.01, "
      "0]}]\nsolve: {explicit: {steps: 3000, damping: 3}}\n",
      law, limit, lattice, peridynamics, stretch);
  if (breccia_model_load_string(deck, "deck", &options, &model, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return model;
}

static void a_step_that_fails_gives_back_every_bit(void **state)
{
  (void)state;
  const struct {
    const char *law, *lattice, *peridynamics;
  } bodies[] = {
      {"tired", "shape: {box: {particles: [12, 4, 4]}}", ""},
      {"tired", "lattice: square, thickness: 1, shape: {box: {particles: [14, 8]}}",
       "peridynamics: {space: plane stress}\n"},
      {"tired-1d", "shape: {box: {particles: [12, 4, 4]}}", "peridynamics: {formulation: bond-based}\n"},
  };
  /* Stretches at which bonds break in steps before the law gives up, so many that the stable step is measured again, and in the very step: a
   * twin whose law does not give up tells. */
  for (size_t b = 0; b < sizeof bodies / sizeof *bodies; ++b) {
    int in_the_step = 0, failed = 0;
    for (int k = 0; k < 45; k += under_sanitizers() ? 3 : 1) {
      const double stretch = 6e-4 + 2.6e-5 * k;
      breccia_model *m = pulled_body(bodies[b].law, 1e-3, bodies[b].lattice, bodies[b].peridynamics, stretch);
      breccia_model *twin = pulled_body(bodies[b].law, 1, bodies[b].lattice, bodies[b].peridynamics, stretch);
      int status = 0;
      int64_t step = 0;
      StateCopy before = {0}, after;
      breccia_model_step(m, 0, NULL); /* forces of the first state */
      while (!status && breccia_model_steps_done(m) < 60) {
        state_copy_destroy(&before);
        copy_state(m, &before);
        step = breccia_model_steps_done(m);
        status = breccia_model_step(m, 1, NULL);
        breccia_model_step(twin, 1, NULL);
      }
      copy_state(m, &after);
      const bool fails = status && breccia_model_steps_done(m) == step; /* not after it, by its energies */
      if (fails) assert_same_state(&before, &after);
      failed += fails;
      in_the_step += fails && breccia_model_broken_bonds(twin) > breccia_model_broken_bonds(m);
      state_copy_destroy(&before);
      state_copy_destroy(&after);
      breccia_model_destroy(&m);
      breccia_model_destroy(&twin);
    }
    assert_true(failed > (under_sanitizers() ? 1 : 3));
    assert_true(in_the_step > 0);
  }
}

/** A bar that is pulled. */
static breccia_model *pulled_bar(const char *strain, const char *more)
{
  char deck[800];
  snprintf(deck, sizeof deck,
           "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
           "body: {b: {material: m, spacing: 1, shape: {box: {particles: [21, 7, 9]}}}}\n"
           "peridynamics: {formulation: correspondence, strain: %s}\n"
           "%s%s",
           strain,
           strstr(more, "loads:")
               ? ""
               : "loads: [{on: {face: x-}, displacement: [0, 0, 0]}, {on: {face: x+}, velocity: [0.3, 0.1, 0]}]\n",
           more);
  breccia_error *error = breccia_error_create();
  const breccia_options options = {.size = sizeof options, .force = 1}; /* steps may be longer than damping allows */
  breccia_model *model;
  if (breccia_model_load_string(deck, "deck", &options, &model, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return model;
}

/** Evaluations of elastic bodies may leave strains and stresses out: whoever looks finds the bits that they would have written, energies, too, and force
 *  states are as they were when he has gone. */
static void strains_that_are_left_out_are_found_to_the_same_bits(void **state)
{
  (void)state;
  for (int finite = 0; finite < 2; ++finite) {
    const char *strain = finite ? "green-lagrange" : "small", *solve = "solve: {explicit: {steps: 40}}\n";
    breccia_model *leaving = pulled_bar(strain, solve), *keeping = pulled_bar(strain, solve);
    Domain *d = &leaving->domain, *with = &keeping->domain;
    const Particles *p = d->particles, *q = with->particles;
    assert_true(d->may_leave_tensors);
    with->may_leave_tensors = false;
    advance(leaving, 7);
    advance(keeping, 7);
    assert_same_numbers(d->strain, with->strain, 6, p->places, "strain after steps");
    assert_same_numbers(d->stress, with->stress, 6, p->places, "stress after steps");
    domain_leave_tensors(d, true);
    domain_evaluate(d, NULL);
    assert_true(d->tensors_are_old);
    assert_true(d->strain[0] != d->own_strain[0]);
    assert_true(domain_stored_energy(d) == domain_stored_energy(with));
    for (int64_t slot = d->family.first[9]; slot < d->family.first[10]; slot += 7) {
      double force[3], same[3];
      domain_bond_force(d, 9, slot, 3, force);
      domain_bond_force(with, 9, slot, 3, same);
      for (int k = 0; k < 3; ++k) assert_true(force[k] == same[k]);
    }
    assert_int_equal(domain_observe(d, NULL), BRECCIA_OK);
    assert_same_numbers(d->strain, with->strain, 6, p->places, "strain");
    assert_same_numbers(d->stress, with->stress, 6, p->places, "stress");
    assert_true(with->stress[0][p->place_of[p->count / 2]] > 1e-3);
    domain_stop_observing(d);
    domain_leave_tensors(d, false);
    assert_int_equal(domain_observe(d, NULL), BRECCIA_OK);
    assert_same_numbers(d->stress, with->stress, 6, p->places, "stress as kept again");
    advance(leaving, 20);
    advance(keeping, 20);
    assert_same_numbers(p->displacement.row, q->displacement.row, 3, p->places, "displacement");
    assert_same_numbers(p->velocity.row, q->velocity.row, 3, p->places, "velocity");
    assert_same_numbers(p->internal.row, q->internal.row, 3, p->places, "force");
    breccia_model_destroy(&leaving);
    breccia_model_destroy(&keeping);
  }
}

static void try_steps_back(const char *solve)
{
  breccia_model *back = pulled_bar("green-lagrange", solve), *apart = pulled_bar("green-lagrange", solve);
  const Particles *p = back->domain.particles, *q = apart->domain.particles;
  apart->domain.may_leave_tensors = false;
  domain_leave_tensors(&back->domain, true);
  Entry entry;
  assert_int_equal(model_enter(back, &entry, NULL), BRECCIA_OK);
  assert_int_equal(model_begin(back, NULL), BRECCIA_OK);
  for (int k = 0; k < 30; ++k) assert_int_equal(model_advance(back, NULL), BRECCIA_OK);
  advance(apart, 30);
  assert_same_numbers(p->displacement.row, q->displacement.row, 3, p->places, "displacement");
  assert_same_numbers(p->velocity.row, q->velocity.row, 3, p->places, "velocity");
  assert_true(back->solver.ledger.kinetic == apart->solver.ledger.kinetic);
  const int32_t i = p->place_of[p->count / 2];
  assert_true(fabs(p->velocity.row[0][i]) > 1e-3);
  const double u = p->displacement.row[0][i + 8], v = p->velocity.row[0][i + 8];
  p->velocity.row[0][i] = NAN; /* the next step comes to no numbers */
  assert_int_equal(model_advance(back, NULL), BRECCIA_FAILURE);
  assert_near(p->displacement.row[0][i + 8], u, 1e-14);
  assert_near(p->velocity.row[0][i + 8], v, 1e-14);
  model_leave(&entry, BRECCIA_OK, NULL);
  breccia_model_destroy(&back);
  breccia_model_destroy(&apart);
}

/** Steps that leave strains and stresses out come to the same bits, and one that fails steps back to the motion with
 * which it began, but for round-off; also where damping is 2 / dt, so that the velocity in the middle of a
 * step says nothing of that at its beginning. */
static void steps_that_step_back_lead_to_the_same_bits(void **state)
{
  (void)state;
  try_steps_back("solve: {explicit: {steps: 40, damping: 0.02}}\n");
  try_steps_back("loads: [{gravity: [3, 1, 0]}]\n"
                 "solve: {explicit: {steps: 40, time step: 0.015625, damping: 128}}\n");
}

/** Stages that linearise, what breaks, and watches of stresses need them in every step. */
static void strains_are_kept_where_steps_need_them(void **state)
{
  (void)state;
  static const struct {
    const char *more;
    bool leaves;
  } cases[] = {{"solve: {explicit: {steps: 4}}\nwatch: {e: {energy: yes}}\n", true},
               {"solve: {explicit: {steps: 4, stiffness damping: 1e-3}}\n", false},
               {"solve: {explicit: {quasi-static: {period: 10}}}\n", false},
               {"solve: [{static: {increments: 2}}, {explicit: {steps: 4}}]\n", false},
               {"solve: {explicit: {steps: 4}}\nfailure: {critical stretch: 0.1}\n", false},
               {"solve: {explicit: {steps: 4}}\ncontact: {}\n", false},
               {"solve: {explicit: {steps: 4}}\nwatch: {s: {stress and strain of: {face: x+}}}\n", false}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = pulled_bar("small", cases[k].more);
    if (m->domain.may_leave_tensors != cases[k].leaves) fail_msg("%s", cases[k].more);
    breccia_model_destroy(&m);
  }
}

/** Arrays that a program has asked for once stay where they are while a stage lasts, and hold what a step has found, of laws that remember, too. */
static void arrays_stay_where_they_are(void **state)
{
  (void)state;
  static const char *const solve[] = {"explicit: {steps: 20}", "implicit: {end time: 4, time step: 0.1}",
                                      "static: {increments: 20}"};
  static const char *const names[] = {"displacement x", "velocity x", "force x", "strain xx", "stress xx", "stress xy"};
  enum { NAMES = sizeof names / sizeof *names };
  for (size_t n = 0; n < sizeof solve / sizeof *solve; ++n) {
    char deck[600];
    snprintf(deck, sizeof deck,
             "materials: {m: {model: j2, density: 1, Young modulus: 150, Poisson ratio: 0.25, yield stress: 0.5}}\n"
             "body: {b: {material: m, spacing: 1, shape: {box: {particles: [9, 4, 5]}}}}\n"
             "loads: [{on: {face: x-}, displacement: [0, 0, 0]}, {on: {face: x+}, velocity: [0.1, 0, 0]}]\n"
             "solve: {%s}\n",
             solve[n]);
    breccia_model *m = model_of("%s", deck);
    double *held[NAMES];
    for (int k = 0; k < NAMES; ++k) held[k] = breccia_model_array(m, names[k]);
    for (int step = 1; step <= 4; ++step) {
      advance(m, step);
      for (int k = 0; k < NAMES; ++k) assert_ptr_equal(breccia_model_array(m, names[k]), held[k]);
    }
    breccia_model_destroy(&m);
  }
}

static void rows_have_names_of_their_own_and_known_units(void **state)
{
  (void)state;
  breccia_model *m = pulled_body("tired", 1e-3, "shape: {box: {particles: [12, 4, 4]}}", "", 1e-3);
  StateList list = {0};
  model_state(m, &list);
  assert_false(list.failed);
  for (int k = 0; k < list.count; ++k) {
    assert_ptr_equal(state_find(&list, list.rows[k].name), &list.rows[k]);
    if (!dimension_find(list.rows[k].unit)) fail_msg("%s: unit '%s'", list.rows[k].name, list.rows[k].unit);
    assert_true(list.rows[k].values || (list.rows[k].care && list.rows[k].care->save));
  }
  assert_ptr_equal(breccia_model_array(m, "force y"), m->domain.particles->internal.row[1]);
  assert_ptr_equal(breccia_model_array(m, "stress zx"), m->domain.regions[0].points.stress[5]);
  assert_null(breccia_model_array(m, "history"));
  assert_null(breccia_model_array(m, "force"));
  state_list_destroy(&list);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_state_given_back_leads_to_the_same_steps),
      cmocka_unit_test(so_it_does_where_bonds_remember_and_bodies_meet),
      cmocka_unit_test(so_it_does_where_laws_are_in_servers),
      cmocka_unit_test(a_step_that_fails_gives_back_every_bit),
      cmocka_unit_test(strains_that_are_left_out_are_found_to_the_same_bits),
      cmocka_unit_test(steps_that_step_back_lead_to_the_same_bits),
      cmocka_unit_test(strains_are_kept_where_steps_need_them),
      cmocka_unit_test(arrays_stay_where_they_are),
      cmocka_unit_test(rows_have_names_of_their_own_and_known_units),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

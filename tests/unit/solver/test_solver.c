#include "base/random.h"
#include "solver/stable_step.h"
#include "support.h"

#define STEEL "materials: {m: {model: elastic, density: 7.85, Young modulus: 2.1e8, Poisson ratio: %s}}\n"

static void a_free_body_under_gravity_falls_as_galilei_says(void **state)
{
  (void)state;
  breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [5, 5, 5]}}}}\n"
                              "loads: [{gravity: [0, 0, -9.81]}]\nsolve: {explicit: {steps: 500}}\n");
  assert_int_equal(breccia_model_step(m, 500, NULL), 0);
  double t = breccia_model_time(m), *u = breccia_model_array(m, "displacement z");
  for (int64_t n = 0; n < 125; ++n)
    assert_near(u[m->domain.particles->place_of[n]], -9.81 * t * t / 2, 1e-10 * 9.81 * t * t);
  breccia_model_destroy(&m);
}

static void a_wave_runs_along_a_slender_bar_at_root_e_over_rho(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* other bodies take explicit steps */
  /* validation A6: 5172 m/s; a velocity step at one end, arrival at 2 % of it, 5 cells across. */
  breccia_model *m =
      model_of(STEEL "units: {length: m, force: kN, time: s}\n"
                     "peridynamics: {horizon: 2.015 spacings}\n"
                     "body: {b: {material: m, spacing: 0.0125, shape: {box: {particles: [160, 5, 5]}}}}\n"
                     "loads: [{on: {face: x-, layers: 2}, velocity: [1, free, free], history: {ramp to: 2e-5}}]\n"
                     "solve: {explicit: {end time: 2.6e-4}}\n",
               "0.29");
  const double near[3] = {0.5, 0.03, 0.03}, far[3] = {1.2, 0.03, 0.03};
  int32_t a = particles_nearest(m->domain.particles, near), b = particles_nearest(m->domain.particles, far);
  double *v = breccia_model_array(m, "velocity x"), first = 0, second = 0;
  while (second == 0 && m->solver.clock.step < m->solver.clock.steps) {
    breccia_model_step(m, 1, NULL);
    if (first == 0 && v[a] > 0.5) first = breccia_model_time(m);
    if (second == 0 && v[b] > 0.5) second = breccia_model_time(m);
  }
  assert_true(second > 0);
  double speed = (m->domain.particles->position[0][b] - m->domain.particles->position[0][a]) / (second - first);
  assert_near(speed, sqrt(2.1e8 / 7.85), 0.05 * 5172);
  breccia_model_destroy(&m);
}

static breccia_model *shaken_plate(const char *more)
{
  return model_of(
      "materials: {m: {model: multi-yield-j2, density: 1.5, shear modulus: 60000, bulk modulus: 100000, octahedral "
      "strength: 30}}\n"
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [20, 9, 3]}}}}\n"
      "cracks: [{cut: {line: [[1, -1], [1, 0.4]]}}]\n"
      "failure: {critical stretch: 0.004}\n"
      "loads: [{on: {face: x+, layers: 2}, body force: [900, 0, 0], history: {ramp to: 0.004}},\n"
      "        {on: {face: x-, layers: 2}, velocity: [0, 0.3, free], history: {sine: {frequency: 100}}}]\n"
      "solve: {explicit: {steps: 600, time step: 5e-5%s}}\n",
      more);
}

static void energy_of_loads_motions_damping_yielding_and_cracks_balances(void **state)
{
  (void)state;
  const char *const cases[] = {"", ", damping: 50", ", local damping: 0.5"};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = shaken_plate(cases[k]);
    breccia_error *error = breccia_error_create();
    if (breccia_model_step(m, 600, error)) fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
    Energy e = solver_energy(&m->solver);
    assert_true(e.external > 0);
    assert_true(breccia_model_broken_bonds(m) > 0);
    assert_true(e.fracture > 0);
    if (k) assert_true(e.damping > 0.01 * e.external);
    if (e.imbalance > 2e-3) fail_msg("%s: imbalance %g", cases[k], e.imbalance);
    breccia_model_destroy(&m);
  }
}

static void an_elastic_body_keeps_its_energy(void **state)
{
  (void)state;
  breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 6, 5]}}}}\n"
                              "solve: {explicit: {steps: 3000, safety: 0.1}}\n");
  double *v = breccia_model_array(m, "velocity x");
  const Particles *p = m->domain.particles;
  double start = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    v[p->place_of[n]] = p->position[0][p->place_of[n]] > 0.4 ? 0.1 : -0.1;
    start += 0.5 * 2 * p->volume[p->place_of[n]] * 0.01;
  }
  breccia_model_step(m, 3000, NULL);
  Energy e = solver_energy(&m->solver);
  assert_near(e.kinetic + e.internal, start, 0.002 * start);
  assert_true(e.imbalance < 0.002);
  assert_true(e.internal > 0.05 * start);
  breccia_model_destroy(&m);
}

/** However long it swings: what a formulation does beside free surfaces must not feed it, and the step must be stable. */
static void free_bodies_keep_their_energy(void **state)
{
  (void)state;
  static const struct {
    const char *law, *peridynamics;
  } of[] = {{"elastic-1d, Young modulus: 1e4", "formulation: bond-based"},
            {"elastic-1d, Young modulus: 1e4", "formulation: bond-based, surface correction: energy"},
            {"elastic, Young modulus: 1e4, Poisson ratio: 0.3", "formulation: ordinary"},
            {"elastic, Young modulus: 1e4, Poisson ratio: 0.3", "formulation: correspondence"},
            {"elastic, Young modulus: 1e4, Poisson ratio: 0.3", "formulation: hybrid"},
            {"elastic, Young modulus: 1e4, Poisson ratio: 0.3", "formulation: micropolar"}};
  for (int k = 0; formulation_at(k); ++k) { /* every one of the program */
    char key[80];
    size_t n = 0;
    snprintf(key, sizeof key, "formulation: %s", formulation_at(k)->name);
    while (n < sizeof of / sizeof *of && strncmp(of[n].peridynamics, key, strlen(key)) != 0) ++n;
    if (n == sizeof of / sizeof *of) fail_msg("%s is not among the free bodies", formulation_at(k)->name);
  }
  const int steps = under_sanitizers() ? 1000 : whole_walks() ? 20000 : 5000;
  const double mass = 2 * (2 * 5 * 0.01 * 0.3), whole = 0.5 * mass * 0.25; /* of what moves at the start */
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\n"
        "materials: {m: {model: %s, density: 2}}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [12, 5]}}}}\n"
        "peridynamics: {%s, space: plane stress, horizon: 1.5 spacings}\n"
        "loads: [{on: {face: x+, layers: 2}, initial velocity: {translation: [0, 0.5, 0]}}]\n"
        "solve: {explicit: {safety: 0.5, steps: %d}}\n",
        of[k].law, of[k].peridynamics, steps);
    step_surely(m, steps);
    const Energy e = solver_energy(&m->solver);
    print_message("%s: kinetic and stored %.4f of the energy of the start\n", of[k].peridynamics,
                  (e.kinetic + e.stored) / whole);
    assert_near(e.kinetic + e.stored, whole, 0.015 * whole);
    assert_true(e.stored > 1e-3 * whole);
    assert_near(sums_of(m).momentum[1], mass * 0.5, 1e-7 * mass);
    breccia_model_destroy(&m);
  }
}

static void damping_takes_the_speed_of_a_free_body_as_its_rate_says(void **state)
{
  (void)state;
  /* v = v0 exp(-c t); a ratio z of critical damping at f is the rate c = 2 z omega = 4 pi z f. */
  const struct {
    const char *words;
    double rate;
  } cases[] = {{"90", 90},
               {"90 1/s", 90},
               {"0.09 ms-1", 90},
               {"{ratio: 0.05, at: 120 Hz}", 4 * acos(-1) * 0.05 * 120},
               {"{ratio: 1, at: 0.02 kHz}", 4 * acos(-1) * 20}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                                "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                                "solve: {explicit: {steps: 200, time step: 5e-5, damping: %s}}\n",
                                cases[k].words);
    double *v = breccia_model_array(m, "velocity y");
    for (int64_t n = 0; n < breccia_model_places(m); ++n) v[n] = 0.1;
    breccia_model_step(m, 200, NULL);
    const double left = v[m->domain.particles->place_of[21]] / 0.1;
    assert_near(left, exp(-cases[k].rate * 0.01), 1e-5);
    breccia_model_destroy(&m);
  }
}

static void the_stable_step_is_stable_and_a_tenth_more_is_not(void **state)
{
  (void)state;
  const char *const bodies[] = {"spacing: 0.1, shape: {box: {particles: [12, 9, 2]}}",
                                "spacing: 0.1, shape: {box: {particles: [6, 6, 6]}}",
                                "spacing: 0.1, lattice: square, thickness: 1, shape: {box: {particles: [15, 11]}}"};
  const char *const controls[] = {"silling: 0.1", "silling: 1", "wan: 1", "none: yes"};
  /* What grows by 1 % in a step is 1e6 times as large after 1400 of them. */
  const int64_t steps = under_sanitizers() ? 300 : whole_walks() ? 4000 : 1500;
  for (int b = under_sanitizers() ? 2 : 0; b < 3; ++b)
    for (int c = 0; c < 4; ++c)
      for (int over = 0; over < 2; ++over) {
        breccia_model *m =
            model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.3}}\n"
                     "peridynamics: {strain: small, space: %s, zero-energy control: {%s}}\n"
                     "body: {b: {material: m, %s}}\nsolve: {explicit: {steps: 4000}}\n",
                     b == 2 ? "plane strain" : "3-D", controls[c], bodies[b]);
        m->solver.clock.time_step = m->solver.clock.stable * (over ? 1.1 : 1);
        const Particles *p = m->domain.particles;
        for (int64_t n = 0; n < p->count; ++n) p->velocity.row[n % 2][p->place_of[n]] = (double)(n * 7919 % 13) * 1e-9;
        const int stopped = breccia_model_step(m, steps, NULL);
        double largest = 0;
        for (int64_t n = 0; n < p->count; ++n)
          largest = larger_of(largest, fabs(p->displacement.row[0][p->place_of[n]]));
        if (over ? !stopped && largest < 1e-3 : stopped || !(largest < 1e-3))
          fail_msg("body %d, control %s, %s the stable step: displacement %g", b, controls[c], over ? "above" : "at",
                   largest);
        breccia_model_destroy(&m);
      }
}

/** A sum over all bonds of force components times random numbers. */
static double bond_forces(const Domain *d)
{
  double sum = 0, force[3];
  uint64_t seed = 7;
  for (int64_t s = 0; s < d->particles->slices; ++s)
    for (int64_t slot = d->family.first[s]; slot < d->family.first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(d->family.intact[slot] >> lane & 1)) continue;
        domain_bond_force(d, s, slot, lane, force);
        for (int k = 0; k < 3; ++k) sum += force[k] * random_uniform(&seed);
      }
  return sum;
}

static void measuring_the_stable_step_leaves_no_trace(void **state)
{
  (void)state;
  breccia_model *m = shaken_plate("");
  breccia_model_step(m, 400, NULL);
  const double before = bond_forces(&m->domain);
  double step;
  assert_int_equal(stable_step(&m->domain, &step, NULL), 0);
  assert_true(before != 0);
  assert_true(bond_forces(&m->domain) == before);
  breccia_model_destroy(&m);
}

static void threads_do_not_change_a_bit(void **state)
{
  (void)state;
  double *reference[3] = {0};
  const int threads[] = {1, 8, 2, 3};
  for (int k = 0; k < (whole_walks() ? 4 : 2); ++k) {
    breccia_model *m = shaken_plate("");
    m->threads = threads[k];
    breccia_model_step(m, 600, NULL);
    size_t bytes = sizeof(double) * (size_t)breccia_model_places(m);
    double *const now[3] = {breccia_model_array(m, "displacement x"), breccia_model_array(m, "stress xy"),
                            &m->solver.ledger.bond_work};
    for (int a = 0; a < 3; ++a) {
      size_t size = a < 2 ? bytes : sizeof(double);
      if (!k) {
        reference[a] = malloc(size);
        memcpy(reference[a], now[a], size);
      } else
        assert_memory_equal(now[a], reference[a], size);
    }
    breccia_model_destroy(&m);
  }
  for (int a = 0; a < 3; ++a) free(reference[a]);
}

static void broken_bonds_stay_broken_and_damage_grows(void **state)
{
  (void)state;
  breccia_model *m = shaken_plate("");
  double before = 0;
  for (int k = 0; k < 6; ++k) {
    breccia_model_step(m, 100, NULL);
    double damage = 0;
    for (int64_t n = 0; n < m->domain.particles->count; ++n)
      damage += domain_damage(&m->domain, m->domain.particles->place_of[n]);
    assert_true(damage >= before);
    before = damage;
  }
  assert_true(before > 0);
  /* No bond that is left is stretched beyond the limit, and every broken one has been. */
  const Domain *d = &m->domain;
  for (int64_t s = 0; s < d->particles->slices; ++s)
    for (int64_t slot = d->family.first[s]; slot < d->family.first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(d->family.intact[slot] >> lane & 1)) continue;
        Bond bond = family_bond(&d->family, s, slot, lane);
        assert_false(d->failure.criterion->exceeds(&d->failure, &d->family, s, slot, &bond, lane));
      }
  breccia_model_destroy(&m);
}

static void looking_only_where_bonds_may_break_misses_none(void **state)
{
  (void)state;
  /* A copy that looks at every bond in every step breaks the same bonds at the same steps. */
  breccia_model *lazy = shaken_plate(""), *thorough = shaken_plate("");
  int64_t skipped = 0;
  for (int k = 0; k < 600; ++k) {
    breccia_model_step(lazy, 1, NULL);
    memset(thorough->domain.look_again, 0, sizeof(double) * (size_t)thorough->domain.particles->slices);
    breccia_model_step(thorough, 1, NULL);
    assert_int_equal(lazy->domain.broken_count, thorough->domain.broken_count);
    for (int64_t s = 0; s < lazy->domain.particles->slices; ++s)
      skipped += lazy->domain.look_again[s] > lazy->domain.motion;
  }
  assert_true(lazy->domain.broken_count > 0);
  assert_true(skipped > 300 * lazy->domain.particles->slices);
  breccia_model_destroy(&lazy);
  breccia_model_destroy(&thorough);
}

static void prescribed_particles_go_where_they_are_told(void **state)
{
  (void)state;
  breccia_model *m =
      model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}\n"
               "loads:\n"
               "  - {on: {face: x-}, displacement: [0, 0, 0]}\n"
               "  - {on: {face: x+}, along: {direction: [3, 4, 0], displacement: 0.01}, history: {table: [[0, 0], "
               "[0.005, 1], [0.01, 0.5]]}}\n"
               "solve: {explicit: {end time: 0.01, safety: 0.1}}\n");
  breccia_model_step(m, m->solver.clock.steps, NULL);
  const Particles *p = m->domain.particles;
  const Selection *s = &m->loading.loads[1].selection;
  double t = breccia_model_time(m), factor = t < 0.01 ? 1 - 0.5 * (t - 0.005) / 0.005 : 0.5;
  assert_int_equal(s->count, 16);
  for (int64_t n = 0; n < s->count; ++n) {
    int32_t i = s->places[n];
    assert_near(0.6 * p->displacement.row[0][i] + 0.8 * p->displacement.row[1][i], 0.01 * factor, 1e-12);
  }
  assert_near(p->displacement.row[0][m->loading.loads[0].selection.places[3]], 0, 1e-15);
  Energy e = solver_energy(&m->solver);
  if (e.imbalance > 1e-2)
    fail_msg("imbalance %g: external %g kinetic %g internal %g damping %g", e.imbalance, e.external, e.kinetic,
             e.internal, e.damping);
  breccia_model_destroy(&m);
}

static void a_load_that_sets_in_late_stops_nothing(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *m;
  const char *deck =
      "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
      "loads:\n"
      "  - {on: {all: yes}, body force: [1e-6, 0, 0]}\n"
      "  - {on: {face: x+}, body force: [1, 0, 0], history: {table: [[0, 0], [0.0101, 0], [0.0102, 1]]}}\n"
      "solve: {explicit: {time step: 1e-4, steps: 200}}\n";
  for (int alone = 0; alone < 2; ++alone) {
    char words[1024];
    snprintf(words, sizeof words, "%s", deck);
    if (alone) memcpy(strstr(words, "1e-6"), "0   ", 4);
    assert_int_equal(breccia_model_load_string(words, "deck", NULL, &m, error), 0);
    if (breccia_model_step(m, 200, error)) fail_msg("%s", breccia_error_text(error));
    breccia_model_destroy(&m);
  }
  breccia_error_destroy(&error);
}

static void energy_from_nothing_stops_the_run(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *m;
  const breccia_options force = {.size = sizeof(breccia_options), .force = 1};
  const char *deck = "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                     "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                     "loads: [{on: {face: x+}, body force: [1, 0, 0]}]\n"
                     "solve: {explicit: {time step: 0.01, steps: 100000}}\n";
  assert_int_equal(breccia_model_load_string(deck, "deck", &force, &m, error), 0);
  assert_int_equal(breccia_model_step(m, 100000, error), BRECCIA_FAILURE);
  const char *words = breccia_error_text(error);
  holds_words(
      words,
      "energy from nothing: kinetic |, internal |, fracture |, while loads and motions have put in |; the time step "
      "of 0.01 s (stable step |) is too long for what happens, or bonds that break or close give more than they "
      "got: choose a smaller 'safety' or 'time step', more zero-energy control, or leave contact out");
  assert_true(m->solver.clock.step < 100);
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

/** A spring that is too stiff for the step takes from itself what it gives, so that works say nothing; speeds do. */
static void a_run_that_blows_up_stops_within_ten_steps_of_the_first_absurd_speed(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *m;
  const breccia_options force = {.size = sizeof(breccia_options), .force = 1};
  const char *deck =
      SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                 "loads: [{on: {face: x-}, spring: {stiffness: 1e6}}, {on: {all: yes}, body force: [1, 0, 0]}]\n"
                 "solve: {explicit: {time step: 5e-4, steps: 100000}}\n";
  assert_int_equal(breccia_model_load_string(deck, "deck", &force, &m, error), 0);
  const double wave = sqrt((m->domain.materials[0].bulk + 4 * m->domain.materials[0].shear / 3) / 2);
  int64_t absurd = -1;
  int status = BRECCIA_OK;
  while (!status && m->solver.clock.step < 5000) {
    status = breccia_model_step(m, 1, error);
    if (absurd < 0 && m->solver.ledger.fastest > 10 * wave) absurd = m->solver.clock.step;
  }
  assert_int_equal(status, BRECCIA_FAILURE);
  holds_words(
      breccia_error_text(error),
      "has blown up: particle |] moves at | m/s, more than |times the waves of the materials (77.46 m/s) and the "
      "speeds at "
      "the start and prescribed (0 m/s) together; the time step of 0.0005 s (stable step |) is too long for what "
      "happens, or "
      "bonds that break or close give more than they got: choose a smaller 'safety' or 'time step', more zero-energy "
      "control, or leave contact out");
  assert_true(absurd > 0 && m->solver.clock.step <= absurd + 10);
  assert_true(m->solver.ledger.unsound_steps > 0); /* so that the checkpoint before is kept */
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

/** Rotations are no speeds: one that is beyond all bounds shows in the energy alone. The first holds less than all mass at a thousand times the
 *  waves, the second a thousand times more. */
static void a_rotation_that_blows_up_stops_a_run_too(void **state)
{
  (void)state;
  static const double turning[] = {3e6, 1e9};
  for (int k = 0; k < 2; ++k) {
    breccia_error *error = breccia_error_create();
    breccia_model *m;
    const char *deck = SOFT_SOLID
        "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [24, 10]}}}}\n"
        "peridynamics: {formulation: micropolar, space: plane strain}\n"
        "solve: {explicit: {time step: 1e-13, steps: 1000}}\n";
    assert_int_equal(breccia_model_load_string(deck, "deck", NULL, &m, error), 0);
    const Particles *p = m->domain.particles;
    const int32_t i = p->place_of[31];
    assert_true(particles_have_rotations(p));
    p->velocity.row[p->space.rows - 1][i] = turning[k];
    assert_int_equal(breccia_model_step(m, 1, error), k ? BRECCIA_FAILURE : BRECCIA_OK);
    assert_int_equal(ledger_has_blown_up(&m->solver.ledger), k);
    if (k)
      holds_words(breccia_error_text(error),
                  "step 1 (|: the computation has blown up: particle 31 at [|] turns at 1e+09 1/s, so that kinetic "
                  "energy is as "
                  "if all mass moved at |, more than 10 times the waves of the materials (77.46 m/s) ");
    breccia_model_destroy(&m);
    breccia_error_destroy(&error);
  }
}

/** Fast for its material is no mistake: a shot, a body that is pulled away, and one that falls for long. */
static void speeds_that_the_deck_gives_stop_nothing(void **state)
{
  (void)state;
  static const char *const loads[] = {"{on: {all: yes}, initial velocity: {translation: [1e5, 0, 0]}}",
                                      "{on: {all: yes}, velocity: [1e5, 0, 0]}",
                                      "{on: {all: yes}, body force: [4e4, 0, 0]}"};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m =
        model_of(SOFT_SOLID "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                            "loads: [%s]\nsolve: {explicit: {steps: 200}}\n",
                 loads[k]);
    step_surely(m, 200);
    assert_true(m->solver.ledger.fastest > 12 * ledger_wave_speed(&m->domain));
    breccia_model_destroy(&m);
  }
}

static void a_force_that_is_no_number_is_reported_with_place_step_and_cause(void **state)
{
  (void)state;
  breccia_error *error = breccia_error_create();
  breccia_model *m = model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                              "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                              "solve: {explicit: {steps: 100}}\n");
  m->domain.particles->velocity.row[0][m->domain.particles->place_of[77]] = 1e200;
  assert_int_equal(breccia_model_step(m, 100, error), BRECCIA_FAILURE);
  holds_words(breccia_error_text(error), "step 1 (time |: the force on particle |] is not a number; likely cause: | "
                                         "(time step |, stable step |, kinetic energy ");
  for (int64_t i = 0; i < breccia_model_places(m); ++i)
    assert_true(isfinite(breccia_model_array(m, "displacement x")[i]));
  breccia_model_destroy(&m);
  breccia_error_destroy(&error);
}

static void a_step_above_the_stable_one_is_refused(void **state)
{
  (void)state;
  char *words = refusal_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                           "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                           "solve: {explicit: {time step: 0.01, steps: 10}}\n");
  assert_non_null(strstr(words, "times the stable step"));
  free(words);
  /* near to it a warning says so */
  static const char body[] = "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                             "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
                             "solve: {explicit: {time step: %.17g, steps: 10}}\n";
  breccia_model *m = model_of(body, 1e-6);
  const double stable = m->solver.clock.stable;
  breccia_model_destroy(&m);
  for (int near = 0; near < 2; ++near) {
    m = model_of(body, (near ? 0.91 : 0.89) * stable);
    assert_true(near == (strstr(breccia_model_warnings(m), "is 0.91 times the stable step of ") != NULL));
    breccia_model_destroy(&m);
  }
  /* and where no bond is left nobody knows a stable one */
  static const char *const steps[] = {"steps: 10", "end time: 1", "time step: 0.01, steps: 10"};
  for (int k = 0; k < 3; ++k) {
    char deck[512];
    snprintf(deck, sizeof deck,
             "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
             "body: {b: {material: m, lattice: line, area: 1, spacing: 0.1, shape: {box: {particles: [4, 1]}}}}\n"
             "cracks: [{remove: {box: {from: [0.1, -1], to: [0.3, 1]}}}]\n"
             "peridynamics: {space: 1-D, formulation: bond-based, horizon: 1.5 spacings}\nsolve: {explicit: {%s}}\n",
             steps[k]);
    words = refusal_of(deck);
    if (!strstr(words,
                "deck:4:62: horizon: no bond joins any of the 2 particles within 0.15 m; choose a longer horizon"))
      fail_msg("%s", words);
    free(words);
  }
}

/* ---- static check of the example against finite elements ---- */

/** Returns the plate of the example: by its own deck, in damped motion, with BRECCIA_WHOLE; else by a static solver and
 *  three particles that hold the body as a whole, in place of 'explicit'. */
static breccia_model *plate_with_crack(void)
{
  breccia_model *m;
  if (whole_walks()) {
    assert_int_equal(breccia_model_load_file(EXAMPLES "/plate-with-crack/rest.yaml", NULL, &m, NULL), 0);
    return m;
  }
  char deck[4096], *solve;
  FILE *file = fopen(EXAMPLES "/plate-with-crack/rest.yaml", "r");
  assert_non_null(file);
  deck[fread(deck, 1, sizeof deck - 1, file)] = 0;
  fclose(file);
  solve = strstr(deck, "solve: {explicit");
  assert_non_null(solve);
  *solve = 0;
  return model_of("%ssolve: [{static: {increments: 1}, loads: [\n"
                  "  {on: {nearest: [1.035, 1.89, 0]}, displacement: [0, 0, 0]},\n"
                  "  {on: {nearest: [0, 1.89, 0]}, displacement: [free, 0, 0]},\n"
                  "  {on: {nearest: [1.035, 0.9, 0]}, displacement: [free, free, 0]}]}]\n",
                  deck);
}

static void plate_with_crack_opens_at_rest_as_finite_elements_say(void **state)
{
  (void)state;
  if (under_sanitizers()) skip();
  /* validation: 500 kN/m3 open the mouth by 3.34 mm, converged quadrilaterals; control 0.1; 2 %. */
  breccia_model *m = plate_with_crack();
  step_surely(m, INT64_MAX);
  const double left[3] = {1.02, 0, 0}, right[3] = {1.08, 0, 0};
  const Particles *p = m->domain.particles;
  int32_t a = particles_nearest(p, left), b = particles_nearest(p, right);
  Energy e = solver_energy(&m->solver);
  assert_true(e.kinetic < 1e-5 * e.internal);
  double opening = p->displacement.row[0][b] - p->displacement.row[0][a];
  print_message("opening at rest: %.4f mm\n", 1e3 * opening);
  assert_near(opening, 3.34e-3, 0.02 * 3.34e-3);
  breccia_model_destroy(&m);
}

static void prescribed_particles_have_the_velocity_of_their_motion(void **state)
{
  (void)state;
  /* Parabolas, of which the speed at the end of a step is known to all digits: x = D (t / T)^2, and x = V t^2 / 2 T, along slanting directions. */
  breccia_model *m =
      model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [8, 4, 4]}}}}\n"
               "loads:\n"
               "  - {on: {face: x-}, along: {direction: [4, 0, -3], displacement: 0.02}, history: {product: [{ramp to: "
               "0.02}, {ramp to: 0.02}]}}\n"
               "  - {on: {face: x+}, along: {direction: [3, 4, 0], velocity: 2}, history: {ramp to: 0.02}}\n"
               "solve: {explicit: {end time: 0.02, safety: 0.4}}\n");
  const Particles *p = m->domain.particles;
  const double direction[2][3] = {{0.8, 0, -0.6}, {0.6, 0.8, 0}};
  for (int step = 0; step < 12; ++step) {
    step_surely(m, 1);
    const double t = breccia_model_time(m), speed[2] = {2 * 0.02 * t / (0.02 * 0.02), 2 * t / 0.02};
    for (int n = 0; n < 2; ++n) {
      const Selection *s = &m->loading.loads[n].selection;
      for (int64_t q = 0; q < s->count; ++q) {
        double along = 0;
        for (int k = 0; k < 3; ++k) along += direction[n][k] * p->velocity.row[k][s->places[q]];
        assert_near(along, speed[n], 1e-9 * speed[n]);
      }
    }
  }
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_body_under_gravity_falls_as_galilei_says),
      cmocka_unit_test(a_wave_runs_along_a_slender_bar_at_root_e_over_rho),
      cmocka_unit_test(energy_of_loads_motions_damping_yielding_and_cracks_balances),
      cmocka_unit_test(an_elastic_body_keeps_its_energy),
      cmocka_unit_test(free_bodies_keep_their_energy),
      cmocka_unit_test(damping_takes_the_speed_of_a_free_body_as_its_rate_says),
      cmocka_unit_test(the_stable_step_is_stable_and_a_tenth_more_is_not),
      cmocka_unit_test(measuring_the_stable_step_leaves_no_trace),
      cmocka_unit_test(threads_do_not_change_a_bit),
      cmocka_unit_test(broken_bonds_stay_broken_and_damage_grows),
      cmocka_unit_test(looking_only_where_bonds_may_break_misses_none),
      cmocka_unit_test(prescribed_particles_go_where_they_are_told),
      cmocka_unit_test(energy_from_nothing_stops_the_run),
      cmocka_unit_test(a_run_that_blows_up_stops_within_ten_steps_of_the_first_absurd_speed),
      cmocka_unit_test(a_rotation_that_blows_up_stops_a_run_too),
      cmocka_unit_test(speeds_that_the_deck_gives_stop_nothing),
      cmocka_unit_test(a_load_that_sets_in_late_stops_nothing),
      cmocka_unit_test(a_force_that_is_no_number_is_reported_with_place_step_and_cause),
      cmocka_unit_test(a_step_above_the_stable_one_is_refused),
      cmocka_unit_test(plate_with_crack_opens_at_rest_as_finite_elements_say),
      cmocka_unit_test(prescribed_particles_have_the_velocity_of_their_motion),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

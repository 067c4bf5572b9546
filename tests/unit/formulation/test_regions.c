/* Bodies of several formulations: what their joints keep, pass and break. */
#include "support.h"

#include "base/random.h"
#include "base/tensor.h"

#define MATERIALS                                                                                                      \
  "materials: {solid: {model: elastic, density: 2, Young modulus: 150, Poisson ratio: 0.25}, fibre: {model: "          \
  "elastic-1d, density: 2, Young modulus: 150}}\n"

/** A bar along x, its left half of fibres, in plane strain. */
static breccia_model *bar(const char *peridynamics, const char *fibres, int columns, int rows, const char *rest)
{
  return model_of(MATERIALS
                  "peridynamics: {space: plane strain, %s, regions: {fibres: {blocks: [left], formulation: bond-based, "
                  "calibration: %s}}}\n"
                  "body: {left: {material: fibre, spacing: 1, lattice: square, thickness: 1, shape: {box: {particles: "
                  "[%d, %d]}}}, right: {material: solid, spacing: 1, lattice: square, thickness: 1, shape: {box: "
                  "{from: [%d, 0], to: [%d, %d]}}}}\n%s",
                  peridynamics, fibres, columns / 2, rows, columns / 2, columns, rows, rest);
}

#define ONE_STEP "solve: {explicit: {steps: 1, time step: 1e-3}}\n"

/** Both halves have the same modulus of expansion, the one of its families, the other of its bonds as they are calibrated. In uniform expansion
 *  what crosses a plane near the joint is half of the one stress and half of the other: nothing in all pulls at the particles of
 *  one side. Single ones are pulled, because shares of half families differ, but none that is further from the joint than a horizon. */
static void a_patch_pulls_at_the_joint_only_and_not_in_all(void **state)
{
  (void)state;
  for (int c = 0; c < 2; ++c) {
    breccia_model *model =
        bar(c ? "horizon: 2.015, influence: conical" : "horizon: 3.015", "uniform-expansion", 40, 30, ONE_STEP);
    const Domain *d = &model->domain;
    const Particles *p = d->particles;
    const double f[9] = {1 + 1e-6, 0, 0, 0, 1 + 1e-6, 0, 0, 0, 1}, stress = 1e-6 * 1.6 * 150,
                 horizon = d->family.horizon;
    double side[2] = {0}, most = 0;
    deform_uniformly(model, f);
    compute_forces(model);
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      const double x = p->position[0][i] - 20, y = p->position[1][i], force = p->internal.row[0][i];
      if (fabs(x) > 10 || fabs(y - 15) > 2) continue; /* beside the surfaces of the bar */
      assert_near(p->internal.row[1][i], 0, 1e-8 * stress);
      if (fabs(x) > horizon)
        assert_near(force, 0, 1e-8 * stress);
      else
        most = larger_of(most, fabs(force));
      side[x > 0] += force;
    }
    assert_true(most > 1e-3 * stress && most < 0.3 * stress);
    for (int s = 0; s < 2; ++s) assert_near(side[s], 0, 5e-6 * stress); /* some strains, as strains are finite */
    breccia_model_destroy(&model);
  }
}

/** Forces of any displacements have no sum. */
static void assert_momentum_is_kept(breccia_model *model)
{
  const Particles *p = model->domain.particles;
  uint64_t seed = 5;
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 2; ++k) p->displacement.row[k][p->place_of[n]] = 0.1 * (random_uniform(&seed) - 0.5);
  compute_forces(model);
  double sum[2] = {0}, size = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    for (int k = 0; k < 2; ++k) {
      const double force = p->internal.row[k][i] * p->volume[i];
      sum[k] += force;
      size += fabs(force);
    }
  }
  for (int k = 0; k < 2; ++k) assert_near(sum[k], 0, 1e-14 * size);
  breccia_model_destroy(&model);
}

static void momentum_is_kept_to_rounding(void **state)
{
  (void)state;
  assert_momentum_is_kept(bar("horizon: 3.015", "uniaxial", 20, 7, ONE_STEP));
}

static void momentum_is_kept_between_unlike_spacings(void **state)
{
  (void)state;
  assert_momentum_is_kept(model_of(
      MATERIALS
      "peridynamics: {space: plane strain, horizon: 3.015, regions: {fibres: {blocks: [left], formulation: "
      "bond-based}}}\n"
      "body:\n  left: {material: fibre, spacing: 1, lattice: square, thickness: 1, shape: {box: {from: [0, 0], "
      "to: [5, 6]}}}\n"
      "  right: {material: solid, spacing: 0.5, lattice: square, thickness: 1, shape: {box: {from: [5, 0], to: "
      "[9, 6]}}}\n" ONE_STEP));
}

/* ---- a wave through a joint ---- */

enum { COLUMNS = 480, ROWS = 13 }; /* rows: forces of the middle one know nothing of the surfaces */

typedef struct Strip {
  breccia_model *model;
  int *column;             /* [places] */
  int32_t middle[COLUMNS]; /* place in the middle row */
} Strip;

/** Forces per volume of columns that are displaced as planes. */
static void strip_forces(const Strip *s, const double *u, double *force)
{
  const Particles *p = s->model->domain.particles;
  for (int32_t n = 0; n < p->count; ++n) p->displacement.row[0][p->place_of[n]] = u[s->column[p->place_of[n]]];
  compute_forces(s->model);
  for (int x = 0; x < COLUMNS; ++x) force[x] = p->internal.row[0][s->middle[x]];
}

/** Speed of a plane wave in a half, from the forces of a cosine. */
static double wave_speed(const Strip *s, double k, int x)
{
  double u[COLUMNS], force[COLUMNS];
  for (int n = 0; n < COLUMNS; ++n) u[n] = 1e-9 * cos(k * (n - x));
  strip_forces(s, u, force);
  return sqrt(-force[x] / (2 * u[x])) / k;
}

/** Modulus of bonds whose lattice is as stiff in stretch along x alone, at hindered width, as a solid of modulus 150. */
static double fibre_modulus(const char *peridynamics)
{
  breccia_model *model =
      model_of("materials: {fibre: {model: elastic-1d, density: 2, Young modulus: 150}}\n"
               "peridynamics: {space: plane strain, formulation: bond-based, %s}\nbody: {a: {material: fibre, spacing: "
               "1, lattice: square, thickness: 1, shape: {box: {particles: [16, 16]}}}}\n" ONE_STEP,
               peridynamics);
  const double f[9] = {1 + 1e-7, 0, 0, 0, 1, 0, 0, 0, 1};
  double strain[6], stress[6];
  deform_uniformly(model, f);
  domain_look(&model->domain, model->domain.particles->place_of[8 * 16 + 8], strain, stress);
  breccia_model_destroy(&model);
  return 150 * 1.2 * 150 * 1e-7 / stress[XX];
}

/** A packet of waves of 20 spacings runs from bonds into families, as planes; what it leaves behind. @param[out] speeds  in both halves */
static double reflected(const char *peridynamics, double speeds[2])
{
  char fibre[96];
  snprintf(fibre, sizeof fibre, "fibre: {model: elastic-1d, density: 2, Young modulus: %.12g}",
           fibre_modulus(peridynamics));
  Strip s = {.model =
                 model_of("materials: {solid: {model: elastic, density: 2, Young modulus: 150, Poisson ratio: "
                          "0.25}, %s}\nperidynamics: {space: plane strain, %s, regions: {fibres: {blocks: [left], "
                          "formulation: bond-based}}}\nbody: {left: {material: fibre, spacing: 1, lattice: square, "
                          "thickness: 1, shape: {box: {particles: [%d, %d]}}}, right: {material: solid, spacing: "
                          "1, lattice: square, thickness: 1, shape: {box: {from: [%d, 0], to: [%d, %d]}}}}\n" ONE_STEP,
                          fibre, peridynamics, COLUMNS / 2, ROWS, COLUMNS / 2, COLUMNS, ROWS)};
  const Particles *p = s.model->domain.particles;
  s.column = calloc((size_t)p->places, sizeof *s.column);
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    s.column[i] = (int)p->position[0][i];
    if ((int)p->position[1][i] == ROWS / 2) s.middle[s.column[i]] = i;
  }
  const double k = 2 * acos(-1) / 20, width = 40, at = COLUMNS / 4., dt = 0.07;
  for (int half = 0; half < 2; ++half) speeds[half] = wave_speed(&s, k, COLUMNS / 4 + half * COLUMNS / 2);
  double u[COLUMNS], v[COLUMNS], force[COLUMNS], sent = 0, back = 0;
  for (int x = 0; x < COLUMNS; ++x) {
    const double away = x + 0.5 - at, height = 1e-6 * exp(-away * away / (2 * width * width));
    u[x] = height * cos(k * away);
    v[x] = speeds[0] * height * (k * sin(k * away) + away / (width * width) * cos(k * away));
    sent += v[x] * v[x];
  }
  const int steps = (int)(COLUMNS / 2. / speeds[0] / dt);
  for (int n = 0; n < steps; ++n) {
    strip_forces(&s, u, force);
    for (int x = 0; x < COLUMNS; ++x) {
      v[x] += (n ? dt : dt / 2) * force[x] / 2; /* speeds between steps */
      u[x] += dt * v[x];
    }
  }
  for (int x = 0; x < COLUMNS / 2; ++x) back += v[x] * v[x];
  breccia_model_destroy(&s.model);
  free(s.column);
  return sqrt(back / sent);
}

/** Long waves pass: of what comes back all but a little is due to the speeds of both halves, which differ at this length of wave as lattices
 *  do; it falls with the square of the horizon over the wave. */
static void waves_of_twenty_spacings_pass(void **state)
{
  (void)state;
  double speeds[2];
  const double wide = reflected("horizon: 3.015", speeds);
  assert_true(wide < 0.025);
  assert_near(wide, (speeds[0] - speeds[1]) / (speeds[0] + speeds[1]), 0.008);
  assert_true(reflected("horizon: 2.015", speeds) < 0.01);
  assert_true(reflected("horizon: 3.015, influence: cubic-spline", speeds) < 0.006);
}

/** A region with all blocks is the body without regions, to the bit. */
static void one_region_is_the_body_without(void **state)
{
  (void)state;
  breccia_model *model[2];
  for (int k = 0; k < 2; ++k) {
    model[k] = model_of(
        "materials: {fibre: {model: elastic-1d, density: 2, Young modulus: 150}}\n"
        "peridynamics: {space: plane strain, %s}\n"
        "body: {left: {material: fibre, spacing: 1, lattice: square, thickness: 1, shape: {box: {particles: [9, 6]}}}, "
        "right: {material: fibre, spacing: 1, lattice: square, thickness: 1, shape: {box: {from: [9, 0], to: [20, "
        "6]}}}}\nloads: [{on: {face: x+}, velocity: [0.1, free]}, {on: {face: x-}, displacement: [0, free]}]\n"
        "failure: {critical stretch: 0.02}\nsolve: {explicit: {steps: 100}}\n",
        k ? "regions: {all: {blocks: [left, right], formulation: bond-based}}" : "formulation: bond-based");
    assert_int_equal(model[k]->domain.region_count, 1);
    assert_int_equal(breccia_model_step(model[k], 100, NULL), 0);
  }
  assert_true(model[0]->domain.broken_count > 0);
  for (int k = 0; k < 3; ++k)
    assert_memory_equal(model[0]->domain.particles->displacement.row[k],
                        model[1]->domain.particles->displacement.row[k],
                        sizeof(double) * (size_t)model[0]->domain.particles->places);
  for (int k = 0; k < 2; ++k) breccia_model_destroy(&model[k]);
}

/** A bar that was stretched and let go rings, and keeps its energy for 20 000 steps. */
static void a_free_bar_keeps_its_energy(void **state)
{
  (void)state;
  breccia_model *model = bar("horizon: 2.015", "uniaxial", 20, 5, "solve: {explicit: {steps: 20000}}\n");
  const Particles *p = model->domain.particles;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->velocity.row[0][i] = 0.05 * (p->position[0][i] - 10) / 10;
    p->velocity.row[1][i] = 0.05 * sin(0.3 * p->position[0][i]);
  }
  assert_int_equal(breccia_model_step(model, 1, NULL), 0);
  const Energy first = solver_energy(&model->solver);
  double least = INFINITY, most = 0;
  for (int k = 0; k < 200; ++k) {
    assert_int_equal(breccia_model_step(model, 100, NULL), 0);
    const Energy e = solver_energy(&model->solver);
    least = fmin(least, e.kinetic + e.stored);
    most = larger_of(most, e.kinetic + e.stored);
  }
  const double whole = first.kinetic + first.stored;
  assert_near(least, whole, 0.01 * whole);
  assert_near(most, whole, 0.01 * whole);
  assert_true(solver_energy(&model->solver).kinetic > 0.05 * whole);
  breccia_model_destroy(&model);
}

/** A plate that is torn along its joint: bonds between the halves break, and what they held is in the books; with the same bits for any
 *  number of threads. */
static void joints_break_and_keep_their_books(void **state)
{
  (void)state;
  static const char torn[] =
      "cracks: [{cut: {line: [[12.01, -1], [12.01, 4]]}}]\nfailure: {critical stretch: 0.01, near grips: hold}\n"
      "loads: [{on: {face: x+, layers: 3}, velocity: [0.05, free]}, {on: {face: x-, layers: 3}, displacement: "
      "[0, free]}]\nsolve: {explicit: {end time: 20, damping: 0.1}}\n";
  double *found[4] = {NULL};
  for (int turn = 0; turn < 4; ++turn) {
    const bool links = turn > 1;
    breccia_model *model =
        links
            ? model_of(
                  "materials: {solid: {model: elastic, density: 2, Young modulus: 150, Poisson ratio: 0.2}}\n"
                  "peridynamics: {space: plane strain, horizon: 2.015, regions: {links: {blocks: [left], formulation: "
                  "micropolar}}}\n"
                  "body: {left: {material: solid, spacing: 1, lattice: square, thickness: 1, shape: {box: {particles: "
                  "[12, 12]}}}, right: {material: solid, spacing: 1, lattice: square, thickness: 1, shape: {box: "
                  "{from: [12, 0], to: [24, 12]}}}}\n%s",
                  torn)
            : bar("horizon: 3.015", "uniaxial", 24, 12, torn);
    Domain *d = &model->domain;
    model->threads = turn % 2 ? 1 : 3;
    while (breccia_model_time(model) < 19.9 && !breccia_model_step(model, 10, NULL)) {
    }
    int64_t across = 0;
    for (int64_t n = 0; n < d->broken_count; ++n)
      across += domain_region(d, d->particles->place_of[d->broken[n].a]) !=
                domain_region(d, d->particles->place_of[d->broken[n].b]);
    assert_true(across > 20);
    const Energy e = solver_energy(&model->solver);
    assert_true(e.fracture > 0.02 * e.external);
    assert_true(e.imbalance < 1e-3);
    const size_t bytes = sizeof(double) * (size_t)d->particles->places;
    found[turn] = malloc(bytes);
    memcpy(found[turn], d->particles->displacement.row[0], bytes);
    if (turn % 2) assert_memory_equal(found[turn - 1], found[turn], bytes);
    breccia_model_destroy(&model);
  }
  for (int turn = 0; turn < 4; ++turn) free(found[turn]);
}

static void bonds_of_a_joint_are_told_once(void **state)
{
  (void)state;
  /* Two bars of fibres and solid side by side: of bonds up to three spacings those along x cross the joint 1, 2 and 3 times in each row, those that
   * rise by r rows as often as they are long. */
  breccia_model *model = bar("horizon: 3.015", "continuum", 20, 6, ONE_STEP);
  int64_t bonds = 0;
  for (int dx = 1; dx <= 3; ++dx)
    for (int dy = -3; dy <= 3; ++dy)
      if (dx * dx + dy * dy <= 9) bonds += dx * (6 - abs(dy));
  char words[64];
  snprintf(words, sizeof words, ", joined by %lld bonds;", (long long)bonds);
  if (!strstr(breccia_model_overview(model), words)) fail_msg("no '%s' in: %s", words, breccia_model_overview(model));
  breccia_model_destroy(&model);
}

static void what_regions_cannot_be_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *regions, *failure, *words;
  } wrong[] = {
      {"one: {blocks: [lift], formulation: bond-based}", "", "there is no block 'lift'; did you mean 'left'?"},
      {"one: {blocks: [], formulation: bond-based}", "", "blocks: region 'one' names none"},
      {"one: {blocks: [left], formulation: bond-based}, two: {blocks: [left], formulation: ordinary}", "",
       "blocks: 'left' is in region 'one' already"},
      {"one: {blocks: [left], formulation: bond-based, strain: small}", "", "strain: is for correspondence"},
      {"one: {blocks: [right], formulation: bond-based}", "",
       "'elastic' is a law of strain in space; bond-based takes"},
      {"one: {blocks: [left], formulation: bond-based}", "failure: {failed laws: break}\n",
       "failed laws: 'break' needs a body of one formulation"},
      {"one: {blocks: [left], formulation: bond-based}", "failure: {fracture energy: 1}\n",
       "no critical stretch follows from it in correspondence"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char *deck = text_format(
        MATERIALS "peridynamics: {space: plane strain, regions: {%s}}\nbody: {left: {material: fibre, spacing: 1, "
                  "lattice: square, thickness: 1, shape: {box: {particles: [9, 6]}}}, right: {material: solid, "
                  "spacing: 1, lattice: square, thickness: 1, shape: {box: {from: [9, 0], to: [20, 6]}}}}\n%s" ONE_STEP,
        wrong[k].regions, wrong[k].failure);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s' in '%s'", wrong[k].words, words);
    free(words);
    free(deck);
  }
}

/** Reaction of a bar of two blocks that is stretched by a millionth of its length. */
static double stretched(const char *left, const char *right, const char *space)
{
  const bool plane = *space == 'p';
  const char *lattice = plane ? "lattice: square, thickness: 1, " : "";
  char *regions = strcmp(left, right) ? text_format(", regions: {other: {blocks: [right], formulation: %s}}", right)
                                      : text_format("%s", "");
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 2, Young modulus: 150, Poisson ratio: 0.2}}\n"
      "peridynamics: {space: %s, horizon: 2.015, formulation: %s%s}\n"
      "body: {left: {material: m, spacing: 1, %sshape: {box: {from: [0, 0, 0], to: [%d, 6, 4]}}}, right: {material: m, "
      "spacing: 1, %sshape: {box: {from: [%d, 0, 0], to: [%d, 6, 4]}}}}\n"
      "loads: [{on: {face: x-}, displacement: [0, free%s]}, {name: pull, on: {face: x+}, displacement: [2e-5, free%s], "
      "history: {ramp to: 1}}, {on: {nearest: [0, 0, 0]}, displacement: [free, 0%s]}, {on: {nearest: [0, 6, 0]}, "
      "displacement: [free, free%s]}, {on: {nearest: [0, 0, 4]}, displacement: [free, %s]}]\n"
      "watch: {held: {reaction of: pull}}\nsolve: {static: {end time: 1, increments: 1}}\n",
      space, left, regions, lattice, plane ? 20 : 10, lattice, plane ? 20 : 10, plane ? 40 : 20, plane ? "" : ", free",
      plane ? "" : ", free", plane ? "" : ", 0", plane ? "" : ", 0", plane ? "free" : "0, free");
  free(regions);
  breccia_error *error = breccia_error_create();
  breccia_model_step(model, 1, error);
  assert_string_equal(breccia_error_text(error), "");
  breccia_error_destroy(&error);
  assert_true(solver_energy(&model->solver).imbalance < 1e-5);
  double force = 0;
  const Particles *p = model->domain.particles;
  double most = 0;
  for (int32_t n = 0; n < p->count; ++n) most = larger_of(most, p->position[0][p->place_of[n]]);
  for (int32_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] > most - 0.1)
      force += p->internal.row[0][p->place_of[n]] * p->volume[p->place_of[n]];
  breccia_model_destroy(&model);
  return -force;
}

/** A bar of links and something else is as stiff as its halves one after the other: the joint gives nothing way and stiffens nothing. */
static void links_join_other_formulations_without_a_seam(void **state)
{
  (void)state;
  const struct {
    const char *formulation, *space;
  } cases[] = {{"correspondence", "plane stress"},
               {"ordinary", "plane stress"},
               {"hybrid", "plane strain"},
               {"correspondence", "3-D"},
               {"ordinary", "3-D"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    const double links = stretched("micropolar", "micropolar", cases[c].space),
                 others = stretched(cases[c].formulation, cases[c].formulation, cases[c].space),
                 series = 2 / (1 / links + 1 / others);
    assert_near(stretched("micropolar", cases[c].formulation, cases[c].space) / series, 1, 0.008);
    assert_near(stretched(cases[c].formulation, "micropolar", cases[c].space) / series, 1, 0.008);
  }
}

/** Where strains are even, particles that turn with the continuum store as much beside a joint as deep in their own lattice. Whatever the motion, nothing turns or
 *  pulls the whole, moments of particles counted. */
static void links_of_a_joint_store_what_others_do(void **state)
{
  (void)state;
  const char *const beside[] = {"correspondence", "ordinary", "hybrid"};
  for (int c = 0; c < 6; ++c) {
    const bool space = c > 2;
    const int depth = space ? 7 : 1;
    breccia_model *model = model_of(
        "materials: {m: {model: elastic, density: 2, Young modulus: 150, Poisson ratio: 0.2}}\n"
        "peridynamics: {space: %s, horizon: 2.015, formulation: micropolar, regions: {other: {blocks: [right], "
        "formulation: %s}}}\n"
        "body: {left: {material: m, spacing: 1, %sshape: {box: {from: [0, 0, 0], to: [8, 7, %d]}}}, right: "
        "{material: m, spacing: 1, %sshape: {box: {from: [8, 0, 0], to: [12, 7, %d]}}}}\n" ONE_STEP,
        space ? "3-D" : "plane strain", beside[c % 3], space ? "" : "lattice: square, thickness: 1, ", depth,
        space ? "" : "lattice: square, thickness: 1, ", depth);
    const Particles *p = model->domain.particles;
    const Region *region = &model->domain.regions[0];
    const double shear = 1e-6;
    StoredEnergy joint = {0}, inner = {0};
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      p->displacement.row[0][i] = shear * p->position[1][i];
      p->displacement.row[1][i] = 0.5 * shear * p->position[1][i];
      if (particles_turn(p, i)) p->displacement.row[p->space.rows - 1][i] = -shear / 2;
    }
    compute_forces(model);
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (p->position[1][i] != 3.5 || (space && p->position[2][i] != 3.5)) continue;
      if (p->position[0][i] == 7.5) region->type->stored_energy(region->formulation, i, 0, &joint);
      if (p->position[0][i] == 3.5) region->type->stored_energy(region->formulation, i, 0, &inner);
    }
    assert_true(inner.stored > 0);
    assert_near(joint.stored / inner.stored, 1, 1e-5);
    uint64_t seed = 3;
    for (int32_t n = 0; n < p->count; ++n)
      for (int k = 0; k < p->space.rows; ++k)
        if ((k < model->domain.body.dimensions || k >= p->space.rotation) &&
            (k < p->space.rotation || particles_turn(p, p->place_of[n])))
          p->displacement.row[k][p->place_of[n]] = 0.05 * (random_uniform(&seed) - 0.5);
    compute_forces(model);
    double sum[6] = {0}, size = 0;
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        sum[k] += p->volume[i] * p->internal.row[k][i];
        sum[3 + k] += p->volume[i] * ((p->position[x][i] + p->displacement.row[x][i]) * p->internal.row[y][i] -
                                      (p->position[y][i] + p->displacement.row[y][i]) * p->internal.row[x][i]);
        if (space || k == 2)
          sum[3 + k] += p->volume[i] * p->internal.row[space ? p->space.rotation + k : p->space.rotation][i];
        size += fabs(p->volume[i] * p->internal.row[k][i]);
      }
    }
    for (int k = 0; k < 3; ++k) assert_near(sum[k] / size, 0, 1e-13);
    if (c % 3) /* correspondence keeps no angular momentum to rounding: its zero-energy control */
      for (int k = 3; k < 6; ++k) assert_near(sum[k] / size, 0, 1e-12);
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_patch_pulls_at_the_joint_only_and_not_in_all),
      cmocka_unit_test(momentum_is_kept_to_rounding),
      cmocka_unit_test(momentum_is_kept_between_unlike_spacings),
      cmocka_unit_test(waves_of_twenty_spacings_pass),
      cmocka_unit_test(one_region_is_the_body_without),
      cmocka_unit_test(a_free_bar_keeps_its_energy),
      cmocka_unit_test(joints_break_and_keep_their_books),
      cmocka_unit_test(bonds_of_a_joint_are_told_once),
      cmocka_unit_test(links_join_other_formulations_without_a_seam),
      cmocka_unit_test(links_of_a_joint_store_what_others_do),
      cmocka_unit_test(what_regions_cannot_be_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

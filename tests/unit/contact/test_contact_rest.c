/* Contact where states are found by iteration: at rest and by long steps. */
#include "contact/contact.h"
#include "solver/linear_solver.h"
#include "solver/matrix.h"
#include "support.h"

#include "base/team.h"
#include <unistd.h>

#define UNITS                                                                                                          \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2.4, Young modulus: 3e6, Poisson ratio: 0.25}}\n"
#define PLANE ", lattice: square, thickness: 1"
#define IN_PLANE "peridynamics: {formulation: correspondence, space: plane strain}\n"

/* ---- changes of forces ---- */

/** A smooth motion that shears, turns and strains. */
static void wave(const breccia_model *m, double amplitude, const Vector *v)
{
  const Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double x = p->position[0][i], y = p->position[1][i], z = p->position[2][i];
    v->row[0][i] = amplitude * sin(20 * y + 13 * z + 0.3);
    v->row[1][i] = amplitude * sin(17 * x + 11 * z - 0.2);
    v->row[2][i] = m->domain.body.dimensions > 2 ? amplitude * sin(12 * x - 19 * y) : 0;
  }
}

static void add(const breccia_model *m, double factor, const Vector *v)
{
  const Particles *p = m->domain.particles;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) p->displacement.row[k][i] += factor * v->row[k][i];
}

/** Compares changes of the forces of contact with differences of them. */
static void check_changes(breccia_model *m, const char *what)
{
  Domain *d = &m->domain;
  const Particles *p = d->particles;
  const double h = 1e-9;
  Vector v[1] = {{0}}, change[1] = {{0}}, forces[2] = {{0}};
  assert_true(vector_create(v, &p->space, "test", NULL) && vector_create(change, &p->space, "test", NULL));
  assert_true(vector_create(&forces[0], &p->space, "test", NULL) && vector_create(&forces[1], &p->space, "test", NULL));
  wave(m, 1, v);
  for (int side = 0; side < 2; ++side) {
    add(m, side ? h : -h, v);
    domain_forces_beside(d, NULL, &forces[side]);
    add(m, side ? -h : h, v);
  }
  domain_evaluate(d, NULL);
  forces_linearise(&d->forces);
  domain_change_forces(d, v, change);
  double largest = 0, worst = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      const double expected = (forces[1].row[k][i] - forces[0].row[k][i]) / (2 * h);
      largest = larger_of(largest, fabs(expected));
      worst = larger_of(worst, fabs(change->row[k][i] - expected));
    }
  print_message("%s: %.1e\n", what, worst / largest);
  assert_true(largest > 0);
  if (!(worst <= 3e-4 * largest)) fail_msg("%s: changes of forces are off by %g", what, worst / largest);
  vector_destroy(v), vector_destroy(change), vector_destroy(&forces[0]), vector_destroy(&forces[1]);
}

static breccia_model *cut_block(const char *space, const char *contact)
{
  const bool plane = strcmp(space, "3-D");
  return model_of(UNITS
                  "body: {b: {material: m, spacing: 0.01%s, shape: {box: {from: [0, 0%s], to: [0.12, 0.08%s]}}}}\n"
                  "cracks: [{cut: {line: [[-1, 0.04], [1, 0.04]]}}]\n"
                  "peridynamics: {formulation: correspondence, space: %s}\n"
                  "contact: {%s}\n"
                  "solve: {static: {increments: 1}}\n"
                  "loads: [{on: {face: y-}, displacement: [0, 0%s]}]\n",
                  plane ? PLANE : ", lattice: cubic", plane ? "" : ", 0", plane ? "" : ", 0.06", space, contact,
                  plane ? "" : ", 0");
}

static void changes_of_forces_are_those_of_small_motions(void **state)
{
  (void)state;
  const char *const spaces[] = {"plane strain", "3-D"};
  const double angle = 0.4, c = cos(angle), s = sin(angle), tiny = 1e-5;
  for (int k = 0; k < 2; ++k) {
    /* Pressed together by far less than a spacing, and turned. */
    const double pressed[9] = {c, -s * (1 - tiny), 0, s, c * (1 - tiny), 0, 0, 0, 1};
    breccia_model *m = cut_block(spaces[k], "");
    domain_evaluate(&m->domain, NULL); /* faces are chosen as they stand at first */
    deform_uniformly(m, pressed);
    domain_evaluate(&m->domain, NULL);
    check_changes(m, spaces[k]);
    breccia_model_destroy(&m);

    m = cut_block(spaces[k], "friction: 0.5");
    Domain *d = &m->domain;
    domain_evaluate(d, NULL);
    deform_uniformly(m, pressed);
    domain_evaluate(d, NULL);
    forces_commit(&d->forces);
    check_changes(m, "sticking");
    /* All of the upper half slides along the face. */
    const Particles *p = d->particles;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (p->position[1][i] < 0.04) continue;
      p->displacement.row[0][i] += c * 1e-6;
      p->displacement.row[1][i] += s * 1e-6;
    }
    domain_evaluate(d, NULL);
    check_changes(m, "sliding");
    breccia_model_destroy(&m);
  }
}

/** A block on one of two, bonded, of unlike spacing: normals turn with families in which volumes differ. */
static breccia_model *unlike_blocks(const char *space, double gap)
{
  const bool plane = strcmp(space, "3-D");
  const char *lattice = plane ? PLANE : ", lattice: cubic";
  breccia_model *m = model_of(
      UNITS "peridynamics: {formulation: correspondence, space: %s, horizon: 0.0202}\nbody:\n"
            "  one: {material: m, spacing: 0.01%s, shape: {box: {from: [0, 0%s], to: [0.03, %s0.03]}}}\n"
            "  other: {material: m, spacing: 0.006%s, shape: {box: {from: [0.03, 0%s], to: [0.06, %s0.03]}}}\n"
            "  two: {material: m, spacing: 0.006%s, shape: {box: {from: [0.011, %s0.05], to: [0.047, %s0.068]}}}\n"
            "contact: {}\nsolve: {static: {increments: 1}}\n"
            "loads: [{on: {face: %c-}, displacement: [0, 0%s]}, {on: {face: %c+}, displacement: [0, 0%s]}]\n",
      space, lattice, plane ? "" : ", 0", plane ? "" : "0.05, ", lattice, plane ? "" : ", 0", plane ? "" : "0.048, ",
      lattice, plane ? "" : "0.008, ", plane ? "" : "0.038, ", plane ? 'y' : 'z', plane ? "" : ", 0", plane ? 'y' : 'z',
      plane ? "" : ", 0");
  Domain *d = &m->domain;
  const Particles *p = d->particles;
  domain_evaluate(d, NULL);
  for (int near = 0; near < 2; ++near) { /* it chooses its faces before it presses */
    for (int64_t i = 0; i < p->places; ++i)
      if (p->block[i / SLICE] == 2) p->displacement.row[plane ? 1 : 2][i] = near ? -0.02 - gap : -0.0199;
    contact_search(d->forces.own[FORCES_contact]);
    domain_evaluate(d, NULL);
  }
  return m;
}

static void families_of_unlike_particles_turn_as_their_volumes_weigh(void **state)
{
  (void)state;
  breccia_model *m = unlike_blocks("3-D", 1e-8);
  check_changes(m, "unlike");
  breccia_model_destroy(&m);
}

/** Compares the matrix of a body whose faces press with the changes of forces that it stands for. */
static void check_matrix(breccia_model *m)
{
  Domain *d = &m->domain;
  const Particles *p = d->particles;
  LinearSolver solver = {
      .domain = d, .loading = &m->loading, .unknowns = unknowns_of(d, &m->loading), .stiffness_share = 0.3};
  Matrix matrix = {0};
  Vector v[1] = {{0}}, kv[1] = {{0}};
  assert_true(vector_create(v, &p->space, "test", NULL) && vector_create(kv, &p->space, "test", NULL));
  assert_int_equal(domain_linearise(d, NULL, NULL), 0);
  forces_linearise(&d->forces);
  assert_true(((const Contact *)d->forces.own[0])->joint_count >= 10);
  assert_int_equal(matrix_create(&matrix, &solver.unknowns, NULL), 0);
  assert_int_equal(matrix_fill(&matrix, &solver.unknowns, solver.stiffness_share, 0, NULL), 0);
  wave(m, 1, v);
  unknowns_clear_rest(&solver.unknowns, v);
  double *x = calloc((size_t)matrix.size, sizeof *x), *y = calloc((size_t)matrix.size, sizeof *y);
  matrix_pack(&matrix, &solver.unknowns, v, x);
  linear_solver_apply(&solver, v, kv);
  matrix_pack(&matrix, &solver.unknowns, kv, y);
  double largest = 0, most = 0;
  for (int64_t row = 0; row < matrix.size; ++row) {
    double sum = 0;
    for (int64_t t = matrix.first[row]; t < matrix.first[row + 1]; ++t) sum += matrix.value[t] * x[matrix.column[t]];
    largest = larger_of(largest, fabs(y[row]));
    most = larger_of(most, fabs(sum - y[row]));
  }
  assert_near(most, 0, 1e-10 * largest);
  free(x), free(y);
  matrix_destroy(&matrix);
  vector_destroy(v), vector_destroy(kv);
}

static void points_of_pairs_are_what_the_matrix_needs(void **state)
{
  (void)state;
  breccia_model *m = cut_block("plane strain", "");
  domain_evaluate(&m->domain, NULL);
  deform_uniformly(m, (const double[]){1, 0, 0, 0, 1 - 1e-4, 0, 0, 0, 1});
  check_matrix(m);
  breccia_model_destroy(&m);

  m = unlike_blocks("plane strain", 1e-6);
  check_matrix(m);
  breccia_model_destroy(&m);
}

/* ---- bodies at rest ---- */

static double top_of(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  double sum = 0, highest = -INFINITY;
  int64_t count = 0;
  for (int64_t n = 0; n < p->count; ++n) highest = larger_of(highest, p->position[1][p->place_of[n]]);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[1][i] < highest - 1e-9) continue;
    sum += p->displacement.row[1][i];
    ++count;
  }
  return sum / (double)count;
}

/** Iterations that a stage's log tells. */
static int64_t iterations_of(const breccia_model *m)
{
  int64_t count = 0;
  for (const char *at = text_words(&m->solver.log); (at = strstr(at, "    iteration ")); ++at) ++count;
  return count;
}

static breccia_model *column(const char *cut, const char *how)
{
  return model_of(UNITS "body: {b: {material: m, spacing: 0.01" PLANE
                        ", shape: {box: {from: [0, 0], to: [0.1, 0.2]}}}}\n"
                        "%s" IN_PLANE "contact: {}\n"
                        "loads:\n"
                        "  - {on: {face: x-}, support: {held: across}}\n"
                        "  - {on: {face: y-, layers: 3}, displacement: [0, 0]}\n"
                        "  - {on: {face: y+}, pressure: 300, history: {ramp to: 1}}\n"
                        "solve: {static: {increments: 2, %s}}\n",
                  cut, how);
}

#define CUT "cracks: [{cut: {line: [[-1, 0.1], [1, 0.1]]}}]\n"

static void a_closed_cut_bears_whatever_solves_the_equations(void **state)
{
  (void)state;
  const char *const ways[] = {"equations: direct", "equations: minimal residuals", "method: relaxation"};
  breccia_model *whole = column("", ways[0]);
  step_surely(whole, INT64_MAX);
  double first = 0;
  for (int k = 0; k < 3; ++k) {
    breccia_model *m = column(CUT, ways[k]);
    step_surely(m, INT64_MAX);
    const double top = top_of(m), less = (1 - top / top_of(whole)) * 20;
    print_message("%s: %.4g m, %.2f spacings' shortening less than the whole\n", ways[k], top, less);
    if (k == 0) first = top;
    assert_near(top, first, 1e-6 * fabs(first));
    assert_true(less > 0.4 && less < 0.6); /* as in explicit steps: docs/choosing.md */
    assert_balanced(m, 1e-4);
    if (k < 2) assert_true(iterations_of(m) <= 5); /* what tangents leave out is of the order of the strain */
    breccia_model_destroy(&m);
  }
  breccia_model_destroy(&whole);
}

#define SLIDING                                                                                                        \
  UNITS "body:\n"                                                                                                      \
        "  base: {material: m, spacing: 0.01" PLANE ", shape: {box: {from: [0, 0], to: [0.3, 0.05]}}}\n"               \
        "  top: {material: m, spacing: 0.01" PLANE ", shape: {box: {from: [0.1, 0.05], to: [0.2, 0.1]}}}\n"            \
        "cracks: [{cut: {line: [[-1, 0.05], [1, 0.05]]}}]\n" IN_PLANE "contact: {friction: 0.4}\n"                     \
        "loads:\n"                                                                                                     \
        "  - {on: {face: y-, block: base, layers: 3}, displacement: [0, 0]}\n"                                         \
        "  - {on: {face: y+, block: top}, pressure: 300}\n"                                                            \
        "solve:\n"                                                                                                     \
        "  - {static: {increments: 1}}\n"                                                                              \
        "  - {loads: [{name: push, on: {block: top, face: x-, layers: 3}, displacement: [40e-6, free], history: "      \
        "{ramp to: 1}}], static: {increments: 10}}\n"                                                                  \
        "results: {number: 2, checkpoint steps: 3}\n"

/** Force along x on what a load moves. */
static double push_of(const breccia_model *m)
{
  const Particles *p = m->domain.particles;
  const Load *load = &m->loading.loads[m->loading.count - 1];
  double sum = 0;
  for (int64_t n = 0; n < load->selection.count; ++n)
    sum -= p->volume[load->selection.places[n]] * p->internal.row[0][load->selection.places[n]];
  return sum;
}

static void a_block_is_pushed_over_another_with_coulombs_force(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* the same block is pushed by several threads below */
  breccia_model *m = model_of(SLIDING);
  int64_t most = 0;
  double slid = 0;
  for (int n = 0; n < 11; ++n) {
    if (n == 4) slid = solver_energy(&m->solver).friction;
    step_surely(m, 1);
    most = iterations_of(m) > most ? iterations_of(m) : most;
  }
  assert_true(solver_is_done(&m->solver));
  const Energy e = solver_energy(&m->solver);
  print_message("push %.6f kN, friction %.6g, imbalance %.1e, %lld iterations at most\n", push_of(m), e.friction,
                e.imbalance, (long long)most);
  assert_near(push_of(m), 0.4 * 300 * 0.1, 1e-4 * 12);
  assert_near(e.friction - slid, 12 * 7 * 4e-6, 1e-3 * e.friction); /* seven increments of sliding */
  assert_true(e.imbalance < 1e-4);
  assert_true(most <= 6);
  breccia_model_destroy(&m);
}

static void blocks_meet_whatever_way_they_have_come(void **state)
{
  (void)state;
  const double gaps[] = {0.031, 0.051}; /* beyond the horizon, so that no bonds join them */
  double carried[2] = {0};
  for (int k = 0; k < (under_sanitizers() ? 1 : 2); ++k) {
    breccia_model *m =
        model_of(UNITS "body:\n"
                       "  base: {material: m, spacing: 0.01" PLANE ", shape: {box: {from: [0, 0], to: [0.2, 0.1]}}}\n"
                       "  top: {material: m, spacing: 0.01" PLANE
                       ", shape: {box: {from: [0.05, %g], to: [0.15, %g]}}}\n" IN_PLANE "contact: {}\n"
                       "loads:\n"
                       "  - {on: {face: y-, block: base, layers: 3}, displacement: [0, 0]}\n"
                       "  - {on: {face: y+, block: top, layers: 3}, displacement: [0, %g], history: {ramp to: 1}}\n"
                       "solve: {static: {increments: 10}}\n",
                 0.1 + gaps[k], 0.2 + gaps[k], -gaps[k] - 5e-5);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < m->loading.loads[1].selection.count; ++n) {
      const int32_t i = m->loading.loads[1].selection.places[n];
      carried[k] += p->internal.row[1][i] * p->volume[i];
    }
    const Energy e = solver_energy(&m->solver);
    print_message("gap %g: %.6g kN, external %.6g, imbalance %.1e\n", gaps[k], carried[k], e.external, e.imbalance);
    assert_near(e.external, 5e-5 * carried[k] / 2, 2e-3 * e.external); /* linear from where they meet */
    assert_true(e.imbalance < 1e-3);
    breccia_model_destroy(&m);
  }
  assert_true(carried[0] > 100);
  if (!under_sanitizers()) assert_near(carried[1], carried[0], 1e-6 * carried[0]);
}

/* ---- in motion, bits ---- */

#define FALLING                                                                                                        \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, density: 2.4, Young modulus: 3e4, Poisson ratio: 0.25}}\n"                          \
  "body:\n"                                                                                                            \
  "  base: {material: m, spacing: 0.01" PLANE ", shape: {box: {from: [0, 0], to: [0.1, 0.06]}}}\n"                     \
  "  top: {material: m, spacing: 0.01" PLANE ", shape: {box: {from: [0.03, 0.1], to: [0.07, 0.14]}}}\n" IN_PLANE       \
  "contact: {friction: 0.3}\n"                                                                                         \
  "loads:\n"                                                                                                           \
  "  - {on: {face: y-, block: base, layers: 3}, displacement: [0, 0]}\n"                                               \
  "  - {on: {block: top}, initial velocity: {translation: [0.2, -1]}}\n"                                               \
  "solve: {%s}\n"                                                                                                      \
  "results: {number: 2, checkpoint steps: 20}\n"

/** Mean velocity of the upper block. */
static void flight_of(const breccia_model *m, double v[2])
{
  const Particles *p = m->domain.particles;
  double mass = 0;
  v[0] = v[1] = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->position[1][i] < 0.08) continue;
    mass += p->volume[i];
    for (int k = 0; k < 2; ++k) v[k] += p->volume[i] * p->velocity.row[k][i];
  }
  for (int k = 0; k < 2; ++k) v[k] /= mass;
}

static void a_block_bounces_as_in_explicit_steps(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* the last test steps the same block */
  double found[2], expected[2];
  breccia_model *m = model_of(FALLING, "explicit: {end time: 0.05, safety: 0.4}");
  step_surely(m, INT64_MAX);
  flight_of(m, expected);
  breccia_model_destroy(&m);
  m = model_of(FALLING, "implicit: {end time: 0.05, time step: 1e-4}");
  step_surely(m, INT64_MAX);
  flight_of(m, found);
  const Energy e = solver_energy(&m->solver);
  print_message("%.4f %.4f, by explicit steps %.4f %.4f m/s; imbalance %.1e\n", found[0], found[1], expected[0],
                expected[1], e.imbalance);
  assert_true(expected[1] > 0.5);
  for (int k = 0; k < 2; ++k) assert_near(found[k], expected[k], 0.03);
  assert_true(e.imbalance < 0.05);
  breccia_model_destroy(&m);
}

static void assert_same_state(breccia_model *one, breccia_model *other)
{
  one->peaks = other->peaks = (Peaks){0};
  one->next_due = one->last_due = one->states_due = one->log_bytes = 0; /* of files */
  other->next_due = other->last_due = other->states_due = other->log_bytes = 0;
  StateCopy found = state_of(one), expected = state_of(other);
  assert_int_equal(found.count, expected.count);
  for (int k = 0; k < found.count; ++k)
    if (found.rows[k].count != expected.rows[k].count ||
        memcmp(found.values[k], expected.values[k], state_size(&found.rows[k]) * (size_t)found.rows[k].count))
      fail_msg("'%s' is not the same", found.rows[k].name);
  state_copy_destroy(&found);
  state_copy_destroy(&expected);
}

static void assert_same_bits(breccia_model *(*make)(void), int64_t stop, int64_t end)
{
  Error *error = breccia_error_create();
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  breccia_model *whole = make(), *first = make(), *second = make(), *threaded = make();
  step_surely(whole, end);
  Team *team = team_create(3, NULL), *before = team_use(team);
  step_surely(threaded, end);
  team_use(before);
  assert_same_state(threaded, whole);
  assert_non_null(mkdtemp(folder));
  breccia_run run = {.size = sizeof(breccia_run), .folder = folder, .steps = stop};
  if (breccia_model_run(first, &run, error)) fail_msg("%s", breccia_error_text(error));
  run.restart = 1;
  run.steps = end;
  if (breccia_model_run(second, &run, error)) fail_msg("%s", breccia_error_text(error));
  assert_same_state(second, whole);
  team_destroy(&team);
  breccia_error_destroy(&error);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&first);
  breccia_model_destroy(&second);
  breccia_model_destroy(&threaded);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

static breccia_model *sliding(void)
{
  return model_of(SLIDING);
}

static breccia_model *falling(void)
{
  return model_of(FALLING, "implicit: {end time: 0.05, time step: 1e-3, scheme: HHT, stiffness damping: 1e-5}");
}

static void threads_and_restarts_change_no_bit(void **state)
{
  (void)state;
  assert_same_bits(sliding, 5, 9);
  if (!under_sanitizers()) {
    assert_same_bits(falling, 50, 70);
    return;
  }
  breccia_model *m = falling();
  step_surely(m, 36); /* they have met */
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(changes_of_forces_are_those_of_small_motions),
      cmocka_unit_test(families_of_unlike_particles_turn_as_their_volumes_weigh),
      cmocka_unit_test(points_of_pairs_are_what_the_matrix_needs),
      cmocka_unit_test(a_closed_cut_bears_whatever_solves_the_equations),
      cmocka_unit_test(a_block_is_pushed_over_another_with_coulombs_force),
      cmocka_unit_test(blocks_meet_whatever_way_they_have_come),
      cmocka_unit_test(a_block_bounces_as_in_explicit_steps),
      cmocka_unit_test(threads_and_restarts_change_no_bit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

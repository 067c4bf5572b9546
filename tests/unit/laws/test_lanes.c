/* Vectors of eight lanes beside those of four (base/lane_kinds.h): the same bits, of all laws in space and of all formulations, along lattices and among scattered
 * particles. */
#include "sample_laws.h"

#include "base/lane_kinds.h"
#include "base/random.h"
#include "base/trap.h"

#include <stdlib.h>

static breccia_model *body(const char *peridynamics, const char *law, const char *shape)
{
  return model_of(
      "materials: {m: {model: %s, density: 1, Young modulus: 150}, n: {model: %s, density: 1, Young modulus: 90}}\n"
      "peridynamics: {formulation: %s, horizon: 3.015}\n"
      "cracks: [{cut: {line: [[9.05, -9], [9.05, 3.1]]}}]\n"
      "body: {b: {material: m, spacing: 1, %s}}\n"
      "solve: {explicit: {steps: 20}}\n",
      law, law, peridynamics, shape);
}

/** Displacements with stretches of a thousandth; of one particle, if wanted, so large that bonds around it leave the series. */
static void displace(const Domain *d, double far)
{
  const Particles *p = d->particles;
  uint64_t seed = 5;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < p->space.rows; ++k)
      if (p->position[2][p->place_of[p->count - 1]] > 0 || k != 2) /* a plane stays one */
        p->displacement.row[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
  p->displacement.row[0][p->place_of[p->count / 3]] += far;
}

/** Some bonds, so that some slices have gaps and others none. */
static void break_some(Domain *d)
{
  const Particles *p = d->particles;
  const Region *region = &d->regions[0];
  for (int64_t n = 0; n + 1 < p->count; n += 40) {
    const int32_t end[2] = {p->place_of[n], p->place_of[n + 1]};
    if (!family_break(&d->family, end[0], end[1])) continue;
    for (int k = 0; k < 2 && region->type->renew; ++k) region->type->renew(region->formulation, end[k] / SLICE);
  }
}

/** Forces of one evaluation, by `lanes`. @return [motions][places], to be freed */
static double *forces_by(const char *lanes, const char *peridynamics, const char *law, const char *shape, double far,
                         int64_t *count)
{
  setenv("BRECCIA_LANES", lanes, 1);
  breccia_model *model = body(peridynamics, law, shape);
  const Particles *p = model->domain.particles;
  *count = p->space.rows * p->places;
  double *forces = malloc(sizeof(double) * (size_t)*count);
  displace(&model->domain, far);
  if (far > 0) break_some(&model->domain);
  Trap trap = {0};
  Text words = {0};
  if (trap_is_possible()) trap_begin(&trap); /* lanes without a bond divide by nothing either */
  compute_forces(model);
  if (trap_is_possible()) trap_end();
  if (trap_tell(&trap, &words)) fail_msg("%s, %s lanes: %s", peridynamics, lanes, text_words(&words));
  for (int k = 0; k < p->space.rows; ++k)
    memcpy(forces + k * p->places, p->internal.row[k], sizeof(double) * (size_t)p->places);
  breccia_model_destroy(&model);
  return forces;
}

static void check(const char *peridynamics, const char *law, const char *shape)
{
  for (int n = 0; n < 3; ++n) {
    const double far = n == 0 ? 0 : n == 1 ? 0.05 : 0.6; /* by the series, by Newton's steps, by roots */
    int64_t count, other;
    double *four = forces_by("4", peridynamics, law, shape, far, &count),
           *eight = forces_by("8", peridynamics, law, shape, far, &other), largest = 0;
    assert_int_equal(count, other);
    for (int64_t i = 0; i < count; ++i) {
      largest = larger_of(largest, fabs(four[i]));
      if (memcmp(&four[i], &eight[i], sizeof(double)))
        fail_msg("%s, %s, %s, far %g: %a by four lanes, %a by eight", peridynamics, law, shape, far, four[i], eight[i]);
    }
    assert_true(largest > 0);
    free(four);
    free(eight);
  }
}

static const char *const lattice = "shape: {difference: [{box: {particles: [29, 8, 7]}}, {sphere: {centre: [20, 4, 3], "
                                   "radius: 1.7}}]}";

static const char *const plane = "lattice: hexagonal, thickness: 1, shape: {difference: [{box: {particles: [29, 13]}}, "
                                 "{sphere: {centre: [20, 4], radius: 1.7}}]}";

static const char *const of[][2] = {
    {"bond-based", "elastic-1d"},
    {"bond-based, surface correction: energy", "elastic-1d"},
    {"bond-based", "bilinear-softening, tensile strength: 0.01, fracture energy: 0.001"},
    {"bond-based, influence: gaussian", "elastic-1d"},
    {"ordinary", "elastic, Poisson ratio: 0.3"},
    {"correspondence", "elastic, Poisson ratio: 0.3"},
    {"correspondence, strain: small", "elastic, Poisson ratio: 0.3"},
    {"correspondence, influence: gaussian", "elastic, Poisson ratio: 0.3"},
    {"correspondence, zero-energy control: {none: yes}", "elastic, Poisson ratio: 0.3"},
    {"correspondence, zero-energy control: {wan: 0.5}", "elastic, Poisson ratio: 0.3"},
    {"hybrid", "elastic, Poisson ratio: 0.3"},
    {"hybrid, strain: small", "elastic, Poisson ratio: 0.3"},
    {"micropolar", "elastic, Poisson ratio: 0.2"}};

static void skip_without_eight(void)
{
  setenv("BRECCIA_LANES", "8", 1);
  if (lane_kind() != LANES_OF_AVX512) skip();
}

static void a_variable_chooses_four_lanes(void **state)
{
  (void)state;
  skip_without_eight();
  setenv("BRECCIA_LANES", "4", 1);
  assert_int_equal(lane_kind(), LANES_OF_AVX2);
  unsetenv("BRECCIA_LANES");
  assert_int_equal(lane_kind(), LANES_OF_AVX512);
}

static void eight_lanes_give_the_bits_of_four_along_lattices(void **state)
{
  (void)state;
  skip_without_eight();
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) check(of[k][0], of[k][1], lattice);
  check("micropolar, space: plane strain", "elastic, Poisson ratio: 0.2", plane);
}

/** A file of the particles of a body 15 long that stand from one x on to another. */
static void write_scattered(const char *name, int from, int to)
{
  FILE *file = fopen(name, "w");
  uint64_t seed = 3;
  fprintf(file, "x,y,z,volume\n");
  for (int n = 0; n < 15 * 7 * 6; ++n) {
    const int at[3] = {n % 15, n / 15 % 7, n / 105};
    double number[4];
    for (int k = 0; k < 4; ++k) number[k] = random_uniform(&seed) - 0.5;
    if (at[0] < from || at[0] >= to) continue;
    for (int k = 0; k < 3; ++k) fprintf(file, "%.17g,", at[k] + 0.6 * number[k]);
    fprintf(file, "%.17g\n", 1 + 0.2 * number[3]);
  }
  fclose(file);
}

static void eight_lanes_give_the_bits_of_four_among_scattered_particles(void **state)
{
  (void)state;
  skip_without_eight();
  write_scattered("lanes.csv", 0, 15);
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k)
    if (strncmp(of[k][0], "micropolar", 10) && strncmp(of[k][0], "hybrid", 6))
      check(of[k][0], of[k][1], "file: lanes.csv");
}

enum { CROWD = 45, CROWD_STEPS = 60 };

/** Answers of points of a law by `lanes`, in steps with tangents and without: all that it wrote. @return to be freed */
static double *answers_by(const char *lanes, const Sample *sample, size_t *count)
{
  setenv("BRECCIA_LANES", lanes, 1);
  Material m = sample->make();
  const size_t values = (size_t)m.history_values, each = 6 + values + 36;
  double *answers = calloc(CROWD_STEPS * CROWD * each, sizeof *answers), *to = answers, *committed, *trial;
  double strain[6][CROWD] = {{0}}, stress[6][CROWD], tangent[36 * CROWD];
  committed = calloc(values * CROWD + 1, sizeof *committed);
  trial = calloc(values * CROWD + 1, sizeof *trial);
  *count = CROWD_STEPS * CROWD * each;
  for (size_t i = 0; i < CROWD && m.law->begin; ++i) {
    m.law->begin(m.constants, committed + values * i);
    m.law->begin(m.constants, trial + values * i);
  }
  uint64_t seed = 71;
  for (int step = 0; step < CROWD_STEPS; ++step) {
    breccia_batch batch = {.size = sizeof batch, .count = CROWD, .committed = committed, .trial = trial};
    if (step % 2) batch.tangent = tangent;
    for (int i = 0; i < CROWD; ++i) {
      double e[6];
      for (int k = 0; k < 6; ++k) e[k] = strain[k][i];
      const double size = sample->strain * (i % 3 ? 1 : 30); /* some far beyond */
      sample_wander(&seed, size, size / 5, e);
      for (int k = 0; k < 6; ++k) strain[k][i] = step % 20 == 9 ? 0.1 * e[k] : e[k];
    }
    for (int k = 0; k < 6; ++k) {
      batch.strain[k] = strain[k];
      batch.stress[k] = stress[k];
    }
    assert_int_equal(m.law->update(m.constants, &batch), -1);
    for (size_t i = 0; i < CROWD; ++i, to += each) {
      for (int k = 0; k < 6; ++k) to[k] = stress[k][i];
      memcpy(to + 6, trial + values * i, sizeof(double) * values);
      if (batch.tangent) memcpy(to + 6 + values, tangent + 36 * i, sizeof(double) * 36);
    }
    double *other = committed;
    committed = trial;
    trial = other;
  }
  free(committed);
  free(trial);
  material_destroy(&m);
  return answers;
}

static void eight_lanes_give_the_bits_of_four_in_laws(void **state)
{
  (void)state;
  skip_without_eight();
  for (int n = 0; n < SAMPLES; ++n) {
    size_t count, other;
    double *four = answers_by("4", &samples[n], &count), *eight = answers_by("8", &samples[n], &other);
    assert_int_equal(count, other);
    for (size_t i = 0; i < count; ++i)
      if (memcmp(&four[i], &eight[i], sizeof(double)))
        fail_msg("%s: number %zu is %a by four lanes, %a by eight", samples[n].name, i, four[i], eight[i]);
    free(four);
    free(eight);
  }
}

/** Bonds with a history between two materials have two rows each, and go another way. */
static void eight_lanes_give_the_bits_of_four_between_materials(void **state)
{
  (void)state;
  skip_without_eight();
  write_scattered("lanes-left.csv", 0, 7);
  write_scattered("lanes-right.csv", 7, 15);
  check("bond-based", "bilinear-softening, tensile strength: 0.01, fracture energy: 0.001",
        "file: lanes-left.csv}, c: {material: n, spacing: 1, file: lanes-right.csv");
}

/** Numbers of chosen lanes, stored one after another and spread again, are where they were; the other places keep what they had. */
static void chosen_lanes_come_back_to_where_they_were(void **state)
{
  (void)state;
  for (unsigned bits = 0; bits < 1u << LANES; ++bits) {
    double packed[2 * LANES] = {0}, back[LANES];
    Lanes lanes;
    LaneMask mask;
    for (int k = 0; k < LANES; ++k) {
      lanes[k] = 1 + k;
      mask[k] = bits & 1u << k ? -1 : 0;
      back[k] = -1;
    }
    assert_int_equal(lanes_bits(mask), bits);
    lanes_store_some(packed, bits, 0, lanes);
    lanes_spread_some(back, bits, packed);
    int next = 0;
    for (int k = 0; k < LANES; ++k) {
      const bool chosen = bits & 1u << k;
      if (chosen) assert_true(packed[next++] == 1 + k);
      assert_true(back[k] == (chosen ? 1 + k : -1));
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_variable_chooses_four_lanes),
      cmocka_unit_test(chosen_lanes_come_back_to_where_they_were),
      cmocka_unit_test(eight_lanes_give_the_bits_of_four_in_laws),
      cmocka_unit_test(eight_lanes_give_the_bits_of_four_along_lattices),
      cmocka_unit_test(eight_lanes_give_the_bits_of_four_among_scattered_particles),
      cmocka_unit_test(eight_lanes_give_the_bits_of_four_between_materials),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

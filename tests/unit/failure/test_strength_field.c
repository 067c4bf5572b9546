/* Factors on strengths (`fields`): their distribution, what they do to laws and criteria, and on whom they depend. */
#include "support.h"

#include "domain/domain.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"

/** A strip that is stretched along x.
 *  @param[in] material, formulation, failure, fields  keys of these sections; fields "": none */
static breccia_model *strip_on(int threads, const char *material, const char *formulation, const char *failure,
                               const char *fields, const char *solver)
{
  return model_on(threads,
                  UNITS "materials: {m: {density: 2, %s}}\n"
                        "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
                        "[12, 6]}}}}\ncracks: [{cut: {line: [[0.6, 0.25], [0.6, 1]]}}]\n"
                        "peridynamics: {%s}\n%s%s"
                        "loads: [{on: {face: y-}, support: {held: across}}, {on: {face: x-, layers: 2}, displacement: "
                        "[0, free]}, {on: {face: x+, layers: 2}, displacement: [0.02, free], history: {ramp to: 1}}]\n"
                        "solve: {%s}\n",
                  material, formulation, failure, fields, solver);
}

/** Factors of the particles of a model, by number. */
static double factor_of(const breccia_model *m, int64_t n)
{
  return m->domain.strength[m->domain.particles->place_of[n]];
}

static breccia_model *block_of(const char *strength)
{
  return model_of(UNITS "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"
                        "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: "
                        "[100, 100]}}}}\nperidynamics: {formulation: bond-based, space: plane stress, horizon: 1.2 "
                        "spacings}\nfailure: {critical stretch: 1e-3}\nfields: {strength: {%s}}\n"
                        "solve: {explicit: {steps: 1}}\n",
                  strength);
}

/** Mean and scatter of ten thousand factors, and the share of them below some values, are those of the distribution
 *  within four standard errors. Another seed gives another sample, the same seed the same one. */
static void factors_follow_the_weibull_distribution(void **state)
{
  (void)state;
  static const double shapes[] = {1, 3, 6, 20};
  for (size_t s = 0; s < sizeof shapes / sizeof *shapes; ++s) {
    const double k = shapes[s], scale = 1 / tgamma(1 + 1 / k), variance = tgamma(1 + 2 / k) * scale * scale - 1;
    char words[128];
    snprintf(words, sizeof words, "weibull: {shape: %g, seed: 7}, least: 1e-9", k);
    breccia_model *m = block_of(words);
    const int64_t count = m->domain.particles->count;
    double sum = 0, squares = 0;
    for (int64_t n = 0; n < count; ++n) {
      sum += factor_of(m, n);
      squares += pow(factor_of(m, n) - 1, 2);
    }
    const double root = sqrt((double)count);
    print_message("shape %g: mean %.4f, variation %.4f (%.4f)\n", k, sum / (double)count, sqrt(squares / (double)count),
                  sqrt(variance));
    assert_near(sum / (double)count, 1, 4 * sqrt(variance) / root);
    assert_near(sqrt(squares / (double)count), sqrt(variance), 0.05 * sqrt(variance));
    for (double at = 0.3; at < 2; at += 0.1) {
      const double share = 1 - exp(-pow(at / scale, k));
      int64_t below = 0;
      for (int64_t n = 0; n < count; ++n) below += factor_of(m, n) < at;
      assert_near((double)below / (double)count, share, 4 * sqrt(share * (1 - share)) / root + 2 / (double)count);
    }
    /* Neighbours know nothing of each other. */
    double product = 0;
    for (int64_t n = 1; n < count; ++n) product += (factor_of(m, n) - 1) * (factor_of(m, n - 1) - 1);
    assert_near(product / (double)count, 0, 5 * variance / root);
    breccia_model *again = block_of(words);
    snprintf(words, sizeof words, "weibull: {shape: %g, seed: 8}, least: 0.9", k);
    breccia_model *other = block_of(words);
    int64_t alike = 0;
    for (int64_t n = 0; n < count; ++n) {
      assert_true(factor_of(m, n) == factor_of(again, n));
      assert_true(factor_of(other, n) >= 0.9);
      alike += factor_of(m, n) == factor_of(other, n);
    }
    assert_true(alike < 10);
    breccia_model_destroy(&m);
    breccia_model_destroy(&again);
    breccia_model_destroy(&other);
  }
}

/** Expressions grade the strength by place, in units, on a part of the body; images have the factor of their original. */
static void expressions_grade_by_place(void **state)
{
  (void)state;
  breccia_model *m = strip_on(1, "model: elastic, Young modulus: 1e4, Poisson ratio: 0.25",
                              "formulation: correspondence, space: plane strain, horizon: 2.015 spacings",
                              "failure: {critical stretch: 2e-3}\n",
                              "fields: {strength: {expression: '1 - 0.3 * x / (2000 mm) + y / 10 m', on: {inside: "
                              "{box: {from: [0.5, 0], to: [2, 1]}}}}}\n",
                              "explicit: {steps: 1, time step: 2e-4}");
  const Domain *d = &m->domain;
  int64_t graded = 0, outside = 0;
  for (int64_t n = 0; n < d->particles->count; ++n) {
    const int64_t of = body_original(&d->body, n);
    double *const *at = d->particles->position;
    const double x = at[0][d->particles->place_of[of]], y = at[1][d->particles->place_of[of]];
    assert_near(factor_of(m, n), x > 0.5 ? 1 - 0.15 * x + 0.1 * y : 1, 1e-14);
    graded += x > 0.5;
    outside += of != n;
  }
  assert_true(graded > 0 && outside > 0);
  breccia_model_destroy(&m);
}

/** A body with a factor everywhere is the body with the strengths of its deck times this factor, and its fracture
 *  energies times the square. */
static void factors_scale_laws_and_limits(void **state)
{
  (void)state;
#define BONDS "formulation: bond-based, space: plane stress, horizon: 3.015 spacings"
#define PLANE "formulation: correspondence, space: plane stress, horizon: 2.015 spacings"
#define STRAIN "formulation: correspondence, space: plane strain, horizon: 2.015 spacings"
#define MEMBERS "formulation: hybrid, space: plane stress, horizon: 1.5 spacings"
#define HOOKE "model: elastic, Young modulus: 1e4, Poisson ratio: 0.25"
#define ROD "model: elastic-1d, Young modulus: 1e4"
#define MOVES "explicit: {end time: 0.3, time step: 2e-4}"
#define RESTS "static: {increments: 6, end time: 0.3}"
  static const struct {
    const char *material, *scaled, *formulation, *failure, *scaled_failure, *solver;
  } pairs[] = {
      {"model: exponential-softening, Young modulus: 1e4, tensile strength: 20, fracture energy: 0.05",
       "model: exponential-softening, Young modulus: 1e4, tensile strength: 16, fracture energy: 0.032", BONDS, "", "",
       RESTS},
      {"model: exponential-softening, Young modulus: 1e4, tensile strength: 20, fracture energy: 0.05",
       "model: exponential-softening, Young modulus: 1e4, tensile strength: 16, fracture energy: 0.032", BONDS, "", "",
       MOVES},
      {ROD, ROD, BONDS, "failure: {critical stretch: 2e-3}\n", "failure: {critical stretch: 1.6e-3}\n", MOVES},
      {ROD, ROD, BONDS, "failure: {fracture energy: 0.01}\n", "failure: {fracture energy: 0.0064}\n", MOVES},
      {HOOKE, HOOKE, STRAIN, "failure: {criterion: critical bond energy, bond energy: 0.5}\n",
       "failure: {criterion: critical bond energy, bond energy: 0.32}\n", MOVES},
      {HOOKE, HOOKE, "formulation: ordinary, space: plane strain, horizon: 3.015 spacings",
       "failure: {criterion: critical bond energy, bond energy: 0.5}\n",
       "failure: {criterion: critical bond energy, bond energy: 0.32}\n", MOVES},
      {HOOKE, HOOKE, "formulation: micropolar, space: plane strain, horizon: 1.5 spacings",
       "failure: {critical stretch: 2e-3}\n", "failure: {critical stretch: 1.6e-3}\n", MOVES},
      {HOOKE, HOOKE, MEMBERS,
       "failure: {criterion: critical bond stress, bond tensile strength: 20, bond shear strength: 10}\n",
       "failure: {criterion: critical bond stress, bond tensile strength: 16, bond shear strength: 8}\n", MOVES},
      {"model: j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 20, hardening modulus: 500",
       "model: j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 16, hardening modulus: 500", PLANE, "", "",
       RESTS},
      {"model: j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 20, hardening modulus: 500",
       "model: j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 16, hardening modulus: 500", MEMBERS, "", "",
       RESTS},
      {"model: drucker-prager, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 10, friction angle: 30 deg, dilation "
       "angle: 10 deg",
       "model: drucker-prager, Young modulus: 1e4, Poisson ratio: 0.25, cohesion: 8, friction angle: 30 deg, dilation "
       "angle: 10 deg",
       STRAIN, "", "", RESTS},
      {"model: mazars, Young modulus: 1e4, Poisson ratio: 0.2, tensile strength: 20, fracture energy: 0.05, "
       "compression rate: 1500",
       "model: mazars, Young modulus: 1e4, Poisson ratio: 0.2, tensile strength: 16, fracture energy: 0.032, "
       "compression rate: 1875",
       PLANE, "", "", MOVES},
  };
  for (size_t k = 0; k < sizeof pairs / sizeof *pairs; ++k) {
    breccia_model *m = strip_on(1, pairs[k].material, pairs[k].formulation, pairs[k].failure,
                                "fields: {strength: {expression: '0.8'}}\n", pairs[k].solver);
    breccia_model *other =
        strip_on(1, pairs[k].scaled, pairs[k].formulation, pairs[k].scaled_failure, "", pairs[k].solver);
    breccia_model *plain = strip_on(1, pairs[k].material, pairs[k].formulation, pairs[k].failure, "", pairs[k].solver);
    breccia_model *const all[] = {m, other, plain};
    for (int n = 0; n < 3; ++n) step_surely(all[n], INT64_MAX);
    double apart = 0, differs = 0, moved = 0;
    for (int64_t n = 0; n < m->domain.particles->count; ++n)
      for (int c = 0; c < 2; ++c) {
        const int32_t place = m->domain.particles->place_of[n];
        const double u = m->domain.particles->displacement.row[c][place];
        apart = larger_of(apart, fabs(u - other->domain.particles->displacement.row[c][place]));
        differs = larger_of(differs, fabs(u - plain->domain.particles->displacement.row[c][place]));
        moved = larger_of(moved, fabs(u));
      }
    print_message("%s, %s%s: apart %.2g, without the factor %.2g of %.2g; %lld bonds broken\n", pairs[k].material,
                  pairs[k].formulation, pairs[k].failure, apart, differs, moved, (long long)m->domain.broken_count);
    assert_int_equal(m->domain.broken_count, other->domain.broken_count);
    for (int64_t n = 0; n < m->domain.broken_count; ++n) {
      const BrokenBond *one = &m->domain.broken[n], *two = &other->domain.broken[n];
      assert_true(one->step == two->step && one->a == two->a && one->b == two->b && one->cause == two->cause);
      if (one->cause == BREAK_LIMIT) assert_near(one->limit, two->limit, 1e-9 * two->limit);
    }
    assert_true(apart < 1e-6 * moved);
    assert_true(differs > 1e-3 * moved);
    for (int n = 0; n < 3; ++n) {
      breccia_model *one = all[n];
      breccia_model_destroy(&one);
    }
  }
}

static breccia_model *scattered(int threads)
{
  return strip_on(threads,
                  "model: exponential-softening, Young modulus: 1e4, tensile strength: 20, fracture energy: 0.05",
                  "formulation: bond-based, space: plane stress, horizon: 3.015 spacings", "",
                  "fields: {strength: {weibull: {shape: 4}}}\n", "explicit: {end time: 0.5, time step: 2e-4}");
}
static breccia_model *scattered_points(int threads)
{
  return strip_on(threads,
                  "model: mazars, Young modulus: 1e4, Poisson ratio: 0.2, tensile strength: 20, fracture energy: 0.05",
                  "formulation: hybrid, space: plane stress, horizon: 1.5 spacings",
                  "failure: {criterion: critical bond stress, bond tensile strength: 18}\n",
                  "fields: {strength: {weibull: {shape: 4}}}\n", "explicit: {end time: 0.5, time step: 2e-4}");
}

static void scattered_bodies_have_the_same_bits(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(scattered, 600, 1200);
  assert_same_bits_by_threads_and_restart(scattered_points, 600, 1200);
}

/** Each broken bond tells the limit of its weaker end. */
static void broken_bonds_tell_the_limit_of_the_weaker_end(void **state)
{
  (void)state;
  breccia_model *m = strip_on(1, "model: elastic-1d, Young modulus: 1e4",
                              "formulation: bond-based, space: plane stress, horizon: 3.015 spacings",
                              "failure: {critical stretch: 2e-3}\n", "fields: {strength: {weibull: {shape: 4}}}\n",
                              "explicit: {end time: 0.5, time step: 2e-4}");
  step_surely(m, INT64_MAX);
  assert_true(m->domain.broken_count > 5);
  for (int64_t n = 0; n < m->domain.broken_count; ++n) {
    const BrokenBond *bond = &m->domain.broken[n];
    assert_near(bond->limit, 2e-3 * fmin(factor_of(m, bond->a), factor_of(m, bond->b)), 1e-15);
    assert_true(bond->value > bond->limit);
  }
  breccia_model_destroy(&m);
}

static void what_cannot_take_factors_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *material, *formulation, *fields, *words;
  } cases[] = {
      {"model: elastic-1d, Young modulus: 1e4", "bond-based", "strength: {expression: '1 - x / 1 m'}",
       "expression: '1 - x / 1 m': is |expected a number above 0"},
      {"model: elastic-1d, Young modulus: 1e4", "bond-based", "strength: {expression: '2 * x'}", "expected a 1"},
      {"model: elastic-1d, Young modulus: 1e4", "bond-based", "strength: {weibull: {shape: 4}, expression: '1'}",
       "strength"},
      {"model: elastic-1d, Young modulus: 1e4", "bond-based", "stiffness: {expression: '1'}", "stiffness"},
      {"model: j2, Young modulus: 1e4, Poisson ratio: 0.25, yield stress: 20", "ordinary",
       "strength: {weibull: {shape: "
       "4}}",
       "has no material points whose law 'j2' could take a factor"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format(UNITS "materials: {m: {density: 2, %s}}\n"
                                   "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: "
                                   "{particles: [20, 6]}}}}\nperidynamics: {space: plane strain, formulation: %s, "
                                   "horizon: 3.015 spacings}\nfields: {%s}\nsolve: {explicit: {steps: 1}}\n",
                             cases[k].material, cases[k].formulation, cases[k].fields);
    char *words = refusal_of(deck);
    holds_words(words, cases[k].words);
    free(words);
    free(deck);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(factors_follow_the_weibull_distribution),
      cmocka_unit_test(expressions_grade_by_place),
      cmocka_unit_test(factors_scale_laws_and_limits),
      cmocka_unit_test(scattered_bodies_have_the_same_bits),
      cmocka_unit_test(broken_bonds_tell_the_limit_of_the_weaker_end),
      cmocka_unit_test(what_cannot_take_factors_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Concrete along one bond by fib-concrete, against closed forms: the curve of fib Model Code 2010, eq. 5.1-26, the
 * crushing energy beyond the peak, tension as exponential-softening, and the effect of pressure across the bond. */
#include "point.h"

#include "base/random.h"

#define FIB                                                                                                            \
  "Young modulus=30e6", "fracture energy=0.1", "length=0.03", "tensile strength=3000", "compressive strength=30e3",    \
      "crushing energy=6"

typedef struct Bond1 {
  Material material;
  double committed[3], trial[3];
} Bond1;

static Bond1 bond_of(Material material)
{
  assert_int_equal(material.history_values, 3);
  return (Bond1){.material = material};
}

static double bond_try(Bond1 *b, double strain, double lateral, double *tangent)
{
  double stress;
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .strain = {&strain},
                         .stress = {&stress},
                         .committed = b->committed,
                         .trial = b->trial,
                         .tangent = tangent,
                         .lateral = &lateral};
  assert_int_equal(material_update(&b->material, &batch), -1);
  return stress;
}

static double bond_strain(Bond1 *b, double strain, double lateral)
{
  const double stress = bond_try(b, strain, lateral, NULL);
  memcpy(b->committed, b->trial, sizeof b->committed);
  return stress;
}

/** E = 30 GPa, f_c = 30 MPa and a peak strain of 0.0022 make k = 2.2. */
static void compression_follows_the_curve_of_the_model_code(void **state)
{
  (void)state;
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  for (int n = 1; n <= 20; ++n) {
    const double eta = n / 20.0, expected = 30e3 * (2.2 * eta - eta * eta) / (1 + 0.2 * eta);
    assert_near(bond_strain(&b, -0.0022 * eta, 0), -expected, 1e-8);
  }
  assert_near(b.material.law->compressive_strength(b.material.constants), 30e3, 0);
  material_destroy(&b.material);
}

static void crushing_spends_its_energy_beyond_the_peak(void **state)
{
  (void)state;
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  const int steps = 200000;
  const double last = 0.1, step = (last - 0.0022) / steps;
  double work = 0, before = bond_strain(&b, -0.0022, 0);
  for (int n = 1; n <= steps; ++n) {
    const double stress = bond_strain(&b, -0.0022 - n * step, 0);
    work -= (stress + before) / 2 * step;
    before = stress;
  }
  assert_near(work, 6 / 0.03, 1e-4 * 200);
  material_destroy(&b.material);
}

static void crushed_bonds_unload_along_the_modulus_and_keep_their_tension(void **state)
{
  (void)state;
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  const double crushed = bond_strain(&b, -0.003, 0), rest = -0.003 - crushed / 30e6;
  assert_near(b.committed[1], -rest, 1e-12);
  assert_near(bond_strain(&b, -0.0029, 0), crushed + 30e6 * 1e-4, 1e-8);
  assert_near(bond_strain(&b, rest, 0), 0, 1e-8);
  assert_near(bond_strain(&b, rest + 0.99e-4, 0), 2970, 1e-8);
  assert_near(bond_strain(&b, -0.003, 0), crushed, 1e-8);
  material_destroy(&b.material);
}

static void tension_is_that_of_exponential_softening(void **state)
{
  (void)state;
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  Material other = material_of("exponential-softening", "Young modulus=30e6", "fracture energy=0.1", "length=0.03",
                               "tensile strength=3000", NULL);
  double committed = 0, trial = 0;
  for (int n = 1; n <= 100; ++n) {
    double strain = 2e-5 * n, stress, tangent, own;
    breccia_batch batch = {.size = sizeof batch,
                           .count = 1,
                           .strain = {&strain},
                           .stress = {&stress},
                           .committed = &committed,
                           .trial = &trial,
                           .tangent = &tangent};
    assert_int_equal(material_update(&other, &batch), -1);
    committed = trial;
    assert_near(bond_try(&b, strain, 0, &own), stress, 1e-8);
    assert_near(own, tangent, 1e-6 * 30e6);
    bond_strain(&b, strain, 0);
  }
  material_destroy(&b.material);
  material_destroy(&other);
}

/** A bond with an elongation of 2e-4 by pressure across has no damage up to a strain of 3e-4. The elongation is limited
 * to half of the peak strain. */
static void pressure_across_stretches_bonds_without_damage(void **state)
{
  (void)state;
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  assert_near(bond_strain(&b, 2.999e-4, 2e-4), 30e6 * 2.999e-4, 1e-8);
  assert_near(b.committed[0], 0, 0);
  bond_strain(&b, 3.1e-4, 2e-4);
  assert_true(b.committed[0] > 0.01);
  Bond1 fresh = bond_of(b.material);
  bond_strain(&fresh, 0.0011 + 0.99e-4, 1);
  assert_near(fresh.committed[0], 0, 0);
  bond_strain(&fresh, 0.0011 + 1.1e-4, 1);
  assert_true(fresh.committed[0] > 0.001);
  material_destroy(&b.material);
}

/** Under the confining pressure x f_c with alpha = 1/2 the biaxial strength of Kupfer and Gerstle is 1.2556 f_c. A body
 *  of bonds carries 1.1 f_c of it by itself, a bond the rest. Beyond equal pressures bonds gain nothing. */
static void confined_bonds_crush_at_a_larger_stress(void **state)
{
  (void)state;
  const double alpha = 0.5, biaxial = (1 + 3.65 * alpha) / pow(1 + alpha, 2), gain = biaxial / 1.1;
  const Material material = material_of("fib-concrete", FIB, NULL);
  Bond1 b = bond_of(material);
  b.committed[2] = 30e3 * alpha * biaxial;
  assert_near(bond_strain(&b, -0.0022 * gain * gain, 0), -30e3 * gain, 1e-8);
  assert_near(b.committed[2], 30e3 * alpha * biaxial, 0);
  assert_near(b.committed[1], 0.0022 * gain * gain - 1e-3 * gain, 1e-12);
  b = bond_of(material);
  b.committed[2] = 1e-6 * 30e3;
  assert_near(bond_strain(&b, -0.0022, 0), -30e3, 1);
  b = bond_of(material);
  b.committed[2] = 1.3 * 30e3;
  assert_near(bond_strain(&b, -0.0022, 0), -30e3, 1e-8);
  material_destroy(&b.material);
}

/** Under pressure across a cracking bond the tangent is the secant. */
static void tangents_are_slopes(void **state)
{
  (void)state;
  const double ways[] = {-1e-4, 5e-5, 1.3e-4, -1.5e-3, -1.2e-3, 3e-4, -2.5e-3, -4e-3, -3.9e-3, 9e-4};
  Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
  for (size_t n = 0; n < sizeof ways / sizeof *ways; ++n) {
    const double h = ways[n] < 0 ? -1e-9 : 1e-9, lateral = ways[n] < 0 ? 1e-4 : 0;
    double tangent;
    const double here = bond_try(&b, ways[n], lateral, &tangent), there = bond_try(&b, ways[n] + h, lateral, NULL);
    assert_near(tangent, (there - here) / h, 1e-4 * 30e6);
    bond_strain(&b, ways[n], lateral);
  }
  Bond1 fresh = bond_of(b.material);
  double tangent;
  const double stress = bond_try(&fresh, 3.3e-4, 2e-4, &tangent);
  assert_near(tangent, stress / 3.3e-4, 1e-9 * 30e6);
  material_destroy(&b.material);
}

/** Random walks in strain, in pressure across and in confining pressure do work that is never negative, because an undamaged point stores
 *  nothing. */
static void no_walk_makes_energy_whatever_presses_across(void **state)
{
  (void)state;
  uint64_t seed = 7;
  for (int walk = 0; walk < 200; ++walk) {
    Bond1 b = bond_of(material_of("fib-concrete", FIB, NULL));
    double strain = 0, stress = 0, work = 0, put = 0, damage = 0, crushed = 0;
    for (int corner = 0; corner < 12; ++corner) {
      const double to = 4e-3 * (random_uniform(&seed) - 0.6) * pow(10, -2 * random_uniform(&seed)),
                   across = 8e-4 * random_uniform(&seed), from = strain;
      for (int n = 1; n <= 400; ++n) {
        b.committed[2] = 30e3 * random_uniform(&seed);
        const double next = from + (to - from) * n / 400, now = bond_strain(&b, next, across * n / 400),
                     gain = (stress + now) / 2 * (next - strain);
        work += gain;
        put += fabs(gain);
        strain = next;
        stress = now;
        assert_true(b.committed[0] >= damage && b.committed[1] >= crushed);
        damage = b.committed[0];
        crushed = b.committed[1];
        assert_true(now > -1.2 * 30e3);
      }
      if (work < -1e-4 * put) fail_msg("walk %d makes %g of %g", walk, -work, put);
    }
    material_destroy(&b.material);
  }
}

static void impossible_constants_are_refused(void **state)
{
  (void)state;
  const breccia_law *law = NULL;
  for (int k = 0; breccia_law_at(k); ++k)
    if (!strcmp(breccia_law_at(k)->name, "fib-concrete")) law = breccia_law_at(k);
  assert_non_null(law);
  const double good[] = {30e6, 3000, 0.1, 0.03, 30e3, 0.0022, 6, 25, 0.25, 2};
  const struct {
    int which;
    double value;
    const char *word;
  } bad[] = {{5, 0.001, "peak strain"},
             {4, 2000, "compressive strength"},
             {6, 0.5, "finer spacing"},
             {3, NAN, "length"},
             {9, 2.5, "give 1, 2 or 3"}};
  char constants[1024], reason[512] = "";
  double values[10];
  assert_true(law->constants_size <= sizeof constants && law->parameter_count == 10);
  assert_int_equal(law->prepare(good, constants, reason, sizeof reason), 0);
  for (size_t n = 0; n < sizeof bad / sizeof *bad; ++n) {
    memcpy(values, good, sizeof values);
    values[bad[n].which] = bad[n].value;
    assert_int_equal(law->prepare(values, constants, reason, sizeof reason), 1);
    if (!strstr(reason, bad[n].word)) fail_msg("'%s' in place of '%s'", reason, bad[n].word);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(compression_follows_the_curve_of_the_model_code),
      cmocka_unit_test(crushing_spends_its_energy_beyond_the_peak),
      cmocka_unit_test(crushed_bonds_unload_along_the_modulus_and_keep_their_tension),
      cmocka_unit_test(tension_is_that_of_exponential_softening),
      cmocka_unit_test(pressure_across_stretches_bonds_without_damage),
      cmocka_unit_test(confined_bonds_crush_at_a_larger_stress),
      cmocka_unit_test(tangents_are_slopes),
      cmocka_unit_test(no_walk_makes_energy_whatever_presses_across),
      cmocka_unit_test(impossible_constants_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

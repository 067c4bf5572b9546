/* Laws of one strain. */
#include "support.h"

#include "base/random.h"

typedef struct Fibre {
  Material material;
  double committed[8], trial[8];
} Fibre;

static Fibre fibre(Material material)
{
  Fibre f = {.material = material};
  assert_true(material.history_values <= 8);
  return f;
}

static double stress_at(Fibre *f, double strain, double *tangent, int elastic)
{
  double stress;
  breccia_batch batch = {.count = 1,
                         .strain = {&strain},
                         .stress = {&stress},
                         .committed = f->committed,
                         .trial = f->trial,
                         .tangent = tangent,
                         .elastic_stage = elastic};
  assert_int_equal(f->material.law->update(f->material.constants, &batch), -1);
  return stress;
}

static double pull(Fibre *f, double strain)
{
  double stress = stress_at(f, strain, NULL, 0);
  memcpy(f->committed, f->trial, sizeof f->committed);
  return stress;
}

/* Concrete: f_t^2 / E = 400 N/m3 x ..., with a length of 30 mm: E in kPa, G_F in kN/m. */
#define CONCRETE "Young modulus=30e6", "fracture energy=0.1", "length=0.03"
#define STRONG CONCRETE, "tensile strength=3000"

static Material softening(int k)
{
  switch (k) {
  case 0: return material_of("bilinear-softening", STRONG, NULL);
  case 1: return material_of("exponential-softening", STRONG, NULL);
  default: return material_of("elastic-brittle", CONCRETE, NULL);
  }
}

static void pulling_apart_spends_the_fracture_energy_over_the_length(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Fibre f = fibre(softening(k));
    const double end = material_failure_strain(&f.material);
    const int steps = 400000;
    double work = 0, before = 0;
    for (int n = 1; n <= steps; ++n) {
      double stress = pull(&f, end * n / steps);
      work += (stress + before) / 2 * end / steps;
      before = stress;
    }
    assert_near(work, 0.1 / 0.03, 1e-5 * work);
    assert_near(pull(&f, end * 1.0001), 0, 0);
    assert_near(f.committed[0], 1, 0);
    material_destroy(&f.material);
  }
}

static void softening_curves_go_through_their_points(void **state)
{
  (void)state;
  const double peak = 3000 / 30e6;
  Fibre f = fibre(softening(0));
  double end = 2 * 0.1 / 0.03 / 3000; /* f_t end / 2 = G_F / length */
  assert_near(material_failure_strain(&f.material), end, 1e-12);
  assert_near(pull(&f, peak), 3000, 1e-9);
  assert_near(pull(&f, peak + (end - peak) / 4), 2250, 1e-9);
  material_destroy(&f.material);
  f = fibre(softening(1));
  end = material_failure_strain(&f.material);
  for (int n = 0; n < 20; ++n) {
    double x = (n + 0.5) / 20;
    double expected = 3000 * (1 - (1 - exp(-25 * x)) / (1 - exp(-25)) + 0.25 * (1 - x)) / 1.25;
    assert_near(pull(&f, peak + x * (end - peak)), expected, 1e-9);
  }
  material_destroy(&f.material);
  f = fibre(material_of("elastic-brittle", "Young modulus=30e6", "tensile strength=3000", NULL));
  assert_near(pull(&f, peak * (1 - 1e-12)), 3000, 1e-8);
  assert_near(pull(&f, peak * (1 + 1e-12)), 0, 0);
  assert_near(pull(&f, -peak), 0, 0); /* broken for good */
  material_destroy(&f.material);
}

static void softened_fibres_unload_to_the_origin_and_close_stiff(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Fibre f = fibre(softening(k));
    const double strain = 3e-4, stress = pull(&f, strain);
    assert_true(stress < 3000 && stress > 0);
    for (int n = 9; n >= 0; --n) assert_near(pull(&f, strain * n / 10), stress * n / 10, 1e-9 * stress);
    assert_near(pull(&f, -1e-4), -3000, 1e-9);
    assert_near(pull(&f, strain / 2), stress / 2, 1e-9 * stress);
    assert_near(pull(&f, strain), stress, 1e-9 * stress);
    Fibre fresh = fibre(f.material); /* the way there does not matter */
    assert_near(pull(&f, 2 * strain), pull(&fresh, 2 * strain), 1e-9 * stress);
    assert_near(stress_at(&fresh, 3 * strain, NULL, 1), 30e6 * 3 * strain, 1e-6); /* the elastic stage */
    material_destroy(&f.material);
  }
}

static void tangents_are_derivatives(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Fibre f = fibre(softening(k));
    const double ways[] = {-1e-4, 5e-5, 1.3e-4, 3e-4, 1e-4, 9e-4, 2e-3, 0.02};
    for (size_t n = 0; n < sizeof ways / sizeof *ways; ++n) {
      double tangent, ignored, h = 1e-9;
      double here = stress_at(&f, ways[n], &tangent, 0), there = stress_at(&f, ways[n] + h, &ignored, 0);
      assert_near(tangent, (there - here) / h, 1e-4 * 30e6);
      pull(&f, ways[n]);
    }
    material_destroy(&f.material);
  }
}

static void walks_of_chance_never_make_energy_or_leave_the_curve(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Fibre f = fibre(softening(k));
    const double strength = k < 2 ? 3000 : 30e6 * material_failure_strain(&f.material);
    uint64_t seed = 5;
    double strain = 0, stress = 0, work = 0, damage = 0;
    for (int n = 0; n < 200000; ++n) {
      double next = strain + pow(10, -9 + 6 * random_uniform(&seed)) * (random_uniform(&seed) - 0.5);
      double now = pull(&f, next);
      assert_true(isfinite(now) && now <= strength * (1 + 1e-12));
      assert_true(f.committed[0] >= damage && f.committed[0] <= 1);
      damage = f.committed[0];
      work += (stress + now) / 2 * (next - strain);
      strain = next;
      stress = now;
    }
    assert_true(work - stress * strain / 2 >= -1e-3 * strength * material_failure_strain(&f.material));
    material_destroy(&f.material);
  }
}

static void curves_that_would_snap_back_are_refused(void **state)
{
  (void)state;
  const double values[] = {30e6, 3000, 0.1, 0.7}, neither[] = {30e6, NAN, NAN, 0.03},
               nowhere[] = {30e6, 3000, 0.1, NAN};
  char reason[512];
  Material m;
  assert_int_equal(material_prepare(&m, law_find(NULL, "bilinear-softening"), values, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "it must be less than 2 E G_F / f_t^2 = 0.666667"));
  assert_int_equal(material_prepare(&m, law_find(NULL, "bilinear-softening"), nowhere, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "needs the 'length'"));
  assert_int_equal(material_prepare(&m, law_find(NULL, "elastic-brittle"), neither, reason, sizeof reason),
                   BRECCIA_USER_ERROR);
  assert_non_null(strstr(reason, "give either 'tensile strength' or 'fracture energy'"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pulling_apart_spends_the_fracture_energy_over_the_length),
      cmocka_unit_test(softening_curves_go_through_their_points),
      cmocka_unit_test(softened_fibres_unload_to_the_origin_and_close_stiff),
      cmocka_unit_test(tangents_are_derivatives),
      cmocka_unit_test(walks_of_chance_never_make_energy_or_leave_the_curve),
      cmocka_unit_test(curves_that_would_snap_back_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

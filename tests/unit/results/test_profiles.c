/* The most that layers of particles have done in a run: against a column that swings in its first mode. */
#include "base/csv.h"
#include "support.h"

#include <unistd.h>

/** A column of soil, 20 m high with shear waves of 200 m/s, which nothing damps. */
#define COLUMN                                                                                                         \
  "units: {length: m, force: kN, time: s}\n"                                                                           \
  "materials: {m: {model: elastic, Young modulus: 2e5, Poisson ratio: 0.25, density: 2}}\n"                            \
  "body: {soil: {material: m, lattice: square, thickness: 1, spacing: 0.5, shape: {box: {from: [0, 0], to: [2, "       \
  "20]}}}}\n"                                                                                                          \
  "peridynamics: {space: plane strain, strain: small}\n"                                                               \
  "loads: [{on: {face: y-}, support: {held: all}}, {on: {face: x-}, support: {held: periodic}}]\n"

static const double pi = 3.14159265358979323846;

/** A column of a profile that was written, with as many rows as it must have; to be freed. */
static double *column_of(const char *folder, const char *name, int rows, const char *heading)
{
  char path[128], label[128];
  int count = 0;
  snprintf(path, sizeof path, "%s/profiles/soil.csv", folder);
  breccia_error *error = breccia_error_create();
  double *values = csv_column(path, name, CSV_FINISHED, &count, label, error);
  if (!values) fail_msg("%s", breccia_error_text(error));
  assert_int_equal(count, rows);
  assert_string_equal(label, heading);
  breccia_error_destroy(&error);
  return values;
}

static void a_swing_is_told_at_its_largest(void **state)
{
  (void)state;
  breccia_model *m = model_of(COLUMN "solve: {explicit: {end time: 0.45}}\n"
                                     "profiles: {soil: {of: {all: yes}, along: y, every: 1}}\npictures: []\n");
  const double k = pi / 40, omega = 200 * k, v = 0.05, modulus = 8e4;
  Particles *p = m->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->velocity.row[0][i] = -v * sin(k * p->position[1][i]);
  }
  char folder[] = "/tmp/breccia-XXXXXX";
  assert_non_null(mkdtemp(folder));
  breccia_error *error = breccia_error_create();
  const breccia_run run = {.size = sizeof run, .folder = folder};
  if (breccia_model_run(m, &run, error)) fail_msg("%s", breccia_error_text(error));
  assert_non_null(strstr(breccia_model_outcome(m), "/profiles/soil.csv\n"));
  double *y = column_of(folder, "y", 40, "y (m)"), *u = column_of(folder, "displacement x", 40, "displacement x (m)"),
         *s = column_of(folder, "velocity x", 40, "velocity x (m/s)"),
         *a = column_of(folder, "acceleration x", 40, "acceleration x (m/s2)"),
         *gamma = column_of(folder, "shear strain", 40, "shear strain"),
         *tau = column_of(folder, "shear stress", 40, "shear stress (kPa)");
  for (int n = 0; n < 40; ++n) {
    const double shape = sin(k * (0.25 + 0.5 * n)), slope = k * cos(k * (0.25 + 0.5 * n));
    assert_near(y[n], 0.25 + 0.5 * n, 1e-9);
    assert_near(u[n], v / omega * shape, 0.01 * v / omega);
    assert_near(s[n], v * shape, 0.01 * v);
    assert_near(a[n], v * omega * shape, 0.02 * v * omega);
    assert_near(gamma[n], v / omega * slope, 0.04 * v / omega * k); /* nearest to the free surface */
    assert_near(tau[n], modulus * gamma[n], 1e-9 * modulus * k * v);
  }
  double *const all[] = {y, u, s, a, gamma, tau};
  for (int n = 0; n < 6; ++n) free(all[n]);
  char words[160];
  snprintf(words, sizeof words, "rm -r %s", folder);
  assert_int_equal(system(words), 0);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
}

/** Shear on planes across x has the parts xy and zx, and so on round: of a strain whose six parts are all others, along each axis. */
static void shear_is_that_across_the_axis(void **state)
{
  (void)state;
  const double f[9] = {1.0001, 3e-4, 2e-4, 0, 0.9998, 5e-4, 7e-4, 0, 1.0003};
  const double xy = 3e-4, yz = 5e-4, zx = 9e-4;
  const double across[3] = {hypot(xy, zx), hypot(xy, yz), hypot(yz, zx)};
  breccia_model *m = model_of(
      "units: {length: m, force: kN, time: s}\n"
      "materials: {m: {model: elastic, Young modulus: 2e5, Poisson ratio: 0.25, density: 2}}\n"
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [5, 6, 7]}}}}\n"
      "peridynamics: {strain: small}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\npictures: []\n"
      "profiles: {a: {of: {all: yes}, along: x}, b: {of: {all: yes}, along: y}, c: {of: {all: yes}, along: z}}\n");
  char folder[] = "/tmp/breccia-XXXXXX", words[160], path[160];
  assert_non_null(mkdtemp(folder));
  deform_uniformly(m, f);
  const breccia_run run = {.size = sizeof run, .folder = folder};
  assert_int_equal(breccia_model_run(m, &run, NULL), 0);
  for (int k = 0; k < 3; ++k) {
    int count = 0;
    snprintf(path, sizeof path, "%s/profiles/%c.csv", folder, "abc"[k]);
    double *strain = csv_column(path, "shear strain", CSV_FINISHED, &count, words, NULL),
           *stress = csv_column(path, "shear stress", CSV_FINISHED, &count, words, NULL);
    assert_true(strain && stress);
    assert_int_equal(count, 5 + k);
    for (int n = 0; n < count; ++n) {
      assert_near(strain[n], across[k], 1e-9);
      assert_near(stress[n], 8e4 * across[k], 1e-4);
    }
    free(strain);
    free(stress);
  }
  snprintf(words, sizeof words, "rm -r %s", folder);
  assert_int_equal(system(words), 0);
  breccia_model_destroy(&m);
}

static void wrong_profiles_are_refused(void **state)
{
  (void)state;
  const struct {
    const char *profile, *words;
  } wrong[] = {
      {"{of: {all: yes}, along: z}", "along: the body does not reach along z; take x or y"},
      {"{of: {all: yes}, along: up}", "along"},
      {"{along: y}", "of"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[2048];
    snprintf(deck, sizeof deck, COLUMN "solve: {explicit: {steps: 1}}\nprofiles: {soil: %s}\n", wrong[k].profile);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words) || !strstr(words, "deck:7:"))
      fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_swing_is_told_at_its_largest),
      cmocka_unit_test(shear_is_that_across_the_axis),
      cmocka_unit_test(wrong_profiles_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

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
    p->velocity[0][i] = -v * sin(k * p->position[1][i]);
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
      cmocka_unit_test(wrong_profiles_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Many points of a law in servers at once: every stress and tangent comes from the point that it belongs to. */
#include "servers.h"

#include "base/random.h"

#define SOLID "Young modulus=2e8; Poisson ratio=0.3; yield stress=4e5; hardening modulus=2e7"

static void tangents_of_many_points_on_two_servers_are_those_of_the_law(void **state)
{
  (void)state;
  Servers servers;
  servers_start(&servers, 2);
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {steel: {remote: '%s', server: ['%s', '%s'], density: 8}}\n"
                              "body: {b: {material: steel, spacing: 0.1, shape: {box: {particles: [16, 8, 6]}}}}\n"
                              "solve: {explicit: {time step: 1e-9, steps: 1}}\n",
                              "j2; " SOLID, servers.address[0], servers.address[1]);
  step_surely(m, 1); /* servers take up points as a run begins */
  const Points *points = &m->domain.regions[0].points;
  const Material *remote = &points->materials[0];
  Material local =
      material_of("j2", "Young modulus=2e8", "Poisson ratio=0.3", "yield stress=4e5", "hardening modulus=2e7", NULL);
  const int count = (int)points->count;
  assert_int_equal(count, 16 * 8 * 6); /* no place is empty: each server gets all its points in one frame */
  double *numbers = calloc((size_t)count * (12 + 36), sizeof(double)), *tangent = numbers + 12 * count;
  breccia_batch batch = {.size = sizeof(breccia_batch),
                         .count = count,
                         .committed = points->committed,
                         .trial = points->trial,
                         .tangent = tangent};
  uint64_t seed = 3;
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = numbers + k * count;
    batch.stress[k] = numbers + (6 + k) * count;
    for (int i = 0; i < count; ++i) numbers[k * count + i] = 1e-2 * (random_uniform(&seed) - 0.5);
  }
  assert_int_equal(remote->law->update(remote->constants, &batch), -1);
  int plastic = 0;
  for (int64_t n = 0; n < m->domain.particles->count; ++n) {
    const int i = m->domain.particles->place_of[n];
    double strain[6], stress[6], own[36], *history = calloc((size_t)local.history_values * 2 + 1, sizeof(double));
    breccia_batch one = {.size = sizeof(breccia_batch),
                         .count = 1,
                         .committed = history,
                         .trial = history + local.history_values,
                         .tangent = own};
    for (int k = 0; k < 6; ++k) {
      strain[k] = numbers[k * count + i];
      one.strain[k] = &strain[k];
      one.stress[k] = &stress[k];
    }
    assert_int_equal(local.law->update(local.constants, &one), -1);
    for (int k = 0; k < 6; ++k) assert_near(numbers[(6 + k) * count + i], stress[k], 1e-9 * 4e5);
    for (int k = 0; k < 36; ++k) assert_near(tangent[36 * i + k], own[k], 1e-9 * 2e8);
    plastic += own[21] < 0.9 * local.shear;
    free(history);
  }
  assert_true(plastic > 500);
  free(numbers);
  material_destroy(&local);
  breccia_model_destroy(&m);
  servers_stop(&servers);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_of_many_points_on_two_servers_are_those_of_the_law),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

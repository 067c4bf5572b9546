/* Many points of a law in servers at once: every stress and tangent comes from the point that it belongs to. */
#include "support.h"

#include "base/random.h"
#include "constitutive/remote/server.h"

#include <pthread.h>
#include <time.h>
#include <unistd.h>

enum { SERVERS = 2 };

static volatile int listening, interrupted;

static void count_listening(const char *address)
{
  (void)address;
  __atomic_fetch_add(&listening, 1, __ATOMIC_SEQ_CST);
}

static void *serve(void *spec)
{
  static int bad = 1;
  return serve_materials(spec, NULL) ? &bad : NULL;
}

#define SOLID "Young modulus=2e8; Poisson ratio=0.3; yield stress=4e5; hardening modulus=2e7"

static void tangents_of_many_points_on_two_servers_are_those_of_the_law(void **state)
{
  (void)state;
  char folder[] = "/tmp/breccia-served-XXXXXX", address[SERVERS][64];
  pthread_t thread[SERVERS];
  ServeSpec spec[SERVERS];
  assert_non_null(mkdtemp(folder));
  listening = interrupted = 0;
  for (int k = 0; k < SERVERS; ++k) {
    snprintf(address[k], sizeof address[k], "unix:%s/%d", folder, k);
    spec[k] = (ServeSpec){.address = address[k], .interrupted = &interrupted, .listening = count_listening};
    assert_int_equal(pthread_create(&thread[k], NULL, serve, &spec[k]), 0);
  }
  while (listening < SERVERS) nanosleep(&(struct timespec){.tv_nsec = 1000000L}, NULL);
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {steel: {remote: '%s', server: ['%s', '%s'], density: 8}}\n"
                              "body: {b: {material: steel, spacing: 0.1, shape: {box: {particles: [16, 8, 6]}}}}\n"
                              "solve: {explicit: {time step: 1e-9, steps: 1}}\n",
                              "j2; " SOLID, address[0], address[1]);
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
  interrupted = 1;
  for (int k = 0; k < SERVERS; ++k) {
    void *bad;
    pthread_join(thread[k], &bad);
    assert_null(bad);
  }
  rmdir(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_of_many_points_on_two_servers_are_those_of_the_law),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

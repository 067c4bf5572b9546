/* Sums along lattice rows that threads make of some planes at a time, each in memory of its own, lead to the bits to which sums of the whole body lead. */
#include "domain/regions.h"
#include "support.h"

/** A plate that is pulled and sheared at one end. */
static breccia_model *plate_on(int threads, const char *law, const char *peridynamics, const char *more)
{
  return model_on(threads,
                  "materials: {m: {model: %s, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
                  "body: {b: {material: m, spacing: 1, shape: {box: {from: [0, 0, 0], to: [92, 3, 90]}}}}\n"
                  "peridynamics: {formulation: correspondence, %s}\n%s"
                  "loads: [{on: {face: z-}, displacement: [0, 0, 0]}, {on: {face: z+}, velocity: [0.1, 0, 0.6]},\n"
                  "        {on: {face: x+}, traction: [0.02, 0, 0]}]\n"
                  "solve: {explicit: {steps: 40}}\n",
                  law, peridynamics, more);
}

static void windows_lead_to_the_same_bits(void **state)
{
  (void)state;
  static const struct {
    const char *law, *peridynamics;
  } cases[] = {{"elastic", "strain: green-lagrange"},
               {"elastic", "strain: small, zero-energy control: {wan: 0.1}"},
               {"elastic", "horizon: 4.015 spacings"}, /* rows of several kinds */
               {"j2, yield stress: 0.5", "strain: green-lagrange"}};
  const int steps = under_sanitizers() ? 2 : 4;
  for (size_t k = under_sanitizers() ? 3 : 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *whole = plate_on(1, cases[k].law, cases[k].peridynamics, "");
    whole->domain.regions[0].window.threads = 0;
    step_surely(whole, steps);
    const Particles *q = whole->domain.particles;
    assert_true(fabs(q->internal.row[2][q->place_of[q->count - 300]]) > 1e-9);
    for (int threads = k && !whole_walks() ? 3 : 1; threads <= 3; ++threads) {
      if (under_sanitizers() && threads != 3) continue;
      breccia_model *some = plate_on(threads, cases[k].law, cases[k].peridynamics, "");
      const Particles *p = some->domain.particles;
      assert_in_range(some->domain.regions[0].window.threads, 3, 1000);
      step_surely(some, steps);
      assert_same_numbers(p->displacement.row, q->displacement.row, 3, p->places, cases[k].peridynamics);
      assert_same_numbers(p->velocity.row, q->velocity.row, 3, p->places, cases[k].peridynamics);
      assert_same_numbers(p->internal.row, q->internal.row, 3, p->places, cases[k].peridynamics);
      breccia_model_destroy(&some);
    }
    breccia_model_destroy(&whole);
  }
}

static breccia_model *elastic_plate(int threads)
{
  return plate_on(threads, "elastic", "strain: green-lagrange", "");
}

static breccia_model *plastic_plate(int threads)
{
  return plate_on(threads, "j2, yield stress: 0.5", "strain: small", "");
}

static void so_do_numbers_of_threads_and_restarts(void **state)
{
  (void)state;
  if (under_sanitizers()) skip();
  assert_same_bits_by_threads_and_restart(elastic_plate, 2, 4);
  assert_same_bits_by_threads_and_restart(plastic_plate, 2, 4);
}

/** More threads than windows pay for share sums of the whole body; so do those of bodies whose bonds may break, and of bodies of which windows would hold most. */
static void others_work_without(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* sums of the whole body are those above */
  breccia_model *m = plate_on(2, "elastic", "strain: small", "");
  Window *w = &m->domain.regions[0].window;
  assert_true(window_of_thread(w) != NULL);
  assert_true(w->threads * w->slices <= m->domain.particles->slices / 2);
  breccia_model *other = plate_on(2, "elastic", "strain: small", "");
  w->threads = 1;
  step_surely(m, 3);
  step_surely(other, 3);
  assert_same_numbers(m->domain.particles->velocity.row, other->domain.particles->velocity.row, 3,
                      m->domain.particles->places, "velocity");
  breccia_model_destroy(&other);
  breccia_model_destroy(&m);
  m = plate_on(1, "elastic", "strain: small", "failure: {critical stretch: 0.5}\n");
  assert_int_equal(m->domain.regions[0].window.threads, 0);
  breccia_model_destroy(&m);
  m = model_of("%sbody: {b: {material: m, spacing: 1, shape: {box: {particles: [8, 8, 8]}}}}\n"
               "peridynamics: {formulation: correspondence}\nsolve: {explicit: {steps: 4}}\n",
               SOFT_SOLID);
  assert_int_equal(m->domain.regions[0].window.threads, 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_lead_to_the_same_bits),
      cmocka_unit_test(so_do_numbers_of_threads_and_restarts),
      cmocka_unit_test(others_work_without),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Planes of hybrid bonds in cubic lattices (formulation/hybrid_planes.c): the forces of bonds that are walked one by one, whatever is cut out, cut, broken or mended, and
 * the same bits for any number of threads and lanes. */
#include "formulation/hybrid.h"

#include "base/random.h"
#include "support.h"

#include <stdlib.h>

/** Two blocks of different laws, a hole and a cut. Rows run along x, and along y in the second. A law that never yields asks for walks. */
static breccia_model *body(bool walked, const char *horizon, const char *strain, bool turned)
{
  const char *law = walked ? "model: j2, yield stress: 1e30" : "model: elastic";
  const char *shape = turned ? "{from: [0, 0, 0], to: [13, 19, 13]}" : "{from: [0, 0, 0], to: [19, 13, 13]}";
  const char *beside = turned ? "{from: [13, 0, 0], to: [28, 19, 13]}" : "{from: [0, 13, 0], to: [19, 28, 13]}";
  return model_of("units: {length: m, force: kN, time: s}\n"
                  "materials: {m: {%s, density: 2, Young modulus: 1e5, Poisson ratio: 0.25}, n: {%s, density: 1, Young "
                  "modulus: 3e4, Poisson ratio: 0.1}}\n"
                  "body:\n"
                  "  a: {material: m, spacing: 1, shape: {difference: [{box: %s}, {sphere: {centre: [5, 5, 4], radius: "
                  "1.2}}]}}\n"
                  "  b: {material: n, spacing: 1, shape: {box: %s}}\n"
                  "cracks: [{cut: {polygon: [[3, -1, -1], [3, 3.4, -1], [3, 3.4, 5], [3, -1, 5]]}}]\n"
                  "peridynamics: {formulation: hybrid, horizon: %s spacings, strain: %s}\n"
                  "solve: {explicit: {steps: 1}}\n",
                  law, law, shape, beside, horizon, strain);
}

static const Hybrid *formulation_of(const breccia_model *model)
{
  return model->domain.regions[0].formulation;
}

static void displace(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  uint64_t seed = 3;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) p->displacement[k][p->place_of[n]] = 4e-2 * (random_uniform(&seed) - 0.5);
}

/** Bonds that planes go through. */
static int64_t planar(const Hybrid *h)
{
  int64_t count = 0;
  for (int64_t group = 0; group < h->bonds->owned_first[h->particles->slices]; ++group)
    count += __builtin_popcount(h->planar[group]);
  return count;
}

/** Breaks some bonds inside, or mends them. */
static void change_bonds(breccia_model *model, bool breaks)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  Hybrid *h = d->regions[0].formulation;
  uint64_t seed = 7;
  for (int n = 0; n < 12; ++n) {
    const int32_t a = p->place_of[(int64_t)(random_uniform(&seed) * (double)p->count)];
    const int64_t slice = a / SLICE, slots = d->family.stored[slice] - d->family.first[slice];
    const int64_t slot = d->family.first[slice] + (int64_t)(random_uniform(&seed) * (double)slots);
    const int32_t b = family_base(&d->family, slice, slot) + a % SLICE;
    if (breaks ? !family_break(&d->family, a, b) : !family_mend(&d->family, a, b)) continue;
    hybrid_renew(h, a / SLICE);
    hybrid_renew(h, b / SLICE);
  }
}

static void assert_close(const Particles *p, const Particles *q, const char *when)
{
  double largest = 0, off = 0;
  for (int64_t i = 0; i < p->places; ++i)
    for (int k = 0; k < 3; ++k) {
      largest = fmax(largest, fabs(q->internal[k][i]));
      off = fmax(off, fabs(p->internal[k][i] - q->internal[k][i]));
    }
  if (!(off <= 1e-13 * largest) || largest == 0) fail_msg("%s: %g beside %g", when, off, largest);
}

/** Forces, with bonds that break and are mended, and changes of forces; once with more kinds of slices than are kept. */
static void planes_exert_what_walked_bonds_do(void **state)
{
  (void)state;
  static const char *const strains[] = {"green-lagrange", "small"};
  for (int n = 0; n < 4; n += under_sanitizers() ? 3 : 1) {
    const char *strain = strains[n % 2], *horizon = n < 2 ? "1.5" : "2.015";
    const bool turned = n == 1 || n == 2;
    breccia_model *m = body(false, horizon, strain, turned), *w = body(true, horizon, strain, turned);
    const Particles *p = m->domain.particles, *q = w->domain.particles;
    assert_null(formulation_of(w)->planar);
    const int64_t before = planar(formulation_of(m));
    assert_true(before > m->domain.family.bonds / 2 / 2); /* of bonds once each: at least half */
    displace(m);
    displace(w);
    if (n == 3) ((Hybrid *)m->domain.regions[0].formulation)->plane_kinds = HYBRID_ODD; /* no room for more of them */
    for (int turn = 0; turn < 3; ++turn) {
      if (turn) change_bonds(m, turn == 1);
      if (turn) change_bonds(w, turn == 1);
      assert_true((planar(formulation_of(m)) < before) == (turn == 1));
      compute_forces(m);
      compute_forces(w);
      assert_close(p, q, turn == 1 ? "broken" : turn ? "mended" : "whole");
    }
    assert_int_equal(domain_linearise(&m->domain, NULL, NULL), 0);
    assert_int_equal(domain_linearise(&w->domain, NULL, NULL), 0);
    double *v[3], *change[2][3], largest = 0;
    for (int k = 0; k < 3; ++k) {
      v[k] = places_array(p->places, "v", NULL);
      for (int64_t i = 0; i < p->places; ++i) v[k][i] = p->number[i] >= 0 ? sin(0.7 * (double)i + k) : 0;
      for (int of = 0; of < 2; ++of) change[of][k] = places_array(p->places, "K v", NULL);
    }
    domain_linear_step(&m->domain, v, change[0]);
    domain_linear_step(&w->domain, v, change[1]);
    for (int turn = 0; turn < 2; ++turn)
      for (int64_t i = 0; i < p->places; ++i)
        for (int k = 0; k < 3; ++k) {
          if (!turn) largest = fmax(largest, fabs(change[1][k][i]));
          if (turn) assert_near(change[0][k][i], change[1][k][i], 1e-13 * largest);
        }
    for (int k = 0; k < 3; ++k) {
      places_free(&v[k]);
      for (int of = 0; of < 2; ++of) places_free(&change[of][k]);
    }
    breccia_model_destroy(&m);
    breccia_model_destroy(&w);
  }
}

/** A cube of n particles in each direction. With 1.5 spacings bonds along axes see particles beside them, those across squares before and behind them; with
 *  2.015 spacings those across squares and through cubes also particles a spacing beyond their ends. What lies in line with a bond tells nothing of
 *  its strain, so that bonds along axes need none there. */
static void bonds_with_the_fit_of_an_endless_lattice_go_by_planes(void **state)
{
  (void)state;
  const int64_t n = 16, a = n - 1, b = n - 2, c = n - 3; /* places of what is two, three and four particles long */
  const int64_t asked[] = {3 * a * b * b + 6 * a * a * b,
                           3 * a * b * b + 3 * b * b * b + 6 * c * c * b + 4 * c * c * c};
  for (int of = 0; of < 2; ++of) {
    breccia_model *m =
        model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e5, Poisson ratio: 0.25}}\n"
                 "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [16, 16, 16]}}}}\n"
                 "peridynamics: {formulation: hybrid, horizon: %s spacings}\n"
                 "solve: {explicit: {steps: 1}}\n",
                 of ? "2.015" : "1.5");
    assert_int_equal(planar(formulation_of(m)), asked[of]);
    breccia_model_destroy(&m);
  }
}

static void eight_lanes_give_the_bits_of_four(void **state)
{
  (void)state;
  static const char *const strains[] = {"green-lagrange", "small"};
  double *forces[2][3];
  for (int n = 0; n < 6; ++n) {
    setenv("BRECCIA_LANES", n % 2 ? "8" : "4", 1);
    breccia_model *m =
        n < 4 ? body(false, n < 2 ? "1.5" : "2.015", strains[n / 2], false)
              : model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e5, Poisson ratio: 0.25}}\n"
                         "body: {b: {material: m, spacing: 1, shape: {box: {particles: [21, 8, 6]}}}}\n"
                         "peridynamics: {formulation: hybrid, horizon: 3.015 spacings}\n"
                         "solve: {explicit: {steps: 1}}\n");
    const int64_t places = m->domain.particles->places;
    displace(m);
    compute_forces(m);
    for (int k = 0; k < 3; ++k) {
      forces[n % 2][k] = places_array(places, "forces", NULL);
      memcpy(forces[n % 2][k], m->domain.particles->internal[k], sizeof(double) * (size_t)places);
    }
    breccia_model_destroy(&m);
    for (int k = 0; k < 3 && n % 2; ++k) {
      assert_memory_equal(forces[0][k], forces[1][k], sizeof(double) * (size_t)places);
      for (int of = 0; of < 2; ++of) places_free(&forces[of][k]);
    }
  }
  unsetenv("BRECCIA_LANES");
}

/** Longer than a column is wide, more than it has rows; and so short that each piece has two numbers. */
static void rows_of_any_length_exert_what_walked_bonds_do(void **state)
{
  (void)state;
  static const int size[][3] = {{70, 23, 12}, {16, 16, 16}};
  for (int n = 0; n < 4; n += whole_walks() ? 1 : 3) { /* each size by one of the horizons */
    const int *cells = size[n / 2];
    breccia_model *model[3]; /* eight lanes, four, walked */
    for (int k = 0; k < 3; ++k) {
      setenv("BRECCIA_LANES", k == 1 ? "4" : "8", 1);
      model[k] = model_of("units: {length: m, force: kN, time: s}\n"
                          "materials: {m: {%s, density: 2, Young modulus: 1e5, Poisson ratio: 0.3}}\n"
                          "body: {b: {material: m, spacing: 1, shape: {box: {particles: [%d, %d, %d]}}}}\n"
                          "peridynamics: {formulation: hybrid, horizon: %s spacings}\n"
                          "solve: {explicit: {steps: 1, time step: 1e-3}}\n",
                          k == 2 ? "model: j2, yield stress: 1e30" : "model: elastic", cells[0], cells[1], cells[2],
                          n % 2 ? "2.015" : "1.5");
      displace(model[k]);
      compute_forces(model[k]);
    }
    const Particles *p = model[0]->domain.particles, *q = model[1]->domain.particles;
    assert_true(planar(formulation_of(model[0])) > 0);
    assert_close(p, model[2]->domain.particles, "walked");
    for (int k = 0; k < 3; ++k) assert_memory_equal(p->internal[k], q->internal[k], sizeof(double) * (size_t)p->places);
    for (int k = 0; k < 3; ++k) breccia_model_destroy(&model[k]);
  }
  unsetenv("BRECCIA_LANES");
}

/** A plate with a notch that is torn. */
static breccia_model *torn(int threads)
{
  breccia_model *model =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: elastic, density: 2.4, Young modulus: 30e6, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, spacing: 0.01, shape: {box: {particles: [18, 15, 13]}}}}\n"
               "cracks: [{cut: {polygon: [[-1, 0.07, -1], [0.06, 0.07, -1], [0.06, 0.07, 1], [-1, 0.07, 1]]}}]\n"
               "peridynamics: {formulation: hybrid, horizon: 1.5 spacings}\n"
               "failure: {critical stretch: 2e-4, near grips: hold}\n"
               "loads: [{on: {face: y+, layers: 2}, velocity: [free, 0.2], history: {ramp to: 20e-6}},\n"
               "        {on: {face: y-, layers: 2}, velocity: [free, -0.2], history: {ramp to: 20e-6}}]\n"
               "solve: {explicit: {end time: 4e-4}}\n");
  model->threads = threads;
  return model;
}

static void breaking_has_the_same_bits_by_threads_and_after_a_restart(void **state)
{
  (void)state;
  if (!under_sanitizers()) {
    breccia_model *m = torn(1);
    const int64_t before = planar(formulation_of(m));
    step_surely(m, 60);
    assert_true(m->domain.broken_count > 20 && planar(formulation_of(m)) < before);
    breccia_model_destroy(&m);
  }
  assert_same_bits_by_threads_and_restart(torn, 45, 60);
}

/** Rows of planes are as long as those of a block: what the first of two blocks that do not touch has left at the end of a longer row is none of the other's. */
static void blocks_that_do_not_touch_exert_nothing_on_each_other(void **state)
{
  (void)state;
  breccia_model *m = model_of("units: {length: m, force: kN, time: s}\n"
                              "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
                              "body:\n"
                              "  a: {material: m, spacing: 1, shape: {union: [{box: {from: [0, 0, 0], to: [64, 15, "
                              "17]}}, {box: {from: [47, 15, "
                              "0], to: [49, 16, 17]}}]}}\n"
                              "  b: {material: m, spacing: 1, shape: {box: {from: [0, 40, 0], to: [72, 56, 16]}}}\n"
                              "peridynamics: {formulation: hybrid, horizon: 1.5 spacings}\n"
                              "solve: {explicit: {steps: 1, time step: 1e-3}}\n");
  const Particles *p = m->domain.particles;
  double moved = 0, still = 0;
  for (int64_t i = 0; i < p->places; ++i)
    if (p->number[i] >= 0 && p->position[1][i] < 20 && p->position[0][i] > 48)
      p->displacement[0][i] = 1e-3 * (p->position[0][i] - 48);
  compute_forces(m);
  for (int64_t i = 0; i < p->places; ++i) {
    double *most = p->position[1][i] < 20 ? &moved : &still;
    for (int k = 0; k < 3 && p->number[i] >= 0; ++k) *most = fmax(*most, fabs(p->internal[k][i]));
  }
  assert_true(moved > 0);
  assert_true(still == 0);
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(planes_exert_what_walked_bonds_do),
      cmocka_unit_test(rows_of_any_length_exert_what_walked_bonds_do),
      cmocka_unit_test(blocks_that_do_not_touch_exert_nothing_on_each_other),
      cmocka_unit_test(bonds_with_the_fit_of_an_endless_lattice_go_by_planes),
      cmocka_unit_test(eight_lanes_give_the_bits_of_four),
      cmocka_unit_test(breaking_has_the_same_bits_by_threads_and_after_a_restart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

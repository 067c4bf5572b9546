/* Bonds whose laws have a history. */
#include "support.h"

#include "results/fields.h"

#include "base/random.h"

#define SOFTENING                                                                                                      \
  "model: bilinear-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa, fracture energy: 100 N/m"
#define LINEAR "model: elastic-1d, density: 2.4, Young modulus: 30 GPa"

static breccia_model *bodies(const char *one, const char *other, const char *peridynamics)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {a: {%s}, b: {%s}}\n"
      "peridynamics: {formulation: bond-based%s}\nbody:\n"
      "  left: {material: a, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.11, 0.07, 0.05]}}}\n"
      "  right: {material: b, spacing: 0.005, shape: {box: {from: [0.11, 0, 0], to: [0.14, 0.07, 0.05]}}}\n"
      "cracks: [{cut: {line: [[0.055, -1], [0.055, 0.02]]}}]\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
      one, other, peridynamics);
}

static void shake(breccia_model *model, double amplitude)
{
  const Particles *p = model->domain.particles;
  uint64_t seed = 11;
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) p->displacement.row[k][p->place_of[n]] = amplitude * (random_uniform(&seed) - 0.5);
}

static double largest_difference(const breccia_model *a, const breccia_model *b, double *largest)
{
  double off = 0;
  *largest = 0;
  for (int64_t i = 0; i < a->domain.particles->places; ++i)
    for (int k = 0; k < 3; ++k) {
      off = larger_of(off, fabs(a->domain.particles->internal.row[k][i] - b->domain.particles->internal.row[k][i]));
      *largest = larger_of(*largest, fabs(a->domain.particles->internal.row[k][i]));
    }
  return off;
}

/** Below the strength a softening law is a linear one, between two lattices and two materials too, where bonds may
 *  break: otherwise linear bonds between two materials are in series. */
static void points_below_their_strength_pull_like_springs(void **state)
{
  (void)state;
  const char *const settings[] = {"}\nfailure: {critical stretch: 1",
                                  ", influence: conical, volume correction: partial, calibration: continuum}\n"
                                  "failure: {critical stretch: 1"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *springs = bodies(LINEAR, "model: elastic-1d, density: 2.4, Young modulus: 10 GPa", settings[k]);
    breccia_model *points = bodies(SOFTENING, "model: elastic-1d, density: 2.4, Young modulus: 10 GPa", settings[k]);
    double largest, off;
    shake(springs, 1e-7);
    shake(points, 1e-7);
    compute_forces(springs);
    compute_forces(points);
    off = largest_difference(springs, points, &largest);
    assert_near(off, 0, 1e-13 * largest);
    assert_true(largest > 0);
    breccia_model_destroy(&springs);
    breccia_model_destroy(&points);
  }
}

static void damaged_bonds_balance_and_both_ends_remember_alike(void **state)
{
  (void)state;
  breccia_model *model =
      bodies(SOFTENING,
             "model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 2 "
             "MPa, fracture energy: 80 N/m",
             "");
  Domain *d = &model->domain;
  for (int step = 1; step <= 3; ++step) {
    shake(model, step * 6e-6);
    compute_forces(model);
    points_commit(&d->regions[0].points);
    double total[3] = {0}, size = 0;
    for (int64_t i = 0; i < d->particles->places; ++i)
      for (int k = 0; k < 3; ++k) {
        double force = d->particles->internal.row[k][i] * d->particles->volume[i];
        total[k] += force;
        size += fabs(force);
      }
    for (int k = 0; k < 3; ++k) assert_near(total[k], 0, 1e-13 * size);
  }
  int damaged = 0, mixed = 0;
  const Family *f = &d->family;
  for (int64_t slice = 0; slice < d->particles->slices; ++slice)
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        Bond bond = family_bond(f, slice, slot, lane);
        int64_t back = f->first[bond.neighbour / SLICE];
        while (!(f->intact[back] >> bond.neighbour % SLICE & 1) ||
               family_bond(f, bond.neighbour / SLICE, back, bond.neighbour % SLICE).neighbour != slice * SLICE + lane)
          ++back;
        double there[3], here[3];
        domain_bond_force(d, slice, slot, lane, here);
        domain_bond_force(d, bond.neighbour / SLICE, back, bond.neighbour % SLICE, there);
        for (int k = 0; k < 3; ++k) assert_near(here[k], -there[k], 1e-15 * fabs(here[k]));
        int64_t rows[2], back_rows[2];
        bond_list_rows(&d->regions[0].bonds, f, slice, slot, lane, rows);
        bond_list_rows(&d->regions[0].bonds, f, bond.neighbour / SLICE, back, bond.neighbour % SLICE, back_rows);
        assert_true(rows[0] == back_rows[1] && rows[1] == back_rows[0]);
        const Points *points = &d->regions[0].points; /* the first is of the place's own material */
        assert_ptr_equal(points_material(points, rows[0]), &points->materials[d->material[slice]]);
        assert_ptr_equal(points_material(points, rows[1]), &points->materials[d->material[bond.neighbour / SLICE]]);
        damaged += points_try(&d->regions[0].points, rows[0], 1e-6, 0, NULL) < 0.999 * 30e6 * 1e-6;
        mixed += d->material[slice] != d->material[bond.neighbour / SLICE];
      }
  assert_true(damaged > 1000 && mixed > 1000);
  uint8_t *present = calloc((size_t)d->regions[0].bonds.count, 1);
  int64_t rows = 0;
  bond_list_mark(&d->regions[0].bonds, f, present);
  for (int64_t n = 0; n < d->regions[0].bonds.count; ++n) rows += present[n];
  assert_int_equal(rows, f->bonds / 2 + mixed / 2); /* each bond once, and once more for its other material */
  free(present);
  breccia_model_destroy(&model);
}

/** Two halves of a lattice are pulled apart: the work per area is G_F times the lattice's quadrature of the integral over bonds that
 *  cross a plane (docs/theory.md 2), whatever the law. */
static void parting_a_body_spends_its_fracture_energy(void **state)
{
  (void)state;
  const char *const laws[] = {SOFTENING,
                              "model: exponential-softening, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 "
                              "MPa, fracture energy: 100 N/m"};
  const struct {
    const char *words, *shape;
    double quadrature;
  } spaces[] = {{"space: 3-D", "shape: {box: {particles: [6, 8, 8]}}", 0.911},
                {"space: plane stress", "lattice: square, thickness: 0.1, shape: {box: {particles: [6, 20]}}", 0.853}};
  for (int law = 0; law < 2; ++law)
    for (int s = 0; s < 2; ++s) {
      if (under_sanitizers() && law == s) continue;
      breccia_model *model = model_of(
          "units: {length: m, force: kN, time: s}\nmaterials: {a: {%s}}\nperidynamics: {formulation: bond-based, "
          "calibration: continuum, horizon: 0.00314159265358979, %s}\nbody: {b: {material: a, spacing: 0.001, "
          "%s}}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
          laws[law], spaces[s].words, spaces[s].shape);
      Domain *d = &model->domain;
      const Particles *p = d->particles;
      double work = 0, before = 0, opening = 0;
      /* only rows along x that have all their neighbours beside them count */
      const int margin = 3, across = s ? 20 : 8;
      const double area = s ? (across - 2 * margin) * 0.001 * 0.1 : pow((across - 2 * margin) * 0.001, 2);
      const double far = 12 * d->failure.limit[0] * 0.001; /* bonds that lean open last */
      for (int step = 1; step <= 600; ++step) {
        double next = far * pow(step / 600., 3), force = 0;
        for (int32_t n = 0; n < p->count; ++n)
          p->displacement.row[0][p->place_of[n]] = p->position[0][p->place_of[n]] > 0.003 ? next : 0;
        compute_forces(model);
        points_commit(&d->regions[0].points);
        for (int32_t n = 0; n < p->count; ++n) {
          int32_t i = p->place_of[n];
          bool inside =
              p->position[0][i] < 0.003 && fabs(p->position[1][i] - across * 0.0005) < (across / 2 - margin) * 0.001;
          if (!s) inside &= fabs(p->position[2][i] - across * 0.0005) < (across / 2 - margin) * 0.001;
          if (inside) force += p->internal.row[0][i] * p->volume[i];
        }
        work += (before + force) / 2 * (next - opening);
        before = force;
        opening = next;
      }
      assert_near(before, 0, 1e-9);
      assert_near(work / area / 0.1, spaces[s].quadrature, 2e-3);
      breccia_model_destroy(&model);
    }
}

static breccia_model *bar(int threads)
{
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {%s}, s: {model: elastic-brittle, density: 2.4, Young "
      "modulus: 60 GPa, fracture energy: 500 N/m}}\nperidynamics: {formulation: bond-based}\nbody:\n"
      "  b: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.2, 0.05, 0.05]}}}\n"
      "  s: {material: s, spacing: 0.01, shape: {box: {from: [0.2, 0, 0], to: [0.3, 0.05, 0.05]}}}\n"
      "loads:\n"
      "  - {on: {face: x-, layers: 3}, velocity: [0, 0, 0]}\n"
      "  - {on: {face: x+, layers: 3}, velocity: [2, 0, 0], history: {ramp to: 5e-5}}\n"
      "solve: {explicit: {steps: 700}}\n",
      SOFTENING);
  model->threads = threads;
  return model;
}

static void a_pulled_bar_softens_alike_for_any_number_of_threads_and_keeps_its_energy(void **state)
{
  (void)state;
  double *reference = NULL;
  for (int threads = under_sanitizers() ? 3 : 1; threads <= 3; threads += whole_walks() ? 1 : 2) {
    breccia_model *model = bar(threads);
    breccia_error *error = breccia_error_create();
    breccia_model_step(model, 700, error);
    assert_string_equal(breccia_error_text(error), "");
    breccia_error_destroy(&error);
    const Particles *p = model->domain.particles;
    double damage = 0;
    for (int32_t n = 0; n < p->count; ++n)
      if (!model->domain.material[p->place_of[n] / SLICE])
        damage = larger_of(damage, domain_history(&model->domain, p->place_of[n], 0));
    assert_true(damage > 0.05 && damage <= 1);
    assert_true(breccia_model_broken_bonds(model) > 10);
    double gone = 0; /* laws break bonds of decks without a section on failure, too */
    for (int32_t n = 0; n < p->count; ++n) gone = larger_of(gone, domain_damage(&model->domain, p->place_of[n]));
    assert_true(gone > 0);
    assert_true(solver_energy(&model->solver).imbalance < 0.01);
    size_t bytes = sizeof(double) * (size_t)p->places;
    if (!reference) reference = memcpy(malloc(bytes), p->displacement.row[0], bytes);
    assert_memory_equal(reference, p->displacement.row[0], bytes);
    breccia_model_destroy(&model);
  }
  free(reference);
}

/** Bonds that break before their law is damaged leave a damage that is the share of those that are gone, in laws of one strain with and without points of
 *  their own and in space. */
static void a_broken_bond_counts_as_wholly_damaged(void **state)
{
  (void)state;
  static const char *const cases[][3] = {
      {SOFTENING, "bond-based", "bond damage"},
      {"model: elastic-brittle, density: 2.4, Young modulus: 30 GPa, tensile strength: 3 MPa", "bond-based",
       "bond damage"},
      {"model: mazars, density: 2.4, Young modulus: 30 GPa, Poisson ratio: 0.2, tensile strength: 3 MPa, fracture "
       "energy: 100 N/m",
       "hybrid", "material damage"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *model = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {%s}}\n"
        "peridynamics: {formulation: %s, space: plane stress}\nfailure: {critical stretch: 6e-5}\n"
        "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.1, shape: {box: {particles: [16, 6]}}}}\n"
        "loads:\n  - {on: {face: x-, layers: 3}, velocity: [-0.3, 0]}\n"
        "  - {on: {face: x+, layers: 3}, velocity: [0.3, 0]}\n"
        "solve: {explicit: {steps: 40}}\n",
        cases[c][0], cases[c][1]);
    const Domain *d = &model->domain;
    const int k = history_field_index(&d->materials[0], cases[c][2]);
    double most = 0;
    assert_true(k >= 0);
    breccia_model_step(model, 40, NULL);
    for (int32_t n = 0; n < d->particles->count; ++n) {
      const int32_t place = d->particles->place_of[n];
      assert_near(domain_history(d, place, k), domain_damage(d, place), 1e-14);
      most = larger_of(most, domain_damage(d, place));
    }
    assert_true(most > 0.2);
    breccia_model_destroy(&model);
  }
}

static void each_material_has_its_own_limit_and_a_joint_the_smaller_one(void **state)
{
  (void)state;
  breccia_model *model =
      bodies("model: elastic-brittle, density: 1, Young modulus: 30 GPa, tensile strength: 3 MPa",
             "model: elastic-brittle, density: 1, Young modulus: 10 GPa, tensile strength: 2 MPa", "");
  const Failure *failure = &model->domain.failure;
  assert_int_equal(model->domain.regions[0].points.components, 0);
  assert_near(failure->limit[0], 1e-4, 1e-18);
  assert_near(failure->limit[1], 2e-4, 1e-18);
  const Particles *p = model->domain.particles;
  int32_t left = particles_nearest(p, (const double[]){0.105, 0.035, 0.025});
  int32_t right = particles_nearest(p, (const double[]){0.1125, 0.0325, 0.0225});
  assert_near(failure_limit(failure, left, right), 1e-4, 1e-18);
  assert_near(failure_limit(failure, right, left), 1e-4, 1e-18);
  assert_near(failure_limit(failure, right, right), 2e-4, 1e-18);
  breccia_model_destroy(&model);
}

static void the_smaller_of_the_limits_of_deck_and_law_holds(void **state)
{
  (void)state;
  breccia_model *model = bodies("model: elastic-brittle, density: 1, Young modulus: 30 GPa, tensile strength: 3 MPa",
                                "model: elastic-brittle, density: 1, Young modulus: 10 GPa, tensile strength: 2 MPa",
                                "}\nfailure: {critical stretch: 1.5e-4");
  const Failure *failure = &model->domain.failure;
  assert_near(failure->limit[0], 1e-4, 1e-18);
  assert_near(failure->limit[1], 1.5e-4, 1e-18);
  breccia_model_destroy(&model);
}

/** A body of 12 x 8, or x 4 in space too, as one block or as two that stand side by side on one lattice. */
static breccia_model *parted(bool two, int dimensions, const char *law, const char *keys)
{
  const char *const plane[] = {
      "b: {material: m, lattice: square, thickness: 0.2, spacing: 0.1, shape: {box: {from: [0, 0], "
      "to: [1.2, 0.8]}}}",
      "b: {material: m, lattice: square, thickness: 0.2, spacing: 0.1, shape: {box: {from: [0, 0], "
      "to: [0.5, 0.8]}}}, c: {material: m, lattice: square, thickness: 0.2, spacing: 0.1, shape: "
      "{box: {from: [0.5, 0], to: [1.2, 0.8]}}}"};
  const char *const space[] = {
      "b: {material: m, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [1.2, 0.8, 0.4]}}}",
      "b: {material: m, spacing: 0.1, shape: {box: {from: [0, 0, 0], to: [0.5, 0.8, 0.4]}}}, c: {material: m, "
      "spacing: 0.1, shape: {box: {from: [0.5, 0, 0], to: [1.2, 0.8, 0.4]}}}"};
  return model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {%s, density: 1}}\n"
                  "peridynamics: {formulation: bond-based, space: %s%s}\nbody: {%s}\n"
                  "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                  law, dimensions == 2 ? "plane stress" : "3-D", keys, (dimensions == 2 ? plane : space)[two]);
}

static void a_body_in_two_blocks_is_as_one(void **state)
{
  (void)state;
  const char
      *const laws[] = {"model: elastic-1d, Young modulus: 30 GPa",
                       "model: bilinear-softening, Young modulus: 30 GPa, tensile strength: 300 MPa, fracture energy: "
                       "10 MN/m"},
             *const keys[] = {"", ", surface correction: energy", ", influence: conical, volume correction: partial"};
  for (int c = 0; c < 12; ++c) {
    breccia_model *model[2];
    const int dimensions = 2 + c / 6;
    for (int n = 0; n < 2; ++n) {
      model[n] = parted(n == 1, dimensions, laws[c % 2], keys[c / 2 % 3]);
      const Particles *p = model[n]->domain.particles;
      for (int64_t i = 0; i < p->places; ++i)
        for (int k = 0; k < dimensions; ++k)
          p->displacement.row[k][i] =
              1e-4 * sin(13 * p->position[0][i] + 17 * p->position[1][i] + 7 * p->position[2][i] + k);
      compute_forces(model[n]);
    }
    const Particles *p = model[0]->domain.particles, *q = model[1]->domain.particles;
    assert_int_equal(p->count, q->count);
    double largest = 0;
    for (int64_t i = 0; i < p->places; ++i) largest = larger_of(largest, fabs(p->internal.row[0][i]));
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      const double at[3] = {p->position[0][i], p->position[1][i], p->position[2][i]};
      const int32_t j = particles_nearest(q, at);
      for (int k = 0; k < dimensions; ++k)
        if (!(fabs(p->internal.row[k][i] - q->internal.row[k][j]) <= 1e-6 * largest))
          fail_msg("%s%s: force %g in one block, %g in two at [%g, %g, %g]", laws[c % 2], keys[c / 2 % 3],
                   p->internal.row[k][i], q->internal.row[k][j], at[0], at[1], at[2]);
    }
    for (int n = 0; n < 2; ++n) breccia_model_destroy(&model[n]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_below_their_strength_pull_like_springs),
      cmocka_unit_test(damaged_bonds_balance_and_both_ends_remember_alike),
      cmocka_unit_test(parting_a_body_spends_its_fracture_energy),
      cmocka_unit_test(a_pulled_bar_softens_alike_for_any_number_of_threads_and_keeps_its_energy),
      cmocka_unit_test(a_broken_bond_counts_as_wholly_damaged),
      cmocka_unit_test(each_material_has_its_own_limit_and_a_joint_the_smaller_one),
      cmocka_unit_test(the_smaller_of_the_limits_of_deck_and_law_holds),
      cmocka_unit_test(a_body_in_two_blocks_is_as_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Particles that no bond joins keep each other off. */
#include "support.h"

/** Two blocks that fly at each other with 15 m/s each, a little beside each other. */
static breccia_model *blocks(const char *formulation, const char *law, const char *contact)
{
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: {formulation: "
      "%s}\nbody:\n"
      "  left: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.08, 0.06, 0.05]}}}\n"
      "  right: {material: m, spacing: 0.01, shape: {box: {from: [0.115, 0.013, 0.004], to: [0.175, 0.063, 0.054]}}}\n"
      "%ssolve: {explicit: {steps: 1000000}}\n",
      law, formulation, contact);
  const Particles *p = model->domain.particles;
  for (int32_t n = 0; n < p->count; ++n) p->velocity[0][p->place_of[n]] = p->block[p->place_of[n] / SLICE] ? -15 : 15;
  return model;
}

typedef struct Motion {
  double momentum[3], spin[3], size, gap;
} Motion;

static Motion motion_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  Motion m = {.gap = INFINITY};
  double left = -INFINITY, right = INFINITY;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x[3], v[3], mass = p->density[i] * p->volume[i];
    for (int k = 0; k < 3; ++k) {
      x[k] = p->position[k][i] + p->displacement[k][i];
      v[k] = mass * p->velocity[k][i];
      m.momentum[k] += v[k];
      m.size += fabs(v[k]);
    }
    for (int k = 0; k < 3; ++k) m.spin[k] += x[(k + 1) % 3] * v[(k + 2) % 3] - x[(k + 2) % 3] * v[(k + 1) % 3];
    if (p->block[i / SLICE])
      right = fmin(right, x[0]);
    else
      left = fmax(left, x[0]);
  }
  m.gap = right - left;
  return m;
}

#define FIBRE "model: elastic-1d, Young modulus: 3 GPa"
#define SOLID "model: elastic, Young modulus: 3 GPa, Poisson ratio: 0.2"

static void two_bodies_that_meet_bounce_and_keep_their_momentum(void **state)
{
  (void)state;
  const char *const kinds[][2] = {{"bond-based", FIBRE}, {"correspondence", SOLID}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model = blocks(kinds[k][0], kinds[k][1], "contact: {}\n");
    Motion before = motion_of(model);
    double nearest = INFINITY, impulse = before.size;
    while (breccia_model_time(model) < 3.6e-3) {
      breccia_error *error = breccia_error_create();
      breccia_model_step(model, 10, error);
      assert_string_equal(breccia_error_text(error), "");
      breccia_error_destroy(&error);
      nearest = fmin(nearest, motion_of(model).gap);
      const Particles *p = model->domain.particles;
      for (int64_t i = 0; i < p->places; ++i)
        impulse += 10 * breccia_model_time_step(model) * fabs(p->internal[0][i]) * p->volume[i];
    }
    Motion after = motion_of(model);
    assert_true(nearest > 0.004 && nearest < 0.0135); /* they touched and did not pass through each other */
    assert_true(after.gap > 0.02);                    /* and flew apart */
    for (int c = 0; c < 3; ++c) {
      assert_near(after.momentum[c], before.momentum[c], 1e-12 * impulse);
      assert_near(after.spin[c], before.spin[c], 1e-12 * impulse);
    }
    Energy e = explicit_energy(&model->solver);
    assert_true(e.imbalance < 0.01);
    assert_true(e.kinetic < 0.999 * model->solver.kinetic_at_start); /* some of it rings on */
    breccia_model_destroy(&model);
  }
}

static void without_contact_they_pass_through_each_other(void **state)
{
  (void)state;
  breccia_model *model = blocks("bond-based", FIBRE, "");
  while (breccia_model_time(model) < 2.4e-3) breccia_model_step(model, 10, NULL);
  assert_true(motion_of(model).gap < 0);
  breccia_model_destroy(&model);
}

static void particles_at_rest_and_bonds_feel_no_contact(void **state)
{
  (void)state;
  /* At rest nothing repels, across a cut either; and in a sound body contact changes no bit, however it is squeezed. */
  for (int cut = 0; cut < 2; ++cut) {
    breccia_model *model[2];
    for (int on = 0; on < 2; ++on)
      model[on] = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\n"
                           "peridynamics: {formulation: bond-based}\n"
                           "body: {b: {material: m, spacing: 0.01, shape: {box: {particles: [12, 9, 8]}}}}\n%s%s"
                           "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                           FIBRE, cut ? "cracks: [{cut: {line: [[0.06, -1], [0.06, 0.05]]}}]\n" : "",
                           on ? "contact: {stiffness: 20}\n" : "");
    const double squeeze[9] = {cut ? 1 : 0.6, 0, 0, 0, 0.7, 0, 0, 0, 0.8};
    for (int on = 0; on < 2; ++on) {
      compute_forces(model[on]);
      const Particles *p = model[on]->domain.particles;
      for (int64_t i = 0; cut && i < p->places; ++i) assert_true(p->internal[0][i] == 0);
      if (!cut) deform_uniformly(model[on], squeeze);
      compute_forces(model[on]);
    }
    const Particles *p = model[0]->domain.particles, *q = model[1]->domain.particles;
    for (int k = 0; k < 3; ++k) assert_memory_equal(p->internal[k], q->internal[k], sizeof(double) * (size_t)p->places);
    breccia_model_destroy(&model[0]);
    breccia_model_destroy(&model[1]);
  }
}

/** A pair squeezed to half its distance: 15 c / delta (d_c - |Y|) V. */
static void a_pair_repels_as_it_should_once_its_bond_is_gone(void **state)
{
  (void)state;
  breccia_model *model = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1, %s}}\n"
                                  "peridynamics: {formulation: bond-based, horizon: 0.03}\ncontact: {}\n"
                                  "body: {b: {material: m, spacing: 0.01, shape: {box: {particles: [3, 3, 3]}}}}\n"
                                  "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                                  FIBRE);
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  const int32_t a = p->place_of[13], b = p->place_of[14];
  assert_true(family_break(&d->family, a, b));
  d->type->renew(d->formulation, a / SLICE);
  d->type->renew(d->formulation, b / SLICE);
  p->displacement[0][b] = -0.004;
  compute_forces(model);
  const double without = p->internal[0][a];
  contact_bond_broke(&d->contact, a, b);
  compute_forces(model);
  const double c = 12 * 3e6 / (acos(-1) * pow(0.03, 4));
  assert_near(p->internal[0][a] - without, -15 * c / 0.03 * (0.009 - 0.006) * 1e-6,
              1e-9 * 15 * c / 0.03 * 0.003 * 1e-6);
  contact_search(&d->contact); /* found again, it is the same */
  const double before = p->internal[0][a];
  compute_forces(model);
  assert_true(p->internal[0][a] == before);
  breccia_model_destroy(&model);
}

static void threads_do_not_change_a_bit(void **state)
{
  (void)state;
  double *reference = NULL;
  for (int threads = 1; threads <= 3; ++threads) {
    breccia_model *model =
        blocks("bond-based", "model: elastic-brittle, Young modulus: 3 GPa, tensile strength: 3 MPa", "contact: {}\n");
    model->threads = threads;
    while (breccia_model_time(model) < 1.6e-3) breccia_model_step(model, 10, NULL);
    assert_true(breccia_model_broken_bonds(model) > 0);
    const size_t bytes = sizeof(double) * (size_t)breccia_model_places(model);
    if (!reference) reference = memcpy(malloc(bytes), breccia_model_array(model, "displacement x"), bytes);
    assert_memory_equal(reference, breccia_model_array(model, "displacement x"), bytes);
    breccia_model_destroy(&model);
  }
  free(reference);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_bodies_that_meet_bounce_and_keep_their_momentum),
      cmocka_unit_test(without_contact_they_pass_through_each_other),
      cmocka_unit_test(particles_at_rest_and_bonds_feel_no_contact),
      cmocka_unit_test(a_pair_repels_as_it_should_once_its_bond_is_gone),
      cmocka_unit_test(threads_do_not_change_a_bit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

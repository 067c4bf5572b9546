/* Particles that no bond joins keep each other off. */
#include "support.h"

#include "contact/contact.h"

static Contact *contact_of(const Domain *d)
{
  return d->forces.own[FORCES_contact];
}

/** Two blocks that fly at each other with 15 m/s each, a little beside each other. They meet within a step or two, all particles of
 *  a face at once: of that a step of 0.8 of the stable one makes an error of up to 2 % of the energy, of either sign. */
static breccia_model *blocks_at(double safety, const char *formulation, const char *law, const char *contact)
{
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: {formulation: "
      "%s}\nbody:\n"
      "  left: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.08, 0.06, 0.05]}}}\n"
      "  right: {material: m, spacing: 0.01, shape: {box: {from: [0.115, 0.013, 0.004], to: [0.175, 0.063, 0.054]}}}\n"
      "%ssolve: {explicit: {steps: 1000000, safety: %g}}\n",
      law, formulation, contact, safety);
  const Particles *p = model->domain.particles;
  for (int32_t n = 0; n < p->count; ++n)
    p->velocity.row[0][p->place_of[n]] = p->block[p->place_of[n] / SLICE] ? -15 : 15;
  return model;
}

static breccia_model *blocks(const char *formulation, const char *law, const char *contact)
{
  return blocks_at(0.5, formulation, law, contact);
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
      x[k] = p->position[k][i] + p->displacement.row[k][i];
      v[k] = mass * p->velocity.row[k][i];
      m.momentum[k] += v[k];
      m.size += fabs(v[k]);
    }
    for (int k = 0; k < 3; ++k) m.spin[k] += x[(k + 1) % 3] * v[(k + 2) % 3] - x[(k + 2) % 3] * v[(k + 1) % 3];
    if (p->block[i / SLICE])
      right = fmin(right, x[0]);
    else
      left = larger_of(left, x[0]);
  }
  m.gap = right - left;
  return m;
}

#define FIBRE "model: elastic-1d, Young modulus: 3 GPa"
#define SOLID "model: elastic, Young modulus: 3 GPa, Poisson ratio: 0.2"

static void two_bodies_that_meet_bounce_and_keep_their_momentum(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* bodies that crumble walk the same code */
  const char *const kinds[][2] = {{"bond-based", FIBRE}, {"correspondence", SOLID}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model = blocks(kinds[k][0], kinds[k][1], "contact: {}\n");
    Motion before = motion_of(model);
    double nearest = INFINITY, impulse = before.size;
    while (breccia_model_time(model) < 3.6e-3) {
      step_surely(model, 10);
      nearest = fmin(nearest, motion_of(model).gap);
      const Particles *p = model->domain.particles;
      for (int64_t i = 0; i < p->places; ++i)
        impulse += 10 * breccia_model_time_step(model) * fabs(p->internal.row[0][i]) * p->volume[i];
    }
    Motion after = motion_of(model);
    assert_true(nearest > 0.004 && nearest < 0.0135); /* they touched and did not pass through each other */
    assert_true(after.gap > 0.02);                    /* and flew apart */
    for (int c = 0; c < 3; ++c) {
      assert_near(after.momentum[c], before.momentum[c], 1e-12 * impulse);
      assert_near(after.spin[c], before.spin[c], 1e-12 * impulse);
    }
    Energy e = solver_energy(&model->solver);
    assert_true(e.imbalance < 0.01);
    assert_true(e.kinetic < 0.9999 * model->solver.ledger.kinetic_at_start); /* some of it rings on */
    breccia_model_destroy(&model);
  }
}

/** Two blocks that fly at each other along a diagonal, both of them; of two models one looks for pairs before every step, the other when it holds that to be
 *  due. They move alike: no pair that presses was found late. */
static void pairs_are_found_before_they_press(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* bodies that crumble walk the same code */
  breccia_model *models[2];
  for (int always = 0; always < 2; ++always) {
    models[always] = blocks("bond-based", FIBRE, "contact: {}\n");
    const Particles *p = models[always]->domain.particles;
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n], sign = p->block[i / SLICE] ? -1 : 1;
      for (int k = 0; k < 3; ++k) p->velocity.row[k][i] = sign * (k ? 15 : 18);
    }
  }
  const Particles *p = models[0]->domain.particles, *q = models[1]->domain.particles;
  double apart = 0;
  while (breccia_model_time(models[0]) < 1.4e-3) {
    contact_search(contact_of(&models[1]->domain));
    for (int always = 0; always < 2; ++always) step_surely(models[always], 1);
    for (int64_t i = 0; i < p->places; ++i)
      for (int k = 0; k < 3; ++k) apart = larger_of(apart, fabs(p->displacement.row[k][i] - q->displacement.row[k][i]));
  }
  assert_true(solver_energy(&models[0]->solver).kinetic < 0.99 * models[0]->solver.ledger.kinetic_at_start);
  print_message("pairs found when due: %.3g m apart from those found at every step\n", apart);
  assert_true(apart < 1e-12);
  for (int always = 0; always < 2; ++always) breccia_model_destroy(&models[always]);
}

static void without_contact_they_pass_through_each_other(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* nothing of contact */
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
                           on ? "contact: {stiffness: 20, friction: 0.5}\n" : "");
    const double squeeze[9] = {cut ? 1 : 0.6, 0, 0, 0, 0.7, 0, 0, 0, 0.8};
    for (int on = 0; on < 2; ++on) {
      compute_forces(model[on]);
      const Particles *p = model[on]->domain.particles;
      for (int64_t i = 0; cut && i < p->places; ++i) assert_true(p->internal.row[0][i] == 0);
      if (!cut) deform_uniformly(model[on], squeeze);
      compute_forces(model[on]);
    }
    const Particles *p = model[0]->domain.particles, *q = model[1]->domain.particles;
    for (int k = 0; k < 3; ++k)
      assert_memory_equal(p->internal.row[k], q->internal.row[k], sizeof(double) * (size_t)p->places);
    breccia_model_destroy(&model[0]);
    breccia_model_destroy(&model[1]);
  }
}

/** A pair of a body of 3 x 3 x 3 whose bond is gone, squeezed by 40 %: it carries what the bond would. */
static void a_pair_resists_as_its_bond_did_unless_that_broke_when_pressed(void **state)
{
  (void)state;
  for (int pressed = 0; pressed < 2; ++pressed) {
    breccia_model *model = model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1, %s}}\n"
                                    "peridynamics: {formulation: bond-based, horizon: 0.0175}\ncontact: {}\n"
                                    "body: {b: {material: m, spacing: 0.01, shape: {box: {particles: [3, 3, 3]}}}}\n"
                                    "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                                    FIBRE);
    Domain *d = &model->domain;
    const Particles *p = d->particles;
    const int32_t a = p->place_of[13], b = p->place_of[14];
    contact_bond_mended(contact_of(d), a, b); /* without a row, as where memory was out when it broke */
    assert_true(family_break(&d->family, a, b));
    d->regions[0].type->renew(d->regions[0].formulation, a / SLICE);
    d->regions[0].type->renew(d->regions[0].formulation, b / SLICE);
    p->displacement.row[0][b] = -0.004;
    compute_forces(model);
    const double without = p->internal.row[0][a];
    if (!pressed) p->displacement.row[0][b] = 0;
    contact_bond_broke(contact_of(d), a, b);
    p->displacement.row[0][b] = pressed ? -0.0041 : -0.004;
    compute_forces(model);
    /* Bonds calibrated in uniform expansion: sum c L V / 2 = 6 E, here over 26 neighbours, of which a column with free sides shows 5/6. */
    const double moment = (6 + 12 * sqrt(2) + 8 * sqrt(3)) * 0.01 * 1e-6, c = 5.0 / 6 * 6 * 3e6 / (moment / 2);
    if (!pressed) assert_near(p->internal.row[0][a] - without, -c * 0.4 * 1e-6, 1e-9 * c * 1e-6);
    const double before = p->internal.row[0][a];
    contact_search(contact_of(d)); /* found again, it is the same */
    compute_forces(model);
    assert_true(p->internal.row[0][a] == before);
    if (pressed) {
      p->displacement.row[0][b] = -0.004;
      compute_forces(model);
      assert_near(p->internal.row[0][a], without, 1e-9 * c * 1e-6); /* nothing happens where it broke */
      contact_bond_mended(contact_of(d), a, b);
      p->displacement.row[0][b] = -0.006;
      compute_forces(model);
      const double mended = p->internal.row[0][a];
      contact_bond_broke(contact_of(d), a, b);
      p->displacement.row[0][b] = -0.007;
      compute_forces(model);
      assert_true(p->internal.row[0][a] < mended - c * 0.05 * 1e-6);
    }
    breccia_model_destroy(&model);
  }
}

static void a_pair_of_two_materials_resists_as_the_mean_of_both(void **state)
{
  (void)state;
  /* The same between blocks of 3 and 9 GPa, whichever of them stands first. */
  for (int turned = 0; turned < 2; ++turned) {
    breccia_model *model =
        model_of("units: {length: m, force: kN, time: s}\nmaterials:\n  soft: {density: 1, %s}\n"
                 "  stiff: {density: 1, model: elastic-1d, Young modulus: 9 GPa}\n"
                 "peridynamics: {formulation: bond-based, horizon: 0.0175}\ncontact: {}\nbody:\n"
                 "  one: {material: %s, spacing: 0.01, shape: {box: {particles: [2, 3, 3]}}}\n"
                 "  two: {material: %s, spacing: 0.01, shape: {box: {particles: [2, 3, 3], first particle: [0.025, "
                 "0.005, 0.005]}}}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
                 FIBRE, turned ? "stiff" : "soft", turned ? "soft" : "stiff");
    Domain *d = &model->domain;
    const Particles *p = d->particles;
    const int32_t a = particles_nearest(p, (const double[]){0.015, 0.015, 0.015}),
                  b = particles_nearest(p, (const double[]){0.025, 0.015, 0.015});
    assert_true(p->block[a / SLICE] != p->block[b / SLICE]);
    assert_true(family_break(&d->family, a, b));
    d->regions[0].type->renew(d->regions[0].formulation, a / SLICE);
    d->regions[0].type->renew(d->regions[0].formulation, b / SLICE);
    p->displacement.row[0][b] = -0.004;
    compute_forces(model);
    const double without = p->internal.row[0][a];
    p->displacement.row[0][b] = 0;
    contact_bond_broke(contact_of(d), a, b);
    p->displacement.row[0][b] = -0.004;
    compute_forces(model);
    const double moment = (6 + 12 * sqrt(2) + 8 * sqrt(3)) * 0.01 * 1e-6, c = 5.0 / 6 * 6 * 6e6 / (moment / 2);
    assert_near(p->internal.row[0][a] - without, -c * 0.4 * 1e-6, 1e-9 * c * 1e-6);
    breccia_model_destroy(&model);
  }
}

/** Forces of contact alone on all places [force]: those with it less those without. */
static double *contact_forces(breccia_model *model)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  double *force = malloc(3 * sizeof *force * (size_t)p->places);
  compute_forces(model);
  for (int k = 0; k < 3; ++k) memcpy(force + k * p->places, p->internal.row[k], sizeof *force * (size_t)p->places);
  const Forces forces = d->forces;
  d->forces.count = 0;
  compute_forces(model);
  d->forces = forces;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < p->places; ++i)
      force[k * p->places + i] = (force[k * p->places + i] - p->internal.row[k][i]) * p->volume[i];
  return force;
}

static void faces_that_meet_press_as_a_layer_of_both_bodies(void **state)
{
  (void)state;
  /* Blocks of 3 and 9 GPa, particle opposite particle: the pressure is 2 E E' / (E + E') times the gap over a spacing, whichever lies below; of sums over
   * lattices for integrals 2 %. */
  for (int turned = 0; turned < 2; ++turned) {
    breccia_model *model = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials:\n  soft: {density: 1, %s}\n"
        "  stiff: {density: 1, model: elastic-1d, Young modulus: 9 GPa}\n"
        "peridynamics: {formulation: bond-based, horizon: 0.0175}\nbody:\n"
        "  one: {material: %s, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.08, 0.08, 0.03]}}}\n"
        "  two: {material: %s, spacing: 0.01, shape: {box: {from: [0.02, 0.02, 0.05], to: [0.06, 0.06, 0.08]}}}\n"
        "contact: {stiffness: 0.7}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
        FIBRE, turned ? "stiff" : "soft", turned ? "soft" : "stiff");
    Domain *d = &model->domain;
    const Particles *p = d->particles;
    const double gap = 1e-6;
    compute_forces(model);
    for (int near = 0; near < 2; ++near) { /* it chooses its faces before it presses */
      for (int64_t i = 0; i < p->places; ++i)
        if (p->block[i / SLICE]) p->displacement.row[2][i] = near ? -0.02 - gap : -0.0199;
      contact_search(contact_of(d));
      compute_forces(model);
    }
    double *force = contact_forces(model), sum = 0;
    for (int64_t n = 0; n < p->count; ++n)
      if (p->block[p->place_of[n] / SLICE]) sum += force[2 * p->places + p->place_of[n]];
    const double pressure = 0.7 * 4.5e6 * gap / 0.01;
    assert_near(sum / (0.04 * 0.04), pressure, 0.02 * pressure);
    free(force);
    breccia_model_destroy(&model);
  }
}

/** Fails unless the forces of contact are the derivative of its energy, and no force or couple is left in all. */
static void check_derivative(breccia_model *model, double spacing, const char *what)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  double *force = contact_forces(model), largest = 0, sum[3] = {0}, couple[3] = {0}, worst = 0;
  int checked = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x[3], f[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = p->position[k][i] + p->displacement.row[k][i];
      sum[k] += f[k] = force[k * p->places + i];
      largest = larger_of(largest, fabs(f[k]));
    }
    for (int k = 0; k < 3; ++k) couple[k] += x[(k + 1) % 3] * f[(k + 2) % 3] - x[(k + 2) % 3] * f[(k + 1) % 3];
  }
  assert_true(largest > 0);
  for (int k = 0; k < 3; ++k) {
    assert_near_at(sum[k], 0, 1e-11 * largest, what, __FILE__, __LINE__);
    assert_near_at(couple[k], 0, 1e-10 * largest * spacing, what, __FILE__, __LINE__);
  }
  for (int64_t n = 0; n < p->count; n += under_sanitizers() ? 12 : 3) {
    const int32_t i = p->place_of[n];
    for (int k = 0; k < d->body.dimensions; ++k) {
      const double h = 1e-5 * spacing, here = p->displacement.row[k][i];
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        p->displacement.row[k][i] = here + (side ? h : -h);
        energy[side] = contact_energy(contact_of(d));
      }
      p->displacement.row[k][i] = here;
      worst = larger_of(worst, fabs((energy[1] - energy[0]) / (2 * h) + force[k * p->places + i]));
      checked += fabs(force[k * p->places + i]) > 1e-3 * largest;
    }
  }
  assert_true(checked > (under_sanitizers() ? 5 : 20));
  assert_near_at(worst, 0, 2e-5 * largest, what, __FILE__, __LINE__);
  free(force);
}

/** A smooth deformation of all particles, of a few per cent of the size of the body. */
static void wave(const breccia_model *model, double size, double amplitude)
{
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double x = p->position[0][i] / size, y = p->position[1][i] / size, z = p->position[2][i] / size;
    p->displacement.row[0][i] += amplitude * size * sin(3 * y + 2 * z);
    p->displacement.row[1][i] += amplitude * size * sin(2 * x + 3 * z);
    if (model->domain.body.dimensions == 3) p->displacement.row[2][i] += amplitude * size * sin(3 * x - 2 * y);
  }
}

/** Turns everything by half a radian about an axis that is no lattice axis (in the plane about its normal). */
static void rotate(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  const double c = cos(0.5), s = sin(0.5), r = sqrt(1.0 / 3);
  const double axis[2][3] = {{0, 0, 1}, {r, r, r}}, *a = axis[model->domain.body.dimensions == 3];
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double x[3], along = 0;
    for (int k = 0; k < 3; ++k) {
      x[k] = p->position[k][i] + p->displacement.row[k][i];
      along += a[k] * x[k];
    }
    for (int k = 0; k < 3; ++k)
      p->displacement.row[k][i] = c * x[k] + s * (a[(k + 1) % 3] * x[(k + 2) % 3] - a[(k + 2) % 3] * x[(k + 1) % 3]) +
                                  (1 - c) * along * a[k] - p->position[k][i];
  }
}

static void forces_are_the_derivative_of_the_energy(void **state)
{
  (void)state;
  /* A cut body in space and in the plane, pressed, then slid too, then turned too. */
  for (int plane = 0; plane < 2; ++plane) {
    breccia_model *model =
        plane ? model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: "
                         "{formulation: bond-based, space: plane stress}\nbody: {b: {material: m, lattice: square, "
                         "thickness: 0.1, spacing: 0.01, shape: {box: {particles: [12, 10]}}}}\n"
                         "cracks: [{cut: {line: [[-1, 0.05], [1, 0.05]]}}]\ncontact: {}\n"
                         "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                         FIBRE)
              : model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: "
                         "{formulation: bond-based}\nbody: {b: {material: m, spacing: 0.01, shape: {box: {particles: "
                         "[6, 5, 8]}}}}\ncracks: [{cut: {polygon: [[-1, -1, 0.04], [1, -1, 0.04], [1, 1, 0.04], "
                         "[-1, 1, 0.04]]}}]\ncontact: {}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
                         FIBRE);
    const Particles *p = model->domain.particles;
    const int across = plane ? 1 : 2;
    const double level = plane ? 0.05 : 0.04;
    for (int64_t i = 0; i < p->places; ++i) p->displacement.row[across][i] = p->position[across][i] > level ? -4e-4 : 0;
    wave(model, 0.06, 0.01);
    check_derivative(model, 0.01, "pressed");
    for (int64_t i = 0; i < p->places; ++i) p->displacement.row[0][i] += p->position[across][i] > level ? 0.0137 : 0;
    contact_search(contact_of(&model->domain));
    check_derivative(model, 0.01, "slid");
    rotate(model);
    check_derivative(model, 0.01, "turned");
    breccia_model_destroy(&model);
  }
  /* Bodies of unlike spacing that meet at an angle, sound and with broken bonds. */
  for (int broken = 0; broken < 2; ++broken) {
    breccia_model *model = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\n"
        "peridynamics: {formulation: bond-based, horizon: 0.0202}\nbody:\n"
        "  one: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.06, 0.05, 0.03]}}}\n"
        "  two: {material: m, spacing: 0.006, shape: {box: {from: [0.011, 0.008, 0.05], to: [0.047, 0.038, 0.068]}}}\n"
        "contact: {}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
        FIBRE);
    Domain *d = &model->domain;
    const Particles *p = d->particles;
    compute_forces(model);
    for (int n = 0; n < 4 && broken; ++n) { /* of the upper face of the lower body */
      const int32_t a = p->place_of[6 * 5 * 2 + 8 + 6 * (n / 2)], b = a - 1 + 2 * (n % 2);
      assert_true(family_break(&d->family, a, b));
      contact_bond_broke(contact_of(d), a, b);
      d->regions[0].type->renew(d->regions[0].formulation, a / SLICE);
      d->regions[0].type->renew(d->regions[0].formulation, b / SLICE);
    }
    for (int64_t i = 0; i < p->places; ++i)
      if (p->block[i / SLICE]) p->displacement.row[2][i] = -0.0199;
    contact_search(contact_of(d)); /* nearly touching: it chooses its faces */
    compute_forces(model);
    wave(model, 0.06, 0.004);
    for (int64_t i = 0; i < p->places; ++i)
      if (p->block[i / SLICE]) p->displacement.row[2][i] -= 6e-4;
    if (broken) p->displacement.row[0][p->place_of[6 * 5 * 2 + 8]] += 2e-3;
    check_derivative(model, 0.01, broken ? "unlike, broken" : "unlike");
    rotate(model);
    check_derivative(model, 0.01, "unlike, turned");
    breccia_model_destroy(&model);
  }
}

static void families_of_unlike_particles_feel_contact_as_its_energy_says(void **state)
{
  (void)state;
  /* The lower body is two blocks of unlike spacing, bonded: the faces of one know where the particles of the other are. */
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\n"
      "peridynamics: {formulation: bond-based, horizon: 0.0202}\nbody:\n"
      "  one: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.03, 0.05, 0.03]}}}\n"
      "  other: {material: m, spacing: 0.006, shape: {box: {from: [0.03, 0.001, 0], to: [0.06, 0.049, 0.03]}}}\n"
      "  two: {material: m, spacing: 0.006, shape: {box: {from: [0.011, 0.008, 0.05], to: [0.047, 0.038, 0.068]}}}\n"
      "contact: {}\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n",
      FIBRE);
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  compute_forces(model);
  for (int64_t i = 0; i < p->places; ++i)
    if (p->block[i / SLICE] == 2) p->displacement.row[2][i] = -0.0199;
  contact_search(contact_of(d));
  compute_forces(model);
  wave(model, 0.06, 0.004);
  for (int64_t i = 0; i < p->places; ++i)
    if (p->block[i / SLICE] == 2) p->displacement.row[2][i] -= 6e-4;
  check_derivative(model, 0.01, "joined");
  breccia_model_destroy(&model);
}

static void bodies_that_crumble_gain_nothing(void **state)
{
  (void)state;
  const char *const kinds[][2] = {
      {"bond-based", "model: elastic-brittle, Young modulus: 3 GPa, tensile strength: 3 MPa"},
      {"correspondence", SOLID}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model = blocks_at(0.3, kinds[k][0], kinds[k][1],
                                     k ? "failure: {critical stretch: 2e-3}\ncontact: {}\n" : "contact: {}\n");
    const int64_t enough = under_sanitizers() ? 200 : INT64_MAX;
    while (breccia_model_time(model) < 2e-3 && breccia_model_broken_bonds(model) < enough) step_surely(model, 10);
    assert_true(breccia_model_broken_bonds(model) > (under_sanitizers() ? 100 : 5000));
    const Energy e = solver_energy(&model->solver);
    assert_true(e.fracture > 0);
    assert_near(e.kinetic + e.stored + e.fracture - e.between, model->solver.ledger.kinetic_at_start,
                0.015 * model->solver.ledger.kinetic_at_start);
    breccia_model_destroy(&model);
  }
}

static void bodies_of_unlike_spacing_that_meet_keep_their_momentum(void **state)
{
  (void)state;
  for (int rough = under_sanitizers(); rough < 2; ++rough) {
    breccia_model *model =
        model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}, n: {density: 7.8, model: "
                 "elastic-1d, "
                 "Young modulus: 9 GPa}}\nperidynamics: {formulation: bond-based, horizon: 0.0302}\nbody:\n"
                 "  left: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.08, 0.06, 0.05]}}}\n"
                 "  right: {material: n, spacing: 0.006, shape: {box: {from: [0.115, 0.013, 0.004], to: [0.151, 0.055, "
                 "0.046]}}}\n"
                 "contact: {friction: %g}\nsolve: {explicit: {steps: 1000000}}\n",
                 FIBRE, rough * 0.3);
    const Particles *p = model->domain.particles;
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      p->velocity.row[0][i] = p->block[i / SLICE] ? -15 : 15;
      p->velocity.row[1][i] = p->block[i / SLICE] ? 5 : 0;
    }
    const Motion before = motion_of(model);
    while (breccia_model_time(model) < (under_sanitizers() ? 1.8e-3 : 2.6e-3)) step_surely(model, 10);
    const Motion after = motion_of(model);
    if (!under_sanitizers()) assert_true(after.gap > 0.012);
    for (int c = 0; c < 3; ++c) {
      assert_near(after.momentum[c], before.momentum[c], 1e-11 * before.size);
      if (!rough) assert_near(after.spin[c], before.spin[c], 1e-11 * before.size);
    }
    Energy e = solver_energy(&model->solver);
    assert_true(rough ? e.friction > 0 : e.friction == 0);
    assert_true(e.imbalance < 0.01);
    breccia_model_destroy(&model);
  }
}

static void threads_do_not_change_a_bit(void **state)
{
  (void)state;
  double *reference = NULL;
  for (int threads = under_sanitizers() ? 3 : 1; threads <= 3; ++threads) {
    breccia_model *model = blocks("bond-based", "model: elastic-brittle, Young modulus: 3 GPa, tensile strength: 3 MPa",
                                  "contact: {friction: 0.3}\n");
    model->threads = threads;
    while (breccia_model_time(model) < (under_sanitizers() ? 1.2e-3 : 1.6e-3)) breccia_model_step(model, 10, NULL);
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
      cmocka_unit_test(pairs_are_found_before_they_press),
      cmocka_unit_test(without_contact_they_pass_through_each_other),
      cmocka_unit_test(particles_at_rest_and_bonds_feel_no_contact),
      cmocka_unit_test(a_pair_resists_as_its_bond_did_unless_that_broke_when_pressed),
      cmocka_unit_test(a_pair_of_two_materials_resists_as_the_mean_of_both),
      cmocka_unit_test(faces_that_meet_press_as_a_layer_of_both_bodies),
      cmocka_unit_test(forces_are_the_derivative_of_the_energy),
      cmocka_unit_test(bodies_that_crumble_gain_nothing),
      cmocka_unit_test(bodies_of_unlike_spacing_that_meet_keep_their_momentum),
      cmocka_unit_test(threads_do_not_change_a_bit),
      cmocka_unit_test(families_of_unlike_particles_feel_contact_as_its_energy_says),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

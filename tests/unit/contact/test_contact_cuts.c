/* Faces of a cut, and a block on a base: they carry pressure as the body did, slide, and stick by friction. */
#include "support.h"

#include "contact/contact_parts.h"

static Contact *contact_of(const Domain *d)
{
  return d->forces.own[FORCES_contact];
}

#define FIBRE "model: elastic-1d, Young modulus: 3 GPa"
#define SOLID "model: elastic, Young modulus: 3 GPa, Poisson ratio: 0.2"

#define LEVEL_CUT "cracks: [{cut: {polygon: [[-1, -1, 0.09], [1, -1, 0.09], [1, 1, 0.09], [-1, 1, 0.09]]}}]\n"

static breccia_model *column(const char *formulation, const char *law, const char *more)
{
  return model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: "
      "{formulation: %s}\nbody: {b: {material: m, spacing: 0.01, shape: {box: {particles: [6, 6, 18]}}}}\n%s"
      "loads:\n  - {on: {face: z+, layers: 3}, body force: [0, 0, -100000]}\n"
      "  - {on: {face: z-, layers: 3}, body force: [0, 0, 100000]}\n"
      "solve: {explicit: {steps: 1000000, safety: 0.5, local damping: 0.5}}\n",
      law, formulation, more);
}

/** Mean displacement along an axis of particles above (1) or below (-1) a height. */
static double mean_motion(const breccia_model *model, int axis, double height, int side)
{
  const Particles *p = model->domain.particles;
  double sum = 0;
  int count = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if ((p->position[2][i] - height) * side < 0) continue;
    sum += p->displacement.row[axis][i];
    ++count;
  }
  return sum / count;
}

/** Blocks of unlike stiffness and spacing press alike whichever of them the deck names first. */
static void the_order_of_blocks_changes_nothing(void **state)
{
  (void)state;
  static const char *const soft = "a: {material: m, lattice: square, thickness: 1, spacing: 0.01, shape: {box: {from: "
                                  "[0, 0], to: [0.12, 0.08]}}}",
                           *const stiff =
                               "b: {material: n, lattice: square, thickness: 1, spacing: 0.015, shape: {box: "
                               "{from: [0, 0.08], to: [0.12, 0.17]}}}";
  static const char *const kinds[][2] = {{"bond-based", "elastic-1d"},
                                         {"correspondence", "elastic, Poisson ratio: 0.25"}};
  for (int k = 0; k < 2; ++k) {
    double pressed[2][2], energy[2];
    for (int turned = 0; turned < 2; ++turned) {
      breccia_model *m =
          model_of("units: {length: m, force: kN, time: s}\n"
                   "materials: {m: {density: 2.4, model: %s, Young modulus: 3 GPa}, n: {density: 2.4, model: %s, Young "
                   "modulus: 20 "
                   "GPa}}\nbody: {%s, %s}\ncracks: [{cut: {line: [[-1, 0.08], [1, 0.08]]}}]\nperidynamics: "
                   "{formulation: %s, space: plane stress, horizon: 0.04}\ncontact: {}\n"
                   "solve: {explicit: {steps: 1}}\n",
                   kinds[k][1], kinds[k][1], turned ? stiff : soft, turned ? soft : stiff, kinds[k][0]);
      const Particles *p = m->domain.particles;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        if (p->position[1][i] < 0.08) continue;
        p->displacement.row[1][i] = -2e-5;
        p->displacement.row[0][i] = 1e-5 + 1e-4 * p->position[0][i];
      }
      compute_forces(m);
      double sum[2] = {0};
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        for (int c = 0; c < 2 && p->position[1][i] > 0.08; ++c) sum[c] += p->volume[i] * p->internal.row[c][i];
      }
      for (int c = 0; c < 2; ++c) pressed[turned][c] = sum[c];
      Team *before = team_use(m->team);
      energy[turned] = contact_energy(contact_of(&m->domain));
      team_use(before);
      breccia_model_destroy(&m);
    }
    assert_true(pressed[0][1] > 1 && energy[0] > 0);
    assert_near(pressed[1][1], pressed[0][1], 1e-9 * pressed[0][1]);
    assert_near(pressed[1][0], pressed[0][0], 1e-9 * pressed[0][1]);
    assert_near(energy[1], energy[0], 1e-9 * energy[0]);
  }
}

/** A particle that has lost bonds has a face where these went: from the mean of the volume that is left to the mean of that which is gone. Where as much
 *  is gone on one side as on the other it has none. */
static void particles_look_to_where_they_have_lost_bonds(void **state)
{
  (void)state;
  for (int turn = 0; turn < 6; ++turn) {
    breccia_model *m = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, " SOLID "}}\n"
        "peridynamics: {space: plane strain, horizon: 2.015 spacings}\nbody: {b: {material: m, lattice: hexagonal, "
        "spacing: 0.01, thickness: 0.1, shape: {box: {particles: [13, 13]}}}}\ncontact: {}\n"
        "solve: {explicit: {steps: 1}}\n");
    Domain *d = &m->domain;
    Particles *p = d->particles;
    Contact *c = contact_of(d);
    const int32_t i = body_nearest(&d->body, (double[3]){0.065, 0.055, 0});
    const double angle = 1.1 * turn + 0.2, towards[2] = {cos(angle), sin(angle)};
    const bool even = turn == 5; /* on both sides */
    double lost[2] = {0}, left[2] = {0}, gone = 0, whole = 0;
    int32_t others[64];
    int count = 0;
    for (int64_t n = 0; n < p->count; ++n) /* unlike volumes, so that it shows whether they count */
      if (!even) p->volume[p->place_of[n]] *= 1 + 0.5 * (double)(n % 3);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t j = p->place_of[n];
      if (j == i || !family_joins(&d->family, i, j)) continue;
      double xi[2], along = 0;
      for (int k = 0; k < 2; ++k) {
        xi[k] = p->position[k][j] - p->position[k][i];
        along += xi[k] * towards[k];
      }
      const bool goes = (even ? fabs(along) : along) > 0.004;
      for (int k = 0; k < 2; ++k) (goes ? lost : left)[k] += p->volume[j] * xi[k];
      *(goes ? &gone : &whole) += p->volume[j];
      if (goes) others[count++] = j;
    }
    for (int k = 0; k < count; ++k) {
      family_break(&d->family, i, others[k]);
      forces_bond_broke(&d->forces, i, others[k]);
    }
    assert_true(count > 4 && c->row_of[i] >= 0);
    ContactRow *row = &c->rows[c->row_of[i]];
    contact_find_faces(c, row);
    assert_int_equal(row->faces, !even);
    assert_near(row->depth, 0.005, 1e-12);
    if (!even) {
      const double way[2] = {lost[0] / gone - left[0] / whole, lost[1] / gone - left[1] / whole},
                   size = hypot(way[0], way[1]);
      for (int k = 0; k < 2; ++k) assert_near(row->face[0][k], way[k] / size, 1e-9);
      assert_near(row->face[0][2], 0, 1e-9);
    }
    breccia_model_destroy(&m);
  }
}

static void a_closed_cut_is_as_stiff_as_the_body_and_opens_freely(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* the other tests walk the same code */
  const char *const kinds[][2] = {{"bond-based", FIBRE}, {"correspondence", SOLID}};
  for (int k = 0; k < 2; ++k) {
    double shorter[2];
    for (int cut = 0; cut < 2; ++cut) {
      breccia_model *model = column(kinds[k][0], kinds[k][1], cut ? LEVEL_CUT "contact: {}\n" : "");
      step_surely(model, 700);
      shorter[cut] = mean_motion(model, 2, 0.03, -1) - mean_motion(model, 2, 0.15, 1);
      assert_true(solver_energy(&model->solver).kinetic < 1e-6 * solver_energy(&model->solver).external);
      if (cut) { /* apart, the halves know nothing of each other */
        const Particles *p = model->domain.particles;
        for (int c = 0; c < 3; ++c) memset(p->displacement.row[c], 0, sizeof(double) * (size_t)p->places);
        for (int64_t i = 0; i < p->places; ++i) p->displacement.row[2][i] = p->position[2][i] > 0.09 ? 1e-6 : 0;
        compute_forces(model);
        for (int64_t i = 0; i < p->places; ++i) assert_near(p->internal.row[2][i], 0, k ? 1e-3 : 0);
      }
      breccia_model_destroy(&model);
    }
    assert_near(shorter[1], shorter[0], 0.025 * shorter[0]);
  }
}

static void a_block_that_slides_on_a_cut_gains_nothing(void **state)
{
  (void)state;
  /* Halves pressed together by 50 kN/m3 each and pushed along the cut and a little off it, over two spacings. */
  const char *const kinds[][2] = {{"bond-based", FIBRE}, {"correspondence", SOLID}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model =
        model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, %s}}\nperidynamics: "
                 "{formulation: %s}\nbody: {b: {material: m, spacing: 0.01, shape: {box: {particles: [8, 5, 8]}}}}\n"
                 "cracks: [{cut: {polygon: [[-1, -1, 0.04], [1, -1, 0.04], [1, 1, 0.04], [-1, 1, 0.04]]}}]\n"
                 "contact: {}\nloads:\n  - {on: {inside: {box: {from: [-1, -1, 0.04], to: [1, 1, 1]}}}, body force: "
                 "[0, 0, -50000]}\n  - {on: {inside: {box: {from: [-1, -1, -1], to: [1, 1, 0.04]}}}, body force: "
                 "[0, 0, 50000]}\nsolve: {explicit: {steps: 1000000}}\n",
                 kinds[k][1], kinds[k][0]);
    const Particles *p = model->domain.particles;
    for (int64_t i = 0; i < p->places; ++i) {
      const double side = p->position[2][i] > 0.04 ? 1 : -1;
      p->velocity.row[0][i] = side * 5;
      p->velocity.row[2][i] = side * -0.5;
    }
    double most = 0;
    while (breccia_model_time(model) < (under_sanitizers() ? 1e-4 : 2e-3)) {
      step_surely(model, 20);
      const Energy e = solver_energy(&model->solver);
      const double given = model->solver.ledger.kinetic_at_start + e.external;
      assert_near(e.kinetic + e.stored, given, 0.01 * model->solver.ledger.kinetic_at_start);
      assert_true(e.imbalance < 5e-3);
      most = larger_of(most, contact_energy(contact_of(&model->domain)));
    }
    if (!under_sanitizers()) assert_true(mean_motion(model, 0, 0.04, 1) - mean_motion(model, 0, 0.04, -1) > 0.019);
    assert_true(most > (under_sanitizers() ? 0 : 1e-4) * model->solver.ledger.kinetic_at_start); /* it was pressed */
    breccia_model_destroy(&model);
  }
}

/** Force on what lies above the middle of a column. */
static void force_above(const breccia_model *model, double height, double force[3])
{
  const Particles *p = model->domain.particles;
  for (int k = 0; k < 3; ++k) force[k] = 0;
  for (int64_t i = 0; i < p->places; ++i)
    for (int k = 0; k < 3; ++k)
      if (p->position[2][i] > height) force[k] += p->internal.row[k][i] * p->volume[i];
}

static void faces_of_a_cut_slide_freely_or_with_coulombs_friction(void **state)
{
  (void)state;
  /* The upper half is pressed down by 1e-5 and pushed along x over two and a half spacings. */
  double smooth[251];
  for (int rough = 0; rough < 2; ++rough) {
    breccia_model *model =
        column("bond-based", FIBRE, rough ? LEVEL_CUT "contact: {friction: 0.3}\n" : LEVEL_CUT "contact: {}\n");
    const Particles *p = model->domain.particles;
    double least = INFINITY, first = 0;
    for (int step = 0; step <= (under_sanitizers() ? 25 : 250); ++step) {
      double force[3], all[3];
      for (int64_t i = 0; i < p->places; ++i) {
        const bool upper = p->position[2][i] > 0.09;
        p->displacement.row[0][i] = upper ? 1e-4 * step : 0;
        p->displacement.row[2][i] = upper ? -1e-5 : 0;
      }
      compute_forces(model);
      contact_commit(contact_of(&model->domain));
      contact_follow(contact_of(&model->domain), 1e-4);
      force_above(model, 0.09, force);
      force_above(model, -1, all);
      for (int k = 0; k < 3; ++k) assert_near(all[k], 0, 1e-12 * force[2]);
      assert_true(force[2] > 0);
      if (step == 0) first = force[2];
      least = fmin(least, force[2]);
      /* What is left of roughness is of the edges of so slender a column. */
      if (!rough) smooth[step] = force[0];
      if (!rough) assert_near(force[0], 0, 0.08 * force[2]);
      if (rough && step > 2) assert_near(force[0], smooth[step] - 0.3 * force[2], 0.02 * force[2]);
    }
    assert_true(least > 0.2 * first);
    breccia_model_destroy(&model);
  }
}

/** A block on a base that is held: gravity of 50 m/s2 along z, and along x as told. It is set down by a displacement, so that no
 *  bond joins it to the base. */
static breccia_model *sliding_block(double spacing, double friction, double along, double speed)
{
  breccia_model *model =
      model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, model: elastic-1d, Young "
               "modulus: 30 MPa}}\n"
               "peridynamics: {formulation: bond-based, horizon: 0.0202}\n"
               "body:\n  base: {material: m, spacing: 0.01, shape: {box: {from: [0, 0, 0], to: [0.16, 0.06, 0.02]}}}\n"
               "  block: {material: m, spacing: %g, shape: {box: {from: [0.02, 0.01, 0.12], to: [0.07, 0.05, 0.14]}}}\n"
               "loads:\n  - {on: {block: base}, displacement: [0, 0, 0]}\n"
               "  - {on: {block: block}, gravity: [%g, 0, -50]}\n"
               "contact: {friction: %g}\nsolve: {explicit: {steps: 1000000, safety: 0.7}}\n",
               spacing, along, friction);
  const Particles *p = model->domain.particles;
  for (int64_t i = 0; i < p->places; ++i) {
    if (p->block[i / SLICE] == 0 || p->number[i] < 0) continue;
    p->displacement.row[2][i] = -0.1 - 1.2e-6; /* nearly as deep as its weight presses it */
    p->velocity.row[0][i] = speed;
  }
  contact_search(contact_of(&model->domain));
  return model;
}

static void a_block_slides_as_far_as_coulomb_says_and_sticks_below_his_angle(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* faces of a cut that slide walk the same code */
  for (int fine = 0; fine < 2; ++fine) {
    const double spacing = fine ? 0.005 : 0.01, mu = 0.4, gravity = 50, speed = 1;
    /* pushed on the level: v^2 / (2 mu g) */
    breccia_model *model = sliding_block(spacing, mu, 0, speed);
    const double way = speed * speed / (2 * mu * gravity), duration = speed / (mu * gravity);
    while (breccia_model_time(model) < 1.3 * duration) step_surely(model, 10);
    const double slid = mean_motion(model, 0, 0.05, 1);
    Energy e = solver_energy(&model->solver);
    /* the rest goes into vibrations */
    assert_near(slid, way, (fine ? 0.03 : 0.04) * way);
    assert_near(e.friction, model->solver.ledger.kinetic_at_start, 0.02 * model->solver.ledger.kinetic_at_start);
    assert_true(e.imbalance < 0.01);
    const double rest = mean_motion(model, 0, 0.05, 1);
    step_surely(model, 200);
    assert_near(mean_motion(model, 0, 0.05, 1), rest, 1e-3 * way);
    breccia_model_destroy(&model);
    /* on slopes of 0.3 and 0.7: rest, and half of (0.7 - 0.4) g t^2 */
    for (int steep = 0; steep < 2 && !fine; ++steep) {
      model = sliding_block(spacing, mu, (steep ? 0.7 : 0.3) * gravity, 0);
      double half = 0;
      while (breccia_model_time(model) < 0.08) {
        step_surely(model, 10);
        if (breccia_model_time(model) < 0.04) half = mean_motion(model, 0, 0.05, 1);
      }
      const double time = breccia_model_time(model), free = 0.5 * 0.3 * gravity * time * time;
      const double moved = mean_motion(model, 0, 0.05, 1);
      if (steep) {
        assert_near(moved, free, 0.06 * free);
      } else { /* it gives a little as it is let go, and rests */
        assert_near(moved, 0, 0.06 * free);
        assert_near(moved, half, 0.01 * free);
      }
      breccia_model_destroy(&model);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_order_of_blocks_changes_nothing),
      cmocka_unit_test(particles_look_to_where_they_have_lost_bonds),
      cmocka_unit_test(a_closed_cut_is_as_stiff_as_the_body_and_opens_freely),
      cmocka_unit_test(a_block_that_slides_on_a_cut_gains_nothing),
      cmocka_unit_test(faces_of_a_cut_slide_freely_or_with_coulombs_friction),
      cmocka_unit_test(a_block_slides_as_far_as_coulomb_says_and_sticks_below_his_angle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

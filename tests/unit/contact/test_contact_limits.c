/* Contact at its limits: steps, the watch over energies, restarts, rotation, corners of other lattices. */
#include "contact/contact.h"
#include "solver/stable_step.h"
#include "support.h"

#include <unistd.h>

static Contact *contact_of(const breccia_model *model)
{
  return model->domain.forces.own[FORCES_contact];
}

#define FIBRE "elastic-1d, Young modulus: 3 GPa"
#define SOLID "elastic, Young modulus: 3 GPa, Poisson ratio: 0.2"
static const char *const kinds[][2] = {{"bond-based", FIBRE}, {"correspondence", SOLID}};

/** Two bodies some centimetres apart along the last axis, the upper one moved by a share of the spacing along the others. */
static breccia_model *two_bodies(const char *lattice, int kind, double horizon, double shift, const char *more)
{
  const bool plane = !strcmp(lattice, "square") || !strcmp(lattice, "hexagonal");
  char body[2][256];
  for (int b = 0; b < 2; ++b)
    snprintf(body[b], sizeof body[b],
             plane
                 ? "{material: m, lattice: %s, thickness: 0.1, spacing: 0.01, shape: {box: {particles: [12, 6], first "
                   "particle: [%g, %g]}}}"
                 : "{material: m, lattice: %s, spacing: 0.01, shape: {box: {particles: [7, 7, 5], first particle: "
                   "[%g, 0, %g]}}}",
             lattice, b * 0.01 * shift, b * 0.1);
  return model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, model: %s}}\n"
                  "peridynamics: {formulation: %s, space: %s, horizon: %g}\nbody:\n  a: %s\n  b: %s\n"
                  "%ssolve: {explicit: {steps: 1000000}}\n",
                  kinds[kind][1], kinds[kind][0], plane ? "plane strain" : "3-D", horizon, body[0], body[1], more);
}

/** Space between the rows of both bodies that face each other, as they stand. */
static double space_between(const breccia_model *model, int axis)
{
  const Particles *p = model->domain.particles;
  double top = -INFINITY, bottom = INFINITY;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double x = p->position[axis][i] + p->displacement.row[axis][i];
    if (p->block[i / SLICE])
      bottom = fmin(bottom, x);
    else
      top = larger_of(top, x);
  }
  return bottom - top;
}

/** @param[in] choose  pairs are found, and choose their faces, where they are then */
static void lower(breccia_model *model, int axis, double way, bool choose)
{
  const Particles *p = model->domain.particles;
  for (int64_t i = 0; i < p->places; ++i)
    if (p->block[i / SLICE]) p->displacement.row[axis][i] -= way;
  if (choose) contact_search(contact_of(model));
  for (int turn = 0; turn < 2; ++turn) {
    compute_forces(model);
    contact_commit(contact_of(model));
  }
}

static void the_stable_step_holds_when_faces_press(void **state)
{
  (void)state;
  const char *const lattices[] = {"square", "hexagonal", "cubic"};
  double most = 0;
  for (int l = 0; l < 3; ++l)
    for (int kind = 0; kind < 2; ++kind)
      for (int wide = 0; wide < 2; ++wide)
        for (int rough = 0; rough < 2; ++rough) {
          if (under_sanitizers() && (wide != (l + kind) % 2 || rough == wide)) continue;
          breccia_model *m = two_bodies(lattices[l], kind, wide ? 0.03015 : 0.02015, 0.5 * rough,
                                        rough ? "contact: {friction: 0.5}\n" : "contact: {}\n");
          const int axis = l == 2 ? 2 : 1;
          const double rest = l == 1 ? 0.00866 : 0.01;
          double told, alone, pressed;
          assert_int_equal(stable_step(&m->domain, &told, NULL), 0);
          contact_of(m)->stiffest = 0; /* from here on Lanczos' method sees what there is and no more */
          assert_int_equal(stable_step(&m->domain, &alone, NULL), 0);
          lower(m, axis, space_between(m, axis) - 1.01 * rest, true);
          lower(m, axis, 0.02 * rest, false);
          if (!(contact_energy(contact_of(m)) > 0)) fail_msg("%s, kind %d", lattices[l], kind);
          assert_int_equal(stable_step(&m->domain, &pressed, NULL), 0);
          assert_true(pressed < 0.99 * alone);
          if (told > pressed)
            fail_msg("%s, kind %d, horizon %d, friction %d: %g of it", lattices[l], kind, wide, rough, told / pressed);
          most = larger_of(most, told / pressed);
          breccia_model_destroy(&m);
        }
  print_message("the step told is at most %.2f of the stable one of pressed bodies\n", most);
  if (!under_sanitizers()) assert_true(most > 0.7); /* nor is it much too short */
}

/** Contact bounds the stable step by the lighter one of two bodies, whichever the deck names first. */
static void the_lighter_body_bounds_the_stable_step_in_any_order(void **state)
{
  (void)state;
  static const char *const blocks[] = {
      "  a: {material: light, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [0, 0], to: [0.6, "
      "0.5]}}}\n",
      "  b: {material: heavy, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {from: [0, 0.6], to: [0.6, "
      "1.1]}}}\n"};
  double step[2];
  for (int order = 0; order < 2; ++order) {
    breccia_model *m = model_of("units: {length: m, force: kN, time: s}\nmaterials:\n"
                                "  light: {model: elastic, density: 1, Young modulus: 1e4, Poisson ratio: 0.25}\n"
                                "  heavy: {model: elastic, density: 16, Young modulus: 1e4, Poisson ratio: 0.25}\n"
                                "peridynamics: {space: plane strain, horizon: 0.21}\ncontact: {}\nbody:\n%s%s"
                                "solve: {explicit: {steps: 1}}\n",
                                blocks[order], blocks[!order]);
    step[order] = m->solver.clock.stable;
    breccia_model_destroy(&m);
  }
  assert_near(step[1], step[0], 1e-2 * step[0]);
}

/** Faces of unlike spacing press like a layer of both: by the stiffness times Young's modulus and the gap over the mean spacing. */
static void unlike_spacings_press_like_a_layer_of_both(void **state)
{
  (void)state;
  for (int fine = 0; fine < 2; ++fine) { /* the first body, or the second */
    breccia_model *m =
        model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 2.4, model: " FIBRE "}}\n"
                 "peridynamics: {formulation: bond-based, space: plane strain, horizon: 0.04}\n"
                 "body:\n  a: {material: m, lattice: square, thickness: 0.1, spacing: %s}}\n"
                 "  b: {material: m, lattice: square, thickness: 0.1, spacing: %s}}\ncontact: {}\n"
                 "solve: {explicit: {steps: 1000000}}\n",
                 fine ? "0.01, shape: {box: {particles: [8, 8], first particle: [0.055, 0.005]}"
                      : "0.02, shape: {box: {particles: [10, 4], first particle: [0.01, 0.01]}",
                 fine ? "0.02, shape: {box: {particles: [10, 4], first particle: [0.01, 0.18]}"
                      : "0.01, shape: {box: {particles: [8, 8], first particle: [0.055, 0.175]}");
    const Particles *p = m->domain.particles;
    const double rest = 0.015, gap = 0.01 * rest;
    lower(m, 1, space_between(m, 1) - 1.01 * rest, true);
    lower(m, 1, 0.01 * rest + gap, false);
    double force = 0;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      if (p->block[i / SLICE]) force += p->volume[i] * p->internal.row[1][i];
    }
    const Contact *c = contact_of(m);
    const double pressed = c->spec->stiffness * c->young[0] * gap / 0.015 * 0.08 * 0.1;
    assert_near(force, pressed, 1e-3 * pressed);
    breccia_model_destroy(&m);
  }
}

/** Bodies fly at each other along the last axis, each with this speed. */
static void fly(const breccia_model *model, int axis, double speed)
{
  const Particles *p = model->domain.particles;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    p->velocity.row[axis][i] = p->block[i / SLICE] ? -speed : speed;
  }
}

static void a_run_that_gains_a_fifth_through_contact_is_stopped(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; ++kind)
    for (int fault = 0; fault < 2; ++fault) {
      if (under_sanitizers() && (kind || !fault)) continue;
      breccia_model *m = two_bodies("cubic", kind, 0.03015, 0.3, "contact: {stiffness: 0.1}\n");
      fly(m, 2, 5);
      breccia_error *error = breccia_error_create();
      double last = 0;
      int status = 0;
      bool bent = false;
      while (!status && m->solver.clock.step < 800) {
        status = breccia_model_step(m, 1, error);
        const double held = contact_energy(contact_of(m)), start = m->solver.ledger.kinetic_at_start;
        /* When it is pressed most, its energy is made larger by a quarter of what there was. */
        if (fault && !bent && held < last) {
          ContactSpec *spec = (ContactSpec *)contact_of(m)->spec;
          spec->stiffness *= 1 + 0.25 * start / held;
          bent = true;
        }
        last = held;
      }
      if (!fault) {
        assert_string_equal(breccia_error_text(error), "");
      } else {
        assert_true(bent);
        assert_int_equal(status, BRECCIA_FAILURE);
        if (!strstr(breccia_error_text(error), "energy from nothing")) fail_msg("%s", breccia_error_text(error));
      }
      breccia_error_destroy(&error);
      breccia_model_destroy(&m);
    }
}

static void friction_restarts_to_the_same_bits(void **state)
{
  (void)state;
  if (under_sanitizers()) skip(); /* test_contact_rest walks the same code */
  /* One body lies on the other, which is held, and is pushed along. */
  const char *more =
      "contact: {friction: 0.4}\nfailure: {critical stretch: 2e-3}\nloads:\n"
      "  - {on: {block: b}, body force: [4000, 0, -6000]}\n  - {on: {face: z-}, displacement: [0, 0, 0]}\n";
  breccia_model *run[3];
  for (int k = 0; k < 3; ++k) {
    run[k] = two_bodies("cubic", 0, 0.03015, 0.3, more);
    lower(run[k], 2, space_between(run[k], 2) - 0.01005, true);
  }
  char folder[] = "/tmp/breccia-XXXXXX", command[64];
  assert_non_null(mkdtemp(folder));
  breccia_run how = {.size = sizeof(breccia_run), .folder = folder, .steps = 1100};
  assert_int_equal(breccia_model_run(run[1], &how, NULL), 0);
  how.restart = 1;
  how.steps = 1300;
  assert_int_equal(breccia_model_run(run[2], &how, NULL), 0);
  assert_int_equal(breccia_model_step(run[0], 1300, NULL), 0);
  const Contact *whole = contact_of(run[0]), *again = contact_of(run[2]);
  const Particles *p = run[0]->domain.particles;
  assert_true(whole->friction_work > 0);
  assert_true(whole->friction_work > contact_of(run[1])->friction_work);
  assert_true(again->friction_work == whole->friction_work);
  assert_true(contact_energy(contact_of(run[2])) == contact_energy(contact_of(run[0])));
  for (int k = 0; k < 3; ++k) {
    const size_t bytes = sizeof(double) * (size_t)p->places;
    assert_memory_equal(run[2]->domain.particles->displacement.row[k], p->displacement.row[k], bytes);
    assert_memory_equal(run[2]->domain.particles->velocity.row[k], p->velocity.row[k], bytes);
  }
  for (int k = 0; k < 3; ++k) breccia_model_destroy(&run[k]);
  snprintf(command, sizeof command, "rm -r %s", folder);
  assert_int_equal(system(command), 0);
}

/** Turns what is displaced about an axis through the origin, with what contact knows following. */
static void turn(breccia_model *model, double angle)
{
  const Particles *p = model->domain.particles;
  for (int64_t i = 0; i < p->places; ++i) {
    const double y = p->position[1][i] + p->displacement.row[1][i], z = p->position[2][i] + p->displacement.row[2][i];
    p->displacement.row[1][i] = cos(angle) * y - sin(angle) * z - p->position[1][i];
    p->displacement.row[2][i] = sin(angle) * y + cos(angle) * z - p->position[2][i];
  }
  contact_follow(contact_of(model), 0.2 * fabs(angle));
  compute_forces(model);
  contact_commit(contact_of(model));
}

static void bodies_in_contact_that_rotate_feel_no_friction(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; ++kind) {
    breccia_model *m = two_bodies("cubic", kind, 0.03015, 0.3, "contact: {friction: 0.5}\n");
    const Particles *p = m->domain.particles;
    lower(m, 2, space_between(m, 2) - 0.0101, true);
    lower(m, 2, 3e-4, false);
    for (int64_t i = 0; i < p->places; ++i)
      if (p->block[i / SLICE]) p->displacement.row[1][i] += 2e-5; /* it sticks */
    turn(m, 0);
    const double held = contact_energy(contact_of(m)), slid = contact_of(m)->friction_work;
    assert_true(held > 0 && slid < 0.2 * held);
    for (int n = 0; n < (under_sanitizers() ? 15 : 150); ++n) {
      double force[3] = {0}, torque = 0, size = 0;
      turn(m, 0.01);
      for (int32_t k = 0; k < p->count; ++k) {
        const int32_t i = p->place_of[k];
        const double y = p->position[1][i] + p->displacement.row[1][i],
                     z = p->position[2][i] + p->displacement.row[2][i];
        for (int c = 0; c < 3; ++c) force[c] += p->internal.row[c][i] * p->volume[i];
        torque += (y * p->internal.row[2][i] - z * p->internal.row[1][i]) * p->volume[i];
        size += fabs(p->internal.row[2][i]) * p->volume[i];
      }
      for (int c = 0; c < 3; ++c) assert_near(force[c], 0, 1e-9 * size);
      assert_near(torque, 0, 1e-9 * size);
    }
    assert_near(contact_energy(contact_of(m)), held, 1e-6 * held);
    assert_near(contact_of(m)->friction_work, slid, 1e-6 * held);
    breccia_model_destroy(&m);
  }
}

static void corners_of_other_lattices_meet_and_keep_their_books(void **state)
{
  (void)state;
  const char *const lattices[] = {"hexagonal", "face-centred cubic"};
  for (int l = 0; l < 2; ++l)
    for (int kind = 0; kind < 2; ++kind) {
      if (under_sanitizers() && kind != l) continue;
      /* The upper one comes down beside the lower one's edge, over which it hangs by all but two or three rows. */
      breccia_model *m = two_bodies(lattices[l], kind, 0.03015, l ? 3.4 : 9.3, "contact: {friction: 0.3}\n");
      const int axis = l ? 2 : 1;
      const Particles *p = m->domain.particles;
      double before[3] = {0}, after[3] = {0}, size = 0, most = 0;
      fly(m, axis, 5);
      for (int64_t i = 0; i < p->places; ++i)
        for (int c = 0; c < 3; ++c) {
          before[c] += p->density[i] * p->volume[i] * p->velocity.row[c][i];
          size += fabs(p->density[i] * p->volume[i] * p->velocity.row[c][i]);
        }
      breccia_error *error = breccia_error_create();
      while (m->solver.clock.step < 1500 && !(under_sanitizers() && most > 0)) {
        if (breccia_model_step(m, 10, error)) fail_msg("%s: %s", lattices[l], breccia_error_text(error));
        most = larger_of(most, contact_energy(contact_of(m)));
        assert_true(solver_energy(&m->solver).imbalance < 0.02);
      }
      for (int64_t i = 0; i < p->places; ++i)
        for (int c = 0; c < 3; ++c) after[c] += p->density[i] * p->volume[i] * p->velocity.row[c][i];
      for (int c = 0; c < 3; ++c) assert_near(after[c], before[c], 1e-11 * size);
      assert_true(most > 0);
      if (!under_sanitizers()) {
        assert_true(most > 1e-3 * m->solver.ledger.kinetic_at_start); /* they have met */
        assert_true(contact_energy(contact_of(m)) == 0);              /* and parted */
      }
      breccia_error_destroy(&error);
      breccia_model_destroy(&m);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_stable_step_holds_when_faces_press),
      cmocka_unit_test(the_lighter_body_bounds_the_stable_step_in_any_order),
      cmocka_unit_test(a_run_that_gains_a_fifth_through_contact_is_stopped),
      cmocka_unit_test(unlike_spacings_press_like_a_layer_of_both),
      cmocka_unit_test(friction_restarts_to_the_same_bits),
      cmocka_unit_test(bodies_in_contact_that_rotate_feel_no_friction),
      cmocka_unit_test(corners_of_other_lattices_meet_and_keep_their_books),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

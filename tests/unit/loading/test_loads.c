/* Loads against closed forms: what each of them does, and its work in the ledger. */
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define SOFT UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e3, Poisson ratio: 0.25}}\n"
#define CUBE SOFT "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 4, 4]}}}}\n"

static void run_all(breccia_model *model)
{
  Error *error = breccia_error_create();
  if (breccia_model_step(model, INT64_MAX, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
}

static void pressure_and_traction_have_the_resultant_of_their_face(void **state)
{
  (void)state;
  const struct {
    const char *lattice, *to, *more;
    double size[3]; /* without blocks that do not fill it: the box */
  } bodies[] = {{"cubic", "[0.6, 0.8, 1]", "", {0.6, 0.8, 1}},
                {"face-centred cubic", "[0.6, 0.8, 1]", "", {0.6, 0.8, 1}},
                {"square", "[0.6, 0.8]", ", thickness: 0.3", {0.6, 0.8, 0.3}},
                {"hexagonal", "[0.6, 0.8]", ", thickness: 0.3", {0.6, 0.8, 0.3}}};
  const char *const faces[] = {"x+", "x-", "y+", "y-", "z+", "z-"};
  for (int b = 0; b < 4; ++b)
    for (int f = 0; f < (b < 2 ? 6 : 4); ++f)
      for (int layers = 1; layers < 4; layers += 2) {
        breccia_model *m = model_of(
            SOFT "body: {b: {material: m, lattice: %s, spacing: 0.1, shape: {box: {from: [0, 0%s], to: %s}}%s}}\n"
                 "loads: [{on: {face: %s, layers: %d}, pressure: 7}, {on: {face: %s}, traction: [2, -3%s]}]\n"
                 "peridynamics: {space: %s}\nsolve: {explicit: {steps: 1}}\n",
            bodies[b].lattice, b < 2 ? ", 0" : "", bodies[b].to, bodies[b].more, faces[f], layers, faces[f],
            b < 2 ? ", 5" : "", b < 2 ? "3-D" : "plane strain");
        assert_int_equal(breccia_model_step(m, 1, NULL), 0);
        const int axis = f / 2;
        const double area = bodies[b].size[(axis + 1) % 3] * bodies[b].size[(axis + 2) % 3];
        const double traction[] = {2, -3, b < 2 ? 5 : 0};
        const Sums s = sums_of(m);
        for (int k = 0; k < 3; ++k)
          assert_near(s.external[k], area * (traction[k] + (k == axis ? f % 2 ? 7 : -7 : 0)), 1e-12 * area * 7);
        breccia_model_destroy(&m);
      }
  /* A sphere has no face of known area: half of it, with the area that the deck says. */
  breccia_model *m =
      model_of(SOFT "body: {b: {material: m, spacing: 0.1, shape: {sphere: {centre: [0, 0, 0], radius: 0.5}}}}\n"
                    "loads: [{on: {inside: {box: {from: [0.2, -1, -1], to: [1, 1, 1]}}}, area: 0.4, "
                    "traction: [3, 0, -1], history: {ramp to: 2}}]\n"
                    "solve: {explicit: {steps: 10, time step: 1e-2}}\n");
  assert_int_equal(breccia_model_step(m, 10, NULL), 0);
  assert_near(sums_of(m).external[0], 0.05 * 0.4 * 3, 1e-14);
  assert_near(sums_of(m).external[2], -0.05 * 0.4, 1e-14);
  breccia_model_destroy(&m);
}

static void pressure_from_both_ends_stresses_a_bar_by_itself(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(SOFT "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [24, 5, 5]}}}}\n"
                    "loads: [{on: {face: x-, layers: 3}, pressure: 0.5}, {on: {face: x+, layers: 3}, "
                    "pressure: 0.5}]\n"
                    "solve: {explicit: {end time: 6, damping: 10, rest: 1e-4}}\n"
                    "watch: {s: {stress and strain of: {inside: {box: {from: [1, 0, 0], to: [1.4, 1, 1]}}}}}\n");
  run_all(m);
  assert_true(m->solver.records[0].came_to_rest == 1);
  double mean = 0;
  int count = 0;
  for (int64_t n = 0; n < m->domain.particles->count; ++n) {
    const int32_t i = m->domain.particles->place_of[n];
    if (fabs(m->domain.particles->position[0][i] - 1.2) > 0.11) continue;
    mean += m->domain.stress[0][i];
    ++count;
  }
  assert_near(mean / count, -0.5, 0.01 * 0.5);
  assert_balanced(m, 1e-3);
  breccia_model_destroy(&m);
}

static void water_presses_by_its_depth(void **state)
{
  (void)state;
  /* On faces of 2 x 1, with water up to s = 1.5, where two cells of height h meet: the resultant w s^2 / 2 is exact, and its moment about the foot,
   * w s^3 / 6, is found with w s h^2 / 12 too much, as pressure is one in each cell. */
  const struct {
    const char *lattice, *to, *more, *face;
    int up;
  } bodies[] = {{"cubic", "[0.4, 1, 2]", "", "x-", 2}, {"square", "[0.4, 2]", ", thickness: 1", "x+", 1}};
  for (int b = 0; b < 2; ++b) {
    breccia_model *m = model_of(
        SOFT "body: {b: {material: m, lattice: %s, spacing: 0.1, shape: {box: {from: [0, 0%s], to: %s}}%s}}\n"
             "loads: [{on: {face: %s, layers: 2}, water pressure: {surface: 1.5, unit weight: 8}}]\n"
             "peridynamics: {space: %s}\nsolve: {explicit: {steps: 1}}\n",
        bodies[b].lattice, b ? "" : ", 0", bodies[b].to, bodies[b].more, bodies[b].face, b ? "plane strain" : "3-D");
    assert_int_equal(breccia_model_step(m, 1, NULL), 0);
    const Sums s = sums_of(m);
    const Particles *p = m->domain.particles;
    assert_near(s.external[0], (b ? -1 : 1) * 8 * 1.5 * 1.5 / 2, 1e-12);
    double moment = 0;
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      moment += p->external.row[0][i] * p->volume[i] * p->position[bodies[b].up][i];
    }
    assert_near(fabs(moment), 8 * 1.5 * (1.5 * 1.5 + 0.1 * 0.1 / 2) / 6, 1e-12);
    breccia_model_destroy(&m);
  }
}

static void radial_pressure_pushes_half_a_pipe_by_its_diameter(void **state)
{
  (void)state;
  /* Half a ring on y > 0: a pressure p within is in all p x diameter x length along y, in the plane and around an axis askew in space. Shares go by
   * volume along the true directions, so that what is left is the roundness of a lattice. */
  const double radius = 1, pressure = 7, length = 0.5;
  breccia_model *m = model_of(
      SOFT "body: {b: {material: m, lattice: square, spacing: 0.02, thickness: 0.5, shape: {difference: [{box: {from: "
           "[-1.2, 0], to: [1.2, 1.2]}}, {sphere: {centre: [0, 0], radius: 1}}]}}}\n"
           "loads: [{on: {inside: {sphere: {centre: [0, 0], radius: 1.1}}}, radial pressure: {pressure: 7, centre: "
           "[0, 0], area: \"${pi/2}\"}}]\n"
           "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n");
  step_surely(m, 1);
  assert_near(sums_of(m).external[0], 0, 1e-10);
  assert_near(sums_of(m).external[1], 2 * radius * length * pressure, 0.005 * 2 * radius * length * pressure);
  assert_near(sums_of(m).turn[2], 0, 1e-10);
  breccia_model_destroy(&m);
  m = model_of(
      CUBE
      "loads: [{on: {all: yes}, radial pressure: {pressure: -3, centre: [1, 0.1, -2], axis: [0, 2, 0], area: 5}}]\n"
      "solve: {explicit: {steps: 1}}\n");
  step_surely(m, 1);
  const Particles *p = m->domain.particles;
  const int32_t i = p->place_of[0];
  const double dx = p->position[0][i] - 1, dz = p->position[2][i] + 2, r = sqrt(dx * dx + dz * dz);
  const double force = -3 * 5 / (64 * 1e-3); /* per volume */
  assert_near(p->external.row[0][i], force * dx / r, 1e-12 * fabs(force));
  assert_near(p->external.row[1][i], 0, 0);
  assert_near(p->external.row[2][i], force * dz / r, 1e-12 * fabs(force));
  breccia_model_destroy(&m);
}

static void the_ground_moves_as_seen_from_itself(void **state)
{
  (void)state;
  const char *history = "history: {sine: {frequency: 3, until: 1}}";
  breccia_model *frame = model_of(CUBE "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]},\n"
                                       "        {base acceleration: [2, 0, -1], %s}]\n"
                                       "solve: {explicit: {steps: 600, time step: 1e-3}}\n",
                                  history),
                *ground = model_of(CUBE "loads: [{on: {face: x-, layers: 1}, acceleration: [2, 0, -1], %s}]\n"
                                        "solve: {explicit: {steps: 600, time step: 1e-3}}\n",
                                   history);
  const Particles *p = frame->domain.particles, *q = ground->domain.particles;
  const int32_t held = p->place_of[0];
  double largest = 0;
  for (int round = 0; round < 12; ++round) {
    assert_int_equal(breccia_model_step(frame, 50, NULL), 0);
    assert_int_equal(breccia_model_step(ground, 50, NULL), 0);
    const double t = breccia_model_time(frame), w = 6 * acos(-1);
    const Sums s = sums_of(frame);
    assert_near(s.external[0], -s.mass * 2 * sin(w * t), 1e-12); /* against the acceleration */
    assert_near(s.external[2], s.mass * 1 * sin(w * t), 1e-12);
    assert_near(q->displacement.row[0][held], 2 * (t / w - sin(w * t) / (w * w)),
                1e-12); /* the integral of the integral */
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < 3; k += 2) {
        const int32_t i = p->place_of[n];
        const double relative = q->displacement.row[k][i] - q->displacement.row[k][held];
        largest = larger_of(largest, fabs(relative));
        assert_near(relative, p->displacement.row[k][i], 2e-6);
      }
  }
  assert_true(largest > 1e-3);
  assert_balanced(frame, 1e-3);
  assert_balanced(ground, 1e-3);
  breccia_model_destroy(&frame);
  breccia_model_destroy(&ground);
}

static void on_inclined_rollers_a_body_slides_without_friction(void **state)
{
  (void)state;
  breccia_model *m = model_of(CUBE "loads: [{gravity: [0, 0, -10]}, {on: {all: yes}, roller: [3, 0, 4]}]\n"
                                   "solve: {explicit: {end time: 0.5}}\n");
  run_all(m);
  /* Down the slope, (4, 0, -3) / 5, by g sin a = 6. */
  const double moved = 6 * 0.25 / 2;
  const Sums s = sums_of(m);
  assert_near(s.moved[0], 0.8 * moved, 1e-9);
  assert_near(s.moved[2], -0.6 * moved, 1e-9);
  assert_near(solver_energy(&m->solver).kinetic, s.mass * 9 / 2, 1e-9);
  assert_near(solver_energy(&m->solver).external, s.mass * 10 * 0.6 * moved, 1e-9);
  breccia_model_destroy(&m);
}

static void a_body_is_thrown_and_spins_as_said(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(SOFT "body: {b: {material: m, spacing: 0.1, shape: {box: {from: [1, 1, 0], to: [1.6, 1.4, 0.2]}}}}\n"
                    "loads: [{initial velocity: {translation: [1, 0, 2], rotation: [0, 0, 3 rad/s]}}]\n"
                    "solve: {explicit: {steps: 40}}\n");
  assert_int_equal(breccia_model_step(m, 1, NULL), 0);
  const Sums first = sums_of(m);
  const double mass = 2 * 0.6 * 0.4 * 0.2;
  /* The inertia of the particles' centres; of the whole box it would be m (a^2 + b^2) / 12. */
  const double inertia = mass * (0.36 - 0.01 + 0.16 - 0.01) / 12, about_origin = mass * (1.3 * 0 - 1.2 * 1);
  const double kinetic = mass * 5 / 2 + inertia * 9 / 2;
  assert_near(m->solver.ledger.kinetic_at_start, kinetic, 1e-12);
  assert_near(first.momentum[0], mass, 1e-12);
  assert_near(first.momentum[2], 2 * mass, 1e-12);
  assert_near(first.turn[2], inertia * 3 + about_origin, 1e-3 * mass);
  run_all(m);
  const Sums last = sums_of(m);
  for (int k = 0; k < 3; ++k) {
    assert_near(last.momentum[k], first.momentum[k], 1e-12);
    assert_near(last.turn[k], first.turn[k], 1e-9);
  }
  assert_balanced(m, 1e-3);
  breccia_model_destroy(&m);
  breccia_model *about = model_of(CUBE "loads: [{initial velocity: {rotation: [2, 0, 0], about: [0, 1, 0]}}]\n"
                                       "solve: {explicit: {steps: 1, time step: 1e-6}}\n");
  assert_int_equal(breccia_model_step(about, 1, NULL), 0);
  const Particles *p = about->domain.particles;
  const int32_t i = particles_nearest(p, (double[]){0.35, 0.25, 0.15});
  assert_near(p->velocity.row[1][i], -2 * p->position[2][i], 1e-4);
  assert_near(p->velocity.row[2][i], 2 * (p->position[1][i] - 1), 1e-4);
  breccia_model_destroy(&about);
}

/** A body of two densities that begins to turn about its centre of mass has no momentum. */
static void a_body_spins_about_its_centre_of_mass(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(UNITS "materials:\n"
                     "  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}\n"
                     "  n: {model: elastic, density: 6, Young modulus: 1e4, Poisson ratio: 0.25}\n"
                     "body:\n  b: {material: m, spacing: 0.1, shape: {box: {particles: [4, 3, 3]}}}\n"
                     "  c: {material: n, spacing: 0.1, shape: {box: {particles: [2, 3, 3], first particle: "
                     "[0.4, 0, 0]}}}\n"
                     "loads: [{initial velocity: {rotation: [0, 0, 3]}}]\nsolve: {explicit: {steps: 1}}\n");
  run_all(m);
  const Sums s = sums_of(m);
  assert_true(s.turn[2] > 0.01 * s.mass);
  for (int k = 0; k < 3; ++k) assert_near(s.momentum[k], 0, 1e-12 * s.mass);
  breccia_model_destroy(&m);
}

#define STRIP(nx)                                                                                                      \
  UNITS                                                                                                                \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [" nx                      \
  ", 0], to: [2, 1.2]}}}}\n"                                                                                           \
  "peridynamics: {space: plane stress}\n"

/* Half a body on a plane of symmetry is the half of a whole one, at every moment and particle. */
static void assert_half_moves_as_whole(const char *solve)
{
  const char *whole_loads = "loads: [{on: {face: x+}, traction: [3, 1]}, {on: {face: x-}, traction: [-3, 1]}]\n",
             *half_loads = "loads: [{on: {face: x+}, traction: [3, 1]}, {on: {face: x-}, support: {held: across}}]\n";
  breccia_model *whole = model_of(STRIP("-2") "%s%s", whole_loads, solve),
                *half = model_of(STRIP("0") "%s%s", half_loads, solve);
  assert_int_equal(half->domain.particles->count, 20 * 12 + 6 * 12);
  run_all(whole);
  run_all(half);
  const Particles *p = whole->domain.particles, *q = half->domain.particles;
  double largest = 0;
  for (int64_t n = 0; n < q->count; ++n) {
    const int32_t i = q->place_of[n];
    if (q->position[0][i] < 0) { /* outside: the other way across the face, the same way along it */
      const int32_t image = particles_nearest(q, (double[]){-q->position[0][i], q->position[1][i], 0});
      assert_near(q->velocity.row[0][i], -q->velocity.row[0][image], 1e-12);
      assert_near(q->velocity.row[1][i], q->velocity.row[1][image], 1e-12);
      continue;
    }
    const int32_t j = particles_nearest(p, (double[]){q->position[0][i], q->position[1][i], 0});
    for (int k = 0; k < 2; ++k) {
      largest = larger_of(largest, fabs(p->displacement.row[k][j]));
      assert_near(q->displacement.row[k][i], p->displacement.row[k][j], 1e-10);
    }
    assert_near(half->domain.stress[0][i], whole->domain.stress[0][j], 1e-6);
  }
  assert_true(largest > 1e-4);
  assert_balanced(half, 1e-3);
  breccia_model_destroy(&whole);
  breccia_model_destroy(&half);
}

static void half_a_body_on_a_support_across_is_half_a_whole(void **state)
{
  (void)state;
  assert_half_moves_as_whole("solve: {explicit: {steps: 200, time step: 2e-4}}\n");
  assert_half_moves_as_whole("solve: {implicit: {end time: 0.04, time step: 4e-3, local error: 1, residual: 1e-12, "
                             "stiffness damping: 1e-3}}\n");
}

/** Every particle of a half (or quarter) body moves as the one at its place in the whole body. */
static void assert_part_moves_as_whole(const breccia_model *part, const breccia_model *whole, const char *what)
{
  const Particles *p = whole->domain.particles, *q = part->domain.particles;
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t n = 0; n < p->count; ++n) largest = larger_of(largest, fabs(p->displacement.row[k][p->place_of[n]]));
  assert_true(largest > 0);
  for (int64_t n = 0; n < q->count; ++n) {
    const int32_t i = q->place_of[n];
    if (body_outside(&part->domain.body, n)) continue;
    const int32_t j = particles_nearest(p, (double[]){q->position[0][i], q->position[1][i], q->position[2][i]});
    for (int k = 0; k < 3; ++k)
      if (!(fabs(q->displacement.row[k][i] - p->displacement.row[k][j]) <= 1e-9 * largest))
        fail_msg("%s: at [%g, %g, %g] along %c: %.12g, in the whole body %.12g", what, q->position[0][i],
                 q->position[1][i], q->position[2][i], "xyz"[k], q -> displacement.row[k][i],
                 p->displacement.row[k][j]);
  }
}

#define CRACKED(lattice, from, to, space)                                                                              \
  UNITS                                                                                                                \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"                            \
  "body: {b: {material: m, lattice: " lattice ", spacing: 0.1, shape: {box: {from: " from ", to: " to "}}}}\n"         \
  "peridynamics: {" space "}\n"

/* Half a cracked plate, wherever its crack begins at the plane of symmetry or beyond, is the half of a whole one: the images have its crack. */
static void cracks_go_on_in_images(void **state)
{
  (void)state;
#define PULL                                                                                                           \
  "{on: {face: x+}, traction: [3, 0]}, {on: {face: y+}, traction: [0, 5]}, {on: {face: y-}, traction: [0, -5]}"
#define SOLVE "solve: {explicit: {steps: 150, time step: 2e-4}}\n"
  static const struct {
    const char *half, *whole;
  } cracks[] = {
      {"cut: {line: [[0, 1], [0.5, 1]]}", "cut: {line: [[-0.5, 1], [0.5, 1]]}"},
      {"cut: {line: [[0.5, 1], [-0.2, 1]]}", "cut: {line: [[0.5, 1], [-0.5, 1]]}"},
      {"cut: {line: [[0, 1.05], [0.5, 1.05]]}", "cut: {line: [[-0.5, 1.05], [0.5, 1.05]]}"}, /* in a row */
      {"cut: {line: [[0, 0.95], [0.5, 1.45]]}", "cut: {line: [[-0.5, 1.45], [0, 0.95], [0.5, 1.45]]}"},
      {"cut: {line: [[0.5, 1.5], [-0.3, 0.7]]}", "cut: {line: [[0.5, 1.5], [0, 1], [-0.5, 1.5]]}"},
      {"cut: {line: [[0, 0.6], [0, 1.4]]}", "cut: {line: [[0, 0.6], [0, 1.4]]}"}, /* in the plane of symmetry */
      {"remove: {box: {from: [0, 0.9], to: [0.5, 1.1]}}, cut faces: yes",
       "remove: {box: {from: [-0.5, 0.9], to: [0.5, 1.1]}}, cut faces: yes"},
      {"remove: {box: {from: [0, 1], to: [0.5, 1.1]}}, cut faces: yes",
       "remove: {box: {from: [-0.5, 1], to: [0.5, 1.1]}}, cut faces: yes"},
  };
  for (size_t k = 0; k < sizeof cracks / sizeof *cracks; ++k) {
    breccia_model *half =
                      model_of(CRACKED("square, thickness: 1", "[0, 0]", "[1, 2]",
                                       "space: plane strain") "cracks: [{%s}]\n"
                                                              "loads: [{on: {face: x-}, support: {held: across}}, " PULL
                                                              "]\n" SOLVE,
                               cracks[k].half),
                  *whole = model_of(CRACKED("square, thickness: 1", "[-1, 0]", "[1, 2]",
                                            "space: plane strain") "cracks: [{%s}]\n"
                                                                   "loads: [{on: {face: x-}, traction: [-3, 0]}, " PULL
                                                                   "]\n" SOLVE,
                                    cracks[k].whole);
    run_all(half);
    run_all(whole);
    assert_part_moves_as_whole(half, whole, cracks[k].half);
    breccia_model_destroy(&half);
    breccia_model_destroy(&whole);
  }
  /* a quarter in space, with a polygon that reaches both planes */
  breccia_model *part = model_of(
                    CRACKED("cubic", "[0, 0, 0]", "[0.7, 0.7, 0.6]",
                            "formulation: ordinary") "cracks: [{cut: {polygon: [[0, 0, 0.3], [0.4, 0, 0.3], [0.4, "
                                                     "0.4, 0.3], [0, 0.4, 0.3]]}}]\n"
                                                     "loads: [{on: {face: x-}, support: {held: across}}, {on: {face: "
                                                     "y-}, support: {held: "
                                                     "across}}, {on: {face: z+}, traction: [0, 0, 5]}]\n" SOLVE),
                *whole = model_of(
                    CRACKED("cubic", "[-0.7, -0.7, 0]", "[0.7, 0.7, 0.6]",
                            "formulation: ordinary") "cracks: [{cut: {polygon: [[-0.4, -0.4, 0.3], [0.4, -0.4, 0.3], "
                                                     "[0.4, 0.4, 0.3], [-0.4, 0.4, 0.3]]}}]\n"
                                                     "loads: [{on: {face: z+}, traction: [0, 0, 5]}]\n" SOLVE);
  run_all(part);
  run_all(whole);
  assert_part_moves_as_whole(part, whole, "in space");
  breccia_model_destroy(&part);
  breccia_model_destroy(&whole);
#undef PULL
#undef SOLVE
}

/* A quarter of a plate, with a corner where two supports meet, pulled to rest: stress and strain are alike in all of it up to the faces. */
static void stresses_are_right_up_to_a_support(void **state)
{
  (void)state;
  breccia_model *m = model_of(STRIP("0") "loads:\n  - {on: {face: x-}, support: {held: across}}\n"
                                         "  - {on: {face: y-}, support: {held: across}}\n"
                                         "  - {on: {face: x+, layers: 3}, traction: [5, 0]}\n"
                                         "solve: {explicit: {end time: 3, damping: 60, rest: 1e-5}}\n");
  run_all(m);
  assert_true(m->solver.records[0].came_to_rest == 1);
  for (double x = 0.05; x < 1; x += 0.1)
    for (double y = 0.05; y < 0.6; y += 0.1) {
      const int32_t i = body_nearest(&m->domain.body, (double[]){x, y, 0});
      assert_near(m->domain.stress[0][i], 5, 0.01 * 5);
      assert_near(m->domain.stress[1][i], 0, 0.02 * 5);
      assert_near(m->domain.particles->displacement.row[0][i], 5e-4 * x, 0.01 * 5e-4);
      assert_near(m->domain.particles->displacement.row[1][i], -1.25e-4 * y, 0.01 * 5e-4);
    }
  breccia_model_destroy(&m);
}

/* A face that is pushed by a support stands where it is told: a bar between two of them has the mean strain at once. */
static void a_face_goes_where_its_support_goes(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      STRIP("0") "selections: {held: {outside: yes, face: x-, layers: 6}}\n"
                 "loads:\n  - {on: {face: x-}, support: {held: all, layers: 6}}\n"
                 "  - {on: {face: x+}, support: {held: across, displacement: [2e-3, 0]}, history: {ramp to: 0.05}}\n"
                 "solve: {explicit: {end time: 3, damping: 60, rest: 1e-5}}\n"
                 "watch: {reaction: {force on: held}}\n");
  run_all(m);
  const int32_t i = body_nearest(&m->domain.body, (double[]){1.95, 0.65, 0});
  const int32_t j = body_nearest(&m->domain.body, (double[]){1, 0.6, 0});
  assert_near(m->domain.particles->displacement.row[0][i], 2e-3 * 1.95 / 2, 0.02 * 2e-3);
  assert_near(m->domain.stress[0][j], 10, 0.02 * 10);
  assert_near(solver_energy(&m->solver).imbalance, 0, 1e-2);
  breccia_model_destroy(&m);
  const char *const wrong[][2] = {
      {"{on: {inside: {box: {from: [0, 0], to: [1, 1]}}}, support: {held: all}}", "takes the whole face of a block"},
      {"{on: {face: x-}, support: {held: across, displacement: [0, 1]}}", "its displacement along y must be 0"},
      {"{on: {face: x-}, support: {held: all}}, {on: {face: x-}, support: {held: across}}",
       "this face has one already"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, STRIP("0") "loads: [%s]\nsolve: {explicit: {steps: 1}}\n", wrong[k][0]);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k][1])) fail_msg("expected '%s', found '%s'", wrong[k][1], words);
    free(words);
  }
  /* Its layers are there from the first stage to the last, and would be part of the body where nobody moves them. */
  const char *const staged[] = {
      "solve: [{explicit: {steps: 1}}, {explicit: {steps: 1}, loads: [{on: {face: x-}, support: {held: all}}]}]\n",
      "loads: [{name: wall, on: {face: x-}, support: {held: all}}]\n"
      "solve: [{explicit: {steps: 1}}, {explicit: {steps: 1}, without: [wall]}]\n"};
  for (size_t k = 0; k < sizeof staged / sizeof *staged; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, STRIP("0") "%s", staged[k]);
    char *words = refusal_of(deck);
    if (!strstr(words, "it must act all the while")) fail_msg("found '%s'", words);
    free(words);
  }
}

/* A face that stands a millimetre aside from the first step on: what that takes is work of its load, alike whether the body is damped or not. */
static void a_face_that_jumps_pays_for_it(void **state)
{
  (void)state;
  const char *const solves[] = {"", ", damping: 30", ", local damping: 0.5"};
  for (int k = 0; k < 3; ++k) {
    breccia_model *m =
        model_of(CUBE "loads: [{on: {face: x-}, displacement: [1e-5, 0, 0]}, {on: {face: x+}, roller: [1, 0, "
                      "0]}]\nsolve: {explicit: {steps: 40, safety: 0.3%s}}\n",
                 solves[k]);
    breccia_model_step(m, 1, NULL);
    const Energy first = solver_energy(&m->solver);
    assert_true(first.stored > 0);
    assert_near(first.external, first.stored + first.kinetic + first.damping - first.between, 1e-3 * first.external);
    run_all(m);
    assert_balanced(m, 2e-3);
    breccia_model_destroy(&m);
  }
}

/* A block that is moved whole presses another by contact, without friction: what bonds of the platen carry is what crosses the block. */
static void a_rigid_platen_presses_by_contact(void **state)
{
  (void)state;
  breccia_model *m = model_of(
      UNITS
      "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.25}}\n"
      "body:\n"
      "  b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [0, 0], to: [2, 1]}}}\n"
      "  platen: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {from: [-0.5, 1], to: [2.5, "
      "1.4]}}}\n"
      "cracks: [{cut: {line: [[-1, 1], [3, 1]]}}]\n"
      "peridynamics: {space: plane stress}\n"
      "contact: {friction: 0}\n"
      "loads: [{on: {block: b, face: y-}, support: {held: across}},\n"
      "        {on: {block: platen}, displacement: [0, -0.01], history: {ramp to: 0.3}}]\n"
      "solve: {explicit: {end time: 1, damping: 60}}\n");
  run_all(m);
  const Particles *p = m->domain.particles;
  double platen = 0, section = 0, strain = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (p->block[i / SLICE] == 1) {
      platen += p->internal.row[1][i] * p->volume[i];
      assert_near(p->displacement.row[1][i], -0.01, 1e-12);
    } else if (fabs(p->position[1][i] - 0.35) < 1e-6) {
      section += m->domain.stress[1][i] * 0.1;
      strain += m->domain.strain[1][i] / 20;
    }
  }
  assert_near(platen, -section, 0.02 * platen);
  assert_near(strain, -0.01, 0.001); /* less what contact gives way */
  assert_near(section, 2 * 1e4 * strain, 0.02 * platen);
  assert_balanced(m, 1e-3);
  breccia_model_destroy(&m);
}

static void a_prescribed_acceleration_does_the_work_that_it_must(void **state)
{
  (void)state;
  /* All of the body by a constant acceleration: a rigid motion, 1/2 m v^2 of work. */
  breccia_model *m = model_of(CUBE "loads: [{on: {all: yes}, along: {direction: [0, 1, 0], acceleration: 4}}]\n"
                                   "solve: {explicit: {end time: 0.5}}\n");
  run_all(m);
  const Sums s = sums_of(m);
  assert_near(s.moved[1], 0.5, 1e-12);
  assert_near(s.momentum[1], s.mass * 2, 1e-12);
  assert_near(solver_energy(&m->solver).external, s.mass * 4 / 2, 1e-10);
  breccia_model_destroy(&m);
}

static void what_does_not_fit_is_said(void **state)
{
  (void)state;
  const struct {
    const char *load, *words;
  } wrong[] = {
      {"{on: {all: yes}, pressure: 3}", "pressure: acts on a face: 'on' must say which, like {face: x+}"},
      {"{on: {all: yes}, traction: [1, 0, 0]}", "or 'area' how large it is"},
      {"{on: {face: x+}, pressure: 3, area: 2}", "area: only a 'traction' has one"},
      {"{on: {all: yes}, water pressure: {surface: 3}}", "water pressure: acts on a face"},
      {"{on: {face: x+}, water pressure: {surface: -1}}", "surface: all particles of the face stand above it"},
      {"{on: {all: yes}, radial pressure: {pressure: 3, area: 1, centre: [0.05, 0.05, 0]}}",
       "a particle stands on the axis"},
      {"{on: {all: yes}, radial pressure: {pressure: 3, area: 1, centre: [0, 0, 0], axis: [0, 0, 0]}}",
       "axis: must not be zero"},
      {"{on: {face: x+}, roller: [0, 0, 0]}", "roller: must not be zero"},
      {"{on: {face: x+}, roller: [1, 0, 0], history: {ramp to: 1}}", "history: 'roller' does not vary in time"},
      {"{on: {face: x+}, spring: {stiffness: -1}}", "stiffness: -1 is out of range"},
      {"{on: {face: x+}, spring: {stiffness: 1, to: {face: x+}}}", "spring: its ends have one centre"},
      {"{on: {face: x+}, spring: {stiffness: 5 kN}}", "stiffness"},
      {"{on: {face: x+}, tie: {to: {all: yes}}}", "is among 'on' and among 'to'"},
      {"{initial velocity: {about: [0, 0, 0]}}", "initial velocity: say how: 'translation', 'rotation' or both"},
      {"{initial velocity: {rotation: [0, 0, 3 Hz]}}", "counts turns"},
      {"{on: {face: x+}, displacement: [0, free, free]}, {on: {face: x+}, tie: {to: {face: x-}}}",
       "is moved or held by the load in line 4, and the one it is tied to is not"},
      {"{on: {face: x+}, displacement: [0, free, free]}, {on: {face: x+}, roller: [1, 1, 0]}", "not at right angles"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    char deck[1024];
    snprintf(deck, sizeof deck, CUBE "loads: [%s]\nsolve: {explicit: {steps: 1}}\n", wrong[k].load);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s', found '%s'", wrong[k].words, words);
    assert_non_null(strstr(words, "deck:"));
    free(words);
  }
  char *words = refusal_of(SOFT "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: "
                                "{particles: [6, 20]}}}}\n"
                                "peridynamics: {space: plane strain}\n"
                                "loads: [{initial velocity: {rotation: [1, 0, 0]}}]\nsolve: {explicit: {steps: 1}}\n");
  assert_non_null(strstr(words, "plane and turns about z only"));
  free(words);
  words = refusal_of(
      SOFT "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {box: {particles: [6, 20]}}}}\n"
           "peridynamics: {space: plane strain}\n"
           "loads: [{on: {all: yes}, radial pressure: {pressure: 3, area: 1, centre: [9, 9], axis: [1, 0, 0]}}]\n"
           "solve: {explicit: {steps: 1}}\n");
  assert_non_null(strstr(words, "the body is plane; leave out 'axis'"));
  free(words);
  /* The box around the disc has particles on its left that the half plane takes away: nothing would be held. */
  words = refusal_of(
      SOFT "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 1, shape: {difference: [{sphere: "
           "{centre: [0, 0], radius: 1}}, {box: {from: [-2, -2], to: [0, 2]}}]}}}\n"
           "peridynamics: {space: plane strain}\nloads: [{on: {face: x-}, support: {held: across}}]\n"
           "solve: {explicit: {steps: 1}}\n");
  assert_non_null(strstr(words, "has no particles at its face x-"));
  free(words);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_and_traction_have_the_resultant_of_their_face),
      cmocka_unit_test(pressure_from_both_ends_stresses_a_bar_by_itself),
      cmocka_unit_test(water_presses_by_its_depth),
      cmocka_unit_test(radial_pressure_pushes_half_a_pipe_by_its_diameter),
      cmocka_unit_test(the_ground_moves_as_seen_from_itself),
      cmocka_unit_test(on_inclined_rollers_a_body_slides_without_friction),
      cmocka_unit_test(a_body_is_thrown_and_spins_as_said),
      cmocka_unit_test(a_body_spins_about_its_centre_of_mass),
      cmocka_unit_test(half_a_body_on_a_support_across_is_half_a_whole),
      cmocka_unit_test(cracks_go_on_in_images),
      cmocka_unit_test(stresses_are_right_up_to_a_support),
      cmocka_unit_test(a_face_goes_where_its_support_goes),
      cmocka_unit_test(a_face_that_jumps_pays_for_it),
      cmocka_unit_test(a_rigid_platen_presses_by_contact),
      cmocka_unit_test(a_prescribed_acceleration_does_the_work_that_it_must),
      cmocka_unit_test(what_does_not_fit_is_said),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

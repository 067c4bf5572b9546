/* Bodies with rotations in the solvers beside explicit dynamics: beams of links and cantilevers of lattices against closed forms, at rest, vibrating and
 * by long steps, and the ways to rest against each other. */
#include "formulation/micropolar.h"

#include "base/tensor.h"
#include "results/fields.h"
#include "solver/modes.h"
#include "solver/reactions.h"
#include "solver/rest.h"
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define MATERIAL(poisson)                                                                                              \
  "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: " poisson "}}\n"

static const double young = 1e4, density = 2, spacing = 0.1, thick = 0.3, pi = 3.14159265358979323846;

/** A row of particles along x, its first one clamped. @param[in] rest  more loads, and the solver */
static breccia_model *beam(bool space, int particles, const char *rest)
{
  breccia_model *model =
      model_of(UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {particles: "
                                     "[%d, 1%s]}}}}\n"
                                     "peridynamics: {formulation: micropolar, space: %s}\n"
                                     "loads: [{on: {nearest: [0, 0, 0]}, displacement: [0, 0, 0]}, {on: {nearest: [0, "
                                     "0, 0]}, rotation: [0, 0, 0]}%s\n",
               space ? "face-centred cubic" : "hexagonal", space ? "" : "thickness: 0.3,", particles,
               space ? ", 1" : "", space ? "3-D" : "plane stress", rest);
  model->threads = 1; /* of bodies so small more only wait */
  return model;
}

static int32_t last_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  return p->place_of[p->count - 1];
}

/** Of the links of a row: EA, EI, GJ and the mass of a particle. */
typedef struct Links {
  double axial, bending, twist, mass, gyration;
} Links;

static Links links_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  const Micropolar *m = model->domain.regions[0].formulation;
  const LinkConstants *c = &m->constants[0];
  const LinkStiffness *of = &c->of[c->lengths == 2 && c->length[0] > 1.2 * spacing];
  const double v = p->volume[p->place_of[0]];
  return (Links){of->axial * v * v, of->bending * v * v, of->twist * v * v, density * v, c->gyration};
}

static void rotation_of(const breccia_model *model, int32_t place, double rotation[3])
{
  particles_rotation(model->domain.particles, place, rotation);
}

/* ---- at rest ---- */

/** The tip of a row of links has the deflection and rotation of a beam, under a force, a moment and a torque, by each way to rest. */
static void a_row_of_links_at_rest_is_a_beam(void **state)
{
  (void)state;
  static const char *const ways[] = {"equations: direct", "equations: conjugate gradients", "method: relaxation",
                                     "equations: minimal residuals"};
  static const char *const loads[] = {"force: [0, 1e-7, 0]", "moment: [0, 0, 1e-7]", "moment: [1e-7, 0, 0]"};
  for (int space = 0; space < 2; ++space)
    for (int way = 0; way < 4; ++way)
      for (int load = 0; load < (space ? 3 : 2); ++load) {
        char rest[300];
        if (space && way == 1) continue; /* their stiffness is not symmetric once they have turned */
        snprintf(rest, sizeof rest,
                 ", {on: {nearest: [9, 0, 0]}, %s}]\nsolve: {static: {increments: 2, residual: 1e-8, relaxation "
                 "iterations: 20000, %s}}",
                 loads[load], ways[way]);
        breccia_model *model = beam(space, 7, rest);
        const Links links = links_of(model);
        const Particles *p = model->domain.particles;
        const int32_t tip = last_of(model);
        const double l = 6 * spacing, f = 1e-7;
        double rotation[3];
        step_surely(model, INT64_MAX);
        rotation_of(model, tip, rotation);
        const double wanted[3] = {l * l * l / 3, l * l / 2, 0}, turned[3] = {l * l / 2, l, l};
        const double ei = load == 2 ? links.twist : links.bending;
        if (load < 2) assert_near(p->displacement.row[1][tip] / (f * wanted[load] / ei), 1, 1e-6);
        assert_near(rotation[load == 2 ? 0 : 2] / (f * turned[load] / ei), 1, 1e-6);
        assert_balanced(model, 1e-6);
        assert_true(model->solver.clock.time == 1);
        breccia_model_destroy(&model);
      }
}

/** Rolled by a moment at its tip, an elastic row of links becomes an arc of a circle, up to the whole circle; its rotation follows in increments. The chords
 *  between the particles turn by equal angles: exact for a chain of equal links. */
static void a_row_of_links_is_rolled_into_a_circle(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = beam(space, 13,
                                ", {on: {nearest: [9, 0, 0]}, rotation: [free, free, 360], history: {ramp to: 1}}]\n"
                                "solve: {static: {increments: 8}}");
    const Particles *p = model->domain.particles;
    const double turn = 2 * pi / 12;
    step_surely(model, INT64_MAX);
    /* Link k points along turn (k + 1/2); links that bend alike have no axial force, and their length. */
    double x = 0, y = 0;
    for (int n = 0; n < 12; ++n) {
      x += spacing * cos(turn * (n + 0.5));
      y += spacing * sin(turn * (n + 0.5));
      const int32_t i = p->place_of[n + 1], first = p->place_of[0];
      double rotation[3], told[3];
      output_field_find("rotation")->value(&model->domain, i, told); /* in degrees; in space half a turn at most */
      if (n != 5)                                                    /* half a turn either way */
        assert_near(told[2], space && n >= 6 ? 30 * (n + 1) - 360 : 30 * (n + 1), 1e-4);
      assert_near(p->position[0][i] + p->displacement.row[0][i] - p->position[0][first], x, 1e-7);
      assert_near(p->displacement.row[1][i], y, 1e-7);
      rotation_of(model, i, rotation);
      assert_near(sin(rotation[2] - turn * (n + 1)), 0, 1e-6);
      assert_near(cos(rotation[2] - turn * (n + 1)), 1, 1e-6);
    }
    assert_near(x, 0, 1e-12);
    breccia_model_destroy(&model);
  }
}

/** A cantilever of a lattice bends and shears as Timoshenko's beam does, but for its surfaces, which lack links: an error of the first order in the
 *  spacing. All ways to rest find the same. */
static breccia_model *cantilever(bool space, double size, const char *rest)
{
  breccia_model *model =
      model_of(UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: %s, spacing: %g, %s shape: {box: {from: [0, 0, "
                                     "0], to: [%g, 0.8, %g]}}}}\n"
                                     "peridynamics: {formulation: micropolar, space: %s}\n"
                                     "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x-, "
                                     "layers: 1}, rotation: [0, 0, 0]}%s\n",
               space ? "cubic" : "square", size, space ? "" : "thickness: 0.3,", space ? 4.0 : 6.4, space ? 0.8 : 0.1,
               space ? "3-D" : "plane stress", rest);
  model->threads = 1;
  return model;
}

static double tip_of(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  double farthest = 0, sum = 0;
  int64_t count = 0;
  for (int64_t n = 0; n < p->count; ++n) farthest = larger_of(farthest, p->position[0][p->place_of[n]]);
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] > farthest - 1e-6) {
      sum += p->displacement.row[1][p->place_of[n]];
      ++count;
    }
  return sum / (double)count;
}

static void a_cantilever_bends_and_shears_like_a_beam(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    double found[3], off[2];
    for (int fine = 0; fine < 2; ++fine) {
      const double size = fine ? 0.1 : 0.2, length = (space ? 4.0 : 6.4) - size, depth = 0.8,
                   width = space ? 0.8 : thick, shear = young / 2.4 * 5 / 6 * width * depth,
                   wanted = 1e-4 * (pow(length, 3) / (3 * young * width * pow(depth, 3) / 12) + length / shear);
      for (int way = 0; way < (fine ? 3 : 1); ++way) {
        static const char *const ways[] = {"equations: direct", "equations: automatic",
                                           "method: relaxation, relaxation iterations: 100"};
        char rest[300];
        snprintf(rest, sizeof rest,
                 ", {on: {face: x+, layers: 1}, force: [0, 1e-4, 0]}]\n"
                 "solve: {static: {increments: 1, residual: 1e-10, %s}}",
                 ways[way]);
        breccia_model *model = cantilever(space, size, rest);
        step_surely(model, INT64_MAX);
        found[way] = tip_of(model);
        assert_balanced(model, 1e-6);
        breccia_model_destroy(&model);
      }
      off[fine] = found[0] / wanted - 1;
    }
    print_message("%s: off by %.4f, of half the spacing %.4f\n", space ? "space" : "plane", off[0], off[1]);
    assert_near(off[1] / off[0], 0.5, 0.1); /* surfaces of a lattice are softer */
    assert_near(2 * off[1] - off[0], 0, 0.05);
    assert_near(found[1] / found[0], 1, 1e-7);
    assert_near(found[2] / found[0], 1, 1e-7);
  }
}

/** What comes to rest in damped explicit steps is what statics find. */
static void explicit_steps_come_to_the_rest_that_statics_find(void **state)
{
  (void)state;
  double found[2], turned[2];
  for (int way = 0; way < 2; ++way) {
    char rest[300];
    snprintf(rest, sizeof rest, ", {on: {nearest: [9, 0, 0]}, force: [0.02, 0.2, 0]}]\nsolve: {%s}",
             way ? "explicit: {end time: 100, local damping: 0.8, rest: 1e-9}" : "static: {increments: 4}");
    breccia_model *model = beam(false, 6, rest);
    double rotation[3];
    step_surely(model, way ? 200000 : INT64_MAX);
    rotation_of(model, last_of(model), rotation);
    found[way] = model->domain.particles->displacement.row[1][last_of(model)];
    turned[way] = rotation[2];
    breccia_model_destroy(&model);
  }
  assert_true(turned[0] > 0.1); /* so that the way to it is not straight */
  assert_near(found[1] / found[0], 1, 1e-5);
  assert_near(turned[1] / turned[0], 1, 1e-5);
}

/** At the limit of Poisson's ratio links are bars: rotations mean nothing, and stand in nobody's way. */
static void links_that_do_not_bend_find_rest(void **state)
{
  (void)state;
  static const char *const ways[] = {"equations: direct", "equations: conjugate gradients", "method: relaxation"};
  double found[3];
  for (int way = 0; way < 3; ++way) {
    breccia_model *model =
        model_of(UNITS MATERIAL("0.25") "body: {b: {material: m, lattice: face-centred cubic, spacing: 0.1, shape: "
                                        "{box: {particles: [6, 4, 3]}}}}\n"
                                        "peridynamics: {formulation: micropolar, space: 3-D}\n"
                                        "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x+, "
                                        "layers: 1}, force: [0, 1e-3, 0]}]\n"
                                        "solve: {static: {increments: 1, residual: 1e-10, %s}}\n",
                 ways[way]);
    model->threads = 1;
    const Particles *p = model->domain.particles;
    step_surely(model, INT64_MAX);
    found[way] = tip_of(model);
    for (int k = 0; k < 4; ++k)
      for (int64_t n = 0; n < p->count; ++n) assert_near(p->orientation[k][p->place_of[n]], k == 0, 1e-9);
    breccia_model_destroy(&model);
  }
  assert_true(found[0] > 0);
  for (int way = 1; way < 3; ++way) assert_near(found[way] / found[0], 1, 1e-7);
}

/** What a clamp exerts on a cantilever, with the moments of its rotations: what stands against the load, force and moment. */
static void a_clamp_carries_the_moment(void **state)
{
  (void)state;
  for (int way = 0; way < 2; ++way) {
    breccia_model *model = beam(way, 7,
                                ", {on: {nearest: [9, 0, 0]}, force: [0, 1e-7, 0]}, {on: {nearest: [9, 0, 0]}, moment: "
                                "[0, 0, 2e-8]}]\nsolve: {static: {increments: 1, residual: 1e-9}}");
    const Particles *p = model->domain.particles;
    double about[3];
    Reactions reactions = {0};
    step_surely(model, INT64_MAX);
    for (int k = 0; k < 3; ++k) about[k] = p->position[k][p->place_of[0]];
    assert_int_equal(reactions_create(&reactions, p, NULL), 0);
    const Wrench sum = reactions_sum(&reactions, &model->solver, NULL, NULL, about);
    reactions_destroy(&reactions);
    assert_near(sum.force[1], -1e-7, 1e-14);
    assert_near(sum.moment[2], -1e-7 * 6 * spacing - 2e-8, 1e-13);
    Rest rest;
    assert_int_equal(rest_find(&model->solver, &rest, NULL), 0);
    assert_true(rest.reached);
    breccia_model_destroy(&model);
  }
}

/** A moment that nothing balances is no rest. */
static void moments_out_of_balance_are_no_rest(void **state)
{
  (void)state;
  breccia_model *model = beam(false, 3,
                              ", {on: {nearest: [9, 0, 0]}, moment: [0, 0, 1e-7]}]\n"
                              "solve: {explicit: {steps: 1, local damping: 0.8}}");
  Rest rest;
  step_surely(model, 1);
  assert_int_equal(rest_find(&model->solver, &rest, NULL), 0);
  assert_false(rest.reached);
  assert_true(rest.unbalanced > 0.5);
  breccia_model_destroy(&model);
}

/** A plate or block torn apart with turning grips, at rest or in long steps. */
static breccia_model *torn(bool space, const char *solver)
{
  return model_of(
      UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {particles: "
                            "%s}}}}\n"
                            "peridynamics: {formulation: micropolar, space: %s}\nfailure: {critical "
                            "stretch: 0.01}\n"
                            "loads: [{on: {face: x-, layers: 1}, displacement: [0, 0, 0]}, {on: {face: x-, "
                            "layers: 1}, rotation: [0, 0, 0]}, {on: {face: x+, layers: 1}, displacement: "
                            "[0.012, 0.02, 0], history: {ramp to: 1}}, {on: {face: x+, layers: 1}, rotation: "
                            "[free, free, -0.1], history: {ramp to: 1}}]\nsolve: {%s}\n",
      space ? "face-centred cubic" : "hexagonal", space ? "" : "thickness: 0.3,", space ? "[6, 3, 2]" : "[8, 4]",
      space ? "3-D" : "plane stress", solver);
}

/** Links break at rest and in long steps, the books are balanced, and the same bits come from a state that was taken up and for any number of threads. */
static void steps_are_the_same_again_and_for_any_number_of_threads(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 12}", "static: {increments: 12, method: relaxation}",
                                        "implicit: {end time: 1.2, time step: 0.1, damping: 3, local error: 1}"};
  for (int space = 0; space < 2; ++space)
    for (int s = 0; s < 3; ++s) {
      breccia_model *model = torn(space, solvers[s]), *other = torn(space, solvers[s]);
      const Particles *p = model->domain.particles, *q = other->domain.particles;
      model->threads = 1;
      other->threads = 3;
      step_surely(model, 9);
      StateCopy before = state_of(model);
      step_surely(model, 3);
      StateList list = {0};
      Team *team = team_use(model->team);
      model_state(model, &list);
      assert_int_equal(state_return(&before, &list, NULL), 0);
      team_use(team);
      state_list_destroy(&list);
      step_surely(model, 3);
      step_surely(other, 12);
      if (breccia_model_broken_bonds(model) < 3)
        fail_msg("%d, %s: %lld bonds", space, solvers[s], (long long)breccia_model_broken_bonds(model));
      for (int k = 0; k < p->space.rows; ++k)
        assert_memory_equal(p->displacement.row[k], q->displacement.row[k], sizeof(double) * (size_t)p->places);
      for (int k = 0; k < 4 && space; ++k)
        assert_memory_equal(p->orientation[k], q->orientation[k], sizeof(double) * (size_t)p->places);
      assert_balanced(model, 1e-2);
      state_copy_destroy(&before);
      breccia_model_destroy(&model);
      breccia_model_destroy(&other);
    }
}

/* ---- vibrations ---- */

static Modes modes_of(breccia_model *model, int count)
{
  Modes modes = {0};
  Error *error = breccia_error_create();
  if (modes_find(&model->domain, &model->loading, count, &modes, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return modes;
}

/** A long row of links vibrates like the beam of its EI and mass: first and second bending, f = b^2 sqrt(EI / m) / 2 pi l^2. */
static void a_row_of_links_vibrates_like_a_beam(void **state)
{
  (void)state;
  const double roots[] = {1.87510407, 4.69409113};
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = beam(space, 41, "]\nsolve: {static: {}}");
    const Links links = links_of(model);
    const double l = 40 * spacing, per_length = links.mass / spacing;
    Modes modes = modes_of(model, space ? 4 : 2);
    assert_int_equal(modes.rigid, 0);
    for (int n = 0; n < modes.count; ++n) { /* in space each stands twice */
      const double b = roots[space ? n / 2 : n], f = b * b * sqrt(links.bending / per_length) / (2 * pi * l * l);
      /* The mass is in the particles, half of one more than there is at the tip; they spin, as Rayleigh's beam. */
      if (!(fabs(modes.modes[n].frequency / f - 1) <= 0.06))
        fail_msg("mode %d: %g, beam %g", n, modes.modes[n].frequency, f);
    }
    modes_destroy(&modes);
    breccia_model_destroy(&model);
  }
}

/** The first mode of a cantilever of a lattice, with Timoshenko's correction; and the free body has three motions as a whole, in which particles turn with it. */
static void a_cantilever_vibrates_like_a_beam(void **state)
{
  (void)state;
  const double depth = 0.8, length = 6.3, radius = depth / sqrt(12), first = 1.87510407,
               bending = first * first / (2 * pi * length * length) * sqrt(young / density) * radius,
               wanted = bending * (1 - first * first / 2 * pow(radius / length, 2) * (1 + 2.4 / (5.0 / 6)));
  breccia_model *model = cantilever(false, 0.1, "]\nsolve: {static: {}}");
  Modes modes = modes_of(model, 2);
  print_message("first mode %g, beam %g\n", modes.modes[0].frequency, wanted);
  assert_near(modes.modes[0].frequency / wanted, 1, 0.05);
  assert_near(modes.modes[0].share[1], 0.613, 0.02);
  modes_destroy(&modes);
  breccia_model_destroy(&model);

  model = model_of(UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.3, "
                                         "shape: {box: {particles: [12, 6]}}}}\n"
                                         "peridynamics: {formulation: micropolar, space: plane stress}\n"
                                         "solve: {explicit: {steps: 1}}\n");
  modes = modes_of(model, 5);
  assert_int_equal(modes.rigid, 3);
  for (int n = 0; n < 3; ++n) { /* every particle turns alike, by half of the curl of how it moves */
    const Particles *p = model->domain.particles;
    double *const *u = modes.modes[n].displacement.row;
    const int32_t a = p->place_of[0], b = p->place_of[11];
    const double turned = (u[1][b] - u[1][a]) / (p->position[0][b] - p->position[0][a]);
    for (int64_t i = 0; i < p->count; ++i) assert_near(u[p->space.rotation][p->place_of[i]], turned, 1e-6);
  }
  modes_destroy(&modes);
  breccia_model_destroy(&model);
}

/* ---- long steps ---- */

/** A free body that spins keeps its speed and, with the average acceleration, its energy and moment of momentum. */
static void a_free_body_spins_on_in_long_steps(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    const char *rest = space ? "loads: [{initial velocity: {translation: [1, 0, 0], rotation: [3, 4, 12]}}]\n"
                               "solve: {implicit: {end time: 0.2, time step: 2e-3, residual: 1e-10}}\n"
                             : "loads: [{initial velocity: {translation: [1, 2], rotation: [0, 0, 12]}}]\n"
                               "solve: {implicit: {end time: 0.2, time step: 2e-3, residual: 1e-10}}\n";
    breccia_model *model =
        model_of(UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: "
                                       "{particles: %s}}}}\nperidynamics: {formulation: micropolar, space: %s}\n%s",
                 space ? "face-centred cubic" : "hexagonal", space ? "" : "thickness: 0.3,",
                 space ? "[4, 3, 2]" : "[6, 4]", space ? "3-D" : "plane stress", rest);
    model->threads = 1;
    Sums sums[2];
    for (int k = 0; k < 2; ++k) {
      step_surely(model, k ? INT64_MAX : 1);
      sums[k] = sums_of(model);
    }
    for (int axis = 0; axis < 3; ++axis) {
      assert_near(sums[1].momentum[axis], sums[0].momentum[axis], 1e-8);
      assert_near(sums[1].turn[axis] / sums[0].turn[2], sums[0].turn[axis] / sums[0].turn[2], 1e-3);
    }
    assert_balanced(model, 2e-3);
    breccia_model_destroy(&model);
  }
}

/** A cantilever let go swings in its first mode with the period of closed forms. */
static void a_cantilever_swings_at_its_first_frequency(void **state)
{
  (void)state;
  breccia_model *model = beam(false, 11,
                              ", {on: {nearest: [9, 0, 0]}, force: [0, 1e-5, 0]}]\n"
                              "solve: {implicit: {end time: 8, time step: 0.02, local error: 1}}");
  Modes modes = modes_of(model, 1);
  const double period = 1 / modes.modes[0].frequency;
  const Particles *p = model->domain.particles;
  const int32_t tip = last_of(model);
  const Links links = links_of(model);
  double most = 0, at = 0, mean = 0;
  int64_t steps = 0;
  modes_destroy(&modes);
  while (model->solver.clock.time < fmin(period, 7.9)) {
    step_surely(model, 1);
    mean += p->displacement.row[1][tip];
    ++steps;
    if (p->displacement.row[1][tip] > most) {
      most = p->displacement.row[1][tip];
      at = model->solver.clock.time;
    }
  }
  const double l = 10 * spacing, still = 1e-5 * l * l * l / (3 * links.bending);
  print_message("period %g, most at %g, mean %g of the deflection at rest\n", period, at, mean / (double)steps / still);
  assert_true(period < 7.9);
  assert_near(at / period, 0.5, 0.06);
  assert_near(mean / (double)steps / still, 1, 0.03);
  assert_near(most / still, 2, 0.15);
  assert_balanced(model, 1e-5);
  breccia_model_destroy(&model);
}

/** Damping by stiffness takes beta w / 2 of critical from the first mode of a row, in explicit steps as in implicit ones, and all of it is in the books. */
static void stiffness_damps_what_turns(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space)
    for (int way = 0; way < 2; ++way) {
      char rest[400];
      const double share = 0.05;
      breccia_model *model = beam(space, 5, "]\nsolve: {static: {}}");
      Modes modes = modes_of(model, 1);
      const double w = 2 * pi * modes.modes[0].frequency;
      modes_destroy(&modes);
      breccia_model_destroy(&model);
      snprintf(rest, sizeof rest,
               ", {on: {nearest: [9, 0, 0]}, force: [0, 1e-5, 0]}]\n"
               "solve: {%s: {end time: %g, stiffness damping: %g%s}}",
               way ? "implicit" : "explicit", 4 * pi / w, 2 * share / w,
               way ? ", time step: 0.002, local error: 1" : "");
      model = beam(space, 5, rest);
      const Particles *p = model->domain.particles;
      const int32_t tip = last_of(model);
      const double l = 4 * spacing, still = 1e-5 * l * l * l / (3 * links_of(model).bending);
      double most[2] = {0};
      while (model->solver.clock.time < 3.9 * pi / w) {
        step_surely(model, 1);
        const int turn = model->solver.clock.time > 2 * pi / w;
        most[turn] = larger_of(most[turn], p->displacement.row[1][tip] / still - 1);
      }
      const double decay = log(most[0] / most[1]) / (2 * pi * share / sqrt(1 - share * share));
      print_message("%s, %s: decay %.4f of what is wanted\n", space ? "space" : "plane", way ? "implicit" : "explicit",
                    decay);
      assert_near(decay, 1, 0.05);
      assert_balanced(model, 1e-3);
      breccia_model_destroy(&model);
    }
}

/** What is clamped and turned in space turns all of the body with it, increment by increment, through more than half a turn. */
static void a_turned_clamp_turns_the_body(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(UNITS MATERIAL("0.2") "body: {b: {material: m, lattice: face-centred cubic, spacing: 0.1, shape: {box: "
                                     "{particles: [5, 1, 1]}}}}\nperidynamics: {formulation: micropolar, space: 3-D}\n"
                                     "loads: [{on: {nearest: [0, 0, 0]}, displacement: [0, 0, 0]}, {on: {nearest: [0, "
                                     "0, 0]}, rotation: [2.4 rad, 0, 3.2 rad], history: {ramp to: 1}}]\n"
                                     "solve: {static: {increments: 9}}\n");
  model->threads = 1;
  const Particles *p = model->domain.particles;
  step_surely(model, INT64_MAX);
  const double axis[3] = {0.6, 0, 0.8}, angle = 4, c = cos(angle), s = sin(angle);
  for (int n = 0; n < 5; ++n) {
    const int32_t i = p->place_of[n], first = p->place_of[0];
    const double x = p->position[0][i] - p->position[0][first];
    const double turned[3] = {x * (c + (1 - c) * axis[0] * axis[0]), x * s * axis[2], x * (1 - c) * axis[0] * axis[2]};
    double rotation[3];
    for (int k = 0; k < 3; ++k)
      assert_near(p->position[k][i] + p->displacement.row[k][i] - p->position[k][first], turned[k], 1e-8);
    rotation_of(model, i, rotation);
    for (int k = 0; k < 3; ++k) assert_near(rotation[k], (angle - 2 * pi) * axis[k], 1e-7);
  }
  breccia_model_destroy(&model);
}

/** Broken links are none, however far apart their ends have come: series in their lengths would be beyond all numbers. */
static void pieces_that_fly_apart_go_on_for_ever(void **state)
{
  (void)state;
  static const char *const bodies[] = {
      "lattice: square, thickness: 0.3, spacing: 0.1, shape: {box: {particles: [10, 5]}}}}\n"
      "peridynamics: {formulation: micropolar, space: plane strain}\n"
      "loads: [{on: {face: x-, layers: 5}, velocity: [0, 0]}, {on: {face: x+, layers: 5}, velocity: "
      "[1e4, 0]}]\n",
      "lattice: cubic, spacing: 0.1, shape: {box: {particles: [10, 4, 4]}}}}\n"
      "peridynamics: {formulation: micropolar, space: 3-D}\n"
      "loads: [{on: {face: x-, layers: 5}, velocity: [0, 0, 0]}, {on: {face: x+, layers: 5}, velocity: "
      "[1e4, 0, 0]}]\n"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m =
        model_of(UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.1}}\n"
                       "failure: {critical stretch: 0.01, near grips: break}\n"
                       "body: {b: {material: m, %s"
                       "solve: {explicit: {time step: 1e-4, steps: 1000}}\n",
                 bodies[k]);
    const Particles *p = m->domain.particles;
    breccia_error *error = breccia_error_create();
    if (breccia_model_step(m, 1000, error)) fail_msg("%s", breccia_error_text(error));
    breccia_error_destroy(&error);
    assert_true(m->domain.broken_count > 0);
    for (int64_t n = 0; n < p->count; ++n)
      for (int row = 0; row < p->space.rows; ++row) assert_float_equal(p->internal.row[row][p->place_of[n]], 0, 1e-6);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pieces_that_fly_apart_go_on_for_ever),
      cmocka_unit_test(a_row_of_links_at_rest_is_a_beam),
      cmocka_unit_test(a_row_of_links_is_rolled_into_a_circle),
      cmocka_unit_test(a_cantilever_bends_and_shears_like_a_beam),
      cmocka_unit_test(explicit_steps_come_to_the_rest_that_statics_find),
      cmocka_unit_test(links_that_do_not_bend_find_rest),
      cmocka_unit_test(a_clamp_carries_the_moment),
      cmocka_unit_test(moments_out_of_balance_are_no_rest),
      cmocka_unit_test(steps_are_the_same_again_and_for_any_number_of_threads),
      cmocka_unit_test(a_row_of_links_vibrates_like_a_beam),
      cmocka_unit_test(a_cantilever_vibrates_like_a_beam),
      cmocka_unit_test(a_free_body_spins_on_in_long_steps),
      cmocka_unit_test(a_cantilever_swings_at_its_first_frequency),
      cmocka_unit_test(stiffness_damps_what_turns),
      cmocka_unit_test(a_turned_clamp_turns_the_body),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

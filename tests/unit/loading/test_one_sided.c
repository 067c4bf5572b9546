/* One-sided supports: beams that lift off, eccentric loads on a bed without tension, bars that bounce. References are
 * closed forms, and the bodies with a two-sided support and without a support. */
#include "support.h"

#include "loading/constraint.h"
#include "model/plausibility.h"
#include "model/run.h"
#include "solver/reactions.h"

#define MATERIAL                                                                                                       \
  "units: {length: mm, force: kN, time: ms}\n"                                                                         \
  "materials: {m: {model: elastic, density: 2400 kg/m3, Young modulus: 30 GPa, Poisson ratio: 0.2}}\n"

/** Returns the force with which a load acts on the body, and its moment about the origin. */
static Wrench wrench_of(const breccia_model *model, const char *load)
{
  Reactions reactions = {0};
  assert_int_equal(reactions_create(&reactions, model->domain.particles, NULL), 0);
  const Wrench sum = reactions_sum(&reactions, &model->solver, NULL, load, (double[3]){0});
  reactions_destroy(&reactions);
  return sum;
}

static double moved_at(const breccia_model *m, int axis, double x, double y)
{
  const Particles *p = m->domain.particles;
  return p->displacement.row[axis][particles_nearest(p, (double[]){x, y, 0})];
}

static const Constraint *one_sided_of(const breccia_model *m)
{
  for (const Constraint *c = m->loading.constraints; c < m->loading.constraints + m->loading.constraint_count; ++c)
    if (c->one_sided) return c;
  fail_msg("there is no one-sided motion");
  return NULL;
}

static int64_t open_entries(const breccia_model *m)
{
  const OneSided *q = one_sided_of(m)->one_sided;
  int64_t open = 0;
  for (int64_t n = 0; n < q->count; ++n) open += q->open[n];
  return open;
}

/* ---- a beam on three supports ---- */

/* The weight of the beam presses it on the middle support, and a force at the middle lifts it off. */
#define BEAM                                                                                                           \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [410, "        \
  "40]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress, strain: small}\n"                                  \
  "loads:\n  - {on: {nearest: [5, 5]}, displacement: [0, 0]}\n  - {on: {nearest: [405, 5]}, displacement: [free, "     \
  "0]}\n  - {on: {all: yes}, body force: [0, -1e-5]}\n"
#define MIDDLE "  - {name: middle, on: {nearest: [205, 5]}, displacement: [free, 0]%s}\n"
#define LIFT "  - {on: {nearest: [205, 5]}, force: [0, %.17g], history: {table: [[0, 0], [1, 1], [2, 0]]}}\n"

static const double weight = 1e-5 * 410 * 40 * 50; /* kN */

/** Returns the displacement of the middle of the beam under weight and a force, without the middle support. */
static double free_deflection(double lift)
{
  breccia_model *m = model_of(BEAM LIFT "solve: {static: {end time: 1, increments: 1}}\n", lift);
  step_surely(m, 1);
  const double moved = moved_at(m, 1, 205, 5);
  breccia_model_destroy(&m);
  return moved;
}

static void a_beam_lifts_off_its_middle_support(void **state)
{
  (void)state;
  const double bent = -free_deflection(0), compliance = (free_deflection(0.1) + bent) / 0.1;
  const double bears = bent / compliance; /* reaction of a two-sided middle support, which cancels the deflection */
  assert_near(bears, 0.625 * weight * 400 / 410, 0.03 * bears); /* a continuous beam of two spans */
  static const char *const solvers[] = {"increments: 8", "increments: 8, equations: conjugate gradients",
                                        "increments: 8, equations: minimal residuals",
                                        "increments: 4, method: relaxation"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k) {
    breccia_model *m =
        model_of(BEAM MIDDLE LIFT "solve: {static: {end time: 2, %s}}\n", ", only presses: yes", 2 * bears, solvers[k]);
    while (!m->solver.clock.ended) {
      step_surely(m, 1);
      const double time = m->solver.clock.time, lift = 2 * bears * (time > 1 ? 2 - time : time);
      const double presses = wrench_of(m, "middle").force[1], moved = moved_at(m, 1, 205, 5);
      assert_near(presses, fmax(0, bears - lift), 1e-5 * bears);
      assert_near(moved, compliance * fmax(0, lift - bears), 1e-5 * bent);
      assert_true(presses >= 0);
    }
    assert_balanced(m, 1e-6);
    breccia_model_destroy(&m);
  }
}

/** A support that begins in a later stage is at the current position of the body. */
static void a_support_begins_where_the_body_is(void **state)
{
  (void)state;
  const double bent = -free_deflection(0), compliance = (free_deflection(0.1) + bent) / 0.1, bears = bent / compliance;
  breccia_model *m = model_of(BEAM MIDDLE "  - {name: lift, on: {nearest: [205, 5]}, force: [0, %.17g]}\n"
                                          "solve:\n  - {static: {increments: 2}}\n"
                                          "  - {static: {increments: 3}, without: [lift], loads: [{name: middle, on: "
                                          "{nearest: [205, 5]}, roller: [0, 1], only presses: yes}]}\n",
                              ", only presses: yes", 2 * bears);
  step_surely(m, 2);
  const double lifted = moved_at(m, 1, 205, 5);
  assert_near(lifted, compliance * bears, 1e-6 * lifted);
  step_surely(m, 3);
  assert_near(moved_at(m, 1, 205, 5), lifted, 1e-12);
  assert_near(wrench_of(m, "middle").force[1], 2 * bears, 1e-5 * bears);
  breccia_model_destroy(&m);
}

/** The work done on the body is recovered: a support that opens and closes does no work. */
static void lift_off_makes_no_energy(void **state)
{
  (void)state;
  breccia_model *m = model_of(BEAM MIDDLE LIFT "solve:\n  - {static: {end time: 2, increments: 40}}\n  - {static: {}, "
                                               "loads: [{name: lifted, on: {nearest: [205, 5]}, force: [0, 10], "
                                               "history: {table: [[0, 0], [0.5, 1], [1, 0]]}}]}\n",
                              ", only presses: yes", 8.0);
  step_surely(m, 20);
  const double most = solver_energy(&m->solver).stored;
  double before = NAN;
  for (int stage = 0; stage < 2; ++stage) {
    step_surely(m, stage ? 10 : 20);
    const Energy e = solver_energy(&m->solver);
    if (stage) assert_near(e.external, before, 1e-6 * most);
    before = e.external;
    assert_near(e.external, e.stored + e.damping, 1e-7 * most);
  }
  breccia_model_destroy(&m);
}

/* The beam upside down, in other units, and turned. */
static void other_views_of_a_beam_are_the_same(void **state)
{
  (void)state;
  breccia_model *m[4];
  m[0] = model_of(BEAM MIDDLE LIFT "solve: {static: {end time: 0.9, increments: 4}}\n", ", only presses: yes", 8.0);
  m[1] = model_of(
      MATERIAL "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, -40], to: "
               "[410, 0]}}}}\nperidynamics: {formulation: correspondence, space: plane stress, strain: small}\n"
               "loads:\n  - {on: {nearest: [5, -5]}, displacement: [0, 0]}\n  - {on: {nearest: [405, -5]}, "
               "displacement: [free, 0]}\n  - {on: {all: yes}, body force: [0, 1e-5]}\n"
               "  - {name: middle, on: {nearest: [205, -5]}, roller: [0, 1], only presses: yes}\n"
               "  - {on: {nearest: [205, -5]}, force: [0, -8], history: {ramp to: 1}}\n"
               "solve: {static: {end time: 0.9, increments: 4}}\n");
  m[2] = model_of(
      "units: {length: m, force: N, time: s}\n"
      "materials: {m: {model: elastic, density: 2400, Young modulus: 30e9, Poisson ratio: 0.2}}\n"
      "body: {b: {material: m, lattice: square, spacing: 0.01, thickness: 0.05, shape: {box: {from: [0, 0], to: [0.41, "
      "0.04]}}}}\nperidynamics: {formulation: correspondence, space: plane stress, strain: small}\n"
      "loads:\n  - {on: {nearest: [0.005, 0.005]}, displacement: [0, 0]}\n  - {on: {nearest: [0.405, 0.005]}, "
      "displacement: [free, 0]}\n  - {on: {all: yes}, body force: [0, -1e7]}\n"
      "  - {name: middle, on: {nearest: [0.205, 0.005]}, roller: [0, -3], only presses: yes}\n"
      "  - {on: {nearest: [0.205, 0.005]}, force: [0, 8000], history: {ramp to: 1}}\n"
      "solve: {static: {end time: 0.9, increments: 4}}\n");
  m[3] = model_of(
      MATERIAL "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: "
               "[40, 410]}}}}\nperidynamics: {formulation: correspondence, space: plane stress, strain: small}\n"
               "loads:\n  - {on: {nearest: [35, 5]}, displacement: [0, 0]}\n  - {on: {nearest: [35, 405]}, "
               "displacement: [0, free]}\n  - {on: {all: yes}, body force: [1e-5, 0]}\n"
               "  - {name: middle, on: {nearest: [35, 205]}, along: {direction: [2, 0], displacement: 0}, only "
               "presses: yes}\n  - {on: {nearest: [35, 205]}, force: [-8, 0], history: {ramp to: 1}}\n"
               "solve: {static: {end time: 0.9, increments: 4}}\n");
  for (int k = 0; k < 4; ++k) step_surely(m[k], 4);
  const double lifted = moved_at(m[0], 1, 205, 5);
  assert_true(lifted > 0 && open_entries(m[0]) == 1);
  assert_near(moved_at(m[1], 1, 205, -5), -lifted, 1e-8 * lifted);
  assert_near(1e3 * moved_at(m[2], 1, 0.205, 0.005), lifted, 1e-8 * lifted);
  assert_near(moved_at(m[3], 0, 35, 205), -lifted, 1e-8 * lifted);
  for (int k = 0; k < 4; ++k) breccia_model_destroy(&m[k]);
}

/* ---- eccentric loads ---- */

/* A stiff block 200 wide and 100 high, 50 thick. */
#define BLOCK                                                                                                          \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [200, "        \
  "100]}}}}\n"                                                                                                         \
  "peridynamics: {formulation: correspondence, space: plane stress, strain: small}\n"                                  \
  "loads:\n  - {on: {nearest: [105, 45]}, displacement: [0, free]}\n"

/** On a bed of springs without tension pressure falls along a straight line over 3 (B/2 - e), from 2 P / (3 (B/2 - e))
 * at the edge. */
static void a_bed_without_tension_takes_an_eccentric_load(void **state)
{
  (void)state;
  const double force = 0.01, stiffness = 0.1, e = 55, width = 3 * (100 - e), edge = 2 * force / width;
  static const char *const solvers[] = {"static: {increments: 1, equations: direct}",
                                        "static: {increments: 2, equations: conjugate gradients}",
                                        "static: {increments: 1, method: relaxation}",
                                        "implicit: {end time: 400, time step: 4, local error: 1, damping: 0.1 1/ms}"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k) {
    breccia_model *m = model_of(BLOCK "  - {on: {face: y-}, spring: {stiffness: %g, direction: [0, 1]}, only presses: "
                                      "yes}\n  - {on: {nearest: [155, 95]}, force: [0, %g]%s}\nsolve: {%s}\n",
                                stiffness, -force, k > 2 ? ", history: {ramp to: 100}" : "", solvers[k]);
    step_surely(m, 1000000);
    const double left = moved_at(m, 1, 5, 5), right = moved_at(m, 1, 195, 5), tilt = (left - right) / 190;
    const double settled = -(right - 5 * tilt), lifts = 200 - settled / tilt; /* at the edge; where the bed ends */
    assert_near(200 - lifts, width, 0.02 * width);
    assert_near(settled * stiffness / 200, edge, 0.02 * edge);
    breccia_model_destroy(&m);
  }
}

/** Rollers that only press: no particle is pulled or passes the base, and the resultant stands under the load. */
static void an_eccentric_load_tips_a_block_on_rollers(void **state)
{
  (void)state;
  for (int x = 115; x < 190; x += 20) {
    breccia_model *m = model_of(BLOCK "  - {name: base, on: {face: y-}, roller: [0, 1], only presses: yes}\n"
                                      "  - {on: {nearest: [%d, 95]}, force: [0, -10]}\nsolve: {static: {}}\n",
                                x);
    step_surely(m, 10);
    const Wrench w = wrench_of(m, "base");
    assert_near(w.force[1], 10, 1e-6);
    assert_near(w.moment[2], 10.0 * x, 0.1); /* lever arms are those of the deformed body */
    const Constraint *c = one_sided_of(m);
    for (int64_t n = 0; n < c->one_sided->count; ++n) {
      const double u = constraint_along(c, m->domain.particles->displacement.row, c->load->selection.places[n]);
      assert_true(c->one_sided->open[n] ? u >= -1e-9 : u == 0);
      assert_true(c->one_sided->open[n] ? c->one_sided->found[n] == 0 : c->one_sided->found[n] >= -1e-6);
    }
    assert_true(open_entries(m) > 0);
    breccia_model_destroy(&m);
  }
}

static void a_body_that_nothing_holds_down_flies_away(void **state)
{
  (void)state;
  breccia_model *m = model_of(BLOCK "  - {on: {face: y-}, roller: [0, 1], only presses: yes}\n"
                                    "  - {on: {face: y+}, force: [0, 1]}\nsolve: {static: {increments: 1}}\n");
  step_must_fail(m, "would have to pull|nothing holds the body against moving along y");
  breccia_model_destroy(&m);
}

static void what_only_presses_is_told(void **state)
{
  (void)state;
  breccia_model *m = model_of(BLOCK "  - {name: base, on: {face: y-}, roller: [0, 1], only presses: yes}\n"
                                    "  - {on: {nearest: [155, 95]}, force: [0, -10]}\nsolve: {static: {}}\n");
  Text text = {0};
  plausibility_describe(m, false, &text);
  holds_words(text_words(&text),
              "only presses, along +y, and each particle lets go|without the supports that only press, nothing "
              "holds the body against moving along y as a whole");
  text_free(&text);
  assert_true(open_entries(m) == 0);
  step_surely(m, 10);
  run_tell_loads(m, &text);
  holds_words(text_words(&text), "load 'base': roller|[0, 10, 0] kN, only presses: has let go of|of its 20 particles");
  text_free(&text);
  breccia_model_destroy(&m);
}

/** A jack that moves away from the body gives a warning; a jack that is held still or presses gives none. */
static void a_jack_that_moves_away_is_warned_of(void **state)
{
  (void)state;
  static const struct {
    double motion;
    bool warned;
  } jacks[] = {{0.1, true}, {-0.1, false}, {0, false}};
  for (size_t k = 0; k < sizeof jacks / sizeof *jacks; ++k) {
    breccia_model *m = model_of(BLOCK "  - {on: {face: y-}, displacement: [0, 0]}\n"
                                      "  - {name: jack, on: {face: y+}, displacement: [free, %g], only presses: yes, "
                                      "history: {ramp to: 1}}\nsolve: {static: {increments: 2}}\n",
                                jacks[k].motion);
    Text text = {0};
    step_surely(m, 10);
    run_tell_loads(m, &text);
    const bool warned = strstr(text_words(&text), "warning: load 'jack' only presses and never pressed");
    if (warned != jacks[k].warned) fail_msg("jack by %g: %s", jacks[k].motion, text_words(&text));
    text_free(&text);
    breccia_model_destroy(&m);
  }
}

/* ---- bars that bounce ---- */

/* Waves run at 1 m/s along a bar of 1 m and 1 kg that flies with 1e-3 m/s against a wall, which it reaches after 0.1 s.
 * It leaves the wall 2 s later with its momentum reversed. */
#define BAR                                                                                                            \
  "units: {length: m, force: N, time: s}\n"                                                                            \
  "materials: {m: {model: elastic-1d, density: 1, Young modulus: 1}}\n"                                                \
  "body: {bar: {material: m, lattice: line, spacing: 0.01, area: 1, shape: {box: {particles: [100, 1], first "         \
  "particle: [0.005, 0]}}}}\nperidynamics: {formulation: bond-based, space: 1-D, horizon: 1.5 spacings}\npictures: "   \
  "[]\n"                                                                                                               \
  "loads:\n  - {initial velocity: {translation: [-1e-3, 0]}}\n  - {name: wall, on: {face: x-}, displacement: [-1e-4, " \
  "free], only "                                                                                                       \
  "presses: yes}\n"

static void a_bar_bounces_off_a_wall(void **state)
{
  (void)state;
  static const char *const solvers[] = {"explicit: {end time: 2.6, time step: 2e-3}",
                                        "implicit: {end time: 2.6, time step: 4e-3, local error: 10}",
                                        "implicit: {end time: 2.6, time step: 4e-3, local error: 10, scheme: HHT}"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k) {
    breccia_model *m = model_of(BAR "solve: {%s}\n", solvers[k]);
    double impulse = 0, left = NAN, before = 0;
    while (!m->solver.clock.ended) {
      step_surely(m, 1);
      const double force = wrench_of(m, "wall").force[0], time = m->solver.clock.time;
      assert_true(force >= 0);
      if (time > 0.4 && time < 1.9) assert_near(force, 1e-3, 3e-4); /* rho c v A, with the ripple of a lattice */
      if (force > 0) left = time;
      impulse += (time - before) * force;
      before = time;
    }
    assert_near(left, 2.1, 0.06);
    assert_near(sums_of(m).momentum[0], 1e-3, 3e-5);
    assert_near(impulse, 2e-3, 6e-5);
    assert_true(open_entries(m) == 1);
    const Energy e = solver_energy(&m->solver);
    assert_near(e.kinetic + e.stored, 0.5e-6, 0.02 * 0.5e-6); /* a hundredth of the bar has a plastic impact */
    assert_near(e.external, 0, 0.005 * 0.5e-6);
    assert_balanced(m, 1e-3);
    breccia_model_destroy(&m);
  }
}

/* ---- jacks on plates that turn ---- */

#define JACK                                                                                                           \
  MATERIAL                                                                                                             \
  "body: {b: {material: m, lattice: square, spacing: 10, thickness: 50, shape: {box: {from: [0, 0], to: [400, "        \
  "80]}}}}\n"                                                                                                          \
  "peridynamics: {formulation: correspondence, space: plane stress, strain: small}\n"                                  \
  "selections: {jack: {face: y+, inside: {box: {from: [80, 0], to: [150, 80]}}}}\n"                                    \
  "loads:\n  - {on: {nearest: [5, 5]}, displacement: [0, 0]}\n  - {on: {nearest: [395, 5]}, displacement: [free, "     \
  "0]}\n"

/** A jack moves down, and up beyond its first contact. It presses like a two-sided jack, and then leaves the beam. */
static void a_jack_leaves_its_beam(void **state)
{
  (void)state;
  const char *const motion = "displacement: [free, -0.1], history: {table: [[0, 0], [8, 1], [16, -1]]}";
  static const char *const solvers[] = {"static: {end time: 16, increments: 8}",
                                        "static: {end time: 16, increments: 4, method: relaxation}",
                                        "implicit: {end time: 16, time step: 0.1, local error: 1, damping: 3 1/ms}",
                                        "explicit: {end time: 16, damping: 3 1/ms}"};
  for (size_t k = 0; k < sizeof solvers / sizeof *solvers; ++k) {
    breccia_model *m[2];
    for (int n = 0; n < 2; ++n)
      m[n] = model_of(JACK "  - {name: jack, on: jack, %s%s}\nsolve: {%s}\n", motion, n ? ", only presses: yes" : "",
                      solvers[k]);
    double largest = 0;
    while (!m[0]->solver.clock.ended && !m[1]->solver.clock.ended) {
      step_surely(m[0], 1);
      step_surely(m[1], 1);
      const double time = m[0]->solver.clock.time, held = wrench_of(m[0], "jack").force[1],
                   presses = wrench_of(m[1], "jack").force[1];
      if (k < 2 ? time < 12 : time > 5 && time < 11) {
        assert_near(m[1]->solver.clock.time, time, 1e-9);
        assert_near(presses, held, (k < 2 ? 1e-6 : 0.04) * fabs(largest));
      }
      largest = fmin(largest, held);
      assert_true(presses <= (k < 3 ? 1e-6 : 1e-3) * fabs(largest)); /* explicit steps let go a step late */
    }
    assert_near(wrench_of(m[1], "jack").force[1], 0, 1e-9 * fabs(largest));
    assert_near(moved_at(m[1], 1, 115, 75), 0, k < 2 ? 1e-7 : 2e-3);
    assert_near(moved_at(m[0], 1, 115, 75), 0.1, 1e-9);
    assert_balanced(m[1], k < 2 ? 1e-6 : 1e-3);
    breccia_model_destroy(&m[0]);
    breccia_model_destroy(&m[1]);
  }
}

/* ---- bitwise reproducibility ---- */

static breccia_model *lifted_beam(int threads)
{
  return model_on(threads,
                  BEAM MIDDLE LIFT "solve:\n  - {static: {end time: 2, increments: 8}}\n  - {explicit: {steps: 40}, "
                                   "loads: [{on: {all: yes}, body force: [0, 1e-4]}]}\n",
                  ", only presses: yes", 8.0);
}

static breccia_model *relaxed_block(int threads)
{
  return model_on(threads, BLOCK "  - {on: {face: y-}, roller: [0, 1], only presses: yes}\n"
                                 "  - {on: {nearest: [155, 95]}, force: [0, -10], history: {ramp to: 0.5}}\n"
                                 "solve:\n  - {static: {increments: 3, method: relaxation}}\n  - {implicit: {end time: "
                                 "1, time step: 0.05, local error: 1}}\n");
}

static breccia_model *shaken_block(int threads)
{
  return model_on(threads, BLOCK "  - {on: {face: y-}, roller: [0, 1], only presses: yes}\n"
                                 "  - {on: {nearest: [155, 95]}, force: [0, -1], history: {table: [[0, 0], [0.1, 1], "
                                 "[0.2, -1], [0.3, 2], [9, 2]]}}\n"
                                 "solve: {implicit: {end time: 1, time step: 0.02, scheme: HHT, local error: 1}}\n");
}

static breccia_model *struck_beam(int threads)
{
  return model_on(threads, JACK "  - {name: jack, on: jack, displacement: [free, -0.02], only presses: yes, history: "
                                "{table: [[0, 0], [0.02, 1], [0.04, -1], [0.3, 3]]}}\n"
                                "solve:\n  - {explicit: {steps: 60}}\n  - {implicit: {end time: 0.4, time step: 0.01, "
                                "local error: 1}}\n");
}

static breccia_model *bouncing_bar(int threads)
{
  return model_on(threads, BAR "solve: {explicit: {steps: 600}}\n");
}

static void threads_and_restarts_change_no_bit(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(lifted_beam, 5, 20);
  assert_same_bits_by_threads_and_restart(relaxed_block, 2, 6);
  assert_same_bits_by_threads_and_restart(shaken_block, 9, 16);
  assert_same_bits_by_threads_and_restart(bouncing_bar, 250, 500);
  for (int half = 10; half < 60; half += 24) assert_same_bits_by_threads_and_restart(struck_beam, half, 70);
}

/* ---- refused decks ---- */

static void what_cannot_only_press_is_refused(void **state)
{
  (void)state;
  static const char *const decks[][2] = {
      {BEAM "  - {on: {nearest: [105, 25]}, displacement: [free, 0], only presses: yes}\nsolve: {static: {}}\n",
       "only presses: the body lies on both sides"},
      {BEAM "  - {on: {nearest: [205, 5]}, displacement: [0, 0], only presses: yes}\nsolve: {static: {}}\n",
       "only presses: its motion is to be prescribed in one direction, and here it is in 2"},
      {BEAM "  - {on: {nearest: [205, 5]}, force: [0, 1], only presses: yes}\nsolve: {static: {}}\n",
       "only presses: only of a prescribed displacement"},
      {BEAM "  - {on: {face: x-}, support: {held: across}, only presses: yes}\nsolve: {static: {}}\n",
       "only presses: only of|outermost layer by a 'roller'"},
      {BEAM "  - {on: {nearest: [205, 5]}, spring: {stiffness: 1}, only presses: yes}\nsolve: {static: {}}\n",
       "only presses|give its 'direction'"},
      {BEAM "  - {on: {nearest: [205, 5]}, displacement: [free, 0], only presses: yes}\n"
            "  - {on: {nearest: [205, 5]}, tie: {to: {nearest: [105, 25]}}}\nsolve: {static: {}}\n",
       "tie: particle|under a support that only presses"},
      {BEAM "  - {on: {nearest: [205, 5]}, displacement: [free, -1], only presses: yes, history: {controlled: yes}}\n"
            "solve: {static: {control: {displacement of: {nearest: [205, 5]}, direction: [0, -1], to: 1}}}\n",
       "only presses: the factor of this load is found by control"},
  };
  for (size_t k = 0; k < sizeof decks / sizeof *decks; ++k) {
    char *words = refusal_of(decks[k][0]);
    holds_words(words, decks[k][1]);
    free(words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_beam_lifts_off_its_middle_support),
      cmocka_unit_test(a_support_begins_where_the_body_is),
      cmocka_unit_test(lift_off_makes_no_energy),
      cmocka_unit_test(other_views_of_a_beam_are_the_same),
      cmocka_unit_test(a_bed_without_tension_takes_an_eccentric_load),
      cmocka_unit_test(an_eccentric_load_tips_a_block_on_rollers),
      cmocka_unit_test(a_body_that_nothing_holds_down_flies_away),
      cmocka_unit_test(what_only_presses_is_told),
      cmocka_unit_test(a_jack_that_moves_away_is_warned_of),
      cmocka_unit_test(a_bar_bounces_off_a_wall),
      cmocka_unit_test(a_jack_leaves_its_beam),
      cmocka_unit_test(threads_and_restarts_change_no_bit),
      cmocka_unit_test(what_cannot_only_press_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Pieces of a body at rest, each of which must be held: refused, joined, cut off by a crack. */
#include "support.h"

#include "solver/pieces.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define IN_PLANE UNITS SOFT_SOLID "peridynamics: {formulation: correspondence, space: plane stress, horizon: 0.3015}\n"
#define SQUARE "material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: "

/** Two blocks, the right one a gap away from the left one, which is held; and further lines of the deck. */
static breccia_model *pair_of(double gap, const char *more)
{
  return model_of(IN_PLANE "body:\n"
                           "  left: {" SQUARE "{box: {from: [0, 0], to: [0.8, 0.5]}}}\n"
                           "  right: {" SQUARE "{box: {from: [%g, 0], to: [%g, 0.5]}}}\n%s",
                  0.8 + gap, 1.5 + gap, more);
}

/** Steps a model until a stage is refused for these words. */
static void stage_is_refused(breccia_model *m, const char *words)
{
  Error *error = breccia_error_create();
  assert_int_equal(breccia_model_step(m, INT64_MAX, error), BRECCIA_USER_ERROR);
  holds_words(breccia_error_text(error), words);
  breccia_error_destroy(&error);
  breccia_model_destroy(&m);
}

static void pair_is_refused(double gap, const char *more, const char *words)
{
  char deck[2000];
  snprintf(deck, sizeof deck,
           IN_PLANE "body:\n"
                    "  left: {" SQUARE "{box: {from: [0, 0], to: [0.8, 0.5]}}}\n"
                    "  right: {" SQUARE "{box: {from: [%g, 0], to: [%g, 0.5]}}}\n%s",
           0.8 + gap, 1.5 + gap, more);
  char *refusal = refusal_of(deck);
  holds_words(refusal, words);
  free(refusal);
}

#define HELD "  - {on: {block: left, face: x-, layers: 2}, displacement: [0, 0]}\n"
#define CUT "cracks: [{cut: {line: [[0.8, -1], [0.8, 1]]}}]\n"
#define SOLVE "solve: {static: {increments: 1}}\n"

static void each_piece_must_be_held(void **state)
{
  (void)state;
  const char *const none = "loads:\n" HELD SOLVE;
  breccia_model_destroy(&(breccia_model *){pair_of(0, none)}); /* bonds join them */
  pair_is_refused(0.5, none,
                  "static: nothing holds a piece of 35 particles, with particle 40 at [1.35, 0.05, 0], against moving "
                  "along x as a whole; hold it by a support|or join it to the rest by bonds, ties or 'contact'");
  /* Rollers that held one body hold two pieces not. */
  pair_is_refused(0.5, "loads:\n" HELD "  - {on: {block: right, face: y-, layers: 1}, roller: [0, 1]}\n" SOLVE,
                  "a piece of 35 particles|against moving along x");
  /* Images beyond a plane of symmetry are neither counted nor named. */
  pair_is_refused(0.5, "loads:\n" HELD "  - {on: {block: right, face: y-}, support: {held: across}}\n" SOLVE,
                  "a piece of 35 particles|at [1.35, 0.05, 0], against moving along x");
  pair_is_refused(0.5, "loads:\n" HELD "  - {on: {nearest: [2, 0.5]}, displacement: [0, 0]}\n" SOLVE,
                  "a piece of 35 particles|against moving about z");
  pair_is_refused(0.5, "loads:\n  - {on: {block: right, face: x+, layers: 1}, displacement: [0, 0]}\n" SOLVE,
                  "a piece of 40 particles, with particle 0 at [0.05, 0.05, 0]");
  pair_is_refused(0.5, "loads:\n  - {on: {all: yes}, gravity: [0, -9.81]}\n" SOLVE,
                  "a piece of 40 particles|nor 1 smaller ones");
}

static void what_joins_pieces_holds_them(void **state)
{
  (void)state;
  static const struct {
    double gap;
    const char *more;
  } cases[] = {
      {0.5, "loads:\n" HELD "  - {on: {block: right, face: x+, layers: 1}, displacement: [0.01, 0]}\n" SOLVE},
      {0.5, "loads:\n" HELD "  - {on: {block: right}, spring: {stiffness: 1}}\n" SOLVE},
      {0.5, "selections: {last: {block: left, face: x+, layers: 1}}\nloads:\n" HELD
            "  - {on: {block: right, face: x-, layers: 1}, tie: {to: last}}\n" SOLVE},
      {0, CUT "bars: {b: {points: [[0.4, 0.25], [1.3, 0.25]], diameter: 0.01, material: m}}\nloads:\n" HELD SOLVE},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = pair_of(cases[k].gap, cases[k].more);
    breccia_model_destroy(&m);
  }
}

static void contact_joins_what_touches(void **state)
{
  (void)state;
  const char *const pressed = CUT "%sloads:\n" HELD "  - {on: {block: right, face: x+, layers: 1}, traction: [-2, 0]}\n"
                                  "  - {on: {block: right, face: y-, layers: 1}, roller: [0, 1]}\n" SOLVE;
  char more[1000];
  snprintf(more, sizeof more, pressed, "");
  pair_is_refused(0, more, "a piece of 35 particles");
  snprintf(more, sizeof more, pressed, "contact: {}\n");
  breccia_model *m = pair_of(0, more);
  step_surely(m, INT64_MAX);
  const Particles *p = m->domain.particles;
  const Selection *held = &m->loading.loads[0].selection;
  double carried = 0;
  for (int64_t n = 0; n < held->count; ++n) carried += p->volume[held->places[n]] * p->internal.row[0][held->places[n]];
  assert_near(carried, -2 * 0.2 * 0.5, 1e-6);
  assert_balanced(m, 1e-4);
  breccia_model_destroy(&m);
  pair_is_refused(0.5, more, "a piece of 35 particles|join it to the rest"); /* it touches nothing */
}

#define STRIP                                                                                                          \
  IN_PLANE "body: {b: {" SQUARE "{box: {from: [0, 0], to: [0.8, 0.4]}}}}\n"                                            \
           "failure: {critical stretch: 1e-3}\npictures: []\n"

/** The load tears a strip in two: whatever solves the equations, it is said what has come off. */
static void a_crack_that_cuts_a_body_is_named(void **state)
{
  (void)state;
  static const struct {
    const char *way, *contact; /* faces of the crack that have come apart do not hold each other */
  } cases[] = {{"equations: direct", ""},
               {"equations: minimal residuals", ""},
               {"equations: conjugate gradients", ""},
               {"method: relaxation", ""},
               {"method: relaxation", "contact: {}\n"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    breccia_model *m = model_of(STRIP "%sloads:\n  - {on: {face: x-, layers: 2}, displacement: [0, 0]}\n"
                                      "  - {on: {face: x+, layers: 2}, traction: [15, 0], history: {ramp to: 1}}\n"
                                      "solve: {static: {increments: 4, %s}}\n",
                                cases[k].contact, cases[k].way);
    step_must_fail(m, "broken bonds have cut the body, and nothing holds a piece of 16 particles|against moving along "
                      "x as a whole|go on with a stage of 'explicit'");
    const Particles *p = m->domain.particles;
    for (int64_t n = 0; n < p->count; ++n)
      for (int axis = 0; axis < 2; ++axis) assert_true(fabs(p->displacement.row[axis][p->place_of[n]]) < 0.1);
    breccia_model_destroy(&m);
  }
}

/** Pulled apart by displacements, both halves are held. Then one is let go: it stays at rest where it is, unless something acts on it. */
static void what_has_come_off_rests_until_something_acts_on_it(void **state)
{
  (void)state;
#define TORN                                                                                                           \
  STRIP "loads:\n  - {on: {face: x-, layers: 2}, displacement: [0, 0]}\n"                                              \
        "  - {name: pull, on: {face: x+, layers: 2}, displacement: [0.01, 0], history: {ramp to: 1}}\n"                \
        "solve:\n  - {static: {increments: 4}}\n"
  breccia_model *m = model_of(TORN "  - {without: [pull], static: {increments: 1, equations: minimal residuals}}\n");
  step_surely(m, INT64_MAX);
  assert_true(m->domain.broken_count > 20);
  breccia_model_destroy(&m);
  m = model_of(TORN "  - {without: [pull], loads: [{name: more, on: {face: x+, layers: 1}, traction: [1, 0]}], "
                    "static: {increments: 1}}\n");
  stage_is_refused(m, "static: nothing holds a piece of|against moving along x as a whole|or go on with a stage of "
                      "'explicit'");
}

/** Of a stage to come it is not known where pieces will be. */
static void stages_to_come_may_let_pieces_meet(void **state)
{
  (void)state;
  const char *const later = "%sloads:\n" HELD "solve:\n  - {explicit: {steps: 1}}\n  - {static: {increments: 1}}\n";
  char more[1000];
  snprintf(more, sizeof more, later, "contact: {}\n");
  breccia_model *m = pair_of(0.5, more);
  stage_is_refused(m, "nothing holds a piece of 35 particles");
  snprintf(more, sizeof more, later, "");
  pair_is_refused(0.5, more, "nothing holds a piece of 35 particles");
}

#define BONDS                                                                                                          \
  UNITS "materials: {m: {model: elastic-1d, density: 2, Young modulus: 1e4}}\n"                                        \
        "peridynamics: {formulation: bond-based, space: plane stress, horizon: 0.2015}\npictures: []\n"

/** A particle that a cut frees of all bonds is let be where nothing acts on it; under a load it is named, as no equations hold it. */
static void a_single_particle_must_be_held_under_a_load(void **state)
{
  (void)state;
  static const struct {
    const char *load, *refusal;
  } cases[] = {
      {"{on: {face: x+}, force: [0, -1], history: {ramp to: 1}}",
       "nothing holds a piece of 1 particle, with particle 9 at [0.95, 0.05, 0], against moving along x as a whole"},
      {"{gravity: [0, -10]}", "nothing holds a piece of 1 particle"},
      {"{on: {inside: {box: {from: [0.5, 0.2], to: [2, 2]}}}, force: [0, -1]}", NULL},
      {"{gravity: [0, -10]}, {on: {nearest: [0.95, 0.05]}, spring: {stiffness: 1e3}}", NULL},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char deck[2000];
    snprintf(deck, sizeof deck,
             BONDS "body: {b: {" SQUARE "{box: {particles: [10, 4]}}}}\n"
                   "cracks: [{cut: {line: [[0.92, -1], [0.92, 0.12], [2, 0.12]]}}]\n"
                   "loads: [{on: {face: x-}, displacement: [0, 0]}, %s]\n" SOLVE,
             cases[k].load);
    if (cases[k].refusal) {
      char *words = refusal_of(deck);
      holds_words(words, cases[k].refusal);
      free(words);
      continue;
    }
    breccia_model *m = model_of("%s", deck);
    step_surely(m, INT64_MAX);
    breccia_model_destroy(&m);
  }
}

/** A body of one particle does not turn; and a spring at one particle keeps no other body from turning. */
static void springs_hold_along_their_direction(void **state)
{
  (void)state;
  static const char *const held[] = {"{on: {all: yes}, spring: {stiffness: 1e3}}",
                                     "{on: {all: yes}, spring: {stiffness: 1e3, direction: [2e-6, 0]}}, {on: {all: "
                                     "yes}, displacement: [free, 0]}"};
  for (int k = 0; k < 2; ++k) {
    breccia_model *m = model_of(BONDS "body: {b: {" SQUARE "{box: {particles: [1, 1]}}}}\n"
                                      "loads: [%s, {on: {face: x+}, force: [1, 0], history: {ramp to: 1}}]\n" SOLVE,
                                held[k]);
    step_surely(m, INT64_MAX);
    const Particles *p = m->domain.particles;
    assert_near(p->displacement.row[0][p->place_of[0]], 1e-3, 1e-9);
    breccia_model_destroy(&m);
  }
  static const struct {
    const char *springs, *motion;
  } loose[] = {
      {"{on: {nearest: [0.95, 0.05]}, spring: {stiffness: 1e3}}", "about z"},
      {"{on: {all: yes}, spring: {stiffness: 1e3, direction: [1, 0]}}", "along y"},
  };
  for (int k = 0; k < 2; ++k) {
    char deck[2000], words[64];
    snprintf(deck, sizeof deck,
             BONDS "body: {b: {" SQUARE "{box: {particles: [10, 4]}}}}\n"
                   "loads: [%s, {on: {face: x+}, force: [0, 1]}]\n" SOLVE,
             loose[k].springs);
    snprintf(words, sizeof words, "nothing holds the body against moving %s as a whole", loose[k].motion);
    char *refusal = refusal_of(deck);
    holds_words(refusal, words);
    free(refusal);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_piece_must_be_held),
      cmocka_unit_test(what_joins_pieces_holds_them),
      cmocka_unit_test(a_single_particle_must_be_held_under_a_load),
      cmocka_unit_test(springs_hold_along_their_direction),
      cmocka_unit_test(contact_joins_what_touches),
      cmocka_unit_test(a_crack_that_cuts_a_body_is_named),
      cmocka_unit_test(what_has_come_off_rests_until_something_acts_on_it),
      cmocka_unit_test(stages_to_come_may_let_pieces_meet),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What supports ask of the layers outside a face, as solvers take it: these move as the particles of which they are images, the other way along what
 * is held, and about the motion of the face; and what holds a body as a whole is told by it. */
#include "support.h"

#include "base/random.h"
#include "solver/pieces.h"

#define DECK                                                                                                           \
  "units: {length: m, force: kN, time: s}\n" SOFT_SOLID                                                                \
  "body: {b: {material: m, spacing: 0.1, shape: {box: {particles: [9, 8, 7]}}}}\n"                                     \
  "peridynamics: {formulation: correspondence, space: 3-D, horizon: 1.5 spacings}\n"

static const struct Case {
  const char *loads;
  int axis;
  bool high, held[3], periodic;
  double moved[3];
  const char *loose; /* first motion as a whole that nothing holds; NULL: none is left */
} cases[] = {
    {"{on: {face: x-}, support: {held: across}}", 0, false, {true, false, false}, false, {0}, "along y"},
    {"{on: {face: y+}, support: {held: across, displacement: [0, 2e-3, 0]}}",
     1,
     true,
     {false, true, false},
     false,
     {0, 2e-3, 0},
     "along x"},
    {"{on: {face: z-}, support: {held: all}}", 2, false, {true, true, true}, false, {0}, NULL},
    {"{on: {face: x+}, support: {held: all, displacement: [1e-3, -3e-3, 5e-4]}}",
     0,
     true,
     {true, true, true},
     false,
     {1e-3, -3e-3, 5e-4},
     NULL},
    {"{on: {face: z-}, support: {held: periodic}}", 2, false, {false, false, false}, true, {0}, "along x"},
};
enum { CASES = sizeof cases / sizeof *cases };

static void images_move_as_what_they_are_images_of(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    breccia_model *m = model_of(DECK "loads: [%s]\nsolve: {explicit: {steps: 1, time step: 1e-9}}\n", cases[c].loads);
    const Particles *p = m->domain.particles;
    const Unknowns u = unknowns_of(&m->domain, &m->loading);
    Vector v[1] = {{0}};
    assert_true(vector_create(v, &p->space, "test", NULL));
    uint64_t seed = 3;
    for (int k = 0; k < 3; ++k)
      for (int64_t n = 0; n < p->count; ++n) {
        p->displacement.row[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
        v->row[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
      }
    for (int timed = 0; timed < 2; ++timed) {
      unknowns_spread(&u, timed ? 1 : NAN, v); /* changes alone, or to where all stands at the end */
      const int axis = cases[c].axis;
      const double size[3] = {0.9, 0.8, 0.7}, face = cases[c].high ? size[axis] : 0;
      int images = 0;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        double inside[3];
        for (int k = 0; k < 3; ++k) inside[k] = p->position[k][i];
        const bool beyond = inside[axis] < 0 || inside[axis] > size[axis];
        if (!beyond) continue;
        if (cases[c].periodic)
          inside[axis] += inside[axis] < 0 ? size[axis] : -size[axis];
        else
          inside[axis] = 2 * face - inside[axis];
        const int32_t j = body_nearest(&m->domain.body, inside);
        for (int k = 0; k < 3; ++k) assert_near(p->position[k][j], inside[k], 1e-9);
        ++images;
        for (int k = 0; k < 3; ++k) {
          const double sign = cases[c].held[k] ? -1 : 1, there = v->row[k][j] + (timed ? p->displacement.row[k][j] : 0),
                       here = v->row[k][i] + (timed ? p->displacement.row[k][i] : 0);
          const double wanted = sign * there + (timed && cases[c].held[k] ? 2 * cases[c].moved[k] : 0);
          if (!(fabs(here - wanted) < 1e-15))
            fail_msg("%s: an image goes %g along %c, not %g", cases[c].loads, here, "xyz"[k], wanted);
        }
      }
      assert_true(images > 50);
    }
    LoosePiece loose;
    assert_int_equal(pieces_find_loose(&u, PIECES_ALL, &loose, NULL), 0);
    assert_int_equal(loose.pieces, cases[c].loose != NULL);
    if (loose.pieces) assert_string_equal(loose.motion, cases[c].loose);
    vector_destroy(v);
    breccia_model_destroy(&m);
  }
}

/* ---- lattices, whose particles turn ---- */

#define LATTICE                                                                                                        \
  "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson "   \
  "ratio: 0.2}}\nperidynamics: {formulation: micropolar, space: %s}\n"                                                 \
  "body: {b: {material: m, spacing: 0.1, %s shape: {box: {from: %s, to: %s}}}}\nloads: [%s]\nsolve: {%s}\n"

/** A lattice symmetric about the plane in which a support holds it across is half of one that is loaded alike on both sides: a beam under a force across
 *  it bends at the plane, where its particles do not turn about axes along it, and twisted about the normal they do. */
static void half_a_lattice_moves_as_the_whole(void **state)
{
  (void)state;
  static const char *const solvers[] = {"static: {increments: 2, residual: 1e-10}",
                                        "explicit: {end time: 0.02, time step: 2e-4}"};
  static const struct {
    const char *space, *lattice, *from[2], *to, *loads;
  } bodies[] = {
      {"plane stress",
       "lattice: square, thickness: 0.3,",
       {"[-1, 0]", "[0, 0]"},
       "[1, 0.4]",
       "{on: {face: x+, layers: 1}, force: [0, 1e-2]}%s%s"},
      {"3-D",
       "lattice: cubic,",
       {"[-0.8, 0, 0]", "[0, 0, 0]"},
       "[0.8, 0.3, 0.3]",
       "{on: {face: x+, layers: 1}, force: [0, 1e-2, 3e-3]}%s%s"},
  };
  for (int b = 0; b < 2; ++b)
    for (int s = 0; s < 2; ++s) {
      breccia_model *m[2];
      for (int half = 0; half < 2; ++half) {
        char loads[600];
        snprintf(loads, sizeof loads, bodies[b].loads,
                 half ? ", {on: {face: x-}, support: {held: across}}"
                 : b  ? ", {on: {face: x-, layers: 1}, force: [0, 1e-2, 3e-3]}"
                      : ", {on: {face: x-, layers: 1}, force: [0, 1e-2]}",
                 b ? ", {on: {inside: {box: {from: [-0.1, -1, -1], to: [0.1, 0.1, 1]}}}, displacement: [0, 0, 0]}"
                   : ", {on: {inside: {box: {from: [-0.1, -1], to: [0.1, 0.1]}}}, displacement: [0, 0]}");
        m[half] = model_of(LATTICE, bodies[b].space, bodies[b].lattice, bodies[b].from[half], bodies[b].to, loads,
                           solvers[s]);
        while (!solver_is_done(&m[half]->solver)) step_surely(m[half], 1);
        assert_balanced(m[half], 1e-4);
      }
      const Particles *whole = m[0]->domain.particles, *p = m[1]->domain.particles;
      double most = 0, turned = 0;
      int64_t images = 0;
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        double at[3], here[3], there[3];
        for (int k = 0; k < 3; ++k) at[k] = p->position[k][i];
        images += body_outside(&m[1]->domain.body, n);
        const int32_t j = body_nearest(&m[0]->domain.body, at);
        particles_rotation(p, i, here);
        particles_rotation(whole, j, there);
        for (int k = 0; k < 3; ++k) {
          assert_near(p->displacement.row[k][i], whole->displacement.row[k][j], 1e-9);
          assert_near(here[k], there[k], 1e-8);
          most = larger_of(most, fabs(p->displacement.row[k][i]));
          turned = larger_of(turned, fabs(here[k]));
        }
      }
      assert_true(images > 5 && most > 1e-5 && turned > 1e-5);
      for (int half = 0; half < 2; ++half) breccia_model_destroy(&m[half]);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(images_move_as_what_they_are_images_of),
      cmocka_unit_test(half_a_lattice_moves_as_the_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

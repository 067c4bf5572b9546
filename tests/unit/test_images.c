/* What supports ask of the layers outside a face, as solvers take it: these move as the particles of which they are images, the other way along what
 * is held, and about the motion of the face; and what holds a body as a whole is told by it. */
#include "support.h"

#include "base/random.h"
#include "solver/pieces.h"
#include "solver/vectors.h"

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
    double *v[MOTIONS];
    assert_true(vectors_make(v, p, "test", NULL));
    uint64_t seed = 3;
    for (int k = 0; k < 3; ++k)
      for (int64_t n = 0; n < p->count; ++n) {
        p->displacement[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
        v[k][p->place_of[n]] = 1e-3 * (random_uniform(&seed) - 0.5);
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
          const double sign = cases[c].held[k] ? -1 : 1, there = v[k][j] + (timed ? p->displacement[k][j] : 0),
                       here = v[k][i] + (timed ? p->displacement[k][i] : 0);
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
    vectors_free(v);
    breccia_model_destroy(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(images_move_as_what_they_are_images_of),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

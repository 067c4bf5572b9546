/* Which bonds notches and cuts part. */
#include "support.h"

#define MATERIAL "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
#define SOLVE "solve: {explicit: {steps: 1}}\n"

static void a_cut_through_a_row_of_particles_parts_the_body_beside_it(void **state)
{
  (void)state;
  /* Particles on the cut belong to one side: nothing is cut off from both. */
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: 2.015}\ncracks: [{cut: {line: [[4, -9], [4, 99]]}}]\n"
                              "body: {b: {material: m, spacing: 1, shape: {box: {particles: [9, 5, 4], first "
                              "particle: [0, 0, 0]}}}}\n");
  const Particles *p = model->domain.particles;
  int across[2] = {0, 0};
  for (int64_t n = 0; n < p->count; ++n) {
    if (p->position[0][p->place_of[n]] != 4) continue;
    across[0] += family_joins(&model->domain.family, p->place_of[n], p->place_of[n - 1]);
    across[1] += family_joins(&model->domain.family, p->place_of[n], p->place_of[n + 1]);
  }
  assert_int_equal(across[0] + across[1], 20);
  assert_int_equal(across[0] * across[1], 0);
  breccia_model_destroy(&model);
}

/** Bonds of a plate of two layers with a notch or cut up to y = `tip`. */
static int64_t bonds_with(const char *crack, double tip)
{
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: 3.015 spacings}\nunits: {length: m, force: kN, time: s}\n"
                              "cracks: [{remove: {box: {from: [0.285, -1, -1], to: [0.315, %.17g, 1]}}%s}]\n"
                              "body: {b: {material: m, spacing: 0.03, shape: {box: {particles: [20, 14, 2], first "
                              "particle: [0, 0, 0]}}}}\n",
               tip < 0.195 ? tip : 0.195, crack);
  int64_t bonds = model->domain.family.bonds;
  breccia_model_destroy(&model);
  return bonds;
}

static void a_bond_that_only_touches_the_end_of_a_cut_is_whole(void **state)
{
  (void)state;
  /* A tip half-way between two rows at 0.18 and 0.21, which slanting bonds meet: it cuts what one a little shorter cuts. */
  const char *const cuts[] = {", cut faces: yes", "}, {cut: {line: [[0.3, -1], [0.3, TIP]]}",
                              "}, {cut: {polygon: [[0.3, -1, -1], [0.3, TIP, -1], [0.3, TIP, 1], [0.3, -1, 1]]}"};
  for (int k = 0; k < 3; ++k) {
    const double tips[] = {0.1949, 0.195, 0.1951};
    int64_t bonds[3];
    for (int n = 0; n < 3; ++n) {
      char crack[160];
      snprintf(crack, sizeof crack, "%s", cuts[k]);
      for (char *at; (at = strstr(crack, "TIP"));) {
        char rest[160];
        snprintf(rest, sizeof rest, "%s", at + 3);
        snprintf(at, sizeof crack - (size_t)(at - crack), "%g%s", tips[n], rest);
      }
      bonds[n] = bonds_with(crack, k ? 0.195 : tips[n]);
    }
    assert_int_equal(bonds[1], bonds[0]);
    /* From layer to layer and within each, one spacing up or down: 2 x 2 x 2 bonds of reach (2, 1), from both sides. */
    if (k) assert_int_equal(bonds[1] - bonds[2], 2 * 8);
  }
}

typedef struct CutCase {
  const char *cuts;
  double a[3], b[3];
  bool cut;
} CutCase;

/** The same words with every number x as (x + shift) times scale, to be freed. */
static char *scaled(const char *words, double scale, double shift)
{
  Text text = {0};
  for (const char *at = words; *at;) {
    char *end = (char *)at;
    const double number = strchr("-0123456789", *at) ? strtod(at, &end) : 0;
    if (end > at)
      text_add(&text, "%.17g", (number + shift) * scale);
    else
      text_add(&text, "%c", *at++);
    if (end > at) at = end;
  }
  return text.characters;
}

static void ends_edges_corners_and_bonds_in_the_plane_of_a_cut_are_decided_alike_from_both_sides(void **state)
{
  (void)state;
#define LINE(...) "{cut: {line: [" #__VA_ARGS__ "]}}"
#define POLYGON(...) "{cut: {polygon: [" #__VA_ARGS__ "]}}"
#define WINDOW POLYGON([ 4.5, 1.5, 1.5 ], [ 4.5, 4.5, 1.5 ], [ 4.5, 4.5, 4.5 ], [ 4.5, 1.5, 4.5 ])
#define HALF_SLIT LINE([ 4.5, -1 ], [ 4.5, 3.5 ])
#define ROW_SLIT LINE([ 4, -1 ], [ 4, 3.5 ])
#define BEND LINE([ 2.5, 2 ], [ 4.5, 4 ], [ 6.5, 2 ])
  const CutCase cases[] = {
      /* a line that ends between rows */
      {HALF_SLIT, {4, 3, 0}, {5, 3, 1}, true},
      {HALF_SLIT, {4, 3, 0}, {5, 4, 0}, false},
      {HALF_SLIT, {4, 4, 0}, {5, 4, 0}, false},
      {HALF_SLIT, {4, 2, 0}, {5, 4, 2}, true},
      /* that ends at a row: inside the body the row is whole, at its outermost particles it is cut */
      {LINE([ 4.5, 2 ], [ 4.5, 3.5 ]), {4, 2, 0}, {5, 2, 0}, false},
      {LINE([ 4.5, 0 ], [ 4.5, 3.5 ]), {4, 0, 0}, {5, 0, 0}, true},
      {LINE([ 4.5, 3.5 ], [ 4.5, 8 ]), {4, 8, 0}, {5, 8, 2}, true},
      /* through a corner of a line, straight or bent; the bend touched from outside */
      {LINE([ 4.5, -1 ], [ 4.5, 2 ], [ 4.5, 6.5 ]), {4, 2, 0}, {5, 2, 0}, true},
      {LINE([ 4.5, -1 ], [ 4.5, 2 ], [ 4.5, 6.5 ]), {4, 1, 0}, {5, 3, 0}, true},
      {BEND, {4.5, 3.5, 0}, {4.5, 4.5, 0}, true},
      {BEND, {4, 4, 0}, {5, 4, 0}, false},
      {BEND, {4, 4, 0}, {4, 3, 0}, true},
      {BEND, {4, 3, 0}, {5, 3, 0}, false},
      {LINE([ 2.5, 2.5 ], [ 5.5, 2.5 ], [ 5.5, 5.5 ], [ 2.5, 2.5 ]), {2, 3, 0}, {3, 2, 0}, false},
      {LINE([ 2.5, 2.5 ], [ 5.5, 2.5 ], [ 5.5, 5.5 ], [ 2.5, 2.5 ]), {1.5, 2, 0}, {3.5, 3, 0}, true},
      /* two cuts that meet at an end */
      {LINE([ 4.5, 1.5 ], [ 4.5, 3 ]) ", " LINE([ 4.5, 3 ], [ 4.5, 5.5 ]), {4, 3, 0}, {5, 3, 0}, true},
      /* particles on the line belong to its left, bonds along it are whole, and so is the one at its end */
      {ROW_SLIT, {4, 1, 0}, {5, 1, 0}, true},
      {ROW_SLIT, {4, 1, 0}, {5, 2, 1}, true},
      {ROW_SLIT, {4, 1, 0}, {3, 1, 0}, false},
      {ROW_SLIT, {4, 1, 0}, {4, 2, 1}, false},
      {ROW_SLIT, {4, 3, 0}, {4, 4, 0}, false},
      {LINE([ 4, 3.5 ], [ 4, -1 ]), {4, 1, 0}, {5, 1, 0}, false},
      {LINE([ 4, 3.5 ], [ 4, -1 ]), {4, 1, 0}, {3, 1, 0}, true},
      {LINE([ 4, -1 ], [ 4, 3 ]), {4, 3, 0}, {5, 3, 0}, false},
      {LINE([ 4, -1 ], [ 4, 3 ]), {4, 3, 0}, {3, 3, 0}, false},
      {LINE([ 4, -1 ], [ 4, 3 ]), {4, 2, 0}, {5, 2, 0}, true},
      /* a polygon: inside, edge, corner, its plane, particles on it, and where it leaves the body */
      {WINDOW, {4, 2, 2}, {5, 2, 2}, true},
      {WINDOW, {4, 1, 2}, {5, 2, 2}, false},
      {WINDOW, {4, 1, 1}, {5, 2, 2}, false},
      {WINDOW, {4, 4, 4}, {5, 5, 5}, false},
      {WINDOW, {4, 1, 3}, {5, 1, 3}, false},
      {WINDOW, {4.5, 2, 2}, {4.5, 3, 3}, false},
      {WINDOW, {4.5, 2, 2}, {4.5, 1, 2}, false},
      {WINDOW, {4.5, 2, 2}, {4, 2, 2}, true},
      {WINDOW, {4.5, 2, 2}, {5, 2, 2}, false},
      {WINDOW, {4.5, 1.5, 2}, {4, 2, 2}, false},
      {POLYGON([ 4.5, 0, 0 ], [ 4.5, 3.5, 0 ], [ 4.5, 3.5, 8 ], [ 4.5, 0, 8 ]), {4, 0, 3}, {5, 0, 3}, true},
      {POLYGON([ 4.5, 0, 0 ], [ 4.5, 3.5, 0 ], [ 4.5, 3.5, 8 ], [ 4.5, 0, 8 ]), {4, 2, 0}, {5, 2, 0}, true},
      {POLYGON([ 4.5, 0, 0 ], [ 4.5, 3.5, 0 ], [ 4.5, 3.5, 8 ], [ 4.5, 0, 8 ]), {4, 3, 0}, {5, 4, 0}, false},
      {WINDOW ", " POLYGON([ 4.5, 4.5, 1.5 ], [ 4.5, 4.5, 4.5 ], [ 4.5, 7.5, 4.5 ], [ 4.5, 7.5, 1.5 ]),
       {4, 4, 3},
       {5, 5, 3},
       true},
  };
  /* As they stand, and where no number is what it is meant to be but for roundings: those must not decide. */
  const double scales[] = {1, 0.1, 0.07, 3e-3}, shifts[] = {0, 0.3, 7.7, -4.1};
  for (size_t k = 0; k < 4 * (sizeof cases / sizeof *cases); ++k) {
    const CutCase *one = &cases[k / 4];
    const double scale = scales[k % 4], shift = shifts[k % 4];
    char *cuts = scaled(one->cuts, scale, shift);
    breccia_model *model =
        model_of(MATERIAL SOLVE "peridynamics: {horizon: 1.5 spacings}\ncracks: [%s]\n"
                                "body: {b: {material: m, spacing: %.17g, shape: {box: {particles: [9, 9, "
                                "9], first particle: [%.17g, %.17g, %.17g]}}}}\n",
                 cuts, scale, shift * scale, shift * scale, shift * scale);
    const Body *body = &model->domain.body;
    double a[3], b[3];
    for (int c = 0; c < 3; ++c) {
      a[c] = shift * scale + one->a[c] * scale;
      b[c] = shift * scale + one->b[c] * scale;
    }
    if (body_cuts(body, a, b) != one->cut || body_cuts(body, b, a) != one->cut)
      fail_msg("case %zu: %s, [%g, %g, %g] to [%g, %g, %g], times %g: %d, back %d, expected %d", k / 4, cuts, a[0],
               a[1], a[2], b[0], b[1], b[2], scale, body_cuts(body, a, b), body_cuts(body, b, a), one->cut);
    free(cuts);
    breccia_model_destroy(&model);
  }
}

static void a_notch_whose_end_is_a_row_of_taken_particles_cuts_the_bonds_across_them(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(MATERIAL SOLVE "peridynamics: {horizon: 2.015}\n"
                              "cracks: [{remove: {box: {from: [3.5, -9, -9], to: [4.5, 3, 9]}}, cut faces: yes}]\n"
                              "body:\n  far: {material: m, spacing: 1, shape: {box: {particles: [2, 2, 2], first "
                              "particle: [20.5, 0.5, 0.5]}}}\n" /* without a row at the end of the notch */
                              "  b: {material: m, spacing: 1, shape: {box: {particles: [9, 9, 2], first "
                              "particle: [0, 0, 0]}}}\n");
  const Body *body = &model->domain.body;
  assert_true(body_cuts(body, (double[]){3, 3, 0}, (double[]){5, 3, 0}));
  assert_true(!body_cuts(body, (double[]){3, 4, 0}, (double[]){5, 4, 0}));
  breccia_model_destroy(&model);
}

/** A cut that goes on from a notch is closed beyond it; across the notch its faces are apart. */
static void a_cut_is_closed_but_where_a_notch_is(void **state)
{
  (void)state;
  breccia_model *m =
      model_of(SOFT_SOLID "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.2, shape: {box: "
                          "{from: [0, 0], to: [1, 1]}}}}\n"
                          "cracks: [{remove: {box: {from: [0, 0.4], to: [0.5, 0.6]}}}, {cut: {line: [[0, "
                          "0.5], [1, 0.5]]}}]\n"
                          "peridynamics: {space: plane strain}\nsolve: {explicit: {steps: 1}}\n");
  const struct {
    double a[3], b[3];
    bool closed;
  } cases[] = {{{0.25, 0.35, 0}, {0.25, 0.65, 0}, false},
               {{0.45, 0.35, 0}, {0.35, 0.65, 0}, false},
               {{0.75, 0.45, 0}, {0.75, 0.55, 0}, true},
               {{0.75, 0.55, 0}, {0.65, 0.45, 0}, true},
               {{0.75, 0.65, 0}, {0.65, 0.55, 0}, false}}; /* beside it */
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    double normal[3], level = 0;
    const bool closed = body_closed_cut(&m->domain.body, cases[k].a, cases[k].b, normal, &level);
    if (closed != cases[k].closed) fail_msg("%zu: closed %d", k, closed);
    if (!closed) continue;
    const double up = cases[k].b[1] > cases[k].a[1] ? 1 : -1; /* from a to b */
    assert_near(normal[0], 0, 1e-14);
    assert_near(normal[1], up, 1e-14);
    assert_near(level, 0.5 * up, 1e-14);
  }
  breccia_model_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cut_is_closed_but_where_a_notch_is),
      cmocka_unit_test(a_cut_through_a_row_of_particles_parts_the_body_beside_it),
      cmocka_unit_test(a_bond_that_only_touches_the_end_of_a_cut_is_whole),
      cmocka_unit_test(ends_edges_corners_and_bonds_in_the_plane_of_a_cut_are_decided_alike_from_both_sides),
      cmocka_unit_test(a_notch_whose_end_is_a_row_of_taken_particles_cuts_the_bonds_across_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

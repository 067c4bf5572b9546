/* Laws that ask where their points stand: numbers, positions and directions of bonds, and histories that begin by them. */
#include "support.h"

#include "domain/domain.h"

/* "witness": elastic; its history notes at `begin_point` where the point stands, and `update` gives up where its batch
 * tells another place. In space it is Hooke's law with a Poisson ratio of 0; along bonds stiffness differs by
 * direction: E = 1e4 (1 + 0.5 n_x^2). */
enum { WITNESS_VALUES = 9 };

static int witness_prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)values, (void)constants, (void)reason, (void)size;
  return 0;
}
static void witness_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1e4 / 3;
  *shear = 1e4 / 2;
}
static void rod_moduli(const void *constants, double *bulk, double *shear)
{
  (void)constants;
  *bulk = 1.5e4 / 1.5;
  *shear = 1.5e4 / 2.5;
}
static int witness_values(const void *constants)
{
  (void)constants;
  return WITNESS_VALUES;
}
static void witness_begin_point(const void *constants, const breccia_place *place, double *history)
{
  (void)constants;
  history[0] = 1;
  for (int k = 0; k < 2; ++k) history[1 + k] = place->particle[k];
  for (int k = 0; k < 3; ++k) history[3 + k] = place->position[k];
  for (int k = 0; k < 3; ++k) history[6 + k] = place->direction[k];
}

/** Returns true if a batch tells of point i what its history noted. */
static bool witness_agrees(const breccia_batch *batch, int i)
{
  const double *noted = batch->committed + WITNESS_VALUES * i;
  if (!batch->position[0]) return noted[0] == 0; /* in no body */
  bool agrees = noted[0] == 1;
  for (int k = 0; k < 2; ++k) agrees &= noted[1 + k] == batch->particle[k][i];
  for (int k = 0; k < 3; ++k) agrees &= noted[3 + k] == batch->position[k][i];
  for (int k = 0; k < 3; ++k) agrees &= noted[6 + k] == (batch->direction[k] ? batch->direction[k][i] : 0);
  return agrees;
}
static void witness_keep(const breccia_batch *batch, int i)
{
  memcpy(batch->trial + WITNESS_VALUES * i, batch->committed + WITNESS_VALUES * i, WITNESS_VALUES * sizeof(double));
}
static int witness_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    if (!witness_agrees(batch, i)) return i;
    witness_keep(batch, i);
    for (int k = 0; k < 6; ++k) batch->stress[k][i] = (k < 3 ? 1e4 : 0.5e4) * batch->strain[k][i];
    for (int k = 0; k < 36 && batch->tangent; ++k) batch->tangent[36 * i + k] = k % 7 ? 0 : k / 7 < 3 ? 1e4 : 0.5e4;
  }
  return -1;
}
static int rod_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    if (!witness_agrees(batch, i)) return i;
    witness_keep(batch, i);
    const double along = batch->direction[0] ? batch->direction[0][i] : 0, young = 1e4 * (1 + 0.5 * along * along);
    batch->stress[0][i] = young * batch->strain[0][i];
    if (batch->tangent) batch->tangent[i] = young;
  }
  return -1;
}
#define WITNESS                                                                                                        \
  .size = sizeof(breccia_law), .about = "notes where points stand", .source = "the tests", .maturity = "experimental", \
  .constants_size = 1, .prepare = witness_prepare, .history_values = witness_values, .takes_places = 1,                \
  .begin_point = witness_begin_point
static const breccia_law law_of_witness = {WITNESS, .name = "witness", .components = 6, .moduli = witness_moduli,
                                           .update = witness_update};
static const breccia_law law_of_rod = {WITNESS, .name = "rod", .components = 1, .moduli = rod_moduli,
                                       .update = rod_update};

/* "speck": along bonds, E = 1e4 (1 + x), with a short history, which laws without places share among untouched points. */
static int speck_values(const void *constants)
{
  (void)constants;
  return 1;
}
static void speck_begin_point(const void *constants, const breccia_place *place, double *history)
{
  (void)constants;
  *history = 1 + place->position[0];
}
static int speck_update(const void *constants, const breccia_batch *batch)
{
  (void)constants;
  for (int i = 0; i < batch->count; ++i) {
    batch->trial[i] = batch->committed[i];
    batch->stress[0][i] = 1e4 * batch->committed[i] * batch->strain[0][i];
    if (batch->tangent) batch->tangent[i] = 1e4 * batch->committed[i];
  }
  return -1;
}
static const breccia_law law_of_speck = {.size = sizeof(breccia_law),
                                         .name = "speck",
                                         .about = "notes where points stand",
                                         .source = "the tests",
                                         .maturity = "experimental",
                                         .constants_size = 1,
                                         .components = 1,
                                         .prepare = witness_prepare,
                                         .moduli = rod_moduli,
                                         .history_values = speck_values,
                                         .update = speck_update,
                                         .takes_places = 1,
                                         .begin_point = speck_begin_point};

static breccia_model *loaded(int threads, const char *deck)
{
  const breccia_law *const laws[] = {&law_of_witness, &law_of_rod, &law_of_speck};
  const breccia_options options = {.size = sizeof options, .laws = laws, .law_count = 3, .threads = threads};
  Error *error = breccia_error_create();
  breccia_model *m = NULL;
  if (breccia_model_load_string(deck, "deck", &options, &m, error)) fail_msg("%s", breccia_error_text(error));
  breccia_error_destroy(&error);
  return m;
}

static const struct {
  const char *law, *limits, *peridynamics, *space, *solver;
} bodies[] = {
    {"rod", "", "formulation: bond-based, horizon: 3.015 spacings", "plane stress", "explicit: {steps: 40}"},
    {"rod", ", largest strain: 0.5", "formulation: bond-based, horizon: 3.015 spacings", "plane strain",
     "static: {increments: 2}"},
    {"witness", "", "formulation: hybrid, horizon: 1.5 spacings", "plane stress", "static: {increments: 2}"},
    {"witness", "", "formulation: hybrid, horizon: 2.015 spacings", "plane strain", "explicit: {steps: 40}"},
    {"witness", "", "formulation: correspondence, horizon: 2.015 spacings", "plane stress", "explicit: {steps: 40}"},
    {"witness", "", "formulation: correspondence, horizon: 2.015 spacings", "plane strain", "static: {increments: 2}"},
};

/** A body of two lattices and materials with a support, stretched and sheared. */
static breccia_model *body_of(int which, int threads)
{
  char *deck = text_format(
      "units: {length: m, force: kN, time: s}\nmaterials:\n  a: &a {model: %s, density: 2%s}\n  b: *a\n"
      "body:\n  left: {material: a, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [7, 4]}}}\n"
      "  right: {material: b, lattice: square, thickness: 1, spacing: 0.08, shape: {box: {particles: [8, 5], first "
      "particle: [0.745, 0.04]}}}\n"
      "peridynamics: {%s, space: %s}\n"
      "loads: [{on: {block: left, face: x-}, support: {held: across}}, {on: {block: left, face: y-}, support: {held: "
      "across}}, {on: {block: right, face: x+, layers: 2}, displacement: [0.002, 0.001], history: {ramp to: 0.01}}]\n"
      "solve: {%s}\n",
      bodies[which].law, bodies[which].limits, bodies[which].peridynamics, bodies[which].space, bodies[which].solver);
  breccia_model *m = loaded(threads, deck);
  free(deck);
  return m;
}

/** Batches of all kinds tell each point the place at which its history began: in explicit steps and at rest, of one
 *  strain and six, in plane stress, inside limits of strain, on several threads. */
static void batches_tell_each_point_its_place(void **state)
{
  (void)state;
  for (int k = 0; k < (int)(sizeof bodies / sizeof *bodies); ++k)
    for (int threads = 1; threads < 4; threads += 2) {
      breccia_model *m = body_of(k, threads);
      print_message("%s, %s, %s\n", bodies[k].law, bodies[k].peridynamics, bodies[k].solver);
      step_surely(m, INT64_MAX);
      breccia_model_destroy(&m);
    }
}

/** Numbers, position and direction are those of the bond, or of the particle; of images of one support
 *  those of their originals. */
static void places_are_those_of_bonds_and_particles(void **state)
{
  (void)state;
  for (int k = 0; k < (int)(sizeof bodies / sizeof *bodies); ++k) {
    breccia_model *m = body_of(k, 1);
    const Domain *d = &m->domain;
    const Region *region = &d->regions[0];
    const Points *points = &region->points;
    const Particles *p = d->particles;
    int64_t inside = 0, images = 0;
    for (int64_t s = 0; s < p->slices; ++s)
      for (int lane = 0; lane < SLICE; ++lane) {
        const int64_t place = s * SLICE + lane;
        if (p->number[place] < 0) continue;
        if (!points->on_bonds) {
          const double *noted = points_history(points, place);
          const int64_t of = body_original(&d->body, p->number[place]);
          assert_true(noted[0] == 1 && noted[1] == (double)of && noted[2] == (double)of);
          for (int c = 0; c < 3; ++c) assert_near(noted[3 + c], p->position[c][p->place_of[of]], 1e-12);
          for (int c = 0; c < 3; ++c) assert_true(noted[6 + c] == 0);
          ++inside;
        }
        for (int64_t slot = d->family.first[s]; slot < d->family.first[s + 1] && points->on_bonds; ++slot) {
          int64_t rows[2];
          if (!(d->family.intact[slot] >> lane & 1)) continue;
          const Bond bond = family_bond(&d->family, s, slot, lane);
          int64_t ends[2] = {p->number[place], p->number[bond.neighbour]};
          bond_list_rows(&region->bonds, &d->family, s, slot, lane, rows);
          const bool both = body_outside(&d->body, ends[0]) && body_outside(&d->body, ends[1]);
          while (body_outside(&d->body, ends[0]) && body_outside(&d->body, ends[1]) &&
                 d->body.margin_of[ends[0]] == d->body.margin_of[ends[1]])
            for (int e = 0; e < 2; ++e) ends[e] = d->body.image_of[ends[e]];
          double middle[3], along[3], length = 0;
          domain_bond_middle(d, (const int32_t[]){p->number[place], p->number[bond.neighbour]}, middle);
          for (int c = 0; c < 3; ++c) {
            along[c] = p->position[c][p->place_of[ends[1]]] - p->position[c][p->place_of[ends[0]]];
            length += along[c] * along[c];
          }
          for (int r = 0; r < 2; ++r) {
            const double *noted = points_history(points, rows[r]);
            const int64_t a = body_original(&d->body, ends[0]), b = body_original(&d->body, ends[1]);
            assert_true(noted[0] == 1);
            const bool same = noted[1] == (double)a && noted[2] == (double)b,
                       turned = noted[1] == (double)b && noted[2] == (double)a;
            assert_true(same || turned);
            double dot = 0;
            for (int c = 0; c < 3; ++c) assert_near(noted[3 + c], middle[c], 1e-12);
            for (int c = 0; c < 3; ++c) dot += noted[6 + c] * along[c] / sqrt(length);
            assert_near(fabs(dot), 1, 1e-12);
            if (a != b && same != turned) assert_near(dot, same ? 1 : -1, 1e-12);
          }
          inside += !both;
          images += both;
        }
      }
    assert_true(inside > 0 && (images > 0 || !points->on_bonds));
    breccia_model_destroy(&m);
  }
}

/** Bonds along x are half as stiff again as bonds along y, as the law says by their directions. */
static void a_law_may_know_directions(void **state)
{
  (void)state;
  double pull[2];
  for (int axis = 0; axis < 2; ++axis) {
    breccia_model *m = loaded(1, "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: rod, density: 2}}\n"
                                 "body: {b: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: "
                                 "{particles: [8, 8]}}}}\n"
                                 "peridynamics: {formulation: bond-based, space: plane stress, horizon: 1.2 "
                                 "spacings}\nsolve: {explicit: {steps: 1, time step: 1e-6}}\n");
    double f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    f[4 * axis] += 1e-6;
    deform_uniformly(m, f);
    compute_forces(m);
    pull[axis] = fabs(m->domain.particles->internal.row[axis][m->domain.particles->place_of[axis ? 3 : 24]]);
    breccia_model_destroy(&m);
  }
  print_message("pull along x %g, along y %g\n", pull[0], pull[1]);
  assert_true(pull[1] > 0);
  assert_near(pull[0] / pull[1], 1.5, 1e-9);
}

/** Ends of an evenly stretched bar of next neighbours pull in proportion to the stiffness with which their bonds began. */
static void a_law_may_grade_its_history(void **state)
{
  (void)state;
  breccia_model *m = loaded(1, "units: {length: m, force: kN, time: s}\nmaterials: {m: {model: speck, density: 2}}\n"
                               "body: {b: {material: m, lattice: line, area: 1, spacing: 0.5, shape: {box: {particles: "
                               "[8, 1, 1]}}}}\nperidynamics: {formulation: bond-based, space: 1-D, horizon: 0.6}\n"
                               "solve: {explicit: {steps: 1, time step: 1e-6}}\n");
  const double f[9] = {1 + 1e-6, 0, 0, 0, 1, 0, 0, 0, 1};
  deform_uniformly(m, f);
  compute_forces(m);
  const Particles *p = m->domain.particles;
  const double *x = p->position[0], *force = p->internal.row[0], left = x[p->place_of[0]] + 0.25,
               right = x[p->place_of[7]] - 0.25;
  assert_true(force[p->place_of[0]] > 0);
  assert_near(-force[p->place_of[7]] / force[p->place_of[0]], (1 + right) / (1 + left), 1e-9);
  breccia_model_destroy(&m);
}

static breccia_model *rods(int threads)
{
  return body_of(0, threads);
}
static breccia_model *witnesses(int threads)
{
  return body_of(4, threads);
}
static void such_bodies_have_the_same_bits(void **state)
{
  (void)state;
  assert_same_bits_by_threads_and_restart(rods, 10, 30);
  assert_same_bits_by_threads_and_restart(witnesses, 10, 30);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(batches_tell_each_point_its_place), cmocka_unit_test(places_are_those_of_bonds_and_particles),
      cmocka_unit_test(a_law_may_know_directions),         cmocka_unit_test(a_law_may_grade_its_history),
      cmocka_unit_test(such_bodies_have_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

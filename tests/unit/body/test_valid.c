/* What must always hold of families and points is seen when it does not. */
#include "support.h"

static breccia_model *cracked_plate(void)
{
  return model_of("materials: {m: {model: j2, density: 2000, Young modulus: 200 GPa, Poisson ratio: 0.3, yield stress: "
                  "400 MPa, hardening modulus: 1 GPa}}\n"
                  "body:\n"
                  "  a: {material: m, spacing: 1, shape: {box: {particles: [9, 7, 4]}}}\n"
                  "  b: {material: m, spacing: 1, shape: {box: {from: [8.6, -0.5, -0.5], to: [12.6, 6.5, 3.5]}}}\n"
                  "cracks: [{cut: {line: [[4.5, -1], [4.5, 3.2]]}}]\n"
                  "solve: {explicit: {steps: 1}}\n");
}

static void families_of_bodies_are_valid_also_with_broken_bonds(void **state)
{
  (void)state;
  breccia_model *model = cracked_plate();
  Family *f = &model->domain.family;
  assert_true(family_is_valid(f));
  const int32_t a = model->domain.particles->place_of[30];
  int64_t slot = f->first[a / SLICE];
  while (!(f->intact[slot] >> (a % SLICE) & 1)) ++slot;
  assert_true(family_break(f, a, family_bond(f, a / SLICE, slot, a % SLICE).neighbour));
  assert_true(family_is_valid(f));
  breccia_model_destroy(&model);
}

/* A bond that only one end knows, anywhere: one of them in so many is looked for from the other end, so that all are told by a
 * side that lost every bond. */
static void a_bond_of_one_end_only_is_seen(void **state)
{
  (void)state;
  breccia_model *model = cracked_plate();
  Family *f = &model->domain.family;
  const int64_t slice = model->domain.particles->place_of[60] / SLICE;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) f->intact[slot] = 0;
  assert_false(family_is_valid(f));
  breccia_model_destroy(&model);
}

/** Of an intact bond between lattices. */
static int32_t *stored_neighbour(const Family *f)
{
  for (int64_t slice = 0; slice < f->particles->slices; ++slice)
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane)
        if (f->intact[slot] >> lane & 1) return &f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
  fail_msg("the body has no bonds between lattices");
  return NULL;
}

static void a_neighbour_beyond_the_body_or_out_of_reach_is_seen(void **state)
{
  (void)state;
  for (int way = 0; way < 4; ++way) {
    breccia_model *model = cracked_plate();
    Family *f = &model->domain.family;
    if (way == 0) f->reach /= 2;
    if (way == 1) f->base[f->first[5] + f->entry[5]] += (int32_t)model->domain.particles->places;
    if (way == 2) *stored_neighbour(f) = (int32_t)model->domain.particles->places;
    if (way == 3) f->stored[3] = f->first[4] + 1;
    assert_false(family_is_valid(f));
    breccia_model_destroy(&model);
  }
}

/** Of a box in slices of eight, families differ only by how far the six faces are: of a horizon of three spacings there are at most seven such distances along
 *  each of two axes, and along rows as many slices as begin or end within three spacings of a face, or in between. Each list leads to the
 *  neighbours that reference positions say. */
static void slices_inside_a_box_share_lists_of_slots(void **state)
{
  (void)state;
  breccia_model *model = model_of("materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0.2}}\n"
                                  "body: {b: {material: m, spacing: 1, shape: {box: {particles: [32, 20, 20]}}}}\n"
                                  "solve: {explicit: {steps: 1}}\n");
  const Family *f = &model->domain.family;
  const Particles *p = model->domain.particles;
  int64_t lists = 0, longest = 0;
  uint8_t *seen = calloc((size_t)f->entries + 1, 1);
  for (int64_t s = 0; s < p->slices; ++s) {
    const int64_t entry = f->first[s] + f->entry[s], length = f->first[s + 1] - f->first[s];
    lists += !seen[entry];
    seen[entry] = 1;
    if (length > longest) longest = length;
    for (int64_t slot = f->first[s]; slot < f->first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        const Bond bond = family_bond(f, s, slot, lane);
        for (int k = 0; k < 3; ++k)
          assert_near(p->position[k][bond.neighbour] - p->position[k][s * SLICE + lane], bond.xi[k], 1e-12);
      }
  }
  assert_int_equal(p->slices, 4 * 20 * 20);
  assert_true(lists <= 7 * 7 * 3);
  assert_true(f->entries <= lists * longest);
  free(seen);
  breccia_model_destroy(&model);
}

static void points_out_of_order_are_seen(void **state)
{
  (void)state;
  for (int way = 0; way < 5; ++way) {
    breccia_model *model = cracked_plate();
    Points *p = &model->domain.regions[0].points;
    assert_true(points_is_valid(p));
    double *trial = p->trial;
    if (way == 0) p->runs[0].first += 1;
    if (way == 1) p->runs[0].material = p->material_count;
    if (way == 2) p->count += 1;
    if (way == 3) p->trial = p->committed;
    if (way == 4) p->history_first[0] += 1;
    assert_false(points_is_valid(p));
    p->trial = trial;
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(families_of_bodies_are_valid_also_with_broken_bonds),
      cmocka_unit_test(a_bond_of_one_end_only_is_seen),
      cmocka_unit_test(a_neighbour_beyond_the_body_or_out_of_reach_is_seen),
      cmocka_unit_test(slices_inside_a_box_share_lists_of_slots),
      cmocka_unit_test(points_out_of_order_are_seen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What is told of bodies of links: stress, strain and energies of uniform fields, words of 'check', radii of gyration,
 * torsion. */
#include "formulation/micropolar.h"

#include "base/random.h"
#include "base/tensor.h"
#include "support.h"

#include <unistd.h>

static const double young = 1e4, poisson = 0.2, spacing = 0.1;

/** @param[in] where  shape or file, and lattice */
static breccia_model *body(const char *where, const char *space, const char *words)
{
  breccia_model *model =
      model_of("units: {length: m, force: kN, time: s}\n"
               "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
               "body: {b: {material: m, spacing: 0.1, %s %s}}\n"
               "peridynamics: {formulation: micropolar, space: %s %s}\nsolve: {explicit: {steps: 1}}\n",
               *space == 'p' ? "thickness: 0.3," : "", where, space, words);
  model->threads = 1;
  return model;
}

#define PLANE(lattice) "lattice: " lattice ", shape: {box: {particles: [12, 12]}}"
#define SOLID(lattice) "lattice: " lattice ", shape: {box: {particles: [7, 8, 9]}}"

static const struct Case {
  const char *where, *space;
} cases[] = {{PLANE("hexagonal"), "plane stress"}, {PLANE("hexagonal"), "plane strain"},
             {PLANE("square"), "plane stress"},    {PLANE("square"), "plane strain"},
             {SOLID("face-centred cubic"), "3-D"}, {SOLID("cubic"), "3-D"}};
enum { CASES = sizeof cases / sizeof *cases };

/** The place of a particle all of whose links are there. */
static int32_t inner_place(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  int32_t found = 0;
  int most = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    const int count = family_count(&model->domain.family, p->place_of[n]);
    if (count <= most) continue;
    most = count;
    found = p->place_of[n];
  }
  return found;
}

/** Hooke's law of the space for the six strains, and the strain across plane stress. */
static void uniform_strain_is_told_with_its_stress(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; ++c) {
    const bool plane = *cases[c].space == 'p', free = !strcmp(cases[c].space, "plane stress");
    breccia_model *model = body(cases[c].where, cases[c].space, "");
    const Region *region = &model->domain.regions[0];
    const int32_t place = inner_place(model);
    const double e[6] = {3e-7, -1e-7, plane ? 0 : 2e-7, 4e-7, plane ? 0 : -2e-7, plane ? 0 : 5e-7}, /* xy yz zx */
        f[9] = {1 + e[0], e[3], e[5], e[3], 1 + e[1], e[4], e[5], e[4], 1 + e[2]};
    const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    const double across = free ? -poisson / (1 - poisson) * (e[0] + e[1]) : e[2];
    double s[6], told[9];
    deform_uniformly(model, f); /* without rotation: the links of particles that do not turn feel the strain alone */
    region->type->stress(region->formulation, place, s);
    for (int k = 0; k < 6; ++k) {
      const double normal = lambda * (e[0] + e[1] + across) + 2 * mu * (k == ZZ ? across : e[k]);
      assert_near(s[k] / (1e-7 * young), (k < 3 ? normal : 2 * mu * e[k]) / (1e-7 * young), 1e-5);
    }
    region->type->gradient(region->formulation, place, told);
    for (int k = 0; k < 9; ++k) assert_near(1e7 * (told[k] - (k == 8 ? 1 + across : f[k])), 0, 1e-5);
    breccia_model_destroy(&model);
  }
}

/** What bonds have received by the end of a step is what they store less half of what their forces and moments of that
 *  end do along it. */
static void what_links_receive_is_the_work_on_them(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; c += 2) {
    breccia_model *model = body(cases[c].where, cases[c].space, ", horizon: 1.8 spacings");
    const Particles *p = model->domain.particles;
    const Region *region = &model->domain.regions[0];
    const double step = 1e-3;
    uint64_t seed = 5;
    double power = 0, stored = 0, received = 0;
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < p->space.rows; ++k) {
        if (k < p->space.rotation && k >= model->domain.body.dimensions) continue;
        p->displacement.row[k][p->place_of[n]] = (k < p->space.rotation ? spacing : 1) * 1e-3 * random_uniform(&seed);
        p->velocity.row[k][p->place_of[n]] = (k < p->space.rotation ? spacing : 1) * random_uniform(&seed);
      }
    compute_forces(model);
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      StoredEnergy energy;
      region->type->stored_energy(region->formulation, i, step, &energy);
      stored += energy.stored;
      received += energy.received;
      for (int k = 0; k < p->space.rows; ++k) power -= p->volume[i] * p->internal.row[k][i] * p->velocity.row[k][i];
    }
    assert_true(stored > 0 && fabs(power * step) > 1e-6 * stored);
    assert_near((stored - received) / (step * power / 2), 1, 1e-9);
    breccia_model_destroy(&model);
  }
}

/** Half the force that one end gives to each link adds up, over both ends, to the force on a particle. */
static void halves_of_links_add_up_to_forces(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; c += 2) {
    breccia_model *model = body(cases[c].where, cases[c].space, "");
    const Particles *p = model->domain.particles;
    const Family *f = &model->domain.family;
    const Region *region = &model->domain.regions[0];
    uint64_t seed = 9;
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < p->space.rows; ++k)
        if (k >= p->space.rotation || k < model->domain.body.dimensions)
          p->displacement.row[k][p->place_of[n]] = (k < p->space.rotation ? spacing : 1) * 1e-3 * random_uniform(&seed);
    compute_forces(model);
    const int32_t place = inner_place(model);
    double sum[3] = {0}, half[3];
    for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const Bond bond = family_bond(f, place / SLICE, slot, place % SLICE);
      region->type->half_state(region->formulation, p->displacement.row, NULL, place / SLICE, slot, place % SLICE,
                               half);
      for (int k = 0; k < 3; ++k) sum[k] += 2 * half[k] * p->volume[bond.neighbour];
    }
    for (int k = 0; k < model->domain.body.dimensions; ++k) assert_near(sum[k] / p->internal.row[k][place], 1, 1e-9);
    breccia_model_destroy(&model);
  }
}

/** And the changes of those halves, along a motion, to the change of the force. */
static void halves_of_changes_add_up_to_the_change(void **state)
{
  (void)state;
  for (int c = 0; c < CASES; c += 2) {
    breccia_model *model = body(cases[c].where, cases[c].space, "");
    const Particles *p = model->domain.particles;
    const Family *f = &model->domain.family;
    const Region *region = &model->domain.regions[0];
    const int32_t place = inner_place(model);
    uint64_t seed = 21;
    Vector at = {0};
    double sum[3] = {0}, half[3];
    assert_true(vector_create(&at, &p->space, "test", NULL));
    for (int k = 0; k < p->space.rows; ++k) {
      for (int64_t n = 0; n < p->count; ++n) {
        if (k < p->space.rotation && k >= model->domain.body.dimensions) continue;
        at.row[k][p->place_of[n]] = (k < p->space.rotation ? spacing : 1) * 1e-2 * random_uniform(&seed);
        p->displacement.row[k][p->place_of[n]] = (k < p->space.rotation ? spacing : 1) * random_uniform(&seed);
      }
    }
    const Sweep sweep = {.displacement = p->displacement.row, .linearised_at = at.row, .internal = p->internal.row};
    micropolar_resist_changes_one_by_one(region->formulation, &sweep, place / SLICE, false);
    for (int64_t slot = f->first[place / SLICE]; slot < f->first[place / SLICE + 1]; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const Bond bond = family_bond(f, place / SLICE, slot, place % SLICE);
      region->type->half_state(region->formulation, p->displacement.row, at.row, place / SLICE, slot, place % SLICE,
                               half);
      for (int k = 0; k < 3; ++k) sum[k] += 2 * half[k] * p->volume[bond.neighbour];
    }
    for (int k = 0; k < model->domain.body.dimensions; ++k) assert_near(sum[k] / p->internal.row[k][place], 1, 1e-9);
    vector_destroy(&at);
    breccia_model_destroy(&model);
  }
}

static void check_tells_axial_and_bending_stiffness_of_links(void **state)
{
  (void)state;
  const double nu = poisson, s = spacing, thick = 0.3;
  breccia_model *model = body(PLANE("hexagonal"), "plane stress", "");
  char words[128];
  snprintf(words, sizeof words, "b: links are right in every direction; 0.1 m long: EA %.4g kN, EI %.4g kN*m2\n",
           young * s * thick / (sqrt(3) * (1 - nu)),
           young * s * s * s * thick * (1 - 3 * nu) / (12 * sqrt(3) * (1 - nu * nu)));
  if (!strstr(breccia_model_overview(model), words)) fail_msg("no '%s' in %s", words, breccia_model_overview(model));
  breccia_model_destroy(&model);
  model = body(SOLID("face-centred cubic"), "3-D", "");
  const char *told = strstr(breccia_model_overview(model), "links are right in every direction; ");
  double length[2], axial[2], bending[2];
  assert_non_null(told);
  assert_int_equal(sscanf(told + strlen("links are right in every direction; "),
                          "%lf m long: EA %lf kN, EI %lf kN*m2; %lf m long: EA %lf kN, EI %lf", &length[0], &axial[0],
                          &bending[0], &length[1], &axial[1], &bending[1]),
                   6);
  for (int k = 0; k < 2; ++k) {
    const bool second = length[k] > 1.2 * s;
    const double by = 1 / ((1 + nu) * (1 - 2 * nu));
    assert_near(length[k], second ? sqrt(2) * s : s, 1e-4);
    assert_near(axial[k] / (second ? young * nu * s * s / 2 * by : sqrt(2) * young * s * s / 4 * by), 1, 1e-3);
    assert_near(bending[k] / (sqrt(2) * young * s * s * s * s * (1 - 4 * nu) / 48 * by), second ? 0 : 1, 1e-3);
  }
  assert_true(fabs(length[0] - length[1]) > 0.03);
  breccia_model_destroy(&model);
}

/** Of lattices that are right in the mean only, between which shares of the wanted stiffness a strain in one direction
 *  lies: least and largest stand along the axes and the diagonals of square and cubic lattices. */
static void check_tells_how_unlike_the_directions_are(void **state)
{
  (void)state;
  const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = space ? body(SOLID("cubic"), "3-D", ", horizon: 2.1 spacings")
                                 : body(PLANE("square"), "plane strain", ", horizon: 2.1 spacings");
    const Region *region = &model->domain.regions[0];
    const int32_t place = inner_place(model);
    const double ways[3][3] = {{1, 0, 0}, {sqrt(0.5), sqrt(0.5), 0}, {sqrt(1.0 / 3), sqrt(1.0 / 3), sqrt(1.0 / 3)}};
    double least = INFINITY, largest = 0, told[2];
    for (int w = 0; w < (space ? 3 : 2); ++w) {
      const double *n = ways[w];
      double f[9];
      StoredEnergy energy;
      for (int k = 0; k < 9; ++k) f[k] = (k % 4 == 0) + 1e-6 * n[k / 3] * n[k % 3];
      deform_uniformly(model, f);
      region->type->stored_energy(region->formulation, place, 0, &energy);
      const double share = energy.stored / (model->domain.particles->volume[place] * (lambda / 2 + mu) * 1e-12);
      least = fmin(least, share);
      largest = larger_of(largest, share);
    }
    const char *words = strstr(breccia_model_overview(model), "stretched in one direction only its lattice shows ");
    assert_non_null(words);
    assert_int_equal(sscanf(words + strlen("stretched in one direction only its lattice shows "),
                            "%lf to %lf of the wanted stiffness", &told[0], &told[1]),
                     2);
    assert_true(largest - least > 0.005);
    assert_near(told[0], least, 0.002);
    assert_near(told[1], largest, 0.002);
    breccia_model_destroy(&model);
  }
}

#define FILE_NAME "test_micropolar_readings.csv"

/** Particles are cells of their lattice: I = area / 6 of squares about their axis, side^2 / 6 of cubes about any; and so
 *  those that stand anywhere. */
static void particles_turn_like_their_cells(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space)
    for (int file = 0; file < 2; ++file) {
      FILE *table = fopen(FILE_NAME, "w");
      assert_non_null(table);
      fputs(space ? "x (m),y (m),z (m),volume (m3)\n" : "x (m),y (m),volume (m3)\n", table);
      for (int n = 0; n < 27; ++n) /* every second one is half as large as the others: the mean counts */
        if (space)
          fprintf(table, "%g,%g,%g,%g\n", 0.1 * (n % 3), 0.1 * (n / 3 % 3), 0.1 * (n / 9), n % 2 ? 4e-4 : 8e-4);
        else if (n < 9)
          fprintf(table, "%g,%g,%g\n", 0.1 * (n % 3), 0.1 * (n / 3), n % 2 ? 1.5e-3 : 3e-3);
      fclose(table);
      breccia_model *model = body(file    ? space ? "file: " FILE_NAME : "lattice: square, file: " FILE_NAME
                                  : space ? "shape: {box: {particles: [3, 3, 3]}}"
                                          : "lattice: square, shape: {box: {particles: [3, 3]}}",
                                  space ? "3-D" : "plane strain", "");
      const Region *region = &model->domain.regions[0];
      const double one = !file   ? spacing * spacing
                         : space ? pow((14 * 8e-4 + 13 * 4e-4) / 27, 2.0 / 3)
                                 : (5 * 3e-3 + 4 * 1.5e-3) / 9 / 0.3;
      const int32_t place = model->domain.particles->place_of[4];
      assert_near(region->type->gyration(region->formulation, place) / (one / 6), 1, space && !file ? 2e-3 : 1e-12);
      breccia_model_destroy(&model);
      unlink(FILE_NAME);
    }
}

/** Blocks of particles from files turn like cells of their own mean size. */
static void blocks_from_files_have_cells_of_their_own(void **state)
{
  (void)state;
  static const char *const names[] = {"test_micropolar_one.csv", "test_micropolar_two.csv"};
  const double volumes[] = {3e-3, 0.75e-3};
  for (int b = 0; b < 2; ++b) {
    FILE *table = fopen(names[b], "w");
    assert_non_null(table);
    fputs("x,y,volume\n", table);
    for (int n = 0; n < 16; ++n)
      fprintf(table, "%g,%g,%g\n", 5 * b + sqrt(volumes[b] / 0.3) * (n % 4), sqrt(volumes[b] / 0.3) * (n / 4),
              volumes[b]);
    fclose(table);
  }
  breccia_model *model =
      model_of("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
               "body:\n  one: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, file: %s}\n"
               "  two: {material: m, lattice: square, spacing: 0.05, thickness: 0.3, file: %s}\n"
               "peridynamics: {formulation: micropolar, space: plane strain, horizon: 0.21}\n"
               "solve: {explicit: {steps: 1}}\n",
               names[0], names[1]);
  const Region *region = &model->domain.regions[0];
  for (int b = 0; b < 2; ++b) {
    const int32_t place = model->domain.particles->place_of[16 * b + 5];
    assert_near(region->type->gyration(region->formulation, place), volumes[b] / 0.3 / 6, 1e-12);
    unlink(names[b]);
  }
  breccia_model_destroy(&model);
}

static void torsion_is_a_share_of_that_of_round_beams(void **state)
{
  (void)state;
  const char *const words[] = {", torsion: 2.5", ", torsion: 0", ""};
  const double shares[] = {2.5, 0, 1};
  for (int k = 0; k < 3; ++k) {
    breccia_model *model = body(SOLID("cubic"), "3-D", words[k]);
    const Micropolar *m = model->domain.regions[0].formulation;
    const LinkConstants *of = &m->constants[0];
    /* G J / E I of a round beam: 2 G / E */
    const double share = shares[k] / (1 + poisson);
    assert_near(of->any.twist / of->any.bending, share, 1e-12);
    for (int l = 0; l < of->lengths; ++l)
      assert_near(of->of[l].twist, share * of->of[l].bending, 1e-12 * of->any.axial * spacing * spacing);
    breccia_model_destroy(&model);
  }
}

/** Hexagonal lattices have the rows of the thesis: three of them are 47 loaded particles at each end of its plate of 15 in, and its deep beam has 3703. */
static void lattices_have_the_rows_of_the_thesis(void **state)
{
  (void)state;
  breccia_model *model = NULL;
  assert_int_equal(breccia_model_load_file(EXAMPLES "/concrete-tension/plate.yaml", NULL, &model, NULL), 0);
  assert_int_equal(model->loading.count, 2);
  for (int n = 0; n < 2; ++n) assert_int_equal(model->loading.loads[n].selection.count, 47);
  breccia_model_destroy(&model);
  assert_int_equal(breccia_model_load_file(EXAMPLES "/deep-beam/beam.yaml", NULL, &model, NULL), 0);
  assert_int_equal(model->domain.particles->count, 3703);
  breccia_model_destroy(&model);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform_strain_is_told_with_its_stress),
      cmocka_unit_test(what_links_receive_is_the_work_on_them),
      cmocka_unit_test(halves_of_links_add_up_to_forces),
      cmocka_unit_test(halves_of_changes_add_up_to_the_change),
      cmocka_unit_test(check_tells_axial_and_bending_stiffness_of_links),
      cmocka_unit_test(check_tells_how_unlike_the_directions_are),
      cmocka_unit_test(particles_turn_like_their_cells),
      cmocka_unit_test(blocks_from_files_have_cells_of_their_own),
      cmocka_unit_test(torsion_is_a_share_of_that_of_round_beams),
      cmocka_unit_test(lattices_have_the_rows_of_the_thesis),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Ordinary state-based peridynamics against closed forms, published figures, other formulations and its own invariants. */
#include "base/random.h"
#include "base/tensor.h"
#include "ordinary_body.h"
#include "solver/stable_step.h"

#define SOLVE "solve: {explicit: {steps: 1, time step: 1e-12}}\n"

static breccia_model *body_of(const char *material, const char *peridynamics, const char *block)
{
  return model_of("materials: {m: {model: elastic, density: 1, %s}}\nperidynamics: {formulation: ordinary, %s}\n"
                  "body: {b: {material: m, %s}}\n" SOLVE,
                  material, peridynamics, block);
}

static void two_points_and_a_cube_have_the_forces_of_another_program(void **state)
{
  (void)state;
  /* validation U1: unit volumes from 1 to 2 apart: m = 1, theta = 3, e_d = 0, force density 18 K. */
  const char *moduli = "bulk modulus: 130e9, shear modulus: 78e9";
  breccia_model *m =
      body_of(moduli, "horizon: 1.1, lattice weights: plain", "spacing: 1, shape: {box: {particles: [2, 1, 1]}}");
  const Particles *p = m->domain.particles;
  p->displacement.row[0][p->place_of[1]] = 1;
  compute_forces(m);
  assert_near(weighted_volume(m, p->place_of[0]), 1, 1e-14);
  assert_near(ordinary_of(m)->dilatation[p->place_of[0]], 3, 1e-13);
  assert_near(p->internal.row[0][p->place_of[0]], 2.34e12, 1e-12 * 2.34e12);
  assert_near(p->internal.row[0][p->place_of[1]], -2.34e12, 1e-12 * 2.34e12);
  breccia_model_destroy(&m);

  /* U2: a unit cube of eight points, z compressed to 0.98: A = 0, b = 9.75e10. */
  m = body_of(moduli, "horizon: 1.8, lattice weights: plain", "spacing: 1, shape: {box: {particles: [2, 2, 2]}}");
  p = m->domain.particles;
  deform_uniformly(m, (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 0.98});
  compute_forces(m);
  for (int32_t n = 0; n < 8; ++n) {
    const int32_t place = p->place_of[n];
    double force[3] = {0};
    assert_near(weighted_volume(m, place), 12, 1e-13);
    assert_near(ordinary_of(m)->dilatation[place], -0.01991593994643333, 1e-14);
    for (int32_t other = 0; other < 8; ++other) {
      double y[3], deformed = 0, reference = 0;
      for (int k = 0; k < 3; ++k) {
        const double xi = p->position[k][p->place_of[other]] - p->position[k][place];
        y[k] = xi * (k == 2 ? 0.98 : 1);
        deformed += y[k] * y[k];
        reference += xi * xi;
      }
      for (int k = 0; k < 3 && other != n; ++k)
        force[k] += 2 * 9.75e10 * (sqrt(deformed) - sqrt(reference)) * y[k] / sqrt(deformed);
    }
    for (int k = 0; k < 3; ++k) assert_near(p->internal.row[k][place], force[k], 1e-11 * 1e10);
  }
  breccia_model_destroy(&m);
}

static void weighted_volumes_and_deviators_of_a_ball_are_those_published(void **state)
{
  (void)state;
  /* validation U4: horizon 1, cubes of n^3 cells of 2 / n; U5: |e_d|^2 in simple shear of 1e-6, which is 4 pi gamma^2 / 75. */
  const int cells[] = {3, 5, 7, 9, 11, 13, 17};
  const double moments[] = {3.950617, 3.502080, 2.490391, 2.594726, 2.764640, 2.655369, 2.481106};
  for (size_t k = 0; k < sizeof cells / sizeof *cells; ++k) {
    char block[128];
    snprintf(block, sizeof block, "spacing: %.17g, shape: {box: {particles: [%d, %d, %d]}}", 2.0 / cells[k], cells[k],
             cells[k], cells[k]);
    breccia_model *m = body_of("bulk modulus: 1, shear modulus: 1", "horizon: 1, lattice weights: plain", block);
    const Particles *p = m->domain.particles;
    const int32_t middle = p->place_of[p->count / 2];
    assert_near(weighted_volume(m, middle), moments[k], 5.1e-7);
    if (cells[k] == 17) {
      const double gamma = 1e-6;
      StoredEnergy energy;
      deform_uniformly(m, (const double[]){1, gamma, 0, 0, 1, 0, 0, 0, 1});
      compute_forces(m);
      ordinary_stored_energy(ordinary_of(m), middle, 0, &energy);
      const double square =
          2 * energy.stored / p->volume[middle] * weighted_volume(m, middle) / 15; /* theta is of the second order */
      assert_near(square, 1.638950e-13, 1e-18);
    }
    breccia_model_destroy(&m);
  }
}

/** A field of displacements with all wave lengths. */
static void wiggle(const breccia_model *m, double size)
{
  const Particles *p = m->domain.particles;
  uint64_t seed = 5;
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < m->domain.body.dimensions; ++k)
      p->displacement.row[k][p->place_of[n]] = size * (random_uniform(&seed) - 0.5);
}

static void with_the_poisson_ratio_of_bonds_it_is_bond_based_inside(void **state)
{
  (void)state;
  /* validation U3: A = 0, and omega 1 / L of the one is omega 1 of the other. */
  const char *const spaces[] = {"3-D", "plane strain", "plane stress"};
  const double ratio[] = {0.25, 0.25, 1. / 3};
  for (int k = 0; k < 3; ++k) {
    const char *block = k ? "lattice: square, thickness: 0.3, spacing: 1, shape: {box: {particles: [17, 17]}}"
                          : "spacing: 1, shape: {box: {particles: [15, 15, 15]}}";
    char material[64], words[160];
    snprintf(material, sizeof material, "Young modulus: 150, Poisson ratio: %.17g", ratio[k]);
    snprintf(words, sizeof words, "space: %s, influence: inverse, lattice weights: plain", spaces[k]);
    breccia_model *m = body_of(material, words, block),
                  *bonds = model_of(
                      "materials: {m: {model: elastic-1d, density: 1, Young modulus: 150}}\n"
                      "peridynamics: {formulation: bond-based, space: %s}\nbody: {b: {material: m, %s}}\n" SOLVE,
                      spaces[k], block);
    const Particles *p = m->domain.particles, *q = bonds->domain.particles;
    const double size[3] = {k ? 17 : 15, k ? 17 : 15, k ? 0 : 15};
    int inside = 0;
    wiggle(m, 0.1);
    wiggle(bonds, 0.1);
    compute_forces(m);
    compute_forces(bonds);
    for (int32_t n = 0; n < p->count; ++n) {
      if (!is_inside(p, size, p->place_of[n], 6)) continue;
      ++inside;
      for (int c = 0; c < 3; ++c)
        assert_near(p->internal.row[c][p->place_of[n]], q->internal.row[c][q->place_of[n]], 1e-12 * 50);
    }
    assert_true(inside > 20);
    breccia_model_destroy(&m);
    breccia_model_destroy(&bonds);
  }
}

typedef struct Case {
  const char *space, *block, *words;
  double size[3]; /* of the body; 0: none that way */
} Case;

#define CUBE "spacing: 1, shape: {box: {particles: [17, 16, 15]}}"
#define FCC "lattice: face-centred cubic, spacing: 1, shape: {box: {from: [0, 0, 0], to: [14, 14, 14]}}"
#define SQUARE "lattice: square, spacing: 1, thickness: 0.4, shape: {box: {particles: [19, 17]}}"
#define HEXAGONAL "lattice: hexagonal, spacing: 1, thickness: 0.4, shape: {box: {from: [0, 0], to: [18, 18]}}"

static const Case cases[] = {
    {"3-D", CUBE, "influence: constant", {17, 16, 15}},
    {"3-D", CUBE, "horizon: 2.015 spacings", {17, 16, 15}},
    {"3-D", CUBE, "influence: conical", {17, 16, 15}},
    {"3-D", CUBE, "influence: gaussian, volume correction: partial-beyond", {17, 16, 15}},
    {"3-D", FCC, "horizon: 2.015 spacings", {14, 14, 14}},
    {"plane strain", SQUARE, "influence: constant", {19, 17, 0}},
    {"plane strain", HEXAGONAL, "influence: inverse", {18, 18, 0}},
    {"plane stress", SQUARE, "horizon: 2.015 spacings", {19, 17, 0}},
    {"plane stress", HEXAGONAL, "volume correction: partial", {18, 18, 0}},
};
enum { CASES = sizeof cases / sizeof *cases };

/** Hooke's stress of small strains (engineering shear), E = 150, nu = 0.3, by space. @param[in,out] e  zz is set */
static void hooke(const char *space, double e[6], double s[6])
{
  const double shear = 150 / 2.6, lambda = 150 * 0.3 / (1.3 * 0.4);
  if (!strcmp(space, "plane stress")) e[ZZ] = -0.3 / 0.7 * (e[XX] + e[YY]);
  for (int k = 0; k < 6; ++k) s[k] = k < 3 ? lambda * (e[XX] + e[YY] + e[ZZ]) + 2 * shear * e[k] : shear * e[k];
}

static void uniform_strain_gives_hookes_stress_and_no_force_inside(void **state)
{
  (void)state;
  /* In any direction: the lattice's weights are isotropic. Small strains, as stretches of bonds are not Green-Lagrange's. */
  const double h = 1e-7, g[9] = {1, 0.7, -0.4, 0.1, -0.6, 0.5, 0.3, -0.2, 0.8};
  for (int c = 0; c < CASES; ++c) {
    char words[160];
    snprintf(words, sizeof words, "space: %s, %s", cases[c].space, cases[c].words);
    breccia_model *m = body_of("Young modulus: 150, Poisson ratio: 0.3", words, cases[c].block);
    Domain *d = &m->domain;
    const Particles *p = d->particles;
    const bool plane = d->body.dimensions == 2;
    double f[9], e[6], wanted[6], energy = 0;
    for (int k = 0; k < 9; ++k) f[k] = (k % 4 == 0) + h * (plane && (k > 4 || k == 2) ? 0 : g[k]);
    for (int k = 0; k < 6; ++k)
      e[k] = (f[3 * symmetric_row[k] + symmetric_column[k]] + f[3 * symmetric_column[k] + symmetric_row[k]] -
              2 * (k < 3)) /
             (k < 3 ? 2 : 1);
    hooke(cases[c].space, e, wanted);
    for (int k = 0; k < 6; ++k) energy += wanted[k] * e[k] / 2;
    deform_uniformly(m, f);
    compute_forces(m);
    double largest = 0;
    int inside = 0;
    for (int32_t n = 0; n < p->count; ++n) largest = larger_of(largest, fabs(p->internal.row[0][p->place_of[n]]));
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t place = p->place_of[n];
      const double reach = d->family.horizon + 0.51;
      double strain[6], stress[6];
      StoredEnergy stored;
      if (!is_inside(p, cases[c].size, place, reach)) continue;
      domain_look(d, place, strain, stress);
      d->regions[0].type->stored_energy(d->regions[0].formulation, place, 0, &stored);
      for (int k = 0; k < 6; ++k) {
        assert_near(strain[k], e[k], 2e-6 * h);
        assert_near(stress[k], wanted[k], 3e-6 * 150 * h);
      }
      assert_near(stored.stored / p->volume[place], energy, 1e-6 * energy);
      if (!is_inside(p, cases[c].size, place, 2 * reach)) continue;
      ++inside;
      for (int k = 0; k < 3; ++k) assert_near(p->internal.row[k][place], 0, 1e-9 * largest);
    }
    if (!inside) fail_msg("%s: no particle is inside", cases[c].block);
    breccia_model_destroy(&m);
  }
}

static void plain_weights_show_the_moduli_of_the_theory(void **state)
{
  (void)state;
  /* docs/theory.md 3: in stretching along the axes and in shear along them. */
  const struct {
    const char *words, *block;
    double stretched, sheared;
  } known[] = {{"volume correction: none", CUBE, 0.835, 1.110},
               {"volume correction: partial", CUBE, 0.873, 1.085},
               {"volume correction: partial-beyond", CUBE, 1.018, 0.988},
               {"space: plane strain", SQUARE, 1.035, 0.965},
               {"space: plane strain, horizon: 2.015 spacings", SQUARE, 1.43, 0.57}};
  for (size_t k = 0; k < sizeof known / sizeof *known; ++k) {
    char words[160];
    snprintf(words, sizeof words, "%s, lattice weights: plain", known[k].words);
    breccia_model *m = body_of("Young modulus: 150, Poisson ratio: 0.3", words, known[k].block);
    assert_near(ordinary_lattice_shear(ordinary_of(m), 0, (const double[]){1, -1, 0, 0, 0, 0}), known[k].stretched,
                5e-3 / 3);
    assert_near(ordinary_lattice_shear(ordinary_of(m), 0, (const double[]){0, 0, 0, 1, 0, 0}), known[k].sheared,
                5e-3 / 3);
    breccia_model_destroy(&m);
  }
}

static void rigid_rotation_makes_no_force_and_momenta_are_kept(void **state)
{
  (void)state;
  const double c = cos(acos(-1) / 6), s = sin(acos(-1) / 6), turn[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  for (int k = 0; k < CASES; ++k) {
    char words[160];
    snprintf(words, sizeof words, "space: %s, %s", cases[k].space, cases[k].words);
    breccia_model *m = body_of("Young modulus: 150, Poisson ratio: 0.3", words, cases[k].block);
    const Particles *p = m->domain.particles;
    deform_uniformly(m, turn);
    compute_forces(m);
    for (int32_t n = 0; n < p->count; ++n)
      for (int a = 0; a < 3; ++a) assert_near(p->internal.row[a][p->place_of[n]], 0, 1e-12 * 150);
    wiggle(m, 0.2);
    compute_forces(m);
    double sum[3] = {0}, moment = 0, size = 0;
    for (int32_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      double y[2];
      for (int a = 0; a < 3; ++a) sum[a] += p->internal.row[a][i] * p->volume[i];
      for (int a = 0; a < 2; ++a) y[a] = p->position[a][i] + p->displacement.row[a][i];
      moment += (y[0] * p->internal.row[1][i] - y[1] * p->internal.row[0][i]) * p->volume[i];
      size += fabs(p->internal.row[0][i] * p->volume[i]);
    }
    for (int a = 0; a < 3; ++a) assert_near(sum[a], 0, 1e-13 * size);
    assert_near(moment, 0, 1e-12 * size);
    breccia_model_destroy(&m);
  }
}

/** Breaks a share of the bonds that are left. */
static void break_some(Domain *d, double share, uint64_t *seed)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(f, slice, slot, lane).neighbour;
        if (other > place && random_uniform(seed) < share) family_break(&d->family, place, other);
      }
  for (int64_t slice = 0; slice < p->slices; ++slice) d->regions[0].type->renew(d->regions[0].formulation, slice);
}

static void the_stable_step_does_not_fall_as_bonds_break(void **state)
{
  (void)state;
  const char *const blocks[] = {"spacing: 1, shape: {box: {particles: [10, 10, 10]}}", SQUARE, SQUARE};
  const char *const words[] = {"horizon: 3.015 spacings", "space: plane strain, influence: conical",
                               "space: plane stress, horizon: 2.015 spacings"};
  const double ratio[] = {0, 0.1, 0.25, 0.4, 0.49};
  for (int b = 0; b < 3; ++b)
    for (int k = 0; k < 5; ++k) {
      char material[64];
      snprintf(material, sizeof material, "Young modulus: 150, Poisson ratio: %g", ratio[k]);
      breccia_model *m = body_of(material, words[b], blocks[b]);
      uint64_t seed = 3;
      double whole, step;
      assert_int_equal(stable_step(&m->domain, &whole, NULL), 0);
      for (double gone = 0; gone < 0.9; gone += 0.15) {
        break_some(&m->domain, 0.15 / (1 - gone), &seed);
        assert_int_equal(stable_step(&m->domain, &step, NULL), 0);
        if (step < 0.999 * whole)
          fail_msg("%s, Poisson's ratio %g: %.3f of the stable step is left", words[b], ratio[k], step / whole);
      }
      breccia_model_destroy(&m);
    }
}

static void the_critical_stretch_spends_the_fracture_energy(void **state)
{
  (void)state;
  /* At the Poisson ratio of bonds that of theory 2; otherwise what a lattice of 12 spacings to the horizon sums up, halves drawn apart. */
  const double pi = acos(-1), energy = 80, horizon = 0.3;
  const Space spaces[] = {SPACE_3D, SPACE_PLANE_STRESS, SPACE_PLANE_STRAIN};
  const double known[] = {5. / 6, 4 * pi / 9, 5 * pi / 12}, ratio[] = {0.25, 1. / 3, 0.25};
  for (int k = 0; k < 3; ++k) {
    const Material like_bonds = {.bulk = 150 / (3 - 6 * ratio[k]), .shear = 150 / (2 + 2 * ratio[k])};
    const BondLength of = {spaces[k], influence_at(INFLUENCE_INVERSE), horizon, horizon / 3};
    const double wanted = sqrt(known[k] * energy / (150 * horizon));
    assert_near(ordinary_critical_stretch(&of, &like_bonds, energy), wanted, 1e-4 * wanted);

    enum { REACH = 12 };
    const BondLength constant = {spaces[k], influence_at(INFLUENCE_CONSTANT), horizon, horizon / 3};
    const Material other = {.bulk = 200, .shear = 60};
    const int depth = k ? 0 : REACH, d = k ? 2 : 3;
    const double limit = ordinary_critical_stretch(&constant, &other, energy);
    double whole = 0, spent = 0, part[REACH] = {0};
    for (int x = -REACH; x <= REACH; ++x)
      for (int y = -REACH; y <= REACH; ++y)
        for (int z = -depth; z <= depth; ++z) {
          const int square = x * x + y * y + z * z;
          if (!square || square > REACH * REACH) continue;
          whole += square;
          for (int layer = 0; layer < x; ++layer) part[layer] += square;
        }
    for (int layer = 0; layer < REACH; ++layer) {
      const double r = part[layer] / whole, shear = ordinary_shear(spaces[k], &other);
      spent +=
          horizon / REACH * limit * limit * ((d * d * ordinary_bulk(spaces[k], &other) - shear) * r * r + shear * r);
    }
    assert_near(spent, energy, 0.02 * energy); /* the lattice's own error */
  }
}

/** What `check` tells of a lattice: the shear moduli that patches show, over all directions, or the least and largest factor that makes them alike. */
static void check_tells_the_shear_modulus_of_the_lattice(void **state)
{
  (void)state;
  static const char *const bodies[] = {"spacing: 1, shape: {box: {particles: [9, 9, 9]}}",
                                       "spacing: 1, lattice: square, thickness: 1, shape: {box: {particles: [9, 9]}}"};
  const double shear = 1; /* of E = 2.5, nu = 0.25 */
  for (int plane = 0; plane < 2; ++plane)
    for (int plain = 0; plain < 2; ++plain) {
      char keys[100];
      snprintf(keys, sizeof keys, "space: %s, lattice weights: %s", plane ? "plane strain" : "3-D",
               plain ? "plain" : "isotropic");
      breccia_model *m = body_of("Young modulus: 2.5, Poisson ratio: 0.25", keys, bodies[plane]);
      const Particles *p = m->domain.particles;
      const double s = 1e-7;
      const int32_t middle = particles_nearest(p, (double[]){4.5, 4.5, plane ? 0 : 4.5});
      double strain[6], stress[6], least = INFINITY, largest = 0;
      for (int way = 0; way < 2; ++way) { /* pure shear along the axes, and across their diagonals */
        for (int k = 0; k < 3; ++k) memset(p->displacement.row[k], 0, sizeof(double) * (size_t)p->places);
        deform_uniformly(m,
                         way ? (double[]){1 + s, 0, 0, 0, 1 - s, 0, 0, 0, 1} : (double[]){1, s, 0, s, 1, 0, 0, 0, 1});
        compute_forces(m);
        domain_look(&m->domain, middle, strain, stress);
        const double found = (way ? (stress[XX] - stress[YY]) / 4 : stress[XY] / 2) / s;
        least = fmin(least, found / shear);
        largest = larger_of(largest, found / shear);
      }
      const Ordinary *o = ordinary_of(m);
      double light = INFINITY, heavy = 0;
      for (int k = 0; k < m->domain.family.pattern_count; ++k) {
        light = fmin(light, o->factor[k]);
        heavy = larger_of(heavy, o->factor[k]);
      }
      char *wanted =
          plain ? text_format("b: away from its surfaces the lattice shows the wanted bulk modulus, and %.3f to "
                              "%.3f of the wanted shear modulus\n",
                              least, largest)
                : text_format("b: away from its surfaces the lattice shows the wanted moduli in all directions, "
                              "for which its bonds count by factors of %.2f to %.2f\n",
                              light, heavy);
      assert_true(plain ? largest - least > 0.01 : largest - least < 1e-6 && heavy > 1.01 && light < 0.99);
      if (!strstr(breccia_model_overview(m), wanted)) fail_msg("no '%s' in: %s", wanted, breccia_model_overview(m));
      free(wanted);
      breccia_model_destroy(&m);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_points_and_a_cube_have_the_forces_of_another_program),
      cmocka_unit_test(weighted_volumes_and_deviators_of_a_ball_are_those_published),
      cmocka_unit_test(with_the_poisson_ratio_of_bonds_it_is_bond_based_inside),
      cmocka_unit_test(uniform_strain_gives_hookes_stress_and_no_force_inside),
      cmocka_unit_test(plain_weights_show_the_moduli_of_the_theory),
      cmocka_unit_test(rigid_rotation_makes_no_force_and_momenta_are_kept),
      cmocka_unit_test(the_critical_stretch_spends_the_fracture_energy),
      cmocka_unit_test(the_stable_step_does_not_fall_as_bonds_break),
      cmocka_unit_test(check_tells_the_shear_modulus_of_the_lattice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

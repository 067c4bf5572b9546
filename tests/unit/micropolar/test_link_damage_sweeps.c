/* Sweeps over damaged links: the sums of what links do one by one, in lattices and without, also beside other formulations. */
#include "link_bodies.h"

/* Bodies of links; those of two blocks have two laws. */
static const char plane_cloud[] =
    "b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, file: test_plane_links.csv}";
static const char space_cloud[] = "b: {material: m, spacing: 0.1, file: test_space_links.csv}";
static const char plane_blocks[] =
    "b: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.3, shape: {box: {particles: [19, 9]}}}\n"
    "  c: {material: n, lattice: square, spacing: 0.09, thickness: 0.3, shape: {box: "
    "{from: [1.93, 0.03], to: [2.74, 0.75]}}}";
static const char space_blocks[] =
    "b: {material: m, lattice: face-centred cubic, spacing: 0.1, shape: {box: {particles: [9, 6, 5]}}}\n"
    "  c: {material: n, lattice: cubic, spacing: 0.09, shape: {box: {from: [0.72, 0.03, 0.03], to: [1.08, "
    "0.39, 0.39]}}}";
#define OF(lattice, particles) "b: {material: m, lattice: " lattice ", spacing: 0.1, " particles "}"
#define PLATE "thickness: 0.3, shape: {box: {particles: [19, 9]}}"
#define CUBE "shape: {box: {particles: [11, 6, 5]}}"

/** One of them. */
static breccia_model *links_of(const char *body, const char *space, const char *loads)
{
  breccia_model *model = model_of(
      UNITS "materials:\n"
            "  m: {model: link-damage, density: 2, Young modulus: 1e7, Poisson ratio: 0.2, tensile stretch: 1e-4, "
            "compressive stretch: 2e-4, stiffness recovery: 0.4}\n"
            "  n: {model: link-damage, density: 2, Young modulus: 3e7, Poisson ratio: 0.2, tensile stretch: 2e-4, "
            "compressive stretch: 1e-4, stiffness recovery: 0.7, fracture energy: 0.6, initial fracture energy: 0.3}\n"
            "body:\n  %s\nperidynamics: {formulation: micropolar, space: %s, horizon: 1.8 spacings}\n%s"
            "solve: {explicit: {steps: 1}}\n",
      body, space, loads);
  model->threads = 1;
  return model;
}

/** Whatever is damaged, forces and moments are in balance: both ends of a link find the same damage. */
static void damaged_bodies_keep_their_momenta(void **state)
{
  (void)state;
  const struct {
    const char *lattice, *particles, *space;
  } cases[] = {{"hexagonal", "[19, 9]", "plane stress"},
               {"square", "[19, 9]", "plane strain"},
               {"face-centred cubic", "[9, 5, 5]", "3-D"},
               {plane_blocks, NULL, "plane stress"},
               {space_blocks, NULL, "3-D"}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    breccia_model *model = cases[c].particles
                               ? block("tensile stretch: 1e-4, compressive stretch: 2e-4, fracture energy: 0.05",
                                       cases[c].lattice, cases[c].particles, cases[c].space)
                               : links_of(cases[c].lattice, cases[c].space, "");
    const Particles *p = model->domain.particles;
    const Micropolar *m = formulation_of(model);
    for (uint64_t seed = 1; seed < 4; ++seed) {
      double sum[6] = {0}, most = 0;
      disturb(model, 1e-3, seed);
      compute_forces(model);
      domain_commit_points(&model->domain);
      for (int64_t n = 0; n < p->count; ++n) {
        const int32_t i = p->place_of[n];
        double y[3], f[3], moment[3] = {0}, arm[3];
        for (int k = 0; k < 3; ++k) {
          y[k] = p->position[k][i] + p->displacement.row[k][i];
          f[k] = p->volume[i] * p->internal.row[k][i];
          if (p->space.rows == 6) moment[k] = p->volume[i] * p->internal.row[p->space.rotation + k][i];
        }
        if (p->space.rows == 4) moment[2] = p->volume[i] * p->internal.row[p->space.rotation][i];
        vector_cross(y, f, arm);
        for (int k = 0; k < 3; ++k) {
          sum[k] += f[k];
          sum[3 + k] += arm[k] + moment[k];
          most = larger_of(most, fabs(f[k]));
        }
      }
      double damaged = 0;
      for (int64_t i = 0; i < p->places; ++i) damaged += m->damage->damaged[i];
      assert_true(damaged > 20);
      for (int k = 0; k < 6; ++k) assert_near(sum[k] / most, 0, 1e-11);
    }
    breccia_model_destroy(&model);
  }
}

/** Tensile damage of a link as tried. */
static double tension_of(const Micropolar *m, int64_t slice, int64_t slot, int lane)
{
  return m->damage->tension[m->damage->grown[slice] & GROWN_IN_TENSION ? 1 : 0][slot * SLICE + lane];
}

/** Particles that stand in no lattice. */
static void write_cloud(const char *name, const int n[3], double spacing)
{
  FILE *file = fopen(name, "w");
  uint64_t seed = 4;
  fprintf(file, "x,y,z,volume\n");
  for (int i = 0; i < n[0] * n[1] * n[2]; ++i) {
    const int at[3] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
    for (int k = 0; k < 3; ++k)
      fprintf(file, "%.17g,", spacing * (at[k] + (n[k] > 1 ? 0.3 * (random_uniform(&seed) - 0.5) : 0)));
    fprintf(file, "%.17g\n", spacing * spacing * (n[2] > 1 ? spacing : 0.3) * (0.9 + 0.2 * random_uniform(&seed)));
  }
  fclose(file);
}

/** A sweep over all slices at the displacements held. @param[in] at  of linearised steps; NULL: none */
static Sweep whole_sweep(const Particles *p, double *const *at)
{
  return (Sweep){
      .last = p->slices, .displacement = p->displacement.row, .linearised_at = at, .internal = p->internal.row};
}

/** Changes along a motion at the displacements held, by sweeps and link by link. */
static void check_changes(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  const Micropolar *m = formulation_of(model);
  Vector at = {0}, swept = {0};
  double largest[2] = {0};
  uint64_t seed = 8;
  assert_true(vector_create(&at, &p->space, "test", NULL) && vector_create(&swept, &p->space, "test", NULL));
  for (int k = 0; k < p->space.rows; ++k) {
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      at.row[k][i] = p->displacement.row[k][i];
      p->displacement.row[k][i] = (k < p->space.rotation ? 0.1 : 1) * (random_uniform(&seed) - 0.5);
      if (k < p->space.rotation && k >= model->domain.body.dimensions) p->displacement.row[k][i] = 0;
    }
  }
  const Sweep sweep = whole_sweep(p, at.row);
  if (m->sweeps->show_spins) m->sweeps->show_spins(m, &sweep);
  for (int64_t slice = 0; slice < p->slices; ++slice) {
    m->sweeps->resist_changes(m, &sweep, slice);
    for (int k = 0; k < p->space.rows; ++k)
      memcpy(swept.row[k] + slice * SLICE, p->internal.row[k] + slice * SLICE, SLICE * sizeof(double));
    micropolar_resist_changes_one_by_one(m, &sweep, slice, false);
  }
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i)
      largest[k >= p->space.rotation] = fmax(largest[k >= p->space.rotation], fabs(swept.row[k][i]));
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i)
      assert_near((swept.row[k][i] - p->internal.row[k][i]) / largest[k >= p->space.rotation], 0, 1e-10);
  assert_true(largest[0] > 0 && largest[1] > 0);
  vector_copy(&p->displacement, &at);
  vector_destroy(&at);
  vector_destroy(&swept);
}

/** Finds forces of all slices by sweeps once more. Which slots they went through, and that what was damaged counted. */
typedef struct Ways {
  int64_t stored, along_rows, weak;
} Ways;

static Ways ways_of(const breccia_model *model)
{
  const Micropolar *m = formulation_of(model);
  const Sweep sweep = whole_sweep(m->particles, NULL);
  Ways ways = {0};
  for (int64_t slice = 0; slice < m->particles->slices; ++slice) {
    m->sweeps->resist(m, &sweep, slice);
    ways.weak += micropolar_is_weak(m, slice);
    ways.along_rows += m->family->stored[slice] - m->family->first[slice];
    ways.stored += m->family->first[slice + 1] - m->family->stored[slice];
  }
  return ways;
}

/** Sweeps find what links do one by one, whatever share of its stiffness a closed one has back: where end rotations are as large as their series allow, where
 *  they are larger, up to half a turn, and between particles that stand in no lattice, or in two of other laws. */
static void sweeps_are_sums_of_damaged_links(void **state)
{
  (void)state;
  const struct {
    const char *body, *space;
    double turn;
  } cases[] = {{OF("hexagonal", PLATE), "plane stress", 5e-4},
               {OF("square", PLATE), "plane strain", 0.02},
               {plane_cloud, "plane stress", 0.02},
               {plane_blocks, "plane stress", 0.02},
               {OF("face-centred cubic", CUBE), "3-D", 5e-4},
               {OF("face-centred cubic", CUBE), "3-D", 0.016},
               {OF("cubic", CUBE), "3-D", 0.016},
               {space_cloud, "3-D", 0.016},
               {space_blocks, "3-D", 0.016},
               {OF("hexagonal", PLATE), "plane stress", 0.04}, /* some of the links beyond the series, beside others */
               {OF("face-centred cubic", CUBE), "3-D", 0.04},
               {OF("hexagonal", PLATE), "plane stress", 0.15}, /* from here on beyond the series */
               {OF("hexagonal", PLATE), "plane stress", 3},
               {plane_cloud, "plane strain", 3},
               {plane_blocks, "plane stress", 1.4},
               {OF("face-centred cubic", CUBE), "3-D", 0.15},
               {OF("face-centred cubic", CUBE), "3-D", 1.4},
               {space_cloud, "3-D", 1.4},
               {space_blocks, "3-D", 1.4}};
  write_cloud("test_plane_links.csv", (const int[]){17, 9, 1}, 0.1);
  write_cloud("test_space_links.csv", (const int[]){9, 6, 5}, 0.1);
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c)
    for (int shrunk = 0; shrunk < 2; ++shrunk) {
      breccia_model *model = links_of(
          cases[c].body, cases[c].space,
          shrunk ? "loads: [{on: {inside: {box: {from: [-9, -9, -9], to: [0.7, 9, 9]}}}, initial strain: -1e-4}]\n"
                 : "");
      const Particles *p = model->domain.particles;
      const Micropolar *m = formulation_of(model);
      const bool space = p->space.rows == 6;
      uint64_t seed = 7;
      for (int64_t i = 0; i < p->places && shrunk; ++i) p->free_strain[i] = -2e-4 * random_uniform(&seed);
      disturb(model, 1e-3, 5);
      compute_forces(model);
      domain_commit_points(&model->domain);
      disturb(model, 5e-4, 6); /* some that were torn have closed */
      for (int64_t i = 0; i < p->places; ++i)
        for (int k = p->space.rotation; k < p->space.rows; ++k) p->displacement.row[k][i] *= cases[c].turn / 5e-4;
      for (int64_t n = 0; n < p->count && space; n += 3) /* the same rotation, told otherwise */
        for (int k = 0; k < 4; ++k) p->orientation[k][p->place_of[n]] *= -1;
      compute_forces(model);
      const Ways ways = ways_of(model);
      const bool cloud = strstr(cases[c].body, "file") != NULL,
                 joined = cases[c].body == plane_blocks || cases[c].body == space_blocks;
      assert_int_equal(ways.weak, p->slices);
      assert_int_equal(ways.stored > 0, cloud || joined);
      assert_int_equal(ways.along_rows > 0, !cloud);
      double most[2] = {0}, *swept = calloc((size_t)(p->space.rows * p->places), sizeof(double));
      int closed = 0;
      const Sweep sweep = whole_sweep(p, NULL);
      for (int k = 0; k < p->space.rows; ++k) {
        memcpy(swept + k * p->places, p->internal.row[k], sizeof(double) * (size_t)p->places);
        for (int64_t i = 0; i < p->places; ++i)
          most[k >= p->space.rotation] = fmax(most[k >= p->space.rotation], fabs(p->internal.row[k][i]));
      }
      for (int64_t slice = 0; slice < p->slices; ++slice) {
        micropolar_resist_one_by_one(m, &sweep, slice, false);
        for (int64_t slot = m->family->first[slice]; slot < m->family->first[slice + 1]; ++slot)
          for (int lane = 0; lane < SLICE; ++lane)
            if (m->family->intact[slot] >> lane & 1 && tension_of(m, slice, slot, lane) > 0)
              closed += micropolar_link(m, p->displacement.row, slice, slot, lane).stretch < 0;
      }
      assert_true(closed > 10);
      for (int k = 0; k < p->space.rows; ++k)
        for (int64_t i = 0; i < p->places; ++i)
          assert_near((swept[k * p->places + i] - p->internal.row[k][i]) / most[k >= p->space.rotation], 0, 1e-11);
      for (int64_t n = 0; n < p->count; ++n) /* no forces are found there */
        p->displacement.row[p->space.rotation][p->place_of[n]] += 0.02 * random_uniform(&seed);
      double energies[2] = {0, domain_stored_energy(&model->domain)}; /* place by place, and by sweeps */
      for (int64_t n = 0; n < p->count; ++n) {
        StoredEnergy stored;
        model->domain.regions[0].type->stored_energy(m, p->place_of[n], 0, &stored);
        energies[0] += stored.stored;
      }
      assert_near(energies[1] / energies[0], 1, 1e-11);
      check_changes(model);
      free(swept);
      breccia_model_destroy(&model);
    }
  remove("test_plane_links.csv");
  remove("test_space_links.csv");
}

/** Links that are damaged beside another formulation: forces and moments have no sum, sweeps find what links do one by one, those of the joint with half of their
 *  stiffness, and energies are those of the links. */
static void links_are_damaged_beside_other_formulations(void **state)
{
  (void)state;
  const char *const beside[] = {"correspondence", "ordinary", "hybrid"};
  for (int c = 0; c < 6; ++c) {
    const bool space = c > 2;
    const char *lattice = space ? "" : "lattice: square, thickness: 0.3, ";
    breccia_model *model = model_of(
        UNITS
        "materials: {m: {model: link-damage, density: 2, Young modulus: 1e7, Poisson ratio: 0.2, tensile stretch: 1e-4,"
        " compressive stretch: 2e-4, stiffness recovery: 0.4}, n: {model: elastic, density: 2, Young modulus: 1e7,"
        " Poisson ratio: 0.2}}\n"
        "peridynamics: {space: %s, horizon: 1.5 spacings, formulation: micropolar, regions: {other: {blocks: [right],"
        " formulation: %s}}}\n"
        "body: {left: {material: m, spacing: 0.1, %sshape: {box: {from: [0, 0, 0], to: [0.9, 0.6, 0.5]}}}, right:"
        " {material: n, spacing: 0.1, %sshape: {box: {from: [0.9, 0, 0], to: [1.5, 0.6, 0.5]}}}}\n"
        "solve: {explicit: {steps: 1}}\n",
        space ? "3-D" : "plane strain", beside[c % 3], lattice, lattice);
    model->threads = 1;
    const Particles *p = model->domain.particles;
    const Micropolar *m = formulation_of(model);
    disturb(model, 1e-3, 5);
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = p->space.rotation; k < p->space.rows; ++k)
        if (!particles_turn(p, p->place_of[n])) p->displacement.row[k][p->place_of[n]] = 0;
    compute_forces(model);
    double sum[3] = {0}, size = 0, largest[2] = {0}, off[2] = {0}, energy = 0, missed = 0;
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < 3; ++k) {
        const double force = p->volume[p->place_of[n]] * p->internal.row[k][p->place_of[n]];
        sum[k] += force;
        size += fabs(force);
      }
    for (int k = 0; k < 3; ++k) assert_near(sum[k] / size, 0, 1e-13);
    int across = 0;
    const Sweep sweep = whole_sweep(p, NULL);
    for (int64_t slice = 0; slice < p->slices; ++slice) {
      if (m->foreign[slice]) continue;
      double swept[MAX_ROWS][SLICE], energies[SLICE];
      m->sweeps->resist(m, &sweep, slice);
      micropolar_resist_one_by_one(m, &sweep, slice, true);
      for (int k = 0; k < p->space.rows; ++k) memcpy(swept[k], p->internal.row[k] + slice * SLICE, sizeof swept[k]);
      micropolar_resist_one_by_one(m, &sweep, slice, false);
      for (int k = 0; k < p->space.rows; ++k)
        for (int lane = 0; lane < SLICE; ++lane) {
          const double there = p->internal.row[k][slice * SLICE + lane];
          largest[k >= p->space.rotation] = larger_of(largest[k >= p->space.rotation], fabs(there));
          off[k >= p->space.rotation] = larger_of(off[k >= p->space.rotation], fabs(swept[k][lane] - there));
        }
      model->domain.regions[0].type->stored_energies(m, slice, energies);
      for (int lane = 0; lane < SLICE; ++lane) {
        StoredEnergy stored;
        model->domain.regions[0].type->stored_energy(m, slice * SLICE + lane, 0, &stored);
        energy = larger_of(energy, stored.stored);
        missed = larger_of(missed, fabs(energies[lane] - stored.stored));
        for (int64_t slot = m->family->stored[slice]; slot < m->family->first[slice + 1]; ++slot)
          if (m->family->intact[slot] >> lane & 1 && tension_of(m, slice, slot, lane) > 0) {
            const Link weak = micropolar_link(m, p->displacement.row, slice, slot, lane);
            const LinkStiffness whole = micropolar_stiffness(m, slice * SLICE + lane, &weak.bond);
            if (!weak.alone) continue;
            ++across;
            assert_true(weak.stiffness.bending <= whole.bending && weak.stiffness.axial < whole.axial);
          }
      }
    }
    assert_true(across > 5);
    assert_true(energy > 0 && missed <= 1e-11 * energy);
    for (int k = 0; k < 2; ++k) assert_true(off[k] <= 1e-11 * largest[k]);
    breccia_model_destroy(&model);
  }
}

/** A bar whose half is a lattice that softens and breaks beside ordinary particles that do not, drawn until it is torn: the crack stays in the lattice and takes its
 *  fracture energy, that of one row of links and a part of those beside it, and the other half moves off as it was. */
static void a_lattice_tears_beside_an_elastic_half(void **state)
{
  (void)state;
  breccia_model *model = model_of(
      UNITS
      "materials: {m: {model: link-damage, density: 2, Young modulus: 1e7, Poisson ratio: 0.2, tensile stretch: 1e-4,"
      " compressive stretch: 1e-2, fracture energy: 0.08}, n: {model: elastic, density: 2, Young modulus: 1e7,"
      " Poisson ratio: 0.2}}\n"
      "peridynamics: {space: plane stress, horizon: 1.5 spacings, formulation: micropolar, regions: {other: {blocks:"
      " [right], formulation: ordinary}}}\n"
      "body: {left: {material: m, spacing: 0.1, lattice: square, thickness: 0.3, shape: {box: {from: [0, 0], to: [1,"
      " 0.6]}}}, right: {material: n, spacing: 0.1, lattice: square, thickness: 0.3, shape: {box: {from: [1, 0], to:"
      " [2, 0.6]}}}}\n"
      "loads: [{on: {face: x-, layers: 1}, displacement: [0, free]}, {on: {face: x+, layers: 1}, displacement: [5e-4,"
      " free], history: {ramp to: 0.05}}, {on: {nearest: [0, 0]}, displacement: [free, 0]}]\n"
      "solve: {explicit: {end time: 0.05, local damping: 0.3}}\n");
  model->threads = 1;
  while (!model->solver.clock.ended) step_surely(model, 50);
  const Energy e = solver_energy(&model->solver);
  const double spent = e.dissipated / (0.08 * 0.6 * 0.3);
  if (!(spent > 1 && spent < 1.6)) fail_msg("%g of the fracture energy", spent);
  assert_true(e.stored < 1e-3 * e.dissipated);
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n)
    if (p->position[0][p->place_of[n]] > 1) assert_near(p->displacement.row[0][p->place_of[n]] / 5e-4, 1, 0.01);
  assert_balanced(model, 1e-3);
  breccia_model_destroy(&model);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damaged_bodies_keep_their_momenta),
      cmocka_unit_test(sweeps_are_sums_of_damaged_links),
      cmocka_unit_test(links_are_damaged_beside_other_formulations),
      cmocka_unit_test(a_lattice_tears_beside_an_elastic_half),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "base/random.h"
#include "base/tensor.h"
#include "support.h"

/* An irregular body: two lattices that do not fit each other, a hole and a cut. */
static breccia_model *irregular_body(const char *peridynamics)
{
  return model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
      "peridynamics: {horizon: 2.5, %s}\n"
      "cracks: [{cut: {line: [[3.05, -9], [3.05, 3.1]]}}]\n"
      "body:\n"
      "  a: {material: m, spacing: 1, shape: {difference: [{box: {particles: [13, 9, 5]}}, {sphere: {centre: [9, 4.5, "
      "2.5], radius: 1.3}}]}}\n"
      "  b: {material: m, spacing: 0.8, shape: {box: {from: [0, 0, 5.05], to: [8, 4, 8.25]}}}\n"
      "solve: {explicit: {steps: 10}}\n",
      peridynamics);
}

static breccia_model *plane_body(const char *space, const char *more)
{
  return model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
      "peridynamics: {space: %s, horizon: 3.015 spacings, %s}\n"
      "body: {b: {material: m, lattice: square, thickness: 0.1, spacing: 0.1, shape: {box: {particles: [17, 13]}}}}\n"
      "solve: {explicit: {steps: 1}}\n",
      space, more);
}

static double largest_force(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  double largest = 0;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) largest = larger_of(largest, fabs(p->internal.row[k][p->place_of[n]]));
  return largest;
}

static const char *const controls[] = {"zero-energy control: {none: yes}",
                                       "zero-energy control: {silling: 0.1}",
                                       "zero-energy control: {wan: 0.1}",
                                       "influence: cubic-spline",
                                       "influence: inverse",
                                       "volume correction: partial, influence: gaussian"};
enum { CONTROLS = sizeof controls / sizeof *controls };

static void deformation_gradient_of_a_linear_field_is_exact_everywhere(void **state)
{
  (void)state;
  /* validation U8d, surface included. */
  const double f[9] = {1.1, 0.01, 0, 0, 1.2, 0.02, 0.03, 0, 1.3};
  for (int c = 0; c < CONTROLS; ++c) {
    breccia_model *model = irregular_body(controls[c]);
    deform_uniformly(model, f);
    compute_forces(model);
    const Domain *d = &model->domain;
    for (int64_t n = 0; n < d->particles->count; ++n) {
      double found[9];
      d->regions[0].type->gradient(d->regions[0].formulation, d->particles->place_of[n], found);
      for (int k = 0; k < 9; ++k) assert_near(found[k], f[k], 1e-12);
      for (int k = 0; k < 6; ++k) {
        int r = symmetric_row[k], s = symmetric_column[k];
        double strain = f[r] * f[s] + f[3 + r] * f[3 + s] + f[6 + r] * f[6 + s] - (r == s);
        assert_near(d->strain[k][d->particles->place_of[n]], k < 3 ? strain / 2 : strain, 3e-12);
      }
    }
    breccia_model_destroy(&model);
  }
}

static void patch_of_uniform_strain_leaves_the_interior_without_force(void **state)
{
  (void)state;
  const double f[9] = {1.002, 0.001, 0, -0.003, 0.999, 0.0005, 0, 0.001, 1.001};
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [17, 16, 15]}}}}\nsolve: {explicit: {steps: 1}}\n");
  deform_uniformly(model, f);
  compute_forces(model);
  const Particles *p = model->domain.particles;
  double scale = largest_force(model);
  assert_true(scale > 0.01); /* the surface feels it */
  int interior = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    bool inside = true; /* two horizons from the surface */
    for (int k = 0; k < 3; ++k) inside &= p->position[k][i] > 6 && p->position[k][i] < (double)(17 - k) - 6;
    if (!inside) continue;
    ++interior;
    for (int k = 0; k < 3; ++k) assert_near(p->internal.row[k][i], 0, 1e-12 * scale);
  }
  assert_true(interior >= 3);
  breccia_model_destroy(&model);
}

static void strain_and_stress_of_a_stretched_bar_are_those_of_green_lagrange(void **state)
{
  (void)state;
  /* E11 = e + e^2 / 2 (docs/theory.md 4), S = lambda tr E + 2 G E with E = 150, nu = 0.25: lambda = G = 60. */
  const double e = 0.1, f[9] = {1 + e, 0, 0, 0, 1, 0, 0, 0, 1};
  breccia_model *model = irregular_body("strain: green-lagrange"), *small = irregular_body("strain: small");
  deform_uniformly(model, f);
  deform_uniformly(small, f);
  compute_forces(model);
  compute_forces(small);
  int32_t i = model->domain.particles->place_of[100];
  assert_near(model->domain.strain[0][i], e + e * e / 2, 1e-13);
  assert_near(model->domain.stress[0][i], 180 * (e + e * e / 2), 1e-10);
  assert_near(model->domain.stress[1][i], 60 * (e + e * e / 2), 1e-10);
  assert_near(small->domain.strain[0][i], e, 1e-13);
  breccia_model_destroy(&model);
  breccia_model_destroy(&small);
}

static void rigid_rotation_makes_no_force(void **state)
{
  (void)state;
  const double a = acos(-1) / 6, c = cos(a), s = sin(a);
  const double f[9] = {c, -s, 0, s * c, c * c, -s, s * s, s * c, c}; /* about z, then about x */
  for (int k = 0; k < CONTROLS; ++k) {
    breccia_model *model = irregular_body(controls[k]);
    deform_uniformly(model, f);
    compute_forces(model);
    /* The scale of forces that nearly cancel: modulus over horizon. */
    assert_near(largest_force(model), 0, 1e-12 * 150 / 2.5 * 100);
    breccia_model_destroy(&model);
  }
}

static void shake(breccia_model *model, double amplitude)
{
  const Particles *p = model->domain.particles;
  uint64_t seed = 5;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < (model->domain.body.dimensions); ++k)
      p->displacement.row[k][p->place_of[n]] += amplitude * (random_uniform(&seed) - 0.5);
}

static void internal_forces_balance(void **state)
{
  (void)state;
  /* Linear momentum of a shaken body with broken bonds, for every control; angular momentum of correspondence itself (control
   * forces are not along the bonds). */
  for (int c = 0; c < CONTROLS; ++c) {
    breccia_model *model = irregular_body(controls[c]);
    Particles *p = model->domain.particles;
    shake(model, 0.02);
    for (int32_t n = 0; n < 40; ++n)
      if (family_break(&model->domain.family, p->place_of[n], p->place_of[n + 1])) {
        model->domain.regions[0].type->renew(model->domain.regions[0].formulation, p->place_of[n] / SLICE);
        model->domain.regions[0].type->renew(model->domain.regions[0].formulation, p->place_of[n + 1] / SLICE);
      }
    compute_forces(model);
    double force[3] = {0}, moment[3] = {0}, size = 0;
    for (int64_t n = 0; n < p->count; ++n) {
      int32_t i = p->place_of[n];
      double x[3], f[3];
      for (int k = 0; k < 3; ++k) {
        x[k] = p->position[k][i] + p->displacement.row[k][i];
        f[k] = p->internal.row[k][i] * p->volume[i];
        force[k] += f[k];
        size += fabs(f[k]);
      }
      for (int k = 0; k < 3; ++k) moment[k] += x[(k + 1) % 3] * f[(k + 2) % 3] - x[(k + 2) % 3] * f[(k + 1) % 3];
    }
    for (int k = 0; k < 3; ++k) assert_near(force[k], 0, 1e-13 * size);
    for (int k = 0; k < 3 && strstr(controls[c], "none: yes"); ++k) assert_near(moment[k], 0, 1e-12 * size * 13);
    breccia_model_destroy(&model);
  }
}

/** Makes all slices sum their bonds one by one. */
static void forget_rows(Family *f)
{
  memset(f->rows.count, 0, sizeof *f->rows.count * (size_t)f->particles->slices);
  memset(f->rows.condition, ROWS_RAGGED | ROWS_GAPS, (size_t)f->particles->slices);
}

static void sums_along_lattice_rows_give_the_forces_of_single_bonds(void **state)
{
  (void)state;
  /* Rows along x, y and z, ended by faces, a hole and a cut, and torn by broken bonds; controls alike and different. In the last two
   * every other row is shifted by half a cell. */
  const char *const bodies[] = {
      "cubic, shape: {difference: [{box: {particles: [27, 12, 9]}}, {sphere: {centre: [16, 6.5, "
      "4.5], radius: 2.6}}]}",
      "cubic, shape: {box: {particles: [9, 21, 8]}}",
      "cubic, shape: {box: {particles: [8, 9, 19]}}",
      "square, thickness: 1, shape: {polygon: {corners: [[0, 5], [6, 0], [20, 0], [22, 13], [12, 20], [2, 18]]}}",
      "face-centred cubic, shape: {difference: [{box: {particles: [27, 12, 11]}}, {sphere: {centre: [16, 6.5, 4], "
      "radius: 2.6}}]}",
      "face-centred cubic, shape: {box: {particles: [8, 21, 9]}}"};
  for (int b = 0; b < 6; ++b)
    for (int c = 0; c < 2 * CONTROLS; c += under_sanitizers() ? 3 : 1) {
      const bool flat = !strncmp(bodies[b], "square", 6);
      breccia_model *model = model_of(
          "materials:\n"
          "  m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}\n"
          "  n: {model: elastic, density: 1, Young modulus: %s, Poisson ratio: 0.3}\n"
          "peridynamics: {space: %s, horizon: %g spacings, %s}\n"
          "cracks: [{cut: {line: [[6.03, -9], [6.03, 5.1]]}}]\n"
          "body: {a: {material: m, spacing: 1, lattice: %s}, b: {material: n, spacing: 1, lattice: %s, shape: {box: "
          "{from: [-9, 0, 0], to: [-1, 3, %d]}}}}\n"
          "solve: {explicit: {steps: 1}}\n",
          c < CONTROLS ? "150" : "90", flat ? "plane strain" : "3-D",
          flat                        ? 6.015
          : strstr(bodies[b], "face") ? 4.015
                                      : 3.015,
          controls[c % CONTROLS], bodies[b], flat ? "square, thickness: 1" : "cubic", flat ? 1 : 3);
      Domain *d = &model->domain;
      Particles *p = d->particles;
      Family *f = &d->family;
      shake(model, 0.02);
      for (int64_t n = 0; n < 20; ++n) {
        int32_t first = p->place_of[n * p->count / 20], second = p->place_of[n * p->count / 20 + 1];
        if (!family_break(f, first, second)) continue;
        d->regions[0].type->renew(d->regions[0].formulation, first / SLICE);
        d->regions[0].type->renew(d->regions[0].formulation, second / SLICE);
      }
      int64_t whole = 0, ragged = 0;
      for (int64_t s = 0; s < p->slices; ++s) {
        whole += f->rows.count[s];
        ragged += f->rows.condition[s] & ROWS_RAGGED;
      }
      assert_true(c % CONTROLS >= 3 ||
                  (whole > 2 * p->slices && ragged > 3)); /* other influences have more kinds of rows */
      compute_forces(model);
      double *by_rows = malloc(3 * sizeof(double) * (size_t)p->places), largest = largest_force(model);
      for (int k = 0; k < 3; ++k)
        memcpy(by_rows + k * p->places, p->internal.row[k], sizeof(double) * (size_t)p->places);
      forget_rows(f);
      compute_forces(model);
      for (int k = 0; k < 3; ++k)
        for (int64_t i = 0; i < p->places; ++i)
          assert_near(by_rows[k * p->places + i], p->internal.row[k][i], 1e-12 * largest);
      free(by_rows);
      breccia_model_destroy(&model);
    }
}

static void rows_of_an_intact_lattice_are_whole_to_its_ends(void **state)
{
  (void)state;
  /* with a step in the body, so that rows begin in the last lane of a slice too; also where rows are shifted by half a cell */
  const char *const lattices[] = {"cubic", "face-centred cubic"};
  for (int l = 0; l < 2; ++l) {
    const double layer = l ? sqrt(0.5) : 1;
    breccia_model *model =
        model_of("materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
                 "peridynamics: {horizon: %g spacings}\n"
                 "body: {b: {material: m, lattice: %s, spacing: 1, shape: {union: [{box: {from: [7, 0, 0], to: [21, 7, "
                 "%.15g]}}, {box: {from: [0, 0, %.15g], to: [21, 7, %.15g]}}]}}}\n"
                 "solve: {explicit: {steps: 1}}\n",
                 l ? 4.015 : 3.015, lattices[l], 6 * layer, 6 * layer, 10 * layer);
    const Family *f = &model->domain.family;
    bool shifted = false;
    for (int64_t s = 0; s < f->particles->slices; ++s) {
      assert_true(f->rows.count[s] > 0);
      assert_int_equal(f->rows.condition[s] & ROWS_RAGGED, 0);
    }
    for (int k = 0; k < f->rows.kinds; ++k) shifted |= f->rows.kind[k].neighbours % 2 == 0;
    assert_int_equal(shifted, l);
    breccia_model_destroy(&model);
  }
}

/** What a step that fails goes back to. */
static void bodies_whose_bonds_are_mended_have_the_same_forces_to_the_bit(void **state)
{
  (void)state;
  const char *const kinds[][2] = {{"bond-based", "elastic-1d, density: 1, Young modulus: 150"},
                                  {"ordinary", "elastic, density: 1, Young modulus: 150, Poisson ratio: 0.3"},
                                  {"correspondence", "elastic, density: 1, Young modulus: 150, Poisson ratio: 0.3"}};
  const char *const shapes[] = {"lattice: square, thickness: 1, shape: {box: {from: [0, 0], to: [6, 6]}}",
                                "lattice: square, thickness: 1, shape: {sphere: {centre: [5.2, 4.9], radius: 5}}",
                                "shape: {box: {particles: [7, 5, 6]}}"};
  for (int k = 0; k < 3; ++k)
    for (int b = 0; b < 3; ++b) {
      breccia_model *model = model_of("materials: {m: {model: %s}}\nbody: {b: {material: m, spacing: 1, %s}}\n"
                                      "peridynamics: {formulation: %s, space: %s}\n"
                                      "cracks: [{cut: {line: [[3, -1], [3, 2]]}}]\nsolve: {explicit: {steps: 1}}\n",
                                      kinds[k][1], shapes[b], kinds[k][0], b < 2 ? "plane strain" : "3-D");
      Domain *d = &model->domain;
      const Particles *p = d->particles;
      const size_t bytes = sizeof(double) * (size_t)p->places;
      shake(model, 0.02);
      compute_forces(model);
      double *before[3];
      for (int c = 0; c < 3; ++c) before[c] = memcpy(malloc(bytes), p->internal.row[c], bytes);
      bool *broken = calloc((size_t)(p->count * p->count), 1); /* and not cut */
      for (int deed = 0; deed < 2; ++deed) {
        int64_t changed = 0;
        for (int64_t n = 0; n < p->count; n += 5)
          for (int64_t other = n % 3; other < p->count; other += 3) {
            const int32_t ends[] = {p->place_of[n], p->place_of[other]};
            bool *this_one = &broken[n * p->count + other];
            if (deed ? !*this_one : !(*this_one = family_break(&d->family, ends[0], ends[1]))) continue;
            if (deed) assert_true(family_mend(&d->family, ends[0], ends[1]));
            ++changed;
            for (int end = 0; end < 2; ++end)
              if (d->regions[0].type->renew) d->regions[0].type->renew(d->regions[0].formulation, ends[end] / SLICE);
          }
        assert_true(changed > 20);
        compute_forces(model);
        const bool same = !memcmp(before[0], p->internal.row[0], bytes) &&
                          !memcmp(before[1], p->internal.row[1], bytes) &&
                          !memcmp(before[2], p->internal.row[2], bytes);
        if (same != (deed == 1)) fail_msg("%s, body %d, %s", kinds[k][0], b, deed ? "mended" : "broken");
      }
      free(broken);
      for (int c = 0; c < 3; ++c) free(before[c]);
      breccia_model_destroy(&model);
    }
}

static void force_is_minus_the_gradient_of_the_energy(void **state)
{
  (void)state;
  /* Elastic energy sum V S:E/2 without control, central differences in a few displacements. */
  breccia_model *model = irregular_body("zero-energy control: {none: yes}");
  const Particles *p = model->domain.particles;
  shake(model, 0.05);
  compute_forces(model);
  double *before[3];
  for (int k = 0; k < 3; ++k) {
    before[k] = malloc(sizeof(double) * (size_t)p->places);
    memcpy(before[k], p->internal.row[k], sizeof(double) * (size_t)p->places);
  }
  for (int64_t n = 3; n < p->count; n += p->count / 7) {
    int32_t i = p->place_of[n];
    int k = (int)(n % 3);
    double energy[2], h = 1e-5, u = p->displacement.row[k][i];
    for (int side = 0; side < 2; ++side) {
      p->displacement.row[k][i] = u + (side ? h : -h);
      compute_forces(model);
      energy[side] = 0;
      for (int64_t j = 0; j < p->places; ++j)
        for (int c = 0; c < 6; ++c)
          energy[side] += 0.5 * p->volume[j] * model->domain.stress[c][j] * model->domain.strain[c][j];
    }
    p->displacement.row[k][i] = u;
    assert_near(before[k][i] * p->volume[i], -(energy[1] - energy[0]) / (2 * h), 1e-6 * 150);
  }
  for (int k = 0; k < 3; ++k) free(before[k]);
  breccia_model_destroy(&model);
}

static double checkerboard_resistance(const char *control)
{
  /* rms force density over E 2a / (dx delta), interior particles (validation A4). */
  breccia_model *model = model_of(
      "materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
      "peridynamics: {%s}\n"
      "body: {b: {material: m, spacing: 1, shape: {box: {particles: [16, 16, 16], first particle: [0, 0, 0]}}}}\n"
      "solve: {explicit: {steps: 1}}\n",
      control);
  const Particles *p = model->domain.particles;
  double a = 1e-4, square = 0;
  int count = 0;
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    int parity = (int)(p->position[0][i] + p->position[1][i] + p->position[2][i] + 0.5) % 2;
    for (int k = 0; k < 3; ++k) p->displacement.row[k][i] = parity ? a : -a;
  }
  compute_forces(model);
  for (int64_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[n];
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside &= p->position[k][i] > 5.5 && p->position[k][i] < 9.5;
    if (!inside) continue;
    ++count;
    for (int k = 0; k < 3; ++k) square += p->internal.row[k][i] * p->internal.row[k][i] / 3;
  }
  breccia_model_destroy(&model);
  return sqrt(square / count) / (150 * 2 * a / 3.015);
}

static void control_resists_the_checkerboard_and_correspondence_alone_does_not(void **state)
{
  (void)state;
  double none = checkerboard_resistance("zero-energy control: {none: yes}");
  double tenth = checkerboard_resistance("zero-energy control: {silling: 0.1}");
  double one = checkerboard_resistance("zero-energy control: {silling: 1}");
  double wan = checkerboard_resistance("zero-energy control: {wan: 1}");
  assert_true(none < 1e-10);
  assert_true(tenth > 0.5);
  /* 68 of the 122 neighbours are of the other colour, at distance 2 a: 24 * 68 / (pi m^4) G_s (docs/theory.md 4). */
  assert_near(tenth, 0.1 * 24 * 68 / (acos(-1) * pow(3.015, 4)), 1e-9);
  assert_near(one, 10 * tenth, 1e-9);
  assert_true(wan > 0.5);
}

static void a_chequered_plane_body_is_held_too(void **state)
{
  (void)state;
  breccia_model *model = plane_body("plane stress", "influence: constant");
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n)
    p->displacement.row[0][p->place_of[n]] = 1e-5 * ((n % 17 + n / 17) % 2 ? 1 : -1);
  compute_forces(model);
  const double middle[3] = {0.85, 0.65, 0};
  int32_t i = particles_nearest(p, middle);
  double resistance = fabs(p->internal.row[0][i]) / (150 * 2e-5 / (0.1 * 0.3015));
  assert_true(resistance > 0.5 && resistance < 0.8); /* 3.3 to 3.7 G_s at G_s = 0.2 (docs/theory.md 4) */
  breccia_model_destroy(&model);
}

static void plane_stress_and_plane_strain_have_their_moduli(void **state)
{
  (void)state;
  const double f[9] = {1 + 1e-6, 0, 0, 0, 1, 0, 0, 0, 1};
  const struct {
    const char *space;
    double xx, yy, zz;
  } cases[] = {{"plane stress", 150 / (1 - 0.0625), 0.25 * 150 / (1 - 0.0625), 0}, {"plane strain", 180, 60, 60}};
  for (int k = 0; k < 2; ++k) {
    breccia_model *model = plane_body(cases[k].space, "influence: conical");
    deform_uniformly(model, f);
    compute_forces(model);
    int32_t i = model->domain.particles->place_of[57];
    assert_near(model->domain.stress[0][i], cases[k].xx * 1e-6, 1e-9 * 180e-3);
    assert_near(model->domain.stress[1][i], cases[k].yy * 1e-6, 1e-9 * 180e-3);
    assert_near(model->domain.stress[2][i], cases[k].zz * 1e-6, 1e-9 * 180e-3);
    breccia_model_destroy(&model);
  }
}

static void lone_particles_and_torn_families_give_finite_forces(void **state)
{
  (void)state;
  /* Breaks bonds at random until nothing is left; every rung of the ladder is met. */
  breccia_model *model =
      model_of("materials: {m: {model: elastic, density: 1, Young modulus: 150, Poisson ratio: 0.25}}\n"
               "peridynamics: {horizon: 1.5 spacings}\n"
               "body: {b: {material: m, spacing: 1, shape: {box: {particles: [5, 4, 3]}}}}\n"
               "solve: {explicit: {steps: 1}}\n");
  Particles *p = model->domain.particles;
  uint64_t seed = 9;
  shake(model, 0.1);
  int axial = 0, free_particles = 0;
  for (int tries = 0; tries < 20000; ++tries) {
    int32_t a = p->place_of[(int)(random_uniform(&seed) * (double)p->count)];
    int32_t b = p->place_of[(int)(random_uniform(&seed) * (double)p->count)];
    if (!family_break(&model->domain.family, a, b)) continue;
    model->domain.regions[0].type->renew(model->domain.regions[0].formulation, a / SLICE);
    model->domain.regions[0].type->renew(model->domain.regions[0].formulation, b / SLICE);
    compute_forces(model);
    double sum[3] = {0}, size = 0;
    for (int64_t n = 0; n < p->count; ++n)
      for (int k = 0; k < 3; ++k) {
        assert_true(isfinite(p->internal.row[k][p->place_of[n]]));
        sum[k] += p->internal.row[k][p->place_of[n]];
        size += fabs(p->internal.row[k][p->place_of[n]]);
      }
    for (int k = 0; k < 3; ++k) assert_near(sum[k], 0, 1e-12 * (size + 1));
    int bonds = family_count(&model->domain.family, a);
    axial += bonds > 0 && bonds < 4;
    free_particles += bonds == 0;
  }
  assert_true(axial > 10 && free_particles > 5);
  breccia_model_destroy(&model);
}

static void one_layer_in_space_is_refused_with_advice(void **state)
{
  (void)state;
  char *words = refusal_of("materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
                           "body: {b: {material: m, spacing: 1, shape: {box: {particles: [9, 9, 1]}}}}\n"
                           "solve: {explicit: {steps: 1}}\n");
  assert_non_null(strstr(words, "at least two layers"));
  free(words);
}

/** Particles from a file that nearly lie in a plane have no strain across it that could be told from noise. */
static void flat_families_are_refused(void **state)
{
  (void)state;
  static const double heights[] = {1e-4, 3e-3, 0.1}; /* by which they stand above and below the plane, in spacings */
  for (int h = 0; h < 3; ++h) {
    FILE *file = fopen("test_flat.csv", "w");
    fprintf(file, "x,y,z,volume\n");
    for (int n = 0; n < 49; ++n) fprintf(file, "%d,%d,%g,1\n", n % 7, n / 7, heights[h] * (n * n % 3 ? 1 : -1));
    fclose(file);
    const char *deck = "materials: {m: {model: elastic, density: 1, Young modulus: 1, Poisson ratio: 0}}\n"
                       "body: {b: {material: m, spacing: 1, file: test_flat.csv}}\n"
                       "solve: {explicit: {steps: 1, time step: 1e-9}}\n";
    if (h > 0) {
      breccia_model *model = model_of("%s", deck);
      breccia_model_destroy(&model);
    } else {
      char *words = refusal_of(deck);
      if (!strstr(words, "bonds that do not span space, so that it has no strain; the horizon is 3.015"))
        fail_msg("%s", words);
      free(words);
    }
    remove("test_flat.csv");
  }
}

static void a_lone_bond_pulls_with_the_micromodulus(void **state)
{
  (void)state;
  /* The last bond of two families, too few for a strain: both ends give it half of c s, c = 12 E / (pi delta^4) in space and
   * 9 E / (pi t delta^3) in the plane. */
  const double pi = acos(-1), delta = 1.8 * 0.1, stretch = 0.01;
  for (int plane = 0; plane < 2; ++plane) {
    breccia_model *m = model_of(SOFT_SOLID "peridynamics: {space: %s, horizon: 1.8 spacings}\n"
                                           "body: {b: {material: m, spacing: 0.1, %s}}\n"
                                           "solve: {explicit: {steps: 1, time step: 1e-9}}\n",
                                plane ? "plane strain" : "3-D",
                                plane ? "lattice: square, thickness: 0.2, shape: {box: {particles: [3, 3]}}"
                                      : "shape: {box: {particles: [3, 3, 3]}}");
    Domain *d = &m->domain;
    const Particles *p = d->particles;
    for (int64_t a = 0; a < p->count; ++a)
      for (int64_t b = a + 1; b < p->count; ++b)
        if (a || b != 1) family_break(&d->family, p->place_of[a], p->place_of[b]);
    for (int64_t slice = 0; slice < p->slices; ++slice) d->regions[0].type->renew(d->regions[0].formulation, slice);
    assert_int_equal(family_count(&d->family, p->place_of[0]), 1);
    p->displacement.row[0][p->place_of[1]] = 0.1 * stretch;
    compute_forces(m);
    const double c = plane ? 9 * 1e4 / (pi * 0.2 * pow(delta, 3)) : 12 * 1e4 / (pi * pow(delta, 4)),
                 volume = 0.01 * (plane ? 0.2 : 0.1), force = c * stretch * volume;
    assert_near(p->internal.row[0][p->place_of[0]], force, 1e-9 * force);
    assert_near(p->internal.row[0][p->place_of[1]], -force, 1e-9 * force);
    breccia_model_destroy(&m);
  }
}

/* A phase that fails at one place, in the place of one of a formulation. */
enum { FAILED_PLACE = 40 };
static int64_t (*whole_phase)(void *formulation, const Sweep *sweep);

static int64_t failing_phase(void *formulation, const Sweep *sweep)
{
  whole_phase(formulation, sweep);
  const bool here = sweep->first <= FAILED_PLACE / SLICE && sweep->last > FAILED_PLACE / SLICE;
  return here ? FAILED_PLACE : -1;
}

/** A phase that fails is heard, whichever it is: the evaluation fails with its place, in a linearised step too, and an
 *  explicit step ends. The next evaluation without a failure is good again. */
static void a_phase_that_fails_is_heard(void **state)
{
  (void)state;
  static const char *const formulations[] = {"correspondence", "ordinary", "hybrid", "bond-based"};
  for (size_t f = 0; f < sizeof formulations / sizeof *formulations; ++f)
    for (int phase = 0; phase < MOST_PHASES; ++phase) {
      char keys[64];
      snprintf(keys, sizeof keys, "formulation: %s", formulations[f]);
      breccia_model *m = f < 3 ? plane_body("plane strain", keys)
                               : model_of("materials: {m: {model: elastic-1d, density: 1, Young modulus: 150}}\n"
                                          "peridynamics: {formulation: bond-based, space: plane strain}\n"
                                          "body: {b: {material: m, lattice: square, thickness: 0.1, spacing: 0.1, "
                                          "shape: {box: {particles: [17, 13]}}}}\nsolve: {explicit: {steps: 1}}\n");
      Domain *d = &m->domain;
      const FormulationType *whole = d->regions[0].type;
      FormulationType type = *whole;
      if (type.phases[phase].run) {
        Team *before = team_use(m->team);
        whole_phase = type.phases[phase].run;
        type.phases[phase].run = failing_phase;
        assert_int_equal(domain_evaluate(d, NULL), BRECCIA_OK);
        d->regions[0].type = &type;
        assert_int_equal(domain_evaluate(d, NULL), BRECCIA_FAILURE);
        assert_int_equal(d->failed_place, FAILED_PLACE);
        d->regions[0].type = whole;
        assert_int_equal(domain_linearise(d, NULL, NULL), 0);
        assert_true(domain_has_forces(d));
        Vector v[1] = {{0}}, change[1] = {{0}};
        assert_true(vector_create(v, &d->particles->space, "test", NULL) &&
                    vector_create(change, &d->particles->space, "test", NULL));
        d->regions[0].type = &type;
        domain_linear_step(d, v, change);
        assert_false(domain_has_forces(d));
        vector_destroy(v);
        vector_destroy(change);
        team_use(before);
        breccia_error *error = breccia_error_create();
        assert_int_equal(breccia_model_step(m, 1, error), BRECCIA_FAILURE);
        breccia_error_destroy(&error);
        d->regions[0].type = whole;
        assert_int_equal(domain_evaluate(d, NULL), BRECCIA_OK);
      }
      breccia_model_destroy(&m);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(deformation_gradient_of_a_linear_field_is_exact_everywhere),
      cmocka_unit_test(patch_of_uniform_strain_leaves_the_interior_without_force),
      cmocka_unit_test(strain_and_stress_of_a_stretched_bar_are_those_of_green_lagrange),
      cmocka_unit_test(rigid_rotation_makes_no_force),
      cmocka_unit_test(internal_forces_balance),
      cmocka_unit_test(sums_along_lattice_rows_give_the_forces_of_single_bonds),
      cmocka_unit_test(rows_of_an_intact_lattice_are_whole_to_its_ends),
      cmocka_unit_test(bodies_whose_bonds_are_mended_have_the_same_forces_to_the_bit),
      cmocka_unit_test(force_is_minus_the_gradient_of_the_energy),
      cmocka_unit_test(control_resists_the_checkerboard_and_correspondence_alone_does_not),
      cmocka_unit_test(a_chequered_plane_body_is_held_too),
      cmocka_unit_test(plane_stress_and_plane_strain_have_their_moduli),
      cmocka_unit_test(lone_particles_and_torn_families_give_finite_forces),
      cmocka_unit_test(one_layer_in_space_is_refused_with_advice),
      cmocka_unit_test(flat_families_are_refused),
      cmocka_unit_test(a_lone_bond_pulls_with_the_micromodulus),
      cmocka_unit_test(a_phase_that_fails_is_heard),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Micropolar peridynamics: what uniform strain, a single link, rotation of the whole and motion must do to it. */
#include "formulation/micropolar.h"

#include "base/random.h"
#include "base/tensor.h"
#include "support.h"

#define UNITS "units: {length: m, force: kN, time: s}\n"
#define STEP "solve: {explicit: {steps: 1}}\n"

static const double young = 1e4, poisson = 0.2, spacing = 0.1, thick = 0.3;

static const Micropolar *formulation_of(const breccia_model *model)
{
  return model->domain.regions[0].formulation;
}

/** A block of an elastic material. @param[in] words  more keys of peridynamics */
static breccia_model *block(const char *lattice, const char *particles, const char *space, const char *words,
                            const char *rest)
{
  breccia_model *model =
      model_of(UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                     "body: {b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {particles: %s}}}}\n"
                     "peridynamics: {formulation: micropolar, space: %s %s}\n%s",
               lattice, *space == 'p' ? "thickness: 0.3," : "", particles, space, words, rest);
  model->threads = 1; /* of bodies so small more only wait */
  return model;
}

static double stored(const breccia_model *model, int32_t place)
{
  StoredEnergy energy;
  const Region *region = &model->domain.regions[0];
  region->type->stored_energy(region->formulation, place, 0, &energy);
  return energy.stored;
}

static double all_stored(const breccia_model *model)
{
  const Particles *p = model->domain.particles;
  double sum = 0;
  for (int64_t n = 0; n < p->count; ++n) sum += stored(model, p->place_of[n]);
  return sum;
}

/** Most links that a particle has. */
static int most_links(const breccia_model *model)
{
  int most = 0;
  for (int64_t n = 0; n < model->domain.particles->count; ++n) {
    const int count = family_count(&model->domain.family, model->domain.particles->place_of[n]);
    most = count > most ? count : most;
  }
  return most;
}

/** A rotation of the whole about an axis of length 1, on top of what particles have done. */
static void turn_body(breccia_model *model, const double axis[3], double angle)
{
  const Particles *p = model->domain.particles;
  const double c = cos(angle), s = sin(angle),
               q[4] = {cos(angle / 2), sin(angle / 2) * axis[0], sin(angle / 2) * axis[1], sin(angle / 2) * axis[2]};
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    double y[3], along = 0;
    for (int k = 0; k < 3; ++k) {
      y[k] = p->position[k][i] + p->displacement.row[k][i];
      along += axis[k] * y[k];
    }
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const double turned = c * y[k] + s * (axis[a] * y[b] - axis[b] * y[a]) + (1 - c) * along * axis[k];
      p->displacement.row[k][i] = turned - p->position[k][i];
    }
    if (p->space.rows == 4) {
      p->displacement.row[p->space.rotation][i] += angle;
      continue;
    }
    double o[4];
    particles_orientation(p, p->displacement.row, i, o);
    p->orientation[0][i] = q[0] * o[0] - q[1] * o[1] - q[2] * o[2] - q[3] * o[3];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      p->orientation[1 + k][i] = q[0] * o[1 + k] + q[1 + k] * o[0] + q[1 + a] * o[1 + b] - q[1 + b] * o[1 + a];
      p->displacement.row[p->space.rotation + k][i] = 0;
    }
  }
}

/** Displacements and rotations at random. */
static void disturb(const breccia_model *model, double size, double angle, uint64_t seed)
{
  const Particles *p = model->domain.particles;
  for (int64_t n = 0; n < p->count; ++n)
    for (int k = 0; k < p->space.rows; ++k)
      if (k >= p->space.rotation || k < model->domain.body.dimensions)
        p->displacement.row[k][p->place_of[n]] =
            2 * (random_uniform(&seed) - 0.5) * (k < p->space.rotation ? size * spacing : angle);
}

/* ---- constants ---- */

/** EA and EI of links are those that make the lattice isotropic (docs/theory.md 6.2). */
static void links_have_the_stiffness_of_closed_forms(void **state)
{
  (void)state;
  const double nu = poisson, s = spacing, e = young;
  const struct {
    const char *lattice, *particles, *space;
    double axial[2], bending;
  } cases[] = {{"hexagonal",
                "[6, 6]",
                "plane stress",
                {e * s * thick / (sqrt(3) * (1 - nu))},
                e * s * s * s * thick * (1 - 3 * nu) / (12 * sqrt(3) * (1 - nu * nu))},
               {"hexagonal",
                "[6, 6]",
                "plane strain",
                {e * s * thick / (sqrt(3) * (1 + nu) * (1 - 2 * nu))},
                e * s * s * s * thick * (1 - 4 * nu) / (12 * sqrt(3) * (1 + nu) * (1 - 2 * nu))},
               {"face-centred cubic",
                "[4, 4, 4]",
                "3-D",
                {sqrt(2) * e * s * s / (4 * (1 + nu) * (1 - 2 * nu)), e * nu * s * s / (2 * (1 + nu) * (1 - 2 * nu))},
                sqrt(2) * e * s * s * s * s * (1 - 4 * nu) / (48 * (1 + nu) * (1 - 2 * nu))}};
  const double cells[] = {sqrt(0.75) * s * s * thick, sqrt(0.75) * s * s * thick, s * s * s / sqrt(2)};
  const double gyrations[] = {5.0 / 36, 5.0 / 36, 1.0 / 8};
  for (int k = 0; k < 3; ++k) {
    breccia_model *model = block(cases[k].lattice, cases[k].particles, cases[k].space, "", STEP);
    const LinkConstants *found = &formulation_of(model)->constants[0];
    assert_int_equal(found->lengths, k == 2 ? 2 : 1);
    for (int l = 0; l < found->lengths; ++l) {
      const bool second = found->length[l] > 1.2 * s;
      assert_near(found->of[l].axial * cells[k] * cells[k] / cases[k].axial[second], 1, 1e-12);
      assert_near(found->of[l].bending * cells[k] * cells[k] / cases[k].bending, second ? 0 : 1, 1e-11);
    }
    assert_near(found->gyration / (s * s), gyrations[k], k == 2 ? 1e-4 : 1e-14);
    breccia_model_destroy(&model);
  }
}

/** Energy of a particle within the body, over that of the continuum. */
static double energy_ratio(breccia_model *model, const double e[9], double strain, double nu, bool plane_stress,
                           bool plane)
{
  const Particles *p = model->domain.particles;
  const double mu = young / (2 * (1 + nu)),
               lambda = plane_stress ? young * nu / (1 - nu * nu) : young * nu / ((1 + nu) * (1 - 2 * nu));
  const double f[9] = {1 + strain * e[0], strain * e[1], strain * e[2], strain * e[3],    1 + strain * e[4],
                       strain * e[5],     strain * e[6], strain * e[7], 1 + strain * e[8]};
  double trace = 0, square = 0, found = 0, volume = 0;
  deform_uniformly(model, f);
  for (int64_t n = 0; n < p->count; ++n) { /* particles turn as the body does */
    const int32_t i = p->place_of[n];
    if (plane) p->displacement.row[p->space.rotation][i] = strain * (e[3] - e[1]) / 2;
    for (int k = 0; k < 3 && !plane; ++k)
      p->displacement.row[p->space.rotation + k][i] =
          strain * (e[3 * ((k + 2) % 3) + (k + 1) % 3] - e[3 * ((k + 1) % 3) + (k + 2) % 3]) / 2;
  }
  for (int a = 0; a < 3; ++a) {
    trace += e[4 * a];
    for (int b = 0; b < 3; ++b) square += pow((e[3 * a + b] + e[3 * b + a]) / 2, 2);
  }
  const int most = most_links(model);
  for (int64_t n = 0; n < p->count; ++n) {
    if (family_count(&model->domain.family, p->place_of[n]) < most) continue;
    found += stored(model, p->place_of[n]);
    volume += p->volume[p->place_of[n]];
  }
  assert_true(volume > 0);
  return found / (strain * strain * volume * (lambda / 2 * trace * trace + mu * square));
}

/** Energy of uniform strain, turned and sheared: 1.000000 of the continuum's wherever a lattice is right in every direction, and in expansion on all. */
static void uniform_strain_has_the_energy_of_the_continuum(void **state)
{
  (void)state;
  const double planes[][9] = {{1, 0, 0, 0, 1}, {1, 0, 0, 0, 0}, {0, 0, 0, 0, 1},         {0, 1, 0, 0, 0},
                              {0, 0, 0, 1, 0}, {0, 1, 0, 1, 0}, {0.3, -0.8, 0, 0.5, 0.9}};
  const double solids[][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1},
                              {0, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 1},
                              {0, 0, 0, 0, 0, 1},          {0.3, -0.8, 0.2, 0.5, 0.9, 0.1, -0.4, 0.7, -0.6}};
  const struct {
    const char *lattice, *space, *words;
    bool every; /* direction */
  } cases[] = {{"hexagonal", "plane stress", "", true},
               {"hexagonal", "plane strain", "", true},
               {"hexagonal", "plane stress", ", horizon: 3.1 spacings, influence: conical", true},
               {"square", "plane stress", "", true},
               {"square", "plane strain", ", horizon: 3.1 spacings", false},
               {"face-centred cubic", "3-D", "", true},
               {"cubic", "3-D", "", true},
               {"cubic", "3-D", ", horizon: 2.1 spacings, influence: inverse", false}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
    const bool plane = *cases[c].space == 'p';
    breccia_model *model =
        block(cases[c].lattice, plane ? "[12, 12]" : "[7, 8, 9]", cases[c].space, cases[c].words, STEP);
    const size_t strains = plane ? sizeof planes / sizeof *planes : sizeof solids / sizeof *solids;
    for (size_t k = 0; k < (cases[c].every ? strains : 1); ++k) {
      const double ratio = energy_ratio(model, plane ? planes[k] : solids[k], 1e-7, poisson,
                                        strstr(cases[c].space, "stress") != NULL, plane);
      if (!(fabs(ratio - 1) < 1e-6))
        fail_msg("%s, %s%s, strain %zu: %.8f", cases[c].lattice, cases[c].space, cases[c].words, k, ratio);
    }
    breccia_model_destroy(&model);
  }
}

static void what_bending_cannot_be_is_refused(void **state)
{
  (void)state;
  const struct {
    double poisson;
    const char *space, *words;
  } cases[] = {{0.34, "plane stress", "at most 1/3 in plane stress, and that of material 'm' is 0.34"},
               {0.26, "plane strain", "at most 1/4, and that of material 'm' is 0.26"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: %g}}\n"
                             "body: {b: {material: m, lattice: hexagonal, spacing: 0.1, thickness: 0.3, shape: {box: "
                             "{particles: [5, 5]}}}}\n"
                             "peridynamics: {formulation: micropolar, space: %s}\n" STEP,
                             cases[k].poisson, cases[k].space),
         *words = refusal_of(deck);
    if (!strstr(words, cases[k].words) || !strstr(words, "bending stiffness below zero")) fail_msg("%s", words);
    free(deck);
    free(words);
  }
}

/** Where rotations have no place yet decks are refused. */
static void what_cannot_turn_yet_is_refused(void **state)
{
  (void)state;
  const struct {
    const char *rest, *words;
  } cases[] = {
      {"loads: [{on: {face: x-}, support: {held: all}}]\nsolve: {explicit: {steps: 1}}",
       "support: held in all directions its images are no mirror images"},
      {"loads: [{on: {face: x-}, rotation: [1, 0, 0]}]\nsolve: {explicit: {steps: 1}}", "rotation: the body is plane"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *deck = text_format("materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                             "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: 0.3, shape: {box: "
                             "{particles: [5, 5]}}}}\n"
                             "peridynamics: {formulation: micropolar, space: plane stress}\n%s\n",
                             cases[k].rest),
         *words = refusal_of(deck);
    if (!strstr(words, cases[k].words)) fail_msg("%s", words);
    free(deck);
    free(words);
  }
}

/* ---- links ---- */

/** Two particles: their four ways to deform in the plane, and twist in space, have the stiffness of a beam. */
static void a_link_is_a_beam(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = space ? block("face-centred cubic", "[2, 1, 1]", "3-D", "", STEP)
                                 : block("hexagonal", "[2, 1]", "plane stress", "", STEP);
    const Particles *p = model->domain.particles;
    const LinkConstants *constants = &formulation_of(model)->constants[0];
    const LinkStiffness *of = &constants->of[constants->length[0] > 1.2 * spacing];
    const int32_t a = p->place_of[0], b = p->place_of[1];
    const double v = p->volume[a], ea = of->axial * v * v, ei = of->bending * v * v, gj = of->twist * v * v;
    const double small = 1e-6, l = spacing;
    const int turn = space ? p->space.rotation + 2 : p->space.rotation;
    assert_int_equal(p->count, 2);
    if (space) assert_near(gj / (ei * 2 / 2.4), 1, 1e-12); /* J = 2 I, G = E / 2.4 */
    const struct {
      int end, row;
      double force[3], moment[2]; /* on b along x, y; moments on a, b about z */
    } ways[] = {{1, 0, {-ea / l, 0}, {0, 0}},
                {1, 1, {0, -12 * ei / (l * l * l)}, {6 * ei / (l * l), 6 * ei / (l * l)}},
                {1, turn, {0, 6 * ei / (l * l)}, {-2 * ei / l, -4 * ei / l}},
                {0, turn, {0, 6 * ei / (l * l)}, {-4 * ei / l, -2 * ei / l}}};
    for (size_t w = 0; w < sizeof ways / sizeof *ways; ++w) {
      double *moved = &p->displacement.row[ways[w].row][ways[w].end ? b : a];
      *moved = small;
      compute_forces(model);
      const double slack = 1e-5 * small * ea / l;
      for (int k = 0; k < 2; ++k) {
        assert_near(v * p->internal.row[k][b], small * ways[w].force[k], slack);
        assert_near(v * p->internal.row[k][a], -small * ways[w].force[k], slack);
        assert_near(v * p->internal.row[turn][k ? b : a], small * ways[w].moment[k], slack * l);
      }
      *moved = 0;
    }
    if (space) {
      p->displacement.row[p->space.rotation][b] = small;
      compute_forces(model);
      assert_near(v * p->internal.row[p->space.rotation][b] / small, -gj / l, 1e-6 * gj / l);
      assert_near(v * p->internal.row[p->space.rotation][a] / small, gj / l, 1e-6 * gj / l);
    }
    breccia_model_destroy(&model);
  }
}

/** Forces and moments are the derivatives of the energy, at small strains, which sweeps take by series, and at large ones. */
static void forces_are_derivatives_of_the_energy(void **state)
{
  (void)state;
  const struct {
    const char *lattice, *particles, *space, *words;
  } cases[] = {{"hexagonal", "[9, 5]", "plane stress", ""},
               {"square", "[9, 5]", "plane strain", ", horizon: 2.3 spacings"},
               {"face-centred cubic", "[4, 3, 3]", "3-D", ""},
               {"cubic", "[4, 3, 3]", "3-D", ", horizon: 1.8 spacings, torsion: 0"}};
  const double sizes[][2] = {{1e-3, 1e-2}, {0.1, 0.4}, {0.15, 1.5}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c)
    for (int size = 0; size < 3; ++size) {
      breccia_model *model = block(cases[c].lattice, cases[c].particles, cases[c].space, cases[c].words, STEP);
      const Particles *p = model->domain.particles;
      disturb(model, sizes[size][0], sizes[size][1], 3);
      turn_body(model, *cases[c].space == 'p' ? (double[]){0, 0, 1} : (double[]){0.6, 0, 0.8}, 0.7);
      compute_forces(model);
      double most[2] = {0}, sum[3] = {0};
      for (int k = 0; k < p->space.rows; ++k)
        for (int64_t i = 0; i < p->places; ++i)
          most[k >= p->space.rotation] = fmax(most[k >= p->space.rotation], fabs(p->volume[i] * p->internal.row[k][i]));
      for (int64_t n = 0; n < p->count; n += 7)
        for (int k = 0; k < p->space.rows; ++k) {
          if (k < p->space.rotation && k >= model->domain.body.dimensions) continue;
          const int32_t i = p->place_of[n];
          const double h = 1e-6 * (k < p->space.rotation ? spacing : 1), at = p->displacement.row[k][i];
          p->displacement.row[k][i] = at + h;
          const double above = all_stored(model);
          p->displacement.row[k][i] = at - h;
          const double slope = (above - all_stored(model)) / (2 * h);
          p->displacement.row[k][i] = at;
          if (!(fabs(slope + p->volume[i] * p->internal.row[k][i]) < 2e-6 * most[k >= p->space.rotation]))
            fail_msg("%s, size %d, row %d: %g, by energy %g, of %g", cases[c].lattice, size, k,
                     p->volume[i] * p->internal.row[k][i], -slope, most[k >= p->space.rotation]);
        }
      for (int k = 0; k < 3; ++k) { /* nothing turns or pulls the whole */
        double force = 0;
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        for (int64_t n = 0; n < p->count; ++n) {
          const int32_t i = p->place_of[n];
          const double v = p->volume[i];
          force += v * p->internal.row[k][i];
          sum[k] += v * ((p->position[x][i] + p->displacement.row[x][i]) * p->internal.row[y][i] -
                         (p->position[y][i] + p->displacement.row[y][i]) * p->internal.row[x][i]);
          if (p->space.rows == 6 || k == 2)
            sum[k] += v * p->internal.row[p->space.rows == 6 ? p->space.rotation + k : p->space.rotation][i];
        }
        assert_near(force / most[0], 0, 1e-12);
        assert_near(sum[k] / (most[0] * spacing), 0, 1e-11);
      }
      breccia_model_destroy(&model);
    }
}

/** Links between two materials have the mean stiffness of both, and neither push nor turn the body. */
static void links_between_two_materials_neither_push_nor_turn(void **state)
{
  (void)state;
  static const struct {
    const char *space, *block, *boxes[2];
  } bodies[] = {
      {"3-D", "lattice: cubic,", {"[0, 0, 0], to: [0.3, 0.3, 0.3]", "[0.3, 0, 0], to: [0.6, 0.3, 0.3]"}},
      {"plane stress", "lattice: square, thickness: 0.3,", {"[0, 0], to: [0.4, 0.4]", "[0.4, 0], to: [0.8, 0.4]"}}};
  for (int b = 0; b < 2; ++b) {
    breccia_model *model =
        model_of(UNITS "materials:\n  m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}\n"
                       "  n: {model: elastic, density: 3, Young modulus: 7e4, Poisson ratio: 0.1}\n"
                       "body:\n  b: {material: m, spacing: 0.1, %s shape: {box: {from: %s}}}\n"
                       "  c: {material: n, spacing: 0.1, %s shape: {box: {from: %s}}}\n"
                       "peridynamics: {formulation: micropolar, space: %s}\n" STEP,
                 bodies[b].block, bodies[b].boxes[0], bodies[b].block, bodies[b].boxes[1], bodies[b].space);
    const Particles *p = model->domain.particles;
    model->threads = 1;
    disturb(model, 0.05, 0.4, 3);
    compute_forces(model);
    double most = 0, sum[3] = {0}, force[3] = {0};
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      for (int k = 0; k < 3; ++k) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const double v = p->volume[i];
        force[k] += v * p->internal.row[k][i];
        sum[k] += v * ((p->position[x][i] + p->displacement.row[x][i]) * p->internal.row[y][i] -
                       (p->position[y][i] + p->displacement.row[y][i]) * p->internal.row[x][i]);
        if (p->space.rows == 6 || k == 2)
          sum[k] += v * p->internal.row[p->space.rows == 6 ? p->space.rotation + k : p->space.rotation][i];
        most = larger_of(most, fabs(v * p->internal.row[k][i]));
      }
    }
    for (int k = 0; k < 3; ++k) {
      assert_near(force[k] / most, 0, 1e-12);
      assert_near(sum[k] / (most * spacing), 0, 1e-11);
    }
    breccia_model_destroy(&model);
  }
}

/** Turned as a whole, up to a full turn, a body carries what it did, turned with it: nothing where it was straight, and the same where it was bent. */
static void rotation_of_the_whole_changes_nothing(void **state)
{
  (void)state;
  const double axes[2][3] = {{0, 0, 1}, {0.48, 0.6, 0.64}};
  for (int space = 0; space < 2; ++space)
    for (int bent = 0; bent < 2; ++bent) {
      breccia_model *model = space ? block("face-centred cubic", "[5, 2, 2]", "3-D", "", STEP)
                                   : block("hexagonal", "[9, 3]", "plane stress", "", STEP);
      const Particles *p = model->domain.particles;
      if (bent) disturb(model, 1e-3, 1e-2, 11);
      compute_forces(model);
      const double energy = all_stored(model), scale = young * spacing * spacing * spacing;
      Vector force = {0};
      assert_true(vector_create(&force, &p->space, "test", NULL));
      vector_copy(&force, &p->internal);
      for (int turn = 1; turn <= 8; ++turn) {
        turn_body(model, axes[space], acos(-1) / 4);
        compute_forces(model);
        assert_near(all_stored(model) / scale, energy / scale, 1e-13);
        if (turn < 8) continue;
        for (int k = 0; k < p->space.rows; ++k)
          for (int64_t i = 0; i < p->places; ++i)
            assert_near(p->internal.row[k][i] * p->volume[i] / scale * spacing,
                        force.row[k][i] * p->volume[i] / scale * spacing, 1e-11);
      }
      vector_destroy(&force);
      breccia_model_destroy(&model);
    }
}

/** The links of the thesis resist rigid rotation, to the second order of the angle; ours do not. */
static void links_of_the_thesis_resist_rotation(void **state)
{
  (void)state;
  double most[2][2];
  for (int secant = 0; secant < 2; ++secant)
    for (int k = 0; k < 2; ++k) {
      breccia_model *model = block("hexagonal", "[6, 6]", "plane stress", secant ? ", kinematics: thesis" : "", STEP);
      const Particles *p = model->domain.particles;
      turn_body(model, (double[]){0, 0, 1}, (k ? 2 : 1) * acos(-1) / 180);
      compute_forces(model);
      most[secant][k] = 0;
      for (int row = 0; row < 2; ++row)
        for (int64_t i = 0; i < p->places; ++i)
          most[secant][k] = larger_of(most[secant][k], fabs(p->internal.row[row][i] * p->volume[i]));
      breccia_model_destroy(&model);
    }
  /* At one degree as much as a stretch of 1.5e-4, twice what cracks concrete; four times as much at two. */
  const double link = young * spacing * thick / (sqrt(3) * 0.8);
  assert_true(most[1][0] > 1e-4 * link);
  assert_near(most[1][1] / most[1][0], 4, 0.05);
  assert_true(most[0][1] < 1e-12 * link);
}

/* ---- motion ---- */

#define CLAMP(force)                                                                                                   \
  "loads: [{on: {nearest: [0.05, 0.05, 0.05]}, displacement: [0, 0, 0]}, {on: {nearest: [0.05, 0.05, 0.05]}, "         \
  "rotation: [0, 0, 0]}, {on: {nearest: [9, 0.05, 0.05]}, " force "}]\n"                                               \
  "solve: {explicit: {end time: 100, local damping: 0.8, rest: 1e-7}}\n"

/** A row of particles is a beam: at rest its tip has the deflection and rotation of closed forms, whatever the number of links. */
static void a_row_of_links_bends_like_a_beam(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space)
    for (int moment = 0; moment < 2; ++moment) {
      const char *lattice = space ? "face-centred cubic" : "hexagonal", *row = space ? "[7, 1, 1]" : "[7, 1]";
      breccia_model *model =
          moment ? block(lattice, row, space ? "3-D" : "plane stress", "", CLAMP("moment: [0, 0, 1e-6]"))
                 : block(lattice, row, space ? "3-D" : "plane stress", "", CLAMP("force: [0, 1e-6, 0]"));
      const Particles *p = model->domain.particles;
      const LinkConstants *constants = &formulation_of(model)->constants[0];
      const int32_t tip = p->place_of[6];
      const int first = constants->lengths == 2 && constants->length[0] > 0.12;
      const double l = 6 * spacing, ei = constants->of[first].bending * p->volume[tip] * p->volume[tip], f = 1e-6;
      step_surely(model, 100000);
      double rotation[3];
      particles_rotation(p, tip, rotation);
      assert_near(p->displacement.row[1][tip] / (f * (moment ? l * l / 2 : l * l * l / 3) / ei), 1, 1e-5);
      assert_near(rotation[2] / (f * (moment ? l : l * l / 2) / ei), 1, 1e-5);
      assert_balanced(model, 1e-3);
      breccia_model_destroy(&model);
    }
}

/** Energy of the motion, with what spins. */
static double moving(const Particles *p)
{
  double sum = 0;
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) {
      const int32_t i = p->place_of[n];
      sum += 0.5 * p->inertia.row[k][i] * p->volume[i] * p->velocity.row[k][i] * p->velocity.row[k][i];
    }
  return sum;
}

/** A free body that spins and vibrates keeps its momentum, its moment of momentum with that of spins, and its energy, through several turns. */
static void free_bodies_keep_energy_and_momentum(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    const char *loads = space ? "loads: [{initial velocity: {translation: [1, 0, 0], rotation: [3, 4, 12]}}]\n"
                                "solve: {explicit: {steps: 4000, safety: 0.5}}\n"
                              : "loads: [{initial velocity: {translation: [1, 2], rotation: [0, 0, 12]}}]\n"
                                "solve: {explicit: {steps: 4000, safety: 0.5}}\n";
    breccia_model *model = space ? block("face-centred cubic", "[5, 3, 2]", "3-D", "", loads)
                                 : block("hexagonal", "[9, 5]", "plane stress", "", loads);
    const Particles *p = model->domain.particles;
    double energy[2];
    Sums sums[2];
    step_surely(model, 1);
    for (int k = 0; k < 2; ++k) {
      energy[k] = moving(p) + all_stored(model);
      sums[k] = sums_of(model);
      if (!k) step_surely(model, 3999);
    }
    for (int axis = 0; axis < 3; ++axis) {
      assert_near(sums[1].momentum[axis], sums[0].momentum[axis], 1e-10);
      assert_near(sums[1].turn[axis] / sums[0].turn[2], sums[0].turn[axis] / sums[0].turn[2], 1e-6);
    }
    assert_near(energy[1] / energy[0], 1, 2e-3);
    assert_balanced(model, 1e-4);
    double length = 0; /* it has turned by more than a few turns, and is of one piece */
    for (int k = 0; k < 3; ++k)
      length += pow(p->position[k][p->place_of[0]] + p->displacement.row[k][p->place_of[0]] -
                        p->position[k][p->place_of[1]] - p->displacement.row[k][p->place_of[1]],
                    2);
    assert_near(sqrt(length) / spacing, 1, 0.05);
    assert_true(breccia_model_time(model) * 12 > 10);
    breccia_model_destroy(&model);
  }
}

/** Two blocks side by side, torn apart: links break, of lattices and between them. */
static breccia_model *torn_plate(bool space)
{
  return model_of(UNITS "materials: {m: {model: elastic, density: 2, Young modulus: 1e4, Poisson ratio: 0.2}}\n"
                        "body: {a: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {particles: %s}}},\n"
                        "       b: {material: m, lattice: %s, spacing: 0.1, %s shape: {box: {from: [0.9, 0, 0], to: "
                        "[1.8, 0.4, 0.3]}}}}\n"
                        "peridynamics: {formulation: micropolar, space: %s}\nfailure: {critical stretch: 0.01}\n"
                        "loads: [{on: {face: x-, block: a}, velocity: [-1, 0, 0], name: l}, {on: {face: x-, block: a}, "
                        "rotation: [0, 0, 0]}, {on: {face: x+, block: b}, velocity: [1, 0.3, 0]}, {on: {face: x+, "
                        "block: b}, rotation: [free, free, 0.1 rad], history: {ramp to: 0.02}}]\n"
                        "solve: {explicit: {steps: 120}}\n",
                  space ? "cubic" : "square", space ? "" : "thickness: 0.3,", space ? "[9, 4, 3]" : "[9, 4]",
                  space ? "cubic" : "square", space ? "" : "thickness: 0.3,", space ? "3-D" : "plane stress");
}

/** The same bits from a state that was taken up, and for any number of threads; what breaking takes is in the books. */
static void steps_are_the_same_again_and_for_any_number_of_threads(void **state)
{
  (void)state;
  for (int space = 0; space < 2; ++space) {
    breccia_model *model = torn_plate(space), *other = torn_plate(space);
    const Particles *p = model->domain.particles, *q = other->domain.particles;
    other->threads = 3;
    step_surely(model, 60);
    StateCopy at_sixty = state_of(model);
    for (int turn = 0; turn < 2; ++turn) {
      step_surely(turn ? model : other, turn ? 60 : 120);
      if (!turn) step_surely(model, 60);
      assert_int_equal(breccia_model_steps_done(model), 120);
      assert_true(breccia_model_broken_bonds(model) > 5);
      for (int k = 0; k < p->space.rows; ++k) {
        assert_memory_equal(p->displacement.row[k], q->displacement.row[k], sizeof(double) * (size_t)p->places);
        assert_memory_equal(p->velocity.row[k], q->velocity.row[k], sizeof(double) * (size_t)p->places);
      }
      for (int k = 0; k < 4 && space; ++k)
        assert_memory_equal(p->orientation[k], q->orientation[k], sizeof(double) * (size_t)p->places);
      assert_balanced(model, 1e-3);
      if (turn) break;
      StateList list = {0};
      Team *team = team_use(model->team);
      model_state(model, &list);
      assert_int_equal(state_return(&at_sixty, &list, NULL), 0);
      team_use(team);
      state_list_destroy(&list);
    }
    state_copy_destroy(&at_sixty);
    breccia_model_destroy(&model);
    breccia_model_destroy(&other);
  }
}

/** Bodies of other formulations have neither rows nor inertia of rotations. */
static void bodies_without_rotations_have_none(void **state)
{
  (void)state;
  breccia_model *model =
      model_of(SOFT_SOLID "body: {b: {material: m, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                          "solve: {explicit: {steps: 1}}\n");
  const Particles *p = model->domain.particles;
  assert_int_equal(p->space.rows, 3);
  for (int k = p->space.rotation; k < MAX_ROWS; ++k)
    assert_true(!p->displacement.row[k] && !p->velocity.row[k] && !p->internal.row[k] && !p->external.row[k]);
  assert_true(!p->rotary && !p->orientation[0]);
  breccia_model_destroy(&model);
  char *words =
      refusal_of(SOFT_SOLID "body: {b: {material: m, spacing: 1, shape: {box: {particles: [4, 4, 4]}}}}\n"
                            "loads: [{on: {face: x-}, rotation: [0, 0, 0]}]\nsolve: {explicit: {steps: 1}}\n");
  if (!strstr(words, "rotation: the particles of this body have no rotations")) fail_msg("%s", words);
  free(words);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(links_have_the_stiffness_of_closed_forms),
      cmocka_unit_test(uniform_strain_has_the_energy_of_the_continuum),
      cmocka_unit_test(what_bending_cannot_be_is_refused),
      cmocka_unit_test(what_cannot_turn_yet_is_refused),
      cmocka_unit_test(a_link_is_a_beam),
      cmocka_unit_test(forces_are_derivatives_of_the_energy),
      cmocka_unit_test(links_between_two_materials_neither_push_nor_turn),
      cmocka_unit_test(rotation_of_the_whole_changes_nothing),
      cmocka_unit_test(links_of_the_thesis_resist_rotation),
      cmocka_unit_test(a_row_of_links_bends_like_a_beam),
      cmocka_unit_test(free_bodies_keep_energy_and_momentum),
      cmocka_unit_test(steps_are_the_same_again_and_for_any_number_of_threads),
      cmocka_unit_test(bodies_without_rotations_have_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

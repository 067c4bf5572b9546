/* Particles that stand anywhere, read from a file. */
#include "support.h"

#include "base/random.h"
#include "base/tensor.h"
#include "family/surroundings.h"

#define FILE_NAME "test_cloud.csv"

/** Writes the particles of a model in a random order. @return number of the lattice particle in each row, to be freed */
static int32_t *write_particles(const breccia_model *model, bool plane)
{
  const Particles *p = model->domain.particles;
  int32_t *row = malloc(sizeof(int32_t) * (size_t)p->count);
  uint64_t seed = 7;
  for (int32_t n = 0; n < p->count; ++n) row[n] = n;
  for (int32_t n = (int32_t)p->count - 1; n > 0; --n) {
    int32_t other = (int32_t)(random_uniform(&seed) * (n + 1)), kept = row[n];
    row[n] = row[other];
    row[other] = kept;
  }
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  fprintf(file, "# made by a test\nvolume (m3), x (m),y%s\n", plane ? "" : ",z");
  for (int32_t n = 0; n < p->count; ++n) {
    int32_t i = p->place_of[row[n]];
    fprintf(file, "%.17g, %.17g,%.17g", p->volume[i], p->position[0][i], p->position[1][i]);
    if (!plane) fprintf(file, ",%.17g", p->position[2][i]);
    if (n + 1 < p->count) fprintf(file, "\n"); /* the last row needs no end */
  }
  fclose(file);
  return row;
}

typedef struct Setting {
  bool plane;
  const char *law, *peridynamics;
} Setting;

#define SOLID "model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.25"
#define FIBRE "model: elastic-1d, Young modulus: 150 MPa"

static breccia_model *body_of(const Setting *s, const char *block)
{
  return model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
                  "peridynamics: {%s}\nbody: {b: {material: m, spacing: 0.1, %s%s}}\n"
                  "cracks: [{cut: {line: [[0.45, -1], [0.45, 0.42]]}}, {remove: {box: {from: [0.2, 0.7, 0], to: [0.4, "
                  "0.9, 1]}}}]\nsolve: {explicit: {steps: 10, time step: 1e-6}}\n",
                  s->law, s->peridynamics, s->plane ? "lattice: square, thickness: 0.2, " : "", block);
}

static void break_some(breccia_model *model, const int32_t *number_of)
{
  Domain *d = &model->domain;
  const int32_t *place_of = d->particles->place_of;
  for (int32_t n = 3; n < 60; n += 4) {
    int32_t a = place_of[number_of ? number_of[n] : n], b = place_of[number_of ? number_of[n + 1] : n + 1];
    if (!family_break(&d->family, a, b)) continue;
    d->regions[0].type->renew(d->regions[0].formulation, a / SLICE);
    d->regions[0].type->renew(d->regions[0].formulation, b / SLICE);
  }
}

static void a_lattice_read_from_a_file_has_the_forces_of_the_lattice(void **state)
{
  (void)state;
  const Setting settings[] = {
      {false, SOLID, "zero-energy control: {none: yes}"},
      {false, SOLID, "zero-energy control: {silling: 0.1}"},
      {false, SOLID, "influence: gaussian, zero-energy control: {silling: 0.1}"},
      {false, SOLID, "strain: small, volume correction: partial, zero-energy control: {wan: 0.1}"},
      {true, SOLID, "space: plane stress, influence: cubic-spline, volume correction: partial-beyond"},
      {false, SOLID, "formulation: ordinary, lattice weights: plain"},
      {true, SOLID, "formulation: ordinary, lattice weights: plain, space: plane stress, influence: conical"},
      {false, FIBRE, "formulation: bond-based, calibration: continuum"},
      {false, FIBRE, "formulation: bond-based, calibration: continuum, influence: conical, volume correction: partial"},
      {true, FIBRE, "formulation: bond-based, calibration: continuum, space: plane strain"},
  };
  for (size_t k = 0; k < sizeof settings / sizeof *settings; ++k) {
    const Setting *s = &settings[k];
    breccia_model *lattice = body_of(s, "shape: {box: {from: [0, 0, 0], to: [1.1, 1, 0.7]}}");
    int32_t *row = write_particles(lattice, s->plane);
    breccia_model *cloud = body_of(s, "file: " FILE_NAME);
    const Particles *p = lattice->domain.particles, *q = cloud->domain.particles;
    assert_int_equal(p->count, q->count);
    assert_int_equal(lattice->domain.family.bonds, cloud->domain.family.bonds);
    int32_t *number_of = malloc(sizeof(int32_t) * (size_t)p->count);
    for (int32_t n = 0; n < p->count; ++n) number_of[row[n]] = n;
    break_some(lattice, NULL);
    break_some(cloud, number_of);
    for (int large = 0; large < 3; ++large) {
      const double amplitude[] = {1e-6, 1e-3, 2e-2};
      uint64_t seed = 3;
      for (int32_t n = 0; n < p->count; ++n)
        for (int c = 0; c < (s->plane ? 2 : 3); ++c)
          q->displacement.row[c][q->place_of[number_of[n]]] = p->displacement.row[c][p->place_of[n]] =
              amplitude[large] * (random_uniform(&seed) - 0.5);
      compute_forces(lattice);
      compute_forces(cloud);
      double most = 0, off = 0;
      for (int32_t n = 0; n < p->count; ++n)
        for (int c = 0; c < 3; ++c) {
          double f = p->internal.row[c][p->place_of[n]];
          most = larger_of(most, fabs(f));
          off = larger_of(off, fabs(f - q->internal.row[c][q->place_of[number_of[n]]]));
        }
      assert_true(most > 0);
      assert_near(off, 0, 2e-13 * most);
    }
    free(number_of);
    free(row);
    breccia_model_destroy(&lattice);
    breccia_model_destroy(&cloud);
  }
  remove(FILE_NAME);
}

/** A cube of n^3 particles, each moved by up to a third of the spacing of 0.1 m, with volumes that differ. */
static void write_scattered(int n)
{
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  uint64_t seed = 1;
  fprintf(file, "x,y,z,volume\n");
  for (int i = 0; i < n * n * n; ++i) {
    double x[3], grow = 0.9 + 0.2 * random_uniform(&seed);
    for (int k = 0; k < 3; ++k)
      x[k] = 0.1 * ((k == 0 ? i % n : k == 1 ? i / n % n : i / n / n) + (random_uniform(&seed) - 0.5) / 1.5);
    fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", x[0], x[1], x[2], 1e-3 * grow);
  }
  fclose(file);
}

/** Inside a bar that is stretched evenly, bonds store what the bar does: ends, whose families are halves, do not
 *  count, however long the horizon is; those that lack their last neighbour do. */
static void a_bar_from_a_file_is_as_stiff_as_its_law_says(void **state)
{
  (void)state;
  const double spacings[] = {0.1, 10};
  for (int s = 0; s < 2; ++s) {
    const double spacing = spacings[s], stretch = 1e-6;
    FILE *file = fopen(FILE_NAME, "w");
    assert_non_null(file);
    fprintf(file, "x (m),volume (m3)\n");
    for (int n = 0; n < 24; ++n) fprintf(file, "%.17g,%.17g\n", n * spacing, 0.5 * spacing);
    fclose(file);
    breccia_model *model = model_of(
        "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, model: elastic-1d, Young modulus: "
        "1e4}}\n"
        "peridynamics: {formulation: bond-based, space: 1-D, horizon: 3.015 spacings}\nbody: {b: {material: m, "
        "lattice: line, area: 0.5, spacing: %g, file: %s}}\nsolve: {explicit: {steps: 1}}\n",
        spacing, FILE_NAME);
    const Region *region = &model->domain.regions[0];
    const Particles *p = model->domain.particles;
    StoredEnergy energy;
    deform_uniformly(model, (double[]){1 + stretch, 0, 0, 0, 1, 0, 0, 0, 1});
    region->type->stored_energy(region->formulation, p->place_of[12], 0, &energy);
    assert_near(energy.stored / (p->volume[p->place_of[12]] * 1e4 * stretch * stretch / 2), 1, 0.03);
    breccia_model_destroy(&model);
  }
  remove(FILE_NAME);
}

static void numbers_follow_the_file_and_slices_hold_neighbours(void **state)
{
  (void)state;
  write_scattered(12);
  breccia_model *model = body_of(&(Setting){false, SOLID, "horizon: 3 spacings"}, "file: " FILE_NAME);
  const Particles *p = model->domain.particles;
  double before = -1, apart = 0, around = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    assert_int_equal(p->number[p->place_of[n]], n);
    double along = round(p->position[2][p->place_of[n]] * 10); /* layers come one after the other in the file */
    assert_true(along >= before);
    before = along;
  }
  for (int64_t place = 0; place < p->places; ++place) {
    if (p->number[place] < 0) assert_true(p->volume[place] == 0);
    double square = 0;
    for (int k = 0; k < 3; ++k) square += pow(p->position[k][place] - p->position[k][place / SLICE * SLICE], 2);
    apart += sqrt(square) / (double)p->places;
  }
  assert_true(apart < 0.2); /* two spacings; numbered along x they would be 3.5 apart */
  Surroundings s;
  assert_int_equal(surroundings_create(&s, &model->domain.family, NULL), BRECCIA_OK);
  around = (double)s.first[p->slices] / (double)model->domain.family.bonds;
  assert_true(around < 0.28); /* along Morton's curve 0.31: slices that share less */
  surroundings_destroy(&s);
  breccia_model_destroy(&model);
  remove(FILE_NAME);
}

/** Bonds of a slice's surroundings are those of its slots. */
static void check_surroundings(const Surroundings *s, const Family *f, int64_t slice)
{
  int64_t bonds = 0;
  for (int64_t n = s->first[slice]; n < s->first[slice + 1]; ++n) {
    if (n > s->first[slice]) assert_true(s->place[n] > s->place[n - 1]);
    bonds += __builtin_popcount(s->lanes[n]);
    for (int lane = 0; lane < SLICE; ++lane) {
      const int32_t here = (int32_t)(slice * SLICE + lane);
      const bool joined = s->lanes[n] >> lane & 1;
      assert_int_equal(joined, here != s->place[n] && family_joins(f, here, s->place[n]));
      if (!s->scale) continue;
      const int64_t slot = joined ? family_slot(f, here, s->place[n]) : 0;
      assert_true(s->scale[n * SLICE + lane] == (joined ? f->scale[(int64_t)f->base[slot] * SLICE + lane] : 0));
    }
  }
  int64_t intact = 0;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    intact += __builtin_popcount(f->intact[slot]);
  assert_int_equal(bonds, intact);
}

static void surroundings_have_every_bond_once(void **state)
{
  (void)state;
  write_scattered(6);
  for (int scaled = 0; scaled < 2; ++scaled) {
    const Setting setting = {false, SOLID, scaled ? "volume correction: partial" : "horizon: 3 spacings"};
    breccia_model *model = body_of(&setting, "file: " FILE_NAME);
    Family *f = &model->domain.family;
    Surroundings s;
    assert_int_equal(surroundings_create(&s, f, NULL), BRECCIA_OK);
    assert_int_equal(s.scale != NULL, scaled);
    for (int64_t slice = 0; slice < f->particles->slices; ++slice) check_surroundings(&s, f, slice);
    const int32_t a = s.place[0], b = (int32_t)__builtin_ctz(s.lanes[0]);
    assert_true(family_break(f, a, b));
    surroundings_renew(&s, f, a / SLICE);
    surroundings_renew(&s, f, 0);
    for (int64_t slice = 0; slice < f->particles->slices; ++slice) check_surroundings(&s, f, slice);
    assert_true(family_mend(f, a, b));
    surroundings_renew(&s, f, a / SLICE);
    surroundings_renew(&s, f, 0);
    for (int64_t slice = 0; slice < f->particles->slices; ++slice) check_surroundings(&s, f, slice);
    surroundings_destroy(&s);
    breccia_model_destroy(&model);
  }
  remove(FILE_NAME);
}

static void scattered_particles_have_exact_gradients_and_balance(void **state)
{
  (void)state;
  const double f[9] = {1.01, 0.002, -0.003, 0.004, 0.99, 0.001, -0.002, 0.003, 1.02};
  write_scattered(9);
  for (int fibres = 0; fibres < 2; ++fibres) {
    const Setting s = {false, fibres ? FIBRE : SOLID, fibres ? "formulation: bond-based" : "strain: small"};
    breccia_model *model = body_of(&s, "file: " FILE_NAME);
    const Particles *p = model->domain.particles;
    deform_uniformly(model, f);
    compute_forces(model);
    double total[3] = {0}, size = 0;
    for (int32_t n = 0; n < p->count; ++n) {
      int32_t i = p->place_of[n];
      double found[9];
      model->domain.regions[0].type->gradient(model->domain.regions[0].formulation, i, found);
      for (int k = 0; k < 9; ++k) assert_near(found[k], f[k], 1e-12);
      for (int k = 0; k < 3; ++k) {
        total[k] += p->internal.row[k][i] * p->volume[i];
        size += fabs(p->internal.row[k][i] * p->volume[i]);
      }
    }
    for (int k = 0; k < 3; ++k) assert_near(total[k], 0, 1e-13 * size);
    breccia_model_destroy(&model);
  }
  remove(FILE_NAME);
}

/** Uniform expansion of scattered bonds has the continuum's energy on the average over whole families (docs/theory.md 2). */
static void scattered_bonds_are_calibrated_inside_the_body(void **state)
{
  (void)state;
  write_scattered(13);
  breccia_model *model = model_of(
      "units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\nperidynamics: "
      "{formulation: bond-based}\nbody: {b: {material: m, spacing: 0.1, file: %s}}\nsolve: {explicit: {steps: 1}}\n",
      FIBRE, FILE_NAME);
  const double stretch = 1e-5, f[9] = {1 + stretch, 0, 0, 0, 1 + stretch, 0, 0, 0, 1 + stretch};
  deform_uniformly(model, f);
  double sum = 0, count = 0;
  for (int32_t n = 0; n < model->domain.particles->count; ++n) {
    int32_t i = model->domain.particles->place_of[n];
    double stress[6], strain[6];
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside &= fabs(model->domain.particles->position[k][i] - 0.6) < 0.3;
    if (!inside) continue;
    domain_look(&model->domain, i, strain, stress);
    sum += (stress[XX] + stress[YY] + stress[ZZ]) / 3;
    ++count;
  }
  assert_near(sum / count, 150e3 * 2 * stretch, 0.02 * 150e3 * 2 * stretch); /* 3 K = E / (1 - 2 nu) = 2 E */
  breccia_model_destroy(&model);
  remove(FILE_NAME);
}

static void threads_do_not_change_a_bit(void **state)
{
  (void)state;
  write_scattered(10);
  for (int fibres = 0; fibres < 2; ++fibres) {
    double *reference = NULL;
    for (int threads = under_sanitizers() ? 3 : 1; threads <= 3; ++threads) {
      const char words[] = {(char)('0' + threads), 0};
      setenv("OMP_NUM_THREADS", words, 1); /* of setting up, too */
      breccia_model *model =
          model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n%s"
                   "body: {b: {material: m, spacing: 0.1, file: %s}}\nfailure: {critical stretch: 0.002}\n"
                   "loads: [{on: {face: x+, layers: 2}, velocity: [1, 0, 0]}, {on: {face: x-, layers: 2}, velocity: "
                   "[0, 0, 0]}]\n"
                   "solve: {explicit: {steps: 100}}\n",
                   fibres ? FIBRE : SOLID, fibres ? "peridynamics: {formulation: bond-based}\n" : "", FILE_NAME);
      model->threads = threads;
      breccia_model_step(model, 30, NULL);
      assert_true(breccia_model_broken_bonds(model) > 0);
      size_t bytes = sizeof(double) * (size_t)breccia_model_places(model);
      if (!reference) {
        reference = malloc(bytes);
        memcpy(reference, breccia_model_array(model, "displacement y"), bytes);
      } else
        assert_memory_equal(breccia_model_array(model, "displacement y"), reference, bytes);
      breccia_model_destroy(&model);
    }
    free(reference);
  }
  unsetenv("OMP_NUM_THREADS");
  remove(FILE_NAME);
}

static void groups_of_a_file_are_selections(void **state)
{
  (void)state;
  /* A grid whose columns by x are of the groups a, b, c, and none, in a mixed order; the crack takes out the particles beyond y = 0.7. */
  static const char *const names[] = {"a", " \"b\" ", "north wall", ""};
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  fprintf(file, "x,y,group,volume\r\n");
  for (int n = 0; n < 80; ++n) {
    const int i = n * 37 % 80;
    fprintf(file, "%g,%g,%s,0.01\r\n", 0.1 * (i % 8), 0.1 * (i / 8), names[i % 4]);
  }
  fclose(file);
  const struct {
    const char *on;
    int columns, particles;
  } cases[] = {{"a", 0, 2 * 7}, {"{group: b}", 1, 2 * 7}, {"north wall", 2, 2 * 7}, {"{group: a, face: x+}", 0, 7}};
  static const char *const blocks[] = {
      "f: {material: m, lattice: square, thickness: 1, spacing: 0.1, file: " FILE_NAME "}",
      "g: {material: m, lattice: square, thickness: 1, spacing: 0.1, shape: {box: {particles: [4, 4], "
      "first particle: [2, 2]}}}"};
  for (int n = 0; n < 8; ++n) { /* the file's block first, or last */
    const int k = n % 4;
    breccia_model *model = model_of("materials: {m: {density: 1.5, " SOLID "}}\nperidynamics: {space: plane strain}\n"
                                    "body: {%s, %s}\ncracks: [{remove: {box: {from: [-1, 0.65], to: [1, 1]}}}]\n"
                                    "loads: [{on: %s, body force: [1, 0]}]\nsolve: {explicit: {steps: 1}}\n",
                                    blocks[n / 4], blocks[1 - n / 4], cases[k].on);
    const Selection *selection = &model->loading.loads[0].selection;
    assert_int_equal(selection->count, cases[k].particles);
    for (int64_t i = 0; i < selection->count; ++i)
      assert_int_equal(lround(10 * model->domain.particles->position[0][selection->places[i]]) % 4, cases[k].columns);
    breccia_model_destroy(&model);
  }
  char *words =
      refusal_of("materials: {m: {density: 1.5, " SOLID "}}\nperidynamics: {space: plane strain}\n"
                 "body: {f: {material: m, lattice: square, thickness: 1, spacing: 0.1, file: " FILE_NAME "}}\n"
                 "selections: {a: {face: x-}}\nloads: [{on: a, body force: [1, 0]}]\n"
                 "solve: {explicit: {steps: 1}}\n");
  assert_non_null(strstr(words, "'a' is the name of a selection and of a group in a file"));
  free(words);
  remove(FILE_NAME);
}

static void wrong_files_are_refused_with_the_reason(void **state)
{
  (void)state;
  const struct {
    const char *content, *block, *words;
  } wrong[] = {
      {NULL, "file: no-such.csv",
       "file: no-such.csv: No such file or directory; expected a CSV file with the columns x, y, z, volume"},
      {"x,y,volume\n0,0,1\n", "file: " FILE_NAME, "has no column 'z'"},
      {"x,y,z,volume\n0,0,0,1\n1,0,0,0\n", "file: " FILE_NAME, "particle 1: its volume must be a number above 0"},
      {"x,y,z,volume\n0,0,0,1\n1,O,0,1\n", "file: " FILE_NAME, "particle 1: its y is not a number"},
      {"x,y,z,volume\n", "file: " FILE_NAME, "has no particle"},
      {"x,y,z,volume\n0,0,0,1\n1e-9,0,0,1\n", "file: " FILE_NAME, "two particles lie on top of each other"},
      {"x,y,z,volume\n0,0,0,1\n", "file: " FILE_NAME ", shape: {sphere: {centre: [0, 0, 0], radius: 1}}",
       "more than one of 'shape', 'file'"},
  };
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    FILE *file = fopen(FILE_NAME, "w");
    if (wrong[k].content) fputs(wrong[k].content, file);
    fclose(file);
    char *deck = text_format("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\n"
                             "body: {b: {material: m, spacing: 0.1, %s}}\nsolve: {explicit: {steps: 1}}\n",
                             SOLID, wrong[k].block);
    char *words = refusal_of(deck);
    if (!strstr(words, wrong[k].words)) fail_msg("expected '%s' in '%s'", wrong[k].words, words);
    free(words);
    free(deck);
  }
  write_scattered(5);
  char *words =
      refusal_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, " FIBRE "}}\n"
                 "peridynamics: {formulation: bond-based, calibration: continuum, surface correction: energy}\n"
                 "body: {b: {material: m, spacing: 0.1, file: " FILE_NAME "}}\nsolve: {explicit: {steps: 1}}\n");
  if (!strstr(words, "neighbours fill the horizon")) fail_msg("found '%s'", words);
  free(words);
  remove(FILE_NAME);
}

/** A plate of 6 x 4 particles, of which those of the outermost column have half of the volume. */
static void a_thickness_that_contradicts_the_volumes_is_refused(void **state)
{
  (void)state;
  static const struct {
    const char *thickness;
    double volume, growth; /* of the particles, and from each to the next */
    bool refused;
  } cases[] = {{"0.2", 0.002, 1, false}, {"0.24", 0.002, 1, false},    {"0.26", 0.002, 1, true},
               {"2", 0.002, 1, true},    {"0.02", 0.002, 1.01, false}, {"0.15", 0.002, 1, true}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    FILE *file = fopen(FILE_NAME, "w");
    assert_non_null(file);
    fputs("x,y,volume\n", file);
    double volume = cases[k].volume;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 4; ++j, volume *= cases[k].growth)
        fprintf(file, "%g,%g,%.17g\n", 0.1 * i, 0.1 * j, i ? volume : volume / 2);
    fclose(file);
    char *deck = text_format("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, " SOLID "}}\n"
                             "peridynamics: {space: plane strain}\n"
                             "body: {b: {material: m, lattice: square, spacing: 0.1, thickness: %s, file: " FILE_NAME
                             "}}\nsolve: {explicit: {steps: 1}}\n",
                             cases[k].thickness);
    if (!cases[k].refused) {
      breccia_model *m = model_of("%s", deck);
      breccia_model_destroy(&m);
    } else {
      char *words = refusal_of(deck);
      if (!strstr(words, "deck:4:67: thickness: ") ||
          !strstr(words, "contradicts the volumes in '" FILE_NAME "': 0.002 with a spacing of 0.1 makes 0.2"))
        fail_msg("%s: %s", cases[k].thickness, words);
      free(words);
    }
    free(deck);
  }
  remove(FILE_NAME);
}

static void comments_and_blank_lines_of_a_file_are_no_particles(void **state)
{
  (void)state;
  write_scattered(6);
  const Setting setting = {false, SOLID, "horizon: 3 spacings"};
  breccia_model *plain = body_of(&setting, "file: " FILE_NAME);
  char *text = text_read_file(FILE_NAME, NULL);
  FILE *file = fopen(FILE_NAME, "w");
  assert_true(text && file);
  fputs("# scattered by hand\n", file);
  int row = 0;
  for (char *line = text, *end; (end = strchr(line, '\n')); line = end + 1)
    fprintf(file, "%.*s\n%s", (int)(end - line), line,
            ++row % 3 == 0 ? "# 9, 9, 9, 9\n"
            : row % 5 == 0 ? "\n"
            : row % 7 == 0 ? " \t\n#\n"
                           : "");
  fclose(file);
  free(text);
  breccia_model *marked = body_of(&setting, "file: " FILE_NAME);
  const Particles *p = plain->domain.particles, *q = marked->domain.particles;
  assert_int_equal(p->count, q->count);
  for (int k = 0; k < 3; ++k) assert_memory_equal(p->position[k], q->position[k], sizeof(double) * (size_t)p->places);
  assert_memory_equal(p->volume, q->volume, sizeof(double) * (size_t)p->places);
  breccia_model_destroy(&plain);
  breccia_model_destroy(&marked);
  remove(FILE_NAME);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_lattice_read_from_a_file_has_the_forces_of_the_lattice),
      cmocka_unit_test(a_bar_from_a_file_is_as_stiff_as_its_law_says),
      cmocka_unit_test(numbers_follow_the_file_and_slices_hold_neighbours),
      cmocka_unit_test(surroundings_have_every_bond_once),
      cmocka_unit_test(scattered_particles_have_exact_gradients_and_balance),
      cmocka_unit_test(scattered_bonds_are_calibrated_inside_the_body),
      cmocka_unit_test(threads_do_not_change_a_bit),
      cmocka_unit_test(groups_of_a_file_are_selections),
      cmocka_unit_test(comments_and_blank_lines_of_a_file_are_no_particles),
      cmocka_unit_test(wrong_files_are_refused_with_the_reason),
      cmocka_unit_test(a_thickness_that_contradicts_the_volumes_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

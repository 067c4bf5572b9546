/* Every formulation against its own points, one by one: forces are transposed operators times stresses, sums of half states, and minus the
 * gradient of the energy; a linearised step is the change of the forces, and the sum of the points' stiffnesses. One loop over all formulations of the
 * list, with their controls and corrections, in all spaces, on lattices and scattered particles with broken bonds, with laws of each kind. */
#include "support.h"

#include "base/random.h"
#include "base/tensor.h"

typedef struct Law {
  const char *name, *words;
  bool elastic;  /* forces follow from an energy */
  double strain; /* at which the law is interesting */
  double slack;  /* of its tangents beside the stiffness */
} Law;

/** One of each kind: elastic, plastic, damaging, rate-dependent. */
static const Law solid[] = {
    {"elastic", "Young modulus: 150, Poisson ratio: 0.2", true, 0.03, 1e-7},
    {"j2", "Young modulus: 150, Poisson ratio: 0.3, yield stress: 2", false, 0.03, 1e-5},
    {"drucker-prager",
     "Young modulus: 150, Poisson ratio: 0.3, cohesion: 1, friction angle: 30, dilation angle: 10, hardening modulus: "
     "10",
     false, 0.02, 1e-5},
    {"mazars", "Young modulus: 150, Poisson ratio: 0.2, tensile strength: 0.1, fracture energy: 0.2", false, 0.004,
     1e-5},
    {"viscoelastic", "Young modulus: 150, Poisson ratio: 0.2, relaxing share: 0.7, relaxation time: 0.8", false, 0.03,
     1e-7},
};
static const Law fibre[] = {
    {"elastic-1d", "Young modulus: 150", true, 0.03, 1e-7},
    {"elastic-brittle", "Young modulus: 150, tensile strength: 100", true, 0.03, 1e-7},
    {"bilinear-softening", "Young modulus: 150, tensile strength: 1.5, fracture energy: 0.4", false, 0.02, 1e-6},
    {"elastic-perfectly-plastic", "Young modulus: 150, yield stress: 1", false, 0.008, 1e-6},
};
enum { SOLIDS = sizeof solid / sizeof *solid, FIBRES = sizeof fibre / sizeof *fibre, TIME_STEP = 1 };
enum { BODIES = 3, SCATTERED = 2 };

typedef struct Setting {
  const char *space, *words;
  int bodies; /* the first so many: where families must be whole, scattered particles do not fit */
} Setting;

/** What each formulation is tested with. */
static const struct Covered {
  const char *formulation;
  Setting settings[8];
} covered[] = {
    {"correspondence",
     {{"3-D", "zero-energy control: {none: yes}", BODIES},
      {"3-D", "zero-energy control: {silling: 0.1}", BODIES},
      {"3-D", "zero-energy control: {wan: 0.1}, strain: small", BODIES},
      {"3-D", "influence: cubic-spline", BODIES},
      {"plane strain", "zero-energy control: {silling: 0.2}, strain: small", BODIES},
      {"plane strain", "zero-energy control: {wan: 0.1}", BODIES},
      {"plane stress", "zero-energy control: {none: yes}", BODIES},
      {"plane stress", "influence: conical, volume correction: partial", BODIES}}},
    {"bond-based",
     {{"3-D", "calibration: uniform-expansion", SCATTERED},
      {"3-D", "calibration: continuum, influence: conical, volume correction: partial, surface correction: energy",
       SCATTERED},
      {"3-D", "calibration: continuum, influence: inverse", BODIES},
      {"plane strain", "surface correction: energy", SCATTERED},
      {"plane strain", "calibration: continuum", BODIES},
      {"plane stress", "calibration: uniaxial", SCATTERED},
      {"1-D", "calibration: continuum", BODIES}}},
    {"ordinary",
     {{"3-D", "lattice weights: isotropic", BODIES},
      {"3-D", "lattice weights: plain, influence: conical, volume correction: partial", BODIES},
      {"plane strain", "influence: inverse", BODIES},
      {"plane strain", "lattice weights: plain", BODIES},
      {"plane stress", "volume correction: partial-beyond", BODIES},
      {"plane stress", "influence: conical", BODIES}}},
    {"hybrid",
     {{"3-D", "form: variational", BODIES},
      {"3-D", "form: variational, strain: small, influence: inverse, own bond: 0.7", BODIES},
      {"3-D", "form: pairwise, influence: conical", BODIES},
      {"plane strain", "form: variational, volume correction: partial", BODIES},
      {"plane strain", "form: pairwise, strain: small", BODIES},
      {"plane stress", "form: variational", BODIES},
      {"plane stress", "form: pairwise", BODIES}}},
    {"micropolar",
     {{"3-D", "torsion: 1", BODIES},
      {"3-D", "torsion: 0, influence: conical, volume correction: partial", BODIES},
      {"plane strain", "influence: inverse", BODIES},
      {"plane stress", "kinematics: corotational", BODIES}}},
};

#define CUT "cracks: [{cut: {line: [[3.05, -9], [3.05, 2.1]]}}]\n"
#define FILE_NAME "test_operator.csv"

/** Two blocks that do not fit each other, with a cut; rows that are not at right angles; particles anywhere. */
static const char *const space_bodies[BODIES][2] = {
    {"spacing: 1, shape: {box: {particles: [6, 5, 4]}}",
     "spacing: 0.8, shape: {box: {from: [0, 0, 4], to: [2.4, 4, 6.4]}}"},
    {"spacing: 1, lattice: face-centred cubic, shape: {box: {particles: [5, 4, 4]}}"},
    {"spacing: 1, file: " FILE_NAME}};
static const char *const plane_bodies[BODIES][2] = {
    {"spacing: 1, lattice: square, thickness: 0.7, shape: {box: {particles: [9, 6]}}",
     "spacing: 0.8, lattice: square, thickness: 0.7, shape: {box: {from: [0, 6], to: [2.4, 9.2]}}"},
    {"spacing: 1, lattice: hexagonal, thickness: 0.7, shape: {box: {particles: [9, 8]}}"},
    {"spacing: 1, lattice: square, thickness: 0.7, file: " FILE_NAME}};
static const char *const line_bodies[BODIES][2] = {
    {"lattice: line, area: 0.5, spacing: 1, shape: {box: {particles: [13, 1]}}"},
    {"lattice: line, area: 0.5, spacing: 1, shape: {box: {particles: [6, 1]}}",
     "lattice: line, area: 0.5, spacing: 0.8, shape: {box: {from: [6, 0], to: [10.8, 1]}}"},
    {"lattice: line, area: 0.5, spacing: 1, file: " FILE_NAME}};

/** A grid of particles, each moved by up to 0.3 of the spacing, with volumes that differ. */
static void scatter(const char *space)
{
  static const int counts[3][3] = {{5, 5, 4}, {9, 8, 1}, {13, 1, 1}};
  const int k = !strcmp(space, "1-D") ? 2 : *space == 'p', *count = counts[k];
  const double depth[] = {1, 0.7, 0.5};
  static const char *const names[] = {"x,y,z,volume\n", "x,y,volume\n", "x,volume\n"};
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  uint64_t seed = 5;
  fputs(names[k], file);
  for (int i = 0; i < count[0] * count[1] * count[2]; ++i) {
    const int at[3] = {i % count[0], i / count[0] % count[1], i / count[0] / count[1]};
    for (int c = 0; c < 3 - k; ++c) fprintf(file, "%.17g,", at[c] + 0.6 * (random_uniform(&seed) - 0.5));
    fprintf(file, "%.17g\n", depth[k] * (0.9 + 0.2 * random_uniform(&seed)));
  }
  fclose(file);
}

static breccia_model *body(const char *formulation, const Law *law, const Setting *setting, int number)
{
  char shapes[400];
  const bool line = !strcmp(setting->space, "1-D");
  const char *const *blocks = line                     ? line_bodies[number]
                              : *setting->space == 'p' ? plane_bodies[number]
                                                       : space_bodies[number];
  if (number == SCATTERED) scatter(setting->space);
  if (blocks[1])
    snprintf(shapes, sizeof shapes, "a: {material: m, %s}, b: {material: m, %s}", blocks[0], blocks[1]);
  else
    snprintf(shapes, sizeof shapes, "a: {material: m, %s}", blocks[0]);
  breccia_model *model =
      model_of("materials: {m: {model: %s, density: 1, %s}}\nperidynamics: {formulation: %s, space: %s, horizon: 2.5, "
               "%s}\nbody: {%s}\n%ssolve: {implicit: {end time: 1, stiffness damping: 1e-6}}\n",
               law->name, law->words, formulation, setting->space, setting->words, shapes, line ? "" : CUT);
  if (number == SCATTERED) remove(FILE_NAME);
  return model;
}

/** One formulation and law in each of the two blocks. */
typedef struct Couple {
  const char *space, *words;
  struct {
    const char *formulation;
    const Law *law;
  } of[2];
} Couple;

static const Couple couples[] = {
    {"3-D", "", {{"bond-based", &fibre[0]}, {"correspondence", &solid[0]}}},
    {"3-D", "", {{"correspondence, zero-energy control: {wan: 0.1}", &solid[1]}, {"bond-based", &fibre[2]}}},
    {"3-D",
     "influence: conical, volume correction: partial,",
     {{"bond-based, surface correction: energy", &fibre[2]}, {"correspondence, strain: small", &solid[3]}}},
    {"3-D", "", {{"correspondence, zero-energy control: {none: yes}", &solid[0]}, {"correspondence", &solid[0]}}},
    {"3-D", "", {{"ordinary", &solid[0]}, {"correspondence", &solid[1]}}},
    {"3-D", "", {{"ordinary", &solid[1]}, {"ordinary, lattice weights: plain", &solid[4]}}},
    {"3-D", "", {{"bond-based", &fibre[0]}, {"ordinary", &solid[0]}}},
    {"3-D", "", {{"bond-based", &fibre[2]}, {"bond-based, calibration: continuum", &fibre[3]}}},
    {"plane strain", "influence: conical,", {{"correspondence", &solid[2]}, {"bond-based", &fibre[3]}}},
    {"plane strain", "", {{"bond-based", &fibre[0]}, {"ordinary", &solid[4]}}},
    {"plane stress", "", {{"bond-based", &fibre[1]}, {"correspondence", &solid[0]}}},
    {"plane stress", "", {{"correspondence", &solid[0]}, {"ordinary", &solid[0]}}},
    {"plane stress", "", {{"ordinary", &solid[1]}, {"correspondence", &solid[4]}}},
    {"3-D", "", {{"hybrid", &solid[0]}, {"correspondence", &solid[1]}}},
    {"3-D", "influence: conical,", {{"bond-based", &fibre[2]}, {"hybrid", &solid[1]}}},
    {"3-D", "", {{"hybrid", &solid[3]}, {"hybrid, strain: small", &solid[0]}}},
    {"plane strain", "", {{"ordinary", &solid[1]}, {"hybrid, own bond: 0.7", &solid[3]}}},
    {"plane strain", "", {{"hybrid, form: pairwise", &solid[1]}, {"correspondence", &solid[0]}}},
    {"plane stress", "", {{"hybrid", &solid[1]}, {"bond-based", &fibre[0]}}},
    {"plane stress", "", {{"hybrid", &solid[0]}, {"hybrid", &solid[4]}}},
    {"3-D", "", {{"micropolar", &solid[0]}, {"correspondence", &solid[1]}}},
    {"3-D", "influence: conical,", {{"hybrid", &solid[0]}, {"micropolar, torsion: 0.5", &solid[0]}}},
    {"plane strain", "", {{"ordinary", &solid[0]}, {"micropolar", &solid[0]}}},
    {"plane stress", "", {{"micropolar", &solid[0]}, {"bond-based", &fibre[0]}}},
};

static breccia_model *coupled_body(const Couple *c)
{
  const char *const *blocks = *c->space == 'p' ? plane_bodies[0] : space_bodies[0];
  return model_of("materials: {m: {model: %s, density: 1, %s}, n: {model: %s, density: 1, %s}}\nperidynamics: {space: "
                  "%s, horizon: 2.5, %s formulation: %s, regions: {more: {blocks: [b], formulation: %s}}}\nbody: {a: "
                  "{material: m, %s}, b: {material: n, %s}}\n" CUT
                  "solve: {implicit: {end time: 1, stiffness damping: 1e-6}}\n",
                  c->of[0].law->name, c->of[0].law->words, c->of[1].law->name, c->of[1].law->words, c->space, c->words,
                  c->of[0].formulation, c->of[1].formulation, blocks[0], blocks[1]);
}

static void sever(breccia_model *model, int32_t a, int32_t b)
{
  Domain *d = &model->domain;
  assert_true(family_break(&d->family, a, b));
  for (int end = 0; end < 2; ++end) {
    const Region *region = domain_region(d, end ? b : a);
    if (region->type->renew) region->type->renew(region->formulation, (end ? b : a) / SLICE);
  }
}

/** Breaks every fifth bond of one particle, and all bonds of particle `poor` but two or three, which leaves it without a strain. */
static void sever_some(breccia_model *model, int32_t poor)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  for (int turn = 0; turn < 2; ++turn) {
    const int32_t place = p->place_of[turn ? poor : p->count / 2];
    const int64_t slice = place / SLICE;
    int left = family_count(&d->family, place), number = 0;
    for (int64_t slot = d->family.first[slice]; slot < d->family.first[slice + 1]; ++slot) {
      if (!(d->family.intact[slot] >> place % SLICE & 1)) continue;
      if (turn ? left <= d->body.dimensions : number++ % 5) continue;
      sever(model, place, family_bond(&d->family, slice, slot, place % SLICE).neighbour);
      --left;
    }
  }
}

/** Vectors over places. */
typedef struct Vectors {
  Vector of[1];
} Vectors;

static Vectors vectors(const Particles *p)
{
  Vectors v;
  assert_true(vector_create(v.of, &p->space, "test", NULL));
  return v;
}

static void forget(Vectors *v)
{
  vector_destroy(v->of);
}

static void randomize(const Domain *d, double *const *v, double size, uint64_t seed)
{
  for (int32_t n = 0; n < d->particles->count; ++n)
    for (int k = 0; k < d->particles->space.rows; ++k)
      if (k < d->body.dimensions || k >= d->particles->space.rotation)
        v[k][d->particles->place_of[n]] = size * 2 * (random_uniform(&seed) - 0.5);
}

/** A linear field and a random one. */
static void displace(const Domain *d, double strain, uint64_t seed)
{
  const Particles *p = d->particles;
  const double g[9] = {1, 0.3, -0.2, -0.1, -0.4, 0.3, 0.2, 0.1, 0.6};
  randomize(d, p->displacement.row, 0.5 * strain, seed);
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < d->body.dimensions; ++k)
      for (int j = 0; j < d->body.dimensions; ++j)
        p->displacement.row[k][p->place_of[n]] += strain * g[3 * k + j] * p->position[j][p->place_of[n]];
  particles_take_rotations(d->particles, 0, p->places);
}

static void move(const Domain *d, const Vectors *v, double factor)
{
  for (int k = 0; k < d->particles->space.rows; ++k)
    for (int64_t i = 0; i < d->particles->places; ++i)
      d->particles->displacement.row[k][i] += factor * v->of->row[k][i];
}

static double largest(const Particles *p, double *const *v)
{
  double most = 0;
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i) most = larger_of(most, fabs(v[k][i]));
  return most;
}

static void assert_alike(const Particles *p, double *const *a, double *const *b, double part, const char *what)
{
  const double most = largest(p, a);
  if (!(most > 0)) fail_msg("%s: nothing but 0", what);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i)
      if (!(fabs(a[k][i] - b[k][i]) <= part * most))
        fail_msg("%s: %g and %g at place %lld of [%g, %g, %g], of %g at most", what, a[k][i], b[k][i], (long long)i,
                 p->position[0][i], p->position[1][i], p->position[2][i], most);
}

static double energy(Domain *d)
{
  double sum = 0;
  for (int32_t n = 0; n < d->particles->count; ++n) {
    StoredEnergy at;
    const Region *region = domain_region(d, d->particles->place_of[n]);
    region->type->stored_energy(region->formulation, d->particles->place_of[n], 0, &at);
    sum += at.stored;
  }
  return sum;
}

/** Forces per particle as they stand. */
static Vectors forces(const Domain *d)
{
  const Particles *p = d->particles;
  Vectors f = vectors(p);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i) f.of->row[k][i] = p->internal.row[k][i] * p->volume[i];
  return f;
}

static void check_forces(Domain *d, const Vectors *f, const char *name)
{
  const Particles *p = d->particles;
  Vectors sum = vectors(p), halves = vectors(p);
  Operator point = {0};
  for (const Region *region = d->regions; region < d->regions + d->region_count; ++region)
    for (int64_t n = 0; n < region->type->point_count(region->formulation); ++n) {
      assert_int_equal(region->type->point(region->formulation, d->particles->displacement.row, n, &point, NULL), 0);
      operator_add_forces(&point, p->displacement.row, sum.of->row);
    }
  operator_destroy(&point);
  assert_alike(p, f->of->row, sum.of->row, 1e-11, name);
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = d->family.first[slice]; slot < d->family.first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(d->family.intact[slot] >> lane & 1)) continue;
        double force[3];
        const double volume = p->volume[family_bond(&d->family, slice, slot, lane).neighbour];
        domain_bond_force(d, slice, slot, lane, force);
        for (int k = 0; k < 3; ++k)
          halves.of->row[k][slice * SLICE + lane] += force[k] * volume * p->volume[slice * SLICE + lane];
      }
  for (int k = p->space.rotation; k < p->space.rows; ++k) /* half states have no moments */
    memcpy(halves.of->row[k], f->of->row[k], sizeof(double) * (size_t)p->places);
  assert_alike(p, f->of->row, halves.of->row, 1e-11, name);
  forget(&sum);
  forget(&halves);
}

/** Compares one block of the stiffness of a point, taken at random, with what operator_stiffness() finds for its two
 * places alone. */
static void check_block(const Operator *point, double *const u[3], const double *stiffness, uint64_t *seed)
{
  double alone[MAX_ROWS * MAX_ROWS], most = 0;
  const int a = (int)(random_uniform(seed) * point->count), b = (int)(random_uniform(seed) * point->count),
            size = point->motions * point->motions;
  const double *block = stiffness + (int64_t)size * (point->count * a + b);
  operator_stiffness(point, u, a, b, alone);
  for (int c = 0; c < size; ++c) most = larger_of(most, fabs(block[c]));
  for (int c = 0; c < size; ++c) assert_near(alone[c], block[c], 1e-10 * most);
}

/** Change of the forces with changes v, by the points' stiffnesses. */
static Vectors assembled(const Domain *d, const Vectors *v)
{
  const Particles *p = d->particles;
  Vectors sum = vectors(p);
  Operator point = {0};
  double *stiffness = NULL;
  int room = 0; /* places for which there is memory */
  uint64_t seed = 17;
  for (const Region *region = d->regions; region < d->regions + d->region_count; ++region)
    for (int64_t n = 0; n < region->type->point_count(region->formulation); ++n) {
      assert_int_equal(region->type->point(region->formulation, d->particles->displacement.row, n, &point, NULL), 0);
      const int size = point.motions * point.motions;
      if (!point.count) continue;
      if (point.count > room) {
        room = 2 * point.count;
        free(stiffness);
        stiffness = calloc((size_t)room * (size_t)room * MAX_ROWS * MAX_ROWS, sizeof *stiffness);
        assert_non_null(stiffness);
      }
      assert_int_equal(operator_matrix(&point, p->displacement.row, stiffness, NULL), 0);
      check_block(&point, p->displacement.row, stiffness, &seed);
      const double *k = stiffness;
      for (int a = 0; a < point.count; ++a)
        for (int b = 0; b < point.count; ++b, k += size)
          for (int c = 0; c < size; ++c)
            sum.of->row[c / point.motions][point.places[a].place] +=
                k[c] * v->of->row[c % point.motions][point.places[b].place];
    }
  operator_destroy(&point);
  free(stiffness);
  return sum;
}

/** Strains of points in space as they change with v. */
static void check_strains(Domain *d, const Vectors *v, double h)
{
  const Particles *p = d->particles;
  double *strain[2] = {calloc(6 * (size_t)p->places, sizeof(double)), calloc(6 * (size_t)p->places, sizeof(double))};
  for (int side = 0; side < 2; ++side) {
    move(d, v, side ? 2 * h : -h);
    domain_evaluate(d, NULL);
    for (int64_t i = 0; i < 6 * p->places; ++i) strain[side][i] = d->strain[i % 6][i / 6];
  }
  move(d, v, -h);
  Operator point = {0};
  for (int64_t i = 0; i < p->places; ++i) {
    double change[6];
    const Region *region = domain_region(d, i);
    if (!points_on_particles(&region->points)) continue;
    assert_int_equal(region->type->point(region->formulation, p->displacement.row, i, &point, NULL), 0);
    operator_strain(&point, p->displacement.row, v->of->row, change);
    for (int k = 0; k < 6 && point.components; ++k)
      if (k != ZZ || !region->points.plane_stress)
        assert_near(change[k], (strain[1][6 * i + k] - strain[0][6 * i + k]) / (2 * h), 1e-8);
  }
  operator_destroy(&point);
  free(strain[0]);
  free(strain[1]);
}

static void check_model(breccia_model *model, const Law *law, int32_t poor, const char *name)
{
  Domain *d = &model->domain;
  const Particles *p = d->particles;
  Team *before = team_use(model->team);
  d->clock.time_step = TIME_STEP;
  sever_some(model, poor);
  displace(d, law->strain, 3);
  domain_evaluate(d, NULL);
  domain_commit_points(d);
  displace(d, 1.3 * law->strain, 3);
  assert_int_equal(domain_linearise(d, NULL, NULL), 0);
  Vectors f = forces(d);
  check_forces(d, &f, name);

  Vectors v = vectors(p), step = vectors(p), found = vectors(p);
  randomize(d, v.of->row, 1, 8);
  Vectors sum = assembled(d, &v);
  domain_linear_step(d, v.of, step.of);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i) step.of->row[k][i] *= p->volume[i];
  assert_alike(p, sum.of->row, step.of->row, 1e-11, name);

  const double h = 1e-5 * law->strain;
  double energies[2], work = 0, size = 0;
  for (int side = 0; side < 2; ++side) {
    move(d, &v, side ? 2 * h : -h);
    domain_evaluate(d, NULL);
    energies[side] = energy(d);
    for (int k = 0; k < p->space.rows; ++k)
      for (int64_t i = 0; i < p->places; ++i)
        found.of->row[k][i] += (side ? 1 : -1) * p->internal.row[k][i] * p->volume[i] / (2 * h);
  }
  assert_alike(p, step.of->row, found.of->row, law->slack, name);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i) {
      work += f.of->row[k][i] * v.of->row[k][i];
      size += fabs(f.of->row[k][i] * v.of->row[k][i]);
    }
  if (law->elastic && !strstr(name, "pairwise")) assert_near(work, -(energies[1] - energies[0]) / (2 * h), 1e-6 * size);
  move(d, &v, -h);
  if (d->strain[0]) check_strains(d, &v, h);
  forget(&f);
  forget(&v);
  forget(&step);
  forget(&sum);
  forget(&found);
  team_use(before);
}

/** Returns true for one body of each setting with each law, such that each setting and each law meets each body; for
 * all with BRECCIA_WHOLE. */
static bool body_is_sampled(int setting, int law, int body_number, int bodies)
{
  return whole_walks() || body_number == (setting + law) % bodies;
}

/** Bodies, settings and laws of a formulation. @return how many */
static int check_formulation(const FormulationType *type)
{
  const Law *laws = type->components == 1 ? fibre : solid;
  const struct Covered *c = covered;
  int count = 0, asked = 0;
  while (c < covered + sizeof covered / sizeof *covered && strcmp(c->formulation, type->name)) ++c;
  if (c == covered + sizeof covered / sizeof *covered) fail_msg("formulation '%s' has no settings here", type->name);
  const int every = under_sanitizers() ? 7 : 1;
  for (const Setting *s = c->settings; s < c->settings + sizeof c->settings / sizeof *c->settings && s->space; ++s)
    for (int n = 0; n < (type->components == 1 ? (int)FIBRES : (int)SOLIDS); ++n)
      for (int number = 0; number < s->bodies; ++number) {
        char name[256];
        if (type->takes && !type->takes(law_find(NULL, laws[n].name))) continue;
        if (!body_is_sampled((int)(s - c->settings), n, number, s->bodies) || asked++ % every) continue;
        breccia_model *model = body(type->name, &laws[n], s, number);
        snprintf(name, sizeof name, "%s of %s, %s, %s, body %d", laws[n].name, type->name, s->space, s->words, number);
        check_model(model, &laws[n], 0, name);
        breccia_model_destroy(&model);
        ++count;
      }
  return count;
}

static void every_formulation_is_the_sum_of_its_points(void **state)
{
  (void)state;
  for (int k = 0; formulation_at(k); ++k) {
    const int count = check_formulation(formulation_at(k));
    print_message("%s: %d bodies\n", formulation_at(k)->name, count);
    assert_true(count > 0);
  }
}

/** Also a particle on either side of the joint that has lost all bonds but two or three of those that cross it. */
static void bodies_of_several_formulations_are_the_sum_of_all_their_points(void **state)
{
  (void)state;
  char name[256];
  for (size_t k = 0; k < 2 * sizeof couples / sizeof *couples; ++k) {
    const Couple *c = &couples[k / 2];
    if (under_sanitizers() && k / 2 % 5 != 1) continue; /* these five have all formulations */
    if (k % 2 != k / 2 % 2 && !whole_walks()) continue; /* the sides in turn */
    const Law *first = c->of[0].law, *second = c->of[1].law;
    const Law both = {.elastic = first->elastic && second->elastic,
                      .strain = fmin(first->strain, second->strain),
                      .slack = fmax(first->slack, second->slack)};
    const int32_t beside[2][2] = {{90, 120}, {45, 54}}; /* in the one block and in the other */
    breccia_model *model = coupled_body(c);
    snprintf(name, sizeof name, "%s, %s of %s and %s of %s", c->space, first->name, c->of[0].formulation, second->name,
             c->of[1].formulation);
    assert_int_equal(model->domain.region_count, 2);
    check_model(model, &both, beside[*c->space == 'p'][k % 2], name);
    breccia_model_destroy(&model);
  }
}

/** Two elastic materials, bonds of which are in series across their interface, and a third one that flows or none. */
static void bodies_of_two_elastic_materials_are_the_sum_of_their_points(void **state)
{
  (void)state;
  static const struct {
    const char *formulation, *space, *law, *third;
  } of[] = {
      {"bond-based", "plane stress", "elastic-1d", ""},
      {"bond-based, surface correction: energy", "3-D", "elastic-1d", ""},
      {"bond-based", "plane strain", "elastic-1d", "elastic-perfectly-plastic, Young modulus: 70, yield stress: 1"},
      {"ordinary", "plane stress", "elastic, Poisson ratio: 0.2", ""},
      {"ordinary, lattice weights: plain", "3-D", "elastic, Poisson ratio: 0.3", ""},
      {"ordinary", "plane strain", "elastic, Poisson ratio: 0.4",
       "j2, Young modulus: 70, Poisson ratio: 0.3, yield stress: 1"},
  };
  for (size_t k = 0; k < sizeof of / sizeof *of; ++k) {
    const bool plane = *of[k].space == 'p', third = *of[k].third != 0;
    const char *const *blocks = plane ? plane_bodies[0] : space_bodies[0];
    breccia_model *model =
        model_of("materials: {m: {model: %s, density: 1, Young modulus: 150}, n: {model: %s, density: 1, Young "
                 "modulus: 15}%s%s%s}\n"
                 "peridynamics: {space: %s, horizon: 2.5, formulation: %s}\nbody: {a: {material: m, %s}, b: {material: "
                 "n, %s}%s}\n" CUT "solve: {implicit: {end time: 1, stiffness damping: 1e-6}}\n",
                 of[k].law, of[k].law, third ? ", o: {density: 1, model: " : "", of[k].third, third ? "}" : "",
                 of[k].space, of[k].formulation, blocks[0], blocks[1],
                 third ? ", c: {material: o, spacing: 1, lattice: square, thickness: 0.7, shape: {box: {from: [9, 0], "
                         "to: [12, 6]}}}"
                       : "");
    const Law law = {.elastic = !third, .strain = third ? 0.01 : 0.03, .slack = third ? 1e-5 : 1e-7};
    check_model(model, &law, 0, of[k].formulation);
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_of_two_elastic_materials_are_the_sum_of_their_points),
      cmocka_unit_test(every_formulation_is_the_sum_of_its_points),
      cmocka_unit_test(bodies_of_several_formulations_are_the_sum_of_all_their_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

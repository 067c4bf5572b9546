/* Forces of bonds that stand in no lattice, as the sweeps find them, beside sums of their closed forms bond by bond in long double: at rest, turned, and
 * with stretches of each way to g(d) (formulation/stretch.h), with all bonds and with some broken. */
#include "support.h"

#include "base/random.h"
#include "formulation/bond_based.h"
#include "formulation/ordinary.h"
#include <math.h>

#define FILE_NAME "test_scattered_bonds.csv"
enum { N = 7 };

/** A cube of particles that are moved by up to a third of the spacing of 0.1 m, with volumes that differ. */
static void write_scattered(void)
{
  FILE *file = fopen(FILE_NAME, "w");
  assert_non_null(file);
  uint64_t seed = 1;
  fprintf(file, "x,y,z,volume\n");
  for (int i = 0; i < N * N * N; ++i) {
    const double grow = 0.9 + 0.2 * random_uniform(&seed);
    const int at[3] = {i % N, i / N % N, i / N / N};
    for (int k = 0; k < 3; ++k) fprintf(file, "%.17g,", 0.1 * (at[k] + (random_uniform(&seed) - 0.5) / 1.5));
    fprintf(file, "%.17g\n", 1e-3 * grow);
  }
  fclose(file);
}

static const struct {
  const char *law, *peridynamics;
} cases[] = {{"model: elastic-1d, Young modulus: 150 MPa", "formulation: bond-based, calibration: continuum"},
             {"model: elastic-1d, Young modulus: 150 MPa",
              "formulation: bond-based, calibration: continuum, influence: conical, volume correction: partial"},
             {"model: elastic-perfectly-plastic, Young modulus: 150 MPa, yield stress: 1e5 MPa",
              "formulation: bond-based, calibration: continuum"},
             {"model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.3", "formulation: ordinary"},
             {"model: elastic, Young modulus: 150 MPa, Poisson ratio: 0.3",
              "formulation: ordinary, influence: conical, volume correction: partial"}};
enum { CASES = sizeof cases / sizeof *cases };

static breccia_model *scattered(int k)
{
  write_scattered();
  breccia_model *model =
      model_of("units: {length: m, force: kN, time: s}\nmaterials: {m: {density: 1.5, %s}}\nperidynamics: {%s}\n"
               "body: {b: {material: m, spacing: 0.1, file: %s}}\nsolve: {explicit: {steps: 1}}\n",
               cases[k].law, cases[k].peridynamics, FILE_NAME);
  remove(FILE_NAME);
  return model;
}

static bool is_ordinary(const breccia_model *model)
{
  return !strcmp(model->domain.regions[0].type->name, "ordinary");
}

/** A bond in long double. */
typedef struct Exact {
  int32_t neighbour;
  long double y[3], length, now, elongation, weight;
} Exact;

/** @param[in] o  whose factors count, or NULL */
static Exact exact_bond(const Domain *d, const Ordinary *o, int64_t slice, int64_t slot, int lane)
{
  const Particles *p = d->particles;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(&d->family, slice, slot, lane);
  const double weight = o ? ordinary_bond(o, slice, slot, lane).weight : bond.weight;
  Exact e = {.neighbour = bond.neighbour, .weight = (long double)weight};
  long double along = 0;
  for (int k = 0; k < 3; ++k) {
    const long double xi = (long double)p->position[k][bond.neighbour] - (long double)p->position[k][place],
                      eta = (long double)p->displacement.row[k][bond.neighbour] -
                            (long double)p->displacement.row[k][place];
    e.y[k] = xi + eta;
    e.length += xi * xi;
    e.now += e.y[k] * e.y[k];
    along += eta * (xi + e.y[k]);
  }
  e.length = sqrtl(e.length);
  e.now = sqrtl(e.now);
  e.elongation = along / (e.length + e.now);
  return e;
}

static long double exact_dilatation(const Domain *d, const Ordinary *o, int64_t place)
{
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  long double sum = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Exact e = exact_bond(d, o, slice, slot, lane);
    sum += e.weight * e.length * e.elongation;
  }
  return (long double)o->inverse[place] * sum;
}

/** Force on a particle per volume, and what it is a sum of: the largest pull that there can be of all its bonds with the strain `size`. */
static void exact_force(const breccia_model *model, const long double *dilatation, int64_t place, double size,
                        long double force[3], double *whole)
{
  const Domain *d = &model->domain;
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const void *formulation = d->regions[0].formulation;
  const Ordinary *o = is_ordinary(model) ? formulation : NULL;
  const double c = o ? 0 : ((const BondBased *)formulation)->stiffness[0];
  *whole = 0;
  for (int k = 0; k < 3; ++k) force[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Exact e = exact_bond(d, o, slice, slot, lane);
    long double tension = (long double)c * e.elongation / e.length, most = (long double)c;
    if (o) {
      const int64_t j = e.neighbour;
      const long double a = (long double)o->volumetric[place] * dilatation[place] +
                            (long double)o->volumetric[j] * dilatation[j],
                        b = (long double)o->shear[place] + (long double)o->shear[j];
      tension = a * e.length + b * e.elongation;
      most = (3 * fabsl((long double)o->volumetric[place] + (long double)o->volumetric[j]) + b) * e.length;
    }
    *whole += size * (double)(e.weight * most);
    for (int k = 0; k < 3; ++k) force[k] += e.weight * tension * e.y[k] / e.now;
  }
}

/** Fails unless forces are those of the closed forms but for so much of what they are sums of. */
static void check_forces(breccia_model *model, const char *what, double size, double tolerance)
{
  const Domain *d = &model->domain;
  const Particles *p = d->particles;
  long double *dilatation = calloc((size_t)p->places, sizeof *dilatation);
  compute_forces(model);
  for (int64_t place = 0; place < p->places && is_ordinary(model); ++place)
    if (p->number[place] >= 0) dilatation[place] = exact_dilatation(d, d->regions[0].formulation, place);
  double worst = 0;
  for (int32_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    long double force[3];
    double whole;
    exact_force(model, dilatation, place, size, force, &whole);
    for (int k = 0; k < 3; ++k)
      worst = larger_of(worst, (double)fabsl((long double)p->internal.row[k][place] - force[k]) / whole);
  }
  free(dilatation);
  if (!(worst <= tolerance)) fail_msg("%s: forces differ by %g of what they are sums of", what, worst);
}

static void break_some(breccia_model *model)
{
  Domain *d = &model->domain;
  const Region *region = &d->regions[0];
  int broken = 0;
  for (int32_t n = 0; n + 1 < d->particles->count; n += 3) {
    const int32_t a = d->particles->place_of[n], b = d->particles->place_of[n + 1];
    if (!family_break(&d->family, a, b)) continue;
    ++broken;
    region->type->renew(region->formulation, a / SLICE);
    region->type->renew(region->formulation, b / SLICE);
  }
  assert_true(broken > 50);
}

/** By up to half of a length along each axis, always in the same way. */
static void displace(breccia_model *model, double by)
{
  const Particles *p = model->domain.particles;
  uint64_t seed = 5;
  for (int32_t n = 0; n < p->count; ++n)
    for (int k = 0; k < 3; ++k) p->displacement.row[k][p->place_of[n]] = by * (random_uniform(&seed) - 0.5);
}

/** Displacements are numbers of their own, differences of which have no more error than they: forces have all digits of the stretches. */
static void forces_are_those_of_closed_forms(void **state)
{
  (void)state;
  static const double by[] = {1e-9, 1e-5, 1e-3, 2e-2}; /* two by the series, by Newton's steps, by roots */
  for (int k = 0; k < CASES; ++k) {
    breccia_model *model = scattered(k);
    for (int broken = 0; broken < 2; ++broken) {
      if (broken) break_some(model);
      for (size_t n = 0; n < sizeof by / sizeof *by; ++n) {
        displace(model, by[n]);
        check_forces(model, cases[k].peridynamics, by[n] / 0.1, 4e-15);
      }
    }
    breccia_model_destroy(&model);
  }
}

static void bodies_at_rest_have_no_forces_at_all(void **state)
{
  (void)state;
  for (int k = 0; k < CASES; ++k) {
    breccia_model *model = scattered(k);
    const Particles *p = model->domain.particles;
    for (int broken = 0; broken < 2; ++broken) {
      if (broken) break_some(model);
      for (int moved = 0; moved < 2; ++moved) {
        deform_uniformly(model, (double[]){1, 0, 0, 0, 1, 0, 0, 0, 1});
        for (int64_t place = 0; place < p->places && moved; ++place) p->displacement.row[1][place] += 0.3;
        compute_forces(model);
        for (int64_t place = 0; place < p->places; ++place)
          for (int c = 0; c < 3; ++c) assert_true(p->internal.row[c][place] == 0);
      }
    }
    breccia_model_destroy(&model);
  }
}

/** What is left are roundings of displacements, which are as large as the body. */
static void turned_bodies_have_no_forces(void **state)
{
  (void)state;
  const double a = 0.7, f[9] = {cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1};
  for (int k = 0; k < CASES; ++k) {
    breccia_model *model = scattered(k);
    deform_uniformly(model, f);
    check_forces(model, cases[k].peridynamics, 1, 1e-15);
    const Particles *p = model->domain.particles;
    for (int32_t n = 0; n < p->count; ++n) {
      long double force[3], *none = calloc((size_t)p->places, sizeof *none);
      double whole;
      exact_force(model, none, p->place_of[n], 1, force, &whole);
      for (int c = 0; c < 3; ++c) assert_near(p->internal.row[c][p->place_of[n]], 0, 4e-15 * whole);
      free(none);
    }
    breccia_model_destroy(&model);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(forces_are_those_of_closed_forms),
                                     cmocka_unit_test(bodies_at_rest_have_no_forces_at_all),
                                     cmocka_unit_test(turned_bodies_have_no_forces)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

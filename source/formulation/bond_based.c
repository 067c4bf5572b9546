/* Bond-based peridynamics (Silling 2000; docs/theory.md 2): every bond is a fibre with a uniaxial law of its own.
 *
 * With y = xi + eta and the stretch s = (|y| - |xi|) / |xi|, the force on a particle per volume is sum c w s y / |y|, where
 * w = omega beta V_j and c follows from Young's modulus. As s / |y| = (1 - |xi| / |y|) / |xi|, and |y|^2 = |xi|^2 (1 + d) with
 * d = eta . (xi + y) / |xi|^2, a bond needs g(d) = 1 - (1 + d)^-1/2 only; d has no cancellation however small the stretch. */
#include "base/tensor.h"
#include "family/slots.h"
#include "formulation/formulation.h"
#include "formulation/shape_tensor.h"

#include <stdlib.h>
#include <string.h>

typedef struct BondBased {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  Space space;
  const Influence *influence;
  double *stiffness; /* c of each place's material and lattice; a bond has the mean of its two. NULL: all alike */
  double uniform;    /* c, if all are alike */
} BondBased;

static double thickness(const BondBased *b)
{
  return b->body->plane ? b->body->blocks[0]->thickness : 1;
}

/** Integral of omega(q) q^power over 0 <= q <= 1 by Simpson's rule. */
static double influence_moment(const BondBased *b, int power)
{
  enum { INTERVALS = 2000 };
  double sum = 0;
  for (int k = 1; k <= INTERVALS; ++k) { /* q = 0 adds nothing */
    double q = (double)k / INTERVALS, value = b->influence->value(q, q * b->family->horizon) * pow(q, power);
    sum += value * (k == INTERVALS ? 1 : k % 2 ? 4 : 2);
  }
  return sum / (3.0 * INTERVALS);
}

/** c by the continuum's integrals (docs/theory.md 2, table and general rule). */
static double continuum_constant(const BondBased *b, double young)
{
  const double pi = acos(-1), horizon = b->family->horizon;
  if (b->space == SPACE_3D) return 12 * young / (pi * pow(horizon, 4)) * (1.0 / 4) / influence_moment(b, 3);
  double constant = b->space == SPACE_PLANE_STRESS ? 9.0 : 48.0 / 5;
  return constant * young / (pi * thickness(b) * pow(horizon, 3)) * (1.0 / 3) / influence_moment(b, 2);
}

/* Symmetric tensors of rank four as matrices in Mandel's components, so that inverse and product keep their meaning. */
enum { MANDEL = 6 };

static void mandel_of(const double n[3], double m[MANDEL])
{
  for (int k = 0; k < MANDEL; ++k) m[k] = n[symmetric_row[k]] * n[symmetric_column[k]] * (k < 3 ? 1 : sqrt(2));
}

/** Stiffness of the infinite lattice of a block for c = 1: half the sum of w L n n n n. */
static void lattice_stiffness(const BondBased *b, int block, double c[MANDEL][MANDEL])
{
  memset(c, 0, sizeof(double) * MANDEL * MANDEL);
  for (int k = b->family->pattern_begin[block]; k < b->family->pattern_begin[block + 1]; ++k) {
    const Pattern *p = &b->family->patterns[k];
    double n[3] = {p->xi[0] / p->length, p->xi[1] / p->length, p->xi[2] / p->length}, m[MANDEL];
    mandel_of(n, m);
    for (int i = 0; i < MANDEL; ++i)
      for (int j = 0; j < MANDEL; ++j) c[i][j] += 0.5 * p->weight * p->length * m[i] * m[j];
  }
}

/** Young's modulus that the infinite lattice of a block shows along a direction for c = 1: 1 / (m . C^-1 m).
 *  @return NaN if it resists no strain there */
static double lattice_young(const BondBased *b, int block, const double n[3])
{
  double c[MANDEL][MANDEL], m[MANDEL], x[MANDEL];
  lattice_stiffness(b, block, c);
  mandel_of(n, m);
  memcpy(x, m, sizeof x);
  for (int k = 0; k < MANDEL; ++k)
    if (b->body->plane && symmetric_row[k] != symmetric_column[k] ? k != XY : b->body->plane && k == ZZ)
      c[k][k] = 1; /* the plane's network has nothing to say here */
  for (int k = 0; k < MANDEL; ++k) {
    if (!(c[k][k] > 1e-12 * c[XX][XX])) return NAN;
    for (int i = k + 1; i < MANDEL; ++i) {
      double factor = c[i][k] / c[k][k];
      for (int j = k; j < MANDEL; ++j) c[i][j] -= factor * c[k][j];
      x[i] -= factor * x[k];
    }
  }
  double compliance = 0;
  for (int k = MANDEL - 1; k >= 0; --k) {
    for (int j = k + 1; j < MANDEL; ++j) x[k] -= c[k][j] * x[j];
    x[k] /= c[k][k];
    compliance += m[k] * x[k];
  }
  return 1 / compliance;
}

/** Modulus of the continuum in uniaxial stress within the body's space, as a multiple of Young's: nu = 1/4 in plane strain. */
static double continuum_young(const BondBased *b)
{
  return b->space == SPACE_PLANE_STRAIN ? 16.0 / 15 : 1;
}

/** Factor on the continuum's c for the lattice of a block. */
static double calibration_factor(const BondBased *b, int block, Calibration calibration)
{
  if (calibration == CALIBRATION_CONTINUUM) return 1;
  double unit = continuum_constant(b, 1);
  if (calibration == CALIBRATION_UNIAXIAL) {
    const double along[3] = {1, 0, 0};
    return continuum_young(b) / (unit * lattice_young(b, block, along));
  }
  double c[MANDEL][MANDEL], sum = 0;
  lattice_stiffness(b, block, c);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += c[i][j];
  /* Uniform expansion by s has the energy sum s^2 / 2: 6 E s^2 / 2 in space, 3 E and 3.2 E in the plane. */
  double continuum = b->space == SPACE_3D ? 6 : b->space == SPACE_PLANE_STRESS ? 3 : 3.2;
  return continuum / (unit * sum);
}

static void destroy(void *formulation)
{
  BondBased *b = formulation;
  if (!b) return;
  places_free(&b->stiffness);
  free(b);
}

static void *create(const FormulationParts *parts, Error *error)
{
  BondBased *b = calloc(1, sizeof *b);
  if (!b) {
    error_add(error, BRECCIA_FAILURE, "out of memory: bond-based");
    return NULL;
  }
  *b = (BondBased){.particles = parts->particles,
                   .family = parts->family,
                   .body = parts->body,
                   .points = parts->points,
                   .space = peridynamics_space(parts->spec),
                   .influence = influence_find(parts->spec->influence)};
  int calibration = 0;
  while (strcmp(calibration_word(calibration), parts->spec->calibration)) ++calibration;
  if (!(b->stiffness = places_array(b->particles->places, "bond constants", error))) {
    destroy(b);
    return NULL;
  }
  bool alike = true;
  for (int block = 0; block < b->body->block_count; ++block) {
    double factor = calibration_factor(b, block, (Calibration)calibration) * continuum_constant(b, 1);
    if (!(factor > 0) || !isfinite(factor)) {
      error_add(
          error, BRECCIA_USER_ERROR,
          "block '%s': the bonds within the horizon of %g do not resist every strain, so that there is no stiffness to "
          "calibrate; give a longer horizon, or 'calibration: continuum'",
          b->body->blocks[block]->head.name, b->family->horizon);
      destroy(b);
      return NULL;
    }
    for (int64_t slice = 0; slice < b->particles->slices; ++slice)
      for (int lane = 0; b->particles->block[slice] == block && lane < SLICE; ++lane)
        b->stiffness[slice * SLICE + lane] = factor * material_young(&b->points->materials[b->points->material[slice]]);
  }
  for (int64_t i = 1; i < b->particles->places; ++i) alike &= b->stiffness[i] == b->stiffness[0];
  b->uniform = b->stiffness[0];
  if (alike) places_free(&b->stiffness);
  return b;
}

/* ---- the sweep over bonds ---- */

/* Ways to g(d) = 1 - (1 + d)^-1/2, each good to double precision relative to g and each cheaper than the next: its series, for stretches
 * up to 0.2 %; a reciprocal root by Newton's steps from a short series, for stretches from -13 to 11 %; root and quotients. */
typedef enum Range { RANGE_SERIES, RANGE_NEWTON, RANGE_ANY } Range;
static const double range_limit[] = {0.00390625, 0.25}; /* largest |d| */

LANES_INLINE Lanes shortening(Lanes d, Range range)
{
  if (range == RANGE_SERIES) {
    Lanes series = lanes_set(429.0 / 2048);
    series = lanes_set(-231.0 / 1024) + d * series;
    series = lanes_set(63.0 / 256) + d * series;
    series = lanes_set(-35.0 / 128) + d * series;
    series = lanes_set(5.0 / 16) + d * series;
    series = lanes_set(-3.0 / 8) + d * series;
    return d * (lanes_set(0.5) + d * series);
  }
  if (range == RANGE_NEWTON) {
    Lanes r = lanes_set(35.0 / 128), x = lanes_set(0.5) + lanes_set(0.5) * d;
    r = lanes_set(-5.0 / 16) + d * r;
    r = lanes_set(3.0 / 8) + d * r;
    r = lanes_set(-0.5) + d * r;
    r = lanes_set(1) + d * r;
    for (int step = 0; step < 3; ++step) r *= lanes_set(1.5) - x * (r * r);
    Lanes g = lanes_set(1) - r; /* has lost digits where d is small; (1 - g)^2 (1 + d) = 1 gives them back */
    return lanes_set(0.5) * (d * (r * r) + g * g);
  }
  Lanes r = lanes_set(1) / lanes_root(lanes_set(1) + d);
  return d * r * r / (lanes_set(1) + r);
}

/** Adds one slot to the forces of half a slice. @return lanes in which d was beyond the range */
LANES_INLINE LaneMask add_slot(const BondBased *b, int64_t slot, int64_t slice, int half, bool lattice, bool alike,
                               Range range, const Lanes own[3], Lanes force[3])
{
  const Family *f = b->family;
  const Particles *p = b->particles;
  LaneMask intact = half_mask(f->intact[slot], half);
  Slot s = slot_open(f, slot, lattice);
  Lanes xi[3], d = {0}, y[3], factor, square;
  if (lattice) {
    const Pattern *pattern = &f->patterns[f->pattern[slot]];
    for (int k = 0; k < 3; ++k) xi[k] = lanes_set(pattern->xi[k]);
    factor = lanes_set(pattern->weight_by_length);
    square = lanes_set(pattern->by_square);
  } else {
    slot_reference(&s, p, slice, half, xi);
    Lanes length = xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2];
    length = lanes_where(intact, length) + lanes_where(~intact, lanes_set(1)); /* empty lanes have no length */
    square = lanes_set(1) / length;
    factor = lanes_load(f->weight + s.at + LANES * half) / lanes_root(length);
  }
  for (int k = 0; k < 3; ++k) {
    Lanes eta = slot_read(&s, half, p->displacement[k]) - own[k];
    y[k] = xi[k] + eta;
    d += eta * (xi[k] + y[k]);
  }
  d = lanes_where(intact, d) * square;
  if (!alike)
    factor *=
        lanes_set(0.5) * (slot_read(&s, half, b->stiffness) + lanes_load(b->stiffness + slice * SLICE + LANES * half));
  Lanes pull = factor * shortening(d, range);
  for (int k = 0; k < 3; ++k) force[k] += pull * y[k];
  return range == RANGE_ANY ? (LaneMask){0} : (LaneMask)(lanes_absolute(d) > lanes_set(range_limit[range]));
}

/** Forces of half a slice. @return false if a stretch was beyond the range */
LANES_INLINE bool resist_half(const BondBased *b, int64_t slice, int half, bool alike, Range range)
{
  const Family *f = b->family;
  const int64_t place = slice * SLICE + LANES * half, stored = f->stored[slice], last = f->first[slice + 1];
  Lanes force[3] = {{0}}, own[3];
  LaneMask beyond = {0};
  for (int k = 0; k < 3; ++k) own[k] = lanes_load(b->particles->displacement[k] + place);
  for (int64_t slot = f->first[slice]; slot < stored; ++slot)
    beyond |= add_slot(b, slot, slice, half, true, alike, range, own, force);
  for (int64_t slot = stored; slot < last; ++slot)
    beyond |= add_slot(b, slot, slice, half, false, alike, range, own, force);
  if (range != RANGE_ANY && (beyond[0] | beyond[1] | beyond[2] | beyond[3])) return false;
  Lanes scale = lanes_set(alike ? b->uniform : 1);
  for (int k = 0; k < 3; ++k) lanes_store(b->particles->internal[k] + place, force[k] * scale);
  return true;
}

BRECCIA_CLONES
static void resist(void *formulation, int64_t first, int64_t last)
{
  const BondBased local = *(const BondBased *)formulation, *b = &local; /* so that stores are seen not to change it */
  for (int64_t slice = first; slice < last; ++slice)
    for (int half = 0; half < SLICE / LANES; ++half)
      if (b->stiffness)
        (void)(resist_half(b, slice, half, false, RANGE_SERIES) || resist_half(b, slice, half, false, RANGE_NEWTON) ||
               resist_half(b, slice, half, false, RANGE_ANY));
      else
        (void)(resist_half(b, slice, half, true, RANGE_SERIES) || resist_half(b, slice, half, true, RANGE_NEWTON) ||
               resist_half(b, slice, half, true, RANGE_ANY));
}

/* ---- single bonds and places ---- */

/** c s / |y| of a bond, and y. */
static inline double bond_pull(const BondBased *b, int64_t place, const Bond *bond, double y[3])
{
  double d = 0, c = b->stiffness ? (b->stiffness[place] + b->stiffness[bond->neighbour]) / 2 : b->uniform;
  for (int k = 0; k < 3; ++k) {
    double eta = b->particles->displacement[k][bond->neighbour] - b->particles->displacement[k][place];
    y[k] = bond->xi[k] + eta;
    d += eta * (bond->xi[k] + y[k]);
  }
  d /= bond->length * bond->length;
  double r = 1 / sqrt(1 + d);
  return c * d * r * r / ((1 + r) * bond->length);
}

static void bond_force(const void *formulation, int64_t slice, int64_t slot, int lane, double force[3])
{
  const BondBased *b = formulation;
  Bond bond = family_bond(b->family, slice, slot, lane);
  double y[3], pull = bond_pull(b, slice * SLICE + lane, &bond, y);
  for (int k = 0; k < 3; ++k) force[k] = pull * bond.weight / b->particles->volume[bond.neighbour] * y[k];
}

static void gradient(const void *formulation, int64_t place, double f[9])
{
  const BondBased *b = formulation;
  ShapeTensor shape = shape_tensor(b->family, (int32_t)place, b->body->plane, 0);
  shape_gradient(b->family, (int32_t)place, shape.inverse, f);
}

/** Half of the sum of force (x) y over the bonds. */
static void stress(const void *formulation, int64_t place, double s[6])
{
  const BondBased *b = formulation;
  const Family *f = b->family;
  int64_t slice = place / SLICE;
  int lane = (int)(place % SLICE);
  for (int k = 0; k < 6; ++k) s[k] = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    Bond bond = family_bond(f, slice, slot, lane);
    double y[3], pull = bond_pull(b, place, &bond, y) * 0.5 * bond.weight;
    for (int k = 0; k < 6; ++k) s[k] += pull * y[symmetric_row[k]] * y[symmetric_column[k]];
  }
}

static double critical_stretch(const void *formulation, double fracture_energy)
{
  const BondBased *b = formulation;
  const double pi = acos(-1), horizon = b->family->horizon;
  double young = NAN;
  for (int64_t slice = 0; slice < b->particles->slices; ++slice) {
    double here = material_young(&b->points->materials[b->points->material[slice]]);
    if (slice && here != young) return NAN;
    young = here;
  }
  double c = continuum_constant(b, young);
  if (b->space == SPACE_3D) return sqrt(fracture_energy / (pi / 2 * c * pow(horizon, 5) * influence_moment(b, 4)));
  return sqrt(fracture_energy / (c * thickness(b) * pow(horizon, 4) * influence_moment(b, 3)));
}

static void describe(const void *formulation, Text *text)
{
  const BondBased *b = formulation;
  const double axis[3] = {1, 0, 0}, plane[3] = {sqrt(0.5), sqrt(0.5), 0},
               space[3] = {sqrt(1. / 3), sqrt(1. / 3), sqrt(1. / 3)};
  for (int block = 0; block < b->body->block_count; ++block) {
    int64_t slice = 0;
    while (b->particles->block[slice] != block) ++slice;
    const Material *m = &b->points->materials[b->points->material[slice]];
    double c = b->stiffness ? b->stiffness[slice * SLICE] : b->uniform;
    double wanted = material_young(m) * continuum_young(b);
    if (isnan(lattice_young(b, block, axis))) {
      text_add(text, "%s: the bonds within the horizon resist no shear; give a longer one\n",
               b->body->blocks[block]->head.name);
      continue;
    }
    text_add(text,
             "%s: a uniaxial patch shows %.3f of the wanted modulus along the axes, %.3f along the diagonals of the %s",
             b->body->blocks[block]->head.name, c * lattice_young(b, block, axis) / wanted,
             c * lattice_young(b, block, plane) / wanted, b->body->plane ? "plane" : "faces");
    if (!b->body->plane) text_add(text, ", %.3f along those of space", c * lattice_young(b, block, space) / wanted);
    text_add(text, "\n");
  }
}

static size_t bytes(const void *formulation)
{
  const BondBased *b = formulation;
  return b->stiffness ? (size_t)b->particles->places * sizeof(double) : 0;
}

const FormulationType formulation_bond_based = {
    .name = "bond-based",
    .about = "every bond is a fibre with a uniaxial law of its own; Poisson's ratio is 1/4 (1/3 in plane stress)",
    .source = "Silling 2000; Silling and Askari 2005",
    .maturity = "verified against closed forms on lattices",
    .uniaxial = 1,
    .create = create,
    .destroy = destroy,
    .resist = resist,
    .bond_force = bond_force,
    .gradient = gradient,
    .stress = stress,
    .critical_stretch = critical_stretch,
    .describe = describe,
    .bytes = bytes,
};

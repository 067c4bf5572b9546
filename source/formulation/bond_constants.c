#include "base/tensor.h"
#include "formulation/body_modulus.h"
#include "formulation/bond_based.h"
#include "formulation/interface.h"
#include "formulation/whole_family.h"

#include <string.h>

/** Integral of omega(q) q^power over 0 <= q <= 1 by Simpson's rule. */
static double influence_moment(const BondLength *of, int power)
{
  enum { INTERVALS = 2000 };
  double sum = 0;
  for (int k = 1; k <= INTERVALS; ++k) { /* q = 0 adds nothing */
    double q = (double)k / INTERVALS, value = of->influence->value(q, q * of->horizon) * pow(q, power);
    sum += value * (k == INTERVALS ? 1 : k % 2 ? 4 : 2);
  }
  return sum / (3.0 * INTERVALS);
}

/** c by the continuum's integrals, of a body of that thickness in the plane. */
static double continuum_constant(const BondLength *of, double young, double thick)
{
  const double pi = acos(-1);
  if (of->space == SPACE_3D) return 12 * young / (pi * pow(of->horizon, 4)) * (1.0 / 4) / influence_moment(of, 3);
  if (of->space == SPACE_BAR) return 2 * young / (thick * pow(of->horizon, 2)) * (1.0 / 2) / influence_moment(of, 1);
  double constant = of->space == SPACE_PLANE_STRESS ? 9.0 : 48.0 / 5;
  return constant * young / (pi * thick * pow(of->horizon, 3)) * (1.0 / 3) / influence_moment(of, 2);
}

double bond_continuum_constant(const BondBased *b, double young)
{
  return continuum_constant(&(BondLength){.space = b->space, .influence = b->influence, .horizon = b->family->horizon},
                            young, body_section(b->body));
}

/* Symmetric tensors of rank four as matrices in Mandel's components, so that inverse and product keep their meaning. */
enum { MANDEL = 6 };

static void mandel_of(const double n[3], double m[MANDEL])
{
  for (int k = 0; k < MANDEL; ++k) m[k] = n[symmetric_row[k]] * n[symmetric_column[k]] * (k < 3 ? 1 : sqrt(2));
}

/** Adds half of w L n n n n. */
static void add_bond(const double xi[3], double length, double weight, double c[MANDEL][MANDEL])
{
  const double n[3] = {xi[0] / length, xi[1] / length, xi[2] / length};
  double m[MANDEL];
  mandel_of(n, m);
  for (int i = 0; i < MANDEL; ++i)
    for (int j = 0; j < MANDEL; ++j) c[i][j] += 0.5 * weight * length * m[i] * m[j];
}

/** Mean over the families of particles from a file that are whole, so that surfaces do not count. NaN if there is
 *  none. */
static void cloud_stiffness(const BondBased *b, int block, double c[MANDEL][MANDEL])
{
  const Family *f = b->family;
  const double least = whole_family_volume(b->body, f, block, LEAST_FILLED);
  double volume = 0;
  for (int64_t place = 0; place < b->particles->places; ++place) {
    const int64_t slice = place / SLICE;
    const double own = b->particles->volume[place];
    if (!whole_family_at(f, block, place, least)) continue;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, (int)(place % SLICE));
      add_bond(bond.xi, bond.length, own * bond.weight, c);
    }
    volume += own;
  }
  for (int i = 0; i < MANDEL; ++i)
    for (int j = 0; j < MANDEL; ++j) c[i][j] /= volume;
}

/** Stiffness of the infinite lattice of a block for c = 1, half the sum of w L n n n n; of particles from a file the
 *  mean of those inside. */
static void inner_stiffness(const BondBased *b, int block, double c[MANDEL][MANDEL])
{
  memset(c, 0, sizeof(double) * MANDEL * MANDEL);
  for (int k = b->family->pattern_begin[block]; k < b->family->pattern_begin[block + 1]; ++k) {
    const Pattern *p = &b->family->patterns[k];
    add_bond(p->xi, p->length, p->weight, c);
  }
  if (!b->body->lattices[block].chunks) cloud_stiffness(b, block, c);
}

/** Young's modulus that a stiffness shows along a direction: 1 / (m . C^-1 m).
 *  @return NaN if it resists no strain there */
static double young_along(double stiffness[MANDEL][MANDEL], int dimensions, const double n[3])
{
  double c[MANDEL][MANDEL], m[MANDEL], x[MANDEL];
  memcpy(c, stiffness, sizeof c);
  mandel_of(n, m);
  memcpy(x, m, sizeof x);
  for (int k = 0; k < MANDEL; ++k)
    if (symmetric_row[k] >= dimensions || symmetric_column[k] >= dimensions)
      c[k][k] = 1; /* the network of a plane or a bar has nothing to say here */
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

/** The same of the inside of a block for c = 1. */
static double inner_young(const BondBased *b, int block, const double n[3])
{
  double c[MANDEL][MANDEL];
  inner_stiffness(b, block, c);
  return young_along(c, b->body->dimensions, n);
}

/** Modulus of the continuum in uniaxial stress within the body's space, as a multiple of Young's: nu = 1/4 in plane
 *  strain. */
static double continuum_young(const BondBased *b)
{
  return b->space == SPACE_PLANE_STRAIN ? 16.0 / 15 : 1;
}

double bond_calibration(const BondBased *b, int block, Calibration calibration)
{
  if (calibration == CALIBRATION_CONTINUUM) return 1;
  double unit = bond_continuum_constant(b, 1), c[MANDEL][MANDEL], sum = 0;
  inner_stiffness(b, block, c);
  if (calibration == CALIBRATION_UNIAXIAL) {
    const double along[3] = {1, 0, 0};
    return continuum_young(b) / (unit * young_along(c, b->body->dimensions, along));
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += c[i][j];
  /* Uniform expansion by s has the energy sum s^2 / 2: 6 E s^2 / 2 in space, 3 E and 3.2 E in the plane, E in a bar. */
  double continuum = b->space == SPACE_3D ? 6 : b->space == SPACE_PLANE_STRESS ? 3 : b->space == SPACE_BAR ? 1 : 3.2;
  return continuum / (unit * sum);
}

double bond_characteristic_length(const BondLength *of)
{
  const double pi = acos(-1);
  double c = continuum_constant(of, 1, 1);
  if (of->space == SPACE_BAR) return c * pow(of->horizon, 3) * influence_moment(of, 2);
  return of->space == SPACE_3D ? pi * c * pow(of->horizon, 5) * influence_moment(of, 4)
                               : 2 * c * pow(of->horizon, 4) * influence_moment(of, 3);
}

double bond_critical_stretch(const BondLength *of, const Material *material, double energy)
{
  return sqrt(2 * energy / (material_young(material) * bond_characteristic_length(of)));
}

/** G(n) of docs/theory.md 4 with bonds of the energy c w L s^2 / 2. */
double bond_crack_length(const void *formulation, int block, const double normal[3])
{
  const BondBased *b = formulation;
  if (!b->body->lattices[block].chunks || block_is_foreign(b->foreign, b->particles, block)) return NAN;
  double sum = 0;
  for (int k = b->family->pattern_begin[block]; k < b->family->pattern_begin[block + 1]; ++k) {
    const Pattern *p = &b->family->patterns[k];
    const double along = p->xi[0] * normal[0] + p->xi[1] * normal[1] + p->xi[2] * normal[2];
    sum += fabs(along) / 2 * p->weight * p->length;
  }
  return b->stiffness[block] * sum / material_young(bond_material(b, block));
}

double bond_shown_young(const void *formulation, int block, int axis)
{
  const BondBased *b = formulation;
  const double along[3] = {axis == 0, axis == 1, axis == 2};
  if (block_is_foreign(b->foreign, b->particles, block)) return NAN;
  return b->stiffness[block] * inner_young(b, block, along) /
         (material_young(bond_material(b, block)) * continuum_young(b));
}

/** Says which moduli bonds show whose axes are not alike: along each, and the least and largest over all directions. */
static void describe_directions(const BondBased *b, int block, double c[MANDEL][MANDEL], double unit, Text *text)
{
  enum { ANGLES = 90 };
  const double step = acos(-1) / ANGLES;
  const int dimensions = b->body->dimensions;
  double least = INFINITY, largest = 0;
  for (int azimuth = 0; azimuth < ANGLES; ++azimuth)
    for (int height = 0; height <= (dimensions == 3 ? ANGLES / 2 : 0); ++height) {
      const double round = azimuth * step, up = height * step;
      const double n[3] = {cos(round) * cos(up), sin(round) * cos(up), sin(up)}, young = young_along(c, dimensions, n);
      least = fmin(least, young);
      largest = fmax(largest, young);
    }
  text_add(text, "%s: a uniaxial patch%s shows ", b->body->blocks[block]->head.name,
           b->body->lattices[block].chunks ? "" : " inside, away from its surfaces,");
  for (int k = 0; k < dimensions; ++k) {
    const double n[3] = {k == 0, k == 1, k == 2};
    text_add(text, k ? ", %.3f along %c" : "%.3f of the wanted modulus along %c", unit * young_along(c, dimensions, n),
             "xyz"[k]);
  }
  text_add(text, "; %.3f to %.3f in all directions\n", unit * least, unit * largest);
}

/** Returns the stiffness with which the family of a place counts a bond: that of the material of the place, or, through
 *  two linear materials, that of both pieces in series. */
static double body_bond_stiffness(const BondBased *b, int64_t slice, int64_t slot, int lane, const Bond *bond)
{
  const int own = b->particles->block[slice], other = b->particles->block[bond->neighbour / SLICE];
  const bool joined = b->in_series && interfaces_join(bond_material(b, own), bond_material(b, other));
  return bond_factor(b, slice, slot, lane) *
         (joined ? (b->stiffness[own] + b->stiffness[other]) / 2 : b->stiffness[own]);
}

/** Returns w L s^2 / 2 of a bond in a uniform strain of 1 along an axis and of -across along the others, without w. */
static double bond_in_tension(const double xi[3], double length, int axis, double across)
{
  const double n = xi[axis] / length, stretch = (1 + across) * n * n - across;
  return length / 2 * stretch * stretch;
}

/** Returns twice the energy per volume of a family in uniform tension. */
static double family_in_tension(const BondBased *b, int64_t place, int axis, double across)
{
  const Family *f = b->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double sum = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    sum += body_bond_stiffness(b, slice, slot, lane, &bond) * bond.weight *
           bond_in_tension(bond.xi, bond.length, axis, across);
  }
  return sum;
}

/** Returns the modulus that all families of a block show in uniform tension along an axis, over that of the deck. Bodies
 *  of bonds contract across by a quarter in space and by a third in the plane. */
static double body_young(const void *formulation, int block, int axis)
{
  const BondBased *b = formulation;
  const Particles *p = b->particles;
  const double across = b->space == SPACE_3D ? 1.0 / 4 : 1.0 / 3;
  double sum = 0, volume = 0;
  for (int64_t place = 0; place < p->places; ++place) {
    if (p->block[place / SLICE] != block || p->number[place] < 0 || body_outside(b->body, p->number[place])) continue;
    sum += p->volume[place] * family_in_tension(b, place, axis, across);
    volume += p->volume[place];
  }
  return sum / volume / (material_young(bond_material(b, block)) * continuum_young(b));
}

static void describe_body(const BondBased *b, int block, Text *text)
{
  const double most = 0.03;
  bool lattice_is_right = true;
  for (int axis = 0; axis < b->body->dimensions; ++axis)
    lattice_is_right &= fabs(bond_shown_young(b, block, axis) - 1) < most;
  static const char *const remedies[2][2] = {
      {", or 'surface correction: energy'; 'calibration: uniaxial' makes the lattice right along its axes",
       ", or 'surface correction: energy'"},
      {"; 'calibration: uniaxial' makes the lattice right along its axes", ""}};
  const BodyModulus modulus = {.formulation = b,
                               .young = body_young,
                               .body = b->body,
                               .particles = b->particles,
                               .wrong = "strains",
                               .remedy = remedies[b->surface_corrected][lattice_is_right],
                               .tolerance = 0.05};
  body_modulus_describe(&modulus, block, text);
}

/** Says which moduli the inside of a block shows by direction. */
static void describe_inside(const BondBased *b, int block, Text *text)
{
  const double axis[3] = {1, 0, 0}, plane[3] = {sqrt(0.5), sqrt(0.5), 0},
               space[3] = {sqrt(1. / 3), sqrt(1. / 3), sqrt(1. / 3)};
  const double unit = b->stiffness[block] / (material_young(bond_material(b, block)) * continuum_young(b));
  const int dimensions = b->body->dimensions;
  double c[MANDEL][MANDEL];
  inner_stiffness(b, block, c);
  if (isnan(young_along(c, dimensions, axis))) {
    text_add(text, "%s: the bonds within the horizon resist no shear; give a longer one\n",
             b->body->blocks[block]->head.name);
  } else if (dimensions == 1) {
    text_add(text, "%s: a stretched bar shows %.3f of the wanted modulus\n", b->body->blocks[block]->head.name,
             unit * young_along(c, dimensions, axis));
  } else if (!b->body->lattices[block].chunks || b->body->lattices[block].type->turns < dimensions) {
    describe_directions(b, block, c, unit, text);
  } else {
    text_add(text,
             "%s: a uniaxial patch shows %.3f of the wanted modulus along the axes, %.3f along the diagonals of the %s",
             b->body->blocks[block]->head.name, unit * young_along(c, dimensions, axis),
             unit * young_along(c, dimensions, plane), dimensions == 2 ? "plane" : "faces");
    if (dimensions == 3) text_add(text, ", %.3f along those of space", unit * young_along(c, dimensions, space));
    text_add(text, "\n");
  }
}

void bond_describe(const void *formulation, const Units *units, Text *text)
{
  (void)units;
  const BondBased *b = formulation;
  for (int block = 0; block < b->body->block_count; ++block) {
    if (block_is_foreign(b->foreign, b->particles, block)) continue;
    describe_inside(b, block, text);
    if (b->body->dimensions > 1) describe_body(b, block, text);
  }
  if (b->crosses_rows) interfaces_describe(text);
}

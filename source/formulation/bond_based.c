/* Bond-based peridynamics (Silling 2000; docs/theory.md 2): every bond is a fibre with a uniaxial law of its own.
 *
 * With y = xi + eta and the stretch s = (|y| - |xi|) / |xi|, the force on a particle per volume is sum c w s y / |y|, where
 * w = omega beta V_j and c follows from Young's modulus. As s / |y| = (1 - |xi| / |y|) / |xi|, and |y|^2 = |xi|^2 (1 + d) with
 * d = eta . (xi + y) / |xi|^2, a bond needs g(d) = 1 - (1 + d)^-1/2 only; d has no cancellation however small the stretch. */
#include "formulation/bond_based.h"
#include "base/tensor.h"
#include "family/slots.h"
#include "formulation/shape_tensor.h"

#include <stdlib.h>
#include <string.h>

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
    double factor = bond_calibration(b, block, (Calibration)calibration) * bond_continuum_constant(b, 1);
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
    .critical_stretch = bond_critical_stretch,
    .describe = bond_describe,
    .bytes = bytes,
};

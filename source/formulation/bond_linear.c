/* Linearised steps of bonds, and bonds one by one. A bond of tension T = c s (with points: c / E times the stress) and slope A = dT/ds changes
 * its force on the particle per volume, w T y / |y|, by
 *   w [(A / L - T / |y|) n (n . delta eta) + T / |y| delta eta],   n = y / |y|. */
#include "base/team.h"
#include "base/tensor.h"
#include "formulation/bond_based.h"

#include <math.h>
#include <stdlib.h>

/** Half a slot of reference vectors, weights and constants, of lattice slots and stored ones. */
typedef struct HalfSlot {
  Lanes xi[3], length, weight, constant;
  Lanes eta[3], change[3]; /* elongations held, and their change */
} HalfSlot;

LANES_INLINE HalfSlot half_slot(const BondBased *b, double *const at[3], int64_t slice, int64_t slot, int half)
{
  const Family *f = b->family;
  const int64_t here = slice * SLICE + LANES * half;
  HalfSlot h;
  if (slot < f->stored[slice]) {
    const Pattern *row = &f->patterns[f->pattern[slot]];
    const int64_t there = f->base[slot] + LANES * half;
    h.length = lanes_set(row->length);
    h.weight = lanes_set(row->weight);
    for (int k = 0; k < 3; ++k) {
      h.xi[k] = lanes_set(row->xi[k]);
      h.eta[k] = lanes_load(at[k] + there) - lanes_load(at[k] + here);
      h.change[k] =
          lanes_load(b->particles->displacement[k] + there) - lanes_load(b->particles->displacement[k] + here);
    }
    h.constant = lanes_set(b->stiffness[b->particles->block[slice]]);
    return h;
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const Bond bond = family_bond(f, slice, slot, LANES * half + lane);
    const int32_t there = bond.neighbour;
    for (int k = 0; k < 3; ++k) {
      h.xi[k][lane] = bond.xi[k];
      h.eta[k][lane] = at[k][there] - at[k][here + lane];
      h.change[k][lane] = b->particles->displacement[k][there] - b->particles->displacement[k][here + lane];
    }
    h.length[lane] = bond.length;
    h.weight[lane] = bond.weight;
    h.constant[lane] =
        0.5 * (b->stiffness[b->particles->block[slice]] + b->stiffness[b->particles->block[there / SLICE]]);
  }
  return h;
}

LANES_INLINE void add_change(const BondBased *b, double *const at[3], int64_t slice, int64_t slot, int half,
                             Lanes force[3])
{
  const HalfSlot h = half_slot(b, at, slice, slot, half);
  Lanes y[3], square = {0}, d = {0}, along = {0};
  for (int k = 0; k < 3; ++k) {
    y[k] = h.xi[k] + h.eta[k];
    square += y[k] * y[k];
    d += h.eta[k] * (h.xi[k] + y[k]);
    along += y[k] * h.change[k];
  }
  const Lanes length = lanes_root(square), stretch = d / (h.length * (length + h.length));
  Lanes tension = h.constant * stretch, slope = h.constant, weight = h.weight;
  if (b->tension) {
    tension = lanes_load(b->tension + slot * SLICE + LANES * half);
    slope = lanes_load(b->slope + slot * SLICE + LANES * half);
  }
  if (b->surface) weight *= bond_surface(b, slot, half);
  const Lanes across = weight * tension / length, turned = (weight * slope / h.length - across) * along / square;
  const LaneMask intact = lanes_half(b->family->intact[slot], half);
  for (int k = 0; k < 3; ++k) force[k] += lanes_where(intact, turned * y[k] + across * h.change[k]);
}

BRECCIA_CLONES
static void resist_changes(const BondBased *b, const Sweep *sweep)
{
  const Family *f = b->family;
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      Lanes force[3] = {{0}};
      for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
        add_change(b, sweep->at, slice, slot, half, force);
      for (int k = 0; k < 3; ++k) lanes_store(b->particles->internal[k] + slice * SLICE + LANES * half, force[k]);
    }
}

void bond_resist_changes(const BondBased *b, const Sweep *sweep)
{
  resist_changes(b, sweep);
}

/* ---- bonds one by one ---- */

/** Stretch of a bond, and the bond as deformed. */
static double stretch_of(const BondBased *b, int64_t place, const Bond *bond, double y[3])
{
  double d = 0, square = 0;
  for (int k = 0; k < 3; ++k) {
    const double eta = b->particles->displacement[k][bond->neighbour] - b->particles->displacement[k][place];
    y[k] = bond->xi[k] + eta;
    d += eta * (bond->xi[k] + y[k]);
    square += y[k] * y[k];
  }
  return d / (bond->length * (sqrt(square) + bond->length));
}

/** Tension of a bond and its slope: c s and c, or c / E times what laws answer. */
static void find_tension(const BondBased *b, int64_t slice, int64_t slot, int lane, double *tension, double *slope)
{
  const Bond bond = family_bond(b->family, slice, slot, lane);
  const int32_t *block = b->particles->block;
  const int64_t other = bond.neighbour / SLICE;
  double y[3], stretch = stretch_of(b, slice * SLICE + lane, &bond, y);
  if (b->points->where == POINTS_NOWHERE) {
    *slope = (b->stiffness[block[slice]] + b->stiffness[block[other]]) / 2;
    *tension = *slope * stretch;
    return;
  }
  double tangent, partner_tangent;
  double own = points_bond_stress(b->points, slice, slot, lane, false, stretch, &tangent), partner = own;
  partner_tangent = tangent;
  if (b->points->material[other] != b->points->material[slice])
    partner = points_bond_stress(b->points, slice, slot, lane, true, stretch, &partner_tangent);
  *tension = (b->per_stress[block[slice]] * own + b->per_stress[block[other]] * partner) / 2;
  *slope = (b->per_stress[block[slice]] * tangent + b->per_stress[block[other]] * partner_tangent) / 2;
}

static void linearise_slice(void *context, int64_t slice)
{
  const BondBased *b = context;
  const Family *f = b->family;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane)
      if (f->intact[slot] >> lane & 1)
        find_tension(b, slice, slot, lane, &b->tension[slot * SLICE + lane], &b->slope[slot * SLICE + lane]);
}

int bond_linearise(void *formulation, Error *error)
{
  BondBased *b = formulation;
  const size_t count = (size_t)b->family->slots * SLICE;
  if (b->points->where == POINTS_NOWHERE) return BRECCIA_OK;
  if (!b->tension) b->tension = memory_zeroed(count, sizeof(double), "linearised step", error);
  if (!b->slope) b->slope = memory_zeroed(count, sizeof(double), "linearised step", error);
  if (!b->tension || !b->slope) return BRECCIA_FAILURE;
  team_each(b->particles->slices, linearise_slice, b);
  return BRECCIA_OK;
}

int64_t bond_point_count(const void *formulation)
{
  const BondBased *b = formulation;
  return b->family->slots * SLICE;
}

/** Slice of a slot. */
static int64_t slice_of(const Family *f, int64_t slot)
{
  int64_t low = 0, high = f->particles->slices;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (f->first[middle] <= slot)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/** Points are numbered by slot and lane; a bond has one, of its end with the lower place. */
int bond_point(const void *formulation, int64_t number, Operator *point, Error *error)
{
  const BondBased *b = formulation;
  const int64_t slot = number / SLICE, slice = slice_of(b->family, slot);
  const int lane = (int)(number % SLICE);
  const int64_t place = slice * SLICE + lane;
  operator_clear(point);
  if (!(b->family->intact[slot] >> lane & 1)) return BRECCIA_OK;
  const Bond bond = family_bond(b->family, slice, slot, lane);
  if (bond.neighbour < place) return BRECCIA_OK;
  if (!operator_add(point, place, error)) return BRECCIA_FAILURE;
  OperatorPlace *p = operator_add(point, bond.neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  double y[3], length = 0;
  stretch_of(b, place, &bond, y);
  for (int k = 0; k < 3; ++k) length += y[k] * y[k];
  length = sqrt(length);
  for (int k = 0; k < 3; ++k) p->g[k] = y[k] / (length * bond.length);
  p->turn = 1 / (length * bond.length);
  point->components = 1;
  point->volume = b->particles->volume[place] * bond.weight * bond.length;
  if (b->surface) point->volume *= (double)b->surface[slot * SLICE + lane];
  find_tension(b, slice, slot, lane, &point->stress[0], &point->tangent[0]);
  operator_close(point);
  return BRECCIA_OK;
}

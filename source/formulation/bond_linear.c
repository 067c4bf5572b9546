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

LANES_INLINE HalfSlot half_slot(const BondBased *b, const Sweep *sweep, int64_t slice, int64_t slot, int half)
{
  double *const *at = sweep->linearised_at, *const *v = sweep->displacement;
  const Family *f = b->family;
  const int64_t here = slice * SLICE + LANES * half;
  HalfSlot h;
  if (slot < f->stored[slice]) {
    const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
    const int64_t there = family_base(f, slice, slot) + LANES * half;
    h.length = lanes_set(row->length);
    h.weight = lanes_set(row->weight);
    for (int k = 0; k < 3; ++k) {
      h.xi[k] = lanes_set(row->xi[k]);
      h.eta[k] = lanes_load(at[k] + there) - lanes_load(at[k] + here);
      h.change[k] = lanes_load(v[k] + there) - lanes_load(v[k] + here);
    }
    h.constant = lanes_set(b->stiffness[b->particles->block[slice]]);
    return h;
  }
  const int64_t first = (int64_t)f->base[slot] * SLICE + LANES * half;
  const int32_t *there = f->neighbour + first;
  Lanes square = {0}, other;
  for (int k = 0; k < 3; ++k) {
    h.xi[k] = lanes_gather(b->particles->position[k], there) - lanes_load(b->particles->position[k] + here);
    h.eta[k] = lanes_gather(at[k], there) - lanes_load(at[k] + here);
    h.change[k] = lanes_gather(v[k], there) - lanes_load(v[k] + here);
    square += h.xi[k] * h.xi[k];
  }
  /* Where there is no bond nothing is divided by 0. */
  h.length = lanes_root(lanes_choose(lanes_half(f->intact[slot], half), square, lanes_set(1)));
  h.weight = lanes_gather(b->particles->volume, there);
  if (f->scale) h.weight *= lanes_load(f->scale + first);
  for (int lane = 0; lane < LANES; ++lane) other[lane] = b->stiffness[b->particles->block[there[lane] / SLICE]];
  h.constant = lanes_set(0.5) * (lanes_set(b->stiffness[b->particles->block[slice]]) + other);
  return h;
}

LANES_INLINE void add_change(const BondBased *b, const Sweep *sweep, int64_t slice, int64_t slot, int half,
                             Lanes force[3])
{
  const HalfSlot h = half_slot(b, sweep, slice, slot, half);
  Lanes y[3], square = {0}, d = {0}, along = {0};
  for (int k = 0; k < 3; ++k) {
    y[k] = h.xi[k] + h.eta[k];
    square += y[k] * y[k];
    d += h.eta[k] * (h.xi[k] + y[k]);
    along += y[k] * h.change[k];
  }
  const LaneMask intact = lanes_half(b->family->intact[slot], half);
  square = lanes_choose(intact, square, lanes_set(1)); /* lanes without a bond divide by nothing that may be 0 */
  const Lanes length = lanes_root(square), stretch = d / (h.length * (length + h.length));
  Lanes tension = h.constant * stretch, slope = h.constant, weight = h.weight;
  if (b->tension) {
    tension = bond_list_load(b->bonds, b->family, b->tension, slice, slot, half);
    slope = bond_list_load(b->bonds, b->family, b->slope, slice, slot, half);
  }
  const float *factors = bond_factors(b, slice);
  if (factors) weight *= bond_surface(b, factors, slice, slot, half);
  const Lanes across = weight * tension / length, turned = (weight * slope / h.length - across) * along / square;
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
        add_change(b, sweep, slice, slot, half, force);
      for (int k = 0; k < 3; ++k) lanes_store(sweep->internal[k] + slice * SLICE + LANES * half, force[k]);
    }
}

void bond_resist_changes(const BondBased *b, const Sweep *sweep)
{
  resist_changes(b, sweep);
}

/* ---- bonds one by one ---- */

void bond_tension(const BondBased *b, double *const *u, int64_t slice, int64_t slot, int lane, const Bond *bond,
                  double y[3], double *tension, double *slope)
{
  const int64_t place = slice * SLICE + lane, other = bond->neighbour / SLICE;
  const int32_t *block = b->particles->block;
  double d = 0;
  for (int k = 0; k < 3; ++k) {
    const double eta = u[k][bond->neighbour] - u[k][place];
    y[k] = bond->xi[k] + eta;
    d += eta * (bond->xi[k] + y[k]);
  }
  d /= bond->length * bond->length;
  const double stretch = d / (1 + sqrt(1 + d));
  if (!b->bonds) {
    *slope = (b->stiffness[block[slice]] + b->stiffness[block[other]]) / 2;
    *tension = *slope * stretch;
    return;
  }
  int64_t rows[2];
  const double share = bond_share(b, slice, other);
  double tangent[2], own = share * b->per_stress[block[slice]], there = (1 - share) * b->per_stress[block[other]];
  bond_list_rows(b->bonds, b->family, slice, slot, lane, rows);
  const double lateral = bond_lateral(b, place, bond),
               stress = points_try(b->points, rows[0], stretch, lateral, &tangent[0]);
  double partner = stress;
  tangent[1] = tangent[0];
  if (rows[1] != rows[0]) partner = points_try(b->points, rows[1], stretch, lateral, &tangent[1]);
  *tension = own * stress + there * partner;
  *slope = own * tangent[0] + there * tangent[1];
}

void bond_change(const BondBased *b, double *const *v, double *const *at, int64_t slice, int64_t slot, int lane,
                 const Bond *bond, double change[3])
{
  const int64_t place = slice * SLICE + lane;
  double y[3], d = 0, square = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    const double eta = at[k][bond->neighbour] - at[k][place];
    change[k] = v[k][bond->neighbour] - v[k][place];
    y[k] = bond->xi[k] + eta;
    d += eta * (bond->xi[k] + y[k]);
    square += y[k] * y[k];
    along += y[k] * change[k];
  }
  const double length = sqrt(square), correction = bond_factor(b, slice, slot, lane);
  const int32_t *block = b->particles->block;
  double slope = (b->stiffness[block[slice]] + b->stiffness[block[bond->neighbour / SLICE]]) / 2,
         tension = slope * d / (bond->length * (length + bond->length));
  if (b->tension) {
    int64_t rows[2];
    bond_list_rows(b->bonds, b->family, slice, slot, lane, rows);
    const bool owner = rows[1] == rows[0] || bond->neighbour > place; /* sums stand in the first row */
    tension = b->tension[rows[!owner]];
    slope = b->slope[rows[!owner]];
  }
  const double across = tension / length, turned = (slope / bond->length - across) * along / square;
  for (int k = 0; k < 3; ++k) change[k] = correction * (turned * y[k] + across * change[k]);
}

/** Bonds at the displacements at which they are linearised. */
typedef struct BondsAt {
  const BondBased *bonds;
  double *const *displacement;
} BondsAt;

static void linearise_slice(void *context, int64_t slice)
{
  const BondsAt *at = context;
  const BondBased *b = at->bonds;
  const Family *f = b->family;
  for (int64_t row = b->bonds->first[slice]; row < b->bonds->first[slice + 1]; ++row) {
    int64_t slot;
    int lane;
    double y[3];
    if (bond_list_bond(b->bonds, f, slice, row, &slot, &lane) || !(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    bond_tension(b, at->displacement, slice, slot, lane, &bond, y, &b->tension[row], &b->slope[row]);
  }
}

int bond_linearise(void *formulation, double *const *displacement, Error *error)
{
  BondBased *b = formulation;
  if (!b->bonds) return BRECCIA_OK;
  if (!b->tension) b->tension = places_array(b->bonds->count, "linearised step", error);
  if (!b->slope) b->slope = places_array(b->bonds->count, "linearised step", error);
  if (!b->tension || !b->slope) return BRECCIA_FAILURE;
  BondsAt at = {b, displacement};
  team_each(b->particles->slices, linearise_slice, &at);
  return BRECCIA_OK;
}

int64_t bond_point_count(const void *formulation)
{
  const BondBased *b = formulation;
  return b->family->slots * SLICE;
}

/** Points are numbered by slot and lane; a bond has one, of its end with the lower place. */
int bond_point(const void *formulation, double *const *u, int64_t number, Operator *point, Error *error)
{
  const BondBased *b = formulation;
  const int64_t slot = number / SLICE, slice = family_slice(b->family, slot);
  const int lane = (int)(number % SLICE);
  const int64_t place = slice * SLICE + lane;
  operator_clear(point);
  if (!(b->family->intact[slot] >> lane & 1)) return BRECCIA_OK;
  const Bond bond = family_bond(b->family, slice, slot, lane);
  if (is_foreign(b->foreign, place)) return BRECCIA_OK;
  if (bond.neighbour < place && !is_foreign(b->foreign, bond.neighbour)) return BRECCIA_OK;
  if (!operator_add(point, place, error)) return BRECCIA_FAILURE;
  OperatorPlace *p = operator_add(point, bond.neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  double y[3], length = 0;
  bond_tension(b, u, slice, slot, lane, &bond, y, &point->stress[0], &point->tangent[0]);
  for (int k = 0; k < 3; ++k) length += y[k] * y[k];
  length = sqrt(length);
  for (int k = 0; k < 3; ++k) p->g[k] = y[k] / (length * bond.length);
  p->turn = 1 / (length * bond.length);
  point->components = 1;
  point->volume = b->particles->volume[place] * bond.weight * bond.length * bond_factor(b, slice, slot, lane);
  operator_close(point);
  return BRECCIA_OK;
}

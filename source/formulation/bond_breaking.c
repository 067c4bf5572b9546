/* How far bonds are from an energy: of half the force of a linear bond, c omega e / |xi|, times half its elongation e. It depends on the elongation
 * only, and as that grows by no more than both ends move, the slice need not be looked at again before half of what is left has been moved. */
#include "formulation/bond_based.h"

#include <math.h>

/** Length that each of four lattice bonds may still grow by. */
LANES_INLINE Lanes room_of_lattice(const BondBased *b, const EnergyLimit *limit, int64_t slot, int64_t place, int half)
{
  const Family *f = b->family;
  const int64_t slice = place / SLICE, there = family_base(f, slice, slot) + LANES * half;
  const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
  Lanes square = {0};
  for (int k = 0; k < 3; ++k) {
    const double *u = b->particles->displacement.row[k];
    const Lanes y = lanes_set(row->xi[k]) + (lanes_load(u + there) - lanes_load(u + place));
    square += y * y;
  }
  const double constant =
      b->stiffness[b->particles->block[place / SLICE]] * limit->influence[family_pattern(f, slice, slot)];
  Lanes stiffness = lanes_set(constant / (4 * limit->half * row->length));
  const float *factors = bond_factors(b, slice);
  if (factors) stiffness *= bond_surface(b, factors, slice, slot, half);
  const Lanes left = lanes_set(1) / lanes_root(stiffness) + lanes_set(row->length) - lanes_root(square);
  const LaneMask intact = lanes_half(f->intact[slot], half);
  return lanes_where(intact, left) + lanes_where(~intact, lanes_set(f->horizon));
}

static double room_of_stored(const BondBased *b, const EnergyLimit *limit, int64_t slice, int64_t slot, int lane)
{
  const Family *f = b->family;
  const int32_t *block = b->particles->block;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(f, slice, slot, lane);
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double *u = b->particles->displacement.row[k], y = bond.xi[k] + (u[bond.neighbour] - u[place]);
    square += y * y;
  }
  const double own = bond_own_share(b, &bond) * bond_factor(b, slice, slot, lane) *
                     limit->of->value(fmin(1, bond.length / f->horizon), bond.length) *
                     (b->stiffness[block[slice]] + b->stiffness[block[bond.neighbour / SLICE]]) / 2;
  return sqrt(2 * limit->half * bond.length / own) + bond.length - sqrt(square);
}

BRECCIA_CLONES
static double least_room(const BondBased *b, int64_t slice, const EnergyLimit *limit)
{
  const Family *f = b->family;
  Lanes least = lanes_set(f->horizon);
  for (int half = 0; half < SLICE / LANES; ++half)
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
      least = lanes_least(least, room_of_lattice(b, limit, slot, slice * SLICE + LANES * half, half));
  double smallest = least[0];
  for (int k = 1; k < LANES; ++k) smallest = least[k] < smallest ? least[k] : smallest;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane)
      if (f->intact[slot] >> lane & 1) smallest = fmin(smallest, room_of_stored(b, limit, slice, slot, lane));
  return smallest;
}

double bond_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found)
{
  const BondBased *b = formulation;
  if (b->particles->free_strain) { /* which may change without any motion */
    *found = 1;
    return 0;
  }
  const double rounding = 1e-12 * b->family->horizon, least = least_room(b, slice, limit);
  *found = least <= rounding;
  return least > rounding ? (least - rounding) / 2 : 0;
}

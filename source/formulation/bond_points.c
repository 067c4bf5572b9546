/* Bonds whose law has a history: pulls from stresses, and bonds one by one. What goes over all of them is bond_points_sweep.c. */
#include "formulation/bond_based.h"

#include <math.h>

int64_t bond_stretch(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  if (b->bonds) b->point_sweeps->stretch(b, sweep);
  if (b->bonds) bond_lateral_rows(b, sweep);
  return -1;
}

int64_t bond_pull_of_stress(void *formulation, const Sweep *sweep)
{
  const BondBased *b = formulation;
  if (!b->bonds) return -1;
  int64_t slot;
  int lane;
  const double *stress = sweep->stress[0], *lever = sweep->carry;
  if (!bond_list_bond(b->bonds, b->family, sweep->first, sweep->row, &slot, &lane)) {
    for (int i = 0; i < sweep->rows; ++i) b->pull[sweep->row + i] = stress[i] * lever[i];
    return -1;
  }
  for (int i = 0; i < sweep->rows; ++i) { /* second rows add to the first of their bonds */
    bond_list_bond(b->bonds, b->family, sweep->first, sweep->row + i, &slot, &lane);
    b->pull[b->bonds->stored_row[(int64_t)b->family->base[slot] * SLICE + lane]] += stress[i] * lever[i];
  }
  return -1;
}

double bond_pull(const BondBased *b, double *const *u, int64_t slice, int64_t slot, int lane, const Bond *bond,
                 double y[3])
{
  double tension, slope, length = 0;
  bond_tension(b, u, slice, slot, lane, bond, y, &tension, &slope);
  for (int k = 0; k < 3; ++k) length += y[k] * y[k];
  return tension * bond_factor(b, slice, slot, lane) / sqrt(length);
}

/* Factors on bonds near interfaces of two linear materials (formulation/interface.h): of bonds that pass through both
 * the stiffness in series, and of bonds along the interface what the energy of their particles lacks. */
#include "formulation/bond_based.h"
#include "formulation/interface.h"

#include "base/memory.h"
#include "base/team.h"

#include <math.h>
#include <stdlib.h>

typedef struct BondInterfaces {
  BondBased *bonds;
  Interfaces interfaces;
  double *lack; /* [places] */
} BondInterfaces;

static InterfaceShare bond_interface_share(const void *context, int64_t slice, int64_t slot, int lane, const Bond *bond)
{
  const BondInterfaces *of = context;
  const BondBased *b = of->bonds;
  const int32_t *block = b->particles->block;
  const double series = interfaces_series(&of->interfaces, slice, slot, lane), own = b->stiffness[block[slice]],
               mean = (own + b->stiffness[block[bond->neighbour / SLICE]]) / 2;
  return (InterfaceShare){bond->weight * bond->length, series != 1 ? series * mean / own : 1};
}

static void bond_interface_lack(void *context, int64_t place)
{
  BondInterfaces *of = context;
  const InterfaceSum sum = {.measure = bond_interface_share, .formulation = of, .power = 2, .poisson = NAN};
  of->lack[place] = interfaces_lack(&of->interfaces, place, &sum);
}

static void bond_interface_slice(void *context, int64_t slice)
{
  const BondInterfaces *of = context;
  const Family *f = of->bonds->family;
  if (!of->interfaces.series[slice]) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t place = slice * SLICE + lane;
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      const double lack = (of->lack[place] + of->lack[bond.neighbour]) / 2,
                   row = lack != 0 ? lack * interfaces_along(&of->interfaces, place, &bond) : 0;
      of->bonds->surface[slice][(slot - f->first[slice]) * SLICE + lane] *=
          (float)(interfaces_series(&of->interfaces, slice, slot, lane) * (1 + row));
    }
}

int bond_make_factors(BondBased *b, float *const *only, Error *error)
{
  const Family *f = b->family;
  const int64_t slices = b->particles->slices;
  size_t count = 0;
  if (b->surface) return BRECCIA_OK;
  for (int64_t slice = 0; slice < slices; ++slice)
    if (!only || only[slice]) count += (size_t)(f->first[slice + 1] - f->first[slice]) * SLICE;
  b->surface = memory_zeroed((size_t)slices, sizeof *b->surface, "factors of bonds", error);
  b->surfaces = memory_zeroed(count + 1, sizeof *b->surfaces, "factors of bonds", error);
  if (!b->surface || !b->surfaces) return BRECCIA_FAILURE;
  b->surface_count = count;
  float *at = b->surfaces;
  for (size_t k = 0; k < count; ++k) at[k] = 1;
  for (int64_t slice = 0; slice < slices; ++slice) {
    if (only && !only[slice]) continue;
    b->surface[slice] = at;
    at += (f->first[slice + 1] - f->first[slice]) * SLICE;
  }
  return BRECCIA_OK;
}

int bond_correct_interfaces(BondBased *b, const FormulationParts *parts, Error *error)
{
  BondInterfaces of = {.bonds = b};
  int failed = interfaces_create(&of.interfaces, parts, b->stiffness, error);
  if (!failed && of.interfaces.series) {
    of.lack = memory_zeroed((size_t)b->particles->places, sizeof *of.lack, "interfaces of bonds", error);
    failed = !of.lack || bond_make_factors(b, of.interfaces.series, error);
    if (!failed) team_each(b->particles->places, bond_interface_lack, &of);
    if (!failed) team_each(b->particles->slices, bond_interface_slice, &of);
    b->in_series = true;
    b->crosses_rows = interfaces_cross_rows(&of.interfaces);
  }
  free(of.lack);
  interfaces_destroy(&of.interfaces);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

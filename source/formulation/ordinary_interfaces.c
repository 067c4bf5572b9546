/* Factors on bonds near interfaces of two linear materials (formulation/interface.h). A bond through both gives each
 * family the elongation that it would have in that family's material: the stiffness b is that of its pieces in series,
 * and the dilatation of an end counts it 2 G_j / (G_i + G_j) times, so that both ends together give it the tension of
 * one material. Bonds along the interface give both families back what their dilatation and their energy lack. */
#include "formulation/interface.h"
#include "formulation/ordinary.h"

#include "base/memory.h"
#include "base/team.h"

#include <stdlib.h>

typedef struct OrdinaryInterfaces {
  Ordinary *ordinary;
  Interfaces interfaces;
  double *shear;               /* [blocks] b m */
  double *dilatation, *energy; /* [places] what both lack */
} OrdinaryInterfaces;

/** Returns the part of a bond in the dilatation of a place. */
static InterfaceShare ordinary_interface_dilatation(const void *context, int64_t slice, int64_t slot, int lane,
                                                    const Bond *bond)
{
  const OrdinaryInterfaces *of = context;
  const int32_t *block = of->ordinary->particles->block;
  const double series = interfaces_series(&of->interfaces, slice, slot, lane), own = of->shear[block[slice]],
               other = of->shear[block[bond->neighbour / SLICE]];
  const Bond weighted = ordinary_bond(of->ordinary, slice, slot, lane);
  return (InterfaceShare){weighted.weight * bond->length * bond->length, series == 1    ? 1
                                                                         : own == other ? series
                                                                                        : 2 * other / (own + other)};
}

/** Returns the part of a bond in the energy of elongations of a place. */
static InterfaceShare ordinary_interface_energy(const void *context, int64_t slice, int64_t slot, int lane,
                                                const Bond *bond)
{
  const OrdinaryInterfaces *of = context;
  const Ordinary *o = of->ordinary;
  const int32_t *block = o->particles->block;
  const double series = interfaces_series(&of->interfaces, slice, slot, lane),
               own = of->shear[block[slice]] * o->inverse[slice * SLICE + lane],
               other = of->shear[block[bond->neighbour / SLICE]] * o->inverse[bond->neighbour];
  const Bond weighted = ordinary_bond(o, slice, slot, lane);
  return (InterfaceShare){weighted.weight * bond->length * bond->length,
                          series == 1 ? 1 : series * (own + other) / (2 * own)};
}

static void ordinary_interface_lack(void *context, int64_t place)
{
  OrdinaryInterfaces *of = context;
  const Ordinary *o = of->ordinary;
  const Material *m = ordinary_material(o, place);
  const double bulk = ordinary_bulk(o->space, m), lame = bulk - 2 * m->shear / o->dimensions;
  InterfaceSum sum = {ordinary_interface_dilatation, of, 1, lame / (lame + 2 * m->shear)};
  of->dilatation[place] = interfaces_lack(&of->interfaces, place, &sum);
  sum.measure = ordinary_interface_energy;
  sum.power = 2;
  of->energy[place] = interfaces_lack(&of->interfaces, place, &sum);
}

static void ordinary_interface_bond(const OrdinaryInterfaces *of, int64_t slice, int64_t slot, int lane,
                                    float factors[ORDINARY_FACTORS])
{
  const Ordinary *o = of->ordinary;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = family_bond(o->family, slice, slot, lane);
  const int32_t other = bond.neighbour;
  const double along = interfaces_along(&of->interfaces, place, &bond),
               series = interfaces_series(&of->interfaces, slice, slot, lane),
               own = ordinary_interface_dilatation(of, slice, slot, lane, &bond).share,
               both = series == 1 || own == series ? 2 * own : 2;
  factors[ORDINARY_OWN] = (float)(own * (1 + along * of->dilatation[place]));
  factors[ORDINARY_OTHER] = (float)((both - own) * (1 + along * of->dilatation[other]));
  factors[ORDINARY_SPRING] = (float)(series * (1 + along * (of->energy[place] + of->energy[other]) / 2));
}

static void ordinary_interface_slice(void *context, int64_t slice)
{
  const OrdinaryInterfaces *of = context;
  const Ordinary *o = of->ordinary;
  const Family *f = o->family;
  if (!o->unlike[slice]) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      float factors[ORDINARY_FACTORS] = {1, 1, 1};
      if (f->intact[slot] >> lane & 1) ordinary_interface_bond(of, slice, slot, lane, factors);
      for (int k = 0; k < ORDINARY_FACTORS; ++k)
        ordinary_factor_at(o, o->unlike[slice], slice, slot, k)[lane] = factors[k];
    }
}

/** Makes room for the factors of slices near interfaces. */
static int ordinary_interface_room(const OrdinaryInterfaces *of, Error *error)
{
  Ordinary *o = of->ordinary;
  const Family *f = o->family;
  o->unlike_count = of->interfaces.count * ORDINARY_FACTORS;
  o->unlike = memory_zeroed((size_t)o->particles->slices, sizeof *o->unlike, "interfaces of bonds", error);
  o->unlikes = memory_zeroed(o->unlike_count, sizeof *o->unlikes, "interfaces of bonds", error);
  if (!o->unlike || !o->unlikes) return BRECCIA_FAILURE;
  float *at = o->unlikes;
  for (int64_t slice = 0; slice < o->particles->slices; ++slice) {
    if (!of->interfaces.series[slice]) continue;
    o->unlike[slice] = at;
    at += (f->first[slice + 1] - f->first[slice]) * ORDINARY_FACTORS * SLICE;
  }
  return BRECCIA_OK;
}

bool ordinary_shifts_interface(const void *formulation, const Material *one, const Material *other)
{
  return ((const Ordinary *)formulation)->may_break || !interfaces_join(one, other);
}

int ordinary_find_interfaces(Ordinary *o, const FormulationParts *parts, Error *error)
{
  const Particles *p = o->particles;
  OrdinaryInterfaces of = {.ordinary = o};
  of.shear = memory_zeroed((size_t)o->body->block_count, sizeof *of.shear, "interfaces of bonds", error);
  if (!of.shear) return BRECCIA_FAILURE;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    of.shear[p->block[slice]] = ordinary_shear(o->space, &o->materials[o->material[slice]]);
  int failed = interfaces_create(&of.interfaces, parts, of.shear, error);
  if (!failed && of.interfaces.series) {
    of.dilatation = memory_zeroed((size_t)p->places, sizeof *of.dilatation, "interfaces of bonds", error);
    of.energy = memory_zeroed((size_t)p->places, sizeof *of.energy, "interfaces of bonds", error);
    failed = !of.dilatation || !of.energy || ordinary_interface_room(&of, error);
    if (!failed) team_each(p->places, ordinary_interface_lack, &of);
    if (!failed) team_each(p->slices, ordinary_interface_slice, &of);
    o->crosses_rows = interfaces_cross_rows(&of.interfaces);
  }
  free(of.shear);
  free(of.dilatation);
  free(of.energy);
  interfaces_destroy(&of.interfaces);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

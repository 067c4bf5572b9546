/* Linearised steps of ordinary peridynamics, and its points one by one. A point is the dilatation of a family with the modulus K_d - b m / d^2; beside
 * it the elongations of its bonds act as springs. */
#include "formulation/ordinary.h"

#include "base/tensor.h"

#include <math.h>

/** Half a slot at the displacements held, and how elongations change. */
typedef struct HalfSlot {
  Lanes n[3], change[3], along, length, reference, weight, base, slope, turned;
} HalfSlot;

LANES_INLINE HalfSlot half_slot(const Ordinary *o, double *const at[3], int64_t slice, int64_t slot, int half,
                                bool forces)
{
  HalfSlot h = {.along = {0}};
  for (int lane = 0; lane < LANES; ++lane) {
    const int64_t place = slice * SLICE + LANES * half + lane;
    if (!(o->family->intact[slot] >> (LANES * half + lane) & 1)) {
      h.length[lane] = h.reference[lane] = 1;
      continue;
    }
    const Bond bond = ordinary_bond(o, slice, slot, LANES * half + lane);
    const OrdinaryStretch s = ordinary_stretch(at, place, &bond);
    for (int k = 0; k < 3; ++k) {
      h.n[k][lane] = s.y[k] / s.length;
      h.change[k][lane] = o->particles->displacement[k][bond.neighbour] - o->particles->displacement[k][place];
      h.along[lane] += h.n[k][lane] * h.change[k][lane];
    }
    h.length[lane] = s.length;
    h.reference[lane] = bond.length;
    h.weight[lane] = bond.weight;
    if (!forces) continue; /* other threads are writing what follows */
    h.base[lane] = o->base[place] + o->base[bond.neighbour];
    h.slope[lane] = o->slope[place] + o->slope[bond.neighbour];
    h.turned[lane] = o->change[place] + o->change[bond.neighbour];
  }
  return h;
}

int64_t ordinary_change_dilatation(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      const int64_t here = slice * SLICE + LANES * half;
      Lanes sum = {0};
      for (int64_t slot = o->family->first[slice]; slot < o->family->first[slice + 1]; ++slot) {
        const HalfSlot h = half_slot(o, sweep->at, slice, slot, half, false);
        sum += h.weight * h.reference * h.along;
      }
      lanes_store(o->change + here, lanes_load(o->inverse + here) * sum);
    }
  return -1;
}

int64_t ordinary_change_forces(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      Lanes force[3] = {{0}};
      for (int64_t slot = o->family->first[slice]; slot < o->family->first[slice + 1]; ++slot) {
        const HalfSlot h = half_slot(o, sweep->at, slice, slot, half, true);
        const Lanes stiffness = h.base + h.slope; /* b_i + b_j */
        const Lanes tension = h.base * h.reference + stiffness * (h.length - h.reference);
        const Lanes across = tension / h.length;
        const Lanes pull = h.turned * h.reference + (stiffness - across) * h.along;
        for (int k = 0; k < 3; ++k) force[k] += h.weight * (pull * h.n[k] + across * h.change[k]);
      }
      for (int k = 0; k < 3; ++k) lanes_store(o->particles->internal[k] + slice * SLICE + LANES * half, force[k]);
    }
  return -1;
}

int ordinary_linearise(void *formulation, Error *error)
{
  Ordinary *o = formulation;
  if (o->flow) return error_add(error, BRECCIA_FAILURE, "ordinary: families that yield or relax have no tangent");
  if (!o->change) o->change = places_array(o->particles->places, "linearised step", error);
  return o->change ? BRECCIA_OK : BRECCIA_FAILURE;
}

int64_t ordinary_point_count(const void *formulation)
{
  return ((const Ordinary *)formulation)->particles->places;
}

static int add_neighbour(const Ordinary *o, int64_t place, const Bond *bond, Operator *point, Error *error)
{
  OperatorPlace *p = operator_add(point, bond->neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  const OrdinaryStretch s = ordinary_stretch(o->particles->displacement, place, bond);
  const double share = o->inverse[place] * bond->weight * bond->length,
               spring = o->particles->volume[place] * o->shear[place] * bond->weight,
               across = spring * s.elongation / s.length;
  p->turn = share / s.length;
  for (int k = 0; k < 3; ++k) {
    p->g[k] = share * s.y[k] / s.length;
    p->pull[k] = across * s.y[k];
  }
  for (int k = 0; k < 6; ++k)
    p->spring[k] = (k < 3 ? across : 0) +
                   (spring - across) * s.y[symmetric_row[k]] * s.y[symmetric_column[k]] / (s.length * s.length);
  return BRECCIA_OK;
}

int ordinary_point(const void *formulation, int64_t place, Operator *point, Error *error)
{
  const Ordinary *o = formulation;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  operator_clear(point);
  if (o->particles->number[place] < 0 || is_foreign(o->foreign, place) || o->inverse[place] == 0) return BRECCIA_OK;
  if (!operator_add(point, place, error)) return BRECCIA_FAILURE;
  point->components = 1;
  point->volume = o->particles->volume[place];
  point->tangent[0] = o->volumetric[place] / o->inverse[place];
  point->stress[0] = point->tangent[0] * o->dilatation[place];
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    if (add_neighbour(o, place, &bond, point, error)) return BRECCIA_FAILURE;
  }
  operator_close(point);
  return BRECCIA_OK;
}

/* Linearised steps of ordinary peridynamics, and its points one by one. A point is the dilatation of a family with the modulus K_d - b m / d^2; beside
 * it the elongations of its bonds act as springs. Where families flow, what is kept of the deviator, x = e_d - s, changes by
 *   dx = f de_d + x (f_0 dtheta + f_1 sum w x de_d)
 * (FlowReturn): a softer spring for each bond, and two numbers of the whole family. */
#include "formulation/ordinary.h"

#include "base/tensor.h"

#include <math.h>

/** Half a slot at the displacements held, and how elongations change. */
typedef struct HalfSlot {
  Lanes n[3], change[3], along, length, reference, weight;
  Lanes tension, stiffness, turned; /* of both ends */
  Lanes kept;                       /* x of the slice's own end, where it flows */
} HalfSlot;

LANES_INLINE HalfSlot half_slot(const Ordinary *o, double *const at[3], int64_t slice, int64_t slot, int half,
                                bool forces)
{
  HalfSlot h = {.along = {0}};
  for (int lane = 0; lane < LANES; ++lane) {
    const int64_t place = slice * SLICE + LANES * half + lane, own = slot * SLICE + LANES * half + lane;
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
    if (o->flow) h.kept[lane] = ordinary_deviatoric(o, place, &bond, &s) - o->flow->shift[1][own];
    if (!forces) continue; /* other threads are writing what follows */
    const OrdinaryEnd here = ordinary_end(o, place, own, &bond, &s),
                      there = ordinary_end(o, bond.neighbour, o->flow ? o->flow->back[own] : 0, &bond, &s);
    h.tension[lane] = here.tension + there.tension;
    h.stiffness[lane] = here.stiffness + there.stiffness;
    h.turned[lane] = here.turned + there.turned;
  }
  return h;
}

int64_t ordinary_change_dilatation(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      const int64_t here = slice * SLICE + LANES * half;
      Lanes sum = {0}, kept = {0}, evenly = {0};
      for (int64_t slot = o->family->first[slice]; slot < o->family->first[slice + 1]; ++slot) {
        const HalfSlot h = half_slot(o, sweep->at, slice, slot, half, false);
        sum += h.weight * h.reference * h.along;
        kept += h.weight * h.kept * h.along;
        evenly += h.weight * h.kept * h.reference;
      }
      const Lanes dilatation = lanes_load(o->inverse + here) * sum;
      lanes_store(o->change + here, dilatation);
      if (o->flow) lanes_store(o->flow->amount + here, kept - evenly * dilatation * lanes_set(1.0 / o->dimensions));
    }
  return -1;
}

/** How a family that flows changes with its dilatation and with the amount of x: a, and what x is taken times. */
typedef struct FamilyTangent {
  double base[2], kept[2];
} FamilyTangent;

static FamilyTangent family_tangent(const Ordinary *o, int64_t place)
{
  FamilyTangent t = {.base = {o->volumetric[place]}};
  if (!o->flow) return t;
  const FlowReturn *r = &o->flow->returned[place];
  const double pull =
      ordinary_coupling(o->space, ordinary_material(o, place)).pull * o->share[place] * o->inverse[place];
  t.base[0] += o->shear[place] * (1 - r->factor) / o->dimensions;
  for (int k = 0; k < 2; ++k) {
    t.base[k] -= pull * r->across_by[k];
    t.kept[k] = o->shear[place] * r->factor_by[k];
  }
  return t;
}

int64_t ordinary_change_states(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; ++place) {
    const double dilatation = o->change[place];
    if (!o->flow) {
      o->change[place] = o->volumetric[place] * dilatation;
      continue;
    }
    const FamilyTangent t = family_tangent(o, place);
    const double amount = o->flow->amount[place];
    o->change[place] = t.base[0] * dilatation + t.base[1] * amount;
    o->flow->amount[place] = t.kept[0] * dilatation + t.kept[1] * amount;
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
        const Lanes across = h.tension / h.length, pull = h.turned + (h.stiffness - across) * h.along;
        for (int k = 0; k < 3; ++k) force[k] += h.weight * (pull * h.n[k] + across * h.change[k]);
      }
      for (int k = 0; k < 3; ++k) lanes_store(o->particles->internal[k] + slice * SLICE + LANES * half, force[k]);
    }
  return -1;
}

int ordinary_linearise(void *formulation, Error *error)
{
  Ordinary *o = formulation;
  if (!o->change) o->change = places_array(o->particles->places, "linearised step", error);
  if (o->flow && !o->flow->amount) o->flow->amount = places_array(o->particles->places, "linearised step", error);
  return o->change && (!o->flow || o->flow->amount) ? BRECCIA_OK : BRECCIA_FAILURE;
}

int64_t ordinary_point_count(const void *formulation)
{
  return ((const Ordinary *)formulation)->particles->places;
}

/** @param[in,out] evenly  adds to sum w x |xi| */
static int add_neighbour(const Ordinary *o, int64_t place, int64_t at, const Bond *bond, Operator *point,
                         double *evenly, Error *error)
{
  OperatorPlace *p = operator_add(point, bond->neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  const OrdinaryStretch s = ordinary_stretch(o->particles->displacement, place, bond);
  const double share = o->inverse[place] * bond->weight * bond->length, shift = o->flow ? o->flow->shift[1][at] : 0,
               spring = o->particles->volume[place] * o->shear[place] * bond->weight,
               along = spring * (o->flow ? o->flow->returned[place].factor : 1),
               across = spring * (s.elongation - shift) / s.length,
               kept = bond->weight * (ordinary_deviatoric(o, place, bond, &s) - shift);
  p->turn = share / s.length;
  *evenly += kept * bond->length;
  for (int k = 0; k < 3; ++k) {
    p->g[k] = share * s.y[k] / s.length;
    p->second[k] = kept * s.y[k] / s.length;
    p->pull[k] = across * s.y[k];
  }
  for (int k = 0; k < 6; ++k)
    p->spring[k] = (k < 3 ? across : 0) +
                   (along - across) * s.y[symmetric_row[k]] * s.y[symmetric_column[k]] / (s.length * s.length);
  return BRECCIA_OK;
}

/** Where families flow the point's second component is sum w x n . du, from which the amount of x has sum w x |xi| / d of the dilatation less. */
int ordinary_point(const void *formulation, int64_t place, Operator *point, Error *error)
{
  const Ordinary *o = formulation;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  operator_clear(point);
  if (o->particles->number[place] < 0 || is_foreign(o->foreign, place) || o->inverse[place] == 0) return BRECCIA_OK;
  if (!operator_add(point, place, error)) return BRECCIA_FAILURE;
  double evenly = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    if (add_neighbour(o, place, slot * SLICE + lane, &bond, point, &evenly, error)) return BRECCIA_FAILURE;
  }
  const FamilyTangent t = family_tangent(o, place);
  const double inverse = o->inverse[place], less = evenly / o->dimensions;
  point->components = o->flow ? 2 : 1;
  point->volume = o->particles->volume[place];
  point->stress[0] = o->base[place] / inverse;
  point->tangent[0] = (t.base[0] - less * t.base[1]) / inverse;
  if (o->flow) {
    point->tangent[1] = t.base[1] / inverse;
    point->tangent[2] = t.kept[0] - less * t.kept[1];
    point->tangent[3] = t.kept[1];
  }
  operator_close(point);
  return BRECCIA_OK;
}

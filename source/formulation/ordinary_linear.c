/* Linearised steps of ordinary peridynamics, and its points one by one. A point is the dilatation of a family with the modulus K_d - b m / d^2; beside
 * it the elongations of its bonds act as springs. Where families flow, what is kept of the deviator, x = e_d - s, changes by
 *   dx = f de_d + x (f_0 dtheta + f_1 sum w x de_d)
 * (FlowReturn): a softer spring for each bond, and two numbers of the whole family. */
#include "formulation/ordinary.h"

#include "base/tensor.h"

/** Half a slot at the displacements held, and how elongations change. Where there is no bond lengths are 1, so that nothing is divided by 0. */
typedef struct HalfSlot {
  Lanes n[3], change[3], along, by_length, reference, weight, elongation; /* by_length: 1 / |y| */
  LaneMask intact;
  Lanes factor[ORDINARY_FACTORS]; /* near interfaces; else 1 */
  int64_t own, there;             /* in the arrays of slots; first neighbour of lattice slots */
  const int32_t *stored;          /* neighbours of stored ones, or NULL */
} HalfSlot;

LANES_INLINE Lanes at_neighbours(const HalfSlot *h, const double *values)
{
  return h->stored ? lanes_gather(values, h->stored) : lanes_load(values + h->there);
}

LANES_INLINE HalfSlot half_slot(const Ordinary *o, const Sweep *sweep, int64_t slice, int64_t slot, int half)
{
  double *const *at = sweep->linearised_at, *const *v = sweep->displacement;
  const Family *f = o->family;
  const Particles *p = o->particles;
  const int64_t here = slice * SLICE + LANES * half;
  HalfSlot h = {.own = slot * SLICE + LANES * half, .intact = lanes_half(f->intact[slot], half)};
  Lanes xi[3], y[3], whole = {0}, square = {0}, d = {0};
  if (slot < f->stored[slice]) {
    const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
    h.there = family_base(f, slice, slot) + LANES * half;
    h.reference = lanes_set(row->length);
    h.weight = lanes_set(row->weight * o->factor[family_pattern(f, slice, slot)]);
    for (int k = 0; k < 3; ++k) xi[k] = lanes_set(row->xi[k]);
  } else {
    const int64_t first = (int64_t)f->base[slot] * SLICE + LANES * half;
    h.stored = f->neighbour + first;
    for (int k = 0; k < 3; ++k) {
      xi[k] = at_neighbours(&h, p->position[k]) - lanes_load(p->position[k] + here);
      whole += xi[k] * xi[k];
    }
    h.reference = lanes_choose(h.intact, lanes_root(whole), lanes_set(1));
    h.weight = at_neighbours(&h, p->volume);
    if (f->scale) h.weight *= lanes_load(f->scale + first);
  }
  if (o->surface && o->surface[slice])
    h.weight *= lanes_widen(o->surface[slice] + (slot - f->first[slice]) * SLICE + LANES * half);
  h.weight = lanes_where(h.intact, h.weight);
  float *unlike = o->unlike ? o->unlike[slice] : NULL;
  for (int k = 0; k < ORDINARY_FACTORS; ++k)
    h.factor[k] = unlike ? lanes_widen(ordinary_factor_at(o, unlike, slice, slot, k) + LANES * half) : lanes_set(1);
  for (int k = 0; k < 3; ++k) {
    const Lanes eta = at_neighbours(&h, at[k]) - lanes_load(at[k] + here);
    y[k] = xi[k] + eta;
    square += y[k] * y[k];
    d += eta * (xi[k] + y[k]);
    h.change[k] = at_neighbours(&h, v[k]) - lanes_load(v[k] + here);
  }
  const Lanes length = lanes_root(lanes_choose(h.intact, square, lanes_set(1)));
  h.by_length = lanes_set(1) / length;
  h.elongation = d / (length + h.reference);
  h.along = (Lanes){0};
  for (int k = 0; k < 3; ++k) {
    h.n[k] = y[k] * h.by_length;
    h.along += h.n[k] * h.change[k];
  }
  return h;
}

/** x = e_d - s of one end, by its dilatation. */
LANES_INLINE Lanes kept_by(const Ordinary *o, const HalfSlot *h, Lanes dilatation, Lanes shift)
{
  return h->elongation - dilatation * h->reference * lanes_set(1.0 / o->dimensions) - shift;
}

/** Shifts as the other ends know them. */
LANES_INLINE Lanes shifts_there(const Ordinary *o, const HalfSlot *h)
{
  Lanes shift = {0};
  for (int lane = 0; lane < LANES; ++lane)
    if (h->intact[lane]) shift[lane] = o->flow->shift[1][o->flow->back[h->own + lane]];
  return shift;
}

BRECCIA_CLONES
static void change_dilatation(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      const int64_t here = slice * SLICE + LANES * half;
      Lanes sum = {0}, amount = {0}, evenly = {0};
      for (int64_t slot = o->family->first[slice]; slot < o->family->first[slice + 1]; ++slot) {
        const HalfSlot h = half_slot(o, sweep, slice, slot, half);
        sum += h.factor[ORDINARY_OWN] * h.weight * h.reference * h.along;
        if (!o->flow) continue;
        const Lanes kept = kept_by(o, &h, lanes_load(o->dilatation + here),
                                   lanes_load(o->flow->shift[1] + h.own)); /* of its own end */
        amount += h.weight * kept * h.along;
        evenly += h.weight * kept * h.reference;
      }
      const Lanes dilatation = lanes_load(o->inverse + here) * sum;
      lanes_store(o->change + here, dilatation);
      if (o->flow) lanes_store(o->flow->amount + here, amount - evenly * dilatation * lanes_set(1.0 / o->dimensions));
    }
}

int64_t ordinary_change_dilatation(const Ordinary *o, const Sweep *sweep)
{
  change_dilatation(o, sweep);
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

/** Pull of both ends of half a slot over influence, its growth with the elongation alone, and its change with those of the families. */
typedef struct BothEnds {
  Lanes tension, stiffness, turned;
} BothEnds;

LANES_INLINE BothEnds both_ends(const Ordinary *o, const HalfSlot *h, int64_t here)
{
  const Lanes own = lanes_load(o->shear + here), other = at_neighbours(h, o->shear);
  const Lanes *factor = h->factor, spring = factor[ORDINARY_SPRING];
  BothEnds ends = {.tension = (factor[ORDINARY_OWN] * lanes_load(o->base + here) +
                               factor[ORDINARY_OTHER] * at_neighbours(h, o->base)) *
                                  h->reference +
                              spring * (own + other) * h->elongation,
                   .stiffness = spring * (own + other),
                   .turned = (factor[ORDINARY_OWN] * lanes_load(o->change + here) +
                              factor[ORDINARY_OTHER] * at_neighbours(h, o->change)) *
                             h->reference};
  if (o->unlike && o->particles->free_strain) /* what the bases hold of it */
    ends.tension += ((factor[ORDINARY_OWN] - spring) * own * lanes_load(o->particles->free_strain + here) +
                     (factor[ORDINARY_OTHER] - spring) * other * at_neighbours(h, o->particles->free_strain)) *
                    h->reference;
  if (!o->flow) return ends;
  const Flow *flow = o->flow;
  const Lanes shift = lanes_load(flow->shift[1] + h->own), back = shifts_there(o, h);
  Lanes kept = {0}, kept_there = {0};
  for (int lane = 0; lane < LANES; ++lane) {
    if (!h->intact[lane]) continue;
    kept[lane] = flow->returned[here + lane].factor;
    kept_there[lane] = flow->returned[h->stored ? h->stored[lane] : h->there + lane].factor;
  }
  ends.tension -= own * shift + other * back;
  ends.stiffness = spring * (own * kept + other * kept_there);
  ends.turned += lanes_load(flow->amount + here) * kept_by(o, h, lanes_load(o->dilatation + here), shift) +
                 at_neighbours(h, flow->amount) * kept_by(o, h, at_neighbours(h, o->dilatation), back);
  return ends;
}

BRECCIA_CLONES
static void change_forces(const Ordinary *o, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    for (int half = 0; half < 2; ++half) {
      const int64_t here = slice * SLICE + LANES * half;
      Lanes force[3] = {{0}};
      for (int64_t slot = o->family->first[slice]; slot < o->family->first[slice + 1]; ++slot) {
        const HalfSlot h = half_slot(o, sweep, slice, slot, half);
        const BothEnds ends = both_ends(o, &h, here);
        const Lanes across = ends.tension * h.by_length, pull = ends.turned + (ends.stiffness - across) * h.along;
        for (int k = 0; k < 3; ++k)
          force[k] += lanes_where(h.intact, h.weight * (pull * h.n[k] + across * h.change[k]));
      }
      for (int k = 0; k < 3; ++k) lanes_store(sweep->internal[k] + here, force[k]);
    }
}

int64_t ordinary_change_forces(const Ordinary *o, const Sweep *sweep)
{
  change_forces(o, sweep);
  return -1;
}

int ordinary_linearise(void *formulation, double *const *displacement, Error *error)
{
  (void)displacement;
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
static int add_neighbour(const Ordinary *o, double *const *u, int64_t place, int64_t at, const Bond *bond,
                         Operator *point, double *evenly, Error *error)
{
  OperatorPlace *p = operator_add(point, bond->neighbour, error);
  if (!p) return BRECCIA_FAILURE;
  const OrdinaryStretch s = ordinary_stretch(u, place, bond);
  const double share = ordinary_factor(o, place, at, ORDINARY_OWN) * o->inverse[place] * bond->weight * bond->length,
               shift = o->flow ? o->flow->shift[1][at] : 0,
               spring = ordinary_factor(o, place, at, ORDINARY_SPRING) * o->particles->volume[place] * o->shear[place] *
                        bond->weight,
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
int ordinary_point(const void *formulation, double *const *u, int64_t place, Operator *point, Error *error)
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
    if (add_neighbour(o, u, place, slot * SLICE + lane, &bond, point, &evenly, error)) return BRECCIA_FAILURE;
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

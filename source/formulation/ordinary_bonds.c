/* Bonds and places of ordinary peridynamics one by one. */
#include "formulation/ordinary.h"

#include "base/tensor.h"
#include "formulation/shape_tensor.h"

#include <math.h>

OrdinaryStretch ordinary_stretch(double *const u[3], int64_t place, const Bond *bond)
{
  OrdinaryStretch s;
  double square = 0, d = 0;
  for (int k = 0; k < 3; ++k) {
    s.eta[k] = u[k][bond->neighbour] - u[k][place];
    s.y[k] = bond->xi[k] + s.eta[k];
    square += s.y[k] * s.y[k];
    d += s.eta[k] * (bond->xi[k] + s.y[k]);
  }
  s.length = sqrt(square);
  s.elongation = d / (s.length + bond->length);
  return s;
}

/** Elongation that carries nothing. */
static double shift_of(const Ordinary *o, int64_t slot, int lane, int state)
{
  return o->flow ? o->flow->shift[state][slot * SLICE + lane] : 0;
}

/** With the scalar force state over influence a |xi| + b (e - s), its change in a linearised step is da |xi| + b f de + b x df / f. */
OrdinaryEnd ordinary_end(const Ordinary *o, int64_t place, int64_t at, const Bond *bond, const OrdinaryStretch *s)
{
  const double own = ordinary_factor(o, place, at, ORDINARY_OWN),
               spring = ordinary_factor(o, place, at, ORDINARY_SPRING),
               freely = o->shear[place] * ordinary_free(o, place); /* of which the base holds `own` */
  OrdinaryEnd end = {.tension = (own * o->base[place] + (own - spring) * freely) * bond->length +
                                spring * o->shear[place] * s->elongation,
                     .stiffness = spring * o->shear[place],
                     .turned = o->change ? own * o->change[place] * bond->length : 0};
  if (!o->flow) return end;
  const double shift = o->flow->shift[1][at];
  end.tension -= o->shear[place] * shift;
  end.stiffness *= o->flow->returned[place].factor;
  if (o->flow->amount) end.turned += o->flow->amount[place] * (ordinary_deviatoric(o, place, bond, s) - shift);
  return end;
}

void ordinary_half_state(const void *formulation, double *const *u, double *const *at, int64_t slice, int64_t slot,
                         int lane, double state[3])
{
  const Ordinary *o = formulation;
  const int64_t place = slice * SLICE + lane;
  const Bond bond = ordinary_bond(o, slice, slot, lane);
  const OrdinaryStretch s = ordinary_stretch(at ? at : u, place, &bond);
  const OrdinaryEnd end = ordinary_end(o, place, slot * SLICE + lane, &bond, &s);
  const double omega = bond.weight / o->particles->volume[bond.neighbour], across = end.tension / s.length;
  double change[3], along = 0;
  for (int k = 0; k < 3; ++k) {
    state[k] = omega * across * s.y[k];
    if (!at) continue;
    change[k] = u[k][bond.neighbour] - u[k][place];
    along += change[k] * s.y[k] / s.length;
  }
  for (int k = 0; k < 3 && at; ++k)
    state[k] = omega * ((end.turned + (end.stiffness - across) * along) * s.y[k] / s.length + across * change[k]);
}

/** Of the displacements held and the bonds as they are, not of what was evaluated last: bonds may have broken since. */
void ordinary_stored_energy(const void *formulation, int64_t place, double time, StoredEnergy *energy)
{
  const Ordinary *o = formulation;
  const Particles *p = o->particles;
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double volume = 0, square = 0, volume_moved = 0, square_moved = 0,
         flowed = 0; /* sums of w |xi| e and w e^2; of their changes */
  const double relaxing = o->deviators[o->material[slice]].relaxing, part = relaxing > 0 ? relaxing : 1;
  *energy = (StoredEnergy){0};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const OrdinaryStretch s = ordinary_stretch(p->displacement.row, place, &bond);
    const double own = ordinary_factor(o, place, slot * SLICE + lane, ORDINARY_OWN),
                 spring = ordinary_factor(o, place, slot * SLICE + lane, ORDINARY_SPRING);
    double grown = 0;
    for (int k = 0; k < 3; ++k)
      grown += time * (p->velocity.row[k][bond.neighbour] - p->velocity.row[k][place]) * s.y[k] / s.length;
    const double from_free = s.elongation - ordinary_free(o, place) * bond.length;
    volume += own * bond.weight * bond.length * from_free;
    const double shift = shift_of(o, slot, lane, 1), elastic = from_free - shift;
    square += spring * bond.weight * (elastic * elastic + (1 / part - 1) * shift * shift);
    flowed += bond.weight * (from_free - shift / part) * (shift - shift_of(o, slot, lane, 0));
    volume_moved += own * bond.weight * bond.length * grown;
    square_moved += spring * bond.weight * elastic * grown;
  }
  const double inverse = o->inverse[place], own_volume = p->volume[place];
  const double base = o->volumetric[place] * inverse, shear = o->shear[place];
  const Material *m = ordinary_material(o, place);
  energy->stored = 0.5 * own_volume * (base * volume * volume + shear * square);
  energy->received = energy->stored - 0.5 * own_volume * (base * volume * volume_moved + shear * square_moved);
  if (o->flow) { /* and what p stores: with - pull theta p + own p^2 / 2 what a relaxing share keeps to itself */
    const Across c = ordinary_coupling(o->space, m);
    const double share = own_volume * o->share[place], across = o->flow->across[1][place], theta = inverse * volume,
                 stiffness = c.own + (o->space == SPACE_3D ? 0 : 3 * m->shear * (1 / part - 1));
    const double stored = share * across * (0.5 * stiffness * across - c.pull * theta);
    energy->stored += stored;
    energy->received += stored + 0.5 * share * c.pull * across * inverse * volume_moved;
    energy->received += share * (c.pull * theta - stiffness * across) * (across - o->flow->across[0][place]);
  }
  energy->received +=
      own_volume * shear * flowed; /* what has been dissipated in the step is not what the break takes */
}

void ordinary_gradient(const void *formulation, int64_t place, double f[9])
{
  const Ordinary *o = formulation;
  const ShapeTensor shape = shape_tensor(o->family, (int32_t)place, o->dimensions, 0);
  shape_gradient(o->family, o->particles->displacement.row, (int32_t)place, shape.inverse, f);
  if (o->space != SPACE_PLANE_STRESS) return;
  const double sum = f[0] * f[0] + f[3] * f[3] + f[1] * f[1] + f[4] * f[4] - 2, /* 2 (E_xx + E_yy) */
      inelastic = o->flow ? 2 * o->flow->across[1][place] : 0, freely = ordinary_free(o, place);
  f[8] = sqrt(fmax(0, 1 + ordinary_across(ordinary_material(o, place)) * (sum - inelastic - 4 * freely) - inelastic +
                          2 * freely));
}

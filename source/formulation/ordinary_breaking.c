/* How far the bonds of a slice are from an energy: a particle's half of it is omega (a |xi| + b (e - s)) e / 2. With its two ends a bond grows by no
 * more than q, twice what every particle moves, and its dilatation, (d / m) sum w |xi| e, by no more than d q over the shortest bond, as
 * sum w |xi| <= m / shortest. So the half stays below an energy h while (p + p' q)(e + q) < 2 h / omega, where p = a |xi| + b e now
 * and p' = |a / theta| (d / shortest) |xi| + b. Families that yield or relax are looked at in every step. */
#include "formulation/ordinary.h"

#include <math.h>

/** Four bonds as they are. */
typedef struct Four {
  Lanes length, elongation, force; /* p */
  Lanes magnitude;                 /* of what p is the sum of */
  Lanes most;                      /* 2 h / omega */
} Four;

LANES_INLINE Four four_bonds(const Ordinary *o, const EnergyLimit *limit, int64_t slice, int64_t slot, int half)
{
  const Family *f = o->family;
  const int64_t place = slice * SLICE + LANES * half;
  Four four;
  if (slot < f->stored[slice]) {
    const int64_t there = family_base(f, slice, slot) + LANES * half;
    const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
    Lanes square = {0}, along = {0};
    for (int k = 0; k < 3; ++k) {
      const double *u = o->particles->displacement.row[k];
      const Lanes xi = lanes_set(row->xi[k]), eta = lanes_load(u + there) - lanes_load(u + place), y = xi + eta;
      square += y * y;
      along += eta * (xi + y);
    }
    four.length = lanes_set(row->length);
    four.elongation = along / (lanes_root(square) + four.length);
    four.most =
        lanes_set(2 * limit->half /
                  (limit->influence[family_pattern(f, slice, slot)] * o->factor[family_pattern(f, slice, slot)]));
  } else {
    for (int lane = 0; lane < LANES; ++lane) {
      const Bond bond = family_bond(f, slice, slot, LANES * half + lane);
      const OrdinaryStretch s = ordinary_stretch(o->particles->displacement.row, place + lane, &bond);
      four.length[lane] = bond.length;
      four.elongation[lane] = s.elongation;
      four.most[lane] = 2 * limit->half / limit->of->value(fmin(1, bond.length / f->horizon), bond.length);
    }
  }
  if (o->surface && o->surface[slice])
    four.most = four.most / lanes_widen(o->surface[slice] + (slot - f->first[slice]) * SLICE + LANES * half);
  const Lanes base = lanes_load(o->base + place) * four.length;
  const Lanes stiffness = lanes_load(o->shear + place);
  Lanes elastic = four.elongation;
  if (o->flow) elastic -= lanes_load(o->flow->shift[1] + slot * SLICE + LANES * half);
  four.force = base + stiffness * elastic;
  four.magnitude = lanes_absolute(base) + lanes_absolute(stiffness * elastic);
  return four;
}

BRECCIA_CLONES
static double least_room(const Ordinary *o, int64_t slice, const EnergyLimit *limit, uint8_t *found)
{
  const Family *f = o->family;
  const Lanes tiny = lanes_set(1e-300), rounding = lanes_set(1e-12);
  Lanes least = lanes_set(f->horizon);
  LaneMask any = {0};
  for (int half = 0; half < SLICE / LANES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Lanes swell = lanes_absolute(lanes_load(o->volumetric + place)) * lanes_set(o->dimensions / o->shortest);
    const Lanes stiffness = lanes_load(o->shear + place) + tiny;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const Four four = four_bonds(o, limit, slice, slot, half);
      const LaneMask intact = lanes_half(f->intact[slot], half);
      const Lanes above = (four.force + rounding * four.magnitude) * four.elongation,
                  rate = swell * four.length + stiffness;
      any |= intact & (LaneMask)(above >= four.most * (lanes_set(1) - rounding)) & (LaneMask)(four.elongation > tiny);
      const Lanes soon = four.force + swell * four.length * lanes_set(2 * limit->moved), other = rate * four.elongation;
      const Lanes apart = soon - other, root = lanes_root(apart * apart + lanes_set(4) * rate * four.most);
      const Lanes room = (root - soon - other) / (lanes_set(2) * rate);
      least = lanes_least(least, lanes_where(intact, room) + lanes_where(~intact, lanes_set(f->horizon)));
    }
  }
  *found = (any[0] | any[1] | any[2] | any[3]) != 0;
  double smallest = least[0];
  for (int k = 1; k < LANES; ++k) smallest = least[k] < smallest ? least[k] : smallest;
  return smallest;
}

double ordinary_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found)
{
  const Ordinary *o = formulation;
  if (o->particles->free_strain) { /* which may change without any motion */
    *found = 1;
    return 0;
  }
  const double margin = 1e-12 * o->family->horizon, least = least_room(o, slice, limit, found);
  return o->flow || least <= margin ? 0 : (least - margin) / 2;
}

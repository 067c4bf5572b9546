#include "formulation/correspondence.h"

#include <math.h>

/** What a particle without a strain exerts through one of its bonds: half of a bond-based spring, instead of the control that
 *  the sweeps have added for it. */
static void axial_state(const Correspondence *c, int64_t slice, const Bond *bond, int lane, double t[3])
{
  int64_t place = slice * SLICE + lane;
  const Material *m = &c->points->materials[c->points->material[slice]];
  double y[3], length = 0;
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + c->particles->displacement[k][bond->neighbour] - c->particles->displacement[k][place];
    length += y[k] * y[k];
  }
  length = sqrt(length);
  double stiffness = micromodulus(c->body, material_young(m), c->family->horizon) / 2;
  double pull = length > 0 ? stiffness * (length - bond->length) / (bond->length * length) : 0;
  double omega = bond->weight / c->particles->volume[bond->neighbour];
  double hold = c->control == CONTROL_TENSOR ? 0 : hold_component(c, place, XX);
  for (int k = 0; k < 3; ++k) t[k] = pull * y[k] - omega * hold * (y[k] - bond->xi[k]);
}

void correspondence_finish(void *formulation)
{
  const Correspondence *c = formulation;
  for (int64_t n = 0; n < c->axial_count; ++n) {
    int32_t place = c->axial[n];
    int64_t slice = place / SLICE;
    int lane = place % SLICE;
    if (c->shapes.mode[place] != SHAPE_AXIAL) continue;
    for (int64_t slot = c->family->first[slice]; slot < c->family->first[slice + 1]; ++slot) {
      if (!(c->family->intact[slot] >> lane & 1)) continue;
      Bond bond = family_bond(c->family, slice, slot, lane);
      double t[3];
      axial_state(c, slice, &bond, lane, t);
      for (int k = 0; k < 3; ++k) {
        c->particles->internal[k][place] += t[k] * c->particles->volume[bond.neighbour];
        c->particles->internal[k][bond.neighbour] -= t[k] * c->particles->volume[place];
      }
    }
  }
}

void correspondence_bond_force(const void *formulation, int64_t slice, int64_t slot, int lane, double force[3])
{
  const Correspondence *c = formulation;
  Bond bond = family_bond(c->family, slice, slot, lane);
  int64_t place = slice * SLICE + lane, ends[2] = {place, bond.neighbour};
  double omega = bond.weight / c->particles->volume[bond.neighbour];
  for (int k = 0; k < 3; ++k) force[k] = 0;
  for (int e = 0; e < 2; ++e)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        double eta = c->particles->displacement[j][bond.neighbour] - c->particles->displacement[j][place];
        double hold = hold_component(c, ends[e], symmetric_place[3 * k + j]);
        force[k] += omega * (c->state[3 * k + j][ends[e]] * bond.xi[j] + hold * eta);
      }
  for (int e = 0; e < 2; ++e) { /* a spring pulls its two ends alike */
    if (c->shapes.mode[ends[e]] != SHAPE_AXIAL) continue;
    Bond seen = bond; /* from that end */
    double t[3];
    if (e) {
      seen.neighbour = (int32_t)place;
      for (int k = 0; k < 3; ++k) seen.xi[k] = -bond.xi[k];
      seen.weight = bond.weight * c->particles->volume[place] / c->particles->volume[bond.neighbour];
    }
    axial_state(c, ends[e] / SLICE, &seen, (int)(ends[e] % SLICE), t);
    for (int k = 0; k < 3; ++k) force[k] += e ? -t[k] : t[k];
  }
}

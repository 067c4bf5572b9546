/* Bonds between regions. The force on a particle per volume is sum (t_ij - t_ji) V_j, t_ij being the force state that its own formulation gives
 * the bond and t_ji that of its neighbour's (docs/theory.md 1). A formulation gives its own places t_ij for all their bonds; what is left
 * for bonds between regions is t_ji. Both ends add the same two, so that momentum is kept to rounding whatever the formulations are, and forces
 * are the gradient of the energies of both where each has one. */
#include "domain/regions.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>

struct JointBond {
  int64_t slot, back; /* of the place, and of its neighbour */
  int32_t neighbour;
};

/** Counts the bonds between regions, and writes them if there is room. */
static void gather(Joint *joint, const Domain *d)
{
  const Family *f = &d->family;
  const bool write = joint->bonds != NULL;
  joint->places = joint->bond_count = 0;
  for (int64_t place = 0; place < d->particles->places; ++place) {
    const int64_t s = place / SLICE, before = joint->bond_count;
    for (int64_t slot = f->stored[s]; slot < f->first[s + 1]; ++slot) {
      if (!(f->intact[slot] >> place % SLICE & 1)) continue;
      const int32_t there = family_bond(f, s, slot, (int)(place % SLICE)).neighbour;
      if (d->region[there / SLICE] == d->region[s]) continue;
      if (write) joint->bonds[joint->bond_count] = (JointBond){slot, family_slot(f, there, (int32_t)place), there};
      ++joint->bond_count;
    }
    if (joint->bond_count == before) continue;
    if (write) {
      joint->place[joint->places] = (int32_t)place;
      joint->first[joint->places + 1] = joint->bond_count;
    }
    ++joint->places;
  }
}

int joint_create(Joint *joint, const Domain *d, Error *error)
{
  if (d->region_count < 2) return BRECCIA_OK;
  gather(joint, d);
  joint->place = memory_zeroed((size_t)joint->places, sizeof *joint->place, "bonds between regions", error);
  joint->first = memory_zeroed((size_t)joint->places + 1, sizeof *joint->first, "bonds between regions", error);
  joint->bonds = memory_zeroed((size_t)joint->bond_count, sizeof *joint->bonds, "bonds between regions", error);
  if (!joint->place || !joint->first || !joint->bonds) return BRECCIA_FAILURE;
  gather(joint, d);
  return BRECCIA_OK;
}

void joint_destroy(Joint *joint)
{
  free(joint->place);
  free(joint->first);
  free(joint->bonds);
}

void joint_resist(const Domain *d, const Evaluation *of)
{
  const Joint *joint = &d->joint;
  const Particles *p = d->particles;
  TEAM_FOR (n, joint->places) {
    const int32_t place = joint->place[n];
    double force[3] = {0};
    for (int64_t b = joint->first[n]; b < joint->first[n + 1]; ++b) {
      const JointBond *bond = &joint->bonds[b];
      if (!(d->family.intact[bond->slot] >> place % SLICE & 1)) continue;
      const Region *region = domain_region(d, bond->neighbour);
      double state[3];
      region->type->half_state(region->formulation, of->displacement->row,
                               of->linearised_at ? of->linearised_at->row : NULL, bond->neighbour / SLICE, bond->back,
                               bond->neighbour % SLICE, state);
      for (int k = 0; k < 3; ++k) force[k] += state[k] * p->volume[bond->neighbour];
    }
    for (int k = 0; k < 3; ++k) of->internal->row[k][place] -= force[k];
  }
}

void domain_bond_force(const Domain *d, int64_t slice, int64_t slot, int lane, double force[3])
{
  const int32_t place = (int32_t)(slice * SLICE + lane), other = family_bond(&d->family, slice, slot, lane).neighbour;
  const Region *own = domain_region(d, place), *their = domain_region(d, other);
  double back[3];
  double *const *u = d->particles->displacement.row;
  own->type->half_state(own->formulation, u, NULL, slice, slot, lane, force);
  their->type->half_state(their->formulation, u, NULL, other / SLICE, family_slot(&d->family, other, place),
                          other % SLICE, back);
  for (int k = 0; k < 3; ++k) force[k] -= back[k];
}

void domain_even_stress(const Domain *d, const uint8_t *marked, double *const area[3])
{
  for (int64_t i = 0; i < d->particles->places; ++i) {
    const Region *region = marked[i] ? domain_region(d, i) : NULL;
    for (int k = 0; k < 3; ++k) area[k][i] = region && !(region->formulation && region->type->even_stress) ? NAN : 0;
  }
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].formulation && d->regions[r].type->even_stress)
      d->regions[r].type->even_stress(d->regions[r].formulation, marked, area);
}

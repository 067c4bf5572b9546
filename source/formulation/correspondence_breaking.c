/* What a bond holds in correspondence: half of t . r, t its force state and r = y - R xi, where R is how the family has turned. Over the bonds of a
 * family t . r / 2 adds up to S : E / 2 and the energy of the control, but for the cube of the stretches; in a bond that bridges a crack r
 * is what the bond has opened, which the strain of the family shows in part only. Stresses may change with any law, so that all slices
 * are looked at in every step. */
#include "formulation/correspondence.h"

#include <math.h>

void correspondence_keep_turn(const Correspondence *c, int64_t place, const double *gradient)
{
  double *turn = c->turns + place / SLICE * (9 * SLICE) + place % SLICE;
  Lanes g[9], f[9], cofactor[9], determinant = {0};
  for (int k = 0; k < 9; ++k) {
    g[k] = lanes_load(gradient + k * BATCH);
    f[k] = g[k] + lanes_set(k % 4 == 0);
  }
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      const int r1 = (r + 1) % 3 * 3, r2 = (r + 2) % 3 * 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      cofactor[3 * r + k] = f[r1 + k1] * f[r2 + k2] - f[r1 + k2] * f[r2 + k1];
    }
  for (int k = 0; k < 3; ++k) determinant += f[k] * cofactor[k];
  const LaneMask sound =
      (LaneMask)(determinant > lanes_set(0.01)); /* families that are turned inside out have no turn */
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      const Lanes finite = f[3 * r + k] + cofactor[3 * r + k] / determinant - lanes_set(r == k ? 2 : 0);
      const Lanes small = g[3 * r + k] - g[3 * k + r];
      const Lanes both = c->finite ? lanes_choose(sound, finite, small) : small;
      lanes_store(turn + SLICE * (3 * r + k), lanes_set(0.5) * both);
    }
}

int correspondence_keep_turns(void *formulation, Error *error)
{
  Correspondence *c = formulation;
  if (!c->turns) c->turns = places_array(9 * c->particles->places, "turns of families", error);
  return c->turns ? BRECCIA_OK : BRECCIA_FAILURE;
}

void correspondence_elongation(const void *formulation, int64_t slice, int64_t slot, int lane, double change[3])
{
  const Correspondence *c = formulation;
  const Bond bond = family_bond(c->family, slice, slot, lane);
  const int64_t place = slice * SLICE + lane;
  const double *turn = c->turns + slice * (9 * SLICE) + lane;
  for (int k = 0; k < 3; ++k) {
    change[k] = c->particles->displacement.row[k][bond.neighbour] - c->particles->displacement.row[k][place];
    for (int j = 0; j < 3; ++j) change[k] -= turn[SLICE * (3 * k + j)] * bond.xi[j];
  }
  const double freely = particles_free_strain(c->particles, place, bond.neighbour);
  for (int k = 0; k < 3 && freely != 0; ++k) {
    change[k] -= freely * bond.xi[k];
    for (int j = 0; j < 3; ++j) change[k] -= freely * turn[SLICE * (3 * k + j)] * bond.xi[j];
  }
}

/** The force state of four particles, over influence, is state xi + hold eta. */
typedef struct Fours {
  Lanes state[9], turn[9], hold[6], own[3]; /* own: displacements */
} Fours;

LANES_INLINE Fours four_places(const Correspondence *c, int64_t place)
{
  Fours fours;
  for (int k = 0; k < 9; ++k) {
    fours.state[k] = lanes_load(c->state[k] + place);
    fours.turn[k] = lanes_load(c->turns + place / SLICE * (9 * SLICE) + SLICE * k + place % SLICE);
  }
  for (int k = 0; k < 6; ++k) {
    fours.hold[k] = lanes_set(0);
    if (c->control == CONTROL_TENSOR) fours.hold[k] = lanes_load(c->hold[k] + place);
    if (c->control == CONTROL_SCALAR && k <= ZZ) fours.hold[k] = lanes_load(c->hold[0] + place);
    if (c->control == CONTROL_UNIFORM && k <= ZZ) fours.hold[k] = lanes_set(c->uniform);
  }
  for (int k = 0; k < 3; ++k) fours.own[k] = lanes_load(c->particles->displacement.row[k] + place);
  return fours;
}

/** Twice the energy of four bonds at their own end, over influence. */
LANES_INLINE Lanes twice_energy(const Fours *fours, const Lanes xi[3], const Lanes eta[3], bool tensor)
{
  Lanes sum = {0};
  for (int r = 0; r < 3; ++r) {
    Lanes force = fours->hold[r] * eta[r], change = eta[r];
    for (int k = 0; k < 3; ++k) {
      force += fours->state[3 * r + k] * xi[k];
      change -= fours->turn[3 * r + k] * xi[k];
      if (tensor && k != r) force += fours->hold[symmetric_place[3 * r + k]] * eta[k];
    }
    sum += force * change;
  }
  return sum;
}

BRECCIA_CLONES
static bool any_beyond(const Correspondence *c, int64_t slice, const EnergyLimit *limit)
{
  const Family *f = c->family;
  double *const *u = c->particles->displacement.row;
  const double share = 2 * limit->half * (1 - 1e-9);
  LaneMask any = {0};
  for (int half = 0; half < SLICE / LANES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Fours fours = four_places(c, place);
    const bool tensor = c->control == CONTROL_TENSOR;
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      Lanes xi[3], eta[3], most;
      if (slot < f->stored[slice]) {
        const Pattern *row = &f->patterns[family_pattern(f, slice, slot)];
        const int64_t there = family_base(f, slice, slot) + LANES * half;
        for (int k = 0; k < 3; ++k) {
          xi[k] = lanes_set(row->xi[k]);
          eta[k] = lanes_load(u[k] + there) - fours.own[k];
        }
        most = lanes_set(share / limit->influence[family_pattern(f, slice, slot)]);
      } else {
        const int32_t *index = f->neighbour + (int64_t)f->base[slot] * SLICE + LANES * half;
        Lanes square = {0};
        for (int k = 0; k < 3; ++k) {
          xi[k] = lanes_gather(c->particles->position[k], index) - lanes_load(c->particles->position[k] + place);
          eta[k] = lanes_gather(u[k], index) - fours.own[k];
          square += xi[k] * xi[k];
        }
        for (int lane = 0; lane < LANES; ++lane) {
          const double length = sqrt(square[lane]);
          most[lane] = share / limit->of->value(fmin(1, length / f->horizon), length);
        }
      }
      any |= lanes_half(f->intact[slot], half) & (LaneMask)(twice_energy(&fours, xi, eta, tensor) >= most);
    }
  }
  return (any[0] | any[1] | any[2] | any[3]) != 0;
}

/** Particles with too few bonds for a strain pull at them besides. */
static bool any_axial_beyond(const Correspondence *c, int64_t slice, int lane, const EnergyLimit *limit)
{
  const Family *f = c->family;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    double state[3], change[3], energy = 0;
    correspondence_half_state(c, c->particles->displacement.row, NULL, slice, slot, lane, state);
    correspondence_elongation(c, slice, slot, lane, change);
    for (int k = 0; k < 3; ++k) energy += 0.5 * state[k] * change[k];
    const double influence = limit->of->value(fmin(1, bond.length / f->horizon), bond.length),
                 corrected = bond.weight / c->particles->volume[bond.neighbour];
    if (energy * influence >= limit->half * (1 - 1e-9) * corrected) return true;
  }
  return false;
}

double correspondence_energy_room(const void *formulation, int64_t slice, const EnergyLimit *limit, uint8_t *found)
{
  const Correspondence *c = formulation;
  *found = c->particles->free_strain || any_beyond(c, slice, limit); /* which may change without any motion */
  for (int lane = 0; lane < SLICE && !*found; ++lane)
    if (c->shapes.mode[slice * SLICE + lane] == SHAPE_AXIAL) *found = any_axial_beyond(c, slice, lane, limit);
  return 0;
}

/* Bonds whose law has a history: the stretch of each bond goes to its material point, batches of slots of a slice at a time, and what comes
 * back is a stress that acts on c / E times the bond's weight. Both sides of a bond keep its history; they see the same stretches to
 * the last bit and so remember the same. A bond between two materials is half a fibre of each, side by side. */
#include "formulation/bond_based.h"

#include <math.h>

enum { SLOTS = BLOCK / SLICE };

typedef struct Batch {
  double stretch[BLOCK], stress[BLOCK];
  double lever[BLOCK]; /* weight / |y|; of stored slots times the mean c / E */
  double y[3][BLOCK];
} Batch;

/** Stretch and lever of a bond from xi and eta. */
static inline double stretch_of(const double xi[3], const double eta[3], double length, double y[3], double *ratio)
{
  double d = 0;
  for (int k = 0; k < 3; ++k) {
    y[k] = xi[k] + eta[k];
    d += eta[k] * (xi[k] + y[k]);
  }
  d /= length * length;
  *ratio = sqrt(1 + d); /* |y| / |xi| */
  return d / (1 + *ratio);
}

LANES_INLINE void stretch_lattice(const BondBased *b, int64_t slice, int64_t slot, int half, Batch *batch, int at)
{
  const Family *f = b->family;
  const Pattern *row = &f->patterns[f->pattern[slot]];
  const int64_t there = f->base[slot] + LANES * half, here = slice * SLICE + LANES * half;
  Lanes d = {0};
  for (int k = 0; k < 3; ++k) {
    const double *u = b->particles->displacement[k];
    Lanes xi = lanes_set(row->xi[k]), eta = lanes_load(u + there) - lanes_load(u + here), y = xi + eta;
    d += eta * (xi + y);
    lanes_store(batch->y[k] + at, y);
  }
  d = lanes_where(lanes_half(f->intact[slot], half), d) * lanes_set(row->by_square);
  Lanes ratio = lanes_root(lanes_set(1) + d);
  lanes_store(batch->stretch + at, d / (lanes_set(1) + ratio));
  lanes_store(batch->lever + at, lanes_set(row->weight_by_length) / ratio);
}

LANES_INLINE void stretch_stored(const BondBased *b, int64_t slice, int64_t slot, int half, Batch *batch, int at)
{
  Lanes own[3];
  for (int k = 0; k < 3; ++k) own[k] = lanes_load(b->particles->displacement[k] + slice * SLICE + LANES * half);
  BondEnds ends = bond_gather(b, slice, slot, half, own);
  Lanes ratio = lanes_root(lanes_set(1) + ends.d);
  lanes_store(batch->stretch + at, ends.d / (lanes_set(1) + ratio));
  lanes_store(batch->lever + at, ends.constant * ends.weight_by_length / ratio);
  for (int k = 0; k < 3; ++k) lanes_store(batch->y[k] + at, ends.y[k]);
}

/** Makes the mean stress of both halves of a bond, weighted by c / E, out of the stress of its own, where the other end may be of another
 *  material. Broken bonds (with stretch 0) too, so that both their histories stay what they were. @return the place of a failure or -1 */
static int64_t join_stresses(const BondBased *b, int64_t slice, int64_t slot, int lane, double stretch, double *stress)
{
  const Family *f = b->family;
  const int32_t *block = b->particles->block;
  const int64_t other = f->neighbour[(int64_t)f->base[slot] * SLICE + lane] / SLICE;
  if (b->points->material[other] == b->points->material[slice]) return -1;
  double partner, own = b->per_stress[block[slice]], there = b->per_stress[block[other]];
  int64_t bad = points_update_partner(b->points, slice, slot, lane, stretch, &partner);
  *stress = (own * *stress + there * partner) / (own + there);
  return bad;
}

/** @return a place whose law could not be integrated, or -1 */
LANES_INLINE int64_t resist_slice(const BondBased *b, int64_t slice)
{
  const Family *f = b->family;
  const int64_t stored = f->stored[slice], last = f->first[slice + 1];
  const Lanes per_stress = lanes_set(b->per_stress[b->particles->block[slice]]);
  Lanes force[2][3] = {{{0}}};
  int64_t bad = -1;
  Batch batch;
  for (int64_t first = f->first[slice]; first < last && bad < 0; first += SLOTS) {
    const int count = last - first < SLOTS ? (int)(last - first) : SLOTS;
    for (int n = 0; n < count; ++n)
      if (first + n < stored)
        for (int half = 0; half < 2; ++half)
          stretch_lattice(b, slice, first + n, half, &batch, n * SLICE + LANES * half);
      else
        for (int half = 0; half < 2; ++half)
          stretch_stored(b, slice, first + n, half, &batch, n * SLICE + LANES * half);
    bad = points_update_bonds(b->points, slice, first, count, batch.stretch, batch.stress);
    for (int n = 0; n < count * SLICE && b->points->partner_values && bad < 0; ++n)
      if (first + n / SLICE >= stored)
        bad = join_stresses(b, slice, first + n / SLICE, n % SLICE, batch.stretch[n], &batch.stress[n]);
    for (int n = 0; n < count; ++n)
      for (int half = 0; half < 2; ++half) {
        const int at = n * SLICE + LANES * half;
        Lanes pull = lanes_load(batch.stress + at) * lanes_load(batch.lever + at);
        pull = lanes_where(lanes_half(f->intact[first + n], half), pull);
        if (b->surface) pull *= bond_surface(b, first + n, half);
        if (first + n < stored) pull *= per_stress;
        for (int k = 0; k < 3; ++k) force[half][k] += pull * lanes_load(batch.y[k] + at);
      }
  }
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(b->particles->internal[k] + slice * SLICE + LANES * half, force[half][k]);
  return bad;
}

BRECCIA_CLONES
static int64_t resist_points(const BondBased *b, int64_t first, int64_t last)
{
  int64_t failed = -1;
  for (int64_t slice = first; slice < last; ++slice) {
    int64_t bad = resist_slice(b, slice);
    if (failed < 0) failed = bad;
  }
  return failed;
}

int64_t bond_resist_points(const BondBased *b, int64_t first, int64_t last)
{
  return resist_points(b, first, last);
}

double bond_pull(const BondBased *b, int64_t slice, int64_t slot, int lane, const Bond *bond, double y[3])
{
  const int64_t here = slice * SLICE + lane, other = bond->neighbour / SLICE;
  const int32_t *block = b->particles->block;
  double eta[3], ratio;
  for (int k = 0; k < 3; ++k)
    eta[k] = b->particles->displacement[k][bond->neighbour] - b->particles->displacement[k][here];
  double stretch = stretch_of(bond->xi, eta, bond->length, y, &ratio);
  const Points *p = b->points;
  if (b->surface) ratio /= b->surface[slot * SLICE + lane];
  if (p->where == POINTS_NOWHERE)
    return (b->stiffness[block[slice]] + b->stiffness[block[other]]) / 2 * stretch / (bond->length * ratio);
  double own = points_bond_stress(p, slice, slot, lane, false, stretch, NULL), partner = own;
  if (p->material[other] != p->material[slice]) partner = points_bond_stress(p, slice, slot, lane, true, stretch, NULL);
  return (b->per_stress[block[slice]] * own + b->per_stress[block[other]] * partner) / 2 / (bond->length * ratio);
}

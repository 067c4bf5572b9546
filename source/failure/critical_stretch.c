/* A bond breaks when its stretch (|Y| - |xi|) / |xi| exceeds a limit (Silling 2000; docs/theory.md 2). */
#include "failure/failure.h"

#include <math.h>

/** Length that each of four bonds may still grow by; large where there is no intact bond. */
LANES_INLINE Lanes reserve(const Failure *failure, const Family *f, int64_t slot, int64_t place, int half, bool lattice)
{
  const Particles *p = f->particles;
  int64_t base = f->base[slot] + LANES * half, at = (int64_t)f->base[slot] * SLICE + LANES * half;
  const int32_t *index = f->neighbour + at;
  Lanes square = {0}, reference = {0};
  for (int k = 0; k < 3; ++k) {
    const double *u = p->displacement[k], *x = p->position[k];
    Lanes xi =
        lattice ? lanes_set(f->patterns[f->pattern[slot]].xi[k]) : lanes_gather(x, index) - lanes_load(x + place);
    Lanes y = xi + (lattice ? lanes_load(u + base) : lanes_gather(u, index)) - lanes_load(u + place);
    square += y * y;
    reference += xi * xi;
  }
  Lanes limit = lanes_set(failure->limit[failure->material[place / SLICE]]);
  for (int k = 0; !lattice && k < LANES; ++k) limit[k] = failure_limit(failure, place, index[k]);
  Lanes left = (lanes_set(1) + limit) * lanes_root(reference) - lanes_root(square);
  LaneMask intact = lanes_mask((unsigned)f->intact[slot] >> (LANES * half) & 15u);
  return lanes_where(intact, left) + lanes_where(~intact, lanes_set(f->horizon));
}

/* Few bonds are ever near their limit. The sweep finds the smallest reserve of a slice; as a bond grows by no more than its two
 * ends move, half of it may be moved before the slice has to be swept again. Sweeping at every step took a sixth of the time. */
BRECCIA_CLONES
static double suspect(const Failure *failure, const Family *f, int64_t slice, uint8_t *suspects)
{
  Lanes least = lanes_set(f->horizon);
  for (int half = 0; half < SLICE / LANES; ++half) {
    int64_t place = slice * SLICE + LANES * half;
    for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
      least = lanes_least(least, reserve(failure, f, slot, place, half, true));
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      least = lanes_least(least, reserve(failure, f, slot, place, half, false));
  }
  double smallest = least[0];
  for (int k = 1; k < LANES; ++k) smallest = least[k] < smallest ? least[k] : smallest;
  double rounding = 1e-12 * f->horizon;
  *suspects = smallest <= rounding;
  return smallest > rounding ? (smallest - rounding) / 2 : 0;
}

static bool exceeds(const Failure *failure, const Family *f, int64_t slice, const Bond *bond, int lane)
{
  const Particles *p = f->particles;
  int64_t place = slice * SLICE + lane;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    double y = bond->xi[k] + p->displacement[k][bond->neighbour] - p->displacement[k][place];
    square += y * y;
  }
  return sqrt(square) > (1 + failure_limit(failure, place, bond->neighbour)) * bond->length;
}

const Criterion criterion_critical_stretch = {
    .name = "critical stretch",
    .about = "a bond breaks when it is stretched by more than a share of its length",
    .source = "Silling 2000",
    .suspect = suspect,
    .exceeds = exceeds,
};

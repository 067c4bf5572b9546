/* A bond breaks when its stretch (|Y| - |xi|) / |xi| exceeds a limit (Silling 2000; docs/theory.md 2). */
#include "failure/failure.h"

#include <math.h>

LANES_INLINE LaneMask stretched(const Family *f, int64_t slot, int64_t place, int half, bool lattice, double limit)
{
  const Particles *p = f->particles;
  double bound = (1 + limit) * (1 + limit);
  int64_t base = f->base[slot] + LANES * half, at = (int64_t)f->base[slot] * SLICE + LANES * half;
  const int32_t *index = f->neighbour + at;
  Lanes square = {0}, reference = {0};
  for (int k = 0; k < 3; ++k) {
    const double *u = p->displacement[k], *x = p->position[k];
    Lanes xi = lattice ? lanes_set(f->patterns[f->pattern[slot]].xi[k]) : lanes_gather(x, index) - lanes_load(x + place);
    Lanes y = xi + (lattice ? lanes_load(u + base) : lanes_gather(u, index)) - lanes_load(u + place);
    square += y * y;
    reference += xi * xi;
  }
  unsigned bits = (unsigned)f->intact[slot] >> (LANES * half) & 15u;
  return (square > reference * lanes_set(bound)) & lanes_mask(bits);
}

BRECCIA_CLONES
static void suspect(double limit, const Family *f, int64_t first, int64_t last, uint8_t *suspects)
{
  for (int64_t slice = first; slice < last; ++slice) {
    LaneMask any = {0};
    for (int half = 0; half < SLICE / LANES; ++half) {
      int64_t place = slice * SLICE + LANES * half;
      for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
        any |= stretched(f, slot, place, half, true, limit);
      for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
        any |= stretched(f, slot, place, half, false, limit);
    }
    suspects[slice] = (uint8_t)lanes_any(any);
  }
}

static bool exceeds(double limit, const Family *f, int64_t slice, const Bond *bond, int lane)
{
  const Particles *p = f->particles;
  int64_t place = slice * SLICE + lane;
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    double y = bond->xi[k] + p->displacement[k][bond->neighbour] - p->displacement[k][place];
    square += y * y;
  }
  return sqrt(square) > (1 + limit) * bond->length;
}

const Criterion criterion_critical_stretch = {
    .name = "critical stretch",
    .about = "a bond breaks when it is stretched by more than a share of its length",
    .source = "Silling 2000",
    .suspect = suspect,
    .exceeds = exceeds,
};

/* Bonds that no criterion breaks: near grips, and where the deck says so. */
#include "domain/domain.h"

#include <math.h>
#include <stdlib.h>

static int make_room(Domain *d, Error *error)
{
  if (!d->failure.kept) d->failure.kept = memory_zeroed((size_t)d->particles->places, 1, "kept bonds", error);
  return d->failure.kept ? BRECCIA_OK : BRECCIA_FAILURE;
}

int domain_hold_grips(Domain *d, const uint8_t *held, Error *error)
{
  const Particles *p = d->particles;
  const Family *f = &d->family;
  if (make_room(d, error)) return BRECCIA_FAILURE;
  uint8_t *kept = d->failure.kept;
  for (int64_t slice = 0; slice < p->slices; ++slice)
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane)
        if (held[slice * SLICE + lane] && (f->intact[slot] >> lane & 1))
          kept[family_bond(f, slice, slot, lane).neighbour] |= KEPT_GRIPS;
  for (int64_t place = 0; place < p->places; ++place)
    if (held[place]) kept[place] |= KEPT_GRIPS;
  return BRECCIA_OK;
}

typedef struct Centre {
  double x[3];
} Centre;

static int by_x(const void *a, const void *b)
{
  const double x = ((const Centre *)a)->x[0], y = ((const Centre *)b)->x[0];
  return x < y ? -1 : x > y;
}

/** Whether a point lies within a distance of one of the centres, which are sorted by x. */
static bool is_near(const Centre *centres, int64_t count, const double point[3], double distance)
{
  int64_t low = 0, high = count;
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (centres[middle].x[0] < point[0] - distance)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < count && centres[low].x[0] <= point[0] + distance; ++low) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (centres[low].x[k] - point[k]) * (centres[low].x[k] - point[k]);
    if (square <= distance * distance) return true;
  }
  return false;
}

int domain_keep_within(Domain *d, const uint8_t *marked, double distance, Error *error)
{
  const Particles *p = d->particles;
  const double reach = distance + 1e-9 * d->body.largest_spacing;
  int64_t count = 0;
  Centre *centres = memory_zeroed((size_t)p->count, sizeof *centres, "kept bonds", error);
  if (!centres || make_room(d, error)) {
    free(centres);
    return BRECCIA_FAILURE;
  }
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    if (marked[i]) centres[count++] = (Centre){{p->position[0][i], p->position[1][i], p->position[2][i]}};
  }
  qsort(centres, (size_t)count, sizeof *centres, by_x);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const double point[3] = {p->position[0][i], p->position[1][i], p->position[2][i]};
    if (marked[i] || (distance > 0 && is_near(centres, count, point, reach))) d->failure.kept[i] |= KEPT_WITHIN;
  }
  free(centres);
  return BRECCIA_OK;
}

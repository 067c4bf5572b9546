#include "family/surroundings.h"

#include "base/team.h"
#include <stdlib.h>
#include <string.h>

/** Goes through the ends of all stored bonds of a slice, of those that are broken, too: calls of them that come first.
 *  @param[in,out] seen  [places] the last slice around which a place was seen, + 1
 *  @param[out] places  NULL: they are counted only
 *  @return how many */
static int64_t find(const Family *f, int64_t slice, int32_t *seen, int32_t *places)
{
  int64_t count = 0;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int32_t there = f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
      if (there == slice * SLICE + lane || seen[there] == slice + 1) continue;
      seen[there] = (int32_t)slice + 1;
      if (places) places[count] = there;
      ++count;
    }
  return count;
}

static int ascending(const void *a, const void *b)
{
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return x < y ? -1 : x > y;
}

void surroundings_renew(Surroundings *s, const Family *family, int64_t slice)
{
  const Family *f = family;
  const int64_t begin = s->first[slice], count = s->first[slice + 1] - begin;
  memset(s->lanes + begin, 0, (size_t)count);
  if (s->scale) memset(s->scale + begin * SLICE, 0, (size_t)count * SLICE * sizeof *s->scale);
  for (int lane = 0; lane < SLICE; ++lane) {
    int64_t n = begin; /* neighbours of a lane ascend but for a turn or two */
    int32_t before = -1;
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int64_t at = (int64_t)f->base[slot] * SLICE + lane;
      const int32_t there = f->neighbour[at];
      if (there < before) n = begin;
      while (s->place[n] != there) ++n;
      before = there;
      s->lanes[n] |= (uint8_t)(1u << lane);
      if (s->scale) s->scale[n * SLICE + lane] = f->scale[at];
    }
  }
}

typedef struct Making {
  Surroundings *s;
  const Family *family;
} Making;

static void order(void *context, int64_t slice)
{
  const Making *m = context;
  const int64_t begin = m->s->first[slice];
  qsort(m->s->place + begin, (size_t)(m->s->first[slice + 1] - begin), sizeof *m->s->place, ascending);
  surroundings_renew(m->s, m->family, slice);
}

int surroundings_create(Surroundings *s, const Family *family, Error *error)
{
  static const char *const label = "surroundings of particles";
  const int64_t slices = family->particles->slices;
  *s = (Surroundings){0};
  int32_t *seen = memory_zeroed((size_t)family->particles->places, sizeof *seen, label, error);
  s->first = memory_zeroed((size_t)slices + 1, sizeof *s->first, label, error);
  if (!seen || !s->first) {
    free(seen);
    return BRECCIA_FAILURE;
  }
  for (int64_t slice = 0; slice < slices; ++slice)
    s->first[slice + 1] = s->first[slice] + find(family, slice, seen, NULL);
  const size_t count = (size_t)s->first[slices];
  s->place = memory_zeroed(count + SURROUNDINGS_AHEAD, sizeof *s->place, label, error);
  s->lanes = memory_zeroed(count, 1, label, error);
  if (family->scale) s->scale = memory_zeroed(count * SLICE, sizeof *s->scale, label, error);
  const int failed = !s->place || !s->lanes || (family->scale && !s->scale);
  memset(seen, 0, (size_t)family->particles->places * sizeof *seen);
  for (int64_t slice = 0; slice < slices && !failed; ++slice) find(family, slice, seen, s->place + s->first[slice]);
  free(seen);
  if (failed) return BRECCIA_FAILURE;
  team_each(slices, order, &(Making){s, family});
  return BRECCIA_OK;
}

void surroundings_destroy(Surroundings *s)
{
  free(s->first);
  free(s->place);
  free(s->lanes);
  free(s->scale);
  *s = (Surroundings){0};
}

size_t surroundings_bytes(const Surroundings *s, const Family *family)
{
  const size_t slices = (size_t)family->particles->slices;
  if (!s->first) return 0;
  return (slices + 1) * sizeof *s->first +
         (size_t)s->first[slices] * (sizeof *s->place + 1 + (s->scale ? SLICE * sizeof *s->scale : 0));
}

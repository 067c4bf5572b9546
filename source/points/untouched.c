/* Points that remember nothing yet: their histories are as their law began them. Most bonds of a body that cracks stay so, and moving their
 * histories takes more time than their law. Rows are marked in groups; laws see one history as it begins in the place of those of all rows of
 * a marked group, and what they write counts only if it differs. What stands in `committed` and `trial` is the same then, so that nobody else needs to
 * know; and where laws begin with zeros, histories take memory only where something has happened. */
#include "constitutive/min_max.h"
#include "points/points_parts.h"

#include <stdlib.h>
#include <string.h>

enum { GROUP = 64, MOST_VALUES = 4 }; /* rows; longer histories are compared at a cost that laws feel */

struct Untouched {
  uint8_t *groups; /* [count / GROUP + 1] 1: all rows of it */
  double **begin;  /* [materials][BATCH][history_values], or NULL: rows of this material are not looked after */
  int material_count;
};

static size_t group_count(const Points *points)
{
  return (size_t)(points->count / GROUP) + 1;
}

int untouched_create(Points *points, Error *error)
{
  Untouched *u = points->untouched = memory_zeroed(1, sizeof *u, "histories", error);
  if (!u) return BRECCIA_FAILURE;
  u->material_count = points->material_count;
  u->begin = memory_zeroed((size_t)points->material_count, sizeof *u->begin, "histories", error);
  u->groups = memory_zeroed(group_count(points), 1, "histories", error);
  if (!u->begin || !u->groups) return BRECCIA_FAILURE;
  for (int k = 0; k < points->material_count; ++k) {
    const Material *m = &points->materials[k];
    if (m->remote || material_takes_places(m) || m->history_values < 1 || m->history_values > MOST_VALUES) continue;
    u->begin[k] = memory_zeroed((size_t)(BATCH * m->history_values), sizeof(double), "histories", error);
    if (!u->begin[k]) return BRECCIA_FAILURE;
    for (int i = 0; i < BATCH && m->law->begin; ++i)
      m->law->begin(m->constants, u->begin[k] + (ptrdiff_t)i * m->history_values);
  }
  memset(u->groups, 1, group_count(points));
  return BRECCIA_OK;
}

void untouched_destroy(Points *points)
{
  Untouched *u = points->untouched;
  for (int k = 0; u && u->begin && k < u->material_count; ++k) free(u->begin[k]);
  if (u) free(u->begin);
  if (u) free(u->groups);
  free(u);
  points->untouched = NULL;
}

/* Two threads may have rows in one group: each finds the mark good for its own rows, or takes the longer way to the same bits. */
static bool is_marked(const Untouched *u, int64_t group)
{
  return __atomic_load_n(&u->groups[group], __ATOMIC_RELAXED);
}

static void unmark(Untouched *u, int64_t first, int64_t count)
{
  for (int64_t g = first / GROUP; g <= (first + count - 1) / GROUP; ++g)
    __atomic_store_n(&u->groups[g], 0, __ATOMIC_RELAXED);
}

void untouched_find(Points *points)
{
  Untouched *u = points->untouched;
  if (!u) return;
  memset(u->groups, 1, group_count(points));
  for (int64_t n = 0; n < points->run_count; ++n) {
    const PointsRun *run = &points->runs[n];
    const int values = points->materials[run->material].history_values;
    const double *begin = u->begin[run->material], *row = points->committed + points->history_first[n];
    for (int64_t i = 0; begin && i < run->count; ++i)
      if (memcmp(row + i * values, begin, sizeof(double) * (size_t)values)) unmark(u, run->first + i, 1);
  }
}

void untouched_leave(const Points *points, int64_t row)
{
  if (points->untouched) unmark(points->untouched, row, 1);
}

bool untouched_batch(const Points *points, int material, int64_t first, int count, breccia_batch *batch, double *trial)
{
  const Untouched *u = points->untouched;
  const double *begin = u ? u->begin[material] : NULL;
  if (!begin) return false;
  for (int64_t g = first / GROUP; g <= (first + count - 1) / GROUP; ++g)
    if (!is_marked(u, g)) return false;
  const size_t size = sizeof(double) * (size_t)count * (size_t)points->materials[material].history_values;
  memcpy(trial, begin, size);
  batch->committed = begin;
  batch->trial = trial;
  return true;
}

void untouched_keep(Points *points, int material, int64_t first, int count, const double *trial, double *own)
{
  Untouched *u = points->untouched;
  const size_t size = sizeof(double) * (size_t)count * (size_t)points->materials[material].history_values;
  if (!memcmp(trial, u->begin[material], size)) return;
  memcpy(own, trial, size);
  unmark(u, first, count);
}

/* What holds of points at any time, line by line. */
#include "points/points.h"

#include <stddef.h>

bool points_is_valid(const Points *points)
{
  int64_t row = 0, number = 0;
  bool linear = true;
  if (!points->components) return true; /* all laws are linear: there is nothing to keep */
  for (int64_t n = 0; n < points->run_count; ++n) {
    const PointsRun *run = &points->runs[n];
    if (run->first < row || run->count < 0) return false; /* in order; rows between them are other regions' */
    if (run->material < 0 || run->material >= points->material_count) return false;
    const Material *m = &points->materials[run->material];
    if (m->law->components != points->components) return false;
    linear &= m->law->linear != 0;
    if (points->history_first[n] != number) return false;
    row = run->first + run->count;
    number += run->count * m->history_values;
  }
  if (row != points->count || number > (int64_t)points->history_size) return false;
  if (number && (!points->committed || !points->trial || points->committed == points->trial)) return false;
  for (int k = 0; k < 6 && points->components == 6; ++k)
    if (!points->strain[k] != !points->stress[5] || (!points->strain[k] && !linear)) return false;
  return true;
}

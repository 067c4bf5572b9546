/* Sums of histories. */
#include "loading/history/parts.h"

static double factor(const History *h, double time)
{
  double sum = 0;
  for (int k = 0; k < h->part_count; ++k) sum += history_factor(&h->parts[k], time);
  return sum;
}

const HistoryType sum_history = {.create = parts_create, .factor = factor, .corner = parts_corner, .rise = parts_rise};

/* Products of histories. */
#include "loading/history/parts.h"

static double factor(const History *h, double time)
{
  double product = 1;
  for (int k = 0; k < h->part_count; ++k) product *= history_factor(&h->parts[k], time);
  return product;
}

const HistoryType product_history = {
    .create = parts_create, .factor = factor, .corner = parts_corner, .rise = parts_rise};

#include "loading/history.h"

#include <math.h>

/* `constant: no` is the full value too: there is nothing else that it could mean. */
static double factor(const History *h, double time)
{
  (void)h;
  (void)time;
  return 1;
}

static double integral(const History *h, double scale, double time)
{
  (void)h;
  return scale * time;
}

static double corner(const History *h, double time)
{
  (void)h;
  (void)time;
  return INFINITY;
}

static double rise(const History *h)
{
  (void)h;
  return 0;
}

const HistoryType constant_history = {.factor = factor, .integral = integral, .corner = corner, .rise = rise};

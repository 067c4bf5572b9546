#include "loading/history.h"

#include <math.h>

static double factor(const History *h, double time)
{
  return fmax(0, fmin(1, time / h->value->number));
}

static double integral(const History *h, double scale, double time)
{
  const double end = fmin(time, h->value->number);
  const double sum = end * (factor(h, 0) + factor(h, end)) / 2;
  return scale * (sum + (time - end) * (factor(h, end) + factor(h, time)) / 2);
}

static double corner(const History *h, double time)
{
  return time < h->value->number ? h->value->number : INFINITY;
}

static double rise(const History *h)
{
  return h->value->number;
}

const HistoryType ramp_history = {.factor = factor, .integral = integral, .corner = corner, .rise = rise};

#include "loading/history.h"

#include <math.h>

/** Loads without a history of their own may grow so, too. */
static double end_of(const History *h)
{
  return h->value ? h->value->number : h->grown;
}

static double factor(const History *h, double time)
{
  return fmax(0, fmin(1, time / end_of(h)));
}

static double integral(const History *h, double scale, double time)
{
  const double end = fmin(time, end_of(h));
  const double sum = end * (factor(h, 0) + factor(h, end)) / 2;
  return scale * (sum + (time - end) * (factor(h, end) + factor(h, time)) / 2);
}

static double corner(const History *h, double time)
{
  return time < end_of(h) ? end_of(h) : INFINITY;
}

static double rise(const History *h)
{
  return end_of(h);
}

const HistoryType ramp_history = {.factor = factor, .integral = integral, .corner = corner, .rise = rise};

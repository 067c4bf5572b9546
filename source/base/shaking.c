#include "base/shaking.h"

#include <math.h>

void shaking_integrate(const Shaking *s, double *velocities, double *displacements)
{
  velocities[0] = displacements[0] = 0;
  for (int k = 1; k < s->count; ++k) {
    const double h = s->times[k] - s->times[k - 1], a = s->values[k - 1], b = s->values[k];
    displacements[k] = displacements[k - 1] + h * velocities[k - 1] + h * h * (2 * a + b) / 6;
    velocities[k] = velocities[k - 1] + h * (a + b) / 2;
  }
}

void shaking_squares(const Shaking *s, double *sums)
{
  sums[0] = 0;
  for (int k = 1; k < s->count; ++k) {
    const double h = s->times[k] - s->times[k - 1], a = s->values[k - 1], b = s->values[k];
    sums[k] = sums[k - 1] + h * (a * a + a * b + b * b) / 3;
  }
}

double shaking_time_of(const double *times, const double *sums, int count, double share)
{
  const double wanted = share * sums[count - 1];
  if (!(sums[count - 1] > 0)) return NAN;
  int k = 1;
  while (k < count - 1 && sums[k] < wanted) ++k;
  const double rise = sums[k] - sums[k - 1];
  return rise > 0 ? times[k - 1] + (times[k] - times[k - 1]) * (wanted - sums[k - 1]) / rise : times[k];
}

typedef struct Oscillator {
  double omega, swinging, damping;  /* frequency without damping and with it; share of the critical one */
  double step, decay, cosine, sine; /* of the step last taken */
  double x, v;
  Response most;
} Oscillator;

static void choose_step(Oscillator *o, double step)
{
  if (step == o->step) return;
  o->step = step;
  o->decay = exp(-o->damping * o->omega * step);
  o->cosine = cos(o->swinging * step);
  o->sine = sin(o->swinging * step);
}

/** A step in which the base goes from acceleration `a` to `b`: what follows the straight line, and what swings about that. */
static void take_step(Oscillator *o, double a, double b)
{
  const double w = o->omega, slope = (b - a) / o->step, lag = 2 * o->damping * slope / (w * w * w),
               turn = slope / (w * w);
  const double c = o->x + a / (w * w) - lag, s = (o->v + turn + o->damping * w * c) / o->swinging;
  const double swing = o->decay * (c * o->cosine + s * o->sine), across = o->decay * (s * o->cosine - c * o->sine);
  o->x = swing - b / (w * w) + lag;
  o->v = o->swinging * across - o->damping * w * swing - turn;
  o->most.displacement = fmax(o->most.displacement, fabs(o->x));
  o->most.velocity = fmax(o->most.velocity, fabs(o->v));
  o->most.acceleration = fmax(o->most.acceleration, fabs(w * w * o->x + 2 * o->damping * w * o->v));
}

Response shaking_response(const Shaking *s, double period, double damping)
{
  enum { LOOKS = 60 };
  const double omega = 2 * acos(-1) / period;
  Oscillator o = {.omega = omega, .swinging = omega * sqrt(1 - damping * damping), .damping = damping};
  for (int k = 1; k < s->count; ++k) {
    const double whole = s->times[k] - s->times[k - 1], a = s->values[k - 1], b = s->values[k];
    const double pieces = ceil(LOOKS * whole / period);
    choose_step(&o, whole / pieces);
    for (double n = 0; n < pieces; ++n) take_step(&o, a + (b - a) * n / pieces, a + (b - a) * (n + 1) / pieces);
  }
  choose_step(&o, period / LOOKS);
  for (int n = 0; n < LOOKS; ++n) take_step(&o, 0, 0);
  return o.most;
}

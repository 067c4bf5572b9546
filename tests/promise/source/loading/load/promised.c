/* A load as somebody would add one. */
#include "loading/load/load_parts.h"

static void force(const Load *load, Particles *p, double factor)
{
  double uniform[3];
  for (int k = 0; k < 3; ++k) uniform[k] = factor * load->value->point[k];
  load_push(load, p, uniform, (double[3]){0});
}

const LoadType promised_load = {.vector = load_point, .force = force, .magnitude = load_length};

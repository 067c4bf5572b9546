#include "loading/load/load_parts.h"

static void force(const Load *load, Particles *p, double factor)
{
  double per_density[3];
  for (int k = 0; k < 3; ++k) per_density[k] = factor * load->value->point[k];
  load_push(load, p, (double[3]){0}, per_density);
}

const LoadType gravity_load = {.everywhere = true, .vector = load_point, .force = force, .magnitude = load_length};

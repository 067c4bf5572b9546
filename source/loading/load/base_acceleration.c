/* Moving frame: in axes that move with the ground by a(t), a mass m feels the force -m a besides all others. */
#include "loading/load/load_parts.h"

static void force(const Load *load, Particles *p, double factor)
{
  double per_density[3];
  for (int k = 0; k < 3; ++k) per_density[k] = -factor * load->value->point[k];
  load_push(load, p, (double[3]){0}, per_density);
}

const LoadType base_acceleration_load = {
    .everywhere = true, .vector = load_point, .force = force, .magnitude = load_length};

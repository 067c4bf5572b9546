#include "loading/load/load_parts.h"

static void force(const Load *load, Particles *p, double factor)
{
  double per_density[3];
  for (int k = 0; k < 3; ++k) per_density[k] = factor * load->value->point[k];
  load_push(load, p, (double[3]){0}, per_density);
}

static LoadWords tell(const Load *load, const Particles *p)
{
  double mass = 0;
  for (int64_t n = 0; n < load->selection.count; ++n)
    mass += p->density[load->selection.places[n]] * p->volume[load->selection.places[n]];
  return load_force_in_all(mass * load_length(load->value), load->value->point);
}

const LoadType gravity_load = {
    .everywhere = true, .vector = load_point, .force = force, .tell = tell, .magnitude = load_length};

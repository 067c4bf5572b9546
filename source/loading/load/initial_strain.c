#include "loading/load.h"

static int create(Load *load, const LoadMaking *making)
{
  return load_is_known(load, making, "initial strain");
}

static void strain(const Load *load, const LoadStrains *strains, double factor)
{
  for (int64_t n = 0; n < load->selection.count; ++n)
    strains->of_places[load->selection.places[n]] += factor * load->value->number;
}

static double magnitude(const LoadValue *value)
{
  return value->number;
}

const LoadType initial_strain_load = {.everywhere = true, .create = create, .strain = strain, .magnitude = magnitude};

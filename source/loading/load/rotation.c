#include "loading/load/load_parts.h"

static int create(Load *load, const LoadMaking *making)
{
  return load_constrain_rotations(load, making, 0);
}

const LoadType rotation_load = {.create = create, .magnitude = load_length};

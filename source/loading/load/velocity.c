#include "loading/load/load_parts.h"

static int create(Load *load, const LoadMaking *making)
{
  load_constrain_axes(load, making, 1);
  return BRECCIA_OK;
}

const LoadType velocity_load = {
    .platen = true, .may_press = true, .create = create, .vector = load_point, .magnitude = load_length};

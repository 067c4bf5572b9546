#include "loading/load/load_parts.h"

static int create(Load *load, const LoadMaking *making)
{
  if (load_length(load->value) == 0)
    return node_error(making->reader->document, load->node, making->reader->error, "roller: must not be zero");
  load_constrain(load, making, load->value->point, 0, 0);
  return BRECCIA_OK;
}

static double magnitude(const LoadValue *value)
{
  (void)value;
  return 0;
}

const LoadType roller_load = {
    .timeless = true, .may_press = true, .create = create, .vector = load_point, .magnitude = magnitude};

/* A field as somebody would add one. */
#include "results/fields.h"

static void value(const Domain *d, int32_t place, double *value)
{
  *value = d->particles->position[0][place] + d->particles->position[1][place];
}

const OutputField field_promised = {
    .name = "promised field", .dimension = "length", .about = "x + y", .components = 1, .value = value};

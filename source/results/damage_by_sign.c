/* Damage in tension and in compression in one picture of two colours. */
#include "results/fields.h"

#include <math.h>

static double history_of(const Domain *d, int32_t place, const char *name)
{
  const int k = history_field_index(&d->materials[d->material[place / SLICE]], name);
  return k < 0 ? 0 : domain_history(d, place, k);
}

static void value_of(const Domain *d, int32_t place, double *value)
{
  const double tensile = history_of(d, place, "tensile damage"),
               compressive = history_of(d, place, "compressive damage");
  *value = tensile >= compressive ? tensile : -compressive;
}

const OutputField field_damage_by_sign = {
    .name = "damage by sign",
    .dimension = "1",
    .about = "of laws with a tensile and a compressive damage the larger one, in compression with a minus, so that "
             "pictures show both in two colours; of others 0",
    .components = 1,
    .value = value_of,
    .has_sign = true};

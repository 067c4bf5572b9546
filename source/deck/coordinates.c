#include "deck/coordinates.h"

#include "deck/expression.h"

/** Finds the coordinate x, y or z. @param[in] context  position [m] */
static int coordinates_find(void *context, const char *name, Measure *value, Text *reason)
{
  const double *metres = context;
  if (!name[1] && name[0] >= 'x' && name[0] <= 'z') {
    *value = (Measure){.value = metres[name[0] - 'x'], .power[MEASURE_LENGTH] = 1};
    return 0;
  }
  text_add(reason, "there is no '%s' here; a field knows x, y and z, and variables of the deck as ${%s}", name, name);
  return 1;
}

static bool coordinates_know(void *context, const char *name)
{
  (void)context;
  return !name[1] && name[0] >= 'x' && name[0] <= 'z';
}

int coordinates_evaluate(const char *words, const Units *units, const double position[3], const Dimension *dimension,
                         double *value, Text *reason)
{
  const double metre = units_in_si(units, dimension_find("length"), 1), unit = units_in_si(units, dimension, 1);
  double metres[3];
  size_t where;
  Measure found;
  for (int k = 0; k < 3; ++k) metres[k] = metre * position[k];
  const Names names = {coordinates_find, coordinates_know, metres};
  if (expression_read(words, units, &names, &found, &where, reason)) return 1;
  const Measure wanted = {.power = {dimension->length, dimension->force, dimension->time}};
  const bool plain = measure_is_plain(&found);
  if (!plain && !measure_alike(&found, &wanted)) {
    text_add(reason, "is ");
    measure_describe(&found, reason);
    text_add(reason, ", expected a %s", dimension->name);
    return 1;
  }
  *value = plain ? found.value : found.value / unit;
  return 0;
}

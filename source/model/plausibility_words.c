#include "model/plausibility_parts.h"

#include <stdarg.h>
#include <string.h>

double plausibility_in_si(const breccia_model *model, const char *dimension, double value)
{
  return units_in_si(model->units, dimension_find(dimension), value);
}

void plausibility_say(breccia_model *model, const Node *node, const char *format, ...)
{
  Text words = {0};
  va_list arguments;
  va_start(arguments, format);
  text_add_list(&words, format, arguments);
  va_end(arguments);
  char where[WHERE_SIZE];
  node_where(model->document, node, where, sizeof where);
  text_add_warning(&model->warnings, "%s: %s", where, text_words(&words));
  text_free(&words);
}

bool plausibility_is_kind(const LoadSpec *load, const char *kind)
{
  const char *dimension;
  return !strcmp(load_kind(load, &dimension), kind);
}

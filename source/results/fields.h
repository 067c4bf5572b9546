/* What can be written and drawn of each particle. A new field is one function and one line in the table of fields.c. */
#ifndef BRECCIA_RESULTS_FIELDS_H
#define BRECCIA_RESULTS_FIELDS_H

#include "domain/domain.h"

enum { MOST_COMPONENTS = 9 };

typedef struct OutputField {
  const char *name, *dimension, *about;
  int components;
  const char *const *component_names; /* [components]; NULL for one */
  void (*value)(const Domain *domain, int32_t place, double *value);
} OutputField;

/** @return the k-th field, or NULL after the last */
const OutputField *output_field_at(int k);
const OutputField *output_field_find(const char *name);

/** Index of a named history number of any law of the domain, or -1: such numbers are fields too, one component. */
int history_field_find(const Domain *domain, const char *name);
/** Value of a named history number at a place; 0 where the material has none of that name. */
double history_field_value(const Domain *domain, const char *name, int32_t place);

#endif

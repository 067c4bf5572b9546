/* What can be written and drawn of each particle. A new field is one file and one line in field_list.h. */
#ifndef BRECCIA_RESULTS_FIELDS_H
#define BRECCIA_RESULTS_FIELDS_H

#include "domain/domain.h"

typedef struct OutputField {
  const char *name, *dimension, *about;
  int components;
  const char *const *component_names; /* [components]; NULL for one */
  void (*value)(const Domain *domain, int32_t place, double *value);
  bool has_sign; /* a single number that may well be negative */
} OutputField;

/** @return the k-th field, or NULL after the last */
const OutputField *output_field_at(int k);
const OutputField *output_field_find(const char *name);

/** Place of a named number in a material's history rows, or -1. Such numbers are fields too, of one component. */
int history_field_index(const Material *material, const char *name);
/** Dimension of history number k of a material, "1" of a plain number. */
const char *history_field_dimension(const Material *material, int k);

#endif

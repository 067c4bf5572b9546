/* What can be written and drawn of each element of a reinforcing bar. */
#ifndef BRECCIA_RESULTS_BAR_COLUMNS_H
#define BRECCIA_RESULTS_BAR_COLUMNS_H

#include "bars/bars.h"

typedef struct BarColumn {
  const char *name, *dimension;
  double (*value)(const Bars *bars, int bar, int64_t element); /* as committed */
  bool of_slip;                                                /* only of bars among which one slips */
  bool has_sign;                                               /* it may well be negative */
} BarColumn;

/** @return the k-th column, or NULL after the last; those of slip come last */
const BarColumn *bar_column_at(int k);
const BarColumn *bar_column_find(const char *name);
enum { BAR_STRAIN, BAR_STRESS }; /* indices of the first columns */
/** Their names as a choice of decks. @return the k-th, NULL after the last */
const char *bar_column_name(int k);
/** Whether bars have a column: those of slip only where one slips. */
bool bar_column_is_there(const BarColumn *column, const Bars *bars);

#endif

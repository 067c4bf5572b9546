/* What a curve draws: "watch.column : watch.column", each with or without a minus before it. */
#ifndef BRECCIA_RESULTS_CURVE_NAMES_H
#define BRECCIA_RESULTS_CURVE_NAMES_H

#include "base/text.h"
#include <stdbool.h>

enum { CURVE_NAME = 160, CURVE_COLUMNS = 17 };

typedef struct CurveNames { /* first of the horizontal axis, then of all columns of the vertical one */
  int count;
  bool minus[CURVE_COLUMNS]; /* a minus stands before the name: the column is drawn with the other sign */
  char watch[CURVE_COLUMNS][CURVE_NAME], column[CURVE_COLUMNS][CURVE_NAME];
} CurveNames;

/** Splits the words of a curve; several vertical columns have commas between them.
 *  @return 0, or 1 when they are not names of a watch and a column */
int curve_names(const char *curve, CurveNames *names);

/** Adds why the words of a curve are none and how they should be. */
void curve_advise(const char *curve, Text *text);

#endif

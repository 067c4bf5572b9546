/* Curves over the length of reinforcing bars. */
#ifndef BRECCIA_RESULTS_BAR_CURVE_H
#define BRECCIA_RESULTS_BAR_CURVE_H

#include "results/bar_view.h"
#include <stdbool.h>

enum { BAR_CURVE_TIMES = 6 }; /* more are not told apart */

typedef struct BarCurveOptions {
  const char *column;                    /* bar_columns.h */
  const char *title, *x_label, *y_label; /* NULL: what is drawn */
  const char *log_axes;                  /* as of a curve; NULL: none */
  const char *const *names;              /* [name_count] of bars that are drawn; none: of all */
  int name_count;
  const int *steps; /* [count] of the results */
  int count;
  double low, high; /* ends of the length that is drawn; NaN: all of it */
  bool *no_gnuplot; /* as in PlotOptions */
} BarCurveOptions;

/** Whether a name is that of a line, or of the bar of which it is one of several: 'stirrups 3'. */
bool bar_curve_names(const char *line, const char *name);

/** Draws a column of bars over their length at some steps, of those with the largest values where there are many. @return status */
int bar_curve_draw(const ResultView *view, const BarCurveOptions *options, const char *path, Error *error);

#endif

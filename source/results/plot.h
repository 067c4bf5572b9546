/* Lines and points in a diagram, drawn by gnuplot. */
#ifndef BRECCIA_RESULTS_PLOT_H
#define BRECCIA_RESULTS_PLOT_H

#include "base/error.h"
#include <stdbool.h>

typedef struct PlotLine {
  const char *title;
  const double *x, *y; /* [count]; what is not finite is left out */
  int count;
  bool points; /* instead of a line: measured */
} PlotLine;

typedef struct PlotOptions {
  const char *title, *x_label, *y_label;
  double low, high; /* ends of the horizontal axis; NaN: from the data */
} PlotOptions;

/** @param[in] path  .png, .svg or .pdf */
int plot_draw(const PlotLine *lines, int count, const PlotOptions *options, const char *path, Error *error);

#endif

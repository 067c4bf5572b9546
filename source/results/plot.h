/* Lines and points in a diagram, drawn by gnuplot. */
#ifndef BRECCIA_RESULTS_PLOT_H
#define BRECCIA_RESULTS_PLOT_H

#include "base/error.h"
#include <stdbool.h>

typedef struct PlotLine {
  const char *title;
  const double *x, *y; /* [count]; what is not finite is left out */
  int count;
  bool points;       /* instead of a line: measured */
  int colour, dash;  /* from 0 */
  const bool *apart; /* [count] whether no line leads to a point from the one before; NULL: one leads to each */
} PlotLine;

typedef struct PlotAxis {
  const char *words, *unit; /* unit: of the numbers, "" without; they are drawn in one that reads well */
  const char *label;        /* instead of words and unit; NULL: these */
  bool logarithmic;
} PlotAxis;

typedef struct PlotOptions {
  const char *title;
  PlotAxis x, y;
  double low, high; /* ends of the horizontal axis; NaN: from the data */
  bool *no_gnuplot; /* set where it is not installed, which is said as well; may be NULL */
} PlotOptions;

/** Whether words for axes ("none", "x", "y" or "xy"; NULL: none) name one, 'x' or 'y'. */
bool plot_is_logarithmic(const char *log_axes, char axis);

/** Draws a picture, whole or not at all. @param[in] path  .png, .svg or .pdf */
int plot_draw(const PlotLine *lines, int count, const PlotOptions *options, const char *path, Error *error);

#endif

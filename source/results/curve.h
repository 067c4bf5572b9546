/* Curves of histories, and of measured points. */
#ifndef BRECCIA_RESULTS_CURVE_H
#define BRECCIA_RESULTS_CURVE_H

#include "base/error.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct CurveOptions {
  const char *title, *overlay;   /* overlay: a CSV file whose first two columns are drawn as points, or NULL */
  const char *x_label, *y_label; /* NULL: what the axis shows, and its unit */
  const char *log_axes;          /* of x and y those that are logarithmic; NULL: none */
  double low, high;              /* ends of the horizontal axis; NaN: from the data */
  bool *no_gnuplot;              /* as in PlotOptions */
} CurveOptions;

/** Columns of CSV files against each other; several folders give several lines, named after them.
 *  @param[in] folders  where the history files are
 *  @param[in] curve    "watch.column : watch.column", horizontal then vertical; further vertical ones behind commas
 *  @param[in] path     .png, .svg or .pdf */
int curve_draw(const char *const *folders, int folder_count, const char *curve, const CurveOptions *options,
               const char *path, Error *error);

/** The curve of all energies over time that a folder holds, as curve_draw wants it: every column of energy of the history that has
 *  them. To be freed; NULL with a message if there is none. */
char *curve_of_energies(const char *folder, Error *error);

/** A short file name without ending for a curve: its vertical watch over its horizontal one, or the one watch. */
void curve_name(const char *curve, char *name, size_t size);

/** The first two columns of a CSV file; before the first row of numbers there may be headings. To be freed, also after a failure. */
int curve_points(const char *path, double **x, double **y, int *count, Error *error);

#endif

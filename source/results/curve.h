/* Curves of histories, and of measured points. */
#ifndef BRECCIA_RESULTS_CURVE_H
#define BRECCIA_RESULTS_CURVE_H

#include "base/error.h"

typedef struct CurveOptions {
  const char *title, *overlay; /* overlay: a CSV file whose first two columns are drawn as points, or NULL */
  double low, high;            /* ends of the horizontal axis; NaN: from the data */
} CurveOptions;

/** Columns of CSV files against each other; several folders give several lines.
 *  @param[in] folders  where the history files are
 *  @param[in] curve    "watch.column : watch.column", horizontal then vertical
 *  @param[in] path     .png, .svg or .pdf */
int curve_draw(const char *const *folders, int folder_count, const char *curve, const CurveOptions *options,
               const char *path, Error *error);

/** The first two columns of a CSV file; rows that do not begin with two numbers are headings. To be freed, also after a failure. */
int curve_points(const char *path, double **x, double **y, int *count, Error *error);

#endif

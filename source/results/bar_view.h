/* Bars read back from a result file (bar_states.h). */
#ifndef BRECCIA_RESULTS_BAR_VIEW_H
#define BRECCIA_RESULTS_BAR_VIEW_H

#include "results/result_view.h"

typedef struct BarView {
  int lines;
  int64_t nodes, elements; /* element e of line n joins the nodes e + n and e + n + 1 */
  int64_t *first;          /* [lines + 1] elements of a line */
  double *points;          /* [nodes][3] where they stand before they move */
  const char **name;       /* [lines] */
  char *names;
} BarView;

/** @return BRECCIA_OK; BRECCIA_USER_ERROR after a line where the file holds no bars or is damaged; BRECCIA_FAILURE */
int bar_view_open(BarView *bars, const ResultView *view, Error *error);
void bar_view_close(BarView *bars);
/** A column (bar_columns.h) at one state: [elements], to be freed; NULL after a line that tells which there are, or what is damaged.
 *  @param[out] unit  64 bytes */
double *bar_view_read(const BarView *bars, const ResultView *view, const char *column, int step, char *unit,
                      Error *error);
/** Displacements of nodes: [nodes][3], to be freed; NULL as above. */
double *bar_view_displacements(const BarView *bars, const ResultView *view, int step, Error *error);
/** How far along its line the middle of each element is: [elements], to be freed; NULL: no memory. */
double *bar_view_along(const BarView *bars, Error *error);

#endif

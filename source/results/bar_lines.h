/* Reinforcing bars at the end of a run: a table and lines for ParaView in the folder 'bars'. */
#ifndef BRECCIA_RESULTS_BAR_LINES_H
#define BRECCIA_RESULTS_BAR_LINES_H

#include "domain/domain.h"

/** Writes <folder>/bars/bars.csv, a row an element, and bars.vtp, its lines. Nothing where the body has no bars.
 *  @param[in,out] files  gets a line with the path of each */
int bar_lines_write(const Domain *domain, const char *folder, const Units *units, Text *files, Error *error);

#endif

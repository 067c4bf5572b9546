/* Softened bonds and material points in result files: counts, and the most damaged ones, at each written state.
 *
 * Group Breccia of a file with a law that may be damaged holds two datasets:
 *   SoftenedCounts  [states][3] number of points that may be damaged, are damaged, carry nothing
 *   Softened        [states][SOFTENED_LISTED][7] both particles, damage, opening, position x, y, z; rows without a
 *                   point have particles -1
 * Attributes of SoftenedCounts name the columns and the noun of the points. */
#ifndef BRECCIA_RESULTS_SOFTENED_BONDS_H
#define BRECCIA_RESULTS_SOFTENED_BONDS_H

#include "domain/softened.h"
#include "results/result_view.h"

/** Creates both datasets without rows if a law may be damaged. @param[in] own  group Breccia
 *  @return 0, or 1 when HDF5 refuses */
int softened_bonds_create(hid_t own, const Domain *domain);
/** Writes the damaged points of a domain as those of state number `state`. @return 0, or 1 when HDF5 refuses */
int softened_bonds_write(hid_t own, const Domain *domain, int64_t state);
/** Cuts both datasets to a number of states. @return 0, or 1 when HDF5 refuses */
int softened_bonds_cut(hid_t own, int64_t states);

/** Damaged points of a state of a result file. */
typedef struct SoftenedView {
  SoftenedPoints points;
  char noun[32]; /* plural noun of the points; "" if no law of the run may be damaged, or the file lacks the datasets */
} SoftenedView;

/** Reads the damaged points of the last state of an open file.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR for damaged files, after a message */
int softened_bonds_read(const ResultView *view, SoftenedView *softened, Error *error);

#endif

/* Bars in the result file, in its group Breccia/Bars, with a row for each element at every state:
 *  Points [nodes][3]               where nodes stand before the body moves
 *  Lines [lines + 1]               the first node of each line, and how many nodes there are; elements join neighbours on a line
 *  Names                           of the lines, one after the other, each with a zero at its end
 *  displacement [states nodes][3]  of the nodes
 *  strain, stress ...              [states elements] bar_columns.h, each with its unit */
#ifndef BRECCIA_RESULTS_BAR_STATES_H
#define BRECCIA_RESULTS_BAR_STATES_H

#include "domain/domain.h"
#include <hdf5.h>

/** Makes the group in the group Breccia, where the body has bars. @return 0, or 1 when HDF5 refuses or memory is out, as all of these */
int bar_states_create(hid_t breccia, const Domain *domain, const Units *units, bool single);
/** Writes what bars are like now as a state, if the group is there. @param[in] state  from 0 */
int bar_states_write(hid_t breccia, const Domain *domain, int64_t state);
/** Cuts what is there to a number of states. */
int bar_states_cut(hid_t breccia, const Domain *domain, int64_t states);
/** Numbers that a state has of bars. */
int64_t bar_states_numbers(const Domain *domain);

#endif

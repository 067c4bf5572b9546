/* What is made of a record before it acts: equal steps, a baseline, a band of frequencies, an end at rest. */
#ifndef BRECCIA_LOADING_HISTORY_CORRECTION_H
#define BRECCIA_LOADING_HISTORY_CORRECTION_H

#include "base/signal.h"
#include "loading/history/record.h"

/** The shortest and the longest step between its times, of a record of two rows or more. */
void record_steps(const Record *record, double *shortest, double *longest);

/** Values at equal steps from the first time on, by straight lines, up to the last that the record reaches: below
 * 1e8 of them. */
int record_resample(Record *record, double step, Error *error);

/** Of records with equal steps: signal_take_off and signal_band_pass. */
int record_take_off(Record *record, int degree, Error *error);
int record_band_pass(Record *record, const Band *band, Error *error);

/** Takes off the straight line a + b t with which the integral of the record, straight between its rows, and the integral of that end at 0. */
void record_end_at_rest(Record *record);

#endif

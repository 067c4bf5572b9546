/* Files that hold values in time. */
#ifndef BRECCIA_LOADING_HISTORY_RECORD_H
#define BRECCIA_LOADING_HISTORY_RECORD_H

#include "loading/history.h"

typedef struct Record {
  double *rows; /* [count] time, value; to be freed, after a failure too */
  int count;
} Record;

/** A record of the PEER ground motion database: four lines of heading, the last with the number of values and the time step in seconds
 *  (NPTS= 4000, DT= .005 SEC, or 4000 .005 NPTS, DT), then the values. The first is of time 0. */
int record_read_peer(Record *record, const char *path, const Units *units, Error *error);

/** Rows of two numbers, time and value, parted by blanks, tabs, commas or semicolons; lines that begin with no number are headings and remarks. */
int record_read_plain(Record *record, const char *path, Error *error);

#endif

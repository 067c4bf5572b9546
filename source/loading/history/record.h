/* Files that hold values in time. */
#ifndef BRECCIA_LOADING_HISTORY_RECORD_H
#define BRECCIA_LOADING_HISTORY_RECORD_H

#include "loading/history.h"

typedef struct Record {
  double *rows; /* [count] time, value; to be freed, after a failure too */
  int count;
  bool stepped; /* the file has no times: they are multiples of the step that was given */
} Record;

enum { RECORD_LABEL = 128 };

typedef struct RecordFile {
  const char *path;
  /* Of a CSV file with a heading: the columns of values and of times. Column NULL: the file is recognised by what it
   * holds and by its ending. */
  const char *column, *times;
  double step;        /* between values of a file without times, in the unit of `units`; 0 or NaN: not given */
  int channel;        /* of a file with several, from 1 on; 0: not given */
  const Units *units; /* in whose unit of time the times come out */
} RecordFile;

/** Reads two rows or more with ascending times. Records with a header come out in g, cm/s or cm, whatever the unit of
 *  the file; other values stay as they are. The unit of times may stand behind the name of their column.
 *  @param[out] label  name of the values with their unit in parentheses, as far as the file says it, RECORD_LABEL
 *  bytes; may be NULL */
int record_read(Record *record, const RecordFile *file, char *label, Error *error);

#endif

/* Files that hold values in time. */
#ifndef BRECCIA_LOADING_HISTORY_RECORD_H
#define BRECCIA_LOADING_HISTORY_RECORD_H

#include "loading/history.h"

typedef struct Record {
  double *rows; /* [count] time, value; to be freed, after a failure too */
  int count;
} Record;

enum { RECORD_LABEL = 128 };

typedef struct RecordFile {
  const char *path;
  const char *column,
      *times;         /* of a CSV file with a heading; column NULL: a PEER record by its ending, or two plain columns */
  const Units *units; /* in whose unit of time the times come out */
} RecordFile;

/** Reads two rows or more with ascending times. Values stay in the unit of the file; that of times may stand behind the name of their column.
 *  @param[out] label  name of the values with their unit in parentheses, as far as the file says it, RECORD_LABEL bytes; may be NULL */
int record_read(Record *record, const RecordFile *file, char *label, Error *error);

#endif

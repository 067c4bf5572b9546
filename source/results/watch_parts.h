/* What stands behind the door of histories: what each row holds (watch.c), and the files that rows go to (watch_files.c). */
#ifndef BRECCIA_RESULTS_WATCH_PARTS_H
#define BRECCIA_RESULTS_WATCH_PARTS_H

#include "results/watch.h"
#include "solver/reactions.h"
#include <stdio.h>

typedef struct Watch Watch;
typedef struct Kind {
  const char *columns; /* name:dimension, separated by commas */
  void (*row)(const Watch *watch, const Solver *solver, double *values);
} Kind;

enum { MOST_COLUMNS = 16, WATCH_FILE = 160 }; /* WATCH_FILE: room for the name of a file, without its ending */

struct Watch {
  const WatchSpec *spec;
  const Kind *kind;
  Kind own; /* of histories, whose columns the material names, and of loads */
  char columns[1024];
  int history[MOST_COLUMNS]; /* which numbers they are */
  Selection selection;
  int32_t ends[2];
  const LoadSpec *load;
  int bar;
  int64_t element; /* of it */
  Reactions reactions;
  uint8_t *on; /* [places] of reactions on a selection */
  FILE *file;
  char *path;
  int64_t last_step, bytes; /* of the last row in the file; of the whole file */
  int64_t kept_step, kept_bytes,
      kept_sum; /* the same of what stays when the run is taken up again, and its checksum: a row that is only
                                              written because the run ends does not */
};

struct Watches {
  int count;
  Watch *items;
};

/** How many numbers a row has behind step and time. */
int watch_columns(const Kind *kind);

#endif

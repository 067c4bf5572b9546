/* One deck run several times, with other values under some of its keys. */
#ifndef BRECCIA_MODEL_STUDY_H
#define BRECCIA_MODEL_STUDY_H

#include "base/error.h"
#include "base/text.h"

typedef struct Varied { /* a key of the deck and the values that it takes */
  char *key;
  char **values; /* as they would stand in the deck */
  int count;
} Varied;

typedef struct StudyCase {
  char *folder;          /* of its results */
  const char *name;      /* last part of that: "spacing-5-mm" */
  const char **settings; /* "key.path=value" each: those of all cases, then its own */
  char **own;
  int *which; /* of each varied key: the number of its value */
  char *deck; /* as it is run */
} StudyCase;

typedef struct breccia_study {
  breccia_study_plan plan;
  Varied *varied;
  StudyCase *cases;
  int varied_count, setting_count, count; /* of settings: of one case */
  Text table, files;                      /* of the last report: the readable table; names of the files, a line each */
} Study;

enum { MOST_CASES = 1000 };

/** A varied key in short: its last part, or all of it where another varied key ends in the same. */
const char *study_key(const Study *study, int v);

/** What there is of a case in its folder: BRECCIA_CASE_... */
int study_state(const StudyCase *one);

#endif

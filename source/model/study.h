/* One deck run several times, with other values under some of its keys. */
#ifndef BRECCIA_MODEL_STUDY_H
#define BRECCIA_MODEL_STUDY_H

#include "base/error.h"
#include "base/text.h"
#include <stdbool.h>

typedef struct Varied { /* a key of the deck and the values that it takes */
  char *key;
  char **values; /* as they would stand in the deck */
  int count;
} Varied;

typedef enum CaseState {
  CASE_NEW,     /* nothing of it is there, or of another deck */
  CASE_STOPPED, /* its run ended early and can go on from its checkpoint */
  CASE_FAILED,  /* its run ended early, and from where it ended it would do so again */
  CASE_DONE,
} CaseState;

typedef struct StudyCase {
  char *folder;          /* of its results */
  const char *name;      /* last part of that: "spacing-5-mm" */
  const char **settings; /* "key.path=value" each: those of all cases, then its own */
  char **own;
  int *which; /* of each varied key: the number of its value */
  char *deck; /* as it is run */
} StudyCase;

typedef struct StudyWish {
  const char *deck, *folder;   /* the deck's file; where the cases go */
  const char *const *varied;   /* "key.path=from:to:n" or "key.path=a, b, c" */
  const char *const *settings; /* of all cases */
  const char *const *results;  /* of the table; none: peaks, broken bonds and what the deck's curves show */
  const char *const *curves;   /* drawn for all cases in one picture; none: those of the deck */
  int varied_count, setting_count, result_count, curve_count;
  bool together; /* the first values of all varied keys, then the second ...; else all combinations */
} StudyWish;

typedef struct Study {
  Varied *varied;
  StudyCase *cases;
  int varied_count, setting_count, count; /* of settings: of one case */
} Study;

enum { MOST_CASES = 1000 };

/** Makes the cases and reads the deck of each as far as that goes without a body. Also after a failure to be destroyed.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR with a line for every mistake */
int study_plan(Study *study, const StudyWish *wish, Error *error);
void study_destroy(Study *study);

/** A varied key in short: its last part, or all of it where another varied key ends in the same. */
const char *study_key(const Study *study, int v);

/** What there is of a case in its folder. */
CaseState study_state(const StudyCase *one);

/** What the cases gave, from their folders: table.csv and table.txt in the study's folder, a picture for each curve, and one for each
 *  result over the first varied key where that is a number.
 *  @param[out] table  the readable one
 *  @param[out] files  names of those written, a line each
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR if a result or curve that was asked for is not there */
int study_report(const Study *study, const StudyWish *wish, Text *table, Text *files, Error *error);

#endif

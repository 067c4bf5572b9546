/* The report of a study while it is made: which results, their values, and the pictures of them. */
#ifndef BRECCIA_MODEL_STUDY_REPORT_H
#define BRECCIA_MODEL_STUDY_REPORT_H

#include "model/study.h"
#include "results/curve_names.h"

enum { STUDY_RESULTS = 64, RESULT_WORDS = 160 };

typedef struct StudyResult { /* a column of the table */
  char words[RESULT_WORDS];  /* "peak beam.y", or a name of summary.json */
  int taker;                 /* -1: of summary.json */
  char watch[CURVE_NAME], column[CURVE_NAME];
  char unit[64];
  double *values; /* of each case; NaN: not there */
} StudyResult;

typedef struct StudyReport {
  const Study *study;
  const breccia_study_plan *plan;
  StudyResult results[STUDY_RESULTS];
  int result_count;
  char *curves[STUDY_RESULTS];
  int curve_count;
  int *states;
  Text *files;
} StudyReport;

/** Draws the curves of all cases that are done, one picture for each of `curves`, and adds the files' names. */
int study_draw_curves(StudyReport *report, Error *error);
/** Draws each result over the first varied key, if that takes numbers of one unit, and adds the files' names. */
int study_draw_results(StudyReport *report, Error *error);

#endif

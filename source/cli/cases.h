/* What verbs share that run several cases of a deck. */
#ifndef BRECCIA_CLI_CASES_H
#define BRECCIA_CLI_CASES_H

#include <breccia/breccia.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct CaseJob CaseJob;

typedef struct CaseWork {
  breccia_study *study; /* whose cases are run; `deck` is its deck */
  const char *deck;
  bool again, quiet; /* run those again that are done; print nothing but errors */
  bool may_fail;     /* bodies that fail are what is looked for: how they did stands in their log only */
  int failures;      /* cases that failed, out */
  int refused;       /* of which the deck or its settings are wrong, out */
  int count, job_count, threads;
  CaseJob *jobs;
} CaseWork;

/** Ctrl-C and its like stop cases, which keep what they have done; a second one ends the program. */
void cases_catch_signals(void);
bool cases_interrupted(void);

/** Whether a case ended early because its body could not be brought any further, and not for want of memory, space or a server. */
bool cases_body_failed(const breccia_study *study, int k);

/** Makes the folder of the cases. @return status, after a message */
int cases_make_folder(const char *folder);

/** Opens a file of a folder of results for writing: a regular file. A link is not followed.
 *  @return NULL with the cause in errno */
FILE *cases_open_file(const char *path, bool append);

/** Runs all cases that are not done, some at a time. @param[in] threads  of each; 0: the cores, shared among the jobs */
int cases_run(CaseWork *work, long long jobs, long long threads);

#endif

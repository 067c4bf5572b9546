/* solution.txt: how the equations of each increment were solved, of solvers that solve any. */
#include "model/run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *path_of(const Run *run)
{
  return text_format("%s/solution.txt", run->wish->folder);
}

static int tell_failure(const Run *run, int reason, Error *error)
{
  return error_add(error, BRECCIA_FAILURE, "%s/solution.txt: cannot be written: %s", run->wish->folder,
                   strerror(reason));
}

int run_log_write(Run *run, Error *error)
{
  const Text *lines = &run->model->solver.log;
  if (!lines->length) return BRECCIA_OK;
  if (!run->log) {
    char *path = path_of(run);
    run->log = path ? fopen(path, run->wish->restart ? "a" : "w") : NULL;
    if (path && run->log) text_add(&run->logs, "  %s\n", path);
    free(path);
    if (!run->log) return tell_failure(run, errno, error);
  }
  errno = 0;
  const bool bad = fputs(text_words(lines), run->log) < 0 || fflush(run->log);
  return bad ? tell_failure(run, errno, error) : BRECCIA_OK;
}

int run_log_close(Run *run, Error *error)
{
  const bool bad = run->log && fclose(run->log);
  run->log = NULL;
  return bad ? tell_failure(run, errno, error) : BRECCIA_OK;
}

/* solution.txt: how the equations of each increment were solved, of solvers that solve any. */
#include "model/run.h"

#include "base/regular_file.h"
#include "base/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *path_of(const Run *run)
{
  return text_format("%s/solution.txt", run->wish->folder);
}

static int tell_failure(const Run *run, int reason, Error *error)
{
  return error_add(error, BRECCIA_FAILURE, "%s/solution.txt: cannot be written: %s", run->wish->folder,
                   regular_file_problem(reason));
}

/** Opens it behind what was told up to the checkpoint: the steps behind it will be told again. */
static int open_log(Run *run, Error *error)
{
  struct stat status;
  char *path = path_of(run);
  run->log = path ? regular_file_stream(path, run->wish->restart ? "a" : "w") : NULL;
  bool bad = !run->log || fstat(fileno(run->log), &status);
  if (!bad && status.st_size > run->model->log_bytes) bad = ftruncate(fileno(run->log), run->model->log_bytes) != 0;
  if (!bad) text_add(&run->logs, "  %s\n", path);
  free(path);
  return bad ? tell_failure(run, errno, error) : BRECCIA_OK;
}

int run_log_write(Run *run, bool done, Error *error)
{
  const Text *lines = &run->model->solver.log;
  if (!lines->length) return BRECCIA_OK;
  if (!run->log && open_log(run, error)) return BRECCIA_FAILURE;
  errno = 0;
  const bool bad = fputs(text_words(lines), run->log) < 0 || fflush(run->log);
  if (done) run->model->log_bytes = ftell(run->log);
  return bad ? tell_failure(run, errno, error) : BRECCIA_OK;
}

int run_log_check(const Run *run, Error *error)
{
  struct stat status;
  const int64_t due = run->model->log_bytes;
  char *path = due > 0 ? path_of(run) : NULL;
  const int file = path ? regular_file_open(path, O_RDONLY) : -1;
  int bad = BRECCIA_OK;
  if (path && (file < 0 || fstat(file, &status)))
    bad = error_add(error, BRECCIA_USER_ERROR,
                    "%s: %s; the run goes on from step %lld and needs what was told up to "
                    "there: put the file back, or run without --restart",
                    path, regular_file_problem(errno), (long long)run->model->solver.clock.step);
  else if (path && status.st_size < due)
    bad = error_add(error, BRECCIA_USER_ERROR,
                    "%s: has %lld bytes, but %lld were written before the checkpoint of step "
                    "%lld; put the file back as it was, or run without --restart",
                    path, (long long)status.st_size, (long long)due, (long long)run->model->solver.clock.step);
  if (file >= 0) close(file);
  free(path);
  return bad;
}

int run_log_settle(const Run *run, Error *error)
{
  return run->log && file_settle(fileno(run->log)) ? tell_failure(run, errno, error) : BRECCIA_OK;
}

int run_log_close(Run *run, Error *error)
{
  const bool bad = run->log && fclose(run->log);
  run->log = NULL;
  run->unwritten |= bad;
  return bad ? tell_failure(run, errno, error) : BRECCIA_OK;
}

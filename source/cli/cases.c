/* Cases of a study run in processes of their own: one that fails takes no other with it, and gives back all its memory. */
#include "cases.h"

#include "verbs.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static volatile int interrupted;

/* A second signal ends the program at once. */
static void on_signal(int number)
{
  interrupted = number;
  signal(number, SIG_DFL);
}

/* In a case. Its study may tell it again what it has heard by itself; Ctrl-C twice still ends it at once. */
static void on_word_of_study(int number)
{
  interrupted = number;
}

struct CaseJob {
  pid_t process; /* 0: free */
  int which;
  time_t begun;
};

bool cases_body_failed(const breccia_study *study, int k)
{
  double step;
  return breccia_study_figure(study, k, "failed_step", &step) != 0;
}

FILE *cases_open_file(const char *path, bool append)
{
  const int flags = O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | (append ? O_APPEND : 0),
            number = open(path, flags, 0666);
  struct stat status;
  if (number < 0) return NULL;
  int cause = fstat(number, &status) ? errno : S_ISREG(status.st_mode) ? 0 : ESPIPE;
  if (!cause && !append && ftruncate(number, 0)) cause = errno;
  FILE *file = cause ? NULL : fdopen(number, append ? "a" : "w");
  if (file) return file;
  if (!cause) cause = errno;
  close(number);
  errno = cause;
  return NULL;
}

/** Runs a case to its end. What `breccia run` would print goes into a file beside its results. @return exit status */
static int run_case(const CaseWork *work, int k, const breccia_case *one, bool restart)
{
  char path[PATH_MAX];
  const bool fits = snprintf(path, sizeof path, "%s/log.txt", one->folder) < (int)sizeof path;
  FILE *log = fits && (!mkdir(one->folder, 0777) || errno == EEXIST) ? cases_open_file(path, restart) : NULL;
  if (!log) {
    complain("%s: cannot be written: %s", path, strerror(fits ? errno : ENAMETOOLONG));
    return BRECCIA_USER_ERROR;
  }
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {
      .size = sizeof wishes, .threads = work->threads, .settings = one->settings, .setting_count = one->setting_count};
  breccia_model *model;
  const char *problem = error ? NULL : "out of memory: messages";
  int status = breccia_model_load_file(work->deck, &wishes, &model, error);
  if (!status) {
    const char *overview = breccia_model_overview(model);
    if (!overview) {
      problem = "out of memory: words about the model";
      status = BRECCIA_FAILURE;
    }
    fprintf(log, "%s\n", overview ? overview : "");
    fflush(log);
    const breccia_run wish = {
        .size = sizeof wish, .folder = one->folder, .restart = restart, .interrupted = &interrupted};
    if (!status) status = breccia_model_run(model, &wish, error);
    fprintf(log, "%s\n%s\n", breccia_model_warnings(model), breccia_model_outcome(model));
    breccia_model_destroy(&model);
  }
  const char *words = status && problem ? problem : breccia_error_text(error);
  fprintf(log, "%s\n", words);
  const bool said = status && status != BRECCIA_INTERRUPTED && !(work->may_fail && cases_body_failed(work->study, k));
  if (said) fprintf(stderr, "%s: %s\n", one->name, words);
  breccia_error_destroy(&error);
  const bool bad = ferror(log) != 0;
  if (fclose(log) || bad) {
    complain("%s: cannot be written%s%s", path, bad ? "" : ": ", bad ? "" : strerror(errno));
    if (!status) status = BRECCIA_FAILURE;
  }
  return status == BRECCIA_INTERRUPTED ? 130 : status;
}

static breccia_case case_of(const CaseWork *work, int k)
{
  breccia_case one = {.size = sizeof one};
  breccia_study_case_at(work->study, k, &one);
  return one;
}

static int begin_case(CaseWork *work, CaseJob *job, int k, bool restart)
{
  const breccia_case one = case_of(work, k);
  fflush(NULL);
  const pid_t process = fork();
  if (process < 0) {
    complain("breccia: %s: no process can be started: %s", one.name, strerror(errno));
    return 1;
  }
  if (!process) {
    sigaction(SIGTERM, &(struct sigaction){.sa_handler = on_word_of_study}, NULL);
    _exit(run_case(work, k, &one, restart));
  }
  *job = (CaseJob){process, k, time(NULL)};
  if (!work->quiet) printf("%d of %d: %s%s\n", k + 1, work->count, one.name, restart ? ", from its checkpoint" : "");
  fflush(stdout);
  return 0;
}

/** Waits until a case has ended. */
static void end_case(CaseWork *work)
{
  int status = 0;
  pid_t process;
  do { /* Ctrl-C reaches them by itself, a signal to this process alone does not */
    for (int j = 0; j < work->job_count; ++j)
      if (interrupted && work->jobs[j].process) kill(work->jobs[j].process, SIGTERM);
    process = waitpid(-1, &status, 0);
  } while (process < 0 && errno == EINTR);
  for (int j = 0; j < work->job_count; ++j) {
    CaseJob *job = &work->jobs[j];
    if (process < 0 || job->process != process) continue;
    const breccia_case one = case_of(work, job->which);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    if (WIFSIGNALED(status)) complain("%s: ended by signal %d", one.name, WTERMSIG(status));
    work->failures += code && code != 130;
    work->refused += code == BRECCIA_USER_ERROR;
    if (!work->quiet)
      printf("%d of %d: %s: %s, %ld s\n", job->which + 1, work->count, one.name,
             code == 130 ? "stopped"
             : code      ? "failed"
                         : "done",
             (long)(time(NULL) - job->begun));
    fflush(stdout);
    job->process = 0;
  }
}

static bool is_running(const CaseWork *work)
{
  for (int j = 0; j < work->job_count; ++j)
    if (work->jobs[j].process) return true;
  return false;
}

static void run_all(CaseWork *work)
{
  for (int k = 0; k < work->count && !interrupted; ++k) {
    const breccia_case one = case_of(work, k);
    const int state = work->again ? BRECCIA_CASE_NEW : one.state;
    if (state == BRECCIA_CASE_DONE ||
        (work->may_fail && state == BRECCIA_CASE_FAILED && cases_body_failed(work->study, k))) {
      if (!work->quiet) printf("%d of %d: %s: was done\n", k + 1, work->count, one.name);
      continue;
    }
    CaseJob *free_job = NULL;
    while (!free_job) {
      for (int j = 0; j < work->job_count && !free_job; ++j)
        if (!work->jobs[j].process) free_job = &work->jobs[j];
      if (!free_job) end_case(work);
    }
    if (!interrupted && begin_case(work, free_job, k, state == BRECCIA_CASE_STOPPED)) ++work->failures;
  }
  while (is_running(work)) end_case(work);
}

void cases_catch_signals(void)
{
  struct sigaction action = {.sa_handler = on_signal};
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  struct sigaction before;
  if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN) /* by nohup: to go on without a terminal */
    sigaction(SIGHUP, &action, NULL);
}

bool cases_interrupted(void)
{
  return interrupted;
}

int cases_make_folder(const char *folder)
{
  if (!mkdir(folder, 0777) || errno == EEXIST) return BRECCIA_OK;
  complain("%s: the folder cannot be made: %s", folder, strerror(errno));
  return BRECCIA_USER_ERROR;
}

int cases_run(CaseWork *work, long long jobs, long long threads)
{
  breccia_case one = {.size = sizeof one};
  work->count = 0;
  while (breccia_study_case_at(work->study, work->count, &one)) ++work->count;
  const int all = breccia_threads();
  if (jobs > work->count) jobs = work->count;
  work->job_count = (int)jobs;
  work->threads = threads ? (int)threads : jobs > all ? 1 : (int)(all / jobs);
  work->jobs = calloc((size_t)jobs, sizeof *work->jobs);
  if (!work->jobs) return show(NULL, stderr);
  run_all(work);
  free(work->jobs);
  work->jobs = NULL;
  return BRECCIA_OK;
}

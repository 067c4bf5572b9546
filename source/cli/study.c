/* Cases of a study run in processes of their own: one that fails takes no other with it, and gives back all its memory. */
#include "verbs.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { VARY, TOGETHER, SET, RESULT, CURVE, OUTPUT, JOBS, THREADS, AGAIN, CHECK, QUIET, COUNT };

static const Option options[] = {
    {"vary", "KEY=VALUES",
     "what is varied: body.beam.spacing=2 mm:8 mm:4 (four values), or a list a, b, c; several: all combinations"},
    {"together", NULL,
     "with several --vary: the first values of all, then the second ..., instead of all combinations"},
    SET_OPTION,
    {"result", "NAME",
     "column of the table: peaks.displacement and other numbers of summary.json, 'peak watch.column' (maximum, "
     "minimum, last); several"},
    {"curve", "CURVE", "'watch.column : watch.column' of all cases in one picture (those of the deck); several"},
    {"output", "DIR", "folder of the cases and the table (beside the deck, DECK-study)"},
    {"jobs", "N", "cases at a time (1)"},
    {"threads", "N", "threads of each case (all cores, shared among the jobs)"},
    {"again", NULL, "run cases again that are done"},
    {"check", NULL, "say which cases there are and what would be run; run nothing"},
    {"quiet", NULL, "print the table and errors only"},
    {0},
};

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

typedef struct Job {
  pid_t process; /* 0: free */
  int which;
  time_t begun;
} Job;

typedef struct Work {
  breccia_study *study;
  const char *deck;
  Job *jobs;
  int count, job_count, threads, failures;
  bool again, quiet;
} Work;

/** Runs a case to its end. What `breccia run` would print goes into a file beside its results. @return exit status */
static int run_case(const Work *work, const breccia_case *one, bool restart)
{
  char path[PATH_MAX];
  const bool fits = snprintf(path, sizeof path, "%s/log.txt", one->folder) < (int)sizeof path;
  FILE *log = fits && (!mkdir(one->folder, 0777) || errno == EEXIST) ? fopen(path, restart ? "a" : "w") : NULL;
  if (!log) {
    fprintf(stderr, "%s: cannot be written: %s\n", path, strerror(fits ? errno : ENAMETOOLONG));
    return BRECCIA_USER_ERROR;
  }
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {
      .size = sizeof wishes, .threads = work->threads, .settings = one->settings, .setting_count = one->setting_count};
  breccia_model *model;
  int status = breccia_model_load_file(work->deck, &wishes, &model, error);
  if (!status) {
    status = show(breccia_model_overview(model), log);
    fflush(log);
    const breccia_run wish = {
        .size = sizeof wish, .folder = one->folder, .restart = restart, .interrupted = &interrupted};
    if (!status) status = breccia_model_run(model, &wish, error);
    fprintf(log, "%s\n%s\n", breccia_model_warnings(model), breccia_model_outcome(model));
    breccia_model_destroy(&model);
  }
  const char *words = status && !error ? "out of memory: messages" : breccia_error_text(error);
  fprintf(log, "%s\n", words);
  if (status && status != BRECCIA_INTERRUPTED) fprintf(stderr, "%s: %s\n", one->name, words);
  breccia_error_destroy(&error);
  fclose(log);
  return status == BRECCIA_INTERRUPTED ? 130 : status;
}

static breccia_case case_of(const Work *work, int k)
{
  breccia_case one = {.size = sizeof one};
  breccia_study_case_at(work->study, k, &one);
  return one;
}

static int begin_case(Work *work, Job *job, int k, bool restart)
{
  const breccia_case one = case_of(work, k);
  fflush(NULL);
  const pid_t process = fork();
  if (process < 0) {
    fprintf(stderr, "breccia study: %s: no process can be started: %s\n", one.name, strerror(errno));
    return 1;
  }
  if (!process) {
    sigaction(SIGTERM, &(struct sigaction){.sa_handler = on_word_of_study}, NULL);
    _exit(run_case(work, &one, restart));
  }
  *job = (Job){process, k, time(NULL)};
  if (!work->quiet) printf("%d of %d: %s%s\n", k + 1, work->count, one.name, restart ? ", from its checkpoint" : "");
  fflush(stdout);
  return 0;
}

/** Waits until a case has ended. */
static void end_case(Work *work)
{
  int status = 0;
  pid_t process;
  do { /* Ctrl-C reaches them by itself, a signal to this process alone does not */
    for (int j = 0; j < work->job_count; ++j)
      if (interrupted && work->jobs[j].process) kill(work->jobs[j].process, SIGTERM);
    process = waitpid(-1, &status, 0);
  } while (process < 0 && errno == EINTR);
  for (int j = 0; j < work->job_count; ++j) {
    Job *job = &work->jobs[j];
    if (process < 0 || job->process != process) continue;
    const breccia_case one = case_of(work, job->which);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    if (WIFSIGNALED(status)) fprintf(stderr, "%s: ended by signal %d\n", one.name, WTERMSIG(status));
    work->failures += code && code != 130;
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

static bool is_running(const Work *work)
{
  for (int j = 0; j < work->job_count; ++j)
    if (work->jobs[j].process) return true;
  return false;
}

static void run_cases(Work *work)
{
  for (int k = 0; k < work->count && !interrupted; ++k) {
    const breccia_case one = case_of(work, k);
    const int state = work->again ? BRECCIA_CASE_NEW : one.state;
    if (state == BRECCIA_CASE_DONE) {
      if (!work->quiet) printf("%d of %d: %s: was done\n", k + 1, work->count, one.name);
      continue;
    }
    Job *free_job = NULL;
    while (!free_job) {
      for (int j = 0; j < work->job_count && !free_job; ++j)
        if (!work->jobs[j].process) free_job = &work->jobs[j];
      if (!free_job) end_case(work);
    }
    if (!interrupted && begin_case(work, free_job, k, state == BRECCIA_CASE_STOPPED)) ++work->failures;
  }
  while (is_running(work)) end_case(work);
}

typedef struct Lists { /* of options that may be repeated */
  const char **items[COUNT];
  int count[COUNT];
} Lists;

static void note(void *context, int option, const char *value)
{
  Lists *lists = context;
  lists->items[option][lists->count[option]++] = value;
}

static void list_cases(const Work *work)
{
  static const char *const words[] = {[BRECCIA_CASE_NEW] = "to be run",
                                      [BRECCIA_CASE_STOPPED] = "to go on",
                                      [BRECCIA_CASE_FAILED] = "failed, to be run again",
                                      [BRECCIA_CASE_DONE] = "done"};
  for (int k = 0; k < work->count; ++k) {
    const breccia_case one = case_of(work, k);
    printf("%d of %d: %s: %s\n", k + 1, work->count, one.name, words[one.state]);
  }
}

/** Runs the cases and tells what they gave. */
static int run_study(Work *work, const char *folder, breccia_error *error)
{
  if (mkdir(folder, 0777) && errno != EEXIST) {
    fprintf(stderr, "%s: the folder cannot be made: %s\n", folder, strerror(errno));
    return BRECCIA_USER_ERROR;
  }
  run_cases(work);
  int status = breccia_study_report(work->study, error);
  const char *table = breccia_study_table(work->study), *files = breccia_study_files(work->study);
  printf("%s%s", work->quiet || !*table ? "" : "\n", table);
  if (!work->quiet && *files) printf("\nwritten:\n%s", files);
  if (interrupted) printf("'breccia study' with the same arguments goes on from here\n");
  if (!status && work->failures) status = BRECCIA_FAILURE;
  return interrupted ? 130 : status;
}

static int study_deck(const breccia_study_plan *plan, const char **values, breccia_error *error)
{
  long long jobs = 1, threads = 0;
  if (values[JOBS] && read_whole(values[JOBS], "jobs", 1, &jobs)) return BRECCIA_USER_ERROR;
  if (values[THREADS] && read_whole(values[THREADS], "threads", 1, &threads)) return BRECCIA_USER_ERROR;
  Work work = {.deck = plan->deck, .again = values[AGAIN] != NULL, .quiet = values[QUIET] != NULL};
  int status = breccia_study_create(plan, &work.study, error);
  if (status) return status;
  breccia_case one = {.size = sizeof one};
  while (breccia_study_case_at(work.study, work.count, &one)) ++work.count;
  const int all = breccia_threads();
  if (jobs > work.count) jobs = work.count;
  work.job_count = (int)jobs;
  work.threads = threads ? (int)(threads > 4096 ? 4096 : threads) : jobs > all ? 1 : (int)(all / jobs);
  work.jobs = calloc((size_t)jobs, sizeof(Job));
  if (values[CHECK])
    list_cases(&work);
  else if (work.jobs)
    status = run_study(&work, plan->folder, error);
  else
    status = show(NULL, stderr);
  free(work.jobs);
  breccia_study_destroy(&work.study);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  Lists lists = {0};
  bool full = false;
  for (int k = 0; k < COUNT; ++k) full |= !(lists.items[k] = calloc((size_t)argc + 1, sizeof(char *)));
  if (full) {
    fprintf(stderr, "breccia: out of memory: options\n");
    for (int k = 0; k < COUNT; ++k) free(lists.items[k]);
    return BRECCIA_FAILURE;
  }
  breccia_error *error = breccia_error_create();
  int status = BRECCIA_OK;
  const int first = read_options(argc, argv, verb, values, note, &lists);
  if (first < 0)
    status = first == -2 ? 0 : 2;
  else if (argc - first != 1) {
    fprintf(stderr, "breccia study: give one deck; see 'breccia study --help'\n");
    status = BRECCIA_USER_ERROR;
  } else {
    struct sigaction action = {.sa_handler = on_signal};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction before;
    if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN) /* by nohup: to go on without a terminal */
      sigaction(SIGHUP, &action, NULL);
    char *beside = values[OUTPUT] ? NULL : result_folder(argv[first]), *folder = values[OUTPUT]
                                                                                     ? words_of("%s", values[OUTPUT])
                                                                                 : beside ? words_of("%s-study", beside)
                                                                                          : NULL;
    const breccia_study_plan plan = {.size = sizeof plan,
                                     .deck = argv[first],
                                     .folder = folder,
                                     .varied = lists.items[VARY],
                                     .varied_count = lists.count[VARY],
                                     .settings = lists.items[SET],
                                     .setting_count = lists.count[SET],
                                     .results = lists.items[RESULT],
                                     .result_count = lists.count[RESULT],
                                     .curves = lists.items[CURVE],
                                     .curve_count = lists.count[CURVE],
                                     .together = values[TOGETHER] != NULL};
    status = folder ? study_deck(&plan, values, error) : BRECCIA_FAILURE;
    free(folder);
    free(beside);
  }
  for (int k = 0; k < COUNT; ++k) free(lists.items[k]);
  return fail(error, status);
}

const Verb verb_study = {
    .name = "study",
    .arguments = "DECK --vary KEY=VALUES [options]",
    .about = "run a deck with several values of some of its keys, and compare",
    .options = options,
    .more = "Each case has a folder of its own; those that are done are not run again, and one that was stopped goes "
            "on from its\n"
            "checkpoint. table.csv and table.txt have a row for each case; pictures show the curves of all cases, and "
            "each result\n"
            "over the first varied key.\n"
            "Exit status: 0 all cases done, 1 one or more failed, 2 the deck or the arguments are wrong, 130 stopped.",
    .run = run};

#include "cases.h"
#include "verbs.h"

#include <limits.h>
#include <stdlib.h>

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

typedef struct Lists { /* of options that may be repeated */
  const char **items[COUNT];
  int count[COUNT];
} Lists;

static void note(void *context, int option, const char *value)
{
  Lists *lists = context;
  lists->items[option][lists->count[option]++] = value;
}

static void list_cases(const breccia_study *study)
{
  static const char *const words[] = {[BRECCIA_CASE_NEW] = "to be run",
                                      [BRECCIA_CASE_STOPPED] = "to go on",
                                      [BRECCIA_CASE_FAILED] = "failed, to be run again",
                                      [BRECCIA_CASE_DONE] = "done"};
  breccia_case one = {.size = sizeof one};
  int count = 0;
  while (breccia_study_case_at(study, count, &one)) ++count;
  for (int k = 0; k < count && breccia_study_case_at(study, k, &one); ++k)
    printf("%d of %d: %s: %s\n", k + 1, count, one.name, words[one.state]);
}

/** Runs the cases and tells what they gave. */
static int run_study(CaseWork *work, const char *folder, long long jobs, long long threads, breccia_error *error)
{
  int status = cases_make_folder(folder);
  if (!status) status = cases_run(work, jobs, threads);
  if (status) return status;
  status = breccia_study_report(work->study, error);
  const char *table = breccia_study_table(work->study), *files = breccia_study_files(work->study);
  printf("%s%s", work->quiet || !*table ? "" : "\n", table);
  if (!work->quiet && *files) printf("\nwritten:\n%s", files);
  if (cases_interrupted()) printf("'breccia study' with the same arguments goes on from here\n");
  if (!status && work->failures) status = BRECCIA_FAILURE;
  return cases_interrupted() ? 130 : status;
}

static int study_deck(const breccia_study_plan *plan, const char **values, breccia_error *error)
{
  long long jobs = 1, threads = 0;
  if (values[JOBS] && read_whole(values[JOBS], "jobs", 1, LLONG_MAX, &jobs)) return BRECCIA_USER_ERROR;
  if (values[THREADS] && read_whole(values[THREADS], "threads", 1, INT_MAX, &threads)) return BRECCIA_USER_ERROR;
  CaseWork work = {.deck = plan->deck, .again = values[AGAIN] != NULL, .quiet = values[QUIET] != NULL};
  int status = breccia_study_create(plan, &work.study, error);
  if (status) return status;
  if (values[CHECK])
    list_cases(work.study);
  else
    status = run_study(&work, plan->folder, jobs, threads, error);
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
    cases_catch_signals();
    char *folder = output_folder(values[OUTPUT], argv[first], "-study");
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

#include "verbs.h"

#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { SET, OUTPUT, STEPS, THREADS, RESTART, RESTART_BEFORE, FORCE, TRAP, QUIET };

static const Option options[] = {
    SET_OPTION,
    {"output", "DIR", "folder for the files (a folder beside the deck, named after it)"},
    {"steps", "N", "stop after N steps in all"},
    {"threads", "N", "number of threads (OMP_NUM_THREADS, or one for each core)"},
    {"restart", NULL, "go on from the checkpoint in the folder"},
    {"restart-before", NULL, "go on from the checkpoint before that, which takes its place"},
    {"force", NULL, "accept a time step above the stable one"},
    {"trap", NULL, "fail at the first division by zero, overflow or invalid operation, and say where it is"},
    {"quiet", NULL, "print nothing but errors"},
    {0},
};

/* A second signal ends the program at once; but those that send one to a program and to its group, as `timeout` does, mean one. */
static volatile int interrupted;
static struct timespec interrupted_at;

static void on_signal(int number)
{
  static const double together = 0.5;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double since =
      (double)(now.tv_sec - interrupted_at.tv_sec) + 1e-9 * (double)(now.tv_nsec - interrupted_at.tv_nsec);
  if (!interrupted)
    interrupted_at = now;
  else if (since > together && number != SIGXCPU) { /* which the system sends every second, up to its hard limit */
    signal(number, SIG_DFL);
    raise(number);
  }
  interrupted = 1;
}

static void show_progress(void *context, int64_t step, int64_t steps, double left)
{
  breccia_model *model = *(breccia_model **)context;
  char time[32];
  if (left < 100)
    snprintf(time, sizeof time, "%.0f s", left);
  else if (left < 6000)
    snprintf(time, sizeof time, "%.0f min", left / 60);
  else
    snprintf(time, sizeof time, "%.1f h", left / 3600);
  const char *stage = breccia_model_stage(model);
  const char *event = breccia_model_event(model);
  fprintf(stderr, "\r%3.0f %%  %s%sstep %lld of %lld, %s left%s%s \033[K",
          steps ? 100.0 * (double)step / (double)steps : 100.0, stage, *stage ? ", " : "", (long long)step,
          (long long)steps, time, *event ? "; " : "", event);
}

/** A word as a shell takes it, in quotation marks where it needs them. */
static void print_word(const char *word)
{
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  const bool quoted = !*word || word[strspn(word, plain)];
  if (quoted) putchar('"');
  for (; *word; ++word) {
    if (strchr("\"\\$`", *word)) putchar('\\');
    putchar(*word);
  }
  if (quoted) putchar('"');
}

/** How to go on: the same command with --restart. */
static void tell_restart(const char *deck, const char **values, const DeckSettings *settings)
{
  printf("'breccia run ");
  if (*deck == '-') printf("./");
  print_word(deck);
  for (int k = 0; k < settings->count; ++k) {
    printf(" --set ");
    print_word(settings->items[k]);
  }
  if (values[OUTPUT]) {
    printf(" --output ");
    print_word(values[OUTPUT]);
  }
  printf("%s --restart' goes on from here\n", values[FORCE] ? " --force" : "");
}

static int run_deck(const char *deck, const char **values, const DeckSettings *settings)
{
  long long steps = 0, threads = 0;
  if (values[STEPS] && read_whole(values[STEPS], "steps", 1, LLONG_MAX, &steps)) return 2;
  if (values[THREADS] && read_whole(values[THREADS], "threads", 1, INT_MAX, &threads)) return 2;
  /* From here on: what is stopped while it is still being set up leaves a checkpoint too. */
  struct sigaction action = {.sa_handler = on_signal}, before;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  sigaction(SIGXCPU, &action, NULL); /* the processor time that the system allows is nearly spent */
  if (!sigaction(SIGHUP, NULL, &before) && before.sa_handler != SIG_IGN) /* by nohup: to go on without a terminal */
    sigaction(SIGHUP, &action, NULL);
  breccia_error *error = breccia_error_create();
  const breccia_options wishes = {.size = sizeof wishes,
                                  .threads = (int)threads,
                                  .force = values[FORCE] != NULL,
                                  .trap = values[TRAP] != NULL,
                                  .settings = settings->items,
                                  .setting_count = settings->count};
  breccia_model *model;
  int status = breccia_model_load_file(deck, &wishes, &model, error);
  if (status) return fail(error, status);
  bool quiet = values[QUIET] != NULL, terminal = isatty(STDERR_FILENO);
  if (!quiet) {
    if (*breccia_model_warnings(model)) show(breccia_model_warnings(model), stderr);
    status = show(breccia_model_overview(model), stdout);
    fflush(stdout);
  }
  if (status) {
    breccia_model_destroy(&model);
    return fail(error, status);
  }
  size_t told = strlen(breccia_model_warnings(model));
  char *folder = output_folder(values[OUTPUT], deck, "");
  if (!folder) {
    breccia_model_destroy(&model);
    breccia_error_destroy(&error);
    return BRECCIA_FAILURE;
  }
  const breccia_run wish = {.size = sizeof wish,
                            .folder = folder,
                            .restart = values[RESTART_BEFORE] ? BRECCIA_RESTART_BEFORE
                                       : values[RESTART]      ? BRECCIA_RESTART_LAST
                                                              : BRECCIA_RESTART_NO,
                            .steps = steps,
                            .interrupted = &interrupted,
                            .progress = !quiet && terminal ? show_progress : NULL,
                            .context = &model};
  status = breccia_model_run(model, &wish, error);
  if (!quiet && terminal) fprintf(stderr, "\r\033[K");
  if (!quiet) {
    const char *warnings = breccia_model_warnings(model);
    if (strlen(warnings) > told) show(warnings + told + (warnings[told] == '\n'), stderr);
    if (*breccia_model_outcome(model)) show(breccia_model_outcome(model), stdout);
    if (status == BRECCIA_INTERRUPTED) tell_restart(deck, values, settings);
  }
  breccia_model_destroy(&model);
  free(folder);
  return fail(error, status == BRECCIA_INTERRUPTED ? 130 : status);
}

static int run(int argc, char **argv, const Verb *verb)
{
  return act_on_deck(argc, argv, verb, SET, run_deck);
}

const Verb verb_run = {
    .name = "run",
    .arguments = "DECK [options]",
    .about = "run a deck and write its results, histories and pictures",
    .options = options,
    .more = "Ctrl-C stops cleanly: files are closed and a checkpoint is written, from which --restart goes on.\n"
            "Exit status: 0 done, 1 the computation failed or a file could not be written, 2 the deck or the arguments "
            "are wrong, 130 stopped.",
    .run = run};

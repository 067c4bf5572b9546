/* What a motion is: its intensity, response spectrum and frequencies; of two the transfer function. */
#include "verbs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { COLUMN, BELOW_COLUMN, TIMES, UNIT, STEP, CHANNEL, DAMPING, PERIODS, NUMBER, SMOOTHING, OUTPUT, COUNT };

static const Option options[] = {
    {"column", "NAME", "of a CSV file with a heading, like a history of a run: which column holds the values"},
    {"below-column", "NAME", "the same of BELOW (that of FILE, if BELOW ends in .csv)"},
    {"times", "NAME", "with a column: the one that holds the times (time)"},
    {"unit", "UNIT", "of values where a file does not say it: g, m/s2, or m/s of velocities"},
    {"time-step", "SECONDS", "between values of a file of values alone"},
    {"channel", "N", "of a COSMOS file with several channels: which one (of both files)"},
    {"damping", "SHARE", "of oscillators, of the critical one (0.05)"},
    {"periods", "FROM:TO", "of oscillators, in s (0.01:10)"},
    {"count", "N", "how many periods, at equal ratios (60 in each tenfold)"},
    {"smoothing", "B", "bandwidth of Konno and Ohmachi's window for frequencies; 0: none (40)"},
    {"output", "FOLDER", "for the files (FILE-spectrum beside the file)"},
    {0},
};

static int read_wish(const char **values, breccia_motion_wish *wish)
{
  char tail;
  long long count = 0;
  *wish =
      (breccia_motion_wish){.size = sizeof *wish, .damping = NAN, .shortest = NAN, .longest = NAN, .smoothing = NAN};
  const struct {
    const char *words, *name;
    double *value;
  } numbers[] = {{values[DAMPING], "damping", &wish->damping}, {values[SMOOTHING], "smoothing", &wish->smoothing}};
  for (int k = 0; k < 2; ++k)
    if (numbers[k].words &&
        (sscanf(numbers[k].words, "%lf%c", numbers[k].value, &tail) != 1 || !isfinite(*numbers[k].value))) {
      complain("breccia spectrum: --%s: '%s' is not a number", numbers[k].name, numbers[k].words);
      return 1;
    }
  if (values[PERIODS] && (sscanf(values[PERIODS], "%lf:%lf%c", &wish->shortest, &wish->longest, &tail) != 2 ||
                          !isfinite(wish->shortest) || !isfinite(wish->longest))) {
    complain("breccia spectrum: --periods: '%s' should be two numbers with a colon between", values[PERIODS]);
    return 1;
  }
  if (values[NUMBER] && read_whole(values[NUMBER], "count", 1, 1000000, &count)) return 1;
  wish->periods = (int)count;
  return 0;
}

/** What is said of both files. */
static int read_file_words(const char **values, breccia_motion_file *file)
{
  char tail;
  long long channel = 0;
  *file = (breccia_motion_file){.size = sizeof *file, .times = values[TIMES], .unit = values[UNIT]};
  if (values[STEP] &&
      (sscanf(values[STEP], "%lf%c", &file->step, &tail) != 1 || !(file->step > 0) || !isfinite(file->step))) {
    complain("breccia spectrum: --time-step: '%s' is not a positive number of seconds", values[STEP]);
    return 1;
  }
  if (values[CHANNEL] && read_whole(values[CHANNEL], "channel", 1, 1000, &channel)) return 1;
  file->channel = (int)channel;
  return 0;
}

/** Column of the motion below: its own, or the other's where it is a table too. */
static const char *column_below(const char *path, const char **values)
{
  const char *ending = strrchr(path, '.');
  if (values[BELOW_COLUMN]) return values[BELOW_COLUMN];
  return ending && !strcasecmp(ending, ".csv") ? values[COLUMN] : NULL;
}

/** @param[in] paths  one or two, ending in NULL */
static int look(char **paths, const char **values, breccia_motion_file file, const breccia_motion_wish *wish,
                breccia_error *error)
{
  breccia_motion *motion = NULL, *below = NULL;
  file.path = paths[0];
  file.column = values[COLUMN];
  int status = breccia_motion_load(&file, &motion, error);
  if (!status && paths[1]) {
    file.path = paths[1];
    file.column = column_below(paths[1], values);
    status = breccia_motion_load(&file, &below, error);
  }
  if (!status) status = breccia_motion_analyse(motion, below, wish, error);
  if (!status && fputs(breccia_motion_words(motion), stdout) < 0) status = BRECCIA_FAILURE;
  char *folder = status ? NULL : output_folder(values[OUTPUT], paths[0], "-spectrum");
  if (!status && !folder) status = BRECCIA_FAILURE;
  if (!status) {
    status = breccia_motion_write(motion, folder, error);
    for (const char *line = breccia_motion_files(motion); *line; line += strcspn(line, "\n") + 1)
      printf("%s  %.*s", line == breccia_motion_files(motion) ? "\nwritten:\n" : "", (int)strcspn(line, "\n") + 1,
             line);
  }
  free(folder);
  breccia_motion_destroy(&motion);
  breccia_motion_destroy(&below);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  breccia_motion_wish wish;
  breccia_motion_file file;
  const int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (first == argc) {
    fprintf(stderr,
            "breccia spectrum: give a file, or two of which the first is held over the other; see 'breccia spectrum "
            "--help'\n");
    return 2;
  }
  if (refuse_more(argc, argv, verb, first, 2) || read_wish(values, &wish) || read_file_words(values, &file)) return 2;
  if (values[BELOW_COLUMN] && argc - first < 2) {
    fprintf(stderr, "breccia spectrum: --below-column: there is no second file\n");
    return 2;
  }
  char *paths[] = {argv[first], argc - first == 2 ? argv[first + 1] : NULL, NULL};
  breccia_error *error = breccia_error_create();
  const int status = look(paths, values, file, &wish, error);
  return fail(error, status);
}

const Verb verb_spectrum = {
    .name = "spectrum",
    .arguments = "FILE [BELOW] [options]",
    .about = "peaks, Arias intensity, response spectrum and frequencies of a motion; of two the transfer function",
    .options = options,
    .more = "FILE is a record of PEER (.AT2), the USGS (.smc), COSMOS (.V2) or K-NET (.EW, .NS, .UD), two columns of "
            "times\n"
            "and values, values alone with --time-step, or a CSV file with a heading, like a history of a run, and "
            "--column.\n"
            "Values are accelerations, or velocities, which are differentiated.\n"
            "With BELOW, the motion of the ground below, the ratio of amplitudes of FILE over BELOW is found too.",
    .run = run};

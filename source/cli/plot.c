/* Pictures of results, after a run. */
#include "cli/verbs.h"
#include "results/curve.h"
#include "results/movie.h"
#include "results/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
  FIELD,
  COMPONENT,
  STEP,
  TIME,
  DEFORMED,
  RANGE,
  VIEW,
  BROKEN,
  SIZE,
  MOVIE,
  RATE,
  CURVE,
  ENERGY,
  OVERLAY,
  LOG,
  TITLE,
  X_LABEL,
  Y_LABEL,
  OUTPUT,
  COUNT
};

static const Option options[] = {
    {"field", "NAME", "what the particles are coloured by (octahedral shear stress)"},
    {"component", "NAME", "of a vector or tensor, like x or xy"},
    {"step", "N|last|all", "which written step (last)"},
    {"time", "T", "the written step nearest to this time, in the deck's unit"},
    {"deformed", "SCALE", "scale of the displacements drawn (1; 0 draws the reference shape)"},
    {"range", "LOW:HIGH|each",
     "ends of the colours, in the deck's unit (alike at all times); of the x axis with --curve"},
    {"view", "AZIMUTH:ELEVATION", "where the eye is, in degrees, for bodies in space"},
    {"broken-bonds", NULL, "draw the bonds that have broken"},
    {"size", "PIXELS", "largest width of the body in the picture (640; 460 in space)"},
    {"movie", "FILE.mp4", "all written steps as a movie; needs ffmpeg"},
    {"rate", "N", "with --movie: written steps a second (so that it lasts about ten seconds)"},
    {"curve", "X:Y",
     "instead: columns of histories, like 'opening.distance:pull.value'; more Y behind commas; -Y turns the sign"},
    {"energy", NULL, "instead: all energies over time"},
    {"overlay", "FILE.csv", "with --curve: two columns drawn as points"},
    {"log", "x|y|xy", "with --curve: logarithmic axes"},
    {"title", "WORDS", "over the picture (the deck's title)"},
    {"x-label", "WORDS", "at the horizontal axis"},
    {"y-label", "WORDS", "at the vertical axis"},
    {"output", "FILE", "a .png, .svg or .pdf file (in the result folder's pictures; of several results here)"},
    {0},
};

static int read_pair(const char *words, const char *option, double *a, double *b)
{
  char tail;
  if (sscanf(words, "%lf:%lf%c", a, b, &tail) == 2) return 0;
  fprintf(stderr, "breccia plot: --%s: '%s' should be two numbers with a colon between\n", option, words);
  return 1;
}

static int read_number(const char *words, const char *option, double *value)
{
  char tail;
  if (sscanf(words, "%lf%c", value, &tail) == 1 && isfinite(*value)) return 0;
  fprintf(stderr, "breccia plot: --%s: '%s' is not a number\n", option, words);
  return 1;
}

/** The result file named or in the folder named. To be freed. */
static char *result_path(const char *given)
{
  struct stat status;
  if (!stat(given, &status) && S_ISDIR(status.st_mode)) return text_format("%s/results.vtkhdf", given);
  return text_format("%s", given);
}

static char *folder_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? text_format("%.*s", (int)(slash - path), path) : text_format(".");
}

/** A .png file in the folder of pictures beside a result file. To be freed. */
static char *in_pictures(const char *result, const char *name)
{
  char *folder = folder_of(result), *pictures = folder ? text_format("%s/pictures", folder) : NULL;
  if (pictures) mkdir(pictures, 0777);
  char *file = pictures ? text_format("%s/%s.png", pictures, name) : NULL;
  free(pictures);
  free(folder);
  return file;
}

/** Curves of one result lie with its pictures, those of several in the present folder. */
static int draw_curve(const char *const *results, int count, const char **values, const PictureOptions *o,
                      breccia_error *error)
{
  char *curve = values[ENERGY] ? curve_of_energies(results[0], error) : text_format("%s", values[CURVE]);
  if (!curve) return BRECCIA_USER_ERROR;
  char name[256];
  curve_name(curve, name, sizeof name);
  char *inside = text_format("%s/any", results[0]), *file = NULL;
  if (values[OUTPUT])
    file = text_format("%s", values[OUTPUT]);
  else if (inside)
    file = count == 1 ? in_pictures(inside, name) : text_format("%s.png", name);
  char title[256];
  snprintf(title, sizeof title, "%s", values[TITLE] ? values[TITLE] : "");
  ResultView view;
  char *path = result_path(results[0]);
  breccia_error *ignored = breccia_error_create();
  if (!values[TITLE] && path && !result_view_open(&view, path, ignored)) { /* histories may lie without results */
    if (count == 1) snprintf(title, sizeof title, "%s", view.title);
    result_view_close(&view);
  }
  breccia_error_destroy(&ignored);
  const CurveOptions c = {.title = title,
                          .overlay = values[OVERLAY],
                          .x_label = o->x_label,
                          .y_label = o->y_label,
                          .log_axes = values[LOG],
                          .low = o->low,
                          .high = o->high};
  int status = file ? curve_draw(results, count, curve, &c, file, error) : BRECCIA_FAILURE;
  if (!status) printf("%s\n", file);
  free(path);
  free(inside);
  free(file);
  free(curve);
  return status;
}

static int draw_steps(const char *path, const char **values, const PictureOptions *o, double rate, breccia_error *error)
{
  ResultView view;
  int status = result_view_open(&view, path, error);
  if (status) return status;
  int first = view.steps - 1, last = first;
  const char *wanted = values[STEP] ? values[STEP] : "last";
  double time;
  if (values[TIME]) {
    if (read_number(values[TIME], "time", &time)) status = BRECCIA_USER_ERROR;
    for (int k = 0; !status && k < view.steps; ++k)
      if (fabs(view.times[k] - time) < fabs(view.times[first] - time)) first = last = k;
    if (!status && view.steps && (time < 0 || time > view.times[view.steps - 1] * (1 + 1e-6)))
      status = error_add(error, BRECCIA_USER_ERROR, "--time %s: the run wrote states up to the time %g only",
                         values[TIME], view.times[view.steps - 1]);
  } else if (!strcmp(wanted, "all"))
    first = 0;
  else if (strcmp(wanted, "last")) {
    long long number = 0;
    int found = -1;
    if (read_whole(wanted, "step", 0, &number)) status = BRECCIA_USER_ERROR;
    for (int k = 0; k < view.steps; ++k)
      if (view.step_numbers[k] == number) found = k;
    if (!status && found < 0) {
      enum { SHORT = 20 };
      Text list = {0};
      for (int k = 0; k < view.steps; ++k) {
        if (k && k < view.steps - 1 && view.steps > SHORT) continue;
        text_add(&list, "%s%lld", !k ? "" : view.steps > SHORT ? " ... " : ", ", (long long)view.step_numbers[k]);
      }
      if (view.steps > SHORT) text_add(&list, " (%d states); --time takes the nearest", view.steps);
      status = error_add(error, BRECCIA_USER_ERROR, "step %lld was not written; these were: %s", number,
                         list.length ? list.characters : "none");
      text_free(&list);
    }
    first = last = found;
  }
  if (!status && view.steps == 0) status = error_add(error, BRECCIA_USER_ERROR, "%s: holds no step yet", path);
  PictureSurvey survey;
  const bool each = values[RANGE] && !strcmp(values[RANGE], "each");
  if (!status && values[MOVIE]) {
    status = movie_make(&view, o, each, rate, values[MOVIE], error);
    if (!status) printf("%s\n", values[MOVIE]);
    last = first - 1;
  } else if (!status && !each)
    status = picture_survey(&view, 0, view.steps - 1, false, o, &survey, error);
  for (int k = first; k <= last && !status; ++k) {
    char *file;
    if (values[OUTPUT] && first == last)
      file = text_format("%s", values[OUTPUT]);
    else if (values[OUTPUT]) { /* many steps: the number goes before the ending */
      const char *dot = strrchr(values[OUTPUT], '.');
      int stem = dot ? (int)(dot - values[OUTPUT]) : (int)strlen(values[OUTPUT]);
      file = text_format("%.*s-%06lld%s", stem, values[OUTPUT], (long long)view.step_numbers[k], dot ? dot : ".png");
    } else {
      char name[256];
      picture_name(&view, k, o->field, o->component, true, name, sizeof name);
      file = in_pictures(path, name);
    }
    if (file) status = picture_draw(&view, k, o, each ? NULL : &survey, file, error);
    if (!status) printf("%s\n", file);
    free(file);
  }
  result_view_close(&view);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  const bool curve = values[CURVE] || values[ENERGY];
  if (first >= argc || (argc - first > 1 && !curve)) {
    fprintf(stderr, "breccia plot: give one result folder (several with --curve); see 'breccia plot --help'\n");
    return 2;
  }
  PictureOptions o = {.field = values[FIELD] ? values[FIELD] : "octahedral shear stress",
                      .component = values[COMPONENT],
                      .title = values[TITLE],
                      .x_label = values[X_LABEL],
                      .y_label = values[Y_LABEL],
                      .deformed = 1,
                      .azimuth = NAN,
                      .elevation = NAN,
                      .low = NAN,
                      .high = NAN,
                      .broken_bonds = values[BROKEN] != NULL};
  if (values[DEFORMED] && read_number(values[DEFORMED], "deformed", &o.deformed)) return 2;
  long long size;
  double rate = 0;
  if (values[SIZE] && read_whole(values[SIZE], "size", 50, &size)) return 2;
  if (values[SIZE]) o.size = (double)size;
  if (values[RATE] && (read_number(values[RATE], "rate", &rate) || !(rate > 0 && rate <= 120))) {
    fprintf(stderr, "breccia plot: --rate: written steps a second, above 0 and up to 120\n");
    return 2;
  }
  if (values[RANGE] && strcmp(values[RANGE], "each") && read_pair(values[RANGE], "range", &o.low, &o.high)) return 2;
  if (o.low >= o.high) {
    fprintf(stderr, "breccia plot: --range: the lowest value %g is not below the highest, %g\n", o.low, o.high);
    return 2;
  }
  if (values[VIEW] && read_pair(values[VIEW], "view", &o.azimuth, &o.elevation)) return 2;
  if (values[LOG] && strcmp(values[LOG], "x") && strcmp(values[LOG], "y") && strcmp(values[LOG], "xy")) {
    fprintf(stderr, "breccia plot: --log: '%s' should be x, y or xy\n", values[LOG]);
    return 2;
  }
  if (values[OUTPUT] && !picture_format(values[OUTPUT])) {
    fprintf(stderr, "breccia plot: --output: '%s' should end in .png, .svg or .pdf\n", values[OUTPUT]);
    return 2;
  }
  if (values[MOVIE] && (curve || values[STEP] || values[TIME] || values[OUTPUT])) {
    fprintf(stderr,
            "breccia plot: --movie shows a field at all written steps and names its file itself: leave out %s\n",
            values[OUTPUT] ? "--output"
            : values[STEP] ? "--step"
            : values[TIME] ? "--time"
                           : "--curve and --energy");
    return 2;
  }
  breccia_error *error = breccia_error_create();
  int status;
  if (curve)
    status = draw_curve((const char *const *)argv + first, argc - first, values, &o, error);
  else {
    char *path = result_path(argv[first]);
    status = draw_steps(path, values, &o, rate, error);
    free(path);
  }
  return fail(error, status);
}

const Verb verb_plot = {"plot",
                        "RESULT ... [options]",
                        "draw fields and curves from results",
                        options,
                        "RESULT is a result folder or its results.vtkhdf; several give a line each with --curve.\n"
                        "--range each: every picture has a range of its own.",
                        run};

/* Pictures of results, after a run. */
#include "cli/verbs.h"
#include "results/curve.h"
#include "results/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FIELD, COMPONENT, STEP, TIME, DEFORMED, RANGE, VIEW, BROKEN, SIZE, CURVE, OVERLAY, TITLE, OUTPUT, COUNT };

static const Option options[] = {
    {"field", "NAME", "what the particles are coloured by (octahedral shear stress)"},
    {"component", "NAME", "of a vector or tensor, like x or xy"},
    {"step", "N|last|all", "which written step (last)"},
    {"time", "T", "the written step nearest to this time, in the deck's unit"},
    {"deformed", "SCALE", "scale of the displacements drawn (1; 0 draws the reference shape)"},
    {"range", "LOW:HIGH", "ends of the colour scale; with --curve of the horizontal axis"},
    {"view", "AZIMUTH:ELEVATION", "where the eye is, in degrees, for bodies in space"},
    {"broken-bonds", NULL, "draw the bonds that have broken"},
    {"size", "PIXELS", "largest width of the body in the picture (640)"},
    {"curve", "X:Y", "instead: columns of histories against each other, like 'opening.distance:pull.value'"},
    {"overlay", "FILE.csv", "with --curve: two columns drawn as points"},
    {"title", "WORDS", "with --curve: title of the picture"},
    {"output", "FILE", "a .png, .svg or .pdf file (in the folder's pictures)"},
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

static int draw_steps(const char *path, const char **values, const PictureOptions *o, breccia_error *error)
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
  } else if (!strcmp(wanted, "all"))
    first = 0;
  else if (strcmp(wanted, "last")) {
    long long number = 0;
    int found = -1;
    if (read_whole(wanted, "step", 0, &number)) status = BRECCIA_USER_ERROR;
    for (int k = 0; k < view.steps; ++k)
      if (view.step_numbers[k] == number) found = k;
    if (!status && found < 0) {
      Text list = {0};
      for (int k = 0; k < view.steps; ++k) text_add(&list, "%s%lld", k ? ", " : "", (long long)view.step_numbers[k]);
      status = error_add(error, BRECCIA_USER_ERROR, "step %lld was not written; these were: %s", number,
                         list.length ? list.characters : "none");
      text_free(&list);
    }
    first = last = found;
  }
  if (!status && view.steps == 0) status = error_add(error, BRECCIA_USER_ERROR, "%s: holds no step yet", path);
  for (int k = first; k <= last && !status; ++k) {
    char *file;
    if (values[OUTPUT] && first == last)
      file = text_format("%s", values[OUTPUT]);
    else if (values[OUTPUT]) { /* many steps: the number goes before the ending */
      const char *dot = strrchr(values[OUTPUT], '.');
      int stem = dot ? (int)(dot - values[OUTPUT]) : (int)strlen(values[OUTPUT]);
      file = text_format("%.*s-%06lld%s", stem, values[OUTPUT], (long long)view.step_numbers[k], dot ? dot : ".png");
    } else {
      char words[256], name[256], *folder = folder_of(path);
      snprintf(words, sizeof words, "%s%s%s step %lld", o->field, o->component ? " " : "",
               o->component ? o->component : "", (long long)view.step_numbers[k]);
      text_file_name(words, name, sizeof name);
      char *pictures = text_format("%s/pictures", folder);
      mkdir(pictures, 0777);
      file = text_format("%s/%s.png", pictures, name);
      free(pictures);
      free(folder);
    }
    status = picture_draw(&view, k, o, file, error);
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
  if (first >= argc || (argc - first > 1 && !values[CURVE])) {
    fprintf(stderr, "breccia plot: give one result folder (several with --curve); see 'breccia plot --help'\n");
    return 2;
  }
  PictureOptions o = {.field = values[FIELD] ? values[FIELD] : "octahedral shear stress",
                      .component = values[COMPONENT],
                      .deformed = 1,
                      .azimuth = NAN,
                      .elevation = NAN,
                      .low = NAN,
                      .high = NAN,
                      .broken_bonds = values[BROKEN] != NULL};
  if (values[DEFORMED] && read_number(values[DEFORMED], "deformed", &o.deformed)) return 2;
  long long size;
  if (values[SIZE] && read_whole(values[SIZE], "size", 50, &size)) return 2;
  if (values[SIZE]) o.size = (double)size;
  if (values[RANGE] && read_pair(values[RANGE], "range", &o.low, &o.high)) return 2;
  if (values[VIEW] && read_pair(values[VIEW], "view", &o.azimuth, &o.elevation)) return 2;
  if (values[OUTPUT] && !picture_format(values[OUTPUT])) {
    fprintf(stderr, "breccia plot: --output: '%s' should end in .png, .svg or .pdf\n", values[OUTPUT]);
    return 2;
  }
  breccia_error *error = breccia_error_create();
  int status;
  if (values[CURVE]) {
    const char *file = values[OUTPUT] ? values[OUTPUT] : "curve.png";
    const CurveOptions c = {values[TITLE] ? values[TITLE] : values[CURVE], values[OVERLAY], o.low, o.high};
    status = curve_draw((const char *const *)argv + first, argc - first, values[CURVE], &c, file, error);
    if (!status) printf("%s\n", file);
  } else {
    char *path = result_path(argv[first]);
    status = draw_steps(path, values, &o, error);
    free(path);
  }
  return fail(error, status);
}

const Verb verb_plot = {"plot",
                        "RESULT ... [options]",
                        "draw fields and curves from results",
                        options,
                        "RESULT is a result folder or its results.vtkhdf.",
                        run};

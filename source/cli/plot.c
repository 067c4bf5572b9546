/* Pictures of results, after a run. */
#include "verbs.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  FIELD,
  COMPONENT,
  BARS,
  OVER_LENGTH,
  OF_BARS_NAMED,
  STEP,
  TIME,
  DEFORMED,
  RANGE,
  VIEW,
  INSIDE,
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
    {"bars", "COLUMN",
     "instead: reinforcing bars over the pale body, coloured by what a deck may give its pictures as 'bars', like "
     "stress"},
    {"over-length", NULL, "with --bars: curves of it over the length of bars, of many those with the largest values"},
    {"of-bars", "NAME[,NAME...]",
     "with --over-length: of these bars only; one that is repeated stands for all of its lines"},
    {"step", "N|last|all", "which written step (last)"},
    {"time", "T[,T...]",
     "the written step nearest to this time, in the deck's unit; with --over-length up to six times"},
    {"deformed", "SCALE", "scale of the displacements drawn (1; 0 draws the reference shape)"},
    {"range", "LOW:HIGH|each",
     "ends of the colours, in the deck's unit (alike at all times); of the x axis with --curve and --over-length"},
    {"view", "AZIMUTH:ELEVATION", "where the eye is, in degrees, for bodies in space"},
    {"inside", "X0:X1,Y0:Y1[,Z0:Z1]",
     "only particles of this box, in the deck's unit, to look into a body; what is left out has no limit, as in "
     ":,0:2,:"},
    {"broken-bonds", NULL, "draw the bonds that have broken"},
    {"size", "PIXELS", "largest width of the body in the picture (640; 460 in space)"},
    {"movie", "FILE.mp4", "all written steps as a movie; needs ffmpeg"},
    {"rate", "N", "with --movie: written steps a second (so that it lasts about ten seconds)"},
    {"curve", "X:Y",
     "instead: columns of histories, like 'opening.distance:pull.value'; more Y behind commas; -Y turns the sign"},
    {"energy", NULL, "instead: all energies over time"},
    {"overlay", "FILE.csv", "with --curve: two columns drawn as points"},
    {"log", "x|y|xy", "with --curve and --over-length: logarithmic axes"},
    {"title", "WORDS", "over the picture (the deck's title)"},
    {"x-label", "WORDS", "at the horizontal axis"},
    {"y-label", "WORDS", "at the vertical axis"},
    {"output", "FILE", "a .png, .svg or .pdf file (in the result folder's pictures; of several results here)"},
    {0},
};

static int read_pair(const char *words, const char *option, double *a, double *b)
{
  char tail;
  if (sscanf(words, "%lf:%lf%c", a, b, &tail) == 2 && isfinite(*a) && isfinite(*b)) return 0;
  complain("breccia plot: --%s: '%s' should be two numbers with a colon between", option, words);
  return 1;
}

static int read_number(const char *words, const char *option, double *value)
{
  char tail;
  if (sscanf(words, "%lf%c", value, &tail) == 1 && isfinite(*value)) return 0;
  complain("breccia plot: --%s: '%s' is not a number", option, words);
  return 1;
}

/** A finite number, or nothing, which leaves `value` as it is. @return what follows */
static const char *read_end(const char *at, double *value)
{
  char *end;
  const double found = strtod(at, &end);
  if (end == at || !isfinite(found)) return at;
  *value = found;
  return end;
}

/** Ranges along x, y, and z if one is given, with commas between them; an end that is left out is no limit. @return 0, or 1 after saying what is wrong */
static int read_box(const char *words, double low[3], double high[3])
{
  const char *at = words;
  bool good = true;
  for (int k = 0; k < 3 && good; ++k) {
    at = read_end(at, &low[k]);
    good = *at == ':';
    if (good) at = read_end(at + 1, &high[k]);
    good = good && (*at == (k < 2 ? ',' : 0) || (k == 1 && !*at));
    if (!*at) break;
    ++at;
  }
  if (good) return 0;
  complain("breccia plot: --inside: '%s' should be two or three ranges with commas between them, like :,0:2,:", words);
  return 1;
}

static void tell(void *context, const char *path)
{
  (void)context;
  printf("%s\n", path);
}

enum { MOST_TIMES = 64 }; /* that are read, of which the library draws some */

/** Times with commas between them. @return 0, or 1 after saying what is wrong */
static int read_times(const char *words, double *times, int *count)
{
  char *end;
  const char *at = words;
  for (*count = 0; *count < MOST_TIMES; at = end + 1) {
    times[(*count)++] = strtod(at, &end);
    if (end == at || !isfinite(times[*count - 1]) || (*end && *end != ',')) break;
    if (!*end) return 0;
  }
  if (*count == MOST_TIMES && *end == ',') return 0; /* far more than can be drawn, which the library says */
  complain("breccia plot: --time: '%s' should be numbers with commas between them", words);
  return 1;
}

/** Names with commas between them. @return 0, or 1 after saying what is wrong */
static int read_names(const char *words, breccia_plot *plot)
{
  enum { MOST_NAMES = 64, LONGEST = 4096 };
  static char own[LONGEST];
  static const char *names[MOST_NAMES];
  char *rest = NULL;
  if (strlen(words) >= LONGEST) {
    complain("breccia plot: --of-bars: expected fewer than %d characters", LONGEST);
    return 1;
  }
  strcpy(own, words);
  for (char *name = strtok_r(own, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
    if (plot->of_bar_count == MOST_NAMES) {
      complain("breccia plot: --of-bars: expected up to %d names", MOST_NAMES);
      return 1;
    }
    names[plot->of_bar_count++] = name + strspn(name, " ");
  }
  plot->of_bars = names;
  if (plot->of_bar_count) return 0;
  complain("breccia plot: --of-bars: expected names of bars with commas between them");
  return 1;
}

static void tell_replaced(void *context, const char *path)
{
  (void)context;
  fprintf(stderr, "breccia plot: %s has taken the place of the picture that was there; --output names another file\n",
          path);
}

/** Which written states are asked for. */
static int read_state(const char **values, breccia_plot *plot)
{
  static double times[MOST_TIMES];
  const char *step = values[STEP] ? values[STEP] : "last";
  long long number;
  if (values[TIME] && values[OVER_LENGTH]) {
    plot->times = times;
    return read_times(values[TIME], times, &plot->time_count);
  }
  if (values[TIME]) {
    plot->state = BRECCIA_STATE_NEAR_TIME;
    return read_number(values[TIME], "time", &plot->time);
  }
  plot->state = !strcmp(step, "all") ? BRECCIA_STATE_ALL : BRECCIA_STATE_LAST;
  if (!strcmp(step, "all") || !strcmp(step, "last")) return 0;
  plot->state = BRECCIA_STATE_OF_STEP;
  if (read_whole(step, "step", 0, LLONG_MAX, &number)) return 1;
  plot->step = number;
  return 0;
}

/** What the options say of the picture. @return 0, or 1 after saying what is wrong */
static int read_plot(const char **values, breccia_plot *plot)
{
  long long size = 0;
  breccia_plot_begin(plot, sizeof *plot);
  if (values[FIELD]) plot->field = values[FIELD];
  plot->component = values[COMPONENT];
  plot->bars = values[BARS];
  plot->title = values[TITLE];
  plot->x_label = values[X_LABEL];
  plot->y_label = values[Y_LABEL];
  plot->path = values[MOVIE] ? values[MOVIE] : values[OUTPUT];
  plot->drawn = tell;
  plot->replaces = tell_replaced;
  plot->broken_bonds = values[BROKEN] != NULL;
  plot->curve = values[ENERGY] ? NULL : values[CURVE];
  plot->overlay = values[OVERLAY];
  plot->log_axes = values[LOG];
  plot->each_range = values[RANGE] && !strcmp(values[RANGE], "each");
  if (values[DEFORMED] && read_number(values[DEFORMED], "deformed", &plot->deformed)) return 1;
  if (values[SIZE] && read_whole(values[SIZE], "size", 50, 20000, &size)) return 1;
  plot->pixels = (double)size;
  if (values[RATE] && read_number(values[RATE], "rate", &plot->rate)) return 1;
  if (values[RATE] && !(plot->rate > 0 && plot->rate <= 120)) {
    complain("breccia plot: --rate: '%s' is not above 0 and up to 120 written steps a second", values[RATE]);
    return 1;
  }
  if (values[RANGE] && !plot->each_range && read_pair(values[RANGE], "range", &plot->low, &plot->high)) return 1;
  if (values[VIEW] && read_pair(values[VIEW], "view", &plot->azimuth, &plot->elevation)) return 1;
  if (values[INSIDE] && read_box(values[INSIDE], plot->low_corner, plot->high_corner)) return 1;
  if (values[OF_BARS_NAMED] && read_names(values[OF_BARS_NAMED], plot)) return 1;
  return read_state(values, plot);
}

enum { OF_FIELD = 1, OF_BARS = 2, OF_LENGTH = 4, OF_HISTORIES = 8, OF_BODY = OF_FIELD | OF_BARS };

/** Options that some kinds of pictures have no use for, and the kinds that have. */
static const struct {
  int option, kinds;
} uses[] = {{FIELD, OF_FIELD},
            {COMPONENT, OF_FIELD},
            {BARS, OF_BARS | OF_LENGTH},
            {OVER_LENGTH, OF_LENGTH},
            {OF_BARS_NAMED, OF_LENGTH},
            {STEP, OF_BODY | OF_LENGTH},
            {TIME, OF_BODY | OF_LENGTH},
            {DEFORMED, OF_BODY},
            {VIEW, OF_BODY},
            {INSIDE, OF_BODY},
            {BROKEN, OF_BODY},
            {SIZE, OF_BODY},
            {MOVIE, OF_BODY},
            {RATE, OF_BODY},
            {CURVE, OF_HISTORIES},
            {ENERGY, OF_HISTORIES},
            {OVERLAY, OF_HISTORIES},
            {LOG, OF_LENGTH | OF_HISTORIES}};

/** @return 0, or 1 after naming an option that this kind of picture has no use for */
static int refuse_useless(const char **values, int kind)
{
  const char *picture = kind == OF_LENGTH      ? "a curve over the length of bars"
                        : kind == OF_BARS      ? "a picture of bars"
                        : kind == OF_HISTORIES ? "a curve of histories"
                                               : "a picture of a field";
  for (size_t k = 0; k < sizeof uses / sizeof *uses; ++k)
    if (values[uses[k].option] && !(uses[k].kinds & kind)) {
      complain("breccia plot: --%s: %s has no use for it; leave it out", options[uses[k].option].name, picture);
      return 1;
    }
  if (values[RANGE] && !strcmp(values[RANGE], "each") && !(kind & OF_BODY)) {
    complain("breccia plot: --range each: %s has no use for it; leave it out", picture);
    return 1;
  }
  if (values[RATE] && !values[MOVIE]) {
    complain("breccia plot: --rate: is of movies; leave it out, or give --movie");
    return 1;
  }
  return 0;
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
  breccia_plot plot;
  if (read_plot(values, &plot)) return 2;
  if (values[OVER_LENGTH] && !values[BARS]) {
    complain("breccia plot: --over-length needs --bars COLUMN, like --bars stress");
    return 2;
  }
  if (refuse_useless(values, curve                 ? OF_HISTORIES
                             : values[OVER_LENGTH] ? OF_LENGTH
                             : values[BARS]        ? OF_BARS
                                                   : OF_FIELD))
    return 2;
  if (values[MOVIE] && (values[STEP] || values[TIME] || values[OUTPUT])) {
    complain("breccia plot: --movie shows a field at all written steps and names its file itself: leave out %s",
             values[OUTPUT] ? "--output"
             : values[STEP] ? "--step"
                            : "--time");
    return 2;
  }
  breccia_error *error = breccia_error_create();
  const int status = curve ? breccia_plot_curve((const char *const *)argv + first, argc - first, &plot, error)
                     : values[OVER_LENGTH] ? breccia_plot_over_length(argv[first], &plot, error)
                     : values[MOVIE]       ? breccia_plot_movie(argv[first], &plot, error)
                                           : breccia_plot_field(argv[first], &plot, error);
  return fail(error, status);
}

const Verb verb_plot = {.name = "plot",
                        .arguments = "RESULT ... [options]",
                        .about = "draw fields, bars and curves from results",
                        .options = options,
                        .more =
                            "RESULT is a result folder or its results.vtkhdf; several give a line each with --curve.\n"
                            "--range each: every picture has a range of its own.",
                        .run = run};

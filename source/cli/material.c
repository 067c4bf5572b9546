/* One material point driven through a strain path or a laboratory test. */
#include "base/csv.h"
#include "base/tensor.h"
#include "cli/verbs.h"
#include "model/element_deck.h"
#include "model/measured_points.h"
#include "results/picture.h"
#include "results/plot.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MODEL,
  SET,
  STRAIN,
  TEST,
  TO,
  BACK,
  CONFINING,
  ZERO,
  CYCLES,
  STEPS,
  AGAINST,
  PICTURE,
  OUTPUT,
  TANGENT,
  ELASTIC,
  UNITS,
  COUNT
};

static const Option options[] = {
    {"model", "NAME", "constitutive model"},
    {"set", "KEY=VALUE", "a parameter, with or without unit (repeat for each)"},
    {"strain", "PATH.csv",
     "total strains: columns strain xx, yy, zz, xy, yz, zx; strain xx alone for laws of one strain"},
    {"test", "KIND",
     "instead: uniaxial, triaxial, 'undrained triaxial', oedometer, biaxial, isotropic, 'simple shear', 'undrained "
     "shear'"},
    {"to", "STRAIN", "strain that the test goes to, tension positive"},
    {"return", "STRAIN", "other end of its cycles (minus the first)"},
    {"confining", "PRESSURE", "isotropic pressure before anything else: the consolidation"},
    {"strain-zero", "WHERE", "'after consolidation' (default), or 'before consolidation' for total strains"},
    {"cycles", "N", "cycles of the test (0: once to the strain)"},
    {"steps", "N", "steps from end to end (200)"},
    {"against", "DATA.csv", "measured points: x and y of the test's curve in the first two columns"},
    {"picture", "FILE", "draw the test's curve (.png, .svg, .pdf)"},
    {"output", "OUT.csv", "where strains and stresses go (standard output; nowhere with --picture or --against)"},
    {"tangent", NULL, "add the tangent: columns tangent xx xx, tangent xx yy, ..., row by row"},
    {"elastic-rows", "N", "respond elastically in the first N rows of a strain path (gravity stage)"},
    {"units", "LENGTH,FORCE,TIME", "what plain numbers mean and in what stresses are written (m,N,s)"},
    {0},
};

typedef struct Settings {
  const char *items[128];
  int count;
} Settings;

static void keep_settings(void *context, int option, const char *value)
{
  Settings *settings = context;
  if (option == SET && settings->count < 128) settings->items[settings->count++] = value;
}

/** Strain rows [count][6], to be freed; the components that a law takes come first, the others are left. */
static double *read_path(const char *path, int components, int *count, breccia_error *error)
{
  double *rows = NULL;
  for (int k = 0; k < components; ++k) {
    char name[32], label[128];
    int n;
    snprintf(name, sizeof name, "strain %s", component_names[k]);
    double *column = csv_column(path, name, CSV_FINISHED, &n, label, error);
    if (!column) {
      free(rows);
      return NULL;
    }
    if (!k) rows = malloc(sizeof(double) * 6 * (size_t)(n + 1));
    int bad = 0;
    while (bad < n && isfinite(column[bad])) ++bad;
    for (int i = 0; rows && i < n && (!k || i < *count); ++i) rows[6 * i + k] = column[i];
    *count = n;
    free(column);
    if (bad == n) continue;
    error_add(error, BRECCIA_USER_ERROR, "%s: row %d: %s is not a number", path, bad + 1, name);
    free(rows);
    return NULL;
  }
  if (rows && *count) return rows;
  error_add(error, BRECCIA_USER_ERROR, "%s: has no row of strains", path);
  free(rows);
  return NULL;
}

static void print_heading(FILE *out, const Units *units, int components, bool tangent)
{
  char unit[64];
  units_name(units, dimension_find("stress"), unit, sizeof unit);
  for (int k = 0; k < components; ++k) fprintf(out, "%sstrain %s", k ? "," : "", component_names[k]);
  for (int k = 0; k < components; ++k) fprintf(out, ",stress %s (%s)", component_names[k], unit);
  if (components == 6) fprintf(out, ",volumetric strain");
  for (int k = 0; tangent && k < components * components; ++k)
    fprintf(out, ",tangent %s %s (%s)", component_names[k / components], component_names[k % components], unit);
  fprintf(out, "\n");
}

static void print_row(FILE *out, int components, const double *strain, const double *stress, const double *tangent)
{
  for (int k = 0; k < components; ++k) fprintf(out, "%s%.17g", k ? "," : "", strain[k]);
  for (int k = 0; k < components; ++k) fprintf(out, ",%.17g", stress[k]);
  if (components == 6) fprintf(out, ",%.17g", strain[XX] + strain[YY] + strain[ZZ]);
  for (int k = 0; tangent && k < components * components; ++k) fprintf(out, ",%.17g", tangent[k]);
  fprintf(out, "\n");
}

static int follow_path(const Material *m, const Units *units, const char *path, long long elastic, bool tangent,
                       FILE *out, Error *error)
{
  Driver d;
  int count = 0, status = driver_create(&d, m, error);
  if (status) return status;
  double *rows = read_path(path, d.components, &count, error);
  if (!rows) status = BRECCIA_USER_ERROR;
  if (rows) print_heading(out, units, d.components, tangent);
  for (int i = 0; rows && i < count && !status; ++i) {
    d.elastic = i < elastic;
    if (!driver_try(&d, rows + 6 * i))
      status = error_add(error, BRECCIA_FAILURE, "row %d: the law could not be integrated at this strain", i + 1);
    print_row(out, d.components, d.strain, d.stress, tangent ? d.tangent : NULL);
    driver_commit(&d);
  }
  free(rows);
  driver_destroy(&d);
  return status;
}

/** What a test is to be held against and where its curve goes. */
typedef struct Outputs {
  const char *where, *title, *against, *picture;
  bool tangent, quiet; /* quiet: rows go to standard output, words to standard error */
  FILE *out;
} Outputs;

static int show_curve(const ElementTest *test, const ElementCurve *c, const Units *units, const Outputs *o,
                      Error *error)
{
  MeasuredPoints points = {0};
  int status = o->against ? measured_points_read(&points, o->against, units, 1, error) : BRECCIA_OK;
  FILE *const words = o->quiet ? stderr : stdout;
  char unit[64];
  units_name(units, dimension_find("stress"), unit, sizeof unit);
  if (!status && points.count) {
    double most;
    const double mean = element_curve_compare(c, points.x, points.y, points.count, NULL, &most);
    Error *doubts = breccia_error_create();
    if (!measured_points_opposed(&points, c, doubts)) measured_points_doubt(&points, test, c, units, doubts);
    warn(doubts);
    fprintf(words,
            "%d measured points (%s, %s in %s) lie %.2f %% of their range from the curve (rms), %.2f %% at most\n",
            points.count, test->x_label, test->y_label, unit, 100 * mean, 100 * most);
  }
  if (!status && o->picture) {
    const PlotLine lines[2] = {{"computed", c->x, c->y, c->count, false, 0, 0},
                               {"measured", points.x, points.y, points.count, true, 0, 0}};
    const PlotOptions plot = {.title = o->title,
                              .x = {.words = test->x_label, .unit = ""},
                              .y = {.words = test->y_label, .unit = unit},
                              .low = NAN,
                              .high = NAN};
    status = plot_draw(lines, points.count ? 2 : 1, &plot, o->picture, error);
    if (!status) fprintf(words, "%s\n", o->picture);
  }
  measured_points_destroy(&points);
  return status;
}

static int run_test(const ElementTest *test, const Material *m, const Units *units, const Outputs *o, Error *error)
{
  ElementCurve c;
  Error *doubts = breccia_error_create();
  element_doubt_material(m, units, o->where, doubts);
  warn(doubts);
  int status = element_test_run(test, m, &c, error);
  const int n = c.components;
  if (o->out && c.count) print_heading(o->out, units, n, o->tangent);
  for (int i = 0; o->out && i < c.count; ++i)
    print_row(o->out, n, c.strain + 6 * i, c.stress + 6 * i, o->tangent ? c.tangent + n * n * i : NULL);
  const int shown = c.count > 1 ? show_curve(test, &c, units, o, error) : BRECCIA_OK;
  element_curve_destroy(&c);
  return status ? status : shown;
}

/** The test of the command line's words. */
static int read_test(const char **values, const Units *units, TestSpec *spec, Error *error)
{
  const struct {
    int option;
    const char *dimension;
    double *value;
  } numbers[] = {{TO, "1", &spec->strain}, {BACK, "1", &spec->back}, {CONFINING, "stress", &spec->confining}};
  *spec = (TestSpec){.kind = values[TEST], .zero = values[ZERO], .strain = NAN, .back = NAN, .steps = 200};
  int status = BRECCIA_OK, kind = 0;
  while (test_kind_word(kind) && strcmp(test_kind_word(kind), values[TEST])) ++kind;
  if (!test_kind_word(kind)) {
    Text words = {0};
    for (int k = 0; test_kind_word(k); ++k) text_add(&words, "%s'%s'", k ? ", " : "", test_kind_word(k));
    status = error_add(error, BRECCIA_USER_ERROR, "--test '%s' is not known; the tests are %s", values[TEST],
                       text_words(&words));
    text_free(&words);
  }
  if (!spec->zero) spec->zero = test_zero_word(0);
  if (strcmp(spec->zero, test_zero_word(0)) && strcmp(spec->zero, test_zero_word(1)))
    status = error_add(error, BRECCIA_USER_ERROR, "--strain-zero '%s' is not known; choose '%s' or '%s'", spec->zero,
                       test_zero_word(0), test_zero_word(1));
  for (int k = 0; k < 3; ++k) {
    Text reason = {0};
    const char *words = values[numbers[k].option];
    if (words && units_read(units, dimension_find(numbers[k].dimension), words, numbers[k].value, &reason))
      status = error_add(error, BRECCIA_USER_ERROR, "--%s %s: %s", options[numbers[k].option].name, words,
                         text_words(&reason));
    text_free(&reason);
  }
  if (!values[TO]) status = error_add(error, BRECCIA_USER_ERROR, "--test needs --to STRAIN, what it goes to");
  if (spec->confining < 0)
    status = error_add(error, BRECCIA_USER_ERROR, "--confining: must not be negative: it is a pressure");
  long long count;
  if (values[CYCLES]) {
    if (read_whole(values[CYCLES], "cycles", 0, &count)) status = BRECCIA_USER_ERROR;
    spec->cycles = count;
  }
  if (values[STEPS]) {
    if (read_whole(values[STEPS], "steps", 1, &count)) status = BRECCIA_USER_ERROR;
    spec->steps = count;
  }
  return status;
}

/** The units of --units, like 'm, kN, s', or the usual ones. */
static Units *read_units(const char *words, Error *error)
{
  char name[3][32], tail;
  if (!words) return units_create(UNITS_LENGTH, UNITS_FORCE, UNITS_TIME, error);
  if (sscanf(words, " %31[^, ] , %31[^, ] , %31[^, ] %c", name[0], name[1], name[2], &tail) == 3)
    return units_create(name[0], name[1], name[2], error);
  error_add(error, BRECCIA_USER_ERROR, "--units '%s': give units of length, force and time, like 'm,kN,s'", words);
  return NULL;
}

/** A model and its test or path from the command line. */
static int run_words(const char **values, const Settings *settings, const Outputs *o, Error *error)
{
  long long elastic = 0;
  if (values[ELASTIC] && read_whole(values[ELASTIC], "elastic-rows", 0, &elastic)) return BRECCIA_USER_ERROR;
  const breccia_law *law = law_find(NULL, values[MODEL]);
  if (!law) {
    Text advice = {0};
    law_advice(NULL, values[MODEL], &advice);
    error_add(error, BRECCIA_USER_ERROR, "breccia material: there is no model '%s'; %s", values[MODEL],
              text_words(&advice));
    text_free(&advice);
    return BRECCIA_USER_ERROR;
  }
  Units *units = read_units(values[UNITS], error);
  if (!units) return values[UNITS] ? BRECCIA_USER_ERROR : BRECCIA_FAILURE;
  Material material = {0};
  int status = material_from_words(&material, law, settings->items, settings->count, units, "--set ", error);
  if (!status && values[STRAIN]) {
    status = follow_path(&material, units, values[STRAIN], elastic, o->tangent, o->out, error);
  } else if (!status) {
    TestSpec spec;
    ElementTest test = {0};
    const DeckReader reader = {.document = &(Document){.name = "breccia material"}, .units = units, .error = error};
    static const Node nowhere = {.kind = NODE_MAP, .line = 1, .column = 1};
    status = read_test(values, units, &spec, error);
    spec.head.node = &nowhere;
    if (!status) status = element_test_create(&test, &reader, &spec, NULL, law->components == 1);
    if (!status) status = run_test(&test, &material, units, o, error);
    element_test_destroy(&test);
  }
  material_destroy(&material);
  units_destroy(&units);
  return status;
}

static int run_file(const char *path, const Outputs *given, Error *error)
{
  ElementDeck deck;
  int status = element_deck_load(&deck, path, error);
  Outputs o = *given;
  o.where = path;
  if (!status) {
    if (deck.spec->title)
      o.title = deck.spec->title;
    else
      o.title = deck.law->name;
    if (!o.against) o.against = deck.against;
    status = run_test(&deck.test, &deck.material, deck.units, &o, error);
  }
  element_deck_destroy(&deck);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  Settings settings = {.count = 0};
  int first = read_options(argc, argv, verb, values, keep_settings, &settings);
  if (first < 0) return first == -2 ? 0 : 2;
  const bool file = argc - first == 1 && !values[MODEL];
  if (!file && (first < argc || !values[MODEL] || !values[STRAIN] == !values[TEST])) {
    fprintf(stderr,
            "breccia material: give a file TEST.yaml, or --model with --strain or --test; see 'breccia material "
            "--help'\n");
    return 2;
  }
  if (values[PICTURE] && !picture_format(values[PICTURE])) {
    fprintf(stderr, "breccia material: --picture: '%s' should end in .png, .svg or .pdf\n", values[PICTURE]);
    return 2;
  }
  breccia_error *error = breccia_error_create();
  Outputs o = {.where = "breccia material",
               .title = values[MODEL],
               .against = values[AGAINST],
               .picture = values[PICTURE],
               .tangent = values[TANGENT] != NULL,
               .out = stdout};
  if ((values[PICTURE] || values[AGAINST]) && !values[STRAIN]) o.out = NULL; /* rows only where they are asked for */
  o.quiet = o.out && !values[OUTPUT];
  if (values[OUTPUT] && !(o.out = fopen(values[OUTPUT], "w")))
    return fail(error,
                error_add(error, BRECCIA_USER_ERROR, "%s: cannot be written: %s", values[OUTPUT], strerror(errno)));
  int status = file ? run_file(argv[first], &o, error) : run_words(values, &settings, &o, error);
  if (o.out && o.out != stdout && fclose(o.out) && !status)
    status = error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", values[OUTPUT], strerror(errno));
  return fail(error, status);
}

const Verb verb_material = {
    "material",
    "TEST.yaml | --model NAME --set KEY=VALUE ... (--strain PATH.csv | --test KIND --to STRAIN) [options]",
    "drive one material point through a laboratory test or a strain path",
    options,
    "TEST.yaml holds units, a material as in a deck, and a test or stages (docs/models.md). On the command\n"
    "line plain numbers are in " UNITS_WORDS ", as in decks; shear strains are engineering, tension is positive.",
    run};

/* One material point driven through a strain path or a laboratory test. */
#include "verbs.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
  DURATION,
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
     "total strains: columns strain xx, yy, zz, xy, yz, zx; strain xx alone for laws of one strain; a column time for "
     "laws that take it"},
    {"test", "KIND",
     "instead: uniaxial, triaxial, 'undrained triaxial', oedometer, biaxial, isotropic, 'simple shear', 'undrained "
     "shear'"},
    {"to", "STRAIN", "strain that the test goes to, tension positive"},
    {"return", "STRAIN", "other end of its cycles (minus the first)"},
    {"confining", "PRESSURE", "isotropic pressure before anything else: the consolidation"},
    {"strain-zero", "WHERE", "'after consolidation' (default), or 'before consolidation' for total strains"},
    {"cycles", "N", "cycles of the test (0: once to the strain)"},
    {"steps", "N", "steps from end to end (200)"},
    {"duration", "TIME", "of each way to an end of the test, for laws that take time (at once)"},
    {"against", "DATA.csv", "measured points: x and y of the test's curve in the first two columns"},
    {"picture", "FILE", "draw the test's curve (.png, .svg, .pdf)"},
    {"output", "OUT.csv", "where strains and stresses go (standard output; nowhere with --picture or --against)"},
    {"tangent", NULL, "add the tangent: columns tangent xx xx, tangent xx yy, ..., row by row"},
    {"elastic-rows", "N", "respond elastically in the first N rows of a strain path (gravity stage)"},
    {"units", "LENGTH,FORCE,TIME", "what plain numbers mean and in what stresses are written (m,N,s)"},
    {0},
};

/** Reads what the options say of a test or a path. @return 0, or 1 after saying what is wrong */
static int read_words(const char **values, const DeckSettings *parameters, breccia_test_words *words)
{
  long long cycles = 0, steps = 0, elastic = 0;
  if (values[CYCLES] && read_whole(values[CYCLES], "cycles", 0, 1000000, &cycles)) return 1;
  if (values[STEPS] && read_whole(values[STEPS], "steps", 1, LLONG_MAX, &steps)) return 1;
  if (values[ELASTIC] && read_whole(values[ELASTIC], "elastic-rows", 0, LLONG_MAX, &elastic)) return 1;
  *words = (breccia_test_words){.size = sizeof *words,
                                .law = values[MODEL],
                                .units = values[UNITS],
                                .parameters = parameters->items,
                                .parameter_count = parameters->count,
                                .cycles = (int)cycles,
                                .path = values[STRAIN],
                                .kind = values[TEST],
                                .to = values[TO],
                                .back = values[BACK],
                                .confining = values[CONFINING],
                                .strain_zero = values[ZERO],
                                .steps = steps,
                                .duration = values[DURATION],
                                .elastic_rows = elastic};
  return 0;
}

static void print_rows(const breccia_test *test, FILE *out)
{
  int columns = 0;
  for (; breccia_test_heading(test, columns); ++columns)
    fprintf(out, "%s%s", columns ? "," : "", breccia_test_heading(test, columns));
  fprintf(out, "\n");
  for (int i = 0; i < breccia_test_rows(test); ++i) {
    for (int k = 0; k < columns; ++k) fprintf(out, "%s%.17g", k ? "," : "", breccia_test_column(test, k)[i]);
    fprintf(out, "\n");
  }
}

/** Tells how far measured points lie from the curve, and draws both.
 *  @param[in] words  where to say so */
static int show_curve(breccia_test *test, const char **values, FILE *words, breccia_error *error)
{
  breccia_comparison c = {.size = sizeof c};
  int status = breccia_test_compare(test, values[AGAINST], &c, error);
  if (!status && c.points)
    fprintf(words,
            "%d measured points (%s, %s in %s) lie %.2f %% of their range from the curve (rms), %.2f %% at most\n",
            c.points, c.x_label, c.y_label, c.unit, 100 * c.mean, 100 * c.most);
  if (!status && values[PICTURE]) {
    status = breccia_test_draw(test, values[PICTURE], error);
    if (!status) fprintf(words, "%s\n", values[PICTURE]);
  }
  return status;
}

/** Runs the test, prints its rows and shows its curve. Rows on standard output leave words to standard error. */
static int run_test(breccia_test *test, const char **values, breccia_error *error)
{
  FILE *out = stdout;
  if ((values[PICTURE] || values[AGAINST]) && !values[OUTPUT]) out = NULL; /* rows only where they are asked for */
  if (values[OUTPUT] && !(out = fopen(values[OUTPUT], "w"))) {
    complain("%s: cannot be written: %s", values[OUTPUT], strerror(errno));
    return BRECCIA_USER_ERROR;
  }
  int status = breccia_test_run(test, values[TANGENT] != NULL, error);
  if (out && breccia_test_rows(test) && breccia_test_heading(test, 0)) print_rows(test, out);
  if (breccia_test_rows(test) > 1 && breccia_test_heading(test, 0) && !values[STRAIN]) {
    const int shown = show_curve(test, values, out == stdout ? stderr : stdout, error);
    if (!status) status = shown;
  }
  warn(breccia_test_doubts(test));
  const bool bad = out && out != stdout && (ferror(out) | fclose(out));
  struct stat there;
  if (bad) {
    complain("%s: cannot be written: %s", values[OUTPUT], strerror(errno));
    if (!stat(values[OUTPUT], &there) && S_ISREG(there.st_mode)) remove(values[OUTPUT]);
    if (!status) status = BRECCIA_FAILURE;
  }
  return status;
}

/** Whether two paths lead to one file. */
static bool is_same_file(const char *a, const char *b)
{
  struct stat one, other;
  return a && b && !stat(a, &one) && !stat(b, &other) && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/** Whether the output would be written over what is read. @return 0, or 1 after saying so */
static int check_output(const char **values, const char *file)
{
  const char *const inputs[] = {file, values[STRAIN], values[AGAINST]};
  for (size_t k = 0; k < sizeof inputs / sizeof *inputs; ++k) {
    if (!is_same_file(values[OUTPUT], inputs[k])) continue;
    complain("breccia material: --output: %s is read here and would be written over; give another name",
             values[OUTPUT]);
    return 1;
  }
  return 0;
}

/** Whether the options go together. @return 0, or 1 after saying what is wrong */
static int check_options(const char **values, bool file, int others)
{
  if (!file && (others || !values[MODEL] || !values[STRAIN] == !values[TEST])) {
    fprintf(stderr,
            "breccia material: give a file TEST.yaml, or --model with --strain or --test; see 'breccia material "
            "--help'\n");
    return 1;
  }
  if (values[PICTURE] && !breccia_can_draw(values[PICTURE])) {
    complain("breccia material: --picture: '%s' should end in .png, .svg or .pdf", values[PICTURE]);
    return 1;
  }
  if (values[STRAIN] && (values[PICTURE] || values[AGAINST])) {
    complain("breccia material: a path of strains has no curve for --%s: give a --test, or leave it out",
             values[PICTURE] ? "picture" : "against");
    return 1;
  }
  return 0;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  DeckSettings parameters;
  if (settings_begin(&parameters, SET, argc)) return BRECCIA_FAILURE;
  const int first = read_options(argc, argv, verb, values, settings_note, &parameters);
  const bool file = first >= 0 && argc - first == 1 && !values[MODEL];
  int status = first == -2 ? 0 : 2;
  breccia_error *error = breccia_error_create();
  if (first >= 0 && !check_options(values, file, argc - first) && !check_output(values, file ? argv[first] : NULL)) {
    breccia_test *test = NULL;
    breccia_test_words words;
    if (file)
      status = breccia_test_load(argv[first], &test, error);
    else if (!read_words(values, &parameters, &words))
      status = breccia_test_make(&words, &test, error);
    if (test) status = run_test(test, values, error);
    breccia_test_destroy(&test);
  }
  free(parameters.items);
  return fail(error, status);
}

const Verb verb_material = {
    .name = "material",
    .arguments = "TEST.yaml | --model NAME --set KEY=VALUE ... (--strain PATH.csv | --test KIND --to STRAIN) [options]",
    .about = "drive one material point through a laboratory test or a strain path",
    .options = options,
    .more = "TEST.yaml holds units, a material as in a deck, and a test or stages (docs/models.md). On the command\n"
            "line plain numbers are in m, N, s, as in decks; shear strains are engineering, tension is positive.",
    .run = run};

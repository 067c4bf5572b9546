/* Parameters of a law from measured curves. */
#include "verbs.h"

#include <math.h>

enum { AGAINST, PICTURE, COUNT };

static const Option options[] = {
    {"against", "DATA.csv", "measured points, instead of those that the file names"},
    {"picture", "FILE", "draw the fitted curve with the points (.png, .svg, .pdf)"},
    {0},
};

/** @return a status */
static int print_fit(breccia_test *test, const breccia_fit *f)
{
  printf("%d points lie %.2f %% of their range from the curve (rms) and %.2f %% at most; with the file's values it was "
         "%.2f %%.\n",
         f->points, 100 * f->after, 100 * f->most, 100 * f->before);
  printf("%d of %d starts came as near", f->agreeing, f->starts);
  if (isfinite(f->next)) printf("; the others ended at %.2f %% or more", 100 * f->next);
  if (2 * f->agreeing < f->starts) printf(": there are several minima; hold the values against what else you know");
  printf(". %d runs of the test.\n", f->runs);
  breccia_fitted p = {.size = sizeof p};
  int more = 0;
  for (int k = 0; (more = breccia_test_fitted_at(test, k, &p)) > 0; ++k)
    printf("  %s: %.6g%s%s   (between %g and %g; %s)\n", p.name, p.value, *p.unit ? " " : "", p.unit, p.from, p.to,
           p.judgement);
  return more < 0 ? show(NULL, stderr) : BRECCIA_OK;
}

static int draw(breccia_test *test, const char *path, breccia_error *error)
{
  int status = breccia_test_run(test, 0, error);
  if (!status) status = breccia_test_draw(test, path, error);
  if (!status) printf("%s\n", path);
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[COUNT];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (argc - first != 1) {
    fprintf(stderr, "breccia calibrate: give one file TEST.yaml; see 'breccia calibrate --help'\n");
    return 2;
  }
  if (values[PICTURE] && !breccia_can_draw(values[PICTURE])) {
    fprintf(stderr, "breccia calibrate: --picture: '%s' should end in .png, .svg or .pdf\n", values[PICTURE]);
    return 2;
  }
  breccia_error *error = breccia_error_create();
  breccia_test *test;
  breccia_fit fit = {.size = sizeof fit};
  int status = breccia_test_load(argv[first], &test, error);
  if (!status) status = breccia_test_fit(test, values[AGAINST], &fit, error);
  if (test) warn(breccia_test_doubts(test));
  if (!status) status = print_fit(test, &fit);
  if (!status && values[PICTURE]) status = draw(test, values[PICTURE], error);
  breccia_test_destroy(&test);
  return fail(error, status);
}

const Verb verb_calibrate = {
    .name = "calibrate",
    .arguments = "TEST.yaml [options]",
    .about = "fit parameters of a law to a measured curve",
    .options = options,
    .more = "TEST.yaml is a file as for 'breccia material', with the measured points under 'against' and under 'fit'\n"
            "the parameters to choose with their ranges: fit: {cohesion: {from: 5, to: 50}}.",
    .run = run};

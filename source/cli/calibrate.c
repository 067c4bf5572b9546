/* Parameters of a law from measured curves. */
#include "cli/verbs.h"
#include "model/parameter_fit.h"
#include "results/curve.h"
#include "results/picture.h"
#include "results/plot.h"

#include <math.h>
#include <stdlib.h>

enum { AGAINST, PICTURE, COUNT };

static const Option options[] = {
    {"against", "DATA.csv", "measured points, instead of those that the file names"},
    {"picture", "FILE", "draw the fitted curve with the points (.png, .svg, .pdf)"},
    {0},
};

static void print_fit(const ElementDeck *deck, const ParameterFit *c, int points)
{
  printf("%d points lie %.2f %% of their range from the curve (rms) and %.2f %% at most; with the file's values it was "
         "%.2f %%. %d runs.\n",
         points, 100 * c->after, 100 * c->most, 100 * c->before, c->runs);
  for (int k = 0; k < c->count; ++k) {
    const FittedParameter *p = &c->parameters[k];
    const breccia_parameter *law = &deck->law->parameters[p->index];
    char unit[64];
    units_name(deck->units, dimension_find(law->dimension), unit, sizeof unit);
    const double edge = 1e-3 * (p->to - p->from);
    printf("  %s: %.6g%s%s   (between %g and %g; a change by 1 %% of the range moves the points by %.2g %%%s)\n",
           law->name, p->value, *unit ? " " : "", unit, p->from, p->to, 100 * p->sensitivity,
           p->value - p->from < edge || p->to - p->value < edge ? "; it stands at the end of its range"
           : p->sensitivity < 1e-5                              ? "; these points do not tell it"
                                                                : "");
  }
}

static int draw(const ElementDeck *deck, const double *x, const double *y, int count, const char *path, Error *error)
{
  ElementCurve c;
  int status = element_test_run(&deck->test, &deck->material, &c, error);
  if (!status) {
    char unit[64];
    units_name(deck->units, dimension_find("stress"), unit, sizeof unit);
    const PlotLine lines[2] = {{"fitted", c.x, c.y, c.count, false, 0, 0}, {"measured", x, y, count, true, 0, 0}};
    const PlotOptions plot = {.title = deck->spec->title ? deck->spec->title : deck->law->name,
                              .x = {.words = deck->test.x_label, .unit = ""},
                              .y = {.words = deck->test.y_label, .unit = unit},
                              .low = NAN,
                              .high = NAN};
    status = plot_draw(lines, 2, &plot, path, error);
    if (!status) printf("%s\n", path);
  }
  element_curve_destroy(&c);
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
  if (values[PICTURE] && !picture_format(values[PICTURE])) {
    fprintf(stderr, "breccia calibrate: --picture: '%s' should end in .png, .svg or .pdf\n", values[PICTURE]);
    return 2;
  }
  breccia_error *error = breccia_error_create();
  ElementDeck deck;
  double *x = NULL, *y = NULL;
  int count = 0, status = element_deck_load(&deck, argv[first], error);
  const char *against = values[AGAINST] ? values[AGAINST] : deck.against;
  if (!status && !against)
    status = node_error(deck.document, deck.spec->head.node, error, "no measured points: give 'against' or --against");
  if (!status) status = curve_points(against, &x, &y, &count, error);
  ParameterFit c = {0};
  if (!status) status = parameter_fit_run(&deck, x, y, count, &c, error);
  if (!status) print_fit(&deck, &c, count);
  if (!status && values[PICTURE]) status = draw(&deck, x, y, count, values[PICTURE], error);
  parameter_fit_destroy(&c);
  free(x);
  free(y);
  element_deck_destroy(&deck);
  return fail(error, status);
}

const Verb verb_calibrate = {
    "calibrate",
    "TEST.yaml [options]",
    "fit parameters of a law to a measured curve",
    options,
    "TEST.yaml is a file as for 'breccia material', with the measured points under 'against' and under 'fit'\n"
    "the parameters to choose with their ranges: fit: {cohesion: {from: 5, to: 50}}.",
    run};

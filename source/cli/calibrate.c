/* Parameters of a law from measured curves. */
#include "cli/verbs.h"
#include "model/measured_points.h"
#include "model/parameter_fit.h"
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

static const char *parameter_name(const ElementDeck *deck, const FittedParameter *p)
{
  return deck->law->parameters[p->index].name;
}

/** An amount by which a value may differ: in per cent of it where that is a small number. */
static void add_amount(Text *words, double amount, double value)
{
  if (amount < 10 * fabs(value))
    text_add(words, "%.2g %%", 100 * amount / fabs(value));
  else
    text_add(words, "%.2g", amount);
}

/** What the points say of a parameter, or why they say nothing. */
static void add_judgement(const ElementDeck *deck, const ParameterFit *c, const FittedParameter *p, Text *words)
{
  const double edge = 1e-3 * (p->to - p->from);
  const char *partner = p->partner >= 0 ? parameter_name(deck, &c->parameters[p->partner]) : "";
  if (isinf(p->margin_alone)) {
    text_add(words, "these points do not tell it: anywhere in the range the curve moves by less than %g %%",
             100 * FIT_MARGIN);
  } else if (*partner && (isinf(p->margin) || fabs(p->correlation) > 0.9995)) {
    text_add(words, "these points tell it only together with '%s' (correlation %.3f): fix one of the two", partner,
             p->correlation);
  } else {
    if (isinf(p->deviation)) {
      text_add(words, "these points are too few or scatter too much to tell it; ");
    } else if (p->deviation > 1e-4 * fabs(p->value)) {
      text_add(words, "standard deviation ");
      add_amount(words, p->deviation, p->value);
      text_add(words, "; ");
    }
    add_amount(words, p->margin, p->value);
    text_add(words, " more moves the curve by %g %%, the others following", 100 * FIT_MARGIN);
    if (fabs(p->correlation) > 0.95 && *partner)
      text_add(words, "; goes along with '%s' (correlation %.3f)", partner, p->correlation);
  }
  if (p->highest - p->lowest > 0.02 * fabs(p->value))
    text_add(words, "; other starts came as near with %.4g to %.4g", p->lowest, p->highest);
  if (p->value - p->from < edge || p->to - p->value < edge) text_add(words, "; it stands at the end of its range");
}

static void print_fit(const ElementDeck *deck, const ParameterFit *c, int points)
{
  printf("%d points lie %.2f %% of their range from the curve (rms) and %.2f %% at most; with the file's values it was "
         "%.2f %%.\n",
         points, 100 * c->after, 100 * c->most, 100 * c->before);
  printf("%d of %d starts came as near", c->agreeing, c->starts);
  if (isfinite(c->next)) printf("; the others ended at %.2f %% or more", 100 * c->next);
  if (2 * c->agreeing < c->starts) printf(": there are several minima; hold the values against what else you know");
  printf(". %d runs of the test.\n", c->runs);
  for (int k = 0; k < c->count; ++k) {
    const FittedParameter *p = &c->parameters[k];
    char unit[64];
    Text words = {0};
    units_name(deck->units, dimension_find(deck->law->parameters[p->index].dimension), unit, sizeof unit);
    add_judgement(deck, c, p, &words);
    printf("  %s: %.6g%s%s   (between %g and %g; %s)\n", parameter_name(deck, p), p->value, *unit ? " " : "", unit,
           p->from, p->to, words.characters ? words.characters : "");
    text_free(&words);
  }
}

static int draw(const ElementDeck *deck, const MeasuredPoints *m, const char *path, Error *error)
{
  ElementCurve c;
  int status = element_test_run(&deck->test, &deck->material, &c, error);
  if (!status) {
    char unit[64];
    units_name(deck->units, dimension_find("stress"), unit, sizeof unit);
    const PlotLine lines[2] = {{"fitted", c.x, c.y, c.count, false, 0, 0},
                               {"measured", m->x, m->y, m->count, true, 0, 0}};
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

/** Mistakes that show before anything is fitted, with the file's own values. */
static int look_first(const ElementDeck *deck, const MeasuredPoints *points, Error *error)
{
  ElementCurve c;
  Error *ignored = breccia_error_create(), *doubts = breccia_error_create();
  element_doubt_material(&deck->material, deck->units, deck->document->name, doubts);
  int status = BRECCIA_OK;
  if (!element_test_run(&deck->test, &deck->material, &c, ignored)) {
    status = measured_points_opposed(points, &c, error);
    if (!status) measured_points_doubt(points, &deck->test, &c, deck->units, doubts);
  }
  element_curve_destroy(&c);
  breccia_error_destroy(&ignored);
  warn(doubts);
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
  MeasuredPoints points = {0};
  int status = element_deck_load(&deck, argv[first], error);
  const char *against = values[AGAINST] ? values[AGAINST] : deck.against;
  if (!status && !against)
    status = node_error(deck.document, deck.spec->head.node, error, "no measured points: give 'against' or --against");
  if (!status) status = measured_points_read(&points, against, deck.units, 2, error);
  ParameterFit c = {0};
  if (!status) status = look_first(&deck, &points, error);
  if (!status) status = parameter_fit_run(&deck, points.x, points.y, points.count, &c, error);
  if (!status) print_fit(&deck, &c, points.count);
  if (!status && values[PICTURE]) status = draw(&deck, &points, values[PICTURE], error);
  parameter_fit_destroy(&c);
  measured_points_destroy(&points);
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

/* Parameters of a law from measured curves, and how well the points tell them. */
#include "model/laboratory.h"

#include "model/host.h"
#include "model/sized.h"
#include <math.h>
#include <stdlib.h>

/** Mistakes that show before anything is fitted, with the file's own values. */
static int look_first(breccia_test *test, Error *error)
{
  const ElementDeck *deck = &test->deck;
  ElementCurve c;
  Error *ignored = breccia_error_create();
  element_doubt_material(&deck->material, deck->units, test->where, test->doubts);
  int status = BRECCIA_OK;
  if (!element_test_run(&deck->test, &deck->material, &c, ignored)) {
    status = measured_points_opposed(&test->points, &c, error);
    if (!status) measured_points_doubt(&test->points, &deck->test, &c, deck->units, test->doubts);
  }
  element_curve_destroy(&c);
  breccia_error_destroy(&ignored);
  return status;
}

static int run_fit(breccia_test *test, const char *path, Error *error)
{
  ElementDeck *deck = &test->deck;
  if (!deck->document)
    return error_add(error, BRECCIA_USER_ERROR,
                     "%s: only the test of a file can be fitted: it says what is to be chosen", test->where);
  if (!path) path = deck->against;
  if (!path)
    return node_error(deck->document, deck->spec->head.node, error, "no measured points: give 'against' or --against");
  measured_points_destroy(&test->points);
  parameter_fit_destroy(&test->fit);
  deck->reader.error = error;
  int status = measured_points_read(&test->points, path, deck->units, 2, error);
  if (!status) status = look_first(test, error);
  if (!status) status = parameter_fit_run(deck, test->points.x, test->points.y, test->points.count, &test->fit, error);
  return status;
}

int breccia_test_fit(breccia_test *test, const char *path, breccia_fit *fit, breccia_error *error)
{
  if (host_lacks(test, __func__, "test", error)) return BRECCIA_USER_ERROR;
  const Host host = host_enter();
  const int status = run_fit(test, path, error);
  const ParameterFit *f = &test->fit;
  const breccia_fit found = {.points = test->points.count,
                             .starts = f->starts,
                             .agreeing = f->agreeing,
                             .runs = f->runs,
                             .before = f->before,
                             .after = f->after,
                             .most = f->most,
                             .next = f->next};
  if (fit && !status) sized_give(fit, &found, sizeof found);
  return host_leave(&host, status, error);
}

static const char *parameter_name(const breccia_test *test, const FittedParameter *p)
{
  return test->deck.law->parameters[p->index].name;
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
static void add_judgement(const breccia_test *test, const FittedParameter *p, Text *words)
{
  const double edge = 1e-3 * (p->to - p->from);
  const char *partner = p->partner >= 0 ? parameter_name(test, &test->fit.parameters[p->partner]) : "";
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

int breccia_test_fitted_at(breccia_test *test, int k, breccia_fitted *parameter)
{
  if (!test || !parameter) return 0;
  if (k < 0 || k >= test->fit.count) return 0;
  const Host host = host_enter();
  const FittedParameter *p = &test->fit.parameters[k];
  text_free(&test->judgement);
  add_judgement(test, p, &test->judgement);
  units_name(test->deck.units, dimension_find(test->deck.law->parameters[p->index].dimension), test->parameter_unit,
             sizeof test->parameter_unit);
  const breccia_fitted found = {.name = parameter_name(test, p),
                                .unit = test->parameter_unit,
                                .judgement = text_words(&test->judgement),
                                .value = p->value,
                                .from = p->from,
                                .to = p->to,
                                .deviation = p->deviation,
                                .margin = p->margin};
  return host_leave(&host, BRECCIA_OK, NULL) ? -1 : sized_give(parameter, &found, sizeof found);
}

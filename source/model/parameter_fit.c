#include "model/parameter_fit.h"

#include "base/memory.h"
#include "base/random.h"
#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

typedef struct Search {
  ElementDeck *deck;
  ParameterFit *fit;
  double *values; /* of all the law's parameters */
  const double *x, *y;
  int count;
  double most;
} Search;

static const double hopeless = 1e3; /* distance where the parameters are inadmissible or the test cannot be run */

/** Ranges over more than a decade are searched by ratios. */
static bool by_ratio(const FittedParameter *p)
{
  return p->from > 0 && p->to > 10 * p->from;
}

static double value_at(const FittedParameter *p, double place)
{
  return by_ratio(p) ? p->from * pow(p->to / p->from, place) : p->from + (p->to - p->from) * place;
}

static double place_of(const FittedParameter *p, double value)
{
  const double place =
      by_ratio(p) ? log(value / p->from) / log(p->to / p->from) : (value - p->from) / (p->to - p->from);
  return fmin(1, fmax(0, place));
}

static double distance(Search *s, const double *places)
{
  ParameterFit *c = s->fit;
  for (int k = 0; k < c->count; ++k) s->values[c->parameters[k].index] = value_at(&c->parameters[k], places[k]);
  char reason[512];
  Material material;
  ++c->runs;
  if (material_prepare(&material, s->deck->law, s->values, reason, sizeof reason)) return hopeless;
  Error *ignored = breccia_error_create();
  ElementCurve curve;
  double mean = hopeless;
  if (!element_test_run(&s->deck->test, &material, &curve, ignored) && curve.count > 1)
    element_curve_compare(&curve, s->x, s->y, s->count, &mean, &s->most);
  element_curve_destroy(&curve);
  breccia_error_destroy(&ignored);
  material_destroy(&material);
  return isfinite(mean) ? mean : hopeless;
}

static double objective(unsigned count, const double *places, double *gradient, void *context)
{
  (void)count, (void)gradient;
  return distance(context, places);
}

static int find_parameters(const ElementDeck *deck, ParameterFit *c, const double *values)
{
  const SectionList *fit = &deck->spec->fit;
  int status = BRECCIA_OK;
  for (int n = 0; n < fit->count; ++n) {
    const FitSpec *spec = fit->items[n];
    int k = 0;
    while (k < deck->law->parameter_count && strcmp(deck->law->parameters[k].name, spec->head.name)) ++k;
    if (k == deck->law->parameter_count) {
      status = node_error(deck->document, spec->head.node, deck->reader.error, "fit: %s has no parameter '%s'",
                          deck->law->name, spec->head.name);
    } else if (!(spec->from < spec->to) || !interval_contains(deck->law->parameters[k].range, spec->from) ||
               !interval_contains(deck->law->parameters[k].range, spec->to)) {
      char range[128];
      interval_describe(deck->law->parameters[k].range, range, sizeof range);
      status =
          node_error(deck->document, spec->head.node, deck->reader.error,
                     "fit: '%s' needs 'from' below 'to', and both %s", spec->head.name, *range ? range : "numbers");
    } else {
      FittedParameter *p = &c->parameters[c->count++];
      *p = (FittedParameter){.index = k, .from = spec->from, .to = spec->to, .start = values[k]};
      if (isnan(p->start)) p->start = value_at(p, 0.5);
    }
  }
  return status;
}

int parameter_fit_run(ElementDeck *deck, const double *x, const double *y, int count, ParameterFit *c, Error *error)
{
  enum { STARTS = 5, MOST_RUNS = 400 };
  const int parameters = deck->law->parameter_count, fitted = deck->spec->fit.count;
  *c = (ParameterFit){0};
  if (!fitted)
    return node_error(deck->document, deck->spec->head.node, error,
                      "nothing to calibrate: give the parameters and their ranges under 'fit', like 'fit: {cohesion: "
                      "{from: 5, to: 50}}'");
  double *values = memory_zeroed((size_t)parameters, sizeof(double), "parameters", error),
         *places = memory_zeroed((size_t)fitted, sizeof(double), "parameters", error),
         *best = memory_zeroed((size_t)fitted, sizeof(double), "parameters", error);
  c->parameters = memory_zeroed((size_t)fitted, sizeof *c->parameters, "parameters", error);
  nlopt_opt search = nlopt_create(NLOPT_LN_SBPLX, (unsigned)fitted);
  int status = values && places && best && c->parameters && search ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) {
    memcpy(values, deck->spec->material->values, sizeof(double) * (size_t)parameters);
    status = find_parameters(deck, c, values);
  }
  Search s = {deck, c, values, x, y, count, 0};
  if (!status) {
    nlopt_set_lower_bounds1(search, 0);
    nlopt_set_upper_bounds1(search, 1);
    nlopt_set_min_objective(search, objective, &s);
    nlopt_set_xtol_abs1(search, 1e-6);
    nlopt_set_maxeval(search, MOST_RUNS);
    nlopt_set_initial_step1(search, 0.15);
    c->after = INFINITY;
    uint64_t seed = 1;
    for (int start = 0; start < STARTS; ++start) {
      for (int k = 0; k < c->count; ++k)
        places[k] = start ? random_uniform(&seed) : place_of(&c->parameters[k], c->parameters[k].start);
      if (!start) c->before = distance(&s, places);
      double least = INFINITY;
      if (nlopt_optimize(search, places, &least) < 0 && !isfinite(least)) continue;
      if (least >= c->after) continue;
      c->after = least;
      memcpy(best, places, sizeof(double) * (size_t)fitted);
    }
    if (!(c->after < hopeless))
      status = error_add(error, BRECCIA_FAILURE, "nowhere in the ranges could the test be run to its end");
  }
  for (int k = 0; !status && k < c->count; ++k) {
    double worse = 0;
    for (int side = -1; side <= 1; side += 2) {
      memcpy(places, best, sizeof(double) * (size_t)fitted);
      places[k] = fmin(1, fmax(0, best[k] + 0.01 * side));
      worse = fmax(worse, distance(&s, places) - c->after);
    }
    c->parameters[k].sensitivity = worse;
  }
  if (!status) {
    distance(&s, best);
    c->most = s.most;
    for (int k = 0; k < c->count; ++k) {
      c->parameters[k].value = value_at(&c->parameters[k], best[k]);
      deck->spec->material->values[c->parameters[k].index] = c->parameters[k].value;
    }
    char reason[512] = "";
    const char *name = deck->material.name;
    material_destroy(&deck->material);
    status = material_prepare(&deck->material, deck->law, deck->spec->material->values, reason, sizeof reason);
    deck->material.name = name;
  }
  nlopt_destroy(search);
  free(values);
  free(places);
  free(best);
  return status;
}

void parameter_fit_destroy(ParameterFit *c)
{
  free(c->parameters);
  *c = (ParameterFit){0};
}

#include "model/parameter_fit.h"

#include "base/least_squares.h"
#include "base/linear.h"
#include "base/memory.h"
#include "base/random.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STARTS = 9, TRIES_EACH = 60, MOST_TRIES = 400 };
static const double APART = 0.1; /* of starts, in parts of a range */
static const double AS_NEAR = 2e-4,
                    AS_NEAR_SHARE = 0.02; /* of the points' range and of the best misfit: ends that count as equal */
static const double hopeless = 1e3;       /* misfit where the parameters are inadmissible */

typedef struct Search {
  ElementDeck *deck;
  ParameterFit *fit;
  double *values; /* of all the law's parameters */
  const double *x, *y;
  int count;
  double most;
} Search;

typedef struct Start {
  double *place, misfit, end;
} Start;

static double value_at(const FittedParameter *p, double place)
{
  return p->by_ratio ? p->from * pow(p->to / p->from, place) : p->from + (p->to - p->from) * place;
}

static double place_of(const FittedParameter *p, double value)
{
  const double place =
      p->by_ratio ? log(value / p->from) / log(p->to / p->from) : (value - p->from) / (p->to - p->from);
  return fmin(1, fmax(0, place));
}

/** Runs the test with the parameters of a place.
 *  @param[out] offset  [count][2] of the points from the curve; may be NULL
 *  @param[out] whole   it ran to its end
 *  @return the misfit, larger where the test stopped early */
static double misfit(Search *s, const double *places, double *offset, bool *whole)
{
  ParameterFit *c = s->fit;
  for (int k = 0; k < c->count; ++k) s->values[c->parameters[k].index] = value_at(&c->parameters[k], places[k]);
  char reason[512];
  Material material;
  *whole = false;
  ++c->runs;
  if (material_prepare(&material, s->deck->law, s->values, reason, sizeof reason)) return hopeless;
  Error *ignored = breccia_error_create();
  ElementCurve curve;
  double mean = hopeless;
  const bool ended = !element_test_run(&s->deck->test, &material, &curve, ignored);
  if (curve.count > 1) {
    int rows = 0;
    for (int n = 0; n < s->deck->test.count; ++n) rows += s->deck->test.stages[n].steps;
    mean = element_curve_compare(&curve, s->x, s->y, s->count, offset, &s->most);
    *whole = ended && isfinite(mean);
    if (!ended) mean += 2 * (1 - (double)curve.count / rows);
  }
  element_curve_destroy(&curve);
  breccia_error_destroy(&ignored);
  material_destroy(&material);
  return isfinite(mean) ? mean : hopeless;
}

static bool offsets(void *context, const double *places, double *offset)
{
  bool whole;
  misfit(context, places, offset, &whole);
  return whole;
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
      Text names = {0};
      for (int i = 0; i < k; ++i) text_add(&names, "%s'%s'", i ? ", " : "", deck->law->parameters[i].name);
      status =
          node_error(deck->document, spec->head.node, deck->reader.error, "fit: %s has no parameter '%s'; it has %s",
                     deck->law->name, spec->head.name, names.characters ? names.characters : "none that can be fitted");
      text_free(&names);
      continue;
    }
    const char *dimension = deck->law->parameters[k].dimension, *allowed = deck->law->parameters[k].range;
    double from, to;
    if (deck_number(&deck->reader, spec->from, "from", dimension, NULL, &from) ||
        deck_number(&deck->reader, spec->to, "to", dimension, NULL, &to))
      status = BRECCIA_USER_ERROR;
    else if (!(from < to) || !interval_contains(allowed, from) || !interval_contains(allowed, to)) {
      char range[128];
      interval_describe(allowed, range, sizeof range);
      status =
          node_error(deck->document, spec->head.node, deck->reader.error,
                     "fit: '%s' needs 'from' below 'to', and both %s", spec->head.name, *range ? range : "numbers");
    } else {
      FittedParameter *p = &c->parameters[c->count++];
      *p = (FittedParameter){.index = k, .from = from, .to = to, .start = values[k], .partner = -1};
      /* Moduli, strengths and energies by ratios; numbers and angles if their range is wide. */
      p->by_ratio =
          p->from > 0 && (p->to > 10 * p->from || (strcmp(dimension, "1") != 0 && strcmp(dimension, "angle") != 0));
      if (isnan(p->start)) p->start = value_at(p, 0.5);
    }
  }
  return status;
}

/** Takes a place among the starts if it is better than one near it, or than the worst. The first start is the deck's. */
static void enlist(Start *starts, int *count, int parameters, const double *place, double worth)
{
  int put = -1, worst = -1;
  for (int q = 1; q < *count && put < 0; ++q) {
    double distance = 0;
    for (int k = 0; k < parameters; ++k) distance = fmax(distance, fabs(place[k] - starts[q].place[k]));
    if (distance < APART) put = q;
    if (worst < 0 || starts[q].misfit > starts[worst].misfit) worst = q;
  }
  if (put < 0) put = *count < STARTS ? (*count)++ : worst;
  if (worth >= starts[put].misfit) return;
  memcpy(starts[put].place, place, sizeof(double) * (size_t)parameters);
  starts[put].misfit = worth;
}

/** The starts, found and gone down from. @return which ended best */
static const Start *search(Search *s, LeastSquares *squares, Start *starts, double *place)
{
  ParameterFit *c = s->fit;
  const int tries = TRIES_EACH * c->count < MOST_TRIES ? TRIES_EACH * c->count : MOST_TRIES;
  uint64_t seed = 1;
  bool whole;
  int count = 1;
  for (int q = 0; q < STARTS; ++q) starts[q].misfit = INFINITY;
  for (int k = 0; k < c->count; ++k) starts[0].place[k] = place_of(&c->parameters[k], c->parameters[k].start);
  c->before = starts[0].misfit = misfit(s, starts[0].place, NULL, &whole);
  for (int n = 0; n < tries; ++n) {
    for (int k = 0; k < c->count; ++k) place[k] = random_uniform(&seed);
    enlist(starts, &count, c->count, place, misfit(s, place, NULL, &whole));
  }
  const Start *best = NULL;
  for (int q = 0; q < count; ++q) {
    starts[q].end = sqrt(least_squares_descend(squares, starts[q].place) / s->count);
    c->starts += isfinite(starts[q].end);
    if (isfinite(starts[q].end) && (!best || starts[q].end < best->end)) best = &starts[q];
  }
  c->next = INFINITY;
  for (int q = 0; best && q < count; ++q) {
    if (starts[q].end > best->end * (1 + AS_NEAR_SHARE) + AS_NEAR) {
      c->next = fmin(c->next, starts[q].end);
      continue;
    }
    ++c->agreeing;
    for (int k = 0; k < c->count; ++k) {
      FittedParameter *p = &c->parameters[k];
      const double value = value_at(p, starts[q].place[k]);
      p->lowest = c->agreeing == 1 ? value : fmin(p->lowest, value);
      p->highest = c->agreeing == 1 ? value : fmax(p->highest, value);
    }
  }
  return best;
}

/** Change of a value that belongs to a change of its place. */
static double change(const FittedParameter *p, double step)
{
  if (!(step < 1)) return INFINITY;
  return p->by_ratio ? p->value * (pow(p->to / p->from, step) - 1) : (p->to - p->from) * step;
}

/** What the curvature of the misfit says of each parameter. */
static int judge(Search *s, LeastSquares *squares, const double *best, Error *error)
{
  ParameterFit *c = s->fit;
  const int n = c->count;
  double *curvature = memory_zeroed((size_t)(n * n), sizeof(double), "curvature", error),
         *copy = memory_zeroed((size_t)(n * n), sizeof(double), "curvature", error),
         *inverse = memory_zeroed((size_t)(n * n), sizeof(double), "curvature", error), largest = 0;
  if (curvature && copy && inverse) {
    const double margin = s->count * FIT_MARGIN * FIT_MARGIN,
                 variance = s->count > n ? s->count * c->after * c->after / (s->count - n) : INFINITY;
    least_squares_curvature(squares, best, curvature);
    for (int k = 0; k < n; ++k) largest = fmax(largest, curvature[n * k + k]);
    for (int k = 0; k < n; ++k) {
      inverse[n * k + k] = 1;
      for (int l = 0; l < n; ++l) copy[n * k + l] = curvature[n * k + l] + (k == l ? 1e-10 * largest : 0);
    }
    const bool regular = largest > 0 && linear_solve(n, copy, n, inverse);
    for (int k = 0; k < n; ++k) {
      FittedParameter *p = &c->parameters[k];
      const double own = inverse[n * k + k];
      p->margin_alone = change(p, sqrt(margin / curvature[n * k + k]));
      p->margin = regular ? change(p, sqrt(margin * own)) : INFINITY;
      p->deviation = regular ? change(p, sqrt(variance * own)) : INFINITY;
      for (int l = 0; regular && l < n; ++l) {
        const double correlation = inverse[n * k + l] / sqrt(own * inverse[n * l + l]);
        if (l == k || !(fabs(correlation) > fabs(p->correlation))) continue;
        p->correlation = correlation;
        p->partner = l;
      }
    }
  }
  const int status = curvature && copy && inverse ? BRECCIA_OK : BRECCIA_FAILURE;
  free(curvature);
  free(copy);
  free(inverse);
  return status;
}

/** Leaves the deck with the best parameters. */
static int settle(Search *s, const double *best, Error *error)
{
  ElementDeck *deck = s->deck;
  ParameterFit *c = s->fit;
  bool whole;
  c->after = misfit(s, best, NULL, &whole);
  c->most = s->most;
  for (int k = 0; k < c->count; ++k) {
    c->parameters[k].value = value_at(&c->parameters[k], best[k]);
    deck->spec->material->values[c->parameters[k].index] = c->parameters[k].value;
  }
  char reason[512] = "";
  const char *name = deck->material.name;
  material_destroy(&deck->material);
  const int status = material_prepare(&deck->material, deck->law, deck->spec->material->values, reason, sizeof reason);
  deck->material.name = name;
  return status ? error_add(error, status, "%s: %s", deck->law->name, reason) : BRECCIA_OK;
}

int parameter_fit_run(ElementDeck *deck, const double *x, const double *y, int count, ParameterFit *c, Error *error)
{
  const int parameters = deck->law->parameter_count, fitted = deck->spec->fit.count;
  *c = (ParameterFit){0};
  if (!fitted)
    return node_error(deck->document, deck->spec->head.node, error,
                      "nothing to calibrate: give the parameters and their ranges under 'fit', like 'fit: {cohesion: "
                      "{from: 5, to: 50}}'");
  if (count < fitted)
    return node_error(deck->document, section_node(deck->spec, "fit"), error,
                      "fit: %d parameters cannot be told from %d points; fit fewer, or measure more", fitted, count);
  double *values = memory_zeroed((size_t)parameters, sizeof(double), "parameters", error),
         *places = memory_zeroed((size_t)((STARTS + 1) * fitted), sizeof(double), "parameters", error);
  c->parameters = memory_zeroed((size_t)fitted, sizeof *c->parameters, "parameters", error);
  Search s = {deck, c, values, x, y, count, 0};
  LeastSquares squares = {.parameters = fitted, .count = 2 * count, .residuals = offsets, .context = &s};
  int status = values && places && c->parameters ? least_squares_create(&squares, error) : BRECCIA_FAILURE;
  if (!status) {
    memcpy(values, deck->spec->material->values, sizeof(double) * (size_t)parameters);
    status = find_parameters(deck, c, values);
  }
  if (!status) {
    Start starts[STARTS];
    for (int q = 0; q < STARTS; ++q) starts[q].place = places + q * fitted;
    const Start *best = search(&s, &squares, starts, places + STARTS * fitted);
    if (!best)
      status = error_add(error, BRECCIA_FAILURE, "nowhere in the ranges could the test be run to its end");
    else
      status = settle(&s, best->place, error);
    if (!status) status = judge(&s, &squares, best->place, error);
  }
  least_squares_destroy(&squares);
  free(values);
  free(places);
  return status;
}

void parameter_fit_destroy(ParameterFit *c)
{
  free(c->parameters);
  *c = (ParameterFit){0};
}

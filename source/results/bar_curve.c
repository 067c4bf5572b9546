#include "results/bar_curve.h"

#include "base/memory.h"
#include "base/text.h"
#include "deck/spelling.h"
#include "results/display_unit.h"
#include "results/picture.h"
#include "results/plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BARS = 6, MOST_DASHES = 5, MOST_LINES = 12, TITLE = 160 };

typedef struct Curves { /* of one picture */
  BarView bars;
  double *along, *values[BAR_CURVE_TIMES];
  bool *taken;
  char unit[64], titles[MOST_LINES][TITLE];
  PlotLine lines[MOST_LINES];
  int count, asked, bar_count, chosen[MOST_BARS]; /* asked: bars among which those are chosen */
} Curves;

static int read_curves(Curves *c, const ResultView *view, const BarCurveOptions *o, Error *error)
{
  int status = bar_view_open(&c->bars, view, error);
  if (status) return status;
  c->along = bar_view_along(&c->bars, error);
  c->taken = memory_zeroed((size_t)c->bars.lines, sizeof(bool), "bars", error);
  if (!c->along || !c->taken) return BRECCIA_FAILURE;
  for (int t = 0; t < o->count; ++t) {
    c->values[t] = bar_view_read(&c->bars, view, o->column, o->steps[t], c->unit, error);
    if (!c->values[t]) return result_view_lost(view);
  }
  return BRECCIA_OK;
}

static double most_in(const Curves *c, int bar, int times)
{
  double most = 0;
  for (int t = 0; t < times; ++t)
    for (int64_t e = c->bars.first[bar]; e < c->bars.first[bar + 1]; ++e) most = fmax(most, fabs(c->values[t][e]));
  return most;
}

/** The lines of a bar, one at each time: times by colours and bars by dashes, or bars by colours at one time. */
static void add_bar(Curves *c, int number, const ResultView *view, const BarCurveOptions *o)
{
  const int bar = c->chosen[number];
  const int64_t from = c->bars.first[bar];
  for (int t = 0; t < o->count; ++t) {
    char time[96];
    picture_time(view, o->steps[t], false, time, sizeof time);
    char *title = c->titles[c->count];
    if (o->count == 1)
      snprintf(title, TITLE, "%s", c->bars.name[bar]);
    else if (c->bar_count == 1)
      snprintf(title, TITLE, "%s", time);
    else
      snprintf(title, TITLE, "%.60s, %s", c->bars.name[bar], time);
    c->lines[c->count++] = (PlotLine){.title = title,
                                      .x = c->along + from,
                                      .y = c->values[t] + from,
                                      .count = (int)(c->bars.first[bar + 1] - from),
                                      .colour = o->count == 1 ? number : t,
                                      .dash = o->count == 1 ? 0 : number};
  }
}

bool bar_curve_names(const char *line, const char *name)
{
  const size_t n = strlen(name);
  if (strncmp(line, name, n) != 0) return false;
  return !line[n] || (line[n] == ' ' && line[n + 1] && strspn(line + n + 1, "0123456789") == strlen(line + n + 1));
}

/** Leaves out bars that were not asked for. */
static int ask(Curves *c, const BarCurveOptions *o, Error *error)
{
  c->asked = o->name_count ? 0 : c->bars.lines;
  for (int n = 0; n < c->bars.lines && o->name_count; ++n) c->taken[n] = true;
  for (int k = 0; k < o->name_count; ++k) {
    bool exact = false, found = false;
    for (int n = 0; n < c->bars.lines; ++n) exact |= !strcmp(c->bars.name[n], o->names[k]);
    for (int n = 0; n < c->bars.lines; ++n) {
      if (exact ? strcmp(c->bars.name[n], o->names[k]) != 0 : !bar_curve_names(c->bars.name[n], o->names[k])) continue;
      found = true;
      c->asked += c->taken[n];
      c->taken[n] = false;
    }
    if (found) continue;
    Text advice = {0};
    spelling_advice(&advice, o->names[k], c->bars.name, c->bars.lines, "bars are");
    const int status =
        error_add(error, BRECCIA_USER_ERROR, "there is no bar '%s'; %s", o->names[k], text_words(&advice));
    text_free(&advice);
    return status;
  }
  return BRECCIA_OK;
}

/** Those with the largest values, but none that has hardly any beside others, unless it was asked for. */
static void choose_bars(Curves *c, const ResultView *view, const BarCurveOptions *o)
{
  const int most_bars = o->count == 1 ? MOST_BARS : MOST_DASHES;
  const int room = MOST_LINES / o->count < most_bars ? MOST_LINES / o->count : most_bars;
  double largest = 0;
  while (c->bar_count < c->asked && c->bar_count < room) {
    int next = -1;
    double most = 0;
    for (int n = 0; n < c->bars.lines; ++n) {
      const double here = c->taken[n] ? 0 : most_in(c, n, o->count);
      if (c->taken[n] || (next >= 0 && !(here > most))) continue;
      next = n;
      most = here;
    }
    if (!c->bar_count) largest = most;
    if (c->bar_count && !o->name_count && most <= 0.02 * largest) break;
    c->taken[next] = true;
    c->chosen[c->bar_count++] = next;
  }
  for (int k = 0; k < c->bar_count; ++k) add_bar(c, k, view, o);
}

/** "Stress along bar 'bottom' at 2 s". */
static void find_title(const Curves *c, const ResultView *view, const BarCurveOptions *o, char *title, size_t size)
{
  char heading[96], time[96] = "", at[112] = "";
  display_heading(o->column, "", heading, sizeof heading);
  if (o->count == 1) {
    picture_time(view, o->steps[0], false, time, sizeof time);
    snprintf(at, sizeof at, " at %s", time);
  }
  if (c->bar_count == 1)
    snprintf(title, size, "%s along bar '%.60s'%s", heading, c->bars.name[c->chosen[0]], at);
  else if (c->bar_count < c->asked)
    snprintf(title, size, "%s along bars%s: %d of %d, those with the largest", heading, at, c->bar_count, c->asked);
  else
    snprintf(title, size, "%s along bars%s", heading, at);
}

int bar_curve_draw(const ResultView *view, const BarCurveOptions *o, const char *path, Error *error)
{
  Curves *c = memory_zeroed(1, sizeof *c, "bars", error);
  if (!c) return BRECCIA_FAILURE;
  int status = o->count >= 1 && o->count <= BAR_CURVE_TIMES
                   ? read_curves(c, view, o, error)
                   : error_add(error, BRECCIA_USER_ERROR,
                               "curves over the length of bars are drawn at up to %d times, and these are %d; choose "
                               "some of them",
                               BAR_CURVE_TIMES, o->count);
  if (!status) status = ask(c, o, error);
  if (!status) {
    char title[320];
    choose_bars(c, view, o);
    find_title(c, view, o, title, sizeof title);
    const PlotOptions options = {.title = o->title ? o->title : title,
                                 .x = {.words = "along the bar",
                                       .unit = view->length_unit,
                                       .label = o->x_label,
                                       .logarithmic = plot_is_logarithmic(o->log_axes, 'x')},
                                 .y = {.words = o->column,
                                       .unit = c->unit,
                                       .label = o->y_label,
                                       .logarithmic = plot_is_logarithmic(o->log_axes, 'y')},
                                 .low = o->low,
                                 .high = o->high,
                                 .no_gnuplot = o->no_gnuplot};
    status = plot_draw(c->lines, c->count, &options, path, error);
  }
  bar_view_close(&c->bars);
  for (int t = 0; t < BAR_CURVE_TIMES; ++t) free(c->values[t]);
  free(c->along);
  free(c->taken);
  free(c);
  return status;
}

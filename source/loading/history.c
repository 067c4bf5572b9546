#include "loading/history.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

#define HISTORY(name, key, kind, dimension, range, meaning) extern const HistoryType name##_history;
#define HISTORY_SECTION(name, key, meaning)                                                                            \
  extern const HistoryType name##_history;                                                                             \
  extern const Section name##_history_section;
#include "loading/history/histories.h"

static const HistoryType *const types[] = {
#define HISTORY(name, key, kind, dimension, range, meaning) &name##_history,
#include "loading/history/histories.h"
};

static const Field history_fields[] = {
#define HISTORY(name, word, form, measure, interval, about)                                                            \
  {.key = word,                                                                                                        \
   .kind = form,                                                                                                       \
   .offset = offsetof(HistorySpec, of[HISTORY_##name]),                                                                \
   .dimension = measure,                                                                                               \
   .standard = "",                                                                                                     \
   .range = interval,                                                                                                  \
   .meaning = about,                                                                                                   \
   .group = 'A'},
#define HISTORY_SECTION(name, word, about)                                                                             \
  {.key = word,                                                                                                        \
   .kind = FIELD_SECTION,                                                                                              \
   .offset = offsetof(HistorySpec, of[HISTORY_##name]),                                                                \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &name##_history_section,                                                                                 \
   .group = 'A'},
#define HISTORY_LIST(name, word, about)                                                                                \
  {.key = word,                                                                                                        \
   .kind = FIELD_SECTIONS,                                                                                             \
   .offset = offsetof(HistorySpec, of[HISTORY_##name]),                                                                \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &history_section,                                                                                        \
   .group = 'A'},
#include "loading/history/histories.h"
};

const Section history_section = {.name = "history",
                                 .about = "How a load varies in time: a factor on its value.",
                                 .size = sizeof(HistorySpec),
                                 FIELDS(history_fields)};

int history_create(History *history, const HistorySpec *spec, const DeckReader *reader)
{
  *history = (History){0};
  if (!spec) return BRECCIA_OK;
  int k = 0;
  while (!node_get(spec->head.node, history_fields[k].key)) ++k;
  history->type = types[k];
  history->value = &spec->of[k];
  history->value_node = node_get(spec->head.node, history_fields[k].key);
  return types[k]->create ? types[k]->create(history, reader) : BRECCIA_OK;
}

void history_destroy(History *history)
{
  for (int k = 0; k < history->part_count; ++k) history_destroy(&history->parts[k]);
  free(history->parts);
  free(history->line.sums);
  free(history->rows);
  free(history->panels);
  *history = (History){0};
}

/** NULL: constant 1. */
static const HistoryType *type_of(const History *history)
{
  return history->type ? history->type : history->grown > 0 ? &ramp_history : NULL;
}

double history_factor(const History *history, double time)
{
  const HistoryType *type = type_of(history);
  return type ? type->factor(history, time) : 1;
}

bool history_is_controlled(const History *history)
{
  return history->type == &controlled_history;
}

static double farther(double peak, double factor)
{
  return fabs(factor) > fabs(peak) ? factor : peak;
}

/** Calls `one` with the factors from time 0 up to a time, at equidistant times and at corners of the history. */
static void each_factor(const History *h, double time, void (*one)(void *context, double factor), void *context)
{
  enum { SAMPLES = 1000, MOST_CORNERS = 1000000 };
  double corner = 0;
  for (int k = 0; k <= SAMPLES; ++k) one(context, history_factor(h, time * k / SAMPLES));
  for (int k = 0; k < MOST_CORNERS && (corner = type_of(h)->corner(h, corner)) < time; ++k)
    one(context, history_factor(h, corner));
}

static void take_farther(void *peak, double factor)
{
  *(double *)peak = farther(*(double *)peak, factor);
}

double history_peak(const History *h, double time)
{
  double peak = 0;
  if (!type_of(h)) return 1;
  if (history_is_controlled(h)) return h->most;
  each_factor(h, time, take_farther, &peak);
  return peak;
}

typedef struct Least {
  double change, value, factor;
} Least;

static void take_less(void *context, double factor)
{
  Least *least = context;
  const double value = 1 + least->change * factor;
  if (!(value < least->value)) return;
  least->value = value;
  least->factor = factor;
}

double history_least(const History *h, double change, double time, double *factor)
{
  const double rises = 10; /* rise times that are searched if the duration of the load is unknown */
  Least least = {.change = change, .value = INFINITY};
  if (type_of(h))
    each_factor(h, isfinite(time) ? time : rises * history_rise(h), take_less, &least);
  else
    take_less(&least, 1);
  *factor = least.factor;
  return least.value;
}

double history_corner(const History *history, double time)
{
  return type_of(history) ? type_of(history)->corner(history, time) : INFINITY;
}

double history_rise(const History *history)
{
  const HistoryType *type = type_of(history);
  return type ? type->rise(history) : 0;
}

/* ---- integrals by Gauss' quadrature, five points between two corners: exact for polynomials of degree nine ---- */

static Panel next_panel(const History *h, const Panel *from, double to)
{
  enum { POINTS = 5 };
  static const double at[POINTS] = {-0.90617984593866399, -0.53846931010568309, 0, 0.53846931010568309,
                                    0.90617984593866399},
                      weight[POINTS] = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889,
                                        0.47862867049936647, 0.23692688505618909};
  const double half = (to - from->time) / 2, middle = (to + from->time) / 2;
  double once = 0, twice = 0;
  for (int k = 0; k < POINTS; ++k) {
    const double time = middle + half * at[k], part = half * weight[k] * history_factor(h, time);
    once += part;
    twice += part * (to - time);
  }
  return (Panel){to, from->once + once, from->twice + from->once * 2 * half + twice};
}

static void keep(History *h, const Panel *panel)
{
  if (h->panel_count == h->panel_capacity) {
    const int64_t more = h->panel_capacity ? 2 * h->panel_capacity : 64;
    Panel *grown = memory_grown(h->panels, (size_t)more, sizeof(Panel));
    if (!grown) return; /* it is found again the next time */
    h->panels = grown;
    h->panel_capacity = more;
  }
  h->panels[h->panel_count++] = *panel;
}

/** Integrals up to a time, from the last corner before it that is known. */
static Panel panel_at(History *h, double time)
{
  int64_t low = 0, high = h->panel_count; /* panels before `low` end no later than the time */
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (h->panels[middle].time <= time)
      low = middle + 1;
    else
      high = middle;
  }
  Panel panel = low ? h->panels[low - 1] : (Panel){0};
  for (double corner; (corner = type_of(h)->corner(h, panel.time)) < time; ++low) {
    panel = next_panel(h, &panel, corner);
    if (low == h->panel_count) keep(h, &panel);
  }
  return next_panel(h, &panel, time);
}

double history_integral(History *h, int order, double scale, double time)
{
  const HistoryType *type = type_of(h);
  if (!type) return order == 1 ? scale * time : scale * time * time / 2;
  const double known = order == 1 && type->integral ? type->integral(h, scale, time) : NAN;
  if (!isnan(known)) return known;
  const Panel panel = panel_at(h, time);
  return scale * (order == 1 ? panel.once : panel.twice);
}

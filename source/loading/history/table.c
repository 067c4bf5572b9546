#include "loading/history.h"

static int create(History *h, const DeckReader *reader)
{
  h->line = (Polyline){.rows = h->value->rows.values, .count = h->value->rows.count};
  return polyline_prepare(&h->line, reader->error);
}

static double factor(const History *h, double time)
{
  return polyline_value(&h->line, time);
}

static double integral(const History *h, double scale, double time)
{
  return scale * polyline_integral(&h->line, time);
}

static double corner(const History *h, double time)
{
  return polyline_corner(&h->line, time);
}

static double rise(const History *h)
{
  return polyline_rise(&h->line);
}

const HistoryType table_history = {
    .create = create, .factor = factor, .integral = integral, .corner = corner, .rise = rise};

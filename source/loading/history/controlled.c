#include "loading/history.h"

#include <math.h>

static int create(History *h, const DeckReader *reader)
{
  if (*(const bool *)h->value) return BRECCIA_OK;
  return node_error(reader->document, h->value_node, reader->error,
                    "controlled: only 'yes' means something; a load without 'history' acts in full");
}

static double factor(const History *h, double time)
{
  (void)time;
  return h->found;
}

static double integral(const History *h, double scale, double time)
{
  return scale * h->found * time;
}

static double corner(const History *h, double time)
{
  (void)h;
  (void)time;
  return INFINITY;
}

static double rise(const History *h)
{
  (void)h;
  return 0;
}

const HistoryType controlled_history = {
    .create = create, .factor = factor, .integral = integral, .corner = corner, .rise = rise};

#include "loading/history/parts.h"

#include "base/memory.h"
#include <math.h>

int parts_create(History *h, const DeckReader *reader)
{
  const SectionList *list = &h->value->list;
  if (!list->count)
    return node_error(reader->document, h->value_node, reader->error, "%s: the list is empty", h->value_node->key);
  h->parts = memory_zeroed((size_t)list->count, sizeof *h->parts, "history", reader->error);
  if (!h->parts) return BRECCIA_FAILURE;
  int status = BRECCIA_OK;
  while (h->part_count < list->count && !status) {
    status = history_create(&h->parts[h->part_count], list->items[h->part_count], reader);
    if (!status && history_is_controlled(&h->parts[h->part_count]))
      status = node_error(reader->document, h->value_node, reader->error,
                          "%s: a factor that is found by control has no place in it; let the load have 'history: "
                          "{controlled: yes}' alone",
                          h->value_node->key);
    ++h->part_count;
  }
  return status;
}

double parts_corner(const History *h, double time)
{
  double first = INFINITY;
  for (int k = 0; k < h->part_count; ++k)
    if (h->parts[k].type) first = fmin(first, h->parts[k].type->corner(&h->parts[k], time));
  return first;
}

double parts_rise(const History *h)
{
  double longest = 0;
  for (int k = 0; k < h->part_count; ++k) longest = fmax(longest, history_rise(&h->parts[k]));
  return longest;
}

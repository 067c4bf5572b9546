/* Supports whose images outside the body are too few. */
#include "model/plausibility_parts.h"

/** Two faces of a block that are held one opposite the other: beyond as many layers as stand between them a mirror would show its own image in the
 *  other one, which is not there. */
static void check_pair(breccia_model *model, const Margin *low, const Margin *high)
{
  const Lattice *lattice = &model->domain.body.lattices[low->block];
  const int k = low->axis;
  const int64_t between = lattice->cells[k] - lattice->margin[k][0] - lattice->margin[k][1],
                wanted = low->layers > high->layers ? low->layers : high->layers;
  if (between >= wanted) return;
  const LoadSpec *of = (high->owner == low->owner ? low : high)->owner;
  plausibility_say(
      model, of->head.node,
      "support: %lld layer%s between the faces %c- and %c+, which are both held, and %lld outside each are wanted: "
      "families there are not whole, and stresses are off by some per cent with one layer less, by half with half of "
      "them; take a finer spacing or a shorter horizon, or hold one face by 'displacement'",
      (long long)between, between == 1 ? " stands" : "s stand", "xyz"[k], "xyz"[k], (long long)wanted);
}

void plausibility_warn_of_supports(breccia_model *model)
{
  const MarginList *list = &model->domain.body.margins;
  for (int a = 0; a < list->count; ++a)
    for (int b = 0; b < list->count; ++b) {
      const Margin *low = &list->items[a], *high = &list->items[b];
      if (low->block == high->block && low->axis == high->axis && !low->high && high->high && !low->repeats)
        check_pair(model, low, high);
    }
}

/* Supports whose images outside the body are too few, or not as the body inside. */
#include "model/plausibility_parts.h"

#include <math.h>

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

static double distance(const Particles *p, int32_t a, int32_t b)
{
  double square = 0;
  for (int k = 0; k < 3; ++k) square += pow(p->position[k][a] - p->position[k][b], 2);
  return sqrt(square);
}

/** Whether a place outside a face has a bond to another one there which the places inside that they stand for have not: a crack has cut that. */
static bool holds_crack_together(const Domain *d, int64_t number)
{
  const Body *body = &d->body;
  const Particles *p = d->particles;
  const int32_t place = p->place_of[number], image = p->place_of[body->image_of[number]];
  for (int64_t slot = d->family.first[place / SLICE]; slot < d->family.first[place / SLICE + 1]; ++slot) {
    if (!(d->family.intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(&d->family, place / SLICE, slot, place % SLICE);
    const int64_t other = p->number[bond.neighbour];
    if (body->margin_of[other] != body->margin_of[number]) continue;
    const int32_t inside = p->place_of[body->image_of[other]];
    if (fabs(distance(p, image, inside) - bond.length) > 1e-6 * bond.length) continue;
    if (family_slot(&d->family, image, inside) < 0) return true;
  }
  return false;
}

static void check_cracks(breccia_model *model, int margin)
{
  const Body *body = &model->domain.body;
  const Margin *of = &body->margins.items[margin];
  int64_t number = 0;
  while (number < model->domain.particles->count &&
         (body->margin_of[number] != margin || !holds_crack_together(&model->domain, number)))
    ++number;
  if (number == model->domain.particles->count) return;
  plausibility_say(model, ((const LoadSpec *)of->owner)->head.node,
                   "support: a crack of the body is none in the layers outside the face %c%c, which stand for it there "
                   "and so hold it together: draw the crack on outside the face as it goes on there, at least two "
                   "horizons far",
                   "xyz"[of->axis], of -> high ? '+' : '-');
}

void plausibility_warn_of_supports(breccia_model *model)
{
  const MarginList *list = &model->domain.body.margins;
  for (int a = 0; a < list->count && model->domain.body.crack_count; ++a) check_cracks(model, a);
  for (int a = 0; a < list->count; ++a)
    for (int b = 0; b < list->count; ++b) {
      const Margin *low = &list->items[a], *high = &list->items[b];
      if (low->block == high->block && low->axis == high->axis && !low->high && high->high && !low->repeats)
        check_pair(model, low, high);
    }
}

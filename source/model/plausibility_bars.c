/* Bars whose size is not that of reinforcement, and bars at faces beyond which they are not carried on. */
#include "model/plausibility_parts.h"

#include "bars/bars.h"
#include <math.h>
#include <string.h>

static void check_amount(breccia_model *model, const Bars *b)
{
  const double most = 0.1; /* of the body's volume; reinforced concrete has 0.002 to 0.04 */
  double steel = 0, body = 0;
  int largest = 0;
  for (int64_t e = 0; e < b->count; ++e) steel += b->area[e] * b->length[e];
  for (int64_t i = 0; i < model->domain.particles->places; ++i) body += model->domain.counted[i];
  for (int n = 1; n < b->specs->count; ++n)
    if (b->bar_area[n] > b->bar_area[largest]) largest = n;
  if (!(steel > most * body)) return;
  const BarSpec *bar = b->specs->items[largest];
  const char *const key = isnan(bar->area) ? "diameter" : "area";
  plausibility_say(model, section_node(bar, key),
                   "%s: bars take %.3g of the volume of the body, and reinforced concrete has 0.002 to 0.04; look at "
                   "the units",
                   key, steel / body);
}

/** Whether a place stands in the outermost row before layers outside a face. */
static bool is_outermost(const Domain *d, int32_t place)
{
  const Family *f = &d->family;
  const int64_t slice = place / SLICE;
  const double near = 1.05 * d->body.lattices[d->particles->block[slice]].spacing;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> place % SLICE & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, place % SLICE);
    if (bond.length < near && body_outside(&d->body, d->particles->number[bond.neighbour])) return true;
  }
  return false;
}

static void check_faces(breccia_model *model, const Bars *b, int n)
{
  if (!model->domain.body.margin_of) return;
  const BarSpec *bar = b->lines.deck->items[n];
  const int64_t from = b->first[b->lines.first[n]], to = b->first[b->lines.first[n + 1]];
  for (int64_t k = b->begin[from]; k < b->begin[to]; ++k) {
    if (!is_outermost(&model->domain, b->joined.place[k])) continue;
    plausibility_say(
        model, section_node(bar, "points"),
        "points: bar '%s' comes to a face with 'support', and is not carried on in the layers outside: its "
        "force goes into the body before that face, where stresses are wrong for some spacings; hold the "
        "face by 'displacement' where bars cross it",
        bar->head.name);
    return;
  }
}

/** Warns of a number that a bond law takes root or slip from, so that a wrong unit would not show elsewhere. */
static void check_size(breccia_model *model, const BondSpec *bond, const char *key, const char *dimension, double value,
                       const char *unit, double least, double most, const char *what, const char *how)
{
  const double real = plausibility_in_si(model, dimension, value);
  if (!(real < least || real > most)) return;
  const Node *node = section_node(bond, key);
  Text words = {0}, low = {0}, high = {0};
  quantity_describe(real, unit, &words);
  quantity_describe(least, unit, &low);
  quantity_describe(most, unit, &high);
  const bool told = node->kind != NODE_SCALAR || !strcmp(node->text, text_words(&words));
  plausibility_say(model, node, "%s: %s%s%s; %s %s to %s%s; look at its unit", key, told ? "" : node->text,
                   told ? "" : " is ", text_words(&words), what, text_words(&low), text_words(&high), how);
  text_free(&words);
  text_free(&low);
  text_free(&high);
}

static void check_bond(breccia_model *model, const BondSpec *bond)
{
  if (!bond || !strcmp(bond->law, "linear")) return;
  check_size(model, bond, "compressive strength", "stress", bond->strength, "Pa", 8e6, 200e6,
             "concrete around bars has", "");
  check_size(model, bond, "rib spacing", "length", bond->rib_spacing, "m", 1e-3, 50e-3, "ribs of bars stand", " apart");
}

void plausibility_warn_of_bars(breccia_model *model)
{
  const Bars *b = bars_among(&model->domain.forces);
  if (!b) return;
  check_amount(model, b);
  for (int n = 0; n < b->lines.deck->count; ++n) {
    check_faces(model, b, n);
    check_bond(model, ((const BarSpec *)b->lines.deck->items[n])->bond);
  }
}

/* Bars whose size is not that of reinforcement, and bars at faces beyond which they are not carried on. */
#include "model/plausibility_parts.h"

#include "bars/bars.h"
#include <math.h>
#include <stdlib.h>
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
                   "the units%s",
                   key, steel / body, bar->number > 1 ? ", and at 'number'" : "");
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

/** The same of stiffnesses of bond, which are told by the millimetre. */
static void check_stiffness(breccia_model *model, const BondSpec *bond, const char *key, double value)
{
  const double least = 1, most = 1e5, real = plausibility_in_si(model, "force per volume", value) / 1e9; /* MPa/mm */
  if (real >= least && real <= most) return;
  plausibility_say(model, section_node(bond, key),
                   "%s: %.3g MPa/mm; bond of bars in concrete has %g MPa/mm to %g MPa/mm; look at its unit", key, real,
                   least, most);
}

static void check_bond(breccia_model *model, const BondSpec *bond)
{
  if (!bond) return;
  if (!strcmp(bond->law, "linear")) {
    check_stiffness(model, bond, "stiffness", bond->stiffness);
    return;
  }
  check_stiffness(model, bond, "unloading stiffness", bond->unloading);
  check_size(model, bond, "compressive strength", "stress", bond->strength, "Pa", 8e6, 200e6,
             "concrete around bars has", "");
  check_size(model, bond, "rib spacing", "length", bond->rib_spacing, "m", 1e-3, 50e-3, "ribs of bars stand", " apart");
}

static const Material *material_of(const breccia_model *model, const BarSpec *bar)
{
  const Material *m = model->domain.materials;
  while (strcmp(m->name, bar->material) != 0) ++m;
  return m;
}

/** Stress and stiffness in units that do not belong together: steel yields at strains from 0.0005 (structural) to 0.01 (of tendons). */
static void check_yield(breccia_model *model, const Material *m)
{
  const double least = 1e-4, most = 0.05, strain = plausibility_parameter(model, m, "yield stress") / material_young(m);
  if (!(strain < least || strain > most)) return;
  plausibility_say(
      model, section_node(plausibility_spec(model, m), "yield stress"),
      "yield stress: over Young's modulus it makes a strain of %.3g, and steel of bars yields at 0.0005 to "
      "0.01; look at the units of both",
      strain);
}

static void check_yields(breccia_model *model, const Bars *b)
{
  for (int k = 0; k < model->domain.material_count; ++k) {
    const Material *m = &model->domain.materials[k];
    bool of_bars = false;
    for (int n = 0; n < b->lines.deck->count; ++n) of_bars |= material_of(model, b->lines.deck->items[n]) == m;
    if (of_bars) check_yield(model, m);
  }
}

/** Tendons that yield before the body resists. */
static void check_prestress(breccia_model *model, const Bars *b, const Load *load)
{
  if (!plausibility_is_kind(load->spec, "prestress")) return;
  double *strain = memory_zeroed((size_t)b->specs->count, sizeof *strain, "bars", NULL);
  if (strain) load->type->strain(load, &(LoadStrains){.of_bars = strain, .bar_count = b->specs->count}, 1);
  for (int n = 0; strain && n < b->lines.deck->count; ++n) {
    const BarSpec *bar = b->lines.deck->items[n];
    const Material *m = material_of(model, bar);
    const double stress = material_young(m) * strain[b->lines.first[n]],
                 yield = plausibility_parameter(model, m, "yield stress");
    if (!(fabs(stress) > yield)) continue;
    Text words = {0}, most = {0};
    quantity_describe(plausibility_in_si(model, "stress", stress), "Pa", &words);
    quantity_describe(plausibility_in_si(model, "stress", yield), "Pa", &most);
    plausibility_say(
        model, load->node,
        "prestress: %s in bar '%s' is beyond the yield stress of its material '%s', %s: it yields where the "
        "body resists; look at the units",
        text_words(&words), bar->head.name, m->name, text_words(&most));
    text_free(&words);
    text_free(&most);
  }
  free(strain);
}

void plausibility_warn_of_bars(breccia_model *model)
{
  const Bars *b = bars_among(&model->domain.forces);
  if (!b) return;
  check_amount(model, b);
  check_yields(model, b);
  for (int l = 0; l < model->loading.count; ++l) check_prestress(model, b, &model->loading.loads[l]);
  for (int n = 0; n < b->lines.deck->count; ++n) {
    check_faces(model, b, n);
    check_bond(model, ((const BarSpec *)b->lines.deck->items[n])->bond);
  }
}

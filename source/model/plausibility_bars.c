/* Bars whose size is not that of reinforcement, and bars at faces beyond which they are not carried on. */
#include "model/plausibility_parts.h"

#include "bars/bars.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Volume of all lines of a bar of the deck. */
static double volume_of(const Bars *b, int deck_bar)
{
  double sum = 0;
  for (int64_t e = b->first[b->lines.first[deck_bar]]; e < b->first[b->lines.first[deck_bar + 1]]; ++e)
    sum += b->area[e] * b->length[e];
  return sum;
}

static double volume_of_body(const breccia_model *model)
{
  double sum = 0;
  for (int64_t i = 0; i < model->domain.particles->places; ++i) sum += model->domain.counted[i];
  return sum;
}

static const char *size_key(const BarSpec *bar)
{
  return isnan(bar->area) ? "diameter" : "area";
}

/** Whether a bar is repeated over a length, so that its pitch says how often. */
static bool is_repeated_by_pitch(const BarSpec *bar)
{
  for (int k = 0; k < bar->repeat.count; ++k)
    if (node_get(((const SectionHead *)bar->repeat.items[k])->node, "over")) return true;
  return false;
}

static void check_amount(breccia_model *model, const Bars *b, double body)
{
  const double most = 0.1; /* of the body's volume; reinforced concrete has 0.002 to 0.04 */
  double steel = 0, largest = 0;
  int of = 0;
  for (int n = 0; n < b->lines.deck->count; ++n) {
    const double volume = volume_of(b, n);
    steel += volume;
    if (volume > largest) of = n;
    largest = fmax(largest, volume);
  }
  if (!(steel > most * body)) return;
  const BarSpec *bar = b->lines.deck->items[of];
  const char *const key = size_key(bar);
  plausibility_say(
      model, section_node(bar, key),
      "%s: bars take %.3g of the volume of the body, and reinforced concrete has 0.002 to 0.04; the largest part of it "
      "is bar '%s': look at the units%s%s",
      key, steel / body, bar->head.name, bar->number > 1 ? ", and at 'number'" : "",
      is_repeated_by_pitch(bar) ? ", and at the 'pitch'"
      : bar->repeat.count       ? ", and at how often it is repeated"
                                : "");
}

/** One bar, of all parallel ones on a line. In the deck's units. */
static double area_of_one(const Bars *b, int deck_bar)
{
  const BarSpec *bar = b->lines.deck->items[deck_bar];
  return b->bar_area[b->lines.first[deck_bar]] / (double)bar->number;
}

/** Wires thinner than two millimetres of which all lines together are next to nothing in the body. */
static void check_thinness(breccia_model *model, const Bars *b, double body, int deck_bar)
{
  const double thin = 3e-6, least = 1e-5; /* m2, of the body's volume */
  const BarSpec *bar = b->lines.deck->items[deck_bar];
  const double area = plausibility_in_si(model, "area", area_of_one(b, deck_bar)),
               share = volume_of(b, deck_bar) / body;
  if (area >= thin || share >= least) return;
  const char *const key = size_key(bar);
  plausibility_say(
      model, section_node(bar, key),
      "%s: bar '%s' has a section of %.2g mm2 and takes %.2g of the volume of the body, and reinforcement has "
      "20 mm2 to 3000 mm2 a bar and 0.002 to 0.04 of a body; look at its unit",
      key, bar->head.name, 1e6 * area, share);
}

/** Lines that lie within one particle, as in metres where the body is in millimetres. */
static void check_length(breccia_model *model, const Bars *b, int deck_bar)
{
  const Body *body = &model->domain.body;
  const BarSpec *bar = b->lines.deck->items[deck_bar];
  const int line = b->lines.first[deck_bar];
  double length = 0, middle[3];
  char unit[64];
  for (int64_t e = b->first[line]; e < b->first[line + 1]; ++e) length += b->length[e];
  bar_middle(b, b->first[line], middle);
  const double spacing = body->lattices[body->particles.block[body_nearest(body, middle) / SLICE]].spacing;
  if (!(length < spacing)) return;
  units_name(model->units, dimension_find("length"), unit, sizeof unit);
  plausibility_say(model, section_node(bar, "points"),
                   "points: bar '%s' is %.3g %s long, %.2g of the spacing, so that it pulls on few particles and joins "
                   "nothing; look at the unit of its points",
                   bar->head.name, length, unit, length / spacing);
}

/** Lines that overlap, and a pitch that leaves none but those at both ends. */
static void check_pitch(breccia_model *model, const Bars *b, int deck_bar)
{
  const BarSpec *bar = b->lines.deck->items[deck_bar];
  const double thick = sqrt(4 / acos(-1) * area_of_one(b, deck_bar));
  char unit[64];
  units_name(model->units, dimension_find("length"), unit, sizeof unit);
  for (int k = 0; k < bar->repeat.count; ++k) {
    const RepeatSpec *r = bar->repeat.items[k];
    if (r->pitch < thick)
      plausibility_say(model, section_node(r, "pitch"),
                       "pitch: lines of bar '%s' follow each other at %.3g %s, and are %.3g %s thick, so that they "
                       "overlap; look at the units",
                       bar->head.name, r->pitch, unit, thick, unit);
    else if (r->pitch > r->over)
      plausibility_say(
          model, section_node(r, "pitch"),
          "pitch: %.3g %s is more than the %.3g %s over which there are lines, so that bar '%s' has one at "
          "each end and none between; look at the units",
          r->pitch, unit, r->over, unit, bar->head.name);
  }
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
  if (bond->law == BOND_LINEAR) {
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
  const double least = 1e-4, most = 0.05,
               strain = plausibility_parameter(model, m, PARAMETER_YIELD_STRESS) / material_young(m);
  if (!(strain < least || strain > most)) return;
  plausibility_say(
      model, plausibility_parameter_node(model, m, PARAMETER_YIELD_STRESS),
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

/** Tendons that yield before the body resists, and those that are pressed. */
static void check_prestress(breccia_model *model, const Bars *b, const Load *load)
{
  if (!plausibility_is_kind(load->spec, "prestress")) return;
  const double time = plausibility_time_of_load(model, load),
               peak = history_peak(&load->history, isfinite(time) ? time : history_rise(&load->history));
  double *strain = memory_zeroed((size_t)b->specs->count, sizeof *strain, "bars", NULL);
  if (strain) load->type->strain(load, &(LoadStrains){.of_bars = strain, .bar_count = b->specs->count}, 1);
  for (int n = 0; strain && n < b->lines.deck->count; ++n) {
    const BarSpec *bar = b->lines.deck->items[n];
    const Material *m = material_of(model, bar);
    const double stress = material_young(m) * strain[b->lines.first[n]],
                 yield = plausibility_parameter(model, m, PARAMETER_YIELD_STRESS);
    Text words = {0}, most = {0};
    if (!(fabs(stress) > yield)) {
      quantity_describe(plausibility_in_si(model, "stress", fabs(stress * peak)), "Pa", &words);
      if (stress * peak < 0)
        plausibility_say(
            model, load->node,
            "prestress: bar '%s' is pressed by %s at first, so that it pushes against the body; tension is "
            "positive: look at the sign",
            bar->head.name, text_words(&words));
      text_free(&words);
      continue;
    }
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

/** Returns true if two lines of bars have the same nodes, in the same or the opposite order. */
static bool bars_lie_on_each_other(const Bars *b, int one, int other)
{
  const int64_t count = b->first[one + 1] - b->first[one];
  if (b->first[other + 1] - b->first[other] != count) return false;
  bool along = true, against = true;
  double middle[2][3], reversed[3];
  for (int64_t e = 0; e < count && (along || against); ++e) {
    bar_middle(b, b->first[one] + e, middle[0]);
    bar_middle(b, b->first[other] + e, middle[1]);
    bar_middle(b, b->first[other] + count - 1 - e, reversed);
    const double near = 1e-6 * b->length[b->first[one] + e];
    for (int k = 0; k < 3; ++k) {
      along &= fabs(middle[0][k] - middle[1][k]) <= near;
      against &= fabs(middle[0][k] - reversed[k]) <= near;
    }
  }
  return along || against;
}

typedef struct BarPlace { /* of a line, for a search for others on the same place */
  double sum[3];          /* of both ends */
  int line;
} BarPlace;

static int bars_compare(const void *first, const void *second)
{
  const BarPlace *a = first, *b = second;
  for (int k = 0; k < 3; ++k)
    if (a->sum[k] != b->sum[k]) return a->sum[k] < b->sum[k] ? -1 : 1;
  return a->line - b->line;
}

static int bars_deck_bar(const Bars *b, int line)
{
  int n = 0;
  while (b->lines.first[n + 1] <= line) ++n;
  return n;
}

/** Reinforcement that stands in the deck twice, of one size and material, counts twice. Lines are compared with the
 *  one before them with the same ends. */
static void check_bars_twice(breccia_model *model, const Bars *b)
{
  const int count = b->lines.first[b->lines.deck->count];
  BarPlace *places = memory_zeroed((size_t)count + 1, sizeof *places, "bars", NULL);
  bool *told = memory_zeroed((size_t)b->lines.deck->count + 1, sizeof *told, "bars", NULL);
  for (int line = 0; places && line < count; ++line) {
    double ends[2][3];
    bar_middle(b, b->first[line], ends[0]);
    bar_middle(b, b->first[line + 1] - 1, ends[1]);
    places[line].line = line;
    for (int k = 0; k < 3; ++k) places[line].sum[k] = round((ends[0][k] + ends[1][k]) * 1e9) / 1e9;
  }
  if (places) qsort(places, (size_t)count, sizeof *places, bars_compare);
  for (int k = 1; places && told && k < count; ++k) {
    if (!bars_lie_on_each_other(b, places[k - 1].line, places[k].line)) continue;
    const int one = bars_deck_bar(b, places[k - 1].line), other = bars_deck_bar(b, places[k].line);
    const BarSpec *bar = b->lines.deck->items[other], *same = b->lines.deck->items[one];
    const bool one_size = fabs(area_of_one(b, one) - area_of_one(b, other)) <= 1e-6 * area_of_one(b, one);
    if (!one_size || strcmp(bar->material, same->material) != 0) continue;
    if (!told[other])
      plausibility_say(
          model, section_node(bar, "points"),
          "points: bar '%s' lies where bar '%s' lies already, and both count; leave one out, or say 'number: "
          "2'",
          bar->head.name, same->head.name);
    told[other] = true;
  }
  free(places);
  free(told);
}

void plausibility_warn_of_bars(breccia_model *model)
{
  const Bars *b = bars_among(&model->domain.forces);
  if (!b) return;
  const double body = volume_of_body(model);
  check_amount(model, b, body);
  check_yields(model, b);
  check_bars_twice(model, b);
  for (int l = 0; l < model->loading.count; ++l) check_prestress(model, b, &model->loading.loads[l]);
  for (int n = 0; n < b->lines.deck->count; ++n) {
    check_thinness(model, b, body, n);
    check_length(model, b, n);
    check_pitch(model, b, n);
    check_faces(model, b, n);
    check_bond(model, ((const BarSpec *)b->lines.deck->items[n])->bond);
  }
}

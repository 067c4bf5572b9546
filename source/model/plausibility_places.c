/* Points of a deck that lie beside what they are meant for: a particle is the nearest one however far it is. */
#include "model/plausibility_parts.h"

#include "bars/bars.h"
#include "base/memory.h"
#include "domain/initial_stress.h"
#include "model/deck_layout.h"
#include "results/profile.h"
#include "solver/static.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double far_away = 2; /* spacings; within a body no point is farther than 0.87 of one from a particle */

static double apart(const double a[3], const double b[3])
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static void add_point(const breccia_model *model, const double point[3], Text *text)
{
  for (int k = 0; k < model->domain.body.dimensions; ++k) text_add(text, "%s%.6g", k ? ", " : "[", point[k]);
  text_add(text, "]");
}

/** @param[in] found, what  where the nearest thing of this name is */
static void check_distance(breccia_model *model, const Node *node, const double point[3], const double found[3],
                           const char *what)
{
  const Body *body = &model->domain.body;
  const double away = apart(point, found),
               spacing = body->lattices[body->particles.block[body_nearest(body, found) / SLICE]].spacing;
  if (!(away > far_away * spacing)) return;
  char length[64];
  Text words[2] = {{0}, {0}};
  units_name(model->units, dimension_find("length"), length, sizeof length);
  add_point(model, point, &words[0]);
  add_point(model, found, &words[1]);
  plausibility_say(model, node,
                   "%s: %s is %.3g %s from the nearest %s, which is at %s: %.3g spacings; look at its coordinates and "
                   "their unit",
                   node->key, text_words(&words[0]), away, length, what, text_words(&words[1]), away / spacing);
  text_free(&words[0]);
  text_free(&words[1]);
}

static void place_of(const breccia_model *model, int32_t place, double point[3])
{
  for (int k = 0; k < 3; ++k) point[k] = model->domain.particles->position[k][place];
}

static void check_point(breccia_model *model, const Node *node, const double point[3])
{
  double found[3];
  place_of(model, body_nearest(&model->domain.body, point), found);
  check_distance(model, node, point, found, "particle");
}

/** One given on the spot, and those that it is made of; NULL: it has a name, and is looked at where it is given. */
static void check_selection(breccia_model *model, const SelectionSpec *spec)
{
  if (!spec) return;
  if (!isnan(spec->nearest[0])) check_point(model, section_node(spec, "nearest"), spec->nearest);
  const ReferenceList *const lists[] = {&spec->any_of, &spec->all_of, &spec->except};
  for (size_t n = 0; n < sizeof lists / sizeof *lists; ++n)
    for (int k = 0; k < lists[n]->count; ++k) check_selection(model, lists[n]->items[k].section);
}

static void check_points(breccia_model *model, const void *section, const char *key, const NumberList *list)
{
  for (int k = 0; k < list->count; ++k) check_point(model, section_node(section, key), list->values + 3 * k);
}

static void check_control(breccia_model *model, const ControlSpec *control)
{
  if (!control) return;
  check_points(model, control, "opening between", &control->opening);
  check_selection(model, control->displacement.section);
  check_selection(model, control->bond.section);
  check_selection(model, control->path.section);
}

static void check_watch(breccia_model *model, const WatchSpec *watch)
{
  const Reference *const references[] = {&watch->displacement, &watch->velocity, &watch->force, &watch->reaction,
                                         &watch->stress,       &watch->history,  &watch->damage};
  for (size_t k = 0; k < sizeof references / sizeof *references; ++k) check_selection(model, references[k]->section);
  check_points(model, watch, "opening between", &watch->opening);
  check_points(model, watch, "bond between", &watch->bond);
  const Bars *bars = bars_among(&model->domain.forces);
  const int bar = watch->bar && bars ? bars_find(bars, watch->bar) : -1;
  if (bar < 0 || isnan(watch->at[0])) return;
  double middle[3];
  bar_middle(bars, bar_nearest(bars, bar, watch->at), middle);
  check_distance(model, section_node(watch, "at"), watch->at, middle, "element of the bar");
}

/** A load on the particle nearest to a point. */
typedef struct PointLoad {
  const Load *load;
  const SelectionSpec *on;
} PointLoad;

static bool act_together(const Load *one, const Load *other)
{
  return one->first < other->behind && other->first < one->behind;
}

/** Points that are apart in the deck and have the same particle: of a body that is given in another unit, mostly. */
static bool is_pair(const PointLoad *one, const PointLoad *other)
{
  return one->load->selection.places[0] == other->load->selection.places[0] && one->on != other->on &&
         apart(one->on->nearest, other->on->nearest) != 0 && act_together(one->load, other->load);
}

/** Whether loads before the last one have the same two selections as the pair of it and another. */
static bool is_told(const PointLoad *loads, const PointLoad *one, const PointLoad *last)
{
  for (const PointLoad *b = loads; b <= last; ++b)
    for (const PointLoad *a = loads; a < b && (b < last || a < one); ++a)
      if (((a->on == one->on && b->on == last->on) || (a->on == last->on && b->on == one->on)) && is_pair(a, b))
        return true;
  return false;
}

static void say_pair(breccia_model *model, const PointLoad *one, const PointLoad *other)
{
  double at[3];
  char length[64];
  Text words = {0};
  place_of(model, one->load->selection.places[0], at);
  add_point(model, at, &words);
  units_name(model->units, dimension_find("length"), length, sizeof length);
  plausibility_say(model, section_node(other->on, "nearest"),
                   "nearest: the particle at %s is also the nearest to the point of the load in line %d, %.3g %s from "
                   "this one; look at the coordinates and their unit",
                   text_words(&words), one->load->spec->head.node->line, apart(one->on->nearest, other->on->nearest),
                   length);
  text_free(&words);
}

static void check_pairs(breccia_model *model)
{
  PointLoad *loads = memory_zeroed((size_t)model->loading.count, sizeof *loads, "loads", NULL);
  int count = 0;
  for (int k = 0; loads && k < model->loading.count; ++k) {
    const Load *load = &model->loading.loads[k];
    const SelectionSpec *on = selection_spec(&model->spec->selections, &load->spec->on);
    if (on && !isnan(on->nearest[0]) && load->selection.count == 1) loads[count++] = (PointLoad){load, on};
  }
  for (int k = 0; k < count; ++k)
    for (int n = 0; n < k; ++n)
      if (is_pair(&loads[n], &loads[k]) && !is_told(loads, &loads[n], &loads[k])) say_pair(model, &loads[n], &loads[k]);
  free(loads);
}

/* ---- coordinates that count for nothing ---- */

static void places_check_coordinate(breccia_model *model, const Field *field, const Node *point)
{
  double value = 0;
  if (point->kind != NODE_LIST || point->count != 3 || !field->dimension || strcmp(field->dimension, "length") != 0)
    return;
  if (!strcmp(field->key, "from") || !strcmp(field->key, "to")) return; /* of a box that may reach through the plane */
  const Node *third = &point->items[2];
  if (third->kind != NODE_SCALAR || !strcmp(third->text, "free")) return;
  Text ignored = {0};
  const bool read = !units_read(model->units, dimension_find("length"), third->text, &value, &ignored);
  text_free(&ignored);
  if (!read || value == 0) return;
  plausibility_say(
      model, third,
      "%s: its third coordinate, %s, counts for nothing: the body is plane, at z = 0; leave it out, or look "
      "at the order of the coordinates",
      field->key, third->text);
}

/** Looks at all points of a section of the deck, and of the sections that it is made of. */
static void places_check_section(breccia_model *model, const Section *section, const Node *node)
{
  for (int f = 0; node->kind == NODE_MAP && f < section->field_count; ++f) {
    const Field *field = &section->fields[f];
    const Node *value = node_get(node, field->key);
    if (!value) continue;
    if (field->kind == FIELD_POINT || field->kind == FIELD_FREE_POINT) places_check_coordinate(model, field, value);
    for (int k = 0; field->kind == FIELD_POINTS && k < value->count; ++k)
      places_check_coordinate(model, field, &value->items[k]);
    if (!field->section || field->kind == FIELD_CHOSEN || field->kind == FIELD_CHOICE) continue;
    const bool items = value->kind == NODE_LIST || field->kind == FIELD_NAMED;
    for (int k = 0; items && k < value->count; ++k) places_check_section(model, field->section, &value->items[k]);
    if (!items) places_check_section(model, field->section, value);
  }
}

void plausibility_warn_of_places(breccia_model *model)
{
  if (model->domain.body.dimensions == 2) places_check_section(model, &deck_section, model->document->root);
  const DeckSpec *deck = model->spec;
  for (int k = 0; k < deck->selections.count; ++k) check_selection(model, deck->selections.items[k]);
  for (int k = 0; k < model->loading.count; ++k) check_selection(model, model->loading.loads[k].spec->on.section);
  check_pairs(model);
  for (int k = 0; k < deck->watches.count; ++k) check_watch(model, deck->watches.items[k]);
  for (int k = 0; k < deck->profiles.count; ++k)
    check_selection(model, ((const ProfileSpec *)deck->profiles.items[k])->of.section);
  for (int k = 0; k < deck->initial_stress.count; ++k)
    check_selection(model, ((const InitialStressSpec *)deck->initial_stress.items[k])->on.section);
  for (int k = 0; deck->failure && k < deck->failure->nowhere.count; ++k)
    check_selection(model, ((const NoFailureSpec *)deck->failure->nowhere.items[k])->of.section);
  for (int k = 0; k < deck->solve.count; ++k) {
    const StaticSpec *rest = ((const SolveSpec *)deck->solve.items[k])->of[SOLVER_static];
    if (rest) check_control(model, rest->control);
  }
}

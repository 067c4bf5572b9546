#include "loading/load.h"

#include <math.h>
#include <stdlib.h>

#define LOAD(name, key, kind, dimension, meaning) extern const LoadType name##_load;
#define LOAD_SECTION(name, key, meaning)                                                                               \
  extern const LoadType name##_load;                                                                                   \
  extern const Section name##_load_section;
#include "loading/load/loads.h"

static const LoadType *const types[] = {
#define LOAD(name, key, kind, dimension, meaning) &name##_load,
#include "loading/load/loads.h"
};

static const Field load_fields[] = {
    {.key = "name",
     .kind = FIELD_TEXT,
     .offset = offsetof(LoadSpec, name),
     .standard = "",
     .meaning = "name, for watching what it applies"},
    {.key = "on",
     .kind = FIELD_REFERENCE,
     .offset = offsetof(LoadSpec, on),
     .standard = "",
     .meaning = "name of a selection, or a selection; gravity, base acceleration and initial velocity are of the whole "
                "body when absent",
     .section = &selection_section},
    {.key = "history",
     .kind = FIELD_SECTION,
     .offset = offsetof(LoadSpec, history),
     .standard = "",
     .meaning = "constant when absent",
     .section = &history_section},
    {.key = "area",
     .kind = FIELD_NUMBER,
     .offset = offsetof(LoadSpec, area),
     .dimension = "area",
     .standard = "",
     .range = "(0, inf)",
     .meaning =
         "area of the face on which particles from a file stand, for a traction, a pressure or a water pressure. On "
         "a plane face of one block the force is spread over the particles behind the face such that force and "
         "moments are those of the face; elsewhere particles take shares by volume"},
    {.key = "centre",
     .kind = FIELD_POINT,
     .offset = offsetof(LoadSpec, centre),
     .dimension = "length",
     .standard = "",
     .meaning = "centre of the face, together with 'area'; when absent the centre of the volumes of the particles "
                "behind the face"},
    {.key = "spread",
     .kind = FIELD_CHOICE,
     .offset = offsetof(LoadSpec, spread),
     .standard = "",
     .meaning =
         "of what acts on a face. bonds: to the particles that the bonds cut off by the face would have pulled, "
         "and as they would have, so that an even stress up to the face is exact: standard for one layer of square and "
         "cubic lattices in formulations that can tell (hybrid and correspondence). layers: evenly over the layers of "
         "the face",
     .words = (const char *const[]){[SPREAD_BY_BONDS] = "bonds", [SPREAD_OVER_LAYERS] = "layers", NULL}},
    {.key = "platen",
     .kind = FIELD_CHOICE,
     .offset = offsetof(LoadSpec, platen),
     .standard = "",
     .meaning = "of a motion prescribed in one direction. turning: a rigid plate presses on the particles and turns "
                "freely about its centre, as on a ball joint, and 'on' moves in the mean: standard for one patch, "
                "narrower than the body, that moves and to no particle of which another motion is prescribed. fixed: "
                "all particles move alike, and the plate takes a moment",
     .words = (const char *const[]){[PLATEN_TURNS] = "turning", [PLATEN_FIXED] = "fixed", NULL}},
    {.key = "only presses",
     .kind = FIELD_FLAG,
     .offset = offsetof(LoadSpec, only_presses),
     .standard = "no",
     .meaning = "yes: the load pushes the body away from the face under 'on', lets go where it would pull, and "
                "presses again when the body comes back. For a motion prescribed in one direction, a roller, or a "
                "spring with a direction. Each particle lets go by itself; a platen that turns lets go as a whole, "
                "and its plate stays on the body"},
#define LOAD(name, word, form, measure, about)                                                                         \
  {.key = word,                                                                                                        \
   .kind = form,                                                                                                       \
   .offset = offsetof(LoadSpec, of[LOAD_##name]),                                                                      \
   .dimension = measure,                                                                                               \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .group = 'A'},
#define LOAD_SECTION(name, word, about)                                                                                \
  {.key = word,                                                                                                        \
   .kind = FIELD_SECTION,                                                                                              \
   .offset = offsetof(LoadSpec, of[LOAD_##name]),                                                                      \
   .standard = "",                                                                                                     \
   .meaning = about,                                                                                                   \
   .section = &name##_load_section,                                                                                    \
   .group = 'A'},
#include "loading/load/loads.h"
};
/* Number of keys that all loads have; the keys of the load types follow, one for each type. */
enum { OTHERS = sizeof load_fields / sizeof *load_fields - sizeof types / sizeof *types };

/** Which load it is: its place in the list. */
static int index_of(const LoadSpec *spec)
{
  int k = 0;
  while (!node_get(spec->head.node, load_fields[OTHERS + k].key)) ++k;
  return k;
}

static void check_load(const DeckReader *reader, void *section)
{
  const LoadSpec *load = section;
  const int k = index_of(load);
  if (!load->on.node && !types[k]->everywhere)
    node_error(reader->document, load->head.node, reader->error, "load: missing key 'on': which particles are loaded");
  if (load->history && types[k]->timeless)
    node_error(reader->document, section_node(load, "history"), reader->error,
               "history: '%s' does not vary in time; leave it out", load_fields[OTHERS + k].key);
  const bool on_face = k == LOAD_traction || k == LOAD_pressure || k == LOAD_water_pressure;
  if (!isnan(load->area) && !on_face)
    node_error(reader->document, section_node(load, "area"), reader->error,
               "area: only a 'traction' has one, and a pressure on particles from a file");
  if (node_get(load->head.node, "centre") && isnan(load->area))
    node_error(reader->document, section_node(load, "centre"), reader->error, "centre: needs the 'area' of the face");
  if (load->spread >= 0 && !on_face)
    node_error(reader->document, section_node(load, "spread"), reader->error,
               "spread: only of a traction, a pressure or a water pressure");
  if (load->platen >= 0 && !types[k]->platen)
    node_error(reader->document, section_node(load, "platen"), reader->error,
               "platen: only of a prescribed displacement, velocity or acceleration, or of 'along'");
  if (load->only_presses && !types[k]->may_press)
    node_error(reader->document, section_node(load, "only presses"), reader->error,
               "only presses: only of a prescribed displacement, velocity or acceleration, of 'along', a 'roller' or a "
               "'spring'%s",
               k == LOAD_support ? "; hold the outermost layer by a 'roller' instead of mirror images" : "");
}

const Section load_section = {
    .name = "load",
    .about = "A force on some particles, a motion prescribed to them, or what joins them to others.",
    .size = sizeof(LoadSpec),
    FIELDS(load_fields),
    .check = check_load};

/** In the plane nothing moves along z, in a bar along x only. */
static int check_directions(const Load *load, int dimensions, const DeckReader *reader)
{
  const double *vector = load->type->vector ? load->type->vector(load->value) : NULL;
  for (int k = dimensions; k < 3 && vector; ++k)
    if (!isnan(vector[k]) && vector[k] != 0)
      return node_error(reader->document, load->node, reader->error, "%s: has a part along %c, but the body is %s",
                        load->node->key, "xyz"[k], dimensions == 2 ? "plane" : "a bar along x");
  return BRECCIA_OK;
}

int load_create(Load *load, const LoadSpec *spec, const LoadMaking *making)
{
  static const Node everywhere = {.kind = NODE_MAP};
  SelectionSpec all = {.head = {NULL, &everywhere}, .face = -1, .layers = 1, .nearest = {NAN, NAN, NAN}, .all = true};
  Reference reference = spec->on;
  if (!reference.node) reference = (Reference){NULL, &all, &everywhere};
  const int k = index_of(spec);
  load->spec = spec;
  load->type = types[k];
  load->value = &spec->of[k];
  load->node = node_get(spec->head.node, load_fields[OTHERS + k].key);
  int status = selection_create(&load->selection, making->body, making->reader, making->selections, &reference);
  if (!status) status = check_directions(load, making->body->dimensions, making->reader);
  const int bad = history_create(&load->history, spec->history, making->reader);
  if (bad) status = bad;
  for (int64_t n = 0; n < load->selection.count; ++n)
    load->volume += making->body->particles.volume[load->selection.places[n]];
  return !status && load->type->create ? load->type->create(load, making) : status;
}

void load_destroy(Load *load)
{
  if (load->own && load->type->destroy) load->type->destroy(load);
  selection_destroy(&load->selection);
  selection_destroy(&load->other);
  history_destroy(&load->history);
  free(load->held);
}

double load_factor(const Load *load, double time)
{
  return history_factor(&load->history, time - load->begin);
}

const char *load_kind(const LoadSpec *spec, const char **dimension)
{
  const int k = index_of(spec);
  const Field *field = &load_fields[OTHERS + k];
  *dimension = field->dimension ? field->dimension : "1";
  return types[k]->kind ? types[k]->kind(&spec->of[k], dimension) : field->key;
}

bool load_strains_places(const LoadSpec *spec)
{
  return types[index_of(spec)] == &initial_strain_load;
}

int load_is_known(const Load *load, const LoadMaking *making, const char *what)
{
  if (!history_is_controlled(&load->history)) return BRECCIA_OK;
  return node_error(
      making->reader->document, load->history.value_node, making->reader->error,
      "controlled: the factor of a load 'initial strain' or 'prestress' is not found; give '%s' a 'ramp' or "
      "a 'table'",
      what);
}

double load_magnitude(const LoadSpec *spec)
{
  const int k = index_of(spec);
  return types[k]->magnitude(&spec->of[k]);
}

double load_value(const LoadSpec *spec, double factor)
{
  const int k = index_of(spec);
  return types[k]->at_factor ? types[k]->at_factor(&spec->of[k], factor) : factor * load_magnitude(spec);
}

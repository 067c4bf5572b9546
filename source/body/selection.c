#include "body/selection.h"

#include "deck/names.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const faces[] = {"x-", "x+", "y-", "y+", "z-", "z+", NULL};

static void check_selection(const DeckReader *reader, void *section)
{
  const SelectionSpec *s = section;
  if (!s->block && !s->group && s->face < 0 && !s->inside && isnan(s->nearest[0]) && !s->all && !s->outside &&
      !s->any_of.count && !s->all_of.count && !s->except.count)
    node_error(reader->document, s->head.node, reader->error,
               "selection: say what is selected: block, group, face, inside, nearest, any of, all of, except or 'all: "
               "yes'");
}

static const Field selection_fields[] = {
    {.key = "block",
     .kind = FIELD_NAME,
     .offset = offsetof(SelectionSpec, block),
     .dimension = "block",
     .standard = "",
     .meaning = "particles of this block"},
    {.key = "group",
     .kind = FIELD_TEXT,
     .offset = offsetof(SelectionSpec, group),
     .standard = "",
     .meaning = "particles of this group (column `group` of a block's file), or of the selection that has this name"},
    {.key = "face",
     .kind = FIELD_CHOICE,
     .offset = offsetof(SelectionSpec, face),
     .standard = "",
     .meaning = "particles next to the outermost ones in this direction, of the block and the group if these are given",
     .words = faces},
    {.key = "layers",
     .kind = FIELD_COUNT,
     .offset = offsetof(SelectionSpec, layers),
     .standard = "1",
     .range = "[1, inf)",
     .meaning = "how many layers of a face"},
    {.key = "inside",
     .kind = FIELD_SECTION,
     .offset = offsetof(SelectionSpec, inside),
     .standard = "",
     .meaning = "particles inside this shape",
     .section = &shape_section},
    {.key = "nearest",
     .kind = FIELD_POINT,
     .offset = offsetof(SelectionSpec, nearest),
     .dimension = "length",
     .standard = "",
     .meaning = "the one particle nearest to this point; where several are, the one of the lowest number"},
    {.key = "all",
     .kind = FIELD_FLAG,
     .offset = offsetof(SelectionSpec, all),
     .standard = "no",
     .meaning = "the whole body"},
    {.key = "outside",
     .kind = FIELD_FLAG,
     .offset = offsetof(SelectionSpec, outside),
     .standard = "no",
     .meaning = "yes: of the layers that supports put outside the body, instead of the body's own particles; "
                "what lies outside a shape is had by 'except'"},
    {.key = "any of",
     .kind = FIELD_REFERENCES,
     .offset = offsetof(SelectionSpec, any_of),
     .standard = "",
     .meaning = "particles of at least one of these selections, like [jack, {face: x-}]",
     .section = &selection_section},
    {.key = "all of",
     .kind = FIELD_REFERENCES,
     .offset = offsetof(SelectionSpec, all_of),
     .standard = "",
     .meaning = "particles that are in each of these",
     .section = &selection_section},
    {.key = "except",
     .kind = FIELD_REFERENCES,
     .offset = offsetof(SelectionSpec, except),
     .standard = "",
     .meaning = "particles that are in none of these",
     .section = &selection_section},
};

const Section selection_section = {.name = "selection",
                                   .about = "Some particles. Where several conditions stand, all must hold.",
                                   .size = sizeof(SelectionSpec),
                                   FIELDS(selection_fields),
                                   .check = check_selection};

/** What is being resolved, and within which others. */
typedef struct Resolving {
  const Body *body;
  const DeckReader *reader;
  const SectionList *named;
  const SelectionSpec *spec;
  const Reference *reference;
  const struct Resolving *within; /* NULL: none */
} Resolving;

static int find(const Resolving *within, const Reference *reference, uint8_t *held);

static int block_index(const Body *body, const char *name)
{
  for (int b = 0; b < body->block_count; ++b)
    if (!strcmp(body->blocks[b]->head.name, name)) return b;
  return -1;
}

static int group_index(const Body *body, const char *name)
{
  for (int g = 0; g < body->group_count; ++g)
    if (!strcmp(body->groups[g], name)) return g;
  return -1;
}

static int64_t count_held(const Body *body, const uint8_t *held)
{
  int64_t count = 0;
  for (int64_t n = 0; n < body->particles.count; ++n) count += held[n];
  return count;
}

/** Where the body is, and which particle is nearest to the middle of the shape asked for. */
static void add_whereabouts(const Resolving *r, Text *words)
{
  const Particles *particles = &r->body->particles;
  const int dimensions = r->body->dimensions;
  double low[3], high[3], from[3], to[3];
  particles_bounds(particles, low, high);
  text_add(words, "particles stand at ");
  for (int k = 0; k < dimensions; ++k) text_add(words, "%s%c from %g to %g", k ? ", " : "", "xyz"[k], low[k], high[k]);
  if (!r->spec->inside) return;
  shape_bounds(r->spec->inside, &r->body->coarsest->unit, from, to);
  double middle[3] = {0};
  for (int k = 0; k < dimensions; ++k) middle[k] = (from[k] + to[k]) / 2;
  const int32_t near = body_nearest(r->body, middle);
  text_add(words, "; the one nearest to the middle of the shape is at [");
  for (int k = 0; k < dimensions; ++k) text_add(words, "%s%g", k ? ", " : "", particles->position[k][near]);
  text_add(words, "]");
}

/** Says that nothing is selected. @param[in] by  the key that took away the last `before` particles; NULL: they never were */
static int say_empty(const Resolving *r, const char *by, int64_t before)
{
  const char *name = r->reference->name;
  Text words = {0};
  if (by)
    text_add(&words, "'%s' leaves none of the %lld that its other keys select", by, (long long)before);
  else
    add_whereabouts(r, &words);
  node_error(r->reader->document, name ? r->spec->head.node : r->reference->node, r->reader->error,
             "the selection%s%s%s holds no particle; %s", name ? " '" : "", name ? name : "", name ? "'" : "",
             text_words(&words));
  text_free(&words);
  return BRECCIA_USER_ERROR;
}

/** Says that no selection and no group has a name. */
static int say_unknown(const Resolving *r, const Node *node, const char *name)
{
  const int count = r->named->count + r->body->group_count;
  const char **names = memory_zeroed((size_t)count, sizeof *names, "names", r->reader->error);
  if (!names) return BRECCIA_FAILURE;
  for (int k = 0; k < r->named->count; ++k) names[k] = ((const SectionHead *)r->named->items[k])->name;
  for (int g = 0; g < r->body->group_count; ++g) names[r->named->count + g] = r->body->groups[g];
  name_unknown(r->reader, node, r->body->group_count ? "selection or group" : "selection", name, names, count);
  free(names);
  return BRECCIA_USER_ERROR;
}

/** How far from the outermost particles the layers of a face reach: to the middle between two planes of particles. */
static double face_depth(const Lattice *lattice, int axis, int64_t layers)
{
  return lattice->unit.size[axis] * (double)layers - lattice->plane[axis] / 2;
}

/** Takes away what does not lie in the layers of a face of those that are held. */
static void keep_face(const Resolving *r, uint8_t *held)
{
  const Particles *p = &r->body->particles;
  const int axis = selection_axis(r->spec);
  const double sign = selection_side(r->spec);
  double outermost = -INFINITY;
  for (int64_t n = 0; n < p->count; ++n)
    if (held[n]) outermost = fmax(outermost, sign * p->position[axis][p->place_of[n]]);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    const Lattice *lattice = &r->body->lattices[p->block[place / SLICE]];
    held[n] &= sign * p->position[axis][place] >= outermost - face_depth(lattice, axis, r->spec->layers);
  }
}

/** Takes away what is not inside the shape, or not the nearest to the point. */
static void keep_near(const Resolving *r, uint8_t *held)
{
  const Particles *p = &r->body->particles;
  const SelectionSpec *spec = r->spec;
  const int32_t nearest = isnan(spec->nearest[0]) ? -1 : body_nearest(r->body, spec->nearest);
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t place = p->place_of[n];
    const Lattice *lattice = &r->body->lattices[p->block[place / SLICE]];
    const double point[3] = {p->position[0][place], p->position[1][place], p->position[2][place]};
    held[n] &= nearest < 0 || place == nearest;
    held[n] &= !spec->inside ||
               shape_contains(spec->inside, &lattice->unit, r->body->dimensions, point, 1e-6 * lattice->spacing);
  }
}

typedef enum Join { JOIN_ANY, JOIN_ALL, JOIN_NONE } Join;

/** Takes away what is in none of the listed selections, not in each of them, or in any. */
static int keep_listed(const Resolving *r, const ReferenceList *list, Join join, const char *key, uint8_t *held)
{
  const size_t count = (size_t)r->body->particles.count;
  const int64_t before = count_held(r->body, held);
  uint8_t *one = memory_zeroed(count, 1, "selection", r->reader->error),
          *listed = memory_zeroed(count, 1, "selection", r->reader->error);
  int status = one && listed ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; k < list->count && !status; ++k) {
    status = find(r, &list->items[k], one);
    for (size_t n = 0; n < count && !status; ++n)
      listed[n] = join == JOIN_ALL && k ? listed[n] & one[n] : listed[n] | one[n];
  }
  for (size_t n = 0; n < count && !status; ++n) held[n] &= join == JOIN_NONE ? !listed[n] : listed[n];
  free(one);
  free(listed);
  return !status && !count_held(r->body, held) ? say_empty(r, key, before) : status;
}

static int find_spec(const Resolving *r, uint8_t *held)
{
  const SelectionSpec *spec = r->spec;
  const Particles *p = &r->body->particles;
  const int block = spec->block ? block_index(r->body, spec->block) : -1;
  if (spec->block && block < 0) return BRECCIA_USER_ERROR; /* said when the deck was read */
  if (spec->face >= 0 && selection_axis(spec) >= r->body->dimensions)
    return node_error(r->reader->document, section_node(spec, "face"), r->reader->error,
                      "face: the body has no face %s; it %s", faces[spec->face],
                      r->body->dimensions == 2 ? "is plane: x-, x+, y- or y+" : "is a bar along x: x- or x+");
  for (int64_t n = 0; n < p->count; ++n)
    held[n] = (block < 0 || p->block[p->place_of[n] / SLICE] == block) && body_outside(r->body, n) == spec->outside;
  int status = BRECCIA_OK;
  if (spec->group) {
    Reference group = {.name = spec->group, .node = section_node(spec, "group")};
    status = keep_listed(r, &(ReferenceList){&group, 1}, JOIN_ANY, "group", held);
  }
  if (status) return status;
  if (spec->face >= 0) keep_face(r, held);
  if (spec->inside || !isnan(spec->nearest[0])) keep_near(r, held);
  if (!count_held(r->body, held)) return say_empty(r, NULL, 0);
  if (spec->any_of.count) status = keep_listed(r, &spec->any_of, JOIN_ANY, "any of", held);
  if (spec->all_of.count && !status) status = keep_listed(r, &spec->all_of, JOIN_ALL, "all of", held);
  if (spec->except.count && !status) status = keep_listed(r, &spec->except, JOIN_NONE, "except", held);
  return status;
}

/** Marks the particles of a reference by their numbers. @param[in] within  whose part it is, and what all have in common */
static int find(const Resolving *within, const Reference *reference, uint8_t *held)
{
  const Body *body = within->body;
  const DeckReader *reader = within->reader;
  const char *name = reference->name;
  const SelectionSpec *spec = selection_spec(within->named, reference);
  const int group = name ? group_index(body, name) : -1;
  if (!spec && !name) return BRECCIA_USER_ERROR; /* was said when it was read */
  if (!spec && group < 0) return say_unknown(within, reference->node, name);
  if (spec && group >= 0)
    return node_error(reader->document, reference->node, reader->error,
                      "'%s' is the name of a selection and of a group in a file; rename the selection", name);
  for (int64_t n = 0; !spec && n < body->particles.count; ++n) held[n] = body->group_of[n] == group;
  if (!spec) return BRECCIA_OK;
  for (const Resolving *r = within; r; r = r->within)
    if (r->spec == spec)
      return node_error(reader->document, reference->node, reader->error, "the selection '%s' is made of itself", name);
  return find_spec(&(Resolving){body, reader, within->named, spec, reference, within}, held);
}

const SelectionSpec *selection_spec(const SectionList *named, const Reference *reference)
{
  return reference->name ? section_find(named, reference->name) : reference->section;
}

int selection_create(Selection *selection, const Body *body, const DeckReader *reader, const SectionList *named,
                     const Reference *reference)
{
  const Particles *p = &body->particles;
  *selection = (Selection){0};
  uint8_t *held = memory_zeroed((size_t)p->count, 1, "selection", reader->error);
  int status = held ? BRECCIA_OK : BRECCIA_FAILURE;
  if (!status) status = find(&(Resolving){.body = body, .reader = reader, .named = named}, reference, held);
  int64_t count = 0;
  for (int64_t n = 0; n < p->count && !status; ++n) count += held[n] != 0;
  if (!status && !(selection->places = memory_zeroed((size_t)count, sizeof(int32_t), "selection", reader->error)))
    status = BRECCIA_FAILURE;
  for (int64_t n = 0; n < p->count && !status; ++n)
    if (held[n]) selection->places[selection->count++] = p->place_of[n];
  free(held);
  if (status) selection_destroy(selection);
  return status;
}

void selection_destroy(Selection *selection)
{
  free(selection->places);
  *selection = (Selection){0};
}

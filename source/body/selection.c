#include "body/selection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *face_word(int k)
{
  static const char *const words[] = {"x-", "x+", "y-", "y+", "z-", "z+", NULL};
  return words[k];
}

static void check_selection(const DeckReader *reader, void *section)
{
  const SelectionSpec *s = section;
  if (!s->block && !s->face && !s->inside && isnan(s->nearest[0]) && !s->all)
    node_error(reader->document, s->head.node, reader->error,
               "selection: say what is selected: block, face, inside, nearest or 'all: yes'");
}

static const Field selection_fields[] = {
    {"block", FIELD_TEXT, offsetof(SelectionSpec, block), NULL, "", NULL, "particles of this block", NULL, NULL, 0},
    {"face", FIELD_CHOICE, offsetof(SelectionSpec, face), NULL, "", NULL,
     "particles next to the outermost ones in this direction", NULL, face_word, 0},
    {"layers", FIELD_COUNT, offsetof(SelectionSpec, layers), NULL, "1", "[1, inf)", "how many layers of a face", NULL,
     NULL, 0},
    {"inside", FIELD_SECTION, offsetof(SelectionSpec, inside), NULL, "", NULL, "particles inside this shape",
     &shape_section, NULL, 0},
    {"nearest", FIELD_POINT, offsetof(SelectionSpec, nearest), "length", "", NULL,
     "the one particle nearest to this point", NULL, NULL, 0},
    {"all", FIELD_FLAG, offsetof(SelectionSpec, all), NULL, "no", NULL, "the whole body", NULL, NULL, 0},
};
const Section selection_section = {"selection",
                                   "Some particles. Where several conditions stand, all must hold.",
                                   sizeof(SelectionSpec),
                                   FIELDS(selection_fields),
                                   check_selection,
                                   NULL,
                                   NULL,
                                   0};

static int block_index(const Body *body, const char *name)
{
  for (int b = 0; b < body->block_count; ++b)
    if (!strcmp(body->blocks[b]->head.name, name)) return b;
  return -1;
}

/** Says that nothing is selected, where the body is, and which particle is nearest to the middle of the shape asked for. */
static void say_empty(const Particles *particles, int dimensions, const UnitCell *unit, const SelectionSpec *spec,
                      const Reference *reference, const DeckReader *reader)
{
  Text words = {0};
  double low[3], high[3], from[3], to[3];
  particles_bounds(particles, low, high);
  for (int k = 0; k < dimensions; ++k) text_add(&words, "%s%c from %g to %g", k ? ", " : "", "xyz"[k], low[k], high[k]);
  if (spec->inside) {
    shape_bounds(spec->inside, unit, from, to);
    double middle[3] = {0};
    for (int k = 0; k < dimensions; ++k) middle[k] = (from[k] + to[k]) / 2;
    const int32_t near = particles_nearest(particles, middle);
    text_add(&words, "; the one nearest to the middle of the shape is at [");
    for (int k = 0; k < dimensions; ++k) text_add(&words, "%s%g", k ? ", " : "", particles->position[k][near]);
    text_add(&words, "]");
  }
  node_error(reader->document, reference->name ? spec->head.node : reference->node, reader->error,
             "the selection%s%s%s holds no particle; particles stand at %s", reference->name ? " '" : "",
             reference->name ? reference->name : "", reference->name ? "'" : "", text_words(&words));
  text_free(&words);
}

/** How far from the outermost particles the layers of a face reach: to the middle between two planes of particles. */
static double face_depth(const Lattice *lattice, int axis, int64_t layers)
{
  return lattice->unit.size[axis] * (double)layers - lattice->plane[axis] / 2;
}

int selection_create(Selection *selection, const Body *body, const DeckReader *reader, const SectionList *named,
                     const Reference *reference)
{
  *selection = (Selection){0};
  const SelectionSpec *spec = reference->section;
  if (reference->name) spec = section_find(named, reference->name);
  if (!spec) {
    if (reference->name) section_unknown(reader, reference->node, "selection", reference->name, named);
    return BRECCIA_USER_ERROR;
  }
  int block = -1;
  if (spec->block && (block = block_index(body, spec->block)) < 0)
    return node_error(reader->document, section_place(spec, "block"), reader->error, "block: there is no block '%s'",
                      spec->block);
  const Particles *particles = &body->particles;
  selection->places = memory_zeroed((size_t)particles->count, sizeof(int32_t), "selection", reader->error);
  if (!selection->places) return BRECCIA_FAILURE;

  int axis = spec->face ? spec->face[0] - 'x' : 0;
  double sign = spec->face && spec->face[1] == '-' ? -1 : 1, outermost = -INFINITY;
  for (int64_t n = 0; spec->face && n < particles->count; ++n) {
    int32_t place = particles->place_of[n];
    if (block >= 0 && particles->block[place / SLICE] != block) continue;
    outermost = fmax(outermost, sign * particles->position[axis][place]);
  }
  int32_t nearest = isnan(spec->nearest[0]) ? -1 : particles_nearest(particles, spec->nearest);
  for (int64_t n = 0; n < particles->count; ++n) {
    int32_t place = particles->place_of[n];
    int own = particles->block[place / SLICE];
    double point[3] = {particles->position[0][place], particles->position[1][place], particles->position[2][place]};
    const Lattice *lattice = &body->lattices[own];
    if (block >= 0 && own != block) continue;
    if (spec->face && sign * point[axis] < outermost - face_depth(lattice, axis, spec->layers)) continue;
    if (spec->inside && !shape_contains(spec->inside, &lattice->unit, body->dimensions, point, 1e-6 * lattice->spacing))
      continue;
    if (nearest >= 0 && place != nearest) continue;
    selection->places[selection->count++] = place;
  }
  if (!selection->count) {
    selection_destroy(selection);
    say_empty(particles, body->dimensions, &body->coarsest->unit, spec, reference, reader);
    return BRECCIA_USER_ERROR;
  }
  return BRECCIA_OK;
}

void selection_destroy(Selection *selection)
{
  free(selection->places);
  *selection = (Selection){0};
}

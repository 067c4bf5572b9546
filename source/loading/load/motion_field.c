#include "deck/coordinates.h"
#include "loading/load/load_parts.h"

#include <math.h>
#include <string.h>

typedef struct MotionFieldSpec {
  SectionHead head;
  TextList displacement, velocity;
} MotionFieldSpec;

static const Field motion_field_fields[] = {
    {.key = "displacement",
     .kind = FIELD_TEXTS,
     .offset = offsetof(MotionFieldSpec, displacement),
     .standard = "",
     .meaning = "its components as expressions of x, y and z, where the particle stands at first, or 'free': ['0.001 * "
                "y', 0]. Deck variables stand in them as ${name}",
     .group = 'A'},
    {.key = "velocity",
     .kind = FIELD_TEXTS,
     .offset = offsetof(MotionFieldSpec, velocity),
     .standard = "",
     .meaning = "the same of a velocity: ['-0.2 * y / 1 s', '0.2 * x / 1 s', free]",
     .group = 'A'},
};

const Section motion_field_load_section = {
    .name = "field",
    .about =
        "A motion that differs from place to place: even strain, turning, bending, prescribed to layers as deep as "
        "the horizon.",
    .size = sizeof(MotionFieldSpec),
    FIELDS(motion_field_fields)};

static const TextList *given(const LoadValue *value, int *order, const char **key)
{
  const MotionFieldSpec *s = value->section;
  *order = s->displacement.count ? 0 : 1;
  *key = *order ? "velocity" : "displacement";
  return *order ? &s->velocity : &s->displacement;
}

/** One component at all particles of a load. */
static int reckon(const Load *load, const LoadMaking *making, const char *words, const char *dimension_name,
                  double *part, Text *reason)
{
  const Particles *p = &making->body->particles;
  const Dimension *dimension = dimension_find(dimension_name);
  for (int64_t n = 0; n < load->selection.count; ++n) {
    const int32_t place = load->selection.places[n];
    const double at[3] = {p->position[0][place], p->position[1][place], p->position[2][place]};
    if (coordinates_evaluate(words, making->reader->units, at, dimension, &part[n], reason)) return 1;
  }
  return 0;
}

static int create(Load *load, const LoadMaking *making)
{
  int order;
  const char *key;
  const DeckReader *reader = making->reader;
  const TextList *words = given(load->value, &order, &key);
  const Node *node = section_node(load->value->section, key);
  if (words->count < 2 || words->count > 3)
    return node_error(reader->document, node, reader->error,
                      "%s: expected a list of 2 or 3 expressions, like ['0.001 * y', 0, free]", key);
  for (int k = 0; k < words->count; ++k) {
    if (!strcmp(words->items[k], "free")) continue;
    double axis[3] = {0};
    axis[k] = 1;
    load_constrain(load, making, axis, 1, order);
    Constraint *constraint = &making->loading->constraints[making->loading->constraint_count - 1];
    constraint->part = memory_zeroed((size_t)load->selection.count, sizeof(double), "field", reader->error);
    if (!constraint->part) return BRECCIA_FAILURE;
    Text reason = {0};
    int bad = reckon(load, making, words->items[k], order ? "velocity" : "length", constraint->part, &reason);
    for (int64_t n = 0; n < load->selection.count && !bad; ++n) {
      constraint->largest_part = fmax(constraint->largest_part, fabs(constraint->part[n]));
      if (k < making->body->dimensions || constraint->part[n] == 0) continue;
      text_add(&reason, "has a part along %c, but the body is %s", "xyz"[k],
               making -> body -> dimensions == 2 ? "plane" : "a bar along x");
      bad = 1;
    }
    if (bad)
      node_error(reader->document, node, reader->error, "%s: '%s': %s", key, words->items[k], text_words(&reason));
    text_free(&reason);
    if (bad) return BRECCIA_USER_ERROR;
  }
  return BRECCIA_OK;
}

static double magnitude(const LoadValue *value)
{
  (void)value;
  return 1;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  int order;
  const char *key;
  given(value, &order, &key);
  *dimension = "1";
  return order ? "velocity field" : "displacement field";
}

const LoadType motion_field_load = {.create = create, .magnitude = magnitude, .kind = kind};

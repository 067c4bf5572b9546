#include "loading/load/load_parts.h"

#include <math.h>

typedef struct AlongSpec { /* a motion prescribed in one direction; the others stay free */
  SectionHead head;
  double direction[3], displacement, velocity, acceleration;
} AlongSpec;

static void check_along(const DeckReader *reader, void *section)
{
  const AlongSpec *along = section;
  if (along->direction[0] == 0 && along->direction[1] == 0 && along->direction[2] == 0)
    node_error(reader->document, section_node(section, "direction"), reader->error, "direction: must not be zero");
}

static const Field along_fields[] = {
    {.key = "direction",
     .kind = FIELD_POINT,
     .offset = offsetof(AlongSpec, direction),
     .dimension = "1",
     .meaning = "any length but zero"},
    {.key = "displacement",
     .kind = FIELD_NUMBER,
     .offset = offsetof(AlongSpec, displacement),
     .dimension = "length",
     .standard = "",
     .meaning = "in that direction",
     .group = 'A'},
    {.key = "velocity",
     .kind = FIELD_NUMBER,
     .offset = offsetof(AlongSpec, velocity),
     .dimension = "velocity",
     .standard = "",
     .meaning = "in that direction",
     .group = 'A'},
    {.key = "acceleration",
     .kind = FIELD_NUMBER,
     .offset = offsetof(AlongSpec, acceleration),
     .dimension = "acceleration",
     .standard = "",
     .meaning = "in that direction, from rest",
     .group = 'A'},
};

const Section along_load_section = {.name = "along",
                                    .about = "A motion in one direction; the particles stay free across it.",
                                    .size = sizeof(AlongSpec),
                                    FIELDS(along_fields),
                                    .check = check_along};

/** How often what is given must be integrated over time for a displacement. */
static int order_of(const AlongSpec *along, double *value)
{
  const double given[] = {along->displacement, along->velocity, along->acceleration};
  const int order = !isnan(given[0]) ? 0 : !isnan(given[1]) ? 1 : 2;
  *value = given[order];
  return order;
}

static int create(Load *load, const LoadMaking *making)
{
  const AlongSpec *along = load->value->section;
  double value;
  const int order = order_of(along, &value);
  load_constrain(load, making, along->direction, value, order);
  return BRECCIA_OK;
}

static const double *vector(const LoadValue *value)
{
  return ((const AlongSpec *)value->section)->direction;
}

static double magnitude(const LoadValue *value)
{
  double given;
  order_of(value->section, &given);
  return given;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  static const char *const kinds[] = {"displacement", "velocity", "acceleration"}, *const dimensions[] = {
                                                                                       "length", "velocity",
                                                                                       "acceleration"};
  double given;
  const int order = order_of(value->section, &given);
  *dimension = dimensions[order];
  return kinds[order];
}

const LoadType along_load = {
    .platen = true, .may_press = true, .create = create, .vector = vector, .magnitude = magnitude, .kind = kind};

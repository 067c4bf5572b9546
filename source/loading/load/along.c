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
    node_error(reader->document, section_place(section, "direction"), reader->error, "direction: must not be zero");
}

static const Field along_fields[] = {
    {"direction", FIELD_POINT, offsetof(AlongSpec, direction), "1", NULL, NULL, "any length but zero", NULL, NULL, 0},
    {"displacement", FIELD_NUMBER, offsetof(AlongSpec, displacement), "length", "", NULL, "in that direction", NULL,
     NULL, 'A'},
    {"velocity", FIELD_NUMBER, offsetof(AlongSpec, velocity), "velocity", "", NULL, "in that direction", NULL, NULL,
     'A'},
    {"acceleration", FIELD_NUMBER, offsetof(AlongSpec, acceleration), "acceleration", "", NULL,
     "in that direction, from rest", NULL, NULL, 'A'},
};
const Section along_load_section = {"along",
                                    "A motion in one direction; the particles stay free across it.",
                                    sizeof(AlongSpec),
                                    FIELDS(along_fields),
                                    check_along,
                                    NULL,
                                    NULL,
                                    0};

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
  return fabs(given);
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

const LoadType along_load = {.create = create, .vector = vector, .magnitude = magnitude, .kind = kind};

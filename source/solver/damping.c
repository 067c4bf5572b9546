#include "solver/damping.h"

#include <math.h>

typedef struct DampingSpec {
  SectionHead head;
  double ratio, at; /* of critical damping, at a frequency */
} DampingSpec;

static const Field damping_fields[] = {
    {.key = "ratio",
     .kind = FIELD_NUMBER,
     .offset = offsetof(DampingSpec, ratio),
     .dimension = "1",
     .range = "[0, inf)",
     .meaning = "share of critical damping; 1 comes to rest soonest"},
    {.key = "at",
     .kind = FIELD_NUMBER,
     .offset = offsetof(DampingSpec, at),
     .dimension = "frequency",
     .range = "(0, inf)",
     .meaning = "frequency of the vibration that has this ratio; slower ones are damped more, faster ones less"},
};
const Section damping_section = {.name = "damping",
                                 .about = "Mass-proportional damping by its ratio: c = 4 pi ratio frequency.",
                                 .size = sizeof(DampingSpec),
                                 FIELDS(damping_fields)};

/** The rate c of a number or a section [1/time]. */
static double rate_of(const NumberOrSection *given)
{
  const DampingSpec *spec = given->section;
  return spec ? 4 * acos(-1) * spec->ratio * spec->at : given->value;
}

static const Field rayleigh_fields[] = {
    {.key = "ratio",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RayleighSpec, ratio),
     .dimension = "1",
     .range = "[0, inf)",
     .meaning = "share of critical damping at both frequencies; somewhat less between them, more beyond"},
    {.key = "from",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RayleighSpec, from),
     .dimension = "frequency",
     .range = "(0, inf)",
     .meaning = "the lower frequency, usually the first of the body"},
    {.key = "to",
     .kind = FIELD_NUMBER,
     .offset = offsetof(RayleighSpec, to),
     .dimension = "frequency",
     .range = "(0, inf)",
     .meaning = "the upper one, usually the last that matters"},
};
const Section rayleigh_section = {.name = "Rayleigh damping",
                                  .about = "Damping in proportion to mass and to initial stiffness, by one ratio at "
                                           "two frequencies.",
                                  .size = sizeof(RayleighSpec),
                                  FIELDS(rayleigh_fields)};

static Rayleigh rayleigh_of(const RayleighSpec *spec)
{
  const double from = 2 * acos(-1) * spec->from, to = 2 * acos(-1) * spec->to, twice = 2 * spec->ratio;
  return (Rayleigh){.mass = twice * from * to / (from + to), .stiffness = twice / (from + to)};
}

Rayleigh damping_of(const DampingKeys *keys, const DeckReader *reader, const void *section)
{
  if (!keys->rayleigh) return (Rayleigh){rate_of(&keys->mass), keys->stiffness};
  static const char *const others[] = {"damping", "stiffness damping"};
  const Node *whole = ((const SectionHead *)section)->node;
  for (int k = 0; k < 2; ++k)
    if (section_node(section, others[k]) != whole)
      node_error(reader->document, section_node(section, others[k]), reader->error,
                 "%s: 'Rayleigh damping' says it already; leave one of them out", others[k]);
  return rayleigh_of(keys->rayleigh);
}

double damping_ratio(const DampingKeys *keys)
{
  const DampingSpec *mass = keys->mass.section;
  return keys->rayleigh ? keys->rayleigh->ratio : mass ? mass->ratio : NAN;
}

void damping_describe(const Rayleigh *damping, const char *time, Text *text)
{
  if (damping->mass > 0) text_add(text, ", damping %.4g 1/%s", damping->mass, time);
  if (damping->stiffness > 0) text_add(text, ", stiffness damping %.4g %s", damping->stiffness, time);
}

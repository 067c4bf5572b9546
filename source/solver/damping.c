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

double damping_rate(const NumberOrSection *given)
{
  const DampingSpec *spec = given->section;
  return spec ? 4 * acos(-1) * spec->ratio * spec->at : given->value;
}

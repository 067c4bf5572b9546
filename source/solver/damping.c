#include "solver/damping.h"

#include <math.h>

typedef struct DampingSpec {
  SectionHead head;
  double ratio, at; /* of critical damping, at a frequency */
} DampingSpec;

static const Field damping_fields[] = {
    {"ratio", FIELD_NUMBER, offsetof(DampingSpec, ratio), "1", NULL, "[0, inf)",
     "share of critical damping; 1 comes to rest soonest", NULL, NULL, 0},
    {"at", FIELD_NUMBER, offsetof(DampingSpec, at), "frequency", NULL, "(0, inf)",
     "frequency of the vibration that has this ratio; slower ones are damped more, faster ones less", NULL, NULL, 0},
};
const Section damping_section = {"damping",
                                 "Mass-proportional damping by its ratio: c = 4 pi ratio frequency.",
                                 sizeof(DampingSpec),
                                 FIELDS(damping_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};

double damping_rate(const NumberOrSection *given)
{
  const DampingSpec *spec = given->section;
  return spec ? 4 * acos(-1) * spec->ratio * spec->at : given->value;
}

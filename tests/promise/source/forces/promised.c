/* Forces beside those of bonds as somebody would add them: each particle is held by a soft spring. */
#include "base/team.h"
#include "forces/forces.h"

#include <stdlib.h>

typedef struct PromisedSpec {
  SectionHead head;
  double stiffness;
} PromisedSpec;

static const Field fields[] = {{.key = "promised stiffness",
                                .kind = FIELD_NUMBER,
                                .offset = offsetof(PromisedSpec, stiffness),
                                .dimension = "1",
                                .range = "[0, inf)",
                                .meaning = "force per volume and displacement, in the deck's units"}};
const Section promised_springs_section = {
    .name = "promised_springs", .about = "Forces.", .size = sizeof(PromisedSpec), FIELDS(fields)};

typedef struct Promised {
  Particles *particles;
  double stiffness;
} Promised;

static int create(const void *spec, const ForcesParts *parts, void **forces, Error *error)
{
  Promised *p = *forces = calloc(1, sizeof *p);
  if (!p) return error_add(error, BRECCIA_FAILURE, "out of memory: forces");
  p->particles = (Particles *)(uintptr_t)parts->family->particles;
  p->stiffness = ((const PromisedSpec *)spec)->stiffness;
  return BRECCIA_OK;
}

static void resist(void *forces, double *const *displacement, double *const *internal)
{
  const Promised *p = forces;
  TEAM_FOR (place, p->particles->places)
    for (int k = 0; k < 3; ++k) internal[k][place] -= p->stiffness * displacement[k][place];
}

static double energy(void *forces)
{
  const Promised *p = forces;
  double sum = 0;
  for (int64_t place = 0; place < p->particles->places; ++place)
    for (int k = 0; k < 3; ++k)
      sum += p->stiffness * p->particles->volume[place] * p->particles->displacement.row[k][place] *
             p->particles->displacement.row[k][place] / 2;
  return sum;
}

const ForcesType promised_springs_forces = {
    .name = "promised_springs", .create = create, .destroy = free, .resist = resist, .energy = energy};

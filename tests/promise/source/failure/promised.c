/* A criterion as somebody would add one: bonds break when they have grown by a length. */
#include "failure/failure.h"

#include <math.h>

typedef struct PromisedSpec {
  SectionHead head;
  double elongation;
} PromisedSpec;

static const Field fields[] = {{.key = "promised elongation",
                                .kind = FIELD_NUMBER,
                                .offset = offsetof(PromisedSpec, elongation),
                                .dimension = "length",
                                .range = "(0, inf)",
                                .meaning = "a bond that has grown by this length breaks"}};
static const Section section = {
    .name = "promised", .about = "Keys of a criterion.", .size = sizeof(PromisedSpec), FIELDS(fields)};

static int limits(const FailureSpec *failure, const LimitsOf *of, double *limit)
{
  const PromisedSpec *spec = failure->keys;
  for (int k = 0; k < of->material_count; ++k) limit[k] = spec->elongation;
  return BRECCIA_OK;
}

static double suspect(const Failure *failure, const Family *family, int64_t slice, uint8_t *suspects)
{
  (void)failure, (void)family, (void)slice;
  *suspects = 1;
  return 0;
}

static bool exceeds(const Failure *failure, const Family *family, int64_t slice, int64_t slot, const Bond *bond,
                    int lane)
{
  (void)slot;
  const Particles *p = family->particles;
  const int64_t place = slice * SLICE + lane;
  double square = 0;
  for (int k = 0; k < 3; ++k)
    square += pow(bond->xi[k] + p->displacement.row[k][bond->neighbour] - p->displacement.row[k][place], 2);
  return sqrt(square) - bond->length > failure_limit(failure, place, bond->neighbour);
}

const Criterion criterion_promised = {.name = "promised",
                                      .about = "a bond breaks when it has grown by a length",
                                      .source = "tests/promise",
                                      .dimension = "length",
                                      .section = &section,
                                      .limits = limits,
                                      .suspect = suspect,
                                      .exceeds = exceeds};

/* A bond breaks when the stress on its section is beyond a strength: across it in tension, or along it in shear. For formulations whose bonds have a
 * section and a stress of their own (docs/theory.md 5.3). */
#include "failure/failure.h"

#include <math.h>

typedef struct CriticalStressSpec {
  SectionHead head;
  double tensile, shear; /* shear NaN: it does not count */
} CriticalStressSpec;

static const Field fields[] = {
    {.key = "bond tensile strength",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalStressSpec, tensile),
     .dimension = "stress",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "a bond breaks for good when the tension across its section is beyond this"},
    {.key = "bond shear strength",
     .kind = FIELD_NUMBER,
     .offset = offsetof(CriticalStressSpec, shear),
     .dimension = "stress",
     .standard = "",
     .range = "(0, inf)",
     .meaning = "or when the shear along its section is beyond this; when absent shear breaks nothing"},
};
static const Section section = {
    .name = "critical bond stress",
    .about = "Keys of `failure` with `criterion: critical bond stress`, for `formulation: hybrid`. Only bonds that are "
             "longer than they were break. Strength alone spends less fracture energy with every halved spacing: with "
             "laws that soften it need not be given.",
    .size = sizeof(CriticalStressSpec),
    FIELDS(fields)};

static int limits(const FailureSpec *failure, const LimitsOf *of, double *limit)
{
  const CriticalStressSpec *spec = failure->keys;
  const DeckReader *reader = of->reader;
  const Node *node = section_node(spec, "criterion");
  if (!of->type->section_stress)
    return node_error(
        reader->document, node, reader->error,
        "criterion: bonds of %s have no stress on a section; expected 'formulation: hybrid' with laws for "
        "strain in space, or 'criterion: critical stretch'",
        of->type->name);
  if (isnan(spec->tensile))
    return node_error(reader->document, node, reader->error, "failure: give 'bond tensile strength'");
  for (int k = 0; k < of->material_count; ++k) limit[k] = spec->tensile;
  return BRECCIA_OK;
}

/** Value and limit of one quantity of a bond, tension or shear. */
typedef struct SectionLoad {
  enum { TENSION, SHEAR } quantity;
  double value, limit;
} SectionLoad;

/** Returns tension or shear of a bond: the one that is the larger share of its limit. */
static SectionLoad section_load(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond,
                                int lane)
{
  const CriticalStressSpec *spec = failure->keys;
  const FailureRegion *own = &failure->regions[failure->region[slice]];
  const int64_t place = slice * SLICE + lane;
  const double limit = failure_limit(failure, place, bond->neighbour);
  double tension, shear;
  if (isinf(limit) || !failure_is_longer(f, place, bond)) return (SectionLoad){TENSION, 0, limit};
  own->type->section_stress(own->formulation, slice, slot, lane, &tension, &shear);
  const double shear_limit = isnan(spec->shear) ? INFINITY : spec->shear * (limit / spec->tensile);
  return shear / shear_limit > tension / limit ? (SectionLoad){SHEAR, shear, shear_limit}
                                               : (SectionLoad){TENSION, tension, limit};
}

static bool exceeds(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane)
{
  const SectionLoad load = section_load(failure, f, slice, slot, bond, lane);
  return load.value > load.limit;
}

static double measure(const Failure *failure, const Family *f, int64_t slice, int64_t slot, const Bond *bond, int lane,
                      double *limit, int *quantity)
{
  const SectionLoad load = section_load(failure, f, slice, slot, bond, lane);
  *limit = load.limit;
  *quantity = (int)load.quantity;
  return load.value;
}

/** Stresses change with every step: bonds are looked at in each. */
static double suspect(const Failure *failure, const Family *f, int64_t slice, uint8_t *suspects)
{
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      if (bond.neighbour < slice * SLICE + lane) continue; /* once is enough */
      if (exceeds(failure, f, slice, slot, &bond, lane)) *suspects = 1;
    }
  return 0;
}

const Criterion criterion_critical_stress = {
    .name = "critical bond stress",
    .about = "a bond breaks when the tension across its section, or the shear along it, is beyond a strength",
    .source = "docs/theory.md 5",
    .dimension = "stress",
    .section = &section,
    .limits = limits,
    .suspect = suspect,
    .exceeds = exceeds,
    .measure = measure,
    .quantities = {[TENSION] = "tension", [SHEAR] = "shear"},
    .power = 2,
};

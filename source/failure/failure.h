/* When a bond breaks. A criterion finds suspect slices in a fast sweep; the few bonds in them are then judged and broken one
 * by one, in a fixed order, both sides at once. */
#ifndef BRECCIA_FAILURE_FAILURE_H
#define BRECCIA_FAILURE_FAILURE_H

#include "deck/section.h"
#include "family/family.h"

typedef struct FailureSpec {
  SectionHead head;
  double critical_stretch, fracture_energy; /* NaN: not given */
} FailureSpec;

extern const Section failure_section;

typedef struct Criterion {
  const char *name, *about, *source;
  /** Marks a slice if some bond of it may exceed the limit.
   *  @return how far every particle may move before the slice has to be looked at again; 0: look at every step */
  double (*suspect)(double limit, const Family *family, int64_t slice, uint8_t *suspect);
  /** True if this bond exceeds it. */
  bool (*exceeds)(double limit, const Family *family, int64_t slice, const Bond *bond, int lane);
} Criterion;

extern const Criterion criterion_critical_stretch;

typedef struct Failure {
  const Criterion *criterion; /* NULL: bonds do not break */
  double limit;
} Failure;

#endif

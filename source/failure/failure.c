#include "failure/failure.h"

#include <math.h>

static const Field failure_fields[] = {
    {"critical stretch", FIELD_NUMBER, offsetof(FailureSpec, critical_stretch), "1", "", "(0, inf)",
     "a bond that is stretched by more than this share of its length breaks for good", NULL, NULL, 0},
};
const Section failure_section = {"failure",
                                 "When bonds break. Without this section, or with nothing in it, they never do.",
                                 sizeof(FailureSpec),
                                 FIELDS(failure_fields),
                                 NULL,
                                 NULL,
                                 NULL,
                                 0};

Failure failure_of(const FailureSpec *spec)
{
  if (!spec || isnan(spec->critical_stretch)) return (Failure){0};
  return (Failure){&criterion_critical_stretch, spec->critical_stretch};
}

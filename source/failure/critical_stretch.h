/* The keys of the criterion by stretch. */
#ifndef BRECCIA_FAILURE_CRITICAL_STRETCH_H
#define BRECCIA_FAILURE_CRITICAL_STRETCH_H

#include "failure/failure.h"

typedef struct CriticalStretchSpec {
  SectionHead head;
  double stretch, fracture_energy; /* NaN: not given */
} CriticalStretchSpec;

/** The keys, where a deck has this criterion; else NULL. */
const CriticalStretchSpec *critical_stretch_spec(const FailureSpec *failure);

#endif

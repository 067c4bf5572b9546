/* The keys of the criterion by stretch. */
#ifndef BRECCIA_FAILURE_CRITICAL_STRETCH_H
#define BRECCIA_FAILURE_CRITICAL_STRETCH_H

#include "failure/failure.h"

typedef struct CriticalStretchSpec {
  SectionHead head;
  double stretch, fracture_energy; /* NaN: not given */
  int calibration;                 /* FailureCalibration */
} CriticalStretchSpec;

/** The keys, where a deck has this criterion; else NULL. */
const CriticalStretchSpec *critical_stretch_spec(const FailureSpec *failure);

/** Returns the critical stretch of a material with which cracks take a fracture energy: in the mean over all planes of
 *  its lattice, or by the integrals of a continuum, which also serve particles outside a lattice.
 *  @param[in] material  index of the material in of->materials */
double critical_stretch_of(const LimitsOf *of, int material, double energy, FailureCalibration calibration);

#endif

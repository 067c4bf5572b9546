/* The keys of the criterion by energy. */
#ifndef BRECCIA_FAILURE_CRITICAL_ENERGY_H
#define BRECCIA_FAILURE_CRITICAL_ENERGY_H

#include "failure/failure.h"

typedef struct CriticalEnergySpec {
  SectionHead head;
  double energy, fracture_energy; /* NaN: not given */
  int calibration;                /* FailureCalibration */
} CriticalEnergySpec;

/** The keys, where a deck has this criterion; else NULL. */
const CriticalEnergySpec *critical_energy_spec(const FailureSpec *failure);

/** Sum over the bonds across a unit area of a plane, if each counts 1 per volume squared: G_F over the energy of a bond. With bonds at
 *  least as long as the distance z of their particle, 2 integral dz over all bonds beyond the plane: pi delta^4 / 4 in space, 2 t delta^3 / 3 in
 *  the plane, A delta^2 / 2 of a bar (docs/theory.md 4).
 *  @param[in] section  thickness of a plane body, cross-section of a bar, else 1 */
double bonds_across(Space space, double horizon, double section);

#endif

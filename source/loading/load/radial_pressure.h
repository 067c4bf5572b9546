/* Load `radial pressure`: a pressure on a round surface, directed away from an axis. */
#ifndef BRECCIA_LOADING_LOAD_RADIAL_PRESSURE_H
#define BRECCIA_LOADING_LOAD_RADIAL_PRESSURE_H

#include "loading/load.h"

typedef struct RadialPressureSpec {
  SectionHead head;
  double pressure, area, centre[3], axis[3]; /* axis: NaN where it is not given */
} RadialPressureSpec;

extern const LoadType radial_pressure_load;

/** Computes the unit vector from the axis to a particle, perpendicular to the axis.
 *  @param[out] distance  distance of the particle from the axis [length]
 *  @return false if the particle is on the axis */
bool radial_pressure_outwards(const RadialPressureSpec *spec, const Particles *particles, int32_t place, double n[3],
                              double *distance);

#endif

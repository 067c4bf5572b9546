/* Pressure on a round surface. */
#ifndef BRECCIA_LOADING_LOAD_RADIAL_PRESSURE_H
#define BRECCIA_LOADING_LOAD_RADIAL_PRESSURE_H

#include "loading/load.h"

typedef struct RadialPressureSpec {
  SectionHead head;
  double pressure, area, centre[3], axis[3]; /* axis: NaN where it is not given */
} RadialPressureSpec;

extern const LoadType radial_pressure_load;

/** Finds the unit vector from the axis to a place, across the axis.
 *  @param[out] distance  of the place from the axis @return false: the place stands on the axis */
bool radial_pressure_outwards(const RadialPressureSpec *spec, const Particles *particles, int32_t place, double n[3],
                              double *distance);

#endif

/* The keys of water against a face. */
#ifndef BRECCIA_LOADING_WATER_PRESSURE_H
#define BRECCIA_LOADING_WATER_PRESSURE_H

#include "loading/load.h"

typedef struct WaterPressureSpec {
  SectionHead head;
  double surface, unit_weight;
} WaterPressureSpec;

extern const LoadType water_pressure_load;

#endif

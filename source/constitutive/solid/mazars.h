/* Mazars' damage: what its parameters become, and a point's history (mazars.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_MAZARS_H
#define BRECCIA_CONSTITUTIVE_MAZARS_H

#include "constitutive/solid/solid_lanes.h"

enum { MAZARS_LARGEST = 0, MAZARS_DAMAGE, MAZARS_HISTORY };

typedef struct Mazars {
  Elasticity elastic;
  double threshold, tension_rate, compression_share, compression_rate;
  SolidUpdate *update; /* for the vectors of this machine */
} Mazars;

LANES_CHOICE(SolidUpdate, mazars_update)

#endif

/* Damage by stretch at a point in space: what its parameters become, and a point's history (link_damage.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_LINK_LAW_H
#define BRECCIA_CONSTITUTIVE_LINK_LAW_H

#include "constitutive/solid/solid_lanes.h"

typedef struct LinkLaw {
  Elasticity elastic;
  breccia_link link;
  SolidUpdate *update; /* for the vectors of this machine */
} LinkLaw;

enum { LINK_TENSILE = 0, LINK_COMPRESSIVE, LINK_HISTORY };

LANES_CHOICE(SolidUpdate, link_damage_update)

#endif

/* Damage by stretch at a point in space: what its parameters become, and a point's history (link_damage.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_LINK_LAW_H
#define BRECCIA_CONSTITUTIVE_LINK_LAW_H

#include "constitutive/solid/solid_lanes.h"

/** Moduli of principal stresses of closed cracks: E; E / (1 - nu^2) and nu E / (1 - nu^2), where one direction is open;
 * 1 / E. */
typedef struct ClosedModuli {
  double young, plane, across, by_young;
} ClosedModuli;

typedef struct LinkLaw {
  Elasticity elastic;
  breccia_link link;
  ClosedModuli closed;
  SolidUpdate *update; /* for the vectors of this machine */
} LinkLaw;

/* The closing offset is the size of the strain of closed cracks at which they begin to carry pressure [strain]. */
enum { LINK_TENSILE = 0, LINK_COMPRESSIVE, LINK_CLOSING_OFFSET, LINK_HISTORY };

LANES_CHOICE(SolidUpdate, link_damage_update)

#endif

/* J2 plasticity: what its parameters become, and a point's history (j2.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_J2_H
#define BRECCIA_CONSTITUTIVE_J2_H

#include "constitutive/solid/hardening.h"

typedef struct J2 {
  Elasticity elastic;
  Hardening hardening;
  double kinematic;
  SolidUpdate *update; /* for the vectors of this machine */
} J2;

/* History: plastic strain, equivalent plastic strain, and the back stress if it can move. */
enum { J2_EQUIVALENT = 6, J2_BACK, J2_HISTORY = J2_BACK + 6 };

LANES_CHOICE(SolidUpdate, j2_update)

#endif

/* Drucker-Prager plasticity: what its parameters become, and a point's history (drucker_prager.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_DRUCKER_PRAGER_H
#define BRECCIA_CONSTITUTIVE_DRUCKER_PRAGER_H

#include "constitutive/solid/hardening.h"

typedef struct DruckerPrager {
  Elasticity elastic;
  double slope, dilation; /* A and A' */
  Hardening hardening;
  double cut;
  SolidUpdate *update; /* for the vectors of this machine */
} DruckerPrager;

/* Plastic strain first. */
enum { CONE_EQUIVALENT = 6, CONE_HISTORY };

LANES_CHOICE(SolidUpdate, drucker_prager_update)

#endif

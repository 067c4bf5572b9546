/* Damage by stretch at a point in space: what its parameters become, and a point's history (link_damage.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_LINK_LAW_H
#define BRECCIA_CONSTITUTIVE_LINK_LAW_H

#include "constitutive/normal_lengths.h"
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
  /* straight: 2 G_F / (E S_t) [length], which divided by the length is the end stretch of a single line; 0: no fracture
   * energy. first_share: part of G_F below the first of two lines; 1: there is one line. */
  double straight, first_share;
  NormalLengths lengths;
  SolidUpdate *update; /* for the vectors of this machine */
} LinkLaw;

/* The closing offset is the size of the strain of closed cracks at which they begin to carry pressure [strain]. */
/* LINK_LENGTH is the length by the crack normal (normal_lengths.h). */
enum { LINK_TENSILE = 0, LINK_COMPRESSIVE, LINK_CLOSING_OFFSET, LINK_LENGTH, LINK_HISTORY };

/** Sets the lengths by crack normal over which points spread the fracture energy. */
void link_damage_take_lengths(void *constants, const NormalLengths *lengths);
/** Returns true if a history [history_values] has tensile damage. */
bool link_damage_is_damaged(const void *constants, const double *history);

LANES_CHOICE(SolidUpdate, link_damage_update)

#endif

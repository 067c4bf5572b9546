/* Mohr-Coulomb plasticity: what its parameters become, and a point's history (mohr_coulomb.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_MOHR_COULOMB_H
#define BRECCIA_CONSTITUTIVE_MOHR_COULOMB_H

#include "constitutive/solid/solid_lanes.h"

/* Planes: shear between principal directions 1 and 3, 1 and 2, 2 and 3; tension in 1, 2, 3. */
enum { SHEAR13, SHEAR12, SHEAR23, TENSION1, TENSION2, TENSION3, PLANES };
enum { COULOMB_SETS = 9 };
enum { COULOMB_HISTORY = 6 }; /* the plastic strain */

/* The sets of planes that a sorted stress can end on, in the order in which they are tried. The tip of the pyramid is a corner of the cut-off, which never lies
 * beyond it. */
typedef struct PlaneSet {
  int count, plane[3];
} PlaneSet;
static const PlaneSet coulomb_sets[COULOMB_SETS] = {
    {1, {SHEAR13}},
    {1, {TENSION1}},
    {2, {SHEAR13, TENSION1}},
    {2, {SHEAR13, SHEAR12}},
    {2, {SHEAR13, SHEAR23}},
    {2, {TENSION1, TENSION2}},
    {3, {SHEAR13, SHEAR12, TENSION1}},
    {3, {SHEAR13, TENSION1, TENSION2}},
    {3, {TENSION1, TENSION2, TENSION3}},
};

/** The return of sorted principal stresses to a set of planes: multipliers, times 2 G, are `inverse` times what the trial stress is beyond them; each takes its
 *  `stiff_flow` off. Three planes meet in a corner. */
typedef struct CoulombReturn {
  bool exists;
  double inverse[3][3], stiff_flow[3][3], corner[3], slopes[9]; /* d stress / d principal strain */
} CoulombReturn;

typedef struct MohrCoulomb {
  Elasticity elastic;
  double sine, dilation, limit;        /* sin(phi), sin(psi), 2 c cos(phi) */
  double tensile;                      /* of the cut-off */
  CoulombReturn returns[COULOMB_SETS]; /* in the order in which they are tried */
  SolidUpdate *update;                 /* for the vectors of this machine */
} MohrCoulomb;

LANES_CHOICE(SolidUpdate, mohr_coulomb_update)

#endif

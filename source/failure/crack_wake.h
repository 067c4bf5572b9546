/* Energy of running cracks through brittle bonds, over the energy of plane cracks (crack_planes.h). Bonds beside the
 * path of a running crack may break, too (the wake), and loads do more work than all bonds dissipate (lattice
 * trapping). Both shares were measured on a notched strip that a wedge opens in equilibrium (bench/toughness.py). */
#ifndef BRECCIA_FAILURE_CRACK_WAKE_H
#define BRECCIA_FAILURE_CRACK_WAKE_H

#include "failure/crack_planes.h"

/** Measured shares for a formulation, a criterion, a lattice and a horizon. */
typedef struct CrackWake {
  /* Smallest and largest energy of broken bonds over directions, over the mean of plane cracks. */
  double taken[2];
  /* Smallest and largest work of loads over directions, over the mean of plane cracks. */
  double felt[2];
  /* False: the table has no entry for the formulation and the criterion. */
  bool is_known;
  /* False: the values are those of the nearest lattice or horizon in the table. */
  bool is_measured;
  const char *lattice;
  /* Horizon of the table entry, in spacings. */
  double spacings;
} CrackWake;

/** Returns the measured shares whose lattice and horizon in spacings are nearest to those of a block.
 *  @param[in] criterion  name of the criterion by which bonds break */
CrackWake crack_wake(const CrackBlock *block, const char *criterion);

#endif

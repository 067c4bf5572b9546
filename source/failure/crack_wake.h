/* Energy that a running crack takes of brittle bonds over the energy of the plane crack (crack_planes.h): bonds beside
 * the path may break, too (the wake), and loads do more work than all bonds take (lattice trapping). Both were measured
 * in a notched strip that a wedge opens at rest (bench/toughness.py). */
#ifndef BRECCIA_FAILURE_CRACK_WAKE_H
#define BRECCIA_FAILURE_CRACK_WAKE_H

#include "failure/crack_planes.h"

/** Measured shares of a formulation, a criterion, a lattice and a horizon. */
typedef struct CrackWake {
  /* Least and largest energy of broken bonds over the mean of plane cracks, by the direction. */
  double taken[2];
  /* Least and largest work of the loads over the mean of plane cracks. */
  double felt[2];
  /* False: no row of the table has the formulation and the criterion. */
  bool is_known;
  /* False: the values are those of the nearest lattice or horizon in the table. */
  bool is_measured;
  const char *lattice;
  /* Horizon of the table's row over the spacing. */
  double spacings;
} CrackWake;

/** Returns the measured shares nearest to a block by its lattice and its horizon over its spacing.
 *  @param[in] criterion  name of the criterion by which bonds break */
CrackWake crack_wake(const CrackBlock *block, const char *criterion);

#endif

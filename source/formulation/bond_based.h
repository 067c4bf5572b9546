/* What the sweep of bond-based peridynamics (bond_based.c) and its constants (bond_constants.c) share. */
#ifndef BRECCIA_FORMULATION_BOND_BASED_H
#define BRECCIA_FORMULATION_BOND_BASED_H

#include "formulation/formulation.h"

typedef struct BondBased {
  const Particles *particles;
  const Family *family;
  const Body *body;
  const Points *points;
  Space space;
  const Influence *influence;
  double *stiffness; /* c of each place's material and lattice; a bond has the mean of its two. NULL: all alike */
  double uniform;    /* c, if all are alike */
} BondBased;

/** c by the continuum's integrals (docs/theory.md 2, table and general rule). */
double bond_continuum_constant(const BondBased *b, double young);

/** Factor on the continuum's c for the lattice of a block. */
double bond_calibration(const BondBased *b, int block, Calibration calibration);

/** As FormulationType describes them. */
double bond_critical_stretch(const void *formulation, double fracture_energy);
void bond_describe(const void *formulation, Text *text);

#endif

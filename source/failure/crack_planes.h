/* Energy of plane cracks through a lattice, by the normal of the plane.
 *
 * In a lattice of volume V per particle |xi . n| / V bonds of each vector xi cross a unit area of a plane with the
 * normal n. If a bond takes the energy e V, the crack takes
 *   G(n) = 1/2 sum |xi . n| e(xi)
 * over all bonds of a particle, both ways (docs/theory.md 4, equation 4.1). Criteria are calibrated so that the mean
 * over all normals is the fracture energy; the least and the largest value tell how far directions differ. */
#ifndef BRECCIA_FAILURE_CRACK_PLANES_H
#define BRECCIA_FAILURE_CRACK_PLANES_H

#include "failure/failure.h"

/** A quantity of plane cracks by their normal.
 *  @param[in] normal  unit vector */
typedef double CrackQuantity(const void *context, const double normal[3]);

typedef struct CrackBand {
  double mean, least, most; /* over all normals */
  double across[3];         /* of cracks across x, y, z */
} CrackBand;

/** Samples a quantity of plane cracks over all normals of a line, the plane or space.
 *  @return NaN in all members where the quantity is NaN */
CrackBand crack_band(int dimensions, CrackQuantity *quantity, const void *context);

struct CrackBlock {
  const FormulationType *type;
  const void *formulation;
  const Family *family;
  const Influence *influence;
  int block;
  const Lattice *lattice; /* lattice of the block */
};

/** Returns the length over which a plane crack spreads a fracture energy (FormulationType.crack_length).
 *  @param[in] crack_block  a CrackBlock */
double crack_length_across(const void *crack_block, const double normal[3]);
/** Returns the sum over the bonds across a unit area of a plane, if each counts 1 per volume squared (bonds_across).
 *  @param[in] crack_block  a CrackBlock */
double crack_bonds_across(const void *crack_block, const double normal[3]);

/** Returns the mean of a quantity over normals and over the blocks of a material.
 *  @return NaN where no block of the material is a lattice, or the quantity is unknown
 *  @param[in] material  index of it in of->materials */
double crack_mean(const LimitsOf *of, int material, CrackQuantity *quantity);

#endif

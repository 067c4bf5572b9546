/* Families of particles from files that count as inside their block: those over which stiffnesses are calibrated. */
#ifndef BRECCIA_FORMULATION_WHOLE_FAMILY_H
#define BRECCIA_FORMULATION_WHOLE_FAMILY_H

#include "family/family.h"

/** Share of the volume of the horizon, or of the largest family, from which on a family counts as whole. */
#define WHOLE_FAMILY_SHARE 0.95

/** Volume from which a particle of a file and its neighbours count as a family inside the block: 95 % of the
 *  horizon's, or of that of the largest family, if that is less.
 *  @param[in] least  share of the horizon that the largest family must fill
 *  @return infinite if it does not */
double whole_family_volume(const Body *body, const Family *family, int block, double least);

/** Returns true if a place stands in a block and its family has at least that volume. */
bool whole_family_at(const Family *family, int block, int64_t place, double volume);

/** Finds the places of a block with inside families that are nearest to the middle of all such places. The result does
 *  not depend on the order or the direction of the particles.
 *  @param[in] least  share of the horizon that the largest family must fill
 *  @param[out] places  [most], the nearest first
 *  @return their number; 0 if no family counts as inside */
int whole_families_in_the_middle(const Body *body, const Family *family, int block, double least, int most,
                                 int64_t *places);

#endif

/* Tensile strength of bodies whose bonds soften: bonds take a share of the tensile strength of the deck such that the
 * body carries this strength under uniaxial tension in its strongest direction. */
#ifndef BRECCIA_DOMAIN_TENSILE_STRENGTH_H
#define BRECCIA_DOMAIN_TENSILE_STRENGTH_H

#include "domain/domain.h"

/** Sets the shares of the tensile strength that bonds take. Called after formulations are created and before any point
 *  is updated.
 *  @return BRECCIA_OK, or BRECCIA_USER_ERROR with the reason */
int tensile_strength_set(Domain *domain, const DeckReader *reader, const SectionList *materials);

/** Adds a line for each material and lattice of softening bonds: the smallest and the largest strength of the body over
 * directions, under uniaxial tension. */
void tensile_strength_describe(const Domain *domain, Text *text);

#endif

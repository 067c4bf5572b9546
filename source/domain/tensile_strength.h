/* Tensile strength of bodies whose bonds soften: bonds take such a share of the tensile strength that the body carries
 * that strength, pulled one way in the direction in which it carries most. */
#ifndef BRECCIA_DOMAIN_TENSILE_STRENGTH_H
#define BRECCIA_DOMAIN_TENSILE_STRENGTH_H

#include "domain/domain.h"

/** Sets the shares of tensile strengths that bonds take. Formulations are made; no point has been updated.
 *  @return BRECCIA_OK, or BRECCIA_USER_ERROR with the reason */
int tensile_strength_set(Domain *domain, const DeckReader *reader, const SectionList *materials);

/** Adds a line for each material and lattice of bonds that soften: what a body carries pulled one way, least and
 * largest over directions. */
void tensile_strength_describe(const Domain *domain, Text *text);

#endif

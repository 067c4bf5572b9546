/* How far the toughness of a body depends on the direction of its cracks, in words. */
#ifndef BRECCIA_DOMAIN_TOUGHNESS_H
#define BRECCIA_DOMAIN_TOUGHNESS_H

#include "domain/domain.h"

/** Adds a line for each block whose cracks take an energy that follows from what a plane cuts of its lattice: the band
 *  over all directions, and the values across the axes. Blocks of one material and one lattice have one line.
 *  @param[in] failure  that of the deck; NULL: none */
void toughness_describe(const Domain *domain, const FailureSpec *failure, const Units *units, Text *text);

#endif

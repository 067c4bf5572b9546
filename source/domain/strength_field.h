/* Strengths that differ from particle to particle: `fields: {strength: ...}` of a deck.
 *
 * A factor s of a particle multiplies both axes of the curve of its law:
 *   stress(strain) = s stress_0(strain / s)
 * where stress_0 is the law of the deck (points/points.h). Strengths, yield stresses and strains at which the law softens
 * or breaks change by s, moduli stay, and energies per volume and fracture energies change by s^2. Limits of failure
 * criteria change in the same way. A bond, and a point on a bond, has the smaller factor of the two ends, as it has
 * the smaller limit of two materials. Factors depend on the deck and the number of the particle alone, so that they are
 * the same for any number of threads and after a restart; an image outside of a support has the factor of its original. */
#ifndef BRECCIA_DOMAIN_STRENGTH_FIELD_H
#define BRECCIA_DOMAIN_STRENGTH_FIELD_H

#include "domain/domain.h"

extern const Section fields_section;

/** Finds the factors of all places (Domain.strength), which stay NULL if the deck gives none. Serial.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR after a message */
int strength_field_create(Domain *domain, const DeckReader *reader, const FieldsSpec *spec);
/** Refuses regions whose formulation or laws have no points that could take factors.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR after a message */
int strength_field_check(const Domain *domain, const DeckReader *reader, const FieldsSpec *spec);
/** Adds a line with the smallest, mean and largest factor of the body. Nothing without a field. */
void strength_field_describe(const Domain *domain, Text *text);

#endif

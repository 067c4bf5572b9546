/* Stresses with which a body begins, given by the deck: ground at rest under its own weight, or tensors. */
#ifndef BRECCIA_DOMAIN_INITIAL_STRESS_H
#define BRECCIA_DOMAIN_INITIAL_STRESS_H

#include "domain/domain.h"
#include "loading/load.h"

/** One item of the deck. */
typedef struct InitialStressSpec {
  SectionHead head;
  Reference on;                               /* no node: the whole body */
  NumberList stress;                          /* of one tensor; or */
  double surface, k0, unit_weight, surcharge; /* of ground at rest; weight NaN: by density and gravity */
} InitialStressSpec;

extern const Section initial_stress_section;

/** Lets points begin under the stresses of the deck, and finds what they store by that. Layers outside the body go on with the stress inside; where a
 *  face slides, without the shear that it cannot take.
 *  @param[in] loading  of the body: gravity of the first stage tells the weight of ground and which way is down */
int domain_begin_under(Domain *domain, const Loading *loading, const DeckReader *reader, const SectionList *items,
                       const SectionList *selections);

#endif

/* Inside of domain/: regions of a body, and what its joints do (regions.c, joint.c). */
#ifndef BRECCIA_DOMAIN_REGIONS_H
#define BRECCIA_DOMAIN_REGIONS_H

#include "domain/domain.h"

/** Which formulation has which slices, from the deck; the formulations themselves are not made yet. The body stands. */
int regions_create(Domain *domain, const DeckReader *reader, const PeridynamicsSpec *spec);
void regions_destroy(Domain *domain);

/** Slices of other regions whose particles have bonds with those of each region. Families stand. */
int regions_find_borders(Domain *domain, Error *error);

/** Finds the bonds between regions. */
int joint_create(Joint *joint, const Domain *domain, Error *error);
void joint_destroy(Joint *joint);
/** Takes from the forces what the neighbours in other regions give by their own formulations, by all threads. @param[in] at  as in Sweep */
void joint_resist(const Domain *domain, double *const *at);

#endif

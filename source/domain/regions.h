/* Inside of domain/: materials, regions of a body, their points, and what joints do. */
#ifndef BRECCIA_DOMAIN_REGIONS_H
#define BRECCIA_DOMAIN_REGIONS_H

#include "domain/domain.h"

/** Which formulation has which slices, from the deck; the formulations themselves are not made yet. The body stands. */
int regions_create(Domain *domain, const DeckReader *reader, const PeridynamicsSpec *spec);
/** Regions all of whose materials take one strain become what their formulation is with such laws; refuses keys that say nothing then. */
int regions_take_fibres(Domain *domain, const DeckReader *reader, const SectionList *materials);
void regions_destroy(Domain *domain);

/** Slices of other regions whose particles have bonds with those of each region. Families stand. */
int regions_find_borders(Domain *domain, Error *error);

/** Length over which a formulation spreads a fracture energy; NaN if it does not. */
static inline double region_length(const FormulationType *type, const BondLength *of)
{
  return type->characteristic_length ? type->characteristic_length(of) : __builtin_nan("");
}

/** Makes the materials of the deck, and refuses laws and parameters that the formulations of their regions do not take
 *  (domain_materials.c). Regions are made. */
int domain_create_materials(Domain *domain, const DeckReader *reader, const DomainSpec *spec, const BondLength *of);

/** Makes the points of a region: on particles where laws take six strains; on bonds where they take one, unless all are linear
 *  (region_points.c). Families and materials are made. */
int region_create_points(Domain *domain, Region *region, Space space, bool may_give_up, const BondLength *of,
                         Error *error);

/** Sets the lengths over which points spread a fracture energy (domain_lengths.c) in laws that accept such lengths, if
 *  the formulations of all regions find them. A `length` in the deck takes precedence. Called after formulations are
 *  created. */
int domain_find_lengths(Domain *domain, Space space, Error *error);

/** Windows for a region whose bonds do not break, where they take less than half of what sums of all slices do. Its formulation is made. */
int window_create(Domain *domain, Region *region, Error *error);
void window_destroy(Window *window);
/** Window of this thread; NULL: this team works without. */
double *window_of_thread(const Window *window);
/** Bytes of what phases `ahead` write. */
size_t window_bytes(const Domain *domain, const Region *region);

/** Finds the bonds between regions. */
int joint_create(Joint *joint, const Domain *domain, Error *error);
void joint_destroy(Joint *joint);
/** Takes from the forces what the neighbours in other regions give by their own formulations, by all threads. */
void joint_resist(const Domain *domain, const Evaluation *of);

#endif

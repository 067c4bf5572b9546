/* Cell-list search for bonds of particles that stand in no common lattice; within a lattice the offsets are known. */
#ifndef BRECCIA_FAMILY_SEARCH_H
#define BRECCIA_FAMILY_SEARCH_H

#include "family/family.h"

typedef struct StoredBonds { /* compressed rows over places, in an order that does not depend on threads */
  int64_t *first;            /* [places + 1]; NULL: none */
  int32_t *neighbour;
  double *scale; /* influence x volume correction; NULL: 1 for all */
} StoredBonds;

typedef struct StoredWeight {
  double horizon;
  const Influence *influence;
  VolumeCorrection correction;
  double (*share)(VolumeCorrection correction, double length, double horizon, double half_spacing);
} StoredWeight;

/** O(N) for bodies of even density. Refuses particles nearer than a hundredth of a spacing. */
int search_beyond_lattices(StoredBonds *stored, const Body *body, const StoredWeight *weight, Error *error);
void stored_bonds_destroy(StoredBonds *stored);

#endif

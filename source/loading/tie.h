/* Ties as rows: the displacement of a particle along an axis is that of its master, whatever lay between them when the tie began. Rows that
 * meet make groups with one motion. In explicit steps the forces of a group are shared by mass, which is what rows ask for when masses are
 * lumped: the forces that a tie exerts then sum to nothing and do no work. */
#ifndef BRECCIA_LOADING_TIE_H
#define BRECCIA_LOADING_TIE_H

#include "loading/load.h"

typedef struct Tie { /* what a load of this kind keeps */
  bool along[3];
  int32_t *masters; /* [particles of the load] places; one of the particles themselves may be its own */
} Tie;

extern const LoadType tie_load;

/** Largest distance of a particle from its master, at the start. */
double tie_reach(const Load *load, const Particles *particles);

/** Groups of the ties that act in the stage under way. Those before are freed. */
int tie_groups_make(Loading *loading, const Particles *particles, Error *error);
void tie_groups_destroy(TieGroups groups[3]);

/** Of two tied particles both or none must be held in a direction of the tie. */
int ties_check(const Loading *loading, const Particles *particles, const DeckReader *reader);

/** By all threads: adds to the external forces what makes accelerations equal, at the internal forces held. */
void tie_groups_push(const TieGroups groups[3], Particles *particles);
/** By all threads: velocities and accelerations of the first particle of each group for all of it. */
void tie_groups_keep(const TieGroups groups[3], Particles *particles, double *const acceleration[3]);
/** Common velocities by momentum. */
void tie_groups_join(const TieGroups groups[3], Particles *particles);

#endif

/* Mazars' damage: what its parameters become, and a point's history (mazars.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_MAZARS_H
#define BRECCIA_CONSTITUTIVE_MAZARS_H

#include "constitutive/normal_lengths.h"
#include "constitutive/solid/solid_lanes.h"

/* MAZARS_LENGTH is the length by the crack normal (normal_lengths.h). */
enum { MAZARS_LARGEST = 0, MAZARS_DAMAGE, MAZARS_LENGTH, MAZARS_HISTORY };

typedef struct Mazars {
  Elasticity elastic;
  double threshold, tension_rate, compression_share, compression_rate;
  double opening; /* G_F / f_t */
  NormalLengths lengths;
  SolidUpdate *update; /* for the vectors of this machine */
} Mazars;

/** Sets the lengths by crack normal over which points spread the fracture energy. */
void mazars_take_lengths(void *constants, const NormalLengths *lengths);
/** Returns true if the largest equivalent strain of a history [history_values] exceeds the damage threshold. */
bool mazars_is_damaged(const void *constants, const double *history);

LANES_CHOICE(SolidUpdate, mazars_update)

#endif

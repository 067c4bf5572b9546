/* The plastic-damage model of concrete: what its parameters become, and a point's history (damage_plasticity.c tells the law). */
#ifndef BRECCIA_CONSTITUTIVE_DAMAGE_PLASTICITY_H
#define BRECCIA_CONSTITUTIVE_DAMAGE_PLASTICITY_H

#include "constitutive/normal_lengths.h"
#include "constitutive/solid/solid_lanes.h"

typedef struct DamagePlasticity {
  Elasticity elastic;
  double alpha, gamma, dilation, rounding; /* tan(psi), e f_t tan(psi) */
  double tension, tension_rate, tension_share;
  double tail, steeper; /* t, and k - 1; 1 and 0: one exponential */
  double compression, hump, compression_rate, compression_share;
  double by_twice_shear, by_rounding, by_tension, by_rest_of_alpha; /* 1 / 2G, 1 / rounding, 1 / f_t, 1 / (1 - alpha) */
  double by_invariant, by_deviator; /* of squares of I1 and q in a^2: 1 / (9 K E), 1 / (3 G E) */
  bool recovers_by_share;           /* as published: no closing offset */
  double opening, initial_opening;  /* G_F / f_t and G_f / f_t [length]; initial_opening is 0 without a tail */
  double peak_strain;               /* f_t / E */
  NormalLengths lengths;
  SolidUpdate *update; /* for the vectors of this machine */
} DamagePlasticity;

/* Plastic strain first. */
/* The closing offset is the size of the elastic strain at which closed cracks begin to carry stress [strain].
 * PLASTIC_LENGTH is the length over which the point spreads G_F, by its crack normal (normal_lengths.h); 0: the length
 * of the law. */
enum {
  PLASTIC_IN_TENSION = 6,
  PLASTIC_IN_COMPRESSION,
  PLASTIC_DAMAGE,
  PLASTIC_CLOSING_OFFSET,
  PLASTIC_LENGTH,
  DAMAGE_PLASTICITY_HISTORY
};

/** Sets the lengths by crack normal over which points spread the fracture energy. */
void damage_plasticity_take_lengths(void *constants, const NormalLengths *lengths);
/** Returns true if a history [history_values] has plastic strain in tension. */
bool damage_plasticity_is_damaged(const void *constants, const double *history);
/** Returns the length [length] over which a point can spread the fracture energy at the most: over a longer one its
 *  curve in tension would snap back. Points with a longer length take more than the fracture energy. */
double damage_plasticity_longest(const void *constants);

/** Returns the least area below the curve of tension over plastic strain, over f_t [1]: steeper curves would snap
 *  back. */
static inline double damage_plasticity_steepest(const DamagePlasticity *c)
{
  return (1 - c->tension_share + 0.01) * c->peak_strain;
}

LANES_CHOICE(SolidUpdate, damage_plasticity_update)

#endif

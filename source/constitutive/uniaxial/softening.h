/* What laws that soften in tension share: stress = (1 - damage) E strain while a point is strained, E strain in compression (cracks close);
 * damage only grows, and unloading goes straight back to the origin. */
#ifndef BRECCIA_CONSTITUTIVE_UNIAXIAL_SOFTENING_H
#define BRECCIA_CONSTITUTIVE_UNIAXIAL_SOFTENING_H

#include "base/lanes.h"
#include "constitutive/law.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

enum { SOFTENING_YOUNG, SOFTENING_STRENGTH, SOFTENING_ENERGY, SOFTENING_LENGTH, SOFTENING_PARAMETERS };

#define SOFTENING_PARAMETER_ROWS                                                                                       \
  {"Young modulus", "stress", NULL, "(0, inf)", "E"}, {"tensile strength", "stress", NULL, "(0, inf)", "f_t"},         \
      {"fracture energy", "fracture energy", NULL, "(0, inf)", "G_F per area of crack"},                               \
  {                                                                                                                    \
    "length", "length", "", "(0, inf)",                                                                                \
        "over which the fracture energy is spread; that of the formulation when absent"                                \
  }

typedef struct Softening {
  double young, strength;
  double peak, end; /* strains at the strength and where nothing is left */
} Softening;

/** Envelope beyond the peak: stress over strength at x = 0 (peak) to 1 (end), and its slope. */
typedef double (*SofteningEnvelope)(const void *constants, double x, double *slope);

/** Sets E, f_t and the two strains such that the area below the curve is G_F / length.
 *  @param[in] area  below the envelope from x = 0 to 1 */
static inline int softening_prepare(Softening *c, const double *values, double area, char *reason, size_t size)
{
  c->young = values[SOFTENING_YOUNG];
  c->strength = values[SOFTENING_STRENGTH];
  c->peak = c->strength / c->young;
  if (isnan(values[SOFTENING_LENGTH])) {
    snprintf(reason, size, "a fracture energy needs the 'length' over which it is spread");
    return 1;
  }
  double left = values[SOFTENING_ENERGY] / values[SOFTENING_LENGTH] - c->strength * c->peak / 2;
  c->end = c->peak + left / (c->strength * area);
  if (left > 0) return 0;
  snprintf(
      reason, size,
      "a length of %g, over which the fracture energy is spread, stores more than this energy at the peak, so that the "
      "curve would snap back; it must be "
      "less than 2 E G_F / f_t^2 = %g: take a finer spacing, if the units of these numbers are right",
      values[SOFTENING_LENGTH], 2 * values[SOFTENING_ENERGY] / (c->strength * c->peak));
  return 1;
}

/** Elastic energy per volume at the peak. The curve is the first member of all constants. */
static inline double softening_start(const void *constants)
{
  const Softening *c = constants;
  return c->strength * c->peak / 2;
}

/* Difference of two stresses, over the elastic stress, that is round-off. */
#define SOFTENING_TIE 1e-14

/** Updates a point strained beyond the peak: damage, if it grows, and stress and tangent then.
 *
 *  Where a point stands at its largest strain so far, as at the beginning of each increment at rest, stress by damage
 * and stress of the envelope are equal but for round-off. The tangent is that of loading there: if round-off chose
 * between loading and unloading, results at rest would depend on the units of the deck. */
__attribute__((always_inline)) static inline void softening_beyond(const void *constants, const Softening *c,
                                                                   SofteningEnvelope envelope,
                                                                   const breccia_batch *batch, int i)
{
  const double strain = batch->strain[0][i], unloading = batch->stress[0][i];
  double slope = 0, x = (strain - c->peak) / (c->end - c->peak);
  const double stress = x < 1 ? c->strength * envelope(constants, x, &slope) : 0;
  if (!(stress < unloading + SOFTENING_TIE * c->young * strain)) return;
  if (batch->tangent) batch->tangent[i] = x < 1 ? c->strength * slope / (c->end - c->peak) : 0;
  if (!(stress < unloading)) return;
  batch->trial[i] = x < 1 ? 1 - stress / (c->young * strain) : 1;
  batch->stress[0][i] = stress;
}

/* Four points at a time up to the peak. Signs of strains follow no rule that a processor could guess, so that branches cost more than the law;
 * and histories that are what they were are not written, as a bond takes most of its time to move them. */
__attribute__((always_inline)) static inline int
softening_update(const void *constants, const Softening *c, SofteningEnvelope envelope, const breccia_batch *batch)
{
  const Lanes young = lanes_set(c->young), one = lanes_set(1);
  const double peak = batch->elastic_stage ? INFINITY : c->peak, softened = batch->elastic_stage ? INFINITY : 0;
  int i = 0;
  for (; i + LANES <= batch->count; i += LANES) {
    const Lanes strain = lanes_load(batch->strain[0] + i), damage = lanes_load(batch->committed + i);
    const Lanes whole = lanes_choose(strain > lanes_set(softened), one - damage, one);
    const LaneMask beyond = strain > lanes_set(peak), stale = lanes_load(batch->trial + i) != damage;
    lanes_store(batch->stress[0] + i, young * strain * whole);
    if (batch->tangent) lanes_store(batch->tangent + i, young * whole);
    const LaneMask either = stale | beyond;
    if (!(either[0] | either[1] | either[2] | either[3])) continue;
    lanes_store(batch->trial + i, damage);
    for (int k = 0; k < LANES; ++k)
      if (beyond[k]) softening_beyond(constants, c, envelope, batch, i + k);
  }
  for (; i < batch->count; ++i) {
    const double strain = batch->strain[0][i], damage = batch->committed[i];
    const double whole = strain > softened ? 1 - damage : 1;
    batch->trial[i] = damage;
    batch->stress[0][i] = c->young * strain * whole;
    if (batch->tangent) batch->tangent[i] = c->young * whole;
    if (strain > peak) softening_beyond(constants, c, envelope, batch, i);
  }
  return -1;
}

static inline int softening_history_values(const void *constants)
{
  (void)constants;
  return 1;
}

static inline void softening_history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants, (void)k;
  snprintf(name, size, "bond damage");
}

static inline int softening_history_is_damage(const void *constants, int k)
{
  (void)constants;
  return k == 0;
}

#endif

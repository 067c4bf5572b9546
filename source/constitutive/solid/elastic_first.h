/* Points of laws whose stress follows from an elastic strain, four side by side: those that are surely elastic are done with at once, the
 * others go through the law one by one. Elastic points cost two to four times as much without it. */
#ifndef BRECCIA_CONSTITUTIVE_ELASTIC_FIRST_H
#define BRECCIA_CONSTITUTIVE_ELASTIC_FIRST_H

#include "base/lanes.h"
#include "constitutive/solid/solid_law.h"

/** Elastic trial of four points: first invariant, deviator and its norm, and their rows of history. */
typedef struct TrialLanes {
  Lanes invariant, s[6], length;
  const double *row[LANES];
} TrialLanes;

/** Number k of the four rows. */
LANES_INLINE Lanes trial_history(const TrialLanes *t, int k)
{
  return (Lanes){t->row[0][k], t->row[1][k], t->row[2][k], t->row[3][k]};
}

/** Bound of principal stresses, for points so far inside that no decomposition is needed: none is larger than a third of the invariant and
 *  2 r, the largest less the smallest no more than 2 sqrt(3) r. @return r = sqrt(J2 / 3) */
LANES_INLINE Lanes trial_radius(const TrialLanes *t)
{
  return t->length * lanes_set(1 / sqrt(6));
}

/** @param[out] found  the points that are inside their yield surface for sure; a point's answer must not depend on the points beside it. Returned through
 *  memory: without optimisation the call is a real one, from a function for another processor, which looks for vectors elsewhere */
typedef void (*SolidInside)(const void *constants, const TrialLanes *trial, LaneMask *found);

/** `update` of a law: solid_update with the sieve before it. To be called from a function with BRECCIA_CLONES.
 *  @param[in] plastic  whether history begins with the plastic strain; otherwise all strain is elastic */
LANES_INLINE int solid_update_elastic_first(const void *constants, const breccia_batch *batch, int history_values,
                                            const Elasticity *e, bool plastic, SolidInside inside,
                                            SolidPointUpdate update_point)
{
  const Lanes twice = lanes_set(2 * e->shear);
  for (int first = 0; first < batch->count; first += LANES) {
    const bool all = first + LANES <= batch->count;
    TrialLanes trial;
    int at[LANES];
    for (int l = 0; l < LANES; ++l) { /* beyond the end the last point stands in */
      at[l] = all || first + l < batch->count ? first + l : batch->count - 1;
      trial.row[l] = batch->committed + (ptrdiff_t)history_values * at[l];
    }
    Lanes strain[6], spent[6] = {twice, twice, twice, twice, twice, twice};
    if (plastic) {
      lanes_turn(lanes_load(trial.row[0]), lanes_load(trial.row[1]), lanes_load(trial.row[2]), lanes_load(trial.row[3]),
                 spent);
      for (int k = 4; k < 6; ++k) spent[k] = trial_history(&trial, k);
    }
    for (int k = 0; k < 6; ++k) {
      const double *from = batch->strain[k];
      strain[k] = all ? lanes_load(from + first) : (Lanes){from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
      if (k >= 3) strain[k] *= lanes_set(0.5);
      if (plastic) strain[k] -= spent[k];
    }
    const Lanes volume = strain[XX] + strain[YY] + strain[ZZ], mean = volume / lanes_set(3);
    for (int k = 0; k < 6; ++k) trial.s[k] = twice * (k < 3 ? strain[k] - mean : strain[k]);
    trial.invariant = lanes_set(3 * e->bulk) * volume;
    trial.length =
        lanes_root(trial.s[0] * trial.s[0] + trial.s[1] * trial.s[1] + trial.s[2] * trial.s[2] +
                   lanes_set(2) * (trial.s[3] * trial.s[3] + trial.s[4] * trial.s[4] + trial.s[5] * trial.s[5]));
    const Lanes size = trial.length + trial.invariant;
    LaneMask done = size - size == lanes_set(0); /* finite */
    if (!batch->elastic_stage) {
      LaneMask found;
      inside(constants, &trial, &found);
      done &= found;
    }
    const Lanes pressure = lanes_set(e->bulk) * volume;
    const bool whole = all && (done[0] & done[1] & done[2] & done[3]);
    for (int k = 0; k < 6; ++k) {
      const Lanes stress = k < 3 ? trial.s[k] + pressure : trial.s[k];
      if (whole)
        lanes_store(batch->stress[k] + first, stress);
      else
        for (int l = 0; l < LANES; ++l)
          if (done[l]) batch->stress[k][at[l]] = stress[l];
    }
    if (whole)
      memcpy(batch->trial + (ptrdiff_t)history_values * first, trial.row[0],
             sizeof(double) * LANES * (size_t)history_values);
    for (int l = 0; l < LANES && first + l < batch->count; ++l) {
      double *tangent = batch->tangent ? batch->tangent + 36 * at[l] : NULL;
      if (done[l]) {
        if (!whole)
          memcpy(batch->trial + (ptrdiff_t)history_values * at[l], trial.row[l],
                 sizeof(double) * (size_t)history_values);
        if (tangent) elastic_tangent(e, tangent);
      } else if (!solid_update_one(constants, batch, history_values, at[l], update_point)) {
        return at[l];
      }
    }
  }
  return -1;
}

#endif

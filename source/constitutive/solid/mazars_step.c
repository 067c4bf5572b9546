/* A step of Mazars' damage, a point a lane, for each kind of vectors (mazars.c tells the law). */
#include "constitutive/solid/dual.h"
#include "constitutive/solid/mazars.h"
#include "constitutive/solid/spectral.h"

/** Returns the equivalent strain. */
LANES_INLINE Lanes mazars_equivalent(const Lanes strain[3])
{
  Lanes square = lanes_set(0);
  for (int k = 0; k < 3; ++k) {
    const Lanes positive = lanes_where(strain[k] > lanes_set(0), strain[k]);
    square += positive * positive;
  }
  return lanes_root(square);
}

/** Returns B_t for the lengths of points; a length of 0 stands for the length of the law. A length for which the curve
 *  would snap back gives a curve that falls over a hundredth of the peak strain. */
LANES_INLINE Lanes mazars_rate(const Mazars *c, Lanes length)
{
  const double steepest = 0.01;
  const LaneMask known = length > lanes_set(0);
  const Lanes decay = lanes_set(c->opening) / lanes_choose(known, length, lanes_set(1)) - lanes_set(c->threshold / 2);
  return lanes_choose(known, lanes_set(1) / lanes_greatest(decay, lanes_set(steepest * c->threshold)),
                      lanes_set(c->tension_rate));
}

/** Computes principal stresses and damage from principal strains, which are the variables 0, 1 and 2.
 *  @param[in] rate  B_t */
LANES_INLINE void respond(DualSlopes n, const Mazars *c, Lanes rate, const Dual strain[3], const Lanes *committed,
                          Dual stress[3], Dual *largest, Dual *damage)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear,
               by_others = -lambda / (twice * (3 * lambda + twice));
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  const Dual volume = dual_add(n, dual_add(n, strain[0], strain[1]), strain[2]), across = dual_scale(n, lambda, volume);
  Dual square = dual_constant(zero), tension = dual_constant(zero), effective[3], positive[3];
  for (int k = 0; k < 3; ++k) {
    positive[k] = dual_positive(n, strain[k]);
    square = dual_add(n, square, dual_product(n, positive[k], positive[k]));
    effective[k] = dual_sum(n, across, twice, strain[k]);
    tension = dual_add(n, tension, dual_positive(n, effective[k]));
  }
  const Dual equivalent = dual_root(n, square);
  *largest = dual_choose(n, equivalent.value > committed[MAZARS_LARGEST], equivalent,
                         dual_constant(committed[MAZARS_LARGEST]));
  /* a_t: the strain that positive stresses make, against the equivalent strain: never below 0; above 1 where Poisson's ratio is negative. */
  Dual share = dual_constant(zero);
  const Dual beside = dual_scale(n, by_others, tension);
  for (int k = 0; k < 3; ++k) {
    const Dual by_tension = dual_sum(n, beside, 1 / twice, dual_positive(n, effective[k]));
    share = dual_add(n, share, dual_product(n, positive[k], by_tension));
  }
  const LaneMask strained = square.value > zero;
  share = dual_where(n, strained, dual_quotient(n, share, dual_choose(n, strained, square, dual_constant(one))));
  share = dual_choose(n, share.value > one, dual_constant(one), share);
  const Dual past = dual_shift(*largest, -c->threshold),
             relative = dual_quotient(n, dual_constant(lanes_set(c->threshold)), *largest);
  const Dual in_tension =
      dual_rest(n, dual_product(n, relative, dual_exponential(n, dual_product(n, dual_constant(-rate), past))));
  Dual in_compression =
      dual_rest(n, dual_sum(n, dual_scale(n, 1 - c->compression_share, relative), c->compression_share,
                            dual_exponential(n, dual_scale(n, -c->compression_rate, past))));
  in_compression = dual_positive(n, in_compression);
  in_compression = dual_choose(n, in_compression.value > one, dual_constant(one), in_compression);
  const Dual found = dual_add(n, in_compression, dual_product(n, share, dual_sum(n, in_tension, -1, in_compression)));
  *damage = dual_constant(committed[MAZARS_DAMAGE]);
  *damage = dual_choose(n, (largest->value > lanes_set(c->threshold)) & (found.value > damage->value), found, *damage);
  const Dual whole = dual_rest(n, *damage);
  for (int k = 0; k < 3; ++k) stress[k] = dual_product(n, whole, effective[k]);
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  const Mazars *c = constants;
  const DualSlopes n = {0, tangents ? 3 : 0};
  const SpectrumApart apart = spectrum_apart(p->strain);
  Spectrum spectrum;
  if (tangents)
    spectrum = spectrum_with_vectors(&apart);
  else
    spectrum_values(&apart, spectrum.value);
  Dual strain[3], stress[3], largest, damage;
  const LaneMask begins = mazars_equivalent(spectrum.value) > lanes_set(c->threshold);
  const Lanes length = normal_lengths_choose(
      &c->lengths, &apart, begins, p->committed[MAZARS_LARGEST] > lanes_set(c->threshold), p->committed[MAZARS_LENGTH]);
  for (int k = 0; k < 3; ++k) strain[k] = dual_variable(spectrum.value[k], k);
  respond(n, c, mazars_rate(c, p->committed[MAZARS_LENGTH]), strain, p->committed, stress, &largest, &damage);
  p->trial[MAZARS_LENGTH] = length;
  p->trial[MAZARS_LARGEST] = largest.value;
  p->trial[MAZARS_DAMAGE] = damage.value;
  /* Stress follows the strain itself, so that nothing is lost to the decomposition. */
  elastic_stress_lanes(&c->elastic, p->strain, p->stress);
  for (int k = 0; k < 6; ++k) p->stress[k] *= lanes_set(1) - damage.value;
  if (!tangents) return;
  Lanes value[3], slopes[9], tangent[36];
  for (int k = 0; k < 3; ++k) {
    value[k] = stress[k].value;
    for (int m = 0; m < 3; ++m) slopes[3 * k + m] = stress[k].slope[m];
  }
  spectral_tangent(&spectrum, value, slopes, tangent);
  store_tangents(tangent, p->tangent);
}

/** Points that were never damaged and whose strains, all together, are less than what damages. */
LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const Mazars *c = constants;
  const Lanes square = trial_strain_square(&c->elastic, t);
  *found = (history[MAZARS_LARGEST] <= lanes_set(c->threshold)) & (history[MAZARS_LENGTH] <= lanes_set(0)) &
           (square <= lanes_set(c->threshold * c->threshold));
}

int LANES_NAMED(mazars_update)(const void *constants, const breccia_batch *batch)
{
  const Mazars *c = constants;
  return solid_update_lanes(constants, batch, MAZARS_HISTORY, &c->elastic, false, inside, step, NULL);
}

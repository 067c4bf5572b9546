/* A step of damage by stretch at points in space, a point a lane, for each kind of vectors (link_damage.c tells the law). */
#include "constitutive/link_damage.h"
#include "constitutive/solid/dual.h"
#include "constitutive/solid/link_law.h"
#include "constitutive/solid/spectral.h"

/** Returns the tension curve of a point that spreads the fracture energy over a length; 0: over the length of the law.
 *  A length for which the force would snap back gives a curve that falls within a hundredth of the peak stretch. */
LANES_INLINE LinkCurve link_curve_over(const LinkLaw *c, double length)
{
  const double shortest = 1.01;
  breccia_link link = c->link;
  if (length > 0) {
    const double straight = fmax(c->straight / length, shortest * link.tension_begin / c->first_share);
    const double first = c->first_share, kink = link.tension_kink;
    link.tension_first_end = first < 1 ? first * straight : 0;
    link.tension_end = first < 1 ? (1 - (1 - kink) * first) / kink * straight : straight;
  }
  return link_in_tension(&link);
}

/* One lane after the other: links ask the same function (formulation/micropolar_damage). */
LANES_INLINE Dual damage_of(DualSlopes n, Dual stretch, const LinkLaw *c, const Lanes *length)
{
  double value[LANES], slope[LANES], over[LANES];
  LinkCurve curve = length ? link_in_tension(&c->link) : link_in_compression(&c->link);
  lanes_store(value, stretch.value);
  lanes_store(over, length ? *length : lanes_set(0));
  for (int l = 0; l < LANES; ++l) {
    const LinkCurve own = over[l] > 0 ? link_curve_over(c, over[l]) : curve;
    slope[l] = n.end > n.first ? link_damage_slope(value[l], &own) : 0;
    value[l] = link_damage(value[l], &own);
  }
  return dual_of(n, lanes_load(value), lanes_load(slope), stretch);
}

/** Principal stresses of a material without tensile strength (Del Piero 1989): directions open, the most stretched
 * first, until no principal stress is positive. The stresses are the derivatives of a convex energy, half of their
 * product with the strains.
 *  @param[in] strain  principal strains in descending order
 *  @param[in] effective  principal stresses of C strain */
LANES_INLINE void find_closed_stress(DualSlopes n, const ClosedModuli *c, const Dual strain[3], const Dual effective[3],
                                     Dual closed[3])
{
  const Lanes zero = lanes_set(0);
  const Dual none = dual_constant(zero), middle = dual_sum(n, dual_scale(n, c->plane, strain[1]), c->across, strain[2]),
             least = dual_sum(n, dual_scale(n, c->plane, strain[2]), c->across, strain[1]),
             alone = dual_scale(n, c->young, dual_choose(n, strain[2].value < zero, strain[2], none));
  const LaneMask first = effective[0].value > zero, second = first & (middle.value > zero);
  closed[0] = dual_choose(n, first, none, effective[0]);
  closed[1] = dual_choose(n, second, none, dual_choose(n, first, middle, effective[1]));
  closed[2] = dual_choose(n, second, alone, dual_choose(n, first, least, effective[2]));
}

/** Finds trial damage, and what it leaves of the stresses C strain and of those of closed cracks. The latter is
 *    (1 - D_c) D_t s (a - m) / a,  m = max(min(m committed, a), (1 - q) a),
 *  a the size of the strain of closed cracks and q = <pressure - tension> / (pressure + tension) of the principal
 *  stresses of C strain.
 *  @param[in] strain  principal strains in descending order, the variables 0, 1, 2
 *  @param[in] length  length over which points spread the fracture energy; 0: the length of the law
 *  @param[out] trial  history except the length
 *  @param[out] rest  factors of C strain and of the closed stresses */
LANES_INLINE void find_rest(DualSlopes n, const LinkLaw *c, const Lanes *committed, Lanes length, const Dual strain[3],
                            const Dual effective[3], const Dual closed[3], Lanes trial[LINK_HISTORY], Dual rest[2])
{
  const breccia_link *l = &c->link;
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  Dual most = dual_constant(zero), least = dual_constant(zero), pressure = dual_constant(zero),
       all = dual_constant(zero), square = dual_constant(zero);
  for (int k = 0; k < 3; ++k) {
    most = dual_larger(n, strain[k], most);
    least = dual_larger(n, dual_scale(n, -1, strain[k]), least);
    pressure = dual_sum(n, pressure, -1, effective[k]);
    all = dual_add(n, all, dual_absolute(n, effective[k]));
    square = dual_sum(n, square, c->closed.by_young, dual_product(n, closed[k], strain[k]));
  }
  Dual d[2] = {damage_of(n, most, c, &length), damage_of(n, least, c, NULL)};
  const LaneMask beside = (d[LINK_TENSILE].value > zero) | (committed[LINK_TENSILE] > zero);
  d[LINK_COMPRESSIVE] = dual_where(n, beside, d[LINK_COMPRESSIVE]);
  for (int k = 0; k < 2; ++k) {
    d[k] = dual_choose(n, d[k].value > committed[k], d[k], dual_constant(committed[k]));
    trial[k] = d[k].value;
  }
  const LaneMask pressed = pressure.value > zero;
  const Dual share = dual_rest(
      n, dual_where(n, pressed, dual_quotient(n, pressure, dual_choose(n, pressed, all, dual_constant(one)))));
  const Dual size = dual_root(n, dual_positive(n, square));
  const LaneMask sized = size.value > committed[LINK_CLOSING_OFFSET];
  const Dual before = dual_choose(
      n, sized,
      dual_quotient(n, dual_constant(committed[LINK_CLOSING_OFFSET]), dual_choose(n, sized, size, dual_constant(one))),
      dual_constant(one));
  const Dual offset = dual_larger(n, share, before);
  trial[LINK_CLOSING_OFFSET] = lanes_where(trial[LINK_TENSILE] > zero, lanes_product(offset.value, size.value));
  const Dual uncrushed = dual_rest(n, d[LINK_COMPRESSIVE]);
  rest[0] = dual_product(n, dual_rest(n, d[LINK_TENSILE]), uncrushed);
  rest[1] =
      dual_product(n, dual_scale(n, l->recovery, dual_product(n, d[LINK_TENSILE], dual_rest(n, offset))), uncrushed);
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  const LinkLaw *c = constants;
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const DualSlopes n = {0, tangents ? 3 : 0};
  const SpectrumApart apart = spectrum_apart(p->strain);
  const SpectrumParts parts = spectrum_parts(&apart);
  Dual strain[3], effective[3], closed[3], stress[3], rest[2];
  Lanes value[3], slopes[9], tangent[36], whole[6], recovered[6];
  for (int k = 0; k < 3; ++k) strain[k] = dual_variable(parts.value[k], k);
  const Dual volume = dual_add(n, dual_add(n, strain[0], strain[1]), strain[2]);
  for (int k = 0; k < 3; ++k) effective[k] = dual_sum(n, dual_scale(n, lambda, volume), twice, strain[k]);
  find_closed_stress(n, &c->closed, strain, effective, closed);
  const LaneMask begins = parts.value[0] > lanes_set(c->link.tension_begin);
  const Lanes length = normal_lengths_choose(&c->lengths, &apart, begins, p->committed[LINK_TENSILE] > lanes_set(0),
                                             p->committed[LINK_LENGTH]);
  find_rest(n, c, p->committed, p->committed[LINK_LENGTH], strain, effective, closed, p->trial, rest);
  p->trial[LINK_LENGTH] = length;
  for (int k = 0; k < 3; ++k) {
    closed[k] = dual_product(n, rest[1], closed[k]);
    value[k] = closed[k].value;
  }
  /* What is left of C strain follows the strain itself: nothing is lost to the decomposition. */
  elastic_stress_lanes(&c->elastic, p->strain, whole);
  spectral_tensor_of_parts(&parts, value, recovered);
  for (int k = 0; k < 6; ++k)
    p->stress[k] = lanes_product(whole[k], rest[0].value) + lanes_where(rest[1].value > lanes_set(0), recovered[k]);
  if (!tangents) return;
  const Spectrum spectrum = spectrum_with_vectors(&apart);
  for (int k = 0; k < 3; ++k) {
    stress[k] = dual_add(n, dual_product(n, rest[0], effective[k]), closed[k]);
    value[k] = stress[k].value;
    for (int m = 0; m < 3; ++m) slopes[3 * k + m] = stress[k].slope[m];
  }
  spectral_tangent(&spectrum, value, slopes, tangent);
  store_tangents(tangent, p->tangent);
}

/** Points that were never damaged and whose strains, all together, are less than what damages. */
LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const LinkLaw *c = constants;
  const Lanes square = trial_strain_square(&c->elastic, t);
  /* Damage in compression grows only where there is damage in tension. */
  *found = (history[LINK_TENSILE] <= lanes_set(0)) & (history[LINK_LENGTH] <= lanes_set(0)) &
           (square <= lanes_set(c->link.tension_begin * c->link.tension_begin));
}

int LANES_NAMED(link_damage_update)(const void *constants, const breccia_batch *batch)
{
  const LinkLaw *c = constants;
  return solid_update_lanes(constants, batch, LINK_HISTORY, &c->elastic, false, inside, step, NULL);
}

/* A step of Mohr-Coulomb plasticity, a point a lane, for each kind of vectors (mohr_coulomb.c tells the law). */
#include "constitutive/solid/mohr_coulomb.h"
#include "constitutive/solid/spectral.h"

/** How far principal stresses are beyond the planes. */
LANES_INLINE void excess_of(const MohrCoulomb *c, const Lanes s[3], Lanes excess[PLANES])
{
  static const int larger[3] = {0, 0, 1}, smaller[3] = {2, 1, 2};
  for (int k = 0; k < 3; ++k) {
    excess[SHEAR13 + k] =
        lanes_cross(lanes_set(1 + c->sine), s[larger[k]], lanes_set(1 - c->sine), s[smaller[k]]) - lanes_set(c->limit);
    excess[TENSION1 + k] = s[k] - lanes_set(c->tensile);
  }
}

/** Returns sorted trial stresses to the first set of planes whose multipliers and stress are admissible; where more planes meet than a set names, to the
 *  nearest admissible corner. @param[out] which  set; where there is none the stress is no number */
LANES_INLINE void return_stress(const MohrCoulomb *c, const Lanes trial[3], const Lanes excess[PLANES],
                                LaneMask elastic, Lanes stress[3], LaneMask *which)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const Lanes scale = lanes_absolute(trial[0]) + lanes_absolute(trial[2]) + lanes_set(c->limit),
              tolerance = lanes_product(lanes_set(1e-13), scale), least_push = lanes_set(-1e-13 / twice) * scale;
  Lanes corner[3], nearest = lanes_set(INFINITY);
  LaneMask found = elastic, corner_set = {0};
  *which = (LaneMask){0};
  for (int k = 0; k < 3; ++k) {
    stress[k] = trial[k];
    corner[k] = lanes_set(NAN);
  }
  for (int set = 0; set < COULOMB_SETS; ++set) {
    const CoulombReturn *r = &c->returns[set];
    if (!r->exists) continue;
    Lanes tried[3] = {trial[0], trial[1], trial[2]}, least = lanes_set(INFINITY), beyond[PLANES];
    Lanes multiplier[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
    for (int k = 0; k < PLANES; ++k) beyond[k] = excess[k];
    for (int turn = 0; turn < 2;
         ++turn) { /* once more for roundings of the inverse, which are large where volumes hardly change */
      for (int n = 0; n < 3; ++n) {
        const Lanes more = lanes_dot(lanes_set(r->inverse[n][0]), beyond[r->plane[0]], lanes_set(r->inverse[n][1]),
                                     beyond[r->plane[1]], lanes_set(r->inverse[n][2]), beyond[r->plane[2]]);
        multiplier[n] += more;
        for (int k = 0; k < 3; ++k) tried[k] -= more * lanes_set(r->stiff_flow[n][k]);
      }
      excess_of(c, tried, beyond);
    }
    for (int n = 0; n < 3; ++n) least = lanes_least(least, multiplier[n]);
    const LaneMask admissible = (tried[0] >= tried[1] - tolerance) & (tried[1] >= tried[2] - tolerance) &
                                (beyond[SHEAR13] <= tolerance) & (beyond[TENSION1] <= tolerance) & ~found,
                   good = admissible & (least >= least_push), number = (LaneMask){0} + set;
    found |= good;
    *which = (*which & ~good) | (number & good);
    for (int k = 0; k < 3; ++k) stress[k] = lanes_choose(good, tried[k], stress[k]);
    if (!lanes_any(~found)) break;
    if (!r->corner) continue;
    const Lanes off[3] = {trial[0] - tried[0], trial[1] - tried[1], trial[2] - tried[2]},
                sum = off[0] + off[1] + off[2],
                distance = lanes_cross(lanes_set(1 / twice), lanes_square(off[0], off[1], off[2]),
                                       lanes_set(lambda / (twice * (3 * lambda + twice))), sum * sum);
    const LaneMask nearer = admissible & ~good & (distance < nearest);
    nearest = lanes_choose(nearer, distance, nearest);
    corner_set = (corner_set & ~nearer) | (number & nearer);
    for (int k = 0; k < 3; ++k) corner[k] = lanes_choose(nearer, tried[k], corner[k]);
  }
  *which = (*which & found) | (corner_set & ~found);
  for (int k = 0; k < 3; ++k) stress[k] = lanes_choose(found, stress[k], corner[k]);
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  const MohrCoulomb *c = constants;
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  Lanes elastic[6], within[6], returned[6], plastic[6], trial[3], stress[3], excess[PLANES];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
  const Spectrum strain = spectrum_of(elastic);
  const Lanes volume = lanes_product(lanes_set(lambda), lanes_trace(elastic));
  for (int k = 0; k < 3; ++k) trial[k] = volume + lanes_set(twice) * strain.value[k];
  excess_of(c, trial, excess);
  const LaneMask stays = (excess[SHEAR13] <= lanes_set(0)) & (excess[TENSION1] <= lanes_set(0));
  LaneMask which;
  return_stress(c, trial, excess, stays, stress, &which);
  elastic_stress_lanes(&c->elastic, elastic, within);
  spectral_tensor(&strain, stress, returned);
  for (int k = 0; k < 6; ++k) p->stress[k] = lanes_choose(stays, within[k], returned[k]);
  plastic_strain_lanes(&c->elastic, p->strain, returned, plastic);
  for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(stays, p->committed[k], plastic[k]);
  if (!tangents) return;
  double numbers[9][LANES];
  Lanes slopes[9], tangent[36];
  for (int l = 0; l < LANES; ++l)
    for (int k = 0; k < 9; ++k) numbers[k][l] = c->returns[which[l]].slopes[k];
  for (int k = 0; k < 9; ++k) slopes[k] = lanes_load(numbers[k]);
  spectral_tangent(&strain, stress, slopes, tangent);
  store_tangents(tangent, p->tangent);
  for (int l = 0; l < LANES; ++l)
    if (stays[l]) elastic_tangent(&c->elastic, p->tangent[l]);
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const MohrCoulomb *c = constants;
  const Lanes radius = trial_radius(t), mean = lanes_product(t->invariant, lanes_set(1.0 / 3)), two = lanes_set(2);
  *found =
      (two * (lanes_product(radius, lanes_set(sqrt(3) + c->sine)) + mean * lanes_set(c->sine)) <= lanes_set(c->limit)) &
      (mean + two * radius <= lanes_set(c->tensile));
}

int LANES_NAMED(mohr_coulomb_update)(const void *constants, const breccia_batch *batch)
{
  const MohrCoulomb *c = constants;
  return solid_update_lanes(constants, batch, COULOMB_HISTORY, &c->elastic, true, inside, step);
}

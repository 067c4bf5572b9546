/* A step of Mohr-Coulomb plasticity, a point a lane, for each kind of vectors (mohr_coulomb.c tells the law). */
#include "constitutive/solid/mohr_coulomb.h"
#include "constitutive/solid/spectral.h"

/** How far principal stresses are beyond a plane. @param[in] plane  a constant */
LANES_INLINE Lanes excess_of(const MohrCoulomb *c, const Lanes s[3], int plane)
{
  if (plane >= TENSION1) return s[plane - TENSION1] - lanes_set(c->tensile);
  const int larger = plane == SHEAR23, smaller = plane == SHEAR12 ? 1 : 2;
  return lanes_cross(lanes_set(1 + c->sine), s[larger], lanes_set(1 - c->sine), s[smaller]) - lanes_set(c->limit);
}

/** The first admissible stress that is found, and the set of planes on which it lies. */
typedef struct Return {
  Lanes stress[3], tolerance;
  LaneMask found, which;
} Return;

/** Whether a set names a plane. All are constants. */
LANES_INLINE bool names_plane(const PlaneSet *set, int plane)
{
  bool named = false;
  for (int n = 0; n < set->count; ++n) named |= set->plane[n] == plane;
  return named;
}

/** Returns sorted trial stresses that have not found their set to this one. What must not be negative is compared at once: multipliers, what the order of stresses leaves, and the planes that the
 *  set does not name. @param[in] number  of the set: a constant */
LANES_INLINE void try_set(const MohrCoulomb *c, int number, const Lanes trial[3], Return *out)
{
  const PlaneSet *set = &coulomb_sets[number];
  const CoulombReturn *r = &c->returns[number];
  const bool corner = set->count == 3;
  Lanes tried[3] = {trial[0], trial[1], trial[2]}, multiplier[3], beyond[3];
  /* Once more for roundings of the inverse, which are large where volumes hardly change. A corner is known. */
  for (int turn = 0; turn < (corner ? 1 : 2); ++turn) {
    for (int n = 0; n < set->count; ++n) beyond[n] = excess_of(c, tried, set->plane[n]);
    for (int n = 0; n < set->count; ++n) {
      Lanes more = lanes_product(lanes_set(r->inverse[n][0]), beyond[0]);
      for (int k = 1; k < set->count; ++k) more += lanes_set(r->inverse[n][k]) * beyond[k];
      multiplier[n] = turn ? multiplier[n] + more : more;
      for (int k = 0; k < 3 && !corner; ++k) tried[k] -= more * lanes_set(r->stiff_flow[n][k]);
    }
  }
  Lanes least = multiplier[0];
  for (int n = 1; n < set->count; ++n) least = lanes_least(least, multiplier[n]);
  for (int k = 0; k < 3 && corner; ++k) tried[k] = lanes_set(r->corner[k]);
  for (int k = 0; k < 2 && !corner; ++k) least = lanes_least(least, tried[k] - tried[k + 1]);
  if (!names_plane(set, SHEAR13)) least = lanes_least(least, -excess_of(c, tried, SHEAR13));
  if (!names_plane(set, TENSION1)) least = lanes_least(least, -excess_of(c, tried, TENSION1));
  const LaneMask good = (least >= -out->tolerance) & ~out->found, numbers = (LaneMask){0} + number;
  out->found |= good;
  out->which = (out->which & ~good) | (numbers & good);
  for (int k = 0; k < 3; ++k) out->stress[k] = lanes_choose(good, tried[k], out->stress[k]);
}

/** The nearest corner, by the energy of what is taken off, of stresses that have found no set. */
LANES_INLINE void take_nearest_corner(const MohrCoulomb *c, const Lanes trial[3], Return *out)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  Lanes nearest = lanes_set(INFINITY);
  for (int k = 0; k < 3; ++k) out->stress[k] = lanes_choose(out->found, out->stress[k], lanes_set(NAN));
  for (int set = 0; set < COULOMB_SETS; ++set) {
    const CoulombReturn *r = &c->returns[set];
    if (coulomb_sets[set].count < 3 || !r->exists) continue;
    Lanes off[3];
    for (int k = 0; k < 3; ++k) off[k] = trial[k] - lanes_set(r->corner[k]);
    const Lanes sum = off[0] + off[1] + off[2],
                distance = lanes_cross(lanes_set(1 / twice), lanes_square(off[0], off[1], off[2]),
                                       lanes_set(lambda / (twice * (3 * lambda + twice))), sum * sum);
    const LaneMask nearer = ~out->found & (distance < nearest), numbers = (LaneMask){0} + set;
    nearest = lanes_choose(nearer, distance, nearest);
    out->which = (out->which & ~nearer) | (numbers & nearer);
    for (int k = 0; k < 3; ++k) out->stress[k] = lanes_choose(nearer, lanes_set(r->corner[k]), out->stress[k]);
  }
}

/** Returns sorted trial stresses to the first set of planes whose multipliers and stress are admissible; where more planes meet than a set names, to the
 *  nearest corner. Where there is none the stress is no number. */
LANES_INLINE Return return_stress(const MohrCoulomb *c, const Lanes trial[3], LaneMask elastic)
{
  Return out = {.found = elastic};
  out.tolerance =
      lanes_product(lanes_set(1e-13), lanes_absolute(trial[0]) + lanes_absolute(trial[2]) + lanes_set(c->limit));
  for (int k = 0; k < 3; ++k) out.stress[k] = trial[k];
  _Pragma("GCC unroll 9") for (int set = 0; set < COULOMB_SETS; ++set)
  {
    if (!c->returns[set].exists) continue;
    try_set(c, set, trial, &out);
    if (!lanes_any(~out.found)) return out;
  }
  take_nearest_corner(c, trial, &out);
  return out;
}

LANES_INLINE void steps(const void *constants, SolidLanes *points, int groups, bool tangents)
{
  const MohrCoulomb *c = constants;
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  SpectrumApart apart[SOLID_GROUPS];
  SpectrumParts parts[SOLID_GROUPS];
  for (int g = 0; g < groups; ++g) {
    Lanes elastic[6];
    for (int k = 0; k < 6; ++k) elastic[k] = points[g].strain[k] - points[g].committed[k];
    apart[g] = spectrum_apart(elastic);
    parts[g] = spectrum_parts(&apart[g]);
  }
  for (int g = 0; g < groups; ++g) {
    SolidLanes *p = &points[g];
    Lanes elastic[6], within[6], returned[6], plastic[6], trial[3];
    for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
    const Lanes volume = lanes_product(lanes_set(lambda), lanes_trace(elastic));
    for (int k = 0; k < 3; ++k) trial[k] = volume + lanes_set(twice) * parts[g].value[k];
    const LaneMask stays =
        (excess_of(c, trial, SHEAR13) <= lanes_set(0)) & (excess_of(c, trial, TENSION1) <= lanes_set(0));
    const Return found = return_stress(c, trial, stays);
    elastic_stress_lanes(&c->elastic, elastic, within);
    spectral_tensor_of_parts(&parts[g], found.stress, returned);
    for (int k = 0; k < 6; ++k) p->stress[k] = lanes_choose(stays, within[k], returned[k]);
    plastic_strain_lanes(&c->elastic, p->strain, returned, plastic);
    for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(stays, p->committed[k], plastic[k]);
    if (!tangents) continue;
    const Spectrum strain = spectrum_with_vectors(&apart[g]);
    double numbers[9][LANES];
    Lanes slopes[9], tangent[36];
    for (int l = 0; l < LANES; ++l)
      for (int k = 0; k < 9; ++k) numbers[k][l] = c->returns[found.which[l]].slopes[k];
    for (int k = 0; k < 9; ++k) slopes[k] = lanes_load(numbers[k]);
    spectral_tangent(&strain, found.stress, slopes, tangent);
    store_tangents(tangent, p->tangent);
    for (int l = 0; l < LANES; ++l)
      if (stays[l]) elastic_tangent(&c->elastic, p->tangent[l]);
  }
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  (void)history;
  const MohrCoulomb *c = constants;
  const Lanes radius = trial_radius(t), mean = lanes_product(t->invariant, lanes_set(1.0 / 3)), two = lanes_set(2);
  *found =
      (two * (lanes_product(radius, lanes_set(sqrt(3) + c->sine)) + mean * lanes_set(c->sine)) <= lanes_set(c->limit)) &
      (mean + two * radius <= lanes_set(c->tensile));
}

int LANES_NAMED(mohr_coulomb_update)(const void *constants, const breccia_batch *batch)
{
  const MohrCoulomb *c = constants;
  return solid_update_lanes(constants, batch, COULOMB_HISTORY, &c->elastic, true, inside, NULL, steps);
}

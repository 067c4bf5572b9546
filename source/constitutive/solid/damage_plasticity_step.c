/* A step of the plastic-damage model of concrete, a point a lane, for each kind of vectors (damage_plasticity.c tells the law).
 *
 * The flow keeps the direction of the trial deviator, and all else follows from the share r of it that is left: q + 3 G dl q / sqrt(e^2 + q^2) = q_trial
 * with q = r q_trial says the multiplier dl, and F = 0 is one equation in r. */
#include "constitutive/solid/damage_plasticity.h"
#include "constitutive/solid/dual.h"
#include "constitutive/solid/spectral.h"

enum { LEFT = 3 }; /* the variable r; trial principal stresses are 0 to 2 */

/** Trial principal stresses, whatever flows. */
typedef struct Trial {
  Dual sum, deviator[3], q;
} Trial;

/** Where the flow leads that leaves a share of the trial deviator: principal effective stresses, plastic strains in tension and compression, F, and the
 *  share of tension in the stresses. */
typedef struct Flow {
  Dual stress[3], tension, compression, excess, share, multiplier;
} Flow;

LANES_INLINE Trial trial_of(DualSlopes n, const Lanes principal[3])
{
  Trial t;
  Dual square = dual_constant(lanes_set(0));
  t.sum = dual_variable(principal[0], 0);
  for (int k = 1; k < 3; ++k) t.sum = dual_add(n, t.sum, dual_variable(principal[k], k));
  for (int k = 0; k < 3; ++k) {
    t.deviator[k] = dual_sum(n, dual_variable(principal[k], k), -1.0 / 3, t.sum);
    square = dual_sum(n, square, 1.5, dual_product(n, t.deviator[k], t.deviator[k]));
  }
  t.q = dual_root(n, square);
  return t;
}

/** The curve of tension over plastic strain, to a power: c^share. @param[in] tail  whether it has one: a constant */
LANES_INLINE Dual remaining(DualSlopes n, const DamagePlasticity *c, bool tail, Dual plastic, double share)
{
  Dual power = dual_scale(n, -c->tension_rate * share, plastic);
  if (tail) {
    const Dual quick = dual_exponential(n, dual_scale(n, -c->tension_rate * c->steeper, plastic)),
               both = dual_shift(dual_scale(n, 1 - c->tail, quick), c->tail);
    power = dual_sum(n, power, share, dual_logarithm(n, both));
  }
  return dual_exponential(n, power);
}

LANES_INLINE Flow flow_by(DualSlopes n, const DamagePlasticity *c, bool tail, const Trial *t, Lanes left,
                          const Lanes *committed)
{
  Flow f;
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  const double half = 1 / (2 * c->elastic.shear), third = 1 / (3 * c->elastic.shear);
  const Dual q = dual_times_variable(n, t->q, left, LEFT);
  const Lanes root = lanes_root(lanes_set(c->rounding * c->rounding) + q.value * q.value), inverse = one / left;
  const Dual steep = dual_of(n, root, q.value / root, q);
  Dual over = dual_constant((inverse - one) * lanes_set(third));
  over.slope[LEFT] = -inverse * inverse * lanes_set(third);
  f.multiplier = dual_product(n, over, steep);
  const Dual whole = dual_sum(n, t->sum, -3 * c->elastic.bulk * c->dilation, f.multiplier);
  Dual positive = dual_constant(zero), all = dual_constant(zero);
  for (int k = 0; k < 3; ++k) {
    f.stress[k] = dual_sum(n, dual_times_variable(n, t->deviator[k], left, LEFT), 1.0 / 3, whole);
    positive = dual_add(n, positive, dual_positive(n, f.stress[k]));
    all = dual_add(n, all, dual_absolute(n, f.stress[k]));
  }
  const LaneMask stressed = all.value > zero;
  f.share = dual_where(n, stressed, dual_quotient(n, positive, dual_choose(n, stressed, all, dual_constant(one))));
  /* Plastic strain increments: (1 - r) s_trial / 2G + dl tan(psi) / 3. */
  Dual gone = dual_constant((one - left) * lanes_set(half));
  gone.slope[LEFT] = lanes_set(-half);
  const Dual dilated = dual_scale(n, c->dilation / 3, f.multiplier),
             largest = dual_add(n, dual_product(n, gone, t->deviator[0]), dilated),
             least = dual_add(n, dual_product(n, gone, t->deviator[2]), dilated);
  f.tension = dual_product(n, f.share, dual_positive(n, largest));
  f.tension.value += committed[PLASTIC_IN_TENSION];
  f.compression = dual_product(n, dual_rest(n, f.share), dual_positive(n, dual_scale(n, -1, least)));
  f.compression.value += committed[PLASTIC_IN_COMPRESSION];
  const double b = c->compression_rate, m = c->compression_share;
  Dual strength = dual_scale(n, c->tension, remaining(n, c, tail, f.tension, 1 - c->tension_share));
  strength =
      dual_larger(n, strength, dual_constant(lanes_set(1e-9 * c->tension))); /* a crack cannot carry, but divides */
  const Dual rise = dual_exponential(n, dual_scale(n, -b * (1 - m), f.compression)),
             fall = dual_exponential(n, dual_scale(n, -b * (2 - m), f.compression));
  Dual cohesion = dual_sum(n, dual_scale(n, c->compression * (1 + c->hump), rise), -c->compression * c->hump, fall);
  cohesion = dual_larger(n, cohesion, dual_constant(lanes_set(1e-9 * c->compression)));
  const Dual beta = dual_shift(dual_scale(n, 1 - c->alpha, dual_quotient(n, cohesion, strength)), -(1 + c->alpha)),
             pulled = dual_positive(n, f.stress[0]), pressed = dual_positive(n, dual_scale(n, -1, f.stress[0]));
  Dual excess = dual_add(n, dual_sum(n, q, c->alpha, whole), dual_product(n, beta, pulled));
  excess = dual_scale(n, 1 / (1 - c->alpha), dual_sum(n, excess, -c->gamma, pressed));
  f.excess = dual_sum(n, excess, -1, cohesion);
  return f;
}

/** 1 - D of a state. */
LANES_INLINE Dual wholeness(DualSlopes n, const DamagePlasticity *c, bool tail, const Flow *f)
{
  const Dual tension = remaining(n, c, tail, f->tension, c->tension_share),
             compression =
                 dual_exponential(n, dual_scale(n, -c->compression_rate * c->compression_share, f->compression));
  return dual_product(n, compression, dual_rest(n, dual_product(n, f->share, dual_rest(n, tension))));
}

/** The share at which F vanishes, by Newton's method in a bracket; 1 of points that are elastic. F is negative where nothing is left, because the flow
 *  dilates. NaN: there is none. @param[out] flow  there, values only */
LANES_INLINE Lanes find_left(const DamagePlasticity *c, bool tail, const Lanes principal[3], const Trial *t,
                             const Lanes *committed, Flow *flow, LaneMask *plastic)
{
  enum { MOST_ITERATIONS = 400 };
  const DualSlopes to_left = {LEFT, LEFT + 1};
  const Lanes one = lanes_set(1), half = lanes_set(0.5), triple = lanes_set(3 * c->elastic.shear),
              noise = lanes_set(1e-14 * c->compression) +
                      lanes_set(4e-16) * lanes_greatest(lanes_absolute(principal[0]), lanes_absolute(principal[2])),
              longest = lanes_greatest(t->q.value, lanes_set(1e-100 * c->compression));
  Lanes left = one, low = lanes_set(0), high = one, before = lanes_set(INFINITY);
  LaneMask ended = {0}, bracketed = {0};
  for (int iteration = 0; iteration < MOST_ITERATIONS; ++iteration) {
    *flow = flow_by(to_left, c, tail, t, left, committed);
    const Lanes gap = flow->excess.value, slope = flow->excess.slope[LEFT];
    if (iteration == 0) {
      *plastic = gap > lanes_set(1e-12 * c->compression);
      ended = ~*plastic;
    }
    const LaneMask beyond = gap > lanes_set(0);
    high = lanes_choose(beyond, left, high);
    low = lanes_choose(beyond, low, left);
    bracketed |= ~beyond;
    ended |= (lanes_absolute(gap) <= noise) | (high - low <= lanes_set(4e-16) * high);
    if (!lanes_any(~ended)) break;
    /* Newton's step in the multiplier, and three bounds from below of what it leaves: the first one of second order, the others right where the rounding of
     * the potential's tip is nothing, and where it is all. */
    const Lanes step = gap / slope, wanted = triple * (flow->multiplier.value - step * flow->multiplier.slope[LEFT]);
    Lanes next = lanes_greatest(left - step, (t->q.value - wanted) / longest);
    next = lanes_greatest(next, one / (one + wanted * lanes_set(1 / c->rounding)));
    const LaneMask inside = (slope > lanes_set(0)) & (next > low) & (next < high),
                   good = inside & (~bracketed | (lanes_absolute(next - left) <= half * before));
    next = lanes_choose(good, next, half * (low + high));
    before = lanes_choose(bracketed, lanes_absolute(next - left), before);
    ended |= next == left;
    left = lanes_choose(ended, left, next);
  }
  return lanes_choose(ended, left, lanes_set(NAN));
}

LANES_INLINE void step_along(const DamagePlasticity *c, SolidLanes *p, bool tail, bool tangents)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const DualSlopes none = {0, 0}, every = {0, LEFT + 1};
  Lanes elastic[6], effective[6], returned[6], principal[3], plastic[6];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
  elastic_stress_lanes(&c->elastic, elastic, effective);
  const Spectrum strain = spectrum_of(elastic);
  const Lanes volume = lanes_product(lanes_set(lambda), lanes_trace(elastic));
  for (int k = 0; k < 3; ++k) principal[k] = volume + lanes_set(twice) * strain.value[k];
  LaneMask flows;
  Flow flow;
  const Trial trial = trial_of(none, principal);
  const Lanes left = find_left(c, tail, principal, &trial, p->committed, &flow, &flows);
  Lanes value[3];
  for (int k = 0; k < 3; ++k) value[k] = flow.stress[k].value;
  spectral_tensor(&strain, value, returned);
  for (int k = 0; k < 6; ++k) effective[k] = lanes_choose(flows, returned[k], effective[k]);
  plastic_strain_lanes(&c->elastic, p->strain, effective, plastic);
  for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(flows, plastic[k], p->committed[k]);
  p->trial[PLASTIC_IN_TENSION] = flow.tension.value;
  p->trial[PLASTIC_IN_COMPRESSION] = flow.compression.value;
  Dual whole = wholeness(none, c, tail, &flow);
  p->trial[PLASTIC_DAMAGE] = lanes_set(1) - whole.value;
  for (int k = 0; k < 6; ++k) p->stress[k] = lanes_product(whole.value, effective[k]) + (left - left);
  if (!tangents) return;
  const Trial varied = trial_of(every, principal);
  flow = flow_by(every, c, tail, &varied, left, p->committed);
  whole = wholeness(every, c, tail, &flow);
  Lanes slopes[9], tangent[36];
  const Lanes by_flow = lanes_where(flows, lanes_set(1) / lanes_choose(flows, flow.excess.slope[LEFT], lanes_set(1)));
  for (int k = 0; k < 3; ++k) {
    const Dual nominal = dual_product(every, whole, flow.stress[k]);
    Lanes to_trial[3];
    value[k] = nominal.value;
    for (int n = 0; n < 3; ++n) to_trial[n] = nominal.slope[n] - nominal.slope[LEFT] * (flow.excess.slope[n] * by_flow);
    const Lanes all = lanes_product(lanes_set(lambda), to_trial[0] + to_trial[1] + to_trial[2]);
    for (int n = 0; n < 3; ++n) slopes[3 * k + n] = all + lanes_set(twice) * to_trial[n];
  }
  spectral_tangent(&strain, value, slopes, tangent);
  store_tangents(tangent, p->tangent);
}

LANES_INLINE void step(const void *constants, SolidLanes *p, bool tangents)
{
  step_along(constants, p, false, tangents);
}

LANES_INLINE void step_with_tail(const void *constants, SolidLanes *p, bool tangents)
{
  step_along(constants, p, true, tangents);
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const DamagePlasticity *c = constants;
  const Lanes zero = lanes_set(0), radius = trial_radius(t),
              most = lanes_greatest(zero, lanes_product(t->invariant, lanes_set(1.0 / 3)) + lanes_set(2) * radius);
  const double beta = (1 - c->alpha) * c->compression / c->tension - (1 + c->alpha);
  const Lanes stress =
      lanes_dot(lanes_set(3), radius, lanes_set(c->alpha), t->invariant, lanes_set(fmax(0, beta)), most);
  *found = (trial_history(t, PLASTIC_IN_TENSION) <= zero) & (trial_history(t, PLASTIC_IN_COMPRESSION) <= zero) &
           (stress <= lanes_set((1 - c->alpha) * c->compression));
}

int LANES_NAMED(damage_plasticity_update)(const void *constants, const breccia_batch *batch)
{
  const DamagePlasticity *c = constants;
  enum { VALUES = DAMAGE_PLASTICITY_HISTORY };
  return c->tail == 1 ? solid_update_lanes(constants, batch, VALUES, &c->elastic, true, inside, step)
                      : solid_update_lanes(constants, batch, VALUES, &c->elastic, true, inside, step_with_tail);
}

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

/** Where the flow leads that leaves a share of the trial deviator: principal effective stresses and their sum, plastic strains in tension and compression, F,
 *  and the share of tension in the stresses. */
typedef struct Flow {
  Dual stress[3], sum, tension, compression, excess, share, multiplier;
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

/** Parameters of the tension curves of points (damage_plasticity.c): b [1], and k - 1 if the curve has a tail. */
typedef struct TensionCurves {
  Lanes rate, steeper;
} TensionCurves;

/** Returns the tension curves of points that spread the fracture energy over a length. The area below a curve over
 *  plastic strain, over f_t, is at least damage_plasticity_steepest.
 *  @param[in] length  length of each point [length]; 0: the length of the law */
LANES_INLINE TensionCurves tension_curves_over(const DamagePlasticity *c, Lanes length)
{
  const double m = c->tension_share, steepest = damage_plasticity_steepest(c), t = c->tail;
  TensionCurves curves = {lanes_set(c->tension_rate), lanes_set(c->steeper)};
  const LaneMask known = length > lanes_set(0);
  if (!c->lengths.across || !lanes_any(known)) return curves;
  const Lanes one = lanes_set(1), over = one / lanes_choose(known, length, one),
              area = lanes_greatest(lanes_product(lanes_set(c->opening), over) -
                                        lanes_set(c->peak_strain * m / (2 * (2 - m))),
                                    lanes_set(steepest));
  Lanes sum = one; /* t + (1 - t) / k */
  if (t < 1) {
    const Lanes first = lanes_greatest(lanes_product(lanes_set(2 * c->initial_opening), over) -
                                           lanes_set(c->peak_strain * m),
                                       lanes_set(steepest)),
                half = lanes_greatest((area / first - lanes_set(t * t + (1 - t) * (1 - t))) *
                                          lanes_set(0.5 / (t * (1 - t))),
                                      one), /* (k + 1 / k) / 2 */
        k = half + lanes_root(lanes_product(half, half) - one);
    sum = lanes_set(t) + lanes_set(1 - t) / k;
    curves.steeper = lanes_choose(known, k - one, curves.steeper);
  }
  curves.rate = lanes_choose(known, sum / area, curves.rate);
  return curves;
}

/** The curve of tension over plastic strain, to a power: c^share. @param[in] tail  whether it has one: a constant */
LANES_INLINE Dual remaining(DualSlopes n, const DamagePlasticity *c, const TensionCurves *curves, bool tail,
                            Dual plastic, double share)
{
  const Lanes slow = lanes_product(-curves->rate, lanes_set(share));
  Dual power = dual_of(n, lanes_product(slow, plastic.value), slow, plastic);
  if (tail) {
    const Lanes fast = lanes_product(-curves->rate, curves->steeper);
    const Dual quick = dual_exponential(n, dual_of(n, lanes_product(fast, plastic.value), fast, plastic)),
               both = dual_shift(dual_scale(n, 1 - c->tail, quick), c->tail);
    power = dual_sum(n, power, share, dual_logarithm(n, both));
  }
  return dual_exponential(n, power);
}

LANES_INLINE Flow flow_by(DualSlopes n, const DamagePlasticity *c, const TensionCurves *curves, bool tail,
                          const Trial *t, Lanes left, const Lanes *committed)
{
  Flow f;
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  const double half = c->by_twice_shear, third = half * (2.0 / 3);
  const Dual q = dual_times_variable(n, t->q, left, LEFT);
  const Lanes root = lanes_root(lanes_set(c->rounding * c->rounding) + q.value * q.value),
              both = one / lanes_product(left, root), inverse = lanes_product(root, both);
  const Dual steep = dual_of(n, root, q.value * lanes_product(left, both), q);
  Dual over = dual_constant((inverse - one) * lanes_set(third));
  over.slope[LEFT] = -inverse * inverse * lanes_set(third);
  f.multiplier = dual_product(n, over, steep);
  f.sum = dual_sum(n, t->sum, -3 * c->elastic.bulk * c->dilation, f.multiplier);
  Dual pull[3];
  for (int k = 0; k < 3; ++k) {
    f.stress[k] = dual_sum(n, dual_times_variable(n, t->deviator[k], left, LEFT), 1.0 / 3, f.sum);
    pull[k] = dual_positive(n, f.stress[k]);
  }
  const Dual positive = dual_add(n, dual_add(n, pull[0], pull[1]), pull[2]),
             all = dual_sum(n, dual_scale(n, 2, positive), -1, f.sum); /* of all magnitudes */
  const LaneMask stressed = all.value > zero;
  f.share = dual_where(n, stressed, dual_quotient(n, positive, dual_choose(n, stressed, all, dual_constant(one))));
  f.share.value = lanes_least(f.share.value, one);
  /* Plastic strain increments: (1 - r) s_trial / 2G + dl tan(psi) / 3. */
  Dual gone = dual_constant((one - left) * lanes_set(half));
  gone.slope[LEFT] = lanes_set(-half);
  const Dual dilated = dual_scale(n, c->dilation * (1.0 / 3), f.multiplier),
             largest = dual_add(n, dual_product(n, gone, t->deviator[0]), dilated),
             least = dual_add(n, dual_product(n, gone, t->deviator[2]), dilated);
  f.tension = dual_product(n, f.share, dual_positive(n, largest));
  f.tension.value += committed[PLASTIC_IN_TENSION];
  f.compression = dual_product(n, dual_rest(n, f.share), dual_positive(n, dual_scale(n, -1, least)));
  f.compression.value += committed[PLASTIC_IN_COMPRESSION];
  const double b = c->compression_rate, m = c->compression_share;
  /* One over the strength in tension; a crack cannot carry, but divides. */
  Dual weakness = dual_scale(n, c->by_tension, remaining(n, c, curves, tail, f.tension, c->tension_share - 1));
  weakness = dual_smaller(n, weakness, dual_constant(lanes_set(1e9 * c->by_tension)));
  const Dual rise = dual_exponential(n, dual_scale(n, -b * (1 - m), f.compression)),
             fall = dual_exponential(n, dual_scale(n, -b * (2 - m), f.compression));
  Dual cohesion = dual_sum(n, dual_scale(n, c->compression * (1 + c->hump), rise), -c->compression * c->hump, fall);
  cohesion = dual_larger(n, cohesion, dual_constant(lanes_set(1e-9 * c->compression)));
  const Dual beta = dual_shift(dual_scale(n, 1 - c->alpha, dual_product(n, cohesion, weakness)), -(1 + c->alpha)),
             pressed = dual_sum(n, pull[0], -1, f.stress[0]);
  Dual excess = dual_add(n, dual_sum(n, q, c->alpha, f.sum), dual_product(n, beta, pull[0]));
  excess = dual_scale(n, c->by_rest_of_alpha, dual_sum(n, excess, -c->gamma, pressed));
  f.excess = dual_sum(n, excess, -1, cohesion);
  return f;
}

/** 1 - D of a state. */
LANES_INLINE Dual wholeness(DualSlopes n, const DamagePlasticity *c, const TensionCurves *curves, bool tail,
                            Dual tension, Dual compression, Dual share)
{
  const Dual pulled = remaining(n, c, curves, tail, tension, c->tension_share),
             pressed = dual_exponential(n, dual_scale(n, -c->compression_rate * c->compression_share, compression));
  return dual_product(n, pressed, dual_rest(n, dual_product(n, share, dual_rest(n, pulled))));
}

/** Finds the share of tension that counts for damage, at least the closing offset over the size of the elastic strain,
 * so that closed cracks carry no more than what has been put in since they closed: they have the energy E (a - m)^2 / 2
 * of what damage takes.
 *  @param[in] sum, q  of effective stress
 *  @param[in] share  of tension in the principal stresses
 *  @param[out] size  a, of the elastic strain: E a^2 / 2 is the energy of C */
LANES_INLINE Dual counted_share(DualSlopes n, const DamagePlasticity *c, Dual sum, Dual q, Dual share,
                                const Lanes *committed, Dual *size)
{
  const Dual square = dual_sum(n, dual_scale(n, c->by_invariant, dual_product(n, sum, sum)), c->by_deviator,
                               dual_product(n, q, q)),
             one = dual_constant(lanes_set(1));
  *size = dual_root(n, square);
  const LaneMask beyond = size->value > committed[PLASTIC_CLOSING_OFFSET];
  const Dual offset = dual_constant(committed[PLASTIC_CLOSING_OFFSET]);
  const Dual least = dual_choose(n, beyond, dual_quotient(n, offset, dual_choose(n, beyond, *size, one)), one);
  return dual_larger(n, share, c->recovers_by_share ? dual_constant(lanes_set(0)) : least);
}

/* What a search finds besides the share. */
enum { FOUND_SUM, FOUND_TENSION, FOUND_COMPRESSION, FOUND_SHARE, FOUND };

/** A group's trial stress, and where F vanishes: what the search for it knows so far. */
typedef struct Search {
  Lanes principal[3], sum, deviator[3], q;       /* trial stress */
  Lanes noise, by_longest;                       /* F that is nothing; 1 / q */
  Lanes left, low, high, moved;                  /* share, its bracket, how far it went last */
  Lanes left_before, gap_before, inverse_before; /* share, F and 1 / slope the time before */
  Lanes rest, found[FOUND];                      /* what the last step adds; what it leads to */
  LaneMask flows, ended, bracketed;
  SpectrumApart apart; /* of the elastic trial strain, for tangents and crack normals */
  TensionCurves curves;
} Search;

LANES_INLINE Trial searched_trial(const Search *s)
{
  Trial t = {dual_constant(s->sum),
             {dual_constant(s->deviator[0]), dual_constant(s->deviator[1]), dual_constant(s->deviator[2])},
             dual_constant(s->q)};
  return t;
}

LANES_INLINE void begin_search(const DamagePlasticity *c, const SolidLanes *p, Search *s, bool tangents)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const DualSlopes none = {0, 0};
  const Lanes zero = lanes_set(0), one = lanes_set(1);
  Lanes elastic[6], value[3];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
  const Lanes volume = lanes_product(lanes_set(lambda), lanes_trace(elastic));
  const SpectrumApart apart = spectrum_apart(elastic);
  spectrum_values(&apart, value);
  if (tangents || c->lengths.across) s->apart = apart;
  s->curves = tension_curves_over(c, p->committed[PLASTIC_LENGTH]);
  for (int k = 0; k < 3; ++k) s->principal[k] = volume + lanes_set(twice) * value[k];
  const Trial t = trial_of(none, s->principal);
  s->sum = t.sum.value;
  for (int k = 0; k < 3; ++k) s->deviator[k] = t.deviator[k].value;
  s->q = t.q.value;
  s->noise = lanes_set(1e-14 * c->compression) +
             lanes_set(4e-16) * lanes_greatest(lanes_absolute(s->principal[0]), lanes_absolute(s->principal[2]));
  s->by_longest = one / lanes_greatest(s->q, lanes_set(1e-100 * c->compression));
  s->left = s->left_before = s->high = one;
  s->low = s->inverse_before = s->rest = zero;
  s->moved = s->gap_before = lanes_set(INFINITY);
  s->flows = s->ended = s->bracketed = (LaneMask){0};
}

/** One more step towards the share at which F vanishes, by Newton's method in a bracket; it is 1 of points that are elastic. F is negative where nothing is
 *  left, because the flow dilates. From the second time on steps lead to where the cubic vanishes that has the values and slopes of the last two. Where they
 *  and Newton's own differ by a rounding of the share, all else follows them by its slope. @param[in] give_up  whether it is the last step: shares that are not there become no number. @return whether all
 *  are there; before, values are not told */
LANES_INLINE bool search_on(const DamagePlasticity *c, bool tail, Search *s, const Lanes *committed, bool give_up)
{
  const DualSlopes to_left = {LEFT, LEFT + 1};
  const Lanes zero = lanes_set(0), one = lanes_set(1), half = lanes_set(0.5), left = s->left;
  const Trial t = searched_trial(s);
  const Flow flow = flow_by(to_left, c, &s->curves, tail, &t, left, committed);
  const Lanes gap = flow.excess.value, slope = flow.excess.slope[LEFT];
  const LaneMask first = s->gap_before == lanes_set(INFINITY);
  s->flows |= first & (gap > lanes_set(1e-12 * c->compression));
  const LaneMask beyond = gap > zero;
  s->high = lanes_choose(beyond, left, s->high);
  s->low = lanes_choose(beyond, s->low, left);
  s->bracketed |= ~beyond;
  LaneMask ended =
      s->ended | ~s->flows | (lanes_absolute(gap) <= s->noise) | (s->high - s->low <= lanes_set(4e-16) * s->high);
  /* The share as a cubic of F: Hermite's interpolation. */
  const Lanes apart = s->gap_before - gap;
  const LaneMask two = (apart != zero) & ~first;
  /* Newton's step in the multiplier, and three bounds from below of what it leaves: the first one of second order, the others right where the rounding of
   * the potential's tip is nothing, and where it is all. One division for all. */
  const double triple = 3 * c->elastic.shear;
  const Lanes stands = one + lanes_set(triple * c->by_rounding) * flow.multiplier.value,
              grows = lanes_product(lanes_set(triple * c->by_rounding), flow.multiplier.slope[LEFT]),
              tip = lanes_cross(slope, stands, gap, grows), some = lanes_choose(two, apart, one),
              by_all = one / (lanes_product(slope, some) * tip), inverse = lanes_product(some, tip) * by_all,
              by_apart = lanes_product(slope, tip) * by_all, by_tip = lanes_product(slope, some) * by_all;
  const Lanes step = lanes_product(gap, inverse), chord = lanes_product(s->left_before - left, by_apart),
              bend = (chord - inverse) -
                     lanes_product(s->gap_before, by_apart) * ((s->inverse_before + inverse) - (chord + chord)),
              more = lanes_where(two, lanes_product(gap, gap) * lanes_product(by_apart, bend));
  const LaneMask smooth = two & (lanes_absolute(more) <= half * lanes_absolute(step)) & (slope > zero),
                 last = smooth & ~ended & (lanes_absolute(more) <= lanes_set(4e-16) * left) &
                        (lanes_absolute(step) <= lanes_set(1e-7) * left);
  s->rest = lanes_choose(last, more - step, s->rest);
  ended |= last;
  const Lanes wanted = lanes_set(triple) * (flow.multiplier.value - step * flow.multiplier.slope[LEFT]);
  Lanes next = lanes_greatest(left - step, (s->q - wanted) * s->by_longest);
  next = lanes_greatest(next, lanes_product(slope, by_tip));
  next = lanes_choose(smooth, left - step + more, next);
  const LaneMask inside = (slope > zero) & (next > s->low) & (next < s->high),
                 good = inside & (~s->bracketed | (lanes_absolute(next - left) <= half * s->moved));
  next = lanes_choose(good, next, half * (s->low + s->high));
  if (give_up || !lanes_any(~ended)) {
    const Dual *const found[] = {&flow.sum, &flow.tension, &flow.compression, &flow.share};
    for (int k = 0; k < FOUND; ++k) s->found[k] = found[k]->value + s->rest * found[k]->slope[LEFT];
    s->left = lanes_choose(ended, left + s->rest, lanes_set(NAN));
    return true;
  }
  s->moved = lanes_choose(s->bracketed, lanes_absolute(next - left), s->moved);
  s->left_before = left;
  s->gap_before = gap;
  s->inverse_before = inverse;
  s->ended = ended | (next == left);
  s->left = lanes_choose(ended, left, next);
  return false;
}

/** Goes on until all points of all groups are there. */
LANES_INLINE void search_all(const DamagePlasticity *c, bool tail, const SolidLanes *p, int groups, Search *searches)
{
  enum { MOST_ITERATIONS = 400 };
  bool there[SOLID_GROUPS] = {false};
  int going = groups;
  for (int iteration = 1; going; ++iteration)
    for (int g = 0; g < groups; ++g) {
      if (there[g]) continue;
      there[g] = search_on(c, tail, &searches[g], p[g].committed, iteration == MOST_ITERATIONS);
      going -= there[g];
    }
}

LANES_INLINE void finish_step(const DamagePlasticity *c, const Search *s, SolidLanes *p, bool tail)
{
  const double twice = 2 * c->elastic.shear;
  const DualSlopes none = {0, 0};
  Lanes elastic[6], effective[6], plastic[6];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[k];
  elastic_stress_lanes(&c->elastic, elastic, effective);
  const Lanes left = s->left, stiff = lanes_product(lanes_set(twice), left),
              mean = lanes_product(lanes_trace(elastic), lanes_set(1.0 / 3)),
              spherical = lanes_product(s->found[FOUND_SUM], lanes_set(1.0 / 3));
  for (int k = 0; k < 6; ++k) {
    const Lanes returned = k < 3 ? spherical + stiff * (elastic[k] - mean) : lanes_product(stiff, elastic[k]);
    effective[k] = lanes_choose(s->flows, returned, effective[k]);
  }
  plastic_strain_lanes(&c->elastic, p->strain, effective, plastic);
  for (int k = 0; k < 6; ++k) p->trial[k] = lanes_choose(s->flows, plastic[k], p->committed[k]);
  p->trial[PLASTIC_IN_TENSION] = s->found[FOUND_TENSION];
  p->trial[PLASTIC_LENGTH] =
      normal_lengths_choose(&c->lengths, &s->apart, s->found[FOUND_TENSION] > lanes_set(0),
                            p->committed[PLASTIC_IN_TENSION] > lanes_set(0), p->committed[PLASTIC_LENGTH]);
  p->trial[PLASTIC_IN_COMPRESSION] = s->found[FOUND_COMPRESSION];
  Dual size;
  const Dual share =
      counted_share(none, c, dual_constant(s->found[FOUND_SUM]), dual_constant(lanes_product(left, s->q)),
                    dual_constant(s->found[FOUND_SHARE]), p->committed, &size);
  p->trial[PLASTIC_CLOSING_OFFSET] =
      lanes_where(s->found[FOUND_TENSION] > lanes_set(0), lanes_product(share.value, size.value));
  const Dual whole = wholeness(none, c, &s->curves, tail, dual_constant(s->found[FOUND_TENSION]),
                               dual_constant(s->found[FOUND_COMPRESSION]), share);
  p->trial[PLASTIC_DAMAGE] = lanes_set(1) - whole.value;
  for (int k = 0; k < 6; ++k) p->stress[k] = lanes_product(whole.value, effective[k]) + (left - left);
}

LANES_INLINE void find_tangents(const DamagePlasticity *c, const Search *s, SolidLanes *p, bool tail)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const DualSlopes every = {0, LEFT + 1};
  const Trial varied = trial_of(every, s->principal);
  const Flow flow = flow_by(every, c, &s->curves, tail, &varied, s->left, p->committed);
  Dual size;
  const Dual share = counted_share(every, c, flow.sum, dual_times_variable(every, varied.q, s->left, LEFT), flow.share,
                                   p->committed, &size);
  const Dual whole = wholeness(every, c, &s->curves, tail, flow.tension, flow.compression, share);
  const Spectrum strain = spectrum_with_vectors(&s->apart);
  Lanes value[3], slopes[9], tangent[36];
  const Lanes by_flow =
      lanes_where(s->flows, lanes_set(1) / lanes_choose(s->flows, flow.excess.slope[LEFT], lanes_set(1)));
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

/* Begun, searched and varied are groups by functions of their own, one for each curve of tension: with all of it in one function for each kind of call gcc
 * takes four times as long. */
LANES_OUTLINE void begin_searches(const DamagePlasticity *c, const SolidLanes *p, int groups, Search *searches,
                                  bool tangents)
{
  for (int g = 0; g < groups; ++g) begin_search(c, &p[g], &searches[g], tangents);
}

LANES_OUTLINE void search_without_tail(const DamagePlasticity *c, const SolidLanes *p, int groups, Search *searches)
{
  search_all(c, false, p, groups, searches);
}

LANES_OUTLINE void search_with_tail(const DamagePlasticity *c, const SolidLanes *p, int groups, Search *searches)
{
  search_all(c, true, p, groups, searches);
}

LANES_OUTLINE void tangents_without_tail(const DamagePlasticity *c, const Search *s, SolidLanes *p)
{
  find_tangents(c, s, p, false);
}

LANES_OUTLINE void tangents_with_tail(const DamagePlasticity *c, const Search *s, SolidLanes *p)
{
  find_tangents(c, s, p, true);
}

LANES_INLINE void steps(const void *constants, SolidLanes *p, int groups, bool tangents)
{
  Search searches[SOLID_GROUPS];
  begin_searches(constants, p, groups, searches, tangents);
  search_without_tail(constants, p, groups, searches);
  for (int g = 0; g < groups; ++g) {
    finish_step(constants, &searches[g], &p[g], false);
    if (tangents) tangents_without_tail(constants, &searches[g], &p[g]);
  }
}

LANES_INLINE void steps_with_tail(const void *constants, SolidLanes *p, int groups, bool tangents)
{
  Search searches[SOLID_GROUPS];
  begin_searches(constants, p, groups, searches, tangents);
  search_with_tail(constants, p, groups, searches);
  for (int g = 0; g < groups; ++g) {
    finish_step(constants, &searches[g], &p[g], true);
    if (tangents) tangents_with_tail(constants, &searches[g], &p[g]);
  }
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, const Lanes *history, LaneMask *found)
{
  const DamagePlasticity *c = constants;
  const Lanes zero = lanes_set(0), radius = trial_radius(t),
              most = lanes_greatest(zero, lanes_product(t->invariant, lanes_set(1.0 / 3)) + lanes_set(2) * radius);
  const double beta = (1 - c->alpha) * c->compression / c->tension - (1 + c->alpha);
  const Lanes stress =
      lanes_dot(lanes_set(3), radius, lanes_set(c->alpha), t->invariant, lanes_set(fmax(0, beta)), most);
  *found = (history[PLASTIC_IN_TENSION] <= zero) & (history[PLASTIC_IN_COMPRESSION] <= zero) &
           (history[PLASTIC_LENGTH] <= zero) & (stress <= lanes_set((1 - c->alpha) * c->compression));
}

int LANES_NAMED(damage_plasticity_update)(const void *constants, const breccia_batch *batch)
{
  const DamagePlasticity *c = constants;
  enum { VALUES = DAMAGE_PLASTICITY_HISTORY };
  return c->tail == 1 ? solid_update_lanes(constants, batch, VALUES, &c->elastic, true, inside, NULL, steps)
                      : solid_update_lanes(constants, batch, VALUES, &c->elastic, true, inside, NULL, steps_with_tail);
}

/* Plastic-damage model of concrete (Lubliner, Oliver, Oller and Onate 1989; Lee and Fenves 1998; docs/theory.md 8.7), tension positive.
 *
 * Effective stress obeys F = (q + alpha I1 + beta <s1> - gamma <-s1>) / (1 - alpha) - Sc <= 0 with beta = Sc / St (1 - alpha) - (1 + alpha);
 * flow along sqrt((e f_t tan(psi))^2 + q^2) + tan(psi) I1 / 3; nominal stress = (1 - D) effective stress, 1 - D = (1 - D_c) (1 - r D_t).
 * Uniaxial curves over plastic strain x are those of Lee and Fenves: tension f_t exp(-b x), compression
 * f_c0 ((1 + a) exp(-b x) - a exp(-2 b x)), with 1 - D = exp(-m b x), so that a share m of the softening is loss of stiffness. Where concrete
 * has an initial fracture energy of its own (Bazant 2002), tension is f_t c(x), c = t exp(-b x) + (1 - t) exp(-k b x), and 1 - D = c^m.
 *
 * The flow keeps the direction of the trial deviator, and all else follows from one multiplier: its equation has one unknown. */
#include "constitutive/solid/dual.h"
#include "constitutive/solid/elastic_first.h"
#include "constitutive/solid/spectral.h"

typedef struct DamagePlasticity {
  Elasticity elastic;
  double alpha, gamma, dilation, rounding; /* tan(psi), e f_t tan(psi) */
  double tension, tension_rate, tension_share;
  double tail, steeper; /* t, and k - 1; 1 and 0: one exponential */
  double compression, hump, compression_rate, compression_share;
} DamagePlasticity;

enum {
  TENSILE = ELASTIC_PARAMETERS,
  COMPRESSIVE,
  FIRST_YIELD,
  ENERGY,
  CRUSHING,
  BIAXIAL,
  MERIDIAN,
  DILATION,
  ECCENTRICITY,
  TENSION_DAMAGE,
  COMPRESSION_DAMAGE,
  LENGTH,
  INITIAL_ENERGY
};
enum { PLASTIC = 0, IN_TENSION = 6, IN_COMPRESSION, DAMAGE, HISTORY };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"tensile strength", "stress", NULL, "(0, inf)", "f_t"},
    {"compressive strength", "stress", NULL, "(0, inf)", "f_c, uniaxial"},
    {"first yield", "1", "0.5", "(0, 1)", "share of the compressive strength at which compression becomes plastic"},
    {"fracture energy", "fracture energy", NULL, "(0, inf)", "G_F per area of crack"},
    {"crushing energy", "fracture energy", "", "(0, inf)", "per area of crushing zone; (f_c / f_t)^2 G_F when absent"},
    {"biaxial ratio", "1", "1.16", "(1, 2]", "biaxial over uniaxial compressive strength"},
    {"meridian ratio", "1", "0.6667", "(0.5, 1]", "K_c, of the tensile to the compressive meridian"},
    {"dilation angle", "angle", "35 deg", "(0, 56]", "of the flow"},
    {"eccentricity", "1", "0.1", "(0, 1]", "rounding of the flow potential's tip"},
    {"tension damage", "1", "0.75", "[0, 1)", "share of the softening in tension that is loss of stiffness"},
    {"compression damage", "1", "0.5", "[0, 1)", "the same in compression"},
    {"length", "length", "", "(0, inf)", "over which the energies are spread; that of the formulation when absent"},
    {"initial fracture energy", "fracture energy", "", "(0, inf)",
     "G_f below the first tangent of stress over opening, which decides largest loads; about 0.4 G_F in concrete; when "
     "absent G_F / 2, one exponential"},
};

/* Share of the strength at which concrete's softening turns into its long tail: 0.15 to 0.33. */
static const double turn = 0.25;

/** Two exponentials, so that the first tangent of stress over opening has an energy of its own below it. Opening over length is x and what damage
 *  makes elastic, x' (1 + m f_t |c'| / E) at first. @param[in] area  below c. @return 1 with a reason */
static int prepare_tail(DamagePlasticity *c, const double *v, double area, char *reason, size_t size)
{
  const double young = elasticity_young(&c->elastic), strength = v[TENSILE], length = v[LENGTH],
               first =
                   2 * v[INITIAL_ENERGY] / (length * strength) - c->tension_share * strength / young; /* 1 / |c'(0)| */
  if (first <= (1 - c->tension_share) * strength / young) {
    snprintf(reason, size,
             "a length of %g makes the curve of tension snap back; with this 'initial fracture energy' it must be less "
             "than %g: take a finer spacing, if the units of these numbers are right",
             length, 2 * v[INITIAL_ENERGY] * young / (strength * strength));
    return 1;
  }
  const double steepness = (area / first - turn * turn - (1 - turn) * (1 - turn)) / (turn * (1 - turn)); /* k + 1 / k */
  if (steepness < 2) {
    snprintf(reason, size,
             "'initial fracture energy' must be at most %g with this 'fracture energy': that of one exponential",
             length * strength / 2 * (area + c->tension_share * strength / young));
    return 1;
  }
  const double k = (steepness + sqrt(steepness * steepness - 4)) / 2;
  c->tail = turn;
  c->steeper = k - 1;
  c->tension_rate = (turn + (1 - turn) / k) / area;
  return 0;
}

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  DamagePlasticity *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  if (isnan(v[LENGTH])) {
    snprintf(reason, size, "a fracture energy needs the 'length' over which it is spread");
    return 1;
  }
  const double young = elasticity_young(&c->elastic), ratio = v[BIAXIAL], strength = v[TENSILE];
  c->alpha = (ratio - 1) / (2 * ratio - 1);
  c->gamma = 3 * (1 - v[MERIDIAN]) / (2 * v[MERIDIAN] - 1);
  c->dilation = tan(v[DILATION] * acos(-1) / 180);
  c->rounding = v[ECCENTRICITY] * strength * c->dilation;
  c->tension = strength;
  c->tension_share = v[TENSION_DAMAGE];
  c->compression_share = v[COMPRESSION_DAMAGE];
  c->compression = v[FIRST_YIELD] * v[COMPRESSIVE];
  /* The peak of the hump, f_c0 (1 + a)^2 / (4 a), is f_c. */
  const double over = 1 / v[FIRST_YIELD];
  c->hump = 2 * over - 1 + 2 * sqrt(over * over - over);
  const double crushing = isnan(v[CRUSHING]) ? pow(v[COMPRESSIVE] / strength, 2) * v[ENERGY] : v[CRUSHING];
  c->compression_rate = c->compression * (1 + c->hump / 2) * v[LENGTH] / crushing;
  /* Plastic work f_t / b and what damage takes of the stored energy make the area below the curve of total strain. */
  const double m = c->tension_share, stored = strength * strength / young,
               left = v[ENERGY] / v[LENGTH] - stored * m / (2 * (2 - m));
  c->tension_rate = strength / left;
  c->tail = 1;
  c->steeper = 0;
  if (left > (1 - m) * stored) {
    if (!isnan(v[INITIAL_ENERGY]) && prepare_tail(c, v, left / strength, reason, size)) return 1;
    if (v[COMPRESSIVE] * v[FIRST_YIELD] > strength) return 0;
    snprintf(reason, size, "'first yield' times 'compressive strength' must be larger than 'tensile strength'");
    return 1;
  }
  snprintf(reason, size,
           "a length of %g makes the curve of tension snap back; it must be less than %g: take a finer spacing, if the "
           "units of these numbers are right",
           v[LENGTH], v[ENERGY] / (stored * (1 - m + m / (2 * (2 - m)))));
  return 1;
}

static double softening_energy(const void *constants)
{
  const DamagePlasticity *c = constants;
  return c->tension * c->tension / (2 * elasticity_young(&c->elastic));
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  static const char *const names[] = {"plastic strain in tension", "plastic strain in compression", "material damage"};
  snprintf(name, size, "%s", k >= IN_TENSION ? names[k - IN_TENSION] : "");
}

/** Where the flow with a multiplier leads: principal effective stresses, plastic strains in tension and compression, and F. */
typedef struct Flow {
  Dual stress[3], tension, compression, excess, share;
} Flow;

/** Effective deviator after a flow: q + 3 G dl q / sqrt(e^2 + q^2) = q_trial, which grows in q; returns q / q_trial. */
static double shrink_of(const DamagePlasticity *c, double trial, double multiplier)
{
  if (trial <= 0) return 1;
  const double pull = 3 * c->elastic.shear * multiplier, e2 = c->rounding * c->rounding;
  double low = fmax(0, trial - pull), high = trial, q = low > 0 ? low : trial / (1 + pull / c->rounding);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double root = sqrt(e2 + q * q), gap = q + pull * q / root - trial;
    if (gap > 0)
      high = q;
    else
      low = q;
    double next = q - gap / (1 + pull * e2 / (root * root * root));
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (fabs(next - q) <= 1e-16 * trial) break;
    q = next;
  }
  return q / trial;
}

/** The curve of tension over plastic strain, to a power: c^share. */
static Dual remaining(const DamagePlasticity *c, Dual plastic, double share)
{
  const Dual slow = dual_exp(dual_scale(-c->tension_rate * share, plastic));
  if (c->tail == 1) return slow;
  const Dual quick = dual_exp(dual_scale(-c->tension_rate * c->steeper, plastic)),
             both = dual_shift(dual_scale(1 - c->tail, quick), c->tail);
  const double power = pow(both.value, share);
  return dual_product(slow, dual_chain(power, share * power / both.value, both, 0, both));
}

/** Trial principal stresses are the variables 0 to 2, the multiplier is 3. */
static Flow flow_by(const DamagePlasticity *c, const double trial[3], double multiplier, const double *committed)
{
  Flow f;
  const Dual dl = dual_variable(multiplier, 3);
  Dual sum = dual_constant(0), deviator[3], square = dual_constant(0);
  for (int k = 0; k < 3; ++k) sum = dual_sum(1, sum, 1, dual_variable(trial[k], k));
  for (int k = 0; k < 3; ++k) {
    deviator[k] = dual_sum(1, dual_variable(trial[k], k), -1.0 / 3, sum);
    square = dual_sum(1, square, 1.5, dual_product(deviator[k], deviator[k]));
  }
  const Dual q_trial = dual_sqrt(square);
  const double triple = 3 * c->elastic.shear, e2 = c->rounding * c->rounding;
  Dual q = dual_constant(q_trial.value * shrink_of(c, q_trial.value, multiplier));
  /* Derivatives of q from its equation. */
  const double root = sqrt(e2 + q.value * q.value), stiff = 1 + triple * multiplier * e2 / (root * root * root);
  q = dual_chain(q.value, 1 / stiff, q_trial, -triple * q.value / root / stiff, dl);
  const Dual shrink = q_trial.value > 0 ? dual_quotient(q, q_trial) : dual_constant(1);
  const Dual whole = dual_sum(1, sum, -3 * c->elastic.bulk * c->dilation, dl);
  /* Plastic strain increments: dl (1.5 s / root + tan(psi) / 3). */
  const Dual steep = dual_quotient(dual_scale(1.5, dl), dual_sqrt(dual_shift(dual_product(q, q), e2)));
  Dual positive = dual_constant(0), all = dual_constant(0), s[3];
  for (int k = 0; k < 3; ++k) {
    s[k] = dual_product(shrink, deviator[k]);
    f.stress[k] = dual_sum(1, s[k], 1.0 / 3, whole);
    positive = dual_sum(1, positive, 1, dual_positive(f.stress[k]));
    all = dual_sum(1, all, 1, dual_absolute(f.stress[k]));
  }
  f.share = all.value > 0 ? dual_quotient(positive, all) : dual_constant(0);
  const Dual largest = dual_sum(1, dual_product(steep, s[0]), c->dilation / 3, dl),
             least = dual_sum(1, dual_product(steep, s[2]), c->dilation / 3, dl);
  f.tension = dual_shift(dual_product(f.share, dual_positive(largest)), committed[IN_TENSION]);
  f.compression = dual_shift(dual_product(dual_shift(dual_scale(-1, f.share), 1), dual_positive(dual_scale(-1, least))),
                             committed[IN_COMPRESSION]);
  const double b = c->compression_rate, m = c->compression_share;
  Dual strength = dual_scale(c->tension, remaining(c, f.tension, 1 - c->tension_share));
  strength = dual_larger(strength, dual_constant(1e-9 * c->tension)); /* a crack cannot carry, but divides */
  Dual cohesion = dual_sum(c->compression * (1 + c->hump), dual_exp(dual_scale(-b * (1 - m), f.compression)),
                           -c->compression * c->hump, dual_exp(dual_scale(-b * (2 - m), f.compression)));
  cohesion = dual_larger(cohesion, dual_constant(1e-9 * c->compression));
  const Dual beta = dual_shift(dual_scale(1 - c->alpha, dual_quotient(cohesion, strength)), -(1 + c->alpha));
  Dual excess = dual_sum(1, q, c->alpha, whole);
  excess = dual_sum(1, excess, 1, dual_product(beta, dual_positive(f.stress[0])));
  excess = dual_sum(1, excess, -c->gamma, dual_positive(dual_scale(-1, f.stress[0])));
  f.excess = dual_sum(1 / (1 - c->alpha), excess, -1, cohesion);
  return f;
}

/** 1 - D of a state. */
static Dual wholeness(const DamagePlasticity *c, const Flow *f)
{
  const Dual tension = remaining(c, f->tension, c->tension_share),
             compression = dual_exp(dual_scale(-c->compression_rate * c->compression_share, f->compression));
  const Dual lost = dual_product(f->share, dual_shift(dual_scale(-1, tension), 1));
  return dual_product(compression, dual_shift(dual_scale(-1, lost), 1));
}

/** The multiplier at which F vanishes, by Newton's method in a bracket. @return NaN if there is none */
static double find_multiplier(const DamagePlasticity *c, const double trial[3], const double *committed, double scale,
                              Flow *flow)
{
  double low = 0, high = INFINITY, dl = 0, step = INFINITY;
  for (int iteration = 0; iteration < 400; ++iteration) {
    *flow = flow_by(c, trial, dl, committed);
    const double gap = flow->excess.value, slope = flow->excess.slope[3];
    if (gap > 0)
      low = dl;
    else
      high = dl;
    const bool bracketed = isfinite(high);
    if (fabs(gap) <= 1e-14 * scale || (bracketed && high - low <= 4e-16 * high)) return dl;
    double next = dl - gap / slope;
    if (bracketed) {
      if (!(next > low && next < high) || fabs(next - dl) > 0.5 * step) next = (low + high) / 2;
      step = fabs(next - dl);
    } else if (!(next > low) || !isfinite(next)) {
      next = dl > 0 ? 2 * dl : scale / c->elastic.bulk;
    }
    if (next == dl) return dl;
    dl = next;
  }
  return NAN;
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const DamagePlasticity *c = constants;
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  double elastic[6], effective[6];
  for (int k = 0; k < 6; ++k) elastic[k] = p->strain[k] - p->committed[PLASTIC + k];
  const double volume = lambda * trace(elastic);
  elastic_stress(&c->elastic, elastic, effective);
  memcpy(p->trial, p->committed, sizeof(double) * HISTORY);
  const Spectrum strain = spectrum_of(elastic);
  double trial[3], scale = c->compression;
  for (int k = 0; k < 3; ++k) {
    trial[k] = volume + twice * strain.value[k];
    scale = fmax(scale, fabs(trial[k]));
  }
  Flow flow = flow_by(c, trial, 0, p->committed);
  const bool plastic = flow.excess.value > 1e-12 * c->compression;
  if (plastic) {
    if (isnan(find_multiplier(c, trial, p->committed, c->compression, &flow))) return false;
    double value[3];
    for (int k = 0; k < 3; ++k) value[k] = flow.stress[k].value;
    spectral_tensor(&strain, value, effective);
    plastic_strain(&c->elastic, p->strain, effective, p->trial + PLASTIC);
    p->trial[IN_TENSION] = flow.tension.value;
    p->trial[IN_COMPRESSION] = flow.compression.value;
  }
  const Dual whole = wholeness(c, &flow);
  p->trial[DAMAGE] = 1 - whole.value;
  for (int k = 0; k < 6; ++k) p->stress[k] = whole.value * effective[k];
  if (!p->tangent) return true;
  double value[3], slopes[9];
  for (int k = 0; k < 3; ++k) {
    const Dual nominal = dual_product(whole, flow.stress[k]);
    double to_trial[3];
    value[k] = nominal.value;
    for (int n = 0; n < 3; ++n)
      to_trial[n] = nominal.slope[n] - (plastic ? nominal.slope[3] * flow.excess.slope[n] / flow.excess.slope[3] : 0);
    for (int n = 0; n < 3; ++n)
      slopes[3 * k + n] = lambda * (to_trial[0] + to_trial[1] + to_trial[2]) + twice * to_trial[n];
  }
  spectral_tangent(&strain, value, slopes, p->tangent);
  return true;
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const DamagePlasticity *c = constants;
  const Lanes zero = lanes_set(0), radius = trial_radius(t),
              most = lanes_greatest(zero, t->invariant / lanes_set(3) + lanes_set(2) * radius);
  const double beta = (1 - c->alpha) * c->compression / c->tension - (1 + c->alpha);
  const Lanes stress = lanes_set(3) * radius + lanes_set(c->alpha) * t->invariant + lanes_set(fmax(0, beta)) * most;
  *found = (trial_history(t, IN_TENSION) <= zero) & (trial_history(t, IN_COMPRESSION) <= zero) &
           (stress <= lanes_set((1 - c->alpha) * c->compression));
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  const DamagePlasticity *c = constants;
  return solid_update_elastic_first(constants, batch, HISTORY, &c->elastic, true, inside, update_point);
}

const breccia_law law_damage_plasticity = {
    .size = sizeof(breccia_law),
    .name = "damage-plasticity",
    .about = "concrete: plasticity with damage of its own in tension and compression; cracks close; energies hold for "
             "any spacing",
    .source = "Lubliner, Oliver, Oller and Onate 1989; Lee and Fenves 1998; initial fracture energy Bazant 2002",
    .maturity = "verified against its closed forms",
    .equations = "effective stress: (q + α I₁ + β⟨σ₁⟩ − γ⟨−σ₁⟩) / (1 − α) ≤ S_c, β = (1 − α) S_c/S_t − (1 + α), α from "
                 "the biaxial ratio, γ from the meridian ratio\n"
                 "flow along √((e f_t tan ψ)² + q²) + tan ψ I₁/3\n"
                 "tension over plastic strain f_t exp(−b x), or with an initial fracture energy f_t (t exp(−b x) + (1 "
                 "− t) exp(−k b "
                 "x)), t = 1/4, compression f_c0 ((1 + a) exp(−b x) − a exp(−2 b x)), "
                 "with areas G_F/l and G_c/l\n"
                 "σ = (1 − D) σ_eff, 1 − D = (1 − D_c)(1 − r D_t), r the share of tension in the principal stresses",
    .opensees = "nDMaterial ASDConcrete3D (similar)",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(DamagePlasticity),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .softening_energy = softening_energy,
    .history_values = history_values,
    .history_name = history_name,
    .update = update,
};

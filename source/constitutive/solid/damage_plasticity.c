/* Plastic-damage model of concrete (Lubliner, Oliver, Oller and Onate 1989; Lee and Fenves 1998; docs/theory.md 8.7), tension positive.
 *
 * Effective stress obeys F = (q + alpha I1 + beta <s1> - gamma <-s1>) / (1 - alpha) - Sc <= 0 with beta = Sc / St (1 - alpha) - (1 + alpha);
 * flow along sqrt((e f_t tan(psi))^2 + q^2) + tan(psi) I1 / 3; nominal stress = (1 - D) effective stress, 1 - D = (1 - D_c) (1 - r' D_t).
 * Uniaxial curves over plastic strain x are those of Lee and Fenves: tension f_t exp(-b x), compression
 * f_c0 ((1 + a) exp(-b x) - a exp(-2 b x)), with 1 - D = exp(-m b x), so that a share m of the softening is loss of stiffness. Where concrete
 * has an initial fracture energy of its own (Bazant 2002), tension is f_t c(x), c = t exp(-b x) + (1 - t) exp(-k b x), and 1 - D = c^m.
 * If the formulation gives lengths by crack normal (normal_lengths.h), each point spreads G_F over the length of its
 * own crack. The crushing energy is spread over one length for all points.
 *
 * The share r' is that of tension in the principal stresses, or the closing offset over the size of the elastic strain
 * if that is more: stress derives from a free energy, and closed cycles of strain make none (docs/theory.md 8.7,
 * equations 8.1 and 8.2).
 *
 * The flow keeps the direction of the trial deviator. */
#include "constitutive/solid/damage_plasticity.h"

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
  INITIAL_ENERGY,
  RECOVERY_BY_SHARE
};

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
    {"recovery by share", "1", "0", "[0, 1]",
     "1: cracks close by the share of tension in the stresses alone, as published; closed cycles of strain then make "
     "energy"},
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
  c->update = damage_plasticity_update_chosen();
  c->by_invariant = 1 / (9 * c->elastic.bulk * young);
  c->by_deviator = 1 / (3 * c->elastic.shear * young);
  c->recovers_by_share = v[RECOVERY_BY_SHARE] > 0;
  c->peak_strain = strength / young;
  c->opening = v[ENERGY] / strength;
  c->initial_opening = isnan(v[INITIAL_ENERGY]) ? 0 : v[INITIAL_ENERGY] / strength;
  c->lengths = (NormalLengths){0};
  c->tension = strength;
  c->tension_share = v[TENSION_DAMAGE];
  c->compression_share = v[COMPRESSION_DAMAGE];
  c->by_twice_shear = 1 / (2 * c->elastic.shear);
  c->by_rounding = 1 / c->rounding;
  c->by_tension = 1 / strength;
  c->by_rest_of_alpha = 1 / (1 - c->alpha);
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
  return DAMAGE_PLASTICITY_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  static const char *const names[] = {"plastic strain in tension", "plastic strain in compression", "material damage",
                                      "", ""};
  snprintf(name, size, "%s", k >= PLASTIC_IN_TENSION ? names[k - PLASTIC_IN_TENSION] : "");
}

static int history_is_damage(const void *constants, int k)
{
  (void)constants;
  return k == PLASTIC_DAMAGE;
}

void damage_plasticity_take_lengths(void *constants, const NormalLengths *lengths)
{
  ((DamagePlasticity *)constants)->lengths = *lengths;
}

bool damage_plasticity_is_damaged(const void *constants, const double *history)
{
  (void)constants;
  return history[PLASTIC_IN_TENSION] > 0;
}

double damage_plasticity_longest(const void *constants)
{
  const DamagePlasticity *c = constants;
  const double m = c->tension_share, steepest = damage_plasticity_steepest(c),
               whole = c->opening / (steepest + c->peak_strain * m / (2 * (2 - m)));
  return c->tail < 1 ? fmin(whole, 2 * c->initial_opening / (steepest + c->peak_strain * m)) : whole;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const DamagePlasticity *)constants)->update(constants, batch);
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
                 "σ = (1 − D) σ_eff, 1 − D = (1 − D_c)(1 − r' D_t), r' = m/a at least r, the share of tension in the "
                 "principal stresses; E a²/2 the elastic energy, the closing offset m = max(min(m, a), r a)\n"
                 "closed cycles make no energy; with 'recovery by share' r' = r as published, and they may make a "
                 "fourteenth of what is put in",
    .opensees = "nDMaterial ASDConcrete3D (similar)",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(DamagePlasticity),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .softening_energy = softening_energy,
    .history_values = history_values,
    .history_name = history_name,
    .history_is_damage = history_is_damage,
    .update = update,
};

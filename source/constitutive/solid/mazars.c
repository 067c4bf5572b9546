/* Isotropic damage of concrete by Mazars (Mazars and Pijaudier-Cabot 1989; docs/theory.md 8.7): stress = (1 - D) C strain,
 * equivalent strain e = sqrt(sum <e_i>^2), D = a_t D_t + (1 - a_t) D_c, damage of tension and of compression from the largest e so far, k;
 * damage never heals.
 *
 * In tension D_t = 1 - k0 / k exp(-B_t (k - k0)) with 1 / B_t = G_F / (l E k0) - k0 / 2: the curve peaks at E k0 and spends G_F over the
 * length l whatever that is. In compression D_c = 1 - k0 (1 - A) / k - A exp(-B (k - k0)). */
#include "constitutive/solid/dual.h"
#include "constitutive/solid/elastic_first.h"
#include "constitutive/solid/spectral.h"

typedef struct Mazars {
  Elasticity elastic;
  double threshold, tension_rate, compression_share, compression_rate;
} Mazars;

enum { STRENGTH = ELASTIC_PARAMETERS, ENERGY, COMPRESSION_SHARE, COMPRESSION_RATE, LENGTH };
enum { LARGEST = 0, DAMAGE, HISTORY };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"tensile strength", "stress", NULL, "(0, inf)", "f_t"},
    {"fracture energy", "fracture energy", NULL, "(0, inf)", "G_F per area of crack"},
    {"compression share", "1", "1.2", "(0, 2]", "A_c of the damage in compression"},
    {"compression rate", "1", "1500", "(0, inf)", "B_c of the damage in compression"},
    {"length", "length", "", "(0, inf)",
     "over which the fracture energy is spread; that of the formulation when absent"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Mazars *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  if (isnan(v[LENGTH])) {
    snprintf(reason, size, "a fracture energy needs the 'length' over which it is spread");
    return 1;
  }
  const double young = elasticity_young(&c->elastic), k0 = v[STRENGTH] / young;
  const double decay = v[ENERGY] / (v[LENGTH] * v[STRENGTH]) - k0 / 2;
  c->threshold = k0;
  c->tension_rate = 1 / decay;
  c->compression_share = v[COMPRESSION_SHARE];
  c->compression_rate = v[COMPRESSION_RATE];
  if (decay > 0) return 0;
  snprintf(
      reason, size,
      "a length of %g stores more at the peak than the fracture energy, so that the curve would snap back; it must "
      "be less than 2 E G_F / f_t^2 = %g: take a finer spacing, if the units of these numbers are right",
      v[LENGTH], 2 * young * v[ENERGY] / (v[STRENGTH] * v[STRENGTH]));
  return 1;
}

static double softening_energy(const void *constants)
{
  const Mazars *c = constants;
  return elasticity_young(&c->elastic) * c->threshold * c->threshold / 2;
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == DAMAGE ? "material damage" : "equivalent strain");
}

static void begin(const void *constants, double *history)
{
  history[LARGEST] = ((const Mazars *)constants)->threshold;
  history[DAMAGE] = 0;
}

/** Principal stresses and damage at principal strains, which come as the variables 0, 1, 2. */
static void respond(const Mazars *c, const Dual strain[3], const double *committed, Dual stress[3], Dual *largest,
                    Dual *damage)
{
  const double lambda = c->elastic.bulk - 2 * c->elastic.shear / 3, twice = 2 * c->elastic.shear;
  const Dual volume = dual_sum(1, dual_sum(1, strain[0], 1, strain[1]), 1, strain[2]);
  Dual square = dual_constant(0), tension = dual_constant(0), effective[3];
  for (int k = 0; k < 3; ++k) {
    const Dual positive = dual_positive(strain[k]);
    square = dual_sum(1, square, 1, dual_product(positive, positive));
    effective[k] = dual_sum(lambda, volume, twice, strain[k]);
    tension = dual_sum(1, tension, 1, dual_positive(effective[k]));
  }
  const Dual equivalent = dual_sqrt(square);
  *largest = equivalent.value > committed[LARGEST] ? equivalent : dual_constant(committed[LARGEST]);
  *damage = dual_constant(committed[DAMAGE]);
  if (largest->value > c->threshold) {
    /* a_t: the strain that positive stresses make, against the equivalent strain: never below 0; above 1 where Poisson's ratio is negative. */
    Dual share = dual_constant(0);
    if (square.value > 0) {
      for (int k = 0; k < 3; ++k) {
        const Dual by_tension =
            dual_sum(1 / twice, dual_positive(effective[k]), -lambda / (twice * (3 * lambda + twice)), tension);
        share = dual_sum(1, share, 1, dual_product(dual_positive(strain[k]), by_tension));
      }
      share = dual_quotient(share, square);
      if (share.value > 1) share = dual_constant(1);
    }
    const Dual past = dual_shift(*largest, -c->threshold),
               relative = dual_quotient(dual_constant(c->threshold), *largest);
    const Dual in_tension =
        dual_shift(dual_scale(-1, dual_product(relative, dual_exp(dual_scale(-c->tension_rate, past)))), 1);
    Dual in_compression = dual_shift(dual_sum(-(1 - c->compression_share), relative, -c->compression_share,
                                              dual_exp(dual_scale(-c->compression_rate, past))),
                                     1);
    in_compression = dual_positive(in_compression);
    if (in_compression.value > 1) in_compression = dual_constant(1);
    *damage = dual_larger(
        *damage, dual_sum(1, in_compression, 1, dual_product(share, dual_sum(1, in_tension, -1, in_compression))));
  }
  const Dual whole = dual_shift(dual_scale(-1, *damage), 1);
  for (int k = 0; k < 3; ++k) stress[k] = dual_product(whole, effective[k]);
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const Mazars *c = constants;
  memcpy(p->trial, p->committed, sizeof(double) * HISTORY);
  const Spectrum spectrum = spectrum_of(p->strain);
  Dual strain[3], stress[3], largest, damage;
  for (int k = 0; k < 3; ++k) strain[k] = dual_variable(spectrum.value[k], k);
  respond(c, strain, p->committed, stress, &largest, &damage);
  p->trial[LARGEST] = largest.value;
  p->trial[DAMAGE] = damage.value;
  double value[3], slopes[9];
  for (int k = 0; k < 3; ++k) {
    value[k] = stress[k].value;
    for (int n = 0; n < 3; ++n) slopes[3 * k + n] = stress[k].slope[n];
  }
  /* Stress follows the strain itself, so that nothing is lost to the decomposition. */
  elastic_stress(&c->elastic, p->strain, p->stress);
  for (int k = 0; k < 6; ++k) p->stress[k] *= 1 - damage.value;
  if (p->tangent) spectral_tangent(&spectrum, value, slopes, p->tangent);
  return true;
}

/** Points that were never damaged and whose strains, all together, are less than what damages. */
LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const Mazars *c = constants;
  const Lanes deviator = t->length * lanes_set(1 / (2 * c->elastic.shear)),
              mean = t->invariant * lanes_set(1 / (9 * c->elastic.bulk)),
              square = deviator * deviator + lanes_set(3) * mean * mean;
  *found = (trial_history(t, LARGEST) <= lanes_set(c->threshold)) & (square <= lanes_set(c->threshold * c->threshold));
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  const Mazars *c = constants;
  return solid_update_elastic_first(constants, batch, HISTORY, &c->elastic, false, inside, update_point);
}

const breccia_law law_mazars = {
    .size = sizeof(breccia_law),
    .name = "mazars",
    .about = "concrete: isotropic damage, quick in tension and slow in compression; the fracture energy holds for any "
             "spacing",
    .source = "Mazars and Pijaudier-Cabot 1989",
    .maturity = "verified against its closed forms",
    .equations =
        "σ = (1 − D) C ε; equivalent strain e = √Σ⟨εᵢ⟩², k its largest value so far, at least k₀ = f_t/E\n"
        "D_t = 1 − k₀/k exp(−B_t (k − k₀)), 1/B_t = G_F/(l f_t) − k₀/2; D_c = 1 − k₀ (1 − A)/k − A exp(−B (k − k₀))\n"
        "D = a_t D_t + (1 − a_t) D_c, a_t the share of strain that tensile stresses make; D never falls",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Mazars),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .softening_energy = softening_energy,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};

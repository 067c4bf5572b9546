/* Isotropic damage of concrete by Mazars (Mazars and Pijaudier-Cabot 1989; docs/theory.md 8.7): stress = (1 - D) C strain,
 * equivalent strain e = sqrt(sum <e_i>^2), D = a_t D_t + (1 - a_t) D_c, damage of tension and of compression from the largest e so far, k;
 * damage never heals.
 *
 * In tension D_t = 1 - k0 / k exp(-B_t (k - k0)) with 1 / B_t = G_F / (l E k0) - k0 / 2: the curve peaks at E k0 and
 * spends G_F over any length l. If the formulation gives lengths by crack normal (normal_lengths.h), l is that length.
 * In compression D_c = 1 - k0 (1 - A) / k - A exp(-B (k - k0)). */
#include "constitutive/solid/mazars.h"

enum { STRENGTH = ELASTIC_PARAMETERS, ENERGY, COMPRESSION_SHARE, COMPRESSION_RATE, LENGTH };

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
  c->opening = v[ENERGY] / v[STRENGTH];
  c->lengths = (NormalLengths){0};
  c->compression_share = v[COMPRESSION_SHARE];
  c->compression_rate = v[COMPRESSION_RATE];
  c->update = mazars_update_chosen();
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
  return MAZARS_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  static const char *const names[MAZARS_HISTORY] = {"equivalent strain", "material damage", ""};
  snprintf(name, size, "%s", names[k]);
}

static void begin(const void *constants, double *history)
{
  history[MAZARS_LARGEST] = ((const Mazars *)constants)->threshold;
  history[MAZARS_DAMAGE] = history[MAZARS_LENGTH] = 0;
}

static int history_is_damage(const void *constants, int k)
{
  (void)constants;
  return k == MAZARS_DAMAGE;
}

void mazars_take_lengths(void *constants, const NormalLengths *lengths)
{
  ((Mazars *)constants)->lengths = *lengths;
}

bool mazars_is_damaged(const void *constants, const double *history)
{
  return history[MAZARS_LARGEST] > ((const Mazars *)constants)->threshold;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const Mazars *)constants)->update(constants, batch);
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
    .history_is_damage = history_is_damage,
    .begin = begin,
    .update = update,
};

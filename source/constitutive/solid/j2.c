/* J2 plasticity: the yield stress grows linearly and towards a saturation, the yield surface may travel (docs/theory.md 8.2, Simo and
 * Hughes 1998, ch. 3): |s - b| = sqrt(2/3) Y(x), Y = Y1 + (Y0 - Y1) exp(-d x) + H x, db = 2/3 Hk dg n, dx = sqrt(2/3) dg. */
#include "constitutive/solid/j2.h"

enum { YIELD = ELASTIC_PARAMETERS, SATURATION, RATE, HARDENING, KINEMATIC };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"yield stress", "stress", NULL, "(0, inf)", "in uniaxial tension"},
    {"saturation stress", "stress", "", "(0, inf)", "that the yield stress grows to; the yield stress when absent"},
    {"saturation rate", "1", "0", "[0, inf)", "per equivalent plastic strain, of the growth to the saturation stress"},
    {"hardening modulus", "stress", "0", "[0, inf)", "of the yield stress, per equivalent plastic strain"},
    {"kinematic modulus", "stress", "0", "[0, inf)", "of the travelling centre, per equivalent plastic strain"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  J2 *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  const double saturation = isnan(v[SATURATION]) ? v[YIELD] : v[SATURATION];
  c->hardening = (Hardening){v[YIELD], saturation - v[YIELD], v[RATE], v[HARDENING]};
  c->kinematic = v[KINEMATIC];
  c->update = j2_update_chosen();
  if (saturation >= v[YIELD]) return 0;
  snprintf(reason, size, "'saturation stress' must not lie below 'yield stress': this law does not soften");
  return 1;
}

static void reduce_strength(double *v, double factor)
{
  static const int strengths[] = {YIELD, SATURATION, HARDENING};
  for (size_t k = 0; k < sizeof strengths / sizeof *strengths; ++k) v[strengths[k]] /= factor;
}

static int history_values(const void *constants)
{
  return ((const J2 *)constants)->kinematic > 0 ? J2_HISTORY : J2_BACK;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == J2_EQUIVALENT ? "equivalent plastic strain" : "");
}

static int deviator_of(const void *constants, breccia_deviator *d, char *reason, size_t size)
{
  const J2 *c = constants;
  *d = (breccia_deviator){.yield_stress = c->hardening.first};
  if (c->kinematic == 0 && c->hardening.gain == 0 && c->hardening.modulus == 0) return 0;
  snprintf(reason, size,
           "families yield without hardening: leave out 'saturation stress', 'hardening modulus' and "
           "'kinematic modulus'");
  return 1;
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const J2 *)constants)->update(constants, batch);
}

const breccia_law law_j2 = {
    .size = sizeof(breccia_law),
    .name = "j2",
    .about = "metal-like plasticity (von Mises) with linear and saturating isotropic and linear kinematic hardening",
    .source = "Simo and Hughes 1998, ch. 3",
    .maturity = "verified against OpenSees J2Plasticity",
    .equations =
        "f = ‖s − b‖ − √(2/3) Y(x) ≤ 0, s the stress deviator, b the back stress\n"
        "Y = Y₁ + (Y₀ − Y₁) exp(−d x) + H x; flow dεᵖ = dγ n, n = (s − b)/‖s − b‖; dx = √(2/3) dγ, db = ⅔ Hₖ dγ n",
    .opensees = "nDMaterial J2Plasticity (without the kinematic part)",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(J2),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .history_name = history_name,
    .update = update,
    .deviator = deviator_of,
    .reduce_strength = reduce_strength,
};

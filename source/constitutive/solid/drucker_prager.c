/* Drucker-Prager plasticity with a tension cut-off (Drucker and Prager 1952; docs/theory.md 8.4), tension positive:
 * sqrt(J2) + a I1 = k, flow along sqrt(J2) + a' I1, I1 <= T. Inside, |s| + A I1 = sqrt(2/3) Y(x) with A = sqrt(2) a and
 * Y = sqrt(3) k + H x + dY (1 - exp(-d x)), x the equivalent plastic strain. */
#include "constitutive/solid/drucker_prager.h"

enum {
  COHESION = ELASTIC_PARAMETERS,
  FRICTION,
  DILATION_ANGLE,
  CONE_STRENGTH,
  CONE_SLOPE,
  DILATION_SLOPE,
  CUT,
  HARDENING,
  GAIN,
  RATE
};

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"cohesion", "stress", "", "(0, inf)",
     "c of the Mohr-Coulomb surface whose compressive edges the cone touches; goes with the friction angle"},
    {"friction angle", "angle", "", "[0, 80]", "of that surface"},
    {"dilation angle", "angle", "", "[0, 80]", "of the flow; the friction angle when absent"},
    {"cone strength", "stress", "", "(0, inf)",
     "k of sqrt(J2) + a I1 = k, instead of the angles; goes with the cone slope"},
    {"cone slope", "1", "", "[0, inf)", "a of sqrt(J2) + a I1 = k"},
    {"dilation slope", "1", "", "[0, inf)", "a of the flow; the cone slope when absent"},
    {"tension cut-off", "stress", "", "(0, inf)", "largest sum of normal stresses; the tip of the cone when absent"},
    {"hardening modulus", "stress", "0", "[0, inf)", "growth of sqrt(3) k per equivalent plastic strain"},
    {"saturation gain", "stress", "0", "[0, inf)", "further growth of sqrt(3) k that fades"},
    {"saturation rate", "1", "0", "[0, inf)", "how fast it fades, per equivalent plastic strain"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  DruckerPrager *c = constants;
  if (elasticity_prepare(&c->elastic, v, reason, size)) return 1;
  const int angles = !isnan(v[COHESION]) + !isnan(v[FRICTION]), cone = !isnan(v[CONE_STRENGTH]) + !isnan(v[CONE_SLOPE]);
  if (!(angles == 2 && !cone && isnan(v[DILATION_SLOPE])) && !(cone == 2 && !angles && isnan(v[DILATION_ANGLE]))) {
    snprintf(reason, size,
             "give 'cohesion' and 'friction angle' (and 'dilation angle'), or 'cone strength' and 'cone slope' (and "
             "'dilation slope')");
    return 1;
  }
  double strength = v[CONE_STRENGTH], slope = v[CONE_SLOPE],
         flow = isnan(v[DILATION_SLOPE]) ? slope : v[DILATION_SLOPE];
  if (angles) {
    const double degree = acos(-1) / 180, friction = sin(v[FRICTION] * degree),
                 dilation = isnan(v[DILATION_ANGLE]) ? friction : sin(v[DILATION_ANGLE] * degree);
    slope = 2 * friction / (sqrt(3) * (3 - friction));
    flow = 2 * dilation / (sqrt(3) * (3 - dilation));
    strength = 6 * v[COHESION] * cos(v[FRICTION] * degree) / (sqrt(3) * (3 - friction));
  }
  if (flow > slope * (1 + 1e-12)) {
    snprintf(reason, size, "the dilation must not be larger than the friction: the law would make energy");
    return 1;
  }
  c->update = drucker_prager_update_chosen();
  c->slope = sqrt(2) * slope;
  c->dilation = sqrt(2) * flow;
  c->hardening = (Hardening){sqrt(3) * strength, v[GAIN], v[RATE], v[HARDENING]};
  const double tip = slope > 0 ? strength / slope : INFINITY;
  c->cut = isnan(v[CUT]) ? tip : v[CUT];
  if (c->cut <= tip * (1 + 1e-12)) return 0;
  snprintf(reason, size, "'tension cut-off' lies beyond the tip of the cone, where the normal stresses sum to %g", tip);
  return 1;
}

/** The tip of the cone stays where it is, and dilation until friction is less. */
static void reduce_strength(double *v, double factor)
{
  static const int strengths[] = {COHESION, CONE_STRENGTH, CONE_SLOPE, CUT, HARDENING, GAIN};
  const double degree = acos(-1) / 180;
  for (size_t k = 0; k < sizeof strengths / sizeof *strengths; ++k) v[strengths[k]] /= factor;
  v[FRICTION] = atan(tan(v[FRICTION] * degree) / factor) / degree;
  v[DILATION_ANGLE] = isnan(v[DILATION_ANGLE]) ? NAN : fmin(v[DILATION_ANGLE], v[FRICTION]);
  v[DILATION_SLOPE] = isnan(v[DILATION_SLOPE]) ? NAN : fmin(v[DILATION_SLOPE], v[CONE_SLOPE]);
}

static int history_values(const void *constants)
{
  (void)constants;
  return CONE_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == CONE_EQUIVALENT ? "equivalent plastic strain" : "");
}

static int update(const void *constants, const breccia_batch *batch)
{
  return ((const DruckerPrager *)constants)->update(constants, batch);
}

const breccia_law law_drucker_prager = {
    .size = sizeof(breccia_law),
    .name = "drucker-prager",
    .about = "soil and rock: a cone with tension cut-off, associated or not, with isotropic hardening",
    .source = "Drucker and Prager 1952",
    .maturity = "verified against OpenSees DruckerPrager (isotropic hardening) and TruncatedDP",
    .equations = "√J₂ + a I₁ ≤ k, tension positive; tr σ ≤ T; flow along √J₂ + a′ I₁\n"
                 "from angles, touching the compressive edges of Mohr–Coulomb: a = 2 sin φ / (√3 (3 − sin φ)), k = 6 c "
                 "cos φ / (√3 (3 − sin φ)), a′ likewise from ψ\n"
                 "√3 k + H x + ΔY (1 − exp(−d x)) with the equivalent plastic strain x",
    .opensees = "nDMaterial DruckerPrager",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(DruckerPrager),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .history_name = history_name,
    .update = update,
    .reduce_strength = reduce_strength,
};

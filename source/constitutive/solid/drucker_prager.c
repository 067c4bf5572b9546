/* Drucker-Prager plasticity with a tension cut-off (Drucker and Prager 1952; docs/theory.md 8.4), tension positive:
 * sqrt(J2) + a I1 = k, flow along sqrt(J2) + a' I1, I1 <= T. Inside, |s| + A I1 = sqrt(2/3) Y(x) with A = sqrt(2) a and
 * Y = sqrt(3) k + H x + dY (1 - exp(-d x)), x the equivalent plastic strain. */
#include "constitutive/solid/elastic_first.h"
#include "constitutive/solid/hardening.h"

typedef struct DruckerPrager {
  Elasticity elastic;
  double slope, dilation; /* A and A' */
  Hardening hardening;
  double cut;
} DruckerPrager;

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
enum { PLASTIC = 0, EQUIVALENT = 6, HISTORY };

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
  c->slope = sqrt(2) * slope;
  c->dilation = sqrt(2) * flow;
  c->hardening = (Hardening){sqrt(3) * strength, v[GAIN], v[RATE], v[HARDENING]};
  const double tip = slope > 0 ? strength / slope : INFINITY;
  c->cut = isnan(v[CUT]) ? tip : v[CUT];
  if (c->cut <= tip * (1 + 1e-12)) return 0;
  snprintf(reason, size, "'tension cut-off' lies beyond the tip of the cone, where the normal stresses sum to %g", tip);
  return 1;
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == EQUIVALENT ? "equivalent plastic strain" : "");
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const DruckerPrager *c = constants;
  const double shear = c->elastic.shear, bulk9 = 9 * c->elastic.bulk, x = p->committed[EQUIVALENT];
  double s[6], length, hard, strength;
  const double trial = elastic_trial(&c->elastic, p->strain, p->committed + PLASTIC, s, &length);
  const double radius = root23 * hardening_strength(&c->hardening, x, &hard),
               excess = length + c->slope * trial - radius;
  memcpy(p->trial, p->committed, sizeof(double) * HISTORY);
  double i = trial, returned = length, flow = 0;
  ReturnSlopes slopes = {0};
  if (excess <= 0 && trial <= c->cut) {
    for (int k = 0; k < 6; ++k) p->stress[k] = s[k] + (k < 3 ? i / 3 : 0);
    if (p->tangent) elastic_tangent(&c->elastic, p->tangent);
    return true;
  }
  bool cone = false;
  if (excess > 0) {
    const double stiffness = 2 * shear + bulk9 * c->slope * c->dilation;
    flow = hardening_multiplier(&c->hardening, excess, stiffness, x, &strength, &hard);
    i = trial - bulk9 * c->dilation * flow;
    returned = length - 2 * shear * flow;
    cone = i <= c->cut && returned >= 0;
    const double whole = stiffness + 2 * hard / 3;
    slopes = (ReturnSlopes){1 - bulk9 * c->dilation * c->slope / whole, -bulk9 * c->dilation / whole,
                            -2 * shear * c->slope / whole, 1 - 2 * shear / whole};
  }
  if (!cone) {
    const double at_cut = fmax(0, radius - c->slope * c->cut);
    i = c->cut;
    returned = length;
    flow = 0;
    slopes = (ReturnSlopes){0, 0, 0, 1};
    if (length > at_cut) { /* where the cone meets the cut-off */
      flow = hardening_multiplier(&c->hardening, length - at_cut, 2 * shear, x, &strength, &hard);
      returned = fmax(0, length - 2 * shear * flow);
      slopes.length_length = 1 - 2 * shear / (2 * shear + 2 * hard / 3);
    }
  }
  const double shrink = length > 0 ? returned / length : 0;
  double stress[6];
  for (int k = 0; k < 6; ++k) {
    stress[k] = s[k] * shrink;
    p->stress[k] = stress[k] + (k < 3 ? i / 3 : 0);
  }
  p->trial[EQUIVALENT] = x + root23 * flow;
  plastic_rest(&c->elastic, p->strain, i, stress, p->trial + PLASTIC);
  if (p->tangent) return_tangent(&c->elastic, &slopes, returned, length, s, p->tangent);
  return true;
}

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const DruckerPrager *c = constants;
  const Lanes radius = hardening_least(&c->hardening, trial_history(t, EQUIVALENT));
  *found = (t->length + lanes_set(c->slope) * t->invariant <= radius) & (t->invariant <= lanes_set(c->cut));
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  const DruckerPrager *c = constants;
  return solid_update_elastic_first(constants, batch, HISTORY, &c->elastic, true, inside, update_point);
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
};

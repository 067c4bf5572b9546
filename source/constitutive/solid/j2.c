/* J2 plasticity: the yield stress grows linearly and towards a saturation, the yield surface may travel (docs/theory.md 8.2, Simo and
 * Hughes 1998, ch. 3): |s - b| = sqrt(2/3) Y(x), Y = Y1 + (Y0 - Y1) exp(-d x) + H x, db = 2/3 Hk dg n, dx = sqrt(2/3) dg. */
#include "constitutive/solid/elastic_first.h"
#include "constitutive/solid/hardening.h"

typedef struct J2 {
  Elasticity elastic;
  Hardening hardening;
  double kinematic;
} J2;

enum { YIELD = ELASTIC_PARAMETERS, SATURATION, RATE, HARDENING, KINEMATIC };
/* History: plastic strain, equivalent plastic strain, and the back stress if it can move. */
enum { PLASTIC = 0, EQUIVALENT = 6, BACK = 7 };

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
  if (saturation >= v[YIELD]) return 0;
  snprintf(reason, size, "'saturation stress' must not lie below 'yield stress': this law does not soften");
  return 1;
}

static int history_values(const void *constants)
{
  return ((const J2 *)constants)->kinematic > 0 ? 13 : 7;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == EQUIVALENT ? "equivalent plastic strain" : "");
}

static bool update_point(const void *constants, SolidPoint *p)
{
  const J2 *c = constants;
  const double shear = c->elastic.shear, *old = p->committed;
  const bool travels = c->kinematic > 0;
  double s[6], trial_length, slope, distance[6];
  const double invariant = elastic_trial(&c->elastic, p->strain, old + PLASTIC, s, &trial_length);
  for (int k = 0; k < 6; ++k) distance[k] = s[k] - (travels ? old[BACK + k] : 0);
  const double length = travels ? norm(distance) : trial_length, x = old[EQUIVALENT];
  memcpy(p->trial, old, sizeof(double) * (travels ? 13 : 7));
  double strength = hardening_strength(&c->hardening, x, &slope), radius = root23 * strength;
  if (length <= radius) {
    for (int k = 0; k < 6; ++k) p->stress[k] = s[k] + (k < 3 ? invariant / 3 : 0);
    if (p->tangent) elastic_tangent(&c->elastic, p->tangent);
    return true;
  }
  const double straight = 2 * shear + 2 * c->kinematic / 3;
  const double flow = hardening_multiplier(&c->hardening, length - radius, straight, x, &strength, &slope);
  radius = root23 * strength;
  for (int k = 0; k < 6; ++k) {
    distance[k] /= length;
    const double back = travels ? old[BACK + k] + 2 * c->kinematic / 3 * flow * distance[k] : 0;
    s[k] = back + radius * distance[k];
    if (travels) p->trial[BACK + k] = back;
    p->stress[k] = s[k] + (k < 3 ? invariant / 3 : 0);
  }
  p->trial[EQUIVALENT] = x + root23 * flow;
  plastic_rest(&c->elastic, p->strain, invariant, s, p->trial + PLASTIC);
  if (p->tangent) {
    const double turned = 1 - 2 * shear * flow / length, along = 2 * shear / (straight + 2 * slope / 3);
    solid_tangent(c->elastic.bulk, 0, 0, 2 * shear * (1 - along - turned), 2 * shear * turned, distance, p->tangent);
  }
  return true;
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

LANES_INLINE void inside(const void *constants, const TrialLanes *t, LaneMask *found)
{
  const J2 *c = constants;
  Lanes length = t->length;
  if (c->kinematic > 0) {
    Lanes square = lanes_set(0);
    for (int k = 0; k < 6; ++k) {
      const Lanes distance = t->s[k] - trial_history(t, BACK + k);
      square += lanes_set(k < 3 ? 1 : 2) * distance * distance;
    }
    length = lanes_root(square);
  }
  *found = length <= hardening_least(&c->hardening, trial_history(t, EQUIVALENT));
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  const J2 *c = constants;
  return solid_update_elastic_first(constants, batch, c->kinematic > 0 ? 13 : 7, &c->elastic, true, inside,
                                    update_point);
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
};

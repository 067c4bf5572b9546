/* Multi-yield-surface J2 plasticity for clay (Iwan 1967, Mroz 1967, Prevost 1977; docs/theory.md 8.2): its parameters and what follows
 * from them. multi_yield_step.c integrates it. */
#include "constitutive/solid/multi_yield.h"

#include <stdio.h>
#include <string.h>

enum { P_SHEAR, P_BULK, P_OCTAHEDRAL, P_COHESION, P_PEAK, P_SURFACES, P_FRICTION, P_REFERENCE, P_EXPONENT };

static const breccia_parameter parameters[] = {
    {"shear modulus", "stress", NULL, "(0, inf)", "G at small strain"},
    {"bulk modulus", "stress", NULL, "(0, inf)", "K"},
    {"octahedral strength", "stress", "", "(0, inf)", "largest octahedral shear stress; or give the cohesion"},
    {"cohesion", "stress", "", "(0, inf)",
     "c as OpenSees reads it: octahedral strength = 2 sqrt(2) c / 3 without friction"},
    {"peak octahedral strain", "1", "0.1", "(0, inf)", "octahedral shear strain at which the strength is reached"},
    {"surfaces", "1", "20", "[1, 60]", "number of yield surfaces"},
    {"friction angle", "angle", "0", "[0, 60]", "strength grows with the pressure at the end of the elastic stage"},
    {"reference pressure", "stress", "100 kPa", "(0, inf)", "pressure at which the moduli hold (with friction)"},
    {"pressure exponent", "1", "0", "[0, 2]", "growth of the moduli with pressure (with friction)"},
};

static void reduce_strength(double *v, double factor)
{
  const double degree = acos(-1) / 180;
  v[P_OCTAHEDRAL] /= factor;
  v[P_COHESION] /= factor;
  v[P_FRICTION] = atan(tan(v[P_FRICTION] * degree) / factor) / degree;
}

static int prepare(const double *v, void *constants, char *reason, size_t reason_size)
{
  MultiYield *c = constants;
  memset(c, 0, sizeof *c);
  c->shear = v[P_SHEAR];
  c->bulk = v[P_BULK];
  c->surfaces = (int)v[P_SURFACES];
  c->frictional = v[P_FRICTION] > 0;
  c->reference_pressure = v[P_REFERENCE];
  c->exponent = v[P_EXPONENT];
  if (isnan(v[P_OCTAHEDRAL]) == isnan(v[P_COHESION])) {
    snprintf(reason, reason_size, "give either 'octahedral strength' or 'cohesion'");
    return 1;
  }
  if (v[P_SURFACES] != c->surfaces) {
    snprintf(reason, reason_size, "'surfaces' must be a whole number");
    return 1;
  }
  double strength = isnan(v[P_OCTAHEDRAL]) ? 2 * sqrt(2) / 3 * v[P_COHESION] : v[P_OCTAHEDRAL];
  double height = 1;
  if (c->frictional) {
    if (isnan(v[P_COHESION])) {
      snprintf(reason, reason_size, "with a friction angle the strength is given by 'cohesion'");
      return 1;
    }
    double sine = sin(v[P_FRICTION] * acos(-1) / 180), slope = 6 * sine / (3 - sine);
    c->residual_pressure = 3 * v[P_COHESION] / (sqrt(2) * slope);
    height = c->reference_pressure + c->residual_pressure;
    strength = sqrt(2) * height * slope / 3;
  }
  double peak = v[P_PEAK], shear = c->shear;
  if (shear * peak <= strength) {
    snprintf(
        reason, reason_size,
        "the strength, %g (octahedral), must lie below shear modulus times peak strain, %g: a hyperbola cannot pass "
        "through both",
        strength, shear * peak);
    return 1;
  }
  double plastic_modulus[MOST_SURFACES + 1] = {0};
  double reference_strain = peak * strength / (shear * peak - strength);
  for (int i = 1; i <= c->surfaces; ++i) {
    double tau = strength * i / c->surfaces, next = strength * (i + 1) / c->surfaces;
    c->radius[i] = sqrt(3) * tau;
    c->flow[i] = 1; /* the outermost does not harden */
    if (i == c->surfaces) break;
    double strain = tau * reference_strain / (shear * reference_strain - tau);
    double further = next * reference_strain / (shear * reference_strain - next);
    double chord = 2 * (next - tau) / (further - strain);
    double plastic = 2 * shear * chord / (2 * shear - chord);
    plastic_modulus[i] = plastic < 0 ? 0 : plastic > 1e30 ? 1e30 : plastic;
    c->flow[i] = 2 * shear / (2 * shear + plastic_modulus[i]);
  }
  for (int i = 1; i < c->surfaces; ++i) {
    c->ratio[i] = c->radius[i] / c->radius[i + 1];
    c->step_down[i + 1] =
        plastic_modulus[i] > 0 ? (plastic_modulus[i] - plastic_modulus[i + 1]) / plastic_modulus[i] : 0;
  }
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const MultiYield *c = constants;
  *bulk = c->bulk;
  *shear = c->shear;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == ACTIVE ? "active surface" : "");
}

static void begin(const void *constants, double *history)
{
  memset(history, 0, sizeof(double) * (size_t)multi_yield_history_values(constants));
  history[LOW] = 1; /* an empty range */
  const MultiYield *c = constants;
  if (c->frictional) history[HEAD] = history[HEAD + 1] = 1;
}

const breccia_law law_multi_yield_j2 = {
    .size = sizeof(breccia_law),
    .name = "multi-yield-j2",
    .about = "clay: nested yield surfaces on a hyperbolic backbone, kinematic hardening by Mroz' rule",
    .source = "Iwan 1967, Mroz 1967, Prevost 1977; scheme of OpenSees PressureIndependMultiYield",
    .maturity = "verified against OpenSees PressureIndependMultiYield",
    .equations =
        "backbone τ = G γ / (1 + γ/γᵣ) of octahedral stress and strain, through the strength at the peak strain\n"
        "N nested surfaces √(3/2) ‖s − αₘ‖ = Kₘ, Kₘ = 3 m τ_max / (√2 N), with plastic moduli from the backbone's "
        "chords; the active one moves towards the next (Mroz)\n"
        "pressure: dp = K tr dε, elastic",
    .opensees = "nDMaterial PressureIndependMultiYield",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(MultiYield),
    .components = 6,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = multi_yield_history_values,
    .history_name = history_name,
    .begin = begin,
    .update = multi_yield_update,
    .reduce_strength = reduce_strength,
};

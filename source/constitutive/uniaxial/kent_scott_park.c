/* Concrete without tension (Kent and Park 1971, Scott, Park and Priestley 1982; docs/theory.md 8.7). Confinement enters through the
 * parameters: strength K f_c, peak strain 0.002 K. */
#include "constitutive/uniaxial/concrete.h"

static const breccia_parameter parameters[] = {CONCRETE_PARAMETER_ROWS};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  return concrete_prepare(constants, values, reason, size);
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(concrete_young(constants), bulk, shear);
}

static int history_values(const void *constants)
{
  (void)constants;
  return CONCRETE_HISTORY;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants;
  snprintf(name, size, "%s", k == CONCRETE_LARGEST ? "largest compressive strain" : "");
}

static void begin(const void *constants, double *history)
{
  concrete_begin(concrete_young(constants), history);
}

static double curve(const void *constants, double strain, double *slope)
{
  return concrete_envelope(constants, strain, slope);
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const ConcreteEnvelope *c = constants;
  concrete_without_tension(constants, p, curve, concrete_young(c), c->strain, c->crushed);
}

static int update(const void *constants, const breccia_batch *batch)
{
  return uniaxial_update(constants, batch, CONCRETE_HISTORY, concrete_young(constants), 0, true, update_point);
}

const breccia_law law_kent_scott_park = {
    .size = sizeof(breccia_law),
    .name = "kent-scott-park",
    .about =
        "concrete in compression: parabola, line and residual strength, unloading along lines; no tension (Concrete01)",
    .source = "Kent and Park 1971; Scott, Park and Priestley 1982; Karsan and Jirsa 1969",
    .maturity = "verified against OpenSees Concrete01",
    .equations =
        "compression positive: f_c (2 x − x²), x = ε/ε₀ ≤ 1; a line to the residual strength at ε_u; constant\n"
        "unloading to εₚ/ε₀ = 0.145 x² + 0.13 x, x < 2, else 0.707 (x − 2) + 0.834\n"
        "confined by hoops: K f_c and 0.002 K with K = 1 + ρ_s f_yh/f_c",
    .opensees = "uniaxialMaterial Concrete01",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(ConcreteEnvelope),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};

/* Confined concrete (Mander, Priestley and Park 1988; docs/theory.md 8.7), compression positive inside:
 * f = f_cc x r / (r - 1 + x^r), x = strain / e_cc, r = E / (E - f_cc / e_cc), f_cc and e_cc from the confining pressure. Unloading as
 * in kent-scott-park; nothing is left beyond the crushing strain; no tension. */
#include "constitutive/uniaxial/concrete.h"

typedef struct Mander {
  double young, strength, strain, exponent, crushed;
} Mander;

enum { STRENGTH, PEAK, YOUNG, CONFINEMENT, CRUSHED };

static const breccia_parameter parameters[] = {
    {"compressive strength", "stress", NULL, "(0, inf)", "f_co, unconfined"},
    {"peak strain", "1", "0.002", "(0, inf)", "compressive strain at the unconfined strength"},
    {"Young modulus", "stress", NULL, "(0, inf)", "E"},
    {"confining pressure", "stress", "0", "[0, inf)", "f_l, effective lateral pressure of the hoops at yield"},
    {"crushing strain", "1", "", "(0, inf)",
     "beyond which nothing is left; four times the confined peak strain when absent"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Mander *c = constants;
  const double relative = v[CONFINEMENT] / v[STRENGTH], gain = 2.254 * sqrt(1 + 7.94 * relative) - 2 * relative - 1.254;
  c->young = v[YOUNG];
  c->strength = gain * v[STRENGTH];
  c->strain = v[PEAK] * (1 + 5 * (gain - 1));
  c->crushed = isnan(v[CRUSHED]) ? 4 * c->strain : v[CRUSHED];
  const double secant = c->strength / c->strain;
  c->exponent = c->young / (c->young - secant);
  if (c->young <= secant)
    snprintf(reason, size, "'Young modulus' must be larger than strength over strain at the confined peak, %g", secant);
  else if (c->crushed <= c->strain)
    snprintf(reason, size, "'crushing strain' must be larger than the confined peak strain, %g", c->strain);
  else
    return 0;
  return 1;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Mander *)constants)->young, bulk, shear);
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
  concrete_begin(((const Mander *)constants)->young, history);
}

static double curve(const void *constants, double strain, double *slope)
{
  const Mander *c = constants;
  *slope = 0;
  if (strain > c->crushed) return 0;
  const double x = strain / c->strain, r = c->exponent, power = pow(x, r), below = r - 1 + power;
  *slope = c->strength * r / c->strain * (r - 1) * (1 - power) / (below * below);
  return c->strength * x * r / below;
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const Mander *c = constants;
  concrete_without_tension(constants, p, curve, c->young, c->strain, c->crushed);
}

static int update(const void *constants, const breccia_batch *batch)
{
  return uniaxial_update(constants, batch, CONCRETE_HISTORY, ((const Mander *)constants)->young, 0, true, update_point);
}

const breccia_law law_mander = {
    .size = sizeof(breccia_law),
    .name = "mander",
    .about = "confined concrete in compression, unloading along lines; no tension",
    .source = "Mander, Priestley and Park 1988; Karsan and Jirsa 1969",
    .maturity = "verified against its closed form",
    .equations = "compression positive: f_cc x r/(r − 1 + xʳ), x = ε/ε_cc, r = E/(E − f_cc/ε_cc)\n"
                 "f_cc = f_co (2.254 √(1 + 7.94 f_l/f_co) − 2 f_l/f_co − 1.254), ε_cc = ε_co (1 + 5 (f_cc/f_co − 1)); "
                 "unloading as kent-scott-park",
    .opensees = "uniaxialMaterial Concrete04 (similar)",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Mander),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};

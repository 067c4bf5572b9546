/* Softening that begins steeply and has a long straight tail (Hobbs 2021; docs/theory.md 2): with x = 0 at the peak and 1 at the end,
 * stress / strength = (1 - (1 - e^-kx) / (1 - e^-k) + alpha (1 - x)) / (1 + alpha). */
#include "constitutive/uniaxial/softening.h"

typedef struct Exponential {
  Softening curve;
  double decay, tail;
} Exponential;

enum { DECAY = SOFTENING_PARAMETERS, TAIL };

static const breccia_parameter parameters[] = {
    SOFTENING_PARAMETER_ROWS,
    {"decay", "1", "25", "(0, inf)", "k, how steeply the stress falls at first"},
    {"tail", "1", "0.25", "[0, inf)", "alpha, weight of the straight tail"},
};

static double envelope(const void *constants, double x, double *slope)
{
  const Exponential *c = constants;
  double fall = exp(-c->decay * x), whole = -expm1(-c->decay);
  *slope = -(c->decay * fall / whole + c->tail) / (1 + c->tail);
  return (1 - (1 - fall) / whole + c->tail * (1 - x)) / (1 + c->tail);
}

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  Exponential *c = constants;
  double k = values[DECAY], alpha = values[TAIL];
  c->decay = k;
  c->tail = alpha;
  double area = (alpha / 2 + 1 + 1 / expm1(-k) + 1 / k) / (1 + alpha);
  return softening_prepare(&c->curve, values, area, reason, size);
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Exponential *)constants)->curve.young, bulk, shear);
}

static double failure_strain(const void *constants)
{
  return ((const Exponential *)constants)->curve.end;
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  return softening_update(constants, &((const Exponential *)constants)->curve, envelope, batch);
}

const breccia_law law_exponential_softening = {
    .size = sizeof(breccia_law),
    .name = "exponential-softening",
    .about = "a straight line up to the strength, then an exponential fall with a long straight tail; elastic in "
             "compression",
    .source = "Hobbs 2021; docs/theory.md 2",
    .maturity = "verified against its closed form",
    .equations = "σ/f_t = (1 − (1 − e^(−k x))/(1 − e^(−k)) + α (1 − x))/(1 + α), x from the peak to the end; area "
                 "G_F/l; unloading to the origin",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Exponential),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .failure_strain = failure_strain,
    .softening_energy = softening_start,
    .history_values = softening_history_values,
    .history_name = softening_history_name,
    .history_is_damage = softening_history_is_damage,
    .update = update,
    .never_crushes = law_never_crushes,
};

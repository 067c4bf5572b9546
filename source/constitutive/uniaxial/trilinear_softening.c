/* A straight line up to the strength and two down (Petersson 1981): fast to the kink, slowly from there to nothing. */
#include "constitutive/uniaxial/softening.h"

typedef struct Trilinear {
  Softening curve;
  double stress, place; /* of the kink, over the strength and from peak to end */
} Trilinear;

enum { STRESS = SOFTENING_PARAMETERS, PLACE };

static const breccia_parameter parameters[] = {
    SOFTENING_PARAMETER_ROWS,
    {"kink stress", "1", "0.3333333333333333", "(0, 1)", "at the kink, over the strength"},
    {"kink place", "1", "0.2222222222222222", "(0, 1)", "0 at the peak, 1 where nothing is left"},
};

static double envelope(const void *constants, double x, double *slope)
{
  const Trilinear *c = constants;
  const bool first = x < c->place;
  *slope = first ? (c->stress - 1) / c->place : -c->stress / (1 - c->place);
  return first ? 1 + *slope * x : *slope * (x - 1);
}

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  Trilinear *c = constants;
  c->stress = values[STRESS];
  c->place = values[PLACE];
  if (c->stress > 1 - c->place) {
    snprintf(reason, size,
             "the kink must lie below the straight line from peak to end: 'kink stress' at most 1 - 'kink place'");
    return 1;
  }
  return softening_prepare(&c->curve, values, (c->place + c->stress) / 2, reason, size);
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Trilinear *)constants)->curve.young, bulk, shear);
}

static double failure_strain(const void *constants)
{
  return ((const Trilinear *)constants)->curve.end;
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  return softening_update(constants, &((const Trilinear *)constants)->curve, envelope, batch);
}

const breccia_law law_trilinear_softening = {
    .size = sizeof(breccia_law),
    .name = "trilinear-softening",
    .about = "a straight line up to the strength and two down, the first steeper; elastic in compression",
    .source = "Petersson 1981",
    .maturity = "verified against its closed form",
    .equations = "σ = E ε up to f_t, a line to the kink and a line to 0; area G_F/l; unloading to the origin",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Trilinear),
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

/* A straight line up to the strength and a straight line down. */
#include "constitutive/uniaxial/softening.h"

static const breccia_parameter parameters[] = {SOFTENING_PARAMETER_ROWS};

static double envelope(const void *constants, double x, double *slope)
{
  (void)constants;
  *slope = -1;
  return 1 - x;
}

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  return softening_prepare(constants, values, 0.5, reason, size);
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Softening *)constants)->young, bulk, shear);
}

static double failure_strain(const void *constants)
{
  return ((const Softening *)constants)->end;
}

BRECCIA_CLONES
static int update(const void *constants, const breccia_batch *batch)
{
  return softening_update(constants, constants, envelope, batch);
}

const breccia_law law_bilinear_softening = {
    .size = sizeof(breccia_law),
    .name = "bilinear-softening",
    .about = "a straight line up to the strength and a straight one down to nothing; elastic in compression",
    .source = "docs/theory.md 2 (linear softening of bonds)",
    .maturity = "verified against its closed form",
    .equations = "σ = E ε up to f_t, then a line to 0; area G_F/l; unloading to the origin",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Softening),
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

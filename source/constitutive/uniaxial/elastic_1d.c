/* Linear elasticity along one direction. */
#include "constitutive/law.h"

typedef struct Elastic1d {
  double young;
} Elastic1d;

static const breccia_parameter parameters[] = {
    {"Young modulus", "stress", NULL, "(0, inf)", "E"},
};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)reason, (void)size;
  *(Elastic1d *)constants = (Elastic1d){values[0]};
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const Elastic1d *c = constants;
  uniaxial_moduli(c->young, bulk, shear);
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Elastic1d *c = constants;
  for (int i = 0; i < batch->count; ++i) batch->stress[0][i] = c->young * batch->strain[0][i];
  for (int i = 0; batch->tangent && i < batch->count; ++i) batch->tangent[i] = c->young;
  return -1;
}

const breccia_law law_elastic_1d = {
    .size = sizeof(breccia_law),
    .name = "elastic-1d",
    .about = "linear elasticity along one direction",
    .source = "Hooke's law",
    .maturity = "verified against its closed form",
    .equations = "σ = E ε",
    .opensees = "uniaxialMaterial Elastic",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Elastic1d),
    .components = 1,
    .linear = 1,
    .prepare = prepare,
    .moduli = moduli,
    .update = update,
    .never_crushes = law_never_crushes,
};

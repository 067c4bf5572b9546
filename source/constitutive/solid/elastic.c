/* Linear isotropic elasticity (docs/theory.md 8.1). */
#include "constitutive/solid/solid_law.h"

#include "base/lanes.h"

static const breccia_parameter parameters[] = {ELASTIC_PARAMETER_ROWS};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  return elasticity_prepare(constants, values, reason, size);
}

BRECCIA_CLONES
static void stresses(const Elasticity *c, const breccia_batch *batch)
{
  double lambda = c->bulk - 2 * c->shear / 3, shear = c->shear;
  const double *const *strain = batch->strain;
  double *const *stress = batch->stress;
  LANES_INDEPENDENT
  for (int i = 0; i < batch->count; ++i) {
    double volumetric = lambda * (strain[0][i] + strain[1][i] + strain[2][i]);
    for (int k = 0; k < 3; ++k) stress[k][i] = volumetric + 2 * shear * strain[k][i];
    for (int k = 3; k < 6; ++k) stress[k][i] = shear * strain[k][i];
  }
}

static int update(const void *constants, const breccia_batch *batch)
{
  stresses(constants, batch);
  for (int i = 0; batch->tangent && i < batch->count; ++i) elastic_tangent(constants, batch->tangent + 36 * i);
  return -1;
}

const breccia_law law_elastic = {
    .size = sizeof(breccia_law),
    .name = "elastic",
    .about = "linear isotropic elasticity",
    .linear = 1,
    .source = "Hooke's law",
    .maturity = "verified against OpenSees ElasticIsotropic3D",
    .equations = "σ = λ tr(ε) 1 + 2 G ε, λ = K − 2G/3",
    .opensees = "nDMaterial ElasticIsotropic",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Elasticity),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .update = update,
    .never_crushes = law_never_crushes,
};

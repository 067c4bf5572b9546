/* Linear isotropic elasticity (docs/theory.md 8.1). */
#include "constitutive/law.h"

#include "base/lanes.h"
#include <math.h>
#include <stdio.h>

typedef struct Elastic {
  double lambda, shear, bulk;
} Elastic;

enum { YOUNG, POISSON, BULK, SHEAR };

static const breccia_parameter parameters[] = {
    {"Young modulus", "stress", "", "(0, inf)", "E; goes with the Poisson ratio"},
    {"Poisson ratio", "1", "", "(-1, 0.5)", "nu; goes with the Young modulus"},
    {"bulk modulus", "stress", "", "(0, inf)", "K; goes with the shear modulus"},
    {"shear modulus", "stress", "", "(0, inf)", "G; goes with the bulk modulus"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Elastic *c = constants;
  int young = !isnan(v[YOUNG]) + !isnan(v[POISSON]), bulk = !isnan(v[BULK]) + !isnan(v[SHEAR]);
  if (!((young == 2 && !bulk) || (bulk == 2 && !young))) {
    snprintf(reason, size, "give 'Young modulus' and 'Poisson ratio', or 'bulk modulus' and 'shear modulus'");
    return 1;
  }
  c->shear = young ? v[YOUNG] / (2 * (1 + v[POISSON])) : v[SHEAR];
  c->bulk = young ? v[YOUNG] / (3 * (1 - 2 * v[POISSON])) : v[BULK];
  c->lambda = c->bulk - 2 * c->shear / 3;
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  const Elastic *c = constants;
  *bulk = c->bulk;
  *shear = c->shear;
}

BRECCIA_CLONES
static void stresses(const Elastic *c, const breccia_batch *batch)
{
  double lambda = c->lambda, shear = c->shear;
  const double *const *strain = batch->strain;
  double *const *stress = batch->stress;
#pragma omp simd
  for (int i = 0; i < batch->count; ++i) {
    double volumetric = lambda * (strain[0][i] + strain[1][i] + strain[2][i]);
    for (int k = 0; k < 3; ++k) stress[k][i] = volumetric + 2 * shear * strain[k][i];
    for (int k = 3; k < 6; ++k) stress[k][i] = shear * strain[k][i];
  }
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Elastic *c = constants;
  stresses(c, batch);
  for (int i = 0; batch->tangent && i < batch->count; ++i)
    for (int r = 0; r < 6; ++r)
      for (int k = 0; k < 6; ++k)
        batch->tangent[36 * i + 6 * r + k] =
            (r < 3 && k < 3 ? c->lambda : 0) + (r == k ? (r < 3 ? 2 : 1) * c->shear : 0);
  return -1;
}

const breccia_law law_elastic = {
    .name = "elastic",
    .about = "linear isotropic elasticity",
    .source = "Hooke's law",
    .maturity = "verified against OpenSees ElasticIsotropic3D",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Elastic),
    .prepare = prepare,
    .moduli = moduli,
    .update = update,
};

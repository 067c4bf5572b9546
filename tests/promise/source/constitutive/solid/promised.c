/* A law as somebody would add one. */
#include "constitutive/law.h"

static const breccia_parameter parameters[] = {
    {"promised modulus", "stress", NULL, "(0, inf)", "Young modulus; Poisson ratio 1/4"}};

static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  (void)reason, (void)size;
  *(double *)constants = values[0];
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(*(const double *)constants, bulk, shear);
}

static int update(const void *constants, const breccia_batch *batch)
{
  double bulk, shear;
  moduli(constants, &bulk, &shear);
  for (int i = 0; i < batch->count; ++i) {
    const double volumetric = batch->strain[0][i] + batch->strain[1][i] + batch->strain[2][i];
    for (int k = 0; k < 6; ++k)
      batch->stress[k][i] =
          k < 3 ? 2 * shear * batch->strain[k][i] + (bulk - 2 * shear / 3) * volumetric : shear * batch->strain[k][i];
  }
  return -1;
}

const breccia_law law_promised = {.size = sizeof(breccia_law),
                                  .name = "promised",
                                  .about = "linear elasticity once more",
                                  .source = "tests/promise",
                                  .maturity = "experimental",
                                  LAW_PARAMETERS(parameters),
                                  .constants_size = sizeof(double),
                                  .components = 6,
                                  .linear = 1,
                                  .prepare = prepare,
                                  .moduli = moduli,
                                  .update = update};

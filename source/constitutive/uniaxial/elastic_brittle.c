/* Linear until it breaks: the prototype microelastic brittle law of a bond (Silling and Askari 2005). */
#include "constitutive/law.h"

#include <math.h>
#include <stdio.h>

typedef struct Brittle {
  double young, limit;
} Brittle;

enum { YOUNG, STRENGTH, ENERGY, LENGTH };

static const breccia_parameter parameters[] = {
    {"Young modulus", "stress", NULL, "(0, inf)", "E"},
    {"tensile strength", "stress", "", "(0, inf)", "f_t; or give the fracture energy"},
    {"fracture energy", "fracture energy", "", "(0, inf)", "G_F per area of crack, from which the strength follows"},
    {"length", "length", "", "(0, inf)",
     "over which the fracture energy is spread; that of the formulation when absent"},
};

/** E s^2 / 2 = G_F / length. */
static int prepare(const double *values, void *constants, char *reason, size_t size)
{
  Brittle *c = constants;
  *c = (Brittle){values[YOUNG], values[STRENGTH] / values[YOUNG]};
  if (isnan(values[STRENGTH]) == isnan(values[ENERGY])) {
    snprintf(reason, size, "give either 'tensile strength' or 'fracture energy'");
    return 1;
  }
  if (!isnan(values[STRENGTH])) return 0;
  if (isnan(values[LENGTH])) {
    snprintf(reason, size, "a fracture energy needs the 'length' over which it is spread");
    return 1;
  }
  c->limit = sqrt(2 * values[ENERGY] / (values[YOUNG] * values[LENGTH]));
  return 0;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Brittle *)constants)->young, bulk, shear);
}

static double failure_strain(const void *constants)
{
  return ((const Brittle *)constants)->limit;
}

static int history_values(const void *constants)
{
  (void)constants;
  return 1;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants, (void)k;
  snprintf(name, size, "bond damage");
}

static int history_is_damage(const void *constants, int k)
{
  (void)constants;
  return k == 0;
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Brittle *c = constants;
  for (int i = 0; i < batch->count; ++i) {
    double strain = batch->strain[0][i];
    batch->trial[i] = !batch->elastic_stage && strain > c->limit ? 1 : batch->committed[i];
    double young = batch->elastic_stage || batch->trial[i] == 0 ? c->young : 0;
    batch->stress[0][i] = young * strain;
    if (batch->tangent) batch->tangent[i] = young;
  }
  return -1;
}

const breccia_law law_elastic_brittle = {
    .size = sizeof(breccia_law),
    .name = "elastic-brittle",
    .about = "linear until it breaks for good, by strength or fracture energy; a broken point carries nothing",
    .source = "Silling and Askari 2005",
    .maturity = "verified against its closed form",
    .equations = "σ = E ε up to f_t or to E s²/2 = G_F/l, then nothing for good",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Brittle),
    .components = 1,
    .linear = 1,
    .prepare = prepare,
    .moduli = moduli,
    .failure_strain = failure_strain,
    .history_values = history_values,
    .history_name = history_name,
    .history_is_damage = history_is_damage,
    .update = update,
    .never_crushes = law_never_crushes,
};

/* Elastic up to two yield stresses, plastic beyond. */
#include "constitutive/uniaxial/uniaxial_law.h"

typedef struct Perfect {
  double young, tension, compression, shift;
} Perfect;

enum { YOUNG, TENSION, COMPRESSION, SHIFT };

static const breccia_parameter parameters[] = {
    {"Young modulus", "stress", NULL, "(0, inf)", "E"},
    {"yield stress", "stress", NULL, "(0, inf)", "in tension"},
    {"compressive yield stress", "stress", "", "(0, inf)", "in compression; as in tension when absent"},
    {"initial strain", "1", "0", NULL, "at which the stress is nothing at first"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  const Perfect c = {v[YOUNG], v[TENSION], isnan(v[COMPRESSION]) ? v[TENSION] : v[COMPRESSION], v[SHIFT]};
  const double begun = -c.young * c.shift, least = -(1 + 1e-9) * c.compression, most = (1 + 1e-9) * c.tension;
  *(Perfect *)constants = c;
  if (begun >= least && begun <= most) return 0;
  snprintf(reason, size,
           "'initial strain' makes a stress of %.4g at first, beyond the yield stress; take one from %.4g to %.4g",
           begun, -c.tension / c.young, c.compression / c.young);
  return 1;
}

static void moduli(const void *constants, double *bulk, double *shear)
{
  uniaxial_moduli(((const Perfect *)constants)->young, bulk, shear);
}

static int history_values(const void *constants)
{
  (void)constants;
  return 1;
}

static void history_name(const void *constants, int k, char *name, size_t size)
{
  (void)constants, (void)k;
  snprintf(name, size, "plastic strain");
}

static void begin(const void *constants, double *history)
{
  *history = ((const Perfect *)constants)->shift;
}

static void update_point(const void *constants, UniaxialPoint *p)
{
  const Perfect *c = constants;
  const double trial = c->young * (p->strain - p->committed[0]);
  p->stress = uniaxial_between(-c->compression, trial, c->tension);
  /* A point that stands at yield, roundings apart, counts as plastic. */
  const double room = c->tension - trial < c->compression + trial ? c->tension - trial : c->compression + trial;
  p->tangent = room > c->young * 2.3e-16 ? c->young : 0;
  if (p->stress != trial) p->trial[0] = p->strain - p->stress / c->young;
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Perfect *c = constants;
  return uniaxial_update(c, batch, 1, c->young, c->shift, false, update_point);
}

const breccia_law law_elastic_perfectly_plastic = {
    .size = sizeof(breccia_law),
    .name = "elastic-perfectly-plastic",
    .about = "elastic up to a yield stress in tension and another in compression (ElasticPP)",
    .source = "Prandtl 1928",
    .maturity = "verified against OpenSees ElasticPP",
    .equations = "σ = E (ε − εᵖ) between −f_y⁻ and f_y",
    .opensees = "uniaxialMaterial ElasticPP",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Perfect),
    .components = 1,
    .prepare = prepare,
    .moduli = moduli,
    .history_values = history_values,
    .history_name = history_name,
    .begin = begin,
    .update = update,
};

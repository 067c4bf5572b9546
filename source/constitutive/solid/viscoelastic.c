/* Elastic volume, and a deviator of which a share relaxes: the standard linear solid, a spring beside a spring and a dashpot in series
 * (docs/theory.md 8.1). With the deviatoric strain e and that of the dashpot v, s = 2 G (e - lambda v) and dv/dt = (e - v) / tau, which is solved
 * exactly for strains that grow evenly in a step. */
#include "constitutive/solid/solid_law.h"

typedef struct Viscoelastic {
  Elasticity elastic;
  double share, time;
} Viscoelastic;

enum { SHARE = ELASTIC_PARAMETERS, TIME };
enum { DASHPOT = 0, DEVIATOR = 6, HISTORY = 12 };

static const breccia_parameter parameters[] = {
    ELASTIC_PARAMETER_ROWS,
    {"relaxing share", "1", NULL, "[0, 1)", "lambda, of the shear modulus at once, which is gone after a long time"},
    {"relaxation time", "time", NULL, "(0, inf)",
     "tau, in which a stress at constant strain falls by 1 - 1 / e of that share"},
};

static int prepare(const double *v, void *constants, char *reason, size_t size)
{
  Viscoelastic *c = constants;
  c->share = v[SHARE];
  c->time = v[TIME];
  return elasticity_prepare(&c->elastic, v, reason, size);
}

static int history_values(const void *constants)
{
  (void)constants;
  return HISTORY;
}

/** One point. @param[in] gone, late  1 - e^-x and 1 - gone / x for x = time step / tau */
static void update_point(const Viscoelastic *c, const breccia_batch *batch, int i, double gone, double late)
{
  const double *old = batch->committed + HISTORY * i;
  double *new = batch->trial + HISTORY *i, strain[6], e[6];
  for (int k = 0; k < 6; ++k) strain[k] = batch->strain[k][i] * (k < 3 ? 1 : 0.5);
  deviator(strain, e);
  for (int k = 0; k < 6; ++k) {
    const double before = old[DEVIATOR + k];
    new[DASHPOT + k] = old[DASHPOT + k] * (1 - gone) + before *gone + late *(e[k] - before);
    new[DEVIATOR + k] = e[k];
    if (batch->elastic_stage) { /* the history is kept */
      new[DASHPOT + k] = old[DASHPOT + k];
      new[DEVIATOR + k] = before;
    }
    batch->stress[k][i] =
        2 * c->elastic.shear * (e[k] - c->share * new[DASHPOT + k]) + (k < 3 ? c->elastic.bulk * trace(strain) : 0);
  }
  static const double none[6];
  const double shear = c->elastic.shear * (1 - (batch->elastic_stage ? 0 : c->share * late));
  if (batch->tangent) solid_tangent(c->elastic.bulk, 0, 0, 0, 2 * shear, none, batch->tangent + 36 * i);
}

static int update(const void *constants, const breccia_batch *batch)
{
  const Viscoelastic *c = constants;
  const double times = batch->time_step / c->time, gone = -expm1(-times), late = times > 0 ? 1 - gone / times : 0;
  for (int i = 0; i < batch->count; ++i) update_point(c, batch, i, gone, late);
  return -1;
}

static int deviator_of(const void *constants, breccia_deviator *d, char *reason, size_t size)
{
  const Viscoelastic *c = constants;
  (void)reason;
  (void)size;
  *d = (breccia_deviator){.yield_stress = INFINITY, .relaxing = c->share, .relaxation_time = c->time};
  return 0;
}

const breccia_law law_viscoelastic = {
    .size = sizeof(breccia_law),
    .name = "viscoelastic",
    .about = "elastic volume, and a deviator of which a share relaxes (standard linear solid)",
    .source = "Simo and Hughes 1998, ch. 10",
    .maturity = "verified against closed forms",
    .equations = "s = 2 G (e − λ v), v̇ = (e − v)/τ; p = K tr(ε); e the deviatoric strain",
    LAW_PARAMETERS(parameters),
    .constants_size = sizeof(Viscoelastic),
    .components = 6,
    .prepare = prepare,
    .moduli = elasticity_moduli,
    .history_values = history_values,
    .update = update,
    .deviator = deviator_of,
    .takes_time = 1,
    .never_crushes = law_never_crushes,
};

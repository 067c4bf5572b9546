#include "solver/stiffness_damping.h"

#include "base/team.h"
#include "solver/vectors.h"
#include <math.h>
#include <string.h>

int stiffness_damping_create(StiffnessDamping *s, double time, const Domain *d, Error *error)
{
  static const char label[] = "stiffness damping";
  const Particles *p = d->particles;
  s->time = time;
  if (!(time > 0)) return BRECCIA_OK;
  const bool made = !aside_create(&s->aside, d, label, error) && vectors_make(s->drag, p, label, error) &&
                    vectors_make(s->left, p, label, error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

void stiffness_damping_destroy(StiffnessDamping *s)
{
  aside_destroy(&s->aside);
  vectors_free(s->drag);
  vectors_free(s->left);
}

size_t stiffness_damping_bytes(const StiffnessDamping *s, const Domain *d)
{
  return (s->drag[0] ? 2 * vectors_bytes(d->particles) : 0) + aside_bytes(&s->aside, d);
}

/** Elastic forces at these displacements. */
static void evaluate(StiffnessDamping *s, Domain *d, double *const at[MOTIONS])
{
  for (int k = 0; k < d->particles->motions; ++k)
    memcpy(s->aside.displacement[k], at[k], sizeof(double) * (size_t)d->particles->places);
  aside_exchange(&s->aside, d);
  domain_evaluate(d);
  aside_exchange(&s->aside, d);
}

void stiffness_damping_find(StiffnessDamping *s, Domain *d, double *const was[MOTIONS], double step)
{
  const size_t bytes = sizeof(double) * (size_t)d->particles->places;
  const bool elastic = domain_in_elastic_stage(d), linear = domain_is_elastic(d);
  domain_set_elastic_stage(d, true);
  if (!linear) evaluate(s, d, was); /* else they are those that the body has */
  for (int k = 0; k < d->particles->motions; ++k)
    memcpy(s->drag[k], linear ? d->particles->internal[k] : s->aside.internal[k], bytes);
  evaluate(s, d, d->particles->displacement);
  domain_set_elastic_stage(d, elastic);
  vectors_combine(d, s->time / step, s->drag, -s->time / step, s->aside.internal);
}

static void exchange_forces(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->motions; ++k) {
    double *f = d->particles->internal[k];
    d->particles->internal[k] = s->left[k];
    s->left[k] = f;
  }
}

void stiffness_damping_take_off(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places) s->left[k][i] = d->particles->internal[k][i] - s->drag[k][i];
  TEAM_SINGLE exchange_forces(s, d);
}

void stiffness_damping_put_back(StiffnessDamping *s, Domain *d)
{
  TEAM_SINGLE exchange_forces(s, d);
}

/** Velocity lags behind by half a step: the fastest vibration turns over from step to step where dt^2 w^2 + 2 b w^2 dt = 4. */
double stiffness_damping_step(double time, double stable)
{
  return sqrt(time * time + stable * stable) - time;
}

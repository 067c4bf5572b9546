#include "solver/stiffness_damping.h"

#include "base/team.h"
#include "solver/vectors.h"
#include <math.h>

int stiffness_damping_create(StiffnessDamping *s, double time, const Domain *d, Error *error)
{
  static const char label[] = "stiffness damping";
  const Particles *p = d->particles;
  s->time = time;
  if (!(time > 0)) return BRECCIA_OK;
  const bool made = !tensor_copy_create(&s->tensors, d, label, error) && vectors_make(s->was, p, label, error) &&
                    vectors_make(s->force, p, label, error) && vectors_make(s->drag, p, label, error) &&
                    vectors_make(s->left, p, label, error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

void stiffness_damping_destroy(StiffnessDamping *s)
{
  tensor_copy_destroy(&s->tensors);
  vectors_free(s->was);
  vectors_free(s->force);
  vectors_free(s->drag);
  vectors_free(s->left);
}

size_t stiffness_damping_bytes(const StiffnessDamping *s, const Domain *d)
{
  return (s->drag[0] ? 4 * vectors_bytes(d->particles) : 0) + tensor_copy_bytes(&s->tensors);
}

void stiffness_damping_note(StiffnessDamping *s, const Domain *d)
{
  vectors_combine(d, 0, s->was, 1, d->particles->displacement);
}

void stiffness_damping_find(StiffnessDamping *s, Domain *d, double step)
{
  const bool elastic = domain_in_elastic_stage(d), linear = domain_is_elastic(d);
  tensor_copy_save(&s->tensors, d);
  domain_set_elastic_stage(d, true);
  if (!linear) domain_evaluate(d, &(Evaluation){.displacement = s->was, .internal = s->drag});
  if (linear) vectors_combine(d, 0, s->drag, 1, d->particles->internal);
  domain_evaluate(d, &(Evaluation){.displacement = d->particles->displacement, .internal = s->force});
  domain_set_elastic_stage(d, elastic);
  tensor_copy_restore(&s->tensors, d);
  vectors_combine(d, s->time / step, s->drag, -s->time / step, s->force);
}

void stiffness_damping_take_off(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places) {
      s->left[k][i] = d->particles->internal[k][i];
      d->particles->internal[k][i] -= s->drag[k][i];
    }
}

void stiffness_damping_put_back(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places) d->particles->internal[k][i] = s->left[k][i];
}

/** Velocity lags behind by half a step: the fastest vibration turns over from step to step where dt^2 w^2 + 2 b w^2 dt = 4. */
double stiffness_damping_step(double time, double stable)
{
  return sqrt(time * time + stable * stable) - time;
}

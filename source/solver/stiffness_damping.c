#include "solver/stiffness_damping.h"

#include "base/team.h"
#include <math.h>

int stiffness_damping_create(StiffnessDamping *s, double time, const Domain *d, Error *error)
{
  static const char label[] = "stiffness damping";
  const Particles *p = d->particles;
  s->time = time;
  if (!(time > 0)) return BRECCIA_OK;
  const bool made =
      !tensor_copy_create(&s->tensors, d, label, error) && vector_create(&s->was, &p->space, label, error) &&
      vector_create(&s->force, &p->space, label, error) && vector_create(&s->drag, &p->space, label, error) &&
      vector_create(&s->left, &p->space, label, error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

void stiffness_damping_destroy(StiffnessDamping *s)
{
  tensor_copy_destroy(&s->tensors);
  vector_destroy(&s->was);
  vector_destroy(&s->force);
  vector_destroy(&s->drag);
  vector_destroy(&s->left);
}

size_t stiffness_damping_bytes(const StiffnessDamping *s, const Domain *d)
{
  return (s->drag.row[0] ? 4 * vector_bytes(&d->particles->space) : 0) + tensor_copy_bytes(&s->tensors);
}

void stiffness_damping_note(StiffnessDamping *s, const Domain *d)
{
  vector_copy(&s->was, &d->particles->displacement);
}

void stiffness_damping_find(StiffnessDamping *s, Domain *d, double step)
{
  const bool elastic = domain_in_elastic_stage(d), linear = domain_is_elastic(d);
  tensor_copy_save(&s->tensors, d);
  domain_set_elastic_stage(d, true);
  if (!linear) domain_evaluate(d, &(Evaluation){.displacement = &s->was, .internal = &s->drag});
  if (linear) vector_copy(&s->drag, &d->particles->internal);
  domain_evaluate(d, &(Evaluation){.displacement = &d->particles->displacement, .internal = &s->force});
  domain_set_elastic_stage(d, elastic);
  tensor_copy_restore(&s->tensors, d);
  vector_combine(s->time / step, &s->drag, -s->time / step, &s->force);
}

void stiffness_damping_take_off(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->space.rows; ++k)
    TEAM_FOR (i, d->particles->places) {
      s->left.row[k][i] = d->particles->internal.row[k][i];
      d->particles->internal.row[k][i] -= s->drag.row[k][i];
    }
}

void stiffness_damping_put_back(StiffnessDamping *s, Domain *d)
{
  for (int k = 0; k < d->particles->space.rows; ++k)
    TEAM_FOR (i, d->particles->places) d->particles->internal.row[k][i] = s->left.row[k][i];
}

/** Velocity lags behind by half a step: the fastest vibration turns over from step to step where dt^2 w^2 + 2 b w^2 dt = 4. */
double stiffness_damping_step(double time, double stable)
{
  return sqrt(time * time + stable * stable) - time;
}

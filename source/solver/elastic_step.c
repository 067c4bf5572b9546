#include "solver/elastic_step.h"

#include <math.h>
#include <string.h>

int elastic_step_create(ElasticStep *s, const Domain *d, Error *error)
{
  const bool made = vector_create(&s->force, &d->particles->space, "elastic stiffness", error) &&
                    vector_create(&s->tried, &d->particles->space, "elastic stiffness", error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

size_t elastic_step_bytes(const Particles *p)
{
  return 2 * vector_bytes(&p->space);
}

void elastic_step_destroy(ElasticStep *s)
{
  vector_destroy(&s->force);
  vector_destroy(&s->tried);
}

/** Forces of an elastic body. */
static void evaluate(Domain *d, const Vector *at, const Vector *force)
{
  const bool elastic = domain_in_elastic_stage(d);
  domain_set_elastic_stage(d, true);
  domain_evaluate(d, &(Evaluation){.displacement = at, .internal = force});
  domain_set_elastic_stage(d, elastic);
}

void elastic_step_prepare(ElasticStep *s, Domain *d)
{
  evaluate(d, &d->particles->displacement, &s->force);
}

void elastic_step_apply(const ElasticStep *s, Domain *d, const Vector *v, const Vector *change)
{
  /* 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  const double length = d->body.largest_spacing, largest = fmax(vector_largest(v), length * vector_largest_rotation(v)),
               h = largest > 0 ? 1e-7 * length / largest : 1;
  vector_copy(&s->tried, &d->particles->displacement);
  vector_combine(1, &s->tried, h, v);
  evaluate(d, &s->tried, change);
  vector_combine(1 / h, change, -1 / h, &s->force);
}

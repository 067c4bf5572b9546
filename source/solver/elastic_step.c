#include "solver/elastic_step.h"

#include "solver/vectors.h"
#include <math.h>
#include <string.h>

int elastic_step_create(ElasticStep *s, const Domain *d, Error *error)
{
  const bool made = vectors_make(s->force, d->particles, "elastic stiffness", error) &&
                    vectors_make(s->tried, d->particles, "elastic stiffness", error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

size_t elastic_step_bytes(const Particles *p)
{
  return 2 * vectors_bytes(p);
}

void elastic_step_destroy(ElasticStep *s)
{
  vectors_free(s->force);
  vectors_free(s->tried);
}

/** Forces of an elastic body. */
static void evaluate(Domain *d, double *const at[MOTIONS], double *const force[MOTIONS])
{
  const bool elastic = domain_in_elastic_stage(d);
  domain_set_elastic_stage(d, true);
  domain_evaluate(d, &(Evaluation){.displacement = at, .internal = force});
  domain_set_elastic_stage(d, elastic);
}

void elastic_step_prepare(ElasticStep *s, Domain *d)
{
  evaluate(d, d->particles->displacement, s->force);
}

/** Of displacements, and of rotations over a spacing. */
static double largest_of(const Domain *d, double *const v[MOTIONS])
{
  double largest = 0;
  for (int k = 0; k < d->particles->motions; ++k) {
    const double length = k < ROTATION ? 1 : d->body.largest_spacing;
    for (int64_t i = 0; i < d->particles->places; ++i) largest = fmax(largest, length * fabs(v[k][i]));
  }
  return largest;
}

void elastic_step_apply(const ElasticStep *s, Domain *d, double *const v[MOTIONS], double *const change[MOTIONS])
{
  const Particles *p = d->particles;
  /* 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  const double largest = largest_of(d, v), h = largest > 0 ? 1e-7 * d->body.largest_spacing / largest : 1;
  for (int k = 0; k < p->motions; ++k) memcpy(s->tried[k], p->displacement[k], sizeof(double) * (size_t)p->places);
  vectors_combine(d, 1, s->tried, h, v);
  evaluate(d, s->tried, change);
  vectors_combine(d, 1 / h, change, -1 / h, s->force);
}

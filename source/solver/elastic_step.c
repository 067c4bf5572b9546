#include "solver/elastic_step.h"

#include "solver/vectors.h"
#include <math.h>
#include <string.h>

int elastic_step_create(ElasticStep *s, const Domain *d, Error *error)
{
  const int64_t places = d->particles->places;
  const bool made = vectors_make(s->force, places, "elastic stiffness", error) &&
                    vectors_make(s->tried, places, "elastic stiffness", error);
  return made ? BRECCIA_OK : BRECCIA_FAILURE;
}

void elastic_step_destroy(ElasticStep *s)
{
  vectors_free(s->force);
  vectors_free(s->tried);
}

/** Forces of an elastic body at other displacements than those held. */
static void evaluate(Domain *d, double *const at[3], double *const force[3])
{
  Particles *p = d->particles;
  const bool elastic = domain_in_elastic_stage(d);
  double *held[3], *internal[3];
  for (int k = 0; k < 3; ++k) {
    held[k] = p->displacement[k];
    internal[k] = p->internal[k];
    p->displacement[k] = at[k];
    p->internal[k] = force[k];
  }
  domain_set_elastic_stage(d, true);
  domain_evaluate(d);
  domain_set_elastic_stage(d, elastic);
  for (int k = 0; k < 3; ++k) {
    p->displacement[k] = held[k];
    p->internal[k] = internal[k];
  }
}

void elastic_step_prepare(ElasticStep *s, Domain *d)
{
  evaluate(d, d->particles->displacement, s->force);
}

static double largest_of(const Domain *d, double *const v[3])
{
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < d->particles->places; ++i) largest = fmax(largest, fabs(v[k][i]));
  return largest;
}

void elastic_step_apply(const ElasticStep *s, Domain *d, double *const v[3], double *const change[3])
{
  const Particles *p = d->particles;
  /* 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  const double largest = largest_of(d, v), h = largest > 0 ? 1e-7 * d->body.largest_spacing / largest : 1;
  for (int k = 0; k < 3; ++k) memcpy(s->tried[k], p->displacement[k], sizeof(double) * (size_t)p->places);
  vectors_combine(d, 1, s->tried, h, v);
  evaluate(d, s->tried, change);
  vectors_combine(d, 1 / h, change, -1 / h, s->force);
}

#include "solver/stable_step.h"

#include "base/random.h"
#include "base/team.h"
#include "base/tridiagonal.h"
#include "solver/aside.h"
#include <math.h>
#include <string.h>

enum { LEAST_ITERATIONS = 13, MOST_ITERATIONS = 60, VECTORS = 2 };

/* Relative growth of the largest eigenvalue in an iteration below which the iteration ends. The first vector depends on
 * the numbers of particles. In small ordinary bodies the highest modes lie close together: with 1e-4 the step depended
 * on the order of particles by 0.6 %, with 1e-6 by at most 1e-4. */
static const double least_growth = 1e-6;

static double mass_product(const Domain *d, double *const a[MOTIONS], double *const b[MOTIONS])
{
  const Particles *p = d->particles;
  double sum = 0;
  for (int64_t batch = 0; batch < d->batch_count; ++batch) { /* the same bits for any number of threads */
    double part = 0;
    for (int k = 0; k < p->motions; ++k)
      for (int64_t i = d->batches[batch].first * SLICE; i < d->batches[batch].last * SLICE; ++i)
        part += p->inertia[k][i] * p->volume[i] * a[k][i] * b[k][i];
    sum += part;
  }
  return sum;
}

/** Radius of gyration of a particle in rows of rotations; 1 in others. */
static double radius(const Domain *d, int k, int64_t number)
{
  const Particles *p = d->particles;
  return k < ROTATION ? 1 : sqrt(p->rotary[p->place_of[number]] / p->density[p->place_of[number]]);
}

typedef struct Iteration { /* of Lanczos' method */
  Domain *domain;
  Aside *aside;
  double *const *base_u, *const *base_f; /* displacements u and forces f(u) */
  double **previous, **current;
  double h, alpha, beta;
} Iteration;

/** next = -(f(u + h current) - f(u)) / (h rho), in the place of the forces; large bodies have no memory for more vectors. */
static void apply(void *context)
{
  const Iteration *n = context;
  Domain *d = n->domain;
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places) n->aside->displacement[k][i] = n->base_u[k][i] + n->h * n->current[k][i];
  TEAM_SINGLE aside_exchange(n->aside, d);
  domain_forces(d);
  TEAM_SINGLE aside_exchange(n->aside, d);
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places)
      n->aside->internal[k][i] = (n->base_f[k][i] - n->aside->internal[k][i]) / (n->h * d->particles->inertia[k][i]);
}

/** Next in the place of previous. */
static void orthogonalize(void *context)
{
  const Iteration *n = context;
  for (int k = 0; k < n->domain->particles->motions; ++k)
    TEAM_FOR (i, n->domain->particles->places)
      n->previous[k][i] = n->aside->internal[k][i] - (n->alpha * n->current[k][i] + n->beta * n->previous[k][i]);
}

static void normalize(void *context)
{
  const Iteration *n = context;
  for (int k = 0; k < n->domain->particles->motions; ++k)
    TEAM_FOR (i, n->domain->particles->places) n->previous[k][i] /= n->beta;
}

static bool are_zero(const Particles *p, double *const *rows)
{
  bool zero = true;
  for (int k = 0; k < p->motions; ++k)
    for (int64_t i = 0; i < p->places && zero; ++i) zero = rows[k][i] == 0;
  return zero;
}

/** Rows of zeros change places with others, of which no memory is taken as long as nothing is written to them. */
static void put_aside(const Particles *p, double **rows, double **reserved)
{
  for (int k = 0; k < p->motions; ++k) {
    double *own = rows[k];
    rows[k] = reserved[k];
    reserved[k] = own;
  }
}

static void take_back(const Particles *p, double **rows, double **reserved)
{
  for (int k = 0; k < p->motions; ++k) memset(reserved[k], 0, sizeof(double) * (size_t)p->places);
  put_aside(p, rows, reserved);
}

int stable_step(Domain *d, double *step, Error *error)
{
  const int64_t places = d->particles->places;
  const int motions = d->particles->motions;
  Aside aside;
  double *own_f[MOTIONS] = {0}, *v[VECTORS][MOTIONS] = {{0}};
  int failed = aside_create(&aside, d, "stable step", error) != BRECCIA_OK;
  for (int k = 0; k < motions; ++k) {
    failed |= !(own_f[k] = places_reserved(places, "stable step", error));
    for (int n = 0; n < VECTORS; ++n) failed |= !(v[n][k] = places_reserved(places, "stable step", error));
  }
  if (failed) goto done;

  /* Forces of elastic bodies follow from displacements, and are evaluated before steps begin. */
  const bool lean = d->leaves_tensors, at_zero = lean && are_zero(d->particles, d->particles->displacement),
             at_rest = at_zero && are_zero(d->particles, d->particles->velocity);
  double *const *u = d->particles->displacement, *const *base_f = lean ? d->particles->internal : own_f;
  const bool elastic = domain_in_elastic_stage(d), old = d->tensors_are_old;
  domain_set_elastic_stage(d, true);
  Iteration it = {.domain = d, .aside = &aside, .base_u = u, .base_f = base_f, .previous = v[0], .current = v[1]};
  if (lean)
    domain_evaluate(d);
  else {
    for (int k = 0; k < motions; ++k) memcpy(aside.displacement[k], u[k], sizeof(double) * (size_t)places);
    aside_exchange(&aside, d);
    domain_evaluate(d);
    aside_exchange(&aside, d);
    for (int k = 0; k < motions; ++k) memcpy(own_f[k], aside.internal[k], sizeof(double) * (size_t)places);
  }
  const bool bears_nothing = at_zero && are_zero(d->particles, d->particles->internal);
  if (at_zero) put_aside(d->particles, d->particles->displacement, aside.displacement);
  if (bears_nothing) put_aside(d->particles, d->particles->internal, aside.internal);
  if (at_rest) put_aside(d->particles, d->particles->velocity, v[0]);

  uint64_t seed = 1;
  for (int k = 0; k < motions; ++k)
    for (int64_t n = 0; n < d->particles->count; ++n) {
      double r = random_uniform(&seed) - 0.5;
      it.current[k][d->particles->place_of[n]] = k < d->body.dimensions || k >= ROTATION ? r / radius(d, k, n) : 0;
    }
  double norm = sqrt(mass_product(d, it.current, it.current));
  double alpha[MOST_ITERATIONS], beta[MOST_ITERATIONS + 1] = {0}, largest = 0, before = 0;
  for (int k = 0; k < motions; ++k)
    for (int64_t i = 0; i < places; ++i) it.current[k][i] /= norm;
  /* Displacements of 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  it.h = 1e-7 * d->body.largest_spacing * norm;
  for (int n = 0; n < MOST_ITERATIONS; ++n) {
    team_run(apply, &it);
    it.alpha = alpha[n] = mass_product(d, aside.internal, it.current);
    it.beta = beta[n];
    team_run(orthogonalize, &it);
    it.beta = beta[n + 1] = sqrt(mass_product(d, it.previous, it.previous));
    largest = tridiagonal_largest(alpha, beta, n + 1);
    if (!(beta[n + 1] > 1e-9 * fabs(largest)) || (n >= LEAST_ITERATIONS && largest - before < least_growth * largest))
      break;
    before = largest;
    team_run(normalize, &it);
    double **spare = it.previous;
    it.previous = it.current;
    it.current = spare;
  }
  domain_set_elastic_stage(d, elastic);
  if (at_zero) take_back(d->particles, d->particles->displacement, aside.displacement);
  if (bears_nothing) take_back(d->particles, d->particles->internal, aside.internal);
  if (at_rest) take_back(d->particles, d->particles->velocity, v[0]);
  domain_show_states(d); /* bonds that break next are judged by what particles show */
  d->tensors_are_old = old || d->leaves_tensors;
  if (!isfinite(largest) || largest < 0)
    failed = error_add(error, BRECCIA_FAILURE,
                       "the stable time step could not be found: the internal forces are not those "
                       "of a stiff body (largest eigenvalue %g)",
                       largest);
  else /* with what Lanczos' method may still lack after its stopping test */
    *step = 2 / sqrt(largest * 1.005 + forces_eigenvalue(&d->forces));
done:
  aside_destroy(&aside);
  for (int k = 0; k < MOTIONS; ++k) {
    places_free(&own_f[k]);
    for (int n = 0; n < VECTORS; ++n) places_free(&v[n][k]);
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

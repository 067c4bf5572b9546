#include "solver/stable_step.h"

#include "base/random.h"
#include "base/team.h"
#include "base/tridiagonal.h"
#include "domain/tensor_copy.h"
#include "solver/vectors.h"
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
  const Evaluation *of;                  /* perturbed evaluation */
  double *const *base_u, *const *base_f; /* displacements u and forces f(u); NULL: 0 */
  double **previous, **current;
  double h, alpha, beta;
} Iteration;

/** next = -(f(u + h current) - f(u)) / (h rho), in the place of the forces; large bodies have no memory for more vectors. */
static void apply(void *context)
{
  const Iteration *n = context;
  Domain *d = n->domain;
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places)
      n->of->displacement[k][i] = (n->base_u ? n->base_u[k][i] : 0) + n->h * n->current[k][i];
  domain_forces(d, n->of);
  for (int k = 0; k < d->particles->motions; ++k)
    TEAM_FOR (i, d->particles->places)
      n->of->internal[k][i] =
          ((n->base_f ? n->base_f[k][i] : 0) - n->of->internal[k][i]) / (n->h * d->particles->inertia[k][i]);
}

/** Next in the place of previous. */
static void orthogonalize(void *context)
{
  const Iteration *n = context;
  for (int k = 0; k < n->domain->particles->motions; ++k)
    TEAM_FOR (i, n->domain->particles->places)
      n->previous[k][i] = n->of->internal[k][i] - (n->alpha * n->current[k][i] + n->beta * n->previous[k][i]);
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

/** Reserves the rows of a vector; the system gives memory where something is written. */
static bool reserve(double *vector[MOTIONS], const Particles *p, Error *error)
{
  for (int k = 0; k < MOTIONS; ++k) vector[k] = NULL;
  for (int k = 0; k < p->motions; ++k)
    if (!(vector[k] = places_reserved(p->places, "stable step", error))) return false;
  return true;
}

/* To save memory, rows of the particles that are zero serve as vectors, and are cleared afterwards. */
int stable_step(Domain *d, double *step, Error *error)
{
  Particles *p = d->particles;
  const int64_t places = p->places;
  const int motions = p->motions;
  TensorCopy tensors;
  double *own_u[MOTIONS] = {0}, *own_f[MOTIONS] = {0}, *base[MOTIONS] = {0}, *v[VECTORS][MOTIONS] = {{0}};
  int failed = tensor_copy_create(&tensors, d, "stable step", error) != BRECCIA_OK;
  failed |= !reserve(own_u, p, error) || !reserve(own_f, p, error) || !reserve(base, p, error);
  for (int n = 0; n < VECTORS; ++n) failed |= !reserve(v[n], p, error);
  if (failed) goto done;

  /* Forces of elastic bodies follow from displacements, and are evaluated before steps begin. */
  const bool lean = d->leaves_tensors, at_zero = lean && are_zero(p, p->displacement),
             at_rest = at_zero && are_zero(p, p->velocity);
  double *const *base_f = lean ? p->internal : base;
  const bool elastic = domain_in_elastic_stage(d), old = d->tensors_are_old;
  tensor_copy_save(&tensors, d);
  domain_set_elastic_stage(d, true);
  domain_evaluate(d, &(Evaluation){.displacement = p->displacement, .internal = base_f});
  const bool bears_nothing = at_zero && are_zero(p, p->internal);
  const Evaluation trial = {.displacement = at_zero ? p->displacement : own_u,
                            .internal = bears_nothing ? p->internal : own_f};
  Iteration it = {.domain = d,
                  .of = &trial,
                  .base_u = at_zero ? NULL : p->displacement,
                  .base_f = bears_nothing ? NULL : base_f,
                  .previous = at_rest ? p->velocity : v[0],
                  .current = v[1]};

  uint64_t seed = 1;
  for (int k = 0; k < motions; ++k)
    for (int64_t n = 0; n < p->count; ++n) {
      double r = random_uniform(&seed) - 0.5;
      it.current[k][p->place_of[n]] = body_moves_along(&d->body, k) ? r / radius(d, k, n) : 0;
    }
  double norm = sqrt(mass_product(d, it.current, it.current));
  double alpha[MOST_ITERATIONS], beta[MOST_ITERATIONS + 1] = {0}, largest = 0, before = 0;
  for (int k = 0; k < motions; ++k)
    for (int64_t i = 0; i < places; ++i) it.current[k][i] /= norm;
  /* Displacements of 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  it.h = 1e-7 * d->body.largest_spacing * norm;
  for (int n = 0; n < MOST_ITERATIONS; ++n) {
    team_run(apply, &it);
    it.alpha = alpha[n] = mass_product(d, trial.internal, it.current);
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
  tensor_copy_restore(&tensors, d);
  if (at_zero) vectors_clear(p->displacement, p);
  if (bears_nothing) vectors_clear(p->internal, p);
  if (at_rest) vectors_clear(p->velocity, p);
  domain_show_states(d, NULL); /* bonds that break next are judged by what particles show */
  d->tensors_are_old = old || d->leaves_tensors;
  if (!isfinite(largest) || largest < 0)
    failed = error_add(error, BRECCIA_FAILURE,
                       "the stable time step could not be found: the internal forces are not those "
                       "of a stiff body (largest eigenvalue %g)",
                       largest);
  else /* with what Lanczos' method may still lack after its stopping test */
    *step = 2 / sqrt(largest * 1.005 + forces_eigenvalue(&d->forces));
done:
  tensor_copy_destroy(&tensors);
  vectors_free(own_u);
  vectors_free(own_f);
  vectors_free(base);
  for (int n = 0; n < VECTORS; ++n) vectors_free(v[n]);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

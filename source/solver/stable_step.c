#include "solver/stable_step.h"

#include "base/random.h"
#include "base/team.h"
#include "base/tridiagonal.h"
#include "domain/tensor_copy.h"
#include <math.h>
#include <string.h>

enum { LEAST_ITERATIONS = 13, MOST_ITERATIONS = 60, VECTORS = 2 };

/* Relative growth of the largest eigenvalue in an iteration below which the iteration ends. The first vector depends on
 * the numbers of particles. In small ordinary bodies the highest modes lie close together: with 1e-4 the step depended
 * on the order of particles by 0.6 %, with 1e-6 by at most 1e-4. */
static const double least_growth = 1e-6;

static double mass_product(const Particles *p, const Vector *a, const Vector *b)
{
  return vector_inner_mass(p->volume, &p->inertia, a, b);
}

/** Radius of gyration of a particle in rows of rotations; 1 in others. */
static double radius(const Domain *d, int k, int64_t number)
{
  const Particles *p = d->particles;
  return k < p->space.rotation ? 1 : sqrt(p->rotary[p->place_of[number]] / p->density[p->place_of[number]]);
}

/** An iteration of Lanczos' method. */
typedef struct Iteration {
  Domain *domain;
  const Evaluation *of;          /* perturbed evaluation */
  const Vector *base_u, *base_f; /* displacements u and forces f(u); NULL: 0 */
  const Vector *previous, *current;
  double h;
} Iteration;

static void next_in_tile(void *context, int64_t first, int64_t last)
{
  const Iteration *n = context;
  const Vector *force = n->of->internal, *inertia = &n->domain->particles->inertia;
  for (int k = 0; k < force->space->rows; ++k)
    for (int64_t i = first; i < last; ++i)
      force->row[k][i] = ((n->base_f ? n->base_f->row[k][i] : 0) - force->row[k][i]) / (n->h * inertia->row[k][i]);
}

/** next = -(f(u + h current) - f(u)) / (h rho), in the place of the forces; large bodies have no memory for more vectors. */
static void apply(const Iteration *n)
{
  if (n->base_u) vector_copy(n->of->displacement, n->base_u);
  vector_combine(n->base_u ? 1 : 0, n->of->displacement, n->h, n->current);
  domain_evaluate(n->domain, n->of);
  vector_each_tile(n->current->space, next_in_tile, (void *)n);
}

/* To save memory, rows of the particles that are zero serve as vectors, and are cleared afterwards. */
int stable_step(Domain *d, double *step, Error *error)
{
  Particles *p = d->particles;
  const VectorSpace *space = &p->space;
  static const char label[] = "stable step";
  TensorCopy tensors;
  Vector own_u = {0}, own_f = {0}, base = {0}, v[VECTORS] = {{0}};
  int failed = tensor_copy_create(&tensors, d, label, error) != BRECCIA_OK;
  failed |= !vector_reserve(&own_u, space, label, error) || !vector_reserve(&own_f, space, label, error) ||
            !vector_reserve(&base, space, label, error);
  for (int n = 0; n < VECTORS; ++n) failed |= !vector_reserve(&v[n], space, label, error);
  if (failed) goto done;

  /* Forces of elastic bodies follow from displacements, and are evaluated before steps begin. */
  const bool lean = d->leaves_tensors, at_zero = lean && vector_is_zero(&p->displacement),
             at_rest = at_zero && vector_is_zero(&p->velocity);
  const Vector *base_f = lean ? &p->internal : &base;
  const bool elastic = domain_in_elastic_stage(d), old = d->tensors_are_old;
  tensor_copy_save(&tensors, d);
  domain_set_elastic_stage(d, true);
  domain_evaluate(d, &(Evaluation){.displacement = &p->displacement, .internal = base_f});
  const bool bears_nothing = at_zero && vector_is_zero(&p->internal);
  const Evaluation trial = {.displacement = at_zero ? &p->displacement : &own_u,
                            .internal = bears_nothing ? &p->internal : &own_f};
  Iteration it = {.domain = d,
                  .of = &trial,
                  .base_u = at_zero ? NULL : &p->displacement,
                  .base_f = bears_nothing ? NULL : base_f,
                  .previous = at_rest ? &p->velocity : &v[0],
                  .current = &v[1]};

  uint64_t seed = 1;
  for (int k = 0; k < space->rows; ++k)
    for (int64_t n = 0; n < p->count; ++n) {
      double r = random_uniform(&seed) - 0.5;
      it.current->row[k][p->place_of[n]] = body_moves_along(&d->body, k) ? r / radius(d, k, n) : 0;
    }
  double norm = sqrt(mass_product(p, it.current, it.current));
  double alpha[MOST_ITERATIONS], beta[MOST_ITERATIONS + 1] = {0}, largest = 0, before = 0;
  vector_scale(it.current, 1 / norm);
  /* Displacements of 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  it.h = 1e-7 * d->body.largest_spacing * norm;
  for (int n = 0; n < MOST_ITERATIONS; ++n) {
    apply(&it);
    alpha[n] = mass_product(p, trial.internal, it.current);
    vector_combine(-beta[n], it.previous, -alpha[n],
                   it.current); /* the next vector, in the place of the previous one */
    vector_combine(1, it.previous, 1, trial.internal);
    beta[n + 1] = sqrt(mass_product(p, it.previous, it.previous));
    largest = tridiagonal_largest(alpha, beta, n + 1);
    if (!(beta[n + 1] > 1e-9 * fabs(largest)) || (n >= LEAST_ITERATIONS && largest - before < least_growth * largest))
      break;
    before = largest;
    vector_scale(it.previous, 1 / beta[n + 1]);
    const Vector *spare = it.previous;
    it.previous = it.current;
    it.current = spare;
  }
  domain_set_elastic_stage(d, elastic);
  tensor_copy_restore(&tensors, d);
  if (at_zero) vector_clear(&p->displacement);
  if (bears_nothing) vector_clear(&p->internal);
  if (at_rest) vector_clear(&p->velocity);
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
  vector_destroy(&own_u);
  vector_destroy(&own_f);
  vector_destroy(&base);
  for (int n = 0; n < VECTORS; ++n) vector_destroy(&v[n]);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

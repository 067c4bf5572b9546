#include "solver/stable_step.h"

#include "base/random.h"
#include <math.h>
#include <string.h>

enum { MOST_ITERATIONS = 40, VECTORS = 3 };

/* Arrays that stand in for the domain's own while displacements are tried out. */
typedef struct Trial {
  double *displacement[3], *internal[3], *strain[6], *stress[6];
} Trial;

static void swap(double **a, double **b)
{
  double *c = *a;
  *a = *b;
  *b = c;
}

static void exchange(Domain *d, Trial *t)
{
  for (int k = 0; k < 3; ++k) {
    swap(&d->particles->displacement[k], &t->displacement[k]);
    swap(&d->particles->internal[k], &t->internal[k]);
  }
  for (int k = 0; k < 6; ++k) {
    swap(&d->points.strain[k], &t->strain[k]);
    swap(&d->points.stress[k], &t->stress[k]);
  }
}

static double mass_product(const Domain *d, double *const a[3], double *const b[3])
{
  const Particles *p = d->particles;
  double sum = 0;
  for (int64_t block = 0; block < d->block_count;
       ++block) { /* block by block: the same bits for any number of threads */
    double part = 0;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = d->blocks[block].first * SLICE; i < d->blocks[block].last * SLICE; ++i)
        part += p->density[i] * p->volume[i] * a[k][i] * b[k][i];
    sum += part;
  }
  return sum;
}

/** Number of eigenvalues of the tridiagonal matrix that are larger than x (Sturm). */
static int count_above(const double *alpha, const double *beta, int n, double x)
{
  int count = 0;
  double q = 1;
  for (int k = 0; k < n; ++k) {
    q = alpha[k] - x - (k ? beta[k] * beta[k] / q : 0);
    if (q == 0) q = 1e-300;
    count += q > 0;
  }
  return count;
}

static double largest_eigenvalue(const double *alpha, const double *beta, int n)
{
  double low = alpha[0], high = 0;
  for (int k = 0; k < n; ++k) {
    double row = alpha[k] + (k ? fabs(beta[k]) : 0) + (k + 1 < n ? fabs(beta[k + 1]) : 0);
    high = fmax(high, row);
    low = fmin(low, alpha[k]);
  }
  for (int k = 0; k < 100 && high - low > 1e-10 * fabs(high); ++k) {
    double middle = (low + high) / 2;
    if (count_above(alpha, beta, n, middle))
      low = middle;
    else
      high = middle;
  }
  return high;
}

/** v -> -(f(u + h v) - f(u)) / (h rho); `base` holds u and f(u). */
static void apply(Domain *d, Trial *trial, double *const base_u[3], double *const base_f[3], double h,
                  double *const v[3], double *const out[3])
{
  int64_t places = d->particles->places;
  for (int k = 0; k < 3; ++k)
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < places; ++i) trial->displacement[k][i] = base_u[k][i] + h * v[k][i];
  exchange(d, trial);
#pragma omp parallel
  domain_forces(d);
  exchange(d, trial);
  for (int k = 0; k < 3; ++k)
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < places; ++i)
      out[k][i] = (base_f[k][i] - trial->internal[k][i]) / (h * d->particles->density[i]);
}

int stable_step(Domain *d, double *step, Error *error)
{
  int64_t places = d->particles->places;
  Trial trial = {0};
  double *base_f[3] = {0}, *v[VECTORS][3] = {{0}};
  int failed = 0;
  for (int k = 0; k < 3; ++k) {
    failed |= !(trial.displacement[k] = places_array(places, "stable step", error));
    failed |= !(trial.internal[k] = places_array(places, "stable step", error));
    failed |= !(base_f[k] = places_array(places, "stable step", error));
    for (int n = 0; n < VECTORS; ++n) failed |= !(v[n][k] = places_array(places, "stable step", error));
  }
  for (int k = 0; k < 6 && d->points.where == POINTS_ON_PARTICLES; ++k) {
    failed |= !(trial.strain[k] = places_array(places, "stable step", error));
    failed |= !(trial.stress[k] = places_array(places, "stable step", error));
  }
  if (failed) goto done;

  double *const *u = d->particles->displacement;
  int elastic = d->points.elastic_stage;
  d->points.elastic_stage = 1;
  double **previous = v[0], **current = v[1], **next = v[2];
  for (int k = 0; k < 3; ++k) memcpy(trial.displacement[k], u[k], sizeof(double) * (size_t)places);
  exchange(d, &trial);
#pragma omp parallel
  domain_forces(d);
  exchange(d, &trial);
  for (int k = 0; k < 3; ++k) memcpy(base_f[k], trial.internal[k], sizeof(double) * (size_t)places);

  uint64_t seed = 1;
  for (int k = 0; k < 3; ++k)
    for (int64_t n = 0; n < d->particles->count; ++n) {
      double r = random_uniform(&seed) - 0.5;
      current[k][d->particles->place_of[n]] = k < d->body.dimensions ? r : 0;
    }
  double norm = sqrt(mass_product(d, current, current));
  double alpha[MOST_ITERATIONS], beta[MOST_ITERATIONS + 1] = {0}, largest = 0, before = 0;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < places; ++i) current[k][i] /= norm;
  /* Displacements of 1e-7 spacings: far above roundings, far below where anything is non-linear. */
  double h = 1e-7 * d->body.largest_spacing * norm;
  for (int n = 0; n < MOST_ITERATIONS; ++n) {
    apply(d, &trial, u, base_f, h, current, next);
    alpha[n] = mass_product(d, next, current);
    for (int k = 0; k < 3; ++k)
#pragma omp parallel for schedule(static)
      for (int64_t i = 0; i < places; ++i) next[k][i] -= alpha[n] * current[k][i] + beta[n] * previous[k][i];
    beta[n + 1] = sqrt(mass_product(d, next, next));
    largest = largest_eigenvalue(alpha, beta, n + 1);
    if (!(beta[n + 1] > 1e-9 * fabs(largest)) || (n > 12 && largest - before < 1e-4 * largest)) break;
    before = largest;
    for (int k = 0; k < 3; ++k)
#pragma omp parallel for schedule(static)
      for (int64_t i = 0; i < places; ++i) next[k][i] /= beta[n + 1];
    double **spare = previous;
    previous = current;
    current = next;
    next = spare;
  }
  d->points.elastic_stage = elastic;
  domain_show_states(d); /* bonds that break next are judged by what particles show */
  if (!isfinite(largest) || largest <= 0)
    failed = error_add(error, BRECCIA_FAILURE,
                       "the stable time step could not be found: the internal forces are not those "
                       "of a stiff body (largest eigenvalue %g)",
                       largest);
  else
    *step = 2 / sqrt(largest * 1.005 +
                     contact_eigenvalue(&d->contact)); /* what Lanczos' method may still lack after its stopping test */
done:
  for (int k = 0; k < 3; ++k) {
    places_free(&trial.displacement[k]);
    places_free(&trial.internal[k]);
    places_free(&base_f[k]);
    for (int n = 0; n < VECTORS; ++n) places_free(&v[n][k]);
  }
  for (int k = 0; k < 6; ++k) {
    places_free(&trial.strain[k]);
    places_free(&trial.stress[k]);
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

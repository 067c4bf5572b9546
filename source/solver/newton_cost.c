#include "solver/newton.h"

#include "base/clock.h"
#include <math.h>
#include <string.h>

/* Means over the examples (docs/performance.md): iterations of an increment, products of an iteration, evaluations of an increment by relaxation. What softens
 * begins with conjugate gradients and goes on with minimal residuals, which take longer for each product. */
static const double elastic_iterations = 1.3, elastic_products = 45, iterations = 4, products = 30, relaxing = 300,
                    softening = 2.5;

/** Least seconds so far of making ready for equations, and of a product with the stiffness and what goes with it. */
typedef struct Trial {
  double ready, product;
} Trial;

static int try_equations(Newton *n, Trial *least, Error *error)
{
  const Particles *p = n->domain->particles;
  LinearRecord record;
  const double begin = clock_seconds();
  if (linear_solver_prepare(&n->linear, error)) return BRECCIA_FAILURE;
  const double prepared = clock_seconds();
  for (int k = 0; k < 3; ++k) {
    memset(n->change[k], 0, sizeof(double) * (size_t)p->places);
    memcpy(n->force[k], p->volume, sizeof(double) * (size_t)p->places);
  }
  unknowns_gather(&n->linear.unknowns, n->force);
  const double gathered = clock_seconds();
  if (linear_solver_solve(&n->linear, n->force, n->change, 0.1, &record, error)) return BRECCIA_FAILURE;
  least->ready = fmin(least->ready, prepared - begin);
  least->product = fmin(least->product, (clock_seconds() - gathered) / fmax(1, (double)record.iterations));
  return BRECCIA_OK;
}

int newton_measure(Newton *n, StepCost *cost, Error *error)
{
  enum { VECTORS = 9 + 6 + 6 }; /* its own, the increment's, and what a failed one gives back */
  const double vector = sizeof(double) * (double)n->domain->particles->places;
  const bool elastic = domain_is_elastic(n->domain);
  cost->bytes += VECTORS * vector;
  if (n->relaxes) {
    cost->evaluations = relaxing;
    return BRECCIA_OK;
  }
  const double begin = clock_seconds(), enough = 0.1;
  if (domain_linearise(n->domain, error)) return BRECCIA_FAILURE;
  const double linearised = clock_seconds() - begin;
  const LinearForesight before = linear_solver_foresee(&n->linear);
  Trial trial = {INFINITY, INFINITY};
  enum { MOST = 10 };
  const int64_t given_up =
      n->linear.given_up; /* the run gives up its ways by itself, whether this was asked for or not */
  for (int k = 0; before.seconds == 0 && k < MOST && (k == 0 || clock_seconds() - begin < enough); ++k)
    if (try_equations(n, &trial, error)) return BRECCIA_FAILURE;
  n->linear.given_up = given_up;
  if (before.seconds > 0) trial = (Trial){before.seconds, 0};
  const double softer = domain_take_secants(n->domain, false) ? softening : 1;
  const double one = linearised + trial.ready + softer * trial.product * (elastic ? elastic_products : products);
  cost->evaluations = 0;
  cost->seconds = one * (elastic ? elastic_iterations : iterations);
  cost->bytes += fmax(before.bytes, linear_solver_foresee(&n->linear).bytes);
  return BRECCIA_OK;
}

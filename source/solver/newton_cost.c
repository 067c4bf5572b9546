#include "solver/newton.h"

#include "base/clock.h"
#include <math.h>
#include <string.h>

/* Means over the elastic examples (docs/performance.md): iterations of an increment, and products of an iteration. What yields, softens or breaks takes from a
 * few times as long, as the slope of the examples, to a hundred times; how long nothing tells beforehand. So of such bodies the least is told: a
 * step as if they were elastic and one that finds it so, with half of the products, as their equations are solved less closely. */
static const double elastic_iterations = 1.3, elastic_products = 45, least_iterations = 2, least_products = 12,
                    least_relaxing = 60;

/** Least seconds so far of tangents, of making ready for equations, and of a product with the stiffness and what goes with it. */
typedef struct Trial {
  double linearised, ready, product;
} Trial;

static int try_equations(Newton *n, Trial *least, Error *error)
{
  const Particles *p = n->domain->particles;
  LinearRecord record;
  const double begin = clock_seconds();
  if (domain_linearise(n->domain, NULL, error)) return BRECCIA_FAILURE;
  const double linearised = clock_seconds();
  if (linear_solver_prepare(&n->linear, error)) return BRECCIA_FAILURE;
  const double prepared = clock_seconds();
  vector_clear(&n->change);
  for (int k = 0; k < p->space.rows; ++k) memcpy(n->force.row[k], p->volume, sizeof(double) * (size_t)p->places);
  unknowns_gather(&n->linear.unknowns, &n->force);
  const double gathered = clock_seconds();
  if (linear_solver_solve(&n->linear, &n->force, &n->change, 0.1, &record, error)) return BRECCIA_FAILURE;
  least->linearised = fmin(least->linearised, linearised - begin);
  least->ready = fmin(least->ready, prepared - linearised);
  least->product = fmin(least->product, (clock_seconds() - gathered) / fmax(1, (double)record.iterations));
  return BRECCIA_OK;
}

int newton_measure(Newton *n, StepCost *cost, Error *error)
{
  const int vectors = 3 + (n->control ? 2 : 0) + (n->change_forces.row[0] ? 1 : 0);
  const bool elastic = domain_is_elastic(n->domain) && !n->domain->failure.criterion;
  cost->bytes += vectors * (double)vector_bytes(&n->domain->particles->space);
  cost->least = !elastic || n->relaxes;
  if (n->relaxes) {
    cost->evaluations = least_relaxing;
    return BRECCIA_OK;
  }
  const double begin = clock_seconds(), enough = 0.1;
  if (domain_linearise(n->domain, NULL, error)) return BRECCIA_FAILURE;
  const LinearForesight before = linear_solver_foresee(&n->linear);
  Trial trial = {INFINITY, INFINITY, INFINITY};
  enum { MOST = 10 };
  const int64_t given_up =
      n->linear.given_up; /* the run gives up its ways by itself, whether this was asked for or not */
  for (int k = 0; before.seconds == 0 && k < MOST && (k == 0 || clock_seconds() - begin < enough); ++k)
    if (try_equations(n, &trial, error)) return BRECCIA_FAILURE;
  n->linear.given_up = given_up;
  if (before.seconds > 0) trial = (Trial){clock_seconds() - begin, before.seconds, 0};
  cost->evaluations = 0;
  cost->seconds = (elastic ? elastic_iterations : least_iterations) *
                  (trial.linearised + trial.ready + trial.product * (elastic ? elastic_products : least_products));
  cost->bytes += fmax(before.bytes, linear_solver_foresee(&n->linear).bytes);
  return BRECCIA_OK;
}

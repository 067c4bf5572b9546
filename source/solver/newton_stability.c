#include "solver/newton_stability.h"

#include "base/random.h"
#include "solver/newton_parts.h"
#include <math.h>

enum { MOST = 200 };

/** Forces on the unknowns, as if at random. */
static void push(const Newton *n, const Vector *f)
{
  const Particles *p = n->domain->particles;
  const Unknowns *u = &n->linear.unknowns;
  uint64_t seed = 1;
  vector_clear(f);
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->count; ++i)
      f->row[k][p->place_of[i]] = unknowns_length(u, k) * (random_uniform(&seed) - 0.5);
  unknowns_gather(u, f);
}

int newton_find_stability(Newton *n, bool *stays, Error *error)
{
  const double accuracy = 1e-4; /* of the push */
  LinearRecord linear = {0};
  if (newton_linearise(n, error) || newton_prepare(n, error)) return BRECCIA_FAILURE;
  push(n, &n->force);
  if (linear_solver_solve(&n->linear, &n->force, &n->change, accuracy, &linear, error)) return BRECCIA_FAILURE;
  n->products += linear.iterations;
  *stays = !linear.indefinite;
  return BRECCIA_OK;
}

int newton_seek_fall(Newton *n, Preconditioner *m, const Vector *fall, const Vector *rest, const Vector *product,
                     bool *falls, Error *error)
{
  const double enough = 1e-4;  /* of the push is left where the body resists every motion */
  const double nothing = 1e-6; /* of the stiffness of the preconditioner: torn parts resist with roundings */
  const Unknowns *u = &n->linear.unknowns;
  *falls = false;
  if (newton_linearise(n, error) || preconditioner_prepare(m, &n->linear, fall, product, error)) return BRECCIA_FAILURE;
  push(n, rest);
  const double first = unknowns_product_of_forces(u, rest, rest);
  double left = first, slope = 0, size = 0; /* of the direction, by the preconditioner */
  for (int k = 0; k < MOST && left > enough * enough * first; ++k) {
    preconditioner_apply(m, &n->linear, rest, product);
    const double next = vector_inner(rest, product, 1), again = k ? next / slope : 0;
    vector_combine(again, fall, 1, product);
    size = next + again * again * size;
    slope = next;
    linear_solver_apply(&n->linear, fall, product);
    unknowns_clear_rest(u, fall);
    ++n->products;
    const double curvature = vector_inner(product, fall, 1);
    *falls = curvature < -nothing * size;
    if (!(curvature > nothing * size)) break;
    vector_combine(1, rest, -slope / curvature, product);
    left = unknowns_product_of_forces(u, rest, rest);
  }
  return BRECCIA_OK;
}

/* Conjugate gradients on products K v (Hestenes and Stiefel 1952), with a preconditioner of two levels. They need a stiffness that is symmetric and resists
 * every motion, and notice where it is not. */
#include "solver/preconditioner.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

enum { MOST_ITERATIONS = 20000 };

typedef struct Gradients {
  Preconditioner preconditioner;
  Vector rest, direction;
  Vector product; /* with K; then what the preconditioner makes of the rest */
} Gradients;

static double suits(const LinearSolver *s)
{
  (void)s;
  return 1;
}

static void destroy(LinearSolver *s)
{
  Gradients *g = s->own;
  if (!g) return;
  vector_destroy(&g->rest);
  vector_destroy(&g->direction);
  vector_destroy(&g->product);
  preconditioner_destroy(&g->preconditioner);
  free(g);
}

static int create(LinearSolver *s, Error *error)
{
  const Particles *p = s->domain->particles;
  Gradients *g = s->own = memory_zeroed(1, sizeof *g, "conjugate gradients", error);
  const bool failed = !g || preconditioner_create(&g->preconditioner, s->domain, false, error) ||
                      !vector_create(&g->rest, &p->space, "conjugate gradients", error) ||
                      !vector_create(&g->direction, &p->space, "conjugate gradients", error) ||
                      !vector_create(&g->product, &p->space, "conjugate gradients", error);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int prepare(LinearSolver *s, Error *error)
{
  Gradients *g = s->own;
  return preconditioner_prepare(&g->preconditioner, s, &g->direction, &g->product, error);
}

static int solve(LinearSolver *s, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                 Error *error)
{
  (void)error;
  Gradients *g = s->own;
  const Unknowns *u = &s->unknowns;
  const double first = unknowns_product_of_forces(u, f, f);
  double rest = first, slope = 0;
  vector_copy(&g->rest, f);
  record->unsuited = !g->preconditioner.is_symmetric;
  while (!record->unsuited && record->iterations < MOST_ITERATIONS && rest > tolerance * tolerance * first) {
    record->stopped = s->allowed && record->iterations >= s->allowed;
    if (record->stopped) break;
    preconditioner_apply(&g->preconditioner, s, &g->rest, &g->product);
    const double next = vector_inner(&g->rest, &g->product, 1);
    vector_combine(record->iterations ? next / slope : 0, &g->direction, 1, &g->product);
    slope = next;
    linear_solver_apply(s, &g->direction, &g->product);
    unknowns_clear_rest(u, &g->direction);
    const double curvature = vector_inner(&g->product, &g->direction, 1);
    ++record->iterations;
    if (!(curvature > 0)) {
      record->indefinite = record->unsuited = true;
      break;
    }
    vector_combine(1, v, slope / curvature, &g->direction);
    vector_combine(1, &g->rest, -slope / curvature, &g->product);
    rest = unknowns_product_of_forces(u, &g->rest, &g->rest);
  }
  record->residual = first > 0 ? sqrt(rest / first) : 0;
  return BRECCIA_OK;
}

static size_t bytes(const LinearSolver *s)
{
  const Gradients *g = s->own;
  const Particles *p = s->domain->particles;
  return (3 * (size_t)p->space.rows + 1) * sizeof(double) * (size_t)p->places +
         preconditioner_bytes(&g->preconditioner);
}

extern const LinearType residuals_linear;

const LinearType gradients_linear = {.instead = &residuals_linear,
                                     .suits = suits,
                                     .create = create,
                                     .destroy = destroy,
                                     .prepare = prepare,
                                     .solve = solve,
                                     .bytes = bytes};

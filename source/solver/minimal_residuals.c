/* Generalised minimal residuals, restarted (Saad and Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856), for stiffness that is not symmetric or does not resist
 * every motion. The preconditioner stands on the right, so that residuals are those of the equations. Each product adds a vector to those that are kept. */
#include "solver/preconditioner.h"

#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BASIS = 40, MOST_PRODUCTS = 5000 };

typedef struct Residuals {
  Preconditioner preconditioner;
  Vector basis[BASIS + 1]; /* as many as were needed so far */
  Vector scaled;
} Residuals;

/** The least squares of the projected equations, kept triangular by rotations. */
typedef struct Projected {
  double h[BASIS + 1][BASIS]; /* column by column of products */
  double cosine[BASIS], sine[BASIS], right[BASIS + 1];
} Projected;

static double suits(const LinearSolver *s)
{
  (void)s;
  return 0.5;
}

static void destroy(LinearSolver *s)
{
  Residuals *g = s->own;
  for (int n = 0; g && n <= BASIS; ++n) vector_destroy(&g->basis[n]);
  if (g) vector_destroy(&g->scaled);
  if (g) preconditioner_destroy(&g->preconditioner);
  free(g);
}

static int create(LinearSolver *s, Error *error)
{
  Residuals *g = s->own = memory_zeroed(1, sizeof *g, "minimal residuals", error);
  const Particles *p = s->domain->particles;
  const bool failed = !g || preconditioner_create(&g->preconditioner, s->domain, false, error) ||
                      !vector_create(&g->scaled, &p->space, "minimal residuals", error) ||
                      !vector_create(&g->basis[0], &p->space, "minimal residuals", error);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int prepare(LinearSolver *s, Error *error)
{
  Residuals *g = s->own;
  return preconditioner_prepare(&g->preconditioner, s, &g->scaled, &g->basis[0], error);
}

/** Turns a new column of the projected equations, and the right-hand side with it. @return what is left of the residual */
static double turn(Projected *p, int n)
{
  for (int i = 0; i < n; ++i) {
    const double upper = p->h[i][n], lower = p->h[i + 1][n];
    p->h[i][n] = p->cosine[i] * upper + p->sine[i] * lower;
    p->h[i + 1][n] = p->cosine[i] * lower - p->sine[i] * upper;
  }
  const double length = hypot(p->h[n][n], p->h[n + 1][n]);
  p->cosine[n] = length > 0 ? p->h[n][n] / length : 1;
  p->sine[n] = length > 0 ? p->h[n + 1][n] / length : 0;
  p->h[n][n] = length;
  p->right[n + 1] = -p->sine[n] * p->right[n];
  p->right[n] *= p->cosine[n];
  return fabs(p->right[n + 1]);
}

/** Adds to v what the first `count` vectors of the basis answer best. The last vector of the basis is lost. */
static void add_answer(const LinearSolver *s, const Projected *p, int count, const Vector *v)
{
  const Residuals *g = s->own;
  double y[BASIS] = {0};
  for (int i = count - 1; i >= 0; --i) {
    y[i] = p->right[i];
    for (int k = i + 1; k < count; ++k) y[i] -= p->h[i][k] * y[k];
    y[i] = p->h[i][i] > 0 ? y[i] / p->h[i][i] : 0;
  }
  vector_combine(0, &g->basis[count], y[0], &g->basis[0]);
  for (int i = 1; i < count; ++i) vector_combine(1, &g->basis[count], y[i], &g->basis[i]);
  preconditioner_apply(&g->preconditioner, s, &g->basis[count], &g->scaled);
  vector_combine(1, v, 1, &g->scaled);
}

/** One round, from the residual in the first vector of the basis. */
static int go_round(LinearSolver *s, double length, double enough, const Vector *v, LinearRecord *record, Error *error)
{
  Residuals *g = s->own;
  const Unknowns *u = &s->unknowns;
  Projected p = {.right = {length}};
  double left = length;
  int n = 0;
  vector_combine(1 / length, &g->basis[0], 0, &g->basis[0]);
  for (; n < BASIS && left > enough; ++n) {
    const Vector *next = &g->basis[n + 1];
    if (!vector_exists(next) &&
        !vector_create(&g->basis[n + 1], &s->domain->particles->space, "minimal residuals", error))
      return BRECCIA_FAILURE;
    preconditioner_apply(&g->preconditioner, s, &g->basis[n], &g->scaled);
    linear_solver_apply(s, &g->scaled, next);
    ++record->iterations;
    for (int i = 0; i <= n; ++i) {
      p.h[i][n] = unknowns_product_of_forces(u, next, &g->basis[i]);
      vector_combine(1, next, -p.h[i][n], &g->basis[i]);
    }
    p.h[n + 1][n] = sqrt(unknowns_product_of_forces(u, next, next));
    if (p.h[n + 1][n] > 0) vector_combine(1 / p.h[n + 1][n], next, 0, next);
    left = turn(&p, n);
  }
  add_answer(s, &p, n, v);
  return BRECCIA_OK;
}

static int solve(LinearSolver *s, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                 Error *error)
{
  Residuals *g = s->own;
  const Unknowns *u = &s->unknowns;
  const double first = sqrt(unknowns_product_of_forces(u, f, f));
  const double little = 0.95;  /* a round that leaves more than this of the residual leads nowhere */
  const double useless = 0.01; /* Newton's method comes on well with less */
  vector_copy(&g->basis[0], f);
  for (double length = first, before = INFINITY; first > 0;) {
    record->residual = length / first;
    if (length <= tolerance * first || !(length <= little * before) || record->iterations >= MOST_PRODUCTS) break;
    record->stopped = s->allowed && record->iterations >= s->allowed;
    if (record->stopped) break;
    before = length;
    if (go_round(s, length, 0.9 * tolerance * first, v, record, error)) return BRECCIA_FAILURE;
    vector_copy(&g->scaled, v);
    linear_solver_apply(s, &g->scaled, &g->basis[0]);
    ++record->iterations;
    vector_combine(-1, &g->basis[0], 1, f);
    length = sqrt(unknowns_product_of_forces(u, &g->basis[0], &g->basis[0]));
  }
  record->indefinite = vector_inner(f, v, 1) < 0;
  record->unsuited = !(record->residual <= fmax(tolerance, useless));
  return BRECCIA_OK;
}

static size_t bytes(const LinearSolver *s)
{
  const Residuals *g = s->own;
  const Particles *p = s->domain->particles;
  return (size_t)p->space.rows * (BASIS + 2) * sizeof(double) * (size_t)p->places +
         preconditioner_bytes(&g->preconditioner);
}

extern const LinearType direct_linear;

const LinearType residuals_linear = {.any_stiffness = true,
                                     .instead = &direct_linear,
                                     .suits = suits,
                                     .create = create,
                                     .destroy = destroy,
                                     .prepare = prepare,
                                     .solve = solve,
                                     .bytes = bytes};

/* Conjugate gradients on products K v, with a preconditioner of two levels. */
#include "solver/preconditioner.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 20000 };

typedef struct Gradients {
  Preconditioner preconditioner;
  double *rest[3], *direction[3];
  double *product[3]; /* with K; then what the preconditioner makes of the rest */
} Gradients;

static double suits(const LinearSolver *s)
{
  (void)s;
  return 1;
}

static void destroy(LinearSolver *s)
{
  Gradients *g = s->own;
  for (int k = 0; g && k < 3; ++k) {
    places_free(&g->rest[k]);
    places_free(&g->direction[k]);
    places_free(&g->product[k]);
  }
  if (g) preconditioner_destroy(&g->preconditioner);
  free(g);
}

static int create(LinearSolver *s, Error *error)
{
  const int64_t places = s->domain->particles->places;
  Gradients *g = s->own = memory_zeroed(1, sizeof *g, "conjugate gradients", error);
  bool failed = !g || preconditioner_create(&g->preconditioner, s->domain, error);
  for (int k = 0; k < 3 && !failed; ++k) {
    failed |= !(g->rest[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->direction[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->product[k] = places_array(places, "conjugate gradients", error));
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

static int prepare(LinearSolver *s, Error *error)
{
  Gradients *g = s->own;
  double *const work[2][3] = {{g->direction[0], g->direction[1], g->direction[2]},
                              {g->product[0], g->product[1], g->product[2]}};
  return preconditioner_prepare(&g->preconditioner, s, work, error);
}

/* ---- steps along arrays ---- */

/** a += factor b of batches of places. */
typedef struct Adding {
  const Domain *domain;
  double *const *a, *const *b;
  double own, factor; /* a = own a + factor b */
} Adding;

BRECCIA_CLONES
static void add(const Adding *s, int64_t first, int64_t last)
{
  const Lanes own = lanes_set(s->own), factor = lanes_set(s->factor);
  for (int k = 0; k < 3; ++k)
    for (int64_t i = first; i < last; i += LANES)
      lanes_store(s->a[k] + i, own * lanes_load(s->a[k] + i) + factor * lanes_load(s->b[k] + i));
}

static void add_batch(void *context, int64_t b)
{
  const Adding *s = context;
  const Batch *batch = &s->domain->batches[b];
  add(s, batch->first * SLICE, batch->last * SLICE);
}

/** a = own a + factor b */
static void combine(const LinearSolver *s, double own, double *const a[3], double factor, double *const b[3])
{
  team_each(s->domain->batch_count, add_batch, &(Adding){s->domain, a, b, own, factor});
}

static int solve(LinearSolver *s, double *const f[3], double *const v[3], double tolerance, LinearRecord *record,
                 Error *error)
{
  (void)error;
  Gradients *g = s->own;
  const Unknowns *u = &s->unknowns;
  const double first = unknowns_product(u, f, f);
  double rest = first, slope = 0;
  for (int k = 0; k < 3; ++k) memset(g->direction[k], 0, sizeof(double) * (size_t)s->domain->particles->places);
  for (int k = 0; k < 3; ++k) memcpy(g->rest[k], f[k], sizeof(double) * (size_t)s->domain->particles->places);
  while (record->iterations < MOST_ITERATIONS && rest > tolerance * tolerance * first) {
    preconditioner_apply(&g->preconditioner, s, g->rest, g->product);
    const double next = unknowns_product(u, g->rest, g->product);
    combine(s, record->iterations ? next / slope : 0, g->direction, 1, g->product);
    slope = next;
    linear_solver_apply(s, g->direction, g->product);
    unknowns_clear_rest(u, g->direction);
    const double curvature = unknowns_product(u, g->direction, g->product);
    ++record->iterations;
    if (!(curvature > 0)) {
      record->indefinite = true;
      break;
    }
    combine(s, 1, v, slope / curvature, g->direction);
    combine(s, 1, g->rest, -slope / curvature, g->product);
    rest = unknowns_product(u, g->rest, g->rest);
  }
  record->residual = first > 0 ? sqrt(rest / first) : 0;
  return BRECCIA_OK;
}

static size_t bytes(const LinearSolver *s)
{
  const Gradients *g = s->own;
  return 10 * sizeof(double) * (size_t)s->domain->particles->places + preconditioner_bytes(&g->preconditioner);
}

const LinearType gradients_linear = {
    .suits = suits, .create = create, .destroy = destroy, .prepare = prepare, .solve = solve, .bytes = bytes};

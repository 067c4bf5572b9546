/* Conjugate gradients on products K v. */
#include "solver/linear_solver.h"

#include "base/memory.h"
#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 20000 };

typedef struct Gradients {
  double *rest[3], *scaled[3], *direction[3], *product[3];
  double *diagonal[3];
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
    places_free(&g->scaled[k]);
    places_free(&g->direction[k]);
    places_free(&g->product[k]);
    places_free(&g->diagonal[k]);
  }
  free(g);
}

static int create(LinearSolver *s, Error *error)
{
  const int64_t places = s->domain->particles->places;
  Gradients *g = s->own = memory_zeroed(1, sizeof *g, "conjugate gradients", error);
  bool failed = !g;
  for (int k = 0; k < 3 && !failed; ++k) {
    failed |= !(g->rest[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->scaled[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->direction[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->product[k] = places_array(places, "conjugate gradients", error));
    failed |= !(g->diagonal[k] = places_array(places, "conjugate gradients", error));
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

/** What stands on the diagonal of K is in proportion to volume, stiffness and what is left of the family. */
static int prepare(LinearSolver *s, Error *error)
{
  (void)error;
  Gradients *g = s->own;
  const Particles *p = s->domain->particles;
  for (int64_t n = 0; n < p->count; ++n) {
    const int32_t i = p->place_of[n];
    const Material *m = &s->domain->materials[s->domain->material[i / SLICE]];
    const double family = fmax(1, family_count(&s->domain->family, i));
    for (int k = 0; k < 3; ++k) g->diagonal[k][i] = p->volume[i] * (m->bulk + 4 * m->shear / 3) * family;
  }
  unknowns_gather(&s->unknowns, g->diagonal);
  return BRECCIA_OK;
}

static void precondition(const LinearSolver *s)
{
  const Gradients *g = s->own;
  for (int k = 0; k < 3; ++k)
    for (int64_t i = 0; i < s->domain->particles->places; ++i)
      g->scaled[k][i] = g->diagonal[k][i] > 0 ? g->rest[k][i] / g->diagonal[k][i] : 0;
  unknowns_clear_rest(&s->unknowns, g->scaled);
}

static int solve(LinearSolver *s, double *const f[3], double *const v[3], double tolerance, LinearRecord *record,
                 Error *error)
{
  (void)error;
  Gradients *g = s->own;
  const int64_t places = s->domain->particles->places;
  const double first = unknowns_product(&s->unknowns, f, f);
  double rest = first, slope = 0;
  for (int k = 0; k < 3; ++k) memcpy(g->rest[k], f[k], sizeof(double) * (size_t)places);
  for (int64_t n = 0; n < MOST_ITERATIONS && rest > tolerance * tolerance * first; ++n) {
    precondition(s);
    const double next = unknowns_product(&s->unknowns, g->rest, g->scaled);
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < places; ++i)
        g->direction[k][i] = g->scaled[k][i] + (n ? next / slope : 0) * g->direction[k][i];
    slope = next;
    linear_solver_apply(s, g->direction, g->product);
    unknowns_clear_rest(&s->unknowns, g->direction);
    const double curvature = unknowns_product(&s->unknowns, g->direction, g->product);
    ++record->iterations;
    if (!(curvature > 0)) {
      record->indefinite = true;
      break;
    }
    const double step = slope / curvature;
    for (int k = 0; k < 3; ++k)
      for (int64_t i = 0; i < places; ++i) {
        v[k][i] += step * g->direction[k][i];
        g->rest[k][i] -= step * g->product[k][i];
      }
    rest = unknowns_product(&s->unknowns, g->rest, g->rest);
  }
  record->residual = first > 0 ? sqrt(rest / first) : 0;
  return BRECCIA_OK;
}

static size_t bytes(const LinearSolver *s)
{
  return 15 * sizeof(double) * (size_t)s->domain->particles->places;
}

const LinearType gradients_linear = {
    .suits = suits, .create = create, .destroy = destroy, .prepare = prepare, .solve = solve, .bytes = bytes};

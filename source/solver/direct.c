/* Direct solution: the stiffness is assembled (matrix.h) and factored by a library (factors.h). Each solution is the
 * sum of up to three corrections, each of which solves for the residual of those before. */
#include "solver/factors.h"
#include "solver/linear_solver.h"
#include "solver/matrix.h"

#include "base/memory.h"
#include "loading/one_sided.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Direct {
  Matrix matrix;
  /** State at creation of the matrix: number of broken bonds, pattern of additional forces, key of one-sided
   *  supports. */
  int64_t broken, pattern, open;
  Factors *factors;
  /** Residual, overwritten by its correction [matrix.size]. */
  double *correction;
  bool indefinite;
} Direct;

/** Products take less time than factors in all but the smallest bodies (docs/performance.md); where conjugate gradients have failed, a body a few
 *  times as large is still cheaper by factors than by some hundreds of products an iteration: a notched strip of 800 particles with brittle bonds took
 *  2 s instead of 18. Beyond, factors are the last resort, where they can be had: one of a body in space has the square of the entries that one in the
 *  plane has. */
static double suits(const LinearSolver *s)
{
  static const double small[] = {20000, 500, 100}, most[] = {1e6, 250000, 6000};
  const int of = s->domain->body.dimensions - 1;
  const double count = (double)s->domain->particles->count;
  if (matrix_refusal(&s->unknowns) || count > most[of]) return 0;
  return count <= small[of] ? 2 : count <= 8 * small[of] ? 0.75 : 0.1;
}

static void destroy(LinearSolver *s)
{
  Direct *d = s->own;
  if (!d) return;
  factors_destroy(&d->factors);
  matrix_destroy(&d->matrix);
  free(d->correction);
  free(d);
}

static int create(LinearSolver *s, Error *error)
{
  Direct *d = s->own = memory_zeroed(1, sizeof *d, "direct solution", error);
  if (!d) return BRECCIA_FAILURE;
  d->broken = -1;
  return BRECCIA_OK;
}

/** Particles that nothing joins any more would leave empty rows: they stay where they are. */
static void hold_lone_unknowns(Matrix *m)
{
  double largest = 0;
  for (int64_t row = 0; row < m->size; ++row)
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t)
      if (m->column[t] == row) largest = fmax(largest, fabs(m->value[t]));
  for (int64_t row = 0; row < m->size; ++row) {
    double sum = 0;
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) sum += fabs(m->value[t]);
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t)
      if (m->column[t] == row && sum <= 1e-14 * largest) m->value[t] = largest;
  }
}

/** Creates matrix and factors again if bonds have broken since, if additional forces join other particles, or if the
 * set of open one-sided supports has changed. */
static int direct_renew(LinearSolver *s, Error *error)
{
  Direct *d = s->own;
  const int64_t pattern = forces_pattern(&s->domain->forces);
  const int64_t open = one_sided_key(s->loading);
  if (d->broken == s->domain->broken_count && d->pattern == pattern && d->open == open) return BRECCIA_OK;
  d->broken = -1;
  factors_destroy(&d->factors);
  matrix_destroy(&d->matrix);
  free(d->correction);
  d->correction = NULL;
  if (matrix_create(&d->matrix, &s->unknowns, error)) return BRECCIA_FAILURE;
  d->correction = memory_zeroed((size_t)d->matrix.size + 1, sizeof *d->correction, "direct solution", error);
  d->factors = factors_create("factors of the equations", error);
  if (!d->correction || !d->factors) return BRECCIA_FAILURE;
  d->broken = s->domain->broken_count;
  d->pattern = pattern;
  d->open = open;
  return BRECCIA_OK;
}

static int prepare(LinearSolver *s, Error *error)
{
  Direct *d = s->own;
  const Matrix *m = &d->matrix;
  int status = direct_renew(s, error);
  if (!status) status = matrix_fill(&d->matrix, &s->unknowns, s->stiffness_share, s->mass_factor, error);
  if (status) return status;
  hold_lone_unknowns(&d->matrix);
  return factors_compute(d->factors, &(SparseMatrix){m->size, m->first, m->column, m->value},
                         matrix_asymmetry(m) < 1e-9, &d->indefinite, error);
}

/** Computes the residual f - K x into `correction`. @return its Euclidean norm */
static double find_residual(Direct *d, const double *f, const double *x)
{
  const Matrix *m = &d->matrix;
  double square = 0;
  for (int64_t row = 0; row < m->size; ++row) {
    double left = f[row];
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) left -= m->value[t] * x[m->column[t]];
    d->correction[row] = left;
    square += left * left;
  }
  return sqrt(square);
}

static int solve(LinearSolver *s, const Vector *f, const Vector *v, double tolerance, LinearRecord *record,
                 Error *error)
{
  enum { MOST = 3 }; /* corrections */
  Direct *d = s->own;
  const size_t size = (size_t)d->matrix.size;
  double *right = memory_zeroed(size + 1, sizeof *right, "direct solution", error);
  double *x = memory_zeroed(size + 1, sizeof *x, "direct solution", error);
  int status = right && x ? BRECCIA_OK : BRECCIA_FAILURE;
  record->indefinite = d->indefinite;
  if (!status) {
    matrix_pack(&d->matrix, &s->unknowns, f, right);
    double whole = find_residual(d, right, x);
    for (int n = 0; n < MOST && !status && whole > 0; ++n) {
      status = factors_solve(d->factors, d->correction, error);
      for (size_t k = 0; k < size && !status; ++k) x[k] += d->correction[k];
      if (!status) record->residual = find_residual(d, right, x) / whole;
      if (record->residual <= tolerance || !isfinite(record->residual)) break;
    }
    if (!status) matrix_unpack(&d->matrix, &s->unknowns, x, v);
  }
  free(right);
  free(x);
  return status;
}

static size_t bytes(const LinearSolver *s)
{
  const Direct *d = s->own;
  return factors_bytes(d->factors) + 16 * (size_t)(d->matrix.first ? d->matrix.first[d->matrix.size] : 0);
}

/** By trials on squares and cubes (docs/performance.md): what it takes grows with the places that a row joins, and a little faster than with the unknowns. */
static LinearForesight foresee(const LinearSolver *s)
{
  const Domain *d = s->domain;
  const int axes = d->body.dimensions;
  const int motions = axes + d->particles->space.rows - d->particles->space.rotation; /* of a particle */
  const double count = (double)d->particles->count, small = 200, unknowns = motions * count;
  double row = 0;
  if (axes == 1 || count < small) return (LinearForesight){.bytes = (double)bytes(s)};
  for (int r = 0; r < d->region_count;
       ++r) { /* points on bonds, and links, join two places; families all within two horizons of each other */
    const double family = (double)d->family.bonds / count;
    const FormulationType *type = d->regions[r].type;
    const double joined = type->components == 1 || type->gyration ? family : pow(2, axes) * family;
    row += motions * (1 + joined) * (double)d->regions[r].particles / count;
  }
  row = fmin(row, unknowns);
  if (axes == 2)
    return (LinearForesight){.seconds = 6e-7 * unknowns * row * pow(unknowns / 5e4, 0.15),
                             .bytes = unknowns * (24 * row + 36 * sqrt(row) * log2(unknowns))};
  return (LinearForesight){.seconds = 1.5e-6 * unknowns * row * pow(unknowns / 4e3, 0.3),
                           .bytes = unknowns * (24 * row + 12 * pow(row, 2.0 / 3) * cbrt(unknowns))};
}

const LinearType direct_linear = {.words = "factors of the stiffness",
                                  .suits = suits,
                                  .refusal = matrix_refusal,
                                  .create = create,
                                  .destroy = destroy,
                                  .prepare = prepare,
                                  .solve = solve,
                                  .bytes = bytes,
                                  .foresee = foresee};

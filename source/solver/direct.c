/* Direct solution: the stiffness is assembled (matrix.h) and factored by SuiteSparse, in one order found once for each pattern. What is symmetric and
 * resists every motion is factored by CHOLMOD (Chen and others 2008); all else by UMFPACK (Davis 2004), at two to four times the price. */
#include "solver/linear_solver.h"
#include "solver/matrix.h"

#include "base/library_threads.h"
#include "base/memory.h"
#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <umfpack.h>

typedef struct Direct {
  Matrix matrix;
  int64_t broken, pattern; /* bonds, and what forces beside theirs join, when the matrix was created */
  cholmod_common common;
  cholmod_factor *factor;
  void *symbolic, *numeric; /* of UMFPACK; numeric: it is the one to solve with */
  double *from, *to, *residual;
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

static void forget_factors(Direct *d)
{
  if (d->numeric) umfpack_dl_free_numeric(&d->numeric);
  if (d->symbolic) umfpack_dl_free_symbolic(&d->symbolic);
  if (d->factor) cholmod_l_free_factor(&d->factor, &d->common);
}

static void destroy(LinearSolver *s)
{
  Direct *d = s->own;
  if (!d) return;
  forget_factors(d);
  cholmod_l_finish(&d->common);
  matrix_destroy(&d->matrix);
  free(d->from);
  free(d->to);
  free(d->residual);
  free(d);
}

static int create(LinearSolver *s, Error *error)
{
  Direct *d = s->own = memory_zeroed(1, sizeof *d, "direct solution", error);
  if (!d) return BRECCIA_FAILURE;
  cholmod_l_start(&d->common);
  d->common.print = 0;
  d->common.final_ll = 1;
  d->broken = -1;
  return BRECCIA_OK;
}

static int out_of_memory(Error *error)
{
  return error_add(error, BRECCIA_FAILURE,
                   "out of memory: factors of the equations; solve them by 'equations: conjugate gradients'");
}

/** A matrix of the library that borrows ours: rows of ours are its columns. */
static cholmod_sparse borrow(const Matrix *m)
{
  return (cholmod_sparse){.nrow = (size_t)m->size,
                          .ncol = (size_t)m->size,
                          .nzmax = (size_t)m->first[m->size],
                          .p = m->first,
                          .i = m->column,
                          .x = m->value,
                          .stype = 1,
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
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

static int factor_symmetric(Direct *d, Error *error)
{
  cholmod_sparse a = borrow(&d->matrix);
  if (!d->factor) d->factor = cholmod_l_analyze(&a, &d->common);
  if (!d->factor || d->common.status == CHOLMOD_OUT_OF_MEMORY) return out_of_memory(error);
  cholmod_l_factorize(&a, d->factor, &d->common);
  if (d->common.status == CHOLMOD_OUT_OF_MEMORY) return out_of_memory(error);
  d->indefinite = d->common.status == CHOLMOD_NOT_POSDEF || d->factor->minor < d->factor->n;
  return BRECCIA_OK;
}

static int factor_any(Direct *d, Error *error)
{
  const Matrix *m = &d->matrix;
  long status = UMFPACK_OK;
  if (!d->symbolic)
    status = umfpack_dl_symbolic(m->size, m->size, m->first, m->column, m->value, &d->symbolic, NULL, NULL);
  if (status == UMFPACK_OK)
    status = umfpack_dl_numeric(m->first, m->column, m->value, d->symbolic, &d->numeric, NULL, NULL);
  if (status == UMFPACK_ERROR_out_of_memory) return out_of_memory(error);
  return BRECCIA_OK; /* singular ones show in what is left */
}

static int factor(Direct *d, Error *error)
{
  d->indefinite = false;
  const bool symmetric = matrix_asymmetry(&d->matrix) < 1e-9;
  if (symmetric && factor_symmetric(d, error)) return BRECCIA_FAILURE;
  return symmetric && !d->indefinite ? BRECCIA_OK : factor_any(d, error);
}

static int prepare(LinearSolver *s, Error *error)
{
  Direct *d = s->own;
  int status = BRECCIA_OK;
  const int64_t pattern = forces_pattern(&s->domain->forces);
  if (d->broken != s->domain->broken_count || d->pattern != pattern) {
    forget_factors(d);
    matrix_destroy(&d->matrix);
    status = matrix_create(&d->matrix, &s->unknowns, error);
    double **columns[] = {&d->from, &d->to, &d->residual};
    for (int k = 0; k < 3 && !status; ++k) {
      free(*columns[k]);
      if (!(*columns[k] = memory_zeroed((size_t)d->matrix.size + 1, sizeof(double), "direct solution", error)))
        status = BRECCIA_FAILURE;
    }
    d->broken = status ? -1 : s->domain->broken_count;
    d->pattern = pattern;
  }
  if (!status) status = matrix_fill(&d->matrix, &s->unknowns, s->stiffness_share, s->mass_factor, error);
  if (!status) status = library_memory(error);
  if (status) return status;
  hold_lone_unknowns(&d->matrix);
  if (d->numeric) umfpack_dl_free_numeric(&d->numeric);
  const LibraryThreads before = library_threads_forbid();
  status = factor(d, error);
  library_threads_allow(before);
  return status;
}

/** One solution with the factors. */
static int solve_once(Direct *d, Error *error)
{
  const Matrix *m = &d->matrix;
  if (d->numeric) { /* rows of ours are its columns */
    const long status =
        umfpack_dl_solve(UMFPACK_At, m->first, m->column, m->value, d->to, d->from, d->numeric, NULL, NULL);
    return status == UMFPACK_ERROR_out_of_memory ? out_of_memory(error) : BRECCIA_OK;
  }
  cholmod_dense b = {.nrow = (size_t)m->size,
                     .ncol = 1,
                     .nzmax = (size_t)m->size,
                     .d = (size_t)m->size,
                     .x = d->from,
                     .xtype = CHOLMOD_REAL,
                     .dtype = CHOLMOD_DOUBLE};
  cholmod_dense *x = cholmod_l_solve(CHOLMOD_A, d->factor, &b, &d->common);
  if (!x) return out_of_memory(error);
  memcpy(d->to, x->x, sizeof(double) * (size_t)m->size);
  cholmod_l_free_dense(&x, &d->common);
  return BRECCIA_OK;
}

/** from = f - K x. @return its size */
static double find_residual(Direct *d, const double *f, const double *x)
{
  const Matrix *m = &d->matrix;
  double square = 0;
  for (int64_t row = 0; row < m->size; ++row) {
    double left = f[row];
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) left -= m->value[t] * x[m->column[t]];
    d->from[row] = left;
    square += left * left;
  }
  return sqrt(square);
}

static int solve(LinearSolver *s, double *const f[MOTIONS], double *const v[MOTIONS], double tolerance,
                 LinearRecord *record, Error *error)
{
  enum { MOST = 3 }; /* corrections */
  Direct *d = s->own;
  const size_t size = (size_t)d->matrix.size;
  double *right = memory_zeroed(size + 1, sizeof *right, "direct solution", error);
  double *x = memory_zeroed(size + 1, sizeof *x, "direct solution", error);
  int status = right && x ? BRECCIA_OK : BRECCIA_FAILURE;
  record->indefinite = d->indefinite;
  const LibraryThreads before = library_threads_forbid();
  if (!status) {
    matrix_pack(&d->matrix, &s->unknowns, f, right);
    double whole = find_residual(d, right, x);
    for (int n = 0; n < MOST && !status && whole > 0; ++n) {
      status = solve_once(d, error);
      for (size_t k = 0; k < size && !status; ++k) x[k] += d->to[k];
      if (!status) record->residual = find_residual(d, right, x) / whole;
      if (record->residual <= tolerance || !isfinite(record->residual)) break;
    }
    if (!status) matrix_unpack(&d->matrix, &s->unknowns, x, v);
  }
  library_threads_allow(before);
  free(right);
  free(x);
  return status;
}

static size_t bytes(const LinearSolver *s)
{
  const Direct *d = s->own;
  return d->common.memory_usage + 16 * (size_t)(d->matrix.first ? d->matrix.first[d->matrix.size] : 0);
}

/** By trials on squares and cubes (docs/performance.md): what it takes grows with the places that a row joins, and a little faster than with the unknowns. */
static LinearForesight foresee(const LinearSolver *s)
{
  const Domain *d = s->domain;
  const int axes = d->body.dimensions;
  const int motions = axes + d->particles->motions - ROTATION; /* of a particle */
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

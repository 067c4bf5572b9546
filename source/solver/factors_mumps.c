/* Factors by MUMPS (Amestoy et al. 2001, SIAM J. Matrix Anal. Appl. 23, 15), the sequential library in double
 * precision.
 *
 * A symmetric matrix is factored as L D L^T without pivoting first. If D has a negative or zero entry, the matrix is
 * not positive definite and is factored again with pivots of one and two rows. The elimination orders are MUMPS's own,
 * of approximate minimum degree or fill. PORD would end the process if memory is refused, and orders of Scotch differ
 * from run to run. MUMPS keeps state in its modules: a lock lets one thread call it at a time. It reports large
 * allocations that are refused, and crashes at some small ones: each phase begins only if the system has what the phase
 * needs. */
#include "solver/factors.h"

#include "base/library_threads.h"
#include "base/memory.h"
#include <dmumps_c.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/** Kind of a matrix, as MUMPS numbers them. */
typedef enum MatrixKind { KIND_GENERAL = 0, KIND_POSITIVE = 1, KIND_SYMMETRIC = 2, KIND_NONE = 3 } MatrixKind;

/** Phases of MUMPS. */
enum { JOB_BEGIN = -1, JOB_END = -2, JOB_ANALYSE = 1, JOB_FACTOR = 2, JOB_SOLVE = 3 };

/** Statuses of MUMPS (INFOG(1)); others below zero are allocations that were refused, but for errors of the caller. */
enum { STATUS_SINGULAR = -10, STATUS_STRUCTURE_SINGULAR = -6, STATUS_NO_ROOM = -13 };

enum {
  COMMUNICATOR = -987654, /* stands for all processes */
  ORDER_DEGREE = 0,       /* approximate minimum degree: the better one of most plane bodies */
  ORDER_FILL = 2,         /* approximate minimum fill: the better one of most bodies in space */
  SPARE_STEPS = 5         /* times that the spare workspace is doubled */
};

struct Factors {
  /** What the factors serve, for messages. */
  const char *purpose;
  /** Instance of MUMPS; it holds analysis and factors of matrices of `kind`. */
  DMUMPS_STRUC_C *mumps;
  MatrixKind kind;
  /** True if `mumps` has factors to solve with. */
  bool factored;
};

static pthread_mutex_t factors_lock = PTHREAD_MUTEX_INITIALIZER;

Factors *factors_create(const char *purpose, Error *error)
{
  Factors *f = memory_zeroed(1, sizeof *f, purpose, error);
  if (!f) return NULL;
  f->purpose = purpose;
  f->kind = KIND_NONE;
  f->mumps = memory_zeroed(1, sizeof *f->mumps, purpose, error);
  if (!f->mumps) factors_destroy(&f);
  return f;
}

/** Returns about how many bytes a phase allocates; not less. */
static size_t factors_need(const DMUMPS_STRUC_C *m, int job)
{
  const double rows = (double)m->n, entries = (double)m->nnz, spare = (100.0 + m->icntl[13]) / 100;
  double bytes = 4e6; /* small allocations */
  if (job == JOB_ANALYSE) bytes += 48 * entries + 200 * rows;
  if (job == JOB_FACTOR) bytes += 1e6 * m->infog[16] * spare + 16 * entries;
  if (job == JOB_SOLVE) bytes += 64 * rows;
  return (size_t)bytes;
}

/** Runs a phase of MUMPS. @return its status, INFOG(1): 0 or a warning > 0, or an error < 0 */
static int factors_run(Factors *f, int job)
{
  if (job != JOB_END && !library_room(factors_need(f->mumps, job))) return f->mumps->infog[0] = STATUS_NO_ROOM;
  const LibraryThreads before = library_threads_forbid();
  pthread_mutex_lock(&factors_lock);
  f->mumps->job = job;
  dmumps_c(f->mumps);
  pthread_mutex_unlock(&factors_lock);
  library_threads_allow(before);
  return f->mumps->infog[0];
}

static void factors_end(Factors *f)
{
  if (f->kind != KIND_NONE) factors_run(f, JOB_END);
  f->kind = KIND_NONE;
  f->factored = false;
}

void factors_destroy(Factors **factors)
{
  Factors *f = *factors;
  if (!f) return;
  factors_end(f);
  free(f->mumps);
  free(f);
  *factors = NULL;
}

static int factors_out_of_memory(const Factors *f, Error *error)
{
  return error_add(
      error, BRECCIA_FAILURE,
      "out of memory: %s, in MUMPS (its error %d); a smaller body takes less, or 'equations: conjugate gradients'",
      f->purpose, (int)f->mumps->infog[0]);
}

/** Begins an instance for matrices of a kind. */
static int factors_begin(Factors *f, MatrixKind kind, Error *error)
{
  factors_end(f);
  memset(f->mumps, 0, sizeof *f->mumps);
  f->mumps->comm_fortran = COMMUNICATOR;
  f->mumps->par = 1;
  f->mumps->sym = (MUMPS_INT)kind;
  if (factors_run(f, JOB_BEGIN) < 0) return factors_out_of_memory(f, error);
  f->kind = kind;
  for (int k = 0; k < 3; ++k) f->mumps->icntl[k] = -1; /* prints nothing */
  f->mumps->icntl[3] = 0;
  f->mumps->icntl[5] = 0;  /* columns stay, whatever the values */
  f->mumps->icntl[11] = 1; /* and so does the order of a symmetric matrix */
  return BRECCIA_OK;
}

/** Entries of a matrix as MUMPS takes them. */
typedef struct Entries {
  MUMPS_INT *row, *column;
  double *value;
  int64_t count;
} Entries;

static void entries_free(Entries *e)
{
  free(e->row);
  free(e->column);
  free(e->value);
}

static int entries_make(Entries *e, const SparseMatrix *m, bool symmetric, const char *purpose, Error *error)
{
  for (int64_t row = 0; row < m->size; ++row)
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) e->count += !symmetric || m->column[t] <= row;
  e->row = memory_reserved((size_t)e->count + 1, sizeof *e->row, purpose, error);
  e->column = memory_reserved((size_t)e->count + 1, sizeof *e->column, purpose, error);
  e->value = memory_reserved((size_t)e->count + 1, sizeof *e->value, purpose, error);
  if (!e->row || !e->column || !e->value) return BRECCIA_FAILURE;
  int64_t n = 0;
  for (int64_t row = 0; row < m->size; ++row)
    for (int64_t t = m->first[row]; t < m->first[row + 1]; ++t) {
      if (symmetric && m->column[t] > row) continue;
      e->row[n] = (MUMPS_INT)row + 1;
      e->column[n] = (MUMPS_INT)m->column[t] + 1;
      e->value[n++] = m->value[t];
    }
  return BRECCIA_OK;
}

/** Returns true for a status that says that the spare workspace was too small, and more of it may do. */
static bool factors_short_of_space(int status)
{
  return status == -8 || status == -9 || status == -14 || status == -15 || status == -17 || status == -20;
}

/** Analyses a matrix, in the order that takes fewer operations. @return status */
static int factors_analyse(Factors *f)
{
  DMUMPS_STRUC_C *m = f->mumps;
  m->icntl[6] = ORDER_FILL;
  int status = factors_run(f, JOB_ANALYSE);
  const double operations = m->rinfog[0];
  m->icntl[6] = ORDER_DEGREE;
  if (status >= 0) status = factors_run(f, JOB_ANALYSE);
  if (status < 0 || m->rinfog[0] <= operations) return status;
  m->icntl[6] = ORDER_FILL;
  return factors_run(f, JOB_ANALYSE);
}

/** Factors the entries as a matrix of a kind. @param[out] singular  there are no factors */
static int factors_numeric(Factors *f, MatrixKind kind, const Entries *e, int64_t size, bool *singular, Error *error)
{
  const bool begun = f->kind == kind;
  DMUMPS_STRUC_C *m = f->mumps;
  int status = 0;
  if (!begun && factors_begin(f, kind, error)) return BRECCIA_FAILURE;
  f->factored = false;
  m->n = (MUMPS_INT)size;
  m->nnz = e->count;
  m->irn = e->row;
  m->jcn = e->column;
  m->a = e->value;
  if (!begun) status = factors_analyse(f);
  const int spare = m->icntl[13];
  if (status >= 0) status = factors_run(f, JOB_FACTOR);
  for (int n = 0; n < SPARE_STEPS && factors_short_of_space(status); ++n) {
    m->icntl[13] = 2 * m->icntl[13] + 20;
    status = factors_run(f, JOB_FACTOR);
  }
  m->icntl[13] = spare; /* so that what comes does not depend on what was */
  *singular = status == STATUS_SINGULAR || status == STATUS_STRUCTURE_SINGULAR;
  f->factored = status >= 0;
  m->irn = m->jcn = NULL;
  m->a = NULL;
  if (status >= 0 || *singular) return BRECCIA_OK;
  const int failed = factors_out_of_memory(f, error);
  factors_end(f);
  return failed;
}

int factors_compute(Factors *f, const SparseMatrix *matrix, bool symmetric, bool *indefinite, Error *error)
{
  Entries entries = {0};
  bool singular = false;
  *indefinite = false;
  if (matrix->size == 0) return BRECCIA_OK;
  if (matrix->size >= INT_MAX)
    return error_add(
        error, BRECCIA_FAILURE,
        "%s: %lld equations are too many for MUMPS, which counts to %d; solve by 'equations: conjugate gradients'",
        f->purpose, (long long)matrix->size, INT_MAX);
  int status = library_memory(error);
  if (!status) status = entries_make(&entries, matrix, symmetric, f->purpose, error);
  if (!status)
    status = factors_numeric(f, symmetric ? KIND_POSITIVE : KIND_GENERAL, &entries, matrix->size, &singular, error);
  if (!status && symmetric) {
    *indefinite = singular || f->mumps->infog[11] > 0;
    if (*indefinite) status = factors_numeric(f, KIND_SYMMETRIC, &entries, matrix->size, &singular, error);
  }
  entries_free(&entries);
  return status;
}

int factors_solve(Factors *f, double *x, Error *error)
{
  if (!f->factored) {
    for (int64_t k = 0; k < (f->kind == KIND_NONE ? 0 : f->mumps->n); ++k) x[k] = NAN;
    return BRECCIA_OK;
  }
  f->mumps->rhs = x;
  f->mumps->nrhs = 1;
  f->mumps->lrhs = f->mumps->n;
  const int status = factors_run(f, JOB_SOLVE);
  f->mumps->rhs = NULL;
  return status < 0 ? factors_out_of_memory(f, error) : BRECCIA_OK;
}

size_t factors_bytes(const Factors *f)
{
  if (!f || !f->factored) return 0;
  const double entries = f->mumps->infog[28] < 0 ? -1e6 * f->mumps->infog[28] : f->mumps->infog[28];
  return (size_t)fmax(1e6 * f->mumps->infog[18], sizeof(double) * entries); /* of small ones MUMPS tells 0 MB */
}

const char *factors_library(void)
{
  return "MUMPS " MUMPS_VERSION;
}

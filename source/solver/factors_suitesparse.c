/* Factors by SuiteSparse, in builds with BRECCIA_SUITESPARSE: a symmetric and positive definite matrix by CHOLMOD (Chen
 * et al. 2008, ACM Trans. Math. Softw. 35, 22), every other by UMFPACK (Davis 2004, ACM Trans. Math. Softw. 30, 196).
 * Supernodes of CHOLMOD and UMFPACK are under the GPL, and so is a program with them as a whole. */
#include "solver/factors.h"

#include "base/library_threads.h"
#include "base/memory.h"
#include <cholmod.h>
#include <stdlib.h>
#include <string.h>
#include <umfpack.h>

struct Factors {
  /** What the factors serve, for messages. */
  const char *purpose;
  /** The matrix that was factored last, borrowed. */
  SparseMatrix matrix;
  cholmod_common common;
  cholmod_factor *factor;
  /** Factors of UMFPACK; with them UMFPACK solves. */
  void *numeric;
  /** Size of `numeric`, in bytes. */
  double numeric_bytes;
  /** Right-hand side of UMFPACK [matrix.size]. */
  double *right;
};

Factors *factors_create(const char *purpose, Error *error)
{
  Factors *f = memory_zeroed(1, sizeof *f, purpose, error);
  if (!f) return NULL;
  f->purpose = purpose;
  cholmod_l_start(&f->common);
  f->common.print = 0;
  f->common.final_ll = 1;
  return f;
}

void factors_destroy(Factors **factors)
{
  Factors *f = *factors;
  if (!f) return;
  if (f->numeric) umfpack_dl_free_numeric(&f->numeric);
  if (f->factor) cholmod_l_free_factor(&f->factor, &f->common);
  cholmod_l_finish(&f->common);
  free(f->right);
  free(f);
  *factors = NULL;
}

static int factors_out_of_memory(const Factors *f, Error *error)
{
  return error_add(error, BRECCIA_FAILURE,
                   "out of memory: %s, in SuiteSparse; a smaller body takes less, or 'equations: conjugate gradients'",
                   f->purpose);
}

/** Our matrix as one of CHOLMOD: our rows are its columns. */
static cholmod_sparse factors_borrow(const SparseMatrix *m)
{
  return (cholmod_sparse){.nrow = (size_t)m->size,
                          .ncol = (size_t)m->size,
                          .nzmax = (size_t)m->first[m->size],
                          .p = (void *)m->first,
                          .i = (void *)m->column,
                          .x = (void *)m->value,
                          .stype = 1,
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
}

static int factors_positive(Factors *f, bool *indefinite, Error *error)
{
  cholmod_sparse a = factors_borrow(&f->matrix);
  if (!f->factor) f->factor = cholmod_l_analyze(&a, &f->common);
  if (!f->factor || f->common.status == CHOLMOD_OUT_OF_MEMORY) return factors_out_of_memory(f, error);
  cholmod_l_factorize(&a, f->factor, &f->common);
  if (f->common.status == CHOLMOD_OUT_OF_MEMORY) return factors_out_of_memory(f, error);
  *indefinite = f->common.status == CHOLMOD_NOT_POSDEF || f->factor->minor < f->factor->n;
  return BRECCIA_OK;
}

static int factors_general(Factors *f, Error *error)
{
  const SparseMatrix *m = &f->matrix;
  double info[UMFPACK_INFO] = {0};
  /* The analysis depends on values, too: made again each time, so that bits do not depend on earlier matrices. */
  void *symbolic = NULL;
  if (!f->right) f->right = memory_zeroed((size_t)m->size, sizeof *f->right, f->purpose, error);
  if (!f->right) return BRECCIA_FAILURE;
  long status = umfpack_dl_symbolic(m->size, m->size, m->first, m->column, m->value, &symbolic, NULL, NULL);
  if (status == UMFPACK_OK)
    status = umfpack_dl_numeric(m->first, m->column, m->value, symbolic, &f->numeric, NULL, info);
  f->numeric_bytes = info[UMFPACK_NUMERIC_SIZE] * info[UMFPACK_SIZE_OF_UNIT];
  if (symbolic) umfpack_dl_free_symbolic(&symbolic);
  return status == UMFPACK_ERROR_out_of_memory ? factors_out_of_memory(f, error) : BRECCIA_OK;
}

int factors_compute(Factors *f, const SparseMatrix *matrix, bool symmetric, bool *indefinite, Error *error)
{
  *indefinite = false;
  f->matrix = *matrix;
  if (f->numeric) umfpack_dl_free_numeric(&f->numeric);
  int status = library_memory(error);
  const LibraryThreads before = library_threads_forbid();
  if (!status && symmetric) status = factors_positive(f, indefinite, error);
  if (!status && (!symmetric || *indefinite)) status = factors_general(f, error);
  library_threads_allow(before);
  return status;
}

static int factors_solve_positive(Factors *f, double *x, Error *error)
{
  const size_t size = (size_t)f->matrix.size;
  cholmod_dense b = {
      .nrow = size, .ncol = 1, .nzmax = size, .d = size, .x = x, .xtype = CHOLMOD_REAL, .dtype = CHOLMOD_DOUBLE};
  cholmod_dense *found = cholmod_l_solve(CHOLMOD_A, f->factor, &b, &f->common);
  if (!found) return factors_out_of_memory(f, error);
  memcpy(x, found->x, sizeof(double) * size);
  cholmod_l_free_dense(&found, &f->common);
  return BRECCIA_OK;
}

static int factors_solve_general(Factors *f, double *x, Error *error)
{
  const SparseMatrix *m = &f->matrix;
  memcpy(f->right, x, sizeof(double) * (size_t)m->size);
  const long status = umfpack_dl_solve(UMFPACK_At, m->first, m->column, m->value, x, f->right, f->numeric, NULL, NULL);
  return status == UMFPACK_ERROR_out_of_memory ? factors_out_of_memory(f, error) : BRECCIA_OK;
}

int factors_solve(Factors *f, double *x, Error *error)
{
  const LibraryThreads before = library_threads_forbid();
  const int status = f->numeric ? factors_solve_general(f, x, error) : factors_solve_positive(f, x, error);
  library_threads_allow(before);
  return status;
}

size_t factors_bytes(const Factors *f)
{
  return f ? f->common.memory_usage + (f->numeric ? (size_t)f->numeric_bytes : 0) : 0;
}

const char *factors_library(void)
{
  return "SuiteSparse's CHOLMOD and UMFPACK";
}

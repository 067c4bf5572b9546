/* Factors of a sparse matrix, by one library for all callers: MUMPS (factors_mumps.c), or CHOLMOD and UMFPACK in builds
 * with BRECCIA_SUITESPARSE (factors_suitesparse.c). The elimination order follows from the positions of the entries, so
 * that factors of a matrix have the same bits whatever was factored before. The library works by the calling thread. */
#ifndef BRECCIA_SOLVER_FACTORS_H
#define BRECCIA_SOLVER_FACTORS_H

#include "base/error.h"
#include <stdint.h>

/** A sparse matrix, row by row. */
typedef struct SparseMatrix {
  /** Number of rows and columns. */
  int64_t size;
  /** Index of the first entry of each row [size + 1]. */
  const int64_t *first;
  /** Column of each entry, ascending in a row. */
  const int64_t *column;
  /** Value of each entry. */
  const double *value;
} SparseMatrix;

typedef struct Factors Factors;

/** Creates empty factors.
 *  @param[in] purpose  what they serve, for messages; borrowed
 *  @return NULL after adding a line */
Factors *factors_create(const char *purpose, Error *error);
void factors_destroy(Factors **factors);

/** Factors a matrix. All matrices of one object have their entries at the same positions.
 *  @param[in] matrix       borrowed until the next call or the end
 *  @param[in] symmetric    entries beyond the diagonal (column > row) may be missing if the matrix is positive definite
 *  @param[out] indefinite  the matrix is symmetric, and not positive definite; it is factored all the same
 *  @return BRECCIA_FAILURE after adding a line if memory is out. A singular matrix is no failure: its solutions are not
 *          finite, or leave a residual */
int factors_compute(Factors *factors, const SparseMatrix *matrix, bool symmetric, bool *indefinite, Error *error);

/** Solves with the matrix that was factored last.
 *  @param[in,out] x  right-hand side [size], overwritten by the solution
 *  @return BRECCIA_FAILURE after adding a line if memory is out */
int factors_solve(Factors *factors, double *x, Error *error);

/** Returns the memory that factors and work arrays take. @param[in] factors  may be NULL */
size_t factors_bytes(const Factors *factors);

/** Returns name and version of the library, "MUMPS 5.5.1". */
const char *factors_library(void);

#endif

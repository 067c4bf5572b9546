/* Small dense systems of equations. */
#ifndef BRECCIA_BASE_LINEAR_H
#define BRECCIA_BASE_LINEAR_H

#include <stdbool.h>

/** Solves a x = right by Gaussian elimination with pivots; both are overwritten, `right` by x.
 *  @param[in,out] a      [size][size]
 *  @param[in,out] right  [size][columns]
 *  @return false: the matrix is singular, a pivot being less than 1e-12 of its largest entry */
bool linear_solve(int size, double *a, int columns, double *right);

/** Factors a symmetric positive definite matrix as L L^T (Cholesky), row by row; zeros before the first entry of a row
 * are skipped.
 *  @param[in,out] a   [size][size]; entries up to the diagonal are read, and overwritten by L
 *  @param[out] begin  [size] column of the first entry of each row
 *  @return false: the matrix is not positive definite, and `a` holds no factor */
bool linear_factor(int size, double *a, int *begin);

/** Solves with the factor L L^T of linear_factor.
 *  @param[in,out] x  right-hand side [size], overwritten by the solution */
void linear_factor_solve(int size, const double *a, const int *begin, double *x);

#endif

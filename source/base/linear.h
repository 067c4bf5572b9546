/* Small dense systems of equations. */
#ifndef BRECCIA_BASE_LINEAR_H
#define BRECCIA_BASE_LINEAR_H

#include <stdbool.h>

/** Solves a x = right by Gaussian elimination with pivots; both are overwritten, `right` by x.
 *  @param[in,out] a      [size][size]
 *  @param[in,out] right  [size][columns]
 *  @return false: the matrix is singular, a pivot being less than 1e-12 of its largest entry */
bool linear_solve(int size, double *a, int columns, double *right);

#endif

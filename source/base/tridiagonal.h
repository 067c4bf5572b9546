/* Symmetric matrices with three diagonals, as Lanczos' method and conjugate gradients make them. */
#ifndef BRECCIA_BASE_TRIDIAGONAL_H
#define BRECCIA_BASE_TRIDIAGONAL_H

/** The largest eigenvalue, to ten digits, by counting those above a number (Sturm) and halving.
 *  @param[in] alpha  [n] diagonal
 *  @param[in] beta   [n] beside it: beta[k] joins k - 1 and k; beta[0] is not read */
double tridiagonal_largest(const double *alpha, const double *beta, int n);

#endif

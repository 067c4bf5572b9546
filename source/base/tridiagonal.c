#include "base/tridiagonal.h"

#include <math.h>

/** Number of eigenvalues of the tridiagonal matrix that are larger than x. */
static int count_above(const double *alpha, const double *beta, int n, double x)
{
  int count = 0;
  double q = 1;
  for (int k = 0; k < n; ++k) {
    q = alpha[k] - x - (k ? beta[k] * beta[k] / q : 0);
    if (q == 0) q = 1e-300;
    count += q > 0;
  }
  return count;
}

double tridiagonal_largest(const double *alpha, const double *beta, int n)
{
  double low = alpha[0], high = 0;
  for (int k = 0; k < n; ++k) {
    double row = alpha[k] + (k ? fabs(beta[k]) : 0) + (k + 1 < n ? fabs(beta[k + 1]) : 0);
    high = fmax(high, row);
    low = fmin(low, alpha[k]);
  }
  for (int k = 0; k < 100 && high - low > 1e-10 * fabs(high); ++k) {
    double middle = (low + high) / 2;
    if (count_above(alpha, beta, n, middle))
      low = middle;
    else
      high = middle;
  }
  return high;
}

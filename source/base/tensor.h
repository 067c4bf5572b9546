/* Small tensors. A 3 x 3 tensor is nine numbers row by row; a symmetric one is six in the order xx yy zz xy yz zx. */
#ifndef BRECCIA_BASE_TENSOR_H
#define BRECCIA_BASE_TENSOR_H

#include <math.h>

enum { XX, YY, ZZ, XY, YZ, ZX };
/** How decks, files and messages spell the components. */
static const char *const component_names[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};

/** Row and column of a symmetric component in a full tensor: full[3 * r + c]. */
static const int symmetric_row[6] = {0, 1, 2, 0, 1, 2}, symmetric_column[6] = {0, 1, 2, 1, 2, 0};
/** Place in a symmetric tensor of component (r, c). */
static const int symmetric_place[9] = {XX, XY, ZX, XY, YY, YZ, ZX, YZ, ZZ};

static inline double tensor_determinant(const double s[6])
{
  return s[XX] * (s[YY] * s[ZZ] - s[YZ] * s[YZ]) - s[XY] * (s[XY] * s[ZZ] - s[YZ] * s[ZX]) +
         s[ZX] * (s[XY] * s[YZ] - s[YY] * s[ZX]);
}

/** Inverse of a symmetric tensor whose determinant is not zero. */
static inline void tensor_inverse(const double s[6], double inverse[6])
{
  double scale = 1 / tensor_determinant(s);
  inverse[XX] = scale * (s[YY] * s[ZZ] - s[YZ] * s[YZ]);
  inverse[YY] = scale * (s[XX] * s[ZZ] - s[ZX] * s[ZX]);
  inverse[ZZ] = scale * (s[XX] * s[YY] - s[XY] * s[XY]);
  inverse[XY] = scale * (s[YZ] * s[ZX] - s[XY] * s[ZZ]);
  inverse[YZ] = scale * (s[XY] * s[ZX] - s[XX] * s[YZ]);
  inverse[ZX] = scale * (s[XY] * s[YZ] - s[YY] * s[ZX]);
}

/** Eigenvalues and orthonormal eigenvectors (columns) of a symmetric tensor by cyclic Jacobi rotations. */
static inline void tensor_eigen(const double s[6], double value[3], double vector[9])
{
  double a[9];
  for (int k = 0; k < 9; ++k) {
    a[k] = s[symmetric_place[k]];
    vector[k] = k % 4 == 0;
  }
  for (int sweep = 0; sweep < 50; ++sweep) {
    double off = a[1] * a[1] + a[2] * a[2] + a[5] * a[5];
    double diagonal = a[0] * a[0] + a[4] * a[4] + a[8] * a[8];
    if (off <= 1e-32 * diagonal || off == 0) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[3 * p + q] == 0) continue;
        double theta = (a[4 * q] - a[4 * p]) / (2 * a[3 * p + q]);
        double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
        double c = 1 / sqrt(t * t + 1), sn = t * c;
        for (int k = 0; k < 3; ++k) {
          double x = a[3 * k + p], y = a[3 * k + q];
          a[3 * k + p] = c * x - sn * y;
          a[3 * k + q] = sn * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          double x = a[3 * p + k], y = a[3 * q + k];
          a[3 * p + k] = c * x - sn * y;
          a[3 * q + k] = sn * x + c * y;
          x = vector[3 * k + p], y = vector[3 * k + q];
          vector[3 * k + p] = c * x - sn * y;
          vector[3 * k + q] = sn * x + c * y;
        }
      }
  }
  for (int k = 0; k < 3; ++k) value[k] = a[4 * k];
}

/** Octahedral shear stress sqrt(2 J2 / 3) (docs/theory.md, S0, eq. 23). */
static inline double tensor_octahedral_shear(const double s[6])
{
  double a = s[XX] - s[YY], b = s[XX] - s[ZZ], c = s[YY] - s[ZZ];
  return sqrt(a * a + b * b + c * c + 6 * (s[XY] * s[XY] + s[YZ] * s[YZ] + s[ZX] * s[ZX])) / 3;
}

#endif

/* Isotropic laws written in principal values: stress and tangent from a spectral decomposition. */
#ifndef BRECCIA_CONSTITUTIVE_SPECTRAL_H
#define BRECCIA_CONSTITUTIVE_SPECTRAL_H

#include "constitutive/solid/solid_law.h"

typedef struct Spectrum {
  double value[3], vector[9]; /* in descending order; eigenvectors are columns */
} Spectrum;

static inline Spectrum spectrum_of(const double a[6])
{
  Spectrum raw, sorted;
  tensor_eigen(a, raw.value, raw.vector);
  int order[3] = {0, 1, 2};
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < 2; ++k)
      if (raw.value[order[k]] < raw.value[order[k + 1]]) {
        int other = order[k];
        order[k] = order[k + 1];
        order[k + 1] = other;
      }
  for (int k = 0; k < 3; ++k) {
    sorted.value[k] = raw.value[order[k]];
    for (int r = 0; r < 3; ++r) sorted.vector[3 * r + k] = raw.vector[3 * r + order[k]];
  }
  return sorted;
}

/** The symmetric tensor with these eigenvalues and the spectrum's eigenvectors. */
static inline void spectral_tensor(const Spectrum *s, const double value[3], double tensor[6])
{
  for (int k = 0; k < 6; ++k) {
    tensor[k] = 0;
    for (int a = 0; a < 3; ++a)
      tensor[k] += value[a] * s->vector[3 * symmetric_row[k] + a] * s->vector[3 * symmetric_column[k] + a];
  }
}

/** Tangent of an isotropic tensor function: principal stresses, and their derivatives to principal strains [3][3], on the spectrum of
 *  the strain (de Souza Neto, Peric and Owen 2008, box A.6). */
static inline void spectral_tangent(const Spectrum *strain, const double stress[3], const double slopes[9],
                                    double tangent[36])
{
  double basis[6][6]; /* of the pairs aa, bb, cc, ab, bc, ca */
  double widest = fmax(fabs(strain->value[0]), fabs(strain->value[2]));
  for (int n = 0; n < 6; ++n) {
    const int a = symmetric_row[n], b = symmetric_column[n];
    for (int k = 0; k < 6; ++k) {
      const int r = symmetric_row[k], c = symmetric_column[k];
      basis[n][k] = (strain->vector[3 * r + a] * strain->vector[3 * c + b] +
                     strain->vector[3 * r + b] * strain->vector[3 * c + a]) /
                    2;
    }
  }
  for (int k = 0; k < 36; ++k) tangent[k] = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k) tangent[6 * i + k] += slopes[3 * a + b] * basis[a][i] * basis[b][k];
  for (int n = 3; n < 6; ++n) {
    const int a = symmetric_row[n], b = symmetric_column[n];
    const double apart = strain->value[a] - strain->value[b];
    const double turn = fabs(apart) > 1e-9 * widest
                            ? (stress[a] - stress[b]) / apart
                            : (slopes[4 * a] - slopes[3 * a + b] + slopes[4 * b] - slopes[3 * b + a]) / 2;
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 6; ++k) tangent[6 * i + k] += 2 * turn * basis[n][i] * basis[n][k];
  }
}

#endif

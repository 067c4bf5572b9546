/* Isotropic laws written in principal values: spectral decompositions of symmetric tensors side by side, without branches, and what stress and tangent are by
 * them. */
#ifndef BRECCIA_CONSTITUTIVE_SPECTRAL_H
#define BRECCIA_CONSTITUTIVE_SPECTRAL_H

#include "base/lanes.h"
#include "base/tensor.h"

typedef struct Spectrum {
  Lanes value[3], vector[3][3]; /* in descending order; vector[a] belongs to value[a] */
} Spectrum;

/** The deviator of a symmetric tensor, and the eigenvalue of it that stands apart from the other two: a = 2^n (mean + b). */
typedef struct SpectrumApart {
  Lanes scale, mean, b[6]; /* 2^n */
  Lanes value;             /* of b */
  Lanes adjugate
      [6]; /* of b - value: nothing but its vector v, (value - value 2) (value - value 3) v v; 1, 0 ... where b is nothing */
  LaneMask least; /* it is the smallest value */
} SpectrumApart;

/** By a closed form: with size^2 = |b|^2 / 6 the values are 2 size cos of angles a third of a turn apart. The one that stands apart is the largest where the
 *  determinant is positive, otherwise the smallest, and size times the largest root of t^3 - 3 t = 2 h, which is smooth in h from 0 to 1: a polynomial that is
 *  right to 1e-6, and a step of Halley's method. */
LANES_INLINE SpectrumApart spectrum_apart(const Lanes a[6])
{
  SpectrumApart x;
  const Lanes one = lanes_set(1), half = lanes_set(0.5);
  Lanes most = lanes_absolute(a[0]);
  for (int k = 1; k < 6; ++k) most = lanes_greatest(most, lanes_absolute(a[k]));
  most = lanes_choose(most > lanes_set(1e-300), most, one);
  const LaneMask exponents = (LaneMask)lanes_set(INFINITY);
  x.scale = (Lanes)((LaneMask)most & exponents);
  const Lanes shrink = (Lanes)((LaneMask)lanes_set(0x1p1023) - (LaneMask)x.scale); /* 2^-n */
  for (int k = 0; k < 6; ++k) x.b[k] = lanes_product(a[k], shrink);
  x.mean = lanes_product(x.b[XX] + x.b[YY] + x.b[ZZ], lanes_set(1.0 / 3));
  for (int k = 0; k < 3; ++k) x.b[k] -= x.mean;
  /* Where all values are alike roundings of the mean are much beside what is left. */
  const Lanes missed = lanes_product(x.b[XX] + x.b[YY] + x.b[ZZ], lanes_set(1.0 / 3));
  for (int k = 0; k < 3; ++k) x.b[k] -= missed;
  x.mean += missed;
  const Lanes *b = x.b;
  const Lanes square =
      lanes_set(1.0 / 3) * (lanes_square(b[XX], b[YY], b[ZZ]) * half + lanes_square(b[XY], b[YZ], b[ZX]));
  const LaneMask apart = square > lanes_set(1e-60); /* otherwise all values are alike */
  for (int k = 0; k < 6; ++k) x.b[k] = lanes_where(apart, x.b[k]);
  const Lanes size = lanes_root(lanes_where(apart, square)), cube = lanes_choose(apart, square * size, one);
  const Lanes determinant =
      lanes_dot(b[XX], lanes_cross(b[YY], b[ZZ], b[YZ], b[YZ]), b[XY], lanes_cross(b[YZ], b[ZX], b[XY], b[ZZ]), b[ZX],
                lanes_cross(b[XY], b[YZ], b[YY], b[ZX]));
  const LaneMask sign = (LaneMask)determinant & (LaneMask)lanes_set(-0.0);
  x.least = determinant < lanes_set(0);
  const Lanes h = lanes_least(lanes_absolute(determinant) * half / cube, one), h2 = h * h;
  Lanes t = (lanes_set(1.7320519648958261) + lanes_set(0.3332451278937458) * h) +
            h2 * ((lanes_set(-0.09510725177575985) + lanes_set(0.04395557114353155) * h) +
                  h2 * (lanes_set(-0.018108343904695623) + lanes_set(0.003963813196744326) * h));
  const Lanes t2 = t * t, gap = t * (t2 - lanes_set(3)) - (h + h), slope = lanes_set(3) * (t2 - one);
  t -= gap * slope / lanes_cross(slope, slope, lanes_set(3) * t, gap);
  x.value = (Lanes)((LaneMask)(t * size) ^ sign);
  const Lanes xx = b[XX] - x.value, yy = b[YY] - x.value, zz = b[ZZ] - x.value;
  const Lanes adjugate[6] = {lanes_cross(yy, zz, b[YZ], b[YZ]),    lanes_cross(xx, zz, b[ZX], b[ZX]),
                             lanes_cross(xx, yy, b[XY], b[XY]),    lanes_cross(b[ZX], b[YZ], b[XY], zz),
                             lanes_cross(b[XY], b[ZX], b[YZ], xx), lanes_cross(b[XY], b[YZ], b[ZX], yy)};
  for (int k = 0; k < 6; ++k) x.adjugate[k] = k ? adjugate[k] : lanes_choose(apart, adjugate[k], one);
  return x;
}

/** Eigenvalues in descending order, from the two that do not stand apart. */
LANES_INLINE void spectrum_sort(const SpectrumApart *x, Lanes high, Lanes low, Lanes value[3])
{
  value[0] = (x->mean + lanes_choose(x->least, high, x->value)) * x->scale;
  value[1] = (x->mean + lanes_choose(x->least, low, high)) * x->scale;
  value[2] = (x->mean + lanes_choose(x->least, x->value, low)) * x->scale;
}

/** A symmetric tensor in parts that need no vectors. */
typedef struct SpectrumParts {
  Lanes value[3]; /* in descending order */
  /* v v of the value that stands apart; radius (p p - q q) of the others' vectors; half of what these differ by, scaled. */
  Lanes alone[6], pair[6], radius;
  LaneMask least; /* the smallest value stands apart */
} SpectrumParts;

/** Eigenvalues to a few roundings of the largest component, however close they are: the two that do not stand apart are what b less the third leaves. */
LANES_INLINE SpectrumParts spectrum_parts(const SpectrumApart *x)
{
  const Lanes middle = lanes_product(lanes_set(-0.5), x->value), part = lanes_set(3) * middle,
              shorten = lanes_set(1) / (x->adjugate[XX] + x->adjugate[YY] + x->adjugate[ZZ]);
  SpectrumParts out;
  out.least = x->least;
  for (int k = 0; k < 6; ++k) {
    out.alone[k] = lanes_product(x->adjugate[k], shorten);
    out.pair[k] = x->b[k] + part * out.alone[k];
    if (k < 3) out.pair[k] -= middle;
  }
  const Lanes *pair = out.pair;
  out.radius = lanes_root(lanes_square(pair[XX], pair[YY], pair[ZZ]) * lanes_set(0.5) +
                          lanes_square(pair[XY], pair[YZ], pair[ZX]));
  const Lanes high = middle + out.radius, low = middle - out.radius;
  spectrum_sort(x, high, low, out.value);
  return out;
}

/** Eigenvalues in descending order. */
LANES_INLINE void spectrum_values(const SpectrumApart *x, Lanes value[3])
{
  const SpectrumParts parts = spectrum_parts(x);
  for (int k = 0; k < 3; ++k) value[k] = parts.value[k];
}

/** The tensor with other eigenvalues, which must not differ by more than a constant times what the tensor's own do: where those are alike their directions
 *  are nothing but roundings. */
LANES_INLINE void spectral_tensor_of_parts(const SpectrumParts *s, const Lanes value[3], Lanes tensor[6])
{
  const Lanes half = lanes_set(0.5), high = lanes_choose(s->least, value[0], value[1]),
              low = lanes_choose(s->least, value[1], value[2]), alone = lanes_choose(s->least, value[2], value[0]),
              mean = (high + low) * half, more = alone - mean;
  const LaneMask wide = s->radius > lanes_set(0);
  const Lanes turn = (high - low) * half / lanes_choose(wide, s->radius, lanes_set(1));
  for (int k = 0; k < 6; ++k) {
    tensor[k] = lanes_product(more, s->alone[k]) + turn * s->pair[k];
    if (k < 3) tensor[k] += mean;
  }
}

/** Eigenvalues and orthonormal eigenvectors, as well: the vector that stands apart is the longest column of the adjugate, which is well conditioned, and the
 *  others follow from one rotation in the plane across it (after Eberly, A robust eigensolver for 3x3 symmetric matrices, 2014). */
LANES_INLINE Spectrum spectrum_with_vectors(const SpectrumApart *x)
{
  const Lanes zero = lanes_set(0), one = lanes_set(1), half = lanes_set(0.5), *b = x->b, *column = x->adjugate;
  const LaneMask first = (column[XX] >= column[YY]) & (column[XX] >= column[ZZ]), second = column[YY] >= column[ZZ];
  Lanes v[3] = {lanes_choose(first, column[XX], lanes_choose(second, column[XY], column[ZX])),
                lanes_choose(first, column[XY], lanes_choose(second, column[YY], column[YZ])),
                lanes_choose(first, column[ZX], lanes_choose(second, column[YZ], column[ZZ]))};
  const Lanes shorten = one / lanes_root(lanes_square(v[0], v[1], v[2]));
  for (int k = 0; k < 3; ++k) v[k] *= shorten;
  /* Two directions across it, and b in their plane. */
  const LaneMask steep = lanes_absolute(v[0]) > lanes_absolute(v[1]);
  const Lanes lead = lanes_choose(steep, v[0], v[1]), flat = one / lanes_root(lanes_square(lead, v[2], zero));
  const Lanes u[3] = {lanes_where(steep, -v[2] * flat), lanes_where(~steep, v[2] * flat),
                      lanes_choose(steep, v[0], -v[1]) * flat};
  const Lanes w[3] = {lanes_cross(v[1], u[2], v[2], u[1]), lanes_cross(v[2], u[0], v[0], u[2]),
                      lanes_cross(v[0], u[1], v[1], u[0])};
  const Lanes bu[3] = {lanes_dot(b[XX], u[0], b[XY], u[1], b[ZX], u[2]),
                       lanes_dot(b[XY], u[0], b[YY], u[1], b[YZ], u[2]),
                       lanes_dot(b[ZX], u[0], b[YZ], u[1], b[ZZ], u[2])};
  const Lanes bw[3] = {lanes_dot(b[XX], w[0], b[XY], w[1], b[ZX], w[2]),
                       lanes_dot(b[XY], w[0], b[YY], w[1], b[YZ], w[2]),
                       lanes_dot(b[ZX], w[0], b[YZ], w[1], b[ZZ], w[2])};
  const Lanes uu = lanes_dot(u[0], bu[0], u[1], bu[1], u[2], bu[2]),
              uw = lanes_dot(u[0], bw[0], u[1], bw[1], u[2], bw[2]),
              ww = lanes_dot(w[0], bw[0], w[1], bw[1], w[2], bw[2]);
  const Lanes middle = lanes_product(uu + ww, half), lean = lanes_product(uu - ww, half),
              both = lanes_square(lean, uw, zero);
  const LaneMask turns = both > lanes_set(1e-290);
  const Lanes radius = lanes_root(lanes_where(turns, both)), share = half / lanes_choose(turns, radius, half);
  /* Cosine and sine of the smaller turn: half the angle of (lean, uw). */
  const Lanes c = lanes_root(half + lanes_choose(turns, lanes_absolute(lean) * share, half)), s = uw * share / c;
  const LaneMask along = lean >= zero;
  const Lanes cosine = lanes_choose(along, c, s), sine = lanes_choose(along, s, c);
  Spectrum out;
  const Lanes high = middle + radius, low = middle - radius;
  spectrum_sort(x, high, low, out.value);
  for (int k = 0; k < 3; ++k) {
    const Lanes to = lanes_product(cosine, u[k]) + sine * w[k], across = lanes_cross(cosine, w[k], sine, u[k]);
    out.vector[0][k] = lanes_choose(x->least, to, v[k]);
    out.vector[1][k] = lanes_choose(x->least, across, to);
    out.vector[2][k] = lanes_choose(x->least, v[k], across);
  }
  return out;
}

/** Tangent of an isotropic tensor function: principal stresses, and their derivatives to principal strains [3][3], on the spectrum of
 *  the strain (de Souza Neto, Peric and Owen 2008, box A.6). */
LANES_INLINE void spectral_tangent(const Spectrum *strain, const Lanes stress[3], const Lanes slopes[9],
                                   Lanes tangent[36])
{
  const Lanes widest =
      lanes_set(1e-9) * lanes_greatest(lanes_absolute(strain->value[0]), lanes_absolute(strain->value[2]));
  Lanes basis[6][6], weighted[6][6]; /* of the pairs aa, bb, cc, ab, bc, ca; what stands beside them in the tangent */
  for (int n = 0; n < 6; ++n) {
    const Lanes *p = strain->vector[symmetric_row[n]], *q = strain->vector[symmetric_column[n]];
    for (int k = 0; k < 6; ++k) {
      const int r = symmetric_row[k], c = symmetric_column[k];
      basis[n][k] = (lanes_product(p[r], q[c]) + q[r] * p[c]) * lanes_set(0.5);
    }
  }
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < 6; ++k)
      weighted[a][k] =
          lanes_dot(slopes[3 * a], basis[0][k], slopes[3 * a + 1], basis[1][k], slopes[3 * a + 2], basis[2][k]);
  for (int n = 3; n < 6; ++n) {
    const int a = symmetric_row[n], b = symmetric_column[n];
    const Lanes apart = strain->value[a] - strain->value[b];
    const LaneMask wide = lanes_absolute(apart) > widest;
    const Lanes chord = lanes_set(2) * (stress[a] - stress[b]) / lanes_choose(wide, apart, lanes_set(1)),
                alike = slopes[4 * a] - slopes[3 * a + b] + slopes[4 * b] - slopes[3 * b + a];
    const Lanes turn = lanes_choose(wide, chord, alike);
    for (int k = 0; k < 6; ++k) weighted[n][k] = turn * basis[n][k];
  }
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      tangent[6 * i + k] = lanes_set(0);
      for (int n = 0; n < 6; ++n) tangent[6 * i + k] += basis[n][i] * weighted[n][k];
    }
}

#endif

/* Stress of a particle from the force state of its own family,
 *   sum t y (x) y / |y| V.
 * In a uniform strain this sum is the stress of the law if S = sum w |xi|^2 n n n n / m is isotropic. Incomplete
 * families keep some anisotropy (ordinary_families.c): at a flat face in uniform tension the sum is up to 1.16 of the
 * stress of the law, and 0.91 in the layers below. With the scalar force state a |xi| + b (e - s) the stress is
 * therefore
 *   Q (A M + b T),  Q = S_iso S^-1,  T = sum w |xi| (e - s) n (x) n,  M = sum w |xi|^2 n (x) n.
 * S is that of the family as it began, S_iso the isotropic one, and A is a with the dilatation of Q T instead of that
 * of T. In complete families of a lattice Q is 1. Broken bonds are left out of T and M but not of Q, so that the stress
 * decreases as bonds break. */
#include "formulation/ordinary.h"

#include "base/linear.h"
#include "base/tensor.h"
#include "formulation/shape_tensor.h"

#include <math.h>

enum { MOST_COMPONENTS = 6 };

/** Smallest Cholesky pivot of S, whose trace is 1, with which a family counts as resisting every strain. Isotropic
 *  families have pivots of at least 2/15. */
static const double least_pivot = 0.01;

/** Sums over the intact bonds of a family. */
typedef struct StressSums {
  double force[6];              /* sum t y (x) y / |y| V [stress] */
  double elastic[6], second[6]; /* T and M, in the reference configuration */
} StressSums;

/** Components of a symmetric tensor in a plane or in space: their number and their indices of 0 to 5. */
typedef struct StressComponents {
  int count, at[MOST_COMPONENTS];
} StressComponents;

static StressComponents stress_components(int dimensions)
{
  return dimensions == 2 ? (StressComponents){3, {XX, YY, XY}} : (StressComponents){6, {XX, YY, ZZ, XY, YZ, ZX}};
}

/** Returns the factor of a component in Mandel's notation, in which tensors have the products of vectors. */
static double stress_scale(int component)
{
  return component < 3 ? 1 : sqrt(2);
}

/** Tension that a place gives a bond, and stiffness of the bond over that of a bond inside the material of the place.
 *  Near interfaces both are half of those of both ends, which pieces in series have in common. */
typedef struct StressBond {
  double tension, stiffness;
} StressBond;

static StressBond stress_bond(const Ordinary *o, int64_t place, int64_t at, const Bond *bond, const OrdinaryStretch *s)
{
  const double own = ordinary_end(o, place, at, bond, s).tension, other = ordinary_factor(o, place, at, ORDINARY_OTHER),
               spring = ordinary_factor(o, place, at, ORDINARY_SPRING), shear = o->shear[bond->neighbour];
  if (other == 1 && spring == 1) return (StressBond){own, 1};
  const double base = other * o->base[bond->neighbour] + (other - spring) * shear * ordinary_free(o, bond->neighbour);
  return (StressBond){(own + base * bond->length + spring * shear * s->elongation) / 2,
                      spring * (o->shear[place] + shear) / (2 * o->shear[place])};
}

/** Computes the sums over the intact bonds of a family. */
static StressSums stress_sums(const Ordinary *o, int64_t place)
{
  const Family *f = o->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  const double freely = ordinary_free(o, place);
  StressSums sums = {.force = {0}};
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = ordinary_bond(o, slice, slot, lane);
    const OrdinaryStretch s = ordinary_stretch(o->particles->displacement.row, place, &bond);
    const StressBond of = stress_bond(o, place, slot * SLICE + lane, &bond, &s);
    const double shift = o->flow ? o->flow->shift[1][slot * SLICE + lane] : 0,
                 elastic = (s.elongation - freely * bond.length - shift) / bond.length;
    for (int k = 0; k < 6; ++k) {
      const int r = symmetric_row[k], c = symmetric_column[k];
      sums.force[k] += bond.weight * of.tension / s.length * s.y[r] * s.y[c];
      sums.elastic[k] += bond.weight * of.stiffness * elastic * bond.xi[r] * bond.xi[c];
      sums.second[k] += bond.weight * bond.xi[r] * bond.xi[c];
    }
  }
  return sums;
}

/** Factors S of an incomplete family, in Mandel's notation.
 *  @param[out] matrix  [count][count] factor of S, count that of stress_components
 *  @param[out] begin   rows of the factor (base/linear.h)
 *  @return false if the family does not resist every strain */
static bool stress_factor(const Ordinary *o, int64_t place, double *matrix, int begin[MOST_COMPONENTS])
{
  const int d = o->dimensions;
  const StressComponents on = stress_components(d);
  const float *fourth = o->fourth + (int64_t)ordinary_fourth_count(d) * o->incomplete[place];
  for (int i = 0; i < on.count; ++i)
    for (int j = 0; j < on.count; ++j) {
      int power[3] = {0};
      ++power[symmetric_row[on.at[i]]], ++power[symmetric_column[on.at[i]]];
      ++power[symmetric_row[on.at[j]]], ++power[symmetric_column[on.at[j]]];
      matrix[i * on.count + j] =
          stress_scale(on.at[i]) * stress_scale(on.at[j]) * (double)fourth[ordinary_fourth_index(d, power)];
    }
  if (!linear_factor(on.count, matrix, begin)) return false;
  for (int i = 0; i < on.count; ++i)
    if (matrix[i * on.count + i] * matrix[i * on.count + i] < least_pivot) return false;
  return true;
}

/** Multiplies a symmetric tensor by Q.
 *  @param[in] d              dimensions
 *  @param[in] matrix, begin  factor of S (stress_factor)
 *  @param[out] to            product; may be `from` */
static void stress_make_isotropic(int d, const double *matrix, const int *begin, const double from[6], double to[6])
{
  const StressComponents on = stress_components(d);
  double x[MOST_COMPONENTS], trace = 0;
  for (int i = 0; i < on.count; ++i) x[i] = stress_scale(on.at[i]) * from[on.at[i]];
  linear_factor_solve(on.count, matrix, begin, x);
  for (int i = 0; i < d; ++i) trace += x[i];
  for (int k = 0; k < 6; ++k) to[k] = from[k];
  for (int i = 0; i < on.count; ++i)
    to[on.at[i]] = (2 * x[i] / stress_scale(on.at[i]) + (on.at[i] < 3 ? trace : 0)) / (d * (d + 2));
}

/** Adds the correction for the anisotropy of an incomplete family to the stress of its force state; adds nothing in
 *  complete families and in those that do not resist every strain.
 *  @return dilatation of Q T less that of T [-] */
static double stress_correct(const Ordinary *o, int64_t place, const StressSums *sums, double stress[6])
{
  const int d = o->dimensions;
  double matrix[MOST_COMPONENTS * MOST_COMPONENTS], straight[6], own[6], wanted[6], f[9], change = 0;
  int begin[MOST_COMPONENTS];
  if (!o->incomplete || o->incomplete[place] < 0 || !stress_factor(o, place, matrix, begin)) return 0;
  stress_make_isotropic(d, matrix, begin, sums->elastic, straight);
  for (int k = 0; k < d; ++k) change += o->inverse[place] * (straight[k] - sums->elastic[k]);
  const double base = o->base[place] + o->shear[place] * ordinary_free(o, place), more = o->volumetric[place] * change;
  for (int k = 0; k < 6; ++k) {
    own[k] = base * sums->second[k] + o->shear[place] * sums->elastic[k];
    wanted[k] = own[k] + more * sums->second[k];
  }
  stress_make_isotropic(d, matrix, begin, wanted, wanted);
  const ShapeTensor shape = shape_tensor(o->family, (int32_t)place, d, 0);
  shape_gradient(o->family, o->particles->displacement.row, (int32_t)place, shape.inverse, f);
  for (int k = 0; k < 6; ++k)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        const int at = symmetric_place[3 * r + c];
        stress[k] += f[3 * symmetric_row[k] + r] * (wanted[at] - own[at]) * f[3 * symmetric_column[k] + c];
      }
  return change;
}

/** Computes the stress of a particle. In plane strain the stress across the plane is lambda theta + 2 G p. */
void ordinary_stress(const void *formulation, int64_t place, double stress[6])
{
  const Ordinary *o = formulation;
  const StressSums sums = stress_sums(o, place);
  for (int k = 0; k < 6; ++k) stress[k] = sums.force[k];
  const double change = stress_correct(o, place, &sums, stress);
  const Material *m = ordinary_material(o, place);
  if (o->space != SPACE_PLANE_STRAIN) return;
  const double inelastic = o->flow ? o->flow->across[1][place] : 0, freely = ordinary_free(o, place);
  stress[ZZ] = o->share[place] * ((m->bulk - 2 * m->shear / 3) * (ordinary_elastic_dilatation(o, place) + change) +
                                  2 * m->shear * inelastic - 2 * m->shear * freely);
}

/* How the deviator of a family yields or relaxes in a step. In space a family has the stress of von Mises q^2 = 3 G b N^2, N^2 = sum w (e_d - s)^2. In the
 * plane e_d is the deviator of the plane, and the law flows across the plane too: as the flow keeps volume, -p is the inelastic strain across and p
 * the inelastic dilatation of the plane (docs/theory.md 3):
 *   plane strain  q^2 = 3 G b N^2 + 9 G^2 (p - theta / 3)^2: the deviator across is 2 G (p - theta / 3);
 *   plane stress  q^2 = 3 G b N^2 + K_d^2 (theta - p)^2: the strain across follows from the stress there, 0. */
#include "formulation/ordinary.h"

#include <math.h>

double ordinary_across(const Material *m)
{
  return -(3 * m->bulk - 2 * m->shear) / (3 * m->bulk + 4 * m->shear);
}

Across ordinary_coupling(Space space, const Material *m)
{
  if (space == SPACE_PLANE_STRAIN) return (Across){m->shear, 3 * m->shear};
  if (space == SPACE_3D) return (Across){0, 0};
  const double bulk = ordinary_bulk(space, m);
  return (Across){bulk, bulk};
}

/** Plane stress: strains flow by dl (sigma_m 1 + 3 s), sigma_m the mean stress in the plane and s its deviator (Simo and Taylor 1986), so that
 *  q^2 = f^2 T^2 + g^2 M^2 with f = 1 / (1 + 6 G dl), g = 1 / (1 + 2 K_d dl), the trial T^2 = 3 G b N^2 and M. 1/q is increasing and concave in dl: Newton's
 *  method comes from one side. */
static FlowReturn yield_plane_stress(const Material *m, double yield_stress, double dilatation, double across,
                                     double shear, double square)
{
  enum { MOST_ITERATIONS = 50 };
  const double bulk = ordinary_bulk(SPACE_PLANE_STRESS, m), mean = bulk * (dilatation - across);
  const double trial = 3 * m->shear * shear * square;
  double l = 0, f = 1, g = 1, slope = 0; /* minus half the derivative of q^2 */
  for (int n = 0; n < MOST_ITERATIONS; ++n) {
    f = 1 / (1 + 6 * m->shear * l);
    g = 1 / (1 + 2 * bulk * l);
    const double q = sqrt(f * f * trial + g * g * mean * mean);
    slope = 6 * m->shear * f * f * f * trial + 2 * bulk * g * g * g * mean * mean;
    const double step = q * q * (q / yield_stress - 1) / slope;
    if (!(step > 1e-15 * l)) break;
    l += step;
  }
  const double by_dilatation =
      g * g * mean * bulk / slope; /* of dl; and of its growth with the amount of x = f times the trial */
  const double by_amount = 3 * m->shear * shear * f / slope;
  return (FlowReturn){
      .factor = f,
      .across = dilatation - g * mean / bulk,
      .factor_by = {-6 * m->shear * f * by_dilatation, -6 * m->shear * f * by_amount},
      .across_by = {1 - g + 2 * g * g * mean * by_dilatation, 2 * g * g * mean * by_amount},
  };
}

FlowReturn ordinary_yield(Space space, const Material *m, double yield_stress, double dilatation, double across,
                          double shear, double square)
{
  const double lag = space == SPACE_PLANE_STRAIN ? across - dilatation / 3 : 0, /* elastic deviatoric strain across */
      mean = space == SPACE_PLANE_STRESS ? ordinary_bulk(space, m) * (dilatation - across) : 0;
  const double mises = sqrt(3 * m->shear * shear * square + 9 * m->shear * m->shear * lag * lag + mean * mean);
  if (!(mises > yield_stress)) return (FlowReturn){.factor = 1, .across = across};
  if (space == SPACE_PLANE_STRESS) return yield_plane_stress(m, yield_stress, dilatation, across, shear, square);
  /* All of the deviator is scaled by f = Y / q. */
  const double f = yield_stress / mises, by_dilatation = 3 * m->shear * m->shear * lag / (mises * mises),
               by_amount = -3 * m->shear * shear / (f * mises * mises);
  FlowReturn r = {.factor = f, .across = across, .factor_by = {by_dilatation, by_amount}};
  if (space != SPACE_PLANE_STRAIN) return r;
  r.across = dilatation / 3 + f * lag;
  r.across_by[0] = (1 - f) / 3 + f * lag * by_dilatation;
  r.across_by[1] = f * lag * by_amount;
  return r;
}

Relaxed ordinary_relaxed(double times)
{
  const double gone = -expm1(-times);
  return (Relaxed){gone, times > 0 ? 1 - gone / times : 0};
}

/** p is the share of what the deviatoric strain across, less its sign, has been: theta / 3 in plane strain; (theta - 2 e) / 3 in plane stress, where the strain
 *  across e = c (theta - p) - p depends on p. */
FlowReturn ordinary_relax(Space space, const Material *m, double share, double times, double dilatation, double across,
                          double last, double *now)
{
  const Relaxed relaxed = ordinary_relaxed(times);
  FlowReturn r = {.factor = 1 - share * relaxed.late};
  double by_dilatation = 1.0 / 3, by_across = 0;
  *now = 0;
  if (space == SPACE_3D) return r;
  if (space == SPACE_PLANE_STRESS) {
    const double c = ordinary_across(m);
    by_dilatation = (1 - 2 * c) / 3;
    by_across = (2 + 2 * c) / 3;
  }
  const double held = share * last * (relaxed.gone - relaxed.late) + across * (1 - relaxed.gone),
               grown = share * relaxed.late, whole = 1 - grown * by_across;
  r.across = (held + grown * by_dilatation * dilatation) / whole;
  r.across_by[0] = grown * by_dilatation / whole;
  *now = by_dilatation * dilatation + by_across * r.across;
  return r;
}

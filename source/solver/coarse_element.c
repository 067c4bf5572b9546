#include "solver/coarse_element.h"

#include <math.h>

/** Gradients of the shares of an element's corners, at one of the 2^axes integration points. */
static void find_gradients(int axes, const double size[3], int point, double gradient[8][3])
{
  const double half = 0.5 / sqrt(3);
  for (int c = 0; c < 1 << axes; ++c)
    for (int k = 0; k < axes; ++k) {
      gradient[c][k] = (c >> k & 1 ? 1 : -1) / size[k];
      for (int j = 0; j < axes; ++j) {
        const double at = 0.5 + (point >> j & 1 ? half : -half);
        if (j != k) gradient[c][k] *= c >> j & 1 ? at : 1 - at;
      }
    }
}

void element_stiffness(int axes, const double size[3], ElementStiffness *s)
{
  *s = (ElementStiffness){0};
  double volume = 1, g[8][3];
  for (int k = 0; k < axes; ++k) volume *= size[k] / 2;
  for (int point = 0; point < 1 << axes; ++point) {
    find_gradients(axes, size, point, g);
    for (int a = 0; a < axes << axes; ++a)
      for (int b = 0; b < axes << axes; ++b) {
        const int r = a % axes, t = b % axes;
        const double *ga = g[a / axes], *gb = g[b / axes];
        double product = 0;
        for (int k = 0; k < axes; ++k) product += ga[k] * gb[k];
        s->lame[a][b] += volume * ga[r] * gb[t];
        s->shear[a][b] += volume * ((r == t ? product : 0) + ga[t] * gb[r]);
      }
  }
}

/** Of the tangent of a point, if it is not that of an elastic law: means over the axes. */
static void find_tangent(const Region *region, int axes, int32_t place, ElementModuli *m)
{
  double d[36], normal = 0, beside = 0, shear = 0;
  if (!points_on_particles(&region->points) || region->is_linear || !region->points.tangent) return;
  points_tangent(&region->points, place, d);
  for (int r = 0; r < axes; ++r)
    for (int k = 0; k < axes; ++k) *(r == k ? &normal : &beside) += d[6 * r + k];
  normal /= axes;
  if (axes > 1) beside /= axes * (axes - 1);
  shear = axes == 3 ? (d[21] + d[28] + d[35]) / 3 : axes == 2 ? d[21] : normal / 2;
  /* Normal stiffness is lame + 2 shear; the two ways to the shear modulus are alike in isotropic tangents. */
  shear = (shear + (normal - beside) / 2) / 2;
  m->shear = shear;
  m->lame = axes > 1 ? normal - 2 * shear : 0;
}

ElementModuli element_moduli(const Domain *d, int32_t place, bool linearised)
{
  const Material *m = &d->materials[d->material[place / SLICE]];
  const Region *region = domain_region(d, place);
  const int axes = d->body.dimensions;
  const double lame = m->bulk - 2 * m->shear / 3;
  const double least = 1e-3; /* of the undamaged stiffness: what has softened still has a place in the grid */
  ElementModuli whole = {lame, m->shear}, now;
  if (axes == 2 && region->points.plane_stress) whole.lame = 2 * m->shear * lame / (lame + 2 * m->shear);
  if (axes == 1) whole = (ElementModuli){0, material_young(m) / 2};
  now = whole;
  if (linearised) find_tangent(region, axes, place, &now);
  const double left = fmax(least, 1 - domain_damage(d, place));
  now.shear = fmax(now.shear, least * whole.shear);
  now.lame = axes > 1 ? fmax(now.lame, -1.9 / axes * now.shear) : 0; /* it resists any change of volume */
  return (ElementModuli){left * now.lame, left * now.shear};
}

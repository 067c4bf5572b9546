/* Links one by one, as corotational beams (docs/theory.md 6.4). Of a link along m = y / |y| with ends whose sections, along n at first, point along
 * a_i = R_i n, the end rotations are those that turn m into a_i: angles t_i about u_i = m x a_i / |m x a_i|. Its energy is
 *   W = c L s^2 / 2 + 2 (d / L) (t_i . t_i + t_i . t_j + t_j . t_j) + (twist / L) psi^2 / 2,
 * psi being the twist 2 m . r_v of the quaternion r = q_j q_i^*. Forces and moments are its derivatives by displacements and spins:
 *   delta t = u (u . (delta w - m x delta m)) + (t / sin t) (1 - u u) (delta m x a + m x (delta w x a)).
 * With b = m x a, f = t / sin t and k = (1 - t cot t) / sin^2 t, which have no singularity at t = 0, a derivative M by the rotation of an end is
 *   k b (b . M) + f cos t M - f m (a . M) by its spin, and f a x M - k (b . M) a by the chord, but for what is along the chord. */
#include "formulation/micropolar.h"

#include <math.h>
#include <string.h>

/** Unit quaternion of a place. */
static void quaternion_of(const Micropolar *m, double *const *u, int64_t place, double q[4])
{
  const Particles *p = m->particles;
  if (p->space.rows == 6) {
    particles_orientation(p, u, place, q);
    return;
  }
  const double half = u[micropolar_rotation(m)][place] / 2;
  memcpy(q, (double[]){cos(half), 0, 0, sin(half)}, 4 * sizeof *q);
}

/** R n. */
static void turn(const double q[4], const double n[3], double a[3])
{
  double once[3], twice[3];
  vector_cross(q + 1, n, once);
  vector_cross(q + 1, once, twice);
  for (int k = 0; k < 3; ++k) a[k] = n[k] + 2 * (q[0] * once[k] + twice[k]);
}

LinkEnd micropolar_end(const Micropolar *m, double *const *u, int64_t place, const double n[3], const double chord[3])
{
  LinkEnd e = {.factor = 1};
  quaternion_of(m, u, place, e.q);
  turn(e.q, n, e.a);
  vector_cross(chord, e.a, e.b);
  e.cosine = vector_dot(chord, e.a);
  const double x = vector_dot(e.b, e.b), sine = sqrt(x);
  if (sine > 0) e.factor = atan2(sine, e.cosine) / sine;
  /* (1 - t cot t) / sin^2 t, by its series where digits would be lost */
  e.bend = x < 1e-3 && e.cosine > 0 ? 1.0 / 3 + x * (2.0 / 15 + x * (8.0 / 105 + x * 16 / 315))
                                    : (1 - e.factor * e.cosine) / x;
  for (int k = 0; k < 3; ++k) e.rotation[k] = e.factor * e.b[k];
  return e;
}

/** Adds the derivatives of the energy whose derivative by the rotation of an end is `by_rotation`; what they have along the chord by the chord counts
 *  for nothing. */
static void add_end(const LinkEnd *e, const double chord[3], const double by_rotation[3], double by_chord[3],
                    double by_spin[3])
{
  const double along = e->bend * vector_dot(e->b, by_rotation), off = e->factor * vector_dot(e->a, by_rotation);
  double arm[3];
  vector_cross(e->a, by_rotation, arm);
  for (int k = 0; k < 3; ++k) {
    by_chord[k] += e->factor * arm[k] - along * e->a[k];
    by_spin[k] += along * e->b[k] + e->factor * e->cosine * by_rotation[k] - off * chord[k];
  }
}

void micropolar_twist(const LinkEnd ends[2], double r[4])
{
  const double *a = ends[0].q, *b = ends[1].q;
  vector_cross(a + 1, b + 1, r + 1); /* minus b x a */
  r[0] = a[0] * b[0] + vector_dot(a + 1, b + 1);
  for (int k = 0; k < 3; ++k) r[1 + k] += a[0] * b[1 + k] - b[0] * a[1 + k];
  for (int k = 0; k < 4 && r[0] < 0; ++k) /* the same rotation by the shorter way */
    if (k) r[k] = -r[k];
  r[0] = fabs(r[0]);
}

static void add_twist(const LinkEnd ends[2], const double chord[3], double twist, double *energy, double by_chord[3],
                      double by_spin[2][3])
{
  double r[4], across[3];
  micropolar_twist(ends, r);
  const double psi = 2 * vector_dot(chord, r + 1), torque = twist * psi;
  *energy += torque * psi / 2;
  vector_cross(r + 1, chord, across);
  for (int k = 0; k < 3; ++k) {
    by_chord[k] += 2 * torque * r[1 + k];
    by_spin[0][k] += torque * (across[k] - r[0] * chord[k]);
    by_spin[1][k] += torque * (across[k] + r[0] * chord[k]);
  }
}

/** Corotational. */
static void resist(const Micropolar *m, double *const *u, int64_t place, const double chord[3], Link *l)
{
  const double length = l->bond.length, bending = l->stiffness.bending / length;
  double n[3], by_chord[3] = {0}, by_spin[2][3] = {{0}};
  for (int k = 0; k < 3; ++k) n[k] = l->bond.xi[k] / length;
  l->energy = l->stiffness.axial * length * l->stretch * l->stretch / 2;
  if (l->stiffness.bending > 0) {
    const LinkEnd ends[2] = {micropolar_end(m, u, place, n, chord), micropolar_end(m, u, l->bond.neighbour, n, chord)};
    const double *a = ends[0].rotation, *b = ends[!l->alone].rotation;
    l->energy += 2 * bending * (vector_dot(a, a) + vector_dot(a, b) + vector_dot(b, b));
    for (int e = 0; e < (l->alone ? 1 : 2); ++e) {
      double by_rotation[3];
      for (int k = 0; k < 3; ++k)
        by_rotation[k] =
            l->alone ? bending * 12 * a[k] : bending * (4 * ends[e].rotation[k] + 2 * ends[1 - e].rotation[k]);
      add_end(&ends[e], chord, by_rotation, by_chord, by_spin[e]);
    }
    if (l->stiffness.twist > 0 && !l->alone)
      add_twist(ends, chord, l->stiffness.twist / length, &l->energy, by_chord, by_spin);
  }
  const double along = vector_dot(chord, by_chord);
  for (int k = 0; k < 3; ++k) {
    l->force[k] = l->stiffness.axial * l->stretch * chord[k] + (by_chord[k] - along * chord[k]) / l->length;
    for (int e = 0; e < 2; ++e) l->moment[e][k] = -by_spin[e][k];
  }
}

/** As in the thesis (Tuniki 2012, eq. 3.3): the stiffness of a frame along the present direction, of the present length, times displacements and
 *  rotations in all. It resists rigid rotation. */
void micropolar_resist_secant(const double angle[2], Link *l)
{
  double chord[2], eta[2];
  l->length = sqrt(vector_dot(l->y, l->y));
  const double length = l->length, grown = length / l->bond.length;
  const double axial = l->stiffness.axial / (grown * length), bending = l->stiffness.bending * grown;
  for (int k = 0; k < 2; ++k) {
    chord[k] = l->y[k] / length;
    eta[k] = l->y[k] - l->bond.xi[k];
  }
  const double turns = angle[0] + angle[1], along = chord[0] * eta[0] + chord[1] * eta[1],
               across = chord[0] * eta[1] - chord[1] * eta[0];
  const double normal = axial * along,
               shear = bending * (12 * across / length - 6 * turns) / (length * length); /* on this end, across */
  l->force[0] = normal * chord[0] - shear * chord[1];
  l->force[1] = normal * chord[1] + shear * chord[0];
  for (int e = 0; e < 2; ++e)
    l->moment[e][2] = bending / length * (6 * across / length - 4 * angle[e] - 2 * angle[1 - e]);
  l->energy = normal * along / 2 + shear * across / 2 - (l->moment[0][2] * angle[0] + l->moment[1][2] * angle[1]) / 2;
}

double micropolar_stretch(double *const *u, int64_t place, const Bond *bond, double y[3])
{
  double d = 0;
  for (int k = 0; k < 3; ++k) {
    const double eta = u[k][bond->neighbour] - u[k][place];
    y[k] = bond->xi[k] + eta;
    d += eta * (bond->xi[k] + y[k]);
  }
  d /= bond->length * bond->length;
  return d / (1 + sqrt(1 + d));
}

Link micropolar_link(const Micropolar *m, double *const *u, int64_t slice, int64_t slot, int lane)
{
  const int64_t place = slice * SLICE + lane;
  Link l = {.bond = family_bond(m->family, slice, slot, lane)};
  double chord[3];
  l.alone = is_foreign(m->foreign, l.bond.neighbour);
  l.stiffness = micropolar_stiffness(m, place, &l.bond);
  l.stretch = micropolar_stretch(u, place, &l.bond, l.y);
  l.length = l.bond.length * (1 + l.stretch);
  l.stretch -= particles_free_strain(m->particles, place, l.bond.neighbour);
  if (micropolar_is_weak(m, slice))
    micropolar_weaken(m, place, l.bond.neighbour, slot * SLICE + lane, l.stretch, &l.stiffness);
  for (int k = 0; k < 3; ++k) chord[k] = l.y[k] / l.length;
  if (m->secant)
    micropolar_resist_secant(
        (const double[]){u[micropolar_rotation(m)][place], u[micropolar_rotation(m)][l.bond.neighbour]}, &l);
  else
    resist(m, u, place, chord, &l);
  return l;
}

void micropolar_resist_one_by_one(const Micropolar *m, const Sweep *sweep, int64_t slice, bool only_foreign)
{
  const Particles *p = m->particles;
  const Family *f = m->family;
  for (int k = 0; k < p->space.rows && !only_foreign; ++k)
    memset(sweep->internal[k] + slice * SLICE, 0, SLICE * sizeof(double));
  for (int64_t slot = only_foreign ? f->stored[slice] : f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      if (only_foreign && !is_foreign(m->foreign, family_bond(f, slice, slot, lane).neighbour)) continue;
      const Link l = micropolar_link(m, sweep->displacement, slice, slot, lane);
      const int64_t place = slice * SLICE + lane;
      for (int k = 0; k < 3; ++k) sweep->internal[k][place] += l.bond.weight * l.force[k];
      for (int k = p->space.rotation; k < p->space.rows; ++k)
        sweep->internal[k][place] += l.bond.weight * l.moment[0][p->space.row[k].axis];
    }
}

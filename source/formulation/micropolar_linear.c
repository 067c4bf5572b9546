/* Linearised steps of links: derivatives of forces and moments (micropolar_link.c) along a motion of their ends, and so links as points. */
#include "formulation/micropolar.h"

#include <math.h>
#include <string.h>

/** Spin of a place with a change of its rotation vector: with the vector f held it is (1 + (1 - cos f) / f^2 f x + (f - sin f) / f^3 f x f x). */
static void find_spin(const Micropolar *m, double *const *at, int64_t place, const double change[3], double spin[3])
{
  double held[3], once[3], twice[3];
  for (int k = 0; k < 3; ++k) {
    held[k] = at[micropolar_rotation(m) + k][place];
    spin[k] = change[k];
  }
  const double square = vector_dot(held, held), angle = sqrt(square);
  vector_cross(held, spin, once);
  vector_cross(held, once, twice);
  const double a = angle > 1e-3 ? (1 - cos(angle)) / square : 0.5 - square / 24,
               b = angle > 1e-3 ? (angle - sin(angle)) / (square * angle) : 1.0 / 6 - square / 120;
  for (int k = 0; k < 3; ++k) spin[k] += a * once[k] + b * twice[k];
}

LinkMotion micropolar_motion(const Micropolar *m, double *const *v, double *const *at, int64_t place, int64_t other)
{
  LinkMotion motion = {.apart = {0}};
  for (int k = 0; k < 3; ++k) motion.apart[k] = v[k][other] - v[k][place];
  for (int end = 0; end < 2; ++end) {
    const int64_t i = end ? other : place;
    double *const *rotation = v + micropolar_rotation(m);
    if (m->particles->space.rows == 4)
      motion.spin[end][2] = rotation[0][i];
    else
      find_spin(m, at, i, (const double[]){rotation[0][i], rotation[1][i], rotation[2][i]}, motion.spin[end]);
  }
  return motion;
}

/** An end and its change. */
typedef struct EndChange {
  double a[3], b[3], cosine, rotation[3], factor, bend;
} EndChange;

static EndChange change_end(const LinkEnd *e, const double chord[3], const double chord_change[3], const double spin[3])
{
  EndChange c;
  double turned[3], carried[3];
  vector_cross(spin, e->a, c.a);
  vector_cross(chord_change, e->a, turned);
  vector_cross(chord, c.a, carried);
  const double x = vector_dot(e->b, e->b);
  c.cosine = vector_dot(chord_change, e->a) + vector_dot(chord, c.a);
  c.factor = -e->bend * c.cosine;
  c.bend = c.cosine * (x < 1e-3 && e->cosine > 0 ? -2 * e->cosine * (2.0 / 15 + x * (16.0 / 105 + x * 16 / 105))
                                                 : (3 * e->cosine * e->bend - e->factor) / x);
  for (int k = 0; k < 3; ++k) {
    c.b[k] = turned[k] + carried[k];
    c.rotation[k] = c.factor * e->b[k] + e->factor * c.b[k];
  }
  return c;
}

/** Adds derivatives of the energy by the chord and by the spin of an end, and their changes. */
static void add_end(const LinkEnd *e, const EndChange *c, const double chord[3], const double chord_change[3],
                    const double moment[3], const double moment_change[3], double by_chord[2][3], double by_spin[3])
{
  const double along = vector_dot(e->b, moment), off = vector_dot(e->a, moment),
               along_change = vector_dot(c->b, moment) + vector_dot(e->b, moment_change),
               off_change = vector_dot(c->a, moment) + vector_dot(e->a, moment_change);
  double arm[3], turned[3], carried[3];
  vector_cross(e->a, moment, arm);
  vector_cross(c->a, moment, turned);
  vector_cross(e->a, moment_change, carried);
  for (int k = 0; k < 3; ++k) {
    by_chord[0][k] += e->factor * arm[k] - e->bend * along * e->a[k];
    by_chord[1][k] += c->factor * arm[k] + e->factor * (turned[k] + carried[k]) -
                      (c->bend * along + e->bend * along_change) * e->a[k] - e->bend * along * c->a[k];
    by_spin[k] += (c->bend * along + e->bend * along_change) * e->b[k] + e->bend * along * c->b[k] +
                  (c->factor * e->cosine + e->factor * c->cosine) * moment[k] +
                  e->factor * e->cosine * moment_change[k] - (c->factor * off + e->factor * off_change) * chord[k] -
                  e->factor * off * chord_change[k];
  }
}

static void add_twist(const LinkEnd ends[2], const double chord[3], const double chord_change[3],
                      const LinkMotion *motion, double twist, double by_chord[2][3], double by_spin[2][3])
{
  double r[4], apart[3], sum[3], turned[3], change[4], across[3], first[3], second[3];
  micropolar_twist(ends, r);
  for (int k = 0; k < 3; ++k) {
    apart[k] = motion->spin[1][k] - motion->spin[0][k];
    sum[k] = motion->spin[1][k] + motion->spin[0][k];
  }
  vector_cross(sum, r + 1, turned);
  change[0] = -vector_dot(apart, r + 1) / 2;
  for (int k = 0; k < 3; ++k) change[1 + k] = (r[0] * apart[k] + turned[k]) / 2;
  const double torque = twist * 2 * vector_dot(chord, r + 1),
               torque_change = twist * 2 * (vector_dot(chord_change, r + 1) + vector_dot(chord, change + 1));
  vector_cross(r + 1, chord, across);
  vector_cross(change + 1, chord, first);
  vector_cross(r + 1, chord_change, second);
  for (int k = 0; k < 3; ++k) {
    const double along = r[0] * chord[k], along_change = change[0] * chord[k] + r[0] * chord_change[k];
    by_chord[0][k] += 2 * torque * r[1 + k];
    by_chord[1][k] += 2 * (torque_change * r[1 + k] + torque * change[1 + k]);
    by_spin[0][k] += torque_change * (across[k] - along) + torque * (first[k] + second[k] - along_change);
    by_spin[1][k] += torque_change * (across[k] + along) + torque * (first[k] + second[k] + along_change);
  }
}

/** Of links of the thesis, which are there to compare with: differences. */
static LinkChange difference(const Micropolar *m, const Link *l, double *const *at, int64_t place,
                             const LinkMotion *motion)
{
  const double size = sqrt(vector_dot(motion->apart, motion->apart)) / l->bond.length + fabs(motion->spin[0][2]) +
                      fabs(motion->spin[1][2]);
  LinkChange change = {.force = {0}};
  for (int side = -1; side <= 1 && size > 0; side += 2) {
    Link moved = *l;
    const double *rotation = at[micropolar_rotation(m)], share = side * 1e-6 / size,
                 angle[2] = {rotation[place] + share * motion->spin[0][2],
                             rotation[l->bond.neighbour] + share * motion->spin[1][2]};
    for (int k = 0; k < 3; ++k) moved.y[k] += share * motion->apart[k];
    micropolar_resist_secant(angle, &moved);
    for (int k = 0; k < 3; ++k) {
      change.force[k] += moved.force[k] / (2 * share);
      for (int e = 0; e < 2; ++e) change.moment[e][k] += moved.moment[e][k] / (2 * share);
    }
  }
  return change;
}

LinkChange micropolar_change(const Micropolar *m, double *const *at, int64_t place, const Link *l,
                             const LinkMotion *motion)
{
  if (m->secant) return difference(m, l, at, place, motion);
  const double length = l->bond.length, bending = l->stiffness.bending / length;
  double n[3], chord[3], chord_change[3], by_chord[2][3] = {{0}}, by_spin[2][3] = {{0}};
  for (int k = 0; k < 3; ++k) {
    n[k] = l->bond.xi[k] / length;
    chord[k] = l->y[k] / l->length;
  }
  const double grown = vector_dot(chord, motion->apart);
  for (int k = 0; k < 3; ++k) chord_change[k] = (motion->apart[k] - grown * chord[k]) / l->length;
  if (l->stiffness.bending > 0) {
    const LinkEnd ends[2] = {micropolar_end(m, at, place, n, chord),
                             micropolar_end(m, at, l->bond.neighbour, n, chord)};
    const EndChange changes[2] = {change_end(&ends[0], chord, chord_change, motion->spin[0]),
                                  change_end(&ends[1], chord, chord_change, motion->spin[1])};
    for (int e = 0; e < (l->alone ? 1 : 2); ++e) {
      const double own = l->alone ? 12 : 4, other = l->alone ? 0 : 2;
      double moment[3], moment_change[3];
      for (int k = 0; k < 3; ++k) {
        moment[k] = bending * (own * ends[e].rotation[k] + other * ends[1 - e].rotation[k]);
        moment_change[k] = bending * (own * changes[e].rotation[k] + other * changes[1 - e].rotation[k]);
      }
      add_end(&ends[e], &changes[e], chord, chord_change, moment, moment_change, by_chord, by_spin[e]);
    }
    if (l->stiffness.twist > 0 && !l->alone)
      add_twist(ends, chord, chord_change, motion, l->stiffness.twist / length, by_chord, by_spin);
  }
  const double along = vector_dot(chord, by_chord[0]),
               along_change = vector_dot(chord_change, by_chord[0]) + vector_dot(chord, by_chord[1]);
  LinkChange change;
  for (int k = 0; k < 3; ++k) {
    const double across = by_chord[0][k] - along * chord[k],
                 across_change = by_chord[1][k] - along * chord_change[k] - along_change * chord[k];
    change.force[k] = l->stiffness.axial * (grown / length * chord[k] + l->stretch * chord_change[k]) +
                      (across_change - across * grown / l->length) / l->length;
    for (int e = 0; e < 2; ++e) change.moment[e][k] = -by_spin[e][k];
  }
  return change;
}

void micropolar_resist_changes_one_by_one(const Micropolar *m, const Sweep *sweep, int64_t slice, bool only_foreign)
{
  double *const *at = sweep->linearised_at;
  const Particles *p = m->particles;
  const Family *f = m->family;
  for (int k = 0; k < p->space.rows && !only_foreign; ++k)
    memset(sweep->internal[k] + slice * SLICE, 0, SLICE * sizeof(double));
  for (int64_t slot = only_foreign ? f->stored[slice] : f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      if (only_foreign && !is_foreign(m->foreign, family_bond(f, slice, slot, lane).neighbour)) continue;
      const int64_t place = slice * SLICE + lane;
      const Link l = micropolar_link(m, at, slice, slot, lane);
      const LinkMotion motion = micropolar_motion(m, sweep->displacement, at, place, l.bond.neighbour);
      const LinkChange change = micropolar_change(m, at, place, &l, &motion);
      for (int k = 0; k < 3; ++k) sweep->internal[k][place] += l.bond.weight * change.force[k];
      for (int k = p->space.rotation; k < p->space.rows; ++k)
        sweep->internal[k][place] += l.bond.weight * change.moment[0][p->space.row[k].axis];
    }
}

/* ---- as points ---- */

int64_t micropolar_point_count(const void *formulation)
{
  const Micropolar *m = formulation;
  return m->family->slots * SLICE;
}

/** Row of motion of an end: force on it along an axis, or moment about one. */
static double row_of(const double force[3], const double moment[2][3], int end, const VectorRow *row)
{
  if (row->kind == ROW_ROTATION) return moment[end][row->axis];
  return end ? -force[row->axis] : force[row->axis];
}

/** Numbered by slot and lane; a link has one point, of its end with the lower place, or of its only end here. */
int micropolar_point(const void *formulation, double *const *u, int64_t number, Operator *point, Error *error)
{
  const Micropolar *m = formulation;
  const Particles *p = m->particles;
  const int64_t slot = number / SLICE, slice = family_slice(m->family, slot);
  const int lane = (int)(number % SLICE), motions = p->space.rows;
  const int64_t place = slice * SLICE + lane;
  operator_clear(point);
  if (!(m->family->intact[slot] >> lane & 1) || is_foreign(m->foreign, place)) return BRECCIA_OK;
  const Link l = micropolar_link(m, u, slice, slot, lane);
  const double weight = l.bond.weight * p->volume[place];
  if (l.bond.neighbour < place && !l.alone) return BRECCIA_OK;
  if (!operator_add(point, place, error) || !operator_add(point, l.bond.neighbour, error)) return BRECCIA_FAILURE;
  point->motions = motions;
  for (int row = 0; row < 2 * motions; ++row)
    point->force[row] = weight * row_of(l.force, l.moment, row / motions, &p->space.row[row % motions]);
  for (int column = 0; column < 2 * motions; ++column) {
    const int end = column / motions, k = column % motions;
    LinkMotion motion = {.apart = {0}};
    const VectorRow *of = &p->space.row[k];
    if (of->kind == ROW_DISPLACEMENT)
      motion.apart[of->axis] = end ? 1 : -1;
    else if (motions == 4)
      motion.spin[end][2] = 1;
    else
      find_spin(m, u, end ? l.bond.neighbour : place, (const double[]){of->axis == 0, of->axis == 1, of->axis == 2},
                motion.spin[end]);
    const LinkChange change = micropolar_change(m, u, place, &l, &motion);
    for (int row = 0; row < 2 * motions; ++row)
      point->stiffness[2 * motions * row + column] =
          weight * row_of(change.force, change.moment, row / motions, &p->space.row[row % motions]);
  }
  return BRECCIA_OK;
}

/* How forces of contact change with displacements, for solvers that iterate (docs/theory.md 2).
 *
 * Of the second derivative of a pair's energy k g^2 / 2 the part k dg dg is taken, which is symmetric and never negative; what it leaves out is smaller
 * by the gap over the spacing, so that each correction leaves about that share. dg = -n.dy - y.dn is linear in the displacements of both ends and of
 * their families, whose deformation gradients turn the normal n. Friction adds k ds ds for its slip ds = (I - n n) dy - (y.n) dn while it sticks.
 * Where it slides, it is the part across the way of sliding, times the share of the trial force that is left, and along it the coefficient times
 * k dg, which is not symmetric.
 * Pairs that touch count as if they pressed: blocks that stand on each other would fall apart in the first correction. */
#include "base/memory.h"
#include "contact/contact_parts.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double touching = 1e-9; /* of the rest: gaps no wider than this are closed */

/* ---- joints ---- */

static void find_friction(const Contact *c, const Grip *grip, ContactJoint *joint)
{
  const double size = sqrt(dot(grip->spring, grip->spring));
  joint->along = grip->left * joint->stiffness;
  if (grip->left < 1) joint->coupling = c->spec->friction * joint->stiffness;
  for (int k = 0; k < 3; ++k) joint->slide[k] = size > 0 ? grip->spring[k] / size : 0;
}

/** What a pair is, if it presses or touches. @return whether it does */
static bool find_joint(const Contact *c, const ContactRow *row, int32_t n, ContactJoint *joint)
{
  const ContactPair *pair = &row->pairs[n];
  const ContactRow *other = &c->rows[c->row_of[pair->neighbour]];
  Press m;
  if (!row->near || !other->near ||
      !contact_touch(c, c->body->particles.displacement.row, row, other, pair, touching, &m))
    return false;
  *joint = (ContactJoint){.low = row->place, .pair = n, .stiffness = m.stiffness, .across = m.across};
  memcpy(joint->normal, m.normal, sizeof joint->normal);
  if (m.central) return true;
  joint->size = sqrt(dot(m.long_normal, m.long_normal));
  memcpy(joint->side, m.way, sizeof joint->side);
  flatten(joint->normal, joint->side);
  if (row->grips) find_friction(c, &row->grips[2 * n + !c->committed], joint);
  return true;
}

static bool make_room(Contact *c)
{
  if (c->joint_count == c->joint_capacity) {
    const int64_t capacity = c->joint_capacity ? 2 * c->joint_capacity : 256;
    ContactJoint *grown = memory_grown(c->joints, (size_t)capacity, sizeof *grown);
    if (!grown) return false;
    c->joints = grown;
    c->joint_capacity = capacity;
  }
  return true;
}

static void mark_ends(Contact *c, const ContactJoint *joint)
{
  ContactRow *row = &c->rows[c->row_of[joint->low]];
  ContactRow *ends[] = {row, &c->rows[c->row_of[row->pairs[joint->pair].neighbour]]};
  for (int e = 0; e < 2; ++e) {
    ends[e]->joined = true;
    ends[e]->linear = ends[e]->frame;
  }
}

/** Joints in the order of places, whatever the one of rows: a restart makes the same sums. */
void contact_linearise(Contact *c)
{
  const int64_t before = c->joint_count;
  bool same = true;
  free(c->steps);
  c->steps = memory_zeroed((size_t)c->act_count + 1, sizeof *c->steps, "contact", NULL);
  c->joint_count = 0;
  if (!c->steps) c->failed = true;
  for (int32_t r = 0; r < c->row_count; ++r) c->rows[r].joined = false;
  for (int64_t place = 0; place < c->body->particles.places && !c->failed; ++place) {
    const ContactRow *row = c->row_of[place] < 0 ? NULL : &c->rows[c->row_of[place]];
    for (int32_t n = 0; row && n < row->count; ++n) {
      ContactJoint joint;
      if (!row->pairs[n].low || !find_joint(c, row, n, &joint)) continue;
      if (!make_room(c)) {
        c->failed = true;
        break;
      }
      const ContactJoint *then = &c->joints[c->joint_count];
      same &= c->joint_count < before && then->low == joint.low && then->pair == joint.pair;
      c->joints[c->joint_count++] = joint;
      mark_ends(c, &joint);
    }
  }
  if (!same || c->joint_count != before) ++c->pattern;
}

double contact_room(const Contact *c)
{
  return c->margin;
}

/* ---- changes ---- */

/** Change of the cofactor of the deformation gradient of a row. */
static void turn_frame(const Contact *c, ContactRow *row, double *const v[3])
{
  const Family *f = c->family;
  const Particles *p = f->particles;
  const int64_t slice = row->place / SLICE;
  const int lane = row->place % SLICE;
  const double *g = row->linear.gradient;
  double moment[9] = {0}, d[9] = {0};
  memset(row->cofactor_change, 0, sizeof row->cofactor_change);
  if (!row->linear.known || c->body->dimensions == 1) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, lane);
    for (int i = 0; i < 3; ++i) {
      const double eta = p->volume[bond.neighbour] * (v[i][bond.neighbour] - v[i][row->place]);
      for (int j = 0; j < 3; ++j) moment[3 * i + j] += eta * bond.xi[j];
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) d[3 * i + j] += moment[3 * i + k] * row->shape[3 * k + j];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int m = 3 * ((i + 1) % 3), n = 3 * ((i + 2) % 3), k = (j + 1) % 3, l = (j + 2) % 3;
      row->cofactor_change[3 * i + j] =
          d[m + k] * g[n + l] + g[m + k] * d[n + l] - d[m + l] * g[n + k] - g[m + l] * d[n + k];
    }
}

static const ContactRow *high_row(const Contact *c, const ContactJoint *joint)
{
  return &c->rows[c->row_of[c->rows[c->row_of[joint->low]].pairs[joint->pair].neighbour]];
}

/** What a joint does where displacements change. */
static void step_joint(const Contact *c, const ContactJoint *joint, double *const v[3])
{
  const ContactRow *low = &c->rows[c->row_of[joint->low]], *high = high_row(c, joint);
  const ContactPair *pair = &low->pairs[joint->pair];
  PairAct *step = &c->steps[pair->act];
  double moved[3], turned[3] = {0}, slip[3], along = 0;
  for (int k = 0; k < 3; ++k) {
    moved[k] = v[k][high->place] - v[k][low->place];
    if (joint->size > 0)
      turned[k] =
          (dot(low->cofactor_change + 3 * k, pair->normal[0]) + dot(high->cofactor_change + 3 * k, pair->normal[1])) /
          joint->size;
  }
  flatten(joint->normal, turned);
  const double closed = -dot(joint->normal, moved) - dot(joint->side, turned);
  memcpy(slip, moved, sizeof slip);
  flatten(joint->normal, slip);
  for (int k = 0; k < 3; ++k) slip[k] -= joint->across * turned[k];
  if (joint->coupling > 0) along = dot(joint->slide, slip);
  *step = (PairAct){.presses = true, .turns = joint->size > 0};
  for (int k = 0; k < 3; ++k) {
    const double pull = joint->along * (slip[k] - along * joint->slide[k]) + joint->coupling * closed * joint->slide[k];
    step->force[k] = pull - joint->stiffness * closed * joint->normal[k];
    if (step->turns)
      step->turning[k] = -(joint->stiffness * closed * joint->side[k] + joint->across * pull) / joint->size;
  }
}

void contact_change(Contact *c, double *const v[3], double *const change[3])
{
  if (!c->joint_count) return;
  TEAM_FOR (r, c->row_count)
    if (c->rows[r].joined) turn_frame(c, &c->rows[r], v);
  TEAM_FOR (n, c->joint_count) step_joint(c, &c->joints[n], v);
  contact_spread_change(c, change);
}

/* ---- points ---- */

const char *contact_unassembled(const Contact *c)
{
  return c->spec && c->spec->friction > 0 ? "friction of contact has no place in it" : NULL;
}

/** Adds what the normal, which turns with the family of an end, makes of the gap.
 *  @param[in] by  derivative of y.n by cof(F) N */
static int add_family(const Contact *c, const ContactRow *row, const double by[3], const double normal[3],
                      Operator *point, Error *error)
{
  const Family *f = c->family;
  const int64_t slice = row->place / SLICE;
  double a[9], pull[9], own[3] = {0};
  if (!row->linear.known || c->body->dimensions == 1) return BRECCIA_OK;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[3 * i + j] = by[i] * normal[j];
  contact_find_pull(row->linear.gradient, row->shape, a, pull);
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> (row->place % SLICE) & 1)) continue;
    const Bond bond = family_bond(f, slice, slot, row->place % SLICE);
    OperatorPlace *place = operator_add(point, bond.neighbour, error);
    if (!place) return BRECCIA_FAILURE;
    for (int i = 0; i < 3; ++i) {
      place->g[i] = f->particles->volume[bond.neighbour] * dot(pull + 3 * i, bond.xi);
      own[i] -= place->g[i];
    }
  }
  OperatorPlace *place = operator_add(point, row->place, error);
  if (place) memcpy(place->g, own, sizeof own);
  return place ? BRECCIA_OK : BRECCIA_FAILURE;
}

/** How far the ends are apart across the face as the strain, the stiffness as the tangent. */
int contact_point(const Contact *c, int64_t number, Operator *point, Error *error)
{
  const ContactJoint *joint = &c->joints[number];
  const ContactRow *ends[] = {&c->rows[c->row_of[joint->low]], high_row(c, joint)};
  const ContactPair *pair = &ends[0]->pairs[joint->pair];
  const Particles *p = &c->body->particles;
  operator_clear(point);
  point->components = 1;
  point->volume = 1;
  point->tangent[0] = joint->stiffness * p->volume[ends[0]->place] * p->volume[ends[1]->place];
  for (int e = 0; e < 2; ++e) {
    OperatorPlace *place = operator_add(point, ends[e]->place, error);
    if (!place) return BRECCIA_FAILURE;
    for (int k = 0; k < 3; ++k) place->g[k] = (e ? 1 : -1) * joint->normal[k];
  }
  double by[3];
  for (int k = 0; k < 3; ++k) by[k] = joint->size > 0 ? joint->side[k] / joint->size : 0;
  for (int e = 0; e < 2 && joint->size > 0; ++e)
    if (add_family(c, ends[e], by, pair->normal[e], point, error)) return BRECCIA_FAILURE;
  return BRECCIA_OK;
}

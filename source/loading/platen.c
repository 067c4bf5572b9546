#include "loading/platen.h"

#include "base/memory.h"
#include "body/body.h"
#include "loading/constraint.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double Triple[3];

static const double platen_flat = 1e-6; /* spacings by which particles that stand in line across the direction differ */

/** Subtracts the part of a vector along a unit vector. */
static void platen_project(Triple v, const double unit[3])
{
  const double along = v[0] * unit[0] + v[1] * unit[1] + v[2] * unit[2];
  for (int k = 0; k < 3; ++k) v[k] -= along * unit[k];
}

static double platen_length(const double v[3])
{
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/** Finds the centre of the volumes of a selection. */
static void platen_centre(const Selection *s, const Particles *p, Triple centre)
{
  double volume = 0;
  for (int k = 0; k < 3; ++k) centre[k] = 0;
  for (int64_t n = 0; n < s->count; ++n) {
    const int32_t i = s->places[n];
    volume += p->volume[i];
    for (int k = 0; k < 3; ++k) centre[k] += p->volume[i] * p->position[k][i];
  }
  for (int k = 0; k < 3; ++k) centre[k] /= volume;
}

/** Finds where the n-th particle stands from the centre, across the direction. */
static void platen_arm(const Selection *s, const Particles *p, const double centre[3], const double direction[3],
                       int64_t n, Triple arm)
{
  for (int k = 0; k < 3; ++k) arm[k] = p->position[k][s->places[n]] - centre[k];
  platen_project(arm, direction);
}

/** Finds the particle that stands farthest from the centre across the direction and, if given, across a second one; of
 * equal ones the first.
 *  @param[out] farthest  its arm  @return its index */
static int64_t platen_farthest(const Selection *s, const Particles *p, const double centre[3],
                               const double direction[3], const double *second, Triple farthest)
{
  const double nearly = 1 + 1e-9;
  double most = 0;
  int64_t found = 0;
  for (int k = 0; k < 3; ++k) farthest[k] = 0;
  for (int64_t n = 0; n < s->count; ++n) {
    Triple arm;
    platen_arm(s, p, centre, direction, n, arm);
    if (second) platen_project(arm, second);
    if (!(platen_length(arm) > nearly * most)) continue;
    most = platen_length(arm);
    found = n;
    for (int k = 0; k < 3; ++k) farthest[k] = arm[k];
  }
  return found;
}

double platen_width(const Constraint *c, const Body *body, int axis)
{
  const double along = 0.9;
  const Selection *s = &c->load->selection;
  const double *at = body->particles.position[axis], spacing = body->coarsest->plane[axis];
  double low = INFINITY, high = -INFINITY;
  if (axis >= body->dimensions || fabs(c->direction[axis]) > along) return 0;
  for (int64_t n = 0; n < s->count; ++n) {
    low = fmin(low, at[s->places[n]]);
    high = fmax(high, at[s->places[n]]);
  }
  return high - low > 0.1 * spacing ? high - low + spacing : 0;
}

bool platen_is_narrow(const Constraint *c, const Body *body)
{
  const double most = 0.9; /* of the body */
  for (int k = 0; k < body->dimensions; ++k) {
    const double width = platen_width(c, body, k);
    if (width > 0 && width < most * (body->high[k] - body->low[k] + body->coarsest->plane[k])) return true;
  }
  return false;
}

bool platen_can_turn(const Constraint *c, const Body *body)
{
  Triple centre, farthest;
  platen_centre(&c->load->selection, &body->particles, centre);
  platen_farthest(&c->load->selection, &body->particles, centre, c->direction, NULL, farthest);
  return platen_length(farthest) > platen_flat * body->coarsest->spacing;
}

/** Finds the shares of the n-th particle: its arm as a sum of those of the leaders, whose Gram matrix is inverted. */
static void platen_find_shares(Platen *q, const Selection *s, const Particles *p, const double centre[3],
                               const double direction[3])
{
  Triple lead[2] = {{0}};
  double gram[2][2] = {{0}};
  for (int m = 0; m < q->leaders; ++m) platen_arm(s, p, centre, direction, q->leader[m], lead[m]);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int k = 0; k < 3; ++k) gram[a][b] += lead[a][k] * lead[b][k];
  const double determinant = q->leaders > 1 ? gram[0][0] * gram[1][1] - gram[0][1] * gram[1][0] : gram[0][0];
  for (int64_t n = 0; n < s->count; ++n) {
    Triple arm;
    double along[2] = {0};
    platen_arm(s, p, centre, direction, n, arm);
    for (int m = 0; m < q->leaders; ++m)
      for (int k = 0; k < 3; ++k) along[m] += arm[k] * lead[m][k];
    if (q->leaders > 1) {
      q->share[0][n] = (gram[1][1] * along[0] - gram[0][1] * along[1]) / determinant;
      q->share[1][n] = (gram[0][0] * along[1] - gram[1][0] * along[0]) / determinant;
    } else
      q->share[0][n] = along[0] / determinant;
  }
}

/** Puts a platen between a constraint and its particles, if these stand apart across its direction. */
static int platen_create(Constraint *c, const Body *body, Error *error)
{
  const Particles *p = &body->particles;
  const Selection *s = &c->load->selection;
  Triple centre, first, second;
  platen_centre(s, p, centre);
  const int64_t leader = platen_farthest(s, p, centre, c->direction, NULL, first);
  const double length = platen_length(first);
  if (!platen_can_turn(c, body)) return BRECCIA_OK;
  Platen *q = c->platen = memory_zeroed(1, sizeof *q, "platens", error);
  if (!q) return BRECCIA_FAILURE;
  *q = (Platen){.leaders = 1, .leader = {leader, -1, -1}};
  for (int k = 0; k < 3; ++k) first[k] /= length;
  const int64_t other = platen_farthest(s, p, centre, c->direction, first, second);
  if (platen_length(second) > platen_flat * length) {
    q->leader[1] = other;
    q->leaders = 2;
  }
  for (int m = 0; m < q->leaders; ++m)
    if (!(q->share[m] = memory_zeroed((size_t)s->count, sizeof(double), "platens", error))) return BRECCIA_FAILURE;
  c->part = memory_zeroed((size_t)s->count, sizeof(double), "platens", error);
  c->moved = memory_zeroed((size_t)s->count, sizeof(double), "platens", error);
  if (!c->part || !c->moved) return BRECCIA_FAILURE;
  platen_find_shares(q, s, p, centre, c->direction);
  for (int64_t n = 0; n < s->count; ++n) {
    c->part[n] = 1;
    for (int m = 0; m < q->leaders; ++m) c->part[n] -= q->share[m][n];
    c->largest_part = fmax(c->largest_part, fabs(c->part[n]));
  }
  return BRECCIA_OK;
}

static int platen_compare(const void *a, const void *b)
{
  const double one = *(const double *)a, other = *(const double *)b;
  return (one > other) - (one < other);
}

/** Returns true if the particles stand side by side along an axis: a load of two jacks has a gap between them.
 *  @param[out] room  [particles of the load] */
static bool platen_is_one(const Constraint *c, const Body *body, int axis, double *room)
{
  const double gap = 1.6; /* spacings from one particle to the next */
  const Selection *s = &c->load->selection;
  bool one = true;
  for (int64_t n = 0; n < s->count; ++n) room[n] = body->particles.position[axis][s->places[n]];
  qsort(room, (size_t)s->count, sizeof *room, platen_compare);
  for (int64_t n = 1; n < s->count; ++n) one &= room[n] - room[n - 1] < gap * body->coarsest->spacing;
  return one;
}

/** Finds whether the particles are a single patch. @return BRECCIA_OK, or BRECCIA_FAILURE: no memory */
static int platen_find_patch(const Constraint *c, const Body *body, bool *patch, Error *error)
{
  double *room = memory_zeroed((size_t)c->load->selection.count, sizeof *room, "platens", error);
  if (!room) return BRECCIA_FAILURE;
  *patch = true;
  for (int k = 0; k < body->dimensions && *patch; ++k)
    if (platen_width(c, body, k) > 0) *patch = platen_is_one(c, body, k, room);
  free(room);
  return BRECCIA_OK;
}

/** Returns true if another motion is prescribed to one of the particles while this one is. */
static bool platen_is_held_across(const Loading *loading, const Constraint *c, const Particles *p)
{
  const Selection *a = &c->load->selection;
  for (int other = 0; other < loading->constraint_count; ++other) {
    const Constraint *held = &loading->constraints[other];
    const Selection *b = &held->load->selection;
    if (held == c || held->row || held->load->behind <= c->load->first || c->load->behind <= held->load->first)
      continue;
    for (int64_t n = 0, m = 0; n < a->count && m < b->count;) { /* numbers ascend in both */
      const int32_t one = p->number[a->places[n]], two = p->number[b->places[m]];
      if (one == two) return true;
      n += one < two;
      m += two < one;
    }
  }
  return false;
}

/** Returns true if one of the particles stands beside its mirror image at a face along the direction. */
static bool platen_is_mirrored(const Constraint *c, const Body *body)
{
  const double beside = 1.5; /* spacings from a particle of the outermost layer to its image */
  const Selection *s = &c->load->selection;
  const Particles *p = &body->particles;
  for (int64_t n = 0; body->margin_of && n < p->count; ++n) {
    if (!body_outside(body, n)) continue;
    const int32_t original = p->place_of[body->image_of[n]];
    const int axis = body->margins.items[body->margin_of[n]].axis;
    const double apart = fabs(p->position[axis][p->place_of[n]] - p->position[axis][original]);
    if (fabs(c->direction[axis]) > 0.5 || apart > beside * body->coarsest->plane[axis]) continue;
    for (int64_t m = 0; m < s->count; ++m)
      if (s->places[m] == original) return true;
  }
  return false;
}

/** Returns true if a platen is under a load of which the deck does not say so, if the load moves a single patch. */
static bool platen_is_usual(const Loading *loading, const Constraint *c, const Body *body)
{
  return c->load->spec->platen < 0 && c->value != 0 && platen_is_narrow(c, body) &&
         !platen_is_held_across(loading, c, &body->particles) && !platen_is_mirrored(c, body);
}

static int platen_choose(const LoadMaking *making, const Load *load)
{
  Loading *loading = making->loading;
  Constraint *found = NULL;
  int count = 0;
  for (int c = 0; c < loading->constraint_count; ++c) {
    if (loading->constraints[c].load != load) continue;
    found = &loading->constraints[c];
    ++count;
  }
  const bool wanted = load->spec->platen == PLATEN_TURNS;
  if (wanted && count != 1)
    return node_error(making->reader->document, section_node(load->spec, "platen"), making->reader->error,
                      "platen: one that turns has its motion prescribed in one direction, and here it is in %d; give "
                      "the others as 'free', or take 'platen: fixed'",
                      count);
  if (count != 1 || !(wanted || platen_is_usual(loading, found, making->body))) return BRECCIA_OK;
  bool patch = wanted;
  if (!wanted && platen_find_patch(found, making->body, &patch, making->reader->error)) return BRECCIA_FAILURE;
  if (!patch) return BRECCIA_OK;
  return platen_create(found, making->body, making->reader->error);
}

int platens_create(const LoadMaking *making)
{
  int status = BRECCIA_OK;
  for (int l = 0; l < making->loading->count && status != BRECCIA_FAILURE; ++l) {
    const Load *load = &making->loading->loads[l];
    const int bad = load->type && load->type->platen ? platen_choose(making, load) : BRECCIA_OK;
    if (bad) status = bad;
  }
  return status;
}

void platen_destroy(Platen *platen)
{
  if (!platen) return;
  for (int m = 0; m < 2; ++m) free(platen->share[m]);
  for (int m = 0; m < MAX_LEADERS; ++m) free(platen->loose[m]);
  free(platen);
}

/* ---- a centre that is free ---- */

int platen_loosen(const Constraint *c, Error *error)
{
  const double nearly = 1 + 1e-9;
  Platen *q = c->platen;
  const int last = q->leaders;
  const int64_t count = c->load->selection.count;
  double most = 0;
  for (int64_t n = 0; n < count; ++n) {
    if (!(fabs(c->part[n]) > nearly * most)) continue;
    most = fabs(c->part[n]);
    q->leader[last] = n;
  }
  for (int m = 0; m <= last; ++m)
    if (!(q->loose[m] = memory_zeroed((size_t)count, sizeof(double), "platens", error))) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < count; ++n) {
    const double ratio = c->part[n] / c->part[q->leader[last]];
    q->loose[last][n] = ratio;
    for (int m = 0; m < last; ++m) q->loose[m][n] = q->share[m][n] - ratio * q->share[m][q->leader[last]];
  }
  return BRECCIA_OK;
}

double platen_centre_rate(const Constraint *c, double *const *v)
{
  const Platen *q = c->platen;
  const int64_t n = q->leader[q->leaders];
  double moved = constraint_along(c, v, c->load->selection.places[n]);
  for (int m = 0; m < q->leaders; ++m) moved -= q->share[m][n] * constraint_along(c, v, constraint_leader(c, m));
  return moved / c->part[n];
}

double platen_centre_displacement(const Constraint *c, double *const *u)
{
  const int64_t n = c->platen->leader[c->platen->leaders];
  return platen_centre_rate(c, u) - (c->from ? c->from[n] / c->part[n] : 0);
}

double platen_centre_force(const Constraint *c, double *const *f)
{
  double sum = 0;
  for (int64_t n = 0; n < c->load->selection.count; ++n)
    sum += c->part[n] * constraint_along(c, f, c->load->selection.places[n]);
  return sum;
}

void platen_add_centre_force(const Constraint *c, double *const *f, double force)
{
  const Platen *q = c->platen;
  const int64_t n = q->leader[q->leaders];
  const double along = force / c->part[n];
  constraint_add(c, f, c->load->selection.places[n], along);
  for (int m = 0; m < q->leaders; ++m) constraint_add(c, f, constraint_leader(c, m), -q->share[m][n] * along);
}

/* ---- motion ---- */

/** Solves a symmetric positive definite system of equations by Gaussian elimination. */
static void platen_solve(int count, double matrix[MAX_LEADERS][MAX_LEADERS], double right[MAX_LEADERS])
{
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const double factor = matrix[b][a] / matrix[a][a];
      for (int k = a; k < count; ++k) matrix[b][k] -= factor * matrix[a][k];
      right[b] -= factor * right[a];
    }
  for (int a = count - 1; a >= 0; --a) {
    for (int k = a + 1; k < count; ++k) right[a] -= matrix[a][k] * right[k];
    right[a] /= matrix[a][a];
  }
}

/** Divides generalised forces or momenta of the leaders by the mass matrix of the plate, M_ab = sum_i m_i S_ia S_ib. */
static void platen_accelerate(const Constraint *c, const Particles *p, const double force[MAX_LEADERS],
                              double acceleration[MAX_LEADERS])
{
  const int leaders = constraint_leaders(c);
  const Selection *s = &c->load->selection;
  double mass[MAX_LEADERS][MAX_LEADERS] = {{0}};
  for (int64_t n = 0; n < s->count; ++n) {
    const double own = p->density[s->places[n]] * p->volume[s->places[n]];
    for (int a = 0; a < leaders; ++a)
      for (int b = 0; b < leaders; ++b) mass[a][b] += own * constraint_share(c, a, n) * constraint_share(c, b, n);
  }
  if (leaders == 1) {
    acceleration[0] = force[0] / mass[0][0];
    return;
  }
  if (leaders > 2) {
    for (int m = 0; m < leaders; ++m) acceleration[m] = force[m];
    platen_solve(leaders, mass, acceleration);
    return;
  }
  const double determinant = mass[0][0] * mass[1][1] - mass[0][1] * mass[1][0];
  acceleration[0] = (mass[1][1] * force[0] - mass[0][1] * force[1]) / determinant;
  acceleration[1] = (mass[0][0] * force[1] - mass[1][0] * force[0]) / determinant;
}

void platen_start(const Constraint *c, const Particles *p, double time, double step)
{
  const Selection *s = &c->load->selection;
  const double given = constraint_velocity(c, time, step);
  double momentum[MAX_LEADERS] = {0}, velocity[MAX_LEADERS];
  for (int64_t n = 0; n < s->count; ++n) {
    const int32_t i = s->places[n];
    const double along =
        p->density[i] * p->volume[i] * (constraint_along(c, p->velocity.row, i) - constraint_part(c, n) * given);
    for (int m = 0; m < constraint_leaders(c); ++m) momentum[m] += constraint_share(c, m, n) * along;
  }
  platen_accelerate(c, p, momentum, velocity);
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t i = constraint_leader(c, m);
    constraint_add(c, p->velocity.row, i, velocity[m] - constraint_along(c, p->velocity.row, i));
  }
}

/** Computes the accelerations of the leaders from the forces on all particles and the motion of the centre. */
static void platen_find_accelerations(const Constraint *c, const Particles *p, double acceleration[MAX_LEADERS])
{
  const Platen *q = c->platen;
  const Selection *s = &c->load->selection;
  double force[MAX_LEADERS] = {0};
  for (int64_t n = 0; n < s->count; ++n) {
    const int32_t i = s->places[n];
    const double along =
        p->volume[i] * (constraint_along(c, p->internal.row, i) + constraint_along(c, p->external.row, i) -
                        p->density[i] * constraint_part(c, n) * q->given);
    for (int m = 0; m < constraint_leaders(c); ++m) force[m] += constraint_share(c, m, n) * along;
  }
  platen_accelerate(c, p, force, acceleration);
}

/** Returns true if a platen with prescribed motion and these accelerations of its leaders pulls on its particles. */
static bool platen_pulls(const Constraint *c, const Particles *p, const double acceleration[MAX_LEADERS])
{
  const Platen *q = c->platen;
  const Selection *s = &c->load->selection;
  double sum = 0;
  for (int64_t n = 0; n < s->count; ++n) {
    const int32_t i = s->places[n];
    double moved = c->part[n] * q->given;
    for (int m = 0; m < q->leaders; ++m) moved += q->share[m][n] * acceleration[m];
    sum += c->part[n] * p->volume[i] *
           (p->density[i] * moved - constraint_along(c, p->internal.row, i) - constraint_along(c, p->external.row, i));
  }
  return c->one_sided->pushes * sum < 0;
}

void platen_push(const Constraint *c, Particles *p, double time)
{
  Platen *q = c->platen;
  const double step = 2 * c->load->motion.lag; /* 0 if forces are evaluated again for a restored state */
  if (step > 0) q->given = constraint_acceleration(c, time, step);
  double acceleration[MAX_LEADERS];
  platen_find_accelerations(c, p, acceleration);
  if (c->one_sided && !c->one_sided->open[0] && platen_pulls(c, p, acceleration)) {
    c->one_sided->open[0] = 1;
    q->opens = step > 0;
    platen_find_accelerations(c, p, acceleration);
  }
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t i = constraint_leader(c, m);
    constraint_add(c, p->external.row, i,
                   p->density[i] * acceleration[m] - constraint_along(c, p->internal.row, i) -
                       constraint_along(c, p->external.row, i));
  }
}

void platen_share_mass(const Constraint *c, const Particles *p, const Vector *acceleration)
{
  double force[MAX_LEADERS] = {0}, shared[MAX_LEADERS];
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t i = constraint_leader(c, m);
    force[m] = p->density[i] * p->volume[i] * constraint_along(c, acceleration->row, i);
  }
  platen_accelerate(c, p, force, shared);
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t i = constraint_leader(c, m);
    constraint_add(c, acceleration->row, i, shared[m] - constraint_along(c, acceleration->row, i));
  }
}

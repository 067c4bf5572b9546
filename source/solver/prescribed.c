/* Prescribed motions in explicit steps. In a prescribed direction loads, reaction and damping together do whatever work the change of
 * kinetic energy and the bonds ask for; that sum is booked as external. The sweeps over all particles have booked the free motion, which is
 * taken back here. Particles are shared out in parts whose sums are added in order; held faces are large enough for one thread
 * alone to hold up all others. */
#include "base/team.h"
#include "loading/constraint.h"
#include "loading/platen.h"
#include "solver/explicit.h"

#include <math.h>

enum { PART = 512 };

int64_t explicit_parts_of(const Constraint *constraint)
{
  return (constraint->load->selection.count + PART - 1) / PART;
}

/** A direction, and the axis that it lies along, or -1. Most do, and reading three components of seven arrays is what prescribing costs. */
typedef struct Direction {
  const double *of;
  int axis;
} Direction;

static int axis_of(const double direction[3])
{
  int axis = -1, others = 0;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) continue;
    ++others;
    axis = k;
  }
  return others == 1 ? axis : -1;
}

static inline __attribute__((always_inline)) double along(double *const vector[3], Direction d, int32_t i)
{
  if (d.axis >= 0) return vector[d.axis][i] * d.of[d.axis];
  return vector[0][i] * d.of[0] + vector[1][i] * d.of[1] + vector[2][i] * d.of[2];
}

static inline __attribute__((always_inline)) void add_along(double *const vector[3], Direction d, int32_t i,
                                                            double amount)
{
  if (d.axis >= 0) {
    vector[d.axis][i] += amount * d.of[d.axis];
    return;
  }
  for (int k = 0; k < 3; ++k) vector[k][i] += amount * d.of[k];
}

/** The rows of motion of which a constraint speaks. */
typedef struct Rows {
  double *const *displacement, *const *velocity, *const *acceleration, *const *internal, *const *external;
  const double *inertia;
  bool from_step; /* displacements count from the beginning of the step: rotations in space */
} Rows;

static Rows rows_of(const Explicit *s, const Constraint *constraint)
{
  const Particles *p = s->domain->particles;
  const int row = constraint->row;
  return (Rows){p->displacement.row + row, p->velocity.row + row, s->acceleration.row + row, p->internal.row + row,
                p->external.row + row,     p->inertia.row[row],   row && p->orientation[0]};
}

static int64_t part_end(const Constraint *constraint, int64_t part)
{
  int64_t end = (part + 1) * PART;
  return end < constraint->load->selection.count ? end : constraint->load->selection.count;
}

void explicit_add_to_ledger(Explicit *s, const double *sums)
{
  s->ledger->bond_work += sums[BOND_WORK];
  s->ledger->external_work += sums[EXTERNAL_WORK];
  s->ledger->damping_work += sums[DAMPING_WORK];
  s->ledger->kinetic += sums[KINETIC];
  s->ledger->between += sums[BETWEEN];
}

static void add_parts(Explicit *s, const Constraint *constraint)
{
  for (int64_t part = 0; part < explicit_parts_of(constraint); ++part) {
    const double *sums = s->parts[part];
    explicit_add_to_ledger(s, sums);
    s->motion = fmax(s->motion, sums[MOTION]);
  }
}

static void move_part(Explicit *s, const Constraint *constraint, const struct Motion *motion, int64_t part)
{
  const double *counted = s->domain->counted;
  const Direction d = {constraint->direction, axis_of(constraint->direction)};
  const Rows rows = rows_of(s, constraint);
  const OneSided *lets_go = constraint->one_sided;
  double dt = s->clock->time_step, c = explicit_mass_damping(s), bond = 0, external = 0, damping = 0, between = 0,
         largest = 0;
  for (int64_t k = part * PART; k < part_end(constraint, part); ++k) {
    if (constraint_leads(constraint, k)) continue;
    int32_t i = constraint->load->selection.places[k];
    double half = along(rows.velocity, d, i), a = along(rows.acceleration, d, i), drifted = dt * half;
    double fi = along(rows.internal, d, i), fe = along(rows.external, d, i);
    const double part_of = constraint_part(constraint, k), from = constraint_from(constraint, k);
    double v = (half - 0.5 * dt * a) / (1 - 0.5 * c * dt),
           off = (rows.from_step ? motion->moved * part_of : from + motion->target * part_of) -
                 along(rows.displacement, d, i);
    if (constraint_follows(constraint)) {
      off += constraint_followed(constraint, s->domain->particles->displacement.row, k);
      constraint->moved[k] = drifted + off;
    }
    if (lets_go && !constraint->platen) {
      const bool strikes = lets_go->open[k] || s->clock->time <= constraint->load->begin;
      lets_go->open[k] = !(lets_go->pushes * off > 0);
      if (lets_go->open[k]) continue;
      if (strikes) { /* dissipates in a plastic impact */
        const double fast = v - motion->moved * part_of / dt, lost = 0.5 * rows.inertia[i] * counted[i] * fast * fast;
        damping += lost;
        external += lost;
      }
    }
    if (!constraint->row) largest = fmax(largest, fabs(drifted + off));
    double moved = drifted + off, free_work = 0.5 * drifted * counted[i], work = 0.5 * moved * counted[i];
    bond -= fi * (work - free_work);
    damping -= (fi + fe - rows.inertia[i] * (a - c * v)) * free_work;
    external += -fe * free_work - fi * work - 0.5 * rows.inertia[i] * counted[i] * v * v;
    between += dt * dt / 8 * rows.inertia[i] * counted[i] * (a - c * v) * (a - c * v);
    add_along(rows.displacement, d, i, off);
    add_along(rows.velocity, d, i, off / dt);
  }
  double *sums = s->parts[part];
  sums[BOND_WORK] = bond;
  sums[EXTERNAL_WORK] = external;
  sums[DAMPING_WORK] = damping;
  sums[KINETIC] = 0;
  sums[BETWEEN] = between;
  sums[MOTION] = largest;
}

void explicit_foresee_motions(Explicit *s)
{
  const double dt = s->clock->time_step, end = explicit_time_after_step(s);
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *constraint = &s->loading->constraints[n];
    if (!load_acts(s->loading, constraint->load)) continue;
    const double before = constraint_displacement(constraint, end - dt);
    const bool first =
        s->clock->time <= constraint->load->begin; /* particles stand where they were, whatever is told */
    s->motions[n] = (struct Motion){.target = constraint_displacement(constraint, s->clock->time + dt),
                                    .moved = constraint_displacement(constraint, end) - (first ? 0 : before),
                                    .rate = (constraint_displacement(constraint, end + dt) - before) / (2 * dt)};
    const double fastest = fmax(fabs(s->motions[n].moved / dt), fabs(s->motions[n].rate));
    if (!constraint->row) s->ledger->given = fmax(s->ledger->given, fastest * constraint_most(constraint));
  }
}

/** Particles that follow others move after those. */
static bool is_turn(const Explicit *s, const Constraint *constraint, bool second)
{
  return load_acts(s->loading, constraint->load) && (constraint->images != NULL) == second;
}

/** Moves the centre of a platen that has passed its support to the position of the support at the end of the step. The
 * leaders have drifted before; the shift acts as an impulse in the middle of the step. */
static void explicit_strike_platen(Explicit *s, const Constraint *c, const struct Motion *motion)
{
  const Particles *p = s->domain->particles;
  const double passed = motion->target - platen_centre_displacement(c, p->displacement.row),
               fast = platen_centre_rate(c, p->velocity.row), sudden = passed / s->clock->time_step;
  c->platen->strikes = 0;
  if (!constraint_is_loose(c) || !(c->one_sided->pushes * passed > 0)) return;
  c->one_sided->open[0] = 0;
  c->platen->strikes = motion->rate - fast;
  c->platen->still = motion->rate - fast - sudden;
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t i = constraint_leader(c, m);
    const double half = constraint_along(c, p->velocity.row, i), volume = s->domain->counted[i],
                 bond = -0.5 * constraint_along(c, p->internal.row, i) * passed * volume;
    s->ledger->bond_work += bond;
    s->ledger->external_work += bond + 0.5 * p->density[i] * volume * sudden * (2 * half + sudden);
    constraint_add(c, p->displacement.row, i, passed);
    constraint_add(c, p->velocity.row, i, sudden);
  }
}

/** Gives the leaders of a platen that has struck the velocity of the support plus that of the turn, at the end of the
 * step: a plastic impact of all particles under the platen. */
static void explicit_still_platen(Explicit *s, const Constraint *c)
{
  const Particles *p = s->domain->particles;
  Platen *q = c->platen;
  if (q->strikes == 0) return;
  for (int64_t n = 0; n < c->load->selection.count; ++n) {
    const int32_t i = c->load->selection.places[n];
    const double mass = p->density[i] * s->domain->counted[i], lost = 0.5 * mass * q->strikes * q->strikes;
    s->ledger->damping_work += lost;
    s->ledger->external_work += lost;
    if (!constraint_leads(c, n)) continue;
    const double gain = 0.5 * mass * q->still * (2 * constraint_along(c, p->velocity.row, i) + q->still);
    s->ledger->external_work += gain;
    s->ledger->kinetic += gain;
    constraint_add(c, p->velocity.row, i, q->still);
  }
  q->strikes = q->still = 0;
  s->ledger->damped = 1;
}

void explicit_note_open_platens(Explicit *s)
{
  const Particles *p = s->domain->particles;
  for (int n = 0; n < s->loading->constraint_count; ++n) {
    const Constraint *c = &s->loading->constraints[n];
    if (!c->platen || !c->platen->opens) continue;
    const int32_t i = constraint_leader(c, c->platen->leaders);
    const double half = constraint_along(c, p->velocity.row, i);
    s->ledger->external_work += 0.5 * p->density[i] * s->domain->counted[i] * half * half;
    c->platen->opens = false;
  }
}

void explicit_prescribe_displacements(Explicit *s)
{
  TEAM_SINGLE
  {
    s->motion = 0;
    for (int64_t b = 0; b < s->domain->batch_count; ++b) s->motion = fmax(s->motion, s->sums[b][MOTION]);
  }
  const int count = s->loading->constraint_count; /* one after the other: they may share particles */
  for (int n = 0; n < 2 * count; ++n) {
    const Constraint *constraint = &s->loading->constraints[n % count];
    if (!is_turn(s, constraint, n >= count)) continue;
    if (constraint->platen && constraint->one_sided)
      TEAM_SINGLE explicit_strike_platen(s, constraint, &s->motions[n % count]);
    TEAM_FOR (part, explicit_parts_of(constraint)) move_part(s, constraint, &s->motions[n % count], part);
    TEAM_SINGLE add_parts(s, constraint);
  }
}

static void speed_part(Explicit *s, const Constraint *constraint, const struct Motion *motion, int64_t part)
{
  const double *counted = s->domain->counted;
  const Direction d = {constraint->direction, axis_of(constraint->direction)};
  const Rows rows = rows_of(s, constraint);
  double dt = s->clock->time_step, c = explicit_mass_damping(s), external = 0, damping = 0, kinetic = 0, between = 0;
  const bool keeps = constraint->one_sided && !constraint->platen; /* the acceleration decides in the next step */
  for (int64_t k = part * PART; k < part_end(constraint, part); ++k) {
    if (constraint_leads(constraint, k) || constraint_is_open(constraint, k)) continue;
    int32_t i = constraint->load->selection.places[k];
    double mass = rows.inertia[i] * counted[i], v = along(rows.velocity, d, i), a = along(rows.acceleration, d, i);
    const double part_of = constraint_part(constraint, k);
    double moved = constraint_follows(constraint) ? constraint->moved[k] : motion->moved * part_of,
           rate = motion->rate * part_of + constraint_followed(constraint, s->domain->particles->velocity.row, k);
    double fi = along(rows.internal, d, i), fe = along(rows.external, d, i), work = 0.5 * moved * counted[i];
    kinetic += 0.5 * mass * (rate * rate - v * v);
    damping -= (fi + fe - rows.inertia[i] * (a - c * v)) * work;
    external += 0.5 * mass * rate * rate - fe * work - fi * work;
    between -= dt * dt / 8 * mass * (a - c * v) * (a - c * v);
    add_along(rows.velocity, d, i, rate - v);
    if (!keeps) add_along(rows.acceleration, d, i, -a);
  }
  double *sums = s->parts[part];
  sums[BOND_WORK] = sums[MOTION] = 0;
  sums[EXTERNAL_WORK] = external;
  sums[DAMPING_WORK] = damping;
  sums[KINETIC] = kinetic;
  sums[BETWEEN] = between;
}

void explicit_prescribe_velocities(Explicit *s)
{
  const int count = s->loading->constraint_count;
  for (int n = 0; n < 2 * count; ++n) {
    const Constraint *constraint = &s->loading->constraints[n % count];
    if (!is_turn(s, constraint, n >= count)) continue;
    const struct Motion *motion = &s->motions[n % count];
    if (constraint->platen && constraint->one_sided) TEAM_SINGLE explicit_still_platen(s, constraint);
    TEAM_FOR (part, explicit_parts_of(constraint)) speed_part(s, constraint, motion, part);
    TEAM_SINGLE add_parts(s, constraint);
  }
}

double explicit_inertia(const Solver *run, const Constraint *constraint, int64_t n)
{
  const Explicit *s = run->own;
  const Particles *p = s->domain->particles;
  const int32_t i = constraint->load->selection.places[n];
  const double time = s->clock->time, dt = s->clock->time_step;
  if (time <= constraint->load->begin) return 0;
  const double before = constraint_displacement(constraint, time - dt), now = constraint_displacement(constraint, time),
               after = constraint_displacement(constraint, time + dt);
  const double part = constraint_part(constraint, n);
  const double acceleration = part * (after - 2 * now + before) / (dt * dt) +
                              constraint_followed(constraint, s->acceleration.row, n),
               rate = part * (after - before) / (2 * dt) + constraint_followed(constraint, p->velocity.row, n);
  double drag = 0; /* of stiffness */
  for (int k = 0; k < 3 && s->viscous.time > 0; ++k)
    if (constraint->direction[k] != 0) drag += constraint->direction[k] * s->viscous.drag.row[constraint->row + k][i];
  return p->volume[i] * (drag + p->inertia.row[constraint->row][i] * (acceleration + explicit_mass_damping(s) * rate));
}

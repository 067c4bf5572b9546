/* Phases of a formulation, and laws between them, over the blocks of a body. Phases follow each other within a block, while its numbers are
 * in the cache, as far as none reads of its neighbours what another one of them writes: there all blocks wait for each other. */
#include "base/team.h"
#include "base/tensor.h"
#include "domain/domain.h"

#include <math.h>
#include <string.h>

/** What a sweep is for. */
typedef struct Purpose {
  double *const *at; /* NULL, or displacements at which a linearised step was made */
  bool no_law;       /* stresses are as they should be */
  unsigned without;  /* phases that write any of these are left out */
} Purpose;

/** Not finite if any force of the block is not. */
BRECCIA_CLONES
static double force_magnitude(const Particles *p, const Span *span)
{
  Lanes sum = {0};
  for (int k = 0; k < 3; ++k)
    for (int64_t place = span->first * SLICE; place < span->last * SLICE; place += LANES)
      sum += lanes_absolute(lanes_load(p->internal[k] + place));
  return lanes_total(sum);
}

/** Phases `from` .. `to` - 1 of a formulation that follow each other within a block; `law` is the first that reads stresses, if any. From
 *  `close` on they need that the blocks with lower neighbours are done too. */
typedef struct Group {
  int from, law, close, to;
} Group;

/** The group that begins with a phase. */
static Group group_from(const Domain *d, int from)
{
  const Phase *phases = d->type->phases;
  unsigned written = 0;
  Group group = {from, -1, MOST_PHASES, from};
  for (int p = from; p < MOST_PHASES && phases[p].run; group.to = ++p) {
    const unsigned read = phases[p].of_neighbours | (d->rows_cut ? phases[p].along_rows : 0);
    if (p > from && (read & written || phases[p].by_one || phases[from].by_one)) break;
    if (phases[p].of_lower & written && group.close == MOST_PHASES) group.close = p;
    if (phases[p].reads & OF_STRESSES && group.law < 0) group.law = p;
    written |= phases[p].writes;
  }
  return group;
}

static void run_phases(Domain *d, int from, int to, const Sweep *sweep, const Purpose *purpose)
{
  for (int p = from; p < to; ++p)
    if (!(d->type->phases[p].writes & purpose->without)) d->type->phases[p].run(d->formulation, sweep);
}

/** A block of points on particles, or of none.
 *  @param[in] send  only up to the law: strains are sent to servers */
static void run_places(Domain *d, const Group *group, int64_t block, const Purpose *purpose, bool send)
{
  _Alignas(64) double carry[CARRY * BLOCK], change[12 * BLOCK];
  const Span *span = &d->blocks[block];
  const int64_t first = span->first * SLICE;
  const int count = (int)(span->last * SLICE - first);
  Sweep sweep = {.first = span->first, .last = span->last, .carry = carry, .at = purpose->at};
  if (purpose->at && d->points.plane_stress) memset(change + ZZ * BLOCK, 0, sizeof(double) * BLOCK);
  for (int k = 0; k < 6 && d->points.components == 6; ++k) {
    sweep.strain[k] = purpose->at ? change + k * BLOCK : d->points.strain[k] + first;
    sweep.stress[k] = purpose->at ? change + (6 + k) * BLOCK : d->points.stress[k] + first;
  }
  run_phases(d, group->from, group->law < 0 ? group->to : group->law, &sweep, purpose);
  if (group->law < 0) return;
  if (send) {
    points_send(&d->points, first, count, sweep.strain);
    return;
  }
  if (d->points.components == 6) {
    if (purpose->at)
      points_change(&d->points, first, count, sweep.strain, sweep.stress);
    else if (!purpose->no_law)
      d->block_failed[block] = points_update(&d->points, first, count, sweep.strain, sweep.stress);
  }
  run_phases(d, group->law, group->to, &sweep, purpose);
}

/** Both ends of bonds whose laws could not be integrated are marked; several threads may mark one end. */
static void mark_ends(Domain *d, int64_t slice, int64_t row, int count)
{
  for (int64_t r = row; r < row + count; ++r) {
    int64_t slot;
    int lane;
    if (!d->points.gave_up[r]) continue;
    d->points.gave_up[r] = 0;
    bond_list_bond(&d->bonds, &d->family, slice, r, &slot, &lane);
    __atomic_fetch_or(&d->gave_up[slice * SLICE + lane], 1, __ATOMIC_RELAXED);
    __atomic_fetch_or(&d->gave_up[family_bond(&d->family, slice, slot, lane).neighbour], 1, __ATOMIC_RELAXED);
  }
}

/** Place of the owner of a bond's row. */
static int64_t owner_of(const Domain *d, int64_t slice, int64_t row)
{
  int64_t slot;
  int lane;
  bond_list_bond(&d->bonds, &d->family, slice, row, &slot, &lane);
  return slice * SLICE + lane;
}

/** A block of points on bonds, chunk by chunk of rows of one slice and material. */
static void run_bonds(Domain *d, const Group *group, int64_t block, const Purpose *purpose, bool send)
{
  _Alignas(64) double carry[CARRY * BLOCK], strain[BLOCK], stress[BLOCK];
  Sweep sweep = {.carry = carry, .strain = {strain}, .stress = {stress}};
  int64_t failed = -1;
  for (int64_t slice = d->blocks[block].first; slice < d->blocks[block].last; ++slice) {
    const int64_t end = d->bonds.first[slice + 1];
    for (sweep.row = d->bonds.first[slice]; sweep.row < end; sweep.row += sweep.rows) {
      const PointsRun *run = &d->points.runs[points_run(&d->points, sweep.row)];
      const int64_t left = (run->first + run->count < end ? run->first + run->count : end) - sweep.row;
      sweep.rows = left < BLOCK ? (int)left : BLOCK;
      sweep.first = slice;
      sweep.last = slice + 1;
      run_phases(d, group->from, group->law, &sweep, purpose);
      if (send) {
        points_send(&d->points, sweep.row, sweep.rows, sweep.strain);
        continue;
      }
      const int64_t bad = points_update(&d->points, sweep.row, sweep.rows, sweep.strain, sweep.stress);
      if (bad >= 0 && failed < 0) failed = owner_of(d, slice, bad);
      if (d->points.gave_up) mark_ends(d, slice, sweep.row, sweep.rows);
      run_phases(d, group->law, group->to, &sweep, purpose);
    }
  }
  d->block_failed[block] = failed;
}

static void run_group(Domain *d, const Group *group, int64_t block, const Purpose *purpose, bool send)
{
  if (group->law < 0 || d->points.components != 1)
    run_places(d, group, block, purpose, send);
  else if (!purpose->at && !purpose->no_law)
    run_bonds(d, group, block, purpose, send);
}

/** Phases of a block that have waited for lower blocks. */
static void finish_block(Domain *d, const Group *group, int64_t b, const Purpose *purpose, unsigned writes)
{
  run_group(d, group, b, purpose, false);
  if (writes & OF_FORCES) d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
}

/** Where bonds have broken: the same again for blocks whose families turn out to carry less, with the stresses that laws have given. */
static void settle(Domain *d, const Group *group)
{
  domain_settle(d);
  TEAM_FOR (b, d->block_count) {
    const int64_t first = d->blocks[b].first * SLICE, places = d->blocks[b].last * SLICE - first;
    if (memchr(d->is_torn + first, 2, (size_t)places)) run_group(d, group, b, &(Purpose){.no_law = true}, false);
  }
}

static void run_all(Domain *d, const Purpose *purpose)
{
  const bool ahead = !purpose->at && !purpose->no_law && points_ask_ahead(&d->points);
  for (int p = 0; p < MOST_PHASES && d->type->phases[p].run;) {
    const Group group = group_from(d, p);
    p = group.to;
    unsigned writes = 0;
    for (int n = group.from; n < group.to; ++n) writes |= d->type->phases[n].writes & ~purpose->without;
    if (!writes) continue;
    if (d->type->phases[group.from].by_one) {
      TEAM_SINGLE
      d->type->phases[group.from].run(d->formulation, &(Sweep){.last = d->particles->slices, .at = purpose->at});
      continue;
    }
    if (ahead && group.law >= 0) { /* servers work while strains of further points are found */
      TEAM_FOR (b, d->block_count) run_group(d, &group, b, purpose, true);
      TEAM_SINGLE points_await(&d->points);
    }
    Group before = group, after = {group.close, -1, MOST_PHASES, group.to};
    const bool in_two = group.close < group.to;
    if (in_two) before.to = group.close;
    const TeamShare share = team_share(d->block_count);
    const bool torn = group.law >= 0 && d->torn_count && !purpose->at; /* forces wait for what families carry */
    TEAM_FOR (b, d->block_count) {
      run_group(d, &before, b, purpose, false);
      if (in_two && !torn && d->lowest[b] >= share.first) finish_block(d, &after, b, purpose, writes);
      if (!in_two && writes & OF_FORCES) d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
    }
    if (torn) settle(d, &before);
    if (in_two) {
      TEAM_FOR (b, d->block_count) /* the rest, whose neighbours were another thread's */
        if (torn || d->lowest[b] < share.first) finish_block(d, &after, b, purpose, writes);
    }
  }
}

void domain_forces(Domain *d)
{
  run_all(d, &(Purpose){0});
  forces_resist(&d->forces);
  TEAM_SINGLE
  {
    d->force_sum = 0;
    d->failed_place = -1;
    for (int64_t b = 0; b < d->block_count; ++b) {
      d->force_sum += d->block_sum[b];
      if (d->failed_place < 0) d->failed_place = d->block_failed[b];
    }
  }
}

static void evaluate(void *context)
{
  domain_forces(context);
}

void domain_evaluate(Domain *d)
{
  team_run(evaluate, d);
}

static void show_states(void *context)
{
  run_all(context, &(Purpose){.no_law = true, .without = OF_SUMS | OF_FORCES});
}

void domain_show_states(Domain *d)
{
  team_run(show_states, d);
}

static void remake_forces(void *context)
{
  Domain *d = context;
  run_all(d, &(Purpose){.no_law = true});
  forces_resist(&d->forces);
}

void domain_follow(Domain *d)
{
  if (domain_is_elastic(d))
    domain_evaluate(d);
  else if (d->points.components == 6)
    team_run(remake_forces, d);
  else
    domain_show_states(d);
}

/* ---- linearised steps ---- */

int domain_linearise(Domain *d, Error *error)
{
  if (points_keep_tangents(&d->points, true, error)) return BRECCIA_FAILURE;
  domain_evaluate(d);
  points_keep_tangents(&d->points, false, error);
  return d->type->linearise(d->formulation, error);
}

/** Puts other arrays in the place of displacements and internal forces, or takes them away again. */
static void exchange(Particles *p, double *displacement[3], double *internal[3])
{
  for (int k = 0; k < 3; ++k) {
    double *u = p->displacement[k], *f = p->internal[k];
    p->displacement[k] = displacement[k];
    p->internal[k] = internal[k];
    displacement[k] = u;
    internal[k] = f;
  }
}

typedef struct Step {
  Domain *domain;
  double *displacement[3], *internal[3];
} Step;

static void take_step(void *context)
{
  Step *s = context;
  run_all(s->domain, &(Purpose){.at = s->displacement});
}

void domain_linear_step(Domain *d, double *const v[3], double *const change[3])
{
  Step step = {d, {v[0], v[1], v[2]}, {change[0], change[1], change[2]}};
  exchange(d->particles, step.displacement, step.internal);
  team_run(take_step, &step);
  exchange(d->particles, step.displacement, step.internal);
}

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

/** Phases `from` .. `to` - 1 of a formulation that follow each other within a block; `law` is the first that reads stresses, if any. */
typedef struct Group {
  int from, law, to;
} Group;

/** The group that begins with a phase. */
static Group group_from(const Domain *d, int from)
{
  const Phase *phases = d->type->phases;
  unsigned written = 0;
  Group group = {from, -1, from};
  for (int p = from; p < MOST_PHASES && phases[p].run; group.to = ++p) {
    const unsigned read = phases[p].of_neighbours | (d->rows_cut ? phases[p].along_rows : 0);
    if (p > from && (read & written || phases[p].by_one || phases[from].by_one)) break;
    if (phases[p].reads & OF_STRESSES && group.law < 0) group.law = p;
    written |= phases[p].writes;
  }
  return group;
}

static void run_phases(Domain *d, int from, int to, int64_t block, const Sweep *sweep, const Purpose *purpose)
{
  for (int p = from; p < to; ++p) {
    const Phase *phase = &d->type->phases[p];
    if (phase->writes & purpose->without) continue;
    const int64_t failed = phase->run(d->formulation, sweep);
    if (phase->writes & OF_FORCES && d->points.where != POINTS_ON_PARTICLES) d->block_failed[block] = failed;
  }
}

/** @param[in] change  [12][BLOCK] room for changes of strains and stresses */
static Sweep sweep_of(Domain *d, int64_t block, double *carry, double *change, const Purpose *purpose)
{
  const Span *span = &d->blocks[block];
  Sweep sweep = {.first = span->first, .last = span->last, .carry = carry, .at = purpose->at};
  for (int k = 0; k < 6; ++k) {
    sweep.strain[k] = purpose->at ? change + k * BLOCK : d->points.strain[k] + span->first * SLICE;
    sweep.stress[k] = purpose->at ? change + (6 + k) * BLOCK : d->points.stress[k] + span->first * SLICE;
  }
  return sweep;
}

static void run_group(Domain *d, const Group *group, int64_t block, const Purpose *purpose)
{
  _Alignas(64) double carry[CARRY * BLOCK], change[12 * BLOCK];
  if (purpose->at && d->points.space == SPACE_PLANE_STRESS) memset(change + ZZ * BLOCK, 0, sizeof(double) * BLOCK);
  const Sweep sweep = sweep_of(d, block, carry, change, purpose);
  run_phases(d, group->from, group->law < 0 ? group->to : group->law, block, &sweep, purpose);
  if (group->law < 0) return;
  if (purpose->at)
    points_change(&d->points, sweep.first, sweep.last, sweep.strain, sweep.stress);
  else if (!purpose->no_law)
    d->block_failed[block] = points_update(&d->points, sweep.first, sweep.last, NULL);
  run_phases(d, group->law, group->to, block, &sweep, purpose);
}

/** The same of all blocks, where some have laws in servers: strains go out part by part, so that servers work while further
 *  parts are deformed. */
static void run_in_parts(Domain *d, const Group *group, const Purpose *purpose)
{
  for (int k = 0; k < d->part_count; ++k) {
    const Part *part = &d->parts[k];
    TEAM_FOR (n, part->last - part->first) {
      const int64_t b = part->first + n;
      if (d->part_of[b] != k) continue;
      const Sweep sweep = sweep_of(d, b, d->carry + b * CARRY * BLOCK, NULL, purpose);
      run_phases(d, group->from, group->law, b, &sweep, purpose);
      points_pack(&d->points, sweep.first, sweep.last);
    }
    if (team_turn(k)) points_post(&d->points, part->material, part->server);
  }
  TEAM_FOR (b, d->block_count)
    if (d->part_of[b] < 0) run_group(d, group, b, purpose);
  for (int k = 0; k < d->part_count; ++k) {
    const Part *part = &d->parts[k];
    TEAM_SINGLE
    {
      const int64_t failed = points_collect(&d->points, part->material, part->server);
      for (int64_t b = part->first; b < part->last; ++b)
        if (d->part_of[b] == k)
          d->block_failed[b] = failed >= d->blocks[b].first * SLICE && failed < d->blocks[b].last * SLICE ? failed : -1;
    }
    TEAM_FOR (n, part->last - part->first) {
      const int64_t b = part->first + n;
      if (d->part_of[b] != k) continue;
      const Sweep sweep = sweep_of(d, b, d->carry + b * CARRY * BLOCK, NULL, purpose);
      points_unpack(&d->points, sweep.first, sweep.last);
      run_phases(d, group->law, group->to, b, &sweep, purpose);
    }
  }
}

/** Laws act on bonds, and some run in servers: a group that makes forces is gone through once before to gather strains. */
static void gather_bonds(Domain *d, const Group *group, const Purpose *purpose)
{
  TEAM_SINGLE points_gather_bonds(&d->points);
  if (d->points.pass != PASS_GATHER) return;
  TEAM_FOR (b, d->block_count) run_group(d, group, b, purpose);
  TEAM_SINGLE points_ask_bonds(&d->points);
}

static void run_all(Domain *d, const Purpose *purpose)
{
  const bool remote = d->points.server && !purpose->at && !purpose->no_law;
  const bool parts = remote && d->part_count && !d->points.elastic_stage && points_begun(&d->points);
  for (int p = 0; p < MOST_PHASES && d->type->phases[p].run;) {
    const Group group = group_from(d, p);
    p = group.to;
    unsigned writes = 0;
    for (int n = group.from; n < group.to; ++n) writes |= d->type->phases[n].writes & ~purpose->without;
    if (!writes) continue;
    if (d->type->phases[group.from].by_one) {
      TEAM_SINGLE d->type->phases[group.from].run(d->formulation,
                                                  &(Sweep){.last = d->particles->slices, .at = purpose->at});
      continue;
    }
    if (remote && d->points.where == POINTS_ON_BONDS && writes & OF_FORCES) gather_bonds(d, &group, purpose);
    if (parts && group.law >= 0)
      run_in_parts(d, &group, purpose);
    else
      TEAM_FOR (b, d->block_count) {
        run_group(d, &group, b, purpose);
        if (writes & OF_FORCES) d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
      }
  }
}

void domain_forces(Domain *d)
{
  run_all(d, &(Purpose){0});
  contact_resist(&d->contact);
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
  contact_resist(&d->contact);
}

void domain_follow(Domain *d)
{
  if (domain_is_elastic(d))
    domain_evaluate(d);
  else if (d->points.where == POINTS_ON_PARTICLES)
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

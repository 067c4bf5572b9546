/* Phases of formulations, and laws between them, over the batches of a body, region by region. Phases follow each other within a batch, while
 * its numbers are in the cache, as far as none reads of its neighbours what another one of them writes: there all batches wait for each other. */
#include "base/team.h"
#include "base/tensor.h"
#include "domain/regions.h"

#include <math.h>
#include <string.h>

/** Options of a sweep. */
typedef struct Purpose {
  const Evaluation *of; /* evaluation to perform */
  bool no_law;          /* stresses are as they should be */
  bool observes;        /* strains and stresses are written that evaluations leave out */
  unsigned without;     /* phases that write any of these are left out */
} Purpose;

/** Not finite if any force of the batch is not. */
BRECCIA_CLONES
static double force_magnitude(const Vector *internal, const Batch *batch)
{
  Lanes sum = {0};
  for (int k = 0; k < internal->space->rows; ++k)
    for (int64_t place = batch->first * SLICE; place < batch->last * SLICE; place += LANES)
      sum += lanes_absolute(lanes_load(internal->row[k] + place));
  return lanes_total(sum);
}

/** Phases `from` .. `to` - 1 of a formulation that follow each other within a batch; `law` is the first that reads stresses, if any. From
 *  `close` on they need that the batches with lower neighbours are done too. */
typedef struct Group {
  int from, law, close, to;
  bool by_stripes;
  /* Phase that this thread calls before them, into its window, for slices that its batches read; up to `filled` it is done. -1: there is none */
  int ahead;
  double *window;
  int64_t filled;
} Group;

/** The group that begins with a phase. @param[in] window  of this thread; NULL: none */
static Group group_from(const Domain *d, const Region *region, int from, double *window)
{
  const Phase *phases = region->type->phases;
  unsigned written = 0;
  Group group = {.from = from, .law = -1, .close = MOST_PHASES, .to = from, .ahead = -1};
  if (window && phases[from].ahead) {
    group.ahead = from;
    group.window = window;
    group.from = group.to = ++from;
  }
  for (int p = from; p < MOST_PHASES && phases[p].run; group.to = ++p) {
    const unsigned read = phases[p].of_neighbours | (d->rows_cut ? phases[p].along_rows : 0);
    if (p > from && (read & written || phases[p].by_one || phases[from].by_one)) break;
    if (p > from && window && phases[p].ahead) break;
    if (phases[p].of_lower & written && group.close == MOST_PHASES) group.close = p;
    if (phases[p].reads & OF_STRESSES && group.law < 0) group.law = p;
    written |= phases[p].writes;
    group.by_stripes |= phases[p].by_stripes;
  }
  return group;
}

/** Returns true if the evaluation is a linearised step. */
static bool is_linear(const Purpose *purpose)
{
  return purpose->of->linearised_at != NULL;
}

/** Returns a sweep over slices first .. last - 1 with the rows of an evaluation. */
static Sweep sweep_of(const Purpose *purpose, int64_t first, int64_t last)
{
  return (Sweep){.first = first,
                 .last = last,
                 .displacement = purpose->of->displacement->row,
                 .linearised_at = purpose->of->linearised_at ? purpose->of->linearised_at->row : NULL,
                 .internal = purpose->of->internal->row};
}

/** Runs phases `from` .. `to` - 1. @return -1, or a place at which a phase has failed */
static int64_t run_phases(const Region *region, int from, int to, const Sweep *sweep, const Purpose *purpose)
{
  int64_t failed = -1;
  for (int p = from; p < to; ++p) {
    if (region->type->phases[p].writes & purpose->without) continue;
    const int64_t place = region->type->phases[p].run(region->formulation, sweep);
    if (failed < 0) failed = place;
  }
  return failed;
}

/** Notes the first failure of a batch. @param[in] place  -1: none */
static void note_failure(Domain *d, int64_t batch, int64_t place)
{
  if (place >= 0 && d->batch_failed[batch] < 0) d->batch_failed[batch] = place;
}

/** Writes what a batch has found for those who look. */
static void keep_tensors(const Domain *d, int64_t first, int count, const double *found)
{
  for (int k = 0; k < 6; ++k) {
    memcpy(d->strain[k] + first, found + k * BATCH, sizeof(double) * (size_t)count);
    memcpy(d->stress[k] + first, found + (6 + k) * BATCH, sizeof(double) * (size_t)count);
  }
}

/** A batch of points on particles, or of none.
 *  @param[in] send  only up to the law: strains are sent to servers */
static void run_places(Domain *d, Region *region, const Group *group, int64_t batch, const Purpose *purpose, bool send)
{
  _Alignas(64) double carry[CARRY * BATCH], change[12 * BATCH];
  const Batch *slices = &d->batches[batch];
  Points *points = &region->points;
  const int64_t first = slices->first * SLICE;
  const int count = (int)(slices->last * SLICE - first);
  const bool leaves = d->leaves_tensors || purpose->observes, linear = is_linear(purpose), apart = linear || leaves;
  Sweep sweep = sweep_of(purpose, slices->first, slices->last);
  sweep.carry = carry;
  sweep.no_law = purpose->no_law && !leaves;
  sweep.window = group->window;
  sweep.window_slices = region->window.slices;
  if (linear && points->plane_stress) memset(change + ZZ * BATCH, 0, sizeof(double) * BATCH);
  for (int k = 0; k < 6 && points_on_particles(points); ++k) {
    sweep.strain[k] = apart ? change + k * BATCH : points->strain[k] + first;
    sweep.stress[k] = apart ? change + (6 + k) * BATCH : points->stress[k] + first;
  }
  note_failure(d, batch, run_phases(region, group->from, group->law < 0 ? group->to : group->law, &sweep, purpose));
  if (group->law < 0) return;
  if (send) {
    points_send(points, first, count, sweep.strain);
    return;
  }
  if (points_on_particles(points)) {
    if (linear)
      points_change(points, first, count, sweep.strain, sweep.stress);
    else if (!sweep.no_law)
      note_failure(d, batch, points_update(points, first, count, sweep.strain, sweep.stress));
  }
  note_failure(d, batch, run_phases(region, group->law, group->to, &sweep, purpose));
  if (purpose->observes) keep_tensors(d, first, count, change);
}

/** Both ends of bonds whose laws could not be integrated are marked; several threads may mark one end. */
static void mark_ends(Domain *d, const Region *region, int64_t slice, int64_t row, int count)
{
  for (int64_t r = row; r < row + count; ++r) {
    int64_t slot;
    int lane;
    if (!region->points.gave_up[r]) continue;
    region->points.gave_up[r] = 0;
    bond_list_bond(&region->bonds, &d->family, slice, r, &slot, &lane);
    __atomic_fetch_or(&d->gave_up[slice * SLICE + lane], 1, __ATOMIC_RELAXED);
    __atomic_fetch_or(&d->gave_up[family_bond(&d->family, slice, slot, lane).neighbour], 1, __ATOMIC_RELAXED);
  }
}

/** Place of the owner of a bond's row, most likely in a slice; servers tell of any row. */
static int64_t owner_of(const Domain *d, const Region *region, int64_t slice, int64_t row)
{
  int64_t slot;
  int lane;
  while (slice && row < region->bonds.first[slice]) --slice;
  while (row >= region->bonds.first[slice + 1]) ++slice;
  bond_list_bond(&region->bonds, &d->family, slice, row, &slot, &lane);
  return slice * SLICE + lane;
}

/** Laws of a batch of rows. @return `failed`, or if it is -1 the owner of a bond whose law could not be integrated */
static int64_t update_bonds(Domain *d, Region *region, const Sweep *sweep, int64_t failed)
{
  Points *points = &region->points;
  const int64_t bad = points_update(points, sweep->row, sweep->rows, sweep->strain, sweep->stress);
  if (points->gave_up) mark_ends(d, region, sweep->first, sweep->row, sweep->rows);
  return bad >= 0 && failed < 0 ? owner_of(d, region, sweep->first, bad) : failed;
}

/** The points on bonds of a batch of places, in batches of rows of one slice and material. */
static void run_bonds(Domain *d, Region *region, const Group *group, int64_t batch, const Purpose *purpose, bool send)
{
  _Alignas(64) double carry[CARRY * BATCH], change[12 * BATCH];
  Points *points = &region->points;
  const int components = points->components;
  const bool linear = is_linear(purpose), kept = components == 6 && !linear; /* strains and stresses stay in the rows */
  Sweep sweep = sweep_of(purpose, 0, 0);
  sweep.carry = carry;
  sweep.no_law = purpose->no_law;
  if (linear && points->plane_stress) memset(change + ZZ * BATCH, 0, sizeof(double) * BATCH);
  const BondList *bonds = &region->bonds;
  int64_t failed = -1;
  for (int64_t slice = d->batches[batch].first; slice < d->batches[batch].last; ++slice) {
    const int64_t end = bonds->first[slice + 1];
    for (sweep.row = bonds->first[slice]; sweep.row < end; sweep.row += sweep.rows) {
      const PointsRun *run = &points->runs[points_run(points, sweep.row)];
      const int64_t left = (run->first + run->count < end ? run->first + run->count : end) - sweep.row;
      sweep.rows = left < BATCH ? (int)left : BATCH;
      sweep.first = slice;
      sweep.last = slice + 1;
      for (int k = 0; k < components; ++k) {
        sweep.strain[k] = kept ? points->strain[k] + sweep.row : change + k * BATCH;
        sweep.stress[k] = kept ? points->stress[k] + sweep.row : change + (6 + k) * BATCH;
      }
      if (points->takes_lateral) sweep.strain[1] = change + BATCH;
      note_failure(d, batch, run_phases(region, group->from, group->law, &sweep, purpose));
      if (send) {
        points_send(points, sweep.row, sweep.rows, sweep.strain);
        continue;
      }
      if (linear)
        points_change(points, sweep.row, sweep.rows, sweep.strain, sweep.stress);
      else if (!purpose->no_law)
        failed = update_bonds(d, region, &sweep, failed);
      note_failure(d, batch, run_phases(region, group->law, group->to, &sweep, purpose));
    }
  }
  note_failure(d, batch, failed);
}

/** Brings the window of a group that has one to what a batch reads. By each thread in the order of its batches. */
static void fill_window(Domain *d, const Region *region, Group *group, int64_t batch, const Purpose *purpose)
{
  if (group->ahead < 0) return;
  const Window *w = &region->window;
  const int64_t low = w->low[batch - region->first_batch], end = w->high[batch - region->first_batch] + 1;
  if (group->filled < low) group->filled = low;
  if (group->filled >= end) return;
  Sweep sweep = sweep_of(purpose, group->filled, end);
  sweep.window = group->window;
  sweep.window_slices = w->slices;
  note_failure(d, batch, run_phases(region, group->ahead, group->ahead + 1, &sweep, purpose));
  group->filled = end;
}

static void run_group(Domain *d, Region *region, Group *group, int64_t batch, const Purpose *purpose, bool send)
{
  fill_window(d, region, group, batch, purpose);
  const bool rows = region->points.on_bonds && (region->points.components == 1 || points_keep_tensors(&region->points));
  if (group->law < 0 || !rows)
    run_places(d, region, group, batch, purpose, send);
  else if (region->points.components == 6 || (!is_linear(purpose) && !purpose->no_law)) /* fibres keep their pulls */
    run_bonds(d, region, group, batch, purpose, send);
}

/** Sums the magnitudes of the force components of a batch. */
static void sum_forces(Domain *d, const Purpose *purpose, int64_t b)
{
  d->batch_sum[b] = force_magnitude(purpose->of->internal, &d->batches[b]);
}

/** Phases of a batch that have waited for lower batches. */
static void finish_batch(Domain *d, Region *region, Group *group, int64_t b, const Purpose *purpose, unsigned writes)
{
  run_group(d, region, group, b, purpose, false);
  if (writes & OF_FORCES) sum_forces(d, purpose, b);
}

/** Batches of a thread, from a first one on, that close after those of all threads: those with neighbours in the shares of others, and as many more as
 *  other threads leave for later, so that none waits while another works. */
typedef struct Later {
  int64_t from, share_first;
  int64_t more; /* of those that could close at once */
} Later;

static Later find_later(const Domain *d, int64_t from, int64_t count)
{
  int64_t most = 0, here = 0;
  const int64_t first = from + team_share(count).first;
  for (int thread = 0; thread < team_size(); ++thread) {
    const TeamShare share = team_share_of(count, thread);
    int64_t waiting = 0;
    for (int64_t n = share.first; n < share.last; ++n) waiting += d->lowest[from + n] < from + share.first;
    if (from + share.first == first) here = waiting;
    if (waiting > most) most = waiting;
  }
  return (Later){from, first, most - here};
}

/** By each thread in the order of its batches. */
static bool closes_later(const Domain *d, Later *later, int64_t n)
{
  return d->lowest[later->from + n] < later->share_first || later->more-- > 0;
}

/** Where bonds have broken: the same again for batches whose families turn out to carry less, with the stresses that laws have given. */
static void settle(Domain *d, Region *region, Group *group, const Purpose *purpose)
{
  domain_settle(d, region);
  TEAM_FOR (n, region->last_batch - region->first_batch) {
    const int64_t b = region->first_batch + n, first = d->batches[b].first * SLICE,
                  places = d->batches[b].last * SLICE - first;
    if (memchr(d->is_torn + first, 2, (size_t)places))
      run_group(d, region, group, b, &(Purpose){.of = purpose->of, .no_law = true}, false);
  }
}

/** What particles of other regions show those of this one. */
static void show_border(const Region *region, const Group *group, const Purpose *purpose)
{
  TEAM_FOR (n, region->border_count) {
    const Sweep sweep = sweep_of(purpose, region->border[n], region->border[n] + 1);
    for (int p = group->from; p < group->to; ++p)
      if (region->type->phases[p].writes == OF_SHOWN) run_phases(region, p, p + 1, &sweep, purpose);
  }
}

static void run_region(Domain *d, Region *region, const Purpose *purpose)
{
  const Phase *phases = region->type->phases;
  const int64_t from = region->first_batch, count = region->last_batch - from;
  const bool asks = !is_linear(purpose) && !purpose->no_law && points_ask_ahead(&region->points);
  double *window = window_of_thread(&region->window);
  for (int p = 0; p < MOST_PHASES && phases[p].run;) {
    Group group = group_from(d, region, p, window);
    p = group.to;
    unsigned writes = 0;
    for (int n = group.from; n < group.to; ++n) writes |= phases[n].writes & ~purpose->without;
    if (!writes) continue;
    if (phases[group.from].by_one) {
      const Sweep whole = sweep_of(purpose, 0, d->particles->slices);
      TEAM_SINGLE note_failure(d, from, phases[group.from].run(region->formulation, &whole));
      continue;
    }
    if (asks && group.law >= 0) { /* servers work while strains of further points are found */
      TEAM_FOR (n, count) run_group(d, region, &group, from + n, purpose, true);
      TEAM_SINGLE points_await(&region->points);
      group.filled = 0;
    }
    if (writes & OF_SHOWN && region->border_count) show_border(region, &group, purpose);
    if (group.by_stripes) {
      TEAM_FOR (n, region->stripe_count)
        for (int64_t b = region->stripe[n]; b < region->stripe[n + 1]; ++b)
          run_group(d, region, &group, b, purpose, false);
      continue;
    }
    Group before = group, after = {.from = group.close, .law = -1, .close = MOST_PHASES, .to = group.to, .ahead = -1};
    const bool in_two = group.close < group.to;
    if (in_two) before.to = group.close;
    const bool torn = group.law >= 0 && d->torn_count && !is_linear(purpose) && !region->type->bond_energy;
    const Later later = in_two ? find_later(d, from, count) : (Later){0};
    Later first = later, second = later;
    TEAM_FOR (n, count) {
      const int64_t b = from + n;
      run_group(d, region, &before, b, purpose, false);
      /* Where bonds have broken, forces wait for what families carry. */
      if (in_two && !torn && !closes_later(d, &first, n)) finish_batch(d, region, &after, b, purpose, writes);
      if (!in_two && writes & OF_FORCES) sum_forces(d, purpose, b);
    }
    if (torn) settle(d, region, &before, purpose);
    if (in_two) {
      TEAM_FOR (n, count)
        if (torn || closes_later(d, &second, n)) finish_batch(d, region, &after, from + n, purpose, writes);
    }
  }
}

static void run_all(Domain *d, const Purpose *purpose)
{
  for (int r = 0; r < d->region_count; ++r) run_region(d, &d->regions[r], purpose);
  if (d->region_count > 1 && !(purpose->without & OF_FORCES)) joint_resist(d, purpose->of);
}

Evaluation domain_present(const Domain *d)
{
  return (Evaluation){.displacement = &d->particles->displacement, .internal = &d->particles->internal};
}

void domain_forces(Domain *d, const Evaluation *of)
{
  TEAM_FOR (b, d->batch_count) d->batch_failed[b] = -1;
  run_all(d, &(Purpose){.of = of});
  TEAM_SINGLE
  {
    if (!of->linearised_at) d->failed_place = -1;
    for (int64_t b = 0; b < d->batch_count && d->failed_place < 0; ++b) d->failed_place = d->batch_failed[b];
  }
  if (of->linearised_at) return;
  forces_resist(&d->forces, of->displacement->row, of->internal->row);
  TEAM_SINGLE
  {
    d->force_sum = 0;
    d->tensors_are_old = d->leaves_tensors;
    for (int64_t b = 0; b < d->batch_count; ++b) d->force_sum += d->batch_sum[b];
    if (forces_stuck(&d->forces, NULL) || *domain_server_problem(d)) d->force_sum = NAN; /* these are no forces */
  }
}

/** A sweep of all regions by the team. */
typedef struct Task {
  Domain *domain;
  Purpose purpose;
} Task;

static void evaluate(void *context)
{
  const Task *task = context;
  domain_forces(task->domain, task->purpose.of);
}

bool domain_has_forces(const Domain *d)
{
  return isfinite(d->force_sum) && d->failed_place < 0;
}

int domain_evaluate(Domain *d, const Evaluation *of)
{
  const Evaluation present = domain_present(d);
  Task task = {d, {.of = of ? of : &present}};
  team_run(evaluate, &task);
  return domain_has_forces(d) ? BRECCIA_OK : BRECCIA_FAILURE;
}

static void sweep_all(void *context)
{
  const Task *task = context;
  const Evaluation *of = task->purpose.of;
  run_all(task->domain, &task->purpose);
  if (!(task->purpose.without & OF_FORCES))
    forces_resist(&task->domain->forces, of->displacement->row, of->internal->row);
}

/** Sweeps at displacements, into the particles' own forces. @param[in] displacement  NULL: those held */
static void sweep_at(Domain *d, const Vector *displacement, Purpose purpose)
{
  Evaluation at = domain_present(d);
  if (displacement) at.displacement = displacement;
  purpose.of = &at;
  team_run(sweep_all, &(Task){d, purpose});
}

void domain_show_states(Domain *d, const Vector *displacement)
{
  d->tensors_are_old |= d->leaves_tensors;
  sweep_at(d, displacement, (Purpose){.no_law = true, .without = OF_SUMS | OF_FORCES});
}

void domain_find_tensors(Domain *d)
{
  sweep_at(d, NULL, (Purpose){.observes = true, .without = OF_STATES | OF_SUMS | OF_FORCES});
  d->tensors_are_old = false;
}

void domain_follow(Domain *d)
{
  domain_follow_strains(d);
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].type->commit) d->regions[r].type->commit(d->regions[r].formulation, false);
  if (domain_is_elastic(d))
    domain_evaluate(d, NULL);
  else if (domain_laws_in_forces(d))
    domain_show_states(d, NULL);
  else
    sweep_at(d, NULL, (Purpose){.no_law = true});
}

/* ---- linearised steps ---- */

bool domain_take_secants(Domain *d, Secants of)
{
  bool any = false;
  for (int r = 0; r < d->region_count; ++r) {
    d->regions[r].points.secants = of;
    any |= d->regions[r].points.components == 1;
  }
  return any;
}

int domain_linearise(Domain *d, const Vector *displacement, Error *error)
{
  const Evaluation at = {.displacement = displacement ? displacement : &d->particles->displacement,
                         .internal = &d->particles->internal};
  d->linearised_at = at.displacement;
  domain_leave_tensors(d, false);
  for (int r = 0; r < d->region_count; ++r)
    if (points_keep_tangents(&d->regions[r].points, true, error)) return BRECCIA_FAILURE;
  domain_evaluate(d, &at);
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    points_keep_tangents(&d->regions[r].points, false, error);
    if (region->type->linearise(region->formulation, at.displacement->row, error)) return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

void domain_linear_step(Domain *d, const Vector *v, const Vector *change)
{
  domain_evaluate(d, &(Evaluation){.displacement = v, .linearised_at = d->linearised_at, .internal = change});
}

/** Displacements, or their changes, and the forces that follow from them. */
typedef struct Rows {
  Domain *domain;
  const Vector *displacement, *internal;
} Rows;

static void change_forces(void *context)
{
  const Rows *s = context;
  forces_change(&s->domain->forces, s->displacement->row, s->internal->row);
}

void domain_change_forces(Domain *d, const Vector *v, const Vector *change)
{
  Rows rows = {d, v, change};
  if (d->forces.count) team_run(change_forces, &rows);
}

static void resist(void *context)
{
  const Rows *s = context;
  forces_resist(&s->domain->forces, s->displacement->row, s->internal->row);
}

void domain_forces_beside(Domain *d, const Vector *displacement, const Vector *forces)
{
  Rows rows = {d, displacement ? displacement : &d->particles->displacement, forces};
  vector_clear(forces);
  team_run(resist, &rows);
}

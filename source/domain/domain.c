#include "domain/domain.h"

#include "base/team.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/** Stresses of a block, and what its particles show their neighbours. */
static void answer(Domain *d, int64_t block, bool resume)
{
  _Alignas(64) double carry[CARRY * BLOCK];
  Span span = d->blocks[block];
  d->type->deform(d->formulation, span.first, span.last, carry);
  if (!resume) d->block_failed[block] = points_update(&d->points, span.first, span.last, NULL);
  d->type->respond(d->formulation, span.first, span.last, carry);
}

/** The same of all blocks, where some have laws in servers: strains go out part by part, so that servers work while further
 *  parts are deformed. */
static void answer_in_parts(Domain *d)
{
  const FormulationType *type = d->type;
  for (int k = 0; k < d->part_count; ++k) {
    const Part *part = &d->parts[k];
    TEAM_FOR (n, part->last - part->first) {
      const int64_t b = part->first + n;
      if (d->part_of[b] != k) continue;
      type->deform(d->formulation, d->blocks[b].first, d->blocks[b].last, d->carry + b * CARRY * BLOCK);
      points_pack(&d->points, d->blocks[b].first, d->blocks[b].last);
    }
    if (team_turn(k)) points_post(&d->points, part->material, part->server);
  }
  TEAM_FOR (b, d->block_count)
    if (d->part_of[b] < 0) answer(d, b, false);
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
      points_unpack(&d->points, d->blocks[b].first, d->blocks[b].last);
      type->respond(d->formulation, d->blocks[b].first, d->blocks[b].last, d->carry + b * CARRY * BLOCK);
    }
  }
}

/** Laws act on bonds, and some run in servers. */
static bool points_on_bonds_in_servers(const Domain *d)
{
  return d->points.server && d->points.where == POINTS_ON_BONDS;
}

void domain_forces(Domain *d)
{
  const FormulationType *type = d->type;
  if (type->show_displacements) {
    TEAM_FOR (b, d->block_count) type->show_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
  }
  const bool parts = d->part_count && !d->points.elastic_stage && points_begun(&d->points);
  if (type->deform) {
    if (parts) answer_in_parts(d);
    TEAM_FOR (b, d->block_count) {
      if (!parts) answer(d, b, false);
      if (type->row_sums && !d->rows_cut) type->sum_states(d->formulation, d->blocks[b].first, d->blocks[b].last);
    }
  }
  if (type->row_sums && d->rows_cut) {
    TEAM_FOR (b, d->block_count) type->sum_states(d->formulation, d->blocks[b].first, d->blocks[b].last);
  }
  if (points_on_bonds_in_servers(d)) {
    TEAM_SINGLE points_gather_bonds(&d->points);
    if (d->points.pass == PASS_GATHER) {
      TEAM_FOR (b, d->block_count) type->resist(d->formulation, d->blocks[b].first, d->blocks[b].last);
      TEAM_SINGLE points_ask_bonds(&d->points);
    }
  }
  TEAM_FOR (b, d->block_count) {
    int64_t failed = type->resist(d->formulation, d->blocks[b].first, d->blocks[b].last);
    if (!type->deform) d->block_failed[b] = failed;
    d->block_sum[b] = force_magnitude(d->particles, &d->blocks[b]);
  }
  if (type->finish) {
    TEAM_SINGLE type->finish(d->formulation);
  }
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
  Domain *d = context;
  TEAM_FOR (b, d->block_count)
    if (d->type->show_displacements) d->type->show_displacements(d->formulation, d->blocks[b].first, d->blocks[b].last);
  TEAM_FOR (b, d->block_count)
    if (d->type->deform) answer(d, b, true);
}

void domain_show_states(Domain *d)
{
  team_run(show_states, d);
}

void domain_resume(Domain *d)
{
  for (int64_t n = 0; n < d->broken_count; ++n) {
    contact_bond_broke(&d->contact, d->particles->place_of[d->broken[n].a], d->particles->place_of[d->broken[n].b]);
    for (int end = 0; end < 2; ++end) {
      int64_t slice = d->particles->place_of[end ? d->broken[n].b : d->broken[n].a] / SLICE;
      lattice_rows_mark(&d->family, slice);
      if (d->type->renew) d->type->renew(d->formulation, slice);
    }
  }
  domain_show_states(d);
  if (d->contact.spec) contact_search(&d->contact);
}

double domain_history(const Domain *d, int64_t place, int k)
{
  if (d->points.where == POINTS_NOWHERE) return 0;
  if (d->points.where == POINTS_ON_BONDS) return points_bond_history(&d->points, place, k);
  const int64_t slice = place / SLICE;
  return d->points
      .committed[d->points.history_start[slice] + place % SLICE * d->materials[d->material[slice]].history_values + k];
}

void domain_look(const Domain *d, int64_t place, double strain[6], double stress[6])
{
  if (d->points.where == POINTS_ON_PARTICLES) {
    for (int k = 0; k < 6; ++k) {
      strain[k] = d->points.strain[k][place];
      stress[k] = d->points.stress[k][place];
    }
    return;
  }
  double f[9];
  d->type->stress(d->formulation, place, stress);
  d->type->gradient(d->formulation, place, f);
  for (int k = 0; k < 6; ++k) {
    int r = symmetric_row[k], s = symmetric_column[k];
    double green = f[r] * f[s] + f[3 + r] * f[3 + s] + f[6 + r] * f[6 + s] - (r == s);
    strain[k] = k < 3 ? green / 2 : green;
  }
}

static void observe(void *context, int64_t n)
{
  Domain *d = context;
  int32_t place = d->particles->place_of[n];
  double strain[6], stress[6];
  domain_look(d, place, strain, stress);
  for (int k = 0; k < 6; ++k) {
    d->points.strain[k][place] = strain[k];
    d->points.stress[k][place] = stress[k];
  }
}

int domain_observe(Domain *d, Error *error)
{
  if (d->points.where == POINTS_ON_PARTICLES) return BRECCIA_OK;
  if (points_show(&d->points, error)) return BRECCIA_FAILURE;
  team_each(d->particles->count, observe, d);
  return BRECCIA_OK;
}

int domain_record(Domain *d, const BrokenBond *bond)
{
  if (d->broken_count == d->broken_capacity) {
    int64_t capacity = d->broken_capacity ? 2 * d->broken_capacity : 256;
    BrokenBond *grown = realloc(d->broken, sizeof(BrokenBond) * (size_t)capacity);
    if (!grown) return BRECCIA_FAILURE;
    d->broken = grown;
    d->broken_capacity = capacity;
  }
  d->broken[d->broken_count++] = *bond;
  return BRECCIA_OK;
}

/** Work that the bond could still have done: half of force times elongation, as of a linear spring. */
static double released_energy(const Domain *d, int64_t slice, int64_t slot, int lane, const Bond *bond)
{
  const Particles *p = d->particles;
  double force[3], y[3], length = 0, along = 0;
  d->type->bond_force(d->formulation, slice, slot, lane, force);
  for (int k = 0; k < 3; ++k) {
    y[k] = bond->xi[k] + p->displacement[k][bond->neighbour] - p->displacement[k][slice * SLICE + lane];
    length += y[k] * y[k];
    along += force[k] * y[k];
  }
  length = sqrt(length);
  return 0.5 * along / length * (length - bond->length) * p->volume[slice * SLICE + lane] * p->volume[bond->neighbour];
}

/** Judges the bonds of the suspect slices in order; @return true if any broke */
static bool judge(Domain *d, int64_t step, double time)
{
  const Family *f = &d->family;
  int64_t before = d->broken_count;
  for (int64_t s = 0; s < d->particles->slices; ++s) {
    if (!d->suspects[s]) continue;
    for (int64_t slot = f->first[s]; slot < f->first[s + 1]; ++slot)
      for (int lane = 0; lane < SLICE; ++lane) {
        if (!(f->intact[slot] >> lane & 1)) continue;
        Bond bond = family_bond(f, s, slot, lane);
        int32_t place = (int32_t)(s * SLICE + lane), a = d->particles->number[place];
        const uint8_t *gave_up = d->points.gave_up;
        if (!(gave_up && gave_up[place]) &&
            !(d->failure.criterion && d->failure.criterion->exceeds(&d->failure, f, s, &bond, lane)))
          continue;
        int32_t b = d->particles->number[bond.neighbour];
        d->fracture_energy += released_energy(d, s, slot, lane, &bond);
        family_break(&d->family, place, bond.neighbour);
        contact_bond_broke(&d->contact, place, bond.neighbour);
        d->suspects[bond.neighbour / SLICE] = 1; /* so that its family is renewed */
        BrokenBond event = {step, time, a < b ? a : b, a < b ? b : a};
        if (domain_record(d, &event)) return true;
      }
  }
  return d->broken_count > before;
}

void domain_break(Domain *d, int64_t step, double time, double motion)
{
  if (d->contact.spec) {
    TEAM_SINGLE contact_follow(&d->contact, motion);
  }
  if (!d->failure.criterion && !d->points.gave_up) return;
  TEAM_SINGLE d->motion += motion;
  TEAM_FOR (b, d->block_count)
    for (int64_t s = d->blocks[b].first; s < d->blocks[b].last; ++s) {
      d->suspects[s] = 0;
      if (d->failure.criterion && d->motion >= d->look_again[s])
        d->look_again[s] = d->motion + d->failure.criterion->suspect(&d->failure, &d->family, s, &d->suspects[s]);
      for (int lane = 0; d->points.gave_up && lane < SLICE; ++lane)
        if (d->points.gave_up[s * SLICE + lane]) d->suspects[s] = 1;
    }
  TEAM_SINGLE
  {
    int any = 0;
    for (int64_t s = 0; s < d->particles->slices; ++s) any |= d->suspects[s];
    if (any && judge(d, step, time))
      for (int64_t s = 0; s < d->particles->slices; ++s)
        if (d->suspects[s] && d->type->renew) d->type->renew(d->formulation, s);
    if (any && d->points.gave_up) memset(d->points.gave_up, 0, (size_t)d->points.places);
  }
}

double domain_damage(const Domain *d, int32_t place)
{
  if (!d->broken_count) return 0;
  double whole = d->family_volume[place];
  return whole > 0 ? fmax(0, 1 - family_volume(&d->family, place) / whole) : 0;
}

size_t domain_particle_bytes(const Domain *d)
{
  size_t places = (size_t)d->particles->places;
  size_t arrays = 15 + 2 + 1 + (d->points.where == POINTS_ON_PARTICLES ? 12 : 0);
  return places * sizeof(double) * arrays + places * sizeof(int32_t) * 2 + 2 * d->points.history_size * sizeof(double);
}

size_t domain_bytes(const Domain *d)
{
  return domain_particle_bytes(d) + family_bytes(&d->family) + d->type->bytes(d->formulation);
}

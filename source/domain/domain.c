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

bool domain_is_elastic(const Domain *d)
{
  for (int k = 0; k < d->material_count; ++k)
    if (!d->materials[k].law->linear) return false;
  return true;
}

static void store_block(void *context, int64_t b)
{
  const Domain *d = context;
  d->block_sum[b] = 0;
  for (int64_t place = d->blocks[b].first * SLICE; place < d->blocks[b].last * SLICE; ++place) {
    StoredEnergy energy;
    if (d->particles->number[place] < 0) continue;
    d->type->stored_energy(d->formulation, place, 0, &energy);
    d->block_sum[b] += energy.stored;
  }
}

double domain_stored_energy(Domain *d)
{
  team_each(d->block_count, store_block, d);
  double sum = 0;
  for (int64_t b = 0; b < d->block_count; ++b) sum += d->block_sum[b]; /* in order */
  return sum;
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

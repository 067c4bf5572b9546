#include "domain/regions.h"

#include "base/team.h"
#include "base/tensor.h"
#include "constitutive/remote/remote.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Of the bonds of a place that are not broken. */
static double mean_history(const Domain *d, const Region *region, int64_t place, int k)
{
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double sum = 0;
  int count = 0;
  for (int64_t slot = d->family.first[slice]; slot < d->family.first[slice + 1]; ++slot)
    if (d->family.intact[slot] >> lane & 1) {
      int64_t rows[2];
      bond_list_rows(&region->bonds, &d->family, slice, slot, lane, rows);
      sum += points_history(&region->points, rows[0])[k];
      ++count;
    }
  return count ? sum / count : 0;
}

double domain_history(const Domain *d, int64_t place, int k)
{
  const Region *region = domain_region(d, place);
  const Material *material = &d->materials[d->material[place / SLICE]];
  if (points_on_particles(&region->points)) return points_history(&region->points, place)[k];
  if (!region->points.components && region->type->history) return region->type->history(region->formulation, place, k);
  const double mean = region->points.components ? mean_history(d, region, place, k) : 0;
  if (!material->law->history_is_damage || !material->law->history_is_damage(material->constants, k)) return mean;
  const double broken = domain_damage(d, (int32_t)place);
  return broken + (1 - broken) * mean;
}

void domain_look(const Domain *d, int64_t place, double strain[6], double stress[6])
{
  const Region *region = domain_region(d, place);
  if (points_on_particles(&region->points)) {
    for (int k = 0; k < 6; ++k) {
      strain[k] = region->points.strain[k][place];
      stress[k] = region->points.stress[k][place];
    }
    return;
  }
  double f[9];
  region->type->stress(region->formulation, place, stress);
  region->type->gradient(region->formulation, place, f);
  const bool small = region->type->takes_small_strain && region->type->takes_small_strain(region->formulation);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], s = symmetric_column[k];
    const double twice = small ? f[3 * r + s] + f[3 * s + r] - 2 * (r == s)
                               : f[r] * f[s] + f[3 + r] * f[3 + s] + f[6 + r] * f[6 + s] - (r == s);
    strain[k] = k < 3 ? twice / 2 : twice;
  }
}

static void observe(void *context, int64_t n)
{
  Domain *d = context;
  int32_t place = d->particles->place_of[n];
  double strain[6], stress[6];
  if (points_on_particles(&domain_region(d, place)->points)) return;
  domain_look(d, place, strain, stress);
  for (int k = 0; k < 6; ++k) {
    d->strain[k][place] = strain[k];
    d->stress[k][place] = stress[k];
  }
}

bool domain_can_leave_tensors(const Domain *d)
{
  const Region *region = &d->regions[0];
  double *strain[6], *stress[6];
  return domain_is_hookean(d, NULL) && d->region_count == 1 && points_on_particles(&region->points) &&
         !region->points.plane_stress && region->type->scratch &&
         region->type->scratch(region->formulation, strain, stress) && !d->failure.criterion && !d->gave_up &&
         !d->is_strained && !d->begins_under_stress && !d->forces.count;
}

void domain_leave_tensors(Domain *d, bool leave)
{
  if (!d->may_leave_tensors || leave == d->leaves_tensors) return;
  Points *points = &d->regions[0].points;
  d->leaves_tensors = leave;
  d->tensors_are_old = true;
  if (leave) {
    memcpy(d->own_strain, points->strain, sizeof d->own_strain);
    memcpy(d->own_stress, points->stress, sizeof d->own_stress);
    d->regions[0].type->scratch(d->regions[0].formulation, points->strain, points->stress);
  } else {
    memcpy(points->strain, d->own_strain, sizeof d->own_strain);
    memcpy(points->stress, d->own_stress, sizeof d->own_stress);
  }
  memcpy(d->strain, points->strain, sizeof d->strain);
  memcpy(d->stress, points->stress, sizeof d->stress);
}

void domain_give_way(Domain *d, bool give)
{
  if (!d->may_leave_tensors) return;
  if (give) {
    domain_leave_tensors(d, false);
    d->regions[0].type->give_way(d->regions[0].formulation);
  } else
    domain_show_states(d, NULL);
}

void domain_stop_observing(Domain *d)
{
  if (d->leaves_tensors && !d->tensors_are_old) domain_show_states(d, NULL);
}

int domain_observe(Domain *d, Error *error)
{
  if (d->region_count == 1 && points_on_particles(&d->regions[0].points)) {
    if (d->tensors_are_old) domain_find_tensors(d);
    return BRECCIA_OK;
  }
  for (int k = 0; k < 6; ++k) {
    if (!d->strain[k]) d->strain[k] = places_array(d->particles->places, "strains", error);
    if (!d->stress[k]) d->stress[k] = places_array(d->particles->places, "stresses", error);
    if (!d->strain[k] || !d->stress[k]) return BRECCIA_FAILURE;
  }
  team_each(d->particles->count, observe, d);
  return BRECCIA_OK;
}

bool domain_is_elastic(const Domain *d)
{
  bool elastic = true;
  for (int r = 0; r < d->region_count; ++r) elastic &= d->regions[r].is_linear;
  return elastic;
}

bool domain_laws_in_forces(const Domain *d)
{
  bool laws = false;
  for (int r = 0; r < d->region_count; ++r) laws |= d->regions[r].points.components != 6 && !d->regions[r].is_linear;
  return laws;
}

bool domain_in_elastic_stage(const Domain *d)
{
  return d->clock.elastic_stage;
}

bool domain_may_soften(const Domain *d)
{
  bool may = false;
  for (int k = 0; k < d->material_count; ++k) may |= d->materials[k].softening_energy > 0;
  return may && !domain_in_elastic_stage(d);
}

bool domain_bonds_may_soften(const Domain *d)
{
  bool may = false;
  for (int r = 0; r < d->region_count; ++r)
    for (int k = 0; k < d->material_count && d->regions[r].points.components == 1; ++k)
      may |= d->materials[k].softening_energy > 0 && region_is_made_of(d, &d->regions[r], d->materials[k].name);
  return may && !domain_in_elastic_stage(d);
}

void domain_set_elastic_stage(Domain *d, bool elastic)
{
  d->clock.elastic_stage = elastic;
}

void domain_mix_tangents(Domain *d, double elastic_weight)
{
  for (int r = 0; r < d->region_count; ++r) d->regions[r].points.elastic_weight = elastic_weight;
  for (int k = 0; k < d->forces.count; ++k)
    if (forces_points(&d->forces, k)) forces_points(&d->forces, k)->elastic_weight = elastic_weight;
}

void domain_tell_time(Domain *d, double time, double time_step)
{
  domain_tell_strains(d, time);
  domain_tell_strength(d, time);
  d->clock.time = time;
  d->clock.time_step = time_step;
}

double domain_step_begin(const Domain *d)
{
  return d->clock.time - d->clock.time_step;
}

void domain_commit_points(Domain *d)
{
  domain_book_strains(d);
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    points_commit(&d->regions[r].points);
    if (region->type->commit) region->type->commit(region->formulation, true);
  }
  forces_accept(&d->forces);
}

/* ---- laws in servers ---- */

static int points_groups(const Domain *d)
{
  return d->region_count + d->forces.count;
}

/** Points of the n-th region, or behind them of a kind of forces; NULL: it has none. */
static Points *points_group(const Domain *d, int n)
{
  return n < d->region_count ? &d->regions[n].points : forces_points(&d->forces, n - d->region_count);
}

int domain_begin_points(Domain *d, Error *error)
{
  int status = BRECCIA_OK;
  for (int n = 0; n < points_groups(d) && !status; ++n)
    if (points_group(d, n)) status = points_begin(points_group(d, n), error);
  return status ? status : forces_begin(&d->forces, error);
}

bool domain_can_save_points(Domain *d)
{
  bool can = true;
  for (int n = 0; n < points_groups(d) && can; ++n)
    if (points_group(d, n)) can = points_can_save(points_group(d, n));
  return can;
}

void domain_report_servers(const Domain *d, double run_seconds, bool json, Text *text)
{
  for (int n = 0; n < points_groups(d); ++n)
    if (points_group(d, n)) points_report(points_group(d, n), run_seconds, json, text);
}

const char *domain_server_problem(const Domain *d)
{
  const char *problem = "";
  for (int n = 0; n < points_groups(d) && !*problem; ++n)
    if (points_group(d, n)) problem = points_problem(points_group(d, n));
  return problem;
}

bool domain_has_servers(const Domain *d)
{
  bool servers = false;
  for (int n = 0; n < points_groups(d); ++n) servers |= points_group(d, n) && points_group(d, n)->servers;
  return servers;
}

const Material *domain_without_trials(const Domain *d)
{
  for (int k = 0; k < d->material_count; ++k)
    if (d->materials[k].remote && !remote_iterates(d->materials[k].remote)) return &d->materials[k];
  return NULL;
}

/* ---- what formulations are like ---- */

const char *domain_flutters(const Domain *d)
{
  const char *why = NULL;
  for (int r = 0; r < d->region_count && !why; ++r)
    if (d->regions[r].type->flutters) why = d->regions[r].type->flutters(d->regions[r].formulation);
  return why;
}

bool domain_may_stiffen(const Domain *d)
{
  bool may = false;
  for (int r = 0; r < d->region_count; ++r) may |= d->regions[r].type->may_stiffen;
  return may;
}

bool domain_lags(const Domain *d)
{
  bool lags = false;
  for (int r = 0; r < d->region_count; ++r)
    lags |= d->regions[r].type->lags && d->regions[r].type->lags(d->regions[r].formulation);
  return lags;
}

double domain_lag_allowed(const Domain *d)
{
  double allowed = INFINITY;
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].type->lag_allowed)
      allowed = fmin(allowed, d->regions[r].type->lag_allowed(d->regions[r].formulation));
  return allowed;
}

bool domain_has_secants(const Domain *d)
{
  bool has = false;
  for (int r = 0; r < d->region_count; ++r)
    has |= d->regions[r].type->takes_secants && d->regions[r].type->takes_secants(d->regions[r].formulation);
  return has;
}

const Material *domain_without_tangents(const Domain *d)
{
  for (int k = 0; k < d->material_count; ++k)
    if (!material_has_tangent(&d->materials[k])) return &d->materials[k];
  return NULL;
}

static void show_held(void *context, int64_t slice)
{
  const Domain *d = context;
  for (int r = 0; r < d->region_count; ++r)
    if (d->regions[r].type->show_held) d->regions[r].type->show_held(d->regions[r].formulation, slice);
}

static void store_batch(void *context, int64_t b)
{
  const Domain *d = context;
  d->batch_sum[b] = 0;
  for (int64_t slice = d->batches[b].first; slice < d->batches[b].last; ++slice) {
    const Region *region = &d->regions[d->region[slice]];
    const double *counted = d->counted + slice * SLICE;
    double energies[SLICE] = {0};
    if (region->type->stored_energies) region->type->stored_energies(region->formulation, slice, energies);
    for (int lane = 0; lane < SLICE; ++lane) {
      StoredEnergy energy = {.stored = energies[lane]};
      if (!(counted[lane] > 0)) continue;
      if (!region->type->stored_energies)
        region->type->stored_energy(region->formulation, slice * SLICE + lane, 0, &energy);
      d->batch_sum[b] += energy.stored;
    }
  }
}

double domain_stored_energy(Domain *d)
{
  bool shows = false;
  for (int r = 0; r < d->region_count; ++r) shows |= d->regions[r].type->show_held != NULL;
  const bool looks = d->tensors_are_old;
  if (looks) domain_find_tensors(d);
  if (shows) team_each(d->particles->slices, show_held, d);
  team_each(d->batch_count, store_batch, d);
  if (looks) domain_stop_observing(d);
  double sum = 0;
  for (int64_t b = 0; b < d->batch_count; ++b) sum += d->batch_sum[b]; /* in order */
  return sum;
}

double domain_damage(const Domain *d, int32_t place)
{
  if (!d->broken_count || !d->family_volume) return 0;
  double whole = d->family_volume[place];
  return whole > 0 ? fmax(0, 1 - family_volume(&d->family, place) / whole) : 0;
}

size_t domain_particle_bytes(const Domain *d)
{
  size_t places = (size_t)d->particles->places;
  size_t history = 0, tensors = 0, bonds = 0;
  for (int r = 0; r < d->region_count; ++r) {
    history += d->regions[r].points.history_size;
    if (points_on_particles(&d->regions[r].points))
      tensors = d->initial_strain[0] ? 18 : d->may_leave_tensors ? 0 : 12;
    else if (points_keep_tensors(&d->regions[r].points))
      bonds += (d->regions[r].initial[0] ? 18 : 12) * (size_t)d->regions[r].points.count;
  }
  const Particles *p = d->particles;
  if (d->strains.given) tensors += 6;
  for (int r = 0; r < d->region_count; ++r)
    for (int k = 0; k < 3; ++k) bonds += d->regions[r].beside[k] ? (size_t)d->regions[r].points.count : 0;
  const size_t own = 3 + 4 * (size_t)p->space.rows + 2 + (p->rotary ? 1 : 0) + (p->orientation[0] ? 4 : 0);
  return places * sizeof(double) * (own + (d->family_volume ? 1 : 0) + tensors) + places * sizeof(int32_t) * 2 +
         (2 * history + bonds) * sizeof(double);
}

size_t domain_bytes(const Domain *d)
{
  size_t bytes = domain_particle_bytes(d) + family_bytes(&d->family);
  if (d->strength) bytes += 2 * sizeof(double) * (size_t)d->particles->places;
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    const size_t rows = (size_t)region->points.count, vectors = region->places.direction[0] ? 6 : 3;
    if (region->row_strength) bytes += rows * sizeof(double);
    if (region->places.position[0]) bytes += rows * (2 * sizeof(int32_t) + vectors * sizeof(double));
  }
  for (int r = 0; r < d->region_count; ++r)
    bytes += points_tangent_bytes(&d->regions[r].points) + bond_list_bytes(&d->regions[r].bonds, &d->family) +
             d->regions[r].type->bytes(d->regions[r].formulation) + window_bytes(d, &d->regions[r]);
  return bytes;
}

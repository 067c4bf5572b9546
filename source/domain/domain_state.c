/* The state of a domain: its rows, and how what follows from them is made again. */
#include "base/memory.h"
#include "domain/domain.h"

#include "base/check.h"
#include "base/tensor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Numbers of a saved broken bond: step, time, both ends, cause, quantity, material, whether value and limit are known,
 *  value and limit. */
enum { NUMBERS_PER_BOND = 11 };

/** What follows from the bonds of both ends of a broken or mended one. */
static void renew_ends(Domain *d, const BrokenBond *bond)
{
  for (int end = 0; end < 2; ++end) {
    const int64_t slice = d->particles->place_of[end ? bond->b : bond->a] / SLICE;
    lattice_rows_mark(&d->family, slice);
    const Region *region = domain_region(d, slice * SLICE);
    if (region->type->renew) region->type->renew(region->formulation, slice);
  }
}

static int64_t save_broken(const void *owner, double **numbers)
{
  const Domain *d = owner;
  double *rows = *numbers = memory_plain((size_t)(NUMBERS_PER_BOND * d->broken_count + 1), sizeof(double));
  if (!rows) return -1;
  for (int64_t n = 0; n < d->broken_count; ++n) {
    const BrokenBond *bond = &d->broken[n];
    const double numbers_of[NUMBERS_PER_BOND] = {(double)bond->step,
                                                 bond->time,
                                                 bond->a,
                                                 bond->b,
                                                 bond->cause,
                                                 bond->quantity,
                                                 bond->material,
                                                 !isnan(bond->value),
                                                 !isnan(bond->limit),
                                                 isnan(bond->value) ? 0 : bond->value,
                                                 isnan(bond->limit) ? 0 : bond->limit};
    memcpy(rows + NUMBERS_PER_BOND * n, numbers_of, sizeof numbers_of);
  }
  return NUMBERS_PER_BOND * d->broken_count;
}

/** Displacements, stresses and intact bits are in place; shapes, deformations and force states follow from them, to the same bits as
 *  in the run that left them. */
static int resume_broken(void *owner, const double *numbers, int64_t count, Error *error)
{
  Domain *d = owner;
  const double particles = (double)d->particles->count;
  if (count % NUMBERS_PER_BOND) return STATE_MISFIT;
  for (int64_t n = 0; n < d->broken_count; ++n) {
    forces_bond_mended(&d->forces, d->particles->place_of[d->broken[n].a], d->particles->place_of[d->broken[n].b]);
    renew_ends(d, &d->broken[n]);
  }
  d->broken_count = 0;
  for (const double *row = numbers; row < numbers + count; row += NUMBERS_PER_BOND) {
    if (!(row[2] >= 0 && row[2] < particles && row[3] >= 0 && row[3] < particles)) return STATE_MISFIT;
    if (!(row[4] >= 0 && row[4] < BREAK_CAUSES && row[6] >= 0 && row[6] < d->material_count)) return STATE_MISFIT;
    const BrokenBond bond = {.step = (int64_t)row[0],
                             .time = row[1],
                             .a = (int32_t)row[2],
                             .b = (int32_t)row[3],
                             .cause = (BreakCause)row[4],
                             .quantity = (int)row[5],
                             .material = (int)row[6],
                             .value = row[7] > 0 ? row[9] : NAN,
                             .limit = row[8] > 0 ? row[10] : NAN};
    if (bond.quantity < 0 || bond.quantity > 1) return STATE_MISFIT;
    if (domain_record(d, &bond)) return error_add(error, BRECCIA_FAILURE, "out of memory: broken bonds");
    forces_bond_broke(&d->forces, d->particles->place_of[bond.a], d->particles->place_of[bond.b]);
    renew_ends(d, &bond);
  }
  CHECK(family_is_valid(&d->family));
  for (int r = 0; r < d->region_count; ++r) CHECK(points_is_valid(&d->regions[r].points));
  memset(d->look_again, 0, sizeof *d->look_again * (size_t)d->particles->slices);
  if (d->strains.loading) loading_forget_strains(d->strains.loading); /* those of bars came back as well */
  domain_show_states(d, NULL);
  forces_find_again(&d->forces);
  return BRECCIA_OK;
}

/** What people see of points on bonds; of several regions also strains and stresses of points on particles. */
static void show_strains(Domain *d, StateList *list)
{
  StateRow row = {.kind = STATE_NUMBERS,
                  .entity = STATE_OF_PLACE,
                  .role = d->region_count > 1 ? STATE_TRIED : STATE_SHOWN,
                  .count = d->particles->places};
  for (int k = 0; k < 6; ++k) {
    row.unit = "1";
    row.values = d->strain[k];
    state_add(list, &row, "strain", component_names[k]);
    row.unit = "stress";
    row.values = d->stress[k];
    state_add(list, &row, "stress", component_names[k]);
  }
}

/** What is put behind the names of rows that each region has. */
static const char *region_part(int number, char *part, size_t size)
{
  snprintf(part, size, "%d", number + 1);
  return number ? part : NULL;
}

void domain_state(Domain *d, StateList *list)
{
  static const StateCare broken = {.save = save_broken, .resume = resume_broken};
  const bool laws_in_forces = domain_laws_in_forces(d);
  particles_state(d->particles, list);
  domain_strains_state(d, list);
  state_add_vector(list, "force", "force per volume", laws_in_forces ? STATE_TRIED : STATE_FOLLOWS,
                   d->particles->internal.row, d->particles->places);
  particles_state_rotations("moment", "stress", laws_in_forces ? STATE_TRIED : STATE_FOLLOWS, &d->particles->internal,
                            list);
  if ((d->region_count > 1 || !points_on_particles(&d->regions[0].points)) && d->strain[0]) show_strains(d, list);
  if (d->gave_up)
    state_add(list,
              &(StateRow){.unit = "1",
                          .kind = STATE_BYTES,
                          .entity = STATE_OF_PLACE,
                          .role = STATE_TRIED,
                          .count = d->particles->places,
                          .values = d->gave_up},
              "failed laws", NULL);
  char part[16];
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    points_state(&d->regions[r].points, region_part(r, part, sizeof part), list);
    if (region->type->state) region->type->state(region->formulation, region_part(r, part, sizeof part), list);
  }
  family_state(&d->family, list);
  state_add_number(list, "motion", "length", STATE_TRIED, &d->motion);
  state_add_number(list, "fracture energy", "energy", STATE_TRIED, &d->fracture_energy);
  state_add_number(list, "energy shed by bonds", "energy", STATE_TRIED, &d->shed_energy);
  for (int r = 0; r < d->region_count; ++r) {
    const Region *region = &d->regions[r];
    if (!region->type->shares) continue;
    state_add(list,
              &(StateRow){.unit = "1",
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_PLACE,
                          .role = STATE_COMMITTED,
                          .count = d->particles->places,
                          .values = region->type->shares(region->formulation)},
              "share", region_part(r, part, sizeof part));
  }
  state_add(list, &(StateRow){.unit = "1", .role = STATE_COMMITTED, .care = &broken, .owner = d}, "broken bonds", NULL);
  forces_state(&d->forces, list);
}

int domain_keep_stresses(Domain *d, bool keep, Error *error)
{
  int status = BRECCIA_OK;
  if (!keep && d->region_count) domain_put_stresses_back(d);
  for (int r = 0; r < d->region_count && !status; ++r)
    status = points_keep_stresses(&d->regions[r].points, keep, error);
  return status;
}

static void show_stresses(Domain *d)
{
  const Points *points = &d->regions[0].points;
  for (int k = 0; k < 6 && points_on_particles(points); ++k) d->stress[k] = points->stress[k];
}

void domain_put_stresses_by(Domain *d)
{
  Points *points = &d->regions[0].points; /* those of several regions are one set of arrays, and are noted */
  if (!points->stress_before[0]) return;
  points_put_by(points);
  show_stresses(d);
}

void domain_put_stresses_back(Domain *d)
{
  Points *points = &d->regions[0].points;
  if (!points_on_particles(points)) return;
  points_put_back(points);
  show_stresses(d);
}

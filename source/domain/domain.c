#include "domain/domain.h"

#include "base/team.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
  return points_are_linear(&d->points);
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

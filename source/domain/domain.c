#include "domain/domain.h"

#include "base/team.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

double domain_history(const Domain *d, int64_t place, int k)
{
  if (!d->points.components) return 0;
  if (d->points.components == 6) return points_history(&d->points, place)[k];
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double sum = 0;
  int count = 0;
  for (int64_t slot = d->family.first[slice]; slot < d->family.first[slice + 1]; ++slot)
    if (d->family.intact[slot] >> lane & 1) {
      int64_t rows[2];
      bond_list_rows(&d->bonds, &d->family, slice, slot, lane, rows);
      sum += points_history(&d->points, rows[0])[k];
      ++count;
    }
  return count ? sum / count : 0;
}

void domain_look(const Domain *d, int64_t place, double strain[6], double stress[6])
{
  if (d->points.components == 6) {
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
    d->strain[k][place] = strain[k];
    d->stress[k][place] = stress[k];
  }
}

int domain_observe(Domain *d, Error *error)
{
  if (d->points.components == 6) return BRECCIA_OK;
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
  size_t arrays = 15 + 2 + 1 + (d->points.components == 6 ? 12 : 0);
  return places * sizeof(double) * arrays + places * sizeof(int32_t) * 2 + 2 * d->points.history_size * sizeof(double);
}

size_t domain_bytes(const Domain *d)
{
  return domain_particle_bytes(d) + family_bytes(&d->family) + bond_list_bytes(&d->bonds, &d->family) +
         d->type->bytes(d->formulation);
}

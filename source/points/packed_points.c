#include "points/packed_points.h"

#include "base/tensor.h"

#include <string.h>

bool packed_points_take(const Material *m)
{
  return !m->remote && !m->law->takes_places && m->history_values <= PACKED_VALUES;
}

void packed_points_pack(PackedPoints *packed, const Material *m, const breccia_batch *from, bool is_packed,
                        const int *chosen, int count)
{
  const size_t values = (size_t)m->history_values;
  for (int j = 0; j < count; ++j) {
    const int i = chosen[j];
    if (is_packed && i == j) continue;
    packed->of[j] = is_packed ? packed->of[i] : i;
    for (int k = 0; k < 6; ++k) packed->strain[k][j] = from->strain[k][i];
    if (from->length) packed->length[j] = from->length[i];
    memmove(packed->committed + values * (size_t)j, from->committed + values * (size_t)i, sizeof(double) * values);
    memmove(packed->trial + values * (size_t)j, from->trial + values * (size_t)i, sizeof(double) * values);
  }
}

breccia_batch packed_points_batch(PackedPoints *packed, const breccia_batch *whole, int count)
{
  breccia_batch batch = *whole;
  batch.count = count;
  batch.committed = packed->committed;
  batch.trial = packed->trial;
  if (whole->tangent) batch.tangent = packed->tangent;
  batch.length = whole->length ? packed->length : NULL;
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = packed->strain[k];
    batch.stress[k] = packed->stress[k];
  }
  return batch;
}

void packed_points_give_back(const PackedPoints *packed, const Material *m, int j, const breccia_batch *whole,
                             double *strain_zz)
{
  const int i = packed->of[j];
  const size_t values = (size_t)m->history_values;
  strain_zz[i] = packed->strain[ZZ][j];
  for (int k = 0; k < 6; ++k) whole->stress[k][i] = packed->stress[k][j];
  memcpy(whole->trial + values * (size_t)i, packed->trial + values * (size_t)j, sizeof(double) * values);
  if (whole->tangent) memcpy(whole->tangent + 36 * i, packed->tangent + 36 * j, sizeof(double) * 36);
}

#include "domain/tensor_copy.h"

#include "base/memory.h"
#include <stdlib.h>
#include <string.h>

/** Returns true if the points of a region share their arrays with those of a region before it. */
static bool tensor_copy_is_shared(const Domain *d, int region)
{
  const Points *points = &d->regions[region].points;
  for (int r = 0; r < region; ++r)
    if (d->regions[r].points.strain[0] == points->strain[0]) return true;
  return false;
}

int tensor_copy_create(TensorCopy *copy, const Domain *d, const char *label, Error *error)
{
  bool failed = false;
  *copy = (TensorCopy){.regions = memory_zeroed((size_t)d->region_count, sizeof *copy->regions, label, error),
                       .region_count = d->region_count};
  if (!copy->regions) return BRECCIA_FAILURE;
  for (int r = 0; r < d->region_count; ++r) {
    TensorRows *rows = &copy->regions[r];
    const Points *points = &d->regions[r].points;
    if (!points_keep_tensors(points) || d->leaves_tensors || tensor_copy_is_shared(d, r)) continue;
    rows->count = points->on_bonds ? points->count : d->particles->places;
    for (int k = 0; k < 6; ++k) {
      failed |= !(rows->strain[k] = places_reserved(rows->count, label, error));
      failed |= !(rows->stress[k] = places_reserved(rows->count, label, error));
    }
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void tensor_copy_destroy(TensorCopy *copy)
{
  for (int r = 0; r < copy->region_count && copy->regions; ++r)
    for (int k = 0; k < 6; ++k) {
      places_free(&copy->regions[r].strain[k]);
      places_free(&copy->regions[r].stress[k]);
    }
  free(copy->regions);
  *copy = (TensorCopy){.region_count = 0};
}

size_t tensor_copy_bytes(const TensorCopy *copy)
{
  int64_t numbers = 0;
  for (int r = 0; r < copy->region_count; ++r) numbers += 12 * copy->regions[r].count;
  return (size_t)numbers * sizeof(double);
}

void tensor_copy_save(const TensorCopy *copy, const Domain *d)
{
  for (int r = 0; r < copy->region_count; ++r) {
    const TensorRows *rows = &copy->regions[r];
    const size_t bytes = sizeof(double) * (size_t)rows->count;
    for (int k = 0; k < 6 && rows->count; ++k) {
      memcpy(rows->strain[k], d->regions[r].points.strain[k], bytes);
      memcpy(rows->stress[k], d->regions[r].points.stress[k], bytes);
    }
  }
}

void tensor_copy_restore(const TensorCopy *copy, const Domain *d)
{
  for (int r = 0; r < copy->region_count; ++r) {
    const TensorRows *rows = &copy->regions[r];
    const size_t bytes = sizeof(double) * (size_t)rows->count;
    for (int k = 0; k < 6 && rows->count; ++k) {
      memcpy(d->regions[r].points.strain[k], rows->strain[k], bytes);
      memcpy(d->regions[r].points.stress[k], rows->stress[k], bytes);
    }
  }
}

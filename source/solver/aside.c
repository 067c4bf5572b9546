#include "solver/aside.h"

#include "base/memory.h"
#include <stdlib.h>

/** Rows of the arrays of a region's points. */
static int64_t rows_of(const Points *points, int64_t places)
{
  return points->on_bonds || points->count > places ? points->count : places;
}

int aside_create(Aside *a, const Domain *d, const char *label, Error *error)
{
  const int64_t places = d->particles->places;
  bool failed = false;
  *a = (Aside){.tensors = memory_zeroed((size_t)d->region_count, sizeof *a->tensors, label, error),
               .region_count = d->region_count};
  for (int k = 0; k < d->particles->motions; ++k) {
    failed |= !(a->displacement[k] = places_reserved(places, label, error));
    failed |= !(a->internal[k] = places_reserved(places, label, error));
  }
  if (!a->tensors || failed) return BRECCIA_FAILURE;
  for (int r = 0; r < d->region_count; ++r) {
    AsideTensors *t = &a->tensors[r];
    const Points *points = &d->regions[r].points;
    if (!points_keep_tensors(points) || d->leaves_tensors) continue;
    const int64_t rows = rows_of(points, places);
    while (d->regions[t->shares].points.strain[0] != points->strain[0]) ++t->shares;
    for (int k = 0; k < 6 && t->shares == r; ++k) {
      failed |= !(t->strain[k] = places_array(rows, label, error));
      failed |= !(t->stress[k] = places_array(rows, label, error));
    }
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

size_t aside_bytes(const Aside *a, const Domain *d)
{
  const int64_t places = d->particles->places;
  int64_t rows = a->tensors ? 2 * d->particles->motions * places : 0;
  for (int r = 0; r < a->region_count; ++r)
    if (a->tensors[r].strain[0]) rows += 12 * rows_of(&d->regions[r].points, places);
  return (size_t)rows * sizeof(double);
}

void aside_destroy(Aside *a)
{
  for (int k = 0; k < MOTIONS; ++k) {
    places_free(&a->displacement[k]);
    places_free(&a->internal[k]);
  }
  for (int r = 0; r < a->region_count && a->tensors; ++r)
    for (int k = 0; k < 6; ++k) {
      places_free(&a->tensors[r].strain[k]);
      places_free(&a->tensors[r].stress[k]);
    }
  free(a->tensors);
  a->tensors = NULL;
}

static void swap(double **a, double **b)
{
  double *c = *a;
  *a = *b;
  *b = c;
}

void aside_exchange(Aside *a, Domain *d)
{
  for (int k = 0; k < d->particles->motions; ++k) {
    swap(&d->particles->displacement[k], &a->displacement[k]);
    swap(&d->particles->internal[k], &a->internal[k]);
  }
  for (int r = 0; r < d->region_count; ++r) {
    AsideTensors *t = &a->tensors[r];
    Points *points = &d->regions[r].points, *first = &d->regions[t->shares].points;
    for (int k = 0; k < 6 && a->tensors[t->shares].strain[5] && points_keep_tensors(points); ++k) {
      if (t->shares == r) {
        swap(&points->strain[k], &t->strain[k]);
        swap(&points->stress[k], &t->stress[k]);
      } else {
        points->strain[k] = first->strain[k];
        points->stress[k] = first->stress[k];
      }
    }
  }
}

#include "solver/aside.h"

int aside_create(Aside *a, const Domain *d, const char *label, Error *error)
{
  const int64_t places = d->particles->places;
  int64_t rows = 0;
  bool failed = false;
  *a = (Aside){0};
  for (int k = 0; k < 3; ++k) {
    failed |= !(a->displacement[k] = places_array(places, label, error));
    failed |= !(a->internal[k] = places_array(places, label, error));
  }
  for (int r = 0; r < d->region_count;
       ++r) /* points with tensors: one set for all of them, as several regions share theirs */
    if (d->regions[r].points.components == 6 && d->regions[r].points.count > rows) rows = d->regions[r].points.count;
  if (rows && rows < places) rows = places;
  for (int k = 0; k < 6 && rows; ++k) {
    failed |= !(a->strain[k] = places_array(rows, label, error));
    failed |= !(a->stress[k] = places_array(rows, label, error));
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void aside_destroy(Aside *a)
{
  for (int k = 0; k < 3; ++k) {
    places_free(&a->displacement[k]);
    places_free(&a->internal[k]);
  }
  for (int k = 0; k < 6; ++k) {
    places_free(&a->strain[k]);
    places_free(&a->stress[k]);
  }
}

static void swap(double **a, double **b)
{
  double *c = *a;
  *a = *b;
  *b = c;
}

void aside_exchange(Aside *a, Domain *d)
{
  for (int k = 0; k < 3; ++k) {
    swap(&d->particles->displacement[k], &a->displacement[k]);
    swap(&d->particles->internal[k], &a->internal[k]);
  }
  for (int k = 0; k < 6; ++k) {
    double *strain = NULL, *stress = NULL; /* regions with points on particles share theirs */
    for (int r = 0; r < d->region_count; ++r) {
      Points *points = &d->regions[r].points;
      if (points->components != 6) continue;
      strain = points->strain[k];
      stress = points->stress[k];
      points->strain[k] = a->strain[k];
      points->stress[k] = a->stress[k];
    }
    a->strain[k] = strain;
    a->stress[k] = stress;
  }
}

#include "constitutive/points.h"

#include "base/tensor.h"
#include <stdlib.h>
#include <string.h>

int points_create(Points *points, int64_t slices, Space space, const Material *materials, const int32_t *material,
                  bool kept, Error *error)
{
  *points =
      (Points){.places = slices * SLICE, .kept = kept, .space = space, .materials = materials, .material = material};
  points->history_start = memory_zeroed((size_t)slices, sizeof(int64_t), "history rows", error);
  if (!points->history_start) return BRECCIA_FAILURE;
  int64_t total = 0;
  for (int64_t s = 0; s < slices && kept; ++s) {
    points->history_start[s] = total;
    total += SLICE * materials[material[s]].history_values;
  }
  points->history_size = (size_t)total;
  points->committed = memory_zeroed((size_t)total, sizeof(double), "histories", error);
  points->trial = memory_zeroed((size_t)total, sizeof(double), "histories", error);
  int failed = !points->committed || !points->trial;
  for (int k = 0; k < 6; ++k) {
    failed |= !(points->strain[k] = places_array(points->places, "strains", error));
    failed |= !(points->stress[k] = places_array(points->places, "stresses", error));
  }
  if (failed) return BRECCIA_FAILURE;
  for (int64_t s = 0; s < slices; ++s) {
    const Material *m = &materials[material[s]];
    for (int lane = 0; kept && m->law->begin && lane < SLICE; ++lane)
      m->law->begin(m->constants, points->committed + points->history_start[s] + lane * m->history_values);
  }
  if (total) memcpy(points->trial, points->committed, sizeof(double) * (size_t)total);
  return BRECCIA_OK;
}

void points_destroy(Points *points)
{
  for (int k = 0; k < 6; ++k) {
    places_free(&points->strain[k]);
    places_free(&points->stress[k]);
  }
  free(points->committed);
  free(points->trial);
  free(points->history_start);
  *points = (Points){0};
}

void points_commit(Points *points)
{
  double *trial = points->trial;
  points->trial = points->committed;
  points->committed = trial;
}

/** Strain zz by Newton's method with the law's own tangent, for all points of a batch at once. */
static int plane_stress(const Material *m, breccia_batch *batch, double *strain_zz, double *tangent)
{
  enum { MOST_ITERATIONS = 50 };
  double local[BLOCK * 36];
  batch->tangent = tangent ? tangent : local;
  for (int iteration = 0;; ++iteration) {
    int bad = m->law->update(m->constants, batch);
    if (bad >= 0) return bad;
    int worst = -1;
    for (int i = 0; i < batch->count; ++i) {
      double scale = 0, zz = batch->stress[ZZ][i], stiffness = batch->tangent[36 * i + 7 * ZZ];
      for (int k = 0; k < 6; ++k) scale += fabs(batch->stress[k][i]);
      if (fabs(zz) <= 1e-12 * (scale + fabs(stiffness * strain_zz[i]))) continue;
      if (!(stiffness > 0)) return i;
      strain_zz[i] -= zz / stiffness;
      worst = i;
    }
    if (worst < 0) break;
    if (iteration == MOST_ITERATIONS) return worst;
  }
  for (int i = 0; tangent && i < batch->count; ++i) {
    double *d = tangent + 36 * i;
    double column[6], row[6], pivot = d[7 * ZZ];
    for (int k = 0; k < 6; ++k) {
      column[k] = d[6 * k + ZZ];
      row[k] = d[6 * ZZ + k];
    }
    for (int r = 0; r < 6; ++r)
      for (int k = 0; k < 6; ++k) d[6 * r + k] = r == ZZ || k == ZZ ? 0 : d[6 * r + k] - column[r] * row[k] / pivot;
  }
  return -1;
}

int64_t points_update(Points *points, int64_t first, int64_t last, double *tangent)
{
  if (!points->kept) return -1;
  const Material *m = &points->materials[points->material[first]];
  int64_t place = first * SLICE;
  breccia_batch batch = {
      .count = (int)((last - first) * SLICE),
      .committed = points->committed + points->history_start[first],
      .trial = points->trial + points->history_start[first],
      .tangent = tangent,
      .elastic_stage = points->elastic_stage,
  };
  for (int k = 0; k < 6; ++k) {
    batch.strain[k] = points->strain[k] + place;
    batch.stress[k] = points->stress[k] + place;
  }
  int bad = points->space == SPACE_PLANE_STRESS ? plane_stress(m, &batch, points->strain[ZZ] + place, tangent)
                                                : m->law->update(m->constants, &batch);
  return bad < 0 ? -1 : place + bad;
}

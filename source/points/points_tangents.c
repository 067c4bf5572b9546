/* How stresses of points change with strains: tangents as laws tell them, or secants in their place. */
#include "points/points_parts.h"

#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- secants ---- */

/** Stress of a point after a small step back, over what the first moduli would take off it: the share of them with which it unloads.
 *  @param[in] strain, stress  after an update, whose trial history is where it unloads from */
static double unloading_share(const Points *points, int64_t row, const double strain[6], const double stress[6])
{
  const double step = 1e-3; /* of the elastic strain */
  const Material *m = points_material(points, row);
  const double mean = (stress[XX] + stress[YY] + stress[ZZ]) / 3;
  double back[6], after[6], scratch[MOST_TRIED_VALUES], square = 0, fall = 0, *at[6], *to[6];
  for (int k = 0; k < 6; ++k) {
    const double deviator = k < 3 ? stress[k] - mean : stress[k];
    at[k] = &back[k];
    to[k] = &after[k];
    back[k] = strain[k] - step * (deviator / m->shear * (k < 3 ? 0.5 : 1) + (k < 3 ? mean / (3 * m->bulk) : 0));
  }
  breccia_batch batch;
  points_make_batch(&batch, points, row, 1, at, to);
  batch.committed = batch.trial;
  batch.trial = scratch;
  batch.tangent = NULL;
  memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
  if (points_ask_law(points, m, &batch, row, NULL) >= 0) return 0;
  for (int k = 0; k < 6; ++k) {
    square += stress[k] * stress[k] * (k < 3 ? 1 : 2);
    fall += stress[k] * (stress[k] - after[k]) * (k < 3 ? 1 : 2);
  }
  return square > 0 ? fall / (step * square) : 0;
}

void points_take_secants(const Points *points, int64_t first, int count, double *const strain[6],
                         double *const stress[6])
{
  const double least = 1e-4; /* a torn point must not leave its place without any stiffness */
  const int64_t run = points_run(points, first);
  const Material *m = points_material(points, first);
  double *kept = points_kept_tangent(points, run, first);
  if (!kept || !(m->softening_energy > 0) || points->clock->elastic_stage) return;
  const double *elastic = points->elastic_tangent + 36 * points->runs[run].material;
  for (int i = 0; i < count; ++i) {
    double trace = 0, product = 0, elastically = 0, at[6], is[6];
    for (int k = 0; k < 6; ++k) {
      at[k] = strain[k][i];
      is[k] = stress[k][i];
      trace += k < 3 ? at[k] : 0;
      product += at[k] * is[k];
      elastically += m->shear * (k < 3 ? 2 : 1) * at[k] * at[k];
    }
    elastically += (m->bulk - 2 * m->shear / 3) * trace * trace;
    double share = elastically > 0 ? product / elastically : 1;
    if (share < 1 && !m->remote && m->history_values <= MOST_TRIED_VALUES)
      share = fmax(share, unloading_share(points, first + i, at, is));
    share = fmin(1, fmax(least, share));
    for (int k = 0; k < 36; ++k) kept[36 * i + k] = share * elastic[k];
  }
}

/* ---- tangents ---- */

/** The tangent that all points of a linear law have. */
static void find_linear_tangent(const Points *points, const Material *m, double *tangent)
{
  double strain[6] = {0}, stress[6], *at[6], *to[6];
  for (int k = 0; k < 6; ++k) {
    at[k] = &strain[k];
    to[k] = &stress[k];
  }
  breccia_batch one = {.size = sizeof one, .count = 1, .tangent = tangent};
  memcpy(one.strain, at, sizeof at);
  memcpy(one.stress, to, sizeof to);
  if (points->plane_stress)
    plane_stress_update(m, &one, at[ZZ]);
  else
    material_update(m, &one);
}

/** The tangent by the first moduli. */
static void find_elastic_tangent(const Points *points, const Material *m, double *tangent)
{
  const double lame = m->bulk - 2 * m->shear / 3,
               across = points->plane_stress ? lame * lame / (lame + 2 * m->shear) : 0;
  const int axes = points->plane_stress ? 2 : 3;
  for (int r = 0; r < axes; ++r)
    for (int k = 0; k < axes; ++k) tangent[6 * r + k] = lame - across + (r == k ? 2 * m->shear : 0);
  for (int k = 3; k < 6; ++k) tangent[7 * k] = m->shear;
}

static int make_tangents(Points *points, Error *error)
{
  int64_t rows = 0;
  free(points->tangent_first); /* of a call that got no memory for the rest */
  free(points->elastic_tangent);
  points->tangent_first = memory_zeroed((size_t)points->run_count, sizeof(int64_t), "tangents", error);
  points->elastic_tangent = memory_zeroed((size_t)points->material_count, 36 * sizeof(double), "tangents", error);
  if (!points->tangent_first || !points->elastic_tangent) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < points->run_count; ++n) {
    const bool linear = points->materials[points->runs[n].material].law->linear;
    points->tangent_first[n] = linear ? -1 : rows;
    if (!linear) rows += points->runs[n].count;
  }
  for (int k = 0; k < points->material_count; ++k) {
    const Material *m = &points->materials[k];
    if (m->law->components == 6)
      (m->law->linear ? find_linear_tangent : find_elastic_tangent)(points, m, points->elastic_tangent + 36 * k);
  }
  points->tangent = memory_zeroed((size_t)rows, 36 * sizeof(double), "tangents", error);
  return points->tangent ? BRECCIA_OK : BRECCIA_FAILURE;
}

int points_keep_tangents(Points *points, bool keep, Error *error)
{
  if (points->components != 6) return BRECCIA_OK;
  if (!points->tangent && make_tangents(points, error)) return BRECCIA_FAILURE;
  points->keeps_tangents = keep;
  return BRECCIA_OK;
}

size_t points_tangent_bytes(const Points *points)
{
  size_t rows = 0;
  for (int64_t n = 0; points->tangent && n < points->run_count; ++n)
    if (points->tangent_first[n] >= 0) rows += (size_t)points->runs[n].count;
  return rows * 36 * sizeof(double);
}

void points_tangent(const Points *points, int64_t row, double *tangent)
{
  const int64_t n = points_run(points, row);
  const double *kept = points->tangent ? points_kept_tangent(points, n, row) : NULL;
  const double *elastic = points->tangent ? points->elastic_tangent + 36 * points->runs[n].material : NULL;
  const double w = kept ? points->elastic_weight : 1;
  for (int k = 0; k < 36; ++k) tangent[k] = (kept ? (1 - w) * kept[k] : 0) + (elastic && w > 0 ? w * elastic[k] : 0);
}

/** Point after point within each sum of products, so that several points are worked on at once. */
BRECCIA_CLONES
static void change_linear(const double d[36], int count, double *const strain[6], double *const stress[6])
{
  for (int r = 0; r < 6; ++r) {
    double *restrict to = stress[r];
    for (int i = 0; i < count; ++i) to[i] = d[6 * r] * strain[0][i];
    for (int k = 1; k < 6; ++k)
      for (int i = 0; i < count && d[6 * r + k] != 0; ++i) to[i] += d[6 * r + k] * strain[k][i];
  }
}

void points_change(const Points *points, int64_t first, int count, double *const strain[6], double *const stress[6])
{
  const int64_t n = points_run(points, first);
  const double *kept = points_kept_tangent(points, n, first), w = points->elastic_weight;
  const double *elastic = points->elastic_tangent + 36 * points->runs[n].material;
  if (!kept) {
    change_linear(elastic, count, strain, stress);
    return;
  }
  for (int i = 0; i < count; ++i) {
    const double *d = kept + 36 * i;
    for (int r = 0; r < 6; ++r) {
      double sum = 0, elastically = 0;
      for (int k = 0; k < 6; ++k) sum += d[6 * r + k] * strain[k][i];
      for (int k = 0; w > 0 && k < 6; ++k) elastically += elastic[6 * r + k] * strain[k][i];
      stress[r][i] = w > 0 ? (1 - w) * sum + w * elastically : sum;
    }
  }
}

/* Points asked without a trace: what they would answer to other strains, and what they would give back. */
#include "points/points_parts.h"

#include "base/tensor.h"
#include <math.h>
#include <string.h>

/** Stress of a point of one strain, from a history; one that gives up carries nothing and keeps its history.
 *  @param[out] to  [MOST_TRIED_VALUES] the history that follows */
static double stress_from(const Points *points, int64_t row, const double *from, double strain, double lateral,
                          double *to, double *tangent)
{
  const Material *m = points_material(points, row);
  double stress = NAN, *const at[2] = {&strain, &lateral}, *const out[1] = {&stress};
  breccia_batch batch;
  points_make_batch(&batch, points, row, 1, at, out);
  batch.committed = from;
  batch.trial = to;
  batch.tangent = tangent;
  memcpy(to, from, sizeof(double) * (size_t)m->history_values);
  if (points_ask_law(points, m, &batch, row, NULL) < 0) return stress;
  memcpy(to, from, sizeof(double) * (size_t)m->history_values);
  if (tangent) *tangent = 0;
  return 0;
}

double points_mixed_slope(const Points *points, int64_t row, double strain, double stress, double slope)
{
  const double weight = points->elastic_weight;
  if (points->secants != SECANTS_OF_NONE && slope < 0 && strain * stress > 0) slope = stress / strain;
  return weight > 0 ? (1 - weight) * slope + weight * material_young(points_material(points, row)) : slope;
}

double points_try(const Points *points, int64_t row, double strain, double lateral, double *tangent)
{
  const Material *m = points_material(points, row);
  const double *history = points_history(points, row);
  double scratch[MOST_TRIED_VALUES], stress = NAN;
  strain = points_whole_strain(points, row, XX, strain);
  if (m->remote) {
    stress = point_servers_last_stress(history);
    if (tangent) *tangent = strain != 0 ? stress / strain : material_young(m);
  } else if (m->history_values <= MOST_TRIED_VALUES) {
    stress = stress_from(points, row, history, strain, lateral, scratch, tangent);
  }
  if (tangent) *tangent = points_mixed_slope(points, row, strain, stress, *tangent);
  return stress;
}

int64_t points_ask_slopes(Points *points, int64_t first, int count, double *strain, double *stress, double *slope)
{
  const Material *m = points_material(points, first);
  breccia_batch batch;
  double *const at[2] = {strain, NULL}; /* laws in servers do not receive the pressure across bonds */
  points_make_batch(&batch, points, first, count, at, &stress);
  batch.tangent = slope;
  const int bad = points_ask_law(points, m, &batch, first, NULL);
  return bad < 0 ? -1 : first + bad;
}

bool points_try_stress(const Points *points, int64_t row, const double strain[6], double stress[6])
{
  const Material *m = points_material(points, row);
  double whole[6], scratch[MOST_TRIED_VALUES], *at[6], *to[6];
  if (m->remote || m->history_values > MOST_TRIED_VALUES) return false;
  for (int k = 0; k < 6; ++k) {
    whole[k] = points_whole_strain(points, row, k, strain[k]);
    at[k] = &whole[k];
    to[k] = &stress[k];
  }
  breccia_batch batch;
  points_make_batch(&batch, points, row, 1, at, to);
  batch.trial = scratch;
  batch.tangent = NULL;
  if (m->history_values) memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
  return points_update_batch(points, m, &batch, row, at) < 0;
}

double points_energy_at(const Material *m, const double stress[6])
{
  const double mean = (stress[XX] + stress[YY] + stress[ZZ]) / 3;
  double density = mean * mean / (2 * m->bulk);
  for (int k = 0; k < 6; ++k) {
    const double deviator = stress[k] - (k < 3 ? mean : 0);
    density += deviator * deviator / (m->shear * (k < 3 ? 4 : 2));
  }
  return density;
}

double points_elastic_energy(const Points *points, int64_t row)
{
  double stress[6];
  for (int k = 0; k < 6; ++k) stress[k] = points->stress[k][row];
  return points_energy_at(points_material(points, row), stress);
}

double points_softness(const Points *points, int64_t row)
{
  const Material *m = points_material(points, row);
  if (m->remote || m->law->linear || m->history_values > MOST_TRIED_VALUES) return 1;
  double strain[6], before[6], after[6], scratch[MOST_TRIED_VALUES], square = 0, mean = 0, stiffest = 0;
  double *at[6], *to[6];
  for (int k = 0; k < 6; ++k) {
    at[k] = &strain[k];
    to[k] = &after[k];
    before[k] = points->stress[k][row];
    square += before[k] * before[k] * (k < 3 ? 1 : 2);
  }
  for (int k = 0; k < 3; ++k) mean += before[k] / 3;
  breccia_batch batch;
  points_make_batch(&batch, points, row, 1, at, to);
  batch.trial = scratch;
  batch.tangent = NULL;
  /* A small step back and one ahead, elastically: damage is felt both ways, yielding one way. */
  for (int side = -1; side <= 1; side += 2) {
    const double step = side * 1e-3;
    double product = 0;
    for (int k = 0; k < 6; ++k) {
      const double deviator = k < 3 ? before[k] - mean : before[k];
      strain[k] = points_whole_strain(points, row, k, points->strain[k][row]) +
                  step * (deviator / m->shear * (k < 3 ? 0.5 : 1) + (k < 3 ? mean / (3 * m->bulk) : 0));
    }
    if (m->history_values) memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
    if (points_ask_law(points, m, &batch, row, NULL) >= 0) continue;
    for (int k = 0; k < 6; ++k) product += before[k] * (after[k] - before[k]) * (k < 3 ? 1 : 2);
    if (square > 0) stiffest = fmax(stiffest, product / (step * square));
  }
  return stiffest > 0 ? 1 / fmin(1, stiffest) : 1;
}

double points_elastic_strain(const Points *points, int64_t row, double strain, double lateral, double from)
{
  const Material *m = points_material(points, row);
  if (m->remote || m->history_values > MOST_TRIED_VALUES)
    return points_try(points, row, strain, lateral, NULL) == 0 ? 0
                                                               : points_whole_strain(points, row, XX, strain) - from;
  strain = points_whole_strain(points, row, XX, strain);
  /* Unloaded from where the strain has led: from the history before it a law that flows would only flow less. */
  double here[MOST_TRIED_VALUES], scratch[MOST_TRIED_VALUES];
  const double stress = stress_from(points, row, points_history(points, row), strain, lateral, here, NULL);
  if (stress == 0) return 0;
  /* Steel that has yielded and is pushed back carries against its strain: that gives nothing of the way to unload. */
  const double strained = strain - from;
  const bool along = stress * strained > 0;
  const double back = 1e-3, step = along ? back * strained : back * stress / material_young(m);
  const double drop = stress - stress_from(points, row, here, strain - step, lateral, scratch, NULL);
  const double share = drop != 0 ? back * stress / drop : 0;
  /* No more than the strain, or what the first modulus makes of a stress against which plastic strain stays. */
  const double most = along ? fmax(1, stress / (material_young(m) * strained)) : 1;
  if (along) return (share > 0 ? fmin(most, share) : 1) * strained;
  return share > 0 ? share * step / back : 0;
}

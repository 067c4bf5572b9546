/* Plane stress of any law of points in space: the strain across the plane is found such that the stress there vanishes. */
#include "base/tensor.h"
#include "points/points_parts.h"

#include <math.h>
#include <string.h>

breccia_batch batch_part(const breccia_batch *whole, const Material *m, int components, int first, int count)
{
  breccia_batch part = *whole;
  part.count = count;
  part.committed += (ptrdiff_t)m->history_values * first;
  part.trial += (ptrdiff_t)m->history_values * first;
  for (int k = 0; k < components; ++k) {
    part.strain[k] += first;
    part.stress[k] += first;
  }
  if (part.tangent) part.tangent += components * components * first;
  if (part.length) part.length += first;
  return part;
}

/** What a strain of 1 across the plane makes of stress, elastically. */
static double elastic_zz(const Material *m)
{
  return m->bulk + 4 * m->shear / 3;
}

/* Stress zz that is nothing, as a part of what stands beside it. Open cracks that dilate keep a last bit however far they are strained: they
 * are held to the second one. */
static const double SHARP = 1e-12, CLOSE = 1e-9;

/** True if the stress zz of point i of a batch is nothing, by this part of its other stresses and of what its strain zz would make
 *  elastically. */
static bool is_free_of_zz(const Material *m, const breccia_batch *batch, int i, double part)
{
  double scale = elastic_zz(m) * fabs(batch->strain[ZZ][i]);
  for (int k = 0; k < 6; ++k) scale += fabs(batch->stress[k][i]);
  return fabs(batch->stress[ZZ][i]) <= part * scale;
}

/** Strain zz of one point where Newton's method does not end: between two strains whose stresses zz differ in sign. The stress of some
 *  laws jumps there (explicit schemes, reversals under neutral loading): then the nearer side of the jump is taken.
 *  @param[in] from  where to begin
 *  @param[in] part  on the way to a change of sign, the first strain is taken whose stress is nothing by this part
 *  @return true if it was found */
static bool bisect_zz(const Material *m, const breccia_batch *batch, int at, double from, double part,
                      double *strain_zz)
{
  enum { MOST_DOUBLINGS = 60, MOST_HALVINGS = 200 };
  breccia_batch one = batch_part(batch, m, 6, at, 1);
  double *const x = strain_zz + at, ends[2] = {from, from}, values[2];
  *x = from;
  if (m->law->update(m->constants, &one) >= 0) return false;
  if (is_free_of_zz(m, &one, 0, part)) return true;
  values[0] = values[1] = one.stress[ZZ][0];
  double step = -values[0] / elastic_zz(m);
  for (int n = 0; n < MOST_DOUBLINGS && values[0] * values[1] > 0; ++n, step *= 2) {
    ends[0] = ends[1];
    values[0] = values[1];
    *x = ends[1] += step;
    if (m->law->update(m->constants, &one) >= 0) return false;
    values[1] = one.stress[ZZ][0];
    if (values[0] * values[1] > 0 && is_free_of_zz(m, &one, 0, part)) return true;
  }
  for (int n = 0; n < MOST_HALVINGS && !is_free_of_zz(m, &one, 0, SHARP); ++n) {
    /* The secant where it lies well inside, otherwise the middle. */
    const double share = values[0] / (values[0] - values[1]);
    *x = ends[0] + (n % 3 != 2 && share > 0.01 && share < 0.99 ? share : 0.5) * (ends[1] - ends[0]);
    if (m->law->update(m->constants, &one) >= 0) return false;
    const int side = one.stress[ZZ][0] * values[0] > 0 ? 0 : 1;
    ends[side] = *x;
    values[side] = one.stress[ZZ][0];
  }
  if (is_free_of_zz(m, &one, 0, SHARP)) return true;
  *x = ends[fabs(values[0]) < fabs(values[1]) ? 0 : 1];
  return values[0] * values[1] <= 0 && m->law->update(m->constants, &one) < 0;
}

/** How far the points of a batch are strained as they begin, or as elastic stiffness would have them. */
static void find_strained(const Material *m, const breccia_batch *batch, double strained[BATCH])
{
  for (int i = 0; i < batch->count; ++i) {
    strained[i] = fabs(batch->stress[ZZ][i]) / elastic_zz(m);
    for (int k = 0; k < 6; ++k) strained[i] = fmax(strained[i], fabs(batch->strain[k][i]));
  }
}

/** Strain zz by Newton's method with the law's own tangent, for all points of a batch at once, and alone for those where it does
 *  not end: at corners, in softening, and with tangents that are not those of whole steps; and for those where it ran away, as next to no
 *  stress divided by next to no stiffness leads out of numbers. */
int plane_stress_update(const Material *m, breccia_batch *batch, double *strain_zz)
{
  enum { MOST_ITERATIONS = 20 };
  static const double far = 10, out_of_sight = 1e6; /* times what the point is strained as it begins */
  double local[BATCH * 36], begin[BATCH], strained[BATCH], *const tangent = batch->tangent;
  bool settled[BATCH] = {false};
  memcpy(begin, strain_zz, sizeof *begin * (size_t)batch->count);
  batch->tangent = tangent ? tangent : local;
  for (int iteration = 0;; ++iteration) {
    int bad = m->law->update(m->constants, batch), worst = -1;
    if (bad >= 0) return bad;
    if (iteration == 0) find_strained(m, batch, strained);
    for (int i = 0; i < batch->count; ++i) {
      if (settled[i]) continue;
      const bool is_free = is_free_of_zz(m, batch, i, SHARP), last = iteration == MOST_ITERATIONS;
      if (is_free && fabs(strain_zz[i]) <= far * strained[i]) continue;
      worst = i;
      if (!is_free && !last) {
        const double stiffness = batch->tangent[36 * i + 7 * ZZ];
        strain_zz[i] -= batch->stress[ZZ][i] / (stiffness > 0 ? stiffness : elastic_zz(m));
        if (fabs(strain_zz[i]) <= out_of_sight * strained[i]) continue;
      }
      settled[i] = (!is_free && last && bisect_zz(m, batch, i, strain_zz[i], SHARP, strain_zz)) ||
                   bisect_zz(m, batch, i, begin[i], CLOSE, strain_zz);
      if (!settled[i]) return i;
    }
    if (worst < 0 || iteration == MOST_ITERATIONS) break;
  }
  for (int i = 0; tangent && i < batch->count; ++i) {
    double *d = tangent + 36 * i;
    double column[6], row[6], pivot = d[7 * ZZ] > 0 ? d[7 * ZZ] : elastic_zz(m);
    for (int k = 0; k < 6; ++k) {
      column[k] = d[6 * k + ZZ];
      row[k] = d[6 * ZZ + k];
    }
    for (int r = 0; r < 6; ++r)
      for (int k = 0; k < 6; ++k) d[6 * r + k] = r == ZZ || k == ZZ ? 0 : d[6 * r + k] - column[r] * row[k] / pivot;
  }
  return -1;
}

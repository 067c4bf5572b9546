/* Plane stress of any law of points in space: the strain across the plane is found such that the stress there vanishes. */
#include "base/tensor.h"
#include "points/packed_points.h"
#include "points/points_parts.h"

#include <math.h>

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
  if (part.lateral) part.lateral += first;
  batch_places_from(&part, first);
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
 *  @param[in] from, most  where to begin, and the largest strain that is looked at
 *  @param[in] part  on the way to a change of sign, the first strain is taken whose stress is nothing by this part
 *  @return true if it was found */
static bool bisect_zz(const Material *m, const breccia_batch *batch, int at, double from, double most, double part,
                      double *strain_zz)
{
  enum { MOST_DOUBLINGS = 60, MOST_HALVINGS = 200 };
  breccia_batch one = batch_part(batch, m, 6, at, 1);
  double *const x = strain_zz + at, ends[2] = {from, from}, values[2];
  if (!(fabs(from) <= most)) return false;
  *x = from;
  if (material_update(m, &one) >= 0) return false;
  if (is_free_of_zz(m, &one, 0, part)) return true;
  values[0] = values[1] = one.stress[ZZ][0];
  double step = -values[0] / elastic_zz(m);
  for (int n = 0; n < MOST_DOUBLINGS && values[0] * values[1] > 0; ++n, step *= 2) {
    ends[0] = ends[1];
    values[0] = values[1];
    *x = ends[1] += step;
    if (fabs(*x) > most || material_update(m, &one) >= 0) return false;
    values[1] = one.stress[ZZ][0];
    if (values[0] * values[1] > 0 && is_free_of_zz(m, &one, 0, part)) return true;
  }
  if (!(values[0] * values[1] <= 0)) return false;
  for (int n = 0; n < MOST_HALVINGS && !is_free_of_zz(m, &one, 0, SHARP); ++n) {
    /* The secant where it lies well inside, otherwise the middle. */
    const double share = values[0] / (values[0] - values[1]);
    *x = ends[0] + (n % 3 != 2 && share > 0.01 && share < 0.99 ? share : 0.5) * (ends[1] - ends[0]);
    if (material_update(m, &one) >= 0) return false;
    const int side = one.stress[ZZ][0] * values[0] > 0 ? 0 : 1;
    ends[side] = *x;
    values[side] = one.stress[ZZ][0];
  }
  if (is_free_of_zz(m, &one, 0, SHARP)) return true;
  *x = ends[fabs(values[0]) < fabs(values[1]) ? 0 : 1];
  return material_update(m, &one) < 0;
}

/** The strain zz of a point, as it is looked for. */
typedef struct Search {
  double begin, most; /* where it begins, and the largest that counts */
  double zz, stress;  /* the last one, and its stress */
  double before;      /* how large the stress before that was */
  double sides[2];    /* the last ones with a stress of either sign */
  bool has_side[2];   /* whether there are any */
  bool found;
} Search;

/* Times as far as a point is strained as it begins, or as elastic stiffness would have it: no answer lies further, as next to no stress divided by next to
 * no stiffness leads anywhere; and no question, as laws are not made for strains that large. */
static const double FAR = 10, OUT_OF_SIGHT = 1000;

static Search begin_search(const Material *m, const breccia_batch *batch, int i)
{
  double strained = fabs(batch->stress[ZZ][i]) / elastic_zz(m);
  for (int k = 0; k < 6; ++k)
    if (fabs(batch->strain[k][i]) > strained) strained = fabs(batch->strain[k][i]);
  return (Search){
      .begin = batch->strain[ZZ][i], .most = fmax(FAR * strained, 1), .before = INFINITY, .stress = INFINITY};
}

/** Where to look next: by the tangent, or else by the slope between the last two strains, which stays between two whose stresses differ in sign and takes their middle
 *  where it has not halved the stress in two steps. */
static double next_zz(const Material *m, const breccia_batch *batch, int i, const Search *s)
{
  const double zz = batch->strain[ZZ][i], stress = batch->stress[ZZ][i];
  double slope = batch->tangent ? batch->tangent[36 * i + 7 * ZZ] : 0;
  if (!batch->tangent && zz != s->zz) slope = (stress - s->stress) / (zz - s->zz);
  const double next = zz - stress / (slope > 0 ? slope : elastic_zz(m));
  if (batch->tangent || !s->has_side[0] || !s->has_side[1]) return next;
  const double low = fmin(s->sides[0], s->sides[1]), high = fmax(s->sides[0], s->sides[1]);
  return next > low && next < high && fabs(stress) <= 0.5 * s->before ? next : 0.5 * (low + high);
}

typedef enum Look { FOUND, GOES_ON, FAILED } Look;

/** Looks at the stress zz of a point and, where it is not nothing, goes on to another strain zz. */
static Look take_step(const Material *m, const breccia_batch *batch, int i, bool last, Search *s, double *strain_zz)
{
  const bool is_free = is_free_of_zz(m, batch, i, SHARP);
  const double stress = batch->stress[ZZ][i];
  if (is_free && fabs(strain_zz[i]) <= s->most) return FOUND;
  if (!is_free && !last) {
    s->sides[stress > 0] = strain_zz[i];
    s->has_side[stress > 0] = true;
    const double next = next_zz(m, batch, i, s);
    s->zz = strain_zz[i];
    s->before = fabs(s->stress);
    s->stress = stress;
    strain_zz[i] = next;
    if (fabs(next) <= OUT_OF_SIGHT / FAR * s->most) return GOES_ON;
  }
  const bool found = (!is_free && last && bisect_zz(m, batch, i, strain_zz[i], s->most, SHARP, strain_zz)) ||
                     bisect_zz(m, batch, i, s->begin, s->most, CLOSE, strain_zz);
  return found ? FOUND : FAILED;
}

/** Strains zz of a whole batch as its searches began: another try begins there. @return the point that fails */
static int fail(const Search *searches, int count, int point, double *strain_zz)
{
  for (int i = 0; i < count; ++i) strain_zz[i] = searches[i].begin;
  return point;
}

/** Predicts the strains zz of a batch by linear isotropic elasticity, where sigma_zz = 0:
 *    eps_zz = -lambda (eps_xx + eps_yy) / (lambda + 2 G),  lambda = K - 2 G / 3.
 *  The result does not depend on earlier evaluations, whose strains zz a checkpoint need not hold.
 *  @param[out] strain_zz  [count] */
static void plane_stress_predict(const Material *m, const breccia_batch *batch, double *strain_zz)
{
  const double ratio = (m->bulk - 2 * m->shear / 3) / elastic_zz(m);
  for (int i = 0; i < batch->count; ++i) strain_zz[i] = -ratio * (batch->strain[XX][i] + batch->strain[YY][i]);
}

/** Strain zz by Newton's method with the law's own tangent, for all points of a batch at once, and alone for those where it does
 *  not end: at corners, in softening, and with tangents that are not those of whole steps; and for those where it ran away. Where nobody wants tangents
 *  the law makes them once only, as they take it as long again as stresses. */
int plane_stress_update(const Material *m, breccia_batch *batch, double *strain_zz)
{
  enum { MOST_ITERATIONS = 20 };
  const bool may_pack = packed_points_take(m);
  double local[BATCH * 36], *const tangent = batch->tangent;
  Search searches[BATCH];
  bool is_packed = false;
  PackedPoints packed;
  breccia_batch now = *batch; /* the whole one, or what is left of it */
  double *zz = strain_zz;
  const bool linear = m->law->linear;
  if (linear || batch->elastic_stage) plane_stress_predict(m, batch, strain_zz);
  now.tangent = tangent || linear ? tangent : local;
  for (int iteration = 0;; ++iteration) {
    const int bad = material_update(m, &now);
    int left[BATCH], count = 0;
    if (bad >= 0 && iteration == 0) return bad;
    if (bad >= 0) return fail(searches, batch->count, is_packed ? packed.of[bad] : bad, strain_zz);
    for (int i = 0; i < now.count && iteration == 0; ++i) searches[i] = begin_search(m, &now, i);
    for (int i = 0; i < now.count; ++i) {
      const int of = is_packed ? packed.of[i] : i;
      if (searches[of].found) continue;
      const Look look = take_step(m, &now, i, iteration == MOST_ITERATIONS, &searches[of], zz);
      if (look == FAILED) return fail(searches, batch->count, of, strain_zz);
      searches[of].found = look == FOUND;
      if (look == GOES_ON)
        left[count++] = i;
      else if (is_packed)
        packed_points_give_back(&packed, m, i, batch, strain_zz);
    }
    if (!count) break;
    if (!may_pack) continue;
    if (!is_packed) now.tangent = tangent;
    if (count == now.count) continue;
    packed_points_pack(&packed, m, &now, is_packed, left, count);
    now = packed_points_batch(&packed, batch, count);
    zz = packed.strain[ZZ];
    is_packed = true;
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

#include "constitutive/points.h"

#include "base/team.h"
#include "base/tensor.h"
#include "constitutive/remote_points.h"
#include <stdlib.h>
#include <string.h>

/** Numbers of history that a slice needs. */
static int64_t slice_values(const Points *points, int64_t slice)
{
  const Family *f = points->family;
  int64_t values = points->materials[points->material[slice]].history_values;
  if (points->where == POINTS_ON_PARTICLES) return SLICE * values;
  return SLICE * ((f->first[slice + 1] - f->first[slice]) * values +
                  (f->first[slice + 1] - f->stored[slice]) * points->partner_values);
}

int64_t points_bond_row(const Points *points, int64_t slice, int64_t slot, int lane, bool partner)
{
  const Family *f = points->family;
  int64_t own = points->materials[points->material[slice]].history_values, start = points->history_start[slice];
  if (!partner) return start + ((slot - f->first[slice]) * SLICE + lane) * own;
  return start + (f->first[slice + 1] - f->first[slice]) * SLICE * own +
         ((slot - f->stored[slice]) * SLICE + lane) * points->partner_values;
}

const Material *points_partner(const Points *points, int64_t slot, int lane)
{
  const Family *f = points->family;
  return &points->materials[points->material[f->neighbour[(int64_t)f->base[slot] * SLICE + lane] / SLICE]];
}

static void begin_row(const Material *m, double *row)
{
  if (m->law->begin) m->law->begin(m->constants, row);
}

static void begin_slice(void *context, int64_t slice)
{
  const Points *points = context;
  const Family *f = points->family;
  const Material *m = &points->materials[points->material[slice]];
  for (int lane = 0; points->where == POINTS_ON_PARTICLES && lane < SLICE; ++lane)
    begin_row(m, points->committed + points->history_start[slice] + lane * m->history_values);
  if (points->where != POINTS_ON_BONDS) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      begin_row(m, points->committed + points_bond_row(points, slice, slot, lane, false));
      if (points->partner_values && slot >= f->stored[slice])
        begin_row(points_partner(points, slot, lane),
                  points->committed + points_bond_row(points, slice, slot, lane, true));
    }
}

int points_create(Points *points, const PointsSpec *spec, Error *error)
{
  const int64_t slices = spec->family->particles->slices;
  *points = (Points){.where = spec->where,
                     .space = spec->space,
                     .places = slices * SLICE,
                     .materials = spec->materials,
                     .material_count = spec->material_count,
                     .material = spec->material,
                     .family = spec->family};
  points->history_start = memory_zeroed((size_t)slices, sizeof(int64_t), "history rows", error);
  if (!points->history_start) return BRECCIA_FAILURE;
  for (int k = 0; spec->material_count > 1 && k < spec->material_count; ++k)
    if (spec->materials[k].history_values > points->partner_values)
      points->partner_values = spec->materials[k].history_values;
  if (spec->may_give_up && !(points->gave_up = memory_zeroed((size_t)points->places, 1, "failed laws", error)))
    return BRECCIA_FAILURE;
  int64_t total = 0;
  for (int64_t s = 0; s < slices && spec->where != POINTS_NOWHERE; ++s) {
    points->history_start[s] = total;
    total += slice_values(points, s);
  }
  points->history_size = (size_t)total;
  points->committed = memory_zeroed((size_t)total, sizeof(double), "histories", error);
  points->trial = memory_zeroed((size_t)total, sizeof(double), "histories", error);
  if (!points->committed || !points->trial) return BRECCIA_FAILURE;
  if (spec->where == POINTS_ON_PARTICLES && points_show(points, error)) return BRECCIA_FAILURE;
  team_each(slices, begin_slice, points);
  if (total) memcpy(points->trial, points->committed, sizeof(double) * (size_t)total);
  return remote_points_create(points, error);
}

int points_show(Points *points, Error *error)
{
  int failed = 0;
  for (int k = 0; k < 6; ++k) {
    if (!points->strain[k]) failed |= !(points->strain[k] = places_array(points->places, "strains", error));
    if (!points->stress[k]) failed |= !(points->stress[k] = places_array(points->places, "stresses", error));
  }
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
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
  free(points->gave_up);
  free(points->tangent);
  remote_points_destroy(points);
  *points = (Points){0};
}

void points_commit(Points *points)
{
  double *trial = points->trial;
  points->trial = points->committed;
  points->committed = trial;
  remote_points_commit(points);
}

static int histories_ready(void *owner, Error *error)
{
  return points_save(owner, error);
}

static int histories_resume(void *owner, const double *numbers, int64_t count, Error *error)
{
  Points *points = owner;
  (void)numbers, (void)count;
  if (points->history_size) memcpy(points->trial, points->committed, sizeof(double) * points->history_size);
  return points_resume(points, error);
}

void points_state(Points *points, StateList *list)
{
  static const StateCare histories = {.ready = histories_ready, .resume = histories_resume};
  static const char *const parts[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  const bool here = points->where == POINTS_ON_PARTICLES;
  StateRow row = {.kind = STATE_NUMBERS, .entity = STATE_OF_PLACE, .count = points->places};
  for (int k = 0; k < 6 && points->strain[0]; ++k) {
    row.unit = "1";
    row.values = points->strain[k];
    /* Across the plane of plane stress the law finds it, from where it was. */
    row.role = !here ? STATE_SHOWN : k == ZZ && points->space == SPACE_PLANE_STRESS ? STATE_TRIED : STATE_FOLLOWS;
    state_add(list, &row, "strain", parts[k]);
    row.unit = "stress";
    row.values = points->stress[k];
    row.role = !here ? STATE_SHOWN : points_are_linear(points) ? STATE_FOLLOWS : STATE_TRIED;
    state_add(list, &row, "stress", parts[k]);
  }
  if (points->gave_up)
    state_add(list,
              &(StateRow){.unit = "1",
                          .kind = STATE_BYTES,
                          .entity = STATE_OF_PLACE,
                          .role = STATE_TRIED,
                          .count = points->places,
                          .values = points->gave_up},
              "failed laws", NULL);
  row = (StateRow){.unit = "1", .kind = STATE_NUMBERS, .role = STATE_COMMITTED};
  row.count = (int64_t)points->identity_size;
  row.values = points->identity;
  if (points->identity_size) state_add(list, &row, "servers", NULL);
  row.entity = STATE_OF_POINT;
  row.count = (int64_t)points->history_size;
  row.values = points->committed;
  row.care = &histories;
  row.owner = points;
  state_add(list, &row, "history", NULL);
}

bool points_are_linear(const Points *points)
{
  for (int k = 0; k < points->material_count; ++k)
    if (!points->materials[k].law->linear) return false;
  return true;
}

/** True if the stress zz of point i of a batch is nothing beside its other stresses and what its strain zz would make
 *  elastically. */
static bool is_free_of_zz(const Material *m, const breccia_batch *batch, int i)
{
  double scale = (m->bulk + 4 * m->shear / 3) * fabs(batch->strain[ZZ][i]);
  for (int k = 0; k < 6; ++k) scale += fabs(batch->stress[k][i]);
  return fabs(batch->stress[ZZ][i]) <= 1e-12 * scale;
}

/** Strain zz of one point where Newton's method does not end: between two strains whose stresses zz differ in sign. The stress of some
 *  laws jumps there (explicit schemes, reversals under neutral loading): then the nearer side of the jump is taken.
 *  @return true if it was found */
static bool bisect_zz(const Material *m, const breccia_batch *batch, int at, double *strain_zz)
{
  enum { MOST_DOUBLINGS = 60, MOST_HALVINGS = 200 };
  const ptrdiff_t row = (ptrdiff_t)m->history_values * at;
  breccia_batch one = {.count = 1,
                       .committed = batch->committed + row,
                       .trial = batch->trial + row,
                       .tangent = batch->tangent + 36 * at,
                       .elastic_stage = batch->elastic_stage};
  for (int k = 0; k < 6; ++k) {
    one.strain[k] = batch->strain[k] + at;
    one.stress[k] = batch->stress[k] + at;
  }
  double *const x = strain_zz + at, ends[2] = {*x, *x}, values[2];
  if (m->law->update(m->constants, &one) >= 0) return false;
  values[0] = values[1] = one.stress[ZZ][0];
  double step = -values[0] / (m->bulk + 4 * m->shear / 3);
  for (int n = 0; n < MOST_DOUBLINGS && values[0] * values[1] > 0; ++n, step *= 2) {
    ends[0] = ends[1];
    values[0] = values[1];
    *x = ends[1] += step;
    if (m->law->update(m->constants, &one) >= 0) return false;
    values[1] = one.stress[ZZ][0];
  }
  for (int n = 0; n < MOST_HALVINGS && !is_free_of_zz(m, &one, 0); ++n) {
    /* The secant where it lies well inside, otherwise the middle. */
    const double share = values[0] / (values[0] - values[1]);
    *x = ends[0] + (n % 3 != 2 && share > 0.01 && share < 0.99 ? share : 0.5) * (ends[1] - ends[0]);
    if (m->law->update(m->constants, &one) >= 0) return false;
    const int side = one.stress[ZZ][0] * values[0] > 0 ? 0 : 1;
    ends[side] = *x;
    values[side] = one.stress[ZZ][0];
  }
  if (is_free_of_zz(m, &one, 0)) return true;
  *x = ends[fabs(values[0]) < fabs(values[1]) ? 0 : 1];
  return values[0] * values[1] <= 0 && m->law->update(m->constants, &one) < 0;
}

/** Strain zz by Newton's method with the law's own tangent, for all points of a batch at once, and alone for those where it does
 *  not end: at corners, in softening, and with tangents that are not those of whole steps. */
static int plane_stress(const Material *m, breccia_batch *batch, double *strain_zz, double *tangent)
{
  enum { MOST_ITERATIONS = 20 };
  double local[BLOCK * 36];
  batch->tangent = tangent ? tangent : local;
  for (int iteration = 0;; ++iteration) {
    int bad = m->law->update(m->constants, batch), worst = -1;
    if (bad >= 0) return bad;
    for (int i = 0; i < batch->count; ++i) {
      if (is_free_of_zz(m, batch, i)) continue;
      worst = i;
      if (iteration == MOST_ITERATIONS) {
        if (!bisect_zz(m, batch, i, strain_zz)) return i;
        continue;
      }
      const double stiffness = batch->tangent[36 * i + 7 * ZZ];
      strain_zz[i] -= batch->stress[ZZ][i] / (stiffness > 0 ? stiffness : m->bulk + 4 * m->shear / 3);
    }
    if (worst < 0 || iteration == MOST_ITERATIONS) break;
  }
  for (int i = 0; tangent && i < batch->count; ++i) {
    double *d = tangent + 36 * i;
    double column[6], row[6], pivot = d[7 * ZZ] > 0 ? d[7 * ZZ] : m->bulk + 4 * m->shear / 3;
    for (int k = 0; k < 6; ++k) {
      column[k] = d[6 * k + ZZ];
      row[k] = d[6 * ZZ + k];
    }
    for (int r = 0; r < 6; ++r)
      for (int k = 0; k < 6; ++k) d[6 * r + k] = r == ZZ || k == ZZ ? 0 : d[6 * r + k] - column[r] * row[k] / pivot;
  }
  return -1;
}

/** Part of a batch. */
static breccia_batch batch_from(const breccia_batch *whole, const Material *m, int first, int count)
{
  breccia_batch part = *whole;
  part.count = count;
  part.committed += (ptrdiff_t)m->history_values * first;
  part.trial += (ptrdiff_t)m->history_values * first;
  for (int k = 0; k < 6; ++k) {
    if (part.strain[k]) part.strain[k] += first;
    if (part.stress[k]) part.stress[k] += first;
  }
  if (part.tangent) part.tangent += 36 * first;
  return part;
}

static int update_batch(const Points *points, const Material *m, breccia_batch *batch, double *strain_zz)
{
  return points->space == SPACE_PLANE_STRESS ? plane_stress(m, batch, strain_zz, batch->tangent)
                                             : m->law->update(m->constants, batch);
}

/** One point after the other: those that cannot be integrated are marked, carry nothing and keep their history. */
static void update_one_by_one(const Points *points, const Material *m, const breccia_batch *batch, int64_t place)
{
  for (int i = 0; i < batch->count; ++i) {
    breccia_batch one = batch_from(batch, m, i, 1);
    if (update_batch(points, m, &one, points->strain[ZZ] + place + i) < 0) continue;
    points->gave_up[place + i] |= 1;
    for (int k = 0; k < 6; ++k) one.stress[k][0] = 0;
    memcpy(one.trial, one.committed, sizeof(double) * (size_t)m->history_values);
    for (int k = 0; batch->tangent && k < 36; ++k) batch->tangent[36 * i + k] = 0;
  }
}

int points_keep_tangents(Points *points, bool keep, Error *error)
{
  if (points->where == POINTS_ON_PARTICLES && !points->tangent &&
      !(points->tangent = memory_zeroed(36 * (size_t)points->places, sizeof(double), "tangents", error)))
    return BRECCIA_FAILURE;
  points->keeps_tangents = keep;
  return BRECCIA_OK;
}

void points_tangent(const Points *points, int64_t place, double tangent[36])
{
  for (int k = 0; k < 36; ++k) tangent[k] = points->tangent ? points->tangent[36 * place + k] : 0;
}

void points_change(const Points *points, int64_t first, int64_t last, double *const strain[6], double *const stress[6])
{
  const int64_t count = (last - first) * SLICE;
  for (int64_t i = 0; i < count; ++i) {
    const double *d = points->tangent + 36 * (first * SLICE + i);
    for (int r = 0; r < 6; ++r) {
      double sum = 0;
      for (int k = 0; k < 6; ++k) sum += d[6 * r + k] * strain[k][i];
      stress[r][i] = sum;
    }
  }
}

int64_t points_update(Points *points, int64_t first, int64_t last, double *tangent)
{
  if (points->keeps_tangents) tangent = points->tangent + 36 * SLICE * first;
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
  const int bad = update_batch(points, m, &batch, points->strain[ZZ] + place);
  if (bad < 0) return -1;
  if (!points->gave_up) return place + bad;
  batch.tangent = tangent;
  update_one_by_one(points, m, &batch, place);
  return -1;
}

static int update_bonds(const Points *points, const Material *m, const breccia_batch *batch)
{
  return m->remote ? remote_points_bonds(points, m, batch) : m->law->update(m->constants, batch);
}

int64_t points_update_bonds(Points *points, int64_t slice, int64_t slot, int count, const double *strain,
                            double *stress)
{
  const Material *m = &points->materials[points->material[slice]];
  const int64_t row = points_bond_row(points, slice, slot, 0, false);
  breccia_batch batch = {.count = count * SLICE,
                         .strain = {strain},
                         .stress = {stress},
                         .committed = points->committed + row,
                         .trial = points->trial + row,
                         .elastic_stage = points->elastic_stage};
  int bad = update_bonds(points, m, &batch);
  if (bad < 0) return -1;
  if (!points->gave_up || m->remote) return slice * SLICE + bad % SLICE;
  for (int i = 0; i < batch.count; ++i) {
    breccia_batch one = batch_from(&batch, m, i, 1);
    if (m->law->update(m->constants, &one) < 0) continue;
    points->gave_up[slice * SLICE + i % SLICE] |= 1;
    one.stress[0][0] = 0;
    memcpy(one.trial, one.committed, sizeof(double) * (size_t)m->history_values);
  }
  return -1;
}

int64_t points_update_partner(Points *points, int64_t slice, int64_t slot, int lane, double strain, double *stress)
{
  const Material *m = points_partner(points, slot, lane);
  const int64_t row = points_bond_row(points, slice, slot, lane, true);
  breccia_batch batch = {.count = 1,
                         .strain = {&strain},
                         .stress = {stress},
                         .committed = points->committed + row,
                         .trial = points->trial + row,
                         .elastic_stage = points->elastic_stage};
  if (update_bonds(points, m, &batch) < 0) return -1;
  if (!points->gave_up || m->remote) return slice * SLICE + lane;
  points->gave_up[slice * SLICE + lane] |= 1;
  *stress = 0;
  memcpy(batch.trial, batch.committed, sizeof(double) * (size_t)m->history_values);
  return -1;
}

double points_bond_stress(const Points *points, int64_t slice, int64_t slot, int lane, bool partner, double strain,
                          double *tangent)
{
  enum { MOST_VALUES = 256 };
  const Material *m = partner ? points_partner(points, slot, lane) : &points->materials[points->material[slice]];
  const double *row = points->committed + points_bond_row(points, slice, slot, lane, partner);
  double stress = NAN, scratch[MOST_VALUES];
  if (m->remote) stress = remote_last_stress(row); /* a law in a server need not be able to try */
  if (m->remote && tangent) *tangent = strain != 0 ? stress / strain : material_young(m);
  if (m->remote) return stress;
  if (m->history_values > MOST_VALUES) return NAN;
  memcpy(scratch, row, sizeof(double) * (size_t)m->history_values);
  breccia_batch batch = {.count = 1,
                         .strain = {&strain},
                         .stress = {&stress},
                         .committed = row,
                         .trial = scratch,
                         .tangent = tangent,
                         .elastic_stage = points->elastic_stage};
  m->law->update(m->constants, &batch);
  return stress;
}

double points_softness(const Points *points, int64_t place)
{
  enum { MOST_VALUES = 256 };
  const int64_t slice = place / SLICE;
  const Material *m = &points->materials[points->material[slice]];
  if (m->remote || m->law->linear || m->history_values > MOST_VALUES) return 1;
  double strain[6], before[6], after[6], scratch[MOST_VALUES], square = 0, mean = 0, stiffest = 0;
  for (int k = 0; k < 6; ++k) {
    before[k] = points->stress[k][place];
    square += before[k] * before[k] * (k < 3 ? 1 : 2);
  }
  for (int k = 0; k < 3; ++k) mean += before[k] / 3;
  breccia_batch batch = {.count = 1,
                         .committed =
                             points->committed + points->history_start[slice] + place % SLICE * m->history_values,
                         .trial = scratch,
                         .elastic_stage = points->elastic_stage};
  /* A small step back and one ahead, elastically: damage is felt both ways, yielding one way. */
  for (int side = -1; side <= 1; side += 2) {
    const double step = side * 1e-3;
    double product = 0;
    for (int k = 0; k < 6; ++k) {
      const double deviator = k < 3 ? before[k] - mean : before[k];
      strain[k] = points->strain[k][place] +
                  step * (deviator / m->shear * (k < 3 ? 0.5 : 1) + (k < 3 ? mean / (3 * m->bulk) : 0));
      batch.strain[k] = &strain[k];
      batch.stress[k] = &after[k];
    }
    if (m->history_values) memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
    if (m->law->update(m->constants, &batch) >= 0) continue;
    for (int k = 0; k < 6; ++k) product += before[k] * (after[k] - before[k]) * (k < 3 ? 1 : 2);
    if (square > 0) stiffest = fmax(stiffest, product / (step * square));
  }
  return stiffest > 0 ? 1 / fmin(1, stiffest) : 1;
}

double points_bond_elastic_share(const Points *points, int64_t slice, int64_t slot, int lane, double strain)
{
  if (points->where != POINTS_ON_BONDS || strain == 0) return 1;
  const double back = 1e-3, stress = points_bond_stress(points, slice, slot, lane, false, strain, NULL);
  const double drop = stress - points_bond_stress(points, slice, slot, lane, false, strain - back * strain, NULL);
  const double share = back * stress / drop;
  return share > 0 ? fmin(1, share) : stress == 0 ? 0 : 1;
}

double points_bond_history(const Points *points, int64_t place, int k)
{
  const Family *f = points->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double sum = 0;
  int count = 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    if (f->intact[slot] >> lane & 1) {
      sum += points->committed[points_bond_row(points, slice, slot, lane, false) + k];
      ++count;
    }
  return count ? sum / count : 0;
}

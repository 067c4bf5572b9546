#include "points/points.h"

#include "base/team.h"
#include "base/tensor.h"
#include "points/points_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_VALUES = 256 }; /* history numbers of a point that can be tried out */

static void begin_run(void *context, int64_t n)
{
  const Points *points = context;
  const PointsRun *run = &points->runs[n];
  const Material *m = &points->materials[run->material];
  for (int64_t i = 0; i < run->count && m->law->begin; ++i) {
    const int64_t at = points->history_first[n] + i * m->history_values;
    m->law->begin(m->constants, points->committed + at);
    m->law->begin(m->constants, points->trial + at);
  }
}

static int create_runs(Points *points, const PointsSpec *spec, Error *error)
{
  points->runs = memory_zeroed((size_t)spec->run_count, sizeof *points->runs, "runs of points", error);
  points->history_first = memory_zeroed((size_t)spec->run_count, sizeof(int64_t), "runs of points", error);
  if (!points->runs || !points->history_first) return BRECCIA_FAILURE;
  int64_t total = 0;
  for (int64_t n = 0; n < spec->run_count; ++n) {
    points->runs[n] = spec->runs[n];
    points->history_first[n] = total;
    points->count = spec->runs[n].first + spec->runs[n].count;
    total += spec->runs[n].count * spec->materials[spec->runs[n].material].history_values;
  }
  points->history_size = (size_t)total;
  return BRECCIA_OK;
}

int points_create(Points *points, const PointsSpec *spec, Error *error)
{
  *points = (Points){.components = spec->components,
                     .plane_stress = spec->plane_stress,
                     .on_bonds = spec->on_bonds,
                     .materials = spec->materials,
                     .material_count = spec->material_count,
                     .run_count = spec->run_count};
  for (int i = 0; i < BATCH; ++i) points->length[i] = spec->length;
  if (create_runs(points, spec, error)) return BRECCIA_FAILURE;
  if (spec->may_give_up && !(points->gave_up = memory_zeroed((size_t)points->count, 1, "failed laws", error)))
    return BRECCIA_FAILURE;
  points->committed = memory_reserved(points->history_size, sizeof(double), "histories", error);
  points->trial = memory_reserved(points->history_size, sizeof(double), "histories", error);
  if (!points->committed || !points->trial || untouched_create(points, error)) return BRECCIA_FAILURE;
  points->shares = spec->strain != NULL;
  for (int k = 0; k < 6 && points->shares; ++k) {
    points->strain[k] = spec->strain[k];
    points->stress[k] = spec->stress[k];
  }
  for (int k = 0; k < 6 && points->components == 6 && !points->shares && !spec->no_tensors; ++k) {
    points->strain[k] = places_array(points->count, "strains", error);
    points->stress[k] = places_array(points->count, "stresses", error);
    if (!points->strain[k] || !points->stress[k]) return BRECCIA_FAILURE;
  }
  team_each(points->run_count, begin_run, points);
  return point_servers_create(points, spec->present, error);
}

void points_destroy(Points *points)
{
  for (int k = 0; k < 6 && !points->shares; ++k) {
    places_free(&points->strain[k]);
    places_free(&points->stress[k]);
    places_free(&points->stress_before[k]);
  }
  free(points->committed);
  free(points->trial);
  free(points->runs);
  free(points->history_first);
  free(points->gave_up);
  untouched_destroy(points);
  free(points->tangent);
  free(points->tangent_first);
  free(points->elastic_tangent);
  point_servers_destroy(points);
  *points = (Points){0};
}

int64_t points_run(const Points *points, int64_t row)
{
  int64_t low = 0, high = points->run_count;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (points->runs[middle].first <= row)
      low = middle;
    else
      high = middle;
  }
  return low;
}

const Material *points_material(const Points *points, int64_t row)
{
  return &points->materials[points->runs[points_run(points, row)].material];
}

/** Where the history of a row of run n begins. */
static int64_t history_at(const Points *points, int64_t n, int64_t row)
{
  return points->history_first[n] +
         (row - points->runs[n].first) * points->materials[points->runs[n].material].history_values;
}

const double *points_history(const Points *points, int64_t row)
{
  return points->committed + history_at(points, points_run(points, row), row);
}

void points_take_up(Points *points)
{
  if (points->history_size) memcpy(points->trial, points->committed, sizeof(double) * points->history_size);
  untouched_find(points);
}

void points_commit(Points *points)
{
  double *trial = points->trial;
  points->trial = points->committed;
  points->committed = trial;
  point_servers_commit(points);
}

bool points_are_linear(const Points *points)
{
  for (int k = 0; k < points->material_count; ++k)
    if (!points->materials[k].law->linear) return false;
  return true;
}

static int histories_ready(void *owner, Error *error)
{
  return points_save(owner, error);
}

static int histories_resume(void *owner, const double *numbers, int64_t count, Error *error)
{
  (void)numbers, (void)count;
  points_take_up(owner);
  return points_resume(owner, error);
}

void points_state(Points *points, const char *of, StateList *list)
{
  static const StateCare histories = {.ready = histories_ready, .resume = histories_resume};
  const char *const strain = points->on_bonds ? "bond strain" : "strain", *const stress = points->on_bonds
                                                                                              ? "bond stress"
                                                                                              : "stress";
  StateRow row = {
      .kind = STATE_NUMBERS, .entity = points->on_bonds ? STATE_OF_POINT : STATE_OF_PLACE, .count = points->count};
  for (int k = 0; k < 6 && points_keep_tensors(points) && !points->shares; ++k) {
    row.unit = "1";
    row.values = points->strain[k];
    /* Across the plane of plane stress the law finds it, from where it was. */
    row.role = k == ZZ && points->plane_stress ? STATE_TRIED : STATE_FOLLOWS;
    state_add(list, &row, strain, component_names[k]);
    row.unit = "stress";
    row.values = points->stress[k];
    row.role = points_are_linear(points) ? STATE_FOLLOWS : STATE_COMMITTED; /* points_put_by */
    state_add(list, &row, stress, component_names[k]);
  }
  row = (StateRow){.unit = "1", .kind = STATE_NUMBERS, .role = STATE_COMMITTED};
  row.count = (int64_t)points->identity_size;
  row.values = points->identity;
  if (points->identity_size) state_add(list, &row, "servers", of);
  row.entity = STATE_OF_POINT;
  row.count = (int64_t)points->history_size;
  row.values = points->committed;
  row.care = &histories;
  row.owner = points;
  state_add(list, &row, "history", of);
}

/* ---- the door to laws ---- */

/** Where the tangents from a row of run n on are kept; NULL: its law is linear. */
static double *kept_tangent(const Points *points, int64_t n, int64_t row)
{
  const int64_t first = points->tangent_first[n];
  return first < 0 ? NULL : points->tangent + 36 * (first + row - points->runs[n].first);
}

/** What laws see of rows of one run. Field by field into its place: made whole and copied, it cost more than the law of a bond. */
static void make_batch(breccia_batch *batch, const Points *points, int64_t first, int count, double *const *strain,
                       double *const *stress)
{
  const int64_t run = points_run(points, first), row = history_at(points, run, first);
  const int components = points->components;
  batch->size = sizeof *batch;
  batch->count = count;
  batch->committed = points->committed + row;
  batch->trial = points->trial + row;
  batch->tangent = points->keeps_tangents ? kept_tangent(points, run, first) : NULL;
  batch->elastic_stage = points->elastic_stage;
  batch->time = points->time;
  batch->time_step = points->time_step;
  batch->length = isnan(points->length[0]) ? NULL : points->length;
  for (int k = 0; k < 6; ++k) {
    batch->strain[k] = k < components ? strain[k] : NULL;
    batch->stress[k] = k < components ? stress[k] : NULL;
  }
}

static int update_batch(const Points *points, const Material *m, breccia_batch *batch, double *const strain[6])
{
  return points->plane_stress && points->components == 6 ? plane_stress_update(m, batch, strain[ZZ])
                                                         : m->law->update(m->constants, batch);
}

/** One point after the other: those that cannot be integrated are marked, carry nothing and keep their history. */
static void update_one_by_one(Points *points, const Material *m, const breccia_batch *batch, int64_t first,
                              double *const strain[6])
{
  const int n = points->components;
  for (int i = 0; i < batch->count; ++i) {
    breccia_batch one = batch_part(batch, m, n, i, 1);
    double *here[6] = {NULL};
    for (int k = 0; k < n; ++k) here[k] = strain[k] + i;
    if (update_batch(points, m, &one, here) < 0) continue;
    points->gave_up[first + i] |= 1;
    for (int k = 0; k < n; ++k) one.stress[k][0] = 0;
    memcpy(one.trial, one.committed, sizeof(double) * (size_t)m->history_values);
    for (int k = 0; batch->tangent && k < n * n; ++k) batch->tangent[n * n * i + k] = 0;
  }
}

/** Histories of as many rows behind these, which are worked on next. */
static void fetch_ahead(const Points *points, const breccia_batch *batch, int values)
{
  const ptrdiff_t size = (ptrdiff_t)batch->count * values;
  if (batch->committed + 2 * size > points->committed + points->history_size) return;
  for (ptrdiff_t k = size; k < 2 * size; k += 8) {
    __builtin_prefetch(batch->committed + k);
    __builtin_prefetch(batch->trial + k);
  }
}

static int64_t update_rows(Points *points, int64_t first, int count, double *const strain[6], double *const stress[6])
{
  const int material = points->runs[points_run(points, first)].material;
  const Material *m = &points->materials[material];
  _Alignas(64) double trial[UNTOUCHED_NUMBERS];
  breccia_batch batch;
  make_batch(&batch, points, first, count, strain, stress);
  double *own = batch.trial;
  if (untouched_batch(points, material, first, count, &batch, trial)) {
    if (update_batch(points, m, &batch, strain) < 0) {
      untouched_keep(points, material, first, count, trial, own);
      return -1;
    }
    make_batch(&batch, points, first, count, strain, stress);
  }
  if (points->components == 1 && m->history_values <= 2) fetch_ahead(points, &batch, m->history_values);
  if (m->remote && points_ask_ahead(points)) return point_servers_answer(points, m, &batch, first);
  const int bad = update_batch(points, m, &batch, strain);
  if (bad < 0) return -1;
  if (!points->gave_up || m->remote) return first + bad;
  make_batch(&batch, points, first, count, strain, stress);
  update_one_by_one(points, m, &batch, first, strain);
  return -1;
}

int64_t points_update(Points *points, int64_t first, int count, double *const strain[6], double *const stress[6])
{
  if (!points->initial[0]) return update_rows(points, first, count, strain, stress);
  _Alignas(64) double whole[6][BATCH];
  double *at[6];
  for (int k = 0; k < 6; ++k) {
    at[k] = whole[k];
    for (int i = 0; i < count; ++i) whole[k][i] = strain[k][i] + points->initial[k][first + i];
  }
  const int64_t bad = update_rows(points, first, count, at, stress);
  for (int i = 0; i < count && points->plane_stress; ++i) strain[ZZ][i] = whole[ZZ][i] - points->initial[ZZ][first + i];
  return bad;
}

static bool has_stresses_to_keep(const Points *points)
{
  return points->components == 6 && !points->shares && !points_are_linear(points);
}

size_t points_kept_bytes(const Points *points)
{
  return has_stresses_to_keep(points) ? 6 * sizeof(double) * (size_t)points->count : 0;
}

int points_keep_stresses(Points *points, bool keep, Error *error)
{
  const bool wanted = keep && has_stresses_to_keep(points);
  for (int k = 0; k < 6; ++k) {
    if (!wanted)
      places_free(&points->stress_before[k]);
    else if (!points->stress_before[k] && !(points->stress_before[k] = places_array(points->count, "stresses", error)))
      return BRECCIA_FAILURE;
  }
  return BRECCIA_OK;
}

void points_put_by(Points *points)
{
  for (int k = 0; k < 6 && points->stress_before[5]; ++k) {
    double *stress = points->stress[k];
    points->stress[k] = points->stress_before[k];
    points->stress_before[k] = stress;
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
  update_batch(points, m, &one, at);
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
  const double *kept = points->tangent ? kept_tangent(points, n, row) : NULL;
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
  const double *kept = kept_tangent(points, n, first), w = points->elastic_weight;
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

/* ---- points tried out ---- */

/** Stress of a point of one strain, from a history; one that gives up carries nothing and keeps its history.
 *  @param[out] to  [MOST_VALUES] the history that follows */
static double stress_from(const Points *points, int64_t row, const double *from, double strain, double *to,
                          double *tangent)
{
  const Material *m = points_material(points, row);
  double stress = NAN, *const at[1] = {&strain}, *const out[1] = {&stress};
  breccia_batch batch;
  make_batch(&batch, points, row, 1, at, out);
  batch.committed = from;
  batch.trial = to;
  batch.tangent = tangent;
  memcpy(to, from, sizeof(double) * (size_t)m->history_values);
  if (m->law->update(m->constants, &batch) < 0) return stress;
  memcpy(to, from, sizeof(double) * (size_t)m->history_values);
  if (tangent) *tangent = 0;
  return 0;
}

double points_try(const Points *points, int64_t row, double strain, double *tangent)
{
  const Material *m = points_material(points, row);
  const double *history = points_history(points, row);
  double scratch[MOST_VALUES], stress = NAN;
  if (m->remote) {
    stress = point_servers_last_stress(history);
    if (tangent) *tangent = strain != 0 ? stress / strain : material_young(m);
  } else if (m->history_values <= MOST_VALUES) {
    stress = stress_from(points, row, history, strain, scratch, tangent);
  }
  if (tangent && points->secants && *tangent < 0 && strain * stress > 0) *tangent = stress / strain;
  if (tangent && points->elastic_weight > 0)
    *tangent = (1 - points->elastic_weight) * *tangent + points->elastic_weight * material_young(m);
  return stress;
}

bool points_try_stress(const Points *points, int64_t row, const double strain[6], double stress[6])
{
  const Material *m = points_material(points, row);
  double whole[6], scratch[MOST_VALUES], *at[6], *to[6];
  if (m->remote || m->history_values > MOST_VALUES) return false;
  for (int k = 0; k < 6; ++k) {
    whole[k] = strain[k] + (points->initial[k] ? points->initial[k][row] : 0);
    at[k] = &whole[k];
    to[k] = &stress[k];
  }
  breccia_batch batch;
  make_batch(&batch, points, row, 1, at, to);
  batch.trial = scratch;
  batch.tangent = NULL;
  if (m->history_values) memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
  return update_batch(points, m, &batch, at) < 0;
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
  if (m->remote || m->law->linear || m->history_values > MOST_VALUES) return 1;
  double strain[6], before[6], after[6], scratch[MOST_VALUES], square = 0, mean = 0, stiffest = 0;
  double *at[6], *to[6];
  for (int k = 0; k < 6; ++k) {
    at[k] = &strain[k];
    to[k] = &after[k];
    before[k] = points->stress[k][row];
    square += before[k] * before[k] * (k < 3 ? 1 : 2);
  }
  for (int k = 0; k < 3; ++k) mean += before[k] / 3;
  breccia_batch batch;
  make_batch(&batch, points, row, 1, at, to);
  batch.trial = scratch;
  batch.tangent = NULL;
  /* A small step back and one ahead, elastically: damage is felt both ways, yielding one way. */
  for (int side = -1; side <= 1; side += 2) {
    const double step = side * 1e-3;
    double product = 0;
    for (int k = 0; k < 6; ++k) {
      const double deviator = k < 3 ? before[k] - mean : before[k];
      strain[k] = points->strain[k][row] + (points->initial[k] ? points->initial[k][row] : 0) +
                  step * (deviator / m->shear * (k < 3 ? 0.5 : 1) + (k < 3 ? mean / (3 * m->bulk) : 0));
    }
    if (m->history_values) memcpy(scratch, batch.committed, sizeof(double) * (size_t)m->history_values);
    if (m->law->update(m->constants, &batch) >= 0) continue;
    for (int k = 0; k < 6; ++k) product += before[k] * (after[k] - before[k]) * (k < 3 ? 1 : 2);
    if (square > 0) stiffest = fmax(stiffest, product / (step * square));
  }
  return stiffest > 0 ? 1 / fmin(1, stiffest) : 1;
}

double points_elastic_strain(const Points *points, int64_t row, double strain)
{
  const Material *m = points_material(points, row);
  if (m->remote || m->history_values > MOST_VALUES) return points_try(points, row, strain, NULL) == 0 ? 0 : strain;
  /* Unloaded from where the strain has led: from the history before it a law that flows would only flow less. */
  double here[MOST_VALUES], scratch[MOST_VALUES];
  const double stress = stress_from(points, row, points_history(points, row), strain, here, NULL);
  if (stress == 0) return 0;
  /* Steel that has yielded and is pushed back carries against its strain: that gives nothing of the way to unload. */
  const bool along = stress * strain > 0;
  const double back = 1e-3, step = along ? back * strain : back * stress / material_young(m);
  const double drop = stress - stress_from(points, row, here, strain - step, scratch, NULL);
  const double share = drop != 0 ? back * stress / drop : 0;
  if (along) return (share > 0 ? fmin(1, share) : 1) * strain;
  return share > 0 ? share * step / back : 0;
}

double points_elastic_share(const Points *points, int64_t row, double strain)
{
  return strain == 0 ? 1 : points_elastic_strain(points, row, strain) / strain;
}

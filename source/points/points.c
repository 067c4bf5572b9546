#include "points/points.h"

#include "base/team.h"
#include "base/tensor.h"
#include "constitutive/normal_lengths.h"
#include "points/points_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static breccia_place place_of_row(const Points *points, int64_t row)
{
  const PointPlaces *places = &points->places;
  breccia_place place = {.size = sizeof place};
  for (int k = 0; k < 2; ++k) place.particle[k] = places->particle[k][row];
  for (int k = 0; k < 3; ++k) {
    place.position[k] = places->position[k][row];
    if (places->direction[k]) place.direction[k] = places->direction[k][row];
  }
  return place;
}

static void begin_run(void *context, int64_t n)
{
  const Points *points = context;
  const PointsRun *run = &points->runs[n];
  const Material *m = &points->materials[run->material];
  for (int64_t i = 0; i < run->count; ++i) {
    const int64_t at = points->history_first[n] + i * m->history_values;
    if (m->law->begin_point && points->places.position[0]) {
      const breccia_place place = place_of_row(points, run->first + i);
      m->law->begin_point(m->constants, &place, points->committed + at);
      m->law->begin_point(m->constants, &place, points->trial + at);
    } else if (m->law->begin) {
      m->law->begin(m->constants, points->committed + at);
      m->law->begin(m->constants, points->trial + at);
    }
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
  static const StepClock still = {.time = 0};
  *points = (Points){.components = spec->components,
                     .plane_stress = spec->plane_stress,
                     .on_bonds = spec->on_bonds,
                     .takes_lateral = spec->takes_lateral,
                     .clock = spec->clock ? spec->clock : &still,
                     .materials = spec->materials,
                     .material_count = spec->material_count,
                     .run_count = spec->run_count,
                     .places = spec->places,
                     .strength = spec->strength};
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
    points->strain[k] = places_reserved(points->count, "strains", error);
    points->stress[k] = places_reserved(points->count, "stresses", error);
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

void points_note(const Points *points, int64_t row, int k, double value)
{
  double *at = points->committed + history_at(points, points_run(points, row), row) + k;
  if (*at == value) return;
  *at = value;
  untouched_leave(points, row);
}

void points_take_up(Points *points)
{
  if (points->history_size) memcpy(points->trial, points->committed, sizeof(double) * points->history_size);
  untouched_find(points);
}

int64_t points_take_lengths(Points *points)
{
  int64_t taken = 0;
  for (int64_t n = 0; n < points->run_count; ++n) {
    const Material *m = &points->materials[points->runs[n].material];
    if (!normal_lengths_give(m, NULL)) continue;
    for (int64_t i = 0; i < points->runs[n].count; ++i) {
      const int64_t at = points->history_first[n] + i * m->history_values;
      taken += normal_lengths_take(m, points->trial + at, points->committed + at);
    }
  }
  return taken;
}

void points_drop_lengths(Points *points)
{
  for (int64_t n = 0; n < points->run_count; ++n) {
    const Material *m = &points->materials[points->runs[n].material];
    for (int64_t i = 0; i < points->runs[n].count && normal_lengths_give(m, NULL); ++i)
      normal_lengths_drop(m, points->committed + points->history_first[n] + i * m->history_values);
  }
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

double *points_kept_tangent(const Points *points, int64_t n, int64_t row)
{
  const int64_t first = points->tangent_first[n];
  return first < 0 ? NULL : points->tangent + 36 * (first + row - points->runs[n].first);
}

/* Field by field into its place: made whole and copied, it cost more than the law of a bond. */
void points_make_batch(breccia_batch *batch, const Points *points, int64_t first, int count, double *const *strain,
                       double *const *stress)
{
  const int64_t run = points_run(points, first), row = history_at(points, run, first);
  const int components = points->components;
  batch->size = sizeof *batch;
  batch->count = count;
  batch->committed = points->committed + row;
  batch->trial = points->trial + row;
  batch->tangent = points->keeps_tangents ? points_kept_tangent(points, run, first) : NULL;
  batch->elastic_stage = points->clock->elastic_stage;
  batch->time = points->clock->time;
  batch->time_step = points->clock->time_step;
  batch->length = isnan(points->length[0]) ? NULL : points->length;
  batch->lateral = points->takes_lateral ? strain[1] : NULL;
  for (int k = 0; k < 2; ++k)
    batch->particle[k] = points->places.particle[k] ? points->places.particle[k] + first : NULL;
  for (int k = 0; k < 3; ++k) {
    batch->position[k] = points->places.position[k] ? points->places.position[k] + first : NULL;
    batch->direction[k] = points->places.direction[k] ? points->places.direction[k] + first : NULL;
  }
  for (int k = 0; k < 6; ++k) {
    batch->strain[k] = k < components ? strain[k] : NULL;
    batch->stress[k] = k < components ? stress[k] : NULL;
  }
}

/** Asks a law with factors s on its strength: stress = s law(strain / s), whose tangent is that of the law. */
static int ask_scaled(const Points *points, const Material *m, const breccia_batch *batch, int64_t first,
                      double *strain_zz)
{
  _Alignas(64) double scaled[6][BATCH], found[6][BATCH], lateral[BATCH];
  const double *strength = points->strength + first;
  breccia_batch inner = *batch;
  for (int k = 0; k < points->components; ++k) {
    for (int i = 0; i < batch->count; ++i) scaled[k][i] = batch->strain[k][i] / strength[i];
    inner.strain[k] = scaled[k];
    inner.stress[k] = found[k];
  }
  for (int i = 0; i < batch->count && batch->lateral; ++i) lateral[i] = batch->lateral[i] / strength[i];
  if (batch->lateral) inner.lateral = lateral;
  const int bad = strain_zz ? plane_stress_update(m, &inner, scaled[ZZ]) : material_update(m, &inner);
  for (int k = 0; k < points->components && bad < 0; ++k)
    for (int i = 0; i < batch->count; ++i) batch->stress[k][i] = strength[i] * found[k][i];
  for (int i = 0; i < batch->count && bad < 0 && strain_zz; ++i) strain_zz[i] = strength[i] * scaled[ZZ][i];
  return bad;
}

int points_ask_law(const Points *points, const Material *m, breccia_batch *batch, int64_t first, double *strain_zz)
{
  if (points->strength) return ask_scaled(points, m, batch, first, strain_zz);
  return strain_zz ? plane_stress_update(m, batch, strain_zz) : material_update(m, batch);
}

int points_update_batch(const Points *points, const Material *m, breccia_batch *batch, int64_t first,
                        double *const strain[6])
{
  return points_ask_law(points, m, batch, first, points->plane_stress && points->components == 6 ? strain[ZZ] : NULL);
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
    if (points_update_batch(points, m, &one, first + i, here) < 0) continue;
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
  points_make_batch(&batch, points, first, count, strain, stress);
  double *own = batch.trial;
  if (untouched_batch(points, material, first, count, &batch, trial)) {
    if (points_update_batch(points, m, &batch, first, strain) < 0) {
      untouched_keep(points, material, first, count, trial, own);
      return -1;
    }
    points_make_batch(&batch, points, first, count, strain, stress);
  }
  if (points->components == 1 && m->history_values <= 2) fetch_ahead(points, &batch, m->history_values);
  if (m->remote && points_ask_ahead(points)) return point_servers_answer(points, m, &batch, first);
  const int bad = points_update_batch(points, m, &batch, first, strain);
  if (bad < 0) return -1;
  if (!points->gave_up || m->remote) return first + bad;
  points_make_batch(&batch, points, first, count, strain, stress);
  update_one_by_one(points, m, &batch, first, strain);
  return -1;
}

static int64_t update_with_secants(Points *points, int64_t first, int count, double *const strain[6],
                                   double *const stress[6])
{
  const int64_t bad = update_rows(points, first, count, strain, stress);
  if (points->secants == SECANTS_OF_ALL && points->keeps_tangents)
    points_take_secants(points, first, count, strain, stress);
  return bad;
}

int64_t points_update(Points *points, int64_t first, int count, double *const strain[6], double *const stress[6])
{
  if (!points->initial[0]) return update_with_secants(points, first, count, strain, stress);
  _Alignas(64) double whole[6][BATCH];
  double *at[6];
  for (int k = 0; k < points->components; ++k) {
    at[k] = whole[k];
    for (int i = 0; i < count; ++i) whole[k][i] = points_whole_strain(points, first + i, k, strain[k][i]);
  }
  if (points->takes_lateral) at[1] = strain[1];
  const int64_t bad = update_with_secants(points, first, count, at, stress);
  for (int i = 0; i < count && points->plane_stress && points->components == 6; ++i)
    strain[ZZ][i] = whole[ZZ][i] - points->initial[ZZ][first + i];
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
  if (!wanted) points->exchanged = false;
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
  if (points->stress_before[5]) points->exchanged = !points->exchanged;
}

void points_put_back(Points *points)
{
  if (!points->exchanged) return;
  for (int k = 0; k < 6; ++k)
    memcpy(points->stress_before[k], points->stress[k], sizeof(double) * (size_t)points->count);
  points_put_by(points);
}

#include "constitutive/remote_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Calls for the row of every point of a slice whose law is remote, in a fixed order. */
typedef void (*RowVisit)(Points *points, const Material *m, int64_t slice, int64_t row, bool real, void *context);

static void each_row(Points *points, int64_t slice, RowVisit visit, void *context)
{
  const Family *f = points->family;
  const Material *m = &points->materials[points->material[slice]];
  if (points->where == POINTS_ON_PARTICLES) {
    for (int lane = 0; m->remote && lane < SLICE; ++lane)
      visit(points, m, slice, points->history_start[slice] + lane * m->history_values,
            f->particles->number[slice * SLICE + lane] >= 0, context);
    return;
  }
  if (points->where != POINTS_ON_BONDS) return;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const bool real = f->intact[slot] >> lane & 1;
      if (m->remote) visit(points, m, slice, points_bond_row(points, slice, slot, lane, false), real, context);
      const Material *partner =
          points->partner_values && slot >= f->stored[slice] ? points_partner(points, slot, lane) : NULL;
      if (partner && partner->remote)
        visit(points, partner, slice, points_bond_row(points, slice, slot, lane, true), real && partner != m, context);
    }
}

static void number_row(Points *points, const Material *m, int64_t slice, int64_t row, bool real, void *context)
{
  int64_t *counts = context; /* of points numbered so far, by material */
  (void)slice;
  const double id = real ? (double)counts[m - points->materials]++ : -1;
  points->committed[row] = points->trial[row] = id;
}

/** Whole slices go to a server, as equal in points as that allows; bonds are asked for by number, wherever they are.
 *  @param[in] before  [slices] points of a slice's material in slices before it */
static int divide(Points *points, int material, int64_t count, const int64_t *before, Error *error)
{
  const int servers = remote_servers(points->materials[material].remote);
  int64_t *starts = points->starts[material] = memory_zeroed((size_t)servers + 1, sizeof(int64_t), "servers", error);
  if (!starts) return BRECCIA_FAILURE;
  for (int n = 1; n <= servers; ++n) starts[n] = count;
  int32_t server = 0;
  for (int64_t s = 0; s < points->family->particles->slices; ++s) {
    if (points->material[s] != material) continue;
    while (server + 1 < servers && before[s] * servers >= count * (server + 1)) starts[++server] = before[s];
    points->server[s] = server;
  }
  return BRECCIA_OK;
}

int remote_points_create(Points *points, Error *error)
{
  const size_t slices = (size_t)points->family->particles->slices, materials = (size_t)points->material_count;
  size_t servers = 0;
  for (size_t k = 0; k < materials; ++k)
    if (points->materials[k].remote) servers += (size_t)remote_servers(points->materials[k].remote);
  if (!servers) return BRECCIA_OK;
  points->identity_size = 2 * servers;
  points->identity = memory_zeroed(points->identity_size, sizeof(double), "servers", error);
  points->starts = memory_zeroed(materials, sizeof(int64_t *), "servers", error);
  points->server = memory_zeroed(slices, sizeof(int32_t), "servers", error);
  int64_t *before = memory_zeroed(slices, sizeof(int64_t), "servers", error),
          *counts = memory_zeroed(materials, sizeof(int64_t), "servers", error);
  int status = points->identity && points->starts && points->server && before && counts ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int64_t s = 0; !status && s < (int64_t)slices; ++s) {
    before[s] = counts[points->material[s]];
    each_row(points, s, number_row, counts);
  }
  for (int k = 0; !status && k < points->material_count; ++k)
    if (points->materials[k].remote) status = divide(points, k, counts[k], before, error);
  free(before);
  free(counts);
  return status;
}

void remote_points_destroy(Points *points)
{
  for (int k = 0; points->starts && k < points->material_count; ++k) free(points->starts[k]);
  free(points->starts);
  free(points->server);
  free(points->identity);
}

void remote_points_commit(Points *points)
{
  for (int k = 0; points->server && k < points->material_count; ++k)
    if (points->starts[k]) remote_commit(points->materials[k].remote);
}

double remote_last_stress(const double *row)
{
  return row[2];
}

bool points_begun(const Points *points)
{
  for (int k = 0; points->server && k < points->material_count; ++k)
    if (points->starts[k] && !remote_begun(points->materials[k].remote)) return false;
  return true;
}

int points_begin(Points *points, Error *error)
{
  for (int k = 0; points->server && k < points->material_count; ++k) {
    const int status = points->starts[k] ? remote_begin(points->materials[k].remote, points->starts[k], error) : 0;
    if (status) return status;
  }
  return BRECCIA_OK;
}

/** Moves what servers save between rows of history and one array per material, by number of point. */
typedef struct States {
  double **of; /* [material_count] */
  bool in;
} States;

static void move_state(Points *points, const Material *m, int64_t slice, int64_t row, bool real, void *context)
{
  const States *states = context;
  const int values = remote_state_values(m->remote);
  const int64_t id = (int64_t)points->committed[row];
  (void)slice, (void)real;
  if (!values || id < 0) return;
  double *own = points->committed + row + remote_state_at(m->remote),
         *theirs = states->of[m - points->materials] + id * values;
  memcpy(states->in ? own : theirs, states->in ? theirs : own, sizeof(double) * (size_t)values);
}

static int states_create(const Points *points, States *states, Error *error)
{
  states->of = memory_zeroed((size_t)points->material_count, sizeof(double *), "states of servers", error);
  for (int k = 0; states->of && k < points->material_count; ++k) {
    if (!points->starts[k]) continue;
    const Remote *r = points->materials[k].remote;
    const size_t size = (size_t)points->starts[k][remote_servers(r)] * (size_t)remote_state_values(r);
    if (!(states->of[k] = memory_zeroed(size, sizeof(double), "states of servers", error))) return BRECCIA_FAILURE;
  }
  return states->of ? BRECCIA_OK : BRECCIA_FAILURE;
}

static void states_move(Points *points, States *states)
{
  for (int64_t s = 0; s < points->family->particles->slices; ++s) each_row(points, s, move_state, states);
}

static void states_destroy(const Points *points, States *states)
{
  for (int k = 0; states->of && k < points->material_count; ++k) free(states->of[k]);
  free(states->of);
}

int points_save(Points *points, Error *error)
{
  if (!points->server) return BRECCIA_OK;
  States states = {.in = true};
  int status = states_create(points, &states, error);
  double *identity = points->identity;
  for (int k = 0; !status && k < points->material_count; ++k) {
    if (!points->starts[k]) continue;
    Remote *r = points->materials[k].remote;
    status = remote_identify(r, identity, error);
    if (!status) status = remote_save(r, states.of[k], error);
    identity += 2 * remote_servers(r);
  }
  if (!status) states_move(points, &states);
  states_destroy(points, &states);
  return status;
}

int points_resume(Points *points, Error *error)
{
  if (!points->server) return BRECCIA_OK;
  States states = {.in = false};
  int status = states_create(points, &states, error);
  if (!status) states_move(points, &states);
  const double *identity = points->identity;
  for (int k = 0; !status && k < points->material_count; ++k) {
    if (!points->starts[k]) continue;
    Remote *r = points->materials[k].remote;
    status = remote_resume(r, points->starts[k], states.of[k], identity, error);
    identity += 2 * remote_servers(r);
  }
  states_destroy(points, &states);
  return status;
}

/* ---- a step, of points on particles ---- */

void points_pack(Points *points, int64_t first, int64_t last)
{
  const int k = points->material[first], server = points->server[first];
  const Material *m = &points->materials[k];
  double *to = remote_strains(m->remote, server);
  for (int64_t s = first; to && s < last; ++s)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t id = (int64_t)points->committed[points->history_start[s] + lane * m->history_values];
      for (int n = 0; id >= 0 && n < 6; ++n)
        to[6 * (id - points->starts[k][server]) + n] = points->strain[n][s * SLICE + lane];
    }
}

void points_post(Points *points, int material, int server)
{
  remote_post(points->materials[material].remote, server);
}

int64_t points_collect(Points *points, int material, int server)
{
  const Material *m = &points->materials[material];
  int64_t bad;
  if (remote_collect(m->remote, server, &bad)) return -1;
  for (int64_t s = 0; s < points->family->particles->slices; ++s)
    for (int lane = 0; points->material[s] == material && points->server[s] == server && lane < SLICE; ++lane)
      if (points->committed[points->history_start[s] + lane * m->history_values] ==
          (double)(points->starts[material][server] + bad))
        return s * SLICE + lane;
  return 0;
}

void points_unpack(Points *points, int64_t first, int64_t last)
{
  const int k = points->material[first], server = points->server[first];
  const Material *m = &points->materials[k];
  const double *from = remote_stresses(m->remote, server);
  for (int64_t s = first; s < last; ++s)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t row = points->history_start[s] + lane * m->history_values, id = (int64_t)points->committed[row];
      points->trial[row] = points->committed[row];
      double strain[6], stress[6];
      for (int n = 0; n < 6; ++n) {
        strain[n] = points->strain[n][s * SLICE + lane];
        stress[n] = id < 0 ? 0 : from ? from[6 * (id - points->starts[k][server]) + n] : NAN;
        points->stress[n][s * SLICE + lane] = stress[n];
      }
      remote_note(m->remote, points->trial + row, strain, stress);
    }
}

/* ---- a step, of points on bonds ---- */

void points_gather_bonds(Points *points)
{
  points->pass = PASS_NONE;
  if (points_begun(points) && !points->elastic_stage) points->pass = PASS_GATHER;
}

int64_t points_ask_bonds(Points *points)
{
  int64_t bad = 0, failed = -1;
  points->pass = PASS_ANSWER;
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < points->material_count; ++k)
      for (int n = 0; points->starts[k] && n < remote_servers(points->materials[k].remote); ++n)
        if (!pass)
          remote_post(points->materials[k].remote, n);
        else if (!remote_collect(points->materials[k].remote, n, &bad))
          failed = 0;
  return failed;
}

int remote_points_bonds(const Points *points, const Material *m, const breccia_batch *batch)
{
  if (points->pass == PASS_NONE) return m->law->update(m->constants, batch);
  const int64_t *starts = points->starts[m - points->materials];
  int server = 0;
  for (int i = 0; i < batch->count; ++i) {
    const ptrdiff_t row = (ptrdiff_t)m->history_values * i;
    const int64_t id = (int64_t)batch->committed[row];
    batch->stress[0][i] = 0;
    batch->trial[row] = batch->committed[row];
    if (id < 0) continue;
    while (id < starts[server]) --server;
    while (id >= starts[server + 1]) ++server;
    if (points->pass == PASS_GATHER) {
      double *to = remote_strains(m->remote, server);
      if (to) to[id - starts[server]] = batch->strain[0][i];
      continue;
    }
    const double *from = remote_stresses(m->remote, server);
    if (!from) return i;
    batch->stress[0][i] = from[id - starts[server]];
    remote_note(m->remote, batch->trial + row, &batch->strain[0][i], &batch->stress[0][i]);
  }
  return -1;
}

bool points_can_save(Points *points)
{
  const bool trouble = *points_problem(points);
  for (int k = 0; trouble && k < points->material_count; ++k) {
    Remote *r = points->starts[k] ? points->materials[k].remote : NULL;
    if (r && remote_state_values(r) && !remote_rescue(r)) return false;
  }
  return true;
}

void points_report(const Points *points, double run_seconds, bool json, Text *text)
{
  for (int k = 0; points->server && k < points->material_count; ++k)
    if (points->starts[k]) remote_report(points->materials[k].remote, run_seconds, json, text);
}

const char *points_problem(const Points *points)
{
  for (int k = 0; points->server && k < points->material_count; ++k)
    if (points->starts[k] && *remote_problem(points->materials[k].remote))
      return remote_problem(points->materials[k].remote);
  return "";
}

/* Points of laws that run in other processes: which server holds which, and what is sent and received. The history of such a point begins with
 * its number among those of its material, or -1 where there is none (constitutive/remote/remote.h); servers hold ranges of numbers. */
#include "points/points_parts.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct PointServers {
  int64_t *
      *starts; /* [materials], of each: first point of each of its servers, and behind the last; NULL: not remote */
  atomic_llong **left; /* [materials][servers] points whose strains are still to come */
  int64_t failed;      /* a row whose server did not answer, or -1 */
};

/** Calls for the history of every row of a remote law, in order. */
typedef void (*RowVisit)(Points *points, int material, int64_t row, int64_t history, void *context);

static void each_row(Points *points, RowVisit visit, void *context)
{
  for (int64_t n = 0; n < points->run_count; ++n) {
    const PointsRun *run = &points->runs[n];
    const Material *m = &points->materials[run->material];
    for (int64_t i = 0; m->remote && i < run->count; ++i)
      visit(points, run->material, run->first + i, points->history_first[n] + i * m->history_values, context);
  }
}

typedef struct Numbering {
  const uint8_t *present;
  int64_t *counts; /* [materials] */
} Numbering;

static void number_row(Points *points, int material, int64_t row, int64_t history, void *context)
{
  const Numbering *n = context;
  const double id = !n->present || n->present[row] ? (double)n->counts[material]++ : -1;
  points->committed[history] = points->trial[history] = id;
}

/** Divides the points of a material among its servers, as equally as can be. */
static int divide(Points *points, int material, int64_t count, Error *error)
{
  PointServers *s = points->servers;
  const int servers = remote_servers(points->materials[material].remote);
  s->starts[material] = memory_zeroed((size_t)servers + 1, sizeof(int64_t), "servers", error);
  s->left[material] = memory_zeroed((size_t)servers, sizeof(atomic_llong), "servers", error);
  if (!s->starts[material] || !s->left[material]) return BRECCIA_FAILURE;
  for (int n = 0; n <= servers; ++n) s->starts[material][n] = count * n / servers;
  for (int n = 0; n < servers; ++n)
    atomic_init(&s->left[material][n], s->starts[material][n + 1] - s->starts[material][n]);
  return BRECCIA_OK;
}

/** Room for the servers of materials that have points here: others belong to other points, as those of bars do.
 *  @param[in] counts  [materials] */
static int make_servers(Points *points, const int64_t *counts, Error *error)
{
  const size_t materials = (size_t)points->material_count;
  size_t servers = 0;
  for (size_t k = 0; k < materials; ++k)
    if (counts[k]) servers += (size_t)remote_servers(points->materials[k].remote);
  if (!servers) return BRECCIA_OK;
  points->identity_size = 2 * servers;
  points->identity = memory_zeroed(points->identity_size, sizeof(double), "servers", error);
  PointServers *s = points->servers = memory_zeroed(1, sizeof *s, "servers", error);
  if (!points->identity || !s) return BRECCIA_FAILURE;
  s->failed = -1;
  s->starts = memory_zeroed(materials, sizeof *s->starts, "servers", error);
  s->left = memory_zeroed(materials, sizeof *s->left, "servers", error);
  int status = s->starts && s->left ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; !status && k < points->material_count; ++k)
    if (counts[k]) status = divide(points, k, counts[k], error);
  return status;
}

int point_servers_create(Points *points, const uint8_t *present, Error *error)
{
  Numbering numbering = {present,
                         memory_zeroed((size_t)points->material_count, sizeof *numbering.counts, "servers", error)};
  if (!numbering.counts) return BRECCIA_FAILURE;
  each_row(points, number_row, &numbering);
  const int status = make_servers(points, numbering.counts, error);
  free(numbering.counts);
  return status;
}

void point_servers_destroy(Points *points)
{
  PointServers *s = points->servers;
  for (int k = 0; s && k < points->material_count; ++k) {
    if (s->starts) free(s->starts[k]);
    if (s->left) free(s->left[k]);
  }
  if (s) {
    free(s->starts);
    free(s->left);
  }
  free(s);
  free(points->identity);
}

/** The remote law of a material that has points in servers, or NULL. */
static Remote *remote_of(const Points *points, int material)
{
  return points->servers && points->servers->starts[material] ? points->materials[material].remote : NULL;
}

void point_servers_commit(Points *points)
{
  for (int k = 0; k < points->material_count; ++k)
    if (remote_of(points, k)) remote_commit(remote_of(points, k));
}

double point_servers_last_stress(const double *row)
{
  return row[2];
}

static bool begun(const Points *points)
{
  for (int k = 0; k < points->material_count; ++k)
    if (remote_of(points, k) && !remote_begun(remote_of(points, k))) return false;
  return true;
}

int points_begin(Points *points, Error *error)
{
  int status = BRECCIA_OK;
  for (int k = 0; !status && k < points->material_count; ++k)
    if (remote_of(points, k)) status = remote_begin(remote_of(points, k), points->servers->starts[k], error);
  return status;
}

/** Server of a point; `guess` is that of the one before. */
static int server_of(const int64_t *starts, int64_t id, int guess)
{
  while (id < starts[guess]) --guess;
  while (id >= starts[guess + 1]) ++guess;
  return guess;
}

static void note_first(Points *points, int material, int64_t row, int64_t history, void *context)
{
  const int64_t id = (int64_t)points->committed[history], *starts = points->servers->starts[material];
  const Remote *r = points->materials[material].remote;
  const double strain = 0;
  (void)row, (void)context;
  if (id < 0) return;
  const int server = server_of(starts, id, 0);
  const double *stress = remote_stresses(r, server) + (id - starts[server]);
  remote_note(r, points->committed + history, &strain, stress);
  remote_note(r, points->trial + history, &strain, stress);
}

int points_ask_first_stresses(Points *points, Error *error)
{
  if (!points->servers || points->components != 1) return BRECCIA_OK;
  for (int k = 0; k < points->material_count; ++k) {
    Remote *r = remote_of(points, k);
    const int64_t *starts = points->servers->starts[k];
    for (int n = 0; r && n < remote_servers(r); ++n) {
      const int64_t count = starts[n + 1] - starts[n];
      double *strain = count ? remote_strains(r, n) : NULL;
      for (int64_t i = 0; strain && i < count; ++i) strain[i] = 0;
      if (count) remote_post(r, n);
    }
    for (int n = 0; r && n < remote_servers(r); ++n) {
      int64_t bad;
      if (starts[n + 1] > starts[n] && !remote_collect(r, n, &bad))
        return error_add(error, BRECCIA_FAILURE, "%s", remote_problem(r));
    }
  }
  each_row(points, note_first, NULL);
  return BRECCIA_OK;
}

/* ---- what servers save ---- */

/** Moves what servers save between histories and one array per material, by number of point. */
typedef struct States {
  double **of; /* [materials] */
  bool in;
} States;

static void move_state(Points *points, int material, int64_t row, int64_t history, void *context)
{
  const States *states = context;
  const Remote *r = points->materials[material].remote;
  const int values = remote_state_values(r);
  const int64_t id = (int64_t)points->committed[history];
  (void)row;
  if (!values || id < 0) return;
  double *own = points->committed + history + remote_state_at(r), *theirs = states->of[material] + id * values;
  memcpy(states->in ? own : theirs, states->in ? theirs : own, sizeof(double) * (size_t)values);
}

static int states_create(const Points *points, States *states, Error *error)
{
  states->of = memory_zeroed((size_t)points->material_count, sizeof(double *), "states of servers", error);
  for (int k = 0; states->of && k < points->material_count; ++k) {
    const Remote *r = remote_of(points, k);
    if (!r) continue;
    const size_t size = (size_t)points->servers->starts[k][remote_servers(r)] * (size_t)remote_state_values(r);
    if (!(states->of[k] = memory_zeroed(size, sizeof(double), "states of servers", error))) return BRECCIA_FAILURE;
  }
  return states->of ? BRECCIA_OK : BRECCIA_FAILURE;
}

static void states_destroy(const Points *points, States *states)
{
  for (int k = 0; states->of && k < points->material_count; ++k) free(states->of[k]);
  free(states->of);
}

int points_save(Points *points, Error *error)
{
  if (!points->servers) return BRECCIA_OK;
  States states = {.in = true};
  int status = states_create(points, &states, error);
  double *identity = points->identity;
  for (int k = 0; !status && k < points->material_count; ++k) {
    Remote *r = remote_of(points, k);
    if (!r) continue;
    status = remote_identify(r, identity, error);
    if (!status) status = remote_save(r, states.of[k], error);
    identity += 2 * remote_servers(r);
  }
  if (!status) each_row(points, move_state, &states);
  states_destroy(points, &states);
  return status;
}

int points_resume(Points *points, Error *error)
{
  if (!points->servers) return BRECCIA_OK;
  States states = {.in = false};
  int status = states_create(points, &states, error);
  if (!status) each_row(points, move_state, &states);
  const double *identity = points->identity;
  for (int k = 0; !status && k < points->material_count; ++k) {
    Remote *r = remote_of(points, k);
    if (!r) continue;
    status = remote_resume(r, points->servers->starts[k], states.of[k], identity, error);
    identity += 2 * remote_servers(r);
  }
  states_destroy(points, &states);
  return status;
}

/* ---- a step ---- */

bool points_ask_ahead(const Points *points)
{
  return points->servers && !points->clock->elastic_stage && !points->keeps_tangents &&
         !(points->plane_stress && points->components == 6) && begun(points);
}

/** So many strains more are with a server; the last ones send them all. */
static void count_down(PointServers *s, Remote *r, int material, int server, int64_t count)
{
  if (count && atomic_fetch_sub(&s->left[material][server], count) == count) remote_post(r, server);
}

void points_send(Points *points, int64_t first, int count, double *const strain[6])
{
  PointServers *s = points->servers;
  const int64_t n = points_run(points, first);
  const int material = points->runs[n].material, components = points->components;
  Remote *r = remote_of(points, material);
  if (!r) return;
  const int values = points->materials[material].history_values;
  const double *history = points_history(points, first);
  const int64_t *starts = s->starts[material];
  int server = 0;
  int64_t sent = 0;
  for (int i = 0; i < count; ++i) {
    const int64_t id = (int64_t)history[(ptrdiff_t)values * i];
    if (id < 0) continue;
    const int now = server_of(starts, id, server);
    if (now != server) {
      count_down(s, r, material, server, sent);
      sent = 0;
      server = now;
    }
    double *to = remote_strains(r, server);
    for (int k = 0; to && k < components; ++k)
      to[components * (id - starts[server]) + k] = points_whole_strain(points, first + i, k, strain[k][i]);
    ++sent;
  }
  count_down(s, r, material, server, sent);
}

typedef struct Search {
  int material;
  int64_t id, row;
} Search;

static void find_row(Points *points, int material, int64_t row, int64_t history, void *context)
{
  Search *s = context;
  if (material == s->material && points->committed[history] == (double)s->id) s->row = row;
}

void points_await(Points *points)
{
  PointServers *s = points->servers;
  s->failed = -1;
  for (int k = 0; k < points->material_count; ++k) {
    Remote *r = remote_of(points, k);
    for (int n = 0; r && n < remote_servers(r); ++n) {
      const int64_t count = s->starts[k][n + 1] - s->starts[k][n];
      int64_t bad = 0;
      if (!count) continue;
      atomic_store(&s->left[k][n], count);
      if (remote_collect(r, n, &bad)) continue;
      Search search = {k, s->starts[k][n] + bad, 0};
      each_row(points, find_row, &search);
      s->failed = search.row;
    }
  }
}

int64_t point_servers_answer(const Points *points, const Material *m, const breccia_batch *batch, int64_t first)
{
  const PointServers *s = points->servers;
  const int64_t *starts = s->starts[m - points->materials];
  const int components = points->components;
  int server = 0;
  int64_t failed = -1;
  for (int i = 0; i < batch->count; ++i) {
    const ptrdiff_t row = (ptrdiff_t)m->history_values * i;
    const int64_t id = (int64_t)batch->committed[row];
    double strain[6], stress[6] = {0};
    const double *from = NULL;
    batch->trial[row] = batch->committed[row];
    if (id >= 0) {
      server = server_of(starts, id, server);
      from = remote_stresses(m->remote, server);
      if (!from) failed = s->failed >= 0 ? s->failed : first + i;
    }
    for (int k = 0; k < components; ++k) {
      strain[k] = batch->strain[k][i];
      stress[k] = id < 0 ? 0 : from ? from[components * (id - starts[server]) + k] : NAN;
      batch->stress[k][i] = stress[k];
    }
    remote_note(m->remote, batch->trial + row, strain, stress);
  }
  return failed;
}

bool points_can_save(Points *points)
{
  const bool trouble = *points_problem(points);
  for (int k = 0; trouble && k < points->material_count; ++k) {
    Remote *r = remote_of(points, k);
    if (r && remote_state_values(r) && !remote_rescue(r)) return false;
  }
  return true;
}

void points_report(const Points *points, double run_seconds, bool json, Text *text)
{
  for (int k = 0; k < points->material_count; ++k)
    if (remote_of(points, k)) remote_report(remote_of(points, k), run_seconds, json, text);
}

const char *points_problem(const Points *points)
{
  for (int k = 0; k < points->material_count; ++k)
    if (remote_of(points, k) && *remote_problem(remote_of(points, k))) return remote_problem(remote_of(points, k));
  return "";
}

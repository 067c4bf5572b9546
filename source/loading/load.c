#include "loading/load.h"

#include "base/team.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_along(const DeckReader *reader, void *section)
{
  const AlongSpec *along = section;
  if (along->direction[0] == 0 && along->direction[1] == 0 && along->direction[2] == 0)
    node_error(reader->document, section_place(section, "direction"), reader->error, "direction: must not be zero");
}

static const Field along_fields[] = {
    {"direction", FIELD_POINT, offsetof(AlongSpec, direction), "1", NULL, NULL, "any length but zero", NULL, NULL, 0},
    {"displacement", FIELD_NUMBER, offsetof(AlongSpec, displacement), "length", "", NULL, "in that direction", NULL,
     NULL, 'A'},
    {"velocity", FIELD_NUMBER, offsetof(AlongSpec, velocity), "velocity", "", NULL, "in that direction", NULL, NULL,
     'A'},
};
static const Section along_section = {"along",
                                      "A motion in one direction; the particles stay free across it.",
                                      sizeof(AlongSpec),
                                      FIELDS(along_fields),
                                      check_along,
                                      NULL,
                                      NULL,
                                      0};

static void check_load(const DeckReader *reader, void *section)
{
  const LoadSpec *load = section;
  if (!load->on.node && isnan(load->gravity[0]))
    node_error(reader->document, load->head.node, reader->error, "load: missing key 'on': which particles are loaded");
}

static const Field load_fields[] = {
    {"name", FIELD_TEXT, offsetof(LoadSpec, name), NULL, "", NULL, "name, for watching what it applies", NULL, NULL, 0},
    {"on", FIELD_REFERENCE, offsetof(LoadSpec, on), NULL, "", NULL,
     "name of a selection, or a selection; gravity acts on the whole body when absent", &selection_section, NULL, 0},
    {"body force", FIELD_POINT, offsetof(LoadSpec, body_force), "force per volume", "", NULL, "force per volume", NULL,
     NULL, 'A'},
    {"force", FIELD_POINT, offsetof(LoadSpec, force), "force", "", NULL,
     "total force, shared among the particles by volume", NULL, NULL, 'A'},
    {"gravity", FIELD_POINT, offsetof(LoadSpec, gravity), "acceleration", "", NULL, "acceleration, times the density",
     NULL, NULL, 'A'},
    {"displacement", FIELD_FREE_POINT, offsetof(LoadSpec, displacement), "length", "", NULL, "prescribed displacement",
     NULL, NULL, 'A'},
    {"velocity", FIELD_FREE_POINT, offsetof(LoadSpec, velocity), "velocity", "", NULL, "prescribed velocity", NULL,
     NULL, 'A'},
    {"along", FIELD_SECTION, offsetof(LoadSpec, along), NULL, "", NULL, "motion prescribed in one direction only",
     &along_section, NULL, 'A'},
    {"history", FIELD_SECTION, offsetof(LoadSpec, history), NULL, "", NULL, "constant when absent", &history_section,
     NULL, 0},
};
const Section load_section = {"load",
                              "A force on some particles, or a motion prescribed to them.",
                              sizeof(LoadSpec),
                              FIELDS(load_fields),
                              check_load,
                              NULL,
                              NULL,
                              0};

static void add_constraints(Loading *loading, const Load *load)
{
  const LoadSpec *spec = load->spec;
  for (int kind = 0; kind < 2; ++kind) {
    const double *value = kind ? spec->velocity : spec->displacement;
    for (int k = 0; k < 3; ++k) {
      if (isnan(value[k])) continue;
      Constraint c = {.load = load, .value = value[k], .is_velocity = kind};
      c.direction[k] = 1;
      loading->constraints[loading->constraint_count++] = c;
    }
  }
  if (!spec->along) return;
  const double *d = spec->along->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  bool is_velocity = isnan(spec->along->displacement);
  loading->constraints[loading->constraint_count++] =
      (Constraint){.load = load,
                   .direction = {d[0] / length, d[1] / length, d[2] / length},
                   .value = is_velocity ? spec->along->velocity : spec->along->displacement,
                   .is_velocity = is_velocity};
}

/** Two motions of one particle must be at right angles, or they contradict each other. */
static int check_constraints(const Loading *loading, const Particles *particles, const DeckReader *reader)
{
  int status = BRECCIA_OK;
  uint8_t *marked = memory_zeroed((size_t)particles->places, 1, "prescribed motions", reader->error);
  if (!marked) return BRECCIA_FAILURE;
  for (int a = 0; a < loading->constraint_count; ++a) {
    const Constraint *first = &loading->constraints[a];
    memset(marked, 0, (size_t)particles->places);
    for (int64_t n = 0; n < first->load->selection.count; ++n) marked[first->load->selection.places[n]] = 1;
    for (int b = a + 1; b < loading->constraint_count; ++b) {
      const Constraint *second = &loading->constraints[b];
      if (first->load->behind <= second->load->first || second->load->behind <= first->load->first) continue;
      double cosine = 0;
      for (int k = 0; k < 3; ++k) cosine += first->direction[k] * second->direction[k];
      if (fabs(cosine) < 1e-9) continue;
      for (int64_t n = 0; n < second->load->selection.count; ++n) {
        int32_t place = second->load->selection.places[n];
        if (!marked[place]) continue;
        status =
            node_error(reader->document, second->load->spec->head.node, reader->error,
                       "load: particle %d at [%g, %g, %g] already moves as the load in line %d says, in a direction "
                       "that is not at right angles to this one",
                       particles->number[place], particles->position[0][place], particles->position[1][place],
                       particles->position[2][place], first->load->spec->head.node->line);
        break;
      }
    }
  }
  free(marked);
  return status;
}

/** In the plane nothing moves along z, in a bar along x only. */
static int check_directions(const LoadSpec *spec, int dimensions, const DeckReader *reader)
{
  const struct {
    const char *key;
    const double *value;
  } vectors[] = {{"body force", spec->body_force}, {"force", spec->force},
                 {"gravity", spec->gravity},       {"displacement", spec->displacement},
                 {"velocity", spec->velocity},     {"along", spec->along ? spec->along->direction : NULL}};
  for (int v = 0; v < 6; ++v)
    for (int k = dimensions; k < 3 && vectors[v].value; ++k)
      if (!isnan(vectors[v].value[k]) && vectors[v].value[k] != 0)
        return node_error(reader->document, section_place(spec, vectors[v].key), reader->error,
                          "%s: has a part along %c, but the body is %s", vectors[v].key, "xyz"[k],
                          dimensions == 2 ? "plane" : "a bar along x");
  return BRECCIA_OK;
}

static int create_load(Load *load, const Body *body, const DeckReader *reader, const SectionList *selections)
{
  static const Node everywhere = {.kind = NODE_MAP};
  SelectionSpec all = {.head = {NULL, &everywhere}, .layers = 1, .nearest = {NAN, NAN, NAN}, .all = true};
  Reference reference = load->spec->on;
  if (!reference.node) reference = (Reference){NULL, &all, &everywhere};
  int status = selection_create(&load->selection, body, reader, selections, &reference);
  if (!status) status = check_directions(load->spec, body->dimensions, reader);
  for (int64_t n = 0; n < load->selection.count; ++n) load->volume += body->particles.volume[load->selection.places[n]];
  return status;
}

/** Ends the loads of a name that began before a stage. @return how many */
static int end_loads(Loading *loading, const char *name, int64_t stage)
{
  int ended = 0;
  for (int k = 0; k < loading->count; ++k) {
    Load *load = &loading->loads[k];
    if (!load->spec->name || strcmp(load->spec->name, name) || load->first >= stage || load->behind <= stage) continue;
    load->behind = stage;
    ++ended;
  }
  return ended;
}

static int end_named(Loading *loading, const DeckReader *reader, const LoadStage *stage, int64_t number)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < stage->without->count; ++k)
    if (!end_loads(loading, stage->without->items[k], number))
      status = node_error(reader->document, section_place(stage->section, "without"), reader->error,
                          "without: no load that acts before this stage has the name '%s'; give it one with 'name:'",
                          stage->without->items[k]);
  return status;
}

/** Adds the loads of a list, from a stage on. */
static int add_loads(Loading *loading, const Body *body, const DeckReader *reader, const SectionList *specs,
                     int64_t stage, const SectionList *selections)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < specs->count; ++k) {
    const LoadSpec *spec = specs->items[k];
    if (spec->name) end_loads(loading, spec->name, stage);
    Load *load = &loading->loads[loading->count++];
    *load = (Load){.spec = spec, .first = stage, .behind = INT64_MAX};
    const int bad = create_load(load, body, reader, selections);
    if (bad) status = bad;
    const int before = loading->constraint_count;
    add_constraints(loading, load);
    for (int c = before; stage > 0 && c < loading->constraint_count; ++c)
      if (!(loading->constraints[c].from =
                memory_zeroed((size_t)load->selection.count, sizeof(double), "prescribed motions", reader->error)))
        return BRECCIA_FAILURE;
  }
  return status;
}

int loading_create(Loading *loading, const Body *body, const DeckReader *reader, const SectionList *loads,
                   const LoadStage *stages, int stage_count, const SectionList *selections)
{
  *loading = (Loading){0};
  size_t most = (size_t)loads->count;
  for (int s = 0; s < stage_count; ++s) most += (size_t)stages[s].loads->count;
  loading->loads = memory_zeroed(most, sizeof(Load), "loads", reader->error);
  loading->constraints = memory_zeroed(3 * most, sizeof(Constraint), "loads", reader->error);
  if (!loading->loads || !loading->constraints) return BRECCIA_FAILURE;
  int status = add_loads(loading, body, reader, loads, 0, selections);
  for (int s = 0; s < stage_count; ++s) {
    int bad = end_named(loading, reader, &stages[s], s);
    if (bad) status = bad;
    bad = add_loads(loading, body, reader, stages[s].loads, s, selections);
    if (bad) status = bad;
  }
  return status ? status : check_constraints(loading, &body->particles, reader);
}

void loading_destroy(Loading *loading)
{
  for (int k = 0; k < loading->count; ++k) selection_destroy(&loading->loads[k].selection);
  for (int c = 0; c < loading->constraint_count; ++c) free(loading->constraints[c].from);
  free(loading->loads);
  free(loading->constraints);
  *loading = (Loading){0};
}

void loading_enter(Loading *loading, int64_t stage)
{
  loading->stage = stage;
}

void loading_begin(Loading *loading, Particles *p, double time)
{
  for (int k = 0; k < loading->count; ++k)
    if (loading->loads[k].first == loading->stage) loading->loads[k].begin = time;
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    const Selection *selection = &constraint->load->selection;
    if (constraint->load->first != loading->stage || !constraint->from) continue;
    for (int64_t n = 0; n < selection->count; ++n) {
      constraint->from[n] = 0;
      for (int k = 0; k < 3; ++k)
        constraint->from[n] += p->displacement[k][selection->places[n]] * constraint->direction[k];
    }
  }
  for (int k = 0; k < 3; ++k) memset(p->external[k], 0, sizeof(double) * (size_t)p->places);
}

void loading_state(Loading *loading, StateList *list)
{
  char name[40];
  for (int k = 0; k < loading->count; ++k) {
    if (!loading->loads[k].first) continue;
    snprintf(name, sizeof name, "load %d begins", k);
    state_add_number(list, name, "time", STATE_COMMITTED, &loading->loads[k].begin);
  }
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (!constraint->from) continue;
    snprintf(name, sizeof name, "motion %d begins", c);
    state_add(list,
              &(StateRow){.unit = "length",
                          .kind = STATE_NUMBERS,
                          .role = STATE_COMMITTED,
                          .count = constraint->load->selection.count,
                          .values = constraint->from},
              name, NULL);
  }
}

double load_factor(const Load *load, double time)
{
  return history_factor(load->spec->history, time - load->begin);
}

static bool is_force(const LoadSpec *spec)
{
  bool any = false;
  for (int k = 0; k < 3; ++k) any |= !isnan(spec->body_force[k]) || !isnan(spec->force[k]) || !isnan(spec->gravity[k]);
  return any;
}

void loading_apply(const Loading *loading, Particles *p, double time)
{
  for (int l = 0; l < loading->count; ++l) { /* loads may overlap: clear first, then add */
    const Selection *selection = &loading->loads[l].selection;
    if (!is_force(loading->loads[l].spec) || !load_acts(loading, &loading->loads[l])) continue;
    TEAM_FOR (n, selection->count)
      for (int k = 0; k < 3; ++k) p->external[k][selection->places[n]] = 0;
  }
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    const LoadSpec *spec = load->spec;
    if (!is_force(spec) || !load_acts(loading, load)) continue;
    double factor = load_factor(load, time), uniform[3] = {0}, per_density[3] = {0};
    for (int k = 0; k < 3; ++k) {
      if (!isnan(spec->body_force[k])) uniform[k] = factor * spec->body_force[k];
      if (!isnan(spec->force[k])) uniform[k] = factor * spec->force[k] / load->volume;
      if (!isnan(spec->gravity[k])) per_density[k] = factor * spec->gravity[k];
    }
    TEAM_FOR (n, load->selection.count) {
      int32_t place = load->selection.places[n];
      for (int k = 0; k < 3; ++k) p->external[k][place] += uniform[k] + per_density[k] * p->density[place];
    }
  }
}

double constraint_displacement(const Constraint *constraint, double run_time)
{
  const HistorySpec *history = constraint->load->spec->history;
  const double time = run_time - constraint->load->begin;
  if (!constraint->is_velocity) return constraint->value * history_factor(history, time);
  if (!history || history->constant) return constraint->value * time;
  if (history->sine) {
    const double pi = acos(-1), omega = 2 * pi * history->sine->frequency, phase = history->sine->phase * pi / 180;
    return constraint->value * (cos(phase) - cos(omega * time + phase)) / omega;
  }
  /* Integral of the factor over its straight pieces. */
  double begin = 0, sum = 0;
  int corners = !isnan(history->ramp) ? 1 : history->table.count;
  for (int c = 0; c <= corners; ++c) {
    double end = c == corners ? time : !isnan(history->ramp) ? history->ramp : history->table.values[2 * c];
    end = fmin(time, fmax(begin, end));
    sum += (end - begin) * (history_factor(history, begin) + history_factor(history, end)) / 2;
    begin = end;
  }
  return constraint->value * sum;
}

void loading_mark_held(const Loading *loading, uint8_t *held)
{
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Selection *selection = &loading->constraints[c].load->selection;
    for (int64_t n = 0; n < selection->count; ++n) held[selection->places[n]] = 1;
  }
}

const char *load_kind(const LoadSpec *l, const char **dimension)
{
  const struct {
    const char *key, *dimension;
    const double *value;
  } kinds[] = {{"body force", "force per volume", l->body_force},
               {"force", "force", l->force},
               {"gravity", "acceleration", l->gravity},
               {"displacement", "length", l->displacement},
               {"velocity", "velocity", l->velocity}};
  int kind = l->along ? isnan(l->along->displacement) ? 4 : 3 : 4;
  for (int v = 0; v < 5 && !l->along; ++v)
    for (int k = 0; k < 3; ++k)
      if (!isnan(kinds[v].value[k])) kind = v;
  *dimension = kinds[kind].dimension;
  return kinds[kind].key;
}

double load_magnitude(const LoadSpec *l)
{
  const double *given[] = {l->body_force, l->force, l->gravity, l->displacement, l->velocity};
  double square = 0;
  for (int v = 0; v < 5; ++v)
    for (int k = 0; k < 3; ++k)
      if (!isnan(given[v][k])) square += given[v][k] * given[v][k];
  if (l->along) square = pow(isnan(l->along->displacement) ? l->along->velocity : l->along->displacement, 2);
  return sqrt(square);
}

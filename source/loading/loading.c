/* All loads of a run: those of its stages as they begin, act and end. */
#include "loading/load.h"

#include "base/team.h"
#include "loading/constraint.h"
#include "loading/one_sided.h"
#include "loading/platen.h"
#include "loading/tie.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
      status = node_error(reader->document, section_node(stage->section, "without"), reader->error,
                          "without: no load that acts before this stage has the name '%s'; give it one with 'name:'",
                          stage->without->items[k]);
  return status;
}

/** Adds the loads of a list, from a stage on. */
static int add_loads(const LoadMaking *making, const SectionList *specs, int64_t stage)
{
  Loading *loading = making->loading;
  int status = BRECCIA_OK;
  for (int k = 0; k < specs->count; ++k) {
    const LoadSpec *spec = specs->items[k];
    if (spec->name && stage > 0) end_loads(loading, spec->name, stage);
    Load *load = &loading->loads[loading->count++];
    *load = (Load){.first = stage, .behind = INT64_MAX, .applied = NAN};
    const int before = loading->constraint_count;
    const int bad = load_create(load, spec, making);
    if (bad) status = bad;
    for (int c = before; stage > 0 && c < loading->constraint_count; ++c)
      if (!(loading->constraints[c].from = memory_zeroed((size_t)load->selection.count, sizeof(double),
                                                         "prescribed motions", making->reader->error)))
        return BRECCIA_FAILURE;
  }
  return status;
}

/** Loads that have put particles outside the body: these would ride along while nobody moves them. */
static int check_lasting(const Loading *loading, const DeckReader *reader)
{
  int status = BRECCIA_OK;
  for (int k = 0; k < loading->count; ++k) {
    const Load *load = &loading->loads[k];
    if (!load->type || !load->type->lasting || (!load->first && load->behind == INT64_MAX)) continue;
    status =
        node_error(reader->document, load->node, reader->error,
                   "%s: its particles stand outside the body from the first stage to the last, so that it must act "
                   "all the while; let it begin with the run, and leave it out of 'without'",
                   load->node->key);
  }
  return status;
}

int loading_create(const LoadMaking *making, const SectionList *loads, const LoadStage *stages, int stage_count)
{
  Loading *loading = making->loading;
  const Particles *particles = &making->body->particles;
  const DeckReader *reader = making->reader;
  *loading = (Loading){0};
  size_t most = (size_t)loads->count;
  for (int s = 0; s < stage_count; ++s) most += (size_t)stages[s].loads->count;
  loading->loads = memory_zeroed(most, sizeof(Load), "loads", reader->error);
  loading->constraints = memory_zeroed(MAX_ROWS * most, sizeof(Constraint), "loads", reader->error);
  if (!loading->loads || !loading->constraints) return BRECCIA_FAILURE;
  int status = add_loads(making, loads, 0);
  for (int s = 0; s < stage_count; ++s) {
    int bad = end_named(loading, reader, &stages[s], s);
    if (bad) status = bad;
    bad = add_loads(making, stages[s].loads, s);
    if (bad) status = bad;
  }
  if (!status) status = check_lasting(loading, reader);
  if (!status) status = constraints_check(loading, particles, reader);
  if (!status) status = platens_create(making);
  if (!status) status = one_sided_create(making);
  return status ? status : ties_check(loading, particles, reader);
}

void loading_destroy(Loading *loading)
{
  for (int k = 0; k < loading->count; ++k) load_destroy(&loading->loads[k]);
  for (int c = 0; c < loading->constraint_count; ++c) {
    free(loading->constraints[c].from);
    free(loading->constraints[c].moved);
    free(loading->constraints[c].part);
    platen_destroy(loading->constraints[c].platen);
    one_sided_destroy(loading->constraints[c].one_sided);
  }
  free(loading->loads);
  free(loading->constraints);
  tie_groups_destroy(loading->ties);
  *loading = (Loading){0};
}

/** Axes along which motions of the stage under way are prescribed to particles of a load. */
static void find_held(const Loading *loading, const Load *load, const Particles *p)
{
  memset(load->held, 0, (size_t)load->selection.count);
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (!load_acts(loading, constraint->load)) continue;
    int axes = 0;
    for (int k = 0; k < 3; ++k) axes |= (constraint->direction[k] != 0) << k;
    if (constraint->row) continue;
    const Selection *a = &load->selection, *b = &constraint->load->selection;
    for (int64_t n = 0, m = 0; n < a->count && m < b->count;) { /* numbers ascend in both */
      if (a->places[n] == b->places[m] && !constraint_leads(constraint, m)) load->held[n] |= (uint8_t)axes;
      const bool next = p->number[a->places[n]] <= p->number[b->places[m]];
      n += next;
      m += !next;
    }
  }
}

int loading_enter(Loading *loading, const Particles *p, int64_t stage, Error *error)
{
  loading->stage = stage;
  for (int l = 0; l < loading->count; ++l)
    if (loading->loads[l].held) find_held(loading, &loading->loads[l], p);
  return tie_groups_make(loading, p, error);
}

static bool may_grow(const Load *load)
{
  return !load->spec->history && !load->type->timeless && !load->type->goes_on;
}

void loading_grow(Loading *loading, double time)
{
  for (int l = 0; l < loading->count; ++l)
    if (loading->loads[l].first == loading->stage && may_grow(&loading->loads[l]))
      loading->loads[l].history.grown = time;
}

static bool tied(const Loading *loading)
{
  return loading->ties[0].count || loading->ties[1].count || loading->ties[2].count;
}

/** Pages of external forces that nothing is written to take no memory. */
static void make_zero(double *value)
{
  if (*value != 0) *value = 0;
}

/** External forces as they stand when a stage begins: of loads that act already. Others come suddenly, or grow over the first increment. */
static void take_up_forces(const Loading *loading, Particles *p, double time)
{
  for (int k = 0; k < p->space.rows; ++k)
    for (int64_t i = 0; i < p->places; ++i) make_zero(&p->external.row[k][i]);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    const bool stays = load->first < loading->stage || load->type->goes_on;
    if (stays && load->type->force && load_acts(loading, load)) load->type->force(load, p, load_factor(load, time));
  }
}

void loading_begin(Loading *loading, Particles *p, double time)
{
  loading->speeds_set = false;
  bool ties = false;
  loading_move(loading, &(LoadMotion){0});
  for (int k = 0; k < loading->count; ++k) {
    Load *load = &loading->loads[k];
    if (load->first != loading->stage) continue;
    load->begin = time;
    if (load->type->begin && load->type->begin(load, p)) loading->speeds_set = true;
    ties |= load->type == &tie_load;
  }
  if (ties || (loading->speeds_set && tied(loading))) {
    tie_groups_join(loading->ties, p);
    loading->speeds_set = true;
  }
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    const Selection *selection = &constraint->load->selection;
    if (constraint->load->first != loading->stage) continue;
    one_sided_close(constraint);
    if (!constraint->from) continue;
    for (int64_t n = 0; n < selection->count; ++n) {
      constraint->from[n] = 0;
      for (int k = 0; k < 3; ++k) {
        const double *u = p->displacement.row[constraint->row + k];
        if (constraint->direction[k] == 0) continue;
        constraint->from[n] += u[selection->places[n]] * constraint->direction[k];
      }
      constraint->from[n] -= constraint_followed(constraint, p->displacement.row, n);
    }
  }
  take_up_forces(loading, p, time);
}

void loading_start_platens(Loading *loading, const Particles *p, double time, double step)
{
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (!constraint->platen || constraint->load->first != loading->stage || !(step > 0)) continue;
    platen_start(constraint, p, time, step);
    loading->speeds_set = true;
  }
}

void loading_state(Loading *loading, StateList *list)
{
  char name[40];
  for (int k = 0; k < loading->count; ++k) {
    Load *load = &loading->loads[k];
    snprintf(name, sizeof name, "load %d from", k);
    if (load->type->state) load->type->state(load, name, list);
    if (history_is_controlled(&load->history)) {
      snprintf(name, sizeof name, "load %d factor", k);
      state_add_number(list, name, "1", STATE_TRIED, &load->history.found);
      snprintf(name, sizeof name, "load %d most", k);
      state_add_number(list, name, "1", STATE_TRIED, &load->history.most);
    }
    if (may_grow(load)) {
      snprintf(name, sizeof name, "load %d grows over", k);
      state_add_number(list, name, "time", STATE_COMMITTED, &load->history.grown);
    }
    if (!loading->loads[k].first) continue;
    snprintf(name, sizeof name, "load %d begins", k);
    state_add_number(list, name, "time", STATE_COMMITTED, &loading->loads[k].begin);
  }
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (constraint->platen) {
      snprintf(name, sizeof name, "motion %d accelerates", c);
      state_add_number(list, name, "acceleration", STATE_TRIED, &constraint->platen->given);
    }
    snprintf(name, sizeof name, "motion %d", c);
    one_sided_state(constraint, name, list);
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

static void clear(const Selection *selection, Particles *p)
{
  TEAM_FOR (n, selection->count)
    for (int k = 0; k < p->space.rows; ++k) make_zero(&p->external.row[k][selection->places[n]]);
}

/** Loads may overlap: they are cleared first, then added. */
static void clear_all(const Loading *loading, Particles *p)
{
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if ((!load->type->force && !load->type->brake && load->type != &tie_load) || !load_acts(loading, load)) continue;
    clear(&load->selection, p);
    clear(&load->other, p);
  }
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Load *load = loading->constraints[c].load;
    if (loading->constraints[c].platen && load_acts(loading, load)) clear(&load->selection, p);
  }
}

void loading_apply_controlled(const Loading *loading, Particles *p)
{
  clear_all(loading, p);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->force && load_acts(loading, load) && history_is_controlled(&load->history))
      load->type->force(load, p, 1);
  }
}

void loading_apply_untied(const Loading *loading, Particles *p, double time)
{
  clear_all(loading, p);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->force && load_acts(loading, load)) load->type->force(load, p, load_factor(load, time));
  }
  for (int l = 0; l < loading->count; ++l) {
    Load *load = &loading->loads[l];
    if (load->type->brake && load->motion.velocity && load_acts(loading, load))
      load->type->brake(load, p, &load->motion, time - load->begin);
  }
}

void loading_apply(const Loading *loading, Particles *p, double time)
{
  loading_apply_untied(loading, p, time);
  tie_groups_push(loading->ties, p);
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Constraint *constraint = &loading->constraints[c];
    if (constraint->platen && load_acts(loading, constraint->load)) TEAM_SINGLE platen_push(constraint, p, time);
  }
}

/** Factor of the strains of a load, 0 where it does not act. */
static double strain_factor(const Loading *loading, const Load *load, double time)
{
  return load_acts(loading, load) ? load_factor(load, time) : 0;
}

static void clear_strains(const LoadStrains *strains)
{
  if (strains->of_places) memset(strains->of_places, 0, sizeof(double) * (size_t)strains->places);
  if (strains->of_bars) memset(strains->of_bars, 0, sizeof(double) * (size_t)strains->bar_count);
}

bool loading_strain(Loading *loading, const LoadStrains *strains, double time)
{
  bool same = true;
  for (int l = 0; l < loading->count; ++l)
    if (loading->loads[l].type->strain)
      same &= loading->loads[l].applied == strain_factor(loading, &loading->loads[l], time);
  if (same) return false;
  clear_strains(strains);
  for (int l = 0; l < loading->count; ++l) {
    Load *load = &loading->loads[l];
    if (!load->type->strain) continue;
    load->applied = strain_factor(loading, load, time);
    if (load->applied != 0) load->type->strain(load, strains, load->applied);
  }
  return true;
}

double loading_grown_factor(const Loading *loading, const Load *load, double time)
{
  if (load->first < loading->stage) return load_factor(load, time);
  return history_factor(&load->history, load->type->goes_on ? 0 : history_rise(&load->history));
}

void loading_grown_strains(const Loading *loading, const LoadStrains *strains, double time)
{
  clear_strains(strains);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->strain && load_acts(loading, load))
      load->type->strain(load, strains, loading_grown_factor(loading, load, time));
  }
}

/** Factor of the strains of a load when the stage under way began. */
static double factor_before(const Loading *loading, const Load *load, double begin)
{
  return load->first < loading->stage && load->behind >= loading->stage ? load_factor(load, begin) : 0;
}

void loading_changed_strains(const Loading *loading, const LoadStrains *strains, double begin, double time)
{
  clear_strains(strains);
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (!load->type->strain) continue;
    const double now = strain_factor(loading, load, time),
                 before = isnan(begin) ? 0 : factor_before(loading, load, begin);
    if (now != before) load->type->strain(load, strains, now - before);
  }
}

void loading_forget_strains(Loading *loading)
{
  for (int l = 0; l < loading->count; ++l) loading->loads[l].applied = NAN;
}

void loading_change(const Loading *loading, const Particles *p, double *const v[3], double *const change[3])
{
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->change && load_acts(loading, load)) load->type->change(load, p, v, change);
  }
}

void loading_keep_ties(const Loading *loading, Particles *p, double *const acceleration[3])
{
  tie_groups_keep(loading->ties, p, acceleration);
}

void loading_move(const Loading *loading, const LoadMotion *motion)
{
  for (int l = 0; l < loading->count; ++l) loading->loads[l].motion = *motion;
}

void loading_settle(const Loading *loading, const Particles *p, double *const moved[3], double factor)
{
  for (int l = 0; l < loading->count; ++l) {
    Load *load = &loading->loads[l];
    if (load->type->settle && load_acts(loading, load)) load->type->settle(load, p, moved, factor);
  }
}

double loading_dissipated(const Loading *loading)
{
  double sum = 0;
  for (int l = 0; l < loading->count; ++l)
    if (loading->loads[l].type->dissipated) sum += loading->loads[l].type->dissipated(&loading->loads[l]);
  return sum;
}

double loading_energy(const Loading *loading, const Particles *p)
{
  double sum = 0;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->energy && load_acts(loading, load)) sum += load->type->energy(load, p);
  }
  return sum;
}

double loading_eigenvalue(const Loading *loading, const Particles *p)
{
  double sum = 0;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    if (load->type->eigenvalue && load_acts(loading, load)) sum += load->type->eigenvalue(load, p);
  }
  return sum;
}

void loading_mark_held(const Loading *loading, uint8_t *held)
{
  for (int c = 0; c < loading->constraint_count; ++c) {
    const Selection *selection = &loading->constraints[c].load->selection;
    for (int64_t n = 0; n < selection->count; ++n) held[selection->places[n]] = 1;
  }
}

int loading_gravity_axis(const Loading *loading, double *sign)
{
  for (int k = 0; k < loading->count; ++k) {
    if (loading->loads[k].type != &gravity_load) continue;
    const double *gravity = loading->loads[k].spec->of[LOAD_gravity].point;
    int axis = 0;
    for (int r = 1; r < 3; ++r)
      if (fabs(gravity[r]) > fabs(gravity[axis])) axis = r;
    *sign = gravity[axis] > 0 ? -1 : 1;
    return axis;
  }
  return -1;
}

double loading_strength_reduction(const Loading *loading, int64_t stage, double time)
{
  double factor = 1;
  for (int k = 0; k < loading->count; ++k) {
    const Load *load = &loading->loads[k];
    if (load->type != &strength_reduction_load || !load_acts_in(load, stage)) continue;
    factor *= load_value(load->spec, load_factor(load, time));
  }
  return factor;
}

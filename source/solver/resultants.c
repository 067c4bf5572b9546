#include "solver/resultants.h"

#include "base/memory.h"
#include "solver/reactions.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct Resultants {
  Reactions reactions;  /* work arrays */
  double (*now)[3];     /* [loads] work array */
  double (*largest)[3]; /* [loads] */
  double *time;         /* [loads] of the largest */
};

/** Returns true if the resultant depends on how the body moves. */
static bool resultants_keeps(const Loading *loading, const Load *load)
{
  bool holds = load->type->exerts != NULL;
  for (int c = 0; c < loading->constraint_count; ++c) holds |= loading->constraints[c].load == load;
  return holds;
}

static bool resultants_keeps_any(const Loading *loading)
{
  bool any = false;
  for (int l = 0; l < loading->count; ++l) any |= resultants_keeps(loading, &loading->loads[l]);
  return any;
}

int resultants_create(Solver *s, Error *error)
{
  if (!resultants_keeps_any(s->loading)) return BRECCIA_OK;
  Resultants *r = s->resultants = memory_zeroed(1, sizeof *r, "resultant forces", error);
  const size_t loads = (size_t)s->loading->count;
  if (!r) return BRECCIA_FAILURE;
  r->now = memory_zeroed(loads, sizeof *r->now, "resultant forces", error);
  r->largest = memory_zeroed(loads, sizeof *r->largest, "resultant forces", error);
  r->time = memory_zeroed(loads, sizeof *r->time, "resultant forces", error);
  if (!r->now || !r->largest || !r->time) return BRECCIA_FAILURE;
  return reactions_create(&r->reactions, s->domain->particles, error);
}

void resultants_destroy(Solver *s)
{
  Resultants *r = s->resultants;
  if (!r) return;
  reactions_destroy(&r->reactions);
  free(r->now);
  free(r->largest);
  free(r->time);
  free(r);
  s->resultants = NULL;
}

void resultants_state(Solver *s, StateList *list)
{
  const Resultants *r = s->resultants;
  const int64_t loads = s->loading->count;
  if (!r) return;
  state_add(list, &(StateRow){.unit = "force", .role = STATE_COMMITTED, .count = 3 * loads, .values = r->largest},
            "largest resultants", NULL);
  state_add(list, &(StateRow){.unit = "time", .role = STATE_COMMITTED, .count = loads, .values = r->time},
            "times of largest resultants", NULL);
}

/** Finds what supports, prescribed motions, springs and dashpots exert; 0 of other loads.
 *  @param[out] now  [loads] */
static void resultants_of_motions(const Solver *s, double (*now)[3])
{
  const Loading *loading = s->loading;
  reactions_of_each(&s->resultants->reactions, s, now);
  for (int l = 0; l < loading->count; ++l) {
    Load *load = &loading->loads[l];
    const bool drags = !(load->type->brake && s->type->rests); /* nothing moves at rest */
    if (load->type->exerts && load_acts(loading, load) && drags)
      load->type->exerts(load, s->domain->particles, s->clock.time - load->begin, now[l]);
  }
}

static double resultants_size(const double force[3])
{
  return sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

/** Returns true if a force is larger than the largest so far, and not by round-off alone. */
static bool resultants_is_larger(const double now[3], const double largest[3])
{
  const double roundoff = 1e-9;
  return resultants_size(now) > (1 + roundoff) * resultants_size(largest);
}

int64_t resultants_interval(const Solver *s)
{
  return reactions_of_each_ask_bonds(s->loading) ? 10 : 1;
}

void resultants_note(Solver *s)
{
  const int64_t every = resultants_interval(s);
  Resultants *r = s->resultants;
  if (!r || (!s->type->few_steps && !s->clock.ended && s->clock.step % every)) return;
  resultants_of_motions(s, r->now);
  for (int l = 0; l < s->loading->count; ++l) {
    if (!resultants_is_larger(r->now[l], r->largest[l])) continue;
    memcpy(r->largest[l], r->now[l], sizeof r->now[l]);
    r->time[l] = s->clock.time;
  }
}

int resultants_largest_at(const Solver *s, double time)
{
  const double roundoff = 1e-6; /* of the largest resultant: below, a load carries nothing, at whatever time */
  const Resultants *r = s->resultants;
  int found = -1;
  double largest = 0;
  for (int l = 0; r && l < s->loading->count; ++l) largest = fmax(largest, resultants_size(r->largest[l]));
  for (int l = 0; r && l < s->loading->count; ++l) {
    const Load *load = &s->loading->loads[l];
    if (!load_acts(s->loading, load) || !(resultants_size(r->largest[l]) > roundoff * largest) || r->time[l] != time)
      continue;
    if (load->spec->name) return l;
    if (found < 0) found = l;
  }
  return found;
}

double resultants_peak_factor(const Solver *s, const Load *load)
{
  if (load->first > s->clock.stage) return 0;
  const double end = load->behind <= s->clock.stage ? s->records[load->behind - 1].end : s->clock.time;
  return history_peak(&load->history, end - load->begin);
}

/** Adds the forces on some places, and takes them off there. */
static void resultants_collect(const Selection *selection, const Particles *p, double sum[3])
{
  for (int64_t n = 0; n < selection->count; ++n)
    for (int k = 0; k < 3; ++k) {
      const int32_t i = selection->places[n];
      sum[k] += p->volume[i] * p->external.row[k][i];
      p->external.row[k][i] = 0;
    }
}

/** Finds the resultants of loads of forces from their resultant at factor 1.
 *  @param[in,out] scratch  the particles with other external forces, 0 everywhere */
static void resultants_of_factors(const Solver *s, Particles *scratch, Resultant *list)
{
  for (int l = 0; l < s->loading->count; ++l) {
    const Load *load = &s->loading->loads[l];
    const bool acts = load_acts(s->loading, load);
    double unit[3] = {0};
    if (!load->type->force || load->type->exerts) continue;
    list[l].exerts = true;
    if (load->first > s->clock.stage) continue;
    load->type->force(load, scratch, 1);
    resultants_collect(&load->selection, scratch, unit);
    resultants_collect(&load->other, scratch, unit);
    for (int k = 0; k < 3; ++k) {
      list[l].largest[k] = resultants_peak_factor(s, load) * unit[k];
      list[l].now[k] = acts ? load_factor(load, s->clock.time) * unit[k] : 0;
    }
  }
}

int resultants_find(const Solver *s, Resultant *list, Error *error)
{
  const Resultants *r = s->resultants;
  Particles scratch = *s->domain->particles;
  const bool failed = !vector_reserve(&scratch.external, &s->domain->particles->space, "resultant forces", error);
  for (int l = 0; l < s->loading->count; ++l) list[l] = (Resultant){.time = NAN};
  if (!failed) resultants_of_factors(s, &scratch, list);
  vector_destroy(&scratch.external);
  if (failed) return BRECCIA_FAILURE;
  if (!r) return BRECCIA_OK;
  resultants_of_motions(s, r->now);
  for (int l = 0; l < s->loading->count; ++l) {
    const double *now = r->now[l];
    if (!resultants_keeps(s->loading, &s->loading->loads[l])) continue;
    const bool grown = resultants_is_larger(now, r->largest[l]); /* between two steps that are looked at */
    list[l].exerts = true;
    list[l].time = grown ? s->clock.time : r->time[l];
    memcpy(list[l].now, now, sizeof list[l].now);
    memcpy(list[l].largest, grown ? now : r->largest[l], sizeof list[l].largest);
  }
  return BRECCIA_OK;
}

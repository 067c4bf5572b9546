#include "loading/tie.h"

#include "base/team.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- groups ---- */

static int32_t root_of(int32_t *parent, int32_t place)
{
  while (parent[place] != place) place = parent[place] = parent[parent[place]];
  return place;
}

/** Joins what the ties of a stage join along an axis; roots are the lowest places. @return how many particles are tied */
static int64_t join_all(const Loading *loading, int axis, int32_t *parent, uint8_t *tied)
{
  int64_t count = 0;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    const Tie *tie = load->type == &tie_load ? load->own : NULL;
    if (!tie || !tie->along[axis] || !load_acts(loading, load)) continue;
    for (int64_t n = 0; n < load->selection.count; ++n) {
      const int32_t ends[] = {load->selection.places[n], tie->masters[n]};
      const int32_t a = root_of(parent, ends[0]), b = root_of(parent, ends[1]);
      parent[a > b ? a : b] = a > b ? b : a;
      for (int e = 0; e < 2; ++e) {
        count += !tied[ends[e]];
        tied[ends[e]] = 1;
      }
    }
  }
  return count;
}

/** Lists the tied particles group by group. */
static int list_groups(TieGroups *groups, int32_t *parent, const uint8_t *tied, int64_t places, int64_t count,
                       Error *error)
{
  int32_t *number = memory_zeroed((size_t)places, sizeof *number, "ties", error);
  groups->first = memory_zeroed((size_t)count + 1, sizeof *groups->first, "ties", error);
  groups->places = memory_zeroed((size_t)count, sizeof *groups->places, "ties", error);
  const bool failed = !number || !groups->first || !groups->places;
  for (int32_t i = 0; !failed && i < places; ++i) {
    if (!tied[i]) continue;
    const int32_t root = root_of(parent, i); /* it is no higher than i, and so has its number */
    if (root == i) number[i] = (int32_t)groups->count++;
    ++groups->first[number[root] + 1];
  }
  for (int64_t g = 0; !failed && g < groups->count; ++g) groups->first[g + 1] += groups->first[g];
  for (int32_t i = 0; !failed && i < places; ++i)
    if (tied[i]) groups->places[groups->first[number[root_of(parent, i)]]++] = i;
  for (int64_t g = groups->count; !failed && g > 0; --g) groups->first[g] = groups->first[g - 1];
  if (!failed) groups->first[0] = 0;
  free(number);
  return failed ? BRECCIA_FAILURE : BRECCIA_OK;
}

void tie_groups_destroy(TieGroups groups[3])
{
  for (int k = 0; k < 3; ++k) {
    free(groups[k].first);
    free(groups[k].places);
    groups[k] = (TieGroups){0};
  }
}

int tie_groups_make(Loading *loading, const Particles *p, Error *error)
{
  bool any = false;
  tie_groups_destroy(loading->ties);
  for (int l = 0; l < loading->count; ++l)
    any |= loading->loads[l].type == &tie_load && load_acts(loading, &loading->loads[l]);
  if (!any) return BRECCIA_OK;
  int32_t *parent = memory_zeroed((size_t)p->places, sizeof *parent, "ties", error);
  uint8_t *tied = memory_zeroed((size_t)p->places, 1, "ties", error);
  int status = parent && tied ? BRECCIA_OK : BRECCIA_FAILURE;
  for (int k = 0; k < 3 && !status; ++k) {
    for (int32_t i = 0; i < p->places; ++i) parent[i] = i;
    memset(tied, 0, (size_t)p->places);
    const int64_t count = join_all(loading, k, parent, tied);
    if (count) status = list_groups(&loading->ties[k], parent, tied, p->places, count, error);
  }
  free(parent);
  free(tied);
  return status;
}

/* ---- what contradicts ---- */

static int check_pairs(const Load *load, const Constraint *held, const uint8_t *marked, const Particles *p,
                       const DeckReader *reader)
{
  const Tie *tie = load->own;
  bool meets = false;
  for (int k = 0; k < 3; ++k) meets |= tie->along[k] && fabs(held->direction[k]) > 1e-9;
  for (int64_t n = 0; meets && n < load->selection.count; ++n) {
    const int32_t a = load->selection.places[n], b = tie->masters[n];
    if (marked[a] && held->platen)
      return node_error(reader->document, load->node, reader->error,
                        "tie: particle %d at [%g, %g, %g] is under a platen that turns, that of the load in line %d; "
                        "let it be 'platen: fixed', or leave this particle out of the tie",
                        p->number[a], p->position[0][a], p->position[1][a], p->position[2][a],
                        held->load->spec->head.node->line);
    if ((marked[a] || marked[b]) && held->one_sided)
      return node_error(reader->document, load->node, reader->error,
                        "tie: particle %d at [%g, %g, %g] is under a support that only presses, that of the load in "
                        "line %d; leave 'only presses' out, or leave this particle out of the tie",
                        p->number[marked[a] ? a : b], p->position[0][marked[a] ? a : b],
                        p->position[1][marked[a] ? a : b], p->position[2][marked[a] ? a : b],
                        held->load->spec->head.node->line);
    if (marked[a] == marked[b]) continue;
    const int32_t bad = marked[a] ? a : b;
    return node_error(reader->document, load->node, reader->error,
                      "tie: particle %d at [%g, %g, %g] is moved or held by the load in line %d, and the one it is "
                      "tied to is not; let that load act on both, or leave this particle out of the tie",
                      p->number[bad], p->position[0][bad], p->position[1][bad], p->position[2][bad],
                      held->load->spec->head.node->line);
  }
  return BRECCIA_OK;
}

int ties_check(const Loading *loading, const Particles *p, const DeckReader *reader)
{
  int status = BRECCIA_OK;
  uint8_t *marked = memory_zeroed((size_t)p->places, 1, "ties", reader->error);
  if (!marked) return BRECCIA_FAILURE;
  for (int l = 0; l < loading->count; ++l) {
    const Load *load = &loading->loads[l];
    for (int c = 0; load->type == &tie_load && c < loading->constraint_count; ++c) {
      const Constraint *held = &loading->constraints[c];
      const Selection *selection = &held->load->selection;
      if (load->behind <= held->load->first || held->load->behind <= load->first) continue;
      for (int64_t n = 0; n < selection->count; ++n) marked[selection->places[n]] = 1;
      if (check_pairs(load, held, marked, p, reader)) status = BRECCIA_USER_ERROR;
      for (int64_t n = 0; n < selection->count; ++n) marked[selection->places[n]] = 0;
    }
  }
  free(marked);
  return status;
}

/* ---- motion ---- */

void tie_groups_push(const TieGroups groups[3], Particles *p)
{
  for (int k = 0; k < 3; ++k) {
    if (!groups[k].count) continue;
    TEAM_FOR (g, groups[k].count) {
      double force = 0, mass = 0;
      for (int64_t n = groups[k].first[g]; n < groups[k].first[g + 1]; ++n) {
        const int32_t i = groups[k].places[n];
        force += (p->internal.row[k][i] + p->external.row[k][i]) * p->volume[i];
        mass += p->density[i] * p->volume[i];
      }
      for (int64_t n = groups[k].first[g]; n < groups[k].first[g + 1]; ++n) {
        const int32_t i = groups[k].places[n];
        p->external.row[k][i] = p->density[i] * (force / mass) - p->internal.row[k][i];
      }
    }
  }
}

void tie_groups_keep(const TieGroups groups[3], Particles *p, double *const acceleration[3])
{
  for (int k = 0; k < 3; ++k) {
    if (!groups[k].count) continue;
    TEAM_FOR (g, groups[k].count) {
      const int32_t one = groups[k].places[groups[k].first[g]];
      for (int64_t n = groups[k].first[g]; n < groups[k].first[g + 1]; ++n) {
        p->velocity.row[k][groups[k].places[n]] = p->velocity.row[k][one];
        acceleration[k][groups[k].places[n]] = acceleration[k][one];
      }
    }
  }
}

void tie_groups_join(const TieGroups groups[3], Particles *p)
{
  for (int k = 0; k < 3; ++k)
    for (int64_t g = 0; g < groups[k].count; ++g) {
      double momentum = 0, mass = 0;
      for (int64_t n = groups[k].first[g]; n < groups[k].first[g + 1]; ++n) {
        const int32_t i = groups[k].places[n];
        momentum += p->density[i] * p->volume[i] * p->velocity.row[k][i];
        mass += p->density[i] * p->volume[i];
      }
      for (int64_t n = groups[k].first[g]; n < groups[k].first[g + 1]; ++n)
        p->velocity.row[k][groups[k].places[n]] = momentum / mass;
    }
}

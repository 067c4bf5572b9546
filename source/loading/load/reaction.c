/* What a motion prescribed in earlier stages exerted on its particles when these ended, carried on as forces, so that something else can take its place:
 * dashpots that cannot hold a weight at rest, or nothing, as where ground is dug away. */
#include "loading/constraint.h"
#include "loading/load/load_parts.h"

#include "base/team.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reaction {
  const Loading *loading;
  const char *name;   /* of the loads that held */
  int64_t stage;      /* with which they end */
  double *force[6];   /* [particles of the load] force, or moment, per volume */
  const int *motions; /* how many of these there are */
} Reaction;

/** Whether a load of the name acts in the stage before. */
static bool acted(const Reaction *own, const Load *load)
{
  return load->spec->name && !strcmp(load->spec->name, own->name) && load->first < own->stage &&
         load->behind >= own->stage;
}

/** All particles that loads of the name hold. */
static int select_held(Load *load, const LoadMaking *making, uint8_t *held)
{
  const Reaction *own = load->own;
  const Loading *loading = own->loading;
  const Particles *p = &making->body->particles;
  const Constraint *c = loading->constraints;
  int64_t count = 0;
  for (; c < loading->constraints + loading->constraint_count; ++c) {
    if (c->images && acted(own, c->load))
      return node_error(making->reader->document, load->node, making->reader->error,
                        "reaction of: '%s' is a support, whose particles stand outside the body for the whole run; "
                        "hold layers inside by 'displacement' instead",
                        own->name);
    for (int64_t n = 0; acted(own, c->load) && n < c->load->selection.count; ++n) {
      const int64_t number = p->number[c->load->selection.places[n]];
      count += !held[number];
      held[number] = 1;
    }
  }
  if (!count)
    return node_error(making->reader->document, load->node, making->reader->error,
                      "reaction of: no load that acts before this stage prescribes a motion under the name '%s'; give "
                      "one that does so 'name: %s'",
                      own->name, own->name);
  selection_destroy(&load->selection);
  load->selection.places = memory_zeroed((size_t)count, sizeof(int32_t), "reactions", making->reader->error);
  if (!load->selection.places) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < p->count; ++n)
    if (held[n]) load->selection.places[load->selection.count++] = p->place_of[n];
  return BRECCIA_OK;
}

static int create(Load *load, const LoadMaking *making)
{
  const Particles *p = &making->body->particles;
  Error *error = making->reader->error;
  Reaction *own = load->own = memory_zeroed(1, sizeof *own, "reactions", error);
  uint8_t *held = own ? memory_zeroed((size_t)p->count, 1, "reactions", error) : NULL;
  int status = BRECCIA_FAILURE;
  if (held) {
    *own = (Reaction){.loading = making->loading, .name = load->value->text, .stage = load->first};
    own->motions = &p->space.rows;
    status = select_held(load, making, held);
  }
  free(held);
  if (status) return status;
  if (load->spec->on.node)
    return node_error(making->reader->document, section_node(load->spec, "on"), error,
                      "on: 'reaction of' acts on the particles that '%s' held; leave 'on' out", own->name);
  for (int k = 0; k < p->space.rows; ++k)
    if (!(own->force[k] = memory_zeroed((size_t)load->selection.count, sizeof(double), "reactions", error)))
      return BRECCIA_FAILURE;
  for (int l = 0; l < making->loading->count; ++l) {
    Load *other = &making->loading->loads[l];
    if (other != load && acted(own, other)) other->behind = own->stage;
  }
  return BRECCIA_OK;
}

static void destroy(Load *load)
{
  Reaction *own = load->own;
  for (int k = 0; k < 6; ++k) free(own->force[k]);
  free(own);
}

/** Adds a force along the direction of a constraint to the particle of index n of the load. */
static void add_along(Reaction *own, const Particles *p, const Constraint *c, int64_t n, double along)
{
  for (int k = 0; k < 3 && c->row + k < p->space.rows; ++k) own->force[c->row + k][n] += along * c->direction[k];
}

/** Adds what the leaders of a platen bear when the force on its n-th particle is `along`: the plate takes no moment
 * about its centre. */
static void add_to_leaders(Reaction *own, const Particles *p, const Constraint *c, const Selection *all, int64_t n,
                           double along)
{
  const double volume = p->volume[c->load->selection.places[n]];
  for (int m = 0; m < constraint_leaders(c); ++m) {
    const int32_t leader = constraint_leader(c, m);
    int64_t at = 0;
    while (all->places[at] != leader) ++at;
    add_along(own, p, c, at, -constraint_share(c, m, n) * along * volume / p->volume[leader]);
  }
}

/** Forces that balance the particles in the directions that were prescribed. */
static bool begin(Load *load, Particles *p)
{
  Reaction *own = load->own;
  const Loading *loading = own->loading;
  const Selection *all = &load->selection;
  for (const Constraint *c = loading->constraints; c < loading->constraints + loading->constraint_count; ++c) {
    if (!acted(own, c->load)) continue;
    const Selection *some = &c->load->selection;
    for (int64_t n = 0, m = 0; m < some->count; ++m) {
      const int32_t i = some->places[m];
      if (constraint_leads(c, m) || constraint_is_open(c, m)) continue;
      while (all->places[n] != i) ++n; /* numbers ascend in both */
      double along = 0;
      for (int k = 0; k < 3 && c->row + k < p->space.rows; ++k)
        along -= (p->internal.row[c->row + k][i] + p->external.row[c->row + k][i]) * c->direction[k];
      add_along(own, p, c, n, along);
      add_to_leaders(own, p, c, all, m, along);
    }
  }
  return false;
}

static void force(const Load *load, Particles *p, double factor)
{
  const Reaction *own = load->own;
  TEAM_FOR (n, load->selection.count) {
    const int32_t i = load->selection.places[n];
    for (int k = 0; k < p->space.rows; ++k) p->external.row[k][i] += factor * own->force[k][n];
  }
}

static void state(Load *load, const char *name, StateList *list)
{
  Reaction *own = load->own;
  for (int k = 0; k < *own->motions; ++k) {
    char part[24];
    snprintf(part, sizeof part, "reaction %d", k);
    state_add(list,
              &(StateRow){.unit = k < 3 ? "force per volume" : "stress",
                          .kind = STATE_NUMBERS,
                          .role = STATE_COMMITTED,
                          .count = load->selection.count,
                          .values = own->force[k]},
              name, part);
  }
}

static double magnitude(const LoadValue *value)
{
  (void)value;
  return 1;
}

static const char *kind(const LoadValue *value, const char **dimension)
{
  (void)value;
  *dimension = "1";
  return "share of the reaction";
}

const LoadType reaction_load = {.everywhere = true,
                                .goes_on = true,
                                .create = create,
                                .destroy = destroy,
                                .begin = begin,
                                .force = force,
                                .state = state,
                                .magnitude = magnitude,
                                .kind = kind};

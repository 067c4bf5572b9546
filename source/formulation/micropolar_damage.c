/* Damage of links (Tuniki 2012, 3.4; docs/theory.md 6.5): what it leaves of a link, and its two states. How it is found stands in micropolar_damage_sweep.c. */
#include "formulation/micropolar.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

/* ---- what is left ---- */

void micropolar_weaken(const Micropolar *m, int64_t place, int64_t other, int64_t at, double stretch,
                       LinkStiffness *stiffness)
{
  const LinkDamage *damage = m->damage;
  const uint8_t grown = damage->grown[place / SLICE];
  const double tension = damage->tension[grown & GROWN_IN_TENSION ? 1 : 0][at],
               rest = 1 - damage->compression[grown & GROWN_IN_COMPRESSION ? 1 : 0][at];
  double recovery = 1;
  for (int end = 0; end < 2; ++end)
    recovery = fmin(recovery, damage->laws[m->particles->block[(end ? other : place) / SLICE]].recovery);
  stiffness->axial *= (1 - tension * (stretch < 0 ? 1 - recovery : 1)) * rest;
  stiffness->bending *= (1 - tension) * rest;
  stiffness->twist *= (1 - tension) * rest;
}

/* ---- state ---- */

typedef struct Commit {
  const Micropolar *micropolar;
  int from, to; /* of both states */
} Commit;

static void copy_slice(void *context, int64_t slice)
{
  const Commit *c = context;
  const LinkDamage *damage = c->micropolar->damage;
  const uint8_t grown = damage->grown[slice];
  if (!grown) return;
  const int64_t *slots = c->micropolar->family->first + slice, first = slots[0] * SLICE;
  const size_t bytes = sizeof(double) * (size_t)(slots[1] - slots[0]) * SLICE;
  if (grown & GROWN_IN_TENSION) memcpy(damage->tension[c->to] + first, damage->tension[c->from] + first, bytes);
  if (grown & GROWN_IN_COMPRESSION)
    memcpy(damage->compression[c->to] + first, damage->compression[c->from] + first, bytes);
  damage->grown[slice] = 0;
}

void micropolar_commit(void *formulation, bool well)
{
  Commit commit = {formulation, well, !well};
  if (commit.micropolar->damage && !(well && commit.micropolar->points->clock->elastic_stage))
    team_each(commit.micropolar->particles->slices, copy_slice, &commit);
}

/** The committed state was put in place from outside. */
static int take_up(void *owner, const double *numbers, int64_t count, Error *error)
{
  const Micropolar *m = owner;
  const Family *f = m->family;
  (void)numbers, (void)count, (void)error;
  for (int64_t slice = 0; slice < m->particles->slices; ++slice)
    for (int64_t at = f->first[slice] * SLICE; at < f->first[slice + 1] * SLICE; ++at)
      if (m->damage->tension[0][at] > 0 || m->damage->compression[0][at] > 0) m->damage->touched[slice] = 1;
  for (int64_t slice = 0; slice < m->particles->slices; ++slice) /* what was tried goes */
    m->damage->grown[slice] = m->damage->touched[slice] ? GROWN_IN_TENSION | GROWN_IN_COMPRESSION : 0;
  micropolar_commit(owner, false);
  return BRECCIA_OK;
}

void micropolar_state(void *formulation, const char *part, StateList *list)
{
  static const StateCare care = {.resume = take_up};
  Micropolar *m = formulation;
  if (!m->damage) return;
  const struct {
    const char *name;
    double *values;
  } rows[] = {{"damage of links in tension", m->damage->tension[0]},
              {"damage of links in compression", m->damage->compression[0]}};
  for (int k = 0; k < 2; ++k) {
    const StateRow row = {.unit = "1",
                          .kind = STATE_NUMBERS,
                          .entity = STATE_OF_SLOT,
                          .role = STATE_COMMITTED,
                          .count = m->family->slots * SLICE,
                          .values = rows[k].values,
                          .care = &care,
                          .owner = m};
    state_add(list, &row, rows[k].name, part);
  }
}

/** Mean over the links of a place, as they count in its family, with those that broke when they were damaged. */
double micropolar_history(const void *formulation, int64_t place, int k)
{
  const Micropolar *m = formulation;
  const Family *f = m->family;
  const int64_t slice = place / SLICE;
  const int lane = (int)(place % SLICE);
  double sum = 0, weights = 0;
  if (!m->damage || !m->damage->touched[slice] || k > 1) return 0;
  for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
    const int64_t at = slot * SLICE + lane;
    const bool broke = !(f->intact[slot] >> lane & 1); /* as it was when it broke, if it was damaged then */
    if (broke && !(m->damage->tension[0][at] > 0)) continue;
    const double weight = family_bond(f, slice, slot, lane).weight;
    sum += weight * (k ? m->damage->compression : m->damage->tension)[0][at];
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

double micropolar_link_damage(const void *formulation, int64_t slice, int64_t slot, int lane)
{
  const Micropolar *m = formulation;
  if (!m->damage || !m->damage->touched[slice]) return 0;
  const int64_t at = slot * SLICE + lane;
  return fmax(m->damage->tension[0][at], m->damage->compression[0][at]);
}

size_t micropolar_damage_bytes(const Micropolar *m)
{
  if (!m->damage) return 0;
  return 4 * sizeof(double) * (size_t)m->family->slots * SLICE + sizeof(double) * (size_t)m->particles->places +
         2 * (size_t)m->particles->slices;
}

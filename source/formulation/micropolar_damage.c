/* Damage of links (Tuniki 2012, 3.4; docs/theory.md 6.5), in two passes, so that it depends on no order: first that in tension of all links, and how many of them
 * each particle has; then that in compression, of links beside which another link of either end is damaged in tension. */
#include "constitutive/link_damage.h"
#include "formulation/micropolar_lanes.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

LANES_INLINE Lanes stretch_of(Lanes squares)
{
  return squares / (lanes_set(1) + lanes_root(lanes_set(1) + squares));
}

LANES_INLINE bool any_of(LaneMask mask)
{
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

/** All links of half a slot, also those to places of other formulations. @param[in] u  of this end */
LANES_INLINE LinkLanes all_links(const Micropolar *m, int64_t slice, int64_t slot, int half, const Lanes u[3])
{
  return links_of(m, m->particles->displacement, slice, slot, half, m->family->intact[slot], 3, u);
}

/** (|y|^2 - |xi|^2) / |xi|^2, |xi| being longer by the free strain. */
LANES_INLINE Lanes squares_of(const Micropolar *m, const LinkLanes *l)
{
  Lanes d = lanes_set(0);
  for (int k = 0; k < 3; ++k) d += l->e[k] * (l->n[k] + l->n[k] + l->e[k]);
  if (!m->particles->free_strain) return d;
  const Lanes left = stretch_of(d) - free_of(m, l);
  return left * (lanes_set(2) + left);
}

LANES_INLINE void load_displacements(const Micropolar *m, int64_t place, Lanes u[3])
{
  for (int k = 0; k < 3; ++k) u[k] = lanes_load(m->particles->displacement[k] + place);
}

/** link_damage, lane by lane. */
LANES_INLINE Lanes damage_of(Lanes stretch, double begin, double end, bool linear_force)
{
  const LaneMask beyond = (LaneMask)(stretch > lanes_set(begin));
  if (!isfinite(begin)) return lanes_set(0);
  const Lanes x = lanes_choose(beyond, stretch, lanes_set(begin));
  /* gcc 12 takes a division under a condition of one number to be one of the first lane only: both forms are made of one formula */
  const Lanes share = (x - lanes_set(begin)) * lanes_set(1 / (end - begin)) *
                      (lanes_set(!linear_force) + lanes_set(linear_force ? end : 0) / x);
  return lanes_where(beyond, lanes_choose((LaneMask)(x >= lanes_set(end)), lanes_set(1), share));
}

/** The larger damage of what both ends' blocks say of a stretch. */
static double larger_damage(const Micropolar *m, int64_t place, int64_t other, double stretch, bool tension)
{
  double most = 0;
  for (int end = 0; end < 2; ++end) {
    const breccia_link *l = &m->damage->laws[m->particles->block[(end ? other : place) / SLICE]];
    most = fmax(most, tension ? link_damage(stretch, l->tension_begin, l->tension_end, l->linear_force)
                              : link_damage(-stretch, l->compression_begin, l->compression_end, false));
  }
  return most;
}

/** Damage in tension or compression at present stretches. */
LANES_INLINE Lanes damage_now(const Micropolar *m, const LinkLanes *l, bool tension)
{
  const breccia_link *law = &m->damage->laws[m->particles->block[l->place / SLICE]];
  const Lanes d = squares_of(m, l);
  const LaneMask beyond =
      tension ? (LaneMask)(d > lanes_set(m->damage->longer)) : (LaneMask)(d < lanes_set(m->damage->shorter));
  if (!any_of(beyond)) return lanes_set(0); /* spares roots and quotients where nothing new is damaged */
  const Lanes stretch = stretch_of(d);
  Lanes now = tension ? damage_of(stretch, law->tension_begin, law->tension_end, law->linear_force)
                      : damage_of(-stretch, law->compression_begin, law->compression_end, false);
  for (int k = 0; k < LANES && joins_blocks(m, l); ++k) /* both ends by the same formula */
    if (m->particles->block[l->neighbours[k] / SLICE] != m->particles->block[l->place / SLICE])
      now[k] = larger_damage(m, l->place + k, l->neighbours[k], stretch[k], tension);
  return now;
}

/** Writes what damage has become, where it has grown or what stands there is of an earlier trial.
 *  @param[in] now  where it counts @return whether it is more than what is committed */
LANES_INLINE bool grow(double *const damage[2], int64_t at, LaneMask counts, Lanes now, bool stale, Lanes *most)
{
  const Lanes before = lanes_load(damage[0] + at);
  const LaneMask more = (LaneMask)(now > before) & counts;
  const bool grows = any_of(more);
  *most = lanes_choose(more, now, before);
  if (grows || stale) lanes_store(damage[1] + at, *most);
  return grows;
}

/* ---- in tension ---- */

/** Whether a link of a slice is beyond the bounds within which none is damaged. */
LANES_INLINE bool is_beyond(const Micropolar *m, int64_t slice)
{
  const Family *f = m->family;
  const Lanes longer = lanes_set(m->damage->longer), shorter = lanes_set(m->damage->shorter);
  LaneMask beyond = {0};
  for (int half = 0; half < SLICE / LANES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    Lanes u[3];
    load_displacements(m, place, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = all_links(m, slice, slot, half, u);
      const Lanes d = squares_of(m, &l);
      beyond |= ((LaneMask)(d > longer) | (LaneMask)(d < shorter)) & lanes_half(l.intact, half);
    }
  }
  return any_of(beyond);
}

LANES_INLINE void find_tension(const Micropolar *m, int64_t slice)
{
  const Family *f = m->family;
  LinkDamage *damage = m->damage;
  if (!damage->touched[slice] && !is_beyond(m, slice)) return;
  damage->touched[slice] = 1;
  const bool stale = damage->grown[slice] & GROWN_IN_TENSION;
  bool grown = false;
  for (int half = 0; half < SLICE / LANES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    Lanes count = lanes_set(0), u[3];
    load_displacements(m, place, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = all_links(m, slice, slot, half, u);
      Lanes most;
      grown |= grow(damage->tension, slot * SLICE + LANES * half, lanes_half(l.intact, half), damage_now(m, &l, true),
                    stale, &most);
      count += lanes_where((LaneMask)(most > lanes_set(0)), lanes_set(1)); /* also of links that broke with it */
    }
    lanes_store(damage->damaged + place, count);
  }
  damage->grown[slice] = (uint8_t)((damage->grown[slice] & ~GROWN_IN_TENSION) | (grown ? GROWN_IN_TENSION : 0));
}

BRECCIA_CLONES
static void find_tensions(const Micropolar *m, int64_t first, int64_t last)
{
  for (int64_t slice = first; slice < last; ++slice) find_tension(m, slice);
}

/* Clones of functions that other files see would be among the names that the library exports. */
void micropolar_find_tension(const Micropolar *m, int64_t first, int64_t last)
{
  find_tensions(m, first, last);
}

/* ---- in compression ---- */

BRECCIA_CLONES
static void find_compression(const Micropolar *m, int64_t slice)
{
  const Family *f = m->family;
  LinkDamage *damage = m->damage;
  const bool stale = damage->grown[slice] & GROWN_IN_COMPRESSION;
  bool grown = false;
  for (int half = 0; half < SLICE / LANES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Lanes own = lanes_load(damage->damaged + place);
    Lanes u[3];
    load_displacements(m, place, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const int64_t at = slot * SLICE + LANES * half;
      const LinkLanes l = all_links(m, slice, slot, half, u);
      /* what is torn just now is pulled, so that it does not matter here */
      const Lanes itself = lanes_where((LaneMask)(lanes_load(damage->tension[0] + at) > lanes_set(0)), lanes_set(1));
      const LaneMask beside =
          (LaneMask)(lanes_greatest(own, of_others(&l, damage->damaged)) > itself) & lanes_half(l.intact, half);
      Lanes most;
      grown |= grow(damage->compression, at, beside, damage_now(m, &l, false), stale, &most);
    }
  }
  damage->grown[slice] = (uint8_t)((damage->grown[slice] & ~GROWN_IN_COMPRESSION) | (grown ? GROWN_IN_COMPRESSION : 0));
}

void micropolar_find_compression(const Micropolar *m, int64_t slice)
{
  find_compression(m, slice);
}

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
  if (!damage->grown[slice]) return;
  const int64_t *slots = c->micropolar->family->first + slice, first = slots[0] * SLICE;
  const size_t bytes = sizeof(double) * (size_t)(slots[1] - slots[0]) * SLICE;
  memcpy(damage->tension[c->to] + first, damage->tension[c->from] + first, bytes);
  memcpy(damage->compression[c->to] + first, damage->compression[c->from] + first, bytes);
  damage->grown[slice] = 0;
}

void micropolar_commit(void *formulation, bool well)
{
  Commit commit = {formulation, well, !well};
  if (commit.micropolar->damage && !(well && commit.micropolar->points->elastic_stage))
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

size_t micropolar_damage_bytes(const Micropolar *m)
{
  if (!m->damage) return 0;
  return 4 * sizeof(double) * (size_t)m->family->slots * SLICE + sizeof(double) * (size_t)m->particles->places +
         2 * (size_t)m->particles->slices;
}

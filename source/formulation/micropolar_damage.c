/* Damage of links (Tuniki 2012, 3.4; docs/theory.md 6.5), in two passes, so that it depends on no order: first that in tension of all links, and how many of them
 * each particle has; then that in compression, of links beside which another link of either end is damaged in tension. */
#include "constitutive/link_damage.h"
#include "formulation/micropolar.h"

#include "base/team.h"
#include <math.h>
#include <string.h>

/* ---- in tension ---- */

LANES_INLINE Lanes stretch_of(Lanes squares)
{
  return squares / (lanes_set(1) + lanes_root(lanes_set(1) + squares));
}

/** Stretch of a link without its free strain. */
static double stretch_at(const Micropolar *m, int64_t place, const Bond *bond)
{
  double y[3];
  return micropolar_stretch(m->particles->displacement, place, bond, y) -
         particles_free_strain(m->particles, place, bond->neighbour);
}

/** (|y|^2 - |xi|^2) / |xi|^2 of the links of half a lattice slot, |xi| being longer by the free strain. */
LANES_INLINE Lanes squares_of(const Micropolar *m, int64_t slot, int64_t place, int half)
{
  double *const *u = m->particles->displacement;
  const LinkRow *row = &m->rows[m->family->pattern[slot]];
  const int64_t here = place + LANES * half, there = m->family->base[slot] + LANES * half;
  Lanes d = lanes_set(0);
  for (int k = 0; k < 3; ++k) {
    const Lanes e = (lanes_load(u[k] + there) - lanes_load(u[k] + here)) * lanes_set(row->by_length);
    d += e * (lanes_set(2 * row->n[k]) + e);
  }
  const double *free = m->particles->free_strain;
  if (!free) return d;
  const Lanes left = stretch_of(d) - lanes_set(0.5) * (lanes_load(free + here) + lanes_load(free + there));
  return left * (lanes_set(2) + left);
}

/** link_damage, lane by lane. */
LANES_INLINE Lanes damage_of(Lanes stretch, double begin, double end, bool linear_force)
{
  const LaneMask beyond = (LaneMask)(stretch > lanes_set(begin));
  const Lanes x = lanes_choose(beyond, stretch, lanes_set(begin));
  /* gcc 12 takes a division under a condition of one number to be one of the first lane only: both forms are made of one formula */
  const Lanes share = (x - lanes_set(begin)) * lanes_set(1 / (end - begin)) *
                      (lanes_set(!linear_force) + lanes_set(linear_force ? end : 0) / x);
  return lanes_where(beyond, lanes_choose((LaneMask)(x >= lanes_set(end)), lanes_set(1), share));
}

/** Whether a link of a slice is beyond the bounds within which none is damaged. */
LANES_INLINE bool is_beyond(const Micropolar *m, int64_t slice)
{
  const Family *f = m->family;
  const Lanes longer = lanes_set(m->damage->longer), shorter = lanes_set(m->damage->shorter);
  LaneMask beyond = {0};
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    for (int half = 0; half < SLICE / LANES; ++half) {
      const Lanes d = squares_of(m, slot, slice * SLICE, half);
      beyond |= ((LaneMask)(d > longer) | (LaneMask)(d < shorter)) & lanes_half(f->intact[slot], half);
    }
  if (beyond[0] | beyond[1] | beyond[2] | beyond[3]) return true;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const Bond bond = family_bond(f, slice, slot, lane);
      const double s = stretch_at(m, slice * SLICE + lane, &bond), d = s * (2 + s);
      if (d > m->damage->longer || d < m->damage->shorter) return true;
    }
  return false;
}

/** The larger damage of what both ends' blocks say of a stretch. */
static double tension_at(const Micropolar *m, int64_t place, int64_t other, double stretch)
{
  double most = 0;
  for (int end = 0; end < 2; ++end) {
    const breccia_link *l = &m->damage->laws[m->particles->block[(end ? other : place) / SLICE]];
    most = fmax(most, link_damage(stretch, l->tension_begin, l->tension_end, l->linear_force));
  }
  return most;
}

static double compression_at(const Micropolar *m, int64_t place, int64_t other, double stretch)
{
  double most = 0;
  for (int end = 0; end < 2; ++end) {
    const breccia_link *l = &m->damage->laws[m->particles->block[(end ? other : place) / SLICE]];
    most = fmax(most, link_damage(-stretch, l->compression_begin, l->compression_end, false));
  }
  return most;
}

LANES_INLINE void find_tension(const Micropolar *m, int64_t slice)
{
  const Family *f = m->family;
  LinkDamage *damage = m->damage;
  const int64_t first = slice * SLICE;
  if (!damage->touched[slice] && !is_beyond(m, slice)) return;
  damage->touched[slice] = 1;
  const breccia_link *law = &damage->laws[m->particles->block[slice]];
  for (int half = 0; half < SLICE / LANES; ++half) {
    Lanes count = lanes_set(0);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice] && isfinite(law->tension_begin); ++slot) {
      const int64_t at = slot * SLICE + LANES * half;
      const LaneMask intact = lanes_half(f->intact[slot], half);
      const Lanes before = lanes_load(damage->tension[0] + at), stretch = stretch_of(squares_of(m, slot, first, half)),
                  now = damage_of(stretch, law->tension_begin, law->tension_end, law->linear_force);
      const Lanes most = lanes_choose(intact, lanes_greatest(before, now), before);
      lanes_store(damage->tension[1] + at, most);
      count += lanes_where((LaneMask)(most > lanes_set(0)), lanes_set(1)); /* also of links that broke with it */
    }
    lanes_store(damage->damaged + first + LANES * half, count);
  }
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t at = slot * SLICE + lane, place = first + lane;
      damage->tension[1][at] = damage->tension[0][at];
      if (f->intact[slot] >> lane & 1) {
        const Bond bond = family_bond(f, slice, slot, lane);
        const double stretch = stretch_at(m, place, &bond);
        damage->tension[1][at] = fmax(damage->tension[0][at], tension_at(m, place, bond.neighbour, stretch));
      }
      damage->damaged[place] += damage->tension[1][at] > 0;
    }
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
  const LinkDamage *damage = m->damage;
  const int64_t first = slice * SLICE;
  const breccia_link *law = &damage->laws[m->particles->block[slice]];
  for (int half = 0; half < SLICE / LANES; ++half) {
    const Lanes own = lanes_load(damage->damaged + first + LANES * half);
    for (int64_t slot = f->first[slice]; slot < f->stored[slice] && isfinite(law->compression_begin); ++slot) {
      const int64_t at = slot * SLICE + LANES * half, there = f->base[slot] + LANES * half;
      const Lanes itself = lanes_where((LaneMask)(lanes_load(damage->tension[1] + at) > lanes_set(0)), lanes_set(1));
      const LaneMask beside = (LaneMask)(lanes_greatest(own, lanes_load(damage->damaged + there)) > itself) &
                              lanes_half(f->intact[slot], half);
      const Lanes before = lanes_load(damage->compression[0] + at),
                  stretch = stretch_of(squares_of(m, slot, first, half)),
                  now = damage_of(-stretch, law->compression_begin, law->compression_end, false);
      lanes_store(damage->compression[1] + at, lanes_choose(beside, lanes_greatest(before, now), before));
    }
  }
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int64_t at = slot * SLICE + lane, place = first + lane;
      const Bond bond = family_bond(f, slice, slot, lane);
      const double stretch = stretch_at(m, place, &bond),
                   beside = fmax(damage->damaged[place], damage->damaged[bond.neighbour]);
      damage->compression[1][at] = damage->compression[0][at];
      if (beside > (damage->tension[1][at] > 0))
        damage->compression[1][at] =
            fmax(damage->compression[0][at], compression_at(m, place, bond.neighbour, stretch));
    }
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
  const double tension = damage->tension[1][at], rest = 1 - damage->compression[1][at];
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
  if (!damage->touched[slice]) return;
  const int64_t *slots = c->micropolar->family->first + slice, first = slots[0] * SLICE;
  const size_t bytes = sizeof(double) * (size_t)(slots[1] - slots[0]) * SLICE;
  memcpy(damage->tension[c->to] + first, damage->tension[c->from] + first, bytes);
  memcpy(damage->compression[c->to] + first, damage->compression[c->from] + first, bytes);
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
         (size_t)m->particles->slices;
}

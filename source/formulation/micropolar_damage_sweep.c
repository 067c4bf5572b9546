/* How damage of links is found (Tuniki 2012, 3.4; docs/theory.md 6.5), in two passes, so that it depends on no order: first that in tension of all links, and how many of
 * them each particle has; then that in compression, of links beside which another link of either end is damaged in tension. */
#include "constitutive/link_damage.h"
#include "formulation/micropolar_lanes.h"

#include <math.h>

/** Stretch of (|y|^2 - |xi|^2) / |xi|^2. Each lane goes its own way, so that both ends of a link find the same bits. */
LANES_INLINE Lanes stretch_of(Lanes d)
{
  const LaneMask far = (LaneMask)(lanes_absolute(d) > lanes_set(range_limit[RANGE_SERIES]));
  const Lanes square = d * d;
  Lanes pair[STRETCH_TERMS / 2];
  for (int n = 0; n < STRETCH_TERMS; n += 2)
    pair[n / 2] = lanes_set(stretch_terms[n]) - d * lanes_set(stretch_terms[n + 1]);
  const Lanes series = d * (pair[0] + square * (pair[1] + square * pair[2]));
  if (!lanes_any(far)) return series;
  return lanes_choose(far, d / (lanes_set(1) + lanes_root(lanes_set(1) + d)), series);
}

/** All links of half a slot, also those to places of other formulations. @param[in] u  of this end */
LANES_INLINE LinkLanes all_links(const Micropolar *m, double *const *displacement, int64_t slice, int64_t slot,
                                 int half, int dimensions, const Lanes u[3])
{
  return links_of(m, displacement, slice, slot, half, m->family->intact[slot], dimensions, u);
}

/** (|y|^2 - |xi|^2) / |xi|^2, |xi| being longer by the free strain. */
LANES_INLINE Lanes squares_of(const Micropolar *m, int dimensions, const LinkLanes *l)
{
  Lanes d = lanes_set(0);
  for (int k = 0; k < dimensions; ++k) d += l->e[k] * (l->n[k] + l->n[k] + l->e[k]);
  if (!m->particles->free_strain) return d;
  const Lanes left = stretch_of(d) - free_of(m, l);
  return left * (lanes_set(2) + left);
}

LANES_INLINE void load_displacements(double *const *displacement, int64_t place, int dimensions, Lanes u[3])
{
  for (int k = 0; k < dimensions; ++k) u[k] = lanes_load(displacement[k] + place);
}

/** link_damage, lane by lane. */
LANES_INLINE Lanes damage_of(Lanes stretch, LinkCurve c)
{
  const LaneMask beyond = (LaneMask)(stretch > lanes_set(c.begin));
  if (!isfinite(c.begin)) return lanes_set(0);
  const Lanes x = lanes_choose(beyond, stretch, lanes_set(c.begin));
  /* gcc 12 takes a division under a condition of one number to be one of the first lane only: both forms are made of one formula */
  const Lanes inverse = lanes_set(1) / x,
              first = (x - lanes_set(c.begin)) * lanes_set(1 / (c.first_end - c.begin)) *
                      (lanes_set(!c.linear_force) + lanes_set(c.linear_force ? c.first_end : 0) * inverse),
              second = lanes_set(1 + c.tail) - lanes_set(c.tail * c.end) * inverse;
  return lanes_where(beyond, lanes_choose((LaneMask)(x >= lanes_set(c.end)), lanes_set(1), lanes_least(first, second)));
}

/** The larger damage of what both ends' blocks say of a stretch. */
static double larger_damage(const Micropolar *m, int64_t place, int64_t other, double stretch, bool tension)
{
  double most = 0;
  for (int end = 0; end < 2; ++end) {
    const breccia_link *l = &m->damage->laws[m->particles->block[(end ? other : place) / SLICE]];
    const LinkCurve curves[2] = {link_in_tension(l), link_in_compression(l)};
    most = fmax(most, tension ? link_damage(stretch, &curves[0]) : link_damage(-stretch, &curves[1]));
  }
  return most;
}

/** Damage in tension or compression at present squares of lengths. @param[in] beyond  which of them are beyond their bound */
LANES_INLINE Lanes damage_now(const Micropolar *m, const LinkLanes *l, Lanes d, LaneMask beyond, bool tension)
{
  const breccia_link *law = &m->damage->laws[m->particles->block[l->place / SLICE]];
  if (!lanes_any(beyond)) return lanes_set(0); /* spares quotients where nothing new is damaged */
  const Lanes stretch = stretch_of(d);
  Lanes now = tension ? damage_of(stretch, link_in_tension(law)) : damage_of(-stretch, link_in_compression(law));
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
  const bool grows = lanes_any(more);
  *most = lanes_choose(more, now, before);
  if (grows || stale) lanes_store(damage[1] + at, *most);
  return grows;
}

/** Whether a link of a slice is beyond the bounds within which none is damaged. */
LANES_INLINE bool is_beyond(const Micropolar *m, double *const *displacement, int64_t slice, int dimensions)
{
  const Family *f = m->family;
  const Lanes longer = lanes_set(m->damage->longer), shorter = lanes_set(m->damage->shorter);
  LaneMask beyond = {0};
  for (int half = 0; half < HALVES; ++half) {
    Lanes u[3];
    load_displacements(displacement, slice * SLICE + LANES * half, dimensions, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = all_links(m, displacement, slice, slot, half, dimensions, u);
      const Lanes d = squares_of(m, dimensions, &l);
      beyond |= ((LaneMask)(d > longer) | (LaneMask)(d < shorter)) & lanes_half(l.intact, half);
    }
  }
  return lanes_any(beyond);
}

LANES_INLINE void find_tension(const Micropolar *m, double *const *displacement, int64_t slice, int dimensions)
{
  const Family *f = m->family;
  LinkDamage *damage = m->damage;
  if (!damage->touched[slice] && !is_beyond(m, displacement, slice, dimensions)) return;
  damage->touched[slice] = 1;
  const bool stale = damage->grown[slice] & GROWN_IN_TENSION;
  const Lanes longer = lanes_set(damage->longer), shorter = lanes_set(damage->shorter);
  bool grown = false;
  LaneMask pressed = {0};
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    Lanes count = lanes_set(0), u[3];
    load_displacements(displacement, place, dimensions, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const LinkLanes l = all_links(m, displacement, slice, slot, half, dimensions, u);
      const Lanes d = squares_of(m, dimensions, &l);
      Lanes most;
      grown |= grow(damage->tension, slot * SLICE + LANES * half, lanes_half(l.intact, half),
                    damage_now(m, &l, d, (LaneMask)(d > longer), true), stale, &most);
      count += lanes_where((LaneMask)(most > lanes_set(0)), lanes_set(1)); /* also of links that broke with it */
      pressed |= (LaneMask)(d < shorter);
    }
    lanes_store(damage->damaged + place, count);
  }
  damage->grown[slice] = (uint8_t)((damage->grown[slice] & GROWN_IN_COMPRESSION) | (grown ? GROWN_IN_TENSION : 0) |
                                   (lanes_any(pressed) ? PRESSED : 0));
}

LANES_INLINE void find_compression(const Micropolar *m, double *const *displacement, int64_t slice, int dimensions)
{
  const Family *f = m->family;
  LinkDamage *damage = m->damage;
  const bool stale = damage->grown[slice] & GROWN_IN_COMPRESSION;
  if (!stale && !(damage->grown[slice] & PRESSED)) return;
  const Lanes shorter = lanes_set(damage->shorter);
  bool grown = false;
  for (int half = 0; half < HALVES; ++half) {
    const int64_t place = slice * SLICE + LANES * half;
    const Lanes own = lanes_load(damage->damaged + place);
    Lanes u[3];
    load_displacements(displacement, place, dimensions, u);
    for (int64_t slot = f->first[slice]; slot < f->first[slice + 1]; ++slot) {
      const int64_t at = slot * SLICE + LANES * half;
      const LinkLanes l = all_links(m, displacement, slice, slot, half, dimensions, u);
      const Lanes d = squares_of(m, dimensions, &l);
      /* what is torn just now is pulled, so that it does not matter here */
      const Lanes itself = lanes_where((LaneMask)(lanes_load(damage->tension[0] + at) > lanes_set(0)), lanes_set(1));
      const LaneMask beside =
          (LaneMask)(lanes_greatest(own, of_others(&l, damage->damaged)) > itself) & lanes_half(l.intact, half);
      Lanes most;
      grown |=
          grow(damage->compression, at, beside, damage_now(m, &l, d, (LaneMask)(d < shorter), false), stale, &most);
    }
  }
  damage->grown[slice] = (uint8_t)((damage->grown[slice] & ~GROWN_IN_COMPRESSION) | (grown ? GROWN_IN_COMPRESSION : 0));
}

/* Loops over components need bounds that the compiler knows. */

static void find_tensions(const Micropolar *m, const Sweep *sweep)
{
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice)
    if (m->space == SPACE_3D)
      find_tension(m, sweep->displacement, slice, 3);
    else
      find_tension(m, sweep->displacement, slice, 2);
}

static void find_compressions(const Micropolar *m, double *const *displacement, int64_t slice)
{
  if (m->space == SPACE_3D)
    find_compression(m, displacement, slice, 3);
  else
    find_compression(m, displacement, slice, 2);
}

const DamageSweeps LANES_NAMED(micropolar_damage) = {.find_tension = find_tensions,
                                                     .find_compression = find_compressions};

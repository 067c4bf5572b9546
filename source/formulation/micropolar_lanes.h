/* What sweeps over links of lattices in the plane and in space share, vectors of links at a time. */
#ifndef BRECCIA_FORMULATION_MICROPOLAR_LANES_H
#define BRECCIA_FORMULATION_MICROPOLAR_LANES_H

#include "formulation/micropolar.h"

/* Largest |sine| of an end rotation for which the series are good to double precision, as the cosine's distance from 1: 1 - (1 - 2^-10)^1/2. */
static const double largest_cosine_loss = 0x1.001002005p-11;

/** Angle over sine, less 1, of the square of the sine: of the series of the arc sine. */
LANES_INLINE Lanes angle_excess(Lanes square)
{
  Lanes sum = lanes_set(63.0 / 2816) * square + lanes_set(35.0 / 1152);
  sum = sum * square + lanes_set(5.0 / 112);
  sum = sum * square + lanes_set(3.0 / 40);
  sum = sum * square + lanes_set(1.0 / 6);
  return square * sum;
}

/** (1 - t cot t) / sin^2 t, of sin^2 t, for small t. */
LANES_INLINE Lanes bend_series(Lanes square)
{
  Lanes sum = lanes_set(16.0 / 315) * square + lanes_set(8.0 / 105);
  sum = sum * square + lanes_set(2.0 / 15);
  return sum * square + lanes_set(1.0 / 3);
}

/** Angle from 0 to pi of a sine and cosine, by the series of the arc tangent of a sixteenth part of a turn at most. */
LANES_INLINE Lanes angle_between(Lanes sine, Lanes cosine)
{
  enum { TERMS = 11 };
  const LaneMask obtuse = (LaneMask)(cosine < lanes_set(0));
  const Lanes one = lanes_set(1);
  Lanes tangent = sine / (one + lanes_absolute(cosine)); /* of half the angle */
  for (int halved = 0; halved < 2; ++halved) tangent /= one + lanes_root(one + tangent * tangent);
  const Lanes square = tangent * tangent;
  Lanes sum = lanes_set(1.0 / (2 * TERMS - 1));
  for (int n = TERMS - 2; n >= 0; --n) sum = lanes_set(1.0 / (2 * n + 1)) - square * sum;
  const Lanes angle = lanes_set(8) * tangent * sum;
  return lanes_choose(obtuse, lanes_set(3.14159265358979323846) - angle, angle);
}

/** An end rotation t: t / sin t, and (1 - t cot t) / sin^2 t. */
typedef struct EndLanes {
  Lanes factor, bend;
} EndLanes;

/** @param[in] square  of the sine @param[in] any  of any angle, or within the series */
LANES_INLINE EndLanes end_rotation(Lanes square, Lanes cosine, bool any)
{
  const Lanes one = lanes_set(1), zero = lanes_set(0);
  if (!any) return (EndLanes){one + angle_excess(square), bend_series(square)};
  const LaneMask turned = (LaneMask)(square > zero),
                 small = (LaneMask)(square < lanes_set(1e-3)) & ~(LaneMask)(cosine < zero);
  const Lanes sine = lanes_root(square),
              factor = lanes_choose(turned, angle_between(sine, cosine) / lanes_choose(turned, sine, one), one);
  const Lanes bend = (one - factor * cosine) / lanes_choose(turned, square, one);
  return (EndLanes){factor, lanes_choose(small, bend_series(square), bend)};
}

/** Links of half a slot. */
typedef struct LinkLanes {
  int64_t place, slot, there; /* of the first lane; there: of its other end, where these stand side by side */
  const int32_t *neighbours;  /* NULL, or where they do not */
  int half;
  unsigned intact;
  Lanes volume;          /* of the other ends, where these do not */
  Lanes n[3], by_length; /* reference vector over its length, and 1 over that */
  Lanes e[3]; /* displacement of the other end less that of this one, over the length; 0 where the link is broken */
} LinkLanes;

/** As in LinkRow; 0 where a link is broken. */
typedef struct StiffnessLanes {
  Lanes axial, bending, twist;
  bool bends, twists; /* some of the links do */
} StiffnessLanes;

/** Numbers of the other ends. */
LANES_INLINE Lanes of_others(const LinkLanes *link, const double *from)
{
  return link->neighbours ? lanes_gather(from, link->neighbours) : lanes_load(from + link->there);
}

/** Finds what is shown of the rotations of the other ends. @param[in] count  of numbers @param[out] turns  [QUAD] */
LANES_INLINE void turns_of_others(const Micropolar *m, const LinkLanes *link, int count, Lanes *turns)
{
  if (link->neighbours) {
    family_fetch_ahead(m->family, link->neighbours - m->family->neighbour, m->turns, QUAD);
    lanes_gather_rows(m->turns, QUAD, link->neighbours, turns);
    return;
  }
  for (int k = 0; k < count; ++k) turns[k] = lanes_load(m->shown[k] + link->there);
}

/** @param[in] at  displacements @param[in] u  of this end */
LANES_INLINE LinkLanes lattice_links(const Micropolar *m, double *const *at, int64_t place, int64_t slot, int half,
                                     int dimensions, const Lanes *u)
{
  const Family *f = m->family;
  const int64_t slice = place / SLICE;
  const LinkRow *row = &m->rows[family_pattern(f, slice, slot)];
  LinkLanes l = {.place = place,
                 .slot = slot,
                 .half = half,
                 .there = family_base(f, slice, slot) + LANES * half,
                 .intact = f->intact[slot],
                 .by_length = lanes_set(row->by_length)};
  for (int k = 0; k < dimensions; ++k) {
    l.n[k] = lanes_set(row->n[k]);
    /* the ends of broken links may be so far apart that the series would be none */
    l.e[k] = lanes_intact(l.intact, half, of_others(&l, at[k]) - u[k]) * l.by_length;
  }
  return l;
}

LANES_INLINE StiffnessLanes lattice_stiffness(const Micropolar *m, const LinkLanes *l)
{
  const LinkRow *row = &m->rows[family_pattern(m->family, l->place / SLICE, l->slot)];
  return (StiffnessLanes){lanes_intact(l->intact, l->half, lanes_set(row->axial)),
                          lanes_intact(l->intact, l->half, lanes_set(row->bending)),
                          lanes_intact(l->intact, l->half, lanes_set(row->twist)), row->bending > 0, row->twist > 0};
}

/** @param[in] wanted  bits of links */
LANES_INLINE LinkLanes stored_links(const Micropolar *m, int64_t place, int64_t slot, int half, unsigned wanted,
                                    int dimensions, const Lanes *u)
{
  const Family *f = m->family;
  const Particles *p = m->particles;
  LinkLanes l = {.place = place,
                 .slot = slot,
                 .half = half,
                 .neighbours = f->neighbour + (int64_t)f->base[slot] * SLICE + LANES * half,
                 .intact = wanted};
  Lanes position[QUAD], moved[QUAD];
  family_fetch_ahead(f, l.neighbours - f->neighbour, m->record, LINK_RECORD);
  lanes_gather_rows(m->record, LINK_RECORD, l.neighbours, position);
  lanes_gather_rows(m->record + QUAD, LINK_RECORD, l.neighbours, moved);
  l.volume = position[3];
  const LaneMask intact = lanes_half(l.intact, half);
  Lanes square = lanes_set(0);
  for (int k = 0; k < dimensions; ++k) {
    l.n[k] = lanes_where(intact, position[k] - lanes_load(p->position[k] + place));
    square += l.n[k] * l.n[k];
    l.e[k] = lanes_where(intact, moved[k] - u[k]);
  }
  l.by_length = lanes_set(1) / lanes_choose(intact, lanes_root(square), lanes_set(1));
  for (int k = 0; k < dimensions; ++k) {
    l.n[k] *= l.by_length;
    l.e[k] *= l.by_length;
  }
  return l;
}

/** Finds constants of links whose ends are of several blocks or have constants by length, one by one. Out of line: vectors
 *  of which lanes are read one by one go through memory, and with them the links that they belong to.
 *  @param[out] stiffness  axial, bending, twist */
static __attribute__((noinline)) void find_each_stiffness(const Micropolar *m, int64_t place, const int32_t *neighbours,
                                                          const Lanes *by_length, Lanes stiffness[3])
{
  for (int k = 0; k < LANES; ++k) {
    const Bond bond = {.neighbour = neighbours[k], .length = 1 / (*by_length)[k]};
    const LinkStiffness each = micropolar_stiffness(m, place + k, &bond);
    stiffness[0][k] = each.axial;
    stiffness[1][k] = each.bending;
    stiffness[2][k] = each.twist;
  }
}

LANES_INLINE StiffnessLanes stored_stiffness(const Micropolar *m, const LinkLanes *l)
{
  const Family *f = m->family;
  Lanes weight = l->volume;
  if (f->scale) weight *= lanes_load(f->scale + (int64_t)f->base[l->slot] * SLICE + LANES * l->half);
  weight = lanes_intact(l->intact, l->half, weight);
  const LinkStiffness *any = &m->constants[0].any;
  Lanes axial = lanes_set(any->axial), bending = lanes_set(any->bending), twist = lanes_set(any->twist);
  if (m->body->block_count > 1 || m->constants[0].lengths) {
    const Lanes by_length = l->by_length;
    Lanes each[3];
    find_each_stiffness(m, l->place, l->neighbours, &by_length, each);
    axial = each[0];
    bending = each[1];
    twist = each[2];
  }
  const Lanes over_length = weight * l->by_length;
  return (StiffnessLanes){axial * weight, bending * over_length, twist * over_length, true, true};
}

/** Keeps what stored links read of a place beside its position. @param[in] at  displacements */
LANES_INLINE void show_record(const Micropolar *m, double *const *at, int64_t place)
{
  for (int k = 0; k < 3; ++k) m->record[LINK_RECORD * place + QUAD + k] = at[k][place];
  for (int k = 0; k < 4; ++k) m->turns[QUAD * place + k] = m->shown[k] ? m->shown[k][place] : 0;
}

/** Intact bits of a slot without its links to places of other formulations, which go one by one. */
LANES_INLINE unsigned own_bits(const Micropolar *m, int64_t slice, int64_t slot)
{
  unsigned bits = m->family->intact[slot];
  if (!m->foreign || slot < m->family->stored[slice]) return bits;
  const int32_t *neighbours = m->family->neighbour + (int64_t)m->family->base[slot] * SLICE;
  for (int lane = 0; lane < SLICE; ++lane)
    if (bits >> lane & 1u && m->foreign[neighbours[lane] / SLICE]) bits &= ~(1u << lane);
  return bits;
}

/** Links of half a slot of a slice, whichever way it is kept. @param[in] wanted  bits of them, where it is a stored one */
LANES_INLINE LinkLanes links_of(const Micropolar *m, double *const *at, int64_t slice, int64_t slot, int half,
                                unsigned wanted, int dimensions, const Lanes *u)
{
  const int64_t place = slice * SLICE + LANES * half;
  if (slot < m->family->stored[slice]) return lattice_links(m, at, place, slot, half, dimensions, u);
  return stored_links(m, place, slot, half, wanted, dimensions, u);
}

LANES_INLINE StiffnessLanes stiffness_of_links(const Micropolar *m, const LinkLanes *l)
{
  return l->neighbours ? stored_stiffness(m, l) : lattice_stiffness(m, l);
}

/** Some other end is of another block than this one. */
LANES_INLINE bool joins_blocks(const Micropolar *m, const LinkLanes *l)
{
  const int32_t *block = m->particles->block;
  bool joins = false;
  for (int k = 0; k < LANES && l->neighbours && m->body->block_count > 1; ++k)
    joins |= block[l->neighbours[k] / SLICE] != block[l->place / SLICE];
  return joins;
}

/** Stretch at which links carry nothing. */
LANES_INLINE Lanes free_of(const Micropolar *m, const LinkLanes *l)
{
  const double *free = m->particles->free_strain;
  return free ? lanes_set(0.5) * (lanes_load(free + l->place) + of_others(l, free)) : lanes_set(0);
}

/** Links as they are deformed. */
typedef struct ChordLanes {
  Lanes m[3];    /* to the other end, of length 1 */
  Lanes inverse; /* reference over present length */
  Lanes stretch; /* without the free strain */
} ChordLanes;

/** Of any stretches. Where the series is good for all lanes it spares the root and the quotients. */
LANES_INLINE ChordLanes chords_of(const Micropolar *m, const LinkLanes *l, int dimensions)
{
  ChordLanes c;
  Lanes d = {0};
  for (int k = 0; k < dimensions; ++k) {
    c.m[k] = l->n[k] + l->e[k];
    d += l->e[k] * (l->n[k] + c.m[k]);
  }
  const LaneMask far = (LaneMask)(lanes_absolute(d) > lanes_set(range_limit[RANGE_SERIES]));
  Lanes g = shortening_series(d);
  if (lanes_any(far)) g = lanes_choose(far, shortening(d, RANGE_ANY), g);
  c.inverse = lanes_set(1) - g;
  c.stretch = d * c.inverse - g - free_of(m, l);
  for (int k = 0; k < dimensions; ++k) c.m[k] *= c.inverse;
  return c;
}

/** What damage of a link that is open leaves of it when it closes again, of both ends' laws. */
LANES_INLINE Lanes recovery_of(const Micropolar *m, const breccia_link *law, const LinkLanes *l)
{
  Lanes recovery = lanes_set(law->recovery);
  for (int k = 0; k < LANES && joins_blocks(m, l); ++k) {
    const double other = m->damage->laws[m->particles->block[l->neighbours[k] / SLICE]].recovery;
    recovery[k] = law->recovery < other ? law->recovery : other;
  }
  return recovery;
}

/** Takes from the stiffness of links what their damage has taken. @param[in] law  NULL: nothing */
LANES_INLINE void weaken(const Micropolar *m, const breccia_link *law, const LinkLanes *l, Lanes stretch,
                         StiffnessLanes *stiffness)
{
  if (!law) return;
  const int64_t at = l->slot * SLICE + LANES * l->half;
  const LinkDamage *damage = m->damage;
  const uint8_t grown = damage->grown[l->place / SLICE];
  const Lanes tension = lanes_load(damage->tension[grown & GROWN_IN_TENSION ? 1 : 0] + at), one = lanes_set(1),
              rest = one - lanes_load(damage->compression[grown & GROWN_IN_COMPRESSION ? 1 : 0] + at);
  const Lanes closed = lanes_choose((LaneMask)(stretch < lanes_set(0)), one - recovery_of(m, law, l), one),
              left = (one - tension) * rest;
  stiffness->axial *= (one - tension * closed) * rest;
  stiffness->bending *= left;
  stiffness->twist *= left;
}

/** The law by which links of a slice are weakened now; NULL: none is. */
LANES_INLINE const breccia_link *weakened_by(const Micropolar *m, int64_t slice)
{
  return micropolar_is_weak(m, slice) ? &m->damage->laws[m->particles->block[slice]] : NULL;
}

/** Where links that bend have an end that has turned too far for the series, by the cosines of both. Torn links do not bend, however far their ends have turned. */
LANES_INLINE LaneMask turned_far(Lanes bending, Lanes cosine, Lanes other)
{
  return (LaneMask)(lanes_least(cosine, other) < lanes_set(1 - largest_cosine_loss)) &
         (LaneMask)(bending > lanes_set(0));
}

#endif

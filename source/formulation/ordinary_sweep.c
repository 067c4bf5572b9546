/* Sweeps of ordinary peridynamics over bonds (formulation/ordinary.h), for each kind of vectors. */
#include "formulation/ordinary.h"

#include <math.h>

/** Half a slot between lattice neighbours: -|xi|^2 d, and 2 y. */
LANES_INLINE Lanes lattice_stretch(const Ordinary *o, double *const *u, const double *doubled, int64_t slice,
                                   int64_t slot, int half, const Lanes own[3], Lanes twice[3])
{
  const int64_t there = family_base(o->family, slice, slot) + LANES * half;
  Lanes d = {0};
  for (int k = 0; k < 3; ++k) {
    const Lanes back = own[k] - lanes_load(u[k] + there);
    const Lanes middle = lanes_set(doubled[k]) - back;
    twice[k] = middle - back;
    d += back * middle;
  }
  return d;
}

/** A series in -|xi|^2 d. By pairs: its chain is shorter so. */
LANES_INLINE Lanes series_of(const double terms[STRETCH_TERMS], Lanes d, Lanes square)
{
  Lanes pair[STRETCH_TERMS / 2];
  for (int n = 0; n < STRETCH_TERMS; n += 2) pair[n / 2] = lanes_set(terms[n]) + d * lanes_set(terms[n + 1]);
  return d * (pair[0] + square * (pair[1] + square * pair[2]));
}

/** Factors of the bonds of a slice; NULL: they are 1. */
typedef struct Factors {
  const float *surface;
  float *unlike;
} Factors;

static Factors factors_of(const Ordinary *o, int64_t slice)
{
  return (Factors){o->surface ? o->surface[slice] : NULL, o->unlike ? o->unlike[slice] : NULL};
}

/** Multiplies half a slot by the factors of the bonds of a slice; NULL: they are 1. */
LANES_INLINE Lanes by_surface(const Ordinary *o, Factors factors, int64_t slice, int64_t slot, int half, Lanes lanes)
{
  return factors.surface
             ? lanes * lanes_widen(factors.surface + (slot - o->family->first[slice]) * SLICE + LANES * half)
             : lanes;
}

/** A factor near interfaces of half a slot. */
LANES_INLINE Lanes unlike_factor(const Ordinary *o, Factors factors, int64_t slice, int64_t slot, int half, int factor)
{
  return lanes_widen(ordinary_factor_at(o, factors.unlike, slice, slot, factor) + LANES * half);
}

/** Multiplies what half a slot adds to the dilatation of its own end. */
LANES_INLINE Lanes by_own(const Ordinary *o, Factors factors, int64_t slice, int64_t slot, int half, Lanes lanes)
{
  return factors.unlike ? lanes * unlike_factor(o, factors, slice, slot, half, ORDINARY_OWN) : lanes;
}

/* ---- dilatation ---- */

typedef struct Dilated {
  Lanes sum, largest; /* d^2, where that is not by the series of a lattice */
  LanesWithin within; /* the series */
} Dilated;

/** Stretch from d and g(d). */
LANES_INLINE Lanes stretch_of(Lanes d, StretchRange range)
{
  const Lanes g = shortening(d, range);
  return d * (lanes_set(1) - g) - g;
}

LANES_INLINE void dilate_lattice(const Ordinary *o, double *const *u, int64_t slice, int64_t slot, int half, bool gaps,
                                 Factors factors, StretchRange range, const Lanes own[3], Dilated *sum)
{
  const int pattern = family_pattern(o->family, slice, slot);
  const OrdinaryDilating *row = &o->dilating[pattern];
  Lanes twice[3], d = lattice_stretch(o, u, row->twice, slice, slot, half, own, twice);
  if (gaps) d = lanes_intact(o->family->intact[slot], half, d);
  if (range == RANGE_SERIES) {
    const Lanes square = d * d;
    sum->sum += by_own(o, factors, slice, slot, half,
                       by_surface(o, factors, slice, slot, half, series_of(row->series, d, square)));
    sum->within = lanes_within(sum->within, d, lanes_set(row->limit));
    return;
  }
  const Pattern *bond = &o->family->patterns[pattern];
  d *= -lanes_set(bond->by_square);
  sum->largest = lanes_greatest(sum->largest, d * d);
  sum->sum += by_own(o, factors, slice, slot, half,
                     by_surface(o, factors, slice, slot, half,
                                lanes_set(2 * o->resisting[pattern].weight / bond->by_square) * stretch_of(d, range)));
}

LANES_INLINE void dilate_stored(const Ordinary *o, int64_t slice, int64_t slot, int half, bool gaps, Factors factors,
                                StretchRange range, const StretchHere *here, StretchWalk *walk, Dilated *sum)
{
  const int64_t at = walk->at;
  const StretchShown there = stretch_next(walk);
  const StretchEnds ends = stretch_ends(o->family, o->by_length, &there, at, o->family->intact[slot], half, gaps, here);
  sum->largest = lanes_greatest(sum->largest, ends.d * ends.d);
  sum->sum += by_own(o, factors, slice, slot, half, by_surface(o, factors, slice, slot, half, ends.weight)) *
              stretch_of(ends.d, range) * ends.square;
}

/** Sums of a slice, all bonds by one way. @return the way that they should go */
LANES_INLINE StretchRange dilate_slice(const Ordinary *o, double *const *u, int64_t slice, bool gaps, Factors factors,
                                       StretchRange range)
{
  const Family *f = o->family;
  Dilated sum[HALVES];
  Lanes own[HALVES][3];
  double most = 0;
  for (int half = 0; half < HALVES; ++half) {
    sum[half] = (Dilated){.within = lanes_all_within()};
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + slice * SLICE + LANES * half);
  }
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    for (int half = 0; half < HALVES; ++half)
      dilate_lattice(o, u, slice, slot, half, gaps, factors, range, own[half], &sum[half]);
  for (int half = 0; half < HALVES; ++half) {
    const StretchHere at = stretch_here(o->particles, u, slice, half);
    StretchWalk walk = stretch_walk(f, o->shown, f->stored[slice], f->first[slice + 1], half);
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      dilate_stored(o, slice, slot, half, gaps, factors, range, &at, &walk, &sum[half]);
  }
  for (int half = 0; half < HALVES; ++half) {
    const int64_t here = slice * SLICE + LANES * half;
    lanes_store(o->dilatation + here, lanes_load(o->inverse + here) * sum[half].sum);
    if (!lanes_are_within(sum[half].within)) most = INFINITY;
    for (int k = 0; k < LANES; ++k) most = sum[half].largest[k] > most ? sum[half].largest[k] : most;
  }
  return stretch_range_after(range, most);
}

LANES_INLINE StretchRange dilate_way(const Ordinary *o, double *const *u, int64_t slice, bool gaps, Factors factors,
                                     StretchRange range)
{
  if (range == RANGE_SERIES) return dilate_slice(o, u, slice, gaps, factors, RANGE_SERIES);
  if (range == RANGE_NEWTON) return dilate_slice(o, u, slice, gaps, factors, RANGE_NEWTON);
  return dilate_slice(o, u, slice, gaps, factors, RANGE_ANY);
}

/** Sums of a slice by one way, with what it has of gaps and factors known when this is compiled. */
static StretchRange dilate_any(const Ordinary *o, double *const *u, int64_t slice, StretchRange range)
{
  const Factors factors = factors_of(o, slice);
  const Factors surface = {factors.surface, NULL};
  if (factors.unlike) return dilate_way(o, u, slice, true, factors, range);
  if (factors.surface && o->gaps[slice]) return dilate_way(o, u, slice, true, surface, range);
  if (factors.surface) return dilate_way(o, u, slice, false, surface, range);
  if (o->gaps[slice]) return dilate_way(o, u, slice, true, (Factors){0}, range);
  return dilate_way(o, u, slice, false, (Factors){0}, range);
}

static int64_t dilate(const Ordinary *ordinary, const Sweep *sweep)
{
  const Ordinary local = *ordinary, *o = &local; /* so that stores are seen not to change it */
  const int64_t last = sweep->last;
  for (int64_t slice = sweep->first; slice < last; ++slice) {
    /* Begins with the way of the last time, and ends with the first way that is good: what came before does not show in the bits. */
    StretchRange range = (StretchRange)o->range[slice], next = range;
    for (int turn = 0; turn < 3; ++turn) {
      range = next;
      next = dilate_any(o, sweep->displacement, slice, range);
      if (next == range) break;
    }
    o->range[slice] = (uint8_t)range;
  }
  return -1;
}

/* ---- force states and forces ---- */

static int64_t respond(const Ordinary *o, const Sweep *sweep)
{
  const double pull = ordinary_coupling(o->space, ordinary_material(o, sweep->first * SLICE)).pull;
  const double *free = o->particles->free_strain;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; place += LANES) {
    Lanes base = lanes_load(o->volumetric + place) * lanes_load(o->dilatation + place);
    /* bonds and dilatation less those of the free strain, both of which are in proportion to |xi| */
    if (free)
      base -= (lanes_set(o->dimensions) * lanes_load(o->left + place) * lanes_load(o->volumetric + place) +
               lanes_load(o->shear + place)) *
              lanes_load(free + place);
    if (o->flow)
      base -= lanes_set(pull) * lanes_load(o->share + place) * lanes_load(o->inverse + place) *
              lanes_load(o->flow->across[1] + place);
    lanes_store(o->base + place, base);
    lanes_store(o->slope + place, lanes_load(o->shear + place) - base);
  }
  for (int64_t place = sweep->first * SLICE; o->answer && place < sweep->last * SLICE; ++place) {
    o->answer[2 * place] = o->base[place];
    o->answer[2 * place + 1] = o->slope[place];
  }
  return -1;
}

/** Adds a and b - a of the other ends of half a slot to those of its own ends, with the factors near interfaces.
 *  @param[in] stored  the other ends of a stored slot, or NULL
 *  @param[in] there  first of the other ends of a lattice slot
 *  @param[in,out] base, slope  of the own ends; sums of both */
LANES_INLINE void add_states(const Ordinary *o, Factors factors, int64_t slice, int64_t slot, int half,
                             const int32_t *stored, int64_t there, const Lanes other[2], Lanes *base, Lanes *slope)
{
  if (!factors.unlike) {
    *base += other[0];
    *slope += other[1];
    return;
  }
  const double *free = o->particles->free_strain;
  const int64_t here = slice * SLICE + LANES * half;
  const Lanes own = unlike_factor(o, factors, slice, slot, half, ORDINARY_OWN),
              others = unlike_factor(o, factors, slice, slot, half, ORDINARY_OTHER),
              spring = unlike_factor(o, factors, slice, slot, half, ORDINARY_SPRING);
  const Lanes stiffness = spring * (*base + *slope + other[0] + other[1]);
  *base = own * *base + others * other[0];
  if (free) { /* a has the free strain of b, by the factors of the dilatation */
    const Lanes shear = stored ? lanes_gather(o->shear, stored) : lanes_load(o->shear + there),
                strain = stored ? lanes_gather(free, stored) : lanes_load(free + there);
    *base +=
        (own - spring) * lanes_load(o->shear + here) * lanes_load(free + here) + (others - spring) * shear * strain;
  }
  *slope = stiffness - *base;
}

/** With A = a_i + a_j and C = b_i + b_j - A the force of a bond is w (A + C g) y: e / |y| is g, and |xi| / |y| is 1 - g. */
LANES_INLINE void resist_lattice(const Ordinary *o, double *const *u, int64_t slice, int64_t slot, int half, bool gaps,
                                 Factors factors, StretchRange range, const Lanes own[3], Lanes base, Lanes slope,
                                 Lanes force[3])
{
  const int pattern = family_pattern(o->family, slice, slot);
  const OrdinaryResisting *row = &o->resisting[pattern];
  const int64_t there = family_base(o->family, slice, slot) + LANES * half;
  Lanes twice[3], d = lattice_stretch(o, u, row->twice, slice, slot, half, own, twice), g;
  const Lanes weight = lanes_set(row->weight);
  const Lanes other[2] = {lanes_load(o->base + there), lanes_load(o->slope + there)};
  add_states(o, factors, slice, slot, half, NULL, there, other, &base, &slope);
  if (range == RANGE_SERIES)
    g = series_of(row->series, d, d * d);
  else
    g = weight * shortening(-lanes_set(o->family->patterns[pattern].by_square) * d, range);
  Lanes pull = by_surface(o, factors, slice, slot, half, weight * base + slope * g);
  if (gaps) pull = lanes_intact(o->family->intact[slot], half, pull);
  for (int k = 0; k < 3; ++k) force[k] += pull * twice[k];
}

LANES_INLINE void resist_stored(const Ordinary *o, int64_t slice, int64_t slot, int half, bool gaps, Factors factors,
                                StretchRange range, const StretchHere *here, Lanes base, Lanes slope, StretchWalk *walk,
                                Lanes force[3])
{
  const Family *f = o->family;
  const int64_t at = walk->at;
  const StretchShown there = stretch_next(walk);
  const StretchEnds ends = stretch_ends(f, o->by_length, &there, at, f->intact[slot], half, gaps, here);
  Lanes answer[2];
  lanes_gather_pairs(o->answer, f->neighbour + at, answer);
  family_fetch_ahead(f, at, o->answer, 2);
  add_states(o, factors, slice, slot, half, f->neighbour + at, 0, answer, &base, &slope);
  Lanes pull = by_surface(o, factors, slice, slot, half, ends.weight) * (base + slope * shortening(ends.d, range));
  if (gaps) pull = lanes_intact(f->intact[slot], half, pull);
  for (int k = 0; k < 3; ++k) force[k] += pull * ends.y[k];
}

LANES_INLINE void resist_slice(const Ordinary *o, const Sweep *sweep, int64_t slice, bool gaps, Factors factors,
                               StretchRange range)
{
  const Family *f = o->family;
  double *const *u = sweep->displacement;
  Lanes own[HALVES][3], force[HALVES][3] = {{{0}}}, base[HALVES], slope[HALVES];
  for (int half = 0; half < HALVES; ++half) {
    const int64_t here = slice * SLICE + LANES * half;
    base[half] = lanes_load(o->base + here);
    slope[half] = lanes_load(o->slope + here);
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(u[k] + here);
  }
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    for (int half = 0; half < HALVES; ++half)
      resist_lattice(o, u, slice, slot, half, gaps, factors, range, own[half], base[half], slope[half], force[half]);
  for (int half = 0; half < HALVES; ++half) {
    const StretchHere here = stretch_here(o->particles, u, slice, half);
    StretchWalk walk = stretch_walk(f, o->shown, f->stored[slice], f->first[slice + 1], half);
    for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
      resist_stored(o, slice, slot, half, gaps, factors, range, &here, base[half], slope[half], &walk, force[half]);
  }
  for (int half = 0; half < HALVES; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(sweep->internal[k] + slice * SLICE + LANES * half, force[half][k]);
}

LANES_INLINE void resist_way(const Ordinary *o, const Sweep *sweep, int64_t slice, bool gaps, Factors factors)
{
  const StretchRange range = (StretchRange)o->range[slice];
  if (range == RANGE_SERIES)
    resist_slice(o, sweep, slice, gaps, factors, RANGE_SERIES);
  else if (range == RANGE_NEWTON)
    resist_slice(o, sweep, slice, gaps, factors, RANGE_NEWTON);
  else
    resist_slice(o, sweep, slice, gaps, factors, RANGE_ANY);
}

static int64_t resist(const Ordinary *ordinary, const Sweep *sweep)
{
  const Ordinary local = *ordinary, *o = &local; /* so that stores are seen not to change it */
  const int64_t last = sweep->last;
  for (int64_t slice = sweep->first; slice < last; ++slice) {
    const Factors factors = factors_of(o, slice);
    const Factors surface = {factors.surface, NULL};
    if (factors.unlike)
      resist_way(o, sweep, slice, true, factors);
    else if (factors.surface && o->gaps[slice])
      resist_way(o, sweep, slice, true, surface);
    else if (factors.surface)
      resist_way(o, sweep, slice, false, surface);
    else if (o->gaps[slice])
      resist_way(o, sweep, slice, true, (Factors){0});
    else
      resist_way(o, sweep, slice, false, (Factors){0});
  }
  return -1;
}

const OrdinarySweeps LANES_NAMED(ordinary_sweeps) = {.dilate = dilate, .respond = respond, .resist = resist};

#include "formulation/ordinary.h"

#include <math.h>

static int64_t show_displacements(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  const Particles *p = o->particles;
  for (int64_t place = sweep->first * SLICE; o->shown && !sweep->at && place < sweep->last * SLICE; ++place) {
    double *shown = o->shown + STRETCH_SHOWN * place;
    for (int k = 0; k < 3; ++k) {
      shown[k] = p->position[k][place];
      shown[4 + k] = p->displacement[k][place];
    }
    shown[3] = p->volume[place];
  }
  return -1;
}

/** Half a slot between lattice neighbours: -|xi|^2 d, and 2 y. */
LANES_INLINE Lanes lattice_stretch(const Ordinary *o, const double *doubled, int64_t slot, int half, const Lanes own[3],
                                   Lanes twice[3])
{
  const int64_t there = o->family->base[slot] + LANES * half;
  Lanes d = {0};
  for (int k = 0; k < 3; ++k) {
    const Lanes back = own[k] - lanes_load(o->particles->displacement[k] + there);
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

/* ---- dilatation ---- */

typedef struct Dilated {
  Lanes sum, largest; /* |d|, beyond the series */
  LaneMask beyond;    /* the series */
} Dilated;

/** Stretch from d and g(d). */
LANES_INLINE Lanes stretch_of(Lanes d, StretchRange range)
{
  const Lanes g = shortening(d, range);
  return d * (lanes_set(1) - g) - g;
}

LANES_INLINE void dilate_lattice(const Ordinary *o, int64_t slot, int half, bool gaps, StretchRange range,
                                 const Lanes own[3], Dilated *sum)
{
  const int pattern = o->family->pattern[slot];
  const OrdinaryDilating *row = &o->dilating[pattern];
  Lanes twice[3], d = lattice_stretch(o, row->twice, slot, half, own, twice);
  if (gaps) d = lanes_where(lanes_half(o->family->intact[slot], half), d);
  if (range == RANGE_SERIES) {
    const Lanes square = d * d;
    sum->sum += series_of(row->series, d, square);
    sum->beyond |= (LaneMask)(square > lanes_set(row->limit));
    return;
  }
  const Pattern *bond = &o->family->patterns[pattern];
  d *= -lanes_set(bond->by_square);
  sum->largest = lanes_greatest(sum->largest, lanes_absolute(d));
  sum->sum += lanes_set(2 * o->resisting[pattern].weight / bond->by_square) * stretch_of(d, range);
}

LANES_INLINE void dilate_stored(const Ordinary *o, int64_t slot, int64_t slice, int half, StretchRange range,
                                const Lanes own[3], Dilated *sum)
{
  const StretchEnds ends = stretch_ends(o->family, o->shown, slice, slot, half, own);
  const LaneMask intact = lanes_half(o->family->intact[slot], half);
  sum->largest = lanes_greatest(sum->largest, lanes_absolute(ends.d));
  sum->sum += lanes_where(intact, ends.weight * stretch_of(ends.d, range) * ends.square);
}

/** Sums of a slice, all bonds by one way. @return the way that they should go */
LANES_INLINE StretchRange dilate_slice(const Ordinary *o, int64_t slice, bool gaps, StretchRange range)
{
  const Family *f = o->family;
  Dilated sum[2] = {{.beyond = {0}}, {.beyond = {0}}};
  const int64_t here = slice * SLICE;
  Lanes own[2][3];
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(o->particles->displacement[k] + here + LANES * half);
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    for (int half = 0; half < 2; ++half) dilate_lattice(o, slot, half, gaps, range, own[half], &sum[half]);
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int half = 0; half < 2; ++half) dilate_stored(o, slot, slice, half, range, own[half], &sum[half]);
  for (int half = 0; half < 2; ++half)
    lanes_store(o->dilatation + here + LANES * half, lanes_load(o->inverse + here + LANES * half) * sum[half].sum);
  const Lanes largest = lanes_greatest(sum[0].largest, sum[1].largest);
  const LaneMask beyond = sum[0].beyond | sum[1].beyond;
  double most = beyond[0] | beyond[1] | beyond[2] | beyond[3] ? INFINITY : 0;
  for (int k = 0; k < LANES; ++k) most = largest[k] > most ? largest[k] : most;
  if (range == RANGE_SERIES && most > range_limit[RANGE_SERIES]) return RANGE_NEWTON;
  return stretch_range(most);
}

LANES_INLINE StretchRange dilate_way(const Ordinary *o, int64_t slice, bool gaps, StretchRange range)
{
  if (range == RANGE_SERIES && o->wide && stretch_is_wide(o->family, slice)) return ordinary_dilate_wide(o, slice);
  if (range == RANGE_SERIES) return dilate_slice(o, slice, gaps, RANGE_SERIES);
  if (range == RANGE_NEWTON) return dilate_slice(o, slice, gaps, RANGE_NEWTON);
  return dilate_slice(o, slice, gaps, RANGE_ANY);
}

BRECCIA_CLONES
static int64_t dilate(void *formulation, const Sweep *sweep)
{
  const Ordinary local = *(const Ordinary *)formulation, *o = &local; /* so that stores are seen not to change it */
  const int64_t last = sweep->last;
  if (sweep->at) return ordinary_change_dilatation(o, sweep);
  for (int64_t slice = sweep->first; slice < last; ++slice) {
    /* Begins with the way of the last time, and ends with the first way that is good: what came before does not show in the bits. */
    StretchRange range = (StretchRange)o->range[slice], next = range;
    for (int turn = 0; turn < 3; ++turn) {
      range = next;
      next = o->gaps[slice] ? dilate_way(o, slice, true, range) : dilate_way(o, slice, false, range);
      if (next == range) break;
    }
    o->range[slice] = (uint8_t)range;
  }
  return -1;
}

/* ---- force states and forces ---- */

BRECCIA_CLONES
static int64_t respond(void *formulation, const Sweep *sweep)
{
  const Ordinary *o = formulation;
  if (sweep->at) return ordinary_change_states(o, sweep);
  if (o->flow && !sweep->no_law) ordinary_flow(o, sweep);
  const double pull = ordinary_coupling(o->space, ordinary_material(o, sweep->first * SLICE)).pull;
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE; place += LANES) {
    Lanes base = lanes_load(o->volumetric + place) * lanes_load(o->dilatation + place);
    if (o->flow)
      base -= lanes_set(pull) * lanes_load(o->share + place) * lanes_load(o->inverse + place) *
              lanes_load(o->flow->across[1] + place);
    lanes_store(o->base + place, base);
    lanes_store(o->slope + place, lanes_load(o->shear + place) - base);
  }
  for (int64_t place = sweep->first * SLICE; o->shown && place < sweep->last * SLICE; ++place)
    o->shown[STRETCH_SHOWN * place + STRETCH_SHOWN - 1] = o->base[place];
  return -1;
}

/** With A = a_i + a_j and C = b_i + b_j - A the force of a bond is w (A + C g) y: e / |y| is g, and |xi| / |y| is 1 - g. */
LANES_INLINE void resist_lattice(const Ordinary *o, int64_t slot, int half, bool gaps, StretchRange range,
                                 const Lanes own[3], Lanes base, Lanes slope, Lanes force[3])
{
  const int pattern = o->family->pattern[slot];
  const OrdinaryResisting *row = &o->resisting[pattern];
  const int64_t there = o->family->base[slot] + LANES * half;
  Lanes twice[3], d = lattice_stretch(o, row->twice, slot, half, own, twice), g;
  const Lanes weight = lanes_set(row->weight);
  base += lanes_load(o->base + there);
  slope += lanes_load(o->slope + there);
  if (range == RANGE_SERIES)
    g = series_of(row->series, d, d * d);
  else
    g = weight * shortening(-lanes_set(o->family->patterns[pattern].by_square) * d, range);
  Lanes pull = weight * base + slope * g;
  if (gaps) pull = lanes_where(lanes_half(o->family->intact[slot], half), pull);
  for (int k = 0; k < 3; ++k) force[k] += pull * twice[k];
}

LANES_INLINE void resist_stored(const Ordinary *o, int64_t slot, int64_t slice, int half, StretchRange range,
                                const Lanes own[3], Lanes base, Lanes slope, Lanes force[3])
{
  const Family *f = o->family;
  const StretchEnds ends = stretch_ends(f, o->shown, slice, slot, half, own);
  base += ends.last;
  slope += lanes_gather(o->slope, f->neighbour + (int64_t)f->base[slot] * SLICE + LANES * half);
  const Lanes pull =
      lanes_where(lanes_half(f->intact[slot], half), ends.weight * (base + slope * shortening(ends.d, range)));
  for (int k = 0; k < 3; ++k) force[k] += pull * ends.y[k];
}

LANES_INLINE void resist_slice(const Ordinary *o, int64_t slice, bool gaps, StretchRange range)
{
  const Family *f = o->family;
  Lanes own[2][3], force[2][3] = {{{0}}}, base[2], slope[2];
  for (int half = 0; half < 2; ++half) {
    const int64_t here = slice * SLICE + LANES * half;
    base[half] = lanes_load(o->base + here);
    slope[half] = lanes_load(o->slope + here);
    for (int k = 0; k < 3; ++k) own[half][k] = lanes_load(o->particles->displacement[k] + here);
  }
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot)
    for (int half = 0; half < 2; ++half)
      resist_lattice(o, slot, half, gaps, range, own[half], base[half], slope[half], force[half]);
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int half = 0; half < 2; ++half)
      resist_stored(o, slot, slice, half, range, own[half], base[half], slope[half], force[half]);
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k < 3; ++k) lanes_store(o->particles->internal[k] + slice * SLICE + LANES * half, force[half][k]);
}

LANES_INLINE void resist_way(const Ordinary *o, int64_t slice, bool gaps, StretchRange range)
{
  if (range == RANGE_SERIES && o->wide && stretch_is_wide(o->family, slice))
    ordinary_resist_wide(o, slice);
  else if (range == RANGE_SERIES)
    resist_slice(o, slice, gaps, RANGE_SERIES);
  else if (range == RANGE_NEWTON)
    resist_slice(o, slice, gaps, RANGE_NEWTON);
  else
    resist_slice(o, slice, gaps, RANGE_ANY);
}

BRECCIA_CLONES
static int64_t resist(void *formulation, const Sweep *sweep)
{
  const Ordinary local = *(const Ordinary *)formulation, *o = &local; /* so that stores are seen not to change it */
  const int64_t last = sweep->last;
  if (sweep->at) return ordinary_change_forces(o, sweep);
  for (int64_t slice = sweep->first; slice < last; ++slice)
    if (o->gaps[slice])
      resist_way(o, slice, true, (StretchRange)o->range[slice]);
    else
      resist_way(o, slice, false, (StretchRange)o->range[slice]);
  if (o->flow) ordinary_flow_resist(o, sweep);
  return -1;
}

const FormulationType formulation_ordinary = {
    .name = "ordinary",
    .about = "ordinary state-based: bonds resist by the dilatation of both families and by their own elongation; any "
             "Poisson ratio",
    .source = "Silling et al. 2007",
    .maturity = "verified against closed forms",
    .components = 6,
    .keeps_no_points = true,
    .takes = ordinary_takes,
    .check_material = ordinary_check_material,
    .bond_lengths = true,
    .joins = true,
    .section = &ordinary_section,
    .check = ordinary_check,
    .create = ordinary_create,
    .destroy = ordinary_destroy,
    .renew = ordinary_renew,
    .phases =
        {{.run = show_displacements, .reads = OF_DISPLACEMENTS, .writes = OF_SHOWN},
         {.run = dilate, .reads = OF_DISPLACEMENTS, .writes = OF_STRAINS, .of_neighbours = OF_DISPLACEMENTS | OF_SHOWN},
         {.run = respond, .reads = OF_STRAINS | OF_STRESSES, .writes = OF_STATES, .of_neighbours = OF_DISPLACEMENTS},
         {.run = resist,
          .reads = OF_DISPLACEMENTS | OF_STATES,
          .writes = OF_FORCES,
          .of_neighbours = OF_DISPLACEMENTS | OF_STATES}},
    .linearise = ordinary_linearise,
    .half_state = ordinary_half_state,
    .point_count = ordinary_point_count,
    .point = ordinary_point,
    .shares = ordinary_shares,
    .state = ordinary_state,
    .commit = ordinary_commit,
    .history = ordinary_history,
    .stored_energy = ordinary_stored_energy,
    .energy_room = ordinary_energy_room,
    .gradient = ordinary_gradient,
    .stress = ordinary_stress,
    .critical_stretch = ordinary_critical_stretch,
    .former_bonds = ordinary_former_bonds,
    .describe = ordinary_describe,
    .bytes = ordinary_bytes,
};

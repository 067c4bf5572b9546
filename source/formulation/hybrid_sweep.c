/* The sweeps of hybrid peridynamics: eight bonds of a lattice slot at once, from displacements to forces; listed bonds one by one.
 *
 * A slice's bonds along the lattice lead from places side by side to places side by side, so that a member of the eight bonds of a slot is the base of
 * another slot and a vector g that all eight share. Where their geometries differ, at the ends of rows and beside cracks, the slot is gone through once for each
 * of these, and lanes of others are left as they are. */
#include "formulation/hybrid_slice.h"

#include "base/tensor.h"
#include <string.h>

/** The rows of a sweep: those of lattice slots come first, and batches of rows divide none. */
LANES_INLINE void find_batch(const Hybrid *h, const Sweep *sweep, SliceOf *s)
{
  find_slice(h, sweep->first, s);
  const int64_t from = sweep->row - h->bonds->first[sweep->first], left = SLICE * (int64_t)s->groups - from;
  s->sweep = sweep;
  s->first += from / SLICE;
  s->groups = left <= 0 ? 0 : (int)((left < sweep->rows ? left : sweep->rows) / SLICE);
}

/** The next geometry of half a slot and the lanes that have it, of those that are left. */
LANES_INLINE const HybridGeometry *next_geometry(const Hybrid *h, int64_t group, int half, unsigned *left,
                                                 unsigned *lanes)
{
  const int32_t whole = h->group[group];
  *lanes = *left;
  *left = 0;
  if (whole >= 0) return &h->table.geometry[whole];
  const int32_t *mixed = h->mixed[-1 - whole] + half, first = mixed[__builtin_ctz(*lanes)];
  for (int lane = 0; lane < LANES; ++lane)
    if (mixed[lane] != first) *left |= *lanes & 1u << lane;
  *lanes &= ~*left;
  return &h->table.geometry[first];
}

/** Number of the listed row of a lane, or -1. */
LANES_INLINE int64_t listed_at(const Hybrid *h, int64_t group, int lane)
{
  const int32_t whole = h->group[group];
  return whole >= 0 || h->mixed[-1 - whole][lane] >= -1 ? -1 : -2 - (int64_t)h->mixed[-1 - whole][lane];
}

/** Number of the listed row of row i of a batch, or -1. */
static int64_t listed_of(const SliceOf *s, int i)
{
  if (i < SLICE * s->groups) return listed_at(s->h, s->first + i / SLICE, i % SLICE);
  const BondList *l = s->h->bonds;
  return s->h->listed_first[s->sweep->first + 1] - (l->first[s->sweep->first + 1] - (s->sweep->row + i));
}

/** G of half of a slot. */
LANES_INLINE void lane_gradient(const SliceOf *s, const HybridGeometry *geometry, double *const u[3], int lane,
                                Lanes g[9])
{
  const double(*vector)[3] = (const double(*)[3])(s->h->table.g + geometry->first);
  const uint16_t *near = s->h->table.near + geometry->first;
  for (int k = 0; k < 9; ++k) g[k] = lanes_set(0);
  if (geometry->mirrored) {
    for (int n = 0; n + 1 < geometry->count; n += 2) {
      const int64_t a = s->base[near[n]] + lane, b = s->base[near[n + 1]] + lane;
      for (int k = 0; k < 3; ++k) {
        const Lanes apart = lanes_load(u[k] + a) - lanes_load(u[k] + b);
        for (int j = 0; j < 3; ++j) g[3 * k + j] += apart * lanes_set(vector[n][j]);
      }
    }
    return;
  }
  for (int n = 0; n < geometry->count; ++n)
    for (int k = 0; k < 3; ++k) {
      const Lanes moved = lanes_load(u[k] + s->base[near[n]] + lane);
      for (int j = 0; j < 3; ++j) g[3 * k + j] += moved * lanes_set(vector[n][j]);
    }
}

/** Numbers of the lanes of a mask; the others are kept. */
LANES_INLINE void store_where(double *to, LaneMask mask, bool whole, Lanes value)
{
  lanes_store(to, whole ? value : lanes_choose(mask, value, lanes_load(to)));
}

/** Strains of half a slot. In a linearised step their change, with the change g of G. */
LANES_INLINE void deform_half(const SliceOf *s, const HybridGeometry *geometry, int at, int lane, unsigned lanes,
                              bool linear)
{
  const Sweep *sweep = s->sweep;
  const bool finite = s->h->finite;
  const LaneMask mask = lanes_mask(lanes);
  Lanes g[9], g0[9];
  lane_gradient(s, geometry, sweep->displacement, lane, g);
  if (linear && finite) lane_gradient(s, geometry, sweep->linearised_at, lane, g0);
  for (int k = 0; k < 9; ++k) store_where(sweep->carry + k * BATCH + at, mask, lanes == 15, g[k]);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    if (k == ZZ && s->h->points->plane_stress) continue; /* that strain is the law's affair */
    Lanes strain = g[3 * r + c] + g[3 * c + r];
    if (finite && !linear) strain += g[r] * g[c] + g[3 + r] * g[3 + c] + g[6 + r] * g[6 + c];
    for (int j = 0; j < 3 && finite && linear; ++j)
      strain += g0[3 * j + r] * g[3 * j + c] + g[3 * j + r] * g0[3 * j + c];
    store_where(sweep->strain[k] + at, mask, lanes == 15, k < 3 ? strain * lanes_set(0.5) : strain);
  }
}

static void deform_listed(const Hybrid *h, const Sweep *sweep, int i, int64_t number)
{
  double g[9] = {0}, at[9] = {0}, strain[6];
  Lanes column[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int64_t n = h->first[number]; n < h->first[number + 1] && !h->idle[number]; ++n) {
    const Lanes u = lanes_load(h->shown + LANES * (int64_t)h->member[n]);
    for (int j = 0; j < 3; ++j) column[j] += u * lanes_set(h->g[n][j]);
    for (int k = 0; k < 9 && sweep->linearised_at; ++k)
      at[k] += sweep->linearised_at[k / 3][h->member[n]] * h->g[n][k % 3];
  }
  for (int k = 0; k < 9; ++k) sweep->carry[k * BATCH + i] = g[k] = column[k % 3][k / 3];
  if (sweep->linearised_at)
    hybrid_strain_change(h, at, g, strain);
  else
    hybrid_strain(h, g, strain);
  const HybridLaminate *laminate = hybrid_laminate(h, number);
  const bool begins = laminate && !sweep->linearised_at; /* free strains do not change in a linearised step */
  hybrid_laminate_strain(h, laminate, begins ? hybrid_laminate_free(h, h->member + h->first[number]) : 0, strain);
  const bool stays = h->idle[number] && !sweep->linearised_at; /* as of broken bonds along lattices */
  for (int k = 0; k < 6; ++k)
    if (!stays && (k != ZZ || !h->points->plane_stress)) sweep->strain[k][i] = strain[k];
}

/** Half a slot of which rows carry nothing. A bond that has broken keeps its strain: laws are still asked, and one that jumps to 0 may not be
 *  integrated. */
LANES_INLINE void clear_half(const Hybrid *h, const Sweep *sweep, int at, bool linear)
{
  for (int k = 0; k < 9; ++k) lanes_store(sweep->carry + k * BATCH + at, lanes_set(0));
  for (int k = 0; k < 6 && linear; ++k)
    if (k != ZZ || !h->points->plane_stress) lanes_store(sweep->strain[k] + at, lanes_set(0));
}

LANES_INLINE void deform_groups(const SliceOf *s, bool linear)
{
  const Hybrid *h = s->h;
  for (int n = 0; n < s->groups; ++n)
    for (int lane = 0; lane < SLICE; lane += LANES) {
      const int64_t group = s->first + n;
      unsigned left = (unsigned)h->active[group] >> lane & 15u, lanes;
      if (left != 15) clear_half(h, s->sweep, SLICE * n + lane, linear);
      while (left) {
        const HybridGeometry *geometry = next_geometry(h, group, lane, &left, &lanes);
        deform_half(s, geometry, SLICE * n + lane, lane, lanes, linear);
      }
    }
}

BRECCIA_CLONES
static void deform_rows(const Hybrid *h, const Sweep *sweep)
{
  const Sweep own = *sweep; /* so that stores are seen not to change it */
  SliceOf s;
  find_batch(h, &own, &s);
  if (own.linearised_at)
    deform_groups(&s, true);
  else
    deform_groups(&s, false);
  if (h->moments) {
    hybrid_moments_deform(h, &own);
    return;
  }
  for (int i = h->mixed_count ? 0 : SLICE * s.groups; i < own.rows && h->listed; ++i) {
    const int64_t number = listed_of(&s, i);
    if (number >= 0) deform_listed(h, &own, i, number);
  }
}

int64_t hybrid_show(void *formulation, const Sweep *sweep)
{
  const Hybrid *h = formulation;
  if (h->moments) hybrid_moments_show(h, sweep);
  for (int64_t place = sweep->first * SLICE; place < sweep->last * SLICE && h->shown; ++place)
    for (int k = 0; k < 3; ++k) h->shown[LANES * place + k] = sweep->displacement[k][place];
  return -1;
}

int64_t hybrid_deform(void *formulation, const Sweep *sweep)
{
  const Hybrid *h = formulation;
  if (!h->hooke) deform_rows(h, sweep);
  return -1;
}

/* ---- what bonds exert ---- */

/** F S, or its change, of half a slot. */
LANES_INLINE void lane_stress(const SliceOf *s, const HybridGeometry *geometry, int at, int lane, bool linear,
                              Lanes p[9])
{
  const Sweep *sweep = s->sweep;
  const bool finite = s->h->finite;
  Lanes g[9], g0[9], stress[6], held[6];
  for (int k = 0; k < 6; ++k) stress[k] = lanes_load(sweep->stress[k] + at);
  for (int k = 0; k < 9 && finite; ++k) g[k] = lanes_load(sweep->carry + k * BATCH + at);
  if (linear && finite) {
    lane_gradient(s, geometry, sweep->linearised_at, lane, g0);
    for (int k = 0; k < 6; ++k) held[k] = lanes_load(s->h->points->stress[k] + sweep->row + at);
  }
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      p[3 * r + k] = stress[symmetric_place[3 * r + k]];
      for (int j = 0; finite && j < 3; ++j)
        p[3 * r + k] += g[3 * r + j] * (linear ? held : stress)[symmetric_place[3 * j + k]];
      for (int j = 0; finite && linear && j < 3; ++j)
        p[3 * r + k] += g0[3 * r + j] * stress[symmetric_place[3 * j + k]];
    }
}

LANES_INLINE void add_to(double *to, Lanes value)
{
  lanes_store(to, lanes_load(to) + value);
}

/** Adds what half a slot exerts on its members.
 *  @param[in,out] sums  of lane 0 by vector, [3][room] numbers each */
LANES_INLINE void respond_half(const SliceOf *s, const HybridGeometry *geometry, int at, int lane, unsigned lanes,
                               double *sums, int room, bool linear)
{
  const Hybrid *h = s->h;
  const double(*vector)[3] = (const double(*)[3])(h->table.g + geometry->first);
  const uint16_t *near = h->table.near + geometry->first;
  Lanes p[9];
  lane_stress(s, geometry, at, lane, linear, p);
  const Lanes factor = lanes_set(h->pairwise ? 1 : geometry->volume);
  for (int k = 0; k < 9; ++k) p[k] = lanes == 15 ? p[k] * factor : lanes_where(lanes_mask(lanes), p[k] * factor);
  if (h->pairwise) {
    for (int k = 0; k < 3; ++k) {
      const Lanes force = p[3 * k] * lanes_set(geometry->area[0]) + p[3 * k + 1] * lanes_set(geometry->area[1]) +
                          p[3 * k + 2] * lanes_set(geometry->area[2]);
      add_to(sums + k * room + lane, force);
      add_to(sums + (3 * (int64_t)geometry->other + k) * room + lane, -force);
    }
    return;
  }
  const int step = geometry->mirrored ? 2 : 1;
  for (int n = 0; n + step <= geometry->count; n += step) {
    double *a = sums + 3 * (int64_t)near[n] * room + lane, *b = sums + 3 * (int64_t)near[n + step - 1] * room + lane;
    for (int k = 0; k < 3; ++k) {
      const Lanes force = p[3 * k] * lanes_set(vector[n][0]) + p[3 * k + 1] * lanes_set(vector[n][1]) +
                          p[3 * k + 2] * lanes_set(vector[n][2]);
      lanes_store(a + k * room, lanes_load(a + k * room) - force);
      if (step == 2) add_to(b + k * room, force);
    }
  }
}

LANES_INLINE void respond_groups(const SliceOf *s, double *sums, int room, bool linear)
{
  const Hybrid *h = s->h;
  for (int n = 0; n < s->groups; ++n)
    for (int lane = 0; lane < SLICE; lane += LANES) {
      unsigned left = (unsigned)h->active[s->first + n] >> lane & 15u, lanes;
      while (left) {
        const HybridGeometry *geometry = next_geometry(h, s->first + n, lane, &left, &lanes);
        respond_half(s, geometry, SLICE * n + lane, lane, lanes, sums, room, linear);
      }
    }
}

BRECCIA_CLONES
static void respond_lattice(const Hybrid *h, const Sweep *sweep)
{
  const Sweep own = *sweep;
  const HybridLattice *lattice = &h->lattice[h->particles->block[own.first]];
  const HybridStripe *stripe = stripe_of(h, own.first);
  SliceOf s;
  find_batch(h, &own, &s);
  if (own.row == stripe->row) clear_stripe(stripe);
  if (!s.groups || !lattice->count) return;
  _Alignas(64) double sums[3 * HYBRID_NEAR * MOST_ROOM];
  const int margin = sums_margin(h), room = 2 * margin + SLICE;
  memset(sums, 0, sizeof *sums * (size_t)(3 * lattice->count * room));
  if (own.linearised_at)
    respond_groups(&s, sums + margin, room, true);
  else
    respond_groups(&s, sums + margin, room, false);
  add_to_stripe(&s, stripe, sums + margin, room);
}

static void full_tensor(double *const of[6], int64_t i, double to[6])
{
  for (int k = 0; k < 6; ++k) to[k] = of[k][i];
}

/** G of a listed row at other displacements than those shown. */
static void listed_gradient(const Hybrid *h, double *const u[3], int64_t number, double g[9])
{
  memset(g, 0, 9 * sizeof *g);
  for (int64_t n = h->first[number]; n < h->first[number + 1] && !h->idle[number]; ++n)
    for (int k = 0; k < 9; ++k) g[k] += u[k / 3][h->member[n]] * h->g[n][k % 3];
}

/** Keeps what a listed row exerts, by F S. */
static void keep_listed(const Hybrid *h, int64_t number, const double p[9])
{
  const double *a = h->area[number], factor = h->idle[number] ? 0 : h->pairwise ? 1 : h->volume[number];
  double *to = h->force + HYBRID_FORCE * number;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3 && !h->pairwise; ++j) to[LANES * j + k] = factor * p[3 * k + j];
    if (h->pairwise) to[k] = factor * (p[3 * k] * a[0] + p[3 * k + 1] * a[1] + p[3 * k + 2] * a[2]);
  }
}

static void respond_listed(const Hybrid *h, const Sweep *sweep, int i, int64_t number)
{
  double stress[6], held[6], p[9], g[9], at[9];
  const HybridLaminate *laminate = hybrid_laminate(h, number);
  full_tensor(sweep->stress, i, stress);
  hybrid_laminate_stress(h, laminate, stress);
  for (int k = 0; k < 9; ++k) g[k] = sweep->carry[k * BATCH + i];
  if (sweep->linearised_at) {
    full_tensor(h->points->stress, sweep->row + i, held);
    hybrid_laminate_stress(h, laminate, held);
    listed_gradient(h, sweep->linearised_at, number, at);
  }
  hybrid_first_stress(h, g, stress, sweep->linearised_at ? at : NULL, held, p);
  keep_listed(h, number, p);
}

/** The same from displacements, where the law is Hooke's. @param[in] material  of the row */
static void respond_by_hooke(const Hybrid *h, const Sweep *sweep, int64_t number, int material)
{
  double g[9], at[9], strain[6], stress[6], held[6], p[9];
  const HybridLaminate *laminate = hybrid_laminate(h, number);
  Lanes column[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int64_t n = h->first[number]; n < h->first[number + 1] && !h->idle[number]; ++n) {
    const Lanes u = lanes_load(h->shown + LANES * (int64_t)h->member[n]);
    for (int j = 0; j < 3; ++j) column[j] += u * lanes_set(h->g[n][j]);
  }
  for (int k = 0; k < 9; ++k) g[k] = column[k % 3][k / 3];
  if (sweep->linearised_at) {
    listed_gradient(h, sweep->linearised_at, number, at);
    hybrid_strain(h, at, strain);
    hybrid_laminate_strain(h, laminate, 0, strain);
    hybrid_hooke_stress(&h->hooke[material], strain, held);
    hybrid_laminate_stress(h, laminate, held);
    hybrid_strain_change(h, at, g, strain);
  } else {
    hybrid_strain(h, g, strain);
  }
  hybrid_laminate_strain(h, laminate, 0, strain);
  hybrid_hooke_stress(&h->hooke[material], strain, stress);
  hybrid_laminate_stress(h, laminate, stress);
  hybrid_first_stress(h, g, stress, sweep->linearised_at ? at : NULL, held, p);
  keep_listed(h, number, p);
}

/** All listed rows of a slice. */
static void respond_slice_by_hooke(const Hybrid *h, const Sweep *sweep, int64_t slice)
{
  if (h->moments) {
    hybrid_moments_hooke(h, sweep, slice);
    return;
  }
  const int64_t end = h->listed_first[slice + 1];
  for (int64_t number = h->listed_first[slice]; number < end; ++number) {
    const int64_t single = hybrid_single(h, slice, number);
    respond_by_hooke(h, sweep, number, single < 0 ? h->material[slice] : h->bonds->single_material[single]);
  }
}

int64_t hybrid_respond(void *formulation, const Sweep *sweep)
{
  const Hybrid *h = formulation;
  if (h->hooke) {
    h->hooke_sweep(h, sweep);
    if (h->moments && sweep->first == stripe_of(h, sweep->first)->first)
      hybrid_moments_clear(h, stripe_of(h, sweep->first));
    for (int64_t slice = sweep->first; slice < sweep->last && h->listed; ++slice)
      respond_slice_by_hooke(h, sweep, slice);
    return -1;
  }
  respond_lattice(h, sweep);
  if (!h->listed) return -1;
  if (h->moments) {
    const HybridStripe *stripe = stripe_of(h, sweep->first);
    if (sweep->row == stripe->row) hybrid_moments_clear(h, stripe);
    hybrid_moments_respond(h, sweep);
    return -1;
  }
  SliceOf s;
  find_batch(h, sweep, &s);
  for (int i = h->mixed_count ? 0 : SLICE * s.groups; i < sweep->rows; ++i) {
    const int64_t number = listed_of(&s, i);
    if (number >= 0) respond_listed(h, sweep, i, number);
  }
  return -1;
}

/* ---- forces ---- */

/** Force on a place from the listed points that it has a part in. */
LANES_INLINE Lanes listed_force(const Hybrid *h, int64_t place)
{
  Lanes sum = lanes_set(0);
  if (h->moments) {
    const HybridMoments *m = h->moments;
    for (int64_t n = m->reach_first[place]; n < m->reach_first[place + 1]; ++n)
      sum += lanes_load(m->sums + QUAD * (int64_t)m->reach[n]);
    return sum;
  }
  for (int64_t n = h->met_first[place]; n < h->met_first[place + 1]; ++n) {
    const struct HybridMet *met = &h->met[n];
    const double *force = h->force + HYBRID_FORCE * (int64_t)met->number;
    if (h->pairwise) {
      if (met->member >= 2) continue;
      sum += lanes_set(met->member ? -1 : 1) * lanes_load(force);
      continue;
    }
    const double *g = h->g[h->first[met->number] + met->member];
    for (int j = 0; j < 3; ++j) sum -= lanes_load(force + LANES * j) * lanes_set(g[j]);
  }
  return sum;
}

BRECCIA_CLONES
static void resist_slices(const Hybrid *h, const Sweep *sweep)
{
  const Particles *p = h->particles;
  for (int64_t slice = sweep->first; slice < sweep->last; ++slice) {
    Lanes sum[2][3] = {{{0}}};
    for (int32_t n = h->reaching[slice][0]; n <= h->reaching[slice][1]; ++n) {
      const HybridStripe *stripe = &h->stripe[n];
      const int64_t at = slice * SLICE - stripe->low, size = stripe->high - stripe->low;
      if (at < 0 || at >= size) continue;
      for (int half = 0; half < 2; ++half)
        for (int k = 0; k < 3; ++k) sum[half][k] += lanes_load(stripe->sums + k * size + at + LANES * half);
    }
    for (int lane = 0; lane < SLICE && h->listed; ++lane) {
      const Lanes more = listed_force(h, slice * SLICE + lane);
      for (int k = 0; k < 3; ++k) sum[lane / LANES][k][lane % LANES] += more[k];
    }
    for (int half = 0; half < 2; ++half) {
      const int64_t place = slice * SLICE + LANES * half;
      const Lanes volume = lanes_load(p->volume + place);
      const LaneMask there = (LaneMask)(volume > lanes_set(0));
      for (int k = 0; k < 3; ++k)
        lanes_store(sweep->internal[k] + place,
                    lanes_where(there, sum[half][k] / lanes_choose(there, volume, lanes_set(1))));
    }
  }
}

int64_t hybrid_resist(void *formulation, const Sweep *sweep)
{
  resist_slices(formulation, sweep);
  return -1;
}

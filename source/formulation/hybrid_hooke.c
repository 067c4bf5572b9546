/* The sweep of hybrid bonds whose laws are all Hooke's, from displacements to what members receive, with nothing kept in between, for each kind of vectors.
 * A lane is a bond, whatever its vector's length, so that both give the same bits. Sums of products are therefore added up one by one from a number that is none,
 * even from 0: of two products a compiler may round either before it fuses the other with the sum. */
#include "formulation/hybrid_slice.h"

#include "base/tensor.h"
#include <string.h>

/** Bonds of a slot that have the same members. */
typedef struct HookeBonds {
  int64_t first;                      /* of the members in the table */
  int count;                          /* of members */
  int other;                          /* lattice vector of the other end */
  bool mirrored;                      /* as in HybridGeometry */
  bool alike;                         /* one section counts for all lanes */
  unsigned lanes;                     /* bits */
  double scale[4];                    /* volume; of pairwise bonds section */
  _Alignas(64) double each[4][SLICE]; /* the same lane by lane */
} HookeBonds;

/** What kind of sweep it is: a constant where it is asked. */
enum { HOOKE_FINITE = 1, HOOKE_PAIRWISE = 2, HOOKE_LINEAR = 4 /* a linearised step */ };

/** What a sweep works with, the same for all its slices. */
typedef struct HookeWork {
  double *u[3], *at[3]; /* as in Sweep */
  double lame, shear;
  double *sums; /* of lane 0 by lattice vector, [3][room] */
  int room;
} HookeWork;

LANES_INLINE void take_geometry(const Hybrid *h, HookeBonds *bonds, const HybridGeometry *geometry)
{
  bonds->first = geometry->first;
  bonds->count = geometry->count;
  bonds->other = geometry->other;
  bonds->mirrored = geometry->mirrored;
  for (int k = 0; k < 3 && h->pairwise; ++k) bonds->scale[k] = geometry->area[k];
  if (!h->pairwise) bonds->scale[0] = geometry->volume;
}

/** The next bonds of a slot with the same members, of those lanes that are left. */
LANES_INLINE void next_bonds(const Hybrid *h, int64_t group, unsigned *left, HookeBonds *bonds)
{
  const int32_t whole = h->group[group];
  bonds->lanes = *left;
  bonds->alike = whole >= 0;
  *left = 0;
  if (whole >= 0) {
    take_geometry(h, bonds, &h->table.geometry[whole]);
    return;
  }
  const int32_t *mixed = h->mixed[-1 - whole];
  take_geometry(h, bonds, &h->table.geometry[mixed[__builtin_ctz(bonds->lanes)]]);
  for (int lane = 0; lane < SLICE; ++lane) {
    if (!(bonds->lanes >> lane & 1)) continue;
    const HybridGeometry *geometry = &h->table.geometry[mixed[lane]];
    if (geometry->first != bonds->first) {
      *left |= 1u << lane;
      continue;
    }
    for (int k = 0; k < 3 && h->pairwise; ++k) bonds->each[k][lane] = geometry->area[k];
    if (!h->pairwise) bonds->each[0][lane] = geometry->volume;
  }
  bonds->lanes &= ~*left;
}

/** G of the bonds of lanes `lane` and on. */
LANES_INLINE void find_gradient(const SliceOf *s, const HookeBonds *bonds, double *const u[3], int lane, Lanes g[9])
{
  const double(*vector)[3] = (const double(*)[3])(s->h->table.g + bonds->first);
  const uint16_t *near = s->h->table.near + bonds->first;
  for (int k = 0; k < 9; ++k) g[k] = lanes_set(0);
  if (bonds->mirrored) {
    for (int n = 0; n + 1 < bonds->count; n += 2) {
      const int64_t a = s->base[near[n]] + lane, b = s->base[near[n + 1]] + lane;
      for (int k = 0; k < 3; ++k) {
        const Lanes apart = lanes_load(u[k] + a) - lanes_load(u[k] + b);
        for (int j = 0; j < 3; ++j) g[3 * k + j] += apart * lanes_set(vector[n][j]);
      }
    }
    return;
  }
  for (int n = 0; n < bonds->count; ++n)
    for (int k = 0; k < 3; ++k) {
      const Lanes moved = lanes_load(u[k] + s->base[near[n]] + lane);
      for (int j = 0; j < 3; ++j) g[3 * k + j] += moved * lanes_set(vector[n][j]);
    }
}

/** Hooke's law. */
LANES_INLINE void find_stress(const HookeWork *w, const Lanes strain[6], Lanes stress[6])
{
  const Lanes trace = strain[0] + strain[1] + strain[2];
  for (int k = 0; k < 3; ++k)
    stress[k] = lanes_set(2 * w->shear) * (strain[k] + lanes_set(w->lame / (2 * w->shear)) * trace);
  for (int k = 3; k < 6; ++k) stress[k] = lanes_set(w->shear) * strain[k];
}

/** Strain of a gradient; with engineering shear. */
LANES_INLINE void find_strain(const Lanes g[9], int kind, Lanes strain[6])
{
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    Lanes sum = g[3 * r + c] + g[3 * c + r];
    for (int j = 0; j < 3 && kind & HOOKE_FINITE; ++j) sum += g[3 * j + r] * g[3 * j + c];
    strain[k] = k < 3 ? sum * lanes_set(0.5) : sum;
  }
}

/** Adds G S to p. */
LANES_INLINE void add_turned(const Lanes g[9], const Lanes stress[6], Lanes p[9])
{
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) p[3 * r + k] += g[3 * r + j] * stress[symmetric_place[3 * j + k]];
}

/** F S, or in a linearised step its change. */
LANES_INLINE void find_first_stress(const SliceOf *s, const HookeWork *w, const HookeBonds *bonds, int lane, int kind,
                                    Lanes p[9])
{
  Lanes g[9], strain[6], stress[6];
  find_gradient(s, bonds, w->u, lane, g);
  if (kind != (kind | HOOKE_FINITE | HOOKE_LINEAR)) {
    find_strain(g, kind, strain);
    find_stress(w, strain, stress);
    for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
    if (kind & HOOKE_FINITE) add_turned(g, stress, p);
    return;
  }
  Lanes at[9], held[6];
  find_gradient(s, bonds, w->at, lane, at);
  find_strain(at, kind, strain);
  find_stress(w, strain, held);
  for (int k = 0; k < 6; ++k) {
    const int r = symmetric_row[k], c = symmetric_column[k];
    Lanes sum = g[3 * r + c] + g[3 * c + r];
    for (int j = 0; j < 3; ++j) {
      sum += at[3 * j + r] * g[3 * j + c];
      sum += g[3 * j + r] * at[3 * j + c];
    }
    strain[k] = k < 3 ? sum * lanes_set(0.5) : sum;
  }
  find_stress(w, strain, stress);
  for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
  add_turned(at, stress, p);
  add_turned(g, held, p);
}

/** Those of a vector's lanes whose bit is set. */
LANES_INLINE Lanes of_lanes(unsigned bits, Lanes value)
{
  return bits == (1u << LANES) - 1 ? value : lanes_intact(bits, 0, value);
}

LANES_INLINE void add_vector(double *to, Lanes value)
{
  lanes_store(to, lanes_load(to) + value);
}

LANES_INLINE Lanes scale_of(const HookeBonds *bonds, int k, int lane)
{
  return bonds->alike ? lanes_set(bonds->scale[k]) : lanes_load(bonds->each[k] + lane);
}

/** Adds what bonds exert on their members. */
LANES_INLINE void exert(const SliceOf *s, const HookeWork *w, const HookeBonds *bonds, int lane, int kind)
{
  const unsigned lanes = bonds->lanes >> lane & ((1u << LANES) - 1);
  Lanes p[9];
  find_first_stress(s, w, bonds, lane, kind, p);
  double *sums = w->sums + lane;
  const int room = w->room;
  if (kind & HOOKE_PAIRWISE) {
    for (int k = 0; k < 3; ++k) {
      Lanes force = lanes_set(0);
      for (int j = 0; j < 3; ++j) force += p[3 * k + j] * scale_of(bonds, j, lane);
      force = of_lanes(lanes, force);
      add_vector(sums + k * room, force);
      add_vector(sums + (3 * (int64_t)bonds->other + k) * room, -force);
    }
    return;
  }
  const double(*vector)[3] = (const double(*)[3])(s->h->table.g + bonds->first);
  const uint16_t *near = s->h->table.near + bonds->first;
  const Lanes volume = scale_of(bonds, 0, lane);
  for (int k = 0; k < 9; ++k) p[k] = of_lanes(lanes, p[k] * volume);
  const int step = bonds->mirrored ? 2 : 1;
  for (int n = 0; n + step <= bonds->count; n += step) {
    double *a = sums + 3 * (int64_t)near[n] * room, *b = sums + 3 * (int64_t)near[n + step - 1] * room;
    for (int k = 0; k < 3; ++k) {
      Lanes force = lanes_set(0);
      for (int j = 0; j < 3; ++j) force += p[3 * k + j] * lanes_set(vector[n][j]);
      add_vector(a + k * room, -force);
      if (step == 2) add_vector(b + k * room, force);
    }
  }
}

LANES_INLINE void exert_groups(const SliceOf *s, const HookeWork *w, int kind)
{
  const Hybrid *h = s->h;
  HookeBonds bonds = {0};
  for (int n = 0; n < s->groups; ++n)
    for (unsigned left = h->active[s->first + n]; left;) {
      next_bonds(h, s->first + n, &left, &bonds);
      for (int lane = 0; lane < SLICE; lane += LANES)
        if (bonds.lanes >> lane & ((1u << LANES) - 1)) exert(s, w, &bonds, lane, kind);
    }
}

void LANES_NAMED(hybrid_hooke)(const Hybrid *h, const Sweep *sweep)
{
  const Sweep whole = *sweep; /* so that stores are seen not to change it */
  const int margin = sums_margin(h), room = 2 * margin + SLICE;
  _Alignas(64) double sums[3 * HYBRID_NEAR * MOST_ROOM];
  HookeWork w = {.sums = sums + margin, .room = room};
  const int kind = (h->finite ? HOOKE_FINITE : 0) | (h->pairwise ? HOOKE_PAIRWISE : 0) | (whole.at ? HOOKE_LINEAR : 0);
  for (int k = 0; k < 3; ++k) {
    w.u[k] = h->particles->displacement[k];
    if (whole.at) w.at[k] = whole.at[k];
  }
  int cleared = 0; /* lattice vectors whose sums are zero */
  for (int64_t slice = whole.first; slice < whole.last; ++slice) {
    const HybridLattice *lattice = &h->lattice[h->particles->block[slice]];
    const HybridHooke *hooke = &h->hooke[h->material[slice]];
    const HybridStripe *stripe = stripe_of(h, slice);
    SliceOf s;
    find_slice(h, slice, &s);
    if (slice == stripe->first) clear_stripe(stripe);
    if (!s.groups || !lattice->count) continue;
    if (cleared < lattice->count) {
      memset(sums + 3 * cleared * room, 0, sizeof *sums * (size_t)(3 * (lattice->count - cleared) * room));
      cleared = lattice->count;
    }
    w.lame = hooke->lame;
    w.shear = hooke->shear;
    switch (kind) {
    case 0: exert_groups(&s, &w, 0); break;
    case HOOKE_FINITE: exert_groups(&s, &w, HOOKE_FINITE); break;
    case HOOKE_LINEAR: exert_groups(&s, &w, HOOKE_LINEAR); break;
    case HOOKE_FINITE | HOOKE_LINEAR: exert_groups(&s, &w, HOOKE_FINITE | HOOKE_LINEAR); break;
    case HOOKE_PAIRWISE: exert_groups(&s, &w, HOOKE_PAIRWISE); break;
    case HOOKE_PAIRWISE | HOOKE_FINITE: exert_groups(&s, &w, HOOKE_PAIRWISE | HOOKE_FINITE); break;
    case HOOKE_PAIRWISE | HOOKE_LINEAR: exert_groups(&s, &w, HOOKE_PAIRWISE | HOOKE_LINEAR); break;
    default: exert_groups(&s, &w, HOOKE_PAIRWISE | HOOKE_FINITE | HOOKE_LINEAR);
    }
    add_to_stripe(&s, stripe, w.sums, room);
    for (int n = 0; n < 3 * lattice->count; ++n)
      for (int lane = 0; lane < SLICE; lane += LANES) lanes_store(w.sums + n * room + lane, lanes_set(0));
  }
}

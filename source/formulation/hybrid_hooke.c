/* The sweep of hybrid bonds whose laws are all Hooke's, from displacements to what members receive, with nothing kept in between, for each kind of vectors.
 * A lane is a bond, whatever its vector's length, so that both give the same bits. Sums of products are therefore added up one by one from a number that is none,
 * even from 0: of two products a compiler may round either before it fuses the other with the sum. */
#include "formulation/hybrid_slice.h"

#include "base/tensor.h"
#include <string.h>

/** Bonds of a slot that have the same members. */
typedef struct HookeBonds {
  int64_t first;                      /* of the members in the table */
  const uint16_t *near;               /* lattice vectors that lead to them */
  const double (*vector)[3];          /* their g */
  const int32_t *base;                /* places of lane 0's members by lattice vector */
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
  int kind;
  const HybridStripe *stripe;
  struct HookeAside *aside;
  const HybridHooke *hooke;
  double lame, shear;
  double *sums; /* of lane 0 by lattice vector, [3][room] */
  int room;
} HookeWork;

LANES_INLINE void take_geometry(const Hybrid *h, HookeBonds *bonds, const HybridGeometry *geometry)
{
  bonds->first = geometry->first;
  bonds->near = h->table.near + geometry->first;
  bonds->vector = (const double(*)[3])(h->table.g + geometry->first);
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

/** Numbers of member n of the bonds of lanes `lane` and on. */
LANES_INLINE Lanes of_member(const HookeBonds *bonds, const double *u, int n, int lane)
{
  return lanes_load(u + bonds->base[bonds->near[n]] + lane);
}

/** G of the bonds of lanes `lane` and on. */
LANES_INLINE void find_gradient(const HookeBonds *bonds, double *const u[3], int lane, Lanes g[9])
{
  const double(*vector)[3] = bonds->vector;
  for (int k = 0; k < 9; ++k) g[k] = lanes_set(0);
  if (bonds->mirrored) {
    for (int n = 0; n + 1 < bonds->count; n += 2)
      for (int k = 0; k < 3; ++k) {
        const Lanes apart = of_member(bonds, u[k], n, lane) - of_member(bonds, u[k], n + 1, lane);
        for (int j = 0; j < 3; ++j) g[3 * k + j] += apart * lanes_set(vector[n][j]);
      }
    return;
  }
  for (int n = 0; n < bonds->count; ++n)
    for (int k = 0; k < 3; ++k) {
      const Lanes moved = of_member(bonds, u[k], n, lane);
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
LANES_INLINE void find_first_stress(const HookeWork *w, const HookeBonds *bonds, int lane, int kind, Lanes p[9])
{
  Lanes g[9], strain[6], stress[6];
  find_gradient(bonds, w->u, lane, g);
  if (!(kind & HOOKE_FINITE) || !(kind & HOOKE_LINEAR)) {
    find_strain(g, kind, strain);
    find_stress(w, strain, stress);
    for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
    if (kind & HOOKE_FINITE) add_turned(g, stress, p);
    return;
  }
  Lanes at[9], held[6];
  find_gradient(bonds, w->at, lane, at);
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
LANES_INLINE void exert(const HookeWork *w, const HookeBonds *bonds, int lane, int kind)
{
  const unsigned lanes = bonds->lanes >> lane & ((1u << LANES) - 1);
  Lanes p[9];
  find_first_stress(w, bonds, lane, kind, p);
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
  const double(*vector)[3] = bonds->vector;
  const uint16_t *near = bonds->near;
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

/* ---- bonds that are alone in their slots: those of eight slices at once, a slice a lane ---- */

enum {
  ALONE = 3,   /* bonds of a turn that are put aside, at most */
  BUNDLES = 4, /* that are filled at once */
  FEW = 19,    /* lattice vectors of blocks in which nothing is gained beside whole turns, at most */
  MANY =
      54 /* from so many on displacements around a slice are read so often that bringing them into whole cache lines pays */
};

/** Slices with bonds that are put aside, of one block and in the same lanes. */
typedef struct HookeBundle {
  int slices;
  unsigned lanes;                    /* bits */
  uint8_t aside[HYBRID_NEAR][SLICE]; /* lanes by lattice vector and slice */
  int32_t group[HYBRID_NEAR][SLICE]; /* of their slots, as in Hybrid */
  int32_t base[HYBRID_NEAR][SLICE];
} HookeBundle;

typedef struct HookeAside {
  HookeBundle bundle[BUNDLES];
  int next; /* which is emptied when there is room for no more */
  int block;
  uint8_t lanes[HYBRID_NEAR]; /* of the slice at hand, by lattice vector; and what they are bits of: */
  int32_t group[HYBRID_NEAR];
  bool here[HYBRID_NEAR]; /* what follows is there of these lattice vectors */
  int32_t number[HYBRID_NEAR];
  _Alignas(64) double u[3][HYBRID_NEAR * SLICE], at[3][HYBRID_NEAR * SLICE], sums[3 * HYBRID_NEAR * SLICE];
} HookeAside;

/** Geometry of a lane of a slot. @param[in] group  as in Hybrid */
LANES_INLINE int32_t geometry_of(const Hybrid *h, int32_t group, int lane)
{
  return group >= 0 ? group : h->mixed[-1 - group][lane];
}

/** Bits of lane `lane` of eight bytes. */
LANES_INLINE unsigned bits_of_lane(const uint8_t bytes[SLICE], int lane)
{
  uint64_t all;
  memcpy(&all, bytes, sizeof all);
  return (unsigned)((all >> lane & 0x0101010101010101u) * 0x0102040810204080u >> 56);
}

/** The next bonds of lane `lane` of a bundle's slices with the same members. */
LANES_INLINE void next_aside(const Hybrid *h, const int32_t *group, int lane, unsigned *left, HookeBonds *bonds)
{
  const int32_t first = geometry_of(h, group[__builtin_ctz(*left)], lane);
  unsigned others = 0;
  take_geometry(h, bonds, &h->table.geometry[first]);
  for (unsigned rest = *left; rest; rest &= rest - 1)
    if (geometry_of(h, group[__builtin_ctz(rest)], lane) != first) others |= rest & -rest;
  bonds->alike = true;
  bonds->lanes = *left & ~others;
  *left = others;
  if (!others) return;
  bonds->alike = false;
  for (unsigned rest = bonds->lanes | others; rest; rest &= rest - 1) {
    const int n = __builtin_ctz(rest);
    const HybridGeometry *geometry = &h->table.geometry[geometry_of(h, group[n], lane)];
    if (geometry->first != bonds->first) continue;
    bonds->lanes |= 1u << n;
    for (int k = 0; k < 3 && h->pairwise; ++k) bonds->each[k][n] = geometry->area[k];
    if (!h->pairwise) bonds->each[0][n] = geometry->volume;
  }
  *left &= ~bonds->lanes;
}

/** Brings what the members of bonds are asked for, and forgets what they received. */
LANES_INLINE void bring(const HookeWork *w, const HookeBundle *bundle, const HookeBonds *bonds, int lane, int kind)
{
  HookeAside *aside = w->aside;
  for (int n = 0; n < bonds->count; ++n) {
    const int vector = bonds->near[n], at = SLICE * vector;
    if (aside->here[vector]) continue;
    aside->here[vector] = true;
    for (int k = 0; k < 3; ++k)
      for (int part = 0; part < SLICE; part += LANES) {
        lanes_store(aside->u[k] + at + part, lanes_gather(w->u[k] + lane, bundle->base[vector] + part));
        if (kind & HOOKE_LINEAR)
          lanes_store(aside->at[k] + at + part, lanes_gather(w->at[k] + lane, bundle->base[vector] + part));
        lanes_store(aside->sums + 3 * at + SLICE * k + part, lanes_set(0));
      }
  }
}

/** Adds what they received to the sums of the stripe. */
LANES_INLINE void take_back(const HookeWork *w, const HookeBundle *bundle, int lane, int vectors)
{
  HookeAside *aside = w->aside;
  const int64_t size = w->stripe->high - w->stripe->low;
  double *to = w->stripe->sums - w->stripe->low + lane;
  for (int n = 0; n < vectors; ++n) {
    if (!aside->here[n]) continue;
    aside->here[n] = false;
    for (int k = 0; k < 3; ++k)
      for (int slice = 0; slice < bundle->slices; ++slice)
        to[k * size + bundle->base[n][slice]] += aside->sums[SLICE * (3 * n + k) + slice];
  }
}

LANES_INLINE void exert_lane(const Hybrid *h, const HookeWork *w, const HookeBundle *bundle, int lane, int kind)
{
  HookeAside *aside = w->aside;
  HookeWork work = *w;
  HookeBonds bonds = {.base = aside->number};
  const int vectors = h->lattice[aside->block].count;
  for (int k = 0; k < 3; ++k) {
    work.u[k] = aside->u[k];
    work.at[k] = aside->at[k];
  }
  work.sums = aside->sums;
  work.room = SLICE;
  for (int n = 0; n < vectors; ++n) {
    unsigned left = bits_of_lane(bundle->aside[n], lane) & ((1u << bundle->slices) - 1);
    while (left) {
      next_aside(h, bundle->group[n], lane, &left, &bonds);
      bring(w, bundle, &bonds, lane, kind);
      for (int part = 0; part < SLICE; part += LANES)
        if (bonds.lanes >> part & ((1u << LANES) - 1)) exert(&work, &bonds, part, kind);
    }
  }
  take_back(w, bundle, lane, vectors);
}

/** Lets all that a bundle holds exert what it does, and empties it. */
static void exert_bundle(const Hybrid *h, const HookeWork *w, HookeBundle *bundle)
{
  if (!bundle->slices) return;
  for (unsigned left = bundle->lanes; left; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    switch (w->kind) {
    case 0: exert_lane(h, w, bundle, lane, 0); break;
    case HOOKE_FINITE: exert_lane(h, w, bundle, lane, HOOKE_FINITE); break;
    case HOOKE_LINEAR: exert_lane(h, w, bundle, lane, HOOKE_LINEAR); break;
    case HOOKE_FINITE | HOOKE_LINEAR: exert_lane(h, w, bundle, lane, HOOKE_FINITE | HOOKE_LINEAR); break;
    case HOOKE_PAIRWISE: exert_lane(h, w, bundle, lane, HOOKE_PAIRWISE); break;
    case HOOKE_PAIRWISE | HOOKE_FINITE: exert_lane(h, w, bundle, lane, HOOKE_PAIRWISE | HOOKE_FINITE); break;
    case HOOKE_PAIRWISE | HOOKE_LINEAR: exert_lane(h, w, bundle, lane, HOOKE_PAIRWISE | HOOKE_LINEAR); break;
    default: exert_lane(h, w, bundle, lane, HOOKE_PAIRWISE | HOOKE_FINITE | HOOKE_LINEAR);
    }
  }
  bundle->slices = 0;
}

static void exert_bundles(const Hybrid *h, const HookeWork *w)
{
  for (int n = 0; n < BUNDLES; ++n) exert_bundle(h, w, &w->aside->bundle[n]);
}

/** A bundle of slices with bonds in some lanes that has room for one more. */
static HookeBundle *bundle_of(const Hybrid *h, const HookeWork *w, unsigned lanes)
{
  HookeAside *aside = w->aside;
  HookeBundle *empty = NULL;
  for (int n = BUNDLES - 1; n >= 0; --n) {
    HookeBundle *bundle = &aside->bundle[n];
    if (bundle->slices && bundle->lanes == lanes) return bundle;
    if (!bundle->slices) empty = bundle;
  }
  if (!empty) {
    empty = &aside->bundle[aside->next];
    aside->next = (aside->next + 1) % BUNDLES;
    exert_bundle(h, w, empty);
  }
  empty->lanes = lanes;
  return empty;
}

/** Puts a slice's bonds aside that were marked. */
static void put_aside(const SliceOf *s, const HookeWork *w)
{
  HookeAside *aside = w->aside;
  const int vectors = s->h->lattice[aside->block].count;
  unsigned lanes = 0;
  for (int n = 0; n < vectors; ++n) lanes |= aside->lanes[n];
  HookeBundle *bundle = bundle_of(s->h, w, lanes);
  const int slice = bundle->slices++;
  for (int n = 0; n < vectors; ++n) {
    bundle->aside[n][slice] = aside->lanes[n];
    bundle->group[n][slice] = aside->group[n];
    bundle->base[n][slice] = s->base[n];
    aside->lanes[n] = 0;
  }
  if (bundle->slices == SLICE) exert_bundle(s->h, w, bundle);
}

/** Brings what stands around a slice into whole cache lines, those of a bundle, which is not at work meanwhile. */
LANES_INLINE void line_up(const SliceOf *s, int vectors, HookeWork *w, HookeBonds *bonds, int kind)
{
  HookeAside *aside = w->aside;
  for (int k = 0; k < 3; ++k) {
    for (int n = 0; n < vectors; ++n)
      for (int lane = 0; lane < SLICE; lane += LANES) {
        lanes_store(aside->u[k] + SLICE * n + lane, lanes_load(w->u[k] + s->base[n] + lane));
        if (kind & HOOKE_LINEAR) lanes_store(aside->at[k] + SLICE * n + lane, lanes_load(w->at[k] + s->base[n] + lane));
      }
    w->u[k] = aside->u[k];
    w->at[k] = aside->at[k];
  }
  bonds->base = aside->number;
}

/** @param[out] puts  some bonds are put aside. @return whether there is something in the sums of lattice vectors */
LANES_INLINE bool exert_groups(const SliceOf *s, const HookeWork *given, int kind, bool *puts)
{
  HookeWork work = *given;
  const HookeWork *w = &work;
  const Hybrid *h = s->h;
  HookeBonds bonds = {.base = s->base};
  const int block = h->particles->block[s->slice];
  const HybridLattice *lattice = &h->lattice[block];
  if (lattice->count >= MANY) line_up(s, lattice->count, &work, &bonds, kind);
  const bool bundles = lattice->count > FEW;
  bool some = false;
  for (int n = 0; n < s->groups; ++n) {
    const int64_t group = s->first + n;
    for (unsigned left = h->active[group]; left;) {
      if (bundles && __builtin_popcount(left) <= ALONE) { /* those of them with the same members are no more */
        bonds.lanes = left;
        left = 0;
      } else {
        next_bonds(h, group, &left, &bonds);
      }
      if (bundles && __builtin_popcount(bonds.lanes) <= ALONE) {
        const int64_t slot = h->family->first[s->slice] + h->bonds->owned[group];
        const int vector = hybrid_vector(h, block, s->slice, slot);
        w->aside->lanes[vector] |= (uint8_t)bonds.lanes;
        w->aside->group[vector] = h->group[group];
        if (h->group[group] < 0) __builtin_prefetch(h->mixed[-1 - h->group[group]]);
        *puts = true;
        continue;
      }
      some = true;
      for (int lane = 0; lane < SLICE; lane += LANES)
        if (bonds.lanes >> lane & ((1u << LANES) - 1)) exert(w, &bonds, lane, kind);
    }
  }
  return some;
}

static bool exert_slice(const SliceOf *s, const HookeWork *w, bool *puts)
{
  switch (w->kind) {
  case 0: return exert_groups(s, w, 0, puts);
  case HOOKE_FINITE: return exert_groups(s, w, HOOKE_FINITE, puts);
  case HOOKE_LINEAR: return exert_groups(s, w, HOOKE_LINEAR, puts);
  case HOOKE_FINITE | HOOKE_LINEAR: return exert_groups(s, w, HOOKE_FINITE | HOOKE_LINEAR, puts);
  case HOOKE_PAIRWISE: return exert_groups(s, w, HOOKE_PAIRWISE, puts);
  case HOOKE_PAIRWISE | HOOKE_FINITE: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_FINITE, puts);
  case HOOKE_PAIRWISE | HOOKE_LINEAR: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_LINEAR, puts);
  default: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_FINITE | HOOKE_LINEAR, puts);
  }
}

static void walk_stripe(const Hybrid *h, HookeWork *w)
{
  const HybridStripe *stripe = w->stripe;
  int cleared = 0; /* lattice vectors whose sums are zero */
  for (int64_t slice = stripe->first; slice < stripe->last; ++slice) {
    const int block = h->particles->block[slice];
    const HybridLattice *lattice = &h->lattice[block];
    const HybridHooke *hooke = &h->hooke[h->material[slice]];
    bool active = false;
    for (int64_t group = h->bonds->owned_first[slice]; group < h->bonds->owned_first[slice + 1] && !active; ++group)
      active = h->active[group];
    if (!active || !lattice->count) continue;
    if (cleared < lattice->count) {
      memset(w->sums - sums_margin(h) + 3 * cleared * w->room, 0,
             sizeof *w->sums * (size_t)(3 * (lattice->count - cleared) * w->room));
      cleared = lattice->count;
    }
    if (w->hooke != hooke || w->aside->block != block) exert_bundles(h, w);
    w->aside->block = block;
    w->hooke = hooke;
    w->lame = hooke->lame;
    w->shear = hooke->shear;
    SliceOf s;
    for (int n = 0; n < lattice->count; ++n) s.base[n] = (int32_t)(slice * SLICE); /* where there is no slot */
    find_slice(h, slice, &s);
    bool puts = false;
    const bool exerts = exert_slice(&s, w, &puts);
    if (puts) put_aside(&s, w);
    if (!exerts) continue;
    add_to_stripe(&s, stripe, w->sums, w->room);
    for (int n = 0; n < 3 * lattice->count; ++n)
      for (int lane = 0; lane < SLICE; lane += LANES) lanes_store(w->sums + n * w->room + lane, lanes_set(0));
  }
  exert_bundles(h, w);
}

/** The first batch of a stripe stands for all of them. */
void LANES_NAMED(hybrid_hooke)(const Hybrid *h, const Sweep *sweep)
{
  const HybridStripe *stripe = stripe_of(h, sweep->first);
  if (sweep->first != stripe->first) return;
  _Alignas(64) double sums[3 * HYBRID_NEAR * MOST_ROOM];
  HookeAside aside;
  aside.next = 0;
  aside.block = -1;
  memset(aside.lanes, 0, sizeof aside.lanes);
  memset(aside.here, 0, sizeof aside.here);
  for (int n = 0; n < BUNDLES; ++n) {
    aside.bundle[n].slices = 0;
    memset(aside.bundle[n].base, 0, sizeof aside.bundle[n].base); /* lanes without a slice read any place */
  }
  for (int n = 0; n < HYBRID_NEAR; ++n) aside.number[n] = SLICE * n;
  HookeWork w = {.stripe = stripe, .aside = &aside, .sums = sums + sums_margin(h), .room = 2 * sums_margin(h) + SLICE};
  w.kind =
      (h->finite ? HOOKE_FINITE : 0) | (h->pairwise ? HOOKE_PAIRWISE : 0) | (sweep->linearised_at ? HOOKE_LINEAR : 0);
  for (int k = 0; k < 3; ++k) {
    w.u[k] = sweep->displacement[k];
    if (sweep->linearised_at) w.at[k] = sweep->linearised_at[k];
  }
  clear_stripe(stripe);
  walk_stripe(h, &w);
}

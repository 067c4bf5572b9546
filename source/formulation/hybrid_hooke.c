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
  const int32_t *base;                /* places of lane 0's members by lattice vector; or NULL: */
  const int32_t (*place)[SLICE];      /* those of all members lane by lane */
  int count;                          /* of members */
  int other;                          /* lattice vector of the other end */
  bool mirrored;                      /* as in HybridGeometry */
  bool alike;                         /* one section counts for all lanes */
  unsigned lanes;                     /* bits */
  double scale[4];                    /* volume; of pairwise bonds section */
  _Alignas(64) double each[4][SLICE]; /* the same lane by lane */
} HookeBonds;

/** What kind of sweep it is: a constant where it is asked. */
enum {
  HOOKE_FINITE = 1,
  HOOKE_PAIRWISE = 2,
  HOOKE_LINEAR = 4 /* a linearised step */,
  HOOKE_GATHERED = 8 /* bonds of several slices */
};

/** What a sweep works with, the same for all its slices. */
typedef struct HookeWork {
  double *u[3], *at[3]; /* as in Sweep */
  int kind;
  const HybridStripe *stripe;
  struct HookeGathering *gathering;
  const uint8_t *planar; /* bonds that planes go through, or NULL */
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
LANES_INLINE Lanes of_member(const HookeBonds *bonds, const double *u, int n, int lane, bool gathered)
{
  return gathered ? lanes_gather(u, bonds->place[n] + lane) : lanes_load(u + bonds->base[bonds->near[n]] + lane);
}

/** G of the bonds of lanes `lane` and on. */
LANES_INLINE void find_gradient(const HookeBonds *bonds, double *const u[3], int lane, int kind, Lanes g[9])
{
  const bool gathered = kind & HOOKE_GATHERED;
  const double(*vector)[3] = bonds->vector;
  for (int k = 0; k < 9; ++k) g[k] = lanes_set(0);
  if (bonds->mirrored) {
    for (int n = 0; n + 1 < bonds->count; n += 2)
      for (int k = 0; k < 3; ++k) {
        const Lanes apart = of_member(bonds, u[k], n, lane, gathered) - of_member(bonds, u[k], n + 1, lane, gathered);
        for (int j = 0; j < 3; ++j) g[3 * k + j] += apart * lanes_set(vector[n][j]);
      }
    return;
  }
  for (int n = 0; n < bonds->count; ++n)
    for (int k = 0; k < 3; ++k) {
      const Lanes moved = of_member(bonds, u[k], n, lane, gathered);
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
  find_gradient(bonds, w->u, lane, kind, g);
  if (!(kind & HOOKE_FINITE) || !(kind & HOOKE_LINEAR)) {
    find_strain(g, kind, strain);
    find_stress(w, strain, stress);
    for (int k = 0; k < 9; ++k) p[k] = stress[symmetric_place[k]];
    if (kind & HOOKE_FINITE) add_turned(g, stress, p);
    return;
  }
  Lanes at[9], held[6];
  find_gradient(bonds, w->at, lane, kind, at);
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

/** Bonds of a slot that carry something and that planes leave. */
LANES_INLINE unsigned left_by_planes(const Hybrid *h, const HookeWork *w, int64_t group)
{
  return h->active[group] & ~(w->planar ? w->planar[group] : 0u);
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

/* ---- bonds that are alone in their slots: those of several slices that have the same members go through one turn ---- */

enum {
  GATHERED = 3,         /* bonds of a turn that wait for others, at most */
  GATHERED_SLICES = 16, /* from which they come */
  GATHERED_KINDS = 512,
  GATHERED_LISTS = 1024
};

/** Bonds with the same members that wait. */
typedef struct HookeList {
  int64_t first; /* of the members in the table */
  int count, next;
  int32_t geometry[SLICE];
  uint8_t slice[SLICE], lane[SLICE];
} HookeList;

typedef struct HookeGathering {
  int slices, kinds;
  int16_t list[GATHERED_LISTS]; /* by hash, one more than the number of the first one; 0: none */
  HookeList kind[GATHERED_KINDS];
  int32_t base[GATHERED_SLICES][HYBRID_NEAR];
} HookeGathering;

/** Adds what eight bonds at most exert on their members, lane by lane, to the sums of the stripe. */
LANES_INLINE void exert_gathered(const HookeWork *w, const HookeBonds *bonds, int lanes, int kind)
{
  _Alignas(64) double exerted[HYBRID_NEAR][3][SLICE];
  const int members = kind & HOOKE_PAIRWISE ? 2 : bonds->count;
  for (int lane = 0; lane < lanes; lane += LANES) {
    Lanes p[9];
    find_first_stress(w, bonds, lane, kind | HOOKE_GATHERED, p);
    if (kind & HOOKE_PAIRWISE) {
      for (int k = 0; k < 3; ++k) {
        Lanes force = lanes_set(0);
        for (int j = 0; j < 3; ++j) force += p[3 * k + j] * scale_of(bonds, j, lane);
        lanes_store(exerted[0][k] + lane, force);
        lanes_store(exerted[1][k] + lane, -force);
      }
      continue;
    }
    const Lanes volume = scale_of(bonds, 0, lane);
    for (int k = 0; k < 9; ++k) p[k] = p[k] * volume;
    for (int n = 0; n < members; ++n)
      for (int k = 0; k < 3; ++k) {
        Lanes force = lanes_set(0);
        for (int j = 0; j < 3; ++j) force += p[3 * k + j] * lanes_set(bonds->vector[n][j]);
        lanes_store(exerted[n][k] + lane, -force);
      }
  }
  const int64_t size = w->stripe->high - w->stripe->low;
  double *to = w->stripe->sums - w->stripe->low;
  for (int n = 0; n < members; ++n)
    for (int lane = 0; lane < lanes; ++lane)
      for (int k = 0; k < 3; ++k) to[k * size + bonds->place[n][lane]] += exerted[n][k][lane];
}

static void exert_list(const Hybrid *h, const HookeWork *w, HookeList *list)
{
  int32_t place[HYBRID_NEAR][SLICE];
  HookeBonds bonds = {.place = (const int32_t(*)[SLICE])place};
  take_geometry(h, &bonds, &h->table.geometry[list->geometry[0]]);
  for (int lane = 0; lane < SLICE; ++lane) {
    const int of = lane < list->count ? lane : 0; /* lanes that are left over do what the first one does */
    const HybridGeometry *geometry = &h->table.geometry[list->geometry[of]];
    const int32_t *base = w->gathering->base[list->slice[of]];
    for (int k = 0; k < 3 && h->pairwise; ++k) bonds.each[k][lane] = geometry->area[k];
    if (!h->pairwise) bonds.each[0][lane] = geometry->volume;
    for (int n = 0; n < bonds.count; ++n) place[n][lane] = base[bonds.near[n]] + list->lane[of];
  }
  const int lanes = list->count;
  list->count = 0;
  switch (w->kind) {
  case 0: exert_gathered(w, &bonds, lanes, 0); break;
  case HOOKE_FINITE: exert_gathered(w, &bonds, lanes, HOOKE_FINITE); break;
  case HOOKE_LINEAR: exert_gathered(w, &bonds, lanes, HOOKE_LINEAR); break;
  case HOOKE_FINITE | HOOKE_LINEAR: exert_gathered(w, &bonds, lanes, HOOKE_FINITE | HOOKE_LINEAR); break;
  case HOOKE_PAIRWISE: exert_gathered(w, &bonds, lanes, HOOKE_PAIRWISE); break;
  case HOOKE_PAIRWISE | HOOKE_FINITE: exert_gathered(w, &bonds, lanes, HOOKE_PAIRWISE | HOOKE_FINITE); break;
  case HOOKE_PAIRWISE | HOOKE_LINEAR: exert_gathered(w, &bonds, lanes, HOOKE_PAIRWISE | HOOKE_LINEAR); break;
  default: exert_gathered(w, &bonds, lanes, HOOKE_PAIRWISE | HOOKE_FINITE | HOOKE_LINEAR);
  }
}

/** Lets all that wait exert what they do. */
static void finish_gathering(const Hybrid *h, const HookeWork *w)
{
  HookeGathering *g = w->gathering;
  for (int n = 0; n < g->kinds; ++n)
    if (g->kind[n].count) exert_list(h, w, &g->kind[n]);
  if (g->kinds) memset(g->list, 0, sizeof g->list);
  g->kinds = g->slices = 0;
}

/** The list of bonds with the members of some, or NULL: there is no room for more. */
static HookeList *list_of(HookeGathering *g, int64_t first)
{
  int16_t *list = &g->list[(uint64_t)first * 0x9e3779b97f4a7c15u >> 54];
  for (int n = *list; n; n = g->kind[n - 1].next)
    if (g->kind[n - 1].first == first) return &g->kind[n - 1];
  if (g->kinds == GATHERED_KINDS) return NULL;
  g->kind[g->kinds] = (HookeList){.first = first, .next = *list};
  *list = (int16_t)(g->kinds + 1);
  return &g->kind[g->kinds++];
}

/** Puts bonds of a slot aside. @return false: there is no room for them */
static bool gather(const SliceOf *s, const HookeWork *w, int64_t group, const HookeBonds *bonds)
{
  const Hybrid *h = s->h;
  HookeGathering *g = w->gathering;
  HookeList *list = list_of(g, bonds->first);
  if (!list) return false;
  for (unsigned left = bonds->lanes; left; left &= left - 1) {
    const int lane = __builtin_ctz(left), n = list->count++;
    list->slice[n] = (uint8_t)g->slices;
    list->lane[n] = (uint8_t)lane;
    list->geometry[n] = h->group[group] < 0 ? h->mixed[-1 - h->group[group]][lane] : h->group[group];
    if (list->count == SLICE) exert_list(h, w, list);
  }
  return true;
}

/** @return whether there is something in the sums of lattice vectors */
LANES_INLINE bool exert_groups(const SliceOf *s, const HookeWork *w, int kind)
{
  const Hybrid *h = s->h;
  HookeBonds bonds = {.base = s->base};
  const bool gathers = w->planar && h->lattice[h->particles->block[s->slice]]
                                        .kind; /* elsewhere slices have whole turns besides, and nothing is gained */
  bool some = false;
  for (int n = 0; n < s->groups; ++n)
    for (unsigned left = left_by_planes(h, w, s->first + n); left;) {
      next_bonds(h, s->first + n, &left, &bonds);
      if (gathers && __builtin_popcount(bonds.lanes) <= GATHERED && gather(s, w, s->first + n, &bonds)) continue;
      some = true;
      for (int lane = 0; lane < SLICE; lane += LANES)
        if (bonds.lanes >> lane & ((1u << LANES) - 1)) exert(w, &bonds, lane, kind);
    }
  return some;
}

static bool exert_slice(const SliceOf *s, const HookeWork *w)
{
  switch (w->kind) {
  case 0: return exert_groups(s, w, 0);
  case HOOKE_FINITE: return exert_groups(s, w, HOOKE_FINITE);
  case HOOKE_LINEAR: return exert_groups(s, w, HOOKE_LINEAR);
  case HOOKE_FINITE | HOOKE_LINEAR: return exert_groups(s, w, HOOKE_FINITE | HOOKE_LINEAR);
  case HOOKE_PAIRWISE: return exert_groups(s, w, HOOKE_PAIRWISE);
  case HOOKE_PAIRWISE | HOOKE_FINITE: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_FINITE);
  case HOOKE_PAIRWISE | HOOKE_LINEAR: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_LINEAR);
  default: return exert_groups(s, w, HOOKE_PAIRWISE | HOOKE_FINITE | HOOKE_LINEAR);
  }
}

static void walk_stripe(const Hybrid *h, HookeWork *w)
{
  const HybridStripe *stripe = w->stripe;
  int cleared = 0; /* lattice vectors whose sums are zero */
  for (int64_t slice = stripe->first; slice < stripe->last; ++slice) {
    const HybridLattice *lattice = &h->lattice[h->particles->block[slice]];
    const HybridHooke *hooke = &h->hooke[h->material[slice]];
    unsigned left = 0;
    const int planes = w->planar ? h->planar_kind[slice] : HYBRID_ODD;
    if (planes != HYBRID_ODD && !h->planes[planes].leaves) continue;
    for (int64_t group = h->bonds->owned_first[slice]; group < h->bonds->owned_first[slice + 1]; ++group)
      left |= left_by_planes(h, w, group);
    if (!left || !lattice->count) continue;
    if (cleared < lattice->count) {
      memset(w->sums - sums_margin(h) + 3 * cleared * w->room, 0,
             sizeof *w->sums * (size_t)(3 * (lattice->count - cleared) * w->room));
      cleared = lattice->count;
    }
    if (w->gathering->slices == GATHERED_SLICES || w->hooke != hooke) finish_gathering(h, w);
    w->hooke = hooke;
    w->lame = hooke->lame;
    w->shear = hooke->shear;
    SliceOf s;
    find_slice(h, slice, &s);
    memcpy(w->gathering->base[w->gathering->slices], s.base, sizeof *s.base * (size_t)lattice->count);
    const bool some = exert_slice(&s, w);
    ++w->gathering->slices;
    if (!some) continue;
    add_to_stripe(&s, stripe, w->sums, w->room);
    for (int n = 0; n < 3 * lattice->count; ++n)
      for (int lane = 0; lane < SLICE; lane += LANES) lanes_store(w->sums + n * w->room + lane, lanes_set(0));
  }
  if (w->hooke) finish_gathering(h, w);
}

/** The first batch of a stripe stands for all of them. */
void LANES_NAMED(hybrid_hooke)(const Hybrid *h, const Sweep *sweep)
{
  const HybridStripe *stripe = stripe_of(h, sweep->first);
  if (sweep->first != stripe->first) return;
  _Alignas(64) double sums[3 * HYBRID_NEAR * MOST_ROOM];
  HookeGathering gathering;
  gathering.slices = gathering.kinds = 0;
  memset(gathering.list, 0, sizeof gathering.list);
  HookeWork w = {
      .stripe = stripe, .gathering = &gathering, .sums = sums + sums_margin(h), .room = 2 * sums_margin(h) + SLICE};
  w.kind = (h->finite ? HOOKE_FINITE : 0) | (h->pairwise ? HOOKE_PAIRWISE : 0) | (sweep->at ? HOOKE_LINEAR : 0);
  for (int k = 0; k < 3; ++k) {
    w.u[k] = h->particles->displacement[k];
    if (sweep->at) w.at[k] = sweep->at[k];
  }
  clear_stripe(stripe);
  if (w.kind != (w.kind | HOOKE_FINITE | HOOKE_LINEAR)) w.planar = h->planar;
  if (w.planar) LANES_NAMED(hybrid_planes)(h, stripe);
  walk_stripe(h, &w);
}

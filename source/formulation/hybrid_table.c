/* The geometry of hybrid bonds along lattices: which members they have, in a table of distinct ones, and where what they exert is summed. */
#include "formulation/hybrid.h"

#include "base/memory.h"
#include "base/tensor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NO_BOND = -1, FIRST_ROOM = 64 };

/** Members of a bond that is looked at. */
typedef struct Members {
  int block, other; /* lattice vector of the other end */
  int count;        /* 0: it carries nothing */
  bool mirrored;
  uint16_t key[HYBRID_NEAR], near[HYBRID_NEAR];
  double g[HYBRID_NEAR][3];
} Members;

/* ---- lattice vectors ---- */

static const Pattern *pattern_of(const Hybrid *h, int block, int vector)
{
  return &h->family->patterns[h->family->pattern_begin[block] + vector - 1];
}

static int difference(const HybridLattice *lattice, int a, int b)
{
  return lattice->difference[a * lattice->count + b];
}

/** Vectors by their offsets, in a box around 0. */
typedef struct VectorBox {
  int extent[3];
  int16_t *vector;
} VectorBox;

static int16_t *in_box(const VectorBox *box, const int offset[3])
{
  int64_t at = 0;
  for (int k = 0; k < 3; ++k) {
    if (abs(offset[k]) > box->extent[k]) return NULL;
    at = at * (2 * box->extent[k] + 1) + offset[k] + box->extent[k];
  }
  return &box->vector[at];
}

static void offset_of(const Hybrid *h, int block, int vector, int offset[3])
{
  for (int k = 0; k < 3; ++k) offset[k] = vector ? pattern_of(h, block, vector)->offset[k] : 0;
}

static void fill_differences(const Hybrid *h, int block, const VectorBox *box)
{
  HybridLattice *lattice = &h->lattice[block];
  int a[3], b[3];
  for (int n = 0; n < lattice->count; ++n) {
    offset_of(h, block, n, a);
    *in_box(box, a) = (int16_t)(n + 1);
  }
  for (int n = 0; n < lattice->count; ++n)
    for (int m = 0; m < lattice->count; ++m) {
      offset_of(h, block, n, a);
      offset_of(h, block, m, b);
      for (int k = 0; k < 3; ++k) b[k] -= a[k];
      const int16_t *found = in_box(box, b);
      lattice->difference[n * lattice->count + m] = (int16_t)(found ? *found - 1 : -1);
    }
}

/** Which lattice row each vector leads to, counted through. */
static void number_rows(const Hybrid *h, int block)
{
  HybridLattice *lattice = &h->lattice[block];
  const int axis = h->family->lattices[block].axis;
  int own = -1, offset[3];
  for (int n = 1; n < lattice->count; ++n) {
    const Pattern *pattern = pattern_of(h, block, n);
    if (n == 1 || pattern->row != pattern_of(h, block, n - 1)->row) ++lattice->windows;
    lattice->window[n] = (uint8_t)(lattice->windows - 1);
    offset_of(h, block, n, offset);
    offset[axis] = 0;
    if (!offset[0] && !offset[1] && !offset[2]) own = lattice->window[n];
  }
  lattice->window[0] = (uint8_t)(own < 0 ? lattice->windows++ : own);
}

/** Vectors that lead to one lattice row, at most. */
static int most_in_row(const Hybrid *h, int block, int count)
{
  int most = 0;
  for (int n = 1, first = 1; n < count; ++n) {
    if (pattern_of(h, block, n)->row != pattern_of(h, block, first)->row) first = n;
    if (n - first + 2 > most) most = n - first + 2; /* the place itself may be among them */
  }
  return most;
}

static int create_lattice(const Hybrid *h, int block, Error *error)
{
  HybridLattice *lattice = &h->lattice[block];
  const int count = h->family->pattern_begin[block + 1] - h->family->pattern_begin[block] + 1;
  if (count < 2 || count > HYBRID_NEAR || most_in_row(h, block, count) > HYBRID_WIDTH - SLICE + 1) return BRECCIA_OK;
  *lattice = (HybridLattice){
      .count = count,
      .difference = memory_zeroed((size_t)count * (size_t)count, sizeof *lattice->difference, "lattices", error),
      .window = memory_zeroed((size_t)count, 1, "lattices", error)};
  VectorBox box = {0};
  int64_t size = 1;
  for (int n = 1; n < count; ++n)
    for (int k = 0; k < 3; ++k) {
      const int extent = abs(pattern_of(h, block, n)->offset[k]);
      if (extent > box.extent[k]) box.extent[k] = extent;
    }
  for (int k = 0; k < 3; ++k) size *= 2 * box.extent[k] + 1;
  box.vector = memory_zeroed((size_t)size, sizeof *box.vector, "lattices", error);
  const bool whole = lattice->difference && lattice->window && box.vector;
  if (whole) {
    fill_differences(h, block, &box);
    number_rows(h, block);
  }
  free(box.vector);
  return whole ? BRECCIA_OK : BRECCIA_FAILURE;
}

int hybrid_lattices_create(Hybrid *h, Error *error)
{
  const size_t groups = (size_t)h->bonds->owned_first[h->particles->slices], blocks = (size_t)h->body->block_count;
  h->lattice = memory_zeroed(blocks, sizeof *h->lattice, "lattices", error);
  h->group = memory_zeroed(groups, sizeof *h->group, "geometries of bonds", error);
  h->active = memory_zeroed(groups, 1, "geometries of bonds", error);
  if (!h->lattice || !h->group || !h->active) return BRECCIA_FAILURE;
  for (int block = 0; block < (int)blocks; ++block)
    if (create_lattice(h, block, error)) return BRECCIA_FAILURE;
  return BRECCIA_OK;
}

void hybrid_lattices_destroy(Hybrid *h)
{
  for (int block = 0; h->lattice && block < h->body->block_count; ++block) {
    free(h->lattice[block].difference);
    free(h->lattice[block].window);
  }
  free(h->lattice);
  free(h->group);
  free(h->active);
  free(h->mixed);
  free(h->table.geometry);
  free(h->table.near);
  free(h->table.key);
  free(h->table.g);
  free(h->table.bucket);
  free(h->stripe);
  free(h->reaching);
  places_free(&h->sums);
}

size_t hybrid_lattices_bytes(const Hybrid *h)
{
  const size_t slices = (size_t)h->particles->slices, groups = (size_t)h->bonds->owned_first[slices];
  const HybridTable *t = &h->table;
  return groups * (sizeof *h->group + 1) + (size_t)h->mixed_count * sizeof *h->mixed +
         (size_t)t->count * sizeof *t->geometry + (size_t)t->buckets * sizeof *t->bucket +
         (size_t)t->members * (sizeof *t->near + sizeof *t->key + sizeof *t->g) + hybrid_stripes_bytes(h);
}

/* ---- the table ---- */

static uint64_t mixed_in(uint64_t hash, uint64_t value)
{
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 29;
}

/** Of members alone: geometries with the same ones and other sections share these. */
static uint64_t hash_of(int block, int other, int count, const uint16_t *key)
{
  uint64_t hash = mixed_in(mixed_in((uint64_t)block, (uint64_t)other), (uint64_t)count);
  for (int n = 0; n < count; ++n) hash = mixed_in(hash, key[n]);
  return hash;
}

static uint64_t hash_at(const HybridTable *t, int32_t n)
{
  const HybridGeometry *geometry = &t->geometry[n];
  return hash_of(geometry->block, geometry->other, geometry->count, t->key + geometry->first);
}

static void put_in_bucket(HybridTable *t, int32_t n)
{
  uint64_t at = hash_at(t, n) & (uint64_t)(t->buckets - 1);
  while (t->bucket[at] >= 0) at = (at + 1) & (uint64_t)(t->buckets - 1);
  t->bucket[at] = n;
}

/** @return false: there is no memory */
static bool grow(void *array, size_t count, size_t size)
{
  void **at = array, *grown = memory_grown(*at, count, size);
  if (grown) *at = grown;
  return grown != NULL;
}

static void fill_buckets(HybridTable *t)
{
  for (int32_t n = 0; n < t->buckets; ++n) t->bucket[n] = -1;
  for (int32_t n = 0; n < t->count; ++n) put_in_bucket(t, n);
}

static bool make_buckets(HybridTable *t, int32_t buckets)
{
  if (!grow(&t->bucket, (size_t)buckets, sizeof *t->bucket)) return false;
  t->buckets = buckets;
  fill_buckets(t);
  return true;
}

static bool make_room(HybridTable *t, int members)
{
  if (t->count == t->room) {
    const int32_t room = 2 * t->room + FIRST_ROOM;
    if (!grow(&t->geometry, (size_t)room, sizeof *t->geometry)) return false;
    t->room = room;
  }
  if (t->members + members > t->member_room) {
    const int64_t room = 2 * t->member_room + HYBRID_NEAR + members;
    if (!grow(&t->near, (size_t)room, sizeof *t->near) || !grow(&t->key, (size_t)room, sizeof *t->key) ||
        !grow(&t->g, (size_t)room, sizeof *t->g))
      return false;
    t->member_room = room;
  }
  return 2 * (t->count + 1) <= t->buckets || make_buckets(t, t->buckets ? 2 * t->buckets : 4 * FIRST_ROOM);
}

/** Vectors g of members, opposite ones side by side where each has one. @return evenness of the members (hybrid_invert) */
static double weigh(const Hybrid *h, Members *m)
{
  const HybridLattice *lattice = &h->lattice[m->block];
  uint16_t opposite[HYBRID_NEAR] = {0};
  bool there[HYBRID_NEAR] = {false};
  double middle[3] = {0}, moment[6] = {0};
  int count = 2, centre = -1;
  for (int n = 0; n < m->count; ++n) there[m->key[n]] = true;
  m->mirrored = true;
  for (int n = 0; n < m->count; ++n) {
    const int other = difference(lattice, m->key[n], m->other);
    m->mirrored &= other >= 0 && there[other];
    if (other >= 0) opposite[m->key[n]] = (uint16_t)other;
  }
  m->near[0] = 0;
  m->near[1] = (uint16_t)m->other;
  for (int n = 0; n < m->count; ++n) {
    const int vector = m->key[n];
    if (!vector || vector == m->other) continue;
    if (m->mirrored && opposite[vector] == vector) centre = vector;
    if (m->mirrored && opposite[vector] <= vector) continue;
    m->near[count++] = (uint16_t)vector;
    if (m->mirrored) m->near[count++] = opposite[vector];
  }
  if (centre >= 0) m->near[count++] = (uint16_t)centre;
  for (int n = 0; n < count; ++n)
    for (int k = 0; k < 3; ++k) {
      m->g[n][k] = m->near[n] ? pattern_of(h, m->block, m->near[n])->xi[k] : 0;
      middle[k] += m->g[n][k] / count;
    }
  const double *xi = pattern_of(h, m->block, m->other)->xi;
  for (int k = 0; k < 3 && m->mirrored; ++k) middle[k] = xi[k] / 2;
  for (int n = 0; n < count; ++n) {
    for (int k = 0; k < 3; ++k) m->g[n][k] -= middle[k];
    for (int k = 0; k < 6; ++k) moment[k] += m->g[n][symmetric_row[k]] * m->g[n][symmetric_column[k]];
  }
  const double evenness = hybrid_fit(h, count, moment, xi, m->g);
  if (!(evenness > FORMULATION_LEAST_EVENNESS)) return evenness;
  for (int n = 0; n + 1 < count && m->mirrored; n += 2)
    for (int k = 0; k < 3; ++k) m->g[n + 1][k] = -m->g[n][k];
  return evenness;
}

/** The geometry with these members and this section. @return its number, or -1: there is no memory */
static int32_t look_up(Hybrid *h, Members *m, const double area[3], double volume)
{
  HybridTable *t = &h->table;
  int32_t alike = -1;                    /* a geometry with the same members */
  for (int turn = 0; turn < 2; ++turn) { /* the second one for members that turn out to span no space */
    uint64_t at = hash_of(m->block, m->other, m->count, m->key);
    for (; t->buckets && t->bucket[at & (uint64_t)(t->buckets - 1)] >= 0; ++at) {
      const int32_t n = t->bucket[at & (uint64_t)(t->buckets - 1)];
      const HybridGeometry *found = &t->geometry[n];
      if (found->block != m->block || found->other != m->other || found->count != m->count ||
          memcmp(t->key + found->first, m->key, sizeof *m->key * (size_t)m->count) != 0)
        continue;
      if (!memcmp(found->area, area, sizeof found->area)) return n;
      alike = n;
    }
    if (!m->count || alike >= 0 || weigh(h, m) > FORMULATION_LEAST_EVENNESS) break;
    m->count = 0;
  }
  if (!make_room(t, m->count)) return -1;
  HybridGeometry *made = &t->geometry[t->count];
  if (alike >= 0) {
    *made = t->geometry[alike];
    memcpy(made->area, area, sizeof made->area);
    made->volume = volume;
    put_in_bucket(t, t->count);
    return t->count++;
  }
  *made = (HybridGeometry){.area = {area[0], area[1], area[2]},
                           .volume = volume,
                           .first = t->members,
                           .count = (int16_t)m->count,
                           .other = (int16_t)m->other,
                           .block = m->block,
                           .mirrored = m->count && m->mirrored};
  if (m->count) {
    memcpy(t->near + t->members, m->near, sizeof *t->near * (size_t)m->count);
    memcpy(t->key + t->members, m->key, sizeof *t->key * (size_t)m->count);
    memcpy(t->g + t->members, m->g, sizeof *t->g * (size_t)m->count);
  }
  t->members += m->count;
  put_in_bucket(t, t->count);
  return t->count++;
}

static int32_t *lane_geometry(const Hybrid *h, int64_t group, int lane)
{
  return h->group[group] < 0 ? &h->mixed[-1 - h->group[group]][lane] : &h->group[group];
}

/** Throws away what no bond has any more, once there is twice as much as bonds have had. */
static void tidy(Hybrid *h)
{
  HybridTable *t = &h->table;
  const int64_t groups = h->bonds->owned_first[h->particles->slices];
  if (t->count < 2 * t->kept + 16 * FIRST_ROOM) return;
  int32_t *now = memory_plain((size_t)t->count, sizeof *now), count = 0;
  int64_t *begins = memory_plain((size_t)t->members, sizeof *begins),
          members = 0; /* how many members begin there, then where they are now */
  if (!now || !begins) {
    free(now);
    free(begins);
    return;
  }
  for (int64_t group = 0; group < groups; ++group)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int32_t geometry = *lane_geometry(h, group, lane);
      if (geometry < 0) continue;
      now[geometry] = 1;
      if (t->geometry[geometry].count) begins[t->geometry[geometry].first] = t->geometry[geometry].count;
    }
  for (int64_t from = 0, size = 1; from < t->members; from += size ? size : 1) {
    size = begins[from];
    if (!size) continue;
    memmove(t->near + members, t->near + from, sizeof *t->near * (size_t)size);
    memmove(t->key + members, t->key + from, sizeof *t->key * (size_t)size);
    memmove(t->g + members, t->g + from, sizeof *t->g * (size_t)size);
    begins[from] = members;
    members += size;
  }
  t->members = members;
  for (int32_t n = 0; n < t->count; ++n) {
    if (!now[n]) continue;
    t->geometry[count] = t->geometry[n];
    if (t->geometry[n].count) t->geometry[count].first = begins[t->geometry[n].first];
    now[n] = count++;
  }
  for (int64_t group = 0; group < groups; ++group)
    if (h->group[group] >= 0) h->group[group] = now[h->group[group]];
  for (int32_t n = 0; n < h->mixed_count; ++n)
    for (int lane = 0; lane < SLICE; ++lane)
      if (h->mixed[n][lane] >= 0) h->mixed[n][lane] = now[h->mixed[n][lane]];
  free(now);
  free(begins);
  t->count = t->kept = count;
  fill_buckets(t);
}

/* ---- which members bonds have ---- */

/** Intact bonds of a slice's lanes by a vector; none if there is no such slice. */
static unsigned intact_of(const Hybrid *h, int block, int64_t slice, int vector)
{
  const Family *f = h->family;
  if (slice < 0 || slice >= h->particles->slices || h->particles->block[slice] != block) return 0;
  int64_t low = f->first[slice], high = f->stored[slice];
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (hybrid_vector(h, block, slice, middle) < vector)
      low = middle + 1;
    else
      high = middle;
  }
  return low < f->stored[slice] && hybrid_vector(h, block, slice, low) == vector ? f->intact[low] : 0;
}

static bool is_hidden(const Hybrid *h, int64_t a, int64_t b)
{
  return (a == h->hidden[0] && b == h->hidden[1]) || (a == h->hidden[1] && b == h->hidden[0]);
}

/** Places that the eight bonds of an owned slot have as members, by bits of its lanes.
 *  @param[out] key, lanes  [HYBRID_NEAR] vectors in ascending order, and which lanes have them
 *  @return how many */
static int find_members(const Hybrid *h, int64_t slice, int64_t slot, uint16_t *key, uint8_t *lanes)
{
  const Family *f = h->family;
  const int block = h->particles->block[slice], other = hybrid_vector(h, block, slice, slot);
  const int64_t base = family_base(f, slice, slot), next = base / SLICE;
  const int shift = (int)(base % SLICE);
  int count = 1;
  key[0] = 0;
  lanes[0] = f->intact[slot];
  for (int64_t to = f->first[slice]; to < f->stored[slice]; ++to) {
    const int vector = hybrid_vector(h, block, slice, to), from_other = difference(&h->lattice[block], other, vector);
    if (from_other < 0) continue;
    unsigned seen = f->intact[slot] & f->intact[to];
    if (to != slot)
      seen &= intact_of(h, block, next, from_other) >> shift |
              (shift ? intact_of(h, block, next + 1, from_other) << (SLICE - shift) : 0);
    for (int lane = 0; h->hidden[0] >= 0 && lane < SLICE; ++lane) {
      const int64_t a = slice * SLICE + lane, b = base + lane, c = family_base(f, slice, to) + lane;
      if (is_hidden(h, a, c) || is_hidden(h, b, c)) seen &= ~(1u << lane);
      if (is_hidden(h, a, b)) lanes[0] = (uint8_t)(lanes[0] & ~(1u << lane));
    }
    if (!(seen & 255u)) continue;
    key[count] = (uint16_t)vector;
    lanes[count++] = (uint8_t)seen;
  }
  return count;
}

static void take_lane(Members *m, int count, const uint16_t *key, const uint8_t *lanes, int lane)
{
  m->count = 0;
  for (int n = 0; n < count && lanes[0] >> lane & 1; ++n)
    if (lanes[n] >> lane & 1) m->key[m->count++] = key[n];
}

double hybrid_group_weigh(const Hybrid *h, const HybridRow *at, HybridView *view)
{
  Members m = {.block = h->particles->block[at->slice]};
  uint16_t key[HYBRID_NEAR];
  uint8_t lanes[HYBRID_NEAR];
  m.other = hybrid_vector(h, m.block, at->slice, at->slot);
  take_lane(&m, find_members(h, at->slice, at->slot, key, lanes), key, lanes, at->lane);
  view->count = m.count;
  view->member = view->near;
  view->g = (const double(*)[3])view->tried;
  const double evenness = m.count ? weigh(h, &m) : 0;
  if (!(evenness > FORMULATION_LEAST_EVENNESS)) return evenness;
  for (int n = 0; n < m.count; ++n) {
    const int64_t slot = h->family->first[at->slice];
    int64_t to = slot;
    while (m.near[n] && hybrid_vector(h, m.block, at->slice, to) != m.near[n]) ++to;
    view->near[n] = (int32_t)((m.near[n] ? family_base(h->family, at->slice, to) : at->slice * SLICE) + at->lane);
    memcpy(view->tried[n], m.g[n], sizeof m.g[n]);
  }
  return evenness;
}

/** Gives the eight bonds of an owned slot their geometries. @return false: there is no memory, and they stay as they were */
static bool set_group(Hybrid *h, int64_t group, const int32_t geometry[SLICE])
{
  int32_t whole = -1;
  bool alike = true;
  uint8_t active = 0;
  for (int lane = 0; lane < SLICE; ++lane) {
    if (geometry[lane] == NO_BOND) continue;
    if (whole < 0) whole = geometry[lane];
    alike &= geometry[lane] >= 0 && geometry[lane] == whole;
    if (geometry[lane] >= 0 && h->table.geometry[geometry[lane]].count) active |= (uint8_t)(1u << lane);
  }
  /* Lanes without a bond must not be taken for such with one, once bonds are mended: they have a geometry of their own elsewhere. */
  for (int lane = 0; lane < SLICE; ++lane) alike &= geometry[lane] != NO_BOND;
  if (!alike && h->group[group] >= 0) {
    if (h->mixed_count == h->mixed_room) {
      const int32_t room = 2 * h->mixed_room + FIRST_ROOM;
      if (!grow(&h->mixed, (size_t)room, sizeof *h->mixed)) return false;
      h->mixed_room = room;
    }
    h->group[group] = -1 - h->mixed_count++;
  }
  if (h->group[group] < 0)
    memcpy(h->mixed[-1 - h->group[group]], geometry, sizeof *h->mixed);
  else
    h->group[group] = whole;
  h->active[group] = active;
  return true;
}

int hybrid_group_list(Hybrid *h, int64_t group, int lane, int64_t number)
{
  int32_t geometry[SLICE];
  for (int k = 0; k < SLICE; ++k) geometry[k] = h->group[group] < 0 ? *lane_geometry(h, group, k) : NO_BOND;
  geometry[lane] = (int32_t)(NO_BOND - 1 - number);
  return set_group(h, group, geometry) ? BRECCIA_OK : BRECCIA_FAILURE;
}

int hybrid_group_create(Hybrid *h, const HybridShape *shape, int64_t slice, int64_t slot, int64_t group)
{
  Members m = {.block = h->particles->block[slice]};
  uint16_t key[HYBRID_NEAR];
  uint8_t lanes[HYBRID_NEAR];
  m.other = hybrid_vector(h, m.block, slice, slot);
  int32_t geometry[SLICE];
  const int count = h->lattice[m.block].count ? find_members(h, slice, slot, key, lanes) : 0;
  for (int lane = 0; lane < SLICE; ++lane) {
    geometry[lane] = *lane_geometry(h, group, lane); /* listed ones are known */
    if (geometry[lane] < NO_BOND) continue;
    geometry[lane] = NO_BOND;
    if (!(h->family->intact[slot] >> lane & 1)) continue;
    double area[3], volume;
    hybrid_section_of(h, shape, &(HybridRow){.slice = slice, .slot = slot, .lane = lane}, area, &volume);
    take_lane(&m, count, key, lanes, lane);
    if (volume == 0) m.count = 0; /* influence may end at the horizon */
    geometry[lane] = look_up(h, &m, area, volume);
    if (geometry[lane] < 0) return -2;
    if (volume == 0 || h->table.geometry[geometry[lane]].count) continue;
    if (!hybrid_is_beyond(h, slice * SLICE + lane, family_base(h->family, slice, slot) + lane)) return lane;
    m.count = 0;
    geometry[lane] = look_up(h, &m, (double[3]){0}, 0);
    if (geometry[lane] < 0) return -2;
  }
  h->table.kept = h->table.count;
  return set_group(h, group, geometry) ? -1 : -2;
}

/** Without memory for it a bond keeps its members: the public function in which that happens fails. */
static void renew_group(Hybrid *h, int64_t slice, int64_t slot, int64_t group)
{
  Members m = {.block = h->particles->block[slice]};
  uint16_t key[HYBRID_NEAR];
  uint8_t lanes[HYBRID_NEAR];
  if (!h->lattice[m.block].count) return;
  m.other = hybrid_vector(h, m.block, slice, slot);
  int32_t geometry[SLICE];
  const int count = find_members(h, slice, slot, key, lanes);
  for (int lane = 0; lane < SLICE; ++lane) {
    geometry[lane] = *lane_geometry(h, group, lane);
    if (geometry[lane] < 0) continue;
    const HybridGeometry was = h->table.geometry[geometry[lane]];
    take_lane(&m, count, key, lanes, lane);
    if (was.volume == 0) m.count = 0;
    const int32_t now = look_up(h, &m, was.area, was.volume);
    if (now >= 0) geometry[lane] = now;
  }
  set_group(h, group, geometry);
}

void hybrid_groups_renew(Hybrid *h, int64_t slice)
{
  const Family *f = h->family;
  const BondList *l = h->bonds;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
    const bool own = bond_list_owns(f, slice, slot);
    int64_t last = -1;
    for (int lane = 0; lane < SLICE; ++lane) {
      const int64_t owner = own ? slice : (family_base(f, slice, slot) + lane) / SLICE;
      int64_t rows[2];
      if (owner < 0 || owner == last || family_base(f, slice, slot) + lane < 0) continue;
      last = owner;
      bond_list_rows(l, f, slice, slot, lane, rows);
      /* Where the owners have no such slot, the row is that of another slice. */
      const int64_t group = l->owned_first[owner] + (rows[0] - l->first[owner]) / SLICE;
      if (rows[0] < l->first[owner] || group >= l->owned_first[owner + 1]) continue;
      renew_group(h, owner, f->first[owner] + l->owned[group], group);
    }
  }
  tidy(h);
}

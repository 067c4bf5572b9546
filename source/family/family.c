#include "family/family.h"

#include "base/memory.h"
#include "base/team.h"
#include "family/search.h"
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

const char *volume_correction_word(int k)
{
  static const char *const words[] = {
      [VOLUME_WHOLE] = "none", [VOLUME_PARTIAL] = "partial", [VOLUME_PARTIAL_BEYOND] = "partial-beyond", NULL};
  return words[k];
}

/** Share of a neighbour's volume that counts (docs/theory.md 1, options 1 and 2); r is half a spacing. */
static double volume_share(VolumeCorrection correction, double length, double horizon, double r)
{
  if (correction == VOLUME_WHOLE || length <= horizon - r) return 1;
  return fmax(0, fmin(1, (horizon + r - length) / (2 * r)));
}

/** Fills a pattern. @return false if the lattice vector is beyond reach */
static bool make_pattern(Pattern *pattern, const Family *family, const Lattice *lattice, const FamilySpec *spec,
                         double reach, const int offset[3])
{
  double way[3];
  lattice_vector(lattice, offset, way);
  const double length = lattice->spacing * sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  if (length == 0 || length > reach * (1 + 1e-9)) return false;
  const double share = volume_share(spec->correction, length, family->horizon, lattice->spacing / 2);
  if (share == 0) return false;
  *pattern = (Pattern){.length = length, .kind = -1};
  pattern->weight = spec->influence->value(fmin(1, length / family->horizon), length) * share * lattice->volume;
  for (int k = 0; k < 3; ++k) {
    pattern->xi[k] = lattice->spacing * way[k];
    pattern->weighted_xi[k] = pattern->weight * pattern->xi[k];
    pattern->offset[k] = offset[k];
  }
  pattern->weight_by_length = pattern->weight / length;
  pattern->by_square = 1 / (length * length);
  pattern->twice = (int)lround(2 * pattern->xi[lattice->axis] / lattice->unit.size[lattice->axis]);
  return true;
}

static int refuse_reach(const Family *family, const Lattice *lattice, Error *error)
{
  return error_add(error, BRECCIA_USER_ERROR,
                   "the horizon of %g reaches over %.3g spacings of %g: families would have more than %d bonds; take a "
                   "smaller horizon, or blocks of like spacings",
                   family->horizon, family->horizon / lattice->spacing, lattice->spacing, UINT16_MAX);
}

/** How many rows, layers and places along a row may be within reach to each side. Rows are shifted by less than one place for each row and layer.
 *  @return false if they are so many that a family has too many bonds for certain: to count them would take too long */
static bool find_extent(const Lattice *lattice, const int axes[3], double reach, int extent[3])
{
  static const double most = 64.0 * UINT16_MAX; /* shifted rows are looked for in up to 16 times the ball's places */
  double further = 0, all = 1;
  for (int n = 2; n >= 0; --n) {
    const double along =
        axes[n] < lattice->dimensions ? floor(reach / lattice->unit.size[axes[n]] * (1 + 1e-9)) + further : 0;
    further += along;
    all *= 2 * along + 1;
    if (!(all <= most)) return false;
    extent[n] = (int)along;
  }
  return true;
}

/** Lattice vectors of one block within reach, lattice row by lattice row. */
static int add_patterns(Family *family, const Lattice *lattice, const FamilySpec *spec, double reach, Error *error)
{
  const int axes[3] = {lattice->axis, lattice->across[0], lattice->across[1]};
  int extent[3], room = family->pattern_count, offset[3];
  if (!find_extent(lattice, axes, reach, extent)) return refuse_reach(family, lattice, error);
  for (offset[axes[2]] = -extent[2]; offset[axes[2]] <= extent[2]; ++offset[axes[2]])
    for (offset[axes[1]] = -extent[1]; offset[axes[1]] <= extent[1]; ++offset[axes[1]]) {
      const int row_begins = family->pattern_count;
      for (offset[axes[0]] = -extent[0]; offset[axes[0]] <= extent[0]; ++offset[axes[0]]) {
        Pattern pattern;
        if (!make_pattern(&pattern, family, lattice, spec, reach, offset)) continue;
        pattern.row = row_begins;
        if (family->pattern_count == room) {
          Pattern *grown = memory_grown(family->patterns, (size_t)(room = 2 * room + 64), sizeof(Pattern));
          if (!grown) return error_add(error, BRECCIA_FAILURE, "out of memory: bond patterns");
          family->patterns = grown;
        }
        family->patterns[family->pattern_count++] = pattern;
      }
      if (family->pattern_count > UINT16_MAX) return refuse_reach(family, lattice, error);
    }
  return BRECCIA_OK;
}

/** The row of a lattice in which neighbours of a slice stand. */
typedef struct NeighbourRow {
  int pattern;           /* the first that leads there; -1: none yet */
  const int32_t *slices; /* [chunks], or NULL where the lattice has no such row */
  int64_t begin;         /* cell in it from which offsets along the row count */
} NeighbourRow;

/** @param[in] cell  of the first place of the slice */
static NeighbourRow neighbour_row(const Lattice *lattice, const int64_t cell[3], const Pattern *pattern)
{
  NeighbourRow row = {.pattern = pattern->row};
  int offset[3] = {pattern->offset[0], pattern->offset[1], pattern->offset[2]};
  int64_t there[3];
  offset[lattice->axis] = 0;
  if (!lattice_neighbour(lattice, cell, offset, there)) return row;
  row.slices = lattice->slice + lattice_row(lattice, there) * lattice->chunks;
  row.begin = there[lattice->axis];
  return row;
}

/** One lattice slot: base place and mask of existing neighbours.
 *  @param[in] start  cell of the first one in its row
 *  @return the mask */
static uint8_t lattice_slot(const Particles *p, const Lattice *lattice, int64_t slice, const int32_t *slices,
                            int64_t start, int32_t *base)
{
  const int64_t near = start >= 0 ? start / SLICE : (start - SLICE + 1) / SLICE, shift = start - near * SLICE;
  const int32_t a = near >= 0 && near < lattice->chunks ? slices[near] : -1;
  const int32_t b = shift && near + 1 >= 0 && near + 1 < lattice->chunks ? slices[near + 1] : -1;
  if (a < 0 && b < 0) return 0;
  *base = (int32_t)(a >= 0 ? a * SLICE + shift : b * SLICE + shift - SLICE);
  const int64_t here = slice * SLICE;
  uint8_t mask = 0;
  for (int lane = 0; lane < SLICE; ++lane) {
    const bool in_first = shift + lane < SLICE;
    if (p->number[here + lane] < 0 || (in_first ? a : b) < 0 || p->number[*base + lane] < 0) continue;
    mask |= (uint8_t)(1u << lane);
  }
  return mask;
}

static uint8_t cut_slot(const Body *body, int64_t slice, int32_t base, uint8_t mask)
{
  for (int lane = 0; lane < SLICE; ++lane)
    if (mask >> lane & 1 && body_cuts_bond(body, (int32_t)(slice * SLICE + lane), base + lane))
      mask = (uint8_t)(mask & ~(1u << lane));
  return mask;
}

typedef struct Rows { /* of slices of one lattice, for a loop over slices */
  int64_t row, chunk;
} Rows;

typedef struct Build {
  Family *family;
  const Body *body;
  const Rows *rows;
  const StoredBonds *stored;
  int64_t *stored_before; /* [slices + 1] slots that are stored, of the slices before each */
  uint64_t *mark;         /* [slices] alike for slices whose lists of slots are alike */
  uint8_t *own;           /* [slices] 1: it writes its list, which others may have too */
  atomic_llong bonds;
  atomic_int unlike; /* lists that were taken for alike and are not */
} Build;

/** What is done with the slots of a slice: they are counted and marked; or its list is written; or, where another slice has written it, compared with that. Intact
 *  bits are written with both. */
typedef enum Pass { COUNT_SLOTS, WRITE_LIST, COMPARE_LIST } Pass;

/** A number by which lists of slots are told apart, with one more slot. */
static uint64_t marked_with(uint64_t mark, uint64_t number)
{
  mark = (mark ^ number) * 0x9e3779b97f4a7c15u;
  return mark ^ mark >> 29;
}

/** Slots of one slice. @return their number; `stored_slots` of which are stored */
static int64_t slice_slots(Build *build, int64_t slice, Pass pass, int64_t *stored_slots, int64_t *bonds)
{
  const bool write = pass != COUNT_SLOTS;
  uint64_t mark = 0;
  Family *family = build->family;
  const Rows *where = &build->rows[slice];
  const int block = build->body->particles.block[slice];
  const Lattice *lattice = &build->body->lattices[block];
  int64_t slot = write ? family->first[slice] : 0, begin = slot, cell[3];
  NeighbourRow beyond = {.pattern = -1};
  if (lattice->chunks) lattice_cell(lattice, where->row, where->chunk, 0, cell);
  for (int k = 0; k < family->pattern_begin[block + 1] - family->pattern_begin[block]; ++k) {
    int32_t base = 0;
    const Pattern *pattern = &family->patterns[family->pattern_begin[block] + k];
    if (pattern->row != beyond.pattern) beyond = neighbour_row(lattice, cell, pattern);
    if (!beyond.slices) continue;
    uint8_t mask = lattice_slot(&build->body->particles, lattice, slice, beyond.slices,
                                beyond.begin + pattern->offset[lattice->axis], &base);
    if (mask && build->body->crack_count) mask = cut_slot(build->body, slice, base, mask);
    if (!mask) continue;
    const uint16_t row = (uint16_t)(family->pattern_begin[block] + k);
    base -= (int32_t)(slice * SLICE);
    if (pass == COUNT_SLOTS) mark = marked_with(mark, (uint64_t)row << 32 | (uint32_t)base);
    if (pass == WRITE_LIST) {
      family->base[slot + family->entry[slice]] = base;
      family->pattern[slot + family->entry[slice]] = row;
    }
    if (pass == COMPARE_LIST &&
        (family->base[slot + family->entry[slice]] != base || family->pattern[slot + family->entry[slice]] != row))
      atomic_store(&build->unlike, 1);
    if (write) family->intact[slot] = mask;
    *bonds += __builtin_popcount(mask);
    ++slot;
  }
  const StoredBonds *stored = build->stored;
  int64_t most = 0;
  for (int lane = 0; lane < SLICE; ++lane) {
    int64_t place = slice * SLICE + lane, count = stored->first ? stored->first[place + 1] - stored->first[place] : 0;
    *bonds += count;
    if (count > most) most = count;
  }
  if (write) {
    family->stored[slice] = slot;
    int64_t row = *stored_slots;
    for (int64_t k = 0; k < most; ++k, ++row) {
      family->base[slot + k] = (int32_t)row;
      for (int lane = 0; lane < SLICE; ++lane) {
        int64_t place = slice * SLICE + lane, at = stored->first[place] + k;
        bool here = at < stored->first[place + 1];
        family->neighbour[row * SLICE + lane] = here ? stored->neighbour[at] : (int32_t)place;
        if (family->scale) family->scale[row * SLICE + lane] = here ? stored->scale[at] : 0;
        if (here) family->intact[slot + k] |= (uint8_t)(1u << lane);
      }
    }
  }
  *stored_slots += most;
  if (pass == COUNT_SLOTS) build->mark[slice] = mark;
  return slot - begin + most;
}

static Rows *slice_rows(const Body *body, Error *error)
{
  Rows *rows = memory_zeroed((size_t)body->particles.slices, sizeof *rows, "slice rows", error);
  for (int b = 0; rows && b < body->block_count; ++b) {
    const Lattice *lattice = &body->lattices[b];
    const int64_t count = lattice_row_count(lattice);
    for (int64_t row = 0; row < count; ++row)
      for (int64_t chunk = 0; chunk < lattice->chunks; ++chunk) {
        int32_t slice = lattice->slice[row * lattice->chunks + chunk];
        if (slice >= 0) rows[slice] = (Rows){row, chunk};
      }
  }
  return rows;
}

static void count_slots(void *context)
{
  Build *build = context;
  int64_t bonds = 0;
  TEAM_FOR (s, build->body->particles.slices)
    build->family->first[s + 1] = slice_slots(build, s, COUNT_SLOTS, &build->stored_before[s + 1], &bonds);
  atomic_fetch_add(&build->bonds, bonds);
}

static void write_list(void *context, int64_t slice)
{
  Build *build = context;
  int64_t row = build->stored_before[slice], ignored = 0;
  if (build->own[slice]) slice_slots(build, slice, WRITE_LIST, &row, &ignored);
}

static void compare_list(void *context, int64_t slice)
{
  Build *build = context;
  int64_t row = build->stored_before[slice], ignored = 0;
  if (!build->own[slice]) slice_slots(build, slice, COMPARE_LIST, &row, &ignored);
}

/** Finds slices whose lists of slots are alike by what they are marked with and their lengths: the first of them writes it. */
static int share_lists(Build *build, Error *error)
{
  Family *family = build->family;
  const int64_t slices = build->body->particles.slices;
  int64_t size = 16;
  while (size < 2 * slices) size *= 2;
  int32_t *table = memory_reserved((size_t)size, sizeof *table, "bond rows", error); /* slice + 1; 0: empty */
  family->entries = 0;
  for (int64_t s = 0; s < slices && table; ++s) {
    const int64_t length = family->first[s + 1] - family->first[s];
    int64_t at = (int64_t)(marked_with(build->mark[s], (uint64_t)length) & (uint64_t)(size - 1)), other = -1;
    for (; !family->stored_slots && table[at] && other < 0; at = (at + 1) & (size - 1)) {
      const int64_t there = table[at] - 1;
      if (build->mark[there] == build->mark[s] && family->first[there + 1] - family->first[there] == length)
        other = there;
    }
    build->own[s] = other < 0;
    family->entry[s] = (other < 0 ? family->entries : family->first[other] + family->entry[other]) - family->first[s];
    if (other >= 0) continue;
    table[at] = (int32_t)s + 1;
    family->entries += length;
  }
  free(table);
  return table ? BRECCIA_OK : BRECCIA_FAILURE;
}

static int write_slots(Build *build, Error *error)
{
  Family *family = build->family;
  const int64_t slices = build->body->particles.slices;
  if (share_lists(build, error)) return BRECCIA_FAILURE;
  free(family->base);
  free(family->pattern);
  family->base = memory_zeroed((size_t)family->entries, sizeof *family->base, "bonds", error);
  family->pattern = memory_zeroed((size_t)family->entries, sizeof *family->pattern, "bonds", error);
  if (!family->base || !family->pattern) return BRECCIA_FAILURE;
  team_each(slices, write_list, build);
  team_each(slices, compare_list, build);
  if (!atomic_exchange(&build->unlike, 0)) return BRECCIA_OK;
  for (int64_t s = 0; s < slices; ++s)
    build->mark[s] = (uint64_t)s; /* marks deceive, as hardly ever: each has its own */
  return write_slots(build, error);
}

static int fill_slots(Build *build, Error *error)
{
  Family *family = build->family;
  const int64_t slices = build->body->particles.slices;
  family->first = memory_zeroed((size_t)slices + 1, sizeof(int64_t), "bond rows", error);
  family->stored = memory_zeroed((size_t)slices, sizeof(int64_t), "bond rows", error);
  family->entry = memory_zeroed((size_t)slices, sizeof(int64_t), "bond rows", error);
  if (!family->first || !family->stored || !family->entry) return BRECCIA_FAILURE;
  team_run(count_slots, build);
  for (int64_t s = 0; s < slices; ++s) {
    family->first[s + 1] += family->first[s];
    build->stored_before[s + 1] += build->stored_before[s];
  }
  family->bonds = build->bonds;
  family->slots = family->first[slices];
  family->stored_slots = build->stored_before[slices];
  family->intact = memory_zeroed((size_t)family->slots, sizeof *family->intact, "bonds", error);
  const int64_t ahead = family->stored_slots ? FAMILY_AHEAD : 0;
  family->neighbour = memory_zeroed((size_t)(family->stored_slots + ahead) * SLICE, sizeof(int32_t), "bonds", error);
  int failed = !family->intact || !family->neighbour;
  if (build->stored->scale)
    failed |= !(family->scale = memory_zeroed((size_t)family->stored_slots * SLICE, sizeof(double), "bonds", error));
  return failed ? BRECCIA_FAILURE : write_slots(build, error);
}

static int build_slots(Build *build, Error *error)
{
  const size_t slices = (size_t)build->body->particles.slices;
  build->stored_before = memory_zeroed(slices + 1, sizeof *build->stored_before, "bond rows", error);
  build->mark = memory_zeroed(slices, sizeof *build->mark, "bond rows", error);
  build->own = memory_zeroed(slices, 1, "bond rows", error);
  const bool made = build->stored_before && build->mark && build->own;
  const int status = made ? fill_slots(build, error) : BRECCIA_FAILURE;
  free(build->stored_before);
  free(build->mark);
  free(build->own);
  return status;
}

int family_create(Family *family, const Body *body, const FamilySpec *spec, Error *error)
{
  const double beyond = spec->correction == VOLUME_PARTIAL_BEYOND ? body->largest_spacing / 2 : 0;
  *family = (Family){.particles = &body->particles,
                     .lattices = body->lattices,
                     .horizon = spec->horizon,
                     .reach = spec->horizon + beyond};
  int blocks = body->block_count;
  family->rows.kind = memory_zeroed((size_t)blocks * ROW_KINDS, sizeof(RowKind), "lattice rows", error);
  if (!family->rows.kind) return BRECCIA_FAILURE;
  family->pattern_begin = memory_zeroed((size_t)blocks + 1, sizeof(int), "bond patterns", error);
  Rows *rows = slice_rows(body, error);
  StoredBonds stored = {0};
  int status = family->pattern_begin && rows ? BRECCIA_OK : BRECCIA_FAILURE;
  bool stored_too = blocks > 1;
  for (int b = 0; b < blocks && !status; ++b) {
    double reach = spec->horizon + (spec->correction == VOLUME_PARTIAL_BEYOND ? body->lattices[b].spacing / 2 : 0);
    bool cloud = !body->lattices[b].chunks;
    if (!cloud) status = add_patterns(family, &body->lattices[b], spec, reach, error);
    stored_too |= cloud;
    family->pattern_begin[b + 1] = family->pattern_count;
    if (!status && spec->row_sums && !cloud) status = lattice_rows_choose(family, b, error);
  }
  if (!status && stored_too) {
    StoredWeight weight = {spec->horizon, spec->influence, spec->correction, volume_share};
    status = search_beyond_lattices(&stored, body, &weight, error);
  }
  if (!status) {
    Build build = {.family = family, .body = body, .rows = rows, .stored = &stored};
    status = build_slots(&build, error);
  }
  if (!status && spec->row_sums) status = lattice_rows_create(family, body, error);
  free(rows);
  stored_bonds_destroy(&stored);
  if (status) { /* what needs bonds asks for this */
    free(family->first);
    family->first = NULL;
  }
  return status;
}

void family_destroy(Family *family)
{
  free(family->first);
  free(family->stored);
  free(family->entry);
  free(family->base);
  free(family->pattern);
  free(family->intact);
  free(family->patterns);
  free(family->pattern_begin);
  free(family->neighbour);
  free(family->scale);
  lattice_rows_destroy(&family->rows);
  *family = (Family){0};
}

/** Slot in which place a has place b as its neighbour, by an intact bond or by a broken one, or -1. */
static int64_t find_slot(const Family *family, int32_t a, int32_t b, unsigned intact)
{
  int64_t slice = a / SLICE;
  int lane = a % SLICE;
  for (int64_t slot = family->first[slice]; slot < family->first[slice + 1]; ++slot)
    if (((unsigned)family->intact[slot] >> lane & 1u) == intact &&
        family_bond(family, slice, slot, lane).neighbour == b)
      return slot;
  return -1;
}

int64_t family_slot(const Family *family, int32_t a, int32_t b)
{
  return find_slot(family, a, b, 1);
}

int64_t family_slice(const Family *f, int64_t slot)
{
  int64_t low = 0, high = f->particles->slices;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    if (f->first[middle] <= slot)
      low = middle;
    else
      high = middle;
  }
  return low;
}

bool family_joins(const Family *family, int32_t a, int32_t b)
{
  return find_slot(family, a, b, 1) >= 0;
}

static bool change_bond(Family *family, int32_t a, int32_t b, unsigned intact)
{
  const int64_t there = find_slot(family, a, b, intact), back = find_slot(family, b, a, intact);
  if (there < 0 || back < 0) return false;
  family->intact[there] = (uint8_t)(family->intact[there] ^ 1u << (a % SLICE));
  family->intact[back] = (uint8_t)(family->intact[back] ^ 1u << (b % SLICE));
  lattice_rows_mark(family, a / SLICE);
  lattice_rows_mark(family, b / SLICE);
  return true;
}

bool family_break(Family *family, int32_t a, int32_t b)
{
  return change_bond(family, a, b, 1);
}

bool family_mend(Family *family, int32_t a, int32_t b)
{
  return change_bond(family, a, b, 0);
}

int family_count(const Family *family, int32_t place)
{
  int64_t slice = place / SLICE;
  int lane = place % SLICE, count = 0;
  for (int64_t slot = family->first[slice]; slot < family->first[slice + 1]; ++slot)
    count += family->intact[slot] >> lane & 1;
  return count;
}

double family_volume(const Family *family, int32_t place)
{
  int64_t slice = place / SLICE;
  int lane = place % SLICE;
  double volume = 0;
  for (int64_t slot = family->first[slice]; slot < family->first[slice + 1]; ++slot)
    if (family->intact[slot] >> lane & 1)
      volume += family->particles->volume[family_bond(family, slice, slot, lane).neighbour];
  return volume;
}

void family_state(Family *family, StateList *list)
{
  state_add(list,
            &(StateRow){.unit = "1",
                        .kind = STATE_BYTES,
                        .entity = STATE_OF_SLOT,
                        .role = STATE_COMMITTED,
                        .count = family->slots,
                        .values = family->intact},
            "intact", NULL);
}

size_t family_bytes(const Family *family)
{
  const size_t entry = sizeof *family->base + sizeof *family->pattern;
  const size_t stored = SLICE * (sizeof *family->neighbour + (family->scale ? sizeof *family->scale : 0));
  return (size_t)family->entries * entry + (size_t)family->slots * sizeof *family->intact +
         (size_t)family->stored_slots * stored + (size_t)family->particles->slices * 3 * sizeof(int64_t) +
         lattice_rows_bytes(family);
}

#include "family/bond_list.h"

#include "base/team.h"
#include <stdlib.h>

typedef struct Build {
  BondList *list;
  const Family *family;
  const int32_t *material, *stiffness;
  const uint8_t *foreign;
  uint8_t *mixed; /* [places] 1: some neighbours have another stiffness; NULL without `stiffness` */
} Build;

static int32_t stored_neighbour(const Family *f, int64_t slot, int lane)
{
  return f->neighbour[(int64_t)f->base[slot] * SLICE + lane];
}

static bool is_foreign(const Build *b, int64_t place)
{
  return b->foreign && b->foreign[place / SLICE];
}

/** Whether a lane of a stored slot owns a bond. */
static bool owns_stored(const Build *b, int64_t slice, int64_t slot, int lane)
{
  const Family *f = b->family;
  if (!(f->intact[slot] >> lane & 1) || is_foreign(b, slice * SLICE)) return false;
  const int32_t there = stored_neighbour(f, slot, lane);
  return there > slice * SLICE + lane || is_foreign(b, there);
}

/** Marks the places of a slice that have neighbours of another stiffness. Such neighbours are in other blocks. */
static void bond_list_mark_mixed(void *context, int64_t slice)
{
  const Build *b = context;
  const Family *f = b->family;
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!(f->intact[slot] >> lane & 1)) continue;
      const int32_t there = stored_neighbour(f, slot, lane);
      if (!is_foreign(b, there) && b->stiffness[there / SLICE] != b->stiffness[slice])
        b->mixed[slice * SLICE + lane] = 1;
    }
}

/** Number of common neighbours of both ends of a bond by material. */
typedef struct AroundBond {
  int32_t material[16], stiffness[16], count[16];
  int found;
} AroundBond;

static void bond_list_count_around(AroundBond *around, int32_t material, int32_t stiffness)
{
  int k = 0;
  while (k < around->found && around->material[k] != material) ++k;
  if (k == 16) return;
  if (k == around->found) {
    around->material[k] = material;
    around->stiffness[k] = stiffness;
    around->count[around->found++] = 0;
  }
  ++around->count[k];
}

/** Returns the number of common neighbours that have the stiffness of material k. */
static int bond_list_alike_around(const AroundBond *around, int k)
{
  int sum = 0;
  for (int j = 0; j < around->found; ++j) sum += around->stiffness[j] == around->stiffness[k] ? around->count[j] : 0;
  return sum;
}

/** Returns the most frequent material among the common neighbours of both ends of a bond whose stiffness differs from
 *  the bond's. Of several stiffnesses the most frequent one counts. Returns -1 if all neighbours are as stiff. */
static int32_t bond_list_material_around(const Build *b, int64_t slice, int lane, int32_t there)
{
  const Family *f = b->family;
  AroundBond around = {.found = 0};
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot) {
    if (!(f->intact[slot] >> lane & 1)) continue;
    const int32_t near = stored_neighbour(f, slot, lane), stiffness = b->stiffness[near / SLICE];
    if (!is_foreign(b, near) && stiffness != b->stiffness[slice] && family_joins(f, there, near))
      bond_list_count_around(&around, b->material[near / SLICE], stiffness);
  }
  int best = 0;
  for (int k = 1; k < around.found; ++k) {
    const int more = bond_list_alike_around(&around, k) - bond_list_alike_around(&around, best),
              own = around.count[k] - around.count[best], before = around.material[best] - around.material[k];
    if (more > 0 || (!more && (own > 0 || (!own && before > 0)))) best = k;
  }
  return around.found ? around.material[best] : -1;
}

/** Returns the material of the second row of an owned bond, or the material of the slice if there is no second row. */
static int32_t other_material(const Build *b, int64_t slice, int64_t slot, int lane)
{
  const Family *f = b->family;
  const bool lattice = slot < f->stored[slice];
  const int32_t there = lattice ? family_base(f, slice, slot) + lane : stored_neighbour(f, slot, lane);
  if (is_foreign(b, there)) return b->material[slice];
  const int32_t material = b->material[there / SLICE];
  if (!b->mixed || !b->mixed[slice * SLICE + lane] || !b->mixed[there] ||
      b->stiffness[there / SLICE] != b->stiffness[slice])
    return material;
  const int32_t around = bond_list_material_around(b, slice, lane, there);
  return around < 0 ? material : around;
}

/** Returns true if a lane of a slot owns a bond that has a second row. */
static bool bond_list_has_second(const Build *b, int64_t slice, int64_t slot, int lane)
{
  const Family *f = b->family;
  if (slot < f->stored[slice]) {
    if (!b->mixed || !bond_list_owns(f, slice, slot) || !(f->intact[slot] >> lane & 1)) return false;
  } else if (!owns_stored(b, slice, slot, lane)) {
    return false;
  }
  return other_material(b, slice, slot, lane) != b->material[slice];
}

/** Returns the first slot of a slice whose bonds may have second rows. */
static int64_t bond_list_seconds(const Build *b, int64_t slice)
{
  return b->mixed ? b->family->first[slice] : b->family->stored[slice];
}

/** Second rows of a slice, of the materials above `after` in their order. @return the least of these materials, or -1 */
static int32_t next_material(const Build *b, int64_t slice, int32_t after)
{
  const Family *f = b->family;
  int32_t next = -1;
  for (int64_t slot = bond_list_seconds(b, slice); slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!bond_list_has_second(b, slice, slot, lane)) continue;
      const int32_t there = other_material(b, slice, slot, lane);
      if (there > after && (next < 0 || there < next)) next = there;
    }
  return next;
}

static void count_slice(void *context, int64_t slice)
{
  const Build *b = context;
  const Family *f = b->family;
  int64_t owned = 0, single = 0;
  if (is_foreign(b, slice * SLICE)) return;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) owned += bond_list_owns(f, slice, slot);
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) single += owns_stored(b, slice, slot, lane);
  for (int64_t slot = bond_list_seconds(b, slice); slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) single += bond_list_has_second(b, slice, slot, lane);
  b->list->owned_first[slice + 1] = owned;
  b->list->single_first[slice + 1] = single;
}

/** Fills the second rows of a slice for one material. @param[in,out] single, row  next entry and row */
static void bond_list_fill_second(const Build *b, int64_t slice, int32_t material, int64_t *single, int64_t *row)
{
  const Family *f = b->family;
  BondList *l = b->list;
  for (int64_t slot = bond_list_seconds(b, slice); slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!bond_list_has_second(b, slice, slot, lane) || other_material(b, slice, slot, lane) != material) continue;
      if (slot < f->stored[slice])
        l->pairs_lattice[slice] = 1;
      else if (b->material[stored_neighbour(f, slot, lane) / SLICE] == material)
        l->partner_row[(int64_t)f->base[slot] * SLICE + lane] = (int32_t)*row;
      else
        l->partner_row[(int64_t)f->base[slot] * SLICE + lane] = -2 - (int32_t)*row;
      l->single_material[*single] = material;
      l->single[(*single)++] = -1 - ((int32_t)(SLICE * (slot - f->first[slice])) + lane);
      ++*row;
    }
}

/** Rows of bonds that a slice owns. */
static void fill_slice(void *context, int64_t slice)
{
  const Build *b = context;
  const Family *f = b->family;
  BondList *l = b->list;
  int64_t owned = l->owned_first[slice], single = l->single_first[slice], row = l->first[slice];
  if (is_foreign(b, slice * SLICE)) return;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
    if (!bond_list_owns(f, slice, slot)) continue;
    l->owned[owned++] = (uint16_t)(slot - f->first[slice]);
    l->slot_row[slot][0] = (int32_t)row;
    row += SLICE;
  }
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      if (!owns_stored(b, slice, slot, lane)) continue;
      l->stored_row[(int64_t)f->base[slot] * SLICE + lane] = (int32_t)row++;
      l->keeps[f->base[slot]] |= (uint8_t)(1u << lane);
      l->single_material[single] = b->material[slice];
      l->single[single++] = (int32_t)(SLICE * (slot - f->first[slice])) + lane;
    }
  for (int32_t material = next_material(b, slice, -1); material >= 0; material = next_material(b, slice, material))
    bond_list_fill_second(b, slice, material, &single, &row);
}

/** Slot of a slice with a lattice vector the opposite of that of a pattern, or -1. */
static int64_t opposite_slot(const Family *f, int64_t slice, const Pattern *pattern)
{
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
    const int *offset = f->patterns[family_pattern(f, slice, slot)].offset;
    if (offset[0] == -pattern->offset[0] && offset[1] == -pattern->offset[1] && offset[2] == -pattern->offset[2])
      return slot;
  }
  return -1;
}

/** Where bonds that others own have their rows. */
static void mate_slice(void *context, int64_t slice)
{
  const Build *b = context;
  const Family *f = b->family;
  BondList *l = b->list;
  if (is_foreign(b, slice * SLICE)) return;
  for (int64_t slot = f->first[slice]; slot < f->stored[slice]; ++slot) {
    if (bond_list_owns(f, slice, slot)) continue;
    const int32_t shift = family_base(f, slice, slot) & (SLICE - 1),
                  owners[2] = {(family_base(f, slice, slot) - shift) / SLICE,
                               (family_base(f, slice, slot) - shift) / SLICE + 1};
    for (int n = 0; n < (shift ? 2 : 1); ++n) {
      const int64_t there =
          owners[n] >= 0 ? opposite_slot(f, owners[n], &f->patterns[family_pattern(f, slice, slot)]) : -1;
      l->slot_row[slot][n] = there < 0 ? 0 : l->slot_row[there][0] + shift - (n ? SLICE : 0);
    }
  }
  for (int64_t slot = f->stored[slice]; slot < f->first[slice + 1]; ++slot)
    for (int lane = 0; lane < SLICE; ++lane) {
      const int32_t place = (int32_t)(slice * SLICE + lane), owner = stored_neighbour(f, slot, lane);
      if (!(f->intact[slot] >> lane & 1) || owner > place || is_foreign(b, owner)) continue;
      const int64_t there = family_slot(f, owner, place), at = (int64_t)f->base[slot] * SLICE + lane,
                    seen = (int64_t)f->base[there] * SLICE + owner % SLICE;
      l->stored_row[at] = l->stored_row[seen];
      if (l->partner_row) l->partner_row[at] = l->partner_row[seen];
    }
}

/** Counts and fills the rows of all slices. */
static int bond_list_fill(Build *b, Error *error)
{
  BondList *l = b->list;
  const int64_t slices = b->family->particles->slices;
  team_each(slices, count_slice, b);
  for (int64_t s = 0; s < slices; ++s) {
    l->owned_first[s + 1] += l->owned_first[s];
    l->single_first[s + 1] += l->single_first[s];
    l->first[s + 1] = SLICE * l->owned_first[s + 1] + l->single_first[s + 1];
  }
  l->count = l->first[slices];
  if (l->count > INT32_MAX - SLICE)
    return error_add(
        error, BRECCIA_USER_ERROR,
        "%lld bonds are too many for laws with a history, which allow %d; take a shorter horizon or a wider "
        "spacing",
        (long long)l->count, INT32_MAX - SLICE);
  l->owned = memory_zeroed((size_t)l->owned_first[slices], sizeof *l->owned, "list of bonds", error);
  l->single = memory_zeroed((size_t)l->single_first[slices], sizeof *l->single, "list of bonds", error);
  l->single_material =
      memory_zeroed((size_t)l->single_first[slices], sizeof *l->single_material, "list of bonds", error);
  if (!l->owned || !l->single || !l->single_material) return BRECCIA_FAILURE;
  team_each(slices, fill_slice, b);
  team_each(slices, mate_slice, b);
  return BRECCIA_OK;
}

int bond_list_create(BondList *l, const Family *f, const BondListOf *of, Error *error)
{
  const int64_t slices = f->particles->slices;
  const int32_t *material = of->material;
  const uint8_t *foreign = of->foreign;
  bool several = false;
  int32_t first = -1;
  for (int64_t s = 0; s < slices; ++s) {
    if (foreign && foreign[s]) continue;
    if (first < 0) first = material[s];
    several |= material[s] != first;
  }
  *l = (BondList){
      .first = memory_zeroed((size_t)slices + 1, sizeof(int64_t), "list of bonds", error),
      .owned_first = memory_zeroed((size_t)slices + 1, sizeof(int64_t), "list of bonds", error),
      .single_first = memory_zeroed((size_t)slices + 1, sizeof(int64_t), "list of bonds", error),
      .slot_row = memory_zeroed((size_t)f->slots + BOND_LIST_SPARE, sizeof *l->slot_row, "list of bonds", error),
      .keeps = memory_zeroed((size_t)f->stored_slots, 1, "list of bonds", error),
      .stored_row =
          memory_zeroed((size_t)(f->stored_slots + FAMILY_AHEAD) * SLICE, sizeof(int32_t), "list of bonds", error)};
  if (several) l->partner_row = memory_zeroed((size_t)f->stored_slots * SLICE, sizeof(int32_t), "list of bonds", error);
  if (!l->first || !l->owned_first || !l->single_first || !l->keeps || !l->slot_row || !l->stored_row ||
      (several && !l->partner_row))
    return BRECCIA_FAILURE;
  for (int64_t n = 0; several && n < f->stored_slots * SLICE; ++n) l->partner_row[n] = -1;
  Build build = {l, f, material, of->stiffness, foreign, NULL};
  if (several && of->stiffness) {
    build.mixed = memory_zeroed((size_t)slices * SLICE, 1, "list of bonds", error);
    l->pairs_lattice = memory_zeroed((size_t)slices, 1, "list of bonds", error);
    if (!build.mixed || !l->pairs_lattice) {
      free(build.mixed);
      return BRECCIA_FAILURE;
    }
    team_each(slices, bond_list_mark_mixed, &build);
  }
  const int status = bond_list_fill(&build, error);
  free(build.mixed);
  return status;
}

void bond_list_destroy(BondList *l)
{
  free(l->first);
  free(l->owned_first);
  free(l->owned);
  free(l->single_first);
  free(l->single);
  free(l->single_material);
  free(l->pairs_lattice);
  free(l->keeps);
  free(l->slot_row);
  free(l->stored_row);
  free(l->partner_row);
  *l = (BondList){0};
}

/** Returns the second row of a lattice bond, or its first one if there is none. */
static int64_t bond_list_lattice_partner(const BondList *l, const Family *f, int64_t slice, int64_t slot, int lane,
                                         int64_t row)
{
  int64_t owner = slice, own_slot = slot, n;
  if (!bond_list_owns(f, slice, slot)) {
    const int32_t there = family_base(f, slice, slot) + lane;
    if (there < 0) return row;
    owner = there / SLICE;
    lane = there % SLICE;
    if (!l->pairs_lattice[owner]) return row;
    own_slot = opposite_slot(f, owner, &f->patterns[family_pattern(f, slice, slot)]);
    if (own_slot < 0) return row;
  }
  if (!l->pairs_lattice[owner]) return row;
  const int32_t code = -1 - ((int32_t)(SLICE * (own_slot - f->first[owner])) + lane);
  for (n = l->single_first[owner + 1] - 1; n >= l->single_first[owner] && l->single[n] < 0; --n)
    if (l->single[n] == code) return l->first[owner + 1] - (l->single_first[owner + 1] - n);
  return row;
}

void bond_list_rows(const BondList *l, const Family *f, int64_t slice, int64_t slot, int lane, int64_t rows[2])
{
  if (slot < f->stored[slice]) {
    const int shift = family_base(f, slice, slot) & (SLICE - 1);
    const bool second = !bond_list_owns(f, slice, slot) && lane + shift >= SLICE;
    rows[0] = rows[1] = l->slot_row[slot][second] + lane;
    if (l->pairs_lattice) rows[1] = bond_list_lattice_partner(l, f, slice, slot, lane, rows[0]);
    return;
  }
  const int64_t at = (int64_t)f->base[slot] * SLICE + lane;
  const int32_t partner = l->partner_row ? l->partner_row[at] : -1;
  const bool owner = f->neighbour[at] > slice * SLICE + lane;
  rows[0] = rows[1] = l->stored_row[at];
  if (partner >= 0) rows[owner] = partner;
  if (partner < -1) rows[1] = -2 - partner;
}

bool bond_list_bond(const BondList *l, const Family *f, int64_t slice, int64_t row, int64_t *slot, int *lane)
{
  const int64_t n = row - l->first[slice], lattice = SLICE * (l->owned_first[slice + 1] - l->owned_first[slice]);
  if (n < lattice) {
    *slot = f->first[slice] + l->owned[l->owned_first[slice] + n / SLICE];
    *lane = (int)(n % SLICE);
    return false;
  }
  const int32_t single = l->single[l->single_first[slice] + n - lattice], code = single < 0 ? -1 - single : single;
  *slot = f->first[slice] + code / SLICE;
  *lane = code % SLICE;
  return single < 0;
}

void bond_list_mark(const BondList *l, const Family *f, uint8_t *present)
{
  for (int64_t slice = 0; slice < f->particles->slices; ++slice)
    for (int64_t row = l->first[slice]; row < l->first[slice + 1]; ++row) {
      int64_t slot;
      int lane;
      bond_list_bond(l, f, slice, row, &slot, &lane);
      present[row] = f->intact[slot] >> lane & 1;
    }
}

size_t bond_list_bytes(const BondList *l, const Family *f)
{
  if (!l->first) return 0;
  const int64_t slices = f->particles->slices;
  return 3 * (size_t)slices * sizeof *l->first + (size_t)l->owned_first[slices] * sizeof *l->owned +
         (size_t)l->single_first[slices] * (sizeof *l->single + sizeof *l->single_material) +
         (size_t)f->slots * sizeof *l->slot_row +
         (size_t)f->stored_slots * (sizeof *l->keeps + SLICE * sizeof(int32_t) * (l->partner_row ? 2 : 1));
}

/* Every bond once, in rows, for what belongs to bonds and not to their two ends: material points of laws that act on them. Made only where
 * somebody asks for it.
 *
 * A bond has its row in the slice of its end with the lower place, its owner. Rows of a slice: eight for each of its lattice slots that lead
 * to higher places, lane by lane (also where a lane has no bond); then one for each stored bond of which it is the owner; then a second one
 * for each of these bonds that joins two materials, for the material of the other end. If `stiffness` is given, a bond
 * between ends of one stiffness with common neighbours of another stiffness has a second row, too, for the material of
 * these neighbours. This holds for lattice bonds and for stored bonds.
 * Always true: rows first[s] .. first[s + 1] - 1 are those of slice s; rows of one material in one slice lie side by side, the owner's first. */
#ifndef BRECCIA_FAMILY_BOND_LIST_H
#define BRECCIA_FAMILY_BOND_LIST_H

#include "family/family.h"

enum { BOND_LIST_SPARE = 16 };

typedef struct BondList {
  int64_t count;         /* rows */
  int64_t *first;        /* [slices + 1] */
  int64_t *owned_first;  /* [slices + 1] entries of `owned` */
  uint16_t *owned;       /* lattice slots that have rows, counted from the first slot of their slice */
  int64_t *single_first; /* [slices + 1] entries of `single` */
  /** Stored bonds with rows: 8 (slot - first slot of the slice) + lane. A negative entry -1 - x is the second row of
   *  bond x, which may be a lattice bond. */
  int32_t *single;
  int32_t *single_material; /* [entries of `single`] material of the row */
  uint8_t *pairs_lattice;   /* [slices] 1: some lattice bonds of the slice have second rows; NULL: none in any slice */
  uint8_t *keeps;           /* [stored_slots] bits of the lanes that own their bonds */
  /** [slots][2] of a lattice slot: the row of lane 0. Where the neighbours are the owners, they may stand in two slices: lanes with neighbours in the
   *  first of them have row [0] + lane, the others [1] + lane. */
  int32_t (*slot_row)[2]; /* with BOND_LIST_SPARE entries behind the last */
  int32_t *stored_row;    /* [stored_slots + FAMILY_AHEAD][8] the row of the owner's material */
  /** [stored_slots][8] second row of the bond: row for the material of the other end, or -2 - (row for a material
   *  around the bond); -1: none. NULL: there is one material. */
  int32_t *partner_row;
} BondList;

/** Data besides families from which the rows of bonds are made. */
typedef struct BondListOf {
  const int32_t *material; /* [slices] */
  /** [slices] equal numbers: materials of equal stiffness. NULL: only bonds that join two materials have second
   *  rows. */
  const int32_t *stiffness;
  /** [slices] 1: the slice does not belong to the owner of the list. A bond with a foreign end has one row, owned by
   *  the other end. NULL: there are none. */
  const uint8_t *foreign;
} BondListOf;

int bond_list_create(BondList *list, const Family *family, const BondListOf *of, Error *error);
void bond_list_destroy(BondList *list);

/** Finds the two rows of the bond of a lane: for the law of this end and for the law of the other end; equal if there
 *  is no second row. Between ends of equal stiffness the second row is that of the other material around the bond. */
void bond_list_rows(const BondList *list, const Family *family, int64_t slice, int64_t slot, int lane, int64_t rows[2]);

/** Slot and lane of a row of a slice. @return whether it is a second row */
bool bond_list_bond(const BondList *list, const Family *family, int64_t slice, int64_t row, int64_t *slot, int *lane);

/** Marks the rows that have a bond. @param[out] present  [count] */
void bond_list_mark(const BondList *list, const Family *family, uint8_t *present);

size_t bond_list_bytes(const BondList *list, const Family *family);

/** True if the bonds of a lattice slot have their rows in its own slice. */
static inline bool bond_list_owns(const Family *family, int64_t slice, int64_t slot)
{
  return family_base(family, slice, slot) > slice * SLICE;
}

/** Numbers per row, as half a slot sees its bonds; what stands where there is none is of no use.
 *  @param[in] rows  [count] with spare entries (places_array) */
LANES_INLINE Lanes bond_list_load(const BondList *list, const Family *family, const double *rows, int64_t slice,
                                  int64_t slot, int half)
{
  if (slot >= family->stored[slice])
    return lanes_gather(rows, list->stored_row + (int64_t)family->base[slot] * SLICE + LANES * half);
  const int32_t *row = list->slot_row[slot];
  const int shift = family_base(family, slice, slot) & (SLICE - 1);
  const Lanes first = lanes_load(rows + row[0] + LANES * half);
  if (!shift || bond_list_owns(family, slice, slot)) return first;
  return lanes_choose(lanes_half(255u >> shift, half), first, lanes_load(rows + row[1] + LANES * half));
}

#endif

/* Who interacts with whom.
 *
 * The bonds of a slice of eight particles lie in slots: slot k holds one bond of each of them. On a lattice the eight
 * neighbours of a slot stand side by side too and share one reference vector, so a slot is a base index (the place of lane
 * 0's neighbour), a row of the pattern table (reference vector, length, weight) and a byte of intact bits. Inside a body the lists of
 * slots of most slices are alike but for where they begin: places are counted from the slice's own, and alike lists are kept once.
 * Bonds between lattices, and of particles that stand in none, are kept in stored slots: eight places, and the reference vector is the
 * difference of positions.
 * Always true:
 *   slots first[s] .. stored[s] - 1 of slice s are lattice slots, stored[s] .. first[s+1] - 1 stored ones;
 *   bonds come in pairs (i to j, j to i) whose intact bits agree; no particle is its own neighbour;
 *   the lattice slots of a slice are in the order of patterns: lattice row by lattice row, and along each row. */
#ifndef BRECCIA_FAMILY_FAMILY_H
#define BRECCIA_FAMILY_FAMILY_H

#include "body/body.h"
#include "family/influence.h"
#include "family/lattice_rows.h"

typedef struct Pattern {              /* a relative lattice vector */
  double xi[3];                       /* from the particle to its neighbour */
  double length, weight;              /* weight: influence x volume correction x volume of the neighbour */
  double weighted_xi[3];              /* weight x xi */
  double weight_by_length, by_square; /* weight / length, 1 / length^2 */
  int offset[3];                      /* in primitive vectors (lattice_vector) */
  int twice;                          /* how far the neighbour is along the row, in half cells */
  int row;                            /* alike for patterns that lead to the same lattice row */
  int kind;                           /* of that row, or -1 */
} Pattern;

typedef enum VolumeCorrection { VOLUME_WHOLE, VOLUME_PARTIAL, VOLUME_PARTIAL_BEYOND } VolumeCorrection;

typedef struct FamilySpec {
  double horizon;
  const Influence *influence;
  VolumeCorrection correction;
  bool row_sums; /* the formulation makes sums along lattice rows */
} FamilySpec;

/* So many stored slots ahead sweeps ask for what they will read of neighbours: less and it is not there in time, more and it is gone again. */
enum { FAMILY_AHEAD = 32 };

struct Family {
  const Particles *particles;
  const Lattice *lattices;            /* one per block */
  double horizon, reach;              /* reach: no bond is longer; beyond the horizon if parts of volumes count there */
  int64_t slots, stored_slots, bonds; /* bonds: directed, as built */
  int64_t *first;                     /* [slices + 1]; NULL where the bonds could not be made */
  int64_t *stored;                    /* [slices] first stored slot */
  /* [slices] slot n of a slice has entry n + entry[slice] of base and pattern; 0 in bodies with stored slots. */
  int64_t *entry;
  int64_t entries; /* of base and pattern */
  /* [entries] lattice: places from the slice's first to lane 0's neighbour; stored: row of neighbour and scale. */
  int32_t *base;
  uint16_t *pattern; /* [entries] row of patterns; unused in stored slots */
  uint8_t *intact;   /* [slots] */
  Pattern *patterns;
  int pattern_count,
      *pattern_begin; /* [lattices + 1] those of lattice b are pattern_begin[b] .. pattern_begin[b + 1] - 1 */
  int32_t *
      neighbour; /* [stored_slots + FAMILY_AHEAD][8] the place itself where there is no bond; place 0 behind the last slot */
  double *scale;    /* [stored_slots][8] influence x volume correction; NULL: 1 */
  LatticeRows rows; /* empty if the formulation makes no sums along rows */
};

/** One bond seen from one end. */
typedef struct Bond {
  int32_t neighbour;
  double xi[3], length, weight;
} Bond;

const char *volume_correction_word(int k);

/** Finds all pairs nearer than the horizon (inclusive, with a tolerance of 1e-9) that no cut of the body separates.
 *  Refuses particles that lie (nearly) on top of each other. */
int family_create(Family *family, const Body *body, const FamilySpec *spec, Error *error);
void family_destroy(Family *family);

/** Place of lane 0's neighbour in a lattice slot of a slice. */
static inline int32_t family_base(const Family *family, int64_t slice, int64_t slot)
{
  return (int32_t)(family->base[slot + family->entry[slice]] + slice * SLICE);
}

/** The row of the pattern table of a lattice slot of a slice. */
static inline int family_pattern(const Family *family, int64_t slice, int64_t slot)
{
  return family->pattern[slot + family->entry[slice]];
}

/** The bond of a lane in a slot of a slice; its intact bit is not looked at. */
static inline Bond family_bond(const Family *family, int64_t slice, int64_t slot, int lane)
{
  const Particles *p = family->particles;
  if (slot < family->stored[slice]) {
    const Pattern *row = &family->patterns[family_pattern(family, slice, slot)];
    return (Bond){
        family_base(family, slice, slot) + lane, {row->xi[0], row->xi[1], row->xi[2]}, row->length, row->weight};
  }
  int64_t at = (int64_t)family->base[slot] * SLICE + lane, here = slice * SLICE + lane;
  Bond bond = {.neighbour = family->neighbour[at]};
  bond.weight = (family->scale ? family->scale[at] : 1) * p->volume[bond.neighbour];
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    bond.xi[k] = p->position[k][bond.neighbour] - p->position[k][here];
    square += bond.xi[k] * bond.xi[k];
  }
  bond.length = __builtin_sqrt(square);
  return bond;
}

/** Asks for what half a stored slot will read of its neighbours in FAMILY_AHEAD slots, and, further ahead, for which ones they are: the processor
 *  itself asks for what lies in a row up to the end of a page only.
 *  @param[in] at     where its neighbours stand now
 *  @param[in] shown  [places][length] what is read of a place */
LANES_INLINE void family_fetch_ahead(const Family *family, int64_t at, const double *shown, int length)
{
  const int32_t *ahead = family->neighbour + at + FAMILY_AHEAD * SLICE;
  __builtin_prefetch((const void *)((uintptr_t)ahead + 4 * FAMILY_AHEAD * SLICE * sizeof *ahead));
  for (int lane = 0; lane < LANES; ++lane)
    for (int k = 0; k < length; k += 8) __builtin_prefetch(shown + (int64_t)ahead[lane] * length + k);
}

/** Which lattice row the bonds of a lattice slot of a slice lead to: alike for slots of one row. */
static inline int family_row(const Family *family, int64_t slice, int64_t slot)
{
  return family->patterns[family_pattern(family, slice, slot)].row;
}

/** Breaks the bond between two places on both sides. @return false if there is no intact one */
bool family_break(Family *family, int32_t a, int32_t b);

/** Makes a broken bond between two places whole again, on both sides. @return false if there was none */
bool family_mend(Family *family, int32_t a, int32_t b);

/** @return the slot in which place a has place b as its neighbour by an intact bond, or -1 */
int64_t family_slot(const Family *family, int32_t a, int32_t b);

/** @return the slice of a slot */
int64_t family_slice(const Family *family, int64_t slot);

/** @return whether an intact bond joins two places */
bool family_joins(const Family *family, int32_t a, int32_t b);

/** Intact bonds of a place. */
int family_count(const Family *family, int32_t place);

/** Sum of the neighbours' volumes over intact bonds of a place; at the start it is what damage is measured against. */
double family_volume(const Family *family, int32_t place);

/** The row of intact bits. What follows from them (lattice rows) is marked again by who gives them back. */
void family_state(Family *family, StateList *list);

/** Whether what must always hold of a family does: order of slots, ends and lengths of bonds, and that they come in pairs. */
bool family_is_valid(const Family *family);

/** Bytes that bonds take. */
size_t family_bytes(const Family *family);

#endif

/* Broken bonds in result files: ends, time, position and reason of each.
 *
 * Group Breccia of a file holds two datasets with one row for each broken bond, in the order in which the bonds broke:
 *   BrokenBonds        [count][3] step and numbers of both particles
 *   BrokenBondReasons  [count][columns] the columns of reason_column_at
 * Attributes of BrokenBondReasons list names and units of the columns, causes with the criterion of each, quantities
 * with the unit of each, and materials. The reference of result files (docs/deck.md) is made from the same tables. */
#ifndef BRECCIA_RESULTS_BROKEN_BONDS_H
#define BRECCIA_RESULTS_BROKEN_BONDS_H

#include "deck/quantity.h"
#include "domain/domain.h"
#include "results/result_view.h"

/** One column of BrokenBondReasons: name, dimension ("": a number, or another unit as the text says), meaning. */
typedef struct ReasonColumn {
  const char *name, *dimension, *about;
} ReasonColumn;

/** Returns column k; its name is NULL after the last column. */
const ReasonColumn *reason_column_at(int k);

/** Creates both datasets without rows. @param[in] own  group Breccia @return 0, or 1 when HDF5 refuses */
int broken_bonds_create(hid_t own, const Domain *domain, const Units *units);
/** Writes the broken bonds of a domain from number `first` on. @return 0, or 1 when HDF5 refuses or memory is out */
int broken_bonds_write(hid_t own, const Domain *domain, int64_t first);
/** Cuts both datasets to `count` rows. @return 0, or 1 when HDF5 refuses */
int broken_bonds_cut(hid_t own, int64_t count);

/** One broken bond of a result file. */
typedef struct BondReason {
  int64_t step, particles[2]; /* particles: numbers as written, including layers outside of supports */
  double time, value, limit, position[3];
  BreakCause cause;
  const char *criterion, *quantity, *unit, *material; /* words of the lists of BondReasons */
  bool is_outside; /* the bond is the image of another one, in the layers outside of supports */
} BondReason;

enum { REASON_WORDS = 64 };

/** List of words of an attribute. */
typedef struct ReasonWords {
  char text[2048], *words[REASON_WORDS];
  int count;
} ReasonWords;

/** Broken bonds of a result file with the texts of its attributes. */
typedef struct BondReasons {
  int64_t count;
  BondReason *bonds; /* [count] owned */
  ReasonWords criteria, quantities, units, materials;
} BondReasons;

/** Reads the broken bonds of an open file. The caller calls broken_bonds_destroy also after a failure.
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR for damaged files and files without reasons, after a message */
int broken_bonds_read(const ResultView *view, BondReasons *reasons, Error *error);
void broken_bonds_destroy(BondReasons *reasons);

#endif

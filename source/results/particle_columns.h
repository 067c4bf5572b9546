/* Constant numbers of particles in result files: where each stands, and of what it is part.
 *
 * Group Breccia of a file holds one dataset of each column of the table, with one row for each particle. Columns that
 * are indices list their words in the attribute `names`. The reference of result files (docs/deck.md) is made from the
 * same table. */
#ifndef BRECCIA_RESULTS_PARTICLE_COLUMNS_H
#define BRECCIA_RESULTS_PARTICLE_COLUMNS_H

#include "deck/quantity.h"
#include "domain/domain.h"

#include <hdf5.h>

typedef struct ParticleColumn {
  const char *name, *dimension, *about; /* dimension "": an index or a mark */
  /** Returns the number of the particle with number n. */
  double (*value)(const Domain *domain, int64_t n);
  /** Returns word k of an index; NULL after the last. NULL: the column is no index. */
  const char *(*word)(const Domain *domain, int k);
  /** Returns true if the body needs the column. NULL: always. */
  bool (*is_needed)(const Domain *domain);
} ParticleColumn;

/** Returns column k, or NULL after the last. */
const ParticleColumn *particle_column_at(int k);

/** Creates and writes the datasets of all columns. @param[in] own  group Breccia
 *  @return 0, or 1 when HDF5 refuses or memory is out */
int particle_columns_write(hid_t own, const Domain *domain, const Units *units);

#endif

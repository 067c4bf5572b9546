/* Datasets of HDF5 that grow by rows, and attributes. All return 0, or 1 when HDF5 refuses. */
#ifndef BRECCIA_RESULTS_DATASET_H
#define BRECCIA_RESULTS_DATASET_H

#include <hdf5.h>

/** An empty dataset [0][columns] that can grow without end, stored in pieces of so many rows, each with a checksum (Fletcher's) that HDF5 looks
 *  at whenever it reads the piece, in whatever program. */
int dataset_create(hid_t where, const char *name, hid_t type, int columns, hsize_t rows_per_chunk);
/** Writes rows from `first` on, growing or cutting the dataset to end with them. */
int dataset_write(hid_t where, const char *name, hid_t memory_type, int columns, hsize_t first, hsize_t rows,
                  const void *values);
/** A dataset that holds nothing itself and shows rows from `first` on of another one of the same file, whose path is `source`:
 *  for readers that cannot take a part of a dataset. */
int dataset_view(hid_t where, const char *name, hid_t file, const char *source, hsize_t first, int rank,
                 const hsize_t shape[2]);
/** `count` numbers of a group; writes over those that are there. */
int attribute_numbers(hid_t where, const char *name, hid_t type, hsize_t count, const void *values);
/** Words of a dataset or group in `where`, which is itself ".". */
int attribute_text(hid_t where, const char *object, const char *name, const char *words);

#endif

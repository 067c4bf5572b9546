/* Everything that a step depends on, in one HDF5 file that is written whole or not at all. */
#ifndef BRECCIA_RESULTS_CHECKPOINT_H
#define BRECCIA_RESULTS_CHECKPOINT_H

#include "solver/explicit.h"

/** Numbers that a run keeps beside the solver's state. */
enum { CHECKPOINT_EXTRAS = 8 };

/** Writes <folder>/checkpoint.h5 (temporary file, fsync, rename). `deck` is the text that the run was made from. */
int checkpoint_write(const char *folder, Explicit *solver, const char *deck, const double *extras, Error *error);

/** Reads it back into a solver freshly set up from the same deck, to the same bits; another deck, version or body is refused. */
int checkpoint_read(const char *folder, Explicit *solver, const char *deck, double *extras, Error *error);

#endif

/* A state in one HDF5 file that is written whole or not at all. */
#ifndef BRECCIA_RESULTS_CHECKPOINT_H
#define BRECCIA_RESULTS_CHECKPOINT_H

#include "base/state.h"

/** What a checkpoint belongs to. */
typedef struct CheckpointOf {
  const char *deck; /* the text that the run was made from */
  int64_t particles;
} CheckpointOf;

/** Writes <folder>/checkpoint.h5 (temporary file, fsync, rename). */
int checkpoint_write(const char *folder, const StateList *state, const CheckpointOf *of, Error *error);

/** Reads it back into a body freshly set up from the same deck, to the same bits; another deck, version or body is refused. */
int checkpoint_read(const char *folder, const StateList *state, const CheckpointOf *of, Error *error);

/** A count of a checkpoint that may be there, which has to be known before its state is taken up; -1 if it cannot be read. */
int64_t checkpoint_count(const char *folder, const char *name);

#endif

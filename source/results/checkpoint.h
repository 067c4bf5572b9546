/* A state in one HDF5 file that is written whole or not at all, and sealed: no byte of it that has changed is believed.
 *
 * Two are kept in turn, checkpoint.h5 and the one before it, checkpoint-before.h5, so that a disk that loses one loses only the time between
 * them. At each moment at least one of them is whole and on the disk. */
#ifndef BRECCIA_RESULTS_CHECKPOINT_H
#define BRECCIA_RESULTS_CHECKPOINT_H

#include "base/state.h"
#include "results/hdf5_file.h"

/** What a checkpoint belongs to. */
typedef struct CheckpointOf {
  const char *deck;  /* the text that the run was made from */
  const char *files; /* the files that it names: a line each, checksum, bytes and name */
  int64_t particles;
} CheckpointOf;

typedef enum CheckpointWhich { CHECKPOINT_LAST, CHECKPOINT_BEFORE } CheckpointWhich;

/** Writes <folder>/checkpoint.h5 (temporary file, checksum, fsync, rename), when the one that is there has become the one before. */
int checkpoint_write(const char *folder, const StateList *state, const CheckpointOf *of, Error *error);

/** One that is open to be taken up. */
typedef struct Checkpoint {
  char *path;
  Hdf5File file; /* stays where it is while it is open */
} Checkpoint;

/** Opens one if it is whole and of this body, deck, files and version; of a damaged one the message says what to go on from.
 *  @param[out] checkpoint  to be closed in any case */
int checkpoint_open(Checkpoint *checkpoint, const char *folder, CheckpointWhich which, const CheckpointOf *of,
                    Error *error);
/** Reads it into a body freshly set up from the same deck, to the same bits. */
int checkpoint_read(const Checkpoint *checkpoint, const StateList *state, Error *error);
/** A count of it, which has to be known before its state is taken up; -1 if it has none of that name. */
int64_t checkpoint_count(const Checkpoint *checkpoint, const char *name);
void checkpoint_close(Checkpoint *checkpoint);

/** Makes the one before the last one, which a run has been taken up from. */
int checkpoint_return_to_before(const char *folder, Error *error);

/** Whether a folder holds at least one of them. */
bool checkpoint_exists(const char *folder);

/** Removes both, and what a run that was killed left of a third. */
int checkpoint_forget(const char *folder, Error *error);

#endif

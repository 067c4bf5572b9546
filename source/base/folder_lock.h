/* One writer at a time in a folder. */
#ifndef BRECCIA_BASE_FOLDER_LOCK_H
#define BRECCIA_BASE_FOLDER_LOCK_H

#include "base/error.h"

typedef struct FolderLock {
  char *path;     /* NULL: nothing is locked */
  int descriptor; /* what is locked; the system unlocks it when the process ends, however it ends */
} FolderLock;

/** Locks a folder by a file in it, run.lock, that says who holds it: process, computer and since when.
 *  @param[out] lock  given back by folder_lock_return in any case
 *  @return BRECCIA_OK, also where the file system knows no locks; BRECCIA_USER_ERROR after a line about who holds it; BRECCIA_FAILURE */
int folder_lock_take(FolderLock *lock, const char *folder, Error *error);
void folder_lock_return(FolderLock *lock);

#endif

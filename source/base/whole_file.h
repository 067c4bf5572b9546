/* Files that are written whole, or not at all. */
#ifndef BRECCIA_BASE_WHOLE_FILE_H
#define BRECCIA_BASE_WHOLE_FILE_H

#include "base/error.h"
#include "base/text.h"

/** Writes `words` to <path>.part and puts it in the place of `path`. Where that fails, `path` is as it was and nothing is left beside it.
 *  @return BRECCIA_OK, or BRECCIA_FAILURE after a line with the cause */
int whole_file_write(const char *path, const Text *words, Error *error);
/** Copies a file over another one, or into a new one. @return 0, or errno of what failed: then `to` is worth nothing */
int whole_file_copy(const char *from, const char *to);
/** Brings an open file to the disk; file systems that cannot do that, as some for folders, keep things in order themselves.
 *  @return 0, or 1 with errno set */
int file_settle(int descriptor);
/** The same for a file, or the names in a folder. */
int path_settle(const char *path);
/** The same for the folder in which a file lies. */
int folder_of_file_settle(const char *path);

#endif

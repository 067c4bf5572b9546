/* Opens the files of a results folder: regular files only. A symbolic link is not followed, so that a run reads and
 * writes nothing outside of its folder; a pipe or a device is refused without waiting for its other end. */
#ifndef BRECCIA_BASE_REGULAR_FILE_H
#define BRECCIA_BASE_REGULAR_FILE_H

#include <stdio.h>

/** Opens a regular file. A file opened with O_TRUNC is emptied only after it has been found to be regular.
 *  @param[in] flags  those of open(2); O_CLOEXEC and O_NOFOLLOW are added
 *  @return descriptor; -1 with the cause in errno, for regular_file_problem */
int regular_file_open(const char *path, int flags);

/** Opens a regular file as a stream. @param[in] mode  "r", "w" or "a"  @return NULL with the cause in errno */
FILE *regular_file_stream(const char *path, const char *mode);

/** Makes an empty regular file for a library or a program that writes by name and would follow a link.
 *  @return 0, or errno */
int regular_file_make(const char *path);

/** Looks at a name under which a file will be written. @return 0 if nothing or a regular file has it; else errno */
int regular_file_look(const char *path);

/** Describes why a regular file could not be opened, read or written.
 *  @param[in] number  errno of the call that failed */
const char *regular_file_problem(int number);

#endif

/* Bytes of open files: a signal may interrupt a call, and a call may do less than it was asked for; neither is a failure. */
#ifndef BRECCIA_BASE_FILE_BYTES_H
#define BRECCIA_BASE_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>

/** Reads bytes from a place of a file on. @return how many there are before its end; below 0 with errno set where they cannot be read */
int64_t file_read_at(int descriptor, void *bytes, size_t size, int64_t from);
/** Writes all bytes to a place of a file. @return 0, or errno of what failed */
int file_write_at(int descriptor, const void *bytes, size_t size, int64_t from);

#endif

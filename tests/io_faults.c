/* Loaded before the C library (LD_PRELOAD), lets calls that write into one folder fail, as a full or broken disk would.
 *
 * FAULT_FOLDER  the folder; calls on other files pass
 * FAULT_AT      the number of the call that fails, from 1 on; 0: none, and they are only counted
 * FAULT_ERROR   its errno, a number
 * FAULT_LASTS   1: all calls after it fail too
 * FAULT_EXCEPT  words in the names of files that pass too
 * FAULT_LARGER  bytes by which files of results seem larger to those who ask for their size by name
 * FAULT_COUNT   a file outside the folder, to which each call adds a byte
 * Streams of the C library write by a way that cannot be seen from here, so that flushing and closing them fail in its place, and what
 * they held is dropped. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static atomic_long calls;

static long number_of(const char *variable)
{
  const char *words = getenv(variable);
  return words ? strtol(words, NULL, 10) : 0;
}

/** Counts a call on a file of the folder. @return true with errno set where it is to fail */
static bool fails(const char *path)
{
  const char *folder = getenv("FAULT_FOLDER"), *count = getenv("FAULT_COUNT"), *except = getenv("FAULT_EXCEPT");
  char whole[PATH_MAX];
  if (!folder || !path) return false;
  if (*path != '/') {
    char here[PATH_MAX];
    if (!getcwd(here, sizeof here)) return false;
    if (snprintf(whole, sizeof whole, "%s/%s", here, path) >= (int)sizeof whole) return false;
    path = whole;
  }
  const size_t length = strlen(folder);
  if (strncmp(path, folder, length) || path[length] != '/' || (except && strstr(path + length, except))) return false;
  const long number = atomic_fetch_add(&calls, 1) + 1, at = number_of("FAULT_AT");
  if (count) {
    const int out = (int)syscall(SYS_openat, AT_FDCWD, count, O_WRONLY | O_CREAT | O_APPEND, 0666);
    syscall(SYS_write, out, ".", 1);
    syscall(SYS_close, out);
  }
  if (!at || number < at || (number > at && !number_of("FAULT_LASTS"))) return false;
  errno = (int)number_of("FAULT_ERROR");
  return true;
}

static bool fails_open(int descriptor)
{
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n <= 0) return false;
  path[n] = 0;
  return fails(path);
}

static bool for_writing(int descriptor)
{
  const int flags = fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

ssize_t write(int descriptor, const void *buffer, size_t size)
{
  return fails_open(descriptor) ? -1 : NEXT(write)(descriptor, buffer, size);
}
ssize_t pwrite(int descriptor, const void *buffer, size_t size, off_t from)
{
  return fails_open(descriptor) ? -1 : NEXT(pwrite)(descriptor, buffer, size, from);
}
ssize_t pwrite64(int descriptor, const void *buffer, size_t size, off64_t from)
{
  return fails_open(descriptor) ? -1 : NEXT(pwrite64)(descriptor, buffer, size, from);
}
ssize_t writev(int descriptor, const struct iovec *pieces, int count)
{
  return fails_open(descriptor) ? -1 : NEXT(writev)(descriptor, pieces, count);
}
int fsync(int descriptor)
{
  return fails_open(descriptor) ? -1 : NEXT(fsync)(descriptor);
}
int fdatasync(int descriptor)
{
  return fails_open(descriptor) ? -1 : NEXT(fdatasync)(descriptor);
}
int ftruncate(int descriptor, off_t size)
{
  return fails_open(descriptor) ? -1 : NEXT(ftruncate)(descriptor, size);
}
int ftruncate64(int descriptor, off64_t size)
{
  return fails_open(descriptor) ? -1 : NEXT(ftruncate64)(descriptor, size);
}
int truncate(const char *path, off_t size)
{
  return fails(path) ? -1 : NEXT(truncate)(path, size);
}
static bool is_results(const char *path)
{
  const size_t length = strlen(path);
  return length > 7 && !strcmp(path + length - 7, ".vtkhdf");
}
int stat(const char *path, struct stat *status)
{
  const int bad = NEXT(stat)(path, status);
  if (!bad && is_results(path)) status->st_size += number_of("FAULT_LARGER");
  return bad;
}
int stat64(const char *path, struct stat64 *status)
{
  const int bad = NEXT(stat64)(path, status);
  if (!bad && is_results(path)) status->st_size += number_of("FAULT_LARGER");
  return bad;
}
int mkdir(const char *path, mode_t mode)
{
  return fails(path) ? -1 : NEXT(mkdir)(path, mode);
}
int rename(const char *from, const char *to)
{
  return fails(to) ? -1 : NEXT(rename)(from, to);
}

/** A descriptor is gone when close has failed; what it wrote may not have arrived. */
int close(int descriptor)
{
  const bool bad = for_writing(descriptor) && fails_open(descriptor);
  const int cause = errno, status = NEXT(close)(descriptor);
  if (!bad) return status;
  errno = cause;
  return -1;
}

static int mode_of(int flags, va_list arguments)
{
  return flags & O_CREAT ? va_arg(arguments, int) : 0;
}
int open(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  return flags & O_CREAT && fails(path) ? -1 : NEXT(open)(path, flags, mode);
}
int open64(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  return flags & O_CREAT && fails(path) ? -1 : NEXT(open64)(path, flags, mode);
}
FILE *fopen(const char *path, const char *mode)
{
  return *mode != 'r' && fails(path) ? NULL : NEXT(fopen)(path, mode);
}
FILE *fopen64(const char *path, const char *mode)
{
  return *mode != 'r' && fails(path) ? NULL : NEXT(fopen64)(path, mode);
}
int fflush(FILE *file)
{
  if (!file || !__fpending(file) || !fails_open(fileno(file))) return NEXT(fflush)(file);
  const int cause = errno;
  __fpurge(file);
  errno = cause;
  return EOF;
}
int fclose(FILE *file)
{
  const bool bad = __fwritable(file) && fails_open(fileno(file));
  const int cause = errno;
  if (bad) __fpurge(file);
  const int status = NEXT(fclose)(file);
  if (!bad) return status;
  errno = cause;
  return EOF;
}

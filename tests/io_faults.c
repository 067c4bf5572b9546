/* Loaded before the C library (LD_PRELOAD), lets calls that write into one folder fail, as a full or broken disk would, or kills the
 * process at one of them.
 *
 * FAULT_FOLDER  the folder, or one file in it; calls on other files pass
 * FAULT_AT      the number of the call that fails, from 1 on; 0: none, and they are only counted
 * FAULT_ERROR   its errno, a number
 * FAULT_LASTS   1: all calls after it fail too
 * FAULT_READS   1: calls that read are counted and fail, in place of those that write
 * FAULT_TRICKLES  1: nothing fails, but every other call that reads or writes is interrupted by a signal, and the others do at most half of what is asked
 * FAULT_EXCEPT  words in the names of files that pass too
 * FAULT_LARGER  bytes by which files of results seem larger to those who ask for their size by name
 * FAULT_KILLS   instead of failing: 1: the process is killed before the call, 2: where it writes, when half of it is written
 * FAULT_COUNT   a file outside the folder, to which each call adds a letter for its kind
 * Streams of the C library write by a way that cannot be seen from here, so that flushing and closing them fail in its place, and what
 * they held is dropped. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
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

typedef enum Kind {
  OPEN = 'o',
  WRITE = 'w',
  FLUSH = 'f', /* of a stream */
  SETTLE = 's',
  TRUNCATE = 't',
  CLOSE = 'c',
  MAKE = 'm', /* a folder */
  RENAME = 'r',
  LINK = 'l', /* this and the next one never fail, but a process may be killed at them */
  REMOVE = 'u',
  READ = 'd'
} Kind;

static atomic_long calls;

static long number_of(const char *variable)
{
  const char *words = getenv(variable);
  return words ? strtol(words, NULL, 10) : 0;
}

static void die(void)
{
  kill(getpid(), SIGKILL);
}

/** Whether a call is on a file of the folder that does not pass. */
static bool concerns(const char *path, Kind kind)
{
  const char *folder = getenv("FAULT_FOLDER"), *except = getenv("FAULT_EXCEPT");
  char whole[PATH_MAX];
  if (!folder || !path) return false;
  if (*path != '/') {
    char here[PATH_MAX];
    if (!getcwd(here, sizeof here)) return false;
    if (snprintf(whole, sizeof whole, "%s/%s", here, path) >= (int)sizeof whole) return false;
    path = whole;
  }
  const size_t length = strlen(folder);
  return !strncmp(path, folder, length) && (path[length] == '/' || (!path[length] && kind != MAKE)) &&
         !(except && strstr(path + length, except));
}

/** Counts a call on a file of the folder. @return true with errno set where it is to fail, or to be cut short by death */
static bool fails(const char *path, Kind kind)
{
  const char *count = getenv("FAULT_COUNT");
  const long kills = number_of("FAULT_KILLS");
  if ((kind == READ) != (number_of("FAULT_READS") != 0) || ((kind == LINK || kind == REMOVE) && !kills) ||
      number_of("FAULT_TRICKLES") || !concerns(path, kind))
    return false;
  const long number = atomic_fetch_add(&calls, 1) + 1, at = number_of("FAULT_AT");
  if (count) {
    const int out = (int)syscall(SYS_openat, AT_FDCWD, count, O_WRONLY | O_CREAT | O_APPEND, 0666);
    syscall(SYS_write, out, &(char){(char)kind}, 1);
    syscall(SYS_close, out);
  }
  if (!at || number < at || (number > at && !number_of("FAULT_LASTS"))) return false;
  if (kills == 1 || (kills && kind != WRITE && kind != FLUSH)) die();
  errno = (int)number_of("FAULT_ERROR");
  return true;
}

/** Of a file that is open; "" where it has none. */
static const char *path_of(int descriptor, char path[PATH_MAX])
{
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, PATH_MAX - 1);
  path[n < 0 ? 0 : n] = 0;
  return path;
}

static bool fails_open(int descriptor, Kind kind)
{
  char path[PATH_MAX];
  return fails(path_of(descriptor, path), kind);
}

/** Whether a call that reads or writes is interrupted, with errno set. @param[in,out] size  how much it is to do */
static bool is_interrupted(int descriptor, size_t *size)
{
  char path[PATH_MAX];
  if (!number_of("FAULT_TRICKLES") || !concerns(path_of(descriptor, path), READ)) return false;
  if (*size > 1) *size /= 2;
  if (atomic_fetch_add(&calls, 1) % 2) return false;
  errno = EINTR;
  return true;
}

static bool for_writing(int descriptor)
{
  const int flags = fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

/** What a write that fails comes to: an error, or half of it and the end. */
static ssize_t cut_short(int descriptor, const void *buffer, size_t size, off_t from)
{
  if (number_of("FAULT_KILLS")) {
    if (from < 0)
      syscall(SYS_write, descriptor, buffer, size / 2);
    else
      syscall(SYS_pwrite64, descriptor, buffer, size / 2, from);
    die();
  }
  return -1;
}

ssize_t write(int descriptor, const void *buffer, size_t size)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, WRITE) ? cut_short(descriptor, buffer, size, -1)
                                       : NEXT(write)(descriptor, buffer, size);
}
ssize_t pwrite(int descriptor, const void *buffer, size_t size, off_t from)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, WRITE) ? cut_short(descriptor, buffer, size, from)
                                       : NEXT(pwrite)(descriptor, buffer, size, from);
}
ssize_t pwrite64(int descriptor, const void *buffer, size_t size, off64_t from)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, WRITE) ? cut_short(descriptor, buffer, size, from)
                                       : NEXT(pwrite64)(descriptor, buffer, size, from);
}
ssize_t writev(int descriptor, const struct iovec *pieces, int count)
{
  return fails_open(descriptor, WRITE) ? cut_short(descriptor, pieces->iov_base, pieces->iov_len, -1)
                                       : NEXT(writev)(descriptor, pieces, count);
}
ssize_t read(int descriptor, void *buffer, size_t size)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, READ) ? -1 : NEXT(read)(descriptor, buffer, size);
}
ssize_t pread(int descriptor, void *buffer, size_t size, off_t from)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, READ) ? -1 : NEXT(pread)(descriptor, buffer, size, from);
}
ssize_t pread64(int descriptor, void *buffer, size_t size, off64_t from)
{
  if (is_interrupted(descriptor, &size)) return -1;
  return fails_open(descriptor, READ) ? -1 : NEXT(pread64)(descriptor, buffer, size, from);
}
int fsync(int descriptor)
{
  return fails_open(descriptor, SETTLE) ? -1 : NEXT(fsync)(descriptor);
}
int fdatasync(int descriptor)
{
  return fails_open(descriptor, SETTLE) ? -1 : NEXT(fdatasync)(descriptor);
}
int ftruncate(int descriptor, off_t size)
{
  return fails_open(descriptor, TRUNCATE) ? -1 : NEXT(ftruncate)(descriptor, size);
}
int ftruncate64(int descriptor, off64_t size)
{
  return fails_open(descriptor, TRUNCATE) ? -1 : NEXT(ftruncate64)(descriptor, size);
}
int truncate(const char *path, off_t size)
{
  return fails(path, TRUNCATE) ? -1 : NEXT(truncate)(path, size);
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
  return fails(path, MAKE) ? -1 : NEXT(mkdir)(path, mode);
}
int rename(const char *from, const char *to)
{
  return fails(to, RENAME) ? -1 : NEXT(rename)(from, to);
}
int link(const char *from, const char *to)
{
  return fails(to, LINK) ? -1 : NEXT(link)(from, to);
}
int unlink(const char *path)
{
  return fails(path, REMOVE) ? -1 : NEXT(unlink)(path);
}
int remove(const char *path)
{
  return fails(path, REMOVE) ? -1 : NEXT(remove)(path);
}

/** A descriptor is gone when close has failed; what it wrote may not have arrived. */
int close(int descriptor)
{
  const bool bad = for_writing(descriptor) && fails_open(descriptor, CLOSE);
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
  return flags & O_CREAT && fails(path, OPEN) ? -1 : NEXT(open)(path, flags, mode);
}
int open64(const char *path, int flags, ...)
{
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  return flags & O_CREAT && fails(path, OPEN) ? -1 : NEXT(open64)(path, flags, mode);
}
FILE *fopen(const char *path, const char *mode)
{
  return *mode != 'r' && fails(path, OPEN) ? NULL : NEXT(fopen)(path, mode);
}
FILE *fopen64(const char *path, const char *mode)
{
  return *mode != 'r' && fails(path, OPEN) ? NULL : NEXT(fopen64)(path, mode);
}
/** Drops what a stream holds; or writes half of it and ends. */
static void drop(FILE *file)
{
  if (number_of("FAULT_KILLS")) cut_short(fileno(file), file->_IO_write_base, __fpending(file), -1);
  __fpurge(file);
}
int fflush(FILE *file)
{
  if (!file || !__fpending(file) || !fails_open(fileno(file), FLUSH)) return NEXT(fflush)(file);
  const int cause = errno;
  drop(file);
  errno = cause;
  return EOF;
}
int fclose(FILE *file)
{
  const bool bad = __fwritable(file) && fails_open(fileno(file), FLUSH);
  const int cause = errno;
  if (bad) drop(file);
  const int status = NEXT(fclose)(file);
  if (!bad) return status;
  errno = cause;
  return EOF;
}

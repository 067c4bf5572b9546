#include "base/regular_file.h"

#include "base/text.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/** Returns the reason for which a descriptor is not that of a regular file, an errno; 0: it is. */
static int regular_file_misfit(int descriptor)
{
  struct stat status;
  if (fstat(descriptor, &status)) return errno;
  return S_ISREG(status.st_mode) ? 0 : S_ISDIR(status.st_mode) ? EISDIR : ESPIPE;
}

int regular_file_open(const char *path, int flags)
{
  const int file = open(path, (flags & ~O_TRUNC) | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file < 0) {
    if (errno == ENXIO) errno = ESPIPE; /* a pipe that nobody reads */
    return -1;
  }
  struct stat status;
  int cause = regular_file_misfit(file);
  if (!cause && flags & O_TRUNC && !fstat(file, &status) && status.st_size && ftruncate(file, 0)) cause = errno;
  if (!cause) return file;
  close(file);
  errno = cause;
  return -1;
}

FILE *regular_file_stream(const char *path, const char *mode)
{
  const int flags = *mode == 'r' ? O_RDONLY : O_WRONLY | O_CREAT | (*mode == 'a' ? O_APPEND : O_TRUNC);
  const int number = regular_file_open(path, flags);
  FILE *file = number < 0 ? NULL : fdopen(number, mode);
  if (file || number < 0) return file;
  const int cause = errno;
  close(number);
  errno = cause;
  return NULL;
}

int regular_file_make(const char *path)
{
  const int file = regular_file_open(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file >= 0 && !close(file)) return 0;
  const int cause = errno;
  if (file >= 0) remove(path); /* it is empty, and may not reach the disk */
  return cause;
}

int regular_file_look(const char *path)
{
  struct stat status;
  if (lstat(path, &status)) return errno == ENOENT ? 0 : errno;
  if (S_ISLNK(status.st_mode)) return ELOOP;
  return S_ISREG(status.st_mode) ? 0 : S_ISDIR(status.st_mode) ? EISDIR : ESPIPE;
}

const char *regular_file_problem(int number)
{
  if (number == ELOOP) return "it is a link; remove it";
  return number == ESPIPE ? text_why_unread(number) : strerror(number);
}

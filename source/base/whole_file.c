#include "base/whole_file.h"

#include "base/file_bytes.h"
#include "base/memory.h"
#include "base/regular_file.h"
#include "breccia/breccia.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int whole_file_write(const char *path, const Text *words, Error *error)
{
  char *part = words->failed ? NULL : text_format("%s.part", path);
  if (!part) return error_add(error, BRECCIA_FAILURE, "%s: cannot be written: out of memory", path);
  FILE *file = regular_file_stream(part, "w");
  int cause = file ? 0 : errno;
  if (file && fwrite(text_words(words), 1, words->length, file) != words->length) cause = errno;
  if (file && fclose(file) && !cause) cause = errno;
  if (!cause && rename(part, path)) cause = errno;
  if (cause) {
    if (file) remove(part);
    error_add(error, BRECCIA_FAILURE, "%s: cannot be written: %s", path, regular_file_problem(cause));
  }
  free(part);
  return cause ? BRECCIA_FAILURE : BRECCIA_OK;
}

int whole_file_copy(const char *from, const char *to)
{
  enum { PIECE = 1 << 20 };
  const int in = regular_file_open(from, O_RDONLY),
            out = in < 0 ? -1 : regular_file_open(to, O_WRONLY | O_CREAT | O_TRUNC);
  int cause = out < 0 ? errno : 0;
  char *buffer = memory_plain(PIECE, 1);
  if (!buffer) cause = ENOMEM;
  for (int64_t done = 0; !cause;) {
    const int64_t n = file_read_at(in, buffer, PIECE, done);
    if (n < 0) cause = errno;
    if (n <= 0) break;
    cause = file_write_at(out, buffer, (size_t)n, done);
    done += n;
  }
  free(buffer);
  if (in >= 0) close(in);
  if (out >= 0 && close(out) && !cause) cause = errno;
  return cause;
}

int file_settle(int descriptor)
{
  return fsync(descriptor) && errno != EINVAL && errno != ENOTSUP;
}

int path_settle(const char *path)
{
  const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const int bad = file < 0 || file_settle(file);
  const int cause = errno;
  if (file >= 0) close(file);
  errno = cause;
  return bad;
}

int folder_of_file_settle(const char *path)
{
  const char *slash = strrchr(path, '/');
  char *folder = slash ? text_format("%.*s", (int)(slash - path) + 1, path) : text_format(".");
  const int bad = !folder || path_settle(folder);
  free(folder);
  return bad;
}

#include "base/file_bytes.h"

#include <errno.h>
#include <unistd.h>

int64_t file_read_at(int descriptor, void *bytes, size_t size, int64_t from)
{
  size_t done = 0;
  while (done < size) {
    const ssize_t n = pread(descriptor, (char *)bytes + done, size - done, (off_t)(from + (int64_t)done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return n;
    if (!n) break;
    done += (size_t)n;
  }
  return (int64_t)done;
}

int file_write_at(int descriptor, const void *bytes, size_t size, int64_t from)
{
  size_t done = 0;
  while (done < size) {
    const ssize_t n = pwrite(descriptor, (const char *)bytes + done, size - done, (off_t)(from + (int64_t)done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n ? errno : EIO;
    done += (size_t)n;
  }
  return 0;
}

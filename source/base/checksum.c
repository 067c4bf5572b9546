#include "base/checksum.h"

#include "base/file_bytes.h"
#include "base/memory.h"
#include "base/text.h"
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>
#include <zlib.h>

int checksum_of_descriptor(int file, int64_t from, int64_t most, uint32_t *sum, int64_t *bytes)
{
  enum { PIECE = 1 << 18 }; /* stays in the cache */
  unsigned char *piece = memory_plain(PIECE, 1);
  int64_t n = piece ? 0 : -1;
  uLong crc = crc32(0, NULL, 0);
  *bytes = 0;
  while (piece &&
         (n = file_read_at(file, piece, (size_t)(most - *bytes < PIECE ? most - *bytes : PIECE), from + *bytes)) > 0) {
    crc = crc32(crc, piece, (uInt)n);
    *bytes += n;
  }
  const int problem = errno;
  free(piece);
  *sum = (uint32_t)crc;
  errno = problem;
  return n != 0;
}

int checksum_of_file(const char *path, int64_t from, int64_t most, uint32_t *sum, int64_t *bytes)
{
  const int file = text_open_file(path);
  if (file < 0) return 1;
  const int bad = checksum_of_descriptor(file, from, most, sum, bytes), cause = errno;
  close(file);
  errno = cause;
  return bad;
}

uint32_t checksum_of(const void *bytes, size_t size)
{
  return checksum_with(0, bytes, size);
}

uint32_t checksum_with(uint32_t sum, const void *bytes, size_t size)
{
  return (uint32_t)crc32_z(sum, bytes, size);
}

#include "results/seal.h"

#include "base/checksum.h"
#include "base/file_bytes.h"
#include "base/regular_file.h"
#include "base/whole_file.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/** The words for the bytes behind them, to the last one: whatever changes there is seen too. */
static int words_for(const char *path, char words[SEAL_BYTES])
{
  uint32_t sum;
  int64_t bytes;
  memset(words, 0, SEAL_BYTES);
  const int file = regular_file_open(path, O_RDONLY);
  if (file < 0) return 1;
  const int bad = checksum_of_descriptor(file, SEAL_BYTES, INT64_MAX, &sum, &bytes), cause = errno;
  close(file);
  errno = cause;
  if (bad) return 1;
  snprintf(words, SEAL_BYTES, "Breccia checkpoint\nbytes behind the first %d: %" PRId64 "\nCRC-32: %08" PRIx32 "\n",
           SEAL_BYTES, bytes, sum);
  return 0;
}

int seal_file(const char *path)
{
  char words[SEAL_BYTES];
  if (words_for(path, words)) return 1;
  const int file = regular_file_open(path, O_WRONLY);
  int bad = file < 0 || file_write_at(file, words, SEAL_BYTES, 0) || file_settle(file);
  if (file >= 0 && close(file)) bad = 1;
  return bad;
}

int seal_is_broken(const char *path)
{
  char words[SEAL_BYTES], there[SEAL_BYTES];
  if (words_for(path, words)) return -1;
  const int file = regular_file_open(path, O_RDONLY);
  if (file < 0) return -1;
  const int64_t n = file_read_at(file, there, SEAL_BYTES, 0);
  const int problem = errno;
  close(file);
  errno = problem;
  return n < 0 ? -1 : n != SEAL_BYTES || memcmp(words, there, SEAL_BYTES) != 0;
}

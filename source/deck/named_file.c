#include "deck/named_file.h"

#include "base/checksum.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void named_file_note(const DeckReader *reader, const char *name, const char *path)
{
  uint32_t sum;
  int64_t bytes;
  if (!reader->files || checksum_of_file(path, 0, INT64_MAX, &sum, &bytes)) return;
  char *line = text_format("%08" PRIx32 " %" PRId64 " %s\n", sum, bytes, name);
  if (line && !strstr(text_words(reader->files), line)) text_add(reader->files, "%s", line);
  free(line);
}

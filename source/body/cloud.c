#include "body/cloud.h"

#include "deck/named_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** Spreads the lowest 21 bits so that two others fit between each two of them. */
static uint64_t spread(uint64_t x)
{
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

typedef struct Keyed {
  uint64_t key;
  int32_t index;
} Keyed;

static int by_key(const void *a, const void *b)
{
  const Keyed *x = a, *y = b;
  if (x->key != y->key) return x->key < y->key ? -1 : 1;
  return x->index < y->index ? -1 : x->index > y->index;
}

/* Along Morton's curve: bits of the three coordinates in turn. */
int cloud_sort(Cloud *cloud, Error *error)
{
  double low[3] = {INFINITY, INFINITY, INFINITY}, extent = 0;
  for (int k = 0; k < 3; ++k) {
    double high = -INFINITY;
    for (int64_t n = 0; cloud->position[k] && n < cloud->count; ++n) {
      low[k] = fmin(low[k], cloud->position[k][n]);
      high = fmax(high, cloud->position[k][n]);
    }
    extent = fmax(extent, high - low[k]);
  }
  Keyed *keyed = memory_zeroed((size_t)cloud->count, sizeof *keyed, "order of particles", error);
  cloud->order = memory_zeroed((size_t)cloud->count, sizeof *cloud->order, "order of particles", error);
  if (!keyed || !cloud->order) {
    free(keyed);
    return BRECCIA_FAILURE;
  }
  for (int64_t n = 0; n < cloud->count; ++n) {
    keyed[n].index = (int32_t)n;
    for (int k = 0; k < 3 && cloud->position[k]; ++k)
      keyed[n].key |= spread((uint64_t)((cloud->position[k][n] - low[k]) / (extent > 0 ? extent : 1) * 0x1fffff)) << k;
  }
  qsort(keyed, (size_t)cloud->count, sizeof *keyed, by_key);
  for (int64_t n = 0; n < cloud->count; ++n) cloud->order[n] = keyed[n].index;
  free(keyed);
  return BRECCIA_OK;
}

static int check_rows(const Cloud *cloud, const DeckReader *reader, const Node *node, const char *file)
{
  static const char *const names[] = {"x", "y", "z"};
  for (int64_t n = 0; n < cloud->count; ++n) {
    for (int k = 0; k < 3; ++k)
      if (cloud->position[k] && !isfinite(cloud->position[k][n]))
        return node_error(reader->document, node, reader->error, "file: '%s', particle %lld: its %s is not a number",
                          file, (long long)n, names[k]);
    if (!(cloud->volume[n] > 0) || !isfinite(cloud->volume[n]))
      return node_error(reader->document, node, reader->error,
                        "file: '%s', particle %lld: its volume must be a number above 0", file, (long long)n);
  }
  if (!cloud->count) return node_error(reader->document, node, reader->error, "file: '%s' has no particle", file);
  return BRECCIA_OK;
}

#define READER(name) extern const BodyReader name##_reader;
#include "body/readers.h"
#undef READER

static const BodyReader *const readers[] = {
#define READER(name) &name##_reader,
#include "body/readers.h"
#undef READER
};

const BodyReader *body_reader_at(int k)
{
  return k < (int)(sizeof readers / sizeof *readers) ? readers[k] : NULL;
}

/** The kind of a file by its ending, in any case of letters; files with another ending are tables, as they were before there was a choice. */
static const BodyReader *reader_of(const char *file)
{
  const char *ending = strrchr(file, '.');
  for (int k = 0; ending && body_reader_at(k); ++k)
    if (!strcasecmp(ending, body_reader_at(k)->ending)) return body_reader_at(k);
  return &csv_reader;
}

int cloud_read(Cloud *cloud, const DeckReader *reader, const Node *node, const char *file, int dimensions)
{
  *cloud = (Cloud){0};
  char *path = text_beside(node_file(reader->document, node), file);
  Error *reason = breccia_error_create();
  if (path) named_file_note(reader, file, path);
  int status = path ? reader_of(file)->read(cloud, path, dimensions, reader->units, reason) : BRECCIA_FAILURE;
  if (!path) error_add(reader->error, BRECCIA_FAILURE, "out of memory: %s", file);
  if (path && status)
    status = node_error(reader->document, node, reader->error, "file: %s", breccia_error_text(reason));
  breccia_error_destroy(&reason);
  free(path);
  return status ? status : check_rows(cloud, reader, node, file);
}

void cloud_destroy(Cloud *cloud)
{
  for (int k = 0; k < 3; ++k) free(cloud->position[k]);
  free(cloud->volume);
  free(cloud->order);
  csv_words_destroy(&cloud->groups);
  *cloud = (Cloud){0};
}

void cloud_thin(Cloud *cloud, const uint8_t *gone)
{
  int64_t count = 0;
  for (int64_t n = 0; n < cloud->count; ++n) {
    if (gone[n]) continue;
    for (int k = 0; k < 3; ++k)
      if (cloud->position[k]) cloud->position[k][count] = cloud->position[k][n];
    if (cloud->groups.cells) cloud->groups.cells[count] = cloud->groups.cells[n];
    cloud->volume[count++] = cloud->volume[n];
  }
  cloud->count = count;
}

int64_t cloud_slices(const Cloud *cloud)
{
  return (cloud->count + SLICE - 1) / SLICE;
}

void cloud_fill(const Cloud *cloud, Particles *particles, int64_t slice, int block, int32_t *number)
{
  int64_t places = cloud_slices(cloud) * SLICE;
  for (int64_t k = 0; k < places; ++k) {
    int64_t place = slice * SLICE + k;
    bool here = k < cloud->count;
    int32_t from = cloud->order[here ? k : cloud->count - 1]; /* unused places stand at the last particle */
    particles->block[place / SLICE] = block;
    for (int c = 0; c < 3; ++c) particles->position[c][place] = cloud->position[c] ? cloud->position[c][from] : 0;
    particles->volume[place] = here ? cloud->volume[from] : 0;
    particles->density[place] = 1;
    particles->number[place] = here ? *number + from : -1;
    if (here) particles->place_of[*number + from] = (int32_t)place;
  }
  *number += (int32_t)cloud->count;
}

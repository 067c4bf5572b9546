#include "body/cloud.h"

#include "deck/named_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Each part is halved across its longest side until eight particles are left, which make a slice: the more they lie in one place, the more neighbours they share. */
static double extent_along(const Cloud *cloud, const int32_t *part, int64_t count, int k)
{
  double low = INFINITY, high = -INFINITY;
  for (int64_t n = 0; n < count; ++n) {
    low = fmin(low, cloud->position[k][part[n]]);
    high = fmax(high, cloud->position[k][part[n]]);
  }
  return high - low;
}

static bool comes_before(const double *x, int32_t a, int32_t b)
{
  return x[a] < x[b] || (x[a] == x[b] && a < b);
}

/** Puts the first `middle` along x before the others. */
static void part_at(const double *x, int32_t *part, int64_t count, int64_t middle)
{
  int64_t low = 0, high = count - 1;
  while (low < high) {
    const int32_t pivot = part[low + (high - low) / 2];
    int64_t i = low, j = high;
    while (i <= j) {
      while (comes_before(x, part[i], pivot)) ++i;
      while (comes_before(x, pivot, part[j])) --j;
      if (i > j) break;
      const int32_t other = part[i];
      part[i++] = part[j];
      part[j--] = other;
    }
    if (middle <= j)
      high = j;
    else if (middle >= i)
      low = i;
    else
      return;
  }
}

static void halve(const Cloud *cloud, int32_t *part, int64_t count)
{
  while (count > SLICE) {
    const int64_t slices = (count + SLICE - 1) / SLICE, middle = slices / 2 * SLICE;
    int longest = 0;
    double most = -1;
    for (int k = 0; k < 3 && cloud->position[k]; ++k) {
      const double along = extent_along(cloud, part, count, k);
      if (along > most) {
        most = along;
        longest = k;
      }
    }
    part_at(cloud->position[longest], part, count, middle);
    halve(cloud, part, middle);
    part += middle;
    count -= middle;
  }
}

int cloud_sort(Cloud *cloud, Error *error)
{
  cloud->order = memory_zeroed((size_t)cloud->count, sizeof *cloud->order, "order of particles", error);
  if (!cloud->order) return BRECCIA_FAILURE;
  for (int64_t n = 0; n < cloud->count; ++n) cloud->order[n] = (int32_t)n;
  halve(cloud, cloud->order, cloud->count);
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

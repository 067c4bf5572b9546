#include "results/global_heap.h"

#include <stdint.h>
#include <string.h>

enum { HEADING = 16, OBJECT_HEADING = 16, CHECKSUM = 4 };

/** Reads an unsigned number of some bytes, the lowest first. */
static uint64_t global_heap_number(const unsigned char *bytes, int size)
{
  uint64_t number = 0;
  for (int k = size - 1; k >= 0; --k) number = number << 8 | bytes[k];
  return number;
}

static uint32_t global_heap_turn(uint32_t x, int bits)
{
  return x << bits | x >> (32 - bits);
}

/** Computes the checksum that HDF5 writes behind its metadata: Jenkins' lookup3 (Jenkins 2006, "lookup3.c") with an
 * initial value of 0. */
static uint32_t global_heap_checksum(const unsigned char *bytes, size_t size)
{
  static const int mix[6] = {4, 6, 8, 16, 19, 4}, last[7] = {14, 11, 25, 16, 4, 14, 24};
  uint32_t v[3];
  v[0] = v[1] = v[2] = 0xdeadbeefu + (uint32_t)size;
  while (size > 12) {
    for (int k = 0; k < 3; ++k) v[k] += (uint32_t)global_heap_number(bytes + 4 * k, 4);
    for (int k = 0; k < 6; ++k) {
      uint32_t *a = &v[k % 3], *b = &v[(k + 1) % 3], *c = &v[(k + 2) % 3];
      *a = (*a - *c) ^ global_heap_turn(*c, mix[k]);
      *c += *b;
    }
    bytes += 12;
    size -= 12;
  }
  if (!size) return v[2];
  for (size_t k = 0; k < size; ++k) v[k / 4] += (uint32_t)bytes[k] << 8 * (k % 4);
  for (int k = 0; k < 7; ++k) {
    uint32_t *c = &v[(k + 2) % 3], *b = &v[(k + 1) % 3];
    *c = (*c ^ *b) - global_heap_turn(*b, last[k]);
  }
  return v[2];
}

/** Returns true if an object is a mapping with its checksum. */
static bool global_heap_object_is_whole(const unsigned char *bytes, uint64_t size)
{
  return size > CHECKSUM &&
         global_heap_checksum(bytes, (size_t)size - CHECKSUM) == global_heap_number(bytes + size - CHECKSUM, CHECKSUM);
}

bool global_heap_is_damaged(const void *given, size_t size)
{
  static const unsigned char begin[8] = {'G', 'C', 'O', 'L', 1};
  const unsigned char *bytes = given;
  if (size < HEADING || memcmp(bytes, begin, sizeof begin) != 0) return false;
  if (global_heap_number(bytes + sizeof begin, 8) > size) return false;
  const uint64_t end = global_heap_number(bytes + sizeof begin, 8);
  uint64_t at = HEADING;
  while (at + OBJECT_HEADING <= end) { /* what is left behind is free */
    const uint64_t index = global_heap_number(bytes + at, 2), own = global_heap_number(bytes + at + 8, 8),
                   left = end - at;
    if (own > left) return true;
    const uint64_t taken = index ? OBJECT_HEADING + (own + 7) / 8 * 8 : own;
    if (taken < OBJECT_HEADING || taken > left) return true;
    if (index && !global_heap_object_is_whole(bytes + at + OBJECT_HEADING, own)) return true;
    at += taken;
  }
  return false;
}

#include "base/memory.h"

#include "base/check.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static _Thread_local long refusals;

long memory_refusals(void)
{
  return refusals;
}

void *memory_noted(void *memory)
{
  refusals += !memory;
  return memory;
}

static void *out_of_memory(size_t count, size_t size, const char *label, Error *error)
{
  memory_noted(NULL);
  error_add(error, BRECCIA_FAILURE, "out of memory: %s needs %.1f MB", label, (double)count * (double)size / 1e6);
  return NULL;
}

void *memory_zeroed(size_t count, size_t size, const char *label, Error *error)
{
  enum { ALIGNMENT = 64 };
  CHECK(*label);
  size_t bytes = 0;
  void *memory = NULL;
  if (!__builtin_mul_overflow(count, size, &bytes) && bytes < SIZE_MAX - ALIGNMENT)
    memory = aligned_alloc(ALIGNMENT, bytes ? (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT : ALIGNMENT);
  return memory ? memset(memory, 0, bytes) : out_of_memory(count, size, label, error);
}

void *memory_reserved(size_t count, size_t size, const char *label, Error *error)
{
  CHECK(*label);
  void *memory = calloc(count ? count : 1, size);
  return memory ? memory : out_of_memory(count, size, label, error);
}

void *memory_plain(size_t count, size_t size)
{
  return memory_noted(calloc(count ? count : 1, size));
}

void *memory_grown(void *old, size_t count, size_t size)
{
  size_t bytes = 0;
  return memory_noted(__builtin_mul_overflow(count, size, &bytes) ? NULL : realloc(old, bytes ? bytes : 1));
}

typedef struct Chunk {
  struct Chunk *next;
  size_t used, size;
  max_align_t bytes[];
} Chunk;

struct Arena {
  Chunk *chunks;
};

Arena *arena_create(void)
{
  return memory_plain(1, sizeof(Arena));
}

void *arena_zeroed(Arena *arena, size_t size)
{
  enum { CHUNK = 1 << 16 };
  size = (size + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
  Chunk *chunk = arena->chunks;
  if (!chunk || chunk->size - chunk->used < size) {
    size_t room = size > CHUNK ? size : CHUNK;
    chunk = memory_plain(1, sizeof(Chunk) + room);
    if (!chunk) return NULL;
    chunk->size = room;
    chunk->next = arena->chunks;
    arena->chunks = chunk;
  }
  void *piece = (char *)chunk->bytes + chunk->used;
  chunk->used += size;
  return piece;
}

char *arena_copy(Arena *arena, const char *words, size_t length)
{
  char *copy = arena_zeroed(arena, length + 1);
  if (copy) memcpy(copy, words, length);
  return copy;
}

void arena_destroy(Arena **arena)
{
  if (!arena || !*arena) return;
  for (Chunk *chunk = (*arena)->chunks, *next; chunk; chunk = next) {
    next = chunk->next;
    free(chunk);
  }
  free(*arena);
  *arena = NULL;
}

/* All large memory is asked for here, by name; and an arena for the many small pieces that are freed together. */
#ifndef BRECCIA_BASE_MEMORY_H
#define BRECCIA_BASE_MEMORY_H

#include "base/error.h"
#include <stddef.h>

/** Zeroed memory aligned to 64 bytes for `count` things of `size` bytes.
 *  @param[in] label  what it is for, in words, used in the message when memory is out
 *  @return NULL after adding a line to `error`; never NULL for count 0; freed with free() */
void *memory_zeroed(size_t count, size_t size, const char *label, Error *error);

/** The same without the alignment, and memory is taken only where something is written: for arrays of which large parts may stay zero. */
void *memory_reserved(size_t count, size_t size, const char *label, Error *error);

typedef struct Arena Arena;

Arena *arena_create(void);
/** Zeroed memory, freed with the arena; NULL when memory is out. */
void *arena_zeroed(Arena *arena, size_t size);
/** A copy of the first `length` bytes of `words`, zero-terminated, freed with the arena. */
char *arena_copy(Arena *arena, const char *words, size_t length);
void arena_destroy(Arena **arena);

#endif

/* All large memory is asked for here, by name; and an arena for the many small pieces that are freed together. Whatever is refused is
 * counted, so that a public function can tell at its end that something was lost on the way (model/host.h). */
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

/** Zeroed memory without a message: NULL where it is refused; the caller says what cannot be done. Never NULL for count 0. */
void *memory_plain(size_t count, size_t size);

/** Room for `count` things of `size` bytes, the first of them as in `old` (NULL: none). @return NULL where it is refused; then `old` stays as
 *  it is, and no message is added */
void *memory_grown(void *old, size_t count, size_t size);

/** How often memory was refused to this thread, here and where texts grow, since it began. */
long memory_refusals(void);

/** For those who ask the system themselves: NULL is counted. @return `memory` */
void *memory_noted(void *memory);

typedef struct Arena Arena;

Arena *arena_create(void);
/** Zeroed memory, freed with the arena; NULL when memory is out. */
void *arena_zeroed(Arena *arena, size_t size);
/** A copy of the first `length` bytes of `words`, zero-terminated, freed with the arena. */
char *arena_copy(Arena *arena, const char *words, size_t length);
void arena_destroy(Arena **arena);

#endif

/* Structs of the public header, which begin with their size: read and filled whatever version of the header they were made with. */
#ifndef BRECCIA_MODEL_SIZED_H
#define BRECCIA_MODEL_SIZED_H

#include "base/error.h"

/** Reads a struct that a program made. What it does not know of is zero.
 *  @param[out] own    [size], of which the first member is the size
 *  @param[in]  given  NULL: all zeros
 *  @param[in]  name   of the struct, for messages
 *  @return BRECCIA_OK; BRECCIA_USER_ERROR if no size is set, or something is asked for that this library does not know */
int sized_take(void *own, size_t size, const void *given, const char *name, Error *error);

/** Fills a struct of a program as far as that knows its members. @return 0 if no size is set, else 1 */
int sized_give(void *given, const void *own, size_t size);

#endif

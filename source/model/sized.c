#include "model/sized.h"

#include <string.h>

enum { LARGEST = 1 << 14 }; /* a size above is what lay in memory by chance */

static size_t size_of(const void *given)
{
  size_t size;
  memcpy(&size, given, sizeof size);
  return size > sizeof size && size <= LARGEST ? size : 0;
}

int sized_take(void *own, size_t size, const void *given, const char *name, Error *error)
{
  memset(own, 0, size);
  const size_t there = given ? size_of(given) : 0;
  if (given && !there)
    return error_add(error, BRECCIA_USER_ERROR, "%s: its size is not set; begin with {.size = sizeof(%s), ...}", name,
                     name);
  for (size_t k = size; k < there; ++k)
    if (((const unsigned char *)given)[k])
      return error_add(error, BRECCIA_USER_ERROR, "%s: asks for something that this library, Breccia %s, does not know",
                       name, BRECCIA_VERSION);
  if (given) memcpy(own, given, there < size ? there : size);
  memcpy(own, &size, sizeof size);
  return BRECCIA_OK;
}

int sized_give(void *given, const void *own, size_t size)
{
  const size_t there = size_of(given);
  if (!there) return 0;
  memcpy((char *)given + sizeof(size_t), (const char *)own + sizeof(size_t),
         (there < size ? there : size) - sizeof(size_t));
  return 1;
}

/* What must always hold is looked at where data changes hands: in debug builds and under the sanitizers, where BRECCIA_CHECKS is defined.
 * As with assert, what does not hold is said and the process aborts: it is a mistake of the program that nobody else can act upon, and a debugger
 * or a sanitizer then shows where. Whatever a deck, a file or a caller can bring about is an Error instead (base/error.h). */
#ifndef BRECCIA_BASE_CHECK_H
#define BRECCIA_BASE_CHECK_H

#ifdef BRECCIA_CHECKS
#include <stdio.h>
#include <stdlib.h>
#define CHECK(holds)                                                                                                   \
  do {                                                                                                                 \
    if (!(holds)) {                                                                                                    \
      fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #holds);                                       \
      abort();                                                                                                         \
    }                                                                                                                  \
  } while (0)
#else
#define CHECK(holds) ((void)0)
#endif

#endif

/* What must always hold is looked at where data changes hands: in debug builds and under the sanitizers, where BRECCIA_CHECKS is defined. */
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

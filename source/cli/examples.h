/* The decks of the folder examples, put into the command when it is built (scripts/embed_examples.cmake). */
#ifndef BRECCIA_CLI_EXAMPLES_H
#define BRECCIA_CLI_EXAMPLES_H

#include <stddef.h>

enum { MOST_EXAMPLE_FILES = 8 };

typedef struct ExampleFile {
  const char *name;
  const unsigned char *bytes; /* with a zero byte behind the last */
  size_t length;
} ExampleFile;

typedef struct Example {
  const char *name;                          /* folder/deck */
  ExampleFile files[MOST_EXAMPLE_FILES + 1]; /* the deck, then the files that it names; ending in a NULL name */
} Example;

/** All examples by name, ending in a NULL name. */
extern const Example examples[];

#endif

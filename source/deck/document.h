/* YAML text as a tree of nodes that know where they stand in the file. */
#ifndef BRECCIA_DECK_DOCUMENT_H
#define BRECCIA_DECK_DOCUMENT_H

#include "base/error.h"
#include "base/memory.h"
#include <stdbool.h>

typedef enum NodeKind { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

typedef struct Node {
  NodeKind kind;
  int line, column; /* of the value, from 1 */
  const char *text; /* scalar: its characters */
  bool quoted;      /* scalar: was written in quotes */
  const char *key;  /* if it is the value of a map entry: the key */
  int key_line, key_column;
  int count; /* of a list or a map */
  struct Node *items;
} Node;

typedef struct Document {
  const char *name; /* file name for messages */
  Arena *arena;
  Node *root;
} Document;

/** Reads YAML text. Problems of syntax become lines "name:line:column: ...".
 *  @return NULL if the text is not one YAML document */
Document *document_parse(const char *text, size_t length, const char *name, Error *error);
/** The characters of a deck's file, to be freed; NULL with a message if it cannot be read or is not text. */
char *document_text(const char *path, size_t *length, Error *error);
void document_destroy(Document **document);

/** @return the value of the first entry with that key, or NULL */
const Node *node_get(const Node *map, const char *key);

/** Adds "name:line:column: ..." for a node. @return BRECCIA_USER_ERROR */
int node_error(const Document *document, const Node *node, Error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
